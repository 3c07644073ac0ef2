//! The contacts of several meshes that share gear bodies, solved together as one complementarity problem.
//!
//! ```text
//! g_A = C_AA F_A + δ(F_A) + e_A + Σ_B C_AB F_B          C_AB = Σ_(bodies of A and B) Φ_Aᵀ C_hub Φ_B
//! ```
//!
//! Each mesh side has its own compliance and laws ([`SliceContact`]); what it feels of another one comes in by the body
//! that both are on ([`CrossCompliance`]).

use std::sync::Arc;

use crate::bore_bending::BoreBending;
use crate::contact_error::ContactError;
use crate::cross_compliance::CrossCompliance;
use crate::nlcp::{Info, LocalLaw, Params, Problem, Workspace, solve_position};
use crate::place_blocks::BetweenPlaces;
use crate::slice_contact::SliceContact;

/// Two sides on one body.
#[derive(Debug, Clone)]
pub struct MeshLink {
    /// Their numbers.
    pub sides: [usize; 2],
    /// Which gear the body is of each, 0 or 1.
    pub gears: [usize; 2],
    /// What the body deflects at the first under the forces of the second.
    pub compliance: Arc<CrossCompliance>,
}

/// Contacts of several sides, with all memory that a solve needs. Steps of a solution: [`Self::lay`], [`Self::take`]
/// and [`Self::couple`] for each side and link, [`Self::solve`].
#[derive(Debug, Clone)]
pub struct JointContact {
    /// What the processor has for the loops over coupled places; results do not depend on it.
    arch: pulp::Arch,
    found: BetweenPlaces,
    links: Vec<MeshLink>,
    /// First contact of each side, and the end of the last one.
    starts: Vec<usize>,
    c: Vec<f64>,
    /// What [`Self::couple`] found for [`Self::walk`]: how the compliance of contacts of one side and the other changes
    /// with both places, link after link.
    couplings: Vec<[f64; 2]>,
    /// Where those of each link begin.
    coupling_starts: Vec<usize>,
    local: Vec<LocalLaw>,
    separation_m: Vec<f64>,
    closing: Vec<f64>,
    lever_m: Vec<f64>,
    begin_n: Vec<f64>,
    work: Workspace,
    params: Params,
    /// −∂F/∂gap, `[force][gap]`.
    stiffness: Vec<f64>,
    inverse: Vec<f64>,
    /// Σ_B C_AB F_B of each contact \[m\].
    felt_m: Vec<f64>,
    /// How the energy between sides changes as a contact walks over the flank of gear 0 or 1 \[J per u\].
    energy_by_u: Vec<[f64; 2]>,
    /// Bodies that bend over their bores.
    bores: Vec<BoreBending>,
    /// Compliance and separations with what bores make of them.
    softened: (Vec<f64>, Vec<f64>),
}

impl JointContact {
    /// For up to so many contacts.
    #[must_use]
    pub fn new(links: Vec<MeshLink>, capacity: usize) -> Self {
        let empty = || Vec::with_capacity(capacity);
        Self {
            arch: pulp::Arch::new(),
            found: BetweenPlaces::default(),
            coupling_starts: vec![0; links.len()],
            links,
            starts: Vec::new(),
            c: Vec::with_capacity(capacity * capacity),
            couplings: Vec::with_capacity(capacity * capacity),
            local: Vec::with_capacity(capacity),
            separation_m: empty(),
            closing: empty(),
            lever_m: empty(),
            begin_n: empty(),
            work: Workspace::new(capacity),
            params: Params::default(),
            stiffness: Vec::with_capacity(capacity * capacity),
            inverse: Vec::with_capacity(capacity * capacity),
            felt_m: empty(),
            energy_by_u: Vec::with_capacity(capacity),
            bores: Vec::new(),
            softened: (Vec::new(), Vec::new()),
        }
    }

    /// Adds bodies that bend over their bores.
    #[must_use]
    pub fn with_bores(mut self, bores: Vec<BoreBending>) -> Self {
        if !bores.is_empty() {
            let capacity = self.work.capacity();
            let empty = Vec::with_capacity;
            self.softened = (empty(capacity * capacity), empty(capacity));
        }
        self.bores = bores;
        self
    }

    /// Bodies that bend over their bores.
    #[must_use]
    pub fn bores(&self) -> &[BoreBending] {
        &self.bores
    }

    /// The same to be supported.
    pub fn bores_mut(&mut self) -> &mut [BoreBending] {
        &mut self.bores
    }

    /// The links.
    #[must_use]
    pub fn links(&self) -> &[MeshLink] {
        &self.links
    }

