//! Blanks at and near every limit of their keys: each is reduced to a valid compliance, or refused as input.

use crate::small_gears::{self, COARSE, body, difference, reduced, without_symmetry};
use gearmesh_geometry::GearDefinition;
use gearmesh_geometry::input::InputDocument;
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_reduction::{MemoryEstimate, OfflineJob, ReductionOptions, Silent, reduce};
use std::panic::catch_unwind;
use std::time::Instant;

/// Root diameter of [`small_gears::gear`]: 54 + 2 · 3 · (0.1 − 1.25) mm.
const ROOT_MM: f64 = 47.1;

/// As thick as the shaft may be its outline lay on the ring below the teeth: the ring's nodes were held, and the teeth
/// lost them.
#[test]
fn a_shaft_as_thick_as_allowed_carries_the_teeth() {
    let most = ROOT_MM - 9.0;
    for ends in [[most, 0.0], [most - 1e-3, most]] {
        let blank = format!(
            "[blank]\nkind = \"solid\"\nbore_diameter_mm = 0.0\nshaft_diameter_mm = {ends:?}\n"
        );
        let gear = small_gears::gear(COARSE, &blank, 0.0);
        let (model, _) = reduced(&gear, false);
        let (whole, _) = reduced(&without_symmetry(&gear), false);
        let found = difference(&whole.c_hub, &model.c_hub);
        assert!(found < 1e-9, "{ends:?}: {found:e}");
    }
}

/// A body whose regions are thinner than elements are long: the lines of a free mesh would cut the next circle.
#[test]
fn thin_rings_are_paved_in_rows() {
    for (bore, hub, rim) in [(14.0, 14.2, 38.0), (14.0, 14.06, 14.12)] {
        let blank = format!(
            "[blank]\nkind = \"thin-rim\"\nbore_diameter_mm = {bore}\nhub_diameter_mm = {hub}\nrim_inner_diameter_mm = {rim}\n\
             web_thickness_mm = 4.0\n"
        );
        let gear = small_gears::gear(COARSE, &blank, 0.0);
        let (model, _) = reduced(&gear, false);
        let (whole, _) = reduced(&without_symmetry(&gear), false);
        let found = difference(&whole.c_hub, &model.c_hub);
        assert!(found < 1e-9, "{hub} {rim}: {found:e}");
    }
}

/// Holes that reach as far out as allowed are in the mesh: it is smaller by their area. Beyond the ring below the teeth
/// they were lost.
#[test]
fn no_opening_is_lost() {
    let area = |blank: &str| {
        let section = body(&small_gears::gear(COARSE, blank, 0.0)).mesh.section;
        let cross = |[a, b]: [[f64; 2]; 2]| 0.5 * (a[0] * b[1] - a[1] * b[0]);
        let of_quad = |quad: &[usize; 4]| -> f64 {
            let p = quad.map(|n| section.nodes[n]);
            (0..4).map(|k| cross([p[k], p[(k + 1) % 4]])).sum()
        };
        section.quads.iter().map(of_quad).sum::<f64>()
    };
    let solid = area(small_gears::SOLID);
    // Allowed is a quarter of a module inside the root diameter less one module.
    for (outer, count) in [(0.5 * (ROOT_MM - 3.0) - 0.75, 3), (19.5, 6), (17.0, 3)] {
        let holes = format!(
            "{}holes = {{ count = {count}, diameter_mm = 6.0, pitch_circle_diameter_mm = {}, phase_deg = 10.0 }}\n",
            small_gears::SOLID,
            2.0 * (outer - 3.0)
        );
        let lost = (solid - area(&holes)) * 1e6 / (f64::from(count) * 9.0 * std::f64::consts::PI);
        // Polygons of 40 corners and less take the place of circles.
        assert!((lost - 1.0).abs() < 0.05, "{outer}: {lost}");
    }
}

