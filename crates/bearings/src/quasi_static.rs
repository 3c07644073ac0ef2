//! A bearing whose balls or rollers are in equilibrium at every place of the inner ring.

use nalgebra::{Vector3, Vector5};

use crate::ball_row::BallRow;
use crate::build_rows;
use crate::definition::{BearingDefinition, Preload};
use crate::element_load::ElementLoad;
use crate::error::BearingError;
use crate::operation::Operation;
use crate::point_contact::ContactEllipse;
use crate::ring_load::RingLoad;
use crate::ring_pose::RingPose;
use crate::roller_row::RollerRow;

/// A row.
#[derive(Debug, Clone, PartialEq)]
pub enum Row {
    /// Of balls.
    Ball(BallRow),
    /// Of rollers.
    Roller(RollerRow),
}

impl Row {
    /// Number of balls or rollers.
    #[must_use]
    pub fn elements(&self) -> usize {
        match self {
            Self::Ball(row) => row.balls,
            Self::Roller(row) => row.rollers,
        }
    }

    /// d_m/2 \[m\].
    #[must_use]
    pub fn pitch_radius_m(&self) -> f64 {
        match self {
            Self::Ball(row) => row.pitch_radius_m,
            Self::Roller(row) => row.pitch_radius_m,
        }
    }

    /// Contact ellipses of a ball at the inner and outer race; none for rollers.
    #[must_use]
    pub fn ellipses(&self, load: &ElementLoad) -> [Option<ContactEllipse>; 2] {
        match self {
            Self::Ball(row) => [
                Some(row.inner.contact.ellipse(load.inner_load_n)),
                Some(row.outer.contact.ellipse(load.outer_load_n)),
            ],
            Self::Roller(_) => [None; 2],
        }
    }

    /// Peak pressures at the inner and outer race under an element's load \[Pa\]; of rollers those of the lamina that bears most.
    #[must_use]
    pub fn peak_pressures_pa(&self, load: &ElementLoad) -> [f64; 2] {
        match self {
            Self::Ball(row) => [
                row.inner
                    .contact
                    .ellipse(load.inner_load_n)
                    .peak_pressure_pa,
                row.outer
                    .contact
                    .ellipse(load.outer_load_n)
                    .peak_pressure_pa,
            ],
            Self::Roller(row) => [
                row.inner
                    .contact
                    .peak_pressure_pa(load.inner_line_load_n_per_m),
                row.outer
                    .contact
                    .peak_pressure_pa(load.outer_line_load_n_per_m),
            ],
        }
    }

    fn add(
        &self,
        pose: &RingPose,
        operation: &Operation,
        ring: &mut RingLoad,
        each: impl FnMut(ElementLoad),
        each_lamina: impl FnMut(f64, f64),
    ) -> Result<(), BearingError> {
        match self {
            Self::Ball(row) => row.add(pose, operation, ring, each),
            Self::Roller(row) => row.add(pose, operation, ring, each, each_lamina),
        }
    }

    /// Moves the race of the inner ring along the ring's axis.
    fn shift_inner(&mut self, shift_m: f64) {
        match self {
            Self::Ball(row) => row.inner.centre_z_m += shift_m,
            Self::Roller(row) => {
                row.inner.offset_m += row.inner.normal.1 * shift_m;
                if let Some(rib) = &mut row.rib {
                    rib.offset_m += rib.normal.1 * shift_m;
                }
            }
        }
    }
}

/// Loads of all elements of a bearing, row after row.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RowLoads {
    /// Balls or rollers of one row after the other.
    pub elements: Vec<Vec<ElementLoad>>,
    /// For rollers the loads of their laminae at the inner and outer race \[N\], roller after roller; empty for balls.
    pub laminae: Vec<Vec<(f64, f64)>>,
}

/// A bearing ready to be evaluated.
#[derive(Debug, Clone, PartialEq)]
pub struct QuasiStaticBearing {
    /// Its rows.
    pub rows: Vec<Row>,
    /// How far each row's inner ring is pressed in \[m\].
    pub preload_m: f64,
    /// Whether it resists along its axis.
    pub locates: bool,
}

impl QuasiStaticBearing {
    /// From a definition.
    ///
    /// # Errors
    /// [`BearingError`] where a preload finds no equilibrium.
    pub fn new(definition: &BearingDefinition) -> Result<Self, BearingError> {
        let mut rows = build_rows::rows(definition);
        let locates = match &rows[0] {
            Row::Ball(_) => true,
            Row::Roller(row) => row.rib.is_some(),
        };
        let preload_m = match definition.preload {
            Preload::None => 0.0,
            Preload::Displacement(m) => m,
            Preload::Force(force_n) => shift_under_force(&rows[0], definition, force_n)?,
        };
        let senses = definition.arrangement.rows();
        for (row, (_, sense)) in rows.iter_mut().zip(senses) {
            row.shift_inner(sense * preload_m);
        }
        Ok(Self {
            rows,
            preload_m,
            locates,
        })
    }

