//! Multibody scenes: against a case computed by hand, against the functions of the rating crate on the same columns,
//! and what is refused.

use crate::common::load;
use crate::made_up_gears::{YOUNG_PA, pair, scene};
use crate::rating::{STEEL, TABLE, folder, near};
use crate::system_runs::{Desk, driven_wheel, job, transient};
use gearmesh_dynamics::{Motion, Params, TimeFunction};
use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{GearDefinition, GearPair, Misalignment};
use gearmesh_rating::{
    BelowTable, MeanStress, Passage, RootConstruction, RootSection, SnCurve, SnPoint, SurfaceState,
    flank_pressure, highest_single_contact_rolls_rad, history_damage, lewis_stress_pa,
    root_stress_pa,
};
use gearmesh_scene::rating::FatigueJob;
use gearmesh_scene::system::{LoadedSystem, RatingJob, RatingRule, SystemPlan, SystemScene};
use gearmesh_scene::system_run::*;
use std::f64::consts::{FRAC_PI_2, PI};

/// Ten pulses of stress from 0 to 800 MPa in 5 s. N = 2·10⁶ (300/400)⁶ without regard to the mean; by Goodman with 1200
/// MPa the amplitude counts as 400/(1 − 400/1200) = 600 MPa, N = 2·10⁶/2⁶.
#[test]
fn pulses_of_constant_amplitude_fail_as_computed_by_hand() {
    let pulses = TimeFunction::Sine {
        offset: 0.5,
        amplitude: 0.5,
        frequency_hz: 2.0,
        phase_rad: -FRAC_PI_2,
    };
    let knee = SnPoint {
        cycles: 2e6,
        amplitude_pa: 300e6,
    };
    let curve = SnCurve::basquin(knee, 6.0, BelowTable::EnduranceLimit).unwrap();
    let rated = |mean_stress, passage, from_s| RatingJob {
        name: "pulses".into(),
        method: "by hand".into(),
        from_s,
        columns: vec!["joints/driver/angle_rad".into()],
        turn_column: Some("joints/driver/angle_rad".into()),
        rule: RatingRule::Fatigue(FatigueJob {
            modulus_pa: 8e14,
            curve: curve.clone(),
            mean_stress,
            passage,
        }),
    };
    let goodman = MeanStress::Goodman {
        tensile_strength_pa: 1200e6,
    };
    let weak = MeanStress::Goodman {
        tensile_strength_pa: 300e6,
    };
    let (system, _) = driven_wheel(Motion::Position(pulses));
    let kind = transient(Params::fixed(1.0 / 640.0), 5.0, 1.0 / 64.0);
    let desk = Desk::new();
    let result = desk.run(RunJob {
        ratings: vec![
            rated(MeanStress::None, Passage::Repeated, 0.0),
            rated(goodman, Passage::Repeated, 0.0),
            rated(goodman, Passage::Once, 2.5),
            rated(weak, Passage::Repeated, 0.0),
        ],
        ..job(system.build().unwrap(), kind)
    });
    for (rating, cycles, life, passage_s) in [
        (0, 10.0, 2e6 * 0.75f64.powi(6), 5.0),
        (1, 10.0, 2e6 / 64.0, 5.0),
        (2, 5.0, 2e6 / 64.0, 2.5),
    ] {
        let found = &result.ratings[rating];
        assert_eq!(found.problem, None);
        // It goes to and fro: at the end it has not turned.
        let missing = found.incomplete.as_deref().unwrap();
        assert!(missing.contains("0.000 of a revolution"), "{missing}");
        let figure = |name: &str| found.figure(name).unwrap();
        near(figure("largest_stress_Pa"), 800e6, 1e-7);
        assert!(figure("least_stress_Pa").abs() < 100.0);
        assert_eq!(figure("cycles"), cycles);
        near(figure("most_damaging_amplitude_Pa"), 400e6, 1e-7);
        near(figure("most_damaging_mean_Pa"), 400e6, 1e-7);
        near(figure("damage"), cycles / life, 1e-6);
        near(figure("life_passages"), life / cycles, 1e-6);
        near(figure("life_h"), life / cycles * passage_s / 3600.0, 1e-6);
    }
    // What cannot be judged does not take the run with it.
    let last = &result.ratings[3];
    assert!(last.figures.is_empty());
    let problem = last.problem.as_ref().unwrap();
    assert!(
        problem.contains("reaches the tensile strength of 300.000 MPa"),
        "{problem}"
    );
}

const RUN: &str = r#"[run]
kind = "transient"
end_s = 0.05
[solver]
step_s = 2e-5
start = "equilibrium"
[output]
interval_s = 1e-4"#;

