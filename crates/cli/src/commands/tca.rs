//! `gearmesh tca`: tooth contact analysis of a bevel pair.

use crate::arguments::TcaArguments;
use crate::commands::{bevel, bevel_stress, loaded_tca, tca_page};
use crate::console;
use crate::failure::Failure;
use crate::output_name;
use gearmesh_bevel::{Flank, PairFile, Sensitivity, ToothContact, sensitivity, tooth_contact};
use gearmesh_geometry::input::InputDocument;
use serde_json::{Value, json};

/// Runs the command.
pub fn run(a: &TcaArguments) -> Result<(), Failure> {
    if let Some(path) = &a.report {
        output_name::demand_report(path)?;
    }
    if let Some(path) = &a.field_output {
        output_name::demand_mesh(path)?;
    }
    let document = InputDocument::read(&a.pair)?;
    let file = PairFile::from_document(&document)?;
    let (design, _) = file.checked_design(&document)?;
    let flanks = design.flanks(file.pinion_flank);
    let found = tooth_contact(flanks, &file.blank, &file.tca)
        .map_err(|error| Failure::work(error.in_file(&document)))?;
    // Where only edges touch, or along a line, no contact moves with the errors.
    let moved = found
        .mean
        .and_then(|_| sensitivity(flanks, &file.blank, &file.tca.error).ok());
    let loaded = match &file.load {
        Some(load) => Some(loaded_tca::analyse((&file, &design), load, &a.pair)?),
        None => None,
    };
    let (stress, stress_figures) = bevel_stress::asked(a, loaded.as_ref())?.unzip();
    if let Some(path) = &a.report {
        let analysed = tca_page::Analysed {
            file: &file,
            flanks,
            contact: &found,
            moved: moved.as_ref(),
            loaded: loaded.as_ref(),
            stress,
        };
        tca_page::write(&analysed, a, path)?;
    }
    if a.json {
        let mut all = figures(&file, flanks, &found, moved.as_ref());
        if let (Some(loaded), Some(all)) = (&loaded, all.as_object_mut()) {
            all.insert("load".to_owned(), loaded_tca::figures(loaded));
            if let Some(figures) = stress_figures {
                all.insert("stress".to_owned(), figures.into());
            }
        }
        console::json(&all);
    } else {
        if let Some(loaded) = &loaded {
            loaded_tca::table(&file, loaded);
        }
        let teeth = design.teeth.iter();
        let thicknesses: Vec<String> = teeth
            .filter_map(|tooth| bevel::thickness_words(tooth, &file))
            .collect();
        table(&file, flanks, &thicknesses, &found, moved.as_ref());
    }
    Ok(())
}

/// Said instead of sensitivities.
pub(super) const NO_MEAN: &str = "the flanks have no contact at constant ratio in this assembly: nothing is said of what further errors do";

