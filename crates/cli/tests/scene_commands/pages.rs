//! Pages of every kind, as a reader meets them: words, numbers, units and what is drawn without a script.

use crate::common::{Desk, argument, changed, run_scene, succeeds};
use crate::hybrid_scene;
use std::path::{Path, PathBuf};

/// Axes of plain numbers.
const WITHOUT_UNIT: [&str; 6] = [
    "loaded pairs",
    "apart",
    "number",
    "load factor",
    "K_H",
    "order",
];

/// Size of a drawing's letters in its own units, and width of a page's text, on a screen of 390 pixels (page.css).
const LETTERS: f64 = 14.0;
const NARROW: f64 = 390.0 - 2.0 * 14.0;

fn shipped(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fe_models");
    folder.join(name)
}

/// Makes a page by a command that ends in its file, and reads it.
fn page(desk: &Desk, name: &str, command: &[&str]) -> (String, String) {
    let file = desk.path(&format!("{name}.html"));
    succeeds(&[command, &[argument(&file)]].concat());
    (name.to_owned(), std::fs::read_to_string(file).unwrap())
}

/// Runs a scene and reports it.
fn reported(desk: &Desk, name: &str, scene: &Path) -> (String, String) {
    let result = desk.path(&format!("{name}.h5"));
    succeeds(&["run", argument(scene), "-o", argument(&result)]);
    page(desk, name, &["report", argument(&result), "-o"])
}

/// A drive that comes to speed in a fifth of a second.
fn run_up(desk: &Desk) -> PathBuf {
    let text = std::fs::read_to_string(shipped("dynamics_17_25.toml")).unwrap();
    let folder = shipped("").canonicalize().unwrap();
    let whole = format!("gear = \"{}/", folder.display());
    let text = text.replace("gear = \"", &whole);
    let text = text.replace("end_s = 2.0", "end_s = 0.2");
    desk.file("run_up.toml", text.replace("end_s = 1.0", "end_s = 0.2"))
}

/// A page for each command and each kind of run that makes one.
fn every_kind(desk: &Desk) -> Vec<(String, String)> {
    let (pair, _) = run_scene(desk, "");
    let mut pages = vec![page(desk, "pair", &["report", argument(&pair), "-o"])];
    let hybrid = hybrid_scene();
    let transient = desk.file("transient.toml", &hybrid);
    pages.push(reported(desk, "transient", &transient));
    let run =
        "kind = \"transient\"\nend_s = 1e-3\n[solver]\nstep_s = 1e-6\n[output]\ninterval_s = 1e-5";
    let eigen = desk.file("eigen.toml", changed(&hybrid, run, "kind = \"eigen\""));
    pages.push(reported(desk, "eigen", &eigen));
    pages.push(reported(
        desk,
        "static",
        &shipped("gearbox_three_stage.toml"),
    ));
    let sweep = "kind = \"speed-sweep\"\nmotion = \"motion of axle of solid\"\nfrom_rpm = -60.0\nto_rpm = -120.0\nspeeds = 3\nsettle_s = 1e-3\nmeasure_s = 1e-3";
    let steps = "\n[solver]\nstep_s = 5e-6\n[output]\ninterval_s = 1e-5";
    let sweep = changed(&hybrid, run, &format!("{sweep}{steps}"));
    pages.push(reported(desk, "sweep", &desk.file("sweep.toml", sweep)));
    pages.push(reported(desk, "run-up", &run_up(desk)));
    let spectrum = desk.path("transient.h5");
    let column = "elements/mesh/transmission_error_m";
    let spectrum = ["signal", "spectrum", argument(&spectrum), column, "-o"];
    pages.push(page(desk, "signal", &spectrum));
    let bearing = shipped("bearing_9_balls.toml");
    let bearing = argument(&bearing);
    for (name, load) in [("thrust", "0,0,500"), ("radial", "0,-1000,100")] {
        let command = ["bearing", bearing, "--load-N", load, "--report"];
        pages.push(page(desk, name, &command));
    }
    let bevel = shipped("bevel_13_35_loaded.toml");
    pages.push(page(desk, "tca", &["tca", argument(&bevel), "--report"]));
    let study = desk.file(
        "study.toml",
        format!(
            "title = \"A bearing\"\nscene = '{bearing}'\ndesign = \"grid\"\noperation = {{ load_N = [0.0, -1000.0, 100.0] }}\n\
             columns = [\"displacement_y_um\", \"pressure_inner_largest_MPa\", \"life_L10_Mrev\"]\n\
             [[parameter]]\nname = \"load N\"\nkeys = [\"operation.load_N.1\"]\nvalues = [-500.0, -1000.0, -1500.0]\n\
             [[parameter]]\nname = \"thrust N\"\nkeys = [\"operation.load_N.2\"]\nvalues = [100.0, 400.0]\n"
        ),
    );
    let out = desk.path("study");
    succeeds(&["study", argument(&study), "-o", argument(&out)]);
    let html = std::fs::read_to_string(out.join("study.html")).unwrap();
    pages.push(("study".to_owned(), html));
    let optimise = desk.file(
        "optimise.toml",
        format!(
            "title = \"A bearing\"\nscene = '{bearing}'\noperation = {{ load_N = [0.0, -1000.0, 100.0] }}\ntrials = 20\nsearches = 1\n\
             [[variable]]\nname = \"thrust N\"\nkeys = [\"operation.load_N.2\"]\nfrom = 50.0\nto = 400.0\n\
             [[objective]]\nname = \"pressure MPa\"\nterm = [{{ column = \"pressure_inner_largest_MPa\" }}]\n\
             [[objective]]\nname = \"moves um, sideways\"\nterm = [{{ column = \"displacement_x_um\" }}]\n"
        ),
    );
    let out = desk.path("optimise");
    succeeds(&["optimise", argument(&optimise), "-o", argument(&out)]);
    let html = std::fs::read_to_string(out.join("optimise.html")).unwrap();
    pages.push(("optimise".to_owned(), html));
    let columns = ["--columns", "te_peak_to_peak_um,k_h_beta", "-o"];
    let scene = desk.path("scene.toml");
    let accuracy = [&["accuracy", argument(&scene)][..], &columns].concat();
    pages.push(page(desk, "accuracy", &accuracy));
    pages
}

