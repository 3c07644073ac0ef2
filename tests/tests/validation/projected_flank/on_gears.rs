//! Deflections and strains of gears both ways.

use super::BothWays;

fn gear(stations: usize, slices: usize, mesh: &str, blank: &str, helix: &str) -> String {
    format!(
        "name = \"wheel\"\n[tooth]\nteeth = 24\nmodule_mm = 3.0\nface_width_mm = 20.0\n{helix}[material]\nyoung_GPa = 206.0\npoisson = 0.3\n\
         [mesh]\n{mesh}[reduction]\nflanks = [\"right\"]\nslices = {slices}\nroll_stations = {stations}\n{blank}\
         [[gauge]]\nname = \"tension\"\ntooth = 0\nside = \"right\"\nlength_mm = 0.9\nwidth_mm = 3.0\n\
         [[gauge]]\nname = \"compression\"\ntooth = 0\nside = \"left\"\nlength_mm = 0.9\nwidth_mm = 3.0\n\
         [[gauge]]\nname = \"next tooth\"\ntooth = 1\nside = \"right\"\nlength_mm = 0.9\nwidth_mm = 3.0\n"
    )
}

const SOLID: &str = "[blank]\nkind = \"solid\"\nbore_diameter_mm = 30.0\n";
const SLOTTED: &str = "[blank]\nkind = \"thin-rim\"\nbore_diameter_mm = 20.0\nhub_diameter_mm = 28.0\nrim_inner_diameter_mm = 54.0\nweb_thickness_mm = 4.0\n\
[blank.slots]\ncount = 3\ninner_radius_mm = 17.0\nouter_radius_mm = 24.0\nwidth_deg = 70.0\nphase_deg = 60.0\ncorner_radius_mm = 1.5\n";

#[test]
#[ignore = "explore"]
fn explore() {
    for (what, mesh) in [
        ("default", ""),
        ("hex20", "element = \"hex20\"\n"),
        ("fine", "flank_mm = 0.5\naxial_mm = 1.0\n"),
    ] {
        for (blank, helix) in [
            (SOLID, ""),
            (SLOTTED, ""),
            (SOLID, "helix_angle_deg = 20.0\nhand = \"right\"\n"),
        ] {
            for stations in [9, 17] {
                let both = BothWays::new(gear(stations, 5, mesh, blank, helix));
                let hats = both.hats();
                let c = hats.centroids();
                let s = &both.model.grid.roll_angles_rad;
                let last = s.len() - 1;
                let mid = |a: f64, b: f64| 0.5 * (a + b);
                let rolls = [
                    s[0],
                    c[0],
                    mid(c[0], c[1]),
                    c[last / 2],
                    mid(c[last / 2], c[last / 2 + 1]),
                    mid(c[last - 1], c[last]),
                    c[last],
                    s[last],
                ];
                println!(
                    "== {what} {} {helix} stations {stations}",
                    &blank[..30].replace('\n', " ")
                );
                let loads = both.lines(&rolls);
                for (name, d) in [
                    ("global", both.global(&loads, &rolls, 0).differences()),
                    ("next tooth", both.global(&loads, &rolls, 1).differences()),
                    ("calibrated", both.calibrated(&loads, &rolls).differences()),
                ] {
                    for (roll, d) in rolls.iter().zip(d) {
                        println!(
                            "{name:12} {roll:.4} {}",
                            d.map(|x| format!("{:8.3}", 100.0 * x)).join(" ")
                        );
                    }
                }
                let points = both.points(&rolls);
                for (name, d) in [("points next", both.global(&points, &rolls, 1).differences())] {
                    for (roll, d) in rolls.iter().zip(d) {
                        println!(
                            "{name:12} {roll:.4} {}",
                            d.map(|x| format!("{:8.3}", 100.0 * x)).join(" ")
                        );
                    }
                }
                for number in 0..3 {
                    for (name, loads) in [("line", &loads), ("point", &points)] {
                        let read = both.gauge(number, loads, &rolls, 0);
                        let largest: f64 = read.iter().map(|r| r[0][1].abs()).fold(0.0, f64::max);
                        let n = both.model.grid.slices;
                        for r in 0..rolls.len() {
                            let of = &read[r * n..][..n];
                            let worst = |k: usize| {
                                of.iter().map(|x| (x[k][0] - x[k][1]) / largest).fold(
                                    0.0,
                                    |a: f64, b: f64| if b.abs() > a.abs() { b } else { a },
                                )
                            };
                            let sum = |k: usize, w: usize| of.iter().map(|x| x[k][w]).sum::<f64>();
                            println!(
                                "gauge {number} {name:6} {:.4} normal {:8.3} tangential {:8.3} all {:8.3} {:8.3}",
                                rolls[r],
                                100.0 * worst(0),
                                100.0 * worst(1),
                                100.0 * (sum(0, 0) / sum(0, 1) - 1.0),
                                100.0 * (sum(1, 0) / sum(1, 1) - 1.0)
                            );
                        }
                    }
                }
            }
        }
    }
}
