//! Where the inner ring of a bearing comes to rest under a load.

use nalgebra::{Matrix5, Vector5};

use crate::element_place::ElementPlaces;
use crate::error::BearingError;
use crate::operation::Operation;
use crate::quasi_static::{QuasiStaticBearing, Row};
use crate::ring_load::RingLoad;
use crate::ring_pose::RingPose;

/// What is stated of the ring's tilt.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TiltCondition {
    /// Moments about x and y \[N·m\].
    Moments([f64; 2]),
    /// Tilt θx, θy \[rad\].
    Held([f64; 2]),
}

/// A load on the inner ring.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AppliedBearingLoad {
    /// Force x, y, z \[N\].
    pub force_n: [f64; 3],
    /// Moments, or the tilt itself.
    pub tilt: TiltCondition,
}

/// Most steps of Newton's method for the ring.
const MOST_STEPS: usize = 200;

/// Most proximal steps down the potential energy.
const MOST_PROXIMAL_STEPS: usize = 200;

/// Most places on the way down the potential energy at which a ball or barrel finds no equilibrium: twice as many as
/// any bearing of the tests meets that comes to rest.
const MOST_LOST_BALLS: usize = 600;

/// The same of rollers: bearings that come to rest meet none, and each is a long search.
const MOST_LOST_ROLLERS: usize = 60;

/// A ring that has come this share of the pitch radius from its start is on its way out: no play is so large.
const FARTHEST: f64 = 0.1;

/// Where a spring half as stiff lets the ring go farther by more than this factor (twice as far where nothing takes up
/// the load), so often one after the other, the ring slides.
const SLIDES: (f64, usize) = (1.7, 3);

/// Springs that hold the ring to a place; about x and y by the pitch radius' square.
pub(crate) struct Anchor {
    at: Vector5<f64>,
    spring_n_per_m: f64,
}

impl QuasiStaticBearing {
    /// Where the inner ring comes to rest under a load.
    ///
    /// Newton's method with the exact tangent; steps that do not lessen the unbalanced load are turned towards it
    /// (Levenberg and Marquardt). At speed the place at rest is the start, and balls stay between both grooves as long
    /// as an equilibrium with them is found as the speed rises. Self-aligning bearings resist no tilt: they are held
    /// without one where none is stated.
    ///
    /// # Errors
    /// [`BearingError`] where there is none, or a cylindrical roller bearing is loaded along its axis.
    pub fn equilibrium(
        &self,
        load: &AppliedBearingLoad,
        operation: &Operation,
    ) -> Result<RingPose, BearingError> {
        Ok(self.equilibrium_with_places(load, operation)?.0)
    }

    /// As [`Self::equilibrium`], with the places of its elements: balls with two equilibria are evaluated from them
    /// ([`Self::loads_from`]).
    ///
    /// # Errors
    /// As [`Self::equilibrium`].
    pub fn equilibrium_with_places(
        &self,
        load: &AppliedBearingLoad,
        operation: &Operation,
    ) -> Result<(RingPose, ElementPlaces), BearingError> {
        let held = AppliedBearingLoad {
            tilt: TiltCondition::Held([0.0; 2]),
            ..*load
        };
        let load = match load.tilt {
            TiltCondition::Moments([x, y]) if self.aligns() => {
                if x != 0.0 || y != 0.0 {
                    return Err(BearingError::NotCarried(
                        "a spherical roller bearing tilts freely and carries no moment; remove it, or state the tilt",
                    ));
                }
                &held
            }
            _ => load,
        };
        if !self.locates && load.force_n[2] != 0.0 {
            return Err(BearingError::NotCarried(
                "the load has an axial part, which cylindrical rollers do not carry in this model; set it to 0, another bearing carries it",
            ));
        }
        let resting = operation.at_rest();
        let start = self.first_guess(load);
        let pose = match self.iterate(start, load, &resting, (None, None, &mut 0)) {
            Ok(found) => found,
            Err(error) => self
                .settle(start, load, &resting, (error, None))
                .or_else(|error| self.tilt_up(load, &resting, error))?,
        };
        if operation.is_turning() {
            return self.speed_up(pose, load, operation);
        }
        Ok((pose, ElementPlaces::unknown(&self.rows)))
    }

