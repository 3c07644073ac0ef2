//! `[blank]`: the body below the teeth by its meridian.

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{InputDocument, TableKeys};
use schemars::JsonSchema;
use serde::Deserialize;

use super::MM;
use crate::bevel_gear::{BevelBlank, BevelContourPoint};
use crate::tooth::Tooth;

/// Places by which radii along the rim's ends and the contour must differ, as a share of the module.
const LEAST_STEP: f64 = 0.02;

/// The keys of `[blank]`.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct BodyTable {
    /// Bore.
    bore_diameter_mm: f64,
    /// How far the cones of toe and heel go on below the teeth's roots; the whole depth of the teeth at the heel where
    /// not given.
    rim_mm: Option<f64>,
    /// z of the hub's faces at the bore, on the toe's and the heel's side, from the pitch apex; level with the ends of
    /// the rim where not given.
    hub_z_mm: Option<[f64; 2]>,
    /// Web between rim and hub: points from the bore outwards, straight between them; none where not given.
    #[serde(default)]
    web: Vec<WebPointTable>,
}

/// One point of the web.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct WebPointTable {
    /// Diameter.
    diameter_mm: f64,
    /// z of its faces on the toe's and the heel's side, from the pitch apex.
    z_mm: [f64; 2],
}

impl BodyTable {
    pub(super) fn check(
        self,
        document: &InputDocument,
        tooth: &Tooth,
    ) -> Result<BevelBlank, InputError> {
        let keys = TableKeys::new(document, "blank");
        let blank = &tooth.blank;
        let depth = blank.outer_addendum_m + blank.outer_dedendum_m;
        let rim_m = self.rim_mm.map_or(depth, |rim| rim * MM);
        let module_m = blank.outer_diameter_m() / blank.teeth as f64;
        keys.require(
            "rim_mm",
            rim_m / MM,
            rim_m >= 0.5 * module_m,
            &format!("{:.4} and more, half an outer module", 500.0 * module_m),
        )?;
        let ends = rim_ends_m(tooth, rim_m);
        let bore_radius_m = 0.5 * self.bore_diameter_mm * MM;
        let room = ends[0][0].min(ends[1][0]);
        keys.require(
            "bore_diameter_mm",
            self.bore_diameter_mm,
            bore_radius_m > 0.0 && bore_radius_m < room - LEAST_STEP * module_m,
            &format!(
                "more than 0 and less than {:.4}, where the rim ends at the toe",
                2e3 * room
            ),
        )?;
        let mut contour = Vec::new();
        let mut least_m = bore_radius_m;
        for (k, point) in self.web.iter().enumerate() {
            let radius_m = 0.5 * point.diameter_mm * MM;
            keys.require(
                &format!("web.{k}.diameter_mm"),
                point.diameter_mm,
                radius_m > least_m + LEAST_STEP * module_m && radius_m < room,
                &format!(
                    "more than {:.4} and less than {:.4}: from the bore outwards, below the rim",
                    2e3 * least_m,
                    2e3 * room
                ),
            )?;
            keys.require(
                &format!("web.{k}.z_mm"),
                point.z_mm[1] - point.z_mm[0],
                point.z_mm[1] > point.z_mm[0],
                "[toe's side, heel's side] with the first less than the second",
            )?;
            contour.push(BevelContourPoint {
                radius_m,
                z_m: point.z_mm.map(|z| z * MM),
            });
            least_m = radius_m;
        }
        contour.reverse();
        let level = [ends[0][1], ends[1][1]];
        let hub_m = self.hub_z_mm.map_or(level, |z| z.map(|z| z * MM));
        keys.require(
            "hub_z_mm",
            (hub_m[1] - hub_m[0]) / MM,
            hub_m[1] > hub_m[0],
            "[toe's side, heel's side] with the first less than the second",
        )?;
        contour.push(BevelContourPoint {
            radius_m: bore_radius_m,
            z_m: hub_m,
        });
        Ok(BevelBlank {
            bore_radius_m,
            rim_m,
            contour,
        })
    }
}

/// Radius and z \[m\] of the rim's ends at toe and heel.
fn rim_ends_m(tooth: &Tooth, rim_m: f64) -> [[f64; 2]; 2] {
    let blank = &tooth.blank;
    [blank.inner_cone_m(), blank.outer_cone_m].map(|cone| {
        let [z, radius] = blank.meridian_m(cone, -blank.dedendum_m(cone) - rim_m);
        [radius, z]
    })
}
