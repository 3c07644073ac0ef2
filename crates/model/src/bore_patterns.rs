//! Motions of a bore: the displacement of the flanks under each, and the forces that the bore then carries.
//!
//! With the bore held the flanks deflect by C_hub f. Let the bore move by Σ_p q_p P_p, where P are radial, tangential
//! and axial displacements, harmonics around the axis times polynomials along it, Ψ the displacements of the body that
//! go with them:
//!
//! ```text
//! flanks  C_hub f + s q,   s = NᵀΨ        forces on the bore along P  S q − sᵀ f,   S = PᵀKΨ
//! ```
//!
//! q = 0: the bore is glued to a rigid pin. A bore that slides has no tangential and axial forces, one on rollers has
//! radial ones at the rollers alone. S has the rigid motions of the body as its null space. Theory:
//! docs/theory/bore_patterns.md.

use crate::file_error::FileError;
use crate::quantity_check::{check_array, out_of_range};
use crate::record::Fields;
use crate::reduced_gear_axes::{GEAR_FRAME, LOAD};
use crate::reduced_gear_error::ReducedGearError;

/// Components of the motion of a bore.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BoreMotion {
    /// Away from the axis.
    Radial = 0,
    /// Counter-clockwise.
    Tangential = 1,
    /// Along +z; not in plane strain.
    Axial = 2,
}

/// Motions of a bore. Their number m = components · (2 H + 1) · L; motion ((component · (2 H + 1) + wave) · L +
/// degree): wave 0 is constant around, 2n − 1 is cos nφ, 2n is sin nφ; the degree is that of a Legendre polynomial
/// along the bore.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct BorePatterns {
    /// Highest harmonic H.
    pub harmonics: usize,
    /// Polynomials L along the bore.
    pub along: usize,
    /// Radial, tangential and axial: 3; without the axial one in plane strain: 2.
    pub components: usize,
    /// Radius of the bore (m).
    pub radius_m: f64,
    /// Its back and front (m).
    pub ends_m: [f64; 2],
    /// S in N/m, `[motion][motion]`.
    pub stiffness: Vec<f64>,
    /// s, `[tooth in sector][flank][load][motion]`: displacement along the inward normal per motion.
    pub flank: Vec<f64>,
    /// gᵀΨ, `[gauge][motion]`: strain per m.
    pub gauges: Vec<f64>,
}

impl BorePatterns {
    /// Waves around the bore, 2 H + 1.
    #[must_use]
    pub fn waves(&self) -> usize {
        2 * self.harmonics + 1
    }

    /// Number of motions m.
    #[must_use]
    pub fn count(&self) -> usize {
        self.components * self.waves() * self.along
    }

    /// The motions of a component.
    #[must_use]
    pub fn motions_of(&self, component: BoreMotion) -> std::ops::Range<usize> {
        let each = self.waves() * self.along;
        component as usize * each..(component as usize + 1) * each
    }

    /// What the motions of one component are at a place of the bore, `[wave][degree]`, by polar angle \[rad\] and z
    /// \[m\].
    #[must_use]
    pub fn at(&self, polar_rad: f64, z_m: f64) -> Vec<f64> {
        let along = legendre(place_along(self.ends_m, z_m), self.along);
        let waves = (0..self.waves()).map(|wave| bore_wave(wave, polar_rad));
        waves
            .flat_map(|wave| along.iter().map(move |p| wave * p))
            .collect()
    }

    /// Rigid motions of the body as motions of its bore: translations along x and y, rotation about z; in space
    /// translation along z and rotations about x and y, too, all about the origin of the gear's frame.
    #[must_use]
    pub fn rigid(&self) -> Vec<Vec<f64>> {
        use BoreMotion::{Axial, Radial, Tangential};
        let set = |terms: &[(BoreMotion, usize, usize, f64)]| {
            let mut q = vec![0.0; self.count()];
            for &(component, wave, degree, value) in terms {
                q[self.motions_of(component).start + wave * self.along + degree] += value;
            }
            q
        };
        let (cos, sin, r) = (1, 2, self.radius_m);
        let mut all = vec![
            set(&[(Radial, cos, 0, 1.0), (Tangential, sin, 0, -1.0)]),
            set(&[(Radial, sin, 0, 1.0), (Tangential, cos, 0, 1.0)]),
            set(&[(Tangential, 0, 0, r)]),
        ];
        if self.components > 2 {
            let [back, front] = self.ends_m;
            let (middle, half) = (0.5 * (back + front), 0.5 * (front - back));
            all.push(set(&[(Axial, 0, 0, 1.0)]));
            // u = θ × r: (θ_y z, −θ_x z, θ_x y − θ_y x).
            for (waves, sign) in [([sin, cos], -1.0), ([cos, sin], 1.0)] {
                let mut terms = vec![(Axial, waves[0], 0, -sign * r)];
                for (degree, z) in [(0, middle), (1, half)] {
                    terms.push((Radial, waves[0], degree, sign * z));
                    terms.push((Tangential, waves[1], degree, -z));
                }
                all.push(set(&terms));
            }
        }
        all
    }

