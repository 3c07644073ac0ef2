//! Gears of a multibody result where their bodies are, shafts and bearings with them, and the forces on the teeth: for
//! pictures that move.

use std::collections::BTreeMap;
use std::path::Path;

use gearmesh_report::moving::{GearShape, GearSurface, Moment};
use gearmesh_scene::system::{MovingGear, MovingShape};
use gearmesh_scene::system_run::SystemResult;
use serde_json::{Value, json};

use crate::failure::{Failure, Result};
use crate::moving_parts::{PartsInMotion, place, rounded_mm};
use crate::system_moments::{SystemMoments, WantedMoments, surface};
use crate::watch::Watch;

/// Sections of helical teeth over their face; spur ones need their ends only.
const SECTIONS: usize = 6;

/// Surfaces of the gears, the solids beside them, and at most `most` moments of a stretch, evenly chosen: places,
/// turns, angles of balls, and of each mesh and gear the force and where it acts.
///
/// # Errors
/// [`Failure`] for a result without anything that could be drawn, for files that are not as they were in the run, and
/// once `watch` stops it.
pub fn moving_system(
    (file, result): (&Path, &SystemResult),
    [from_s, to_s]: [Option<f64>; 2],
    most: usize,
    watch: &Watch<'_>,
) -> Result<Value> {
    let wanted = WantedMoments {
        result: file,
        from_s,
        to_s,
        scene_folder: None,
    };
    let mut moments = SystemMoments::new(&wanted, result, watch)?;
    if moments.gears().is_empty() && moments.parts().parts.is_empty() {
        return Err(Failure::input(format!(
            "{}: no body of the scene has a shape that could be drawn",
            file.display()
        )));
    }
    let surfaces = surfaces(moments.gears())?;
    let parts = PartsInMotion::new(moments.parts(), result)?;
    let rows = moments.rows();
    let count = rows.len().min(most.max(1));
    let task = watch.listener.begin("moments");
    let mut frames = Vec::with_capacity(count);
    for k in 0..count {
        watch.go_on()?;
        let row = rows[k * (rows.len() - 1) / (count - 1).max(1)];
        let mut shown = frame(&moments.moment(row)?, &surfaces);
        shown["carriers"] = parts.places(row);
        shown["angles_rad"] = parts.angles_rad(row);
        shown["element_loads_N"] = parts.loads_n(row);
        frames.push(shown);
        task.advance(k as f64 + 1.0, count as f64);
    }
    Ok(json!({
        "unit": moments.unit,
        "bodies": drawn(moments.gears(), &surfaces),
        "parts": parts.solids(),
        "elements": parts.elements(),
        "rows": rows.len(),
        "frames": frames,
    }))
}

/// Surfaces of gears, fine enough for a picture that moves.
///
/// # Errors
/// [`Failure`] of a bevel gear's mesh.
pub(crate) fn surfaces(gears: &[MovingGear]) -> Result<Vec<GearSurface>> {
    let of_gear = |gear: &MovingGear| match &gear.shape {
        MovingShape::Cylindrical(of) if of.tooth.helix_angle_rad == 0.0 => {
            Ok(GearSurface::new(of, &[]))
        }
        MovingShape::Cylindrical(of) => {
            let height = |k: usize| (k as f64 / SECTIONS as f64 - 0.5) * of.tooth.face_width_m;
            let heights: Vec<f64> = (0..=SECTIONS).map(height).collect();
            Ok(GearSurface::new(of, &heights))
        }
        MovingShape::Bevel(_) => surface(gear),
    };
    gears.iter().map(of_gear).collect()
}

/// Names and shapes of gears: cylindrical ones with the parts of their blanks, others by their surfaces.
pub(crate) fn drawn(gears: &[MovingGear], surfaces: &[GearSurface]) -> Value {
    let of_gear = |(gear, surface): (&MovingGear, &GearSurface)| {
        if let MovingShape::Cylindrical(definition) = &gear.shape {
            return json!({"name": gear.body, "shape": GearShape::of(definition)});
        }
        let points = surface.points_m.iter().flatten().map(|x| rounded_mm(*x));
        json!({
            "name": gear.body,
            "points_mm": points.collect::<Vec<_>>(),
            "quads": surface.quads.iter().flatten().collect::<Vec<_>>(),
        })
    };
    gears.iter().zip(surfaces).map(of_gear).collect()
}

/// The forces of a mesh on a gear.
#[derive(Debug, Default)]
struct Sum {
    weight: f64,
    force_n: [f64; 3],
    /// In the gear's axes, times the weight.
    point_m: [f64; 3],
}

/// A moment: of each gear its rotation (by rows) and origin, and of each mesh and gear the sum of the forces on the
/// gear with its point of attack, the mean of the slices' places by their forces.
fn frame(moment: &Moment, surfaces: &[GearSurface]) -> Value {
    let places = moment.placements.iter();
    let places = places.map(|placed| place(&placed.rotation, &placed.origin_m));
    // A gear in several meshes has a force in each.
    let mut sums: BTreeMap<(usize, usize), Sum> = BTreeMap::new();
    for load in &moment.loads {
        let shape = &surfaces[load.gear];
        let tooth = (load.tooth, load.side);
        let quad = shape.quads[shape.flank_quad(tooth, load.roll_rad, load.height_m)];
        let amount = load.components_n[0];
        let sum = sums.entry((load.gear, load.mesh)).or_default();
        sum.weight += amount;
        for k in 0..3 {
            sum.force_n[k] += load.force_n[k];
            let own = quad.map(|corner| shape.points_m[corner as usize][k]);
            sum.point_m[k] += amount * own.iter().sum::<f64>() / 4.0;
        }
    }
    let loaded = sums.into_iter().filter(|(_, sum)| sum.weight > 0.0);
    let forces = loaded.map(|((gear, _), sum)| {
        let placed = moment.placements[gear];
        let own = sum.point_m.map(|x| x / sum.weight);
        let point = (0..3).map(|k| {
            let turned: f64 = (0..3).map(|j| placed.rotation[k][j] * own[j]).sum();
            rounded_mm(turned + placed.origin_m[k])
        });
        json!({"force_N": sum.force_n, "point_mm": point.collect::<Vec<_>>()})
    });
    json!({
        "at": moment.at,
        "places": places.collect::<Vec<_>>(),
        "forces": forces.collect::<Vec<_>>(),
    })
}
