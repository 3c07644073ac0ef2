//! Bearings that several tests use.

use gearmesh_bearings::bearing_file::BearingFromFile;
use gearmesh_bearings::definition::{BearingDefinition, BearingGeometry};
use gearmesh_bearings::quasi_static::Row;
use gearmesh_bearings::{QuasiStaticBearing, Ratings};
use gearmesh_geometry::input::InputDocument;
use nalgebra::{Matrix2, Vector2};

/// REFERENCES §2: Z 16, D 22.23, f 0.5232, 40°, E 206 GPa.
pub const B218: &str = r#"
name = "218"
kind = "angular-contact"
balls = 16
ball_diameter_mm = 22.23
pitch_diameter_mm = 125.3
inner_conformity = 0.5232
outer_conformity = 0.5232
contact_angle_deg = 40.0
"#;

/// A 6205 without clearance; `radial_clearance_um` may be put behind it.
pub const B6205: &str = r#"
name = "6205"
kind = "deep-groove"
balls = 9
ball_diameter_mm = 7.938
pitch_diameter_mm = 39.04
inner_conformity = 0.52
outer_conformity = 0.53
"#;

/// Two 7010 C back to back, pressed in by 5 µm each.
pub const PAIR: &str = r#"
name = "7010 C pair"
kind = "angular-contact"
balls = 19
ball_diameter_mm = 8.731
pitch_diameter_mm = 65.0
inner_conformity = 0.52
outer_conformity = 0.53
contact_angle_deg = 15.0
arrangement = "O"
row_distance_mm = 16.0
preload_um = 5.0
"#;

/// A cylindrical roller bearing.
pub const ROLLERS: &str = r#"
name = "NU 204"
kind = "cylindrical-roller"
rollers = 12
roller_diameter_mm = 7.5
roller_length_mm = 9.0
pitch_diameter_mm = 33.5
radial_clearance_um = 10.0
"#;

/// A tapered roller bearing.
pub const TAPERED: &str = r#"
name = "30206"
kind = "tapered-roller"
rollers = 17
roller_diameter_mm = 7.2
roller_length_mm = 10.5
pitch_diameter_mm = 46.0
contact_angle_deg = 14.04
"#;

pub fn definition(text: &str) -> BearingDefinition {
    let document = InputDocument::new("bearing.toml", text);
    BearingFromFile::from_document(&document)
        .unwrap_or_else(|e| panic!("{e}"))
        .definition
}

pub fn bearing(text: &str) -> QuasiStaticBearing {
    QuasiStaticBearing::new(&definition(text)).unwrap()
}

#[track_caller]
pub fn close(found: f64, expected: f64, relative: f64) {
    assert!(
        (found - expected).abs() <= relative * expected.abs(),
        "found {found}, expected {expected} within {relative:e}: {:e} off",
        found / expected - 1.0
    );
}

/// Where the ring of a ball bearing stands under a radial force, and what its balls carry, by springs K δ^1.5 in the
/// plane, δ = u·e_r less half of the play, each of both races in a row.
pub fn on_springs(
    text: &str,
    force_n: [f64; 3],
    play_m: f64,
    missing: Option<usize>,
) -> (Vector2<f64>, Vec<f64>) {
    let own = bearing(text);
    let Row::Ball(row) = &own.rows[0] else {
        panic!("balls")
    };
    let soft = |k: f64| k.powf(-2.0 / 3.0);
    let both =
        soft(row.inner.contact.stiffness_n_per_m15) + soft(row.outer.contact.stiffness_n_per_m15);
    let stiffness = both.powf(-1.5);
    let approach = |u: &Vector2<f64>, ball: usize| {
        let angle = std::f64::consts::TAU * ball as f64 / row.balls as f64;
        let e = Vector2::new(angle.cos(), angle.sin());
        let is_there = missing != Some(ball);
        let depth_m = if is_there {
            u.dot(&e) - 0.5 * play_m
        } else {
            0.0
        };
        (e, depth_m.max(0.0))
    };
    let force = Vector2::new(force_n[0], force_n[1]);
    let mut u =
        force.normalize() * (0.5 * play_m.max(0.0) + (force.norm() / stiffness).powf(2.0 / 3.0));
    for _ in 0..100 {
        let (mut residual, mut tangent) = (force, Matrix2::zeros());
        for (e, depth_m) in (0..row.balls).map(|ball| approach(&u, ball)) {
            residual -= e * (stiffness * depth_m.powf(1.5));
            tangent += e * e.transpose() * (1.5 * stiffness * depth_m.sqrt());
        }
        u += tangent.try_inverse().unwrap() * residual;
    }
    let loads = (0..row.balls).map(|ball| stiffness * approach(&u, ball).1.powf(1.5));
    (u, loads.collect())
}

/// L10r (10⁶ turns) of ball loads alike on both races, the inner ring turning: ISO/TS 16281 (22) to (26), written out
/// anew for a bearing without contact angle.
pub fn life_of_balls(text: &str, loads_n: &[f64]) -> f64 {
    let definition = definition(text);
    let BearingGeometry::Ball(g) = &definition.geometry else {
        panic!("balls")
    };
    let gamma = g.ball_diameter_m / g.pitch_diameter_m;
    let groove = |f: f64| (2.0 * f - 1.0) / f;
    let grooves = (groove(g.outer_conformity) / groove(g.inner_conformity)).powf(0.41);
    let ratio = 1.044 * ((1.0 - gamma) / (1.0 + gamma)).powf(1.72) * grooves;
    let even = Ratings::of(&definition).dynamic_n / g.balls as f64;
    let mean = |power: f64| {
        let sum: f64 = loads_n.iter().map(|q| q.powf(power)).sum();
        (sum / g.balls as f64).powf(1.0 / power)
    };
    let inner = even / 0.407 * (1.0 + ratio.powf(10.0 / 3.0)).powf(0.3);
    let outer = even / 0.389 * (1.0 + ratio.powf(-10.0 / 3.0)).powf(0.3);
    let damage = (mean(3.0) / inner).powf(10.0 / 3.0) + (mean(10.0 / 3.0) / outer).powf(10.0 / 3.0);
    damage.powf(-0.9)
}
