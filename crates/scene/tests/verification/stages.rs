//! The stages of a result beside hand calculation, and what is warned of: open meshes, loads that drive, gears that
//! overlap, torques that follow tilting bodies.

use std::f64::consts::PI;

use gearmesh_scene::system_run::{RunJob, StageTable, SystemResult};

use crate::common::{build_in, changed, fe_models, load};
use crate::system_runs::Desk;

/// A pair of the shipped train, gear 1 held at some angles, 100 N m against gear 2.
fn at_rest(model: &str, tilt_deg: f64, more: &str) -> String {
    format!(
        "title = \"pair\"\n[run]\nkind = \"static\"\nload_factors = [0.5, 1.0]\n\
         [[body]]\nname = \"pinion\"\ngear = \"train_27.toml\"\nspeed_rpm = 600.0\n\
         [[body]]\nname = \"wheel\"\ngear = \"train_61.toml\"\nposition_mm = [88.0, 0.0, 0.0]\ncardan_deg = [{tilt_deg}, 0.0]\n\
         [[joint]]\nname = \"a\"\nkind = \"revolute\"\nbody_2 = \"pinion\"\n\
         [[joint]]\nname = \"b\"\nkind = \"revolute\"\nbody_2 = \"wheel\"\n\
         [[torsion_spring]]\nname = \"held\"\nbody_2 = \"pinion\"\nstiffness_Nm_per_rad = 1e6\n\
         [[load]]\nname = \"brake\"\nbody = \"wheel\"\ntorque_Nm = -100.0\n\
         [[gear_mesh]]\nname = \"mesh\"\ngear_1 = \"pinion\"\ngear_2 = \"wheel\"\nmodel = {model}\n{more}"
    )
}

fn run(text: &str) -> SystemResult {
    let desk = Desk::new();
    desk.run(RunJob::from_scene(load(text, &fe_models()).unwrap()).unwrap())
}

fn near(found: f64, expected: f64, share: f64) {
    assert!(
        (found - expected).abs() <= share * expected.abs(),
        "{found}, expected {expected}"
    );
}

fn stages(result: &SystemResult) -> StageTable {
    result.stages().unwrap().unwrap()
}

#[test]
fn loads_of_a_stage_at_rest_are_those_of_statics() {
    for model in [
        "{ kind = \"iso6336\", slices = 5 }",
        "{ kind = \"analytic\", slices = 5 }",
        "{ kind = \"kinematic\" }",
    ] {
        let result = run(&at_rest(model, 0.0, ""));
        let table = stages(&result);
        assert_eq!(table.over, "in the equilibrium of load factor 1");
        let (row, load) = (&table.rows[0], table.rows[0].load.unwrap());
        // The mesh balances the load, and by the numbers of teeth what holds the pinion.
        near(load.moments_nm[1], 100.0, 1e-6);
        near(load.moments_nm[0], 100.0 * 27.0 / 61.0, 1e-3);
        near(row.speeds_rad_per_s[0].unwrap(), 20.0 * PI, 1e-12);
        near(
            row.speeds_rad_per_s[1].unwrap(),
            -20.0 * PI * 27.0 / 61.0,
            1e-12,
        );
        let stage = row.mesh.stage.unwrap();
        if let Some(forces) = load.forces_n {
            let of_1_nm = stage.forces_of_1_nm_n;
            for (force, of_1_nm) in forces.into_iter().zip(of_1_nm).take(2) {
                near(force, load.moments_nm[0] * of_1_nm, 1e-3);
            }
            near(load.k_h_beta.unwrap(), 1.0, 1e-9);
        } else {
            assert!(model.contains("kinematic") && load.k_h_beta.is_none());
        }
        assert_eq!(result.warnings().unwrap(), Vec::<String>::new());
        // One line a figure; what no stage has is left out.
        let lines = table.lines();
        let value = |key: &str| lines.iter().find(|l| l.key == key).map(|l| l.values[0]);
        near(value("moment_2_Nm").flatten().unwrap(), 100.0, 1e-6);
        near(value("speed_1_rpm").flatten().unwrap(), 600.0, 1e-12);
        // 100 N m at 600 · 27/61 rpm, out of the wheel's load and into the spring of the pinion.
        let watts = -100.0 * 20.0 * PI * 27.0 / 61.0;
        near(value("power_1_W").flatten().unwrap(), watts, 1e-3);
        near(value("power_2_W").flatten().unwrap(), watts, 1e-6);
        assert_eq!(value("k_h_beta").is_none(), model.contains("kinematic"));
    }
}

