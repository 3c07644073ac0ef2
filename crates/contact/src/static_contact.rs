//! Forces and transmission error of a pair at rest, at one position.
//!
//! g = C F + local(F) + e − x ≥ 0, F ≥ 0, gᵀF = 0, with x = −TE the rigid approach along the line of action, and where
//! the driven torque is given Σ F_i b_i = T₂, b_i = r_b2 + μ_i ρ₂ (friction towards the tip of gear 2 helps to turn
//! it). Beyond the ends of the path a tip edge touches: there x closes the gap at the rate w_i = b_i/r_b2 (without
//! friction) and the compliance of the tip tooth is that of the force's component along its own flank's normal.
//!
//! Errors of single flanks open gaps (flank_deviations.rs), gears beside their axes move the teeth (runout.rs).
//!
//! Helical teeth: gaps are measured along the normal, so that the approach closes them at w_i = cos β_b, the lever arms
//! are b_i = r_b2 cos β_b + μ_i ρ₂, every slice has its own roll angle, and the forces have an axial part, ∓F sin β_b.

use crate::condensed_flanks::CondensedFlanks;
use crate::contact_error::ContactError;
use crate::contact_lines::{ContactLine, ContactLines, Friction};
use crate::contact_patch::ContactPatch;
use crate::contact_zone::SliceLayout;
use crate::drive::Drive;
use crate::flank_deviations::FlankDeviations;
use crate::flanks_at_rest::FlanksAtRest;
use crate::hertz;
use crate::involute_at_rest::{InvoluteAtRest, most_lines};
use crate::local_contact::LocalContact;
use crate::nlcp::{FLOOR_FRACTION, Info};
use crate::runout::Runout;
use crate::slice_contact::SliceContact;
use crate::tip_contact::TipGear;
use gearmesh_model::ReducedGear;

/// What a contact computation includes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactOptions {
    /// Local contact compliance.
    pub local: LocalContact,
    /// Friction, or none.
    pub friction: Option<Friction>,
}

/// The solution at one position, besides lines and forces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactState {
    /// Transmission error r_b2 θ₂ − r_b1 θ₁ \[m\]; negative under load.
    pub transmission_error_m: f64,
    /// Transmission error without load at this position \[m\]: first touch.
    pub unloaded_m: f64,
    /// Torque on gear 2 \[N·m\].
    pub torque_2_nm: f64,
    /// Torque on gear 1 \[N·m\]; differs from T₂ r_b1/r_b2 by friction.
    pub torque_1_nm: f64,
    /// Axial force on gear 1 \[N\], positive along +z; gear 2 feels the opposite. Zero for spur teeth.
    pub axial_force_1_n: f64,
    /// −dT₂/dTE \[N\]: tangent.
    pub torque_rate_n: f64,
    /// Solver effort and flags.
    pub info: Info,
}

/// Contact of two reduced gears, with all memory it needs; F: the family of their flanks, involute ones where nothing
/// is said.
#[derive(Debug, Clone)]
pub struct StaticContact<F = InvoluteAtRest> {
    flanks: F,
    slices: SliceContact,
    patches: Vec<ContactPatch>,
    forces: Vec<f64>,
}

impl StaticContact {
    /// Prepares the contact of two involute gears on the flanks that the pair names.
    ///
    /// # Errors
    /// [`ContactError`] when the models do not fit the pair or each other.
    pub fn new(
        lines: ContactLines,
        gear_1: &ReducedGear,
        gear_2: &ReducedGear,
        options: ContactOptions,
    ) -> Result<Self, ContactError> {
        let layout = SliceLayout::of_models([gear_1, gear_2], lines.zone.displacement_m);
        Self::on_slices(lines, [gear_1, gear_2], options, layout)
    }

    /// The same on the slices of a layout, see [`SliceLayout::resolved`].
    ///
    /// # Errors
    /// As [`StaticContact::new`].
    pub fn on_slices(
        lines: ContactLines,
        models: [&ReducedGear; 2],
        options: ContactOptions,
        layout: SliceLayout,
    ) -> Result<Self, ContactError> {
        let slices = Self::condensed(&lines, models, options.local, layout)?;
        Ok(Self::of_condensed(lines, slices, options.friction))
    }

    /// The bodies condensed to the slices of a layout: what of a contact does not depend on microgeometry, load or
    /// friction.
    ///
    /// # Errors
    /// As [`StaticContact::new`].
    pub fn condensed(
        lines: &ContactLines,
        models: [&ReducedGear; 2],
        local: LocalContact,
        layout: SliceLayout,
    ) -> Result<SliceContact, ContactError> {
        let teeth = [lines.pair.gear_1.teeth, lines.pair.gear_2.teeth];
        let flanks = (teeth, [0, 1].map(|gear| lines.pair.flank_of(gear)));
        let most = most_lines(lines);
        SliceContact::of_gears(
            models,
            flanks,
            (local, layout),
            most,
            &CondensedFlanks::default(),
        )
    }

    /// The contact of bodies that [`StaticContact::condensed`] has condensed for these lines, or for others of the same
    /// gears that are as many at most.
    #[must_use]
    pub fn of_condensed(
        lines: ContactLines,
        slices: SliceContact,
        friction: Option<Friction>,
    ) -> Self {
        let flanks = InvoluteAtRest::new(lines, *slices.layout(), friction);
        Self::of_flanks(flanks, slices)
    }

