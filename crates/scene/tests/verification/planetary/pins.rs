//! Pins that bend between side plates, against beams in closed form.

use std::f64::consts::PI;

use nalgebra::Vector2;

use super::positions::{ALPHA_DEG, unit};
use super::*;

/// Diameter and span of a pin \[m\], Young's modulus \[Pa\], Poisson's ratio.
const PIN: [f64; 4] = [20e-3, 40e-3, 206e9, 0.3];
const TORQUE_NM: f64 = 600.0;

fn set(run: &str, sun: &str, planets: &str) -> String {
    let carrier = format!(
        "inertia_kg_m2 = [0.1, 0.1, 0.1]\ntorque_Nm = {:?}",
        -TORQUE_NM
    );
    let planets = format!("count = 3\n{planets}");
    scene(
        run,
        90.0,
        [sun, "support = \"held\"", &carrier, &planets, ""],
    )
}

/// Where a planet stands against the carrier: out and on \[m\].
fn in_carrier(result: &SystemResult, planet: usize) -> Vector2<f64> {
    let read = |name: String| result.rows.read(&name).unwrap()[0];
    let at =
        |body: &str| Vector2::from(["x", "y"].map(|axis| read(format!("bodies/{body}/{axis}_m"))));
    let turn = read("bodies/set carrier/turn_rad".to_owned());
    let out = unit(std::f64::consts::TAU * (planet - 1) as f64 / 3.0 + turn);
    let place = at(&format!("set planet {planet}")) - at("set carrier");
    Vector2::new(place.dot(&out), place.dot(&Vector2::new(-out.y, out.x)))
}

/// A force P in the middle between two plates moves the middle by P L³/192EI + P L/4κGA, and does not tilt it, so that
/// it does not matter what the teeth hold; κ = 6(1 + ν)/(7 + 6ν) of a full circle. Both meshes push a planet round with
/// 2F cos α = T/3a, out by nothing.
#[test]
fn a_pin_between_two_plates_deflects_as_a_beam() {
    let folder = tempfile::tempdir().unwrap();
    write_gears(folder.path(), [24, 36], ALPHA_DEG);
    let kind = "kind = \"static\"\nmotion = \"set sun speed\"\nangles_deg = [0.0]";
    let result = run(
        &set(
            kind,
            "speed_rpm = 600.0",
            "pin = { diameter_mm = 20.0, plates_mm = [-20.0, 20.0] }",
        ),
        folder.path(),
    );
    let [d, length, young, nu] = PIN;
    let (area, inertia) = (PI * d * d / 4.0, PI * d.powi(4) / 64.0);
    let shear = young / (2.0 * (1.0 + nu)) * 6.0 * (1.0 + nu) / (7.0 + 6.0 * nu) * area;
    let force = TORQUE_NM / 3.0 / 0.09;
    let expected = force * (length.powi(3) / (192.0 * young * inertia) + length / (4.0 * shear));
    for planet in 1..=3 {
        let found = in_carrier(&result, planet) - Vector2::new(0.09, 0.0);
        assert!(
            (found.y.abs() / expected - 1.0).abs() < 1e-3 && found.x.abs() < 1e-2 * expected,
            "{planet}: {found} {expected:e}"
        );
    }
    let figures = result.sets().unwrap().remove(0);
    for pin in figures.pin_force_n.unwrap() {
        assert!((pin / force - 1.0).abs() < 1e-3, "{pin} {force}");
    }
}

/// In time carrier and pins turn as one at the start, and energy balances; planets on bearings beside each other stand
/// on stations of their own.
#[test]
fn a_set_with_pins_that_bend_runs_in_time() {
    let folder = tempfile::tempdir().unwrap();
    write_gears(folder.path(), [24, 36], ALPHA_DEG);
    let keys = "kind = \"transient\"\nend_s = 0.002\n[solver]\nstep_s = 1e-5\nstart = \"equilibrium\"\n[output]\ninterval_s = 1e-4";
    let linear = "model = { kind = \"linear\", radial_stiffness_N_per_mm = 5e5, axial_stiffness_N_per_mm = 2e5 }";
    let planets = format!(
        "bearings = [{{ z_mm = -8.0, {linear} }}, {{ z_mm = 8.0, {linear} }}]\n\
         pin = {{ diameter_mm = 20.0, inner_diameter_mm = 6.0, plates_mm = [-20.0], damping_s = 1e-6 }}"
    );
    let text = set(keys, "speed_rpm = 600.0", &planets).replace(
        "stiffness_N_per_mm_um = 20.0",
        "stiffness_N_per_mm_um = 20.0, damping = { kind = \"stiffness-proportional\", time_s = 1e-6, full_depth_um = 1.0 }",
    );
    let built = build_in(&text, folder.path()).unwrap();
    let carrier = crate::spin(&built, "set carrier");
    assert!(carrier > 1.0, "{carrier}");
    for station in ["set planet 2 pin beam/0", "set planet 2 pin beam/2"] {
        let body = crate::body(&built, station);
        assert!((body.angular_velocity_rad_per_s.z / carrier - 1.0).abs() < 1e-9);
        let speed = body.velocity_m_per_s.norm();
        assert!((speed / (0.09 * carrier) - 1.0).abs() < 1e-9, "{speed}");
    }
    let result = run(&text, folder.path());
    let error = result.relative_energy_error().unwrap();
    assert!(error < 1e-3, "{error:e}");
}

