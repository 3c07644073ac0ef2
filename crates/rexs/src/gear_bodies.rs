//! The bodies of gears in the scene. Most sit on a station of their shaft; one that turns loose has a place of its own,
//! and so has a second gear at the place of another one, to which it is fixed.

use crate::gearbox::{SeatedGear, Train};
use crate::ledger::About;
use crate::shaft::Shaft;
use crate::source::Source;
use crate::text::{numbers, quoted};
use crate::vectors::Frame;

/// What a gear is fixed to, where it does not sit on a station of its shaft.
enum Place<'a> {
    /// On a station, which it takes.
    Station,
    /// Held by its bearings or clutch alone.
    Free(&'a Shaft),
    /// Fixed to the gear that has the station.
    Beside(&'a Shaft, &'a str),
}

fn place<'a>(train: &'a Train, seated: &SeatedGear) -> Place<'a> {
    let Some(shaft) = train.shaft(seated.shaft) else {
        return Place::Station;
    };
    if shaft.hub_on.is_some() {
        return Place::Free(shaft);
    }
    match shaft.seated(shaft.station(seated.mid_mm)) {
        Some(first) if first != seated.gear.name => Place::Beside(shaft, first),
        _ => Place::Station,
    }
}

/// Tables of all gears: bodies, and joints of those that stand at the place of another one. `file` is what a body names
/// as its gear.
pub fn gear_bodies(
    source: &Source<'_>,
    train: &Train,
    file: impl Fn(&SeatedGear) -> String,
) -> String {
    let mut text = String::new();
    let mut joints = String::new();
    for seated in train.gears.iter().filter(|g| g.shaft >= 0) {
        let name = quoted(&seated.gear.name);
        text.push_str(&format!(
            "\n[[body]]\nname = {name}\ngear = {}\n",
            quoted(&file(seated))
        ));
        let shaft = match place(train, seated) {
            Place::Station => continue,
            Place::Free(shaft) => shaft,
            Place::Beside(shaft, first) => {
                let what =
                    format!("stands at the place of {first} on the same shaft: fixed to it there");
                source.assume_of(seated.gear.id, About::Small, what);
                joints.push_str(&format!(
                    "\n[[joint]]\nname = {}\nkind = \"fixed\"\nbody_1 = {}\nbody_2 = {name}\n",
                    quoted(&format!("{} on {first}", seated.gear.name)),
                    quoted(first)
                ));
                shaft
            }
        };
        let frame = shaft.frame.unwrap_or(Frame::WORLD);
        text.push_str(&format!(
            "position_mm = {}\ncardan_deg = {}\n",
            numbers(&frame.point([seated.mid_mm, 0.0, 0.0])),
            numbers(&cardan_deg(shaft.z()))
        ));
    }
    text + &joints
}

/// Angles about x and the new y that turn z into a direction, R_x(a) R_y(b) e_z = (sin b, −sin a cos b, cos a cos b);
/// the mesh settles the third one.
fn cardan_deg([x, y, z]: [f64; 3]) -> [f64; 2] {
    let about_x = if y.hypot(z) < 1e-12 {
        0.0
    } else {
        (-y).atan2(z)
    };
    [about_x, x.clamp(-1.0, 1.0).asin()].map(f64::to_degrees)
}
