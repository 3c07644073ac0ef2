//! `[blank]`: the body below the teeth.

use super::contour_table::{ContourRoom, WebPointTable, check_contour, check_fillets};
use super::openings_table::{HolesTable, SlotsTable, check_openings};
use super::{MM, TableKeys};
use crate::definition::{Blank, Contour, LengthUnit, MeshedBody, ToothDefinition, Web};
use crate::input::{InputDocument, InputError};
use crate::tooth::ToothGeometry;
use schemars::JsonSchema;
use serde::Deserialize;
use std::path::Path;

/// The keys of `[blank]`.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct BlankTable {
    /// "solid" disc, "thin-rim" with hub and web, "contour" with sloped or stepped faces, "mesh" of another program.
    kind: BlankKind,
    /// Bore.
    bore_diameter_mm: f64,
    /// "thin-rim": outer diameter of the hub.
    hub_diameter_mm: Option<f64>,
    /// "thin-rim": inner diameter of the rim.
    rim_inner_diameter_mm: Option<f64>,
    /// "thin-rim": thickness of the web.
    web_thickness_mm: Option<f64>,
    /// "thin-rim": place of the web's middle along the axis from mid-face; 0 where not given.
    web_offset_mm: Option<f64>,
    /// "contour": back and front of the hub.
    hub_z_mm: Option<[f64; 2]>,
    /// "contour": points of the web from the hub outwards.
    web: Option<Vec<WebPointTable>>,
    /// Annular slots through the web or the disc; none where not given.
    slots: Option<SlotsTable>,
    /// Round holes through the web or the disc; none where not given.
    holes: Option<HolesTable>,
    /// "mesh": file of the whole gear, teeth included, beside this one.
    file: Option<String>,
    /// "mesh": unit of its coordinates; "m" where not given.
    length_unit: Option<LengthUnit>,
    /// "mesh": set of nodes or elements on the bore; "bore" where not given.
    bore_set: Option<String>,
    /// "mesh": sets on the flanks, {tooth} and {side} standing for number and side; "tooth{tooth}_{side}_flank" where
    /// not given.
    flank_sets: Option<String>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
enum BlankKind {
    Solid,
    ThinRim,
    Contour,
    Mesh,
}

