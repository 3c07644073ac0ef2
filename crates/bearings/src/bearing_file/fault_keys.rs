//! `[[fault]]`: what is wrong with a bearing.

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{
    Bounded, Count, End, InputDocument, NotNegative, Positive, TableKeys, Within,
};
use gearmesh_geometry::{kinds, number_range};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{MM, UM};
use crate::definition::{Arrangement, BallGeometry, BearingGeometry};
use crate::faults::{BallSpall, Fault, MisalignedRing, OffSizeBall, RaceSpall, Side, Waviness};

/// `race`, `ring`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SideWord {
    /// The inner ring.
    Inner,
    /// The outer ring.
    Outer,
}

impl SideWord {
    fn side(self) -> Side {
        match self {
            Self::Inner => Side::Inner,
            Self::Outer => Side::Outer,
        }
    }
}

/// A fault of a bearing.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(remote = "Self", rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(tag = "kind", rename = "BearingFaultTable")]
pub enum FaultTable {
    /// Material lost from a race.
    RaceSpall {
        /// The race.
        race: SideWord,
        /// The row, from 1; 1 where not given.
        row: Option<usize>,
        /// Its middle round the axis, from x towards y in the ring's own axes.
        angle_deg: f64,
        /// Its middle across the groove as a contact angle; the contact angle without load where not given.
        contact_angle_deg: Option<Bounded<ContactAngle>>,
        /// Along the way of the balls.
        length_mm: Bounded<Positive>,
        /// Across the groove; all of the groove where not given.
        width_mm: Option<Bounded<Positive>>,
        /// Depth. Between its rims a ball sinks no deeper than length and width let it.
        depth_um: Bounded<NotNegative>,
    },
    /// Material lost from a round patch of a ball; the bearing must be a `dynamic` one with traction.
    BallSpall {
        /// The row, from 1; 1 where not given.
        row: Option<usize>,
        /// The ball, from 1.
        ball: usize,
        /// Place along the track of the ball at the start: 0 faces the outer race, 180 the inner one; 0 where not
        /// given.
        angle_deg: Option<f64>,
        /// Place beside the track, towards +z; 0 where not given.
        beside_deg: Option<Bounded<Within<-90, 90>>>,
        /// Diameter of the patch.
        diameter_mm: Bounded<Positive>,
        /// Depth. Between its rims a race sinks no deeper than the diameter lets it.
        depth_um: Bounded<NotNegative>,
    },
    /// A race that is not round.
    Waviness {
        /// The race.
        race: SideWord,
        /// The row, from 1; 1 where not given.
        row: Option<usize>,
        /// Waves round the race.
        order: Count<1, 1000>,
        /// Amplitude across the axis; 0 where not given.
        radial_um: Option<Bounded<Within<0, 500>>>,
        /// Amplitude along the axis; 0 where not given.
        axial_um: Option<Bounded<Within<0, 500>>>,
        /// Phase: the groove is displaced by amplitude times cos(order times angle + phase); 0 where not given.
        phase_deg: Option<f64>,
    },
    /// A ball of another size.
    OffSizeBall {
        /// The row, from 1; 1 where not given.
        row: Option<usize>,
        /// The ball, from 1.
        ball: usize,
        /// By how much its diameter is larger; negative: smaller.
        oversize_um: f64,
    },
    /// A ball or roller that is not there.
    Missing {
        /// The row, from 1; 1 where not given.
        row: Option<usize>,
        /// The ball or roller, from 1.
        element: usize,
    },
    /// A ring that stands askew or aside on its seat.
    MisalignedRing {
        /// The ring.
        ring: SideWord,
        /// Tilt of its axis about x and y; 0 where not given.
        tilt_mrad: Option<[Bounded<Within<-100, 100>>; 2]>,
        /// Displacement along x, y, z; 0 where not given.
        offset_um: Option<[Bounded<Within<-1000, 1000>>; 3]>,
    },
}

kinds!(FaultTable, "kind");

number_range!(
    /// Contact angles of a groove, from one side to the other.
    pub ContactAngle: End::Beyond(-90.0), End::Beyond(90.0)
);

/// The faults of a list of tables `fault`, in SI units; what the bearing cannot have is refused.
pub(super) fn faults(
    tables: &[FaultTable],
    document: &InputDocument,
    geometry: &BearingGeometry,
    arrangement: &Arrangement,
) -> Result<Vec<Fault>, InputError> {
    let mut found: Vec<Fault> = Vec::with_capacity(tables.len());
    for (number, table) in tables.iter().enumerate() {
        let path = format!("fault.{number}");
        let keys = TableKeys::new(document, &path);
        let rows = arrangement.rows().len();
        let fault = table.fault(&keys, geometry, rows)?;
        if let Fault::MisalignedRing { side, .. } = fault {
            let same = |other: &Fault| matches!(other, Fault::MisalignedRing { side: of, .. } if *of == side);
            if found.iter().any(same) {
                return Err(keys.error(
                    "ring",
                    "a fault before this one misaligns the same ring; give one of them",
                ));
            }
        }
        found.push(fault);
    }
    refuse_absent(&found, document, geometry)?;
    Ok(found)
}

