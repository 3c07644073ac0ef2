//! Two gears at a centre distance: working pressure angle, path of contact, backlash, sliding, interference.

use crate::base_circles::BaseCircles;
use crate::flank::Flank;
use crate::involute;
use crate::pair_error::PairError;
use crate::tip_in_fillet;
use crate::tip_sweep::{self, RollingPinion};
use crate::tooth::ToothGeometry;
use std::f64::consts::{PI, TAU};

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

/// A gear pair on parallel axes, spur or helical: two external gears, or one inside a ring. Gear 1 drives. External
/// gears are loaded on flanks of the same hand, a ring and the gear inside on opposite ones.
///
/// The equations are those of external gears with the base radius of a ring, and with it the centre distance, negative
/// (ISO 21771): docs/theory/internal_teeth.md.
#[derive(Debug, Clone, PartialEq)]
pub struct GearPair {
    /// Driving gear.
    pub gear_1: ToothGeometry,
    /// Driven gear.
    pub gear_2: ToothGeometry,
    /// Centre distance a \[m\].
    pub centre_distance_m: f64,
    /// Working pressure angle α_w: cos α_w = |r_b1 + r_b2|/a \[rad\].
    pub working_pressure_angle_rad: f64,
    /// Axis errors.
    pub misalignment: Misalignment,
    /// Side of the flanks in contact on gear 1: right where it turns clockwise. [`GearPair::flank_of`] has both.
    pub flank: Flank,
    /// Roll angle on gear 1 where contact starts (tip of gear 2).
    pub roll_start_1_rad: f64,
    /// Roll angle on gear 1 where contact ends (tip of gear 1).
    pub roll_end_1_rad: f64,
}

impl GearPair {
    /// Checks that two gears on parallel axes run together and derives the path of contact, right flanks of gear 1 in
    /// contact. Either may be a ring around the other. The centre distance has no sign.
    ///
    /// # Errors
    /// [`PairError`] with the numbers that make it impossible.
    pub fn new(
        gear_1: ToothGeometry,
        gear_2: ToothGeometry,
        centre_distance_m: f64,
        misalignment: Misalignment,
    ) -> Result<Self, PairError> {
        if gear_1.internal && gear_2.internal {
            return Err(PairError::TwoRings);
        }
        let base_pitch = |g: &ToothGeometry| TAU * g.base_radius_m / g.teeth as f64;
        let (p1, p2) = (base_pitch(&gear_1), base_pitch(&gear_2));
        if (p1 - p2).abs() > 1e-6 * p1 {
            return Err(PairError::BasePitch {
                base_pitch_1_mm: p1 * 1e3,
                base_pitch_2_mm: p2 * 1e3,
            });
        }
        let (h1, h2) = (gear_1.base_helix_angle_rad(), gear_2.base_helix_angle_rad());
        let [signed_1, signed_2] = [gear_1.tip_direction() * h1, gear_2.tip_direction() * h2];
        if (signed_1 + signed_2).abs() > 1e-6 * h1.abs() {
            return Err(PairError::Helix {
                helix_1_deg: h1.abs().to_degrees(),
                hand_1: gear_1.hand(),
                helix_2_deg: h2.abs().to_degrees(),
                hand_2: gear_2.hand(),
            });
        }
        let mut pair = Self {
            roll_start_1_rad: 0.0,
            roll_end_1_rad: gear_1.flank_end_roll_rad,
            gear_1,
            gear_2,
            centre_distance_m,
            working_pressure_angle_rad: 0.0,
            misalignment,
            flank: Flank::Right,
        };
        if let Some((inside, ring)) = pair.inside_and_ring()
            && inside.teeth >= ring.teeth
        {
            return Err(PairError::RingTooSmall {
                ring_teeth: ring.teeth,
                teeth: inside.teeth,
                allowed: ring.teeth - 1,
            });
        }
        let smallest = pair.circles().sum_m().abs();
        if centre_distance_m.is_nan() || centre_distance_m <= smallest {
            return Err(PairError::CentreDistance {
                centre_distance_mm: centre_distance_m * 1e3,
                smallest_mm: smallest * 1e3,
            });
        }
        let alpha_w = (smallest / centre_distance_m).acos();
        pair.working_pressure_angle_rad = alpha_w;
        pair.roll_start_1_rad = pair.roll_at_tip_of_2_rad();
        pair.check_flanks()?;
        pair.roll_start_1_rad = pair.roll_start_1_rad.max(0.0);
        if pair.backlash_m() < -ROUNDING_M {
            return Err(PairError::NoBacklash {
                backlash_mm: pair.backlash_m() * 1e3,
            });
        }
        for (gear, tip, mate) in pair.tips_and_mates() {
            let depth_m = tip_in_fillet::depth_m(tip, mate, centre_distance_m);
            if depth_m > ROUNDING_M {
                return Err(PairError::TipInFillet {
                    gear,
                    depth_um: depth_m * 1e6,
                });
            }
        }
        pair.check_passing_tips()?;
        if pair.contact_ratio() < 1.0 {
            return Err(PairError::ContactRatio {
                contact_ratio: pair.contact_ratio(),
            });
        }
        Ok(pair)
    }

