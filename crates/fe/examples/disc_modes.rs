//! Natural frequencies of a steel disc held at its bore, with time and effort.
//!
//! ```text
//! cargo run -p gearmesh-fe --example disc_modes -- hex20 72 6 2 20     element, around, radial, axial, modes
//! ```
//!
//! Bore radius 25 mm, outer radius 75 mm, width 23 mm. Pairs of equal frequencies are the modes with nodal diameters.

use std::error::Error;
use std::io::Write;
use std::time::Instant;

use gearmesh_fe::{
    DofMap, Element, Factor, Material, ModeSettings, StructuredMesh, arc_middle, assemble_mass,
    assemble_stiffness, natural_modes,
};

const BORE_M: f64 = 0.025;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let element = match arguments.first() {
        Some(name) => Element::from_name(name).ok_or("the element is unknown")?,
        None => Element::Hex20,
    };
    let mut numbers = [72, 6, 2, 20];
    for (number, text) in numbers.iter_mut().zip(arguments.iter().skip(1)) {
        *number = text.parse()?;
    }
    let [around, radial, axial, count] = numbers;
    let ring = StructuredMesh::ring([around, radial, axial], [BORE_M, 0.075], 0.023);
    let steel = Material::new(206e9, 0.3)?;
    let model = ring.into_model(steel, element, |_, ends| arc_middle(ends))?;
    let bore: Vec<usize> = (0..model.node_count())
        .filter(|n| model.nodes()[*n][0].hypot(model.nodes()[*n][1]) < BORE_M * 1.000_001)
        .collect();
    let dofs = DofMap::with_fixed_nodes(model.node_count(), &bore)?;

    let mut clock = Instant::now();
    let mut lap = || {
        let seconds = clock.elapsed().as_secs_f64();
        clock = Instant::now();
        seconds
    };
    let k = assemble_stiffness(&model, &dofs)?;
    let stiffness = lap();
    let m = assemble_mass(&model, &dofs, 7850.0)?;
    let mass = lap();
    let factor = Factor::of_model(&model, &dofs, &k)?;
    let factored = lap();
    let modes = natural_modes(&k, &m, &factor, &ModeSettings::new(count))?;
    let searched = lap();
    let mut out = std::io::stdout();
    writeln!(
        out,
        "{}: {} free unknowns; stiffness {stiffness:.2} s, mass {mass:.2} s, factor {factored:.2} s, {count} modes \
         {searched:.2} s in {} solves and {} restarts",
        element.name(),
        dofs.free_count(),
        modes.solves,
        modes.restarts
    )?;
    for (hz, residual) in modes.frequencies_hz().iter().zip(&modes.relative_residuals) {
        writeln!(out, "{hz:12.3} Hz   residual {residual:.1e}")?;
    }
    Ok(())
}
