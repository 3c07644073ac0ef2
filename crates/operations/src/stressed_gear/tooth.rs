//! One tooth of a stressed gear: the faces of its root, how it stands, gauges put on it, places in words.

use super::{StressedBody, StressedGear};
use crate::failure::{Failure, Result};
use gearmesh_geometry::{Flank, ProfileCurve};
use gearmesh_mesh::OutlineFace;
use gearmesh_reduction::bevel::gauge::bevel_gauge_row;
use gearmesh_reduction::bevel::loads::shares_of;
use gearmesh_reduction::gauge_row::gauge_row;
use gearmesh_reduction::skin::SkinFace;
use std::collections::HashSet;

/// Rounding of shares and lengths \[m\].
const SAME: f64 = 1e-6;

/// How a tooth stands: unit vectors in the gear's frame, and points at its tip \[m\].
#[derive(Debug, Clone, Copy)]
pub struct ToothFrame {
    /// Towards the tip.
    pub up: [f64; 3],
    /// Along the tooth: of a bevel gear towards the heel, of others to larger z.
    pub along: [f64; 3],
    /// From the other side to the side asked for.
    pub side: [f64; 3],
    /// The tip's two ends: of a bevel gear toe and heel, of others −z and +z.
    pub ends_m: [[f64; 3]; 2],
}

/// A face below a flank.
#[derive(Debug, Clone)]
pub struct RootFace {
    /// The face.
    pub face: SkinFace,
    /// Its middle \[m\].
    pub middle_m: [f64; 3],
}

/// What a gauge reads.
#[derive(Debug, Clone)]
pub struct GaugeReading {
    /// Name.
    pub name: String,
    /// Side of the tooth.
    pub side: Flank,
    /// Strain along the profile.
    pub strain: f64,
    /// Its middle \[m\].
    pub at_m: [f64; 3],
}

fn less(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k: usize| a[k] - b[k])
}

fn middle<'a>(points: impl IntoIterator<Item = &'a [f64; 3]>) -> [f64; 3] {
    let (mut sum, mut count) = ([0.0; 3], 0.0);
    for point in points {
        sum = [0, 1, 2].map(|k: usize| sum[k] + point[k]);
        count += 1.0;
    }
    sum.map(|x| x / f64::max(count, 1.0))
}

/// The part of a vector normal to a unit vector, at unit length.
fn unit_normal_to(a: [f64; 3], unit: [f64; 3]) -> [f64; 3] {
    let along: f64 = a.iter().zip(unit).map(|(x, y)| x * y).sum();
    let rest = [0, 1, 2].map(|k: usize| a[k] - along * unit[k]);
    let length = rest.iter().map(|x| x * x).sum::<f64>().sqrt();
    rest.map(|x| x / length.max(f64::MIN_POSITIVE))
}

impl StressedGear {
    /// Number of teeth.
    pub fn teeth(&self) -> usize {
        match &self.body {
            StressedBody::Cylindrical(_, body) => body.mesh.teeth(),
            StressedBody::Bevel(_, body) => body.mesh.teeth(),
        }
    }

    /// Elements of a tooth with the ring below it.
    pub fn cell_elements(&self, tooth: usize) -> Vec<u32> {
        match &self.body {
            StressedBody::Cylindrical(_, body) => body.mesh.cell_elements(tooth),
            StressedBody::Bevel(_, body) => body.mesh.cell_elements(tooth),
        }
    }

    /// Those of a tooth's cell up to the middle of the face, from toe or −z.
    pub fn half_cell_elements(&self, tooth: usize) -> Vec<u32> {
        let mut elements = self.cell_elements(tooth);
        match &self.body {
            StressedBody::Bevel(_, body) => {
                // Elements follow one another from toe to heel.
                let layers = (body.mesh.along.len() - 1) / body.mesh.order();
                elements.retain(|e| (*e as usize % layers) < layers.div_ceil(2));
            }
            StressedBody::Cylindrical(..) => {
                let model = self.model();
                let height = |element: u32| {
                    let nodes = model.element_nodes(element as usize);
                    middle(nodes.iter().map(|n| &model.nodes()[*n as usize]))[2]
                };
                // The plane between two layers next to the middle of the face.
                elements.retain(|e| height(*e) < SAME);
            }
        }
        elements
    }

