//! A gear's exact flanks as STEP, by gmsh's OCC kernel in a Python process.

use super::ExportRequest;
use crate::answer::Answer;
use crate::failure::{Failure, Result};
use crate::gear_file::{AnyGear, GearFile};
use crate::watch::Watch;
use gearmesh_bevel::{SlotSection, SolidOutline};
use gearmesh_geometry::{Flank, GearDefinition, ProfileCurve};
use gearmesh_model::write_by;
use serde_json::{Value, json};
use std::f64::consts::PI;
use std::path::Path;

const WRITE: &str = include_str!("../step/write.py");

/// Points that a spline goes through, on a fillet and on a flank.
const SPLINE_POINTS: usize = 24;

/// Turn of a section against the next one, where a helical tooth is skinned \[rad\].
const SECTION_TURN_RAD: f64 = 0.06;

/// Places on a flank, along the profile and over the width, at which the file is compared with the exact flank.
const CHECKED: [usize; 2] = [13, 7];

/// Writes the solid of a gear file.
pub(super) fn write(a: &ExportRequest, watch: &Watch<'_>) -> Result<Answer> {
    if a.result.extension().is_some_and(|e| e == "h5") {
        let shown = a.result.display();
        return Err(Failure::input(format!(
            "{shown}: a model or a result; a .step file is made of a gear file (.toml)"
        )));
    }
    let solid = Solid::read(&a.result, watch)?;
    let python = watch.python()?;
    let task = format!("writing {}", a.output.display());
    let input = solid.description.to_string();
    let mut told = Vec::new();
    watch.offline(&solid.name, |progress| {
        progress.stage("making the solid and comparing it with the exact flanks");
        write_by(&a.output, |beside| {
            let beside = beside.display().to_string();
            told = python
                .run(&task, WRITE, &[&beside], input.as_bytes())
                .map_err(Failure::work)?;
            Ok::<(), Failure>(())
        })
    })?;
    let told: Value = serde_json::from_slice(&told).map_err(Failure::work)?;
    let left_out = solid.left_out;
    if !left_out.is_empty() {
        watch.note(format!("not in the solid: {}", left_out.join(", ")));
    }
    let off_nm = 1e6 * told["largest_error_mm"].as_f64().unwrap_or_default();
    let line = format!(
        "{}: one solid of {} faces, in mm; flanks within {off_nm:.3} nm of the exact ones",
        a.output.display(),
        told["faces"]
    );
    Ok(Answer {
        figures: json!({ "file": a.output, "solid": told, "left_out": left_out }),
        lines: vec![line],
    })
}

/// What is written of a gear.
struct Solid {
    name: String,
    description: Value,
    left_out: Vec<&'static str>,
}

impl Solid {
    /// Of a cylindrical gear's file or a bevel gear's.
    fn read(path: &Path, watch: &Watch<'_>) -> Result<Self> {
        match GearFile::read(path, watch)?.gear {
            AnyGear::Bevel(gear) => {
                let outline = gear.solid_outline();
                let outline = outline.map_err(|e| Failure::work(e).about(path))?;
                Ok(Self {
                    description: bevel_description(gear.blank().teeth, &outline),
                    name: gear.name,
                    left_out: Vec::new(),
                })
            }
            AnyGear::Cylindrical(gear) if gear.profile.internal => Err(Failure::input(format!(
                "{}: a ring with internal teeth, of which no solid is made; `gearmesh mesh` writes its mesh",
                path.display()
            ))),
            AnyGear::Cylindrical(gear) => Ok(Self {
                description: description(&gear),
                left_out: left_out(&gear),
                name: gear.name,
            }),
        }
    }
}

/// The blank's meridian, a slot in sections, and points of the exact flanks of tooth 0 to compare with; lengths in mm.
fn bevel_description(teeth: usize, outline: &SolidOutline) -> Value {
    let mm = |points: &Vec<[f64; 3]>| -> Vec<[f64; 3]> {
        points.iter().map(|p| p.map(|x| 1e3 * x)).collect()
    };
    let section = |s: &SlotSection| json!({ "walls": s.walls_m.each_ref().map(mm), "lid": s.lid_m.map(|x| 1e3 * x) });
    let corners = outline.meridian_m.iter();
    json!({
        "teeth": teeth,
        "meridian": corners.map(|p| p.map(|x| 1e3 * x)).collect::<Vec<_>>(),
        "slot": outline.slot.iter().map(section).collect::<Vec<_>>(),
        "flanks": outline.flanks_m.each_ref().map(mm),
    })
}

