//! Which of meshio's formats a file name stands for.

use std::path::Path;

use gearmesh_model::EXPORT_ENDINGS;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

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

    /// The format in which a path is to be written.
    ///
    /// # Errors
    /// `ValueError` that lists the endings of all that are.
    pub fn to_write(py: Python<'_>, path: &Path) -> PyResult<Self> {
        let name = path.to_string_lossy().to_lowercase();
        if EXPORT_ENDINGS.iter().any(|ending| name.ends_with(ending)) {
            return Self::of(py, path);
        }
        let message = format!(
            "{}: meshes are not written in this format; allowed are {}",
            path.display(),
            EXPORT_ENDINGS.join(" ")
        );
        Err(PyValueError::new_err(message))
    }

    /// What meshio's writer gets beside the mesh. Older programs do not read VTK 5.1; an .xdmf file that has its
    /// numbers in it needs no second file, which would be `gear.h5` and might be somebody's model.
    pub fn write_options<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let options = PyDict::new(py);
        let name = if self.name == "vtk" {
            "vtk42"
        } else {
            &self.name
        };
        options.set_item("file_format", name)?;
        if self.name == "xdmf" {
            options.set_item("data_format", "XML")?;
        }
        Ok(options)
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
