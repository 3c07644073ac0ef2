//! Tooth contact analysis: path of contact, transmission error, ellipses, ease-off, contact ratio, edge contact and
//! what assembly errors do to them.

use crate::assembly::{Assembly, AssemblyError};
use crate::blank::PairBlank;
use crate::contact_ellipse::ContactEllipse;
use crate::contact_path::{ContactKind, PairContacts, first_touch};
use crate::contact_point::{Mesh, Touch};
use crate::ease_off::EaseOff;
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
    /// Largest less smallest transmission error \[rad\].
    pub peak_to_peak_rad: f64,
    /// Pitches during which a pair's flanks touch at the path inside their limits; 0 where only edges touch.
    pub contact_ratio: f64,
    /// Contact at which the ratio of speeds is exactly that of the teeth.
    pub mean: Touch,
    /// Ease-off over the pinion's flank in this assembly: L, h and gap.
    pub ease_off: Vec<([f64; 2], EaseOff)>,
    /// Positions at which an edge is the first to touch, of all positions of the path that lead.
    pub edge_share: f64,
}

/// Least relative curvature over the largest below which flanks touch along a line.
const LINE_CONTACT: f64 = 1e-8;

/// Analyses a pair of flanks.
///
/// # Errors
/// [`BevelError`] where the flanks do not touch, or only in lines.
pub fn tooth_contact(
    flanks: [&Flank; 2],
    blank: &PairBlank,
    request: &TcaRequest,
) -> Result<ToothContact, BevelError> {
    let (assembly, first) = first_touch(flanks, blank, &request.error)?;
    let mesh = Mesh {
        flanks,
        assembly: &assembly,
    };
    let [least, largest] = ContactEllipse::at(&first).curvatures_per_m;
    if least.abs() < LINE_CONTACT * largest.abs() {
        return Err(BevelError::NoContact {
            hint: "they are conjugate and touch along a line, which has no path of contact; look at their ease-off",
        });
    }
    let contacts = mesh.pair_contacts(&first, request.per_pitch);
    let best = first_of_each_turn(&mesh, &contacts);
    if best.is_empty() {
        return Err(BevelError::NoContact {
            hint: "the path of contact passes beside the flanks; make the errors smaller",
        });
    }
    // The gear is pushed by the pair that brings it farthest.
    let n = request.per_pitch as i64;
    let mut composite = vec![f64::NEG_INFINITY; request.per_pitch];
    for (i, _, touch) in &best {
        let slot = &mut composite[i.rem_euclid(n) as usize];
        *slot = slot.max(mesh.lead_rad(touch));
    }
    if composite.iter().any(|x| !x.is_finite()) {
        return Err(BevelError::NoContact {
            hint: "between two pairs no tooth touches: the contact ratio is below one, edges included",
        });
    }
    let largest = composite.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let smallest = composite.iter().copied().fold(f64::INFINITY, f64::min);
    let mut path = Vec::with_capacity(best.len());
    for (i, kind, touch) in &best {
        let lead = mesh.lead_rad(touch);
        let places = [0, 1].map(|k| {
            flanks[k]
                .point(touch.at[k])
                .map_or([f64::NAN; 2], |p| flanks[k].place(&p.r))
        });
        path.push(PathPoint {
            pinion_turn_rad: touch.pinion_turn_rad,
            error_rad: lead - largest,
            kind: *kind,
            leading: lead >= composite[i.rem_euclid(n) as usize],
            places_m: places,
            ellipse: (*kind == ContactKind::Flanks).then(|| ContactEllipse::at(touch)),
            touch: *touch,
        });
    }
    let leading = path.iter().filter(|p| p.leading).count() as f64;
    let edges = path
        .iter()
        .filter(|p| p.leading && p.kind != ContactKind::Flanks)
        .count() as f64;
    let pitch = contacts.step_rad * request.per_pitch as f64;
    Ok(ToothContact {
        error_rad: composite.iter().map(|x| x - largest).collect(),
        peak_to_peak_rad: largest - smallest,
        contact_ratio: contacts
            .flank_span_rad
            .map_or(0.0, |[a, b]| (b - a) / pitch),
        mean: mean_contact(&mesh, &first)?,
        ease_off: mesh.ease_off_map(request.map[0], request.map[1])?,
        edge_share: edges / leading,
        path,
    })
}

/// At each turn the contact at which the pair touches first.
fn first_of_each_turn(mesh: &Mesh<'_>, contacts: &PairContacts) -> Vec<(i64, ContactKind, Touch)> {
    let mut best: Vec<(i64, ContactKind, Touch)> = Vec::new();
    for contact in &contacts.contacts {
        match best.last_mut() {
            Some(last) if last.0 == contact.0 => {
                if mesh.lead_rad(&contact.2) > mesh.lead_rad(&last.2) {
                    *last = *contact;
                }
            }
            _ => best.push(*contact),
        }
    }
    best
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
    let slip = |touch: &Touch| {
        let [m1, m2] = &mesh.assembly.members;
        let p = &touch.points[1];
        let v = m1.axis().cross(&(p.r - m1.apex_m))
            + m2.axis().cross(&(p.r - m2.apex_m)) * mesh.assembly.ratio;
        p.n.dot(&v) / flank_size(mesh)
    };
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

fn flank_size(mesh: &Mesh<'_>) -> f64 {
    mesh.flanks[0].blank.mean_cone_m
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

/// Sensitivity of the mean contact round an assembly, by central differences over 0.1 µm and 1 µrad.
///
/// # Errors
/// [`BevelError::NoContact`].
pub fn sensitivity(
    flanks: [&Flank; 2],
    blank: &PairBlank,
    error: &AssemblyError,
) -> Result<Sensitivity, BevelError> {
    let (_, first) = first_touch(flanks, blank, error)?;
    let place = |error: &AssemblyError| -> Result<[f64; 2], BevelError> {
        let assembly = Assembly::new(blank, error);
        let mesh = Mesh {
            flanks,
            assembly: &assembly,
        };
        let start = mesh
            .touch(first.pinion_turn_rad, &first)
            .ok_or(BevelError::NoContact {
                hint: "make the errors smaller",
            })?;
        let mean = mean_contact(&mesh, &start)?;
        let p = flanks[1].point(mean.at[1]).ok_or(BevelError::NoContact {
            hint: "make the errors smaller",
        })?;
        Ok(flanks[1].place(&p.r))
    };
    let slope = |by: AssemblyError, size: f64| -> Result<[f64; 2], BevelError> {
        let shifted = |sign: f64| {
            let e = by.scaled(sign);
            place(&AssemblyError {
                offset_m: error.offset_m + e.offset_m,
                pinion_axial_m: error.pinion_axial_m + e.pinion_axial_m,
                gear_axial_m: error.gear_axial_m + e.gear_axial_m,
                shaft_angle_rad: error.shaft_angle_rad + e.shaft_angle_rad,
            })
        };
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
