//! The parts of a gear's definition in a file but the blank (`blank_record.rs`) and microgeometry. Lengths in metres,
//! angles in radians.

use gearmesh_geometry::{
    Blank, BoreMotions, CrackDefinition, Element, Flank, GaugeDefinition, GearDefinition,
    GearMicrogeometry, Gearing, GeometryError, HubSupport, InternalRoot, Material, MeshSettings,
    ModeRange, PinionCutter, ReductionSettings, RootPosition, Symmetry, ToothDefinition,
    ToothGeometry,
};

use crate::file_error::FileError;
use crate::record::{Fields, Named, Record};

/// A definition without what follows from it.
#[derive(Default)]
pub(crate) struct DefinitionParts {
    name: String,
    tooth: ToothDefinition,
    blank: Blank,
    material: Material,
    microgeometry: GearMicrogeometry,
    mesh: MeshSettings,
    reduction: ReductionSettings,
    modes: Option<ModeRange>,
    hub: HubSupport,
    gauges: Vec<GaugeDefinition>,
    crack: Option<CrackDefinition>,
}

impl DefinitionParts {
    pub(crate) fn of(gear: &GearDefinition) -> Self {
        let gear = gear.clone();
        Self {
            name: gear.name,
            tooth: gear.tooth,
            blank: gear.blank,
            material: gear.material,
            microgeometry: gear.microgeometry,
            mesh: gear.mesh,
            reduction: gear.reduction,
            modes: gear.modes,
            hub: gear.hub,
            gauges: gear.gauges,
            crack: gear.crack,
        }
    }

    /// The definition, with the text that it comes from.
    pub(crate) fn into_definition(self, source: String) -> Result<GearDefinition, GeometryError> {
        let profile = ToothGeometry::new(&self.tooth)?;
        Ok(GearDefinition {
            name: self.name,
            tooth: self.tooth,
            blank: self.blank,
            material: self.material,
            microgeometry: self.microgeometry,
            mesh: self.mesh,
            reduction: self.reduction,
            modes: self.modes,
            hub: self.hub,
            gauges: self.gauges,
            crack: self.crack,
            profile,
            source,
        })
    }
}

impl Record for DefinitionParts {
    fn fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        f.text("name", &mut self.name, "name of the gear")?;
        f.group("tooth", |f| self.tooth.fields(f))?;
        f.group("blank", |f| self.blank.fields(f))?;
        f.group("material", |f| self.material.fields(f))?;
        f.group("microgeometry", |f| self.microgeometry.fields(f))?;
        f.group("mesh", |f| self.mesh.fields(f))?;
        f.group("reduction", |f| self.reduction.fields(f))?;
        f.optional("modes", &mut self.modes, ModeRange::fields)?;
        f.choice("hub_support", &mut self.hub, "how the bore is held")?;
        f.list("gauges", &mut self.gauges, GaugeDefinition::fields)?;
        f.optional("crack", &mut self.crack, CrackDefinition::fields)
    }
}

impl Record for ToothDefinition {
    fn fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        f.count("teeth", &mut self.teeth, "number of teeth")?;
        let what = "module, of helical teeth in the normal section";
        f.number("module", &mut self.module_m, "m", what)?;
        let what = "pressure angle of the rack, of helical teeth in the normal section";
        f.number("pressure_angle", &mut self.pressure_angle_rad, "rad", what)?;
        let what = "profile shift coefficient";
        f.number("profile_shift", &mut self.profile_shift, "1", what)?;
        let what = "addendum in modules, without meaning where a tip diameter is given";
        f.number("addendum", &mut self.addendum, "1", what)?;
        let what = "dedendum in modules: addendum of the cutting rack";
        f.number("dedendum", &mut self.dedendum, "1", what)?;
        let what = "tip radius of the cutting rack in modules";
        f.number("rack_tip_radius", &mut self.rack_tip_radius, "1", what)?;
        let what = "tip diameter, where it is stated";
        f.optional_number("tip_diameter", &mut self.tip_diameter_m, "m", what)?;
        let what = "reduction of the tooth thickness on the reference circle";
        let allowance = &mut self.thickness_allowance_m;
        f.number("thickness_allowance", allowance, "m", what)?;
        f.number("tip_chamfer", &mut self.tip_chamfer_m, "m", "tip chamfer")?;
        f.number("face_width", &mut self.face_width_m, "m", "face width")?;
        let what = "helix angle on the reference cylinder, positive for a right hand";
        f.number("helix_angle", &mut self.helix_angle_rad, "rad", what)?;
        let mut internal = match self.gearing {
            Gearing::External => None,
            Gearing::Internal(root) => Some(InternalParts::of(root)),
        };
        f.optional("internal", &mut internal, InternalParts::fields)?;
        if f.is_reading() {
            self.gearing = internal.map_or(Gearing::External, |parts| {
                Gearing::Internal(parts.into_root())
            });
        }
        Ok(())
    }
}

