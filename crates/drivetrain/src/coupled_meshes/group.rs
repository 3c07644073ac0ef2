//! Meshes that are solved together: the bodies that link them, their joint solution and its tangents.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use gearmesh_contact::{AxialSpread, BoreFlank, CrossCompliance, JointContact, MeshLink};
use gearmesh_dynamics::elements::{ForceElement, Loads, View};
use gearmesh_dynamics::relative_motion::{Jacobian, PairTangent};
use gearmesh_dynamics::{BodyId, BodyMotion, GROUND, Iterate, RelativeMotion};
use gearmesh_geometry::Flank;
use gearmesh_model::{RadialMotions, ReducedGear};
use nalgebra::Matrix3;

use super::roller_bore::RollerBore;
use crate::error::DrivetrainError;
use crate::flank_modes::ModalMotion;
use crate::mesh_element::MeshElement;
use crate::pose::{Pose, Vector6};
use crate::slice_plane::Matrix6;

/// What the force of a roller may miss, of the largest one.
const SETTLED: f64 = 1e-10;
/// What it may miss where rollers are thrown out only, by forces as small as their weight \[N\].
const NOTHING_N: f64 = 1e-6;
/// Most iterations of rollers and flanks.
const MOST_SETTLINGS: usize = 50;

/// One side of a mesh in the group.
#[derive(Debug, Clone, Copy)]
pub(super) struct SideOfMesh {
    pub mesh: usize,
    pub side: usize,
}

/// The meshes, and what their solution needs.
pub(super) struct Group {
    pub meshes: Vec<MeshElement>,
    pub sides: Vec<SideOfMesh>,
    pub joint: JointContact,
    pub motions: Vec<RelativeMotion>,
    /// Of the motions, where tangents were asked for.
    pub jacobians: Vec<Jacobian>,
    /// Gears on rollers, in the order of the joint problem's bores.
    pub bores: Vec<RollerBore>,
    /// Solutions of the joint problem so far.
    pub solutions: Arc<AtomicUsize>,
    /// Motions of all bodies at the last evaluation.
    pub bodies: Vec<BodyId>,
    pub known: Vec<BodyMotion>,
    /// How far gaps are felt ahead, and what that makes of the forces.
    pub ahead_m: Vec<f64>,
    pub drag_n: Vec<f64>,
}

/// One cross compliance for all links that are alike.
struct KnownCompliance<'a> {
    model: &'a ReducedGear,
    flanks: [Flank; 2],
    spreads: [AxialSpread; 2],
    compliance: Arc<CrossCompliance>,
}

