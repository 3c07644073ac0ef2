//! Natural modes by harmonics against those of the whole gear, and what the model file makes of them for the dynamics.

use crate::small_gears::{COARSE, QUADRATIC};
use faer::{Mat, Side};
use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{Flank, GearDefinition, ModeRange};
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_model::ReducedGear;
use gearmesh_reduction::flank_loads::{dot, flank_grid, flank_loads};
use gearmesh_reduction::{
    GearBody, GearMode, GearModes, ReductionError, ReductionOptions, Silent, reduce,
};

const SMALL: &str = r#"
name = "small"
[tooth]
teeth = 18
module_mm = 3.0
profile_shift = 0.1
face_width_mm = 12.0
[material]
young_GPa = 210.0
poisson = 0.3
density_kg_per_m3 = 7850.0
[mesh]
flank_mm = 1.5
fillet_mm = 0.6
body_mm = 4.0
axial_mm = 6.0
[reduction]
roll_stations = 3
slices = 1
[[gauge]]
name = "root"
tooth = 4
side = "right"
length_mm = 1.5
width_mm = 4.0
"#;

const SOLID: &str = "[blank]\nkind = \"solid\"\nbore_diameter_mm = 20.0\n";

/// The web is off the middle: no plane of symmetry keeps bending and torsion apart.
pub(crate) const THIN_RIM: &str = "[blank]
kind = \"thin-rim\"
bore_diameter_mm = 14.0
hub_diameter_mm = 20.0
rim_inner_diameter_mm = 38.0
web_thickness_mm = 3.0
web_offset_mm = 2.0
";

pub(crate) const SLOTS: &str = "slots = { count = 3, inner_radius_mm = 12.0, outer_radius_mm = 17.0, width_deg = 60.0, phase_deg = 60.0, corner_radius_mm = 1.5 }\n";

fn gear(blank: &str, reduction: &str, tables: &str) -> GearDefinition {
    gear_like(SMALL, blank, reduction, tables)
}

fn gear_like(small: &str, blank: &str, reduction: &str, tables: &str) -> GearDefinition {
    let text = small.replace("[reduction]", &format!("[reduction]\n{reduction}"));
    let text = format!("{text}\n{blank}\n{tables}");
    GearDefinition::from_document(&InputDocument::new("small.toml", text)).unwrap()
}

fn body(gear: &GearDefinition) -> GearBody {
    GearBody::new(gear, &PythonEnvironment::find().unwrap(), &Silent).unwrap()
}

/// The modes, and NᵀΦ of the normal loads of tooth 0, `[mode][load]`.
fn modes(gear: &GearDefinition, body: &GearBody, range: ModeRange) -> (GearModes, Vec<Vec<f64>>) {
    let loads = flank_loads(gear, &body.mesh, &flank_grid(gear), 0, Flank::Right);
    let rigid = body.rigid_mass(7850.0).unwrap();
    let mut readings = Vec::new();
    let modes = body
        .natural_modes(&rigid, range, &Silent, |_, _, field| {
            readings.push(loads.iter().map(|l| dot(&l.normal, field)).collect());
        })
        .unwrap();
    (modes, readings)
}

/// NᵀΦ ΦᵀN summed over modes of equal frequency: the shapes of a pair are arbitrary, this is not.
fn groups(modes: &GearModes, readings: &[Vec<f64>]) -> Vec<Mat<f64>> {
    let mut groups: Vec<Mat<f64>> = Vec::new();
    for (k, row) in readings.iter().enumerate() {
        let own = Mat::from_fn(row.len(), row.len(), |i, j| row[i] * row[j]);
        let square = |k: usize| modes.modes[k].omega_squared;
        match groups.last_mut() {
            Some(last) if square(k) < square(k - 1) * (1.0 + 1e-6) => *last += own,
            _ => groups.push(own),
        }
    }
    groups
}

/// Element lengths of [`SMALL`].
const LENGTHS: &str = "flank_mm = 1.5\nfillet_mm = 0.6\nbody_mm = 4.0\naxial_mm = 6.0\n";

/// [`SMALL`] on another mesh.
pub(crate) fn on_mesh(mesh: &str) -> String {
    assert!(SMALL.contains(LENGTHS));
    SMALL.replace(LENGTHS, mesh)
}

/// Both ways find the same modes; the nodal diameters are those of the harmonics. So on every mesh: a coarse one.
fn both_ways_agree(blank: &str, teeth_per_sector: usize) {
    both_ways_agree_like(&on_mesh(COARSE), blank, teeth_per_sector);
}

