//! Forces of single pairs of teeth where a mesh is cut into slices: summed by pair, of bevel and of cylindrical gears.

use gearmesh_geometry::involute;
use gearmesh_scene::system_run::{RunJob, SystemResult};

use crate::common::*;
use crate::system_runs::Desk;

const PAIRS: usize = 4;

struct Run(SystemResult);

impl Run {
    fn new(scene: &str) -> Self {
        let job = RunJob::from_scene(load(scene, &fe_models()).unwrap()).unwrap();
        Self(Desk::new().run(job))
    }

    fn mesh(&self, name: &str) -> Vec<f64> {
        self.0.rows.read(&format!("elements/mesh/{name}")).unwrap()
    }

    fn pairs(&self, what: &str) -> Vec<Vec<f64>> {
        (1..=PAIRS)
            .map(|pair| self.mesh(&format!("pair_{pair}_{what}")))
            .collect()
    }

    /// In every row the forces of the pairs make the normal force, as many as carry, the highest on gear 1 first.
    fn sums_hold(&self) {
        let [right, left, loaded] = [
            "normal_force_right_N",
            "normal_force_left_N",
            "loaded_pairs",
        ]
        .map(|name| self.mesh(name));
        let (forces, teeth) = (self.pairs("force_N"), self.pairs("tooth_1"));
        let heights = self.pairs("height_1");
        let mut most = 0;
        for row in 0..loaded.len() {
            let sum: f64 = forces.iter().map(|of| of[row]).sum();
            let all = right[row] + left[row];
            assert!((sum - all).abs() < 1e-9 * all.max(1.0), "{sum}, {all} N");
            let count = teeth.iter().filter(|of| of[row] >= 0.0).count();
            assert_eq!(count as f64, loaded[row]);
            assert!((1..count).all(|k| heights[k - 1][row] >= heights[k][row]));
            most = most.max(count);
        }
        assert!(most >= 2, "never two pairs");
    }
}

/// Seed 001's pair on half spaces in slices: the sums; places lie on the flanks; a tooth takes its load up and gives
/// it back without a
/// jump, which the force of whichever pair comes first does not do.
#[test]
fn slices_of_bevel_teeth_are_summed_by_pair() {
    let scene = text("dynamics_bevel_20_20_slices.toml");
    let run = Run::new(&changed(&scene, "end_s = 0.06", "end_s = 0.024"));
    run.sums_hold();
    let (forces, teeth) = (run.pairs("force_N"), run.pairs("tooth_1"));
    for gear in [1, 2] {
        for way in ["along", "height"] {
            for (places, forces) in run.pairs(&format!("{way}_{gear}")).iter().zip(&forces) {
                let mut loaded = places.iter().zip(forces).filter(|(_, force)| **force > 0.0);
                assert!(loaded.all(|(place, _)| (0.0..=1.0).contains(place)));
            }
        }
    }
    // The passage of one tooth after the load has come up, at 10 ms.
    let rows = forces[0].len();
    let of_tooth = |tooth: f64| -> Vec<f64> {
        let force = |row: usize| {
            let own = (0..PAIRS).find(|pair| teeth[*pair][row] == tooth);
            own.map_or(0.0, |pair| forces[pair][row])
        };
        (rows / 2..rows).map(force).collect()
    };
    let whole = (0..20).map(|tooth| of_tooth(f64::from(tooth)));
    let passed = whole.filter(|own| {
        own[0] == 0.0 && own[own.len() - 1] == 0.0 && own.iter().any(|force| *force > 0.0)
    });
    let passed: Vec<Vec<f64>> = passed.collect();
    assert!(!passed.is_empty(), "no tooth passed as a whole");
    for own in passed {
        let most = own.iter().copied().fold(0.0, f64::max);
        let jumps = own.windows(2).map(|two| (two[1] - two[0]).abs());
        let jump = jumps.fold(0.0, f64::max);
        // A pair carries over about 1.6 pitches of 50 rows; a straight rise over a tenth of that would step by 1/8.
        assert!(jump < 0.125 * most, "{jump} of {most} N");
    }
}

