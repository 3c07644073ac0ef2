//! Columns of a multibody run in time against a reference record: brought to the angle of the record's shaft, averaged
//! over as many of the record's lengths as the run has, then as a rig would show it.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use gearmesh_model::FileError;
use gearmesh_scene::system_run::{MeshRecord, ResultKind, SystemResult};
use gearmesh_signal::{AngleSeries, Resampler, SeriesError, synchronous_average};

use crate::comparison::{ComparisonError, RigView, SeriesComparison, compare_with_column};
use crate::pair_orders::{PairOrders, Shaft};
use crate::quantity::Quantity;
use crate::record::{RecordColumn, ReferenceRecord};
use crate::scene_comparison::compared_orders;

/// Columns named in a message at most.
const NAMED: usize = 12;

/// Fewest and most samples in a turn that the rows of a result may give.
const SAMPLES_PER_TURN: std::ops::RangeInclusive<f64> = 8.0..=1e6;

/// Why a multibody result cannot be compared with a record.
#[derive(Debug, thiserror::Error)]
pub enum SystemComparisonError {
    /// Not a run in time.
    #[error("found a result of kind `{found}`; records are compared with `transient` runs")]
    Kind {
        /// Its kind.
        found: ResultKind,
    },
    /// Nothing says what to compare.
    #[error(
        "nothing says which columns of the result belong to the record's; name them in record.toml, [columns], or with --column HEAD=COLUMN; the record has: {heads}"
    )]
    NoColumns {
        /// Columns of the record.
        heads: String,
    },
    /// A column that the record does not have.
    #[error("data.csv of the record has no column `{head}`; it has: {heads}")]
    NoHead {
        /// Asked for.
        head: String,
        /// Columns of the record.
        heads: String,
    },
    /// A column that the result does not have.
    #[error(
        "the result has no column `{column}`; it has {all}, among them: {some} (`gearmesh signal columns` lists them)"
    )]
    NoColumn {
        /// Asked for.
        column: String,
        /// Number of columns.
        all: usize,
        /// Some of them.
        some: String,
    },
    /// A column of another quantity.
    #[error(
        "column `{column}` of the result is in `{found}`; `{head}` of the record needs {needed}"
    )]
    Unit {
        /// Column of the result.
        column: String,
        /// Its unit.
        found: String,
        /// Column of the record.
        head: String,
        /// What is needed.
        needed: &'static str,
    },
    /// A column that belongs to no gear mesh, so that no shaft is known.
    #[error(
        "column `{column}` is no channel of a gear mesh (elements/MESH/...); the meshes are: {meshes}"
    )]
    NoMesh {
        /// Column of the result.
        column: String,
        /// Names of the meshes.
        meshes: String,
    },
    /// The shaft does not turn one way.
    #[error("`{body}` stands still or turns back at {time_s} s; begin later with --from-s")]
    TurnsBack {
        /// The body on the record's shaft.
        body: String,
        /// Where.
        time_s: f64,
    },
    /// Rows too far apart, or by far too near.
    #[error(
        "the rows give {found:.1} samples in a turn of `{body}`; needed are {least} to {most}: change output.interval_s of the scene"
    )]
    SamplesPerTurn {
        /// The body on the record's shaft.
        body: String,
        /// Samples in a turn.
        found: f64,
        /// Fewest.
        least: f64,
        /// Most.
        most: f64,
    },
    /// The run is too short.
    #[error(
        "from {from_s} s on the run has {found:.2} revolutions of `{body}`, the ends that resampling needs left out; the record repeats after {revolutions}: lengthen run.end_s, or begin earlier with --from-s"
    )]
    TooShort {
        /// First time that counts.
        from_s: f64,
        /// Revolutions found.
        found: f64,
        /// The body on the record's shaft.
        body: String,
        /// Revolutions of the record.
        revolutions: usize,
    },
    /// A time outside the run.
    #[error("--from-s: found {found}, allowed is 0 to below {end_s}, the end of the run")]
    From {
        /// Asked for.
        found: f64,
        /// End of the run.
        end_s: f64,
    },
    /// The result cannot be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// The column cannot be brought to the shaft's angle, or its average is no periodic series.
    #[error("column `{column}`: {source}")]
    Series {
        /// Column of the result.
        column: String,
        /// Why.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// The pipeline failed.
    #[error(transparent)]
    Comparison(#[from] ComparisonError),
}

/// What of a run is compared, and from where its angles count.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SystemSelection {
    /// Columns of the result by columns of the record; over those that the record names.
    pub columns: BTreeMap<String, String>,
    /// First time that counts \[s\]; the middle of the run where not given.
    pub from_s: Option<f64>,
    /// Angle of the record at the start of the run \[rad\]: bodies count their turns from there.
    pub start_angle_rad: f64,
}