    /// Load on the inner ring by its rolling elements, and its tangent.
    ///
    /// # Errors
    /// [`BearingError`] where an element finds no equilibrium.
    pub fn evaluate(
        &self,
        pose: &RingPose,
        operation: &Operation,
    ) -> Result<RingLoad, BearingError> {
        let mut ring = RingLoad::default();
        for row in &self.rows {
            row.add(pose, operation, &mut ring, |_| {}, |_, _| {})?;
        }
        Ok(ring)
    }

    /// As [`Self::evaluate`], with the load of every element.
    ///
    /// # Errors
    /// As [`Self::evaluate`].
    pub fn loads(
        &self,
        pose: &RingPose,
        operation: &Operation,
    ) -> Result<(RingLoad, RowLoads), BearingError> {
        let mut ring = RingLoad::default();
        let mut all = RowLoads::default();
        for row in &self.rows {
            let (mut elements, mut laminae) = (Vec::new(), Vec::new());
            let each = |element| elements.push(element);
            let each_lamina = |inner, outer| laminae.push((inner, outer));
            row.add(pose, operation, &mut ring, each, each_lamina)?;
            all.elements.push(elements);
            all.laminae.push(laminae);
        }
        Ok((ring, all))
    }
}

/// How far the inner ring of a row moves along the axis under an axial force, at rest.
fn shift_under_force(
    row: &Row,
    definition: &BearingDefinition,
    force_n: f64,
) -> Result<f64, BearingError> {
    let (_, sense) = definition.arrangement.rows()[0];
    let operation = Operation::default();
    let axial = |shift_m: f64| {
        let pose = RingPose {
            centre_m: Vector3::new(0.0, 0.0, sense * shift_m),
            axis: Vector3::z(),
        };
        let mut ring = RingLoad::default();
        row.add(&pose, &operation, &mut ring, |_| {}, |_, _| {})?;
        Ok::<_, BearingError>(-sense * ring.load[2])
    };
    let (mut low, mut high) = (0.0, 1e-6);
    while axial(high)? < force_n {
        low = high;
        high *= 2.0;
        if high > 0.1 * row.pitch_radius_m() {
            return Err(BearingError::NoEquilibrium {
                unbalanced_n: force_n,
                iterations: 0,
                hint: "The preload is more than the races can bear.",
            });
        }
    }
    // Bisection to the last bit: done once.
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if axial(middle)? < force_n {
            low = middle;
        } else {
            high = middle;
        }
    }
    Ok(0.5 * (low + high))
}

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

impl QuasiStaticBearing {
    /// Where the inner ring comes to rest under a load.
    ///
    /// Newton's method with the exact tangent; steps that do not lessen the unbalanced load are turned towards it (Levenberg and
    /// Marquardt). At speed the loads of the rest position are the start.
    ///
    /// # Errors
    /// [`BearingError`] where there is none, or a cylindrical roller bearing is loaded along its axis.
    pub fn equilibrium(
        &self,
        load: &AppliedBearingLoad,
        operation: &Operation,
    ) -> Result<RingPose, BearingError> {
        if !self.locates && load.force_n[2] != 0.0 {
            return Err(BearingError::NotCarried(
                "the load has an axial part, which cylindrical rollers do not bear in this model; set it to 0, another bearing bears it",
            ));
        }
        let resting = Operation {
            inner_rad_per_s: 0.0,
            outer_rad_per_s: 0.0,
            ..*operation
        };
        let start = self.first_guess(load);
        let mut pose = self.iterate(start, load, &resting)?;
        if operation.is_turning() {
            pose = self.speed_up(pose, load, operation)?;
        }
        self.refuse_pulled_out(&pose, operation)?;
        Ok(pose)
    }

    /// Angular-contact bearings have no groove on the side away from their load: balls that climb there have left the bearing.
    fn refuse_pulled_out(
        &self,
        pose: &RingPose,
        operation: &Operation,
    ) -> Result<(), BearingError> {
        let (_, loads) = self.loads(pose, operation)?;
        for (row, elements) in self.rows.iter().zip(&loads.elements) {
            let Row::Ball(row) = row else { continue };
            let free = row.free_angle_rad;
            let climbs = |e: &ElementLoad| {
                e.inner_load_n > 0.0
                    && e.inner_contact_angle_rad * free.signum() < -0.5 * free.abs()
            };
            if free != 0.0 && elements.iter().any(climbs) {
                return Err(BearingError::PulledOut);
            }
        }
        Ok(())
    }