/// What makes the root of internal teeth.
#[derive(Default)]
struct InternalParts {
    full_round: bool,
    cutter: Option<PinionCutter>,
}

impl InternalParts {
    fn of(root: InternalRoot) -> Self {
        match root {
            InternalRoot::FullRound => Self {
                full_round: true,
                cutter: None,
            },
            InternalRoot::Cutter(cutter) => Self {
                full_round: false,
                cutter: Some(cutter),
            },
        }
    }

    fn into_root(self) -> InternalRoot {
        self.cutter
            .map_or(InternalRoot::FullRound, InternalRoot::Cutter)
    }

    fn fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        let what = "the root has one radius";
        f.flag("full_round", &mut self.full_round, what)?;
        f.optional("cutter", &mut self.cutter, |cutter, f| {
            let what = "number of teeth of the pinion cutter";
            f.count("teeth", &mut cutter.teeth, what)?;
            let what = "its profile shift coefficient";
            f.number("profile_shift", &mut cutter.profile_shift, "1", what)?;
            let what = "its addendum in modules";
            f.number("addendum", &mut cutter.addendum, "1", what)?;
            let what = "radius of its tip edges in modules";
            f.number("tip_radius", &mut cutter.tip_radius, "1", what)
        })
    }
}

impl Record for Material {
    fn fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        f.number("young", &mut self.young_pa, "Pa", "Young's modulus")?;
        f.number("poisson", &mut self.poisson, "1", "Poisson's ratio")?;
        let what = "density, where it is stated";
        f.optional_number("density", &mut self.density_kg_per_m3, "kg/m^3", what)
    }
}

impl Record for MeshSettings {
    fn fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        f.choice("element", &mut self.element, "finite element")?;
        let what = "element length along the flank";
        f.number("flank", &mut self.flank_m, "m", what)?;
        let what = "element length along the root fillet";
        f.number("fillet", &mut self.fillet_m, "m", what)?;
        let what = "largest element length in the body";
        f.number("body", &mut self.body_m, "m", what)?;
        let what = "element length along the axis";
        f.number("axial", &mut self.axial_m, "m", what)?;
        let (quality, what) = (
            &mut self.min_scaled_jacobian,
            "smallest scaled Jacobian allowed",
        );
        f.number("min_scaled_jacobian", quality, "1", what)?;
        let what = "cross-section only, plane strain";
        f.flag("plane_strain", &mut self.plane_strain, what)
    }
}

impl Record for ReductionSettings {
    fn fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        let what = "whether the repetition of the gear is used";
        f.choice("symmetry", &mut self.symmetry, what)?;
        let what = "stations of the flank grid along the profile";
        f.count("roll_stations", &mut self.roll_stations, what)?;
        f.count("slices", &mut self.slices, "slices over the face width")?;
        let both = self.flanks.iter().map(|side| side.name().to_owned());
        let mut names: Vec<String> = both.collect();
        f.lines("flanks", &mut names, "flanks that carry loads")?;
        f.optional("bore", &mut self.bore, BoreMotions::fields)?;
        if f.is_reading() {
            let side = |name: &String| match &name[..] {
                "right" => Ok(Flank::Right),
                "left" => Ok(Flank::Left),
                _ => Err(f.contradiction(
                    "flanks",
                    &format!("found {name}, allowed are right and left"),
                )),
            };
            self.flanks = names.iter().map(side).collect::<Result<_, _>>()?;
        }
        Ok(())
    }
}

