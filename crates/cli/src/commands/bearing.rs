//! `gearmesh bearing`: a rolling bearing under a load.

use super::{bearing_clearance, bearing_friction, bearing_page};
use crate::arguments::{BearingArguments, ControlWord};
use crate::console;
use gearmesh_bearings::bearing_file::BearingFromFile;
use gearmesh_bearings::definition::BearingGeometry;
use gearmesh_bearings::estimate::Estimate;
use gearmesh_bearings::frequencies::RollingSizes;
use gearmesh_bearings::life::Lubrication;
use gearmesh_bearings::quasi_static::RowLoads;
use gearmesh_bearings::warnings::Judged;
use gearmesh_bearings::{AppliedBearingLoad, TiltCondition};
use gearmesh_bearings::{
    BearingError, BearingWarning, Control, ElementLoad, FrictionTorque, Life, Operation,
    QuasiStaticBearing, Ratings, RingLoad, RingPose, StaticSafety,
};
use gearmesh_operations::{Failure, output_name, overwriting};
use serde_json::{Value, json};
use std::path::Path;

/// Reads a bearing file and tells its notes.
pub fn read(path: &Path) -> Result<BearingFromFile, Failure> {
    let found = BearingFromFile::read(path)?;
    found.unit_slips.iter().for_each(console::warning);
    found.notes.iter().for_each(console::note);
    found.warnings.iter().for_each(console::warning);
    Ok(found)
}

/// What rolls in a bearing, at its nominal contact angle or that of `--contact-angle-deg`.
pub fn sizes(
    found: &BearingFromFile,
    contact_angle_deg: Option<f64>,
) -> Result<RollingSizes, Failure> {
    let mut sizes = found.definition.rolling_sizes();
    if let Some(degrees) = contact_angle_deg {
        if !(0.0..90.0).contains(&degrees) {
            return Err(Failure::input(format!(
                "--contact-angle-deg: found {degrees}, allowed is 0 up to, not including, 90"
            )));
        }
        sizes.contact_angle_rad = degrees.to_radians();
    }
    Ok(sizes)
}

/// Everything that is printed.
pub(super) struct Answer<'a> {
    pub found: &'a BearingFromFile,
    pub bearing: &'a QuasiStaticBearing,
    pub pose: RingPose,
    pub ring: RingLoad,
    pub loads: RowLoads,
    pub ratings: Ratings,
    pub life: Life,
    pub friction: Option<FrictionTorque>,
    pub safety: Option<StaticSafety>,
    pub warnings: Vec<BearingWarning>,
}

/// Runs the command.
pub fn run(a: &BearingArguments) -> Result<(), Failure> {
    if let Some(path) = &a.report {
        overwriting::refuse(vec![a.bearing.clone()], std::slice::from_ref(path))?;
        output_name::demand_report(path)?;
    }
    let found = read(&a.bearing)?;
    let load = applied(a)?;
    let operation = operation(a)?;
    let lubrication = lubrication(a)?;
    let bearing = QuasiStaticBearing::new(&found.definition).map_err(Failure::work)?;
    refuse_faults_in_motion(&bearing)?;
    if bearing.aligns() && a.moment_Nm.iter().any(|moment| *moment != 0.0) {
        return Err(Failure::input(
            "--moment-Nm: a spherical roller bearing tilts freely and carries no moment; remove it, or give --tilt-mrad",
        ));
    }
    let (pose, mut places) =
        bearing
            .equilibrium_with_places(&load, &operation)
            .map_err(|e| match e {
                BearingError::NotCarried(_) => Failure::input(format!("--load-N: {e}")),
                e => Failure::work(e),
            })?;
    let (ring, loads) = bearing
        .loads_from(&pose, &operation, &mut places)
        .map_err(Failure::work)?;
    let life = Life::of(
        &found.definition,
        &loads,
        load.force_n,
        &operation,
        lubrication.as_ref(),
    );
    let friction = found.definition.friction;
    let friction = friction.map(|f| f.torque(&found.definition, &loads, &operation));
    let ratings = Ratings::of(&found.definition);
    let judged = Judged {
        definition: &found.definition,
        bearing: &bearing,
        pose: &pose,
        ring: &ring,
        loads: &loads,
        force_n: load.force_n,
        operation: &operation,
        life: &life,
    };
    let answer = Answer {
        friction,
        warnings: judged.warnings(),
        safety: StaticSafety::of(&found.definition, &ratings, load.force_n),
        ratings,
        found: &found,
        bearing: &bearing,
        pose,
        ring,
        loads,
        life,
    };
    if let Some(path) = &a.report {
        bearing_page::write(&answer, a, path)?;
    }
    answer.warnings.iter().for_each(console::warning);
    if a.json {
        console::json(&answer.figures());
    } else {
        answer.table();
    }
    Ok(())
}

