//! The time of an import grows with the size of the file: every shape of input that once took the square of it.

use gearmesh_rexs::{Import, Meshes, import};
use std::fmt::Write;

/// Components of each file, about.
const COUNT: usize = 4_000;

/// Imports files of a number of components and of twice that number: what the import looks at doubles. A
/// part of it that grew with the square and made up a tenth of the smaller file's looks would add a fifth.
fn grows_linearly(make: impl Fn(usize) -> Import) {
    let [once, twice] = [COUNT, 2 * COUNT].map(|count| make(count).visits as f64);
    let ratio = twice / once;
    assert!(
        (1.9..2.1).contains(&ratio),
        "{once} looks, {twice} at twice as many components: {ratio:.4} times"
    );
}

#[derive(Default)]
struct File {
    relations: String,
    components: String,
    next: usize,
}

impl File {
    fn component(&mut self, kind: &str, attributes: &[(&str, &str, String)]) -> usize {
        self.next += 1;
        let id = self.next;
        let mut all = String::new();
        for (name, unit, value) in attributes {
            writeln!(
                all,
                "<attribute id=\"{name}\" unit=\"{unit}\">{value}</attribute>"
            )
            .unwrap();
        }
        writeln!(
            self.components,
            "<component id=\"{id}\" type=\"{kind}\" name=\"{kind}\">\n{all}</component>"
        )
        .unwrap();
        id
    }

    fn relate(&mut self, kind: &str, references: &[(usize, &str)]) {
        write!(self.relations, "<relation id=\"1\" type=\"{kind}\">").unwrap();
        for (id, role) in references {
            write!(self.relations, "<ref id=\"{id}\" role=\"{role}\"/>").unwrap();
        }
        self.relations.push_str("</relation>\n");
    }

    fn shaft(&mut self, x: f64) -> usize {
        let place = format!("<array><c>0</c><c>{x}</c><c>0</c></array>");
        self.component(
            "shaft",
            &[
                ("support_vector", "mm", place),
                ("rotational_speed", "1 / min", "10".to_owned()),
            ],
        )
    }

    fn gear(&mut self, shaft: usize, u: f64) -> usize {
        let number = |x: f64| x.to_string();
        let id = self.component(
            "cylindrical_gear",
            &[
                ("number_of_teeth", "none", number(31.0)),
                ("normal_module", "mm", number(2.0)),
                ("face_width", "mm", number(5.0)),
                ("u_coordinate_on_shaft", "mm", number(u)),
            ],
        );
        self.relate("assembly", &[(shaft, "assembly"), (id, "part")]);
        id
    }

    fn load(&mut self, shaft: usize, torque: f64) {
        let id = self.component(
            "external_load",
            &[("torque_around_u_axis", "N m", torque.to_string())],
        );
        self.relate("assembly", &[(shaft, "assembly"), (id, "part")]);
    }

    fn read(&self) -> Import {
        let text = format!(
            "<model version=\"1.4\"><relations>\n{}</relations><components>\n{}</components></model>",
            self.relations, self.components
        );
        import(text.into_bytes(), "box", Meshes::Iso6336).unwrap()
    }
}

/// Shafts that carry a load each and nothing else.
#[test]
fn lone_shafts() {
    grows_linearly(|number| {
        let mut file = File::default();
        for i in 0..number / 2 {
            let shaft = file.shaft(i as f64);
            file.load(shaft, 0.0);
        }
        let made = file.read();
        assert_eq!(made.scenes.len(), 1);
        made
    });
}

#[test]
fn sections_of_one_shaft() {
    grows_linearly(|number| {
        let mut file = File::default();
        let shaft = file.shaft(0.0);
        file.load(shaft, 1.0);
        for i in 0..number {
            let of = |x: f64| x.to_string();
            // Half of them drawn over others.
            let start = 0.5 * (i / 2) as f64;
            let piece = [
                ("length", "mm", of(0.5)),
                ("u_coordinate_on_shaft", "mm", of(start)),
                ("outer_diameter_begin", "mm", of(300.0 + (i % 5) as f64)),
            ];
            let id = file.component("shaft_section", &piece);
            file.relate("assembly", &[(shaft, "assembly"), (id, "part")]);
        }
        file.read()
    });
}

#[test]
fn gears_on_one_shaft() {
    grows_linearly(|number| {
        let mut file = File::default();
        let shaft = file.shaft(0.0);
        for i in 0..number {
            file.gear(shaft, 6.0 * i as f64);
        }
        file.load(shaft, 1.0);
        let made = file.read();
        assert_eq!(made.gears.len(), number);
        made
    });
}

