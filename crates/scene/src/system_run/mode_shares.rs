//! What a mode is: whose kinetic energy and whose strain.

use std::collections::BTreeMap;

use gearmesh_dynamics::NaturalMode;

/// Shares below this are not worth a word.
const LEAST: f64 = 5e-4;

/// The largest shares, largest first: bodies and beams of a shaft (`shaft/0`, `shaft/0-1`) count as the shaft.
#[must_use]
pub fn largest_shares(names: &[String], shares: &[f64], most: usize) -> Vec<(String, f64)> {
    let mut of_owner: BTreeMap<&str, f64> = BTreeMap::new();
    for (name, share) in names.iter().zip(shares) {
        let owner = name.split('/').next().unwrap_or(name);
        *of_owner.entry(owner).or_default() += share;
    }
    let mut sorted: Vec<(String, f64)> = of_owner
        .into_iter()
        .filter(|(_, share)| *share > LEAST)
        .map(|(owner, share)| (owner.to_owned(), share))
        .collect();
    sorted.sort_by(|a, b| b.1.total_cmp(&a.1));
    sorted.truncate(most);
    sorted
}

/// The same as a list in words, in percent.
#[must_use]
pub fn shares_in_words(names: &[String], shares: &[f64], most: usize) -> String {
    let largest = largest_shares(names, shares, most);
    let words = largest
        .iter()
        .map(|(owner, share)| format!("{owner} {:.1} %", 100.0 * share));
    words.collect::<Vec<_>>().join(", ")
}

/// Whether a motion dies out without vibrating.
#[must_use]
pub fn is_overdamped(mode: &NaturalMode) -> bool {
    mode.angular_frequency_rad_per_s == 0.0 && mode.growth_per_s < 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stations_and_beams_count_as_their_shaft() {
        let names = ["shaft/0", "shaft/0-1", "wheel", "idler"].map(str::to_owned);
        let found = largest_shares(&names, &[0.3, 0.3, 0.3999, 1e-4], 3);
        assert_eq!(found.len(), 2);
        assert_eq!(found[0].0, "shaft");
        assert!((found[0].1 - 0.6).abs() < 1e-12);
        let words = shares_in_words(&names, &[0.3, 0.3, 0.3999, 1e-4], 3);
        assert_eq!(words, "shaft 60.0 %, wheel 40.0 %");
    }
}
