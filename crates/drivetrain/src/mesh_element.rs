//! A gear mesh between two bodies of a multibody system.

use gearmesh_dynamics::elements::{Channel, ForceElement, Loads, View};
use gearmesh_dynamics::relative_motion::PairTangent;
use gearmesh_dynamics::{BodyId, ElementFailure, Marker, MarkerPair, RelativeMotion};
use gearmesh_model::ReducedGear;

use crate::error::DrivetrainError;
use crate::flank_contacts::FlankContacts;
use crate::flank_modes::ModalMotion;
use crate::gear_mesh::{GearMesh, MeshLoad};
use crate::mesh_channels::{self, FORCES, MOMENTS, POWERS, SliceLineLoads, force_on_gear_1};
use crate::pair_channels::ToothPairs;
use crate::pose::Pose;
use crate::strain_gauges::{ModalPart, StrainGauges};

impl From<&RelativeMotion> for Pose {
    fn from(motion: &RelativeMotion) -> Self {
        Self {
            displacement_m: motion.displacement_m,
            rotation: motion.rotation,
            velocity_m_per_s: motion.velocity_m_per_s,
            angular_velocity_rad_per_s: motion.angular_velocity_rad_per_s,
        }
    }
}

/// Tangents of the generalised force of a mesh on its two bodies; order as in [`gearmesh_dynamics::elements::Loads`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairTangents {
    /// ∂force/∂increments.
    pub by_position: PairTangent,
    /// ∂force/∂velocities.
    pub by_velocity: PairTangent,
}

impl PairTangents {
    /// Brings the tangents of a load from gear 1's frame to the bodies.
    #[must_use]
    pub fn new(mesh: &MeshLoad, motion: &RelativeMotion) -> Self {
        let jacobian = motion.jacobian();
        let along =
            mesh.by_position * jacobian + mesh.by_velocity * motion.rate_jacobian(&jacobian);
        Self {
            by_position: jacobian.tr_mul(&along) + motion.geometric_tangent(&jacobian, &mesh.load),
            by_velocity: jacobian.tr_mul(&(mesh.by_velocity * jacobian)),
        }
    }
}

/// A [`GearMesh`] at its place. The markers are the gears' frames: z along the axis, origin at mid-face, tooth 0 on +x.
///
/// Channels: normal force of each side that is modelled, transmission error, pairs of teeth that carry, whether the
/// gears are apart (1 where no tooth reaches the mate; the transmission error then goes on as that of continued
/// flanks); strain of each gauge; the force on gear 1 and the line load of each slice (mesh_channels.rs); the pairs of
/// teeth that carry (pair_channels.rs); powers where the teeth rub.
pub struct MeshElement {
    name: String,
    pair: MarkerPair,
    /// The axes about which the bodies turn, where the gears stand beside them.
    axes: Option<(MarkerPair, FlankContacts)>,
    bodies: [BodyId; 2],
    mesh: GearMesh,
    gauges: Vec<StrainGauges>,
    line_loads: Option<SliceLineLoads>,
    pairs: Option<ToothPairs>,
}

impl MeshElement {
    /// Puts a mesh between gear 1 and gear 2.
    #[must_use]
    pub fn new(name: &str, [gear_1, gear_2]: [Marker; 2], mesh: GearMesh) -> Self {
        Self {
            name: name.to_owned(),
            pair: MarkerPair {
                a: gear_1,
                b: gear_2,
            },
            axes: None,
            bodies: [gear_1.body, gear_2.body],
            mesh,
            gauges: Vec::new(),
            line_loads: None,
            pairs: None,
        }
    }

    /// States the axes about which the bodies turn, for gears that stand beside them or askew: the transmission error
    /// is then that of ideal flanks on these axes, with runout and wobble in it.
    #[must_use]
    pub fn with_axes(mut self, [a, b]: [Marker; 2]) -> Self {
        let found = FlankContacts::with_capacity(self.mesh.kinematics().capacity());
        self.axes = Some((MarkerPair { a, b }, found));
        self
    }

