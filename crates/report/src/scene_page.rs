//! The report page of one or more results.

use crate::comparison_table;
use crate::contact_pattern;
use crate::page::{
    self, Align, Axis, FieldPicture, FieldValues, KeyFigures, LineChart, LineSeries, LineStyle,
    Page, PageError, Section, SeriesColour, SpectrumChart, SpectrumSeries, Table, Text,
};
use crate::pair_in_space;
use crate::pair_orders::{PairOrders, Shaft};
use crate::peak_view::PeakView;
use crate::quantity::Quantity;
use crate::ratings;
use crate::record::ReferenceRecord;
use crate::result_series::series;
use crate::scene_comparison::{SceneComparisonError, compare_scene};
use crate::short_number::short;
use crate::system_page;
use crate::torque_tables;
use gearmesh_model::FileError;
use gearmesh_scene::SceneResult;
use gearmesh_scene::pair::figure_table::{FIGURES, FigureKind};
use gearmesh_scene::system_run::SystemResult;
use gearmesh_signal::RigSettings;
use gearmesh_signal::rig::process;

/// A gear's cross-section coloured by stress.
#[derive(Debug, Clone)]
pub struct GearPicture {
    /// Title.
    pub title: String,
    /// Nodes \[mm\].
    pub nodes_mm: Vec<[f64; 2]>,
    /// Quads.
    pub quads: Vec<[u32; 4]>,
    /// Stress per quad \[MPa\].
    pub von_mises_mpa: Vec<f64>,
}

/// One result with what belongs to it.
#[derive(Debug)]
pub struct SceneChapter {
    /// Result.
    pub result: SceneResult,
    /// Reference, if any.
    pub record: Option<ReferenceRecord>,
    /// Stress of its gears, if it is asked for.
    pub stress: Option<Section>,
}

/// The result of a multibody scene with what belongs to it.
#[derive(Debug)]
pub struct SystemChapter {
    /// Result.
    pub result: SystemResult,
    /// Stress of its gears, if it is asked for.
    pub stress: Option<Section>,
}