    /// Faces of a tooth's side from the middle of the space on; places rise up the profile and along the tooth.
    fn outline(&self, tooth: usize, side: Flank) -> Vec<OutlineFace> {
        match &self.body {
            StressedBody::Cylindrical(gear, body) => {
                let curve = ProfileCurve::new(&gear.profile);
                body.mesh
                    .outline_faces(tooth, side, [0.0, curve.flank_end_m()])
            }
            StressedBody::Bevel(_, body) => body
                .mesh
                .outline_faces(tooth, side, |k, section| [k as f64, section as f64]),
        }
    }

    /// Faces below the flank on one side of a tooth: fillet and bottom of the space, as far as they belong to it.
    pub fn root(&self, tooth: usize, side: Flank) -> Result<Vec<RootFace>> {
        let faces = self.outline(tooth, side);
        let below: Vec<OutlineFace> = match &self.body {
            StressedBody::Cylindrical(gear, _) => {
                let end = ProfileCurve::new(&gear.profile).flank_start_m();
                let is_below = |face: &OutlineFace| face.range_m(0)[1] < end + SAME;
                faces.into_iter().filter(is_below).collect()
            }
            StressedBody::Bevel(gear, body) => {
                let patch = gear.patch(side).map_err(Failure::work)?;
                let lines = &body.mesh.outline_m[side as usize];
                let is_below = |face: &OutlineFace| {
                    face.corners_m().iter().all(|[k, section]| {
                        let [cone, height] = lines[*section as usize][*k as usize];
                        shares_of(&patch, cone, height)[0] < SAME
                    })
                };
                faces.into_iter().filter(is_below).collect()
            }
        };
        let nodes = self.model().nodes();
        let root = below.into_iter().map(|face| {
            let corners = face.nodes[..face.shape.corner_count()].to_vec();
            RootFace {
                middle_m: middle(corners.iter().map(|n| &nodes[*n as usize])),
                face: SkinFace {
                    corners,
                    element: face.element,
                },
            }
        });
        Ok(root.collect())
    }

