//! Whether the flanks of both members are mates: backlash by the thicknesses their teeth have, and whether the flanks
//! meet at all.

use crate::assembly::{Assembly, AssemblyError};
use crate::blank::PairBlank;
use crate::contact_path::first_touch;
use crate::contact_point::Mesh;
use crate::error::BevelError;
use crate::hand::FlankSide;
use crate::pair_design::PairDesign;
use crate::tca::{ToothContact, mean_contact, touches_along_line};

/// Normals of mates at their mean points are opposite within this where the flanks are conjugate \[rad\].
const PARALLEL_RAD: f64 = 1e-6;
/// Overlap of the flanks that do not drive from which teeth are said to jam: pairs without backlash have some rounding
/// \[m\].
const JAMMED_M: f64 = 1e-6;
/// How deep they may overlap, as a share of the normal pitch: as in scenes whose mesh leaves these flanks out.
const MOST_DEPTH: f64 = 0.02;
/// Turns of a pitch at which the least backlash is looked for.
const TURNS: usize = 96;

impl PairDesign {
    /// Normal backlash at the mean points, by the thicknesses that the teeth of both members have \[m\]; negative where
    /// they are too thick for their spaces.
    pub fn backlash_m(&self, blank: &PairBlank) -> f64 {
        let member = &blank.members[0];
        let circle = std::f64::consts::TAU * blank.mean_cone_m * member.pitch_angle_rad.sin()
            / member.teeth as f64;
        let teeth: f64 = self.teeth.iter().map(|t| t.thickness.counts_m()).sum();
        let data = &blank.data;
        (circle - teeth) * data.spiral_angle_rad.cos() * data.pressure_angle_rad.cos()
    }

    /// Asks whether the flanks of both sides touch inside their limits in the pair as designed: where the ratio of
    /// speeds is that of the teeth, both must have a point. Flanks in line contact meet.
    ///
    /// # Errors
    /// [`BevelError::DoNotMeet`].
    pub fn check_meeting(&self, blank: &PairBlank) -> Result<(), BevelError> {
        let assembly = Assembly::new(blank, &AssemblyError::default());
        for pinion in FlankSide::BOTH {
            let flanks = self.flanks(pinion);
            let [n, mate] =
                [0, 1].map(|m: usize| assembly.members[m].axes * flanks[m].mean().point.n);
            let apart_rad = (n + mate).norm();
            let refuse = |what: &str| BevelError::DoNotMeet {
                pinion: pinion.word(),
                gear: pinion.mate().word(),
                problem: format!(
                    "{what}; their normals at the mean points are {:.3} degrees apart. Look at blade angles, point radii, radial distance, cradle \
                     angle and ratio of roll of both, and at which table is concave",
                    apart_rad.to_degrees()
                ),
            };
            if apart_rad < PARALLEL_RAD {
                continue;
            }
            let mesh = Mesh {
                flanks,
                assembly: &assembly,
            };
            let touch = match first_touch(flanks, blank, &AssemblyError::default()) {
                Ok((_, touch)) if touches_along_line(&touch) => continue,
                Ok((_, touch)) => mean_contact(&mesh, &touch).ok(),
                Err(_) => None,
            };
            let Some(touch) = touch else {
                return Err(refuse("their surfaces have no contact at constant ratio"));
            };
            for (m, flank) in flanks.into_iter().enumerate() {
                let Some(p) = flank.point(touch.at[m]) else {
                    continue;
                };
                if !flank.holds(&p) {
                    let [cone, height] = flank.place(&p.r);
                    return Err(refuse(&format!(
                        "their surfaces touch at constant ratio at cone distance {:.2} mm, {:+.2} mm from the pitch cone of the {}, whose flank goes \
                         from {:.2} to {:.2} mm and from {:+.2} to {:+.2} mm",
                        1e3 * cone,
                        1e3 * height,
                        flank.blank.name,
                        1e3 * flank.blank.inner_cone_m(),
                        1e3 * flank.blank.outer_cone_m,
                        -1e3 * flank.blank.dedendum_m(flank.blank.mean_cone_m),
                        1e3 * flank.blank.addendum_m(flank.blank.mean_cone_m)
                    )));
                }
            }
        }
        Ok(())
    }

    /// Least backlash over a pitch in an assembly, along the normal at the gear's mean point \[m\]: by how much the
    /// gear can be turned from where the flanks of one side touch to where those of the other do. `sides`: contact of
    /// both, the pinion's concave flank first, in the same assembly.
    pub fn assembled_backlash_m(&self, blank: &PairBlank, sides: [&ToothContact; 2]) -> f64 {
        let [pinion, gear] = &self.teeth;
        let radius = blank.mean_cone_m * gear.blank.pitch_angle_rad.sin();
        let lever =
            radius * blank.data.spiral_angle_rad.cos() * blank.data.pressure_angle_rad.cos();
        // Teeth and spaces as designed, less what both sides lead: docs/theory/bevel_gears.md, "Backlash of an
        // assembly".
        let designed_rad = self.backlash_m(blank) / lever;
        let pitch = std::f64::consts::TAU / pinion.blank.teeth as f64;
        let lead = |k: usize, turn: f64| {
            // Its mean point on +x, a flank has turned by the half tooth angle more than its tooth.
            let own = turn + pinion.half_angle_rad(FlankSide::BOTH[k]);
            let values = &sides[k].error_rad;
            let n = values.len();
            let place = (own / pitch).rem_euclid(1.0) * n as f64;
            let (i, share) = (place as usize % n, place.fract());
            sides[k].largest_rad + values[i] + share * (values[(i + 1) % n] - values[i])
        };
        let turns = (0..TURNS).map(|i| pitch * i as f64 / TURNS as f64);
        let least = turns.map(|turn| designed_rad - lead(0, turn) - lead(1, turn));
        lever * least.fold(f64::INFINITY, f64::min)
    }

    /// Refuses an assembly in which teeth jam; says so where they overlap by less than what is refused. `driving`: side
    /// of the pinion that drives.
    ///
    /// # Errors
    /// [`BevelError::Jam`].
    pub fn check_jam(
        &self,
        blank: &PairBlank,
        (driving, backlash_m): (FlankSide, f64),
    ) -> Result<Option<BevelError>, BevelError> {
        let normal_pitch =
            std::f64::consts::PI * blank.mean_normal_module_m * blank.data.pressure_angle_rad.cos();
        let allowed_m = MOST_DEPTH * normal_pitch;
        let jam = BevelError::Jam {
            pinion: driving.word(),
            depth_mm: -1e3 * backlash_m,
            allowed_mm: 1e3 * allowed_m,
        };
        match -backlash_m {
            depth if depth > allowed_m => Err(jam),
            depth if depth > JAMMED_M => Ok(Some(jam)),
            _ => Ok(None),
        }
    }
}
