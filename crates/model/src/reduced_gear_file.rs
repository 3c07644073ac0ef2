//! The file of a reduced gear: the contract between the offline and the online side on disk.

use std::path::Path;

use crate::crack_file::{put_crack, take_crack};
use crate::data_tree::{DataArray, DataTree, FileFormat, Values};
use crate::dynamics_file::{
    Sizes, put_dynamics, take_modes, take_reference_point, take_rigid_body,
};
use crate::file_error::FileError;
use crate::near_field::NearField;
use crate::reduced_gear::{FlankGrid, GaugeRows, Provenance, ReducedGear, ReductionChecks};
use gearmesh_geometry::Flank;

/// Name and version of the reduced gear file.
pub const REDUCED_GEAR_FORMAT: FileFormat = FileFormat {
    name: "gearmesh reduced gear",
    // 2: near field; 3: rigid body, reference point, modes; 4: crack
    version: 4,
};

pub(crate) const GEAR_FRAME: &str = "gear: right-handed, z the axis, zero at mid-face, tooth 0 centred on +x, teeth counter-clockwise";
pub(crate) const NORMAL: &str =
    "inward normal of the flank at each point, positive into the material";
pub(crate) const FLANK_COMPONENTS: &str =
    "flank: inward normal, profile tangential towards the tip, axial +z";

/// Writes a reduced gear, atomically.
///
/// # Errors
/// [`FileError::ReducedGear`] for a gear that contradicts itself, otherwise as [`DataTree::write`].
pub fn write_reduced_gear(path: &Path, gear: &ReducedGear) -> Result<(), FileError> {
    gear.validate().map_err(|source| FileError::ReducedGear {
        path: path.to_owned(),
        source,
    })?;
    let mut tree = DataTree::default();
    put_gear(&mut tree, gear);
    put_compliance(&mut tree, gear);
    if let Some(near_field) = &gear.near_field {
        put_near_field(&mut tree, gear, near_field);
    }
    for (index, gauge) in gear.gauges.iter().enumerate() {
        put_gauge(&mut tree, gear, index, gauge);
    }
    put_dynamics(&mut tree, gear);
    if let Some(crack) = &gear.crack {
        put_crack(&mut tree, crack, gear.teeth, gear.grid.len());
    }
    put_provenance(&mut tree, &gear.provenance);
    put_named_numbers(
        &mut tree,
        "checks",
        "1",
        "relative error of an identity",
        &named_checks(&gear.checks),
    );
    tree.write(path, &REDUCED_GEAR_FORMAT)
}

/// Reads a reduced gear and checks it.
///
/// # Errors
/// Every kind of [`FileError`] except those about meshes; each names the file and the item.
pub fn read_reduced_gear(path: &Path) -> Result<ReducedGear, FileError> {
    let mut tree = DataTree::read(path, &REDUCED_GEAR_FORMAT)?;
    let (teeth, sectors) = (
        tree.take_count(path, "gear/teeth")?,
        tree.take_count(path, "gear/sectors")?,
    );
    let [stations] = tree.shape(path, "grid/roll_angles")?;
    let [axial_stations] = tree.shape(path, "grid/z")?;
    let [hands] = tree.shape(path, "grid/flanks")?;
    let grid = FlankGrid {
        roll_angles_rad: tree.take_f64(path, "grid/roll_angles", &[stations])?,
        z_m: tree.take_f64(path, "grid/z", &[axial_stations])?,
        slices: tree.take_count(path, "grid/slices")?,
    };
    let flanks = tree.take_u32(path, "grid/flanks", &[hands])?;
    let flanks = flanks
        .into_iter()
        .map(|code| flank_of(path, "grid/flanks", code))
        .collect::<Result<_, _>>()?;
    let loads = grid.len();
    // `sectors` may be zero in a faulty file; the division is repeated by `validate`, which says so.
    let own = teeth.checked_div(sectors).unwrap_or_default();
    let gauges = tree.children("gauges").len();
    let gauges = (0..gauges).map(|index| take_gauge(&mut tree, path, index, [teeth, hands, loads]));
    let gauges: Vec<GaugeRows> = gauges.collect::<Result<_, _>>()?;
    let sizes = Sizes {
        teeth,
        hands,
        loads,
        gauges: gauges.len(),
    };
    let gear = ReducedGear {
        name: tree.take_text(path, "gear/name")?,
        input_toml: tree.take_text(path, "gear/input_toml")?,
        teeth,
        sectors,
        base_radius_m: tree.take_scalar(path, "gear/base_radius")?,
        face_width_m: tree.take_scalar(path, "gear/face_width")?,
        young_pa: tree.take_scalar(path, "gear/young")?,
        poisson: tree.take_scalar(path, "gear/poisson")?,
        grid,
        flanks,
        c_hub: tree.take_f64(
            path,
            "compliance/c_hub",
            &[own, hands, teeth, hands, loads, loads],
        )?,
        c_tooth: tree.take_f64(path, "compliance/c_tooth", &[hands, loads, loads])?,
        opposite_distance_m: tree.take_f64(
            path,
            "compliance/opposite_distance",
            &[hands, stations],
        )?,
        near_field: take_near_field(&mut tree, path, hands, stations)?,
        gauges,
        rigid_body: take_rigid_body(&mut tree, path)?,
        reference_point: take_reference_point(&mut tree, path, sizes)?,
        modes: take_modes(&mut tree, path, sizes)?,
        crack: take_crack(&mut tree, path, teeth, loads)?,
        provenance: take_provenance(&mut tree, path)?,
        checks: take_checks(&mut tree, path)?,
    };
    gear.validate().map_err(|source| FileError::ReducedGear {
        path: path.to_owned(),
        source,
    })?;
    Ok(gear)
}

