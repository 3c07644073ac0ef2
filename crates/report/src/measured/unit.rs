//! Units of measured channels, in the spellings of measuring programs.

use super::{Channel, MeasuredError};

/// A quantity that a record needs, with the units that are understood and their factors.
pub(super) struct Units {
    /// What it is, for messages.
    pub what: &'static str,
    /// Spelling (small letters, `u` for µ) and the value of one unit in the unit of the table.
    pub known: &'static [(&'static str, f64)],
}

const DEG: f64 = 180.0 / std::f64::consts::PI;

/// Angles in degrees.
pub(super) const ANGLE_DEG: Units = Units {
    what: "an angle",
    known: &[
        ("deg", 1.0),
        ("°", 1.0),
        ("degree", 1.0),
        ("degrees", 1.0),
        ("gon", 0.9),
        ("rad", DEG),
        ("mrad", 1e-3 * DEG),
        ("urad", 1e-6 * DEG),
        ("arcmin", 1.0 / 60.0),
        ("arcsec", 1.0 / 3600.0),
        ("\"", 1.0 / 3600.0),
        ("″", 1.0 / 3600.0),
        ("bogensekunden", 1.0 / 3600.0),
        ("winkelsekunden", 1.0 / 3600.0),
        ("winkelminuten", 1.0 / 60.0),
        ("rev", 360.0),
        ("revolutions", 360.0),
        ("turn", 360.0),
        ("turns", 360.0),
        ("u", 360.0),
        ("umdr", 360.0),
        ("umdrehungen", 360.0),
    ],
};

/// Lengths in micrometres.
pub(super) const LENGTH_UM: Units = Units {
    what: "a transmission error",
    known: &[
        ("um", 1.0),
        ("mm", 1e3),
        ("m", 1e6),
        ("nm", 1e-3),
        ("in", 25.4e3),
        ("inch", 25.4e3),
        ("mil", 25.4),
        ("thou", 25.4),
        ("uin", 25.4e-3),
    ],
};

/// Strains in microstrain.
pub(super) const STRAIN_USTRAIN: Units = Units {
    what: "a strain",
    known: &[
        ("ustrain", 1.0),
        ("ue", 1.0),
        ("uε", 1.0),
        ("microstrain", 1.0),
        ("um/m", 1.0),
        ("mm/m", 1e3),
        ("%", 1e4),
        ("m/m", 1e6),
        ("strain", 1e6),
        ("1", 1e6),
        ("-", 1e6),
    ],
};

/// Times in seconds.
pub(super) const TIME_S: Units = Units {
    what: "a time",
    known: &[("s", 1.0), ("sec", 1.0), ("ms", 1e-3)],
};

impl Units {
    /// Value of one of these units, or of a part of it such as `rev/1024` (a pulse of an encoder); none where it is of
    /// another quantity.
    pub fn factor(&self, unit: &str) -> Option<f64> {
        // German: a degree. In small letters it may be that or a gon, and is asked for.
        let unit = plain(if unit.trim() == "Grad" { "deg" } else { unit });
        let of = |wanted: &str| {
            let found = self.known.iter().find(|(name, _)| *name == wanted);
            found.map(|(_, factor)| *factor)
        };
        of(&unit).or_else(|| {
            let (whole, parts) = unit.split_once('/')?;
            let parts = parts.parse::<f64>().ok()?;
            (parts.is_finite() && parts >= 1.0).then(|| of(whole).map(|one| one / parts))?
        })
    }

    /// The same of a channel's unit.
    ///
    /// # Errors
    /// [`MeasuredError::Unit`] that lists what is understood.
    pub fn factor_of(&self, name: &str, unit: &str) -> Result<f64, MeasuredError> {
        let known: Vec<&str> = self.known.iter().map(|(name, _)| *name).collect();
        self.factor(unit).ok_or_else(|| MeasuredError::Unit {
            name: name.to_owned(),
            found: unit.to_owned(),
            what: self.what,
            allowed: known.join(" ")
                + if self.known == ANGLE_DEG.known {
                    "; pulses of an encoder are parts of a turn, such as rev/1024"
                } else {
                    ""
                },
        })
    }
}

/// Whether any quantity has this unit.
pub(super) fn is_known(unit: &str) -> bool {
    [ANGLE_DEG, LENGTH_UM, STRAIN_USTRAIN, TIME_S]
        .iter()
        .any(|units| units.factor(unit).is_some())
}

/// Small letters, both letters mu as `u`, no blanks.
fn plain(unit: &str) -> String {
    let letters = unit.chars().filter(|c| !c.is_whitespace());
    let letters = letters.map(|c| if matches!(c, 'µ' | 'μ') { 'u' } else { c });
    letters.flat_map(char::to_lowercase).collect()
}

/// States the units of channels that the file leaves open or gets wrong; a name may be that of the axis.
///
/// # Errors
/// [`MeasuredError::NoChannel`] for a name that is neither a channel nor an axis.
pub(super) fn state_units(
    channels: &mut [Channel],
    stated: &[(String, String)],
) -> Result<(), MeasuredError> {
    for (name, unit) in stated {
        let mut found = false;
        for channel in channels.iter_mut() {
            if channel.name == *name {
                channel.unit.clone_from(unit);
                found = true;
            }
            if channel.axis == *name {
                channel.axis_unit.clone_from(unit);
                found = true;
            }
        }
        if !found {
            let axes = channels.first().map(|c| c.axis.clone());
            let names: Vec<String> = channels
                .iter()
                .map(|c| c.name.clone())
                .chain(axes)
                .collect();
            return Err(MeasuredError::NoChannel {
                wanted: name.clone(),
                known: names.join("; "),
            });
        }
    }
    Ok(())
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn spellings_of_one_unit_are_the_same() {
        for unit in ["µm", "μm", "um", " UM "] {
            assert_eq!(LENGTH_UM.factor(unit), Some(1.0), "{unit}");
        }
        assert_eq!(STRAIN_USTRAIN.factor("µm/m"), Some(1.0));
        assert_eq!(STRAIN_USTRAIN.factor("%"), Some(1e4));
        assert!((ANGLE_DEG.factor("rad").unwrap() - 57.295_779_513_082_32).abs() < 1e-12);
        assert!((ANGLE_DEG.factor("arcsec").unwrap() * 3600.0 - 1.0).abs() < 1e-15);
        for (unit, um) in [("in", 25_400.0), ("mil", 25.4), ("µin", 0.0254)] {
            assert!(
                (LENGTH_UM.factor(unit).unwrap() / um - 1.0).abs() < 1e-15,
                "{unit}"
            );
        }
        assert_eq!(ANGLE_DEG.factor("turns"), Some(360.0));
        for (unit, deg) in [
            ("Grad", 1.0),
            ("gon", 0.9),
            ("U", 360.0),
            ("rev/1024", 360.0 / 1024.0),
        ] {
            assert_eq!(ANGLE_DEG.factor(unit), Some(deg), "{unit}");
        }
        for unit in ["grad", "rev/0", "rev/", "pulses", "rev/x", "1/5"] {
            assert_eq!(ANGLE_DEG.factor(unit), None, "{unit}");
        }
        assert_eq!(STRAIN_USTRAIN.factor("-"), Some(1e6));
        let message = LENGTH_UM.factor_of("TE", "N").unwrap_err().to_string();
        assert!(
            message.contains("`N`") && message.contains("um mm m nm"),
            "{message}"
        );
    }
}
