//! Tooth contact analysis: path of contact, transmission error, ellipses, ease-off, contact ratio, edge contact and
//! what assembly errors do to them.

use crate::assembly::{Assembly, AssemblyError};
use crate::between_positions::between_positions;
use crate::blank::PairBlank;
use crate::contact_ellipse::ContactEllipse;
use crate::contact_path::{PairContacts, first_touch, pair_contacts};
use crate::contact_point::{ContactKind, Mesh, Touch};
use crate::contact_search::ContactSearch;
use crate::ease_off::{EaseOff, EaseOffMap};
use crate::error::BevelError;
use crate::flank::Flank;

/// What a contact analysis is asked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TcaRequest {
    /// Where the members stand.
    pub error: AssemblyError,
    /// Marking thickness of the ellipses \[m\].
    pub marking_m: f64,
    /// Positions a pitch.
    pub per_pitch: usize,
    /// Places of the ease-off along the face and up the flank.
    pub map: [usize; 2],
}

impl Default for TcaRequest {
    /// Marking compound 6.35 µm (0.25 thousandths of an inch), 48 positions a pitch, ease-off at 9 × 5 places.
    fn default() -> Self {
        Self {
            error: AssemblyError::default(),
            marking_m: 6.35e-6,
            per_pitch: 48,
            map: [9, 5],
        }
    }
}

/// A contact of one tooth pair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathPoint {
    /// Turn of the pinion \[rad\].
    pub pinion_turn_rad: f64,
    /// Transmission error: turn of the gear ahead of constant ratio in the driven sense, less the largest of all
    /// positions \[rad\].
    pub error_rad: f64,
    /// The same from where the mean points of both flanks meet in the pair as designed: with what an assembly with
    /// errors adds to it for good \[rad\].
    pub lead_rad: f64,
    /// Whether the position stands between the equal steps: where the next pair takes over, or the lead has an extreme.
    pub is_between: bool,
    /// What touches.
    pub kind: ContactKind,
    /// Whether no other tooth pair touches before this one.
    pub leading: bool,
    /// L and h on the pinion and on the gear \[m\].
    pub places_m: [[f64; 2]; 2],
    /// Ellipse of both surfaces; none at edges.
    pub ellipse: Option<ContactEllipse>,
    /// The contact.
    pub touch: Touch,
}

/// Answer of a tooth contact analysis.
#[derive(Debug, Clone, PartialEq)]
pub struct ToothContact {
    /// Contacts of one pair in the order of the pinion's turn. At each turn only that in which the pair touches first.
    pub path: Vec<PathPoint>,
    /// Transmission error of the pair of gears over one pitch, at equal steps from turn 0 \[rad\].
    pub error_rad: Vec<f64>,
    /// Largest transmission error of all positions, from where the mean points of both flanks meet in the pair as
    /// designed \[rad\].
    pub largest_rad: f64,
    /// Largest less smallest transmission error, changes of pairs and extremes between the steps included \[rad\].
    pub peak_to_peak_rad: f64,
    /// Pitches during which a pair's flanks touch at the path inside their limits; 0 where only edges touch.
    pub contact_ratio: f64,
    /// Contact of the extended flanks at which the ratio of speeds is exactly that of the teeth; none where only edges
    /// touch, and of conjugate flanks.
    pub mean: Option<Touch>,
    /// Ease-off over the pinion's flank in this assembly.
    pub ease_off: EaseOffMap,
    /// Positions at which an edge is the first to touch, of all positions of the path that lead.
    pub edge_share: f64,
}

/// Least relative curvature over the largest below which flanks touch along a line.
const LINE_CONTACT: f64 = 1e-8;
/// Steps in which errors of assembly are brought into the ease-off.
const EASE_OFF_PARTS: i32 = 8;

