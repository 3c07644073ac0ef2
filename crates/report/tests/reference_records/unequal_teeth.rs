//! 23 teeth drive 47, the wheel with six holes: results and records of made-up orders, on either shaft.

use gearmesh_model::StoredGear;
use gearmesh_report::export::{Cells, torque_table};
use gearmesh_report::scene_comparison::{SceneComparisonError, compare_scene};
use gearmesh_report::scene_page::{SceneChapter, scene_page};
use gearmesh_report::{ReferenceRecord, SeriesComparison, comparison_table};
use gearmesh_scene::pair::{LineForces, PairSolution, PairSource};
use gearmesh_scene::periods::Coverage;
use gearmesh_scene::{SceneResult, StrainSeries};
use std::f64::consts::TAU;

const POINTS: usize = 24;
const WHEEL: f64 = 23.0 / 47.0;

/// Micrometres: mesh, holes, the holes' sidebands, at an angle of the pinion.
fn te_um(angle_rad: f64, mesh_um: f64) -> f64 {
    let wave =
        |amplitude: f64, order: f64| amplitude * (order * angle_rad + 0.3 * order.sqrt()).cos();
    -20.0 + wave(mesh_um, 23.0) + wave(1.5, 6.0 * WHEEL) + wave(0.2, 23.0 - 6.0 * WHEEL)
}

/// A passage once in a revolution of a gear with `teeth` teeth.
fn strain(angle_rad: f64, teeth: f64) -> f64 {
    let turn = (angle_rad * 23.0 / teeth / TAU + 0.3).rem_euclid(1.0) - 0.5;
    6e-4 * (-(turn * teeth).powi(2)).exp()
}

fn gear_file(teeth: usize, blank: &str) -> String {
    format!(
        "name = \"z {teeth}\"\n[tooth]\nteeth = {teeth}\nmodule_mm = 3.0\nface_width_mm = 20.0\n[blank]\nbore_diameter_mm = 30.0\n{blank}\
         [material]\nyoung_GPa = 210.0\npoisson = 0.3\n"
    )
}

/// A run over so many pitches with a gauge on each gear.
fn result(pitches: usize) -> SceneResult {
    let step = TAU / (23 * POINTS) as f64;
    let angle_rad: Vec<f64> = (0..pitches * POINTS).map(|k| step * k as f64).collect();
    let over = |f: &dyn Fn(f64) -> f64| angle_rad.iter().map(|a| f(*a)).collect::<Vec<f64>>();
    let gauge = |gear: usize, teeth: f64, period: usize| StrainSeries {
        gear,
        name: format!("g{gear}"),
        error_estimate_relative: 0.01,
        coverage: Coverage::of_contact(period, pitches),
        method_1: over(&|a| strain(a, teeth)),
        method_2: over(&|a| strain(a, teeth)),
        between: Default::default(),
    };
    let holes = "kind = \"thin-rim\"\nhub_diameter_mm = 50.0\nrim_inner_diameter_mm = 124.0\nweb_thickness_mm = 6.0\n\
                 [blank.holes]\ncount = 6\npitch_circle_diameter_mm = 88.0\ndiameter_mm = 20.0\nphase_deg = 0.0\n";
    let points = pitches * POINTS;
    SceneResult {
        source: PairSource {
            title: "23 and 47".into(),
            gears: [gear_file(23, "kind = \"solid\"\n"), gear_file(47, holes)]
                .map(StoredGear::of_older_file),
            ..PairSource::default()
        },
        lines: LineForces {
            slots: 1,
            slices: 1,
            pair: vec![0.0; points],
            pair_count: vec![1; points],
            force_n: vec![1.0; points],
            pressure_pa: vec![1.0; points],
            k_h_beta: vec![1.0],
            ..LineForces::default()
        },
        solution: PairSolution {
            iterations: vec![1],
            residual: vec![0.0],
            torque_balance: vec![0.0],
            ..PairSolution::default()
        },
        pitches,
        contact_coverage: Coverage::of_contact(47, pitches),
        proposal: if pitches < 47 {
            "run.pitches = 47 covers everything".into()
        } else {
            String::new()
        },
        torque_nm: vec![100.0],
        te_m: over(&|a| 1e-6 * te_um(a, 0.8)),
        unloaded_m: vec![0.0; points],
        torque_1_nm: vec![0.0; points],
        axial_force_1_n: vec![0.0; points],
        secant_n_per_m: vec![1.0; points],
        tangent_n_per_m: vec![1.0; points],
        strain: vec![gauge(1, 23.0, 1081), gauge(2, 47.0, 47)],
        angle_rad,
        ..SceneResult::default()
    }
}

