//! Fits and heat: closed forms, a cylinder model of its own, and bearings whose clearance is stated instead.

use gearmesh_bearings::bearing_file::BearingFromFile;
use gearmesh_bearings::definition::BearingGeometry;
use gearmesh_bearings::fit::{OperatingClearance, raceways_m};
use gearmesh_bearings::{Operation, RingPose};
use gearmesh_geometry::input::InputDocument;
use nalgebra::{Vector3, Vector5};

use crate::common::{B6205, PAIR, ROLLERS, TAPERED, bearing, close, definition};

const SIZES_6205: &str = "bore_mm = 25.0\noutside_diameter_mm = 52.0\nradial_clearance_um = 12.0\n";

fn clearance(text: &str) -> OperatingClearance {
    definition(text).operating_clearance().unwrap()
}

/// A solid shaft of the ring's own material: with d²/F² = k the raceway grows by the interference times d/F, whatever E
/// and ν.
#[test]
fn a_solid_shaft_of_the_rings_material_widens_the_raceway_by_d_over_f() {
    let seated = "[fit]\nshaft_interference_um = 10.0\n";
    let other = "young_GPa = 70.0, poisson = 0.2 }\n";
    for fit in [
        format!("{B6205}{SIZES_6205}{seated}"),
        format!("{B6205}{SIZES_6205}ring_material = {{ {other}{seated}shaft_material = {{ {other}"),
    ] {
        let found = clearance(&fit);
        let [inner_m, _] = raceways_m(&definition(&fit).geometry);
        close(found.by_shaft_m, -10e-6 * 0.025 / inner_m, 1e-12);
        close(found.operating_m(), 12e-6 + found.by_shaft_m, 1e-12);
        assert_eq!(found.by_housing_m, 0.0);
    }
}

/// A housing without end of the ring's own material: the raceway shrinks by the interference times E/D.
#[test]
fn a_thick_housing_of_the_rings_material_narrows_the_raceway_by_e_over_d() {
    let fit = |outside: f64| {
        clearance(&format!(
            "{B6205}{SIZES_6205}[fit]\nhousing_interference_um = 8.0\nhousing_outside_diameter_mm = {outside}\n"
        ))
    };
    let [_, outer_m] = raceways_m(&definition(&format!("{B6205}{SIZES_6205}")).geometry);
    let limit = -8e-6 * outer_m / 0.052;
    // What is missing is (D² − E²)/(D_h² − E²), which vanishes with the housing's size.
    let missing = |outside: f64| 1.0 - fit(outside).by_housing_m / limit;
    for outside in [60.0, 100.0, 1000.0] {
        let section = |d: f64| d * d - outer_m * outer_m;
        close(
            missing(outside),
            section(0.052) / section(1e-3 * outside),
            1e-9,
        );
    }
    // A thin housing presses less.
    assert!(missing(60.0) > 0.3);
}

/// E, ν, α, temperature above 20 °C.
type Body = (f64, f64, f64, f64);

/// Two cylinders, one pressed into the other, by linear elements along the radius in plane stress: growth of the radius
/// of the innermost and the outermost surface under a radial overlap, heat included. It knows no formula of Lamé's:
/// only ½∫(σ_r ε_r + σ_θ ε_θ) r dr.
fn pressed(radii: [f64; 3], bodies: [Body; 2], overlap: f64, cells: usize) -> [f64; 2] {
    let nodes = 2 * cells + 1;
    // Row sums of a tridiagonal matrix and its load; the node of the joint belongs to both, the outer body's copy lies
    // `overlap` farther out.
    let mut diagonal = vec![0.0; nodes];
    let mut beside = vec![0.0; nodes - 1];
    let mut load = vec![0.0; nodes];
    for (which, (e, nu, alpha, rise)) in bodies.into_iter().enumerate() {
        let (from, to) = (radii[which], radii[which + 1]);
        let h = (to - from) / cells as f64;
        let c = e / (1.0 - nu * nu);
        for cell in 0..cells {
            let a = which * cells + cell;
            let start = from + h * cell as f64;
            for (x, weight) in [
                (0.5 - 0.75_f64.sqrt() / 3.0, 0.5),
                (0.5 + 0.75_f64.sqrt() / 3.0, 0.5),
            ] {
                let r = start + x * h;
                let w = weight * h * r;
                // Strains by the two nodes: ε_r, ε_θ.
                let b = [[-1.0 / h, 1.0 / h], [(1.0 - x) / r, x / r]];
                let k = |i: usize, j: usize| {
                    c * w
                        * (b[0][i] * b[0][j]
                            + b[1][i] * b[1][j]
                            + nu * (b[0][i] * b[1][j] + b[1][i] * b[0][j]))
                };
                let heat = |i: usize| c * (1.0 + nu) * alpha * rise * w * (b[0][i] + b[1][i]);
                diagonal[a] += k(0, 0);
                diagonal[a + 1] += k(1, 1);
                beside[a] += k(0, 1);
                load[a] += heat(0);
                load[a + 1] += heat(1);
                if a == cells {
                    // The outer body's first node stands at u + overlap.
                    load[a] -= k(0, 0) * overlap;
                    load[a + 1] -= k(1, 0) * overlap;
                }
            }
        }
    }
    if radii[0] == 0.0 {
        // On the axis nothing moves.
        diagonal[0] = 1.0;
        beside[0] = 0.0;
        load[0] = 0.0;
    }
    for i in 1..nodes {
        let factor = beside[i - 1] / diagonal[i - 1];
        diagonal[i] -= factor * beside[i - 1];
        load[i] -= factor * load[i - 1];
    }
    let mut u = load;
    u[nodes - 1] /= diagonal[nodes - 1];
    for i in (0..nodes - 1).rev() {
        u[i] = (u[i] - beside[i] * u[i + 1]) / diagonal[i];
    }
    [u[0], u[nodes - 1]]
}

