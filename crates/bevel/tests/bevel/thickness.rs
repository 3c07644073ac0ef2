//! Tooth thickness by settings and by blank, settings that cannot be, and assemblies that jam.

use gearmesh_bevel::cut_thickness::{normal_m, settings_of_thickness};
use gearmesh_bevel::tca::PathPoint;
use gearmesh_bevel::{
    AssemblyError, BevelError, ContactKind, FlankSide, PairDesign, PairFile, TcaRequest,
    ThicknessFrom, VhCause, tooth_contact,
};
use gearmesh_geometry::input::InputDocument;

use crate::common::near;

fn shipped(name: &str) -> String {
    let path = format!("{}/../../fe_models/{name}", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(path).unwrap()
}

fn made(text: &str) -> Result<(PairFile, PairDesign), String> {
    let document = InputDocument::new("pair.toml", text);
    let file = PairFile::from_document(&document).map_err(|e| e.to_string())?;
    let (design, _) = file.checked_design(&document).map_err(|e| e.to_string())?;
    Ok((file, design))
}

/// The published gear: 4.656 mm cut, 4.893 mm by the blank. The slot once more from the points of both surfaces in the
/// machine's frame.
#[test]
fn stated_settings_of_one_operation_make_the_tooth() {
    let text = shipped("bevel_38_51.toml");
    let (file, design) = made(&text).unwrap();
    let gear = &design.teeth[1];
    let cut = gear.thickness.cut_m.unwrap();
    near(1e3 * cut, 4.656, 5e-4);
    near(1e3 * gear.thickness.blank_m, 4.893, 5e-4);
    assert_eq!(gear.thickness.from, ThicknessFrom::Settings);
    let azimuths = [0, 1].map(|i: usize| {
        let flank = &gear.flanks[i];
        let at = flank.mean().at;
        let r = flank.cut_surface().unwrap().flank(at[0], at[1]).unwrap().r;
        let radius = flank.blank.mean_cone_m * flank.blank.pitch_angle_rad.sin();
        near(r.x.hypot(r.y), radius, 1e-12);
        r.y.atan2(r.x)
    });
    // A left hand: the slot goes from the convex flank counter-clockwise to the concave one.
    let radius = gear.blank.mean_cone_m * gear.blank.pitch_angle_rad.sin();
    let slot = azimuths[0] - azimuths[1];
    near(radius * (std::f64::consts::TAU / 51.0 - slot), cut, 1e-12);
    // What patches and bodies are made with.
    let half = gear.half_angle_rad(FlankSide::Concave);
    near(2.0 * half.abs() * radius, cut, 1e-15);
    near(
        normal_m(&gear.flanks, cut) / cut,
        35f64.to_radians().cos(),
        2e-3,
    );
    // What is missing is backlash: the pinion is as thick as its blank.
    let cosines = 35f64.to_radians().cos() * 20f64.to_radians().cos();
    near(
        design.backlash_m(&file.blank),
        (gear.thickness.blank_m - cut) * cosines,
        1e-12,
    );
    // The other way round, and the blank's by the key.
    let settings = design.settings[1].unwrap();
    let wanted = gear.thickness.blank_m;
    let found = settings_of_thickness(&gear.blank, &settings, wanted).unwrap();
    let radii = found.map(|s| 1e3 * s.face_mill().unwrap().point_radius_m);
    near(radii[0], 96.1676, 1e-4);
    near(radii[1], 94.3324, 1e-4);
    let again = text
        .replace("96.265", &format!("{:.12}", radii[0]))
        .replace("94.235", &format!("{:.12}", radii[1]));
    let (_, again) = made(&again).unwrap();
    near(again.teeth[1].thickness.counts_m(), wanted, 1e-11);
    let blank = text.replacen(
        "settings = \"given\"",
        "settings = \"given\"\nthickness = \"blank\"",
        1,
    );
    let (file, design) = made(&blank).unwrap();
    assert_eq!(design.teeth[1].thickness.counts_m(), wanted);
    near(design.backlash_m(&file.blank), 0.0, 1e-15);
}

/// Members that are derived from the blank cut its thickness; by the formula of the pitch cone alone they would not.
#[test]
fn derived_settings_cut_the_thickness_of_the_blank() {
    for name in ["bevel_20_20.toml", "bevel_13_35.toml", "bevel_8_48.toml"] {
        for process in ["basic", "formate"] {
            let text = shipped(name).replacen("\"basic\"", &format!("\"{process}\""), 1);
            let text = text.replacen(
                "path_angle_deg = [100.0, 80.0]",
                "path_angle_deg = [90.0, 90.0]",
                1,
            );
            let document = InputDocument::new("pair.toml", text);
            let file = PairFile::from_document(&document).unwrap();
            // Whether its pinion is undercut is another matter.
            let Ok(design) = file.design() else { continue };
            let gear = &design.teeth[1];
            let cut = gear.thickness.cut_m.unwrap();
            near(cut, gear.blank.mean_thickness_m, 1e-12);
            assert!(design.teeth[0].thickness.cut_m.is_none(), "{name}");
        }
    }
}

/// Settings of the wrong hand, member or side are named with their key.
#[test]
fn settings_that_cannot_be_are_named() {
    let text = shipped("bevel_38_51.toml");
    let all = |from: &str, to: &str| text.replace(from, to);
    for (wrong, told) in [
        (
            all("= -54.735452", "= 54.735452"),
            "gear.concave.cradle_angle_deg: found 54.7355 degrees, which cuts a right hand; the gear has a left hand",
        ),
        (
            all("pinion_hand = \"right\"", "pinion_hand = \"left\""),
            "which cuts a left hand; the gear has a right hand",
        ),
        (
            all("= 96.265", "= 94.0"),
            "gear.concave.point_radius_mm: found 94.0000 mm, convex.point_radius_mm is 94.2350 mm",
        ),
        (
            all("1.2461602935829152", "0.802465"),
            "it is near that turned upside down; this is work over cradle",
        ),
        (
            all("= 51.1285", "= 34.5"),
            "gear.concave.machine_root_angle_deg: found 34.5000 degrees, the gear's root angle is 51.1285",
        ),
        (
            text.replacen("= 95.559965", "= 95.56", 1).replacen(
                "settings = \"given\"",
                "settings = \"given\"\nthickness = \"settings\"",
                1,
            ),
            "gear.thickness: found \"settings\", but the settings of both flanks differ",
        ),
        (
            text.replacen(
                "edge_radius_mm = 0.5",
                "edge_radius_mm = 0.5\nthickness = \"blank\"",
                1,
            ),
            "pinion: `thickness` belongs to settings \"given\", not to \"local-synthesis\"",
        ),
    ] {
        assert_ne!(wrong, text, "{told}");
        let error = made(&wrong).unwrap_err();
        assert!(error.contains(told), "{error}");
    }
}

/// A pair whose settings are stated, its pinion's by synthesis; one setting of the pinion off, and the flanks no longer
/// meet.
#[test]
fn flanks_that_do_not_meet_are_refused() {
    let text = shipped("bevel_20_20.toml");
    let (_, design) = made(&text).unwrap();
    let head = text.split("[gear]").next().unwrap();
    let stated = |change: &dyn Fn(usize, &mut gearmesh_bevel::FaceMill)| {
        let mut text = head.to_owned();
        for (m, name) in ["pinion", "gear"].into_iter().enumerate() {
            text.push_str(&format!("[{name}]\nsettings = \"given\"\n"));
            for (i, side) in FlankSide::BOTH.into_iter().enumerate() {
                let mut s = design.settings[m].unwrap()[i];
                if let gearmesh_bevel::Tool::FaceMill(mill) = &mut s.tool {
                    change(m, mill);
                }
                let table = format!("{name}.{}", side.word());
                text.push_str(&gearmesh_bevel::pair_file::settings_toml(&s, &table).unwrap());
            }
        }
        text
    };
    made(&stated(&|_, _| {})).unwrap();
    let steeper = stated(&|m, mill| {
        if m == 0 {
            mill.blade_angle_rad += 2f64.to_radians();
        }
    });
    let error = made(&steeper).unwrap_err();
    assert!(error.contains("do not meet"), "{error}");
    assert!(error.contains("degrees apart"), "{error}");
}

/// Edges of both blades lie side by side in the slot or not.
#[test]
fn edge_radii_that_do_not_fit_are_refused() {
    let text = shipped("bevel_13_35.toml");
    let from = "edge_radius_mm = 0.5\n\n";
    let with = |radius_mm: f64| {
        let changed = text.replacen(from, &format!("edge_radius_mm = {radius_mm:.4}\n\n"), 1);
        assert_ne!(changed, text);
        made(&changed)
    };
    let error = with(5.0).unwrap_err();
    assert!(error.contains("edge radius does not fit"), "{error}");
    // What it allows is allowed, a little more is not.
    let share: f64 = error
        .split("edge radii up to ")
        .nth(1)
        .and_then(|rest| rest.split(' ').next())
        .unwrap()
        .parse()
        .unwrap();
    let less = with(0.95 * 5.0 * share);
    assert!(less.is_ok(), "{:?}", less.err());
    assert!(with(1.05 * 5.0 * share).is_err());
}

fn backlash(file: &PairFile, design: &PairDesign, error: AssemblyError) -> f64 {
    let sides = FlankSide::BOTH.map(|side| {
        let request = TcaRequest {
            error,
            ..TcaRequest::default()
        };
        tooth_contact(design.flanks(side), &file.blank, &request).unwrap()
    });
    design.assembled_backlash_m(&file.blank, [&sides[0], &sides[1]])
}

/// The backlash of an assembly: a gear moved along its axis loses twice the move times sin α sin γ (derived by hand
/// from the pitch plane's normal), a heavy offset jams.
#[test]
fn assemblies_that_jam_are_told_apart() {
    let text = shipped("bevel_20_20.toml");
    let text = text.replacen("[bevel]", "[bevel]\nbacklash_mm = 0.15", 1);
    let (file, design) = made(&text).unwrap();
    let free = backlash(&file, &design, AssemblyError::default());
    near(1e3 * free, 0.15, 2e-3);
    let gear = |by: f64| AssemblyError {
        gear_axial_m: by,
        ..AssemblyError::default()
    };
    let slope = 2.0 * 20f64.to_radians().sin() * 45f64.to_radians().sin();
    let moved = [-10e-6, 10e-6].map(|by| backlash(&file, &design, gear(by)));
    // The least over a pitch is at contacts beside the mean points, whose normals differ.
    near((moved[1] - moved[0]) / (slope * 20e-6), 1.0, 0.05);
    let jam = |error| {
        let found = backlash(&file, &design, error);
        design.check_jam(&file.blank, (FlankSide::Concave, found))
    };
    assert!(jam(gear(-100e-6)).unwrap().is_none());
    // Warned of, refused.
    assert!(matches!(
        jam(gear(-400e-6)).unwrap(),
        Some(BevelError::Jam { .. })
    ));
    let far = AssemblyError {
        offset_m: -5e-3,
        ..AssemblyError::default()
    };
    let error = jam(far).unwrap_err();
    assert!(error.to_string().starts_with("teeth jam"), "{error}");
}

/// Where the next pair takes over there is a position: the peak-to-peak value no longer depends on how many there are.
#[test]
fn the_change_of_pairs_has_a_position() {
    let mut missed = 0.0;
    for name in ["bevel_20_20.toml", "bevel_13_35.toml", "bevel_31_36.toml"] {
        let (file, design) = made(&shipped(name)).unwrap();
        for side in FlankSide::BOTH {
            let found = [16, 48, 480].map(|per_pitch| {
                let request = TcaRequest {
                    per_pitch,
                    ..TcaRequest::default()
                };
                tooth_contact(design.flanks(side), &file.blank, &request).unwrap()
            });
            let [few, usual, many] = found.each_ref().map(|f| f.peak_to_peak_rad);
            near(usual / many, 1.0, 2e-5);
            near(few / many, 1.0, 1e-3);
            // Equal steps alone miss it.
            let errors = found[1].error_rad.iter().copied();
            missed = f64::max(missed, 1.0 + errors.fold(f64::INFINITY, f64::min) / many);
            // Both pairs stand there at the same lead.
            let between: Vec<_> = found[1].path.iter().filter(|p| p.is_between).collect();
            assert!(between.len() >= 2, "{name}");
            let lowest = between.iter().map(|p| p.error_rad).fold(0.0, f64::min);
            near(lowest, -usual, 1e-12);
        }
    }
    assert!(missed > 0.03, "{missed}");
}

/// Errors of assembly that are said to bring the contact to toe and heel do so in the contact analysis, and keep the
/// backlash.
#[test]
fn the_contact_goes_to_toe_and_heel() {
    for name in ["bevel_20_20.toml", "bevel_31_36.toml"] {
        let (file, design) = made(&shipped(name)).unwrap();
        let blank = &file.blank;
        let quarter = 0.25 * (blank.outer_cone_m - blank.mean_cone_m);
        for side in FlankSide::BOTH {
            let flanks = design.flanks(side);
            let mean = tooth_contact(flanks, blank, &TcaRequest::default()).unwrap();
            let none = AssemblyError::default();
            let check = design.vh_check(blank, side, (&none, &mean.mean.unwrap()));
            let by_offset = check.by_offset.map(Result::unwrap);
            let by_angle = check.by_shaft_angle.into_iter().flatten();
            for (i, setting) in by_offset.into_iter().chain(by_angle).enumerate() {
                let request = TcaRequest {
                    error: setting.error,
                    ..TcaRequest::default()
                };
                let found = tooth_contact(flanks, blank, &request).unwrap();
                // The path comes by there, and the lead has its largest value: the ratio of speeds is that of the
                // teeth.
                let sign = [-2.0, 2.0][i % 2];
                let wanted = [blank.mean_cone_m + sign * quarter, 0.0];
                near(setting.place_m[0], wanted[0], 1e-6);
                near(setting.place_m[1], wanted[1], 1e-6);
                let path = found.path.iter();
                let path: Vec<_> = path.filter(|p| p.kind == ContactKind::Flanks).collect();
                let apart = |p: &PathPoint| {
                    let [l, h] = p.places_m[1];
                    (l - wanted[0]).hypot(h - wanted[1])
                };
                let order = |a: &usize, b: &usize| apart(path[*a]).total_cmp(&apart(path[*b]));
                let k = (0..path.len()).min_by(order).unwrap();
                assert!(apart(path[k]) < 2e-4, "{name} {:e}", apart(path[k]));
                for beside in [k - 3, k + 3] {
                    assert!(path[beside].lead_rad < path[k].lead_rad, "{name} {i}");
                }
                assert!(found.contact_ratio > 0.5, "{name} {}", found.contact_ratio);
                // G keeps the backlash to the first order; without it some micrometres would be lost or won. Settings
                // by the shaft angle are larger, and lose some beside the mean points.
                if i > 1 {
                    continue;
                }
                let part = setting.error.scaled(0.05);
                let free = backlash(&file, &design, AssemblyError::default());
                near(backlash(&file, &design, part), free, 2e-6);
                let without = AssemblyError {
                    gear_axial_m: 0.0,
                    ..part
                };
                let lost = backlash(&file, &design, without) - free;
                assert!(lost.abs() > 3e-6, "{name} {lost:e}");
            }
        }
    }
}

/// Drawn at random: brought to the toe, the mean contact of this pair is a contact of the surfaces, but the gear's tip
/// touches first.
const EDGES_FIRST: &str = r#"title = "drawn"
[bevel]
teeth = [27, 66]
outer_module_mm = 7.586
face_width_mm = [84.41, 80.39]
spiral_angle_deg = 22.18
pressure_angle_deg = 25
shaft_angle_deg = 90
pinion_hand = "right"
taper = "duplex"
cutter_radius_mm = 260.19
thickness_shift = 0.038
backlash_mm = 0.247
[gear]
settings = "basic"
edge_radius_mm = 0.379
[pinion]
settings = "local-synthesis"
edge_radius_mm = 0.379
path_angle_deg = [75.3, 96.0]
ellipse_half_length_mm = [28.71, 18.93]
transmission_curvature = [-0.00600, -0.00242]
"#;

#[test]
fn a_place_at_which_an_edge_touches_first_is_not_reached() {
    let (file, design) = made(EDGES_FIRST).unwrap();
    let side = FlankSide::Concave;
    let mean = tooth_contact(design.flanks(side), &file.blank, &TcaRequest::default()).unwrap();
    let none = AssemblyError::default();
    let check = design.vh_check(&file.blank, side, (&none, &mean.mean.unwrap()));
    let [toe, heel] = check.by_offset;
    assert!(heel.is_ok());
    let stop = toe.unwrap_err();
    assert_eq!(stop.cause, VhCause::EdgeFirst);
    let words = stop.words();
    assert!(words.ends_with("there an edge touches first"), "{words}");
    // The contact analysis of that assembly: where the lead is largest a tip touches, by a good millimetre.
    let request = TcaRequest {
        error: stop.last.error,
        ..TcaRequest::default()
    };
    let found = tooth_contact(design.flanks(side), &file.blank, &request).unwrap();
    let flanks = found.path.iter().filter(|p| p.kind == ContactKind::Flanks);
    let away_m = flanks.map(|p| {
        let [l, h] = p.places_m[1];
        (l - stop.last.place_m[0]).hypot(h - stop.last.place_m[1])
    });
    assert!(away_m.fold(f64::INFINITY, f64::min) > 1e-3);
}

/// Nominal grids are tables that pair files read: the same flanks and the same thickness.
#[test]
fn nominal_grids_are_read_back() {
    let (file, design) = made(&shipped("bevel_13_35.toml")).unwrap();
    let gear = &design.teeth[1];
    let mut azimuths = [0.0; 2];
    for (i, side) in FlankSide::BOTH.into_iter().enumerate() {
        let text = gear.nominal_grid_csv(side, [15, 9]).unwrap();
        let folder = std::env::temp_dir().join(format!("gearmesh-grid-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let path = folder.join(format!("{}.csv", side.word()));
        std::fs::write(&path, &text).unwrap();
        let grid = gearmesh_bevel::GridSurface::read(&path, 0.0, &gear.blank, side).unwrap();
        assert!(grid.fit.rms_m < 2e-8, "{:e}", grid.fit.rms_m);
        azimuths[i] = gearmesh_bevel::Flank::through(&gear.blank, side, grid)
            .unwrap()
            .table_azimuth_rad()
            .unwrap();
        std::fs::remove_file(&path).unwrap();
        // Normals point out of the material: against the flank's own.
        let row: Vec<f64> = text
            .lines()
            .nth(68)
            .unwrap()
            .split(',')
            .map(|x| x.parse().unwrap())
            .collect();
        let facing = side.facing(gear.blank.hand);
        assert!(row[6] * facing > 0.0, "{row:?}");
    }
    let radius = gear.blank.mean_cone_m * gear.blank.pitch_angle_rad.sin();
    near(
        radius * (azimuths[0] - azimuths[1]).abs(),
        gear.thickness.counts_m(),
        1e-8,
    );
    assert_eq!(file.members.len(), 2);
}

#[test]
fn numbers_of_the_check_that_round_to_zero_have_no_sign() {
    let printed = [-3e-5, 0.0, -0.0, 6e-5, -6e-5]
        .map(|x| format!("{:.4}", gearmesh_bevel::vh_check::as_printed(x)));
    assert_eq!(printed, ["0.0000", "0.0000", "0.0000", "0.0001", "-0.0001"]);
}
