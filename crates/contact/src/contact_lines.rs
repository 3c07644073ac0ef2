//! Involute pairs at rest: which tooth pairs touch at a driver angle, where, and how far their slices stand apart
//! unloaded.
//!
//! A helical contact line slants over the flank, ξ₁(z) = ξ₁(0) + ξ′ z ([`GearPair::roll_slope_1_rad_per_m`]), so that
//! its slices enter and leave the path of contact one by one. A slice that is partly on the path touches over that part
//! only: it has the roll angle of the part's middle and a share of the slice's length, which goes to zero with its
//! force. The transmission error is therefore continuous where a slice enters.

use crate::contact_patch::{ContactPatch, FlankPlace, PatchBalance, PatchEdge};
use crate::contact_zone::{ContactZone, SliceLayout};
use crate::slice_part::{LEAST_SHARE, SlicePart};
use crate::tip_contact::{PathExtension, TipContact, TipGear};
use gearmesh_geometry::{GearPair, Microgeometry, Misalignment};
use nalgebra::SVector;

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

/// One line of contact: a tooth pair at a driver angle. Of helical teeth it slants over the flank and its numbers are
/// those of the section at mid-face; see [`ContactLines::section`] for others.
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
    /// Turn of the contact's normal from the flank normal of gear 0 or 1 towards the tip \[rad\]: zero but for a tip
    /// edge.
    pub fn tilt_rad(&self, gear: usize) -> f64 {
        (self.tip.filter(|tip| tip.tip_gear.indices().0 == gear)).map_or(0.0, |tip| tip.tilt_rad)
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
    /// Contact beyond the ends of the path; without it pairs touch on the rigid path only.
    pub extension: Option<PathExtension>,
    /// Where the faces overlap: how far contact lines reach. Sections are counted from halfway between the mid-faces.
    pub zone: ContactZone,
}

impl ContactLines {
    /// Fills `lines` with the pairs at a driver angle that are on the path of contact or, where it is extended, near
    /// enough to its ends. A pair is on the path or at one tip, never both.
    pub fn at(&self, driver_angle_rad: f64, lines: &mut Vec<ContactLine>) {
        lines.clear();
        let (start, end) = self.range_1_rad();
        // Along the path, against which the roll angle of a ring runs.
        let pitch = self.pair.circles().sense(0) * self.pair.pitch_1_rad();
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
        if self.pair.is_helical() {
            return line;
        }
        self.at_edge(line)
    }