/// Hollow shaft and aluminium housing, all at their own temperatures, against cylinders by finite elements: second
/// order in the element's length.
#[test]
fn raceways_move_as_cylinders_by_finite_elements_do() {
    let text = format!(
        "{B6205}{SIZES_6205}[fit]\nshaft_interference_um = 11.0\nshaft_bore_mm = 12.0\nhousing_interference_um = 14.0\n\
         housing_outside_diameter_mm = 75.0\ninner_ring_temperature_C = 75.0\nouter_ring_temperature_C = 60.0\nelement_temperature_C = 80.0\n\
         shaft_temperature_C = 82.0\nhousing_temperature_C = 51.0\nring_expansion_um_per_m_K = 12.5\n\
         [fit.shaft_material]\nyoung_GPa = 120.0\npoisson = 0.25\nexpansion_um_per_m_K = 10.0\n\
         [fit.housing_material]\nyoung_GPa = 70.0\npoisson = 0.33\nexpansion_um_per_m_K = 23.0\n"
    );
    let found = clearance(&text);
    let [inner_m, outer_m] = raceways_m(&definition(&text).geometry);
    let ring = |rise: f64| (206e9, 0.3, 12.5e-6, rise);
    let by_shaft = 0.5 * -(found.by_shaft_m + found.by_inner_heat_m);
    let by_housing = 0.5 * (found.by_housing_m + found.by_outer_heat_m);
    let mut before = [0.0; 2];
    for cells in [25, 50, 100, 200] {
        let shaft = (120e9, 0.25, 10e-6, 62.0);
        let radii = [6e-3, 12.5e-3, 0.5 * inner_m];
        let [_, inner] = pressed(radii, [shaft, ring(55.0)], 5.5e-6, cells);
        // The outer body's copy of the joint is what moves by the overlap: the ring's far surface moves with it only
        // where it is the outer one.
        let housing = (70e9, 0.33, 23e-6, 31.0);
        let radii = [0.5 * outer_m, 26e-3, 37.5e-3];
        let [outer, _] = pressed(radii, [ring(40.0), housing], 7e-6, cells);
        let errors = [inner - by_shaft, outer - by_housing].map(f64::abs);
        if cells > 25 {
            for (error, before) in errors.iter().zip(before) {
                close(before / error, 4.0, 0.02);
            }
        }
        before = errors;
    }
    assert!(
        before[0] < 1e-5 * by_shaft.abs() && before[1] < 1e-5 * by_housing.abs(),
        "{before:?}"
    );
    // The aluminium grew away from the ring: it presses by less than cold, but still.
    let seat = found.housing.unwrap();
    assert!(seat.pressure_pa > 0.0 && seat.interference_m < 14e-6);
    close(
        found.by_element_heat_m,
        -2.0 * 7.938e-3 * 12.5e-6 * 60.0,
        1e-12,
    );
}

