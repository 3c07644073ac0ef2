//! HDF5 files with a good seal and faults inside: models whose arrays and texts were changed, and files whose bytes
//! were.

use crate::common::{ends, program};
use crate::pair_common::made_up_models::{small_crack, small_reduced_gear};
use crate::{fuzz, mutation};
use fastrand::Rng;
use gearmesh_model::{
    CellKind, DataTree, Field, MESH_FORMAT, MeshData, REDUCED_GEAR_FORMAT, Values, bytes_digest,
    read_mesh, read_reduced_gear, write_mesh, write_reduced_gear,
};
use std::path::Path;
use std::time::Duration;

const COUNTS: [u32; 8] = [0, 1, 2, 3, 7, 1000, u32::MAX / 2, u32::MAX];

const VALUES: [f64; 10] = [
    0.0,
    -0.0,
    -1.0,
    1e-300,
    1e300,
    f64::INFINITY,
    f64::NEG_INFINITY,
    1e9,
    0.5,
    1e-9,
];

/// A tree with one to three arrays, shapes, texts or names changed.
pub fn changed(sound: &DataTree, random: &mut Rng) -> DataTree {
    let mut tree = sound.clone();
    for _ in 0..random.usize(1..=3) {
        let names: Vec<String> = tree.arrays.keys().cloned().collect();
        let name = &names[random.usize(..names.len())];
        let Some(array) = tree.arrays.get_mut(name) else {
            continue;
        };
        match random.u8(..7) {
            0..=2 => match &mut array.values {
                Values::F64(values) if !values.is_empty() => {
                    let place = random.usize(..values.len());
                    values[place] = VALUES[random.usize(..VALUES.len())];
                }
                Values::U32(values) if !values.is_empty() => {
                    let place = random.usize(..values.len());
                    values[place] = COUNTS[random.usize(..COUNTS.len())];
                }
                _ => {}
            },
            3 => {
                // Fewer or more along one axis.
                if let Some(axis) =
                    (!array.shape.is_empty()).then(|| random.usize(..array.shape.len()))
                {
                    array.shape[axis] = random.usize(..4);
                    let size = array.shape.iter().product();
                    match &mut array.values {
                        Values::F64(values) => values.resize(size, 0.5),
                        Values::U32(values) => values.resize(size, 1),
                    }
                }
            }
            4 => drop(tree.arrays.remove(name)),
            5 => {
                let texts: Vec<String> = tree.texts.keys().cloned().collect();
                if let Some(name) = texts.get(random.usize(..texts.len().max(1))) {
                    tree.texts.remove(name);
                }
            }
            _ => {
                let array = array.clone();
                tree.arrays.insert(format!("{name}x"), array);
            }
        }
    }
    tree
}

/// A case of a tree is the file itself, so that a finding can be looked at.
pub fn file_of(tree: &DataTree, path: &Path, format: &gearmesh_model::FileFormat) -> Vec<u8> {
    match tree.write(path, format) {
        Ok(()) => std::fs::read(path).unwrap(),
        // What the writer refuses is no file.
        Err(_) => Vec::new(),
    }
}

#[test]
fn models() {
    let desk = tempfile::tempdir().unwrap();
    let (made, case) = (desk.path().join("made.h5"), desk.path().join("case.h5"));
    let mut gear = small_reduced_gear();
    gear.crack = Some(small_crack());
    write_reduced_gear(&made, &gear).unwrap();
    let sound = DataTree::read(&made, &REDUCED_GEAR_FORMAT).unwrap();
    let make = |random: &mut Rng| file_of(&changed(&sound, random), &made, &REDUCED_GEAR_FORMAT);
    fuzz("model", 60, make, |bytes| {
        std::fs::write(&case, bytes).unwrap();
        answered_model(&case);
    });
}

