//! V/H check: the errors of assembly that bring the contact to toe and heel, as a testing machine is set. Derivation:
//! docs/theory/bevel_gears.md, "V/H check".

use nalgebra::{Matrix6, Vector3, Vector6};

use crate::assembly::{Assembly, AssemblyError};
use crate::blank::PairBlank;
use crate::contact_point::{ContactKind, Mesh, Touch};
use crate::flank::{Flank, Located};
use crate::hand::FlankSide;
use crate::pair_design::PairDesign;
use crate::tca::{TcaRequest, tooth_contact};

/// Settings of the testing machine for one place of the contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VhSetting {
    /// L and h of the mean contact on the gear \[m\].
    pub place_m: [f64; 2],
    /// Offset E (V), pinion's place P (H), gear's place G and shaft angle, beside those of the assembly.
    pub error: AssemblyError,
}

/// No errors of assembly bring the mean contact to its place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VhStop {
    /// How far the contact goes.
    pub last: VhSetting,
    /// Why it goes no farther.
    pub cause: VhCause,
}

/// Why the mean contact goes no farther.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VhCause {
    /// The pinion's flank, or the surface that it is part of, ends.
    PinionEnds,
    /// The gear's lead has no maximum there any more: the contact is no mean contact.
    NoMaximum,
    /// At its place it is none: an edge of a flank touches first.
    EdgeFirst,
    /// No errors of assembly that bring it farther were found.
    NoneFound,
    /// The errors exceed what an assembly may have.
    TooLarge,
}

/// A number of the check as it is printed, to four decimals: what rounds to zero has no sign.
#[must_use]
pub fn as_printed(value: f64) -> f64 {
    // The sum makes 0 of -0.
    (1e4 * value).round() / 1e4 + 0.0
}

impl VhStop {
    /// In words.
    #[must_use]
    pub fn words(&self) -> String {
        let VhSetting { place_m, error: e } = &self.last;
        if self.last.error == AssemblyError::default() {
            return format!(
                "not reached: the mean contact of this assembly, at L {:.4} mm, h {:.4} mm, lies off the pinion's flank",
                as_printed(1e3 * place_m[0]),
                as_printed(1e3 * place_m[1])
            );
        }
        let why = match self.cause {
            VhCause::PinionEnds => "there the contact leaves the pinion's flank".to_owned(),
            VhCause::NoMaximum => "farther on the gear's lead has no maximum there".to_owned(),
            VhCause::EdgeFirst => "there an edge touches first".to_owned(),
            VhCause::NoneFound => "farther on no such errors were found".to_owned(),
            VhCause::TooLarge => format!(
                "farther on the errors exceed {MOST_SHARE} of the mean cone distance or {:.0} mrad",
                1e3 * MOST_TILT_RAD
            ),
        };
        format!(
            "not reached: the contact comes to L {:.4} mm, h {:.4} mm with E {:.4}, P {:.4}, G {:.4} mm, {:.4} mrad; {why}",
            as_printed(1e3 * place_m[0]),
            as_printed(1e3 * place_m[1]),
            as_printed(1e3 * e.offset_m),
            as_printed(1e3 * e.pinion_axial_m),
            as_printed(1e3 * e.gear_axial_m),
            as_printed(1e3 * e.shaft_angle_rad)
        )
    }
}

/// Settings that bring the mean contact to toe and heel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VhCheck {
    /// Toe and heel by E, P and G, the shaft angle kept.
    pub by_offset: [Result<VhSetting, VhStop>; 2],
    /// Toe and heel by the shaft angle, P and G, the offset kept.
    pub by_shaft_angle: [Result<VhSetting, VhStop>; 2],
}

/// The contact is brought so far from the ends of the smaller face, as a share of it.
const FROM_END: f64 = 0.25;
/// First and least part of the way from the mean contact that is made in one step.
const PARTS: [f64; 2] = [0.1, 1e-3];
/// Turn of the pinion, in pitches, to where the lead is compared.
const BESIDE: f64 = 0.05;
/// Newton steps for one part.
const MOST_STEPS: usize = 12;
/// Step of the differences: parameters, turns, and errors over the mean cone distance are of the order of one.
const STEP: f64 = 1e-6;
/// Left of the equations, whose lengths are over the mean cone distance, where they hold: 0.1 pm of 100 mm.
const CLOSE: f64 = 1e-12;
/// Errors of assembly at most, over the mean cone distance and \[rad\]: as far as scenes take axes for those of a bevel
/// pair.
const MOST_SHARE: f64 = 0.1;
const MOST_TILT_RAD: f64 = 0.05;

/// Which error of assembly is free beside P.
#[derive(Clone, Copy)]
enum Free {
    Offset,
    ShaftAngle,
}

