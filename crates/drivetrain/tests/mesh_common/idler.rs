//! An idler between two wheels on fixed axes, made-up gears on soft rims.

use gearmesh_contact::LocalContact;
use gearmesh_drivetrain::*;
use gearmesh_dynamics::elements::{AppliedLoad, Axes, LoadKind};
use gearmesh_dynamics::{Joint, JointKind, Marker, System, TimeFunction};
use gearmesh_geometry::{Flank, GearPair, Misalignment};

use super::*;

/// Direction from the idler to the second wheel, against that from the first wheel to the idler \[rad\].
const GAMMA: f64 = 0.9;

/// Wheel and idler, idler and second wheel.
pub fn pairs() -> [GearPair; 2] {
    let first = spur_pair();
    let gears = [first.gear_2.clone(), first.gear_1.clone()];
    let [idler, wheel] = gears;
    let second = GearPair::new(
        idler,
        wheel,
        first.centre_distance_m,
        Misalignment::default(),
    )
    .unwrap();
    [first, second]
}

/// Sides of gear 1 that press in the first mesh and in the second.
pub const SIDES: [Flank; 2] = [Flank::Right, Flank::Left];

pub fn teeth(pair: &GearPair, side: Flank) -> ReducedTeeth {
    let models = [&pair.gear_1, &pair.gear_2].map(|gear| on_soft_rim(made_up_gear(gear)));
    ReducedTeeth::new(
        pair,
        side,
        [&models[0], &models[1]],
        LocalContact::WeberBanaschek,
        1e4,
    )
    .unwrap()
}

/// How the meshes of an idler are put together.
pub struct Meshes {
    pub damping: Option<Damping>,
    pub ends: PathEnds,
    pub coupled: bool,
}

/// Undamped and coupled, on the rigid path.
pub const PLAIN: Meshes = Meshes {
    damping: None,
    ends: PathEnds::LineOfAction,
    coupled: true,
};

/// Bodies turned so that both meshes overlap by these depths \[m\], the idler turning at a speed, a torque on the first
/// wheel and the balancing one on the last.
pub fn idler(
    theta: f64,
    depths_m: [f64; 2],
    how: Meshes,
    (speed_rad_per_s, torque_nm): (f64, f64),
) -> System {
    let [first, second] = pairs();
    let a = first.centre_distance_m;
    let [wheel_1, idler] = angles(&first, SIDES[0], theta, -depths_m[0]);
    // The turn of the idler says where the second mesh is.
    let turn = |at: f64| angles(&second, SIDES[1], at, -depths_m[1])[0] + GAMMA;
    let slope = (turn(1e-2) - turn(0.0)) / 1e-2;
    let at = (idler - turn(0.0)) / slope;
    let wheel_2 = angles(&second, SIDES[1], at, -depths_m[1])[1] + GAMMA;
    let mut builder = System::builder();
    let places = [
        ("wheel 1", &first.gear_1, [0.0, 0.0], wheel_1),
        ("idler", &first.gear_2, [a, 0.0], idler),
        (
            "wheel 2",
            &first.gear_1,
            [a * (1.0 + GAMMA.cos()), a * GAMMA.sin()],
            wheel_2,
        ),
    ];
    let mut markers = Vec::new();
    for (name, gear, [x, y], angle) in places {
        let ratio = first.gear_2.base_radius_m / gear.base_radius_m;
        let turns = if name == "idler" { 1.0 } else { -1.0 };
        let speed = turns * ratio * speed_rad_per_s;
        let mut body = disc(name, gear, WIDTH, (x, angle, speed));
        body.position_m.y = y;
        let id = builder.body(body).unwrap();
        if torque_nm != 0.0 && name != "idler" {
            // The first wheel drives clockwise.
            let sense = if name == "wheel 1" { -1.0 } else { 1.0 };
            let load = TimeFunction::Constant(sense * torque_nm);
            let axis = (Axes::World, [0.0, 0.0, 1.0]);
            let load =
                AppliedLoad::new(&format!("{name} torque"), id, LoadKind::Torque, axis, load);
            builder.element(load.unwrap());
        }
        let joint = Joint::new(
            name,
            JointKind::Revolute,
            Marker::ground([x, y, 0.0]),
            Marker::at(id, [0.0; 3]),
        );
        builder.joint(joint.unwrap());
        markers.push(Marker::at(id, [0.0; 3]));
    }
    let pairs = [first, second];
    let shared = on_soft_rim(made_up_gear(&pairs[0].gear_2));
    let meshes = [0, 1].map(|number: usize| {
        let (pair, side) = (&pairs[number], SIDES[number]);
        let model: Box<dyn TeethModel> = match how.damping {
            None => Box::new(teeth(pair, side)),
            Some(damping) => Box::new(Damped::new(teeth(pair, side), damping, SLICES).unwrap()),
        };
        let kinematics = kinematics_with(pair, [Vec::new(), Vec::new()], how.ends);
        let mesh = GearMesh::new(kinematics, side, model).unwrap();
        let ends = [markers[number], markers[number + 1]];
        let mut models = [None; 2];
        models[1 - number] = Some(&shared);
        MeshToCouple {
            element: MeshElement::new(["first", "second"][number], ends, mesh),
            models,
        }
    });
    if !how.coupled {
        for mesh in meshes {
            builder.element(mesh.element);
        }
        return builder.build().unwrap();
    }
    let (together, parts) = CoupledMeshes::new("together", meshes.into()).unwrap();
    assert_eq!(together.link_count(), 1);
    builder.element(together);
    for part in parts {
        builder.element(part);
    }
    builder.build().unwrap()
}
