//! Stress in the bodies of a bevel pair under its loads: pictures for the page, whole fields for other programs.

use crate::cross_section::{FieldCase, largest_torque, nearest_angle};
use crate::failure::{Failure, Result};
use crate::mesh_file::{LengthUnit, export_bevel_mesh};
use crate::result_stress::{StressSection, add_worst};
use crate::stressed_gear::{Pressed, StressedBody, StressedGear};
use crate::tooth_stress;
use crate::watch::Watch;
use gearmesh_bevel::BevelGear;
use gearmesh_geometry::Flank;
use gearmesh_mesh::BevelMesh;
use gearmesh_model::{ReducedGear, read_reduced_gear};
use gearmesh_recovery::PlacedForce;
use gearmesh_reduction::GearBody;
use gearmesh_reduction::field::Field;
use gearmesh_reduction::skin::{SkinFace, von_mises_on_faces};
use gearmesh_report::page::{FieldPicture, FieldValues, Section, Text};
use gearmesh_scene::SceneResult;
use gearmesh_scene::pair::bevel_result::Pressing;
use std::path::Path;

const MEMBERS: [&str; 2] = ["pinion", "gear"];

/// The page's section of the stress in both members, with its figures: each at the position of its largest root stress
/// under the largest torque, or at the one nearest to an angle of the driver.
///
/// # Errors
/// [`Failure`] where the pair has no reduced models, or a field cannot be made.
pub fn section(
    result: &SceneResult,
    angle_deg: Option<f64>,
    watch: &Watch<'_>,
) -> Result<StressSection> {
    demand_bodies(result, "--stress")?;
    let models = models_of(result)?;
    let words = format!(
        "{} Each member at the position of its largest root stress under the largest torque. Last, the body along its axis, the largest value along the teeth, and the \
         tooth's side unrolled, from the middle of the space over root and fillet to the tip.",
        tooth_stress::WORDS
    );
    let section = Section::new("Stress in the bodies").push(Text::paragraph(words));
    let mut made = (section, Vec::new());
    for (member, model) in models.iter().enumerate() {
        let body = StressedGear::of_bevel(model, &result.source.model_files[member], watch)?;
        made = pictures(made, (angle_deg, result), (member, &body), watch)?;
    }
    Ok(made)
}

/// Writes the displacement and stress of a member.
///
/// # Errors
/// As [`section()`]; [`Failure`] for a file that cannot be written.
pub fn write_field(
    result: &SceneResult,
    case: FieldCase,
    output: &Path,
    watch: &Watch<'_>,
) -> Result<()> {
    demand_bodies(result, "--field-gear")?;
    let (models, member) = (models_of(result)?, case.gear - 1);
    let stressed =
        StressedGear::of_bevel(&models[member], &result.source.model_files[member], watch)?;
    let field = stressed.field(&pressed(result, case))?;
    let (gear, body) = bevel(&stressed)?;
    let file = (output, LengthUnit::M);
    export_bevel_mesh(gear, &body.mesh, (&field).into(), file, watch)?;
    watch.note(format!(
        "{}: field of the {}, {}",
        output.display(),
        MEMBERS[member],
        case.words(result)
    ));
    Ok(())
}

/// Refuses what an option or command wants of gears without bodies.
///
/// # Errors
/// [`Failure`] for rigid gears.
pub fn demand_bodies(result: &SceneResult, option: &str) -> Result<()> {
    match result.source.model_files[0].is_empty() {
        false => Ok(()),
        true => Err(Failure::input(format!(
            "{option} needs the bodies of both members, these are rigid: name their reduced models, `models` of [load] in the pair file"
        ))),
    }
}

/// The reduced members of a result.
///
/// # Errors
/// [`Failure`] where one cannot be read, or has been made again.
pub fn models_of(result: &SceneResult) -> Result<[ReducedGear; 2]> {
    let read = |i: usize| {
        let file = &result.source.model_files[i];
        let model = read_reduced_gear(Path::new(file)).map_err(Failure::input)?;
        if model.input != result.source.gears[i] {
            return Err(Failure::input(format!(
                "{file} has been made again from another gear file since the result was computed; run the pair again"
            )));
        }
        Ok(model)
    };
    Ok([read(0)?, read(1)?])
}

/// What presses on a member.
fn pressed(result: &SceneResult, case: FieldCase) -> Pressed {
    let position = result.even_position(case.torque, case.angle);
    let (Some((bevel, position)), member) = (result.bevel.zip(position), case.gear - 1) else {
        return Pressed::default();
    };
    let force = |at: Pressing<'_>| PlacedForce {
        tooth: bevel.teeth_of(at.pair)[member],
        side: bevel.side,
        u: at.up(member),
        v_m: at.along_m(member),
        width_m: bevel.face_widths_m[0] / result.lines.slices as f64,
        normal_n: at.force_n,
        tangential_n: 0.0,
    };
    position.pressing().map(force).collect::<Vec<_>>().into()
}

/// The bevel body, which it always is here.
fn bevel(gear: &StressedGear) -> Result<(&BevelGear, &GearBody<BevelMesh>)> {
    match &gear.body {
        StressedBody::Bevel(gear, body) => Ok((gear, body)),
        StressedBody::Cylindrical(..) => Err(Failure::work("no bevel gear")),
    }
}

