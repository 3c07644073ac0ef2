//! One side of the teeth of a bevel pair in slices: contacts of every section of gear 1's flank in the pair as
//! designed, and the line that they make.

use std::cell::Cell;
use std::f64::consts::TAU;

use nalgebra::{Matrix3, Vector3};

use super::contact_limits::nearest_within;
use super::hertz_stiffness::curvature;
use super::line_geometry::{LineGeometry, Sample};
use super::nearest_points::Nearest;
use super::nominal_contacts::NominalContacts;
use super::section_points::{edge_of, line_tangent, sections};
use super::tooth_side::{REACH, Side, nominal_rotation, placed};

/// A side in slices.
#[derive(Debug, Clone)]
pub(super) struct SlicedSide {
    /// Contacts of each slice's middle section.
    pub nominal: Vec<NominalContacts>,
    /// The line over gear 1's flank.
    pub line: LineGeometry,
}

impl SlicedSide {
    /// The sections of a side; none where the line of contact is not found.
    pub fn new(
        side: &Side,
        teeth: [usize; 2],
        shaft_angle_rad: f64,
        slices: usize,
    ) -> Option<Self> {
        let [pitch_1, pitch_2] = teeth.map(|z| TAU / z as f64);
        let count = Cell::new(0);
        let poses = NominalContacts::angles(pitch_1, REACH);
        let mut samples = Vec::new();
        let mut found: Vec<Vec<(Matrix3<f64>, Option<Nearest>)>> = Vec::with_capacity(poses.len());
        for (number, angle_1) in poses.into_iter().enumerate() {
            let angles = [angle_1, -angle_1 * pitch_2 / pitch_1];
            let turns = [0, 1].map(|m: usize| angles[m] - side.azimuths_rad[m]);
            let rotation = nominal_rotation(shaft_angle_rad, turns);
            let stands = (rotation, Vector3::zeros());
            let bodies = placed(&side.patches, [0.0; 2], stands, &count);
            let whole = side.nominal.entry(number);
            let whole = whole.and_then(|(limits, at)| nearest_within(&bodies, limits, at));
            let here = whole.map_or(vec![None; slices], |whole| {
                sections(&bodies, whole.at, edge_of(&whole), slices)
            });
            let inside = here
                .iter()
                .flatten()
                .filter(|point| edge_of(point).is_none());
            samples.extend(inside.filter_map(sample));
            found.push(here.into_iter().map(|point| (rotation, point)).collect());
        }
        let nominal = (0..slices).map(|slice| {
            let of_slice = found.iter().map(|here| here[slice]);
            NominalContacts::new(pitch_1, REACH, of_slice)
        });
        let nominal = nominal.collect();
        let line = LineGeometry::fitted(&samples)?;
        Some(Self { nominal, line })
    }
}

/// What the line is at a contact inside both flanks.
fn sample(found: &Nearest) -> Option<Sample> {
    let tangent = line_tangent(found)?;
    let length_m = tangent.norm();
    let across = found.normal.cross(&tangent).normalize();
    let curvature_per_m = curvature(found).along_tangent(&across);
    (curvature_per_m > 0.0).then(|| Sample {
        at: found.at[0],
        radius_m: 1.0 / curvature_per_m,
        length_m,
    })
}
