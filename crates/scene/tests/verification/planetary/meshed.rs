//! Meshed planets (sun, planet, partner, ring): speeds, forces, places, phases, load sharing, motion.

use std::f64::consts::TAU;

use nalgebra::{Complex, Vector2};

use super::positions::{ALPHA_DEG, unit};
use super::*;

/// Planets of 18 teeth at the sun, of 20 at the ring, all of module 3.
const PLANETS: [usize; 2] = [18, 20];
/// Stiffness of a mesh, 20 N/(mm µm) on 25 mm \[N/m\].
const MESH: f64 = 5e8;

/// Gear files of sun and ring of so many teeth, `planet.toml` and `partner.toml`.
pub fn write_meshed(folder: &Path, [sun, ring]: [usize; 2]) {
    write_gears(folder, [PLANETS[0], PLANETS[1]], ALPHA_DEG);
    let read = |name: &str| std::fs::read_to_string(folder.join(name)).unwrap();
    let (planet, partner, rim) = (read("sun.toml"), read("planet.toml"), read("ring.toml"));
    let write = |name: &str, text: String| std::fs::write(folder.join(name), text).unwrap();
    let own_ring = PLANETS[0] + 2 * PLANETS[1];
    let rim = changed(
        &rim,
        &format!("teeth = -{own_ring}"),
        &format!("teeth = -{ring}"),
    );
    let outside = |ring: usize| format!("outer_diameter_mm = {}", 3 * ring + 30);
    write(
        "ring.toml",
        changed(&rim, &outside(own_ring), &outside(ring)),
    );
    write(
        "sun.toml",
        changed(&planet, "teeth = 18", &format!("teeth = {sun}")),
    );
    write("planet.toml", planet);
    write("partner.toml", partner);
}

/// Distances of the pins of planets and partners from the axis, and from each other \[m\].
pub fn arms_m([sun, ring]: [usize; 2]) -> [f64; 3] {
    let [planet, partner] = PLANETS;
    [sun + planet, ring - partner, planet + partner].map(|teeth| 1.5e-3 * teeth as f64)
}

/// δ by the law of cosines \[rad\].
pub fn ahead_rad(teeth: [usize; 2]) -> f64 {
    let [a, b, d] = arms_m(teeth);
    ((a * a + b * b - d * d) / (2.0 * a * b)).acos()
}

/// A scene with one set of meshed planets; `more`: keys of the partners.
pub fn meshed(
    run: &str,
    teeth: [usize; 2],
    [sun, ring, carrier, planets, more]: [&str; 5],
) -> String {
    let [own, partner, pair] = arms_m(teeth).map(|arm| 1e3 * arm);
    let carrier = format!("inertia_kg_m2 = [0.1, 0.1, 0.1]\n{carrier}");
    let mesh = "pair_mesh = { model = { kind = \"iso6336\", stiffness_N_per_mm_um = 20.0 } }";
    let text = scene(run, own, [sun, ring, &carrier, planets, mesh]);
    format!(
        "{text}[planetary.planets.partner]\ngear = \"partner.toml\"\ncentre_distance_mm = {partner:?}\npair_distance_mm = {pair:?}\n{more}\n"
    )
}

const IN_TIME: &str =
    "kind = \"transient\"\nend_s = 0.01\n[solver]\nstep_s = 1e-5\n[output]\ninterval_s = 1e-3";