/// Faults that say nothing of a bearing at rest.
fn refuse_faults_in_motion(bearing: &QuasiStaticBearing) -> Result<(), Failure> {
    let of_file = |problem: &str| Failure::input(format!("fault: {problem}"));
    bearing
        .refuse_spalled_balls()
        .map_err(|e| of_file(&e.to_string()))?;
    if bearing.misaligned.iter().any(Option::is_some) {
        return Err(of_file(
            "a misaligned ring tilts with the seat that carries it, which is known in a scene only; here remove it and give --tilt-mrad",
        ));
    }
    Ok(())
}

/// Numbers of an option: so many, finite, not too large.
fn numbers<const N: usize>(flag: &str, values: &[f64], largest: f64) -> Result<[f64; N], Failure> {
    let found: Vec<String> = values.iter().map(f64::to_string).collect();
    let sound = values.iter().all(|v| v.is_finite() && v.abs() <= largest);
    <[f64; N]>::try_from(values)
        .ok()
        .filter(|_| sound)
        .ok_or_else(|| {
            Failure::input(format!(
                "{flag}: found {}, allowed are {N} numbers between -{largest:e} and {largest:e}, separated by commas",
                found.join(",")
            ))
        })
}

fn applied(a: &BearingArguments) -> Result<AppliedBearingLoad, Failure> {
    let force_n = numbers("--load-N", &a.load_N, 1e9)?;
    let tilt = if !a.tilt_mrad.is_empty() {
        let [x, y] = numbers("--tilt-mrad", &a.tilt_mrad, 100.0)?;
        TiltCondition::Held([1e-3 * x, 1e-3 * y])
    } else if a.moment_Nm.is_empty() {
        TiltCondition::Moments([0.0; 2])
    } else {
        TiltCondition::Moments(numbers("--moment-Nm", &a.moment_Nm, 1e9)?)
    };
    Ok(AppliedBearingLoad { force_n, tilt })
}

fn operation(a: &BearingArguments) -> Result<Operation, Failure> {
    let rad_per_s = |rpm: f64| rpm * std::f64::consts::PI / 30.0;
    let [inner] = numbers("--speed-rpm", &[a.speed_rpm], 1e7)?;
    let [outer] = numbers("--outer-speed-rpm", &[a.outer_speed_rpm], 1e7)?;
    Ok(Operation {
        inner_rad_per_s: rad_per_s(inner),
        outer_rad_per_s: rad_per_s(outer),
        cage_angle_rad: 0.0,
        inner_angle_rad: 0.0,
        control: match a.control {
            ControlWord::OuterRace => Control::OuterRace,
            ControlWord::LeastSpin => Control::LeastSpin,
        },
    })
}