/// Walls of less than a thousandth of a module, and webs that would take gmsh hours, are refused by their key at once.
#[test]
fn what_is_too_thin_is_refused_by_key() {
    let thin_rim = |hub: f64, web: f64, more: &str| {
        format!(
            "[blank]\nkind = \"thin-rim\"\nbore_diameter_mm = 14.0\nhub_diameter_mm = {hub:?}\nrim_inner_diameter_mm = 38.0\n\
             web_thickness_mm = {web:?}\n{more}"
        )
    };
    let read = |mesh: &str, blank: &str| {
        let text = small_gears::gear(mesh, small_gears::SOLID, 0.0).source;
        let text = text.replace(small_gears::SOLID, blank);
        GearDefinition::from_document(&InputDocument::new("thin.toml", text))
    };
    for (hub, web, more, key) in [
        (14.0 + 5.9e-3, 4.0, "", "blank.hub_diameter_mm"),
        (20.0, 2.9e-3, "", "blank.web_thickness_mm"),
        (38.0 - 5.9e-3, 4.0, "", "blank.rim_inner_diameter_mm"),
        (20.0, 12.0 - 1e-4, "", "blank.web_thickness_mm"),
    ] {
        let refused = read(COARSE, &thin_rim(hub, web, more)).unwrap_err();
        assert!(refused.to_string().contains(key), "{refused}");
    }
    let tetrahedra = read(small_gears::TETRAHEDRA, &thin_rim(20.0, 0.01, "")).unwrap();
    let python = PythonEnvironment::find().unwrap();
    let options = ReductionOptions {
        estimate_error: false,
    };
    let clock = Instant::now();
    let refused = reduce(&tetrahedra, &python, options, &Silent)
        .err()
        .unwrap();
    assert!(refused.is_input(), "{refused}");
    let text = refused.to_string();
    assert!(text.starts_with("blank.web_thickness_mm"), "{text}");
    assert!(clock.elapsed().as_secs() < 60, "{:?}", clock.elapsed());
}

/// A draw of keys, each inside its range, at a limit or beside it.
struct Draw(fastrand::Rng);

/// What a drawn blank must fit (mm).
struct Room {
    root: f64,
    /// Below the root half a module stays.
    ring: f64,
    width: f64,
    teeth: u32,
}

impl Draw {
    /// Between two limits, at one of them, or beside it by anything from a millionth of a micrometre to a tenth of a
    /// millimetre.
    fn near(&mut self, low: f64, high: f64) -> f64 {
        let beside = 10f64.powf(self.0.f64() * 8.0 - 9.0);
        let inwards = self.of(&[0.0, beside, beside, -beside, -1e-9, -1e-3]);
        match self.0.u8(..4) {
            0 => low + inwards,
            1 => high - inwards,
            _ => low + (high - low) * (0.05 + 0.9 * self.0.f64()),
        }
    }

