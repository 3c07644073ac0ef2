//! Topography: material removed at the points of a grid over roll angle and axial place, bilinear between them and held
//! beyond its borders.

/// A table over the flank.
#[derive(Debug, Clone, PartialEq)]
pub struct Topography {
    rolls_rad: Vec<f64>,
    heights_m: Vec<f64>,
    /// `[roll][height]` \[m\].
    removed_m: Vec<f64>,
}

/// Why a grid is none.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum TopographyError {
    /// Fewer than one place in a direction, or a number of values that does not fill the grid.
    #[error("{rolls} places along the profile and {heights} along the axis need {} values, found {found}", rolls * heights)]
    Size {
        /// Places along the profile.
        rolls: usize,
        /// Places along the axis.
        heights: usize,
        /// Values found.
        found: usize,
    },
    /// Places that do not increase.
    #[error("the places must increase from one to the next")]
    Order,
}

impl Topography {
    /// Values `[roll][height]` \[m\] at increasing roll angles \[rad\] and increasing axial places from mid-face \[m\].
    ///
    /// # Errors
    /// [`TopographyError`] for numbers that make no grid.
    pub fn new(
        rolls_rad: Vec<f64>,
        heights_m: Vec<f64>,
        removed_m: Vec<f64>,
    ) -> Result<Self, TopographyError> {
        let (rolls, heights, found) = (rolls_rad.len(), heights_m.len(), removed_m.len());
        if rolls == 0 || heights == 0 || rolls * heights != found {
            return Err(TopographyError::Size {
                rolls,
                heights,
                found,
            });
        }
        let increase = |places: &[f64]| places.windows(2).all(|pair| pair[1] > pair[0]);
        if !increase(&rolls_rad) || !increase(&heights_m) {
            return Err(TopographyError::Order);
        }
        Ok(Self {
            rolls_rad,
            heights_m,
            removed_m,
        })
    }

    /// Material removed \[m\], its derivative by the roll angle \[m/rad\] and along the axis.
    #[must_use]
    pub fn removed(&self, roll_rad: f64, z_m: f64) -> [f64; 3] {
        let (i, u, by_roll) = cell(&self.rolls_rad, roll_rad);
        let (j, v, by_height) = cell(&self.heights_m, z_m);
        let columns = self.heights_m.len();
        let (below, right) = (
            (i + 1).min(self.rolls_rad.len() - 1),
            (j + 1).min(columns - 1),
        );
        let at = |i: usize, j: usize| self.removed_m[i * columns + j];
        let [a, b, c, d] = [at(i, j), at(i, right), at(below, j), at(below, right)];
        let (low, high) = ((1.0 - v) * a + v * b, (1.0 - v) * c + v * d);
        let (first, last) = ((1.0 - u) * a + u * c, (1.0 - u) * b + u * d);
        [
            (1.0 - u) * low + u * high,
            by_roll * (high - low),
            by_height * (last - first),
        ]
    }

    /// The largest and the smallest value \[m\].
    #[must_use]
    pub fn extremes_m(&self) -> [f64; 2] {
        (self.removed_m.iter()).fold([f64::NEG_INFINITY, f64::INFINITY], |[high, low], value| {
            [high.max(*value), low.min(*value)]
        })
    }

    /// Roll angles \[rad\], axial places \[m\] and values \[m\], as [`Topography::new`] takes them.
    #[must_use]
    pub fn parts(&self) -> [&[f64]; 3] {
        [&self.rolls_rad, &self.heights_m, &self.removed_m]
    }

    /// Places along the profile and along the axis.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        [self.rolls_rad.len(), self.heights_m.len()]
    }
}

/// The cell that holds `x`, the share of the way through it, and the share's derivative; held beyond the ends.
fn cell(places: &[f64], x: f64) -> (usize, f64, f64) {
    let last = places.len() - 1;
    let above = places.partition_point(|place| *place <= x);
    if above == 0 {
        return (0, 0.0, 0.0);
    }
    if above > last {
        return (last, 0.0, 0.0);
    }
    let width = places[above] - places[above - 1];
    (above - 1, (x - places[above - 1]) / width, 1.0 / width)
}
