//! `gearmesh modes`: natural frequencies and shapes with the bore held, or the ends of the shaft's stubs.

use crate::arguments::Printed;
use crate::console;
use gearmesh_operations::Failure;
use gearmesh_operations::modes::{FoundModes, ModesRequest, effective_shares, modes};

/// Runs the command.
pub fn run(a: &Printed<ModesRequest>) -> Result<(), Failure> {
    let found = modes(&a.request, &console::watch())?;
    if a.json {
        console::json(&found.figures());
    } else {
        table(&found);
    }
    Ok(())
}

fn table(found: &FoundModes) {
    let (modes, rigid) = (&found.modes, &found.rigid);
    console::data(format!(
        "{}: {} modes up to {:.1} Hz, {}, {} degrees of freedom; mass {:.4} kg, inertia about the axis {:.4e} kg m2",
        found.gear,
        modes.modes.len(),
        modes.complete_to_hz,
        found.held,
        found.dofs,
        rigid.mass_kg,
        rigid.inertia_kg_m2[2][2]
    ));
    console::data("                 nodal   kinetic energy %        effective mass or inertia %");
    console::data(
        "mode        Hz   diam.  radial circ. axial      x     y     z  about x     y     z",
    );
    let shares = |s: [f64; 6]| {
        let s = s.map(|v| 100.0 * v);
        format!(
            "{:6.1} {:5.1} {:5.1}  {:7.1} {:5.1} {:5.1}",
            s[0], s[1], s[2], s[3], s[4], s[5]
        )
    };
    for (k, m) in modes.modes.iter().enumerate() {
        let [r, t, z] = m.direction_shares.map(|v| 100.0 * v);
        console::data(format!(
            "{:>4} {:>9.2} {:>7}  {r:>6.1} {t:>5.1} {z:>5.1} {}",
            k + 1,
            m.frequency_hz(),
            m.nodal_diameters,
            shares(effective_shares(m, rigid))
        ));
    }
    console::data(format!("sum {:>39}", shares(found.share_sums())));
}
