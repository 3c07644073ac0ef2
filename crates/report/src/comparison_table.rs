//! The comparison as text: one block for each quantity, one line for each torque, units in the heads.

use crate::column_width;
use crate::comparison::{BothSides, HarmonicComparison, SeriesComparison};
use std::fmt::Write as _;

/// Below this part of the peak-to-peak value an amplitude is rounding and its phase says nothing.
const WEAKEST_HARMONIC: f64 = 1e-5;
/// A correlation below this one is that of a sign turned round.
const AGAINST: f64 = -0.9;

/// Text tables of comparisons, grouped by quantity in the order of their first occurrence.
///
/// For each quantity: the overall figures, the angle offset with the best correlation (applied to nothing), the stated
/// uncertainty of the reference, the harmonics. Values are in the unit of the
/// quantity (µm, µε); differences are ours/reference − 1.
pub fn comparison_table(comparisons: &[SeriesComparison]) -> String {
    let mut text = String::new();
    let mut done: Vec<&SeriesComparison> = Vec::new();
    for first in comparisons {
        if done.iter().any(|c| c.quantity == first.quantity) {
            continue;
        }
        done.push(first);
        let group: Vec<&SeriesComparison> = comparisons
            .iter()
            .filter(|c| c.quantity == first.quantity)
            .collect();
        if !text.is_empty() {
            text.push('\n');
        }
        figures(&mut text, first, &group);
        harmonics(&mut text, first, &group);
    }
    text
}

fn figures(text: &mut String, first: &SeriesComparison, group: &[&SeriesComparison]) {
    let unit = first.quantity.unit();
    let mut rows = vec![
        [
            "torque", "mean", "mean", "diff.", "pk-pk", "pk-pk", "diff.", "RMS", "RMS", "correl.",
            "max dev.", "at angle", "offset", "correl.",
        ]
        .map(String::from)
        .to_vec(),
        [
            "", "ours", "ref.", "", "ours", "ref.", "", "ours", "ref.", "", "", "", "best", "there",
        ]
        .map(String::from)
        .to_vec(),
        [
            "N·m",
            unit.symbol,
            unit.symbol,
            "%",
            unit.symbol,
            unit.symbol,
            "%",
            unit.symbol,
            unit.symbol,
            "-",
            unit.symbol,
            "deg",
            "deg",
            "-",
        ]
        .map(String::from)
        .to_vec(),
    ];
    let shown = |value: f64| format!("{:.3}", value * unit.per_si);
    for c in group {
        rows.push(vec![
            format!("{}", c.torque_nm),
            shown(c.mean.ours),
            shown(c.mean.reference),
            percent(&c.mean),
            shown(c.peak_to_peak.ours),
            shown(c.peak_to_peak.reference),
            percent(&c.peak_to_peak),
            shown(c.rms.ours),
            shown(c.rms.reference),
            number_or_dash(c.correlation, 5),
            shown(c.largest_deviation),
            format!("{:.2}", c.largest_deviation_angle_rad.to_degrees()),
            number_or_dash(c.best_offset_rad.map(f64::to_degrees), 2),
            number_or_dash(c.best_offset_correlation, 5),
        ]);
    }
    let _ = writeln!(text, "{} ({})", first.quantity, unit.symbol);
    write_aligned(text, &rows);
    let stated = |value: Option<f64>| {
        value.map_or_else(
            || "not stated".into(),
            |v| format!("± {} {}", shown(v), unit.symbol),
        )
    };
    let _ = writeln!(
        text,
        "  stated uncertainty of the reference: mean {}, pk-pk {}",
        stated(first.mean.uncertainty),
        stated(first.peak_to_peak.uncertainty)
    );
    if group.iter().any(|c| !c.is_locked) {
        let _ = writeln!(
            text,
            "  the record is no whole number of our periods: what is not locked to its revolutions is averaged out of ours"
        );
    }
    doubts(text, group);
}

/// What makes the reference doubtful: a hole, or a sign that runs against ours.
fn doubts(text: &mut String, group: &[&SeriesComparison]) {
    if let Some(hole) = group.iter().find_map(|c| c.reference_hole) {
        let [from, to] = [hole.from_rad, hole.from_rad + hole.step_rad].map(f64::to_degrees);
        let _ = writeln!(
            text,
            "  the reference has no values from {from:.2} to {to:.2} deg, {:.1} mesh periods: its curve there is invented, and figures suffer",
            hole.mesh_periods
        );
    }
    let against = |c: &&&SeriesComparison| c.correlation.is_some_and(|r| r < AGAINST);
    if let Some(c) = group.iter().find(against) {
        let _ = writeln!(
            text,
            "  at {} N·m the reference runs against ours: is its sign the other one? (`gearmesh record --negate HEAD` turns it)",
            c.torque_nm
        );
    }
}

/// Rounded to so many places, or a dash.
fn number_or_dash(value: Option<f64>, places: usize) -> String {
    value.map_or_else(|| "-".into(), |v| format!("{v:.places$}"))
}

