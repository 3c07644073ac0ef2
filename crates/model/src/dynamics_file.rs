//! The groups of a reduced gear's file that the dynamics reads: rigid body, reference point, modes. All are optional;
//! files before version 3 have none.

use std::path::Path;

use crate::data_tree::{DataArray, DataTree, Values};
use crate::file_error::FileError;
use crate::modal_basis::ModalBasis;
use crate::reduced_gear::ReducedGear;
use crate::rigid_body::{ReferencePoint, RigidBody};

const GEAR_FRAME: &str = crate::reduced_gear_file::GEAR_FRAME;
const FLANK_COMPONENTS: &str = crate::reduced_gear_file::FLANK_COMPONENTS;

/// Lengths that the arrays have in common.
#[derive(Clone, Copy)]
pub(crate) struct Sizes {
    pub teeth: usize,
    pub hands: usize,
    pub loads: usize,
    pub gauges: usize,
}

pub(crate) fn put_dynamics(tree: &mut DataTree, gear: &ReducedGear) {
    let sizes = Sizes {
        teeth: gear.teeth,
        hands: gear.flanks.len(),
        loads: gear.grid.len(),
        gauges: gear.gauges.len(),
    };
    if let Some(body) = &gear.rigid_body {
        put_rigid_body(tree, body);
    }
    if let Some(point) = &gear.reference_point {
        put_reference_point(tree, point, sizes);
    }
    if let Some(basis) = &gear.modes {
        put_modes(tree, basis, sizes);
    }
}

fn put_rigid_body(tree: &mut DataTree, body: &RigidBody) {
    let at = |item: &str| format!("rigid_body/{item}");
    let mass = DataArray::scalar(body.mass_kg, "kg", "mass of the meshed body");
    tree.put(at("mass"), mass);
    let about = "point that the inertia tensor is about";
    put_vector(tree, &at("reference"), body.reference_m, about);
    put_vector(tree, &at("centre"), body.centre_m, "centre of mass");
    let array = DataArray::new(
        Values::F64(body.inertia_kg_m2.as_flattened().to_vec()),
        &[("axis", 3), ("axis", 3)],
        "kg*m^2",
        "inertia tensor about the reference point",
    );
    tree.put(at("inertia"), array.in_frame(GEAR_FRAME));
}

fn put_vector(tree: &mut DataTree, name: &str, values: [f64; 3], description: &str) {
    let values = Values::F64(values.to_vec());
    let array = DataArray::new(values, &[("axis", 3)], "m", description);
    tree.put(name, array.in_frame(GEAR_FRAME));
}

fn take_vector(tree: &mut DataTree, path: &Path, name: &str) -> Result<[f64; 3], FileError> {
    let values = tree.take_f64(path, name, &[3])?;
    Ok(std::array::from_fn(|k| values[k]))
}

pub(crate) fn take_rigid_body(
    tree: &mut DataTree,
    path: &Path,
) -> Result<Option<RigidBody>, FileError> {
    let at = |item: &str| format!("rigid_body/{item}");
    if tree.children("rigid_body").is_empty() {
        return Ok(None);
    }
    let reference_m = take_vector(tree, path, &at("reference"))?;
    let centre_m = take_vector(tree, path, &at("centre"))?;
    let inertia = tree.take_f64(path, &at("inertia"), &[3, 3])?;
    Ok(Some(RigidBody {
        reference_m,
        mass_kg: tree.take_scalar(path, &at("mass"))?,
        centre_m,
        inertia_kg_m2: std::array::from_fn(|i| std::array::from_fn(|j| inertia[3 * i + j])),
    }))
}

fn put_reference_point(tree: &mut DataTree, point: &ReferencePoint, sizes: Sizes) {
    let place = "place of the hub's reference point";
    put_vector(tree, "reference_point/place", point.place_m, place);
    let axes = [
        ("tooth", sizes.teeth),
        ("flank", sizes.hands),
        ("load: roll station, axial station", sizes.loads),
        ("component", 3),
        ("motion: x, y, z, rotations about x, y, z", 6),
    ];
    let array = DataArray::new(
        Values::F64(point.flank.clone()),
        &axes,
        "1",
        "displacement at the flank per motion of the hub's reference point (m per rad for rotations)",
    );
    tree.put("reference_point/flank", array.in_frame(FLANK_COMPONENTS));
}