fn both_ways_agree_like(small: &str, blank: &str, teeth_per_sector: usize) {
    let count = 6;
    let cyclic_gear = gear_like(small, blank, "", "");
    let whole_gear = gear_like(small, blank, "symmetry = \"off\"", "");
    let (cyclic_body, whole_body) = (body(&cyclic_gear), body(&whole_gear));
    let (cyclic, there) = modes(&cyclic_gear, &cyclic_body, ModeRange::Count(count));
    let (whole, here) = modes(&whole_gear, &whole_body, ModeRange::Count(count));
    assert_eq!(cyclic.modes.len(), whole.modes.len());
    assert!((count..=count + 1).contains(&cyclic.modes.len()));
    for (a, b) in cyclic.modes.iter().zip(&whole.modes) {
        let hz = (a.frequency_hz(), b.frequency_hz());
        assert!((hz.0 / hz.1 - 1.0).abs() < 1e-9, "{hz:?}");
        assert_eq!(a.nodal_diameters, b.nodal_diameters, "{hz:?}");
        // What is left of higher modes, 1e-10 in the mass norm, counts here with their ω²: up to 1e4 times as much.
        let residuals = [a.relative_residual, b.relative_residual];
        assert!(residuals.iter().all(|r| *r < 1e-6), "{hz:?} {residuals:?}");
        for (x, y) in a.direction_shares.iter().zip(b.direction_shares) {
            assert!((x - y).abs() < 1e-6, "{a:?} {b:?}");
        }
        if teeth_per_sector == 1 {
            assert!(a.nodal_share > 1.0 - 1e-9, "{a:?}");
        }
    }
    for (a, b) in groups(&cyclic, &there).iter().zip(groups(&whole, &here)) {
        assert!((a - &b).norm_max() < 1e-6 * b.norm_max());
    }
    // All nodal diameters but 0 and z/2 come in pairs, where every tooth is a sector.
    if teeth_per_sector == 1 {
        for n in 1..9 {
            let of_n = cyclic.modes.iter().filter(|m| m.nodal_diameters == n);
            let hz: Vec<f64> = of_n.map(GearMode::frequency_hz).collect();
            for pair in hz.chunks(2) {
                assert!((pair[0] / pair[1] - 1.0).abs() < 1e-10, "{n}: {pair:?}");
            }
        }
    }
    // By frequency: the same list up to just above its last member.
    let end = cyclic.complete_to_hz * (1.0 + 1e-6);
    let by_frequency = modes(&cyclic_gear, &cyclic_body, ModeRange::UpToHz(end)).0;
    assert_eq!(by_frequency.modes.len(), cyclic.modes.len());
    if blank == SOLID {
        let end = cyclic.complete_to_hz * (1.0 - 1e-4);
        let fewer = modes(&whole_gear, &whole_body, ModeRange::UpToHz(end)).0;
        let below = whole.modes.iter().filter(|m| m.frequency_hz() < end);
        assert_eq!(fewer.modes.len(), below.count());
    }
}

#[test]
fn solid_gear() {
    both_ways_agree(SOLID, 1);
}

#[test]
fn helical_solid_gear() {
    let helix = "helix_angle_deg = 20.0\nhand = \"left\"\nface_width_mm";
    let small = on_mesh(COARSE).replace("face_width_mm", helix);
    both_ways_agree_like(&small, SOLID, 1);
}

/// One layer; with a web between layers in `cyclic_symmetry.rs`.
#[test]
fn quadratic_elements() {
    both_ways_agree_like(&on_mesh(QUADRATIC), SOLID, 1);
}

#[test]
fn thin_rim() {
    both_ways_agree(THIN_RIM, 1);
}

#[test]
fn three_slots_with_six_teeth_a_sector() {
    both_ways_agree(&format!("{THIN_RIM}{SLOTS}"), 6);
}

fn drilled(count: usize, phase_deg: f64) -> String {
    format!(
        "{THIN_RIM}holes = {{ count = {count}, pitch_circle_diameter_mm = 29.0, diameter_mm = 4.0, phase_deg = {phase_deg} }}\n"
    )
}

#[test]
fn two_sectors_share_both_their_cuts() {
    both_ways_agree(&drilled(4, 30.0), 9);
}

#[test]
fn no_repetition() {
    both_ways_agree(&drilled(5, 7.0), 18);
}

fn reduced(blank: &str, tables: &str) -> (GearDefinition, ReducedGear, GearBody) {
    reduced_like(SMALL, blank, tables)
}

pub(crate) fn reduced_like(
    small: &str,
    blank: &str,
    tables: &str,
) -> (GearDefinition, ReducedGear, GearBody) {
    let gear = gear_like(small, blank, "", tables);
    let options = ReductionOptions {
        estimate_error: false,
    };
    let python = PythonEnvironment::find().unwrap();
    let (model, body) = reduce(&gear, &python, options, &Silent).unwrap();
    (gear, model, body)
}

