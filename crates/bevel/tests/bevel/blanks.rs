//! Blanks against published numbers, their identities, and files that are refused.

use gearmesh_bevel::{PairBlank, PairData, PairFile, Taper};
use gearmesh_geometry::input::InputDocument;

use crate::common::{blank, data_13_35, data_20_20, near};

/// 20/20, m 3.5: Gleason's proportions; cone angles are printed in seed 001, too.
#[test]
fn blank_of_seed_001() {
    let pair = blank(&data_20_20());
    near(1e3 * pair.outer_cone_m, 49.4975, 1e-4);
    near(1e3 * pair.mean_cone_m, 41.9975, 1e-4);
    for member in &pair.members {
        near(1e3 * member.outer_addendum_m, 2.975, 1e-4);
        near(1e3 * member.outer_dedendum_m, 3.633, 1e-4);
        near(member.face_angle_rad.to_degrees(), 49.1979, 1e-4);
        near(member.root_angle_rad.to_degrees(), 40.8021, 1e-4);
        near(member.pitch_angle_rad.to_degrees(), 45.0, 1e-12);
    }
}

/// 13/35, m 5.5, face width 28.
#[test]
fn blank_of_seed_000() {
    let pair = blank(&data_13_35());
    let [pinion, gear] = &pair.members;
    near(1e3 * pair.outer_cone_m, 102.6749, 1e-4);
    near(1e3 * pair.mean_cone_m, 88.6749, 1e-4);
    for (member, pitch, addendum, dedendum, face) in [
        (pinion, 20.3764, 6.5241, 3.8599, 24.5865),
        (gear, 69.6236, 2.8259, 7.5581, 71.7765),
    ] {
        near(member.pitch_angle_rad.to_degrees(), pitch, 1e-4);
        near(1e3 * member.outer_addendum_m, addendum, 1e-4);
        near(1e3 * member.outer_dedendum_m, dedendum, 1e-4);
        near(member.face_angle_rad.to_degrees(), face, 1e-4);
    }
    near(pair.whole_depth_m, 1.888 * 5.5e-3, 1e-15);
    // Tooth and space fill the pitch; with backlash they do not.
    let circle = |pair: &PairBlank| {
        std::f64::consts::TAU * pair.mean_cone_m * pair.members[0].pitch_angle_rad.sin() / 13.0
    };
    near(
        pinion.mean_thickness_m + gear.mean_thickness_m,
        circle(&pair),
        1e-15,
    );
    let loose = blank(&PairData {
        backlash_m: 0.1e-3,
        ..data_13_35()
    });
    let play =
        circle(&loose) - loose.members[0].mean_thickness_m - loose.members[1].mean_thickness_m;
    near(
        play * 20f64.to_radians().cos() * 35f64.to_radians().cos(),
        0.1e-3,
        1e-15,
    );
}

/// Clearance is the same from toe to heel at every taper and shaft angle: a tip is parallel to the mate's root.
#[test]
fn tips_are_parallel_to_the_roots_of_the_mate() {
    for taper in [Taper::Standard, Taper::Duplex, Taper::Uniform] {
        for shaft in [60f64, 90.0, 100.0] {
            let data = PairData {
                taper,
                shaft_angle_rad: shaft.to_radians(),
                ..data_13_35()
            };
            let pair = blank(&data);
            for (tip, root) in [(0, 1), (1, 0)] {
                for cone in [
                    pair.outer_cone_m,
                    pair.mean_cone_m,
                    pair.members[0].inner_cone_m(),
                ] {
                    let clearance =
                        pair.members[root].dedendum_m(cone) - pair.members[tip].addendum_m(cone);
                    // Where tips and roots keep to one line in the pitch plane: exact for the tangents of equal angles.
                    let mean = pair.members[root].dedendum_m(pair.mean_cone_m)
                        - pair.members[tip].addendum_m(pair.mean_cone_m);
                    near(clearance, mean, 1e-15);
                }
            }
            near(
                pair.members[0].pitch_angle_rad + pair.members[1].pitch_angle_rad,
                shaft.to_radians(),
                1e-15,
            );
            near(
                pair.members[1].pitch_angle_rad.sin() / pair.members[0].pitch_angle_rad.sin(),
                35.0 / 13.0,
                1e-14,
            );
        }
    }
}

