//! Bevel pairs drawn at random: each is refused by key, or analysed without load; scenes touch where the analysis says,
//! jam where it says so, and run.
#![allow(clippy::print_stdout)] // figures of the campaign

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::panic::{AssertUnwindSafe, catch_unwind};

use gearmesh_bevel::tca::mean_contact;
use gearmesh_bevel::{
    AssembledPair, Assembly, BevelError, ContactKind, FlankSide, Mesh, PairDesign, PairFile,
    TcaRequest, Touch, VhSetting, VhStop, sensitivity, tooth_contact,
};
use gearmesh_geometry::input::InputDocument;
use gearmesh_scene::system_run::RunJob;

use crate::bevel_hard_cases::{GEAR, PINION, scene};
use crate::common::*;
use crate::system_runs::Desk;

/// A draw of a pair file's keys, within what such pairs have.
struct Draw(fastrand::Rng);

impl Draw {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.f64()
    }

    fn of<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.0.usize(..choices.len())]
    }

    fn pair(&mut self) -> String {
        let pinion = self.0.u32(9..=36);
        let gear = (f64::from(pinion) * self.between(1.0, 4.0)).round();
        let shaft = self.of(&[90.0, 90.0, 75.0, 105.0, 62.5]);
        let module = self.between(1.5, 8.0);
        let sigma = f64::to_radians(shaft);
        let gamma = sigma.sin().atan2(gear / f64::from(pinion) + sigma.cos());
        let cone = 0.5 * module * f64::from(pinion) / gamma.sin();
        let face = cone * self.between(0.18, 0.32);
        let spiral = self.between(15.0, 40.0);
        let edge = 0.05 * module;
        let mut text = format!(
            "title = \"drawn\"\n[bevel]\nteeth = [{pinion}, {gear:.0}]\nouter_module_mm = {module:.3}\nface_width_mm = [{:.2}, {face:.2}]\n\
             spiral_angle_deg = {spiral:.2}\npressure_angle_deg = {}\nshaft_angle_deg = {shaft}\npinion_hand = \"{}\"\ntaper = \"{}\"\n\
             cutter_radius_mm = {:.2}\nthickness_shift = {:.3}\nbacklash_mm = {:.3}\n",
            face * self.of(&[1.0, 1.0, 1.05]),
            self.of(&[20.0, 20.0, 22.5, 25.0]),
            self.of(&["left", "right"]),
            self.of(&["standard", "standard", "duplex", "uniform"]),
            cone * self.between(0.8, 1.4),
            self.between(0.0, 0.06),
            module * self.between(0.02, 0.05),
        );
        let both = |low: f64, high: f64, draw: &mut Self| {
            [draw.between(low, high), draw.between(low, high)]
        };
        let ellipse = both(0.18 * face, 0.4 * face, self);
        let _ = write!(
            text,
            "[gear]\nsettings = \"{}\"\nedge_radius_mm = {edge:.3}\n[pinion]\nsettings = \"local-synthesis\"\nedge_radius_mm = {edge:.3}\n\
             path_angle_deg = {:.1?}\nellipse_half_length_mm = {ellipse:.2?}\ntransmission_curvature = {:.5?}\n",
            self.of(&["basic", "basic", "formate"]),
            both(70.0, 110.0, self),
            both(-0.01, -0.002, self),
        );
        // As designed, off by hundredths of a module, and far off.
        let size = module * self.of(&[0.0, 0.02, 0.02, 0.15]);
        let mut off = || 1e3 * size * self.between(-1.0, 1.0);
        let [offset, pinion, gear, tilt] = [off(), off(), off(), off()];
        let _ = write!(
            text,
            "[tca]\npinion_flank = \"{}\"\noffset_um = {offset:.1}\npinion_axial_um = {pinion:.1}\ngear_axial_um = {gear:.1}\nshaft_angle_mrad = {:.3}\n",
            self.of(&["concave", "convex"]),
            tilt / cone,
        );
        text
    }
}

/// How many pairs came to what, and the largest deviations.
#[derive(Default)]
struct Tally {
    counts: BTreeMap<String, usize>,
    most: BTreeMap<&'static str, f64>,
    /// Files of pairs of which something did not hold.
    failed: Vec<String>,
}

