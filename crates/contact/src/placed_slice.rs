//! A place on the profile of a tooth, and how the force of a slice there sits on the stations along the tooth.

use crate::profile_shares::ProfilePlace;
use crate::walked_slice::WalkedSlice;

/// A place on the profile of a tooth, where one or more slices of a contact line stand.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ToothPlace {
    /// Tooth.
    pub tooth: usize,
    /// Place between the stations.
    pub place: ProfilePlace,
    /// What neighbouring slices share of the calibrated correction there \[m/N\], and its derivative by u.
    pub(crate) shared: (f64, f64),
    /// Tooth of the sector, whose flanks are stored, that this one repeats, and by how many teeth the sector is turned.
    pub(crate) in_sector: (usize, usize),
    /// Where along the tooth the slice stands, if not in its own middle.
    pub(crate) walked: Option<WalkedSlice>,
}

impl ToothPlace {
    /// Tooth of the sector that is stored for this place, and the tooth of so many `teeth` that stands to it as `other`
    /// stands to this place's own.
    #[inline(always)]
    pub(crate) fn with_response(&self, other: usize, teeth: usize) -> (usize, usize) {
        let (tooth, turned) = self.in_sector;
        let response = other + teeth - turned;
        let response = if response < teeth {
            response
        } else {
            response - teeth
        };
        (tooth, response)
    }
}

/// Share of a slice's force on the middle of each of its neighbours.
///
/// A slice has axial stations at its edges and its middle. Equal forces on all slices make a uniform load whenever the
/// edges carry ¼ each and a station in the middle ½ in sum over the slices. One share is left free: −1/24 on the
/// neighbours' middles gives a slice's force the second moment w²/12 of a load that is uniform on it, w its width, and
/// an edge slice the first. Without (¼, ½, ¼) it would be a triangle two slices wide with twice that moment.
const ON_NEIGHBOUR: f64 = -1.0 / 24.0;

/// Shares of the force on `slice` of `slices`, as (axial station, share). They add up to one.
pub fn axial_shares(slice: usize, slices: usize) -> impl Iterator<Item = (usize, f64)> + Clone {
    let below = (slice > 0).then(|| (2 * slice - 1, ON_NEIGHBOUR));
    let above = (slice + 1 < slices).then_some((2 * slice + 3, ON_NEIGHBOUR));
    let neighbours = usize::from(below.is_some()) + usize::from(above.is_some());
    let own = [
        (2 * slice, 0.25),
        (2 * slice + 1, 0.5 - ON_NEIGHBOUR * neighbours as f64),
        (2 * slice + 2, 0.25),
    ];
    below.into_iter().chain(own).chain(above)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Density of a slice's unit force at the stations, slices one unit wide: a hat of one newton is 2 high, at the
    /// faces 4.
    fn density(slice: usize, slices: usize) -> Vec<f64> {
        let mut density = vec![0.0; 2 * slices + 1];
        for (station, share) in axial_shares(slice, slices) {
            let face = station == 0 || station == 2 * slices;
            density[station] += share * if face { 4.0 } else { 2.0 };
        }
        density
    }

    #[test]
    fn equal_slice_forces_make_a_uniform_load() {
        for slices in [1, 2, 3, 7] {
            let mut sum = vec![0.0; 2 * slices + 1];
            for slice in 0..slices {
                let total: f64 = axial_shares(slice, slices).map(|(_, share)| share).sum();
                assert!((total - 1.0).abs() < 1e-15);
                for (s, d) in sum.iter_mut().zip(density(slice, slices)) {
                    *s += d;
                }
            }
            assert!(sum.iter().all(|s| (s - 1.0).abs() < 1e-14), "{sum:?}");
        }
    }

    /// Moment of a slice's unit force about its middle, slices one unit wide: an inner hat has the variance 1/24 about
    /// its station, half a hat its centroid 1/6 inside and the variance 1/72 about it.
    fn moment(slice: usize, slices: usize, power: i32) -> f64 {
        axial_shares(slice, slices)
            .map(|(station, share)| {
                let z = 0.5 * station as f64 - slice as f64 - 0.5;
                let inwards = match station {
                    0 => 1.0,
                    s if s == 2 * slices => -1.0,
                    _ => 0.0,
                };
                let centroid: f64 = z + inwards / 6.0;
                let variance = if inwards == 0.0 {
                    1.0 / 24.0
                } else {
                    1.0 / 72.0
                };
                share
                    * match power {
                        1 => centroid,
                        _ => centroid * centroid + variance,
                    }
            })
            .sum()
    }

    #[test]
    fn a_slice_force_has_the_moments_of_a_uniform_load() {
        for slices in [2, 3, 7] {
            for slice in 0..slices {
                assert!(
                    moment(slice, slices, 1).abs() < 1e-15,
                    "{slice} of {slices}"
                );
                if slice > 0 && slice + 1 < slices {
                    let second = moment(slice, slices, 2);
                    assert!((second - 1.0 / 12.0).abs() < 1e-15, "{second}");
                }
            }
        }
    }
}
