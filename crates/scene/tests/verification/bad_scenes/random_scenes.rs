//! Scenes of any numbers and parts: what is right is read, printed and read as the same; what is wrong is answered.

use crate::common::{build, fe_models, line_of, text};
use crate::property_cases::cases;
use gearmesh_geometry::input::InputDocument;
use gearmesh_scene::SceneFile;
use gearmesh_scene::system::SystemScene;
use gearmesh_specification::study::Study;
use proptest::prelude::*;
use proptest::sample::{Index, select};
use std::fmt::Write;

const JOINTS: [&str; 6] = [
    "fixed",
    "revolute",
    "prismatic",
    "cylindrical",
    "spherical",
    "planar",
];

/// A body on a joint to one before it or to the ground, with a load and a spring.
#[derive(Debug, Clone)]
struct Part {
    mass_kg: f64,
    gyration: [f64; 3],
    position_mm: [f64; 3],
    cardan_deg: [f64; 3],
    parent: Index,
    joint: &'static str,
    axis: [f64; 3],
    load: f64,
    stiffness: f64,
}

fn parts() -> impl Strategy<Value = Vec<Part>> {
    let three = |range: std::ops::Range<f64>| [range.clone(), range.clone(), range];
    let part = (
        (
            1e-3f64..1e3,
            three(0.1..1.0),
            three(-500.0..500.0),
            three(-80.0..80.0),
        ),
        (
            any::<Index>(),
            select(&JOINTS[..]),
            three(0.2..1.0),
            -100.0f64..100.0,
            1e-3f64..1e6,
        ),
    );
    let part = part.prop_map(|(own, joint)| Part {
        mass_kg: own.0,
        gyration: own.1,
        position_mm: own.2,
        cardan_deg: own.3,
        parent: joint.0,
        joint: joint.1,
        axis: joint.2,
        load: joint.3,
        stiffness: joint.4,
    });
    proptest::collection::vec(part, 1..6)
}

/// The scene as a person would write it, with comments.
fn scene(parts: &[Part], end_s: f64) -> String {
    let mut out = format!(
        "# made up\ntitle = \"any\"\ngravity_m_per_s2 = [0.0, -9.81, 0.0]\n[run]\nkind = \"transient\"\nend_s = {end_s}\n\
         [solver]\nstep_s = {}\n[output]\ninterval_s = {}\n",
        0.01 * end_s,
        0.1 * end_s,
    );
    for (i, p) in parts.iter().enumerate() {
        let [a, b, c] = p.gyration;
        let inertia = [b + c, a + c, a + b].map(|sum| 1e-3 * p.mass_kg * sum);
        let parent = match p.parent.index(i + 1) {
            0 => String::new(),
            before => format!("body_1 = \"body {}\"\n", before - 1),
        };
        let axis = match p.joint {
            "fixed" | "spherical" => String::new(),
            _ => format!("axis = {:?}\n", p.axis),
        };
        let _ = write!(
            out,
            "[[body]]\nname = \"body {i}\"\nmass_kg = {}\ninertia_kg_m2 = {inertia:?}\nposition_mm = {:?}\ncardan_deg = {:?}\n\
             [[joint]]\nname = \"joint {i}\" # to one before\nkind = \"{}\"\n{parent}body_2 = \"body {i}\"\n{axis}\
             [[load]]\nbody = \"body {i}\"\ntorque_Nm = {{ sine = {{ amplitude = {}, frequency_Hz = 3.0 }} }}\n\
             [[spring]]\nname = \"spring {i}\"\nbody_2 = \"body {i}\"\nat_1_mm = [0.0, 1e3, 0.0]\nstiffness_N_per_mm = {}\n",
            p.mass_kg, p.position_mm, p.cardan_deg, p.joint, p.load, p.stiffness,
        );
    }
    out
}

/// What a scene says, without its text.
fn said(text: &str) -> Result<String, String> {
    let document = InputDocument::new("scene.toml", text);
    let scene = SystemScene::from_document(document, &fe_models()).map_err(|e| e.to_string())?;
    Ok(format!(
        "{:?}",
        (scene.run, scene.solver, scene.output, scene.tables)
    ))
}

/// Values that keys get in place of theirs.
const VALUES: [&str; 14] = [
    "0",
    "-1",
    "1e-30",
    "1e30",
    "nan",
    "-inf",
    "9223372036854775807",
    "\"\"",
    "\"ground\"",
    "true",
    "[]",
    "{}",
    "[1.0, 2.0, 3.0]",
    "{ sum = [] }",
];

