//! An error of the multibody system, told at the table of the scene that it is about.

use gearmesh_dynamics::DynamicsError;
use gearmesh_geometry::InputError;

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
        let named = |list: &str, names: Vec<String>| -> Vec<(String, String)> {
            names
                .into_iter()
                .enumerate()
                .map(|(i, name)| (format!("{list}.{i}"), name))
                .collect()
        };
        macro_rules! names {
            ($list:ident) => {
                named(
                    stringify!($list),
                    t.$list.iter().map(|table| table.name.clone()).collect(),
                )
            };
        }
        let motions = named(
            "motion",
            t.motion.iter().map(|table| table.name()).collect(),
        );
        let loads = named("load", t.load.iter().map(|table| table.name()).collect());
        [
            [names!(body), names!(shaft)].concat(),
            [names!(joint), motions].concat(),
            [
                loads,
                names!(spring),
                names!(torsion_spring),
                names!(bushing),
                names!(bearing),
                names!(gear_mesh),
            ]
            .concat(),
        ]
    }
}
