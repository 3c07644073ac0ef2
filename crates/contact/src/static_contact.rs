//! Forces and transmission error of a pair at one position.
//!
//! g = C F + local(F) + e − x ≥ 0, F ≥ 0, gᵀF = 0, with x = −TE the rigid approach along the line of action, and where
//! the driven torque is given Σ F_i b_i = T₂, b_i = r_b2 + μ_i ρ₂ (friction towards the tip of gear 2 helps to turn it).
//! Beyond the ends of the path a tip edge touches: there x closes the gap at the rate w_i = b_i/r_b2 (without friction)
//! and the compliance of the tip tooth is that of the force's component along its own flank's normal.
//!
//! Helical teeth: gaps are measured along the normal, so that the approach closes them at w_i = cos β_b, the lever arms are
//! b_i = r_b2 cos β_b + μ_i ρ₂, every slice has its own roll angle, and the forces have an axial part, ∓F sin β_b.

use crate::contact_lines::{ContactLine, ContactLines, Friction};
use crate::contact_slices::ContactSlice;
use crate::hertz;
use crate::local_contact::LocalContact;
use crate::nlcp::{
    ContactBody, EdgeContact, FLOOR_FRACTION, Info, LineContact, LocalLaw, LocalLawError,
    NlcpError, Params, Problem, Workspace, solve_load, solve_position,
};
use crate::slice_compliance::{PlacedSlice, SliceCompliance};
use gearmesh_geometry::FlankSide;
use gearmesh_model::{Flank, ReducedGear, ReducedGearError};

/// What a contact computation includes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactOptions {
    /// Local contact compliance.
    pub local: LocalContact,
    /// Friction, or none.
    pub friction: Option<Friction>,
}