fn harmonics(text: &mut String, first: &SeriesComparison, group: &[&SeriesComparison]) {
    if first.harmonics.is_empty() {
        return;
    }
    let unit = first.quantity.unit();
    let mut rows = vec![
        [
            "torque",
            "order",
            "amplitude",
            "amplitude",
            "diff.",
            "phase diff.",
        ]
        .map(String::from)
        .to_vec(),
        ["", "", "ours", "ref.", "", ""].map(String::from).to_vec(),
        ["N·m", "1/rev", unit.symbol, unit.symbol, "%", "deg"]
            .map(String::from)
            .to_vec(),
    ];
    for c in group {
        for h in &c.harmonics {
            let both = BothSides {
                ours: h.ours,
                reference: h.reference,
                uncertainty: None,
            };
            rows.push(vec![
                format!("{}", c.torque_nm),
                format!("{}", h.order),
                format!("{:.4}", h.ours * unit.per_si),
                format!("{:.4}", h.reference * unit.per_si),
                if weak(c, h) {
                    "-".into()
                } else {
                    percent(&both)
                },
                phase(c, h),
            ]);
        }
    }
    write_aligned(text, &rows);
}

/// One of the amplitudes is rounding.
fn weak(c: &SeriesComparison, h: &HarmonicComparison) -> bool {
    let floor = WEAKEST_HARMONIC * c.peak_to_peak.reference.abs();
    h.ours < floor || h.reference < floor
}

/// Phase difference in degrees, or a dash where one of the amplitudes is too weak to have a phase.
fn phase(c: &SeriesComparison, h: &HarmonicComparison) -> String {
    if weak(c, h) {
        "-".into()
    } else {
        format!("{:.1}", h.phase_difference_rad.to_degrees())
    }
}

/// Relative difference in per cent, or a dash where it says nothing.
fn percent(both: &BothSides) -> String {
    match both.relative_difference() {
        Some(r) if r.abs() < 10.0 => format!("{:+.2}", 100.0 * r),
        _ => "-".into(),
    }
}

/// Right-aligned columns, two blanks between them.
fn write_aligned(text: &mut String, rows: &[Vec<String>]) {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |i: usize| column_width(rows.iter().filter_map(|r| r.get(i)), 0);
    let widths: Vec<usize> = (0..columns).map(width).collect();
    for row in rows {
        for (cell, width) in row.iter().zip(&widths) {
            let _ = write!(text, "  {cell:>width$}");
        }
        text.push('\n');
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::comparison::RigView;
    use crate::comparison::compare;
    use crate::pair_orders::{PairOrders, Shaft};
    use crate::quantity::Quantity;
    use gearmesh_signal::AngleSeries;
    use std::f64::consts::TAU;

    #[test]
    fn holes_and_turned_signs_of_a_reference_are_told() {
        let curve = |sign: f64, hole: std::ops::Range<i32>| {
            let places = (0..1368).filter(|i| !hole.contains(i));
            let (angle, values): (Vec<f64>, Vec<f64>) = places
                .map(|i| TAU * f64::from(i) / 1368.0)
                .map(|a| (a, sign * 2e-6 * (57.0 * a).cos()))
                .unzip();
            AngleSeries::one_revolution(&angle, &values).unwrap()
        };
        let pair = PairOrders {
            teeth: [57, 57],
            openings: [0, 0],
        };
        let view = RigView::of(&pair, Shaft::Gear1, 1, vec![57.0]);
        let te = Quantity::TransmissionError;
        let told = |reference: &AngleSeries| {
            let c = compare(&curve(1.0, 0..0), reference, &te, &view).unwrap();
            (comparison_table(std::slice::from_ref(&c)), c)
        };
        // 14 of 24 points a pitch are missing after point 380 (100 degrees).
        let (text, c) = told(&curve(1.0, 381..395));
        assert!(
            text.contains("no values from 100.00 to 103.95 deg, 0.6 mesh"),
            "{text}"
        );
        // No crest is invented.
        assert!((c.peak_to_peak.reference / 4e-6 - 1.0).abs() < 0.01);
        let (text, _) = told(&curve(-1.0, 381..391));
        assert!(
            text.contains("runs against ours") && !text.contains("no values"),
            "{text}"
        );
    }

    #[test]
    fn heads_carry_units_and_columns_line_up() {
        let series = |scale: f64| {
            let values: Vec<f64> = (0..1368)
                .map(|i| scale * (-30e-6 + 2e-6 * (57.0 * TAU * f64::from(i) / 1368.0).cos()))
                .collect();
            AngleSeries::uniform(0.0, &values, 1).unwrap()
        };
        let pair = PairOrders {
            teeth: [57, 57],
            openings: [0, 0],
        };
        let mut c = compare(
            &series(1.02),
            &series(1.0),
            &Quantity::TransmissionError,
            &RigView::of(&pair, Shaft::Gear1, 1, vec![57.0]),
        )
        .unwrap();
        c.torque_nm = 300.0;
        c.mean.uncertainty = Some(5e-8);
        let text = comparison_table(&[c.clone(), c]);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], "TE (µm)");
        assert!(lines[3].contains("N·m") && lines[3].contains("µm") && lines[3].contains("deg"));
        assert!(
            lines[4].contains("-30.600")
                && lines[4].contains("-30.000")
                && lines[4].contains("+2.00")
        );
        assert!(
            lines[4].contains("4.080")
                && lines[4].contains("+2.00")
                && lines[4].contains("1.00000")
        );
        assert!(
            lines[6].contains("mean ± 0.050 µm, pk-pk not stated"),
            "{}",
            lines[6]
        );
        assert!(!text.contains("runs against") && !text.contains("no values"));
        let lengths: Vec<usize> = lines[1..6].iter().map(|l| l.chars().count()).collect();
        assert!(lengths.iter().all(|l| *l == lengths[0]), "{lengths:?}");
    }
}
