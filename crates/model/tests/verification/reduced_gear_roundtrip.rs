//! Whatever is written comes back equal, bit for bit.

use crate::made_up_models::{
    small_bevel_gear, small_crack, small_patterned_gear, small_reduced_gear,
};
use gearmesh_model::{
    DataArray, DataTree, FileError, FileFormat, Flank, FlankGrid, GaugeRows, ReducedGear,
    StoredGear, Values, file_digest, read_reduced_gear, write_reduced_gear,
};
use proptest::prelude::*;

#[test]
fn synthetic_gear_comes_back_equal() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("gear.h5");
    let gear = small_reduced_gear();
    let definition = gear.input.definition_in("synthetic.toml").unwrap();
    assert!(definition.blank.openings().is_some());
    write_reduced_gear(&path, &gear).unwrap();
    assert!(read_reduced_gear(&path).unwrap() == gear);
    let left_over = std::fs::read_dir(folder.path()).unwrap().count();
    assert_eq!(left_over, 1, "temporary files are left");
}

#[test]
fn a_gear_without_calibration_and_dynamics_comes_back_so() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("gear.h5");
    let mut gear = small_reduced_gear();
    gear.near_field = None;
    gear.rigid_body = None;
    gear.reference_point = None;
    gear.modes = None;
    write_reduced_gear(&path, &gear).unwrap();
    assert_eq!(read_reduced_gear(&path).unwrap(), gear);
}

#[test]
fn a_crack_comes_back_equal() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("gear.h5");
    let mut gear = small_reduced_gear();
    gear.crack = Some(small_crack());
    write_reduced_gear(&path, &gear).unwrap();
    let read = read_reduced_gear(&path).unwrap();
    assert_eq!(read, gear);
    assert!(read.crack_for(Flank::Right).is_some() && read.crack_for(Flank::Left).is_none());
}

#[test]
fn a_bevel_gear_comes_back_equal() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("gear.h5");
    let mut gear = small_bevel_gear();
    write_reduced_gear(&path, &gear).unwrap();
    assert_eq!(read_reduced_gear(&path).unwrap(), gear);
    gear.bevel.as_mut().unwrap().near_field = None;
    write_reduced_gear(&path, &gear).unwrap();
    assert_eq!(read_reduced_gear(&path).unwrap(), gear);
}

#[test]
fn a_second_file_replaces_the_first() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("gear.h5");
    let mut gear = small_reduced_gear();
    write_reduced_gear(&path, &gear).unwrap();
    let first = file_digest(&path).unwrap();
    gear.young_pa = 70e9;
    gear.gauges.clear();
    gear.modes = None;
    write_reduced_gear(&path, &gear).unwrap();
    assert_eq!(read_reduced_gear(&path).unwrap(), gear);
    assert_ne!(file_digest(&path).unwrap(), first);
}

#[cfg(unix)]
#[test]
fn others_may_read_the_file() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let (path, plain) = (folder.path().join("gear.h5"), folder.path().join("plain"));
    write_reduced_gear(&path, &small_reduced_gear()).unwrap();
    std::fs::write(&plain, "").unwrap();
    let mode = |path: &std::path::Path| path.metadata().unwrap().permissions().mode();
    assert_eq!(
        mode(&path),
        mode(&plain),
        "rights differ from those of any new file"
    );
}

/// Longer than the buffer of the seal's digest: everything is covered, also the last, shorter piece.
#[test]
fn long_files_are_covered_to_the_end() {
    let format = FileFormat {
        name: "test",
        version: 1,
    };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("tree.h5");
    let mut tree = DataTree::default();
    let values = (0..1_700_000).map(f64::from).collect();
    tree.put(
        "long",
        DataArray::new(
            Values::F64(values),
            &[("row", 1_700_000)],
            "1",
            "a long array",
        ),
    );
    tree.write(&path, &format).unwrap();
    assert_eq!(DataTree::read(&path, &format).unwrap(), tree);
    let mut bytes = std::fs::read(&path).unwrap();
    for value in [0.0_f64, 600_000.0, 1_699_999.0] {
        let needle = [value.to_le_bytes(), (value + 1.0).to_le_bytes()].concat();
        let needle = if value == 1_699_999.0 {
            &needle[..8]
        } else {
            &needle[..]
        };
        let place = bytes
            .windows(needle.len())
            .position(|window| window == needle)
            .unwrap();
        bytes[place] ^= 1;
        std::fs::write(&path, &bytes).unwrap();
        assert!(
            matches!(
                DataTree::read(&path, &format),
                Err(FileError::Altered { .. })
            ),
            "{value}"
        );
        bytes[place] ^= 1;
    }
    std::fs::write(&path, &bytes).unwrap();
    assert_eq!(DataTree::read(&path, &format).unwrap(), tree);
}

