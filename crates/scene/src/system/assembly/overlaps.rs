//! Gears on one axis whose faces overlap: no gearbox has them, and no equation of a scene would show them.

use gearmesh_geometry::ToothGeometry;
use gearmesh_specification::gear_tables::MM;

use super::bodies::{Bodies, PlacedBody};

/// Axes nearer than this are one \[m\]; faces that overlap by less touch.
const SAME_M: f64 = 1e-6;

/// Cosine of the angle between axes that are parallel.
const PARALLEL: f64 = 1.0 - 1e-9;

/// Adds a warning for each pair.
pub(super) fn note(bodies: &Bodies, notes: &mut Vec<String>) {
    let gears: Vec<&PlacedBody> = (bodies.list.iter())
        .filter(|body| body.cylindrical().is_some())
        .collect();
    for (i, first) in gears.iter().enumerate() {
        for second in &gears[i + 1..] {
            if let Some(overlap_m) = overlap_m(first, second) {
                notes.push(format!(
                    "warning: gears `{}` and `{}` turn about one axis and overlap by {:.4} mm along it: look at their places and face widths",
                    first.body.name,
                    second.body.name,
                    overlap_m / MM
                ));
            }
        }
    }
}

/// How far two gears about one axis overlap \[m\]; none where they do not, and of a sun within its ring.
fn overlap_m(first: &PlacedBody, second: &PlacedBody) -> Option<f64> {
    let (axis, other) = (first.axis(), second.axis());
    let apart = second.body.position_m - first.body.position_m;
    let along = apart.dot(&axis);
    if axis.dot(&other).abs() < PARALLEL || (apart - axis * along).norm() > SAME_M {
        return None;
    }
    let gears = [first.cylindrical()?, second.cylindrical()?];
    let [one, two] = gears.map(|gear| &gear.definition.profile);
    let fits_inside = |gear: &ToothGeometry, ring: &ToothGeometry| {
        !gear.internal && ring.internal && gear.tip_radius_m < ring.tip_radius_m
    };
    if fits_inside(one, two) || fits_inside(two, one) {
        return None;
    }
    let width = |body: &PlacedBody| Some(body.cylindrical()?.definition.tooth.face_width_m);
    let overlap_m = 0.5 * (width(first)? + width(second)?) - along.abs();
    (overlap_m > SAME_M).then_some(overlap_m)
}
