//! `[pinion]` and `[gear]`: how a member is cut.

use std::path::{Path, PathBuf};

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{Bounded, InputDocument, Positive, TableKeys, Within};
use schemars::JsonSchema;
use serde::Deserialize;

use super::assembly_table::{DEFAULT_MARKING_UM, MarkingThickness};
use super::given_check;
use super::settings_table::SettingsTable;
use crate::basic_settings::Process;
use crate::blank::{MemberBlank, PairBlank, ToothForm};
use crate::cut_thickness::ThicknessFrom;
use crate::grid_surface::GridSurface;
use crate::hand::FlankSide;
use crate::local_synthesis::Synthesis;
use crate::pair_design::Cutting;
use crate::settings_search::AskedEaseOff;

/// Material left away on the concave and the convex flank.
type Amounts = [Bounded<Within<-1000, 1000>>; 2];

/// How a member is cut. Lists of two: concave, convex flank.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct MemberTable {
    /// Where the settings come from.
    settings: SettingsWord,
    /// Radius of the blade's edge; "given": stated with each flank.
    edge_radius_mm: Option<Bounded<Within<0, 1000>>>,
    /// Width of the blade's point, to check that it fits into the slot.
    point_width_mm: Option<Bounded<Within<0, 1000>>>,
    /// Least thickness of the top land; 0 where not given.
    least_top_land_mm: Option<Bounded<Within<0, 1000>>>,
    /// "local-synthesis": mean contact point on the gear along the tooth, from the middle of the face towards the
    /// heel; 0 where not given.
    mean_point_along_mm: Option<[f64; 2]>,
    /// "local-synthesis": its height above the gear's pitch cone; 0 where not given.
    mean_point_height_mm: Option<[f64; 2]>,
    /// "local-synthesis": direction of the path on the gear's flank, from along the tooth towards the heel to up the
    /// profile.
    path_angle_deg: Option<[Bounded<Within<1, 179>>; 2]>,
    /// "local-synthesis": half length of the contact ellipse.
    ellipse_half_length_mm: Option<[Bounded<Positive>; 2]>,
    /// "local-synthesis": marking thickness of that ellipse; 6.35 where not given.
    marking_um: Option<Bounded<MarkingThickness>>,
    /// "local-synthesis": second derivative of the gear's lead by the pinion's turn; negative where the gear stays
    /// behind.
    transmission_curvature: Option<[Bounded<Within<-1, 1>>; 2]>,
    /// "ease-off": material left away at toe and heel.
    lengthwise_um: Option<Amounts>,
    /// "ease-off": at the tip and the lower end of the working depth.
    profile_um: Option<Amounts>,
    /// "ease-off": twist, at the tip of the heel; its negative at the tip of the toe. 0 where not given.
    bias_um: Option<Amounts>,
    /// "points": table of the concave flank's points, beside this file or with its folder: columns sector, height, x_mm, y_mm,
    /// z_mm, nx, ny, nz (all three of these may be missing: the points make the normals); with deviation_um the points are nominal and
    /// the flank is off them by so much added material.
    concave_points: Option<String>,
    /// "points": table of the convex flank's points.
    convex_points: Option<String>,
    /// "points": place of the tables' origin on the member's axis, from the pitch apex towards the heel; 0 where not given.
    points_origin_mm: Option<Bounded<Within<-10_000, 10_000>>>,
    /// "given": settings of the concave flank.
    concave: Option<SettingsTable>,
    /// "given": settings of the convex flank.
    convex: Option<SettingsTable>,
    /// "given": which tooth thickness counts. Where not given that of the settings where they are the same for both
    /// flanks but for the blades (one operation), else that of the blank.
    thickness: Option<ThicknessFrom>,
}

/// `settings`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
enum SettingsWord {
    /// By the pair's crown gear: conjugate where both members are cut so.
    Crown,
    /// Generated, both flanks by one face mill.
    Basic,
    /// Not generated: the work is held.
    Formate,
    /// Pinion: each flank by local synthesis.
    LocalSynthesis,
    /// Pinion: each flank fitted to an ease-off.
    EaseOff,
    /// As stated in `concave` and `convex`.
    Given,
    /// No settings: flanks through measured or published points.
    Points,
}

impl SettingsWord {
    fn word(self) -> &'static str {
        match self {
            Self::Crown => "crown",
            Self::Basic => "basic",
            Self::Formate => "formate",
            Self::LocalSynthesis => "local-synthesis",
            Self::EaseOff => "ease-off",
            Self::Given => "given",
            Self::Points => "points",
        }
    }
}

