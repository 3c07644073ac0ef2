//! The page of a tooth contact analysis: contact pattern, transmission error, ease-off, and what assembly errors do.

use crate::failure::{Failure, Result};
use crate::page_file;
use crate::tca_sides::{NO_MEAN, Side, headline, moves, vh_rows, worth_of_points};
use crate::watch::Watch;
use gearmesh_bevel::tca::{PathPoint, ease_off_map};
use gearmesh_bevel::vh_check::as_printed;
use gearmesh_bevel::{
    Assembly, BevelError, ContactKind, EaseOff, Flank, MemberBlank, PairFile, ToothContact,
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
    /// The side that drives, and the other one where it has contacts.
    pub sides: &'a [Side<'a>],
    /// Least normal backlash in this assembly.
    pub backlash_m: Option<f64>,
    /// How thick the teeth are.
    pub thicknesses: &'a [String],
}

/// Writes the page.
///
/// # Errors
/// [`Failure`] where the page cannot be made or the file not be written.
pub fn write(of: &Analysed<'_>, pair: &Path, path: &Path, watch: &Watch<'_>) -> Result<()> {
    let page = page(of, pair)?;
    page_file::write(&page, path, watch)
}

fn page(of: &Analysed<'_>, pair: &Path) -> Result<Page> {
    let page = Page::new(of.file.title.clone()).subtitle(format!(
        "Tooth contact analysis: {}, without load",
        of.sides[0].name()
    ));
    let mut pattern = Section::new("Contact pattern").push(Text::paragraph(format!(
        "What touches at the positions at which this pair of teeth leads: ellipses on which the flanks are nearer than {} µm, and the path. \
         Across is the distance from the apex along the pitch cone, up the height above it. The flanks that drive first, then the others.",
        short(1e6 * of.file.tca.marking_m)
    )));
    let mut errors = Section::new("Transmission error");
    let mut ease_offs = Section::new("Ease-off");
    let mut moves = Section::new("Assembly errors");
    for side in of.sides {
        match &side.contact {
            Some(contact) => {
                for member in [1, 0] {
                    let drawn = self::pattern(of, (side.flanks, contact), member);
                    pattern = pattern.push(drawn.map_err(Failure::work)?);
                }
                errors = errors.push(error(of, side, contact));
                moves = assembly_errors(moves, side);
            }
            None => pattern = pattern.push(Text::paragraph(headline(side))),
        }
        ease_offs = ease_offs.push(ease_off(of, side).map_err(Failure::work)?);
    }
    Ok(page
        .section(at_a_glance(of))
        .section(pattern)
        .section(errors)
        .section(ease_offs)
        .section(moves)
        .footer(format!(
            "{} by gearmesh {}",
            pair.display(),
            env!("CARGO_PKG_VERSION")
        )))
}

fn at_a_glance(of: &Analysed<'_>) -> Section {
    let error = &of.file.tca.error;
    let figures = KeyFigures::new();
    let figures = of
        .sides
        .iter()
        .enumerate()
        .fold(figures, |figures, (i, side)| {
            let Some(contact) = &side.contact else {
                return figures;
            };
            let whose = if i == 0 { "" } else { "other flanks: " };
            figures
                .figure(
                    format!("{whose}transmission error, peak to peak"),
                    short(1e6 * contact.peak_to_peak_rad),
                    "µrad of the gear",
                )
                .figure(
                    format!("{whose}contact ratio of the path"),
                    short(contact.contact_ratio),
                    "",
                )
                .figure(
                    format!("{whose}edges touch first on"),
                    short(100.0 * contact.edge_share),
                    "% of the path",
                )
        });
    let figures = of.backlash_m.into_iter().fold(figures, |figures, m| {
        figures.figure("least normal backlash", short(1e6 * m), "µm")
    });
    let figures = figures
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
    let worth = of.sides.iter().flat_map(|s| worth_of_points(s.flanks));
    worth
        .chain(of.thicknesses.iter().cloned())
        .fold(section, |section, words| {
            section.push(Text::paragraph(words))
        })
}

