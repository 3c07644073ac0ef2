//! How many natural modes a gear has up to a frequency, roughly and before any of them is known.
//!
//! H. Weyl's law counts the waves that fit into a body: those that bend a plate, those in its plane, and those of a
//! solid, whose wavelengths fit into the thickness, too. For a part of the area A, the thickness h and the volume V = A
//! h
//!
//! ```text
//! N(ω) = A ω/(4π) √(ρ h/D) + A ω²/(4π) (1/c_p² + 1/c_t²) + V ω³/(6π²) (1/c_l³ + 2/c_t³)
//! D = E h³/(12 (1 − ν²)),  c_p² = E/(ρ (1 − ν²)),  c_t² = E/(2ρ (1 + ν)),  c_l² = E (1 − ν)/(ρ (1 + ν)(1 − 2ν))
//! ```
//!
//! Hub, web and rim are rings of their thickness up to the reference circle. What is held or free at the edges shifts
//! the count by a term of one order less in ω: of the lowest few modes it counts one. Source: R. Courant, D.
//! Hilbert, *Methods of Mathematical Physics* I, section VI.4.

use gearmesh_geometry::{GearDefinition, Material, Openings};
use std::f64::consts::{PI, TAU};

/// Modes up to a frequency \[Hz\]; none without a density, or where the gear was meshed elsewhere.
pub fn modes_up_to(gear: &GearDefinition, frequency_hz: f64) -> Option<f64> {
    if gear.blank.meshed().is_some() {
        return None;
    }
    let density = gear.material.density_kg_per_m3?;
    let omega = TAU * frequency_hz;
    let parts = plates(gear);
    Some(
        parts
            .iter()
            .map(|plate| plate.modes_up_to(omega, gear.material, density))
            .sum(),
    )
}

/// A flat part.
#[derive(Debug, Clone, Copy)]
struct Plate {
    area_m2: f64,
    thickness_m: f64,
}

impl Plate {
    fn ring(inner_m: f64, outer_m: f64, thickness_m: f64) -> Self {
        Self {
            area_m2: PI * (outer_m * outer_m - inner_m * inner_m).max(0.0),
            thickness_m,
        }
    }

    fn modes_up_to(&self, omega: f64, material: Material, density: f64) -> f64 {
        let (nu, area) = (material.poisson, self.area_m2);
        let per_mass = material.young_pa / density;
        let in_plane = per_mass / (1.0 - nu * nu);
        let shear = per_mass / (2.0 * (1.0 + nu));
        let dilatation = per_mass * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
        // ρ h/D
        let bending = 12.0 / (in_plane * self.thickness_m * self.thickness_m);
        area * omega * bending.sqrt() / (4.0 * PI)
            + area * omega * omega / (4.0 * PI) * (1.0 / in_plane + 1.0 / shear)
            + area * self.thickness_m * omega.powi(3) / (6.0 * PI * PI)
                * (dilatation.powf(-1.5) + 2.0 * shear.powf(-1.5))
    }
}