impl PairDesign {
    /// Settings that bring the mean contact of a side to toe and heel from where it is in an assembly, at the same
    /// share of the depth; G keeps the backlash. `mean`: the mean contact in this assembly.
    #[must_use]
    pub fn vh_check(
        &self,
        blank: &PairBlank,
        pinion: FlankSide,
        (base, mean): (&AssemblyError, &Touch),
    ) -> VhCheck {
        let flanks = self.flanks(pinion);
        let other = self.teeth[0].flank(pinion.mate());
        let by = |free: Free| {
            let way = Way {
                flanks,
                blank,
                base,
                free,
                gear_axial: gear_axial_of_backlash(blank, [flanks[0], other]),
            };
            [-1.0, 1.0].map(|sign| way.go(mean, sign))
        };
        VhCheck {
            by_offset: by(Free::Offset),
            by_shaft_angle: by(Free::ShaftAngle),
        }
    }
}

/// What moves the contact.
struct Way<'a> {
    flanks: [&'a Flank; 2],
    blank: &'a PairBlank,
    base: &'a AssemblyError,
    free: Free,
    /// G by E, P and the shaft angle \[m/m, m/m, m/rad\].
    gear_axial: Vector3<f64>,
}

/// Parameters of the pinion's point, turns of pinion and gear, the free error and P over the mean cone distance (the
/// shaft angle as it is).
type Unknowns = Vector6<f64>;

