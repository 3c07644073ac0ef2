//! `[pinion]` and `[gear]`: how a member is cut.

use gearmesh_geometry::input::{Bounded, InputDocument, Positive, TableKeys, Within};
use gearmesh_geometry::{InputError, kinds};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(remote = "Self", rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(tag = "settings", rename = "MemberTable")]
pub enum MemberTable {
    /// By the pair's crown gear: conjugate where both members are cut so.
    Crown(BladeTable),
    /// Generated, both flanks by one face mill.
    Basic(BladeTable),
    /// Not generated: the work is held.
    Formate(BladeTable),
    /// Pinion: each flank by local synthesis.
    LocalSynthesis(SynthesisTable),
    /// Pinion: each flank fitted to an ease-off.
    EaseOff(EaseOffTable),
    /// As stated in `concave` and `convex`.
    Given(GivenTable),
    /// No settings: flanks through measured or published points.
    Points(PointsTable),
}

kinds!(MemberTable, "settings");

/// Lengths of blades and lands.
type Length = Option<Bounded<Within<0, 1000>>>;

/// The blade where the settings follow from the pair.
#[derive(Debug, Clone, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BladeTable {
    /// Radius of the blade's edge.
    pub edge_radius_mm: Length,
    /// Width of the blade's point, to check that it fits into the slot.
    pub point_width_mm: Length,
    /// Least thickness of the top land; 0 where not given.
    pub least_top_land_mm: Length,
}

/// `settings = "local-synthesis"`.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SynthesisTable {
    /// Radius of the blade's edge.
    pub edge_radius_mm: Length,
    /// Width of the blade's point, to check that it fits into the slot.
    pub point_width_mm: Length,
    /// Least thickness of the top land; 0 where not given.
    pub least_top_land_mm: Length,
    /// Mean contact point on the gear along the tooth, from the middle of the face towards the heel; 0 where not given.
    #[serde(default)]
    pub mean_point_along_mm: [f64; 2],
    /// Its height above the gear's pitch cone; 0 where not given.
    #[serde(default)]
    pub mean_point_height_mm: [f64; 2],
    /// Direction of the path on the gear's flank, from along the tooth towards the heel to up the profile.
    pub path_angle_deg: [Bounded<Within<1, 179>>; 2],
    /// Half length of the contact ellipse.
    pub ellipse_half_length_mm: [Bounded<Positive>; 2],
    /// Marking thickness of that ellipse; 6.35 where not given.
    pub marking_um: Option<Bounded<MarkingThickness>>,
    /// Second derivative of the gear's lead by the pinion's turn; negative where the gear stays behind.
    pub transmission_curvature: [Bounded<Within<-1, 1>>; 2],
}

/// `settings = "ease-off"`.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EaseOffTable {
    /// Radius of the blade's edge.
    pub edge_radius_mm: Length,
    /// Width of the blade's point, to check that it fits into the slot.
    pub point_width_mm: Length,
    /// Least thickness of the top land; 0 where not given.
    pub least_top_land_mm: Length,
    /// Material left away at toe and heel.
    pub lengthwise_um: Amounts,
    /// Material left away at the tip and the lower end of the working depth.
    pub profile_um: Amounts,
    /// Twist, at the tip of the heel; its negative at the tip of the toe. 0 where not given.
    pub bias_um: Option<Amounts>,
}

/// `settings = "given"`.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GivenTable {
    /// Width of the blade's point, to check that it fits into the slot.
    pub point_width_mm: Length,
    /// Least thickness of the top land; 0 where not given.
    pub least_top_land_mm: Length,
    /// Settings of the concave flank.
    pub concave: SettingsTable,
    /// Settings of the convex flank.
    pub convex: SettingsTable,
    /// Which tooth thickness counts. Where not given that of the settings where they are the same for both flanks but
    /// for the blades (one operation), else that of the blank.
    pub thickness: Option<ThicknessFrom>,
}

