//! The node lines of the right half of one tooth, from the tooth space to the centre line: what `tooth_blocks.rs`
//! mirrors and joins to blocks. Its picture has the names.

use crate::grading::{Pieces, graded};
use crate::ring_radius::ring_radius_m;
use gearmesh_geometry::{GearDefinition, ProfileCurve, RootPosition, ToothGeometry};
use std::f64::consts::PI;

/// Elements across the layer along the outline, and their growth inwards.
const LAYERS: usize = 3;
const LAYER_GROWTH: f64 = 1.35;
/// Thickness of that layer in fillet element lengths.
const LAYER_THICKNESS: f64 = 2.6;
/// The layer along the outline takes no more than this share of the ring.
const LAYER_SHARE: f64 = 0.6;
/// Growth of element length along the outline, per length.
const GRADING: f64 = 0.3;

/// Points, and lines of places among them.
pub(crate) struct HalfLines {
    /// Coordinates in metres and the mesher's size factor.
    pub(crate) points: Vec<[f64; 3]>,
    /// From the middle of the tooth space over fillet and flank to the tip land.
    pub(crate) outline: Vec<usize>,
    /// Arc length of each of its points.
    pub(crate) arcs_m: Vec<f64>,
    /// The inner edge of the layer along it, point by point.
    pub(crate) offset: Vec<usize>,
    /// The place in both at which the cut begins.
    pub(crate) cut_position: usize,
    /// Across the layer, from the outline inwards: at the tooth space, at the cut, on the tip land.
    pub(crate) at_space: Vec<usize>,
    pub(crate) at_cut: Vec<usize>,
    pub(crate) at_tip: Vec<usize>,
    /// From the layer to the centre line: the cut, and the tip land.
    pub(crate) cut: Vec<usize>,
    pub(crate) tip_land: Vec<usize>,
    /// From the layer at the tooth space to the circle where the body begins.
    pub(crate) down: Vec<usize>,
    /// Along that circle to the centre line.
    pub(crate) bottom: Vec<usize>,
}

impl HalfLines {
    /// Places the nodes of all lines.
    pub(crate) fn new(gear: &GearDefinition, curve: &ProfileCurve) -> Self {
        let tooth = &gear.profile;
        let (h_fillet, h_flank) = (gear.mesh.fillet_m, gear.mesh.flank_m);
        let space = tooth.space_angle_rad();
        let (arcs_m, cut_position) = outline_arcs(gear, curve);
        let last = arcs_m.len() - 1;
        let layer = Layer::new(gear);
        let outline_points: Vec<[f64; 2]> = arcs_m.iter().map(|&s| curve.point_at(s)).collect();
        let offset_points = layer.inner_edge(gear, curve, &arcs_m, cut_position);

        let mut points = Points(Vec::new());
        let outline: Vec<usize> = outline_points.iter().map(|&p| points.add(p)).collect();
        let offset: Vec<usize> = offset_points.iter().map(|&p| points.add(p)).collect();
        let shares = layer_shares();
        let across = |points: &mut Points, i: usize| -> Vec<usize> {
            let (p, q) = (outline_points[i], offset_points[i]);
            let mut line = vec![outline[i]];
            for &w in &shares {
                let straight = [p[0] + w * (q[0] - p[0]), p[1] + w * (q[1] - p[1])];
                let r = straight[0].hypot(straight[1]);
                // The layer's edge on the tip land lies on the tip circle.
                let scale = if i == last {
                    tooth.tip_radius_m / r
                } else {
                    1.0
                };
                line.push(points.add([straight[0] * scale, straight[1] * scale]));
            }
            line.push(offset[i]);
            line
        };
        let at_space = across(&mut points, 0);
        let at_cut = across(&mut points, cut_position);
        let at_tip = across(&mut points, last);

        // Pieces grow from those of the layer, so that the stress below the fillet is resolved beyond it.
        let innermost = layer.thickness_m * (1.0 - shares[shares.len() - 1]);
        let growing = |length: f64, largest: f64, least: usize| {
            let size = |from_layer: f64| (innermost + GRADING * from_layer).min(largest);
            graded(0.0, length, size, Pieces::at_least(least))
        };
        // Cut and tip land have the same number of pieces from the layer to the centre line.
        let [x, y] = offset_points[cut_position];
        let (cut_radius, cut_angle) = (x.hypot(y), y.atan2(x));
        let cut_length = cut_angle.abs() * cut_radius;
        let across_cut = growing(cut_length, h_flank, 2);
        let width = across_cut.len() - 1;
        let cut_shares = across_cut.iter().map(|along| along / cut_length);
        let cut = points.arc(offset[cut_position], cut_radius, cut_angle, cut_shares);
        let tip_angle = layer.tip_angle_rad;
        let tip_land = points.arc(offset[last], tooth.tip_radius_m, tip_angle, equal(width));

        // On to the circle where the body begins.
        let outwards = tooth.tip_direction();
        let ring = ring_radius_m(gear);
        let start_radius = tooth.root_radius_m - outwards * layer.thickness_m;
        let depth = growing((start_radius - ring).abs(), h_flank.max(2.0 * h_fillet), 2);
        let mut down = vec![offset[0]];
        let below = depth[1..].iter();
        down.extend(below.map(|d| points.add(polar(start_radius - outwards * d, space))));
        let corner = down[down.len() - 1];
        let bottom = points.arc(corner, ring, space, equal(cut_position + width));
        Self {
            points: points.0,
            outline,
            arcs_m,
            offset,
            cut_position,
            at_space,
            at_cut,
            at_tip,
            cut,
            tip_land,
            down,
            bottom,
        }
    }