    /// Adds the line load of each slice, slices being so wide \[m\]: channels `line_load_slice_<number>_N_per_m`,
    /// counted along gear 1's z.
    #[must_use]
    pub fn with_line_loads(mut self, slice_width_m: f64) -> Self {
        self.line_loads = Some(SliceLineLoads {
            width_m: slice_width_m,
        });
        self
    }

    /// Adds tooth, force, place and pressure of each pair that carries (pair_channels.rs).
    #[must_use]
    pub fn with_tooth_pairs(mut self, pairs: ToothPairs) -> Self {
        self.pairs = Some(pairs);
        self
    }

    /// Adds gauges of gear 1 or 2, read at every output time: channels `strain_gear1_<gauge>_method1_ustrain` and
    /// `…_method2_ustrain`.
    ///
    /// # Errors
    /// As [`StrainGauges::new`].
    ///
    /// # Panics
    /// If `gear` is neither 1 nor 2.
    pub fn with_gauges(
        mut self,
        gear: usize,
        model: &ReducedGear,
        names: &[&str],
        modal_part: ModalPart,
    ) -> Result<Self, DrivetrainError> {
        let gauges = StrainGauges::new(&self.mesh, gear, model, names, modal_part)?;
        self.gauges.push(gauges);
        Ok(self)
    }

    /// Gauges of the gears that are this body, which runs on rollers.
    pub(crate) fn gauges_of(&mut self, body: BodyId) -> impl Iterator<Item = &mut StrainGauges> {
        let bodies = self.bodies;
        let gauges = self.gauges.iter_mut();
        gauges.filter(move |gauges| bodies[gauges.gear() - 1] == body)
    }

    /// The mesh.
    #[must_use]
    pub fn mesh(&self) -> &GearMesh {
        &self.mesh
    }

    /// Bodies of gear 1 and gear 2.
    #[must_use]
    pub fn gear_bodies(&self) -> [BodyId; 2] {
        self.bodies
    }

    pub(crate) fn mesh_mut(&mut self) -> &mut GearMesh {
        &mut self.mesh
    }

    pub(crate) fn motion(&self, view: &View<'_>) -> RelativeMotion {
        let [gear_1, gear_2] = self.bodies.map(|body| view.body(body));
        self.pair.motion(gear_1, gear_2)
    }

    /// Transmission error at the last motion, not a number where there is none.
    fn transmission_error_m(&mut self, view: &View<'_>, motion: &RelativeMotion) -> f64 {
        let told = match &mut self.axes {
            // Between two pairs of teeth, and where gears are apart, the nearest flanks are continued.
            None => (self.mesh.transmission_error_m()).or_else(|| self.mesh.nearest_gap_m()),
            Some((axes, found)) => {
                let [body_1, body_2] = self.bodies.map(|body| view.body(body));
                let poses = [motion, &axes.motion(body_1, body_2)].map(Pose::from);
                let told = (self.mesh).transmission_error_on_axes_m(&poses[0], &poses[1], found);
                told.ok().flatten()
            }
        };
        told.unwrap_or(f64::NAN)
    }

    /// Takes the mesh to a motion of its bodies and their modes.
    fn update(
        &mut self,
        view: &View<'_>,
        motion: &RelativeMotion,
        tangents: bool,
    ) -> Result<(), DrivetrainError> {
        let counts = self.mesh.modal_loads().counts();
        let mut modal = ModalMotion::default();
        for (gear, body) in self.bodies.into_iter().enumerate() {
            if counts[gear] == 0 {
                continue;
            }
            modal.coordinates[gear] = view.modal(body);
            modal.rates[gear] = view.modal_rates(body);
            DrivetrainError::check_length(
                "gear mesh",
                "the list of modes of a gear's body",
                modal.coordinates[gear].len(),
                counts[gear],
            )?;
        }
        self.mesh.expect(view.iterate);
        self.mesh.update(&Pose::from(motion), &modal, tangents)
    }

