//! Meshes as files of other programs, with their sets and fields; written by meshio in a Python process.

use crate::failure::{Failure, Result};
use crate::scratch::Scratch;
use crate::watch::Watch;
use gearmesh_bevel::BevelGear;
use gearmesh_geometry::{Element, Flank, GearDefinition};
use gearmesh_mesh::python::PythonError;
use gearmesh_mesh::{BevelMesh, BodyGrid, ElementList, GearMesh};
use gearmesh_model::{CellKind, Field as MeshField, MeshData, write_by, write_mesh};
use gearmesh_reduction::field::Field;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;

/// Unit of lengths in a mesh file.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum LengthUnit {
    /// Metres.
    #[default]
    M,
    /// Millimetres.
    Mm,
}

impl LengthUnit {
    /// Both.
    pub const ALL: [Self; 2] = [Self::M, Self::Mm];

    /// As files and arguments call it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::M => "m",
            Self::Mm => "mm",
        }
    }
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
    (output, unit): (&Path, LengthUnit),
    watch: &Watch<'_>,
) -> Result<()> {
    let data = MeshData {
        points: mesh.nodes.clone(),
        cells: cells_of(&mesh.elements),
        point_sets: mesh.node_sets(gear),
        point_fields: fields.point,
        cell_fields: fields.cell,
    };
    export((&data, gear.mesh.element), (output, unit), watch)
}

/// Says where the body of a bevel gear is not meshed in rows.
pub(crate) fn note_body_grid(grid: BodyGrid, watch: &Watch<'_>) {
    if grid == BodyGrid::Free {
        watch.note(
            "the body below the teeth is meshed freely in its meridian, for rows of hexahedra from the teeth to the bore would be too poor there",
        );
    }
}

/// The same of a bevel gear: sets are the bore and the flanks of all teeth.
pub fn export_bevel_mesh(
    gear: &BevelGear,
    mesh: &BevelMesh,
    fields: MeshFields,
    (output, unit): (&Path, LengthUnit),
    watch: &Watch<'_>,
) -> Result<()> {
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
    export((&data, gear.mesh.element), (output, unit), watch)
}

fn cells_of(elements: &ElementList) -> BTreeMap<CellKind, Vec<u32>> {
    BTreeMap::from([(elements.shape(), elements.connectivity().to_vec())])
}

fn export(
    (data, element): (&MeshData, Element),
    (output, unit): (&Path, LengthUnit),
    watch: &Watch<'_>,
) -> Result<()> {
    watch.go_on()?;
    let folder = Scratch::new()?;
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
        left_out = watch
            .python()?
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
        watch.note(format!(
            "{} does not hold {} node sets or fields of the mesh ({}{more})",
            output.display(),
            names.len(),
            names[..names.len().min(MOST_NAMES)].join(", ")
        ));
    }
    Ok(())
}
