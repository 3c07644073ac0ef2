//! What a bearing is warned of, each beside its figure by hand.

use crate::common::{B218, B6205, PAIR, ROLLERS, TAPERED, close, definition};
use gearmesh_bearings::warnings::{Concern, Judged};
use gearmesh_bearings::{
    AppliedBearingLoad, BearingWarning, Life, Operation, QuasiStaticBearing, Ratings, StaticSafety,
    TiltCondition,
};

fn warnings(text: &str, force_n: [f64; 3], rpm: f64) -> Vec<BearingWarning> {
    warnings_tilted(text, force_n, rpm, [0.0; 2])
}

fn warnings_tilted(
    text: &str,
    force_n: [f64; 3],
    rpm: f64,
    tilt_rad: [f64; 2],
) -> Vec<BearingWarning> {
    let definition = definition(text);
    let bearing = QuasiStaticBearing::new(&definition).unwrap();
    let operation = Operation {
        inner_rad_per_s: rpm * std::f64::consts::PI / 30.0,
        ..Operation::default()
    };
    let load = AppliedBearingLoad {
        force_n,
        tilt: TiltCondition::Held(tilt_rad),
    };
    let pose = bearing.equilibrium(&load, &operation).unwrap();
    let (ring, loads) = bearing.loads(&pose, &operation).unwrap();
    let life = Life::of(&definition, &loads, force_n, &operation, None);
    let judged = Judged {
        definition: &definition,
        bearing: &bearing,
        pose: &pose,
        ring: &ring,
        loads: &loads,
        force_n,
        operation: &operation,
        life: &life,
    };
    judged.warnings()
}

fn of(found: &[BearingWarning], concern: Concern) -> Option<&BearingWarning> {
    found.iter().find(|warning| warning.concern == concern)
}

/// P₀ of ISO 76 by hand: 0.6 F_r + 0.5 F_a of a deep groove, 0.5 and 0.26 at 40°, 1 and 0.92 of a pair of 15°, 0.5 and
/// 0.22 cot α of tapered rollers; never less than F_r; none for cylindrical rollers but F_r.
#[test]
fn static_loads_are_those_of_iso_76() {
    let equivalent = |text: &str, force_n: [f64; 3]| {
        let definition = definition(text);
        let ratings = Ratings::of(&definition);
        let safety = StaticSafety::of(&definition, &ratings, force_n).unwrap();
        close(safety.factor * safety.equivalent_n, ratings.static_n, 1e-12);
        safety.equivalent_n
    };
    close(equivalent(B6205, [600.0, 800.0, -3000.0]), 2100.0, 1e-12);
    close(equivalent(B6205, [1000.0, 0.0, 100.0]), 1000.0, 1e-12);
    close(equivalent(B218, [1000.0, 0.0, 10_000.0]), 3100.0, 1e-12);
    let between = B218.replace("40.0", "27.5");
    close(equivalent(&between, [0.0, 0.0, 1000.0]), 355.0, 1e-9);
    close(equivalent(PAIR, [1000.0, 0.0, -1000.0]), 1920.0, 1e-12);
    let cot = 1.0 / 14.04_f64.to_radians().tan();
    close(
        equivalent(TAPERED, [100.0, 0.0, 1000.0]),
        50.0 + 220.0 * cot,
        1e-12,
    );
    close(equivalent(ROLLERS, [700.0, 0.0, 0.0]), 700.0, 1e-12);
    let flat = definition(&B218.replace("40.0", "4.0"));
    let ratings = Ratings::of(&flat);
    assert_eq!(StaticSafety::of(&flat, &ratings, [1.0; 3]), None);
}

/// A bearing within its limits is warned of nothing.
#[test]
fn usual_loads_raise_no_warning() {
    for (text, force) in [
        (B6205, [1000.0, 0.0, 100.0]),
        (B218, [5000.0, 0.0, 8000.0]),
        (ROLLERS, [3000.0, 0.0, 0.0]),
        (TAPERED, [4000.0, 0.0, 1500.0]),
    ] {
        assert_eq!(warnings(text, force, 1500.0), [], "{text}");
    }
}

/// Loads near C₀: s₀ below 1, pressures above 4200 MPa, P above 0.5 C, each with its figure.
#[test]
fn heavy_loads_are_warned_of() {
    let ratings = Ratings::of(&definition(B6205));
    let found = warnings(B6205, [1.25 * ratings.static_n, 0.0, 0.0], 0.0);
    close(of(&found, Concern::StaticSafety).unwrap().value, 0.8, 1e-9);
    let pressure = of(&found, Concern::Pressure).unwrap();
    // C₀ stands for 4200 MPa under 5 F/Z; without clearance the ball under the load has 4.37 F/Z (Stribeck). Pressure
    // goes with the cube root.
    close(
        pressure.value,
        4200.0 * (1.25_f64 * 4.37 / 5.0).cbrt(),
        5e-3,
    );
    assert!(pressure.text.contains("4200 MPa"), "{pressure}");
    let life = of(&found, Concern::LifeLoad).unwrap();
    close(life.limit, 0.5 * ratings.dynamic_n, 1e-12);
    assert!(life.excess() > 1.0);
    let rollers = Ratings::of(&definition(ROLLERS));
    let found = warnings(ROLLERS, [rollers.static_n, 0.0, 0.0], 0.0);
    let safety = of(&found, Concern::StaticSafety).unwrap();
    close(safety.excess(), 1.5, 1e-9);
}

