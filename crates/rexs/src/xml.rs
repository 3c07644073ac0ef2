//! Models in XML (`.rexs`).

use crate::error::{Result, RexsError};
use crate::model::{
    Attribute, Component, LoadCase, LoadSpectrum, Model, Reference, Relation, Value,
};
use base64::Engine;
use roxmltree::{Document, Node, ParsingOptions};

/// Elements below each other; a REXS file has seven.
const DEEPEST: usize = 64;

/// Reads a model.
///
/// # Errors
/// [`RexsError::Syntax`] with the line.
pub fn read(text: &str) -> Result<Model> {
    demand_shallow(text)?;
    // A document type with its entities is refused by the parser: the format has none.
    let options = ParsingOptions {
        allow_dtd: false,
        nodes_limit: 20_000_000,
        ..ParsingOptions::default()
    };
    let document =
        Document::parse_with_options(text, options).map_err(|cause| broken(text, &cause))?;
    let root = document.root_element();
    if root.tag_name().name() != "model" {
        return Err(wrong(
            &root,
            "the outermost element of a REXS file is <model>".to_owned(),
        ));
    }
    let lines = Lines::of(text);
    let mut model = Model {
        version: root.attribute("version").unwrap_or_default().to_owned(),
        application: words(&[
            root.attribute("applicationId").unwrap_or_default(),
            root.attribute("applicationVersion").unwrap_or_default(),
        ]),
        ..Model::default()
    };
    for node in elements(root) {
        match node.tag_name().name() {
            "relations" => {
                for child in elements(node) {
                    match child.tag_name().name() {
                        "relation" => model.relations.push(relation(&child)?),
                        _ => model.unknown.push(unknown(&child, &lines)),
                    }
                }
            }
            "components" => model
                .components
                .extend(components(node, &lines, &mut model.unknown)?),
            "load_spectrum" => {
                let found = spectrum(&node, &lines, &mut model.unknown)?;
                model.spectra.push(found);
            }
            _ => model.unknown.push(unknown(&node, &lines)),
        }
    }
    Ok(model)
}

/// What the parser did not like. Of a text that ends too early it gives no place, of a document type neither place nor
/// name.
fn broken(text: &str, cause: &roxmltree::Error) -> RexsError {
    let line_of = |at: usize| text[..at].matches('\n').count() as u32 + 1;
    match cause {
        roxmltree::Error::DtdDetected => {
            let at = text.find("<!DOCTYPE").unwrap_or(0);
            let end = text[at..].find(['>', '[', '\n']).unwrap_or(0);
            let what = format!(
                "a document type (`{}`): REXS files have none, and what it may name is not read. Take it out",
                text[at..at + end].trim_end()
            );
            RexsError::syntax(Some(line_of(at)), what)
        }
        roxmltree::Error::UnexpectedEndOfStream | roxmltree::Error::UnclosedRootNode => {
            let end = text.trim_end().len();
            let last = text[..end].rsplit('\n').next().unwrap_or_default().trim();
            let last: String = last.chars().take(80).collect();
            let what = format!(
                "broken XML: the text ends here, before </model>: `{last}`. Part of the file is missing"
            );
            RexsError::syntax(Some(line_of(end)), what)
        }
        other => RexsError::syntax(Some(other.pos().row), format!("broken XML: {other}")),
    }
}

/// Refuses text that nests deeper than any model before the parser, which calls itself for each level, sees it.
fn demand_shallow(text: &str) -> Result<()> {
    let bytes = text.as_bytes();
    let mut depth = 0_usize;
    for (at, &byte) in bytes.iter().enumerate() {
        let next = bytes.get(at + 1).copied().unwrap_or(b'>');
        if byte == b'<' && next == b'/' {
            depth = depth.saturating_sub(1);
        } else if byte == b'<' && next != b'!' && next != b'?' {
            depth += 1;
        } else if byte == b'/' && next == b'>' {
            depth = depth.saturating_sub(1);
        }
        if depth > DEEPEST {
            let line = bytes[..at].iter().filter(|&&b| b == b'\n').count() as u32 + 1;
            let what = format!(
                "elements stand more than {DEEPEST} deep in each other; a REXS file has seven levels"
            );
            return Err(RexsError::syntax(Some(line), what));
        }
    }
    Ok(())
}

