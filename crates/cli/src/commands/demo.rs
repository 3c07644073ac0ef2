//! `gearmesh demo`: gear pairs A and B (seed 004 in docs/sources.md) from definition to report.

use crate::arguments::DemoArguments;
use crate::console;
use gearmesh_geometry::GearDefinition;
use gearmesh_geometry::input::InputDocument;
use gearmesh_model::write_reduced_gear;
use gearmesh_operations::Failure;
use gearmesh_operations::cross_section::{CROSS_SECTION, FieldCase, picture};
use gearmesh_operations::reduce::{reduced, summary};
use gearmesh_operations::report::write_page;
use gearmesh_reduction::GearBody;
use gearmesh_report::page::{FieldPicture, Section, Text};
use gearmesh_report::scene_comparison::compare_scene;
use gearmesh_report::scene_page::SceneChapter;
use gearmesh_report::{Quantity, ReferenceRecord};
use gearmesh_scene::{Scene, SceneResult, load, run as run_scene};
use gearmesh_signal::AngleSeries;
use gearmesh_signal::rig::{OrderFilter, RigSettings, process};
use std::path::Path;
use std::time::Instant;

/// Teeth of all three gears.
const TEETH: usize = 57;

/// Stages and their times.
struct Clock {
    start: Instant,
    stages: Vec<(String, f64)>,
}

impl Clock {
    fn lap(&mut self, name: String) {
        let seconds = self.start.elapsed().as_secs_f64();
        console::note(format!("{name}: {seconds:.1} s"));
        self.stages.push((name, seconds));
        self.start = Instant::now();
    }
}

/// Runs the command from the project's folder.
pub fn run(arguments: &DemoArguments) -> Result<(), Failure> {
    let (models, records) = (Path::new("fe_models"), Path::new("reference"));
    if !models.is_dir() || !records.is_dir() {
        return Err(Failure::input(
            "run the demo in the project's folder: it needs fe_models/ and reference/",
        ));
    }
    let out = &arguments.output;
    std::fs::create_dir_all(out).map_err(|e| Failure::work(format!("{}: {e}", out.display())))?;
    let mut clock = Clock {
        start: Instant::now(),
        stages: Vec::new(),
    };
    reduce_gear(models, out, "gear1", &mut clock)?;
    let mut chapters = Vec::new();
    for (pair, driven) in [("pair_a", "gear2"), ("pair_b", "gear3")] {
        let (definition, body) = reduce_gear(models, out, driven, &mut clock)?;
        let mut scene = Scene::read(&models.join(format!("{pair}.toml")))?;
        scene.gears[0].model = out.join("gear1.h5");
        scene.gears[1].model = out.join(format!("{driven}.h5"));
        let loaded = load(scene)?;
        let result = run_scene(&loaded, &|_, _| {})?;
        result
            .write(&out.join(format!("{pair}.h5")))
            .map_err(Failure::work)?;
        result.warnings.iter().for_each(console::warning);
        clock.lap(format!(
            "{pair}: {} static positions, {} gauges",
            result.angles() * result.torque_nm.len(),
            result.strain.len()
        ));
        let case = FieldCase {
            gear: 2,
            torque: result.torque_nm.len() - 1,
            angle: 0,
        };
        let picture = picture(&loaded, &result, case, (&definition, &body))?;
        clock.lap(format!("{pair}: stress field for the report"));
        let record = ReferenceRecord::read(&records.join(pair)).map_err(Failure::input)?;
        print_table(&result, &record)?;
        clock.lap(format!("{pair}: comparison"));
        let stress = Section::new(format!("{}: stress", result.source.title))
            .push(Text::paragraph(CROSS_SECTION))
            .push(FieldPicture::from(&picture));
        chapters.push(SceneChapter {
            result,
            record: Some(record),
            stress: Some(stress),
        });
    }
    let page = out.join("report.html");
    write_page(&chapters, &[], &page, &console::watch())?;
    clock.lap("report".into());
    console::data("\ntime of each stage");
    for (name, seconds) in &clock.stages {
        console::data(format!("{seconds:>9.2} s  {name}"));
    }
    let total: f64 = clock.stages.iter().map(|(_, s)| s).sum();
    console::data(format!(
        "{total:>9.2} s  in all\n\nreport: {}",
        out.join("report.html").display()
    ));
    Ok(())
}

