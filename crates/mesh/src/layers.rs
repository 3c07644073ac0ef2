//! Planes along the axis: aligned with the web's faces, about `axial_m` apart.

use gearmesh_geometry::GearDefinition;

/// The layers of a gear.
#[derive(Debug, Clone, PartialEq)]
pub struct Layers {
    /// Axial positions of the node planes \[m\], from −b/2 to b/2.
    pub planes_m: Vec<f64>,
    /// Layers that the web occupies; all layers for a solid blank.
    pub web: std::ops::Range<usize>,
}

impl Layers {
    /// Number of element layers.
    pub fn count(&self) -> usize {
        self.planes_m.len() - 1
    }

    /// The planes and, between each two of them, the middle of the layer.
    pub fn planes_and_middles_m(&self) -> Vec<f64> {
        let pairs = self.planes_m.windows(2);
        let mut levels: Vec<f64> = pairs.flat_map(|z| [z[0], 0.5 * (z[0] + z[1])]).collect();
        levels.extend(self.planes_m.last());
        levels
    }

    /// A single layer of the given width about mid-face, which the web fills too.
    pub fn single(width_m: f64) -> Self {
        Self {
            planes_m: vec![-0.5 * width_m, 0.5 * width_m],
            web: 0..1,
        }
    }

    /// Layers of a gear. The web has at least two, an even number over the whole width of a symmetric gear, so that
    /// mid-face is a node plane. One layer in plane strain.
    pub fn new(gear: &GearDefinition) -> Self {
        if gear.mesh.plane_strain {
            return Self::single(gear.tooth.face_width_m);
        }
        let half = 0.5 * gear.tooth.face_width_m;
        let axial = gear.mesh.axial_m;
        let mut breaks = vec![-half, half];
        if let Some(web) = gear.blank.web {
            breaks.extend([
                web.offset_m - 0.5 * web.thickness_m,
                web.offset_m + 0.5 * web.thickness_m,
            ]);
        }
        breaks.sort_by(f64::total_cmp);
        breaks.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
        let mut planes = vec![breaks[0]];
        let mut web = 0..0;
        for pair in breaks.windows(2) {
            let (from, to) = (pair[0], pair[1]);
            let inside = gear
                .blank
                .web
                .is_none_or(|w| (0.5 * (from + to) - w.offset_m).abs() < 0.5 * w.thickness_m);
            let wanted = ((to - from) / axial - 1e-9).ceil().max(1.0) as usize;
            let n = if inside {
                wanted.max(2).next_multiple_of(2)
            } else {
                wanted
            };
            if inside {
                web = planes.len() - 1..planes.len() - 1 + n;
            }
            planes.extend((1..=n).map(|k| from + (to - from) * k as f64 / n as f64));
        }
        Self {
            planes_m: planes,
            web,
        }
    }
}
