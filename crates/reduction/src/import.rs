//! The reduction of a gear that was meshed elsewhere.
//!
//! The whole gear is factorised and every tooth's own loads are solved: nothing is known of how the mesh repeats. Near
//! field and C_tooth belong to a tooth's mesh and the model holds one of each; where teeth differ in mesh they are the
//! means over the teeth, and the largest departure from them is kept as a check.
//!
//! W of the near field is that of the tooth-only submodel of the imported mesh itself, all nodes held along the axis
//! and the loads uniform over the width: plane strain, and in a mesh made of layers exactly what one layer gives.

use crate::flank_compliance::{
    HubRows, IDENTITY_ALLOWED, SYMMETRY_ALLOWED, checked, pattern_identity,
};
use crate::flank_loads::{
    GridLoad, SparseVector, directions, dot, flank_grid, flank_loads, normals,
};
use crate::gauge_row::{gauge_head, gauge_row};
use crate::imported_error::{ImportedMeshError, PythonFailure};
use crate::imported_mesh::ImportedMesh;
use crate::near_field::{calibration, line_compliance};
use crate::reduce::of_definition;
use crate::reduction_steps::provenance;
use crate::stages::Stages;
use crate::tooth_submodel::{Deformation, ToothSubmodel};
use crate::whole_gear::WholeGear;
use crate::{Progress, ReductionError};
use gearmesh_fe::DofMap;
use gearmesh_geometry::{Flank, GearDefinition, MeshedBody};
use gearmesh_mesh::python::{PythonEnvironment, PythonError};
use gearmesh_model::{FlankGrid, GaugeRows, MeshData, ReducedGear, ReductionChecks, read_mesh};
use rayon::prelude::*;
use std::path::Path;

const IMPORT_SCRIPT: &str = "import sys, gearmesh
try:
    gearmesh.import_mesh(sys.argv[1], sys.argv[2], sys.argv[3])
except (ValueError, OSError) as error:
    print(error, file=sys.stderr)
    sys.exit(2 if isinstance(error, (ValueError, FileNotFoundError)) else 1)
";

/// Reads the mesh file of a definition; `scratch` is a file that may be written.
///
/// # Errors
/// [`ReductionError::Imported`] when it cannot be read, or has elements that are not on offer.
pub fn read_body(
    body: &MeshedBody,
    python: &PythonEnvironment,
    scratch: &Path,
) -> Result<MeshData, ReductionError> {
    let arguments = [
        &body.file.display().to_string(),
        &scratch.display().to_string(),
        body.length_unit.name(),
    ];
    let task = format!("reading {}", body.file.display());
    python
        .run(&task, IMPORT_SCRIPT, &arguments, b"")
        .map_err(|error| match error {
            PythonError::Failed { code, message, .. } => ImportedMeshError::Python(PythonFailure {
                message,
                input: code == Some(2),
            })
            .into(),
            other => ReductionError::Mesh(other.into()),
        })?;
    read_mesh(scratch).map_err(|e| ImportedMeshError::Exchange(e.to_string()).into())
}

/// C_tooth and W of one tooth's flanks, one after another.
struct ToothBlocks {
    c_tooth: Vec<f64>,
    plane: Vec<f64>,
}