/// Compares the columns of a run with those of a record that belong to them.
///
/// # Errors
/// [`SystemComparisonError`].
pub fn compare_system(
    result: &SystemResult,
    record: &ReferenceRecord,
    selection: &SystemSelection,
) -> Result<Vec<SeriesComparison>, SystemComparisonError> {
    if result.kind != ResultKind::Transient {
        let found = result.kind;
        return Err(SystemComparisonError::Kind { found });
    }
    let mut columns = record.multibody_columns.clone();
    columns.extend(selection.columns.clone());
    let heads = || {
        let heads: Vec<&str> = record.columns.iter().map(|c| c.name.as_str()).collect();
        heads.join(", ")
    };
    if columns.is_empty() {
        return Err(SystemComparisonError::NoColumns { heads: heads() });
    }
    let mut comparisons = Vec::new();
    for (head, column) in &columns {
        let of_record = record.columns.iter().find(|c| c.name == *head);
        let of_record = of_record.ok_or_else(|| SystemComparisonError::NoHead {
            head: head.clone(),
            heads: heads(),
        })?;
        comparisons.push(compared(result, record, (of_record, column), selection)?);
    }
    Ok(comparisons)
}

fn compared(
    result: &SystemResult,
    record: &ReferenceRecord,
    (of_record, column): (&RecordColumn, &str),
    selection: &SystemSelection,
) -> Result<SeriesComparison, SystemComparisonError> {
    let factor = si_factor(result, of_record, column)?;
    let mesh = mesh_of(result, column)?;
    let body = match record.shaft {
        Shaft::Gear1 => &mesh.bodies[0],
        Shaft::Gear2 => &mesh.bodies[1],
    };
    let interval_s = result.interval_s()?;
    let rows = result.rows.rows();
    let end_s = rows.saturating_sub(1) as f64 * interval_s;
    let from_s = selection.from_s.unwrap_or(0.5 * end_s);
    if !(0.0..end_s).contains(&from_s) {
        let found = from_s;
        return Err(SystemComparisonError::From { found, end_s });
    }
    let first = (from_s / interval_s).round() as usize;
    let read = |name: &str| Ok::<_, SystemComparisonError>(known(result, name)?[first..].to_vec());
    let values: Vec<f64> = read(column)?.iter().map(|v| v * factor).collect();
    let mut turns = read(&format!("bodies/{body}/turn_rad"))?;
    // A shaft's angle is positive in its own sense of turning.
    if turns.last() < turns.first() {
        turns.iter_mut().for_each(|angle| *angle = -*angle);
    }
    if let Some(row) = turns.windows(2).position(|pair| pair[1] <= pair[0]) {
        return Err(SystemComparisonError::TurnsBack {
            body: body.clone(),
            time_s: (first + row) as f64 * interval_s,
        });
    }
    let turned = turns.iter().map(|turn| turn + selection.start_angle_rad);
    let turned: Vec<f64> = turned.collect();
    let run = RunOnShaft {
        column,
        body,
        from_s,
        values: &values,
        turns_rad: &turned,
    };
    let ours = run.average(record.revolutions)?;
    let pair = PairOrders {
        teeth: mesh.teeth,
        openings: [0, 0],
    };
    let orders = match of_record.quantity {
        Quantity::TransmissionError => compared_orders(&pair, record.shaft, record.revolutions),
        Quantity::Strain { .. } => Vec::new(),
    };
    let view = RigView::of(&pair, record.shaft, record.revolutions, orders);
    Ok(compare_with_column(&ours, record, of_record, &view)?)
}

/// Factor that brings a column of the result to SI units.
fn si_factor(
    result: &SystemResult,
    of_record: &RecordColumn,
    column: &str,
) -> Result<f64, SystemComparisonError> {
    known(result, column)?;
    let mut columns = result.rows.columns().iter();
    let found = columns.find(|known| known.name == column);
    let found = found.map_or("", |known| &known.unit);
    let (needed, factor) = match of_record.quantity {
        Quantity::TransmissionError => ("m", 1.0),
        Quantity::Strain { .. } => ("µε", 1e-6),
    };
    if found == needed {
        return Ok(factor);
    }
    Err(SystemComparisonError::Unit {
        column: column.into(),
        found: found.to_owned(),
        head: of_record.name.clone(),
        needed,
    })
}

/// The mesh whose channel a column is.
fn mesh_of<'a>(
    result: &'a SystemResult,
    column: &str,
) -> Result<&'a MeshRecord, SystemComparisonError> {
    let is_of = |mesh: &&MeshRecord| {
        let rest = column
            .strip_prefix("elements/")
            .and_then(|c| c.strip_prefix(&*mesh.name));
        rest.is_some_and(|rest| rest.starts_with('/'))
    };
    result.head.meshes.iter().find(is_of).ok_or_else(|| {
        let meshes: Vec<&str> = result.head.meshes.iter().map(|m| m.name.as_str()).collect();
        SystemComparisonError::NoMesh {
            column: column.into(),
            meshes: meshes.join(", "),
        }
    })
}

