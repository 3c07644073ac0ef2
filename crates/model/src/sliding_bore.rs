//! A gear whose bore slides on a rigid pin: the compliance of its flanks with the motions of the bore that no force
//! holds.
//!
//! ```text
//! S_oo q_o = s_oᵀ f,      C = C_hub + s_o S_oo⁻¹ s_oᵀ,      ε = a f + γ_o q_o = (a + γ_o S_oo⁻¹ s_oᵀ) f
//! ```
//!
//! o: tangential and axial motions but the rigid ones; f: normal loads, a: a gauge's strain with the bore held, γ: its
//! strain per motion. What friction on the flanks moves the bore by is left out.
//!
//! Radial motions are held, as by a pin that presses and pulls; for rollers, which let them go,
//!
//! ```text
//! Ŝ = S_rr − S_ro S_oo⁻¹ S_or,      ŝ = s_r − s_o S_oo⁻¹ S_or,      γ̂ = γ_r − γ_o S_oo⁻¹ S_or
//! ```
//!
//! is what they have to do with forces on the bore, with the flanks and with the gauges. The uniform tangential and the
//! uniform axial motion belong to the motion of the body. Theory: docs/theory/bore_patterns.md.

use gearmesh_geometry::Flank;

use crate::bore_patterns::{BoreMotion, BorePatterns, legendre, place_along};
use crate::reduced_gear::ReducedGear;
use crate::reduced_gear_error::ReducedGearError;

/// A gear whose bore slides, and the radial motions of the bore that its support holds or lets go.
#[derive(Debug, Clone, PartialEq)]
pub struct SlidingBore {
    /// The gear as its flanks and gauges feel it where all radial motions are held. Modes and the bore's motions, which
    /// are those of a held bore, are left out.
    pub gear: ReducedGear,
    /// The radial motions.
    pub radial: RadialMotions,
}

/// Radial motions of a bore that slides: those that bend the body. Its rigid ones, shifts across the axis and tilts,
/// are left out: they belong to the motion of the body, whose bore has none of cos φ and sin φ in its mean along the
/// axis and, in space, in the slope along it.
#[derive(Debug, Clone, PartialEq)]
pub struct RadialMotions {
    /// Polynomials along the bore.
    pub along: usize,
    /// Radius of the bore (m).
    pub radius_m: f64,
    /// Its back and front (m).
    pub ends_m: [f64; 2],
    /// Wave and degree of each, as in [`BorePatterns`](crate::BorePatterns).
    pub motions: Vec<[usize; 2]>,
    /// Force along a motion per another one (N/m), `[motion][motion]`; positive definite.
    pub stiffness: Vec<f64>,
    /// Displacement along the inward normal per motion, `[tooth][flank][load][motion]`.
    pub flank: Vec<f64>,
    /// Strain of the model's gauges per motion (1/m), `[gauge][motion]`.
    pub gauges: Vec<f64>,
}

impl RadialMotions {
    /// Number of motions.
    #[must_use]
    pub fn count(&self) -> usize {
        self.motions.len()
    }

    /// Values of the polynomials at a place along the bore.
    #[must_use]
    pub fn polynomials(&self, z_m: f64) -> Vec<f64> {
        legendre(place_along(self.ends_m, z_m), self.along)
    }
}

