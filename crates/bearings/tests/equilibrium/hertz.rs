//! Elliptic integrals and point contacts.

use crate::common::close;
use gearmesh_bearings::elliptic::of_axis_ratio;
use gearmesh_bearings::point_contact::{PointContact, contact_modulus_pa};

/// K and E at m = 0, 0.5 and 0.99 (Abramowitz and Stegun, table 17.1).
#[test]
fn complete_integrals_are_those_of_the_tables() {
    for (m, first, second) in [
        (
            0.0,
            std::f64::consts::FRAC_PI_2,
            std::f64::consts::FRAC_PI_2,
        ),
        (0.5, 1.854074677301372, 1.350643881047675),
        (0.99, 3.695637362989875, 1.015993545025224),
    ] {
        let found = of_axis_ratio((1.0_f64 - m).powf(-0.5));
        close(found.first, first, 1e-14);
        close(found.second, second, 1e-14);
    }
}

/// Two spheres: k = (4/3) E* √R, a³ = 3QR/(4E*).
#[test]
fn a_sphere_on_a_plane_is_the_circular_case() {
    let modulus = contact_modulus_pa((206e9, 0.3), (206e9, 0.3));
    let radius = 4.7625e-3;
    let contact = PointContact::new(2.0 / radius, 0.0, modulus);
    close(contact.axis_ratio, 1.0, 1e-12);
    close(
        contact.stiffness_n_per_m15,
        4.0 / 3.0 * modulus * f64::sqrt(radius),
        1e-12,
    );
    let ellipse = contact.ellipse(100.0);
    close(
        ellipse.half_length_m,
        (75.0 * radius / modulus).cbrt(),
        1e-12,
    );
    // Mean pressure is two thirds of the peak.
    let area = std::f64::consts::PI * ellipse.half_length_m * ellipse.half_width_m;
    close(ellipse.peak_pressure_pa, 1.5 * 100.0 / area, 1e-14);
}

/// The 218 bearing of REFERENCES §2: axis ratios and stiffnesses by scipy's integrals (tools/reference/bearings.py).
#[test]
fn stiffness_of_the_218_is_that_of_scipy() {
    let row = match &crate::common::bearing(crate::common::B218).rows[0] {
        gearmesh_bearings::quasi_static::Row::Ball(row) => row.clone(),
        _ => unreachable!(),
    };
    let mm15 = 1e3_f64.powf(1.5);
    close(row.inner.contact.axis_ratio, 8.155136947955842, 1e-12);
    close(row.outer.contact.axis_ratio, 6.897410157678095, 1e-12);
    close(
        row.inner.contact.stiffness_n_per_m15,
        mm15 * 1287243.6079026521,
        1e-12,
    );
    close(
        row.outer.contact.stiffness_n_per_m15,
        mm15 * 1338963.077313778,
        1e-12,
    );
}
