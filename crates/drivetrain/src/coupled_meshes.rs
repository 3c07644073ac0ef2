//! Meshes that share gear bodies as one force element: their contacts are solved together, so that each feels what the
//! forces of the others make of the bodies.
//!
//! ```text
//! mesh A  gap_A = rigid gap_A + C_AA F_A + δ(F_A) + Σ_B C_AB F_B       C_AB: crates/contact, joint_contact.rs
//! tangent ∂(load A) = Σ_i d_i ∂F_i,   ∂F_i = −Σ_j K_ij g_j ∂(pose of j's mesh)        K = (C + diag δ′)⁻¹ of all
//! ```
//!
//! [`CoupledMeshes`] pushes on all bodies; a [`CoupledPart`] stands for each mesh by its name and reports what that
//! mesh does. Gears without vibration modes: those deflect all meshes of their body already.

use std::sync::atomic::AtomicUsize;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use gearmesh_contact::{BoreBending, JointContact};
use gearmesh_dynamics::elements::{Channel, ForceElement, Loads, View};
use gearmesh_dynamics::{BodyId, ElementFailure};
use gearmesh_model::ReducedGear;

use self::group::{Group, SideOfMesh, links, sides_of_bore};
use self::roller_bore::RollerBore;
use crate::error::DrivetrainError;
use crate::gear_mesh::GearMesh;
use crate::mesh_element::MeshElement;

mod group;
mod roller_bore;

pub use roller_bore::GearOnRollers;

/// A mesh that is to be solved with others, and the models of its gears: none of a gear whose deflection stays with
/// the mesh's own forces.
pub struct MeshToCouple<'a> {
    /// The mesh.
    pub element: MeshElement,
    /// Models of gear 1 and gear 2.
    pub models: [Option<&'a ReducedGear>; 2],
}

/// Meshes whose contacts are solved together.
pub struct CoupledMeshes {
    name: String,
    bodies: Vec<BodyId>,
    /// Where their degrees of freedom begin.
    places: Vec<usize>,
    /// State of a mesh, for its length.
    saved: Vec<f64>,
    group: Arc<Mutex<Group>>,
}

/// One of them, or the bearing of a gear on rollers, for what it reports.
pub struct CoupledPart {
    name: String,
    bodies: [BodyId; 2],
    part: Part,
    group: Arc<Mutex<Group>>,
}

/// What meshes that are solved together were found as at the last evaluation.
pub struct FoundTogether {
    bodies: Vec<BodyId>,
    group: Arc<Mutex<Group>>,
}

impl FoundTogether {
    /// The bodies whose places and speeds the meshes depend on.
    #[must_use]
    pub fn bodies(&self) -> &[BodyId] {
        &self.bodies
    }

    /// What is read of a mesh, by its number among those that were coupled.
    ///
    /// # Panics
    /// If there is no such mesh.
    pub fn of_mesh<T>(&self, number: usize, read: impl FnOnce(&GearMesh) -> T) -> T {
        read(lock(&self.group).meshes[number].mesh())
    }

    /// Radial motions of the bore of a body on rollers \[m\]; none of another body.
    #[must_use]
    pub fn bore_motions_m(&self, body: BodyId) -> Option<Vec<f64>> {
        let group = lock(&self.group);
        let mut bores = group.bores.iter().zip(group.joint.bores());
        let (_, bending) = bores.find(|(bore, _)| bore.bodies()[0] == body)?;
        Some(bending.motions_m().to_vec())
    }
}

/// What a part is, by its number in the group.
#[derive(Clone, Copy)]
enum Part {
    Mesh(usize),
    Bearing(usize),
}

