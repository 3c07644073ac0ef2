//! Two gears at a centre distance: working pressure angle, path of contact, backlash, sliding, interference.

use crate::involute;
use crate::tooth::ToothGeometry;
use std::f64::consts::TAU;

/// Why two gears do not run together.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PairError {
    /// Different base pitches.
    #[error(
        "the base pitches differ: {base_pitch_1_mm:.5} and {base_pitch_2_mm:.5} mm; module and pressure angle of both gears must agree"
    )]
    BasePitch {
        /// Base pitch of gear 1.
        base_pitch_1_mm: f64,
        /// Base pitch of gear 2.
        base_pitch_2_mm: f64,
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
    /// Contact is lost between two pairs.
    #[error(
        "the contact ratio is {contact_ratio:.4}: below 1 the pair loses contact between teeth"
    )]
    ContactRatio {
        /// Transverse contact ratio.
        contact_ratio: f64,
    },
}

/// Small rotation of gear 2's axis against gear 1's, about mid-face.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Misalignment {
    /// Tilt in the plane of the axes: gear 2's axis moves away from gear 1 by this much per metre of z \[rad\].
    pub inclination_rad: f64,
    /// Tilt across the plane of the axes: opens the loaded flanks by cos α_w times this per metre of z \[rad\].
    pub deviation_rad: f64,
}

/// An external spur gear pair. Gear 1 drives; both are loaded on flanks of the same hand.
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
    /// Roll angle on gear 1 where contact starts (tip of gear 2).
    pub roll_start_1_rad: f64,
    /// Roll angle on gear 1 where contact ends (tip of gear 1).
    pub roll_end_1_rad: f64,
}

impl GearPair {
    /// Checks that the gears run together and derives the path of contact.
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
        if pair.backlash_m() <= 0.0 {
            return Err(PairError::NoBacklash {
                backlash_mm: pair.backlash_m() * 1e3,
            });
        }
        if pair.contact_ratio() < 1.0 {
            return Err(PairError::ContactRatio {
                contact_ratio: pair.contact_ratio(),
            });
        }
        Ok(pair)
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

    /// Roll angle on gear 1 of pair `pair` (gear 1 tooth p with gear 2 tooth −p) at driver angle θ₁:
    /// ξ₁ = tan α_w + θ₁ − p 2π/z₁. Zero driver angle: pair 0 at the pitch point.
    pub fn roll_1_rad(&self, driver_angle_rad: f64, pair: i64) -> f64 {
        self.working_pressure_angle_rad.tan() + driver_angle_rad - pair as f64 * self.pitch_1_rad()
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

    /// Opening of the loaded flanks by misalignment at axial position `z_m`:
    /// z (δ_inclination sin α_w + δ_deviation cos α_w) \[m\].
    pub fn misalignment_gap_m(&self, z_m: f64) -> f64 {
        let (s, c) = self.working_pressure_angle_rad.sin_cos();
        z_m * (self.misalignment.inclination_rad * s + self.misalignment.deviation_rad * c)
    }

    /// Pairs (numbers p) that are on the path of contact at a driver angle.
    pub fn pairs_in_contact(&self, driver_angle_rad: f64) -> std::ops::RangeInclusive<i64> {
        let pitch = self.pitch_1_rad();
        let at_zero = self.roll_1_rad(driver_angle_rad, 0);
        let first = ((at_zero - self.roll_end_1_rad) / pitch).ceil() as i64;
        let last = ((at_zero - self.roll_start_1_rad) / pitch).floor() as i64;
        first..=last
    }
}
