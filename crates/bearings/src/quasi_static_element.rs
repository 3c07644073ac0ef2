//! A bearing whose balls or rollers are in equilibrium at every moment, between two bodies of a system.
//!
//! Marker A is the outer ring, marker B the inner one, z the axis. Load and tangent are those of
//! [`QuasiStaticBearing`] at the place of B in A, with linear damping beside it. The speeds that balls feel
//! (centrifugal force, gyroscopic moment) are those of the last accepted step; between steps the cage goes on at its
//! speed of rolling, (ω_i − ω_o)(1 − γ)/2 seen from the outer ring, so that elements pass. The friction torque of a
//! definition that has one is that of the loads and speeds of the last accepted step, too, and nothing in the first: M
//! ω/√(ω² + ω₀²) against the turning of the rings.

use gearmesh_dynamics::elements::{Channel, ForceElement, Loads, View};
use gearmesh_dynamics::{BodyId, ElementFailure, MarkerPair, RelativeMotion};
use nalgebra::{Matrix6, Vector6};

use crate::bent_race::BentRace;
use crate::definition::BearingDefinition;
use crate::element_load::ElementLoad;
use crate::element_place::ElementPlaces;
use crate::error::BearingError;
use crate::frequencies::RollingSizes;
use crate::friction::FrictionTorque;
use crate::operation::{Control, Operation};
use crate::quasi_static::{QuasiStaticBearing, Row, RowLoads};
use crate::ring_channels::{RING_CHANNELS, race_loads, ring_channels, sample_ring};
use crate::ring_load::RingLoad;
use crate::ring_pose::{RingPose, spin_rad_per_s};

/// Damping beside the elastic bearing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RingDamping {
    /// Across the axis \[N·s/m\].
    pub radial_n_s_per_m: f64,
    /// Along the axis \[N·s/m\].
    pub axial_n_s_per_m: f64,
    /// Of tilting \[N·m·s/rad\].
    pub tilt_nm_s_per_rad: f64,
}

/// ω₀: rings that turn slower than some of it against each other rub less \[rad/s\].
const CREEP_RAD_PER_S: f64 = 0.1;

/// The bearing as a force element.
///
/// Channels: force and moment on the inner ring (A axes; `force_shaft_x_N` and so on), the force in world axes and
/// across the axis; with [`Self::with_element_loads`] the load of every ball or roller at both races; of a bearing
/// with friction torque and power loss of the loads and speeds of the moment.
pub struct QuasiStaticElement {
    name: String,
    pair: MarkerPair,
    bodies: [BodyId; 2],
    bearing: QuasiStaticBearing,
    sizes: RollingSizes,
    damping: RingDamping,
    control: Control,
    element_loads: bool,
    /// Whether another element carries the load, so that nothing but its friction acts.
    friction_alone: bool,
    /// With a friction torque: the definition it is computed from, and whether it acts.
    rubbing: Option<(BearingDefinition, bool)>,
    /// Time, cage's angle and speeds of the rings at the last accepted step.
    kept: Kept,
    /// Where the elements stood at the last accepted step: every search begins there. Part of the saved state, so that
    /// a resumed run is the same to the last bit.
    kept_places: ElementPlaces,
    /// Where those of the last evaluation stand.
    places: ElementPlaces,
    /// The outer races, where they are a bore that bends.
    bent: Option<BentRace>,
}

#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Kept {
    time_s: f64,
    cage_angle_rad: f64,
    /// Of the inner ring against the outer one.
    inner_angle_rad: f64,
    inner_rad_per_s: f64,
    outer_rad_per_s: f64,
    /// M.
    friction_nm: f64,
}

impl QuasiStaticElement {
    /// Puts a bearing between its outer ring (marker A) and its inner ring (marker B).
    ///
    /// # Errors
    /// [`BearingError`] where a damping is negative or the bearing cannot be preloaded.
    pub fn new(
        name: &str,
        pair: MarkerPair,
        definition: &BearingDefinition,
        control: Control,
        damping: RingDamping,
    ) -> Result<Self, BearingError> {
        for (what, found) in [
            ("the radial damping in N s/m", damping.radial_n_s_per_m),
            ("the axial damping in N s/m", damping.axial_n_s_per_m),
            ("the tilt damping in N m s/rad", damping.tilt_nm_s_per_rad),
        ] {
            BearingError::not_negative(what, found)?;
        }
        let bearing = QuasiStaticBearing::new(definition)?;
        bearing.refuse_spalled_balls()?;
        Ok(Self {
            name: name.to_owned(),
            pair: bearing.ring_markers(pair),
            bodies: [pair.a.body, pair.b.body],
            kept_places: ElementPlaces::unknown(&bearing.rows),
            places: ElementPlaces::unknown(&bearing.rows),
            bent: None,
            bearing,
            sizes: definition.rolling_sizes(),
            damping,
            control,
            element_loads: false,
            friction_alone: false,
            rubbing: definition.friction.map(|_| (definition.clone(), true)),
            kept: Kept::default(),
        })
    }

