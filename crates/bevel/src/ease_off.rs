//! Ease-off: how far the pinion's flank stays back from the one that the gear's flank would cut at constant ratio.

use nalgebra::{Matrix4, Vector3, Vector4};

use crate::assembly::Assembly;
use crate::contact_point::Mesh;
use crate::error::BevelError;

/// Place and size of an ease-off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EaseOff {
    /// Distance of the pinion's point from the gear's flank, along its normal, where it passes nearest; positive apart
    /// \[m\].
    pub gap_m: f64,
    /// Turn of the pinion at which it passes \[rad\].
    pub pinion_turn_rad: f64,
    /// Parameters on the gear's flank.
    pub gear_at: [f64; 2],
}

/// Cone distance and height of places of the pinion \[m\], with their ease-off.
pub type EaseOffMap = Vec<([f64; 2], Option<EaseOff>)>;

/// Newton steps at most.
const MOST_STEPS: usize = 40;

impl Mesh<'_> {
    /// Gear turn at constant ratio.
    pub fn ideal_gear_turn(assembly: &Assembly, pinion_turn: f64) -> f64 {
        -assembly.ratio * pinion_turn
    }

    /// Ease-off at a point of the pinion, from one nearby. Four unknowns: the gear's parameters, the gap g along its
    /// normal and the pinion's turn; three
    /// equations r₁ = r₂ − g n₂ and n₂·v₁₂ = 0, at which g is stationary.
    ///
    /// # Errors
    /// [`BevelError::NoMate`] where the gear's surface is not met.
    pub fn ease_off(&self, pinion: [f64; 2], start: &EaseOff) -> Result<EaseOff, BevelError> {
        let flank = self.flanks[0];
        let none = || {
            let place = flank
                .point(pinion)
                .map_or([f64::NAN; 2], |p| flank.place(&p.r));
            BevelError::NoMate {
                cone_mm: 1e3 * place[0],
                height_mm: 1e3 * place[1],
            }
        };
        let own = flank.point(pinion).ok_or_else(none)?;
        let size = flank.blank.mean_cone_m;
        let [m1, m2] = &self.assembly.members;
        let (k1, k2) = (m1.axis(), m2.axis());
        let ratio = -self.assembly.ratio;
        let mut x = *start;
        let mut last = f64::INFINITY;
        for _ in 0..MOST_STEPS {
            let p1 = m1.placed(&own, x.pinion_turn_rad);
            let other = self.flanks[1].point(x.gear_at).ok_or_else(none)?;
            let p2 = m2.placed(&other, ratio * x.pinion_turn_rad);
            // The normal points into the gear: a point that stays outside is at r₂ − g n₂.
            let miss = p1.r - p2.r + p2.n * x.gap_m;
            let v1 = k1.cross(&(p1.r - m1.apex_m));
            let turn2 = |v: &Vector3<f64>| k2.cross(v) * ratio;
            let arm = p1.r - m2.apex_m;
            let v = v1 - turn2(&arm);
            let dv = k1.cross(&v1) - turn2(&v1);
            let residual = Vector4::new(
                miss.x / size,
                miss.y / size,
                miss.z / size,
                p2.n.dot(&v) / size,
            );
            let error = residual.norm();
            if error < 1e-14 || (error < 1e-11 && error >= 0.5 * last) {
                return Ok(x);
            }
            last = error;
            let mut slopes = Matrix4::zeros();
            let by_turn = v1 - turn2(&(p2.r - m2.apex_m)) + turn2(&p2.n) * x.gap_m;
            for i in 0..3 {
                for k in 0..2 {
                    slopes[(i, k)] = (-p2.dr[k][i] + p2.dn[k][i] * x.gap_m) / size;
                }
                slopes[(i, 2)] = p2.n[i];
                slopes[(i, 3)] = by_turn[i] / size;
            }
            for k in 0..2 {
                slopes[(3, k)] = p2.dn[k].dot(&v) / size;
            }
            slopes[(3, 3)] = (turn2(&p2.n).dot(&v) + p2.n.dot(&dv)) / size;
            let mut step = slopes.lu().solve(&residual).ok_or_else(none)?;
            let most = step.amax();
            if !most.is_finite() {
                return Err(none());
            }
            if most > 0.2 {
                step *= 0.2 / most;
            }
            x.gear_at[0] -= step[0];
            x.gear_at[1] -= step[1];
            x.gap_m -= step[2] * size;
            x.pinion_turn_rad -= step[3];
        }
        Err(none())
    }

    /// Ease-off over the pinion's flank: `along` × `up` places from toe to heel and from the lower end (or the start
    /// of the gear's tip contact) to the tip, each as cone distance, height and ease-off.
    ///
    /// # Errors
    /// [`BevelError::NoMate`] at the first place where the gear's surface is not met.
    pub fn ease_off_map(
        &self,
        along: usize,
        up: usize,
    ) -> Result<Vec<([f64; 2], EaseOff)>, BevelError> {
        let begin = EaseOff {
            gap_m: 0.0,
            pinion_turn_rad: 0.0,
            gear_at: self.flanks[1].mean().at,
        };
        let first = self.ease_off(self.flanks[0].mean().at, &begin)?;
        let map = self.ease_off_map_from(&first, along, up)?;
        let whole = map.into_iter().map(|([cone, height], found)| {
            let none = BevelError::NoMate {
                cone_mm: 1e3 * cone,
                height_mm: 1e3 * height,
            };
            Ok(([cone, height], found.ok_or(none)?))
        });
        whole.collect()
    }

    /// As [`Self::ease_off_map`], from the ease-off at the pinion's mean point; none at places where the pinion's flank
    /// is undercut or never meets the gear's surface.
    ///
    /// # Errors
    /// [`BevelError::NoMate`] where the pinion's pitch line does not meet it.
    pub fn ease_off_map_from(
        &self,
        first: &EaseOff,
        along: usize,
        up: usize,
    ) -> Result<EaseOffMap, BevelError> {
        let flank = self.flanks[0];
        let blank = &flank.blank;
        let mate = &self.flanks[1].blank;
        let mut list = Vec::with_capacity(along * up);
        let share = |i: usize, n: usize| {
            if n > 1 {
                i as f64 / (n - 1) as f64
            } else {
                0.5
            }
        };
        for i in 0..along {
            let toe = blank.inner_cone_m().max(mate.inner_cone_m());
            let cone = toe + (blank.outer_cone_m - toe) * share(i, along);
            let pitch = flank.locate(cone, 0.0)?;
            let middle = self.ease_off(pitch.at, first)?;
            let bottom = flank.bottom(cone).ok();
            let bottom = bottom.map(|b| flank.place(&b.point.r)[1]);
            // Below the reach of the gear's tip nothing touches.
            let low = bottom.map_or(-mate.addendum_m(cone), |b| b.max(-mate.addendum_m(cone)));
            let high = blank.addendum_m(cone);
            for k in 0..up {
                let height = low + (high - low) * share(k, up);
                let place = flank.locate_from(cone, height, &pitch);
                let found = place.and_then(|place| self.ease_off(place.at, &middle));
                list.push(([cone, height], found.ok()));
            }
        }
        Ok(list)
    }
}