    /// From rest to speed, in shorter steps of the square of the speed where a step fails.
    fn speed_up(
        &self,
        mut pose: RingPose,
        load: &AppliedBearingLoad,
        operation: &Operation,
    ) -> Result<RingPose, BearingError> {
        let (mut done, mut step) = (0.0_f64, 1.0_f64);
        loop {
            let next = (done + step).min(1.0);
            let part = Operation {
                inner_rad_per_s: operation.inner_rad_per_s * next.sqrt(),
                outer_rad_per_s: operation.outer_rad_per_s * next.sqrt(),
                ..*operation
            };
            match self.iterate(pose, load, &part) {
                Ok(found) => {
                    (pose, done) = (found, next);
                    if done >= 1.0 {
                        return Ok(pose);
                    }
                    step *= 2.0;
                }
                Err(error) => {
                    step *= 0.25;
                    if step < 1e-4 {
                        return Err(error);
                    }
                }
            }
        }
    }

    /// Moved towards the load, through the clearance.
    fn first_guess(&self, load: &AppliedBearingLoad) -> RingPose {
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

    fn iterate(
        &self,
        start: RingPose,
        load: &AppliedBearingLoad,
        operation: &Operation,
    ) -> Result<RingPose, BearingError> {
        let arm = self.rows[0].pitch_radius_m();
        let scale = Vector5::new(1.0, 1.0, 1.0, arm, arm);
        let [x, y, z] = load.force_n;
        let (moments, held) = match load.tilt {
            TiltCondition::Moments(m) => (m, false),
            TiltCondition::Held(_) => ([0.0; 2], true),
        };
        let applied = Vector5::new(x, y, z, moments[0], moments[1]);
        let mut free = [true; 5];
        free[2] = self.locates;
        (free[3], free[4]) = (!held, !held);
        // Forces, with moments over the pitch radius.
        let residual = |ring: &RingLoad| {
            let mut r = (ring.five() + applied).component_div(&scale);
            for (entry, free) in r.iter_mut().zip(free) {
                if !free {
                    *entry = 0.0;
                }
            }
            r
        };
        let mut pose = start;
        let mut ring = self.evaluate(&pose, operation)?;
        let mut r = residual(&ring);
        let mut lift = 0.0_f64;
        let bearing_size = applied.component_div(&scale).norm().max(1e-9);
        for iteration in 0..MOST_STEPS {
            let size = r.norm();
            let within = ring.five().component_div(&scale).norm().max(bearing_size);
            if size <= 1e-13 * within {
                return Ok(pose);
            }
            let mut matrix = -ring.tangent.fixed_view::<5, 5>(0, 0).into_owned();
            for i in 0..5 {
                for j in 0..5 {
                    matrix[(i, j)] /= scale[i] * scale[j];
                }
            }
            let mut stiffest = 1e3_f64;
            for i in 0..5 {
                stiffest = stiffest.max(matrix[(i, i)].abs());
            }
            for (i, is_free) in free.iter().enumerate() {
                if !is_free {
                    for j in 0..5 {
                        matrix[(i, j)] = 0.0;
                        matrix[(j, i)] = 0.0;
                    }
                    matrix[(i, i)] = stiffest;
                }
                matrix[(i, i)] += (lift + 1e-14) * stiffest;
            }
            let Some(step) = matrix.lu().solve(&r) else {
                lift = (10.0 * lift).max(1e-6);
                continue;
            };
            let length = step.norm();
            if length <= 1e-16 * arm {
                return Ok(pose);
            }
            let factor = (100e-6 / length).min(1.0);
            let next = pose.moved(&(step * factor).component_div(&scale));
            let found = self.evaluate(&next, operation);
            match found {
                Ok(found) if residual(&found).norm() < size => {
                    (pose, ring) = (next, found);
                    r = residual(&ring);
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
        let within = ring.five().component_div(&scale).norm().max(bearing_size);
        if r.norm() <= 1e-9 * within {
            return Ok(pose);
        }
        Err(BearingError::NoEquilibrium {
            unbalanced_n: r.norm(),
            iterations: MOST_STEPS,
            hint: "A single row that bears axial loads one way needs an axial load towards +z, a preload or a second row; a moment needs \
                   something that resists it.",
        })
    }
}
