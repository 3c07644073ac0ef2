//! How a strain over the driver's angle is shown.

use gearmesh_scene::{SceneResult, StrainSeries};

/// How a strain with one peak is shown: one period of its own begins half a period before the peak, so that the peak is
/// never cut in two; angles before the run's first one count as negative. Less than a period is shown as it is.
pub(crate) struct PeakView {
    /// Positions shown: one period, or all.
    shown: usize,
    first: usize,
    peak: usize,
    period_deg: f64,
}

impl PeakView {
    pub(crate) fn of(r: &SceneResult, series: &StrainSeries, curve: &[f64]) -> Self {
        let period = series.coverage.period_pitches * r.points_per_pitch();
        let shown = if series.coverage.is_whole() {
            period
        } else {
            curve.len()
        };
        let peak = (0..shown)
            .max_by(|a, b| curve[*a].abs().total_cmp(&curve[*b].abs()))
            .unwrap_or(0);
        let first = if shown == period {
            (peak + shown / 2) % shown
        } else {
            0
        };
        let step_rad = match r.angle_rad[..] {
            [first, second, ..] => second - first,
            _ => 0.0,
        };
        Self {
            shown,
            first,
            peak,
            period_deg: period as f64 * step_rad.to_degrees(),
        }
    }

    pub(crate) fn turned(&self, values: &[f64]) -> Vec<f64> {
        [&values[self.first..self.shown], &values[..self.first]].concat()
    }

    fn angle_deg(&self, r: &SceneResult, index: usize) -> f64 {
        let before = self.first > 0 && index >= self.first && self.peak < self.first;
        let after = self.first > 0 && index < self.first && self.peak >= self.first;
        r.angle_rad[index].to_degrees() + self.period_deg * (f64::from(after) - f64::from(before))
    }

    pub(crate) fn angles_deg(&self, r: &SceneResult) -> Vec<f64> {
        (0..self.shown)
            .map(|k| self.angle_deg(r, (self.first + k) % self.shown))
            .collect()
    }

    pub(crate) fn peak_deg(&self, r: &SceneResult) -> f64 {
        self.angle_deg(r, self.peak)
    }

    /// What a chart shows at first of a long view: 40 degrees about the peak, the run-up and run-out of a tooth.
    pub(crate) fn window_deg(&self, r: &SceneResult) -> Option<[f64; 2]> {
        let (low, high) = self.range_deg(r);
        // Not so for angles of a file that are no numbers in degrees.
        (high - low > 60.0).then(|| {
            let from = (self.peak_deg(r) - 20.0).clamp(low, high - 40.0);
            [from, from + 40.0]
        })
    }

    pub(crate) fn range_deg(&self, r: &SceneResult) -> (f64, f64) {
        let last = (self.first + self.shown - 1) % self.shown;
        (self.angle_deg(r, self.first), self.angle_deg(r, last))
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use gearmesh_scene::periods::Coverage;

    /// Driver of 23 teeth, ten points a pitch, strain of a wheel of 47 teeth with its peak at the first point.
    fn view(pitches: usize) -> (PeakView, SceneResult, Vec<f64>) {
        let points = 10;
        let angle = |k: usize| k as f64 * 360.0 / 23.0 / points as f64;
        let strain: Vec<f64> = (0..pitches * points)
            .map(|k| f64::from(u8::from(k % (47 * points) == 0)) + 1e-3)
            .collect();
        let r = SceneResult {
            pitches,
            angle_rad: (0..strain.len()).map(|k| angle(k).to_radians()).collect(),
            ..SceneResult::default()
        };
        let series = StrainSeries {
            gear: 2,
            name: "g".into(),
            error_estimate_relative: 0.0,
            coverage: Coverage::of_contact(47, pitches),
            method_1: Vec::new(),
            method_2: strain.clone(),
            between: Default::default(),
        };
        (PeakView::of(&r, &series, &strain), r, strain)
    }

    /// A revolution of the driver is 23 pitches: the wheel's strain is not joined to itself there.
    #[test]
    fn less_than_the_wheels_revolution_is_shown_as_it_is() {
        let (view, r, strain) = view(23);
        assert_eq!(view.turned(&strain), strain);
        assert_eq!(view.angles_deg(&r)[0], 0.0);
    }

    /// Found by fuzzing: a result whose angles are finite in radians only.
    #[test]
    fn angles_beyond_numbers_have_no_window() {
        let (view, mut r, _) = view(47);
        assert!(view.window_deg(&r).is_some());
        r.angle_rad.fill(f64::MAX);
        assert_eq!(view.window_deg(&r), None);
    }

    #[test]
    fn the_wheels_revolution_is_joined_and_no_more_is_shown() {
        for pitches in [47, 60] {
            let (view, r, strain) = view(pitches);
            let (angles, turned) = (view.angles_deg(&r), view.turned(&strain));
            assert_eq!((angles.len(), turned.len()), (470, 470));
            assert!(angles.windows(2).all(|w| w[1] > w[0]));
            assert_eq!(turned[235], 1.001);
            assert!(angles[235].abs() < 1e-9 && view.peak_deg(&r).abs() < 1e-9);
            let (low, high) = view.range_deg(&r);
            assert!((low + 23.5 * 360.0 / 23.0).abs() < 1e-9, "{low}");
            assert!((high - 23.4 * 360.0 / 23.0).abs() < 1e-9, "{high}");
        }
    }
}
