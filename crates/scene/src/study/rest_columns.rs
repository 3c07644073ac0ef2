//! The columns of bevel pairs and of bearings that are studied by themselves: a number each.

use gearmesh_bearings::{BearingError, Life, QuasiStaticBearing, Ratings, StaticSafety};
use gearmesh_bevel::{BevelError, sensitivity};
use gearmesh_contact::mesh_stiffness::mesh_harmonics;
use gearmesh_geometry::InputError;

use super::subject::BearingSubject;
use crate::pair::BevelScene;

/// Harmonics of the mesh that are listed.
const HARMONICS: usize = 3;

/// Names of the columns of a bevel pair, in the order of [`of_bevel`].
#[must_use]
pub(super) fn bevel_names() -> Vec<String> {
    let mut names = vec!["te_peak_to_peak_urad".to_owned()];
    names.extend((1..=HARMONICS).map(|k| format!("te_harmonic_{k}_urad")));
    names.extend(
        [
            "contact_ratio",
            "edge_share",
            "backlash_least_mm",
            "ellipse_half_length_largest_mm",
            "ease_off_largest_um",
        ]
        .map(str::to_owned),
    );
    for cause in [
        "offset_mm_per_mm",
        "pinion_axial_mm_per_mm",
        "gear_axial_mm_per_mm",
        "shaft_angle_mm_per_mrad",
    ] {
        names.extend(["along", "up"].map(|way| format!("contact_moves_{way}_by_{cause}")));
    }
    names
}

/// The text of a case is not the user's.
fn without_line(error: InputError) -> InputError {
    InputError {
        line: None,
        ..error
    }
}

/// All columns of a bevel pair.
///
/// # Errors
/// [`InputError`] where the flanks cannot be made or do not touch, or teeth jam in the assembly.
pub(super) fn of_bevel(subject: &BevelScene) -> Result<Vec<f64>, InputError> {
    let BevelScene { file, document, .. } = subject;
    let flanks = (subject.design().map_err(without_line)?).flanks(file.pinion_flank);
    let fault = |error: BevelError| without_line(error.in_file(document));
    let pair = subject.assembled().map_err(without_line)?;
    let found = pair.path().map_err(fault)?;
    // Where only edges touch, no contact moves with the errors.
    let moved = (found.mean.as_ref())
        .and_then(|mean| sensitivity(flanks, &file.blank, (&file.tca.error, mean)).ok());
    let lines = mesh_harmonics(&found.error_rad, 1, HARMONICS).1;
    let ellipses = found.path.iter().filter(|p| p.leading);
    let lengths = ellipses.filter_map(|p| Some(p.ellipse?.half_lengths_m(file.tca.marking_m)[0]));
    let ease_off = (found.ease_off.iter()).filter_map(|(_, found)| Some(found.as_ref()?.gap_m));
    let mut values = vec![1e6 * found.peak_to_peak_rad];
    values.extend((0..HARMONICS).map(|k| 1e6 * lines.get(k).map_or(0.0, |line| line.0)));
    values.extend([
        found.contact_ratio,
        found.edge_share,
        1e3 * pair.backlash_m.unwrap_or(f64::NAN),
        1e3 * lengths.fold(0.0, f64::max),
        1e6 * ease_off.fold(0.0, f64::max),
    ]);
    let moves = moved.map_or([[f64::NAN; 2]; 4], |m| {
        [m.offset, m.pinion_axial, m.gear_axial, m.shaft_angle]
    });
    values.extend(moves.into_iter().flatten());
    Ok(values)
}

/// Names of the columns of a bearing, in the order of [`of_bearing`].
#[must_use]
pub(super) fn bearing_names(subject: &BearingSubject) -> Vec<String> {
    let mut names: Vec<String> = [
        "displacement_x_um",
        "displacement_y_um",
        "displacement_z_um",
        "tilt_x_mrad",
        "tilt_y_mrad",
        "moment_x_Nm",
        "moment_y_Nm",
        "stiffness_x_N_per_um",
        "stiffness_y_N_per_um",
        "stiffness_z_N_per_um",
        "stiffness_tilt_x_Nm_per_rad",
        "stiffness_tilt_y_Nm_per_rad",
        "load_inner_largest_N",
        "load_outer_largest_N",
        "loaded_elements",
        "pressure_inner_largest_MPa",
        "pressure_outer_largest_MPa",
        "rating_dynamic_N",
        "rating_static_N",
        "static_safety",
        "life_L10_Mrev",
        "equivalent_load_N",
        "life_L10r_Mrev",
        "reference_equivalent_load_N",
    ]
    .map(str::to_owned)
    .into();
    if subject.operation.lubrication.is_some() {
        names.push("life_L10mr_Mrev".to_owned());
    }
    names
}

/// All columns of a bearing.
///
/// # Errors
/// [`BearingError`] where there is no equilibrium.
pub(super) fn of_bearing(subject: &BearingSubject) -> Result<Vec<f64>, BearingError> {
    let definition = &subject.found.definition;
    let bearing = QuasiStaticBearing::new(definition)?;
    bearing.refuse_spalled_balls()?;
    let operation = &subject.operation;
    let (pose, mut places) =
        bearing.equilibrium_with_places(&operation.load, &operation.operation)?;
    let (ring, loads) = bearing.loads_from(&pose, &operation.operation, &mut places)?;
    let ratings = Ratings::of(definition);
    let lubrication = operation.lubrication.as_ref();
    let force = operation.load.force_n;
    let life = Life::of(definition, &loads, force, &operation.operation, lubrication);
    let q = pose.to_five();
    let stiffness = |k: usize| -ring.tangent[(k, k)];
    // Largest inner and outer load, loaded elements, largest inner and outer pressure.
    let mut most = [0.0_f64; 4];
    let mut loaded = 0.0;
    for (row, elements) in loads.elements.iter().enumerate() {
        for element in elements {
            let [inner, outer] = bearing.rows[row].peak_pressures_pa(element);
            let own = [element.inner_load_n, element.outer_load_n, inner, outer];
            most.iter_mut().zip(own).for_each(|(m, x)| *m = m.max(x));
            loaded += if element.inner_load_n > 0.0 { 1.0 } else { 0.0 };
        }
    }
    let mut values = vec![1e6 * q[0], 1e6 * q[1], 1e6 * q[2], 1e3 * q[3], 1e3 * q[4]];
    values.extend([-ring.load[3], -ring.load[4]]);
    values.extend([0, 1, 2].map(|k| 1e-6 * stiffness(k)));
    values.extend([3, 4].map(stiffness));
    values.extend([most[0], most[1], loaded, 1e-6 * most[2], 1e-6 * most[3]]);
    // Not a number where ISO 76 or ISO 281 give no factors for the bearing.
    let safety = StaticSafety::of(definition, &ratings, force).map(|safety| safety.factor);
    let of_standards = [safety, life.basic_mrev, life.equivalent_n];
    values.extend([ratings.dynamic_n, ratings.static_n]);
    values.extend(of_standards.map(|value| value.unwrap_or(f64::NAN)));
    values.extend([life.reference_mrev, life.reference_equivalent_n]);
    values.extend(life.modified_mrev.filter(|_| lubrication.is_some()));
    Ok(values)
}
