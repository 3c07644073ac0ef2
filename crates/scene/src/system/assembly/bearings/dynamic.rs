//! Ball bearings whose balls are bodies.

use gearmesh_bearings::dynamic::{
    FluidTraction, LandContact, LandFilm, LandGuide, LandSide, PocketShape, Pockets, Rebound,
    StatedContact, Traction, TriangleSize,
};
use gearmesh_bearings::quasi_static::Row;
use gearmesh_bearings::{DynamicBearing, DynamicEffects, QuasiStaticBearing};
use gearmesh_geometry::InputError;
use gearmesh_geometry::input::TableKeys;
use nalgebra::Vector3;

use super::cages::PlacedCage;
use super::rolling_bearing;
use crate::system::assembly::bodies::Frame;
use crate::system::assembly::elements::{Connections, PER_MM, pair};
use crate::system::tables::bearing::{
    BearingTable, DynamicBearingTable, LandTable, PocketTable, PocketWord, ReboundTable, RingWord,
    SurfaceTable, TractionTable,
};
use crate::system::tables::{MM, UM};

/// N/mm^1.5 in N/m^1.5.
const PER_MM_15: f64 = PER_MM * 31.622_776_601_683_793;
/// mPa in Pa.
const MILLI: f64 = 1e-3;

/// Adds one, and the lands that guide its cages.
pub(super) fn add(
    number: usize,
    table: &BearingTable,
    model: &DynamicBearingTable,
    connections: &mut Connections<'_>,
) -> Result<(), InputError> {
    let named = (&*table.name, table.body_1.as_deref(), &*table.body_2);
    let (bodies, folder, gravity) = (
        connections.bodies,
        connections.folder,
        connections.gravity_m_per_s2,
    );
    let of_bearing = |cage: &&PlacedCage| cage.bearing == number;
    let cages: Vec<PlacedCage> = connections
        .manner
        .cages
        .iter()
        .filter(of_bearing)
        .copied()
        .collect();
    let mut lands = Vec::new();
    connections.add(
        ("bearing", number),
        "dynamic bearing",
        named,
        |keys, ends| {
            let frame = bodies.stated_frame(keys, ends[1], table.at_mm, table.axis)?;
            let definition =
                rolling_bearing::without_friction("model.file", &model.file, folder, keys)?;
            let bearing =
                QuasiStaticBearing::new(&definition).map_err(|e| keys.error("model", e))?;
            let mut effects = DynamicEffects {
                contact: contact(model, keys)?,
                rebound: rebound(model.rebound, "model.rebound", keys)?,
                traction: traction(model.traction.as_ref(), "model.traction", keys)?,
                surface: model.surface.map(triangles),
                gravity_m_per_s2: weight(model, gravity, keys)?,
                ..DynamicEffects::default()
            };
            if let Some(cage) = &model.cage {
                for placed in &cages {
                    let pockets = pockets(&cage.pockets, keys)?;
                    effects.cages.push((bodies.id(Some(placed.body)), pockets));
                    let (Some(land), Row::Ball(row)) = (&cage.land, &bearing.rows[placed.row])
                    else {
                        continue;
                    };
                    let middle = Vector3::new(0.0, 0.0, row.middle_z_m);
                    let at = Frame {
                        origin_m: frame.origin_m + frame.axes * middle,
                        axes: frame.axes,
                    };
                    lands.push((placed.body, at, guide(land, keys)?, land.ring));
                }
            }
            let element =
                DynamicBearing::new(&table.name, pair(bodies, ends, &frame), &bearing, effects)
                    .map_err(|e| {
                        keys.error(
                            if model.surface.is_some() {
                                "model.surface"
                            } else {
                                "model"
                            },
                            e,
                        )
                    })?;
            let element = if model.ball_loads {
                element.with_ball_loads()
            } else {
                element
            };
            Ok(Ok(if model.ball_accelerations {
                element.with_ball_accelerations()
            } else {
                element
            }))
        },
    )?;
    for (place, (cage, at, guide, ring)) in lands.into_iter().enumerate() {
        let name = if cages.len() == 1 {
            format!("{}/land", table.name)
        } else {
            format!("{}/land_{}", table.name, place + 1)
        };
        let ring = match ring {
            RingWord::Outer => table.body_1.as_deref(),
            RingWord::Inner => Some(&*table.body_2),
        };
        let named = (&*name, ring, bodies.name(Some(cage)));
        connections.add(("bearing", number), "cage land", named, |keys, ends| {
            let element = guide.between(&name, pair(bodies, ends, &at));
            Ok(Ok(element.map_err(|e| keys.error("model.cage.land", e))?))
        })?;
    }
    Ok(())
}

fn weight(
    model: &DynamicBearingTable,
    gravity_m_per_s2: Option<[f64; 3]>,
    keys: &TableKeys<'_>,
) -> Result<Option<[f64; 3]>, InputError> {
    match (model.ball_weight, gravity_m_per_s2) {
        (false, _) => Ok(None),
        (true, Some(gravity)) => Ok(Some(gravity)),
        (true, None) => Err(keys.error(
            "model.ball_weight",
            "needs the scene's gravity_m_per_s2, which is missing; state it, or remove this key",
        )),
    }
}

