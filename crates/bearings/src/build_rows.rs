//! From a definition to rows ready to be evaluated.

use std::f64::consts::PI;

use crate::ball_row::{BallRow, Groove};
use crate::barrel_row::{BarrelLamina, BarrelRow};
use crate::definition::{
    BallBearingKind, BallGeometry, BarrelShape, BearingDefinition, BearingGeometry, RollerGeometry,
    Taper,
};
use crate::four_point_row::{Arc, FourPointRow};
use crate::line_contact::LineContact;
use crate::point_contact::{PointContact, contact_modulus_pa};
use crate::roller_row::{Lamina, Race, Rib, RollerRow};
use crate::row::Row;

/// E* between elements and rings \[Pa\].
pub(crate) fn modulus_pa(definition: &BearingDefinition) -> f64 {
    contact_modulus_pa(
        definition.element_material.elastic(),
        definition.ring_material.elastic(),
    )
}

/// Hertz contacts of a ball with the inner and outer groove, their curvatures taken at the free contact angle.
pub(crate) fn groove_contacts(g: &BallGeometry, modulus_pa: f64) -> [PointContact; 2] {
    let d = g.ball_diameter_m;
    let gamma = d * g.free_angle_rad.cos() / g.pitch_diameter_m;
    let contact = |conformity: f64, along: f64| {
        let across = 1.0 / conformity;
        PointContact::new((4.0 - across + along) / d, (across + along) / d, modulus_pa)
    };
    [
        contact(g.inner_conformity, 2.0 * gamma / (1.0 - gamma)),
        contact(g.outer_conformity, -2.0 * gamma / (1.0 + gamma)),
    ]
}

/// A row of balls at `middle_z_m` that takes axial forces on the inner ring of the sense `sense`.
pub(crate) fn ball_row(
    definition: &BearingDefinition,
    g: &BallGeometry,
    (middle_z_m, sense): (f64, f64),
) -> BallRow {
    let [inner, outer] = groove_contacts(g, modulus_pa(definition));
    let (d, pitch_radius_m) = (g.ball_diameter_m, 0.5 * g.pitch_diameter_m);
    let (sine, cosine) = (g.free_angle_rad.sin(), g.groove_cosine());
    // The grooves of a deep-groove bearing face each other; its rings stand in the middle of their axial play.
    let apart = match g.kind {
        BallBearingKind::DeepGroove | BallBearingKind::FourPoint { .. } => 0.0,
        BallBearingKind::AngularContact | BallBearingKind::Thrust => sense * sine,
    };
    let faces = match g.kind {
        BallBearingKind::Thrust => (0.0, sense),
        _ => (1.0, 0.0),
    };
    let arms = [g.inner_conformity, g.outer_conformity].map(|f| (f - 0.5) * d);
    BallRow {
        balls: g.balls,
        ball_diameter_m: d,
        pitch_radius_m,
        ball_mass_kg: definition.element_material.density_kg_per_m3 * PI / 6.0 * d.powi(3),
        middle_z_m,
        inner: Groove {
            centre_radius_m: pitch_radius_m + arms[0] * cosine,
            centre_z_m: middle_z_m + arms[0] * apart,
            arm_m: arms[0],
            contact: inner,
            faces,
        },
        outer: Groove {
            centre_radius_m: pitch_radius_m - arms[1] * cosine,
            centre_z_m: middle_z_m - arms[1] * apart,
            arm_m: arms[1],
            contact: outer,
            faces,
        },
        free_angle_rad: apart.asin(),
        first_angle_rad: definition.first_angle_rad,
        faults: None,
    }
}

/// A row of balls between grooves of two arcs each.
pub(crate) fn four_point_row(definition: &BearingDefinition, g: &BallGeometry) -> FourPointRow {
    let contacts = groove_contacts(g, modulus_pa(definition));
    let (d, pitch_radius_m) = (g.ball_diameter_m, 0.5 * g.pitch_diameter_m);
    let (sine, cosine) = (g.free_angle_rad.sin(), g.groove_cosine());
    let arcs = |conformity: f64, contact: PointContact, inwards: f64| {
        let arm_m = (conformity - 0.5) * d;
        [1.0, -1.0].map(|side| Arc {
            groove: Groove {
                centre_radius_m: pitch_radius_m + inwards * arm_m * cosine,
                centre_z_m: inwards * side * arm_m * sine,
                arm_m,
                contact,
                faces: (1.0, 0.0),
            },
            side,
            // Both arcs meet in the middle plane: (f − ½) D sin α = f D sin of the end.
            end_sine: (conformity - 0.5) / conformity * sine,
        })
    };
    FourPointRow {
        balls: g.balls,
        ball_diameter_m: d,
        pitch_radius_m,
        ball_mass_kg: definition.element_material.density_kg_per_m3 * PI / 6.0 * d.powi(3),
        middle_z_m: 0.0,
        inner: arcs(g.inner_conformity, contacts[0], 1.0),
        outer: arcs(g.outer_conformity, contacts[1], -1.0),
        free_angle_rad: g.free_angle_rad,
        first_angle_rad: definition.first_angle_rad,
    }
}

