//! Sections of shafts: read from a model, joined without gaps or overlaps, and demanded where it has none.

use crate::error::Result;
use crate::ledger::About;
use crate::material::material;
use crate::shaft::{MOST_RPM, SAME_MM, Section, Shaft};
use crate::source::Part;
use crate::units::{MM, RPM};
use crate::vectors::Frame;

/// Pieces of a taper.
const TAPER_PIECES: usize = 3;

/// Reads a shaft with its sections.
///
/// # Errors
/// Those of [`Part`].
pub fn read(component: Part<'_>, name: String, frame: Option<Frame>) -> Result<Shaft> {
    let mut sections = Vec::new();
    let mut end_mm = 0.0;
    for piece in component.parts(&["shaft_section"]) {
        let Some(length) = piece.positive("length", MM)? else {
            piece.leave_out(About::Stiffness, "a section without length");
            continue;
        };
        let start = piece.number("u_coordinate_on_shaft", MM)?.unwrap_or(end_mm);
        end_mm = start + length;
        let Some(diameters) = diameters_mm(piece)? else {
            let what = "a section without an outer diameter";
            piece.leave_out(About::Stiffness, what);
            continue;
        };
        add_pieces(piece, (start, length), diameters, &mut sections);
    }
    sections.sort_by(|a, b| a.start_mm.total_cmp(&b.start_mm));
    let mut sections = part_overlaps(component, sections);
    close_gaps(component, &mut sections);
    let speed = component.number_up_to("rotational_speed", RPM, MOST_RPM)?;
    let defines = component.flag("defines_speed")?;
    let mut shaft = Shaft::default();
    (shaft.id, shaft.name, shaft.frame) = (component.id, name, frame);
    shaft.sections = sections;
    shaft.material = material(component)?;
    shaft.speed_rpm = speed.filter(|n| *n != 0.0 && defines != Some(false));
    Ok(shaft)
}

/// Outer and inner diameters of a section at its begin and end \[mm\]; none without an outer one.
fn diameters_mm(piece: Part<'_>) -> Result<Option<[[f64; 2]; 2]>> {
    let value = |id: &str| piece.number(id, MM);
    let [outer_0, outer_1] = [value("outer_diameter_begin")?, value("outer_diameter_end")?];
    let [inner_0, inner_1] = [value("inner_diameter_begin")?, value("inner_diameter_end")?];
    let outer = outer_0.or(outer_1).filter(|d| *d > 0.0);
    Ok(outer.map(|outer| {
        let end = outer_1.filter(|d| *d > 0.0).unwrap_or(outer);
        [
            [outer_0.unwrap_or(outer), end],
            [
                inner_0.or(inner_1).unwrap_or(0.0),
                inner_1.or(inner_0).unwrap_or(0.0),
            ],
        ]
    }))
}

/// A section as cylinders: one, or those that stand for a taper.
fn add_pieces(
    piece: Part<'_>,
    (start, length): (f64, f64),
    [outer, inner]: [[f64; 2]; 2],
    sections: &mut Vec<Section>,
) {
    let is_taper = outer[0] != outer[1] || inner[0] != inner[1];
    if is_taper {
        // Bending stiffness goes with d^4: 1/d^4 along the taper, and in the middles of its pieces.
        let [a, b] = outer;
        let exact = (a.powi(-3) - b.powi(-3)) / (3.0 * (b - a));
        let middles = (0..TAPER_PIECES)
            .map(|k| a + (b - a) * (k as f64 + 0.5) / TAPER_PIECES as f64)
            .map(|d| d.powi(-4) / TAPER_PIECES as f64);
        let off = (middles.sum::<f64>() / exact - 1.0).abs();
        piece.assume(
            About::by(off > 1e-2 || inner[0] != inner[1], About::Stiffness),
            format!("a taper: {TAPER_PIECES} cylinders of its diameters in their middles"),
        );
    }
    let pieces = if is_taper { TAPER_PIECES } else { 1 };
    for k in 0..pieces {
        let at = |d: [f64; 2]| d[0] + (d[1] - d[0]) * (k as f64 + 0.5) / pieces as f64;
        let [outer_mm, mut inner_mm] = [at(outer), at(inner).max(0.0)];
        if inner_mm >= outer_mm {
            piece.leave_out(
                About::Stiffness,
                format!(
                    "an inner diameter of {inner_mm} mm, which is not below the outer one: solid"
                ),
            );
            inner_mm = 0.0;
        }
        let step = length / pieces as f64;
        sections.push(Section {
            start_mm: start + k as f64 * step,
            end_mm: start + (k + 1) as f64 * step,
            outer_mm,
            inner_mm,
        });
    }
}

