//! Columns of multibody results.

use serde_json::json;

use super::Studio;
use crate::common::{Desk, argument, number, succeeds};
use crate::hybrid_scene;

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