fn put_gear(tree: &mut DataTree, gear: &ReducedGear) {
    tree.put_text("gear/name", &gear.name);
    tree.put_text("gear/input_toml", &gear.input_toml);
    tree.put("gear/teeth", count(gear.teeth, "number of teeth"));
    tree.put(
        "gear/sectors",
        count(gear.sectors, "number of equal sectors of the body"),
    );
    tree.put(
        "gear/base_radius",
        DataArray::scalar(gear.base_radius_m, "m", "base circle radius"),
    );
    tree.put(
        "gear/face_width",
        DataArray::scalar(gear.face_width_m, "m", "face width"),
    );
    tree.put(
        "gear/young",
        DataArray::scalar(gear.young_pa, "Pa", "Young's modulus"),
    );
    tree.put(
        "gear/poisson",
        DataArray::scalar(gear.poisson, "1", "Poisson's ratio"),
    );
    let grid = &gear.grid;
    let axes = [("roll station", grid.roll_angles_rad.len())];
    let array = DataArray::new(
        Values::F64(grid.roll_angles_rad.clone()),
        &axes,
        "rad",
        "roll angles tan(alpha)",
    );
    tree.put("grid/roll_angles", array);
    let array = DataArray::new(
        Values::F64(grid.z_m.clone()),
        &[("axial station", grid.z_m.len())],
        "m",
        "axial positions",
    );
    tree.put("grid/z", array.in_frame(GEAR_FRAME));
    tree.put(
        "grid/slices",
        count(grid.slices, "slices across the face width"),
    );
    let codes = gear.flanks.iter().map(|&flank| code_of(flank)).collect();
    let description = "hands that carry loads: 0 right (faces clockwise), 1 left";
    tree.put(
        "grid/flanks",
        DataArray::new(
            Values::U32(codes),
            &[("flank", gear.flanks.len())],
            "1",
            description,
        ),
    );
}

fn put_compliance(tree: &mut DataTree, gear: &ReducedGear) {
    let (hands, loads) = (gear.flanks.len(), gear.grid.len());
    let axes = [
        ("load tooth in sector", gear.teeth_per_sector()),
        ("load flank", hands),
        ("response tooth", gear.teeth),
        ("response flank", hands),
        ("load: roll station, axial station", loads),
        ("response: roll station, axial station", loads),
    ];
    let description = "deflection at the response point per force at the load point, hub held";
    let array = DataArray::new(Values::F64(gear.c_hub.clone()), &axes, "m/N", description);
    tree.put("compliance/c_hub", array.in_frame(NORMAL));
    let axes = [("flank", hands), axes[4], axes[5]];
    let description = "the same on the tooth-only submodel, equal for all teeth";
    let array = DataArray::new(Values::F64(gear.c_tooth.clone()), &axes, "m/N", description);
    tree.put("compliance/c_tooth", array.in_frame(NORMAL));
    let axes = [
        ("flank", hands),
        ("roll station", gear.grid.roll_angles_rad.len()),
    ];
    let description = "distance along the normal to the opposite side of the tooth";
    let array = DataArray::new(
        Values::F64(gear.opposite_distance_m.clone()),
        &axes,
        "m",
        description,
    );
    tree.put("compliance/opposite_distance", array.in_frame(NORMAL));
}