    /// Each gear with its number, as the one whose tip is looked at, and its mate.
    fn tips_and_mates(&self) -> [(usize, &ToothGeometry, &ToothGeometry); 2] {
        [
            (1, &self.gear_1, &self.gear_2),
            (2, &self.gear_2, &self.gear_1),
        ]
    }

    /// The gear inside and its ring, where one is a ring.
    fn inside_and_ring(&self) -> Option<(&ToothGeometry, &ToothGeometry)> {
        match (self.gear_1.internal, self.gear_2.internal) {
            (false, true) => Some((&self.gear_1, &self.gear_2)),
            (true, false) => Some((&self.gear_2, &self.gear_1)),
            _ => None,
        }
    }

    /// Whether one of the gears is a ring around the other.
    #[must_use]
    pub fn has_ring(&self) -> bool {
        self.circles().has_ring()
    }

    /// Clearance of tips and roots, and that tips touch involutes only.
    fn check_flanks(&self) -> Result<(), PairError> {
        let circles = self.circles();
        let (a, line) = (
            circles.signed_distance_m(self.centre_distance_m),
            self.line_of_action_m(),
        );
        for (gear, tip, mate) in self.tips_and_mates() {
            let tip_m = tip.tip_direction() * tip.tip_radius_m;
            let clearance = a - tip_m - mate.tip_direction() * mate.root_radius_m;
            if clearance < 0.0 {
                return Err(PairError::TipClearance {
                    gear,
                    clearance_mm: clearance * 1e3,
                });
            }
            let needed = circles.mate_roll_rad(line, (gear - 1, tip.flank_end_roll_rad));
            if tip.internal && needed < 0.0 {
                return Err(PairError::InvoluteInterference {
                    gear: 3 - gear,
                    least_mm: 2e3 * tip.base_radius_m.hypot(line),
                });
            }
            if mate.tip_direction() * (needed - mate.form_roll_rad) < -1e-9 {
                let radius =
                    |roll: f64| involute::radius_m(roll.max(0.0), mate.base_radius_m) * 1e3;
                return Err(PairError::FilletInterference {
                    gear,
                    needed_mm: radius(needed),
                    form_mm: radius(mate.form_roll_rad),
                });
            }
        }
        Ok(())
    }