/// What a cylindrical gear has and the solid has not.
fn left_out(gear: &GearDefinition) -> Vec<&'static str> {
    let solid = gearmesh_geometry::Blank::solid(gear.blank.bore_radius_m());
    let mut left_out = Vec::new();
    if gear.blank.cut_into_shaft().is_some() {
        left_out.push("the shaft that it is cut into");
    } else if gear.blank != solid {
        left_out.push("web, rim and openings (a disc of the face width)");
    }
    if !gear.microgeometry.is_none() {
        left_out.push("microgeometry (ideal flanks)");
    }
    if gear.crack.is_some() {
        left_out.push("the crack");
    }
    left_out
}

/// A cylindrical gear's outline in pieces, and points of the exact flanks of teeth 0 to compare with; lengths in mm.
fn description(gear: &GearDefinition) -> Value {
    let tooth = &gear.profile;
    let curve = ProfileCurve::new(tooth);
    let mm = |p: [f64; 2]| p.map(|x| 1e3 * x);
    // Closer towards the ends, as splines want it.
    let share = |k: usize, count: usize| 0.5 * (1.0 - (PI * k as f64 / (count - 1) as f64).cos());
    let along = |from: f64, to: f64, count: usize| -> Vec<[f64; 2]> {
        let at = |k| curve.point_at(from + (to - from) * share(k, count));
        (0..count).map(|k| mm(at(k))).collect()
    };
    let rolls = |count: usize| {
        let (from, to) = (tooth.form_roll_rad, tooth.flank_end_roll_rad);
        (0..count).map(move |k| from + (to - from) * share(k, count))
    };
    let flank: Vec<[f64; 2]> = rolls(SPLINE_POINTS)
        .map(|roll| mm(tooth.flank_point_m(Flank::Right, roll)))
        .collect();
    let mut pieces = Vec::new();
    if curve.root_arc_end_m() > 1e-9 * tooth.root_radius_m {
        pieces.push(json!({ "kind": "root", "points": along(0.0, curve.root_arc_end_m(), 2) }));
    }
    let mut fillet = along(curve.root_arc_end_m(), curve.flank_start_m(), SPLINE_POINTS);
    // One point, however it was computed.
    if let (Some(last), Some(first)) = (fillet.last_mut(), flank.first()) {
        *last = *first;
    }
    pieces.push(json!({ "kind": "fillet", "points": fillet }));
    pieces.push(json!({ "kind": "flank", "points": flank }));
    let mut corner = tooth.flank_point_m(Flank::Right, tooth.flank_end_roll_rad);
    if tooth.tip_chamfer_m > 0.0 {
        let end = curve.point_at(curve.tip_start_m());
        pieces.push(json!({ "kind": "chamfer", "points": [mm(corner), mm(end)] }));
        corner = end;
    }
    pieces.push(json!({ "kind": "tip", "points": [mm(corner), [1e3 * tooth.tip_radius_m, 0.0]] }));
    let (width_m, twist) = (gear.tooth.face_width_m, tooth.twist_rad_per_m());
    let checked = Flank::ALL.map(|side| {
        let mut points = Vec::new();
        for roll in rolls(CHECKED[0]) {
            for k in 0..CHECKED[1] {
                let z = width_m * (k as f64 / (CHECKED[1] - 1) as f64 - 0.5);
                let [x, y] = tooth.flank_point_m(side, roll);
                let (s, c) = (twist * z).sin_cos();
                points.push([c * x - s * y, s * x + c * y, z].map(|v| 1e3 * v));
            }
        }
        points
    });
    let turn = (twist * width_m).abs();
    json!({
        "teeth": tooth.teeth,
        "width": 1e3 * width_m,
        "bore_radius": 1e3 * gear.blank.bore_radius_m(),
        "twist_per_length": 1e-3 * twist,
        "sections": 3 + (turn / SECTION_TURN_RAD).ceil() as usize,
        "half_outline": pieces,
        "flanks": checked,
    })
}
