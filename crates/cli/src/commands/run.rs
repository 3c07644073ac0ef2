//! `gearmesh run`: a scene to a result file.

use crate::arguments::RunArguments;
use crate::commands::{periods, ratings, run_system};
use crate::console;
use crate::failure::Failure;
use crate::output_name;
use gearmesh_contact::ContactZone;
use gearmesh_report::run_figures::pair_figures;
use gearmesh_scene::pair::PairFigures;
use gearmesh_scene::system_run::megabytes;
use gearmesh_scene::{Scene, SceneFile, SceneResult, load, run as run_scene};
use std::path::Path;

/// Results from this size on are announced \[bytes\].
const WORTH_A_WORD: f64 = 50e6;

/// Runs the command.
pub fn run(arguments: &RunArguments) -> Result<(), Failure> {
    output_name::demand_hdf5(&arguments.output)?;
    let scene = match SceneFile::read(&arguments.scene)? {
        SceneFile::Pair(scene) => scene,
        SceneFile::System(scene) => {
            let loaded = scene.load()?;
            return run_system::run(loaded, arguments);
        }
    };
    if arguments.restart {
        return Err(Failure::input(
            "--restart: scenes of a gear pair are not resumed; leave it out",
        ));
    }
    let loaded = load(*scene)?;
    loaded.scene.notes.iter().for_each(console::note);
    let told = |done, total| console::note(format!("torque {done} of {total} solved"));
    demand_size(loaded.result_bytes(), "run.pitches", arguments)?;
    // Slips of units are among the warnings of the result; what is refused may follow from them.
    let result =
        run_scene(&loaded, &told).inspect_err(|_| console::unit_slips(loaded.unit_slips()))?;
    result.write(&arguments.output).map_err(Failure::work)?;
    result.warnings.iter().for_each(console::warning);
    ratings::warn(&result.ratings);
    if arguments.json {
        console::json(&pair_figures(&result));
    } else {
        table(&result)?.into_iter().for_each(console::data);
    }
    Ok(())
}

/// Refuses a result that is larger than it may be, before anything of it is written; a large one is announced.
///
/// # Errors
/// [`Failure`] naming the option that allows more.
pub fn demand_size(bytes: f64, key: &str, a: &RunArguments) -> Result<(), Failure> {
    if bytes > 1e9 * a.most_result_gb {
        return Err(Failure::input(format!(
            "{}: {key}: the result will have {}, allowed are {} GB; give --most-result-GB {:.0} to allow it",
            a.scene.display(),
            megabytes(bytes),
            a.most_result_gb,
            (1e-9 * bytes).ceil()
        )));
    }
    if bytes >= WORTH_A_WORD {
        console::note(format!("the result will have {}", megabytes(bytes)));
    }
    Ok(())
}

/// The curves' figures for people.
fn table(result: &SceneResult) -> Result<Vec<String>, Failure> {
    let mut lines = vec![
        format!("{}: {} positions per torque", result.title, result.angles()),
        format!(
            "{:>10} {:>12} {:>12} {:>14} {:>14} {:>8} {:>12} {:>12} {:>9}",
            "torque N m",
            "TE mean um",
            "TE pk-pk um",
            "secant N/mm/um",
            "tangent N/mm/um",
            "K_Hbeta",
            "p_H max MPa",
            "balance",
            "iter/pos"
        ),
    ];
    let mark = periods::mark(&result.contact_coverage);
    let width_mm = 1e3 * zone_width_m(result)?;
    let figures: Vec<PairFigures> = (0..result.torque_nm.len())
        .map(|k| result.figures(k))
        .collect();
    for (k, f) in figures.iter().enumerate() {
        let per_width = |stiffness: f64| stiffness / width_mm * 1e-6;
        lines.push(format!(
            "{:>10.1} {:>12.4} {:>12.4} {:>14.4} {:>15.4} {:>8.4} {:>12.1} {:>12.1e} {:>9.2}{mark}",
            f.torque_nm,
            f.te_mean_m * 1e6,
            f.te_peak_to_peak_m * 1e6,
            per_width(f.secant_mean_n_per_m),
            per_width(f.tangent_mean_n_per_m),
            f.k_h_beta,
            f.pressure_largest_pa * 1e-6,
            result.torque_balance[k],
            f64::from(result.iterations[k]) / result.angles() as f64
        ));
    }
    lines.push(result.means_over());
    lines.push(format!("errors: {}", result.errors_in_words()));
    if result.has_axial_force() {
        lines.push(format!(
            "{:>10} {:>22} {:>24}",
            "torque N m", "axial force gear 1 N", "axial over normal force"
        ));
        for f in &figures {
            lines.push(format!(
                "{:>10.1} {:>22.3} {:>24.6}{mark}",
                f.torque_nm,
                f.axial_force_1_mean_n,
                f.axial_force_1_mean_n / f.normal_force_mean_n
            ));
        }
    }
    lines.push(format!(
        "contact {:.3} s ({:.1} us a position), strain {:.3} s",
        result.seconds[0],
        1e6 * result.seconds[0] / (result.angles() * result.torque_nm.len()) as f64,
        result.seconds[1]
    ));
    lines.extend(periods::lines(result));
    lines.extend(ratings::lines(&result.ratings));
    Ok(lines)
}

/// Width over which the faces overlap \[m\].
fn zone_width_m(result: &SceneResult) -> Result<f64, Failure> {
    use gearmesh_geometry::input::InputDocument;
    let width_m = |gear: usize| -> Result<f64, Failure> {
        let definition = result.gears[gear].definition_in("the result")?;
        Ok(definition.tooth.face_width_m)
    };
    let scene = InputDocument::new("scene in result", &result.scene_toml);
    let offset_m = Scene::from_document(scene, Path::new("."))?.axial_offset_m;
    Ok(ContactZone::new([width_m(0)?, width_m(1)?], offset_m).width_m)
}