impl Tally {
    fn count(&mut self, what: impl Into<String>) {
        *self.counts.entry(what.into()).or_default() += 1;
    }

    /// Fails with the files of what failed.
    fn refuse_failures(&self) {
        assert!(self.failed.is_empty(), "{}", self.failed.join("\n---\n"));
    }

    fn deviation(&mut self, what: &'static str, value: f64) {
        let most = self.most.entry(what).or_insert(0.0);
        *most = most.max(value);
    }
}

/// Draws until so many pairs were analysed.
fn analysed(seed: u64, count: usize) -> Tally {
    let mut draw = Draw(fastrand::Rng::with_seed(seed));
    let (mut tally, mut analysed) = (Tally::default(), 0);
    while analysed < count {
        let text = draw.pair();
        tally.count("drawn");
        let document = InputDocument::new("drawn.toml", text.clone());
        let made = PairFile::from_document(&document)
            .and_then(|file| Ok((file.checked_design(&document)?.0, file)));
        let (design, file) = match made {
            Ok(made) => made,
            Err(error) => {
                let words = error.to_string();
                assert!(words.starts_with("drawn.toml"), "{words}\n{text}");
                tally.count(format!("refused: {}", kind(&words)));
                continue;
            }
        };
        analysed += 1;
        let all_holds = catch_unwind(AssertUnwindSafe(|| {
            match AssembledPair::new(&file, &design) {
                Ok(pair) => found(&text, (&file, &design, &pair), &mut tally),
                Err(error) => {
                    tally.count(format!("assembly refused: {}", kind(&error.to_string())));
                    if let BevelError::Jam { .. } = error {
                        assert!(jams(&file, &text), "{text}");
                    }
                }
            }
        }));
        if all_holds.is_err() {
            tally.count("FAILED");
            tally.failed.push(text);
        }
    }
    tally
}

/// The first words of a message, without its numbers.
fn kind(words: &str) -> String {
    let words = words
        .split_whitespace()
        .filter(|w| !w.contains(|c: char| c.is_ascii_digit()));
    words.take(7).collect::<Vec<_>>().join(" ")
}

/// What must hold of a pair that was analysed.
fn found(
    text: &str,
    (file, design, pair): (&PairFile, &PairDesign, &AssembledPair),
    tally: &mut Tally,
) {
    tally.count("analysed");
    for tooth in &design.teeth {
        for side in FlankSide::BOTH {
            let table = tooth.nominal_grid_csv(side, [5, 3]).unwrap();
            assert_eq!(table.lines().count(), 16, "{text}");
            assert!(!table.contains("NaN"), "{text}");
        }
    }
    match pair.backlash_m {
        Some(backlash_m) if backlash_m < -1e-6 => {
            assert!(pair.jam.is_some(), "{text}");
            tally.count("jams a little");
        }
        Some(_) => tally.count("has backlash"),
        None => tally.count("coast flanks out of reach"),
    }
    check_vh(text, (file, design, pair), tally);
    check_motion(text, (file, design, pair), tally);
}

