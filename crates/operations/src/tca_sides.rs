//! One side of the teeth of an assembled bevel pair: its contact, and what is said of it by pages, lines and figures.

use crate::bevel_pair::{fit_figures, fit_words};
use gearmesh_bevel::ease_off::EaseOffMap;
use gearmesh_bevel::tca::{PathPoint, ease_off_map};
use gearmesh_bevel::{
    BevelError, Flank, FlankSide, PairDesign, PairFile, Sensitivity, ToothContact, VhCheck,
    VhSetting, VhStop, sensitivity,
};
use serde_json::{Value, json};

/// One side of the teeth.
pub struct Side<'a> {
    /// Flanks of pinion and gear.
    pub flanks: [&'a Flank; 2],
    /// Their contact; none of flanks that touch along lines.
    pub contact: Option<ToothContact>,
    /// How further errors of assembly move it; none where only edges touch.
    pub moved: Option<Sensitivity>,
    /// What brings the mean contact to toe and heel; none where there is no mean contact.
    pub vh: Option<VhCheck>,
    /// Ease-off over the pinion's flank.
    pub ease_off: EaseOffMap,
}

impl Side<'_> {
    /// In words.
    pub fn name(&self) -> String {
        side_name(self.flanks[0].side)
    }
}

/// What is to be shown of one side of a pair.
pub(crate) fn side<'a>(
    file: &PairFile,
    design: &'a PairDesign,
    (pinion, contact): (FlankSide, Option<ToothContact>),
) -> Result<Side<'a>, BevelError> {
    let flanks = design.flanks(pinion);
    let (blank, error) = (&file.blank, &file.tca.error);
    let mean = contact.as_ref().and_then(|contact| contact.mean);
    let ease_off = match &contact {
        Some(contact) => contact.ease_off.clone(),
        None => ease_off_map(flanks, blank, error, file.tca.map)?,
    };
    Ok(Side {
        flanks,
        moved: mean.and_then(|mean| sensitivity(flanks, blank, (error, &mean)).ok()),
        vh: mean.map(|mean| design.vh_check(blank, pinion, (error, &mean))),
        ease_off,
        contact,
    })
}

/// Flanks that nowhere touch inside their limits are no mates, or stand far off their places.
pub(crate) fn edge_words(pinion: FlankSide, contact: Option<&ToothContact>) -> Option<String> {
    contact.filter(|c| c.contact_ratio == 0.0).map(|_| {
        format!(
            "{}: only edges touch, the flanks do not meet inside their limits: settings of one pair, and the errors of assembly?",
            side_name(pinion)
        )
    })
}

/// A side in words.
fn side_name(pinion: FlankSide) -> String {
    format!("pinion {} on gear {}", pinion.word(), pinion.mate().word())
}

/// Said instead of sensitivities.
pub(crate) const NO_MEAN: &str = "the flanks have no contact at constant ratio in this assembly: nothing is said of what further errors do";

