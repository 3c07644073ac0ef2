//! Natural frequencies, beams, modal bodies and parametric excitation against closed forms.
#![allow(clippy::unwrap_used)] // test code

mod beams;
mod large_systems;
mod modal_body;
mod natural_frequencies;
mod parametric_excitation;

use gearmesh_dynamics::{BodyId, Marker};

fn origin(body: BodyId) -> Marker {
    Marker::at(body, [0.0; 3])
}

fn close(found: f64, exact: f64, tolerance: f64) {
    assert!(
        (found - exact).abs() <= tolerance * exact.abs(),
        "{found} instead of {exact}"
    );
}