impl CoupledMeshes {
    /// Couples meshes by the bodies that two or more of them have a model for, and by rollers in the bores of gears.
    /// Answers with the element that pushes, the parts of the meshes, and those of the bearings.
    ///
    /// # Errors
    /// [`DrivetrainError::NotCoupled`] for a mesh whose model is not `hybrid` or whose gears have vibration modes,
    /// [`DrivetrainError::Model`] for a model that does not carry the flanks' loads, others for a bearing that does not
    /// sit in the bore.
    pub fn new(
        name: &str,
        meshes: Vec<MeshToCouple<'_>>,
        gears: Vec<GearOnRollers<'_>>,
    ) -> Result<(Self, Vec<CoupledPart>, Vec<CoupledPart>), DrivetrainError> {
        let meshes = meshes.into_iter();
        let (mut elements, models): (Vec<_>, Vec<_>) =
            meshes.map(|mesh| (mesh.element, mesh.models)).unzip();
        let mut sides = Vec::new();
        let mut capacity = 0;
        for (number, element) in elements.iter_mut().enumerate() {
            let mesh = element.mesh_mut();
            if !mesh.couples() {
                let mesh = element.name().to_owned();
                return Err(DrivetrainError::NotCoupled { mesh });
            }
            for side in 0..mesh.side_count() {
                if let Some(model) = mesh.coupled_model(side) {
                    capacity += model.slices().capacity();
                    model.join();
                }
                sides.push(SideOfMesh { mesh: number, side });
            }
        }
        let links = links(&elements, &models, &sides)?;
        let (mut bores, mut bendings) = (Vec::new(), Vec::new());
        for gear in gears {
            let body = gear.bearing.rings().a.body;
            let flanks = sides_of_bore(&elements, (gear.gear, gear.motions, body), &sides)?;
            for gauges in elements.iter_mut().flat_map(|mesh| mesh.gauges_of(body)) {
                gauges.on_bore(gear.gear, gear.motions);
            }
            bendings.push(BoreBending::new(gear.motions, flanks, capacity));
            bores.push(RollerBore::new(gear, capacity)?);
        }
        let mut bodies: Vec<BodyId> = Vec::new();
        let on_meshes = elements.iter().flat_map(MeshElement::gear_bodies);
        for body in on_meshes.chain(bores.iter().flat_map(RollerBore::bodies)) {
            if !bodies.contains(&body) {
                bodies.push(body);
            }
        }
        let group = Arc::new(Mutex::new(Group {
            motions: Vec::with_capacity(elements.len()),
            jacobians: Vec::with_capacity(elements.len()),
            sides,
            joint: JointContact::new(links, capacity).with_bores(bendings),
            bores,
            solutions: Arc::default(),
            bodies: bodies.clone(),
            known: Vec::with_capacity(bodies.len()),
            ahead_m: Vec::with_capacity(capacity),
            drag_n: Vec::with_capacity(capacity),
            meshes: elements,
        }));
        let each = |name: &str, bodies, part| CoupledPart {
            name: name.to_owned(),
            bodies,
            part,
            group: Arc::clone(&group),
        };
        let held = lock(&group);
        let meshes = held.meshes.iter().enumerate();
        let meshes = meshes.map(|(i, mesh)| each(mesh.name(), mesh.gear_bodies(), Part::Mesh(i)));
        let bearings = held.bores.iter().enumerate();
        let bearings =
            bearings.map(|(i, bore)| each(bore.bearing.name(), bore.bodies(), Part::Bearing(i)));
        let (parts, bearings) = (meshes.collect(), bearings.collect());
        drop(held);
        let name = name.to_owned();
        let coupled = Self {
            name,
            places: Vec::with_capacity(bodies.len()),
            saved: Vec::new(),
            bodies,
            group,
        };
        Ok((coupled, parts, bearings))
    }

    /// Solutions of the joint problem of all flanks, counted as long as the element is there: one an evaluation, some
    /// more where rollers bend a bore.
    #[must_use]
    pub fn solutions(&self) -> Arc<AtomicUsize> {
        Arc::clone(&lock(&self.group).solutions)
    }

    /// Reads what is found at each evaluation, wherever the element has gone.
    #[must_use]
    pub fn found(&self) -> FoundTogether {
        FoundTogether {
            bodies: self.bodies.clone(),
            group: Arc::clone(&self.group),
        }
    }

    /// Pairs of sides that feel each other through a body.
    #[must_use]
    pub fn link_count(&self) -> usize {
        lock(&self.group).joint.links().len()
    }
}

/// A group that a panic has left is as good as another: nothing is kept from one evaluation to the next but starts.
fn lock(group: &Mutex<Group>) -> MutexGuard<'_, Group> {
    group.lock().unwrap_or_else(PoisonError::into_inner)
}

impl ForceElement for CoupledMeshes {
    fn name(&self) -> &str {
        &self.name
    }

    fn bodies(&self) -> &[BodyId] {
        &self.bodies
    }

