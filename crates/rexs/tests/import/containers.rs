//! XML, JSON and zip files of one model give the same files.

use crate::{GEARBOX, changed, demand_same, file, names, read};
use gearmesh_rexs::container::unpack;
use gearmesh_rexs::model::{Component, Model, Value};
use gearmesh_rexs::{Meshes, import, xml};
use serde_json::json;
use std::io::Write;

#[test]
fn the_shipped_gearbox_gives_six_gears_two_scenes_and_bearing_files() {
    let made = read(GEARBOX);
    assert_eq!(made.scenes, ["box.toml", "box_case_2.toml"]);
    for name in [
        "box_pinion_17.toml",
        "box_wheel_73.toml",
        "bearing_bearing_1a.toml",
        "bearing_bearing_3b.toml",
    ] {
        file(&made, name);
    }
    let pinion = file(&made, "box_pinion_17.toml");
    for line in [
        "teeth = 17",
        "module_mm = 2.0",
        "helix_angle_deg = 20.0",
        "hand = \"right\"",
        "profile_shift = 0.3",
        "bore_diameter_mm = 18.0",
        "young_GPa = 210.0",
        "flank_angle_um = -9.0",
        "lead_crowning_um = 3.0",
    ] {
        assert!(
            pinion.lines().any(|l| l == line),
            "{line} is not in\n{pinion}"
        );
    }
    let full = file(&made, "box.toml");
    let half = file(&made, "box_case_2.toml");
    // The input is held; the output follows from the balance of power: 1200 and 600 N m.
    assert!(
        full.contains("name = \"machine\"\nbody = \"output shaft/3\"\ntorque_Nm = -1200.0\n"),
        "{full}"
    );
    assert!(half.contains("torque_Nm = -600.0\n"), "{half}");
    assert!(
        full.contains("Load case 1, 60.0000 % of the time"),
        "{full}"
    );
    // Of the two one-way bearings of the first intermediate shaft the one that is pushed holds.
    let held = |name: &str| {
        let table = full
            .split("[[bearing]]")
            .find(|t| t.contains(&format!("\"{name}\"")))
            .unwrap();
        table.contains("axial_stiffness")
    };
    assert!(held("bearing 2A") && !held("bearing 2B"), "{full}");
}

#[test]
fn every_value_is_taken_or_listed() {
    let made = read(GEARBOX);
    let model = xml::read(GEARBOX).unwrap();
    let listed = |component: &Component, attribute: &str| {
        let lists = [&made.ledger.taken, &made.ledger.not_represented];
        lists
            .into_iter()
            .flatten()
            .any(|e| e.subject == component.words() && e.text.starts_with(attribute))
    };
    let mut lost = Vec::new();
    for component in &model.components {
        for a in &component.attributes {
            // Names are those of the newest version.
            let name = a.id.replace(
                "tip_radius_factor",
                "tip_corner_radius_factor_reference_profile",
            );
            if !listed(component, &name) {
                lost.push(format!("{}: {name}", component.words()));
            }
        }
    }
    assert!(lost.is_empty(), "{lost:#?}");
}

#[test]
fn json_gives_the_same_files() {
    let from_xml = read(GEARBOX);
    let text = as_json(&xml::read(GEARBOX).unwrap());
    demand_same(&from_xml, &read(&text));
}

#[test]
fn zip_files_of_either_give_the_same_files() {
    let from_xml = read(GEARBOX);
    let text = as_json(&xml::read(GEARBOX).unwrap());
    for (name, text) in [("deep/model.rexs", GEARBOX), ("model.rexsj", &text)] {
        let bytes = zipped(&[(name, text.as_bytes()), ("picture.png", b"not read")]);
        let made = import(bytes, "box", Meshes::Iso6336).unwrap();
        demand_same(&from_xml, &made);
        let further = made
            .ledger
            .not_represented
            .iter()
            .any(|e| e.text.contains("picture.png"));
        assert!(further, "the picture is not listed");
    }
}

