//! Units of REXS files and the ways in which programs spell them.

/// What a unit measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dimension {
    /// A plain number; a percentage is a hundredth.
    One,
    /// Length, SI m.
    Length,
    /// Angle, SI rad.
    Angle,
    /// Force, SI N.
    Force,
    /// Torque, SI N m.
    Torque,
    /// Turning speed, SI rad/s.
    Speed,
    /// Stress, SI Pa.
    Stress,
    /// Density, SI kg/m³.
    Density,
    /// Mass, SI kg.
    Mass,
    /// Moment of inertia, SI kg m².
    Inertia,
    /// Stiffness, SI N/m.
    Stiffness,
    /// Rotational stiffness, SI N m/rad.
    RotationalStiffness,
    /// Time, SI s.
    Time,
    /// Power, SI W.
    Power,
    /// Acceleration, SI m/s².
    Acceleration,
}

/// A unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    /// What it measures.
    pub dimension: Dimension,
    /// Its size in SI.
    pub si: f64,
    /// Its name in REXS.
    pub name: &'static str,
}

const fn unit(name: &'static str, dimension: Dimension, si: f64) -> Unit {
    Unit {
        dimension,
        si,
        name,
    }
}

const RPM_SI: f64 = std::f64::consts::PI / 30.0;
const DEG_SI: f64 = std::f64::consts::PI / 180.0;

/// A plain number.
pub const ONE: Unit = unit("none", Dimension::One, 1.0);
/// Millimetre.
pub const MM: Unit = unit("mm", Dimension::Length, 1e-3);
/// Micrometre.
pub const UM: Unit = unit("mum", Dimension::Length, 1e-6);
/// Degree.
pub const DEG: Unit = unit("deg", Dimension::Angle, DEG_SI);
/// Newton.
pub const N: Unit = unit("N", Dimension::Force, 1.0);
/// Kilonewton.
pub const KN: Unit = unit("kN", Dimension::Force, 1e3);
/// Newton metre.
pub const NM: Unit = unit("N m", Dimension::Torque, 1.0);
/// Revolutions per minute.
pub const RPM: Unit = unit("1 / min", Dimension::Speed, RPM_SI);
/// Megapascal.
pub const MPA: Unit = unit("MPa", Dimension::Stress, 1e6);
/// Kilogram per cubic decimetre.
pub const KG_PER_DM3: Unit = unit("kg / dm^3", Dimension::Density, 1e3);
/// Kilogram.
pub const KG: Unit = unit("kg", Dimension::Mass, 1.0);
/// Kilogram square metre.
pub const KG_M2: Unit = unit("kg m^2", Dimension::Inertia, 1.0);
/// Newton per metre.
pub const N_PER_M: Unit = unit("N / m", Dimension::Stiffness, 1.0);
/// Newton millimetre per radian.
pub const NMM_PER_RAD: Unit = unit("N mm / rad", Dimension::RotationalStiffness, 1e-3);
/// Hour.
pub const HOUR: Unit = unit("h", Dimension::Time, 3600.0);
/// Kilowatt.
pub const KW: Unit = unit("kW", Dimension::Power, 1e3);
/// Metre per second squared.
pub const M_PER_S2: Unit = unit("m / s^2", Dimension::Acceleration, 1.0);