/// Row and ball as the user counts them, from 1.
fn place(
    keys: &TableKeys<'_>,
    (row, rows): (Option<usize>, usize),
    ball: Option<(usize, usize)>,
) -> Result<(usize, usize), InputError> {
    let row = row.unwrap_or(1);
    keys.require(
        "row",
        row as f64,
        (1..=rows).contains(&row),
        &format!("1 to {rows}, the rows of the bearing"),
    )?;
    let (ball, balls) = ball.unwrap_or((1, 1));
    keys.require(
        "ball",
        ball as f64,
        (1..=balls).contains(&ball),
        &format!("1 to {balls}, the balls of a row"),
    )?;
    Ok((row - 1, ball - 1))
}

impl FaultTable {
    fn fault(
        &self,
        keys: &TableKeys<'_>,
        geometry: &BearingGeometry,
        rows: usize,
    ) -> Result<Fault, InputError> {
        let balls = match geometry {
            BearingGeometry::Ball(g) if geometry.is_classic() => Some(g),
            BearingGeometry::Ball(_) | BearingGeometry::Roller(_) => None,
        };
        let needed = || {
            balls.ok_or_else(|| {
                keys.error("kind", "is a fault of deep-groove and angular-contact ball bearings; roller bearings can have \"misaligned-ring\" and \"missing\", others \"misaligned-ring\" only")
            })
        };
        match self {
            Self::RaceSpall { .. } => self.race_spall(keys, needed()?, rows),
            Self::BallSpall { .. } => self.ball_spall(keys, needed()?, rows),
            Self::Waviness { .. } => {
                needed()?;
                self.waviness(keys, rows)
            }
            Self::OffSizeBall {
                row,
                ball,
                oversize_um,
            } => {
                let g = needed()?;
                let (row, ball) = place(keys, (*row, rows), Some((*ball, g.balls)))?;
                let most = 0.01 * g.ball_diameter_m / UM;
                let sound = oversize_um.abs() <= most;
                let allowed =
                    format!("between -{most:.1} and {most:.1}, a hundredth of the ball's diameter");
                keys.require("oversize_um", *oversize_um, sound, &allowed)?;
                let size = OffSizeBall {
                    oversize_m: UM * oversize_um,
                };
                Ok(Fault::OffSizeBall { row, ball, size })
            }
            Self::Missing { .. } if !geometry.is_classic() => Err(keys.error(
                "kind",
                "found \"missing\", which four-point, thrust and spherical roller bearings do not have; they can have \"misaligned-ring\" only",
            )),
            Self::Missing { row, element } => missing(keys, (*row, rows), *element, geometry),
            Self::MisalignedRing {
                ring,
                tilt_mrad,
                offset_um,
            } => {
                if tilt_mrad.is_none() && offset_um.is_none() {
                    return Err(
                        keys.error("", "says neither tilt_mrad nor offset_um; give one of them")
                    );
                }
                Ok(Fault::MisalignedRing {
                    side: ring.side(),
                    place: MisalignedRing {
                        tilt_rad: tilt_mrad.map_or([0.0; 2], |tilt| tilt.map(|t| 1e-3 * t)),
                        offset_m: offset_um.map_or([0.0; 3], |offset| offset.map(|d| UM * d)),
                    },
                })
            }
        }
    }

    fn race_spall(
        &self,
        keys: &TableKeys<'_>,
        g: &BallGeometry,
        rows: usize,
    ) -> Result<Fault, InputError> {
        let Self::RaceSpall {
            race,
            row,
            angle_deg,
            contact_angle_deg,
            length_mm,
            width_mm,
            depth_um,
        } = self
        else {
            return Err(keys.error("kind", "is no race-spall"));
        };
        let (row, _) = place(keys, (*row, rows), None)?;
        // Longer than the way between two balls it would be another race.
        let most = std::f64::consts::PI * g.pitch_diameter_m / MM;
        let within = |key: &str, value: f64, most: f64| {
            keys.require(key, value, value <= most, &format!("at most {most:.3}"))
        };
        within("length_mm", **length_mm, 0.5 * most)?;
        if let Some(width) = width_mm {
            within("width_mm", **width, 2.0 * g.ball_diameter_m / MM)?;
        }
        depth(keys, **depth_um, g)?;
        Ok(Fault::RaceSpall {
            side: race.side(),
            row,
            spall: RaceSpall {
                angle_rad: angle_deg.to_radians(),
                contact_angle_rad: contact_angle_deg.map(|angle| angle.to_radians()),
                length_m: MM * *length_mm,
                width_m: width_mm.map(|w| MM * w),
                depth_m: UM * *depth_um,
            },
        })
    }

