//! Whether settings that a file states can be those of its member: hand, cone, roll and blades. What is asked here is a
//! plain slip (another sign, another member, a ratio upside down); whether the flanks meet is asked of the flanks
//! themselves.

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::TableKeys;

use crate::blank::{MemberBlank, PairBlank};
use crate::cut_thickness::{ThicknessFrom, is_one_operation};
use crate::hand::FlankSide;
use crate::settings::MachineSettings;

/// How far the machine root angle may lie beyond root and pitch angle of the member \[rad\].
const CONE_RAD: f64 = 5.0 * std::f64::consts::PI / 180.0;
/// A ratio of roll this near to that of the rolling pitch cone turned upside down, as a share, is taken for that.
const UPSIDE_DOWN: f64 = 0.03;
/// Unless it is this near to the ratio itself. How far it may be beyond is asked of the flanks: local synthesis rolls
/// pinions of few teeth up to five times as fast.
const ROLL: f64 = 0.1;

/// The ratio of roll with which the pitch cone rolls (docs/theory/bevel_gears.md, "Basic settings").
fn rolling(blank: &MemberBlank) -> f64 {
    blank.dedendum_angle_rad().cos() / blank.pitch_angle_rad.sin()
}

/// Asks the settings of both flanks of a member.
///
/// # Errors
/// [`InputError`] at the key of a setting that cannot be.
pub(super) fn check(
    keys: &TableKeys<'_>,
    settings: &[MachineSettings; 2],
    blank: &PairBlank,
    (name, thickness): (&str, Option<ThicknessFrom>),
) -> Result<(), InputError> {
    let number = usize::from(name == "gear");
    let (member, mate) = (&blank.members[number], &blank.members[1 - number]);
    for (side, s) in FlankSide::BOTH.into_iter().zip(settings) {
        let key = |of: &str| format!("{}.{of}", side.word());
        let Some(mill) = s.face_mill() else { continue };
        let q = mill.cradle_angle_rad;
        if q * member.hand.sign() <= 0.0 {
            let (cuts, sign) = match q > 0.0 {
                true => ("right", "negative"),
                false => ("left", "positive"),
            };
            let cuts = if q == 0.0 {
                "neither hand".to_owned()
            } else {
                format!("a {cuts} hand")
            };
            let sign = if q == 0.0 {
                "positive for a right, negative for a left hand"
            } else {
                sign
            };
            let problem = format!(
                "found {:.4} degrees, which cuts {cuts}; the {name} has a {} hand (bevel.pinion_hand), allowed is {sign}. Are the members \
                 exchanged, or does the source count the cradle the other way round?",
                q.to_degrees(),
                member.hand.word()
            );
            return Err(keys.error(&key("cradle_angle_deg"), problem));
        }
        let root = s.root_angle_rad;
        let allowed = [
            member.root_angle_rad - CONE_RAD,
            member.pitch_angle_rad + CONE_RAD,
        ];
        if root < allowed[0] || root > allowed[1] {
            let exchanged = if (root - mate.root_angle_rad).abs() < CONE_RAD {
                format!(
                    " It is near that of the {}, {:.4} degrees: are the members exchanged?",
                    mate.name,
                    mate.root_angle_rad.to_degrees()
                )
            } else {
                String::new()
            };
            let problem = format!(
                "found {:.4} degrees, the {name}'s root angle is {:.4}; allowed is {:.4} to {:.4}, within 5 degrees of its root and pitch cone.{exchanged}",
                root.to_degrees(),
                member.root_angle_rad.to_degrees(),
                allowed[0].to_degrees(),
                allowed[1].to_degrees()
            );
            return Err(keys.error(&key("machine_root_angle_deg"), problem));
        }
        if let Some(roll) = s.roll {
            let wanted = rolling(member);
            let is_near = (roll.ratio / wanted - 1.0).abs() <= ROLL;
            if !is_near && (roll.ratio * wanted - 1.0).abs() <= UPSIDE_DOWN {
                let problem = format!(
                    "found {:.6}, the {name}'s pitch cone rolls with {wanted:.6}: it is near that turned upside down; this is work over cradle",
                    roll.ratio
                );
                return Err(keys.error(&key("ratio_of_roll"), problem));
            }
        }
    }
    let one = is_one_operation(member, settings);
    if thickness == Some(ThicknessFrom::Settings) && !one {
        let problem = "found \"settings\", but the settings of both flanks differ in more than their blades: the flanks are cut one after the other, and \
            the turn of the work between the cuts, which makes the thickness, is no setting; remove it, or state \"blank\"";
        return Err(keys.error("thickness", problem));
    }
    let radii = settings.map(|s| s.face_mill().map_or(0.0, |mill| mill.point_radius_m));
    if one && thickness != Some(ThicknessFrom::Blank) && radii[0] <= radii[1] {
        let problem = format!(
            "found {:.4} mm, convex.point_radius_mm is {:.4} mm: in one operation the outside blade, which cuts the concave flank, must have the larger \
             radius. Exchange the flanks, or state {name}.thickness = \"blank\" where they are cut one after the other",
            1e3 * radii[0],
            1e3 * radii[1]
        );
        return Err(keys.error("concave.point_radius_mm", problem));
    }
    Ok(())
}