/// Names, and how the mean contact moves along the tooth and up the flank: mm per mm, mm per mrad.
pub(super) fn moves(s: &Sensitivity) -> [(&'static str, [f64; 2]); 4] {
    [
        ("offset, mm per mm", s.offset),
        ("pinion axial, mm per mm", s.pinion_axial),
        ("gear axial, mm per mm", s.gear_axial),
        ("shaft angle, mm per mrad", s.shaft_angle),
    ]
}

/// What is to be known of flanks through points: how well they fit, and what that is beside the transmission error. Nothing of flanks
/// that were cut.
pub(super) fn worth_of_points(flanks: [&Flank; 2]) -> Vec<String> {
    let words = |flank: &Flank| {
        let fit = flank.grid_fit()?;
        // Material along the normal turns the gear by its amount over the arm of the normal about the gear's axis.
        let mean = &flanks[1].mean().point;
        let arm_m = (mean.r.x * mean.n.y - mean.r.y * mean.n.x).abs();
        Some(format!(
            "{}: {}; {:.3} um turn the gear by {:.3} urad",
            flank.name(),
            bevel::fit_words(fit),
            1e6 * fit.left_out_rms_m,
            1e6 * fit.left_out_rms_m / arm_m
        ))
    };
    flanks.into_iter().filter_map(words).collect()
}

fn table(
    file: &PairFile,
    flanks: [&Flank; 2],
    thicknesses: &[String],
    found: &ToothContact,
    moved: Option<&Sensitivity>,
) {
    console::data(format!(
        "{}: pinion {} on gear {}; transmission error peak to peak {:.3} urad of the gear, contact ratio of the path {:.4}, edges touch first on {:.1} % of it",
        file.title,
        file.pinion_flank.word(),
        file.pinion_flank.mate().word(),
        1e6 * found.peak_to_peak_rad,
        found.contact_ratio,
        100.0 * found.edge_share
    ));
    worth_of_points(flanks).into_iter().for_each(console::data);
    thicknesses.iter().for_each(console::data);
    console::data(
        "pinion deg   TE urad   gear: L mm     h mm   ellipse mm: long  short   first   touches",
    );
    for p in &found.path {
        let ellipse = p.ellipse.map_or_else(
            || format!("{:>17} {:>6}", "", ""),
            |e| {
                let [a, b] = e.half_lengths_m(file.tca.marking_m).map(|x| 1e3 * x);
                format!("{a:>17.3} {b:>6.3}")
            },
        );
        console::data(format!(
            "{:>10.4} {:>9.3} {:>12.4} {:>8.4} {ellipse}   {:<5}   {}",
            p.pinion_turn_rad.to_degrees(),
            1e6 * p.error_rad,
            1e3 * p.places_m[1][0],
            1e3 * p.places_m[1][1],
            if p.leading { "yes" } else { "no" },
            p.kind.words()
        ));
    }
    match moved {
        None => console::data(NO_MEAN),
        Some(moved) => {
            console::data("mean contact moves on the gear by     along the tooth   up the flank");
            for (name, [along, up]) in moves(moved) {
                console::data(format!("{name:<37} {along:>15.4} {up:>14.4}"));
            }
        }
    }
    console::data("ease-off of the pinion: L mm, h mm, um");
    for ([cone, height], e) in &found.ease_off {
        let gap = e.map_or_else(|| "-".to_owned(), |e| format!("{:.3}", 1e6 * e.gap_m));
        console::data(format!(
            "{:>12.4} {:>9.4} {gap:>9}",
            1e3 * cone,
            1e3 * height
        ));
    }
}

fn figures(
    file: &PairFile,
    flanks: [&Flank; 2],
    found: &ToothContact,
    moved: Option<&Sensitivity>,
) -> Value {
    let path: Vec<Value> = found
        .path
        .iter()
        .map(|p| {
            let ellipse = p.ellipse.map(|e| {
                e.half_lengths_m(file.tca.marking_m)
                    .map(|x| x.is_finite().then_some(1e3 * x))
            });
            json!({
                "pinion_deg": p.pinion_turn_rad.to_degrees(),
                "error_urad": 1e6 * p.error_rad,
                "touches": p.kind.words(),
                "first": p.leading,
                "pinion_place_mm": p.places_m[0].map(|x| 1e3 * x),
                "gear_place_mm": p.places_m[1].map(|x| 1e3 * x),
                "ellipse_half_lengths_mm": ellipse,
            })
        })
        .collect();
    let map: Vec<Value> = found
        .ease_off
        .iter()
        .map(|([l, h], e)| json!([1e3 * l, 1e3 * h, e.map(|e| 1e6 * e.gap_m)]))
        .collect();
    json!({
        "title": file.title,
        "pinion_flank": file.pinion_flank.word(),
        "peak_to_peak_urad": 1e6 * found.peak_to_peak_rad,
        "contact_ratio": found.contact_ratio,
        "edge_share": found.edge_share,
        "fit_of_points": flanks.map(|flank| flank.grid_fit().map(bevel::fit_figures)),
        "error_urad": found.error_rad.iter().map(|x| 1e6 * x).collect::<Vec<_>>(),
        "path": path,
        "ease_off_mm_mm_um": map,
        "sensitivity": moved.map(|moved| moves(moved).into_iter().map(|(k, v)| (k.to_owned(), json!(v))).collect::<serde_json::Map<_, _>>()),
    })
}
