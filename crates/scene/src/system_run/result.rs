//! The result of a multibody scene as a file: written by the runs, read for reports. Layout: docs/results.md.

use std::path::Path;

use gearmesh_dynamics::NaturalMode;
use gearmesh_model::{
    Column, ColumnFile, DataArray, DataTree, FileError, FileFormat, RowLog, Values, read_record,
    utc_now, write_columns,
};

use super::column_names::varying;
use super::column_statistics::Figures;
use super::job::{EigenPoint, MeshRecord, RunHead};
use super::run_record::RunRecord;
use super::speed_plan::Window;
use crate::rating::{RatingResult, Ratings};

/// Name and version of the result file.
pub const SYSTEM_RESULT_FORMAT: FileFormat = FileFormat {
    name: "gearmesh-system-result",
    version: 1,
};

/// Natural modes at one operating point.
#[derive(Debug, Clone, PartialEq)]
pub struct EigenResult {
    /// The point.
    pub point: EigenPoint,
    /// The modes, by rising frequency.
    pub modes: Vec<NaturalMode>,
    /// Share of each body in the kinetic energy of each mode, `[mode][body]`.
    pub participation: Vec<Vec<f64>>,
    /// Share of each force element in the strain energy of each mode, `[mode][element]`; empty in files of older
    /// programs.
    pub strain: Vec<Vec<f64>>,
}

/// A measured speed sweep.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepResult {
    /// Windows, in the order of time.
    pub windows: Vec<Window>,
    /// Names of the columns.
    pub columns: Vec<String>,
    /// Figures, `[window][column]`.
    pub figures: Vec<Vec<Figures>>,
}

/// A result, columns not read yet.
#[derive(Debug)]
pub struct SystemResult {
    /// Where it comes from.
    pub head: RunHead,
    /// `transient`, `speed-sweep`, `static` or `eigen`.
    pub kind: String,
    /// Program version.
    pub version: String,
    /// When, UTC.
    pub created_utc: String,
    /// Effort and accuracy, of runs in time.
    pub record: Option<RunRecord>,
    /// Rows, column by column; none for a sweep and for natural frequencies.
    pub rows: ColumnFile,
    /// Figures of all columns of a transient run, in their order.
    pub statistics: Vec<Figures>,
    /// Sweep.
    pub sweep: Option<SweepResult>,
    /// What was judged after the run.
    pub ratings: Vec<RatingResult>,
    /// Natural frequencies.
    pub eigen: Vec<EigenResult>,
    /// Names of the bodies, in the order of the participations.
    pub bodies: Vec<String>,
    /// Names of the force elements, in the order of the strain shares.
    pub elements: Vec<String>,
}

impl SweepResult {
    /// Which columns vary by more than rounding in some window.
    #[must_use]
    pub fn varying(&self) -> Vec<bool> {
        let of_window = |figures: &Vec<Figures>| {
            let columns = self.columns.iter().zip(figures);
            varying(columns.map(|(name, f)| (name.as_str(), f.least, f.largest)))
        };
        let none = vec![false; self.columns.len()];
        self.figures
            .iter()
            .map(of_window)
            .fold(none, |mut all, window| {
                all.iter_mut()
                    .zip(window)
                    .for_each(|(all, here)| *all |= here);
                all
            })
    }
}

const FIGURES: [(&str, &str); 4] = [
    ("mean", "mean"),
    ("deviation", "standard deviation: RMS value about the mean"),
    ("least", "smallest value"),
    ("largest", "largest value"),
];

/// The parts that every result has.
pub(super) fn base(head: &RunHead, kind: &str, record: Option<&RunRecord>) -> DataTree {
    let mut tree = DataTree::default();
    for (name, text) in [
        ("title", &head.title[..]),
        ("kind", kind),
        ("scene_toml", &head.scene_toml),
        ("inputs", &head.inputs.join("\n")),
        ("notes", &head.notes.join("\n")),
        ("version", env!("CARGO_PKG_VERSION")),
        ("created_utc", &utc_now()),
    ] {
        tree.put_text(name, text);
    }
    for (i, mesh) in head.meshes.iter().enumerate() {
        let name = |part: &str| format!("meshes/{i}/{part}");
        tree.put_text(name("name"), mesh.name.clone());
        for gear in 0..2 {
            let body = name(&format!("body_{}", gear + 1));
            tree.put_text(body, mesh.bodies[gear].clone());
            let teeth = DataArray::count(mesh.teeth[gear] as u32, "teeth");
            tree.put(name(&format!("teeth_{}", gear + 1)), teeth);
        }
    }
    if let Some(record) = record {
        record.put(&mut tree);
    }
    tree
}

