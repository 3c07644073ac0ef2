//! Gears of a multibody result where their bodies are, and the forces on their teeth: for pictures that move.

use std::path::Path;

use gearmesh_report::moving::{GearSurface, Moment};
use gearmesh_scene::system::MovingShape;
use gearmesh_scene::system_run::SystemResult;
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::system_moments::{SystemMoments, WantedMoments, surface};
use crate::watch::Watch;

/// Sections of helical teeth over their face; spur ones need their ends only.
const SECTIONS: usize = 6;

/// Micrometres: finer than a picture.
fn rounded_mm(x_m: f64) -> f64 {
    (1e6 * x_m).round() / 1e3
}

/// Surfaces of the gears and at most `most` moments of a stretch, evenly chosen: places, turns, and of each mesh and
/// gear the force and where it acts.
///
/// # Errors
/// [`Failure`] for a result without gears that move, for files that are not as they were in the run, and once `watch`
/// stops it.
pub fn moving_system(
    (file, result): (&Path, &SystemResult),
    [from_s, to_s]: [Option<f64>; 2],
    most: usize,
    watch: &Watch<'_>,
) -> Result<Value, Failure> {
    let wanted = WantedMoments {
        result: file,
        from_s,
        to_s,
        scene_folder: None,
    };
    let mut moments = SystemMoments::new(&wanted, result, watch)?;
    let drawn = moments.gears().iter().map(|gear| match &gear.shape {
        MovingShape::Cylindrical(of) if of.tooth.helix_angle_rad == 0.0 => {
            Ok(GearSurface::new(of, &[]))
        }
        MovingShape::Cylindrical(of) => {
            let height = |k: usize| (k as f64 / SECTIONS as f64 - 0.5) * of.tooth.face_width_m;
            let heights: Vec<f64> = (0..=SECTIONS).map(height).collect();
            Ok(GearSurface::new(of, &heights))
        }
        MovingShape::Bevel(_) => surface(gear),
    });
    let surfaces = drawn.collect::<Result<Vec<GearSurface>, Failure>>()?;
    let rows = moments.rows();
    let count = rows.len().min(most.max(1));
    let task = watch.listener.begin("moments");
    let mut frames = Vec::with_capacity(count);
    for k in 0..count {
        watch.go_on()?;
        let row = rows[k * (rows.len() - 1) / (count - 1).max(1)];
        frames.push(frame(&moments.moment(row)?, &surfaces));
        task.advance(k as f64 + 1.0, count as f64);
    }
    let bodies = moments.gears().iter().zip(&surfaces).map(|(gear, shape)| {
        let points = shape.points_m.iter().flatten().map(|x| rounded_mm(*x));
        json!({
            "name": gear.body,
            "points_mm": points.collect::<Vec<_>>(),
            "quads": shape.quads.iter().flatten().collect::<Vec<_>>(),
        })
    });
    Ok(json!({
        "unit": moments.unit,
        "bodies": bodies.collect::<Vec<_>>(),
        "rows": rows.len(),
        "frames": frames,
    }))
}

/// A moment: of each gear its rotation (by rows) and origin, and the sum of the forces on it with its point of attack,
/// the mean of the slices' places by their forces.
fn frame(moment: &Moment, surfaces: &[GearSurface]) -> Value {
    let places = moment.placements.iter().map(|placed| {
        let rotation: Vec<f64> = placed.rotation.iter().flatten().copied().collect();
        json!({"rotation": rotation, "origin_mm": placed.origin_m.map(rounded_mm)})
    });
    let forces = (0..surfaces.len()).map(|gear| {
        let (mut force_n, mut point_m, mut weight) = ([0.0; 3], [0.0; 3], 0.0);
        for load in moment.loads.iter().filter(|load| load.gear == gear) {
            let shape = &surfaces[gear];
            let tooth = (load.tooth, load.side);
            let quad = shape.quads[shape.flank_quad(tooth, load.roll_rad, load.height_m)];
            let amount = load.components_n[0];
            weight += amount;
            for k in 0..3 {
                force_n[k] += load.force_n[k];
                let own = quad.map(|corner| shape.points_m[corner as usize][k]);
                point_m[k] += amount * own.iter().sum::<f64>() / 4.0;
            }
        }
        let placed = moment.placements[gear];
        let own = point_m.map(|x| x / weight);
        let point = (0..3).map(|k| {
            let turned: f64 = (0..3).map(|j| placed.rotation[k][j] * own[j]).sum();
            rounded_mm(turned + placed.origin_m[k])
        });
        (weight > 0.0).then(|| json!({"force_N": force_n, "point_mm": point.collect::<Vec<_>>()}))
    });
    json!({
        "at": moment.at,
        "places": places.collect::<Vec<_>>(),
        "forces": forces.collect::<Vec<_>>(),
    })
}