    /// Adds load, tangents and power of a mesh that is at this motion; `places`: where the bodies' degrees of freedom
    /// begin.
    pub(crate) fn push(&self, motion: &RelativeMotion, places: [usize; 2], loads: &mut Loads) {
        let mesh = self.mesh.load();
        loads.power.stored_j += mesh.power.stored_j;
        loads.power.dissipated_w += mesh.power.dissipated_w;
        loads.power.supplied_w += mesh.power.supplied_w;
        loads.add_pair_force(places, &motion.generalised_force(&mesh.load));
        if loads.wants_tangents() {
            let on_pair = PairTangents::new(mesh, motion);
            loads.add_pair_tangents(places, &on_pair.by_position, &on_pair.by_velocity);
        }
    }

    /// Adds forces on modes and their tangents; `places`: where the bodies' degrees of freedom begin.
    fn add_modal(&self, motion: &RelativeMotion, places: [usize; 2], loads: &mut Loads) {
        let modal = self.mesh.modal_loads();
        let [first, _] = modal.counts();
        let place_of = |mode: usize| match mode.checked_sub(first) {
            None => places[0] + 6 + mode,
            Some(of_2) => places[1] + 6 + of_2,
        };
        for (mode, force) in modal.force.iter().enumerate() {
            loads.add_force(place_of(mode), &[*force]);
        }
        if !loads.wants_tangents() {
            return;
        }
        let jacobian = motion.jacobian();
        let rate_jacobian = motion.rate_jacobian(&jacobian);
        let count = modal.count();
        for mode in 0..count {
            let at = place_of(mode);
            let by_pose = modal.force_by_pose[mode].transpose();
            let by_rates = modal.force_by_rates[mode].transpose();
            let row = by_pose * jacobian + by_rates * rate_jacobian;
            let rate_row = by_rates * jacobian;
            let column = jacobian.tr_mul(&modal.load_by_coordinates[mode]);
            let rate_column = jacobian.tr_mul(&modal.load_by_rates[mode]);
            for dof in 0..12 {
                let other = places[dof / 6] + dof % 6;
                loads.add_by_position(at, other, row[dof]);
                loads.add_by_velocity(at, other, rate_row[dof]);
                loads.add_by_position(other, at, column[dof]);
                loads.add_by_velocity(other, at, rate_column[dof]);
            }
            for other in 0..count {
                let to = place_of(other);
                loads.add_by_position(at, to, modal.by_coordinates[mode * count + other]);
                loads.add_by_velocity(at, to, modal.by_rates[mode * count + other]);
            }
        }
    }
}

impl ForceElement for MeshElement {
    fn name(&self) -> &str {
        &self.name
    }

    fn bodies(&self) -> &[BodyId] {
        &self.bodies
    }

    fn evaluate(&mut self, view: &View<'_>, loads: &mut Loads) -> Result<(), ElementFailure> {
        let motion = self.motion(view);
        let tangents = loads.wants_tangents();
        self.update(view, &motion, tangents)?;
        // Modal coordinates of gear 1 stand between the two.
        let places = [0, 6 + view.modal(self.bodies[0]).len()];
        self.push(&motion, places, loads);
        if self.mesh.modal_loads().count() > 0 {
            self.add_modal(&motion, places, loads);
        }
        Ok(())
    }

    fn admits(&self, view: &View<'_>) -> Result<(), ElementFailure> {
        let pose = Pose::from(&self.motion(view));
        Ok(self.mesh.refuse_overlap(&pose)?)
    }

    /// The forces of the last evaluation, which led to this motion, become the start of the next solutions.
    fn commit(&mut self, view: &View<'_>) -> Result<(), ElementFailure> {
        self.mesh.remember();
        self.admits(view)
    }

    fn save(&self, out: &mut Vec<f64>) {
        self.mesh.save(out);
    }

    fn restore(&mut self, numbers: &[f64]) {
        self.mesh.restore(numbers);
    }

