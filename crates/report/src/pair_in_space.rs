//! The gears of a pair in space with the pressure on the flank of gear 1, position by position.

use gearmesh_geometry::GearDefinition;
use gearmesh_scene::SceneResult;
use serde_json::{Value, json};

use crate::moving::{GearShape, pair_turns, touching_points_m};
use crate::page::SpaceView;
use crate::page::packed::{floats, scaled, scaled_signed};

/// Pressures that a picture has at most, torques together: two bytes each, and six more for a place.
const MOST_PRESSURES: usize = 40_000;

/// Positions that a picture has at least; with fewer a pitch is not seen.
const FEWEST_POSITIONS: usize = 8;

/// The picture; none of bevel pairs, rings, and results of older programs that do not say where the slices touch.
pub(crate) fn view(r: &SceneResult) -> Option<SpaceView> {
    let pair = r.gear_pair().ok()??;
    let places = r.places.as_ref()?;
    let [Some(first), Some(second)] = [0, 1].map(|gear: usize| r.gears[gear].definition()) else {
        return None;
    };
    if pair.has_ring() {
        return None;
    }
    let block = r.slots * r.slices;
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
    let of_block = 0..angles * block;
    let pressures = torques.iter().flat_map(|torque| {
        let from = torque * r.angles() * block;
        r.pressure_pa[from..from + angles * block].iter().copied()
    });
    let turns = (0..angles).flat_map(|angle| pair_turns(&pair, r, (0, angle)));
    let points = touching_points_m(&pair, r);
    let points = points[of_block.clone()].iter().flatten();
    let shape = |gear: &GearDefinition| json!(GearShape::of(gear));
    let mm = |x: &f64| 1e3 * x;
    let data: Value = json!({
        "gears": [shape(first), shape(second)],
        "torques_Nm": torques.iter().map(|torque| r.torque_nm[*torque]).collect::<Vec<_>>(),
        "angle_deg": floats(r.angle_rad[..angles].iter().map(|angle| angle.to_degrees())),
        "turns_rad": floats(turns),
        "slots": r.slots,
        "slices": r.slices,
        "pressure_MPa": scaled(pressures.map(|pressure| 1e-6 * pressure)),
        "point_mm": scaled_signed(points.map(mm)),
        "z_mm": scaled_signed(places.z_m[of_block.clone()].iter().map(mm)),
        "width_mm": scaled(places.width_m[of_block].iter().map(mm)),
        "centre_distance_mm": 1e3 * pair.centre_distance_m,
        "axial_offset_mm": 1e3 * r.scene().ok()?.axial_offset_m,
    });
    let title = "Both gears, and the pressure on the flank of gear 1 at the position of the cursor in the charts over the driver angle";
    Some(SpaceView::new(title, data))
}

/// Positions of as many whole pitches as there is room for, three at most: a fourth is like them; one where there is
/// room for none.
fn whole_pitches(r: &SceneResult, room: usize) -> usize {
    let pitch = r.points_per_pitch().max(1);
    pitch * (room / pitch).clamp(1, 3)
}
