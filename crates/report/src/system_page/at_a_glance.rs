//! What a reader asks first of a run in time or of equilibria: key figures, and a line for each channel.

use std::collections::BTreeMap;

use gearmesh_scene::system_run::{
    ColumnSummary, Figures, MeshPassing, ResultKind, SystemResult, foremost, rank, rounding, stem,
};

use crate::column_words::readable;
use crate::page::{Align, KeyFigures, Table};
use crate::short_number::{short, usual_unit};

/// Meshes whose figures head a page.
pub(super) const MOST_MESHES: usize = 4;

/// The last rank that the first table of a page has: meshes, bearings, strain, line loads, speeds.
const LAST_RANK: u8 = 5;

/// That of line loads, of which there are many: they have a folded table of their own.
const LINE_LOADS: u8 = 4;

/// What the figures of a column are of.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Extent {
    /// A run in time.
    Time,
    /// One equilibrium: each figure is the value.
    Equilibrium,
    /// Several equilibria.
    Equilibria,
}

impl Extent {
    fn of(r: &SystemResult) -> Self {
        match (r.kind, r.rows.rows()) {
            (ResultKind::Transient, _) => Self::Time,
            (_, 1) => Self::Equilibrium,
            _ => Self::Equilibria,
        }
    }
}

/// Transmission error and tooth force of the meshes, and the largest radial force of a bearing; of other columns none.
pub(super) fn key_figures(r: &SystemResult, found: &[ColumnSummary]) -> KeyFigures {
    let extent = Extent::of(r);
    let (te_label, te): (_, fn(&Figures) -> f64) = match extent {
        Extent::Equilibrium => ("TE", |f| f.mean),
        _ => ("TE peak to peak", Figures::peak_to_peak),
    };
    let (force_label, force): (_, fn(&Figures) -> f64) = match extent {
        Extent::Time => ("mean normal force", |f| f.mean),
        Extent::Equilibrium => ("normal force", |f| f.mean),
        Extent::Equilibria => ("largest normal force", |f| f.largest),
    };
    let mut figures = KeyFigures::new();
    for mesh in r.head.meshes.iter().take(MOST_MESHES) {
        let of_mesh = format!("elements/{}/", mesh.name);
        let channels = || {
            found
                .iter()
                .filter_map(|c| Some((c.name.strip_prefix(&of_mesh)?, &c.figures)))
        };
        let errors = channels().filter(|(channel, _)| *channel == "transmission_error_m");
        for (_, f) in errors {
            let label = format!("{}: {te_label}", mesh.name);
            figures = figures.figure(label, short(1e6 * te(f)), "µm");
        }
        let sides = channels().filter(|(channel, _)| channel.starts_with("normal_force_"));
        if let Some(value) = sides.map(|(_, f)| force(f)).reduce(f64::max) {
            let label = format!("{}: {force_label}", mesh.name);
            figures = figures.figure(label, short(value), "N");
        }
    }
    let radial = found
        .iter()
        .filter(|column| column.name.ends_with("/force_radial_N"));
    let largest = |column: &ColumnSummary| column.figures.largest;
    if let Some(column) = radial.max_by(|a, b| largest(a).total_cmp(&largest(b))) {
        let bearing = column.name.split('/').nth(1).unwrap_or_default();
        let label = format!("largest bearing force: {bearing}");
        figures = figures.figure(label, short(largest(column)), "N");
    }
    figures
}

/// Meshes, bearings and speeds, and folded line loads and all other force elements; those without a column are left
/// out.
pub(super) fn tables(
    r: &SystemResult,
    found: Vec<ColumnSummary>,
    passings: &[MeshPassing],
) -> Vec<Table> {
    let extent = Extent::of(r);
    let mut tables = empty_tables(r, extent);
    // The largest amount of each unit, beside which rounding is nothing.
    let mut amounts: BTreeMap<String, f64> = BTreeMap::new();
    for column in &found {
        let amount = amounts.entry(column.unit.clone()).or_default();
        *amount = amount.max(column.figures.magnitude());
    }
    for column in foremost(found) {
        let name = stem(&column.name, &column.unit);
        let f = column.figures;
        let (factor, unit) = usual_unit(&column.unit, f.magnitude());
        let least = rounding(&column.unit) * amounts.get(&column.unit).copied().unwrap_or(0.0);
        let shown = |x: f64| short(if x.abs() > least { factor * x } else { 0.0 });
        let incomplete = passings
            .iter()
            .any(|mesh| mesh.leaves_incomplete(&column.name));
        let mut row = vec![
            readable(name) + if incomplete { " (incomplete)" } else { "" },
            unit.to_owned(),
            shown(f.mean),
        ];
        match extent {
            Extent::Equilibrium => {}
            Extent::Equilibria => row.extend([f.least, f.largest, f.peak_to_peak()].map(shown)),
            Extent::Time => {
                row.extend([f.deviation, f.least, f.largest, f.peak_to_peak()].map(shown));
                row.push(column.dominant_hz.map_or("none".to_owned(), short));
            }
        }
        let place = match rank(&column.name) {
            LINE_LOADS => 1,
            rank if rank > LAST_RANK => 2,
            _ => 0,
        };
        tables[place].push_row(row);
    }
    tables
        .into_iter()
        .filter(|table| !table.is_empty())
        .collect()
}

/// The tables without rows.
fn empty_tables(r: &SystemResult, extent: Extent) -> [Table; 3] {
    let (first, over, heads): (_, _, &[&str]) = match extent {
        Extent::Time => (
            format!("Meshes, bearings and speeds: {}", r.statistics_in_words()),
            " over the same time",
            &[
                "mean",
                "RMS about the mean",
                "least",
                "largest",
                "peak to peak",
                "dominant Hz",
            ],
        ),
        Extent::Equilibrium => ("Meshes and bearings".to_owned(), "", &["value"]),
        Extent::Equilibria => (
            "Meshes and bearings".to_owned(),
            "",
            &["mean", "least", "largest", "peak to peak"],
        ),
    };
    let with_heads = |title: String| {
        let table = Table::new(title).columns(Align::Left, ["column", "unit"]);
        table.columns(Align::Right, heads.iter().copied())
    };
    let folded = |what: &str| with_heads(format!("{what}{over}")).folded();
    [
        with_heads(first),
        folded("Line loads of the slices"),
        folded("Springs, couplings and beams"),
    ]
}
