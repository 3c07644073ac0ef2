//! Reads cylindrical gears: teeth, tool, blank.

pub use crate::cylindrical::Gear;
use crate::cylindrical::Microgeometry;
use crate::error::Result;
use crate::ledger::About;
use crate::material::material;
use crate::source::Part;
use crate::tooth_thickness::thickness;
use crate::units::{DEG, MM, ONE};

/// Reads a gear; its bore and a missing tip diameter come later.
///
/// # Errors
/// Those of [`Part`], and what a gear cannot do without.
pub fn read(component: Part<'_>, name: String, file: String) -> Result<Gear> {
    let internal = component.kind == "ring_gear";
    let teeth = teeth(component, internal)?;
    let helix_deg = component.number("helix_angle_reference_diameter", DEG)?;
    let helix_deg = helix_deg.unwrap_or(0.0);
    if helix_deg.abs() >= 80.0 {
        return Err(component.lacks(format!(
            "helix_angle_reference_diameter is {helix_deg} deg; allowed is less than 80"
        )));
    }
    let module_mm = normal_module_mm(component, helix_deg)?;
    let face_width_mm = component.need("face_width", MM)?;
    for (what, value, most) in [
        ("module", module_mm, 1e3),
        ("face_width", face_width_mm, 1e5),
    ] {
        if !(1e-3..=most).contains(&value) {
            return Err(
                component.lacks(format!("{what} is {value} mm; allowed is 0.001 to {most}"))
            );
        }
    }
    let flanks = component.flanks();
    let mut gear = Gear {
        id: component.id,
        name,
        file,
        teeth,
        internal,
        module_mm,
        pressure_angle_deg: 20.0,
        helix_deg,
        profile_shift: 0.0,
        face_width_mm,
        tip_diameter_mm: None,
        addendum: 1.0,
        dedendum: 1.25,
        rack_tip_radius: 0.38,
        thickness_allowance_mm: 0.0,
        tip_chamfer_mm: 0.0,
        bore_mm: None,
        shaft_mm: None,
        material: material(component)?,
        microgeometry: Microgeometry::default(),
    };
    flank_values(component, flanks, &mut gear)?;
    if internal {
        ring_tip_and_rim(component, &mut gear)?;
    } else {
        tool(component, flanks, &mut gear)?;
        tip_and_root(component, &mut gear)?;
        gear.bore_mm = bore(component)?;
    }
    thickness(component, &mut gear)?;
    Ok(gear)
}

fn teeth(component: Part<'_>, internal: bool) -> Result<u32> {
    let teeth = component
        .integer("number_of_teeth")?
        .ok_or_else(|| component.lacks("number_of_teeth is missing"))?;
    // Programs write the teeth of rings with and without sign.
    let counted = if internal { teeth.abs() } else { teeth };
    u32::try_from(counted)
        .ok()
        .filter(|z| (3..=2000).contains(z))
        .ok_or_else(|| component.lacks(format!("number_of_teeth is {teeth}; allowed are 3 to 2000 (of a ring gear say so by its type)")))
}

fn normal_module_mm(component: Part<'_>, helix_deg: f64) -> Result<f64> {
    if let Some(module) = component.number("normal_module", MM)? {
        return Ok(module);
    }
    let transverse = component.number("transverse_module", MM)?;
    let transverse = transverse.ok_or_else(|| component.lacks("normal_module is missing"))?;
    Ok(transverse * helix_deg.to_radians().cos())
}

/// Words for a value that is not given, or not possible.
fn not_possible(value: Option<f64>, unit: &str) -> String {
    value.map_or("not given".to_owned(), |x| {
        format!("{x} {unit} is not possible")
    })
}

