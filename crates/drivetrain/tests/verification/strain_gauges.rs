//! Root strain at run time.

use crate::mesh_common;

use gearmesh_contact::AxialSpread;
use gearmesh_drivetrain::pose::Vector6;
use gearmesh_drivetrain::*;
use gearmesh_dynamics::{Channel, Simulation};
use gearmesh_geometry::Flank;
use gearmesh_recovery::{LoadedSlice, grid_forces};
use mesh_common::running_pair::*;
use mesh_common::*;
use nalgebra::Vector3;

/// The reading is the dot product of the gauge's row with the forces on the unit loads, friction along the profile
/// included; its direction is taken from where the flanks are.
#[test]
fn gauges_read_the_forces_on_the_flanks() {
    for pair in [pair_a(), helical_pair_a()] {
        let models = [&pair.gear_1, &pair.gear_2].map(calibrated_gear);
        let mu = 0.08;
        // Sliding in either direction is fast against the transition.
        let friction = Friction::new([mu, mu], [1e-9, 2e-9]).unwrap();
        let mut mesh = running_mesh("hybrid", &pair).with_friction(friction);
        for (side, theta) in [
            (Flank::Right, 0.01),
            (Flank::Right, 0.06),
            (Flank::Left, 0.03),
            (Flank::Left, 0.09),
        ] {
            let phi = angles(&pair, side, theta, -12e-6);
            let at = pose(&pair, phi, Vector3::zeros(), Vector3::zeros());
            let turning = Vector6::new(0.0, 0.0, 0.0, 0.0, 0.0, 1.0);
            mesh.evaluate(&moving(&at, &turning), false).unwrap();
            let seen = kinematics(&pair).contacts(&at, side, &mut FlankContacts::default());
            let planes = seen.unwrap().1.planes;
            for gear in [1, 2] {
                let model = &models[gear - 1];
                let mut gauges =
                    StrainGauges::new(&mesh, gear, model, &GAUGES, ModalPart::Included).unwrap();
                let found = gauges.read(&mesh, &[]).to_vec();
                let (flanks, forces) = mesh.side(side).unwrap();
                let coefficients = mesh.friction(side);
                assert!((coefficients.iter()).any(|c| c.coefficient.abs() > 0.99 * mu));
                let slices = flanks.contacts.iter().enumerate().map(|(i, contact)| {
                    let (line, plane) = (&flanks.lines[contact.line], &planes[contact.slice]);
                    let roll_rad = flanks.section(contact).touching_roll_rad;
                    let (w, across) = (plane.normal, plane.across);
                    let r1 = pair.gear_1.base_radius_m;
                    let point = r1 * (side.mirror() * across + roll_rad[0] * w);
                    let (from_axis, rubbing) = match gear {
                        1 => (point, coefficients[i].coefficient * across),
                        _ => (
                            point - at.displacement_m,
                            -coefficients[i].coefficient * across,
                        ),
                    };
                    let outwards = from_axis.dot(&across).signum();
                    LoadedSlice {
                        tooth: line.teeth[gear - 1],
                        slice: contact.slice,
                        roll_rad: roll_rad[gear - 1],
                        components: [1.0, rubbing.dot(&(outwards * across))],
                        force_n: forces[i],
                    }
                });
                let loads = grid_forces(&model.grid, &AxialSpread::own(model), slices);
                let flank = usize::from(side == Flank::Left);
                let mut rubbed = 0;
                for (gauge, found) in model.gauges.iter().zip(&found) {
                    let (mut first, mut second) = (0.0, 0.0);
                    for load in &loads {
                        let at = 3 * ((load.tooth * 2 + flank) * model.grid.len() + load.load);
                        let own = if load.tooth == gauge.tooth {
                            gauge.own_tooth[flank * model.grid.len() + load.load]
                        } else {
                            0.0
                        };
                        first += load.normal_n * (gauge.adjoint[at] - own);
                        second += load.normal_n * gauge.adjoint[at]
                            + load.tangential_n * gauge.adjoint[at + 1];
                    }
                    assert!(
                        (found.method_1 - first).abs() < 1e-12 * first.abs(),
                        "{first:e}"
                    );
                    assert!(
                        (found.method_2 - second).abs() < 1e-12 * second.abs(),
                        "{second:e}"
                    );
                    rubbed += usize::from((second - first).abs() > 1e-3 * first.abs());
                }
                // Slices of helical teeth slide both ways at once, so that at some gauges little is left.
                let least = if pair.is_helical() { 4 } else { GAUGES.len() };
                assert!(rubbed >= least, "{rubbed}");
            }
        }
    }
}

/// Channels of a system in the order of their names, in µm/m.
#[test]
fn gauges_are_channels_of_the_mesh() {
    let pair = pair_a();
    let system = running_pair(&pair, running_mesh("hybrid", &pair), 2);
    let mut run = Simulation::new(system.build().unwrap(), params()).unwrap();
    let names = run.system().channels();
    let of_mesh: Vec<&str> = names
        .iter()
        .filter(|(element, _)| element == "mesh")
        .map(|(_, channel)| channel.name.as_str())
        .collect();
    assert_eq!(
        of_mesh,
        [
            "normal_force_right_N",
            "normal_force_left_N",
            "transmission_error_m",
            "loaded_pairs",
            "apart",
            "strain_gear2_g0_method1_ustrain",
            "strain_gear2_g0_method2_ustrain",
            "strain_gear2_g1_method1_ustrain",
            "strain_gear2_g1_method2_ustrain",
            "tangential_force_1_N",
            "radial_force_1_N",
            "axial_force_1_N",
            "moment_1_Nm",
            "moment_2_Nm",
        ]
    );
    let of = |name: &str| names.iter().filter(|(element, _)| element == name).count();
    let counts: Vec<usize> = run.system().elements().map(of).collect();
    let mut out = vec![f64::NAN; names.len()];
    let is_strain = |(_, channel): &(String, Channel)| channel.name.starts_with("strain");
    let first_strain = names.iter().position(is_strain).unwrap();
    let mut largest = [0.0_f64; 4];
    run.run(50.0 * STEP_S, |step| {
        step.system.sample(step.to, &counts, &mut out);
        let strain = &out[first_strain..first_strain + 4];
        let names = names.iter().map(|(_, channel)| &channel.name[..]);
        let forces = names
            .zip(&out)
            .filter(|(name, _)| name.starts_with("normal_force"));
        let newtons: f64 = forces.map(|(_, force)| force).sum();
        for (largest, value) in largest.iter_mut().zip(strain) {
            *largest = largest.max(value.abs() / newtons);
        }
        std::ops::ControlFlow::Continue(())
    })
    .unwrap();
    // The rows are waves of amplitude 1e-9 a newton, their difference in method 1 one of 1e-10 more; a force lies
    // between two stations, whose rows differ by 0.1 at most: most of a crest is seen while the flank goes by.
    let [first, second] = [1.1e-3, 1e-3];
    for (seen, most) in largest.iter().zip([first, second, first, second]) {
        assert!(*seen <= most && *seen > 0.5 * most, "{largest:?}");
    }
}

#[test]
fn unknown_gauges_are_refused() {
    let pair = pair_a();
    let mesh = running_mesh("hybrid", &pair);
    let model = calibrated_gear(&pair.gear_1);
    let refused = StrainGauges::new(&mesh, 1, &model, &["root"], ModalPart::Included);
    let message = refused.err().unwrap().to_string();
    assert!(
        message.contains("`root`") && message.contains("g0, g1"),
        "{message}"
    );
}
