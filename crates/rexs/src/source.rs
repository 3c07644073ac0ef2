//! Values of a model with their units. Whoever asks for an attribute leaves a trace: what nobody has asked for is listed as
//! not represented, so that nothing is dropped in silence.

use crate::effort;
use crate::error::RexsError;
use crate::ledger::{About, Ledger};
use crate::model::{Attribute, Component, Model, Value};
use crate::placement::Frame;
use crate::units::{self, Unit};
use std::cell::{RefCell, RefMut};
use std::collections::{BTreeSet, HashMap};

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

/// A model and the list of what became of it.
#[derive(Debug)]
pub struct Source<'a> {
    /// The model.
    pub model: &'a Model,
    ledger: &'a RefCell<Ledger>,
    used: &'a RefCell<BTreeSet<(i64, String)>>,
    /// Frames that are known.
    frames: RefCell<HashMap<i64, Frame>>,
}

impl<'a> Source<'a> {
    /// A model whose values go to a list.
    pub fn new(
        model: &'a Model,
        ledger: &'a RefCell<Ledger>,
        used: &'a RefCell<BTreeSet<(i64, String)>>,
    ) -> Self {
        Self {
            model,
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

    /// Something was assumed.
    pub fn assume(&self, component: &Component, about: About, text: impl Into<String>) {
        self.ledger
            .borrow_mut()
            .assume(&component.words(), about, text);
    }

    /// Something is not represented.
    pub fn leave_out(&self, component: &Component, about: About, text: impl Into<String>) {
        self.ledger
            .borrow_mut()
            .leave_out(&component.words(), about, text);
    }

    /// [`Self::assume`] of the component of that number, where the file has it.
    pub fn assume_of(&self, id: i64, about: About, text: impl Into<String>) {
        if let Some(component) = self.model.component(id) {
            self.assume(component, about, text);
        }
    }

    /// A component's own value stands in a file.
    pub fn take(&self, component: &Component, text: impl Into<String>) {
        self.ledger.borrow_mut().take(&component.words(), text);
    }

    fn attribute<'c>(&self, component: &'c Component, id: &str) -> Option<&'c Attribute> {
        let attribute = component.attribute(id).filter(|a| !a.value.is_empty())?;
        if attribute.value.is_nan() {
            self.leave_out(
                component,
                About::Nothing,
                format!("{id} NaN: as if it were not given"),
            );
            self.used.borrow_mut().insert((component.id, id.to_owned()));
            return None;
        }
        self.used.borrow_mut().insert((component.id, id.to_owned()));
        Some(attribute)
    }

    /// Whether a component has an attribute; asking does not use it.
    pub fn has(&self, component: &Component, id: &str) -> bool {
        let given = |a: &Attribute| !a.value.is_empty() && !a.value.is_nan();
        component.attribute(id).is_some_and(given)
    }

    /// Factor from the unit of the file to the wanted one, which is that of the schema, for files that leave it out.
    fn factor(&self, component: &Component, a: &Attribute, wanted: Unit) -> Result<f64, RexsError> {
        let absent = a.unit.is_empty() || a.unit.eq_ignore_ascii_case("none");
        if absent && wanted.dimension != units::Dimension::One {
            self.assume(
                component,
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
            component.wrong(&a.id, found, allowed)
        })
    }

