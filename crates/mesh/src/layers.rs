//! Planes along the axis: aligned with the web's faces, about `axial_m` apart, closer at those faces.
//!
//! Where the web's face meets rim and hub the body has a sharp inner edge of 270°. Stress there is singular, and equal
//! layers converge with little more than the first power of their thickness (2λ = 1.09, M. L. Williams, J. Appl. Mech.
//! 19 (1952) 526). Layers that grow with the distance from the edge win that back.

use crate::grading::{Pieces, graded};
use gearmesh_geometry::{CutIntoShaft, Element, GearDefinition};
use std::ops::Range;

/// Thickness of the layers at the web's faces, as a share of `axial_m`.
const AT_EDGE: f64 = 0.2;
/// Growth of the thickness with the distance from there.
const GROWTH: f64 = 0.5;

/// Layers of a stub of shaft, at least.
const STUB_LAYERS: usize = 2;

/// The layers of a gear, and of the stubs of the shaft that it is cut into.
#[derive(Debug, Clone, PartialEq)]
pub struct Layers {
    /// Axial positions of the node planes \[m\]: from −b/2 to b/2, and on to the ends of the stubs.
    pub planes_m: Vec<f64>,
    /// Layers that the web occupies; those of the face for a solid blank.
    pub web: Range<usize>,
    /// Layers between the gear's faces.
    pub face: Range<usize>,
    /// Radii of the stubs behind and in front of them \[m\]; 0 where there is none.
    pub stub_radii_m: [f64; 2],
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

    /// Radius of the stub that a layer belongs to \[m\]; none between the gear's faces.
    pub fn stub_radius_m(&self, layer: usize) -> Option<f64> {
        let front = layer >= self.face.end;
        (front || layer < self.face.start).then(|| self.stub_radii_m[usize::from(front)])
    }

    /// A single layer of the given width about mid-face, which the web fills too.
    pub fn single(width_m: f64) -> Self {
        Self::between_faces(vec![-0.5 * width_m, 0.5 * width_m], 0..1)
    }

    fn between_faces(planes_m: Vec<f64>, web: Range<usize>) -> Self {
        Self {
            face: 0..planes_m.len() - 1,
            planes_m,
            web,
            stub_radii_m: [0.0; 2],
        }
    }

    /// The same with even layers of a shaft's stubs beyond the faces, at most `axial_m` thick.
    fn with_stubs(mut self, shaft: &CutIntoShaft, axial_m: f64) -> Self {
        let half = self.planes_m[self.planes_m.len() - 1];
        let [back, front] = shaft.stub_lengths_m().map(|length| {
            let count = match length {
                0.0 => 0,
                _ => ((length / axial_m).ceil() as usize).max(STUB_LAYERS),
            };
            (1..=count)
                .map(|k| half + length * k as f64 / count as f64)
                .collect::<Vec<f64>>()
        });
        let behind = back.len();
        self.planes_m
            .splice(0..0, back.into_iter().rev().map(|z| -z));
        self.planes_m.extend(front);
        for range in [&mut self.web, &mut self.face] {
            *range = range.start + behind..range.end + behind;
        }
        self.stub_radii_m = shaft.end_radii_m;
        self
    }

    /// An even number of equal layers, at most `axial_m` thick.
    fn even(width_m: f64, axial_m: f64) -> Self {
        let pairs = (0.5 * width_m / axial_m * (1.0 - 1e-9)).ceil().max(1.0);
        let count = 2 * pairs as usize;
        let planes = (0..=count).map(|k| width_m * (k as f64 / count as f64 - 0.5));
        Self::between_faces(planes.collect(), 0..count)
    }

    /// Layers of a gear. The web has an even number of them, so that its middle, mid-face of a symmetric gear, is a
    /// node plane; so has a solid gear. One layer in plane strain; equal
    /// ones for the teeth above a body of tetrahedra, which do not know of the web.
    pub fn new(gear: &GearDefinition) -> Self {
        if gear.mesh.plane_strain {
            return Self::single(gear.tooth.face_width_m);
        }
        let half = 0.5 * gear.tooth.face_width_m;
        let axial = gear.mesh.axial_m;
        if gear.mesh.element == Element::Tet10 {
            return Self::even(gear.tooth.face_width_m, axial);
        }
        let mut breaks = vec![-half, half];
        if let Some(web) = gear.blank.web() {
            breaks.extend([
                web.offset_m - 0.5 * web.thickness_m,
                web.offset_m + 0.5 * web.thickness_m,
            ]);
        }
        breaks.extend(
            gear.blank
                .rim()
                .and_then(|rim| rim.held_z_m)
                .into_iter()
                .flatten(),
        );
        breaks.sort_by(f64::total_cmp);
        breaks.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
        let edges = &breaks[1..breaks.len() - 1];
        let thickness = |z: f64| {
            let distances = edges.iter().map(|edge| (z - edge).abs());
            let distance = distances.fold(f64::INFINITY, f64::min);
            // Rounding must not add a layer where whole ones fit.
            (1.0 + 1e-9) * axial.min(AT_EDGE * axial + GROWTH * distance)
        };
        let mut planes = vec![breaks[0]];
        let mut web = 0..0;
        for pair in breaks.windows(2) {
            let (from, to) = (pair[0], pair[1]);
            let middle = 0.5 * (from + to);
            let inside = (gear.blank.web())
                .is_none_or(|w| (middle - w.offset_m).abs() < 0.5 * w.thickness_m);
            let first = planes.len() - 1;
            if inside {
                let half = graded(from, middle, thickness, Pieces::at_least(1));
                planes.extend(&half[1..]);
                planes.extend(half.iter().rev().skip(1).map(|z| from + to - z));
                web = first..planes.len() - 1;
            } else {
                planes.extend(&graded(from, to, thickness, Pieces::at_least(1))[1..]);
            }
        }
        if gear.blank.web().is_none() {
            web = 0..planes.len() - 1;
        }
        let layers = Self::between_faces(planes, web);
        match gear.blank.cut_into_shaft() {
            Some(shaft) => layers.with_stubs(shaft, axial),
            None => layers,
        }
    }
}
