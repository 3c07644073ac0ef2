//! Slices of a point contact against Hertz: an ellipsoid on a half space, two crossed cylinders.
//! docs/theory/sliced_contact.md has the curves that are computed here.

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
const SLENDER: f64 = 0.6;

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
            places: [FlankPlace {
                u: 0.0,
                v: place_m(slice),
            }; 2],
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

impl Errors {
    fn all(&self) -> [f64; 4] {
        [
            self.approach,
            self.pressure,
            self.half_width,
            self.half_length,
        ]
    }
}

/// By halving: what gives an ellipse with this ratio of its axes.
fn with_aspect(
    aspect: f64,
    bodies: impl Fn(f64) -> Bodies,
    [mut low, mut high]: [f64; 2],
) -> Bodies {
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

/// The page's table of both bodies.
fn table(curves: &[(&str, Vec<Errors>); 2]) -> String {
    let mut lines = vec![
        "| bodies | long over short axis | slices | approach % | peak pressure % | half width % | half length % |".to_owned(),
        "| --- | --- | --- | --- | --- | --- | --- |".to_owned(),
    ];
    for (name, errors) in curves {
        lines.extend(errors.iter().map(|e| {
            let [a, p, w, l] = e.all().map(|error| format!("{:+.2}", 100.0 * error));
            format!(
                "| {name} | {:.1} | {} | {a} | {p} | {w} | {l} |",
                e.aspect, e.slices
            )
        }));
    }
    lines.join("\n")
}

/// The four curves of a table over the logarithm of the ratio.
fn picture(errors: &[Errors]) -> String {
    const COLOURS: [&str; 4] = ["#1f5fa8", "#c2410c", "#15803d", "#7e22ce"];
    const NAMES: [&str; 4] = ["approach", "peak pressure", "half width", "half length"];
    let x = |aspect: f64| 60.0 + 480.0 * (aspect / 1.5).ln() / (20.0f64 / 1.5).ln();
    let y = |percent: f64| 180.0 - 7.5 * percent;
    let mut svg = vec![
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 700 340\" font-family=\"sans-serif\" font-size=\"12\">".to_owned(),
        "<rect width=\"700\" height=\"340\" fill=\"white\"/>".to_owned(),
        format!("<rect x=\"60\" y=\"{}\" width=\"480\" height=\"{}\" fill=\"#eef2f7\"/>", y(3.0), y(-3.0) - y(3.0)),
    ];
    for percent in [-15, -10, -5, 0, 5, 10, 15] {
        let at = y(f64::from(percent));
        svg.push(format!("<line x1=\"60\" y1=\"{at}\" x2=\"540\" y2=\"{at}\" stroke=\"#ccc\"/><text x=\"54\" y=\"{}\" text-anchor=\"end\">{percent:+}</text>", at + 4.0));
    }
    for aspect in ASPECTS {
        let at = x(aspect);
        svg.push(format!(
            "<text x=\"{at:.1}\" y=\"320\" text-anchor=\"middle\">{aspect}</text>"
        ));
    }
    for (k, (name, colour)) in NAMES.iter().zip(COLOURS).enumerate() {
        let points: Vec<String> = errors
            .iter()
            .map(|e| format!("{:.1},{:.1}", x(e.aspect), y(100.0 * e.all()[k])))
            .collect();
        svg.push(format!(
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"2\"/>",
            points.join(" ")
        ));
        let at = 60.0 + 20.0 * k as f64;
        svg.push(format!(
            "<text x=\"555\" y=\"{at}\" fill=\"{colour}\">{name}</text>"
        ));
    }
    svg.push("<text x=\"60\" y=\"28\">error against Hertz, % (grey: 3 %)</text>".to_owned());
    svg.push("<text x=\"540\" y=\"336\" text-anchor=\"end\">long over short axis of the ellipse</text></svg>\n".to_owned());
    svg.join("\n")
}

#[test]
fn slices_of_a_point_contact_agree_with_hertz() {
    let curves = curves();
    for (name, errors) in &curves {
        for e in errors.iter().filter(|e| e.aspect > 3.99) {
            let [a, p, w, l] = e.all();
            let aspect = e.aspect;
            assert!(a.abs() < 0.01 && p.abs() < 0.02, "{name} {aspect}: {a} {p}");
            assert!(w.abs() < 0.03 && l.abs() < 0.03, "{name} {aspect}: {w} {l}");
        }
        let longest = errors.last().map(Errors::all).unwrap();
        assert!(longest.iter().all(|e| e.abs() < 4e-3), "{name} {longest:?}");
    }
    // The page shows what is computed here.
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/theory");
    let made = [table(&curves), picture(&curves[0].1)];
    let names = ["sliced_contact.md", "sliced_contact.svg"];
    for (text, name) in made.iter().zip(names) {
        let shown = std::fs::read_to_string(format!("{root}/{name}")).unwrap();
        let now = format!("{}/{name}", env!("CARGO_TARGET_TMPDIR"));
        std::fs::write(&now, text).unwrap();
        assert!(
            shown.contains(text),
            "docs/theory/{name} shows other figures than {now}"
        );
    }
}
