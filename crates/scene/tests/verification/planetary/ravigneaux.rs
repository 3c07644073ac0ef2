//! Ravigneaux sets: a set with simple planets, and one whose planets have these as partners, on one carrier.
//!
//! ```text
//! ω_r' = (z_s/z_r) ω_s' = −(z_S/z_r) ω_S'                  against the carrier; s: the sun of the short planets
//! T_r/z_r = T_S/z_S − T_s/z_s,   T_s + T_S + T_r + T_c = 0
//! ```

use std::f64::consts::TAU;

use super::positions::ALPHA_DEG;
use super::*;

/// z_S, z_s, z_r; long and short planets have 18 teeth.
pub const TEETH: [f64; 3] = [30.0, 24.0, 66.0];

/// Gear files: faces of 25 mm, of the long planets 60 mm.
pub fn write_ravigneaux(folder: &Path) {
    write_gears(folder, [30, 18], ALPHA_DEG);
    let planet = std::fs::read_to_string(folder.join("planet.toml")).unwrap();
    let write = |name: &str, from: &str, to: &str| {
        std::fs::write(folder.join(name), changed(&planet, from, to)).unwrap();
    };
    write(
        "planet.toml",
        "face_width_mm = 25.0",
        "face_width_mm = 60.0",
    );
    write("short.toml", "\"planet\"", "\"short\"");
    write("small.toml", "teeth = 18", "teeth = 24");
}

/// The set of the large sun, 17 mm below the middle of the long planets, and the ring, and that of the small sun 17 mm
/// above; keys of large sun, ring, carrier, small sun, first and second set.
pub fn ravigneaux(run: &str, [large, ring, carrier, small, first, second]: [&str; 6]) -> String {
    let carrier = format!("inertia_kg_m2 = [0.1, 0.1, 0.1]\n{carrier}");
    let text = scene(
        run,
        72.0,
        [
            &format!("z_mm = -17.0\n{large}"),
            &format!("z_mm = 17.0\n{ring}"),
            &carrier,
            "count = 3",
            first,
        ],
    );
    let mesh = "{ model = { kind = \"iso6336\", stiffness_N_per_mm_um = 20.0 } }";
    format!(
        "{text}[[planetary]]\nname = \"rear\"\ncentre_distance_mm = 63.0\nposition_mm = [0.0, 0.0, 17.0]\n{second}\n\
         sun_mesh = {mesh}\npair_mesh = {mesh}\ncarrier = {{ body = \"set carrier\" }}\n\
         [planetary.sun]\ngear = \"small.toml\"\n{small}\n[planetary.planets]\ngear = \"short.toml\"\n\
         [planetary.planets.partner]\nplanets_of = \"set\"\npair_distance_mm = 54.0\n"
    )
}

const IN_TIME: &str =
    "kind = \"transient\"\nend_s = 0.01\n[solver]\nstep_s = 1e-5\n[output]\ninterval_s = 1e-3";

