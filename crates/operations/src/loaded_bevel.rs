//! A bevel pair under torques: transmission error, load sharing and pressure of a bevel pair under torques.

use std::path::{Path, PathBuf};

use crate::bevel_gauges::{self, GaugeStrain};
use crate::failure::Failure;
use crate::watch::Watch;
use gearmesh_bevel::pair_file::LoadRequest;
use gearmesh_bevel::{PairDesign, PairFile};
use gearmesh_drivetrain::{BevelSlices, LoadedContact, LoadedPatch, LoadedPosition};
use gearmesh_geometry::Flank;
use gearmesh_model::{ReducedGear, read_reduced_gear};
use gearmesh_report::page::{
    Align, Axis, FieldPicture, FieldValues, LineChart, LineSeries, Section, Table, Text,
};
use gearmesh_scene::bevel_load::{
    BevelLoadError, BevelTorque, LoadedBevel, bevel_figures, load_bevel,
};
use gearmesh_scene::pair::figure_table::FigureTable;
use serde_json::{Map, Value, json};

/// Rows of the pressure's picture up the flank.
const ROWS: usize = 16;

/// What was found under load.
pub struct Loaded {
    flanks: BevelSlices,
    /// Flanks that press.
    pub side: Flank,
    slices: usize,
    /// What deflects, in words.
    body: &'static str,
    /// The reduced members, where the file names any, and their files.
    pub models: Option<[(ReducedGear, PathBuf); 2]>,
    /// One for each torque.
    pub found: Vec<LoadedContact>,
    /// Coefficient of friction, where stated, and z₁/z₂.
    friction: Option<f64>,
    ratio: f64,
    /// At all gauges of the models.
    strain: Vec<GaugeStrain>,
}

impl Loaded {
    /// Efficiency of the teeth in per cent under a torque, where friction is stated.
    fn efficiency_percent(&self, of: &LoadedContact) -> Option<f64> {
        Some(100.0 * of.efficiency(self.friction?, self.ratio))
    }

    /// Width of a slice along the pinion's face \[m\].
    pub fn slice_width_m(&self) -> f64 {
        self.flanks.pair().face_widths_m()[0] / self.slices as f64
    }
}

/// Loads a pair.
///
/// # Errors
/// [`Failure`] where a model cannot be read or is not that of the pair, or no contact is found.
pub fn analyse(
    (file, design): (&PairFile, &PairDesign),
    load: &LoadRequest,
    path: &Path,
    watch: &Watch<'_>,
) -> Result<Loaded, Failure> {
    let models = models(load, path)?;
    let members = models.as_ref().map(|[a, b]| [&a.0, &b.0]);
    let loaded = load_bevel((file, design), load, members).map_err(|error| match error {
        BevelLoadError::Slices { .. } => Failure::input(error).about(path),
        BevelLoadError::Contact(_) => Failure::work(error).about(path),
    })?;
    let young_pa = members.map_or(load.material.0, |[a, b]| a.young_pa.min(b.young_pa));
    if let Some(words) = loaded.too_much_pressure(young_pa) {
        watch.warning(words);
    }
    let LoadedBevel {
        flanks,
        side,
        slices,
        found,
    } = loaded;
    let strain = match members {
        Some(members) => {
            let face_m = flanks.pair().face_widths_m()[0];
            bevel_gauges::read(members, side, (slices, face_m), &found).map_err(Failure::work)?
        }
        None => {
            warn_of_short_slices(&found, watch);
            Vec::new()
        }
    };
    let [pinion, gear] = file.blank.data.teeth;
    Ok(Loaded {
        friction: load.friction,
        ratio: pinion as f64 / gear as f64,
        strain,
        side,
        slices,
        body: match models {
            Some(_) => "reduced gears",
            None => "rigid gears, their surfaces deflect",
        },
        found,
        flanks,
        models,
    })
}

/// The members' models, where the file names any, with their files.
fn models(load: &LoadRequest, path: &Path) -> Result<Option<[(ReducedGear, PathBuf); 2]>, Failure> {
    let Some(files) = &load.models else {
        return Ok(None);
    };
    let folder = path.parent().unwrap_or(Path::new(""));
    let read = |i: usize| -> Result<(ReducedGear, PathBuf), Failure> {
        let file = folder.join(&files[i]);
        match read_reduced_gear(&file) {
            Ok(model) => Ok((model, file)),
            Err(error) => Err(Failure::input(format!("load.models.{i}: {error}"))),
        }
    };
    Ok(Some([read(0)?, read(1)?]))
}

