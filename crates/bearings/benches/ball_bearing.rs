//! Time of one evaluation: load of the inner ring with its tangent, 14 balls; cold, and warm from the balls' places of the evaluation before.
//!
//! Run on a quiet machine: `cargo bench -p gearmesh-bearings --profile dev`; on a busy one only the fastest column says something.
#![allow(clippy::unwrap_used)] // bench code

use divan::Bencher;
use gearmesh_bearings::bearing_file::BearingFromFile;
use gearmesh_bearings::{ElementPlaces, Operation, QuasiStaticBearing, RingPose};
use gearmesh_geometry::input::InputDocument;
use nalgebra::Vector5;

fn main() {
    divan::main();
}

const FOURTEEN: &str = "name = \"14 balls\"\nkind = \"angular-contact\"\nballs = 14\nball_diameter_mm = 12.0\npitch_diameter_mm = 70.0\n\
                        inner_conformity = 0.52\nouter_conformity = 0.53\ncontact_angle_deg = 25.0\n";

/// The ring moves a little from call to call, as in a simulation.
fn evaluate(bencher: Bencher, rpm: f64, warm: bool) {
    let document = InputDocument::new("bearing.toml", FOURTEEN);
    let definition = BearingFromFile::from_document(&document)
        .unwrap()
        .definition;
    let bearing = QuasiStaticBearing::new(&definition).unwrap();
    let operation = Operation {
        inner_rad_per_s: rpm * std::f64::consts::PI / 30.0,
        ..Operation::default()
    };
    let mut shift = 0.0_f64;
    let mut places = ElementPlaces::unknown(&bearing.rows);
    bencher.bench_local(|| {
        shift = (shift + 1e-9) % 1e-6;
        let pose = RingPose::from_five(&Vector5::new(5e-6 + shift, -3e-6, 15e-6, 1e-4, -2e-4));
        if !warm {
            places.forget();
        }
        bearing
            .evaluate_from(&pose, &operation, &mut places)
            .unwrap()
    });
}

#[divan::bench(args = [false, true])]
fn at_rest(bencher: Bencher, warm: bool) {
    evaluate(bencher, 0.0, warm);
}

#[divan::bench(args = [false, true])]
fn at_10000_rpm(bencher: Bencher, warm: bool) {
    evaluate(bencher, 10000.0, warm);
}