/// A column that is there.
fn known(result: &SystemResult, name: &str) -> Result<Vec<f64>, SystemComparisonError> {
    let columns = result.rows.columns();
    if columns.iter().any(|c| c.name == name) {
        return Ok(result.rows.read(name)?);
    }
    let last = name.rsplit('/').next().unwrap_or(name);
    let mut like: Vec<&str> = columns.iter().map(|c| c.name.as_str()).collect();
    let near = |other: &&str| other.ends_with(last) || other.starts_with("elements/");
    like.retain(near);
    like.truncate(NAMED);
    Err(SystemComparisonError::NoColumn {
        column: name.into(),
        all: columns.len(),
        some: like.join(", "),
    })
}

/// A column beside the angle of a shaft that turns one way.
struct RunOnShaft<'a> {
    column: &'a str,
    body: &'a str,
    from_s: f64,
    values: &'a [f64],
    /// Counted on over all turns, rising.
    turns_rad: &'a [f64],
}

impl RunOnShaft<'_> {
    /// The mean over as many stretches of `revolutions` as there are, as a function of the shaft's angle.
    fn average(&self, revolutions: usize) -> Result<AngleSeries, SystemComparisonError> {
        let steps = self.turns_rad.windows(2).map(|pair| pair[1] - pair[0]);
        let found = TAU / steps.fold(0.0_f64, f64::max);
        if !SAMPLES_PER_TURN.contains(&found) {
            return Err(SystemComparisonError::SamplesPerTurn {
                body: self.body.into(),
                found,
                least: *SAMPLES_PER_TURN.start(),
                most: *SAMPLES_PER_TURN.end(),
            });
        }
        let per_turn = found.floor() as usize;
        let refused = |source| SystemComparisonError::Series {
            column: self.column.into(),
            source,
        };
        let resampling = |error: SeriesError| refused(error.into());
        let on_shaft = Resampler::default().to_angle(self.values, self.turns_rad, per_turn);
        let on_shaft = on_shaft.map_err(resampling)?;
        let per_stretch = per_turn * revolutions;
        let stretches = on_shaft.values.len() / per_stretch;
        if stretches == 0 {
            return Err(SystemComparisonError::TooShort {
                from_s: self.from_s,
                found: on_shaft.values.len() as f64 / per_turn as f64,
                body: self.body.into(),
                revolutions,
            });
        }
        let averaged = synchronous_average(&on_shaft.values, per_stretch, stretches);
        let averaged = averaged.map_err(resampling)?.average;
        let series = AngleSeries::uniform(on_shaft.start_rad, &averaged, revolutions);
        series.map_err(|error| refused(error.into()))
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn run<'a>(values: &'a [f64], turns_rad: &'a [f64]) -> RunOnShaft<'a> {
        RunOnShaft {
            column: "elements/mesh/transmission_error_m",
            body: "wheel",
            from_s: 0.0,
            values,
            turns_rad,
        }
    }

    /// Five turns at a speed that swings: orders 6 and 47 of the shaft, and one of the other shaft that averages out.
    #[test]
    fn a_run_at_varying_speed_becomes_a_function_of_the_angle() {
        let turns: Vec<f64> = (0..60_000)
            .map(|i| {
                let t = f64::from(i) / 60_000.0;
                0.7 + TAU * (5.2 * t + 0.05 * (TAU * 3.0 * t).sin())
            })
            .collect();
        let f = |a: f64| 3.0 + (6.0 * a).cos() + 0.3 * (47.0 * a + 1.0).sin();
        let values: Vec<f64> = turns
            .iter()
            .map(|a| f(*a) + 0.2 * (0.2 * a).cos())
            .collect();
        let series = run(&values, &turns).average(1).unwrap();
        for i in 0..500 {
            let a = 0.0123 * f64::from(i);
            assert!((series.value(a) - f(a)).abs() < 1e-6, "{a}");
        }
        assert_eq!(
            run(&values, &turns)
                .average(5)
                .unwrap()
                .period()
                .whole_revolutions(),
            5
        );
    }

    #[test]
    fn too_few_turns_and_rows_are_told() {
        let turns: Vec<f64> = (0..5000).map(|i| 1e-3 * f64::from(i)).collect();
        let error = run(&vec![1.0; 5000], &turns)
            .average(1)
            .err()
            .unwrap()
            .to_string();
        assert!(
            error.contains("0.79 revolutions of `wheel`") && error.contains("run.end_s"),
            "{error}"
        );
        let coarse: Vec<f64> = turns.iter().map(|a| 1000.0 * a).collect();
        let error = run(&vec![1.0; 5000], &coarse)
            .average(1)
            .err()
            .unwrap()
            .to_string();
        assert!(
            error.contains("6.3 samples in a turn") && error.contains("interval_s"),
            "{error}"
        );
    }
}
