//! Deflections and strains under slices of a contact line on gears of several kinds.
//!
//! The loads of the grid are means of projected ones over hats, with no first and no second moment
//! (docs/theory/projection.md). What is left is of third order in the distance of the stations.

use super::{BothWays, Differences, larger};

/// Bounds on the deflection under a line over the whole width, of its mean and of each slice.
///
/// A tooth is a cantilever some eight stations long: its deflection has the third derivative 3/L³ of its own size, and
/// a third moment of a tenth of h³ reads 0.02 % of it. Nearer to the tip the flank's own edge comes in.
const BETWEEN: f64 = 0.001;
const NEAR_TIP: f64 = 0.003;
/// One slice loaded: what the hats across the width leave out, of its own deflection.
const ONE_SLICE: f64 = 0.015;
/// Calibrated on helical teeth: the slices of a line stand beside one another as a staircase, at whose steps both near
/// fields are those of line ends, which the plane problem does not know.
const AT_STEPS: f64 = 0.008;
/// Strain of a gauge under a line over the whole width, of its largest one over the flank.
const STRAIN: f64 = 0.002;

fn gear(stations: usize, mesh: &str, blank: &str, helix: &str) -> BothWays {
    let gauge = |name: &str, tooth: usize, side: &str| {
        format!(
            "[[gauge]]\nname = \"{name}\"\ntooth = {tooth}\nside = \"{side}\"\nlength_mm = 0.9\nwidth_mm = 3.0\n"
        )
    };
    BothWays::new(format!(
        "name = \"wheel\"\n[tooth]\nteeth = 24\nmodule_mm = 3.0\nface_width_mm = 20.0\n{helix}[material]\nyoung_GPa = 206.0\n\
         poisson = 0.3\n[mesh]\n{mesh}[reduction]\nflanks = [\"right\"]\nslices = 5\nroll_stations = {stations}\n{blank}{}{}{}",
        gauge("tension", 0, "right"),
        gauge("compression", 0, "left"),
        gauge("next tooth", 1, "right")
    ))
}

const SOLID: &str = "[blank]\nkind = \"solid\"\nbore_diameter_mm = 30.0\n";
const SLOTTED: &str = "[blank]\nkind = \"thin-rim\"\nbore_diameter_mm = 20.0\nhub_diameter_mm = 28.0\n\
     rim_inner_diameter_mm = 54.0\nweb_thickness_mm = 4.0\n[blank.slots]\ncount = 3\ninner_radius_mm = 17.0\n\
     outer_radius_mm = 24.0\nwidth_deg = 70.0\nphase_deg = 60.0\ncorner_radius_mm = 1.5\n";
const HELICAL: &str = "helix_angle_deg = 20.0\nhand = \"right\"\n";

fn percent(d: &Differences) -> String {
    let each = [d.mean, d.slice, d.own, d.others];
    each.map(|x| format!("{:8.3}", 100.0 * x)).concat()
}

/// Largest differences at the ends of the flank, and between the outermost centroids away from the tip and in the last
/// step before it.
#[derive(Default)]
struct Largest {
    ends: [f64; 2],
    between: f64,
    near_tip: f64,
}

