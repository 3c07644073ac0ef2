//! Stress in the bodies of a bevel pair under its loads: pictures for the page, whole fields for other programs.

use crate::failure::Failure;
use crate::mesh_file::{LengthUnit, export_bevel_mesh};
use crate::result_stress::{StressSection, add_worst};
use crate::stressed_gear::{StressedBody, StressedGear};
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
use std::path::{Path, PathBuf};

const MEMBERS: [&str; 2] = ["pinion", "gear"];

/// What is made of the bodies under load.
#[derive(Debug, Clone, Default)]
pub struct BevelStressRequest {
    /// Pictures of both members for the page.
    pub stress: bool,
    /// Driver angle of the pictures; that of the largest root stress where not given.
    pub angle_deg: Option<f64>,
    /// Member, 1 or 2, of which the whole field is written.
    pub field_gear: Option<u8>,
    /// Driver angle of the field; where a pair of teeth carries most if not given.
    pub field_angle_deg: Option<f64>,
    /// Torque of the field; the largest where not given.
    pub field_torque_nm: Option<f64>,
    /// Mesh file of the field.
    pub field_output: Option<PathBuf>,
}

/// A position under a torque, by their numbers in the result.
#[derive(Clone, Copy)]
struct Case<'a> {
    result: &'a SceneResult,
    torque: usize,
    angle: usize,
}

impl Case<'_> {
    fn words(&self) -> String {
        format!(
            "{} N m, driver angle {:.2} deg",
            self.result.torque_nm[self.torque],
            self.result.angle_rad[self.angle].to_degrees()
        )
    }
}

/// Makes what is asked for: the field's file, and the page's section with its figures, where it shall have one.
///
/// # Errors
/// [`Failure`] where the pair has no reduced models or is not loaded by the torque, and for files that cannot be written.
pub fn asked(
    a: &BevelStressRequest,
    result: Option<&SceneResult>,
    watch: &Watch<'_>,
) -> Result<Option<StressSection>, Failure> {
    let option = match (a.stress, a.field_gear) {
        (true, _) => "--stress",
        (false, Some(_)) => "--field-gear",
        (false, None) => return Ok(None),
    };
    let with_models = result.filter(|result| !result.model_files[0].is_empty());
    let Some(result) = with_models else {
        return Err(Failure::input(format!(
            "{option} needs the bodies of both members under load: name their reduced models, `models` of [load] in the pair file"
        )));
    };
    let models = models_of(result)?;
    let mut bodies: [Option<StressedGear>; 2] = [None, None];
    let mut section = a.stress.then(|| {
        let section = Section::new("Stress in the bodies");
        let words = format!(
            "{} Each member at the position of its largest root stress under the largest torque. Last, the body along its axis, the largest value along the teeth, and the \
             tooth's side unrolled, from the middle of the space over root and fillet to the tip.",
            tooth_stress::WORDS
        );
        (section.push(Text::paragraph(words)), Vec::new())
    });
    for (member, body) in bodies.iter_mut().enumerate() {
        let has_field = a.field_gear == Some(member as u8 + 1);
        if !has_field && section.is_none() {
            continue;
        }
        let model = &models[member];
        let body = body.insert(StressedGear::of_bevel(
            model,
            &result.model_files[member],
            watch,
        )?);
        if let Some(page) = section.take() {
            section = Some(pictures(page, (a, result), (member, body), watch)?);
        }
        if let (true, Some(output)) = (has_field, &a.field_output) {
            write_field(a, result, (member, body), (output, watch))?;
        }
    }
    Ok(section)
}

/// The reduced members of a result.
///
/// # Errors
/// [`Failure`] where one cannot be read, or has been made again.
pub fn models_of(result: &SceneResult) -> Result<[ReducedGear; 2], Failure> {
    let read = |i: usize| {
        let file = &result.model_files[i];
        let model = read_reduced_gear(Path::new(file)).map_err(Failure::input)?;
        if model.input != result.gears[i] {
            return Err(Failure::input(format!(
                "{file} has been made again from another gear file since the result was computed; run the pair again"
            )));
        }
        Ok(model)
    };
    Ok([read(0)?, read(1)?])
}

/// The largest torque, or the one that is named.
fn torque_of(result: &SceneResult, named: Option<f64>) -> Result<usize, Failure> {
    let torques = &result.torque_nm;
    let found = match named {
        None => (0..torques.len()).max_by(|a, b| torques[*a].total_cmp(&torques[*b])),
        Some(wanted) => {
            let near = |torque: &f64| (torque - wanted).abs() <= 1e-9 * wanted.abs();
            torques.iter().position(near)
        }
    };
    found.ok_or_else(|| {
        let named = named.unwrap_or_default();
        Failure::input(format!(
            "--field-torque-Nm: found {named}, the pair is loaded by {torques:?}"
        ))
    })
}

