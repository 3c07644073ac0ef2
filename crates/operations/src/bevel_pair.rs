//! A bevel pair as designed: blank, machine settings and checks of a bevel pair.

use crate::answer::Answer;
use crate::failure::{Failure, Result};
use crate::watch::Watch;
use gearmesh_bevel::cut_thickness::{is_one_operation, normal_m, settings_of_thickness};
use gearmesh_bevel::pair_file::settings_toml;
use gearmesh_bevel::{
    BevelError, FlankSide, GridFit, MachineSettings, MemberBlank, PairDesign, PairFile,
    ThicknessFrom, Tooth, ToothCheck,
};
use gearmesh_geometry::input::InputDocument;
use gearmesh_model::write_text;
use serde::Deserialize;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Which pair, and where its nominal points go.
#[derive(Debug, Clone, clap::Args, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BevelRequest {
    /// Bevel pair file
    pub pair: PathBuf,
    /// Write nominal points and normals of all four flanks for a measuring machine into this folder: pinion-concave.csv
    /// and so on
    #[arg(long, value_name = "FOLDER")]
    pub grid: Option<PathBuf>,
    /// Sectors along the face and heights up the flank of the nominal points
    #[arg(long, num_args = 2, value_names = ["SECTORS", "HEIGHTS"], default_values_t = [9, 5], requires = "grid",
        value_parser = clap::value_parser!(u16).range(3..=99))]
    #[serde(default = "usual_grid")]
    pub grid_size: Vec<u16>,
}

fn usual_grid() -> Vec<u16> {
    vec![9, 5]
}

/// Designs the pair of a file, and writes nominal points where asked for.
///
/// # Errors
/// [`Failure`] for a pair that cannot be made, and points that cannot be written.
pub fn design(a: &BevelRequest, watch: &Watch<'_>) -> Result<Answer> {
    let document = InputDocument::read(&a.pair)?;
    let file = PairFile::from_document(&document)?;
    let (design, checks) = file.checked_design(&document)?;
    if let Some(folder) = &a.grid {
        let [sectors, heights] = a.grid_size[..] else {
            return Err(Failure::input("--grid-size: allowed are two numbers"));
        };
        let size = [sectors, heights].map(usize::from);
        let written = write_grids(&design, folder, size, watch);
        written.map_err(|error| match error {
            Ok(fault) => fault.in_file(&document).into(),
            Err(problem) => Failure::work(problem),
        })?;
    }
    Ok(Answer {
        figures: figures(&file, &design, &checks),
        lines: table(&file, &design, &checks),
    })
}

