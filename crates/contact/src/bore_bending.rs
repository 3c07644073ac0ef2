//! A gear body that bends over its bore, whose radial motions q something outside holds: rollers.
//!
//! ```text
//! flanks  g_i = … + Σ_j C_ij F_j + ŝ_i q          bore  Ŝ q = Σ_i ŝ_i F_i + N(q)
//! ```
//!
//! N are the forces of the support along the motions. About the last q they are N₀ − K (q − q₀); with M = Ŝ + K the
//! motions leave the problem of the flanks:
//!
//! ```text
//! q = M⁻¹ (N₀ + K q₀) + Σ_j M⁻¹ ŝ_j F_j,       C_ij + ŝ_i M⁻¹ ŝ_j,       e_i + ŝ_i M⁻¹ (N₀ + K q₀)
//! ```
//!
//! Theory: docs/theory/bore_patterns.md.

use gearmesh_model::{Flank, RadialMotions, ReducedGear, ReducedGearError};

use crate::axial_spread::AxialSpread;
use crate::nlcp::ldl::Ldl;
use crate::placed_slice::ToothPlace;
use crate::slice_compliance::loads_of_slices;
use crate::slice_contact::{SliceContact, dot};

/// How the slices of one mesh on a flank move with the radial motions of the bore.
#[derive(Debug, Clone)]
pub struct BoreFlank {
    slices: usize,
    stations: usize,
    /// `[tooth][station][slice][motion]`.
    rows: Vec<f64>,
}

impl BoreFlank {
    /// Of slices that are spread so along the teeth.
    ///
    /// # Errors
    /// [`ReducedGearError::FlankNotReduced`].
    pub fn new(
        gear: &ReducedGear,
        motions: &RadialMotions,
        (flank, spread): (Flank, &AxialSpread),
    ) -> Result<Self, ReducedGearError> {
        let (m, loads) = (motions.count(), gear.grid.len());
        let (index, hands) = (gear.flank_index(flank)?, gear.flanks.len());
        let of_slices = loads_of_slices(&gear.grid, spread);
        let mut rows = Vec::with_capacity(gear.teeth * of_slices.len() * m);
        for tooth in 0..gear.teeth {
            let first = (tooth * hands + index) * loads;
            for shares in &of_slices {
                let of_load = |load: usize| &motions.flank[(first + load) * m..][..m];
                let entry = |k: usize| {
                    let each = shares.iter().map(|&(l, share)| share * of_load(l)[k]);
                    each.sum::<f64>()
                };
                rows.extend((0..m).map(entry));
            }
        }
        Ok(Self {
            slices: spread.slices(),
            stations: gear.grid.roll_angles_rad.len(),
            rows,
        })
    }

    /// Adds the displacement along the inward normal per motion of a slice at a place, `scale` times, and its
    /// derivative by u.
    fn add(
        &self,
        (place, slice, scale): (&ToothPlace, usize, f64),
        row: &mut [f64],
        by_u: &mut [f64],
    ) {
        let m = row.len();
        let first = place.tooth * self.stations;
        let of_station = |station: usize| {
            let at = (first + station) * self.slices + slice;
            &self.rows[at * m..][..m]
        };
        for (into, shares) in [
            (row, place.place.all_shares()),
            (by_u, place.place.all_rates()),
        ] {
            for (k, share) in shares
                .iter()
                .enumerate()
                .filter(|(_, share)| **share != 0.0)
            {
                let values = of_station(place.place.first() + k);
                for (sum, value) in into.iter_mut().zip(values) {
                    *sum += scale * share * value;
                }
            }
        }
    }
}

/// The bore of one body: the sides of meshes that are on it, and its motions.
#[derive(Debug, Clone)]
pub struct BoreBending {
    stiffness: Vec<f64>,
    /// Number of a side, which gear of it the body is, and its flank.
    sides: Vec<(usize, usize, BoreFlank)>,
    /// ŝ, `[contact][motion]`, and its derivative by the place on the body.
    rows: Vec<f64>,
    rates: Vec<f64>,
    /// M⁻¹ ŝ.
    solved: Vec<f64>,
    /// M⁻¹ (N₀ + K q₀).
    rest_m: Vec<f64>,
    /// q \[m\].
    motions_m: Vec<f64>,
    factor: Ldl,
}

impl BoreBending {
    /// For up to so many contacts; `sides`: number of a side, gear 0 or 1 of it, its flank.
    #[must_use]
    pub fn new(
        motions: &RadialMotions,
        sides: Vec<(usize, usize, BoreFlank)>,
        capacity: usize,
    ) -> Self {
        let m = motions.count();
        let empty = || Vec::with_capacity(capacity * m);
        Self {
            stiffness: motions.stiffness.clone(),
            sides,
            rows: empty(),
            rates: empty(),
            solved: empty(),
            rest_m: vec![0.0; m],
            motions_m: vec![0.0; m],
            factor: Ldl::new(m),
        }
    }

