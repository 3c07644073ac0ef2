//! Values of a model with their units, and the list of what became of it. Whoever asks for an attribute leaves a trace:
//! what nobody has asked for is listed as not represented, so that nothing is dropped in silence.

use crate::effort;
use crate::error::{Result, RexsError};
use crate::ledger::{About, Ledger};
use crate::model::{Attribute, Component, Model, Value};
use crate::structure::Structure;
use crate::units::{self, Unit};
use crate::vectors::Frame;
use std::cell::{RefCell, RefMut};
use std::collections::{BTreeSet, HashMap};
use std::ops::Deref;

/// A model and the list of what became of it.
#[derive(Debug)]
pub struct Source<'a> {
    /// The model.
    pub model: &'a Model,
    /// Which component of it belongs to which.
    pub structure: &'a Structure,
    ledger: &'a RefCell<Ledger>,
    used: &'a RefCell<BTreeSet<(i64, String)>>,
    /// Frames that are known.
    frames: RefCell<HashMap<i64, Frame>>,
}

impl<'a> Source<'a> {
    /// A model whose values go to a list.
    pub fn new(
        model: &'a Model,
        structure: &'a Structure,
        ledger: &'a RefCell<Ledger>,
        used: &'a RefCell<BTreeSet<(i64, String)>>,
    ) -> Self {
        Self {
            model,
            structure,
            ledger,
            used,
            frames: RefCell::default(),
        }
    }

    /// A frame that was found before.
    pub fn frame(&self, component: i64) -> Option<Frame> {
        self.frames.borrow().get(&component).copied()
    }

    /// Keeps a frame that was found.
    pub fn keep_frame(&self, component: i64, frame: Frame) {
        self.frames.borrow_mut().insert(component, frame);
    }

    /// The list, for what is no component's.
    pub fn ledger(&self) -> RefMut<'_, Ledger> {
        self.ledger.borrow_mut()
    }

    /// A component of the model.
    pub fn part(&self, id: i64) -> Option<Part<'_>> {
        self.model.component(id).map(|found| Part::new(self, found))
    }

    /// Components of some types, in the order of the file.
    pub fn of_kind<'s>(&'s self, kinds: &'s [&str]) -> impl Iterator<Item = Part<'s>> {
        let found = self.model.of_kind(kinds);
        found.map(|component| Part::new(self, component))
    }

    /// Something was assumed of the component of that number, where the file has it.
    pub fn assume_of(&self, id: i64, about: About, text: impl Into<String>) {
        if let Some(part) = self.part(id) {
            part.assume(about, text);
        }
    }

    /// Somebody has asked for an attribute of a component.
    pub fn mark_used(&self, component: i64, attribute: &str) {
        let mut used = self.used.borrow_mut();
        used.insert((component, attribute.to_owned()));
    }

    /// Lists what nobody has asked for.
    pub fn list_unused(&self) {
        let used = self.used.borrow();
        for component in effort::each(self.model.components.iter()) {
            let unused = component
                .attributes
                .iter()
                .filter(|a| !used.contains(&(component.id, a.id.clone())));
            for a in unused {
                let value = match &a.value {
                    Value::Scalar(text) if text.is_empty() => "empty".to_owned(),
                    Value::Scalar(text) => text.chars().take(60).collect(),
                    Value::List(items) if items.len() <= 4 => format!("[{}]", items.join(", ")),
                    Value::List(items) => format!("{} values", items.len()),
                    Value::Rows(rows) => format!("{} rows", rows.len()),
                };
                let text = format!("{} {value} {}", a.id, a.unit);
                let mut ledger = self.ledger.borrow_mut();
                ledger.leave_out_value(&component.words(), text.trim());
            }
        }
    }
}

/// What an infinite stiffness is read as, in the unit of the file: far above what stands for rigid.
const RIGID: f64 = 1e30;

/// Longer lengths and farther places are slips \[m\]: whole numbers count micrometres along a shaft, and ten
/// kilometres are below what they hold.
const LONGEST_M: f64 = 1e4;

/// The largest magnitude that a value of this unit may have, in that unit.
fn largest(unit: Unit) -> f64 {
    match unit.dimension {
        units::Dimension::Length => LONGEST_M / unit.si,
        _ => f64::INFINITY,
    }
}

/// A component whose values go to the list of its source.
#[derive(Debug, Clone, Copy)]
pub struct Part<'a> {
    /// The source.
    pub source: &'a Source<'a>,
    /// The component itself.
    pub component: &'a Component,
}

impl Deref for Part<'_> {
    type Target = Component;

    fn deref(&self) -> &Component {
        self.component
    }
}

impl<'a> Part<'a> {
    /// A component of a source.
    pub fn new(source: &'a Source<'a>, component: &'a Component) -> Self {
        Self { source, component }
    }

    /// Something was assumed.
    pub fn assume(&self, about: About, text: impl Into<String>) {
        self.source.ledger().assume(&self.words(), about, text);
    }

