//! `hybrid`: two reduced gears, their slices coupled through bodies, teeth and neighbouring teeth, and the complementarity problem.
//!
//! ```text
//! C F + δ(F) + gap ≥ 0,   F ≥ 0,   K = (C + diag δ′)⁻¹ on the slices that touch
//! ```
//!
//! The same solver as the static contact's, with the gaps of the pose instead of those of a driver angle. The compliance moves with the
//! roll angles: its part of the generalised force, ½ Fᵀ(∂C/∂ξ)F and that of the local laws, is included, so that undamped teeth keep
//! their energy. The tangent leaves out how C itself moves the forces, about 1e-3 of it.
//! Right and left flanks are solved one by one: a tooth wedged on both flanks at once does not feel itself across.

use gearmesh_contact::LocalContact;
use gearmesh_contact::contact_lines::{ContactLine, ContactLines};
use gearmesh_contact::contact_slices::ContactSlice;
use gearmesh_contact::nlcp::{FLOOR_FRACTION, LocalLawError, NlcpError};
use gearmesh_contact::slice_contact::{Given, Separations, SliceContact};
use gearmesh_geometry::{FlankSide, GearPair, Microgeometry};
use gearmesh_model::ReducedGear;

use crate::error::{DrivetrainError, positive};
use crate::mesh_kinematics::{FlankContacts, TeethLine, ToothContact};
use crate::teeth_model::{TeethLoads, TeethModel};

/// A pair whose nearest slice is open by more than this many times the deepest penetration of all is left out. No unit. What loaded
/// teeth make of other flanks' gaps is at most their own deflection times √(C_ii/C_jj), which stays below 3 on one gear.
const OUT_OF_REACH: f64 = 3.0;

/// A line that is left out.
const NOWHERE: usize = usize::MAX;

/// Separation \[m\] of a slice whose flank is gone.
const GONE_M: f64 = 1.0;

/// The teeth of two reduced gears on one side.
#[derive(Debug, Clone)]
pub struct ReducedTeeth {
    slices: SliceContact,
    floor_n: f64,
    /// Number of each line among those that are solved for.
    place: Vec<usize>,
    active: Vec<ContactLine>,
    touching: Vec<ContactSlice>,
    separation: Vec<f64>,
    ones: Vec<f64>,
    unit: Vec<f64>,
    change: Vec<f64>,
}

impl ReducedTeeth {
    /// The contact of two models on one side of the teeth. `nominal_force_n`: normal force of the nominal load, which sets the floor of
    /// the local law's logarithm.
    ///
    /// # Errors
    /// [`DrivetrainError::Contact`] when the models do not fit the pair, each other or the side, [`DrivetrainError::Value`].
    pub fn new(
        pair: &GearPair,
        side: FlankSide,
        models: [&ReducedGear; 2],
        local: LocalContact,
        nominal_force_n: f64,
    ) -> Result<Self, DrivetrainError> {
        positive("hybrid mesh", "the nominal force in N", nominal_force_n)?;
        let lines = ContactLines {
            pair: pair.clone().on_flanks(side),
            microgeometry_1: Microgeometry::default(),
            microgeometry_2: Microgeometry::default(),
            extension: None,
            face_width_m: models[0].face_width_m,
        };
        let slices = SliceContact::new(lines, models[0], models[1], local)?;
        let capacity = slices.capacity();
        let empty = || Vec::with_capacity(capacity);
        Ok(Self {
            floor_n: FLOOR_FRACTION * nominal_force_n / slices.slices() as f64,
            place: Vec::with_capacity(capacity),
            active: Vec::with_capacity(capacity),
            touching: Vec::with_capacity(capacity),
            separation: empty(),
            ones: vec![1.0; capacity],
            unit: empty(),
            change: empty(),
            slices,
        })
    }

    /// Axial centres of the slices \[m\]: the planes that the mesh kinematics must have.
    #[must_use]
    pub fn slice_centres_m(&self) -> &[f64] {
        self.slices.slice_centres_m()
    }

    /// Takes the lines within reach and the separations of a pose.
    fn take(&mut self, flanks: &FlankContacts) {
        self.active.clear();
        self.touching.clear();
        self.separation.clear();
        self.place.clear();
        let least = |contacts: &[ToothContact]| {
            let gaps = contacts.iter().map(|contact| contact.gap_m);
            gaps.fold(f64::INFINITY, f64::min)
        };
        let reach = -OUT_OF_REACH * least(&flanks.contacts);
        for line in &flanks.lines {
            let (first, count) = line.contacts;
            if least(&flanks.contacts[first..first + count]) > reach {
                self.place.push(NOWHERE);
                continue;
            }
            let number = self.active.len();
            self.place.push(number);
            let section = contact_line(line);
            self.active.push(section);
            let centres = self.slices.slice_centres_m().iter().enumerate();
            self.touching
                .extend(centres.map(|(slice, &z_m)| ContactSlice {
                    line: number,
                    slice,
                    share: 1.0,
                    z_m,
                    section,
                }));
        }
        self.separation.resize(self.touching.len(), GONE_M);
        for contact in &flanks.contacts {
            if let Some(row) = row_of(&self.place, contact, self.slices.slices()) {
                self.separation[row] = contact.gap_m;
            }
        }
    }

