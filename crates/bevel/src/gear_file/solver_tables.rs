//! `[mesh]` and `[reduction]` of a bevel gear file.

use gearmesh_geometry::gear_file::{DEFAULT_LEAST_QUALITY, LeastQuality, loaded_flanks};
use gearmesh_geometry::input::{Bounded, Count, InputDocument, TableKeys};
use gearmesh_geometry::{Element, Flank, InputError, MeshSettings, ReductionSettings, Symmetry};
use schemars::JsonSchema;
use serde::Deserialize;

use super::MM;
use crate::tooth::Tooth;

/// The keys of `[mesh]`.
#[derive(Deserialize, JsonSchema, Default)]
#[serde(deny_unknown_fields)]
pub(super) struct MeshTable {
    /// Element; "hex8-incompatible" where not given. Tetrahedra are not offered.
    element: Option<Element>,
    /// Element length along the flank; 0.3 mean modules where not given.
    flank_mm: Option<f64>,
    /// Largest element length along the root fillet; 0.08 mean modules where not given.
    fillet_mm: Option<f64>,
    /// Largest element length in the body; 1.2 mean modules where not given.
    body_mm: Option<f64>,
    /// Element length along the pitch cone, at most a slice, two of quadratic elements; where not given three quarters
    /// of that, at most a twelfth of the face.
    along_mm: Option<f64>,
    /// Smallest scaled Jacobian that is accepted; 0.2 where not given.
    min_scaled_jacobian: Option<Bounded<LeastQuality>>,
}

impl MeshTable {
    pub(super) fn check(
        self,
        document: &InputDocument,
        tooth: &Tooth,
        slices: usize,
    ) -> Result<MeshSettings, InputError> {
        let keys = TableKeys::new(document, "mesh");
        let blank = &tooth.blank;
        let module_mm =
            2.0 * blank.mean_cone_m * blank.pitch_angle_rad.sin() / blank.teeth as f64 / MM;
        let width_mm = blank.face_width_m / MM;
        let element = self.element.unwrap_or(Element::Hex8Incompatible);
        if element == Element::Tet10 {
            let problem = "bevel gears are meshed in hexahedra along the tooth; allowed is \"hex8-incompatible\", \"hex8\" or \"hex20\"";
            return Err(keys.error("element", problem));
        }
        let least_mm = 0.01 * module_mm;
        let size_m = |key: &str, value: Option<f64>, default_mm: f64, largest_mm: f64| {
            let size_mm = value.unwrap_or(default_mm);
            let allowed = format!("{least_mm:.4} to {largest_mm:.4}");
            let fits = size_mm >= least_mm && size_mm <= largest_mm;
            keys.require(key, size_mm, fits, &allowed)?;
            Ok::<f64, InputError>(size_mm * MM)
        };
        // Longer elements cannot tell the load of one slice from its neighbours': pressure beside edges comes out too
        // high.
        let per_slice = if element == Element::Hex20 { 2.0 } else { 1.0 };
        let longest_mm = (per_slice * width_mm / slices as f64).max(least_mm);
        let along_mm = (0.75 * longest_mm).min(width_mm / 12.0).max(least_mm);
        Ok(MeshSettings {
            element,
            chosen_because: None,
            flank_m: size_m("flank_mm", self.flank_mm, 0.3 * module_mm, module_mm)?,
            fillet_m: size_m(
                "fillet_mm",
                self.fillet_mm,
                0.08 * module_mm,
                0.5 * module_mm,
            )?,
            body_m: size_m("body_mm", self.body_mm, 1.2 * module_mm, 10.0 * module_mm)?,
            axial_m: size_m(
                "along_mm",
                self.along_mm,
                along_mm,
                longest_mm.min(width_mm),
            )?,
            min_scaled_jacobian: self
                .min_scaled_jacobian
                .map_or(DEFAULT_LEAST_QUALITY, f64::from),
            plane_strain: false,
        })
    }
}

/// The keys of `[reduction]`.
#[derive(Deserialize, JsonSchema, Default)]
#[serde(deny_unknown_fields)]
pub(super) struct ReductionTable {
    /// Stations of the flank grid up the profile; 9 where not given.
    profile_stations: Option<Count<3, 65>>,
    /// Slices along the face; 15 where not given.
    slices: Option<Count<1, 100>>,
    /// Flanks that carry loads; both where not given.
    flanks: Option<Vec<Flank>>,
    /// "auto" uses that the gear repeats, "off" factorises all of it for comparison; "auto" where not given.
    #[serde(default)]
    symmetry: Symmetry,
}

impl ReductionTable {
    pub(super) fn check(self, document: &InputDocument) -> Result<ReductionSettings, InputError> {
        let keys = TableKeys::new(document, "reduction");
        Ok(ReductionSettings {
            symmetry: self.symmetry,
            roll_stations: self.profile_stations.map_or(9, Count::get),
            slices: self.slices.map_or(15, Count::get),
            flanks: loaded_flanks(self.flanks, &keys)?,
            bore: None,
        })
    }
}
