//! Sets that are refused, with the numbers that help.

use super::*;

/// What a set does not allow, each with the numbers that help.
#[test]
fn sets_that_do_not_fit_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    write_gears(folder.path(), [24, 36], 20.0);
    let set = |distance: f64, parts: [&str; 5]| scene("kind = \"static\"", distance, parts);
    let carrier = "inertia_kg_m2 = [0.1, 0.1, 0.1]\ntorque_Nm = -5.0";
    let held = "support = \"held\"";
    for (text, expected) in [
        (
            set(90.0, ["", held, carrier, "count = 7", ""]),
            &[
                "planets.count: planet 2 at 51.428571 deg does not fit",
                "360/120 deg",
                "51.0",
                "; 2, 3, 4 equal angles fit",
            ][..],
        ),
        (
            set(
                90.0,
                ["", held, carrier, "angles_deg = [0.0, 180.0, 210.0]", ""],
            ),
            &["planets: planets 2 and 3 touch each other: their axes are 46.587"],
        ),
        (
            set(90.0, ["", held, carrier, "count = 6", ""]).replace("count = 6", "count = 8"),
            &[
                "planets 1 and 2 touch each other",
                "at equal angles 4 planets or fewer",
            ],
        ),
        (
            set(89.6, ["", held, carrier, "count = 3", ""]),
            &["planetary.0.centre_distance_mm: planet and sun do not run together"],
        ),
        (
            set(
                90.0,
                [
                    "",
                    held,
                    carrier,
                    "count = 3\ndeviation = [{ planet = 2, tangential_um = 400.0 }]",
                    "",
                ],
            ),
            &[
                "deviation.0.tangential_um: found 400 um",
                "cannot be turned",
            ],
        ),
        (
            set(
                90.0,
                [
                    "",
                    "support = \"held\"\ntorque_Nm = 1.0",
                    carrier,
                    "count = 3",
                    "",
                ],
            ),
            &["ring.torque_Nm: is not used by support = \"held\""],
        ),
        (
            set(
                90.0,
                ["support = \"bearings\"", held, carrier, "count = 3", ""],
            ),
            &["planetary.0.sun: support = \"bearings\" needs bearings"],
        ),
        (
            set(90.0, ["", held, carrier, "", ""]),
            &["planets: give either count"],
        ),
        (
            set(90.0, ["", held, "torque_Nm = -5.0", "count = 3", ""]),
            &[
                "in inertia_kg_m2 of [[body]] `set carrier`, which follows from it",
                "inertia_kg_m2",
            ],
        ),
        (
            set(90.0, ["body = \"sunn\"", held, carrier, "count = 3", ""]),
            &["planetary.0.sun.body: there is no body `sunn`"],
        ),
        (
            set(
                90.0,
                ["", held, carrier, "count = 3", "sun_torque = \"up\""],
            ),
            &["sun_torque"],
        ),
    ] {
        let complaint = build_in(&text, folder.path()).err().unwrap().to_string();
        for part in expected {
            assert!(complaint.contains(part), "`{part}` is not in: {complaint}");
        }
    }
}