/// Half the angle of a tapered roller: tan ε = (D/d_m) sin(α − ε), so that roller and races share one apex on the axis.
pub(crate) fn half_taper_rad(g: &RollerGeometry) -> f64 {
    g.taper.map_or(0.0, |taper| {
        half_taper_of(g.diameter_m / g.pitch_diameter_m, taper.contact_angle_rad)
    })
}

/// As [`half_taper_rad`], from D/d_m and α.
///
/// The left side grows with ε, the right one falls: one solution between 0 and α, by bisection.
pub(crate) fn half_taper_of(ratio: f64, contact_angle_rad: f64) -> f64 {
    let (mut low, mut high) = (0.0, contact_angle_rad);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if f64::tan(middle) < ratio * (contact_angle_rad - middle).sin() {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// A row of rollers.
pub(crate) fn roller_row(
    definition: &BearingDefinition,
    g: &RollerGeometry,
    (middle_z_m, sense): (f64, f64),
) -> RollerRow {
    let modulus = modulus_pa(definition);
    let half_taper = half_taper_rad(g);
    let outer_angle = g.taper.map_or(0.0, |t| t.contact_angle_rad);
    let axis_angle = outer_angle - half_taper;
    let inner_angle = axis_angle - half_taper;
    let pitch_radius_m = 0.5 * g.pitch_diameter_m;
    let length = g.length_m / g.laminae as f64;
    let laminae = (0..g.laminae)
        .map(|number| {
            let place_m = (number as f64 + 0.5) * length - 0.5 * g.length_m;
            let radius = 0.5 * g.diameter_m + place_m * half_taper.tan();
            Lamina {
                place_m,
                length_m: length,
                reach_m: radius * half_taper.cos() - g.profile.depth_m(place_m, g.length_m),
            }
        })
        .collect();
    let along = 2.0 / g.diameter_m * half_taper.cos();
    // Normal radius of curvature of a cone: its radius there over the cosine of its angle.
    let race_radius = |angle: f64, side: f64| {
        (pitch_radius_m + side * 0.5 * g.diameter_m * axis_angle.cos()) / angle.cos()
    };
    let contact = |curvature: f64| LineContact::new(g.length_m, curvature, modulus);
    let normal = |angle: f64| (angle.cos(), sense * angle.sin());
    // Distance of a race from the roller's middle along its normal.
    let reach = 0.5 * g.diameter_m * half_taper.cos();
    let offset = |(c, s): (f64, f64), side: f64| {
        c * pitch_radius_m + s * middle_z_m + side * (reach + 0.25 * g.radial_clearance_m * c)
    };
    let (inner, outer) = (normal(inner_angle), normal(outer_angle));
    let axis = (axis_angle.sin(), -sense * axis_angle.cos());
    let mass_kg = definition.element_material.density_kg_per_m3
        * PI
        * g.length_m
        * (0.25 * g.diameter_m.powi(2) + (g.length_m * half_taper.tan()).powi(2) / 12.0);
    let own = mass_kg * g.diameter_m.powi(2) / 8.0;
    RollerRow {
        rollers: g.rollers,
        first_angle_rad: definition.first_angle_rad,
        pitch_radius_m,
        diameter_m: g.diameter_m,
        middle_z_m,
        axis,
        laminae,
        inner: Race {
            normal: inner,
            offset_m: offset(inner, -1.0),
            contact: contact(along + 1.0 / race_radius(inner_angle, -1.0)),
        },
        outer: Race {
            normal: outer,
            offset_m: offset(outer, 1.0),
            contact: contact(along - 1.0 / race_radius(outer_angle, 1.0)),
        },
        rib: (g.taper).map(|taper| {
            rib(
                g,
                &taper,
                (middle_z_m, sense),
                (axis_angle, half_taper),
                modulus,
            )
        }),
        mass_kg,
        inertia_kg_m2: (own, 0.5 * own + mass_kg * g.length_m.powi(2) / 12.0),
        missing: Vec::new(),
    }
}

/// The rib at the large end of tapered rollers.
fn rib(
    g: &RollerGeometry,
    taper: &Taper,
    (middle_z_m, sense): (f64, f64),
    (axis_angle, half_taper): (f64, f64),
    modulus: f64,
) -> Rib {
    let pitch_radius_m = 0.5 * g.pitch_diameter_m;
    let axis = (axis_angle.sin(), -sense * axis_angle.cos());
    let apex_m = pitch_radius_m / axis_angle.sin();
    let end_radius = taper.end_radius_ratio * (apex_m + 0.5 * g.length_m);
    let centre_m = 0.5 * g.length_m - end_radius;
    let large = 0.5 * g.diameter_m + 0.5 * g.length_m * half_taper.tan();
    // Towards the inner race, where the rib is.
    let sine = (large - taper.rib_height_m) / end_radius;
    let cosine = (1.0 - sine * sine).sqrt();
    let inward = (axis.1.abs(), sense * axis.0);
    let normal = (
        axis.0 * cosine - inward.0 * sine,
        axis.1 * cosine - inward.1 * sine,
    );
    let centre = (
        pitch_radius_m + axis.0 * centre_m,
        middle_z_m + axis.1 * centre_m,
    );
    Rib {
        centre_m,
        normal,
        offset_m: normal.0 * centre.0 + normal.1 * centre.1,
        stiffness_n_per_m15: 4.0 / 3.0 * modulus * end_radius.sqrt(),
    }
}

/// A row of barrels; `sense` is 1 where the inner ring carries axial loads along +z on it.
pub(crate) fn barrel_row(
    definition: &BearingDefinition,
    g: &RollerGeometry,
    shape: &BarrelShape,
    sense: f64,
) -> BarrelRow {
    let (sine, cosine) = shape.contact_angle_rad.sin_cos();
    let across = (cosine, sense * sine);
    let pitch_radius_m = 0.5 * g.pitch_diameter_m;
    let middle = (pitch_radius_m, pitch_radius_m * across.1 / cosine);
    let gap = 0.25 * g.radial_clearance_m * cosine;
    let to_groove = shape.groove_radius_m - 0.5 * g.diameter_m - gap;
    let length = g.length_m / g.laminae as f64;
    let radius = shape.profile_radius_m;
    let laminae = (0..g.laminae)
        .map(|number| {
            let place_m = (number as f64 + 0.5) * length - 0.5 * g.length_m;
            // R − √(R² − x²) without cancellation.
            let sagitta =
                place_m * place_m / (radius + (radius * radius - place_m * place_m).sqrt());
            BarrelLamina {
                place_m,
                reach_m: 0.5 * g.diameter_m - sagitta,
            }
        })
        .collect();
    let sphere =
        BarrelShape::sphere_radius_m(shape.contact_angle_rad, g.pitch_diameter_m, g.diameter_m);
    let modulus = modulus_pa(definition);
    let roller = 2.0 / g.diameter_m;
    // Normal radii of curvature along the way: of the inner race its distance from the axis along the load line.
    let inner = 1.0 / (pitch_radius_m / cosine - 0.5 * g.diameter_m);
    let contact = |curvature: f64| LineContact::new(g.length_m, curvature, modulus);
    BarrelRow {
        rollers: g.rollers,
        first_angle_rad: definition.first_angle_rad,
        pitch_radius_m,
        diameter_m: g.diameter_m,
        middle_m: middle,
        across,
        laminae,
        lamina_length_m: length,
        groove_centre_m: (
            middle.0 + across.0 * to_groove,
            middle.1 + across.1 * to_groove,
        ),
        groove_radius_m: shape.groove_radius_m,
        sphere_radius_m: sphere + gap,
        contacts: [contact(roller + inner), contact(roller - 1.0 / sphere)],
    }
}

/// The rows of a bearing, not yet preloaded.
pub(crate) fn rows(definition: &BearingDefinition) -> Vec<Row> {
    let places = definition.arrangement.rows();
    let make = |place: (f64, f64)| match &definition.geometry {
        BearingGeometry::Ball(g) if matches!(g.kind, BallBearingKind::FourPoint { .. }) => {
            Row::FourPoint(Box::new(four_point_row(definition, g)))
        }
        BearingGeometry::Ball(g) => Row::Ball(ball_row(definition, g, place)),
        BearingGeometry::Roller(g) => match &g.barrel {
            None => Row::Roller(roller_row(definition, g, place)),
            Some(shape) => Row::Barrel(Box::new(barrel_row(definition, g, shape, place.1))),
        },
    };
    places.into_iter().map(make).collect()
}
