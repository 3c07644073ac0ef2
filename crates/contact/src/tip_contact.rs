//! Tip edge on flank: where a tooth pair touches beyond the ends of the path of contact.
//!
//! Loaded teeth deflect, so that the tip edge of the driven gear meets the driver's flank before the theoretical path
//! begins, and the driver's tip edge leaves the driven flank after it has ended. All points at one distance from an
//! involute along its normals lie on another involute of the same base circle, so the gap of a point to a flank is
//! r_b times the angle by which the flank must turn to reach it: exact, without iteration. Derivation in
//! docs/theory/involute_flanks.md. With a ring all lengths of the ring and of the pair count negative
//! ([`gearmesh_geometry::BaseCircles`]); gaps, lever arms and roll angles stay positive.

use gearmesh_geometry::GearPair;

/// Gear whose tip edge touches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TipGear {
    /// Gear 1, the driver: after the end of the path (recess).
    One,
    /// Gear 2, driven: before the path begins (approach).
    Two,
}

impl TipGear {
    /// Index into arrays over the gears: tip gear, mating gear.
    pub fn indices(self) -> (usize, usize) {
        match self {
            Self::One => (0, 1),
            Self::Two => (1, 0),
        }
    }
}

/// A tip edge against the mating flank, rigid gears without microgeometry.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TipContact {
    /// Gear whose tip edge it is.
    pub tip_gear: TipGear,
    /// Gap along the mating flank's normal \[m\], open positive. Grows by the mating gear's r_b per radian of its
    /// turning back, by `tip_arm_m` per radian of the tip gear's.
    pub gap_m: f64,
    /// Roll angle of the foot point on the mating flank \[rad\].
    pub foot_roll_rad: f64,
    /// Turn of the force on the tip tooth from its own flank's inward normal towards its tip \[rad\]; negative, that is
    /// towards the root, beyond the ends of the path. Zero at the ends.
    pub tilt_rad: f64,
    /// Angle between the force and the perpendicular to the line of centres \[rad\]: α_w at the ends of the path.
    pub force_angle_rad: f64,
    /// Lever arm of the normal force about the tip gear's axis \[m\]; r_b of the tip gear at the ends of the path.
    /// About the mating gear's axis it is always that gear's r_b.
    pub tip_arm_m: f64,
    /// Lever arm about the tip gear's axis of a unit force towards its tip, perpendicular to the normal force \[m\].
    pub tip_friction_arm_m: f64,
}

impl TipContact {
    /// The tip edge of `tip_gear` (tip circle, or corner of the chamfer) where its flank stands at roll angle
    /// `tip_roll_rad` and the mating flank at `flank_roll_rad`: the roll angles at which each flank crosses the line of
    /// action. With TE = 0 they belong together by [`GearPair::roll_2_rad`].
    pub fn new(pair: &GearPair, tip_gear: TipGear, tip_roll_rad: f64, flank_roll_rad: f64) -> Self {
        let tip = match tip_gear {
            TipGear::One => &pair.gear_1,
            TipGear::Two => &pair.gear_2,
        };
        let (of_tip, of_mate) = tip_gear.indices();
        let circles = pair.circles();
        let (base, mate_base) = (circles.radii_m[of_tip], circles.radii_m[of_mate]);
        let alpha_w = pair.working_pressure_angle_rad;
        // Origin on the mating gear's axis, x along the line of action towards the tip gear's base circle.
        let centre = [pair.line_of_action_m(), mate_base + base];
        let edge_roll = tip.flank_end_roll_rad;
        let turned = edge_roll - tip_roll_rad;
        let (sin, cos) = turned.sin_cos();
        let from_centre = [
            base * (sin - edge_roll * cos),
            -base * (cos + edge_roll * sin),
        ];
        let edge = [centre[0] + from_centre[0], centre[1] + from_centre[1]];

        // The involute of the mating base circle through the edge.
        let edge_radius = edge[0].hypot(edge[1]);
        let along = ((edge_radius / mate_base).powi(2) - 1.0).max(0.0).sqrt();
        let side = circles.sense(of_mate);
        let normal_turned = (side * edge[0]).atan2(side * edge[1]) - along.atan();
        let open_rad = normal_turned + along - flank_roll_rad;
        let normal = [normal_turned.cos(), -normal_turned.sin()];
        let outwards = circles.sense(of_tip);
        Self {
            tip_gear,
            gap_m: mate_base * open_rad,
            foot_roll_rad: along - open_rad,
            tilt_rad: turned + normal_turned,
            force_angle_rad: alpha_w - normal_turned,
            tip_arm_m: outwards * (from_centre[0] * normal[1] - from_centre[1] * normal[0]),
            tip_friction_arm_m: -outwards
                * (from_centre[0] * normal[0] + from_centre[1] * normal[1]),
        }
    }
}

