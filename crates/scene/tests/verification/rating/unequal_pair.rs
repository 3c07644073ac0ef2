//! 23 teeth drive 47, solid or with six holes: a quantity repeats after its own period and no earlier, a run says how
//! much of it it has seen, and what it proposes gives the figures of the whole.

use crate::made_up_gears::drilled_pair::{scene, write_models};
use gearmesh_geometry::input::InputDocument;
use gearmesh_model::DataTree;
use gearmesh_scene::periods::Extent;
use gearmesh_scene::{RESULT_FORMAT, Scene, SceneResult, load, run};
use std::path::Path;

const POINTS: usize = 12;

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    write_models(folder.path());
    std::fs::write(folder.path().join("sn.toml"), crate::rating::TABLE).unwrap();
    folder
}

fn ran(text: &str, folder: &Path) -> SceneResult {
    let scene = Scene::from_document(InputDocument::new("scene.toml", text), folder).unwrap();
    run(&load(scene).unwrap(), &|_, _| ()).unwrap()
}

fn keys(pitches: usize) -> String {
    format!("pitches = {pitches}\npoints_per_pitch = {POINTS}")
}

const GAUGES: &str = "[gauges]\ngear_1 = [\"g0\"]\ngear_2 = [\"g0\", \"g5\"]\n";

/// Largest difference of a curve from itself some pitches on, over its range.
fn change_after(curve: &[f64], pitches: usize) -> f64 {
    let (early, late) = (
        &curve[..curve.len() - pitches * POINTS],
        &curve[pitches * POINTS..],
    );
    let differences = early.iter().zip(late).map(|(a, b)| (a - b).abs());
    differences.fold(0.0, f64::max) / range(curve)
}

fn range(curve: &[f64]) -> f64 {
    let least = curve.iter().copied().fold(f64::MAX, f64::min);
    curve.iter().copied().fold(f64::MIN, f64::max) - least
}

/// A computed run of two hunting periods, and the periods that its gears say.
#[test]
fn curves_repeat_after_their_own_periods() {
    let folder = folder();
    for (wheel, contact, of_gauges) in [("wheel", 1, [23, 47, 47]), ("drilled", 47, [1081, 47, 47])]
    {
        let result = ran(&scene(wheel, &keys(2 * 1081), GAUGES), folder.path());
        assert_eq!(result.contact_coverage.period_pitches, contact);
        let repeats = |curve: &[f64], period: usize, shorter: &[usize]| {
            assert!(change_after(curve, period) < 1e-6, "{wheel} {period}");
            for early in shorter {
                let change = change_after(curve, *early);
                assert!(change > 1e-3, "{wheel} {period}: {change:e} after {early}");
            }
        };
        let te = result.curve(&result.te_m, 0);
        repeats(te, contact, if contact == 1 { &[] } else { &[1, 8, 23] });
        for (series, period) in result.strain.iter().zip(of_gauges) {
            assert_eq!(series.coverage.period_pitches, period);
            assert_eq!(series.coverage.extent, Extent::Whole);
            let shorter: &[usize] = if period == 1081 {
                &[23, 47]
            } else {
                &[1, 23 * 47 % period + 1]
            };
            repeats(result.curve(&series.method_2, 0), period, shorter);
        }
        assert!(result.incomplete().is_empty() && result.proposal.is_empty());
    }
}