/// One temperature everywhere, one material: everything grows alike, the clearance by the same share.
#[test]
fn one_temperature_everywhere_changes_nothing() {
    let with = |temperature: f64| {
        clearance(&format!(
            "{B6205}{SIZES_6205}[fit]\ninner_ring_temperature_C = {temperature}\nouter_ring_temperature_C = {temperature}\n\
             shaft_interference_um = 0.0\nhousing_interference_um = 0.0\nhousing_outside_diameter_mm = 80.0\n"
        ))
    };
    let warm = with(120.0);
    close(warm.operating_m(), 12e-6 * (1.0 + 100.0 * 12e-6), 1e-9);
    for seat in [warm.shaft.unwrap(), warm.housing.unwrap()] {
        assert!(seat.interference_m.abs() < 1e-15, "{seat:?}");
    }
    close(with(20.0).operating_m(), 12e-6, 1e-12);
}

/// A loose ring is not pressed; heat may close the gap.
#[test]
fn loose_rings_are_not_pressed() {
    let with = |shaft_c: f64| {
        clearance(&format!(
            "{B6205}{SIZES_6205}[fit]\nshaft_interference_um = -5.0\ninner_ring_temperature_C = 20.0\nouter_ring_temperature_C = 20.0\nshaft_temperature_C = {shaft_c}\n"
        ))
    };
    let cold = with(20.0);
    assert_eq!(cold.change_m(), 0.0);
    assert_eq!(cold.shaft.unwrap().pressure_pa, 0.0);
    // 25 mm × 12e-6 × 40 K = 12 µm of growth, 7 µm of interference.
    let warm = with(60.0);
    close(warm.shaft.unwrap().interference_m, 7e-6, 1e-9);
    assert!(warm.by_shaft_m < -5e-6);
}

/// A bearing with a fit is the one whose stated clearance is that in operation; balls move by micrometres of 19.5 mm,
/// no more.
#[test]
fn a_fitted_bearing_is_that_of_its_operating_clearance() {
    for (text, sizes, stated) in [
        (
            B6205.to_owned(),
            "bore_mm = 25.0\noutside_diameter_mm = 52.0\n",
            12.0,
        ),
        (
            ROLLERS.replace("radial_clearance_um = 10.0\n", ""),
            "bore_mm = 20.0\noutside_diameter_mm = 47.0\n",
            10.0,
        ),
    ] {
        let fitted = format!(
            "{text}{sizes}radial_clearance_um = {stated}\n[fit]\nshaft_interference_um = 9.0\nhousing_interference_um = 3.0\n\
             housing_outside_diameter_mm = 90.0\ninner_ring_temperature_C = 60.0\nouter_ring_temperature_C = 50.0\n"
        );
        let found = clearance(&fitted).operating_m();
        assert!(found < 1e-6 * stated - 5e-6);
        let plain = format!("{text}{sizes}radial_clearance_um = {}\n", 1e6 * found);
        let pose = RingPose::from_five(&Vector5::new(12e-6, -5e-6, 0.0, 0.0, 0.0));
        let operation = Operation::default();
        let [own, other] =
            [fitted, plain].map(|text| bearing(&text).evaluate(&pose, &operation).unwrap());
        let size = other.load.fixed_rows::<3>(0).norm();
        assert!(size > 100.0, "{size}");
        assert!(
            (own.load - other.load).norm() < 1e-4 * size,
            "{} {}",
            own.load,
            other.load
        );
    }
}

/// Two rows back to back: seated where they were, an interference presses them by more; the load of each ball by the
/// triangle of its groove centres.
#[test]
fn a_fit_adds_to_the_preload_of_a_pair() {
    let text = format!(
        "{PAIR}bore_mm = 50.0\noutside_diameter_mm = 80.0\n[fit]\nshaft_interference_um = 8.0\n"
    );
    let found = clearance(&text);
    let own = bearing(&text);
    let (_, loads) = own
        .loads(&RingPose::default(), &Operation::default())
        .unwrap();
    let d = definition(&text);
    let BearingGeometry::Ball(g) = &d.geometry else {
        panic!("balls")
    };
    let (sine, cosine) = g.free_angle_rad.sin_cos();
    let distance = g.groove_distance_m();
    let (radial, axial) = (
        distance * cosine - 0.5 * found.change_m(),
        distance * sine + 5e-6,
    );
    let approach = radial.hypot(axial) - distance;
    let gearmesh_bearings::quasi_static::Row::Ball(row) = &own.rows[0] else {
        panic!("balls")
    };
    let [inner, outer] =
        [&row.inner, &row.outer].map(|groove| groove.contact.stiffness_n_per_m15.powf(-2.0 / 3.0));
    let load = (approach / (inner + outer)).powf(1.5);
    for e in loads.elements.iter().flatten() {
        close(e.inner_load_n, load, 1e-9);
        close(e.inner_contact_angle_rad.abs().tan(), axial / radial, 1e-9);
    }
    let (_, before) = bearing(PAIR)
        .loads(&RingPose::default(), &Operation::default())
        .unwrap();
    assert!(load > 1.5 * before.elements[0][0].inner_load_n);
}

