//! Keys of `[fit]`: how the rings are seated and how warm everything is.

use gearmesh_geometry::gear_file::PoissonRatio;
use gearmesh_geometry::input::{Bounded, InputDocument, NotNegative, TableKeys, Within};
use gearmesh_geometry::{InputError, given};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::element_keys::Clearances;
use super::{MM, UM};
use crate::definition::{BearingDefinition, BearingGeometry, BearingMaterial};
use crate::fit::{Fit, Seat, raceways_m};

/// Temperature at which sizes are stated \[°C\].
const COLD_C: f64 = 20.0;

/// Thermal expansion of steel where the file names none \[µm/(m K)\].
const STEEL_EXPANSION: f64 = 12.0;

/// Micrometres a metre and kelvin in 1/K.
const PER_K: f64 = 1e-6;

/// Temperatures of machines \[°C\].
type Temperature = Bounded<Within<-200, 500>>;

/// Thermal expansions of solids \[µm/(m K)\].
type Expansion = Bounded<Within<-5, 100>>;

/// `[fit]`: fits and temperatures, from which the clearance in operation follows.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub(super) struct FitTable {
    /// Shaft's diameter less the bore of the inner ring at 20 °C, smoothing of the surfaces taken off; negative: loose.
    /// Not given: the shaft does not press the ring, whatever the temperatures.
    shaft_interference_um: Option<f64>,
    /// Bore of a hollow shaft; 0, solid, where not given.
    shaft_bore_mm: Option<Bounded<NotNegative>>,
    /// Material of the shaft; steel where not given.
    shaft_material: Option<SeatMaterial>,
    /// Outside diameter of the outer ring less the housing's bore at 20 °C, smoothing taken off; negative: loose. Not
    /// given: the housing does not press the ring, whatever the temperatures.
    housing_interference_um: Option<f64>,
    /// Outside diameter of the housing; needed with `housing_interference_um`.
    housing_outside_diameter_mm: Option<f64>,
    /// Material of the housing; steel where not given.
    housing_material: Option<SeatMaterial>,
    /// Temperature of the inner ring in operation; 20 where neither ring has one.
    inner_ring_temperature_C: Option<Temperature>,
    /// Temperature of the outer ring; needed with that of the inner one.
    outer_ring_temperature_C: Option<Temperature>,
    /// Temperature of balls or rollers; the mean of the rings where not given.
    element_temperature_C: Option<Temperature>,
    /// Temperature of the shaft; that of the inner ring where not given.
    shaft_temperature_C: Option<Temperature>,
    /// Temperature of the housing; that of the outer ring where not given.
    housing_temperature_C: Option<Temperature>,
    /// Thermal expansion of the rings; 12, steel, where not given.
    ring_expansion_um_per_m_K: Option<Expansion>,
    /// Thermal expansion of balls or rollers; that of the rings where not given.
    element_expansion_um_per_m_K: Option<Expansion>,
}

/// `[fit.shaft_material]`, `[fit.housing_material]`: linear elastic, isotropic.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
struct SeatMaterial {
    /// Young's modulus.
    young_GPa: Bounded<Within<1, 1000>>,
    /// Poisson's ratio.
    poisson: Bounded<PoissonRatio>,
    /// Thermal expansion; 12, steel, where not given.
    expansion_um_per_m_K: Option<Expansion>,
}

/// Checks the table.
pub(super) fn fit(
    table: &FitTable,
    document: &InputDocument,
    (bore_m, outside_m): (Option<f64>, Option<f64>),
    geometry: &BearingGeometry,
) -> Result<Fit, InputError> {
    let top = TableKeys::new(document, "");
    let keys = TableKeys::new(document, "fit");
    if !geometry.is_classic() {
        return Err(keys.error(
            "",
            "is not used by four-point, thrust and spherical roller bearings: state the clearance in operation (radial_clearance_um) and remove the table",
        ));
    }
    let bore_m = top.needed("bore_mm", bore_m, "[fit]")?;
    let outside_m = top.needed("outside_diameter_mm", outside_m, "[fit]")?;
    let [inner_m, outer_m] = raceways_m(geometry);
    refuse_unused(table, &keys)?;
    if !(0.0 < bore_m && bore_m < inner_m && outer_m < outside_m) {
        return Err(keys.error(
            "",
            format!(
                "found a bore of {} and an outside diameter of {} mm; the inner ring must lie below its raceway of {:.3}, the outer one above {:.3} mm",
                bore_m / MM,
                outside_m / MM,
                inner_m / MM,
                outer_m / MM
            ),
        ));
    }
    let rises = Rises::of(table, &keys)?;
    let ring = (table.ring_expansion_um_per_m_K).map_or(STEEL_EXPANSION, f64::from);
    let element = table.element_expansion_um_per_m_K.map_or(ring, f64::from);
    let shaft = Seated {
        key: "shaft_interference_um",
        interference_um: table.shaft_interference_um,
        material: &table.shaft_material,
        diameter_m: bore_m,
        rise_k: rises.shaft,
    };
    let housing = Seated {
        key: "housing_interference_um",
        interference_um: table.housing_interference_um,
        material: &table.housing_material,
        diameter_m: outside_m,
        rise_k: rises.housing,
    };
    let shaft = shaft.seat(document, || {
        let bore = table.shaft_bore_mm.map_or(0.0, f64::from);
        let most = bore_m / MM;
        let allowed = format!("0 (solid) up to, not including, {most}, the bore of the bearing");
        keys.require("shaft_bore_mm", bore, bore < most, &allowed)?;
        Ok(bore)
    })?;
    let housing = housing.seat(document, || {
        let key = "housing_outside_diameter_mm";
        let outside = table.housing_outside_diameter_mm;
        let outside = keys.needed(key, outside, "housing_interference_um")?;
        let least = outside_m / MM;
        let allowed = format!("more than {least}, the outside diameter of the bearing");
        keys.require(key, outside, outside > least, &allowed)?;
        Ok(outside)
    })?;
    Ok(Fit {
        bore_m,
        outside_m,
        shaft,
        housing,
        ring_expansion_per_k: PER_K * ring,
        element_expansion_per_k: PER_K * element,
        inner_rise_k: rises.inner,
        outer_rise_k: rises.outer,
        element_rise_k: rises.element,
    })
}