    /// That tips of a ring and of the gear inside pass each other away from the line of action.
    fn check_passing_tips(&self) -> Result<(), PairError> {
        let Some((inside, ring)) = self.inside_and_ring() else {
            return Ok(());
        };
        let end = inside.flank_end_roll_rad;
        let mut corners = vec![(inside.tip_radius_m, inside.tip_half_angle_rad())];
        if inside.tip_chamfer_m > 0.0 {
            let radius = involute::radius_m(end, inside.base_radius_m);
            corners.push((radius, inside.half_angle_rad(end)));
        }
        let pitch_radius_m = inside.base_radius_m / self.working_pressure_angle_rad.cos();
        let worst = tip_sweep::deepest(
            ring,
            &RollingPinion {
                teeth: inside.teeth,
                corners,
                centre_distance_m: self.centre_distance_m,
                // On one flank: half the backlash from the middle of the space.
                turned_rad: 0.5 * self.backlash_m() / pitch_radius_m,
            },
        );
        if worst.depth_m <= ROUNDING_M {
            return Ok(());
        }
        Err(PairError::TipsCollide {
            gear: if self.gear_1.internal { 2 } else { 1 },
            depth_um: worst.depth_m * 1e6,
            clear_tip_diameter_mm: 2e3 * worst.clear_tip_radius_m,
        })
    }

    /// Least room \[m\] between the tips of a gear inside a ring and those of the ring while it comes in along the line
    /// of centres; negative where they collide: then it comes in along its axis only. None of external gears.
    #[must_use]
    pub fn radial_room_m(&self) -> Option<f64> {
        let (inside, ring) = self.inside_and_ring()?;
        Some(tip_sweep::radial_room_m(
            inside,
            ring,
            self.centre_distance_m,
        ))
    }

    /// How the gear inside a ring is put in, in words; none of external gears.
    #[must_use]
    pub fn assembly_words(&self) -> Option<String> {
        let room_mm = 1e3 * self.radial_room_m()?;
        Some(match room_mm < 0.0 {
            true => format!(
                "the gear inside comes into the ring along the axis only: radially tips would run {:.4} mm into each other",
                -room_mm
            ),
            false => format!(
                "the gear inside comes into the ring radially, too: {room_mm:.4} mm of room between tips"
            ),
        })
    }

    /// The base circles of both.
    #[must_use]
    pub fn circles(&self) -> BaseCircles {
        BaseCircles::new([&self.gear_1, &self.gear_2])
    }

    /// Length of the line of action a sin α_w \[m\], negative with a ring ([`BaseCircles`]).
    #[must_use]
    pub fn line_of_action_m(&self) -> f64 {
        let distance_m = self.circles().signed_distance_m(self.centre_distance_m);
        distance_m * self.working_pressure_angle_rad.sin()
    }

    /// Roll angle on gear 1 at which gear 2's tip touches it.
    fn roll_at_tip_of_2_rad(&self) -> f64 {
        let end = self.gear_2.flank_end_roll_rad;
        (self.circles()).mate_roll_rad(self.line_of_action_m(), (1, end))
    }

    /// Puts the gears at another centre distance, above the sum of the base radii, with other axis errors: working
    /// pressure angle and start of the path follow.
    pub fn move_to(&mut self, centre_distance_m: f64, misalignment: Misalignment) {
        self.centre_distance_m = centre_distance_m;
        self.misalignment = misalignment;
        self.working_pressure_angle_rad = (self.circles().sum_m().abs() / centre_distance_m).acos();
        self.roll_start_1_rad = self.roll_at_tip_of_2_rad().max(0.0);
    }

    /// Side of the flanks in contact on gear 1 (0) or gear 2 (1): the same on external gears, opposite ones with a
    /// ring.
    #[must_use]
    pub fn flank_of(&self, gear: usize) -> Flank {
        self.circles().side_of(gear, self.flank)
    }

    /// The same pair with contact on the flanks of the given side.
    pub fn on_flanks(self, flank: Flank) -> Self {
        Self { flank, ..self }
    }

    /// Base helix angle β_b of gear 1 \[rad\], positive for a right hand; gear 2 has the opposite, with a ring the
    /// same.
    pub fn base_helix_angle_rad(&self) -> f64 {
        self.gear_1.base_helix_angle_rad()
    }

