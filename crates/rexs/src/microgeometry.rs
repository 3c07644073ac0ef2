//! Flank modifications: reliefs, crownings, slopes, twist, topography.

use crate::cylindrical::Gear;
pub use crate::cylindrical::Microgeometry;
use crate::error::Result;
use crate::gearbox::Train;
use crate::ledger::About;
use crate::source::{Part, Source};
use crate::text::{number, numbers};
use crate::units::MM;
use std::collections::HashSet;

/// Micrometres in a millimetre.
const UM_PER_MM: f64 = 1e3;

/// Components that modify a flank and have a counterpart in gear files.
const READ: [&str; 8] = [
    "tip_relief",
    "root_relief",
    "profile_crowning",
    "profile_slope",
    "helix_crowning",
    "helix_slope",
    "profile_twist",
    "topographical_modification",
];

/// End reliefs.
const ENDS: [&str; 2] = ["end_relief_datum_face", "end_relief_non_datum_face"];

/// Those that have none.
const UNREAD: [&str; 4] = [
    "triangular_tip_relief",
    "triangular_root_relief",
    "profile_deviation",
    "helix_deviation",
];

/// Reads the modifications of all gears.
///
/// # Errors
/// Those of [`Part`].
pub fn of_train(source: &Source<'_>, train: &mut Train) -> Result<()> {
    let in_sets = train.sets.iter().flat_map(|set| &set.against_u);
    let in_sets: HashSet<usize> = in_sets.copied().collect();
    for i in 0..train.gears.len() {
        let gear = &train.gears[i].gear;
        let Some(component) = source.part(gear.id) else {
            continue;
        };
        let is_reversed = match train.shaft(train.gears[i].shaft) {
            Some(shaft) => shaft.is_reversed,
            None => in_sets.contains(&i),
        };
        train.gears[i].gear.microgeometry = read(component, gear, is_reversed)?;
    }
    Ok(())
}

/// Reads the modifications of both flanks. `is_reversed`: z of the gear file, which is that of the scene's shaft or
/// planetary set, is −u.
///
/// # Errors
/// Those of [`Part`].
pub fn read(component: Part<'_>, gear: &Gear, is_reversed: bool) -> Result<Microgeometry> {
    let flanks = component.flanks();
    // The datum face looks to -u unless the file says otherwise.
    let datum_along_u = component.text("datum_face_orientation").as_deref() == Some("positive");
    let datum_is_positive = datum_along_u != is_reversed;
    let mut sides = [Vec::new(), Vec::new()];
    for (side, flank) in sides.iter_mut().zip(flanks) {
        let Some(flank) = flank else { continue };
        let reader = Reader {
            gear,
            datum_is_positive,
            is_reversed,
        };
        let found = |kinds: &[&str]| flank.parts(kinds);
        let mut seen: Vec<&str> = Vec::new();
        for m in found(&READ) {
            if seen.contains(&m.kind.as_str()) {
                m.leave_out(About::Flanks, "a second one of its kind on the same flank");
                continue;
            }
            seen.push(&m.component.kind);
            side.extend(reader.modification(m)?);
        }
        side.extend(reader.ends(&found(&ENDS).collect::<Vec<_>>())?);
        for m in found(&UNREAD) {
            m.leave_out(About::Flanks, "gear files have no such modification; give it as a topography or as an error of the mesh");
        }
    }
    let [left, right] = sides;
    if left != right {
        component.assume(
            About::Flanks,
            "left and right flanks as seen from the end of the shaft at higher u, tips upwards",
        );
    }
    // Seen from the other end they change places. So do those of a ring: gear files call the flank that faces clockwise
    // the right one, which is on the left where tips point inwards and upwards.
    let [left, right] = if is_reversed != gear.internal {
        [right, left]
    } else {
        [left, right]
    };
    Ok(Microgeometry { left, right })
}

type Keys = Vec<(String, String)>;

fn key(name: &str, value: f64) -> (String, String) {
    (name.to_owned(), number(value))
}

struct Reader<'a> {
    gear: &'a Gear,
    /// Whether the datum face looks to +z.
    datum_is_positive: bool,
    /// Whether z is −u.
    is_reversed: bool,
}