    /// Adds the load of every ball or roller to the channels: `element_<number>_inner_N`, `element_<number>_outer_N`,
    /// counted from one, row after row.
    #[must_use]
    pub fn with_element_loads(mut self) -> Self {
        self.element_loads = true;
        self
    }

    /// Takes the outer races as a bore that bends; `functions`: its motions along the axis by the place in the frame of
    /// marker A. Whoever solves for the bore sets its motions ([`Self::bent_mut`]) before each evaluation.
    ///
    /// # Errors
    /// [`BearingError::NotCarried`] for what is no cylindrical roller bearing, or has a misaligned outer ring.
    pub fn in_elastic_bore(
        mut self,
        functions: impl Fn(f64) -> Vec<f64>,
    ) -> Result<Self, BearingError> {
        self.bent = Some(self.bearing.bent_race(functions)?);
        Ok(self)
    }

    /// The outer races that bend.
    #[must_use]
    pub fn bent(&self) -> Option<&BentRace> {
        self.bent.as_ref()
    }

    /// The same to be moved.
    pub fn bent_mut(&mut self) -> Option<&mut BentRace> {
        self.bent.as_mut()
    }

    /// Markers of the rings: outer, inner.
    #[must_use]
    pub fn rings(&self) -> &MarkerPair {
        &self.pair
    }

    /// Sizes of its balls or rollers.
    #[must_use]
    pub fn sizes(&self) -> &RollingSizes {
        &self.sizes
    }

