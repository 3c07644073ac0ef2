//! Optimisation against Harris's law, whose optimum is known in closed form, and what is refused.
//!
//! S. L. Harris, Dynamic loads on the teeth of spur gears, Proc. IMechE 172 (1958) 87-112: with constant stiffness k
//! of a pair of teeth and a contact ratio between 1 and 2 the transmission error is F/k where one pair carries F, and
//! F/(2k) + (e_1 + e_2)/2 where two pairs with reliefs e_1 and e_2 do. It is constant at the design load F if e_1 +
//! e_2 = F/k in all of the double contact: linear tip reliefs from the highest point of single contact on, F/k at the
//! tip.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{GearPair, Misalignment, ToothGeometry};
use gearmesh_model::{ReducedGear, StoredGear, write_reduced_gear};
use gearmesh_scene::optimise::{Optimum, Trial, optimise};
use gearmesh_scene::{Scene, load, run};
use gearmesh_specification::optimise::Optimisation;

use crate::made_up_gears;

use made_up_gears::pair_common;

/// Compliance of a tooth [m/N], wherever it is loaded.
const COMPLIANCE: f64 = 4e-9;
const TEETH: usize = 30;
const CENTRE_M: f64 = 0.090;
/// Design load on gear 2 [N m].
const TORQUE: f64 = 100.0;

fn tooth() -> ToothGeometry {
    ToothGeometry::new(&pair_common::tooth(TEETH, 0.0, 0.0)).unwrap()
}

/// Two equal gears whose teeth deflect like springs, and do not feel each other.
fn write_models(folder: &Path) {
    let body = pair_common::made_up_gear(&tooth(), 0.02, 1);
    let loads = body.grid.len();
    let mut c_hub = vec![0.0; TEETH * loads * loads];
    c_hub[..loads * loads].fill(COMPLIANCE);
    let model = ReducedGear {
        input: StoredGear::of_older_file(made_up_gears::gear_file(TEETH, 0.0)),
        near_field: None,
        c_hub,
        ..body
    };
    write_reduced_gear(&folder.join("gear.h5"), &model).unwrap();
}

fn scene(relief: &str) -> String {
    let table = |gear: usize| format!("[gear_{gear}.microgeometry]\n{relief}\n");
    format!(
        "title = \"springs\"\n[pair]\ngear_1 = \"gear.h5\"\ngear_2 = \"gear.h5\"\ncentre_distance_mm = {:?}\n[mesh]\nmodel = {{ kind = \"hybrid\", local = \"none\" }}\n\
         teeth.path = \"line-of-action\"\n{}{}[run]\ntorques_Nm = [50.0, {TORQUE:?}]\npitches = 1\npoints_per_pitch = 40\n",
        1e3 * CENTRE_M,
        table(1),
        table(2)
    )
}

/// Relief [um] and start diameter [mm] by Harris's law.
fn harris() -> (f64, f64) {
    let tooth = tooth();
    let pair = GearPair::new(
        tooth.clone(),
        tooth.clone(),
        CENTRE_M,
        Misalignment::default(),
    )
    .unwrap();
    assert!(pair.contact_ratio() > 1.5 && pair.contact_ratio() < 1.9);
    let base = tooth.base_radius_m;
    let force = TORQUE / base;
    let end = (tooth.tip_radius_m.powi(2) - base.powi(2)).sqrt();
    let base_pitch = std::f64::consts::TAU * base / TEETH as f64;
    // The path is as long as ε base pitches: the lower end of single contact of one flank is the highest of the other.
    let start = end - (pair.contact_ratio() - 1.0) * base_pitch;
    (1e6 * 2.0 * COMPLIANCE * force, 2e3 * start.hypot(base))
}

fn peak_to_peak_um(folder: &Path, relief: &str) -> [f64; 2] {
    let scene = Scene::from_document(InputDocument::new("s", scene(relief)), folder).unwrap();
    let result = run(&load(scene).unwrap(), &|_, _| ()).unwrap();
    [0, 1].map(|k| 1e6 * result.figures(k).te_peak_to_peak_m)
}

