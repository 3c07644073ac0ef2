//! What is judged where the user names nothing: what a model decides. Means in motion are left out: statics fix them,
//! whatever the step.

use crate::study::{FigureKinds, Wanted};

/// Ends of names of series, and what is looked at of each.
const IN_MOTION: [(&str, &[&str]); 6] = [
    ("/transmission_error_m", &["deviation"]),
    ("/normal_force_right_N", &["deviation", "largest"]),
    ("/normal_force_left_N", &["deviation", "largest"]),
    ("_method2_ustrain", &["peak-to-peak", "largest"]),
    ("/force_radial_N", &["deviation"]),
    ("/cage_1_speed_ratio", &["deviation"]),
];

/// Ends of names of single numbers, of pairs at rest and of ratings. Of a loaded bevel pair the first of both
/// transmission errors is rigid.
const AT_REST: [&str; 6] = [
    "te_peak_to_peak_um",
    "te_peak_to_peak_urad",
    "pressure_largest_MPa",
    "k_h_beta",
    "_method2_range_ustrain",
    "_method2_largest_ustrain",
];

/// The columns of a scene that are judged; none where nothing of it is known to be decided by its settings.
pub(super) fn default_columns(known: &[String], kinds: FigureKinds) -> Vec<Wanted> {
    let mut wanted = Vec::new();
    for name in known {
        if kinds == FigureKinds::None {
            if AT_REST.iter().any(|end| name.ends_with(end)) && !name.contains("unloaded") {
                wanted.push(Wanted::of(name));
            }
            continue;
        }
        let figures = IN_MOTION.iter().filter(|(end, _)| name.ends_with(end));
        let figures = figures.flat_map(|(_, figures)| figures.iter());
        wanted.extend(figures.map(|figure| Wanted::of(&format!("{name}:{figure}"))));
    }
    wanted
}