fn put(
    tree: &mut DataTree,
    name: &str,
    values: Vec<f64>,
    axes: &[(&str, usize)],
    unit: &str,
    text: &str,
) {
    tree.put(name, DataArray::new(Values::F64(values), axes, unit, text));
}

/// Figures of all rows, in the order of the columns.
pub(super) fn put_statistics(tree: &mut DataTree, figures: &[Figures]) {
    for (k, (name, text)) in FIGURES.into_iter().enumerate() {
        let values = figures.iter().map(|f| parts(f)[k]).collect();
        let axes = [("column", figures.len())];
        put(
            tree,
            &format!("statistics/{name}"),
            values,
            &axes,
            "of the column",
            text,
        );
    }
}

fn parts(figures: &Figures) -> [f64; 4] {
    [
        figures.mean,
        figures.deviation,
        figures.least,
        figures.largest,
    ]
}

/// The windows of a sweep with the figures of every column.
pub(super) fn put_sweep(
    tree: &mut DataTree,
    columns: &[Column],
    windows: &[Window],
    figures: &[f64],
) {
    let axis = ("window", windows.len());
    let mut of_windows = |name: &str, unit: &str, text: &str, value: fn(&Window) -> f64| {
        let values = windows.iter().map(value).collect();
        put(tree, &format!("sweep/{name}"), values, &[axis], unit, text);
    };
    of_windows("speed_rad_per_s", "rad/s", "prescribed speed", |w| {
        w.speed_rad_per_s
    });
    of_windows("up", "1", "1 on the way up, 0 on the way down", |w| {
        f64::from(u8::from(w.up))
    });
    of_windows("from_s", "s", "begin of the measurement", |w| w.from_s);
    of_windows("to_s", "s", "end of the measurement", |w| w.to_s);
    let names: Vec<&str> = columns.iter().map(|c| c.name.as_str()).collect();
    tree.put_text("sweep/columns", names.join("\n"));
    for (k, (name, text)) in FIGURES.into_iter().enumerate() {
        let values = figures.iter().skip(k).step_by(4).copied().collect();
        let axes = [axis, ("column", columns.len())];
        put(
            tree,
            &format!("sweep/{name}"),
            values,
            &axes,
            "of the column",
            text,
        );
    }
}

/// Natural modes of some operating points.
pub(super) fn put_eigen(
    tree: &mut DataTree,
    [bodies, elements]: [&[String]; 2],
    results: &[EigenResult],
) {
    tree.put_text("eigen/bodies", bodies.join("\n"));
    tree.put_text("eigen/elements", elements.join("\n"));
    for (i, result) in results.iter().enumerate() {
        let group = format!("eigen/{i:04}");
        let modes = ("mode", result.modes.len());
        let dofs = result.modes.first().map_or(0, |mode| mode.shape.len());
        let mut of_modes = |name: &str, unit: &str, text: &str, value: fn(&NaturalMode) -> f64| {
            let values = result.modes.iter().map(value).collect();
            put(
                tree,
                &format!("{group}/{name}"),
                values,
                &[modes],
                unit,
                text,
            );
        };
        of_modes(
            "frequency_Hz",
            "Hz",
            "frequency of the damped vibration",
            NaturalMode::frequency_hz,
        );
        of_modes(
            "damping_ratio",
            "1",
            "damping ratio",
            NaturalMode::damping_ratio,
        );
        of_modes(
            "growth_per_s",
            "1/s",
            "real part of the eigenvalue, negative where the motion dies out",
            |m| m.growth_per_s,
        );
        for (part, name) in ["shape_real", "shape_imaginary"].into_iter().enumerate() {
            let shapes = result
                .modes
                .iter()
                .flat_map(|mode| mode.shape.iter().map(move |a| a[part]));
            let text = "of each body displacement and rotation along world axes, then modal coordinates; the largest is 1";
            put(
                tree,
                &format!("{group}/{name}"),
                shapes.collect(),
                &[modes, ("degree of freedom", dofs)],
                "m or rad",
                text,
            );
        }
        let shares = result.participation.iter().flatten().copied().collect();
        let text = "share of each body in the kinetic energy";
        put(
            tree,
            &format!("{group}/participation"),
            shares,
            &[modes, ("body", bodies.len())],
            "1",
            text,
        );
        if !elements.is_empty() {
            let shares = result.strain.iter().flatten().copied().collect();
            let text = "share of each force element in the strain energy";
            put(
                tree,
                &format!("{group}/strain"),
                shares,
                &[modes, ("element", elements.len())],
                "1",
                text,
            );
        }
        let scalar = |value: f64, unit: &str, text: &str| DataArray::scalar(value, unit, text);
        let factor = scalar(result.point.load_factor, "1", "share of the scene's loads");
        tree.put(format!("{group}/load_factor"), factor);
        if let Some(speed) = result.point.speed_rad_per_s {
            let speed = scalar(speed, "rad/s", "speed of the varied motion");
            tree.put(format!("{group}/speed_rad_per_s"), speed);
        }
    }
}