/// Where pieces overlap, all of them are there, as a collar that is drawn over a shaft.
fn part_overlaps(component: Part<'_>, sections: Vec<Section>) -> Vec<Section> {
    let mut reach = f64::MIN;
    let mut has_overlap = false;
    for section in &sections {
        has_overlap |= reach - section.start_mm > 1e-6;
        reach = reach.max(section.end_mm);
    }
    if !has_overlap {
        return sections;
    }
    let what = "sections overlap: there the largest outer and the smallest inner diameter count";
    component.assume(About::Stiffness, what);
    let mut borders: Vec<f64> = sections
        .iter()
        .flat_map(|s| [s.start_mm, s.end_mm])
        .collect();
    borders.sort_by(f64::total_cmp);
    borders.dedup_by(|a, b| (*a - *b).abs() < 1e-6);
    // Pieces that begin before the middle of a strip and have not ended, in the order of their starts.
    let mut next = 0;
    let mut here: Vec<Section> = Vec::new();
    let piece = |w: &[f64]| {
        let middle = 0.5 * (w[0] + w[1]);
        while next < sections.len() && sections[next].start_mm < middle {
            here.push(sections[next]);
            next += 1;
        }
        here.retain(|s| middle < s.end_mm);
        here.first()?;
        Some(Section {
            start_mm: w[0],
            end_mm: w[1],
            outer_mm: here.iter().map(|s| s.outer_mm).fold(0.0, f64::max),
            inner_mm: here.iter().map(|s| s.inner_mm).fold(f64::MAX, f64::min),
        })
    };
    borders.windows(2).filter_map(piece).collect()
}

/// Each piece ends where the next one begins.
fn close_gaps(component: Part<'_>, sections: &mut [Section]) {
    for i in 1..sections.len() {
        let (start, end) = (sections[i].start_mm, sections[i - 1].end_mm);
        if (start - end).abs() > 1e-6 {
            let length = end - sections[i - 1].start_mm;
            component.assume(About::by((start - end).abs() > 1e-2 * length, About::Stiffness),
                format!(
                    "sections do not join at u = {start} mm ({} of {:.6} mm): the one before ends there",
                    if start > end { "gap" } else { "overlap" },
                    (start - end).abs()
                ),
            );
        }
        sections[i - 1].end_mm = start;
    }
}

/// Shafts that are longer than this many diameters are none of a gearbox.
const MOST_SLENDER: f64 = 100.0;

/// A shaft without sections: one as thick as what sits on it, and long enough.
pub fn demand_sections(component: Part<'_>, shaft: &mut Shaft, bores_mm: &[f64]) {
    let [least, most] = shaft.marked_mm();
    if shaft.sections.is_empty() {
        let outer = bores_mm.iter().copied().fold(f64::MAX, f64::min);
        let outer_mm = if outer < 1e6 { outer } else { 30.0 };
        let [start_mm, end_mm] = if least < most {
            [least, most]
        } else {
            [0.0, 100.0]
        };
        component.assume(
            About::Stiffness,
            format!("no sections given: {outer_mm} mm thick from u = {start_mm} to {end_mm} mm"),
        );
        shaft.give(Section {
            start_mm,
            end_mm,
            outer_mm,
            inner_mm: 0.0,
        });
    }
    let ends = [
        shaft.sections.first().map(|s| s.start_mm),
        shaft.sections.last().map(|s| s.end_mm),
    ];
    if let [Some(start), Some(end)] = ends {
        for u in [least, most] {
            if u.abs() < 1e9 && (u < start - SAME_MM || u > end + SAME_MM) {
                // Something that hangs over by less than the shaft is thick may be drawn so; more is a slip of a
                // coordinate.
                let beyond = (start - u).max(u - end);
                let is_slip = beyond > shaft.diameters_mm(u)[0];
                let about = if is_slip {
                    About::Lost
                } else {
                    About::Stiffness
                };
                let what = format!(
                    "something stands at u = {u} mm, beyond its sections ({start} to {end} mm): the last section goes on to there, the shaft is \
                     {:.6} mm longer",
                    beyond
                );
                component.assume(about, what);
            }
        }
        let thickest = shaft.sections.iter().map(|s| s.outer_mm);
        let thickest = thickest.fold(0.0, f64::max);
        let length = end.max(most) - start.min(least);
        if least <= most && length > MOST_SLENDER * thickest {
            let what = format!(
                "{length} mm long and {thickest} mm thick at most: look at the places along u of what stands on it"
            );
            component.assume(About::Lost, what);
        }
    }
}