fn flank_values(component: Part<'_>, flanks: [Option<Part<'_>>; 2], gear: &mut Gear) -> Result<()> {
    // Of both flanks: the right one's where they differ, which is reported.
    let value = |id: &str, unit| -> Result<Option<f64>> {
        let of = |flank: Option<Part<'_>>| flank.map_or(Ok(None), |flank| flank.number(id, unit));
        let (left, right) = (of(flanks[0])?, of(flanks[1])?);
        if let (Some(left), Some(right)) = (left, right)
            && (left - right).abs() > 1e-9
        {
            component.leave_out(About::Teeth, format!("{id} of left flanks, {left}: gears have one for both, the right flanks' {right}"));
        }
        Ok(right.or(left).or(component.number(id, unit)?))
    };
    match value("normal_pressure_angle", DEG)? {
        Some(angle) if (5.0..=45.0).contains(&angle) => gear.pressure_angle_deg = angle,
        other => {
            let found = not_possible(other, "deg");
            let what = format!("normal_pressure_angle {found}: 20 deg");
            component.assume(About::Teeth, what);
        }
    }
    let shift = match value("addendum_modification_coefficient", ONE)? {
        Some(x) => Some(x),
        None => value("addendum_modification", MM)?.map(|amount| amount / gear.module_mm),
    };
    let shift = match shift {
        Some(x) => Some(x),
        None => value("addendum_modification_coefficient_after_finishing", ONE)?,
    };
    gear.profile_shift = shift.unwrap_or_else(|| {
        component.assume(About::Teeth, "no profile shift given: 0");
        0.0
    });
    gear.tip_chamfer_mm = value("tooth_tip_chamfer", MM)?.map_or(0.0, |c| c.max(0.0));
    let addendum = value("addendum_coefficient_basic_profile", ONE)?;
    if let Some(addendum) = addendum.filter(|h| (0.2..3.0).contains(h)) {
        gear.addendum = addendum;
    }
    Ok(())
}

fn tool(component: Part<'_>, flanks: [Option<Part<'_>>; 2], gear: &mut Gear) -> Result<()> {
    let kinds = ["rack_shaped_tool", "cutter_wheel_tool", "profile_tool"];
    let owners = [flanks[1], flanks[0], Some(component)];
    let found = owners.into_iter().flatten().find_map(|owner| {
        // The last step gives the flank, the first one the root.
        owner.parts(&kinds).next()
    });
    let Some(tool) = found else {
        let what =
            "no tool given: rack of ISO 53 profile A, dedendum 1.25 and tip radius 0.38 modules";
        component.assume(About::Teeth, what);
        return limit_tip_radius(component, gear);
    };
    if tool.kind != "rack_shaped_tool" {
        tool.assume(About::Small, "read as a rack of the same reference profile: roots cut by cutter wheels are not modelled");
    }
    let module = gear.module_mm;
    let pair = |factor: &str, length: &str| -> Result<Option<f64>> {
        let by_factor = tool.number(factor, ONE)?;
        let by_length = tool.number(length, MM)?.map(|l| l / module);
        Ok(by_factor.or(by_length).filter(|v| (0.0..5.0).contains(v)))
    };
    match pair(
        "addendum_coefficient_reference_profile",
        "addendum_reference_profile",
    )? {
        Some(addendum) if addendum > 0.0 => gear.dedendum = addendum,
        _ => {
            let what = "no addendum given: dedendum of the gear 1.25 modules";
            tool.assume(About::Teeth, what);
        }
    }
    match pair(
        "tip_corner_radius_factor_reference_profile",
        "tip_corner_radius_reference_profile",
    )? {
        Some(radius) => gear.rack_tip_radius = radius,
        None => tool.assume(About::Small, "no tip radius given: 0.38 modules"),
    }
    limit_tip_radius(tool, gear)
}

/// The largest tip radius that a rack tooth has room for, and none larger than its addendum allows.
fn limit_tip_radius(subject: Part<'_>, gear: &mut Gear) -> Result<()> {
    let (sin, cos) = gear.pressure_angle_deg.to_radians().sin_cos();
    let room = (std::f64::consts::FRAC_PI_4 - gear.dedendum * sin / cos) * cos / (1.0 - sin);
    if room <= 0.0 {
        return Err(subject.lacks(format!(
            "a rack of dedendum {} modules and {} deg has no tip left",
            gear.dedendum, gear.pressure_angle_deg
        )));
    }
    // A hair below, so that rounding does not make the tip too narrow.
    let most = (1e4 * room).floor() * 1e-4;
    if gear.rack_tip_radius > most {
        subject.assume(About::Small, format!("a tip radius of {} modules does not fit on the rack's tip: {most:.4}, the full round", gear.rack_tip_radius),
        );
        gear.rack_tip_radius = most;
    }
    Ok(())
}

