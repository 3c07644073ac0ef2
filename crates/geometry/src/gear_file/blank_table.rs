//! `[blank]`: the body below the teeth.

use super::contour_table::{ContourRoom, WebPointTable, check_contour, check_fillets};
use super::openings_table::{HolesTable, SlotsTable, check_openings};
use super::{MM, TableKeys};
use crate::blank::{Blank, Contour, CutIntoShaft, LengthUnit, Lugs, MeshedBody, Rim, Web};
use crate::definition::ToothDefinition;
use crate::given;
use crate::input::{Bounded, Count, End, InputDocument, InputError, Within};
use crate::kinds;
use crate::number_range;
use crate::tooth::ToothGeometry;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// `[blank]`: one table a kind.
#[derive(Deserialize, Serialize, JsonSchema)]
#[serde(remote = "Self", rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(tag = "kind", rename = "BlankTable")]
pub(super) enum BlankTable {
    /// A disc of full width.
    Solid(SolidTable),
    /// Hub, web and rim.
    ThinRim(ThinRimTable),
    /// Hub and web with sloped or stepped faces.
    Contour(ContourTable),
    /// The rim of a ring with internal teeth.
    Ring(RingTable),
    /// The whole gear, meshed by another program.
    Mesh(MeshedTable),
}

kinds!(BlankTable, "kind");

/// The keys of `kind = "solid"`.
#[derive(Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct SolidTable {
    /// Bore; 0 for a gear that is cut into its shaft.
    bore_diameter_mm: f64,
    /// Diameter of the shaft at the back and the front face, where a gear without bore joins it; 0 where the shaft does
    /// not go on.
    shaft_diameter_mm: Option<[f64; 2]>,
    /// Annular slots through the disc; none where not given.
    slots: Option<SlotsTable>,
    /// Round holes through the disc; none where not given.
    holes: Option<HolesTable>,
}

/// The keys of `kind = "thin-rim"`.
#[derive(Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct ThinRimTable {
    /// Bore.
    bore_diameter_mm: f64,
    /// Outer diameter of the hub.
    hub_diameter_mm: f64,
    /// Inner diameter of the rim.
    rim_inner_diameter_mm: f64,
    /// Thickness of the web.
    web_thickness_mm: f64,
    /// Place of the web's middle along the axis from mid-face; 0 where not given.
    #[serde(default)]
    web_offset_mm: f64,
    /// Annular slots through the web; none where not given.
    slots: Option<SlotsTable>,
    /// Round holes through the web; none where not given.
    holes: Option<HolesTable>,
}

/// The keys of `kind = "contour"`.
#[derive(Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct ContourTable {
    /// Bore.
    bore_diameter_mm: f64,
    /// Back and front of the hub.
    hub_z_mm: [f64; 2],
    /// Points of the web from the hub outwards.
    web: Vec<WebPointTable>,
    /// Annular slots through the web; none where not given.
    slots: Option<SlotsTable>,
    /// Round holes through the web; none where not given.
    holes: Option<HolesTable>,
}

/// The keys of `kind = "ring"`, of full width.
#[derive(Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct RingTable {
    /// Outer diameter.
    outer_diameter_mm: f64,
    /// Back and front of the band of the outside at which the ring is held, from mid-face; the whole width where not
    /// given.
    held_band_mm: Option<[f64; 2]>,
    /// Lugs, keys or bolts that hold the ring; all round where not given.
    lugs: Option<LugsTable>,
}

number_range!(
    /// Angles of lugs: two or more of them go round with something free between.
    LugWidth: End::Beyond(0.0), End::Beyond(180.0)
);

/// Equal parts of the outside that are held, evenly round it.
#[derive(Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct LugsTable {
    /// Number of them.
    count: Count<2, 1000>,
    /// Angle that each covers.
    width_deg: Bounded<LugWidth>,
    /// Angle of the middle of the first one from the middle of tooth 0, counter-clockwise; 0 where not given.
    phase_deg: Option<Bounded<Within<-360, 360>>>,
}

impl LugsTable {
    /// `outer_radius_m` of the ring, `least_m`: shortest part that elements can follow, held or free.
    fn check(
        &self,
        keys: &TableKeys<'_>,
        outer_radius_m: f64,
        least_m: f64,
    ) -> Result<Lugs, InputError> {
        let lugs = Lugs {
            count: self.count.get(),
            width_rad: self.width_deg.to_radians(),
            phase_rad: (self.phase_deg.as_deref()).map_or(0.0, |deg| deg.to_radians()),
        };
        let (least_rad, repeat) = (least_m / outer_radius_m, lugs.repeat_rad());
        let [least_deg, most_deg] = [least_rad, repeat - least_rad].map(f64::to_degrees);
        keys.require(
            "lugs.width_deg",
            *self.width_deg,
            (least_deg..=most_deg).contains(&*self.width_deg),
            &format!("{least_deg:.4} to {most_deg:.4}: half a module or more of the outside is held, and as much is free between two"),
        )?;
        Ok(lugs)
    }
}