/// Spellings without spaces, µ as `mu`, powers with `^`.
const KNOWN: [(&str, Dimension, f64); 78] = [
    ("", Dimension::One, 1.0),
    ("none", Dimension::One, 1.0),
    ("-", Dimension::One, 1.0),
    ("1", Dimension::One, 1.0),
    ("%", Dimension::One, 0.01),
    ("mm", Dimension::Length, 1e-3),
    ("m", Dimension::Length, 1.0),
    ("cm", Dimension::Length, 1e-2),
    ("dm", Dimension::Length, 0.1),
    ("mum", Dimension::Length, 1e-6),
    ("um", Dimension::Length, 1e-6),
    ("micron", Dimension::Length, 1e-6),
    ("nm", Dimension::Length, 1e-9),
    ("in", Dimension::Length, 25.4e-3),
    ("deg", Dimension::Angle, DEG_SI),
    ("°", Dimension::Angle, DEG_SI),
    ("grad", Dimension::Angle, DEG_SI),
    ("degree", Dimension::Angle, DEG_SI),
    ("rad", Dimension::Angle, 1.0),
    ("mrad", Dimension::Angle, 1e-3),
    ("N", Dimension::Force, 1.0),
    ("kN", Dimension::Force, 1e3),
    ("MN", Dimension::Force, 1e6),
    ("Nm", Dimension::Torque, 1.0),
    ("kNm", Dimension::Torque, 1e3),
    ("Nmm", Dimension::Torque, 1e-3),
    ("1/min", Dimension::Speed, RPM_SI),
    ("min^-1", Dimension::Speed, RPM_SI),
    ("min-1", Dimension::Speed, RPM_SI),
    ("rpm", Dimension::Speed, RPM_SI),
    ("U/min", Dimension::Speed, RPM_SI),
    ("rad/s", Dimension::Speed, 1.0),
    ("1/s", Dimension::Speed, 60.0 * RPM_SI),
    ("Pa", Dimension::Stress, 1.0),
    ("MPa", Dimension::Stress, 1e6),
    ("GPa", Dimension::Stress, 1e9),
    ("N/mm^2", Dimension::Stress, 1e6),
    ("kN/mm^2", Dimension::Stress, 1e9),
    ("N/m^2", Dimension::Stress, 1.0),
    ("kg/dm^3", Dimension::Density, 1e3),
    ("g/cm^3", Dimension::Density, 1e3),
    ("kg/m^3", Dimension::Density, 1.0),
    ("t/mm^3", Dimension::Density, 1e12),
    ("kg/mm^3", Dimension::Density, 1e9),
    ("kg", Dimension::Mass, 1.0),
    ("g", Dimension::Mass, 1e-3),
    ("t", Dimension::Mass, 1e3),
    ("kgm^2", Dimension::Inertia, 1.0),
    ("kgmm^2", Dimension::Inertia, 1e-6),
    ("gm^2", Dimension::Inertia, 1e-3),
    ("kgcm^2", Dimension::Inertia, 1e-4),
    ("N/m", Dimension::Stiffness, 1.0),
    ("N/mm", Dimension::Stiffness, 1e3),
    ("kN/mm", Dimension::Stiffness, 1e6),
    ("N/mum", Dimension::Stiffness, 1e6),
    ("N/um", Dimension::Stiffness, 1e6),
    ("kN/mum", Dimension::Stiffness, 1e9),
    ("Nmm/rad", Dimension::RotationalStiffness, 1e-3),
    ("Nm/rad", Dimension::RotationalStiffness, 1.0),
    ("kNm/rad", Dimension::RotationalStiffness, 1e3),
    ("Nm/deg", Dimension::RotationalStiffness, 1.0 / DEG_SI),
    ("Nm/°", Dimension::RotationalStiffness, 1.0 / DEG_SI),
    ("Nmm/deg", Dimension::RotationalStiffness, 1e-3 / DEG_SI),
    ("h", Dimension::Time, 3600.0),
    ("min", Dimension::Time, 60.0),
    ("s", Dimension::Time, 1.0),
    ("ms", Dimension::Time, 1e-3),
    ("d", Dimension::Time, 86400.0),
    ("W", Dimension::Power, 1.0),
    ("kW", Dimension::Power, 1e3),
    ("MW", Dimension::Power, 1e6),
    ("mm/s^2", Dimension::Acceleration, 1e-3),
    ("m/s^2", Dimension::Acceleration, 1.0),
    ("mm/mm", Dimension::One, 1.0),
    ("bool", Dimension::One, 1.0),
    ("text", Dimension::One, 1.0),
    ("string", Dimension::One, 1.0),
    ("\u{2212}", Dimension::One, 1.0),
];

/// Dimension and size in SI of a unit as programs write it; none where it is not known.
pub fn read(text: &str) -> Option<(Dimension, f64)> {
    let mut plain = String::new();
    for c in text.chars() {
        match c {
            '\u{b5}' | '\u{3bc}' => plain.push_str("mu"),
            '²' => plain.push_str("^2"),
            '³' => plain.push_str("^3"),
            '⁻' => plain.push_str("^-"),
            '¹' => plain.push('1'),
            'º' => plain.push('°'),
            '*' | '·' | '⋅' | '(' | ')' | '[' | ']' => {}
            c if c.is_whitespace() => {}
            c => plain.push(c),
        }
    }
    let plain = plain.replace("**", "^");
    let exact = KNOWN.iter().find(|(name, ..)| *name == plain);
    // Letters of another size are taken where they can mean one thing only (`Mm` and `mm` differ, but nobody writes
    // `Mm`).
    let alike = || {
        let mut same = KNOWN
            .iter()
            .filter(|(name, ..)| name.eq_ignore_ascii_case(&plain));
        same.next().filter(|_| same.next().is_none())
    };
    exact
        .or_else(alike)
        .map(|&(_, dimension, si)| (dimension, si))
}

/// Spellings of a dimension, for messages.
pub fn names(dimension: Dimension) -> String {
    let all = KNOWN
        .iter()
        .filter(|(name, d, _)| *d == dimension && !name.is_empty());
    let shown: Vec<&str> = all.map(|(name, ..)| *name).take(6).collect();
    shown.join(", ")
}