/// Pins that are displaced and lean are beams that do, and their stations turn with the carrier.
#[test]
fn pins_that_lean_bend() {
    let folder = tempfile::tempdir().unwrap();
    write_gears(folder.path(), [24, 36], ALPHA_DEG);
    let deviation = "deviation = [{ planet = 1, radial_um = 5.0, tilt_radial_mrad = 0.5, tilt_tangential_mrad = -0.3 }]";
    let planets = format!("pin = {{ diameter_mm = 20.0, plates_mm = [-20.0, 20.0] }}\n{deviation}");
    let result = run(
        &set("kind = \"static\"", "speed_rpm = 600.0", &planets),
        folder.path(),
    );
    let forces = result.sets().unwrap().remove(0).pin_force_n.unwrap();
    let all: f64 = forces.iter().sum();
    assert!((all * 0.09 / TORQUE_NM - 1.0).abs() < 1e-3, "{forces:?}");
}

#[test]
fn pins_that_cannot_bend_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    write_gears(folder.path(), [24, 36], ALPHA_DEG);
    for (pin, expected) in [
        ("plates_mm = []", "planets.pin.plates_mm: found 0 places"),
        ("plates_mm = [0.0]", "nothing of it bends"),
        (
            "plates_mm = [-20.0], inner_diameter_mm = 20.0",
            "planets.pin.inner_diameter_mm: found 20, allowed is less than diameter_mm, 20",
        ),
    ] {
        let planets = format!("pin = {{ diameter_mm = 20.0, {pin} }}");
        let refused = build_in(&set("kind = \"static\"", "", &planets), folder.path());
        let message = refused.map(|_| ()).unwrap_err().to_string();
        assert!(message.contains(expected), "{expected}: {message}");
    }
}

/// Natural frequencies of a set whose planets stand on bearings on light pins that bend are those on bearings as soft
/// as both in a row: a spur set moves in its plane, where a force in the middle between the plates bends the pin alone.
#[test]
fn modes_of_a_set_feel_its_pins() {
    let folder = tempfile::tempdir().unwrap();
    write_gears(folder.path(), [24, 36], ALPHA_DEG);
    let [d, length, young, nu] = PIN;
    let (area, inertia) = (PI * d * d / 4.0, PI * d.powi(4) / 64.0);
    let shear = young / (2.0 * (1.0 + nu)) * 6.0 * (1.0 + nu) / (7.0 + 6.0 * nu) * area;
    let pin = length.powi(3) / (192.0 * young * inertia) + length / (4.0 * shear);
    let modes = |radial_n_per_m: f64, pin: &str| -> Vec<f64> {
        let bearing = format!(
            "support = \"floating\"\nbearings = [{{ model = {{ kind = \"linear\", radial_stiffness_N_per_mm = {:?}, \
             axial_stiffness_N_per_mm = 1e5, tilt_stiffness_Nm_per_rad = 1e5 }} }}]\n{pin}",
            1e-3 * radial_n_per_m
        );
        let text = set(
            "kind = \"eigen\"\nmost_frequency_Hz = 4000.0",
            "speed_rpm = 600.0",
            &bearing,
        );
        let result = run(&text, folder.path());
        let modes = result.eigen[0].modes.iter();
        modes
            .map(|mode| mode.frequency_hz())
            .filter(|hz| *hz > 1.0)
            .collect()
    };
    let bearing = 2e8;
    let stiff = modes(bearing, "");
    let soft = modes(1.0 / (1.0 / bearing + pin), "");
    let found = modes(
        bearing,
        "pin = { diameter_mm = 20.0, plates_mm = [-20.0, 20.0], density_kg_per_m3 = 1.0 }",
    );
    assert!(soft[0] < 0.97 * stiff[0], "{soft:?} {stiff:?}");
    // Pins that bend give planets modes along and askew to their axes as well; 1e-5 is the pins' mass.
    for expected in &soft {
        let nearest = found.iter().map(|hz| (hz / expected - 1.0).abs());
        let off = nearest.fold(f64::INFINITY, f64::min);
        assert!(off < 1e-5, "{expected}: {found:?}");
    }
}