    /// Turns rows over motions, `[row][motion]`, of a place on tooth 0's sector to the same place on a sector that is
    /// `angle_rad` further round.
    pub fn turn(&self, rows: &mut [f64], angle_rad: f64) {
        let each = self.waves() * self.along;
        for of_component in rows.chunks_exact_mut(each) {
            for n in 1..=self.harmonics {
                let (sin, cos) = (n as f64 * angle_rad).sin_cos();
                for degree in 0..self.along {
                    let [c, s] = [2 * n - 1, 2 * n].map(|wave| wave * self.along + degree);
                    let (of_cos, of_sin) = (of_component[c], of_component[s]);
                    of_component[c] = cos * of_cos - sin * of_sin;
                    of_component[s] = sin * of_cos + cos * of_sin;
                }
            }
        }
    }

    /// `sizes`: loads of all flanks of the teeth of a sector, gauges.
    pub(crate) fn fields(
        &mut self,
        f: &mut Fields<'_>,
        [own, hands, loads, gauges]: [usize; 4],
    ) -> Result<(), FileError> {
        f.count("harmonics", &mut self.harmonics, "highest harmonic")?;
        let what = "polynomials along the bore";
        f.count("along", &mut self.along, what)?;
        let what = "3: radial, tangential, axial; 2: without the axial one";
        f.count("components", &mut self.components, what)?;
        f.number("radius", &mut self.radius_m, "m", "radius of the bore")?;
        let axes = [("end: back, front", 2)];
        f.in_frame(GEAR_FRAME)
            .fixed("ends", &mut self.ends_m, &axes, "m", "ends of the bore")?;
        let sizes = [self.components, self.harmonics, self.along];
        // A faulty file may state any number.
        if f.is_reading() && sizes.iter().any(|&size| size > 1000) {
            let found = format!("found {sizes:?} components, harmonics and polynomials");
            return Err(f.contradiction("harmonics", &found));
        }
        let motion = ("motion: component, wave, degree", self.count());
        let what = "force on the bore along a motion per another motion of it";
        let axes = [motion, motion];
        f.in_frame(GEAR_FRAME)
            .bulk("stiffness", &mut self.stiffness, &axes, "N/m", what)?;
        let axes = [
            ("tooth in sector", own),
            ("flank", hands),
            (LOAD, loads),
            motion,
        ];
        let what = "displacement along the inward normal per motion of the bore";
        f.in_frame(GEAR_FRAME)
            .bulk("flank", &mut self.flank, &axes, "1", what)?;
        let what = "strain of the gauges per motion of the bore";
        let axes = [("gauge", gauges), motion];
        f.in_frame(GEAR_FRAME)
            .numbers("gauges", &mut self.gauges, &axes, "1/m", what)
    }

    /// Ranges, and lengths of all arrays. `loads`: those of all flanks of the teeth of a sector.
    pub(crate) fn check(&self, loads: usize, gauges: usize) -> Result<(), ReducedGearError> {
        if !(2..=3).contains(&self.components) {
            return Err(out_of_range("bore.components", self.components, "2 or 3"));
        }
        let [back, front] = self.ends_m;
        let is_long = self.radius_m > 0.0 && self.radius_m.is_finite() && back < front;
        if !is_long || self.harmonics < 1 || self.along + 1 < self.components {
            let found = format!(
                "radius {} m, ends {back} and {front} m, {} harmonics, {} polynomials",
                self.radius_m, self.harmonics, self.along
            );
            return Err(out_of_range("bore", found, "a bore of some length"));
        }
        let m = self.count();
        check_array("bore.stiffness", &self.stiffness, m * m, "motions squared")?;
        let formula = "teeth of a sector * flanks * loads * motions";
        check_array("bore.flank", &self.flank, loads * m, formula)?;
        check_array("bore.gauges", &self.gauges, gauges * m, "gauges * motions")
    }
}

/// A wave around the bore at a polar angle: 1, cos φ, sin φ, cos 2φ …
#[must_use]
pub fn bore_wave(wave: usize, polar_rad: f64) -> f64 {
    let (sin, cos) = (wave.div_ceil(2) as f64 * polar_rad).sin_cos();
    if wave.is_multiple_of(2) && wave > 0 {
        sin
    } else {
        cos
    }
}

/// −1 at the back, 1 at the front.
pub(crate) fn place_along([back, front]: [f64; 2], z_m: f64) -> f64 {
    (2.0 * z_m - back - front) / (front - back)
}

/// Legendre polynomials P_0 to P_(count − 1), by the recurrence of Bonnet.
pub(crate) fn legendre(x: f64, count: usize) -> Vec<f64> {
    let mut all = vec![1.0, x];
    for n in 1..count.max(2) - 1 {
        let k = n as f64;
        all.push(((2.0 * k + 1.0) * x * all[n] - k * all[n - 1]) / (k + 1.0));
    }
    all.truncate(count);
    all
}