/// A `kinematic` mesh is a joint: its torques at an operating point of `eigen` are its reactions.
#[test]
fn kinematic_meshes_have_torques_at_operating_points() {
    let text = at_rest("{ kind = \"kinematic\" }", 0.0, "");
    let text = changed(&text, "kind = \"static\"", "kind = \"eigen\"");
    let result = run(&text);
    let table = stages(&result);
    let load = table.rows[0].load.unwrap();
    near(load.moments_nm[1], 100.0, 1e-6);
    near(load.moments_nm[0], 100.0 * 27.0 / 61.0, 1e-6);
    let keys: Vec<&str> = table.lines().iter().map(|line| line.key).collect();
    for key in [
        "ratio",
        "contact_ratio",
        "speed_2_rpm",
        "moment_1_Nm",
        "power_1_W",
        "power_2_W",
    ] {
        assert!(keys.contains(&key), "{key} of {keys:?}");
    }
}

/// Springs that hold what stands still, or that do not resist turning, take no power: what loads put in and take out
/// must balance all the same.
#[test]
fn springs_at_rest_do_not_hide_power_that_does_not_balance() {
    let motion = "[run]\nkind = \"transient\"\nend_s = 0.001\n[solver]\nstep_s = 1e-5\n[output]\ninterval_s = 1e-4\n";
    let text = at_rest("{ kind = \"kinematic\" }", 0.0, "");
    let text = changed(
        &text,
        "[run]\nkind = \"static\"\nload_factors = [0.5, 1.0]\n",
        motion,
    );
    let held =
        "[[torsion_spring]]\nname = \"held\"\nbody_2 = \"pinion\"\nstiffness_Nm_per_rad = 1e6\n";
    let with = |spring: &str, input_nm: f64| {
        let load =
            format!("[[load]]\nname = \"input\"\nbody = \"pinion\"\ntorque_Nm = {input_nm:?}\n");
        let frame = "[[body]]\nname = \"frame\"\nmass_kg = 1.0\ninertia_kg_m2 = [1e-3, 1e-3, 2e-3]\nposition_mm = [0.0, 500.0, 0.0]\n";
        changed(&text, held, &format!("{frame}{spring}{load}"))
    };
    let told = |text: &str| {
        let notes = build_in(text, &fe_models()).unwrap().notes;
        notes
            .into_iter()
            .find(|note| note.contains("does not balance"))
    };
    let of = |body: &str| held.replace("\"pinion\"", &format!("\"{body}\""));
    let seat = "[[bushing]]\nname = \"seat\"\nbody_2 = \"pinion\"\nstiffness_N_per_mm = [1e3, 1e3, 1e3]\nstiffness_Nm_per_rad = [1e5, 1e5, 0.0]\n";
    let still = of("frame");
    for spring in [still.as_str(), seat] {
        // 100 N m · 27/61 balance the load of the wheel, which takes 600 · 27/61 rpm against its speed.
        let right = -100.0 * 27.0 / 61.0;
        assert_eq!(told(&with(spring, right)), None, "{spring}");
        let note = told(&with(spring, 0.5 * right)).unwrap();
        assert!(
            note.contains("`input`") && note.contains("`brake`"),
            "{note}"
        );
    }
    // One that is wound up takes what is missing.
    assert_eq!(told(&with(&of("pinion"), -10.0)), None);
}

/// The largest force of the equilibria is rated: 100 N m on the wheel's base circle, beside the load factor of one
/// half.
#[test]
fn equilibria_have_nominal_ratings() {
    let model = "{ kind = \"iso6336\", slices = 5 }";
    let text = at_rest(
        model,
        0.0,
        "[[rating]]\nkind = \"nominal\"\nmesh = \"mesh\"\n",
    );
    let result = run(&text);
    let rating = &result.ratings[0];
    let figures = &rating.figures;
    let force = figures
        .iter()
        .find(|f| f.name == "largest_force_N")
        .unwrap();
    let built = build_in(&text, &fe_models()).unwrap();
    near(force.value, 100.0 / built.meshes[0].base_radii_m[1], 1e-6);
    let timed = at_rest(
        model,
        0.0,
        "[[rating]]\nkind = \"nominal\"\nmesh = \"mesh\"\nfrom_s = 0.1\n",
    );
    let error = build_in(&timed, &fe_models()).err().unwrap().to_string();
    assert!(error.contains("which has no time; remove it"), "{error}");
}

/// Teeth so far apart that one pair leaves before the next one comes are refused with their contact ratio.
#[test]
fn a_contact_ratio_below_one_is_refused_by_name() {
    for model in [
        "{ kind = \"iso6336\", slices = 5 }",
        "{ kind = \"kinematic\" }",
    ] {
        let text = changed(
            &at_rest(model, 0.0, ""),
            "[88.0, 0.0, 0.0]",
            "[90.2, 0.0, 0.0]",
        );
        let error = build_in(&text, &fe_models()).err().unwrap().to_string();
        let part = "the transverse contact ratio is 0.7043: below 1 the pair loses contact";
        assert!(error.contains(part), "{error}");
    }
}