const RATED: &str = r#"[[gauge]]
body = "wheel"
names = ["g0", "g5"]
[[rating]]
kind = "fatigue"
gauge = "g0"
sn_table = "sn.toml"
method = 1
surface = "uniaxial"
[[rating]]
kind = "fatigue"
gauge = "g5"
body = "wheel"
sn_table = "sn.toml"
mean_stress = "goodman"
tensile_strength_MPa = 1200.0
passage = "once"
from_s = 0.01
[[rating]]
kind = "nominal"
mesh = "mesh"
[[rating]]
kind = "nominal"
mesh = "mesh"
load_point = "tip"
from_s = 0.025
"#;

/// The ratings of a run are those that the rating crate gives for the columns that it wrote, in the result's file, too.
#[test]
fn ratings_are_those_of_the_written_columns() {
    let folder = folder();
    let loaded = load(&scene(RUN, -60.0, "", RATED), folder.path()).unwrap();
    let plan = SystemPlan::new(&loaded.scene, loaded.build().unwrap()).unwrap();
    let plan = plan.lines.join("\n");
    for part in [
        "rating     gauge g0 of wheel: cycles and damage of the stress (uniaxial) from strain by method 1, S-N table sn.toml",
        "mean by Goodman's line, history passed once",
        "rating     mesh mesh: Lewis's root stress (load at the tip)",
    ] {
        assert!(plan.contains(part), "`{part}` is not in\n{plan}");
    }
    let desk = Desk::new();
    let result = desk.run(RunJob::from_scene(loaded).unwrap());
    let column = |name: &str, from: usize| {
        let name = format!("elements/mesh/{name}");
        result.rows.read(&name).unwrap()[from..].to_vec()
    };
    let curve = SnCurve::from_toml(TABLE).unwrap();
    let goodman = MeanStress::Goodman {
        tensile_strength_pa: 1200e6,
    };
    for (rating, name, from, surface, mean, passage) in [
        (
            0,
            "strain_gear2_g0_method1_ustrain",
            0,
            SurfaceState::Uniaxial,
            MeanStress::None,
            Passage::Repeated,
        ),
        (
            1,
            "strain_gear2_g5_method2_ustrain",
            100,
            SurfaceState::PlaneStrain,
            goodman,
            Passage::Once,
        ),
    ] {
        let strain: Vec<f64> = column(name, from).iter().map(|x| 1e-6 * x).collect();
        let stress = root_stress_pa(&strain, STEEL, surface);
        let expected = history_damage(&stress, passage, &curve, mean).unwrap();
        let figure = |name: &str| result.ratings[rating].figure(name).unwrap();
        assert!(expected.per_passage > 0.0 && expected.cycles > 0.0);
        assert_eq!(figure("cycles"), expected.cycles);
        near(figure("damage"), expected.per_passage, 1e-9);
        let history_s = (501 - from - 1) as f64 * 1e-4;
        near(figure("life_h"), expected.life_h(history_s), 1e-9);
        let most = stress.iter().fold(f64::MIN, |most, x| most.max(*x));
        near(figure("largest_stress_Pa"), most, 1e-12);
    }
    let pair = pair();
    let width = 20e-3;
    let tips = [&pair.gear_1, &pair.gear_2].map(|gear| gear.flank_end_roll_rad);
    let single = highest_single_contact_rolls_rad(&pair).unwrap();
    for (rating, from, rolls) in [(2, 0, single), (3, 250, tips)] {
        let sides = ["normal_force_right_N", "normal_force_left_N"].map(|name| column(name, from));
        let force = sides.concat().iter().fold(0.0_f64, |most, f| most.max(*f));
        let figure = |name: &str| result.ratings[rating].figure(name).unwrap();
        near(figure("largest_force_N"), force, 1e-12);
        for (gear, (tooth, roll)) in [&pair.gear_1, &pair.gear_2]
            .into_iter()
            .zip(rolls)
            .enumerate()
        {
            let section = RootSection::new(tooth, roll, RootConstruction::Parabola).unwrap();
            let factor = section.lewis_factor(3e-3);
            let tangential = force * (20.0 * PI / 180.0).cos();
            let expected = lewis_stress_pa(tangential, width, 3e-3, factor);
            near(
                figure(&format!("lewis_stress_gear{}_Pa", gear + 1)),
                expected,
                1e-6,
            );
        }
        // Nowhere in single contact is the pressure larger.
        let pressure = figure("hertz_pressure_Pa");
        let (from, to) = (
            pair.roll_end_1_rad - pair.pitch_1_rad(),
            pair.roll_start_1_rad + pair.pitch_1_rad(),
        );
        let largest = (0..=50)
            .map(|k| from + (to - from) * f64::from(k) / 50.0)
            .map(|roll| flank_pressure(&pair, roll, force / width, [STEEL; 2]).unwrap())
            .fold(0.0_f64, |most, found| most.max(found.peak_pressure_pa));
        near(pressure, largest, 1e-6);
    }
}

