//! Models in JSON (`.rexsj`): the same tree, a value under the name of its type.

use crate::error::{Result, RexsError};
use crate::model::{
    Attribute, Component, LoadCase, LoadSpectrum, Model, Reference, Relation, Value,
};
use crate::xml::{decoded, words};
use serde_json::Value as Json;
use std::sync::OnceLock;

/// Reads a model.
///
/// # Errors
/// [`RexsError::Syntax`], with the line where the text is no JSON.
pub fn read(text: &str) -> Result<Model> {
    let root: Json = serde_json::from_str(text).map_err(|cause| {
        RexsError::syntax(Some(cause.line() as u32), format!("broken JSON: {cause}"))
    })?;
    let Some(root) = root.get("model").filter(|m| m.is_object()) else {
        return Err(RexsError::syntax(
            None,
            "a REXS file in JSON is an object with the key `model`",
        ));
    };
    let mut spectra = Vec::new();
    match root.get("load_spectrum") {
        None | Some(Json::Null) => {}
        Some(Json::Array(all)) => {
            for one in all {
                spectra.push(spectrum(one)?);
            }
        }
        Some(one) => spectra.push(spectrum(one)?),
    }
    let known = [
        "version",
        "applicationId",
        "applicationVersion",
        "applicationLanguage",
        "date",
    ];
    let parts = ["relations", "components", "load_spectrum"];
    let keys = root
        .as_object()
        .into_iter()
        .flatten()
        .map(|(key, _)| key.as_str());
    let unknown = keys.filter(|key| !known.contains(key) && !parts.contains(key));
    Ok(Model {
        places: OnceLock::new(),
        version: text_of(root.get("version")),
        application: words(&[
            &text_of(root.get("applicationId")),
            &text_of(root.get("applicationVersion")),
        ]),
        relations: list(root, "relations")?
            .iter()
            .map(relation)
            .collect::<Result<_, _>>()?,
        components: components(root)?,
        spectra,
        unknown: unknown
            .map(|key| format!("key `{key}` of the model"))
            .collect(),
    })
}

fn list<'a>(node: &'a Json, key: &str) -> Result<&'a [Json]> {
    match node.get(key) {
        None | Some(Json::Null) => Ok(&[]),
        Some(Json::Array(items)) => Ok(items),
        Some(_) => Err(RexsError::syntax(None, format!("`{key}` is no list"))),
    }
}

/// Text of a value, whatever its type.
fn text_of(value: Option<&Json>) -> String {
    match value {
        None | Some(Json::Null) => String::new(),
        Some(Json::String(text)) => text.trim().to_owned(),
        Some(other) => other.to_string(),
    }
}

fn number(node: &Json, what: &str) -> Result<i64> {
    let id = node.get("id");
    let found = id.and_then(|id| id.as_i64().or_else(|| id.as_str()?.trim().parse().ok()));
    found.ok_or_else(|| {
        let found = text_of(id);
        RexsError::syntax(
            None,
            format!("the id of a {what} is `{found}`; allowed is a whole number"),
        )
    })
}

fn relation(node: &Json) -> Result<Relation> {
    let references = list(node, "refs")?.iter().map(|r| {
        Ok(Reference {
            id: number(r, "reference in a relation")?,
            role: text_of(r.get("role")),
        })
    });
    Ok(Relation {
        id: number(node, "relation").unwrap_or(0),
        kind: text_of(node.get("type")),
        order: node.get("order").and_then(Json::as_i64),
        references: references.collect::<Result<_>>()?,
    })
}

fn components(node: &Json) -> Result<Vec<Component>> {
    let one = |c: &Json| {
        let attributes = list(c, "attributes")?.iter().map(attribute);
        Ok(Component {
            id: number(c, "component")?,
            kind: text_of(c.get("type")),
            name: text_of(c.get("name")),
            attributes: attributes.collect::<Result<_, _>>()?,
        })
    };
    list(node, "components")?.iter().map(one).collect()
}

fn attribute(node: &Json) -> Result<Attribute> {
    let id = text_of(node.get("id"));
    if id.is_empty() {
        return Err(RexsError::syntax(
            None,
            "an attribute has no `id`, its name",
        ));
    }
    let entries = node.as_object().into_iter().flatten();
    let typed = entries.filter(|(key, _)| !["id", "unit"].contains(&key.as_str()));
    let value = match typed.into_iter().next() {
        None => Value::Scalar(String::new()),
        Some((key, value)) => of_type(key, value)
            .map_err(|what| RexsError::syntax(None, format!("attribute {id}: {what}")))?,
    };
    Ok(Attribute {
        id,
        unit: text_of(node.get("unit")),
        value,
        line: None,
    })
}

fn of_type(key: &str, value: &Json) -> Result<Value, String> {
    if key.ends_with("_coded") {
        let values = decoded(&text_of(value.get("code")), &text_of(value.get("value")))?;
        let columns = value.get("columns").and_then(Json::as_u64).unwrap_or(0) as usize;
        return Ok(match columns {
            0 => Value::List(values),
            n => Value::Rows(values.chunks(n).map(<[String]>::to_vec).collect()),
        });
    }
    let texts = |items: &[Json]| items.iter().map(|item| text_of(Some(item))).collect();
    Ok(match value {
        Json::Array(items) if items.iter().any(Json::is_array) => {
            let row = |item: &Json| texts(item.as_array().map_or(&[][..], Vec::as_slice));
            Value::Rows(items.iter().map(row).collect())
        }
        Json::Array(items) => Value::List(texts(items)),
        other => Value::Scalar(text_of(Some(other))),
    })
}

fn spectrum(node: &Json) -> Result<LoadSpectrum> {
    let case = |c: &Json| {
        Ok(LoadCase {
            id: number(c, "load case")?,
            components: components(c)?,
        })
    };
    Ok(LoadSpectrum {
        id: number(node, "load spectrum").unwrap_or(1),
        cases: list(node, "load_cases")?
            .iter()
            .map(case)
            .collect::<Result<_>>()?,
        accumulation: node
            .get("accumulation")
            .map_or(Ok(Vec::new()), components)?,
    })
}