    fn ball_spall(
        &self,
        keys: &TableKeys<'_>,
        g: &BallGeometry,
        rows: usize,
    ) -> Result<Fault, InputError> {
        let Self::BallSpall {
            row,
            ball,
            angle_deg,
            beside_deg,
            diameter_mm,
            depth_um,
        } = self
        else {
            return Err(keys.error("kind", "is no ball-spall"));
        };
        let (row, ball) = place(keys, (*row, rows), Some((*ball, g.balls)))?;
        let most = g.ball_diameter_m / MM;
        let allowed = format!("at most {most:.3}, the ball's diameter");
        keys.require(
            "diameter_mm",
            **diameter_mm,
            **diameter_mm <= most,
            &allowed,
        )?;
        depth(keys, **depth_um, g)?;
        Ok(Fault::BallSpall {
            row,
            ball,
            spall: BallSpall {
                angle_rad: angle_deg.unwrap_or(0.0).to_radians(),
                beside_rad: beside_deg.map_or(0.0, |beside| beside.to_radians()),
                diameter_m: MM * *diameter_mm,
                depth_m: UM * *depth_um,
            },
        })
    }

    fn waviness(&self, keys: &TableKeys<'_>, rows: usize) -> Result<Fault, InputError> {
        let Self::Waviness {
            race,
            row,
            order,
            radial_um,
            axial_um,
            phase_deg,
        } = self
        else {
            return Err(keys.error("kind", "is no waviness"));
        };
        let (row, _) = place(keys, (*row, rows), None)?;
        if radial_um.is_none() && axial_um.is_none() {
            return Err(keys.error("", "says neither radial_um nor axial_um; give one of them"));
        }
        Ok(Fault::Waviness {
            side: race.side(),
            row,
            waves: Waviness {
                order: order.get() as u32,
                radial_m: radial_um.map_or(0.0, |amplitude| UM * amplitude),
                axial_m: axial_um.map_or(0.0, |amplitude| UM * amplitude),
                phase_rad: phase_deg.unwrap_or(0.0).to_radians(),
            },
        })
    }
}

fn missing(
    keys: &TableKeys<'_>,
    row: (Option<usize>, usize),
    element: usize,
    geometry: &BearingGeometry,
) -> Result<Fault, InputError> {
    let (row, _) = place(keys, row, None)?;
    let elements = geometry.elements();
    keys.require(
        "element",
        element as f64,
        (1..=elements).contains(&element),
        &format!("1 to {elements}, the balls or rollers of a row"),
    )?;
    Ok(Fault::Missing {
        row,
        element: element - 1,
    })
}

/// Complains about a fault of a ball that is missing, and about rows that are left with fewer than two elements.
fn refuse_absent(
    found: &[Fault],
    document: &InputDocument,
    geometry: &BearingGeometry,
) -> Result<(), InputError> {
    let absent = |at: (usize, usize)| {
        let mut all = found.iter();
        all.any(|f| matches!(*f, Fault::Missing { row, element } if (row, element) == at))
    };
    for (number, fault) in found.iter().enumerate() {
        let path = format!("fault.{number}");
        let keys = TableKeys::new(document, &path);
        match *fault {
            Fault::BallSpall { row, ball, .. } | Fault::OffSizeBall { row, ball, .. }
                if absent((row, ball)) =>
            {
                let problem = "another fault says that this ball is missing; remove one of the two";
                return Err(keys.error("ball", problem));
            }
            Fault::Missing { row, element } => {
                let alike = |f: &Fault| matches!(*f, Fault::Missing { row: r, .. } if r == row);
                if found[..number].contains(&Fault::Missing { row, element }) {
                    let problem =
                        "a fault before this one says that it is missing; remove one of the two";
                    return Err(keys.error("element", problem));
                }
                if found[..=number].iter().filter(|f| alike(f)).count() + 2 > geometry.elements() {
                    let problem = "fewer than two balls or rollers of the row are left; remove some of these faults";
                    return Err(keys.error("element", problem));
                }
            }
            _ => {}
        }
    }
    Ok(())
}

fn depth(keys: &TableKeys<'_>, depth_um: f64, g: &BallGeometry) -> Result<(), InputError> {
    let most = 0.1 * g.ball_diameter_m / UM;
    keys.require(
        "depth_um",
        depth_um,
        depth_um <= most,
        &format!("at most {most:.0}, a tenth of the ball's diameter"),
    )
}
