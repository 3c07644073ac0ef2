//! `hybrid`: two reduced gears, their slices coupled through bodies, teeth and neighbouring teeth, and the
//! complementarity problem.
//!
//! ```text
//! C F + δ(F) + gap ≥ 0,   F ≥ 0,   K = (C + diag δ′)⁻¹ on the slices that touch
//! ```
//!
//! The same solver as the static contact's, with the gaps of the pose instead of those of a driver angle. The
//! compliance moves with the roll angles: its part of the generalised force, ½ Fᵀ(∂C/∂ξ)F and that of the local laws,
//! is included, so that undamped teeth keep their energy. The tangent leaves out how C itself moves the forces, about
//! 1e-3 of it. Helical slices stand each at their own roll angle; on the rigid path those at its ends touch over a
//! share of their width, and the change of the energy with the share is included, too. Of gears with vibration modes
//! the compliance is C less Σ φφᵀ/ω², what their modes deflect at rest. A root crack adds to C where its tooth is in
//! contact, by the tooth's number. Right and left flanks are solved one by one: a tooth wedged on both flanks at once
//! does not feel itself across.

use gearmesh_contact::slice_contact::SliceContact;
use gearmesh_contact::{
    CondensedFlanks, ContactLines, ContactPatch, Drive, LocalContact, SliceLayout,
    nlcp::FLOOR_FRACTION,
};
use gearmesh_dynamics::Iterate;
use gearmesh_geometry::{Flank, GearPair, Microgeometry};
use gearmesh_model::ReducedGear;

use crate::error::{DrivetrainError, positive};
use crate::flank_contacts::FlankContacts;
use crate::models::teeth_model::{TeethLoads, TeethModel};
use crate::pose::Vector6;

mod joint;

use joint::JointShare;

/// A slice that is open by more than this many times the deepest penetration of all is left out. No unit. What loaded
/// teeth make of other flanks' gaps is at most their own deflection times √(C_ii/C_jj), which stays below 3 on one
/// gear.
pub(crate) const OUT_OF_REACH: f64 = 3.0;

/// A contact that is left out.
const NOWHERE: usize = usize::MAX;

/// The teeth of two reduced gears on one side.
#[derive(Debug, Clone)]
pub struct ReducedTeeth {
    slices: SliceContact,
    floor_n: f64,
    /// Row of each contact in the problem.
    row: Vec<usize>,
    /// Teeth of the lines within reach.
    teeth: Vec<[usize; 2]>,
    patches: Vec<ContactPatch>,
    unit: Vec<f64>,
    change: Vec<f64>,
    /// φ/ω of each row, `[row][mode]`; one array a gear.
    modal_rows: [Vec<f64>; 2],
    /// Teeth and slice forces that the next solution starts from.
    known: KnownForces,
    iterate: Iterate,
    /// Where the forces are found with those of other meshes: what came of it.
    joint: Option<JointShare>,
}

/// Forces by tooth pair: lines come, go and change their number.
#[derive(Debug, Clone, Default)]
struct KnownForces {
    teeth: Vec<[usize; 2]>,
    /// `[line][slice]`.
    forces_n: Vec<f64>,
}

impl KnownForces {
    fn with_capacity(slices: usize) -> Self {
        Self {
            teeth: Vec::with_capacity(slices),
            forces_n: Vec::with_capacity(slices),
        }
    }

    /// Slice forces known of a tooth pair.
    fn of_teeth(&self, teeth: [usize; 2], slices: usize) -> Option<&[f64]> {
        let line = self.teeth.iter().position(|other| *other == teeth)?;
        Some(&self.forces_n[line * slices..][..slices])
    }
}

impl ReducedTeeth {
    /// The contact of two models on one side of the teeth, gears that do not stand displaced along their axes.
    /// `nominal_force_n`: normal force of the nominal load, which sets the floor of the local law's logarithm.
    ///
    /// # Errors
    /// As [`Self::displaced`].
    pub fn new(
        pair: &GearPair,
        side: Flank,
        models: [&ReducedGear; 2],
        local: LocalContact,
        nominal_force_n: f64,
    ) -> Result<Self, DrivetrainError> {
        Self::displaced(pair, side, models, (local, 0.0), nominal_force_n)
    }

    /// The same with the slices where the faces overlap with gear 2's mid-face `displacement_m` from gear 1's along the
    /// axes: the reference from which the gears may move by a slice's width.
    ///
    /// # Errors
    /// [`DrivetrainError::Contact`] when the models do not fit the pair, each other or the side,
    /// [`DrivetrainError::Value`].
    pub fn displaced(
        pair: &GearPair,
        side: Flank,
        models: [&ReducedGear; 2],
        (local, displacement_m): (LocalContact, f64),
        nominal_force_n: f64,
    ) -> Result<Self, DrivetrainError> {
        let layout = SliceLayout::of_models(models, displacement_m);
        let known = CondensedFlanks::default();
        Self::on_slices(pair, side, models, (local, layout), nominal_force_n, &known)
    }