/// Links of all pairs of sides of different meshes on one body.
pub(super) fn links(
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

/// The sides of meshes on the body of a bore, with their flanks.
pub(super) fn sides_of_bore(
    meshes: &[MeshElement],
    (gear, motions, body): (&ReducedGear, &RadialMotions, BodyId),
    sides: &[SideOfMesh],
) -> Result<Vec<(usize, usize, BoreFlank)>, DrivetrainError> {
    let mut found = Vec::new();
    for (number, at) in sides.iter().enumerate() {
        let mesh = &meshes[at.mesh];
        for own in (0..2).filter(|own| mesh.gear_bodies()[*own] == body) {
            let spread = mesh.mesh().kinematics().layout().spread(own + 1, gear);
            let flank = mesh.mesh().flank_of(own, at.side);
            found.push((
                number,
                own,
                BoreFlank::new(gear, motions, (flank, &spread))?,
            ));
        }
    }
    Ok(found)
}

impl Group {
    /// Takes all meshes to a motion.
    pub fn update(&mut self, view: &View<'_>, tangents: bool) -> Result<(), DrivetrainError> {
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
        // Rollers push flanks together that stand open.
        let of_rollers = self.bores.iter().map(|bore| bore.bearing.deepest_m(view));
        let deepest_m = each.chain(of_rollers).fold(0.0, f64::max);
        for (element, motion) in self.meshes.iter_mut().zip(&self.motions) {
            (element.mesh_mut()).prepare(&Pose::from(motion), deepest_m)?;
        }
        self.solve(view, tangents)?;
        self.jacobians.clear();
        if tangents {
            self.jacobians
                .extend(self.motions.iter().map(RelativeMotion::jacobian));
        }
        for (element, motion) in self.meshes.iter_mut().zip(&self.motions) {
            (element.mesh_mut()).settle(&Pose::from(motion), &none, tangents)?;
        }
        self.known
            .extend(self.bodies.iter().map(|body| *view.body(*body)));
        Ok(())
    }

    /// Whether the last evaluation was at this motion.
    pub fn is_at(&self, view: &View<'_>) -> bool {
        self.known.len() == self.bodies.len()
            && (self.bodies.iter().zip(&self.known)).all(|(body, known)| view.body(*body) == known)
    }

    /// Finds all forces together and gives each side its own.
    fn solve(&mut self, view: &View<'_>, tangents: bool) -> Result<(), DrivetrainError> {
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
        settle(joint, &mut self.bores, view, &self.solutions)?;
        for link in 0..joint.links().len() {
            if let Some(ends) = ends(&joint.links()[link]) {
                joint.walk(link, ends);
            }
        }
        self.joint.walk_bores();
        self.feel_ahead();
        if tangents {
            self.joint.fill_stiffness();
            for (bore, bending) in self.bores.iter_mut().zip(self.joint.bores()) {
                bore.sum_up();
                bore.follow_ring(bending, self.joint.size());
            }
        }
        self.hand_out(tangents);
        Ok(())
    }

    /// What the gaps that damping lets be felt ahead make of all forces.
    fn feel_ahead(&mut self) {
        self.ahead_m.clear();
        self.ahead_m.resize(self.joint.size(), 0.0);
        for (number, at) in self.sides.iter().enumerate() {
            let Some(side) = self.meshes[at.mesh].mesh().coupled_side(at.side) else {
                continue;
            };
            let first = self.joint.contacts_of(number).start;
            for contact in 0..side.contacts.len() {
                if let Some(patch) = side.model.patch_of(contact) {
                    self.ahead_m[first + patch] = side.felt.felt(contact).1;
                }
            }
        }
        self.joint.drag(&self.ahead_m, &mut self.drag_n);
    }

    /// Gives each side its part of the solution.
    fn hand_out(&mut self, tangents: bool) {
        let joint = &self.joint;
        for (number, at) in self.sides.iter().enumerate() {
            let own = joint.contacts_of(number);
            let Some(model) = self.meshes[at.mesh].mesh_mut().coupled_model(at.side) else {
                continue;
            };
            let forces_n = &joint.forces_n()[own.clone()];
            let share = model.accept(forces_n);
            let shared = joint.felt_m()[own.clone()].iter().zip(forces_n);
            share.stored_j = 0.5 * shared.map(|(felt, force)| felt * force).sum::<f64>();
            refill(&mut share.energy_by_u, &joint.energy_by_u()[own.clone()]);
            refill(&mut share.drag_n, &self.drag_n[own.clone()]);
            share.stiffness_n_per_m.clear();
            for row in own.clone().filter(|_| tangents) {
                let of_row = &joint.stiffness_of(row)[own.clone()];
                share.stiffness_n_per_m.extend_from_slice(of_row);
            }
        }
    }

    /// How the loads of each mesh change with the motion of the others; `places`: where the bodies' degrees of freedom
    /// begin.
    pub fn add_cross_tangents(&self, places: impl Fn(BodyId) -> usize, loads: &mut Loads) {
        for (a, of_a) in self.sides.iter().enumerate() {
            for (b, of_b) in self.sides.iter().enumerate() {
                if of_a.mesh == of_b.mesh {
                    continue;
                }
                let Some([by_pose, by_rates]) = self.cross_block([(a, of_a), (b, of_b)]) else {
                    continue;
                };
                let both = [of_a.mesh, of_b.mesh];
                let [left, right] = both.map(|mesh| &self.jacobians[mesh]);
                let at = both.map(|mesh| self.meshes[mesh].gear_bodies().map(&places));
                let turned = self.motions[of_b.mesh].rate_jacobian(right);
                let blocks = [
                    left.tr_mul(&(by_pose * right + by_rates * turned)),
                    left.tr_mul(&(by_rates * right)),
                ];
                add_block(&blocks[0], at, |row, column, part| {
                    loads.add_block_by_position(row, column, part);
                });
                if by_rates != Matrix6::zeros() {
                    add_block(&blocks[1], at, |row, column, part| {
                        loads.add_block_by_velocity(row, column, part);
                    });
                }
            }
        }
    }

    /// Adds the loads of the bearings in bores, and how they and the meshes change with each other's motion.
    pub fn push_bores(&self, view: &View<'_>, places: impl Fn(BodyId) -> usize, loads: &mut Loads) {
        let tangents = loads.wants_tangents();
        for (number, (bore, bending)) in self.bores.iter().zip(self.joint.bores()).enumerate() {
            loads.power.stored_j += bending.stored_energy_j();
            loads.power.supplied_w += bore.led_w(bending.motions_m());
            let mut ring = bore.ring;
            if tangents {
                ring.tangent -= self.between_bores([number, number]);
            }
            let at = bore.bodies().map(&places);
            bore.bearing.push(view, &ring, at, loads);
            if !tangents {
                continue;
            }
            let jacobian = bore.motion(view).jacobian();
            let mut add = |block: &PairTangent, at: [[usize; 2]; 2]| {
                add_block(block, at, |row, column, part| {
                    loads.add_block_by_position(row, column, part);
                });
            };
            for (other, second) in self.bores.iter().enumerate().filter(|(k, _)| *k != number) {
                let to = second.bodies().map(&places);
                let block = -self.between_bores([number, other]) * second.motion(view).jacobian();
                add(&jacobian.tr_mul(&block), [at, to]);
            }
            for (side, of_side) in self.sides.iter().enumerate() {
                let Some([on_ring, on_mesh]) = self.with_mesh(bore, (side, of_side)) else {
                    continue;
                };
                let mesh = &self.jacobians[of_side.mesh];
                let to = self.meshes[of_side.mesh].gear_bodies().map(&places);
                add(&jacobian.tr_mul(&(on_ring * mesh)), [at, to]);
                add(&mesh.tr_mul(&(on_mesh * jacobian)), [to, at]);
            }
        }
    }

    /// Σ_ij P_i K_ij P_jᵀ of two bores.
    fn between_bores(&self, [a, b]: [usize; 2]) -> Matrix6 {
        let [of_a, of_b] = [&self.bores[a].gap_by_ring, &self.bores[b].gap_by_ring];
        let mut sum = Matrix6::zeros();
        for (i, row) in of_a.iter().enumerate() {
            let stiffness = self.joint.stiffness_of(i).iter().zip(of_b);
            let felt: Vector6 = stiffness.map(|(k, gap)| gap * *k).sum();
            sum += row * felt.transpose();
        }
        sum
    }

    /// How the load of a ring changes with the pose of a mesh, by one of its sides, and that of the mesh with the place
    /// of the ring.
    fn with_mesh(
        &self,
        bore: &RollerBore,
        (number, at): (usize, &SideOfMesh),
    ) -> Option<[Matrix6; 2]> {
        let side = self.meshes[at.mesh].mesh().coupled_side(at.side)?;
        let start = self.joint.contacts_of(number).start;
        let (mut on_ring, mut on_mesh) = (Matrix6::zeros(), Matrix6::zeros());
        for (i, contact) in side.contacts.iter().enumerate() {
            let Some(patch) = side.model.patch_of(i) else {
                continue;
            };
            let stiffness = self.joint.stiffness_of(start + patch).iter();
            let felt: Vector6 = stiffness
                .zip(&bore.gap_by_ring)
                .map(|(k, gap)| gap * *k)
                .sum();
            on_ring -= felt * contact.gradient.transpose();
            on_mesh -= side.directions[i] * felt.transpose();
        }
        Some([on_ring, on_mesh])
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
            // By pose and by rates, of all contacts of the other side.
            let mut felt = [Vector6::zeros(); 2];
            for (j, contact) in of_b.contacts.iter().enumerate() {
                let Some(column) = of_b.model.patch_of(j) else {
                    continue;
                };
                let k = stiffness[starts[1] + column];
                if k != 0.0 {
                    carries = true;
                    let (by_gaps, _) = of_b.felt.felt(j);
                    for (felt, by_gap) in felt.iter_mut().zip(by_gaps) {
                        *felt -= k * by_gap * contact.gradient;
                    }
                }
            }
            by_pose += of_a.directions[i] * felt[0].transpose();
            by_rates += of_a.directions[i] * felt[1].transpose();
        }
        carries.then_some([by_pose, by_rates])
    }
}

