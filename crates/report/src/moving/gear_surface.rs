//! The surface of a gear: the exact outline of the teeth over the height with faces and bore of a solid disc, or that
//! of its finite elements.

use gearmesh_geometry::{Flank, GearDefinition, ProfileCurve, ToothGeometry};
use std::f64::consts::TAU;

/// Quadrilaterals along half an outline: root arc, fillet, flank, chamfer, tip land.
const ROOT: usize = 2;
const FILLET: usize = 5;
const FLANK: usize = 12;
const TIP: usize = 2;

/// A gear's surface in its own frame: z along the axis, tooth 0 on +x.
#[derive(Debug, Clone)]
pub struct GearSurface {
    /// Points \[m\].
    pub points_m: Vec<[f64; 3]>,
    /// Corners, counter-clockwise seen from outside; a triangle names its last one twice.
    pub quads: Vec<[u32; 4]>,
    /// Tooth of each quadrilateral; −1 on faces and bore.
    pub teeth: Vec<i32>,
    flanks: Flanks,
}

/// Which quadrilaterals the flanks are made of.
#[derive(Debug, Clone)]
enum Flanks {
    /// Of the exact outline.
    Outline {
        tooth: Box<ToothGeometry>,
        /// Heights of the sections \[m\], rising.
        heights_m: Vec<f64>,
        /// Quadrilaterals along half an outline before the flank, and in all.
        before_flank: usize,
        half: usize,
    },
    /// Faces of elements, right and left.
    Faces([Vec<FlankFace>; 2]),
}

/// A face of finite elements on a flank.
#[derive(Debug, Clone, PartialEq)]
pub struct FlankFace {
    /// Least and largest place along the profile: roll angle \[rad\], on a bevel gear the share of the way up the
    /// flank.
    pub along_profile: [f64; 2],
    /// Least and largest height \[m\], as [`super::FlankLoad::height_m`].
    pub heights_m: [f64; 2],
    /// Its number among the quadrilaterals, tooth by tooth.
    pub quads: Vec<u32>,
}

impl FlankFace {
    /// Distance of a place, in sizes of the face.
    fn distance(&self, place: [f64; 2]) -> f64 {
        let beyond = |[low, high]: [f64; 2], x: f64| {
            (low - x).max(x - high).max(0.0) / (high - low).max(f64::MIN_POSITIVE)
        };
        beyond(self.along_profile, place[0]).hypot(beyond(self.heights_m, place[1]))
    }
}

impl GearSurface {
    /// The surface with sections at these heights \[m\] within the face, and at both faces.
    #[must_use]
    pub fn new(gear: &GearDefinition, heights_m: &[f64]) -> Self {
        let tooth = &gear.profile;
        let half_width = 0.5 * gear.tooth.face_width_m;
        let mut heights = vec![-half_width, half_width];
        let inside = |z: &&f64| z.abs() < half_width * (1.0 - 1e-9);
        heights.extend(heights_m.iter().filter(inside));
        heights.sort_by(f64::total_cmp);
        heights.dedup_by(|a, b| (*a - *b).abs() < 1e-9 * half_width);
        let (right, before_flank) = half_outline(tooth);
        let whole = mirrored(&right);
        let mut surface = Self {
            points_m: outlines(tooth, &whole, &heights),
            quads: Vec::new(),
            teeth: Vec::new(),
            flanks: Flanks::Outline {
                tooth: Box::new(tooth.clone()),
                heights_m: heights,
                before_flank,
                half: right.len() - 1,
            },
        };
        let columns = whole.len() * tooth.teeth;
        let layers = surface.points_m.len() / columns;
        surface.cover_teeth(columns, layers, whole.len());
        // Where the faces end: at the bore, or at a ring's outside.
        let edge = (gear.blank.rim()).map_or(gear.blank.bore_radius_m(), |rim| rim.outer_radius_m);
        surface.cover_faces(columns, layers, edge);
        if tooth.internal {
            // The material lies on the other side of the outline.
            surface.quads.iter_mut().for_each(|quad| quad.reverse());
        }
        surface
    }

    /// Quadrilaterals between the outlines of neighbouring sections, column by column.
    fn cover_teeth(&mut self, columns: usize, layers: usize, per_tooth: usize) {
        let at = |column: usize, layer: usize| (layer * columns + column % columns) as u32;
        for column in 0..columns {
            for layer in 0..layers - 1 {
                self.quads.push([
                    at(column, layer),
                    at(column + 1, layer),
                    at(column + 1, layer + 1),
                    at(column, layer + 1),
                ]);
                self.teeth.push((column / per_tooth) as i32);
            }
        }
    }

    /// Both faces from the outline to the radius at which they end, and the cylinder between them.
    fn cover_faces(&mut self, columns: usize, layers: usize, edge_m: f64) {
        let at = |column: usize, layer: usize| (layer * columns + column % columns) as u32;
        let top = layers - 1;
        let rings = [0, top].map(|layer| {
            let first = self.points_m.len() as u32;
            for column in 0..columns {
                let [x, y, z] = self.points_m[at(column, layer) as usize];
                let radius = x.hypot(y);
                self.points_m
                    .push([edge_m * x / radius, edge_m * y / radius, z]);
            }
            first
        });
        let on = |ring: usize, column: usize| rings[ring] + (column % columns) as u32;
        for column in 0..columns {
            let next = column + 1;
            self.quads.extend([
                [at(column, 0), on(0, column), on(0, next), at(next, 0)],
                [at(column, top), at(next, top), on(1, next), on(1, column)],
            ]);
            self.teeth.extend([-1; 2]);
            // A gear cut into its shaft has no bore: its faces end at the axis.
            if edge_m > 0.0 {
                self.quads
                    .push([on(0, column), on(1, column), on(1, next), on(0, next)]);
                self.teeth.push(-1);
            }
        }
    }

