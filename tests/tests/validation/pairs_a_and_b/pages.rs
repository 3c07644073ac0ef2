//! What docs/demo.md and docs/lightweight-gears.md print of pairs A and B is what is computed.

use super::{TEETH, amplitude, pair, root};
use gearmesh_report::comparison::BothSides;
use gearmesh_report::scene_comparison::compare_scene;
use gearmesh_report::{Quantity, ReferenceRecord};
use gearmesh_scene::SceneResult;

/// The rows of the demo page's table of a pair: torque, mean, its deviation, peak to peak, its deviation, two orders.
fn printed(title: &str) -> Vec<Vec<f64>> {
    let page = std::fs::read_to_string(root().join("docs/demo.md")).unwrap();
    let table = page.split(&format!("{title} against `")).nth(1).unwrap();
    let numbers = |line: &str| -> Option<Vec<f64>> {
        line.split_whitespace()
            .map(|word| word.parse().ok())
            .collect()
    };
    let rows = table.lines().skip(2).map_while(numbers);
    rows.take_while(|row| !row.is_empty()).collect()
}

/// What docs/demo.md prints of pairs A and B is what the demo computes, to the digits that are printed (one more in the
/// last for another processor's rounding).
#[test]
#[ignore = "three gears are reduced: a minute on two quiet cores; run with --ignored"]
fn the_demo_page_prints_what_the_demo_computes() {
    let mut is_right = true;
    for (name, title) in [("pair_a", "Pair A"), ("pair_b", "Pair B")] {
        let (_, result) = pair(name, &[]);
        let record = ReferenceRecord::read(&root().join("reference").join(name)).unwrap();
        let comparisons = compare_scene(&result, &record).unwrap();
        let table = printed(title);
        assert_eq!(table.len(), result.torque_nm.len(), "{title}");
        for (k, row) in table.iter().enumerate() {
            let figures = result.figures(k);
            let te = (comparisons.iter())
                .find(|c| {
                    c.quantity == Quantity::TransmissionError && c.torque_nm == figures.torque_nm
                })
                .unwrap();
            let percent = |both: BothSides| 100.0 * both.relative_difference().unwrap();
            let curve = result.curve(&result.te_m, k);
            let expected = [
                (figures.torque_nm, 0.0),
                (1e6 * figures.te_mean_m, 1.5e-3),
                (percent(te.mean), 1.5e-2),
                (1e6 * figures.te_peak_to_peak_m, 1.5e-3),
                (percent(te.peak_to_peak), 1.5e-2),
                (1e6 * amplitude(curve, 3), 1.5e-4),
                (1e6 * amplitude(curve, TEETH), 1.5e-4),
            ];
            println!("{title}: {row:?} {:?}", expected.map(|(value, _)| value));
            let close =
                |(printed, (value, digits)): (&f64, (f64, f64))| (printed - value).abs() <= digits;
            is_right &= row.iter().zip(expected).all(close);
        }
    }
    assert!(is_right, "the tables of docs/demo.md are not these");
}

/// Rows of the table below a heading of docs/lightweight-gears.md: the words of each row's first cell, and its numbers.
fn table(heading: &str) -> Vec<(String, Vec<f64>)> {
    let page = std::fs::read_to_string(root().join("docs/lightweight-gears.md")).unwrap();
    let section = page.split(&format!("\n## {heading}\n")).nth(1).unwrap();
    let rows = section
        .lines()
        .skip_while(|line| !line.starts_with("| --- "));
    rows.skip(1)
        .take_while(|line| line.starts_with('|'))
        .map(|line| {
            let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
            let number = |cell: &&str| cell.replace('−', "-").parse().unwrap();
            (cells[0].to_owned(), cells[1..].iter().map(number).collect())
        })
        .collect()
}

/// What of a printed table is not its figures, to half of the last digit printed and as much for another processor's
/// rounding.
fn misprints(heading: &str, computed: &[(String, Vec<f64>)], digits: &[usize]) -> Vec<String> {
    println!("{heading}");
    for (name, values) in computed {
        let cells = values.iter().zip(digits);
        let cells: Vec<String> = cells
            .map(|(value, digits)| format!("{value:.digits$}"))
            .collect();
        println!("| {name} | {} |", cells.join(" | ").replace('-', "−"));
    }
    let printed = table(heading);
    if printed.len() != computed.len() {
        return vec![format!("{heading}: {} rows", printed.len())];
    }
    let mut faults = Vec::new();
    for ((name, cells), (expected, values)) in printed.iter().zip(computed) {
        let close = |((cell, value), digits): ((&f64, &f64), &usize)| {
            (cell - value).abs() <= 10f64.powi(-(*digits as i32))
        };
        let all = cells.iter().zip(values).zip(digits).all(close);
        if name != expected || cells.len() != values.len() || !all {
            faults.push(format!(
                "{heading}, {name}: {cells:?} printed, {values:?} computed"
            ));
        }
    }
    faults
}

/// Without and with friction, at the positions of the demo and the events between them.
fn without_and_with(name: &str) -> [SceneResult; 2] {
    [name.to_owned(), format!("{name}_friction")].map(|name| pair(&name, &[]).1)
}

