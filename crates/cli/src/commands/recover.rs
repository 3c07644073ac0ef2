//! `gearmesh recover`: strain of all gauges of both models; the whole field on request.

use crate::arguments::Printed;
use crate::console;
use gearmesh_operations::recover::{RecoverRequest, figures, recover, strain_ranges};
use gearmesh_operations::reduce::mesh_error;
use gearmesh_operations::{Failure, periods};

/// Runs the command.
pub fn run(a: &Printed<RecoverRequest>) -> Result<(), Failure> {
    let result = recover(&a.request, &console::watch())?;
    if a.json {
        console::json(&figures(&result));
        return Ok(());
    }
    console::data(format!(
        "{:>4} {:<18} {:>10} {:>18} {:>18} {:>14}",
        "gear", "gauge", "torque N m", "range 1 ustrain", "range 2 ustrain", "mesh error"
    ));
    for row in strain_ranges(&result) {
        let s = &result.strain[row.series];
        let (torque, [one, two]) = (row.torque_nm, row.ranges);
        console::data(format!(
            "{:>4} {:<18} {torque:>10.1} {:>18.2} {:>18.2} {:>14}{}",
            s.gear,
            s.name,
            one * 1e6,
            two * 1e6,
            mesh_error(s.error_estimate()),
            periods::mark_of_extremes(&s.coverage)
        ));
    }
    console::data(format!(
        "{} gauges, {} positions, both methods: {:.3} s",
        result.strain.len(),
        result.angles() * result.torque_nm.len(),
        result.solution.seconds[1]
    ));
    periods::lines(&result).into_iter().for_each(console::data);
    Ok(())
}
