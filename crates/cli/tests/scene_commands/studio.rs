//! `gearmesh studio` without a browser: figures as those of `gearmesh run`, and what the server refuses or survives.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use serde_json::{Value, json};

use crate::common::{Desk, argument, changed, number, refused, run_scene, succeeds, workshop};
use crate::hybrid_scene;

/// A server, which ends with the test.
struct Studio {
    child: Child,
    port: u16,
    token: String,
}

/// What it answered.
#[derive(Debug)]
struct Reply {
    status: u16,
    head: String,
    body: String,
}

impl Reply {
    fn json(&self) -> Value {
        serde_json::from_str(&self.body).unwrap_or_else(|e| panic!("{e} in {self:?}"))
    }
}

impl Studio {
    fn open(file: &std::path::Path) -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_gearmesh"))
            .args(["studio", argument(file), "--no-open"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut line = String::new();
        let mut output = BufReader::new(child.stdout.take().unwrap());
        output.read_line(&mut line).unwrap();
        let address = line.trim().strip_prefix("http://127.0.0.1:").expect(&line);
        let (port, token) = address.split_once("/?token=").unwrap();
        assert_eq!(token.len(), 48);
        Self {
            child,
            port: port.parse().unwrap(),
            token: token.to_owned(),
        }
    }

    /// Sends lines and a body, and reads to the end of the answer.
    fn send(&self, lines: &[String], body: &str) -> Reply {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream
            .set_read_timeout(Some(Duration::from_secs(60)))
            .unwrap();
        let head = lines.join("\r\n");
        let text = format!(
            "{head}\r\nConnection: close\r\nContent-Length: {}\r\n\r\n{body}",
            body.len()
        );
        // A server that refuses a long body closes before it has all of it.
        let _ = stream.write_all(text.as_bytes());
        let mut answer = Vec::new();
        let _ = stream.read_to_end(&mut answer);
        let answer = String::from_utf8(answer).unwrap();
        let (head, body) = answer.split_once("\r\n\r\n").unwrap_or((&answer, ""));
        let status = head.split(' ').nth(1).and_then(|word| word.parse().ok());
        Reply {
            status: status.unwrap_or(0),
            head: head.to_owned(),
            body: body.to_owned(),
        }
    }

    fn lines(&self, request: &str) -> Vec<String> {
        vec![
            format!("{request} HTTP/1.1"),
            format!("Host: 127.0.0.1:{}", self.port),
            format!("X-Gearmesh-Token: {}", self.token),
        ]
    }

    fn get(&self, path: &str) -> Reply {
        self.send(&self.lines(&format!("GET {path}")), "")
    }

    fn post(&self, path: &str, body: &Value) -> Reply {
        let mut lines = self.lines(&format!("POST {path}"));
        lines.push("Content-Type: application/json".to_owned());
        self.send(&lines, &body.to_string())
    }
}

impl Drop for Studio {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// What does not depend on the clock.
fn timeless(mut figures: Value) -> Value {
    figures.as_object_mut().unwrap().remove("seconds");
    figures
}

fn pair_scene(desk: &Desk) -> std::path::PathBuf {
    desk.file("pair.toml", workshop().scene(""))
}

fn printed(desk: &Desk, text: &str) -> Value {
    let scene = desk.file("changed.toml", text);
    let output = desk.path("changed.h5");
    timeless(succeeds(&["run", argument(&scene), "-o", argument(&output), "--json"]).json())
}

#[test]
fn changed_pairs_have_the_figures_of_run() {
    let desk = Desk::new();
    let studio = Studio::open(&pair_scene(&desk));
    let as_it_is = studio.post("/api/pair", &json!({}));
    assert_eq!(as_it_is.status, 200, "{as_it_is:?}");
    let as_it_is = as_it_is.json();
    assert_eq!(
        timeless(as_it_is["figures"].clone()),
        printed(&desk, &workshop().scene(""))
    );

    // The same change by hand, key by key.
    let change = json!({
        "settings": {
            "pair.centre_distance_mm": 54.72,
            "pair.deviation_mrad": 0.037,
            "gear_1.microgeometry.tip_relief_um": 7.3,
            "gear_1.microgeometry.tip_relief_start_diameter_mm": 57.0,
            "gear_1.microgeometry.tip_relief_shape": "parabolic",
            "gear_2.microgeometry.lead_crowning_um": 4,
            "mesh.teeth.friction.dynamic_coefficient": 0.06,
            "run.torques_Nm": [20, 45.5, 60],
            "run.points_per_pitch": 9,
        },
        "removed": ["gauges.gear_2"],
    });
    let by_hand = workshop().scene("");
    let mut by_hand = changed(
        &by_hand,
        "centre_distance_mm = 54.7\n",
        "centre_distance_mm = 54.72\ndeviation_mrad = 0.037\n",
    );
    for (from, to) in [
        ("[20.0, 60.0]", "[20.0, 45.5, 60.0]"),
        ("points_per_pitch = 8", "points_per_pitch = 9"),
        ("[gauges]\ngear_2 = [\"tension\"]\n", ""),
    ] {
        by_hand = changed(&by_hand, from, to);
    }
    by_hand += "teeth.friction = { model = \"coulomb\", dynamic_coefficient = 0.06 }\n\
        [gear_1.microgeometry]\ntip_relief_um = 7.3\ntip_relief_start_diameter_mm = 57.0\ntip_relief_shape = \"parabolic\"\n\
        [gear_2.microgeometry]\nlead_crowning_um = 4.0\n";
    let answer = studio.post("/api/pair", &change);
    assert_eq!(answer.status, 200, "{answer:?}");
    let answer = answer.json();
    let expected = printed(&desk, &by_hand);
    assert_eq!(timeless(answer["figures"].clone()), expected);
    assert_ne!(
        expected["rows"][0]["te_mean_m"],
        as_it_is["figures"]["rows"][0]["te_mean_m"]
    );

    // What is saved gives the same figures from any folder.
    let saved = studio.post("/api/pair/toml", &change);
    assert_eq!(saved.status, 200, "{saved:?}");
    let elsewhere = Desk::new();
    assert_eq!(printed(&elsewhere, &saved.body), expected);

    // A change more and back: the numbers of the beginning.
    assert_eq!(
        timeless(studio.post("/api/pair", &json!({})).json()["figures"].clone()),
        timeless(as_it_is["figures"].clone())
    );
}

/// The result of a run is opened with its scene and its models.
#[test]
fn curves_are_those_of_the_result_file() {
    let desk = Desk::new();
    let (file, _) = run_scene(&desk, "");
    let result = gearmesh_scene::SceneResult::read(&file).unwrap();
    let studio = Studio::open(&file);
    let answer = studio.post("/api/pair", &json!({})).json();
    let curve =
        |key: &str| -> Vec<f64> { answer[key].as_array().unwrap().iter().map(number).collect() };
    let scaled =
        |values: &[f64], factor: f64| -> Vec<f64> { values.iter().map(|x| factor * x).collect() };
    assert_eq!(curve("te_um"), scaled(&result.te_m, 1e6));
    assert_eq!(curve("pressure_MPa"), scaled(&result.pressure_pa, 1e-6));
    assert_eq!(curve("force_N"), result.force_n);
    let strain: Vec<f64> = answer["strain"][0]["method_2_ustrain"]
        .as_array()
        .unwrap()
        .iter()
        .map(number)
        .collect();
    assert_eq!(strain, scaled(&result.strain[0].method_2, 1e6));
    // Slices touch on the flank of gear 1: their places have its diameters.
    let (diameters, points) = (curve("diameter_mm"), curve("point_mm"));
    let mut touching = 0;
    for (diameter, point) in diameters
        .iter()
        .zip(points.chunks(2))
        .filter(|(d, _)| **d > 0.0)
    {
        assert!((2.0 * point[0].hypot(point[1]) - diameter).abs() < 1e-9 * diameter);
        assert!((47.0..61.0).contains(diameter), "{diameter}");
        touching += 1;
    }
    assert!(touching >= result.angles());
    // At every position the forces make the torque: sum of normal forces times the base radius of gear 2.
    let base_2_m = 1e-3 * 0.5 * 3.0 * 18.0 * 20f64.to_radians().cos();
    let block = result.slots * result.slices;
    for (k, forces) in curve("force_N").chunks(block).enumerate() {
        let torque = result.torque_nm[k / result.angles()];
        assert!((forces.iter().sum::<f64>() * base_2_m / torque - 1.0).abs() < 1e-9);
    }
}

#[test]
fn keys_are_those_of_the_schema_and_pitch_errors_are_felt() {
    let desk = Desk::new();
    let studio = Studio::open(&pair_scene(&desk));
    let description = studio.get("/api/pair").json();
    let fields = description["fields"].as_array().unwrap();
    let field = |key: &str| {
        fields
            .iter()
            .find(|field| field["key"] == key)
            .unwrap_or_else(|| panic!("{key}"))
    };
    let schema = succeeds(&["schema", "scene"]).json();
    let words =
        &schema["$defs"]["MicrogeometryTable"]["properties"]["tip_relief_um"]["description"];
    let relief = field("gear_1.microgeometry.tip_relief_um");
    assert_eq!(&relief["help"], words);
    assert_eq!(
        (&relief["unit"], &relief["label"]),
        (&json!("µm"), &json!("tip relief"))
    );
    assert!(relief["with"]["gear_1.microgeometry.tip_relief_start_diameter_mm"].is_number());
    assert_eq!(field("pair.centre_distance_mm")["stated"], json!(54.7));
    assert_eq!(
        field("gauges.gear_2")["kind"]["names"],
        json!(["tension", "compression"])
    );
    assert!(fields.len() > 40, "{}", fields.len());
    // Nothing that names a file.
    for part in ["pair.gear_1", "misalignment_from", "topography", "profile"] {
        let named = fields
            .iter()
            .filter(|field| field["key"].as_str().unwrap().ends_with(part));
        assert_eq!(named.count(), 0, "{part}");
    }
    assert_eq!(description["gears"][0]["teeth"], json!(18));

    let mut removed = vec![0.0; 18];
    removed[3] = 12.5;
    let key = "mesh.teeth.errors_1";
    let answer = studio.post(
        "/api/pair",
        &json!({"settings": {key: removed, "run.pitches": 18}}),
    );
    assert_eq!(answer.status, 200, "{answer:?}");
    let numbers: Vec<String> = removed.iter().map(|x| format!("{x:?}")).collect();
    let by_hand = changed(&workshop().scene(""), "pitches = 3", "pitches = 18")
        + &format!(
            "teeth.errors_1 = [{{ kind = \"pitch\", side = \"right\", removed_um = [{}] }}]\n",
            numbers.join(", ")
        );
    assert_eq!(
        timeless(answer.json()["figures"].clone()),
        printed(&desk, &by_hand)
    );
    let few = studio.post("/api/pair", &json!({"settings": {key: [1.0, 2.0]}}));
    assert_eq!(few.status, 422);
    assert!(few.body.contains("18 numbers"), "{few:?}");
}

#[test]
fn what_is_wrong_is_said_in_the_words_of_the_program() {
    let desk = Desk::new();
    let studio = Studio::open(&pair_scene(&desk));
    for (change, parts) in [
        (
            json!({"settings": {"pair.centre_distance_mm": -1}}),
            vec!["more than 0"],
        ),
        (
            json!({"settings": {"pair.centre_distance_mm": "far"}}),
            vec!["pair.centre_distance_mm", "a number"],
        ),
        (
            json!({"settings": {"gear_1.microgeometry.tip_relief_um": 5}}),
            vec!["needs tip_relief_start_diameter_mm"],
        ),
        (
            json!({"settings": {"pair.gear_1": "/etc/passwd"}}),
            vec!["pair.gear_1", "no key that the page may set"],
        ),
        (
            json!({"settings": {"pair.gear_1:blank.web_thickness_mm": 3}}),
            vec!["no key"],
        ),
        (
            json!({"settings": {"mesh.model.local": "none at all"}}),
            vec!["calibrated"],
        ),
        (
            json!({"settings": {"run.pitches": 1.5}}),
            vec!["a whole number"],
        ),
        (
            json!({"settings": {"run.pitches": 90000}}),
            vec!["run.pitches", "gearmesh run"],
        ),
        (
            json!({"settings": {"gauges.gear_2": ["elsewhere"]}}),
            vec!["tension, compression"],
        ),
        (json!({"removed": ["run.torques_Nm"]}), vec!["torques_Nm"]),
        (json!({"settings": 3}), vec!["settings"]),
        (json!({"setings": {}}), vec!["setings"]),
    ] {
        let answer = studio.post("/api/pair", &change);
        assert_eq!(answer.status, 422, "{change}: {answer:?}");
        let said = answer.json();
        assert_eq!(said["kind"], "input");
        for part in parts {
            assert!(
                said["error"].as_str().unwrap().contains(part),
                "{change}: {answer:?}"
            );
        }
    }
    // It goes on.
    assert_eq!(studio.post("/api/pair", &json!({})).status, 200);

    refused(
        &crate::common::gearmesh(&["studio", "nothing.toml", "--no-open"]),
        2,
        &["nothing.toml"],
    );
    let system = desk.file("system.toml", hybrid_scene());
    refused(
        &crate::common::gearmesh(&["studio", argument(&system), "--no-open"]),
        2,
        &["gearmesh run"],
    );
    let taken = studio.port.to_string();
    let scene = pair_scene(&desk);
    let again = ["studio", argument(&scene), "--no-open", "--port", &taken];
    refused(&crate::common::gearmesh(&again), 2, &["--port", &taken]);
}

#[test]
fn strangers_are_refused() {
    let desk = Desk::new();
    let studio = Studio::open(&pair_scene(&desk));
    let with = |request: &str, place: usize, line: &str| {
        let mut lines = studio.lines(request);
        match line {
            "" => drop(lines.remove(place)),
            line if place == lines.len() => lines.push(line.to_owned()),
            line => line.clone_into(&mut lines[place]),
        }
        studio.send(&lines, "")
    };
    let session = "GET /api/session";
    assert_eq!(studio.get("/api/session").status, 200);
    let wrong = format!(
        "X-Gearmesh-Token: {}",
        studio.token.replace(['a', '0'], "b")
    );
    for (place, line) in [
        (2, ""),
        (2, &wrong[..]),
        (2, "X-Gearmesh-Token: "),
        (3, "X-Gearmesh-Token: twice"),
        // A name that leads here (DNS rebinding), and none.
        (1, "Host: gears.example"),
        (1, "Host: gears.example:80"),
        (1, ""),
        (3, "Origin: http://gears.example"),
        (3, "Origin: null"),
        (3, "Origin: https://127.0.0.1"),
    ] {
        let reply = with(session, place, line);
        assert!(
            reply.status == 403 || reply.status == 400,
            "{line}: {reply:?}"
        );
        assert!(!reply.body.contains("version"), "{line}: {reply:?}");
    }
    let own = format!("Origin: http://127.0.0.1:{}", studio.port);
    assert_eq!(with(session, 3, &own).status, 200);
    // Every address below /api asks for the token, known or not.
    for request in [
        "GET /api/pair",
        "POST /api/pair",
        "POST /api/quit",
        "POST /api/stop",
        "GET /api/nothing",
    ] {
        assert_eq!(with(request, 2, "").status, 403, "{request}");
    }
    // The page needs none, has no numbers, and may not be framed or load from elsewhere.
    let page = with("GET /", 2, "");
    assert_eq!(page.status, 200);
    assert!(
        page.head.contains("default-src 'none'") && page.head.contains("no-referrer"),
        "{}",
        page.head
    );
    assert!(!page.body.contains(&studio.token));

    for path in [
        "/assets/../Cargo.toml",
        "/assets/../../../../etc/passwd",
        "/assets/%2e%2e%2f%2e%2e%2fCargo.toml",
        "/assets/..%5c..%5cCargo.toml",
        "/assets//etc/passwd",
        "/assets/",
        "/etc/passwd",
        "/pair.toml",
        "//etc/passwd",
        "/api/../assets/main.js",
    ] {
        let reply = studio.get(path);
        assert_eq!(reply.status, 404, "{path}: {reply:?}");
    }
    for (method, path) in [
        ("DELETE", "/api/pair"),
        ("PUT", "/"),
        ("POST", "/assets/main.js"),
    ] {
        let reply = studio.send(&studio.lines(&format!("{method} {path}")), "");
        assert_eq!(reply.status, 404, "{method} {path}: {reply:?}");
    }
    // What other pages can send unasked is not read as JSON.
    let mut lines = studio.lines("POST /api/pair");
    lines.push("Content-Type: text/plain".to_owned());
    assert_eq!(studio.send(&lines, "{}").status, 415);
    let long = json!({"settings": {"run.torques_Nm": vec![1.0; 200_000]}});
    let reply = studio.post("/api/pair", &long);
    assert!(reply.status == 413 || reply.status == 0, "{reply:?}");
    let deep = format!("{{\"settings\": {{\"a\": {}}}}}", "[".repeat(100_000));
    let mut lines = studio.lines("POST /api/pair");
    lines.push("Content-Type: application/json".to_owned());
    assert!((400..500).contains(&studio.send(&lines, &deep).status));
    assert_eq!(studio.get("/api/session").status, 200);
}

/// Of many requests at once the newest is answered; the others are, too, or hear that they were overtaken.
#[test]
fn a_flood_is_survived() {
    let desk = Desk::new();
    let mut studio = Studio::open(&pair_scene(&desk));
    let ask = |k: usize| {
        let relief = json!({"settings": {"pair.deviation_mrad": 1e-3 * (k % 7) as f64}});
        studio.post("/api/pair", &relief).status
    };
    let statuses: Vec<u16> = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..16)
            .map(|worker| {
                scope.spawn(move || (0..25).map(|k| ask(worker + k)).collect::<Vec<u16>>())
            })
            .collect();
        workers
            .into_iter()
            .flat_map(|worker| worker.join().unwrap())
            .collect()
    });
    assert_eq!(statuses.len(), 400);
    assert!(
        statuses.iter().all(|status| [200, 409].contains(status)),
        "{statuses:?}"
    );
    let answered = statuses.iter().filter(|status| **status == 200).count();
    assert!(
        answered > 0 && answered < 400,
        "{answered} of 400 were computed"
    );
    // Half requests, and connections that only stay open.
    let idle: Vec<TcpStream> = (0..50)
        .map(|_| TcpStream::connect(("127.0.0.1", studio.port)).unwrap())
        .collect();
    (&idle[0])
        .write_all(b"POST /api/pair HTTP/1.1\r\nHo")
        .unwrap();
    assert_eq!(ask(0), 200);
    // It ends when it is asked, though they are open.
    assert_eq!(studio.post("/api/quit", &json!({})).status, 200);
    assert_eq!(studio.child.wait().unwrap().code(), Some(0));
    assert!(TcpStream::connect(("127.0.0.1", studio.port)).is_err());
    drop(idle);
}

