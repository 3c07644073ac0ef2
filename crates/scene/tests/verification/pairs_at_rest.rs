//! Scenes of a `[pair]` against static runs of the same gears as bodies: errors and faults, eccentricity, axes that
//! lean.

use std::path::Path;

use gearmesh_contact::LocalContact;
use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{Flank, GearPair};
use gearmesh_model::{read_reduced_gear, write_reduced_gear};
use gearmesh_scene::system_run::RunJob;
use gearmesh_scene::{Scene, SceneResult, load as load_pair, run};

use crate::common::load;
use crate::made_up_gears::pair_common::ring_pair;
use crate::made_up_gears::{pair, with_bore, write_models, write_planet_and_ring};
use crate::system_runs::Desk;

/// How far gear 2 stands behind at the start, so that teeth press on each other \[m\].
const BEHIND_M: f64 = 20e-6;
const POINTS: usize = 12;
const PITCHES: usize = 5;

/// Which gears, gear 1 first.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Gears {
    External,
    /// A planet of this helix angle \[deg\] drives its ring.
    PlanetInRing(f64),
    RingAroundPlanet(f64),
}

const SPUR_GEARS: [Gears; 3] = [
    Gears::External,
    Gears::PlanetInRing(0.0),
    Gears::RingAroundPlanet(0.0),
];

impl Gears {
    fn pair(self) -> GearPair {
        match self {
            Self::External => pair(),
            Self::PlanetInRing(helix_deg) => ring_pair(helix_deg, false),
            Self::RingAroundPlanet(helix_deg) => ring_pair(helix_deg, true),
        }
    }

    fn write(self, folder: &Path) {
        match self {
            Self::External => write_models(folder),
            Self::PlanetInRing(helix_deg) | Self::RingAroundPlanet(helix_deg) => {
                write_planet_and_ring(folder, helix_deg);
            }
        }
    }
}

/// Gear 1 turns clockwise on right flanks, counter-clockwise on left ones.
struct Twin {
    gears: Gears,
    flank: Flank,
    torque_nm: f64,
    /// Keys that both kinds of scene have.
    effects: &'static str,
    /// How the bore of gear 1 is held, where that is stated.
    bore: &'static str,
}

impl Twin {
    fn at_rest(&self, folder: &Path) -> SceneResult {
        let Self {
            gears,
            flank,
            torque_nm,
            effects,
            bore,
        } = self;
        let pair = gears.pair();
        let bore = match bore.is_empty() {
            true => String::new(),
            false => format!("[gear_1]\nbore = \"{bore}\"\n"),
        };
        let text = format!(
            "title = \"at rest\"\n[pair]\ngear_1 = \"gear_{}.h5\"\ngear_2 = \"gear_{}.h5\"\ncentre_distance_mm = {:?}\nflank = \"{}\"\n\
             [run]\ntorques_Nm = [{torque_nm:?}]\npitches = {PITCHES}\npoints_per_pitch = {POINTS}\n\
             [mesh]\nmodel.kind = \"hybrid\"\nmodel.local = \"weber-banaschek\"\nteeth.path = \"line-of-action\"\n{effects}\n{bore}",
            pair.gear_1.teeth,
            pair.gear_2.teeth,
            1e3 * pair.centre_distance_m,
            flank.name(),
        );
        let scene = Scene::from_document(InputDocument::new("pair.toml", text), folder).unwrap();
        assert_eq!(scene.contact.local, LocalContact::WeberBanaschek);
        run(&load_pair(scene).unwrap(), &|_, _| ()).unwrap()
    }

