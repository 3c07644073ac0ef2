//! Meshes that share gear bodies as one force element: their contacts are solved together, so that each feels what the
//! forces of the others make of the bodies.
//!
//! ```text
//! mesh A  gap_A = rigid gap_A + C_AA F_A + δ(F_A) + Σ_B C_AB F_B       C_AB: crates/contact, joint_contact.rs
//! tangent ∂(load A) = Σ_i d_i ∂F_i,   ∂F_i = −Σ_j K_ij g_j ∂(pose of j's mesh)        K = (C + diag δ′)⁻¹ of all
//! ```
//!
//! [`CoupledMeshes`] pushes on all bodies; a [`CoupledMesh`] stands for each mesh by its name and reports what that mesh
//! does. Gears without vibration modes: those deflect all meshes of their body already.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use gearmesh_contact::{AxialSpread, CrossCompliance, JointContact, MeshLink};
use gearmesh_dynamics::elements::{Channel, ForceElement, Loads, View};
use gearmesh_dynamics::{BodyId, BodyMotion, ElementFailure, GROUND, RelativeMotion};
use gearmesh_geometry::Flank;
use gearmesh_model::ReducedGear;

use crate::error::DrivetrainError;
use crate::flank_modes::ModalMotion;
use crate::mesh_element::MeshElement;
use crate::pose::Pose;
use crate::slice_plane::Matrix6;

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
    group: Arc<Mutex<Group>>,
}

/// One of them, for what it reports.
pub struct CoupledMesh {
    name: String,
    bodies: [BodyId; 2],
    number: usize,
    group: Arc<Mutex<Group>>,
}

/// One side of a mesh in the group.
#[derive(Debug, Clone, Copy)]
struct SideOfMesh {
    mesh: usize,
    side: usize,
}

struct Group {
    meshes: Vec<MeshElement>,
    sides: Vec<SideOfMesh>,
    joint: JointContact,
    motions: Vec<RelativeMotion>,
    /// Motions of all bodies at the last evaluation.
    bodies: Vec<BodyId>,
    known: Vec<BodyMotion>,
    /// How far gaps are felt ahead, and what that makes of the forces.
    ahead_m: Vec<f64>,
    drag_n: Vec<f64>,
}

impl CoupledMeshes {
    /// Couples meshes by the bodies that two or more of them have a model for. The first is the element that pushes.
    ///
    /// # Errors
    /// [`DrivetrainError::NotCoupled`] for a mesh whose model is not `hybrid` or whose gears have vibration modes,
    /// [`DrivetrainError::Model`] for a model that does not carry the flanks' loads.
    pub fn new(
        name: &str,
        meshes: Vec<MeshToCouple<'_>>,
    ) -> Result<(Self, Vec<CoupledMesh>), DrivetrainError> {
        let (mut elements, mut models) = (Vec::new(), Vec::new());
        for mesh in meshes {
            elements.push(mesh.element);
            models.push(mesh.models);
        }
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
        let mut bodies: Vec<BodyId> = Vec::new();
        for body in elements.iter().flat_map(MeshElement::gear_bodies) {
            if !bodies.contains(&body) {
                bodies.push(body);
            }
        }
        let group = Arc::new(Mutex::new(Group {
            motions: Vec::with_capacity(elements.len()),
            sides,
            joint: JointContact::new(links, capacity),
            bodies: bodies.clone(),
            known: Vec::with_capacity(bodies.len()),
            ahead_m: Vec::with_capacity(capacity),
            drag_n: Vec::with_capacity(capacity),
            meshes: elements,
        }));
        let each = |(number, mesh): (usize, &MeshElement)| CoupledMesh {
            name: mesh.name().to_owned(),
            bodies: mesh.gear_bodies(),
            number,
            group: Arc::clone(&group),
        };
        let parts = lock(&group).meshes.iter().enumerate().map(each).collect();
        let name = name.to_owned();
        let coupled = Self {
            name,
            places: Vec::with_capacity(bodies.len()),
            bodies,
            group,
        };
        Ok((coupled, parts))
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

/// One cross compliance for all links that are alike.
struct KnownCompliance<'a> {
    model: &'a ReducedGear,
    flanks: [Flank; 2],
    spreads: [AxialSpread; 2],
    compliance: Arc<CrossCompliance>,
}

/// Links of all pairs of sides of different meshes on one body.
fn links(
    meshes: &[MeshElement],
    models: &[[Option<&ReducedGear>; 2]],
    sides: &[SideOfMesh],
) -> Result<Vec<MeshLink>, DrivetrainError> {
    let mut known: Vec<KnownCompliance<'_>> = Vec::new();
    let mut links = Vec::new();
    let gears = || (0..2).flat_map(|g| (0..2).map(move |h| [g, h]));
    for (a, of_a) in sides.iter().enumerate() {
        for (b, of_b) in sides.iter().enumerate().skip(a + 1) {
            let both = [of_a.mesh, of_b.mesh];
            for gears in gears().filter(|_| both[0] != both[1]) {
                let body = |k: usize| meshes[both[k]].gear_bodies()[gears[k]];
                let model = |k: usize| models[both[k]][gears[k]];
                let (Some(model), Some(_)) = (model(0), model(1)) else {
                    continue;
                };
                if body(0) != body(1) || body(0) == GROUND {
                    continue;
                }
                let flank = |k: usize, side: usize| meshes[both[k]].mesh().flank_of(gears[k], side);
                let flanks = [flank(0, of_a.side), flank(1, of_b.side)];
                let spread = |k: usize| {
                    let layout = meshes[both[k]].mesh().kinematics().layout();
                    layout.spread(gears[k] + 1, model)
                };
                let spreads = [spread(0), spread(1)];
                let alike = |known: &&KnownCompliance<'_>| {
                    std::ptr::eq(known.model, model)
                        && known.flanks == flanks
                        && known.spreads == spreads
                };
                let compliance = match known.iter().find(alike) {
                    Some(found) => Arc::clone(&found.compliance),
                    None => {
                        let made = CrossCompliance::new(model, flanks, [&spreads[0], &spreads[1]])?;
                        let compliance = Arc::new(made);
                        known.push(KnownCompliance {
                            model,
                            flanks,
                            spreads,
                            compliance: Arc::clone(&compliance),
                        });
                        compliance
                    }
                };
                links.push(MeshLink {
                    sides: [a, b],
                    gears,
                    compliance,
                });
            }
        }
    }
    Ok(links)
}

