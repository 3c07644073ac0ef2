//! The page of `gearmesh tca --report`: contact pattern, transmission error, ease-off, and what assembly errors do.

use super::loaded_tca::{self, Loaded};
use super::tca::{NO_MEAN, moves, worth_of_points};
use crate::arguments::TcaArguments;
use crate::failure::Failure;
use crate::page_file;
use gearmesh_bevel::tca::{PathPoint, ease_off_map};
use gearmesh_bevel::{
    Assembly, BevelError, ContactKind, EaseOff, Flank, PairFile, Sensitivity, ToothContact,
};
use gearmesh_report::page::{
    Align, Axis, FieldPicture, FieldValues, FlankChart, KeyFigures, LineChart, LineSeries, Page,
    Section, Table, Text,
};
use gearmesh_report::short;
use std::path::Path;

/// Places of the ease-off's picture along the face and up the flank.
const MAP: [usize; 2] = [25, 13];
/// Places along the face of a flank's lower end.
const BOTTOM: usize = 13;
/// Corners of a drawn ellipse.
const CORNERS: usize = 48;

/// What was analysed.
pub struct Analysed<'a> {
    pub file: &'a PairFile,
    /// Pinion and gear.
    pub flanks: [&'a Flank; 2],
    pub contact: &'a ToothContact,
    pub moved: Option<&'a Sensitivity>,
    /// Under load, where the file asks for it.
    pub loaded: Option<&'a Loaded>,
    /// Pictures of both members' stress, where they are asked for.
    pub stress: Option<Section>,
}

/// Writes the page.
///
/// # Errors
/// [`Failure`] where the page cannot be made or the file not be written.
pub fn write(of: &Analysed<'_>, a: &TcaArguments, path: &Path) -> Result<(), Failure> {
    page_file::write(&page(of, a).map_err(Failure::work)?, path)
}

fn page(of: &Analysed<'_>, a: &TcaArguments) -> Result<Page, BevelError> {
    let [pinion, gear] = of.flanks.map(|flank| flank.side.word());
    let pattern = Section::new("Contact pattern")
        .push(Text::paragraph(format!(
            "What touches at the positions at which this pair of teeth leads: ellipses on which the flanks are nearer than {} µm, and the path. \
             Across is the distance from the apex along the pitch cone, up the height above it.",
            short(1e6 * of.file.tca.marking_m)
        )))
        .push(pattern(of, 1)?)
        .push(pattern(of, 0)?);
    let load = of
        .loaded
        .map_or("without load", |_| "without and with load");
    let mut page = Page::new(of.file.title.clone())
        .subtitle(format!(
            "Tooth contact analysis: pinion {pinion} on gear {gear}, {load}"
        ))
        .section(at_a_glance(of));
    if let Some(loaded) = of.loaded {
        page = page.section(loaded_tca::section(loaded));
    }
    if let Some(stress) = &of.stress {
        page = page.section(stress.clone());
    }
    Ok(page
        .section(pattern)
        .section(Section::new("Transmission error").push(error(of)))
        .section(Section::new("Ease-off").push(ease_off(of)?))
        .section(assembly_errors(of))
        .footer(format!(
            "{} by gearmesh {}",
            a.pair.display(),
            env!("CARGO_PKG_VERSION")
        )))
}

fn at_a_glance(of: &Analysed<'_>) -> Section {
    let error = &of.file.tca.error;
    let under_load = of.loaded.iter().flat_map(|loaded| &loaded.found);
    let figures = under_load.fold(KeyFigures::new(), |figures, found| {
        figures.figure(
            format!(
                "transmission error at {} N m, peak to peak",
                found.torque_nm
            ),
            short(1e6 * found.peak_to_peak_rad()),
            "µrad of the gear",
        )
    });
    let name = match of.loaded {
        Some(_) => "transmission error without load, peak to peak",
        None => "transmission error, peak to peak",
    };
    let figures = figures
        .figure(
            name,
            short(1e6 * of.contact.peak_to_peak_rad),
            "µrad of the gear",
        )
        .figure(
            "contact ratio of the path",
            short(of.contact.contact_ratio),
            "",
        )
        .figure(
            "edges touch first on",
            short(100.0 * of.contact.edge_share),
            "% of the path",
        )
        .figure(
            "assembled with offset, pinion axial, gear axial",
            [error.offset_m, error.pinion_axial_m, error.gear_axial_m]
                .map(|x| short(1e6 * x))
                .join(", "),
            "µm",
        )
        .figure(
            "and shaft angle off by",
            short(1e3 * error.shaft_angle_rad),
            "mrad",
        );
    let section = Section::new("At a glance").push(figures);
    worth_of_points(of.flanks)
        .into_iter()
        .fold(section, |section, words| {
            section.push(Text::paragraph(words))
        })
}

