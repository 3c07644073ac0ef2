//! What stands in files reaches the terminal as text: no name, key, kind, cell or file name steers it.

use crate::common::{Answer, gearmesh};
use crate::hostile::bench::{Bench, Names, STEERING, toml_text};
use crate::hostile::commands::CASES;
use std::process::{Command, Stdio};

/// Characters that a terminal obeys, or that turn or hide what is read.
fn steers(character: char) -> bool {
    match character {
        '\n' | '\t' => false,
        '\u{61c}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => {
            true
        }
        _ => character.is_control(),
    }
}

fn demand_text(what: &str, answer: &Answer) {
    let all = [&answer.stdout, &answer.stderr];
    assert!(
        !all.iter().any(|text| text.contains(steers)),
        "{what} steers the terminal: {answer:?}"
    );
    assert!(
        answer.code.is_some() && !answer.stderr.contains("panicked"),
        "{what}: {answer:?}"
    );
}

#[test]
fn names_of_parts_and_files_in_every_command() {
    let bench = Bench::new(Names::Steering);
    for case in CASES {
        let answer = bench.run(case.words);
        demand_text(case.words, &answer);
        assert_eq!(answer.code, Some(case.code), "{}: {answer:#?}", case.words);
    }
}

/// Texts with one thing wrong, whose message names it.
fn wrong_tables(text: &str) -> Vec<String> {
    let lines: Vec<&str> = text.lines().collect();
    let with = |place: usize, line: String| {
        let mut changed: Vec<&str> = lines.clone();
        changed[place] = &line;
        changed.join("\n")
    };
    let mut wrong = Vec::new();
    for (place, line) in lines.iter().enumerate() {
        if let Some((key, value)) = line.split_once('=') {
            let strange = toml_text(&format!("{}{STEERING}", key.trim().trim_matches('"')));
            // An unknown key, a text where none belongs, an unknown kind, a key within a key.
            wrong.push(match place % 4 {
                0 => with(place, format!("{strange} ={value}")),
                1 => with(place, format!("{key}= {}", toml_text(STEERING))),
                2 => with(place, format!("{key}= {{ kind = {strange} }}")),
                _ => with(place, format!("{key}= {{ {strange} = 1 }}")),
            });
        } else if line.starts_with('[') {
            let name = line.trim_matches(['[', ']']);
            let strange = toml_text(&format!("{name}{STEERING}"));
            wrong.push(with(place, line.replace(name, &strange)));
        }
        // Raw, which TOML does not allow.
        if place % 5 == 0 {
            wrong.push(with(place, format!("{line}{STEERING}")));
        }
    }
    wrong
}

#[test]
fn what_is_wrong_with_a_file_is_told_as_text() {
    let bench = Bench::new(Names::Plain);
    let mut count = 0;
    let mut tried = |name: &str, text: &str, words: &str| {
        let path = bench.path(name);
        let whole = std::fs::read(&path).unwrap();
        std::fs::write(&path, text).unwrap();
        demand_text(&format!("{words} of {text:?}"), &bench.run(words));
        std::fs::write(&path, whole).unwrap();
        count += 1;
    };
    for name in [
        "gear.toml",
        "pair.toml",
        "wheel.toml",
        "study.toml",
        "optimise.toml",
        "bearing.toml",
        "bevel.toml",
        "sn.toml",
    ] {
        let text = std::fs::read_to_string(bench.path(name)).unwrap();
        for (number, wrong) in wrong_tables(&text).iter().enumerate() {
            let words = match (name, number % 4) {
                ("optimise.toml", _) => "optimise optimise.toml -o out".to_owned(),
                ("study.toml", 0) => "study study.toml -o out".to_owned(),
                ("pair.toml" | "wheel.toml", 0) => format!("plan {name}"),
                ("pair.toml" | "wheel.toml", 1) => format!("run {name} -o o.h5"),
                ("gear.toml", 0) => "mesh gear.toml -o o.vtu".to_owned(),
                ("bearing.toml", 0) => "bearing-frequencies bearing.toml".to_owned(),
                ("bevel.toml", 0) => "bevel bevel.toml".to_owned(),
                _ => format!("check {name}"),
            };
            tried(name, wrong, &words);
        }
    }
    let files = [
        ("record/record.toml", "check record"),
        ("record/data.csv", "compare pair.h5 record"),
        ("curves.csv", "record curves.csv"),
        (
            "curves.csv",
            "record curves.csv -o out --title t --source s --angle-origin a --column te_um_50Nm=x",
        ),
        ("curves.uff", "record curves.uff"),
        ("box.rexs", "import box.rexs -o out --no-run"),
        ("box.rexsj", "import box.rexsj -o out --no-run"),
    ];
    for (name, words) in files {
        let text = std::fs::read_to_string(bench.path(name)).unwrap();
        let ends: Vec<usize> = text
            .match_indices(['\n', ',', '"'])
            .map(|(place, _)| place)
            .collect();
        for place in ends.iter().step_by(ends.len().div_ceil(12)) {
            let wrong = format!("{}{STEERING}{}", &text[..*place], &text[*place..]);
            tried(name, &wrong, words);
        }
    }
    assert!(count > 200, "{count} wrong files");
}

/// A file whose name is an option's value, an argument too many, or no command.
#[test]
fn arguments_are_told_as_text() {
    let strange = format!("a{STEERING}");
    for words in [
        &["check", "b", &strange][..],
        &[&strange],
        &["schema", &strange],
        &["run", "a", "-o", &strange],
        &["run", "a", "-o", "o.h5", "--checkpoint-s", &strange],
        &["init", &strange],
        &["check", &strange, "--colour"],
    ] {
        let answer = gearmesh(words);
        assert_eq!(answer.code, Some(2), "{answer:#?}");
        demand_text(&format!("{words:?}"), &answer);
    }
}

/// On a terminal there are bars, whose titles are names of gears.
#[test]
fn bars_do_not_pass_on_what_steers() {
    let bench = Bench::new(Names::Steering);
    let script =
        "import os, pty, sys\nsys.exit(os.waitstatus_to_exitcode(pty.spawn(sys.argv[1:])))";
    let python = gearmesh_mesh::python::PythonEnvironment::find().unwrap();
    let mut command: Command = python.command();
    command
        .args(["-c", script, env!("CARGO_BIN_EXE_gearmesh"), "reduce"])
        .arg(bench.path("gear.toml"))
        .arg("-o")
        .arg(bench.path("o.h5"))
        .arg("--no-error-estimate")
        .stdin(Stdio::null());
    let output = command.output().unwrap();
    let told = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{output:?}");
    assert!(
        told.contains("thin\\u202e"),
        "no bar with the gear's name: {told:?}"
    );
    assert!(!told.contains(['\u{202e}', '\u{200b}']), "{told:?}");
}
