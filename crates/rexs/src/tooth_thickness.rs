//! How much thinner than without backlash teeth are: DIN 3967 codes such as `c25`, or allowances of span.

use crate::cylindrical::Gear;
use crate::error::Result;
use crate::ledger::About;
use crate::source::Part;
use crate::units::{MM, UM};

/// Upper limits of the ranges of reference diameters \[mm\].
const DIAMETERS_MM: [f64; 7] = [10.0, 50.0, 125.0, 280.0, 560.0, 1000.0, 1600.0];

/// Upper allowances of the normal tooth thickness \[µm\], DIN 3967:1978, table 1.
const UPPER_UM: [(&str, [f64; 7]); 11] = [
    (
        "a",
        [-100.0, -135.0, -180.0, -250.0, -330.0, -450.0, -600.0],
    ),
    (
        "ab",
        [-85.0, -110.0, -150.0, -200.0, -280.0, -370.0, -500.0],
    ),
    ("b", [-70.0, -95.0, -125.0, -170.0, -230.0, -310.0, -420.0]),
    ("bc", [-58.0, -75.0, -105.0, -140.0, -190.0, -260.0, -340.0]),
    ("c", [-48.0, -65.0, -85.0, -115.0, -155.0, -210.0, -290.0]),
    ("cd", [-40.0, -54.0, -70.0, -95.0, -130.0, -175.0, -240.0]),
    ("d", [-33.0, -44.0, -60.0, -80.0, -110.0, -145.0, -200.0]),
    ("e", [-22.0, -30.0, -40.0, -56.0, -75.0, -100.0, -135.0]),
    ("f", [-10.0, -14.0, -19.0, -26.0, -35.0, -48.0, -64.0]),
    ("g", [-5.0, -7.0, -9.0, -12.0, -17.0, -22.0, -30.0]),
    ("h", [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
];

/// Tolerances of the normal tooth thickness \[µm\], DIN 3967:1978, table 2, series 21 to 30.
const TOLERANCE_UM: [[f64; 7]; 10] = [
    [3.0, 5.0, 6.0, 8.0, 10.0, 12.0, 16.0],
    [5.0, 8.0, 10.0, 12.0, 16.0, 20.0, 25.0],
    [8.0, 12.0, 16.0, 20.0, 25.0, 30.0, 40.0],
    [12.0, 20.0, 25.0, 30.0, 40.0, 50.0, 60.0],
    [20.0, 30.0, 40.0, 50.0, 60.0, 80.0, 100.0],
    [30.0, 50.0, 60.0, 80.0, 100.0, 130.0, 160.0],
    [50.0, 80.0, 100.0, 130.0, 160.0, 200.0, 250.0],
    [80.0, 130.0, 160.0, 200.0, 250.0, 300.0, 400.0],
    [130.0, 200.0, 250.0, 300.0, 400.0, 500.0, 600.0],
    [200.0, 300.0, 400.0, 500.0, 600.0, 800.0, 1000.0],
];

/// By how much the tooth is thinner in the normal section, in the middle of the field, \[mm\]; none for codes and
/// diameters that the tables do not have.
///
/// # Sources
/// DIN 3967 (1978), "System of gear fits; backlash, tooth thickness allowances, tooth thickness tolerances", tables 1
/// and 2, quoted from memory.
pub fn din_3967_mm(code: &str, reference_diameter_mm: f64) -> Option<f64> {
    let code = code.trim().to_lowercase();
    let digits = code.find(|c: char| c.is_ascii_digit())?;
    let (letters, series) = code.split_at(digits);
    let series = series.parse::<usize>().ok()?.checked_sub(21)?;
    let range = DIAMETERS_MM
        .iter()
        .position(|&limit| reference_diameter_mm <= limit)?;
    let upper = UPPER_UM.iter().find(|(name, _)| *name == letters)?.1[range];
    let tolerance = TOLERANCE_UM.get(series)?[range];
    Some(1e-3 * (0.5 * tolerance - upper))
}

/// Reads by how much the teeth of a gear are thinner than those without backlash: allowances of span, of the chordal
/// thickness, a DIN 3967 code, in this order.
///
/// # Errors
/// Those of [`Part`].
pub fn thickness(component: Part<'_>, gear: &mut Gear) -> Result<()> {
    let cos_helix = gear.helix_deg.to_radians().cos();
    let span = [
        component.number("upper_backlash_allowance_referenced_to_span", UM)?,
        component.number("lower_backlash_allowance_referenced_to_span", UM)?,
    ];
    // In the normal section; those of the transverse one are larger by 1/cos beta.
    let mut chordal = [None, None];
    for (found, end) in chordal.iter_mut().zip(["upper", "lower"]) {
        let normal = component.number(&format!("chordal_tooth_thickness_{end}_deviation"), MM)?;
        let transverse = format!("chordal_transverse_tooth_thickness_{end}_deviation");
        let transverse = component.number(&transverse, MM)?;
        *found = normal.or(transverse.map(|s| s * cos_helix));
    }
    let code = component.text("tooth_thickness_deviation_tolerance_series_din_3967_1978");
    let normal_mm = if let [Some(upper), Some(lower)] = span {
        let mean = -0.5e-3 * (upper + lower) / gear.pressure_angle_deg.to_radians().cos();
        let what = "tooth thickness: the middle of the allowances of span";
        component.assume(About::Small, what);
        Some(mean)
    } else if let [Some(upper), Some(lower)] = chordal {
        let what = "tooth thickness: the middle of the allowances of the chordal thickness";
        component.assume(About::Small, what);
        Some(-0.5 * (upper + lower))
    } else if let Some(code) = code {
        let found = din_3967_mm(&code, gear.reference_diameter_mm());
        match found {
            Some(mean) => component.assume(About::Small, format!("tooth thickness: {:.1} um thinner in the normal section, the middle of DIN 3967 {code}", 1e3 * mean),
            ),
            None => component.leave_out(About::Small, format!("tooth thickness `{code}`, which the tables of DIN 3967 do not have for this diameter")),
        }
        found
    } else {
        component.assume(About::Small, "no tooth thickness allowance given: none, teeth without backlash at the theoretical centre distance");
        None
    };
    if let Some(mean) = normal_mm.filter(|m| *m > 0.0 && *m < 0.5 * gear.module_mm) {
        gear.thickness_allowance_mm = mean / cos_helix;
    }
    Ok(())
}