/// What stands between each pair of these words.
fn between<'a>(text: &'a str, from: &str, to: &str) -> Vec<&'a str> {
    let parts = text.split(from).skip(1);
    parts.map(|part| part.split(to).next().unwrap()).collect()
}

/// The text without the elements of these names.
fn without(text: &str, names: &[&str]) -> String {
    names.iter().fold(text.to_owned(), |text, name| {
        let begin = format!("<{name}");
        let mut parts = text.split(&begin[..]);
        let first = parts.next().unwrap().to_owned();
        let end = format!("</{name}>");
        let rest = parts.map(|part| part.split_once(&end[..]).map_or(part, |(_, rest)| rest));
        first + &rest.collect::<String>()
    })
}

/// The words that a reader sees, a line for each element; files that are quoted and names of keys are not among them.
fn words(html: &str) -> Vec<String> {
    let body = html.split_once("<body>").unwrap().1;
    let body = without(body, &["script", "style", "pre", "code"]);
    // Indices belong to their letters.
    let body = body.replace("<sub>", "").replace("</sub>", "");
    let parts = body.split('<').filter_map(|part| part.split_once('>'));
    let words = parts.map(|(_, words)| words.trim().to_owned());
    words.filter(|words| !words.is_empty()).collect()
}

fn attribute(element: &str, name: &str) -> f64 {
    let from = between(element, &format!("{name}=\""), "\"");
    from.first().map_or(0.0, |text| text.parse().unwrap())
}

/// Words as in print: no back-ticks, no powers of ten as programs write them, no units and symbols in letters.
fn demand_words(name: &str, html: &str) {
    for words in words(html) {
        let letters: Vec<char> = words.chars().collect();
        let is_power = |w: &[char]| {
            w[0].is_ascii_digit() && w[1] == 'e' && (w[2] == '-' || w[2].is_ascii_digit())
        };
        // Digests of files are long and have no spaces.
        let numbers = words.split(' ').filter(|word| word.len() < 20);
        let power = numbers.map(|word| word.chars().collect::<Vec<_>>());
        let power = power.into_iter().any(|w| w.windows(3).any(is_power));
        assert!(!power, "{name}: {words}");
        assert!(!letters.contains(&'`'), "{name}: {words}");
        for wrong in [
            "K_H", "N m", " um", "urad", "theta", "r_b1", "p_H", "c_gamma", "–:",
        ] {
            assert!(!words.contains(wrong), "{name}: {wrong} in {words}");
        }
    }
}

/// Headings say what stands below them, once each.
fn demand_headings(name: &str, html: &str) {
    for section in between(html, "<section", "</section>") {
        let (heading, below) = section.split_once("</h2>").unwrap();
        assert!(!below.trim().is_empty(), "{name}: nothing below {heading}");
    }
    let headings = between(html, "<h2>", "</h2>");
    for (k, heading) in headings.iter().enumerate() {
        assert!(!headings[..k].contains(heading), "{name}: twice {heading}");
    }
}

/// Every axis has a title and, but for plain numbers, a unit.
fn demand_axes(name: &str, html: &str) {
    let demand = |label: &str, unit: &str| {
        let vague = ["length", "quantity", "value", ""].contains(&label);
        assert!(!vague, "{name}: an axis is called `{label}` [{unit}]");
        let is_number = WITHOUT_UNIT.iter().any(|known| label.contains(known));
        assert!(!unit.is_empty() || is_number, "{name}: {label} has no unit");
    };
    for payload in between(html, "<script type=\"application/json\">", "</script>") {
        let data: serde_json::Value = serde_json::from_str(payload).unwrap();
        for axis in ["x", "y"] {
            if let Some(label) = data[axis]["label"].as_str() {
                demand(label, data[axis]["unit"].as_str().unwrap());
            }
        }
        if let Some(quantity) = data["quantity"].as_str() {
            demand(quantity, data["unit"].as_str().unwrap());
        }
    }
    for figure in between(html, "<figure class=\"polar points\">", "</figure>") {
        let all = between(figure, "<text", "</text>");
        let titles = &all[all.len() - 2..];
        assert!(titles[1].contains("rotate(-90)"), "{name}: {titles:?}");
        for title in titles {
            let title = title.rsplit_once("\">").unwrap().1;
            let (label, unit) = title.split_once(" [").unwrap_or((title, ""));
            demand(label, unit);
        }
    }
}

