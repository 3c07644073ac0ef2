//! A plane mesh of quads coloured by a value.

use super::PageError;
use super::checks::{check_count, check_finite, check_finite_at, check_range, check_some};
use super::packed::{floats, shorts, words};
use super::typography::plain;
use serde_json::{Value, json};

/// Coordinates are stored as 16-bit steps of the mesh's larger extent: 2.4 µm for a gear of 155 mm.
const COORDINATE_STEPS: f64 = 65_535.0;

/// Share of the area that [`FieldPicture::colours_of_most`] shows in full, and how far above it a value must be to be
/// cut off: two thirds of the colours are left for all else otherwise.
const MOST_OF_AREA: f64 = 0.9;
const FAR_ABOVE: f64 = 1.5;

/// Values of the field.
#[derive(Debug, Clone, PartialEq)]
pub enum FieldValues {
    /// One for each node: colours run smoothly.
    PerNode(Vec<f64>),
    /// One for each quad: each quad has one colour.
    PerElement(Vec<f64>),
}

/// Part of the plane, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ViewWindow {
    /// Centre, mm.
    pub centre_mm: [f64; 2],
    /// Width that is seen, mm.
    pub width_mm: f64,
}

/// A place in a picture with words beside it.
#[derive(Debug, Clone, PartialEq)]
pub struct Mark {
    /// Place, mm.
    pub at_mm: [f64; 2],
    /// Words.
    pub words: String,
    /// What is drawn there.
    pub sign: MarkSign,
}

/// Sign of a mark.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MarkSign {
    /// A ring, the words above.
    Ring,
    /// A square, the words below.
    Square,
    /// The words alone.
    Words,
}

impl MarkSign {
    fn name(self) -> &'static str {
        match self {
            Self::Ring => "ring",
            Self::Square => "square",
            Self::Words => "words",
        }
    }
}

/// A picture of a field on a plane mesh: wheel or +/− to zoom, drag or arrows to move, value under the cursor, colour
/// bar with an upper end that the reader can change.
#[derive(Debug, Clone, PartialEq)]
pub struct FieldPicture {
    title: String,
    quantity: String,
    unit: String,
    nodes_mm: Vec<[f64; 2]>,
    quads: Vec<[u32; 4]>,
    values: FieldValues,
    colour_range: Option<[f64; 2]>,
    colours_of_most: bool,
    window: Option<ViewWindow>,
    shades: Vec<f64>,
    marks: Vec<Mark>,
}

impl FieldPicture {
    /// A picture without mesh; `quantity` names the value, `unit` its unit.
    pub fn new(
        title: impl Into<String>,
        quantity: impl Into<String>,
        unit: impl Into<String>,
    ) -> Self {
        Self {
            title: title.into(),
            quantity: quantity.into(),
            unit: unit.into(),
            nodes_mm: Vec::new(),
            quads: Vec::new(),
            values: FieldValues::PerElement(Vec::new()),
            colour_range: None,
            colours_of_most: false,
            window: None,
            shades: Vec::new(),
            marks: Vec::new(),
        }
    }

    /// Node coordinates in mm (y up) and the quads' corner nodes in cyclic order.
    #[must_use]
    pub fn mesh(mut self, nodes_mm: Vec<[f64; 2]>, quads: Vec<[u32; 4]>) -> Self {
        self.nodes_mm = nodes_mm;
        self.quads = quads;
        self
    }

    /// The values.
    #[must_use]
    pub fn values(mut self, values: FieldValues) -> Self {
        self.values = values;
        self
    }

    /// Ends of the colour scale; without it, from 0 (or the smallest value below 0) to the largest value. A stress
    /// field with a load that acts at a point needs an upper end.
    #[must_use]
    pub fn colour_range(mut self, low: f64, high: f64) -> Self {
        self.colour_range = Some([low, high]);
        self
    }

    /// The colour scale from 0 to the largest value, or, where a small part of the picture stands far above all else
    /// (an edge that carries alone), to what nine tenths of the area that has a value stay below: the bar then ends in
    /// ≥.
    #[must_use]
    pub fn colours_of_most(mut self) -> Self {
        self.colours_of_most = true;
        self
    }

