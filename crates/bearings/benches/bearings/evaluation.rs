//! One evaluation in equilibrium: load of the inner ring with its tangent, 14 balls; cold, and warm from the balls'
//! places of the evaluation before.

use gearmesh_bearings::bearing_file::BearingFromFile;
use gearmesh_bearings::{ElementPlaces, Operation, QuasiStaticBearing, RingPose};
use gearmesh_geometry::input::InputDocument;
use nalgebra::Vector5;
use std::hint::black_box;

use super::recorded::cpu_s;

const FOURTEEN: &str = "name = \"14 balls\"\nkind = \"angular-contact\"\nballs = 14\nball_diameter_mm = 12.0\npitch_diameter_mm = 70.0\n\
                        inner_conformity = 0.52\nouter_conformity = 0.53\ncontact_angle_deg = 25.0\n";

/// Evaluations of one measurement.
const CALLS: usize = 20_000;

pub fn measure() {
    for rpm in [0.0, 10_000.0] {
        for warm in [false, true] {
            let mut times: Vec<f64> = (0..9).map(|_| microseconds(rpm, warm)).collect();
            times.sort_by(f64::total_cmp);
            println!(
                "{{\"case\": \"evaluation\", \"rpm\": {rpm}, \"warm\": {warm}, \"fastest_us\": {}, \"median_us\": {}}}",
                times[0],
                times[times.len() / 2]
            );
        }
    }
}

/// Time of an evaluation; the ring moves a little from call to call, as in a simulation.
fn microseconds(rpm: f64, warm: bool) -> f64 {
    let document = InputDocument::new("bearing.toml", FOURTEEN);
    let definition = BearingFromFile::from_document(&document)
        .unwrap()
        .definition;
    let bearing = QuasiStaticBearing::new(&definition).unwrap();
    let operation = Operation {
        inner_rad_per_s: rpm * std::f64::consts::PI / 30.0,
        ..Operation::default()
    };
    let mut places = ElementPlaces::unknown(&bearing.rows);
    let clock = cpu_s();
    for call in 0..CALLS {
        let shift = 1e-9 * (call % 1000) as f64;
        let pose = RingPose::from_five(&Vector5::new(5e-6 + shift, -3e-6, 15e-6, 1e-4, -2e-4));
        if !warm {
            places.forget();
        }
        black_box(
            bearing
                .evaluate_from(black_box(&pose), &operation, &mut places)
                .unwrap(),
        );
    }
    1e6 * (cpu_s() - clock) / CALLS as f64
}