    /// The surface of a mesh of finite elements: points \[m\], corners, the tooth of each face, and the faces that
    /// right and left flanks are made of.
    #[must_use]
    pub fn of_elements(
        points_m: Vec<[f64; 3]>,
        quads: Vec<[u32; 4]>,
        teeth: Vec<i32>,
        flanks: [Vec<FlankFace>; 2],
    ) -> Self {
        Self {
            points_m,
            quads,
            teeth,
            flanks: Flanks::Faces(flanks),
        }
    }

    /// The quadrilateral of a flank at a roll angle and height; the nearest where they lie beyond its ends.
    #[must_use]
    pub fn flank_quad(
        &self,
        (number, side): (usize, Flank),
        roll_rad: f64,
        height_m: f64,
    ) -> usize {
        let (tooth, heights_m, before_flank, half) = match &self.flanks {
            Flanks::Outline {
                tooth,
                heights_m,
                before_flank,
                half,
            } => (tooth, heights_m, *before_flank, *half),
            Flanks::Faces(sides) => {
                let place = [roll_rad, height_m];
                let faces = sides[side as usize].iter();
                let nearest = faces.min_by(|a, b| a.distance(place).total_cmp(&b.distance(place)));
                return nearest.map_or(0, |face| face.quads[number % face.quads.len()] as usize);
            }
        };
        let share =
            (roll_rad - tooth.form_roll_rad) / (tooth.flank_end_roll_rad - tooth.form_roll_rad);
        let place = ((FLANK as f64 * share) as usize).min(FLANK - 1) + before_flank;
        let column = match side {
            Flank::Right => place,
            Flank::Left => 2 * half - 1 - place,
        };
        let layers = heights_m.len() - 1;
        let above = heights_m.partition_point(|z| *z <= height_m);
        let layer = above.saturating_sub(1).min(layers - 1);
        (number % tooth.teeth * 2 * half + column) * layers + layer
    }
}

/// Inward normal and direction along the profile towards the tip at a place of a flank, in the gear's frame.
#[must_use]
pub fn flank_directions(
    t: &ToothGeometry,
    (tooth, side): (usize, Flank),
    roll_rad: f64,
    height_m: f64,
) -> [[f64; 3]; 2] {
    let turn = TAU * tooth as f64 / t.teeth as f64 + height_m * t.twist_rad_per_m();
    let (s, c) = turn.sin_cos();
    let turned = |v: [f64; 3]| [c * v[0] - s * v[1], s * v[0] + c * v[1], v[2]];
    let (_, [x, y]) = t.flank_frame(side, roll_rad);
    [turned(t.flank_normal(side, roll_rad)), turned([x, y, 0.0])]
}

/// The outline of tooth 0 from the middle of one tooth space to the next \[m\]; its last point is left to the next
/// tooth, whose first one it is.
#[must_use]
pub fn tooth_outline(tooth: &ToothGeometry) -> Vec<[f64; 2]> {
    mirrored(&half_outline(tooth).0)
}

/// Points of the outlines of all teeth at all heights.
fn outlines(tooth: &ToothGeometry, whole: &[[f64; 2]], heights_m: &[f64]) -> Vec<[f64; 3]> {
    let mut points = Vec::new();
    for &z in heights_m {
        for number in 0..tooth.teeth {
            let turn = TAU * number as f64 / tooth.teeth as f64 + z * tooth.twist_rad_per_m();
            let (s, c) = turn.sin_cos();
            let turned = |p: &[f64; 2]| [c * p[0] - s * p[1], s * p[0] + c * p[1], z];
            points.extend(whole.iter().map(turned));
        }
    }
    points
}

/// The outline of a tooth from its right half.
fn mirrored(right: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let inner = &right[1..right.len() - 1];
    let left = inner.iter().rev().map(|p| [p[0], -p[1]]);
    right.iter().copied().chain(left).collect()
}

/// The right half of a tooth's outline from the middle of the space to that of the tip land, and how many
/// quadrilaterals lie before the flank.
fn half_outline(tooth: &ToothGeometry) -> (Vec<[f64; 2]>, usize) {
    let curve = ProfileCurve::new(tooth);
    let mut points = Vec::new();
    let along = |points: &mut Vec<[f64; 2]>, from: f64, to: f64, count: usize| {
        if to - from > 1e-9 * curve.length_m() {
            let each = (0..count).map(|k| from + (to - from) * k as f64 / count as f64);
            points.extend(each.map(|s| curve.point_at(s)));
        }
    };
    along(&mut points, 0.0, curve.root_arc_end_m(), ROOT);
    along(
        &mut points,
        curve.root_arc_end_m(),
        curve.flank_start_m(),
        FILLET,
    );
    let before_flank = points.len();
    for k in 0..FLANK {
        let share = k as f64 / FLANK as f64;
        let roll = tooth.form_roll_rad + share * (tooth.flank_end_roll_rad - tooth.form_roll_rad);
        points.push(tooth.flank_point_m(Flank::Right, roll));
    }
    along(&mut points, curve.flank_end_m(), curve.tip_start_m(), 1);
    if points.len() == before_flank + FLANK {
        points.push(tooth.flank_point_m(Flank::Right, tooth.flank_end_roll_rad));
        points.push([tooth.tip_radius_m, 0.0]);
    } else {
        along(&mut points, curve.tip_start_m(), curve.length_m(), TIP);
        points.push([tooth.tip_radius_m, 0.0]);
    }
    (points, before_flank)
}