    /// The same on the slices of a layout, see [`SliceLayout::resolved`], of flanks that may be `known`.
    ///
    /// # Errors
    /// As [`Self::displaced`].
    pub fn on_slices<'a>(
        pair: &GearPair,
        side: Flank,
        models: [&'a ReducedGear; 2],
        (local, layout): (LocalContact, SliceLayout),
        nominal_force_n: f64,
        known: &CondensedFlanks<'a>,
    ) -> Result<Self, DrivetrainError> {
        let lines = ContactLines {
            pair: pair.clone(),
            microgeometry_1: Microgeometry::default(),
            microgeometry_2: Microgeometry::default(),
            extension: None,
            zone: layout.reference,
        };
        // Tip edges add up to half a pitch at either end, and gears may stand closer together than the pair.
        let most_lines = lines.most_pairs() + 2;
        let teeth = [pair.gear_1.teeth, pair.gear_2.teeth];
        let sides = [0, 1].map(|gear| pair.circles().side_of(gear, side));
        let flanks = (teeth, sides);
        let slices = SliceContact::of_gears(models, flanks, (local, layout), most_lines, known)?;
        Self::of_flanks(slices, nominal_force_n)
    }

    /// The contact of any two elastic flanks.
    ///
    /// # Errors
    /// [`DrivetrainError::Value`].
    pub fn of_flanks(slices: SliceContact, nominal_force_n: f64) -> Result<Self, DrivetrainError> {
        positive("hybrid mesh", "the nominal force in N", nominal_force_n)?;
        let capacity = slices.capacity();
        let empty = || Vec::with_capacity(capacity);
        Ok(Self {
            floor_n: FLOOR_FRACTION * nominal_force_n / slices.slices() as f64,
            row: Vec::with_capacity(capacity),
            teeth: Vec::with_capacity(capacity),
            patches: Vec::with_capacity(capacity),
            unit: empty(),
            change: empty(),
            modal_rows: [empty(), empty()],
            known: KnownForces::with_capacity(capacity),
            iterate: Iterate::Single,
            joint: None,
            slices,
        })
    }

    /// Where the slices lie: the layout that the mesh kinematics must have.
    #[must_use]
    pub fn layout(&self) -> &SliceLayout {
        self.slices.layout()
    }

    /// Refuses gears that have moved along their axes so far that the slices would stand for other parts of the teeth.
    fn check_displacement(&self, flanks: &FlankContacts) -> Result<(), DrivetrainError> {
        let (moved_m, allowed_m) = (flanks.along_teeth.moved_m, self.layout().width_m());
        if moved_m.abs() <= allowed_m {
            return Ok(());
        }
        Err(DrivetrainError::AxialMotion {
            moved_mm: moved_m * 1e3,
            allowed_mm: allowed_m * 1e3,
        })
    }

    /// Takes the patches within reach of so deep an overlap.
    fn take(&mut self, flanks: &FlankContacts, deepest_m: f64) {
        self.teeth.clear();
        self.patches.clear();
        self.row.clear();
        self.row.resize(flanks.contacts.len(), NOWHERE);
        let reach = OUT_OF_REACH * deepest_m;
        for line in &flanks.lines {
            let begin = self.patches.len();
            let (first, count) = line.contacts;
            for i in first..first + count {
                if flanks.contacts[i].gap_m <= reach {
                    self.row[i] = self.patches.len();
                    self.patches.push(flanks.patch((self.teeth.len(), line), i));
                }
            }
            if self.patches.len() > begin {
                self.teeth.push(line.teeth);
            }
        }
    }

    /// Takes from the compliance what the modes deflect at rest.
    fn take_modes_out(&mut self, flanks: &FlankContacts) {
        for (rows, modal) in self.modal_rows.iter_mut().zip(&flanks.modal) {
            let count = modal.count();
            rows.clear();
            if count == 0 {
                continue;
            }
            rows.resize(self.patches.len() * count, 0.0);
            for (number, &row) in self.row.iter().enumerate() {
                if row != NOWHERE {
                    let scaled = rows[row * count..].iter_mut().zip(modal.shape(number));
                    for ((place, phi), omega_squared) in scaled.zip(&modal.omega_squared) {
                        *place = phi / omega_squared.sqrt();
                    }
                }
            }
            self.slices.subtract_from_compliance(rows, count);
        }
    }

    /// Lays forces that are known of the patches, zero where none are.
    pub(crate) fn lay_known(&mut self) {
        let slices = self.slices.slices();
        self.change.clear();
        for on_line in self.patches.chunk_by(|a, b| a.line == b.line) {
            let known = self.known.of_teeth(on_line[0].teeth, slices);
            let force = |patch: &ContactPatch| known.map_or(0.0, |forces| forces[patch.slice]);
            self.change.extend(on_line.iter().map(force));
        }
    }