/// K_Hβ from the line loads of the slices, read from the columns.
#[test]
fn the_share_of_the_most_loaded_slice_is_that_of_the_columns() {
    let result = run(&at_rest("{ kind = \"analytic\", slices = 5 }", 0.02, ""));
    let load = stages(&result).rows[0].load.unwrap();
    let slice = |i: usize| {
        let name = format!("elements/mesh/line_load_slice_{i}_N_per_m");
        result.rows.read(&name).unwrap()[1]
    };
    let slices: Vec<f64> = (1..=5).map(slice).collect();
    let most = slices.iter().copied().fold(0.0, f64::max);
    let expected = 5.0 * most / slices.iter().sum::<f64>();
    assert!(expected > 1.05, "{slices:?}");
    near(load.k_h_beta.unwrap(), expected, 1e-12);
}

/// Two pitches in time: means over the second half; what goes in and does not come out is friction's.
#[test]
fn loads_of_a_stage_in_motion_are_means() {
    let text = "title = \"pair\"\n[run]\nkind = \"transient\"\nend_s = 0.0074074\n[solver]\nstep_s = 1e-5\nstart = \"equilibrium\"\n\
         [output]\ninterval_s = 1e-5\n\
         [[body]]\nname = \"pinion\"\ngear = \"train_27.toml\"\nspeed_rpm = 600.0\n\
         [[body]]\nname = \"wheel\"\ngear = \"train_61.toml\"\nposition_mm = [88.0, 0.0, 0.0]\n\
         [[joint]]\nname = \"a\"\nkind = \"revolute\"\nbody_2 = \"pinion\"\n\
         [[joint]]\nname = \"b\"\nkind = \"revolute\"\nbody_2 = \"wheel\"\n\
         [[motion]]\nname = \"drive\"\njoint = \"a\"\nspeed_rpm = 600.0\n\
         [[load]]\nname = \"brake\"\nbody = \"wheel\"\ntorque_Nm = 100.0\n\
         [[gear_mesh]]\nname = \"mesh\"\ngear_1 = \"pinion\"\ngear_2 = \"wheel\"\n\
         model = { kind = \"analytic\", slices = 3, damping = { kind = \"stiffness-proportional\", time_s = 2e-6, full_depth_um = 1.0 } }\n\
         teeth = { friction = { model = \"coulomb\", dynamic_coefficient = 0.05 } }\n";
    let result = run(text);
    let table = stages(&result);
    assert!(
        table.over.starts_with("mean over the second half"),
        "{}",
        table.over
    );
    let row = &table.rows[0];
    let [w1, w2] = row.speeds_rad_per_s.map(Option::unwrap);
    near(w1, 20.0 * PI, 1e-6);
    let [m1, m2] = row.load.unwrap().moments_nm;
    near(m2, -100.0, 0.02);
    let half = result.rows.rows() / 2;
    let lost = result.rows.read("elements/mesh/friction_power_W").unwrap();
    let lost = lost[half..].iter().sum::<f64>() / (lost.len() - half) as f64;
    // Means of products are not products of means: what vibrates is the rest.
    assert!(
        (-(m1 * w1 + m2 * w2) / lost - 1.0).abs() < 0.2,
        "{m1} {w1} {m2} {w2} {lost}"
    );
    // The load brakes: nothing to report. The other way round it drives, which the motion holds back.
    assert!(
        result.head.notes.iter().all(|n| !n.contains("drives")),
        "{:?}",
        result.head.notes
    );
    let driving = changed(text, "torque_Nm = 100.0", "torque_Nm = -100.0");
    let notes = build_in(&driving, &fe_models()).unwrap().notes;
    let told = notes
        .iter()
        .find(|n| n.contains("load `brake` drives"))
        .unwrap();
    // 100 N m at 600 · 27/61 rpm.
    assert!(told.contains("-265.573770 rpm, put 2781.08"), "{told}");
    assert!(told.contains("motion `drive` must brake"), "{told}");
    // Without the motion nothing brakes, and a brake alone is as wrong.
    let alone = changed(
        &driving,
        "[[motion]]\nname = \"drive\"\njoint = \"a\"\nspeed_rpm = 600.0\n",
        "",
    );
    let notes = build_in(&alone, &fe_models()).unwrap().notes;
    let told = notes
        .iter()
        .find(|n| n.contains("power does not balance"))
        .unwrap();
    assert!(told.contains("`brake` +2781.08"), "{told}");
    // A second torque that balances it by the numbers of teeth.
    let both = format!(
        "{alone}[[load]]\nname = \"input\"\nbody = \"pinion\"\ntorque_Nm = {}\n",
        -100.0 * 27.0 / 61.0
    );
    let notes = build_in(&both, &fe_models()).unwrap().notes;
    assert!(notes.iter().all(|n| !n.contains("balance")), "{notes:?}");
}

