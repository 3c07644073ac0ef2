//! A gear pair at rest: two gears are reduced, one after the other, and a scene without a file runs them under three
//! torques.
//!
//! `cargo run --example pair_at_rest -- fe_models/first_pair target/first_pair`: folder of the gear files, folder for
//! the models.

use std::error::Error;
use std::path::Path;
use std::time::Duration;

use gearmesh_operations::Watch;
use gearmesh_operations::gear_file::GearFile;
use gearmesh_operations::reduce::{Reduction, reduce_to};
use gearmesh_operations::run::{RunHow, run_pair};
use gearmesh_scene::{Scene, load};
use gearmesh_specification::pair::{PairTable, PairTables, RunTable};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let [_, gears, models] = &arguments[..] else {
        return Err("give the folder of the gear files and a folder for the models".into());
    };
    let (gears, models) = (Path::new(gears), Path::new(models));
    std::fs::create_dir_all(models)?;
    // Nobody listens and nothing stops it. A program of your own hands in a `Listener` and a flag.
    let watch = Watch::unattended();
    let how = Reduction {
        estimate_error: false,
        even_if_memory_is_short: false,
    };
    for name in ["pinion", "wheel"] {
        let gear = GearFile::read(&gears.join(format!("{name}.toml")), &watch)?;
        reduce_to(&gear, how, &models.join(format!("{name}.h5")), &watch)?;
    }

    let tables = PairTables {
        title: "A pair without a file".to_owned(),
        pair: PairTable {
            gear_1: "pinion.h5".into(),
            gear_2: "wheel.h5".into(),
            centre_distance_mm: 94.6.into(),
            ..PairTable::default()
        },
        run: RunTable {
            torques_Nm: [50.0, 100.0, 200.0].map(Into::into).into(),
            pitches: 1.into(),
            points_per_pitch: 24.into(),
            ..RunTable::default()
        },
        ..PairTables::default()
    };
    let loaded = load(Scene::new(&tables, models)?)?;
    let how = RunHow {
        output: None,
        restart: false,
        most_result_gb: 1.0,
        checkpoint_interval: Duration::MAX,
    };
    let result = run_pair(&loaded, &how, &watch)?;
    let mut lines = vec!["torque N m  TE mean um  TE pk-pk um  p_H max MPa".to_owned()];
    for k in 0..result.torque_nm.len() {
        let f = result.figures(k);
        lines.push(format!(
            "{:>10.1} {:>11.4} {:>12.4} {:>12.1}",
            f.torque_nm,
            1e6 * f.te_mean_m,
            1e6 * f.te_peak_to_peak_m,
            1e-6 * f.pressure_largest_pa
        ));
    }
    std::fs::write(models.join("pair.txt"), lines.join("\n") + "\n")?;
    Ok(())
}
