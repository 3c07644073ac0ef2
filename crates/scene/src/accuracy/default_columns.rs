//! What is judged where the user names nothing: what a model decides. Means in motion are left out: statics fix them,
//! whatever the step. Lines at mesh orders are judged where motions keep the mesh frequency.

use crate::study::{FigureKinds, SteadyMesh, Wanted};

/// Ends of names of series, and what is looked at of each.
const IN_MOTION: [(&str, &[&str]); 6] = [
    ("/transmission_error_m", &["deviation"]),
    ("/normal_force_right_N", &["deviation", "largest"]),
    ("/normal_force_left_N", &["deviation", "largest"]),
    ("_method2_ustrain", &["peak-to-peak", "largest"]),
    ("/force_radial_N", &["deviation"]),
    ("/cage_1_speed_ratio", &["deviation"]),
];

/// Columns of a mesh whose lines are judged, and how many orders.
const LINES: [(&str, u32); 2] = [("transmission_error_m", 3), ("normal_force_right_N", 3)];

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

/// The columns of a scene that are judged; none where nothing of it is known to be decided by its settings. `steady`:
/// its meshes whose frequency stays.
pub(super) fn default_columns(
    known: &[String],
    kinds: FigureKinds,
    steady: &[SteadyMesh],
) -> Vec<Wanted> {
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
        for mesh in steady {
            let of_mesh = name.strip_prefix(&format!("elements/{}/", mesh.name));
            let orders = LINES.iter().find(|(column, _)| of_mesh == Some(column));
            let orders = 1..=orders.map_or(0, |(_, orders)| *orders);
            let lines = orders.map(|order| shown(f64::from(order) * mesh.hz));
            let told = lines.filter(|hz| *hz <= mesh.most_hz);
            wanted.extend(told.map(|hz| Wanted::of(&format!("{name}:line-{hz}Hz"))));
        }
    }
    wanted
}

/// A frequency without what rounding leaves behind its twelfth digit: the name of its column shows all digits.
fn shown(hz: f64) -> f64 {
    format!("{hz:.11e}").parse().unwrap_or(hz)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lines of the mesh whose frequency stays, as far as the rows tell; no others.
    #[test]
    fn lines_are_judged_where_the_mesh_frequency_stays() {
        let known: Vec<String> = ["one", "two"]
            .iter()
            .flat_map(|mesh| {
                ["transmission_error_m", "normal_force_left_N"]
                    .map(|column| format!("elements/{mesh}/{column}"))
            })
            .collect();
        let steady = [SteadyMesh {
            name: "two".to_owned(),
            hz: 250.5,
            most_hz: 600.0,
        }];
        let found = default_columns(&known, FigureKinds::InTime, &steady);
        let lines: Vec<String> = (found.iter().map(Wanted::name))
            .filter(|name| name.contains("line"))
            .collect();
        assert_eq!(
            lines,
            ["250.5", "501"].map(|hz| format!("elements/two/transmission_error_m:line-{hz}Hz"))
        );
        for one in &found {
            assert!(one.check(&known, FigureKinds::InTime).is_ok(), "{one:?}");
        }
        assert_eq!(found.len(), 8);
    }
}