fn tip_and_root(component: Part<'_>, gear: &mut Gear) -> Result<()> {
    let reference = gear.reference_diameter_mm();
    let has_tool_data = gear.dedendum != 1.25;
    if let Some(root) = component.number("root_diameter", MM)? {
        let dedendum = gear.profile_shift + (reference - root) / (2.0 * gear.module_mm);
        if !has_tool_data
            && (0.5..3.0).contains(&dedendum)
            && (dedendum - gear.dedendum).abs() > 1e-6
        {
            let what = format!("dedendum {dedendum:.4} modules, from root_diameter");
            component.assume(About::Nothing, what);
            gear.dedendum = dedendum;
            limit_tip_radius(component, gear)?;
        }
    }
    if let Some(tip) = component.number("tip_diameter", MM)? {
        let least = gear
            .base_diameter_mm()
            .max(gear.root_diameter_mm() + 0.2 * gear.module_mm);
        if tip > least && tip < reference + 8.0 * gear.module_mm {
            gear.tip_diameter_mm = Some(tip);
        } else {
            component.leave_out(
                About::Teeth,
                format!(
                    "tip_diameter {tip} mm, which teeth of module {} mm cannot have",
                    gear.module_mm
                ),
            );
        }
    }
    Ok(())
}

/// Addendum of a ring whose tip diameter is not given, in modules: that of 1 would interfere with small planets.
const RING_ADDENDUM: f64 = 0.8;
/// Rim of a ring whose outer diameter is not given, in modules.
const RING_RIM: f64 = 3.0;

/// Tip and outer diameter of a ring.
fn ring_tip_and_rim(component: Part<'_>, gear: &mut Gear) -> Result<()> {
    let (reference, module) = (gear.reference_diameter_mm(), gear.module_mm);
    gear.addendum = RING_ADDENDUM;
    let tip = component.number("tip_diameter", MM)?;
    let possible = |tip: &f64| *tip > gear.base_diameter_mm() && *tip < reference + 2.0 * module;
    match tip.map(f64::abs) {
        Some(tip) if possible(&tip) => gear.tip_diameter_mm = Some(tip),
        other => {
            let found = not_possible(other, "mm");
            let what = format!("tip_diameter {found}: addendum {RING_ADDENDUM} modules");
            component.assume(About::Teeth, what);
        }
    }
    let what = "its root is that of the default cutter of gear files";
    component.assume(About::Small, what);
    let least = gear.root_diameter_mm() + 2.0 * module;
    let outer = component.number("outer_diameter", MM)?.map(f64::abs);
    let outer = outer.filter(|outer| *outer > least).unwrap_or_else(|| {
        let outer = gear.root_diameter_mm() + 2.0 * RING_RIM * module;
        let what = format!(
            "no outer_diameter beyond its root: {outer:.3} mm, a rim of {RING_RIM} modules"
        );
        component.assume(About::Blank, what);
        outer
    });
    gear.bore_mm = Some(outer);
    Ok(())
}

fn bore(component: Part<'_>) -> Result<Option<f64>> {
    let mut bore = component.positive("inner_diameter", MM)?;
    for body in component.parts(&["gear_body"]) {
        bore = body.positive("inner_diameter", MM)?.or(bore);
        if body.has("body_contour_coordinate_u") || body.has("gear_body_web_thickness") {
            body.leave_out(About::Blank, "rim, web and contour: the blank is a solid disc with this bore; give [blank] kind = \"thin-rim\" or \"contour\" by hand");
        }
    }
    Ok(bore)
}
