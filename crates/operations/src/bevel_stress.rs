//! Stress in the bodies of a bevel pair under its loads: pictures for the page, whole fields for other programs.

use crate::failure::Failure;
use crate::loaded_bevel::Loaded;
use crate::mesh_file::{LengthUnit, export_bevel_mesh};
use crate::result_stress::{StressSection, add_worst};
use crate::stressed_gear::{StressedBody, StressedGear};
use crate::tooth_stress;
use crate::watch::Watch;
use gearmesh_bevel::BevelGear;
use gearmesh_drivetrain::{LoadedContact, LoadedPosition};
use gearmesh_geometry::Flank;
use gearmesh_mesh::BevelMesh;
use gearmesh_model::ReducedGear;
use gearmesh_recovery::PlacedForce;
use gearmesh_reduction::GearBody;
use gearmesh_reduction::field::Field;
use gearmesh_reduction::skin::{SkinFace, von_mises_on_faces};
use gearmesh_report::page::{FieldPicture, FieldValues, Section, Text};
use std::path::{Path, PathBuf};

const MEMBERS: [&str; 2] = ["pinion", "gear"];

/// What is made of the bodies under load.
#[derive(Debug, Clone, Default)]
pub struct BevelStressRequest {
    /// Pictures of both members for the page.
    pub stress: bool,
    /// Member, 1 or 2, of which the whole field is written.
    pub field_gear: Option<u8>,
    /// Turn of the pinion of the field; where a pair of teeth carries most if not given.
    pub field_angle_deg: Option<f64>,
    /// Torque of the field; the largest where not given.
    pub field_torque_nm: Option<f64>,
    /// Mesh file of the field.
    pub field_output: Option<PathBuf>,
}

/// A position under a torque.
struct Case<'a> {
    torque: &'a LoadedContact,
    position: &'a LoadedPosition,
}

impl Case<'_> {
    fn words(&self) -> String {
        format!(
            "{} N m, pinion at {:.2} deg",
            self.torque.torque_nm,
            self.position.pinion_turn_rad.to_degrees()
        )
    }
}

/// Makes what is asked for: the field's file, and the page's section with its figures, where it shall have one.
///
/// # Errors
/// [`Failure`] where the pair has no reduced models or is not loaded by the torque, and for files that cannot be written.
pub fn asked(
    a: &BevelStressRequest,
    loaded: Option<&Loaded>,
    watch: &Watch<'_>,
) -> Result<Option<StressSection>, Failure> {
    let option = match (a.stress, a.field_gear) {
        (true, _) => "--stress",
        (false, Some(_)) => "--field-gear",
        (false, None) => return Ok(None),
    };
    let with_models = loaded.and_then(|loaded| Some((loaded, loaded.models.as_ref()?)));
    let Some((loaded, models)) = with_models else {
        return Err(Failure::input(format!(
            "{option} needs the bodies of both members under load: name their reduced models, `models` of [load] in the pair file"
        )));
    };
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
        let (model, file) = &models[member];
        let body = body.insert(StressedGear::of_bevel(
            model,
            &file.display().to_string(),
            watch,
        )?);
        if let Some(page) = section.take() {
            section = Some(pictures(page, loaded, (member, model, body), watch)?);
        }
        if let (true, Some(output)) = (has_field, &a.field_output) {
            write_field(a, loaded, (member, model, body), (output, watch))?;
        }
    }
    Ok(section)
}

/// The largest torque, or the one that is named.
fn torque_of(loaded: &Loaded, named: Option<f64>) -> Result<&LoadedContact, Failure> {
    let all = loaded.found.iter();
    let found = match named {
        None => all.max_by(|a, b| a.torque_nm.abs().total_cmp(&b.torque_nm.abs())),
        Some(wanted) => {
            let near = |c: &&LoadedContact| (c.torque_nm - wanted).abs() <= 1e-9 * wanted.abs();
            all.clone().find(near)
        }
    };
    found.ok_or_else(|| {
        let torques: Vec<f64> = loaded.found.iter().map(|c| c.torque_nm).collect();
        let named = named.unwrap_or_default();
        Failure::input(format!(
            "--field-torque-Nm: found {named}, the pair is loaded by {torques:?}"
        ))
    })
}

/// The position nearest to a turn of the pinion, or the one at which one pair of teeth carries most.
fn case(torque: &LoadedContact, angle_deg: Option<f64>) -> Result<Case<'_>, Failure> {
    let most = |p: &LoadedPosition| p.pair_forces_n().first().map_or(0.0, |(_, force)| *force);
    let positions = torque.positions.iter();
    let position = match angle_deg {
        None => positions.max_by(|a, b| most(a).total_cmp(&most(b))),
        Some(wanted) => {
            let apart = |p: &LoadedPosition| (p.pinion_turn_rad.to_degrees() - wanted).abs();
            positions.min_by(|a, b| apart(a).total_cmp(&apart(b)))
        }
    };
    let position = position.ok_or_else(|| Failure::work("no position was computed"))?;
    Ok(Case { torque, position })
}

/// What presses on a member.
fn forces(
    loaded: &Loaded,
    case: &Case<'_>,
    member: usize,
    model: &ReducedGear,
) -> Vec<PlacedForce> {
    let patches = case.position.patches.iter();
    patches
        .map(|patch| {
            let [s, u] = patch.places[member];
            PlacedForce {
                tooth: patch.teeth[member],
                side: loaded.side,
                u,
                v_m: (s - 0.5) * model.face_width_m,
                width_m: loaded.slice_width_m(),
                normal_n: patch.force_n,
                tangential_n: 0.0,
            }
        })
        .collect()
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
    loaded: &Loaded,
    (member, model, stressed): (usize, &ReducedGear, &StressedGear),
    (output, watch): (&Path, &Watch<'_>),
) -> Result<(), Failure> {
    let case = case(torque_of(loaded, a.field_torque_nm)?, a.field_angle_deg)?;
    let field = stressed.field(&forces(loaded, &case, member, model))?;
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
    loaded: &Loaded,
    (member, model, stressed): (usize, &ReducedGear, &StressedGear),
    watch: &Watch<'_>,
) -> Result<StressSection, Failure> {
    let torque = torque_of(loaded, None)?;
    let positions = torque.positions.iter();
    let cases: Vec<Case<'_>> = positions
        .map(|position| Case { torque, position })
        .collect();
    let of_cases = cases.iter().map(|case| forces(loaded, case, member, model));
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
    let unrolled = tooth_surface(gear, body, &field, (tooth, loaded.side))?;
    let words = words(worst);
    let section = section
        .push(along_axis(
            body,
            &field,
            &format!("{name} along its axis, {words}"),
        ))
        .push(unrolled.titled(&format!(
            "{name}, tooth {tooth}, {} side unrolled, toe left, tip up, {words}",
            loaded.side
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