/// Spur teeth at rest: the pressure of a pair is Hertz' for two cylinders with the radii of curvature at its place.
#[test]
fn pairs_of_cylindrical_teeth_have_force_place_and_pressure() {
    let mut scene = text("dynamics_17_25.toml");
    for (from, to) in [
        ("end_s = 2.0", "end_s = 0.008"),
        ("step_s = 2e-5", "step_s = 2e-5\nstart = \"equilibrium\""),
        (
            "{ step = { start_s = 0.0, from = 0.0, end_s = 1.0, to = -500.0 } }",
            "-500.0",
        ),
        (
            "{ step = { start_s = 0.0, from = 0.0, end_s = 1.0, to = -450.0 } }",
            "-450.0",
        ),
        (
            "name = \"pinion\"\ngear",
            "name = \"pinion\"\nspeed_rpm = -500.0\ngear",
        ),
        (
            "gear = \"wheel_25_m10.toml\"",
            "speed_rpm = 340.0\ngear = \"wheel_25_m10.toml\"",
        ),
        (
            "gear_2 = \"gear\"\n",
            "gear_2 = \"gear\"\ntooth_pairs = {}\n",
        ),
    ] {
        scene = changed(&scene, from, to);
    }
    let run = Run::new(&scene);
    run.sums_hold();

    let document =
        |name: &str| gearmesh_geometry::GearDefinition::read(&fe_models().join(name)).unwrap();

    let [pinion, wheel] = ["pinion_17.toml", "wheel_25_m10.toml"].map(document);
    let modulus = |gear: &gearmesh_geometry::GearDefinition| {
        (1.0 - gear.material.poisson.powi(2)) / gear.material.young_pa
    };
    let modulus_pa = 1.0 / (modulus(&pinion) + modulus(&wheel));
    let (profile, mate) = (&pinion.profile, &wheel.profile);
    let base_m = [profile.base_radius_m, mate.base_radius_m];
    let path_m = (0.2101_f64.powi(2) - (base_m[0] + base_m[1]).powi(2)).sqrt();
    let (forces, heights) = (run.pairs("force_N"), run.pairs("height_1"));
    let (pressures, along) = (run.pairs("pressure_Pa"), run.pairs("along_1"));
    let mut compared = 0;
    for pair in 0..PAIRS {
        for row in 0..forces[pair].len() {
            let (force, height) = (forces[pair][row], heights[pair][row]);
            // Inside the flank, where no edge holds the contact; the support deflects by some micrometres of the path.
            if force < 100.0 || !(0.05..0.95).contains(&height) {
                continue;
            }
            assert!((along[pair][row] - 0.5).abs() < 1e-9);
            let [form, tip] = [profile.form_roll_rad, profile.flank_end_roll_rad];
            let radius_m = base_m[0] * (form + height * (tip - form));
            let relative_m = radius_m * (path_m - radius_m) / path_m;
            let line_load = force / pinion.tooth.face_width_m;
            let expected = (line_load * modulus_pa / (std::f64::consts::PI * relative_m)).sqrt();
            let found = pressures[pair][row];
            assert!(
                (found / expected - 1.0).abs() < 1e-3,
                "{found}, {expected} Pa"
            );
            compared += 1;
        }
    }
    assert!(compared > 20, "{compared} places");
    assert!(involute::radius_m(profile.form_roll_rad, base_m[0]) > 0.0);
}

/// Materials are those of the gears; a spring for the whole mesh knows no pairs.
#[test]
fn what_the_model_does_not_know_is_refused() {
    let scene = text("dynamics_17_25.toml");
    let with = |table: &str| {
        let line = format!("gear_2 = \"gear\"\ntooth_pairs = {table}\n");
        changed(&scene, "gear_2 = \"gear\"\n", &line)
    };
    let refused = |scene: &str| build(scene).err().unwrap().to_string();
    let stated = refused(&with("{ young_GPa = 210.0 }"));
    assert!(stated.contains("tooth_pairs.young_GPa"), "{stated}");
    let start = with("{}").find("kind = \"impact\"").unwrap();
    let end = start + with("{}")[start..].find("\n\n").unwrap();
    let whole = with("{}");
    let spring = format!("{}kind = \"iso6336\"{}", &whole[..start], &whole[end..]);
    let refused = refused(&spring);
    assert!(refused.contains("no single teeth"), "{refused}");
}