/// A record with further keys and one column, a function of the pinion's angle, over turns of the shaft with `teeth`
/// teeth.
fn record(
    keys: &str,
    (teeth, turns): (usize, usize),
    head: &str,
    f: impl Fn(f64) -> f64,
) -> ReferenceRecord {
    let folder = tempfile::tempdir().unwrap();
    let toml = format!(
        "title = \"T\"\nkind = \"measured\"\nsource = \"a rig\"\nangle_origin = \"pitch point\"\n{keys}"
    );
    std::fs::write(folder.path().join("record.toml"), toml).unwrap();
    let points = 40 * teeth * turns;
    let mut csv = format!("angle_deg,{head}\n");
    for i in 0..points {
        let deg = 360.0 * (turns * i) as f64 / points as f64;
        let pinion = deg.to_radians() * teeth as f64 / 23.0;
        csv += &format!("{deg},{}\n", f(pinion));
    }
    std::fs::write(folder.path().join("data.csv"), csv).unwrap();
    ReferenceRecord::read(folder.path()).unwrap()
}

fn orders(c: &SeriesComparison) -> Vec<(f64, f64, f64)> {
    let um = 1e6;
    c.harmonics
        .iter()
        .map(|h| (h.order, um * h.ours, um * h.reference))
        .collect()
}

fn near(found: &[(f64, f64, f64)], expected: &[(f64, f64, f64)]) {
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (f, e) in found.iter().zip(expected) {
        let apart = |a: f64, b: f64| (a - b).abs();
        assert!(
            apart(f.0, e.0) < 1e-9 && apart(f.1, e.1) < 1e-4 && apart(f.2, e.2) < 1e-4,
            "{found:?}"
        );
    }
}

/// One revolution of the wheel holds all there is; so do 47 of the pinion. The amplitudes are the same, the orders
/// those of the shaft.
#[test]
fn a_record_of_either_shaft_shows_mesh_and_holes() {
    let result = result(47);
    let te = |a: f64| te_um(a, 1.0);
    let of_wheel = record("shaft = \"gear_2\"\n", (47, 1), "te_um_100Nm", te);
    let [c] = &compare_scene(&result, &of_wheel).unwrap()[..] else {
        panic!()
    };
    near(
        &orders(c),
        &[
            (6.0, 1.5, 1.5),
            (12.0, 0.0, 0.0),
            (47.0, 0.8, 1.0),
            (94.0, 0.0, 0.0),
        ],
    );
    assert!(c.is_locked && (c.mean.reference + 20e-6).abs() < 1e-10);
    let of_pinion = record("revolutions = 47\n", (23, 47), "te_um_100Nm", te);
    let [d] = &compare_scene(&result, &of_pinion).unwrap()[..] else {
        panic!()
    };
    near(
        &orders(d),
        &[
            (6.0 * WHEEL, 1.5, 1.5),
            (12.0 * WHEEL, 0.0, 0.0),
            (23.0, 0.8, 1.0),
            (46.0, 0.0, 0.0),
        ],
    );
    assert!((c.rms.ours / d.rms.ours - 1.0).abs() < 1e-6);
    assert!(c.best_offset_rad.unwrap().abs() < 1e-4);
}

/// The offset with the best correlation is reported; figures are those without it.
#[test]
fn an_offset_is_reported_and_not_applied() {
    let by = 0.05;
    let shifted = record("shaft = \"gear_2\"\n", (47, 1), "te_um_100Nm", |a| {
        te_um(a - by * 47.0 / 23.0, 0.8)
    });
    let [c] = &compare_scene(&result(47), &shifted).unwrap()[..] else {
        panic!()
    };
    assert!(
        (c.best_offset_rad.unwrap() - by).abs() < 1e-4,
        "{:?}",
        c.best_offset_rad
    );
    assert!(c.best_offset_correlation.unwrap() > 0.9999);
    assert!(c.correlation.unwrap() < 0.9 && c.largest_deviation.abs() > 1e-7);
    let table = comparison_table(std::slice::from_ref(c));
    assert!(table.contains("2.86") && table.contains("best"), "{table}");
}

/// Of a pair whose teeth are all alike every pitch is as good an offset as the next one.
#[test]
fn an_offset_is_counted_within_the_period_of_ours() {
    // One pitch of the wheel is 7.66°; the once per revolution of the reference makes pitches differ by a little.
    let (by, noise) = (0.4 * TAU / 47.0, 1e-3);
    let mesh = |a: f64| -20.0 + 0.8 * (23.0 * a).cos();
    let all_alike = SceneResult {
        contact_coverage: Coverage::of_contact(1, 94),
        te_m: (result(94).angle_rad.iter().enumerate())
            .map(|(k, a)| 1e-6 * (mesh(*a) + noise * ((17 * k % 101) as f64 / 101.0 - 0.5)))
            .collect(),
        ..result(94)
    };
    let shifted = record("shaft = \"gear_2\"\n", (47, 1), "te_um_100Nm", |a| {
        mesh(a - by * 47.0 / 23.0)
    });
    let [c] = &compare_scene(&all_alike, &shifted).unwrap()[..] else {
        panic!()
    };
    let found = c.best_offset_rad.unwrap();
    assert!((found - by).abs() < 1e-3, "{found} against {by}");
}

