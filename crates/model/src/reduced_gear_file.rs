//! The file of a reduced gear: the contract between the offline and the online side on disk.

use std::path::Path;

use crate::bevel_body_file::bevel_fields;
use crate::data_tree::{DataTree, FileFormat};
use crate::file_error::FileError;
use crate::modal_basis::ModalBasis;
use crate::near_field::{NearField, calibration_fields};
use crate::record::{Fields, OPEN, Record, read_record, write_record};
use crate::reduced_gear::{GaugeRows, Provenance, ReducedGear};
use crate::reduced_gear_axes::{FLANK_COMPONENTS, GEAR_FRAME, LOAD, MOTION, Sizes};
use crate::rigid_body::{ReferencePoint, RigidBody};
use crate::root_crack::RootCrack;
use crate::shaft_faces_file::shaft_faces_fields;
use gearmesh_geometry::Flank;

/// Name and version of the reduced gear file.
pub const REDUCED_GEAR_FORMAT: FileFormat = FileFormat {
    name: "gearmesh reduced gear",
    // 2: near field; 3: rigid body, reference point, modes; 4: crack; 5: definition of the gear; 6: bevel body; 7:
    // C_hub by patterns; 8: faces of a gear cut into its shaft; 9: motions of the bore
    version: 9,
};

/// The first version that holds what the gear file says, besides its text.
const TYPED_DEFINITION: u32 = 5;

const NORMAL: &str = "inward normal of the flank at each point, positive into the material";

/// Writes a reduced gear, atomically.
///
/// # Errors
/// [`FileError::ReducedGear`] for a gear that contradicts itself, otherwise as [`DataTree::write`].
pub fn write_reduced_gear(path: &Path, gear: &ReducedGear) -> Result<(), FileError> {
    check(path, gear)?;
    let mut tree = DataTree::default();
    write_record(&mut gear.clone(), &mut tree);
    tree.write(path, &REDUCED_GEAR_FORMAT)
}

/// Reads a reduced gear and checks it.
///
/// # Errors
/// Every kind of [`FileError`] except those about meshes; each names the file and the item.
pub fn read_reduced_gear(path: &Path) -> Result<ReducedGear, FileError> {
    let (mut tree, version) = DataTree::read_with_version(path, &REDUCED_GEAR_FORMAT)?;
    let gear: ReducedGear = read_record(&mut tree, path, version)?;
    check(path, &gear)?;
    Ok(gear)
}

fn check(path: &Path, gear: &ReducedGear) -> Result<(), FileError> {
    gear.validate().map_err(|source| FileError::ReducedGear {
        path: path.to_owned(),
        source,
    })
}

impl Record for ReducedGear {
    fn fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        f.text("gear/name", &mut self.name, "name of the gear")?;
        let typed = f.version() >= TYPED_DEFINITION;
        (self.input).fields(f, ("gear/input_toml", "definition"), typed)?;
        f.count("gear/teeth", &mut self.teeth, "number of teeth")?;
        let what = "number of equal sectors of the body";
        f.count("gear/sectors", &mut self.sectors, what)?;
        let what = "base circle radius";
        f.number("gear/base_radius", &mut self.base_radius_m, "m", what)?;
        f.number("gear/face_width", &mut self.face_width_m, "m", "face width")?;
        f.number("gear/young", &mut self.young_pa, "Pa", "Young's modulus")?;
        f.number("gear/poisson", &mut self.poisson, "1", "Poisson's ratio")?;
        self.grid_fields(f)?;
        let sizes = Sizes {
            teeth: self.teeth,
            hands: self.flanks.len(),
            stations: self.grid.roll_angles_rad.len(),
            along: self.grid.z_m.len(),
            loads: self.grid.len(),
            gauges: 0,
        };
        self.compliance_fields(f, sizes)?;
        f.optional("near_field", &mut self.near_field, |it, f| {
            near_field_fields(it, f, sizes)
        })?;
        f.list("gauges", &mut self.gauges, |it, f| {
            gauge_fields(it, f, sizes)
        })?;
        let sizes = Sizes {
            gauges: self.gauges.len(),
            ..sizes
        };
        f.optional("rigid_body", &mut self.rigid_body, RigidBody::fields)?;
        f.optional("reference_point", &mut self.reference_point, |it, f| {
            reference_point_fields(it, f, sizes)
        })?;
        f.optional("modes", &mut self.modes, |it, f| mode_fields(it, f, sizes))?;
        let mode_count = self.modes.as_ref().map_or(0, ModalBasis::count);
        f.optional("shaft_faces", &mut self.shaft_faces, |it, f| {
            let rows = (
                [sizes.teeth, sizes.hands, sizes.loads],
                sizes.gauges,
                mode_count,
            );
            shaft_faces_fields(it, f, rows)
        })?;
        let own = (self.teeth.checked_div(self.sectors)).unwrap_or_default();
        f.optional("bore", &mut self.bore, |it, f| {
            it.fields(f, [own, sizes.hands, sizes.loads, sizes.gauges])
        })?;
        f.optional("crack", &mut self.crack, |it, f| crack_fields(it, f, sizes))?;
        f.optional("bevel", &mut self.bevel, |it, f| bevel_fields(it, f, sizes))?;
        f.group("provenance", |f| self.provenance.fields(f))?;
        self.check_fields(f)
    }
}

