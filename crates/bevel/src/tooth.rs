//! Both flanks of a member's tooth, and what must not happen to them: undercut, points, blades that do not fit.

use std::f64::consts::TAU;

use crate::blank::MemberBlank;
use crate::cut_thickness::{ThicknessFrom, ToothThickness, cut_thickness_m, is_one_operation};
use crate::error::BevelError;
use crate::flank::{Flank, Located};
use crate::grid_surface::GridSurface;
use crate::hand::FlankSide;
use crate::settings::MachineSettings;

pub use crate::flank::{pressure_angle_rad, spiral_angle_rad};

/// A tooth: its concave and its convex flank, as far apart at the mean point as both are cut, or as the blank says.
#[derive(Debug, Clone, PartialEq)]
pub struct Tooth {
    /// Blank.
    pub blank: MemberBlank,
    /// Concave and convex flank, each with its own mean point on +x.
    pub flanks: [Flank; 2],
    /// How far they are apart.
    pub thickness: ToothThickness,
}

/// What the checks of a tooth found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToothCheck {
    /// Thinnest top land along the circle \[m\].
    pub least_top_m: f64,
    /// Narrowest bottom of the slot, normal to the tooth \[m\]; none of flanks from points, whose roots are not known.
    pub least_slot_m: Option<f64>,
}

/// Width of a slot's bottom, normal to the tooth, seen in the plane of the crown gear that cuts it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlotWidth {
    /// Between the points of blades without edge radius \[m\].
    pub point_m: f64,
    /// What the edge radii of both blades take of it \[m\].
    pub edges_m: f64,
}

/// Places of the checks along the face and up the flank.
const ALONG: usize = 9;
const UP: usize = 9;

impl Tooth {
    /// A tooth from the settings of its concave and convex flank. `thickness`: what is asked for; where nothing is, the
    /// settings count that cut both flanks in one operation, else the blank.
    ///
    /// # Errors
    /// [`BevelError::NoFlankPoint`]; [`BevelError::NoSlot`] where the blades leave no slot between the flanks of one
    /// operation.
    pub fn cut(
        blank: &MemberBlank,
        settings: &[MachineSettings; 2],
        thickness: Option<ThicknessFrom>,
    ) -> Result<Self, BevelError> {
        let flanks = [
            Flank::cut(blank, FlankSide::Concave, &settings[0])?,
            Flank::cut(blank, FlankSide::Convex, &settings[1])?,
        ];
        let circle = TAU * blank.mean_cone_m * blank.pitch_angle_rad.sin() / blank.teeth as f64;
        let one_operation = is_one_operation(blank, settings).then(|| cut_thickness_m(&flanks));
        // Crown gears of one cutter radius have the larger one inside: two operations.
        let [outside, inside] =
            (settings.each_ref()).map(|s| s.face_mill().map_or(0.0, |mill| mill.point_radius_m));
        let is_tooth =
            |thickness: &f64| outside > inside && *thickness > 0.0 && *thickness < circle;
        let cut_m = one_operation.filter(is_tooth);
        let from = match (thickness, one_operation) {
            (Some(ThicknessFrom::Blank), _) | (_, None) => ThicknessFrom::Blank,
            (_, Some(_)) => ThicknessFrom::Settings,
        };
        if let (ThicknessFrom::Settings, None, Some(thickness)) = (from, cut_m, one_operation) {
            return Err(BevelError::NoSlot {
                member: blank.name,
                thickness_mm: 1e3 * thickness,
                pitch_mm: 1e3 * circle,
            });
        }
        let found = ToothThickness {
            blank_m: blank.mean_thickness_m,
            cut_m,
            from,
        };
        Ok(Self {
            blank: blank.clone(),
            flanks,
            thickness: found,
        })
    }

    /// A tooth whose concave and convex flanks go through grids of points.
    ///
    /// # Errors
    /// [`BevelError::NoFlankPoint`].
    pub fn through(blank: &MemberBlank, grids: &[GridSurface; 2]) -> Result<Self, BevelError> {
        let [concave, convex] = grids;
        Ok(Self {
            blank: blank.clone(),
            flanks: [
                Flank::through(blank, FlankSide::Concave, concave.clone())?,
                Flank::through(blank, FlankSide::Convex, convex.clone())?,
            ],
            thickness: ToothThickness {
                blank_m: blank.mean_thickness_m,
                cut_m: None,
                from: ThicknessFrom::Blank,
            },
        })
    }

    /// A flank.
    pub fn flank(&self, side: FlankSide) -> &Flank {
        match side {
            FlankSide::Concave => &self.flanks[0],
            FlankSide::Convex => &self.flanks[1],
        }
    }

    /// Angle from the tooth's middle to a flank's mean point, counter-clockwise about the axis \[rad\].
    pub fn half_angle_rad(&self, side: FlankSide) -> f64 {
        let radius = self.blank.mean_cone_m * self.blank.pitch_angle_rad.sin();
        side.facing(self.blank.hand) * 0.5 * self.thickness.counts_m() / radius
    }

    /// Angle that the tooth covers at a place \[rad\].
    ///
    /// # Errors
    /// [`BevelError::NoFlankPoint`].
    pub fn angle_rad(&self, cone_m: f64, height_m: f64) -> Result<f64, BevelError> {
        let mut angle = 0.0;
        for flank in &self.flanks {
            let r = flank.locate(cone_m, height_m)?.point.r;
            let azimuth = r.y.atan2(r.x) + self.half_angle_rad(flank.side);
            angle += flank.side.facing(self.blank.hand) * azimuth;
        }
        Ok(angle)
    }

