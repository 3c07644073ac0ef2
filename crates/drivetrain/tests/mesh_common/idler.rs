//! An idler between two wheels on fixed axes, made-up gears on soft rims.

use std::f64::consts::TAU;
use std::sync::Arc;
use std::sync::atomic::AtomicUsize;

use gearmesh_bearings::bearing_file::BearingFromFile;
use gearmesh_bearings::definition::BearingMaterial;
use gearmesh_bearings::{Control, QuasiStaticElement, RingDamping};
use gearmesh_contact::LocalContact;
use gearmesh_drivetrain::*;
use gearmesh_dynamics::elements::{AppliedLoad, Axes, LoadKind};
use gearmesh_dynamics::{Joint, JointKind, Marker, MarkerPair, System, TimeFunction};
use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{Flank, GearPair, Misalignment};
use gearmesh_model::{RadialMotions, ReducedGear, bore_wave};

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
#[derive(Clone, Copy)]
pub struct Meshes {
    pub damping: Option<Damping>,
    pub ends: PathEnds,
    pub coupled: bool,
    /// The idler runs on rollers, on a bore so many times stiffer than that of a rim.
    pub rollers: Option<Rollers>,
}

/// Rollers in the idler's bore.
#[derive(Clone, Copy)]
pub struct Rollers {
    /// How many times stiffer than a rim the bore is; none: it is round.
    pub bore: Option<f64>,
    pub number: usize,
    pub young_pa: f64,
    pub clearance_m: f64,
    /// Where the idler stands beside its pin \[m\].
    pub beside_m: [f64; 2],
}

/// Straight rollers of 6 mm in a bore of 40 mm.
fn bearing(rollers: &Rollers, [gear, pin]: [Marker; 2]) -> QuasiStaticElement {
    let material = BearingMaterial {
        young_pa: rollers.young_pa,
        ..BearingMaterial::STEEL
    };
    let file = format!(
        "name = \"rollers\"\nkind = \"cylindrical-roller\"\nrollers = {}\nroller_diameter_mm = 6.0\nroller_length_mm = 15.0\n\
         pitch_diameter_mm = 34.0\nradial_clearance_um = {:?}\nfirst_angle_deg = 7.0\nlaminae = 4\n\
         profile = {{ kind = \"straight\" }}\n",
        rollers.number,
        1e6 * rollers.clearance_m
    );
    let document = InputDocument::new("rollers.toml", file);
    let mut definition = BearingFromFile::from_document(&document)
        .unwrap()
        .definition;
    definition.element_material = material;
    definition.ring_material = material;
    let rings = MarkerPair { a: gear, b: pin };
    let damping = RingDamping::default();
    QuasiStaticElement::new("rollers", rings, &definition, Control::default(), damping).unwrap()
}

/// Motions of the idler's bore up to the fourth harmonic, constant along it: flanks move with the rim beneath them,
/// tips more, against the inward normal where it moves outward; a bore that grows evenly is stiff and moves no flank.
pub fn bore_motions(gear: &ReducedGear, stiffer: f64) -> RadialMotions {
    let waves: Vec<usize> = [0, 3, 4, 5, 6, 7, 8].into();
    let order = |wave: usize| wave.div_ceil(2) as f64;
    let count = waves.len();
    let stiffness = |i: usize, j: usize| {
        let n = order(waves[i]);
        let own = if i == j {
            if n > 0.0 { 1e8 * n.powi(4) } else { 1e10 }
        } else {
            2e7
        };
        stiffer * own
    };
    let mut flank = Vec::new();
    for tooth in 0..gear.teeth {
        let polar_rad = TAU * tooth as f64 / gear.teeth as f64;
        for load in 0..gear.flanks.len() * gear.grid.len() {
            let size = -0.3 - 0.01 * (load % gear.grid.len()) as f64;
            let shape = |wave: &usize| match wave {
                0 => 0.0,
                _ => size * bore_wave(*wave, polar_rad + 0.1),
            };
            flank.extend(waves.iter().map(shape));
        }
    }
    RadialMotions {
        along: 1,
        radius_m: 20e-3,
        ends_m: [-0.5 * WIDTH, 0.5 * WIDTH],
        motions: waves.iter().map(|&wave| [wave, 0]).collect(),
        stiffness: (0..count * count)
            .map(|k| stiffness(k / count, k % count))
            .collect(),
        flank,
        gauges: Vec::new(),
    }
}

/// Undamped and coupled, on the rigid path.
pub const PLAIN: Meshes = Meshes {
    damping: None,
    ends: PathEnds::LineOfAction,
    coupled: true,
    rollers: None,
};

/// Bodies turned so that both meshes overlap by these depths \[m\], the idler turning at a speed, a torque on the first
/// wheel and the balancing one on the last.
pub fn idler(theta: f64, depths_m: [f64; 2], how: Meshes, load: (f64, f64)) -> System {
    idler_counted(theta, depths_m, how, load).0
}

/// The same, with the count of its solutions of both meshes together.
pub fn idler_counted(
    theta: f64,
    depths_m: [f64; 2],
    how: Meshes,
    (speed_rad_per_s, torque_nm): (f64, f64),
) -> (System, Arc<AtomicUsize>) {
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
        let pin = Marker::ground([x, y, 0.0]);
        let rollers = how.rollers.filter(|_| name == "idler");
        if let Some(rollers) = rollers {
            body.position_m.x += rollers.beside_m[0];
            body.position_m.y += rollers.beside_m[1];
        }
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
        let kind = match rollers {
            Some(_) => JointKind::Planar,
            None => JointKind::Revolute,
        };
        let joint = Joint::new(name, kind, pin, Marker::at(id, [0.0; 3]));
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
        return (builder.build().unwrap(), Arc::default());
    }
    let pin = Marker::ground([a, 0.0, 0.0]);
    let bearing = how
        .rollers
        .map(|rollers| bearing(&rollers, [markers[1], pin]));
    let stiffer = how.rollers.and_then(|rollers| rollers.bore);
    let motions = bore_motions(&shared, stiffer.unwrap_or(1.0));
    let mut gears = Vec::new();
    match (bearing, stiffer) {
        (Some(bearing), Some(_)) => gears.push(GearOnRollers {
            bearing,
            gear: &shared,
            motions: &motions,
        }),
        (Some(bearing), None) => {
            builder.element(bearing);
        }
        (None, _) => {}
    }
    let (together, parts, bearings) = CoupledMeshes::new("together", meshes.into(), gears).unwrap();
    assert_eq!(together.link_count(), 1);
    let solutions = together.solutions();
    builder.element(together);
    for bearing in bearings {
        builder.element(bearing);
    }
    for part in parts {
        builder.element(part);
    }
    (builder.build().unwrap(), solutions)
}
