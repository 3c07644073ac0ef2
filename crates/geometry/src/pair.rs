//! Two gears at a centre distance: working pressure angle, path of contact, backlash, sliding, interference.

use crate::definition::Flank;
use crate::involute;
use crate::tip_in_fillet;
use crate::tooth::ToothGeometry;
use std::f64::consts::TAU;

/// Why two gears do not run together.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PairError {
    /// Different base pitches.
    #[error(
        "the transverse base pitches differ: {base_pitch_1_mm:.5} and {base_pitch_2_mm:.5} mm; module, pressure angle and helix angle of both gears must agree"
    )]
    BasePitch {
        /// Base pitch of gear 1.
        base_pitch_1_mm: f64,
        /// Base pitch of gear 2.
        base_pitch_2_mm: f64,
    },
    /// The helices do not fit on parallel axes.
    #[error(
        "the helices do not fit: base helix angles {helix_1_deg:.5} deg ({hand_1}) and {helix_2_deg:.5} deg ({hand_2}); external gears on parallel axes need equal angles of opposite hand"
    )]
    Helix {
        /// Base helix angle of gear 1 without its sign.
        helix_1_deg: f64,
        /// Hand of gear 1.
        hand_1: &'static str,
        /// Base helix angle of gear 2 without its sign.
        helix_2_deg: f64,
        /// Hand of gear 2.
        hand_2: &'static str,
    },
    /// The base circles overlap.
    #[error(
        "a centre distance of {centre_distance_mm:.4} mm is below the sum of the base radii, {smallest_mm:.4} mm: no line of action"
    )]
    CentreDistance {
        /// Centre distance given.
        centre_distance_mm: f64,
        /// Smallest possible.
        smallest_mm: f64,
    },
    /// The teeth are too thick for the centre distance.
    #[error(
        "the teeth do not fit: backlash {backlash_mm:.4} mm at the working pitch circle; raise the centre distance or lower the profile shifts"
    )]
    NoBacklash {
        /// Negative backlash.
        backlash_mm: f64,
    },
    /// A tip reaches into the other gear's root circle.
    #[error(
        "the tip of gear {gear} reaches into the root of its mate: clearance {clearance_mm:.4} mm"
    )]
    TipClearance {
        /// Gear whose tip is too long.
        gear: usize,
        /// Negative clearance.
        clearance_mm: f64,
    },
    /// A tip would run on the other gear's fillet.
    #[error(
        "the tip of gear {gear} would touch the fillet of its mate: contact down to radius {needed_mm:.4} mm, but the involute starts at {form_mm:.4} mm"
    )]
    FilletInterference {
        /// Gear whose tip is too long.
        gear: usize,
        /// Radius on the mate that the tip would reach.
        needed_mm: f64,
        /// Where the mate's involute starts.
        form_mm: f64,
    },
    /// A tip edge cuts into the other gear's fillet on its way through the tooth space.
    #[error(
        "the tip of gear {gear} cuts {depth_um:.2} um deep into the root fillet of its mate; shorten the tip or chamfer it, \
         or raise the clearance or the centre distance"
    )]
    TipInFillet {
        /// Gear whose tip is too long.
        gear: usize,
        /// Depth along the normal of the fillet.
        depth_um: f64,
    },
    /// Contact is lost between two pairs.
    #[error(
        "the transverse contact ratio is {contact_ratio:.4}: below 1 the pair loses contact between teeth (also helical gears are taken from 1 on only)"
    )]
    ContactRatio {
        /// Transverse contact ratio.
        contact_ratio: f64,
    },
}

/// Overlap of the teeth that counts as rounding of the numbers in files \[m\]: gears without backlash are let through.
const ROUNDING_M: f64 = 1e-9;

/// Small rotation of gear 2's axis against gear 1's, about mid-face.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Misalignment {
    /// Tilt in the plane of the axes: gear 2's axis moves away from gear 1 by this much per metre of z \[rad\].
    pub inclination_rad: f64,
    /// Tilt across the plane of the axes: opens the loaded flanks by cos α_w times this per metre of z \[rad\].
    pub deviation_rad: f64,
}

