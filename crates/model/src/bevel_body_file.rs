//! The group of a bevel body in the file of a reduced gear, and its checks.

use crate::bevel_body::{BevelBody, BevelNearField};
use crate::file_error::FileError;
use crate::near_field::calibration_fields;
use crate::quantity_check::{
    check_array, check_calibration, check_stations, in_range, out_of_range, positive, smallest,
};
use crate::record::{Fields, OPEN};
use crate::reduced_gear::ReducedGear;
use crate::reduced_gear_axes::Sizes;
use crate::reduced_gear_error::ReducedGearError;

const BEVEL_FRAME: &str = "bevel gear: right-handed, origin in the pitch apex, z the axis towards the heel, middle of tooth 0 on +x at the mean point";
const NORMAL: &str = "inward normal of the flank in the section, positive into the material";

pub(crate) fn bevel_fields(
    it: &mut BevelBody,
    f: &mut Fields<'_>,
    sizes: Sizes,
) -> Result<(), FileError> {
    let what = "the pair file, word for word";
    f.text("pair_toml", &mut it.pair_text, what)?;
    f.choice("member", &mut it.member, "member of the pair")?;
    f.choice("hand", &mut it.hand, "hand of spiral")?;
    let angle = &mut it.pitch_angle_rad;
    f.number("pitch_angle", angle, "rad", "pitch angle")?;
    let (cones, what) = (&mut it.cones_m, "cone distances of toe and heel");
    f.fixed("cones", cones, &[("toe, heel", 2)], "m", what)?;
    let axes = [
        ("flank", sizes.hands),
        ("u station", sizes.stations),
        ("v station", sizes.along),
        ("axis", 3),
    ];
    let what = "flanks of tooth 0 at the stations";
    f.in_frame(BEVEL_FRAME)
        .numbers("points", &mut it.points_m, &axes, "m", what)?;
    let what = "unit normals there, into the material";
    f.in_frame(BEVEL_FRAME)
        .numbers("normals", &mut it.normals, &axes, "1", what)?;
    let what = "area of the flank there per unit of the shares along and up the flank";
    f.numbers("areas", &mut it.areas_m2, &axes[..3], "m^2", what)?;
    f.optional("near_field", &mut it.near_field, |it, f| {
        near_field_fields(it, f, sizes)
    })
}

fn near_field_fields(
    it: &mut BevelNearField,
    f: &mut Fields<'_>,
    sizes: Sizes,
) -> Result<(), FileError> {
    let lengths_m = [&mut it.half_width_m, &mut it.element_m];
    calibration_fields(f, lengths_m, &mut it.residual)?;
    let (sections, what) = (
        &mut it.sections_m,
        "places of the sections along the tooth, from mid-face",
    );
    f.numbers("sections", sections, &[("section", OPEN)], "m", what)?;
    let (profile, what) = (
        &mut it.profile,
        "share of the way up the flank of the places",
    );
    f.numbers("profile", profile, &[("place", OPEN)], "1", what)?;
    let flanks = ("flank", sizes.hands);
    let in_section = ("section", it.sections_m.len());
    let places = [flanks, in_section, ("place", it.profile.len())];
    let what = "length of the profile from the lower line to the tip";
    let lengths = &mut it.profile_length_m;
    f.numbers("profile_length", lengths, &places[..2], "m", what)?;
    let what = "deflection of the contact centre per line load, tooth-only submodel, plane strain, fine mesh";
    f.in_frame(NORMAL)
        .numbers("contact", &mut it.contact_m2_per_n, &places, "m^2/N", what)?;
    let stations = [
        flanks,
        in_section,
        ("load: u station", sizes.stations),
        ("response: u station", sizes.stations),
    ];
    let what = "the same per line load of a hat, the gear's own mesh and hats";
    f.in_frame(NORMAL)
        .numbers("mesh", &mut it.mesh_m2_per_n, &stations, "m^2/N", what)?;
    let what = "distance along the normal to the opposite side of the tooth";
    let distances = &mut it.opposite_distance_m;
    f.in_frame(NORMAL)
        .numbers("opposite_distance", distances, &stations[..3], "m", what)
}