    fn of<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.0.usize(..choices.len())]
    }

    fn solid(&mut self, room: &Room) -> String {
        let bore = self.near(0.1 * room.root, room.ring);
        format!("[blank]\nkind = \"solid\"\nbore_diameter_mm = {bore:?}\n")
    }

    fn shaft(&mut self, room: &Room) -> String {
        let (a, b) = (
            self.near(0.1 * room.root, room.root - 6.0),
            self.near(0.1 * room.root, room.root - 6.0),
        );
        let beside = self.near(a, a + 1.0);
        let ends = self.of(&[[a, 0.0], [0.0, a], [a, a], [a, b], [a, beside]]);
        format!("[blank]\nkind = \"solid\"\nbore_diameter_mm = 0.0\nshaft_diameter_mm = {ends:?}\n")
    }

    fn thin_rim(&mut self, room: &Room) -> String {
        let bore = self.near(0.1 * room.root, 0.4 * room.root);
        let rim = self.near(bore + 0.5, room.ring);
        let (hub, thinnest) = (self.near(bore, rim), self.of(&[0.0, 0.1]) * room.width);
        let web = self.near(thinnest, room.width);
        let offset = self.near(0.0, 0.5 * (room.width - web));
        format!(
            "[blank]\nkind = \"thin-rim\"\nbore_diameter_mm = {bore:?}\nhub_diameter_mm = {hub:?}\nrim_inner_diameter_mm = {rim:?}\n\
             web_thickness_mm = {web:?}\nweb_offset_mm = {offset:?}\n"
        )
    }

    fn contour(&mut self, room: &Room) -> String {
        let bore = self.near(0.1 * room.root, 0.4 * room.root);
        let rim = self.near(bore + 2.0, room.ring);
        let hub = self.near(bore, rim);
        let between = self.near(hub, rim);
        let half = 0.5 * room.width;
        let mut text = String::new();
        let mut outmost = half;
        let diameters = self.of(&[[hub, between, rim], [hub, hub, rim], [hub, rim, rim]]);
        for diameter in diameters {
            let (back, fillet) = (self.near(-half, 0.4 * half), self.near(0.0, 1.0));
            let front = self.near(back, half);
            outmost = outmost.max(front).max(-back);
            let fillet = self.of(&[0.0, 0.0, fillet]);
            text += &format!(
                "[[blank.web]]\ndiameter_mm = {diameter:?}\nz_mm = [{back:?}, {front:?}]\nfillet_radius_mm = {fillet:?}\n"
            );
        }
        let hub_z = self.near(outmost, 1.5 * outmost);
        format!(
            "[blank]\nkind = \"contour\"\nbore_diameter_mm = {bore:?}\nhub_z_mm = {:?}\n{text}",
            [-hub_z, hub_z]
        )
    }

    /// Holes or slots between two diameters.
    fn openings(&mut self, [inner, outer]: [f64; 2], teeth: u32) -> String {
        // Keep a quarter of a module of two millimetres clear of both.
        let (low, high) = (0.5 * inner + 0.5, 0.5 * outer - 0.5);
        let (count, phase) = (self.of(&[1, 2, 3, teeth]), self.near(0.0, 30.0));
        let (bottom, least) = (self.near(low, high), self.of(&[0.0, 0.3]));
        let height = self.near(least, high - low);
        if self.0.bool() {
            let centre = 2.0 * bottom + height;
            return format!(
                "[blank.holes]\ncount = {count}\ndiameter_mm = {height:?}\npitch_circle_diameter_mm = {centre:?}\nphase_deg = {phase:?}\n"
            );
        }
        let most = 360.0 / f64::from(count) - (2.0 / bottom).to_degrees();
        let narrowest = self.of(&[0.0, 0.2 * most]);
        let width = self.near(narrowest, most);
        let corner = self.near(0.0, 0.45 * height.min(bottom * width.to_radians()));
        format!(
            "[blank.slots]\ncount = {count}\ninner_radius_mm = {bottom:?}\nouter_radius_mm = {:?}\nwidth_deg = {width:?}\n\
             phase_deg = {phase:?}\ncorner_radius_mm = {corner:?}\n",
            bottom + height
        )
    }

    fn blank(&mut self, room: &Room) -> String {
        let bore = 0.3 * room.root;
        match self.0.u8(..7) {
            0 => self.solid(room),
            1 => self.shaft(room),
            2 => {
                let openings = self.openings([bore, room.ring], room.teeth);
                format!("[blank]\nkind = \"solid\"\nbore_diameter_mm = {bore:?}\n{openings}")
            }
            3 => {
                let (hub, rim) = (1.2 * bore, self.near(2.0 * bore, room.ring));
                let (web, openings) = (0.5 * room.width, self.openings([hub, rim], room.teeth));
                format!(
                    "[blank]\nkind = \"thin-rim\"\nbore_diameter_mm = {bore:?}\nhub_diameter_mm = {hub:?}\n\
                     rim_inner_diameter_mm = {rim:?}\nweb_thickness_mm = {web:?}\n{openings}"
                )
            }
            4 => self.contour(room),
            _ => self.thin_rim(room),
        }
    }

    /// A gear file.
    fn gear(&mut self) -> String {
        let teeth: u32 = self.of(&[8, 10, 12, 15, 18]);
        let helix = self.of(&["", "", "helix_angle_deg = 12.0\nhand = \"left\"\n"]);
        let width = self.near(4.0, 20.0);
        let transverse: f64 = if helix.is_empty() {
            1.0
        } else {
            12f64.to_radians().cos()
        };
        let root = 2.0 * f64::from(teeth) / transverse + 4.0 * (0.3 - 1.25);
        let blank = self.blank(&Room {
            root,
            ring: root - 2.0,
            width,
            teeth,
        });
        let element = self.of(&["hex8", "hex8-incompatible", "hex20", "tet10"]);
        let (flank, fillet) = (self.near(1.2, 2.0), self.near(0.3, 0.7));
        let (long, axial) = (self.near(3.0, 20.0), self.near(0.25 * width, width));
        let crack = format!(
            "[crack]\ntooth = 0\nside = \"right\"\ndepth_mm = {:?}\n",
            self.near(0.2, 2.0)
        );
        let gauge = format!(
            "[[gauge]]\nname = \"g\"\ntooth = 1\nside = \"left\"\nlength_mm = {:?}\nwidth_mm = {width:?}\n",
            self.near(0.3, 2.0)
        );
        let more = self
            .of(&[
                "",
                "",
                &crack,
                &gauge,
                "[hub]\nsupport = \"reference-point\"\n",
            ])
            .to_owned();
        format!(
            "name = \"drawn\"\n[tooth]\nteeth = {teeth}\nmodule_mm = 2.0\nprofile_shift = 0.3\naddendum = 0.8\nface_width_mm = {width:?}\n{helix}\
             [material]\nyoung_GPa = 210.0\npoisson = 0.3\ndensity_kg_per_m3 = 7850.0\n\
             [reduction]\nroll_stations = 3\nslices = 1\nflanks = [\"right\"]\n\
             [mesh]\nelement = \"{element}\"\nflank_mm = {flank:?}\nfillet_mm = {fillet:?}\nbody_mm = {long:?}\naxial_mm = {axial:?}\n\
             {more}{blank}"
        )
    }
}