    /// The transmission error from the turns of the bodies.
    fn as_bodies(&self, folder: &Path) -> Vec<f64> {
        let pair = self.gears.pair().on_flanks(self.flank);
        let hand = self.flank.mirror();
        // A ring and the gear inside turn the same way.
        let way = if pair.has_ring() { -1.0 } else { 1.0 };
        let [base_1, base_2] = [&pair.gear_1, &pair.gear_2].map(|gear| gear.base_radius_m);
        let starts = pair.tooth_middles_rad((pair.centre_distance_m, [0.0, -BEHIND_M / base_2]));
        let step_deg = 360.0 / (pair.gear_1.teeth * POINTS) as f64;
        let angles: Vec<String> = (0..POINTS * PITCHES)
            .map(|k| format!("{:?}", -hand * step_deg * k as f64))
            .collect();
        let bore = match self.bore.is_empty() {
            true => String::new(),
            false => format!("bore = \"{}\"\n", self.bore),
        };
        let text = format!(
            "title = \"bodies\"\n[run]\nkind = \"static\"\nmotion = \"drive\"\nangles_deg = [{}]\n\
             [[body]]\nname = \"pinion\"\ngear = \"gear_{}.h5\"\n{bore}cardan_deg = [0.0, 0.0, {:?}]\n\
             [[body]]\nname = \"wheel\"\ngear = \"gear_{}.h5\"\nposition_mm = [{:?}, 0.0, 0.0]\ncardan_deg = [0.0, 0.0, {:?}]\n\
             [[joint]]\nname = \"axle 1\"\nkind = \"revolute\"\nbody_2 = \"pinion\"\n\
             [[joint]]\nname = \"axle 2\"\nkind = \"revolute\"\nbody_2 = \"wheel\"\n\
             [[motion]]\nname = \"drive\"\njoint = \"axle 1\"\nangle_deg = 0.0\n\
             [[load]]\nbody = \"wheel\"\ntorque_Nm = {:?}\n\
             [[gear_mesh]]\nname = \"mesh\"\ngear_1 = \"pinion\"\ngear_2 = \"wheel\"\nmodel.kind = \"hybrid\"\nmodel.local = \"weber-banaschek\"\n\
             teeth.flanks = \"{}\"\nteeth.path = \"line-of-action\"\n{}\n",
            angles.join(", "),
            pair.gear_1.teeth,
            starts[0].to_degrees(),
            pair.gear_2.teeth,
            1e3 * pair.centre_distance_m,
            starts[1].to_degrees(),
            -hand * way * self.torque_nm,
            self.flank.name(),
            self.effects
        );
        let result = Desk::new().run(RunJob::from_scene(load(&text, folder).unwrap()).unwrap());
        let turns = |body: &str| {
            result
                .rows
                .read(&format!("bodies/{body}/turn_rad"))
                .unwrap()
        };
        let [first, second] = [turns("pinion"), turns("wheel")];
        let moved = first.iter().zip(&second);
        let turned_m: Vec<f64> = moved
            .map(|(one, two)| hand * (way * base_2 * two + base_1 * one) - BEHIND_M)
            .collect();
        // What the mesh tells is that of the turns, with runout and wobble in it.
        let told_m = (result.rows).read("elements/mesh/transmission_error_m");
        for (told, turned) in told_m.unwrap().iter().zip(&turned_m) {
            assert!((told - turned).abs() < 1e-10, "{told:e} m, {turned:e} m");
        }
        turned_m
    }

    /// Largest difference of the transmission errors, and how far the effects move them \[m\].
    fn difference(&self) -> (f64, f64) {
        let folder = tempfile::tempdir().unwrap();
        self.gears.write(folder.path());
        if !self.bore.is_empty() {
            give_a_bore(folder.path(), self.gears.pair().gear_1.teeth);
        }
        std::fs::write(
            folder.path().join("lead.csv"),
            "z_mm,removed_um\n-10,0\n10,6\n",
        )
        .unwrap();
        let at_rest = self.at_rest(folder.path());
        let bodies = self.as_bodies(folder.path());
        let ideal = Self {
            effects: "",
            bore: "",
            ..*self
        }
        .at_rest(folder.path());
        let worst = |a: &[f64], b: &[f64]| {
            assert_eq!(a.len(), b.len());
            (a.iter().zip(b)).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()))
        };
        (
            worst(&at_rest.te_m, &bodies),
            worst(&at_rest.te_m, &ideal.te_m),
        )
    }

    fn agrees(&self, tolerance_m: f64, least_effect_m: f64) {
        let (difference, effect) = self.difference();
        assert!(effect > least_effect_m, "{:?}: {effect:e}", self.gears);
        let gears = self.gears;
        assert!(
            difference < tolerance_m,
            "{gears:?}: {difference:e} m of {effect:e} m"
        );
    }
}

/// Gives a model a bore whose motions move all flanks.
fn give_a_bore(folder: &Path, teeth: usize) {
    let path = folder.join(format!("gear_{teeth}.h5"));
    let gear = with_bore(read_reduced_gear(&path).unwrap(), 1e10, 5.0);
    write_reduced_gear(&path, &gear).unwrap();
}

/// A bore that slides makes the gear softer than a bonded one, by as much as in a scene of bodies; without its motions,
/// or on rollers, of which a pair has none, it is refused.
#[test]
fn a_bore_that_slides_is_that_of_the_bodies() {
    for gears in [Gears::External, Gears::PlanetInRing(0.0)] {
        let twin = Twin {
            gears,
            flank: Flank::Right,
            torque_nm: 2.0,
            effects: "",
            bore: "sliding",
        };
        twin.agrees(1e-10, 5e-7);
    }
    let folder = tempfile::tempdir().unwrap();
    write_models(folder.path());
    let refused = |bore: &str| {
        let text = format!(
            "title = \"at rest\"\n[pair]\ngear_1 = \"gear_30.h5\"\ngear_2 = \"gear_41.h5\"\ncentre_distance_mm = 106.8\n\
             [gear_2]\nbore = \"{bore}\"\n[run]\ntorques_Nm = [1.0]\npitches = 1\npoints_per_pitch = 4\n[mesh]\nmodel.kind = \"hybrid\"\n"
        );
        let scene = Scene::from_document(InputDocument::new("pair.toml", text), folder.path());
        match scene {
            Ok(scene) => load_pair(scene).map(|_| ()).unwrap_err().to_string(),
            Err(error) => error.to_string(),
        }
    };
    for (bore, expected) in [
        ("sliding", ["pair.toml:7: gear_2.bore", "[reduction.bore]"]),
        (
            "rollers",
            ["pair.toml:7: gear_2.bore", "a pair has no bearing"],
        ),
    ] {
        let message = refused(bore);
        for words in expected {
            assert!(message.contains(words), "{words}: {message}");
        }
    }
}