/// Reads a model; one that is taken can be used.
pub fn answered_model(path: &Path) -> bool {
    let Ok(gear) = read_reduced_gear(path) else {
        return false;
    };
    for tooth in [0, gear.teeth - 1] {
        for &flank in &gear.flanks {
            let block = gear.c_g_block(tooth, flank, 0, gear.flanks[0]);
            assert_eq!(block.len(), gear.grid.len() * gear.grid.len());
        }
    }
    if let Some(field) = &gear.near_field {
        let _ = field.contact_at(0.3, gear.base_radius_m);
    }
    if let Some(modes) = &gear.modes {
        let _ = modes.frequencies_hz();
    }
    let _ = gearmesh_contact::SliceLayout::of_models([&gear, &gear], 0.0).check();
    true
}

pub fn small_mesh() -> MeshData {
    let corner = |k: usize| [k & 1, (k >> 1) & 1, k >> 2].map(|x| x as f64 * 1e-3);
    let mut mesh = MeshData {
        points: [0, 1, 3, 2, 4, 5, 7, 6].map(corner).to_vec(),
        ..MeshData::default()
    };
    mesh.cells.insert(CellKind::Hex8, (0..8).collect());
    mesh.point_sets.insert("bore".into(), vec![0, 1, 2]);
    let field = |values: Vec<f64>| Field {
        components: 1,
        values,
        unit: "m".into(),
    };
    mesh.point_fields.insert("u".into(), field(vec![0.5; 8]));
    mesh.cell_fields.insert("s".into(), field(vec![0.5]));
    mesh
}

#[test]
fn meshes() {
    let desk = tempfile::tempdir().unwrap();
    let (made, case) = (desk.path().join("made.h5"), desk.path().join("case.h5"));
    write_mesh(&made, &small_mesh()).unwrap();
    let sound = DataTree::read(&made, &MESH_FORMAT).unwrap();
    let make = |random: &mut Rng| file_of(&changed(&sound, random), &made, &MESH_FORMAT);
    fuzz("mesh", 60, make, |bytes| {
        std::fs::write(&case, bytes).unwrap();
        answered_mesh(&case);
    });
}

/// Reads a mesh; one that is taken names nodes that it has.
pub fn answered_mesh(path: &Path) -> bool {
    let Ok(mesh) = read_mesh(path) else {
        return false;
    };
    let nodes = mesh.points.len() as u32;
    assert!(mesh.cells.values().flatten().all(|node| *node < nodes));
    assert!(mesh.point_sets.values().flatten().all(|node| *node < nodes));
    true
}

/// Length of the seal.
const SEAL: usize = 512;

/// The bytes under a seal that fits them.
pub fn sealed(mut bytes: Vec<u8>) -> Vec<u8> {
    let digest = bytes_digest(&bytes[SEAL..]);
    let mut seal =
        format!("gearmesh seal 1\nbytes {}\nblake3 {digest}\n", bytes.len()).into_bytes();
    seal.resize(SEAL, 0);
    bytes[..SEAL].copy_from_slice(&seal);
    bytes
}

/// Time after which the program counts as one that never ends.
const FOREVER: Duration = Duration::from_secs(60);

/// Faults that libhdf5 has to see: in the program, whose end by a signal does not end the test.
#[test]
fn bytes_of_hdf5_files() {
    let desk = tempfile::tempdir().unwrap();
    let (made, case) = (desk.path().join("made.h5"), desk.path().join("case.h5"));
    write_reduced_gear(&made, &small_reduced_gear()).unwrap();
    let sound = std::fs::read(&made).unwrap();
    assert_eq!(sealed(sound.clone()), sound);
    let make = |random: &mut Rng| sealed(mutation::bytes(&sound, SEAL, random));
    fuzz("hdf5", 20, make, |bytes| {
        std::fs::write(&case, bytes).unwrap();
        let answer = ends(program(&["check".as_ref(), case.as_os_str()]), FOREVER);
        assert!(matches!(answer.code, Some(0 | 2)), "{answer:#?}");
    });
}