/// Arrays without entries, single numbers, texts without letters: the corners of the tree.
#[test]
fn odd_trees_come_back_equal() {
    let format = FileFormat {
        name: "test",
        version: 3,
    };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("tree.h5");
    let mut tree = DataTree::default();
    tree.write(&path, &format).unwrap();
    assert_eq!(DataTree::read(&path, &format).unwrap(), tree);

    tree.put(
        "empty",
        DataArray::new(Values::F64(vec![]), &[("nothing", 0), ("xyz", 3)], "m", ""),
    );
    tree.put(
        "no members",
        DataArray::new(Values::U32(vec![]), &[("member", 0)], "1", "ε, µm, Ψ"),
    );
    tree.put(
        "a/b/c/d",
        DataArray::scalar(f64::MIN_POSITIVE, "µm", "tiny").in_frame("world"),
    );
    tree.put("a/count", DataArray::count(u32::MAX, "largest"));
    tree.put_text("a/text", "");
    tree.put_text("long", "α\n".repeat(100_000));
    tree.attributes.insert("scene".to_owned(), String::new());
    tree.write(&path, &format).unwrap();
    assert_eq!(DataTree::read(&path, &format).unwrap(), tree);
    assert_eq!(tree.children("a"), ["b", "count", "text"]);
}

prop_compose! {
    fn any_gear()(own in 1_usize..3, sectors in 1_usize..4, stations in 2_usize..4, axial in 2_usize..4, both in any::<bool>())
        (
            c_hub in prop::collection::vec(-1e3..1e3_f64, own * own * sectors * (1 + 3 * usize::from(both)) * (stations * axial).pow(2)),
            c_tooth in prop::collection::vec(prop::num::f64::NORMAL, (1 + usize::from(both)) * (stations * axial).pow(2)),
            distances in prop::collection::vec(1e-6..1.0_f64, (1 + usize::from(both)) * stations),
            adjoint in prop::collection::vec(prop::num::f64::SUBNORMAL, 3 * own * sectors * (1 + usize::from(both)) * stations * axial),
            own_tooth in prop::collection::vec(prop::num::f64::ZERO, (1 + usize::from(both)) * stations * axial),
            (name, text) in ("[^\0]{0,20}", "[^\0]{0,200}"),
            (own, sectors, stations, axial, both) in Just((own, sectors, stations, axial, both)),
        ) -> ReducedGear {
        let gear = small_reduced_gear();
        let even = |count: usize, step: f64| (0..count).map(|i| step * i as f64).collect();
        ReducedGear {
            gauges: vec![GaugeRows { adjoint, own_tooth, tooth: own * sectors - 1, ..gear.gauges[0].clone() }],
            input: StoredGear::without_definition(text),
            teeth: own * sectors, sectors, name, c_hub, c_tooth,
            grid: FlankGrid { roll_angles_rad: even(stations, 0.1), z_m: even(axial, 0.003), slices: 1 },
            flanks: if both { vec![Flank::Left, Flank::Right] } else { vec![Flank::Right] },
            opposite_distance_m: distances,
            near_field: None, reference_point: None, modes: None,
            ..gear
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn any_gear_comes_back_equal(gear in any_gear()) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("gear.h5");
        write_reduced_gear(&path, &gear).unwrap();
        prop_assert_eq!(read_reduced_gear(&path).unwrap(), gear);
    }
}

/// Each entry by its formula (`hub_patterns.rs`), and a force here moves what is there as much as the other way round.
#[test]
fn blocks_are_sums_over_patterns() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("gear.h5");
    let gear = small_patterned_gear();
    write_reduced_gear(&path, &gear).unwrap();
    assert_eq!(read_reduced_gear(&path).unwrap(), gear);
    let patterns = gear.hub_patterns.as_ref().unwrap();
    let (loads, r) = (gear.grid.len(), patterns.count);
    let flanks = [Flank::Right, Flank::Left];
    for (a, b) in [(0, 0), (0, 3), (5, 2)] {
        for (f, g) in [(0, 0), (0, 1), (1, 0)] {
            let block = gear.c_hub_block(a, flanks[f], b, flanks[g]);
            let back = gear.c_hub_block(b, flanks[g], a, flanks[f]);
            for l in 0..loads {
                for m in 0..loads {
                    let (i, j) = (f * loads + l, g * loads + m);
                    let mut sum = if a == b {
                        patterns.own_tooth[i * 2 * loads + j]
                    } else {
                        0.0
                    };
                    for p in 0..r {
                        for q in 0..r {
                            let (load, response) = (a * r + p, b * r + q);
                            let (row, column) = (load.max(response), load.min(response));
                            let between = patterns.body[row * (row + 1) / 2 + column];
                            sum +=
                                patterns.shares[i * r + p] * between * patterns.shares[j * r + q];
                        }
                    }
                    let value = block[l * loads + m];
                    assert!((value - sum).abs() < 1e-12 * sum.abs().max(1e-9));
                    assert!((value - back[m * loads + l]).abs() < 1e-15);
                }
            }
        }
    }
    assert_eq!(gear.c_hub_in_full().len(), (gear.teeth * 2 * loads).pow(2));
}
