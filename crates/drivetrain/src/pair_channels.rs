//! What a mesh reports of each pair of teeth that carries: which tooth, what force, where on both flanks, and Hertz'
//! pressure there.
//!
//! Pair 1 is the one that stands nearest to the tip of gear 1, the next one below it, and so on; what no pair fills is
//! zero, its tooth -1. Places are shares: along the face 0 at the toe and 1 at the heel, up the flank 0 at its lower
//! line and 1 at the tip. Half axes are differences of such shares.
//!
//! Flanks that touch in points have one contact for each pair, with an ellipse. Of flanks in slices or patches a
//! pair's force is the sum of its own,
//! its place their mean weighted with the forces, its pressure the largest of them as that of a line contact.

use gearmesh_contact::hertz;
use gearmesh_dynamics::elements::Channel;

use crate::flank_contacts::{FlankContacts, TeethLine};
use crate::gear_mesh::GearMesh;

/// How pairs of teeth are reported.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ToothPairs {
    /// One contact for each pair, with its ellipse after Hertz, of families whose flanks touch in points.
    Points {
        /// E* \[Pa\].
        contact_modulus_pa: f64,
    },
    /// The slices or nodes of a pair together.
    Slices {
        /// How pressures follow from forces.
        pressure: SlicePressure,
        /// Face widths of gear 1 and gear 2 \[m\].
        face_widths_m: [f64; 2],
        /// Place u up the flank ([`crate::flank_contacts::Section::roll_rad`]) of the lower line and of the tip, gear
        /// 1 and gear 2.
        ends: [[f64; 2]; 2],
    },
}

/// Pairs that have channels; more than three carry nowhere near a design load.
const PAIRS: usize = 4;
/// Channels of a pair: those without the half axes, and all.
const PLAIN: usize = 7;
const SIZE: usize = PLAIN + 8;

/// Pressure of a part of a pair's contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SlicePressure {
    /// Of slices: Hertz' of a line contact with E* \[Pa\].
    Line(f64),
    /// Of nodes: force over their area, which is their stiffness' share in this one \[m²\].
    Area(f64),
}

impl ToothPairs {
    /// Channels of one pair.
    fn size(self) -> usize {
        match self {
            Self::Points { .. } => SIZE,
            Self::Slices { .. } => PLAIN,
        }
    }

    /// Number of the channels.
    pub(crate) fn count(self) -> usize {
        PAIRS * self.size()
    }

    pub(crate) fn channels(self) -> impl Iterator<Item = Channel> {
        (1..=PAIRS).flat_map(move |pair| Self::of_pair(pair).into_iter().take(self.size()))
    }

    fn of_pair(pair: usize) -> Vec<Channel> {
        let name = |what: &str| format!("pair_{pair}_{what}");
        let share = |what: &str, text: &'static str| Channel::new(name(what), "1", text);
        let mut list = vec![
            share(
                "tooth_1",
                "tooth of gear 1, from 0; -1 where no pair carries",
            ),
            Channel::new(name("force_N"), "N", "normal force of the pair"),
        ];
        for gear in [1, 2] {
            let along = share(
                &format!("along_{gear}"),
                "place along the face: 0 at the toe, 1 at the heel",
            );
            let height = share(
                &format!("height_{gear}"),
                "place up the flank: 0 at its lower line, 1 at the tip",
            );
            list.extend([along, height]);
        }
        let what = "largest pressure after Hertz under the force";
        list.push(Channel::new(name("pressure_Pa"), "Pa", what));
        for gear in [1, 2] {
            for axis in ["long", "short"] {
                let what = "half axis of the contact ellipse along the face, as a share of it";
                list.push(share(&format!("{axis}_along_{gear}"), what));
                let what = "half axis of the contact ellipse up the flank, as a share of it";
                list.push(share(&format!("{axis}_height_{gear}"), what));
            }
        }
        list
    }