    /// The line, or the section of one, with its tip edge where it is beyond an end of an extended path.
    fn at_edge(&self, line: ContactLine) -> ContactLine {
        let (roll_1_rad, roll_2_rad) = (line.roll_1_rad, line.roll_2_rad);
        if self.extension.is_none() {
            return line;
        }
        let sense = self.pair.circles().sense(0);
        if sense * (roll_1_rad - self.pair.roll_end_1_rad) > 0.0 {
            let tip = TipContact::new(&self.pair, TipGear::One, roll_1_rad, roll_2_rad);
            ContactLine {
                roll_1_rad: self.pair.gear_1.flank_end_roll_rad,
                roll_2_rad: tip.foot_roll_rad,
                tip: Some(tip),
                ..line
            }
        } else if sense * (roll_1_rad - self.pair.roll_start_1_rad) < 0.0 {
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

    /// Appends the patches of a line that touch or may touch. `number` is the line's number.
    pub fn push_patches(
        &self,
        (number, line): (usize, &ContactLine),
        layout: &SliceLayout,
        friction: Option<Friction>,
        patches: &mut Vec<ContactPatch>,
    ) {
        let mut alike = None;
        for slice in 0..layout.slices {
            let centre_m = layout.reference.slice_centre_m(slice, layout.slices);
            let Some((share, z_m)) = self.part_on_path(line, centre_m, layout.width_m()) else {
                continue;
            };
            let section = self.section(line, z_m);
            // Of a spur line the slices are alike.
            let number_alike = alike.filter(|_| !self.pair.is_helical());
            let mut patch = match number_alike {
                Some(other) => patches[other],
                None => self.patch((number, &section), share * layout.width_m(), friction),
            };
            alike = Some(patches.len());
            let heights = self.zone.heights_m(z_m);
            patch.slice = slice;
            patch.share = share;
            patch.gap_m = self.separation_m(&section, z_m);
            patch.places[0].v = heights[0];
            patch.places[1].v = heights[1];
            patches.push(patch);
        }
    }

    /// What a patch in a section is but for its slice, its place along the teeth and its gap; `width_m`: its part of
    /// the face width.
    fn patch(
        &self,
        (number, section): (usize, &ContactLine),
        width_m: f64,
        friction: Option<Friction>,
    ) -> ContactPatch {
        let ratio = friction.map_or(0.0, |f| f.ratio(section.path_m));
        let rolls = [section.roll_1_rad, section.roll_2_rad];
        let (radius_m, radius_growth) =
            self.pair.circles().relative_radius(rolls, self.helix_cos());
        ContactPatch {
            teeth: [section.tooth_1, section.tooth_2],
            line: number,
            slice: 0,
            places: rolls.map(|u| FlankPlace { u, v: 0.0 }),
            share: 1.0,
            length_m: width_m / self.helix_cos(),
            radius_m,
            radius_growth,
            length_growth: [0.0; 2],
            normal: self.normal(section),
            gap_m: 0.0,
            balance: PatchBalance {
                closing: self.closing(section),
                levers_m: self.lever_arms_m(section, ratio),
                friction: ratio,
            },
            edge: self.edge(section),
        }
    }

    /// A contact line in the section at `z_m`: a tip edge beyond the ends of an extended path, roll angles that go on
    /// beyond those of the rigid one.
    pub fn section(&self, line: &ContactLine, z_m: f64) -> ContactLine {
        if !self.pair.is_helical() {
            return *line;
        }
        let roll_1_rad = line.roll_1_rad + z_m * self.pair.roll_slope_1_rad_per_m();
        self.at_edge(ContactLine {
            roll_1_rad,
            roll_2_rad: self.pair.roll_2_rad(roll_1_rad),
            path_m: self.pair.path_from_pitch_point_m(roll_1_rad),
            ..*line
        })
    }

    /// Share of a slice on the path and the middle of that part; none where it is off the path. On an extended path a
    /// slice is whole and touches as its middle does, flank or tip edge, as in motion.
    fn part_on_path(&self, line: &ContactLine, centre_m: f64, width_m: f64) -> Option<(f64, f64)> {
        if !self.pair.is_helical() {
            return Some((1.0, centre_m));
        }
        let at_rest = |place_m: f64| (place_m, SVector::<f64, 0>::zeros());
        let mut part = SlicePart {
            low: at_rest(centre_m - 0.5 * width_m),
            high: at_rest(centre_m + 0.5 * width_m),
        };
        let slope = self.pair.roll_slope_1_rad_per_m();
        if let Some(extension) = &self.extension {
            let along = |from: f64, to: f64| self.pair.circles().sense(0) * (to - from);
            let roll_1_rad = line.roll_1_rad + centre_m * slope;
            let within = along(extension.start_1_rad, roll_1_rad) >= 0.0
                && along(roll_1_rad, extension.end_1_rad) >= 0.0;
            return within.then_some((1.0, centre_m));
        }
        let at = |roll: f64| at_rest((roll - line.roll_1_rad) / slope);
        let towards_end = self.pair.circles().sense(0) * slope > 0.0;
        part.end_at(at(self.pair.roll_end_1_rad), towards_end);
        part.end_at(at(self.pair.roll_start_1_rad), !towards_end);
        let (share, _) = part.share(width_m);
        (share > LEAST_SHARE).then_some((share.min(1.0), part.middle().0))
    }

    /// Direction of the normal force on gear 2, x along the line of centres from gear 1 to gear 2, z along gear 1's
    /// axis: (cos β_b w, ±sin β_b), upper sign on right flanks, w: [`gearmesh_geometry::BaseCircles::action`] at α_w or
    /// the angle of a tip edge's force.
    fn normal(&self, line: &ContactLine) -> [f64; 3] {
        let angle_rad = (line.tip).map_or(self.pair.working_pressure_angle_rad, |tip| {
            tip.force_angle_rad
        });
        let flank = self.pair.flank;
        let (sin, cos) = self.pair.base_helix_angle_rad().sin_cos();
        let [x, y] = self.pair.circles().action(angle_rad, flank);
        [cos * x, cos * y, flank.mirror() * sin]
    }

    /// Roll angles on gear 1 at mid-face between which pairs are looked for.
    pub fn range_1_rad(&self) -> (f64, f64) {
        let (start, end) = self.extension.map_or(
            (self.pair.roll_start_1_rad, self.pair.roll_end_1_rad),
            |e| (e.start_1_rad, e.end_1_rad),
        );
        let reach_m = self.pair.circles().sense(0) * self.zone.reach_m();
        let slant = reach_m * self.pair.roll_slope_1_rad_per_m().abs();
        (start - slant, end + slant)
    }

    /// Largest number of lines at once.
    pub fn most_pairs(&self) -> usize {
        let (start, end) = self.range_1_rad();
        ((end - start).abs() / self.pair.pitch_1_rad()).floor() as usize + 1
    }

    /// Unloaded separation \[m\] along the normal of a slice at zero transmission error, open positive: the gap of a
    /// tip edge, material removed from both flanks and misalignment. `line` is the line in the slice's section. What is
    /// removed from a tip edge along its own normal opens the gap by its component cos δ.
    pub fn separation_m(&self, line: &ContactLine, z_m: f64) -> f64 {
        let [height_1, height_2] = self.zone.heights_m(z_m);
        let removed_1 = self.microgeometry_1.removed_m(line.roll_1_rad, height_1);
        let removed_2 = self.microgeometry_2.removed_m(line.roll_2_rad, height_2);
        let tilted_axes = self.pair.misalignment;
        let (gap, misalignment) = match line.tip {
            None if tilted_axes == Misalignment::default() => (0.0, 0.0),
            None => (
                0.0,
                self.helix_cos() * self.pair.misalignment_gap_m(z_m, line.path_m),
            ),
            Some(tip) => {
                let (sin, cos) = tip.force_angle_rad.sin_cos();
                let away = 1f64.copysign(self.pair.circles().sum_m());
                let slope =
                    away * tilted_axes.inclination_rad * sin + tilted_axes.deviation_rad * cos;
                (self.helix_cos() * tip.gap_m, self.helix_cos() * z_m * slope)
            }
        };
        gap + line.tilt_rad(0).cos() * removed_1 + line.tilt_rad(1).cos() * removed_2 + misalignment
    }

    /// cos β_b: turns lengths along the normal into lengths in the transverse plane.
    fn helix_cos(&self) -> f64 {
        if self.pair.is_helical() {
            self.pair.base_helix_angle_rad().cos()
        } else {
            1.0
        }
    }

    /// How fast the line's gap closes with the approach x = −TE of the bases at a given driver angle: cos β_b, but for
    /// gear 2's tip edge, whose lever arm over r_b2 stands in the place of 1.
    pub fn closing(&self, line: &ContactLine) -> f64 {
        match line.tip {
            Some(tip) if tip.tip_gear == TipGear::Two => {
                self.helix_cos() * tip.tip_arm_m / self.pair.gear_2.base_radius_m
            }
            _ => self.helix_cos(),
        }
    }

    /// Torque about the axes of gear 1 and gear 2 per newton of normal force \[m\]: b = r_b (cos β_b + ratio ξ), or the
    /// lever arms of a tip edge in their place: friction acts along the profile, in the transverse plane.
    /// `friction_ratio` as [`Friction::ratio`].
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
                cos * tip.tip_arm_m + friction_ratio * tip.tip_friction_arm_m;
        }
        arms
    }

    /// The rounded tip edge against the flank, in the plane normal to the flank's generators; none on the path.
    pub fn edge(&self, line: &ContactLine) -> Option<PatchEdge> {
        let (tip, extension) = line.tip.zip(self.extension)?;
        let [r1, r2] = self.pair.circles().radii_m;
        let flank = match tip.tip_gear {
            TipGear::One => r2 * line.roll_2_rad,
            TipGear::Two => r1 * line.roll_1_rad,
        } / self.helix_cos();
        let edge = extension.edge_radius_m;
        Some(PatchEdge {
            gear: tip.tip_gear.indices().0,
            tilt_rad: tip.tilt_rad,
            radius_m: edge * flank / (edge + flank),
        })
    }
}