/// The run of the issue: three pitches, the gauged tooth in mesh at the start. Its figures are wrong and marked; those
/// of the proposed start are right.
#[test]
fn a_passage_that_is_cut_is_marked_and_the_proposed_run_holds_it() {
    let folder = folder();
    let gauges = "[gauges]\ngear_2 = [\"g0\"]\n";
    let of = |run: &str| ran(&scene("wheel", run, gauges), folder.path());
    let figures = |r: &SceneResult| {
        let strain = r.curve(&r.strain[0].method_2, 0);
        [
            range(strain),
            strain.iter().fold(0.0_f64, |most, x| most.max(x.abs())),
        ]
    };
    // Fine enough for a peak at the tip, where the load leaves at once: a path of 1.6 pitches, a strain that grows
    // along it.
    let fine = 96;
    let keys = |pitches| format!("pitches = {pitches}\npoints_per_pitch = {fine}");
    let (whole, cut) = (of(&keys(47)), of(&keys(3)));
    assert_eq!(cut.strain[0].coverage.extent, Extent::Part);
    assert_eq!(cut.contact_coverage.extent, Extent::Whole);
    assert_eq!(
        cut.incomplete(),
        ["strain at gauge g0 of gear 2: incomplete: 3 of 47 pitches"]
    );
    let [cut_range, whole_range] = [&cut, &whole].map(|r| figures(r)[0]);
    assert!(
        cut_range < 0.95 * whole_range,
        "{cut_range:e} {whole_range:e}"
    );
    // "run.pitches = 47 covers everything; run.start_deg = -28.17, run.pitches = 4 covers peak and range of the gauges"
    let (everything, passage) = cut.proposal.split_once(" covers everything; run.").unwrap();
    assert_eq!(everything, "run.pitches = 47");
    let passage = passage
        .strip_suffix(" covers peak and range of the gauges")
        .unwrap();
    let proposed = of(&format!(
        "{}\npoints_per_pitch = {fine}",
        passage.replace(", run.", "\n")
    ));
    assert_eq!(proposed.strain[0].coverage.extent, Extent::Passage);
    assert!(proposed.pitches < 8, "{}", proposed.pitches);
    assert_eq!(
        proposed.incomplete(),
        [format!(
            "strain at gauge g0 of gear 2: mean and spectrum incomplete: {} of 47 pitches; peak and range are those of the tooth's one passage",
            proposed.pitches
        )]
    );
    // Other positions, as the start is another: 1/(96 · 1.6) of the peak.
    for (found, expected) in figures(&proposed).into_iter().zip(figures(&whole)) {
        assert!(
            (found / expected - 1.0).abs() < 0.01,
            "{found:e} {expected:e}"
        );
    }
}

/// Six holes on 47 teeth: less than the wheel's revolution is part of everything; the pinion's gauge needs the hunting
/// period.
#[test]
fn a_drilled_wheel_is_covered_by_its_revolution() {
    let folder = folder();
    let rating = "[[rating]]\nkind = \"fatigue\"\ngauge = \"g0\"\ngear = 1\nsn_table = \"sn.toml\"\n[[rating]]\nkind = \"nominal\"\n";
    let of = |pitches, further: &str| {
        let text = scene("drilled", &keys(pitches), &format!("{GAUGES}{further}"));
        ran(&text, folder.path())
    };
    let part = of(23, rating);
    assert_eq!(part.contact_coverage.extent, Extent::Part);
    assert_eq!(part.proposal, "run.pitches = 1081 covers everything");
    assert_eq!(
        part.ratings[0].incomplete.as_deref(),
        Some("incomplete: 23 of 1081 pitches")
    );
    assert_eq!(
        part.ratings[1].incomplete.as_deref(),
        Some("incomplete: 23 of 47 pitches")
    );
    let file = folder.path().join("part.h5");
    part.write(&file).unwrap();
    assert_eq!(SceneResult::read(&file).unwrap(), part);
    let tree = DataTree::read(&file, &RESULT_FORMAT).unwrap();
    assert_eq!(tree.texts["contact/extent"], "part");
    assert_eq!(tree.texts["gauges/1/extent"], "part");

    let whole = of(47, "");
    assert_eq!(whole.contact_coverage.extent, Extent::Whole);
    let extents: Vec<Extent> = whole.strain.iter().map(|s| s.coverage.extent).collect();
    assert_eq!(extents, [Extent::Part, Extent::Whole, Extent::Whole]);
    // Means are those of whole periods, however much longer the run.
    let longer = of(60, "");
    let mean = |r: &SceneResult| {
        let te = r.averaged(&r.te_m, 0);
        te.iter().sum::<f64>() / te.len() as f64
    };
    assert!((mean(&longer) / mean(&whole) - 1.0).abs() < 1e-9);
}