/// ω_r − ω_c = (z_s/z_r)(ω_s − ω_c), whichever member stands: with the ring held sun and carrier turn against each
/// other, 1 − z_r/z_s = −2.
#[test]
fn speeds_of_meshed_planets_follow_willis() {
    let folder = tempfile::tempdir().unwrap();
    write_meshed(folder.path(), [24, 72]);
    let held = "support = \"held\"";
    for (keys, expected) in [
        (["speed_rpm = 500.0", held, ""], [500.0, 0.0, -250.0]),
        ([held, "", "speed_rpm = 300.0"], [0.0, 200.0, 300.0]),
        (["speed_rpm = 300.0", "", held], [300.0, 100.0, 0.0]),
        ([held, "speed_rpm = 200.0", ""], [0.0, 200.0, 300.0]),
    ] {
        for side in ["", "side = \"behind\""] {
            let parts = [keys[0], keys[1], keys[2], "count = 3", side];
            let built = build_in(&meshed(IN_TIME, [24, 72], parts), folder.path()).unwrap();
            let rpm = |part: &str| crate::spin(&built, &format!("set {part}")) * 60.0 / TAU;
            for (part, expected) in ["sun", "ring", "carrier"].into_iter().zip(expected) {
                assert!(
                    (rpm(part) - expected).abs() < 1e-9,
                    "{keys:?} {part}: {}",
                    rpm(part)
                );
            }
            let against = (expected[0] - expected[2]) / 18.0 * 24.0;
            let planet = expected[2] - against;
            let partner = expected[2] + against * 18.0 / 20.0;
            assert!((rpm("planet 2") - planet).abs() < 1e-9);
            assert!((rpm("partner 3") - partner).abs() < 1e-9);
        }
    }
    let built = build_in(&documented("set", IN_TIME), folder.path()).unwrap();
    let found = crate::spin(&built, "set carrier") / crate::spin(&built, "set sun");
    assert!((found + 0.5).abs() < 1e-9, "documented: {found}");
}

/// By hand: a pair that is taken round by ψ with the sun standing has its partner turned by −z_s ψ/z_2 against the
/// pair, up to whole pitches; the ring asks for −z_r ψ/z_2. 48 places of 24 and 72 teeth, of which three pairs have
/// room at equal angles, five do not fit and four touch.
#[test]
fn meshed_planets_stand_where_both_gears_fit() {
    let folder = tempfile::tempdir().unwrap();
    write_meshed(folder.path(), [24, 72]);
    let built = |planets: &str, more: &str| {
        let parts = ["", "support = \"held\"", "torque_Nm = -5.0", planets, more];
        build_in(&meshed("kind = \"static\"", [24, 72], parts), folder.path())
    };
    let fits = |psi: f64| {
        let off = 72.0 / 20.0 * psi - 24.0 / 20.0 * psi;
        let pitches = off / (TAU / 20.0);
        (pitches - pitches.round()).abs() < 1e-9
    };
    for k in 28..=36 {
        let psi_deg = 3.75 * f64::from(k);
        let found = built(&format!("angles_deg = [0.0, {psi_deg:?}]"), "");
        assert_eq!(found.is_ok(), fits(psi_deg.to_radians()), "{psi_deg}");
    }
    for (planets, more, expected) in [
        ("count = 5", "", "360/48 deg"),
        (
            "count = 4",
            "",
            "planets: planet 1 and partner 4 touch each other: their axes are 54.4",
        ),
        (
            "count = 4",
            "",
            "at equal angles 3 pairs or fewer have room",
        ),
        (
            "count = 3\nsecond = { gear = \"planet.toml\", z_mm = 1.0 }",
            "",
            "planets.second: is not used with partner",
        ),
        (
            "count = 3",
            "deviation = [{ planet = 4 }]",
            "planets.partner.deviation.0.planet: found 4, the set has planets 1 to 3",
        ),
        (
            "count = 3",
            "support = \"held\"",
            "planets.partner.support: found \"held\"",
        ),
        (
            "count = 3",
            "planets_of = \"other\"",
            "planets.partner.gear: is not used with planets_of",
        ),
    ] {
        let complaint = built(planets, more).err().unwrap().to_string();
        assert!(
            complaint.contains(expected),
            "`{expected}` is not in: {complaint}"
        );
    }
    let text = |from: &str, to: &str| {
        let parts = [
            "",
            "support = \"held\"",
            "torque_Nm = -5.0",
            "count = 3",
            "",
        ];
        let text = changed(&meshed("kind = \"static\"", [24, 72], parts), from, to);
        let refusal = build_in(&text, folder.path()).err();
        refusal.map_or_else(|| format!("nothing, with {to}"), |e| e.to_string())
    };
    for (from, to, expected) in [
        (
            "pair_distance_mm = 57.0",
            "pair_distance_mm = 60.0",
            "partner do not run together",
        ),
        (
            "pair_distance_mm = 57.0",
            "pair_distance_mm = 142.0",
            "pair_distance_mm: found 142 mm; with pins 63.0000 and 78.0000 mm from the axis allowed are distances between 15.0000 and 141.0000 mm",
        ),
        (
            "centre_distance_mm = 78.0",
            "centre_distance_mm = 79.0",
            "partner and ring do not run together",
        ),
        (
            "pair_mesh = ",
            "# pair_mesh = ",
            "pair_mesh: missing; `planets.partner` needs it",
        ),
        (
            "gear = \"partner.toml\"",
            "",
            "planets.partner.gear: missing",
        ),
    ] {
        let complaint = text(from, to);
        assert!(
            complaint.contains(expected),
            "`{expected}` is not in: {complaint}"
        );
    }
}

