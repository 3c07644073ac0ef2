//! Ball bearings whose balls are bodies.

use gearmesh_bearings::dynamic::{
    FluidTraction, LandContact, LandFilm, LandGuide, LandSide, Pockets, Rebound, StatedContact,
    Traction, TriangleSize,
};
use gearmesh_bearings::quasi_static::Row;
use gearmesh_bearings::{BearingDefinition, DynamicBearing, DynamicEffects};
use gearmesh_geometry::InputError;
use gearmesh_geometry::input::TableKeys;
use gearmesh_specification::gear_tables::{MM, UM};
use gearmesh_specification::system::bearing::{
    DynamicBearingTable, LandTable, PocketTable, ReboundTable, SurfaceTable, TractionTable,
};

use super::cages::PlacedCage;
use super::placed_bearing::PlacedBearing;
use crate::system::assembly::bodies::Seat;
use crate::system::assembly::connections::Connections;
use crate::system::assembly::elements::PER_MM;

/// N/mm^1.5 in N/m^1.5.
const PER_MM_15: f64 = PER_MM * 31.622_776_601_683_793;
/// mPa in Pa.
const MILLI: f64 = 1e-3;

/// Adds one, and the lands that guide its cages.
pub(super) fn add(
    bearing: &PlacedBearing<'_>,
    model: &DynamicBearingTable,
    connections: &mut Connections<'_>,
) -> Result<(), InputError> {
    let (keys, bodies) = (&bearing.keys, connections.bodies);
    let rolling = bearing.rolling(&without_friction(bearing, &model.file)?)?;
    let mut effects = DynamicEffects {
        contact: contact(model, keys)?,
        rebound: rebound(model.rebound, "model.rebound", keys)?,
        traction: traction(model.traction.as_ref(), "model.traction", keys)?,
        surface: model.surface.map(triangles),
        gravity_m_per_s2: weight(model, connections.scene.tables.gravity_m_per_s2, keys)?,
        ..DynamicEffects::default()
    };
    let own = |cage: &&PlacedCage| cage.bearing == bearing.number;
    let cages: Vec<&PlacedCage> = connections.cages.iter().filter(own).collect();
    let mut lands = Vec::new();
    for (cage, table) in cages.iter().zip(model.cage.iter().cycle()) {
        let pockets = pockets(&table.pockets, keys)?;
        effects.cages.push((bodies.id(Some(cage.body)), pockets));
        if let (Some(land), Row::Ball(row)) = (&table.land, &rolling.rows[cage.row]) {
            let frame = bearing.seat.frame.raised(row.middle_z_m);
            let ring = bearing.seat.ends[usize::from(land.ring == LandSide::Inner)];
            let ends = [ring, Some(cage.body)];
            lands.push((Seat { ends, frame }, guide(land, keys)?));
        }
    }
    let (name, ends) = (&bearing.table.name, bearing.seat.ends);
    let key = match model.surface {
        Some(_) => "model.surface",
        None => "model",
    };
    let mut element = DynamicBearing::new(name, bodies.markers(&bearing.seat), &rolling, effects)
        .map_err(|e| keys.error(key, e))?;
    if model.ball_loads {
        element = element.with_ball_loads();
    }
    if model.ball_accelerations {
        element = element.with_ball_accelerations();
    }
    connections.element((name, "dynamic bearing"), &ends, element);
    for (place, (seat, guide)) in lands.into_iter().enumerate() {
        let name = match cages.len() {
            1 => format!("{name}/land"),
            _ => format!("{name}/land_{}", place + 1),
        };
        let element = guide.between(&name, bodies.markers(&seat));
        let element = element.map_err(|e| keys.error("model.cage.land", e))?;
        connections.element((&name, "cage land"), &seat.ends, element);
    }
    Ok(())
}

/// The bearing of balls that move: what they lose is the slip of their contacts, which a torque would count twice.
fn without_friction(
    bearing: &PlacedBearing<'_>,
    file: &str,
) -> Result<BearingDefinition, InputError> {
    let found = bearing.definition("model.file", file)?;
    if found.friction.is_some() {
        let problem = format!(
            "the bearing file {file} has [friction], which `dynamic` bearings do not use: what their balls lose is the slip of `traction`, and a torque would count it twice; remove the table, or take the model `quasi-static`, or `linear` with tangent_of"
        );
        return Err(bearing.keys.error("model.file", problem));
    }
    Ok(found)
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
        shape: table.shape,
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
        side: table.ring,
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