/// Hub, web and rim; the openings are taken out of the web, or of the disc.
fn plates(gear: &GearDefinition) -> Vec<Plate> {
    let (bore, width) = (gear.blank.bore_radius_m(), gear.tooth.face_width_m);
    let reference = gear.profile.reference_radius_m;
    let (mut parts, opened) = match gear.blank.web() {
        None => {
            let edge = gear.blank.rim().map_or(bore, |rim| rim.outer_radius_m);
            let (inner, outer) = (edge.min(reference), edge.max(reference));
            (vec![Plate::ring(inner, outer, width)], 0)
        }
        Some(web) => (
            vec![
                Plate::ring(bore, web.hub_radius_m, width),
                Plate::ring(web.hub_radius_m, web.rim_inner_radius_m, web.thickness_m),
                Plate::ring(web.rim_inner_radius_m, reference, width),
            ],
            1,
        ),
    };
    let open_m2 = match gear.blank.openings() {
        None => 0.0,
        Some(Openings::Holes(holes)) => holes.count as f64 * PI * holes.radius_m.powi(2),
        Some(Openings::Slots(slots)) => {
            let (inner, outer) = (slots.inner_radius_m, slots.outer_radius_m);
            0.5 * slots.count as f64 * slots.width_rad * (outer * outer - inner * inner)
        }
    };
    parts[opened].area_m2 = (parts[opened].area_m2 - open_m2).max(0.0);
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEEL: Material = Material {
        young_pa: 210e9,
        poisson: 0.3,
        density_kg_per_m3: Some(7850.0),
    };

    /// Bending of a simply supported plate, ω = π² (i²/a² + j²/b²) √(D/ρh): the term of bending and its correction at
    /// the edges, half of which the law leaves out.
    #[test]
    fn bending_waves_of_a_plate_are_counted() {
        let (a, b, h) = (0.5, 0.3, 1e-3);
        let plate = Plate {
            area_m2: a * b,
            thickness_m: h,
        };
        let in_plane = 210e9 / 7850.0 / (1.0 - 0.09);
        let wave = h * f64::sqrt(in_plane / 12.0);
        let omega = 4000.0 * TAU;
        let most = (omega / wave).sqrt() / PI;
        let (mut exact, mut i) = (0.0, 1.0);
        while i / a < most {
            exact += (b * (most * most - i * i / (a * a)).sqrt()).floor();
            i += 1.0;
        }
        // N = A k²/(4π) − (a + b) k/(2π) + …
        let found = plate.modes_up_to(omega, STEEL, 7850.0);
        let edges = (a + b) * PI * most / TAU;
        assert!(
            (found - edges - exact).abs() < 0.1 * edges,
            "{found} {exact} {edges}"
        );
        assert!(exact > 100.0);
    }

    /// Block on rollers: for each (i, j, l) one dilatational mode where not all are zero, and shear modes, two where
    /// none is zero and one where one is (docs/theory/modes.md). A cube: the faces' terms are of one order less.
    #[test]
    fn waves_in_a_solid_are_counted() {
        let side = 0.2;
        let (per_mass, nu) = (210e9 / 7850.0, 0.3);
        let shear = per_mass / (2.0 * (1.0 + nu));
        let dilatation = per_mass * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
        let omega: f64 = 250e3 * TAU;
        let most = (omega * side / PI / f64::sqrt(shear)) as i32 + 1;
        let mut exact = 0.0;
        for i in 0..=most {
            for j in 0..=most {
                for l in 0..=most {
                    let square = f64::from(i * i + j * j + l * l) * (PI / side).powi(2);
                    let zeros = [i, j, l].iter().filter(|n| **n == 0).count();
                    let shears = [2.0, 1.0, 0.0, 0.0][zeros];
                    exact += if square * shear <= omega * omega {
                        shears
                    } else {
                        0.0
                    };
                    let waves =
                        f64::from(u8::from(zeros < 3 && square * dilatation <= omega * omega));
                    exact += waves;
                }
            }
        }
        let plate = Plate {
            area_m2: side * side,
            thickness_m: side,
        };
        let flat = plate.area_m2 * omega / (4.0 * PI) * (12.0 * (1.0 - nu * nu) / per_mass).sqrt()
            / side
            + plate.area_m2 * omega * omega / (4.0 * PI)
                * ((1.0 - nu * nu) / per_mass + 1.0 / shear);
        let solid = plate.modes_up_to(omega, STEEL, 7850.0) - flat;
        // Faces: at most those of one kind of wave, S ω²/(16π c²).
        let faces =
            6.0 * side * side * omega * omega / (16.0 * PI) * (1.0 / dilatation + 2.0 / shear);
        assert!(
            (solid - exact).abs() < faces && exact > 1000.0,
            "{solid} {exact} {faces}"
        );
    }
}
