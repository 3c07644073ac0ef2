//! Basic settings of a member from its blank: both sides of a slot by one face mill (spread blade). Formulas: docs/theory/bevel_gears.md, "Basic settings".

use std::f64::consts::PI;

use crate::blank::{MemberBlank, PairData, ToothForm};
use crate::error::BevelError;
use crate::hand::FlankSide;
use crate::settings::{FaceMill, MachineSettings, Roll, Tool};

/// How the member is cut.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Process {
    /// The work turns with the cradle.
    Generated,
    /// The work is held: the flank is the cutter's own surface.
    Formate,
}

/// Blade angle with which the flank has the pressure angle at the mean point: A sin α_b + B cos α_b = sin α with A = cos δ_f, B = ± sin β sin δ_f.
fn blade_angle(blank: &MemberBlank, data: &PairData, side: FlankSide) -> Result<f64, BevelError> {
    let (sin_f, cos_f) = blank.dedendum_angle_rad().sin_cos();
    let (a, b) = (cos_f, side.sign() * data.spiral_angle_rad.sin() * sin_f);
    let angle = (data.pressure_angle_rad.sin() / a.hypot(b)).asin() - b.atan2(a);
    if !(0.0..=0.25 * PI).contains(&angle) {
        return Err(BevelError::NoBladeAngle {
            flank: format!("{}'s {}", blank.name, side.word()),
            pressure_deg: data.pressure_angle_rad.to_degrees(),
        });
    }
    Ok(angle)
}

/// Settings of both flanks, concave and convex, of a member.
///
/// # Errors
/// [`BevelError`] where no blade has the asked pressure angle, or the slot's bottom has no width.
pub fn basic_settings(
    blank: &MemberBlank,
    data: &PairData,
    edge_radius_m: f64,
    process: Process,
) -> Result<[MachineSettings; 2], BevelError> {
    let mean = blank.mean_cone_m;
    let delta = blank.dedendum_angle_rad();
    let (sin_b, cos_b) = data.spiral_angle_rad.sin_cos();
    let radius = data.cutter_radius_m;
    let angles = FlankSide::BOTH.map(|side| blade_angle(blank, data, side));
    let angles = [angles[0].clone()?, angles[1].clone()?];

    // Bottom of the slot in the middle of the face, normal to the tooth: the blade's point width.
    let circle = 2.0 * PI * mean * blank.pitch_angle_rad.sin() / blank.teeth as f64;
    let depth = blank.dedendum_m(mean) * delta.cos();
    let width =
        (circle - blank.mean_thickness_m) * cos_b - depth * (angles[0].tan() + angles[1].tan());
    if width <= 0.0 {
        return Err(BevelError::BladeTooWide {
            member: blank.name,
            cone_mm: 1e3 * mean,
            slot_mm: 1e3 * width,
            blade_mm: 0.0,
        });
    }
    let vertical = radius * cos_b;
    let horizontal = mean * delta.cos() - radius * sin_b;
    // The root cone's generator lies in the machine plane, also where it misses the pitch apex.
    let sliding_base = -blank.dedendum_m(0.0) * delta.cos();
    let settings = |side: FlankSide, angle: f64| MachineSettings {
        tool: Tool::FaceMill(FaceMill {
            point_radius_m: radius + 0.5 * side.sign() * width,
            blade_angle_rad: angle,
            edge_radius_m,
            radial_m: vertical.hypot(horizontal),
            cradle_angle_rad: blank.hand.sign() * vertical.atan2(horizontal),
        }),
        root_angle_rad: blank.root_angle_rad,
        sliding_base_m: sliding_base,
        offset_m: 0.0,
        work_offset_m: 0.0,
        roll: match process {
            Process::Generated => Some(Roll::constant(delta.cos() / blank.pitch_angle_rad.sin())),
            Process::Formate => None,
        },
    };
    Ok([
        settings(FlankSide::Concave, angles[0]),
        settings(FlankSide::Convex, angles[1]),
    ])
}

/// Settings of one flank by the pair's crown gear, whose pitch plane rolls on both pitch cones: members so cut are conjugate (line contact). The roots are
/// parallel to the pitch cones, as deep as the blank in the middle of the face. Straight teeth are octoids with roots as the blank says.
pub fn crown_settings(
    blank: &MemberBlank,
    data: &PairData,
    side: FlankSide,
    edge_radius_m: f64,
) -> MachineSettings {
    let (sin_b, cos_b) = data.spiral_angle_rad.sin_cos();
    let radius = data.cutter_radius_m;
    let depth = blank.dedendum_m(blank.mean_cone_m);
    let vertical = radius * cos_b;
    let horizontal = blank.mean_cone_m - radius * sin_b;
    let alpha = data.pressure_angle_rad;
    let straight = data.form == ToothForm::Straight;
    let tool = if straight {
        Tool::Plane {
            blade_angle_rad: alpha,
            end_angle_rad: blank.dedendum_angle_rad(),
            hand: blank.hand,
        }
    } else {
        // The circle in the pitch plane is that of the crown gear's tooth.
        Tool::FaceMill(FaceMill {
            point_radius_m: radius - side.sign() * depth * alpha.tan(),
            blade_angle_rad: alpha,
            edge_radius_m,
            radial_m: vertical.hypot(horizontal),
            cradle_angle_rad: blank.hand.sign() * vertical.atan2(horizontal),
        })
    };
    MachineSettings {
        tool,
        root_angle_rad: blank.pitch_angle_rad,
        sliding_base_m: if straight { 0.0 } else { -depth },
        offset_m: 0.0,
        work_offset_m: 0.0,
        roll: Some(Roll::constant(1.0 / blank.pitch_angle_rad.sin())),
    }
}
