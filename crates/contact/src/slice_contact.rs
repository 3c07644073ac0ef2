//! The patches of two elastic gears: compliance, local laws and the forces at given gaps.
//!
//! This is what a contact at rest and the gear mesh of a multibody system share: it is told which patches face each
//! other and how far apart they stand, and does not ask where that comes from, nor of what family the gears are.

use crate::condensed_flanks::CondensedFlanks;
use crate::contact_error::ContactError;
use crate::contact_patch::ContactPatch;
use crate::contact_zone::SliceLayout;
use crate::drive::Drive;
use crate::half_spaces::HalfSpaces;
use crate::local_contact::{LawRate, LocalContact};
use crate::nlcp::{
    ContactBody, EdgeContact, Info, LineContact, LocalLaw, Params, Problem, Workspace, solve_load,
    solve_position,
};
use crate::placed_slice::ToothPlace;
use crate::slice_compliance::{LocalDepth, SliceCompliance};
use crate::slice_contact::kept_compliance::{KeptCompliance, RatesOfPatches};
use gearmesh_model::{Flank, ReducedGear};
use std::sync::Arc;

mod compliance;
mod energy_rates;
mod kept_compliance;

/// What deflects.
#[derive(Debug, Clone)]
enum Elastic {
    /// Two reduced gears.
    Reduced([Arc<SliceCompliance>; 2]),
    /// The surfaces of two bodies that are rigid otherwise.
    HalfSpaces(HalfSpaces),
}

/// Patches one after the other that stand at one place and press alike, as those of a spur line do.
#[derive(Debug, Clone, Copy)]
struct Run {
    /// First of its patches, and the one after the last.
    patches: [usize; 2],
    teeth: [usize; 2],
    /// ∂(ln length)/∂u of both gears.
    length_growth: [f64; 2],
    /// Where they stand on both gears.
    places: [ToothPlace; 2],
    /// Components of their normal along the flank normals.
    along_normals: [f64; 2],
    contact: LineContact,
    edge: Option<EdgeContact>,
    law: LocalLaw,
    depths: [LocalDepth; 2],
    /// How the law changes with the places on both flanks; zero unless asked for.
    rates: [LawRate; 2],
}

/// What was prepared, as a complementarity problem has it.
#[derive(Debug, Clone, Copy)]
pub struct Prepared<'a> {
    /// C \[m/N\], `[patch][patch]`.
    pub compliance: &'a [f64],
    /// Local laws.
    pub local: &'a [LocalLaw],
    /// Gaps \[m\].
    pub separation_m: &'a [f64],
    /// See [`crate::contact_patch::PatchBalance`].
    pub closing: &'a [f64],
    /// See [`crate::contact_patch::PatchBalance`].
    pub lever_m: &'a [f64],
}

/// Where a patch stands on a gear.
#[derive(Debug, Clone, Copy)]
pub struct Standing<'a> {
    /// Tooth and place along the profile.
    pub place: &'a ToothPlace,
    /// Its slice.
    pub slice: usize,
    /// Component of the patch's normal along that of the flank.
    pub along_normal: f64,
}

/// Patches one after the other that stand at one place on a gear.
#[derive(Debug, Clone)]
pub(crate) struct StandingRun<'a> {
    pub patches: std::ops::Range<usize>,
    /// Their slices.
    pub slices: &'a [usize],
    pub place: &'a ToothPlace,
    /// Component of their normal along that of the flank.
    pub along_normal: f64,
}

/// Two elastic gears in contact, with all memory that a solve needs.
#[derive(Debug, Clone)]
pub struct SliceContact {
    layout: SliceLayout,
    elastic: Elastic,
    local_contact: LocalContact,
    params: Params,
    /// What the processor has for the loops over coupled places; results do not depend on it.
    arch: pulp::Arch,
    runs: Vec<Run>,
    /// Slice of each patch, and its run.
    slice: Vec<usize>,
    run: Vec<usize>,
    shares: Vec<f64>,
    c: Vec<f64>,
    /// ∂C_ij/∂u_i of each gear, `[i][j]`, between patches that carried load at the last solve. Of a patch with itself
    /// both places move, and this is half the derivative of its compliance.
    rates: [Vec<f64>; 2],
    /// The same along the teeth, of gears on which slices walk that way; else empty.
    along: [Vec<f64>; 2],
    kept: KeptCompliance,
    /// Without a local law: compliance of each patch before it was divided by its share \[m/N\].
    own_compliance: Vec<f64>,
    local: Vec<LocalLaw>,
    separation_m: Vec<f64>,
    closing: Vec<f64>,
    lever_m: Vec<f64>,
    work: Workspace,
    rates_of_patches: RatesOfPatches,
}

