//! Cutters and gear files of rings: what is read, what is refused by its key.

use gearmesh_geometry::definition::{Gearing, InternalRoot, PinionCutter, ToothDefinition};
use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{GearDefinition, ToothGeometry, involute};

use crate::rings::*;

/// Cutters that cannot cut a ring, each with the number that helps.
#[test]
fn cutters_that_do_not_suit_are_refused() {
    let of = |d: &ToothDefinition| ToothGeometry::new(d).unwrap_err().to_string();
    let small = of(&cut(
        99,
        0.0,
        PinionCutter {
            teeth: 14,
            profile_shift: 0.0,
            tip_radius: 0.1,
            ..CUTTER
        },
    ));
    assert!(
        small.contains("makes no involute at the ring's tip"),
        "{small}"
    );
    let large = of(&cut(
        99,
        0.0,
        PinionCutter {
            teeth: 93,
            ..CUTTER
        },
    ));
    assert!(
        large.contains("tips of the ring") && large.contains("fewer teeth"),
        "{large}"
    );
    let equal = of(&cut(
        99,
        0.0,
        PinionCutter {
            teeth: 98,
            ..CUTTER
        },
    ));
    assert!(equal.contains("at most 96"), "{equal}");
    let round = of(&cut(
        99,
        0.0,
        PinionCutter {
            tip_radius: 0.6,
            ..CUTTER
        },
    ));
    assert!(
        round.contains("does not fit on the cutter's tooth"),
        "{round}"
    );
    let inside = of(&ToothDefinition {
        addendum: 1.3,
        ..broached(30, 0.5)
    });
    assert!(
        inside.contains("must lie outside its base circle"),
        "{inside}"
    );
    let full = of(&ToothDefinition {
        dedendum: 3.0,
        ..broached(99, 0.0)
    });
    assert!(full.contains("no full root radius"), "{full}");
    // The default suits rings of any common size.
    for teeth in 30..200 {
        let mut d = external(teeth, 0.0);
        d.addendum = 0.8;
        let cutter = PinionCutter::suited(&d, None, 0.0, None, None);
        d.gearing = Gearing::Internal(InternalRoot::Cutter(cutter));
        geometry(&d);
    }
}

const FILE: &str = "name = \"ring\"\n[tooth]\nteeth = -99\nmodule_mm = 2.0\naddendum = 0.8\nface_width_mm = 20.0\n[blank]\nkind = \"ring\"\n\
    outer_diameter_mm = 220.0\n[material]\nyoung_GPa = 206.0\npoisson = 0.3\n";

fn read(find: &str, replace: &str) -> Result<GearDefinition, String> {
    assert!(FILE.contains(find), "{find}");
    let text = FILE.replacen(find, replace, 1);
    GearDefinition::from_document(&InputDocument::new("ring.toml", text)).map_err(|e| e.to_string())
}