/// Compares a gear's slices and gauges within the bounds; what was found under a line over the whole width without near
/// field.
fn compared(what: &str, both: &BothWays, bound_of_steps: f64) -> Largest {
    let ([low, high], inside) = both.places_rad();
    let rolls: Vec<f64> = [low].into_iter().chain(inside).chain([high]).collect();
    let last = rolls.len() - 1;
    let lines = both.lines(rolls.clone());
    let bound = |k: usize| match k {
        k if k + 2 >= last => NEAR_TIP,
        _ => BETWEEN,
    };
    let mut largest = Largest::default();
    println!("{what}: mean, slices, one slice, others [%]");
    for (name, compared, steps) in [
        ("no near field", lines.without_near_field(0), 0.0),
        ("next tooth", lines.without_near_field(1), 0.0),
        ("calibrated", lines.calibrated(), bound_of_steps),
    ] {
        for (k, roll) in rolls.iter().enumerate() {
            let d = compared.differences(k);
            println!("  {name:13} at {roll:.4} rad: {}", percent(&d));
            let allowed = bound(k) + steps;
            assert!(
                d.mean.abs() < allowed && d.slice.abs() < allowed,
                "{name} {k}: {d:?}"
            );
            if name == "calibrated" {
                // A single slice ends in both near fields of its own: not compared.
                continue;
            }
            assert!(
                d.own.abs() < ONE_SLICE && d.others.abs() < ONE_SLICE,
                "{name} {k}: {d:?}"
            );
            if name == "no near field" {
                let of = match k {
                    0 => &mut largest.ends[0],
                    k if k == last => &mut largest.ends[1],
                    k if k + 2 >= last => &mut largest.near_tip,
                    _ => &mut largest.between,
                };
                *of = larger(*of, d.mean);
            }
        }
    }
    let n = both.model.grid.slices;
    for (number, gauge) in both.gear.gauges.iter().enumerate() {
        let by_grid = both.gauge_by_grid(number, &rolls);
        let projected = both.gauge_of(number, &lines.loads);
        let sums = |read: &[[f64; 2]], k: usize| {
            let slices = &read[k * n..][..n];
            [0, 1].map(|part| slices.iter().map(|s| s[part]).sum::<f64>())
        };
        // Of the largest normal one.
        let most = (0..=last)
            .map(|k| sums(&projected, k)[0].abs())
            .fold(0.0, f64::max);
        for (k, roll) in rolls.iter().enumerate() {
            let (grid, exact) = (sums(&by_grid, k), sums(&projected, k));
            let off = [0, 1].map(|part| (grid[part] - exact[part]) / most);
            println!(
                "  strain, {:11} at {roll:.4} rad: normal {:7.3} %, towards the tip {:7.3} %",
                gauge.name,
                100.0 * off[0],
                100.0 * off[1]
            );
            assert!(
                off.iter().all(|off| off.abs() < STRAIN),
                "{} {k}: {off:?}",
                gauge.name
            );
        }
    }
    largest
}

/// A solid spur gear, with twice as many steps between the stations, too: the difference at the tip falls by more than
/// the square of the step, and elsewhere it is as small as what single elements make of it.
#[test]
fn slices_deflect_alike_and_converge_with_the_stations() {
    let [nine, seventeen] = [9, 17].map(|stations| {
        compared(
            &format!("solid, {stations} stations"),
            &gear(stations, "", SOLID, ""),
            0.0,
        )
    });
    let order = (nine.ends[1] / seventeen.ends[1]).abs().log2();
    println!("order of the difference at the tip: {order:.2}");
    assert!(order > 2.0, "{order}");
    assert!(nine.ends[0].abs() < 3e-4 && seventeen.ends[0].abs() < 3e-4);
    // A third of it with half the step is more than first order; rounding is far below.
    assert!(seventeen.near_tip.abs() < nine.near_tip.abs() / 3.0);
    assert!(nine.between.abs() < 3e-4 && seventeen.between.abs() < 3e-4);
}

/// A thin rim on a web with slots, in quadratic elements, whose faces are parabolas. Both ways load one mesh, whose
/// body and fillets may be coarse.
#[test]
fn slices_of_a_slotted_wheel_deflect_alike() {
    let mesh = "element = \"hex20\"\nfillet_mm = 0.3\nbody_mm = 8.0\naxial_mm = 10.0\n";
    compared("slotted, hex20", &gear(9, mesh, SLOTTED, ""), 0.0);
}

/// A helical gear, whose faces are twisted.
#[test]
fn slices_of_a_helical_gear_deflect_alike() {
    compared("helical", &gear(9, "", SOLID, HELICAL), AT_STEPS);
}
