//! Projected Gauss-Seidel with a bisection per slice: the independent solver for curved local laws.

use super::Data;

/// Forces at given approach, swept until no force changes by more than `1e-13` of the largest; `None` if too slow.
pub fn position(data: &Data, approach: f64, force: &mut [f64]) -> Option<()> {
    let n = data.size();
    for _ in 0..20_000 {
        let mut change: f64 = 0.0;
        for i in 0..n {
            let others: f64 = (0..n)
                .filter(|&j| j != i)
                .map(|j| data.compliance[i * n + j] * force[j])
                .sum();
            let room = approach * data.closing[i] - data.separation[i] - others;
            let new = single(data, i, room);
            change = change.max((new - force[i]).abs());
            force[i] = new;
        }
        let largest = force.iter().copied().fold(0.0, f64::max);
        if change <= 1e-13 * largest {
            return Some(());
        }
    }
    None
}

/// The force with `C_ii F + δ(F) = room`, zero if there is no room: bisection, as the left side increases.
fn single(data: &Data, i: usize, room: f64) -> f64 {
    if room <= 0.0 {
        return 0.0;
    }
    let own = data.compliance[i * data.size() + i];
    let value = |f: f64| own * f + data.local[i].deflection(f);
    let mut high = 1.0;
    while value(high) < room {
        high *= 2.0;
    }
    let mut low = 0.0;
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return middle;
        }
        if value(middle) < room {
            low = middle
        } else {
            high = middle
        }
    }
}

/// Approach and forces under a given load: bisection on the approach.
pub fn load(data: &Data, load: f64) -> Option<(f64, Vec<f64>)> {
    let n = data.size();
    let mut force = vec![0.0; n];
    let first = data
        .separation
        .iter()
        .zip(&data.closing)
        .map(|(e, w)| e / w)
        .fold(f64::INFINITY, f64::min);
    let carried = |x: f64, force: &mut Vec<f64>| {
        position(data, x, force)?;
        Some(
            data.lever
                .iter()
                .zip(force.iter())
                .map(|(b, f)| b * f)
                .sum::<f64>(),
        )
    };
    let mut step = 1e-9;
    while carried(first + step, &mut force)? < load {
        step *= 2.0;
    }
    let (mut low, mut high) = (0.0, step);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if carried(first + middle, &mut force)? < load {
            low = middle
        } else {
            high = middle
        }
    }
    Some((first + high, force))
}