fn pitch(side: &str, teeth: usize, seed: usize) -> String {
    let values: Vec<String> = (0..teeth)
        .map(|k| format!("{:?}", ((k * 7 + seed) % 11) as f64))
        .collect();
    format!(
        "{{ kind = \"pitch\", side = \"{side}\", removed_um = [{}] }}",
        values.join(", ")
    )
}

/// Tooth by tooth, on both gears and on either flank.
#[test]
fn pitch_errors_are_those_of_the_bodies() {
    let both = SPUR_GEARS
        .into_iter()
        .flat_map(|gears| [Flank::Right, Flank::Left].map(|flank| (gears, flank)));
    for (gears, flank) in both {
        let pair = gears.pair().on_flanks(flank);
        let errors = format!(
            "teeth.errors_1 = [{}]\nteeth.errors_2 = [{}]",
            pitch(flank.name(), pair.gear_1.teeth, 0),
            pitch(pair.flank_of(1).name(), pair.gear_2.teeth, 5)
        );
        Twin {
            bore: "",
            gears,
            flank,
            torque_nm: 2.0,
            effects: errors.leak(),
        }
        .agrees(1e-9, 5e-6);
    }
}

/// Contact lines slant over both flanks, either gear driving. At rest a slice ends where rigid flanks do, as bodies
/// where the loaded gear 2 stands: what is left is of second order in the load, a hundredth at a tenth of it (twice
/// that is allowed), and at 100 N·m on the ring of the size that faults are allowed there.
#[test]
fn helical_teeth_in_a_ring_are_those_of_the_bodies() {
    for (gears, flank) in [
        (Gears::PlanetInRing(15.0), Flank::Right),
        (Gears::PlanetInRing(-15.0), Flank::Left),
        (Gears::RingAroundPlanet(15.0), Flank::Left),
        (Gears::RingAroundPlanet(-15.0), Flank::Right),
    ] {
        // The same forces on the teeth, whichever gear is loaded.
        let base_m = [gears.pair().gear_1, gears.pair().gear_2].map(|gear| gear.base_radius_m);
        let lever = base_m[1] / base_m[0].max(base_m[1]);
        let [small, large] = [10.0, 100.0].map(|on_ring_nm| {
            let twin = Twin {
                bore: "",
                gears,
                flank,
                torque_nm: on_ring_nm * lever,
                effects: "",
            };
            twin.difference().0
        });
        assert!(large < 1e-8, "{gears:?}: {large:e} m");
        assert!(
            small < 0.02 * large + 1e-12,
            "{gears:?}: {small:e} {large:e}"
        );
    }
}

/// The bodies' mesh turns the normals where the depth has a slope, which moves lever arms; at a small load that moves
/// little.
#[test]
fn faults_are_those_of_the_bodies() {
    for (effects, least_effects_m) in [
        (
            "teeth.errors_1 = [{ kind = \"deviation\", lead = \"lead.csv\" }]",
            [5e-7, 2e-6],
        ),
        (
            "teeth.errors_1 = [{ kind = \"spall\", tooth = 1, side = \"right\", radii_mm = [44.5, 47.5], z_mm = [-10.0, 10.0], depth_um = 8.0, \
             edge_deg = 2.0 }]",
            [5e-6, 5e-6],
        ),
        (
            "teeth.errors_2 = [{ kind = \"tip-chip\", tooth = 39, end = \"+z\", height_mm = 2.0, length_mm = 12.0 }]",
            [1e-8, 3e-7],
        ),
        (
            "teeth.errors_2 = [{ kind = \"broken-tooth\", tooth = 38, above_radius_mm = 63.5 }]",
            [3e-8, 1e-6],
        ),
    ] {
        for (torque_nm, tolerance_m, least_m) in [
            (2.0, 1e-10, least_effects_m[0]),
            (100.0, 1e-8, least_effects_m[1]),
        ] {
            Twin {
                bore: "",
                gears: Gears::External,
                flank: Flank::Right,
                torque_nm,
                effects,
            }
            .agrees(tolerance_m, least_m);
        }
    }
}

