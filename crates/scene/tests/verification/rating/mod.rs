//! Ratings of scenes of both kinds, and how much of its periods a pair's run has seen.

mod bearing_lives;
use crate::made_up_gears;
mod pairs;
mod systems;
mod unequal_pair;

use gearmesh_geometry::Material;
use made_up_gears::{YOUNG_PA, write_models};

const STEEL: Material = Material {
    young_pa: YOUNG_PA,
    poisson: 0.3,
    density_kg_per_m3: Some(7850.0),
};

const TABLE: &str = "cycles = [1e3, 1e5, 2e6]\nstress_amplitude_MPa = [900, 520, 300]\nbelow = \"haibach\"\nabove = \"first-slope\"\n";

fn near(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found / expected - 1.0).abs() < tolerance,
        "{found:e} for {expected:e}"
    );
}

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    write_models(folder.path());
    std::fs::write(folder.path().join("sn.toml"), TABLE).unwrap();
    folder
}
