//! The offline side as the commands use it: reading a gear, meshing, reducing, writing meshes, making fields.

use crate::console::{self, StageBar};
use crate::failure::Failure;
use crate::interrupt::Scratch;
use crate::length_unit::LengthUnit;
use gearmesh_bevel::BevelGear;
use gearmesh_geometry::input::{InputDocument, MOST_MESH_BYTES, demand_readable};
use gearmesh_geometry::{Element, Flank, GearDefinition, MeshedBody};
use gearmesh_mesh::python::{PythonEnvironment, PythonError};
use gearmesh_mesh::{BevelMesh, BodyGrid, ElementList, GearMesh};
use gearmesh_model::{CellKind, Field as MeshField, MeshData, ReducedGear, write_by, write_mesh};
use gearmesh_recovery::grid_forces;
use gearmesh_reduction::field::{Field, GridForce, fields};
use gearmesh_reduction::{
    GearBody, Progress, ReductionOptions, read_body, reduce, reduce_imported,
};
use gearmesh_scene::{LoadedScene, SceneResult};
use std::collections::BTreeMap;
use std::path::Path;

/// The Python that has gmsh and meshio.
pub fn python() -> Result<PythonEnvironment, Failure> {
    PythonEnvironment::find().map_err(Failure::work)
}

/// Reads a gear file for the offline stage.
pub fn gear(path: &Path) -> Result<GearDefinition, Failure> {
    let document = InputDocument::read(path)?;
    if BevelGear::recognises(&document)? {
        return Err(Failure::input(format!(
            "{}: this is a bevel gear; `mesh`, `reduce` and `check` take bevel gears, this command cylindrical ones only",
            path.display()
        )));
    }
    let gear = GearDefinition::from_document(&document)?;
    judge_gear(&gear, &document)?;
    Ok(gear)
}

/// Reads a file as that of a bevel gear; none where it is not meant as one.
pub fn bevel_gear(path: &Path) -> Result<Option<BevelGear>, Failure> {
    let document = InputDocument::read(path)?;
    if !BevelGear::recognises(&document)? {
        return Ok(None);
    }
    let folder = path.parent().unwrap_or(Path::new(""));
    let gear = BevelGear::from_document(&document, folder)?;
    console::unit_slips(document.unit_slips());
    Ok(Some(gear))
}

/// What a gear file leaves to find before the offline stage: whether its mesh is there, and numbers that look like
/// those of another unit.
pub fn judge_gear(gear: &GearDefinition, document: &InputDocument) -> Result<(), Failure> {
    demand_body_file(gear, document)?;
    console::unit_slips(document.unit_slips());
    Ok(())
}

/// Demands the mesh file that a gear names.
pub fn demand_body_file(gear: &GearDefinition, document: &InputDocument) -> Result<(), Failure> {
    if let Some(body) = gear.blank.meshed() {
        let shown = body.file.display();
        if !body.file.exists() {
            let problem = format!("the mesh file {shown} does not exist");
            return Err(document.error("blank.file", problem).into());
        }
        demand_readable(&body.file, MOST_MESH_BYTES)
            .map_err(|error| document.error("blank.file", format!("{shown} {error}")))?;
    }
    Ok(())
}

/// Says which element was chosen and why, where the gear file leaves it open and the usual one does not do.
pub fn note_element(gear: &GearDefinition) {
    if let Some(reason) = gear.mesh.chosen_because {
        console::note(format!(
            "tetrahedra of ten nodes (mesh.element = \"tet10\"): {reason}"
        ));
    }
}

/// Says that a gear's crack is not in what is made of it.
pub fn note_sound(gear: &GearDefinition, what: &str) {
    if gear.crack.is_some() {
        console::note(format!("{what} those of the gear without its [crack]"));
    }
}

/// Meshes and reduces a gear, with a progress bar.
pub fn reduced(
    gear: &GearDefinition,
    estimate_error: bool,
) -> Result<(ReducedGear, GearBody), Failure> {
    let bar = StageBar::new(&gear.name);
    let outcome = reduce(gear, &python()?, ReductionOptions { estimate_error }, &bar);
    bar.finish();
    Ok(outcome?)
}

/// Reduces a gear whose body a study varies; what went wrong in words.
pub fn reduced_for_study(gear: &GearDefinition) -> Result<ReducedGear, String> {
    let outcome = match gear.blank.meshed() {
        Some(body) => reduced_import(gear, body),
        None => reduced(gear, true).map(|(model, _)| model),
    };
    outcome.map_err(|failure| failure.message)
}

/// Reads, checks and reduces a gear that was meshed elsewhere.
pub fn reduced_import(gear: &GearDefinition, body: &MeshedBody) -> Result<ReducedGear, Failure> {
    let bar = StageBar::new(&gear.name);
    bar.stage("reading the mesh");
    let folder = Scratch::new(tempfile::tempdir().map_err(Failure::work)?.keep());
    let mesh = read_body(body, &python()?, &folder.path().join("mesh.h5"));
    let outcome = mesh.and_then(|mesh| reduce_imported(gear, body, mesh, &bar));
    bar.finish();
    Ok(outcome?)
}

/// Fields of a mesh file by name.
#[derive(Debug, Default)]
pub struct MeshFields {
    /// On nodes.
    pub point: BTreeMap<String, MeshField>,
    /// In elements.
    pub cell: BTreeMap<String, MeshField>,
}

impl From<&Field> for MeshFields {
    fn from(field: &Field) -> Self {
        let displacement = MeshField {
            components: 3,
            values: field.displacement_m.iter().flatten().copied().collect(),
            unit: "m".into(),
        };
        let von_mises = MeshField {
            components: 1,
            values: field.von_mises_pa.clone(),
            unit: "Pa".into(),
        };
        Self {
            point: BTreeMap::from([("displacement_m".into(), displacement)]),
            cell: BTreeMap::from([("von_mises_Pa".into(), von_mises)]),
        }
    }
}