/// Why no page could be made.
#[derive(Debug, thiserror::Error)]
pub enum ScenePageError {
    /// A block is wrong.
    #[error(transparent)]
    Page(#[from] PageError),
    /// A column cannot be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// The comparison failed.
    #[error(transparent)]
    Comparison(#[from] SceneComparisonError),
}

/// Pairs of a page that are drawn in space.
const MOST_IN_SPACE: usize = 4;

fn micro(values: &[f64]) -> Vec<f64> {
    values.iter().map(|v| v * 1e6).collect()
}

/// Builds the page: gear pairs first, then multibody scenes.
///
/// # Errors
/// [`ScenePageError`] when a comparison cannot be made, or a column of a result cannot be read.
pub fn scene_page(
    chapters: &[SceneChapter],
    systems: &[SystemChapter],
) -> Result<Page, ScenePageError> {
    let pairs = chapters.iter().map(|c| c.result.source.title.as_str());
    let others = systems.iter().map(|c| c.result.head.title.as_str());
    let titles: Vec<&str> = pairs.chain(others).collect();
    let mut page = match &titles[..] {
        [title] => Page::new(*title).subtitle("gearmesh report"),
        _ => Page::new("gearmesh report").subtitle(titles.join(" - ")),
    };
    // A browser draws some pictures in space at once, not dozens.
    let in_space = chapters.len() <= MOST_IN_SPACE;
    for section in chapters
        .iter()
        .map(|chapter| pair_sections(chapter, in_space))
    {
        page = section?.into_iter().fold(page, Page::section);
    }
    for chapter in systems {
        for section in system_page::sections(&chapter.result, chapter.stress.clone())? {
            page = page.section(section);
        }
    }
    let pairs = chapters
        .iter()
        .map(|c| (&c.result.source.version, &c.result.source.created_utc));
    let others = systems.iter().map(|c| &c.result);
    let others = others.map(|r| (&r.version, &r.created_utc));
    let made: Vec<String> = pairs
        .chain(others)
        .map(|(version, created)| format!("{version} {created}"))
        .collect();
    Ok(page.footer(format!("gearmesh {}", made.join(", "))))
}

/// The sections of a pair.
///
/// # Errors
/// [`ScenePageError`] when its comparison cannot be made.
fn pair_sections(chapter: &SceneChapter, in_space: bool) -> Result<Vec<Section>, ScenePageError> {
    let r = &chapter.result;
    let mut all = vec![overview(r)];
    if let Some(view) = in_space.then(|| pair_in_space::view(r)).flatten() {
        all.push(Section::new(format!("{}: pressure on the flanks", r.source.title)).push(view));
    }
    all.extend([transmission_error(chapter), contact(r)]);
    all.extend(contact_pattern::section(r));
    if !r.strain.is_empty() {
        all.push(root_strain(chapter));
    }
    all.extend(ratings::section(&r.source.title, &r.ratings));
    if let Some(record) = &chapter.record {
        let table = comparison_table(&compare_scene(r, record)?);
        all.push(
            Section::new(format!("{}: comparison", r.source.title))
                .push(Text::paragraph(format!(
                    "Both sides went through the rig pipeline. The reference is {}: {}. {}",
                    record.kind, record.title, record.source
                )))
                .push(Text::preformatted(table)),
        );
    }
    all.extend(chapter.stress.clone());
    all.push(provenance(r));
    Ok(all)
}

fn overview(r: &SceneResult) -> Section {
    let last = r.torque_nm.len() - 1;
    let of_means = mark(r.contact_coverage.is_whole());
    let (f, over) = (r.figures(last), r.overlap_width_m().ok());
    let mut figures = KeyFigures::new();
    for row in FIGURES.iter().filter(|row| r.shows(row)) {
        let mark = if row.kind == FigureKind::Torque {
            ""
        } else {
            of_means
        };
        let unit = row.kind.read_unit(over).name;
        figures = figures.figure(format!("{}{mark}", row.words), row.text(&f, over), unit);
    }
    if let Some(s) = r.strain.first() {
        let [least, most] = r.strain_ends(0, 2, last);
        let range = 1e6 * (most - least);
        figures = figures.figure(
            format!("strain range {}{}", s.name, mark(s.coverage.has_extremes())),
            format!("{range:.0}"),
            "µε",
        );
    }
    let mut section = Section::new(r.source.title.clone()).push(figures);
    section = section.push_all(torque_tables::tables(r, of_means));
    section = section.push(Text::paragraph(format!(
        "{}. Errors: {}. Curves are drawn over the even positions.",
        page::capital(&r.means_over()),
        r.errors_in_words()
    )));
    if let Ok(Some(stage)) = r.stage() {
        section = section.push(Text::paragraph(format!("Stage: {}.", stage.words())));
    }
    for (number, words) in [1, 2].into_iter().zip(&r.source.microgeometry) {
        // Results of older programs do not say.
        if !words.is_empty() {
            section = section.push(Text::paragraph(format!(
                "Flanks of gear {number}: {words}."
            )));
        }
    }
    section = section.push_all(r.incomplete().into_iter().map(Text::note));
    if !r.proposal.is_empty() {
        section = section.push(Text::note(format!("To cover it: {}", r.proposal)));
    }
    let warnings = r.warnings.iter();
    section = section.push_all(warnings.map(|text| Text::note(format!("Warning: {text}"))));
    section
}

/// What stands behind the name of a figure or curve that a longer run may change.
fn mark(is_final: bool) -> &'static str {
    if is_final { "" } else { " (incomplete)" }
}

fn angles_deg(r: &SceneResult) -> Vec<f64> {
    r.angle_rad.iter().map(|a| a.to_degrees()).collect()
}

fn angle_axis() -> Axis {
    Axis::new("driver angle", "deg")
}

/// The reference's values at our angles, in display units; none where it lacks the column.
fn reference_values(
    chapter: &SceneChapter,
    quantity: &Quantity,
    torque_nm: f64,
) -> Option<Vec<f64>> {
    let record = chapter.record.as_ref()?;
    let series = record.series(record.column(quantity, torque_nm)?).ok()?;
    let driver_turns = PairOrders::of(&chapter.result)?.driver_turns(record.shaft);
    let angles = chapter.result.angle_rad.iter();
    Some(
        angles
            .map(|&a| series.value(a / driver_turns) * 1e6)
            .collect(),
    )
}

fn transmission_error(chapter: &SceneChapter) -> Section {
    let r = &chapter.result;
    let mut chart = LineChart::new(
        format!(
            "Transmission error by torque{}",
            mark(r.contact_coverage.is_whole())
        ),
        angle_axis(),
        Axis::new("TE", "µm"),
    )
    .x_values(angles_deg(r));
    for (k, &torque) in r.torque_nm.iter().enumerate() {
        let te = r.curve(&r.te_m, k);
        // The same for a torque and its reference; other ones beside them.
        let colour = SeriesColour::Palette(k);
        chart = chart.series(LineSeries::new(format!("{torque} N m"), micro(te)).colour(colour));
        if let Some(values) = reference_values(chapter, &Quantity::TransmissionError, torque) {
            chart = chart.series(
                LineSeries::new(format!("{torque} N m reference"), values)
                    .style(LineStyle::Dashed)
                    .colour(colour),
            );
        }
    }
    let dashed = match chapter.record {
        Some(_) => " Dashed: the reference.",
        None => "",
    };
    let what = match &r.bevel {
        Some(bevel) => format!(
            "How far the gear is ahead of constant ratio at a radius of {} mm, zero where it leads most without load.",
            short(1e3 * bevel.radius_2_m)
        ),
        None => "TE = r_b2 theta_2 − r_b1 theta_1, zero where unmodified flanks first touch without load, negative under load.".to_owned(),
    };
    if r.bevel.is_some() {
        chart = chart.series(LineSeries::new("without load", micro(&r.unloaded_m)));
    }
    let section = Section::new(format!("{}: transmission error", r.source.title))
        .push(Text::paragraph(format!("{what}{dashed}")))
        .push(chart);
    match order_spectrum(r) {
        Ok(Some(spectrum)) => section.push(spectrum),
        Ok(None) => section,
        Err(problem) => section.push(Text::note(format!("No order spectrum: {problem}"))),
    }
}

/// Orders of the transmission error on the driver, first and last torque; none where the gears are not known.
fn order_spectrum(r: &SceneResult) -> Result<Option<SpectrumChart>, String> {
    let Some(pair) = PairOrders::of(r) else {
        return Ok(None);
    };
    let shaft = Shaft::Gear1;
    let mesh = pair.teeth_on(shaft) as f64;
    let mut chart = SpectrumChart::new(
        "Order spectrum of the transmission error on the driver, mean and once per revolution of either gear removed",
        Axis::new("amplitude", "µm"),
    )
    .up_to_order(2.3 * mesh)
    .decades(5)
    .highlight(mesh, "mesh");
    for order in pair.of_openings(shaft) {
        chart = chart.highlight(order, "slots or holes");
    }
    let last = r.torque_nm.len() - 1;
    let shown = if last == 0 { vec![0] } else { vec![0, last] };
    for k in shown {
        let te = r.curve(&r.te_m, k);
        let series =
            series(r, &r.contact_coverage, te, (&pair, shaft)).map_err(|e| e.to_string())?;
        let period = series.period();
        let settings = RigSettings::default().in_blocks(period.whole_revolutions(), period);
        let signal = process(&series, &settings, pair.filter(shaft)).map_err(|e| e.to_string())?;
        chart = chart
            .orders(signal.spectrum.orders())
            .series(SpectrumSeries::new(
                format!("{} N m", r.torque_nm[k]),
                micro(&signal.spectrum.amplitudes()),
            ));
    }
    Ok(Some(chart))
}

fn contact(r: &SceneResult) -> Section {
    // Over the first pitches: the load of each tooth pair, and the stiffness.
    let points = ((3.3 * r.points_per_pitch() as f64) as usize).clamp(1, r.angles());
    let x: Vec<f64> = angles_deg(r)[..points].to_vec();
    let last = r.torque_nm.len() - 1;
    let mut pairs: Vec<i64> = (0..points)
        .flat_map(|a| {
            (0..r.lines.pair_count[a] as usize)
                .map(move |slot| r.lines.pair[a * r.lines.slots + slot] as i64)
        })
        .collect();
    pairs.sort_unstable();
    pairs.dedup();
    let mut sharing = LineChart::new(
        format!("Load of each tooth pair at {} N m", r.torque_nm[last]),
        angle_axis(),
        Axis::new("normal force", "N"),
    )
    .x_values(x.clone());
    for pair in pairs {
        let values = (0..points)
            .map(|a| {
                (0..r.lines.pair_count[a] as usize)
                    .filter(|slot| r.lines.pair[a * r.lines.slots + slot] as i64 == pair)
                    .map(|slot| r.forces(last, a, slot).iter().sum::<f64>())
                    .sum()
            })
            .collect();
        sharing = sharing.series(LineSeries::new(format!("pair {pair}"), values));
    }
    let unit = FigureKind::Stiffness.read_unit(r.overlap_width_m().ok());
    let mut stiffness = LineChart::new(
        "Mesh stiffness",
        angle_axis(),
        Axis::new("stiffness", unit.name),
    )
    .x_values(x);
    for k in [0, last] {
        let torque = r.torque_nm[k];
        let part = |values: &[f64]| {
            r.curve(values, k)[..points]
                .iter()
                .map(|v| v * unit.factor)
                .collect()
        };
        stiffness = stiffness
            .series(LineSeries::new(
                format!("secant, {torque} N m"),
                part(&r.secant_n_per_m),
            ))
            .series(
                LineSeries::new(format!("tangent, {torque} N m"), part(&r.tangent_n_per_m))
                    .style(LineStyle::Dashed),
            );
        if last == 0 {
            break;
        }
    }
    Section::new(format!(
        "{}: load sharing and mesh stiffness",
        r.source.title
    ))
    .push(sharing)
    .push(stiffness)
}

fn root_strain(chapter: &SceneChapter) -> Section {
    let r = &chapter.result;
    let last = r.torque_nm.len() - 1;
    let mut section = Section::new(format!("{}: root strain", r.source.title)).push(Text::paragraph(
        "Surface strain along the profile at the gauges. Method 1 superposes deformation patterns (normal forces only), method 2 \
         puts the true loads on the finite element model. The estimated error of the mesh stands in the table.",
    ));
    let mut table = Table::new("Gauges")
        .column("gear", Align::Right)
        .column("gauge", Align::Left)
        .column("mesh error %", Align::Right);
    for s in &r.strain {
        table = table.row([
            s.gear.to_string(),
            s.name.clone(),
            s.error_estimate().map_or_else(
                || "not estimated".to_string(),
                |error| format!("{:.2}", 100.0 * error),
            ),
        ]);
        let curve = r.curve(&s.method_2, last);
        let view = PeakView::of(r, s, curve);
        let mut chart = LineChart::new(
            format!(
                "Gear {}, gauge {}, {} N m{}",
                s.gear,
                s.name,
                r.torque_nm[last],
                mark(s.coverage.has_extremes())
            ),
            angle_axis(),
            Axis::new("strain", "µε"),
        )
        .x_values(view.angles_deg(r));
        let quantity = Quantity::Strain {
            gauge: s.name.clone(),
        };
        if let Some(values) = reference_values(chapter, &quantity, r.torque_nm[last]) {
            let values = view.turned(&values);
            chart = chart.series(LineSeries::new("reference", values).style(LineStyle::Dashed));
        }
        if let Some([from, to]) = view.window_deg(r) {
            chart = chart.x_window(from, to);
        }
        section = section.push(
            chart
                .series(LineSeries::new(
                    "method 1",
                    micro(&view.turned(r.curve(&s.method_1, last))),
                ))
                .series(LineSeries::new("method 2", micro(&view.turned(curve)))),
        );
    }
    section.push(table)
}

impl From<&GearPicture> for FieldPicture {
    fn from(picture: &GearPicture) -> Self {
        // The load patches of the model would take the whole scale; the roots are what one wants to see.
        let mut sorted = picture.von_mises_mpa.clone();
        sorted.sort_by(f64::total_cmp);
        let high = sorted
            .get(sorted.len().saturating_sub(1 + sorted.len() / 1000))
            .copied()
            .unwrap_or(1.0);
        FieldPicture::new(picture.title.clone(), "von Mises stress", "MPa")
            .mesh(picture.nodes_mm.clone(), picture.quads.clone())
            .values(FieldValues::PerElement(picture.von_mises_mpa.clone()))
            .colour_range(0.0, high.max(1e-6))
    }
}

fn provenance(r: &SceneResult) -> Section {
    let section = Section::new(format!("{}: scene and gears", r.source.title))
        .push(Text::paragraph(format!(
            "gearmesh {}, computed {}; contact {:.3} s, strain {:.3} s; largest relative residual {:.1e}, torque balance {:.1e}.",
            r.source.version,
            r.source.created_utc,
            r.solution.seconds[0],
            r.solution.seconds[1],
            r.solution.residual.iter().copied().fold(0.0, f64::max),
            r.solution.torque_balance.iter().copied().fold(0.0, f64::max)
        )))
        .push(Text::preformatted(r.source.scene_toml.clone()));
    // Rigid gears have no files.
    let texts = r.source.gears.iter().filter(|gear| !gear.text.is_empty());
    texts.fold(section, |section, gear| {
        section.push(Text::preformatted(gear.text.clone()))
    })
}
