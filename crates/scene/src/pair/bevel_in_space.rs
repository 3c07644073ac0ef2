//! A bevel pair as it stands in space, for pictures: teeth of both members, where these are and how far they have
//! turned, where the flanks touch. Frames: docs/theory/bevel_gears.md.

use super::bevel::BevelScene;
use super::bevel_result::BevelRest;
use super::contact_places::ContactPlaces;
use super::result::SceneResult;
use super::run::RunError;
use gearmesh_bevel::Assembly;
use gearmesh_drivetrain::BevelMesh;
use gearmesh_geometry::Flank;
use nalgebra::{Rotation3, Vector3};
use std::f64::consts::TAU;

/// Sections of a tooth from toe to heel.
const SECTIONS: usize = 9;
/// Points up a flank.
const UP: usize = 8;
/// Where a root's corner is, between flank and middle of the space, as a share of the way.
const CORNER: f64 = 0.35;
/// How far the body goes on below the root: as a share of the teeth's depth, and of the root's radius at most.
const RIM: [f64; 2] = [0.9, 0.6];

/// The teeth of a member, and where the body below them ends. Of fillets two corners are left.
#[derive(Debug, Clone, PartialEq)]
pub struct BevelTeeth {
    /// Number of teeth.
    pub teeth: usize,
    /// Tooth 0 in sections from toe to heel, in the member's frame: each from the middle of a space over right flank,
    /// tip and left flank to the next space, whose middle is left to the next tooth \[m\].
    pub sections_m: Vec<Vec<[f64; 3]>>,
    /// z along the axis and radius of the body's end below toe and heel \[m\].
    pub rim_m: [[f64; 2]; 2],
}

/// Where a member stands before it turns about its axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BevelStand {
    /// World from the member's axes, by rows.
    pub axes: [[f64; 3]; 3],
    /// Pitch apex \[m\].
    pub apex_m: [f64; 3],
}

/// A pair with its result. World: the fixed frame, pinion along z, gear in the x-z plane, by half a revolution about z
/// where the flank of the pinion that touches would face down (-y) in the mesh.
#[derive(Debug)]
pub struct BevelInSpace<'a> {
    scene: &'a BevelScene,
    result: &'a SceneResult,
    rest: BevelRest,
    places: &'a ContactPlaces,
    flanks: &'a BevelMesh,
    assembly: Assembly,
}

impl<'a> BevelInSpace<'a> {
    /// A scene with its result; none where this is not of a bevel pair.
    ///
    /// # Errors
    /// [`RunError`] for flanks that cannot be made.
    pub fn new(scene: &'a BevelScene, result: &'a SceneResult) -> Result<Option<Self>, RunError> {
        let Some((rest, places)) = result.bevel.zip(result.lines.places.as_ref()) else {
            return Ok(None);
        };
        let file = &scene.file;
        let flanks = scene.flanks()?;
        // A damaged result may speak of another pair.
        Ok((flanks.teeth() == rest.teeth).then(|| Self {
            scene,
            result,
            rest,
            places,
            flanks,
            assembly: Assembly::new(&file.blank, &file.tca.error),
        }))
    }

    /// The teeth of the pinion (0) or the gear (1).
    ///
    /// # Panics
    /// If there is no such member.
    #[must_use]
    pub fn teeth(&self, member: usize) -> BevelTeeth {
        let blank = &self.scene.file.blank.members[member];
        let root = |cone_m: f64, below_m: f64| {
            blank.meridian_m(cone_m, -blank.dedendum_m(cone_m) - below_m)
        };
        let section = |k: usize| {
            let s = k as f64 / (SECTIONS - 1) as f64;
            let [right, mut left] = Flank::ALL.map(|side| -> Vec<[f64; 3]> {
                let up = (0..UP).map(|i| i as f64 / (UP - 1) as f64);
                up.map(|v| self.flanks.flank_point_m(side, member, [s, v]).into())
                    .collect()
            });
            left.reverse();
            let azimuth = |p: [f64; 3]| p[1].atan2(p[0]);
            let (first, last) = (azimuth(right[0]), azimuth(left[UP - 1]));
            let half_space = 0.5 * (TAU / blank.teeth as f64 - (last - first));
            let [z, radius] = root(blank.inner_cone_m() + s * blank.face_width_m, 0.0);
            let bottom = |angle: f64| [radius * angle.cos(), radius * angle.sin(), z];
            let before = [1.0, CORNER].map(|share| bottom(first - share * half_space));
            let behind = bottom(last + CORNER * half_space);
            let flanks = right.into_iter().chain(left);
            before.into_iter().chain(flanks).chain([behind]).collect()
        };
        let ends = [blank.inner_cone_m(), blank.outer_cone_m];
        let depth_m = blank.outer_addendum_m + blank.outer_dedendum_m;
        let most_m = RIM[1] * root(ends[0], 0.0)[1] / blank.pitch_angle_rad.cos();
        let below_m = most_m.min(RIM[0] * depth_m);
        BevelTeeth {
            teeth: blank.teeth,
            sections_m: (0..SECTIONS).map(section).collect(),
            rim_m: ends.map(|cone_m| root(cone_m, below_m)),
        }
    }

