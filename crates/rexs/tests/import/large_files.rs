//! The time of an import grows with the size of the file: every shape of input that once took the square of it.

use gearmesh_rexs::{Import, Meshes, import};
use std::fmt::Write;
use std::time::Instant;

/// Components of each file; the time is allowed for a busy machine, 16 000 lone shafts took 32 s.
const COUNT: usize = 20_000;
const MOST_S: f64 = 10.0;

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

    /// Imports it, in time.
    fn read(&self, what: &str) -> Import {
        let text = format!(
            "<model version=\"1.4\"><relations>\n{}</relations><components>\n{}</components></model>",
            self.relations, self.components
        );
        let begun = Instant::now();
        let made = import(text.into_bytes(), "box", Meshes::Iso6336).unwrap();
        let seconds = begun.elapsed().as_secs_f64();
        assert!(
            seconds < MOST_S,
            "{what}: {seconds:.1} s for {} components",
            self.next
        );
        made
    }
}

/// Shafts that carry a load each and nothing else.
#[test]
fn lone_shafts() {
    let mut file = File::default();
    for i in 0..COUNT / 2 {
        let shaft = file.shaft(i as f64);
        file.load(shaft, 0.0);
    }
    assert_eq!(file.read("lone shafts").scenes.len(), 1);
}

#[test]
fn sections_of_one_shaft() {
    let mut file = File::default();
    let shaft = file.shaft(0.0);
    file.load(shaft, 1.0);
    for i in 0..COUNT {
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
    file.read("sections of one shaft");
}

#[test]
fn gears_on_one_shaft() {
    let mut file = File::default();
    let shaft = file.shaft(0.0);
    for i in 0..COUNT {
        file.gear(shaft, 6.0 * i as f64);
    }
    file.load(shaft, 1.0);
    assert_eq!(file.read("gears on one shaft").gears.len(), COUNT);
}

/// A train of as many stages as there are shafts, whose places follow from each other, the last one first.
#[test]
fn a_train_of_many_stages() {
    let mut file = File::default();
    let count = COUNT / 4;
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
    let made = file.read("a train of many stages");
    assert_eq!(made.sheets[0].meshes.len(), count - 1);
}

#[test]
fn attributes_of_one_component() {
    let mut file = File::default();
    let shaft = file.shaft(0.0);
    file.load(shaft, 1.0);
    let names: Vec<String> = (0..COUNT).map(|i| format!("further_{i}")).collect();
    let attributes: Vec<(&str, &str, String)> = names
        .iter()
        .map(|n| (n.as_str(), "mm", "1".to_owned()))
        .collect();
    file.component("gear_casing", &attributes);
    let made = file.read("attributes of one component");
    assert!(made.ledger.not_represented.len() >= COUNT);
}

/// More than 1000 places that are given from each other are no circle.
#[test]
fn chains_of_references() {
    let mut file = File::default();
    for i in 0..COUNT {
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
    file.load(COUNT, 1.0);
    let made = file.read("chains of references");
    let scene = &made.files[0].text;
    assert!(
        scene.contains(&format!("origin_mm = [0.0, {COUNT}.0, 0.0]")),
        "{scene}"
    );
}