/// What became of a drawn gear.
enum Outcome {
    /// Refused by the key that the message names.
    RefusedByKey(String),
    /// Refused as input when its mesh was made or held.
    RefusedLater(String),
    Reduced,
}

/// Reduces a drawn gear.
///
/// # Errors
/// What is wrong: a failure that is not the input's, or a compliance that is none.
fn outcome(text: &str, python: &PythonEnvironment) -> Result<Outcome, String> {
    let options = ReductionOptions {
        estimate_error: false,
    };
    let gear = match GearDefinition::from_document(&InputDocument::new("drawn.toml", text)) {
        Ok(gear) => gear,
        Err(error) => return Ok(Outcome::RefusedByKey(error.to_string())),
    };
    if let Some(estimate) = MemoryEstimate::new(&gear, OfflineJob::Reduction)
        && !(estimate.bytes > 0.0 && estimate.bytes.is_finite())
    {
        return Err(format!("{} bytes of memory are announced", estimate.bytes));
    }
    match reduce(&gear, python, options, &Silent) {
        Ok((model, _)) => {
            // The first load's deflection at itself.
            let deflects = model.c_hub.iter().all(|c| c.is_finite()) && model.c_hub[0] > 0.0;
            if deflects {
                Ok(Outcome::Reduced)
            } else {
                Err(format!(
                    "the first load deflects itself by {}",
                    model.c_hub[0]
                ))
            }
        }
        Err(error) if error.is_input() => Ok(Outcome::RefusedLater(error.to_string())),
        Err(error) => Err(error.to_string()),
    }
}

/// No blank ends in a panic, and what is reduced deflects under its loads.
#[test]
fn every_blank_is_reduced_or_refused() {
    let mut draw = Draw(fastrand::Rng::with_seed(7));
    let python = PythonEnvironment::find().unwrap();
    let (mut files, mut reduced) = (0, 0);
    while reduced < 4 {
        let text = draw.gear();
        files += 1;
        let found = outcome(&text, &python).unwrap_or_else(|error| panic!("{error}\n{text}"));
        reduced += usize::from(matches!(found, Outcome::Reduced));
    }
    println!("{files} drawn, {reduced} reduced");
    assert!(files < 30, "{files}");
}

/// The same of as many as are asked for:
/// `BLANKS=1000 BLANKS_FIRST=1 cargo test --workspace --test verification -- --ignored --nocapture many_blanks`. Each
/// is drawn from a seed of its own, `BLANKS_FIRST` and those that follow, which the lines name, so that any of them can
/// be drawn again alone. Another thousand begins at 1001. `BLANKS_FOLDER` keeps the files of those that failed.
#[test]
#[ignore = "some seconds a blank"]
fn many_blanks_are_reduced_or_refused() {
    let number = |name: &str, default: u64| {
        let given = std::env::var(name).ok();
        given.map_or(default, |text| text.parse().unwrap())
    };
    let (first, count) = (number("BLANKS_FIRST", 1), number("BLANKS", 40));
    let python = PythonEnvironment::find().unwrap();
    let (mut reduced, mut by_key, mut later, mut failed) = (0, 0, 0, 0);
    for seed in first..first + count {
        let text = Draw(fastrand::Rng::with_seed(seed)).gear();
        let clock = Instant::now();
        let found = catch_unwind(|| outcome(&text, &python));
        let seconds = clock.elapsed().as_secs_f64();
        let (what, message) = match found {
            Ok(Ok(Outcome::Reduced)) => (&mut reduced, "reduced".to_owned()),
            Ok(Ok(Outcome::RefusedByKey(why))) => (&mut by_key, why),
            Ok(Ok(Outcome::RefusedLater(why))) => (&mut later, format!("later: {why}")),
            Ok(Err(why)) => (&mut failed, format!("FAILED: {why}")),
            Err(_) => (&mut failed, "FAILED: panic".to_owned()),
        };
        *what += 1;
        println!("{seed}: {seconds:.1} s: {}", message.replace('\n', " "));
        if let Ok(folder) = std::env::var("BLANKS_FOLDER")
            && message.starts_with("FAILED")
        {
            std::fs::write(format!("{folder}/{seed}.toml"), &text).unwrap();
        }
    }
    println!(
        "{count} drawn: {reduced} reduced, {by_key} refused by key, {later} refused when meshed or held, {failed} failed"
    );
    assert_eq!(failed, 0);
}