/// Analyses a pair of flanks.
///
/// # Errors
/// [`BevelError`] where the flanks do not touch, or along a line.
pub fn tooth_contact(
    flanks: [&Flank; 2],
    blank: &PairBlank,
    request: &TcaRequest,
) -> Result<ToothContact, BevelError> {
    let assembly = Assembly::new(blank, &request.error);
    let mesh = Mesh {
        flanks,
        assembly: &assembly,
    };
    let is_conjugate = are_conjugate(flanks, blank);
    if is_conjugate && request.error == AssemblyError::default() {
        return Err(touches_along_lines());
    }
    let search = ContactSearch::new(mesh)?;
    let contacts = pair_contacts(&search, request.per_pitch);
    let leaders = leaders(&mesh, &contacts, request.per_pitch)?;
    let n = request.per_pitch as i64;
    let between = between_positions(&search, &contacts, &leaders);
    let leads = leaders.iter().map(|(_, lead)| *lead);
    let leads = leads.chain(between.iter().map(|(_, touch)| mesh.lead_rad(touch)));
    let largest = leads.clone().fold(f64::NEG_INFINITY, f64::max);
    let smallest = leads.fold(f64::INFINITY, f64::min);
    let point = |kind, touch: &Touch, leading, is_between| {
        let mut point = path_point(&mesh, kind, touch, largest);
        (point.leading, point.is_between) = (leading, is_between);
        point
    };
    let steps = contacts.contacts.iter().map(|(i, kind, touch)| {
        let leads = mesh.lead_rad(touch) >= leaders[i.rem_euclid(n) as usize].1;
        point(*kind, touch, leads, false)
    });
    let mut path: Vec<PathPoint> = steps.collect();
    path.extend((between.iter()).map(|(kind, touch)| point(*kind, touch, true, true)));
    path.sort_by(|a, b| a.pinion_turn_rad.total_cmp(&b.pinion_turn_rad));
    let at_steps = || path.iter().filter(|p| p.leading && !p.is_between);
    let leading = at_steps().count() as f64;
    let edges = at_steps().filter(|p| p.kind != ContactKind::Flanks).count() as f64;
    let best = path
        .iter()
        .filter(|p| p.kind == ContactKind::Flanks)
        .max_by(|a, b| a.error_rad.total_cmp(&b.error_rad));
    // From the mean points as designed, and where errors are too large for that, from the contact that is farthest
    // ahead.
    let designed = first_touch(flanks, blank, &request.error).map(|(_, touch)| touch);
    let starts = [designed.ok(), best.map(|p| p.touch)];
    let mut means = starts.into_iter().flatten();
    let mean = if is_conjugate {
        None
    } else {
        means.find_map(|start| {
            let found = mean_contact(&mesh, &start).ok();
            found.filter(|touch| mesh.is_near_flanks(touch))
        })
    };
    keep_near_leading(&mut path, n as usize);
    let pitch = contacts.step_rad * request.per_pitch as f64;
    Ok(ToothContact {
        error_rad: leaders.iter().map(|(_, lead)| lead - largest).collect(),
        largest_rad: largest,
        peak_to_peak_rad: largest - smallest,
        contact_ratio: contacts
            .flank_span_rad
            .map_or(0.0, |[a, b]| (b - a) / pitch),
        mean,
        ease_off: ease_off_map(flanks, blank, &request.error, request.map)?,
        edge_share: edges / leading,
        path,
    })
}

/// Of each turn the contact of the pair that brings the gear farthest, by which it is pushed, and the lead.
fn leaders(
    mesh: &Mesh<'_>,
    contacts: &PairContacts,
    per_pitch: usize,
) -> Result<Vec<(i64, f64)>, BevelError> {
    let n = per_pitch as i64;
    let mut leaders = vec![(0, f64::NEG_INFINITY); per_pitch];
    for (i, _, touch) in &contacts.contacts {
        let (slot, lead) = (i.rem_euclid(n) as usize, mesh.lead_rad(touch));
        if lead > leaders[slot].1 {
            leaders[slot] = (*i, lead);
        }
    }
    if leaders.iter().any(|(_, lead)| !lead.is_finite()) {
        return Err(BevelError::NoContact {
            hint: "at some turns no tooth reaches its mate, edges included; make the errors smaller",
        });
    }
    Ok(leaders)
}

