//! A bevel gear as a solid for CAD: the blank's meridian, to be turned, and the slot between two teeth in plane
//! sections, to be skinned and cut out of it as often as there are teeth.

use std::f64::consts::{PI, TAU};

use gearmesh_geometry::Flank as Facing;
use nalgebra::{Rotation3, Vector3};

use crate::bevel_gear::BevelGear;
use crate::error::BevelError;
use crate::flank::Flank;

/// Sections of a slot from beyond the toe to beyond the heel.
const SECTIONS: usize = 33;
/// The slot goes on beyond toe and heel, as a share of the face, and above the tip, as a share of the depth: it is cut
/// out of the blank.
const BEYOND: [f64; 2] = [0.05, 0.05];
/// Points of a fillet, and of a flank, in a section.
const POINTS: usize = 24;
/// Places on a flank, along the face and up the profile, that a solid is to be compared with.
const CHECKED: [usize; 2] = [13, 7];
/// Steps of the secant method to a plane, and how near \[m\].
const MOST_STEPS: usize = 20;
const CLOSE_M: f64 = 1e-13;

/// One wall of a slot.
struct Wall<'a> {
    flank: &'a Flank,
    /// About the axis, from where the flank's mean point lies on +x.
    turn: Rotation3<f64>,
}

impl Wall<'_> {
    /// A point at a cone distance. `place`: from 0 above the tip to 1 where the fillet begins, from there to 2 at its
    /// lower end.
    fn point(&self, cone_m: f64, place: f64) -> Result<Vector3<f64>, BevelError> {
        let r = if place <= 1.0 {
            let blank = &self.flank.blank;
            let bottom = self.flank.bottom(cone_m)?;
            let low = self.flank.place(&bottom.point.r)[1];
            let tip = blank.addendum_m(cone_m);
            let high = tip + BEYOND[1] * (tip + blank.dedendum_m(cone_m));
            let height = high + place * (low - high);
            self.flank.locate_from(cone_m, height, &bottom)?.point.r
        } else {
            self.flank.fillet_line(cone_m, &[2.0 - place])?[0].point.r
        };
        Ok(self.turn * r)
    }

    /// A point in a plane.
    fn in_plane(&self, plane: &Plane, place: f64) -> Result<Vector3<f64>, BevelError> {
        let mut cone_m = plane.cone_m;
        let mut last: Option<[f64; 2]> = None;
        let mut found = self.point(cone_m, place)?;
        for _ in 0..MOST_STEPS {
            let off_m = plane.normal.dot(&found) - plane.cone_m;
            if off_m.abs() < CLOSE_M {
                break;
            }
            // Along the generator of the pitch cone it changes as the cone distance does.
            let slope = last.map_or(1.0, |[cone, off]| (off_m - off) / (cone_m - cone));
            last = Some([cone_m, off_m]);
            cone_m -= off_m / slope;
            found = self.point(cone_m, place)?;
        }
        Ok(found)
    }

    fn azimuth_rad(&self, cone_m: f64) -> Result<f64, BevelError> {
        let r = self.turn * self.flank.locate(cone_m, 0.0)?.point.r;
        Ok(r.y.atan2(r.x))
    }
}

/// A plane normal to the generator of the pitch cone in the middle of the slot.
struct Plane {
    normal: Vector3<f64>,
    cone_m: f64,
}

/// Outlines of a bevel gear's solid, in the member's frame.
#[derive(Debug, Clone, PartialEq)]
pub struct SolidOutline {
    /// Corners of the blank, radius and z \[m\]: tips of toe and heel, rim, body on the heel's side, bore, body on the
    /// toe's side, rim.
    pub meridian_m: Vec<[f64; 2]>,
    /// Sections of the slot from tooth 0 to tooth 1, from before the toe to behind the heel.
    pub slot: Vec<SlotSection>,
    /// Points of the right and left flank of tooth 0, to compare a solid with \[m\].
    pub flanks_m: [Vec<[f64; 3]>; 2],
}

/// A plane section of a slot.
#[derive(Debug, Clone, PartialEq)]
pub struct SlotSection {
    /// Left flank and fillet of tooth 0, right flank and fillet of tooth 1, each downwards \[m\]. The slot's bottom is
    /// straight between the fillets.
    pub walls_m: [Vec<[f64; 3]>; 4],
    /// A point above the tips, which with the walls' upper ends closes the section \[m\].
    pub lid_m: [f64; 3],
}