/// An outer ring that shrinks by c across a race of the angle α presses tapered rollers as an inner ring pushed in by
/// c/tan α: both move the race by c cos α along its normal.
#[test]
fn a_squeezed_cup_presses_tapered_rollers_as_a_pushed_cone() {
    let text = format!(
        "{TAPERED}bore_mm = 30.0\noutside_diameter_mm = 62.0\n[fit]\nhousing_interference_um = 10.0\nhousing_outside_diameter_mm = 120.0\n"
    );
    let shrink = -0.5 * clearance(&text).by_housing_m;
    let pushed = RingPose {
        centre_m: Vector3::new(0.0, 0.0, shrink / 14.04_f64.to_radians().tan()),
        axis: Vector3::z(),
    };
    let operation = Operation::default();
    let fitted = bearing(&text)
        .evaluate(&RingPose::default(), &operation)
        .unwrap();
    let plain = bearing(TAPERED).evaluate(&pushed, &operation).unwrap();
    assert!(plain.load[2] < -100.0, "{}", plain.load);
    close(fitted.load[2], plain.load[2], 1e-6);
}

#[test]
fn bad_fits_are_refused() {
    let complaint = |fit: &str| {
        let document = InputDocument::new("b.toml", format!("{B6205}{SIZES_6205}[fit]\n{fit}"));
        BearingFromFile::from_document(&document)
            .unwrap_err()
            .to_string()
    };
    for (fit, parts) in [
        (
            "shaft_bore_mm = 5.0",
            [
                "fit.shaft_bore_mm",
                "not used without shaft_interference_um",
            ],
        ),
        (
            "housing_temperature_C = 5.0",
            ["fit.housing_temperature_C", "housing_interference_um"],
        ),
        (
            "housing_interference_um = 5.0",
            ["fit.housing_outside_diameter_mm", "missing"],
        ),
        (
            "housing_interference_um = 5.0\nhousing_outside_diameter_mm = 50.0",
            ["found 50", "more than 52"],
        ),
        (
            "shaft_interference_um = 1.0\nshaft_bore_mm = 25.0",
            ["found 25", "not including, 25"],
        ),
        (
            "shaft_interference_um = 800.0",
            ["found 800", "-250 to 250"],
        ),
        (
            "inner_ring_temperature_C = 80.0",
            ["fit.outer_ring_temperature_C", "missing"],
        ),
        (
            "shaft_interference_um = 1.0\nshaft_temperature_C = 80.0",
            ["shaft_temperature_C", "inner_ring_temperature_C"],
        ),
        (
            "inner_ring_temperature_C = 800.0\nouter_ring_temperature_C = 20.0",
            ["found 800", "-200 to 500"],
        ),
        (
            "shaft_interference_um = 200.0",
            ["in operation is -14", "up to, not including"],
        ),
        (
            "shaft_interference_um = 1.0\nshaft_material = { young_GPa = 206000.0, poisson = 0.3 }",
            ["206000", "1 to 1000"],
        ),
    ] {
        let found = complaint(fit);
        for part in parts {
            assert!(found.contains(part), "`{part}` is not in: {found}");
        }
    }
    let document = InputDocument::new(
        "b.toml",
        format!("{B6205}[fit]\nshaft_interference_um = 1.0"),
    );
    let found = BearingFromFile::from_document(&document)
        .unwrap_err()
        .to_string();
    assert!(
        found.contains("bore_mm") && found.contains("[fit]"),
        "{found}"
    );
    let inside_out = format!(
        "{B6205}bore_mm = 25.0\noutside_diameter_mm = 46.9\n[fit]\nshaft_interference_um = 1.0"
    );
    let document = InputDocument::new("b.toml", inside_out);
    let found = BearingFromFile::from_document(&document)
        .unwrap_err()
        .to_string();
    assert!(found.contains("fit") && found.contains("46.978"), "{found}");
    // A line of the catalogue says its sizes.
    let listed =
        "kind = \"catalogue\"\ndesignation = \"6205\"\n[fit]\nshaft_interference_um = 5.0\n";
    assert!(clearance(listed).by_shaft_m < -3e-6);
}
