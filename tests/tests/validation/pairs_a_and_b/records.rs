//! Pairs A and B against their records.

use super::{amplitude, pair, root, swing};
use gearmesh_report::scene_comparison::compare_scene;
use gearmesh_report::{Quantity, ReferenceRecord, SeriesComparison};
use gearmesh_scene::SceneResult;

/// Positions a pitch of the records.
const RECORD_POINTS: usize = 48;

/// Root strain of the demo's gears on default lengths: one per cent is asked, 0.52 to 0.86 % below the records found.
/// Of gear 2, fillets that are a fifth shorter leave 0.1 to 0.2 % less, layers a third thinner 0.1 %; quadratic
/// elements leave 0.1 to 0.2 % in all, most of it of slices.
const STRAIN_WITHIN: f64 = 0.01;

/// Error of gear 3's deflection: the program states 0.46 %. Half the length in the body adds 0.5 %, which
/// meshes with longer elements do not see: sides at the corners of slots are as short there (docs/limits.md).
const OVER_SLOTS: f64 = 0.0075;

/// Transmission error of one torque. What the mesh gets wrong is a share of the elastic part: that bounds its mean, its
/// swing and each of its orders. To them comes the record's uncertainty; an order has at most half of the swing's,
/// times 4/π where the difference is a rectangle.
fn transmission_error(it: &SeriesComparison, (result, k): (&SceneResult, usize), share: f64) {
    let te = result.curve(&result.te_m, k);
    let elastic: Vec<f64> = te
        .iter()
        .zip(&result.unloaded_m)
        .map(|(t, u)| t - u)
        .collect();
    let mean = elastic.iter().sum::<f64>() / elastic.len() as f64;
    let swing_uncertainty = it.peak_to_peak.uncertainty.unwrap();
    let mut rows = vec![
        (
            "mean".to_owned(),
            [it.mean.ours, it.mean.reference],
            share * mean.abs() + it.mean.uncertainty.unwrap(),
        ),
        (
            "swing".to_owned(),
            [it.peak_to_peak.ours, it.peak_to_peak.reference],
            share * swing(&elastic) + swing_uncertainty,
        ),
    ];
    for line in it
        .harmonics
        .iter()
        .filter(|line| [3.0, 57.0].contains(&line.order))
    {
        rows.push((
            format!("order {}", line.order),
            [line.ours, line.reference],
            share * amplitude(&elastic, line.order as usize)
                + 2.0 / std::f64::consts::PI * swing_uncertainty,
        ));
    }
    for (what, [ours, theirs], bound) in rows {
        println!(
            "  {} N m, TE {what}: {:.4} um, record {:.4}, off {:+.4} (bound {:.4})",
            it.torque_nm,
            1e6 * ours,
            1e6 * theirs,
            1e6 * (ours - theirs),
            1e6 * bound
        );
        assert!(
            (ours - theirs).abs() <= bound,
            "{} N m: {what}",
            it.torque_nm
        );
    }
}

/// Range of a gauge: within what both sides state, and within [`STRAIN_WITHIN`].
fn strain(it: &SeriesComparison, gauge: &str, stated: f64) {
    let [ours, theirs] = [it.peak_to_peak.ours, it.peak_to_peak.reference];
    let unknown = it.peak_to_peak.uncertainty.unwrap() / theirs;
    let off = ours / theirs - 1.0;
    println!(
        "  {} N m, {gauge}: {:.1} ustrain, record {:.1}, off {:+.2} %, stated {:.2} and {:.2} %",
        it.torque_nm,
        1e6 * ours,
        1e6 * theirs,
        100.0 * off,
        100.0 * stated,
        100.0 * unknown
    );
    assert!(
        off.abs() <= STRAIN_WITHIN,
        "{gauge}, {} N m: {off}",
        it.torque_nm
    );
    // Not more than both state, and ours states no more than three times what is found.
    assert!(
        off.abs() <= stated + unknown,
        "{gauge}, {} N m: {off}",
        it.torque_nm
    );
    assert!(
        stated <= 3.0 * off.abs(),
        "{gauge}, {} N m: {stated} stated, {off}",
        it.torque_nm
    );
}

fn against_its_record(name: &str, gauges: usize) {
    let (_, result) = pair(name, &[]);
    assert_eq!(result.points_per_pitch(), RECORD_POINTS);
    let record = ReferenceRecord::read(&root().join("reference").join(name)).unwrap();
    // What the line `errors:` of the result states.
    let stated = result.te_mesh_error;
    assert!(stated > 0.0);
    let share = match name.starts_with("pair_b") {
        true => OVER_SLOTS,
        false => stated,
    };
    let comparisons = compare_scene(&result, &record).unwrap();
    // Every torque, the transmission error and every gauge.
    assert_eq!(comparisons.len(), 6 * (1 + gauges));
    println!(
        "{name}: stated error of deflections {:.2} %",
        100.0 * stated
    );
    for it in &comparisons {
        let torque = result
            .torque_nm
            .iter()
            .position(|t| *t == it.torque_nm)
            .unwrap();
        match &it.quantity {
            Quantity::TransmissionError => transmission_error(it, (&result, torque), share),
            Quantity::Strain { gauge } => {
                let series = result.strain.iter().find(|s| s.name == *gauge).unwrap();
                strain(it, gauge, series.error_estimate().unwrap());
            }
        }
    }
}

#[test]
#[ignore = "three gears are reduced: a minute on two quiet cores; run with --ignored"]
fn pair_a_is_its_record() {
    against_its_record("pair_a", 2);
}

#[test]
#[ignore = "three gears are reduced: a minute on two quiet cores; run with --ignored"]
fn pair_b_is_its_record() {
    against_its_record("pair_b", 4);
}

/// With friction 0.3, as the seed's experiment.
#[test]
#[ignore = "three gears are reduced: a minute on two quiet cores; run with --ignored"]
fn pairs_with_friction_are_their_records() {
    against_its_record("pair_a_friction", 2);
    against_its_record("pair_b_friction", 4);
}

/// With half and with twice the positions of the records the swing of the transmission error and the largest pressure
/// are the same: positions between the even ones see the change of pairs, of which 24 a pitch alone miss a twelfth.
#[test]
#[ignore = "three gears are reduced: a minute on two quiet cores; run with --ignored"]
fn few_positions_see_what_many_see() {
    let [few, many] = [24, 96].map(|points| {
        let (even, stated) = (format!("= {points} "), format!("= {RECORD_POINTS} "));
        let (_, result) = pair(
            "pair_a",
            &[
                ("[50.0, 100.0, 150.0, 200.0, 250.0, 300.0]", "[300.0]"),
                (&stated, &even),
            ],
        );
        assert_eq!(result.points_per_pitch(), points);
        let figures = result.figures(0);
        let of_even = swing(result.curve(&result.te_m, 0));
        println!(
            "{points} a pitch: {:.4e} m, {of_even:.4e} m by even positions, {:.4e} Pa, {}",
            figures.te_peak_to_peak_m,
            figures.pressure_largest_pa,
            result.errors_in_words()
        );
        (figures, of_even)
    });
    // Twice what both state of their positions together, 0.05 % each.
    let same = |few: f64, many: f64| (few / many - 1.0).abs() < 0.002;
    let swings = [few, many].map(|(figures, _)| figures.te_peak_to_peak_m);
    assert!(same(swings[0], swings[1]), "{swings:?}");
    assert!(few.1 < 0.95 * swings[0], "{} {}", few.1, swings[0]);
    let pressures = [few, many].map(|(figures, _)| figures.pressure_largest_pa);
    assert!(same(pressures[0], pressures[1]), "{pressures:?}");
}