/// Writes a result without rows.
pub(super) fn write(path: &Path, tree: &DataTree) -> Result<(), FileError> {
    tree.write(path, &SYSTEM_RESULT_FORMAT)
}

/// Writes a result with rows; `axis` says what they go through.
pub(super) fn write_rows(
    path: &Path,
    tree: &DataTree,
    (axis, columns, log): (&str, &[Column], &mut RowLog),
) -> Result<(), FileError> {
    write_columns(path, &SYSTEM_RESULT_FORMAT, tree, (axis, columns), log)
}

impl SystemResult {
    /// Opens a result.
    ///
    /// # Errors
    /// [`FileError`] when the file is missing, cut, altered, of another kind, or an array does not fit the others.
    pub fn open(path: &Path) -> Result<Self, FileError> {
        let (rows, mut tree) = ColumnFile::open(path, &SYSTEM_RESULT_FORMAT)?;
        let tree = &mut tree;
        let lines = |text: String| text.lines().map(str::to_owned).collect::<Vec<_>>();
        let kind = tree.take_text(path, "kind")?;
        let in_time = matches!(&kind[..], "transient" | "speed-sweep");
        let record = in_time.then(|| RunRecord::take(tree, path)).transpose()?;
        let statistics = if kind == "transient" {
            take_figures(tree, path, "statistics", &[rows.columns().len()])?
        } else {
            Vec::new()
        };
        let sweep = (kind == "speed-sweep")
            .then(|| take_sweep(tree, path))
            .transpose()?;
        let Ratings(ratings) = read_record(tree, path, rows.version())?;
        let ([bodies, elements], eigen) = if kind == "eigen" {
            take_eigen(tree, path)?
        } else {
            Default::default()
        };
        Ok(Self {
            head: RunHead {
                title: tree.take_text(path, "title")?,
                scene_toml: tree.take_text(path, "scene_toml")?,
                inputs: lines(tree.take_text(path, "inputs")?),
                notes: lines(tree.take_text(path, "notes")?),
                meshes: take_meshes(tree, path)?,
            },
            version: tree.take_text(path, "version")?,
            created_utc: tree.take_text(path, "created_utc")?,
            kind,
            record,
            rows,
            statistics,
            sweep,
            ratings,
            eigen,
            bodies,
            elements,
        })
    }
}

fn take_meshes(tree: &mut DataTree, path: &Path) -> Result<Vec<MeshRecord>, FileError> {
    let count = tree.children("meshes").len();
    let mesh = |i: usize| {
        let name = |part: &str| format!("meshes/{i}/{part}");
        Ok(MeshRecord {
            name: tree.take_text(path, &name("name"))?,
            bodies: [
                tree.take_text(path, &name("body_1"))?,
                tree.take_text(path, &name("body_2"))?,
            ],
            teeth: [
                tree.take_count(path, &name("teeth_1"))?,
                tree.take_count(path, &name("teeth_2"))?,
            ],
        })
    };
    (0..count).map(mesh).collect()
}

