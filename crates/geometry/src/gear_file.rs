//! The gear file: TOML with units in the keys, checked key by key, turned into a [`GearDefinition`] in SI units.

use crate::definition::*;
use crate::input::{InputDocument, InputError};
use crate::involute;
use crate::microgeometry::{Microgeometry, ProfileCrowning, ReliefShape, TipRelief};
use crate::profile_curve::ProfileCurve;
use crate::tooth::ToothGeometry;
use serde::Deserialize;
use std::f64::consts::TAU;
use std::path::Path;

const MM: f64 = 1e-3;
const UM: f64 = 1e-6;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct GearFile {
    name: String,
    tooth: ToothTable,
    blank: BlankTable,
    material: MaterialTable,
    #[serde(default)]
    microgeometry: MicrogeometryTable,
    #[serde(default)]
    mesh: MeshTable,
    #[serde(default)]
    reduction: ReductionTable,
    #[serde(default)]
    gauge: Vec<GaugeTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ToothTable {
    teeth: usize,
    module_mm: f64,
    #[serde(default = "default_pressure_angle")]
    pressure_angle_deg: f64,
    #[serde(default)]
    profile_shift: f64,
    addendum: Option<f64>,
    #[serde(default = "default_dedendum")]
    dedendum: f64,
    #[serde(default = "default_rack_tip_radius")]
    rack_tip_radius: f64,
    tip_diameter_mm: Option<f64>,
    #[serde(default)]
    thickness_allowance_mm: f64,
    #[serde(default)]
    tip_chamfer_mm: f64,
    face_width_mm: f64,
}

fn default_pressure_angle() -> f64 {
    20.0
}
fn default_dedendum() -> f64 {
    1.25
}
fn default_rack_tip_radius() -> f64 {
    0.38
}

#[derive(Deserialize, Clone, Copy, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
enum BlankKind {
    Solid,
    ThinRim,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct BlankTable {
    kind: BlankKind,
    bore_diameter_mm: f64,
    hub_diameter_mm: Option<f64>,
    rim_inner_diameter_mm: Option<f64>,
    web_thickness_mm: Option<f64>,
    web_offset_mm: Option<f64>,
    slots: Option<SlotsTable>,
    holes: Option<HolesTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SlotsTable {
    count: usize,
    inner_radius_mm: f64,
    outer_radius_mm: f64,
    width_deg: f64,
    phase_deg: f64,
    corner_radius_mm: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct HolesTable {
    count: usize,
    pitch_circle_diameter_mm: f64,
    diameter_mm: f64,
    phase_deg: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
struct MaterialTable {
    young_GPa: f64,
    poisson: f64,
}

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields)]
struct MicrogeometryTable {
    profile_crowning_um: Option<f64>,
    profile_crowning_diameter_mm: Option<f64>,
    tip_relief_um: Option<f64>,
    tip_relief_start_diameter_mm: Option<f64>,
    tip_relief_shape: Option<TipReliefShape>,
    lead_crowning_um: Option<f64>,
    flank_angle_um: Option<f64>,
}

#[derive(Deserialize, Clone, Copy)]
#[serde(rename_all = "kebab-case")]
enum TipReliefShape {
    Linear,
    Parabolic,
}

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields)]
struct MeshTable {
    element: Option<ElementKind>,
    flank_mm: Option<f64>,
    fillet_mm: Option<f64>,
    body_mm: Option<f64>,
    axial_mm: Option<f64>,
    min_scaled_jacobian: Option<f64>,
    #[serde(default)]
    plane_strain: bool,
}

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields)]
struct ReductionTable {
    roll_stations: Option<usize>,
    slices: Option<usize>,
    flanks: Option<Vec<FlankSide>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct GaugeTable {
    name: String,
    tooth: usize,
    side: FlankSide,
    tangent_deg: Option<f64>,
    radius_mm: Option<f64>,
    length_mm: f64,
    #[serde(default)]
    z_mm: f64,
    width_mm: f64,
}

/// Complains unless `value` lies in the open or half-open range that `allowed` says.
fn require(
    document: &InputDocument,
    key: &str,
    value: f64,
    ok: bool,
    allowed: &str,
) -> Result<(), InputError> {
    if ok && value.is_finite() {
        Ok(())
    } else {
        Err(document.error(key, format!("found {value}, allowed is {allowed}")))
    }
}

impl GearDefinition {
    /// Reads and checks a gear file.
    ///
    /// # Errors
    /// [`InputError`] for an unreadable file, a key or value that is not allowed, or a gear that cannot exist.
    pub fn read(path: &Path) -> Result<Self, InputError> {
        Self::from_document(&InputDocument::read(path)?)
    }

