//! Gear 1 and gear 2 exchanged: the same loads on the same bodies, whatever the pair, its faces, its pose and the
//! model. Without friction, which acts on gear 1's flank: it differs by the deflection over the radius.

use gearmesh_contact::{LocalContact, SliceLayout};
use gearmesh_drivetrain::pose::Vector6;
use gearmesh_drivetrain::*;
use gearmesh_geometry::definition::ToothDefinition;
use gearmesh_geometry::{Flank, GearPair, ToothGeometry};
use nalgebra::Vector3;
use proptest::prelude::*;

use crate::mesh_common::*;

/// One case.
#[derive(Debug, Clone)]
struct Case {
    teeth: [usize; 2],
    shifts: [f64; 2],
    helix_deg: f64,
    widths_m: [f64; 2],
    slices: [usize; 2],
    offset_m: [f64; 2],
    displacement_m: f64,
    tilt_rad: [f64; 2],
    theta_rad: f64,
    depth_m: f64,
    rates: [f64; 6],
    ends: PathEnds,
}

fn cases() -> impl Strategy<Value = Case> {
    let pair = (
        [18usize..70, 18usize..70],
        [-0.2f64..0.5, -0.2f64..0.5],
        prop_oneof![Just(0.0), -28.0f64..28.0],
        [8e-3f64..30e-3, 8e-3f64..30e-3],
        [1usize..5, 1usize..5],
    );
    let pose = (
        [-1e-4f64..4e-4, -2e-4f64..2e-4],
        -0.4f64..0.4,
        [-1e-3f64..1e-3, -1e-3f64..1e-3],
        0.0f64..6.0,
        8e-6f64..30e-6,
        std::array::from_fn::<_, 6, _>(|_| -1.0f64..1.0),
        prop_oneof![Just(PathEnds::Extended), Just(PathEnds::LineOfAction)],
    );
    (pair, pose).prop_map(|(pair, pose)| Case {
        teeth: pair.0,
        shifts: pair.1,
        helix_deg: pair.2,
        widths_m: pair.3,
        slices: pair.4,
        offset_m: pose.0,
        displacement_m: pose.1 * (pair.3[0] + pair.3[1]),
        tilt_rad: pose.2,
        theta_rad: pose.3,
        depth_m: pose.4,
        rates: pose.5,
        ends: pose.6,
    })
}

impl Case {
    fn pair(&self) -> Option<GearPair> {
        let gear = |i: usize, sense: f64| {
            ToothGeometry::new(&ToothDefinition {
                helix_angle_rad: sense * self.helix_deg.to_radians(),
                ..pair_common::tooth(self.teeth[i], self.shifts[i], 0.0)
            })
            .ok()
        };
        let (gear_1, gear_2) = (gear(0, 1.0)?, gear(1, -1.0)?);
        let shifts = 3e-3 * (self.shifts[0] + self.shifts[1]);
        let centre = gear_1.reference_radius_m + gear_2.reference_radius_m + shifts;
        GearPair::new(gear_1, gear_2, centre, Default::default()).ok()
    }

    /// The mesh with gear 1 and gear 2 in this order, `first` the number of the gear that is gear 1.
    fn mesh(&self, name: &str, pair: &GearPair, first: usize) -> GearMesh {
        let order = [first, 1 - first];
        let widths = order.map(|i| self.widths_m[i]);
        let sense = if first == 0 { 1.0 } else { -1.0 };
        let displacement = sense * self.displacement_m;
        let mut layout = SliceLayout::new(widths, displacement, 3);
        let middle = pair.working_pressure_angle_rad.tan();
        let model: Box<dyn TeethModel> = match name {
            "impact" => {
                let law = PowerStiffness::n_per_mm_e(2e6, 1.5).unwrap();
                Box::new(Impact::new(law, 3e3, 5e-6, 3).unwrap())
            }
            "iso6336" => {
                // Constant: a sine has its phase by gear 1.
                Box::new(MeshSpring::new(3e8, 3, middle).unwrap())
            }
            "analytic" => {
                let width = layout.reference.width_m;
                let gears =
                    [(1, &pair.gear_1), (2, &pair.gear_2)].map(|(number, gear)| BeamTooth {
                        face_width_m: width,
                        ..beam_tooth(number, gear)
                    });
                Box::new(BeamTeeth::new(gears, 3, [&[], &[]]).unwrap())
            }
            _ => {
                let gears = [&pair.gear_1, &pair.gear_2];
                let models = [0, 1].map(|k: usize| {
                    let i = order[k];
                    pair_common::made_up_gear(gears[k], self.widths_m[i], self.slices[i])
                });
                let local = (LocalContact::WeberBanaschek, displacement);
                let models = [&models[0], &models[1]];
                let side = Flank::Right;
                let teeth = ReducedTeeth::displaced(pair, side, models, local, 4e3).unwrap();
                layout = *teeth.layout();
                Box::new(teeth)
            }
        };
        let gears = [pair.gear_1.clone(), pair.gear_2.clone()];
        let none = [Vec::new(), Vec::new()];
        let a = pair.centre_distance_m;
        let kinematics = MeshKinematics::new(gears, none, a, layout, self.ends).unwrap();
        GearMesh::new(kinematics, Flank::Right, model).unwrap()
    }