    /// How a tooth stands, seen from one of its sides.
    pub fn frame(&self, tooth: usize, side: Flank) -> ToothFrame {
        let nodes = self.model().nodes();
        let outlines = Flank::ALL.map(|side| self.outline(tooth, side));
        // Middles of the nodes with the least and the largest place on each side.
        let ends = |outline: &[OutlineFace], axis: usize, only: &dyn Fn(&[f64; 2]) -> bool| {
            let all = || {
                let each = outline
                    .iter()
                    .flat_map(|face| face.nodes.iter().zip(&face.places_m));
                each.filter(|(_, place)| only(place))
            };
            let [low, high] = all().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], (_, p)| {
                [a.min(p[axis]), b.max(p[axis])]
            });
            [low, high].map(|end| {
                let at_end = all().filter(|(_, p)| (p[axis] - end).abs() < SAME);
                middle(at_end.map(|(n, _)| &nodes[*n as usize]))
            })
        };
        let anywhere = |_: &[f64; 2]| true;
        let both = |axis: usize| {
            let [a, b] = [0, 1].map(|k: usize| ends(&outlines[k], axis, &anywhere));
            [0, 1].map(|k: usize| middle([&a[k], &b[k]]))
        };
        let [low, high] = both(0);
        let [start, end] = both(1);
        let length = |a: [f64; 3]| a.iter().map(|x| x * x).sum::<f64>().sqrt();
        let along = less(end, start);
        let along = along.map(|x| x / length(along));
        let up = unit_normal_to(less(high, low), along);
        let of_side = |side: Flank| {
            let faces = outlines[side as usize].iter().flat_map(|face| &face.nodes);
            middle(faces.map(|n| &nodes[*n as usize]))
        };
        let across = less(of_side(side), of_side(side.opposite()));
        let across = unit_normal_to(unit_normal_to(across, along), up);
        let tip = |outline: &Vec<OutlineFace>| {
            let most = outline.iter().map(|f| f.range_m(0)[1]);
            let most = most.fold(f64::NEG_INFINITY, f64::max);
            ends(outline, 1, &|place| (place[0] - most).abs() < SAME)
        };
        let [a, b] = [tip(&outlines[0]), tip(&outlines[1])];
        ToothFrame {
            up,
            along,
            side: across,
            ends_m: [0, 1].map(|k: usize| middle([&a[k], &b[k]])),
        }
    }

    /// What all gauges of the gear would read on this tooth.
    pub fn gauges_on(&self, tooth: usize, displacement_m: &[f64]) -> Result<Vec<GaugeReading>> {
        let mut rows = Vec::new();
        match &self.body {
            StressedBody::Cylindrical(gear, body) => {
                for gauge in &gear.gauges {
                    let row = gauge_row(gear, &body.mesh, &body.model, gauge, tooth)?;
                    rows.push((gauge.name.clone(), gauge.side, row));
                }
            }
            StressedBody::Bevel(gear, body) => {
                for gauge in &gear.gauges {
                    let row = bevel_gauge_row(gear, &body.mesh, &body.model, gauge, tooth)?;
                    rows.push((gauge.name.clone(), gauge.side, row));
                }
            }
        }
        let nodes = self.model().nodes();
        let readings = rows.into_iter().map(|(name, side, row)| {
            let outline = self.outline(tooth, side);
            let surface: HashSet<u32> = outline.iter().flat_map(|f| f.nodes.clone()).collect();
            let (mut sum, mut weights) = ([0.0; 3], 0.0);
            for (dof, weight) in &row {
                if surface.contains(&((dof / 3) as u32)) {
                    let at = nodes[dof / 3];
                    sum = [0, 1, 2].map(|k: usize| sum[k] + weight.abs() * at[k]);
                    weights += weight.abs();
                }
            }
            GaugeReading {
                name,
                side,
                strain: row.iter().map(|(dof, w)| w * displacement_m[*dof]).sum(),
                at_m: sum.map(|x| x / f64::max(weights, f64::MIN_POSITIVE)),
            }
        });
        Ok(readings.collect())
    }

    /// Where a point is along the face, 0 at toe or −z, 1 at heel or +z.
    pub fn share_along_face(&self, [x, y, z]: [f64; 3]) -> f64 {
        match &self.body {
            StressedBody::Cylindrical(..) => z / self.face_width_m + 0.5,
            StressedBody::Bevel(gear, _) => {
                let blank = gear.blank();
                (blank.cone_place(z, x.hypot(y))[0] - blank.inner_cone_m()) / blank.face_width_m
            }
        }
    }

    /// Where a point of a tooth is, in words.
    pub fn place_in_words(&self, point_m: [f64; 3]) -> String {
        let [x, y, z] = point_m;
        let radius = x.hypot(y);
        match &self.body {
            StressedBody::Cylindrical(..) => format!(
                "diameter {:.2} mm, {:.2} mm from mid-face",
                2e3 * radius,
                1e3 * z
            ),
            StressedBody::Bevel(gear, _) => {
                let [_, height] = gear.blank().cone_place(z, radius);
                format!(
                    "{:.0} % of the face from the toe, {:.2} mm {} the pitch cone",
                    100.0 * self.share_along_face(point_m),
                    1e3 * height.abs(),
                    if height < 0.0 { "below" } else { "above" }
                )
            }
        }
    }

    /// What the ends of a tooth are called.
    pub fn end_names(&self) -> [&'static str; 2] {
        match &self.body {
            StressedBody::Cylindrical(..) => ["−z", "+z"],
            StressedBody::Bevel(..) => ["toe", "heel"],
        }
    }
}
