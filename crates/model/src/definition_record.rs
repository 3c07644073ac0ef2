//! The parts of a gear's definition in a file. Lengths in metres, angles in radians.

use gearmesh_geometry::{
    Blank, BoreMotions, Contour, ContourPoint, CrackDefinition, Element, Flank, GaugeDefinition,
    GearDefinition, GearMicrogeometry, Gearing, GeometryError, Holes, HubSupport, InternalRoot,
    LengthUnit, Lugs, Material, MeshSettings, MeshedBody, ModeRange, Openings, PinionCutter,
    ReductionSettings, RootPosition, Slots, Symmetry, ToothDefinition, ToothGeometry, Web,
};

use crate::file_error::FileError;
use crate::record::{Fields, Named, OPEN, Record};

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

impl Record for Blank {
    fn fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        let mut bore_radius_m = self.bore_radius_m();
        let (mut web, mut contour) = (self.web(), self.contour().cloned());
        let mut meshed = self.meshed().cloned();
        let mut shaft = self.cut_into_shaft().copied();
        let mut rim = self.rim().copied();
        let (mut slots, mut holes) = match self.openings() {
            None => (None, None),
            Some(Openings::Slots(slots)) => (Some(slots), None),
            Some(Openings::Holes(holes)) => (None, Some(holes)),
        };
        f.number("bore_radius", &mut bore_radius_m, "m", "bore radius")?;
        f.optional("web", &mut web, Web::fields)?;
        f.optional("contour", &mut contour, Contour::fields)?;
        f.optional("slots", &mut slots, Slots::fields)?;
        f.optional("holes", &mut holes, Holes::fields)?;
        f.optional("meshed", &mut meshed, MeshedBody::fields)?;
        f.optional("shaft", &mut shaft, |shaft, f| {
            let what = "radius of the hole that the mesh leaves open along the axis";
            f.number("hole_radius", &mut shaft.hole_radius_m, "m", what)?;
            let what = "radius of the shaft at back and front, where a gear cut into it is held; 0 where it does not go on";
            let ends = [("back, front", 2)];
            f.fixed("end_radii", &mut shaft.end_radii_m, &ends, "m", what)
        })?;
        f.optional("rim", &mut rim, |rim, f| {
            let what = "outer radius of a ring with internal teeth";
            f.number("outer_radius", &mut rim.outer_radius_m, "m", what)?;
            let mut back = rim.held_z_m.map(|band| band[0]);
            let mut front = rim.held_z_m.map(|band| band[1]);
            let what = "back of the band of the outside that is held, where not all of it is";
            f.optional_number("held_back", &mut back, "m", what)?;
            let what = "its front";
            f.optional_number("held_front", &mut front, "m", what)?;
            rim.held_z_m = back.zip(front).map(|(back, front)| [back, front]);
            f.optional("lugs", &mut rim.lugs, Lugs::fields)
        })?;
        if !f.is_reading() {
            return Ok(());
        }
        let openings = match (slots, holes) {
            (Some(_), Some(_)) => return Err(f.contradiction("holes", "there are slots, too")),
            (slots, holes) => slots.map(Openings::Slots).or(holes.map(Openings::Holes)),
        };
        if let Some(rim) = rim {
            if shaft.is_some() || meshed.is_some() || web.is_some() || openings.is_some() {
                let what = "there is a shaft, a web, openings or a mesh from elsewhere, too";
                return Err(f.contradiction("rim", what));
            }
            *self = Self::Ring(rim);
            return Ok(());
        }
        if let Some(shaft) = shaft {
            if meshed.is_some() || web.is_some() || contour.is_some() || openings.is_some() {
                let what = "there is a web, a contour, openings or a mesh from elsewhere, too";
                return Err(f.contradiction("shaft", what));
            }
            if bore_radius_m != 0.0 {
                return Err(f.contradiction("shaft", "there is a bore, too"));
            }
            *self = Self::CutIntoShaft(shaft);
            return Ok(());
        }
        *self = match (meshed, web, contour) {
            (Some(body), None, None) if openings.is_none() => Self::Meshed {
                bore_radius_m,
                body,
            },
            (Some(_), ..) => {
                let what = "there is a web, a contour or openings, too";
                return Err(f.contradiction("meshed", what));
            }
            (None, Some(web), contour) => Self::Webbed {
                bore_radius_m,
                web,
                contour,
                openings,
            },
            (None, None, None) => Self::Solid {
                bore_radius_m,
                openings,
            },
            (None, None, Some(_)) => return Err(f.contradiction("contour", "there is no web")),
        };
        Ok(())
    }
}

