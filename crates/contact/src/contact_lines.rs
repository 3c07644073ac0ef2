//! Which tooth pairs touch at a driver angle, where, and how far their slices stand apart unloaded.

use crate::tip_contact::{PathExtension, TipContact, TipGear};
use gearmesh_geometry::{GearPair, Microgeometry};

/// Coulomb friction between the flanks, regularised at the pitch point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Friction {
    /// Coefficient μ.
    pub coefficient: f64,
    /// Half width of the path around the pitch point over which the friction force reverses \[m\].
    pub reversal_m: f64,
}

impl Friction {
    /// Friction force over normal force, signed: positive towards the tips of *both* gears (after the pitch point).
    ///
    /// Sliding changes its sign at the pitch point; within ±`reversal_m` of it the coefficient runs linearly.
    pub fn ratio(&self, path_from_pitch_point_m: f64) -> f64 {
        self.coefficient * (path_from_pitch_point_m / self.reversal_m).clamp(-1.0, 1.0)
    }
}

/// One line of contact: a tooth pair at a driver angle. Of helical teeth it slants over the flank and its numbers are those
/// of the section at mid-face; see [`ContactLines::section`] for others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactLine {
    /// Pair number p, see [`GearPair::teeth_of`].
    pub pair: i64,
    /// Tooth of gear 1.
    pub tooth_1: usize,
    /// Tooth of gear 2.
    pub tooth_2: usize,
    /// Roll angle of the contact on gear 1's flank \[rad\]; its end where gear 1's tip edge touches.
    pub roll_1_rad: f64,
    /// Roll angle of the contact on gear 2's flank \[rad\]; its end where gear 2's tip edge touches.
    pub roll_2_rad: f64,
    /// Distance from the pitch point along the path of contact, positive after it \[m\]. Continued beyond the ends.
    pub path_m: f64,
    /// Tip edge on flank beyond the ends of the path; none on it.
    pub tip: Option<TipContact>,
}

impl ContactLine {
    /// Normal and friction force on a gear's tooth (index 0 or 1), in the frame of that gear's own flank: components along
    /// the inward normal and towards the tip, over the normal force of the contact. `friction_ratio` as
    /// [`Friction::ratio`]. (1, ratio), but for a tip edge, which feels them turned by its tilt δ:
    /// (cos δ − ratio sin δ, sin δ + ratio cos δ).
    pub fn force_components(&self, gear: usize, friction_ratio: f64) -> [f64; 2] {
        let (sin, cos) = self.tilt_rad(gear).sin_cos();
        [cos - friction_ratio * sin, sin + friction_ratio * cos]
    }

    /// Turn of the contact's normal from the flank normal of gear 0 or 1 towards the tip \[rad\]: zero but for a tip edge.
    pub fn tilt_rad(&self, gear: usize) -> f64 {
        self.tip.map_or(0.0, |t| {
            if t.tip_gear.indices().0 == gear {
                t.tilt_rad
            } else {
                0.0
            }
        })
    }
}

/// Rigid kinematics of a pair with its microgeometry: contact lines and unloaded gaps.
#[derive(Debug, Clone)]
pub struct ContactLines {
    /// The pair.
    pub pair: GearPair,
    /// Microgeometry of gear 1.
    pub microgeometry_1: Microgeometry,
    /// Microgeometry of gear 2.
    pub microgeometry_2: Microgeometry,
    /// Contact beyond the ends of the path; without it pairs touch on the rigid path only. Spur teeth only.
    pub extension: Option<PathExtension>,
    /// Width over which the teeth face each other \[m\]: how far a helical contact line reaches.
    pub face_width_m: f64,
}

impl ContactLines {
    /// Fills `lines` with the pairs at a driver angle that are on the path of contact or, where it is extended, near
    /// enough to its ends. A pair is on the path or at one tip, never both.
    pub fn at(&self, driver_angle_rad: f64, lines: &mut Vec<ContactLine>) {
        lines.clear();
        let (start, end) = self.range_1_rad();
        let pitch = self.pair.pitch_1_rad();
        let at_zero = self.pair.roll_1_rad(driver_angle_rad, 0);
        // A pair counts as long as any of its sections is within the range.
        let first = ((at_zero - end) / pitch).ceil() as i64;
        let last = ((at_zero - start) / pitch).floor() as i64;
        lines.extend((first..=last).map(|pair| self.line(driver_angle_rad, pair)));
    }

    fn line(&self, driver_angle_rad: f64, pair: i64) -> ContactLine {
        let [tooth_1, tooth_2] = self.pair.teeth_of(pair);
        let roll_1_rad = self.pair.roll_1_rad(driver_angle_rad, pair);
        let roll_2_rad = self.pair.roll_2_rad(roll_1_rad);
        let line = ContactLine {
            pair,
            tooth_1,
            tooth_2,
            roll_1_rad,
            roll_2_rad,
            path_m: self.pair.path_from_pitch_point_m(roll_1_rad),
            tip: None,
        };
        if self.extension.is_none() {
            return line;
        }
        if roll_1_rad > self.pair.roll_end_1_rad {
            let tip = TipContact::new(&self.pair, TipGear::One, roll_1_rad, roll_2_rad);
            ContactLine {
                roll_1_rad: self.pair.gear_1.flank_end_roll_rad,
                roll_2_rad: tip.foot_roll_rad,
                tip: Some(tip),
                ..line
            }
        } else if roll_1_rad < self.pair.roll_start_1_rad {
            let tip = TipContact::new(&self.pair, TipGear::Two, roll_2_rad, roll_1_rad);
            ContactLine {
                roll_1_rad: tip.foot_roll_rad,
                roll_2_rad: self.pair.gear_2.flank_end_roll_rad,
                tip: Some(tip),
                ..line
            }
        } else {
            line
        }
    }

