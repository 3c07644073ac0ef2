//! Effects that are not named are not computed.

use crate::conformance::{friction, loaded_poses};
use crate::mesh_common::*;
use gearmesh_drivetrain::*;
use gearmesh_geometry::{Flank, GearPair};

/// Effects that are not named are not computed.
#[test]
fn absent_effects_cost_nothing() {
    let pair = spur_pair();
    let at = loaded_poses(&pair)[0];
    let one_side =
        |pair: &GearPair| GearMesh::new(kinematics(pair), Flank::Right, beam_teeth(pair)).unwrap();
    let mut plain = one_side(&pair);
    plain.evaluate(&at, true).unwrap();
    let effort = plain.effort();
    assert_eq!((effort.poses, effort.models, effort.friction), (1, 1, 0));
    assert!(plain.side(Flank::Left).is_none());
    assert_eq!(plain.modal_loads().count(), 0);
    assert!(
        plain
            .friction(Flank::Right)
            .iter()
            .all(|friction| friction.coefficient == 0.0)
    );
    let mut rubbing = one_side(&pair).with_friction(friction());
    rubbing.evaluate(&at, true).unwrap();
    assert!(rubbing.effort().friction >= SLICES as u64);
    let mut both = mesh("analytic", &pair, kinematics(&pair));
    both.evaluate(&at, true).unwrap();
    // The flanks behind the teeth are farther apart than anything on them is high.
    assert_eq!(both.effort().models, 1);
    assert!(both.side(Flank::Left).unwrap().0.lines.is_empty());
}
