//! Reduced gears as NumPy arrays.

use std::path::PathBuf;

use gearmesh_model::{GaugeRows, NearField, ReducedGear, RootCrack};
use numpy::{Element, PyArray1, PyArrayDyn, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::errors::file_error;

/// Reads a reduced gear into a dict of NumPy arrays and numbers, SI units.
///
/// c_hub has the axes load tooth in sector, load flank, response tooth, response flank, load, response (m/N); c_tooth
/// flank, load, response. A load is roll station * len(z_m) + axial station. gauges is a list of dicts with adjoint
/// (tooth, flank, load, component) and own_tooth (flank, load) in 1/N. near_field, the calibration of the local term,
/// is a dict with contact_m2_per_n (place) and mesh_m2_per_n (flank, load station, response station), or None in old
/// files. crack, which is not in c_hub, is a dict with rows (row, tooth, load) whose products over the row are what it
/// adds for loads on its side, or None.
#[pyfunction]
pub(crate) fn read_reduced(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, PyDict>> {
    let gear = py
        .detach(|| gearmesh_model::read_reduced_gear(&path))
        .map_err(file_error)?;
    let (teeth, hands, loads) = (gear.teeth, gear.flanks.len(), gear.grid.len());
    let (own, stations) = (gear.teeth_per_sector(), gear.grid.roll_angles_rad.len());
    let result = PyDict::new(py);
    let gauges = gear
        .gauges
        .iter()
        .map(|gauge| gauge_dict(py, &gear, gauge))
        .collect::<PyResult<Vec<_>>>()?;
    result.set_item("gauges", PyList::new(py, gauges)?)?;
    let c_hub = gear.c_hub_in_full().into_owned();
    result.set_item("name", gear.name)?;
    result.set_item("input_toml", gear.input.text)?;
    result.set_item("teeth", teeth)?;
    result.set_item("sectors", gear.sectors)?;
    result.set_item("base_radius_m", gear.base_radius_m)?;
    result.set_item("face_width_m", gear.face_width_m)?;
    result.set_item("young_pa", gear.young_pa)?;
    result.set_item("poisson", gear.poisson)?;
    let roll_angles_rad = PyArray1::from_vec(py, gear.grid.roll_angles_rad);
    result.set_item("roll_angles_rad", roll_angles_rad)?;
    result.set_item("z_m", PyArray1::from_vec(py, gear.grid.z_m))?;
    result.set_item("slices", gear.grid.slices)?;
    let flanks: Vec<_> = gear.flanks.iter().map(ToString::to_string).collect();
    result.set_item("flanks", flanks)?;
    let c_hub = shaped(py, c_hub, vec![own, hands, teeth, hands, loads, loads])?;
    result.set_item("c_hub", c_hub)?;
    let c_tooth = shaped(py, gear.c_tooth, vec![hands, loads, loads])?;
    result.set_item("c_tooth", c_tooth)?;
    let opposite = shaped(py, gear.opposite_distance_m, vec![hands, stations])?;
    result.set_item("opposite_distance_m", opposite)?;
    let near_field = gear.near_field;
    let near_field = near_field.map(|field| near_field_dict(py, field, hands, stations));
    result.set_item("near_field", near_field.transpose()?)?;
    let crack = gear.crack.map(|crack| crack_dict(py, crack, teeth, loads));
    result.set_item("crack", crack.transpose()?)?;
    let provenance = PyDict::new(py);
    provenance.set_item("program", gear.provenance.program)?;
    provenance.set_item("version", gear.provenance.version)?;
    provenance.set_item("created_utc", gear.provenance.created_utc)?;
    provenance.set_item("threads", gear.provenance.threads)?;
    provenance.set_item("element", gear.provenance.element)?;
    provenance.set_item("nodes", gear.provenance.nodes)?;
    provenance.set_item("elements", gear.provenance.elements)?;
    provenance.set_item("dofs", gear.provenance.dofs)?;
    provenance.set_item("stage_seconds", gear.provenance.stage_seconds)?;
    result.set_item("provenance", provenance)?;
    let checks = PyDict::new(py);
    checks.set_item("symmetry", gear.checks.symmetry)?;
    checks.set_item("pattern_identity", gear.checks.pattern_identity)?;
    for (name, value) in gear.checks.further {
        checks.set_item(name, value)?;
    }
    result.set_item("checks", checks)?;
    Ok(result)
}

fn crack_dict(
    py: Python<'_>,
    crack: RootCrack,
    teeth: usize,
    loads: usize,
) -> PyResult<Bound<'_, PyDict>> {
    let result = PyDict::new(py);
    result.set_item("tooth", crack.tooth)?;
    result.set_item("side", crack.side.to_string())?;
    result.set_item("mouth_radius_m", crack.mouth_radius_m)?;
    result.set_item("depth_m", crack.depth_m)?;
    result.set_item("angle_rad", crack.angle_rad)?;
    result.set_item("left_out", crack.left_out)?;
    let rows = crack.count(teeth, loads);
    result.set_item("rows", shaped(py, crack.rows, vec![rows, teeth, loads])?)?;
    Ok(result)
}

fn near_field_dict(
    py: Python<'_>,
    field: NearField,
    hands: usize,
    stations: usize,
) -> PyResult<Bound<'_, PyDict>> {
    let result = PyDict::new(py);
    result.set_item("half_width_m", field.half_width_m)?;
    result.set_item("element_m", field.element_m)?;
    result.set_item("residual", field.residual)?;
    let roll_angles_rad = PyArray1::from_vec(py, field.roll_angles_rad);
    result.set_item("roll_angles_rad", roll_angles_rad)?;
    let contact = PyArray1::from_vec(py, field.contact_m2_per_n);
    result.set_item("contact_m2_per_n", contact)?;
    let mesh = shaped(py, field.mesh_m2_per_n, vec![hands, stations, stations])?;
    result.set_item("mesh_m2_per_n", mesh)?;
    Ok(result)
}

fn gauge_dict<'py>(
    py: Python<'py>,
    gear: &ReducedGear,
    gauge: &GaugeRows,
) -> PyResult<Bound<'py, PyDict>> {
    let (teeth, hands, loads) = (gear.teeth, gear.flanks.len(), gear.grid.len());
    let result = PyDict::new(py);
    result.set_item("name", &gauge.name)?;
    result.set_item("tooth", gauge.tooth)?;
    result.set_item("side", gauge.side.to_string())?;
    result.set_item("description", &gauge.description)?;
    result.set_item("error_estimate_relative", gauge.error_estimate_relative)?;
    let adjoint = shaped(py, gauge.adjoint.clone(), vec![teeth, hands, loads, 3])?;
    result.set_item("adjoint", adjoint)?;
    let own_tooth = shaped(py, gauge.own_tooth.clone(), vec![hands, loads])?;
    result.set_item("own_tooth", own_tooth)?;
    Ok(result)
}

fn shaped<T: Element>(
    py: Python<'_>,
    values: Vec<T>,
    shape: Vec<usize>,
) -> PyResult<Bound<'_, PyArrayDyn<T>>> {
    PyArray1::from_vec(py, values).reshape(shape)
}