    fn most_of_area(&self) -> f64 {
        let area = |quad: &[u32; 4]| {
            let [a, b, c, d] = quad.map(|node| self.nodes_mm[node as usize]);
            0.5 * ((c[0] - a[0]) * (d[1] - b[1]) - (d[0] - b[0]) * (c[1] - a[1])).abs()
        };
        let value = |k: usize, quad: &[u32; 4]| match &self.values {
            FieldValues::PerElement(values) => values[k],
            FieldValues::PerNode(values) => {
                quad.iter().map(|node| values[*node as usize]).sum::<f64>() / 4.0
            }
        };
        let cells = self.quads.iter().enumerate();
        let cells = cells.map(|(k, quad)| (value(k, quad), area(quad)));
        let mut cells: Vec<(f64, f64)> = cells.filter(|(value, _)| *value > 0.0).collect();
        cells.sort_by(|a, b| a.0.total_cmp(&b.0));
        let Some(largest) = cells.last().map(|cell| cell.0) else {
            return 0.0;
        };
        let whole: f64 = cells.iter().map(|cell| cell.1).sum();
        let mut below = 0.0;
        let most = cells.iter().find(|(_, area)| {
            below += area;
            below >= MOST_OF_AREA * whole
        });
        match most {
            Some((most, _)) if largest > FAR_ABOVE * most => *most,
            _ => largest,
        }
    }

    /// What is seen first; without it, the whole mesh.
    #[must_use]
    pub fn window(mut self, window: ViewWindow) -> Self {
        self.window = Some(window);
        self
    }

    /// The mesh is a body seen in space: how light each quad is, from 0 to 1. Later quads hide earlier ones, and what
    /// is hidden has no outline.
    #[must_use]
    pub fn shades(mut self, shades: Vec<f64>) -> Self {
        self.shades = shades;
        self
    }

    /// Adds a mark.
    #[must_use]
    pub fn mark(mut self, mark: Mark) -> Self {
        self.marks.push(mark);
        self
    }

    /// Values and shades, in the order in which quads are drawn.
    #[cfg(test)]
    pub(crate) fn drawn(&self) -> (&FieldValues, &[f64]) {
        (&self.values, &self.shades)
    }

    pub(super) fn title(&self) -> &str {
        &self.title
    }

