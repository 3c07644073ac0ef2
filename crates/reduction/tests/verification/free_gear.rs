//! A free gear on its reference point: modes by finite elements against those from the model file's basis.

use crate::natural_modes::{ON_A_POINT, SLOTS, THIN_RIM, on_mesh, reduced_like};
use crate::small_gears::COARSE;
use faer::{Mat, Side};
use gearmesh_fe::{
    DofMap, Factor, ModeSettings, RigidGroup, assemble_mass, assemble_stiffness, natural_modes,
    shifted_stiffness,
};
use gearmesh_model::ReducedGear;
use gearmesh_reduction::GearBody;
use std::f64::consts::TAU;

/// Free gear on its reference point, by finite elements with a rigid group: ω² of rigid and elastic modes.
fn free_gear(body: &GearBody, count: usize) -> Vec<f64> {
    let nodes: Vec<usize> = body.mesh.bore().into_iter().map(|n| n as usize).collect();
    let group = RigidGroup {
        nodes,
        reference_m: [0.0; 3],
        fixed: [false; 6],
    };
    let dofs = DofMap::with_rigid_groups(body.model.nodes(), &[], &[group]).unwrap();
    let k = assemble_stiffness(&body.model, &dofs).unwrap();
    let m = assemble_mass(&body.model, &dofs, 7850.0).unwrap();
    let settings = ModeSettings {
        shift_rad2_per_s2: (TAU * 5e3).powi(2),
        ..ModeSettings::new(6 + count)
    };
    let shifted = shifted_stiffness(&k, &m, settings.shift_rad2_per_s2).unwrap();
    let factor = Factor::of_model(&body.model, &dofs, &shifted).unwrap();
    natural_modes(&k, &m, &factor, &settings)
        .unwrap()
        .omega_squared
}

/// The same from the model file: six rigid motions and the first `count` modes, coupled by ΦᵀMR.
fn free_craig_bampton(model: &ReducedGear, count: usize) -> Vec<f64> {
    let basis = model.modes.as_ref().unwrap();
    let rigid = model.rigid_body.as_ref().unwrap().mass_matrix();
    let size = 6 + count;
    let m = Mat::from_fn(size, size, |i, j| match (i < 6, j < 6) {
        (true, true) => rigid[i][j],
        (true, false) => basis.coupling[6 * (j - 6) + i],
        (false, true) => basis.coupling[6 * (i - 6) + j],
        (false, false) => f64::from(u8::from(i == j)),
    });
    // M = L Lᵀ: the ordinary problem L⁻¹ K L⁻ᵀ.
    let l = m.llt(Side::Lower).unwrap().L().to_owned();
    let mut half = Mat::from_fn(size, size, |i, j| {
        if i == j && i >= 6 {
            basis.omega_squared[i - 6]
        } else {
            0.0
        }
    });
    let solve = faer::linalg::triangular_solve::solve_lower_triangular_in_place;
    solve(l.as_ref(), half.as_mut(), faer::Par::Seq);
    let mut whole = half.transpose().to_owned();
    solve(l.as_ref(), whole.as_mut(), faer::Par::Seq);
    whole.self_adjoint_eigenvalues(Side::Lower).unwrap()
}

#[test]
fn the_free_gear_on_its_reference_point_comes_back_from_the_basis() {
    let tables = format!("{ON_A_POINT}[modes]\ncount = 48\n");
    let blank = format!("{THIN_RIM}{SLOTS}");
    let (_, model, body) = reduced_like(&on_mesh(COARSE), &blank, &tables);
    let elastic = 6;
    let exact = free_gear(&body, elastic);
    for (k, square) in exact.iter().enumerate() {
        assert_eq!(square.abs() < 1e-6 * exact[6], k < 6, "{exact:?}");
    }
    let mut errors: Vec<Vec<f64>> = Vec::new();
    for count in [6, 18, 48] {
        let found = free_craig_bampton(&model, count);
        assert!(
            found[..6].iter().all(|w| w.abs() < 1e-6 * exact[6]),
            "{found:?}"
        );
        let error = (6..6 + elastic).map(|k| (found[k] / exact[k]).sqrt() - 1.0);
        errors.push(error.collect());
    }
    for k in 0..elastic {
        // A subspace: from above, and never farther away with more modes.
        assert!(errors.iter().all(|e| e[k] > -1e-9), "{errors:?}");
        assert!(errors[1][k] <= errors[0][k] + 1e-12 && errors[2][k] <= errors[1][k] + 1e-12);
        assert!(errors[2][k] < 5e-3, "{errors:?}");
    }
    // Six modes know the lowest ones only; 48 bring the worst of the first six from beyond recognition to 0.4 %, the
    // pair that the hub's inertia changes least to 1e-6.
    assert!(
        errors[0][5] > 0.1 && errors[2][0] < 1e-5 && errors[2][3] < 1e-5,
        "{errors:?}"
    );
}