/// The position nearest to a driver angle, or the one at which one pair of teeth carries most.
fn angle_of(result: &SceneResult, torque: usize, angle_deg: Option<f64>) -> usize {
    let most = |angle: usize| {
        let forces = result
            .even_position(torque, angle)
            .map(|p| p.pair_forces_n());
        forces
            .and_then(|forces| forces.first().copied())
            .map_or(0.0, |(_, force)| force)
    };
    let apart = |angle: usize, wanted: f64| (result.angle_rad[angle].to_degrees() - wanted).abs();
    let found = match angle_deg {
        None => (0..result.points_per_pitch()).max_by(|a, b| most(*a).total_cmp(&most(*b))),
        Some(wanted) => {
            (0..result.angles()).min_by(|a, b| apart(*a, wanted).total_cmp(&apart(*b, wanted)))
        }
    };
    found.unwrap_or_default()
}

/// What presses on a member.
fn forces(case: Case<'_>, member: usize) -> Vec<PlacedForce> {
    let Some((bevel, position)) =
        (case.result.bevel).zip(case.result.even_position(case.torque, case.angle))
    else {
        return Vec::new();
    };
    let force = |at: Pressing<'_>| PlacedForce {
        tooth: bevel.teeth_of(at.pair)[member],
        side: bevel.side,
        u: at.up(member),
        v_m: at.along_m(member),
        width_m: bevel.face_widths_m[0] / case.result.slices as f64,
        normal_n: at.force_n,
        tangential_n: 0.0,
    };
    position.pressing().map(force).collect()
}

/// The bevel body, which it always is here.
fn bevel(gear: &StressedGear) -> Result<(&BevelGear, &GearBody<BevelMesh>), Failure> {
    match &gear.body {
        StressedBody::Bevel(gear, body) => Ok((gear, body)),
        StressedBody::Cylindrical(..) => Err(Failure::work("no bevel gear")),
    }
}

fn write_field(
    a: &BevelStressRequest,
    result: &SceneResult,
    (member, stressed): (usize, &StressedGear),
    (output, watch): (&Path, &Watch<'_>),
) -> Result<(), Failure> {
    let torque = torque_of(result, a.field_torque_nm)?;
    let case = Case {
        result,
        torque,
        angle: angle_of(result, torque, a.field_angle_deg),
    };
    let field = stressed.field(&forces(case, member))?;
    let (gear, body) = bevel(stressed)?;
    let file = (output, LengthUnit::M);
    export_bevel_mesh(gear, &body.mesh, (&field).into(), file, watch)?;
    watch.note(format!(
        "{}: field of the {}, {}",
        output.display(),
        MEMBERS[member],
        case.words()
    ));
    Ok(())
}

fn pictures(
    made: StressSection,
    (a, result): (&BevelStressRequest, &SceneResult),
    (member, stressed): (usize, &StressedGear),
    watch: &Watch<'_>,
) -> Result<StressSection, Failure> {
    let torque = torque_of(result, None)?;
    let angles = match a.angle_deg {
        // A pitch: the others are alike.
        None => (0..result.points_per_pitch()).collect(),
        Some(_) => vec![angle_of(result, torque, a.angle_deg)],
    };
    let case = |angle| Case {
        result,
        torque,
        angle,
    };
    let cases: Vec<Case<'_>> = angles.into_iter().map(case).collect();
    let of_cases = cases.iter().map(|case| forces(*case, member));
    let of_cases: Vec<Vec<PlacedForce>> = of_cases.collect();
    let name = MEMBERS[member];
    let words = |k: usize| cases[k].words();
    let ((section, figures), worst) = add_worst(made, (name, stressed), &of_cases, words, watch)?;
    let Some(worst) = worst else {
        return Ok((section, figures));
    };
    let field = stressed.field(&of_cases[worst])?;
    let (gear, body) = bevel(stressed)?;
    let drawn = figures.last().and_then(|f| f["tooth"].as_u64());
    let tooth = drawn.unwrap_or_default() as usize;
    let side = result.bevel.map_or(Flank::Right, |bevel| bevel.side);
    let unrolled = tooth_surface(gear, body, &field, (tooth, side))?;
    let words = words(worst);
    let section = section
        .push(along_axis(
            body,
            &field,
            &format!("{name} along its axis, {words}"),
        ))
        .push(unrolled.titled(&format!(
            "{name}, tooth {tooth}, {} side unrolled, toe left, tip up, {words}",
            side
        )));
    Ok((section, figures))
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

/// A tooth's side, unrolled.
struct Unrolled {
    nodes_mm: Vec<[f64; 2]>,
    quads: Vec<[u32; 4]>,
    values_mpa: Vec<f64>,
}

impl Unrolled {
    fn titled(self, title: &str) -> FieldPicture {
        FieldPicture::new(title, "von Mises stress", "MPa")
            .mesh(self.nodes_mm, self.quads)
            .values(FieldValues::PerElement(self.values_mpa))
    }
}

/// One side of a tooth from the middle of the space to the tip: along the face, and the length over root, fillet and flank.
fn tooth_surface(
    gear: &BevelGear,
    body: &GearBody<BevelMesh>,
    field: &Field,
    (tooth, side): (usize, Flank),
) -> Result<Unrolled, Failure> {
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
    Ok(Unrolled {
        quads: quads.collect(),
        nodes_mm,
        values_mpa: stress.iter().map(|x| 1e-6 * x).collect(),
    })
}

fn distance_m(a: [f64; 3], b: [f64; 3]) -> f64 {
    let squares = (0..3).map(|k| (a[k] - b[k]).powi(2));
    squares.sum::<f64>().sqrt()
}
