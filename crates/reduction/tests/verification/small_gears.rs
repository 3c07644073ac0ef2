//! Small gears that are meshed and solved in a second or two, and how numbers are compared.

use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{GearDefinition, Symmetry};
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_model::ReducedGear;
use gearmesh_reduction::{GearBody, ReductionOptions, Silent, reduce};

/// Element lengths.
pub const MESH: &str = "flank_mm = 1.5\nfillet_mm = 0.6\nbody_mm = 4.0\naxial_mm = 3.0\n";
/// As long as the mesh's quality allows: for what holds on every mesh to rounding, such as two ways to solve the same
/// equations.
pub const COARSE: &str = "flank_mm = 2.4\nfillet_mm = 1.2\nbody_mm = 6.0\naxial_mm = 6.0\n";
/// Twenty nodes an element, and not twice as many degrees of freedom as [`MESH`] has with eight.
pub const QUADRATIC: &str =
    "element = \"hex20\"\nflank_mm = 2.4\nfillet_mm = 1.2\nbody_mm = 6.0\naxial_mm = 12.0\n";

/// Tetrahedra, likewise.
pub const TETRAHEDRA: &str =
    "element = \"tet10\"\nflank_mm = 3.0\nfillet_mm = 0.8\nbody_mm = 8.0\naxial_mm = 6.0\n";

pub const SOLID: &str = "[blank]\nkind = \"solid\"\nbore_diameter_mm = 20.0\n";
pub const THIN_RIM: &str = "[blank]
kind = \"thin-rim\"
bore_diameter_mm = 14.0
hub_diameter_mm = 20.0
rim_inner_diameter_mm = 38.0
web_thickness_mm = 4.0
";
/// A conical web with a kink, off the middle, and a hub wider than the face on one side, narrower on the other.
pub const CONTOUR: &str = "[blank]
kind = \"contour\"
bore_diameter_mm = 14.0
hub_z_mm = [-8.0, 5.0]
web = [
  { diameter_mm = 20.0, z_mm = [-4.0, 1.0] },
  { diameter_mm = 28.0, z_mm = [-2.5, 1.5] },
  { diameter_mm = 38.0, z_mm = [-1.0, 2.0] },
]
";
/// The same with fillets at hub, kink and rim.
pub const FILLETED: &str = "[blank]
kind = \"contour\"
bore_diameter_mm = 14.0
hub_z_mm = [-8.0, 5.0]
web = [
  { diameter_mm = 20.0, z_mm = [-4.0, 1.0], fillet_radius_mm = 1.5 },
  { diameter_mm = 28.0, z_mm = [-2.5, 1.5], fillet_radius_mm = 8.0 },
  { diameter_mm = 38.0, z_mm = [-1.0, 2.0], fillet_radius_mm = 2.0 },
]
";
/// For [`THIN_RIM`]: sectors of six teeth.
pub const SLOTS: &str = "slots = { count = 3, inner_radius_mm = 12.0, outer_radius_mm = 17.0, width_deg = 60.0, phase_deg = 60.0, corner_radius_mm = 1.5 }\n";

/// A gear of 18 teeth, module 3 mm, 12 mm wide, with one gauge; `helix_deg` is positive for a right hand.
pub fn gear(mesh: &str, blank: &str, helix_deg: f64) -> GearDefinition {
    with_gauges(mesh, blank, helix_deg, &[(3, "right")])
}

/// The same with gauges on the roots of the teeth and sides named.
pub fn with_gauges(
    mesh: &str,
    blank: &str,
    helix_deg: f64,
    gauges: &[(usize, &str)],
) -> GearDefinition {
    let helix = if helix_deg == 0.0 {
        String::new()
    } else {
        let hand = if helix_deg > 0.0 { "right" } else { "left" };
        let size = helix_deg.abs();
        format!("helix_angle_deg = {size:e}\nhand = \"{hand}\"\n")
    };
    let gauges: String = gauges
        .iter()
        .map(|(tooth, side)| {
            format!(
                "[[gauge]]\nname = \"root of tooth {tooth}, {side}\"\ntooth = {tooth}\nside = \"{side}\"\nlength_mm = 0.9\n\
                 width_mm = 4.0\nz_mm = 2.0\n"
            )
        })
        .collect();
    let text = format!(
        "name = \"small\"\n[tooth]\nteeth = 18\nmodule_mm = 3.0\nprofile_shift = 0.1\nface_width_mm = 12.0\n{helix}\
         [material]\nyoung_GPa = 210.0\npoisson = 0.3\n[reduction]\nroll_stations = 4\nslices = 2\nflanks = [\"right\", \"left\"]\n\
         [mesh]\n{mesh}{gauges}{blank}"
    );
    GearDefinition::from_document(&InputDocument::new("small.toml", text)).unwrap()
}

/// The same gear, solved by one factorisation of everything.
pub fn without_symmetry(gear: &GearDefinition) -> GearDefinition {
    let mut gear = gear.clone();
    gear.reduction.symmetry = Symmetry::Off;
    gear
}

pub fn body(gear: &GearDefinition) -> GearBody {
    GearBody::new(gear, &PythonEnvironment::find().unwrap(), &Silent).unwrap()
}

pub fn reduced(gear: &GearDefinition, estimate_error: bool) -> (ReducedGear, GearBody) {
    let options = ReductionOptions { estimate_error };
    reduce(gear, &PythonEnvironment::find().unwrap(), options, &Silent).unwrap()
}

/// Largest difference relative to the largest value.
pub fn difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let largest = a.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    let differences = a.iter().zip(b).map(|(x, y)| (x - y).abs());
    differences.fold(0.0, f64::max) / largest
}
