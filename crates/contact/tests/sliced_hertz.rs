//! Slices of a point contact against Hertz: an ellipsoid on a half space, two crossed cylinders. docs/theory/sliced_contact.md has the curves that
//! are computed here.

use gearmesh_contact::slice_contact::SliceContact;
use gearmesh_contact::{
    ContactPatch, Drive, FlankPlace, HalfSpaces, PatchBalance, RelativeCurvature, SliceLayout,
    SurfaceCurvature,
};
use gearmesh_geometry::point_contact::{PointContact, contact_modulus_pa};
use nalgebra::Vector3;

/// Steel.
const STEEL: (f64, f64) = (206e9, 0.3);

/// Half width of the contact \[m\]: small against all radii.
const HALF_WIDTH: f64 = 1e-4;

/// Length of a slice over the contact's full width.
const SLENDER: f64 = 0.75;

/// Ratios of the axes of the ellipses.
const ASPECTS: [f64; 10] = [1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 7.0, 10.0, 14.0, 20.0];

/// Two bodies that touch: relative curvatures, and the gap over the place along the long axis, least across it.
struct Bodies {
    curvatures_per_m: [f64; 2],
    gap_m: Box<dyn Fn(f64) -> f64>,
}

/// An ellipsoid whose half axes along and across the contact have these curvatures at the pole.
fn ellipsoid([least, largest]: [f64; 2]) -> Bodies {
    let height: f64 = 20e-3;
    let along_m = (height / least).sqrt();
    Bodies {
        curvatures_per_m: [least, largest],
        gap_m: Box::new(move |z| height * (1.0 - (1.0 - (z / along_m).powi(2)).sqrt())),
    }
}

/// Two cylinders of one radius whose axes cross at an angle.
fn crossed_cylinders(radius_m: f64, angle_rad: f64) -> Bodies {
    let axis = |half: f64| Vector3::new(half.cos(), half.sin(), 0.0);
    let axes = [axis(0.5 * angle_rad), axis(-0.5 * angle_rad)];
    let surfaces = axes.map(|first| SurfaceCurvature {
        principal_per_m: [0.0, 1.0 / radius_m],
        first,
    });
    let relative = RelativeCurvature::new(Vector3::z(), surfaces);
    let along = relative.along;
    let across = Vector3::z().cross(&along);
    let gap_at = move |z: f64, t: f64| -> f64 {
        let place = z * along + t * across;
        let depth = |axis: &Vector3<f64>| {
            let off = place.cross(axis).norm();
            radius_m - (radius_m * radius_m - off * off).sqrt()
        };
        axes.iter().map(depth).sum()
    };
    Bodies {
        curvatures_per_m: relative.principal_per_m,
        gap_m: Box::new(move |z| {
            let mut t = 0.0;
            let h = 1e-5;
            for _ in 0..4 {
                let [low, middle, high] = [-h, 0.0, h].map(|step| gap_at(z, t + step));
                t -= 0.5 * h * (high - low) / (high - 2.0 * middle + low);
            }
            gap_at(z, t)
        }),
    }
}

/// Errors of the sliced contact, less one: approach, peak pressure, half width, half length.
struct Errors {
    aspect: f64,
    slices: usize,
    approach: f64,
    pressure: f64,
    half_width: f64,
    half_length: f64,
}