    fn parsed(&self, component: &Component, a: &Attribute, text: &str) -> Result<f64, RexsError> {
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
            component.wrong(&a.id, found, "allowed is a finite number")
        })
    }

    /// The value, unless its magnitude is above `most`, in the same unit.
    fn up_to(
        &self,
        component: &Component,
        a: &Attribute,
        value: f64,
        unit: Unit,
        most: f64,
    ) -> Result<f64, RexsError> {
        if value.abs() > most {
            let found = format!("{value:e} {}", unit.name);
            let allowed = format!("allowed is up to {most:e} {}", unit.name);
            return Err(component.wrong(&a.id, found, allowed));
        }
        Ok(value)
    }

    /// A number in a unit; none where the attribute is missing or empty.
    ///
    /// # Errors
    /// [`RexsError::Attribute`] for another unit or no number.
    pub fn number(
        &self,
        component: &Component,
        id: &str,
        unit: Unit,
    ) -> Result<Option<f64>, RexsError> {
        let Some(a) = self.attribute(component, id) else {
            return Ok(None);
        };
        let text = match &a.value {
            Value::Scalar(text) => text,
            Value::List(items) if items.len() == 1 => &items[0],
            _ => return Err(component.wrong(id, "an array", "allowed is one number")),
        };
        let value = self.parsed(component, a, text)? * self.factor(component, a, unit)?;
        let value = self.up_to(component, a, value, unit, largest(unit))?;
        self.take(
            component,
            format!("{id} {text} {}", a.unit).trim().to_owned(),
        );
        Ok(Some(value))
    }

    /// A number above 0; none where the file says another one or none.
    ///
    /// # Errors
    /// As of [`Self::number`].
    pub fn positive(
        &self,
        component: &Component,
        id: &str,
        unit: Unit,
    ) -> Result<Option<f64>, RexsError> {
        Ok(self.number(component, id, unit)?.filter(|x| *x > 0.0))
    }

    /// A number of a size that machines have.
    ///
    /// # Errors
    /// As of [`Self::number`], and for a larger one.
    pub fn number_up_to(
        &self,
        component: &Component,
        id: &str,
        unit: Unit,
        most: f64,
    ) -> Result<Option<f64>, RexsError> {
        let value = self.number(component, id, unit)?;
        let given = component.attribute(id).zip(value);
        given
            .map(|(a, value)| self.up_to(component, a, value, unit, most))
            .transpose()
    }

    /// A number that must be there.
    ///
    /// # Errors
    /// [`RexsError::Missing`] beside those of [`Self::number`].
    pub fn need(&self, component: &Component, id: &str, unit: Unit) -> Result<f64, RexsError> {
        self.number(component, id, unit)?
            .ok_or_else(|| component.lacks(format!("{id} is missing")))
    }

    /// A list of numbers.
    ///
    /// # Errors
    /// As of [`Self::number`].
    pub fn list(
        &self,
        component: &Component,
        id: &str,
        unit: Unit,
    ) -> Result<Option<Vec<f64>>, RexsError> {
        let Some(a) = self.attribute(component, id) else {
            return Ok(None);
        };
        let texts: Vec<&String> = match &a.value {
            Value::Scalar(text) => vec![text],
            Value::List(items) => items.iter().collect(),
            Value::Rows(rows) => rows.iter().flatten().collect(),
        };
        // `0,0,1` and `0; 0; 1` in one text are lists, too.
        let split: Vec<&str> = match (&a.value, texts.first()) {
            (Value::Scalar(_), Some(text)) => text
                .split([';', ' ', ','])
                .filter(|part| !part.is_empty())
                .collect(),
            _ => texts.iter().map(|text| text.as_str()).collect(),
        };
        let factor = self.factor(component, a, unit)?;
        let values: Result<Vec<f64>, _> = split
            .iter()
            .map(|t| {
                let value = self.parsed(component, a, t)? * factor;
                self.up_to(component, a, value, unit, largest(unit))
            })
            .collect();
        self.take(
            component,
            format!("{id} [{}] {}", split.join(", "), a.unit)
                .trim()
                .to_owned(),
        );
        values.map(Some)
    }

    /// Three numbers.
    ///
    /// # Errors
    /// [`RexsError::Attribute`] for another count.
    pub fn vector(&self, component: &Component, id: &str) -> Result<Option<[f64; 3]>, RexsError> {
        let values = self.list(component, id, units::MM);
        let Some(values) = values.map_err(|cause| match cause {
            RexsError::Attribute { found, .. } if found.ends_with("is no number") => {
                let allowed =
                    "allowed are three numbers, along the axes of its reference component";
                component.wrong(id, found, allowed)
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
                Err(component.wrong(id, found, "allowed are three"))
            }
        }
    }

    /// A text.
    pub fn text(&self, component: &Component, id: &str) -> Option<String> {
        let a = self.attribute(component, id)?;
        let Value::Scalar(text) = &a.value else {
            return None;
        };
        self.take(component, format!("{id} {text}"));
        Some(text.trim().to_owned())
    }

    /// A whole number.
    ///
    /// # Errors
    /// As of [`Self::number`].
    pub fn integer(&self, component: &Component, id: &str) -> Result<Option<i64>, RexsError> {
        let Some(value) = self.number(component, id, units::ONE)? else {
            return Ok(None);
        };
        if value.fract() != 0.0 || value.abs() > 1e9 {
            return Err(component.wrong(id, format!("`{value}`"), "allowed is a whole number"));
        }
        Ok(Some(value as i64))
    }

    /// A yes or no; `true`, `1`, `yes`, `ja` and their opposites.
    ///
    /// # Errors
    /// [`RexsError::Attribute`] for another word.
    pub fn flag(&self, component: &Component, id: &str) -> Result<Option<bool>, RexsError> {
        let Some(text) = self.text(component, id) else {
            return Ok(None);
        };
        match text.to_lowercase().as_str() {
            "true" | "1" | "1.0" | "yes" | "ja" | "wahr" => Ok(Some(true)),
            "false" | "0" | "0.0" | "no" | "nein" | "falsch" => Ok(Some(false)),
            _ => Err(component.wrong(id, format!("`{text}`"), "allowed are true and false")),
        }
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
