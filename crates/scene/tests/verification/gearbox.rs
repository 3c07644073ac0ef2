//! The shipped three-stage gearbox at rest: its bearings carry what hand statics say.

use gearmesh_dynamics::{StaticParams, equilibrium};

use crate::common::{Outputs, build, text};

/// Forces of the bearings on the shafts \[N\], world axes: tools/reference/gearbox_statics.py.
const BY_HAND: &str = include_str!("../../../../reference/gearbox_three_stage/data.csv");

/// Within 2 % of each bearing's own force: the tooth forces' resultant does not stand in the middle of the width, as by
/// hand, but where the shafts' bending puts it.
#[test]
fn bearings_of_the_three_stage_gearbox_carry_what_statics_say() {
    let mut system = build(&text("gearbox_three_stage.toml")).unwrap().system;
    let start = system.start().clone();
    let found = equilibrium(&mut system, &start, &StaticParams::default()).unwrap();
    let outputs = Outputs::at(&mut system, &found.state);
    let rows: Vec<Vec<&str>> = (BY_HAND.lines().skip(1))
        .map(|line| line.split(',').collect())
        .collect();
    assert_eq!(rows.len(), 8);
    for row in rows {
        let by_hand: Vec<f64> = row[1..].iter().map(|v| v.parse().unwrap()).collect();
        let force = ["force_world_x_N", "force_world_y_N", "force_world_z_N"]
            .map(|c| outputs.value(row[0], c));
        let norm = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let off: Vec<f64> = by_hand.iter().zip(force).map(|(a, b)| b - a).collect();
        let off = norm(&off) / norm(&by_hand);
        assert!(off < 0.02, "{}: {force:?} {by_hand:?}", row[0]);
    }
    // Along the axes nothing depends on where the resultants stand: F_t tan(beta).
    let axial = outputs.value("bearing 4A", "force_world_z_N");
    assert!((axial / -2272.456 - 1.0).abs() < 1e-3, "{axial}");
    // Springs that do not change with the place keep the ratio: 1200 N m 17/59 19/67 21/73.
    let input = outputs.value("motor", "moment_z_Nm").abs();
    let expected = 1200.0 * 17.0 / 59.0 * 19.0 / 67.0 * 21.0 / 73.0;
    assert!((input / expected - 1.0).abs() < 1e-3, "{input}");
}