/// A contact as a point of the path; whether it leads is not known yet.
fn path_point(mesh: &Mesh<'_>, kind: ContactKind, touch: &Touch, largest_rad: f64) -> PathPoint {
    let lead_rad = mesh.lead_rad(touch);
    let place = |k: usize| {
        let point = mesh.flanks[k].point(touch.at[k]);
        point.map_or([f64::NAN; 2], |p| mesh.flanks[k].place(&p.r))
    };
    PathPoint {
        pinion_turn_rad: touch.pinion_turn_rad,
        error_rad: lead_rad - largest_rad,
        lead_rad,
        is_between: false,
        kind,
        leading: false,
        places_m: [place(0), place(1)],
        ellipse: (kind == ContactKind::Flanks).then(|| ContactEllipse::at(touch)),
        touch: *touch,
    }
}

/// Conjugate flanks have no path of contact.
pub(crate) fn touches_along_lines() -> BevelError {
    BevelError::NoContact {
        hint: "they are conjugate and touch along a line, which has no path of contact; look at their ease-off",
    }
}

/// Whether flanks touch along a line in the pair as designed.
pub fn are_conjugate(flanks: [&Flank; 2], blank: &PairBlank) -> bool {
    first_touch(flanks, blank, &AssemblyError::default())
        .is_ok_and(|(_, touch)| touches_along_line(&touch))
}

/// Whether flanks touch along a line.
pub(crate) fn touches_along_line(touch: &Touch) -> bool {
    let [least, largest] = ContactEllipse::at(touch).curvatures_per_m;
    least.abs() < LINE_CONTACT * largest.abs()
}

/// Leaves out what lies more than half a pitch before or after the turns at which the pair leads.
fn keep_near_leading(path: &mut Vec<PathPoint>, per_pitch: usize) {
    let leads = |p: &PathPoint| p.leading || p.kind == ContactKind::Flanks;
    let first = path.iter().position(leads).unwrap_or(0);
    let last = path.iter().rposition(leads).unwrap_or(0);
    path.truncate(last + 1 + per_pitch / 2);
    path.drain(..first.saturating_sub(per_pitch / 2));
}

/// Ease-off over the pinion's flank in an assembly with errors, which are brought in step by step.
///
/// # Errors
/// [`BevelError::NoMate`] where the pinion's pitch line never meets the gear's surface.
pub fn ease_off_map(
    flanks: [&Flank; 2],
    blank: &PairBlank,
    error: &AssemblyError,
    map: [usize; 2],
) -> Result<EaseOffMap, BevelError> {
    let mut start = EaseOff {
        gap_m: 0.0,
        pinion_turn_rad: 0.0,
        gear_at: flanks[1].mean().at,
    };
    for part in 0..=EASE_OFF_PARTS {
        let share = f64::from(part) / f64::from(EASE_OFF_PARTS);
        let assembly = Assembly::new(blank, &error.scaled(share));
        let mesh = Mesh {
            flanks,
            assembly: &assembly,
        };
        start = mesh.ease_off(flanks[0].mean().at, &start)?;
    }
    let assembly = Assembly::new(blank, error);
    let mesh = Mesh {
        flanks,
        assembly: &assembly,
    };
    mesh.ease_off_map_from(&start, map[0], map[1])
}