/// What the teeth leave for the body.
struct Room {
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
        let root_diameter_mm = 2.0 * profile.root_radius_m / MM;
        let room = Room {
            root_diameter_mm,
            ring_diameter_mm: root_diameter_mm - tooth.module_m / MM,
            width_mm: tooth.face_width_m / MM,
        };
        self.check_bore(&keys, &room)?;
        let mut contour = None;
        let web = match self.kind {
            BlankKind::Solid => {
                self.refuse_web_keys(&keys, "a solid blank")?;
                None
            }
            BlankKind::ThinRim => Some(self.check_web(&keys, &room)?),
            BlankKind::Contour => {
                self.refuse_web_keys(&keys, "a blank given by its contour")?;
                let (given, web) = self.check_contour(&keys, &room)?;
                contour = Some(given);
                Some(web)
            }
            BlankKind::Mesh => {
                self.refuse_web_keys(&keys, "a blank that was meshed elsewhere")?;
                self.refuse_contour_keys(&keys)?;
                let meshed = self.check_meshed(document, &keys)?;
                if tooth.helix_angle_rad != 0.0 {
                    return Err(keys.error(
                        "kind",
                        "a mesh from elsewhere is read for spur gears only; set tooth.helix_angle_deg = 0 or choose another kind",
                    ));
                }
                return Ok(Blank {
                    bore_radius_m: 0.5 * self.bore_diameter_mm * MM,
                    web: None,
                    contour: None,
                    openings: None,
                    meshed: Some(meshed),
                });
            }
        };
        self.refuse_mesh_keys(&keys)?;
        if contour.is_none() {
            self.refuse_contour_keys(&keys)?;
        }
        // Openings keep clear of the fillets at hub and rim.
        let fillets = contour.as_ref().map_or([0.0; 2], |c| {
            [c.web.first(), c.web.last()].map(|p| p.map_or(0.0, |p| p.fillet_radius_m / MM))
        });
        let (inner_mm, outer_mm) = web.map_or(
            (0.5 * self.bore_diameter_mm, 0.5 * room.ring_diameter_mm),
            |w| {
                (
                    w.hub_radius_m / MM + fillets[0],
                    w.rim_inner_radius_m / MM - fillets[1],
                )
            },
        );
        let openings = check_openings(
            self.slots,
            self.holes,
            document,
            (inner_mm, outer_mm),
            tooth.module_m,
        )?;
        let blank = Blank {
            bore_radius_m: 0.5 * self.bore_diameter_mm * MM,
            web,
            contour,
            openings,
            meshed: None,
        };
        check_fillets(&keys, &blank, tooth.face_width_m, profile.root_radius_m)?;
        Ok(blank)
    }

    fn check_bore(&self, keys: &TableKeys, room: &Room) -> Result<(), InputError> {
        let (bore, ring) = (self.bore_diameter_mm, room.ring_diameter_mm);
        keys.require(
            "bore_diameter_mm",
            bore,
            bore > 0.0 && bore < ring,
            &format!(
                "more than 0 and less than {ring:.3}: the root diameter {:.3} less one module, so that half a module of body stays below the teeth",
                room.root_diameter_mm
            ),
        )
    }

    /// Where the mesh is and how its sets are called; the names are those that `gearmesh mesh` gives unless told
    /// otherwise.
    fn check_meshed(
        &self,
        document: &InputDocument,
        keys: &TableKeys,
    ) -> Result<MeshedBody, InputError> {
        for (key, given) in [
            ("slots", self.slots.is_some()),
            ("holes", self.holes.is_some()),
        ] {
            if given {
                return Err(keys.error(
                    key,
                    "a blank that was meshed elsewhere has its openings in the mesh; remove it",
                ));
            }
        }
        let file = self.file.as_deref().ok_or_else(|| {
            keys.error(
                "file",
                "missing; a blank of kind \"mesh\" needs the name of its mesh file",
            )
        })?;
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
        // Beside the gear file, unless it is an absolute path.
        let folder = Path::new(&document.file).parent().unwrap_or(Path::new(""));
        Ok(MeshedBody {
            file: folder.join(file),
            length_unit: self.length_unit.unwrap_or(LengthUnit::Metre),
            bore_set: self.bore_set.clone().unwrap_or_else(|| "bore".into()),
            flank_sets: flank_sets.into(),
        })
    }

    fn check_contour(&self, keys: &TableKeys, room: &Room) -> Result<(Contour, Web), InputError> {
        let hub_z_mm = self.hub_z_mm.ok_or_else(|| {
            keys.error(
                "hub_z_mm",
                "missing; a contour needs [back, front] of its hub",
            )
        })?;
        let room = ContourRoom {
            bore_mm: self.bore_diameter_mm,
            ring_mm: room.ring_diameter_mm,
            width_mm: room.width_mm,
        };
        check_contour(keys, hub_z_mm, self.web.as_deref().unwrap_or(&[]), &room)
    }

    fn refuse_contour_keys(&self, keys: &TableKeys) -> Result<(), InputError> {
        for (key, given) in [
            ("hub_z_mm", self.hub_z_mm.is_some()),
            ("web", self.web.is_some()),
        ] {
            if given {
                return Err(
                    keys.error(key, "only a blank of kind = \"contour\" uses it; remove it")
                );
            }
        }
        Ok(())
    }

    fn refuse_mesh_keys(&self, keys: &TableKeys) -> Result<(), InputError> {
        for (key, given) in [
            ("file", self.file.is_some()),
            ("length_unit", self.length_unit.is_some()),
            ("bore_set", self.bore_set.is_some()),
            ("flank_sets", self.flank_sets.is_some()),
        ] {
            if given {
                return Err(keys.error(key, "only a blank of kind = \"mesh\" uses it; remove it"));
            }
        }
        Ok(())
    }

    fn refuse_web_keys(&self, keys: &TableKeys, blank: &str) -> Result<(), InputError> {
        for (key, value) in [
            ("hub_diameter_mm", self.hub_diameter_mm),
            ("rim_inner_diameter_mm", self.rim_inner_diameter_mm),
            ("web_thickness_mm", self.web_thickness_mm),
            ("web_offset_mm", self.web_offset_mm),
        ] {
            if value.is_some() {
                return Err(keys.error(
                    key,
                    format!("{blank} does not use it; remove it or set kind = \"thin-rim\""),
                ));
            }
        }
        Ok(())
    }

    fn check_web(&self, keys: &TableKeys, room: &Room) -> Result<Web, InputError> {
        let given = |key: &str, value: Option<f64>| {
            value.ok_or_else(|| keys.error(key, "missing; a thin-rim blank needs it"))
        };
        let hub = given("hub_diameter_mm", self.hub_diameter_mm)?;
        let rim = given("rim_inner_diameter_mm", self.rim_inner_diameter_mm)?;
        let thickness = given("web_thickness_mm", self.web_thickness_mm)?;
        let offset = self.web_offset_mm.unwrap_or(0.0);
        let (bore, ring, width) = (self.bore_diameter_mm, room.ring_diameter_mm, room.width_mm);
        keys.require(
            "hub_diameter_mm",
            hub,
            hub > bore,
            &format!("more than the bore, {bore}"),
        )?;
        keys.require(
            "rim_inner_diameter_mm",
            rim,
            rim > hub && rim < ring,
            &format!(
                "more than the hub, {hub}, and less than {ring:.3}: the root diameter {:.3} less one module, so that the rim is at least half a module thick",
                room.root_diameter_mm
            ),
        )?;
        keys.require(
            "web_thickness_mm",
            thickness,
            thickness > 0.0 && thickness <= width,
            &format!("more than 0 and at most the face width, {width}"),
        )?;
        let play = 0.5 * (width - thickness);
        keys.require(
            "web_offset_mm",
            offset,
            // Rounding of a web that ends flush with the face is forgiven.
            offset.abs() <= play + 1e-9,
            &format!("-{play} to {play}: the web must stay inside the face width"),
        )?;
        Ok(Web {
            hub_radius_m: 0.5 * hub * MM,
            rim_inner_radius_m: 0.5 * rim * MM,
            thickness_m: thickness * MM,
            offset_m: offset * MM,
        })
    }
}