fn reduce_gear(
    models: &Path,
    out: &Path,
    name: &str,
    clock: &mut Clock,
) -> Result<(GearDefinition, GearBody), Failure> {
    let document = InputDocument::read(&models.join(format!("{name}.toml")))?;
    let gear = GearDefinition::from_document(&document)?;
    let (model, body) = reduced(&gear, true, &console::watch())?;
    write_reduced_gear(&out.join(format!("{name}.h5")), &model).map_err(Failure::work)?;
    summary(&model).into_iter().for_each(console::note);
    clock.lap(format!(
        "{name}: mesh and reduce {} degrees of freedom",
        model.provenance.dofs
    ));
    Ok((gear, body))
}

/// Amplitude of an order of the transmission error \[m\], through the rig pipeline.
fn order_amplitude(result: &SceneResult, torque: usize, order: f64) -> Result<f64, Failure> {
    let te = result.curve(&result.te_m, torque);
    let series = AngleSeries::one_revolution(&result.angle_rad, te).map_err(Failure::work)?;
    let filter = OrderFilter::of_transmission_error(TEETH, TEETH);
    let signal = process(&series, &RigSettings::default(), filter).map_err(Failure::work)?;
    signal.spectrum.amplitude(order).map_err(Failure::work)
}

fn print_table(result: &SceneResult, record: &ReferenceRecord) -> Result<(), Failure> {
    let comparisons = compare_scene(result, record).map_err(Failure::work)?;
    console::data(format!(
        "\n{} against `{}` ({})",
        result.source.title, record.title, record.kind
    ));
    console::data(format!(
        "{:>10} {:>10} {:>7} {:>11} {:>7} {:>12} {:>13}   strain range by gauge, method 2: ustrain (deviation %)",
        "torque N m",
        "TE mean um",
        "dev. %",
        "TE pk-pk um",
        "dev. %",
        "3rd order um",
        "mesh order um"
    ));
    for (k, &torque) in result.torque_nm.iter().enumerate() {
        let figures = result.figures(k);
        let of = |quantity: &Quantity| {
            comparisons
                .iter()
                .find(|c| c.quantity == *quantity && c.torque_nm == torque)
        };
        let te = of(&Quantity::TransmissionError);
        let percent =
            |value: Option<f64>| value.map_or("-".into(), |v| format!("{:+.2}", 100.0 * v));
        let gauges: Vec<String> = result
            .strain
            .iter()
            .enumerate()
            .map(|(number, s)| {
                let [least, most] = result.strain_ends(number, 2, k);
                let ours = most - least;
                let compared = of(&Quantity::Strain {
                    gauge: s.name.clone(),
                });
                format!(
                    "{} {:.1} ({})",
                    s.name,
                    ours * 1e6,
                    percent(compared.and_then(|c| c.peak_to_peak.relative_difference()))
                )
            })
            .collect();
        console::data(format!(
            "{torque:>10.1} {:>10.3} {:>7} {:>11.3} {:>7} {:>12.4} {:>13.4}   {}",
            figures.te_mean_m * 1e6,
            percent(te.and_then(|c| c.mean.relative_difference())),
            figures.te_peak_to_peak_m * 1e6,
            percent(te.and_then(|c| c.peak_to_peak.relative_difference())),
            order_amplitude(result, k, 3.0)? * 1e6,
            order_amplitude(result, k, TEETH as f64)? * 1e6,
            gauges.join(", ")
        ));
    }
    Ok(())
}
