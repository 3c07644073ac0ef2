//! The parts of a gear's microgeometry in a file.

use gearmesh_geometry::microgeometry::{
    EndRelief, FaceEnds, ProfileCrowning, ProfileRelief, ReliefShape, Topography, TopographyError,
};
use gearmesh_geometry::{GearMicrogeometry, Microgeometry};

use crate::file_error::FileError;
use crate::record::{Fields, Named, OPEN, Record};

impl Record for GearMicrogeometry {
    fn fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        f.group("right", |f| self.right.fields(f))?;
        f.group("left", |f| self.left.fields(f))
    }
}

impl Record for Microgeometry {
    fn fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        let what = "roll angle tan(alpha) at the form circle, where the involute begins";
        f.number("form_roll", &mut self.form_roll_rad, "rad", what)?;
        let what = "roll angle tan(alpha) at the tip circle, where profile amounts are stated";
        f.number("tip_roll", &mut self.tip_roll_rad, "rad", what)?;
        let what = "face width, over which lead amounts are stated";
        f.number("face_width", &mut self.face_width_m, "m", what)?;
        let crowning = &mut self.profile_crowning;
        f.optional("profile_crowning", crowning, ProfileCrowning::fields)?;
        f.optional("tip_relief", &mut self.tip_relief, ProfileRelief::fields)?;
        f.optional("root_relief", &mut self.root_relief, |relief, f| {
            relief_fields(relief, f, "material removed at the form circle")
        })?;
        let what = "profile slope over the involute: half removed at the tip circle, half added at the form circle";
        f.number("profile_angle", &mut self.profile_angle_m, "m", what)?;
        let what = "lead crowning: parabola over the face width, zero at mid-face, material removed at both ends";
        f.number("lead_crowning", &mut self.lead_crowning_m, "m", what)?;
        let what = "flank line slope over the face width: removed at +z, added at -z";
        f.number("flank_angle", &mut self.flank_angle_m, "m", what)?;
        f.optional("end_relief", &mut self.end_relief, EndRelief::fields)?;
        let what = "profile slope at the face towards +z less that at the one towards -z";
        f.number("twist", &mut self.twist_m, "m", what)?;
        let mut table = self.topography.as_ref().map(TopographyParts::of);
        f.optional("topography", &mut table, TopographyParts::fields)?;
        if f.is_reading() {
            let made = table.map(TopographyParts::into_table).transpose();
            self.topography = made.map_err(|e| f.contradiction("topography", &e.to_string()))?;
        }
        Ok(())
    }
}

/// A table over the flank as its arrays.
#[derive(Default)]
struct TopographyParts {
    rolls_rad: Vec<f64>,
    heights_m: Vec<f64>,
    removed_m: Vec<f64>,
}

impl TopographyParts {
    fn of(table: &Topography) -> Self {
        let [rolls_rad, heights_m, removed_m] = table.parts().map(<[f64]>::to_vec);
        Self {
            rolls_rad,
            heights_m,
            removed_m,
        }
    }

    fn into_table(self) -> Result<Topography, TopographyError> {
        Topography::new(self.rolls_rad, self.heights_m, self.removed_m)
    }
}

impl Record for TopographyParts {
    fn fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        let rolls = &mut self.rolls_rad;
        let what = "roll angles tan(alpha) of the places";
        f.numbers("roll", rolls, &[("roll", OPEN)], "rad", what)?;
        let heights = &mut self.heights_m;
        let what = "axial places from mid-face";
        f.numbers("z", heights, &[("z", OPEN)], "m", what)?;
        let axes = [("roll", rolls.len()), ("z", heights.len())];
        let what = "material removed, bilinear between the places";
        f.numbers("removed", &mut self.removed_m, &axes, "m", what)
    }
}

impl Record for ProfileCrowning {
    fn fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        let what = "material removed at the tip circle";
        f.number("amount", &mut self.amount_m, "m", what)?;
        let what = "roll angle tan(alpha) where nothing is removed";
        f.number("centre_roll", &mut self.centre_roll_rad, "rad", what)
    }
}

/// Of the tip.
impl Record for ProfileRelief {
    fn fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        relief_fields(self, f, "material removed at the tip circle")
    }
}

fn relief_fields(
    it: &mut ProfileRelief,
    f: &mut Fields<'_>,
    amount: &str,
) -> Result<(), FileError> {
    f.number("amount", &mut it.amount_m, "m", amount)?;
    let what = "roll angle tan(alpha) where it starts";
    f.number("start_roll", &mut it.start_roll_rad, "rad", what)?;
    shape_fields(&mut it.shape, f)
}

impl Record for EndRelief {
    fn fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        let what = "material removed at the face";
        f.number("amount", &mut self.amount_m, "m", what)?;
        let what = "length along the axis over which it grows";
        f.number("length", &mut self.length_m, "m", what)?;
        shape_fields(&mut self.shape, f)?;
        f.choice("ends", &mut self.ends, "faces that have it")
    }
}

/// How a relief grows, without numbers.
#[derive(Clone, Copy, PartialEq)]
enum ShapeName {
    Linear,
    Parabolic,
    Arc,
}

fn shape_fields(shape: &mut ReliefShape, f: &mut Fields<'_>) -> Result<(), FileError> {
    let (mut name, mut length) = match *shape {
        ReliefShape::Linear => (ShapeName::Linear, None),
        ReliefShape::Parabolic => (ShapeName::Parabolic, None),
        ReliefShape::Arc { length_m } => (ShapeName::Arc, Some(length_m)),
    };
    f.choice("shape", &mut name, "how it grows from its start")?;
    let what = "of an arc, the length from the start to the place of the amount";
    f.optional_number("arc_length", &mut length, "m", what)?;
    *shape = match (name, length) {
        (ShapeName::Linear, None) => ReliefShape::Linear,
        (ShapeName::Parabolic, None) => ReliefShape::Parabolic,
        (ShapeName::Arc, Some(length_m)) => ReliefShape::Arc { length_m },
        _ => return Err(f.contradiction("arc_length", "an arc has it, no other shape")),
    };
    Ok(())
}

impl Named for ShapeName {
    const NAMES: &'static [(Self, &'static str)] = &[
        (Self::Linear, "linear"),
        (Self::Parabolic, "parabolic"),
        (Self::Arc, "arc"),
    ];
}

impl Named for FaceEnds {
    const NAMES: &'static [(Self, &'static str)] = &[
        (Self::Both, "both"),
        (Self::Positive, "+z"),
        (Self::Negative, "-z"),
    ];
}
