//! What the gears of bevel stages put on their shafts: forces and moments at the stations where they stand.

use crate::bevel_force::{Line, MeanForce, mean_force};
use crate::gearbox::{BevelSeat, TorqueSeat, Train};
use crate::ledger::About;
use crate::source::Source;
use crate::text::{number, numbers, quoted};
use crate::vectors::{add, cross, dot};

/// Force and moment of one gear on its shaft, world axes. The torque about the axis is not in it.
#[derive(Debug, Clone)]
pub struct BevelLoad {
    /// Shaft: component.
    pub shaft: i64,
    /// Its force along the shaft's z \[N\].
    pub axial_n: f64,
    /// Body of the station.
    body: String,
    name: String,
    force_n: [f64; 3],
    moment_nm: [f64; 3],
}

/// The loads of all bevel stages whose torque is known and whose axes cross; of the others only the torque acts, which
/// is reported.
pub fn bevel_loads(source: &Source<'_>, train: &Train) -> Vec<BevelLoad> {
    let mut loads = Vec::new();
    for seats in train.bevels.chunks_exact(2) {
        let found = force(train, seats);
        for seat in seats {
            let Some(component) = source.part(seat.gear) else {
                continue;
            };
            match found {
                Some(_) => component.assume(About::Small, "no mesh in the scene: its torque, radial and axial forces act on the shaft at the middle of the face, without friction"),
                None => component.leave_out(About::Lost, "no mesh in the scene: its torque acts on the shaft, its radial and axial forces do not, for the axes of the stage do not cross at its shaft angle, or its torque or teeth are not known"),
            }
        }
        let Some((force, pinion)) = found else {
            continue;
        };
        for (side, seat) in seats.iter().enumerate() {
            let sign = if side == pinion { 1.0 } else { -1.0 };
            let force_n = force.on_pinion_n.map(|x| sign * x);
            loads.extend(on_shaft(train, &seat.seat, force.point_mm, force_n));
        }
    }
    loads
}

/// The force, and which of the two seats is the pinion's.
fn force(train: &Train, seats: &[BevelSeat]) -> Option<(MeanForce, usize)> {
    let [first, second] = seats else { return None };
    let pair = first.stage.as_ref()?;
    let pinion = pair.pinion;
    let link = train.flow.torques_nm(first.seat.link.0)?;
    let line = |seat: &TorqueSeat| {
        let shaft = train.shaft(seat.shaft)?;
        Some(Line {
            point_mm: shaft.frame?.point([seat.u_mm, 0.0, 0.0]),
            direction: shaft.z(),
        })
    };
    let mut lines = [line(&first.seat)?, line(&second.seat)?];
    if pinion == 1 {
        lines.reverse();
    }
    // What the shaft brings to the link, the link takes from the shaft.
    Some((mean_force(pair, lines, -link[pinion])?, pinion))
}

fn on_shaft(
    train: &Train,
    seat: &TorqueSeat,
    point_mm: [f64; 3],
    force_n: [f64; 3],
) -> Option<BevelLoad> {
    let shaft = train.shaft(seat.shaft)?;
    let z = shaft.z();
    let station_mm = shaft.frame?.point([seat.u_mm, 0.0, 0.0]);
    let arm_m = add(point_mm, station_mm, -1.0).map(|x| 1e-3 * x);
    let moment = cross(arm_m, force_n);
    Some(BevelLoad {
        shaft: seat.shaft,
        axial_n: dot(force_n, z),
        body: shaft.body(seat.u_mm),
        name: seat.name.clone(),
        force_n,
        moment_nm: add(moment, z, -dot(moment, z)),
    })
}

impl BevelLoad {
    /// Its tables in the scene.
    pub fn text(&self) -> String {
        let table = |what: &str, key: &str, vector: [f64; 3]| {
            let amount = dot(vector, vector).sqrt();
            if amount < 1e-9 {
                return String::new();
            }
            format!(
                "\n[[load]]\nname = {}\nbody = {}\n{key} = {}\nalong = {}\n",
                quoted(&format!("{what} at {}", self.name)),
                quoted(&self.body),
                number(amount),
                numbers(&vector.map(|x| x / amount))
            )
        };
        table("force", "force_N", self.force_n) + &table("moment", "torque_Nm", self.moment_nm)
    }
}