    /// Checks a gear file that is already in memory.
    ///
    /// # Errors
    /// As [`GearDefinition::read`].
    pub fn from_document(document: &InputDocument) -> Result<Self, InputError> {
        let file: GearFile = document.parse()?;
        let tooth = tooth(document, &file.tooth)?;
        let profile = ToothGeometry::new(&tooth).map_err(|e| document.error("tooth", e))?;
        let blank = blank(document, &file.blank, &tooth, &profile)?;
        let material = Material {
            young_pa: file.material.young_GPa * 1e9,
            poisson: file.material.poisson,
        };
        let require = |key: &str, value: f64, ok: bool, allowed: &str| {
            require(document, key, value, ok, allowed)
        };
        require(
            "material.young_GPa",
            file.material.young_GPa,
            file.material.young_GPa > 0.0,
            "more than 0",
        )?;
        require(
            "material.poisson",
            material.poisson,
            (0.0..0.5).contains(&material.poisson),
            "0 up to, not including, 0.5",
        )?;
        let microgeometry =
            microgeometry(document, &file.microgeometry, &profile, tooth.face_width_m)?;
        let mesh = mesh(document, &file.mesh, &tooth)?;
        if mesh.plane_strain && blank.web.is_some() {
            return Err(document.error(
                "mesh.plane_strain",
                "plane strain knows the cross-section only, a web thinner than the face has no place in it; set blank.kind = \"solid\" or plane_strain = false",
            ));
        }
        let reduction = reduction(document, file.reduction, mesh.plane_strain)?;
        let gauges = gauges(document, file.gauge, &tooth, &profile)?;
        Ok(Self {
            name: file.name,
            tooth,
            blank,
            material,
            microgeometry,
            mesh,
            reduction,
            gauges,
            profile,
            source: document.text.clone(),
        })
    }
}

fn tooth(document: &InputDocument, t: &ToothTable) -> Result<ToothDefinition, InputError> {
    let require = |key: &str, value: f64, ok: bool, allowed: &str| {
        require(document, &format!("tooth.{key}"), value, ok, allowed)
    };
    require(
        "teeth",
        t.teeth as f64,
        (5..=1000).contains(&t.teeth),
        "5 to 1000",
    )?;
    require("module_mm", t.module_mm, t.module_mm > 0.0, "more than 0")?;
    require(
        "pressure_angle_deg",
        t.pressure_angle_deg,
        (10.0..=35.0).contains(&t.pressure_angle_deg),
        "10 to 35",
    )?;
    require(
        "profile_shift",
        t.profile_shift,
        t.profile_shift.abs() <= 2.0,
        "-2 to 2",
    )?;
    require(
        "dedendum",
        t.dedendum,
        t.dedendum > 0.0,
        "more than 0 (multiples of the module)",
    )?;
    require(
        "rack_tip_radius",
        t.rack_tip_radius,
        t.rack_tip_radius >= 0.0,
        "0 or more (multiples of the module)",
    )?;
    require(
        "face_width_mm",
        t.face_width_mm,
        t.face_width_mm > 0.0,
        "more than 0",
    )?;
    require(
        "tip_chamfer_mm",
        t.tip_chamfer_mm,
        t.tip_chamfer_mm >= 0.0,
        "0 or more",
    )?;
    let thickness = 0.5 * std::f64::consts::PI * t.module_mm;
    require(
        "thickness_allowance_mm",
        t.thickness_allowance_mm,
        (0.0..thickness).contains(&t.thickness_allowance_mm),
        &format!("0 up to half a pitch, {thickness:.3}"),
    )?;
    if t.addendum.is_some() && t.tip_diameter_mm.is_some() {
        return Err(document.error(
            "tooth.addendum",
            "addendum and tip_diameter_mm both set the tip circle; give one of them",
        ));
    }
    Ok(ToothDefinition {
        teeth: t.teeth,
        module_m: t.module_mm * MM,
        pressure_angle_rad: t.pressure_angle_deg.to_radians(),
        profile_shift: t.profile_shift,
        addendum: t.addendum.unwrap_or(1.0),
        dedendum: t.dedendum,
        rack_tip_radius: t.rack_tip_radius,
        tip_diameter_m: t.tip_diameter_mm.map(|v| v * MM),
        thickness_allowance_m: t.thickness_allowance_mm * MM,
        tip_chamfer_m: t.tip_chamfer_mm * MM,
        face_width_m: t.face_width_mm * MM,
    })
}

fn blank(
    document: &InputDocument,
    b: &BlankTable,
    tooth: &ToothDefinition,
    profile: &ToothGeometry,
) -> Result<Blank, InputError> {
    let error = |key: &str, problem: String| document.error(&format!("blank.{key}"), problem);
    let root_mm = 2.0 * profile.root_radius_m / MM;
    // Below the root a ring of half a module must stay: the teeth's root stress lives in it.
    let ring_mm = root_mm - tooth.module_m / MM;
    if !(b.bore_diameter_mm > 0.0 && b.bore_diameter_mm < ring_mm) {
        return Err(error(
            "bore_diameter_mm",
            format!(
                "found {}, allowed is more than 0 and less than {ring_mm:.3}: the root diameter {root_mm:.3} less one module, so that half a module of body stays below the teeth",
                b.bore_diameter_mm
            ),
        ));
    }
    let width_mm = tooth.face_width_m / MM;
    let web = match b.kind {
        BlankKind::Solid => {
            for (key, value) in [
                ("hub_diameter_mm", b.hub_diameter_mm),
                ("rim_inner_diameter_mm", b.rim_inner_diameter_mm),
                ("web_thickness_mm", b.web_thickness_mm),
                ("web_offset_mm", b.web_offset_mm),
            ] {
                if value.is_some() {
                    return Err(error(
                        key,
                        "a solid blank does not use it; remove it or set kind = \"thin-rim\""
                            .into(),
                    ));
                }
            }
            None
        }
        BlankKind::ThinRim => {
            let missing = |key: &str| error(key, "missing; a thin-rim blank needs it".into());
            let hub = b
                .hub_diameter_mm
                .ok_or_else(|| missing("hub_diameter_mm"))?;
            let rim = b
                .rim_inner_diameter_mm
                .ok_or_else(|| missing("rim_inner_diameter_mm"))?;
            let thickness = b
                .web_thickness_mm
                .ok_or_else(|| missing("web_thickness_mm"))?;
            let offset = b.web_offset_mm.unwrap_or(0.0);
            if !(hub > b.bore_diameter_mm && hub.is_finite()) {
                return Err(error(
                    "hub_diameter_mm",
                    format!(
                        "found {hub}, allowed is more than the bore, {}",
                        b.bore_diameter_mm
                    ),
                ));
            }
            if !(rim > hub && rim < ring_mm) {
                return Err(error(
                    "rim_inner_diameter_mm",
                    format!(
                        "found {rim}, allowed is more than the hub, {hub}, and less than {ring_mm:.3}: the root diameter {root_mm:.3} less one module, so that the rim is at least half a module thick"
                    ),
                ));
            }
            if !(thickness > 0.0 && thickness <= width_mm) {
                return Err(error(
                    "web_thickness_mm",
                    format!(
                        "found {thickness}, allowed is more than 0 and at most the face width, {width_mm}"
                    ),
                ));
            }
            let room = 0.5 * (width_mm - thickness);
            if offset.is_nan() || offset.abs() > room + 1e-9 {
                return Err(error(
                    "web_offset_mm",
                    format!(
                        "found {offset}, allowed is -{room} to {room}: the web must stay inside the face width"
                    ),
                ));
            }
            Some(Web {
                hub_radius_m: 0.5 * hub * MM,
                rim_inner_radius_m: 0.5 * rim * MM,
                thickness_m: thickness * MM,
                offset_m: offset * MM,
            })
        }
    };
    let (inner_mm, outer_mm) = web.map_or((0.5 * b.bore_diameter_mm, 0.5 * ring_mm), |w| {
        (w.hub_radius_m / MM, w.rim_inner_radius_m / MM)
    });
    let openings = match (&b.slots, &b.holes) {
        (None, None) => None,
        (Some(_), Some(_)) => {
            return Err(error(
                "holes",
                "slots and holes are both given; a blank has one kind of opening".into(),
            ));
        }
        (Some(s), None) => Some(Openings::Slots(slots(document, s)?)),
        (None, Some(h)) => Some(Openings::Holes(holes(document, h)?)),
    };
    if let Some(o) = &openings {
        let key = if matches!(o, Openings::Slots(_)) {
            "slots"
        } else {
            "holes"
        };
        let (r_in, r_out) = o.radii_m();
        let margin = 0.25 * tooth.module_m / MM;
        if r_in / MM < inner_mm + margin || r_out / MM > outer_mm - margin {
            return Err(error(
                key,
                format!(
                    "they reach from radius {:.3} to {:.3} mm; allowed is {:.3} to {:.3} mm, a quarter module inside the body's edges",
                    r_in / MM,
                    r_out / MM,
                    inner_mm + margin,
                    outer_mm - margin
                ),
            ));
        }
        let spoke = TAU / o.count() as f64 - 2.0 * o.half_width_rad();
        let least = tooth.module_m / r_in;
        if spoke < least {
            return Err(error(
                key,
                format!(
                    "{} openings of {:.3} deg meet: {:.3} deg are left between them, allowed is at least {:.3} deg (one module at their inner radius)",
                    o.count(),
                    2.0 * o.half_width_rad().to_degrees(),
                    spoke.to_degrees(),
                    least.to_degrees()
                ),
            ));
        }
    }
    Ok(Blank {
        bore_radius_m: 0.5 * b.bore_diameter_mm * MM,
        web,
        openings,
    })
}

fn slots(document: &InputDocument, s: &SlotsTable) -> Result<Slots, InputError> {
    let require = |key: &str, value: f64, ok: bool, allowed: &str| {
        require(document, &format!("blank.slots.{key}"), value, ok, allowed)
    };
    require(
        "count",
        s.count as f64,
        (1..=200).contains(&s.count),
        "1 to 200",
    )?;
    require(
        "inner_radius_mm",
        s.inner_radius_mm,
        s.inner_radius_mm > 0.0,
        "more than 0",
    )?;
    require(
        "outer_radius_mm",
        s.outer_radius_mm,
        s.outer_radius_mm > s.inner_radius_mm,
        "more than inner_radius_mm",
    )?;
    require(
        "width_deg",
        s.width_deg,
        s.width_deg > 0.0 && s.width_deg < 180.0,
        "more than 0 and less than 180",
    )?;
    require(
        "phase_deg",
        s.phase_deg,
        s.phase_deg.abs() <= 360.0,
        "-360 to 360",
    )?;
    let height = s.outer_radius_mm - s.inner_radius_mm;
    let chord = s.inner_radius_mm * s.width_deg.to_radians();
    let largest = 0.45 * height.min(chord);
    require(
        "corner_radius_mm",
        s.corner_radius_mm,
        s.corner_radius_mm > 0.0 && s.corner_radius_mm <= largest,
        &format!(
            "more than 0 and at most {largest:.3}: a little less than half of the slot's height and inner width"
        ),
    )?;
    Ok(Slots {
        count: s.count,
        inner_radius_m: s.inner_radius_mm * MM,
        outer_radius_m: s.outer_radius_mm * MM,
        width_rad: s.width_deg.to_radians(),
        phase_rad: s.phase_deg.to_radians(),
        corner_radius_m: s.corner_radius_mm * MM,
    })
}

fn holes(document: &InputDocument, h: &HolesTable) -> Result<Holes, InputError> {
    let require = |key: &str, value: f64, ok: bool, allowed: &str| {
        require(document, &format!("blank.holes.{key}"), value, ok, allowed)
    };
    require(
        "count",
        h.count as f64,
        (1..=200).contains(&h.count),
        "1 to 200",
    )?;
    require(
        "diameter_mm",
        h.diameter_mm,
        h.diameter_mm > 0.0,
        "more than 0",
    )?;
    require(
        "pitch_circle_diameter_mm",
        h.pitch_circle_diameter_mm,
        h.pitch_circle_diameter_mm > h.diameter_mm,
        "more than diameter_mm",
    )?;
    require(
        "phase_deg",
        h.phase_deg,
        h.phase_deg.abs() <= 360.0,
        "-360 to 360",
    )?;
    Ok(Holes {
        count: h.count,
        pitch_radius_m: 0.5 * h.pitch_circle_diameter_mm * MM,
        radius_m: 0.5 * h.diameter_mm * MM,
        phase_rad: h.phase_deg.to_radians(),
    })
}

fn microgeometry(
    document: &InputDocument,
    t: &MicrogeometryTable,
    profile: &ToothGeometry,
    face_width_m: f64,
) -> Result<Microgeometry, InputError> {
    let error =
        |key: &str, problem: String| document.error(&format!("microgeometry.{key}"), problem);
    let roll_at = |key: &str, diameter_mm: f64| {
        let low = 2.0 * involute::radius_m(profile.form_roll_rad, profile.base_radius_m) / MM;
        let high = 2.0 * profile.tip_radius_m / MM;
        if diameter_mm >= low && diameter_mm < high {
            Ok(involute::roll_angle_rad(
                0.5 * diameter_mm * MM,
                profile.base_radius_m,
            ))
        } else {
            Err(error(
                key,
                format!(
                    "found {diameter_mm}, allowed is {low:.3} to below {high:.3}: the involute part of the flank"
                ),
            ))
        }
    };
    let profile_crowning = match (t.profile_crowning_um, t.profile_crowning_diameter_mm) {
        (None, None) => None,
        (Some(amount), Some(diameter)) => Some(ProfileCrowning {
            amount_m: amount * UM,
            centre_roll_rad: roll_at("profile_crowning_diameter_mm", diameter)?,
        }),
        (Some(_), None) => {
            return Err(error(
                "profile_crowning_um",
                "needs profile_crowning_diameter_mm, where nothing is removed".into(),
            ));
        }
        (None, Some(_)) => {
            return Err(error(
                "profile_crowning_diameter_mm",
                "is not used without profile_crowning_um".into(),
            ));
        }
    };
    let tip_relief = match (t.tip_relief_um, t.tip_relief_start_diameter_mm) {
        (Some(amount), Some(diameter)) => Some(TipRelief {
            amount_m: amount * UM,
            start_roll_rad: roll_at("tip_relief_start_diameter_mm", diameter)?,
            shape: match t.tip_relief_shape.unwrap_or(TipReliefShape::Linear) {
                TipReliefShape::Linear => ReliefShape::Linear,
                TipReliefShape::Parabolic => ReliefShape::Parabolic,
            },
        }),
        (Some(_), None) => {
            return Err(error(
                "tip_relief_um",
                "needs tip_relief_start_diameter_mm".into(),
            ));
        }
        (None, Some(_)) => {
            return Err(error(
                "tip_relief_start_diameter_mm",
                "is not used without tip_relief_um".into(),
            ));
        }
        (None, None) if t.tip_relief_shape.is_some() => {
            return Err(error(
                "tip_relief_shape",
                "is not used without tip_relief_um".into(),
            ));
        }
        (None, None) => None,
    };
    for (key, value) in [
        ("profile_crowning_um", t.profile_crowning_um),
        ("tip_relief_um", t.tip_relief_um),
        ("lead_crowning_um", t.lead_crowning_um),
        ("flank_angle_um", t.flank_angle_um),
    ] {
        if let Some(v) = value {
            require(
                document,
                &format!("microgeometry.{key}"),
                v,
                v.abs() <= 1000.0,
                "-1000 to 1000",
            )?;
        }
    }
    Ok(Microgeometry {
        tip_roll_rad: profile.tip_roll_rad,
        face_width_m,
        profile_crowning,
        tip_relief,
        lead_crowning_m: t.lead_crowning_um.unwrap_or(0.0) * UM,
        flank_angle_m: t.flank_angle_um.unwrap_or(0.0) * UM,
    })
}

fn mesh(
    document: &InputDocument,
    t: &MeshTable,
    tooth: &ToothDefinition,
) -> Result<MeshSettings, InputError> {
    let module_mm = tooth.module_m / MM;
    let width_mm = tooth.face_width_m / MM;
    let size = |key: &str, value: Option<f64>, default: f64, largest: f64| {
        let v = value.unwrap_or(default);
        require(
            document,
            &format!("mesh.{key}"),
            v,
            v >= 0.01 * module_mm && v <= largest,
            &format!("{:.4} to {largest:.4}", 0.01 * module_mm),
        )?;
        Ok::<f64, InputError>(v * MM)
    };
    if t.plane_strain && t.axial_mm.is_some() {
        return Err(document.error(
            "mesh.axial_mm",
            "plane strain has one layer and does not use it; remove it or set plane_strain = false",
        ));
    }
    let quality = t.min_scaled_jacobian.unwrap_or(0.2);
    require(
        document,
        "mesh.min_scaled_jacobian",
        quality,
        quality > 0.0 && quality <= 0.9,
        "more than 0, at most 0.9",
    )?;
    Ok(MeshSettings {
        element: t.element.unwrap_or(ElementKind::Hex8Incompatible),
        flank_m: size("flank_mm", t.flank_mm, 0.3 * module_mm, module_mm)?,
        fillet_m: size("fillet_mm", t.fillet_mm, 0.08 * module_mm, 0.5 * module_mm)?,
        body_m: size("body_mm", t.body_mm, 1.2 * module_mm, 10.0 * module_mm)?,
        axial_m: size("axial_mm", t.axial_mm, width_mm / 10.0, width_mm)?,
        min_scaled_jacobian: quality,
        plane_strain: t.plane_strain,
    })
}

fn reduction(
    document: &InputDocument,
    t: ReductionTable,
    plane_strain: bool,
) -> Result<ReductionSettings, InputError> {
    let roll_stations = t.roll_stations.unwrap_or(9);
    let (default, most, allowed) = if plane_strain {
        (1, 1, "1 in plane strain")
    } else {
        (5, 100, "1 to 100")
    };
    let slices = t.slices.unwrap_or(default);
    require(
        document,
        "reduction.roll_stations",
        roll_stations as f64,
        (3..=65).contains(&roll_stations),
        "3 to 65",
    )?;
    require(
        document,
        "reduction.slices",
        slices as f64,
        (1..=most).contains(&slices),
        allowed,
    )?;
    let flanks = t
        .flanks
        .unwrap_or_else(|| vec![FlankSide::Right, FlankSide::Left]);
    if flanks.is_empty() || (flanks.len() == 2 && flanks[0] == flanks[1]) || flanks.len() > 2 {
        return Err(document.error(
            "reduction.flanks",
            "name each loaded flank once: [\"right\"], [\"left\"] or [\"right\", \"left\"]",
        ));
    }
    Ok(ReductionSettings {
        roll_stations,
        slices,
        flanks,
    })
}

fn gauges(
    document: &InputDocument,
    tables: Vec<GaugeTable>,
    tooth: &ToothDefinition,
    profile: &ToothGeometry,
) -> Result<Vec<GaugeDefinition>, InputError> {
    let curve = ProfileCurve::new(profile);
    let mut gauges: Vec<GaugeDefinition> = Vec::with_capacity(tables.len());
    for (i, g) in tables.into_iter().enumerate() {
        let error =
            |key: &str, problem: String| document.error(&format!("gauge.{i}.{key}"), problem);
        if g.tooth >= tooth.teeth {
            return Err(error(
                "tooth",
                format!("found {}, allowed is 0 to {}", g.tooth, tooth.teeth - 1),
            ));
        }
        if gauges.iter().any(|other| other.name == g.name) {
            return Err(error(
                "name",
                format!("`{}` is used by another gauge", g.name),
            ));
        }
        let half_width = 0.5 * tooth.face_width_m / MM;
        if !(g.width_mm > 0.0 && g.z_mm.abs() + 0.5 * g.width_mm <= half_width) {
            return Err(error(
                "width_mm",
                format!(
                    "found {} at z {} mm: the gauge must lie between z -{half_width} and {half_width} mm",
                    g.width_mm, g.z_mm
                ),
            ));
        }
        if !(g.length_mm > 0.0 && g.length_mm <= tooth.module_m / MM) {
            return Err(error(
                "length_mm",
                format!(
                    "found {}, allowed is more than 0 and at most one module",
                    g.length_mm
                ),
            ));
        }
        let position = match (g.tangent_deg, g.radius_mm) {
            (None, None) => RootPosition::TangentAngle(30f64.to_radians()),
            (Some(angle), None) => RootPosition::TangentAngle(angle.to_radians()),
            (None, Some(radius)) => RootPosition::Radius(radius * MM),
            (Some(_), Some(_)) => {
                return Err(error(
                    "radius_mm",
                    "tangent_deg and radius_mm both place the gauge; give one of them".into(),
                ));
            }
        };
        if let Err(problem) = curve.arc_length_at(position) {
            return Err(error(
                if g.radius_mm.is_some() {
                    "radius_mm"
                } else {
                    "tangent_deg"
                },
                problem.to_string(),
            ));
        }
        gauges.push(GaugeDefinition {
            name: g.name,
            tooth: g.tooth,
            side: g.side,
            position,
            length_m: g.length_mm * MM,
            z_m: g.z_mm * MM,
            width_m: g.width_mm * MM,
        });
    }
    Ok(gauges)
}
