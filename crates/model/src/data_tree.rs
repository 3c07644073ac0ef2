//! Named arrays with units and texts: what every gearmesh file is made of.

use std::collections::BTreeMap;

/// The kind of a file and the newest version of it that this program writes and reads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FileFormat {
    /// Written into the root attribute `format`, for example `"gearmesh reduced gear"`.
    pub name: &'static str,
    /// Written into the root attribute `formatVersion`. Versions 1 to this one are read.
    pub version: u32,
}

/// Numbers of one type, in row-major order.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// 64-bit floating point.
    F64(Vec<f64>),
    /// 32-bit counts and indices.
    U32(Vec<u32>),
}

impl Values {
    /// How many numbers there are.
    pub fn len(&self) -> usize {
        match self {
            Self::F64(values) => values.len(),
            Self::U32(values) => values.len(),
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// An array that says what it is. In the file each field but the values is an attribute of the HDF5 dataset, named
/// as in openPMD where that standard has a name for it.
#[derive(Debug, Clone, PartialEq)]
pub struct DataArray {
    /// Length along each axis; empty for a single number.
    pub shape: Vec<usize>,
    /// The numbers, the last axis running fastest.
    pub values: Values,
    /// Attribute `axisLabels`: what each axis counts, for example `["tooth", "load"]`.
    pub axis_labels: Vec<String>,
    /// Attribute `unit`, for example `"m/N"`; `"1"` for a plain number.
    pub unit: String,
    /// Attribute `unitSI`: the factor that turns the numbers into SI units; 1 for all that gearmesh computes.
    pub unit_si: f64,
    /// Attribute `description`: what the numbers are, with their sign.
    pub description: String,
    /// Attribute `frame`: the frame or direction they are given in; empty where that means nothing.
    pub frame: String,
}

impl DataArray {
    /// An array in SI units. `axes` gives label and length of each axis, the last one running fastest.
    ///
    /// # Panics
    /// If the number of values is not the product of the lengths.
    pub fn new(values: Values, axes: &[(&str, usize)], unit: &str, description: &str) -> Self {
        let shape: Vec<usize> = axes.iter().map(|axis| axis.1).collect();
        assert_eq!(
            shape.iter().product::<usize>(),
            values.len(),
            "shape {shape:?} of \"{description}\""
        );
        Self {
            shape,
            values,
            axis_labels: axes.iter().map(|axis| axis.0.to_owned()).collect(),
            unit: unit.to_owned(),
            unit_si: 1.0,
            description: description.to_owned(),
            frame: String::new(),
        }
    }

    /// A single number in SI units.
    pub fn scalar(value: f64, unit: &str, description: &str) -> Self {
        Self::new(Values::F64(vec![value]), &[], unit, description)
    }

    /// A single count.
    pub fn count(value: u32, description: &str) -> Self {
        Self::new(Values::U32(vec![value]), &[], "1", description)
    }

    /// The same array with its frame stated.
    pub fn in_frame(mut self, frame: &str) -> Self {
        self.frame = frame.to_owned();
        self
    }
}

/// Arrays, texts and attributes by name; one HDF5 file. `/` in a name makes groups: `"gauges/0/adjoint"`.
///
/// Write it with [`DataTree::write`], read it with [`DataTree::read`], and take the parts out with
/// [`DataTree::take_f64`], [`DataTree::take_u32`], [`DataTree::take_text`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DataTree {
    /// Numeric datasets.
    pub arrays: BTreeMap<String, DataArray>,
    /// Text datasets, for example an input file word for word.
    pub texts: BTreeMap<String, String>,
    /// Short texts kept as attributes of the root, besides those that every file has (`format` and so on).
    pub attributes: BTreeMap<String, String>,
}

impl DataTree {
    /// Adds an array; one of the same name is replaced.
    pub fn put(&mut self, name: impl Into<String>, array: DataArray) {
        self.arrays.insert(name.into(), array);
    }

    /// Adds a text; one of the same name is replaced.
    pub fn put_text(&mut self, name: impl Into<String>, text: impl Into<String>) {
        self.texts.insert(name.into(), text.into());
    }

    /// Array and place of the first entry that is not a number; none in any file that is complete.
    pub(crate) fn first_not_a_number(&self) -> Option<(&str, usize)> {
        self.arrays.iter().find_map(|(name, array)| {
            let Values::F64(values) = &array.values else {
                return None;
            };
            let index = values.iter().position(|value| value.is_nan())?;
            Some((&name[..], index))
        })
    }

    /// The names directly below a group (`""` is the root), each once, sorted.
    pub fn children(&self, group: &str) -> Vec<String> {
        let prefix = if group.is_empty() {
            String::new()
        } else {
            format!("{group}/")
        };
        let mut names: Vec<String> = (self.arrays.keys().chain(self.texts.keys()))
            .filter_map(|name| name.strip_prefix(&prefix))
            .filter_map(|rest| rest.split('/').next())
            .map(str::to_owned)
            .collect();
        names.sort();
        names.dedup();
        names
    }
}
