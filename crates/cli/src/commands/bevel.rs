//! `gearmesh bevel`: blank, machine settings and checks of a bevel pair.

use crate::arguments::BevelArguments;
use crate::console;
use crate::failure::Failure;
use gearmesh_bevel::pair_file::settings_toml;
use gearmesh_bevel::{FlankSide, GridFit, MemberBlank, PairDesign, PairFile, Tooth, ToothCheck};
use gearmesh_geometry::input::InputDocument;
use serde_json::{Value, json};

/// Runs the command.
pub fn run(a: &BevelArguments) -> Result<(), Failure> {
    let document = InputDocument::read(&a.pair)?;
    let file = PairFile::from_document(&document)?;
    let (design, checks) = file.checked_design(&document)?;
    if a.json {
        console::json(&figures(&file, &design, &checks));
    } else {
        table(&file, &design, &checks);
    }
    Ok(())
}

/// Lines of the blank: words, unit, figure of each member.
fn blank_lines(member: &MemberBlank) -> [(&'static str, f64); 12] {
    [
        ("pitch_angle_deg", member.pitch_angle_rad.to_degrees()),
        ("face_angle_deg", member.face_angle_rad.to_degrees()),
        ("root_angle_deg", member.root_angle_rad.to_degrees()),
        ("outer_addendum_mm", 1e3 * member.outer_addendum_m),
        ("outer_dedendum_mm", 1e3 * member.outer_dedendum_m),
        ("outer_pitch_diameter_mm", 1e3 * member.outer_diameter_m()),
        ("outer_tip_diameter_mm", 1e3 * member.tip_diameter_m()),
        ("crown_distance_mm", 1e3 * member.crown_distance_m()),
        ("face_width_mm", 1e3 * member.face_width_m),
        ("mean_thickness_mm", 1e3 * member.mean_thickness_m),
        (
            "addendum_angle_deg",
            member.addendum_angle_rad().to_degrees(),
        ),
        (
            "dedendum_angle_deg",
            member.dedendum_angle_rad().to_degrees(),
        ),
    ]
}

fn pair_lines(file: &PairFile) -> [(&'static str, f64); 6] {
    let blank = &file.blank;
    [
        ("outer_cone_distance_mm", 1e3 * blank.outer_cone_m),
        ("mean_cone_distance_mm", 1e3 * blank.mean_cone_m),
        ("working_depth_mm", 1e3 * blank.working_depth_m),
        ("whole_depth_mm", 1e3 * blank.whole_depth_m),
        ("mean_normal_module_mm", 1e3 * blank.mean_normal_module_m),
        ("face_contact_ratio", blank.face_contact_ratio),
    ]
}

fn table(file: &PairFile, design: &PairDesign, checks: &[ToothCheck; 2]) {
    let [pinion, gear] = &file.blank.members;
    console::data(format!(
        "# {}: {}/{} teeth, {} taper, pinion {} hand",
        file.title,
        pinion.teeth,
        gear.teeth,
        file.blank.data.taper.word(),
        pinion.hand.word()
    ));
    for (key, value) in pair_lines(file) {
        console::data(format!("# {key:<26} {value:>12.4}"));
    }
    console::data(format!("# {:<26} {:>12} {:>12}", "", "pinion", "gear"));
    for ((key, a), (_, b)) in blank_lines(pinion).into_iter().zip(blank_lines(gear)) {
        console::data(format!("# {key:<26} {a:>12.4} {b:>12.4}"));
    }
    for (key, value) in [
        (
            "least_top_land_mm",
            checks.each_ref().map(|c| Some(c.least_top_m)),
        ),
        (
            "least_slot_width_mm",
            checks.each_ref().map(|c| c.least_slot_m),
        ),
    ] {
        let [a, b] = value.map(|x| x.map_or_else(|| "-".to_owned(), |x| format!("{:.4}", 1e3 * x)));
        console::data(format!("# {key:<26} {a:>12} {b:>12}"));
    }
    if let Some(rms) = design.fit_rms_m {
        console::data(format!(
            "# left of the asked ease-off, root mean square: concave {:.3} um, convex {:.3} um",
            1e6 * rms[0],
            1e6 * rms[1]
        ));
    }
    for (i, name) in ["pinion", "gear"].into_iter().enumerate() {
        let Some(settings) = &design.settings[i] else {
            for flank in &design.teeth[i].flanks {
                if let Some(fit) = flank.grid_fit() {
                    console::data(format!("# {}: {}", flank.name(), fit_words(fit)));
                }
            }
            if let Some(words) = thickness_words(&design.teeth[i], file) {
                console::data(format!("# {words}"));
            }
            continue;
        };
        let tables: Vec<String> = FlankSide::BOTH
            .into_iter()
            .zip(settings)
            .filter_map(|(side, s)| settings_toml(s, &format!("{name}.{}", side.word())))
            .collect();
        if tables.is_empty() {
            console::data(format!("# {name}: cut by the plane tool of the crown gear"));
            continue;
        }
        console::data(format!("[{name}]\nsettings = \"given\""));
        tables.iter().for_each(|t| console::data(t.trim_end()));
    }
}

/// What a flank through points is worth.
pub(super) fn fit_words(fit: &GridFit) -> String {
    let [toe, heel, tip] = fit.beyond_m.map(|x| 1e3 * x);
    format!(
        "{} x {} points, {} x {} polynomials; points off the surface by {:.3} um rms, {:.3} um at most; a point left out by {:.3} um rms, {:.3} um at most; normals {}; the flank goes on beyond the points by {toe:.2} mm at the toe, {heel:.2} mm at the heel, {tip:.2} mm at the tip",
        fit.size[0],
        fit.size[1],
        fit.polynomials[0],
        fit.polynomials[1],
        1e6 * fit.rms_m,
        1e6 * fit.worst_m,
        1e6 * fit.left_out_rms_m,
        1e6 * fit.left_out_worst_m,
        fit.worst_normal_rad.map_or_else(
            || "not given".to_owned(),
            |worst| format!("by {:.4} degrees at most", worst.to_degrees())
        )
    )
}

/// What the azimuths of a member's tables say of the blank and of their origin; nothing of a member that was cut.
pub(super) fn thickness_words(tooth: &Tooth, file: &PairFile) -> Option<String> {
    let found = tooth.table_thickness(file.blank.mean_normal_module_m)?;
    let figures = format!(
        "{}: {:.3} mm thick on the mean circle by the azimuths of its points, {:.3} mm by the blank, which counts",
        tooth.blank.name,
        1e3 * found.found_m,
        1e3 * found.blank_m
    );
    if !found.is_doubtful {
        return Some(figures);
    }
    let origin = found.origin_m.map_or_else(String::new, |m| {
        format!(
            " An origin {:+.3} mm farther towards the heel would explain it.",
            1e3 * m
        )
    });
    Some(format!(
        "warning: {figures}. Are backlash_mm and thickness_shift those of the part, and points_origin_mm the place of the tables' origin?{origin} It says nothing where both tables \
         do not count their azimuths from one place."
    ))
}

/// The same by name.
pub(super) fn fit_figures(fit: &GridFit) -> Value {
    json!({
        "points": fit.size,
        "polynomials": fit.polynomials,
        "rms_um": 1e6 * fit.rms_m,
        "worst_um": 1e6 * fit.worst_m,
        "left_out_rms_um": 1e6 * fit.left_out_rms_m,
        "left_out_worst_um": 1e6 * fit.left_out_worst_m,
        "worst_normal_deg": fit.worst_normal_rad.map(f64::to_degrees),
        "beyond_mm": fit.beyond_m.map(|x| 1e3 * x),
    })
}

fn figures(file: &PairFile, design: &PairDesign, checks: &[ToothCheck; 2]) -> Value {
    let object = |lines: &[(&str, f64)]| -> Value {
        lines
            .iter()
            .map(|(k, v)| ((*k).to_owned(), json!(v)))
            .collect::<serde_json::Map<_, _>>()
            .into()
    };
    let member = |i: usize| {
        let mut value = object(&blank_lines(&file.blank.members[i]));
        value["least_top_land_mm"] = json!(1e3 * checks[i].least_top_m);
        value["least_slot_width_mm"] = json!(checks[i].least_slot_m.map(|x| 1e3 * x));
        for flank in &design.teeth[i].flanks {
            let Some(fit) = flank.grid_fit() else {
                continue;
            };
            value[flank.side.word()] = fit_figures(fit);
        }
        value["thickness_of_points_mm"] = json!(
            design.teeth[i]
                .table_thickness(file.blank.mean_normal_module_m)
                .map(|found| 1e3 * found.found_m)
        );
        for (side, s) in FlankSide::BOTH
            .into_iter()
            .zip(design.settings[i].iter().flatten())
        {
            let Some(mill) = s.face_mill() else { continue };
            value[side.word()] = json!({
                "point_radius_mm": 1e3 * mill.point_radius_m,
                "blade_angle_deg": mill.blade_angle_rad.to_degrees(),
                "edge_radius_mm": 1e3 * mill.edge_radius_m,
                "radial_distance_mm": 1e3 * mill.radial_m,
                "cradle_angle_deg": mill.cradle_angle_rad.to_degrees(),
                "machine_root_angle_deg": s.root_angle_rad.to_degrees(),
                "sliding_base_mm": 1e3 * s.sliding_base_m,
                "offset_mm": 1e3 * s.offset_m,
                "work_offset_mm": 1e3 * s.work_offset_m,
                "ratio_of_roll": s.roll.map(|r| r.ratio),
                "modified_roll": s.roll.map(|r| r.modified),
            });
        }
        value
    };
    let mut value = object(&pair_lines(file));
    value["title"] = json!(file.title);
    value["taper"] = json!(file.blank.data.taper.word());
    value["pinion"] = member(0);
    value["gear"] = member(1);
    value["ease_off_rms_um"] = json!(design.fit_rms_m.map(|rms| rms.map(|x| 1e6 * x)));
    value
}