/// Mass and inertia of the meshed body by its hexahedra's volume integrals, each by 4×4×4 Gauss points of its own.
fn volume_integrals(body: &GearBody) -> [f64; 10] {
    let (a, b) = (0.339_981_043_584_856_26, 0.861_136_311_594_052_6);
    let (p, q) = (0.652_145_154_862_546_1, 0.347_854_845_137_453_85);
    let rule = [(-b, q), (-a, p), (a, p), (b, q)];
    let mut sums = [0.0; 10];
    for element in 0..body.model.element_count() {
        let corners = body.model.element_coordinates(element).unwrap();
        for (r, wr) in rule {
            for (s, ws) in rule {
                for (t, wt) in rule {
                    let mut x = [0.0; 3];
                    let mut j = [[0.0; 3]; 3];
                    for (corner, c) in corners.iter().zip(gearmesh_fe::CORNERS) {
                        let f = [1.0 + c[0] * r, 1.0 + c[1] * s, 1.0 + c[2] * t];
                        let slope = [
                            c[0] * f[1] * f[2] / 8.0,
                            f[0] * c[1] * f[2] / 8.0,
                            f[0] * f[1] * c[2] / 8.0,
                        ];
                        for i in 0..3 {
                            x[i] += f[0] * f[1] * f[2] / 8.0 * corner[i];
                            for k in 0..3 {
                                j[i][k] += corner[i] * slope[k];
                            }
                        }
                    }
                    let det = j[0][0] * (j[1][1] * j[2][2] - j[1][2] * j[2][1])
                        - j[0][1] * (j[1][0] * j[2][2] - j[1][2] * j[2][0])
                        + j[0][2] * (j[1][0] * j[2][1] - j[1][1] * j[2][0]);
                    let m = 7850.0 * det * wr * ws * wt;
                    let [x, y, z] = x;
                    let parts = [1.0, x, y, z, x * x, y * y, z * z, x * y, y * z, x * z];
                    for (sum, part) in sums.iter_mut().zip(parts) {
                        *sum += m * part;
                    }
                }
            }
        }
    }
    sums
}

pub(crate) const ON_A_POINT: &str = "[hub]\nsupport = \"reference-point\"\n";

#[test]
fn mass_and_inertia_are_the_volume_integrals_of_the_mesh() {
    let (_, model, body) = reduced(&format!("{THIN_RIM}{SLOTS}"), ON_A_POINT);
    assert!(model.modes.is_none());
    let rigid = model.rigid_body.unwrap();
    // From the moments alone, as a gear without modes and reference point has it.
    let alone = body.rigid_body(7850.0).unwrap();
    assert!((alone.mass_kg / rigid.mass_kg - 1.0).abs() < 1e-12);
    for i in 0..3 {
        assert!((alone.centre_m[i] - rigid.centre_m[i]).abs() < 1e-15);
        for j in 0..3 {
            let difference = alone.inertia_kg_m2[i][j] - rigid.inertia_kg_m2[i][j];
            assert!(
                difference.abs() < 1e-12 * rigid.inertia_kg_m2[2][2],
                "{i} {j}"
            );
        }
    }
    let [m, x, y, z, xx, yy, zz, xy, yz, xz] = volume_integrals(&body);
    assert!((rigid.mass_kg / m - 1.0).abs() < 1e-12);
    let radius = (xx / m).sqrt();
    for (found, moment) in rigid.centre_m.iter().zip([x, y, z]) {
        assert!((found - moment / m).abs() < 1e-12 * radius);
    }
    let exact = [
        [yy + zz, -xy, -xz],
        [-xy, xx + zz, -yz],
        [-xz, -yz, xx + yy],
    ];
    for (row, exact) in rigid.inertia_kg_m2.iter().zip(exact) {
        for (found, exact) in row.iter().zip(exact) {
            assert!((found - exact).abs() < 1e-12 * xx, "{found} {exact}");
        }
    }
    // The offset web draws the centre with it.
    assert!(rigid.centre_m[2] > 1e-4);
}