/// A long calculation is stopped, by a button or by a newer one.
#[test]
fn long_calculations_stop() {
    let desk = Desk::new();
    let studio = Studio::open(&pair_scene(&desk));
    let long = json!({"settings": {"run.pitches": 300, "run.points_per_pitch": 200}});
    std::thread::scope(|scope| {
        let waiting = scope.spawn(|| studio.post("/api/pair", &long));
        let begun = std::time::Instant::now();
        while begun.elapsed() < Duration::from_secs(20)
            && number(&studio.get("/api/progress").json()["solved"]) < 10.0
        {
            std::thread::sleep(Duration::from_millis(5));
        }
        assert_eq!(studio.post("/api/stop", &json!({})).status, 200);
        let reply = waiting.join().unwrap();
        assert_eq!(
            (reply.status, &reply.json()["kind"]),
            (409, &json!("stopped"))
        );

        let waiting = scope.spawn(|| studio.post("/api/pair", &long));
        std::thread::sleep(Duration::from_millis(50));
        assert_eq!(studio.post("/api/pair", &json!({})).status, 200);
        let reply = waiting.join().unwrap();
        assert_eq!(
            (reply.status, &reply.json()["kind"]),
            (409, &json!("overtaken"))
        );
    });
}

/// Columns of a multibody result: every peak is there, whatever is left out.
#[test]
fn columns_of_a_system_are_drawn_with_their_peaks() {
    let desk = Desk::new();
    let scene = desk.file("system.toml", hybrid_scene());
    let result = desk.path("system.h5");
    succeeds(&["run", argument(&scene), "-o", argument(&result)]);
    let studio = Studio::open(&result);
    let description = studio.get("/api/columns").json();
    let name = description["columns"][0]["name"]
        .as_str()
        .unwrap()
        .to_owned();
    assert_eq!(description["axis"]["name"], "time_s");
    let reply = studio.post("/api/columns", &json!({"columns": [name]}));
    assert_eq!(reply.status, 200, "{reply:?}");
    let file = gearmesh_scene::ResultFile::open(&result).unwrap();
    let gearmesh_scene::ResultFile::System(file) = file else {
        panic!("a system")
    };
    let all = file.rows.read(&name).unwrap();
    let drawn: Vec<f64> = reply.json()["curves"][0]
        .as_array()
        .unwrap()
        .iter()
        .map(number)
        .collect();
    let most = |values: &[f64]| values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    assert_eq!(most(&drawn), most(&all));
    let spectrum = studio.post(
        "/api/columns",
        &json!({"columns": [name], "spectrum": true}),
    );
    assert_eq!(spectrum.status, 200, "{spectrum:?}");
    let unknown = studio.post("/api/columns", &json!({"columns": ["nothing"]}));
    assert_eq!(unknown.status, 422);
    // What belongs to pairs is not there.
    assert_eq!(studio.get("/api/pair").status, 404);
    assert_eq!(studio.post("/api/pair", &json!({})).status, 404);
}
