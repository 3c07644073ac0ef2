//! Gears that stand beside the axes about which they turn, or askew: the transmission error that a mesh tells is that
//! of the bodies' turns.

use gearmesh_scene::system_run::RunJob;

use crate::common::{fe_models, load};
use crate::system_runs::Desk;

/// Helical, so that wobble moves the teeth along the axes and with it gear 2: 7 µm of it.
#[test]
fn runout_and_wobble_are_in_the_transmission_error() {
    let angles: Vec<String> = (0..12).map(|k| format!("{:?}", -29.0 * k as f64)).collect();
    let text = format!(
        "title = \"run-out\"\n[run]\nkind = \"static\"\nmotion = \"drive\"\nangles_deg = [{}]\n\
         [[body]]\nname = \"one\"\ngear = \"helical1.toml\"\nmass_kg = 1.0\ninertia_kg_m2 = [1e-3, 1e-3, 2e-3]\n\
         [[body]]\nname = \"two\"\ngear = \"helical2.toml\"\nmass_kg = 1.0\ninertia_kg_m2 = [1e-3, 1e-3, 2e-3]\nposition_mm = [113.6, 0.0, 0.0]\n\
         [[joint]]\nname = \"axle 1\"\nkind = \"revolute\"\nbody_2 = \"one\"\n\
         [[joint]]\nname = \"axle 2\"\nkind = \"revolute\"\nbody_2 = \"two\"\n\
         [[motion]]\nname = \"drive\"\njoint = \"axle 1\"\nangle_deg = 0.0\n\
         [[load]]\nbody = \"two\"\ntorque_Nm = -100.0\n\
         [[gear_mesh]]\nname = \"mesh\"\ngear_1 = \"one\"\ngear_2 = \"two\"\nmodel = {{ kind = \"analytic\", slices = 5 }}\n\
         teeth = {{ eccentricity_1 = {{ offset_um = 12.0, direction_deg = 40.0, tilt_mrad = 0.3 }}, eccentricity_2 = {{ tilt_mrad = 0.2 }} }}\n",
        angles.join(", ")
    );
    let job = RunJob::from_scene(load(&text, &fe_models()).unwrap()).unwrap();
    let result = Desk::new().run(job);
    let read = |column: &str| result.rows.read(column).unwrap();
    let [turn_1, turn_2] = ["one", "two"].map(|body| read(&format!("bodies/{body}/turn_rad")));
    let told = read("elements/mesh/transmission_error_m");
    // m_n 3 mm, 20°, β 20°: r_b = m_n z/(2 cos β) cos α_t.
    let helix = 20.0_f64.to_radians();
    let transverse = (20.0_f64.to_radians().tan() / helix.cos()).atan();
    let base_m = [31.0, 40.0].map(|teeth| 1.5e-3 * teeth / helix.cos() * transverse.cos());
    let turned: Vec<f64> = (turn_1.iter().zip(&turn_2))
        .map(|(one, two)| base_m[1] * two + base_m[0] * one)
        .collect();
    let spread = |values: &[f64]| {
        let most = values.iter().fold(f64::MIN, |most, v| most.max(*v));
        most - values.iter().fold(f64::MAX, |least, v| least.min(*v))
    };
    let apart: Vec<f64> = told.iter().zip(&turned).map(|(a, b)| a - b).collect();
    assert!(spread(&turned) > 20e-6, "{:e}", spread(&turned));
    assert!(spread(&apart) < 1e-10, "{:e} m", spread(&apart));
}
