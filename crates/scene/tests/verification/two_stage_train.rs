//! The shipped two-stage train at rest: both stages are found though the coupling alone would let the shafts turn by
//! many teeth.

use crate::common;

use common::{Outputs, build, text};
use gearmesh_dynamics::{StaticParams, equilibrium};

#[test]
fn both_stages_of_the_train_come_to_rest_on_their_flanks() {
    let mut system = build(&text("dynamics_two_stage.toml")).unwrap().system;
    let start = system.start().clone();
    let found = equilibrium(&mut system, &start, &StaticParams::default()).unwrap();
    assert!(found.held.is_empty(), "{:?}", found.held);
    assert!(found.iterations < 60, "{}", found.iterations);

    let outputs = Outputs::at(&mut system, &found.state);
    let value = |element: &str, channel: &str| outputs.value(element, channel);
    // The ratio holds in the mean over a mesh period only: at rest the teeth's own elastic energy has a slope.
    let torque = value("coupling", "moment_z_Nm").abs();
    let expected = 100.0 * 27.0 / 61.0 * 31.0 / 71.0;
    assert!(
        (torque / expected - 1.0).abs() < 0.01,
        "{torque} {expected}"
    );
    // One side of the teeth carries in each stage, 1 to 2 pairs of it.
    for mesh in ["first stage", "second stage"] {
        let sides = ["normal_force_right_N", "normal_force_left_N"].map(|side| value(mesh, side));
        assert!(sides[0] * sides[1] == 0.0 && sides[0] + sides[1] > 500.0);
        assert!((1.0..=2.0).contains(&value(mesh, "loaded_pairs")));
        assert!(value(mesh, "transmission_error_m").abs() < 50e-6);
    }
}