/// An external gear pair on parallel axes, spur or helical. Gear 1 drives; both are loaded on flanks of the same hand.
#[derive(Debug, Clone, PartialEq)]
pub struct GearPair {
    /// Driving gear.
    pub gear_1: ToothGeometry,
    /// Driven gear.
    pub gear_2: ToothGeometry,
    /// Centre distance a \[m\].
    pub centre_distance_m: f64,
    /// Working pressure angle α_w: cos α_w = (r_b1 + r_b2)/a \[rad\].
    pub working_pressure_angle_rad: f64,
    /// Axis errors.
    pub misalignment: Misalignment,
    /// Side of the flanks in contact, on both gears: right where gear 1 turns clockwise.
    pub flank: Flank,
    /// Roll angle on gear 1 where contact starts (tip of gear 2).
    pub roll_start_1_rad: f64,
    /// Roll angle on gear 1 where contact ends (tip of gear 1).
    pub roll_end_1_rad: f64,
}

impl GearPair {
    /// Checks that the gears run together and derives the path of contact, right flanks in contact.
    ///
    /// # Errors
    /// [`PairError`] with the numbers that make it impossible.
    pub fn new(
        gear_1: ToothGeometry,
        gear_2: ToothGeometry,
        centre_distance_m: f64,
        misalignment: Misalignment,
    ) -> Result<Self, PairError> {
        let base_pitch = |g: &ToothGeometry| TAU * g.base_radius_m / g.teeth as f64;
        let (p1, p2) = (base_pitch(&gear_1), base_pitch(&gear_2));
        if (p1 - p2).abs() > 1e-6 * p1 {
            return Err(PairError::BasePitch {
                base_pitch_1_mm: p1 * 1e3,
                base_pitch_2_mm: p2 * 1e3,
            });
        }
        let (h1, h2) = (gear_1.base_helix_angle_rad(), gear_2.base_helix_angle_rad());
        if (h1 + h2).abs() > 1e-6 * h1.abs() {
            return Err(PairError::Helix {
                helix_1_deg: h1.abs().to_degrees(),
                hand_1: gear_1.hand(),
                helix_2_deg: h2.abs().to_degrees(),
                hand_2: gear_2.hand(),
            });
        }
        let smallest = gear_1.base_radius_m + gear_2.base_radius_m;
        if centre_distance_m.is_nan() || centre_distance_m <= smallest {
            return Err(PairError::CentreDistance {
                centre_distance_mm: centre_distance_m * 1e3,
                smallest_mm: smallest * 1e3,
            });
        }
        let alpha_w = (smallest / centre_distance_m).acos();
        let line = centre_distance_m * alpha_w.sin();
        let mut pair = Self {
            roll_start_1_rad: (line - gear_2.base_radius_m * gear_2.flank_end_roll_rad)
                / gear_1.base_radius_m,
            roll_end_1_rad: gear_1.flank_end_roll_rad,
            gear_1,
            gear_2,
            centre_distance_m,
            working_pressure_angle_rad: alpha_w,
            misalignment,
            flank: Flank::Right,
        };
        for (gear, tip, mate) in [
            (1, &pair.gear_1, &pair.gear_2),
            (2, &pair.gear_2, &pair.gear_1),
        ] {
            let clearance = centre_distance_m - tip.tip_radius_m - mate.root_radius_m;
            if clearance < 0.0 {
                return Err(PairError::TipClearance {
                    gear,
                    clearance_mm: clearance * 1e3,
                });
            }
            let needed = (line - tip.base_radius_m * tip.flank_end_roll_rad) / mate.base_radius_m;
            if needed < mate.form_roll_rad - 1e-9 {
                let radius =
                    |roll: f64| involute::radius_m(roll.max(0.0), mate.base_radius_m) * 1e3;
                return Err(PairError::FilletInterference {
                    gear,
                    needed_mm: radius(needed),
                    form_mm: radius(mate.form_roll_rad),
                });
            }
        }
        pair.roll_start_1_rad = pair.roll_start_1_rad.max(0.0);
        if pair.backlash_m() < -ROUNDING_M {
            return Err(PairError::NoBacklash {
                backlash_mm: pair.backlash_m() * 1e3,
            });
        }
        for (gear, tip, mate) in [
            (1, &pair.gear_1, &pair.gear_2),
            (2, &pair.gear_2, &pair.gear_1),
        ] {
            let depth_m = tip_in_fillet::depth_m(tip, mate, centre_distance_m);
            if depth_m > ROUNDING_M {
                return Err(PairError::TipInFillet {
                    gear,
                    depth_um: depth_m * 1e6,
                });
            }
        }
        if pair.contact_ratio() < 1.0 {
            return Err(PairError::ContactRatio {
                contact_ratio: pair.contact_ratio(),
            });
        }
        Ok(pair)
    }