/// Every setting that is stated brings the mean contact to its place; every other one says why not.
fn check_vh(
    text: &str,
    (file, design, pair): (&PairFile, &PairDesign, &AssembledPair),
    tally: &mut Tally,
) {
    let flanks = design.flanks(file.pinion_flank);
    let (blank, base) = (&file.blank, &file.tca.error);
    let contact = pair.path().unwrap();
    let Some(mean) = &contact.mean else {
        tally.count("no mean contact");
        return;
    };
    let moved = sensitivity(flanks, blank, (base, mean));
    tally.count(if moved.is_ok() {
        "sensitivity"
    } else {
        "no sensitivity"
    });
    let check = design.vh_check(blank, file.pinion_flank, (base, mean));
    let mut of = |way: &str, found: [Result<VhSetting, VhStop>; 2]| {
        for setting in found {
            match setting {
                Ok(setting) => {
                    tally.count(format!("V/H by {way}"));
                    let request = TcaRequest {
                        error: base.plus(&setting.error),
                        ..file.tca
                    };
                    let Ok(there) = tooth_contact(flanks, blank, &request) else {
                        panic!("no contact at {setting:?}\n{text}");
                    };
                    let apart = |touch: &Touch| {
                        let place = flanks[1].place(&flanks[1].point(touch.at[1]).unwrap().r);
                        (place[0] - setting.place_m[0]).hypot(place[1] - setting.place_m[1])
                    };
                    // The path comes by there (else an edge touches first, and the setting is refused), and the ratio
                    // of speeds is that of the teeth.
                    let path = there.path.iter().filter(|p| p.kind == ContactKind::Flanks);
                    let nearest = path
                        .map(|p| p.touch)
                        .min_by(|a, b| apart(a).total_cmp(&apart(b)))
                        .unwrap_or_else(|| panic!("no path at {setting:?}\n{text}"));
                    let assembly = Assembly::new(blank, &request.error);
                    let mesh = Mesh {
                        flanks,
                        assembly: &assembly,
                    };
                    let off_m = apart(&mean_contact(&mesh, &nearest).unwrap());
                    assert!(off_m < 1e-9, "{off_m:e} {setting:?}\n{text}");
                    tally.deviation("V/H place, m", off_m);
                }
                Err(stop) => {
                    assert!(stop.words().starts_with("not reached"));
                    tally.count(format!("V/H by {way}: {:?}", stop.cause));
                }
            }
        }
    };
    of("offset", check.by_offset);
    of("shaft angle", check.by_shaft_angle);
}

/// A scene of the pair in its assembly, gear 1 turned so far.
fn scene_of(file: &PairFile, flanks: &str, turn_rad: f64) -> String {
    let e = &file.tca.error;
    let pinion = format!(
        "position_mm = [0.0, {:?}, {:?}]\ncardan_deg = [0.0, 0.0, {:?}]",
        1e3 * e.offset_m,
        1e3 * e.pinion_axial_m,
        turn_rad.to_degrees()
    );
    let angle = file.blank.data.shaft_angle_rad + e.shaft_angle_rad;
    let gear = format!(
        "position_mm = [{:?}, 0.0, {:?}]\ncardan_deg = [0.0, {:?}]",
        1e3 * e.gear_axial_m * angle.sin(),
        1e3 * e.gear_axial_m * angle.cos(),
        angle.to_degrees()
    );
    // Right flanks touch where gear 1 drives clockwise.
    let sign = if flanks == "right" { "-" } else { "" };
    let text = scene(&format!("{sign}600.0"), &format!("{sign}3.0"), 0.002);
    let text = changed(&changed(&text, PINION, &pinion), GEAR, &gear);
    let text = changed(
        &text,
        "bevel_pair = \"bevel_20_20.toml\"",
        "bevel_pair = \"drawn.toml\"",
    );
    changed(
        &text,
        "tooth_pairs = {}",
        &format!("teeth = {{ flanks = \"{flanks}\" }}"),
    )
}

/// Whether a scene of both sides says that the teeth jam, or refuses them, at some turn.
fn jams(file: &PairFile, text: &str) -> bool {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("drawn.toml"), text).unwrap();
    let pitch = TAU / file.blank.data.teeth[0] as f64;
    (0..6).any(|k| {
        let scene = scene_of(file, "both", pitch * f64::from(k) / 6.0);
        match build_in(&scene, folder.path()) {
            Ok(built) => built.notes.join("\n").contains("jam"),
            Err(error) => error.to_string().contains("stand"),
        }
    })
}

