//! Single stiffness of two gears after ISO 6336-1 method B, from their definitions.

use gearmesh_drivetrain::SingleStiffness;
use gearmesh_drivetrain::models::iso6336::blank_factor;
use gearmesh_geometry::GearDefinition;

/// N/(mm·µm) in SI, N/m².
pub(super) const N_PER_MM_UM: f64 = 1e9;

/// Line load at which ISO 6336-1 takes the stiffness of teeth as constant; here the reference for loads that a scene
/// does not state.
pub(super) const REFERENCE_LINE_LOAD_N_PER_M: f64 = 1e5;

/// The single stiffness after ISO 6336-1 method B; the pinion is the gear with fewer teeth, the softer blank
/// counts. A ring has infinitely many teeth in its formula (ISO 6336-1:2006, clause 9).
pub(super) fn iso_stiffness(
    gears: [&GearDefinition; 2],
    line_load_n_per_m: f64,
) -> SingleStiffness {
    let [mut pinion, mut wheel] = gears;
    if pinion.profile.teeth > wheel.profile.teeth {
        std::mem::swap(&mut pinion, &mut wheel);
    }
    let blanks = [pinion, wheel].map(|gear| {
        gear.blank.web().map_or(1.0, |web| {
            let rim = (gear.profile.root_radius_m - web.rim_inner_radius_m) / gear.tooth.module_m;
            blank_factor(web.thickness_m / gear.tooth.face_width_m, rim)
        })
    });
    let [e1, e2] = [pinion.material.young_pa, wheel.material.young_pa];
    // Of a ring's cutter no dedendum is stated; that of the teeth it makes.
    let dedendum = |gear: &GearDefinition| {
        let (tooth, profile) = (&gear.tooth, &gear.profile);
        match profile.internal {
            true => {
                let below_m = profile.root_radius_m - profile.reference_radius_m;
                below_m / tooth.module_m + tooth.profile_shift
            }
            false => tooth.dedendum,
        }
    };
    SingleStiffness {
        virtual_teeth: [pinion, wheel].map(|gear| match gear.profile.internal {
            true => f64::INFINITY,
            false => gear.profile.virtual_teeth(),
        }),
        profile_shifts: [pinion, wheel].map(|gear| gear.tooth.profile_shift),
        helix_angle_rad: pinion.tooth.helix_angle_rad.abs(),
        rack_dedendum: 0.5 * (dedendum(pinion) + dedendum(wheel)),
        rack_pressure_angle_rad: pinion.tooth.pressure_angle_rad,
        blank_factor: blanks[0].min(blanks[1]),
        young_pa: 2.0 * e1 * e2 / (e1 + e2),
        line_load_n_per_m,
    }
}
