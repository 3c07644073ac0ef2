//! Flanks through grids of points against the flanks that the points were taken from.

use std::fmt::Write as _;
use std::path::PathBuf;

use gearmesh_bevel::{
    Flank, FlankPatch, FlankSide, GridFit, PairDesign, PairFile, TcaRequest, ToothContact,
    tooth_contact,
};

use crate::common::near;

pub(crate) const MARGIN: f64 = 0.07;

fn shipped() -> String {
    format!(
        "{}/../../fe_models/bevel_13_35.toml",
        env!("CARGO_MANIFEST_DIR")
    )
}

/// A table of sectors × heights with a margin at all ends, normals out of the material, places rounded to so many
/// digits of a millimetre; `added_um` by the shares along and up.
pub(crate) fn table(
    flank: &Flank,
    size: [usize; 2],
    digits: usize,
    added_um: Option<fn(f64, f64) -> f64>,
) -> String {
    let blank = &flank.blank;
    let mut text = "# taken from a flank\nsector,height,x_mm,y_mm,z_mm,nx,ny,nz".to_owned();
    text.push_str(if added_um.is_some() {
        ",deviation_um\n"
    } else {
        "\n"
    });
    for i in 0..size[0] {
        for k in 0..size[1] {
            let [s, v] = [(i, size[0]), (k, size[1])]
                .map(|(i, n)| MARGIN + (1.0 - 2.0 * MARGIN) * i as f64 / (n - 1) as f64);
            let cone = blank.inner_cone_m() + blank.face_width_m * s;
            let bottom = flank.place(&flank.bottom(cone).unwrap().point.r)[1];
            let height = bottom + (blank.addendum_m(cone) - bottom) * v;
            let p = flank.locate(cone, height).unwrap().point;
            let (r, n) = (p.r * 1e3, -p.n);
            let _ = write!(
                text,
                "{},{},{:.digits$},{:.digits$},{:.digits$},{:.6},{:.6},{:.6}",
                i + 1,
                k + 1,
                r.x,
                r.y,
                r.z,
                n.x,
                n.y,
                n.z
            );
            match added_um {
                Some(added) => {
                    let _ = writeln!(text, ",{:.4}", added(s, v));
                }
                None => text.push('\n'),
            }
        }
    }
    text
}

/// A folder with the shipped pair, one of whose members is to be read from points.
pub(crate) struct Desk(PathBuf);

