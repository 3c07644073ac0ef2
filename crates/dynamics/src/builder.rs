//! Puts a system together and checks it.

use std::collections::BTreeSet;

use crate::body::{Body, BodyId, GROUND};
use crate::constraints;
use crate::elements::{ForceElement, Gravity};
use crate::error::DynamicsError;
use crate::inertia::Inertia;
use crate::joint::Joint;
use crate::state::{BodyMotion, Layout, State};
use crate::structure::Structure;
use crate::system::{Slot, System};
use crate::unknown::{Unknown, UnknownKind};

impl System {
    /// Begins a system.
    #[must_use]
    pub fn builder() -> SystemBuilder {
        SystemBuilder::default()
    }
}

/// Collects bodies, joints and force elements.
#[derive(Default)]
pub struct SystemBuilder {
    bodies: Vec<Body>,
    joints: Vec<Joint>,
    elements: Vec<Box<dyn ForceElement>>,
    gravity_m_per_s2: Option<[f64; 3]>,
}

impl SystemBuilder {
    /// Adds a body.
    ///
    /// # Errors
    /// As [`Body::validate`].
    pub fn body(&mut self, body: Body) -> Result<BodyId, DynamicsError> {
        body.validate()?;
        self.bodies.push(body);
        Ok(BodyId(self.bodies.len() - 1))
    }

    /// Adds a joint.
    pub fn joint(&mut self, joint: Joint) -> &mut Self {
        self.joints.push(joint);
        self
    }

    /// Adds a force element.
    pub fn element(&mut self, element: impl ForceElement + 'static) -> &mut Self {
        self.boxed_element(Box::new(element))
    }

    /// Adds a force element whose type is known at run time only.
    pub fn boxed_element(&mut self, element: Box<dyn ForceElement>) -> &mut Self {
        self.elements.push(element);
        self
    }

    /// Lets all bodies, also those added later, have weight under an acceleration \[m/s²\], world axes.
    pub fn gravity(&mut self, acceleration_m_per_s2: [f64; 3]) -> &mut Self {
        self.gravity_m_per_s2 = Some(acceleration_m_per_s2);
        self
    }

    /// Checks names and numbers, moves the bodies onto the joints and finds redundant joint equations.
    ///
    /// # Errors
    /// [`DynamicsError::Name`], [`DynamicsError::UnknownBody`] and [`DynamicsError::Contradiction`].
    pub fn build(mut self) -> Result<System, DynamicsError> {
        if let Some(g) = self.gravity_m_per_s2 {
            for (index, body) in self.bodies.iter().enumerate() {
                self.elements
                    .push(Box::new(Gravity::new(BodyId(index), body, g)));
            }
        }
        self.check()?;
        let of_elements: Vec<Vec<Unknown>> = self
            .elements
            .iter()
            .map(|element| element.unknowns())
            .collect();
        self.check_unknowns(&of_elements)?;
        let layout = Layout::new(&self.bodies, of_elements.concat());
        let start = State::start(&self.bodies, &layout);
        let mut slots: Vec<Slot> = Vec::new();
        let mut first = 0;
        for (element, own) in self.elements.into_iter().zip(&of_elements) {
            slots.push(Slot::new(element, &layout, first..first + own.len()));
            first += own.len();
        }
        let groups = slots.iter().flat_map(|slot| slot.groups(&layout));
        let structure = Structure::new(&layout, &self.joints, groups);
        for slot in &mut slots {
            slot.find_places(&structure.square);
        }
        let mut system = System {
            inertias: self.bodies.iter().map(Inertia::new).collect(),
            slots,
            motions: vec![BodyMotion::at_rest(); self.bodies.len() + 1],
            bodies: self.bodies,
            joints: self.joints,
            layout,
            structure,
            kept: Vec::new(),
            redundant: Vec::new(),
            start,
        };
        let found = constraints::analyse(&mut system)?;
        system.begin_joints(&found.start);
        system.kept = found.kept;
        system.redundant = found.redundant;
        system.start = found.start;
        system.start_unknowns();
        Ok(system)
    }

    fn check_unknowns(&self, of_elements: &[Vec<Unknown>]) -> Result<(), DynamicsError> {
        for (element, unknowns) in self.elements.iter().zip(of_elements) {
            for unknown in unknowns {
                let mass = match unknown.kind {
                    UnknownKind::Inertial { mass } => Some(("mass", mass)),
                    UnknownKind::Rate | UnknownKind::Equilibrium => None,
                };
                for (what, found) in mass.into_iter().chain([("scale", unknown.scale)]) {
                    let (element, own) = (element.name(), &unknown.name);
                    let owner = format!("force element `{element}`, its `{own}`");
                    DynamicsError::positive(owner, what, found)?;
                }
            }
        }
        Ok(())
    }

    fn check(&self) -> Result<(), DynamicsError> {
        let count = self.bodies.len();
        let of_joints = self.joints.iter().flat_map(|joint| {
            let pairs = joint.pairs().iter();
            pairs.flat_map(move |pair| [pair.a.body, pair.b.body].map(|body| (joint.name(), body)))
        });
        let of_elements = self
            .elements
            .iter()
            .flat_map(|element| element.bodies().iter().map(|body| (element.name(), *body)));
        for (owner, body) in of_joints.chain(of_elements) {
            if body != GROUND && body.0 >= count {
                return Err(DynamicsError::UnknownBody {
                    owner: format!("`{owner}`"),
                    body: body.0,
                    count,
                });
            }
        }
        let kinds: [Vec<&str>; 3] = [
            self.bodies.iter().map(|body| body.name.as_str()).collect(),
            self.joints.iter().map(Joint::name).collect(),
            self.elements.iter().map(|element| element.name()).collect(),
        ];
        for names in kinds {
            let mut seen = BTreeSet::new();
            for name in names {
                if name.is_empty() || !seen.insert(name) {
                    return Err(DynamicsError::Name {
                        name: name.to_owned(),
                    });
                }
            }
        }
        Ok(())
    }
}