/// Scenes begin where the flanks touch: gear 2 stands as the contact analysis says. A run of some pitches balances its
/// energy.
fn check_motion(
    text: &str,
    (file, design, pair): (&PairFile, &PairDesign, &AssembledPair),
    tally: &mut Tally,
) {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("drawn.toml"), text).unwrap();
    let [z1, z2] = file.blank.data.teeth;
    let facing = file.pinion_flank.facing(file.blank.members[0].hand);
    let flanks = if facing < 0.0 { "right" } else { "left" };
    let [pitch, gear_pitch] = [z1, z2].map(|z| TAU / z as f64);
    // There turn 0 has the mean point of the flank in the plane of the axes.
    let half_angle = design.teeth[0].half_angle_rad(file.pinion_flank);
    let expected = &pair.path().unwrap().error_rad;
    let (mut leads, count) = (Vec::new(), 4);
    for k in 0..count {
        let turn = pitch * k as f64 / count as f64;
        let built = build_in(&scene_of(file, flanks, turn - half_angle), folder.path());
        let built = match built {
            Ok(built) => built,
            Err(error) => {
                // Their patches reach over the whole flank, which may be undercut where the path never comes; teeth
                // that overlap by nearly what is allowed do so by more at some turn.
                let words = error.to_string();
                let jams = pair.jam.is_some() && words.contains("in each other");
                assert!(jams || words.contains("undercut"), "{words}\n{text}");
                tally.count(if jams {
                    "scene refused: jam"
                } else {
                    "scene refused: undercut"
                });
                return;
            }
        };
        let orientation = crate::body(&built, "gear").orientation;
        let angle = file.blank.data.shaft_angle_rad + file.tca.error.shaft_angle_rad;
        let tilt = nalgebra::UnitQuaternion::from_axis_angle(&nalgebra::Vector3::y_axis(), angle);
        let gear_turn = (tilt.inverse() * orientation).scaled_axis().z;
        leads.push(-facing * (gear_turn + turn * z1 as f64 / z2 as f64));
    }
    let radius = file.blank.mean_cone_m * file.blank.members[1].pitch_angle_rad.sin();
    for (k, lead) in leads.iter().enumerate() {
        let own = expected[k * expected.len() / count] - expected[0];
        let off = lead - leads[0] - own;
        let off = off - gear_pitch * (off / gear_pitch).round();
        tally.deviation(
            "analysis against motion, m on the mean circle",
            off.abs() * radius,
        );
    }
    if pair.jam.is_some() {
        tally.count(if jams(file, text) {
            "jam in scenes, too"
        } else {
            "jam only in the analysis"
        });
    }
    let loaded = load(&scene_of(file, flanks, 0.0), folder.path()).unwrap();
    let result = Desk::new().run(RunJob::from_scene(loaded).unwrap());
    for column in result.rows.columns() {
        let values = result.rows.read(&column.name).unwrap();
        assert!(
            values.iter().all(|v| v.is_finite()),
            "{}\n{text}",
            column.name
        );
    }
    tally.deviation("energy error", result.relative_energy_error().unwrap());
}

/// Number 86 of seed 77: its gear reaches below the lower line of the pinion's flank, where the patch ends. The
/// contact was lost there, came back 32 µm deep and threw the gear: energy was off by 5 % of the work. Allowed is a
/// tenth of what a run refuses.
#[test]
fn a_gear_that_reaches_below_the_flank_touches_its_lower_line() {
    let text = include_str!("reaches_below.toml");
    let document = InputDocument::new("drawn.toml", text);
    let file = PairFile::from_document(&document).unwrap();
    let design = file.checked_design(&document).unwrap().0;
    let pair = AssembledPair::new(&file, &design).unwrap();
    let mut path = pair.path().unwrap().path.iter();
    assert!(path.any(|p| p.kind == ContactKind::LowerEnd { member: 0 }));
    let mut tally = Tally::default();
    check_motion(text, (&file, &design, &pair), &mut tally);
    assert!(tally.most["energy error"] < 1e-3, "{:?}", tally.most);
}

/// A few pairs of [`many_bevel_pairs`].
#[test]
fn random_pairs_are_refused_or_move_as_analysed() {
    let tally = analysed(3, 2);
    assert!(tally.counts["analysed"] >= 2, "{:?}", tally.counts);
    tally.refuse_failures();
}

/// `BEVEL_PAIRS=120 BEVEL_PAIRS_SEED=24 cargo test --workspace --test verification -- --ignored --nocapture
/// many_bevel_pairs`: so many pairs that no key refuses, drawn with a seed. A pair that fails is printed with its
/// file, and the next one drawn.
#[test]
#[ignore = "takes minutes"]
fn many_bevel_pairs() {
    let number = |name: &str, otherwise: u64| {
        std::env::var(name).map_or(otherwise, |text| text.parse().unwrap())
    };
    let tally = analysed(
        number("BEVEL_PAIRS_SEED", 24),
        number("BEVEL_PAIRS", 24) as usize,
    );
    println!("{:#?}\n{:#?}", tally.counts, tally.most);
    tally.refuse_failures();
}