/// One gear of the transmission: keys of large sun, ring, carrier and small sun with what drives at `rpm`, speeds of
/// these four for a turn of what drives; torques that are stated, by member, none of those that follow.
pub struct Gear {
    pub keys: [&'static str; 4],
    pub speeds: [f64; 4],
    pub torques: [Option<f64>; 4],
    pub first: &'static str,
}

const HELD: &str = "support = \"held\"";
/// Driven; in equilibria it stands.
pub const DRIVEN: &str = "speed_rpm = 300.0";

pub fn gears() -> Vec<Gear> {
    let [large, small, ring] = TEETH;
    let over = 1.0 + large / ring;
    vec![
        // First: the small sun drives, the carrier is held; the large sun is dragged.
        Gear {
            keys: ["torque_Nm = 5.0", "torque_Nm = -200.0", HELD, DRIVEN],
            speeds: [-small / large, small / ring, 0.0, 1.0],
            torques: [Some(5.0), Some(-200.0), None, None],
            first: "ring_torque = \"negative\"",
        },
        // Second: the small sun drives, the large one is held, nothing acts on the carrier.
        Gear {
            keys: [HELD, "torque_Nm = -200.0", "", DRIVEN],
            speeds: [0.0, over, 1.0, 1.0 + large / small].map(|w| w / (1.0 + large / small)),
            torques: [None, Some(-200.0), Some(0.0), None],
            first: "sun_torque = \"positive\"\nring_torque = \"negative\"",
        },
        // Fourth: the carrier drives, the large sun is held, the small one dragged.
        Gear {
            keys: [HELD, "torque_Nm = -200.0", DRIVEN, "torque_Nm = -5.0"],
            speeds: [0.0, over, 1.0, 1.0 + large / small],
            torques: [None, Some(-200.0), None, Some(-5.0)],
            first: "",
        },
        // Reverse: the large sun drives, the carrier is held, the small sun is dragged.
        Gear {
            keys: [DRIVEN, "torque_Nm = 200.0", HELD, "torque_Nm = 5.0"],
            speeds: [1.0, -large / ring, 0.0, -large / small],
            torques: [None, Some(200.0), None, Some(5.0)],
            first: "",
        },
    ]
}

pub const MEMBERS: [&str; 4] = ["set sun", "set ring", "set carrier", "rear sun"];

/// Speeds at the start of all gears, and of the third, in which both suns turn alike and all else with them.
#[test]
fn speeds_of_a_ravigneaux_set_follow_willis() {
    let folder = tempfile::tempdir().unwrap();
    write_ravigneaux(folder.path());
    let third = Gear {
        keys: [DRIVEN, "torque_Nm = -200.0", "", DRIVEN],
        speeds: [1.0; 4],
        torques: [None; 4],
        first: "",
    };
    for gear in gears().into_iter().chain([third]) {
        let [large, ring, carrier, small] = gear.keys;
        let keys = [large, ring, carrier, small, gear.first, ""];
        let built = build_in(&ravigneaux(IN_TIME, keys), folder.path()).unwrap();
        for (member, expected) in MEMBERS.into_iter().zip(gear.speeds) {
            let found = crate::spin(&built, member) * 60.0 / TAU / 300.0;
            assert!(
                (found - expected).abs() < 1e-9,
                "{keys:?} {member}: {found} {expected}"
            );
        }
        // Long planets roll on the large sun, short ones on the small one.
        let [sun, _, carrier, small] = gear.speeds;
        for (planet, expected) in [
            ("set planet 2", carrier - 30.0 / 18.0 * (sun - carrier)),
            ("rear planet 3", carrier - 24.0 / 18.0 * (small - carrier)),
        ] {
            let found = crate::spin(&built, planet) * 60.0 / TAU / 300.0;
            assert!(
                (found - expected).abs() < 1e-9,
                "{keys:?} {planet}: {found} {expected}"
            );
        }
    }
}

/// Torques of all gears at rest in several positions, equal forces of all planets, and the balance of power: what
/// drives gives what the others take.
#[test]
fn torques_of_a_ravigneaux_set_are_in_equilibrium() {
    let folder = tempfile::tempdir().unwrap();
    write_ravigneaux(folder.path());
    for gear in gears() {
        let driven = gear.keys.iter().position(|keys| *keys == DRIVEN).unwrap();
        let still = gear.keys.map(|keys| {
            if keys == DRIVEN {
                "speed_rpm = 0.0"
            } else {
                keys
            }
        });
        let [large, ring, carrier, small] = still;
        let kind = format!(
            "kind = \"static\"\nmotion = \"{} speed\"\nangles_deg = [0.0, 2.3, 17.0, 250.0]",
            MEMBERS[driven]
        );
        let result = run(
            &ravigneaux(&kind, [large, ring, carrier, small, gear.first, ""]),
            folder.path(),
        );
        // Two of four torques are stated, the others follow.
        let [z_large, z_small, z_ring] = TEETH;
        let torques = torques(gear.torques, [z_large, z_small, z_ring]);
        let power: f64 = torques
            .iter()
            .zip(gear.speeds)
            .map(|(torque, speed)| torque * speed)
            .sum();
        assert!(power.abs() < 1e-9 * torques[1].abs(), "{power}");
        let read = |name: &str| result.rows.read(name).unwrap();
        for (member, torque) in torques.into_iter().enumerate() {
            let joint = match gear.keys[member] {
                DRIVEN => format!("{} speed", MEMBERS[member]),
                HELD => format!("{} axis", MEMBERS[member]),
                _ => continue,
            };
            for found in read(&format!("joints/{joint}/moment_z_Nm")) {
                assert!(
                    (found / torque - 1.0).abs() < 1e-6,
                    "{:?} {joint}: {found} {torque}",
                    gear.keys
                );
            }
        }
        let cos = ALPHA_DEG.to_radians().cos();
        let force = |torque: f64, teeth: f64| torque.abs() / (3.0 * 1.5e-3 * teeth * cos);
        for n in 1..=3 {
            for (mesh, expected) in [
                (format!("set sun-planet {n}"), force(torques[0], z_large)),
                (format!("set planet {n}-ring"), force(torques[1], z_ring)),
                (format!("rear sun-planet {n}"), force(torques[3], z_small)),
                (
                    format!("rear planet {n}-partner"),
                    force(torques[3], z_small),
                ),
            ] {
                let of = |side| read(&format!("elements/{mesh}/normal_force_{side}_N"));
                for (left, right) in of("left").into_iter().zip(of("right")) {
                    let found = left + right;
                    assert!(
                        (found / expected - 1.0).abs() < 1e-5,
                        "{:?} {mesh}: {found} {expected}",
                        gear.keys
                    );
                }
            }
        }
        let sets = result.sets().unwrap();
        assert_eq!(sets[1].set.members.ring.as_deref(), Some("set ring"));
        assert!((sets[1].pair.as_ref().unwrap().mesh_load_factor() - 1.0).abs() < 1e-5);
    }
}

/// Torques of large sun, ring, carrier, small sun of which two are known.
pub fn torques(known: [Option<f64>; 4], [large, small, ring]: [f64; 3]) -> [f64; 4] {
    // Rows: the planets' balance, the sum of all; then what is known.
    let mut rows = vec![
        (vec![1.0 / large, -1.0 / ring, 0.0, -1.0 / small], 0.0),
        (vec![1.0; 4], 0.0),
    ];
    for (member, torque) in known.into_iter().enumerate() {
        if let Some(torque) = torque {
            let mut row = vec![0.0; 4];
            row[member] = 1.0;
            rows.push((row, torque));
        }
    }
    let matrix = nalgebra::Matrix4::from_fn(|i, j| rows[i].0[j]);
    let right = nalgebra::Vector4::from_fn(|i, _| rows[i].1);
    matrix.lu().solve(&right).unwrap().into()
}

/// The worked example of the documentation turns as its table says.
#[test]
fn the_documented_ravigneaux_set_is_in_first_gear() {
    let folder = tempfile::tempdir().unwrap();
    write_ravigneaux(folder.path());
    for (own, documented) in [
        ("sun", "large-sun"),
        ("planet", "long"),
        ("small", "small-sun"),
    ] {
        let [own, documented] =
            [own, documented].map(|name| folder.path().join(format!("{name}.toml")));
        std::fs::copy(own, documented).unwrap();
    }
    let built = build_in(&documented("front", IN_TIME), folder.path()).unwrap();
    let found = crate::spin(&built, "front ring") / crate::spin(&built, "rear sun");
    assert!((found - TEETH[1] / TEETH[2]).abs() < 1e-9, "{found}");
    let over = |one: f64, other: f64| (1.0 + TEETH[0] / one) / (1.0 + TEETH[0] / other);
    for (stated, expected) in [
        (0.364, TEETH[1] / TEETH[2]),
        (0.646, over(TEETH[2], TEETH[1])),
        (1.455, 1.0 + TEETH[0] / TEETH[2]),
        (-0.455, -TEETH[0] / TEETH[2]),
    ] {
        assert!((stated - expected).abs() < 5.1e-4, "{stated} {expected}");
    }
}

/// What two sets that share planets do not allow.
#[test]
fn ravigneaux_sets_that_do_not_fit_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    write_ravigneaux(folder.path());
    let keys = ["", HELD, "torque_Nm = -50.0", "speed_rpm = 0.0", "", ""];
    let text = ravigneaux("kind = \"static\"", keys);
    build_in(&text, folder.path()).unwrap();
    for (from, to, expected) in [
        (
            "planets_of = \"set\"",
            "planets_of = \"sett\"",
            "there is no planetary set before this one `sett`",
        ),
        (
            "carrier = { body = \"set carrier\" }",
            "carrier = { mass_kg = 1.0, inertia_kg_m2 = [0.1, 0.1, 0.1] }",
            "give carrier = { body = \"set carrier\" }",
        ),
        (
            "position_mm = [0.0, 0.0, 17.0]",
            "position_mm = [1.0, 0.0, 17.0]",
            "the axis of `set` is another one",
        ),
        (
            "position_mm = [0.0, 0.0, 17.0]",
            "axis = [0.0, 0.1, 1.0]",
            "the axis of `set` is another one",
        ),
        (
            "gear = \"short.toml\"",
            "gear = \"short.toml\"\ncount = 3",
            "planets.count: is not used with planets_of",
        ),
        (
            "z_mm = -17.0",
            "z_mm = -5.0",
            "the planets reach 15.0000 mm into the other sun, with which they do not mesh",
        ),
        (
            "pair_distance_mm = 54.0",
            "pair_distance_mm = 54.0\nbore = \"bonded\"",
            "planets.partner.bore: is not used with planets_of",
        ),
        // κ of the two sets, 96 and 42: two or three of four angles fit the first only.
        (
            "count = 3",
            "angles_deg = [0.0, 90.0]",
            "planets.partner.planets_of: planet 2 at 90.000000 deg does not fit between sun and ring: planets fit at multiples of 360/6 deg",
        ),
        (
            "pair_mesh = ",
            "ring_mesh = ",
            "ring_mesh: is not used without a ring",
        ),
    ] {
        let changed = match from {
            "pair_mesh = " => text.replace(from, to),
            _ => changed(&text, from, to),
        };
        let complaint = build_in(&changed, folder.path()).err().unwrap().to_string();
        assert!(
            complaint.contains(expected),
            "`{expected}` is not in: {complaint}"
        );
    }
}