fn lubrication(a: &BearingArguments) -> Result<Option<Lubrication>, Failure> {
    let (Some(viscosity), Some(contamination)) = (a.viscosity_mm2_per_s, a.contamination) else {
        return Ok(None);
    };
    if !(viscosity > 0.0 && viscosity < 1e9) {
        return Err(Failure::input(format!(
            "--viscosity-mm2-per-s: found {viscosity}, allowed is more than 0, less than 1e9"
        )));
    }
    if !(0.0..=1.0).contains(&contamination) {
        return Err(Failure::input(format!(
            "--contamination: found {contamination}, allowed is 0 (dirty) to 1 (clean)"
        )));
    }
    if a.speed_rpm == a.outer_speed_rpm {
        return Err(Failure::input(
            "--viscosity-mm2-per-s: the modified life needs a speed; give --speed-rpm",
        ));
    }
    Ok(Some(Lubrication {
        viscosity_mm2_per_s: viscosity,
        contamination,
    }))
}

/// To so many decimals, without the sign of what is nothing then.
pub(super) fn rounded(value: f64, decimals: i32) -> f64 {
    let unit = 10.0_f64.powi(decimals);
    (value * unit).round() / unit + 0.0
}

impl Answer<'_> {
    pub fn of_rollers(&self) -> bool {
        matches!(self.found.definition.geometry, BearingGeometry::Roller(_))
    }

    /// Stiffness −∂load/∂(x, y, z, θx, θy), SI.
    pub fn stiffness(&self) -> Vec<Vec<f64>> {
        (0..5)
            .map(|i| (0..5).map(|j| -self.ring.tangent[(i, j)]).collect())
            .collect()
    }

    fn element(&self, row: usize, number: usize, e: &ElementLoad) -> Value {
        if !self.bearing.rows[row].has(number) {
            return json!({ "angle_deg": e.angle_rad.to_degrees(), "missing": true });
        }
        let [inner, outer] = self.bearing.rows[row].peak_pressures_pa(e);
        let mut value = json!({
            "angle_deg": e.angle_rad.to_degrees(),
            "inner_load_N": e.inner_load_n,
            "outer_load_N": e.outer_load_n,
            "inner_contact_angle_deg": e.inner_contact_angle_rad.to_degrees(),
            "outer_contact_angle_deg": e.outer_contact_angle_rad.to_degrees(),
            "inner_pressure_MPa": 1e-6 * inner,
            "outer_pressure_MPa": 1e-6 * outer,
            "centrifugal_N": e.centrifugal_n,
            "gyroscopic_Nm": e.gyroscopic_nm,
            "orbit_rad_per_s": e.orbit_rad_per_s,
            "spin_rad_per_s": e.spin_rad_per_s,
        });
        if let Some(other) = &e.other_side {
            value["other_side"] = json!({
                "inner_load_N": other.inner_load_n,
                "outer_load_N": other.outer_load_n,
                "inner_contact_angle_deg": other.inner_contact_angle_rad.to_degrees(),
                "outer_contact_angle_deg": other.outer_contact_angle_rad.to_degrees(),
            });
        }
        if self.of_rollers() {
            value["tilt_mrad"] = json!(1e3 * e.tilt_rad);
            value["rib_load_N"] = json!(e.rib_load_n);
            value["inner_line_load_N_per_mm"] = json!(1e-3 * e.inner_line_load_n_per_m);
            value["outer_line_load_N_per_mm"] = json!(1e-3 * e.outer_line_load_n_per_m);
        } else if let [Some(i), Some(o)] = self.bearing.rows[row].ellipses(e) {
            for (side, ellipse) in [("inner", i), ("outer", o)] {
                value[format!("{side}_half_length_mm")] = json!(1e3 * ellipse.half_length_m);
                value[format!("{side}_half_width_mm")] = json!(1e3 * ellipse.half_width_m);
            }
            value["controlled_by"] = json!(if e.controlled_by_inner {
                "inner"
            } else {
                "outer"
            });
        }
        value
    }

    /// Warnings of the file and of the equilibrium.
    fn told(&self) -> Vec<Value> {
        let of_file = self.found.warnings.iter();
        let of_file = of_file.map(|text| json!({"concern": "estimate", "text": text}));
        let own = self.warnings.iter().map(|warning| {
            json!({
                "concern": warning.concern.word(),
                "value": warning.value,
                "limit": warning.limit,
                "text": warning.text,
            })
        });
        of_file.chain(own).collect()
    }

    fn figures(&self) -> Value {
        let q = self.pose.to_five();
        let rows: Vec<Value> = (self.loads.elements.iter().enumerate())
            .map(|(row, list)| {
                let numbered = list.iter().enumerate();
                numbered
                    .map(|(number, e)| self.element(row, number, e))
                    .collect()
            })
            .collect();
        let finite = |value: f64| value.is_finite().then_some(value);
        let mut value = json!({
            "bearing": self.found.definition.name,
            "displacement_um": [1e6 * q[0], 1e6 * q[1], 1e6 * q[2]],
            "tilt_mrad": [1e3 * q[3], 1e3 * q[4]],
            "moment_Nm": [-self.ring.load[3], -self.ring.load[4]],
            "stiffness_SI": self.stiffness(),
            "preload_um": 1e6 * self.bearing.preload_m,
            "rows": rows,
            "ratings": {
                "dynamic_N": self.ratings.dynamic_n,
                "static_N": self.ratings.static_n,
                "fatigue_N": self.ratings.fatigue_n,
            },
            "life": {
                "L10_Mrev": self.life.basic_mrev.and_then(finite),
                "equivalent_N": self.life.equivalent_n,
                "L10r_Mrev": finite(self.life.reference_mrev),
                "reference_equivalent_N": self.life.reference_equivalent_n,
                "L10mr_Mrev": self.life.modified_mrev.and_then(finite),
            },
            "static_safety": self.safety.map(|safety| json!({
                "equivalent_N": safety.equivalent_n,
                "s0": finite(safety.factor),
            })),
            "warnings": self.told(),
        });
        if let Some(friction) = &self.friction {
            value["friction"] = bearing_friction::figures(friction);
        }
        if let Some(clearance) = self.found.definition.operating_clearance() {
            value["clearance"] = bearing_clearance::figures(&clearance);
        }
        if let Some(e) = &self.found.estimate {
            value["estimate"] = json!({
                "elements": e.elements,
                "elements_spread": e.elements_spread,
                "diameter_mm": 1e3 * e.diameter_m,
                "diameter_spread_mm": e.diameter_spread_m.map(|d| 1e3 * d),
                "length_mm": 1e3 * e.length_m,
                "length_spread_mm": e.length_spread_m.map(|d| 1e3 * d),
                "pitch_diameter_mm": 1e3 * e.pitch_m,
                "dynamic_N": e.dynamic_n,
                "static_N": e.static_n,
                "poor_fit": e.poor_fit,
                "dynamic_ratio": e.dynamic_ratio,
                "static_ratio": e.static_ratio,
            });
        }
        value
    }

    fn table(&self) {
        if let Some(estimate) = &self.found.estimate {
            console::data(estimate_line(estimate));
        }
        if let Some(clearance) = self.found.definition.operating_clearance() {
            let lines = bearing_clearance::lines(&clearance);
            lines.into_iter().for_each(console::data);
        }
        if self.bearing.preload_m != 0.0 {
            console::data(format!(
                "inner ring of each row pressed in by {:.4} um",
                1e6 * self.bearing.preload_m
            ));
        }
        let q = self.pose.to_five();
        console::data(format!(
            "{}: inner ring moves by x {:.4}, y {:.4}, z {:.4} um, tilts by {:.5}, {:.5} mrad; moment {:.4}, {:.4} N m",
            self.found.definition.name,
            rounded(1e6 * q[0], 4),
            rounded(1e6 * q[1], 4),
            rounded(1e6 * q[2], 4),
            rounded(1e3 * q[3], 5),
            rounded(1e3 * q[4], 5),
            rounded(-self.ring.load[3], 4),
            rounded(-self.ring.load[4], 4)
        ));
        let k = self.stiffness();
        console::data(format!(
            "stiffness: x {:.2}, y {:.2}, z {:.2} N/um; tilt {:.4e}, {:.4e} N m/rad",
            rounded(1e-6 * k[0][0], 2),
            rounded(1e-6 * k[1][1], 2),
            rounded(1e-6 * k[2][2], 2),
            k[3][3] + 0.0,
            k[4][4] + 0.0
        ));
        for row in 0..self.loads.elements.len() {
            self.row_table(row);
        }
        console::data(self.ratings_line());
        console::data(self.life_line());
        if let Some(friction) = &self.friction {
            console::data(bearing_friction::line(friction));
        }
    }

    /// Loads, contact angles and pressures of each element of a row.
    fn row_table(&self, row: usize) {
        if self.loads.elements.len() > 1 {
            console::data(format!("row {}", row + 1));
        }
        console::data(
            "    deg   load N: inner      outer   angle deg: inner   outer   pressure MPa: inner   outer",
        );
        for (number, e) in self.loads.elements[row].iter().enumerate() {
            let at_deg = e.angle_rad.to_degrees();
            if !self.bearing.rows[row].has(number) {
                console::data(format!("{at_deg:>7.2} {:>15}", "missing"));
                continue;
            }
            let [inner, outer] = self.bearing.rows[row].peak_pressures_pa(e);
            console::data(format!(
                "{at_deg:>7.2} {:>15.3} {:>10.3} {:>18.4} {:>7.4} {:>21.1} {:>7.1}",
                e.inner_load_n,
                e.outer_load_n,
                rounded(e.inner_contact_angle_rad.to_degrees(), 4),
                rounded(e.outer_contact_angle_rad.to_degrees(), 4),
                1e-6 * inner,
                1e-6 * outer
            ));
            if let Some(other) = &e.other_side {
                console::data(format!(
                    "  other side {:>12.3} {:>10.3} {:>18.4} {:>7.4}",
                    other.inner_load_n,
                    other.outer_load_n,
                    rounded(other.inner_contact_angle_rad.to_degrees(), 4),
                    rounded(other.outer_contact_angle_rad.to_degrees(), 4),
                ));
            }
        }
    }

    fn ratings_line(&self) -> String {
        let mut ratings = format!(
            "ratings: C {:.0} N, C0 {:.0} N, Cu {:.0} N",
            self.ratings.dynamic_n, self.ratings.static_n, self.ratings.fatigue_n
        );
        if let Some(safety) = self.safety.filter(|safety| safety.factor.is_finite()) {
            ratings += &format!(
                "; static safety s0 = C0/P0 {:.3}, P0 {:.0} N",
                safety.factor, safety.equivalent_n
            );
        }
        ratings
    }

    fn life_line(&self) -> String {
        let life = |value: Option<f64>| match value {
            Some(v) if v.is_finite() => format!("{v:.5e}"),
            Some(_) => "unlimited".to_owned(),
            None => "not given by ISO 281".to_owned(),
        };
        let mut text = format!(
            "life in million turns: L10 {}, L10r {}",
            life(self.life.basic_mrev),
            life(Some(self.life.reference_mrev))
        );
        if self.life.modified_mrev.is_some() {
            text += &format!(", L10mr {}", life(self.life.modified_mrev));
        }
        text
    }
}

fn estimate_line(e: &Estimate) -> String {
    let [few, many] = e.elements_spread;
    let [small, large] = e.diameter_spread_m.map(|d| 1e3 * d);
    let mut text = format!(
        "estimated: {} elements ({few} to {many}) of {:.3} mm ({small:.3} to {large:.3}) on {:.3} mm",
        e.elements,
        1e3 * e.diameter_m,
        1e3 * e.pitch_m
    );
    if e.length_m > 0.0 {
        let [short, long] = e.length_spread_m.map(|d| 1e3 * d);
        text += &format!(
            ", {:.3} mm long ({short:.3} to {long:.3})",
            1e3 * e.length_m
        );
    }
    text
}