fn elements<'a, 'i>(node: Node<'a, 'i>) -> impl Iterator<Item = Node<'a, 'i>> {
    node.children().filter(Node::is_element)
}

fn line(node: &Node<'_, '_>) -> u32 {
    node.document().text_pos_at(node.range().start).row
}

fn wrong(node: &Node<'_, '_>, what: String) -> RexsError {
    RexsError::syntax(
        Some(line(node)),
        format!("<{}>: {what}", node.tag_name().name()),
    )
}

fn unknown(node: &Node<'_, '_>, lines: &Lines) -> String {
    format!(
        "element <{}> in line {}",
        node.tag_name().name(),
        lines.at(node)
    )
}

/// Where each line ends: the parser itself counts from the beginning of the text for each place that it is asked for.
struct Lines(Vec<usize>);

impl Lines {
    fn of(text: &str) -> Self {
        let ends = text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n');
        Self(ends.map(|(at, _)| at).collect())
    }

    /// The line of a node, from 1.
    fn at(&self, node: &Node<'_, '_>) -> u32 {
        let start = node.range().start;
        self.0.partition_point(|end| *end < start) as u32 + 1
    }
}

/// Texts with a space between, without empty ones.
pub fn words(texts: &[&str]) -> String {
    let filled: Vec<&str> = texts
        .iter()
        .map(|t| t.trim())
        .filter(|t| !t.is_empty())
        .collect();
    filled.join(" ")
}

fn number(node: &Node<'_, '_>, name: &str) -> Result<i64> {
    let Some(text) = node.attribute(name) else {
        return Err(wrong(
            node,
            format!("`{name}` is missing; it is a whole number"),
        ));
    };
    let found = text.trim().parse();
    found.map_err(|_| {
        wrong(
            node,
            format!("`{name}` is `{text}`; allowed is a whole number"),
        )
    })
}

fn relation(node: &Node<'_, '_>) -> Result<Relation> {
    let references = elements(*node).map(|child| {
        Ok(Reference {
            id: number(&child, "id")?,
            role: child.attribute("role").unwrap_or_default().to_owned(),
        })
    });
    Ok(Relation {
        // A missing number of a relation harms nobody.
        id: number(node, "id").unwrap_or(0),
        kind: node.attribute("type").unwrap_or_default().to_owned(),
        order: node
            .attribute("order")
            .and_then(|text| text.trim().parse().ok()),
        references: references.collect::<Result<_>>()?,
    })
}

fn components(
    node: Node<'_, '_>,
    lines: &Lines,
    unread: &mut Vec<String>,
) -> Result<Vec<Component>> {
    let mut found = Vec::new();
    for child in elements(node) {
        if child.tag_name().name() != "component" {
            unread.push(unknown(&child, lines));
            continue;
        }
        let mut attributes = Vec::new();
        for a in elements(child) {
            if a.tag_name().name() == "attribute" {
                attributes.push(attribute(&a, lines)?);
            } else {
                unread.push(unknown(&a, lines));
            }
        }
        found.push(Component {
            id: number(&child, "id")?,
            kind: child
                .attribute("type")
                .unwrap_or_default()
                .trim()
                .to_owned(),
            name: child
                .attribute("name")
                .unwrap_or_default()
                .trim()
                .to_owned(),
            attributes,
        });
    }
    Ok(found)
}