    /// Begins with sides of so many contacts each.
    pub fn lay(&mut self, sizes: impl Iterator<Item = usize>) {
        self.starts.clear();
        self.starts.push(0);
        let mut end = 0;
        for size in sizes {
            end += size;
            self.starts.push(end);
        }
        self.c.clear();
        self.c.resize(end * end, 0.0);
        self.couplings.clear();
        self.coupling_starts.fill(0);
        self.local.clear();
        for values in [
            &mut self.separation_m,
            &mut self.closing,
            &mut self.lever_m,
            &mut self.begin_n,
        ] {
            values.clear();
        }
        self.felt_m.clear();
        self.felt_m.resize(end, 0.0);
        self.energy_by_u.clear();
        self.energy_by_u.resize(end, [0.0; 2]);
        self.bores.iter_mut().for_each(|bore| bore.lay(end));
    }

    /// Number of contacts.
    #[must_use]
    pub fn size(&self) -> usize {
        self.starts.last().copied().unwrap_or_default()
    }

    /// The contacts of a side.
    #[must_use]
    pub fn contacts_of(&self, side: usize) -> std::ops::Range<usize> {
        self.starts[side]..self.starts[side + 1]
    }

    /// Takes a side that was prepared, the next one in their order; `begin_n`: forces to start from.
    pub fn take(&mut self, side: usize, contact: &SliceContact, begin_n: &[f64]) {
        let (n, own) = (self.size(), self.contacts_of(side));
        let problem = contact.prepared();
        for (row, values) in own
            .clone()
            .zip(problem.compliance.chunks_exact(own.len().max(1)))
        {
            self.c[row * n..][own.clone()].copy_from_slice(values);
        }
        self.local.extend_from_slice(problem.local);
        self.separation_m.extend_from_slice(problem.separation_m);
        self.closing.extend_from_slice(problem.closing);
        self.lever_m.extend_from_slice(problem.lever_m);
        self.begin_n.extend_from_slice(begin_n);
        for bore in &mut self.bores {
            bore.take(side, own.start, contact);
        }
    }

    /// Takes what the body of a link deflects between its sides.
    pub fn couple(&mut self, link: usize, contacts: [&SliceContact; 2]) {
        self.coupling_starts[link] = self.couplings.len();
        let (n, own) = (self.size(), &self.links[link]);
        self.arch.dispatch(Couple {
            link: own,
            contacts,
            starts: own.sides.map(|side| self.starts[side]),
            c: &mut self.c,
            size: n,
            found: &mut self.found,
            rates: &mut self.couplings,
        });
    }

    /// Solves for all forces where the gaps stand; `goes_on`: from those of the last solution, if it was of as many
    /// contacts, not from those that were taken.
    ///
    /// # Errors
    /// [`ContactError::Nlcp`].
    pub fn solve(&mut self, goes_on: bool) -> Result<Info, ContactError> {
        if !self.bores.is_empty() {
            let (softened, shifted) = &mut self.softened;
            softened.clone_from(&self.c);
            shifted.clone_from(&self.separation_m);
            for bore in &self.bores {
                bore.soften(softened, shifted);
            }
        }
        let (c, separation_m) = soft(&self.bores, (&self.c, &self.separation_m), &self.softened);
        let balance = (&self.closing[..], &self.lever_m[..]);
        let problem = Problem::of_symmetric(c, &self.local, separation_m, balance)?;
        let known = self.begin_n.iter().any(|force| *force > 0.0);
        match goes_on && self.work.forces().len() == self.begin_n.len() {
            true => {}
            false if known => self.work.start_from(&self.begin_n),
            false => self.work.reset(),
        }
        let info = solve_position(&problem, 0.0, &self.params, &mut self.work)?;
        let forces = self.work.forces();
        self.bores.iter_mut().for_each(|bore| bore.follow(forces));
        self.arch.dispatch(Feel {
            c: &self.c,
            starts: &self.starts,
            forces_n: forces,
            felt_m: &mut self.felt_m,
        });
        Ok(info)
    }

    /// After [`Self::solve`]: how the energy between the sides of a link changes as contacts walk.
    pub fn walk(&mut self, link: usize, contacts: [&SliceContact; 2]) {
        let MeshLink { sides, gears, .. } = self.links[link];
        let [on_a, on_b] = sides.map(|side| self.contacts_of(side));
        let rates = &self.couplings[self.coupling_starts[link]..];
        let forces = self.work.forces();
        for ((i, at_a), rates) in (on_a.enumerate()).zip(rates.chunks_exact(on_b.len().max(1))) {
            if forces[at_a] == 0.0 {
                continue;
            }
            let along_a = contacts[0].stands(i, gears[0]).along_normal;
            for ((j, at_b), [by_a, by_b]) in on_b.clone().enumerate().zip(rates) {
                let both = forces[at_a] * forces[at_b];
                if both == 0.0 {
                    continue;
                }
                let both = both * along_a * contacts[1].stands(j, gears[1]).along_normal;
                self.energy_by_u[at_a][gears[0]] += both * by_a;
                self.energy_by_u[at_b][gears[1]] += both * by_b;
            }
        }
    }

