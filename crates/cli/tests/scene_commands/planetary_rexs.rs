//! The REXS file of two planetary stages (helical, spur) and a cylindrical one behind each other.

use std::f64::consts::TAU;

/// Sun, planet, ring, module, helix angle of sun and planets, face, middle of the set along x (mm, deg).
pub(super) struct Stage {
    pub teeth: [i32; 3],
    pub module_mm: f64,
    pub helix_deg: f64,
    pub middle_mm: f64,
}

pub(super) const FACE_MM: f64 = 30.0;
pub(super) const FIRST: Stage = Stage {
    teeth: [21, 24, 69],
    module_mm: 2.0,
    helix_deg: 15.0,
    middle_mm: 145.0,
};
pub(super) const SECOND: Stage = Stage {
    teeth: [20, 19, 58],
    module_mm: 3.0,
    helix_deg: 0.0,
    middle_mm: 275.0,
};
/// Pinion and wheel, module, helix angle (mm, deg).
pub(super) const OUTPUT: ([i32; 2], f64, f64) = ([25, 60], 3.0, 12.0);
/// Torque (N m) and speed (1/min) of the motor.
pub(super) const INPUT: (f64, f64) = (20.0, 3000.0);

#[derive(Default)]
struct Text {
    components: String,
    relations: String,
    count: usize,
}

impl Text {
    fn add(&mut self, id: usize, kind: &str, name: &str, attributes: &[(&str, &str, String)]) {
        self.components += &format!("<component id=\"{id}\" type=\"{kind}\" name=\"{name}\">\n");
        for (key, unit, value) in attributes {
            let cells: Vec<String> = value.split(' ').map(|c| format!("<c>{c}</c>")).collect();
            let value = match &cells[..] {
                [_] => value.clone(),
                _ => format!("<array>{}</array>", cells.concat()),
            };
            self.components +=
                &format!("<attribute id=\"{key}\" unit=\"{unit}\">{value}</attribute>\n");
        }
        self.components += "</component>\n";
    }

    fn join(&mut self, kind: &str, references: &[(usize, &str)]) {
        self.count += 1;
        let references: Vec<String> = { references.iter() }
            .map(|(id, role)| format!("<ref id=\"{id}\" role=\"{role}\"/>"))
            .collect();
        self.relations += &format!(
            "<relation id=\"{}\" type=\"{kind}\">{}</relation>\n",
            self.count,
            references.concat()
        );
    }

    fn part(&mut self, whole: usize, part: usize) {
        self.join("assembly", &[(whole, "assembly"), (part, "part")]);
    }

    fn shaft(
        &mut self,
        id: usize,
        name: &str,
        place: [f64; 3],
        length_mm: f64,
        further: &[(&str, &str, String)],
    ) {
        let place = place.map(|x| format!("{x:?}")).join(" ");
        let mut attributes = vec![
            ("reference_component_for_position", "none", "1".to_owned()),
            ("support_vector", "mm", place),
            ("u_axis_vector", "mm", "1 0 0".to_owned()),
            ("w_axis_vector", "mm", "0 0 1".to_owned()),
        ];
        attributes.extend_from_slice(further);
        self.add(id, "shaft", name, &attributes);
        // Thick where pinion and wheel would bend them, for the same reason.
        let thick = match id {
            12..=14 => "60",
            _ => "30",
        };
        let section = [
            ("length", format!("{length_mm:?}")),
            ("outer_diameter_begin", thick.to_owned()),
            ("outer_diameter_end", thick.to_owned()),
            ("inner_diameter_begin", "0".to_owned()),
            ("inner_diameter_end", "0".to_owned()),
        ];
        self.add(
            id + 1000,
            "shaft_section",
            "",
            &section.map(|(key, value)| (key, "mm", value)),
        );
        self.part(id, id + 1000);
    }

    fn gear(
        &mut self,
        id: usize,
        (kind, name): (&str, &str),
        teeth: i32,
        (module_mm, helix_deg): (f64, f64),
        start_mm: f64,
    ) {
        let values = [
            ("number_of_teeth", "none", format!("{teeth}")),
            ("normal_module", "mm", format!("{module_mm:?}")),
            (
                "helix_angle_reference_diameter",
                "deg",
                format!("{helix_deg:?}"),
            ),
            ("addendum_modification_coefficient", "none", "0".to_owned()),
            ("face_width", "mm", format!("{FACE_MM:?}")),
            ("u_coordinate_on_shaft", "mm", format!("{start_mm:?}")),
        ];
        self.add(id, kind, name, &values);
    }

