//! Friction on vibrating gears: it pushes on their modes, and their vibration is part of the sliding.

use std::f64::consts::TAU;
use std::ops::ControlFlow;
use std::sync::Arc;

use gearmesh_contact::ProfileHats;
use gearmesh_drivetrain::pose::Vector6;
use gearmesh_drivetrain::*;
use gearmesh_dynamics::{Params, Simulation};
use gearmesh_geometry::{Flank, GearPair, ToothGeometry};
use gearmesh_model::{ModalBasis, ReducedGear};
use nalgebra::Vector3;

use crate::mesh_common::modal_gear::{MODES, shape, tangential_shape};
use crate::mesh_common::*;
use crate::modal_bodies::in_time::{difference, slow_run};
use crate::modal_bodies::vibrating_pair::*;

const MU: f64 = 0.1;
const GAUGES: [&str; 4] = ["g0", "g1", "g5", "g7"];

/// The same coefficient at any speed of these tests.
fn coulomb() -> Friction {
    Friction::new([MU, MU], [1e-9, 2e-9]).unwrap()
}

/// Gear 2 turns against gear 1, so that all flanks slide.
fn turning(pose: &Pose) -> Pose {
    moving(pose, &Vector6::new(0.0, 0.0, 0.0, 0.0, 0.0, 1.0))
}

fn frequency_squared(mode: usize) -> f64 {
    (TAU * MODES[mode].0).powi(2)
}

/// Sum of what a shape is at the hats of the roll stations, by its height there, with their shares of a force at a roll
/// angle; and its derivative by that angle.
fn at_hats(gear: &ReducedGear, roll_rad: f64, shape: impl Fn(f64) -> f64) -> (f64, f64) {
    let stations = &gear.grid.roll_angles_rad;
    let place = ProfileHats::of_involute(stations).place(roll_rad);
    let last = (stations.len() - 1) as f64;
    let sum = |shares: &mut dyn Iterator<Item = (usize, f64)>| {
        shares
            .map(|(station, share)| share * shape(station as f64 / last))
            .sum()
    };
    (sum(&mut place.shares()), sum(&mut place.rates()))
}

/// Flanks of a gear bent by given modal coordinates, in closed form.
struct Bent {
    model: ReducedGear,
    form_roll_rad: f64,
    coordinates: Vec<f64>,
}

impl FlankError for Bent {
    fn removed(&self, point: FlankPoint) -> Removed {
        let (teeth, side) = (self.model.teeth, point.side.mirror());
        let roll_rad = point.roll_rad.max(self.form_roll_rad);
        let (depth_m, slope) = at_hats(&self.model, roll_rad, |height| {
            let modes = self.coordinates.iter().enumerate();
            modes
                .map(|(mode, eta)| eta * shape(mode, point.tooth, teeth, side, height))
                .sum()
        });
        let walks = point.roll_rad >= self.form_roll_rad;
        Removed {
            depth_m,
            slope_m_per_rad: if walks { slope } else { 0.0 },
            slope_along_axis: 0.0,
        }
    }

    /// No bound is known: all flanks are looked at.
    fn most_added_m(&self) -> f64 {
        f64::INFINITY
    }
}

/// What friction alone makes of a gear's modes at rest, in closed form from the forces on its slices.
fn bent_by_friction(mesh: &GearMesh, model: &ReducedGear, gear: usize, modes: usize) -> Vec<f64> {
    let mut eta = vec![0.0; modes];
    for side in [Flank::Right, Flank::Left] {
        let (found, forces) = mesh.side(side).unwrap();
        let coefficients = mesh.friction(side);
        for (i, contact) in found.contacts.iter().enumerate() {
            let roll_rad = found.section(contact).touching_roll_rad[gear];
            let tooth = found.lines[contact.line].teeth[gear];
            let to_tip_n = side.mirror() * coefficients[i].coefficient * forces[i];
            for (mode, eta) in eta.iter_mut().enumerate() {
                let of_height = |height| tangential_shape(mode, tooth, model.teeth, height);
                let (phi, _) = at_hats(model, roll_rad, of_height);
                *eta += to_tip_n * phi / frequency_squared(mode);
            }
        }
    }
    eta
}

