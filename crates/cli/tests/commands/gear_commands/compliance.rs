//! `gearmesh compliance`: deflections along a flank under a line load.

use crate::common::{argument, largest_difference, number, succeeds, workshop};
use crate::gear_commands::numbers;

fn compliance(further: &[&str]) -> Vec<String> {
    let load = [
        "--tooth",
        "2",
        "--line-load-N-per-mm",
        "100",
        "--half-width-mm",
        "0.1",
    ];
    let words = [
        &["compliance", argument(&workshop().thin)],
        load.as_slice(),
        further,
    ]
    .concat();
    words.into_iter().map(String::from).collect()
}

#[test]
fn compliance_adds_the_global_and_the_local_part() {
    let figures = succeeds(&compliance(&["--radius-mm", "26,27,28", "--json"])).json();
    let rows = figures["rows"].as_array().unwrap();
    assert_eq!(
        rows.iter()
            .map(|row| number(&row["radius_mm"]))
            .collect::<Vec<_>>(),
        [26.0, 27.0, 28.0]
    );
    for row in rows {
        let (global, local, total) = (
            number(&row["global_m"]),
            number(&row["local_m"]),
            number(&row["total_m"]),
        );
        assert!(
            (global + local - total).abs() < 1e-15 * total && global > 0.0 && local > 0.0,
            "{row}"
        );
        for (mean, slices) in [
            (global, &row["global_per_slice_m"]),
            (local, &row["local_per_slice_m"]),
        ] {
            let slices = numbers(slices);
            assert_eq!(slices.len(), 2);
            assert!(
                (slices.iter().sum::<f64>() / 2.0 - mean).abs() < 1e-12 * mean,
                "{row}"
            );
            // The blank is symmetric about mid-face.
            assert!((slices[0] - slices[1]).abs() < 1e-6 * mean, "{row}");
        }
    }
    // A tooth bends more the further out it is loaded.
    let totals: Vec<f64> = rows.iter().map(|row| number(&row["total_m"])).collect();
    assert!(totals.is_sorted(), "{totals:?}");
    // The same figures in the table, in micrometres with five decimals.
    let table = succeeds(&compliance(&["--radius-mm", "26,27,28"])).stdout;
    let lines: Vec<&str> = table.lines().skip(2).collect();
    assert_eq!(lines.len(), 3, "{table}");
    for (line, row) in lines.iter().zip(rows) {
        let columns: Vec<f64> = line
            .split_whitespace()
            .map(|word| word.parse().unwrap())
            .collect();
        let expected =
            [&row["total_m"], &row["global_m"], &row["local_m"]].map(|value| number(value) * 1e6);
        assert!(
            largest_difference(&columns[1..4], &expected) < 0.6e-5,
            "{line} against {row}"
        );
    }
}

/// Teeth are alike, so reading tooth 2 + n is reading tooth n; reciprocity makes ahead and behind the same.
#[test]
fn compliance_at_another_tooth_is_smaller_and_has_no_local_part() {
    let total_at = |tooth: &str| {
        let figures = succeeds(&compliance(&[
            "--radius-mm",
            "27",
            "--at-tooth",
            tooth,
            "--json",
        ]))
        .json();
        (
            number(&figures["rows"][0]["total_m"]),
            number(&figures["rows"][0]["local_m"]),
            figures["mesh_error_relative"].as_f64(),
        )
    };
    let (loaded, local, error) = total_at("2");
    assert!(local > 0.0);
    let (ahead, local_ahead, error_ahead) = total_at("3");
    let (behind, ..) = total_at("1");
    let (opposite, ..) = total_at("11");
    // What the reduction said of the mesh.
    let stated = &workshop().figures[1]["further"];
    for (error, teeth) in [(error, "loaded tooth"), (error_ahead, "other teeth")] {
        let name = format!("mesh error of the deflection, {teeth}");
        assert!(
            error.is_some() && error == stated[name].as_f64(),
            "{error:?}"
        );
    }
    assert_eq!(local_ahead, 0.0);
    assert!(
        opposite < ahead && ahead < loaded && opposite > 0.0,
        "{opposite} {ahead} {loaded}"
    );
    assert!((ahead - behind).abs() < 1e-9 * ahead, "{ahead} {behind}");
    // The displacement is linear in the load but for the local logarithm, which `none` leaves out.
    let linear = |load: &str| {
        let mut words = compliance(&["--radius-mm", "27", "--local", "none", "--json"]);
        let at = words.iter().position(|word| word == "100").unwrap();
        words[at] = load.into();
        number(&succeeds(&words).json()["rows"][0]["total_m"])
    };
    assert!((linear("300") / linear("100") - 3.0).abs() < 1e-12);
}

/// Forces on single elements: one solution a slice, the deflection of the flank grid's four stations to 1 %, whatever
/// is taken off and put back for the near field.
#[test]
fn projected_forces_deflect_alike() {
    for (local, at_tooth) in [
        ("calibrated", "2"),
        ("weber-banaschek", "2"),
        ("calibrated", "3"),
    ] {
        let words = ["--radius-mm", "26,27,28", "--project", "--json"];
        let further = ["--local", local, "--at-tooth", at_tooth];
        let figures = succeeds(&compliance(&[&words[..], &further].concat())).json();
        let projected = &figures["projected"];
        assert_eq!(number(&projected["solutions"]), 6.0);
        for name in ["mesh and factor", "projection", "solutions"] {
            assert!(number(&projected["seconds"][name]) > 0.0, "{name}");
        }
        let totals = |rows: &serde_json::Value| -> Vec<f64> {
            let rows = rows.as_array().unwrap().iter();
            rows.map(|row| number(&row["total_m"])).collect()
        };
        let (grid, single) = (totals(&figures["rows"]), totals(&projected["rows"]));
        assert_eq!(single.len(), 3);
        for (a, b) in grid.iter().zip(&single) {
            assert!((a / b - 1.0).abs() < 0.01 && a != b, "{local}: {a} {b}");
        }
    }
    let table = succeeds(&compliance(&["--radius-mm", "27", "--project"])).stdout;
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(lines.len(), 5, "{table}");
    assert!(lines[3].starts_with("by projection on element faces: 2 solutions, "));
}
