//! A damaged, foreign or contradictory file is a typed error that names the file; never a panic, never a number.

use std::path::{Path, PathBuf};

use crate::made_up_models::{small_bevel_gear, small_reduced_gear};
use gearmesh_model::{
    DataArray, DataTree, FileError, FileFormat, REDUCED_GEAR_FORMAT, Values, read_reduced_gear,
    write_reduced_gear,
};
use proptest::prelude::*;

struct Sample {
    _folder: tempfile::TempDir,
    path: PathBuf,
    bytes: Vec<u8>,
}

fn sample() -> Sample {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("gear.h5");
    write_reduced_gear(&path, &small_reduced_gear()).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    Sample {
        _folder: folder,
        path,
        bytes,
    }
}

fn error_of(path: &Path) -> FileError {
    let error = read_reduced_gear(path).unwrap_err();
    assert!(
        error.to_string().contains("gear.h5"),
        "does not name the file: {error}"
    );
    error
}

#[test]
fn truncated_at_any_length() {
    let Sample { path, bytes, .. } = &sample();
    let lengths = [
        1,
        8,
        100,
        511,
        512,
        513,
        2048,
        bytes.len() / 2,
        bytes.len() - 1,
    ];
    for length in lengths {
        std::fs::write(path, &bytes[..length]).unwrap();
        let error = error_of(path);
        assert!(
            matches!(error, FileError::Truncated { found_bytes, .. } if found_bytes == length as u64),
            "{error}"
        );
    }
    std::fs::write(path, "").unwrap();
    assert!(matches!(error_of(path), FileError::NotAGearmeshFile { .. }));
}

#[test]
fn longer_than_written() {
    let Sample { path, bytes, .. } = &sample();
    std::fs::write(path, [bytes, &b"x"[..]].concat()).unwrap();
    assert!(matches!(error_of(path), FileError::Altered { .. }));
}