/// The shipped helical pair has an overlap ratio of 1.016: F_t = F cos α_n cos β at the reference circle, and ISO
/// 6336-2's Z_H Z_E Z_ε √(F_t/(d₁ b) (u + 1)/u) but for the 1.6 % of an axial pitch.
#[test]
fn a_helical_mesh_is_rated() {
    let rating = "[[rating]]\nkind = \"nominal\"\nmesh = \"mesh\"\n";
    let text = crate::common::text("dynamics_helical.toml") + rating;
    let built = crate::common::build(&text).unwrap();
    let RatingRule::Nominal(rating) = &built.ratings[0].rule else {
        panic!("{:?}", built.ratings[0]);
    };
    let found = rating.under(1000.0).unwrap();
    let (alpha_n, beta) = (20f64.to_radians(), 20f64.to_radians());
    let (width_m, module_m) = (28e-3, 3e-3);
    let tangential = 1000.0 * alpha_n.cos() * beta.cos();
    for (stress, factor) in found.lewis_pa.iter().zip(rating.lewis_factors) {
        assert!((0.5..0.9).contains(&factor), "{factor}");
        near(*stress, tangential / (width_m * module_m * factor), 1e-9);
    }
    let gears = ["helical1.toml", "helical2.toml"]
        .map(|name| GearDefinition::read(&crate::common::fe_models().join(name)).unwrap());
    let [first, second] = gears.map(|gear| gear.profile);
    let pair = GearPair::new(first, second, 113.6e-3, Misalignment::default()).unwrap();
    let alpha_t = (alpha_n.tan() / beta.cos()).atan();
    let beta_b = (beta.sin() * alpha_n.cos()).asin();
    let zone = (2.0 * beta_b.cos() / pair.working_pressure_angle_rad.tan()).sqrt() / alpha_t.cos();
    let elastic = (YOUNG_PA / (2.0 * PI * (1.0 - 0.09))).sqrt();
    let ratio = pair.gear_2.teeth as f64 / 31.0;
    let load = tangential / (31.0 * module_m / beta.cos() * width_m) * (ratio + 1.0) / ratio;
    let iso = zone * elastic * (load / pair.contact_ratio()).sqrt();
    let over = found.flank_pressure_pa / iso;
    assert!((1.0..1.01).contains(&over), "{over}");
}

/// A sweep keeps no rows; its windows hold the largest force.
#[test]
fn a_sweep_has_nominal_ratings() {
    let folder = folder();
    let run = r#"[run]
kind = "speed-sweep"
motion = "drive"
from_rpm = -60.0
to_rpm = -80.0
speeds = 2
settle_s = 0.01
measure_s = 0.01
[solver]
step_s = 2e-5
start = "equilibrium"
[output]
interval_s = 1e-4"#;
    let rating = "[[rating]]\nkind = \"nominal\"\nmesh = \"mesh\"\n";
    let loaded = load(&scene(run, -60.0, "", rating), folder.path()).unwrap();
    let desk = Desk::new();
    let result = desk.run(RunJob::from_scene(loaded).unwrap());
    let sweep = result.sweep.as_ref().unwrap();
    let name = "elements/mesh/normal_force_right_N";
    let place = sweep.columns.iter().position(|c| c.name == name).unwrap();
    let largest = sweep.figures.iter().map(|window| window[place].largest);
    let expected = largest.fold(0.0, f64::max);
    assert!(expected > 1000.0);
    assert_eq!(result.ratings[0].figure("largest_force_N"), Some(expected));
}

/// The scene with its ratings is refused; its gears are those that `sound` has read.
#[track_caller]
fn refused(sound: &LoadedSystem, text: &str, parts: &[&str]) {
    let document = InputDocument::new("scene.toml", text);
    let scene = SystemScene::from_document(document, &sound.scene.folder);
    let built = scene.and_then(|scene| {
        let mut changed = sound.clone();
        changed.scene = scene;
        changed.build()
    });
    let complaint = match built {
        Ok(_) => panic!("accepted:\n{text}"),
        Err(error) => error.to_string(),
    };
    for part in parts {
        assert!(complaint.contains(part), "`{part}` is not in\n{complaint}");
    }
}

