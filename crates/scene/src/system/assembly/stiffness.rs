//! Stiffnesses that a run can resolve.

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::TableKeys;

/// Stiffest support \[N/m or N·m/rad\]. Places are numbers of 16 digits: that of something 1 m away is rounded by 1e-16
/// m, which such a spring answers with 0.1 N. Programs that know no joints write 1e23 N/m for "rigid": its rounding
/// alone would be 1e7 N and tear gears from their axes.
const MOST: f64 = 1e15;

/// Smallest step between two numbers about 1.
const ROUNDING: f64 = 1e-16;

/// Refuses stiffnesses above [`MOST`]; each with its key and the factor from the key's unit to SI.
pub(super) fn refuse_rigid(
    keys: &TableKeys<'_>,
    stated: &[(&str, f64, f64)],
) -> Result<(), InputError> {
    for &(key, value, to_si) in stated {
        if value.is_finite() && (value * to_si).abs() > MOST {
            return Err(keys.error(
                key,
                format!(
                    "found {value:e}, so stiff that the rounding of a place 1 m away is a force of {:.0e} N; allowed is up to {:e}; make a rigid \
                     support a [[joint]]: kind = \"revolute\" for a bearing, \"fixed\" for a clamp",
                    (value * to_si).abs() * ROUNDING,
                    MOST / to_si
                ),
            ));
        }
    }
    Ok(())
}
