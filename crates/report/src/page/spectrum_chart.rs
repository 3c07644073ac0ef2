//! Amplitudes over orders as stems on a logarithmic axis.

use super::PageError;
use super::checks::{check_abscissas, check_count, check_finite, check_some};
use super::line_chart::Axis;
use super::packed::floats;
use super::typography::plain;
use serde_json::{Value, json};

/// Decades below the strongest line that are shown.
const DECADES: u8 = 4;

/// An order with a name.
#[derive(Debug, Clone, PartialEq)]
struct HighlightedOrder {
    order: f64,
    label: String,
}

/// Amplitudes of one signal.
#[derive(Debug, Clone, PartialEq)]
pub struct SpectrumSeries {
    name: String,
    amplitudes: Vec<f64>,
}

impl SpectrumSeries {
    /// Amplitudes, one for each order, 0 or more.
    pub fn new(name: impl Into<String>, amplitudes: Vec<f64>) -> Self {
        Self {
            name: name.into(),
            amplitudes,
        }
    }
}

/// An order spectrum: stems of several signals side by side, named orders marked.
#[derive(Debug, Clone, PartialEq)]
pub struct SpectrumChart {
    title: String,
    y: Axis,
    orders: Vec<f64>,
    highest_order: Option<f64>,
    decades: u8,
    series: Vec<SpectrumSeries>,
    highlighted: Vec<HighlightedOrder>,
}

impl SpectrumChart {
    /// A chart without data; the abscissa is the order, periods in one revolution.
    pub fn new(title: impl Into<String>, y: Axis) -> Self {
        Self {
            title: title.into(),
            y,
            orders: Vec::new(),
            highest_order: None,
            decades: DECADES,
            series: Vec::new(),
            highlighted: Vec::new(),
        }
    }

    /// The orders of all series, increasing.
    #[must_use]
    pub fn orders(mut self, orders: Vec<f64>) -> Self {
        self.orders = orders;
        self
    }

    /// Leaves out the orders above this one.
    #[must_use]
    pub fn up_to_order(mut self, highest: f64) -> Self {
        self.highest_order = Some(highest);
        self
    }

    /// Decades shown below the strongest line (1 … 12; default 4).
    #[must_use]
    pub fn decades(mut self, decades: u8) -> Self {
        self.decades = decades.clamp(1, 12);
        self
    }

    /// Adds a signal.
    #[must_use]
    pub fn series(mut self, series: SpectrumSeries) -> Self {
        self.series.push(series);
        self
    }

    /// Marks an order with a name.
    #[must_use]
    pub fn highlight(mut self, order: f64, label: impl Into<String>) -> Self {
        self.highlighted.push(HighlightedOrder {
            order,
            label: label.into(),
        });
        self
    }

    pub(super) fn title(&self) -> &str {
        &self.title
    }

    pub(super) fn payload(&self) -> Result<Value, PageError> {
        check_abscissas(&self.title, "the list of orders", &self.orders)?;
        let kept = self.highest_order.map_or(self.orders.len(), |highest| {
            self.orders.partition_point(|m| *m <= highest)
        });
        let what = "the list of orders up to the highest";
        check_some(&self.title, what, kept == 0)?;
        let mut series = Vec::with_capacity(self.series.len());
        for s in &self.series {
            let what = format!("series '{}'", s.name);
            check_count(&self.title, &what, s.amplitudes.len(), self.orders.len())?;
            check_finite(&self.title, &what, &s.amplitudes)?;
            series.push(
                json!({ "name": plain(&s.name), "values": floats(s.amplitudes[..kept].iter().copied()) }),
            );
        }
        check_some(&self.title, "the list of series", series.is_empty())?;
        let highlighted: Vec<Value> = self
            .highlighted
            .iter()
            .map(|h| json!({ "order": h.order, "label": plain(&h.label) }))
            .collect();
        Ok(json!({
            "y": self.y.payload(),
            "decades": self.decades,
            "orders": floats(self.orders[..kept].iter().copied()),
            "series": series,
            "highlighted": highlighted,
        }))
    }
}