/// The keys of `kind = "mesh"`. The mesh has its openings.
#[derive(Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct MeshedTable {
    /// Bore.
    bore_diameter_mm: f64,
    /// File of the whole gear, teeth included, beside this one.
    file: String,
    /// Unit of its coordinates; "m" where not given.
    length_unit: Option<LengthUnit>,
    /// Set of nodes or elements on the bore; "bore" where not given.
    bore_set: Option<String>,
    /// Sets on the flanks, {tooth} and {side} standing for number and side; "tooth{tooth}_{side}_flank" where not
    /// given.
    flank_sets: Option<String>,
}

/// Thinnest wall, web, step or opening of a body over the module. Elements are about a module long: thinner ones would
/// be more than a thousand times as long as thick, which takes the square of that, six of sixteen digits, from their
/// stiffness; the checks of every reduction ask for nine, and a tolerance of a lathe is coarser.
pub(super) const LEAST_WALL: f64 = 1e-3;

/// What the teeth leave for the body.
struct Room {
    bore_mm: f64,
    /// Walls are not thinner.
    least_mm: f64,
    root_diameter_mm: f64,
    /// Below the root a ring of half a module must stay: the teeth's root stress lives in it.
    ring_diameter_mm: f64,
    width_mm: f64,
}

impl BlankTable {
    /// The body, in SI units.
    pub(super) fn check(
        self,
        document: &InputDocument,
        tooth: &ToothDefinition,
        profile: &ToothGeometry,
    ) -> Result<Blank, InputError> {
        let keys = TableKeys::new(document, "blank");
        if let Self::Ring(table) = &self {
            return table.check_rim(&keys, tooth, profile);
        }
        if profile.internal {
            let problem =
                "internal teeth stand inside a ring; set kind = \"ring\" and outer_diameter_mm";
            return Err(keys.error("kind", problem));
        }
        let root_diameter_mm = 2.0 * profile.root_radius_m / MM;
        let bore_mm = match &self {
            Self::Ring(_) => 0.0,
            Self::Solid(table) => table.bore_diameter_mm,
            Self::ThinRim(table) => table.bore_diameter_mm,
            Self::Contour(table) => table.bore_diameter_mm,
            Self::Mesh(table) => table.bore_diameter_mm,
        };
        let room = Room {
            bore_mm,
            least_mm: LEAST_WALL * tooth.module_m / MM,
            root_diameter_mm,
            ring_diameter_mm: root_diameter_mm - tooth.module_m / MM,
            width_mm: tooth.face_width_m / MM,
        };
        if let Self::Solid(table) = &self
            && (table.bore_diameter_mm == 0.0 || table.shaft_diameter_mm.is_some())
        {
            return table.check_shaft(&keys, &room, tooth);
        }
        room.check_bore(&keys)?;
        let bore_radius_m = 0.5 * bore_mm * MM;
        let (web, slots, holes) = match self {
            Self::Solid(table) => (None, table.slots, table.holes),
            Self::ThinRim(t) => (Some((t.check_web(&keys, &room)?, None)), t.slots, t.holes),
            Self::Contour(table) => {
                let (contour, web) = table.check_contour(&keys, &room)?;
                (Some((web, Some(contour))), table.slots, table.holes)
            }
            Self::Ring(_) => (None, None, None),
            Self::Mesh(table) => {
                let body = table.check_meshed(document, &keys, tooth)?;
                return Ok(Blank::Meshed {
                    bore_radius_m,
                    body,
                });
            }
        };
        // Openings keep clear of the fillets at hub and rim.
        let whole_disc = (0.5 * bore_mm, 0.5 * room.ring_diameter_mm);
        let between_mm = web.as_ref().map_or(whole_disc, |(web, contour)| {
            let fillets = contour.as_ref().map_or([0.0; 2], |c: &Contour| {
                [c.web.first(), c.web.last()].map(|p| p.map_or(0.0, |p| p.fillet_radius_m / MM))
            });
            (
                web.hub_radius_m / MM + fillets[0],
                web.rim_inner_radius_m / MM - fillets[1],
            )
        });
        let openings = check_openings(slots, holes, document, between_mm, tooth.module_m)?;
        let blank = match web {
            None => Blank::Solid {
                bore_radius_m,
                openings,
            },
            Some((web, contour)) => Blank::Webbed {
                bore_radius_m,
                web,
                contour,
                openings,
            },
        };
        check_fillets(&keys, &blank, tooth.face_width_m, profile.root_radius_m)?;
        Ok(blank)
    }
}