    /// Number of motions.
    fn count(&self) -> usize {
        self.motions_m.len()
    }

    /// Its motions \[m\].
    #[must_use]
    pub fn motions_m(&self) -> &[f64] {
        &self.motions_m
    }

    /// The same to begin from.
    pub fn motions_mut(&mut self) -> &mut [f64] {
        &mut self.motions_m
    }

    /// Elastic energy of the body by its motions, ½ qᵀŜq \[J\].
    #[must_use]
    pub fn stored_energy_j(&self) -> f64 {
        let q = &self.motions_m;
        let rows = self.stiffness.chunks_exact(self.count().max(1));
        0.5 * rows.zip(q).map(|(row, q_i)| q_i * dot(row, q)).sum::<f64>()
    }

    pub(crate) fn lay(&mut self, contacts: usize) {
        let size = contacts * self.count();
        for values in [&mut self.rows, &mut self.rates, &mut self.solved] {
            values.clear();
            values.resize(size, 0.0);
        }
    }

    pub(crate) fn take(&mut self, side: usize, first: usize, contact: &SliceContact) {
        let m = self.count();
        for (_, gear, flank) in self.sides.iter().filter(|own| own.0 == side) {
            for i in 0..contact.prepared().separation_m.len() {
                let at = contact.stands(i, *gear);
                let own = (first + i) * m..(first + i + 1) * m;
                let (row, by_u) = (&mut self.rows[own.clone()], &mut self.rates[own]);
                flank.add((at.place, at.slice, at.along_normal), row, by_u);
            }
        }
    }

    /// Takes the forces of the support at the motions, and K: −∂N/∂q.
    ///
    /// # Errors
    /// The index of a pivot, where Ŝ + K is not positive.
    pub fn support(&mut self, force_n: &[f64], stiffness: &[f64]) -> Result<(), usize> {
        let m = self.count();
        let whole = &self.stiffness;
        let fill = |i: usize, row: &mut [f64]| {
            let from = i * m + i;
            for ((value, a), b) in row.iter_mut().zip(&whole[from..]).zip(&stiffness[from..]) {
                *value = a + b;
            }
        };
        self.factor.factor(m, fill).map_err(|pivot| pivot.index)?;
        for (i, rest) in self.rest_m.iter_mut().enumerate() {
            *rest = force_n[i] + dot(&stiffness[i * m..][..m], &self.motions_m);
        }
        self.factor.solve(&mut self.rest_m);
        self.solved.copy_from_slice(&self.rows);
        for row in self.solved.chunks_exact_mut(m) {
            if row.iter().any(|value| *value != 0.0) {
                self.factor.solve(row);
            }
        }
        Ok(())
    }

    /// Adds what the motions make of compliance and separations.
    pub(crate) fn soften(&self, c: &mut [f64], separation_m: &mut [f64]) {
        let m = self.count();
        let n = separation_m.len();
        for (i, row) in self.rows.chunks_exact(m).enumerate() {
            separation_m[i] += dot(row, &self.rest_m);
            for (j, solved) in self.solved.chunks_exact(m).enumerate().skip(i) {
                let value = dot(row, solved);
                c[i * n + j] += value;
                if i != j {
                    c[j * n + i] += value;
                }
            }
        }
    }

    /// Moves the bore as forces on the flanks have it.
    pub(crate) fn follow(&mut self, forces_n: &[f64]) {
        let m = self.count();
        self.motions_m.copy_from_slice(&self.rest_m);
        for (solved, force) in self.solved.chunks_exact(m).zip(forces_n) {
            if *force != 0.0 {
                for (q, value) in self.motions_m.iter_mut().zip(solved) {
                    *q += force * value;
                }
            }
        }
    }

    /// Adds how the energy between flanks and bore changes as contacts walk, F ∂ŝ/∂u q, `[contact][gear]`.
    pub(crate) fn walk(&self, starts: &[usize], forces_n: &[f64], energy_by_u: &mut [[f64; 2]]) {
        let m = self.count();
        for (side, gear, _) in &self.sides {
            for i in starts[*side]..starts[side + 1] {
                let by_u = dot(&self.rates[i * m..][..m], &self.motions_m);
                energy_by_u[i][*gear] += forces_n[i] * by_u;
            }
        }
    }

    /// M⁻¹ v, in place.
    pub fn follow_force(&self, values: &mut [f64]) {
        self.factor.solve(values);
    }

    /// ŝ_i · v of a contact.
    #[must_use]
    pub fn gap_by(&self, contact: usize, values: &[f64]) -> f64 {
        dot(&self.rows[contact * self.count()..][..self.count()], values)
    }
}