/// A member's part of a pair file.
#[derive(Debug, Clone, PartialEq)]
pub struct MemberRequest {
    /// How it is cut.
    pub cutting: Cutting,
    /// Radius of the blade's edge \[m\].
    pub edge_radius_m: f64,
    /// Width of the blade's point to check, 0 for none \[m\].
    pub point_width_m: f64,
    /// Least top land \[m\].
    pub least_top_land_m: f64,
}

impl MemberTable {
    pub(super) fn request(
        &self,
        document: &InputDocument,
        name: &str,
        blank: &PairBlank,
    ) -> Result<MemberRequest, InputError> {
        let keys = TableKeys::new(document, name);
        self.refuse_unused(&keys)?;
        let word = self.settings;
        let pinion = name == "pinion";
        let straight = blank.data.form == ToothForm::Straight;
        if matches!(word, SettingsWord::LocalSynthesis | SettingsWord::EaseOff) && !pinion {
            return Err(keys.error("settings", format!("found \"{}\", which is for the pinion; allowed is \"crown\", \"basic\", \"formate\", \"given\" or \"points\"", word.word())));
        }
        let any_form = [
            SettingsWord::Crown,
            SettingsWord::Basic,
            SettingsWord::Points,
        ];
        if straight && !any_form.contains(&word) {
            return Err(keys.error(
                "settings",
                format!(
                    "found \"{}\", allowed for straight teeth is \"crown\", \"basic\" or \"points\"",
                    word.word()
                ),
            ));
        }
        if word == SettingsWord::Formate && pinion {
            return Err(keys.error(
                "settings",
                "found \"formate\", which is for the gear: a pinion must be generated",
            ));
        }
        let metres = |value: Option<Bounded<Within<0, 1000>>>| 1e-3 * value.map_or(0.0, f64::from);
        if straight && self.edge_radius_mm.is_some() {
            return Err(keys.error(
                "edge_radius_mm",
                "is not used by straight teeth: their tool has no edge radius; remove it",
            ));
        }
        Ok(MemberRequest {
            cutting: self.cutting(document, &keys, name, blank)?,
            edge_radius_m: metres(self.edge_radius_mm),
            point_width_m: metres(self.point_width_mm),
            least_top_land_m: metres(self.least_top_land_mm),
        })
    }

    fn refuse_unused(&self, keys: &TableKeys<'_>) -> Result<(), InputError> {
        const SYNTHESIS: &[&str] = &["local-synthesis"];
        const EASE_OFF: &[&str] = &["ease-off"];
        const GIVEN: &[&str] = &["given"];
        const POINTS: &[&str] = &["points"];
        const CUT: &[&str] = &[
            "crown",
            "basic",
            "formate",
            "local-synthesis",
            "ease-off",
            "given",
        ];
        const DERIVED: &[&str] = &["crown", "basic", "formate", "local-synthesis", "ease-off"];
        keys.refuse_unused(
            ("settings", self.settings.word()),
            &[
                ("edge_radius_mm", self.edge_radius_mm.is_some(), DERIVED),
                (
                    "mean_point_along_mm",
                    self.mean_point_along_mm.is_some(),
                    SYNTHESIS,
                ),
                (
                    "mean_point_height_mm",
                    self.mean_point_height_mm.is_some(),
                    SYNTHESIS,
                ),
                ("path_angle_deg", self.path_angle_deg.is_some(), SYNTHESIS),
                (
                    "ellipse_half_length_mm",
                    self.ellipse_half_length_mm.is_some(),
                    SYNTHESIS,
                ),
                ("marking_um", self.marking_um.is_some(), SYNTHESIS),
                (
                    "transmission_curvature",
                    self.transmission_curvature.is_some(),
                    SYNTHESIS,
                ),
                ("lengthwise_um", self.lengthwise_um.is_some(), EASE_OFF),
                ("profile_um", self.profile_um.is_some(), EASE_OFF),
                ("bias_um", self.bias_um.is_some(), EASE_OFF),
                ("point_width_mm", self.point_width_mm.is_some(), CUT),
                ("concave_points", self.concave_points.is_some(), POINTS),
                ("convex_points", self.convex_points.is_some(), POINTS),
                ("points_origin_mm", self.points_origin_mm.is_some(), POINTS),
                ("concave", self.concave.is_some(), GIVEN),
                ("convex", self.convex.is_some(), GIVEN),
                ("thickness", self.thickness.is_some(), GIVEN),
            ],
        )
    }