impl Record for BoreMotions {
    fn fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        let what = "highest harmonic of motions of the bore";
        f.count("harmonics", &mut self.harmonics, what)?;
        f.count("along", &mut self.along, "polynomials along the bore")
    }
}

impl Record for ModeRange {
    fn fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        let (mut count, mut up_to) = match *self {
            Self::Count(count) => (Some(count as f64), None),
            Self::UpToHz(most) => (None, Some(most)),
        };
        f.optional_number("count", &mut count, "1", "number of natural modes")?;
        let what = "all natural modes up to this frequency";
        f.optional_number("up_to", &mut up_to, "Hz", what)?;
        *self = match (count, up_to) {
            (Some(count), None) => Self::Count(count as usize),
            (None, Some(most)) => Self::UpToHz(most),
            _ => return Err(f.contradiction("count", "one of count and up_to holds a number")),
        };
        Ok(())
    }
}

impl Record for GaugeDefinition {
    fn fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        f.text("name", &mut self.name, "name of the gauge")?;
        f.count("tooth", &mut self.tooth, "its tooth")?;
        f.choice("side", &mut self.side, "side of the tooth")?;
        self.position.fields(f)?;
        let what = "length along the profile";
        f.number("length", &mut self.length_m, "m", what)?;
        let what = "axial centre from mid-face";
        f.number("z", &mut self.z_m, "m", what)?;
        f.number("width", &mut self.width_m, "m", "width along the axis")
    }
}

impl Record for RootPosition {
    fn fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        let (mut angle, mut radius) = match *self {
            Self::TangentAngle(angle) => (Some(angle), None),
            Self::Radius(radius) => (None, Some(radius)),
        };
        let what =
            "place on the root profile by the angle of its tangent to the tooth's centre line";
        f.optional_number("tangent_angle", &mut angle, "rad", what)?;
        let what = "the place by its radius";
        f.optional_number("radius", &mut radius, "m", what)?;
        *self = match (angle, radius) {
            (Some(angle), None) => Self::TangentAngle(angle),
            (None, Some(radius)) => Self::Radius(radius),
            _ => {
                let problem = "one of tangent_angle and radius holds a number";
                return Err(f.contradiction("radius", problem));
            }
        };
        Ok(())
    }
}

impl Record for CrackDefinition {
    fn fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        f.count("tooth", &mut self.tooth, "cracked tooth")?;
        f.choice("side", &mut self.side, "side on which it opens")?;
        self.start.fields(f)?;
        f.number("depth", &mut self.depth_m, "m", "depth")?;
        let what = "angle to the tooth's centre line, 0 towards the gear's centre";
        f.number("angle", &mut self.angle_rad, "rad", what)
    }
}

impl Named for Flank {
    const NAMES: &'static [(Self, &'static str)] = &[(Self::Right, "right"), (Self::Left, "left")];
}

impl Named for HubSupport {
    const NAMES: &'static [(Self, &'static str)] = &[
        (Self::Fixed, "fixed"),
        (Self::ReferencePoint, "reference-point"),
    ];
}

impl Named for Symmetry {
    const NAMES: &'static [(Self, &'static str)] = &[(Self::Auto, "auto"), (Self::Off, "off")];
}

impl Named for Element {
    const NAMES: &'static [(Self, &'static str)] = &[
        (Self::Hex8, "hex8"),
        (Self::Hex8Incompatible, "hex8-incompatible"),
        (Self::Hex20, "hex20"),
        (Self::Tet10, "tet10"),
    ];
}