/// A train of as many stages as there are shafts, whose places follow from each other, the last one first.
#[test]
fn a_train_of_many_stages() {
    grows_linearly(|number| {
        let mut file = File::default();
        let count = number / 4;
        let shafts: Vec<usize> = (0..count).map(|_| file.component("shaft", &[])).collect();
        let gears: Vec<usize> = shafts.iter().map(|&shaft| file.gear(shaft, 20.0)).collect();
        for pair in gears.windows(2).rev() {
            let stage = file.component(
                "cylindrical_stage",
                &[("center_distance", "mm", "62".to_owned())],
            );
            file.relate(
                "stage",
                &[(stage, "stage"), (pair[0], "gear_1"), (pair[1], "gear_2")],
            );
        }
        for &shaft in &shafts {
            for u in ["2", "38"] {
                let bearing = file.component(
                    "concept_bearing",
                    &[("u_coordinate_on_shaft_inner_side", "mm", u.to_owned())],
                );
                file.relate(
                    "side",
                    &[
                        (bearing, "assembly"),
                        (shaft, "inner_part"),
                        (0, "outer_part"),
                    ],
                );
            }
        }
        // The casing.
        file.components
            .push_str("<component id=\"0\" type=\"gear_casing\" name=\"casing\"></component>\n");
        file.load(shafts[0], 1.0);
        file.load(
            shafts[count - 1],
            if count.is_multiple_of(2) { 1.0 } else { -1.0 },
        );
        let made = file.read();
        assert_eq!(made.sheets[0].meshes.len(), count - 1);
        made
    });
}

#[test]
fn attributes_of_one_component() {
    grows_linearly(|number| {
        let mut file = File::default();
        let shaft = file.shaft(0.0);
        file.load(shaft, 1.0);
        let names: Vec<String> = (0..number).map(|i| format!("further_{i}")).collect();
        let attributes: Vec<(&str, &str, String)> = names
            .iter()
            .map(|n| (n.as_str(), "mm", "1".to_owned()))
            .collect();
        file.component("gear_casing", &attributes);
        file.next += attributes.len();
        let made = file.read();
        assert!(made.ledger.not_represented.len() >= number);
        made
    });
}

/// More than 1000 places that are given from each other are no circle.
#[test]
fn chains_of_references() {
    grows_linearly(|number| {
        let mut file = File::default();
        for i in 0..number {
            let from = if i == 0 { 1 } else { i };
            let place = "<array><c>0</c><c>1</c><c>0</c></array>".to_owned();
            let kind = if i == 0 { "gear_unit" } else { "shaft" };
            let id = file.component(
                kind,
                &[
                    ("support_vector", "mm", place),
                    ("reference_component_for_position", "none", from.to_string()),
                ],
            );
            assert_eq!(id, i + 1);
        }
        file.load(number, 1.0);
        let made = file.read();
        let scene = &made.files[0].text;
        assert!(
            scene.contains(&format!("origin_mm = [0.0, {number}.0, 0.0]")),
            "{scene}"
        );
        made
    });
}

/// Shafts of as many directions: against the first one along its line a shaft may run the other way.
#[test]
fn shafts_of_many_directions() {
    grows_linearly(|number| {
        let mut file = File::default();
        for i in 0..number / 2 {
            let around = 0.7 * i as f64;
            let up = 2.0 * (i as f64 + 0.5) / (number / 2) as f64 - 1.0;
            let across = (1.0 - up * up).sqrt();
            let place = format!("<array><c>0</c><c>{i}</c><c>0</c></array>");
            let [x, y] = [across * around.cos(), across * around.sin()];
            let u = format!("<array><c>{x}</c><c>{y}</c><c>{up}</c></array>");
            let w = format!("<array><c>{}</c><c>{}</c><c>0</c></array>", -y, x);
            let shaft = file.component(
                "shaft",
                &[
                    ("support_vector", "mm", place),
                    ("u_axis_vector", "mm", u),
                    ("w_axis_vector", "mm", w),
                ],
            );
            file.load(shaft, 0.0);
        }
        file.read()
    });
}

/// Gears that are cut into one shaft, from its far end on, and a section for each.
#[test]
fn gears_cut_into_a_shaft_backwards() {
    grows_linearly(|number| {
        let mut file = File::default();
        let shaft = file.shaft(0.0);
        for i in (0..number / 2).rev() {
            let of = |x: f64| x.to_string();
            file.gear(shaft, 6.0 * i as f64 + 0.5);
            let piece = [
                ("length", "mm", of(6.0)),
                ("u_coordinate_on_shaft", "mm", of(6.0 * i as f64)),
                ("outer_diameter_begin", "mm", of(55.0)),
            ];
            let id = file.component("shaft_section", &piece);
            file.relate("assembly", &[(shaft, "assembly"), (id, "part")]);
        }
        file.load(shaft, 1.0);
        let made = file.read();
        assert_eq!(made.gears.len(), number / 2);
        made
    });
}

