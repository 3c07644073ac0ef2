//! V/H check: the errors of assembly that bring the contact to toe and heel, as a testing machine is set. Derivation:
//! docs/theory/bevel_gears.md, "V/H check".

use nalgebra::{Matrix2, Vector2, Vector3};

use crate::assembly::{Assembly, AssemblyError};
use crate::blank::PairBlank;
use crate::contact_path::first_touch;
use crate::contact_point::Touch;
use crate::error::BevelError;
use crate::flank::Flank;
use crate::hand::FlankSide;
use crate::pair_design::PairDesign;
use crate::tca::mean_place_m;

/// Settings of the testing machine for one place of the contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VhSetting {
    /// L and h of the mean contact on the gear \[m\].
    pub place_m: [f64; 2],
    /// Offset E (V), pinion's place P (H), gear's place G and shaft angle, beside those of the assembly.
    pub error: AssemblyError,
}

/// Settings that bring the mean contact to toe and heel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VhCheck {
    /// Toe and heel by E, P and G, the shaft angle kept.
    pub by_offset: [VhSetting; 2],
    /// Toe and heel by the shaft angle, P and G, the offset kept; none where no such setting is found.
    pub by_shaft_angle: Option<[VhSetting; 2]>,
}

/// The contact is brought so far from the ends of the smaller face, as a share of it.
const FROM_END: f64 = 0.25;
/// Parts of the way from the mean contact.
const PARTS: usize = 10;
/// Newton steps for one part.
const MOST_STEPS: usize = 12;
/// Steps of the differences \[m\]; of the angle over the mean cone distance.
const STEP_M: f64 = 1e-7;
/// A place is met within this \[m\].
const CLOSE_M: f64 = 1e-9;

/// Which error of assembly is free beside P.
#[derive(Clone, Copy)]
enum Free {
    Offset,
    ShaftAngle,
}

impl PairDesign {
    /// Settings that bring the mean contact of a side to toe and heel from where it is in an assembly, at the same
    /// share of the depth; G keeps the backlash.
    ///
    /// # Errors
    /// [`BevelError::NoContact`] where the flanks have no contact at constant ratio, or none of these places is
    /// reached.
    pub fn vh_check(
        &self,
        blank: &PairBlank,
        pinion: FlankSide,
        base: &AssemblyError,
    ) -> Result<VhCheck, BevelError> {
        let flanks = self.flanks(pinion);
        let gear_axial =
            gear_axial_of_backlash(blank, [flanks[0], self.teeth[0].flank(pinion.mate())]);
        let (_, first) = first_touch(flanks, blank, base)?;
        let (first, start) = mean_place_m(flanks, blank, base, &first)?;
        let half = blank.outer_cone_m - blank.mean_cone_m;
        let to = |free: Free, sign: f64| -> Result<VhSetting, BevelError> {
            let end = blank.mean_cone_m + sign * (1.0 - 2.0 * FROM_END) * half;
            let error = |x: Vector2<f64>| {
                let mut by = AssemblyError {
                    pinion_axial_m: x[1],
                    ..AssemblyError::default()
                };
                match free {
                    Free::Offset => by.offset_m = x[0],
                    Free::ShaftAngle => by.shaft_angle_rad = x[0] / blank.mean_cone_m,
                }
                by.gear_axial_m = gear_axial(&by);
                by
            };
            // Contacts move by tens of millimetres for each of an error: each is sought from the last one.
            let at = |x: Vector2<f64>, near: &Touch| -> Result<(Touch, Vector2<f64>), BevelError> {
                let (touch, place) = mean_place_m(flanks, blank, &base.plus(&error(x)), near)?;
                Ok((touch, place.into()))
            };
            let begin = Vector2::from(start);
            // The same share of the depth, which is in proportion to the cone distance.
            let goal = Vector2::new(end, start[1] * end / start[0]);
            let mut x = Vector2::zeros();
            let (mut near, mut here) = (first, begin);
            for part in 1..=PARTS {
                let target = begin + (goal - begin) * (part as f64 / PARTS as f64);
                for _ in 0..MOST_STEPS {
                    if (here - target).norm() < CLOSE_M {
                        break;
                    }
                    let mut slopes = Matrix2::zeros();
                    for i in 0..2 {
                        let mut step = Vector2::zeros();
                        step[i] = STEP_M;
                        let ends = [at(x + step, &near)?.1, at(x - step, &near)?.1];
                        slopes.set_column(i, &((ends[0] - ends[1]) / (2.0 * STEP_M)));
                    }
                    x -= slopes.lu().solve(&(here - target)).ok_or_else(unreached)?;
                    (near, here) = at(x, &near)?;
                }
                if (here - target).norm() > 100.0 * CLOSE_M {
                    return Err(unreached());
                }
            }
            Ok(VhSetting {
                place_m: here.into(),
                error: error(x),
            })
        };
        let both = |free: Free| Ok::<_, BevelError>([to(free, -1.0)?, to(free, 1.0)?]);
        Ok(VhCheck {
            by_offset: both(Free::Offset)?,
            by_shaft_angle: both(Free::ShaftAngle).ok(),
        })
    }
}

fn unreached() -> BevelError {
    BevelError::NoContact {
        hint: "no errors of assembly were found that bring the contact to toe and heel",
    }
}

/// The gear's place G that keeps the backlash beside other errors: with the inward normals n and n′ of both flanks of
/// the pinion's tooth at its mean point, (n + n′)·u = 0, u the move of the pinion against the gear there.
fn gear_axial_of_backlash(
    blank: &PairBlank,
    pinion: [&Flank; 2],
) -> impl Fn(&AssemblyError) -> f64 {
    let assembly = Assembly::new(blank, &AssemblyError::default());
    let [k1, k2] = assembly.members.map(|m| m.axis());
    let sum = pinion[0].mean().point.n + pinion[1].mean().point.n;
    let r = pinion[0].mean().point.r;
    let y = Vector3::y();
    move |by: &AssemblyError| {
        let u = y * by.offset_m + k1 * by.pinion_axial_m - y.cross(&r) * by.shaft_angle_rad;
        sum.dot(&u) / sum.dot(&k2)
    }
}