/// On half spaces the law of a slice is cut off where it is shorter than the contact's half width
/// (docs/theory/sliced_contact.md).
fn warn_of_short_slices(found: &[LoadedContact], watch: &Watch<'_>) {
    let too_short = |patch: &&LoadedPatch| patch.half_width_m > patch.length_m;
    let patches = found.iter().flat_map(LoadedContact::patches);
    let widest = patches
        .filter(too_short)
        .max_by(|a, b| a.half_width_m.total_cmp(&b.half_width_m));
    if let Some(patch) = widest {
        watch.warning(format!(
            "slices, {:.3} mm long, are shorter than the contact's half width, {:.3} mm: deflections of short slices are cut off there; state fewer `slices`",
            1e3 * patch.length_m,
            1e3 * patch.half_width_m
        ));
    }
}

/// The figures of all torques as people read them.
fn table(loaded: &Loaded) -> FigureTable {
    let figures = bevel_figures();
    let row = |found| {
        let torque = BevelTorque {
            found,
            slices: loaded.slices,
        };
        figures
            .iter()
            .map(|figure| figure.text(&torque, None))
            .collect()
    };
    FigureTable {
        heads: figures.iter().map(|figure| figure.heading(None)).collect(),
        rows: loaded.found.iter().map(row).collect(),
    }
}

/// The first screen.
#[must_use]
pub fn lines(file: &PairFile, loaded: &Loaded) -> Vec<String> {
    let mut lines = vec![format!(
        "{} under torques on the gear, {} slices, {}: without load TE pk-pk {:.3} urad",
        file.title,
        loaded.slices,
        loaded.body,
        1e6 * loaded.found[0].unloaded_peak_to_peak_rad()
    )];
    lines.extend(table(loaded).lines());
    lines.extend(efficiency_words(loaded));
    lines.extend(bevel_gauges::lines(&loaded.strain));
    lines
}

/// Efficiency under each torque, where friction is stated.
fn efficiency_words(loaded: &Loaded) -> Option<String> {
    let friction = loaded.friction?;
    let each = loaded.found.iter().filter_map(|of| {
        let percent = loaded.efficiency_percent(of)?;
        Some(format!("{percent:.3} % at {} N m", of.torque_nm))
    });
    let each = each.collect::<Vec<_>>().join(", ");
    Some(format!(
        "efficiency of the teeth with a coefficient of friction of {friction}: {each}"
    ))
}

/// All of it for other programs.
pub fn figures(loaded: &Loaded) -> Value {
    let each = loaded.found.iter().map(|of| {
        let positions: Vec<Value> = (of.positions.iter())
            .map(|p| {
                let patches: Vec<Value> = (p.patches.iter())
                    .map(|patch| {
                        json!({
                            "teeth": patch.teeth,
                            "pinion_place": patch.places[0],
                            "gear_place": patch.places[1],
                            "force_N": patch.force_n,
                            "length_mm": 1e3 * patch.length_m,
                            "half_width_mm": 1e3 * patch.half_width_m,
                            "pressure_MPa": 1e-6 * patch.pressure_pa,
                            "on_tip": patch.on_tip,
                        })
                    })
                    .collect();
                json!({
                    "pinion_deg": p.pinion_turn_rad.to_degrees(),
                    "error_urad": 1e6 * p.error_rad,
                    "unloaded_urad": 1e6 * p.unloaded_rad,
                    "pair_forces_N": p.pair_forces_n(),
                    "patches": patches,
                })
            })
            .collect();
        let between: Vec<[f64; 2]> = (of.between.iter())
            .map(|p| [p.pinion_turn_rad.to_degrees(), 1e6 * p.error_rad])
            .collect();
        let torque = BevelTorque {
            found: of,
            slices: loaded.slices,
        };
        let figures =
            bevel_figures().map(|figure| (figure.name_in_files(), json!((figure.of)(&torque))));
        let mut all: Map<String, Value> = figures.into_iter().collect();
        all.insert(
            "efficiency_percent".to_owned(),
            json!(loaded.efficiency_percent(of)),
        );
        all.insert("positions".to_owned(), Value::Array(positions));
        all.insert("between_deg_urad".to_owned(), json!(between));
        Value::Object(all)
    });
    json!({
        "slices": loaded.slices,
        "gears": loaded.body,
        "unloaded_peak_to_peak_urad": 1e6 * loaded.found[0].unloaded_peak_to_peak_rad(),
        "torques": each.collect::<Vec<_>>(),
        "strain": bevel_gauges::figures(&loaded.strain),
    })
}