impl Room {
    fn check_bore(&self, keys: &TableKeys) -> Result<(), InputError> {
        let (bore, ring) = (self.bore_mm, self.ring_diameter_mm);
        keys.require(
            "bore_diameter_mm",
            bore,
            bore > 0.0 && bore < ring,
            &format!(
                "more than 0 and less than {ring:.3}: the root diameter {:.3} less one module, so that half a module of body stays below the teeth",
                self.root_diameter_mm
            ),
        )
    }
}

impl SolidTable {
    /// A gear without bore.
    fn check_shaft(
        &self,
        keys: &TableKeys,
        room: &Room,
        tooth: &ToothDefinition,
    ) -> Result<Blank, InputError> {
        if self.bore_diameter_mm != 0.0 {
            let problem = "is not used with a bore, at which the gear is held; remove it or set bore_diameter_mm = 0";
            return Err(keys.error("shaft_diameter_mm", problem));
        }
        keys.refuse(
            &given!(self; slots, holes),
            "is not used with bore_diameter_mm = 0: a gear cut into its shaft has no openings; remove it",
        )?;
        let ends = self.shaft_diameter_mm.ok_or_else(|| {
            let problem = "found 0; a gear that is cut into its shaft needs shaft_diameter_mm = [back, front] as well, the faces at which it joins the shaft";
            keys.error("bore_diameter_mm", problem)
        })?;
        // Teeth and the ring below them are condensed by themselves.
        let most = room.root_diameter_mm - 3.0 * tooth.module_m / MM;
        let hole = CutIntoShaft::HOLE * room.root_diameter_mm;
        for (i, diameter) in ends.into_iter().enumerate() {
            keys.require(
                &format!("shaft_diameter_mm.{i}"),
                diameter,
                diameter == 0.0 || (diameter >= 4.0 * hole && diameter <= most * (1.0 + 1e-9)),
                &format!(
                    "0 where the shaft does not go on, or {:.3} to {most:.3}: the root diameter {:.3} less three modules",
                    4.0 * hole,
                    room.root_diameter_mm
                ),
            )?;
        }
        if ends == [0.0; 2] {
            return Err(keys.error(
                "shaft_diameter_mm",
                "found 0 at both faces: the gear is held nowhere",
            ));
        }
        Ok(Blank::CutIntoShaft(CutIntoShaft {
            hole_radius_m: 0.5 * hole * MM,
            end_radii_m: ends.map(|d| 0.5 * d * MM),
        }))
    }
}

impl RingTable {
    /// The rim outside the root circle.
    fn check_rim(
        &self,
        keys: &TableKeys,
        tooth: &ToothDefinition,
        profile: &ToothGeometry,
    ) -> Result<Blank, InputError> {
        if !profile.internal {
            return Err(keys.error(
                "kind",
                "\"ring\" is the body of internal teeth; give a negative number of teeth or choose another kind",
            ));
        }
        let root_mm = 2.0 * profile.root_radius_m / MM;
        let least_mm = root_mm + tooth.module_m / MM;
        // Elements are about a module long: beyond this the rim is a plate whose outside no tooth feels.
        let most_mm = 10.0 * root_mm;
        let outer_mm = self.outer_diameter_mm;
        keys.require(
            "outer_diameter_mm",
            outer_mm,
            outer_mm >= least_mm && outer_mm <= most_mm,
            &format!(
                "{least_mm:.3} to {most_mm:.3}: at least the root diameter {root_mm:.3} and one module, so that the rim is half a module thick"
            ),
        )?;
        let half_mm = 0.5 * tooth.face_width_m / MM;
        let thinnest_mm = LEAST_WALL * tooth.module_m / MM;
        if let Some([back, front]) = self.held_band_mm {
            for (i, z) in [back, front].into_iter().enumerate() {
                let flush = z.abs() == half_mm;
                let clear = z.abs() <= half_mm - thinnest_mm;
                keys.require(
                    &format!("held_band_mm.{i}"),
                    z,
                    flush || clear,
                    &format!("-{half_mm} to {half_mm}, at a face or {thinnest_mm:.4} inside of it"),
                )?;
            }
            keys.require(
                "held_band_mm.1",
                front,
                front - back >= thinnest_mm,
                &format!("{thinnest_mm:.4} or more above the back, {back}"),
            )?;
        }
        Ok(Blank::Ring(Rim {
            outer_radius_m: 0.5 * outer_mm * MM,
            held_z_m: self.held_band_mm.map(|band| band.map(|z| z * MM)),
            lugs: (self.lugs.as_ref())
                .map(|lugs| lugs.check(keys, 0.5 * outer_mm * MM, 0.5 * tooth.module_m))
                .transpose()?,
        }))
    }
}

