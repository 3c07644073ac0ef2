//! Bearings: springs in the scene, files for those with a catalogue.

use crate::error::Result;
use crate::ledger::About;
use crate::running::{DAMPING_S, Running};
use crate::source::Part;
use crate::text::{number, quoted};
use crate::units::{KN, MM, N_PER_M, NMM_PER_RAD, UM};

/// Types of bearing components.
pub const KINDS: [&str; 5] = [
    "concept_bearing",
    "rolling_bearing_with_catalog_geometry",
    "rolling_bearing_with_detailed_geometry",
    "hydrodynamic_radial_plain_bearing",
    "slide_bearing",
];

/// Which axial forces of the inner part a bearing takes, along u.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AxialSupport {
    /// Both.
    Both,
    /// Those towards +u.
    Positive,
    /// Those towards −u.
    Negative,
    /// None.
    None,
}

/// A bearing between two parts.
#[derive(Debug, Clone)]
pub struct Bearing {
    /// Component.
    pub id: i64,
    /// Name in the scene.
    pub name: String,
    /// Inner and outer part: components.
    pub sides: [i64; 2],
    /// Places along u of the two sides, where these are shafts \[mm\].
    pub u_mm: [Option<f64>; 2],
    /// Radial stiffness \[N/mm\].
    pub radial_n_per_mm: f64,
    /// Axial stiffness where it supports \[N/mm\].
    pub axial_n_per_mm: f64,
    /// Tilt stiffness \[N m/rad\], 0 for none.
    pub tilt_nm_per_rad: f64,
    /// Axial support.
    pub axial: AxialSupport,
    /// Bore \[mm\], where given.
    pub bore_mm: Option<f64>,
    /// Its file, name and text, where its type has one.
    pub file: Option<(String, String)>,
}

impl Bearing {
    /// A place where a shaft is held, `u_mm` along that of the first side.
    pub fn rigid(id: i64, name: String, sides: [i64; 2], u_mm: f64, axial: AxialSupport) -> Self {
        Self {
            id,
            name,
            sides,
            u_mm: [Some(u_mm), None],
            radial_n_per_mm: RIGID,
            axial_n_per_mm: RIGID,
            tilt_nm_per_rad: 0.0,
            axial,
            bore_mm: None,
            file: None,
        }
    }

    /// The keys of its springs as `model` of the scene, with an axial stiffness \[N/mm\] of its own or none.
    pub fn linear_model(&self, axial_n_per_mm: f64, running: Running) -> String {
        let per_mm = ["N_per_mm", "N_s_per_mm"];
        let per_rad = ["Nm_per_rad", "Nm_s_per_rad"];
        let mut model = "kind = \"linear\"".to_owned();
        for (way, stiffness, [unit, damping]) in [
            ("radial", self.radial_n_per_mm, per_mm),
            ("axial", axial_n_per_mm, per_mm),
            ("tilt", self.tilt_nm_per_rad, per_rad),
        ] {
            if stiffness == 0.0 && way != "radial" {
                continue;
            }
            model.push_str(&format!(", {way}_stiffness_{unit} = {}", number(stiffness)));
            if running == Running::InTime {
                let value = number(DAMPING_S * stiffness);
                model.push_str(&format!(", {way}_damping_{damping} = {value}"));
            }
        }
        model
    }
}

/// Radial stiffness where none is given \[N/mm\]: that of a loaded bearing of medium size.
const RADIAL: f64 = 5e5;
/// Axial stiffness where none is given \[N/mm\].
const AXIAL: f64 = 2e5;
/// What rigid bearings get \[N/mm\]: far stiffer than shafts, and harmless to equations.
pub const RIGID: f64 = 1e7;
/// Larger stiffness stands for rigid \[N/mm\].
const RIGID_FROM: f64 = 1e8;
/// The same of tilting \[N m/rad\].
pub const RIGID_TILT: f64 = 1e7;

/// Reads a bearing; none where it has no two sides.
///
/// # Errors
/// Those of [`Part`].
pub fn read(component: Part<'_>, name: String, file_name: String) -> Result<Option<Bearing>> {
    let Some(sides) = component.sides() else {
        let what = "no relation says what it stands between: not in the scene";
        component.leave_out(About::Lost, what);
        return Ok(None);
    };
    if component.kind.contains("plain") || component.kind == "slide_bearing" {
        let what = "plain bearing: a linear spring in its place, without film";
        component.leave_out(About::Stiffness, what);
    }
    let u_mm = component.places_mm()?;
    let carries_radially = component.flag("radial_force_absorption")? != Some(false);
    let radial_n_per_mm = match carries_radially {
        true => stiffness(component, "radial_stiffness", RADIAL)?,
        false => 0.0,
    };
    let kind = component.text("bearing_type").unwrap_or_default();
    let axial = axial_support(component, &kind)?;
    let without = if radial_n_per_mm >= RIGID {
        RIGID
    } else {
        AXIAL
    };
    let axial_n_per_mm = match axial {
        AxialSupport::None => 0.0,
        _ => stiffness(component, "axial_stiffness", without)?,
    };
    let tilt = component
        .number("bending_stiffness", NMM_PER_RAD)?
        .map_or(0.0, |k| 1e-3 * k);
    if tilt > RIGID_TILT {
        component.assume(
            About::Small,
            format!(
                "bending_stiffness of {tilt:e} N m/rad stands for rigid: {RIGID_TILT:e} N m/rad"
            ),
        );
    }
    let bore_mm = component.positive("inner_diameter", MM)?;
    Ok(Some(Bearing {
        id: component.id,
        file: catalogue(component, &kind, bore_mm, &name, file_name)?,
        name,
        sides,
        u_mm,
        radial_n_per_mm,
        axial_n_per_mm,
        tilt_nm_per_rad: tilt.clamp(0.0, RIGID_TILT),
        axial,
        bore_mm,
    }))
}