#[test]
fn gears_that_overlap_on_one_axis_are_reported() {
    let model = "{ kind = \"iso6336\", slices = 5 }";
    let third = |z_mm: f64| {
        at_rest(
            model,
            0.0,
            &format!(
                "[[body]]\nname = \"third\"\ngear = \"train_61.toml\"\nposition_mm = [0.0, 0.0, {z_mm}]\n\
                 [[joint]]\nname = \"c\"\nkind = \"fixed\"\nbody_1 = \"pinion\"\nbody_2 = \"third\"\n"
            ),
        )
    };
    let told = |z_mm: f64| {
        let notes = build_in(&third(z_mm), &fe_models()).unwrap().notes;
        notes.into_iter().find(|n| n.contains("overlap by"))
    };
    // They are 22 and 20 mm wide.
    let note = told(15.0).unwrap();
    assert!(
        note.contains("`pinion` and `third`") && note.contains("by 6.0000 mm"),
        "{note}"
    );
    assert_eq!(told(21.0), None);
}

/// The wheel is turned a little away from where its teeth touch: without a load it stays there, a load closes the gap.
#[test]
fn eigen_says_where_meshes_are_open() {
    let flanks = "teeth.flanks = \"right\"\n";
    let touching = at_rest("{ kind = \"iso6336\", slices = 5 }", 0.0, flanks);
    let built = build_in(&touching, &fe_models()).unwrap();
    let (_, _, turn) = crate::body(&built, "wheel").orientation.euler_angles();
    let apart = format!("cardan_deg = [0.0, 0.0, {}]", turn.to_degrees() + 0.005);
    let text = changed(&touching, "cardan_deg = [0, 0.0]", &apart);
    let pinion = "gear = \"train_27.toml\"\n";
    let text = changed(
        &text,
        pinion,
        &format!("{pinion}cardan_deg = [0.0, 0.0, 0.0]\n"),
    );
    let text = changed(
        &text,
        "kind = \"static\"\nload_factors = [0.5, 1.0]",
        "kind = \"eigen\"\nload_factors = [0.0, 1.0]",
    );
    let result = run(&text);
    let notes = result.head.notes.iter();
    let open: Vec<&String> = notes.filter(|n| n.contains("is open")).collect();
    assert!(
        open.len() == 1 && open[0].contains("1 of 2 operating points"),
        "{:?}",
        result.head.notes
    );
    assert!(open[0].contains("load factor 0)"), "{open:?}");
    // The point under load is the table's.
    let load = stages(&result).rows[0].load.unwrap();
    near(load.moments_nm[1], 100.0, 1e-6);
    assert!(load.loaded_pairs.unwrap() > 0.0);
}

/// A disc on springs that tilt, between a torque T that follows it and −T that keeps its axis: the stiffness of tilts
/// is [[k, −T], [T, k]] (docs/theory/multibody.md, "Loads that follow"), and modes have damping ratios of ±T/2k
/// without any damping.
#[test]
fn damping_of_torques_that_follow_is_explained() {
    let text = |torques: &str| {
        format!(
            "title = \"disc\"\n[run]\nkind = \"eigen\"\n\
             [[body]]\nname = \"disc\"\nmass_kg = 1.0\ninertia_kg_m2 = [1e-3, 1e-3, 2e-3]\n\
             [[bushing]]\nname = \"seat\"\nbody_2 = \"disc\"\nstiffness_N_per_mm = [1e3, 1e3, 1e3]\nstiffness_Nm_per_rad = [1e5, 1e5, 1e6]\n\
             {torques}"
        )
    };
    let result = run(&text(
        "[[load]]\nname = \"input\"\nbody = \"disc\"\ntorque_Nm = 100.0\n\
         [[load]]\nname = \"against\"\nbody = \"disc\"\ntorque_Nm = -100.0\nalong = [0.0, 0.0, 1.0]\n",
    ));
    let modes = result.eigen[0].modes.iter();
    let most = modes.map(|m| m.damping_ratio()).fold(0.0, f64::max);
    near(most, 0.5 * 100.0 / 1e5, 1e-5);
    let notes = || result.head.notes.iter();
    let told = notes().find(|n| n.contains("without damping")).unwrap();
    assert!(
        told.contains("±0.050 %") && told.contains("`input`, `against`"),
        "{told}"
    );
    let silent = run(&text(""));
    assert!((silent.head.notes.iter()).all(|n| !n.contains("without damping")));
}