fn attribute(node: &Node<'_, '_>, lines: &Lines) -> Result<Attribute> {
    let Some(id) = node.attribute("id") else {
        return Err(wrong(
            node,
            "`id`, the attribute's name, is missing".to_owned(),
        ));
    };
    let value = match elements(*node).next() {
        None => Value::Scalar(text_of(node)),
        Some(child) => match child.tag_name().name() {
            "array" => Value::List(array(&child)?),
            "matrix" => Value::Rows(matrix(&child)?),
            "array_of_arrays" => Value::Rows(
                elements(child)
                    .map(|a| array(&a))
                    .collect::<Result<_, _>>()?,
            ),
            other => {
                let what = format!(
                    "<{other}> is no value; allowed are text, <array>, <matrix>, <array_of_arrays>"
                );
                return Err(wrong(node, what));
            }
        },
    };
    Ok(Attribute {
        id: id.trim().to_owned(),
        unit: node.attribute("unit").unwrap_or_default().trim().to_owned(),
        value,
        line: Some(lines.at(node)),
    })
}

/// Text of an element, comments left out.
fn text_of(node: &Node<'_, '_>) -> String {
    let parts = node.children().filter(Node::is_text);
    let text: String = parts.filter_map(|part| part.text()).collect();
    text.trim().to_owned()
}

fn cells(node: Node<'_, '_>) -> Vec<String> {
    elements(node).map(|c| text_of(&c)).collect()
}

fn array(node: &Node<'_, '_>) -> Result<Vec<String>> {
    match node.attribute("code") {
        None => Ok(cells(*node)),
        Some(code) => decoded(code, &text_of(node)).map_err(|what| wrong(node, what)),
    }
}

fn matrix(node: &Node<'_, '_>) -> Result<Vec<Vec<String>>> {
    let Some(code) = node.attribute("code") else {
        return Ok(elements(*node).map(cells).collect());
    };
    let values = decoded(code, &text_of(node)).map_err(|what| wrong(node, what))?;
    // The grammar lets either be left out.
    let count = |name: &str| -> Result<usize> {
        Ok(usize::try_from(number(node, name)?).unwrap_or(0).max(1))
    };
    let columns = match (node.has_attribute("columns"), node.has_attribute("rows")) {
        (false, true) => values.len().div_ceil(count("rows")?).max(1),
        _ => count("columns")?,
    };
    Ok(values.chunks(columns).map(<[String]>::to_vec).collect())
}

/// Numbers that are written as base64 of their little endian bytes.
///
/// # Errors
/// What was found and what is allowed.
pub fn decoded(code: &str, text: &str) -> Result<Vec<String>, String> {
    let packed: String = text.chars().filter(|c| !c.is_whitespace()).collect();
    let bytes = base64::engine::general_purpose::STANDARD_NO_PAD
        .decode(packed.trim_end_matches('='))
        .map_err(|cause| format!("a coded array is no base64 text: {cause}"))?;
    let width = match code {
        "int32" | "float32" => 4,
        "float64" => 8,
        other => {
            return Err(format!(
                "code is `{other}`; allowed are int32, float32, float64"
            ));
        }
    };
    if bytes.len() % width != 0 {
        return Err(format!(
            "a coded array of {code} has {} bytes, no multiple of {width}",
            bytes.len()
        ));
    }
    let one = |item: &[u8]| match (code, item) {
        ("int32", &[a, b, c, d]) => i32::from_le_bytes([a, b, c, d]).to_string(),
        ("float32", &[a, b, c, d]) => f32::from_le_bytes([a, b, c, d]).to_string(),
        (_, &[a, b, c, d, e, f, g, h]) => f64::from_le_bytes([a, b, c, d, e, f, g, h]).to_string(),
        _ => String::new(),
    };
    Ok(bytes.chunks_exact(width).map(one).collect())
}

fn spectrum(node: &Node<'_, '_>, lines: &Lines, unread: &mut Vec<String>) -> Result<LoadSpectrum> {
    let mut found = LoadSpectrum {
        id: number(node, "id").unwrap_or(1),
        cases: Vec::new(),
        accumulation: Vec::new(),
    };
    for child in elements(*node) {
        match child.tag_name().name() {
            "load_case" => found.cases.push(LoadCase {
                id: number(&child, "id")?,
                components: components(child, lines, unread)?,
            }),
            "accumulation" => found.accumulation = components(child, lines, unread)?,
            _ => unread.push(unknown(&child, lines)),
        }
    }
    Ok(found)
}
