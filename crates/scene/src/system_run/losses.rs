//! Power that friction takes in a run, part by part: teeth whose friction is named, bearings with `[friction]`.

use gearmesh_model::FileError;

use super::column_statistics::Figures;
use super::result::SystemResult;
use super::result_kind::ResultKind;

/// End of the columns that hold a power loss.
const FRICTION: &str = "/friction_power_W";

/// End of the columns that hold the power through a mesh.
const THROUGH: &str = "/power_W";

/// Power that a part loses, mean over the rows of a result.
#[derive(Debug, Clone, PartialEq)]
pub struct PowerLoss {
    /// The part, as its columns are named.
    pub part: String,
    /// \[W\].
    pub mean_w: f64,
    /// Power that goes through it, of meshes \[W\].
    pub through_w: Option<f64>,
}

impl PowerLoss {
    /// Share of the power through it that comes out, of meshes that transmit any.
    #[must_use]
    pub fn efficiency(&self) -> Option<f64> {
        let through_w = self.through_w.filter(|power| *power > self.mean_w)?;
        Some(1.0 - self.mean_w / through_w)
    }
}

/// All parts that lose power.
#[derive(Debug, Clone, PartialEq)]
pub struct PowerLosses {
    /// Part by part, in the order of the columns.
    pub parts: Vec<PowerLoss>,
}

impl PowerLosses {
    /// Of all parts \[W\].
    #[must_use]
    pub fn total_w(&self) -> f64 {
        self.parts.iter().map(|part| part.mean_w).sum()
    }

    /// The largest power through one of the meshes \[W\].
    #[must_use]
    pub fn through_w(&self) -> Option<f64> {
        let through = self.parts.iter().filter_map(|part| part.through_w);
        through.max_by(f64::total_cmp)
    }

    /// 1 − total/(largest power through a mesh): that of a gearbox whose power goes through one mesh after the other.
    #[must_use]
    pub fn efficiency(&self) -> Option<f64> {
        let (through_w, total_w) = (self.through_w()?, self.total_w());
        (through_w > total_w).then(|| 1.0 - total_w / through_w)
    }
}

impl SystemResult {
    /// Losses of a run in time or of a series of equilibria, means over its rows; none where no part names friction.
    ///
    /// # Errors
    /// [`FileError`].
    pub fn power_losses(&self) -> Result<Option<PowerLosses>, FileError> {
        if !matches!(self.kind, ResultKind::Transient | ResultKind::Static) {
            return Ok(None);
        }
        let mean = |name: &str| Ok::<_, FileError>(Figures::of(&self.rows.read(name)?).mean);
        let mut parts = Vec::new();
        for column in self.rows.columns() {
            let Some(part) = column.name.strip_suffix(FRICTION) else {
                continue;
            };
            let through = format!("{part}{THROUGH}");
            let has = self.rows.columns().iter().any(|c| c.name == through);
            parts.push(PowerLoss {
                part: part.to_owned(),
                mean_w: mean(&column.name)?,
                through_w: has.then(|| mean(&through)).transpose()?.map(f64::abs),
            });
        }
        Ok((!parts.is_empty()).then_some(PowerLosses { parts }))
    }
}