    /// Angles of all rollers in the frame of the outer ring at a time, row after row \[rad\].
    pub fn roller_angles_rad(&self, time_s: f64) -> impl Iterator<Item = f64> + '_ {
        let operation = self.operation(time_s);
        let rows = self.bearing.rows.iter().filter_map(Row::rollers);
        rows.flat_map(move |row| {
            (0..row.rollers).map(move |roller| row.angle_rad(roller, &operation))
        })
    }

    /// How deep a roller at the worst angle overlaps both races at a motion, were they round, at most \[m\].
    #[must_use]
    pub fn deepest_m(&self, view: &View<'_>) -> f64 {
        self.bearing.deepest_m(&RingPose::from(&self.motion(view)))
    }

    /// Speed of the cage against the outer ring \[rad/s\].
    #[must_use]
    pub fn cage_rad_per_s(&self) -> f64 {
        // Linear in the speeds, whatever their unit.
        let relative = self.kept.inner_rad_per_s - self.kept.outer_rad_per_s;
        self.sizes.frequencies(relative, 0.0).cage_hz
    }

    /// Load of the elements on the inner ring at a motion; the search of each begins where it stood at the last
    /// accepted step, or, where it `goes_on`, at the last call.
    ///
    /// # Errors
    /// [`BearingError`] where an element finds no equilibrium.
    pub fn find(&mut self, view: &View<'_>, goes_on: bool) -> Result<RingLoad, BearingError> {
        if !goes_on {
            self.places.take_from(&self.kept_places);
        }
        let pose = RingPose::from(&self.motion(view));
        let operation = self.operation(view.time_s);
        let at = (&pose, &operation);
        (self.bearing).evaluate_bent(at, &mut self.places, self.bent.as_mut(), |_| {})
    }

    /// Adds a load that was found, with damping and friction, to the bodies of the rings; `places`: where their degrees
    /// of freedom begin.
    pub fn push(&self, view: &View<'_>, ring: &RingLoad, places: [usize; 2], loads: &mut Loads) {
        let motion = self.motion(view);
        let (mut damping, rates) = (self.damping_matrix(&motion), motion.rates());
        let mut viscous = damping * rates;
        if self.kept.friction_nm > 0.0 {
            let (moment, slope) = self.rubs(rates[5]);
            viscous[5] += moment;
            damping[(5, 5)] += slope;
        }
        let load = ring.load - viscous;
        loads.power.dissipated_w += rates.dot(&viscous);
        match &self.bent {
            // The balls' energy is not known: what the bearing does is work from outside.
            None => loads.power.supplied_w += rates.dot(&ring.load),
            Some(race) => {
                loads.power.stored_j += race.stored_j;
                // By the cage, which leads the rollers round a ring that stands still.
                let centre_m = motion.displacement_m;
                let about_z = centre_m[0] * ring.load[1] - centre_m[1] * ring.load[0];
                loads.power.supplied_w += self.cage_rad_per_s() * (about_z + ring.load[5]);
            }
        }
        loads.add_pair_force(places, &motion.generalised_force(&load));
        if loads.wants_tangents() {
            let jacobian = motion.jacobian();
            let mut by_pose = ring.tangent;
            let turned = self.damping.tilt_nm_s_per_rad * motion.tilt_rate_by_rotation();
            let mut corner = by_pose.fixed_view_mut::<3, 3>(3, 3);
            corner -= turned;
            let along = by_pose * jacobian - damping * motion.rate_jacobian(&jacobian);
            let by_position = jacobian.tr_mul(&along) + motion.geometric_tangent(&jacobian, &load);
            let by_velocity = -jacobian.tr_mul(&(damping * jacobian));
            loads.add_pair_tangents(places, &by_position, &by_velocity);
        }
    }

    /// Shows friction torque and power loss, if it has them, but lets the rings turn freely: for equilibria, in which a
    /// torque about a shaft that turns freely would find no counterpart.
    #[must_use]
    pub fn without_friction_torque(mut self) -> Self {
        if let Some((_, acts)) = &mut self.rubbing {
            *acts = false;
        }
        self
    }

    /// Nothing but the friction torque acts, of the loads of its balls or rollers where the rings stand: beside an
    /// element that carries the load as this bearing would, such as its tangent. Its channels are torque and power.
    #[must_use]
    pub fn friction_alone(mut self) -> Self {
        self.friction_alone = true;
        self
    }

    /// Friction torque at the places of the elements of the last evaluation, and power that it takes; zero where there
    /// is none to compute.
    fn friction(&mut self, pose: &RingPose, operation: &Operation) -> Option<FrictionTorque> {
        let (definition, _) = self.rubbing.as_ref()?;
        let friction = definition.friction.as_ref()?;
        let mut loads = RowLoads::default();
        let mut all = Vec::new();
        let each = |element| all.push(element);
        let (at, bent) = ((pose, operation), self.bent.as_mut());
        let found = (self.bearing).evaluate_bent(at, &mut self.places, bent, each);
        found.ok()?;
        let mut rest = all.as_slice();
        for row in &self.bearing.rows {
            let (own, others) = rest.split_at(row.elements());
            loads.elements.push(own.to_vec());
            rest = others;
        }
        Some(friction.torque(definition, &loads, operation))
    }

    /// Moment about the axis against the relative spin of the rings, and its slope.
    fn rubs(&self, spin_rad_per_s: f64) -> (f64, f64) {
        let scale = spin_rad_per_s.hypot(CREEP_RAD_PER_S);
        let moment = self.kept.friction_nm / scale;
        let slope = moment * (CREEP_RAD_PER_S / scale).powi(2);
        (moment * spin_rad_per_s, slope)
    }

    fn motion(&self, view: &View<'_>) -> RelativeMotion {
        self.pair
            .motion(view.body(self.bodies[0]), view.body(self.bodies[1]))
    }

    /// Speeds of the rings about their own axes: inner, outer.
    fn speeds(&self, view: &View<'_>) -> [f64; 2] {
        [
            (self.bodies[1], &self.pair.b),
            (self.bodies[0], &self.pair.a),
        ]
        .map(|(body, marker)| spin_rad_per_s(view.body(body), marker))
    }

    /// The operation at a time, from what was kept.
    fn operation(&self, time_s: f64) -> Operation {
        let kept = &self.kept;
        // Seen from the outer ring.
        let relative = kept.inner_rad_per_s - kept.outer_rad_per_s;
        let since = time_s - kept.time_s;
        Operation {
            inner_rad_per_s: kept.inner_rad_per_s,
            outer_rad_per_s: kept.outer_rad_per_s,
            cage_angle_rad: kept.cage_angle_rad + self.cage_rad_per_s() * since,
            inner_angle_rad: kept.inner_angle_rad + relative * since,
            control: self.control,
        }
    }

    /// Damping by the rates of the displacement and by the angular velocity, of which the rate of the tilt counts
    /// alone.
    fn damping_matrix(&self, motion: &RelativeMotion) -> Matrix6<f64> {
        let d = &self.damping;
        let radial = d.radial_n_s_per_m;
        let along = Vector6::new(radial, radial, d.axial_n_s_per_m, 0.0, 0.0, 0.0);
        let mut damping = Matrix6::from_diagonal(&along);
        let tilt = d.tilt_nm_s_per_rad * motion.tilt_rate_by_velocity();
        damping.fixed_view_mut::<3, 3>(3, 3).copy_from(&tilt);
        damping
    }

    fn keep(&mut self, view: &View<'_>, cage_angle_rad: f64) {
        let [inner_rad_per_s, outer_rad_per_s] = self.speeds(view);
        let seen = self.motion(view).rotation;
        self.kept = Kept {
            time_s: view.time_s,
            cage_angle_rad,
            inner_angle_rad: (seen.m21 - seen.m12).atan2(seen.m11 + seen.m22),
            inner_rad_per_s,
            outer_rad_per_s,
            friction_nm: self.kept.friction_nm,
        };
    }
}