proptest! {
    #![proptest_config(cases(150))]

    /// Parsed, printed and parsed again, with keys in another order and without comments, a scene says the same.
    #[test]
    fn a_printed_scene_says_the_same(parts in parts(), end_s in 1e-3f64..10.0) {
        let text = scene(&parts, end_s);
        let first = said(&text);
        prop_assert!(first.is_ok(), "{first:?}\n{text}");
        let table: toml::Table = toml::from_str(&text).unwrap();
        prop_assert_eq!(first.unwrap(), said(&toml::to_string(&table).unwrap()).unwrap());
        // The parts of the system are those of the file. Joints of bodies that stand anywhere may contradict nothing.
        let built = build(&text);
        prop_assert!(built.is_ok(), "{}\n{text}", built.err().unwrap());
        let built = built.unwrap();
        prop_assert_eq!(built.system.bodies().len(), parts.len());
        let equations: usize = parts.iter()
            .map(|p| match p.joint { "fixed" => 6, "revolute" | "prismatic" => 5, "cylindrical" => 4, _ => 3 })
            .sum();
        prop_assert_eq!(built.system.mobility(), 6 * parts.len() - equations, "a tree has no redundant equations");
    }

    /// A misspelt key is named at its line, with the right one among those that are known.
    #[test]
    fn a_misspelt_key_is_named_with_the_right_one(parts in parts(), line in any::<Index>(), letter in any::<Index>()) {
        let text = scene(&parts, 1.0);
        let lines: Vec<&str> = text.lines().collect();
        let keyed: Vec<usize> = (0..lines.len()).filter(|&i| lines[i].contains(" = ")).collect();
        let at = keyed[line.index(keyed.len())];
        let key = lines[at].split(" = ").next().unwrap();
        let mut letters: Vec<char> = key.chars().collect();
        letters.remove(letter.index(letters.len()));
        let wrong: String = letters.iter().collect();
        prop_assume!(wrong.len() > 2 && !wrong.starts_with('_'));
        let mut changed: Vec<String> = lines.iter().map(|&l| l.to_owned()).collect();
        changed[at] = changed[at].replacen(key, &wrong, 1);
        let complaint = said(&changed.join("\n"));
        prop_assert!(complaint.is_err(), "`{wrong}` for `{key}` is read");
        let complaint = complaint.unwrap_err();
        prop_assert!(complaint.starts_with(&format!("scene.toml:{}: ", at + 1)), "line {}: {complaint}", at + 1);
        prop_assert!(complaint.contains(&format!("`{wrong}`")) && complaint.contains(&format!("`{key}`")), "{complaint}");
    }

    /// The name of a body misspelt anywhere is answered with the names there are.
    #[test]
    fn a_misspelt_body_is_answered_with_the_names(parts in parts(), letter in any::<Index>()) {
        let last = parts.len() - 1;
        let text = scene(&parts, 1.0);
        let place = format!("[[load]]\nbody = \"body {last}\"");
        let mut wrong: Vec<char> = format!("body {last}").chars().collect();
        wrong.remove(letter.index(wrong.len() - 1));
        let wrong: String = wrong.iter().collect();
        let changed = text.replacen(&place, &format!("[[load]]\nbody = \"{wrong}\""), 1);
        let complaint = build(&changed).err().map(|e| e.to_string());
        prop_assert!(complaint.is_some());
        let complaint = complaint.unwrap();
        let line = line_of(&changed, &format!("body = \"{wrong}\""));
        prop_assert!(complaint.starts_with(&format!("scene.toml:{line}: load.{last}.body: ")), "{complaint}");
        prop_assert!(complaint.contains("did you mean") && complaint.contains("`body 0`"), "{complaint}");
    }

    /// Shipped files with lines changed, removed, doubled or cut: read or refused, never a panic, and the building of
    /// what is read neither.
    #[test]
    fn damaged_files_are_read_or_refused(
        name in select(&[
            "scene_two_wheels.toml", "scene_pendulum.toml", "dynamics_17_25.toml", "gearbox_three_stage.toml", "pair_a.toml",
            "study_17_25.toml",
        ][..]),
        damage in proptest::collection::vec((0usize..4, any::<Index>(), any::<Index>()), 1..4),
    ) {
        let mut damaged = text(name);
        for (kind, place, value) in damage {
            let mut lines: Vec<String> = damaged.lines().map(str::to_owned).collect();
            let line = place.index(lines.len().max(1));
            let Some(old) = lines.get(line).cloned() else { continue };
            match (kind, old.split_once('=')) {
                (0, Some((key, _))) => lines[line] = format!("{key}= {}", VALUES[value.index(VALUES.len())]),
                (1, _) => drop(lines.remove(line)),
                (2, _) => lines.insert(line, old),
                _ => {
                    let letters: Vec<char> = old.chars().collect();
                    let cut = value.index(letters.len() + 1);
                    lines[line] = letters.iter().take(cut).chain(letters.iter().skip(cut + 3)).collect();
                }
            }
            damaged = lines.join("\n");
        }
        let document = InputDocument::new("scene.toml", damaged.as_str());
        let refused = if name.starts_with("study") {
            Study::from_document(document, &fe_models()).err()
        } else {
            SceneFile::from_document(document, &fe_models()).err()
        };
        match refused {
            Some(e) => prop_assert!(e.to_string().starts_with("scene.toml") , "{e}"),
            // Gears are read and the system put together, where no reduced gear is needed.
            None if name == "scene_two_wheels.toml" || name == "scene_pendulum.toml" => {
                let _ = build(&damaged);
            }
            None => {}
        }
    }
}
