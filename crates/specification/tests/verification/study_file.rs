//! Study files: which cases they make, and what is wrong with wrong ones.

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::InputDocument;
use gearmesh_specification::study::Study;
use std::path::Path;

fn study(more: &str) -> Result<Study, InputError> {
    let text = format!(
        "title = 't'\nscene = 's.toml'\ncolumns = ['x']\n{more}\n\
         [[parameter]]\nname = 'a'\nkeys = ['k']\nvalues = [1.0, 2.0]\n\
         [[parameter]]\nname = 'b'\nkeys = ['l', 'm']\nvalues = ['p', 'q', 'r']\n"
    );
    Study::from_document(InputDocument::new("study.toml", text), Path::new(""))
}

#[test]
fn one_at_a_time_begins_with_the_scene_as_it_is_and_a_grid_has_every_combination() {
    let cases = study("").unwrap().cases();
    assert_eq!(cases.len(), 6);
    assert_eq!(cases[0].name(), "as it is");
    assert_eq!(cases[5].name(), "b = \"r\"");
    let cases = study("design = 'grid'").unwrap().cases();
    assert_eq!(cases.len(), 6);
    assert_eq!(cases[0].name(), "a = 1.0, b = \"p\"");
    assert_eq!(cases[5].name(), "a = 2.0, b = \"r\"");
}

#[test]
fn a_wrong_study_says_what_is_allowed() {
    let complaint = study("from_s = -1.0").unwrap_err().to_string();
    assert_eq!(
        complaint,
        "study.toml:4: from_s: found -1, allowed is 0 or more"
    );
    let twice = "[[parameter]]\nname = 'b'\nkeys = ['k']\nvalues = [1]\n";
    let complaint = study(twice).unwrap_err().to_string();
    let told = "parameter.2.name: `b` is the name of parameter.0, too; names must differ";
    assert!(complaint.contains(told), "{complaint}");
    // One at a time each sets the key in cases of its own.
    let shared = "[[parameter]]\nname = 'c'\nkeys = ['m']\nvalues = [1]\n";
    assert!(study(shared).is_ok());
    let complaint = study(&format!("design = 'grid'\n{shared}")).unwrap_err();
    let told = "parameter.2.keys: `m` is set by parameter.0 already";
    assert!(complaint.to_string().contains(told), "{complaint}");
    let long = "x".repeat(65_536);
    let long = format!("[[parameter]]\nname = '{long}'\nkeys = ['k']\nvalues = [1]\n");
    let complaint = study(&long).unwrap_err().to_string();
    assert!(
        complaint.contains("parameter.0.name: found a name of 65536 characters"),
        "{complaint}"
    );
}
