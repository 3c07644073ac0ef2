//! The text of gear files.

use crate::cylindrical::Gear;
use crate::text::{comment, number, numbers, quoted};

/// Text of the file of a gear.
pub fn gear_file(gear: &Gear, origin: &str) -> String {
    let mut text = format!(
        "# {}\nname = {}\n\n[tooth]\nteeth = {}\n",
        comment(origin),
        quoted(&gear.name),
        i64::from(gear.teeth) * gear.sign() as i64
    );
    let mut key = |name: &str, value: f64| text.push_str(&format!("{name} = {}\n", number(value)));
    key("module_mm", gear.module_mm);
    key("pressure_angle_deg", gear.pressure_angle_deg);
    if gear.helix_deg != 0.0 {
        key("helix_angle_deg", gear.helix_deg.abs());
    }
    key("profile_shift", gear.profile_shift);
    key("face_width_mm", gear.face_width_mm);
    match gear.tip_diameter_mm {
        Some(tip) => key("tip_diameter_mm", tip),
        None => key("addendum", gear.addendum),
    }
    if !gear.internal {
        key("dedendum", gear.dedendum);
        key("rack_tip_radius", gear.rack_tip_radius);
    }
    if gear.thickness_allowance_mm > 0.0 {
        key("thickness_allowance_mm", gear.thickness_allowance_mm);
    }
    if gear.tip_chamfer_mm > 0.0 {
        key("tip_chamfer_mm", gear.tip_chamfer_mm);
    }
    if gear.helix_deg != 0.0 {
        let hand = if gear.helix_deg > 0.0 {
            "right"
        } else {
            "left"
        };
        text.push_str(&format!("hand = \"{hand}\"\n"));
    }
    let blank = match gear.internal {
        true => "ring\"\nouter_diameter_mm",
        false => "solid\"\nbore_diameter_mm",
    };
    text.push_str(&format!(
        "\n[blank]\nkind = \"{blank} = {}\n",
        number(gear.bore_mm.unwrap_or(0.0))
    ));
    if let Some(ends) = gear.shaft_mm {
        text.push_str(&format!("shaft_diameter_mm = {}\n", numbers(&ends)));
    }
    let m = gear.material;
    text.push_str(&format!(
        "\n[material]\nyoung_GPa = {}\npoisson = {}\ndensity_kg_per_m3 = {}\n",
        number(m.young_gpa),
        number(m.poisson),
        number(m.density_kg_per_m3)
    ));
    let sides = [
        ("left", &gear.microgeometry.left),
        ("right", &gear.microgeometry.right),
    ];
    if gear.microgeometry.left == gear.microgeometry.right && !gear.microgeometry.left.is_empty() {
        text.push_str("\n[microgeometry]\n");
        keys(&mut text, &gear.microgeometry.left);
    } else {
        for (side, list) in sides.into_iter().filter(|(_, list)| !list.is_empty()) {
            text.push_str(&format!("\n[microgeometry.{side}]\n"));
            keys(&mut text, list);
        }
    }
    text
}

fn keys(text: &mut String, list: &[(String, String)]) {
    for (key, value) in list {
        text.push_str(&format!("{key} = {value}\n"));
    }
}
