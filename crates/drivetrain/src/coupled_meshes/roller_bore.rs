//! A gear on rollers that press its bore: the bearing, and the forces of its rollers along the motions of the bore.
//!
//! ```text
//! roller j at the angle φ_j   b_jd = Σ_w q_wd s_w wave_w(φ_j),   s_w = sin(nh)/(n sin h)
//! on the bore                 N_wd = Σ_j s_w wave_w(φ_j) G_jd
//! ```
//!
//! A roller presses evenly over an arc of its own diameter, 2h = D/R, with pressures whose resultant is its force. With
//! P_i = ŝ_i M⁻¹ Z, Z = Σ_j s wave ∂(ring load)/∂b, the place p of the inner ring is felt by the flanks as a gap of P_i
//! p, and
//!
//! ```text
//! ∂(ring load) = (T + Zᵀ M⁻¹ Z) δp + Σ_i P_iᵀ δF_i
//! ```
//!
//! Theory: docs/theory/bore_patterns.md.

use std::cell::Cell;

use gearmesh_bearings::{BearingError, QuasiStaticElement, RingLoad};
use gearmesh_contact::BoreBending;
use gearmesh_dynamics::elements::View;
use gearmesh_dynamics::{BodyId, RelativeMotion};
use gearmesh_model::{RadialMotions, ReducedGear, bore_wave};
use nalgebra::{Matrix6, Vector6};

use crate::error::DrivetrainError;

/// Largest outer race of the rollers over the bore: files round their numbers.
const LARGEST_RACE: f64 = 1.01;

/// A gear on rollers that press on its bore.
pub struct GearOnRollers<'a> {
    /// The bearing: its outer ring, marker A, is the gear's bore.
    pub bearing: QuasiStaticElement,
    /// The gear, with a bore that slides.
    pub gear: &'a ReducedGear,
    /// Radial motions of the bore.
    pub motions: &'a RadialMotions,
}

/// One bore and its rollers.
pub(super) struct RollerBore {
    pub bearing: QuasiStaticElement,
    /// Wave and degree of each motion.
    motions: Vec<[usize; 2]>,
    /// s of each wave.
    spread: Vec<f64>,
    /// Radius of the bore \[m\].
    radius_m: f64,
    /// Angle of the bearing's frame on the gear \[rad\].
    turned_rad: f64,
    /// s wave of each roller, `[roller][motion]`.
    waves: Vec<f64>,
    /// Its derivative by the angle.
    slopes: Vec<f64>,
    /// N and −∂N/∂q.
    pub force_n: Vec<f64>,
    pub stiffness: Vec<f64>,
    /// G where it was made linear, and what it should have become.
    expected_n: Vec<f64>,
    /// q at the last accepted step.
    pub kept_m: Vec<f64>,
    /// Load on the inner ring, its tangent that of a bore at rest.
    pub ring: RingLoad,
    /// Z and M⁻¹ Z, six columns.
    by_ring: [Vec<f64>; 6],
    follows: [Vec<f64>; 6],
    /// P of each contact.
    pub gap_by_ring: Vec<Vector6<f64>>,
}