    /// Starts from what is known, from nothing where nothing is.
    fn begin_solution(&mut self) {
        self.lay_known();
        if self.change.iter().any(|force| *force > 0.0) {
            self.slices.start_from(&self.change);
        } else {
            self.slices.reset();
        }
    }

    /// F_placeᵀ ∂φ Ω⁻² φᵀF of one gear: the modes' share in the change of the complementary energy, for a section whose
    /// shapes change by these slopes, up the flank or along the tooth.
    fn modal_energy(
        &self,
        (flanks, slopes): (&FlankContacts, &[f64]),
        loads: &TeethLoads,
        (section, gear): (usize, usize),
    ) -> f64 {
        if slopes.is_empty() {
            return 0.0;
        }
        let modal = &flanks.modal[gear];
        let (first, count) = flanks.sections[section].contacts;
        let mut rate = 0.0;
        for (mode, omega_squared) in modal.omega_squared.iter().enumerate() {
            let sum = |values: &[f64], contacts: std::ops::Range<usize>| -> f64 {
                let each = contacts.map(|i| loads.normal_n[i] * values[i * modal.count() + mode]);
                each.sum()
            };
            rate += sum(slopes, first..first + count)
                * sum(&modal.shapes, 0..flanks.contacts.len())
                / omega_squared;
        }
        rate
    }

    fn fill_tangent(&mut self, loads: &mut TeethLoads) {
        let n = self.row.len();
        let size = self.patches.len();
        if let Some(joint) = &self.joint {
            for (j, &column) in self.row.iter().enumerate() {
                for (i, &row) in self.row.iter().enumerate() {
                    if row != NOWHERE && column != NOWHERE {
                        loads.stiffness_n_per_m[i * n + j] =
                            joint.stiffness_n_per_m[row * size + column];
                    }
                }
            }
            return;
        }
        self.change.resize(size, 0.0);
        self.unit.clear();
        self.unit.resize(size, 0.0);
        for (j, &row) in self.row.iter().enumerate() {
            if row == NOWHERE || loads.normal_n[j] <= 0.0 {
                continue;
            }
            self.unit[row] = -1.0;
            self.slices.apply_tangent(&self.unit, &mut self.change);
            self.unit[row] = 0.0;
            for (i, &other) in self.row.iter().enumerate() {
                if other != NOWHERE {
                    loads.stiffness_n_per_m[i * n + j] = self.change[other];
                }
            }
        }
    }

    /// Writes the forces of the last solution.
    fn fill(&mut self, flanks: &FlankContacts, tangents: bool, loads: &mut TeethLoads) {
        let forces = self.slices.forces_n();
        for (force, &row) in loads.normal_n.iter_mut().zip(&self.row) {
            if row != NOWHERE {
                *force = forces[row];
            }
        }
        loads.stored_j = self.slices.stored_energy_j();
        if tangents {
            self.fill_tangent(loads);
        }
        self.fill_energy(flanks, loads);
    }

    fn fill_energy(&self, flanks: &FlankContacts, loads: &mut TeethLoads) {
        for (number, section) in flanks.sections.iter().enumerate() {
            let (first, count) = section.contacts;
            let loaded = (first..first + count).filter(|i| loads.normal_n[*i] > 0.0);
            let rows = loaded.map(|i| self.row[i]);
            if rows.clone().next().is_none() {
                continue;
            }
            for gear in 0..2 {
                // At the end of a flank the contact no longer walks.
                if section.walks(gear) {
                    let joint = self.joint.as_ref();
                    let shared =
                        |row: usize| joint.map_or(0.0, |joint| joint.energy_by_u[row][gear]);
                    let walking =
                        (rows.clone()).map(|row| self.slices.energy_by_u(row, gear) + shared(row));
                    let of_modes = (flanks, &flanks.modal[gear].slopes[..]);
                    loads.energy_by_roll[number][gear] =
                        walking.sum::<f64>() - self.modal_energy(of_modes, loads, (number, gear));
                }
            }
            for gear in 0..2 {
                let along = rows.clone().map(|row| self.slices.energy_by_v(row, gear));
                let of_modes = (flanks, &flanks.modal[gear].slopes_along[..]);
                loads.energy_by_height[number][gear] =
                    along.sum::<f64>() - self.modal_energy(of_modes, loads, (number, gear));
            }
            if section.share_gradient != Vector6::zeros() {
                let growing = rows.map(|row| self.slices.energy_by_share(row));
                loads.energy_by_share[number] = growing.sum();
            }
        }
    }
}