    fn fill_tangent(&mut self, flanks: &FlankContacts, loads: &mut TeethLoads) {
        let (n, slices) = (flanks.contacts.len(), self.slices.slices());
        let size = self.touching.len();
        self.change.resize(size, 0.0);
        self.unit.clear();
        self.unit.resize(size, 0.0);
        for (j, contact) in flanks.contacts.iter().enumerate() {
            let Some(row) = row_of(&self.place, contact, slices) else {
                continue;
            };
            if loads.normal_n[j] <= 0.0 {
                continue;
            }
            self.unit[row] = -1.0;
            self.slices.apply_tangent(&self.unit, &mut self.change);
            self.unit[row] = 0.0;
            for (i, other) in flanks.contacts.iter().enumerate() {
                if let Some(row) = row_of(&self.place, other, slices) {
                    loads.stiffness_n_per_m[i * n + j] = self.change[row];
                }
            }
        }
    }

    fn fill_energy(
        &mut self,
        flanks: &FlankContacts,
        loads: &mut TeethLoads,
    ) -> Result<(), DrivetrainError> {
        let slices = self.slices.slices();
        for (number, line) in flanks.lines.iter().enumerate() {
            let place = self.place[number];
            if place == NOWHERE {
                continue;
            }
            let own = &self.slices.forces_n()[place * slices..(place + 1) * slices];
            if own.iter().all(|force| *force == 0.0) {
                continue;
            }
            for gear in 0..2 {
                // At the end of a flank the contact no longer walks.
                if line.roll_rad[gear] == line.touching_roll_rad[gear] {
                    loads.energy_by_roll[number][gear] = (self.slices)
                        .energy_by_roll(&self.active, &self.touching, (place, gear), self.floor_n)
                        .map_err(|cause| local_law_error(line.teeth, cause))?;
                }
            }
        }
        Ok(())
    }
}

/// Row of a contact in the problem; none if its line is left out.
fn row_of(place: &[usize], contact: &ToothContact, slices: usize) -> Option<usize> {
    let number = place[contact.line];
    (number != NOWHERE).then(|| number * slices + contact.slice)
}

fn contact_line(line: &TeethLine) -> ContactLine {
    ContactLine {
        pair: 0,
        tooth_1: line.teeth[0],
        tooth_2: line.teeth[1],
        roll_1_rad: line.touching_roll_rad[0],
        roll_2_rad: line.touching_roll_rad[1],
        path_m: 0.0,
        tip: None,
    }
}

fn local_law_error(teeth: [usize; 2], cause: LocalLawError) -> DrivetrainError {
    DrivetrainError::LocalLaw {
        tooth_1: teeth[0],
        tooth_2: teeth[1],
        cause,
    }
}

impl TeethModel for ReducedTeeth {
    fn evaluate(
        &mut self,
        flanks: &FlankContacts,
        loads: &mut TeethLoads,
    ) -> Result<(), DrivetrainError> {
        if flanks.contacts.iter().all(|contact| contact.gap_m >= 0.0) {
            return Ok(());
        }
        self.take(flanks);
        let size = self.touching.len();
        if size > self.slices.capacity() {
            return Err(NlcpError::TooLarge {
                size,
                capacity: self.slices.capacity(),
            }
            .into());
        }
        let slices = self.slices.slices();
        (self
            .slices
            .prepare(&self.active, &self.touching, self.floor_n))
        .map_err(|(cause, slice)| {
            let line = &self.active[slice / slices];
            local_law_error([line.tooth_1, line.tooth_2], cause)
        })?;
        let separations = Separations {
            separation_m: &self.separation,
            closing: &self.ones[..size],
            lever_m: &self.ones[..size],
        };
        self.slices.solve(separations, Given::Approach(0.0))?;
        let forces = self.slices.forces_n();
        for (force, contact) in loads.normal_n.iter_mut().zip(&flanks.contacts) {
            if let Some(row) = row_of(&self.place, contact, slices) {
                *force = forces[row];
            }
        }
        loads.stored_j = self.slices.stored_energy_j();
        self.fill_tangent(flanks, loads);
        self.fill_energy(flanks, loads)
    }

    fn forget(&mut self) {
        self.slices.reset();
    }
}
