//! Forces on single elements beside the flank grid, `gearmesh compliance --project` on the models of the offline bench:
//! how far apart, and what a contact point costs.

use std::path::Path;

use serde_json::Value;

use super::Bench;

/// Radii of gear 2's flank \[mm\] at which lines stand: between the outermost hats' centroids, away from the ends.
const RADII_MM: [f64; 5] = [73.0, 74.0, 75.0, 76.0, 77.0];

/// Lines of slices on single elements.
#[derive(Debug, Clone)]
pub struct Projected {
    /// Solutions: one a slice of each line.
    pub solutions: f64,
    /// Seconds for them.
    pub solutions_s: f64,
    /// Seconds for the faces under the lines' points and the nodal forces.
    pub projection_s: f64,
    /// Largest difference of the flank grid's mean deflection from theirs, relative.
    pub apart: f64,
}

impl Bench {
    /// Lines on tooth 0 of a reduced gear 2.
    pub(super) fn projected(&self, model: &Path) -> Result<Projected, String> {
        let radii = RADII_MM.map(|radius| radius.to_string()).join(",");
        let mut command = std::process::Command::new(&self.program);
        command.arg("compliance").arg(model).args([
            "--tooth",
            "0",
            "--line-load-N-per-mm",
            "100",
            "--half-width-mm",
            "0.1",
            "--radius-mm",
            &radii,
            "--project",
            "--json",
        ]);
        let (_, told) = self.run(&mut command)?;
        read(&told).ok_or_else(|| "its figures are not those of --project".to_owned())
    }
}

fn read(told: &Value) -> Option<Projected> {
    let projected = &told["projected"];
    let of_rows = |rows: &Value| -> Option<Vec<f64>> {
        let rows = rows.as_array()?.iter();
        rows.map(|row| row["total_m"].as_f64()).collect()
    };
    let pairs = of_rows(&told["rows"])?
        .into_iter()
        .zip(of_rows(&projected["rows"])?);
    let seconds = |of: &str| projected["seconds"][of].as_f64();
    Some(Projected {
        solutions: projected["solutions"].as_f64()?,
        solutions_s: seconds("solutions")?,
        projection_s: seconds("projection")?,
        apart: pairs
            .map(|(grid, p)| (grid / p - 1.0).abs())
            .fold(0.0, f64::max),
    })
}

impl Projected {
    /// In words, beside the loads of the grid, which were solved in so many seconds.
    pub fn words(&self, grid_loads: f64, grid_s: f64) -> String {
        format!(
            "Lines of slices on single elements ([projection](../theory/projection.md)), `gearmesh compliance --project` at {} radii away \
             from the ends of the flank: {} solutions in {:.2} s, {:.1} ms a contact point, of which {:.2} ms find its faces; deflections within {:.3} % of the flank grid's. \
             The grid's {grid_loads} loads took {grid_s:.1} s once, and no contact point takes another.",
            RADII_MM.len(),
            self.solutions,
            self.solutions_s,
            1e3 * (self.solutions_s + self.projection_s) / self.solutions,
            1e3 * self.projection_s / self.solutions,
            100.0 * self.apart
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn figures_are_read_and_told() {
        let row = |total: f64| json!({"total_m": total});
        let told = json!({"rows": [row(1.001), row(2.0)], "projected": {
            "rows": [row(1.0), row(2.001)], "solutions": 10,
            "seconds": {"mesh and factor": 4.0, "projection": 0.02, "solutions": 0.48}}});
        let words = read(&told).map(|found| found.words(342.0, 0.6));
        let words = words.unwrap_or_default();
        assert!(
            words.contains("10 solutions in 0.48 s, 50.0 ms a contact point, of which 2.00 ms"),
            "{words}"
        );
        assert!(words.contains("within 0.100 %"), "{words}");
        assert!(read(&json!({"rows": []})).is_none());
    }
}