/// Calls the Python module: mesh file, output, unit, whether hexahedra have incompatible modes. Prints what the format
/// does not hold.
const EXPORT: &str = "
import sys, gearmesh
try:
    left_out = gearmesh.export_mesh(*sys.argv[1:4], incompatible_modes=sys.argv[4] == 'yes')
    print(*left_out, sep='\\n')
except (ValueError, OSError) as error:
    print(error, file=sys.stderr)
    sys.exit(2 if isinstance(error, ValueError) else 1)
";

/// Names that a note about what a format does not hold lists.
const MOST_NAMES: usize = 3;

/// Writes a mesh with its sets and fields in the format that the extension names; says what that does not hold.
pub fn export_mesh(
    gear: &GearDefinition,
    mesh: &GearMesh,
    fields: MeshFields,
    unit: LengthUnit,
    output: &Path,
) -> Result<(), Failure> {
    let data = MeshData {
        points: mesh.nodes.clone(),
        cells: cells_of(&mesh.elements),
        point_sets: mesh.node_sets(gear),
        point_fields: fields.point,
        cell_fields: fields.cell,
    };
    export((&data, gear.mesh.element), unit, output)
}

/// Says where the body of a bevel gear is not meshed in rows.
pub fn note_body_grid(grid: BodyGrid) {
    if grid == BodyGrid::Free {
        console::note(
            "the body below the teeth is meshed freely in its meridian, for rows of hexahedra from the teeth to the bore would be too poor there",
        );
    }
}

/// The same of a bevel gear: sets are the bore and the flanks of all teeth.
pub fn export_bevel_mesh(
    gear: &BevelGear,
    mesh: &BevelMesh,
    fields: MeshFields,
    unit: LengthUnit,
    output: &Path,
) -> Result<(), Failure> {
    let mut point_sets = BTreeMap::from([("bore".to_owned(), mesh.bore())]);
    for tooth in 0..mesh.teeth() {
        for side in [Flank::Right, Flank::Left] {
            let name = format!("tooth{tooth}_{side}_flank");
            point_sets.insert(name, mesh.flank_nodes(tooth, side));
        }
    }
    for set in point_sets.values_mut() {
        set.sort_unstable();
        set.dedup();
    }
    let data = MeshData {
        points: mesh.nodes.clone(),
        cells: cells_of(&mesh.elements),
        point_sets,
        point_fields: fields.point,
        cell_fields: fields.cell,
    };
    export((&data, gear.mesh.element), unit, output)
}

fn cells_of(elements: &ElementList) -> BTreeMap<CellKind, Vec<u32>> {
    BTreeMap::from([(elements.shape(), elements.connectivity().to_vec())])
}

fn export(
    (data, element): (&MeshData, Element),
    unit: LengthUnit,
    output: &Path,
) -> Result<(), Failure> {
    let folder = tempfile::tempdir().map_err(Failure::work)?.keep();
    let folder = Scratch::new(folder);
    let exchange = folder.path().join("mesh.h5");
    write_mesh(&exchange, data).map_err(Failure::work)?;
    let incompatible_modes = if element == Element::Hex8Incompatible {
        "yes"
    } else {
        "no"
    };
    let blame = |error: PythonError| match error {
        PythonError::Failed { code: Some(2), .. } => Failure::input(error),
        _ => Failure::work(error),
    };
    let mut left_out = Vec::new();
    write_by(output, |beside| {
        let task = format!("writing {}", output.display());
        let arguments = [
            &*exchange.display().to_string(),
            &*beside.display().to_string(),
            unit.name(),
            incompatible_modes,
        ];
        left_out = python()?
            .run(&task, EXPORT, &arguments, b"")
            .map_err(blame)?;
        Ok::<(), Failure>(())
    })?;
    let left_out = String::from_utf8_lossy(&left_out);
    let names: Vec<&str> = left_out.split_whitespace().collect();
    if !names.is_empty() {
        let more = if names.len() > MOST_NAMES {
            ", ..."
        } else {
            ""
        };
        console::note(format!(
            "{} does not hold {} node sets or fields of the mesh ({}{more})",
            output.display(),
            names.len(),
            names[..names.len().min(MOST_NAMES)].join(", ")
        ));
    }
    Ok(())
}

/// Which computed position a field is made for.
#[derive(Debug, Clone, Copy)]
pub struct FieldCase {
    /// Gear 1 or 2.
    pub gear: usize,
    /// Index of the torque in the result.
    pub torque: usize,
    /// Index of the angle in the result.
    pub angle: usize,
}

/// Displacement and stress of a gear at one position of a result.
pub fn field_of(
    loaded: &LoadedScene,
    result: &SceneResult,
    definition: &GearDefinition,
    body: &GearBody,
    case: FieldCase,
) -> Result<Field, Failure> {
    let model = &loaded.models[case.gear - 1];
    let slices = loaded.patches_at(result.angle_rad[case.angle]);
    let forces = result.position_forces(case.torque, case.angle);
    let loads = loaded.loaded_slices(case.gear, &slices, forces);
    let forces: Vec<GridForce> = grid_forces(&model.grid, &loaded.spreads[case.gear - 1], loads)
        .into_iter()
        .map(|f| GridForce {
            tooth: f.tooth,
            side: loaded.scene.flank,
            load: f.load,
            normal_n: f.normal_n,
            tangential_n: f.tangential_n,
        })
        .collect();
    let mut made = fields(definition, body, &[forces])?;
    made.pop().ok_or_else(|| Failure::work("no field was made"))
}
