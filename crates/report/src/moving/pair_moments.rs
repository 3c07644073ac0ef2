//! Moments of a pair at rest: where the gears stand at a driver angle and torque, and what presses on their flanks.

use super::gear_surface::flank_directions;
use super::{FlankLoad, GearSurface, Moment, Placement};
use gearmesh_geometry::{GearDefinition, GearPair};
use gearmesh_scene::{LoadedScene, SceneResult};
use std::f64::consts::TAU;

/// The surfaces of both gears, with sections between the slices.
#[must_use]
pub fn pair_surfaces(loaded: &LoadedScene, gears: [&GearDefinition; 2]) -> [GearSurface; 2] {
    let width_m = loaded.layout.width_m();
    let patches = loaded.patches_at(0.0);
    [0, 1].map(|gear| {
        let middles = patches.iter().map(|patch| patch.places[gear].v);
        let least = middles.clone().fold(f64::INFINITY, f64::min);
        // From the lowest slice that touches on in steps of a slice, both ways, over the whole face.
        let (count, half) = (loaded.layout.slices as i32, 0.5 * width_m);
        let heights: Vec<f64> = if least.is_finite() {
            let edges = -count..=2 * count;
            edges
                .map(|k| least - half + f64::from(k) * width_m)
                .collect()
        } else {
            Vec::new()
        };
        GearSurface::new(gears[gear], &heights)
    })
}

/// Angles by which both gears are turned about z at a torque and driver angle \[rad\], gear 2 beside gear 1 on +x: at
/// zero the flanks of both teeth 0 touch at the pitch point.
#[must_use]
pub fn pair_turns(
    pair: &GearPair,
    result: &SceneResult,
    (torque, angle): (usize, usize),
) -> [f64; 2] {
    let [base_1, base_2] = [&pair.gear_1, &pair.gear_2].map(|gear| gear.base_radius_m);
    let turn_1 = result.angle_rad[angle];
    let turn_2 = (result.curve(&result.te_m, torque)[angle] + base_1 * turn_1) / base_2;
    pair.tooth_middles_rad((pair.centre_distance_m, [turn_1, turn_2]))
}

/// Where the slices touch across the axes of gear 1 \[m\], `[angle][line][slice]`; the origin where none does, and
/// everywhere for a result without places.
#[must_use]
pub fn touching_points_m(pair: &GearPair, result: &SceneResult) -> Vec<[f64; 2]> {
    let tooth = &pair.gear_1;
    let Some(places) = &result.lines.places else {
        return vec![[0.0; 2]; result.angles() * result.lines.slots * result.lines.slices];
    };
    let point = |(at, roll): (usize, &f64)| {
        if places.width_m[at] <= 0.0 {
            return [0.0; 2];
        }
        let [number, _] = pair.teeth_of(result.lines.pair[at / result.lines.slices] as i64);
        let turn =
            TAU * number as f64 / tooth.teeth as f64 + places.z_m[at] * tooth.twist_rad_per_m();
        let (s, c) = turn.sin_cos();
        let [x, y] = tooth.flank_point_m(pair.flank, *roll);
        [c * x - s * y, s * x + c * y]
    };
    places.roll_1_rad.iter().enumerate().map(point).collect()
}

/// Gear 1 stands at the origin, gear 2 beside it on +x; both turn about z as the transmission error says. Misalignment
/// and axes beside the bores are too small to be seen and left out.
#[must_use]
pub fn pair_moment(
    loaded: &LoadedScene,
    result: &SceneResult,
    gears: [&GearDefinition; 2],
    (torque, angle): (usize, usize),
) -> Moment {
    let pair = &loaded.lines.pair;
    let [turn_1, turn_2] = pair_turns(pair, result, (torque, angle));
    let placements = vec![
        Placement::turned(turn_1, [0.0; 3]),
        Placement::turned(
            turn_2,
            [pair.centre_distance_m, 0.0, loaded.scene.axial_offset_m],
        ),
    ];
    let driver_rad = result.angle_rad[angle];
    let patches = loaded.patches_at(driver_rad);
    let forces = result.position_forces(torque, angle);
    let pressures = {
        let size = result.lines.slots * result.lines.slices;
        &result.lines.pressure_pa[(torque * result.angles() + angle) * size..][..size]
    };
    let mut loads = Vec::new();
    for patch in &patches {
        let at = patch.line * result.lines.slices + patch.slice;
        if forces[at] <= 0.0 {
            continue;
        }
        for gear in 0..2 {
            let place = patch.places[gear];
            let side = pair.flank_of(gear);
            let flank = (patch.teeth[gear], side);
            let tooth = &gears[gear].profile;
            let [normal, tip] = flank_directions(tooth, flank, place.u, place.v);
            let [a, b] = patch.force_components(gear).map(|part| part * forces[at]);
            let own = std::array::from_fn(|k| a * normal[k] + b * tip[k]);
            loads.push(FlankLoad {
                mesh: 0,
                gear,
                tooth: patch.teeth[gear],
                side,
                roll_rad: place.u,
                height_m: place.v,
                width_m: loaded.layout.width_m(),
                components_n: [a, b],
                force_n: placements[gear].direction(own),
                line_load_n_per_m: forces[at] / (loaded.layout.width_m() * patch.share),
                pressure_pa: pressures[at],
            });
        }
    }
    Moment {
        at: driver_rad.to_degrees(),
        placements,
        loads,
        bore_m: Vec::new(),
        von_mises_pa: Vec::new(),
    }
}