fn put_near_field(tree: &mut DataTree, gear: &ReducedGear, near_field: &NearField) {
    let at = |item: &str| format!("near_field/{item}");
    let mut scalar = |item: &str, value: f64, unit: &str, description: &str| {
        tree.put(at(item), DataArray::scalar(value, unit, description));
    };
    scalar(
        "half_width",
        near_field.half_width_m,
        "m",
        "half width of the calibrating Hertz pressure",
    );
    scalar(
        "element",
        near_field.element_m,
        "m",
        "element length at the load of the finer mesh behind the contact compliance",
    );
    scalar(
        "residual",
        near_field.residual,
        "1",
        "largest relative step from that mesh to the extrapolated contact compliance",
    );
    let places = [("place", near_field.roll_angles_rad.len())];
    let array = DataArray::new(
        Values::F64(near_field.roll_angles_rad.clone()),
        &places,
        "rad",
        "roll angles tan(alpha) of the places",
    );
    tree.put(at("roll_angles"), array);
    let description = "deflection of the contact centre per line load, tooth-only submodel, plane strain, fine mesh";
    let array = DataArray::new(
        Values::F64(near_field.contact_m2_per_n.clone()),
        &places,
        "m^2/N",
        description,
    );
    tree.put(at("contact"), array.in_frame(NORMAL));
    let stations = gear.grid.roll_angles_rad.len();
    let axes = [
        ("flank", gear.flanks.len()),
        ("load: roll station", stations),
        ("response: roll station", stations),
    ];
    let description = "the same per line load of a hat, the gear's own mesh and hats";
    let array = DataArray::new(
        Values::F64(near_field.mesh_m2_per_n.clone()),
        &axes,
        "m^2/N",
        description,
    );
    tree.put(at("mesh"), array.in_frame(NORMAL));
}

/// Files of version 1 have no such group.
fn take_near_field(
    tree: &mut DataTree,
    path: &Path,
    hands: usize,
    stations: usize,
) -> Result<Option<NearField>, FileError> {
    let at = |item: &str| format!("near_field/{item}");
    if tree.children("near_field").is_empty() {
        return Ok(None);
    }
    let [places] = tree.shape(path, &at("roll_angles"))?;
    Ok(Some(NearField {
        half_width_m: tree.take_scalar(path, &at("half_width"))?,
        roll_angles_rad: tree.take_f64(path, &at("roll_angles"), &[places])?,
        contact_m2_per_n: tree.take_f64(path, &at("contact"), &[places])?,
        mesh_m2_per_n: tree.take_f64(path, &at("mesh"), &[hands, stations, stations])?,
        element_m: tree.take_scalar(path, &at("element"))?,
        residual: tree.take_scalar(path, &at("residual"))?,
    }))
}

fn put_gauge(tree: &mut DataTree, gear: &ReducedGear, index: usize, gauge: &GaugeRows) {
    let at = |item: &str| format!("gauges/{index}/{item}");
    tree.put_text(at("name"), &gauge.name);
    tree.put_text(at("description"), &gauge.description);
    tree.put(at("tooth"), count(gauge.tooth, "tooth the gauge sits on"));
    tree.put(
        at("side"),
        DataArray::count(code_of(gauge.side), "side of the tooth: 0 right, 1 left"),
    );
    let error = DataArray::scalar(
        gauge.error_estimate_relative,
        "1",
        "estimated relative discretisation error",
    );
    tree.put(at("error_estimate"), error);
    let (hands, loads) = (gear.flanks.len(), gear.grid.len());
    let load = ("load: roll station, axial station", loads);
    let axes = [
        ("tooth", gear.teeth),
        ("flank", hands),
        load,
        ("component", 3),
    ];
    let array = DataArray::new(
        Values::F64(gauge.adjoint.clone()),
        &axes,
        "1/N",
        "strain per force, method 2",
    );
    tree.put(at("adjoint"), array.in_frame(FLANK_COMPONENTS));
    let axes = [("flank", hands), load];
    let description = "strain per force on the own tooth that method 1 leaves out";
    let array = DataArray::new(
        Values::F64(gauge.own_tooth.clone()),
        &axes,
        "1/N",
        description,
    );
    tree.put(at("own_tooth"), array.in_frame(NORMAL));
}

fn take_gauge(
    tree: &mut DataTree,
    path: &Path,
    index: usize,
    sizes: [usize; 3],
) -> Result<GaugeRows, FileError> {
    let [teeth, hands, loads] = sizes;
    let at = |item: &str| format!("gauges/{index}/{item}");
    let side = tree.take_count(path, &at("side"))? as u32;
    Ok(GaugeRows {
        name: tree.take_text(path, &at("name"))?,
        tooth: tree.take_count(path, &at("tooth"))?,
        side: flank_of(path, &at("side"), side)?,
        description: tree.take_text(path, &at("description"))?,
        error_estimate_relative: tree.take_scalar(path, &at("error_estimate"))?,
        adjoint: tree.take_f64(path, &at("adjoint"), &[teeth, hands, loads, 3])?,
        own_tooth: tree.take_f64(path, &at("own_tooth"), &[hands, loads])?,
    })
}