    /// Both flanks of a gear, with one modification.
    fn modify(&mut self, gear: usize, kind: &str, values: &[(&str, f64)]) {
        let [left, right, modification] = [5000, 6000, 7000].map(|more| gear + more);
        self.join("flank", &[(gear, "gear"), (left, "left"), (right, "right")]);
        let values = values
            .iter()
            .map(|(key, mm)| (*key, "mm", format!("{mm:?}")));
        let values: Vec<(&str, &str, String)> = values.collect();
        self.add(modification, kind, "", &values);
        for flank in [left, right] {
            self.add(flank, "cylindrical_gear_flank", "", &[]);
            self.join(
                "reference",
                &[(flank, "origin"), (modification, "referenced")],
            );
        }
    }

    /// Tip relief of sun and ring of a planetary stage, crowned planets.
    fn modify_set(&mut self, base: usize, stage: &Stage) {
        let [z_s, _, z_r] = stage.teeth;
        let module = stage.module_mm;
        let reference = |z: i32| f64::from(z) * module / stage.helix_deg.to_radians().cos();
        for (gear, start_mm) in [
            (base + 1, reference(z_s) + module),
            (base + 2, -(reference(z_r) - 0.8 * module)),
        ] {
            let values = [
                ("tip_relief_depth", 0.01),
                ("tip_relief_datum_diameter", start_mm),
            ];
            self.modify(gear, "tip_relief", &values);
        }
        for planet in 0..3 {
            let values = [
                ("helix_crowning_amount_datum_face", 0.004),
                ("helix_crowning_amount_non_datum_face", 0.004),
            ];
            self.modify(base + 30 + planet, "helix_crowning", &values);
        }
    }

    fn bearing(&mut self, id: usize, name: &str, sides: [usize; 2], (u_mm, holds): (f64, bool)) {
        // Stiff in the casing: displaced carriers would push suns aside, which statics by hand leave out.
        let stiffness = if sides[1] == 2 { "1e10" } else { "5e8" };
        let support = if holds {
            "both_directions"
        } else {
            "no_direction"
        };
        let values = [
            (
                "u_coordinate_on_shaft_inner_side",
                "mm",
                format!("{u_mm:?}"),
            ),
            ("axial_force_absorption", "none", support.to_owned()),
            ("radial_stiffness", "N / m", stiffness.to_owned()),
            ("axial_stiffness", "N / m", "2e8".to_owned()),
        ];
        self.add(id, "concept_bearing", name, &values);
        self.join(
            "side",
            &[
                (id, "assembly"),
                (sides[0], "inner_part"),
                (sides[1], "outer_part"),
            ],
        );
    }

    /// The parts of a planetary stage from the number `base` on, between the shafts of sun and carrier.
    fn planetary(
        &mut self,
        base: usize,
        stage: &Stage,
        [sun, carrier]: [usize; 2],
        sun_start_mm: f64,
    ) {
        let [z_s, z_p, z_r] = stage.teeth;
        let (module, helix) = (stage.module_mm, stage.helix_deg);
        let start_mm = stage.middle_mm - 0.5 * FACE_MM;
        self.add(base, "planetary_stage", &format!("set {base}"), &[]);
        self.join(
            "central_shaft",
            &[(base, "planetary_stage"), (sun, "shaft")],
        );
        self.join(
            "planet_carrier_shaft",
            &[(base, "planetary_stage"), (carrier, "shaft")],
        );
        self.gear(
            base + 1,
            ("cylindrical_gear", &format!("sun {base}")),
            z_s,
            (module, helix),
            sun_start_mm,
        );
        self.part(sun, base + 1);
        self.gear(
            base + 2,
            ("ring_gear", &format!("ring {base}")),
            -z_r,
            (module, -helix),
            0.0,
        );
        self.shaft(
            base + 3,
            &format!("ring shaft {base}"),
            [start_mm, 0.0, 0.0],
            FACE_MM,
            &[],
        );
        self.part(base + 3, base + 2);
        let distance = 0.5 * module * f64::from(z_s + z_p) / helix.to_radians().cos();
        for planet in 0..3 {
            let [on, pin, own, with_sun, with_ring, first, second] =
                [10, 20, 30, 40, 50, 60, 70].map(|more| base + more + planet);
            let (sin, cos) = (TAU * planet as f64 / 3.0 + 0.4).sin_cos();
            let place = [start_mm, distance * cos, distance * sin];
            self.shaft(on, &format!("planet shaft {on}"), place, FACE_MM, &[]);
            self.shaft(pin, &format!("pin {pin}"), place, FACE_MM, &[]);
            self.join("planet_shaft", &[(base, "planetary_stage"), (on, "shaft")]);
            self.join("planet_pin", &[(base, "planetary_stage"), (pin, "shaft")]);
            self.gear(
                own,
                ("cylindrical_gear", &format!("planet {own}")),
                z_p,
                (module, -helix),
                0.0,
            );
            self.part(on, own);
            for (id, pair) in [(with_sun, [base + 1, own]), (with_ring, [own, base + 2])] {
                self.add(id, "cylindrical_stage", "", &[]);
                self.part(base, id);
                self.join(
                    "stage",
                    &[(pair[0], "gear_1"), (id, "stage"), (pair[1], "gear_2")],
                );
            }
            self.bearing(
                first,
                &format!("planet bearing {first}"),
                [on, pin],
                (7.5, true),
            );
            self.bearing(
                second,
                &format!("planet bearing {second}"),
                [on, pin],
                (22.5, false),
            );
        }
    }
}