/// With friction a `modal` gear at rest is a `reduced` one whose flanks have the shape that friction gives its modes:
/// what teeth deflect along the normal under a force along the profile is in no reduced gear. Loads and gauges to 1e-9.
#[test]
fn modal_gears_with_friction_at_rest_are_bent_reduced_gears() {
    for pair in pairs() {
        let models = models(&pair);
        for modes in [[COUNT, COUNT], [3, 2]] {
            let mut modal =
                hybrid(&pair, &models, modes, kinematics(&pair)).with_friction(coulomb());
            let mut unbent =
                hybrid(&pair, &models, [0, 0], kinematics(&pair)).with_friction(coulomb());
            // On parallel axes all slices of a spur line have the roll angle that the flanks' shapes are taken at.
            for (side, theta, te) in [
                (Flank::Right, 0.02, -9e-6),
                (Flank::Right, 0.11, -14e-6),
                (Flank::Left, 0.19, -11e-6),
            ] {
                let phi = angles(&pair, side, theta, te);
                let shift = Vector3::new(2e-6, -1e-6, 0.0);
                let at = turning(&pose(&pair, phi, shift, Vector3::zeros()));
                let (eta, found) = at_rest(&mut modal, &at, modes);
                let errors = [0, 1].map(|gear| -> Vec<Arc<dyn FlankError>> {
                    let bent = Bent {
                        model: models[gear].clone(),
                        form_roll_rad: [&pair.gear_1, &pair.gear_2][gear].form_roll_rad,
                        coordinates: bent_by_friction(&modal, &models[gear], gear, modes[gear]),
                    };
                    vec![Arc::new(bent)]
                });
                let bent = kinematics_with(&pair, errors, PathEnds::Extended);
                let mut reduced = hybrid(&pair, &models, [0, 0], bent).with_friction(coulomb());
                let expected = reduced.evaluate(&at, false).unwrap();
                let scale = expected.load.fixed_rows::<3>(0).norm();
                assert!(scale > 100.0);
                let off = (found.load - expected.load).norm() / scale;
                assert!(off < 1e-9, "{modes:?}: {off:e}");
                let without = unbent.evaluate(&at, false).unwrap();
                let share = (found.load - without.load).norm() / scale;
                assert!(share > 1e-3, "friction bends the flanks: {share:e}");
                for gear in [1, 2] {
                    let own = match gear {
                        1 => &eta[..modes[0]],
                        _ => &eta[modes[0]..],
                    };
                    let model = &models[gear - 1];
                    let read = |mesh: &GearMesh, part, eta: &[f64]| {
                        let gauges = StrainGauges::new(mesh, gear, model, &GAUGES, part);
                        gauges.unwrap().read(mesh, eta).to_vec()
                    };
                    let expected = read(&reduced, ModalPart::Included, &[]);
                    let found = read(&modal, ModalPart::Included, own);
                    let elsewhere = read(&modal, ModalPart::ElsewhereIncluded, own);
                    for (k, (found, expected)) in found.iter().zip(&expected).enumerate() {
                        let scale = expected.method_2.abs();
                        assert!((found.method_1 - expected.method_1).abs() < 1e-9 * scale);
                        assert!((found.method_2 - expected.method_2).abs() < 1e-9 * scale);
                        let number = model.gauges.iter().position(|g| g.name == GAUGES[k]);
                        let basis = model.modal_basis().unwrap();
                        let vibration: f64 = (own.iter().enumerate())
                            .map(|(m, eta)| basis.gauges[m * 8 + number.unwrap()] * eta)
                            .sum();
                        let off = found.method_1 - elsewhere[k].method_1 - vibration;
                        assert!(off.abs() < 1e-9 * scale, "{off:e} of {scale:e}");
                    }
                }
            }
        }
    }
}