impl ForceElement for QuasiStaticElement {
    fn name(&self) -> &str {
        &self.name
    }

    fn bodies(&self) -> &[BodyId] {
        &self.bodies
    }

    fn evaluate(&mut self, view: &View<'_>, loads: &mut Loads) -> Result<(), ElementFailure> {
        let ring = match self.friction_alone {
            true => RingLoad::default(),
            false => self.find(view, false)?,
        };
        let places = [loads.starts()[0], loads.starts()[1]];
        self.push(view, &ring, places, loads);
        Ok(())
    }

    fn begin(&mut self, view: &View<'_>) {
        self.kept_places.forget();
        self.kept.friction_nm = 0.0;
        self.keep(view, 0.0);
    }

    fn commit(&mut self, view: &View<'_>) -> Result<(), ElementFailure> {
        let angle = self.operation(view.time_s).cage_angle_rad;
        // Equilibria are committed at the time of the start: rings that turn freely would find none with friction.
        let goes_on = view.time_s > self.kept.time_s;
        self.keep(view, angle);
        self.kept_places.take_from(&self.places);
        if goes_on && self.rubbing.as_ref().is_some_and(|(_, acts)| *acts) {
            let operation = self.operation(view.time_s);
            let found = self.friction(&RingPose::from(&self.motion(view)), &operation);
            self.kept.friction_nm = found.map_or(0.0, |friction| friction.total_nm());
            if self.friction_alone {
                self.kept_places.take_from(&self.places);
            }
        }
        Ok(())
    }

    fn save(&self, out: &mut Vec<f64>) {
        let kept = &self.kept;
        out.extend([
            kept.time_s,
            kept.cage_angle_rad,
            kept.inner_angle_rad,
            kept.inner_rad_per_s,
            kept.outer_rad_per_s,
            kept.friction_nm,
        ]);
        self.kept_places.save(out);
    }

    fn restore(&mut self, numbers: &[f64]) {
        if let [
            time_s,
            cage_angle_rad,
            inner_angle_rad,
            inner_rad_per_s,
            outer_rad_per_s,
            friction_nm,
            ref places @ ..,
        ] = *numbers
        {
            self.kept = Kept {
                time_s,
                cage_angle_rad,
                inner_angle_rad,
                inner_rad_per_s,
                outer_rad_per_s,
                friction_nm,
            };
            self.kept_places.restore(places);
        }
    }

    fn channels(&self) -> Vec<Channel> {
        let mut channels = if self.friction_alone {
            Vec::new()
        } else {
            ring_channels()
        };
        if self.element_loads {
            let count: usize = self.bearing.rows.iter().map(|row| row.elements()).sum();
            for element in 1..=count {
                channels.extend(race_loads("element", element));
            }
        }
        if self.rubbing.is_some() {
            let what = "friction torque of the bearing under its loads and speeds";
            channels.push(Channel::new("friction_torque_Nm", "N·m", what));
            let what = "power that the bearing's friction takes";
            channels.push(Channel::new("friction_power_W", "W", what));
        }
        channels
    }

    fn sample(&mut self, view: &View<'_>, out: &mut [f64]) {
        let motion = self.motion(view);
        let operation = self.operation(view.time_s);
        self.places.take_from(&self.kept_places);
        let (elements, mut number) = (self.element_loads, 0);
        let (pose, bent) = (RingPose::from(&motion), self.bent.as_mut());
        let each = |element: ElementLoad| {
            if elements {
                let at = RING_CHANNELS + 2 * number;
                out[at] = element.inner_load_n;
                out[at + 1] = element.outer_load_n;
                number += 1;
            }
        };
        let at = (&pose, &operation);
        let found = (self.bearing).evaluate_bent(at, &mut self.places, bent, each);
        let Ok(ring) = found else {
            out.fill(f64::NAN);
            return;
        };
        if self.rubbing.is_some() {
            let [inner_rad_per_s, outer_rad_per_s] = self.speeds(view);
            let operation = Operation {
                inner_rad_per_s,
                outer_rad_per_s,
                ..operation
            };
            let friction = self.friction(&pose, &operation);
            let friction = friction.unwrap_or_default();
            let at = out.len() - 2;
            out[at..].copy_from_slice(&[friction.total_nm(), friction.power_w()]);
        }
        if self.friction_alone {
            return;
        }
        let load = ring.load - self.damping_matrix(&motion) * motion.rates();
        let force = motion.to_world(&load.fixed_rows::<3>(0).into_owned());
        sample_ring(&load, &force, out);
    }
}