    /// Where a member stands as the pair is assembled.
    ///
    /// # Panics
    /// If there is no such member.
    #[must_use]
    pub fn stand(&self, member: usize) -> BevelStand {
        let placed = &self.assembly.members[member];
        let turned = self.half_turn();
        let row = |i: usize| std::array::from_fn(|j| turned[i] * placed.axes[(i, j)]);
        BevelStand {
            axes: std::array::from_fn(row),
            apex_m: std::array::from_fn(|i| turned[i] * placed.apex_m[i]),
        }
    }

    /// The middle of the face on the line on which the pitch cones touch, in the world \[m\].
    #[must_use]
    pub fn pitch_point_m(&self) -> [f64; 3] {
        let blank = &self.scene.file.blank;
        let (sin, cos) = blank.members[0].pitch_angle_rad.sin_cos();
        let [x, ..] = self.half_turn();
        [x * sin, 0.0, cos].map(|x| blank.mean_cone_m * x)
    }

    /// Signs of x, y and z of the world in the fixed frame. Right flanks face clockwise: down where the gear is on +x.
    fn half_turn(&self) -> [f64; 3] {
        let up = -self.rest.side.mirror();
        [up, up, 1.0]
    }

    /// Angles by which both members have turned about their axes \[rad\]: from the ratio of the teeth the gear on until
    /// it meets the pinion where the least torque presses most. None where nothing presses.
    #[must_use]
    pub fn turns_rad(&self, angle: usize) -> Option<[f64; 2]> {
        let side = self.rest.side;
        let [azimuth_1, azimuth_2] = self.flanks.azimuths_rad(side);
        let turned = -side.mirror() * self.result.angle_rad[angle];
        let designed = [
            turned - azimuth_1,
            -self.assembly.ratio * turned - azimuth_2,
        ];
        let forces = self.result.position_forces(0, angle);
        let loaded = (0..forces.len()).filter(|at| forces[*at] > 0.0);
        let most = loaded.max_by(|a, b| forces[*a].total_cmp(&forces[*b]))?;
        let [on_1, on_2] = [0, 1].map(|m: usize| self.touching_m(angle * forces.len() + most, m));
        let [pinion, gear] = &self.assembly.members;
        let point = pinion.axes * (about_z(designed[0]) * on_1?) + pinion.apex_m;
        let seen = gear.axes.transpose() * (point - gear.apex_m);
        let own = about_z(designed[1]) * on_2?;
        // The points are nearest to each other: the gap is closed along what lies between them.
        let between = seen - own;
        let lever = Vector3::z().cross(&own).dot(&between);
        let closing = if lever == 0.0 {
            0.0
        } else {
            between.norm_squared() / lever
        };
        Some([designed[0], designed[1] + closing])
    }

    /// Where the slices touch, in the pinion's axes \[m\], `[angle][line][slice]`; the origin where none does.
    #[must_use]
    pub fn touching_points_m(&self) -> Vec<[f64; 3]> {
        let all = 0..self.places.width_m.len();
        all.map(|at| self.touching_m(at, 0).map_or([0.0; 3], Into::into))
            .collect()
    }

    /// Where a slice touches a member, in this one's axes.
    fn touching_m(&self, at: usize, member: usize) -> Option<Vector3<f64>> {
        let places = self.places;
        if places.width_m[at] <= 0.0 {
            return None;
        }
        let (up, along_m) = match member {
            0 => (&places.roll_1_rad, &places.z_m),
            _ => (&places.roll_2_rad, &places.z_2_m),
        };
        let s = along_m.get(at)? / self.flanks.face_widths_m()[member] + 0.5;
        let place = [s, *up.get(at)?];
        let point = self.flanks.flank_point_m(self.rest.side, member, place);
        let pair = self.result.lines.pair[at / self.result.lines.slices] as i64;
        let [tooth, teeth] =
            [self.rest.teeth_of(pair), self.rest.teeth].map(|of| of[member] as f64);
        Some(about_z(TAU * tooth / teeth) * point)
    }
}

fn about_z(angle_rad: f64) -> Rotation3<f64> {
    Rotation3::from_axis_angle(&Vector3::z_axis(), angle_rad)
}