/// Where the whole gear turns as one mode, φ = σ r_b and φ_t = σ r_b ξ on its flanks, friction's force on the mode is
/// its moment about the axis: exactly on gear 1, on whose flank the contact lies; on gear 2 but for the deflection over
/// the radius.
#[test]
fn friction_on_a_turning_mode_is_its_moment() {
    for pair in pairs() {
        let turns = |gear: ReducedGear, tooth: &ToothGeometry| {
            let radius = tooth.base_radius_m;
            let axial = gear.grid.z_m.len();
            let hats = ProfileHats::of_involute(&gear.grid.roll_angles_rad);
            let mut flank = Vec::new();
            for _ in 0..gear.teeth {
                for sigma in [1.0, -1.0] {
                    for load in 0..gear.grid.len() {
                        let roll_rad = hats.centroids()[load / axial];
                        flank.extend([sigma * radius, sigma * radius * roll_rad, 0.0]);
                    }
                }
            }
            ReducedGear {
                modes: Some(ModalBasis {
                    nodal_diameters: vec![0],
                    // So stiff that it does not deflect.
                    omega_squared: vec![1e20],
                    complete_to_hz: 1.0,
                    flank,
                    gauges: vec![0.0; gear.gauges.len()],
                    coupling: vec![0.0; 6],
                }),
                ..gear
            }
        };
        let models = [&pair.gear_1, &pair.gear_2].map(|tooth| turns(made_up_gear(tooth), tooth));
        let new = || hybrid(&pair, &models, [1, 1], kinematics(&pair));
        let (mut smooth, mut rough) = (new(), new().with_friction(coulomb()));
        for (side, theta) in [
            (Flank::Right, 0.02),
            (Flank::Right, 0.11),
            (Flank::Left, 0.19),
        ] {
            let phi = angles(&pair, side, theta, -10e-6);
            let at = turning(&pose(&pair, phi, Vector3::zeros(), Vector3::zeros()));
            let of = |mesh: &mut GearMesh| {
                let load = mesh.evaluate(&at, false).unwrap().load;
                let force: Vector3<f64> = load.fixed_rows::<3>(0).into();
                let on_1 = -load[5] - at.displacement_m.cross(&force)[2];
                (
                    [on_1, load[5]],
                    [mesh.modal_loads().force[0], mesh.modal_loads().force[1]],
                )
            };
            let (moments, modal) = of(&mut smooth);
            let (moments_rough, modal_rough) = of(&mut rough);
            for (gear, tolerance) in [(0, 1e-10), (1, 2e-3)] {
                let moment = moments_rough[gear] - moments[gear];
                let on_mode = modal_rough[gear] - modal[gear];
                assert!(moment.abs() > 1e-3 * moments[gear].abs());
                let off = (on_mode / moment - 1.0).abs();
                assert!(off < tolerance, "{side:?} {theta} gear {gear}: {off:e}");
            }
        }
    }
}

/// Made-up motions of the gears and their modes.
fn motion(seed: usize) -> (Vector6, Vec<f64>) {
    let value = |i: usize| ((11 * seed + 5 * i + 2) as f64).sin();
    let rates = Vector6::from_fn(|i, _| if i < 3 { 0.01 } else { 0.2 } * value(i));
    (rates, (0..2 * COUNT).map(|i| 0.03 * value(6 + i)).collect())
}

/// Friction spends energy, and exactly what it takes out of the motion of the gears and of their modes; where μ does
/// not change with the speed, its force on each rate is minus the change of the power with it.
#[test]
fn power_of_friction_on_gears_and_modes_balances() {
    for pair in pairs() {
        let models = models(&pair);
        let soft = Friction::new([0.12, 0.07], [2e-3, 2e-2]).unwrap();
        for (friction, is_constant) in [(coulomb(), true), (soft, false)] {
            let new = || hybrid(&pair, &models, [COUNT, COUNT], kinematics(&pair));
            let (mut smooth, mut rough) = (new(), new().with_friction(friction));
            for at in loaded_poses(&pair) {
                check_power_of_friction((&mut smooth, &mut rough), &at, is_constant);
            }
        }
    }
}

/// What friction takes out of the motion of gears and modes, both gears with all modes, is what it spends.
pub fn check_power_of_friction(
    (smooth, rough): (&mut GearMesh, &mut GearMesh),
    at: &Pose,
    is_constant: bool,
) {
    let (eta, _) = at_rest(smooth, at, [COUNT, COUNT]);
    for seed in 0..5 {
        let (rates, modal_rates) = motion(seed);
        let of = |mesh: &mut GearMesh, rates: &Vector6, modal_rates: &[f64]| {
            let motion = ModalMotion {
                coordinates: [&eta[..COUNT], &eta[COUNT..]],
                rates: [&modal_rates[..COUNT], &modal_rates[COUNT..]],
            };
            let load = mesh.evaluate_modal(&moving(at, rates), &motion, false);
            (load.unwrap(), mesh.modal_loads().force.clone())
        };
        let (load, force) = of(rough, &rates, &modal_rates);
        let (normal, normal_force) = of(smooth, &rates, &modal_rates);
        assert_eq!(normal.power.dissipated_w, 0.0);
        let on_gears = -(load.load - normal.load).dot(&rates);
        let on_modes: f64 = (force.iter().zip(&normal_force).zip(&modal_rates))
            .map(|((with, without), rate)| -(with - without) * rate)
            .sum();
        let spent = load.power.dissipated_w;
        assert!(spent > 0.0 && on_modes.abs() > 1e-3 * spent);
        let off = (on_gears + on_modes - spent).abs() / spent;
        assert!(off < 1e-9, "{seed}: {off:e}");
        if !is_constant {
            continue;
        }
        let mut power = |rates: &Vector6, modal_rates: &[f64]| {
            of(rough, rates, modal_rates).0.power.dissipated_w
        };
        let h = 1e-7;
        for mode in 0..2 * COUNT {
            let mut at = |by: f64| {
                let mut changed = modal_rates.clone();
                changed[mode] += by;
                power(&rates, &changed)
            };
            let slope = (at(h) - at(-h)) / (2.0 * h);
            let expected = normal_force[mode] - force[mode];
            let scale = normal.load.fixed_rows::<3>(0).norm() * MU;
            assert!((slope - expected).abs() < 1e-7 * scale, "mode {mode}");
        }
    }
}

