//! The faces of a gear cut into its shaft, in the file of the reduced gear.

use crate::file_error::FileError;
use crate::record::Fields;
use crate::reduced_gear_axes::{FLANK_COMPONENTS, GEAR_FRAME, LOAD, MOTION};
use crate::shaft_faces::{FaceMass, ShaftFaces};

/// `sizes`: teeth, flanks and loads; gauges; natural modes.
pub(crate) fn shaft_faces_fields(
    it: &mut ShaftFaces,
    f: &mut Fields<'_>,
    (flanks, gauges, modes): ([usize; 3], usize, usize),
) -> Result<(), FileError> {
    let (face, motion) = (("motion of the front face", 6), (MOTION, 6));
    let what = "centre of the front face, which moves against the back one";
    f.in_frame(GEAR_FRAME)
        .fixed("front", &mut it.front_m, &[("axis", 3)], "m", what)?;
    let what = "force and moment on the front face per motion of it, back face held (N/rad, N*m/m and N*m/rad for rotations)";
    f.in_frame(GEAR_FRAME)
        .numbers("stiffness", &mut it.stiffness, &[face, motion], "N/m", what)?;
    let [teeth, hands, loads] = flanks;
    let axes = [
        ("tooth", teeth),
        ("flank", hands),
        (LOAD, loads),
        ("component", 3),
        face,
    ];
    let what = "displacement at the flank per motion of the front face, back face held (m per rad for rotations)";
    f.in_frame(FLANK_COMPONENTS)
        .bulk("flank", &mut it.flank, &axes, "1", what)?;
    let what = "strain of the gauges per motion of the front face (1/rad for rotations)";
    f.in_frame(GEAR_FRAME).numbers(
        "gauges",
        &mut it.gauges,
        &[("gauge", gauges), face],
        "1/m",
        what,
    )?;
    f.optional("mass", &mut it.mass, |it: &mut FaceMass, f| {
        let what =
            "consistent mass of the motions of the front face (kg*m and kg*m^2 for rotations)";
        f.in_frame(GEAR_FRAME)
            .numbers("mass", &mut it.mass, &[face, motion], "kg", what)?;
        let what = "the same between them and rigid motions about the origin";
        f.in_frame(GEAR_FRAME).numbers(
            "coupling",
            &mut it.coupling,
            &[face, motion],
            "kg",
            what,
        )?;
        let what =
            "the same between natural modes and motions of the front face (kg^1/2 m for rotations)";
        f.in_frame(GEAR_FRAME).numbers(
            "modes",
            &mut it.modes,
            &[("mode", modes), face],
            "kg^1/2",
            what,
        )
    })
}
