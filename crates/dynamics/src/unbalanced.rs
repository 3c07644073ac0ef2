//! How much pushes on each degree of freedom, where forces balance least, and who pushes there, in words.

use crate::equations::Equations;
use crate::system::System;

/// Joints and elements that are named.
const NAMED: usize = 3;

/// Sum of the magnitudes of all forces of elements and joints, and of what is left over, on each degree of freedom. The
/// equations are those of the last evaluation, with tangents.
pub(crate) fn pushing(system: &System, equations: &Equations, lambda: &[f64]) -> Vec<f64> {
    let mut sums: Vec<f64> = equations.residual.iter().map(|r| r.abs()).collect();
    for slot in &system.slots {
        slot.add_magnitudes(&mut sums);
    }
    for (equation, lambda) in lambda.iter().enumerate() {
        for (dof, b) in equations.gradient.entries(equation) {
            sums[dof] += (lambda * b).abs();
        }
    }
    sums
}

/// The degree of freedom with the largest unbalanced force in the measure of the masses (rᵢ²/mᵢ), and the joints and
/// force elements with the largest forces on it. The equations are those of the last evaluation, with tangents.
pub(crate) fn most_unbalanced(system: &System, equations: &Equations, lambda: &[f64]) -> String {
    let mass = system.mass_diagonal();
    let of_each = equations.residual.iter().zip(&mass).map(|(r, m)| r * r / m);
    let Some((dof, _)) = of_each.enumerate().max_by(|a, b| a.1.total_cmp(&b.1)) else {
        return "nothing moves".to_owned();
    };
    let mut pushes: Vec<(&str, f64)> = system
        .slots
        .iter()
        .map(|slot| (slot.element.name(), slot.force_on(dof)))
        .collect();
    let mut first = 0;
    for joint in system.joints() {
        let own = first..first + joint.equations();
        let force: f64 = own
            .clone()
            .map(|equation| -lambda[equation] * equations.gradient.get(dof, equation))
            .sum();
        pushes.push((joint.name(), force));
        first = own.end;
    }
    pushes.retain(|(_, force)| *force != 0.0);
    pushes.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
    let named = pushes.iter().take(NAMED);
    let words: Vec<String> = named
        .map(|(name, force)| format!("`{name}` with {force:.3e}"))
        .collect();
    let pushing = if words.is_empty() {
        "nothing pushes".to_owned()
    } else {
        format!("{} push", words.join(", "))
    };
    format!(
        "forces balance least along {}: {pushing}, and {:.3e} (N or N m) is left over",
        system.describe(dof),
        -equations.residual[dof]
    )
}
