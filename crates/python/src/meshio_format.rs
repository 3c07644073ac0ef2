//! Which of meshio's formats a file name stands for.

use std::path::Path;

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// A format of meshio by its own name, for example `"gmsh"`.
pub(crate) struct MeshioFormat {
    pub name: String,
}

impl MeshioFormat {
    /// The format of a path by the end of its name.
    ///
    /// # Errors
    /// `ValueError` that lists the known extensions.
    pub fn of(py: Python<'_>, path: &Path) -> PyResult<Self> {
        // meshio reads and writes fifteen-node wedges in several formats, but its table of dimensions lacks them.
        py.import("meshio._mesh")?
            .getattr("topological_dimension")?
            .call_method1("setdefault", ("wedge15", 3))?;
        let table = py.import("meshio")?.getattr("extension_to_filetypes")?;
        let file_name = path
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .to_lowercase();
        let mut extensions: Vec<String> = table
            .try_iter()?
            .map(|key| key?.extract())
            .collect::<PyResult<_>>()?;
        extensions.sort();
        // ".vol.gz" ends in a longer extension than ".gz" would be: the longest that fits wins.
        let fitting = extensions
            .iter()
            .filter(|extension| file_name.ends_with(extension.as_str()));
        let Some(extension) = fitting.max_by_key(|extension| extension.len()) else {
            let known = extensions.join(" ");
            let message = format!(
                "{}: no mesh format has this extension; known are {known}",
                path.display()
            );
            return Err(PyValueError::new_err(message));
        };
        let mut names: Vec<String> = table.get_item(extension)?.extract()?;
        // .msh is gmsh's and also an older format of Ansys Fluent.
        let name = match names.iter().position(|name| name == "gmsh") {
            Some(gmsh) => names.swap_remove(gmsh),
            None => names.swap_remove(0),
        };
        Ok(Self { name })
    }

    /// Reads a file with meshio. Its own `read` prints and ends the process where a file is wrong, so the reader of
    /// the format is called.
    ///
    /// # Errors
    /// `FileNotFoundError`; `ValueError` with meshio's reason.
    pub fn read<'py>(&self, py: Python<'py>, path: &Path) -> PyResult<Bound<'py, PyAny>> {
        let readers = py.import("meshio._helpers")?.getattr("reader_map")?;
        if !readers.contains(&self.name)? {
            return Err(PyValueError::new_err(format!(
                "{}: meshio cannot read {} files",
                path.display(),
                self.name
            )));
        }
        let text = path.to_string_lossy().into_owned();
        readers
            .get_item(&self.name)?
            .call1((text,))
            .map_err(|error| self.explain(py, "read", path, error))
    }

    /// Whether the format has node sets of its own in meshio; elsewhere a set is a field that is 1 on its nodes.
    pub fn has_point_sets(&self) -> bool {
        self.name == "abaqus"
    }

    /// Whether a field of that many components can be written; gmsh knows scalars, vectors and 3 x 3 tensors only.
    pub fn holds_components(&self, components: usize) -> bool {
        self.name != "gmsh" || matches!(components, 1 | 3 | 9)
    }

    /// A failure of meshio as `ValueError`; the system's own errors stay as they are.
    pub fn explain(&self, py: Python<'_>, action: &str, path: &Path, error: PyErr) -> PyErr {
        if error.is_instance_of::<pyo3::exceptions::PyOSError>(py) {
            return error;
        }
        let message = format!(
            "{}: meshio cannot {action} this as {}: {error}",
            path.display(),
            self.name
        );
        let explained = PyValueError::new_err(message);
        explained.set_cause(py, Some(error));
        explained
    }
}
