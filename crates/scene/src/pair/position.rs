//! Static positions of a loaded pair under one torque, one after the other.

use super::contact_places::PatchPlace;
use super::run::RunError;
use gearmesh_contact::mesh_stiffness::MeshStiffness;
use gearmesh_contact::{ContactPatch, Drive, FlanksAtRest, StaticContact, TipGear};
use std::sync::atomic::{AtomicBool, Ordering};

/// Where a patch touches at a driver angle \[rad\].
pub(super) type PlaceOf<'a> = dyn Fn(f64, &ContactPatch) -> PatchPlace + Sync + 'a;

/// What positions of a pair are measured by.
pub(super) struct Measures<'a> {
    /// Angle of the driver from one tooth to the next \[rad\].
    pub pitch_rad: f64,
    /// Distance of one tooth from the next along the line of action \[m\].
    pub base_pitch_m: f64,
    /// Least depth of the teeth behind the flanks \[m\]; infinite for rigid gears.
    pub least_distance_m: f64,
    /// Young's modulus of the softer gear \[Pa\].
    pub young_pa: f64,
    /// Slices of a whole line, where a line counts as whole; the slices that are on the path where none.
    pub whole_line: Option<f64>,
    /// Where patches touch, for families that store it with each position.
    pub place_of: Option<&'a PlaceOf<'a>>,
}

/// What is found at a driver angle.
#[derive(Clone)]
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
    /// Pair of teeth of each line.
    pub pairs: Vec<i64>,
    /// Where the slices touch, `[line][slice]`; empty where the family does not store it.
    pub places: Vec<PatchPlace>,
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
    /// Which of their slices carry.
    pub carrying: Vec<bool>,
}

impl Position {
    /// Largest Hertz pressure \[Pa\].
    pub fn pressure_largest_pa(&self) -> f64 {
        self.pressure_pa.iter().copied().fold(0.0, f64::max)
    }
}

/// Solves positions, each begun from the one before.
pub(super) struct PositionSolver<'a, F> {
    pub contact: StaticContact<F>,
    pub torque_nm: f64,
    pub radius_2_m: f64,
    pub measures: &'a Measures<'a>,
    pub stop: &'a AtomicBool,
}

impl<F: FlanksAtRest> PositionSolver<'_, F> {
    /// The position at a driver angle.
    ///
    /// # Errors
    /// [`RunError::Contact`] where it has no solution; [`RunError::Stopped`].
    pub fn at(&mut self, angle_rad: f64) -> Result<Position, RunError> {
        if self.stop.load(Ordering::Relaxed) {
            return Err(RunError::Stopped);
        }
        let Self {
            contact, measures, ..
        } = self;
        let state = contact.solve(angle_rad, Drive::Torque(self.torque_nm))?;
        let stiffness = MeshStiffness::of(&state, self.radius_2_m);
        let slices = contact.slices();
        let force_n = contact.forces_n().to_vec();
        let mut pressure_pa = vec![0.0; force_n.len()];
        let stored = measures.place_of.map_or(0, |_| force_n.len());
        let mut places = vec![PatchPlace::default(); stored];
        let mut strained = [0.0f64; 4];
        for (number, patch) in contact.patches().iter().enumerate() {
            let (half_width, pressure) = contact.hertz(number, contact.force_n(patch));
            let at = patch.line * slices + patch.slice;
            pressure_pa[at] = pressure;
            if let Some(place_of) = measures.place_of {
                places[at] = place_of(angle_rad, patch);
            }
            strained[0] = strained[0].max(half_width / measures.least_distance_m);
            strained[1] = strained[1].max(pressure / measures.young_pa);
        }
        strained[2] = (state.unloaded_m - state.transmission_error_m) / measures.base_pitch_m;
        strained[3] = state.info.cap_hits as f64;
        let (heaviest, k_h_beta) = heaviest(contact, measures.whole_line);
        let lines = contact.pairs_and_tips().zip(force_n.chunks(slices));
        let carry =
            |(_, (_, forces)): &(usize, (_, &[f64]))| forces.iter().any(|force| *force > 0.0);
        let (carriers, carrying): (Vec<_>, Vec<_>) = (lines.enumerate().filter(carry))
            .map(|(number, ((pair, tip), forces))| ((pair, tip, number == heaviest), forces))
            .unzip();
        let carrying = carrying.concat().iter().map(|force| *force > 0.0).collect();
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
            pairs: contact.pairs_and_tips().map(|(pair, _)| pair).collect(),
            places,
            strained,
            carriers,
            carrying,
        })
    }
}

/// The most loaded line, and its largest over its mean line load; a slice partly on the path counts with its share.
fn heaviest<F: FlanksAtRest>(contact: &StaticContact<F>, whole_line: Option<f64>) -> (usize, f64) {
    let mut heaviest = (0.0, (0, 1.0));
    for on_line in contact.patches().chunk_by(|a, b| a.line == b.line) {
        let force = |s: &ContactPatch| contact.force_n(s);
        let sum: f64 = on_line.iter().map(force).sum();
        if sum > heaviest.0 {
            let length = whole_line.unwrap_or_else(|| on_line.iter().map(|s| s.share).sum());
            let largest = on_line.iter().map(force).fold(0.0, f64::max);
            heaviest = (sum, (on_line[0].line, largest * length / sum));
        }
    }
    heaviest.1
}