/// Adds the tangent of two pairs of bodies, forces and moments apart.
fn add_block(
    block: &PairTangent,
    at: [[usize; 2]; 2],
    mut add: impl FnMut(usize, usize, &Matrix3<f64>),
) {
    for (i, j) in (0..4).flat_map(|i| (0..4).map(move |j| (i, j))) {
        let [row, column] =
            [(at[0], i), (at[1], j)].map(|(at, k): ([usize; 2], usize)| at[k / 2] + 3 * (k % 2));
        let part = block.fixed_view::<3, 3>(3 * i, 3 * j);
        add(row, column, &part.into_owned());
    }
}

/// Solves contacts of flanks and of rollers together: with the rollers' forces linear about where the bores are, the
/// flanks' forces are exact; bores move on until the rollers' forces are what they were taken for.
fn settle(
    joint: &mut JointContact,
    bores: &mut [RollerBore],
    view: &View<'_>,
    solutions: &AtomicUsize,
) -> Result<(), DrivetrainError> {
    let goes_on = view.iterate == Iterate::Correction;
    let solve = |joint: &mut JointContact, goes_on: bool| {
        solutions.fetch_add(1, Ordering::Relaxed);
        joint.solve(goes_on)
    };
    if bores.is_empty() {
        solve(joint, goes_on)?;
        return Ok(());
    }
    for (bore, bending) in bores.iter_mut().zip(joint.bores_mut()) {
        if !goes_on {
            bending.motions_mut().copy_from_slice(&bore.kept_m);
        }
        bore.turn(view.time_s);
        bore.find(view, bending.motions_m(), false)?;
    }
    for iteration in 0..MOST_SETTLINGS {
        for (bore, bending) in bores.iter_mut().zip(joint.bores_mut()) {
            bore.sum_up();
            bending
                .support(&bore.force_n, &bore.stiffness)
                .map_err(|_| unsettled(bore, iteration))?;
        }
        solve(joint, goes_on || iteration > 0)?;
        let mut settled = true;
        for (bore, bending) in bores.iter_mut().zip(joint.bores_mut()) {
            bore.expect(bending.motions_m());
            bore.find(view, bending.motions_m(), true)?;
            let [missed_n, most_n, rounding_n] = bore.missed_n();
            settled &= missed_n <= SETTLED * most_n + rounding_n + NOTHING_N;
        }
        if settled {
            return Ok(());
        }
    }
    Err(unsettled(&bores[0], MOST_SETTLINGS))
}

fn unsettled(bore: &RollerBore, iterations: usize) -> DrivetrainError {
    let [missed_n, most_n, _] = bore.missed_n();
    DrivetrainError::RollersUnsettled {
        bearing: bore.bearing.name().to_owned(),
        missed_n,
        most_n,
        iterations,
    }
}

/// Takes the values in the memory that is there.
fn refill<T: Copy>(own: &mut Vec<T>, values: &[T]) {
    own.clear();
    own.extend_from_slice(values);
}