    /// Arc lengths in metres of the outline's points up to the centre line, those on the tip land included.
    /// `tip_start_m` is the arc length at which the tip land begins.
    pub(crate) fn arcs_to_centre(&self, tooth: &ToothGeometry, tip_start_m: f64) -> Vec<f64> {
        let on_land = self.at_tip[1..].iter().chain(&self.tip_land[1..]);
        let land = on_land.map(|&i| {
            let [x, y, _] = self.points[i];
            tip_start_m + (y.atan2(x) + tooth.tip_half_angle_rad()) * tooth.tip_radius_m
        });
        self.arcs_m.iter().copied().chain(land).collect()
    }
}

/// Arc lengths of the outline's nodes up to the tip land, and the place of the one at which the cut begins.
fn outline_arcs(gear: &GearDefinition, curve: &ProfileCurve) -> (Vec<f64>, usize) {
    let (h_fillet, h_flank) = (gear.mesh.fillet_m, gear.mesh.flank_m);
    let cut = curve
        .arc_length_at(RootPosition::TangentAngle(0.25 * PI))
        .unwrap_or_else(|_| 0.5 * curve.flank_start_m());
    let (form, end, tip) = (
        curve.flank_start_m(),
        curve.flank_end_m(),
        curve.tip_start_m(),
    );
    let size = |s: f64| (h_fillet + GRADING * (s - form).max(0.0)).min(h_flank);
    let mut arcs = graded(0.0, cut, size, Pieces::at_least(3));
    let cut_position = arcs.len() - 1;
    arcs.extend(&graded(cut, end, size, Pieces::at_least(4))[1..]);
    if tip > end {
        arcs.push(tip);
    }
    (arcs, cut_position)
}

/// The layer of elements along the outline.
struct Layer {
    thickness_m: f64,
    tip_thickness_m: f64,
    /// Angle of its inner edge on the tip land.
    tip_angle_rad: f64,
}

