//! Flanks through points without normals, and tables whose origin is not the pitch apex.

use gearmesh_bevel::FlankSide;

use crate::common::near;
use crate::points::{Desk, MARGIN, analysed, cut, distance_m, table};

/// Of flanks through places alone: distance from the flank between the points \[m\], and what it changes of the
/// transmission error \[rad\].
const NINE: (f64, f64) = (0.6e-6, 20e-6);
const FIFTEEN: (f64, f64) = (0.02e-6, 2e-6);

/// A table without some of its columns, counted from 0.
fn without_columns(text: &str, columns: std::ops::Range<usize>) -> String {
    let keep = |line: &str| {
        let fields = line.split(',').enumerate();
        let kept: Vec<&str> = fields
            .filter(|(i, _)| !columns.contains(i))
            .map(|(_, f)| f)
            .collect();
        kept.join(",") + "\n"
    };
    text.lines().skip(1).map(keep).collect()
}

/// Without normals the points alone make the flank, and deviations go along the normals of the surface that they make.
#[test]
fn points_without_normals_are_the_flank() {
    let (file, design) = cut();
    let gear = &design.teeth[1];
    let desk = Desk::new("no-normals");
    for (size, most_m, most_rad) in [([9, 5], NINE.0, NINE.1), ([15, 9], FIFTEEN.0, FIFTEEN.1)] {
        let tables =
            [0, 1].map(|i: usize| without_columns(&table(&gear.flanks[i], size, 5, None), 5..8));
        let read = desk.pair([&tables[0], &tables[1]]).unwrap();
        let again = read.design().unwrap();
        for side in FlankSide::BOTH {
            let flank = again.teeth[1].flank(side);
            let fit = flank.grid_fit().unwrap();
            assert_eq!((fit.size, fit.worst_normal_rad), (size, None));
            let off = distance_m(gear.flank(side), flank, 1.2 * MARGIN);
            assert!(
                off < most_m && off < 2.0 * fit.left_out_worst_m,
                "{off:e} {fit:?}"
            );
            let exact = analysed(
                [design.teeth[0].flank(side.mate()), gear.flank(side)],
                &file,
            );
            let fitted = analysed([again.teeth[0].flank(side.mate()), flank], &file);
            near(fitted.peak_to_peak_rad, exact.peak_to_peak_rad, most_rad);
        }
    }
    // Deviations of 5 um at the tip of the heel, falling to 0.
    let added = |s: f64, v: f64| 5.0 * s * v;
    let with = [0, 1].map(|i: usize| table(&gear.flanks[i], [15, 9], 6, Some(added)));
    let bare = with.each_ref().map(|text| without_columns(text, 5..8));
    let [given, made] = [with, bare].map(|t| desk.pair([&t[0], &t[1]]).unwrap().design().unwrap());
    for side in FlankSide::BOTH {
        let [a, b] = [&given, &made].map(|design| design.teeth[1].flank(side));
        let off = distance_m(a, b, 1.2 * MARGIN);
        assert!(off < 0.1e-6, "{off:e}");
    }
    let shuffled = tables_with_swapped_places(&without_columns(
        &table(&gear.flanks[0], [9, 5], 5, None),
        5..8,
    ));
    let convex = table(&gear.flanks[1], [9, 5], 5, None);
    let error = desk.pair([&shuffled, &convex]).unwrap_err();
    assert!(error.contains("concave.csv:"), "{error}");
    // Some of the normals are no normals.
    let half = without_columns(&table(&gear.flanks[0], [9, 5], 5, None), 6..7);
    let error = desk.pair([&half, &convex]).unwrap_err();
    assert!(
        error.contains("ny") && error.contains("no such column"),
        "{error}"
    );
}

/// The fields of the third and tenth row are those of each other.
fn tables_with_swapped_places(text: &str) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let split = |line: &str| {
        let fields: Vec<&str> = line.splitn(3, ',').collect();
        (fields[..2].join(","), fields[2].to_owned())
    };
    let ((a, places_a), (b, places_b)) = (split(&lines[3]), split(&lines[10]));
    lines[3] = format!("{a},{places_b}");
    lines[10] = format!("{b},{places_a}");
    lines.join("\n")
}

/// A table of another origin on the axis: both flanks together say so, and by how much it is off; with 3 mm points lie
/// off the tooth.
#[test]
fn a_wrong_origin_shows_in_the_thickness_or_off_the_tooth() {
    let (file, design) = cut();
    let gear = &design.teeth[1];
    let desk = Desk::new("origin");
    let module = file.blank.mean_normal_module_m;
    assert!(gear.table_thickness(module).is_none());
    // Both flanks in the frame of one tooth, turned by three teeth; z counts from `origin_mm` behind the apex.
    let moved = |origin_mm: f64| {
        [0, 1].map(|i: usize| {
            let flank = &gear.flanks[i];
            let pitch = std::f64::consts::TAU / gear.blank.teeth as f64;
            let turn = gear.half_angle_rad(flank.side) + 3.0 * i as f64 * pitch + 1.0;
            let (sin, cos) = turn.sin_cos();
            let text = without_columns(&table(flank, [9, 5], 6, None), 5..8);
            let turned = text.lines().enumerate().map(|(row, line)| {
                let f: Vec<&str> = line.split(',').collect();
                if row == 0 {
                    return format!("{line}\n");
                }
                let [x, y, z] = [2, 3, 4].map(|k: usize| f[k].parse::<f64>().unwrap());
                let (x, y) = (x * cos - y * sin, x * sin + y * cos);
                format!("{},{},{x:.6},{y:.6},{:.6}\n", f[0], f[1], z + origin_mm)
            });
            turned.collect::<String>()
        })
    };
    let read = |origin_mm: f64| {
        let tables = moved(origin_mm);
        let pair = desk.pair([&tables[0], &tables[1]])?;
        Ok::<_, String>(
            pair.design().unwrap().teeth[1]
                .table_thickness(module)
                .unwrap(),
        )
    };
    let right = read(0.0).unwrap();
    near(right.found_m, right.blank_m, 1e-6);
    assert!(!right.is_doubtful && right.origin_m.unwrap().abs() < 5e-6);
    for origin_mm in [-1.0, -0.3, 0.3, 1.0] {
        match read(origin_mm) {
            Ok(found) => {
                assert!(found.is_doubtful, "{origin_mm}: {found:?}");
                // What is to be added to points_origin_mm takes the move back.
                near(1e3 * found.origin_m.unwrap(), -origin_mm, 0.02);
            }
            Err(error) => {
                assert!(error.contains("points_origin_mm"), "{error}");
            }
        }
    }
    let error = read(3.0).unwrap_err();
    assert!(
        error.contains("beyond") && error.contains("points_origin_mm"),
        "{error}"
    );
}