impl Desk {
    pub(crate) fn new(name: &str) -> Self {
        let path =
            std::env::temp_dir().join(format!("gearmesh-points-{}-{name}", std::process::id()));
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    /// The gear of the shipped pair from two tables.
    pub(crate) fn pair(&self, tables: [&str; 2]) -> Result<PairFile, String> {
        for (name, text) in ["concave.csv", "convex.csv"].iter().zip(tables) {
            std::fs::write(self.0.join(name), text).unwrap();
        }
        let text = std::fs::read_to_string(shipped()).unwrap();
        let from = "settings = \"basic\"\nedge_radius_mm = 0.5";
        let to = "settings = \"points\"\nconcave_points = \"concave.csv\"\nconvex_points = \"convex.csv\"";
        assert!(text.contains(from));
        let file = self.0.join("pair.toml");
        std::fs::write(&file, text.replacen(from, to, 1)).unwrap();
        PairFile::read(&file).map_err(|e| e.to_string())
    }
}

impl Drop for Desk {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

pub(crate) fn cut() -> (PairFile, PairDesign) {
    let file = PairFile::read(shipped().as_ref()).unwrap();
    let design = file.design().unwrap();
    (file, design)
}

pub(crate) fn analysed(flanks: [&Flank; 2], file: &PairFile) -> ToothContact {
    tooth_contact(flanks, &file.blank, &TcaRequest::default()).unwrap()
}

/// The largest distance of two flanks, each with its mean point on +x, over the part that the mate reaches less a
/// margin.
pub(crate) fn distance_m(a: &Flank, b: &Flank, margin: f64) -> f64 {
    let blank = &a.blank;
    let mut worst = 0.0f64;
    for i in 0..=12 {
        for k in 0..=12 {
            let [s, v] = [i, k].map(|n: i32| margin + (1.0 - 2.0 * margin) * f64::from(n) / 12.0);
            let cone = blank.inner_cone_m() + blank.face_width_m * s;
            let low = -6.5e-3 * cone / blank.outer_cone_m;
            let height = low + (blank.addendum_m(cone) - low) * v;
            let [p, q] = [a, b].map(|f| f.locate(cone, height).unwrap().point);
            worst = worst.max((p.r - q.r).dot(&p.n).abs());
        }
    }
    worst
}

/// Points of the 35-tooth gear, 9 × 5 as measuring machines write and 15 × 9: the flank comes back within what the fit
/// states, beyond the points as well, and the pair meshes as the one that was cut.
#[test]
fn a_flank_through_points_is_the_flank() {
    let (file, design) = cut();
    let gear = &design.teeth[1];
    let desk = Desk::new("fits");
    let mut last = f64::INFINITY;
    for (size, digits) in [([9, 5], 4), ([9, 5], 7), ([15, 9], 7)] {
        let tables = [0, 1].map(|i: usize| table(&gear.flanks[i], size, digits, None));
        let read = desk.pair([&tables[0], &tables[1]]).unwrap();
        let again = read.design().unwrap();
        let mut worst = 0.0f64;
        for side in FlankSide::BOTH {
            let flank = again.teeth[1].flank(side);
            let GridFit {
                size: counted,
                rms_m,
                left_out_rms_m,
                left_out_worst_m,
                worst_normal_rad,
                beyond_m,
                ..
            } = *flank.grid_fit().unwrap();
            let off = distance_m(gear.flank(side), flank, 0.0);
            let between = distance_m(gear.flank(side), flank, 1.2 * MARGIN);
            assert_eq!(counted, size);
            assert!(rms_m <= left_out_rms_m && worst_normal_rad.unwrap() < 1e-3);
            near(beyond_m[0], MARGIN * flank.blank.face_width_m, 1e-6);
            // The flank's ends lie beyond the points, where a fit is worse than between them.
            assert!(
                between < 2.0 * left_out_worst_m,
                "{between:e} {left_out_worst_m:e}"
            );
            assert!(
                off < 10.0 * left_out_worst_m,
                "{off:e} {left_out_worst_m:e}"
            );
            worst = worst.max(off);
        }
        if digits == 7 {
            assert!(worst < last, "{worst:e} {last:e}");
            last = worst;
        }
        for side in FlankSide::BOTH {
            let cut = analysed(
                [design.teeth[0].flank(side), gear.flank(side.mate())],
                &file,
            );
            let fitted = analysed(
                [
                    again.teeth[0].flank(side),
                    again.teeth[1].flank(side.mate()),
                ],
                &file,
            );
            let arm = file.blank.mean_cone_m * file.blank.members[1].pitch_angle_rad.sin();
            let most = 4.0 * (worst + 1e-8) / arm;
            near(fitted.peak_to_peak_rad, cut.peak_to_peak_rad, most);
            near(fitted.contact_ratio, cut.contact_ratio, 0.1);
        }
        // As scenes use it.
        let patch =
            FlankPatch::of_tooth(&again.teeth[1], &file.blank.members[0], FlankSide::Convex)
                .unwrap();
        let exact = FlankPatch::of_tooth(gear, &file.blank.members[0], FlankSide::Convex).unwrap();
        near(
            (patch.point([0.3, 0.7]).r - exact.point([0.3, 0.7]).r).norm(),
            0.0,
            2.0 * worst + 1e-9,
        );
    }
    assert!(last < 0.1e-6, "{last:e}");
}

/// Deviations are added to the nominal flank: material added by so many micrometres.
#[test]
fn measured_deviations_are_added() {
    let (_, design) = cut();
    let gear = &design.teeth[1];
    let desk = Desk::new("deviations");
    // 12 µm more at the heel than at the toe, and a crown of 4 µm.
    let added = |s: f64, v: f64| 12.0 * (s - 0.5) + 4.0 * (2.0 * v - 1.0).powi(2);
    let tables = [0, 1].map(|i: usize| table(&gear.flanks[i], [9, 7], 7, Some(added)));
    let read = desk
        .pair([&tables[0], &tables[1]])
        .unwrap()
        .design()
        .unwrap();
    for side in FlankSide::BOTH {
        let (nominal, measured) = (gear.flank(side), read.teeth[1].flank(side));
        let blank = &nominal.blank;
        let mean = blank.mean_cone_m;
        let at = |s: f64| {
            let cone = blank.inner_cone_m() + blank.face_width_m * s;
            let [p, q] = [nominal, measured].map(|f| f.locate(cone, 0.0).unwrap().point);
            // Out of the material.
            -(q.r - p.r).dot(&p.n)
        };
        let lever = |s: f64| {
            let cone = blank.inner_cone_m() + blank.face_width_m * s;
            let p = nominal.locate(cone, 0.0).unwrap().point;
            (p.r.x * p.n.y - p.r.y * p.n.x).abs()
        };
        let height = |cone: f64| {
            -nominal.place(&nominal.bottom(cone).unwrap().point.r)[1]
                / (blank.addendum_m(cone)
                    - nominal.place(&nominal.bottom(cone).unwrap().point.r)[1])
        };
        // Both flanks have their mean point on +x.
        let zero = 1e-6 * added(0.5, height(mean));
        for s in [0.1, 0.4, 0.9] {
            let cone = blank.inner_cone_m() + blank.face_width_m * s;
            let expected = 1e-6 * added(s, height(cone)) - zero * lever(s) / lever(0.5);
            near(at(s), expected, 0.05e-6);
        }
    }
}

/// Numbers of mean 0 and deviation 1: sums of twelve even ones of a linear congruential generator, less 6.
fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    let mut even = move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    move || (0..12).map(|_| even()).sum::<f64>() - 6.0
}

/// Points that a machine measured with 1 µm of noise, beside nominal normals: the flank is off by no more than the
/// noise, and does not wave between the points.
#[test]
fn noise_of_the_machine_does_not_make_waves() {
    let (_, design) = cut();
    let gear = &design.teeth[1];
    let desk = Desk::new("noise");
    let text = [0, 1].map(|i: usize| table(&gear.flanks[i], [15, 9], 6, None));
    let noisy = |text: &str, draw: &mut dyn FnMut() -> f64| -> String {
        let line = |line: &str| {
            let Ok(mut f) = line
                .split(',')
                .map(str::parse::<f64>)
                .collect::<Result<Vec<_>, _>>()
            else {
                return format!("{line}\n");
            };
            let off_mm = 1e-3 * draw();
            for k in 0..3 {
                f[2 + k] += off_mm * f[5 + k];
            }
            let fields: Vec<String> = f.iter().map(f64::to_string).collect();
            fields.join(",") + "\n"
        };
        text.lines().map(line).collect()
    };
    for seed in 1..=6 {
        let mut draw = noise(seed);
        let tables = [&text[0], &text[1]].map(|text| noisy(text, &mut draw));
        let read = desk.pair([&tables[0], &tables[1]]).unwrap();
        let again = read.design().unwrap();
        for side in FlankSide::BOTH {
            let flank = again.teeth[1].flank(side);
            let fit = flank.grid_fit().unwrap();
            near(fit.rms_m, 1e-6, 0.3e-6);
            let off = distance_m(gear.flank(side), flank, 1.2 * MARGIN);
            // The fit is off by a share of the noise, most at the corners; so is where it puts the mean point.
            assert!(off < 3e-6, "{seed} {side:?}: {off:e} m");
            // 4 to 6 without noise. Eight for nine heights would meet the points of seed 1 better than 4, and wave.
            let up = fit.polynomials[1];
            assert!(up <= 6, "{seed} {side:?}: {up} polynomials");
        }
    }
}

#[test]
fn bad_grids_are_refused_with_file_line_and_reason() {
    let (_, design) = cut();
    let gear = &design.teeth[1];
    let desk = Desk::new("bad");
    let [concave, convex] = [0, 1].map(|i: usize| table(&gear.flanks[i], [9, 5], 6, None));
    desk.pair([&concave, &convex]).unwrap();
    let lines = |text: &str| text.lines().map(str::to_owned).collect::<Vec<_>>();
    let edited = |line: usize, change: &dyn Fn(&mut Vec<String>)| {
        let mut list = lines(&concave);
        let mut fields: Vec<String> = list[line - 1].split(',').map(str::to_owned).collect();
        change(&mut fields);
        list[line - 1] = fields.join(",");
        list.join("\n")
    };
    let without = |line: usize| {
        let mut list = lines(&concave);
        list.remove(line - 1);
        list.join("\n")
    };
    let slip = edited(20, &|f| {
        f[3] = format!("{:.4}", f[3].parse::<f64>().unwrap() + 0.2)
    });
    let mirrored: String = lines(&concave)
        .iter()
        .enumerate()
        .map(|(i, line)| {
            let mut f: Vec<String> = line.split(',').map(str::to_owned).collect();
            if i > 1 {
                for k in [3, 6] {
                    f[k] = format!("{}", -f[k].parse::<f64>().unwrap());
                }
            }
            f.join(",") + "\n"
        })
        .collect();
    let short: String = lines(&concave)
        .iter()
        .enumerate()
        .filter(|(i, line)| *i < 2 || line.split(',').next().unwrap().parse::<usize>().unwrap() < 6)
        .map(|(_, line)| format!("{line}\n"))
        .collect();
    for (text, parts) in [
        (without(12), vec!["concave.csv", "sector 2 has no height 5"]),
        (
            edited(12, &|f| f[0] = "3".to_owned()),
            vec!["concave.csv:17", "stands here and"],
        ),
        (
            edited(9, &|f| f[1] = "2.5".to_owned()),
            vec!["concave.csv:9", "height", "whole number"],
        ),
        (
            edited(9, &|f| f[5] = "0.9".to_owned()),
            vec!["concave.csv:9", "nx", "allowed is 1"],
        ),
        (
            edited(9, &|f| {
                for field in &mut f[5..8] {
                    *field = format!("{}", -field.parse::<f64>().unwrap());
                }
            }),
            vec!["concave.csv:9", "other side"],
        ),
        (
            edited(9, &|f| f[4] = "nan".to_owned()),
            vec!["concave.csv:9", "z_mm"],
        ),
        (
            slip,
            vec!["concave.csv:20", "off the surface through all others"],
        ),
        (convex.clone(), vec!["concave.csv", "is it the other flank"]),
        (mirrored, vec!["concave.csv", "mirror image"]),
        (short, vec!["concave.csv", "beyond the grid at the heel"]),
        (
            lines(&concave)[..2].join("\n"),
            vec!["concave.csv", "rows of numbers"],
        ),
        (
            edited(9, &|f| f[4] = "900.0".to_owned()),
            vec![
                "concave.csv:9",
                "beyond the heel of the gear's tooth",
                "points_origin_mm",
            ],
        ),
    ] {
        let error = desk.pair([&text, &convex]).unwrap_err();
        for part in parts {
            assert!(error.contains(part), "`{part}` is not in: {error}");
        }
    }
}