impl Layer {
    fn new(gear: &GearDefinition) -> Self {
        let tooth = &gear.profile;
        let room = LAYER_SHARE * (tooth.root_radius_m - ring_radius_m(gear)).abs();
        let thickness_m = (LAYER_THICKNESS * gear.mesh.fillet_m).min(room);
        let tip_half = tooth.tip_half_angle_rad();
        let tip_thickness_m = thickness_m.min(0.45 * tip_half * tooth.tip_radius_m);
        Self {
            thickness_m,
            tip_thickness_m,
            tip_angle_rad: -tip_half + tip_thickness_m / tooth.tip_radius_m,
        }
    }

    /// The inner edge: along the outline's normal, turning into the tip land at the tip.
    fn inner_edge(
        &self,
        gear: &GearDefinition,
        curve: &ProfileCurve,
        arcs_m: &[f64],
        cut_position: usize,
    ) -> Vec<[f64; 2]> {
        let tooth = &gear.profile;
        // From the outline into the body the radius falls, in a ring it grows.
        let outwards = tooth.tip_direction();
        let last = arcs_m.len() - 1;
        let (cut, tip) = (arcs_m[cut_position], curve.tip_start_m());
        let along_land = polar(1.0, -tooth.tip_half_angle_rad() + 0.5 * PI);
        let ds = 1e-3 * gear.mesh.fillet_m;
        let inner = |i: usize| {
            let p = curve.point_at(arcs_m[i]);
            if i == 0 {
                let radius = p[0].hypot(p[1]) - outwards * self.thickness_m;
                return polar(radius, tooth.space_angle_rad());
            }
            if i == last {
                return polar(tooth.tip_radius_m, self.tip_angle_rad);
            }
            let (a, b) = (
                curve.point_at(arcs_m[i] - ds),
                curve.point_at(arcs_m[i] + ds),
            );
            let along = [b[0] - a[0], b[1] - a[1]];
            let length = along[0].hypot(along[1]);
            let normal = [-outwards * along[1] / length, outwards * along[0] / length];
            let w = if i > cut_position {
                ((arcs_m[i] - cut) / (tip - cut)).powi(3)
            } else {
                0.0
            };
            let d = [
                (1.0 - w) * normal[0] + w * along_land[0],
                (1.0 - w) * normal[1] + w * along_land[1],
            ];
            let thinner = (self.tip_thickness_m - self.thickness_m) * w.min(1.0);
            let scale = (self.thickness_m + thinner) / d[0].hypot(d[1]);
            [p[0] + scale * d[0], p[1] + scale * d[1]]
        };
        (0..=last).map(inner).collect()
    }
}

/// Inner positions of the layers along the outline as shares of its thickness.
fn layer_shares() -> Vec<f64> {
    let total: f64 = (0..LAYERS).map(|k| LAYER_GROWTH.powi(k as i32)).sum();
    (1..LAYERS)
        .map(|k| (0..k).map(|j| LAYER_GROWTH.powi(j as i32)).sum::<f64>() / total)
        .collect()
}

fn polar(r: f64, angle: f64) -> [f64; 2] {
    [r * angle.cos(), r * angle.sin()]
}

/// Points collected for the mesher.
struct Points(Vec<[f64; 3]>);

impl Points {
    fn add(&mut self, p: [f64; 2]) -> usize {
        self.0.push([p[0], p[1], 1.0]);
        self.0.len() - 1
    }

    /// A line from the point `first` at an angle along a circle to the centre line, with points at shares of it.
    fn arc(
        &mut self,
        first: usize,
        r: f64,
        angle: f64,
        shares: impl ExactSizeIterator<Item = f64>,
    ) -> Vec<usize> {
        let last = shares.len() - 1;
        let point = |(k, share): (usize, f64)| match k {
            0 => first,
            k if k == last => self.add([r, 0.0]),
            _ => self.add(polar(r, angle * (1.0 - share))),
        };
        shares.enumerate().map(point).collect()
    }
}

/// The ends of equal pieces, as shares.
fn equal(pieces: usize) -> impl ExactSizeIterator<Item = f64> {
    (0..pieces + 1).map(move |k| k as f64 / pieces as f64)
}
