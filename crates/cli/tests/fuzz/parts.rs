//! Files of parts and of other programs: bearings, bevel pairs, points of their flanks, optimisations, universal files,
//! archives.

use crate::common::{points_of_flank, root};
use crate::files::{document, fuzz_text, scene_is_answered, shipped, shipped_texts};
use crate::{fuzz, mutation};
use gearmesh_bearings::bearing_file::BearingFromFile;
use gearmesh_bearings::{
    AppliedBearingLoad, Control, Operation, QuasiStaticBearing, TiltCondition,
};
use gearmesh_bevel::{FlankSide, PairFile};
use gearmesh_operations::{Watch, uff};
use gearmesh_rexs::{Meshes, Running, import_to_run};
use gearmesh_scene::InputKind;
use gearmesh_specification::optimise::Optimisation;
use std::io::Write as _;

/// Kinds that none of the shipped bearings has, and a line of a catalogue.
const BEARINGS: [&str; 4] = [
    "name = \"NU 204\"\nkind = \"cylindrical-roller\"\nrollers = 12\nroller_diameter_mm = 7.5\nroller_length_mm = 9.0\npitch_diameter_mm = 34.0\nradial_clearance_um = 10.0\n",
    "name = \"30206\"\nkind = \"tapered-roller\"\nrollers = 17\nroller_diameter_mm = 7.5\nroller_length_mm = 11.0\npitch_diameter_mm = 46.0\ncontact_angle_deg = 14.0\n",
    "name = \"QJ\"\nkind = \"four-point\"\nballs = 15\nball_diameter_mm = 9.0\npitch_diameter_mm = 60.0\ncontact_angle_deg = 35.0\ninner_conformity = 0.52\nouter_conformity = 0.53\n",
    "name = \"6206\"\nkind = \"catalogue\"\ndesignation = \"6206\"\n",
];

#[test]
fn bearings() {
    let mut corpus = shipped_texts(|document| BearingFromFile::recognises(document).unwrap());
    corpus.extend(BEARINGS.map(str::to_owned));
    fuzz_text("bearing", 300, &corpus, |text| {
        let Ok(found) = BearingFromFile::from_document(&document(text)) else {
            return;
        };
        let Ok(bearing) = QuasiStaticBearing::new(&found.definition) else {
            return;
        };
        let load = AppliedBearingLoad {
            force_n: [100.0, -1000.0, 200.0],
            tilt: TiltCondition::Moments([0.0; 2]),
        };
        let operation = Operation {
            inner_rad_per_s: 100.0,
            outer_rad_per_s: 0.0,
            cage_angle_rad: 0.0,
            inner_angle_rad: 0.0,
            control: Control::OuterRace,
        };
        if let Ok(pose) = bearing.equilibrium(&load, &operation) {
            assert!(pose.to_five().iter().all(|q| q.is_finite()), "{pose:?}");
        }
    });
}

#[test]
fn bevel_pairs() {
    let corpus = shipped_texts(|document| PairFile::recognises(document).unwrap());
    fuzz_text("bevel_pair", 300, &corpus, |text| {
        let document = document(text);
        if let Ok(pair) = PairFile::from_document(&document) {
            let _ = pair.checked_design(&document);
        }
    });
}

#[test]
fn points_of_flanks() {
    let desk = tempfile::tempdir().unwrap();
    let file = root().join("fe_models/bevel_13_35.toml");
    let design = PairFile::read(&file).unwrap().design().unwrap();
    let grid = |side: FlankSide| {
        let flank = (design.teeth[1].flanks.iter())
            .find(|flank| flank.side == side)
            .unwrap();
        points_of_flank(flank, [5, 4])
    };
    let [concave, convex] = [FlankSide::Concave, FlankSide::Convex].map(grid);
    std::fs::write(desk.path().join("convex.csv"), &convex).unwrap();
    let settings =
        "settings = \"points\"\nconcave_points = \"concave.csv\"\nconvex_points = \"convex.csv\"";
    let pair = std::fs::read_to_string(&file).unwrap();
    let pair = pair.replace("settings = \"basic\"\nedge_radius_mm = 0.5", settings);
    let at = desk.path().join("pair.toml");
    std::fs::write(&at, pair).unwrap();
    fuzz_text("points", 150, &[concave, convex], |text| {
        std::fs::write(desk.path().join("concave.csv"), text).unwrap();
        if let Ok(pair) = PairFile::read(&at) {
            let _ = pair.design();
        }
    });
}

#[test]
fn optimisations() {
    let folder = root().join("fe_models");
    let corpus = shipped(InputKind::Optimisation);
    fuzz_text("optimisation", 200, &corpus, |text| {
        let _ = Optimisation::from_document(document(text), &folder);
    });
}

/// Each case starts Python.
#[test]
fn universal_files() {
    let desk = tempfile::tempdir().unwrap();
    let file = desk.path().join("case.uff");
    let head = |name: &str| {
        format!(
            "    -1\n    58\n{name}\nNONE\n27-Nov-26 10:00:00\nNONE\nNONE\n    1         1    1         0 NONE               1   1 NONE               1   1\n\
             \x20        2         4         1  0.00000e+00  1.00000e-03  0.00000e+00\n\
             \x20       17    0    0    0 time                 s\n\
             \x20        8    0    0    0 strain               uE\n\
             \x20        0    0    0    0 NONE                 NONE\n\
             \x20        0    0    0    0 NONE                 NONE\n"
        )
    };
    let corpus = [
        format!(
            "{}  1.00000e+00  2.00000e+00  3.00000e+00  4.00000e+00\n    -1\n",
            head("gauge")
        ),
        format!(
            "{0}  1.0  2.0  3.0  4.0\n    -1\n{0}  1.0  2.0  3.0  4.0\n    -1\n",
            head("two")
        ),
    ];
    std::fs::write(&file, &corpus[0]).unwrap();
    assert!(uff::read(&file, &Watch::unattended()).is_ok());
    fuzz_text("universal", 8, &corpus, |text| {
        std::fs::write(&file, text).unwrap();
        let _ = uff::read(&file, &Watch::unattended());
    });
}

/// A gearbox in a zip file, beside a picture.
#[test]
fn archives() {
    let model = std::fs::read(root().join("crates/cli/tests/scene_commands/idler_on_bearing.rexs"));
    let mut archive = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    for (name, content) in [("box.rexs", model.unwrap()), ("picture.png", vec![7; 300])] {
        let options = zip::write::SimpleFileOptions::default();
        archive.start_file(name, options).unwrap();
        archive.write_all(&content).unwrap();
    }
    let sound = archive.finish().unwrap().into_inner();
    let make = |random: &mut fastrand::Rng| mutation::bytes(&sound, 0, random);
    let folder = tempfile::tempdir().unwrap();
    fuzz("archive", 1000, make, |case| {
        let running = Running::AtRest;
        let Ok(import) = import_to_run(case.to_vec(), "case", Meshes::Iso6336, running) else {
            return;
        };
        for file in import
            .files
            .iter()
            .filter(|file| import.scenes.contains(&file.name))
        {
            scene_is_answered(&file.text, folder.path());
        }
    });
}