    /// Adds errors and faults of single flanks.
    #[must_use]
    pub fn with_deviations(mut self, deviations: FlankDeviations) -> Self {
        self.flanks.deviations = deviations;
        self
    }

    /// Lets the gears stand beside, or tilted to, the axes about which they turn.
    #[must_use]
    pub fn with_runout(mut self, runout: Runout) -> Self {
        self.flanks.runout = Some(runout);
        self
    }

    /// Contact lines of the last position, in the order of the forces.
    pub fn active_lines(&self) -> &[ContactLine] {
        self.flanks.active_lines()
    }
}

impl<F: FlanksAtRest> StaticContact<F> {
    /// The contact of flanks of any family that have been condensed to slices.
    pub fn of_flanks(flanks: F, slices: SliceContact) -> Self {
        let capacity = slices.capacity();
        Self {
            flanks,
            slices,
            patches: Vec::with_capacity(capacity),
            forces: Vec::with_capacity(capacity),
        }
    }

    /// Slices per contact line.
    pub fn slices(&self) -> usize {
        self.slices.slices()
    }

    /// Patches that touch or may touch at the last position.
    pub fn patches(&self) -> &[ContactPatch] {
        &self.patches
    }

    /// Pairs of teeth of the lines of the last position, in the order of the forces, and the gear whose tip edge
    /// touches along each, if one does.
    pub fn pairs_and_tips(&self) -> impl Iterator<Item = (i64, Option<TipGear>)> {
        (0..self.flanks.lines()).map(|line| self.flanks.pair_and_tip(line))
    }

    /// Normal forces of the last position \[N\], `[line][slice]`, zero for slices that are off the path.
    pub fn forces_n(&self) -> &[f64] {
        &self.forces
    }

    /// Normal force of a patch of the last position \[N\].
    pub fn force_n(&self, patch: &ContactPatch) -> f64 {
        self.forces[patch.line * self.slices() + patch.slice]
    }

    /// Forgets the last solution: the next position starts cold.
    pub fn reset(&mut self) {
        self.slices.reset();
    }

    /// Half width a \[m\] and peak pressure 2q/(πa) \[Pa\] of the Hertz contact of the patch with this number under a
    /// normal force; q is the force over the patch's length along the contact line. At a tip edge those of the Hertz
    /// contact that deflects as the edge does.
    ///
    /// # Panics
    /// If there is no such patch.
    pub fn hertz(&self, patch: usize, force_n: f64) -> (f64, f64) {
        let (contact, edge) = self.slices.hertz(patch);
        let share = edge.map_or(1.0, |e| e.half_width_share(force_n));
        let a = contact.half_width_m(force_n) * share;
        (a, hertz::peak_pressure_pa(force_n / contact.width_m, a))
    }

    /// Solves one position. Patches and forces are left in [`StaticContact::patches`] and [`StaticContact::forces_n`].
    /// No allocation.
    ///
    /// # Errors
    /// [`ContactError::At`] the driver angle: the solver does not converge, or no local law exists.
    pub fn solve(
        &mut self,
        driver_angle_rad: f64,
        drive: Drive,
    ) -> Result<ContactState, ContactError> {
        self.solve_at(driver_angle_rad, drive)
            .map_err(|cause| ContactError::At {
                angle_deg: driver_angle_rad.to_degrees(),
                cause: Box::new(cause),
            })
    }

    fn solve_at(
        &mut self,
        driver_angle_rad: f64,
        drive: Drive,
    ) -> Result<ContactState, ContactError> {
        let radius_2_m = self.flanks.radius_2_m();
        let (first_contact, info) = loop {
            self.patches.clear();
            (self.flanks).patches_at(driver_angle_rad, &mut self.patches)?;
            let scale_force = match drive {
                Drive::Torque(torque) => torque.abs() / (radius_2_m * self.patches.len() as f64),
                Drive::TransmissionError(_) => 0.0,
            };
            let floor = FLOOR_FRACTION * scale_force.max(1.0);
            self.slices.prepare(&self.patches, floor, false)?;
            let (first_contact, info) = self.slices.solve(drive)?;
            if self.flanks.reaches(info.approach_m)? {
                break (first_contact, info);
            }
        };
        let forces = self.slices.forces_n();
        let slices = self.slices.slices();
        self.forces.clear();
        self.forces.resize(self.flanks.lines() * slices, 0.0);
        let (mut torque_1_nm, mut axial_force_1_n) = (0.0, 0.0);
        for (patch, force) in self.patches.iter().zip(forces) {
            torque_1_nm += force * patch.balance.levers_m[0];
            axial_force_1_n -= force * patch.normal[2];
            self.forces[patch.line * slices + patch.slice] = *force;
        }
        Ok(ContactState {
            transmission_error_m: -info.approach_m,
            unloaded_m: -first_contact,
            torque_2_nm: info.load,
            torque_1_nm,
            axial_force_1_n,
            torque_rate_n: info.stiffness,
            info,
        })
    }
}
