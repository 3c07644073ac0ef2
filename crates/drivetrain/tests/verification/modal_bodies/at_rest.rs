//! Gears with modes under forces at rest are gears without.

use std::f64::consts::TAU;

use gearmesh_drivetrain::*;

use crate::mesh_common::modal_gear::MODES;
use crate::mesh_common::*;
use crate::modal_bodies::vibrating_pair::*;

/// the whole compliance. Loads to 1e-9, those of the walking contacts included.
#[test]
fn modal_gears_at_rest_are_reduced_gears() {
    for pair in pairs() {
        let models = models(&pair);
        let mut reduced = hybrid(&pair, &models, [0, 0], kinematics(&pair));
        for modes in [[COUNT, COUNT], [3, 0], [0, 2]] {
            let mut modal = hybrid(&pair, &models, modes, kinematics(&pair));
            for at in loaded_poses(&pair) {
                let expected = reduced.evaluate(&at, false).unwrap();
                let (eta, found) = at_rest(&mut modal, &at, modes);
                let scale = expected.load.fixed_rows::<3>(0).norm();
                assert!(scale > 100.0);
                let off = (found.load - expected.load).norm() / scale;
                assert!(off < 1e-9, "{modes:?}: {off:e}");
                let strain: f64 = eta
                    .iter()
                    .enumerate()
                    .map(|(i, eta)| {
                        let mode = if i < modes[0] { i } else { i - modes[0] };
                        0.5 * (TAU * MODES[mode].0 * eta).powi(2)
                    })
                    .sum();
                assert!(
                    strain > 1e-3 * expected.power.stored_j,
                    "the modes carry a share"
                );
                let whole = found.power.stored_j + strain;
                let off = (whole / expected.power.stored_j - 1.0).abs();
                assert!(off < 1e-9, "{modes:?}: energy {off:e}");
            }
        }
    }
}

/// At rest a gauge on a `modal` gear reads what it reads on a `reduced` one, with all modes or some, by both methods.
#[test]
fn gauges_at_rest_read_as_on_reduced_gears() {
    for pair in pairs() {
        let models = models(&pair);
        let names = ["g0", "g1", "g5", "g7"];
        let mut reduced = hybrid(&pair, &models, [0, 0], kinematics(&pair));
        let part = ModalPart::Included;
        for modes in [[COUNT, COUNT], [3, 2]] {
            let mut modal = hybrid(&pair, &models, modes, kinematics(&pair));
            for at in loaded_poses(&pair) {
                reduced.evaluate(&at, false).unwrap();
                let (eta, _) = at_rest(&mut modal, &at, modes);
                for gear in [1, 2] {
                    let model = &models[gear - 1];
                    let own = match gear {
                        1 => &eta[..modes[0]],
                        _ => &eta[modes[0]..],
                    };
                    let gauges = |mesh, part| StrainGauges::new(mesh, gear, model, &names, part);
                    let expected = gauges(&reduced, part).unwrap().read(&reduced, &[]).to_vec();
                    let found = gauges(&modal, part).unwrap().read(&modal, own).to_vec();
                    let elsewhere = gauges(&modal, ModalPart::ElsewhereIncluded).unwrap();
                    let without = elsewhere.clone().read(&modal, own).to_vec();
                    for (k, (found, expected)) in found.iter().zip(&expected).enumerate() {
                        let scale = expected.method_2.abs();
                        assert!(scale > 1e-8);
                        assert!((found.method_1 - expected.method_1).abs() < 1e-9 * scale);
                        assert!((found.method_2 - expected.method_2).abs() < 1e-9 * scale);
                        assert!((found.method_2 - without[k].method_2).abs() > 1e-3 * scale);
                    }
                }
            }
        }
    }
}