/// The contact of the extended surfaces at which the ratio of speeds is that of the teeth: n·v₁₂ = 0 with constant
/// ratio. Secant method on the pinion's turn.
///
/// # Errors
/// [`BevelError::NoContact`].
pub fn mean_contact(mesh: &Mesh<'_>, first: &Touch) -> Result<Touch, BevelError> {
    let none = BevelError::NoContact {
        hint: "no position has the ratio of speeds of the teeth",
    };
    let slip = |touch: &Touch| mesh.slip(&touch.points[1]);
    let mut a = *first;
    let mut fa = slip(&a);
    let Some(mut b) = mesh.touch(a.pinion_turn_rad + 1e-3, &a) else {
        return Err(none);
    };
    for _ in 0..60 {
        let fb = slip(&b);
        if fb.abs() < 1e-14 {
            return Ok(b);
        }
        let slope = (fb - fa) / (b.pinion_turn_rad - a.pinion_turn_rad);
        if slope == 0.0 || !slope.is_finite() {
            return if fb.abs() < 1e-11 { Ok(b) } else { Err(none) };
        }
        let step = (-fb / slope).clamp(-0.05, 0.05);
        let Some(next) = mesh.touch(b.pinion_turn_rad + step, &b) else {
            return Err(none);
        };
        (a, fa) = (b, fb);
        b = next;
        if step.abs() < 1e-14 {
            return Ok(b);
        }
    }
    Err(none)
}

/// How far the mean contact moves on the gear's flank by each assembly error: ΔL and Δh per metre or radian.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sensitivity {
    /// By the offset V.
    pub offset: [f64; 2],
    /// By the pinion's axial place.
    pub pinion_axial: [f64; 2],
    /// By the gear's axial place.
    pub gear_axial: [f64; 2],
    /// By the shaft angle \[m/rad\].
    pub shaft_angle: [f64; 2],
}

/// Where the mean contact of an assembly lies on the gear, L and h \[m\], from one nearby.
fn mean_place_m(
    flanks: [&Flank; 2],
    blank: &PairBlank,
    error: &AssemblyError,
    near: &Touch,
) -> Result<[f64; 2], BevelError> {
    let none = || BevelError::NoContact {
        hint: "make the errors smaller",
    };
    let assembly = Assembly::new(blank, error);
    let mesh = Mesh {
        flanks,
        assembly: &assembly,
    };
    let start = mesh.touch(near.pinion_turn_rad, near).ok_or_else(none)?;
    let mean = mean_contact(&mesh, &start)?;
    let p = flanks[1].point(mean.at[1]).ok_or_else(none)?;
    Ok(flanks[1].place(&p.r))
}

/// Sensitivity of the mean contact round an assembly, by central differences over 0.1 µm and 1 µrad. `mean`: the mean
/// contact in this assembly.
///
/// # Errors
/// [`BevelError::NoContact`].
pub fn sensitivity(
    flanks: [&Flank; 2],
    blank: &PairBlank,
    (error, mean): (&AssemblyError, &Touch),
) -> Result<Sensitivity, BevelError> {
    let place = |error: &AssemblyError| mean_place_m(flanks, blank, error, mean);
    let slope = |by: AssemblyError, size: f64| -> Result<[f64; 2], BevelError> {
        let shifted = |sign: f64| place(&error.plus(&by.scaled(sign)));
        let (up, down) = (shifted(1.0)?, shifted(-1.0)?);
        Ok([0, 1].map(|i| (up[i] - down[i]) / (2.0 * size)))
    };
    let zero = AssemblyError::default();
    Ok(Sensitivity {
        offset: slope(
            AssemblyError {
                offset_m: 1e-7,
                ..zero
            },
            1e-7,
        )?,
        pinion_axial: slope(
            AssemblyError {
                pinion_axial_m: 1e-7,
                ..zero
            },
            1e-7,
        )?,
        gear_axial: slope(
            AssemblyError {
                gear_axial_m: 1e-7,
                ..zero
            },
            1e-7,
        )?,
        shaft_angle: slope(
            AssemblyError {
                shaft_angle_rad: 1e-6,
                ..zero
            },
            1e-6,
        )?,
    })
}