fn put_provenance(tree: &mut DataTree, provenance: &Provenance) {
    let at = |item: &str| format!("provenance/{item}");
    tree.put_text(at("program"), &provenance.program);
    tree.put_text(at("version"), &provenance.version);
    tree.put_text(at("created_utc"), &provenance.created_utc);
    tree.put_text(at("element"), &provenance.element);
    tree.put(at("threads"), count(provenance.threads, "threads used"));
    tree.put(
        at("nodes"),
        count(provenance.nodes, "nodes of the finite element model"),
    );
    tree.put(
        at("elements"),
        count(provenance.elements, "elements of the model"),
    );
    tree.put(
        at("dofs"),
        count(provenance.dofs, "free degrees of freedom of the model"),
    );
    put_named_numbers(
        tree,
        "provenance/stage",
        "s",
        "wall-clock time of a stage",
        &provenance.stage_seconds,
    );
    put_named_numbers(
        tree,
        "provenance/effort",
        "1",
        "a count of what was done",
        &provenance.effort,
    );
}

fn take_provenance(tree: &mut DataTree, path: &Path) -> Result<Provenance, FileError> {
    let at = |item: &str| format!("provenance/{item}");
    Ok(Provenance {
        program: tree.take_text(path, &at("program"))?,
        version: tree.take_text(path, &at("version"))?,
        created_utc: tree.take_text(path, &at("created_utc"))?,
        threads: tree.take_count(path, &at("threads"))?,
        element: tree.take_text(path, &at("element"))?,
        nodes: tree.take_count(path, &at("nodes"))?,
        elements: tree.take_count(path, &at("elements"))?,
        dofs: tree.take_count(path, &at("dofs"))?,
        stage_seconds: take_named_numbers(tree, path, "provenance/stage")?,
        effort: take_named_numbers(tree, path, "provenance/effort")?,
    })
}

fn named_checks(checks: &ReductionChecks) -> Vec<(String, f64)> {
    let mut named = vec![
        ("symmetry".to_owned(), checks.symmetry),
        ("pattern_identity".to_owned(), checks.pattern_identity),
    ];
    named.extend(checks.further.iter().cloned());
    named
}

fn take_checks(tree: &mut DataTree, path: &Path) -> Result<ReductionChecks, FileError> {
    let mut named = take_named_numbers(tree, path, "checks")?.into_iter();
    let mut next = |name: &str| match named.next() {
        Some((found, value)) if found == name => Ok(value),
        _ => Err(FileError::Missing {
            path: path.to_owned(),
            item: format!("check \"{name}\""),
        }),
    };
    let (symmetry, pattern_identity) = (next("symmetry")?, next("pattern_identity")?);
    Ok(ReductionChecks {
        symmetry,
        pattern_identity,
        further: named.collect(),
    })
}

/// An ordered list of named numbers as `group/index/{name, value}`: the names are free text.
fn put_named_numbers(
    tree: &mut DataTree,
    group: &str,
    unit: &str,
    description: &str,
    numbers: &[(String, f64)],
) {
    for (index, (name, value)) in numbers.iter().enumerate() {
        tree.put_text(format!("{group}/{index}/name"), name);
        tree.put(
            format!("{group}/{index}/value"),
            DataArray::scalar(*value, unit, description),
        );
    }
}

fn take_named_numbers(
    tree: &mut DataTree,
    path: &Path,
    group: &str,
) -> Result<Vec<(String, f64)>, FileError> {
    let count = tree.children(group).len();
    let mut take = |index| {
        let name = tree.take_text(path, &format!("{group}/{index}/name"))?;
        Ok((
            name,
            tree.take_scalar(path, &format!("{group}/{index}/value"))?,
        ))
    };
    (0..count).map(&mut take).collect()
}

/// Counts beyond 32 bits saturate; only nodes and degrees of freedom could ever come near.
fn count(value: usize, description: &str) -> DataArray {
    DataArray::count(u32::try_from(value).unwrap_or(u32::MAX), description)
}

pub(crate) fn code_of(flank: Flank) -> u32 {
    match flank {
        Flank::Right => 0,
        Flank::Left => 1,
    }
}

pub(crate) fn flank_of(path: &Path, item: &str, code: u32) -> Result<Flank, FileError> {
    match code {
        0 => Ok(Flank::Right),
        1 => Ok(Flank::Left),
        _ => Err(FileError::WrongType {
            path: path.to_owned(),
            item: format!("\"{item}\""),
            found: format!("the code {code}"),
            expected: "0 (right) or 1 (left)",
        }),
    }
}