impl ReducedGear {
    /// The gear with a bore that slides.
    ///
    /// # Errors
    /// [`ReducedGearError::NoBoreMotions`] for a model without motions of its bore, [`ReducedGearError::BoreStiffness`]
    /// if their stiffness is not positive.
    pub fn with_sliding_bore(&self) -> Result<SlidingBore, ReducedGearError> {
        let Some(bore) = &self.bore else {
            let gear = self.name.clone();
            return Err(ReducedGearError::NoBoreMotions { gear });
        };
        let (m, loads) = (bore.count(), self.grid.len());
        let (free, bends) = bore.loose();
        let (n, count) = (free.len(), bends.len());
        let entry = |i: usize, j: usize| bore.stiffness[i * m + j];
        let not_positive = || ReducedGearError::BoreStiffness {
            gear: self.name.clone(),
        };
        let factor = cholesky(n, |i, j| entry(free[i], free[j])).ok_or_else(not_positive)?;
        // L⁻¹ S_or of each radial motion, `[motion][free]`.
        let mut moved = Vec::with_capacity(count * n);
        for &bend in &bends {
            let begin = moved.len();
            moved.extend(free.iter().map(|&motion| entry(motion, bend)));
            forward(&factor, &mut moved[begin..]);
        }
        let moved_by = |k: usize| &moved[k * n..(k + 1) * n];
        let stiffness: Vec<f64> = (0..count)
            .flat_map(|i| (0..count).map(move |j| (i, j)))
            .map(|(i, j)| entry(bends[i], bends[j]) - dot(moved_by(i), moved_by(j)))
            .collect();
        cholesky(count, |i, j| stiffness[i * count + j]).ok_or_else(not_positive)?;
        // L⁻¹ s_oᵀ of each flank, `[tooth][flank][load][motion]`: a product of two is what the bore's motions add.
        let rows = self.teeth * self.flanks.len() * loads;
        let mut halves = Vec::with_capacity(rows * n);
        let mut flank = Vec::with_capacity(rows * count);
        for tooth in 0..self.teeth {
            for hand in &self.flanks {
                let rows = self.bore_rows(tooth, *hand).unwrap_or_default();
                for row in rows.chunks_exact(m) {
                    let begin = halves.len();
                    halves.extend(free.iter().map(|&motion| row[motion]));
                    forward(&factor, &mut halves[begin..]);
                    let half = &halves[begin..];
                    let radial = bends.iter().enumerate();
                    flank.extend(radial.map(|(k, &bend)| row[bend] - dot(half, moved_by(k))));
                }
            }
        }
        let mut strains = Vec::with_capacity(self.gauges.len() * count);
        let mut gauges = self.gauges.clone();
        for (gauge, motions) in gauges.iter_mut().zip(bore.gauges.chunks_exact(m)) {
            let mut half: Vec<f64> = free.iter().map(|&motion| motions[motion]).collect();
            forward(&factor, &mut half);
            let of_loads = gauge.adjoint.chunks_exact_mut(3);
            for (strain, load) in of_loads.zip(halves.chunks_exact(n)) {
                strain[0] += dot(load, &half);
            }
            let radial = bends.iter().enumerate();
            strains.extend(radial.map(|(k, &bend)| motions[bend] - dot(&half, moved_by(k))));
        }
        Ok(SlidingBore {
            gear: ReducedGear {
                gauges,
                ..self.softened(&halves, n)
            },
            radial: RadialMotions {
                along: bore.along,
                radius_m: bore.radius_m,
                ends_m: bore.ends_m,
                motions: bends
                    .iter()
                    .map(|k| [k / bore.along, k % bore.along])
                    .collect(),
                stiffness,
                flank,
                gauges: strains,
            },
        })
    }

    /// All motions of the bore \[m\] under forces on the flanks, where the radial ones that bend the body are
    /// `radial_m`, in the order of [`RadialMotions`]; none: they are held, the bore slides. Of each force tooth, flank,
    /// load and normal part \[N\]. Rigid motions are left out.
    ///
    /// # Errors
    /// As [`ReducedGear::with_sliding_bore`]; [`ReducedGearError::FlankNotReduced`].
    ///
    /// # Panics
    /// If there are more or fewer radial motions than bend the body, or no such tooth or load.
    pub fn bore_motions_m(
        &self,
        forces: &[(usize, Flank, usize, f64)],
        radial_m: &[f64],
    ) -> Result<Vec<f64>, ReducedGearError> {
        let Some(bore) = &self.bore else {
            let gear = self.name.clone();
            return Err(ReducedGearError::NoBoreMotions { gear });
        };
        let m = bore.count();
        let (free, bends) = bore.loose();
        let mut motions = vec![0.0; m];
        if !radial_m.is_empty() {
            assert_eq!(radial_m.len(), bends.len(), "radial motions of a bore");
        }
        for (&bend, q) in bends.iter().zip(radial_m) {
            motions[bend] = *q;
        }
        let held = |&i: &usize| -dot(&bore.stiffness[i * m..][..m], &motions);
        let mut push: Vec<f64> = free.iter().map(held).collect();
        for &(tooth, flank, load, normal_n) in forces {
            self.flank_index(flank)?;
            let rows = self.bore_rows(tooth, flank).unwrap_or_default();
            for (sum, &motion) in push.iter_mut().zip(&free) {
                *sum += normal_n * rows[load * m + motion];
            }
        }
        let entry = |i: usize, j: usize| bore.stiffness[free[i] * m + free[j]];
        let not_positive = || ReducedGearError::BoreStiffness {
            gear: self.name.clone(),
        };
        let factor = cholesky(free.len(), entry).ok_or_else(not_positive)?;
        forward(&factor, &mut push);
        backward(&factor, &mut push);
        for (&motion, q) in free.iter().zip(&push) {
            motions[motion] = *q;
        }
        Ok(motions)
    }