/// The file; with the gears of planetary stages modified, or not.
pub(super) fn gearbox(is_modified: bool) -> String {
    let mut text = Text::default();
    text.add(1, "gear_unit", "unit", &[]);
    text.add(2, "gear_casing", "casing", &[]);
    let speed = [
        ("rotational_speed", "1 / min", format!("{:?}", INPUT.1)),
        ("defines_speed", "none", "true".to_owned()),
    ];
    let (teeth, module, helix) = OUTPUT;
    let distance = 0.5 * module * f64::from(teeth[0] + teeth[1]) / helix.to_radians().cos();
    text.shaft(10, "input", [0.0; 3], 170.0, &speed);
    text.shaft(11, "middle", [170.0, 0.0, 0.0], 130.0, &[]);
    text.shaft(12, "carrier shaft", [300.0, 0.0, 0.0], 100.0, &[]);
    text.shaft(14, "pinion shaft", [420.0, 0.0, 0.0], 160.0, &[]);
    text.shaft(13, "output", [420.0, distance, 0.0], 160.0, &[]);
    text.planetary(200, &FIRST, [10, 11], FIRST.middle_mm - 0.5 * FACE_MM);
    text.planetary(
        300,
        &SECOND,
        [11, 12],
        SECOND.middle_mm - 0.5 * FACE_MM - 170.0,
    );
    if is_modified {
        text.modify_set(200, &FIRST);
        text.modify_set(300, &SECOND);
    }
    text.gear(
        20,
        ("cylindrical_gear", "pinion"),
        teeth[0],
        (module, helix),
        65.0,
    );
    text.gear(
        21,
        ("cylindrical_gear", "wheel"),
        teeth[1],
        (module, -helix),
        65.0,
    );
    text.part(14, 20);
    text.part(13, 21);
    text.add(
        22,
        "cylindrical_stage",
        "output stage",
        &[("center_distance", "mm", format!("{distance:?}"))],
    );
    text.join("stage", &[(20, "gear_1"), (22, "stage"), (21, "gear_2")]);
    for (k, (on, places)) in [
        (10, [20.0, 100.0]),
        (11, [20.0, 60.0]),
        (12, [20.0, 80.0]),
        (14, [20.0, 140.0]),
        (13, [20.0, 140.0]),
    ]
    .into_iter()
    .enumerate()
    {
        for (side, place) in places.into_iter().enumerate() {
            let id = 30 + 2 * k + side;
            text.bearing(id, &format!("b{k}{side}"), [on, 2], (place, side == 0));
        }
    }
    // It turns the pinion and lets it bend its own shaft.
    text.add(60, "coupling", "coupling", &[]);
    text.join(
        "side",
        &[(60, "assembly"), (12, "inner_part"), (14, "outer_part")],
    );
    for (id, name, on, place, torque) in [
        (50, "motor", 10, "5", Some(INPUT.0)),
        (51, "machine", 13, "155", None),
    ] {
        let mut values = vec![
            ("u_coordinate_on_shaft", "mm", place.to_owned()),
            ("transmits_torque", "none", "true".to_owned()),
        ];
        values.extend(torque.map(|t| ("torque_around_u_axis", "N m", format!("{t:?}"))));
        text.add(id, "external_load", name, &values);
        text.part(on, id);
    }
    format!(
        "<model version=\"1.7\" applicationId=\"test\" applicationVersion=\"1\" date=\"2026-11-26T12:00:00+00:00\">\n<relations>\n{}</relations>\n\
         <components>\n{}</components>\n</model>\n",
        text.relations, text.components
    )
}
