//! A made-up gear with a made-up crack in one tooth.

use gearmesh_geometry::ToothGeometry;
use gearmesh_model::{Flank, ReducedGear, RootCrack};

use super::made_up_gear;

/// The body of [`made_up_gear`] with a crack that adds `share` of the tooth's own compliance near its tip for loads on
/// its right side, a little less at one face than at the other, and next to nothing on its neighbours.
pub fn cracked_gear(tooth: &ToothGeometry, cracked: usize, share: f64) -> ReducedGear {
    let gear = made_up_gear(tooth);
    let (rolls, z_m) = (&gear.grid.roll_angles_rad, &gear.grid.z_m);
    let (low, high) = (rolls[0], rolls[rolls.len() - 1]);
    let size = (share * 1.5e-9_f64).sqrt();
    let mut rows = Vec::new();
    for row in 0..2 {
        for number in 0..gear.teeth {
            let apart = (number + gear.teeth - cracked) % gear.teeth;
            let reach = match apart {
                0 => 1.0,
                1 => -0.02,
                a if a + 1 == gear.teeth => -0.03,
                _ => 0.0,
            };
            for roll in rolls {
                let height = 0.2 + 0.8 * (roll - low) / (high - low);
                rows.extend(z_m.iter().map(|z| {
                    let along = z / gear.face_width_m;
                    let shape = [1.0 + 0.2 * along, 0.3 * along];
                    size * reach * height * shape[row]
                }));
            }
        }
    }
    ReducedGear {
        crack: Some(RootCrack {
            tooth: cracked,
            side: Flank::Right,
            mouth_radius_m: tooth.root_radius_m + 0.4e-3,
            depth_m: 2e-3,
            angle_rad: 1.0,
            rows,
            left_out: 0.0,
        }),
        ..gear
    }
}