    fn evaluate(&mut self, view: &View<'_>, loads: &mut Loads) -> Result<(), ElementFailure> {
        let mut group = lock(&self.group);
        let tangents = loads.wants_tangents();
        group.update(view, tangents)?;
        let starts: &[usize] = loads.starts();
        // Of the few bodies each element has.
        self.places.clear();
        self.places.extend_from_slice(&starts[..self.bodies.len()]);
        let place = |body: BodyId| {
            let number = self.bodies.iter().position(|own| *own == body);
            number.map_or(0, |number| self.places[number])
        };
        for (element, motion) in group.meshes.iter().zip(&group.motions) {
            element.push(motion, element.gear_bodies().map(place), loads);
        }
        if tangents {
            group.add_cross_tangents(place, loads);
        }
        group.push_bores(view, place, loads);
        Ok(())
    }

    fn begin(&mut self, view: &View<'_>) {
        for bore in &mut lock(&self.group).bores {
            bore.bearing.begin(view);
            bore.kept_m.fill(0.0);
        }
    }

    fn admits(&self, view: &View<'_>) -> Result<(), ElementFailure> {
        let group = lock(&self.group);
        group.meshes.iter().try_for_each(|mesh| mesh.admits(view))
    }

    fn commit(&mut self, view: &View<'_>) -> Result<(), ElementFailure> {
        let group = &mut *lock(&self.group);
        let mut meshes = group.meshes.iter_mut();
        meshes.try_for_each(|mesh| mesh.commit(view))?;
        for (bore, bending) in group.bores.iter_mut().zip(group.joint.bores()) {
            bore.kept_m.copy_from_slice(bending.motions_m());
            bore.bearing.commit(view)?;
        }
        Ok(())
    }

    fn save(&self, out: &mut Vec<f64>) {
        let group = lock(&self.group);
        group.meshes.iter().for_each(|mesh| mesh.save(out));
        for bore in &group.bores {
            out.extend(&bore.kept_m);
            bore.bearing.save(out);
        }
    }

    fn restore(&mut self, numbers: &[f64]) {
        let group = &mut *lock(&self.group);
        let (mut rest, own) = (numbers, &mut self.saved);
        for mesh in &mut group.meshes {
            own.clear();
            mesh.save(own);
            let (own, after) = rest.split_at(own.len().min(rest.len()));
            mesh.restore(own);
            rest = after;
        }
        for bore in &mut group.bores {
            let (kept, after) = rest.split_at(bore.kept_m.len().min(rest.len()));
            bore.kept_m.copy_from_slice(kept);
            own.clear();
            bore.bearing.save(own);
            let (of_bearing, after) = after.split_at(own.len().min(after.len()));
            bore.bearing.restore(of_bearing);
            rest = after;
        }
    }
}

impl ForceElement for CoupledPart {
    fn name(&self) -> &str {
        &self.name
    }

    fn bodies(&self) -> &[BodyId] {
        &self.bodies
    }

    /// Its forces are among those of the [`CoupledMeshes`].
    fn evaluate(&mut self, _view: &View<'_>, _loads: &mut Loads) -> Result<(), ElementFailure> {
        Ok(())
    }

    /// Nothing depends on anything.
    fn couplings(&self, starts: &[usize]) -> Vec<Vec<usize>> {
        vec![vec![starts[0]]]
    }

    fn channels(&self) -> Vec<Channel> {
        let group = lock(&self.group);
        match self.part {
            Part::Mesh(number) => group.meshes[number].channels(),
            Part::Bearing(number) => group.bores[number].bearing.channels(),
        }
    }

    fn sample(&mut self, view: &View<'_>, out: &mut [f64]) {
        let mut group = lock(&self.group);
        if !group.is_at(view) && group.update(view, false).is_err() {
            group.known.clear();
            out.fill(f64::NAN);
            return;
        }
        match self.part {
            Part::Mesh(number) => {
                let Group {
                    meshes,
                    motions,
                    joint,
                    bores,
                    ..
                } = &mut *group;
                let mesh = &mut meshes[number];
                for (bore, bending) in bores.iter().zip(joint.bores()) {
                    for gauges in mesh.gauges_of(bore.bodies()[0]) {
                        gauges.feel_bore(bending.motions_m());
                    }
                }
                mesh.sample_updated(view, &motions[number], out);
            }
            Part::Bearing(number) => group.bores[number].bearing.sample(view, out),
        }
    }
}