/// Writes nominal points and normals of all flanks; none where one cannot be made.
fn write_grids(
    design: &PairDesign,
    folder: &Path,
    size: [usize; 2],
    watch: &Watch<'_>,
) -> Result<(), Result<BevelError, String>> {
    // All are made before the first is written.
    let mut made = Vec::new();
    for tooth in &design.teeth {
        for side in FlankSide::BOTH {
            let table = tooth.nominal_grid_csv(side, size).map_err(Ok)?;
            let path = folder.join(format!("{}-{}.csv", tooth.blank.name, side.word()));
            made.push((path, table));
        }
    }
    let fault = |e: std::io::Error| Err(format!("{}: {e}", folder.display()));
    std::fs::create_dir_all(folder).map_err(fault)?;
    for (path, table) in &made {
        write_text(path, table).map_err(|e| Err(e.to_string()))?;
        watch.note(format!(
            "{}: {} x {} points",
            path.display(),
            size[0],
            size[1]
        ));
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

fn table(file: &PairFile, design: &PairDesign, checks: &[ToothCheck; 2]) -> Vec<String> {
    let mut lines = Vec::new();
    let [pinion, gear] = &file.blank.members;
    lines.push(format!(
        "# {}: {}/{} teeth, {} taper, pinion {} hand",
        file.title,
        pinion.teeth,
        gear.teeth,
        file.blank.data.taper.word(),
        pinion.hand.word()
    ));
    for (key, value) in pair_lines(file) {
        lines.push(format!("# {key:<26} {value:>12.4}"));
    }
    lines.push(format!("# {:<26} {:>12} {:>12}", "", "pinion", "gear"));
    for ((key, a), (_, b)) in blank_lines(pinion).into_iter().zip(blank_lines(gear)) {
        lines.push(format!("# {key:<26} {a:>12.4} {b:>12.4}"));
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
        lines.push(format!("# {key:<26} {a:>12} {b:>12}"));
    }
    if let Some(rms) = design.fit_rms_m {
        lines.push(format!(
            "# left of the asked ease-off, root mean square: concave {:.3} um, convex {:.3} um",
            1e6 * rms[0],
            1e6 * rms[1]
        ));
    }
    for words in thickness_words(design, file) {
        lines.push(format!("# {words}"));
    }
    for (i, name) in ["pinion", "gear"].into_iter().enumerate() {
        let Some(settings) = &design.settings[i] else {
            for flank in &design.teeth[i].flanks {
                if let Some(fit) = flank.grid_fit() {
                    lines.push(format!("# {}: {}", flank.name(), fit_words(fit)));
                }
            }
            continue;
        };
        let tables: Vec<String> = FlankSide::BOTH
            .into_iter()
            .zip(settings)
            .filter_map(|(side, s)| settings_toml(s, &format!("{name}.{}", side.word())))
            .collect();
        if tables.is_empty() {
            lines.push(format!("# {name}: cut by the plane tool of the crown gear"));
            continue;
        }
        lines.push(format!("[{name}]\nsettings = \"given\""));
        // Read back, settings that are the same for both flanks would be those of one operation.
        let apart = design.teeth[i].thickness.from == ThicknessFrom::Blank;
        if apart && is_one_operation(&file.blank.members[i], settings) {
            lines.push("thickness = \"blank\"".to_owned());
        }
        lines.extend(tables.iter().map(|t| t.trim_end().to_owned()));
    }
    lines
}

/// What a flank through points is worth.
pub(crate) fn fit_words(fit: &GridFit) -> String {
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

/// How thick the teeth of a pair are by what cuts them or by their points, beside the blank, and the backlash that this
/// leaves. Nothing of members that two operations cut, whose thickness is the blank's.
pub(crate) fn thickness_words(design: &PairDesign, file: &PairFile) -> Vec<String> {
    let members = design.teeth.iter().enumerate();
    let mut lines: Vec<String> = members
        .filter_map(|(i, tooth)| {
            cut_thickness_words(tooth, design.settings[i].as_ref())
                .or_else(|| table_thickness_words(tooth, file))
        })
        .collect();
    let stated_m = file.blank.data.backlash_m;
    let backlash_m = design.backlash_m(&file.blank);
    if (backlash_m - stated_m).abs() > NO_DIFFERENCE_M {
        let jam = if backlash_m < 0.0 {
            "warning: the teeth jam in the pair as designed: "
        } else {
            ""
        };
        lines.push(format!(
            "{jam}normal backlash at the mean point by these thicknesses {:.3} mm, by the file {:.3} mm",
            1e3 * backlash_m,
            1e3 * stated_m
        ));
    }
    lines
}

/// Thicknesses that differ by less are the same in print.
const NO_DIFFERENCE_M: f64 = 0.5e-6;

/// How thick teeth are that one operation cuts.
fn cut_thickness_words(tooth: &Tooth, settings: Option<&[MachineSettings; 2]>) -> Option<String> {
    let of = &tooth.thickness;
    let cut_m = of.cut_m?;
    let normal = |m: f64| 1e3 * normal_m(&tooth.flanks, m);
    let figures = format!(
        "{}: {:.3} mm thick on the mean circle ({:.3} mm normal) as its settings cut both flanks, {:.3} mm ({:.3} mm) by the blank",
        tooth.blank.name,
        1e3 * cut_m,
        normal(cut_m),
        1e3 * of.blank_m,
        normal(of.blank_m)
    );
    let off_m = cut_m - of.blank_m;
    if off_m.abs() < NO_DIFFERENCE_M {
        return Some(figures);
    }
    let counts = match of.from {
        ThicknessFrom::Settings => "that of the settings counts",
        ThicknessFrom::Blank => "that of the blank counts, the flanks cut one after the other",
    };
    let radii = point_radii_of_blank_mm(tooth, settings).map_or_else(String::new, |[a, b]| {
        format!("; point radii {a:.4} and {b:.4} mm (concave, convex) would cut the blank's")
    });
    Some(format!(
        "{figures}: {:+.3} mm, {counts}{radii}",
        1e3 * off_m
    ))
}

/// Point radii of the concave and convex flank that would leave the blank's thickness in one operation.
fn point_radii_of_blank_mm(
    tooth: &Tooth,
    settings: Option<&[MachineSettings; 2]>,
) -> Option<[f64; 2]> {
    let found = settings_of_thickness(&tooth.blank, settings?, tooth.thickness.blank_m).ok()?;
    Some(found.map(|s| {
        s.face_mill()
            .map_or(f64::NAN, |mill| 1e3 * mill.point_radius_m)
    }))
}

/// Thickness of a member's teeth by name.
pub(crate) fn thickness_figures(
    tooth: &Tooth,
    settings: Option<&[MachineSettings; 2]>,
    file: &PairFile,
) -> Value {
    let of = &tooth.thickness;
    let points = tooth.table_thickness(file.blank.mean_normal_module_m);
    json!({
        "counts_mm": 1e3 * of.counts_m(),
        "counts_from": of.from.word(),
        "normal_mm": 1e3 * normal_m(&tooth.flanks, of.counts_m()),
        "settings_mm": of.cut_m.map(|m| 1e3 * m),
        "blank_mm": 1e3 * of.blank_m,
        "points_mm": points.map(|found| 1e3 * found.found_m),
        "point_radii_of_blank_mm": of.cut_m.and_then(|_| point_radii_of_blank_mm(tooth, settings)),
    })
}

/// What the azimuths of a member's tables say of the blank and of their origin; nothing of a member that was cut.
fn table_thickness_words(tooth: &Tooth, file: &PairFile) -> Option<String> {
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
pub(crate) fn fit_figures(fit: &GridFit) -> Value {
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
        value["thickness"] = thickness_figures(&design.teeth[i], design.settings[i].as_ref(), file);
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
    value["backlash_mm"] = json!(1e3 * design.backlash_m(&file.blank));
    value["title"] = json!(file.title);
    value["taper"] = json!(file.blank.data.taper.word());
    value["pinion"] = member(0);
    value["gear"] = member(1);
    value["ease_off_rms_um"] = json!(design.fit_rms_m.map(|rms| rms.map(|x| 1e6 * x)));
    value
}
