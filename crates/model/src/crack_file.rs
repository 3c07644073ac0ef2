//! The group of a reduced gear's file that describes a crack; optional, files before version 4 have none.

use std::path::Path;

use crate::data_tree::{DataArray, DataTree, Values};
use crate::file_error::FileError;
use crate::reduced_gear_file::{NORMAL, code_of, flank_of};
use crate::root_crack::RootCrack;

pub(crate) fn put_crack(tree: &mut DataTree, crack: &RootCrack, teeth: usize, loads: usize) {
    let at = |item: &str| format!("crack/{item}");
    let tooth = u32::try_from(crack.tooth).unwrap_or(u32::MAX);
    tree.put(at("tooth"), DataArray::count(tooth, "cracked tooth"));
    let side = "side on which it opens: 0 right, 1 left";
    tree.put(at("side"), DataArray::count(code_of(crack.side), side));
    for (item, value, unit, description) in [
        (
            "mouth_radius",
            crack.mouth_radius_m,
            "m",
            "radius of its mouth",
        ),
        ("depth", crack.depth_m, "m", "depth"),
        (
            "angle",
            crack.angle_rad,
            "rad",
            "angle to the tooth's centre line, 0 towards the gear's centre",
        ),
        (
            "left_out",
            crack.left_out,
            "1",
            "bound of the compliance that further rows would add, relative to the largest added",
        ),
    ] {
        tree.put(at(item), DataArray::scalar(value, unit, description));
    }
    let axes = [
        ("row", crack.count(teeth, loads)),
        ("tooth", teeth),
        ("load: roll station, axial station", loads),
    ];
    let description = "rows whose products are the compliance added by the crack, for loads on its side of the teeth";
    let array = DataArray::new(
        Values::F64(crack.rows.clone()),
        &axes,
        "(m/N)^0.5",
        description,
    );
    tree.put(at("rows"), array.in_frame(NORMAL));
}

pub(crate) fn take_crack(
    tree: &mut DataTree,
    path: &Path,
    teeth: usize,
    loads: usize,
) -> Result<Option<RootCrack>, FileError> {
    let at = |item: &str| format!("crack/{item}");
    if tree.children("crack").is_empty() {
        return Ok(None);
    }
    let [rows, _, _] = tree.shape(path, &at("rows"))?;
    let side = tree.take_count(path, &at("side"))? as u32;
    Ok(Some(RootCrack {
        tooth: tree.take_count(path, &at("tooth"))?,
        side: flank_of(path, &at("side"), side)?,
        mouth_radius_m: tree.take_scalar(path, &at("mouth_radius"))?,
        depth_m: tree.take_scalar(path, &at("depth"))?,
        angle_rad: tree.take_scalar(path, &at("angle"))?,
        rows: tree.take_f64(path, &at("rows"), &[rows, teeth, loads])?,
        left_out: tree.take_scalar(path, &at("left_out"))?,
    }))
}