impl ReducedGear {
    fn grid_fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        let grid = &mut self.grid;
        let (rolls, axes) = (&mut grid.roll_angles_rad, [("roll station", OPEN)]);
        let what = "roll angles tan(alpha)";
        f.numbers("grid/roll_angles", rolls, &axes, "rad", what)?;
        let axes = [("axial station", OPEN)];
        f.in_frame(GEAR_FRAME)
            .numbers("grid/z", &mut grid.z_m, &axes, "m", "axial positions")?;
        let what = "slices across the face width";
        f.count("grid/slices", &mut grid.slices, what)?;
        let mut codes = self.flanks.iter().map(|flank| *flank as u32).collect();
        let what = "hands that carry loads: 0 right (faces clockwise), 1 left";
        f.counts("grid/flanks", &mut codes, &[("flank", OPEN)], what)?;
        if f.is_reading() {
            let flanks = codes
                .into_iter()
                .map(|code| flank_of(f, "grid/flanks", code));
            self.flanks = flanks.collect::<Result<_, _>>()?;
        }
        Ok(())
    }

    fn compliance_fields(&mut self, f: &mut Fields<'_>, sizes: Sizes) -> Result<(), FileError> {
        let Sizes {
            teeth,
            hands,
            loads,
            ..
        } = sizes;
        // `sectors` may be zero in a faulty file; `validate` divides again and says so.
        let own = teeth.checked_div(self.sectors).unwrap_or_default();
        let response = ("response: roll station, axial station", loads);
        let axes = [
            ("load tooth in sector", own),
            ("load flank", hands),
            ("response tooth", teeth),
            ("response flank", hands),
            (LOAD, loads),
            response,
        ];
        let what = "deflection at the response point per force at the load point, hub held";
        let patterns = "compliance/c_hub_patterns";
        f.optional(patterns, &mut self.hub_patterns, |it, f| {
            it.fields(f, hands * loads, NORMAL)
        })?;
        if f.is_listing() || self.hub_patterns.is_none() {
            f.in_frame(NORMAL)
                .bulk("compliance/c_hub", &mut self.c_hub, &axes, "m/N", what)?;
        }
        let axes = [("flank", hands), (LOAD, loads), response];
        let what = "the same on the tooth-only submodel, equal for all teeth";
        f.in_frame(NORMAL)
            .bulk("compliance/c_tooth", &mut self.c_tooth, &axes, "m/N", what)?;
        let axes = [("flank", hands), ("roll station", sizes.stations)];
        let what = "distance along the normal to the opposite side of the tooth";
        let (name, distances) = (
            "compliance/opposite_distance",
            &mut self.opposite_distance_m,
        );
        f.in_frame(NORMAL)
            .numbers(name, distances, &axes, "m", what)
    }

    /// The two checks that every reduction makes come first, by name, then further ones.
    fn check_fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        let checks = &mut self.checks;
        let first = [
            ("symmetry", checks.symmetry),
            ("pattern_identity", checks.pattern_identity),
        ];
        let mut named: Vec<_> = first.map(|(name, value)| (name.to_owned(), value)).into();
        named.append(&mut checks.further);
        named_numbers(
            f,
            "checks",
            &mut named,
            ("1", "relative error of an identity"),
        )?;
        if f.is_reading() {
            for (k, (name, _)) in first.into_iter().enumerate() {
                if named.get(k).is_none_or(|(found, _)| found != name) {
                    return Err(f.missing(&format!("check \"{name}\"")));
                }
            }
            (checks.symmetry, checks.pattern_identity) = (named[0].1, named[1].1);
            checks.further = named.split_off(2);
        }
        Ok(())
    }
}