impl Reader<'_> {
    fn amount_um(&self, m: Part<'_>, id: &str) -> Result<Option<f64>> {
        let found = m
            .number(id, MM)?
            .map(|mm| UM_PER_MM * mm)
            .filter(|um| *um != 0.0);
        if let Some(um) = found.filter(|um| um.abs() > 1000.0) {
            let what = format!("{id} of {um} um: more than 1000 is no modification");
            m.leave_out(About::Flanks, what);
            return Ok(None);
        }
        Ok(found)
    }

    /// A diameter, or the rolling length to it.
    fn diameter_mm(&self, m: Part<'_>, diameter: &str, length: &str) -> Result<Option<f64>> {
        if let Some(d) = m.number(diameter, MM)? {
            return Ok(Some(self.unsigned(d)));
        }
        let base = 0.5 * self.gear.base_diameter_mm();
        Ok(m.number(length, MM)?.map(|roll| 2.0 * base.hypot(roll)))
    }

    /// A diameter without the sign that ISO 21771 gives to those of rings.
    fn unsigned(&self, diameter_mm: f64) -> f64 {
        match self.gear.internal {
            true => diameter_mm.abs(),
            false => diameter_mm,
        }
    }

    fn shape(&self, m: Part<'_>) -> &'static str {
        let shape = m.text("shape_of_relief");
        match shape.as_deref() {
            Some("parabolic") => "parabolic",
            Some("circular") => "arc",
            Some("linear") => "linear",
            Some(other) => {
                let what = format!("shape `{other}`: taken as parabolic");
                m.leave_out(About::Flanks, what);
                "parabolic"
            }
            None => {
                m.assume(About::Flanks, "no shape given: linear");
                "linear"
            }
        }
    }

    fn modification(&self, m: Part<'_>) -> Result<Keys> {
        match m.kind.as_str() {
            "tip_relief" => self.relief(m, "tip_relief"),
            "root_relief" => self.relief(m, "root_relief"),
            "profile_crowning" => self.profile_crowning(m),
            "profile_slope" => {
                let sign = "sign: positive removes towards the tip; over the whole involute";
                self.slope(m, ("profile_slope", "profile_angle_um"), sign, false)
            }
            "helix_crowning" => self.helix_crowning(m),
            "helix_slope" => {
                let sign = "sign: positive removes towards the face that is not the datum face";
                self.slope(m, ("helix_slope", "flank_angle_um"), sign, true)
            }
            "profile_twist" => {
                let sign = "sign: positive where the profile's slope grows from the datum face on";
                self.slope(m, ("profile_twist", "twist_um"), sign, true)
            }
            _ => self.topography(m),
        }
    }

    fn profile_crowning(&self, m: Part<'_>) -> Result<Keys> {
        let tip = self.amount_um(m, "profile_crowning_at_tip")?;
        let root = self.amount_um(m, "profile_crowning_at_root")?;
        let highest = m.number("profile_highest_point", MM)?;
        let Some(tip) = tip.or(root) else {
            return Ok(Vec::new());
        };
        if let Some(root) = root.filter(|root| *root != tip) {
            m.leave_out(About::Flanks, format!("{root} um at the root: one parabola from the highest point on, {tip} um at the tip"));
        }
        let middle = highest.map_or_else(
            || {
                let what = "no highest point given: the reference circle";
                m.assume(About::Flanks, what);
                self.gear.reference_diameter_mm()
            },
            |d| self.unsigned(d),
        );
        Ok(vec![
            key("profile_crowning_um", tip),
            key("profile_crowning_diameter_mm", middle),
        ])
    }

    fn helix_crowning(&self, m: Part<'_>) -> Result<Keys> {
        let ends = [
            self.amount_um(m, "helix_crowning_amount_datum_face")?,
            self.amount_um(m, "helix_crowning_amount_non_datum_face")?,
        ];
        let [Some(a), Some(b)] = [ends[0].or(ends[1]), ends[1].or(ends[0])] else {
            return Ok(Vec::new());
        };
        if a != b {
            let what = format!("{a} and {b} um at the two faces: their mean at both");
            m.leave_out(About::Flanks, what);
        }
        Ok(vec![key("lead_crowning_um", 0.5 * (a + b))])
    }

    /// An amount under a key of ours. `from_datum`: its sign depends on where the datum face is.
    fn slope(
        &self,
        m: Part<'_>,
        (id, ours): (&str, &str),
        sign: &str,
        from_datum: bool,
    ) -> Result<Keys> {
        let Some(amount) = self.amount_um(m, id)? else {
            return Ok(Vec::new());
        };
        m.assume(About::Flanks, sign);
        let is_reversed = from_datum && self.datum_is_positive;
        Ok(vec![key(ours, if is_reversed { -amount } else { amount })])
    }

    fn relief(&self, m: Part<'_>, name: &str) -> Result<Keys> {
        let Some(amount) = self.amount_um(m, &format!("{name}_depth"))? else {
            return Ok(Vec::new());
        };
        let start = self.diameter_mm(
            m,
            &format!("{name}_datum_diameter"),
            &format!("{name}_datum_length"),
        )?;
        let Some(start) = start else {
            m.leave_out(
                About::Flanks,
                format!("{amount} um: neither a diameter nor a length at which it begins is given"),
            );
            return Ok(Vec::new());
        };
        let tip = self.gear.tip_mm();
        let [low, high] = match self.gear.internal {
            true => [tip, self.gear.root_diameter_mm()],
            false => [self.gear.base_diameter_mm(), tip],
        };
        if !(low..high).contains(&start) {
            m.leave_out(About::Flanks, format!("{amount} um from a diameter of {start:.4} mm on: not on the flank, {low:.4} to {high:.4} mm"));
            return Ok(Vec::new());
        }
        Ok(vec![
            key(&format!("{name}_um"), amount),
            key(&format!("{name}_start_diameter_mm"), start),
            (format!("{name}_shape"), format!("\"{}\"", self.shape(m))),
        ])
    }

    fn ends(&self, ends: &[Part<'_>]) -> Result<Keys> {
        let mut found: Vec<(f64, f64, &str, bool)> = Vec::new();
        for &m in ends {
            let is_datum = m.kind == ENDS[0];
            let face = if is_datum {
                "datum_face"
            } else {
                "non_datum_face"
            };
            let amount = self.amount_um(m, &format!("end_relief_depth_{face}"))?;
            let length = m.number(&format!("end_relief_length_{face}"), MM)?;
            match (amount, length) {
                (Some(amount), Some(length))
                    if length > 0.0 && length < self.gear.face_width_mm =>
                {
                    found.push((
                        amount,
                        length,
                        self.shape(m),
                        is_datum == self.datum_is_positive,
                    ));
                }
                (None, _) => {}
                _ => m.leave_out(About::Flanks, "end relief without a length on the face"),
            }
        }
        let Some(&(amount, length, shape, is_positive)) = found.first() else {
            return Ok(Vec::new());
        };
        let end = match found.get(1) {
            None if is_positive => "+z",
            None => "-z",
            Some(second) => {
                if (second.0, second.1, second.2) != (amount, length, shape) {
                    ends[1].leave_out(
                        About::Flanks,
                        "another end relief than at the other face: both have that of the first",
                    );
                }
                "both"
            }
        };
        Ok(vec![
            key("end_relief_um", amount),
            key("end_relief_length_mm", length),
            ("end_relief_shape".to_owned(), format!("\"{shape}\"")),
            ("end_relief_end".to_owned(), format!("\"{end}\"")),
        ])
    }

    /// A table: amounts at diameters times places over the face, the places running fastest.
    fn topography(&self, m: Part<'_>) -> Result<Keys> {
        let diameters = m.list("diameters_of_topographical_modification", MM)?;
        let places = m.list("coordinates_of_topographical_modification", MM)?;
        let amounts = m.list("topographical_modification_amounts", MM)?;
        let (Some(diameters), Some(places), Some(amounts)) = (diameters, places, amounts) else {
            let what = "topography without diameters, coordinates and amounts";
            m.leave_out(About::Flanks, what);
            return Ok(Vec::new());
        };
        let increasing =
            |values: &[f64]| values.len() > 1 && values.windows(2).all(|w| w[0] < w[1]);
        let is_signed = diameters.iter().any(|d| *d <= 0.0);
        if is_signed
            || !increasing(&diameters)
            || !increasing(&places)
            || amounts.len() != diameters.len() * places.len()
        {
            m.leave_out(About::Flanks, format!(
                    "topography of {} diameters, {} places and {} amounts: no full grid of increasing points, diameters without sign",
                    diameters.len(),
                    places.len(),
                    amounts.len()
                ),
            );
            return Ok(Vec::new());
        }
        m.assume(About::Flanks, "places over the face count from the face at the lower u; positive amounts remove material");
        let half = 0.5 * self.gear.face_width_mm;
        // z increases, as u does; against u the table runs from its other end.
        let along_z = |mut values: Vec<f64>| {
            if self.is_reversed {
                values.reverse();
            }
            values
        };
        let sign = if self.is_reversed { -1.0 } else { 1.0 };
        let z = along_z(places.iter().map(|b| sign * (b - half)).collect());
        let rows: Vec<String> = amounts
            .chunks(places.len())
            .map(|row| numbers(&along_z(row.iter().map(|mm| UM_PER_MM * mm).collect())))
            .collect();
        let table = format!(
            "{{ diameter_mm = {}, z_mm = {}, removed_um = [{}] }}",
            numbers(&diameters),
            numbers(&z),
            rows.join(", ")
        );
        Ok(vec![("topography".to_owned(), table)])
    }
}