/// A run over one and a third periods: means of the console, of tables and of Python are those of the whole period.
#[test]
fn means_are_of_whole_periods_in_every_table() {
    let result = result(62);
    let of = |points: usize| result.te_m[..points].iter().sum::<f64>() / points as f64;
    let (whole, all) = (of(47 * POINTS), of(62 * POINTS));
    assert!((whole / all - 1.0).abs() > 1e-4, "{whole:e} {all:e}");
    assert!((result.figures(0).te_mean_m / whole - 1.0).abs() < 1e-12);
    let table = torque_table(&result);
    let column = |name: &str| {
        let (_, cells) = table.columns.iter().find(|(head, _)| head == name).unwrap();
        match cells {
            Cells::Numbers(numbers) => numbers[0],
            Cells::Texts(_) | Cells::Column(..) => f64::NAN,
        }
    };
    assert_eq!(column("te_mean_m"), result.figures(0).te_mean_m);
    assert_eq!(column("mean_over_pitches"), 47.0);
    assert_eq!(
        result.means_over(),
        "means over 47 of 62 pitches: 1 times the period of 47"
    );
}

/// A tacho on the pinion cuts every revolution: the holes of the wheel are not locked to it. Its orders are compared,
/// and the table says so.
#[test]
fn a_record_of_one_pinion_turn_averages_the_rest_out() {
    let mesh_only = record("", (23, 1), "te_um_100Nm", |a| {
        -20.0 + 0.8 * (23.0 * a).cos()
    });
    let [c] = &compare_scene(&result(47), &mesh_only).unwrap()[..] else {
        panic!()
    };
    near(&orders(c), &[(23.0, 0.8, 0.8), (46.0, 0.0, 0.0)]);
    assert!(!c.is_locked);
    let table = comparison_table(std::slice::from_ref(c));
    assert!(table.contains("averaged out of ours"), "{table}");
}

#[test]
fn strain_needs_whole_revolutions_of_its_gear() {
    let head = "strain_g2_ustrain_100Nm";
    let um = |a: f64| 1e6 * strain(a, 47.0);
    let whole = record("shaft = \"gear_2\"\n", (47, 1), head, um);
    let [c] = &compare_scene(&result(47), &whole).unwrap()[..] else {
        panic!()
    };
    // Forty points a pitch on one side, 24 on the other, pulses of the rig: to a thousandth.
    assert!(
        c.correlation.unwrap() > 0.99999
            && c.peak_to_peak.relative_difference().unwrap().abs() < 1e-3
    );
    let pinion = record("", (23, 1), head, um);
    let error = compare_scene(&result(47), &pinion).unwrap_err();
    assert!(matches!(error, SceneComparisonError::StrainPeriod { .. }));
    let text = error.to_string();
    for part in [
        "strain g2 repeats after 47 pitches",
        "1 revolution(s) of gear 1, 23 pitches",
        "shaft and revolutions",
    ] {
        assert!(text.contains(part), "{text}");
    }
}

#[test]
fn a_run_that_is_too_short_is_told_what_would_do() {
    let te = record("shaft = \"gear_2\"\n", (47, 1), "te_um_100Nm", |a| {
        te_um(a, 1.0)
    });
    let text = compare_scene(&result(23), &te).unwrap_err().to_string();
    for part in [
        "TE of the result",
        "23 of the 47 pitches",
        "run.pitches = 47 covers everything",
    ] {
        assert!(text.contains(part), "{text}");
    }
}

/// The page: a spectrum with the holes where the run covers them, marks where it does not, and no strain joined to
/// itself too early.
#[test]
fn the_page_shows_what_is_covered() {
    let page = |pitches| {
        let chapter = SceneChapter {
            result: result(pitches),
            record: None,
            stress: None,
        };
        scene_page(&[chapter], &[]).unwrap().render().unwrap()
    };
    let (whole, part) = (page(47), page(23));
    assert!(whole.contains("Order spectrum of the transmission error"));
    assert!(whole.contains("slots or holes") && !whole.contains("TE mean (incomplete)"));
    assert!(whole.contains("strain at gauge g1 of gear 1: incomplete: 47 of 1081 pitches"));
    assert!(
        !part.contains("Order spectrum of")
            && part.contains("No order spectrum: the run goes through 23 of the 47")
    );
    assert!(
        part.contains("TE mean (incomplete)")
            && part.contains("run.pitches = 47 covers everything")
    );
}