/// Reduces a gear on a mesh from elsewhere. The mesh file, as [`read_body`] gives it, is checked against the
/// definition.
///
/// # Errors
/// [`ReductionError`] when the mesh is not the gear's, or not held, a gauge covers nothing, or an identity is violated
/// by more than round-off explains.
pub fn reduce_imported(
    gear: &GearDefinition,
    body: &MeshedBody,
    mesh: MeshData,
    progress: &dyn Progress,
) -> Result<ReducedGear, ReductionError> {
    let mut stages = Stages::after(Vec::new());
    progress.stage("checking the mesh");
    let mesh = ImportedMesh::new(gear, body, mesh)?;
    stages.lap("model");
    let grid = flank_grid(gear);
    let (flanks, teeth, count) = (&gear.reduction.flanks, gear.tooth.teeth, grid.len());
    let loads = loads_of_teeth(gear, &mesh, &grid);
    stages.lap("loads");

    progress.stage("tooth submodels");
    let blocks: Vec<ToothBlocks> = loads
        .par_iter()
        .enumerate()
        .map(|(tooth, loads)| tooth_blocks(gear, &mesh, &grid, tooth, loads))
        .collect::<Result<_, _>>()?;
    let (c_tooth, _) = mean(blocks.iter().map(|b| &b.c_tooth[..]));
    let (plane, spread) = mean(blocks.iter().map(|b| &b.plane[..]));
    stages.lap("tooth submodel");
    progress.stage("calibrating the near field");
    let near_field = calibration(gear, mesh.cut.clone(), &mesh.model, plane)?;
    stages.lap("near field");

    let held: Vec<usize> = mesh.bore.iter().map(|&n| n as usize).collect();
    let dofs = DofMap::with_fixed_nodes(mesh.model.node_count(), &held)?;
    let whole = WholeGear::new(&mesh.model, &dofs, progress, &mut stages)?;
    progress.stage("solving flank loads");
    let normals = normals(loads.iter().flatten().flatten());
    let rows = HubRows {
        values: energies(&whole, &dofs, &normals, progress),
        flanks: flanks.len(),
        teeth,
        count,
    };
    stages.lap("solve");

    progress.stage("checking");
    let symmetry = rows.asymmetry();
    checked("symmetry of C_hub", symmetry, SYMMETRY_ALLOWED)?;
    let of_first = (&loads[0][0][..], &blocks[0], &normals[..count]);
    let identity = identity_of_patterns(&mesh, flanks[0], of_first, &rows, (&whole, &dofs))?;
    checked("the pattern identity", identity, IDENTITY_ALLOWED)?;
    stages.lap("checks");
    let gauges = gauges(gear, &mesh, &loads, &whole, &dofs, progress)?;
    stages.lap("gauges");
    let solved = (normals.len() + gauges.len()) as f64;
    let effort = [
        ("factorisations", 1.0),
        ("right-hand sides", solved),
        ("DOF of the whole gear", dofs.free_count() as f64),
    ];
    let effort = effort.map(|(what, count)| (what.to_string(), count));
    let spread = (
        "spread of the near field over the teeth".to_string(),
        spread,
    );
    let found = ReducedGear {
        teeth,
        sectors: gear.sectors(),
        young_pa: gear.material.young_pa,
        poisson: gear.material.poisson,
        flanks: flanks.clone(),
        c_hub: rows.into_blocks(),
        c_tooth,
        gauges,
        checks: ReductionChecks {
            symmetry,
            pattern_identity: identity,
            further: vec![spread],
        },
        provenance: provenance(&mesh.model, dofs.free_count(), stages, effort.to_vec()),
        ..ReducedGear::default()
    };
    Ok(of_definition(gear, grid, near_field, found))
}

/// Loads of all flanks, `[tooth][flank][load]`.
fn loads_of_teeth(
    gear: &GearDefinition,
    mesh: &ImportedMesh,
    grid: &FlankGrid,
) -> Vec<Vec<Vec<GridLoad>>> {
    let teeth = (0..gear.tooth.teeth).into_par_iter();
    teeth
        .map(|tooth| {
            let of_side = |&side| flank_loads(gear, mesh, grid, tooth, side);
            gear.reduction.flanks.iter().map(of_side).collect()
        })
        .collect()
}

/// What each load does along each other one, row by row of the loads.
fn energies(
    whole: &WholeGear,
    dofs: &DofMap,
    normals: &[&SparseVector],
    progress: &dyn Progress,
) -> Vec<f64> {
    let mut values = Vec::with_capacity(normals.len() * normals.len());
    whole.solve_each(dofs, normals, progress, |_, u| {
        values.par_extend(normals.par_iter().map(|v| dot(v, u)));
    });
    values
}