/// How far beyond the ends of the path pairs are looked for: up to this rigid gap over the base pitch.
///
/// No unit. Teeth that deflect by more than 1 % of the base pitch raise a warning in a run; half as much again leaves
/// room for microgeometry. A pair beyond it counts as apart.
pub const LARGEST_GAP_OVER_BASE_PITCH: f64 = 0.015;

/// Contact beyond the ends of the path of contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathExtension {
    /// Radius of the tip edge in the local contact \[m\]. The edge itself stands at the sharp corner.
    pub edge_radius_m: f64,
    /// Roll angle on gear 1 from which pairs are looked for.
    pub start_1_rad: f64,
    /// Roll angle on gear 1 up to which pairs are looked for.
    pub end_1_rad: f64,
}

impl PathExtension {
    /// Derives how far the path is extended: up to [`LARGEST_GAP_OVER_BASE_PITCH`], at most half a pitch at each end
    /// and never beyond the end of the mating flank.
    pub fn new(pair: &GearPair, edge_radius_m: f64) -> Self {
        let base_pitch = pair.pitch_1_rad() * pair.gear_1.base_radius_m;
        let largest_gap = LARGEST_GAP_OVER_BASE_PITCH * base_pitch;
        let flank_ends = [
            pair.gear_1.flank_end_roll_rad,
            pair.gear_2.flank_end_roll_rad,
        ];
        let circles = pair.circles();
        let reach = |tip_gear: TipGear| {
            let (mut near, mut far) = (0.0, 0.5 * pair.pitch_1_rad());
            let inside = |beyond: f64| {
                let contact = tip_contact_beyond(pair, tip_gear, beyond);
                let (_, mate) = tip_gear.indices();
                let past_end = contact.foot_roll_rad - flank_ends[mate];
                contact.gap_m <= largest_gap && circles.sense(mate) * past_end <= 0.0
            };
            if inside(far) {
                return far;
            }
            for _ in 0..60 {
                let middle = 0.5 * (near + far);
                if inside(middle) {
                    near = middle;
                } else {
                    far = middle;
                }
            }
            near
        };
        Self {
            edge_radius_m,
            start_1_rad: pair.roll_start_1_rad - circles.sense(0) * reach(TipGear::Two),
            end_1_rad: pair.roll_end_1_rad + circles.sense(0) * reach(TipGear::One),
        }
    }
}

/// The tip edge at TE = 0, the pair `beyond_1_rad` of gear 1's turn outside the path.
pub(crate) fn tip_contact_beyond(
    pair: &GearPair,
    tip_gear: TipGear,
    beyond_1_rad: f64,
) -> TipContact {
    let towards_end = pair.circles().sense(0) * beyond_1_rad;
    match tip_gear {
        TipGear::One => {
            let roll_1 = pair.roll_end_1_rad + towards_end;
            TipContact::new(pair, tip_gear, roll_1, pair.roll_2_rad(roll_1))
        }
        TipGear::Two => {
            let roll_1 = pair.roll_start_1_rad - towards_end;
            TipContact::new(pair, tip_gear, pair.roll_2_rad(roll_1), roll_1)
        }
    }
}
