//! Where the planes between the layers lie below the rim: a contour moves them.
//!
//! Four heights bound the layers: outer faces and web faces. At the rim they are the planes of [`Layers`]; at a radius
//! r below it the web faces are those of the contour, at the hub the outer faces too. In between a plane keeps its
//! share of the distance, so that z(r) is continuous and every layer stays a layer.

use crate::layers::Layers;
use gearmesh_geometry::{Contour, GearDefinition};

/// Heights of the layers by radius.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Heights {
    moved: Option<Moved>,
}

#[derive(Debug, Clone, PartialEq)]
struct Moved {
    contour: Contour,
    /// Outer face, web, web, outer face at the rim \[m\], from −z to +z.
    rim_m: [f64; 4],
}

impl Heights {
    /// The heights of a gear.
    pub fn new(gear: &GearDefinition, layers: &Layers) -> Self {
        let planes = &layers.planes_m;
        let rim_m = [
            planes[0],
            planes[layers.web.start],
            planes[layers.web.end],
            planes[planes.len() - 1],
        ];
        Self {
            moved: gear
                .blank
                .contour()
                .cloned()
                .map(|contour| Moved { contour, rim_m }),
        }
    }

    /// Height \[m\] at a radius of what lies at `plane_m` in the rim.
    pub fn z_m(&self, radius_m: f64, plane_m: f64) -> f64 {
        let Some(Moved { contour, rim_m }) = &self.moved else {
            return plane_m;
        };
        let points = &contour.web;
        let rim = &points[points.len() - 1];
        if radius_m >= rim.radius_m * (1.0 - 1e-12) {
            return plane_m;
        }
        let k = points
            .partition_point(|point| point.radius_m <= radius_m)
            .clamp(1, points.len() - 1);
        let (a, b) = (&points[k - 1], &points[k]);
        let share = ((radius_m - a.radius_m) / (b.radius_m - a.radius_m)).clamp(0.0, 1.0);
        let web: [f64; 2] = std::array::from_fn(|i| a.z_m[i] + share * (b.z_m[i] - a.z_m[i]));
        // Beside the web there is nothing between hub and rim; the hub's faces stand for it.
        let here = [contour.hub_z_m[0], web[0], web[1], contour.hub_z_m[1]];
        let piece = match plane_m {
            z if z < rim_m[1] => 0,
            z if z <= rim_m[2] => 1,
            _ => 2,
        };
        let (from, to) = (rim_m[piece], rim_m[piece + 1]);
        here[piece] + (plane_m - from) / (to - from) * (here[piece + 1] - here[piece])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gearmesh_geometry::ContourPoint;

    #[test]
    fn planes_go_from_the_rim_to_the_hub() {
        let point = |radius_m, z_m| ContourPoint {
            radius_m,
            z_m,
            fillet_radius_m: 0.0,
        };
        let heights = Heights {
            moved: Some(Moved {
                contour: Contour {
                    hub_z_m: [-9.0, 12.0],
                    web: vec![
                        point(1.0, [-3.0, 5.0]),
                        point(2.0, [-1.0, 3.0]),
                        point(4.0, [0.0, 2.0]),
                    ],
                },
                rim_m: [-6.0, 0.0, 2.0, 6.0],
            }),
        };
        for (radius, plane, z) in [
            (5.0, -4.0, -4.0),
            (4.0, 1.0, 1.0),
            (3.0, 0.0, -0.5),
            (3.0, 2.0, 2.5),
            (3.0, 1.0, 1.0),
            (2.0, 0.0, -1.0),
            (1.0, 2.0, 5.0),
            (1.0, 6.0, 12.0),
            (0.5, -6.0, -9.0),
            (0.5, -3.0, -6.0),
            (0.5, 4.0, 8.5),
        ] {
            assert!(
                (heights.z_m(radius, plane) - z).abs() < 1e-14,
                "{radius} {plane}"
            );
        }
        assert_eq!(Heights::default().z_m(0.1, 0.2), 0.2);
    }
}