/// Force of unit normal forces of its meshes on a planet and on its partner, with the torque σ on the sun.
pub fn unit_forces(
    angle_rad: f64,
    ahead_rad: f64,
    arms_m: [f64; 3],
    sense: f64,
) -> [Vector2<f64>; 2] {
    let (sin, cos) = ALPHA_DEG.to_radians().sin_cos();
    let on = |out: Vector2<f64>| Vector2::new(-out.y, out.x);
    let (own, other) = (unit(angle_rad), unit(angle_rad + ahead_rad));
    let between = (arms_m[1] * other - arms_m[0] * own).normalize();
    let from_sun = sense * cos * on(own) + sin * own;
    let on_partner = -sense * cos * on(between) + sin * between;
    let on_ring = sense * cos * on(other) + sin * other;
    [from_sun - on_partner, on_partner - on_ring]
}

/// At rest all pairs carry the same, each mesh of a pair as much as the other two; T_r = −T_s z_r/z_s, and pins bear
/// what is left of the forces of two meshes. With partners behind their planets everything is mirrored.
#[test]
fn forces_of_meshed_planets_are_in_equilibrium() {
    let folder = tempfile::tempdir().unwrap();
    let teeth = [24, 72];
    write_meshed(folder.path(), teeth);
    let (cos, base_m) = (ALPHA_DEG.to_radians().cos(), 36e-3);
    let angles = "angles_deg = [0.0, 3.1, 100.0, 250.0]";
    let kind = format!("kind = \"static\"\nmotion = \"set sun speed\"\n{angles}");
    // The carrier turns backwards and is held back: T_c = T_s (z_r/z_s − 1), T_s against it.
    for (side, ahead, torque_nm) in [
        ("ahead", 1.0, 400.0),
        ("behind", -1.0, -400.0),
        ("behind", -1.0, 400.0),
    ] {
        let sun_nm: f64 = torque_nm / 2.0;
        let sense = sun_nm.signum();
        let carrier = format!("torque_Nm = {torque_nm:?}");
        let more = format!("side = \"{side}\"");
        let parts = [
            "speed_rpm = 0.0",
            "support = \"held\"",
            &carrier,
            "count = 3",
            &more,
        ];
        let result = run(&meshed(&kind, teeth, parts), folder.path());
        let read = |name: &str| result.rows.read(name).unwrap();
        let force = sun_nm.abs() / (3.0 * base_m * cos);
        let sides = if sense > 0.0 {
            ["left", "right"]
        } else {
            ["right", "left"]
        };
        for (row, carrier_rad) in read("bodies/set carrier/turn_rad").iter().enumerate() {
            for n in 1..=3 {
                for (mesh, side) in [
                    (format!("sun-planet {n}"), sides[0]),
                    (format!("planet {n}-partner"), sides[1]),
                    (format!("partner {n}-ring"), sides[0]),
                ] {
                    let found = read(&format!("elements/set {mesh}/normal_force_{side}_N"))[row];
                    assert!(
                        (found / force - 1.0).abs() < 1e-6,
                        "{side} {mesh} {row}: {found} {force}"
                    );
                }
                let angle = TAU * f64::from(n - 1) / 3.0 + carrier_rad;
                let on_both = unit_forces(angle, ahead * ahead_rad(teeth), arms_m(teeth), sense);
                for (planet, meshes) in ["planet", "partner"].into_iter().zip(on_both) {
                    let pin = ["x", "y"].map(|axis| {
                        read(&format!("joints/set {planet} {n} pin/force_world_{axis}_N"))[row]
                    });
                    let rest = Vector2::from(pin) + force * meshes;
                    assert!(
                        rest.norm() < 1e-6 * force,
                        "{side} {planet} {n} {row}: {rest}"
                    );
                }
            }
            for (member, expected) in [("ring axis", -3.0 * sun_nm), ("sun speed", sun_nm)] {
                let found = read(&format!("joints/set {member}/moment_z_Nm"))[row];
                assert!((found / expected - 1.0).abs() < 1e-6, "{member}: {found}");
            }
        }
        let figures = result.sets().unwrap().remove(0);
        for shares in [figures.sun, figures.pair, figures.ring] {
            assert!((shares.unwrap().mesh_load_factor() - 1.0).abs() < 1e-6);
        }
        // Equal meshes under a constant torque: no error but that of the solution.
        let error = figures.transmission_error_rad.unwrap();
        assert!(
            error < 1e-9,
            "{side} {torque_nm}: {error:e}, {:?}",
            read("bodies/set carrier/turn_rad")
        );
        let [planet, partner] = unit_forces(0.0, ahead * ahead_rad(teeth), arms_m(teeth), sense);
        for (found, expected) in [
            (figures.pin_force_n, planet),
            (figures.partner_pin_force_n, partner),
        ] {
            let found = found.unwrap()[1];
            assert!((found / (force * expected.norm()) - 1.0).abs() < 1e-6);
        }
    }
}

