//! A smooth function through points.

/// Cubic Hermite pieces between places; the slope at a place is that of the parabola through it and its neighbours
/// (one-sided at the ends). Two places or more.
#[derive(Debug, Clone, PartialEq)]
pub struct SmoothCurve {
    places: Vec<f64>,
    values: Vec<f64>,
    /// Slope at each place.
    slopes: Vec<f64>,
}

impl SmoothCurve {
    /// Through values at places, which increase.
    #[must_use]
    pub fn new(places: Vec<f64>, values: Vec<f64>) -> Self {
        let last = values.len() - 1;
        let secant = |k: usize| (values[k + 1] - values[k]) / (places[k + 1] - places[k]);
        let slope = |k: usize| {
            if last == 1 {
                return secant(0);
            }
            // The parabola through three neighbours; its slope at any of them.
            let first = k.saturating_sub(1).min(last - 2);
            let (a, b) = (secant(first), secant(first + 1));
            let bend = (b - a) / (places[first + 2] - places[first]);
            a + bend * (2.0 * places[k] - places[first] - places[first + 1])
        };
        let slopes = (0..=last).map(slope).collect();
        Self {
            places,
            values,
            slopes,
        }
    }

    /// The piece that a place belongs to, which begins at the last of `places` not beyond it; those at the ends go on.
    #[must_use]
    pub fn piece(places: &[f64], place: f64) -> usize {
        let behind = places.partition_point(|other| *other <= place);
        behind.clamp(1, places.len() - 1) - 1
    }

    /// Value and slope at a place by the k-th piece. No allocation.
    ///
    /// # Panics
    /// If there is no such piece.
    #[must_use]
    pub fn in_piece(&self, k: usize, place: f64) -> [f64; 2] {
        let length = self.places[k + 1] - self.places[k];
        let t = (place - self.places[k]) / length;
        let (u, from) = (1.0 - t, self.values[k]);
        let rise = self.values[k + 1] - from;
        // Linear part, and what bends it to the two slopes.
        let low = self.slopes[k] * length - rise;
        let high = self.slopes[k + 1] * length - rise;
        [
            from + t * rise + t * u * (u * low - t * high),
            (rise + low * u * (u - 2.0 * t) - high * t * (2.0 * u - t)) / length,
        ]
    }

    /// Value and slope at a place.
    #[must_use]
    pub fn at(&self, place: f64) -> [f64; 2] {
        self.in_piece(Self::piece(&self.places, place), place)
    }
}
