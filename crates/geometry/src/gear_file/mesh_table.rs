//! `[mesh]`: element sizes, by default in proportion to the module.

use super::{MM, TableKeys};
use crate::blank::Blank;
use crate::body_outline::beyond_layers;
use crate::definition::{MeshSettings, ToothDefinition};
use crate::given;
use crate::input::{Bounded, End, InputDocument, InputError};
use crate::number_range;
use gearmesh_elements::Element;
use schemars::JsonSchema;
use serde::Deserialize;

/// The keys of `[mesh]`.
#[derive(Deserialize, JsonSchema, Default)]
#[serde(deny_unknown_fields)]
pub(super) struct MeshTable {
    /// Element; "hex8-incompatible" where not given, "tet10" for contours that need tetrahedra.
    element: Option<Element>,
    /// Element length along the flank; 0.3 modules where not given, twice that in tetrahedra.
    flank_mm: Option<f64>,
    /// Element length along the root fillet, which decides the error of root strain; where not given 0.05 modules (0.5
    /// % of the strain), of quadratic bricks 0.08, of tetrahedra 0.16.
    fillet_mm: Option<f64>,
    /// Largest element length in the body; 1.2 modules where not given, twice that in tetrahedra.
    body_mm: Option<f64>,
    /// Element length along the axis; a tenth of the face where not given, a fifth in tetrahedra.
    axial_mm: Option<f64>,
    /// Smallest scaled Jacobian that is accepted; 0.2 where not given.
    min_scaled_jacobian: Option<Bounded<LeastQuality>>,
    /// The cross-section only, one layer that does not move along the axis; false where not given.
    #[serde(default)]
    plane_strain: bool,
}

number_range!(
    /// Scaled Jacobians that can be asked for: no element of a tooth is a cube.
    pub LeastQuality: End::Beyond(0.0), End::At(0.9)
);

/// Smallest scaled Jacobian where a file asks for none.
pub const DEFAULT_LEAST_QUALITY: f64 = 0.2;

impl MeshTable {
    /// The mesh settings, in SI units.
    pub(super) fn check(
        self,
        document: &InputDocument,
        tooth: &ToothDefinition,
        blank: &Blank,
    ) -> Result<MeshSettings, InputError> {
        let keys = TableKeys::new(document, "mesh");
        let module_mm = tooth.module_m / MM;
        let width_mm = tooth.face_width_m / MM;
        let least_mm = 0.01 * module_mm;
        let size_m = |key: &str, value: Option<f64>, default_mm: f64, largest_mm: f64| {
            let size_mm = value.unwrap_or(default_mm);
            keys.require(
                key,
                size_mm,
                size_mm >= least_mm && size_mm <= largest_mm,
                &format!("{least_mm:.4} to {largest_mm:.4}"),
            )?;
            Ok::<f64, InputError>(size_mm * MM)
        };
        if blank.meshed().is_some() {
            let problem = "blank.kind = \"mesh\" has its elements in the mesh file and does not use it; remove it";
            let sizes = given!(self; flank_mm, fillet_mm, body_mm, axial_mm, min_scaled_jacobian);
            keys.refuse(&sizes, problem)?;
            keys.refuse(&[("plane_strain", self.plane_strain)], problem)?;
        }
        if self.plane_strain && self.axial_mm.is_some() {
            return Err(keys.error(
                "axial_mm",
                "plane strain has one layer and does not use it; remove it or set plane_strain = false",
            ));
        }
        if self.plane_strain && tooth.helix_angle_rad != 0.0 {
            return Err(keys.error(
                "plane_strain",
                "plane strain knows straight teeth only; set tooth.helix_angle_deg = 0 or plane_strain = false",
            ));
        }
        if blank.cut_into_shaft().is_some() {
            if self.plane_strain {
                let problem = "a gear cut into its shaft is held at its end faces, of which plane strain has none; set plane_strain = false";
                return Err(keys.error("plane_strain", problem));
            }
            if self.element == Some(Element::Tet10) {
                let problem =
                    "a gear cut into its shaft is meshed in hexahedra; choose one of them";
                return Err(keys.error("element", problem));
            }
        }
        if blank.rim().is_some() && self.element == Some(Element::Tet10) {
            let problem = "a ring is meshed in hexahedra; choose one of them";
            return Err(keys.error("element", problem));
        }
        if self.plane_strain && blank.rim().is_some_and(|rim| rim.held_z_m.is_some()) {
            let problem = "plane strain knows no band of the outside; remove blank.held_band_mm or set plane_strain = false";
            return Err(keys.error("plane_strain", problem));
        }
        if self.plane_strain && blank.web().is_some() {
            return Err(keys.error(
                "plane_strain",
                "plane strain knows the cross-section only, a web thinner than the face has no place in it; set blank.kind = \"solid\" or plane_strain = false",
            ));
        }
        let (element, chosen_because) = self.check_element(&keys, tooth, blank)?;
        let [flank_mm, fillet_mm, body_mm, axial_mm] =
            MeshSettings::default_lengths(element, module_mm, width_mm);
        Ok(MeshSettings {
            element,
            chosen_because,
            flank_m: size_m("flank_mm", self.flank_mm, flank_mm, module_mm)?,
            fillet_m: size_m("fillet_mm", self.fillet_mm, fillet_mm, 0.5 * module_mm)?,
            body_m: size_m("body_mm", self.body_mm, body_mm, 10.0 * module_mm)?,
            axial_m: size_m("axial_mm", self.axial_mm, axial_mm, width_mm)?,
            min_scaled_jacobian: self
                .min_scaled_jacobian
                .map_or(DEFAULT_LEAST_QUALITY, f64::from),
            plane_strain: self.plane_strain,
        })
    }

    /// The element, and why it is a tetrahedron where that was left open.
    fn check_element(
        &self,
        keys: &TableKeys,
        tooth: &ToothDefinition,
        blank: &Blank,
    ) -> Result<(Element, Option<&'static str>), InputError> {
        let openings_m = blank.openings().map(|openings| openings.radii_m());
        let beyond = blank
            .contour()
            .and_then(|contour| beyond_layers(contour, openings_m, tooth.face_width_m));
        match (self.element, beyond) {
            (Some(Element::Tet10), _) if self.plane_strain => Err(keys.error(
                "plane_strain",
                "the cross-section is meshed in quadrilaterals; set mesh.element to one of hexahedra or plane_strain = false",
            )),
            (Some(Element::Tet10), _) => Ok((Element::Tet10, None)),
            (None, Some(_)) => Ok((Element::Tet10, beyond)),
            (Some(_), Some(reason)) => Err(keys.error(
                "element",
                format!(
                    "{reason}, which moved layers of hexahedra cannot follow; remove the key or set it to \"tet10\""
                ),
            )),
            (element, None) => Ok((element.unwrap_or(Element::Hex8Incompatible), None)),
        }
    }
}