/// Exact for offsets; what is left of tilts is of second order.
#[test]
fn eccentricity_is_that_of_the_bodies() {
    let both = [Gears::External, Gears::PlanetInRing(0.0)]
        .into_iter()
        .flat_map(|gears| [Flank::Right, Flank::Left].map(|flank| (gears, flank)));
    for (gears, flank) in both {
        let twin = |effects| Twin {
            bore: "",
            gears,
            flank,
            torque_nm: 2.0,
            effects,
        };
        twin(
            "teeth.eccentricity_1 = { offset_um = 40.0, direction_deg = 70.0 }\n\
             teeth.eccentricity_2 = { offset_um = 30.0, direction_deg = 200.0 }",
        )
        .agrees(5e-11, 1e-5);
        let tilts = [
            "teeth.eccentricity_1 = { tilt_mrad = 0.25, tilt_direction_deg = 20.0 }\n\
             teeth.eccentricity_2 = { tilt_mrad = 0.25, tilt_direction_deg = 30.0 }",
            "teeth.eccentricity_1 = { tilt_mrad = 0.5, tilt_direction_deg = 20.0 }\n\
             teeth.eccentricity_2 = { tilt_mrad = 0.5, tilt_direction_deg = 30.0 }",
        ];
        let [(small, _), (large, effect)] = tilts.map(|effects| twin(effects).difference());
        // r_b2 t^2/2, both axes leaning by t/2.
        let second_order_m = 0.5 * gears.pair().gear_2.base_radius_m * 1e-3_f64.powi(2);
        assert!(
            effect > 1e-6 && large < second_order_m,
            "{gears:?}: {large:e} m of {effect:e} m"
        );
        assert!(small < 0.35 * large, "{gears:?}: {small:e} {large:e}");
    }
}

/// Of a pair as of a gear mesh.
#[test]
fn the_path_is_extended_where_nothing_is_said() {
    let folder = tempfile::tempdir().unwrap();
    write_models(folder.path());
    let plan = |path: &str| {
        let text = format!(
            "title = \"path\"\n[pair]\ngear_1 = \"gear_30.h5\"\ngear_2 = \"gear_41.h5\"\ncentre_distance_mm = 106.8\n\
             [run]\ntorques_Nm = [100.0]\npitches = 1\npoints_per_pitch = 24\n[mesh]\nmodel.kind = \"hybrid\"\nmodel.local = \"weber-banaschek\"\n{path}\n"
        );
        let scene =
            Scene::from_document(InputDocument::new("p.toml", text), folder.path()).unwrap();
        let loaded = load_pair(scene).unwrap();
        let te = run(&loaded, &|_, _| ()).unwrap().te_m;
        (loaded.plan().lines.join("\n"), te)
    };
    let (told, open) = plan("");
    assert!(
        told.contains("path `extended` with a tip edge radius of 100 um"),
        "{told}"
    );
    assert_eq!(open, plan("teeth.path = \"extended\"").1);
    let (told, rigid) = plan("teeth.path = \"line-of-action\"");
    assert!(told.contains("path `line-of-action`"), "{told}");
    assert_ne!(open, rigid);
    assert!(
        plan("teeth.edge_radius_um = 50.0")
            .0
            .contains("radius of 50 um")
    );
}

/// One faulty tooth, or an axis beside the body's: the gear repeats after a revolution only. A deviation of all teeth
/// leaves the period of one pitch.
#[test]
fn errors_of_single_teeth_set_the_period() {
    let folder = tempfile::tempdir().unwrap();
    write_models(folder.path());
    std::fs::write(
        folder.path().join("lead.csv"),
        "z_mm,removed_um\n-10,0\n10,6\n",
    )
    .unwrap();
    let periods = |effects: &str| {
        let text = format!(
            "title = \"periods\"\n[pair]\ngear_1 = \"gear_30.h5\"\ngear_2 = \"gear_41.h5\"\ncentre_distance_mm = 106.8\n\
             [run]\ntorques_Nm = [100.0]\npitches = 1\npoints_per_pitch = 4\n[mesh]\nmodel.kind = \"hybrid\"\nmodel.local = \"weber-banaschek\"\n{effects}\n"
        );
        let scene =
            Scene::from_document(InputDocument::new("p.toml", text), folder.path()).unwrap();
        load_pair(scene).unwrap().periods.contact()
    };
    assert_eq!(
        periods("teeth.errors_1 = [{ kind = \"deviation\", lead = \"lead.csv\" }]"),
        periods("")
    );
    let broken = "[{ kind = \"broken-tooth\", tooth = 3, above_radius_mm = 47.0 }]";
    assert_eq!(periods(&format!("teeth.errors_1 = {broken}")) % 30, 0);
    assert_eq!(
        periods("teeth.eccentricity_2 = { offset_um = 10.0 }") % 41,
        0
    );
}