impl Way<'_> {
    /// Takes the contact along the face, towards the toe (−1) or the heel (+1).
    fn go(&self, mean: &Touch, sign: f64) -> Result<VhSetting, VhStop> {
        let blank = self.blank;
        let half = blank.outer_cone_m - blank.mean_cone_m;
        let end = blank.mean_cone_m + sign * (1.0 - 2.0 * FROM_END) * half;
        let [pinion, gear] = mean.at;
        let turns = [mean.pinion_turn_rad, mean.gear_turn_rad];
        let mut x = Unknowns::new(pinion[0], pinion[1], turns[0], turns[1], 0.0, 0.0);
        let stop = |place_m: [f64; 2], x: &Unknowns, cause: VhCause| {
            let error = self.error(x);
            let last = VhSetting { place_m, error };
            Err(VhStop { last, cause })
        };
        let Some(point) = self.flanks[1].point(gear) else {
            return stop([f64::NAN; 2], &x, VhCause::PinionEnds);
        };
        let start = self.flanks[1].place(&point.r);
        // The same share of the depth, which is in proportion to the cone distance.
        let goal = [end, start[1] * end / start[0]];
        let at = |share: f64| [0, 1].map(|i| start[i] + share * (goal[i] - start[i]));
        let mut near = Located { at: gear, point };
        let (mut share, mut part, mut slope) = (0.0, PARTS[0], Unknowns::zeros());
        while share < 1.0 {
            let next = f64::min(share + part, 1.0);
            let [cone, height] = at(next);
            let guess = x + slope * (next - share);
            let place = self.flanks[1].locate_from(cone, height, &near).ok();
            let found = place.map(|place| (place, self.solve(&guess, &place)));
            match found {
                Some((place, Ok(found))) => {
                    if self.is_too_large(&found) {
                        return stop(at(share), &x, VhCause::TooLarge);
                    }
                    if !self.is_maximum(&found, &place) {
                        return stop(at(share), &x, VhCause::NoMaximum);
                    }
                    slope = (found - x) / (next - share);
                    (x, near, share) = (found, place, next);
                    part = f64::min(2.0 * part, PARTS[0]);
                }
                other => {
                    part *= 0.5;
                    if part < PARTS[1] {
                        let cause = other.map_or(VhCause::PinionEnds, |(_, found)| {
                            found.err().unwrap_or(VhCause::PinionEnds)
                        });
                        return stop(at(share), &x, cause);
                    }
                }
            }
        }
        if !self.is_on_path(&x) {
            return stop(goal, &x, VhCause::EdgeFirst);
        }
        Ok(VhSetting {
            place_m: goal,
            error: self.error(&x),
        })
    }

    /// Whether the path of contact of that assembly, which knows the edges, goes over the flanks at this turn.
    fn is_on_path(&self, x: &Unknowns) -> bool {
        let request = TcaRequest {
            error: self.base.plus(&self.error(x)),
            map: [1, 1],
            ..TcaRequest::default()
        };
        let step_rad =
            std::f64::consts::TAU / (self.blank.data.teeth[0] * request.per_pitch) as f64;
        tooth_contact(self.flanks, self.blank, &request).is_ok_and(|found| {
            let mut flanks = found.path.iter().filter(|p| p.kind == ContactKind::Flanks);
            flanks.any(|p| (p.pinion_turn_rad - x[2]).abs() <= step_rad)
        })
    }

    /// The further errors of assembly.
    fn error(&self, x: &Unknowns) -> AssemblyError {
        let size = self.blank.mean_cone_m;
        let [offset_m, shaft_angle_rad] = match self.free {
            Free::Offset => [size * x[4], 0.0],
            Free::ShaftAngle => [0.0, x[4]],
        };
        let pinion_axial_m = size * x[5];
        let moved = Vector3::new(offset_m, pinion_axial_m, shaft_angle_rad);
        AssemblyError {
            offset_m,
            pinion_axial_m,
            gear_axial_m: self.gear_axial.dot(&moved),
            shaft_angle_rad,
        }
    }

    fn is_too_large(&self, x: &Unknowns) -> bool {
        let of = self.error(x);
        let most_m = MOST_SHARE * self.blank.mean_cone_m;
        let lengths = [of.offset_m, of.pinion_axial_m, of.gear_axial_m];
        lengths.iter().any(|m| m.abs() > most_m) || of.shaft_angle_rad.abs() > MOST_TILT_RAD
    }

    /// Whether the gear leads less a little before and after.
    fn is_maximum(&self, x: &Unknowns, gear: &Located) -> bool {
        let assembly = Assembly::new(self.blank, &self.base.plus(&self.error(x)));
        let mesh = Mesh {
            flanks: self.flanks,
            assembly: &assembly,
        };
        let here = Touch {
            at: [[x[0], x[1]], gear.at],
            pinion_turn_rad: x[2],
            gear_turn_rad: x[3],
            points: [gear.point; 2],
        };
        let step_rad = BESIDE * std::f64::consts::TAU / self.blank.data.teeth[0] as f64;
        let lead = mesh.lead_rad(&here);
        [-step_rad, step_rad].into_iter().all(|step| {
            let beside = mesh.touch(x[2] + step, &here);
            beside.is_none_or(|touch| mesh.lead_rad(&touch) < lead)
        })
    }

    /// Newton's method for the contact at a point of the gear.
    fn solve(&self, start: &Unknowns, gear: &Located) -> Result<Unknowns, VhCause> {
        let ends = VhCause::PinionEnds;
        let mut x = *start;
        for _ in 0..MOST_STEPS {
            let left = self.left(&x, gear).ok_or(ends)?;
            if left.norm() < CLOSE {
                let pinion = self.flanks[0].point([x[0], x[1]]).ok_or(ends)?;
                return if self.flanks[0].holds(&pinion) {
                    Ok(x)
                } else {
                    Err(ends)
                };
            }
            let mut slopes = Matrix6::zeros();
            for i in 0..6 {
                let mut beside = x;
                beside[i] += STEP;
                let moved = self.left(&beside, gear).ok_or(ends)?;
                slopes.set_column(i, &((moved - left) / STEP));
            }
            x -= slopes.lu().solve(&left).ok_or(VhCause::NoneFound)?;
        }
        Err(VhCause::NoneFound)
    }

    /// What is left of r₁ = r₂, n₁ + n₂ = 0 and n·v₁₂ = 0 at constant ratio; none where the pinion has no surface.
    fn left(&self, x: &Unknowns, gear: &Located) -> Option<Vector6<f64>> {
        let assembly = Assembly::new(self.blank, &self.base.plus(&self.error(x)));
        let [m1, m2] = &assembly.members;
        let own = self.flanks[0].point([x[0], x[1]])?;
        let points = [m1.placed(&own, x[2]), m2.placed(&gear.point, x[3])];
        let gap = (points[0].r - points[1].r) / self.blank.mean_cone_m;
        let [t, u] = points[1].tangents(&points[1].dr[0]);
        let normals = points[0].n + points[1].n;
        let mesh = Mesh {
            flanks: self.flanks,
            assembly: &assembly,
        };
        let slip = mesh.slip(&points[1]);
        Some(Vector6::new(
            gap.x,
            gap.y,
            gap.z,
            t.dot(&normals),
            u.dot(&normals),
            slip,
        ))
    }
}

/// The gear's place G that keeps the backlash beside E, P and the shaft angle, per unit of each: with the inward
/// normals n and n′ of both flanks of the pinion's tooth at its mean point, (n + n′)·u = 0, u the move of the pinion
/// against the gear there.
fn gear_axial_of_backlash(blank: &PairBlank, pinion: [&Flank; 2]) -> Vector3<f64> {
    let assembly = Assembly::new(blank, &AssemblyError::default());
    let [k1, k2] = assembly.members.map(|m| m.axis());
    let sum = pinion[0].mean().point.n + pinion[1].mean().point.n;
    let r = pinion[0].mean().point.r;
    let y = Vector3::y();
    Vector3::new(sum.dot(&y), sum.dot(&k1), -sum.dot(&y.cross(&r))) / sum.dot(&k2)
}