fn stated((relief, start): (f64, f64)) -> String {
    format!("tip_relief_um = {relief:?}\ntip_relief_start_diameter_mm = {start:?}")
}

/// Relief [um] that nulls the transmission error at a share of the design load, for a start [mm] from Harris's on
/// outwards. A relief over the length u at the end of the path, u below that of double contact D, takes a pair out of
/// contact for D − u; both carry over 2u − D, where the slope s of both adds up to F/k if s (2u − D) = F/k. At the tip
/// it is s u; of u = D Harris's F/k.
fn by_law(start: f64, share: f64) -> f64 {
    let tooth = tooth();
    let along = |radius: f64| (radius.powi(2) - tooth.base_radius_m.powi(2)).sqrt();
    let (relief, first) = harris();
    let end = along(tooth.tip_radius_m);
    let [double, own] = [first, start].map(|diameter| end - along(0.5e-3 * diameter));
    share * relief * own / (2.0 * own - double)
}

fn problem(folder: &Path, more: &str) -> Result<Optimisation, String> {
    let start = harris().1;
    std::fs::write(folder.join("scene.toml"), scene(&stated((1.0, start)))).unwrap();
    let text = format!(
        "title = \"Harris\"\nscene = \"scene.toml\"\n{more}\n\
         [[variable]]\nname = \"relief\"\nkeys = [\"gear_1.microgeometry.tip_relief_um\", \"gear_2.microgeometry.tip_relief_um\"]\nfrom = 0.0\nto = 60.0\n\
         [[variable]]\nname = \"start\"\nkeys = [\"gear_1.microgeometry.tip_relief_start_diameter_mm\", \"gear_2.microgeometry.tip_relief_start_diameter_mm\"]\nfrom = {start:?}\nto = 92.6\n"
    );
    Optimisation::from_document(InputDocument::new("o.toml", text), folder)
        .map_err(|e| e.to_string())
}

fn optimised(folder: &Path, more: &str) -> Result<Optimum, String> {
    let outcome = optimise(
        &problem(folder, more)?,
        folder,
        &AtomicBool::new(false),
        &|_, _| (),
    );
    outcome.map_err(|e| e.to_string())
}

const RANGE: &str = "[[objective]]\nname = \"range\"\nterm = [{ column = \"te_peak_to_peak_um\", torque_Nm = 100.0 }]\n";

#[test]
fn a_long_linear_relief_nulls_the_transmission_error_at_its_design_load() {
    let folder = tempfile::tempdir().unwrap();
    write_models(folder.path());
    let unmodified = peak_to_peak_um(folder.path(), "")[1];
    // F/k where one pair carries, half of it where two do.
    assert!(
        (unmodified - 0.5 * harris().0).abs() < 1e-6 * unmodified,
        "{unmodified}"
    );
    let by_law = peak_to_peak_um(folder.path(), &stated(harris()));
    assert!(by_law[1] < 2e-3 * unmodified, "{by_law:?}");
    // Off its design load it does not.
    assert!(by_law[0] > 0.1 * unmodified, "{by_law:?}");

    let found = optimised(folder.path(), &format!("trials = 240\n{RANGE}")).unwrap();
    let [best] = &found.front[..] else {
        unreachable!("one objective has one best: {:?}", found.front);
    };
    assert!(best.objectives[0] < 0.02 * unmodified, "{best:?}");
    let (relief, start) = harris();
    assert!(
        (best.values[0] / relief - 1.0).abs() < 0.04,
        "{best:?}, law {relief} um"
    );
    assert!(
        (best.values[1] - start).abs() < 0.1,
        "{best:?}, law {start} mm"
    );
    // The scene as it stands has a relief of 1 um.
    assert!(found.before.unwrap()[0] > 0.4 * unmodified);
    assert!(found.tried.len() <= 240);
    // The same seed, the same search.
    let again = optimised(folder.path(), &format!("trials = 240\n{RANGE}")).unwrap();
    assert_eq!((found.front, found.tried), (again.front, again.tried));
}

