//! A gear as a page draws it: the exact outline of a tooth, and the parts of the blank as rings of stated heights.

use gearmesh_geometry::{Blank, GearDefinition, Openings};
use serde::Serialize;

use super::tooth_outline;

const MM: f64 = 1e3;

/// A gear's shape, tooth 0 on +x; millimetres.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GearShape {
    name: String,
    teeth: usize,
    /// Outline of tooth 0 from the middle of one space to the next, at mid-face.
    outline_mm: Vec<[f64; 2]>,
    /// How far sections are turned along the axis.
    twist_rad_per_mm: f64,
    face_width_mm: f64,
    form_diameter_mm: f64,
    tip_diameter_mm: f64,
    base_diameter_mm: f64,
    /// Rings that the body is made of; the outermost one ends at the teeth.
    rings: Vec<Ring>,
    /// What is not drawn as it is.
    simplified: Option<&'static str>,
}

/// A part of the blank.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct Ring {
    inner_mm: f64,
    /// None where it ends at the teeth.
    outer_mm: Option<f64>,
    z_mm: [f64; 2],
    openings: Vec<Opening>,
}

/// An opening through a ring: a hole, or a slot between two radii.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
enum Opening {
    Hole {
        centre_mm: [f64; 2],
        radius_mm: f64,
    },
    Slot {
        radii_mm: [f64; 2],
        angles_rad: [f64; 2],
        corner_mm: f64,
    },
}

impl GearShape {
    /// The shape of a gear.
    pub fn of(gear: &GearDefinition) -> Self {
        let tooth = &gear.profile;
        let width_mm = MM * gear.tooth.face_width_m;
        let outline = tooth_outline(tooth).into_iter();
        let diameter = |roll: f64| 2.0 * MM * tooth.base_radius_m * (1.0 + roll * roll).sqrt();
        let (rings, simplified) = rings(&gear.blank, width_mm);
        Self {
            name: gear.name.clone(),
            teeth: tooth.teeth,
            outline_mm: outline.map(|p| p.map(|x| MM * x)).collect(),
            twist_rad_per_mm: tooth.twist_rad_per_m() / MM,
            face_width_mm: width_mm,
            form_diameter_mm: diameter(tooth.form_roll_rad),
            tip_diameter_mm: 2.0 * MM * tooth.tip_radius_m,
            base_diameter_mm: 2.0 * MM * tooth.base_radius_m,
            rings,
            simplified,
        }
    }
}

fn rings(blank: &Blank, width_mm: f64) -> (Vec<Ring>, Option<&'static str>) {
    let face = [-0.5 * width_mm, 0.5 * width_mm];
    let openings = blank.openings().map(openings).unwrap_or_default();
    let bore_mm = MM * blank.bore_radius_m();
    match blank.web() {
        Some(web) if blank.contour().is_none() => {
            let (hub_mm, rim_mm) = (MM * web.hub_radius_m, MM * web.rim_inner_radius_m);
            let z_mm = [-0.5, 0.5].map(|half| MM * (web.offset_m + half * web.thickness_m));
            let ring = |inner_mm, outer_mm, z_mm, openings| Ring {
                inner_mm,
                outer_mm,
                z_mm,
                openings,
            };
            let rings = vec![
                ring(bore_mm, Some(hub_mm), face, Vec::new()),
                ring(hub_mm, Some(rim_mm), z_mm, openings),
                ring(rim_mm, None, face, Vec::new()),
            ];
            (rings, None)
        }
        _ => {
            let is_disc = matches!(blank, Blank::Solid { .. });
            let simplified = (!is_disc).then_some("the body is drawn as a disc");
            let disc = Ring {
                inner_mm: bore_mm,
                outer_mm: None,
                z_mm: face,
                openings,
            };
            (vec![disc], simplified)
        }
    }
}

fn openings(openings: Openings) -> Vec<Opening> {
    let pitch = std::f64::consts::TAU / openings.count() as f64;
    let at = |k: usize| openings.phase_rad() + pitch * k as f64;
    let one = |k: usize| match openings {
        Openings::Holes(holes) => Opening::Hole {
            centre_mm: [at(k).cos(), at(k).sin()].map(|x| MM * holes.pitch_radius_m * x),
            radius_mm: MM * holes.radius_m,
        },
        Openings::Slots(slots) => Opening::Slot {
            radii_mm: [MM * slots.inner_radius_m, MM * slots.outer_radius_m],
            angles_rad: [-0.5, 0.5].map(|half| at(k) + half * slots.width_rad),
            corner_mm: MM * slots.corner_radius_m,
        },
    };
    (0..openings.count()).map(one).collect()
}