    /// Looks for undercut, pointed teeth, and a blade of that point width that does not fit into the slot.
    ///
    /// # Errors
    /// [`BevelError`] with the place.
    pub fn check(&self, least_top_m: f64, point_width_m: f64) -> Result<ToothCheck, BevelError> {
        for flank in self.flanks.iter().filter(|f| f.cut_surface().is_some()) {
            check_envelope(flank)?;
        }
        let blank = &self.blank;
        let mut found = ToothCheck {
            least_top_m: f64::INFINITY,
            least_slot_m: None,
        };
        for i in 0..ALONG {
            let cone = along(blank, i);
            let radius = |height: f64| {
                cone * blank.pitch_angle_rad.sin() + height * blank.pitch_angle_rad.cos()
            };
            let tip = blank.addendum_m(cone);
            let top = self.angle_rad(cone, tip)? * radius(tip);
            if top < least_top_m {
                return Err(BevelError::Pointed {
                    member: blank.name,
                    cone_mm: 1e3 * cone,
                    thickness_mm: 1e3 * top,
                    least_mm: 1e3 * least_top_m,
                });
            }
            found.least_top_m = found.least_top_m.min(top);
            let Some(SlotWidth {
                point_m: width,
                edges_m,
            }) = self.slot_width_m(cone)?
            else {
                continue;
            };
            if width > 0.0 && width < edges_m - 1e-9 * blank.mean_cone_m {
                return Err(BevelError::EdgeTooLarge {
                    member: blank.name,
                    cone_mm: 1e3 * cone,
                    slot_mm: 1e3 * width,
                    edges_mm: 1e3 * edges_m,
                    share: width / edges_m,
                });
            }
            if width < point_width_m - 1e-9 * blank.mean_cone_m || width <= 0.0 {
                return Err(BevelError::BladeTooWide {
                    member: blank.name,
                    cone_mm: 1e3 * cone,
                    slot_mm: 1e3 * width,
                    blade_mm: 1e3 * point_width_m,
                });
            }
            let least = found.least_slot_m.unwrap_or(f64::INFINITY);
            found.least_slot_m = Some(least.min(width));
        }
        Ok(found)
    }

    /// Width of the blade's point that leaves the slot's bottom as it is. None of flanks from points.
    ///
    /// # Errors
    /// [`BevelError::NoFlankPoint`].
    pub fn slot_width_m(&self, cone_m: f64) -> Result<Option<SlotWidth>, BevelError> {
        let mut angle = TAU / self.blank.teeth as f64;
        let (mut radius, mut cosine, mut edges, mut slip) = (0.0, 0.0, 0.0, 0.0);
        for flank in &self.flanks {
            let Some(cut) = flank.cut_surface() else {
                return Ok(None);
            };
            let settings = cut.settings;
            let root = flank.root(cone_m)?;
            let r = root.point.r;
            // A generated root is slower than the pitch cone that rolls: the slot is narrower there than the blade.
            slip += 0.5
                * settings
                    .roll
                    .map_or(1.0, |roll| roll.ratio * settings.root_angle_rad.sin());
            angle -= flank.side.facing(self.blank.hand)
                * (r.y.atan2(r.x) + self.half_angle_rad(flank.side));
            radius += 0.5 * r.x.hypot(r.y);
            match settings.face_mill() {
                None => cosine += 0.5,
                Some(mill) => {
                    // The root is cut on the machine's x axis, where the cutter's circle has this direction.
                    cosine += 0.5 * root.at[0].sin().abs();
                    let (sin, cos) = mill.blade_angle_rad.sin_cos();
                    edges += mill.edge_radius_m * (1.0 - sin) / cos;
                }
            }
        }
        Ok(Some(SlotWidth {
            point_m: angle * radius * cosine / slip + edges,
            edges_m: edges,
        }))
    }
}

fn along(blank: &MemberBlank, i: usize) -> f64 {
    blank.inner_cone_m() + blank.face_width_m * i as f64 / (ALONG - 1) as f64
}

fn check_envelope(flank: &Flank) -> Result<(), BevelError> {
    let blank = &flank.blank;
    let sign = flank.mean().point.area().signum();
    for i in 0..ALONG {
        let cone = along(blank, i);
        // From the pitch cone outwards: beyond a singular place the surface turns back.
        let look = |height: f64, found: Result<Located, BevelError>| match found {
            Ok(found) if found.point.area() * sign > 0.0 => Ok(found),
            _ => Err(BevelError::Undercut {
                flank: flank.name(),
                cone_mm: 1e3 * cone,
                height_mm: 1e3 * height,
            }),
        };
        let pitch = look(0.0, flank.locate(cone, 0.0))?;
        let bottom = flank.bottom(cone);
        let low = bottom
            .as_ref()
            .map_or(-blank.dedendum_m(cone), |b| flank.place(&b.point.r)[1]);
        look(low, bottom)?;
        for end in [low, blank.addendum_m(cone)] {
            let mut from = pitch;
            for k in 1..=UP {
                let height = end * k as f64 / UP as f64;
                from = look(height, flank.locate_from(cone, height, &from))?;
            }
        }
    }
    Ok(())
}
