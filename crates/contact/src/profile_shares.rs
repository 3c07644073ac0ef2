//! How a force at a place along the profile is shared by the hats of the stations.
//!
//! A hat is some tenths of a module wide, the true pressure next to nothing. What is narrower than a hat is the local
//! term's affair; but the rest of the deflection, the bending of the tooth and the turn of its foot, is smooth over a
//! hat, and a load spread over a width averages it: with the variance σ² of the spread load a smooth compliance D(ξ,
//! ξ') is read as D + ½σ²(D_ξξ + D_ξ'ξ'), some tenths of a per cent too soft. The shares Φ therefore keep the force,
//! its first moment *and* its second one, which is zero. With centroids c_i and variances v_i of the hats and ξ between
//! c_i and c_{i+1}:
//!
//! ```text
//! Φ = (1−t) e_i + t e_{i+1} − V [(1−t) β_i + t β_{i+1}],     t = (ξ − c_i)/(c_{i+1} − c_i)
//! V = (1−t)(v_i + (c_i − ξ)²) + t (v_{i+1} + (c_{i+1} − ξ)²)
//! ```
//!
//! β_i is the second difference over station i and its neighbours: no force, no first moment, second moment one. It is
//! continuous in ξ. At the outermost stations β is that of their inner neighbours. Beyond the outermost centroids the
//! same rule is extrapolated: at the very edge of the flank the last stations have shares of some 0.2, −1.1, 1.8.
//!
//! Hats are taken over the flank's area, as the loads are: dA = a(u) du per width, on an involute flank, whose u is the
//! roll angle ξ, r_b ξ dξ.

/// Stations that share a force at most.
pub const SHARES: usize = 4;

/// The hats of the stations along a profile: their moments in u.
#[derive(Debug, Clone, PartialEq)]
pub struct ProfileHats {
    centroids: Vec<f64>,
    /// u².
    variances: Vec<f64>,
    /// β of stations 1, 2, ..., n − 2 as shares of the station's left neighbour, itself and the right one per u².
    second_differences: Vec<[f64; 3]>,
}

/// A place between two hats' centroids and the shares of a force there.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ProfilePlace {
    /// Lower station.
    pub station: usize,
    /// Share of the station above it in the linear interpolation between the two; may lie a little outside 0 to 1
    /// beyond the outermost centroids.
    pub share: f64,
    /// First of the stations that have shares, and their shares.
    first: usize,
    shares: [f64; SHARES],
    /// How the shares change with u per u.
    rates: [f64; SHARES],
}

impl ProfilePlace {
    /// Stations with their shares of a force, which add up to one.
    pub fn shares(&self) -> impl Iterator<Item = (usize, f64)> + Clone {
        let first = self.first;
        let shares = self.shares.into_iter().enumerate();
        shares
            .map(move |(k, share)| (first + k, share))
            .filter(|(_, share)| *share != 0.0)
    }

    /// Stations with the derivatives of their shares by u per u, which add up to zero. Where one hat hands over to the
    /// next it is the derivative of the side above.
    pub fn rates(&self) -> impl Iterator<Item = (usize, f64)> + Clone {
        let first = self.first;
        let rates = self.rates.into_iter().enumerate();
        rates
            .map(move |(k, rate)| (first + k, rate))
            .filter(|(_, rate)| *rate != 0.0)
    }

    /// First of the stations of [`Self::all_shares`].
    pub(crate) fn first(&self) -> usize {
        self.first
    }

    /// Shares of the stations from [`Self::first`] on, zeros included.
    pub(crate) fn all_shares(&self) -> &[f64; SHARES] {
        &self.shares
    }

    /// Their derivatives.
    pub(crate) fn all_rates(&self) -> &[f64; SHARES] {
        &self.rates
    }
}

impl ProfileHats {
    /// The hats of at least two stations of an involute flank, given by their roll angles.
    pub fn of_involute(stations_rad: &[f64]) -> Self {
        Self::new(stations_rad, |roll_rad| roll_rad)
    }

