//! Bevel stages: a pair file with the blank, cut as the program proposes.

use crate::error::Result;
use crate::ledger::About;
use crate::source::Part;
use crate::text::{number, numbers, quoted};
use crate::units::{DEG, MM};

/// Teeth of a bevel gear.
///
/// # Errors
/// Those of [`Part`], and a number that is missing.
pub fn teeth(gear: Part<'_>) -> Result<i64> {
    let found = gear
        .integer("number_of_teeth")?
        .filter(|z| (3..=2000).contains(z));
    found.ok_or_else(|| gear.lacks("number_of_teeth is missing or not 3 to 2000"))
}

/// What a bevel stage says of its pair; of two values the pinion's first, which has the fewer teeth.
#[derive(Debug, Clone, PartialEq)]
pub struct BevelStage {
    /// Which of the stage's gears is the pinion: 0 or 1.
    pub pinion: usize,
    /// Teeth.
    pub teeth: [i64; 2],
    /// Transverse module at the heel \[mm\].
    pub outer_module_mm: f64,
    /// Face widths \[mm\].
    pub face_widths_mm: [f64; 2],
    /// Angle between the axes \[deg\].
    pub shaft_angle_deg: f64,
    /// Normal pressure angle \[deg\].
    pub pressure_angle_deg: f64,
    /// Amount of the mean spiral angle \[deg\]; zero for straight teeth.
    pub spiral_angle_deg: f64,
    /// Whether the spiral of the pinion is a right hand; that of its mate is the other one.
    pub is_right_hand: bool,
}

impl BevelStage {
    /// Cone distance of the middle of the face \[mm\].
    #[must_use]
    pub fn mean_cone_distance_mm(&self) -> f64 {
        let [pinion_cone, _] = self.pitch_angles_rad();
        let outer = 0.5 * self.outer_module_mm * self.teeth[0] as f64 / pinion_cone.sin();
        outer - 0.5 * self.face_widths_mm[0].min(self.face_widths_mm[1])
    }

    /// Pitch angles \[rad\]: tan δ₁ = sin Σ/(z₂/z₁ + cos Σ), δ₂ = Σ − δ₁.
    #[must_use]
    pub fn pitch_angles_rad(&self) -> [f64; 2] {
        let sum = self.shaft_angle_deg.to_radians();
        let ratio = self.teeth[1] as f64 / self.teeth[0] as f64;
        let pinion = sum.sin().atan2(ratio + sum.cos());
        [pinion, sum - pinion]
    }
}

/// Reads a bevel stage; none where it lacks what a pair needs, which is reported.
///
/// # Errors
/// Those of [`Part`].
pub fn read(stage: Part<'_>, gears: [Part<'_>; 2]) -> Result<Option<BevelStage>> {
    let z = [teeth(gears[0])?, teeth(gears[1])?];
    let order = if z[0] <= z[1] { [0, 1] } else { [1, 0] };
    let [pinion, gear] = order.map(|i| gears[i]);
    let teeth = order.map(|i| z[i]);
    let of_both = |id: &str| -> Result<[Option<f64>; 2]> {
        Ok([pinion.number(id, MM)?, gear.number(id, MM)?])
    };
    let none = |why: &str| {
        stage.leave_out(About::Nothing, why);
        Ok(None)
    };
    let shaft_angle = stage.number("shaft_angle", DEG)?;
    let by_turn = stage.number("rotating_angle_around_pos_u_axis", DEG)?;
    let shaft_angle = shaft_angle.or(by_turn).map_or(90.0, f64::abs);
    let offset = stage.number("hypoid_offset", MM)?;
    if offset.is_some_and(|offset| offset.abs() > 1e-6) {
        return none("hypoid offset: gearmesh's bevel pairs have crossing axes; no pair file");
    }
    let outer = match stage.number("outer_transverse_module", MM)? {
        Some(module) => Some(module),
        None => {
            let of_gears = of_both("outer_pitch_diameter")?.into_iter().zip(teeth);
            { of_gears }.find_map(|(d, z)| d.map(|d| d / z as f64))
        }
    };
    let spiral = match pinion.number("mean_spiral_angle", DEG)? {
        Some(angle) => angle,
        None => gear.number("mean_spiral_angle", DEG)?.unwrap_or(0.0),
    };
    let widths = of_both("face_width")?;
    let [Some(width_1), Some(width_2)] = [widths[0].or(widths[1]), widths[1].or(widths[0])] else {
        return none("bevel gears without face width: no pair file");
    };
    let Some(outer) = outer else {
        return none("neither outer_transverse_module nor outer_pitch_diameter: no pair file");
    };
    let pressure_angles = [
        "nominal_design_pressure_angle_on_drive_side",
        "generated_pressure_angle_on_drive_side",
    ];
    let pressure_angle_deg = stage.first_of(&pressure_angles, DEG)?;
    let pressure_angle_deg = pressure_angle_deg.unwrap_or_else(|| {
        stage.assume(About::Teeth, "no pressure angle given: 20 deg");
        20.0
    });
    let is_right_hand = is_right_hand([pinion, gear], spiral);
    Ok(Some(BevelStage {
        pinion: order[0],
        teeth,
        outer_module_mm: outer,
        face_widths_mm: [width_1, width_2],
        shaft_angle_deg: shaft_angle,
        pressure_angle_deg,
        spiral_angle_deg: spiral.abs(),
        is_right_hand,
    }))
}