/// Duplex taper: the slots of both members together are equally wide at both ends (docs/theory/bevel_gears.md).
#[test]
fn duplex_slots_keep_their_width() {
    let data = PairData {
        taper: Taper::Duplex,
        ..data_20_20()
    };
    let pair = blank(&data);
    let width = |cone: f64| {
        let (r, mean, beta) = (
            data.cutter_radius_m,
            pair.mean_cone_m,
            data.spiral_angle_rad,
        );
        let s2 = mean * mean + r * r - 2.0 * mean * r * beta.sin();
        let sine = (cone * cone + r * r - s2) / (2.0 * cone * r);
        let pitch = std::f64::consts::PI * data.outer_module_m * cone / pair.outer_cone_m
            * (1.0 - sine * sine).sqrt();
        pitch
            - 2.0
                * data.pressure_angle_rad.tan()
                * (pair.members[0].dedendum_m(cone) + pair.members[1].dedendum_m(cone))
    };
    let h = 1e-5;
    let slope = (width(pair.mean_cone_m + h) - width(pair.mean_cone_m - h)) / (2.0 * h);
    // tan of each angle stands for the angle in the formula: third order in 5 degrees.
    near(slope, 0.0, 1e-3);
    let standard = blank(&data_20_20());
    assert!(pair.members[0].dedendum_angle_rad() != standard.members[0].dedendum_angle_rad());
}

const FILE: &str = "title = 'p'\n[bevel]\nteeth = [13, 35]\nouter_module_mm = 5.5\nface_width_mm = [30.0, 28.0]\nspiral_angle_deg = 35.0\n\
                    pinion_hand = 'left'\ncutter_radius_mm = 76.2\n";

#[test]
fn a_pair_file_is_read() {
    let file = PairFile::from_document(&InputDocument::new("p.toml", FILE)).unwrap();
    assert_eq!(file.blank, blank(&data_13_35()));
}

#[test]
fn wrong_blanks_are_refused_by_key_and_line() {
    for (from, to, expected) in [
        (
            "[13, 35]",
            "[35, 13]",
            "p.toml:3: bevel.teeth: found 35 and 13",
        ),
        (
            "[13, 35]",
            "[4, 35]",
            "p.toml:3: bevel.teeth.0: found 4, allowed is 5 to 1000",
        ),
        (
            "outer_module_mm = 5.5",
            "outer_module_mm = -1",
            "p.toml:4: bevel.outer_module_mm: found -1",
        ),
        (
            "[30.0, 28.0]",
            "[30.0, 60.0]",
            "p.toml:5: bevel.face_width_mm: found 60.0000, allowed is up to half",
        ),
        (
            "35.0\n",
            "70.0\n",
            "p.toml:6: bevel.spiral_angle_deg: found 70",
        ),
        (
            "pinion_hand = 'left'\n",
            "",
            "bevel.pinion_hand: missing; a face-milled pair needs it",
        ),
        (
            "pinion_hand = 'left'\n",
            "pinion_hand = 'left'\nform = 'zerol'\n",
            "bevel.spiral_angle_deg: is not used by form = \"zerol\"",
        ),
        (
            "pinion_hand = 'left'\n",
            "pinion_hand = 'left'\nshaft_angle_deg = 150.0\n",
            "bevel.shaft_angle_deg: the gear's pitch angle is",
        ),
        (
            "76.2",
            "20.0\ntaper = 'duplex'",
            "bevel.taper: found \"duplex\" with a cutter radius of 20.0000 mm",
        ),
        (
            "76.2",
            "76.2\nthickness_shift = 0.6",
            "bevel.thickness_shift: found 0.6",
        ),
    ] {
        let text = FILE.replacen(from, to, 1);
        assert_ne!(text, FILE, "{from}");
        let error = PairFile::from_document(&InputDocument::new("p.toml", text))
            .unwrap_err()
            .to_string();
        assert!(
            error.contains(expected),
            "{error}\ndoes not say\n{expected}"
        );
    }
}