/// The flank of a member with its ellipses and the path.
fn pattern(
    of: &Analysed<'_>,
    (flanks, contact): ([&Flank; 2], &ToothContact),
    member: usize,
) -> Result<FlankChart, BevelError> {
    let flank = flanks[member];
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
    let drawn = |point: &&PathPoint| point.leading && !point.is_between;
    for point in contact.path.iter().filter(drawn) {
        if let Some(corners) = ellipse((of, blank), &assembly, member, point) {
            chart = chart.patch(mm(corners));
        }
    }
    let places = |wanted: &dyn Fn(&PathPoint) -> bool| {
        let path = contact.path.iter().filter(|p| wanted(p));
        mm(path.map(|p| p.places_m[member]).collect())
    };
    let on_flanks = |p: &PathPoint| p.kind == ContactKind::Flanks;
    chart = chart.line("path of contact", places(&on_flanks));
    for (edge, points) in edges(&contact.path) {
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

/// Corners of a contact's ellipse on a member: cone distance and height. None at edges, and where the flanks are
/// nearer than the marking all along.
fn ellipse(
    (of, blank): (&Analysed<'_>, &MemberBlank),
    assembly: &Assembly,
    member: usize,
    point: &PathPoint,
) -> Option<Vec<[f64; 2]>> {
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
fn error(of: &Analysed<'_>, side: &Side<'_>, contact: &ToothContact) -> LineChart {
    let pitch = 360.0 / of.file.blank.data.teeth[0] as f64;
    let step = pitch / of.file.tca.per_pitch as f64;
    let own: Vec<[f64; 2]> = contact
        .path
        .iter()
        .map(|p| [p.pinion_turn_rad.to_degrees(), 1e6 * p.error_rad])
        .collect();
    let mut x: Vec<f64> = [-pitch, 0.0, pitch]
        .into_iter()
        .flat_map(|by| own.iter().map(move |p| p[0] + by))
        .collect();
    x.sort_by(f64::total_cmp);
    x.dedup_by(|a, b| (*a - *b).abs() < 1e-9 * pitch);
    // Turns at which a pair does not touch stay empty; between its own positions a pair is drawn straight.
    let pair = |ahead: f64| {
        let at = |x: &f64| {
            let turn = x - ahead * pitch;
            let near = |p: &&[f64; 2]| (p[0] - turn).abs() < 1e-9 * pitch;
            if let Some(p) = own.iter().find(near) {
                return p[1];
            }
            let next = own.partition_point(|p| p[0] < turn);
            let [Some(a), Some(b)] = [next.checked_sub(1), Some(next)].map(|i| own.get(i?)) else {
                return f64::NAN;
            };
            if b[0] - a[0] > 1.5 * step {
                return f64::NAN;
            }
            a[1] + (b[1] - a[1]) * (turn - a[0]) / (b[0] - a[0])
        };
        x.iter().map(at).collect::<Vec<_>>()
    };
    let chart = LineChart::new(
        format!(
            "Transmission error of three pairs of teeth, {}; the uppermost one leads",
            side.name()
        ),
        Axis::new("turn of the pinion", "deg"),
        Axis::new("gear ahead of constant ratio", "µrad"),
    );
    chart
        .series(LineSeries::new("pair before", pair(-1.0)))
        .series(LineSeries::new("this pair", pair(0.0)))
        .series(LineSeries::new("pair after", pair(1.0)))
        .x_values(x)
}

fn ease_off(of: &Analysed<'_>, side: &Side<'_>) -> Result<FieldPicture, BevelError> {
    let map = ease_off_map(side.flanks, &of.file.blank, &of.file.tca.error, MAP)?;
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
        format!(
            "What the pinion's flank lacks of the gear's conjugate, toe left, tip up: {}",
            side.name()
        ),
        "ease-off",
        "µm",
    )
    .mesh(nodes.collect(), quads)
    .values(FieldValues::PerNode(values.collect())))
}

fn assembly_errors(section: Section, side: &Side<'_>) -> Section {
    let section = match &side.moved {
        None => section.push(Text::paragraph(format!("{}: {NO_MEAN}", side.name()))),
        Some(moved) => {
            let mut table = Table::new(format!(
                "How the mean contact moves on the gear: {}",
                side.name()
            ))
            .column("by", Align::Left)
            .columns(Align::Right, ["along the tooth", "up the flank"]);
            for (name, [along, up]) in moves(moved) {
                table.push_row([name.to_owned(), short(along), short(up)]);
            }
            section.push(table)
        }
    };
    let Some(vh) = &side.vh else {
        return section;
    };
    let mut table = Table::new(format!(
        "V/H check: further errors that bring the mean contact to a quarter of the face from toe and heel, backlash kept by G: {}",
        side.name()
    ))
    .column("contact at", Align::Left);
    for name in [
        "gear: L mm",
        "h mm",
        "offset E mm",
        "pinion P mm",
        "gear G mm",
        "shaft angle mrad",
    ] {
        table = table.column(name, Align::Right);
    }
    let mut unreached = Vec::new();
    for (name, found) in vh_rows(vh) {
        match found {
            Ok(values) => {
                let [l, h, v, p, g, angle] = values.map(|x| format!("{:.4}", as_printed(x)));
                table.push_row([name.to_owned(), l, h, v, p, g, angle]);
            }
            Err(why) => unreached.push(Text::paragraph(format!("{name}: {why}"))),
        }
    }
    unreached
        .into_iter()
        .fold(section.push(table), |section, words| section.push(words))
}
