//! `[crack]` in gear files.

use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{Flank, GearDefinition, ProfileCurve, RootPosition};

const GEAR: &str = "name = \"g\"\n[tooth]\nteeth = 30\nmodule_mm = 3.0\nface_width_mm = 20.0\n[material]\nyoung_GPa = 210.0\npoisson = 0.3\n";
const SOLID: &str = "[blank]\nkind = \"solid\"\nbore_diameter_mm = 30.0\n";

fn read(rest: &str) -> Result<GearDefinition, String> {
    let document = InputDocument::new("gear.toml", format!("{GEAR}{SOLID}{rest}"));
    GearDefinition::from_document(&document).map_err(|e| e.to_string())
}

#[test]
fn a_crack_starts_across_the_fillet_at_the_30_degree_tangent() {
    assert!(read("").unwrap().crack.is_none());
    let crack = "[crack]\ntooth = 3\nside = \"left\"\ndepth_mm = 1.5\n";
    let found = read(crack).unwrap();
    let curve = ProfileCurve::new(&found.profile);
    let crack = found.crack.unwrap();
    assert_eq!((crack.tooth, crack.side), (3, Flank::Left));
    assert_eq!(crack.start, RootPosition::TangentAngle(30f64.to_radians()));
    assert_eq!(crack.depth_m, 1.5e-3);
    assert!((crack.angle_rad.to_degrees() - 60.0).abs() < 0.05);
    let arc = curve.arc_length_at(crack.start).unwrap();
    assert!((curve.tangent_angle_at_rad(arc).to_degrees() - 30.0).abs() < 0.05);
    let by_radius =
        "[crack]\ntooth = 0\nside = \"right\"\ndepth_mm = 0.2\nangle_deg = 90\nradius_mm = 41.9\n";
    let crack = read(by_radius).unwrap().crack.unwrap();
    assert_eq!(crack.start, RootPosition::Radius(41.9e-3));
    assert!((crack.angle_rad.to_degrees() - 90.0).abs() < 1e-12);
}

#[test]
fn cracks_that_cannot_be_are_named_with_line_and_key() {
    let line = "gear.toml:13: crack.";
    for (keys, expected) in [
        (
            "tooth = 30\nside = \"left\"\ndepth_mm = 1.0",
            "tooth: found 30, allowed is 0 to 29",
        ),
        (
            "depth_mm = 0.0\ntooth = 3\nside = \"left\"",
            "depth_mm: found 0, allowed is more than 0 and less than",
        ),
        (
            "depth_mm = 9.0\ntooth = 3\nside = \"left\"",
            "depth_mm: found 9",
        ),
        (
            "angle_deg = 91.0\ntooth = 3\nside = \"left\"\ndepth_mm = 1.0",
            "angle_deg: found 91, allowed is 0",
        ),
        (
            "tangent_deg = 5.0\ntooth = 3\nside = \"left\"\ndepth_mm = 1.0",
            "tangent_deg: found a tangent",
        ),
        (
            "radius_mm = 45.0\ntooth = 3\nside = \"left\"\ndepth_mm = 1.0",
            "radius_mm: the crack's mouth lies on the flank",
        ),
        (
            "radius_mm = 42.0\ntangent_deg = 30.0\ntooth = 3\nside = \"left\"\ndepth_mm = 1.0",
            "radius_mm: tangent_deg and radius_mm both place the crack's mouth",
        ),
    ] {
        let text = read(&format!("[crack]\n{keys}\n")).unwrap_err();
        assert!(
            text.starts_with(line) && text.contains(expected),
            "{keys}: {text}"
        );
    }
    let crack = "[crack]\ntooth = 3\nside = \"left\"\ndepth_mm = 1.0\n";
    for (rest, expected) in [
        ("depth = 1.0\n", "unknown field `depth`"),
        (
            "[reduction]\nflanks = [\"right\"]\n",
            "crack.side: loads on the left flanks open this crack",
        ),
        (
            "[mesh]\nelement = \"tet10\"\n",
            "crack: a crack follows the sides of hexahedra",
        ),
    ] {
        let text = read(&format!("{crack}{rest}")).unwrap_err();
        assert!(text.contains(expected), "{rest}: {text}");
    }
}
