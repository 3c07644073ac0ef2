//! Rainflow against the standard's own example and a second method.

use gearmesh_rating::{Cycle, Passage, RainflowError, rainflow, turning_points};
use proptest::prelude::*;

/// ASTM E1049-85, figure 6: the history A … I.
const ASTM: [f64; 9] = [-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0];

/// Range and count, sorted by range.
fn table(cycles: &[Cycle]) -> Vec<(f64, f64)> {
    let mut table: Vec<(f64, f64)> = Vec::new();
    for cycle in cycles {
        match table.iter_mut().find(|row| row.0 == cycle.range()) {
            Some(row) => row.1 += cycle.count,
            None => table.push((cycle.range(), cycle.count)),
        }
    }
    table.sort_by(|a, b| a.0.total_cmp(&b.0));
    table
}

#[test]
fn the_standards_example() {
    let cycles = rainflow(&ASTM, Passage::Once).unwrap();
    // The standard's table: range 3: 0.5, 4: 1.5, 6: 0.5, 8: 1.0, 9: 0.5 cycles.
    assert_eq!(
        table(&cycles),
        [(3.0, 0.5), (4.0, 1.5), (6.0, 0.5), (8.0, 1.0), (9.0, 0.5)]
    );
    // And its events in order: A-B, B-C half, E-F whole, then C-D, D-G, G-H, H-I half; their means follow.
    let events: Vec<(f64, f64)> = cycles.iter().map(|c| (c.count, c.mean())).collect();
    assert_eq!(
        events,
        [
            (0.5, -0.5),
            (0.5, -1.0),
            (1.0, 1.0),
            (0.5, 1.0),
            (0.5, 0.5),
            (0.5, 0.0),
            (0.5, 1.0)
        ]
    );
}

#[test]
fn the_standards_example_repeated() {
    // Section 5.4.5 by hand: D E F G H A B C D (I joins A): E-F, A-B, H-C and D-G close as whole cycles.
    let cycles = rainflow(&ASTM, Passage::Repeated).unwrap();
    assert_eq!(
        table(&cycles),
        [(3.0, 1.0), (4.0, 1.0), (7.0, 1.0), (9.0, 1.0)]
    );
}

#[test]
fn plateaus_and_points_on_the_way_change_nothing() {
    let filled: Vec<f64> = ASTM
        .windows(2)
        .flat_map(|pair| [pair[0], pair[0], 0.5 * (pair[0] + pair[1])])
        .chain([-2.0, -2.0])
        .collect();
    assert_eq!(turning_points(&filled).unwrap(), ASTM);
    assert_eq!(
        rainflow(&filled, Passage::Once),
        rainflow(&ASTM, Passage::Once)
    );
}

#[test]
fn short_and_bad_histories() {
    assert_eq!(rainflow(&[], Passage::Once), Err(RainflowError::Empty));
    assert_eq!(rainflow(&[], Passage::Repeated), Err(RainflowError::Empty));
    for passage in [Passage::Once, Passage::Repeated] {
        assert_eq!(rainflow(&[3.0], passage), Ok(vec![]));
        assert_eq!(rainflow(&[3.0; 5], passage), Ok(vec![]));
        assert!(matches!(
            rainflow(&[0.0, f64::NAN, f64::INFINITY], passage),
            Err(RainflowError::NotFinite { index: 1, .. })
        ));
    }
    let one_way = rainflow(&[0.0, 1.0], Passage::Once).unwrap();
    assert_eq!(table(&one_way), [(1.0, 0.5)]);
    let there_and_back = rainflow(&[0.0, 1.0], Passage::Repeated).unwrap();
    assert_eq!(table(&there_and_back), [(1.0, 1.0)]);
}

/// The four-point rule (another statement of the method): of four successive points the inner range is a cycle where
/// both outer ranges hold it. Returns the cycles' ranges and the residue.
fn four_point(points: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let (mut ranges, mut open) = (Vec::new(), Vec::new());
    for &point in points {
        open.push(point);
        while let [.., a, b, c, d] = open[..] {
            let inner = (c - b).abs();
            if inner > (b - a).abs() || inner > (d - c).abs() {
                break;
            }
            ranges.push(inner);
            open.truncate(open.len() - 3);
            open.push(d);
        }
    }
    (ranges, open)
}

fn history() -> impl Strategy<Value = Vec<f64>> {
    // Whole numbers: many equal ranges, the awkward case.
    prop::collection::vec((-9i32..9).prop_map(f64::from), 1..80)
}

proptest! {
    #[test]
    fn every_range_is_counted_once(x in history()) {
        // A cycle takes two ranges between turning points, half a cycle one.
        let cycles = rainflow(&x, Passage::Once).unwrap();
        let ranges = turning_points(&x).unwrap().len() - 1;
        prop_assert_eq!(2.0 * cycles.iter().map(|c| c.count).sum::<f64>(), ranges as f64);
    }

    #[test]
    fn the_turning_points_hold_all_cycles(x in history()) {
        let points = turning_points(&x).unwrap();
        for passage in [Passage::Once, Passage::Repeated] {
            prop_assert_eq!(rainflow(&x, passage), rainflow(&points, passage));
        }
    }

    #[test]
    fn the_largest_range_is_the_histories(x in history()) {
        let span = x.iter().fold(f64::MIN, |m, v| m.max(*v)) - x.iter().fold(f64::MAX, |m, v| m.min(*v));
        for passage in [Passage::Once, Passage::Repeated] {
            let largest = rainflow(&x, passage).unwrap().iter().fold(0.0f64, |m, c| m.max(c.range()));
            prop_assert_eq!(largest, span);
        }
    }

    #[test]
    fn upside_down_it_is_the_same(x in history()) {
        let turned: Vec<f64> = x.iter().map(|v| -v).collect();
        let of = |x: &[f64]| table(&rainflow(x, Passage::Once).unwrap());
        prop_assert_eq!(of(&x), of(&turned));
    }

    #[test]
    fn a_repeated_history_has_whole_cycles_wherever_it_begins(x in history(), by in 0usize..80) {
        let mut turned = x.clone();
        turned.rotate_left(by % x.len());
        let cycles = rainflow(&x, Passage::Repeated).unwrap();
        prop_assert!(cycles.iter().all(|c| c.count == 1.0));
        prop_assert_eq!(table(&cycles), table(&rainflow(&turned, Passage::Repeated).unwrap()));
    }

    #[test]
    fn a_repeated_history_agrees_with_the_four_point_rule(x in history()) {
        // Four-point on two passages, the second of which is stationary: what it closes more than on one is one
        // passage.
        let ranges_of = |times: usize| {
            let points = turning_points(&x.repeat(times)).unwrap();
            four_point(&points).0
        };
        let (mut twice, thrice) = (ranges_of(3), ranges_of(4));
        let mut one = thrice;
        for range in twice.drain(..) {
            let at = one.iter().position(|r| *r == range);
            prop_assert!(at.is_some());
            one.swap_remove(at.unwrap());
        }
        one.sort_by(f64::total_cmp);
        let mut found: Vec<f64> = rainflow(&x, Passage::Repeated).unwrap().iter().map(Cycle::range).collect();
        found.sort_by(f64::total_cmp);
        prop_assert_eq!(found, one);
    }
}