/// Keys that describe a seat whose interference is not given.
fn refuse_unused(table: &FitTable, keys: &TableKeys<'_>) -> Result<(), InputError> {
    for ([(needs, is_there)], given) in [
        (
            given!(table; shaft_interference_um),
            given!(table; shaft_bore_mm, shaft_material, shaft_temperature_C),
        ),
        (
            given!(table; housing_interference_um),
            given!(table; housing_outside_diameter_mm, housing_material, housing_temperature_C),
        ),
    ] {
        if !is_there {
            let problem = format!("is not used without {needs}; remove it, or state the fit");
            keys.refuse(&given, problem)?;
        }
    }
    Ok(())
}

/// Temperatures above 20 °C \[K\].
struct Rises {
    inner: f64,
    outer: f64,
    element: f64,
    shaft: f64,
    housing: f64,
}

impl Rises {
    fn of(table: &FitTable, keys: &TableKeys<'_>) -> Result<Self, InputError> {
        let rise = |value: Temperature| *value - COLD_C;
        let (inner, outer) = (
            table.inner_ring_temperature_C,
            table.outer_ring_temperature_C,
        );
        let others = [
            ("element_temperature_C", table.element_temperature_C),
            ("shaft_temperature_C", table.shaft_temperature_C),
            ("housing_temperature_C", table.housing_temperature_C),
        ];
        let (inner, outer) = match (inner, outer) {
            (None, None) => {
                if let Some((key, _)) = others.iter().find(|(_, value)| value.is_some()) {
                    return Err(keys.error(
                        key,
                        "is given without inner_ring_temperature_C and outer_ring_temperature_C; give them, too",
                    ));
                }
                (0.0, 0.0)
            }
            (inner, outer) => {
                let by = "a bearing with temperatures";
                let inner = keys.needed("inner_ring_temperature_C", inner, by)?;
                let outer = keys.needed("outer_ring_temperature_C", outer, by)?;
                (rise(inner), rise(outer))
            }
        };
        let [element, shaft, housing] = others.map(|(_, value)| value.map(rise));
        Ok(Self {
            inner,
            outer,
            element: element.unwrap_or(0.5 * (inner + outer)),
            shaft: shaft.unwrap_or(inner),
            housing: housing.unwrap_or(outer),
        })
    }
}

/// A shaft or housing on its seat, as the file states it.
struct Seated<'a> {
    /// Key of the interference.
    key: &'static str,
    interference_um: Option<f64>,
    material: &'a Option<SeatMaterial>,
    /// Of the seat \[m\].
    diameter_m: f64,
    /// Temperature above 20 °C \[K\].
    rise_k: f64,
}

impl Seated<'_> {
    /// The seat, if there is an interference; `far_mm` checks the diameter on its far side.
    fn seat(
        &self,
        document: &InputDocument,
        far_mm: impl FnOnce() -> Result<f64, InputError>,
    ) -> Result<Option<Seat>, InputError> {
        let Some(interference_um) = self.interference_um else {
            return Ok(None);
        };
        let key = self.key;
        let most = 0.01 * self.diameter_m / UM;
        let allowed = format!("-{most:.0} to {most:.0}, a hundredth of the seat's diameter");
        let within = interference_um.abs() <= most;
        TableKeys::new(document, "fit").require(key, interference_um, within, &allowed)?;
        let far_diameter_m = MM * far_mm()?;
        let steel = BearingMaterial::STEEL;
        let (young_pa, poisson, expansion) = match self.material {
            None => (steel.young_pa, steel.poisson, None),
            Some(m) => (1e9 * m.young_GPa, *m.poisson, m.expansion_um_per_m_K),
        };
        Ok(Some(Seat {
            interference_m: UM * interference_um,
            far_diameter_m,
            young_pa,
            poisson,
            expansion_per_k: PER_K * expansion.map_or(STEEL_EXPANSION, f64::from),
            rise_k: self.rise_k,
        }))
    }
}

/// The clearance in operation must be one that a bearing can have.
pub(super) fn require_operating(
    definition: &BearingDefinition,
    document: &InputDocument,
) -> Result<(), InputError> {
    let Some(clearance) = definition.operating_clearance() else {
        return Ok(());
    };
    let range = match &definition.geometry {
        BearingGeometry::Ball(g) => {
            Clearances::of_balls(g.ball_diameter_m, 2.0 * g.groove_distance_m())
        }
        BearingGeometry::Roller(g) => Clearances::of_rollers(g.diameter_m),
    };
    let found = clearance.operating_m();
    if range.allows(found) {
        return Ok(());
    }
    Err(TableKeys::new(document, "fit").error(
        "",
        format!(
            "the radial clearance in operation is {:.1} um: stated {:.1}, shaft {:+.1}, housing {:+.1}, heat of the inner ring {:+.1}, of the outer one \
             {:+.1}, of the elements {:+.1}; allowed is {range}",
            found / UM,
            clearance.stated_m / UM,
            clearance.by_shaft_m / UM,
            clearance.by_housing_m / UM,
            clearance.by_inner_heat_m / UM,
            clearance.by_outer_heat_m / UM,
            clearance.by_element_heat_m / UM
        ),
    ))
}