impl RollerBore {
    /// # Errors
    /// [`DrivetrainError::Bearing`] for a bearing whose outer ring is no bore that bends.
    pub fn new(gear: GearOnRollers<'_>, contacts: usize) -> Result<Self, DrivetrainError> {
        let GearOnRollers {
            bearing, motions, ..
        } = gear;
        let seat = bearing.rings().a;
        let [x_m, y_m, z_m] = seat.position_m.into();
        let axes = seat.orientation();
        let beside_m = x_m.hypot(y_m);
        if beside_m > 1e-9 || axes[(2, 2)] < 1.0 - 1e-12 {
            return Err(DrivetrainError::RollersBeside { beside_m });
        }
        let [back, front] = motions.ends_m;
        let farthest_m = Cell::new(0.0_f64);
        let functions = |place_m: f64| {
            let out_m = (back - z_m - place_m).max(place_m + z_m - front);
            farthest_m.set(farthest_m.get().max(out_m));
            motions.polynomials(z_m + place_m)
        };
        let bearing = bearing.in_elastic_bore(functions)?;
        if farthest_m.get() > 1e-9 {
            let out_m = farthest_m.get();
            return Err(DrivetrainError::RollersOutside { out_m });
        }
        let sizes = bearing.sizes();
        let race_m = sizes.pitch_diameter_m + sizes.element_diameter_m;
        let bore_m = 2.0 * motions.radius_m;
        if race_m > LARGEST_RACE * bore_m {
            return Err(DrivetrainError::RollersTooLarge { race_m, bore_m });
        }
        let m = motions.count();
        let half_arc_rad = sizes.element_diameter_m / bore_m;
        let of_order = |order: f64| match order * half_arc_rad {
            0.0 => 1.0,
            arc => arc.sin() / arc,
        };
        let spread = |motion: &[usize; 2]| of_order(motion[0].div_ceil(2) as f64) / of_order(1.0);
        let rollers = bearing.roller_angles_rad(0.0).count();
        Ok(Self {
            spread: motions.motions.iter().map(spread).collect(),
            motions: motions.motions.clone(),
            radius_m: motions.radius_m,
            turned_rad: axes[(1, 0)].atan2(axes[(0, 0)]),
            waves: vec![0.0; rollers * m],
            slopes: vec![0.0; rollers * m],
            force_n: vec![0.0; m],
            stiffness: vec![0.0; m * m],
            expected_n: vec![0.0; bearing.bent().map_or(0, |race| race.force_n.len())],
            kept_m: vec![0.0; m],
            ring: RingLoad::default(),
            by_ring: std::array::from_fn(|_| vec![0.0; m]),
            follows: std::array::from_fn(|_| vec![0.0; m]),
            gap_by_ring: Vec::with_capacity(contacts),
            bearing,
        })
    }

    /// Bodies of outer and inner ring.
    pub fn bodies(&self) -> [BodyId; 2] {
        let rings = self.bearing.rings();
        [rings.a.body, rings.b.body]
    }

    /// Motion of the inner ring in the outer one's frame.
    pub fn motion(&self, view: &View<'_>) -> RelativeMotion {
        let [outer, inner] = self.bodies().map(|body| view.body(body));
        self.bearing.rings().motion(outer, inner)
    }

    /// Takes the rollers to where they are at a time.
    pub fn turn(&mut self, time_s: f64) {
        let m = self.motions.len();
        let rows = self
            .waves
            .chunks_exact_mut(m)
            .zip(self.slopes.chunks_exact_mut(m));
        for (angle_rad, (row, slopes)) in self.bearing.roller_angles_rad(time_s).zip(rows) {
            let polar_rad = self.turned_rad + angle_rad;
            for (k, [wave, _]) in self.motions.iter().enumerate() {
                // cos nφ turns to −n sin nφ, sin nφ to n cos nφ.
                let order = wave.div_ceil(2) as f64;
                let (other, sign) = match wave % 2 {
                    1 => (wave + 1, -order),
                    _ => (wave.saturating_sub(1), order),
                };
                row[k] = self.spread[k] * bore_wave(*wave, polar_rad);
                slopes[k] = self.spread[k] * sign * bore_wave(other, polar_rad);
            }
        }
    }

    /// Finds all rollers where the bore has moved so far; `goes_on`: from where they were found last.
    pub fn find(
        &mut self,
        view: &View<'_>,
        motions_m: &[f64],
        goes_on: bool,
    ) -> Result<(), BearingError> {
        let m = self.motions.len();
        if let Some(race) = self.bearing.bent_mut() {
            let along = race.along();
            let moved = race.moved_m.chunks_exact_mut(along);
            for (moved, row) in moved.zip(self.waves.chunks_exact(m)) {
                moved.fill(0.0);
                for (([_, degree], q), wave) in self.motions.iter().zip(motions_m).zip(row) {
                    moved[*degree] += q * wave;
                }
            }
        }
        self.ring = self.bearing.find(view, goes_on)?;
        Ok(())
    }