    /// Writes all pairs that carry at the last pose.
    pub(crate) fn write(self, mesh: &GearMesh, out: &mut [f64]) {
        out.fill(0.0);
        let size = self.size();
        for pair in out.chunks_exact_mut(size) {
            pair[0] = -1.0;
        }
        let mut filled = 0;
        for flank in mesh.flanks() {
            let Some((found, forces)) = mesh.side(flank) else {
                continue;
            };
            for line in &found.lines {
                let mut values = [0.0; SIZE];
                let is_loaded = match self {
                    Self::Points { contact_modulus_pa } => {
                        let contact = line.contacts.0;
                        let with = (forces[contact], contact_modulus_pa);
                        let patch = (with.0 > 0.0)
                            .then(|| mesh.kinematics().contact_patch(contact, flank, with));
                        patch.flatten().map(|patch| {
                            let [one, two] = patch.places;
                            let pressure = patch.peak_pressure_pa;
                            let plain = [with.0, one[0], one[1], two[0], two[1], pressure];
                            values[1..PLAIN].copy_from_slice(&plain);
                            let axes = patch.axes.iter().flat_map(|own| [own.long, own.short]);
                            for (place, value) in values[PLAIN..].iter_mut().zip(axes.flatten()) {
                                *place = value;
                            }
                        })
                    }
                    Self::Slices {
                        pressure,
                        face_widths_m,
                        ends,
                    } => {
                        let of_slices = SummedSlices {
                            found,
                            forces,
                            widths_m: face_widths_m,
                            ends,
                            pressure,
                        };
                        let plain = of_slices.of_line(line);
                        plain.map(|plain| values[1..PLAIN].copy_from_slice(&plain))
                    }
                };
                if is_loaded.is_none() {
                    continue;
                }
                if filled == PAIRS {
                    return;
                }
                values[0] = line.teeth[0] as f64;
                // The highest first.
                let mut at = filled;
                while at > 0 && out[(at - 1) * size + 3] < values[3] {
                    out.copy_within((at - 1) * size..at * size, at * size);
                    at -= 1;
                }
                out[at * size..(at + 1) * size].copy_from_slice(&values[..size]);
                filled += 1;
            }
        }
    }
}

/// Contacts of one side whose forces are summed pair by pair.
struct SummedSlices<'a> {
    found: &'a FlankContacts,
    forces: &'a [f64],
    /// Face widths of gear 1 and gear 2.
    widths_m: [f64; 2],
    ends: [[f64; 2]; 2],
    pressure: SlicePressure,
}

impl SummedSlices<'_> {
    /// Force, place on gear 1 and gear 2, largest pressure of a pair; none without load.
    fn of_line(&self, line: &TeethLine) -> Option<[f64; PLAIN - 1]> {
        let (first, count) = line.contacts;
        let (mut force, mut places, mut pressure) = (0.0, [0.0; 4], 0.0_f64);
        for number in first..first + count {
            let own = self.forces[number];
            if own <= 0.0 {
                continue;
            }
            let contact = &self.found.contacts[number];
            let section = self.found.section(contact);
            force += own;
            for gear in 0..2 {
                let [lower, tip] = self.ends[gear];
                let up = (section.touching_roll_rad[gear] - lower) / (tip - lower);
                places[2 * gear] += own * (contact.heights_m[gear] / self.widths_m[gear] + 0.5);
                places[2 * gear + 1] += own * up;
            }
            let here = match self.pressure {
                SlicePressure::Area(reference) => own / (section.stiffness * reference),
                SlicePressure::Line(modulus_pa) => {
                    let line_load = own / section.length_m;
                    let half_width_m =
                        hertz::half_width_m(line_load, section.radius_m, 1.0 / modulus_pa);
                    hertz::peak_pressure_pa(line_load, half_width_m)
                }
            };
            pressure = pressure.max(here);
        }
        let [a, b, c, d] = places.map(|sum| sum / force);
        (force > 0.0).then_some([force, a, b, c, d, pressure])
    }
}
