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
        let found = [
            (
                "cradle_angle_deg",
                other_hand(mill.cradle_angle_rad, member, name),
            ),
            (
                "machine_root_angle_deg",
                far_cone(s.root_angle_rad, member, mate, name),
            ),
            (
                "ratio_of_roll",
                s.roll
                    .and_then(|roll| upside_down(roll.ratio, member, name)),
            ),
        ];
        for (of, problem) in found {
            if let Some(problem) = problem {
                return Err(keys.error(&key(of), problem));
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

/// What is wrong with a cradle angle that cuts the other hand, or none.
fn other_hand(cradle_angle_rad: f64, member: &MemberBlank, name: &str) -> Option<String> {
    let q = cradle_angle_rad;
    let (cuts, allowed) = match q * member.hand.sign() {
        product if product > 0.0 => return None,
        _ if q > 0.0 => ("a right hand", "negative"),
        _ if q == 0.0 => {
            let allowed = "positive for a right, negative for a left hand";
            ("neither hand", allowed)
        }
        _ => ("a left hand", "positive"),
    };
    Some(format!(
        "found {:.4} degrees, which cuts {cuts}; the {name} has a {} hand (bevel.pinion_hand), allowed is {allowed}. Are the members \
         exchanged, or does the source count the cradle the other way round?",
        q.to_degrees(),
        member.hand.word()
    ))
}

/// What is wrong with a machine root angle beyond root and pitch cone.
fn far_cone(root_rad: f64, member: &MemberBlank, mate: &MemberBlank, name: &str) -> Option<String> {
    let allowed = [
        member.root_angle_rad - CONE_RAD,
        member.pitch_angle_rad + CONE_RAD,
    ];
    if !(root_rad < allowed[0] || root_rad > allowed[1]) {
        return None;
    }
    let exchanged = if (root_rad - mate.root_angle_rad).abs() < CONE_RAD {
        format!(
            " It is near that of the {}, {:.4} degrees: are the members exchanged?",
            mate.name,
            mate.root_angle_rad.to_degrees()
        )
    } else {
        String::new()
    };
    Some(format!(
        "found {:.4} degrees, the {name}'s root angle is {:.4}; allowed is {:.4} to {:.4}, within 5 degrees of its root and pitch cone.{exchanged}",
        root_rad.to_degrees(),
        member.root_angle_rad.to_degrees(),
        allowed[0].to_degrees(),
        allowed[1].to_degrees()
    ))
}

/// What is wrong with a ratio of roll that is turned upside down.
fn upside_down(ratio: f64, member: &MemberBlank, name: &str) -> Option<String> {
    let wanted = rolling(member);
    let is_near = (ratio / wanted - 1.0).abs() <= ROLL;
    (!is_near && (ratio * wanted - 1.0).abs() <= UPSIDE_DOWN).then(|| {
        format!(
            "found {ratio:.6}, the {name}'s pitch cone rolls with {wanted:.6}: it is near that turned upside down; this is work over cradle"
        )
    })
}
