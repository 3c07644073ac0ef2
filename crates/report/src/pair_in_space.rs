//! The gears of a pair in space with the pressure on the flank of gear 1, position by position.

use gearmesh_scene::SceneResult;
use gearmesh_scene::pair::{BevelInSpace, BevelScene, BevelTeeth};
use serde_json::{Value, json};

use crate::moving::{GearShape, pair_turns, touching_points_m};
use crate::page::SpaceView;
use crate::page::packed::{floats, scaled, scaled_signed};

/// Pressures that a picture has at most, torques together: two bytes each, and eight more for a place.
const MOST_PRESSURES: usize = 40_000;

/// Positions that a picture has at least; with fewer a pitch is not seen.
const FEWEST_POSITIONS: usize = 8;

const MM: f64 = 1e3;

/// The picture; none of results of older programs that do not say where the slices touch, and of bevel flanks through
/// points of files.
pub(crate) fn view(r: &SceneResult) -> Option<SpaceView> {
    let data = match r.bevel {
        Some(_) => bevel_pair(&BevelScene::of_result(r).ok()??, r),
        None => cylindrical_pair(r),
    }?;
    let title = "Both gears, and the pressure on the flank of gear 1 at the position of the cursor in the charts over the driver angle";
    Some(SpaceView::new(title, data))
}

fn cylindrical_pair(r: &SceneResult) -> Option<Value> {
    let pair = r.gear_pair().ok()??;
    let places = r.lines.places.as_ref()?;
    let [Some(first), Some(second)] = [0, 1].map(|gear: usize| r.source.gears[gear].definition())
    else {
        return None;
    };
    let points = touching_points_m(&pair, r).into_iter().zip(&places.z_m);
    let points: Vec<[f64; 3]> = points.map(|([x, y], z)| [x, y, *z]).collect();
    let turns = |angle: usize| Some(pair_turns(&pair, r, (0, angle)));
    let mut data = contact(r, turns, &points)?;
    data["gears"] = json!([GearShape::of(first), GearShape::of(second)]);
    data["centre_distance_mm"] = json!(MM * pair.centre_distance_m);
    data["axial_offset_mm"] = json!(MM * r.scene().ok()?.axial_offset_m);
    Some(data)
}

/// What `assets/scene3d.js` draws a bevel pair from, packed; none of results that do not say where the slices touch,
/// and of flanks that cannot be made again.
pub fn bevel_pair(scene: &BevelScene, r: &SceneResult) -> Option<Value> {
    let pair = BevelInSpace::new(scene, r).ok()??;
    let mut data = contact(r, |angle| pair.turns_rad(angle), &pair.touching_points_m())?;
    let shape = |BevelTeeth {
                     teeth,
                     sections_m,
                     rim_m,
                 }: BevelTeeth| {
        json!({
            "teeth": teeth,
            "sections": sections_m.len(),
            "points_mm": scaled_signed(sections_m.iter().flatten().flatten().map(|x| MM * x)),
            "rim_mm": rim_m.map(|end| end.map(|x| MM * x)),
        })
    };
    let seat = |member: usize| {
        let stand = pair.stand(member);
        let origin = stand.apex_m.map(|x| MM * x);
        json!({ "rotation": stand.axes.as_flattened(), "origin_mm": origin })
    };
    data["gears"] = json!([0, 1].map(|member| shape(pair.teeth(member))));
    data["seats"] = json!([0, 1].map(seat));
    data["pitch_point_mm"] = json!(pair.pitch_point_m().map(|x| MM * x));
    Some(data)
}

/// What presses where, and how far the gears have turned, at as many positions and torques as there is room for.
/// `points_m`: in the axes of gear 1, `[angle][line][slice]`.
fn contact(
    r: &SceneResult,
    turns_rad: impl Fn(usize) -> Option<[f64; 2]>,
    points_m: &[[f64; 3]],
) -> Option<Value> {
    let block = r.lines.slots * r.lines.slices;
    // From the least to the largest torque, where there are many only these two.
    let last = r.torque_nm.len() - 1;
    let torques: Vec<usize> = match last {
        0..=3 => (0..=last).collect(),
        _ => vec![0, last],
    };
    let room = MOST_PRESSURES / (block * torques.len()).max(1);
    let angles = room
        .max(FEWEST_POSITIONS)
        .min(r.angles())
        .min(whole_pitches(r, room));
    let pressures = torques.iter().flat_map(|torque| {
        let from = torque * r.angles() * block;
        r.lines.pressure_pa[from..from + angles * block]
            .iter()
            .copied()
    });
    let turns: Option<Vec<[f64; 2]>> = (0..angles).map(turns_rad).collect();
    let points = &points_m[..angles * block];
    let across = points.iter().flat_map(|[x, y, _]| [*x, *y]);
    let width_m = &r.lines.places.as_ref()?.width_m[..angles * block];
    Some(json!({
        "torques_Nm": torques.iter().map(|torque| r.torque_nm[*torque]).collect::<Vec<_>>(),
        "angle_deg": floats(r.angle_rad[..angles].iter().map(|angle| angle.to_degrees())),
        "turns_rad": floats(turns?.into_iter().flatten()),
        "slots": r.lines.slots,
        "slices": r.lines.slices,
        "pressure_MPa": scaled(pressures.map(|pressure| 1e-6 * pressure)),
        "point_mm": scaled_signed(across.map(|x| MM * x)),
        "z_mm": scaled_signed(points.iter().map(|[.., z]| MM * z)),
        "width_mm": scaled(width_m.iter().map(|width| MM * width)),
    }))
}

/// Positions of as many whole pitches as there is room for, three at most: a fourth is like them; one where there is
/// room for none.
fn whole_pitches(r: &SceneResult, room: usize) -> usize {
    let pitch = r.points_per_pitch().max(1);
    pitch * (room / pitch).clamp(1, 3)
}
