//! Tables of a static pair: curves over the driver angle, forces over the flank, figures of each torque.

use gearmesh_scene::SceneResult;
use gearmesh_scene::pair::PairFigures;
use gearmesh_scene::pair::figure_table::FIGURE_ERRORS;

use super::{Table, ratings_table};

/// `curves` (torque and angle), `contact` (and pair of teeth and slice), `torques`, `ratings`.
#[must_use]
pub fn pair_tables(result: &SceneResult) -> Vec<Table<'static>> {
    let mut tables = vec![curves(result), contact(result), torque_table(result)];
    tables.extend(ratings_table(&result.ratings));
    tables
}

/// A row for each torque and angle.
fn curves(result: &SceneResult) -> Table<'static> {
    let (torques, angles) = (result.torque_nm.len(), result.angles());
    let mut table = Table::new("curves");
    let each_torque = |value: &dyn Fn(usize) -> f64| -> Vec<f64> {
        let rows = (0..torques).flat_map(|k| std::iter::repeat_n(k, angles));
        rows.map(value).collect()
    };
    table.numbers("torque_Nm", each_torque(&|k| result.torque_nm[k]));
    table.numbers("angle_rad", result.angle_rad.repeat(torques));
    table.numbers("te_m", result.te_m.clone());
    table.numbers("te_unloaded_m", result.unloaded_m.repeat(torques));
    let normal = (0..torques).flat_map(|k| result.normal_force_n(k));
    table.numbers("normal_force_N", normal.collect());
    table.numbers("torque_1_Nm", result.torque_1_nm.clone());
    table.numbers("axial_force_1_N", result.axial_force_1_n.clone());
    table.numbers("stiffness_secant_N_per_m", result.secant_n_per_m.clone());
    table.numbers("stiffness_tangent_N_per_m", result.tangent_n_per_m.clone());
    for series in &result.strain {
        for (method, values) in [(1, &series.method_1), (2, &series.method_2)] {
            let name = format!("strain_gear{}_{}_method{method}", series.gear, series.name);
            table.numbers(name, values.clone());
        }
    }
    table
}

/// A row for each torque, angle, pair of teeth and slice that are looked at.
fn contact(result: &SceneResult) -> Table<'static> {
    let (angles, slots, slices) = (result.angles(), result.lines.slots, result.lines.slices);
    let mut columns: [Vec<f64>; 11] = Default::default();
    for (k, &torque_nm) in result.torque_nm.iter().enumerate() {
        for angle in 0..angles {
            let total: f64 = result.position_forces(k, angle).iter().sum();
            for slot in 0..result.lines.pair_count[angle] as usize {
                let forces = result.forces(k, angle, slot);
                let share = forces.iter().sum::<f64>() / total;
                for (slice, &force) in forces.iter().enumerate() {
                    let at = (angle * slots + slot) * slices + slice;
                    let pressure = result.lines.pressure_pa[k * angles * slots * slices + at];
                    let [roll, z, line_load] = match &result.lines.places {
                        Some(p) if p.width_m[at] > 0.0 => {
                            [p.roll_1_rad[at], p.z_m[at], force / p.width_m[at]]
                        }
                        Some(_) => [f64::NAN, f64::NAN, 0.0],
                        None => [f64::NAN; 3],
                    };
                    let row = [
                        torque_nm,
                        result.angle_rad[angle],
                        result.lines.pair[angle * slots + slot],
                        (slice + 1) as f64,
                        roll,
                        z,
                        force,
                        line_load,
                        pressure,
                        share,
                        total,
                    ];
                    columns.iter_mut().zip(row).for_each(|(c, v)| c.push(v));
                }
            }
        }
    }
    let names = [
        "torque_Nm",
        "angle_rad",
        "pair",
        "slice",
        "roll_1_rad",
        "z_m",
        "force_N",
        "line_load_N_per_m",
        "pressure_Pa",
        "load_share_of_pair",
        "normal_force_N",
    ];
    let mut table = Table::new("contact");
    for (name, values) in names.into_iter().zip(columns) {
        table.numbers(name, values);
    }
    table
}

/// `torques`: the figures of each torque, a row each.
#[must_use]
pub fn torque_table(result: &SceneResult) -> Table<'static> {
    let mut table = Table::new("torques");
    let figures: Vec<PairFigures> = (0..result.torque_nm.len())
        .map(|k| result.figures(k))
        .collect();
    for figure in result.stated_figures() {
        table.numbers(
            figure.name_in_files(),
            figures.iter().map(figure.of).collect(),
        );
    }
    for (name, of) in FIGURE_ERRORS {
        let errors = figures.iter().map(|f| of(&f.errors).unwrap_or(f64::NAN));
        table.numbers(format!("error_{name}"), errors.collect());
    }
    let pitches = result.contact_coverage.averaged_pitches() as f64;
    table.numbers("mean_over_pitches", vec![pitches; figures.len()]);
    table
}