    pub(super) fn payload(&self) -> Result<Value, PageError> {
        self.check()?;
        let (origin, extent) = self.bounds();
        let step = extent / COORDINATE_STEPS;
        let short =
            |v: f64, origin: f64| ((v - origin) / step).round().clamp(0.0, COORDINATE_STEPS) as u16;
        let coordinates = shorts(
            self.nodes_mm
                .iter()
                .flat_map(|p| [short(p[0], origin[0]), short(p[1], origin[1])]),
        );
        let corners = self.quads.iter().flatten().copied();
        // Corner numbers fit 16 bits for most pictures; the key says which.
        let (key, corners) = match u16::try_from(self.nodes_mm.len() - 1) {
            Ok(_) => ("quads16", shorts(corners.map(|node| node as u16))),
            Err(_) => ("quads32", words(corners)),
        };
        let (values, per_node) = match &self.values {
            FieldValues::PerNode(values) => (values, true),
            FieldValues::PerElement(values) => (values, false),
        };
        let (least, largest) = values
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| {
                (a.min(*v), b.max(*v))
            });
        let [low, high] = match self.colours_of_most {
            true => [0.0, self.most_of_area()],
            false => self.colour_range.unwrap_or([least.min(0.0), largest]),
        };
        // A field of one value still gets a scale.
        let high = if high > low { high } else { low + 1.0 };
        Ok(json!({
            "quantity": plain(&self.quantity),
            "unit": plain(&self.unit),
            "origin": origin,
            "step": step,
            "coordinates": coordinates,
            key: corners,
            "values": floats(values.iter().copied()),
            "perNode": per_node,
            "low": low,
            "high": high,
            "window": self.window.map(|w| json!({ "x": w.centre_mm[0], "y": w.centre_mm[1], "width": w.width_mm })),
            "shades": (!self.shades.is_empty()).then(|| floats(self.shades.iter().copied())),
            "marks": self.marks.iter().map(|m| json!({ "x": m.at_mm[0], "y": m.at_mm[1], "words": plain(&m.words), "sign": m.sign.name() })).collect::<Vec<_>>(),
        }))
    }

    /// Lower left corner and larger extent of the mesh, mm.
    fn bounds(&self) -> ([f64; 2], f64) {
        let mut low = [f64::INFINITY; 2];
        let mut high = [f64::NEG_INFINITY; 2];
        for p in &self.nodes_mm {
            for k in 0..2 {
                low[k] = low[k].min(p[k]);
                high[k] = high[k].max(p[k]);
            }
        }
        (
            low,
            (high[0] - low[0])
                .max(high[1] - low[1])
                .max(f64::MIN_POSITIVE),
        )
    }

    fn check(&self) -> Result<(), PageError> {
        let title = &self.title[..];
        let none = self.nodes_mm.is_empty() || self.quads.is_empty();
        check_some(title, "the mesh", none)?;
        let nodes = self.nodes_mm.iter().enumerate();
        let nodes = nodes.flat_map(|(i, p)| p.map(|v| (i, v)));
        check_finite_at(title, "the node list", nodes)?;
        self.check_quads()?;
        let (values, expected, what) = match &self.values {
            FieldValues::PerNode(values) => {
                (values, self.nodes_mm.len(), "the list of nodal values")
            }
            FieldValues::PerElement(values) => {
                (values, self.quads.len(), "the list of element values")
            }
        };
        check_count(title, what, values.len(), expected)?;
        check_finite(title, what, values)?;
        let what = "the list of shades";
        if !self.shades.is_empty() {
            check_count(title, what, self.shades.len(), self.quads.len())?;
        }
        check_finite(title, what, &self.shades)?;
        let marks = self.marks.iter().enumerate();
        let marks = marks.flat_map(|(i, m)| m.at_mm.map(|v| (i, v)));
        check_finite_at(title, "the list of marks", marks)?;
        if let Some([low, high]) = self.colour_range {
            check_range(title, "the colour scale", low, high)?;
        }
        if let Some(window) = self.window {
            check_range(title, "the window's width", 0.0, window.width_mm)?;
            check_finite(title, "the window's centre", &window.centre_mm)?;
        }
        Ok(())
    }

    /// Corners are nodes of the list.
    fn check_quads(&self) -> Result<(), PageError> {
        let nodes = self.nodes_mm.len();
        for (quad, corners) in self.quads.iter().enumerate() {
            if let Some(&node) = corners.iter().find(|&&node| node as usize >= nodes) {
                return Err(PageError::NoSuchNode {
                    block: self.title.clone(),
                    quad,
                    node,
                    nodes,
                });
            }
        }
        Ok(())
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    /// Ten cells of one size in a row.
    fn row(values: [f64; 10]) -> Value {
        let nodes = (0..22).map(|k| [f64::from(k / 2), f64::from(k % 2)]);
        let quads = (0..10).map(|k| [2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1]);
        FieldPicture::new("t", "pressure", "MPa")
            .mesh(nodes.collect(), quads.collect())
            .values(FieldValues::PerElement(values.to_vec()))
            .colours_of_most()
            .payload()
            .unwrap()
    }

    /// One edge that carries alone leaves the colours to the rest; where values run up smoothly all are shown.
    #[test]
    fn an_edge_does_not_take_all_colours() {
        let mut values = [
            0.0, 500.0, 600.0, 700.0, 800.0, 900.0, 800.0, 700.0, 600.0, 3500.0,
        ];
        // Nine cells have a value: 8.1 of them are nine tenths.
        assert_eq!(row(values)["high"], 3500.0);
        values[0] = 400.0;
        assert_eq!(row(values)["high"], 900.0);
        values[9] = 1300.0;
        assert_eq!(row(values)["high"], 1300.0);
        assert_eq!(row([0.0; 10])["high"], 1.0);
    }
}