    /// Puts the gears at another centre distance, above the sum of the base radii, with other axis errors: working
    /// pressure angle and start of the path follow.
    pub fn move_to(&mut self, centre_distance_m: f64, misalignment: Misalignment) {
        let [base_1, base_2] = [self.gear_1.base_radius_m, self.gear_2.base_radius_m];
        let sum = base_1 + base_2;
        self.centre_distance_m = centre_distance_m;
        self.misalignment = misalignment;
        self.working_pressure_angle_rad = (sum / centre_distance_m).acos();
        let line = sum * self.working_pressure_angle_rad.tan();
        self.roll_start_1_rad =
            ((line - base_2 * self.gear_2.flank_end_roll_rad) / base_1).max(0.0);
    }

    /// The same pair with contact on the flanks of the given side.
    pub fn on_flanks(self, flank: Flank) -> Self {
        Self { flank, ..self }
    }

    /// Base helix angle β_b of gear 1 \[rad\], positive for a right hand; gear 2 has the opposite.
    pub fn base_helix_angle_rad(&self) -> f64 {
        self.gear_1.base_helix_angle_rad()
    }

    /// Whether the teeth are helical: contact lines then slant and every section has its own roll angle.
    pub fn is_helical(&self) -> bool {
        self.gear_1.helix_angle_rad != 0.0
    }

    /// How the roll angle on gear 1 of one pair changes along the axis \[rad/m\]. A right-hand helix turns the sections
    /// above mid-face counter-clockwise: where gear 1 turns clockwise (right flanks in contact) they lag behind,
    /// ξ₁(z) = ξ₁(0) − z tan β₁/r₁; on left flanks they are ahead.
    pub fn roll_slope_1_rad_per_m(&self) -> f64 {
        -self.flank.mirror() * self.gear_1.twist_rad_per_m()
    }

    /// Overlap ratio ε_β = b tan β_b/p_bt = b sin β/(π m_n) of teeth that touch over the width b.
    pub fn overlap_ratio(&self, face_width_m: f64) -> f64 {
        self.gear_1.overlap_ratio(face_width_m)
    }

    /// Total contact ratio ε_γ = ε_α + ε_β.
    pub fn total_contact_ratio(&self, face_width_m: f64) -> f64 {
        self.contact_ratio() + self.overlap_ratio(face_width_m)
    }

    /// Angle between two teeth of gear 1 \[rad\].
    pub fn pitch_1_rad(&self) -> f64 {
        TAU / self.gear_1.teeth as f64
    }

    /// Transverse contact ratio ε_α.
    pub fn contact_ratio(&self) -> f64 {
        (self.roll_end_1_rad - self.roll_start_1_rad) / self.pitch_1_rad()
    }

    /// Circumferential backlash on the working pitch circles \[m\].
    pub fn backlash_m(&self) -> f64 {
        let roll = self.working_pressure_angle_rad.tan();
        let r_w1 = involute::radius_m(roll, self.gear_1.base_radius_m);
        let r_w2 = involute::radius_m(roll, self.gear_2.base_radius_m);
        r_w1 * self.pitch_1_rad()
            - 2.0 * r_w1 * self.gear_1.half_angle_rad(roll)
            - 2.0 * r_w2 * self.gear_2.half_angle_rad(roll)
    }

    /// Roll angle on gear 1 at mid-face of pair `pair` (see [`GearPair::teeth_of`]) at driver angle θ₁:
    /// ξ₁ = tan α_w + θ₁ − p 2π/z₁. Zero driver angle: pair 0 at the pitch point.
    pub fn roll_1_rad(&self, driver_angle_rad: f64, pair: i64) -> f64 {
        self.working_pressure_angle_rad.tan() + driver_angle_rad - pair as f64 * self.pitch_1_rad()
    }

    /// Teeth of gear 1 and gear 2 that make pair p. A higher p comes later: on right flanks (gear 1 turns clockwise)
    /// gear 1's tooth p with gear 2's tooth −p, on left flanks the mirror image, tooth −p with tooth p.
    pub fn teeth_of(&self, pair: i64) -> [usize; 2] {
        let pair = match self.flank {
            Flank::Right => pair,
            Flank::Left => -pair,
        };
        let wrap = |tooth: i64, teeth: usize| tooth.rem_euclid(teeth as i64) as usize;
        [
            wrap(pair, self.gear_1.teeth),
            wrap(-pair, self.gear_2.teeth),
        ]
    }