fn near_field_fields(
    it: &mut NearField,
    f: &mut Fields<'_>,
    sizes: Sizes,
) -> Result<(), FileError> {
    let lengths_m = [&mut it.half_width_m, &mut it.element_m];
    calibration_fields(f, lengths_m, &mut it.residual)?;
    let rolls = &mut it.roll_angles_rad;
    let what = "roll angles tan(alpha) of the places";
    f.numbers("roll_angles", rolls, &[("place", OPEN)], "rad", what)?;
    let places = [("place", rolls.len())];
    let what = "deflection of the contact centre per line load, tooth-only submodel, plane strain, fine mesh";
    f.in_frame(NORMAL)
        .numbers("contact", &mut it.contact_m2_per_n, &places, "m^2/N", what)?;
    let axes = [
        ("flank", sizes.hands),
        ("load: roll station", sizes.stations),
        ("response: roll station", sizes.stations),
    ];
    let what = "the same per line load of a hat, the gear's own mesh and hats";
    f.in_frame(NORMAL)
        .numbers("mesh", &mut it.mesh_m2_per_n, &axes, "m^2/N", what)
}

fn gauge_fields(it: &mut GaugeRows, f: &mut Fields<'_>, sizes: Sizes) -> Result<(), FileError> {
    f.text("name", &mut it.name, "name of the gauge")?;
    let what = "position and size in words";
    f.text("description", &mut it.description, what)?;
    f.count("tooth", &mut it.tooth, "tooth the gauge sits on")?;
    let what = "side of the tooth: 0 right, 1 left";
    flank(f, "side", &mut it.side, what)?;
    let what = "estimated relative discretisation error";
    f.number("error_estimate", &mut it.error_estimate_relative, "1", what)?;
    let (hands, load) = (("flank", sizes.hands), (LOAD, sizes.loads));
    let axes = [("tooth", sizes.teeth), hands, load, ("component", 3)];
    f.in_frame(FLANK_COMPONENTS).bulk(
        "adjoint",
        &mut it.adjoint,
        &axes,
        "1/N",
        "strain per force, method 2",
    )?;
    let what = "strain per force on the own tooth that method 1 leaves out";
    f.in_frame(NORMAL)
        .bulk("own_tooth", &mut it.own_tooth, &[hands, load], "1/N", what)
}

impl Record for RigidBody {
    fn fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        f.number("mass", &mut self.mass_kg, "kg", "mass of the meshed body")?;
        let axes = [("axis", 3), ("axis", 3)];
        let what = "point that the inertia tensor is about";
        f.in_frame(GEAR_FRAME)
            .fixed("reference", &mut self.reference_m, &axes[..1], "m", what)?;
        let what = "centre of mass";
        f.in_frame(GEAR_FRAME)
            .fixed("centre", &mut self.centre_m, &axes[..1], "m", what)?;
        let inertia = self.inertia_kg_m2.as_flattened_mut();
        let what = "inertia tensor about the reference point";
        f.in_frame(GEAR_FRAME)
            .fixed("inertia", inertia, &axes, "kg*m^2", what)
    }
}

fn reference_point_fields(
    it: &mut ReferencePoint,
    f: &mut Fields<'_>,
    sizes: Sizes,
) -> Result<(), FileError> {
    let what = "place of the hub's reference point";
    f.in_frame(GEAR_FRAME)
        .fixed("place", &mut it.place_m, &[("axis", 3)], "m", what)?;
    let axes = [
        ("tooth", sizes.teeth),
        ("flank", sizes.hands),
        (LOAD, sizes.loads),
        ("component", 3),
        (MOTION, 6),
    ];
    let what = "displacement at the flank per motion of the hub's reference point (m per rad for rotations)";
    f.in_frame(FLANK_COMPONENTS)
        .bulk("flank", &mut it.flank, &axes, "1", what)
}