#[test]
#[ignore = "three gears are reduced: a minute on two quiet cores; run with --ignored"]
fn the_page_of_lightweight_gears_prints_what_is_computed() {
    let (mut te, mut strain, mut faults) = (Vec::new(), Vec::new(), Vec::new());
    for (name, letter, gauges) in [
        ("pair_a", "A", &["t0_tension", "t0_compression"][..]),
        (
            "pair_b",
            "B",
            &[
                "t0_tension",
                "t0_compression",
                "t9_tension",
                "t9_compression",
            ],
        ),
    ] {
        let both = without_and_with(name);
        for torque in [0, 5] {
            let of = |r: &SceneResult| {
                let figures = r.figures(torque);
                [1e6 * figures.te_mean_m, 1e6 * figures.te_peak_to_peak_m]
            };
            let row = both.iter().flat_map(of).collect();
            te.push((format!("{letter}, {} N·m", both[0].torque_nm[torque]), row));
            for gauge in gauges {
                let range = |r: &SceneResult, method| {
                    let number = r.strain.iter().position(|s| s.name == *gauge).unwrap();
                    let [least, most] = r.strain_ends(number, method, torque);
                    1e6 * (most - least)
                };
                let [without, with] = &both;
                let [one, two] = [range(without, 1), range(without, 2)];
                let [one_mu, two_mu] = [range(with, 1), range(with, 2)];
                strain.push((
                    format!("{letter}, {} N·m, {gauge}", without.torque_nm[torque]),
                    vec![one, two, one_mu, two_mu, 100.0 * (two_mu / two - 1.0)],
                ));
            }
        }
        if letter == "A" {
            let rows = along_the_path(&both[0]);
            faults.extend(misprints(
                "Contact along the path",
                &rows,
                &[1, 0, 0, 1, 0, 2],
            ));
        }
    }
    faults.extend(misprints("Transmission error", &te, &[3, 3, 3, 3]));
    faults.extend(misprints("Root strain", &strain, &[1, 1, 1, 1, 1]));
    assert!(faults.is_empty(), "{faults:#?}");
}

/// The pair of teeth 0 and 0 of pair A at 300 N·m, every sixth of a pitch: relative radius, force, line load, half
/// width, pressure, and how far the flanks would overlap if they were rigid.
fn along_the_path(r: &SceneResult) -> Vec<(String, Vec<f64>)> {
    let torque = 5;
    let pitch = std::f64::consts::TAU / TEETH as f64;
    let mut rows = Vec::new();
    let block = r.lines.slots * r.lines.slices;
    let width_m = 23e-3;
    // E* of steel on steel, as Hertz has it: 1/E* = 2 (1 - nu^2)/E.
    let modulus_pa = 210e9 / (2.0 * (1.0 - 0.09));
    for (k, _) in r.angle_rad.iter().enumerate() {
        // Pairs are numbered on: those before the start of the turn are met at its end.
        let (slots, turn) = (r.lines.slots, r.angles());
        let found = (0..slots).find(|slot| {
            let is_in_use = *slot < r.lines.pair_count[k] as usize;
            let pair = r.lines.pair[k * slots + slot].round() as i64;
            is_in_use && pair.rem_euclid(TEETH as i64) == 0
        });
        let (Some(slot), 0) = (found, k % 8) else {
            continue;
        };
        let turned = if k > turn / 2 {
            k as f64 - turn as f64
        } else {
            k as f64
        };
        let angle = turned / r.points_per_pitch() as f64 * pitch;
        let at = (torque * turn + k) * block + slot * r.lines.slices;
        let force_n: f64 = r.lines.force_n[at..at + r.lines.slices].iter().sum();
        let pressure_pa = r.lines.pressure_pa[at..at + r.lines.slices]
            .iter()
            .copied()
            .fold(0.0, f64::max);
        let path_m = angle * BASE_RADIUS_M;
        let half = 0.5 * LINE_M;
        let radius_m = (half + path_m) * (half - path_m) / LINE_M;
        let most = r.lines.force_n[at..at + r.lines.slices]
            .iter()
            .copied()
            .fold(0.0, f64::max);
        let line_load = most / (width_m / r.lines.slices as f64);
        let half_width_m =
            (4.0 * line_load * radius_m / (std::f64::consts::PI * modulus_pa)).sqrt();
        // Hertz: the pressure of the file is that of this half width.
        assert!(
            (2.0 * line_load / (std::f64::consts::PI * half_width_m) / pressure_pa - 1.0).abs()
                < 1e-6
        );
        let overlap_m = -r.curve(&r.te_m, torque)[k] - crowning_m(path_m);
        rows.push((
            path_m,
            vec![
                1e3 * radius_m,
                force_n,
                1e-3 * line_load,
                1e6 * half_width_m,
                1e-6 * pressure_pa,
                1e6 * overlap_m,
            ],
        ));
    }
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    (rows.into_iter())
        .map(|(path_m, row)| (format!("{:.2}", 1e3 * path_m).replace('-', "−"), row))
        .collect()
}

/// Base radius of the three gears: 57 teeth, module 2.6 mm, 20°.
const BASE_RADIUS_M: f64 = 0.5 * 57.0 * 2.6e-3 * 0.939_692_620_785_908_4;

/// Length of the line of action between the base circles: the sum of both radii of curvature.
const LINE_M: f64 = 55.731_239_2e-3;

/// Gear 1's crowning, a parabola of the roll angle: nothing on 150 mm, 10 µm at the tip.
fn crowning_m(path_m: f64) -> f64 {
    let tip_m = (77.558e-3_f64.powi(2) - BASE_RADIUS_M.powi(2)).sqrt();
    10e-6 * (path_m / (tip_m - 0.5 * LINE_M)).powi(2)
}
