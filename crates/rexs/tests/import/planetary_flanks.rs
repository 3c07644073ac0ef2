//! Flank modifications of the gears of planetary stages, and which way the set looks: z of its gears is along the
//! shafts of the scene, whatever the shafts of planets and ring do in the file.

use crate::other_gearboxes::{component, demand_all_listed};
use crate::planetary::gearbox_of;
use crate::{changed, file};
use gearmesh_rexs::{Import, Meshes, Running, Weight, import_to_run};

type Attribute = (&'static str, &'static str, &'static str);

/// Modification of a gear: gear, which flanks, kind, attributes.
type Modification = (
    usize,
    &'static [&'static str],
    &'static str,
    &'static [Attribute],
);

const BOTH: &[&str] = &["left", "right"];

const MODIFICATIONS: [Modification; 7] = [
    (
        20,
        BOTH,
        "tip_relief",
        &[
            ("tip_relief_depth", "mm", "0.02"),
            ("tip_relief_datum_diameter", "mm", "42"),
            ("shape_of_relief", "none", "parabolic"),
        ],
    ),
    (
        320,
        BOTH,
        "helix_crowning",
        &[
            ("helix_crowning_amount_datum_face", "mm", "0.006"),
            ("helix_crowning_amount_non_datum_face", "mm", "0.006"),
        ],
    ),
    (
        320,
        &["left"],
        "helix_slope",
        &[("helix_slope", "mm", "0.01")],
    ),
    // The other planets are as the first, but for this one.
    (321, BOTH, "helix_slope", &[("helix_slope", "mm", "0.03")]),
    // Diameters of rings with the sign of ISO 21771 and without: tip at 124.8 mm, root at 133 mm.
    (
        21,
        BOTH,
        "tip_relief",
        &[
            ("tip_relief_depth", "mm", "0.015"),
            ("tip_relief_datum_diameter", "mm", "-127"),
        ],
    ),
    (
        21,
        &["left"],
        "root_relief",
        &[
            ("root_relief_depth", "mm", "0.005"),
            ("root_relief_datum_diameter", "mm", "129"),
        ],
    ),
    (21, BOTH, "helix_slope", &[("helix_slope", "mm", "0.008")]),
];

/// A gearbox with a planetary stage of modified gears, imported; `turned` shafts point against the others.
fn modified(
    planets_deg: [f64; 3],
    turned: impl Fn(String) -> String,
    with: Meshes,
) -> (String, Import) {
    let loads = [("motor", 10, "50"), ("machine", 14, "")];
    let (mut parts, mut relations) = (String::new(), String::new());
    let mut join = |kind: &str, refs: &[(usize, &str)]| {
        let refs = refs
            .iter()
            .map(|(id, role)| format!("<ref id=\"{id}\" role=\"{role}\"/>"));
        let id = 9000 + relations.lines().count();
        let refs: String = refs.collect();
        relations += &format!("<relation id=\"{id}\" type=\"{kind}\">{refs}</relation>\n");
    };
    for gear in [20, 320, 321, 322, 21] {
        let flanks = [2000 + 2 * gear, 2001 + 2 * gear];
        for flank in flanks {
            parts += &component(flank, "cylindrical_gear_flank", "", &[]);
        }
        join(
            "flank",
            &[(gear, "gear"), (flanks[0], "left"), (flanks[1], "right")],
        );
    }
    for (i, (gear, sides, kind, attributes)) in MODIFICATIONS.iter().enumerate() {
        parts += &component(4000 + i, kind, "", attributes);
        for side in *sides {
            let flank = 2000 + 2 * gear + usize::from(*side == "right");
            join("reference", &[(flank, "origin"), (4000 + i, "referenced")]);
        }
    }
    let text = gearbox_of(planets_deg, "brake", &loads);
    let text = changed(&text, "</relations>", &format!("{relations}</relations>"));
    let text = changed(&text, "</components>", &format!("{parts}</components>"));
    let text = turned(text);
    let made = import_to_run(text.clone().into_bytes(), "box", with, Running::AtRest).unwrap();
    (text, made)
}

/// `[microgeometry]` and what follows it.
fn flanks_of<'a>(made: &'a Import, gear: &str) -> &'a str {
    let text = file(made, &format!("box_{gear}.toml"));
    let at = text.find("[microgeometry");
    &text[at.unwrap_or(text.len())..]
}

const AS_GIVEN: [f64; 3] = [0.0, 120.0, 240.0];

