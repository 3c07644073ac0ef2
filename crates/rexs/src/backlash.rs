//! Backlash of a pair of gears: teeth that jam by rounding become thinner.

use crate::by_number::ByNumber;
use crate::cylindrical::Gear;
use crate::gearbox::SeatedGear;
use crate::ledger::About;
use crate::source::Source;

/// Backlash below this, in modules, is none: rounding decides whether the teeth fit.
const LEAST_BACKLASH: f64 = 1e-3;
/// Backlash that is then given, in modules.
const WANTED_BACKLASH: f64 = 0.02;
/// Teeth that jam by more, in modules, are no matter of rounding: the scene says so.
const MOST_JAM: f64 = 0.05;

/// Circumferential backlash on the reference circles in the transverse section \[mm\], negative for teeth that jam.
///
/// inv α_w = inv α_t + 2 tan α_n Σx₀/Σz is the profile shift Σx₀ without backlash at a working pressure angle; what
/// the gears have less than that is 2 m_n tan α_n/cos β of backlash a module, and their teeth are thinner by the
/// allowances.
///
/// A ring's teeth and diameters count negative.
fn backlash_mm([a, b]: [&Gear; 2], distance_mm: f64) -> f64 {
    let normal = a.pressure_angle_deg.to_radians().tan();
    let cos_helix = a.helix_deg.to_radians().cos();
    let transverse = (normal / cos_helix).atan();
    let of_both = |part: fn(&Gear) -> f64| a.sign() * part(a) + b.sign() * part(b);
    let working = (0.5 * of_both(Gear::base_diameter_mm).abs() / distance_mm)
        .min(1.0)
        .acos();
    let involute = |angle: f64| angle.tan() - angle;
    let teeth = of_both(|gear| f64::from(gear.teeth));
    let without = (involute(working) - involute(transverse)) * teeth / (2.0 * normal);
    let shift = without - a.profile_shift - b.profile_shift;
    shift * 2.0 * a.module_mm * normal / cos_helix
        + a.thickness_allowance_mm
        + b.thickness_allowance_mm
}

/// Makes the teeth of both gears of a pair thinner where they have no backlash.
pub fn give(
    source: &Source<'_>,
    gears: &mut ByNumber<SeatedGear>,
    pair: [usize; 2],
    distance_mm: f64,
) {
    let module = gears[pair[0]].gear.module_mm;
    let jam = -backlash_mm(pair.map(|i| &gears[i].gear), distance_mm);
    if jam <= -LEAST_BACKLASH * module || jam >= MOST_JAM * module {
        return;
    }
    let thinner = 0.5 * (jam + WANTED_BACKLASH * module);
    for i in pair {
        let Some(seated) = gears.get_mut(i) else {
            continue;
        };
        seated.gear.thickness_allowance_mm += thinner;
        let what = format!(
            "no backlash at a centre distance of {distance_mm:.4} mm: teeth {:.1} um thinner on the reference circle",
            1e3 * thinner
        );
        source.assume_of(seated.gear.id, About::Small, what);
    }
}
