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
use crate::nlcp::ldl::dot;
use crate::nlcp::{Info, LocalLaw, Params, Problem, Workspace, solve_position};
use crate::profile_shares::SHARES;
use crate::slice_contact::SliceContact;
use crate::station_blocks::{LANES, SummedBlocks, whole};

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
    parts: [[f64; SHARES]; LANES],
    sum: SummedBlocks,
    links: Vec<MeshLink>,
    /// First contact of each side, and the end of the last one.
    starts: Vec<usize>,
    c: Vec<f64>,
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
    /// See [`Self::energy_by_u`].
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
            parts: [[0.0; SHARES]; LANES],
            sum: SummedBlocks::default(),
            links,
            starts: Vec::new(),
            c: Vec::with_capacity(capacity * capacity),
            local: Vec::with_capacity(capacity),
            separation_m: empty(),
            closing: empty(),
            lever_m: empty(),
            begin_n: empty(),
            work: Workspace::new(capacity),
            params: Params {
                keeps_factor: true,
                ..Params::default()
            },
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
        let (n, own) = (self.size(), &self.links[link]);
        self.arch.dispatch(Couple {
            link: own,
            contacts,
            starts: own.sides.map(|side| self.starts[side]),
            c: &mut self.c,
            size: n,
            parts: &mut self.parts,
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
        let (n, forces) = (self.size(), self.work.forces());
        self.bores.iter_mut().for_each(|bore| bore.follow(forces));
        for side in 0..self.starts.len() - 1 {
            let own = self.starts[side]..self.starts[side + 1];
            for i in own.clone() {
                let row = &self.c[i * n..][..n];
                let before = dot(&row[..own.start], &forces[..own.start]);
                self.felt_m[i] = before + dot(&row[own.end..], &forces[own.end..]);
            }
        }
        Ok(info)
    }

    /// After [`Self::solve`]: how the energy between the sides of a link changes as contacts walk.
    pub fn walk(&mut self, link: usize, contacts: [&SliceContact; 2]) {
        let own = &self.links[link];
        self.arch.dispatch(Walk {
            link: own,
            contacts,
            starts: own.sides.map(|side| self.starts[side]),
            forces_n: self.work.forces(),
            energy_by_u: &mut self.energy_by_u,
            sum: &mut self.sum,
        });
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

    /// ∂E*/∂u on gear 0 and gear 1 \[J per u\], the part between sides: that of contacts at one place in sum, at the
    /// first of them that carries.
    #[must_use]
    pub fn energy_by_u(&self) -> &[[f64; 2]] {
        &self.energy_by_u
    }

    /// K a: by how much forces \[N\] are smaller for gaps that are felt wider by a \[m\].
    ///
    /// # Errors
    /// [`ContactError::Nlcp`].
    pub fn drag(&mut self, ahead_m: &[f64], drag_n: &mut Vec<f64>) -> Result<(), ContactError> {
        drag_n.clear();
        drag_n.resize(self.size(), 0.0);
        if self.work.active().is_empty() || ahead_m.iter().all(|ahead| *ahead == 0.0) {
            return Ok(());
        }
        let (c, separation_m) = soft(&self.bores, (&self.c, &self.separation_m), &self.softened);
        let balance = (&self.closing[..], &self.lever_m[..]);
        let problem = Problem::known(c, &self.local, separation_m, balance);
        (self.work).apply_present_tangent(&problem, ahead_m, drag_n)?;
        drag_n.iter_mut().for_each(|force| *force = -*force);
        Ok(())
    }

    /// Computes −∂F/∂gap of all contacts.
    ///
    /// # Errors
    /// [`ContactError::Nlcp`].
    pub fn fill_stiffness(&mut self) -> Result<(), ContactError> {
        let (c, separation_m) = soft(&self.bores, (&self.c, &self.separation_m), &self.softened);
        let balance = (&self.closing[..], &self.lever_m[..]);
        let problem = Problem::known(c, &self.local, separation_m, balance);
        self.work.factor_present(&problem)?;
        (self.work).stiffness(&mut self.inverse, &mut self.stiffness);
        Ok(())
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
    parts: &'a mut [[f64; SHARES]; LANES],
}

impl pulp::NullaryFnOnce for Couple<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let MeshLink {
            gears, compliance, ..
        } = self.link;
        let [first, second] = self.contacts;
        for a in first.runs_on(gears[0]) {
            for b in second.runs_on(gears[1]) {
                let blocks = compliance.at([a.place, b.place]);
                let weights = blocks.weights();
                let along = a.along_normal * b.along_normal;
                for (i, slice) in a.patches.clone().zip(a.slices) {
                    let here = self.starts[0] + i;
                    let mut across = self.starts[1] + b.patches.start;
                    for others in b.slices.chunks(LANES) {
                        blocks.compliances(&weights, *slice, others, self.parts);
                        for parts in &self.parts[..others.len()] {
                            let value = along * whole(parts);
                            self.c[here * self.size + across] += value;
                            self.c[across * self.size + here] += value;
                            across += 1;
                        }
                    }
                }
            }
        }
    }
}

/// [`JointContact::walk`], to be compiled for what the processor has: ½ Fᵀ ∂C F of all contacts at two places by Σ
/// F_i F_j T_ij.
struct Walk<'a> {
    link: &'a MeshLink,
    contacts: [&'a SliceContact; 2],
    starts: [usize; 2],
    forces_n: &'a [f64],
    energy_by_u: &'a mut [[f64; 2]],
    sum: &'a mut SummedBlocks,
}

impl pulp::NullaryFnOnce for Walk<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let MeshLink {
            gears, compliance, ..
        } = self.link;
        let [first, second] = self.contacts;
        for a in first.runs_on(gears[0]) {
            let forces_a = &self.forces_n[self.starts[0]..][a.patches.clone()];
            let Some(at_a) = forces_a.iter().position(|force| *force > 0.0) else {
                continue;
            };
            for b in second.runs_on(gears[1]) {
                let forces_b = &self.forces_n[self.starts[1]..][b.patches.clone()];
                let Some(at_b) = forces_b.iter().position(|force| *force > 0.0) else {
                    continue;
                };
                let blocks = compliance.at([a.place, b.place]);
                *self.sum = SummedBlocks::default();
                for (slice, force_a) in a.slices.iter().zip(forces_a) {
                    for (other, force_b) in b.slices.iter().zip(forces_b) {
                        let both = force_a * force_b;
                        if both > 0.0 {
                            blocks.add_to(self.sum, both, [*slice, *other]);
                        }
                    }
                }
                let along = a.along_normal * b.along_normal;
                let [by_a, by_b] = blocks.rates_of(self.sum);
                let (at_a, at_b) = (a.patches.start + at_a, b.patches.start + at_b);
                self.energy_by_u[self.starts[0] + at_a][gears[0]] += along * by_a;
                self.energy_by_u[self.starts[1] + at_b][gears[1]] += along * by_b;
            }
        }
    }
}