/// The page's section.
pub fn section(loaded: &Loaded) -> Section {
    let shown = table(loaded);
    let mut table = Table::new("Under torques on the gear");
    for head in shown.heads {
        table = table.column(head, Align::Right);
    }
    for row in shown.rows {
        table.push_row(row);
    }
    let mut section = Section::new("Under load").push(Text::paragraph(format!(
        "{}, {} slices along the face. Best pair: share of the load that the most loaded pair of teeth carries, least and largest over the positions. Off tips: pressure where no tip touches; \
         inside: where the contact's whole width stands clear of the tips. Pattern: where it begins and ends on the gear, along the face from the toe and up the flank from the root.",
        loaded.body, loaded.slices
    )));
    section = section.push(table);
    if let Some(words) = efficiency_words(loaded) {
        section = section.push(Text::paragraph(words));
    }
    section = section.push(error(loaded));
    if let Some(strain) = bevel_gauges::table(&loaded.strain) {
        section = section.push(strain);
    }
    for of in &loaded.found {
        section = section.push(pressure(loaded, of));
    }
    section
}

fn error(loaded: &Loaded) -> LineChart {
    // Where the pinion drives clockwise positions follow one another backwards.
    let values = |of: &LoadedContact, value: fn(&LoadedPosition) -> f64| -> Vec<f64> {
        let mut positions: Vec<&LoadedPosition> = of.positions.iter().collect();
        positions.sort_by(|a, b| a.pinion_turn_rad.total_cmp(&b.pinion_turn_rad));
        positions.into_iter().map(value).collect()
    };
    let first = &loaded.found[0];
    let unloaded = values(first, |p| 1e6 * p.unloaded_rad);
    let chart = LineChart::new(
        "Transmission error over a pitch",
        Axis::new("turn of the pinion", "deg"),
        Axis::new("gear ahead of constant ratio", "µrad"),
    )
    .x_values(values(first, |p| p.pinion_turn_rad.to_degrees()))
    .series(LineSeries::new("without load", unloaded));
    loaded.found.iter().fold(chart, |chart, of| {
        let values = values(of, |p| 1e6 * p.error_rad);
        chart.series(LineSeries::new(format!("{} N m", of.torque_nm), values))
    })
}

/// Largest pressure of all positions over the gear's flank.
fn pressure(loaded: &Loaded, of: &LoadedContact) -> FieldPicture {
    let columns = loaded.slices;
    let mut cells = vec![0.0f64; columns * ROWS];
    let number = |share: f64, count: usize| ((share * count as f64) as usize).min(count - 1);
    for patch in of.patches() {
        let [s, v] = patch.places[1];
        let cell = number(s.max(0.0), columns) * ROWS + number(v.max(0.0), ROWS);
        cells[cell] = cells[cell].max(1e-6 * patch.pressure_pa);
    }
    let place = |i: usize, k: usize| {
        let at = [i as f64 / columns as f64, k as f64 / ROWS as f64];
        let place = loaded.flanks.pair().flank_place_m(loaded.side, 1, at);
        place.map(|x| 1e3 * x)
    };
    let nodes = (0..=columns).flat_map(|i| (0..=ROWS).map(move |k| (i, k)));
    let nodes = nodes.map(|(i, k)| place(i, k)).collect();
    let up = ROWS as u32 + 1;
    let quads = (0..columns as u32).flat_map(|i| (0..ROWS as u32).map(move |k| i * up + k));
    let quads = quads.map(|n| [n, n + up, n + up + 1, n + 1]).collect();
    FieldPicture::new(
        format!(
            "Largest pressure at {} N m over a pitch, flank of the gear, toe left, tip up",
            of.torque_nm
        ),
        "pressure",
        "MPa",
    )
    .mesh(nodes, quads)
    .values(FieldValues::PerElement(cells))
    .colours_of_most()
}