    /// Whether the teeth are helical: contact lines then slant and every section has its own roll angle.
    pub fn is_helical(&self) -> bool {
        self.gear_1.helix_angle_rad != 0.0
    }

    /// How the roll angle on gear 1 of one pair changes along the axis \[rad/m\]. A right-hand helix turns the sections
    /// above mid-face counter-clockwise: where gear 1 turns clockwise (right flanks in contact) they lag behind,
    /// ξ₁(z) = ξ₁(0) − z tan β₁/r₁; on left flanks they are ahead. On a ring the roll falls as it turns: the signs
    /// swap.
    pub fn roll_slope_1_rad_per_m(&self) -> f64 {
        -self.flank.mirror() * self.gear_1.tip_direction() * self.gear_1.twist_rad_per_m()
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
        (self.roll_end_1_rad - self.roll_start_1_rad).abs() / self.pitch_1_rad()
    }

    /// Polar angles of the middles of teeth 0 at mid-face \[rad\], from each gear's own axis, x from gear 1's axis to
    /// gear 2's, where both have turned by these angles in their own senses from where their flanks touch in the pitch
    /// point at the centre distance \[m, rad\].
    #[must_use]
    pub fn tooth_middles_rad(&self, (distance_m, angles_rad): (f64, [f64; 2])) -> [f64; 2] {
        let circles = self.circles();
        let roll = (circles.sum_m().abs() / distance_m).acos().tan();
        let away = 1f64.copysign(circles.sum_m());
        [(0, &self.gear_1), (1, &self.gear_2)].map(|(gear, tooth)| {
            // The pitch point lies towards the mate, but for a gear inside a ring.
            let towards_2 = away * circles.sense(gear) * [1.0, -1.0][gear];
            let pitch_point = if towards_2 > 0.0 { 0.0 } else { PI };
            // Gear 1 drives: it turns to where its flanks face, gear 2 the other way.
            let side = self.flank_of(gear).mirror();
            let driven = [1.0, -1.0][gear];
            pitch_point + side * (tooth.half_angle_rad(roll) - driven * angles_rad[gear])
        })
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
    /// ξ₁ = tan α_w ± (θ₁ − p 2π/z₁), − where gear 1 is a ring. Zero driver angle: pair 0 at the pitch point.
    pub fn roll_1_rad(&self, driver_angle_rad: f64, pair: i64) -> f64 {
        let turned = driver_angle_rad - pair as f64 * self.pitch_1_rad();
        self.working_pressure_angle_rad.tan() + self.gear_1.tip_direction() * turned
    }

    /// Teeth of gear 1 and gear 2 that make pair p. A higher p comes later: on right flanks (gear 1 turns clockwise)
    /// gear 1's tooth p with gear 2's tooth −p, on left flanks the mirror image, tooth −p with tooth p. With a ring
    /// both turn the same way: tooth p with tooth p, on left flanks −p with −p.
    pub fn teeth_of(&self, pair: i64) -> [usize; 2] {
        // Wide enough to be turned round, whatever a file says.
        let pair = i128::from(pair);
        let pair = match self.flank {
            Flank::Right => pair,
            Flank::Left => -pair,
        };
        let of_2 = if self.has_ring() { pair } else { -pair };
        let wrap = |tooth: i128, teeth: usize| tooth.rem_euclid(teeth as i128) as usize;
        [wrap(pair, self.gear_1.teeth), wrap(of_2, self.gear_2.teeth)]
    }

    /// Roll angle on gear 2 opposite to ξ₁: r_b2 ξ₂ = a sin α_w − r_b1 ξ₁, a and the ring's r_b negative.
    pub fn roll_2_rad(&self, roll_1_rad: f64) -> f64 {
        (self.circles()).mate_roll_rad(self.line_of_action_m(), (0, roll_1_rad))
    }

    /// Signed distance \[m\] along the line of action from the pitch point, positive towards the end of contact
    /// (recess): the lever of the sliding velocity and of the friction moment.
    pub fn path_from_pitch_point_m(&self, roll_1_rad: f64) -> f64 {
        self.circles().radii_m[0] * (roll_1_rad - self.working_pressure_angle_rad.tan())
    }

    /// Sliding velocity \[m/s\] of gear 1's flank over gear 2's, positive towards gear 1's *root* (and gear 2's tip):
    /// ω₁ (1 + r_b1/r_b2) (ρ₁ − r_b1 tan α_w), which is (ω₁ + ω₂) s of external gears with s the distance from the
    /// pitch point; r_b1/r_b2 is negative with a ring. Zero at the pitch point, where it changes its sign. The contact
    /// runs towards the tip of gear 1, so the material below it moves towards the root.
    pub fn sliding_velocity_m_per_s(&self, roll_1_rad: f64, speed_1_rad_per_s: f64) -> f64 {
        let [r1, r2] = self.circles().radii_m;
        let ratio = r1 / r2;
        let rolled = roll_1_rad - self.working_pressure_angle_rad.tan();
        speed_1_rad_per_s * (1.0 + ratio) * self.gear_1.base_radius_m * rolled
    }

    /// Radii of curvature ρ₁ = r_b1 ξ₁ and ρ₂ = r_b2 ξ₂ of the touching flanks \[m\].
    pub fn curvature_radii_m(&self, roll_1_rad: f64) -> (f64, f64) {
        (
            self.gear_1.base_radius_m * roll_1_rad,
            self.gear_2.base_radius_m * self.roll_2_rad(roll_1_rad),
        )
    }

    /// Relative radius of curvature ρ \[m\] across the line of contact of two flanks that touch at the given roll
    /// angles: 1/ρ = cos β_b (1/(r_b1 ξ₁) + 1/(r_b2 ξ₂)), the ring's r_b negative: its flank is hollow.
    pub fn relative_radius_m(&self, roll_1_rad: f64, roll_2_rad: f64) -> f64 {
        let helix_cos = self.base_helix_angle_rad().cos();
        (self.circles())
            .relative_radius([roll_1_rad, roll_2_rad], helix_cos)
            .0
    }

    /// Opening of the loaded flanks by misalignment, measured in the transverse plane, at axial position `z_m` and
    /// distance `path_m` from the pitch point along the line of action \[m\]:
    /// (z ∓ s tan β_b)(δ_inclination sin α_w + δ_deviation cos α_w), − on right flanks with a right-hand gear 1.
    ///
    /// An axis that moves away opens external flanks and closes those inside a ring: there the inclination counts
    /// negative. Gear 2 tilts about the pitch point at mid-face. Spur flanks feel the displacement along the line of
    /// action only; a helical flank also feels the axial one.
    pub fn misalignment_gap_m(&self, z_m: f64, path_m: f64) -> f64 {
        let (s, c) = self.working_pressure_angle_rad.sin_cos();
        let opens = self.circles().sum_m().signum();
        let slope =
            opens * self.misalignment.inclination_rad * s + self.misalignment.deviation_rad * c;
        let axial = self.flank.mirror() * self.base_helix_angle_rad().tan();
        (z_m - axial * path_m) * slope
    }

    /// Pairs (numbers p) whose section at mid-face is on the path of contact at a driver angle.
    pub fn pairs_in_contact(&self, driver_angle_rad: f64) -> std::ops::RangeInclusive<i64> {
        // Along the path, whichever way the roll goes.
        let pitch = self.gear_1.tip_direction() * self.pitch_1_rad();
        let at_zero = self.roll_1_rad(driver_angle_rad, 0);
        let first = ((at_zero - self.roll_end_1_rad) / pitch).ceil() as i64;
        let last = ((at_zero - self.roll_start_1_rad) / pitch).floor() as i64;
        first..=last
    }
}