impl Group {
    /// Takes all meshes to a motion.
    fn update(&mut self, view: &View<'_>, tangents: bool) -> Result<(), DrivetrainError> {
        self.known.clear();
        self.motions.clear();
        let none = ModalMotion::default();
        for element in &mut self.meshes {
            let motion = element.motion(view);
            let mesh = element.mesh_mut();
            mesh.expect(view.iterate);
            mesh.find(&Pose::from(&motion), &none, tangents)?;
            self.motions.push(motion);
        }
        let each = self.meshes.iter();
        let each = each.map(|element| element.mesh().deepest_overlap_m());
        let deepest_m = each.fold(0.0, f64::max);
        for (element, motion) in self.meshes.iter_mut().zip(&self.motions) {
            (element.mesh_mut()).prepare(&Pose::from(motion), deepest_m)?;
        }
        self.solve(tangents)?;
        for (element, motion) in self.meshes.iter_mut().zip(&self.motions) {
            (element.mesh_mut()).settle(&Pose::from(motion), &none, tangents)?;
        }
        self.known
            .extend(self.bodies.iter().map(|body| *view.body(*body)));
        Ok(())
    }

    /// Whether the last evaluation was at this motion.
    fn is_at(&self, view: &View<'_>) -> bool {
        self.known.len() == self.bodies.len()
            && (self.bodies.iter().zip(&self.known)).all(|(body, known)| view.body(*body) == known)
    }

    /// Finds all forces together and gives each side its own.
    fn solve(&mut self, tangents: bool) -> Result<(), DrivetrainError> {
        let (joint, meshes, sides) = (&mut self.joint, &mut self.meshes, &self.sides);
        for at in sides {
            if let Some(model) = meshes[at.mesh].mesh_mut().coupled_model(at.side) {
                model.lay_known();
            }
        }
        let side = |at: SideOfMesh| meshes[at.mesh].mesh().coupled_side(at.side);
        let count = |at: &SideOfMesh| side(*at).map_or(0, |side| side.model.patch_count());
        joint.lay(sides.iter().map(count));
        for (number, at) in sides.iter().enumerate() {
            if let Some(side) = side(*at) {
                joint.take(number, side.model.slices(), side.model.known_n());
            }
        }
        let ends = |link: &MeshLink| {
            let [a, b] = link.sides.map(|number| side(sides[number]));
            Some([a?.model.slices(), b?.model.slices()])
        };
        for link in 0..joint.links().len() {
            if let Some(ends) = ends(&joint.links()[link]) {
                joint.couple(link, ends);
            }
        }
        joint.solve()?;
        for link in 0..joint.links().len() {
            if let Some(ends) = ends(&joint.links()[link]) {
                joint.walk(link, ends);
            }
        }
        // What the gaps that damping lets be felt ahead make of all forces.
        self.ahead_m.clear();
        self.ahead_m.resize(joint.size(), 0.0);
        for (number, at) in sides.iter().enumerate() {
            let Some(side) = side(*at) else { continue };
            let first = joint.contacts_of(number).start;
            for contact in 0..side.contacts.len() {
                if let Some(patch) = side.model.patch_of(contact) {
                    self.ahead_m[first + patch] = side.felt.felt(contact).1;
                }
            }
        }
        joint.drag(&self.ahead_m, &mut self.drag_n);
        if tangents {
            joint.fill_stiffness();
        }
        for (number, at) in sides.iter().enumerate() {
            let own = joint.contacts_of(number);
            let Some(model) = meshes[at.mesh].mesh_mut().coupled_model(at.side) else {
                continue;
            };
            let forces_n = &joint.forces_n()[own.clone()];
            let share = model.accept(forces_n);
            let felt_m = &joint.felt_m()[own.clone()];
            let shared = felt_m
                .iter()
                .zip(forces_n)
                .map(|(felt, force)| felt * force);
            share.stored_j = 0.5 * shared.sum::<f64>();
            refill(&mut share.energy_by_u, &joint.energy_by_u()[own.clone()]);
            refill(&mut share.drag_n, &self.drag_n[own.clone()]);
            share.stiffness_n_per_m.clear();
            if tangents {
                for row in own.clone() {
                    let of_row = joint.stiffness_of(row);
                    share
                        .stiffness_n_per_m
                        .extend_from_slice(&of_row[own.clone()]);
                }
            }
        }
        Ok(())
    }