pub(crate) fn take_reference_point(
    tree: &mut DataTree,
    path: &Path,
    sizes: Sizes,
) -> Result<Option<ReferencePoint>, FileError> {
    if tree.children("reference_point").is_empty() {
        return Ok(None);
    }
    let shape = [sizes.teeth, sizes.hands, sizes.loads, 3, 6];
    let flank = tree.take_f64(path, "reference_point/flank", &shape)?;
    let place_m = take_vector(tree, path, "reference_point/place")?;
    Ok(Some(ReferencePoint { place_m, flank }))
}

fn put_modes(tree: &mut DataTree, basis: &ModalBasis, sizes: Sizes) {
    let at = |item: &str| format!("modes/{item}");
    let modes = ("mode", basis.count());
    let complete = "every mode up to this frequency is in the basis";
    let complete = DataArray::scalar(basis.complete_to_hz, "Hz", complete);
    tree.put(at("complete_to"), complete);
    let array = |values: &[f64], axes: &[(&str, usize)], unit, description| {
        DataArray::new(Values::F64(values.to_vec()), axes, unit, description)
    };
    let squares = "squares of the natural angular frequencies, bore held";
    let squares = array(&basis.omega_squared, &[modes], "rad^2/s^2", squares);
    tree.put(at("omega_squared"), squares);
    let diameters = basis.nodal_diameters.iter().map(|&n| n as u32).collect();
    let description = "nodal diameters: the strongest harmonic round the teeth";
    let diameters = DataArray::new(Values::U32(diameters), &[modes], "1", description);
    tree.put(at("nodal_diameters"), diameters);
    let axes = [
        modes,
        ("tooth", sizes.teeth),
        ("flank", sizes.hands),
        ("load: roll station, axial station", sizes.loads),
        ("component", 3),
    ];
    let description = "mode shapes of modal mass 1 at the flank grid";
    let flank = array(&basis.flank, &axes, "kg^-1/2", description);
    tree.put(at("flank"), flank.in_frame(FLANK_COMPONENTS));
    let axes = [modes, ("gauge", sizes.gauges)];
    let description = "strain of the gauges in the mode shapes";
    let gauges = array(&basis.gauges, &axes, "m^-1*kg^-1/2", description);
    tree.put(at("gauges"), gauges);
    let axes = [modes, ("motion: x, y, z, rotations about x, y, z", 6)];
    let description = "mode shapes times mass matrix times rigid motions about the origin (kg^1/2 m for rotations)";
    let coupling = array(&basis.coupling, &axes, "kg^1/2", description);
    tree.put(at("coupling"), coupling.in_frame(GEAR_FRAME));
}

pub(crate) fn take_modes(
    tree: &mut DataTree,
    path: &Path,
    sizes: Sizes,
) -> Result<Option<ModalBasis>, FileError> {
    let at = |item: &str| format!("modes/{item}");
    if tree.children("modes").is_empty() {
        return Ok(None);
    }
    let [modes] = tree.shape(path, &at("omega_squared"))?;
    let diameters = tree.take_u32(path, &at("nodal_diameters"), &[modes])?;
    let shape = [modes, sizes.teeth, sizes.hands, sizes.loads, 3];
    Ok(Some(ModalBasis {
        omega_squared: tree.take_f64(path, &at("omega_squared"), &[modes])?,
        nodal_diameters: diameters.into_iter().map(|n| n as usize).collect(),
        complete_to_hz: tree.take_scalar(path, &at("complete_to"))?,
        flank: tree.take_f64(path, &at("flank"), &shape)?,
        gauges: tree.take_f64(path, &at("gauges"), &[modes, sizes.gauges])?,
        coupling: tree.take_f64(path, &at("coupling"), &[modes, 6])?,
    }))
}