/// Half the load asks for half the relief: between the two there is a front, and every trial on it is a run of its
/// scene.
#[test]
fn two_loads_have_a_front_between_their_reliefs() {
    let folder = tempfile::tempdir().unwrap();
    write_models(folder.path());
    let two = format!(
        "trials = 120\nsearches = 3\n{RANGE}{}",
        RANGE
            .replace("\"range\"", "\"half\"")
            .replace("100.0", "50.0")
    );
    let found = optimised(folder.path(), &two).unwrap();
    assert!(found.front.len() > 5, "{:?}", found.front);
    assert!(found.front.is_sorted_by(
        |a, b| a.objectives[0] < b.objectives[0] && a.objectives[1] > b.objectives[1]
    ));
    let [first, last] = [&found.front[0], found.front.last().unwrap()];
    let of_law = |trial: &Trial, share: f64| trial.values[0] / by_law(trial.values[1], share);
    assert!((of_law(first, 1.0) - 1.0).abs() < 0.1, "{first:?}");
    assert!((of_law(last, 0.5) - 1.0).abs() < 0.1, "{last:?}");
    let middle = &found.front[found.front.len() / 2];
    let run = peak_to_peak_um(folder.path(), &stated((middle.values[0], middle.values[1])));
    for (objective, of_run) in middle.objectives.iter().zip([run[1], run[0]]) {
        assert!(
            (objective - of_run).abs() < 1e-6 * of_run.max(1.0),
            "{middle:?} {run:?}"
        );
    }
}

/// Scatter of ±5 µm about what the variable says: the best relief is worth what its pairs are worth in the mean, not
/// nothing.
#[test]
fn scatter_is_added_to_the_variable() {
    let folder = tempfile::tempdir().unwrap();
    write_models(folder.path());
    let scatter = "[[scatter]]\nname = \"tool\"\nkeys = [\"gear_1.microgeometry.tip_relief_um\"]\nuniform = { from = -5.0, to = 5.0 }\n";
    let found = optimised(
        folder.path(),
        &format!("trials = 60\nscatter_samples = 4\n{RANGE}{scatter}"),
    )
    .unwrap();
    let best = &found.front[0];
    assert!(best.objectives[0] > 0.5, "{best:?}");
    let law = by_law(best.values[1], 1.0);
    assert!(
        (best.values[0] / law - 1.0).abs() < 0.25,
        "{best:?}, law {law} um"
    );
}

#[test]
fn what_is_wrong_is_told_with_what_is_right() {
    let folder = tempfile::tempdir().unwrap();
    write_models(folder.path());
    for (more, told) in [
        (
            RANGE.replace("to_peak", "to_paek"),
            "objective.0.term.0.column: there is no column",
        ),
        (
            RANGE.replace("100.0", "80.0"),
            "objective.0.term.0.torque_Nm: found 80, the scene has [50.0, 100.0]",
        ),
        (
            format!("searches = 3\n{RANGE}"),
            "searches: belongs to several objectives",
        ),
        (
            format!("trials = 3\n{RANGE}"),
            "trials: found 3 in 1 searches, allowed are 20 and more",
        ),
        (
            format!(
                "{RANGE}[[variable]]\nname = \"relief\"\nkeys = [\"pair.deviation_mrad\"]\nfrom = 0.0\nto = 1.0\n"
            ),
            "variable.1.name: `relief` is the name of variable.0, too",
        ),
        (
            format!(
                "{RANGE}[[variable]]\nname = \"again\"\nkeys = [\"gear_2.microgeometry.tip_relief_um\"]\nfrom = 0.0\nto = 1.0\n"
            ),
            "is set by variable.0 already",
        ),
        (
            format!("scatter_samples = 3\n{RANGE}"),
            "scatter_samples: belongs to [[scatter]]",
        ),
        (
            format!(
                "{RANGE}[[scatter]]\nname = \"x\"\nkeys = [\"pair.inclinaton_mrad\"]\nuniform = {{ from = -1.0, to = 1.0 }}\n"
            ),
            "did you mean `inclination_mrad`?",
        ),
    ] {
        let error = optimised(folder.path(), &more).unwrap_err();
        assert!(error.contains(told), "{error}");
    }
}