/// Gears that turn loose on a shaft of many sections: no hub takes the sections with it.
#[test]
fn loose_gears_on_a_shaft_of_many_sections() {
    grows_linearly(|number| {
        let mut file = File::default();
        let shaft = file.shaft(0.0);
        for i in 0..number / 4 {
            let of = |x: f64| x.to_string();
            let gear = file.gear(shaft, 6.0 * i as f64);
            let clutch = file.component(
                "switchable_coupling",
                &[("is_engaged", "none", "false".to_owned())],
            );
            file.relate(
                "side",
                &[(clutch, "assembly"), (shaft, "side_1"), (gear, "side_2")],
            );
            let piece = [
                ("length", "mm", of(6.0)),
                ("outer_diameter_begin", "mm", of(20.0)),
            ];
            let id = file.component("shaft_section", &piece);
            file.relate("assembly", &[(shaft, "assembly"), (id, "part")]);
        }
        file.load(shaft, 1.0);
        let made = file.read();
        assert_eq!(made.gears.len(), number / 4);
        made
    });
}

/// Members that share one stage of many planets.
#[test]
fn a_stage_of_many_planets() {
    grows_linearly(|number| {
        let mut file = File::default();
        let (carrier, sun_shaft, ring_shaft) = (file.shaft(0.0), file.shaft(0.0), file.shaft(0.0));
        let sun = file.gear(sun_shaft, 0.0);
        let ring = file.component(
            "ring_gear",
            &[("number_of_teeth", "none", "-93".to_owned())],
        );
        file.relate("assembly", &[(ring_shaft, "assembly"), (ring, "part")]);
        let stage = file.component("planetary_stage", &[]);
        file.relate(
            "planet_carrier_shaft",
            &[(stage, "planetary_stage"), (carrier, "shaft")],
        );
        for i in 0..number / 6 {
            let pin = file.shaft(i as f64);
            file.relate("planet_pin", &[(stage, "planetary_stage"), (pin, "shaft")]);
            let planet = file.gear(pin, 0.0);
            for mate in [sun, ring] {
                let pair = file.component("cylindrical_stage", &[]);
                file.relate(
                    "stage",
                    &[(pair, "stage"), (planet, "gear_1"), (mate, "gear_2")],
                );
                file.relate("assembly", &[(stage, "assembly"), (pair, "part")]);
            }
        }
        for shaft in [carrier, sun_shaft] {
            file.load(shaft, 1.0);
        }
        file.read()
    });
}

/// A relation that names every component is none of the format, and is reported.
#[test]
fn a_relation_of_all_components() {
    grows_linearly(|number| {
        let mut file = File::default();
        let shaft = file.shaft(0.0);
        file.load(shaft, 1.0);
        let mut all = vec![(shaft, "assembly")];
        for i in 0..number {
            let kind = if i % 2 == 0 { "shaft" } else { "shaft_section" };
            all.push((file.component(kind, &[]), "part"));
        }
        file.relate("assembly", &all);
        let made = file.read();
        let told = made.ledger.not_represented.iter();
        assert!({ told }.any(|e| e.text.contains(&format!("names {} components", number + 1))));
        made
    });
}

/// Two shafts joined by rings of stages: each ring is a loop, whose torques depend on stiffness.
#[test]
fn a_ladder_of_loops() {
    grows_linearly(|number| {
        let mut file = File::default();
        let shafts: Vec<usize> = (0..number / 4)
            .map(|i| file.shaft(62.0 * i as f64))
            .collect();
        for (i, pair) in shafts.windows(2).enumerate() {
            let [a, b] = [pair[0], pair[1]];
            let coupled = |file: &mut File, a, b| {
                let coupling = file.component("coupling", &[]);
                file.relate(
                    "side",
                    &[(coupling, "assembly"), (a, "side_1"), (b, "side_2")],
                );
            };
            coupled(&mut file, a, b);
            // A second way back to the first shaft closes a loop over all that is between.
            if i % 2 == 1 {
                coupled(&mut file, shafts[0], b);
            }
        }
        file.load(shafts[0], 1.0);
        file.load(shafts[shafts.len() - 1], -1.0);
        file.read()
    });
}