    /// Roll angle on gear 2 opposite to ξ₁: r_b2 ξ₂ = a sin α_w − r_b1 ξ₁.
    pub fn roll_2_rad(&self, roll_1_rad: f64) -> f64 {
        (self.centre_distance_m * self.working_pressure_angle_rad.sin()
            - self.gear_1.base_radius_m * roll_1_rad)
            / self.gear_2.base_radius_m
    }

    /// Signed distance \[m\] along the line of action from the pitch point, positive towards the end of contact
    /// (recess): the lever of the sliding velocity and of the friction moment.
    pub fn path_from_pitch_point_m(&self, roll_1_rad: f64) -> f64 {
        self.gear_1.base_radius_m * (roll_1_rad - self.working_pressure_angle_rad.tan())
    }

    /// Sliding velocity \[m/s\] of gear 1's flank over gear 2's, positive towards gear 1's *root* (and gear 2's tip):
    /// (ω₁ + ω₂) s with s the distance from the pitch point. Zero at the pitch point, where it changes its sign. The
    /// contact runs outwards over gear 1, so the material below it moves inwards.
    pub fn sliding_velocity_m_per_s(&self, roll_1_rad: f64, speed_1_rad_per_s: f64) -> f64 {
        let ratio = self.gear_1.base_radius_m / self.gear_2.base_radius_m;
        speed_1_rad_per_s * (1.0 + ratio) * self.path_from_pitch_point_m(roll_1_rad)
    }

    /// Radii of curvature ρ₁ = r_b1 ξ₁ and ρ₂ = r_b2 ξ₂ of the touching flanks \[m\].
    pub fn curvature_radii_m(&self, roll_1_rad: f64) -> (f64, f64) {
        (
            self.gear_1.base_radius_m * roll_1_rad,
            self.gear_2.base_radius_m * self.roll_2_rad(roll_1_rad),
        )
    }

    /// Relative radius of curvature ρ \[m\] across the line of contact of two flanks that touch at the given roll
    /// angles: 1/ρ = cos β_b (1/(r_b1 ξ₁) + 1/(r_b2 ξ₂)).
    pub fn relative_radius_m(&self, roll_1_rad: f64, roll_2_rad: f64) -> f64 {
        let a = self.gear_1.base_radius_m * roll_1_rad;
        let b = self.gear_2.base_radius_m * roll_2_rad;
        a * b / ((a + b) * self.base_helix_angle_rad().cos())
    }

    /// Growth of the relative radius, as a share of itself, per radian of roll on gear 1 and gear 2: (1 − ρ_i/(ρ₁ +
    /// ρ₂))/ξ_i.
    pub fn relative_radius_growth(&self, roll_rad: [f64; 2]) -> [f64; 2] {
        let rho_1 = self.gear_1.base_radius_m * roll_rad[0];
        let rho_2 = self.gear_2.base_radius_m * roll_rad[1];
        let sum = rho_1 + rho_2;
        [rho_2 / (sum * roll_rad[0]), rho_1 / (sum * roll_rad[1])]
    }

    /// Opening of the loaded flanks by misalignment, measured in the transverse plane, at axial position `z_m` and
    /// distance `path_m` from the pitch point along the line of action \[m\]:
    /// (z ∓ s tan β_b)(δ_inclination sin α_w + δ_deviation cos α_w), − on right flanks with a right-hand gear 1.
    ///
    /// Gear 2 tilts about the pitch point at mid-face. Spur flanks feel the displacement along the line of action only;
    /// a helical flank also feels the axial one.
    pub fn misalignment_gap_m(&self, z_m: f64, path_m: f64) -> f64 {
        let (s, c) = self.working_pressure_angle_rad.sin_cos();
        let slope = self.misalignment.inclination_rad * s + self.misalignment.deviation_rad * c;
        let axial = self.flank.mirror() * self.base_helix_angle_rad().tan();
        (z_m - axial * path_m) * slope
    }

    /// Pairs (numbers p) whose section at mid-face is on the path of contact at a driver angle.
    pub fn pairs_in_contact(&self, driver_angle_rad: f64) -> std::ops::RangeInclusive<i64> {
        let pitch = self.pitch_1_rad();
        let at_zero = self.roll_1_rad(driver_angle_rad, 0);
        let first = ((at_zero - self.roll_end_1_rad) / pitch).ceil() as i64;
        let last = ((at_zero - self.roll_start_1_rad) / pitch).floor() as i64;
        first..=last
    }
}