/// Names, and how the mean contact moves along the tooth and up the flank: mm per mm, mm per mrad.
pub(crate) fn moves(s: &Sensitivity) -> [(&'static str, [f64; 2]); 4] {
    [
        ("offset, mm per mm", s.offset),
        ("pinion axial, mm per mm", s.pinion_axial),
        ("gear axial, mm per mm", s.gear_axial),
        ("shaft angle, mm per mrad", s.shaft_angle),
    ]
}

/// What is to be known of flanks through points: how well they fit, and what that is beside the transmission error.
/// Nothing of flanks that were cut.
pub(crate) fn worth_of_points(flanks: [&Flank; 2]) -> Vec<String> {
    let words = |flank: &Flank| {
        let fit = flank.grid_fit()?;
        // Material along the normal turns the gear by its amount over the arm of the normal about the gear's axis.
        let mean = &flanks[1].mean().point;
        let arm_m = (mean.r.x * mean.n.y - mean.r.y * mean.n.x).abs();
        Some(format!(
            "{}: {}; {:.3} um turn the gear by {:.3} urad",
            flank.name(),
            fit_words(fit),
            1e6 * fit.left_out_rms_m,
            1e6 * fit.left_out_rms_m / arm_m
        ))
    };
    flanks.into_iter().filter_map(words).collect()
}

/// The first line of a side.
pub(crate) fn headline(side: &Side<'_>) -> String {
    match &side.contact {
        None => format!(
            "{}: conjugate, the flanks touch along lines and have no path of contact and no transmission error; their ease-off is below",
            side.name()
        ),
        Some(found) => format!(
            "{}; transmission error peak to peak {:.3} urad of the gear, contact ratio of the path {:.4}, edges touch first on {:.1} % of it",
            side.name(),
            1e6 * found.peak_to_peak_rad,
            found.contact_ratio,
            100.0 * found.edge_share
        ),
    }
}

/// A place of the V/H check, and its figures or why it is not reached.
pub(crate) type VhRow = (&'static str, Result<[f64; 6], String>);

/// Rows of the V/H check: where the contact is brought and by what; E, P, G in mm, the shaft angle in mrad.
pub(crate) fn vh_rows(vh: &VhCheck) -> [VhRow; 4] {
    let row = |s: &Result<VhSetting, VhStop>| {
        let s = s.map_err(|stop| stop.words())?;
        let e = &s.error;
        let mm = [
            s.place_m[0],
            s.place_m[1],
            e.offset_m,
            e.pinion_axial_m,
            e.gear_axial_m,
        ];
        let [l, h, v, p, g] = mm.map(|x| 1e3 * x);
        Ok([l, h, v, p, g, 1e3 * e.shaft_angle_rad])
    };
    let [toe, heel] = vh.by_offset.each_ref().map(row);
    let [toe_by_angle, heel_by_angle] = vh.by_shaft_angle.each_ref().map(row);
    [
        ("toe by offset", toe),
        ("heel by offset", heel),
        ("toe by shaft angle", toe_by_angle),
        ("heel by shaft angle", heel_by_angle),
    ]
}

/// What the assembly leaves between the flanks that do not drive.
pub(crate) fn backlash_words(backlash_m: f64) -> String {
    format!(
        "backlash in this assembly at least {:.4} mm along the normal at the gear's mean point",
        1e3 * backlash_m
    )
}

pub(crate) fn figures(file: &PairFile, side: &Side<'_>) -> Value {
    let point = |p: &PathPoint| {
        let ellipse = p.ellipse.map(|e| {
            e.half_lengths_m(file.tca.marking_m)
                .map(|x| x.is_finite().then_some(1e3 * x))
        });
        json!({
            "pinion_deg": p.pinion_turn_rad.to_degrees(),
            "error_urad": 1e6 * p.error_rad,
            "lead_urad": 1e6 * p.lead_rad,
            "touches": p.kind.words(),
            "first": p.leading,
            "between_steps": p.is_between,
            "pinion_place_mm": p.places_m[0].map(|x| 1e3 * x),
            "gear_place_mm": p.places_m[1].map(|x| 1e3 * x),
            "ellipse_half_lengths_mm": ellipse,
        })
    };
    let map: Vec<Value> = side
        .ease_off
        .iter()
        .map(|([l, h], e)| json!([1e3 * l, 1e3 * h, e.map(|e| 1e6 * e.gap_m)]))
        .collect();
    let vh = |vh: &VhCheck| {
        let row = |(name, found): VhRow| match found {
            Ok([l, h, v, p, g, angle]) => json!({
                "contact": name, "gear_place_mm": [l, h], "offset_mm": v, "pinion_axial_mm": p, "gear_axial_mm": g,
                "shaft_angle_mrad": angle,
            }),
            Err(why) => json!({ "contact": name, "problem": why }),
        };
        Value::from(vh_rows(vh).into_iter().map(row).collect::<Vec<_>>())
    };
    let mut all = json!({
        "vh_check": side.vh.as_ref().map(vh),
        "pinion_flank": side.flanks[0].side.word(),
        "conjugate": side.contact.is_none(),
        "fit_of_points": side.flanks.map(|flank| flank.grid_fit().map(fit_figures)),
        "ease_off_mm_mm_um": map,
        "sensitivity": side.moved.as_ref().map(|moved| moves(moved).into_iter().map(|(k, v)| (k.to_owned(), json!(v))).collect::<serde_json::Map<_, _>>()),
    });
    if let Some(found) = &side.contact {
        all["peak_to_peak_urad"] = json!(1e6 * found.peak_to_peak_rad);
        all["constant_urad"] = json!(1e6 * found.largest_rad);
        all["contact_ratio"] = json!(found.contact_ratio);
        all["edge_share"] = json!(found.edge_share);
        let errors = found.error_rad.iter().map(|x| 1e6 * x);
        all["error_urad"] = errors.collect::<Vec<_>>().into();
        all["path"] = found.path.iter().map(point).collect();
    }
    all
}
