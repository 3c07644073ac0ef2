//! Forces and transmission error of a pair at one position.
//!
//! g = C F + local(F) + e − x ≥ 0, F ≥ 0, gᵀF = 0, with x = −TE the rigid approach along the line of action, and where
//! the driven torque is given Σ F_i b_i = T₂, b_i = r_b2 + μ_i ρ₂ (friction towards the tip of gear 2 helps to turn it).
//! Beyond the ends of the path a tip edge touches: there x closes the gap at the rate w_i = b_i/r_b2 (without friction)
//! and the compliance of the tip tooth is that of the force's component along its own flank's normal.
//!
//! Errors of single flanks open gaps (flank_deviations.rs), gears beside their axes move the teeth (runout.rs).
//!
//! Helical teeth: gaps are measured along the normal, so that the approach closes them at w_i = cos β_b, the lever arms are
//! b_i = r_b2 cos β_b + μ_i ρ₂, every slice has its own roll angle, and the forces have an axial part, ∓F sin β_b.

use crate::contact_error::ContactError;
use crate::contact_lines::{ContactLine, ContactLines, Friction};
use crate::contact_slices::ContactSlice;
use crate::flank_deviations::FlankDeviations;
use crate::hertz;
use crate::local_contact::LocalContact;
use crate::nlcp::{FLOOR_FRACTION, Info};
use crate::runout::{Placement, Runout};
use crate::slice_contact::{Given, Separations, SliceContact};
use gearmesh_model::ReducedGear;

/// Gap of a slice without flank \[m\]: beyond any deflection, and small enough for the solver's sums.
const NO_FLANK_M: f64 = 1.0;

/// What a contact computation includes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactOptions {
    /// Local contact compliance.
    pub local: LocalContact,
    /// Friction, or none.
    pub friction: Option<Friction>,
}

/// What drives the contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Drive {
    /// Torque on gear 2 \[N·m\]; the transmission error follows.
    Torque(f64),
    /// Transmission error \[m\]; the torque follows.
    TransmissionError(f64),
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

/// Contact of two reduced gears, with all memory it needs.
#[derive(Debug, Clone)]
pub struct StaticContact {
    slices: SliceContact,
    friction: Option<Friction>,
    deviations: FlankDeviations,
    runout: Option<Runout>,
    active: Vec<ContactLine>,
    touching: Vec<ContactSlice>,
    forces: Vec<f64>,
    separation: Vec<f64>,
    closing: Vec<f64>,
    lever_2: Vec<f64>,
    lever_1: Vec<f64>,
}

impl StaticContact {
    /// Prepares the contact of two gears on the flanks that the pair names.
    ///
    /// # Errors
    /// [`ContactError`] when the models do not fit the pair or each other.
    pub fn new(
        lines: ContactLines,
        gear_1: &ReducedGear,
        gear_2: &ReducedGear,
        options: ContactOptions,
    ) -> Result<Self, ContactError> {
        let slices = SliceContact::new(lines, gear_1, gear_2, options.local)?;
        let capacity = slices.capacity();
        Ok(Self {
            slices,
            friction: options.friction,
            deviations: FlankDeviations::default(),
            runout: None,
            active: Vec::with_capacity(capacity),
            touching: Vec::with_capacity(capacity),
            forces: Vec::with_capacity(capacity),
            separation: Vec::with_capacity(capacity),
            closing: Vec::with_capacity(capacity),
            lever_2: Vec::with_capacity(capacity),
            lever_1: Vec::with_capacity(capacity),
        })
    }

    /// Adds errors and faults of single flanks.
    #[must_use]
    pub fn with_deviations(mut self, deviations: FlankDeviations) -> Self {
        self.deviations = deviations;
        self
    }

    /// Lets the gears stand beside, or tilted to, the axes about which they turn.
    #[must_use]
    pub fn with_runout(mut self, runout: Runout) -> Self {
        self.runout = Some(runout);
        self
    }

    /// Slices per contact line.
    pub fn slices(&self) -> usize {
        self.slices.slices()
    }

    /// Width of a slice \[m\].
    pub fn slice_width_m(&self) -> f64 {
        self.slices.slice_width_m()
    }

    /// Contact lines of the last position, in the order of the forces.
    pub fn active_lines(&self) -> &[ContactLine] {
        &self.active
    }

    /// Slices that touch or may touch at the last position.
    pub fn active_slices(&self) -> &[ContactSlice] {
        &self.touching
    }

    /// Normal forces of the last position \[N\], `[line][slice]`, zero for slices that are off the path.
    pub fn forces_n(&self) -> &[f64] {
        &self.forces
    }

    /// Normal force of an active slice \[N\].
    pub fn force_n(&self, slice: &ContactSlice) -> f64 {
        self.forces[slice.line * self.slices() + slice.slice]
    }