#[test]
fn byte_order_marks_utf_16_and_latin_1_are_read() {
    let text = changed(
        GEARBOX,
        "name=\"input shaft\"",
        "name=\"Welle f\u{fc}r Antrieb\"",
    );
    let utf16 = |big: bool| {
        let pairs = text.encode_utf16().flat_map(|c| {
            if big {
                c.to_be_bytes()
            } else {
                c.to_le_bytes()
            }
        });
        let mark = if big { [0xfe, 0xff] } else { [0xff, 0xfe] };
        mark.into_iter().chain(pairs).collect::<Vec<u8>>()
    };
    let marked = [b"\xef\xbb\xbf", text.as_bytes()].concat();
    let latin = changed(&text, "encoding=\"UTF-8\"", "encoding=\"ISO-8859-1\"");
    let latin: Vec<u8> = latin
        .chars()
        .map(|c| u8::try_from(u32::from(c)).unwrap_or(b'?'))
        .collect();
    for bytes in [marked, utf16(true), utf16(false), latin] {
        let made = import(bytes, "box", Meshes::Iso6336).unwrap();
        assert!(
            file(&made, "box.toml").contains("\"Welle f\u{fc}r Antrieb\""),
            "{:?}",
            names(&made)
        );
    }
}

#[test]
fn a_zip_bomb_is_not_unpacked() {
    // 300 MB of zeros in 300 kB.
    let zeros = vec![b' '; 300 << 20];
    let cause = unpack(zipped(&[("model.rexs", &zeros)]))
        .unwrap_err()
        .to_string();
    assert!(cause.contains("larger than 256 MB"), "{cause}");
}

/// A zip file of some members.
pub fn zipped(members: &[(&str, &[u8])]) -> Vec<u8> {
    let mut writer = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    for (name, bytes) in members {
        let options = zip::write::SimpleFileOptions::default()
            .compression_method(zip::CompressionMethod::Deflated);
        writer.start_file(*name, options).unwrap();
        writer.write_all(bytes).unwrap();
    }
    writer.finish().unwrap().into_inner()
}

fn components(of: &[Component]) -> serde_json::Value {
    of.iter()
        .map(|c| {
            let attributes: Vec<serde_json::Value> = c
                .attributes
                .iter()
                .map(|a| match &a.value {
                    Value::Scalar(text) => match (text.parse::<i64>(), text.parse::<f64>()) {
                        (Ok(number), _) => json!({ "id": a.id, "unit": a.unit, "integer": number }),
                        (_, Ok(number)) => json!({ "id": a.id, "unit": a.unit, "floating_point": number }),
                        _ => json!({ "id": a.id, "unit": a.unit, "string": text }),
                    },
                    // Little endian bytes in base64, as the format allows.
                    Value::List(items) => {
                        use base64::Engine;
                        let bytes = items.iter().flat_map(|i| i.parse::<f64>().unwrap().to_le_bytes());
                        let value = base64::engine::general_purpose::STANDARD.encode(bytes.collect::<Vec<u8>>());
                        json!({ "id": a.id, "unit": a.unit, "floating_point_array_coded": { "code": "float64", "value": value } })
                    }
                    Value::Rows(rows) => json!({ "id": a.id, "unit": a.unit, "string_matrix": rows }),
                })
                .collect();
            json!({ "id": c.id, "type": c.kind, "name": c.name, "attributes": attributes })
        })
        .collect()
}

fn as_json(model: &Model) -> String {
    let relations: Vec<serde_json::Value> = model
        .relations
        .iter()
        .map(|r| {
            let refs: Vec<serde_json::Value> = r
                .references
                .iter()
                .map(|x| json!({ "id": x.id, "role": x.role }))
                .collect();
            json!({ "id": r.id, "type": r.kind, "order": r.order, "refs": refs })
        })
        .collect();
    let cases: Vec<serde_json::Value> = model.spectra[0]
        .cases
        .iter()
        .map(|c| json!({ "id": c.id, "components": components(&c.components) }))
        .collect();
    json!({ "model": {
        "version": model.version,
        "applicationId": "gearmesh",
        "applicationVersion": "0.1",
        "date": "",
        "relations": relations,
        "components": components(&model.components),
        "load_spectrum": { "id": 1, "load_cases": cases },
    } })
    .to_string()
}