    /// Loads on gear 2 and on gear 1 about gear 1's origin by both orders of the gears, and the stored energies.
    fn loads(&self, name: &str, pair: &GearPair) -> [(Vector6, f64); 2] {
        let swapped = GearPair {
            gear_1: pair.gear_2.clone(),
            gear_2: pair.gear_1.clone(),
            ..pair.clone()
        };
        let [phi_1, phi_2] = angles(pair, Flank::Right, self.theta_rad, -self.depth_m);
        let screw = screw_rad(pair, self.displacement_m);
        let shift = Vector3::new(self.offset_m[0], self.offset_m[1], self.displacement_m);
        let tilt = Vector3::new(self.tilt_rad[0], self.tilt_rad[1], 0.0);
        let rates = Vector6::from_row_slice(&self.rates) * 0.01;
        let at = moving(&pose(pair, [phi_1, phi_2 + screw], shift, tilt), &rates);
        let back = at.rotation.transpose();
        // The same motion as seen by gear 2: u₁ = −Qᵀu, ω₁ = −Qᵀω, u̇₁ = −Qᵀ(u̇ − ω × u).
        let (u, omega) = (at.displacement_m, at.angular_velocity_rad_per_s);
        let seen_from_2 = Pose {
            displacement_m: -back * u,
            rotation: back,
            velocity_m_per_s: -back * (at.velocity_m_per_s - omega.cross(&u)),
            angular_velocity_rad_per_s: -back * omega,
        };
        let on_2 = self.mesh(name, pair, 0).evaluate(&at, false).unwrap();
        let on_1 = self
            .mesh(name, &swapped, 1)
            .evaluate(&seen_from_2, false)
            .unwrap();
        let parts = |load: &Vector6| -> (Vector3<f64>, Vector3<f64>) {
            (
                load.fixed_rows::<3>(0).into(),
                load.fixed_rows::<3>(3).into(),
            )
        };
        let (force, moment) = parts(&on_2.load);
        let (back_force, back_moment) = parts(&on_1.load);
        let stack =
            |f: Vector3<f64>, m: Vector3<f64>| Vector6::new(f[0], f[1], f[2], m[0], m[1], m[2]);
        let first = stack(force, moment + u.cross(&force));
        let second = stack(-at.rotation * back_force, -at.rotation * back_moment);
        [(first, on_2.power.stored_j), (second, on_1.power.stored_j)]
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..ProptestConfig::default() })]

    /// Forces within 1e-9 of the force, moments within 1e-9 of the force at a tenth of a metre, energies within 1e-9.
    #[test]
    fn exchanging_the_gears_changes_nothing(case in cases()) {
        let pair = case.pair();
        prop_assume!(pair.as_ref().is_some_and(|pair| pair.contact_ratio() > 1.0));
        let pair = pair.unwrap();
        for name in MODELS {
            // Wheels outside the foundation's fit.
            if name == "analytic" && case.teeth.iter().any(|z| !(26..60).contains(z)) {
                continue;
            }
            let [(first, stored), (second, other)] = case.loads(name, &pair);
            let force = first.fixed_rows::<3>(0).norm();
            // Gaps are known to rounding, 1e-16 m.
            if force < 100.0 {
                continue;
            }
            let off = first - second;
            let (f, m) = (off.fixed_rows::<3>(0).norm(), off.fixed_rows::<3>(3).norm());
            prop_assert!(f < 1e-9 * force && m < 1e-10 * force, "{name}: {f:e}, {m:e} of {force:e}");
            prop_assert!((stored - other).abs() < 1e-9 * stored + 1e-16 * force, "{name}: {stored:e} {other:e}");
        }
    }
}