fn triangles(table: SurfaceTable) -> TriangleSize {
    let SurfaceTable::Triangles {
        across_um,
        along_um,
    } = table;
    TriangleSize {
        across_m: UM * across_um,
        along_m: UM * along_um,
    }
}

/// The stated law of the races' contacts.
fn contact(
    model: &DynamicBearingTable,
    keys: &TableKeys<'_>,
) -> Result<Option<StatedContact>, InputError> {
    let Some(table) = &model.contact else {
        return Ok(None);
    };
    if model.rebound.is_some() {
        let problem = "belongs to Hertz' contact; model.contact states its own damping; remove one of the two";
        return Err(keys.error("model.rebound", problem));
    }
    let depth_um = if table.damping_N_s_per_mm == 0.0 {
        table.full_damping_depth_um.unwrap_or(1.0)
    } else {
        keys.needed(
            "model.contact.full_damping_depth_um",
            table.full_damping_depth_um,
            "damping_N_s_per_mm",
        )?
    };
    let stated = StatedContact {
        stiffness_n_per_m_e: table.stiffness_N_per_mm_e * 1e3_f64.powf(table.exponent),
        exponent: table.exponent,
        damping_n_s_per_m: PER_MM * table.damping_N_s_per_mm,
        full_damping_depth_m: UM * depth_um,
    };
    let made = stated.validated();
    made.map(Some).map_err(|e| keys.error("model.contact", e))
}

fn rebound(
    table: Option<ReboundTable>,
    key: &str,
    keys: &TableKeys<'_>,
) -> Result<Rebound, InputError> {
    table.map_or(Ok(Rebound::default()), |table| {
        Rebound::from_restitution(table.restitution, MM * table.at_speed_mm_per_s)
            .map_err(|e| keys.error(key, e))
    })
}

fn traction(
    table: Option<&TractionTable>,
    key: &str,
    keys: &TableKeys<'_>,
) -> Result<Option<Traction>, InputError> {
    let made = match table {
        None => return Ok(None),
        Some(TractionTable::Coulomb {
            coefficient,
            transition_speed_mm_per_s,
        }) => Traction::coulomb(*coefficient, MM * transition_speed_mm_per_s),
        Some(TractionTable::Table {
            slip_mm_per_s,
            coefficient,
        }) => {
            if slip_mm_per_s.len() != coefficient.len() {
                let problem = format!(
                    "found {} coefficients for {} slips; give one for each",
                    coefficient.len(),
                    slip_mm_per_s.len()
                );
                return Err(keys.error(&format!("{key}.coefficient"), problem));
            }
            let slips = slip_mm_per_s.iter().map(|slip| MM * slip);
            let points: Vec<(f64, f64)> = slips.zip(coefficient.iter().copied()).collect();
            Traction::table(&points)
        }
        Some(TractionTable::Fluid {
            viscosity_mPa_s,
            pressure_viscosity_per_GPa,
            eyring_stress_MPa,
            film_thickness_um,
        }) => FluidTraction {
            viscosity_pa_s: MILLI * viscosity_mPa_s,
            pressure_viscosity_per_pa: 1e-9 * pressure_viscosity_per_GPa,
            eyring_stress_pa: 1e6 * eyring_stress_MPa,
            film_thickness_m: UM * film_thickness_um,
        }
        .validated()
        .map(Traction::Fluid),
    };
    made.map(Some).map_err(|e| keys.error(key, e))
}

fn pockets(table: &PocketTable, keys: &TableKeys<'_>) -> Result<Pockets, InputError> {
    let key = "model.cage.pockets";
    let pockets = Pockets {
        shape: match table.shape {
            PocketWord::Cylindrical => PocketShape::Cylindrical,
            PocketWord::Spherical => PocketShape::Spherical,
        },
        clearance_m: UM * table.clearance_um,
        film_stiffness_n_per_m: PER_MM * table.film_stiffness_N_per_mm,
        contact_stiffness_n_per_m15: PER_MM_15 * table.stiffness_N_per_mm_e,
        rebound: rebound(table.rebound, &format!("{key}.rebound"), keys)?,
        traction: traction(table.traction.as_ref(), &format!("{key}.traction"), keys)?,
    };
    pockets.validated().map_err(|e| keys.error(key, e))
}

fn guide(table: &LandTable, keys: &TableKeys<'_>) -> Result<LandGuide, InputError> {
    Ok(LandGuide {
        side: match table.ring {
            RingWord::Outer => LandSide::Outer,
            RingWord::Inner => LandSide::Inner,
        },
        radius_m: 0.5 * MM * table.diameter_mm,
        clearance_m: UM * table.clearance_um,
        film: table.film.map(|film| LandFilm {
            viscosity_pa_s: MILLI * film.viscosity_mPa_s,
            width_m: MM * film.width_mm,
        }),
        contact: LandContact {
            stiffness_n_per_m15: PER_MM_15 * table.stiffness_N_per_mm_e,
            roughness_m: UM * table.roughness_um,
            rebound: rebound(table.rebound, "model.cage.land.rebound", keys)?,
            friction: table
                .friction
                .map(|f| (f.coefficient, MM * f.transition_speed_mm_per_s)),
        },
    })
}