impl MeshedTable {
    /// Where the mesh is and how its sets are called; the names are those that `gearmesh mesh` gives unless told
    /// otherwise.
    fn check_meshed(
        &self,
        document: &InputDocument,
        keys: &TableKeys,
        tooth: &ToothDefinition,
    ) -> Result<MeshedBody, InputError> {
        let flank_sets = self
            .flank_sets
            .as_deref()
            .unwrap_or("tooth{tooth}_{side}_flank");
        for part in ["{tooth}", "{side}"] {
            if !flank_sets.contains(part) {
                return Err(keys.error(
                    "flank_sets",
                    format!("found \"{flank_sets}\"; {part} must stand in it, as in \"tooth{{tooth}}_{{side}}_flank\""),
                ));
            }
        }
        if tooth.helix_angle_rad != 0.0 {
            let problem = "a mesh from elsewhere is read for spur gears only; set tooth.helix_angle_deg = 0 or choose another kind";
            return Err(keys.error("kind", problem));
        }
        // Beside the gear file, unless it is an absolute path.
        let folder = document.folder();
        Ok(MeshedBody {
            file: folder.join(&self.file),
            length_unit: self.length_unit.unwrap_or(LengthUnit::Metre),
            bore_set: self.bore_set.clone().unwrap_or_else(|| "bore".into()),
            flank_sets: flank_sets.into(),
        })
    }
}

impl ContourTable {
    fn check_contour(&self, keys: &TableKeys, room: &Room) -> Result<(Contour, Web), InputError> {
        let room = ContourRoom {
            bore_mm: room.bore_mm,
            ring_mm: room.ring_diameter_mm,
            width_mm: room.width_mm,
            least_mm: room.least_mm,
        };
        check_contour(keys, self.hub_z_mm, &self.web, &room)
    }
}

impl ThinRimTable {
    fn check_web(&self, keys: &TableKeys, room: &Room) -> Result<Web, InputError> {
        let (hub, rim) = (self.hub_diameter_mm, self.rim_inner_diameter_mm);
        let (thickness, offset) = (self.web_thickness_mm, self.web_offset_mm);
        let (bore, ring, width) = (room.bore_mm, room.ring_diameter_mm, room.width_mm);
        let least = room.least_mm;
        keys.require(
            "hub_diameter_mm",
            hub,
            hub >= bore + 2.0 * least,
            &format!(
                "at least {:.4}: the bore, {bore}, and a wall of a thousandth of a module",
                bore + 2.0 * least
            ),
        )?;
        keys.require(
            "rim_inner_diameter_mm",
            rim,
            rim >= hub + 2.0 * least && rim < ring,
            &format!(
                "at least {:.4}: the hub, {hub}, and two thousandths of a module, and less than {ring:.3}: the root diameter {:.3} less one module, so that the rim is at least half a module thick",
                hub + 2.0 * least,
                room.root_diameter_mm
            ),
        )?;
        keys.require(
            "web_thickness_mm",
            thickness,
            thickness >= least && thickness <= width,
            &format!(
                "at least {least:.4}, a thousandth of a module, and at most the face width, {width}"
            ),
        )?;
        let play = 0.5 * (width - thickness);
        keys.require(
            "web_offset_mm",
            offset,
            // Rounding of a web that ends flush with the face is forgiven.
            offset.abs() <= play + 1e-9,
            &format!("-{play} to {play}: the web must stay inside the face width"),
        )?;
        for step in [play - offset, play + offset] {
            let flush_or_clear = step.abs() <= 1e-9 || step >= least;
            let key = if play < least {
                "web_thickness_mm"
            } else {
                "web_offset_mm"
            };
            let found = if play < least { thickness } else { offset };
            keys.require(
                key,
                found,
                flush_or_clear,
                &format!(
                    "a web whose faces are flush with the gear's or {least:.4} mm, a thousandth of a module, inside of them ({step:e} mm now)"
                ),
            )?;
        }
        Ok(Web {
            hub_radius_m: 0.5 * hub * MM,
            rim_inner_radius_m: 0.5 * rim * MM,
            thickness_m: thickness * MM,
            offset_m: offset * MM,
        })
    }
}