    /// Roll angles on gear 1 at mid-face between which pairs are looked for.
    pub fn range_1_rad(&self) -> (f64, f64) {
        let (start, end) = self.extension.map_or(
            (self.pair.roll_start_1_rad, self.pair.roll_end_1_rad),
            |e| (e.start_1_rad, e.end_1_rad),
        );
        let slant = 0.5 * self.face_width_m * self.pair.roll_slope_1_rad_per_m().abs();
        (start - slant, end + slant)
    }

    /// Largest number of lines at once.
    pub fn most_pairs(&self) -> usize {
        let (start, end) = self.range_1_rad();
        ((end - start) / self.pair.pitch_1_rad()).floor() as usize + 1
    }

    /// Unloaded separation \[m\] along the normal of a slice at zero transmission error, open positive: the gap of a tip
    /// edge, material removed from both flanks and misalignment. `line` is the line in the slice's section. What is removed from a tip edge along its own normal opens the gap by
    /// its component cos δ.
    pub fn separation_m(&self, line: &ContactLine, z_m: f64) -> f64 {
        let removed_1 = self.microgeometry_1.removed_m(line.roll_1_rad, z_m);
        let removed_2 = self.microgeometry_2.removed_m(line.roll_2_rad, z_m);
        let tilted_axes = self.pair.misalignment;
        let (gap, misalignment) = match line.tip {
            None => (
                0.0,
                self.helix_cos() * self.pair.misalignment_gap_m(z_m, line.path_m),
            ),
            Some(tip) => {
                let (sin, cos) = tip.force_angle_rad.sin_cos();
                let slope = tilted_axes.inclination_rad * sin + tilted_axes.deviation_rad * cos;
                (tip.gap_m, z_m * slope)
            }
        };
        gap + line.tilt_rad(0).cos() * removed_1 + line.tilt_rad(1).cos() * removed_2 + misalignment
    }

    /// cos β_b: turns lengths along the normal into lengths in the transverse plane.
    fn helix_cos(&self) -> f64 {
        self.pair.base_helix_angle_rad().cos()
    }

    /// How fast the line's gap closes with the approach x = −TE of the bases at a given driver angle: cos β_b, but for gear
    /// 2's tip edge, whose lever arm over r_b2 it is.
    pub fn closing(&self, line: &ContactLine) -> f64 {
        match line.tip {
            Some(tip) if tip.tip_gear == TipGear::Two => {
                tip.tip_arm_m / self.pair.gear_2.base_radius_m
            }
            _ => self.helix_cos(),
        }
    }

    /// Torque about the axes of gear 1 and gear 2 per newton of normal force \[m\]: b = r_b (cos β_b + ratio ξ), or the lever
    /// arms of a tip edge in their place: friction acts along the profile, in the transverse plane. `friction_ratio` as [`Friction::ratio`].
    pub fn lever_arms_m(&self, line: &ContactLine, friction_ratio: f64) -> [f64; 2] {
        let cos = self.helix_cos();
        let bases = [
            self.pair.gear_1.base_radius_m,
            self.pair.gear_2.base_radius_m,
        ];
        let mut arms = [
            bases[0] * (cos + friction_ratio * line.roll_1_rad),
            bases[1] * (cos + friction_ratio * line.roll_2_rad),
        ];
        if let Some(tip) = line.tip {
            arms[tip.tip_gear.indices().0] =
                tip.tip_arm_m + friction_ratio * tip.tip_friction_arm_m;
        }
        arms
    }

    /// Force along +z on gear 1 per newton of normal force, ∓sin β_b: − where a right-hand gear 1 is loaded on right
    /// flanks. Gear 2 feels the opposite.
    pub fn axial_share_1(&self) -> f64 {
        -self.pair.flank.mirror() * self.pair.base_helix_angle_rad().sin()
    }

    /// Relative radius of curvature ρ₁ρ₂/(ρ₁ + ρ₂)/cos β_b of the flanks \[m\], in the plane normal to the contact line; a
    /// tip edge counts with its flank's end.
    pub fn relative_radius_m(&self, line: &ContactLine) -> f64 {
        self.pair
            .relative_radius_m(line.roll_1_rad, line.roll_2_rad)
    }

    /// Growth of the relative radius, as a share of itself, per radian of roll on gear 0 or 1: (1 − ρ/(ρ₁ + ρ₂))/ξ.
    pub fn relative_radius_growth(&self, line: &ContactLine, gear: usize) -> f64 {
        let rolls = [line.roll_1_rad, line.roll_2_rad];
        let pair = &self.pair;
        let rho = [
            pair.gear_1.base_radius_m * rolls[0],
            pair.gear_2.base_radius_m * rolls[1],
        ];
        (1.0 - rho[gear] / (rho[0] + rho[1])) / rolls[gear]
    }

    /// Tilt \[rad\] and relative radius \[m\] of the rounded edge against the flank; none on the path.
    pub fn edge(&self, line: &ContactLine) -> Option<(f64, f64)> {
        let (tip, extension) = line.tip.zip(self.extension)?;
        let flank = match tip.tip_gear {
            TipGear::One => self.pair.gear_2.base_radius_m * line.roll_2_rad,
            TipGear::Two => self.pair.gear_1.base_radius_m * line.roll_1_rad,
        };
        let edge = extension.edge_radius_m;
        Some((tip.tilt_rad, edge * flank / (edge + flank)))
    }
}
