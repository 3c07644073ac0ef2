//! Couplings: what joins shafts, and whether it is engaged in the present gear.

use crate::error::Result;
use crate::ledger::About;
use crate::model::Value;
use crate::source::{Part, Source};
use crate::units::{N_PER_M, NMM_PER_RAD};

/// Types of couplings and of joints between shafts.
pub const KINDS: [&str; 2] = ["coupling", "switchable_coupling"];

/// Joints of shaft and hub, which are rigid in scenes.
pub const JOINTS: [&str; 4] = [
    "feather_key_connection",
    "cylindrical_interference_fit",
    "tapered_interference_fit",
    "involute_spline_connection",
];

/// A coupling between two parts.
#[derive(Debug, Clone)]
pub struct Coupling {
    /// Component.
    pub id: i64,
    /// Name in the scene.
    pub name: String,
    /// Its two parts: components.
    pub sides: [i64; 2],
    /// Places along u of the two shafts \[mm\].
    pub u_mm: [Option<f64>; 2],
    /// Stiffness along the axis, across it \[N/mm\], about it, of tilting \[N m/rad\].
    pub stiffness: [f64; 4],
    /// Whether the file gives none of them.
    pub is_bare: bool,
}

/// Stiffness of a coupling that is rigid in all directions.
pub const RIGID: [f64; 4] = [1e7, 1e7, RIGID_NM_PER_RAD, RIGID_NM_PER_RAD];

/// What a coupling gets about its axis where no stiffness is given, or one that stands for rigid \[N m/rad\].
const RIGID_NM_PER_RAD: f64 = 1e7;

/// Reads a coupling; none where it joins nothing or is open.
///
/// # Errors
/// Those of [`Part`].
pub fn read(component: Part<'_>, name: String, shift_index: i64) -> Result<Option<Coupling>> {
    let Some(sides) = component.sides() else {
        let what = "no relation says what it joins: not in the scene";
        component.leave_out(About::Lost, what);
        return Ok(None);
    };
    if is_open(component, shift_index) {
        let what = format!("open in gear {shift_index}: its two sides are not joined in the scene");
        component.leave_out(About::Nothing, what);
        return Ok(None);
    }
    let u_mm = component.places_mm()?;
    let number = |id: &str, unit, most: f64| -> Result<f64> {
        let given = component.number(id, unit)?.unwrap_or(0.0);
        if given < 0.0 {
            let words = format!("{id} is below zero, which no coupling has: taken as not given");
            component.assume(About::Stiffness, words);
        }
        Ok((1e-3 * given).clamp(0.0, most))
    };
    let axial = number("axial_stiffness", N_PER_M, 1e7)?;
    let radial = number("radial_stiffness", N_PER_M, 1e7)?;
    let tilt = number("bending_stiffness", NMM_PER_RAD, RIGID_NM_PER_RAD)?;
    let mut torsion = number("rotational_stiffness", NMM_PER_RAD, RIGID_NM_PER_RAD)?;
    let is_open = torsion == 0.0;
    if is_open {
        let what = format!("no rotational_stiffness given: {RIGID_NM_PER_RAD:e} N m/rad");
        component.assume(About::Stiffness, what);
        torsion = RIGID_NM_PER_RAD;
    }
    Ok(Some(Coupling {
        id: component.id,
        is_bare: [axial, radial, tilt].iter().all(|k| *k == 0.0) && is_open,
        name,
        sides,
        u_mm,
        stiffness: [axial, radial, torsion, tilt],
    }))
}

/// The gear that is engaged, from 1 on.
///
/// # Errors
/// Those of [`Part`].
pub fn shift_index(source: &Source<'_>) -> Result<i64> {
    let mut found = 1;
    for unit in source.of_kind(&["gear_unit"]) {
        found = unit.integer("gear_shift_index")?.unwrap_or(1);
    }
    Ok(found)
}

/// Whether a coupling is open in a gear.
pub fn is_open(component: Part<'_>, shift_index: i64) -> bool {
    component.has("is_engaged") && !is_engaged(component, shift_index)
}

/// `is_engaged` holds one word, or one for each gear.
fn is_engaged(component: Part<'_>, shift_index: i64) -> bool {
    let yes = |text: &String| ["true", "1"].contains(&text.to_lowercase().as_str());
    let engaged = match component.attribute("is_engaged").map(|a| &a.value) {
        Some(Value::Scalar(text)) => yes(text),
        Some(Value::List(items)) => {
            let index = usize::try_from(shift_index - 1)
                .unwrap_or(0)
                .min(items.len().saturating_sub(1));
            items.get(index).is_none_or(yes)
        }
        _ => true,
    };
    // Marks the attribute as used.
    let _ = component.text("is_engaged");
    engaged
}