fn take_figures(
    tree: &mut DataTree,
    path: &Path,
    group: &str,
    shape: &[usize],
) -> Result<Vec<Figures>, FileError> {
    let mut take = |name: &str| tree.take_f64(path, &format!("{group}/{name}"), shape);
    let [mean, deviation] = [take("mean")?, take("deviation")?];
    let [least, largest] = [take("least")?, take("largest")?];
    let figures = |i: usize| Figures {
        mean: mean[i],
        deviation: deviation[i],
        least: least[i],
        largest: largest[i],
    };
    Ok((0..mean.len()).map(figures).collect())
}

fn take_sweep(tree: &mut DataTree, path: &Path) -> Result<SweepResult, FileError> {
    let [count] = tree.shape(path, "sweep/speed_rad_per_s")?;
    let names = tree.take_text(path, "sweep/columns")?;
    let columns: Vec<String> = names.lines().map(str::to_owned).collect();
    let all = take_figures(tree, path, "sweep", &[count, columns.len()])?;
    let mut take = |name: &str| tree.take_f64(path, &format!("sweep/{name}"), &[count]);
    let [speed, up] = [take("speed_rad_per_s")?, take("up")?];
    let [from, to] = [take("from_s")?, take("to_s")?];
    let window = |i: usize| Window {
        speed_rad_per_s: speed[i],
        up: up[i] != 0.0,
        from_s: from[i],
        to_s: to[i],
    };
    Ok(SweepResult {
        windows: (0..count).map(window).collect(),
        figures: all
            .chunks(columns.len().max(1))
            .map(<[_]>::to_vec)
            .collect(),
        columns,
    })
}

/// Names of bodies and elements, and the points.
fn take_eigen(
    tree: &mut DataTree,
    path: &Path,
) -> Result<([Vec<String>; 2], Vec<EigenResult>), FileError> {
    let names = tree.take_text(path, "eigen/bodies")?;
    let bodies: Vec<String> = names.lines().map(str::to_owned).collect();
    // Files of older programs have no elements.
    let names = tree.take_text(path, "eigen/elements").unwrap_or_default();
    let elements: Vec<String> = names.lines().map(str::to_owned).collect();
    let points = tree.children("eigen");
    let mut results = Vec::with_capacity(points.len());
    for point in points {
        let name = |part: &str| format!("eigen/{point}/{part}");
        let [modes, dofs] = tree.shape(path, &name("shape_real"))?;
        let speed = name("speed_rad_per_s");
        let speed_rad_per_s = tree
            .arrays
            .contains_key(&speed)
            .then(|| tree.take_scalar(path, &speed))
            .transpose()?;
        let load_factor = tree.take_scalar(path, &name("load_factor"))?;
        let frequency = tree.take_f64(path, &name("frequency_Hz"), &[modes])?;
        let growth = tree.take_f64(path, &name("growth_per_s"), &[modes])?;
        let real = tree.take_f64(path, &name("shape_real"), &[modes, dofs])?;
        let imaginary = tree.take_f64(path, &name("shape_imaginary"), &[modes, dofs])?;
        let shares = tree.take_f64(path, &name("participation"), &[modes, bodies.len()])?;
        let strain = if elements.is_empty() {
            Vec::new()
        } else {
            tree.take_f64(path, &name("strain"), &[modes, elements.len()])?
        };
        let mode = |i: usize| NaturalMode {
            growth_per_s: growth[i],
            angular_frequency_rad_per_s: std::f64::consts::TAU * frequency[i],
            shape: (i * dofs..(i + 1) * dofs)
                .map(|k| [real[k], imaginary[k]])
                .collect(),
        };
        results.push(EigenResult {
            point: EigenPoint {
                speed_rad_per_s,
                load_factor,
            },
            modes: (0..modes).map(mode).collect(),
            participation: shares
                .chunks(bodies.len().max(1))
                .map(<[_]>::to_vec)
                .collect(),
            strain: strain
                .chunks(elements.len().max(1))
                .map(<[_]>::to_vec)
                .collect(),
        });
    }
    Ok(([bodies, elements], results))
}
