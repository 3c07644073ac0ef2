//! What a plane-strain problem says about the near field of a load on a tooth: the calibration of the local term.

use crate::file_error::FileError;
use crate::record::Fields;
use crate::smooth_curve::SmoothCurve;

/// Deflection of the contact centre under a Hertz pressure, and of the model's own mesh under its own hats, both in
/// plane strain on the tooth-only submodel.
///
/// With them the online side corrects each slice's own deflection, q its line load and a its half width:
///
/// ```text
/// δ = q [ c₀(ξ) − w_h(ξ) − k ln(a/a₀) ],     k = 2(1 − ν²)/(πE),     w_h(ξ) = Φ(ξ)ᵀ W Φ(ξ)
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct NearField {
    /// Half width a₀ of the Hertz pressure in metres.
    pub half_width_m: f64,
    /// Roll angles of the places where c₀ is given, increasing, over the whole flank.
    pub roll_angles_rad: Vec<f64>,
    /// c₀ in m²/N (deflection per line load), `[place]`; both flanks, which are mirror images of each other.
    pub contact_m2_per_n: Vec<f64>,
    /// W in m²/N, `[flank f][roll station][roll station]`: deflection, weighted by the response station's hat, per
    /// line load spread by the load station's hat.
    pub mesh_m2_per_n: Vec<f64>,
    /// Element length at the load of the finer of the two meshes from which c₀ was extrapolated, in metres.
    pub element_m: f64,
    /// Largest relative step from the finer mesh's c₀ to the extrapolated one. The error left is a fraction of it.
    pub residual: f64,
}

impl NearField {
    /// c₀ over the roll angle on a gear with this base radius, negative of a ring, whose tip has the smallest roll
    /// angle.
    pub fn contact_curve(&self, base_radius_m: f64) -> ContactCurve {
        let end_rad = match base_radius_m < 0.0 {
            true => self.roll_angles_rad[0],
            false => self.roll_angles_rad[self.roll_angles_rad.len() - 1],
        };
        ContactCurve::new(
            EdgeDistance::Involute {
                base_radius_m,
                end_rad,
            },
            self.half_width_m,
            &self.roll_angles_rad,
            &self.contact_m2_per_n,
        )
    }

    /// c₀ in m²/N at a roll angle; for many of them make the curve once.
    pub fn contact_at(&self, roll_rad: f64, base_radius_m: f64) -> f64 {
        self.contact_curve(base_radius_m).at(roll_rad).0
    }
}

/// c₀ over the roll angle. Beyond the ends the end's value.
///
/// Towards the edge c₀ grows like the logarithm of the distance d to it, r_b (ξ_end² − ξ²)/2 on an involute flank. The
/// interpolation is therefore in u = −ln(1 + d/a₀), by a [`SmoothCurve`].
#[derive(Debug, Clone, PartialEq)]
pub struct ContactCurve {
    distance: EdgeDistance,
    half_width_m: f64,
    rolls_rad: Vec<f64>,
    /// c₀ over u.
    over_u: SmoothCurve,
}

/// How far a place along the profile is from the tip's edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum EdgeDistance {
    /// Of an involute, by the roll angle; the base radius of a ring is negative.
    Involute { base_radius_m: f64, end_rad: f64 },
    /// By the share of the way up the flank.
    Share { length_m: f64 },
}

impl EdgeDistance {
    /// d \[m\], and −∂d by the place.
    fn at(self, place: f64) -> [f64; 2] {
        match self {
            Self::Involute {
                base_radius_m,
                end_rad,
            } => [
                0.5 * base_radius_m * (end_rad * end_rad - place * place),
                base_radius_m * place,
            ],
            Self::Share { length_m } => [length_m * (1.0 - place), length_m],
        }
    }

    /// −ln(1 + d/a₀).
    fn u(self, half_width_m: f64, place: f64) -> f64 {
        -(self.at(place)[0] / half_width_m).ln_1p()
    }
}

impl ContactCurve {
    /// c₀ given at places, `distance` telling how far they are from the edge.
    pub(crate) fn new(
        distance: EdgeDistance,
        half_width_m: f64,
        at: &[f64],
        values: &[f64],
    ) -> Self {
        let coordinates = at.iter().map(|place| distance.u(half_width_m, *place));
        Self {
            distance,
            half_width_m,
            rolls_rad: at.to_vec(),
            over_u: SmoothCurve::new(coordinates.collect(), values.to_vec()),
        }
    }