/// The flank of a member with its ellipses and the path.
fn pattern(of: &Analysed<'_>, member: usize) -> Result<FlankChart, BevelError> {
    let flank = of.flanks[member];
    let blank = &flank.blank;
    let (toe, heel) = (blank.inner_cone_m(), blank.outer_cone_m);
    let mut outline = Vec::new();
    for i in 0..BOTTOM {
        let cone = toe + (heel - toe) * i as f64 / (BOTTOM - 1) as f64;
        let bottom = flank.bottom(cone)?;
        outline.push(flank.place(&bottom.point.r));
    }
    outline.extend([heel, toe].map(|cone| [cone, blank.addendum_m(cone)]));
    let mm = |points: Vec<[f64; 2]>| -> Vec<[f64; 2]> {
        points.iter().map(|p| p.map(|x| 1e3 * x)).collect()
    };
    let name = format!("{} of the {}", flank.side.word(), blank.name);
    let mut chart = FlankChart::new(format!("Flank: {name}"), mm(outline));
    let assembly = Assembly::new(&of.file.blank, &of.file.tca.error);
    for point in of.contact.path.iter().filter(|point| point.leading) {
        if let Some(corners) = ellipse(of, &assembly, member, point) {
            chart = chart.patch(mm(corners));
        }
    }
    let places = |wanted: &dyn Fn(&PathPoint) -> bool| {
        let path = of.contact.path.iter().filter(|p| wanted(p));
        mm(path.map(|p| p.places_m[member]).collect())
    };
    let on_flanks = |p: &PathPoint| p.kind == ContactKind::Flanks;
    chart = chart.line("path of contact", places(&on_flanks));
    for (edge, points) in edges(&of.contact.path) {
        chart = chart.line(
            edge,
            mm(points.iter().map(|p| p.places_m[member]).collect()),
        );
    }
    Ok(chart)
}

/// Contacts of each edge, in the order of the path.
fn edges(path: &[PathPoint]) -> Vec<(String, Vec<&PathPoint>)> {
    let mut found: Vec<(String, Vec<&PathPoint>)> = Vec::new();
    for point in path.iter().filter(|p| p.kind != ContactKind::Flanks) {
        let name = point.kind.words();
        match found.iter_mut().find(|(known, _)| *known == name) {
            Some((_, points)) => points.push(point),
            None => found.push((name, vec![point])),
        }
    }
    found
}

/// Corners of a contact's ellipse on a member: cone distance and height. None at edges, and where the flanks are nearer than the
/// marking all along.
fn ellipse(
    of: &Analysed<'_>,
    assembly: &Assembly,
    member: usize,
    point: &PathPoint,
) -> Option<Vec<[f64; 2]>> {
    let blank = &of.flanks[member].blank;
    let marking = of.file.tca.marking_m;
    let [long, short] = point.ellipse?.on_flank_m(
        marking,
        &point.touch,
        (&assembly.members[member], blank, member),
    )?;
    let centre = point.places_m[member];
    let corner = |i: usize| {
        let (sin, cos) = (std::f64::consts::TAU * i as f64 / CORNERS as f64).sin_cos();
        [0, 1].map(|k| centre[k] + cos * long[k] + sin * short[k])
    };
    Some((0..CORNERS).map(corner).collect())
}

/// The curve of this pair of teeth, and of the pairs before and after it.
fn error(of: &Analysed<'_>) -> LineChart {
    let pitch = 360.0 / of.file.blank.data.teeth[0] as f64;
    let path = &of.contact.path;
    let turns: Vec<f64> = path
        .iter()
        .map(|p| p.pinion_turn_rad.to_degrees())
        .collect();
    let values: Vec<f64> = path.iter().map(|p| 1e6 * p.error_rad).collect();
    let step = pitch / of.file.tca.per_pitch as f64;
    let (first, last) = (turns[0], turns[turns.len() - 1]);
    let number = |x: f64| (x / step).round() as i64;
    let x: Vec<i64> = (number(first - pitch)..=number(last + pitch)).collect();
    // Turns at which a pair does not touch stay empty.
    let pair = |ahead: i64| {
        x.iter()
            .map(|i| {
                let own = i - ahead * of.file.tca.per_pitch as i64;
                let found = turns.iter().position(|turn| number(*turn) == own);
                found.map_or(f64::NAN, |k| values[k])
            })
            .collect::<Vec<_>>()
    };
    LineChart::new(
        "Transmission error of three pairs of teeth; the uppermost one leads",
        Axis::new("turn of the pinion", "deg"),
        Axis::new("gear ahead of constant ratio", "µrad"),
    )
    .x_values(x.iter().map(|i| *i as f64 * step).collect())
    .series(LineSeries::new("pair before", pair(-1)))
    .series(LineSeries::new("this pair", pair(0)))
    .series(LineSeries::new("pair after", pair(1)))
}

fn ease_off(of: &Analysed<'_>) -> Result<FieldPicture, BevelError> {
    let map = ease_off_map(of.flanks, &of.file.blank, &of.file.tca.error, MAP)?;
    let nodes = map.iter().map(|(place, _)| place.map(|x| 1e3 * x));
    let gap = |e: &Option<EaseOff>| e.map_or(0.0, |e| 1e6 * e.gap_m);
    let values = map.iter().map(|(_, e)| gap(e));
    let [along, up] = MAP.map(|n| n as u32);
    let quads = (0..along - 1).flat_map(|i| (0..up - 1).map(move |k| i * up + k));
    // Where the pinion's flank is undercut nothing is drawn.
    let quads = quads
        .map(|n| [n, n + up, n + up + 1, n + 1])
        .filter(|quad| quad.iter().all(|n| map[*n as usize].1.is_some()))
        .collect();
    Ok(FieldPicture::new(
        "What the pinion's flank lacks of the gear's conjugate, toe left, tip up",
        "ease-off",
        "µm",
    )
    .mesh(nodes.collect(), quads)
    .values(FieldValues::PerNode(values.collect())))
}

fn assembly_errors(of: &Analysed<'_>) -> Section {
    let section = Section::new("Assembly errors");
    let Some(moved) = of.moved else {
        return section.push(Text::paragraph(NO_MEAN));
    };
    let mut table = Table::new("How the mean contact moves on the gear")
        .column("by", Align::Left)
        .column("along the tooth", Align::Right)
        .column("up the flank", Align::Right);
    for (name, [along, up]) in moves(moved) {
        table.push_row([name.to_owned(), short(along), short(up)]);
    }
    section.push(table)
}