/// Whether the pinion spirals with a right hand: what it or its mate states, else left.
fn is_right_hand(pair: [Part<'_>; 2], spiral_deg: f64) -> bool {
    let hands = pair.map(|g| g.text("spiral_angle_pitch_direction"));
    match hands.each_ref().map(Option::as_deref) {
        _ if spiral_deg.abs() <= 1e-6 => false,
        [Some(hand), _] => hand == "right",
        [None, Some(hand)] => hand == "left",
        [None, None] => {
            let what = "no spiral_angle_pitch_direction given: left";
            pair[0].assume(About::Teeth, what);
            false
        }
    }
}

/// Text of the pair file; none where the stage lacks what it needs, which is reported.
///
/// # Errors
/// Those of [`Part`].
pub fn pair_file(stage: Part<'_>, gears: [Part<'_>; 2]) -> Result<Option<String>> {
    let Some(pair) = read(stage, gears)? else {
        return Ok(None);
    };
    let is_spiral = pair.spiral_angle_deg > 1e-6;
    let mut text = format!(
        "title = {}\n\n[bevel]\nteeth = [{}, {}]\nouter_module_mm = {}\nface_width_mm = {}\nshaft_angle_deg = {}\npressure_angle_deg = {}\n",
        quoted(stage.name_or("Bevel pair")),
        pair.teeth[0],
        pair.teeth[1],
        number(pair.outer_module_mm),
        numbers(&pair.face_widths_mm),
        number(pair.shaft_angle_deg),
        number(pair.pressure_angle_deg)
    );
    if is_spiral {
        let hand = if pair.is_right_hand { "right" } else { "left" };
        let mean_cone = pair.mean_cone_distance_mm();
        let cutter = stage.positive("cutter_radius", MM)?;
        let cutter = cutter.unwrap_or_else(|| {
            let what = format!("no cutter_radius given: the mean cone distance, {mean_cone:.3} mm");
            stage.assume(About::Nothing, what);
            mean_cone
        });
        text.push_str(&format!(
            "form = \"spiral\"\nspiral_angle_deg = {}\npinion_hand = \"{hand}\"\ncutter_radius_mm = {}\n",
            number(pair.spiral_angle_deg),
            number(cutter)
        ));
        text.push_str("\n[pinion]\nsettings = \"basic\"\n\n[gear]\nsettings = \"basic\"\n");
    } else {
        text.push_str("form = \"straight\"\n\n[pinion]\nsettings = \"crown\"\n\n[gear]\nsettings = \"crown\"\n");
    }
    for side in gears {
        for flank in side.flanks().into_iter().flatten() {
            for found in flank.parts(&["bevel_gear_tool", "bevel_gear_manufacturing_settings"]) {
                found.leave_out(About::Nothing, "machine settings of other programs: frames and signs differ; the pair file lets the program propose settings, or give them as \"given\"");
            }
        }
    }
    stage.assume(
        About::Nothing,
        "bevel pair file: standard taper and thickness, machine settings as the program proposes",
    );
    Ok(Some(text))
}
