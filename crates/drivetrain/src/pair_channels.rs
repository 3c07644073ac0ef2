//! What a mesh reports of each pair of teeth that carries: which tooth, what force, where on both flanks, and Hertz' ellipse there.
//!
//! Pair 1 is the one that stands nearest to the tip of gear 1, the next one below it, and so on; what no pair fills is zero, its tooth -1. Places are shares:
//! along the face 0 at the toe and 1 at the heel, up the flank 0 at its lower line and 1 at the tip. Half axes are differences of such shares.

use gearmesh_dynamics::elements::Channel;

use crate::gear_mesh::GearMesh;

/// Pairs that have channels; more than three carry nowhere near a design load.
const PAIRS: usize = 4;
/// Channels of a pair: those without the half axes, and all.
const PLAIN: usize = 7;
const SIZE: usize = PLAIN + 8;

/// Channels of pairs of teeth.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PairChannels {
    /// E* of the ellipses \[Pa\].
    pub contact_modulus_pa: f64,
}

impl PairChannels {
    pub(crate) const COUNT: usize = PAIRS * SIZE;

    pub(crate) fn channels() -> impl Iterator<Item = Channel> {
        (1..=PAIRS).flat_map(Self::of_pair)
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
        for pair in out.chunks_exact_mut(SIZE) {
            pair[0] = -1.0;
        }
        let mut filled = 0;
        for flank in mesh.flanks() {
            let Some((found, forces)) = mesh.side(flank) else {
                continue;
            };
            let loaded = forces.iter().enumerate().filter(|(_, force)| **force > 0.0);
            for (contact, &force) in loaded {
                let kinematics = mesh.kinematics();
                let with = (force, self.contact_modulus_pa);
                let Some(patch) = kinematics.contact_patch(contact, flank, with) else {
                    continue;
                };
                if filled == PAIRS {
                    return;
                }
                let [one, two] = patch.places;
                let tooth = found.lines[found.contacts[contact].line].teeth[0] as f64;
                let pressure = patch.peak_pressure_pa;
                let mut values = [0.0; SIZE];
                let plain = [tooth, force, one[0], one[1], two[0], two[1], pressure];
                values[..PLAIN].copy_from_slice(&plain);
                let axes = patch.axes.iter().flat_map(|own| [own.long, own.short]);
                for (place, value) in values[PLAIN..].iter_mut().zip(axes.flatten()) {
                    *place = value;
                }
                // The highest first.
                let mut at = filled;
                while at > 0 && out[(at - 1) * SIZE + 3] < one[1] {
                    out.copy_within((at - 1) * SIZE..at * SIZE, at * SIZE);
                    at -= 1;
                }
                out[at * SIZE..(at + 1) * SIZE].copy_from_slice(&values);
                filled += 1;
            }
        }
    }
}
