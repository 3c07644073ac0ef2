//! How the loads of each mesh change with the motion of the others.
//!
//! ```text
//! ∂(load of A) = −Σ_i D_i Σ_j K_ij (V_jᵀ δq + W_jᵀ δν)        i on mesh A, j on any other mesh
//! D_i = J_Aᵀ d_i,   V_j = (∂felt/∂gap) J_Bᵀ g_j + (∂felt/∂rate) J̇_Bᵀ g_j,   W_j = (∂felt/∂rate) J_Bᵀ g_j
//! ```
//!
//! J and J̇ are the Jacobians of a mesh's motion by the places of its two bodies, of the motion itself and of its
//! rates. The inner sums are made over all meshes at once, body by body: bodies are fewer than pairs of meshes.

use gearmesh_contact::JointContact;
use gearmesh_dynamics::RelativeMotion;
use gearmesh_dynamics::elements::Loads;
use gearmesh_dynamics::relative_motion::Jacobian;

use crate::pose::Vector6;

/// A contact that carries.
#[derive(Clone, Copy)]
struct Carrying {
    mesh: usize,
    /// Its number in the joint problem.
    number: usize,
    /// First of the six columns of each of its bodies.
    at: [usize; 2],
    /// D, V, W.
    load: [[f64; 6]; 2],
    felt_by_position: [[f64; 6]; 2],
    felt_by_velocity: [[f64; 6]; 2],
}

/// A contact as its mesh has it.
pub(super) struct ContactOfMesh<'a> {
    pub mesh: usize,
    /// Its number in the joint problem.
    pub number: usize,
    /// Numbers of the bodies of gear 1 and gear 2 in the group.
    pub bodies: [usize; 2],
    /// J, and the motion that it is of.
    pub motion: (&'a RelativeMotion, &'a Jacobian),
    /// d and g.
    pub direction: &'a Vector6,
    pub gradient: &'a Vector6,
    /// ∂felt/∂gap and ∂felt/∂rate.
    pub felt_by: [f64; 2],
}

/// Sums over all contacts.
#[derive(Default)]
pub(super) struct CrossTangents {
    carrying: Vec<Carrying>,
    /// J̇ of the mesh that was added last.
    turned: Option<(usize, Jacobian)>,
    /// Σ_j K_ij V_j and Σ_j K_ij W_j of one contact.
    felt: [Vec<f64>; 2],
    /// Tangents, a row of all bodies' columns for each force.
    sums: [Vec<f64>; 2],
}

impl CrossTangents {
    /// Memory for so many contacts on so many bodies.
    pub fn with_capacity(contacts: usize, bodies: usize) -> Self {
        let size = 6 * bodies;
        Self {
            carrying: Vec::with_capacity(contacts),
            turned: None,
            felt: [0, 1].map(|_| vec![0.0; size]),
            sums: [0, 1].map(|_| vec![0.0; size * size]),
        }
    }

    /// Begins anew.
    pub fn clear(&mut self) {
        self.carrying.clear();
        self.turned = None;
    }

    /// Adds a contact that carries; those of a mesh one after the other.
    pub fn add(&mut self, contact: &ContactOfMesh<'_>) {
        let (motion, jacobian) = contact.motion;
        let [by_gap, by_rate] = contact.felt_by;
        let moved = jacobian.tr_mul(contact.gradient);
        let mut felt = by_gap * moved;
        if by_rate != 0.0 {
            if self.turned.is_none_or(|(mesh, _)| mesh != contact.mesh) {
                self.turned = Some((contact.mesh, motion.rate_jacobian(jacobian)));
            }
            if let Some((_, turned)) = &self.turned {
                felt += by_rate * turned.tr_mul(contact.gradient);
            }
        }
        let halves =
            |values: &[f64]| [0, 6].map(|first: usize| std::array::from_fn(|k| values[first + k]));
        self.carrying.push(Carrying {
            mesh: contact.mesh,
            number: contact.number,
            at: contact.bodies.map(|body| 6 * body),
            load: halves(jacobian.tr_mul(contact.direction).as_slice()),
            felt_by_position: halves(felt.as_slice()),
            felt_by_velocity: halves((by_rate * moved).as_slice()),
        });
    }

    /// Adds all tangents to the loads; `places`: where the degrees of freedom of each body begin.
    pub fn add_to(&mut self, joint: &JointContact, places: &[usize], loads: &mut Loads) {
        let size = 6 * places.len();
        let [by_position, by_velocity] = &mut self.felt;
        self.sums.iter_mut().for_each(|sums| sums.fill(0.0));
        let is_damped = (self.carrying.iter()).any(|j| j.felt_by_velocity != [[0.0; 6]; 2]);
        for i in &self.carrying {
            by_position.fill(0.0);
            by_velocity.fill(0.0);
            let stiffness = joint.stiffness_of(i.number);
            for j in self.carrying.iter().filter(|j| j.mesh != i.mesh) {
                let k = stiffness[j.number];
                for (half, at) in j.at.into_iter().enumerate() {
                    add(&mut by_position[at..], k, &j.felt_by_position[half]);
                    if is_damped {
                        add(&mut by_velocity[at..], k, &j.felt_by_velocity[half]);
                    }
                }
            }
            let felt = [&*by_position, &*by_velocity];
            for (felt, sums) in felt.into_iter().zip(&mut self.sums) {
                for (at, load) in i.at.into_iter().zip(&i.load) {
                    for (row, load) in sums[at * size..].chunks_exact_mut(size).zip(load) {
                        for (sum, felt) in row.iter_mut().zip(felt) {
                            *sum -= load * felt;
                        }
                    }
                }
            }
        }
        let place = |dof: usize| places[dof / 6] + dof % 6;
        let [by_position, by_velocity] = &self.sums;
        for (entry, value) in by_position.iter().enumerate() {
            loads.add_by_position(place(entry / size), place(entry % size), *value);
        }
        for (entry, value) in by_velocity.iter().enumerate().filter(|_| is_damped) {
            loads.add_by_velocity(place(entry / size), place(entry % size), *value);
        }
    }
}

/// Adds a multiple of six values.
#[inline]
fn add(sum: &mut [f64], factor: f64, values: &[f64; 6]) {
    for (sum, value) in sum.iter_mut().zip(values) {
        *sum += factor * value;
    }
}
