//! External loads and additional masses on shafts.

use crate::error::Result;
use crate::ledger::About;
use crate::source::Part;
use crate::units::{KG, KG_M2, KW, MM, N, NM};

/// A load on a shaft.
#[derive(Debug, Clone, Default)]
pub struct Load {
    /// Component.
    pub id: i64,
    /// Name in the scene.
    pub name: String,
    /// Shaft: component.
    pub shaft: i64,
    /// Place along u \[mm\].
    pub u_mm: f64,
    /// Torque about u \[N m\]; none where it follows from the others.
    pub torque_nm: Option<f64>,
    /// Torque about u that the file states beside, of a load that does not define it \[N m\].
    pub stated_nm: Option<f64>,
    /// Power \[W\], where given instead.
    pub power_w: Option<f64>,
    /// Whether it takes part in the flow of power.
    pub transmits: bool,
    /// Whether it is a brake: an engaged coupling between the shaft and the casing.
    pub is_brake: bool,
    /// Force along u, v, w \[N\].
    pub force_n: [f64; 3],
    /// Moments about v and w \[N m\].
    pub moment_nm: [f64; 2],
}

/// Torques, forces and powers in N m, N and kW above this are slips.
const MOST: f64 = 1e9;

/// Reads a load.
///
/// # Errors
/// Those of [`Part`].
pub fn read(component: Part<'_>, name: String, shaft: i64) -> Result<Load> {
    let u_mm = component.number("u_coordinate_on_shaft", MM)?;
    let value = |id: &str, unit| component.number_up_to(id, unit, MOST);
    let torque_nm = value("torque_around_u_axis", NM)?;
    let power_w = value("power", KW)?.map(|p| 1e3 * p).filter(|p| *p != 0.0);
    let states = component.flag("transmits_torque")?;
    let defines = component.flag("defines_torque")?;
    // A load that neither has a torque nor says that it passes one on is a force.
    let transmits = states.unwrap_or(torque_nm.is_some() || power_w.is_some());
    let follows = transmits && defines == Some(false);
    if let Some(torque) = torque_nm.filter(|t| *t != 0.0 && !transmits) {
        let what = format!("a torque of {torque} N m where transmits_torque is false");
        component.leave_out(About::Lost, what);
    }
    if u_mm.is_none() {
        component.assume(About::Place, "no u_coordinate_on_shaft given: 0");
    }
    let force = |axis: &str| value(&format!("force_{axis}_direction"), N);
    Ok(Load {
        id: component.id,
        name,
        shaft,
        u_mm: u_mm.unwrap_or(0.0),
        torque_nm: torque_nm.filter(|_| transmits && !follows),
        stated_nm: torque_nm.filter(|t| *t != 0.0 && follows),
        power_w: power_w.filter(|_| transmits && !follows),
        transmits,
        is_brake: false,
        force_n: [
            force("u")?.unwrap_or(0.0),
            force("v")?.unwrap_or(0.0),
            force("w")?.unwrap_or(0.0),
        ],
        moment_nm: [
            value("torque_around_v_axis", NM)?.unwrap_or(0.0),
            value("torque_around_w_axis", NM)?.unwrap_or(0.0),
        ],
    })
}

/// The torque with which a brake holds a shaft: it follows from the others.
pub fn brake(id: i64, name: String, shaft: i64, u_mm: f64) -> Load {
    Load {
        id,
        name,
        shaft,
        u_mm,
        transmits: true,
        is_brake: true,
        ..Load::default()
    }
}

/// A mass on a shaft.
#[derive(Debug, Clone, Copy)]
pub struct AddedMass {
    /// Shaft: component.
    pub shaft: i64,
    /// Place along u \[mm\].
    pub u_mm: f64,
    /// Mass \[kg\].
    pub mass_kg: f64,
    /// Moments of inertia about v, w and u \[kg m²\].
    pub inertia_kg_m2: [f64; 3],
}

/// Reads an additional mass; none where it has no mass.
///
/// # Errors
/// Those of [`Part`].
pub fn added_mass(component: Part<'_>, shaft: i64) -> Result<Option<AddedMass>> {
    let u_mm = component
        .number("u_coordinate_on_shaft", MM)?
        .unwrap_or(0.0);
    let Some(mass_kg) = component.positive("mass_of_component", KG)? else {
        component.leave_out(About::Nothing, "no mass given");
        return Ok(None);
    };
    let inertia = |axis: &str| -> Result<f64> {
        let found = component.number(&format!("moment_of_inertia_{axis}_axis"), KG_M2)?;
        Ok(found.unwrap_or(0.0).max(0.0))
    };
    Ok(Some(AddedMass {
        shaft,
        u_mm,
        mass_kg,
        inertia_kg_m2: [inertia("v")?, inertia("w")?, inertia("u")?],
    }))
}