impl SliceContact {
    /// Prepares the contact of two reduced gears with so many teeth, loaded on flanks of these sides, on the slices of
    /// a layout; for up to `most_lines` contact lines at once. Flanks that are `known` are not condensed again.
    ///
    /// # Errors
    /// [`ContactError`] when the models do not fit the teeth or each other.
    pub fn of_gears<'a>(
        models: [&'a ReducedGear; 2],
        (teeth, flanks): ([usize; 2], [Flank; 2]),
        (local, layout): (LocalContact, SliceLayout),
        most_lines: usize,
        known: &CondensedFlanks<'a>,
    ) -> Result<Self, ContactError> {
        for gear in 0..2 {
            let (found, needed) = (models[gear].teeth, teeth[gear]);
            if found != needed {
                let gear = gear + 1;
                return Err(ContactError::Teeth {
                    gear,
                    found,
                    needed,
                });
            }
        }
        layout.check()?;
        let condense = |gear: usize| {
            let spread = layout.spread(gear + 1, models[gear]);
            known.on_slices(models[gear], flanks[gear], local, spread)
        };
        let compliance = [condense(0)?, condense(1)?];
        Ok(Self::new(layout, compliance, local, most_lines))
    }

    /// The contact of two flanks that have been condensed to the slices of a layout.
    #[must_use]
    pub fn new(
        layout: SliceLayout,
        compliance: [Arc<SliceCompliance>; 2],
        local_contact: LocalContact,
        most_lines: usize,
    ) -> Self {
        let walks = [0, 1].map(|gear: usize| compliance[gear].walks_along());
        let elastic = Elastic::Reduced(compliance);
        Self::of_elastic(layout, (elastic, walks), local_contact, most_lines)
    }

    /// The contact of two bodies that deflect at their surfaces only.
    ///
    /// The local law is a logarithm up to where its slope is all but zero, as that of calibrated models.
    #[must_use]
    pub fn of_half_spaces(layout: SliceLayout, bodies: HalfSpaces, most_lines: usize) -> Self {
        let elastic = (Elastic::HalfSpaces(bodies), [false; 2]);
        Self::of_elastic(layout, elastic, LocalContact::Calibrated, most_lines)
    }

    fn of_elastic(
        layout: SliceLayout,
        (elastic, walks): (Elastic, [bool; 2]),
        local_contact: LocalContact,
        most_lines: usize,
    ) -> Self {
        let capacity = most_lines * layout.slices;
        let empty = || Vec::with_capacity(capacity);
        let square = || vec![0.0; capacity * capacity];
        let keeps = walks.iter().any(|walks| *walks);
        Self {
            layout,
            elastic,
            local_contact,
            params: Params::default(),
            arch: pulp::Arch::new(),
            runs: Vec::with_capacity(capacity),
            slice: Vec::with_capacity(capacity),
            run: Vec::with_capacity(capacity),
            shares: empty(),
            c: square(),
            rates: [square(), square()],
            along: walks.map(|walks| if walks { square() } else { Vec::new() }),
            kept: KeptCompliance::with_capacity(if keeps { capacity } else { 0 }),
            own_compliance: empty(),
            local: Vec::with_capacity(capacity),
            separation_m: empty(),
            closing: empty(),
            lever_m: empty(),
            work: Workspace::new(capacity),
            rates_of_patches: RatesOfPatches::Unasked,
        }
    }

    /// Largest number of patches at once.
    pub fn capacity(&self) -> usize {
        self.work.capacity()
    }

    /// Slices per contact line.
    pub fn slices(&self) -> usize {
        self.layout.slices
    }

    /// Where the slices lie.
    pub fn layout(&self) -> &SliceLayout {
        &self.layout
    }

    /// Forgets the last solution: the next solve starts cold.
    pub fn reset(&mut self) {
        self.work.reset();
    }

    /// Lets the next solve at a given approach start from these forces \[N\], one for each patch; see
    /// [`Workspace::start_from`].
    pub fn start_from(&mut self, forces_n: &[f64]) {
        self.work.start_from(forces_n);
    }

