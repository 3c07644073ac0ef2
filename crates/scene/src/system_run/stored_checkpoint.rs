//! The checkpoint of a simulation and of what is recorded, as arrays of a file.

use std::path::Path;

use gearmesh_dynamics::Checkpoint;
use gearmesh_model::{DataArray, DataTree, FileError, Values};

/// What a run in time carries besides the simulation.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Recorded {
    /// Number of the next output time.
    pub next_sample: u64,
    /// Wall time used \[s\].
    pub wall_s: f64,
    /// Rows that are not written yet.
    pub rows: Vec<f64>,
    /// Counted angles.
    pub angles: Vec<f64>,
    /// Statistics of all rows, then of the window that is open.
    pub statistics: [Vec<f64>; 2],
    /// Figures of the windows that are closed: mean, deviation, least, largest of every column.
    pub windows: Vec<f64>,
    /// Number of closed windows.
    pub closed: usize,
}

/// Both as arrays.
pub fn to_tree(checkpoint: &Checkpoint, recorded: &Recorded) -> DataTree {
    let mut tree = DataTree::default();
    let counts = |values: &[u64]| values.iter().map(|&n| n as f64).collect::<Vec<_>>();
    let c = checkpoint;
    let r = recorded;
    let progress = [r.next_sample as f64, r.wall_s, r.closed as f64];
    for (name, values) in [
        ("simulation/scalars", c.scalars.clone()),
        ("simulation/counts", counts(&c.counts)),
        ("simulation/positions", c.positions_m.clone()),
        ("simulation/quaternions", c.quaternions.clone()),
        ("simulation/modal", c.modal.clone()),
        ("simulation/unknowns", c.unknowns.clone()),
        ("simulation/velocities", c.velocities.clone()),
        ("simulation/reactions", c.reactions.clone()),
        ("simulation/internal", c.internal.clone()),
        ("simulation/matrix", c.matrix.clone()),
        ("recorded/progress", progress.to_vec()),
        ("recorded/angles", r.angles.clone()),
        ("recorded/rows", r.rows.clone()),
        ("recorded/statistics", r.statistics[0].clone()),
        ("recorded/window", r.statistics[1].clone()),
        ("recorded/windows", r.windows.clone()),
    ] {
        let axes = [("entry", values.len())];
        let text = "internal state of an unfinished run";
        tree.put(name, DataArray::new(Values::F64(values), &axes, "SI", text));
    }
    tree
}

/// Above this not every whole number is a 64-bit float: 2⁵³.
const MOST_COUNT: f64 = 9_007_199_254_740_992.0;

/// The way back; `path` is named in errors.
///
/// # Errors
/// [`FileError::Missing`], [`FileError::WrongShape`], [`FileError::WrongType`], [`FileError::Contradiction`].
pub fn from_tree(tree: &mut DataTree, path: &Path) -> Result<(Checkpoint, Recorded), FileError> {
    let mut take = |name: &str| {
        let [length] = tree.shape(path, name)?;
        tree.take_f64(path, name, &[length])
    };
    // Counts are stored as numbers, which hold whole ones up to here.
    let count = |name: &str, n: f64| {
        if (0.0..MOST_COUNT).contains(&n) && n.fract() == 0.0 {
            return Ok(n as u64);
        }
        Err(FileError::Contradiction {
            path: path.to_owned(),
            item: name.to_owned(),
            problem: format!("{n} is no count"),
        })
    };
    let counts = |name: &str, values: Vec<f64>| {
        let counts = values.into_iter().map(|n| count(name, n));
        counts.collect::<Result<Vec<_>, _>>()
    };
    let checkpoint = Checkpoint {
        scalars: take("simulation/scalars")?,
        counts: counts("simulation/counts", take("simulation/counts")?)?,
        positions_m: take("simulation/positions")?,
        quaternions: take("simulation/quaternions")?,
        modal: take("simulation/modal")?,
        unknowns: take("simulation/unknowns")?,
        velocities: take("simulation/velocities")?,
        reactions: take("simulation/reactions")?,
        internal: take("simulation/internal")?,
        matrix: take("simulation/matrix")?,
    };
    let [next_sample, wall_s, closed]: [f64; 3] =
        take("recorded/progress")?.try_into().unwrap_or([0.0; 3]);
    let [next_sample, closed] = [next_sample, closed].map(|n| count("recorded/progress", n));
    let recorded = Recorded {
        next_sample: next_sample?,
        wall_s,
        closed: closed? as usize,
        angles: take("recorded/angles")?,
        rows: take("recorded/rows")?,
        statistics: [take("recorded/statistics")?, take("recorded/window")?],
        windows: take("recorded/windows")?,
    };
    Ok((checkpoint, recorded))
}