    /// c₀ in m²/N at a roll angle, and its derivative by it. No allocation.
    pub fn at(&self, roll_rad: f64) -> (f64, f64) {
        let rolls = &self.rolls_rad;
        let piece = SmoothCurve::piece(rolls, roll_rad);
        let inside = roll_rad.clamp(rolls[0], rolls[rolls.len() - 1]);
        let u = self.distance.u(self.half_width_m, inside);
        let [value, slope] = self.over_u.in_piece(piece, u);
        let moves = if inside == roll_rad {
            let [distance, rate] = self.distance.at(inside);
            rate / (self.half_width_m + distance)
        } else {
            0.0
        };
        (value, slope * moves)
    }
}

/// What near fields of all gears have.
pub(crate) fn calibration_fields(
    f: &mut Fields<'_>,
    [half_width_m, element_m]: [&mut f64; 2],
    residual: &mut f64,
) -> Result<(), FileError> {
    let what = "half width of the calibrating Hertz pressure";
    f.number("half_width", half_width_m, "m", what)?;
    let what = "element length at the load of the finer mesh behind the contact compliance";
    f.number("element", element_m, "m", what)?;
    let what = "largest relative step from that mesh to the extrapolated contact compliance";
    f.number("residual", residual, "1", what)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sampled(places: &[f64], of: impl Fn(f64) -> f64) -> NearField {
        NearField {
            half_width_m: 1e-4,
            roll_angles_rad: places.to_vec(),
            contact_m2_per_n: places.iter().map(|&x| of(x)).collect(),
            mesh_m2_per_n: Vec::new(),
            element_m: 1e-5,
            residual: 0.0,
        }
    }

    const BASE_RADIUS: f64 = 0.07;

    #[test]
    fn a_parabola_of_the_logarithm_comes_back_exactly() {
        let places = [0.1, 0.25, 0.3, 0.6];
        let parabola = |x: f64| {
            let u = -(0.5 * BASE_RADIUS * (0.36 - x * x) / 1e-4).ln_1p();
            20.0 + 3.0 * u + 0.4 * u * u
        };
        let field = sampled(&places, parabola);
        for x in [0.1, 0.12, 0.2499, 0.25, 0.28, 0.4, 0.55, 0.599, 0.6] {
            let found = field.contact_at(x, BASE_RADIUS);
            assert!((found - parabola(x)).abs() < 1e-12, "{x}: {found}");
            let slope = field.contact_curve(BASE_RADIUS).at(x).1;
            let h = 1e-6;
            let difference = (parabola((x + h).min(0.6)) - parabola(x - h)) / (2.0 * h);
            let inside = x > 0.1 && x < 0.6;
            assert!(
                !inside || (slope / difference - 1.0).abs() < 1e-6,
                "{x}: {slope} {difference}"
            );
        }
        let [low, high] = [0.0, 1.0].map(|x| field.contact_at(x, BASE_RADIUS));
        assert_eq!(low, field.contact_m2_per_n[0]);
        assert!((high - parabola(0.6)).abs() < 1e-12);
    }

    /// Halving the spacing divides the error by eight or more: the slopes are of second order.
    #[test]
    fn the_error_falls_with_the_third_power() {
        let end = 0.5;
        // Places at equal steps of u, whose range is 0 to U.
        let range = (0.5 * BASE_RADIUS * end * end / 1e-4_f64).ln_1p();
        let roll = |u: f64| {
            (end * end - 2.0 * 1e-4 * u.exp_m1() / BASE_RADIUS)
                .max(0.0)
                .sqrt()
        };
        let of = |u: f64| (0.5 * u).sin();
        let error = |n: usize| {
            let steps = (0..=n).rev().map(|k| range * k as f64 / n as f64);
            let mut field = sampled(&steps.clone().map(roll).collect::<Vec<_>>(), |_| 0.0);
            field.contact_m2_per_n = steps.map(of).collect();
            (0..1000)
                .map(|k| range * f64::from(k) / 999.0)
                .map(|u| (field.contact_at(roll(u), BASE_RADIUS) - of(u)).abs())
                .fold(0.0, f64::max)
        };
        let (coarse, fine) = (error(20), error(40));
        assert!(fine > 0.0 && coarse / fine > 7.0, "{coarse} {fine}");
    }
}