    /// The patches that were prepared.
    #[must_use]
    pub fn prepared(&self) -> Prepared<'_> {
        let n = self.separation_m.len();
        Prepared {
            compliance: &self.c[..n * n],
            local: &self.local,
            separation_m: &self.separation_m,
            closing: &self.closing,
            lever_m: &self.lever_m,
        }
    }

    /// Where a patch that was prepared stands on gear 0 or 1.
    ///
    /// # Panics
    /// If there is no such patch.
    #[must_use]
    pub fn stands(&self, patch: usize, gear: usize) -> Standing<'_> {
        let run = &self.runs[self.run[patch]];
        Standing {
            place: &run.places[gear],
            slice: self.slice[patch],
            along_normal: run.along_normals[gear],
        }
    }

    /// The patches that were prepared by their places on gear 0 or 1.
    #[inline(always)]
    pub(crate) fn runs_on(&self, gear: usize) -> impl Iterator<Item = StandingRun<'_>> {
        self.runs.iter().map(move |run| StandingRun {
            patches: run.patches[0]..run.patches[1],
            slices: &self.slice[run.patches[0]..run.patches[1]],
            place: &run.places[gear],
            along_normal: run.along_normals[gear],
        })
    }

    /// Takes forces \[N\] that were found with those of other contacts as the solution of the patches that were
    /// prepared.
    pub fn accept(&mut self, forces_n: &[f64]) {
        self.work.start_from(forces_n);
        if self.rates_of_patches == RatesOfPatches::Asked {
            self.fill_rates();
        }
    }

    /// Takes R Rᵀ from the compliance of the patches that were prepared: what `columns` quantities of R,
    /// `[patch][column]` \[√(m/N)\], carry elsewhere, as the vibration modes of a gear body do.
    pub fn subtract_from_compliance(&mut self, rows: &[f64], columns: usize) {
        if columns == 0 {
            return;
        }
        let n = rows.len() / columns;
        for (i, a) in rows.chunks_exact(columns).enumerate() {
            for (j, b) in rows.chunks_exact(columns).enumerate().take(i + 1) {
                let shared = dot(a, b);
                self.c[i * n + j] -= shared;
                if i != j {
                    self.c[j * n + i] -= shared;
                }
            }
        }
    }

    /// Hertz contact of the patch with this number, and its edge.
    ///
    /// # Panics
    /// If there is no such patch.
    pub fn hertz(&self, patch: usize) -> (LineContact, Option<EdgeContact>) {
        let run = &self.runs[self.run[patch]];
        (run.contact, run.edge)
    }

    /// Normal forces \[N\] of the last solve, in the order of the patches.
    pub fn forces_n(&self) -> &[f64] {
        self.work.forces()
    }

    /// Change of the forces with the gaps, see [`Workspace::apply_tangent`].
    pub fn apply_tangent(&mut self, separation_change: &[f64], force_change: &mut [f64]) {
        self.work.apply_tangent(separation_change, force_change);
    }

    /// Makes compliance and local laws of the patches that face each other. `floor_n`: force below which the logarithm
    /// of the local law is continued by its tangent. `with_rates`: what [`Self::energy_by_u`] and
    /// [`Self::energy_by_share`] need; without edges.
    ///
    /// # Errors
    /// [`ContactError::TooMany`], and [`ContactError::LocalLaw`] with the teeth that have none.
    pub fn prepare(
        &mut self,
        patches: &[ContactPatch],
        floor_n: f64,
        with_rates: bool,
    ) -> Result<(), ContactError> {
        self.take(patches, floor_n, with_rates)?;
        self.fill();
        self.divide_by_shares();
        Ok(())
    }

    /// Takes the patches, their places and local laws.
    fn take(
        &mut self,
        patches: &[ContactPatch],
        floor_n: f64,
        with_rates: bool,
    ) -> Result<(), ContactError> {
        if patches.len() > self.capacity() {
            return Err(ContactError::TooMany {
                found: patches.len(),
                most: self.capacity(),
            });
        }
        self.rates_of_patches = match with_rates {
            true => RatesOfPatches::Asked,
            false => RatesOfPatches::Unasked,
        };
        for values in [
            &mut self.separation_m,
            &mut self.closing,
            &mut self.lever_m,
            &mut self.shares,
        ] {
            values.clear();
        }
        self.runs.clear();
        self.slice.clear();
        self.run.clear();
        self.local.clear();
        for (number, patch) in patches.iter().enumerate() {
            self.separation_m.push(patch.gap_m);
            self.closing.push(patch.balance.closing);
            self.lever_m.push(patch.balance.levers_m[1]);
            self.shares.push(patch.share);
            self.slice.push(patch.slice);
            let goes_on = self.shares_places() && number > 0 && patches[number - 1].is_like(patch);
            match self.runs.last_mut().filter(|_| goes_on) {
                Some(run) => run.patches[1] = number + 1,
                None => {
                    let run = self.begin_run((number, patch), floor_n, with_rates)?;
                    self.runs.push(run);
                }
            }
            let last = self.runs.len() - 1;
            self.run.push(last);
            self.local.push(self.runs[last].law);
        }
        Ok(())
    }

    fn begin_run(
        &self,
        (number, patch): (usize, &ContactPatch),
        floor_n: f64,
        with_rates: bool,
    ) -> Result<Run, ContactError> {
        let (places, depths, materials) = self.stand(patch);
        let body = |gear: usize| {
            let (youngs_modulus_pa, poisson_ratio) = materials[gear];
            ContactBody {
                youngs_modulus_pa,
                poisson_ratio,
                depth_m: depths[gear].depth_m,
            }
        };
        let contact = LineContact {
            width_m: patch.length_m,
            relative_radius_m: patch.radius_m,
            bodies: [body(0), body(1)],
        };
        let mut along_normals = [1.0; 2];
        if let Some(edge) = patch.edge {
            along_normals[edge.gear] = edge.tilt_rad.cos();
        }
        let edge =
            (patch.edge).and_then(|edge| EdgeContact::new(&contact, edge.tilt_rad, edge.radius_m));
        let law = (self.local_contact.law(&contact, floor_n))
            .map_err(|cause| ContactError::LocalLaw {
                teeth: patch.teeth,
                cause,
            })?
            .with_edge(edge);
        let rate = |gear: usize| {
            let growths = [depths[gear].growth_by_u, patch.radius_growth[gear]];
            let rate = self.local_contact.law_rate((&contact, &law), gear, growths);
            let longer = patch.length_growth[gear];
            if longer == 0.0 {
                return rate;
            }
            // α and β of a line load, as with the share of a slice.
            let deeper = [self.depth_by_length(); 2];
            let by_length = (self.local_contact).law_rate_by_share((&contact, &law), deeper, 1.0);
            rate.plus(longer, by_length)
        };
        let rates = if with_rates {
            [rate(0), rate(1)]
        } else {
            [LawRate::default(); 2]
        };
        Ok(Run {
            patches: [number, number + 1],
            teeth: patch.teeth,
            length_growth: patch.length_growth,
            places,
            along_normals,
            contact,
            edge,
            law,
            depths,
            rates,
        })
    }

    /// Solves for the forces of the patches that were prepared; returns the approach at which the first would touch,
    /// and the solver's figures. No allocation.
    ///
    /// # Errors
    /// [`ContactError::Nlcp`].
    pub fn solve(&mut self, drive: Drive) -> Result<(f64, Info), ContactError> {
        let n = self.separation_m.len();
        let problem = Problem::new(
            &self.c[..n * n],
            &self.local,
            &self.separation_m,
            &self.closing,
            &self.lever_m,
        )?;
        let info = match drive {
            Drive::Torque(load) => solve_load(&problem, load, &self.params, &mut self.work),
            Drive::TransmissionError(te_m) => {
                solve_position(&problem, -te_m, &self.params, &mut self.work)
            }
        }?;
        let first_contact = problem.first_contact();
        if self.rates_of_patches == RatesOfPatches::Asked {
            self.fill_rates();
        }
        Ok((first_contact, info))
    }

    /// Elastic energy \[J\] of the last solve: ½ FᵀCF and that of the local laws.
    pub fn stored_energy_j(&self) -> f64 {
        let forces = self.work.forces();
        let n = forces.len();
        let quadratic: f64 = (forces.iter().zip(self.c.chunks_exact(n.max(1))))
            .map(|(force, row)| force * dot(row, forces))
            .sum();
        let local: f64 = (self.local.iter().zip(forces))
            .map(|(law, force)| law.stored_energy(*force))
            .sum();
        0.5 * quadratic + local
    }
}

/// a·b.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