/// What modifies sun, planet and ring stands in their gear files; scenes name these where springs know no flanks, and
/// their models where they are to be reduced. The planet that differs is reported.
#[test]
fn gears_of_sets_have_their_modifications() {
    for with in [Meshes::Iso6336, Meshes::Hybrid] {
        let (text, made) = modified(AS_GIVEN, |text| text, with);
        demand_all_listed(&text, &made);
        assert_eq!(
            flanks_of(&made, "sun"),
            "[microgeometry]\ntip_relief_um = 20.0\ntip_relief_start_diameter_mm = 42.0\ntip_relief_shape = \"parabolic\"\n"
        );
        assert_eq!(
            flanks_of(&made, "planet_0"),
            "[microgeometry.left]\nlead_crowning_um = 6.0\nflank_angle_um = 10.0\n\n[microgeometry.right]\nlead_crowning_um = 6.0\n"
        );
        // Left flanks of the file, on which planets press with theirs, are right ones of gear files.
        let ring = "tip_relief_um = 15.0\ntip_relief_start_diameter_mm = 127.0\ntip_relief_shape = \"linear\"\n";
        let root = "root_relief_um = 5.0\nroot_relief_start_diameter_mm = 129.0\nroot_relief_shape = \"linear\"\n";
        let slope = "flank_angle_um = 8.0\n";
        assert_eq!(
            flanks_of(&made, "ring"),
            format!(
                "[microgeometry.left]\n{ring}{slope}\n[microgeometry.right]\n{ring}{root}{slope}"
            )
        );
        let words = "its flank modifications are others than those of planet 0, which all planets of the scene have";
        for (planet, is_told) in [("321", true), ("322", true), ("320", false)] {
            let mut told = made.ledger.of_weight(Weight::Heavy, Meshes::Hybrid);
            let told = told.any(|e| {
                e.subject.starts_with(&format!("cylindrical_gear {planet}"))
                    && e.text.contains(words)
            });
            assert_eq!(told, is_told, "{planet}");
        }
        let scene = file(&made, "box.toml");
        let (model, ending) = match with {
            Meshes::Iso6336 => ("iso6336\", slices = 9 }, microgeometry = false }", "toml"),
            Meshes::Hybrid => ("hybrid\" } }", "h5"),
        };
        for words in [
            format!("sun_mesh = {{ model = {{ kind = \"{model}"),
            format!("ring_mesh = {{ model = {{ kind = \"{model}"),
            format!("name = \"sun\"\ngear = \"box_sun.{ending}\""),
            format!("ring = {{ gear = \"box_ring.{ending}\", support = \"held\" }}"),
            format!("planets = {{ gear = \"box_planet_0.{ending}\""),
        ] {
            assert!(scene.contains(&words), "{words} is not in {scene}");
        }
    }
}

/// Shafts of planets and ring that point against the sun's: their datum faces and flanks are seen from the other end.
#[test]
fn modifications_of_turned_gears_are_seen_from_the_other_end() {
    let turned = |text: String| {
        let begin = |id: usize| format!("<component id=\"{id}\" type=\"shaft\"");
        let mut text = text;
        for id in [300, 301, 302, 13] {
            let at = text.find(&begin(id)).unwrap();
            let (before, after) = text.split_at(at);
            let after = after.replacen("<c>1</c><c>0</c><c>0</c>", "<c>-1</c><c>0</c><c>0</c>", 1);
            text = format!("{before}{after}");
        }
        text
    };
    let (_, made) = modified(AS_GIVEN, turned, Meshes::Hybrid);
    assert_eq!(
        flanks_of(&made, "planet_0"),
        "[microgeometry.left]\nlead_crowning_um = 6.0\n\n[microgeometry.right]\nlead_crowning_um = 6.0\nflank_angle_um = -10.0\n"
    );
    let ring = flanks_of(&made, "ring");
    let (left, right) = ring.split_once("\n\n").unwrap();
    assert!(left.starts_with("[microgeometry.left]") && left.contains("root_relief_um"));
    assert!(right.ends_with("flank_angle_um = -8.0\n") && !right.contains("root_relief_um"));
}

/// Where the sun's shaft points against the first one along its line, the set looks along that one: its planets are
/// where the file has them, and its gears are seen from there.
#[test]
fn planets_of_a_turned_sun_stand_where_the_file_has_them() {
    // Places that fit, every 360/84 deg, at unequal angles.
    let planets_deg = [0.0, 25.0 * 360.0 / 84.0, 240.0];
    // The first carrier shaft before the sun's, which is turned round: it began at x = 0 and ends there now.
    let turned = |text: String| {
        let [sun, carrier, next] = [10, 11, 12].map(|id| {
            text.find(&format!("<component id=\"{id}\" type=\"shaft\""))
                .unwrap()
        });
        let own = text[sun..carrier]
            .replacen("<c>1</c><c>0</c><c>0</c>", "<c>-1</c><c>0</c><c>0</c>", 1)
            .replacen("<c>0</c><c>0</c><c>0</c>", "<c>350</c><c>0</c><c>0</c>", 1);
        format!(
            "{}{}{own}{}",
            &text[..sun],
            &text[carrier..next],
            &text[next..]
        )
    };
    for (is_turned, axis) in [(false, 1.0), (true, 1.0)] {
        let (_, made) = modified(
            planets_deg,
            |text| if is_turned { turned(text) } else { text },
            Meshes::Hybrid,
        );
        let scene = file(&made, "box.toml");
        let set = scene.split_once("[[planetary]]").unwrap().1;
        let list = |key: &str| -> Vec<f64> {
            let text = set.split_once(&format!("{key} = [")).unwrap().1;
            let text = text.split_once(']').unwrap().0.split(',');
            text.map(|value| value.trim().parse().unwrap()).collect()
        };
        assert_eq!(list("axis"), [axis, 0.0, 0.0], "{is_turned}");
        // Turned about y until z is x, x is −z: planets at φ stand at y = sin φ, z = −cos φ.
        for (angle, stated) in list("angles_deg").iter().zip(planets_deg) {
            let (sin, cos) = angle.to_radians().sin_cos();
            let (y, z) = stated.to_radians().sin_cos();
            let off = (sin - y).hypot(-axis * cos - z);
            assert!(off < 1e-4, "{is_turned}: {angle} {stated} {off}");
        }
        // Planets point along the axis: as they are given.
        let planet = flanks_of(&made, "planet_0");
        assert!(planet.contains("flank_angle_um = 10.0"), "{planet}");
    }
}