fn sliced(bodies: &Bodies) -> Errors {
    let [least, largest] = bodies.curvatures_per_m;
    let modulus = contact_modulus_pa(STEEL, STEEL);
    let hertz = PointContact::new(least + largest, largest - least, modulus);
    // a goes with the cube root of the load.
    let force_n = (HALF_WIDTH / hertz.ellipse(1.0).half_width_m).powi(3);
    let ellipse = hertz.ellipse(force_n);
    let approach_m = (force_n / hertz.stiffness_n_per_m15).powf(2.0 / 3.0);
    let length_m = SLENDER * 2.0 * ellipse.half_width_m;
    // An odd number, beyond the ends of the contact.
    let half = (1.3 * ellipse.half_length_m / length_m).ceil() as usize;
    let slices = 2 * half + 1;
    let layout = SliceLayout::new([length_m * slices as f64; 2], 0.0, slices);
    let place_m = |slice: usize| (slice as f64 - half as f64) * length_m;
    let patches: Vec<ContactPatch> = (0..slices)
        .map(|slice| ContactPatch {
            teeth: [0, 0],
            line: 0,
            slice,
            places: [FlankPlace { u: 0.0, v: place_m(slice) }; 2],
            share: 1.0,
            length_m,
            radius_m: 1.0 / largest,
            radius_growth: [0.0; 2],
            length_growth: [0.0; 2],
            normal: [0.0, 0.0, 1.0],
            gap_m: (bodies.gap_m)(place_m(slice)),
            balance: PatchBalance::ALONG_NORMALS,
            edge: None,
        })
        .collect();
    let mut contact = SliceContact::of_half_spaces(layout, HalfSpaces::new([STEEL; 2]), 1);
    contact.prepare(&patches, 1e-6 * force_n, false).unwrap();
    let (first, info) = contact.solve(Drive::Torque(force_n)).unwrap();
    let forces = contact.forces_n();
    let (line, _) = contact.hertz(half);
    let half_width_m = line.half_width_m(forces[half]);
    let pressure = gearmesh_contact::hertz::peak_pressure_pa(forces[half] / length_m, half_width_m);
    // The line load of an ellipse is a parabola, whose second moment is a fifth of its half length squared.
    let second: f64 = (0..slices)
        .map(|k| forces[k] * (place_m(k).powi(2) + length_m * length_m / 12.0))
        .sum();
    Errors {
        aspect: hertz.axis_ratio,
        slices: forces.iter().filter(|force| **force > 0.0).count(),
        approach: (info.approach_m - first) / approach_m - 1.0,
        pressure: pressure / ellipse.peak_pressure_pa - 1.0,
        half_width: half_width_m / ellipse.half_width_m - 1.0,
        half_length: (5.0 * second / force_n).sqrt() / ellipse.half_length_m - 1.0,
    }
}

/// By halving: what gives an ellipse with this ratio of its axes.
fn with_aspect(aspect: f64, bodies: impl Fn(f64) -> Bodies, [mut low, mut high]: [f64; 2]) -> Bodies {
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        let [least, largest] = bodies(middle).curvatures_per_m;
        let found = PointContact::new(least + largest, largest - least, 1e11).axis_ratio;
        if found < aspect {
            low = middle;
        } else {
            high = middle;
        }
    }
    bodies(low)
}

fn curves() -> [(&'static str, Vec<Errors>); 2] {
    let on_plane = |aspect: f64| {
        let body = |log_ratio: f64| ellipsoid([100.0 * (-log_ratio).exp(), 100.0]);
        sliced(&with_aspect(aspect, body, [1e-6, 9.0]))
    };
    let crossed = |aspect: f64| {
        // The more the axes are parallel, the longer the ellipse.
        let body = |log_angle: f64| {
            crossed_cylinders(20e-3, std::f64::consts::FRAC_PI_2 * (-log_angle).exp())
        };
        sliced(&with_aspect(aspect, body, [1e-6, 6.0]))
    };
    [
        ("ellipsoid on a half space", ASPECTS.map(on_plane).into()),
        ("crossed cylinders", ASPECTS.map(crossed).into()),
    ]
}

#[test]
fn slices_of_a_point_contact_agree_with_hertz() {
    for (name, errors) in curves() {
        for e in errors {
            println!(
                "{name} {:.2} {} {:+.2} {:+.2} {:+.2} {:+.2}",
                e.aspect, e.slices, 100.0 * e.approach, 100.0 * e.pressure, 100.0 * e.half_width, 100.0 * e.half_length
            );
        }
    }
}