/// `settings = "points"`.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PointsTable {
    /// Least thickness of the top land; 0 where not given.
    pub least_top_land_mm: Length,
    /// Table of the concave flank's points, beside this file or with its folder: columns sector, height, x_mm, y_mm,
    /// z_mm, nx, ny, nz (all three of these may be missing: the points make the normals); with deviation_um the points
    /// are nominal and the flank is off them by so much added material.
    pub concave_points: String,
    /// Table of the convex flank's points.
    pub convex_points: String,
    /// Place of the tables' origin on the member's axis, from the pitch apex towards the heel; 0 where not given.
    pub points_origin_mm: Option<Bounded<Within<-10_000, 10_000>>>,
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
        let straight = blank.data.form == ToothForm::Straight;
        self.refuse_settings(&keys, name == "pinion", straight)?;
        let [edge, point, land] = match self {
            Self::Crown(t) | Self::Basic(t) | Self::Formate(t) => {
                [t.edge_radius_mm, t.point_width_mm, t.least_top_land_mm]
            }
            Self::LocalSynthesis(t) => [t.edge_radius_mm, t.point_width_mm, t.least_top_land_mm],
            Self::EaseOff(t) => [t.edge_radius_mm, t.point_width_mm, t.least_top_land_mm],
            Self::Given(t) => [None, t.point_width_mm, t.least_top_land_mm],
            Self::Points(t) => [None, None, t.least_top_land_mm],
        };
        if straight && edge.is_some() {
            return Err(keys.error(
                "edge_radius_mm",
                "is not used by straight teeth: their tool has no edge radius; remove it",
            ));
        }
        let metres = |value: Length| 1e-3 * value.map_or(0.0, f64::from);
        Ok(MemberRequest {
            cutting: self.cutting(document, &keys, name, blank)?,
            edge_radius_m: metres(edge),
            point_width_m: metres(point),
            least_top_land_m: metres(land),
        })
    }

    /// Refuses settings that this member, or its form of teeth, cannot have.
    fn refuse_settings(
        &self,
        keys: &TableKeys<'_>,
        pinion: bool,
        straight: bool,
    ) -> Result<(), InputError> {
        let problem = match self {
            Self::LocalSynthesis(_) | Self::EaseOff(_) if !pinion => {
                "is for the pinion; allowed is \"crown\", \"basic\", \"formate\", \"given\" or \"points\""
            }
            Self::Formate(_) if pinion => "is for the gear: a pinion must be generated",
            Self::Crown(_) | Self::Basic(_) | Self::Points(_) => return Ok(()),
            _ if straight => {
                "does not cut straight teeth; allowed is \"crown\", \"basic\" or \"points\""
            }
            _ => return Ok(()),
        };
        Err(keys.error("settings", problem))
    }

    fn cutting(
        &self,
        document: &InputDocument,
        keys: &TableKeys<'_>,
        name: &str,
        blank: &PairBlank,
    ) -> Result<Cutting, InputError> {
        Ok(match self {
            Self::Crown(_) => Cutting::Crown,
            Self::Basic(_) => Cutting::Basic(Process::Generated),
            Self::Formate(_) => Cutting::Basic(Process::Formate),
            Self::LocalSynthesis(table) => Cutting::Synthesis(table.synthesis(keys, blank)?),
            Self::EaseOff(table) => Cutting::EaseOff([0, 1].map(|i| AskedEaseOff {
                lengthwise_m: 1e-6 * *table.lengthwise_um[i],
                profile_m: 1e-6 * *table.profile_um[i],
                bias_m: 1e-6 * table.bias_um.map_or(0.0, |bias| *bias[i]),
            })),
            Self::Points(table) => {
                let member = &blank.members[usize::from(name == "gear")];
                Cutting::Points(Box::new(table.points(document, member)?))
            }
            Self::Given(table) => {
                let settings = [
                    table
                        .concave
                        .settings(document, &format!("{name}.concave"))?,
                    table.convex.settings(document, &format!("{name}.convex"))?,
                ];
                given_check::check(keys, &settings, blank, (name, table.thickness))?;
                Cutting::Given(settings, table.thickness)
            }
        })
    }
}

impl PointsTable {
    /// Flanks through points.
    fn points(
        &self,
        document: &InputDocument,
        member: &MemberBlank,
    ) -> Result<[GridSurface; 2], InputError> {
        let origin = self.points_origin_mm.map_or(0.0, f64::from);
        let folder = document.folder();
        let read = |name: &str, side: FlankSide| {
            GridSurface::read(&folder.join(name), 1e-3 * origin, member, side)
        };
        Ok([
            read(&self.concave_points, FlankSide::Concave)?,
            read(&self.convex_points, FlankSide::Convex)?,
        ])
    }
}

impl SynthesisTable {
    fn synthesis(
        &self,
        keys: &TableKeys<'_>,
        blank: &PairBlank,
    ) -> Result<[Synthesis; 2], InputError> {
        let (along, height) = (self.mean_point_along_mm, self.mean_point_height_mm);
        let ellipse = self.ellipse_half_length_mm;
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
            path_angle_rad: self.path_angle_deg[i].to_radians(),
            ellipse_half_length_m: 1e-3 * *ellipse[i],
            marking_m: 1e-6 * marking,
            transmission_curvature: *self.transmission_curvature[i],
        }))
    }
}