/// A ring's file: defaults, and what is refused by its key.
#[test]
fn the_file_of_a_ring_is_read_and_checked() {
    let ring = read("", "").unwrap();
    assert_eq!((ring.tooth.teeth, ring.tooth.signed_teeth()), (99, -99));
    let Gearing::Internal(InternalRoot::Cutter(cutter)) = ring.tooth.gearing else {
        panic!("{:?}", ring.tooth.gearing)
    };
    assert_eq!(
        (cutter.teeth, cutter.addendum, cutter.tip_radius),
        (33, 1.25, 0.25)
    );
    assert_eq!(ring.blank.edge_radius_m(), 0.11);
    let band = read(
        "outer_diameter_mm",
        "held_band_mm = [-10.0, 4.0]\nouter_diameter_mm",
    )
    .unwrap();
    assert_eq!(band.blank.rim().unwrap().held_z_m, Some([-0.01, 0.004]));
    let round = read(
        "face_width_mm",
        "root = \"full-round\"\ndedendum = 1.2\nface_width_mm",
    )
    .unwrap();
    assert!((round.profile.root_radius_m - 0.1014).abs() < 1e-12);
    for (find, replace, needed) in [
        (
            "kind = \"ring\"\nouter",
            "kind = \"solid\"\nbore",
            "blank.kind: internal teeth stand inside a ring",
        ),
        (
            "teeth = -99",
            "teeth = 99",
            "\"ring\" is the body of internal teeth",
        ),
        (
            "teeth = -99",
            "teeth = -11",
            "-1000 to -12 for internal teeth",
        ),
        (
            "face_width_mm",
            "dedendum = 1.2\nface_width_mm",
            "tooth.dedendum: is not used by internal teeth whose root a pinion cutter makes",
        ),
        (
            "face_width_mm",
            "rack_tip_radius = 0.3\nface_width_mm",
            "tooth.rack_tip_radius: is not used by internal teeth",
        ),
        (
            "[blank]",
            "[tooth.cutter]\nteeth = 98\n[blank]",
            "tooth.cutter.teeth: found 98, allowed is 5 to 96",
        ),
        (
            "[blank]",
            "[tooth.cutter]\nteeth = 12\n[blank]",
            "makes no involute at the ring's tip",
        ),
        (
            "face_width_mm = 20.0\n",
            "root = \"full-round\"\nface_width_mm = 20.0\n[tooth.cutter]\nteeth = 30\n",
            "tooth.cutter: is not used by root",
        ),
        (
            "220.0",
            "204.0",
            "blank.outer_diameter_mm: found 204, allowed is",
        ),
        (
            "outer_diameter_mm",
            "held_band_mm = [-10.0, 12.0]\nouter_diameter_mm",
            "blank.held_band_mm.1: found 12",
        ),
        (
            "outer_diameter_mm",
            "held_band_mm = [2.0, 2.0]\nouter_diameter_mm",
            "above the back, 2",
        ),
        (
            "[material]",
            "[mesh]\nelement = \"tet10\"\n[material]",
            "mesh.element: a ring is meshed in hexahedra",
        ),
        (
            "[material]",
            "[hub]\nsupport = \"reference-point\"\n[material]",
            "hub.support: a ring is fixed where it is held",
        ),
        (
            "[material]",
            "[reduction.bore]\nharmonics = 8\n[material]",
            "reduction.bore: blank.kind = \"ring\", which is held outside, does not use it",
        ),
        (
            "[material]",
            "[blank.lugs]\ncount = 6\nwidth_deg = 59.9\n[material]",
            "blank.lugs.width_deg: found 59.9, allowed is",
        ),
        (
            "[material]",
            "[blank.lugs]\ncount = 2\nwidth_deg = 180.0\n[material]",
            "blank.lugs.width_deg: found 180, allowed is more than 0 and less than 180",
        ),
        (
            "[material]",
            "[crack]\ntooth = 0\nside = \"right\"\ndepth_mm = 0.5\ntangent_deg = 45.0\n[material]",
            "cracks are made in external teeth only",
        ),
        (
            "outer_diameter_mm = 220.0",
            "outer_diameter_mm = 220.0\nheld_band_mm = [0.0, 5.0]\n[mesh]\nplane_strain = true",
            "mesh.plane_strain: plane strain knows no band",
        ),
    ] {
        let text = read(find, replace).unwrap_err();
        assert!(text.contains(needed), "{replace}: {text}");
    }
    // External gears know nothing of cutters.
    let wheel = "teeth = 40\nroot = \"cutter\"";
    let text = read("teeth = -99", wheel).unwrap_err();
    assert!(
        text.contains("tooth.root: is used by internal teeth only"),
        "{text}"
    );
}

/// Reliefs and crowning of a ring's flank stand where they are stated: from the start diameter towards the tip, which
/// is the smaller one.
#[test]
fn microgeometry_of_a_ring_stands_where_it_is_stated() {
    let given = "[microgeometry]\ntip_relief_um = 20.0\ntip_relief_start_diameter_mm = 197.0\nroot_relief_um = 10.0\n\
        root_relief_start_diameter_mm = 200.5\nprofile_angle_um = 6.0\n[material]";
    let ring = read("[material]", given).unwrap();
    let flank = ring.microgeometry.right;
    let at = |diameter_mm: f64| {
        let roll = involute::roll_angle_rad(0.5e-3 * diameter_mm, ring.profile.base_radius_m);
        1e6 * flank.removed_m(roll, 0.0)
    };
    let tip_mm = 2e3 * ring.profile.tip_radius_m;
    let form_mm = 2e3 * involute::radius_m(ring.profile.form_roll_rad, ring.profile.base_radius_m);
    assert!((at(tip_mm) - 23.0).abs() < 1e-6, "{}", at(tip_mm));
    assert!((at(form_mm) - (10.0 - 3.0)).abs() < 1e-6, "{}", at(form_mm));
    assert!(at(199.0).abs() < 3.0 && at(197.0) > 0.0 && at(200.5) < 0.0);
    // Half the slope is added at the form circle, and no more anywhere on the flank.
    assert!(
        (1e6 * flank.most_added_m() - 3.0).abs() < 1e-9,
        "{}",
        flank.most_added_m()
    );
    for (key, diameter) in [("tip_relief", 194.0), ("tip_relief", 204.0)] {
        let text = format!(
            "[microgeometry]\n{key}_um = 20.0\n{key}_start_diameter_mm = {diameter}\n[material]"
        );
        let error = read("[material]", &text).unwrap_err();
        assert!(error.contains("the involute part of the flank"), "{error}");
    }
}