#[test]
fn flipped_bit_in_data_attribute_name_and_seal() {
    let Sample { path, bytes, .. } = &sample();
    let gear = small_reduced_gear();
    let find = |needle: &[u8]| {
        bytes
            .windows(needle.len())
            .position(|window| window == needle)
            .unwrap()
    };
    let places = [
        find(&gear.c_hub[40].to_le_bytes()),
        find(&gear.gauges[0].adjoint[5].to_le_bytes()),
        find(b"m/N"),
        find(b"unitSI"),
        find(b"opposite_distance"),
        find(b"# made up"),
        find(b"bytes "),
        find(b"blake3 ") + 10,
        400,
    ];
    for place in places {
        let mut altered = bytes.clone();
        altered[place] ^= 1;
        std::fs::write(path, &altered).unwrap();
        let error = error_of(path);
        assert!(
            matches!(error, FileError::Altered { .. }),
            "byte {place}: {error}"
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn any_flipped_bit_is_an_error(place in any::<prop::sample::Index>(), bit in 0..8_u8) {
        let sample = sample();
        let (path, mut bytes) = (&sample.path, sample.bytes.clone());
        let place = place.index(bytes.len());
        bytes[place] ^= 1 << bit;
        std::fs::write(path, &bytes).unwrap();
        prop_assert!(read_reduced_gear(path).is_err(), "byte {}", place);
    }
}

#[test]
fn foreign_files() {
    let Sample { path, bytes, .. } = &sample();
    for (content, word) in [
        (&b"name = \"gear\"\n"[..], "not HDF5"),
        (&bytes[512..], "HDF5 file of another origin"),
        (b"", "empty"),
    ] {
        std::fs::write(path, content).unwrap();
        let error = error_of(path);
        assert!(
            matches!(error, FileError::NotAGearmeshFile { .. }) && error.to_string().contains(word),
            "{error}"
        );
    }
    std::fs::remove_file(path).unwrap();
    assert!(matches!(
        error_of(path),
        FileError::Io { action: "open", .. }
    ));
}

#[test]
fn other_versions_and_formats() {
    let Sample { path, .. } = &sample();
    let tree = DataTree::read(path, &REDUCED_GEAR_FORMAT).unwrap();
    let newest = REDUCED_GEAR_FORMAT.version;
    for version in [0, newest + 1, newest + 3] {
        tree.write(
            path,
            &FileFormat {
                version,
                ..REDUCED_GEAR_FORMAT
            },
        )
        .unwrap();
        let error = error_of(path);
        assert!(
            matches!(error, FileError::UnknownVersion { found, newest: n, .. } if found == version && n == newest),
            "{error}"
        );
    }
    tree.write(
        path,
        &FileFormat {
            name: "gearmesh result",
            version: 1,
        },
    )
    .unwrap();
    assert!(matches!(error_of(path), FileError::WrongFormat { .. }));
}

/// Files with a good seal and wrong contents, as a faulty program would write them.
#[test]
fn every_missing_item_is_named() {
    let Sample { path, .. } = &sample();
    for gear in [small_reduced_gear(), small_bevel_gear()] {
        write_reduced_gear(path, &gear).unwrap();
        let good = DataTree::read(path, &REDUCED_GEAR_FORMAT).unwrap();
        for name in good.arrays.keys().chain(good.texts.keys()) {
            let mut tree = good.clone();
            tree.arrays.remove(name);
            tree.texts.remove(name);
            tree.write(path, &REDUCED_GEAR_FORMAT).unwrap();
            let error = error_of(path);
            let named =
                matches!(&error, FileError::Missing { item, .. } if item.contains(name.as_str()));
            assert!(named, "without {name}: {error}");
        }
    }
}

#[test]
fn wrong_figures_and_names_of_a_bevel_body() {
    let Sample { path, .. } = &sample();
    write_reduced_gear(path, &small_bevel_gear()).unwrap();
    let good = DataTree::read(path, &REDUCED_GEAR_FORMAT).unwrap();
    for name in good.arrays.keys().filter(|name| name.starts_with("bevel/")) {
        let mut tree = good.clone();
        let array = tree.arrays.get_mut(name).unwrap();
        let Values::F64(values) = &mut array.values else {
            continue;
        };
        values[0] = f64::INFINITY;
        tree.write(path, &REDUCED_GEAR_FORMAT).unwrap();
        let error = error_of(path);
        assert!(
            matches!(error, FileError::ReducedGear { .. }),
            "{name}: {error}"
        );
        let mut tree = good.clone();
        let array = tree.arrays.get_mut(name).unwrap();
        if array.shape.is_empty() {
            continue;
        }
        array.shape[0] += 1;
        let Values::F64(values) = &mut array.values else {
            continue;
        };
        values.resize(array.shape.iter().product(), 1.0);
        tree.write(path, &REDUCED_GEAR_FORMAT).unwrap();
        let error = error_of(path);
        assert!(
            matches!(error, FileError::WrongShape { .. }),
            "{name}: {error}"
        );
    }
    for (name, word) in [("bevel/member", "wheel"), ("bevel/hand", "sinister")] {
        let mut tree = good.clone();
        tree.texts.insert(name.to_owned(), word.to_owned());
        tree.write(path, &REDUCED_GEAR_FORMAT).unwrap();
        let message = error_of(path).to_string();
        assert!(message.contains(word), "{message}");
    }
}

#[test]
fn wrong_shapes_types_and_values() {
    let Sample { path, .. } = &sample();
    let good = DataTree::read(path, &REDUCED_GEAR_FORMAT).unwrap();
    let with = |name: &str, change: &dyn Fn(&mut DataArray)| {
        let mut tree = good.clone();
        change(tree.arrays.get_mut(name).unwrap());
        tree.write(path, &REDUCED_GEAR_FORMAT).unwrap();
        error_of(path)
    };
    let flatten = |array: &mut DataArray| array.shape = vec![array.values.len()];
    assert!(matches!(
        with("compliance/c_hub", &flatten),
        FileError::WrongShape { .. }
    ));
    assert!(matches!(
        with("gauges/1/adjoint", &flatten),
        FileError::WrongShape { .. }
    ));
    assert!(matches!(
        with("gear/teeth", &|array| array.values = Values::U32(vec![5])),
        FileError::WrongShape { .. }
    ));
    let counts = |array: &mut DataArray| array.values = Values::U32(vec![1; array.values.len()]);
    assert!(matches!(
        with("compliance/c_tooth", &counts),
        FileError::WrongType { .. }
    ));
    assert!(matches!(
        with("grid/flanks", &|array| array.values =
            Values::U32(vec![0, 2])),
        FileError::WrongType { .. }
    ));
    assert!(matches!(
        with("gear/sectors", &|array| array.values = Values::U32(vec![0])),
        FileError::WrongShape { .. }
    ));
    let poison = |array: &mut DataArray| {
        if let Values::F64(values) = &mut array.values {
            values[3] = f64::INFINITY;
        }
    };
    for name in [
        "compliance/c_hub",
        "compliance/c_tooth",
        "gauges/0/adjoint",
        "gauges/0/own_tooth",
        "rigid_body/inertia",
        "reference_point/flank",
        "modes/flank",
        "modes/gauges",
        "modes/coupling",
    ] {
        let error = with(name, &poison);
        let message = error.to_string();
        assert!(matches!(error, FileError::ReducedGear { .. }), "{message}");
        assert!(message.contains("inf at index 3"), "{message}");
    }
    let mut gear = small_reduced_gear();
    gear.c_hub[0] = f64::NAN;
    assert!(matches!(
        write_reduced_gear(path, &gear),
        Err(FileError::ReducedGear { .. })
    ));
}

/// What is no number is not written as one: the file is not there, or the older one stays.
#[test]
fn a_tree_with_something_that_is_no_number_is_not_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("result.h5");
    let format = FileFormat {
        name: "test",
        version: 1,
    };
    let mut tree = DataTree::default();
    let values =
        |values: [f64; 2]| DataArray::new(Values::F64(values.into()), &[("row", 2)], "m", "");
    tree.put("sound", values([1.0, f64::INFINITY]));
    tree.write(&path, &format).unwrap();
    let before = std::fs::read(&path).unwrap();
    tree.put("group/poisoned", values([1.0, f64::NAN]));
    let error = tree.write(&path, &format).unwrap_err();
    assert!(
        matches!(&error, FileError::NotANumber { item, index: 1, .. } if item == "group/poisoned"),
        "{error}"
    );
    assert_eq!(std::fs::read(&path).unwrap(), before);
}