impl ReducedGear {
    /// Lengths, ranges and numbers of the bevel body, where there is one.
    pub(crate) fn check_bevel(&self) -> Result<(), ReducedGearError> {
        let Some(bevel) = &self.bevel else {
            return Ok(());
        };
        let (flanks, stations) = (self.flanks.len(), self.grid.roll_angles_rad.len());
        let all = flanks * self.grid.len();
        let acute = |angle: f64| angle > 0.0 && angle < std::f64::consts::FRAC_PI_2;
        let angle = bevel.pitch_angle_rad;
        in_range("bevel.pitch_angle_rad", angle, acute, "between 0 and π/2")?;
        check_stations("bevel.cones_m", &bevel.cones_m)?;
        let (item, first) = ("the first of bevel.cones_m", bevel.cones_m[0]);
        in_range(item, first, positive, "above 0 m")?;
        let last = self.grid.roll_angles_rad[stations - 1];
        in_range(
            "the last of the stations up a bevel flank",
            last,
            |u| u <= 1.0,
            "at most 1",
        )?;
        let formula = "flanks * u stations * v stations * 3";
        check_array("bevel.points_m", &bevel.points_m, 3 * all, formula)?;
        check_array("bevel.normals", &bevel.normals, 3 * all, formula)?;
        let formula = "flanks * u stations * v stations";
        check_array("bevel.areas_m2", &bevel.areas_m2, all, formula)?;
        let least = smallest(&bevel.areas_m2);
        in_range(
            "the smallest of bevel.areas_m2",
            least,
            positive,
            "above 0 m^2",
        )?;
        if self.near_field.is_some() || self.crack.is_some() {
            return Err(out_of_range(
                "near_field and crack of a bevel gear",
                "one of a cylindrical gear",
                "none: a bevel gear's near field is bevel.near_field",
            ));
        }
        bevel
            .near_field
            .as_ref()
            .map_or(Ok(()), |field| check_near_field(field, flanks, stations))
    }
}

fn check_near_field(
    field: &BevelNearField,
    flanks: usize,
    stations: usize,
) -> Result<(), ReducedGearError> {
    let (half_width_m, element_m) = (field.half_width_m, field.element_m);
    check_calibration(
        "bevel.near_field",
        [half_width_m, element_m, field.residual],
    )?;
    check_stations("bevel.near_field.profile", &field.profile)?;
    let last = field.profile[field.profile.len() - 1];
    let item = "the last of bevel.near_field.profile";
    in_range(item, last, |u| u <= 1.0, "at most 1")?;
    let sections = field.sections_m.len();
    match sections {
        0 => {
            return Err(out_of_range(
                "bevel.near_field.sections_m",
                0,
                "at least one",
            ));
        }
        1 => check_array("bevel.near_field.sections_m", &field.sections_m, 1, "one")?,
        _ => check_stations("bevel.near_field.sections_m", &field.sections_m)?,
    }
    let all = flanks * sections;
    let (count, formula) = (all * field.profile.len(), "flanks * sections * places");
    let (item, values) = ("bevel.near_field.contact_m2_per_n", &field.contact_m2_per_n);
    check_array(item, values, count, formula)?;
    let (item, lengths) = ("bevel.near_field.profile_length_m", &field.profile_length_m);
    check_array(item, lengths, all, "flanks * sections")?;
    in_range(item, smallest(lengths), positive, "above 0 m")?;
    check_array(
        "bevel.near_field.mesh_m2_per_n",
        &field.mesh_m2_per_n,
        all * stations * stations,
        "flanks * sections * u stations * u stations",
    )?;
    let distances = &field.opposite_distance_m;
    let item = "bevel.near_field.opposite_distance_m";
    check_array(
        item,
        distances,
        all * stations,
        "flanks * sections * u stations",
    )?;
    in_range(item, smallest(distances), positive, "above 0 m")
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::made_up_models::small_bevel_gear;

    #[test]
    fn every_wrong_figure_of_a_bevel_body_is_found() {
        let gear = small_bevel_gear();
        gear.validate().unwrap();
        type Change = fn(&mut BevelBody);
        fn field(bevel: &mut BevelBody) -> &mut BevelNearField {
            bevel.near_field.as_mut().unwrap()
        }
        let spoil: [(&str, Change); 14] = [
            ("pitch_angle_rad", |b| b.pitch_angle_rad = 2.0),
            ("cones_m", |b| b.cones_m = [0.05, 0.04]),
            ("points_m", |b| b.points_m.truncate(4)),
            ("normals", |b| b.normals[3] = f64::NAN),
            ("areas_m2", |b| b.areas_m2[0] = 0.0),
            ("half_width_m", |b| field(b).half_width_m = 0.0),
            ("element_m", |b| field(b).element_m = f64::NAN),
            ("residual", |b| field(b).residual = -1.0),
            ("profile", |b| field(b).profile[1] = 0.0),
            ("sections_m", |b| field(b).sections_m.clear()),
            ("profile_length_m", |b| field(b).profile_length_m[0] = 0.0),
            ("contact_m2_per_n", |b| {
                field(b).contact_m2_per_n.truncate(2)
            }),
            ("mesh_m2_per_n", |b| {
                field(b).mesh_m2_per_n[0] = f64::INFINITY
            }),
            ("opposite_distance_m", |b| {
                field(b).opposite_distance_m[1] = 0.0
            }),
        ];
        for (item, change) in spoil {
            let mut wrong = gear.clone();
            change(wrong.bevel.as_mut().unwrap());
            let message = wrong.validate().unwrap_err().to_string();
            assert!(message.contains(item), "{item}: {message}");
        }
        let mut wrong = gear;
        wrong.near_field = crate::made_up_models::small_reduced_gear().near_field;
        assert!(wrong.validate().is_err());
    }
}