    fn cutting(
        &self,
        document: &InputDocument,
        keys: &TableKeys<'_>,
        name: &str,
        blank: &PairBlank,
    ) -> Result<Cutting, InputError> {
        Ok(match self.settings {
            SettingsWord::Crown => Cutting::Crown,
            SettingsWord::Basic => Cutting::Basic(Process::Generated),
            SettingsWord::Formate => Cutting::Basic(Process::Formate),
            SettingsWord::LocalSynthesis => Cutting::Synthesis(self.synthesis(keys, blank)?),
            SettingsWord::EaseOff => {
                let by = "settings = \"ease-off\"";
                let lengthwise = keys.needed("lengthwise_um", self.lengthwise_um, by)?;
                let profile = keys.needed("profile_um", self.profile_um, by)?;
                Cutting::EaseOff([0, 1].map(|i| AskedEaseOff {
                    lengthwise_m: 1e-6 * *lengthwise[i],
                    profile_m: 1e-6 * *profile[i],
                    bias_m: 1e-6 * self.bias_um.map_or(0.0, |bias| *bias[i]),
                }))
            }
            SettingsWord::Points => {
                let member = &blank.members[usize::from(name == "gear")];
                Cutting::Points(Box::new(self.points(document, keys, member)?))
            }
            SettingsWord::Given => {
                let by = "settings = \"given\"";
                let concave = keys.needed("concave", self.concave.as_ref(), by)?;
                let convex = keys.needed("convex", self.convex.as_ref(), by)?;
                let settings = [
                    concave.settings(document, &format!("{name}.concave"))?,
                    convex.settings(document, &format!("{name}.convex"))?,
                ];
                given_check::check(keys, &settings, blank, (name, self.thickness))?;
                Cutting::Given(settings, self.thickness)
            }
        })
    }

    /// Flanks through points.
    fn points(
        &self,
        document: &InputDocument,
        keys: &TableKeys<'_>,
        member: &MemberBlank,
    ) -> Result<[GridSurface; 2], InputError> {
        let by = "settings = \"points\"";
        let origin = self.points_origin_mm.map_or(0.0, f64::from);
        let folder = Path::new(&document.file).parent();
        let read = |key: &str, name: &Option<String>, side: FlankSide| {
            let name = keys.needed(key, name.as_ref(), by)?;
            let path = folder.map_or_else(|| PathBuf::from(name), |folder| folder.join(name));
            GridSurface::read(&path, 1e-3 * origin, member, side)
        };
        Ok([
            read("concave_points", &self.concave_points, FlankSide::Concave)?,
            read("convex_points", &self.convex_points, FlankSide::Convex)?,
        ])
    }

    fn synthesis(
        &self,
        keys: &TableKeys<'_>,
        blank: &PairBlank,
    ) -> Result<[Synthesis; 2], InputError> {
        let by = "settings = \"local-synthesis\"";
        let angle = keys.needed("path_angle_deg", self.path_angle_deg, by)?;
        let ellipse = keys.needed("ellipse_half_length_mm", self.ellipse_half_length_mm, by)?;
        let curvature = keys.needed("transmission_curvature", self.transmission_curvature, by)?;
        let along = self.mean_point_along_mm.unwrap_or_default();
        let height = self.mean_point_height_mm.unwrap_or_default();
        let marking = self.marking_um.map_or(DEFAULT_MARKING_UM, f64::from);
        let gear = &blank.members[1];
        let half = 500.0 * blank.data.face_width_m[0].min(blank.data.face_width_m[1]);
        let (low, high) = (
            -1e3 * gear.dedendum_m(blank.mean_cone_m),
            1e3 * gear.addendum_m(blank.mean_cone_m),
        );
        for i in 0..2 {
            let key = |name: &str| format!("{name}.{i}");
            keys.require(
                &key("mean_point_along_mm"),
                along[i],
                along[i].abs() < half,
                &format!("less than half the face width, {half}, to either side"),
            )?;
            keys.require(
                &key("mean_point_height_mm"),
                height[i],
                height[i] > low && height[i] < high,
                &format!("above {low:.4}, below {high:.4}"),
            )?;
            keys.require(
                &key("ellipse_half_length_mm"),
                *ellipse[i],
                *ellipse[i] <= 20.0 * half,
                &format!("at most ten face widths, {}", 20.0 * half),
            )?;
        }
        Ok([0, 1].map(|i| Synthesis {
            mean_point_m: [1e-3 * along[i], 1e-3 * height[i]],
            path_angle_rad: angle[i].to_radians(),
            ellipse_half_length_m: 1e-3 * *ellipse[i],
            marking_m: 1e-6 * marking,
            transmission_curvature: *curvature[i],
        }))
    }
}
