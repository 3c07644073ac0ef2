//! A bearing whose balls or rollers are in equilibrium at every place of the inner ring.

use gearmesh_dynamics::{Marker, MarkerPair};
use nalgebra::Vector3;

use crate::bent_race::{BentRace, BentRow};
use crate::build_rows;
use crate::definition::{BearingDefinition, Preload};
use crate::element_load::ElementLoad;
use crate::element_place::ElementPlaces;
use crate::element_search::ElementPlace;
use crate::error::BearingError;
use crate::faults::missing_element::missing;
use crate::faults::{Fault, MisalignedRing, RowFaults, Side};
use crate::operation::Operation;
use crate::ring_load::RingLoad;
use crate::ring_pose::RingPose;
use crate::roller_row::RollerRow;

pub use crate::row::Row;

impl Row {
    fn add(
        &self,
        pose: &RingPose,
        operation: &Operation,
        places: &mut [ElementPlace],
        (ring, bent): (&mut RingLoad, BentRow<'_>),
        each: impl FnMut(ElementLoad),
        each_lamina: impl FnMut(f64, f64),
    ) -> Result<(), BearingError> {
        match self {
            Self::Ball(row) => row.add(pose, operation, places, ring, each),
            Self::FourPoint(row) => row.add(pose, operation, places, ring, each),
            Self::Roller(row) => row.add(pose, operation, places, (ring, bent), each, each_lamina),
            Self::Barrel(row) => row.add(pose, operation, places, ring, each, each_lamina),
        }
    }

    /// Moves the race of the inner ring along the ring's axis.
    fn shift_inner(&mut self, shift_m: f64) {
        match self {
            Self::Ball(row) => row.inner.centre_z_m += shift_m,
            Self::FourPoint(row) => {
                for arc in &mut row.inner {
                    arc.groove.centre_z_m += shift_m;
                }
            }
            // Both rows of barrels share one sphere: nothing presses them against each other.
            Self::Barrel(_) => {}
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
    /// How the outer and the inner ring stand on their seats; none: straight. Poses here are those of the rings
    /// themselves.
    pub misaligned: [Option<MisalignedRing>; 2],
}

impl QuasiStaticBearing {
    /// From a definition.
    ///
    /// # Errors
    /// [`BearingError`] where a preload finds no equilibrium, or there are faults that its kind cannot have.
    pub fn new(definition: &BearingDefinition) -> Result<Self, BearingError> {
        let mut rows = build_rows::rows(definition);
        let locates = match &rows[0] {
            Row::Ball(_) | Row::FourPoint(_) | Row::Barrel(_) => true,
            Row::Roller(row) => row.rib.is_some(),
        };
        let barrels = matches!(&rows[0], Row::Barrel(_));
        if barrels && definition.preload != Preload::None {
            return Err(BearingError::NotCarried(
                "both rows of a spherical roller bearing share one sphere, so that no preload presses them against each other; give radial_clearance_um (negative: interference)",
            ));
        }
        let preload_m = match definition.preload {
            Preload::None => 0.0,
            Preload::Displacement(m) => m,
            Preload::Force(force_n) => shift_under_force(&rows[0], definition, force_n)?,
        };
        let senses = definition.arrangement.rows();
        // Rings keep their places along the axis as they are seated: a fit adds to the preload of a pair.
        let clearance = definition.operating_clearance();
        for (row, (_, sense)) in rows.iter_mut().zip(senses) {
            row.shift_inner(sense * preload_m);
            if let Some(clearance) = &clearance {
                clearance.apply(row);
            }
        }
        for (number, row) in rows.iter_mut().enumerate() {
            match row {
                Row::Ball(row) => row.faults = RowFaults::of(&definition.faults, number, row)?,
                Row::FourPoint(_) | Row::Barrel(_) => refuse_all_but_rings(&definition.faults)?,
                Row::Roller(row) => {
                    refuse_faults_of_balls(&definition.faults)?;
                    row.missing = missing(&definition.faults, number, row.rollers)?;
                }
            }
        }
        Ok(Self {
            rows,
            preload_m,
            locates,
            misaligned: [Side::Outer, Side::Inner].map(|side| misaligned(definition, side)),
        })
    }

    /// Whether its inner ring tilts freely: loads then do not depend on the tilt.
    #[must_use]
    pub fn aligns(&self) -> bool {
        matches!(&self.rows[0], Row::Barrel(_))
    }

    /// The markers of the rings, given those of their seats: outer, inner.
    #[must_use]
    pub fn ring_markers(&self, seats: MarkerPair) -> MarkerPair {
        let on = |ring: &Option<MisalignedRing>, seat: Marker| match ring {
            None => seat,
            Some(ring) => ring.on(&seat),
        };
        MarkerPair {
            a: on(&self.misaligned[0], seats.a),
            b: on(&self.misaligned[1], seats.b),
        }
    }

    /// Its outer races as they bend with a bore; `functions`: the motions along it by the place in the bearing's frame.
    ///
    /// # Errors
    /// [`BearingError::NotCarried`] for what is no cylindrical roller bearing, or has a misaligned outer ring.
    pub(crate) fn bent_race(
        &self,
        functions: impl Fn(f64) -> Vec<f64>,
    ) -> Result<BentRace, BearingError> {
        let cylindrical = |row: &Row| row.rollers().is_some_and(|row| row.rib.is_none());
        if !self.rows.iter().all(cylindrical) {
            return Err(BearingError::NotCarried(
                "an elastic bore takes the rollers of a cylindrical roller bearing only; name the file of one, or take bore = \"sliding\" or \"bonded\"",
            ));
        }
        if self.misaligned[0].is_some() {
            return Err(BearingError::NotCarried(
                "a misaligned outer ring is a round one, which an elastic bore is not; remove that fault, or take bore = \"sliding\" or \"bonded\"",
            ));
        }
        let rows: Vec<RollerRow> = (self.rows.iter())
            .filter_map(Row::rollers)
            .cloned()
            .collect();
        Ok(BentRace::new(&rows, functions))
    }

    /// How deep a roller at the worst angle overlaps both races that stand so, at most \[m\]; 0 of other elements.
    pub(crate) fn deepest_m(&self, pose: &RingPose) -> f64 {
        let of_row = |row: &RollerRow| {
            let reach_m = row
                .laminae
                .iter()
                .fold(0.0, |most, l| f64::max(most, l.reach_m));
            let end_m = row.laminae.iter().map(|l| l.place_m.abs() + l.length_m);
            let farthest_m = row.middle_z_m.abs() + end_m.fold(0.0, f64::max);
            let room_m = row.outer.offset_m - row.inner.offset_m - 2.0 * reach_m;
            let (across, tilt) = (pose.centre_m.xy().norm(), pose.axis.xy().norm());
            (across + farthest_m * tilt - room_m).max(0.0)
        };
        let rows = self.rows.iter().filter_map(Row::rollers);
        rows.map(of_row).fold(0.0, f64::max)
    }

    /// Complains about faults that only moving balls can have.
    ///
    /// # Errors
    /// [`BearingError::NotCarried`] for a spall on a ball, which meets the races only where the ball turns.
    pub fn refuse_spalled_balls(&self) -> Result<(), BearingError> {
        let spalled = |row: &Row| match row {
            Row::Ball(row) => row.faults.as_ref().is_some_and(|f| !f.spalled().is_empty()),
            Row::FourPoint(_) | Row::Roller(_) | Row::Barrel(_) => false,
        };
        if self.rows.iter().any(spalled) {
            return Err(BearingError::NotCarried(
                "a spall on a ball meets the races as the ball turns, which only balls in motion do: take the model `dynamic`",
            ));
        }
        Ok(())
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
        self.evaluate_from(pose, operation, &mut ElementPlaces::unknown(&self.rows))
    }

    /// As [`Self::evaluate`], the search of each element beginning at its place, which is left where it ended; without
    /// new memory.
    ///
    /// # Errors
    /// As [`Self::evaluate`]; the places of the elements behind the failing one are then as before.
    pub fn evaluate_from(
        &self,
        pose: &RingPose,
        operation: &Operation,
        places: &mut ElementPlaces,
    ) -> Result<RingLoad, BearingError> {
        self.evaluate_each(pose, operation, places, |_| {})
    }

    /// As [`Self::evaluate_from`]; hands the load of every element to `each`, row after row.
    ///
    /// # Errors
    /// As [`Self::evaluate_from`].
    pub fn evaluate_each(
        &self,
        pose: &RingPose,
        operation: &Operation,
        places: &mut ElementPlaces,
        each: impl FnMut(ElementLoad),
    ) -> Result<RingLoad, BearingError> {
        self.evaluate_bent((pose, operation), places, None, each)
    }

    /// As [`Self::evaluate_each`], with outer races that bend.
    pub(crate) fn evaluate_bent(
        &self,
        (pose, operation): (&RingPose, &Operation),
        places: &mut ElementPlaces,
        mut bent: Option<&mut BentRace>,
        mut each: impl FnMut(ElementLoad),
    ) -> Result<RingLoad, BearingError> {
        let mut ring = RingLoad::default();
        if let Some(bent) = &mut bent {
            bent.begin();
        }
        let mut first = 0;
        for (number, (row, places)) in self.rows.iter().zip(places.rows()).enumerate() {
            let race = bent.as_deref_mut().map(|race| (race, (number, first)));
            row.add(
                pose,
                operation,
                places,
                (&mut ring, race),
                &mut each,
                |_, _| {},
            )?;
            first += row.elements();
        }
        ring.turn_freely(&pose.axis);
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
        self.loads_from(pose, operation, &mut ElementPlaces::unknown(&self.rows))
    }

    /// As [`Self::loads`], the search of each element beginning at its place, which is left where it ended.
    ///
    /// # Errors
    /// As [`Self::evaluate`].
    pub fn loads_from(
        &self,
        pose: &RingPose,
        operation: &Operation,
        places: &mut ElementPlaces,
    ) -> Result<(RingLoad, RowLoads), BearingError> {
        let mut ring = RingLoad::default();
        let mut all = RowLoads::default();
        for (row, places) in self.rows.iter().zip(places.rows()) {
            let (mut elements, mut laminae) = (Vec::new(), Vec::new());
            let each = |element| elements.push(element);
            let each_lamina = |inner, outer| laminae.push((inner, outer));
            row.add(
                pose,
                operation,
                places,
                (&mut ring, None),
                each,
                each_lamina,
            )?;
            all.elements.push(elements);
            all.laminae.push(laminae);
        }
        ring.turn_freely(&pose.axis);
        Ok((ring, all))
    }
}

fn refuse_all_but_rings(faults: &[Fault]) -> Result<(), BearingError> {
    let other = |fault: &Fault| !matches!(fault, Fault::MisalignedRing { .. });
    if faults.iter().any(other) {
        return Err(BearingError::NotCarried(
            "of the faults four-point, thrust and spherical roller bearings can have a misaligned ring only",
        ));
    }
    Ok(())
}

fn refuse_faults_of_balls(faults: &[Fault]) -> Result<(), BearingError> {
    let of_balls =
        |fault: &Fault| !matches!(fault, Fault::MisalignedRing { .. } | Fault::Missing { .. });
    if faults.iter().any(of_balls) {
        return Err(BearingError::NotCarried(
            "of the faults a roller bearing can have a misaligned ring and missing rollers only; spalls, waviness and off-size balls are those of deep-groove and angular-contact bearings",
        ));
    }
    Ok(())
}

fn misaligned(definition: &BearingDefinition, of: Side) -> Option<MisalignedRing> {
    let mut found = definition.faults.iter().filter_map(|fault| match fault {
        Fault::MisalignedRing { side, place } if *side == of => Some(*place),
        _ => None,
    });
    found.next()
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
        let mut places = vec![None; row.elements()];
        let ring_alone = (&mut ring, None);
        row.add(
            &pose,
            &operation,
            &mut places,
            ring_alone,
            |_| {},
            |_, _| {},
        )?;
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
                hint: "The preload is more than the races can carry.",
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