    /// The hats of at least two stations; `area`: the flank's area per width and u, up to a factor.
    pub fn new(stations: &[f64], area: impl Fn(f64) -> f64) -> Self {
        let moments: Vec<[f64; 3]> = (0..stations.len())
            .map(|i| hat_moments(stations, &area, i))
            .collect();
        let centroids: Vec<f64> = moments.iter().map(|m| m[1] / m[0]).collect();
        let variances: Vec<f64> = moments
            .iter()
            .zip(&centroids)
            .map(|(m, c)| m[2] / m[0] - c * c)
            .collect();
        let second_differences = centroids
            .windows(3)
            .zip(variances.windows(3))
            .map(|(c, v)| {
                let difference: [f64; 3] = std::array::from_fn(|k| {
                    let others = (0..3).filter(|j| *j != k);
                    1.0 / others.map(|j| c[k] - c[j]).product::<f64>()
                });
                // Of the centroids alone the second moment is one.
                let moment = 1.0 + (0..3).map(|k| difference[k] * v[k]).sum::<f64>();
                difference.map(|d| d / moment)
            })
            .collect();
        Self {
            centroids,
            variances,
            second_differences,
        }
    }

    /// Places of the hats' centroids.
    pub fn centroids(&self) -> &[f64] {
        &self.centroids
    }

    /// Where a place lies between the stations, and the shares of a force there.
    pub fn place(&self, u: f64) -> ProfilePlace {
        let c = &self.centroids;
        let n = c.len();
        let station = c.partition_point(|c| *c <= u).clamp(1, n - 1) - 1;
        let (low, high) = (c[station], c[station + 1]);
        let share = (u - low) / (high - low);
        let first = station.saturating_sub(1).min(n.saturating_sub(4));
        let (mut shares, mut rates) = ([0.0; SHARES], [0.0; SHARES]);
        let per_u = 1.0 / (high - low);
        shares[station - first] = 1.0 - share;
        shares[station + 1 - first] += share;
        rates[station - first] = -per_u;
        rates[station + 1 - first] += per_u;
        if n > 2 {
            let t = share;
            let spread = |i: usize| self.variances[i] + (c[i] - u).powi(2);
            let (below, above) = (spread(station), spread(station + 1));
            let variance = (1.0 - t) * below + t * above;
            let widens = (above - below) * per_u + 2.0 * ((1.0 - t) * (u - low) - t * (high - u));
            for (at, weight, turn) in [(station, 1.0 - t, -per_u), (station + 1, t, per_u)] {
                let middle = at.clamp(1, n - 2);
                for (k, value) in self.second_differences[middle - 1].iter().enumerate() {
                    let slot = middle - 1 + k - first;
                    shares[slot] -= variance * weight * value;
                    rates[slot] -= (widens * weight + variance * turn) * value;
                }
            }
        }
        ProfilePlace {
            station,
            share,
            first,
            shares,
            rates,
        }
    }
}

