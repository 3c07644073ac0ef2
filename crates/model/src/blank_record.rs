//! The blank of a gear's definition in a file: solid, with web and openings, ring, shaft, or a mesh from elsewhere.

use gearmesh_geometry::{
    Blank, Contour, ContourPoint, CutIntoShaft, Holes, LengthUnit, Lugs, MeshedBody, Openings, Rim,
    Slots, Web,
};

use crate::file_error::FileError;
use crate::record::{Fields, Named, OPEN, Record};

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
        if f.is_reading() {
            let openings = match (slots, holes) {
                (Some(_), Some(_)) => return Err(f.contradiction("holes", "there are slots, too")),
                (slots, holes) => slots.map(Openings::Slots).or(holes.map(Openings::Holes)),
            };
            let parts = (web, contour, openings);
            *self = blank_of(f, bore_radius_m, parts, (meshed, shaft, rim))?;
        }
        Ok(())
    }
}

/// The blank that has these parts; refuses those that exclude each other.
fn blank_of(
    f: &Fields<'_>,
    bore_radius_m: f64,
    (web, contour, openings): (Option<Web>, Option<Contour>, Option<Openings>),
    (meshed, shaft, rim): (Option<MeshedBody>, Option<CutIntoShaft>, Option<Rim>),
) -> Result<Blank, FileError> {
    if let Some(rim) = rim {
        if shaft.is_some() || meshed.is_some() || web.is_some() || openings.is_some() {
            let what = "there is a shaft, a web, openings or a mesh from elsewhere, too";
            return Err(f.contradiction("rim", what));
        }
        return Ok(Blank::Ring(rim));
    }
    if let Some(shaft) = shaft {
        if meshed.is_some() || web.is_some() || contour.is_some() || openings.is_some() {
            let what = "there is a web, a contour, openings or a mesh from elsewhere, too";
            return Err(f.contradiction("shaft", what));
        }
        if bore_radius_m != 0.0 {
            return Err(f.contradiction("shaft", "there is a bore, too"));
        }
        return Ok(Blank::CutIntoShaft(shaft));
    }
    match (meshed, web, contour) {
        (Some(body), None, None) if openings.is_none() => Ok(Blank::Meshed {
            bore_radius_m,
            body,
        }),
        (Some(_), ..) => {
            let what = "there is a web, a contour or openings, too";
            Err(f.contradiction("meshed", what))
        }
        (None, Some(web), contour) => Ok(Blank::Webbed {
            bore_radius_m,
            web,
            contour,
            openings,
        }),
        (None, None, None) => Ok(Blank::Solid {
            bore_radius_m,
            openings,
        }),
        (None, None, Some(_)) => Err(f.contradiction("contour", "there is no web")),
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
        let what = "parts of the outside that are held";
        f.count("count", &mut self.count, what)?;
        f.number("width", &mut self.width_rad, "rad", "angle covered by each")?;
        let what = "polar angle of the middle of the first one";
        f.number("phase", &mut self.phase_rad, "rad", what)
    }
}

impl Record for Slots {
    fn fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        f.count("count", &mut self.count, "number of slots")?;
        let what = "inner radius";
        f.number("inner_radius", &mut self.inner_radius_m, "m", what)?;
        let what = "outer radius";
        f.number("outer_radius", &mut self.outer_radius_m, "m", what)?;
        let what = "angle covered by a slot";
        f.number("width", &mut self.width_rad, "rad", what)?;
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

impl Named for LengthUnit {
    const NAMES: &'static [(Self, &'static str)] = &[(Self::Metre, "m"), (Self::Millimetre, "mm")];
}
