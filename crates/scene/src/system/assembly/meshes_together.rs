//! Meshes that are solved together where the bodies of a result stand: the force elements of the scene's own system.

use gearmesh_drivetrain::{DrivetrainError, GearMesh};
use gearmesh_dynamics::{BodyId, System};
use gearmesh_geometry::InputError;
use gearmesh_specification::system::body::BoreHold;
use gearmesh_specification::system::mesh_model::MeshKind;

use super::gears_in_motion::GearState;
use super::{LoadedSystem, Variation};
use crate::system::built::BuiltTogether;

/// Why forces on teeth are not known where bodies stand.
#[derive(Debug, thiserror::Error)]
pub enum MovingError {
    /// Of a mesh by itself.
    #[error(transparent)]
    Mesh(#[from] DrivetrainError),
    /// Of meshes that are solved together.
    #[error("{element} have no forces where the bodies stand")]
    Together {
        /// Name of the force element.
        element: String,
    },
}

/// The system whose elements solve the meshes.
pub(super) struct MeshesTogether {
    system: System,
    groups: Vec<BuiltTogether>,
    /// Bodies of the states, and their places in the system.
    bodies: Vec<(BodyId, usize)>,
    /// Bodies beside the gears.
    pub further: Vec<String>,
}

impl MeshesTogether {
    /// None of a scene whose meshes are all solved by themselves. `gears`: names of the gears' bodies, all of the
    /// system.
    pub fn of(loaded: &LoadedSystem, gears: &[&str]) -> Result<Option<Self>, InputError> {
        if !shares_gears(loaded) {
            return Ok(None);
        }
        let built = loaded.assemble(&Variation::default(), loaded.is_at_rest(), &[])?;
        if built.together.is_empty() {
            return Ok(None);
        }
        let place_of = |name: &str| {
            let mut bodies = built.bodies.iter();
            let place = bodies.position(|body| body.name == name)?;
            Some((built.bodies[place].id, place))
        };
        let mut bodies: Vec<(BodyId, usize)> = gears.iter().filter_map(|g| place_of(g)).collect();
        let mut further = Vec::new();
        for id in built.together.iter().flat_map(|group| group.found.bodies()) {
            let place = built.bodies.iter().position(|other| other.id == *id);
            if let Some(place) = place.filter(|_| bodies.iter().all(|(known, _)| known != id)) {
                bodies.push((*id, place));
                further.push(built.bodies[place].name.clone());
            }
        }
        Ok(Some(Self {
            system: built.system,
            groups: built.together,
            bodies,
            further,
        }))
    }

    /// Group of a mesh, and its number there.
    pub fn place(&self, mesh: &str) -> Option<[usize; 2]> {
        let mut groups = self.groups.iter().enumerate();
        groups.find_map(|(number, group)| {
            let own = group.meshes.iter().position(|name| name == mesh);
            own.map(|own| [number, own])
        })
    }

    /// Solves all groups where bodies stand and move like this, in the order of the gears and further bodies.
    pub fn find(&mut self, states: &[GearState], time_s: f64) -> Result<(), MovingError> {
        let mut state = self.system.start().clone();
        state.time_s = time_s;
        for ((body, place), from) in self.bodies.iter().zip(states) {
            let Some(start) = self.system.layout().start(*body) else {
                continue;
            };
            let motion = from.motion();
            state.positions_m[*place] = motion.position_m;
            state.orientations[*place] = motion.orientation;
            let rates = [motion.velocity_m_per_s, motion.angular_velocity_rad_per_s];
            for (k, rate) in rates.iter().flat_map(|v| v.iter()).enumerate() {
                state.velocity[start + k] = *rate;
            }
        }
        let still = vec![0.0; self.system.degrees_of_freedom()];
        for group in &self.groups {
            let velocity = state.velocity.clone();
            let found = self.system.probe(&group.element, &state, &still, &velocity);
            found.ok_or_else(|| MovingError::Together {
                element: group.element.clone(),
            })?;
        }
        Ok(())
    }

    /// Reads a mesh by its place.
    pub fn of_mesh<T>(&self, [group, mesh]: [usize; 2], read: impl FnOnce(&GearMesh) -> T) -> T {
        self.groups[group].found.of_mesh(mesh, read)
    }

    /// Radial motions of the bore of a body, by its number among the states \[m\].
    pub fn bore_motions_m(&self, number: usize) -> Vec<f64> {
        let (body, _) = self.bodies[number];
        let mut groups = self.groups.iter();
        let found = groups.find_map(|group| group.found.bore_motions_m(body));
        found.unwrap_or_default()
    }
}

/// Whether a gear is in several hybrid meshes or on rollers.
fn shares_gears(loaded: &LoadedSystem) -> bool {
    let tables = &loaded.scene.tables;
    tables.body.iter().any(|body| {
        let meshes = tables.gear_mesh.iter();
        let hybrid = meshes.filter(|mesh| mesh.model.kind() == MeshKind::Hybrid);
        let own = hybrid.filter(|mesh| mesh.gear_1 == body.name || mesh.gear_2 == body.name);
        body.bore == Some(BoreHold::Rollers) || own.count() > 1
    })
}
