//! Static positions of a loaded scene under one torque, one after the other.

use super::run::{LoadedScene, RunError};
use gearmesh_contact::mesh_stiffness::MeshStiffness;
use gearmesh_contact::{ContactPatch, Drive, StaticContact, TipGear};
use std::sync::atomic::{AtomicBool, Ordering};

/// What is found at a driver angle.
pub(super) struct Position {
    /// Driver angle \[rad\].
    pub angle_rad: f64,
    /// Transmission error \[m\], and without load.
    pub te_m: f64,
    pub unloaded_m: f64,
    /// Torque \[N·m\] and axial force \[N\] on gear 1.
    pub torque_1_nm: f64,
    pub axial_1_n: f64,
    /// Mesh stiffness \[N/m\].
    pub secant_n_per_m: f64,
    pub tangent_n_per_m: f64,
    /// Slice forces \[N\] and pressures \[Pa\], `[line][slice]`.
    pub force_n: Vec<f64>,
    pub pressure_pa: Vec<f64>,
    /// Largest over mean line load of the most loaded line.
    pub k_h_beta: f64,
    /// Newton iterations, relative residual, relative error of the torque.
    pub iterations: usize,
    pub residual: f64,
    pub torque_balance: f64,
    /// What strains the assumptions, in the order of `warnings.rs`: half width over the depth of the tooth, pressure
    /// over Young's modulus, deflection over the base pitch, capped slices.
    pub strained: [f64; 4],
    /// Pairs of teeth that carry, the tip edge on which they do, and whether it is the one that carries most.
    pub carriers: Vec<(i64, Option<TipGear>, bool)>,
}

impl Position {
    /// Largest Hertz pressure \[Pa\].
    pub fn pressure_largest_pa(&self) -> f64 {
        self.pressure_pa.iter().copied().fold(0.0, f64::max)
    }
}

/// Solves positions, each begun from the one before.
pub(super) struct PositionSolver<'a> {
    contact: StaticContact,
    torque_nm: f64,
    base_2_m: f64,
    base_pitch_m: f64,
    least_distance_m: f64,
    young_pa: f64,
    stop: &'a AtomicBool,
}

impl<'a> PositionSolver<'a> {
    pub fn new(
        loaded: &LoadedScene,
        contact: StaticContact,
        torque_nm: f64,
        stop: &'a AtomicBool,
    ) -> Self {
        let pair = &loaded.lines.pair;
        let distances = loaded.models.each_ref().map(|m| {
            let distances = m.opposite_distance_m.iter().copied();
            distances.fold(f64::INFINITY, f64::min)
        });
        Self {
            contact,
            torque_nm,
            base_2_m: pair.gear_2.base_radius_m,
            base_pitch_m: pair.pitch_1_rad() * pair.gear_1.base_radius_m,
            least_distance_m: distances[0].min(distances[1]),
            young_pa: loaded.models[0].young_pa.min(loaded.models[1].young_pa),
            stop,
        }
    }

    /// The position at a driver angle.
    ///
    /// # Errors
    /// [`RunError::Contact`] where it has no solution; [`RunError::Stopped`].
    pub fn at(&mut self, angle_rad: f64) -> Result<Position, RunError> {
        if self.stop.load(Ordering::Relaxed) {
            return Err(RunError::Stopped);
        }
        let Self { contact, .. } = self;
        let state = contact.solve(angle_rad, Drive::Torque(self.torque_nm))?;
        let stiffness = MeshStiffness::of(&state, self.base_2_m);
        let slices = contact.slices();
        let force_n = contact.forces_n().to_vec();
        let mut pressure_pa = vec![0.0; force_n.len()];
        let mut strained = [0.0f64; 4];
        for (number, patch) in contact.patches().iter().enumerate() {
            let (half_width, pressure) = contact.hertz(number, contact.force_n(patch));
            pressure_pa[patch.line * slices + patch.slice] = pressure;
            strained[0] = strained[0].max(half_width / self.least_distance_m);
            strained[1] = strained[1].max(pressure / self.young_pa);
        }
        strained[2] = (state.unloaded_m - state.transmission_error_m) / self.base_pitch_m;
        strained[3] = state.info.cap_hits as f64;
        let (heaviest, k_h_beta) = heaviest(contact);
        let lines = contact.active_lines().iter().zip(force_n.chunks(slices));
        let carriers = (lines.enumerate())
            .filter(|(_, (_, forces))| forces.iter().any(|force| *force > 0.0))
            .map(|(number, (line, _))| {
                let tip = line.tip.map(|tip| tip.tip_gear);
                (line.pair, tip, number == heaviest)
            })
            .collect();
        Ok(Position {
            angle_rad,
            te_m: state.transmission_error_m,
            unloaded_m: state.unloaded_m,
            torque_1_nm: state.torque_1_nm,
            axial_1_n: state.axial_force_1_n,
            secant_n_per_m: stiffness.secant_n_per_m,
            tangent_n_per_m: stiffness.tangent_n_per_m,
            k_h_beta,
            iterations: state.info.iterations,
            residual: state.info.residual,
            torque_balance: (state.torque_2_nm / self.torque_nm - 1.0).abs(),
            force_n,
            pressure_pa,
            strained,
            carriers,
        })
    }
}

/// The most loaded line, and its largest over its mean line load; a slice partly on the path counts with its share.
fn heaviest(contact: &StaticContact) -> (usize, f64) {
    let mut heaviest = (0.0, (0, 1.0));
    for on_line in contact.patches().chunk_by(|a, b| a.line == b.line) {
        let force = |s: &ContactPatch| contact.force_n(s);
        let sum: f64 = on_line.iter().map(force).sum();
        if sum > heaviest.0 {
            let length: f64 = on_line.iter().map(|s| s.share).sum();
            let largest = on_line.iter().map(force).fold(0.0, f64::max);
            heaviest = (sum, (on_line[0].line, largest * length / sum));
        }
    }
    heaviest.1
}
