//! The gearmesh Python module.
//!
//! | to | call |
//! | --- | --- |
//! | turn a mesh file into a format of other programs, and back | `export_mesh`, `import_mesh` |
//! | read and write a mesh file with NumPy arrays | `read_mesh`, `write_mesh` |
//! | look into a reduced gear with NumPy arrays | `read_reduced` |
//! | compute stiffness, displacements and strains of the body in a mesh file | `stiffness`, `solve`, `strain` |
//! | compute its mass, natural frequencies and shapes | `mass`, `natural_modes` |
//!
//! Wrong input raises `ValueError`, a refusing disk `OSError`; both with the message of the Rust side.

mod errors;
mod finite_elements;
mod mesh_arrays;
mod meshio_exchange;
mod meshio_format;
mod reduced;
mod solver_decks;

/// Gear mesh stiffness: reduced gears and meshes as NumPy arrays.
#[pyo3::pymodule]
mod gearmesh {
    #[pymodule_export]
    use crate::finite_elements::{mass, natural_modes, solve, stiffness, strain};
    #[pymodule_export]
    use crate::mesh_arrays::{read_mesh, write_mesh};
    #[pymodule_export]
    use crate::meshio_exchange::{export_mesh, import_mesh};
    #[pymodule_export]
    use crate::reduced::{_write_synthetic_reduced, read_reduced};

    #[pymodule_export]
    #[allow(non_upper_case_globals)]
    const __version__: &str = env!("CARGO_PKG_VERSION");
}