/// Gears whose modes without nodal diameters friction moves, one against the other: Σ φ φ_tᵀ/ω² = 0, so that at rest no
/// flank deflects to a force along the profile, as in `reduced` gears.
fn gears_that_bend_to_friction_in_motion_only(pair: &GearPair) -> [ReducedGear; 2] {
    models(pair).map(|mut gear| {
        let loads = gear.grid.len();
        let basis = gear.modes.as_mut().unwrap();
        let of_mode = gear.teeth * 2 * loads * 3;
        for (place, component) in basis.flank.iter_mut().enumerate() {
            if place % 3 == 1 {
                *component = match place / of_mode {
                    0 => 0.3 * frequency_squared(0) / frequency_squared(5) * 0.4 / 0.35,
                    5 => -0.3,
                    _ => 0.0,
                };
            }
        }
        gear
    })
}

/// At low speed a `modal` gear is a `reduced` one with friction, too: transmission error and both methods' strain at
/// the gauges differ by the square of the speed, and hardly more than without friction (1e-4 of the transmission
/// error's peak-to-peak value and 7e-3 of the strain's at 2 rad/s, where the strain bends as pairs come and go). μ is
/// the same at the same angle for all speeds.
#[test]
fn slow_modal_gears_with_friction_are_reduced_gears() {
    let pair = spur_pair();
    let models = gears_that_bend_to_friction_in_motion_only(&pair);
    let gauges = ["g3", "g4"];
    let columns = 1 + 2 * gauges.len();
    let worst = |speed: f64, friction: Option<Friction>| -> Vec<f64> {
        let [reduced, modal] = [[0, 0], [COUNT, COUNT]]
            .map(|modes| slow_run(&pair, (&models, modes), (friction, &gauges), speed));
        let relative = |column| {
            let [peak_to_peak, off] = difference(&reduced, &modal, column);
            off / peak_to_peak
        };
        (0..columns).map(relative).collect()
    };
    let rubbing = [8.0, 4.0, 2.0].map(|speed: f64| {
        let friction = Friction::new([MU, MU], [3e-3 * speed, 6e-3 * speed]).unwrap();
        worst(speed, Some(friction))
    });
    let smooth = worst(2.0, None);
    for column in 0..columns {
        let of = rubbing.each_ref().map(|worst| worst[column]);
        assert!(of[2] < 1.6 * smooth[column], "{column}: {of:?} {smooth:?}");
        for pair in of.windows(2) {
            assert!(
                (2.8..5.0).contains(&(pair[0] / pair[1])),
                "{column}: {of:?}"
            );
        }
    }
}

/// The balance of energy closes with friction on vibrating gears, the better the shorter the step.
#[test]
fn energy_of_vibrating_pairs_with_friction_balances() {
    let pair = spur_pair();
    let models = models(&pair);
    let modes = [COUNT, COUNT];
    let ratio = pair.gear_1.base_radius_m / pair.gear_2.base_radius_m;
    let run = |step_s: f64| {
        let friction = Friction::new([MU, MU], [0.05, 0.1]).unwrap();
        let mesh = hybrid(&pair, &models, modes, relieved_kinematics(&pair));
        let mesh = (mesh.with_friction(friction), 60.0, -4e-6, 0.0);
        let (mut builder, markers) = scene(&pair, &models, modes, mesh);
        torque(&mut builder, "drive", markers[0], -60.0 * ratio);
        torque(&mut builder, "load", markers[1], -60.0);
        let params = Params {
            rho_infinity: 1.0,
            newton_tolerance: Some(1e-12),
            ..Params::fixed(step_s)
        };
        let mut run = Simulation::new(builder.build().unwrap(), params).unwrap();
        run.run(5e-3, |_| ControlFlow::Continue(())).unwrap();
        *run.info()
    };
    let infos = [4e-6, 2e-6, 1e-6].map(run);
    let errors = infos.map(|info| info.energy.largest_error_j);
    let spent = infos[2].energy.dissipated_j;
    assert!(spent > 5e-3, "{spent}");
    assert!(errors[2] < 1e-4 * spent, "{errors:?} of {spent}");
    assert!(errors[2] < 0.2 * errors[0], "{errors:?}");
    // Tangents that leave out what friction does to the modes would cost iterations.
    let per_step = infos[1].iterations as f64 / infos[1].steps as f64;
    assert!(per_step < 5.0, "{per_step}");
}