impl Record for Web {
    fn fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        let what = "outer radius of the hub";
        f.number("hub_radius", &mut self.hub_radius_m, "m", what)?;
        let what = "inner radius of the rim";
        f.number("rim_inner_radius", &mut self.rim_inner_radius_m, "m", what)?;
        f.number("thickness", &mut self.thickness_m, "m", "web thickness")?;
        let what = "axial position of the web's mid-plane from mid-face";
        f.number("offset", &mut self.offset_m, "m", what)
    }
}

impl Record for Contour {
    fn fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        let what = "z of the hub's back and front";
        f.fixed("hub", &mut self.hub_z_m, &[("back, front", 2)], "m", what)?;
        let of = |p: &ContourPoint| [p.radius_m, p.z_m[0], p.z_m[1], p.fillet_radius_m];
        let mut points: Vec<f64> = self.web.iter().flat_map(of).collect();
        let axes = [("point", OPEN), ("radius, back, front, fillet radius", 4)];
        let what =
            "z of the web's back and front from the hub to the rim, straight between the points";
        f.numbers("web", &mut points, &axes, "m", what)?;
        let point = |p: &[f64; 4]| ContourPoint {
            radius_m: p[0],
            z_m: [p[1], p[2]],
            fillet_radius_m: p[3],
        };
        self.web = points.as_chunks().0.iter().map(point).collect();
        Ok(())
    }
}

impl Record for Lugs {
    fn fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        f.count(
            "count",
            &mut self.count,
            "parts of the outside that are held",
        )?;
        f.number("width", &mut self.width_rad, "rad", "angle covered by each")?;
        let what = "polar angle of the middle of the first one";
        f.number("phase", &mut self.phase_rad, "rad", what)
    }
}

impl Record for Slots {
    fn fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        f.count("count", &mut self.count, "number of slots")?;
        f.number(
            "inner_radius",
            &mut self.inner_radius_m,
            "m",
            "inner radius",
        )?;
        f.number(
            "outer_radius",
            &mut self.outer_radius_m,
            "m",
            "outer radius",
        )?;
        f.number(
            "width",
            &mut self.width_rad,
            "rad",
            "angle covered by a slot",
        )?;
        let what = "polar angle of the first slot's centre from tooth 0";
        f.number("phase", &mut self.phase_rad, "rad", what)?;
        let what = "radius of the four corners";
        f.number("corner_radius", &mut self.corner_radius_m, "m", what)
    }
}

impl Record for Holes {
    fn fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        f.count("count", &mut self.count, "number of holes")?;
        let what = "radius of the pitch circle";
        f.number("pitch_radius", &mut self.pitch_radius_m, "m", what)?;
        f.number("radius", &mut self.radius_m, "m", "radius of a hole")?;
        let what = "polar angle of the first hole's centre from tooth 0";
        f.number("phase", &mut self.phase_rad, "rad", what)
    }
}

impl Record for MeshedBody {
    fn fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        let mut file = self.file.display().to_string();
        f.text("file", &mut file, "mesh file of the gear")?;
        self.file = file.into();
        let what = "unit of its coordinates";
        f.choice("length_unit", &mut self.length_unit, what)?;
        f.text("bore_set", &mut self.bore_set, "set of the bore")?;
        let what = "sets of the flanks, {tooth} and {side} standing for number and side";
        f.text("flank_sets", &mut self.flank_sets, what)
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
        f.flag(
            "plane_strain",
            &mut self.plane_strain,
            "cross-section only, plane strain",
        )
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
        f.number(
            "length",
            &mut self.length_m,
            "m",
            "length along the profile",
        )?;
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

impl Named for LengthUnit {
    const NAMES: &'static [(Self, &'static str)] = &[(Self::Metre, "m"), (Self::Millimetre, "mm")];
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