#[test]
fn ratings_that_cannot_be_are_refused() {
    let folder = folder();
    let sound = load(&scene(RUN, -60.0, "", RATED), folder.path()).unwrap();
    let of = |rating: &str| scene(RUN, -60.0, "", rating);
    let with = |from: &str, to: &str| {
        assert!(RATED.contains(from), "{from}");
        of(&RATED.replacen(from, to, 1))
    };
    for (text, part) in [
        (
            with("gauge = \"g0\"", "gauge = \"g9\""),
            "rating.0.gauge: there is no gauge in a [[gauge]] `g9`",
        ),
        (
            with("gauge = \"g0\"\n", ""),
            "rating.0.gauge: missing; it has no default",
        ),
        (
            with("gauge = \"g0\"", "gauge = \"g0\"\ngear = 2"),
            "rating.0.gear: is not used by a multibody scene; body says whose gauge it is; remove it",
        ),
        (
            with("method = 1", "method = 3"),
            "rating.0.method: found 3, allowed is 1 to 2",
        ),
        (
            with("method = 1", "mesh = \"mesh\""),
            "rating.0: `mesh` belongs to kind \"nominal\", not to \"fatigue\"",
        ),
        (
            with("sn_table = \"sn.toml\"", "sn_table = \"no.toml\""),
            "rating.0.sn_table: the S-N table",
        ),
        (
            with("body = \"wheel\"\nsn_table", "body = \"weel\"\nsn_table"),
            "rating.1.body: there is no body `weel`; did you mean `wheel`?",
        ),
        (
            with("tensile_strength_MPa = 1200.0\n", ""),
            "rating.1.tensile_strength_MPa: missing; mean_stress = \"goodman\" needs it",
        ),
        (
            with("mean_stress = \"goodman\"\n", ""),
            "rating.1.tensile_strength_MPa: is used by mean_stress = \"goodman\" only",
        ),
        (
            with("from_s = 0.01", "from_s = 0.05"),
            "rating.1.from_s: found 0.05, allowed is 0 to below 0.05, the end of the run",
        ),
        (
            with(
                "kind = \"nominal\"\nmesh = \"mesh\"",
                "kind = \"nominal\"\nmesh = \"mash\"",
            ),
            "rating.2.mesh: there is no gear mesh `mash`; did you mean `mesh`?",
        ),
        (
            with(
                "kind = \"nominal\"",
                "kind = \"nominal\"\npassage = \"once\"",
            ),
            "rating.2: `passage` belongs to kind \"fatigue\", not to \"nominal\"",
        ),
        (
            of(RATED).replace("interval_s = 1e-4", "interval_s = 1e-4\nelements = []"),
            "rating.0: it reads channels of mesh `mesh`, which is not among output.elements",
        ),
        (
            of(RATED)
                .replace("kind = \"transient\"\nend_s = 0.05", "kind = \"static\"")
                .replace("step_s = 2e-5\nstart = \"equilibrium\"", "")
                .replace("interval_s = 1e-4", ""),
            "rating.0.kind: counts the cycles of a motion (run.kind = \"transient\"), found run.kind = \"static\"; change run.kind",
        ),
    ] {
        refused(&sound, &text, &["scene.toml:", part]);
    }
}

#[test]
fn bad_sn_tables_are_refused_at_their_line() {
    let folder = folder();
    let text = scene(RUN, -60.0, "", RATED);
    let sound = load(&text, folder.path()).unwrap();
    for (from, to, part) in [
        (
            "[900, 520, 300]",
            "[900,\n950, 300]",
            "sn.toml:3: stress_amplitude_MPa.1: row 2 of the S-N table: amplitude 950 MPa is not below 900 MPa",
        ),
        (
            "[1e3, 1e5, 2e6]",
            "[1e3, 1e5, 1e4]",
            "sn.toml:1: cycles.2: row 3 of the S-N table: 10000 cycles are not above",
        ),
        (
            "[900, 520, 300]",
            "[900, 520]",
            "sn.toml:1: cycles: 3 values in cycles, 2 in stress_amplitude_MPa",
        ),
        (
            "[900, 520, 300]",
            "[900, 520, -3]",
            "sn.toml:2: stress_amplitude_MPa.2: row 3 of the S-N table",
        ),
        (
            "\"haibach\"",
            "\"slope\"",
            "sn.toml:3: below: below = \"slope\" and slope_below belong together",
        ),
        (
            "\"haibach\"",
            "\"heibach\"",
            "sn.toml:3: below: unknown variant `heibach`",
        ),
        ("below =", "bellow =", "unknown field `bellow`"),
        ("[1e3, 1e5, 2e6]", "1e3", "sn.toml:1: cycles: found"),
    ] {
        assert!(TABLE.contains(from));
        std::fs::write(folder.path().join("sn.toml"), TABLE.replacen(from, to, 1)).unwrap();
        refused(&sound, &text, &[part]);
    }
}