impl BevelGear {
    /// Outlines of the gear's solid.
    ///
    /// # Errors
    /// [`BevelError`] where the tool leaves no surface a little beyond the blank.
    pub fn solid_outline(&self) -> Result<SolidOutline, BevelError> {
        let blank = self.blank();
        // Tooth 0's left flank and tooth 1's right one.
        let walls = [
            self.wall(Facing::Left, 0.0),
            self.wall(Facing::Right, TAU / blank.teeth as f64),
        ];
        let section = |i: usize| {
            let along = i as f64 / (SECTIONS - 1) as f64;
            let share = (1.0 + 2.0 * BEYOND[0]) * along - BEYOND[0];
            self.slot_section(&walls, blank.inner_cone_m() + blank.face_width_m * share)
        };
        let [right, left] = Facing::ALL.map(|side| self.checked_points(&self.wall(side, 0.0)));
        Ok(SolidOutline {
            meridian_m: self.meridian_m(),
            slot: (0..SECTIONS).map(section).collect::<Result<_, _>>()?,
            flanks_m: [right?, left?],
        })
    }

    fn wall(&self, side: Facing, further_rad: f64) -> Wall<'_> {
        let side = self.flank_side(side);
        let turn_rad = self.tooth.half_angle_rad(side) + further_rad;
        Wall {
            flank: self.tooth.flank(side),
            turn: Rotation3::from_axis_angle(&Vector3::z_axis(), turn_rad),
        }
    }

    fn slot_section(&self, walls: &[Wall<'_>; 2], cone_m: f64) -> Result<SlotSection, BevelError> {
        let blank = self.blank();
        let [a, b] = [walls[0].azimuth_rad(cone_m)?, walls[1].azimuth_rad(cone_m)?];
        // The way from tooth 0 to tooth 1 is counter-clockwise.
        let middle_rad = a + 0.5 * (b - a).rem_euclid(TAU);
        let (sin, cos) = blank.pitch_angle_rad.sin_cos();
        let out = Vector3::new(middle_rad.cos(), middle_rad.sin(), 0.0);
        let plane = Plane {
            normal: out * sin + Vector3::z() * cos,
            cone_m,
        };
        let line = |wall: &Wall<'_>, from: f64| -> Result<Vec<[f64; 3]>, BevelError> {
            let point = |k: usize| {
                let r = wall.in_plane(&plane, from + closer_to_the_ends(k))?;
                Ok([r.x, r.y, r.z])
            };
            (0..POINTS).map(point).collect()
        };
        let [left, right] = walls;
        // Above the arc of the tip between both flanks.
        let up = out * cos - Vector3::z() * sin;
        let tip_m = blank.addendum_m(cone_m);
        let lid = plane.normal * cone_m + up * (2.0 * tip_m + blank.dedendum_m(cone_m));
        Ok(SlotSection {
            walls_m: [
                line(left, 0.0)?,
                line(left, 1.0)?,
                line(right, 0.0)?,
                line(right, 1.0)?,
            ],
            lid_m: [lid.x, lid.y, lid.z],
        })
    }

    fn checked_points(&self, wall: &Wall<'_>) -> Result<Vec<[f64; 3]>, BevelError> {
        let blank = self.blank();
        let mut points = Vec::new();
        for i in 0..CHECKED[0] {
            let share = i as f64 / (CHECKED[0] - 1) as f64;
            let cone_m = blank.inner_cone_m() + blank.face_width_m * share;
            let bottom = wall.flank.bottom(cone_m)?;
            let low = wall.flank.place(&bottom.point.r)[1];
            for k in 0..CHECKED[1] {
                let part = k as f64 / (CHECKED[1] - 1) as f64;
                let height = low + part * (blank.addendum_m(cone_m) - low);
                let found = wall.flank.locate_from(cone_m, height, &bottom)?;
                let r = wall.turn * found.point.r;
                points.push([r.x, r.y, r.z]);
            }
        }
        Ok(points)
    }

    fn meridian_m(&self) -> Vec<[f64; 2]> {
        let (blank, body) = (self.blank(), &self.body);
        let corner = |cone: f64, height: f64| {
            let [z, radius] = blank.meridian_m(cone, height);
            [radius, z]
        };
        let below = |cone: f64| corner(cone, -blank.dedendum_m(cone) - body.rim_m);
        let [toe, heel] = [blank.inner_cone_m(), blank.outer_cone_m];
        let mut corners = vec![
            corner(toe, blank.addendum_m(toe)),
            corner(heel, blank.addendum_m(heel)),
            below(heel),
        ];
        corners.extend(body.contour.iter().map(|p| [p.radius_m, p.z_m[1]]));
        corners.extend(body.contour.iter().rev().map(|p| [p.radius_m, p.z_m[0]]));
        corners.push(below(toe));
        corners
    }
}

/// Places of the points of a spline between 0 and 1.
fn closer_to_the_ends(k: usize) -> f64 {
    0.5 * (1.0 - (PI * k as f64 / (POINTS - 1) as f64).cos())
}