fn pictures(
    made: StressSection,
    (angle_deg, result): (Option<f64>, &SceneResult),
    (member, stressed): (usize, &StressedGear),
    watch: &Watch<'_>,
) -> Result<StressSection> {
    let angles = match angle_deg {
        // A pitch: the others are alike.
        None => (0..result.points_per_pitch()).collect(),
        Some(wanted) => vec![nearest_angle(result, wanted)],
    };
    let case = |angle| FieldCase {
        gear: member + 1,
        torque: largest_torque(result),
        angle,
    };
    let cases: Vec<FieldCase> = angles.into_iter().map(case).collect();
    let of_cases: Vec<Pressed> = cases.iter().map(|case| pressed(result, *case)).collect();
    let name = MEMBERS[member];
    let words = |k: usize| cases[k].words(result);
    let ((section, figures), worst) = add_worst(made, (name, stressed), &of_cases, words, watch)?;
    let Some(worst) = worst else {
        return Ok((section, figures));
    };
    let field = stressed.field(&of_cases[worst])?;
    let (gear, body) = bevel(stressed)?;
    let drawn = figures.last().and_then(|f| f["tooth"].as_u64());
    let tooth = drawn.unwrap_or_default() as usize;
    let side = result.bevel.map_or(Flank::Right, |bevel| bevel.side);
    let words = words(worst);
    let title = format!("{name} along its axis, {words}");
    let section = section.push(along_axis(body, &field, &title));
    let title = format!("{name}, tooth {tooth}, {side} side unrolled, toe left, tip up, {words}");
    let unrolled = tooth_surface(gear, body, &field, (tooth, side), &title)?;
    Ok((section.push(unrolled), figures))
}

/// The section in the middle of the face as it is seen along the axis, coloured by the largest stress along the teeth.
fn along_axis(body: &GearBody<BevelMesh>, field: &Field, title: &str) -> FieldPicture {
    let columns = body.mesh.columns_along();
    let mut number = std::collections::HashMap::new();
    let mut nodes_mm = Vec::new();
    let mut quads = Vec::with_capacity(columns.len());
    let mut values = Vec::with_capacity(columns.len());
    for (corners, elements) in columns {
        quads.push(corners.map(|node| {
            *number.entry(node).or_insert_with(|| {
                let [x, y, _] = body.mesh.nodes[node as usize];
                nodes_mm.push([1e3 * x, 1e3 * y]);
                nodes_mm.len() as u32 - 1
            })
        }));
        let stresses = elements.iter().map(|e| field.von_mises_pa[*e as usize]);
        values.push(1e-6 * stresses.fold(0.0, f64::max));
    }
    FieldPicture::new(title, "von Mises stress", "MPa")
        .mesh(nodes_mm, quads)
        .values(FieldValues::PerElement(values))
}

/// One side of a tooth from the middle of the space to the tip: along the face, and the length over root, fillet and
/// flank.
fn tooth_surface(
    gear: &BevelGear,
    body: &GearBody<BevelMesh>,
    field: &Field,
    (tooth, side): (usize, Flank),
    title: &str,
) -> Result<FieldPicture> {
    let mesh = &body.mesh;
    let faces = mesh.outline_faces(tooth, side, |k, section| [k as f64, section as f64]);
    // Nodes by their numbers on the outline and along the tooth.
    let mut at = std::collections::BTreeMap::new();
    for face in &faces {
        for (node, [k, section]) in face.nodes.iter().zip(&face.places_m).take(4) {
            at.insert((*section as usize, *k as usize), *node);
        }
    }
    let mut number = std::collections::HashMap::new();
    let mut nodes_mm = Vec::new();
    let (mut last, mut length_m) = (None, 0.0);
    for ((section, _), node) in &at {
        let x = mesh.nodes[*node as usize];
        length_m = match last {
            Some((before, y)) if before == *section => length_m + distance_m(x, y),
            _ => 0.0,
        };
        last = Some((*section, x));
        number.insert(*node, nodes_mm.len() as u32);
        let along_m = mesh.along[*section] * gear.blank().face_width_m;
        nodes_mm.push([1e3 * along_m, 1e3 * length_m]);
    }
    let skin: Vec<SkinFace> = (faces.iter())
        .map(|face| SkinFace {
            corners: face.nodes[..4].to_vec(),
            element: face.element,
        })
        .collect();
    let stress = von_mises_on_faces(&body.model, &skin, field.displacement_m.as_flattened())?;
    let quads = skin.iter().map(|face| {
        let corner = |k: usize| number[&face.corners[k]];
        [corner(0), corner(1), corner(2), corner(3)]
    });
    let values_mpa = stress.iter().map(|x| 1e-6 * x).collect();
    Ok(FieldPicture::new(title, "von Mises stress", "MPa")
        .mesh(nodes_mm, quads.collect())
        .values(FieldValues::PerElement(values_mpa)))
}

fn distance_m(a: [f64; 3], b: [f64; 3]) -> f64 {
    let squares = (0..3).map(|k| (a[k] - b[k]).powi(2));
    squares.sum::<f64>().sqrt()
}