    fn channels(&self) -> Vec<Channel> {
        let sides = self.mesh.flanks().map(mesh_channels::normal_force);
        let slices = self
            .line_loads
            .map(|_| self.mesh.kinematics().layout().slices);
        let strain = self.gauges.iter().flat_map(|gauges| {
            let names = gauges.names().iter();
            names.flat_map(|name| {
                [1, 2].map(|method| mesh_channels::strain(gauges.gear(), name, method))
            })
        });
        sides
            .chain(mesh_channels::state())
            .chain(strain)
            .chain(mesh_channels::forces())
            .chain(mesh_channels::moments())
            .chain(slices.map(SliceLineLoads::channels).into_iter().flatten())
            .chain(self.pairs.map(ToothPairs::channels).into_iter().flatten())
            .chain(
                (self.mesh.rubs())
                    .then(mesh_channels::powers)
                    .into_iter()
                    .flatten(),
            )
            .collect()
    }

    fn sample(&mut self, view: &View<'_>, out: &mut [f64]) {
        // What fails here has failed in the step itself, or will in the next one.
        let motion = self.motion(view);
        if self.update(view, &motion, false).is_err() {
            out.fill(f64::NAN);
            return;
        }
        self.sample_updated(view, &motion, out);
    }
}

impl MeshElement {
    /// [`ForceElement::sample`] of a mesh that is at this motion.
    pub(crate) fn sample_updated(
        &mut self,
        view: &View<'_>,
        motion: &RelativeMotion,
        out: &mut [f64],
    ) {
        let own = if self.mesh.rubs() { POWERS } else { 0 };
        let (out, powers) = out.split_at_mut(out.len() - own);
        let force = motion.generalised_force(&self.mesh.load().load);
        if let [friction, power] = powers {
            let body = view.body(self.bodies[0]);
            *friction = self.mesh.load().friction_w;
            *power = -(force.fixed_rows::<3>(0).dot(&body.velocity_m_per_s)
                + (force.fixed_rows::<3>(3)).dot(&body.angular_velocity_rad_per_s));
        }
        let mut pairs = 0;
        let sides = self.mesh.flanks().count();
        for (place, flank) in out.iter_mut().zip(self.mesh.flanks()) {
            let Some((found, forces)) = self.mesh.side(flank) else {
                continue;
            };
            *place = forces.iter().sum();
            let loaded =
                |first: usize, count: usize| forces[first..first + count].iter().any(|f| *f > 0.0);
            pairs += (found.lines.iter())
                .filter(|line| loaded(line.contacts.0, line.contacts.1))
                .count();
        }
        out[sides] = self.transmission_error_m(view, motion);
        out[sides + 1] = pairs as f64;
        out[sides + 2] = f64::from(u8::from(self.mesh.is_apart()));
        let mut places = out[sides + 3..].iter_mut();
        for gauges in &mut self.gauges {
            let coordinates = view.modal(self.bodies[gauges.gear() - 1]);
            for strain in gauges.read(&self.mesh, coordinates) {
                let both = [strain.method_1, strain.method_2];
                for (value, place) in both.into_iter().zip(places.by_ref()) {
                    *place = 1e6 * value;
                }
            }
        }
        let rest = places.into_slice();
        let (forces, rest) = rest.split_at_mut(FORCES);
        let (moments, rest) = rest.split_at_mut(MOMENTS);
        moments.copy_from_slice(&[force[5], force[11]]);
        let of_pairs = self.pairs.map_or(0, ToothPairs::count);
        let (slices, pairs) = rest.split_at_mut(rest.len() - of_pairs);
        forces.copy_from_slice(&force_on_gear_1(&self.mesh, &Pose::from(motion)));
        if let Some(line_loads) = &self.line_loads {
            line_loads.write(&self.mesh, slices);
        }
        if let Some(channels) = self.pairs {
            channels.write(&self.mesh, pairs);
        }
    }
}