    /// Forgets the last solution: the next position starts cold.
    pub fn reset(&mut self) {
        self.slices.reset();
    }

    /// Half width a \[m\] and peak pressure 2q/(πa) \[Pa\] of the Hertz contact of the active slice with this number under a
    /// normal force; q is the force over the slice's length along the contact line. At a tip edge those of the Hertz
    /// contact that gives way as the edge does.
    ///
    /// # Panics
    /// If there is no such slice.
    pub fn hertz(&self, active_slice: usize, force_n: f64) -> (f64, f64) {
        let (contact, edge) = self.slices.hertz(active_slice);
        let share = edge.map_or(1.0, |e| e.half_width_share(force_n));
        let a = contact.half_width_m(force_n) * share;
        (a, hertz::peak_pressure_pa(force_n / contact.width_m, a))
    }

    /// Solves one position. Lines and forces are left in [`StaticContact::active_lines`] and
    /// [`StaticContact::forces_n`]. No allocation.
    ///
    /// # Errors
    /// [`ContactError::Nlcp`] when the solver does not converge, [`ContactError::LocalLaw`] when no local law exists.
    pub fn solve(
        &mut self,
        driver_angle_rad: f64,
        drive: Drive,
    ) -> Result<ContactState, ContactError> {
        let placement = (self.runout).map_or_else(Placement::default, |runout| {
            runout.at(&self.slices.lines().pair, driver_angle_rad)
        });
        self.slices.place(&placement);
        let lines = self.slices.lines();
        lines.at(driver_angle_rad + placement.ahead_rad, &mut self.active);
        let (centres, width) = (self.slices.slice_centres_m(), self.slices.slice_width_m());
        self.touching.clear();
        for line in self.active.iter().enumerate() {
            lines.push_slices(line, centres, width, &mut self.touching);
        }
        let side = lines.pair.flank;
        let angle_deg = driver_angle_rad.to_degrees();
        let bases = [
            lines.pair.gear_1.base_radius_m,
            lines.pair.gear_2.base_radius_m,
        ];
        let mut some_flank = false;
        let transverse = lines.pair.base_helix_angle_rad().cos();
        self.separation.clear();
        self.closing.clear();
        self.lever_1.clear();
        self.lever_2.clear();
        for slice in &self.touching {
            let line = &slice.section;
            let friction = self.friction.map_or(0.0, |f| f.ratio(line.path_m));
            let [lever_1, lever_2] = lines.lever_arms_m(line, friction);
            let [arm_1, arm_2] = placement.arms_m.map(|arm| transverse * arm);
            let closing = lines.closing(line) + arm_2 / bases[1];
            let heights = lines.zone.heights_m(slice.z_m);
            let deviation = self.deviations.opening_m(line, side, heights);
            some_flank |= deviation.is_finite();
            // Gears beside their axes stand as rigid flanks leave them; the gap is linear in the approach about there.
            self.separation.push(
                lines.separation_m(line, slice.z_m)
                    + deviation.min(NO_FLANK_M)
                    + closing * placement.opening_m,
            );
            self.closing.push(closing);
            self.lever_1.push(lever_1 + arm_1);
            self.lever_2.push(lever_2 + arm_2);
        }
        if !some_flank {
            return Err(ContactError::NoFlanks { angle_deg });
        }
        let base_2 = bases[1];
        let axial_share_1 = lines.axial_share_1();
        let scale_force = match drive {
            Drive::Torque(torque) => torque.abs() / (base_2 * self.touching.len() as f64),
            Drive::TransmissionError(_) => 0.0,
        };
        let floor = FLOOR_FRACTION * scale_force.max(1.0);
        (self.slices.prepare(&self.active, &self.touching, floor))
            .map_err(|(cause, _)| ContactError::LocalLaw { angle_deg, cause })?;
        let separations = Separations {
            separation_m: &self.separation,
            closing: &self.closing,
            lever_m: &self.lever_2,
        };
        let given = match drive {
            Drive::Torque(torque) => Given::Load(torque),
            Drive::TransmissionError(te) => Given::Approach(-te),
        };
        let (first_contact, info) = (self.slices.solve(separations, given))
            .map_err(|cause| ContactError::Nlcp { angle_deg, cause })?;
        let forces = self.slices.forces_n();
        let torque_1_nm = forces.iter().zip(&self.lever_1).map(|(f, b)| f * b).sum();
        let axial_force_1_n = axial_share_1 * forces.iter().sum::<f64>();
        let slices = self.slices.slices();
        self.forces.clear();
        self.forces.resize(self.active.len() * slices, 0.0);
        for (slice, force) in self.touching.iter().zip(forces) {
            self.forces[slice.line * slices + slice.slice] = *force;
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