    /// Sums up what the rollers do: N, −∂N/∂q and Z.
    pub fn sum_up(&mut self) {
        let m = self.motions.len();
        let Some(race) = self.bearing.bent() else {
            return;
        };
        let along = race.along();
        self.force_n.fill(0.0);
        self.stiffness.fill(0.0);
        self.by_ring.iter_mut().for_each(|column| column.fill(0.0));
        for (roller, row) in self.waves.chunks_exact(m).enumerate() {
            let own = roller * along..(roller + 1) * along;
            let force_n = &race.force_n[own.clone()];
            let stiffness = &race.stiffness[along * own.start..along * own.end];
            if force_n.iter().all(|force| *force == 0.0) {
                continue;
            }
            let by_moved = &race.ring_by_moved[own];
            for (k, [_, d]) in self.motions.iter().enumerate() {
                self.force_n[k] += row[k] * force_n[*d];
                for (column, value) in self.by_ring.iter_mut().zip(by_moved[*d].iter()) {
                    column[k] += row[k] * value;
                }
                let sums = &mut self.stiffness[k * m..(k + 1) * m];
                for ((sum, [_, e]), other) in sums.iter_mut().zip(&self.motions).zip(row) {
                    *sum += row[k] * other * stiffness[d * along + e];
                }
            }
        }
    }

    /// Keeps what the rollers' forces should be where the bore has moved to `motions_m`, by the slopes where it is now.
    pub fn expect(&mut self, motions_m: &[f64]) {
        let m = self.motions.len();
        let Some(race) = self.bearing.bent() else {
            return;
        };
        let along = race.along();
        for (roller, row) in self.waves.chunks_exact(m).enumerate() {
            let first = roller * along;
            let expected = &mut self.expected_n[first..first + along];
            for (d, force) in expected.iter_mut().enumerate() {
                *force = race.force_n[first + d];
                for e in 0..along {
                    let pairs = self.motions.iter().zip(motions_m).zip(row);
                    let own = pairs.filter(|(([_, degree], _), _)| *degree == e);
                    let moved: f64 = own.map(|((_, q), wave)| q * wave).sum();
                    let further_m = moved - race.moved_m[first + e];
                    *force -= race.stiffness[(first + d) * along + e] * further_m;
                }
            }
        }
    }

    /// By how much the rollers' forces miss what was expected, the largest of them, and what places that are rounded
    /// make of them \[N\].
    pub fn missed_n(&self) -> [f64; 3] {
        let Some(race) = self.bearing.bent() else {
            return [0.0; 3];
        };
        let most = |values: &[f64]| values.iter().fold(0.0, |most, v| f64::max(most, v.abs()));
        let pairs = race.force_n.iter().zip(&self.expected_n);
        let missed = pairs.map(|(force, expected)| (force - expected).abs());
        [
            missed.fold(0.0, f64::max),
            most(&race.force_n),
            4.0 * f64::EPSILON * self.radius_m * most(&race.stiffness),
        ]
    }

    /// How flanks and ring feel the place of the ring: P, and T + Zᵀ M⁻¹ Z in the ring's tangent.
    pub fn follow_ring(&mut self, bore: &BoreBending, contacts: usize) {
        for (follows, by_ring) in self.follows.iter_mut().zip(&self.by_ring) {
            follows.copy_from_slice(by_ring);
            bore.follow_force(follows);
        }
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let more = |i: usize, j: usize| dot(&self.by_ring[i], &self.follows[j]);
        self.ring.tangent += Matrix6::from_fn(more);
        self.gap_by_ring.clear();
        let row = |i: usize| Vector6::from_fn(|k, _| bore.gap_by(i, &self.follows[k]));
        self.gap_by_ring.extend((0..contacts).map(row));
    }

    /// Power that the cage brings in by leading the rollers round a bent bore, −ω Σ G ∂b/∂φ \[W\].
    pub fn led_w(&self, motions_m: &[f64]) -> f64 {
        let m = self.motions.len();
        let Some(race) = self.bearing.bent() else {
            return 0.0;
        };
        let mut by_angle = 0.0;
        for (force, slopes) in race
            .force_n
            .chunks_exact(race.along())
            .zip(self.slopes.chunks_exact(m))
        {
            for (([_, degree], q), slope) in self.motions.iter().zip(motions_m).zip(slopes) {
                by_angle += force[*degree] * q * slope;
            }
        }
        -self.bearing.cage_rad_per_s() * by_angle
    }
}
