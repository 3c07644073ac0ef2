//! Sets at rest in several positions, with springs and gaps by hand beside them.
//!
//! Sun and ring push a planet along f and −g; with the sun's torque σ = ±1 and the planet at the angle ψ
//!
//! ```text
//! f = σ cos α e_t + sin α e_r,   g = −σ cos α e_t + sin α e_r
//! E = −f·v_s + (f − g)·v_p + g·v_r + removed          gap that a displaced sun, planet, ring opens
//! F_n = K (σ x − E_n) = F̄ + K (Ē − E_n),   x = r_bs φ_s + r_br φ_r − (r_bs + r_br) φ_c
//! ```

use std::f64::consts::TAU;

use gearmesh_scene::system_run::SystemResult;
use nalgebra::Vector2;

use super::*;

pub const ALPHA_DEG: f64 = 20.0;
/// Centre distance \[m\], of 24, 36 and 96 teeth of module 3.
pub const ARM_M: f64 = 0.09;
/// Both meshes of a planet in series: 20 N/(mm µm) on 25 mm each \[N/m\].
pub const STIFFNESS: f64 = 2.5e8;

/// A driven member, one that is held or turns by itself, and a loaded one; torque on the sun positive or negative.
pub struct Drive {
    /// Keys of sun, ring and carrier.
    pub keys: [String; 3],
    /// What is driven, and by how much for a turn of the carrier against the ring \[deg\].
    pub driven: (&'static str, f64),
    pub sense: f64,
}

/// Mean normal force F̄ of three planets \[N\] by the torque of the loaded member.
pub fn drives(force_n: f64) -> Vec<Drive> {
    let base = 3.0 * force_n * ALPHA_DEG.to_radians().cos();
    let torque = |radius_m: f64| format!("torque_Nm = {:?}", base * radius_m);
    let against = |radius_m: f64| format!("torque_Nm = {:?}", -base * radius_m);
    let (still, held) = (
        "speed_rpm = 0.0".to_owned(),
        "support = \"held\"".to_owned(),
    );
    vec![
        Drive {
            keys: [still.clone(), held.clone(), against(2.0 * ARM_M)],
            driven: ("sun", 5.0 * 360.0),
            sense: 1.0,
        },
        Drive {
            keys: [against(36e-3), held.clone(), still.clone()],
            driven: ("carrier", 360.0),
            sense: -1.0,
        },
        // The sun is held: a turn of the carrier against the ring is -4 turns of itself.
        Drive {
            keys: [held.clone(), torque(144e-3), still.clone()],
            driven: ("carrier", -4.0 * 360.0),
            sense: 1.0,
        },
        // The carrier is held, the ring driven.
        Drive {
            keys: [torque(36e-3), still, held],
            driven: ("ring", -360.0),
            sense: 1.0,
        },
    ]
}

/// A set in so many positions, some mesh periods of the sun or the ring apart.
pub fn of_drive(
    drive: &Drive,
    (planets, more): (&str, &str),
    (rows, pitches): (usize, f64),
) -> String {
    let (driven, turn_deg) = drive.driven;
    let angle = |i: usize| format!("{:?}", turn_deg * pitches / 96.0 * i as f64);
    let angles: Vec<String> = (0..rows).map(angle).collect();
    let kind = format!(
        "kind = \"static\"\nmotion = \"set {driven} speed\"\nangles_deg = [{}]",
        angles.join(", ")
    );
    let [sun, ring, carrier] = &drive.keys;
    let carrier = format!("inertia_kg_m2 = [0.1, 0.1, 0.1]\n{carrier}");
    scene(&kind, 1e3 * ARM_M, [sun, ring, &carrier, planets, more])
}

/// A set at rest in many positions: where everything stands, and what the meshes carry.
pub struct Rows {
    result: SystemResult,
    pub sense: f64,
}

impl Rows {
    pub fn of(text: &str, sense: f64, folder: &Path) -> Self {
        Self {
            result: run(text, folder),
            sense,
        }
    }

    pub fn read(&self, name: &str) -> Vec<f64> {
        self.result.rows.read(name).unwrap()
    }

    pub fn turns(&self, part: &str) -> Vec<f64> {
        self.read(&format!("bodies/set {part}/turn_rad"))
    }

    /// Angle at which the x axis of a part stands \[rad\].
    pub fn stands(&self, part: &str) -> Vec<f64> {
        self.read(&format!("bodies/set {part}/cardan_z_rad"))
    }

    pub fn forces(&self, planet: usize, which: &str) -> Vec<f64> {
        let name = match which {
            "sun" => format!("sun-planet {}", planet + 1),
            _ => format!("planet {}-ring", planet + 1),
        };
        let of = |side| self.read(&format!("elements/set {name}/normal_force_{side}_N"));
        of("left")
            .iter()
            .zip(of("right"))
            .map(|(a, b)| a + b)
            .collect()
    }

    /// σ x: what the meshes approach each other but for a constant \[m\].
    pub fn approach(&self) -> Vec<f64> {
        let [sun, ring, carrier] = ["sun", "ring", "carrier"].map(|part| self.turns(part));
        let cos = self.sense * ALPHA_DEG.to_radians().cos();
        let x = |row: usize| 36e-3 * sun[row] + 144e-3 * ring[row] - 2.0 * ARM_M * carrier[row];
        (0..sun.len()).map(|row| cos * x(row)).collect()
    }

    /// Directions f and g of a planet in a row.
    pub fn directions(&self, planet: usize, carrier_rad: f64) -> [Vector2<f64>; 2] {
        let out = unit(TAU * planet as f64 / 3.0 + carrier_rad);
        let on = Vector2::new(-out.y, out.x);
        let (sin, cos) = ALPHA_DEG.to_radians().sin_cos();
        [self.sense, -self.sense].map(|sign| sign * cos * on + sin * out)
    }
}

pub fn unit(angle_rad: f64) -> Vector2<f64> {
    Vector2::new(angle_rad.cos(), angle_rad.sin())
}
