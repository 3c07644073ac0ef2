//! A REXS model as written in the file: components with attributes, relations between them, load cases.

use crate::effort;
use crate::error::RexsError;
use std::collections::{HashMap, HashSet};
use std::sync::OnceLock;

/// A model.
#[derive(Debug, Clone, Default)]
pub struct Model {
    /// Version as stated.
    pub version: String,
    /// Program that wrote it.
    pub application: String,
    /// Relations.
    pub relations: Vec<Relation>,
    /// Components.
    pub components: Vec<Component>,
    /// Load spectra.
    pub spectra: Vec<LoadSpectrum>,
    /// Elements that the format does not know, as words.
    pub unknown: Vec<String>,
    /// Places of components by their numbers, made when the first one is asked for.
    pub places: OnceLock<HashMap<i64, usize>>,
}

/// A component.
#[derive(Debug, Clone)]
pub struct Component {
    /// Number.
    pub id: i64,
    /// Type: `shaft`, `cylindrical_gear` and so on.
    pub kind: String,
    /// Name, may be empty.
    pub name: String,
    /// Attributes.
    pub attributes: Vec<Attribute>,
}

impl Component {
    /// Words for messages: type, number, name.
    pub fn words(&self) -> String {
        if self.name.is_empty() {
            format!("{} {}", self.kind, self.id)
        } else {
            format!("{} {} `{}`", self.kind, self.id, self.name)
        }
    }

    /// Its name, or another one where it has none.
    pub fn name_or<'a>(&'a self, other: &'a str) -> &'a str {
        match self.name.is_empty() {
            true => other,
            false => &self.name,
        }
    }

    /// An attribute.
    pub fn attribute(&self, id: &str) -> Option<&Attribute> {
        effort::each(self.attributes.iter()).find(|a| a.id == id)
    }

    /// The error of an attribute that cannot be used.
    pub fn wrong(
        &self,
        attribute: &str,
        found: impl Into<String>,
        allowed: impl Into<String>,
    ) -> RexsError {
        RexsError::Attribute {
            line: self.attribute(attribute).and_then(|a| a.line),
            component: self.words(),
            attribute: attribute.to_owned(),
            found: found.into(),
            allowed: allowed.into(),
        }
    }

    /// The error of a component that lacks what a gearbox cannot do without.
    pub fn lacks(&self, what: impl Into<String>) -> RexsError {
        RexsError::Missing {
            component: self.words(),
            what: what.into(),
        }
    }
}

/// An attribute.
#[derive(Debug, Clone)]
pub struct Attribute {
    /// Name.
    pub id: String,
    /// Unit; empty where not given.
    pub unit: String,
    /// Value.
    pub value: Value,
    /// Line in the text, where known.
    pub line: Option<u32>,
}

/// A value, as text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Value {
    /// One value.
    Scalar(String),
    /// An array.
    List(Vec<String>),
    /// A matrix, or an array of arrays.
    Rows(Vec<Vec<String>>),
}

impl Value {
    /// Nothing in it.
    pub fn is_empty(&self) -> bool {
        match self {
            Self::Scalar(text) => text.trim().is_empty(),
            Self::List(items) => items.iter().all(|item| item.trim().is_empty()),
            Self::Rows(rows) => rows.iter().flatten().all(|item| item.trim().is_empty()),
        }
    }

    /// Whether all of it says that there is no value, as programs write numbers that they have not computed: `NaN` in
    /// any letters.
    pub fn is_nan(&self) -> bool {
        let nan = |text: &String| text.trim().eq_ignore_ascii_case("nan");
        match self {
            Self::Scalar(text) => nan(text),
            Self::List(items) => !items.is_empty() && items.iter().all(nan),
            Self::Rows(rows) => {
                let mut all = rows.iter().flatten().peekable();
                all.peek().is_some() && all.all(nan)
            }
        }
    }
}

/// A relation between components.
#[derive(Debug, Clone)]
pub struct Relation {
    /// Number.
    pub id: i64,
    /// Type: `assembly`, `stage` and so on.
    pub kind: String,
    /// Place among relations of its kind.
    pub order: Option<i64>,
    /// The components and their roles.
    pub references: Vec<Reference>,
}

impl Relation {
    /// The component in a role.
    pub fn role(&self, roles: &[&str]) -> Option<i64> {
        let found = effort::each(self.references.iter()).find(|r| roles.contains(&r.role.as_str()));
        found.map(|r| r.id)
    }

    /// Whether a component takes part.
    pub fn names(&self, id: i64) -> bool {
        effort::each(self.references.iter()).any(|r| r.id == id)
    }
}

/// A component in a relation.
#[derive(Debug, Clone)]
pub struct Reference {
    /// The component's number.
    pub id: i64,
    /// Its role.
    pub role: String,
}

/// A load spectrum.
#[derive(Debug, Clone)]
pub struct LoadSpectrum {
    /// Number.
    pub id: i64,
    /// Load cases.
    pub cases: Vec<LoadCase>,
    /// What other programs have summed up over the cases.
    pub accumulation: Vec<Component>,
}

/// A load case: attributes that go before those of the components.
#[derive(Debug, Clone)]
pub struct LoadCase {
    /// Number.
    pub id: i64,
    /// The components, of their attributes those of this case.
    pub components: Vec<Component>,
}

impl Model {
    /// A component.
    pub fn component(&self, id: i64) -> Option<&Component> {
        let places = self.places.get_or_init(|| {
            let mut places = HashMap::new();
            for (place, component) in self.components.iter().enumerate() {
                places.entry(component.id).or_insert(place);
            }
            places
        });
        effort::visited(1);
        places.get(&id).map(|&place| &self.components[place])
    }

    /// Components of some types, in the order of the file.
    pub fn of_kind<'a>(&'a self, kinds: &'a [&str]) -> impl Iterator<Item = &'a Component> {
        let wanted = move |c: &&Component| kinds.contains(&c.kind.as_str());
        effort::each(self.components.iter()).filter(wanted)
    }

    /// The model in a load case.
    pub fn in_case(&self, case: &LoadCase) -> Self {
        let mut model = self.clone();
        let places: HashMap<i64, usize> = (self.components.iter().enumerate().rev())
            .map(|(i, c)| (c.id, i))
            .collect();
        for change in &case.components {
            let Some(&place) = places.get(&change.id) else {
                continue;
            };
            let component = &mut model.components[place];
            let new: HashSet<&str> = change.attributes.iter().map(|a| a.id.as_str()).collect();
            component
                .attributes
                .retain(|a| !new.contains(a.id.as_str()));
            // The last one of a name counts.
            let mut last: HashMap<&str, usize> = HashMap::new();
            for (i, a) in change.attributes.iter().enumerate() {
                last.insert(&a.id, i);
            }
            for (i, a) in change.attributes.iter().enumerate() {
                if last.get(a.id.as_str()) == Some(&i) {
                    component.attributes.push(a.clone());
                }
            }
        }
        model
    }
}