impl TeethModel for ReducedTeeth {
    fn evaluate(
        &mut self,
        flanks: &FlankContacts,
        tangents: bool,
        loads: &mut TeethLoads,
    ) -> Result<(), DrivetrainError> {
        if self.joint.is_some() {
            self.fill_joint(flanks, tangents, loads);
            return Ok(());
        }
        if flanks.contacts.iter().all(|contact| contact.gap_m >= 0.0) {
            self.patches.clear();
            self.teeth.clear();
            return Ok(());
        }
        self.check_displacement(flanks)?;
        self.take(flanks, flanks.deepest_overlap_m());
        let (patches, floor_n) = (&self.patches, self.floor_n);
        let goes_on = match self.iterate {
            Iterate::Single => self.slices.prepare(patches, floor_n, true).map(|()| false),
            Iterate::First => (self.slices.prepare_to_keep(patches, floor_n)).map(|()| false),
            Iterate::Correction => self.slices.prepare_nearby(patches, floor_n),
        }?;
        self.take_modes_out(flanks);
        if !goes_on {
            self.begin_solution();
        }
        self.slices.solve(Drive::TransmissionError(0.0))?;
        self.fill(flanks, tangents, loads);
        Ok(())
    }

    fn coupled(&self) -> Option<&ReducedTeeth> {
        Some(self)
    }

    fn coupled_mut(&mut self) -> Option<&mut ReducedTeeth> {
        Some(self)
    }

    fn prepare(&mut self, flanks: &FlankContacts, deepest_m: f64) -> Result<(), DrivetrainError> {
        self.take(flanks, deepest_m.max(flanks.deepest_overlap_m()));
        if !self.patches.is_empty() {
            self.check_displacement(flanks)?;
        }
        Ok(self.slices.prepare(&self.patches, self.floor_n, true)?)
    }

    fn apply_stiffness(
        &mut self,
        _flanks: &FlankContacts,
        _loads: &TeethLoads,
        opening_m: &[f64],
        forces_n: &mut [f64],
    ) {
        forces_n.fill(0.0);
        let size = self.patches.len();
        if size == 0 {
            return;
        }
        if let Some(joint) = &self.joint {
            // Asked of what is felt ahead only, which all meshes were solved for together.
            for (&row, force) in self.row.iter().zip(forces_n) {
                if row != NOWHERE {
                    *force = joint.drag_n[row];
                }
            }
            return;
        }
        self.unit.clear();
        self.unit.resize(size, 0.0);
        self.change.resize(size, 0.0);
        for (&row, opening) in self.row.iter().zip(opening_m) {
            if row != NOWHERE {
                self.unit[row] = -opening;
            }
        }
        self.slices.apply_tangent(&self.unit, &mut self.change);
        for (&row, force) in self.row.iter().zip(forces_n) {
            if row != NOWHERE {
                *force = self.change[row];
            }
        }
    }

    fn expect(&mut self, iterate: Iterate) {
        self.iterate = iterate;
        // Nothing goes from one step to the next.
        if iterate != Iterate::Correction {
            self.slices.forget_kept();
        }
    }

    fn takes_modes(&self) -> bool {
        true
    }

    fn remember(&mut self) {
        self.known.teeth.clear();
        self.known.forces_n.clear();
        if self.patches.is_empty() {
            return;
        }
        self.known.teeth.extend(&self.teeth);
        let slices = self.slices.slices();
        self.known.forces_n.resize(self.teeth.len() * slices, 0.0);
        for (patch, force) in self.patches.iter().zip(self.slices.forces_n()) {
            self.known.forces_n[patch.line * slices + patch.slice] = *force;
        }
    }

    /// Number of lines, then the teeth and forces of as many lines as there can be.
    fn save(&self, out: &mut Vec<f64>) {
        let slices = self.slices.slices();
        let lines = self.slices.capacity() / slices;
        out.push(self.known.teeth.len() as f64);
        let first = out.len();
        out.resize(first + lines * (2 + slices), 0.0);
        let places = out[first..].chunks_exact_mut(2 + slices);
        let forces = self.known.forces_n.chunks_exact(slices);
        for ((place, teeth), forces) in places.zip(&self.known.teeth).zip(forces) {
            place[..2].copy_from_slice(&teeth.map(|tooth| tooth as f64));
            place[2..].copy_from_slice(forces);
        }
    }

    fn restore(&mut self, numbers: &[f64]) {
        self.known.teeth.clear();
        self.known.forces_n.clear();
        let Some((&lines, rest)) = numbers.split_first() else {
            return;
        };
        let places = rest.chunks_exact(2 + self.slices.slices());
        for place in places.take(lines as usize) {
            self.known
                .teeth
                .push([place[0] as usize, place[1] as usize]);
            self.known.forces_n.extend_from_slice(&place[2..]);
        }
    }
}
