//! How thick the tooth is that the settings of both flanks leave, and the point width that leaves a given thickness.
//! Derivation: docs/theory/bevel_gears.md, "Tooth thickness".

use std::f64::consts::TAU;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::blank::MemberBlank;
use crate::error::BevelError;
use crate::flank::{Flank, spiral_angle_rad};
use crate::hand::FlankSide;
use crate::settings::{MachineSettings, Tool};

/// Which thickness the teeth have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum ThicknessFrom {
    /// What the settings of both flanks leave between two slots that are cut in one operation.
    Settings,
    /// The blank's: both flanks are cut one after the other, the work turned between the cuts.
    Blank,
}

impl ThicknessFrom {
    /// As in files.
    pub fn word(self) -> &'static str {
        match self {
            Self::Settings => "settings",
            Self::Blank => "blank",
        }
    }
}

/// Thickness of a member's teeth along the circle, on the pitch cone at the mean cone distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToothThickness {
    /// By the blank \[m\].
    pub blank_m: f64,
    /// As both flanks leave it that are cut with the work in one place \[m\]; none of a member that two operations cut,
    /// or that goes through points.
    pub cut_m: Option<f64>,
    /// Which of them the teeth have.
    pub from: ThicknessFrom,
}

impl ToothThickness {
    /// What the teeth have \[m\].
    pub fn counts_m(&self) -> f64 {
        match (self.from, self.cut_m) {
            (ThicknessFrom::Settings, Some(cut)) => cut,
            _ => self.blank_m,
        }
    }
}

/// Settings of both flanks differ by less where one operation cuts them: lengths over the mean cone distance, angles,
/// ratios.
const SAME: f64 = 1e-9;
/// Steps of the secant method.
const MOST_STEPS: usize = 30;
/// Thickness is met within this share of the mean cone distance.
const CLOSE: f64 = 1e-13;

/// Whether one cutter cuts both flanks of a slot at once: all settings are the same but for point radius, angle and
/// edge of the blades.
pub fn is_one_operation(blank: &MemberBlank, [a, b]: &[MachineSettings; 2]) -> bool {
    let size = blank.mean_cone_m;
    let (Some(p), Some(q)) = (a.face_mill(), b.face_mill()) else {
        return false;
    };
    let rolls = match (a.roll, b.roll) {
        (None, None) => true,
        (Some(a), Some(b)) => {
            let off = a.modified.iter().zip(b.modified);
            (a.ratio - b.ratio).abs() < SAME && off.map(|(a, b)| (a - b).abs()).all(|d| d < SAME)
        }
        _ => false,
    };
    let lengths = [
        a.sliding_base_m - b.sliding_base_m,
        a.offset_m - b.offset_m,
        a.work_offset_m - b.work_offset_m,
        p.radial_m - q.radial_m,
    ];
    let angles = [
        a.root_angle_rad - b.root_angle_rad,
        p.cradle_angle_rad - q.cradle_angle_rad,
    ];
    rolls && lengths.iter().all(|d| d.abs() < SAME * size) && angles.iter().all(|d| d.abs() < SAME)
}

/// Thickness that two flanks leave which are cut with the work in one place \[m\], by the azimuths of their mean points
/// in the machine's frame: the slot lies between the concave flank of one tooth and the convex flank of the next.
pub(crate) fn cut_thickness_m([concave, convex]: &[Flank; 2]) -> f64 {
    let blank = &concave.blank;
    let sense = FlankSide::Concave.facing(blank.hand);
    // A flank is turned from where it was cut onto +x.
    let slot = sense * (concave.turn_rad() - convex.turn_rad());
    let radius = blank.mean_cone_m * blank.pitch_angle_rad.sin();
    (TAU / blank.teeth as f64 - slot) * radius
}

/// Thickness normal to the tooth \[m\] of one along the circle: times the cosine of the flanks' mean spiral angle.
pub fn normal_m(flanks: &[Flank; 2], along_circle_m: f64) -> f64 {
    let spirals = flanks.iter().map(|f| spiral_angle_rad(f, f.mean()));
    along_circle_m * (0.5 * spirals.sum::<f64>()).cos()
}

fn widened(settings: &[MachineSettings; 2], by_m: f64) -> [MachineSettings; 2] {
    let mut wider = *settings;
    for (side, s) in FlankSide::BOTH.into_iter().zip(&mut wider) {
        if let Tool::FaceMill(mill) = &mut s.tool {
            mill.point_radius_m += 0.5 * side.sign() * by_m;
        }
    }
    wider
}

/// Settings of one operation whose point width leaves teeth of that thickness: both point radii are moved by the same
/// amount, apart or together. Secant method.
///
/// # Errors
/// [`BevelError::NoFlankPoint`] where a flank on the way does not reach the mean point, [`BevelError::NoPointWidth`]
/// where no blade does it.
pub fn settings_of_thickness(
    blank: &MemberBlank,
    settings: &[MachineSettings; 2],
    wanted_m: f64,
) -> Result<[MachineSettings; 2], BevelError> {
    let miss = |by_m: f64| -> Result<f64, BevelError> {
        let [outside, inside] = widened(settings, by_m);
        let flanks = [
            Flank::cut(blank, FlankSide::Concave, &outside)?,
            Flank::cut(blank, FlankSide::Convex, &inside)?,
        ];
        Ok(cut_thickness_m(&flanks) - wanted_m)
    };
    let close = CLOSE * blank.mean_cone_m;
    let (mut a, mut fa) = (0.0, miss(0.0)?);
    // A wider blade leaves a thinner tooth.
    let (mut b, mut steps) = (0.8 * fa, 0);
    while fa.abs() > close && steps < MOST_STEPS {
        let fb = miss(b)?;
        let next = b - fb * (b - a) / (fb - fa);
        (a, fa) = (b, fb);
        b = if next.is_finite() { next } else { a };
        steps += 1;
    }
    let found = widened(settings, a);
    let radii = found.map(|s| s.face_mill().map_or(0.0, |mill| mill.point_radius_m));
    if fa.abs() > 100.0 * close || radii[1] <= 0.0 || radii[0] <= radii[1] {
        return Err(BevelError::NoPointWidth {
            member: blank.name,
            thickness_mm: 1e3 * wanted_m,
        });
    }
    Ok(found)
}