    /// After [`Self::solve`]: the same of the energy between flanks and bores.
    pub fn walk_bores(&mut self) {
        for bore in &self.bores {
            bore.walk(&self.starts, self.work.forces(), &mut self.energy_by_u);
        }
    }

    /// Forces of all contacts \[N\].
    #[must_use]
    pub fn forces_n(&self) -> &[f64] {
        self.work.forces()
    }

    /// Of each contact the deflection by the forces of other sides \[m\].
    #[must_use]
    pub fn felt_m(&self) -> &[f64] {
        &self.felt_m
    }

    /// Of each contact ∂E*/∂u on gear 0 and gear 1 \[J per u\], the part between sides.
    #[must_use]
    pub fn energy_by_u(&self) -> &[[f64; 2]] {
        &self.energy_by_u
    }

    /// K a: by how much forces \[N\] are smaller for gaps that are felt wider by a \[m\].
    pub fn drag(&mut self, ahead_m: &[f64], drag_n: &mut Vec<f64>) {
        drag_n.clear();
        drag_n.resize(self.size(), 0.0);
        if !self.work.active().is_empty() && ahead_m.iter().any(|ahead| *ahead != 0.0) {
            self.work.apply_tangent(ahead_m, drag_n);
            drag_n.iter_mut().for_each(|force| *force = -*force);
        }
    }

    /// Computes −∂F/∂gap of all contacts.
    pub fn fill_stiffness(&mut self) {
        (self.work).stiffness(&mut self.inverse, &mut self.stiffness);
    }

    /// −∂F/∂gap of one force by all gaps \[N/m\], after [`Self::fill_stiffness`].
    #[must_use]
    pub fn stiffness_of(&self, contact: usize) -> &[f64] {
        let n = self.size();
        &self.stiffness[contact * n..][..n]
    }
}

/// Compliance and separations with what bores make of them.
fn soft<'a>(
    bores: &[BoreBending],
    (c, separation_m): (&'a [f64], &'a [f64]),
    (softened, shifted): &'a (Vec<f64>, Vec<f64>),
) -> (&'a [f64], &'a [f64]) {
    match bores.is_empty() {
        true => (c, separation_m),
        false => (softened, shifted),
    }
}

/// [`JointContact::couple`], to be compiled for what the processor has.
struct Couple<'a> {
    link: &'a MeshLink,
    contacts: [&'a SliceContact; 2],
    starts: [usize; 2],
    c: &'a mut [f64],
    size: usize,
    found: &'a mut BetweenPlaces,
    /// How each changes with the first and with the second place.
    rates: &'a mut Vec<[f64; 2]>,
}

impl pulp::NullaryFnOnce for Couple<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let MeshLink {
            gears, compliance, ..
        } = self.link;
        let [first, second] = self.contacts;
        let (begin, columns) = (self.rates.len(), second.prepared().separation_m.len());
        let rows = first.prepared().separation_m.len();
        self.rates.resize(begin + rows * columns, [0.0; 2]);
        for a in first.runs_on(gears[0]) {
            for b in second.runs_on(gears[1]) {
                compliance.between([a.place, b.place], self.found);
                let along = a.along_normal * b.along_normal;
                let across = self.starts[1] + b.patches.start;
                for (i, slice) in a.patches.clone().zip(a.slices) {
                    let here = self.starts[0] + i;
                    let row = &mut self.c[here * self.size + across..][..b.slices.len()];
                    let rates = &mut self.rates[begin + i * columns + b.patches.start..];
                    for ((place, rate), other) in row.iter_mut().zip(rates).zip(b.slices) {
                        let entry = compliance.entry([*slice, *other]);
                        *place += along * self.found.value[entry];
                        *rate = [self.found.by_a[entry], self.found.by_b[entry]];
                    }
                    for j in across..across + b.slices.len() {
                        self.c[j * self.size + here] = self.c[here * self.size + j];
                    }
                }
            }
        }
    }
}

/// What the contacts of each side deflect by under the forces of the others, to be compiled for what the processor has.
struct Feel<'a> {
    c: &'a [f64],
    starts: &'a [usize],
    forces_n: &'a [f64],
    felt_m: &'a mut [f64],
}

impl pulp::NullaryFnOnce for Feel<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let n = self.forces_n.len();
        self.felt_m.fill(0.0);
        for own in self.starts.windows(2) {
            let rows = self.c[own[0] * n..own[1] * n].chunks_exact(n.max(1));
            for (row, &force) in rows.zip(&self.forces_n[own[0]..own[1]]) {
                if force == 0.0 {
                    continue;
                }
                // C is symmetric, its rows are contiguous.
                for range in [0..own[0], own[1]..n] {
                    let pairs = self.felt_m[range.clone()].iter_mut().zip(&row[range]);
                    pairs.for_each(|(felt, c)| *felt += c * force);
                }
            }
        }
    }
}