/// Thrust on a deep groove lifts its balls up the shoulder. The ellipse's end by hand: α + asin(a/r) on a circle of r =
/// 0.52 D.
#[test]
fn ellipses_beyond_the_shoulder_are_warned_of() {
    let text = format!("{B6205}radial_clearance_um = 20.0\n");
    let force = [0.0, 0.0, 12_000.0];
    let definition = definition(&text);
    let bearing = QuasiStaticBearing::new(&definition).unwrap();
    let load = AppliedBearingLoad {
        force_n: force,
        tilt: TiltCondition::Held([0.0; 2]),
    };
    let pose = bearing.equilibrium(&load, &Operation::default()).unwrap();
    let (_, loads) = bearing.loads(&pose, &Operation::default()).unwrap();
    let ball = loads.elements[0][0];
    let half_m = bearing.rows[0].ellipses(&ball)[0].unwrap().half_length_m;
    let radius_m = 0.52 * 7.938e-3;
    let end = ball.inner_contact_angle_rad + (half_m / radius_m).asin();
    let height_mm = 1e3 * radius_m * (1.0 - end.cos());
    let estimated = warnings(&text, force, 0.0);
    let found = of(&estimated, Concern::Shoulder).unwrap();
    close(found.value, height_mm, 1e-9);
    close(found.limit, 0.2 * 7.938, 1e-9);
    assert!(found.text.contains("estimate"), "{found}");
    for (share, warned) in [(0.999, true), (1.001, false)] {
        let stated = format!("{text}shoulder_heights_mm = [{}, 3.5]\n", share * height_mm);
        let found = warnings(&stated, force, 0.0);
        assert_eq!(of(&found, Concern::Shoulder).is_some(), warned);
    }
    // The estimate follows steep angles: (1 − cos 70°)/2 of the diameter.
    let steep = crate::common::definition(B218);
    let gearmesh_bearings::definition::BearingGeometry::Ball(g) = &steep.geometry else {
        panic!("no balls")
    };
    let height = 0.5 * (1.0 - 70.0_f64.to_radians().cos()) * 22.23e-3;
    close(g.shoulder_heights_m()[0], height, 1e-12);
}

/// Light loads at speed, speeds, and few laminae.
#[test]
fn light_loads_and_speeds_are_warned_of() {
    let c = Ratings::of(&definition(B6205)).dynamic_n;
    let light = [0.005 * c, 0.0, 0.0];
    assert_eq!(warnings(B6205, light, 0.0), []);
    let found = warnings(B6205, light, 1000.0);
    let least = of(&found, Concern::MinimumLoad).unwrap();
    close(least.limit, 0.01 * c, 1e-12);
    assert!(least.value < least.limit);
    // 500 000 mm/min on 39.04 mm: 12 807 rpm.
    assert_eq!(warnings(B6205, [2000.0, 0.0, 0.0], 12_806.0), []);
    let found = warnings(B6205, [2000.0, 0.0, 0.0], 12_808.0);
    let fast = of(&found, Concern::Speed).unwrap();
    close(fast.value, 12_808.0 * 39.04, 1e-9);
    let coarse = format!("{ROLLERS}laminae = 29\n");
    let found = warnings(&coarse, [3000.0, 0.0, 0.0], 0.0);
    assert_eq!(of(&found, Concern::Laminae).unwrap().value, 29.0);
}

/// Loads of another unit move a ring by millimetres, tilts of another unit make moments that no bearing carries.
#[test]
fn nonsense_is_warned_of() {
    // Kilonewtons taken for newtons: the ring moves by more than a tenth of the balls' 7.938 mm.
    let found = warnings(B6205, [0.0, 0.0, 14e6], 0.0);
    let far = of(&found, Concern::Displacement).unwrap();
    close(far.limit, 0.7938, 1e-12);
    assert!(far.value > far.limit && far.text.contains("check the units"));
    // Play is no displacement of the bearing: 0.3 mm across, and 2A sin α = 0.68 mm along the axis.
    let loose = format!("{B6205}radial_clearance_um = 300.0\n");
    assert_eq!(
        of(
            &warnings(&loose, [0.0, 0.0, 500.0], 0.0),
            Concern::Displacement
        ),
        None
    );
    let ratings = Ratings::of(&definition(PAIR));
    let found = warnings_tilted(PAIR, [0.0; 3], 0.0, [8e-3, 0.0]);
    let moment = of(&found, Concern::Moment).unwrap();
    close(moment.limit, 0.5 * ratings.static_n * 0.065, 1e-12);
    assert_eq!(
        of(
            &warnings_tilted(PAIR, [0.0; 3], 0.0, [1e-3, 0.0]),
            Concern::Moment
        ),
        None
    );
}
