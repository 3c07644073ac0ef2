//! Bevel stages: a pair file with the blank, cut as the program proposes.

use crate::error::RexsError;
use crate::model::Component;
use crate::source::Source;
use crate::structure::Structure;
use crate::text::{number, numbers, quoted};
use crate::units::{DEG, MM};

/// Teeth of a bevel gear.
///
/// # Errors
/// Those of [`Source`], and a number that is missing.
pub fn teeth(source: &Source<'_>, gear: &Component) -> Result<i64, RexsError> {
    let found = source
        .integer(gear, "number_of_teeth")?
        .filter(|z| (3..=2000).contains(z));
    found.ok_or_else(|| RexsError::Missing {
        component: gear.words(),
        what: "number_of_teeth is missing or not 3 to 2000".to_owned(),
    })
}

/// Text of the pair file; none where the stage lacks what it needs, which is told.
///
/// # Errors
/// Those of [`Source`].
pub fn pair_file(
    source: &Source<'_>,
    structure: &Structure,
    stage: &Component,
    gears: [&Component; 2],
) -> Result<Option<String>, RexsError> {
    let z = [teeth(source, gears[0])?, teeth(source, gears[1])?];
    let order = if z[0] <= z[1] { [0, 1] } else { [1, 0] };
    let [pinion, gear] = order.map(|i| gears[i]);
    let teeth = order.map(|i| z[i]);
    let of_both = |id: &str| -> Result<[Option<f64>; 2], RexsError> {
        Ok([source.number(pinion, id, MM)?, source.number(gear, id, MM)?])
    };
    let shaft_angle = source.number(stage, "shaft_angle", DEG)?.or(source.number(
        stage,
        "rotating_angle_around_pos_u_axis",
        DEG,
    )?);
    let shaft_angle = shaft_angle.map_or(90.0, f64::abs);
    if source
        .number(stage, "hypoid_offset", MM)?
        .is_some_and(|offset| offset.abs() > 1e-6)
    {
        source.leave_out(
            stage,
            "hypoid offset: gearmesh's bevel pairs have crossing axes; no pair file",
        );
        return Ok(None);
    }
    let outer = match source.number(stage, "outer_transverse_module", MM)? {
        Some(module) => Some(module),
        None => {
            let diameters = of_both("outer_pitch_diameter")?;
            let mut modules = diameters
                .iter()
                .zip(teeth)
                .filter_map(|(d, z)| d.map(|d| d / z as f64));
            modules.next()
        }
    };
    let spiral = match source.number(pinion, "mean_spiral_angle", DEG)? {
        Some(angle) => angle,
        None => source
            .number(gear, "mean_spiral_angle", DEG)?
            .unwrap_or(0.0),
    };
    let widths = of_both("face_width")?;
    let [Some(width_1), Some(width_2)] = [widths[0].or(widths[1]), widths[1].or(widths[0])] else {
        source.leave_out(stage, "bevel gears without face width: no pair file");
        return Ok(None);
    };
    let Some(outer) = outer else {
        source.leave_out(
            stage,
            "neither outer_transverse_module nor outer_pitch_diameter: no pair file",
        );
        return Ok(None);
    };
    let pressure = match source.number(stage, "nominal_design_pressure_angle_on_drive_side", DEG)? {
        Some(angle) => angle,
        None => source
            .number(stage, "generated_pressure_angle_on_drive_side", DEG)?
            .unwrap_or_else(|| {
                source.assume(stage, "no pressure angle given: 20 deg");
                20.0
            }),
    };
    let is_spiral = spiral.abs() > 1e-6;
    let mut text = format!(
        "title = {}\n\n[bevel]\nteeth = [{}, {}]\nouter_module_mm = {}\nface_width_mm = {}\nshaft_angle_deg = {}\npressure_angle_deg = {}\n",
        quoted(if stage.name.is_empty() {
            "Bevel pair"
        } else {
            &stage.name
        }),
        teeth[0],
        teeth[1],
        number(outer),
        numbers(&[width_1, width_2]),
        number(shaft_angle),
        number(pressure)
    );
    if is_spiral {
        let hand = source
            .text(pinion, "spiral_angle_pitch_direction")
            .unwrap_or_else(|| {
                source.assume(pinion, "no spiral_angle_pitch_direction given: left");
                "left".to_owned()
            });
        let mean_cone =
            0.5 * outer * (teeth[0] as f64).hypot(teeth[1] as f64) - 0.5 * width_1.min(width_2);
        let cutter = source
            .number(stage, "cutter_radius", MM)?
            .filter(|r| *r > 0.0)
            .unwrap_or_else(|| {
                source.assume(
                    stage,
                    format!("no cutter_radius given: the mean cone distance, {mean_cone:.3} mm"),
                );
                mean_cone
            });
        text.push_str(&format!(
            "form = \"spiral\"\nspiral_angle_deg = {}\npinion_hand = \"{hand}\"\ncutter_radius_mm = {}\n",
            number(spiral.abs()),
            number(cutter)
        ));
        text.push_str("\n[pinion]\nsettings = \"basic\"\n\n[gear]\nsettings = \"basic\"\n");
    } else {
        text.push_str("form = \"straight\"\n\n[pinion]\nsettings = \"crown\"\n\n[gear]\nsettings = \"crown\"\n");
    }
    for side in gears {
        for flank in structure.flanks(side.id).into_iter().flatten() {
            let kinds = ["bevel_gear_tool", "bevel_gear_manufacturing_settings"];
            for id in structure.partners(flank, &kinds) {
                if let Some(found) = source.model.component(id) {
                    source.leave_out(found, "machine settings of other programs: frames and signs differ; the pair file lets the program propose settings, or give them as \"given\"");
                }
            }
        }
    }
    source.assume(
        stage,
        "bevel pair file: standard taper and thickness, machine settings as the program proposes",
    );
    Ok(Some(text))
}