/// How far the patterns' identity is off, at the first flank of tooth 0.
fn identity_of_patterns(
    mesh: &ImportedMesh,
    flank: Flank,
    (loads, blocks, normals): (&[GridLoad], &ToothBlocks, &[&SparseVector]),
    rows: &HubRows,
    (whole, dofs): (&WholeGear, &DofMap),
) -> Result<f64, ReductionError> {
    let deformation = Deformation::Spatial;
    let submodel = ToothSubmodel::of_tooth(&mesh.model, mesh, (0, flank), loads, deformation)?;
    Ok(pattern_identity(
        (&submodel, &blocks.c_tooth),
        normals,
        rows,
        |loads, each| whole.solve_each(dofs, loads, &crate::Silent, each),
        |patterns| whole.energy_products(dofs, patterns),
    ))
}

/// C_tooth, `[flank][load][response]`, and W, `[flank][load station][response station]`, of one tooth.
fn tooth_blocks(
    gear: &GearDefinition,
    mesh: &ImportedMesh,
    grid: &FlankGrid,
    tooth: usize,
    loads: &[Vec<GridLoad>],
) -> Result<ToothBlocks, ReductionError> {
    let mut blocks = ToothBlocks {
        c_tooth: Vec::new(),
        plane: Vec::new(),
    };
    for (&side, loads) in gear.reduction.flanks.iter().zip(loads) {
        let submodel = |deformation| {
            ToothSubmodel::of_tooth(&mesh.model, mesh, (tooth, side), loads, deformation)
        };
        let spatial = submodel(Deformation::Spatial)?;
        blocks.c_tooth.extend(spatial.compliance(loads));
        let plane = submodel(Deformation::PlaneStrain)?.products(&normals(loads));
        let width_m = gear.tooth.face_width_m;
        blocks.plane.extend(line_compliance(grid, &plane, width_m));
    }
    Ok(blocks)
}

/// Mean of equally long lists, and the largest departure from it relative to the largest value.
fn mean<'a>(lists: impl Iterator<Item = &'a [f64]> + Clone) -> (Vec<f64>, f64) {
    let n = lists.clone().count() as f64;
    let mut mean: Vec<f64> = Vec::new();
    for list in lists.clone() {
        mean.resize(list.len(), 0.0);
        mean.iter_mut().zip(list).for_each(|(m, v)| *m += v / n);
    }
    let largest = mean.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let departure = lists
        .flat_map(|list| list.iter().zip(&mean).map(|(v, m)| (v - m).abs()))
        .fold(0.0, f64::max);
    (mean, departure / largest)
}

/// One adjoint solution per gauge, read at the loads of every tooth; and gᵀW on its own tooth.
fn gauges(
    gear: &GearDefinition,
    mesh: &ImportedMesh,
    loads: &[Vec<Vec<GridLoad>>],
    whole: &WholeGear,
    dofs: &DofMap,
    progress: &dyn Progress,
) -> Result<Vec<GaugeRows>, ReductionError> {
    let rows: Vec<SparseVector> = gear
        .gauges
        .iter()
        .map(|g| gauge_row(gear, mesh, &mesh.model, g, g.tooth))
        .collect::<Result<_, _>>()?;
    let directions = directions(loads.iter().flatten().flatten());
    let mut adjoints: Vec<Vec<f64>> = Vec::new();
    let references: Vec<&SparseVector> = rows.iter().collect();
    whole.solve_each(dofs, &references, progress, |_, y| {
        adjoints.push(directions.par_iter().map(|v| dot(v, y)).collect());
    });
    let own_tooth = |tooth: usize, row: &SparseVector| -> Result<Vec<f64>, ReductionError> {
        let mut products = Vec::new();
        for (&side, loads) in gear.reduction.flanks.iter().zip(&loads[tooth]) {
            let place: (usize, Flank) = (tooth, side);
            let submodel =
                ToothSubmodel::of_tooth(&mesh.model, mesh, place, loads, Deformation::Spatial)?;
            products.extend(submodel.products(&[row]));
        }
        Ok(products)
    };
    gear.gauges
        .iter()
        .zip(adjoints.into_iter().zip(&rows))
        .map(|(gauge, (adjoint, row))| {
            Ok(GaugeRows {
                adjoint,
                own_tooth: own_tooth(gauge.tooth, row)?,
                ..gauge_head(gauge)
            })
        })
        .collect()
}