/// A stiffness \[N/mm\], bounded, and `without` where it is not given or none that a bearing has.
fn stiffness(component: Part<'_>, id: &str, without: f64) -> Result<f64> {
    let given = component.number(id, N_PER_M)?.map(|k| 1e-3 * k);
    Ok(match given {
        Some(k) if k >= RIGID_FROM => {
            let words = format!("{id} of {k:e} N/mm stands for rigid: {RIGID:e} N/mm");
            component.assume(About::Small, words);
            RIGID
        }
        Some(k) if k > 0.0 => k,
        _ => {
            let found = given.map_or(format!("no {id} given"), |k| {
                format!("{id} is {k:e} N/mm, which no bearing has")
            });
            let words = format!("{found}: {without:e} N/mm");
            component.assume(About::Stiffness, words);
            without
        }
    })
}

/// Which axial forces it takes, of its stiffness and its type where nothing says so.
fn axial_support(component: Part<'_>, kind: &str) -> Result<AxialSupport> {
    Ok(match component.text("axial_force_absorption").as_deref() {
        Some("both_directions") => AxialSupport::Both,
        Some("positive") => AxialSupport::Positive,
        Some("negative") => AxialSupport::Negative,
        Some("no_direction") => AxialSupport::None,
        other => {
            let stiffness = component.number("axial_stiffness", N_PER_M)?;
            let is_free = ["radial_roller_bearing", "radial_needle_roller_bearing"].contains(&kind);
            let holds =
                stiffness.is_some_and(|k| k > 0.0) || (!is_free && kind.contains("bearing"));
            let (support, words) = match holds {
                true => (AxialSupport::Both, "axial support both ways"),
                false => (AxialSupport::None, "no axial support"),
            };
            let found = other.map_or("not given".to_owned(), |o| format!("`{o}` is not known"));
            let text = format!("axial_force_absorption {found}: {words}");
            component.assume(About::Support, text);
            support
        }
    })
}

/// Types of REXS that gearmesh's catalogue bearings have.
const TYPES: [(&str, &str); 3] = [
    ("radial_grooved_ball_bearing", "deep-groove"),
    ("angular_contact_ball_bearing", "angular-contact"),
    ("radial_roller_bearing", "cylindrical-roller"),
];

/// A bearing file from bore, outside diameter, width and load ratings.
fn catalogue(
    component: Part<'_>,
    kind: &str,
    bore_mm: Option<f64>,
    name: &str,
    file_name: String,
) -> Result<Option<(String, String)>> {
    if !component.kind.starts_with("rolling_bearing") {
        return Ok(None);
    }
    let none = |why: &str| {
        component.leave_out(About::Nothing, why);
        Ok(None)
    };
    let outside = component.number("outer_diameter", MM)?;
    let width = component.number("width", MM)?;
    let dynamic = component.number("radial_dynamic_load_rating", KN)?;
    let rest = component.number("radial_static_load_rating", KN)?;
    let fatigue = component.positive("fatigue_limit_load", KN)?;
    let designation = component.text("catalogue_designation").unwrap_or_default();
    let clearance = component.number("operating_radial_bearing_clearance", UM)?;
    let Some((_, word)) = TYPES.iter().find(|(rexs, _)| *rexs == kind) else {
        return none(&format!(
            "type `{kind}` as balls or rollers: no bearing file, a linear spring in the scene"
        ));
    };
    let rows = component.integer("number_of_bearing_rows")?.unwrap_or(1);
    let (Some(bore), Some(outside), Some(width), Some(dynamic), Some(rest)) =
        (bore_mm, outside, width, dynamic, rest)
    else {
        return none(
            "no bearing file: it needs inner_diameter, outer_diameter, width and both load ratings",
        );
    };
    if rows != 1 || bore >= outside || width <= 0.0 || dynamic <= 0.0 || rest <= 0.0 {
        return none("no bearing file: one row, diameters and load ratings that are possible");
    }
    if *word == "angular-contact" {
        let what = "bearing file: contact angle of 40 deg unless its row says otherwise";
        component.assume(About::Nothing, what);
    }
    let mut text = format!(
        "# {designation}: for `model = {{ kind = \"quasi-static\", file = ... }}` in the scene\nname = {}\nkind = \"catalogue\"\ntype = \"{word}\"\nbore_mm = {}\noutside_diameter_mm = {}\nwidth_mm = {}\n",
        quoted(name),
        number(bore),
        number(outside),
        number(width)
    );
    match (*word, clearance) {
        ("angular-contact", _) => text.push_str("contact_angle_deg = 40.0\n"),
        (_, Some(um)) => text.push_str(&format!("radial_clearance_um = {}\n", number(um))),
        (_, None) => {}
    }
    text.push_str(&format!(
        "\n[ratings]\ndynamic_N = {}\nstatic_N = {}\n",
        number(1e3 * dynamic),
        number(1e3 * rest)
    ));
    if let Some(fatigue) = fatigue {
        text.push_str(&format!("fatigue_N = {}\n", number(1e3 * fatigue)));
    }
    Ok(Some((file_name, text)))
}