fn mode_fields(it: &mut ModalBasis, f: &mut Fields<'_>, sizes: Sizes) -> Result<(), FileError> {
    let what = "every mode up to this frequency is in the basis";
    f.number("complete_to", &mut it.complete_to_hz, "Hz", what)?;
    let what = "squares of the natural angular frequencies, bore held";
    let squares = &mut it.omega_squared;
    f.numbers(
        "omega_squared",
        squares,
        &[("mode", OPEN)],
        "rad^2/s^2",
        what,
    )?;
    let modes = ("mode", squares.len());
    let mut diameters = it.nodal_diameters.iter().map(|&n| n as u32).collect();
    let what = "nodal diameters: the strongest harmonic round the teeth";
    f.counts("nodal_diameters", &mut diameters, &[modes], what)?;
    it.nodal_diameters = diameters.into_iter().map(|n| n as usize).collect();
    let axes = [
        modes,
        ("tooth", sizes.teeth),
        ("flank", sizes.hands),
        (LOAD, sizes.loads),
        ("component", 3),
    ];
    let what = "mode shapes of modal mass 1 at the flank grid";
    f.in_frame(FLANK_COMPONENTS)
        .bulk("flank", &mut it.flank, &axes, "kg^-1/2", what)?;
    let axes = [modes, ("gauge", sizes.gauges)];
    let what = "strain of the gauges in the mode shapes";
    f.numbers("gauges", &mut it.gauges, &axes, "m^-1*kg^-1/2", what)?;
    let axes = [modes, (MOTION, 6)];
    let what = "mode shapes times mass matrix times rigid motions about the origin (kg^1/2 m for rotations)";
    f.in_frame(GEAR_FRAME)
        .numbers("coupling", &mut it.coupling, &axes, "kg^1/2", what)
}

fn crack_fields(it: &mut RootCrack, f: &mut Fields<'_>, sizes: Sizes) -> Result<(), FileError> {
    f.count("tooth", &mut it.tooth, "cracked tooth")?;
    let what = "side on which it opens: 0 right, 1 left";
    flank(f, "side", &mut it.side, what)?;
    let what = "radius of its mouth";
    f.number("mouth_radius", &mut it.mouth_radius_m, "m", what)?;
    f.number("depth", &mut it.depth_m, "m", "depth")?;
    let what = "angle to the tooth's centre line, 0 towards the gear's centre";
    f.number("angle", &mut it.angle_rad, "rad", what)?;
    let what = "bound of the compliance that further rows would add, relative to the largest added";
    f.number("left_out", &mut it.left_out, "1", what)?;
    let axes = [("row", OPEN), ("tooth", sizes.teeth), (LOAD, sizes.loads)];
    let what = "rows whose products are the compliance added by the crack, for loads on its side of the teeth";
    f.in_frame(NORMAL)
        .bulk("rows", &mut it.rows, &axes, "(m/N)^0.5", what)
}

impl Record for Provenance {
    fn fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        let what = "program that reduced the gear";
        f.text("program", &mut self.program, what)?;
        f.text("version", &mut self.version, "its version")?;
        f.text("created_utc", &mut self.created_utc, "when, UTC")?;
        f.text("element", &mut self.element, "finite elements")?;
        f.count("threads", &mut self.threads, "threads used")?;
        let what = "nodes of the finite element model";
        f.count("nodes", &mut self.nodes, what)?;
        f.count("elements", &mut self.elements, "elements of the model")?;
        let what = "free degrees of freedom of the model";
        f.count("dofs", &mut self.dofs, what)?;
        named_numbers(
            f,
            "stage",
            &mut self.stage_seconds,
            ("s", "wall-clock time of a stage"),
        )?;
        named_numbers(
            f,
            "effort",
            &mut self.effort,
            ("1", "a count of what was done"),
        )
    }
}

/// An ordered list of named numbers as `group/index/{name, value}`: the names are free text.
fn named_numbers(
    f: &mut Fields<'_>,
    group: &str,
    numbers: &mut Vec<(String, f64)>,
    (unit, what): (&str, &str),
) -> Result<(), FileError> {
    f.list(group, numbers, |(name, value), f| {
        f.text("name", name, "its name")?;
        f.number("value", value, unit, what)
    })
}

fn flank(f: &mut Fields<'_>, name: &str, flank: &mut Flank, what: &str) -> Result<(), FileError> {
    let mut code = *flank as usize;
    f.count(name, &mut code, what)?;
    *flank = flank_of(f, name, code as u32)?;
    Ok(())
}

fn flank_of(f: &Fields<'_>, item: &str, code: u32) -> Result<Flank, FileError> {
    let found = Flank::ALL.get(code as usize);
    found.copied().ok_or_else(|| {
        let found = format!("the code {code}");
        f.wrong_type(item, &found, "0 (right) or 1 (left)")
    })
}
