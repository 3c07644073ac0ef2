//! What a gauge reads under a line load.

use gearmesh_model::{GaugeRows, ReducedGear};

/// Strain per newton of a line load over the whole width at a roll station of the gauge's tooth: normal, tangential
/// towards the tip, and what the tooth-only submodel contributes to the normal one.
pub fn line_load_strain(gear: &ReducedGear, gauge: &GaugeRows, station: usize) -> [f64; 3] {
    let axial = gear.grid.z_m.len();
    let mut sum = [0.0; 3];
    for j in 0..axial {
        let share = if j == 0 || j + 1 == axial { 0.5 } else { 1.0 } / (axial - 1) as f64;
        let load = gear.grid.load(station, j);
        let row = 3 * (gauge.tooth * gear.grid.len() + load);
        sum[0] += share * gauge.adjoint[row];
        sum[1] += share * gauge.adjoint[row + 1];
        sum[2] += share * gauge.own_tooth[load];
    }
    sum
}