    /// Something is not represented.
    pub fn leave_out(&self, about: About, text: impl Into<String>) {
        self.source.ledger().leave_out(&self.words(), about, text);
    }

    /// A component's own value stands in a file.
    fn take(&self, text: impl Into<String>) {
        self.source.ledger().take(&self.words(), text);
    }

    /// Numbers of the components of some types that share a relation with it.
    pub fn partners(&self, kinds: &[&str]) -> Vec<i64> {
        self.source.structure.partners(self.id, kinds)
    }

    /// The components themselves.
    pub fn parts(&self, kinds: &[&str]) -> impl Iterator<Item = Self> + use<'a> {
        let (source, ids) = (self.source, self.partners(kinds));
        ids.into_iter().filter_map(|id| source.part(id))
    }

    /// Left and right flank of a gear.
    pub fn flanks(&self) -> [Option<Self>; 2] {
        let ids = self.source.structure.flanks(self.id);
        ids.map(|id| self.source.part(id?))
    }

    /// What stands inside and outside of a bearing or coupling: the two sides.
    pub fn sides(&self) -> Option<[i64; 2]> {
        self.source.structure.sides(self.id)
    }

    fn given(&self, id: &str) -> Option<&'a Attribute> {
        let attribute = self.component.attribute(id);
        let attribute = attribute.filter(|a| !a.value.is_empty())?;
        self.source.mark_used(self.id, id);
        if attribute.value.is_nan() {
            self.leave_out(About::Nothing, format!("{id} NaN: as if it were not given"));
            return None;
        }
        Some(attribute)
    }

    /// Whether a component has an attribute; asking does not use it.
    pub fn has(&self, id: &str) -> bool {
        let given = |a: &Attribute| !a.value.is_empty() && !a.value.is_nan();
        self.component.attribute(id).is_some_and(given)
    }

    /// Factor from the unit of the file to the wanted one, which is that of the schema, for files that leave it out.
    fn factor(&self, a: &Attribute, wanted: Unit) -> Result<f64> {
        let absent = a.unit.is_empty() || a.unit.eq_ignore_ascii_case("none");
        if absent && wanted.dimension != units::Dimension::One {
            self.assume(
                About::Nothing,
                format!("{}: no unit given, taken as {}", a.id, wanted.name),
            );
            return Ok(1.0);
        }
        if a.unit == wanted.name {
            return Ok(1.0);
        }
        let found = units::read(&a.unit).filter(|(dimension, _)| *dimension == wanted.dimension);
        found.map(|(_, si)| si / wanted.si).ok_or_else(|| {
            let found = format!("the unit is `{}`", a.unit);
            let allowed = format!("allowed are {}", units::names(wanted.dimension));
            self.wrong(&a.id, found, allowed)
        })
    }

    fn parsed(&self, a: &Attribute, text: &str) -> Result<f64> {
        let plain = text.trim();
        let comma = || match (plain.contains('.'), plain.matches(',').count()) {
            (false, 1) => plain.replace(',', ".").parse().ok(),
            _ => None,
        };
        let value: Option<f64> = plain.parse().ok().or_else(comma);
        // Rigid, as some programs write it.
        let rigid = |v: f64| a.id.ends_with("stiffness") && v == f64::INFINITY;
        let value = value.map(|v| if rigid(v) { RIGID } else { v });
        value.filter(|v| v.is_finite()).ok_or_else(|| {
            let found = format!("`{plain}` is no number");
            self.wrong(&a.id, found, "allowed is a finite number")
        })
    }

    /// The value, unless its magnitude is above `most`, in the same unit.
    fn up_to(&self, id: &str, value: f64, unit: Unit, most: f64) -> Result<f64> {
        if value.abs() > most {
            let found = format!("{value:e} {}", unit.name);
            let allowed = format!("allowed is up to {most:e} {}", unit.name);
            return Err(self.wrong(id, found, allowed));
        }
        Ok(value)
    }

    /// A number in a unit; none where the attribute is missing or empty.
    ///
    /// # Errors
    /// [`RexsError::Attribute`] for another unit or no number.
    pub fn number(&self, id: &str, unit: Unit) -> Result<Option<f64>> {
        let Some(a) = self.given(id) else {
            return Ok(None);
        };
        let text = match &a.value {
            Value::Scalar(text) => text,
            Value::List(items) if items.len() == 1 => &items[0],
            _ => return Err(self.wrong(id, "an array", "allowed is one number")),
        };
        let value = self.parsed(a, text)? * self.factor(a, unit)?;
        let value = self.up_to(id, value, unit, largest(unit))?;
        self.take(format!("{id} {text} {}", a.unit).trim());
        Ok(Some(value))
    }

    /// A number above 0; none where the file says another one or none.
    ///
    /// # Errors
    /// As of [`Self::number`].
    pub fn positive(&self, id: &str, unit: Unit) -> Result<Option<f64>> {
        Ok(self.number(id, unit)?.filter(|x| *x > 0.0))
    }

    /// The first of some attributes that is given.
    ///
    /// # Errors
    /// As of [`Self::number`].
    pub fn first_of(&self, ids: &[&str], unit: Unit) -> Result<Option<f64>> {
        for id in ids {
            if let Some(value) = self.number(id, unit)? {
                return Ok(Some(value));
            }
        }
        Ok(None)
    }

    /// Places along u of the two sides of a bearing or coupling \[mm\].
    ///
    /// # Errors
    /// As of [`Self::number`].
    pub fn places_mm(&self) -> Result<[Option<f64>; 2]> {
        Ok([
            self.number("u_coordinate_on_shaft_inner_side", units::MM)?,
            self.number("u_coordinate_on_shaft_outer_side", units::MM)?,
        ])
    }

    /// A number of a size that machines have.
    ///
    /// # Errors
    /// As of [`Self::number`], and for a larger one.
    pub fn number_up_to(&self, id: &str, unit: Unit, most: f64) -> Result<Option<f64>> {
        let value = self.number(id, unit)?;
        value
            .map(|value| self.up_to(id, value, unit, most))
            .transpose()
    }

    /// A number that must be there.
    ///
    /// # Errors
    /// [`RexsError::Missing`] beside those of [`Self::number`].
    pub fn need(&self, id: &str, unit: Unit) -> Result<f64> {
        self.number(id, unit)?
            .ok_or_else(|| self.lacks(format!("{id} is missing")))
    }

    /// A list of numbers.
    ///
    /// # Errors
    /// As of [`Self::number`].
    pub fn list(&self, id: &str, unit: Unit) -> Result<Option<Vec<f64>>> {
        let Some(a) = self.given(id) else {
            return Ok(None);
        };
        let split: Vec<&str> = match &a.value {
            // `0,0,1` and `0; 0; 1` in one text are lists, too.
            Value::Scalar(text) => {
                let all = text.split([';', ' ', ',']);
                all.filter(|part| !part.is_empty()).collect()
            }
            Value::List(items) => items.iter().map(String::as_str).collect(),
            Value::Rows(rows) => rows.iter().flatten().map(String::as_str).collect(),
        };
        let factor = self.factor(a, unit)?;
        let values = split.iter().map(|t| {
            let value = self.parsed(a, t)? * factor;
            self.up_to(id, value, unit, largest(unit))
        });
        let values: Result<Vec<f64>> = values.collect();
        self.take(format!("{id} [{}] {}", split.join(", "), a.unit).trim());
        values.map(Some)
    }

    /// Three numbers.
    ///
    /// # Errors
    /// [`RexsError::Attribute`] for another count.
    pub fn vector(&self, id: &str) -> Result<Option<[f64; 3]>> {
        let values = self.list(id, units::MM);
        let Some(values) = values.map_err(|cause| match cause {
            RexsError::Attribute { found, .. } if found.ends_with("is no number") => {
                let allowed =
                    "allowed are three numbers, along the axes of its reference component";
                self.wrong(id, found, allowed)
            }
            other => other,
        })?
        else {
            return Ok(None);
        };
        match values.as_slice() {
            &[x, y, z] => Ok(Some([x, y, z])),
            _ => {
                let found = format!("{} numbers", values.len());
                Err(self.wrong(id, found, "allowed are three"))
            }
        }
    }

    /// A text.
    pub fn text(&self, id: &str) -> Option<String> {
        let a = self.given(id)?;
        let Value::Scalar(text) = &a.value else {
            return None;
        };
        self.take(format!("{id} {text}"));
        Some(text.trim().to_owned())
    }

    /// A whole number.
    ///
    /// # Errors
    /// As of [`Self::number`].
    pub fn integer(&self, id: &str) -> Result<Option<i64>> {
        let Some(value) = self.number(id, units::ONE)? else {
            return Ok(None);
        };
        if value.fract() != 0.0 || value.abs() > 1e9 {
            return Err(self.wrong(id, format!("`{value}`"), "allowed is a whole number"));
        }
        Ok(Some(value as i64))
    }

    /// A yes or no; `true`, `1`, `yes`, `ja` and their opposites.
    ///
    /// # Errors
    /// [`RexsError::Attribute`] for another word.
    pub fn flag(&self, id: &str) -> Result<Option<bool>> {
        let Some(text) = self.text(id) else {
            return Ok(None);
        };
        match text.to_lowercase().as_str() {
            "true" | "1" | "1.0" | "yes" | "ja" | "wahr" => Ok(Some(true)),
            "false" | "0" | "0.0" | "no" | "nein" | "falsch" => Ok(Some(false)),
            _ => Err(self.wrong(id, format!("`{text}`"), "allowed are true and false")),
        }
    }
}
