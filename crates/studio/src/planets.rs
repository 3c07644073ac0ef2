//! How the planets of a set share its load, over the turn of the carrier.

use gearmesh_report::min_max;
use serde_json::{Value, json};

use crate::columns::{ColumnsSession, StretchAsked};
use crate::problem::Problem;

impl ColumnsSession {
    /// The shares of all planetary sets in a stretch, by their least and largest values. Where the carrier stands, or
    /// turns back, they are over what the rows run over.
    ///
    /// # Errors
    /// [`Problem`] for a result that cannot be read.
    pub fn planets(&self, asked: &StretchAsked) -> Result<Value, Problem> {
        let stretch = self.stretch([asked.from, asked.to]);
        let rows: Vec<usize> = stretch.clone().collect();
        let found = self.locked()?.planet_shares(&rows)?;
        let sets = found.into_iter().map(|of| {
            let turned = of.carrier_rad.and_then(|turn| over_turn(&turn));
            let (x, over) = match turned {
                Some(degrees) => (degrees, "turn of the carrier °".to_owned()),
                None => (self.axis()[stretch.clone()].to_vec(), self.axis_words()),
            };
            let curves = |shares: Option<Vec<Vec<f64>>>| {
                let most = shares
                    .iter()
                    .flatten()
                    .flatten()
                    .copied()
                    .fold(0.0, f64::max);
                let curves = shares.map(|shares| {
                    let drawn = shares.iter().map(|own| min_max::values(own));
                    drawn.collect::<Vec<_>>()
                });
                json!({"curves": curves, "largest": most})
            };
            json!({
                "name": of.set.name,
                "planets": of.set.planets,
                "over": over,
                "x": min_max::abscissas(&x),
                "sun": curves(of.sun),
                "ring": curves(of.ring),
            })
        });
        Ok(json!({"sets": sets.collect::<Vec<_>>(), "rows": rows.len()}))
    }
}

/// The turn from the first row on \[°\], whichever way it goes; none where it does not go on in every row.
fn over_turn(turn_rad: &[f64]) -> Option<Vec<f64>> {
    let first = *turn_rad.first()?;
    let degrees: Vec<f64> = (turn_rad.iter())
        .map(|turn| (turn - first).to_degrees().abs())
        .collect();
    let rises = degrees.len() > 1 && degrees.windows(2).all(|w| w[1] > w[0]);
    rises.then_some(degrees)
}

#[cfg(test)]
mod tests {
    use super::over_turn;

    #[test]
    fn a_carrier_that_stands_or_turns_back_is_no_axis() {
        let close = |found: Option<Vec<f64>>, wanted: &[f64]| {
            let found = found.unwrap_or_default();
            found.len() == wanted.len()
                && found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-9)
        };
        let half = std::f64::consts::PI;
        assert!(close(
            over_turn(&[1.0, 1.0 - half, 1.0 - 2.0 * half]),
            &[0.0, 180.0, 360.0]
        ));
        assert_eq!(over_turn(&[1.0, 1.0, 2.0]), None);
        assert_eq!(over_turn(&[0.0, 2.0, 1.0]), None);
        assert_eq!(over_turn(&[0.0]), None);
    }
}
