//! Scenes of a pair: against the functions of the rating crate on the same curves, over one revolution and over two,
//! and what is refused.

use crate::made_up_gears::pair;
use crate::rating::{STEEL, TABLE, folder, near};
use gearmesh_geometry::input::InputDocument;
use gearmesh_rating::{
    MeanStress, Passage, RootConstruction, RootSection, SnCurve, SurfaceState, flank_pressure,
    highest_single_contact_rolls_rad, history_damage, lewis_stress_pa, root_stress_pa,
};
use gearmesh_scene::{RunError, Scene, SceneResult, load, run};
use std::path::Path;

const SCENE: &str = r#"title = "made up"
[pair]
gear_1 = "gear_30.h5"
gear_2 = "gear_41.h5"
centre_distance_mm = 106.8
[mesh]
model.kind = "hybrid"
model.local = "weber-banaschek"
teeth.path = "line-of-action"
[run]
torques_Nm = [100.0, 200.0]
pitches = 41
points_per_pitch = 6
[gauges]
gear_1 = ["g0"]
gear_2 = ["g5", "g0"]
[[rating]]
kind = "fatigue"
gauge = "g5"
sn_table = "sn.toml"
[[rating]]
kind = "fatigue"
gauge = "g0"
gear = 2
sn_table = "sn.toml"
method = 1
surface = "uniaxial"
mean_stress = "goodman"
tensile_strength_MPa = 1200.0
passage = "once"
[[rating]]
kind = "nominal"
[[rating]]
kind = "nominal"
load_point = "tip"
"#;

fn ran(text: &str, folder: &Path) -> Result<SceneResult, RunError> {
    let scene = Scene::from_document(InputDocument::new("scene.toml", text), folder)?;
    run(&load(scene)?, &|_, _| ())
}

#[test]
fn ratings_are_those_of_the_curves() {
    let folder = folder();
    let result = ran(SCENE, folder.path()).unwrap();
    assert_eq!(result.ratings.len(), 8);
    let curve = SnCurve::from_toml(TABLE).unwrap();
    let goodman = MeanStress::Goodman {
        tensile_strength_pa: 1200e6,
    };
    let (pair, width_m, module_m) = (pair(), 20e-3, 3e-3);
    let single = highest_single_contact_rolls_rad(&pair).unwrap();
    let tips = [&pair.gear_1, &pair.gear_2].map(|gear| gear.flank_end_roll_rad);
    for torque in 0..2 {
        let rated = |k: usize| &result.ratings[4 * torque + k];
        let figure = |k: usize, name: &str| rated(k).figure(name).unwrap();
        let series = &result.strain;
        for (k, strain, surface, mean, passage) in [
            (
                0,
                &series[1].method_2,
                SurfaceState::PlaneStrain,
                MeanStress::None,
                Passage::Repeated,
            ),
            (
                1,
                &series[2].method_1,
                SurfaceState::Uniaxial,
                goodman,
                Passage::Once,
            ),
        ] {
            let stress = root_stress_pa(result.curve(strain, torque), STEEL, surface);
            let expected = history_damage(&stress, passage, &curve, mean).unwrap();
            assert!(
                expected.cycles > 0.0 && expected.per_passage > 0.0,
                "{expected:?}"
            );
            assert_eq!(figure(k, "cycles"), expected.cycles);
            near(figure(k, "damage"), expected.per_passage, 1e-9);
            near(figure(k, "life_revolutions"), expected.life_in(1.0), 1e-9);
            assert_eq!(rated(k).figure("life_h"), None);
        }
        // Spur teeth without friction: all force has the base radius as lever.
        let force = result.torque_nm[torque] / pair.gear_2.base_radius_m;
        let tangential = force * pair.gear_1.base_radius_m / pair.gear_1.reference_radius_m;
        for (k, rolls) in [(2, single), (3, tips)] {
            near(figure(k, "largest_force_N"), force, 1e-9);
            for (gear, (tooth, roll)) in [&pair.gear_1, &pair.gear_2]
                .into_iter()
                .zip(rolls)
                .enumerate()
            {
                let section = RootSection::new(tooth, roll, RootConstruction::Parabola).unwrap();
                let factor = section.lewis_factor(module_m);
                let expected = lewis_stress_pa(tangential, width_m, module_m, factor);
                near(
                    figure(k, &format!("lewis_stress_gear{}_Pa", gear + 1)),
                    expected,
                    1e-6,
                );
            }
            // Gear 1 is the smaller one: the flanks are most curved where its tooth begins to carry alone.
            let roll = pair.roll_end_1_rad - pair.pitch_1_rad();
            let found = flank_pressure(&pair, roll, force / width_m, [STEEL; 2]).unwrap();
            near(figure(k, "hertz_pressure_Pa"), found.peak_pressure_pa, 1e-9);
        }
    }
    assert_eq!(result.ratings[4].name, "gauge g5 of gear 2 at 200 N m");
    let file = folder.path().join("result.h5");
    result.write(&file).unwrap();
    assert_eq!(SceneResult::read(&file).unwrap().ratings, result.ratings);
}