/// Letters of drawings are readable on a small screen, and none are outside.
fn demand_drawings(name: &str, html: &str) {
    for svg in between(html, "<svg viewBox=\"", "</svg>") {
        let (size, inside) = svg.split_once('"').unwrap();
        let size: Vec<f64> = size.split(' ').map(|n| n.parse().unwrap()).collect();
        let [left, top, width, height] = size[..] else {
            panic!("{name}: {size:?}")
        };
        let letters = LETTERS * NARROW / width;
        assert!(letters >= 10.0, "{name}: letters of {letters:.1} pixels");
        for text in between(inside, "<text", "</text>") {
            let (head, words) = text.split_once('>').unwrap();
            if head.contains("rotate") || head.contains("--fit") {
                continue;
            }
            let wide = 0.6 * LETTERS * words.chars().count() as f64;
            let at = attribute(head, " x");
            let from = match head {
                _ if head.contains("\"end\"") => at - wide,
                _ if head.contains("\"middle\"") => at - 0.5 * wide,
                _ => at,
            };
            let up = attribute(head, " y");
            assert!(
                from >= left - 1.0 && from + wide <= left + width + 1.0,
                "{name}: {words} from {from} of {left} to {}",
                left + width
            );
            assert!(up >= top + 8.0 && up <= top + height, "{name}: {words}");
        }
    }
}

/// K_Hβ of a mesh is the largest of its slices' line loads over their mean, all as the page prints them: to four
/// digits.
fn demand_face_load_factor(html: &str, mesh: &str) {
    let cells = |row: &str| -> Vec<f64> {
        let cells = between(row, "<td class=\"number\">", "</td>");
        cells.iter().map(|cell| cell.parse().unwrap()).collect()
    };
    let rows = between(html, &format!("<td>{mesh}: line load slice"), "</tr>");
    let loads: Vec<f64> = rows.into_iter().map(|row| cells(row)[0]).collect();
    let largest = loads.iter().copied().fold(0.0, f64::max);
    let mean = loads.iter().sum::<f64>() / loads.len() as f64;
    let row = between(html, &format!("<td>{mesh}</td>"), "tilt");
    let found = between(row[0], "<td class=\"number\">", "</td>")[1];
    let found: f64 = found.parse().unwrap();
    assert!(
        loads.len() == 9 && (found - largest / mean).abs() < 1e-3,
        "{found}"
    );
}

#[test]
fn pages_read_as_in_print() {
    let desk = Desk::new();
    for (name, html) in every_kind(&desk) {
        demand_words(&name, &html);
        demand_headings(&name, &html);
        demand_axes(&name, &html);
        demand_drawings(&name, &html);
        // A caption beside its table is not cut where the table scrolls.
        assert!(!html.contains("<caption>"), "{name}");
        // What draws in space is in the page of a pair alone; at one speed there is no waterfall.
        assert_eq!(
            html.contains("data-kind=\"space\""),
            name == "pair",
            "{name}"
        );
        assert_eq!(html.contains("blob:;"), name == "pair", "{name}");
        assert_eq!(
            html.contains("Over time and frequency"),
            name == "run-up",
            "{name}"
        );
        match &name[..] {
            "thrust" => {
                let figures = html.split("</dl>").next().unwrap();
                assert!(figures.contains("<dd>0, 0, "), "sideways displacements");
                assert!(figures.contains("<dd>0, 0 <span>mrad"), "tilts");
            }
            "pair" => {
                let figures = html.split("</dl>").next().unwrap();
                for part in ["mesh stiffness", "p<sub>H</sub>", "K<sub>Hβ</sub>"] {
                    assert!(figures.contains(part), "{part} is not at the top");
                }
            }
            "static" => {
                for part in [
                    "Load across the face",
                    "K<sub>Hβ</sub>",
                    "tilt in the plane",
                ] {
                    assert!(html.contains(part), "{part}");
                }
                assert_eq!(html.matches("<svg viewBox=").count(), 1);
                demand_face_load_factor(&html, "first stage");
            }
            // From rest the speed changes: the mesh frequency and its multiples are drawn over the map.
            "run-up" => {
                assert!(html.contains("<h2>Over time and frequency</h2>"));
                assert!(html.contains("<polyline") && html.contains(">3×</text>"));
            }
            "sweep" => assert!(!html.contains("at −"), "speeds as on the axis"),
            "optimise" => {
                for part in ["at a bound", "weight", "operation.load_N.2"] {
                    assert!(html.contains(part), "{part}");
                }
            }
            _ => {}
        }
    }
}