/// A displaced pin opens the three meshes of its pair, springs of k/3 together, by its displacement along the force
/// that the meshes have on the planet: F_n = F + K (mean of E − E_n). The change of the pressure angles by 20 µm is of
/// the second order, e²/2a: 1e-3 of the gap, and turns its direction by e/a.
#[test]
fn pairs_share_the_load_as_springs_do() {
    let folder = tempfile::tempdir().unwrap();
    let teeth = [24, 72];
    write_meshed(folder.path(), teeth);
    let (force, base_m) = (2e4, 36e-3 * ALPHA_DEG.to_radians().cos());
    let stiffness = MESH / 3.0;
    for (radial_um, tangential_um) in [(0.0, 20.0), (20.0, 0.0), (-12.0, 15.0)] {
        let deviation = format!(
            "deviation = [{{ planet = 2, radial_um = {radial_um:?}, tangential_um = {tangential_um:?} }}]"
        );
        for displaced in [0, 1] {
            let planets = ["count = 3".to_owned(), String::new()];
            let [planets, partners] = match displaced {
                0 => [format!("{}\n{deviation}", planets[0]), String::new()],
                _ => [planets[0].clone(), deviation.clone()],
            };
            let carrier = format!("torque_Nm = {:?}", 2.0 * 3.0 * force * base_m);
            let parts = [
                "speed_rpm = 0.0",
                "support = \"held\"",
                &carrier,
                &planets,
                &partners,
            ];
            let result = run(&meshed("kind = \"static\"", teeth, parts), folder.path());
            let carrier_rad = result.rows.read("bodies/set carrier/turn_rad").unwrap()[0];
            let ahead = ahead_rad(teeth);
            let on_both = unit_forces(TAU / 3.0 + carrier_rad, ahead, arms_m(teeth), 1.0);
            let angle = TAU / 3.0 + carrier_rad + [0.0, ahead][displaced];
            let out = unit(angle);
            let moved = 1e-6 * (radial_um * out + tangential_um * Vector2::new(-out.y, out.x));
            let opened = on_both[displaced].dot(&moved);
            assert!(opened.abs() > 3e-6, "{opened}");
            for n in 1..=3 {
                let own = if n == 2 { opened } else { 0.0 };
                let expected = force + stiffness * (opened / 3.0 - own);
                for mesh in [
                    format!("sun-planet {n}/normal_force_left_N"),
                    format!("planet {n}-partner/normal_force_right_N"),
                    format!("partner {n}-ring/normal_force_left_N"),
                ] {
                    let found = result.rows.read(&format!("elements/set {mesh}")).unwrap()[0];
                    let off = (found - expected) / (stiffness * opened);
                    assert!(
                        off.abs() < 2e-3,
                        "{displaced} {radial_um} {mesh}: {found} {expected}"
                    );
                }
            }
        }
    }
}