    /// To rest down the potential energy, where Newton's method alone stays behind an edge of it.
    ///
    /// One proximal step after the other: each ends where the ring would rest if springs held it to where it stood.
    /// Energy falls in every step, and springs are softened as long as the search within a step succeeds. Newton's
    /// method without springs ends it; it is not tried while the ring slides. A ring that slides out of the bearing
    /// ends the search, and so do elements that find no place too often. `failure` is what the search without springs
    /// ended with; elements begin at their `places`, if given, and leave them where they end.
    pub(crate) fn settle(
        &self,
        start: RingPose,
        load: &AppliedBearingLoad,
        operation: &Operation,
        (failure, mut places): (BearingError, Option<&mut ElementPlaces>),
    ) -> Result<RingPose, BearingError> {
        let [x, y, z] = load.force_n;
        let moments = match load.tilt {
            TiltCondition::Moments([x, y]) => x.hypot(y),
            TiltCondition::Held(_) => 0.0,
        };
        let size = x.hypot(y).hypot(z) + moments / self.rows[0].pitch_radius_m();
        if size == 0.0 {
            return Err(failure);
        }
        let most_lost = match self.rows[0] {
            Row::Ball(_) | Row::FourPoint(_) | Row::Barrel(_) => MOST_LOST_BALLS,
            Row::Roller(_) => MOST_LOST_ROLLERS,
        };
        let farthest_m = FARTHEST * self.rows[0].pitch_radius_m();
        let mut pose = start;
        // So stiff that the load moves the ring by a micrometre.
        let mut spring = size / 1e-6;
        let (mut last_m, mut slides, mut lost) = (f64::INFINITY, 0, 0);
        for _ in 0..MOST_PROXIMAL_STEPS {
            let anchor = Anchor {
                at: pose.to_five(),
                spring_n_per_m: spring,
            };
            let mut tried = places.as_deref().cloned();
            match self.iterate(
                pose,
                load,
                operation,
                (Some(&anchor), tried.as_mut(), &mut lost),
            ) {
                Ok(next) => {
                    let moved_m = (next.centre_m - pose.centre_m).norm();
                    let goes_on = moved_m > SLIDES.0 * last_m;
                    slides = if goes_on { slides + 1 } else { 0 };
                    last_m = moved_m;
                    pose = next;
                    spring *= 0.5;
                    if (pose.centre_m - start.centre_m).norm() > farthest_m {
                        break;
                    }
                    let mut ends = tried.clone();
                    let found = if slides < SLIDES.1 {
                        self.iterate(pose, load, operation, (None, ends.as_mut(), &mut lost))
                    } else {
                        Err(failure.clone())
                    };
                    let kept = if found.is_ok() { &ends } else { &tried };
                    if let (Some(places), Some(kept)) = (&mut places, kept) {
                        places.take_from(kept);
                    }
                    if found.is_ok() {
                        return found;
                    }
                }
                Err(_) => spring *= 10.0,
            }
            if spring > size / 1e-12 || lost > most_lost {
                break;
            }
        }
        Err(failure)
    }

    /// Moved towards the load, through the clearance.
    pub(crate) fn first_guess(&self, load: &AppliedBearingLoad) -> RingPose {
        let [x, y, z] = load.force_n;
        let mut q = Vector5::zeros();
        if let TiltCondition::Held(tilt) = load.tilt {
            (q[3], q[4]) = (tilt[0], tilt[1]);
        }
        let operation = Operation::default();
        // As far along the load as it takes to meet it.
        let across = x.hypot(y);
        let size = across.hypot(z);
        if size == 0.0 {
            return RingPose::from_five(&q);
        }
        let direction = Vector5::new(x / size, y / size, z / size, 0.0, 0.0);
        let mut reach = 1e-6;
        while reach < 1e-3 {
            let pose = RingPose::from_five(&(q + direction * reach));
            let Ok(ring) = self.evaluate(&pose, &operation) else {
                break;
            };
            if -ring.five().dot(&direction) >= size {
                break;
            }
            reach *= 1.5;
        }
        RingPose::from_five(&(q + direction * reach))
    }

    pub(crate) fn iterate(
        &self,
        start: RingPose,
        load: &AppliedBearingLoad,
        operation: &Operation,
        (anchor, places, lost): (Option<&Anchor>, Option<&mut ElementPlaces>, &mut usize),
    ) -> Result<RingPose, BearingError> {
        let balance = RingBalance::of(self, load, anchor);
        let mut pose = start;
        // Without places every search of an element begins from the ring's place alone.
        let mut known = places;
        let unknown = ElementPlaces::unknown(&self.rows);
        let evaluate = |pose: &RingPose, known: &Option<&mut ElementPlaces>| {
            let mut places = known.as_deref().unwrap_or(&unknown).clone();
            let ring = self.evaluate_from(pose, operation, &mut places)?;
            Ok::<_, BearingError>((ring, places))
        };
        let (mut ring, found) = evaluate(&pose, &known)?;
        if let Some(known) = &mut known {
            known.take_from(&found);
        }
        let mut r = balance.residual(&pose, &ring);
        let mut lift = 0.0_f64;
        let mut rounding_n = 0.0;
        for iteration in 0..MOST_STEPS {
            let size = r.norm();
            let within = balance.size_n(&ring);
            if size <= 1e-13 * within {
                return Ok(pose);
            }
            let (matrix, stiffest) = balance.matrix(&ring, lift);
            // What a change of the last digit of an element's place does.
            rounding_n = 4.0 * f64::EPSILON * balance.arm_m * stiffest;
            let Some(step) = matrix.lu().solve(&r) else {
                lift = (10.0 * lift).max(1e-6);
                continue;
            };
            let length = step.norm();
            // Finer than the places of the elements can be resolved: what is unbalanced then decides.
            if length <= 1e-16 * balance.arm_m {
                break;
            }
            let factor = (100e-6 / length).min(1.0);
            let next = pose.moved(&(step * factor).component_div(&balance.scale));
            let found = evaluate(&next, &known);
            *lost += usize::from(found.is_err());
            match found {
                Ok((found, places)) if balance.residual(&next, &found).norm() < size => {
                    (pose, ring) = (next, found);
                    if let Some(known) = &mut known {
                        known.take_from(&places);
                    }
                    r = balance.residual(&pose, &ring);
                    lift = if lift < 1e-9 { 0.0 } else { 0.1 * lift };
                }
                _ => {
                    if size <= 1e-9 * within && lift > 1e-4 {
                        return Ok(pose);
                    }
                    lift = (10.0 * lift).max(1e-8);
                    if lift > 1e12 || iteration + 1 == MOST_STEPS {
                        break;
                    }
                }
            }
        }
        let within = balance.size_n(&ring);
        if r.norm() <= (1e-9 * within).max(rounding_n) {
            return Ok(pose);
        }
        Err(BearingError::NoEquilibrium {
            unbalanced_n: r.norm(),
            iterations: MOST_STEPS,
            hint: hint(&balance.applied, balance.arm_m, operation),
        })
    }
}

