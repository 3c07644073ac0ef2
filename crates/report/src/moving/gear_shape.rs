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
    /// A ring: its teeth point inwards.
    internal: bool,
    /// Outline of tooth 0 from the middle of one space to the next, at mid-face.
    outline_mm: Vec<[f64; 2]>,
    /// How far sections are turned along the axis.
    twist_rad_per_mm: f64,
    face_width_mm: f64,
    form_diameter_mm: f64,
    tip_diameter_mm: f64,
    base_diameter_mm: f64,
    /// Rings that the body is made of; one of them ends at the teeth.
    rings: Vec<Ring>,
}

/// A part of the blank.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct Ring {
    /// None where it ends at teeth inside.
    inner_mm: Option<f64>,
    /// None where it ends at teeth outside.
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
        Self {
            name: gear.name.clone(),
            teeth: tooth.teeth,
            internal: tooth.internal,
            outline_mm: outline.map(|p| p.map(|x| MM * x)).collect(),
            twist_rad_per_mm: tooth.twist_rad_per_m() / MM,
            face_width_mm: width_mm,
            form_diameter_mm: diameter(tooth.form_roll_rad),
            tip_diameter_mm: 2.0 * MM * tooth.tip_radius_m,
            base_diameter_mm: 2.0 * MM * tooth.base_radius_m,
            rings: rings(&gear.blank, width_mm),
        }
    }
}

fn rings(blank: &Blank, width_mm: f64) -> Vec<Ring> {
    let face = [-0.5 * width_mm, 0.5 * width_mm];
    let ring = |inner_mm, outer_mm, z_mm, openings| Ring {
        inner_mm,
        outer_mm,
        z_mm,
        openings,
    };
    if let Some(rim) = blank.rim() {
        return vec![ring(None, Some(MM * rim.outer_radius_m), face, Vec::new())];
    }
    let openings = blank.openings().map(openings).unwrap_or_default();
    let bore = Some(MM * blank.bore_radius_m());
    match blank.web() {
        Some(web) if blank.contour().is_none() => {
            let [hub, rim] = [web.hub_radius_m, web.rim_inner_radius_m].map(|r| Some(MM * r));
            let z_mm = [-0.5, 0.5].map(|half| MM * (web.offset_m + half * web.thickness_m));
            vec![
                ring(bore, hub, face, Vec::new()),
                ring(hub, rim, z_mm, openings),
                ring(rim, None, face, Vec::new()),
            ]
        }
        // A contour, a shaft and a mesh of another program are drawn as a disc.
        _ => vec![ring(bore, None, face, openings)],
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

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use gearmesh_geometry::{Flank, GearPair, Misalignment};
    use std::f64::consts::TAU;

    fn shipped(name: &str) -> GearDefinition {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fe_models");
        GearDefinition::read(&folder.join(name)).unwrap()
    }

    /// All points of a gear's outline in the world, the gear turned about its axis at x.
    fn placed(shape: &GearShape, turn_rad: f64, x_mm: f64) -> Vec<[f64; 2]> {
        let teeth = 0..shape.teeth;
        let all = teeth.flat_map(|tooth| shape.outline_mm.iter().map(move |p| (tooth, p)));
        all.map(|(tooth, [x, y])| {
            let (s, c) = (turn_rad + TAU * tooth as f64 / shape.teeth as f64).sin_cos();
            [c * x - s * y + x_mm, s * x + c * y]
        })
        .collect()
    }

    /// How far a point lies outside of a polygon \[mm\], negative inside.
    fn outside_mm(polygon: &[[f64; 2]], [x, y]: [f64; 2]) -> f64 {
        let (mut least, mut is_inside) = (f64::INFINITY, false);
        for (k, &[ax, ay]) in polygon.iter().enumerate() {
            let [bx, by] = polygon[(k + 1) % polygon.len()];
            let along = ((x - ax) * (bx - ax) + (y - ay) * (by - ay))
                / ((bx - ax).powi(2) + (by - ay).powi(2));
            let along = along.clamp(0.0, 1.0);
            let (dx, dy) = (ax + along * (bx - ax) - x, ay + along * (by - ay) - y);
            least = least.min(dx.hypot(dy));
            if (ay > y) != (by > y) && x < ax + (y - ay) / (by - ay) * (bx - ax) {
                is_inside = !is_inside;
            }
        }
        if is_inside { -least } else { least }
    }

    /// A planet and the ring around it, on either flank and at some positions: the planet's teeth stand in the spaces
    /// of the ring, touch its flanks, and none runs into it. The ring's body lies outside its teeth.
    #[test]
    fn a_planet_as_it_is_drawn_meshes_with_its_ring() {
        let gears = ["planet_24.toml", "ring_75.toml"].map(shipped);
        let [planet, ring] = gears.each_ref().map(GearShape::of);
        assert!(ring.internal && !planet.internal);
        let body = &ring.rings[..];
        assert!(body.len() == 1 && body[0].inner_mm.is_none() && body[0].outer_mm == Some(85.0));
        assert_eq!(planet.rings[0].inner_mm, Some(18.5));
        let [first, second] = gears.map(|gear| gear.profile);
        let pair = GearPair::new(first, second, 51e-3, Misalignment::default()).unwrap();
        for side in Flank::ALL {
            let pair = pair.clone().on_flanks(side);
            for turn in [0.0, 0.1, 0.2, 1.0] {
                let turns = [turn, turn * 24.0 / 75.0];
                let at = pair.tooth_middles_rad((51e-3, turns));
                let space = placed(&ring, at[1], 51.0);
                let teeth = placed(&planet, at[0], 0.0);
                let outside = teeth.iter().map(|point| outside_mm(&space, *point));
                let most = outside.fold(f64::NEG_INFINITY, f64::max);
                // They touch, but for what chords leave out.
                assert!(most.abs() < 0.01, "{side:?} {turn}: {most} mm");
            }
        }
    }
}