/// Each kind of mesh alone has a stiffness that varies; the first harmonic of its force runs ahead of the first pair's
/// by the phases that are stated, as the sun turns backwards against the carrier. 25 and 73 teeth: sequential.
#[test]
fn meshes_of_pairs_follow_each_other_in_the_stated_phases() {
    let folder = tempfile::tempdir().unwrap();
    let teeth = [25, 73];
    write_meshed(folder.path(), teeth);
    let angles: Vec<f64> = (0..12)
        .map(|k| -360.0 / 25.0 / 12.0 * f64::from(k))
        .collect();
    let kind = format!("kind = \"static\"\nmotion = \"set sun speed\"\nangles_deg = {angles:?}");
    let parts = [
        "speed_rpm = 0.0",
        "torque_Nm = 900.0",
        "support = \"held\"",
        "count = 3",
        "",
    ];
    let plain = meshed(&kind, teeth, parts);
    for (mesh, name) in [
        ("sun_mesh", "sun-planet {}/normal_force_right_N"),
        ("pair_mesh", "planet {}-partner/normal_force_left_N"),
        ("ring_mesh", "partner {}-ring/normal_force_right_N"),
    ] {
        let model =
            format!("{mesh} = {{ model = {{ kind = \"iso6336\", stiffness_N_per_mm_um = 20.0");
        let text = changed(
            &plain,
            &model,
            &format!("{model}, stiffness_amplitude = 0.2"),
        );
        let result = run(&text, folder.path());
        let set = &result.head.sets[0];
        let phases = match mesh {
            "ring_mesh" => set.teeth.ring_phases(&set.angles_rad),
            _ => set.teeth.sun_phases(&set.angles_rad),
        };
        assert!((phases[1] - 1.0 / 3.0).abs() < 1e-9, "{phases:?}");
        let harmonic = |n: usize| -> Complex<f64> {
            let name = format!("elements/set {}", name.replace("{}", &n.to_string()));
            let forces = result.rows.read(&name).unwrap().into_iter().enumerate();
            forces
                .map(|(i, f)| f / 6.0 * Complex::from_polar(1.0, -TAU * i as f64 / 12.0))
                .sum()
        };
        let first = harmonic(1);
        assert!(first.norm() > 100.0, "{mesh}: {first}");
        for n in 2..=3 {
            let ahead = (harmonic(n) / first).arg() / TAU - phases[n - 1];
            let off = ahead - ahead.round();
            assert!(off.abs() < 0.02, "{mesh} {n}: {off}");
        }
    }
}

/// In time, from an equilibrium with all pairs in contact: energy balances, the ratio is kept; at two steps.
#[test]
fn meshed_planets_in_time_balance_their_energy() {
    let folder = tempfile::tempdir().unwrap();
    write_meshed(folder.path(), [24, 72]);
    for step_s in ["2e-5", "1e-5"] {
        let keys = format!(
            "kind = \"transient\"\nend_s = 0.02\n[solver]\nstep_s = {step_s}\nstart = \"equilibrium\"\n[output]\ninterval_s = 1e-4"
        );
        let parts = [
            "speed_rpm = 500.0",
            "support = \"held\"",
            "torque_Nm = 300.0",
            "count = 3\ndeviation = [{ planet = 2, tangential_um = 0.5 }]",
            "",
        ];
        let text = meshed(&keys, [24, 72], parts).replace("stiffness_N_per_mm_um = 20.0", "stiffness_N_per_mm_um = 20.0, stiffness_amplitude = 0.1, damping = { kind = \"stiffness-proportional\", time_s = 2e-5, full_depth_um = 1.0 }");
        let result = run(&text, folder.path());
        let read = |name: &str| result.rows.read(name).unwrap();
        for n in 1..=3 {
            let forces = read(&format!(
                "elements/set partner {n}-ring/normal_force_left_N"
            ));
            assert!(forces.iter().all(|force| *force > 100.0), "{step_s} {n}");
        }
        let [sun, carrier] =
            ["sun", "carrier"].map(|body| read(&format!("bodies/set {body}/turn_rad")));
        // A turn of the sun: the carrier is behind by deflections alone.
        let last = sun.len() - 1;
        let error = (carrier[last] - carrier[0]) + 0.5 * (sun[last] - sun[0]);
        assert!(sun[last] - sun[0] > 1.0 && error.abs() < 1e-5, "{error:e}");
        let error = result.relative_energy_error().unwrap();
        assert!(error < 1e-3, "{step_s}: {error:e}");
    }
}