    /// The gear without motions of its bore, its compliance larger by the products of `halves`, n of each
    /// `[tooth][flank][load]`.
    fn softened(&self, halves: &[f64], n: usize) -> Self {
        let (loads, own) = (self.grid.len(), self.teeth_per_sector());
        let of_flank = loads * n;
        let half = |flank: usize| &halves[flank * of_flank..(flank + 1) * of_flank];
        let mut c_hub = self.c_hub_in_full().into_owned();
        let flanks = self.flanks.len();
        let blocks = c_hub.chunks_exact_mut(loads * loads).enumerate();
        for (number, block) in blocks {
            let (load, response) = (
                number / (self.teeth * flanks),
                number % (self.teeth * flanks),
            );
            assert!(load < own * flanks);
            let pressed = half(load).chunks_exact(n);
            for (row, a) in block.chunks_exact_mut(loads).zip(pressed) {
                for (value, b) in row.iter_mut().zip(half(response).chunks_exact(n)) {
                    *value += dot(a, b);
                }
            }
        }
        Self {
            c_hub,
            hub_patterns: None,
            gauges: Vec::new(),
            modes: None,
            bore: None,
            ..self.clone()
        }
    }
}

impl BorePatterns {
    /// Numbers of the motions that no force holds where a bore slides, and of the radial ones that bend the body.
    fn loose(&self) -> (Vec<usize>, Vec<usize>) {
        let in_space = self.components > 2;
        let mut free: Vec<usize> = self.motions_of(BoreMotion::Tangential).skip(1).collect();
        if in_space {
            free.extend(self.motions_of(BoreMotion::Axial).skip(1));
        }
        // cos φ and sin φ, constant and, in space, linear along the bore: rigid.
        let is_rigid = |place: usize| {
            let (wave, degree) = (place / self.along, place % self.along);
            (1..=2).contains(&wave) && degree < if in_space { 2 } else { 1 }
        };
        let radial = self.motions_of(BoreMotion::Radial);
        let first = radial.start;
        let bends = radial.filter(|motion| !is_rigid(motion - first)).collect();
        (free, bends)
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// L of a symmetric matrix = L Lᵀ, row by row; none if it is not positive.
fn cholesky(n: usize, entry: impl Fn(usize, usize) -> f64) -> Option<Vec<Vec<f64>>> {
    let mut rows: Vec<Vec<f64>> = Vec::with_capacity(n);
    for i in 0..n {
        let mut row: Vec<f64> = Vec::with_capacity(i + 1);
        for j in 0..=i {
            let other = rows.get(j).map_or(&row[..], |row| &row[..j]);
            let passed: f64 = row.iter().zip(other).map(|(a, b)| a * b).sum();
            let value = entry(i, j) - passed;
            if j < i {
                row.push(value / rows[j][j]);
            } else if value > 1e-12 * entry(i, i) {
                row.push(value.sqrt());
            } else {
                return None;
            }
        }
        rows.push(row);
    }
    Some(rows)
}

/// L⁻¹ v.
fn forward(factor: &[Vec<f64>], v: &mut [f64]) {
    for (i, row) in factor.iter().enumerate() {
        let passed: f64 = row[..i].iter().zip(&*v).map(|(a, b)| a * b).sum();
        v[i] = (v[i] - passed) / row[i];
    }
}

/// L⁻ᵀ v.
fn backward(factor: &[Vec<f64>], v: &mut [f64]) {
    for i in (0..factor.len()).rev() {
        v[i] /= factor[i][i];
        let value = v[i];
        for (rest, entry) in v[..i].iter_mut().zip(&factor[i]) {
            *rest -= value * entry;
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use crate::made_up_models::{small_bored_gear, small_reduced_gear};

    /// x of A x = b by Gauss-Jordan, A positive.
    fn solved(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Vec<f64> {
        for i in 0..b.len() {
            for k in 0..b.len() {
                if k != i {
                    let factor = a[k][i] / a[i][i];
                    let from = a[i].clone();
                    for (value, other) in a[k].iter_mut().zip(&from) {
                        *value -= factor * other;
                    }
                    b[k] -= factor * b[i];
                }
            }
        }
        b.iter()
            .enumerate()
            .map(|(i, value)| value / a[i][i])
            .collect()
    }

    /// Each entry by its formula, with the equation solved another way. 1e-12 of what is added.
    #[test]
    fn a_sliding_bore_adds_what_its_free_motions_do() {
        let gear = small_bored_gear();
        let released = gear.with_sliding_bore().unwrap().gear;
        let bore = gear.bore.as_ref().unwrap();
        let m = bore.count();
        // Tangential, then axial ones, the uniform one of each left out.
        let (first, each) = (m / 3, m / 3);
        let free: Vec<usize> = (first + 1..first + each).chain(2 * each + 1..m).collect();
        let s = |i: usize| {
            free.iter()
                .map(|&j| bore.stiffness[i * m + j])
                .collect::<Vec<f64>>()
        };
        let matrix: Vec<Vec<f64>> = free.iter().map(|&i| s(i)).collect();
        let loads = gear.grid.len();
        for (tooth, other) in [
            (0, 0),
            (1, 4),
            (gear.teeth_per_sector() - 1, gear.teeth - 1),
        ] {
            for (of_a, of_b) in [(0, 1), (1, 1)] {
                let flanks = [gear.flanks[of_a], gear.flanks[of_b]];
                let rows = gear.bore_rows(tooth, flanks[0]).unwrap();
                let responses = gear.bore_rows(other, flanks[1]).unwrap();
                let before = gear.c_hub_block(tooth, flanks[0], other, flanks[1]);
                let after = released.c_hub_block(tooth, flanks[0], other, flanks[1]);
                for load in 0..loads {
                    let push = free.iter().map(|&q| rows[load * m + q]).collect();
                    let motion = solved(matrix.clone(), push);
                    for response in 0..loads {
                        let row = &responses[response * m..][..m];
                        let terms = free.iter().zip(&motion).map(|(&q, x)| row[q] * x);
                        let adds: f64 = terms.sum();
                        let at = load * loads + response;
                        let off = (after[at] - before[at] - adds).abs();
                        assert!(off < 1e-12 * before[at].abs().max(adds.abs()), "{off}");
                    }
                }
            }
        }
    }

    /// A gauge feels the motions of the bore as well: strain per motion times the motions, solved another way.
    #[test]
    fn gauges_feel_the_free_motions() {
        let gear = small_bored_gear();
        let sliding = gear.with_sliding_bore().unwrap().gear;
        let bore = gear.bore.as_ref().unwrap();
        let (m, each) = (bore.count(), bore.count() / 3);
        let free: Vec<usize> = (each + 1..2 * each).chain(2 * each + 1..m).collect();
        let row = |i: &usize| free.iter().map(|&j| bore.stiffness[i * m + j]).collect();
        let matrix: Vec<Vec<f64>> = free.iter().map(row).collect();
        let loads = gear.grid.len();
        for (number, (before, after)) in gear.gauges.iter().zip(&sliding.gauges).enumerate() {
            assert_eq!(before.own_tooth, after.own_tooth);
            for (tooth, flank, load) in [(0, 0, 0), (2, 1, loads - 1), (gear.teeth - 1, 0, 1)] {
                let rows = gear.bore_rows(tooth, gear.flanks[flank]).unwrap();
                let push = free.iter().map(|&q| rows[load * m + q]).collect();
                let motions = solved(matrix.clone(), push);
                let felt = free.iter().zip(&motions);
                let adds: f64 = felt.map(|(&q, x)| bore.gauges[number * m + q] * x).sum();
                let at = 3 * ((tooth * gear.flanks.len() + flank) * loads + load);
                let off = after.adjoint[at] - before.adjoint[at] - adds;
                assert!(
                    adds != 0.0 && off.abs() < 1e-11 * adds.abs(),
                    "{off} {adds}"
                );
                assert_eq!(
                    before.adjoint[at + 1..at + 3],
                    after.adjoint[at + 1..at + 3]
                );
            }
        }
    }

    /// Radial motions that something holds strain the gauges as all motions together do: those solved another way, and
    /// those that the model states. A bore that nothing moves radially is the one that slides.
    #[test]
    fn gauges_feel_radial_motions_with_the_free_ones_that_follow() {
        let gear = small_bored_gear();
        let released = gear.with_sliding_bore().unwrap();
        let bore = gear.bore.as_ref().unwrap();
        let (m, each, loads) = (bore.count(), bore.count() / 3, gear.grid.len());
        let free: Vec<usize> = (each + 1..2 * each).chain(2 * each + 1..m).collect();
        let entry = |i: usize, j: usize| bore.stiffness[i * m + j];
        let (tooth, load, force_n) = (2, 1, 700.0);
        let flank = gear.flanks[1];
        let forces = [(tooth, flank, load, force_n)];
        let rows = gear.bore_rows(tooth, flank).unwrap();
        for moved in [0.0, 1e-6] {
            let radial: Vec<f64> = (0..released.radial.count())
                .map(|k| moved * (1.0 + k as f64).cos())
                .collect();
            let mut all = vec![0.0; m];
            for ([wave, degree], q) in released.radial.motions.iter().zip(&radial) {
                all[wave * bore.along + degree] = *q;
            }
            let matrix = free
                .iter()
                .map(|&i| free.iter().map(|&j| entry(i, j)).collect());
            let push = free.iter().map(|&i| {
                let held: f64 = all.iter().enumerate().map(|(j, q)| entry(i, j) * q).sum();
                force_n * rows[load * m + i] - held
            });
            let follow = solved(matrix.collect(), push.collect());
            for (&i, q) in free.iter().zip(&follow) {
                all[i] = *q;
            }
            let stated = gear.bore_motions_m(&forces, &radial).unwrap();
            let largest = all.iter().fold(0.0_f64, |most, q| most.max(q.abs()));
            for (a, b) in all.iter().zip(&stated) {
                assert!((a - b).abs() < 1e-12 * largest, "{a} {b}");
            }
            if moved == 0.0 {
                assert_eq!(stated, gear.bore_motions_m(&forces, &[]).unwrap());
            }
            let count = released.radial.count();
            for (number, sliding) in released.gear.gauges.iter().enumerate() {
                let at = 3 * ((tooth * gear.flanks.len() + 1) * loads + load);
                let strained = &released.radial.gauges[number * count..][..count];
                let radially: f64 = strained.iter().zip(&radial).map(|(g, q)| g * q).sum();
                let found = force_n * sliding.adjoint[at] + radially;
                let own = &bore.gauges[number * m..][..m];
                let bending: f64 = own.iter().zip(&all).map(|(g, q)| g * q).sum();
                let expected = force_n * gear.gauges[number].adjoint[at] + bending;
                let off = (found - expected).abs();
                assert!(off < 1e-11 * bending.abs(), "{found} {expected}");
            }
        }
    }

    #[test]
    fn a_model_without_motions_of_its_bore_says_so() {
        let message = small_reduced_gear()
            .with_sliding_bore()
            .unwrap_err()
            .to_string();
        assert!(message.contains("[reduction.bore]"), "{message}");
        let mut gear = small_bored_gear();
        let bore = gear.bore.as_mut().unwrap();
        bore.stiffness.iter_mut().for_each(|value| *value = -*value);
        let message = gear.with_sliding_bore().unwrap_err().to_string();
        assert!(message.contains("not positive"), "{message}");
    }
}
