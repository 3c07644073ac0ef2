//! Names of columns, parameters and objectives as a page shows them: words and a unit.

use crate::page::Axis;
use crate::short_number::usual_unit;

/// How units are written behind a name, longer ones before those that end them: with `_` as columns have them, a space
/// stands for it.
const UNITS: [(&str, &str); 38] = [
    ("N_per_mm_um", "N/(mm·µm)"),
    ("N_per_um", "N/µm"),
    ("Nm_per_rad", "N·m/rad"),
    ("mm_per_mm", "mm/mm"),
    ("mm_per_mrad", "mm/mrad"),
    ("rad_per_s2", "rad/s²"),
    ("rad_per_s", "rad/s"),
    ("m_per_s2", "m/s²"),
    ("m_per_s", "m/s"),
    ("mm2_per_s", "mm²/s"),
    ("sqrt_kg_m", "√kg·m"),
    ("N_per_mm", "N/mm"),
    ("N_per_m", "N/m"),
    ("ustrain", "µε"),
    ("N_s/mm", "N·s/mm"),
    ("N/mm", "N/mm"),
    ("N/um", "N/µm"),
    ("urad", "µrad"),
    ("mrad", "mrad"),
    ("rad", "rad"),
    ("Mrev", "10⁶ turns"),
    ("MPa", "MPa"),
    ("GPa", "GPa"),
    ("Pa", "Pa"),
    ("rpm", "rpm"),
    ("deg", "°"),
    ("kHz", "kHz"),
    ("Hz", "Hz"),
    ("um", "µm"),
    ("mm", "mm"),
    ("Nm", "N·m"),
    ("N_m", "N·m"),
    ("kN", "kN"),
    ("N", "N"),
    ("ms", "ms"),
    ("kg", "kg"),
    ("m", "m"),
    ("s", "s"),
];

/// `elements/mesh/normal_force_right` as `mesh: normal force right`.
pub(crate) fn readable(name: &str) -> String {
    let parts: Vec<&str> = name.split('/').skip(1).collect();
    match parts.split_last() {
        None => name.to_owned(),
        Some((last, [])) => last.replace('_', " "),
        Some((last, before)) => format!("{}: {}", before.join(" "), last.replace('_', " ")),
    }
}

/// A name in words, and its unit; empty where the name has none. `te_peak_to_peak_um` is the TE peak to peak in µm,
/// `elements/mesh/force_N:largest` the force of `mesh` in N.
#[must_use]
pub fn words_and_unit(name: &str) -> (String, &'static str) {
    // What stands behind a comma or a colon belongs to the words: "TE pk-pk um, weighted", COLUMN:FIGURE.
    let end = name.rfind([',', ':']).unwrap_or(name.len());
    let (name, behind) = name.split_at(end);
    let behind = match behind.strip_prefix(':') {
        Some(figure) => format!(", {}", figure.trim().replace('-', " ")),
        None => behind.to_owned(),
    };
    let found = UNITS.iter().find_map(|(written, unit)| {
        let stem = name
            .strip_suffix(written)
            .or_else(|| name.strip_suffix(&written.replace('_', " ")[..]))?;
        let stem = stem.strip_suffix(['_', ' '])?;
        (!stem.is_empty()).then_some((stem, *unit))
    });
    let (stem, unit) = found.unwrap_or((name, ""));
    let is_column = ["elements/", "bodies/", "joints/", "energy/", "run/"]
        .iter()
        .any(|kind| stem.starts_with(kind));
    let words = match stem {
        _ if is_column => readable(stem),
        "k_h_beta" | "K_Hbeta" => "K_Hbeta".to_owned(),
        // Names of files and keys stay as they are.
        _ if stem.contains(['/', '.', ' ']) => stem.to_owned(),
        _ => {
            let words = stem.replace('_', " ");
            match words.strip_prefix("te ") {
                Some(rest) => format!("TE {rest}"),
                None => words,
            }
        }
    };
    (words + &behind, unit)
}

/// The same of a parameter; where its name has no unit, that of the keys that it sets: `speed_rpm.step.to`.
pub(crate) fn parameter(name: &str, keys: &[String]) -> (String, &'static str) {
    let (words, unit) = words_and_unit(name);
    if !unit.is_empty() {
        return (words, unit);
    }
    let of_key = |key: &String| {
        let parts = key.rsplit(['.', ':']).map(|part| words_and_unit(part).1);
        parts.into_iter().find(|unit| !unit.is_empty())
    };
    let mut units = keys.iter().map(of_key);
    let first = units.next().flatten().unwrap_or("");
    let is_one = units.all(|unit| unit == Some(first));
    (words, if is_one { first } else { "" })
}

/// Words with the unit behind them, as heads of tables have it.
pub(crate) fn head((words, unit): (String, &str)) -> String {
    format!("{words} {unit}").trim_end().to_owned()
}

/// A column's words, its unit as people read it, and the factor that brings values there; `largest` is its largest
/// amount.
pub(crate) fn shown(name: &str, largest: f64) -> (String, &'static str, f64) {
    let (words, unit) = words_and_unit(name);
    let (factor, unit) = usual_unit(unit, largest);
    (words, unit, factor)
}

/// An axis of words and unit.
pub(crate) fn axis((words, unit): (String, &str)) -> Axis {
    Axis::new(words, unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_words_and_units() {
        for (name, words, unit) in [
            ("te_peak_to_peak_um", "TE peak to peak", "µm"),
            (
                "stiffness_secant_mean_N_per_mm_um",
                "stiffness secant mean",
                "N/(mm·µm)",
            ),
            ("k_h_beta", "K_Hbeta", ""),
            ("K_Hbeta", "K_Hbeta", ""),
            (
                "elements/mesh/normal_force_right_N",
                "mesh: normal force right",
                "N",
            ),
            (
                "elements/mesh/normal_force_right_N:peak-to-peak",
                "mesh: normal force right, peak to peak",
                "N",
            ),
            (
                "bodies/low shaft/angular_velocity_z_rad_per_s",
                "low shaft: angular velocity z",
                "rad/s",
            ),
            ("life_L10_Mrev", "life L10", "10⁶ turns"),
            ("TE pk-pk um, weighted", "TE pk-pk, weighted", "µm"),
            ("load N m", "load", "N·m"),
            ("damping N s/mm", "damping", "N·s/mm"),
            ("relief um", "relief", "µm"),
            ("bearing file", "bearing file", ""),
            ("um", "um", ""),
        ] {
            assert_eq!(words_and_unit(name), (words.to_owned(), unit), "{name}");
        }
        assert_eq!(shown("a/error_m", 3e-6).1, "µm");
        assert_eq!(head(words_and_unit("load N m")), "load N·m");
        let keys = |keys: &[&str]| keys.iter().map(|key| (*key).to_owned()).collect::<Vec<_>>();
        for (name, of, unit) in [
            ("speed", &["motion.0.speed_rpm.step.to"][..], "rpm"),
            ("load", &["operation.load_N.1"], "N"),
            ("bearing", &["bearing.1.model.file"], ""),
            ("both", &["a.width_mm", "b.relief_um"], ""),
            ("relief um", &["a.relief_um", "b.relief_um"], "µm"),
        ] {
            assert_eq!(parameter(name, &keys(of)).1, unit, "{name}");
        }
    }
}
