//! The page of `cargo xtask accuracy-cost`: what `gearmesh accuracy` says of each scene in, Markdown out.

use std::fmt::Write;

use serde_json::Value;

use super::accuracy::Subject;
use super::host::Host;

/// A scene and what `gearmesh accuracy` says of it, or why it does not.
pub type Tried<'a> = (&'a Subject, Result<Value, String>);

/// The whole page: what was found, and titles of what was not run yet.
pub fn page(
    host: &Host,
    program: &str,
    (found, left): (&[Tried<'_>], &[&str]),
    picture: &str,
) -> String {
    let mut page = format!(
        "# What accuracy costs\n\nWritten by `cargo xtask accuracy-cost`; do not edit.\n\n\
         | | |\n| --- | --- |\n| processor | {}, {} cores |\n| memory | {} |\n| system | {} |\n| date | {} |\n| commit | {} |\n| program | {program} |\n\n\
         ![largest error over processor time of every setting]({picture})\n\n\
         Each section is `gearmesh accuracy` on a shipped scene ([scene.md](scene.md#what-accuracy-costs) says how it works). *Reference*: every knob at its top. *Error*: of \
         each column, relative to the reference, at the worst of the scene's torques; what no knob changes is in none of them. *Time*: processor time of all cores, which other work on the machine hardly changes; \
         reading models and writing results are not in it, nor is the reduction of gears, which is done once. Settings that are recommended were run once more after all others; \
         their errors are those of that run. Elements and element lengths against an independent reference: [benchmarks/elements.md](benchmarks/elements.md); models of a bearing beside each other: \
         [benchmarks/bearing-models.md](benchmarks/bearing-models.md).\n",
        host.cpu, host.cores, host.memory, host.system, host.date, host.commit
    );
    page += &by_quantity(found);
    page += &summary(found);
    if !left.is_empty() {
        let _ = writeln!(
            page,
            "\nNot run yet when this page was written: {}.",
            left.join("; ")
        );
    }
    for (subject, outcome) in found {
        let _ = write!(
            page,
            "\n## {}\n\n`fe_models/{}`",
            subject.title, subject.scene
        );
        for (k, (old, new)) in subject.changed.iter().enumerate() {
            let word = if k == 0 { ", with" } else { "," };
            let _ = write!(page, "{word} `{}` for `{old}`", new.replace('\n', ", "));
        }
        page += ".\n\n";
        match outcome {
            Err(reason) => {
                let _ = writeln!(page, "Failed: {}", reason.trim());
            }
            Ok(told) => page += &section(subject, told),
        }
    }
    page
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}

/// Four digits.
fn short(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if !(1e-4..1e6).contains(&value.abs()) {
        return format!("{value:.2e}");
    }
    let digits = (3 - value.abs().log10().floor() as i32).clamp(0, 7);
    format!("{value:.*}", digits as usize)
}

fn largest_error(setting: &Value) -> f64 {
    let errors = setting["errors"].as_object().into_iter().flatten();
    errors.map(|(_, e)| number(e)).fold(0.0, f64::max)
}

/// What columns measure: a part of their names, and words; of two that fit the first one counts.
const QUANTITIES: [(&str, &str); 12] = [
    ("te_mean", "transmission error, mean"),
    ("transmission_error_m:mean", "transmission error, mean"),
    ("te_peak_to_peak", "transmission error, peak to peak"),
    (
        "transmission_error_m:peak",
        "transmission error, peak to peak",
    ),
    (
        "transmission_error_m:deviation",
        "transmission error, deviation",
    ),
    ("te_harmonic_1", "transmission error, mesh order"),
    (
        "transmission_error_m:line",
        "transmission error, mesh order",
    ),
    ("resonance", "speed of a resonance"),
    ("strain", "root strain, range"),
    ("pressure", "largest pressure"),
    ("force_radial", "bearing force"),
    ("_force_", "mesh force"),
];

/// The front page: what a quantity takes to 1 % and to 0.1 %, scene by scene. The cheapest of all settings that were
/// tried counts, the reference among them.
fn by_quantity(found: &[Tried<'_>]) -> String {
    let mut table = "\n## By quantity\n\nThe cheapest setting that was tried for one quantity alone: processor time, and what differs from the scene's reference.\n\n\
        | quantity | scene | 1 %: s | setting | 0.1 %: s | setting | reference s |\n| --- | --- | ---: | --- | ---: | --- | ---: |\n"
        .to_owned();
    let mut words: Vec<&str> = QUANTITIES.iter().map(|(_, words)| *words).collect();
    words.dedup();
    for words in words {
        for (subject, outcome) in found {
            let Ok(told) = outcome else { continue };
            let of = |column: &str| QUANTITIES.iter().find(|(part, _)| column.contains(part));
            let columns = subject.columns.iter();
            for column in columns.filter(|column| of(column).is_some_and(|(_, of)| *of == words)) {
                let tried: Vec<&Value> = told["tried"].as_array().into_iter().flatten().collect();
                let cheapest = |goal: f64| {
                    let good = tried
                        .iter()
                        .filter(|one| number(&one["errors"][column]) <= goal);
                    let seconds = |one: &&Value| number(&one["cpu_s"]);
                    let least = good.min_by(|a, b| seconds(a).total_cmp(&seconds(b)));
                    least.map_or("| | ".to_owned(), |one| {
                        let setting = one["setting"].as_str().unwrap_or_default();
                        format!("| {} | {} ", short(seconds(one)), setting.replace('|', "/"))
                    })
                };
                let _ = writeln!(
                    table,
                    "| {words} | {} {}{}| {} |",
                    subject.title,
                    cheapest(0.01),
                    cheapest(0.001),
                    short(number(&told["tried"][0]["cpu_s"]))
                );
            }
        }
    }
    table
        + "\nOther programs at the same error: contact of whole gears in finite elements and full factorisations in [benchmarks/offline.md](benchmarks/offline.md), elements in \
          [benchmarks/elements.md](benchmarks/elements.md), bearings and chains of bodies in [benchmarks/bearings.md](benchmarks/bearings.md) and [benchmarks/chain.md](benchmarks/chain.md).\n"
}

/// One line for each scene and goal: the setting that is recommended, its error when it was run again, and how much
/// faster it is.
fn summary(found: &[Tried<'_>]) -> String {
    let mut table = "\n## Recommended settings, tried\n\n\
        | scene | reference s | for 1 %: error % | s | times faster | for 0.1 %: error % | s | times faster | last step of the reference % |\n\
        | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n"
        .to_owned();
    for (subject, outcome) in found {
        let Ok(told) = outcome else {
            let _ = writeln!(table, "| {} | failed{}", subject.title, " |".repeat(8));
            continue;
        };
        let reference = number(&told["tried"][0]["cpu_s"]);
        let of_goal = |goal: &str| {
            let advice = told["advice"].as_array().into_iter().flatten();
            let mut own = advice.filter(|one| one["goal"].as_str() == Some(goal));
            own.next().map_or(" | | ".to_owned(), |one| {
                let again = &one["run_again"];
                let seconds = number(&again["cpu_s"]);
                format!(
                    "{} | {} | {}",
                    short(100.0 * largest_error(again)),
                    short(seconds),
                    short(reference / seconds)
                )
            })
        };
        let step = match &told["last_step_of_reference"] {
            Value::Null => String::new(),
            step => format!(
                "{} ({})",
                short(100.0 * number(&step["change"])),
                step["knob"].as_str().unwrap_or_default()
            ),
        };
        let (one, tenth) = (of_goal("1.000 %"), of_goal("0.1000 %"));
        let _ = writeln!(
            table,
            "| {} | {} | {one} | {tenth} | {step} |",
            subject.title,
            short(reference)
        );
    }
    table
        + "\nA factor near 1: no cheaper setting is that exact. *Last step of the reference*: how much the last rung of the knob that is worst in this still changes the columns, which is what the reference itself may be off by.\n"
}

fn section(subject: &Subject, told: &Value) -> String {
    let mut text = String::new();
    for advice in told["advice"].as_array().into_iter().flatten() {
        let again = &advice["run_again"];
        let lines = advice["toml"].as_array().into_iter().flatten();
        let lines: Vec<&str> = lines.filter_map(Value::as_str).collect();
        let _ = write!(
            text,
            "```toml\n# {}: error {} %, {} s\n{}\n```\n\n",
            advice["goal"].as_str().unwrap_or_default(),
            short(100.0 * largest_error(again)),
            short(number(&again["cpu_s"])),
            lines.join("\n")
        );
    }
    let heads = |text: &mut String, first: &str| {
        let columns = subject.columns.iter().map(|c| format!(" {c} % |"));
        let _ = writeln!(text, "{first}{}", columns.collect::<String>());
        let count = first.matches('|').count() - 1 + subject.columns.len();
        let _ = writeln!(text, "| --- |{}", " ---: |".repeat(count - 1));
    };
    let cells = |errors: &Value| {
        let cells = subject.columns.iter();
        cells
            .map(|column| format!(" {} |", short(100.0 * number(&errors[column]))))
            .collect::<String>()
    };
    heads(
        &mut text,
        "| setting: what differs from the reference | s | iterations | reduction s |",
    );
    for one in told["tried"].as_array().into_iter().flatten() {
        let reduction = number(&one["reduction_s"]);
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} |{}",
            one["setting"]
                .as_str()
                .unwrap_or_default()
                .replace('|', "/"),
            short(number(&one["cpu_s"])),
            number(&one["iterations"]),
            if reduction > 0.0 {
                short(reduction)
            } else {
                String::new()
            },
            cells(&one["errors"])
        );
    }
    let effects: Vec<&Value> = told["effects"].as_array().into_iter().flatten().collect();
    if !effects.is_empty() {
        text += "\nWhat each effect changes and takes, with / without it, all else as the scene has it:\n\n";
        heads(&mut text, "| effect | in the scene | states | calls | s |");
        for one in effects {
            let both = |key: &str, of: &dyn Fn(f64) -> String| {
                let ends = ["with", "without"].map(|side| of(number(&one[side][key])));
                ends.join(" / ")
            };
            let whole = |value: f64| match value == 0.0 {
                true => "-".to_owned(),
                false => value.to_string(),
            };
            let present = if one["in_scene"] == true { "yes" } else { "no" };
            let _ = writeln!(
                text,
                "| {} | {present} | {} | {} | {} |{}",
                one["effect"].as_str().unwrap_or_default(),
                both("states", &whole),
                both("calls", &whole),
                both("cpu_s", &short),
                cells(&one["changes"])
            );
        }
    }
    for (word, key) in [("Not varied", "not_varied"), ("Failed", "failed")] {
        for line in told[key].as_array().into_iter().flatten() {
            let line = line.as_str().unwrap_or_default().replace('\n', " ");
            let line: String = line.chars().take(300).collect();
            let _ = write!(text, "\n- {word}: {line}");
        }
    }
    text + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::accuracy::SUBJECTS;
    use serde_json::json;

    #[test]
    fn a_section_has_advice_settings_and_effects() {
        let subject = &SUBJECTS[0];
        let errors: serde_json::Map<String, Value> = subject
            .columns
            .iter()
            .map(|c| ((*c).to_owned(), json!(0.005)))
            .collect();
        let setting = json!({"setting": "a = 1", "cpu_s": 0.5, "iterations": 12.0, "reduction_s": 0.0, "errors": errors});
        let effort = json!({"states": 10.0, "calls": 100.0, "cpu_s": 1.0});
        let told = json!({
            "tried": [setting], "advice": [{"goal": "1.000 %", "toml": ["a = 1"], "run_again": setting}],
            "effects": [{"effect": "friction", "in_scene": true, "with": effort, "without": effort, "changes": errors}],
            "not_varied": ["b: no"], "failed": [], "last_step_of_reference": null,
        });
        let text = section(subject, &told);
        for part in [
            "# 1.000 %: error 0.5000 %, 0.5000 s\na = 1\n",
            "| a = 1 | 0.5000 | 12 |",
            "| friction | yes | 10 / 10 | 100 / 100 | 1.000 / 1.000 |",
            "- Not varied: b: no",
        ] {
            assert!(text.contains(part), "{part} is not in\n{text}");
        }
        // Tables have as many cells in each line.
        for block in text.split("\n\n").filter(|block| block.starts_with('|')) {
            let counts: Vec<usize> = block
                .lines()
                .filter(|line| line.starts_with('|'))
                .map(|line| line.matches('|').count())
                .collect();
            assert!(counts.windows(2).all(|w| w[0] == w[1]), "{block}");
        }
        let front = by_quantity(&[(subject, Ok(told.clone()))]);
        assert!(front.contains(
            "| transmission error, mean | Pair A at rest | 0.5000 | a = 1 | | | 0.5000 |"
        ));
        assert_eq!(
            front.matches("| Pair A at rest |").count(),
            subject.columns.len()
        );
        let table = summary(&[(subject, Ok(told))]);
        assert!(table.contains("| Pair A at rest | 0.5000 | 0.5000 | 0.5000 | 1.000 |"));
    }
}
