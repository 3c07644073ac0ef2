//! Tooth contact analysis of a bevel pair without load, and its page.

use crate::answer::Answer;
use crate::bevel_pair::{thickness_figures, thickness_words};
use crate::failure::{Failure, Result};
use crate::tca_sides::{
    NO_MEAN, Side, backlash_words, edge_words, figures, headline, moves, side, vh_rows,
    worth_of_points,
};
use crate::watch::Watch;
use crate::{output_name, overwriting, tca_page};
use gearmesh_bevel::vh_check::as_printed;
use gearmesh_bevel::{AssembledPair, BevelError, FlankSide, PairFile, ToothContact};
use gearmesh_geometry::input::InputDocument;
use serde::Deserialize;
use serde_json::json;
use std::path::PathBuf;

/// What is analysed and written.
#[derive(Debug, Clone, clap::Args, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TcaRequest {
    /// Bevel pair file
    pub pair: PathBuf,
    /// Page with pictures: contact pattern, transmission error, ease-off
    #[arg(long, value_name = "PAGE.html")]
    pub report: Option<PathBuf>,
}

/// Analyses the contact of a pair file without load, and makes the page. What it does under the torques of its `[load]`
/// is a scene's run.
///
/// # Errors
/// [`Failure`] for a pair that cannot be made or does not touch, and for files that cannot be read or written.
pub fn tca(a: &TcaRequest, watch: &Watch<'_>) -> Result<Answer> {
    if let Some(path) = &a.report {
        overwriting::refuse(vec![a.pair.clone()], std::slice::from_ref(path))?;
        output_name::demand_report(path)?;
    }
    let document = InputDocument::read(&a.pair)?;
    let file = PairFile::from_document(&document)?;
    let (design, _) = file.checked_design(&document)?;
    let fault = |error: BevelError| Failure::work(error.in_file(&document));
    let pair = AssembledPair::new(&file, &design).map_err(fault)?;
    pair.jam.iter().for_each(|words| watch.warning(words));
    let backlash_m = pair.backlash_m;
    let shown = |pinion: FlankSide, contact| side(&file, &design, (pinion, contact));
    let mut sides = vec![shown(file.pinion_flank, pair.driving).map_err(fault)?];
    let coast = pair.coast;
    sides.extend(
        coast
            .and_then(|contact| shown(file.pinion_flank.mate(), contact))
            .ok(),
    );
    for side in &sides {
        let words = edge_words(side.flanks[0].side, side.contact.as_ref());
        words.iter().for_each(|words| watch.warning(words));
    }
    if file.load.is_some() {
        watch.note(format!(
            "`gearmesh run {} -o RESULT.h5` finds what the pair does under the torques of its [load]; `report` and `recover` make pages, stress and fields of the result",
            a.pair.display()
        ));
    }
    let thicknesses = thickness_words(&design, &file);
    if let Some(path) = &a.report {
        let analysed = tca_page::Analysed {
            file: &file,
            sides: &sides,
            backlash_m,
            thicknesses: &thicknesses,
        };
        watch.go_on()?;
        tca_page::write(&analysed, &a.pair, path, watch)?;
    }
    let mut all = figures(&file, &sides[0]);
    all["title"] = json!(file.title);
    all["backlash_mm"] = json!(backlash_m.map(|m| 1e3 * m));
    all["thickness"] = [0, 1]
        .map(|i: usize| thickness_figures(&design.teeth[i], design.settings[i].as_ref(), &file))
        .to_vec()
        .into();
    all["other_side"] = json!(sides.get(1).map(|side| figures(&file, side)));
    Ok(Answer {
        figures: all,
        lines: table(&file, &sides, &thicknesses, backlash_m),
    })
}

fn table(
    file: &PairFile,
    sides: &[Side<'_>],
    thicknesses: &[String],
    backlash_m: Option<f64>,
) -> Vec<String> {
    let side = &sides[0];
    let mut lines = vec![format!("{}: {}", file.title, headline(side))];
    lines.extend(worth_of_points(side.flanks));
    lines.extend_from_slice(thicknesses);
    if let Some(found) = &side.contact {
        path_table(file, found, &mut lines);
        match side.moved.as_ref() {
            None => lines.push(NO_MEAN.to_owned()),
            Some(moved) => {
                lines.push(
                    "mean contact moves on the gear by     along the tooth   up the flank"
                        .to_owned(),
                );
                for (name, [along, up]) in moves(moved) {
                    lines.push(format!("{name:<37} {along:>15.4} {up:>14.4}"));
                }
            }
        }
    }
    for side in sides {
        if let Some(vh) = &side.vh {
            lines.push(format!(
                    "V/H check, {}: further errors that bring the mean contact to a quarter of the face from toe and heel, backlash kept by G",
                    side.name()
                ));
            lines.push("contact at            gear: L mm     h mm   offset E mm   pinion P mm   gear G mm   shaft angle mrad".to_owned());
            for (name, found) in vh_rows(vh) {
                lines.push(match found {
                        Ok(values) => {
                            let [l, h, v, p, g, angle] = values.map(as_printed);
                            format!(
                                "{name:<20} {l:>11.4} {h:>8.4} {v:>13.4} {p:>13.4} {g:>11.4} {angle:>18.4}"
                            )
                        }
                        Err(why) => format!("{name:<20} {why}"),
                    });
            }
        }
    }
    if let Some(backlash_m) = backlash_m {
        lines.push(backlash_words(backlash_m));
    }
    for other in &sides[1..] {
        lines.push(format!("the other flanks: {}", headline(other)));
    }
    for side in sides {
        lines.push(format!(
            "ease-off of the pinion, {}: L mm, h mm, um",
            side.name()
        ));
        for ([cone, height], e) in &side.ease_off {
            let gap = e.map_or_else(|| "-".to_owned(), |e| format!("{:.3}", 1e6 * e.gap_m));
            lines.push(format!(
                "{:>12.4} {:>9.4} {gap:>9}",
                1e3 * cone,
                1e3 * height
            ));
        }
    }
    lines
}

fn path_table(file: &PairFile, found: &ToothContact, lines: &mut Vec<String>) {
    lines.push("pinion deg   TE urad  with constant   gear: L mm     h mm   ellipse mm: long  short   first   touches".to_owned());
    for p in &found.path {
        let ellipse = p.ellipse.map_or_else(
            || format!("{:>17} {:>6}", "", ""),
            |e| {
                let [a, b] = e.half_lengths_m(file.tca.marking_m).map(|x| 1e3 * x);
                format!("{a:>17.3} {b:>6.3}")
            },
        );
        lines.push(format!(
            "{:>10.4} {:>9.3} {:>14.3} {:>12.4} {:>8.4} {ellipse}   {:<5}   {}",
            p.pinion_turn_rad.to_degrees(),
            1e6 * p.error_rad,
            1e6 * p.lead_rad,
            1e3 * p.places_m[1][0],
            1e3 * p.places_m[1][1],
            if p.leading { "yes" } else { "no" },
            p.kind.words()
        ));
    }
}
