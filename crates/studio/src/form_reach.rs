//! Where the slider of a key goes, and values that suit a gear.

use gearmesh_geometry::GearDefinition;
use gearmesh_geometry::input::NumberRange;
use serde_json::Value;

/// A gear that a key acts on.
#[derive(Debug, Clone, Copy)]
pub struct Shape<'a> {
    /// The gear; of keys of the whole pair the first.
    pub gear: &'a GearDefinition,
    /// Whether the key is this gear's own.
    pub of_gear: bool,
}

/// Least and largest value that the schema of a key, or of its items, allows; ends that only keep numbers of that unit
/// apart from slips are none.
pub fn allowed(schema: &Value, found: &Value, name: &str) -> [Option<f64>; 2] {
    let unit = NumberRange::of(name).largest();
    let parts = [schema, found, &found["items"]];
    [
        ["minimum", "exclusiveMinimum"],
        ["maximum", "exclusiveMaximum"],
    ]
    .map(|ends| {
        let stated = |part: &&Value| ends.iter().find_map(|end| part[*end].as_f64());
        let end = parts.iter().find_map(stated);
        end.filter(|end| end.abs() < unit)
    })
}

/// Where a slider goes: over the range of the schema where that has two ends, else about what is stated, as far as the
/// schema allows. Values beyond the slider may be typed.
pub fn reach(
    key: &str,
    unit: &str,
    (stated, allowed): (Option<&Value>, [Option<f64>; 2]),
    shape: Option<Shape<'_>>,
) -> Option<[f64; 2]> {
    let now = stated.and_then(|value| match value {
        Value::Array(list) => list.iter().filter_map(Value::as_f64).reduce(f64::max),
        value => value.as_f64(),
    });
    let reach = match usual(key, unit, now, shape) {
        Some(reach) => reach,
        None => match (allowed, now) {
            ([Some(low), Some(high)], _) if high - low <= 1e4 => [low, high],
            // Sizes of bodies: half to one and a half times what they are.
            (_, Some(now)) if now != 0.0 => [0.5 * now, 1.5 * now].map(|end| {
                if key.ends_with("teeth") {
                    end.round()
                } else {
                    end
                }
            }),
            _ => return None,
        },
    };
    let [low, high] = allowed;
    let reach = [
        low.map_or(reach[0], |low| reach[0].max(low)),
        high.map_or(reach[1], |high| reach[1].min(high)),
    ];
    // What is stated lies on it.
    let ends = now.map_or(reach, |now| [reach[0].min(now), reach[1].max(now)]);
    let ends = [ends[0].min(ends[1]), ends[0].max(ends[1])];
    (ends[0] < ends[1]).then_some(ends)
}

/// About what is usual; a matter of taste.
fn usual(key: &str, unit: &str, now: Option<f64>, shape: Option<Shape<'_>>) -> Option<[f64; 2]> {
    let name = key.rsplit('.').next().unwrap_or(key);
    let is_body = key.starts_with("tooth.") || key.starts_with("blank.");
    let gear = shape.map(|shape| shape.gear);
    let own = shape.filter(|shape| shape.of_gear).map(|shape| shape.gear);
    Some(match (name, unit) {
        ("centre_distance_mm", _) => now.map(|a| [a - 0.2, a + 0.5])?,
        ("torques_Nm", _) => now.map(|most| [0.02 * most, 2.0 * most])?,
        ("dynamic_coefficient", _) => [0.0, 0.3],
        ("edge_radius_um", _) => [1.0, 500.0],
        ("slices", _) => [1.0, 2.0 * gear?.reduction.slices as f64],
        ("points_per_pitch", _) => [8.0, 120.0],
        ("pitches", _) => [1.0, 12.0],
        ("count", _) if is_body => [1.0, 12.0],
        ("phase_deg", _) if is_body => [0.0, 90.0],
        ("profile_shift", _) => [-0.6, 0.8],
        ("start_deg", _) => [0.0, 360.0 / gear?.tooth.teeth as f64],
        ("end_relief_length_mm", _) => [0.0, 5e2 * own?.tooth.face_width_m],
        (name, "mm") if name.contains("diameter") && !is_body => {
            let tooth = &own?.profile;
            let form = tooth.base_radius_m * (1.0 + tooth.form_roll_rad.powi(2)).sqrt();
            [2e3 * form, 2e3 * tooth.tip_radius_m]
        }
        (name, "µm") if name.contains("angle") || name.contains("twist") => [-40.0, 40.0],
        (_, "µm") => [0.0, 60.0],
        (_, "mrad") => [-0.5, 0.5],
        (_, "mm") if !is_body && shape.is_some() => [-5.0, 5.0],
        _ => return None,
    })
}

/// A value that suits the gear, in hundredths: reliefs begin halfway in roll length between the pitch circle and the
/// tip or the form circle, crowning is zero at the pitch circle, end reliefs take a tenth of the face, openings lie in
/// the middle of the web and take half of its height.
pub fn suited(key: &str, Shape { gear, of_gear }: Shape<'_>) -> Option<f64> {
    if !of_gear {
        return None;
    }
    let tooth = &gear.profile;
    let pitch_roll = (tooth.reference_radius_m / tooth.base_radius_m).powi(2) - 1.0;
    let pitch_roll = pitch_roll.max(0.0).sqrt();
    let diameter = |roll: f64| 2e3 * tooth.base_radius_m * (1.0 + roll * roll).sqrt();
    // Of a disc the ring below the teeth stays whole, as in a body with a web.
    let [inner, outer] = match gear.blank.web() {
        Some(web) => [web.hub_radius_m, web.rim_inner_radius_m],
        None => [
            gear.blank.bore_radius_m() + gear.tooth.module_m,
            tooth.root_radius_m - 2.0 * gear.tooth.module_m,
        ],
    };
    let (middle_mm, height_mm) = (5e2 * (inner + outer), 1e3 * (outer - inner).max(0.0));
    let value = match key
        .strip_prefix("blank.")
        .or_else(|| key.rsplit('.').next())?
    {
        "tip_relief_start_diameter_mm" => diameter(0.5 * (pitch_roll + tooth.tip_roll_rad)),
        "root_relief_start_diameter_mm" => diameter(0.5 * (pitch_roll + tooth.form_roll_rad)),
        "profile_crowning_diameter_mm" => diameter(pitch_roll),
        "end_relief_length_mm" => 1e2 * gear.tooth.face_width_m,
        "holes.count" => 6.0,
        "slots.count" => 3.0,
        "holes.phase_deg" | "slots.phase_deg" => 0.0,
        "holes.pitch_circle_diameter_mm" => 2.0 * middle_mm,
        "holes.diameter_mm" => 0.5 * height_mm,
        "slots.inner_radius_mm" => middle_mm - 0.25 * height_mm,
        "slots.outer_radius_mm" => middle_mm + 0.25 * height_mm,
        "slots.width_deg" => 60.0,
        "slots.corner_radius_mm" => 0.1 * height_mm,
        _ => return None,
    };
    Some((value * 100.0).round() / 100.0)
}
