//! Skidding of a lightly loaded fast bearing.
//!
//! Trend: T. Hirano, *Motion of a ball in angular-contact ball bearing*, ASLE Transactions 8 (1965) 425-434, and T. A.
//! Harris, *An analytical method to predict skidding in thrust-loaded, angular-contact ball bearings*, J. Lubr.
//! Technol. 93 (1971) 17-23: below a thrust that grows with the speed the balls and the cage fall behind rolling; above
//! it they do not.

use std::ops::ControlFlow;

use gearmesh_bearings::RingPose;
use gearmesh_bearings::dynamic::{
    DynamicEffects, LandContact, LandFilm, LandGuide, LandSide, Rebound, Traction,
};
use gearmesh_dynamics::{GROUND, Marker, MarkerPair, Params, Simulation, System};

use crate::common::{PAIR, bearing};
use crate::rig::{Held, cage, element, hold, pockets, row, shaft};

/// How far the cage falls behind rolling, in percent, under a thrust at 12 000 rpm with a film that drags at the land.
fn slip_percent(thrust_n: f64) -> f64 {
    let single = PAIR
        .replace("arrangement = \"O\"", "")
        .replace("row_distance_mm = 16.0", "")
        .replace("preload_um = 5.0", "");
    let bearing = bearing(&single);
    let speed = 1256.0;
    let operation = gearmesh_bearings::Operation {
        inner_rad_per_s: speed,
        ..gearmesh_bearings::Operation::default()
    };
    let load = gearmesh_bearings::ring_equilibrium::AppliedBearingLoad {
        force_n: [0.0, 0.0, thrust_n],
        tilt: gearmesh_bearings::ring_equilibrium::TiltCondition::Held([0.0; 2]),
    };
    let pose: RingPose = bearing.equilibrium(&load, &operation).unwrap();
    let (_, loads) = bearing.loads(&pose, &operation).unwrap();
    let rolling = loads.elements[0][0].orbit_rad_per_s;
    let mut builder = System::builder();
    let shaft = shaft(&mut builder, &pose, speed);
    hold(&mut builder, shaft, &pose, speed, &Held::Thrust(thrust_n));
    let cage = cage(&mut builder, row(&bearing).pitch_radius_m, rolling);
    let land = LandGuide {
        side: LandSide::Outer,
        radius_m: 0.037,
        clearance_m: 2e-4,
        film: Some(LandFilm {
            viscosity_pa_s: 0.1,
            width_m: 6e-3,
        }),
        contact: LandContact {
            stiffness_n_per_m15: 1e9,
            roughness_m: 1e-5,
            rebound: Rebound {
                factor_s_per_m: 1.0,
            },
            friction: None,
        },
    };
    let pair = MarkerPair {
        a: Marker::at(GROUND, [0.0; 3]),
        b: Marker::at(cage, [0.0; 3]),
    };
    builder.element(land.between("land", pair).unwrap());
    let effects = DynamicEffects {
        rebound: Rebound {
            factor_s_per_m: 1.0,
        },
        traction: Some(Traction::coulomb(0.05, 0.05).unwrap()),
        gravity_m_per_s2: None,
        cages: vec![(cage, pockets())],
        ..DynamicEffects::default()
    };
    builder.element(element(&bearing, effects, shaft));
    let mut run = Simulation::new(builder.build().unwrap(), Params::fixed(1e-5)).unwrap();
    let (mut sum, mut count) = (0.0, 0.0);
    run.run(0.06, |step| {
        if step.to.time_s > 0.05 {
            sum += step.to.velocity[11];
            count += 1.0;
        }
        ControlFlow::Continue(())
    })
    .unwrap();
    100.0 * (1.0 - sum / count / rolling)
}

#[test]
fn skidding_vanishes_with_preload() {
    let slips = [10.0, 30.0, 100.0, 400.0].map(slip_percent);
    assert!(slips.windows(2).all(|pair| pair[1] < pair[0]), "{slips:?}");
    assert!(slips[0] > 10.0 && slips[3] < 1.0, "{slips:?}");
}
