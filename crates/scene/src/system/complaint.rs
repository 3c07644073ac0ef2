//! An error of the multibody system, told at the table of the scene that it is about.

use gearmesh_dynamics::DynamicsError;
use gearmesh_geometry::InputError;
use gearmesh_specification::system::joint::MotionTable;
use gearmesh_specification::system::load::LoadTable;

use super::scene::SystemScene;

impl SystemScene {
    /// The complaint of a system at the place in the file that it is about: the first joint that it names, the force
    /// element that failed, the step that is too large; the file as a whole otherwise.
    pub fn complaint(&self, error: &DynamicsError) -> InputError {
        let key = match error {
            DynamicsError::Contradiction { joints, .. } => {
                joints.first().and_then(|name| self.table_named(name))
            }
            DynamicsError::Element { element, .. }
            | DynamicsError::LeftOnTheWay { element, .. } => self.table_named(element),
            DynamicsError::StepTooLarge { .. } => Some("solver".to_string()),
            _ => None,
        };
        self.document.error(&key.unwrap_or_default(), error)
    }

    /// Dotted path of the table with a name.
    fn table_named(&self, name: &str) -> Option<String> {
        self.named_tables()
            .into_iter()
            .flatten()
            .find(|(_, other)| other == name)
            .map(|(key, _)| key)
    }

    /// Dotted path and name of everything that has a name, in the three groups within which names must differ: bodies
    /// and shafts, joints and motions, force elements.
    pub(super) fn named_tables(&self) -> [Vec<(String, String)>; 3] {
        let t = &self.tables;
        let bodies = [
            named("body", &t.body, |one| one.name.clone()),
            named("shaft", &t.shaft, |one| one.name.clone()),
        ];
        let joints = [
            named("joint", &t.joint, |one| one.name.clone()),
            named("motion", &t.motion, MotionTable::name),
        ];
        let elements = [
            named("load", &t.load, LoadTable::name),
            named("spring", &t.spring, |one| one.name.clone()),
            named("torsion_spring", &t.torsion_spring, |one| one.name.clone()),
            named("bushing", &t.bushing, |one| one.1.name.clone()),
            named("bearing", &t.bearing, |one| one.name.clone()),
            named("gear_mesh", &t.gear_mesh, |one| one.name.clone()),
        ];
        [bodies.concat(), joints.concat(), elements.concat()]
    }
}

fn named<T>(list: &str, tables: &[T], name: impl Fn(&T) -> String) -> Vec<(String, String)> {
    let names = tables.iter().map(name).enumerate();
    names
        .map(|(i, name)| (format!("{list}.{i}"), name))
        .collect()
}
