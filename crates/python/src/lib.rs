//! The compiled half of the Python package `gearmesh`: the module `gearmesh._native`.
//!
//! What a user sees is in `gearmesh/*.py` beside this folder; that half turns keywords into texts of files and arrays
//! into pictures. This one calls the libraries.
//!
//! | to | call |
//! | --- | --- |
//! | check texts of files, make them from Python's dicts | `check_gear`, `check_scene`, `toml_from_json`, `schema` |
//! | mesh and reduce a gear | `reduce` |
//! | run a scene, look into its result | `run`, `plan`, `open_result` |
//! | do what a command of the program does | `operate`, by its name |
//! | list the cases of a study, run one that was sent | `study_gears`, `study_cases`, `NativeCaseRunner` |
//! | turn a mesh file into a format of other programs, and back | `export_mesh`, `import_mesh` |
//! | read and write a mesh file with NumPy arrays | `read_mesh`, `write_mesh` |
//! | look into a reduced gear with NumPy arrays | `read_reduced` |
//! | compute stiffness, displacements and strains of the body in a mesh file | `stiffness`, `solve`, `strain` |
//! | compute its mass, natural frequencies and shapes | `mass`, `natural_modes` |
//!
//! Wrong input raises `InputError`, a `ValueError`; failed work `WorkError`, a `RuntimeError`; a refusing disk
//! `OSError`; all with the message of the Rust side. Long work runs beside Python (`watched.rs`).

mod documents;
mod errors;
mod finite_elements;
mod functions;
mod mesh_arrays;
mod meshio_exchange;
mod meshio_format;
mod operating;
mod pair_arrays;
mod reduced;
mod reducing;
mod results;
mod scenes;
mod solver_decks;
mod studies;
mod watched;

/// Gear mesh stiffness: what the package gearmesh calls.
#[pyo3::pymodule(name = "_native")]
mod native {
    #[pymodule_export]
    use crate::documents::{
        check_gear, check_scene, files_of, json_from_toml, schema, toml_from_json, with_files,
        write_text,
    };
    #[pymodule_export]
    use crate::errors::{InputError, WorkError};
    #[pymodule_export]
    use crate::finite_elements::{mass, natural_modes, solve, stiffness, strain};
    #[pymodule_export]
    use crate::mesh_arrays::{read_mesh, write_mesh};
    #[pymodule_export]
    use crate::meshio_exchange::{export_mesh, import_mesh};
    #[pymodule_export]
    use crate::operating::operate;
    #[pymodule_export]
    use crate::reduced::read_reduced;
    #[pymodule_export]
    use crate::reducing::reduce;
    #[pymodule_export]
    use crate::results::{NativeResult, open_result};
    #[pymodule_export]
    use crate::scenes::{plan, run};
    #[pymodule_export]
    use crate::studies::{NativeCaseRunner, gather_study, study, study_cases, study_gears};

    #[pymodule_export]
    #[allow(non_upper_case_globals)]
    const __version__: &str = env!("CARGO_PKG_VERSION");

    #[pymodule_init]
    fn init(_: &pyo3::Bound<'_, pyo3::types::PyModule>) -> pyo3::PyResult<()> {
        gearmesh_fe::split_alike();
        let threads = gearmesh_geometry::input::demand_threads();
        threads.map_err(|error| InputError::new_err(error.to_string()))
    }
}