/// Why no contact state could be computed.
#[derive(Debug, thiserror::Error)]
pub enum ContactError {
    /// The model does not carry loads on the flank in contact.
    #[error(transparent)]
    Model(#[from] ReducedGearError),
    /// The two models have different slices.
    #[error(
        "the gears have {slices_1} and {slices_2} slices of {width_1_mm:.4} and {width_2_mm:.4} mm; reduce both with the same reduction.slices and face width"
    )]
    Slices {
        /// Slices of gear 1.
        slices_1: usize,
        /// Slices of gear 2.
        slices_2: usize,
        /// Slice width of gear 1.
        width_1_mm: f64,
        /// Slice width of gear 2.
        width_2_mm: f64,
    },
    /// The model's teeth are not those of the pair.
    #[error("the model of gear {gear} has {found} teeth, the pair needs {needed}")]
    Teeth {
        /// Gear 1 or 2.
        gear: usize,
        /// Teeth of the model.
        found: usize,
        /// Teeth of the pair.
        needed: usize,
    },
    /// Tip edges of helical teeth are not modelled.
    #[error(
        "helical teeth touch on the path of contact only: an extended path needs spur gears; leave the extension out"
    )]
    HelicalExtension,
    /// No local law.
    #[error("at driver angle {angle_deg:.4} deg: {cause}")]
    LocalLaw {
        /// Driver angle.
        angle_deg: f64,
        /// Cause.
        cause: LocalLawError,
    },
    /// No solution.
    #[error("at driver angle {angle_deg:.4} deg: {cause}")]
    Nlcp {
        /// Driver angle.
        angle_deg: f64,
        /// Cause.
        cause: NlcpError,
    },
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
    lines: ContactLines,
    compliance_1: SliceCompliance,
    compliance_2: SliceCompliance,
    options: ContactOptions,
    params: Params,
    active: Vec<ContactLine>,
    touching: Vec<ContactSlice>,
    placed: Vec<[PlacedSlice; 2]>,
    forces: Vec<f64>,
    c: Vec<f64>,
    /// Hertz contact of each touching slice, and the edge where it is one.
    hertz: Vec<(LineContact, Option<EdgeContact>)>,
    local: Vec<LocalLaw>,
    separation: Vec<f64>,
    closing: Vec<f64>,
    lever_2: Vec<f64>,
    lever_1: Vec<f64>,
    work: Workspace,
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
        if lines.pair.is_helical() && lines.extension.is_some() {
            return Err(ContactError::HelicalExtension);
        }
        let flank = match lines.pair.flank {
            FlankSide::Right => Flank::Right,
            FlankSide::Left => Flank::Left,
        };
        for (gear, model, needed) in [
            (1, gear_1, lines.pair.gear_1.teeth),
            (2, gear_2, lines.pair.gear_2.teeth),
        ] {
            if model.teeth != needed {
                return Err(ContactError::Teeth {
                    gear,
                    found: model.teeth,
                    needed,
                });
            }
        }
        let compliance_1 = SliceCompliance::new(gear_1, flank, options.local)?;
        let compliance_2 = SliceCompliance::new(gear_2, flank, options.local)?;
        let (w1, w2) = (compliance_1.slice_width_m(), compliance_2.slice_width_m());
        if compliance_1.slices() != compliance_2.slices() || (w1 - w2).abs() > 1e-9 * w1 {
            return Err(ContactError::Slices {
                slices_1: compliance_1.slices(),
                slices_2: compliance_2.slices(),
                width_1_mm: w1 * 1e3,
                width_2_mm: w2 * 1e3,
            });
        }
        let capacity = (lines.most_pairs() + 1) * compliance_1.slices();
        Ok(Self {
            lines,
            compliance_1,
            compliance_2,
            options,
            params: Params::default(),
            active: Vec::with_capacity(capacity),
            touching: Vec::with_capacity(capacity),
            placed: Vec::with_capacity(capacity),
            forces: Vec::with_capacity(capacity),
            c: vec![0.0; capacity * capacity],
            hertz: Vec::with_capacity(capacity),
            local: Vec::with_capacity(capacity),
            separation: Vec::with_capacity(capacity),
            closing: Vec::with_capacity(capacity),
            lever_2: Vec::with_capacity(capacity),
            lever_1: Vec::with_capacity(capacity),
            work: Workspace::new(capacity),
        })
    }

    /// Slices per contact line.
    pub fn slices(&self) -> usize {
        self.compliance_1.slices()
    }

    /// Width of a slice \[m\].
    pub fn slice_width_m(&self) -> f64 {
        self.compliance_1.slice_width_m()
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
        self.work.reset();
    }

    /// Half width a \[m\] and peak pressure 2q/(πa) \[Pa\] of the Hertz contact of the active slice with this number under a
    /// normal force; q is the force over the slice's length along the contact line. At a tip edge those of the Hertz
    /// contact that gives way as the edge does.
    ///
    /// # Panics
    /// If there is no such slice.
    pub fn hertz(&self, active_slice: usize, force_n: f64) -> (f64, f64) {
        let (contact, edge) = self.hertz[active_slice];
        let share = edge.map_or(1.0, |e| e.half_width_share(force_n));
        let a = contact.half_width_m(force_n) * share;
        (a, hertz::peak_pressure_pa(force_n / contact.width_m, a))
    }

    fn edge(&self, line: &ContactLine, contact: &LineContact) -> Option<EdgeContact> {
        let (tilt_rad, radius_m) = self.lines.edge(line)?;
        EdgeContact::new(contact, tilt_rad, radius_m)
    }

    fn line_contact(&self, slice: &ContactSlice) -> LineContact {
        let line = &slice.section;
        let helix_cos = self.lines.pair.base_helix_angle_rad().cos();
        let body = |compliance: &SliceCompliance, roll: f64| {
            let (youngs_modulus_pa, poisson_ratio) = compliance.material();
            ContactBody {
                youngs_modulus_pa,
                poisson_ratio,
                depth_m: compliance.local_depth_m(roll, slice.share),
            }
        };
        LineContact {
            width_m: slice.share * self.slice_width_m() / helix_cos,
            relative_radius_m: self.lines.relative_radius_m(line),
            bodies: [
                body(&self.compliance_1, line.roll_1_rad),
                body(&self.compliance_2, line.roll_2_rad),
            ],
        }
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
        self.lines.at(driver_angle_rad, &mut self.active);
        let (centres, width) = (
            self.compliance_1.slice_centres_m(),
            self.compliance_1.slice_width_m(),
        );
        self.touching.clear();
        for line in self.active.iter().enumerate() {
            self.lines
                .push_slices(line, centres, width, &mut self.touching);
        }
        let n = self.touching.len();
        if self.lines.pair.is_helical() {
            self.fill_compliance_by_slices();
        } else {
            self.fill_compliance_by_lines();
        }

        let base_2 = self.lines.pair.gear_2.base_radius_m;
        let scale_force = match drive {
            Drive::Torque(torque) => torque.abs() / (base_2 * n as f64),
            Drive::TransmissionError(_) => 0.0,
        };
        let floor = FLOOR_FRACTION * scale_force.max(1.0);
        self.hertz.clear();
        self.local.clear();
        self.separation.clear();
        self.closing.clear();
        self.lever_1.clear();
        self.lever_2.clear();
        let mut last: Option<(usize, (LineContact, Option<EdgeContact>), LocalLaw)> = None;
        for slice in &self.touching {
            let line = &slice.section;
            let (hertz, law) = match last {
                // The slices of a spur line are all alike.
                Some((number, hertz, law))
                    if number == slice.line && !self.lines.pair.is_helical() =>
                {
                    (hertz, law)
                }
                _ => {
                    let contact = self.line_contact(slice);
                    let edge = self.edge(line, &contact);
                    let law = (self.options.local)
                        .law(&contact, floor)
                        .map_err(|cause| ContactError::LocalLaw {
                            angle_deg: driver_angle_rad.to_degrees(),
                            cause,
                        })?
                        .with_edge(edge);
                    ((contact, edge), law)
                }
            };
            last = Some((slice.line, hertz, law));
            let friction = self.options.friction.map_or(0.0, |f| f.ratio(line.path_m));
            let [lever_1, lever_2] = self.lines.lever_arms_m(line, friction);
            self.hertz.push(hertz);
            self.local.push(law);
            self.separation
                .push(self.lines.separation_m(line, slice.z_m));
            self.closing.push(self.lines.closing(line));
            self.lever_1.push(lever_1);
            self.lever_2.push(lever_2);
        }
        let nlcp = |cause| ContactError::Nlcp {
            angle_deg: driver_angle_rad.to_degrees(),
            cause,
        };
        let problem = Problem::new(
            &self.c[..n * n],
            &self.local,
            &self.separation,
            &self.closing,
            &self.lever_2,
        )
        .map_err(nlcp)?;
        let unloaded_m = -problem.first_contact();
        let info = match drive {
            Drive::Torque(torque) => solve_load(&problem, torque, &self.params, &mut self.work),
            Drive::TransmissionError(te) => {
                solve_position(&problem, -te, &self.params, &mut self.work)
            }
        }
        .map_err(nlcp)?;
        let forces = self.work.forces();
        let torque_1_nm = forces.iter().zip(&self.lever_1).map(|(f, b)| f * b).sum();
        let axial_force_1_n = self.lines.axial_share_1() * forces.iter().sum::<f64>();
        let slices = self.compliance_1.slices();
        self.forces.clear();
        self.forces.resize(self.active.len() * slices, 0.0);
        for (slice, force) in self.touching.iter().zip(forces) {
            self.forces[slice.line * slices + slice.slice] = *force;
        }
        Ok(ContactState {
            transmission_error_m: -info.approach_m,
            unloaded_m,
            torque_2_nm: info.load,
            torque_1_nm,
            axial_force_1_n,
            torque_rate_n: info.stiffness,
            info,
        })
    }

    /// C of slices that share the place of their line, block by block.
    fn fill_compliance_by_lines(&mut self) {
        let slices = self.slices();
        let n = self.active.len() * slices;
        let c = &mut self.c[..n * n];
        c.fill(0.0);
        for (i, a) in self.active.iter().enumerate() {
            for (j, b) in self.active.iter().enumerate() {
                let first = i * slices * n + j * slices;
                for (gear, compliance, of) in [
                    (
                        0,
                        &self.compliance_1,
                        [(a.tooth_1, a.roll_1_rad), (b.tooth_1, b.roll_1_rad)],
                    ),
                    (
                        1,
                        &self.compliance_2,
                        [(a.tooth_2, a.roll_2_rad), (b.tooth_2, b.roll_2_rad)],
                    ),
                ] {
                    let [(tooth_a, roll_a), (tooth_b, roll_b)] = of;
                    let places = (compliance.place(roll_a), compliance.place(roll_b));
                    let along_normals = a.tilt_rad(gear).cos() * b.tilt_rad(gear).cos();
                    compliance.add_block(
                        (tooth_a, places.0),
                        (tooth_b, places.1),
                        along_normals,
                        c,
                        first,
                        n,
                    );
                }
            }
        }
        symmetrise(c, n);
    }

    /// C of slices that each have their own place, entry by entry.
    fn fill_compliance_by_slices(&mut self) {
        let n = self.touching.len();
        let gears = [&self.compliance_1, &self.compliance_2];
        self.placed.clear();
        self.placed.extend(self.touching.iter().map(|s| {
            let line = &s.section;
            let placed = |gear: usize, tooth: usize, roll: f64| PlacedSlice {
                tooth,
                slice: s.slice,
                place: gears[gear].place(roll),
            };
            [
                placed(0, line.tooth_1, line.roll_1_rad),
                placed(1, line.tooth_2, line.roll_2_rad),
            ]
        }));
        let c = &mut self.c[..n * n];
        for (i, a) in self.placed.iter().enumerate() {
            for (j, b) in self.placed.iter().enumerate() {
                c[i * n + j] =
                    gears[0].between_slices(a[0], b[0]) + gears[1].between_slices(a[1], b[1]);
            }
        }
        symmetrise(c, n);
        if self.options.local == LocalContact::None {
            // No local term takes the force of a slice that is partly on the path to zero with its share: the slice's own
            // compliance grows instead.
            for (i, slice) in self.touching.iter().enumerate() {
                c[i * n + i] /= slice.share;
            }
        }
    }
}

/// The blocks between two teeth are stored for each of them as load and as response; they agree to the round-off of
/// the reduction, and the solver wants them equal.
fn symmetrise(c: &mut [f64], n: usize) {
    for i in 0..n {
        for j in 0..i {
            let mean = 0.5 * (c[i * n + j] + c[j * n + i]);
            c[i * n + j] = mean;
            c[j * n + i] = mean;
        }
    }
}