/// The equations of a ring: what is applied, what holds it, and in which of its five directions it is free.
struct RingBalance<'a> {
    anchor: Option<&'a Anchor>,
    /// Pitch radius, by which moments are measured as forces.
    arm_m: f64,
    scale: Vector5<f64>,
    applied: Vector5<f64>,
    free: [bool; 5],
}

impl<'a> RingBalance<'a> {
    fn of(
        bearing: &QuasiStaticBearing,
        load: &AppliedBearingLoad,
        anchor: Option<&'a Anchor>,
    ) -> Self {
        let arm_m = bearing.rows[0].pitch_radius_m();
        let [x, y, z] = load.force_n;
        let (moments, tilts) = match load.tilt {
            TiltCondition::Moments(m) => (m, true),
            TiltCondition::Held(_) => ([0.0; 2], false),
        };
        Self {
            anchor,
            arm_m,
            scale: Vector5::new(1.0, 1.0, 1.0, arm_m, arm_m),
            applied: Vector5::new(x, y, z, moments[0], moments[1]),
            free: [true, true, bearing.locates, tilts, tilts],
        }
    }

    /// What is unbalanced: forces, with moments over the pitch radius.
    fn residual(&self, pose: &RingPose, ring: &RingLoad) -> Vector5<f64> {
        let mut r = (ring.five() + self.applied).component_div(&self.scale);
        if let Some(anchor) = self.anchor {
            r -= (pose.to_five() - anchor.at).component_mul(&self.scale) * anchor.spring_n_per_m;
        }
        for (entry, free) in r.iter_mut().zip(self.free) {
            if !free {
                *entry = 0.0;
            }
        }
        r
    }

    /// The larger of what is applied and what the bearing answers.
    fn size_n(&self, ring: &RingLoad) -> f64 {
        let applied = self.applied.component_div(&self.scale).norm().max(1e-9);
        ring.five().component_div(&self.scale).norm().max(applied)
    }

    /// The tangent with springs, directions that are not free held, lifted by a share of its stiffest entry; and that
    /// entry.
    fn matrix(&self, ring: &RingLoad, lift: f64) -> (Matrix5<f64>, f64) {
        let mut matrix: Matrix5<f64> = -ring.tangent.fixed_view::<5, 5>(0, 0).into_owned();
        for i in 0..5 {
            for j in 0..5 {
                matrix[(i, j)] /= self.scale[i] * self.scale[j];
            }
        }
        let mut stiffest = 1e3_f64;
        for i in 0..5 {
            matrix[(i, i)] += self.anchor.map_or(0.0, |anchor| anchor.spring_n_per_m);
            stiffest = stiffest.max(matrix[(i, i)].abs());
        }
        for (i, is_free) in self.free.iter().enumerate() {
            if !is_free {
                for j in 0..5 {
                    matrix[(i, j)] = 0.0;
                    matrix[(j, i)] = 0.0;
                }
                matrix[(i, i)] = stiffest;
            }
            matrix[(i, i)] += (lift + 1e-14) * stiffest;
        }
        (matrix, stiffest)
    }
}

/// Load \[N\] below which what rounding leaves of the elements' places may be more.
const SMALL_LOAD_N: f64 = 1e-3;

/// What to do about a load without equilibrium.
fn hint(applied: &Vector5<f64>, arm_m: f64, operation: &Operation) -> &'static str {
    let size = applied.fixed_rows::<3>(0).norm() + applied.fixed_rows::<2>(3).norm() / arm_m;
    if size < SMALL_LOAD_N {
        return "So small a load is lost in the rounding of the elements' places: give 0 or at least 0.001 N.";
    }
    if operation.is_turning() {
        return "Without speed there is one: the speed is beyond what the bearing can do; take less of it, or give more thrust.";
    }
    "A single row that carries axial loads one way needs an axial load towards +z, a preload or a second row; a moment needs something that resists it."
}