    /// How the loads of each mesh change with the motion of the others; `places`: where the bodies' degrees of freedom
    /// begin.
    fn add_cross_tangents(&self, places: impl Fn(BodyId) -> usize, loads: &mut Loads) {
        let jacobians = || self.motions.iter().map(RelativeMotion::jacobian);
        for (a, of_a) in self.sides.iter().enumerate() {
            for (b, of_b) in self.sides.iter().enumerate() {
                if of_a.mesh == of_b.mesh {
                    continue;
                }
                let Some([by_pose, by_rates]) = self.cross_block([(a, of_a), (b, of_b)]) else {
                    continue;
                };
                let both = [of_a.mesh, of_b.mesh];
                let [Some(left), Some(right)] = both.map(|mesh| jacobians().nth(mesh)) else {
                    continue;
                };
                let at = both.map(|mesh| self.meshes[mesh].gear_bodies().map(&places));
                let blocks = [by_pose, by_rates].map(|block| left.tr_mul(&(block * right)));
                for (i, j) in (0..12).flat_map(|i| (0..12).map(move |j| (i, j))) {
                    let (row, column) = (at[0][i / 6] + i % 6, at[1][j / 6] + j % 6);
                    loads.add_by_position(row, column, blocks[0][(i, j)]);
                    if by_rates != Matrix6::zeros() {
                        loads.add_by_velocity(row, column, blocks[1][(i, j)]);
                    }
                }
            }
        }
    }

    /// How the load of one side changes with pose and rates of another mesh; none where nothing carries.
    fn cross_block(&self, [a, b]: [(usize, &SideOfMesh); 2]) -> Option<[Matrix6; 2]> {
        let side = |at: &SideOfMesh| self.meshes[at.mesh].mesh().coupled_side(at.side);
        let (of_a, of_b) = (side(a.1)?, side(b.1)?);
        let starts = [a.0, b.0].map(|number| self.joint.contacts_of(number).start);
        let (mut by_pose, mut by_rates) = (Matrix6::zeros(), Matrix6::zeros());
        let mut carries = false;
        for i in 0..of_a.contacts.len() {
            let Some(row) = of_a.model.patch_of(i) else {
                continue;
            };
            let stiffness = self.joint.stiffness_of(starts[0] + row);
            for (j, contact) in of_b.contacts.iter().enumerate() {
                let Some(column) = of_b.model.patch_of(j) else {
                    continue;
                };
                let k = stiffness[starts[1] + column];
                if k != 0.0 {
                    carries = true;
                    let ([by_gap, by_rate], _) = of_b.felt.felt(j);
                    let rank_one = of_a.directions[i] * contact.gradient.transpose();
                    by_pose -= k * by_gap * rank_one;
                    by_rates -= k * by_rate * rank_one;
                }
            }
        }
        carries.then_some([by_pose, by_rates])
    }
}

/// Takes the values in the memory that is there.
fn refill<T: Copy>(own: &mut Vec<T>, values: &[T]) {
    own.clear();
    own.extend_from_slice(values);
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
        Ok(())
    }

    fn admits(&self, view: &View<'_>) -> Result<(), ElementFailure> {
        let group = lock(&self.group);
        group.meshes.iter().try_for_each(|mesh| mesh.admits(view))
    }

    fn commit(&mut self, view: &View<'_>) -> Result<(), ElementFailure> {
        let mut group = lock(&self.group);
        let mut meshes = group.meshes.iter_mut();
        meshes.try_for_each(|mesh| mesh.commit(view))
    }

    fn save(&self, out: &mut Vec<f64>) {
        lock(&self.group)
            .meshes
            .iter()
            .for_each(|mesh| mesh.save(out));
    }

    fn restore(&mut self, numbers: &[f64]) {
        let mut rest = numbers;
        for mesh in &mut lock(&self.group).meshes {
            let mut own = Vec::new();
            mesh.save(&mut own);
            let (own, after) = rest.split_at(own.len().min(rest.len()));
            mesh.restore(own);
            rest = after;
        }
    }
}

impl ForceElement for CoupledMesh {
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
        lock(&self.group).meshes[self.number].channels()
    }

    fn sample(&mut self, view: &View<'_>, out: &mut [f64]) {
        let mut group = lock(&self.group);
        if !group.is_at(view) && group.update(view, false).is_err() {
            group.known.clear();
            out.fill(f64::NAN);
            return;
        }
        let motion = group.motions[self.number];
        group.meshes[self.number].sample_updated(view, &motion, out);
    }
}