/// The teeth are alike: the second revolution is as damaging as the first, and the life in revolutions is the same.
#[test]
fn two_revolutions_are_twice_one() {
    let folder = folder();
    let once = ran(SCENE, folder.path()).unwrap();
    let twice = ran(
        &SCENE.replacen("pitches = 41", "pitches = 82", 1),
        folder.path(),
    )
    .unwrap();
    let of = |result: &SceneResult, name: &str| result.ratings[0].figure(name).unwrap();
    assert_eq!(of(&twice, "cycles"), 2.0 * of(&once, "cycles"));
    near(of(&twice, "damage"), 2.0 * of(&once, "damage"), 1e-6);
    near(
        of(&twice, "life_revolutions"),
        of(&once, "life_revolutions"),
        1e-6,
    );
    near(
        of(&once, "life_revolutions"),
        1.0 / of(&once, "damage"),
        1e-12,
    );
}

#[test]
fn ratings_that_cannot_be_are_refused() {
    let folder = folder();
    for (from, to, part) in [
        (
            "gear = 2\n",
            "",
            "rating.1.gear: missing; gauges of both gears are called `g0`",
        ),
        (
            "gear = 2\n",
            "gear = 3\n",
            "rating.1.gear: found 3, allowed is 1 to 2",
        ),
        (
            "gauge = \"g5\"",
            "gauge = \"g9\"",
            "rating.0.gauge: [gauges] reads no gauge `g9` of either gear; it reads: g0, g5, g0",
        ),
        (
            "gauge = \"g5\"",
            "gauge = \"g5\"\ngear = 1",
            "rating.0.gauge: [gauges] reads no gauge `g5` of gear 1; it reads: g0",
        ),
        (
            "gear = 2\n",
            "gear = 1\n",
            "rating.1.gauge: its history must be whole revolutions of gear 1: run.pitches is 41, allowed are multiples of its 30 teeth",
        ),
        (
            "gear = 2\n",
            "body = \"wheel\"\n",
            "rating.1.body: is not used by a scene of a [pair]; gear = 1 or 2 says whose gauge it is; remove it",
        ),
        (
            "kind = \"nominal\"",
            "kind = \"nominal\"\nmesh = \"mesh\"",
            "rating.2.mesh: is not used by a scene of a [pair], which has one mesh; remove it",
        ),
        (
            "kind = \"nominal\"",
            "kind = \"nominal\"\nfrom_s = 0.1",
            "rating.2.from_s: is not used by a scene of a [pair], which has no time; remove it",
        ),
        (
            "kind = \"nominal\"",
            "kind = \"nominal\"\ngear = 1",
            "rating.2: `gear` belongs to kind \"fatigue\", not to \"nominal\"",
        ),
        ("sn.toml", "no.toml", "rating.0.sn_table: the S-N table"),
    ] {
        assert!(SCENE.contains(from), "{from}");
        let text = SCENE.replacen(from, to, 1);
        let complaint = ran(&text, folder.path()).unwrap_err().to_string();
        for part in ["scene.toml:", part] {
            assert!(complaint.contains(part), "`{part}` is not in\n{complaint}");
        }
    }
}
