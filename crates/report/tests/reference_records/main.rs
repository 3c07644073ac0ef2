//! The records of the repository can be read, and the rig pipeline shows in them what the gears are known for; records
//! of unequal pairs.
#![allow(clippy::unwrap_used, reason = "a test")]

mod unequal_teeth;

use gearmesh_report::{
    PairOrders, Quantity, RecordKind, ReferenceRecord, RigView, Shaft, compare_with_column,
    comparison_table,
};
use std::path::Path;

const TORQUES_NM: [f64; 6] = [50.0, 100.0, 150.0, 200.0, 250.0, 300.0];

/// A rig on the driver of a pair of 57 and 57 teeth.
fn view() -> RigView {
    let pair = PairOrders {
        teeth: [57, 57],
        openings: [0, 3],
    };
    RigView::of(&pair, Shaft::Gear1, 1, vec![3.0, 57.0])
}

fn record(name: &str) -> ReferenceRecord {
    ReferenceRecord::read(
        &Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("../../reference")
            .join(name),
    )
    .unwrap()
}

#[test]
fn every_column_agrees_with_itself() {
    for name in ["pair_a", "pair_b", "solid_line_of_action", "solid_extended"] {
        let record = record(name);
        assert_eq!(
            record.kind,
            RecordKind::Computed,
            "nothing in the repository was measured"
        );
        let comparisons: Vec<_> = record
            .columns
            .iter()
            .map(|column| {
                let ours = record.series(column).unwrap();
                compare_with_column(&ours, &record, column, &view()).unwrap()
            })
            .collect();
        for c in &comparisons {
            assert_eq!(c.largest_deviation, 0.0);
            assert!((c.correlation.unwrap() - 1.0).abs() < 1e-12);
        }
        assert!(comparison_table(&comparisons).contains("stated uncertainty"));
    }
}

#[test]
fn slots_show_as_order_3_and_a_solid_body_does_not() {
    for torque in TORQUES_NM {
        let of = |name: &str| {
            let record = record(name);
            let column = record.column(&Quantity::TransmissionError, torque).unwrap();
            let ours = record.series(column).unwrap();
            let c = compare_with_column(&ours, &record, column, &view()).unwrap();
            assert!(
                c.mean.ours < 0.0,
                "the transmission error is negative under load"
            );
            (c.harmonics[0].ours, c.harmonics[1].ours)
        };
        let (slots_a, mesh_a) = of("pair_a");
        let (slots_b, mesh_b) = of("pair_b");
        // Pair A repeats with the pitch: what is left at order 3 is the rounding of the file, 6 digits.
        assert!(
            slots_a < 1e-5 * mesh_a,
            "{torque} N·m: {slots_a} m at order 3"
        );
        assert!(
            slots_b > 1e-2 * mesh_b,
            "{torque} N·m: {slots_b} m at order 3 against {mesh_b} m at order 57"
        );
    }
}
