//! Blanks at and near every limit of their keys: each is reduced to a valid compliance, or refused as input.

use crate::small_gears::{self, COARSE, body, difference, reduced, without_symmetry};
use gearmesh_geometry::GearDefinition;
use gearmesh_geometry::input::InputDocument;
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_reduction::{ReductionOptions, Silent, reduce};

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

/// A draw of keys, each inside its range, at a limit or beside it.
struct Draw(fastrand::Rng);

impl Draw {
    fn near(&mut self, low: f64, high: f64) -> f64 {
        let inwards = [0.0, 1e-9, 1e-6, 1e-3, -1e-9, -1e-3][self.0.usize(..6)];
        match self.0.u8(..4) {
            0 => low + inwards,
            1 => high - inwards,
            _ => low + (high - low) * (0.05 + 0.9 * self.0.f64()),
        }
    }

    fn of<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.0.usize(..choices.len())]
    }

    /// A gear file and what kind its blank is.
    fn gear(&mut self) -> String {
        let teeth = self.of(&[8, 10, 12, 15, 18]);
        let helix = self.of(&["", "", "helix_angle_deg = 12.0\nhand = \"left\"\n"]);
        let width = self.near(4.0, 20.0);
        let transverse: f64 = if helix.is_empty() {
            1.0
        } else {
            12f64.to_radians().cos()
        };
        let root = 2.0 * f64::from(teeth) / transverse + 4.0 * (0.3 - 1.25);
        let ring = root - 2.0;
        let blank = match self.0.u8(..5) {
            0 => format!(
                "kind = \"solid\"\nbore_diameter_mm = {:?}\n",
                self.near(0.1 * root, ring)
            ),
            1 => {
                let (a, b) = (
                    self.near(0.1 * root, root - 6.0),
                    self.near(0.1 * root, root - 6.0),
                );
                let ends = self.of(&[[a, 0.0], [0.0, a], [a, a], [a, b]]);
                format!("kind = \"solid\"\nbore_diameter_mm = 0.0\nshaft_diameter_mm = {ends:?}\n")
            }
            2 => {
                let bore = 0.3 * root;
                let outer = self.near(0.25 * root, 0.5 * ring - 0.5);
                let (count, phase) = (self.of(&[1, 2, 3, teeth]), self.near(0.0, 30.0));
                format!(
                    "kind = \"solid\"\nbore_diameter_mm = {bore:?}\n[blank.holes]\ncount = {count}\ndiameter_mm = 1.2\n\
                     pitch_circle_diameter_mm = {:?}\nphase_deg = {phase:?}\n",
                    2.0 * (outer - 0.6)
                )
            }
            _ => {
                let bore = self.near(0.1 * root, 0.4 * root);
                let rim = self.near(bore + 0.5, ring);
                let (hub, web) = (self.near(bore, rim), self.near(0.1 * width, width));
                let offset = self.near(0.0, 0.5 * (width - web));
                format!(
                    "kind = \"thin-rim\"\nbore_diameter_mm = {bore:?}\nhub_diameter_mm = {hub:?}\nrim_inner_diameter_mm = {rim:?}\n\
                     web_thickness_mm = {web:?}\nweb_offset_mm = {offset:?}\n"
                )
            }
        };
        let element = self.of(&["hex8", "hex8-incompatible", "hex20"]);
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
             {more}[blank]\n{blank}"
        )
    }
}

/// No blank ends in a panic, and what is reduced deflects under its loads.
#[test]
fn every_blank_is_reduced_or_refused() {
    let mut draw = Draw(fastrand::Rng::with_seed(7));
    let python = PythonEnvironment::find().unwrap();
    let options = ReductionOptions {
        estimate_error: false,
    };
    let (mut files, mut reduced) = (0, 0);
    while reduced < 8 {
        let text = draw.gear();
        files += 1;
        let Ok(gear) =
            GearDefinition::from_document(&InputDocument::new("drawn.toml", text.clone()))
        else {
            continue;
        };
        match reduce(&gear, &python, options, &Silent) {
            Ok((model, _)) => {
                reduced += 1;
                assert!(model.c_hub.iter().all(|c| c.is_finite()), "{text}");
                // The first load's deflection at itself.
                assert!(model.c_hub[0] > 0.0, "{text}");
            }
            Err(error) => assert!(error.is_input(), "{error}\n{text}"),
        }
    }
    println!("{files} drawn, {reduced} reduced");
    assert!(files < 40, "{files}");
}
