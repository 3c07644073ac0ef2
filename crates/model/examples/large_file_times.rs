//! Times writing and reading a reduced gear of the size of a thin-rimmed gear: `cargo run -p gearmesh-model --example
//! large_file_times [MEGABYTES]`. Expected: 100 MB written in less than 2 s and read in less than 0.5 s.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::time::Instant;

#[path = "../../../tests/support/made_up_models.rs"]
mod made_up_models;

use gearmesh_model::{ReducedGear, read_reduced_gear, write_reduced_gear};
use made_up_models::small_reduced_gear;

fn main() {
    let megabytes: usize = std::env::args()
        .nth(1)
        .map_or(100, |text| text.parse().unwrap());
    // 9 roll stations, 11 axial ones, both hands, 57 teeth in N sectors.
    let (loads, teeth) = (99, 57);
    let per_tooth = 8 * 4 * teeth * loads * loads;
    let own = [1, 3, 19]
        .into_iter()
        .rfind(|own| own * per_tooth <= megabytes * 1_000_000)
        .unwrap_or(1);
    let mut gear = ReducedGear {
        teeth,
        sectors: teeth / own,
        gauges: vec![],
        reference_point: None,
        modes: None,
        ..small_reduced_gear()
    };
    gear.grid.roll_angles_rad = (0..9).map(|i| 0.2 + 0.05 * f64::from(i)).collect();
    gear.grid.z_m = (0..11).map(|i| -0.01 + 0.002 * f64::from(i)).collect();
    gear.c_hub = (0..own * per_tooth / 8)
        .map(|i| 1e-9 * (i as f64).sin())
        .collect();
    gear.c_tooth = vec![1e-9; 2 * loads * loads];
    gear.opposite_distance_m = vec![0.003; 18];
    let folder = tempfile::tempdir_in(".").unwrap();
    let path = folder.path().join("gear.h5");
    let start = Instant::now();
    write_reduced_gear(&path, &gear).unwrap();
    let written = start.elapsed();
    let start = Instant::now();
    let back = read_reduced_gear(&path).unwrap();
    let read = start.elapsed();
    assert!(back == gear);
    let size = path.metadata().unwrap().len() as f64 / 1e6;
    println!(
        "{size:.1} MB: written in {:.3} s, read in {:.3} s",
        written.as_secs_f64(),
        read.as_secs_f64()
    );
}