/// Loads under rigid motions have closed forms: a normal load on the right flank has the lever arm r_b about the axis,
/// and all act as unit forces at their points.
#[test]
fn the_rows_of_the_reference_point_are_forces_and_moments() {
    let (gear, model, _) = reduced(SOLID, ON_A_POINT);
    let rows = model.reference_point.as_ref().unwrap();
    let loads = model.grid.len();
    let row = |tooth: usize, flank: usize, load: usize, component: usize| {
        let place = ((tooth * 2 + flank) * loads + load) * 3 + component;
        &rows.flank[6 * place..6 * place + 6]
    };
    let r_b = gear.profile.base_radius_m;
    for tooth in [0, 5, 17] {
        for load in 0..loads {
            let (right, left) = (row(tooth, 0, load, 0), row(tooth, 1, load, 0));
            // The mesh is a chain of chords along the involute.
            assert!((right[5] / r_b - 1.0).abs() < 2e-2, "{}", right[5] / r_b);
            assert!((right[5] + left[5]).abs() < 1e-9 * r_b);
            // Consistent with curvature: the mean of a unit normal is a little shorter than 1.
            let length = right[0].hypot(right[1]);
            assert!((0.98..1.0 + 1e-12).contains(&length), "{length}");
            assert!(right[2].abs() < 1e-12);
            let axial = row(tooth, 0, load, 2);
            assert!((axial[2] - 1.0).abs() < 1e-12 && axial[5].abs() < 1e-12 * r_b);
        }
    }
    let strain = model
        .checks
        .further
        .iter()
        .find(|(name, _)| name == "gauges under rigid motions");
    assert!(strain.unwrap().1 < 1e-10, "{strain:?}");
}

/// C − NᵀΦ Ω⁻² ΦᵀN over all normal loads of all teeth and both hands.
fn residual_flexibility(model: &ReducedGear) -> Mat<f64> {
    let (teeth, loads) = (model.teeth, model.grid.len());
    let size = teeth * 2 * loads;
    let hands = [Flank::Right, Flank::Left];
    let mut all = Mat::zeros(size, size);
    for a in 0..2 * teeth {
        for b in 0..2 * teeth {
            let block = model.c_hub_block(a / 2, hands[a % 2], b / 2, hands[b % 2]);
            for (k, value) in block.iter().enumerate() {
                all[(a * loads + k / loads, b * loads + k % loads)] = *value;
            }
        }
    }
    for (mode, omega_squared) in model
        .modes
        .as_ref()
        .unwrap()
        .omega_squared
        .iter()
        .enumerate()
    {
        let at = |a: usize| model.mode_at_flank(mode, a / 2, hands[a % 2]).unwrap();
        let shape: Vec<f64> = (0..2 * teeth)
            .flat_map(|a| at(a).iter().step_by(3).copied())
            .collect();
        for (a, at_a) in shape.iter().enumerate() {
            for (b, at_b) in shape.iter().enumerate() {
                all[(a, b)] -= at_a * at_b / omega_squared;
            }
        }
    }
    all
}

#[test]
fn the_residual_flexibility_is_positive_and_shrinks_with_each_mode() {
    let (_, full, _) = reduced_like(&on_mesh(COARSE), THIN_RIM, "[modes]\ncount = 20\n");
    let mut last: Option<Mat<f64>> = None;
    let total = full.modes.as_ref().unwrap().count();
    for count in [1, 4, 12, total] {
        let mut model = full.clone();
        let basis = model.modes.as_mut().unwrap();
        let (flank, gauges) = (basis.flank.len() / total, basis.gauges.len() / total);
        basis.omega_squared.truncate(count);
        basis.nodal_diameters.truncate(count);
        basis.flank.truncate(count * flank);
        basis.gauges.truncate(count * gauges);
        basis.coupling.truncate(6 * count);
        model.validate().unwrap();
        let rest = residual_flexibility(&model);
        let scale = rest.norm_max();
        let values = |m: &Mat<f64>| m.self_adjoint_eigenvalues(Side::Lower).unwrap();
        // Rounding of the modes, relative to C itself: their Krylov residual is 1e-10.
        assert!(
            values(&rest)[0] > -1e-9 * scale,
            "{count}: {}",
            values(&rest)[0] / scale
        );
        if let Some(last) = &last {
            let less = last - &rest;
            assert!(values(&less)[0] > -1e-12 * scale);
            assert!(less.norm_max() > 1e-6 * scale);
        }
        last = Some(rest);
    }
    // The gauge's residual rows are those of an adjoint solution without the modes' part: they shrink in energy too.
    let basis = full.modes.as_ref().unwrap();
    let mut rest = full.gauges[0].adjoint.clone();
    for (mode, shape) in basis.flank.chunks_exact(rest.len()).enumerate() {
        let share = basis.gauges[mode * full.gauges.len()] / basis.omega_squared[mode];
        let less = rest.iter_mut().zip(shape);
        less.for_each(|(value, at_load)| *value -= share * at_load);
    }
    let norm = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    assert!(norm(&rest) < norm(&full.gauges[0].adjoint));
}

#[test]
fn a_range_without_modes_says_so() {
    let gear = gear(SOLID, "", "");
    let body = body(&gear);
    let rigid = body.rigid_mass(7850.0).unwrap();
    let outcome = body.natural_modes(&rigid, ModeRange::UpToHz(10.0), &Silent, |_, _, _| {});
    assert!(matches!(outcome, Err(ReductionError::NoModes { up_to_hz }) if up_to_hz == 10.0));
}