/// ∫ h_i u^p a du of the hat of station i, p = 0, 1, 2.
fn hat_moments(stations: &[f64], area: impl Fn(f64) -> f64, i: usize) -> [f64; 3] {
    // Gauss's rule with three points: exact to degree 5, the integrand of an involute flank has 4.
    let offset = (0.6_f64).sqrt();
    let mut moments = [0.0; 3];
    let below = i.checked_sub(1).map(|j| stations[j]);
    for neighbour in below.into_iter().chain(stations.get(i + 1).copied()) {
        let half = 0.5 * (stations[i] - neighbour);
        for (at, weight) in [(-offset, 5.0 / 9.0), (0.0, 8.0 / 9.0), (offset, 5.0 / 9.0)] {
            let xi = neighbour + half * (1.0 + at);
            let hat = 0.5 * (1.0 + at);
            for (p, moment) in moments.iter_mut().enumerate() {
                *moment += half.abs() * weight * hat * area(xi) * xi.powi(p as i32);
            }
        }
    }
    moments
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stations(n: usize) -> Vec<f64> {
        (0..n)
            .map(|i| 0.2 + 0.3 * i as f64 / (n - 1) as f64)
            .collect()
    }

    /// ∫ f over the load of a unit force at a roll angle, by fine sums over the hats.
    fn read(stations: &[f64], roll: f64, f: impl Fn(f64) -> f64) -> f64 {
        let hats = ProfileHats::of_involute(stations);
        let steps = 4000;
        hats.place(roll)
            .shares()
            .map(|(i, share)| {
                let (mut force, mut sum) = (0.0, 0.0);
                for pair in stations.windows(2) {
                    for k in 0..steps {
                        let t = (f64::from(k) + 0.5) / f64::from(steps);
                        let xi = pair[0] + t * (pair[1] - pair[0]);
                        let hat = match stations[i] {
                            s if s == pair[0] => 1.0 - t,
                            s if s == pair[1] => t,
                            _ => 0.0,
                        };
                        force += hat * xi;
                        sum += hat * xi * f(xi);
                    }
                }
                share * sum / force
            })
            .sum()
    }

    #[test]
    fn share_rates_are_the_slopes_of_the_shares() {
        let hats = ProfileHats::of_involute(&stations(9));
        let c = hats.centroids();
        for k in 0..=40 {
            // Beyond the outermost centroids, between them and on them.
            let roll = c[0] - 0.01 + (c[8] - c[0] + 0.02) * f64::from(k) / 40.0;
            let place = hats.place(roll);
            let sum: f64 = place.rates().map(|(_, rate)| rate).sum();
            let moment: f64 = place.rates().map(|(i, rate)| rate * c[i]).sum();
            // No force appears, and its place moves with the roll angle.
            assert!(
                sum.abs() < 1e-10 && (moment - 1.0).abs() < 1e-10,
                "{sum} {moment}"
            );
            let dense = |place: &ProfilePlace| {
                let mut all = [0.0; 9];
                place.shares().for_each(|(i, share)| all[i] += share);
                all
            };
            let step = 1e-7;
            let [after, before] = [step, -step].map(|s| dense(&hats.place(roll + s)));
            let mut found = [0.0; 9];
            place.rates().for_each(|(i, rate)| found[i] += rate);
            let at_kink = c.iter().any(|c| (c - roll).abs() < 2.0 * step);
            for i in 0..9 {
                let difference = (after[i] - before[i]) / (2.0 * step);
                let close = (difference - found[i]).abs() < 1e-5 * (1.0 + difference.abs());
                assert!(at_kink || close, "{roll} {i}: {difference} {}", found[i]);
            }
        }
    }

    #[test]
    fn a_load_reads_every_parabola_at_its_place() {
        for n in [3, 4, 5, 9] {
            let stations = stations(n);
            let hats = ProfileHats::of_involute(&stations);
            // From end to end, beyond the outermost centroids, too.
            let (low, high) = (stations[0], stations[n - 1]);
            for k in 0..=20 {
                let roll = low + (high - low) * f64::from(k) / 20.0;
                let total: f64 = hats.place(roll).shares().map(|(_, share)| share).sum();
                assert!((total - 1.0).abs() < 1e-12);
                let found = read(&stations, roll, |x| 1.0 - 3.0 * x + 5.0 * x * x);
                let exact = 1.0 - 3.0 * roll + 5.0 * roll * roll;
                assert!((found - exact).abs() < 1e-7, "{n} {roll}: {found} {exact}");
            }
        }
    }

    #[test]
    fn shares_are_continuous() {
        let hats = ProfileHats::of_involute(&stations(9));
        let dense = |roll: f64| {
            let mut all = [0.0; 9];
            hats.place(roll).shares().for_each(|(i, s)| all[i] += s);
            all
        };
        let mut last = dense(0.2);
        for k in 1..=3000 {
            let next = dense(0.2 + 0.3 * f64::from(k) / 3000.0);
            for (a, b) in last.iter().zip(next) {
                assert!((a - b).abs() < 0.03);
            }
            last = next;
        }
    }

    #[test]
    fn two_stations_share_linearly() {
        let hats = ProfileHats::of_involute(&[0.2, 0.4]);
        let place = hats.place(0.3);
        let shares: Vec<_> = place.shares().collect();
        assert_eq!(shares, [(0, 1.0 - place.share), (1, place.share)]);
    }
}
