//! What the server refuses, and what it survives.

use std::io::Write;
use std::net::TcpStream;

use serde_json::json;

use super::{Studio, pair_scene};
use crate::common::{Desk, argument, refused};

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
    let empty = desk.path("empty");
    std::fs::create_dir(&empty).unwrap();
    refused(
        &crate::common::gearmesh(&["studio", argument(&empty), "--no-open"]),
        2,
        &["neither scenes (.toml) nor results (.h5)"],
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
