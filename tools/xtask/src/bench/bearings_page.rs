//! The page docs/benchmarks/bearings.md.

use std::fmt::Write;

use serde_json::Value;

use super::host::Host;

/// All that the page tells.
pub struct Page {
    pub host: Host,
    pub peer: String,
    pub evaluations: Vec<Value>,
    pub cages: Vec<Value>,
    pub shafts: Vec<Value>,
    pub surfaces: Vec<Value>,
    pub ours: Vec<Beside>,
    pub theirs: Vec<Beside>,
}

/// A run of the bearing that both programs have; runs are listed from long to short steps.
#[derive(Debug, Clone, PartialEq)]
pub struct Beside {
    pub step_s: f64,
    pub steps: f64,
    pub cpu_s: f64,
    /// Load of each ball at the inner race in every sample \[N\].
    pub inner_n: Vec<Vec<f64>>,
    pub cage_rad_per_s: Vec<f64>,
}

impl Beside {
    /// Reads a line of a bench.
    pub fn read(line: &Value) -> Option<Self> {
        let numbers = |value: &Value| -> Option<Vec<f64>> {
            value.as_array()?.iter().map(Value::as_f64).collect()
        };
        Some(Self {
            step_s: line["step_s"].as_f64()?,
            steps: line["steps"].as_f64()?,
            cpu_s: line["cpu_s"].as_f64()?,
            inner_n: line["inner_N"]
                .as_array()?
                .iter()
                .map(numbers)
                .collect::<Option<_>>()?,
            cage_rad_per_s: numbers(&line["cage_rad_per_s"])?,
        })
    }

    fn mean_n(&self) -> f64 {
        let loads = || self.inner_n.iter().flatten();
        loads().sum::<f64>() / loads().count() as f64
    }

    /// Largest and root mean square difference of a ball's load, in percent of the mean load, and largest of the cage's
    /// speed in percent.
    fn apart(&self, other: &Self) -> [f64; 3] {
        let pairs = || {
            let samples = self.inner_n.iter().zip(&other.inner_n);
            samples.flat_map(|(a, b)| a.iter().zip(b).map(|(a, b)| (a - b).abs()))
        };
        let largest = pairs().fold(0.0, f64::max);
        let square = pairs().map(|miss| miss * miss).sum::<f64>() / pairs().count() as f64;
        let cages = self.cage_rad_per_s.iter().zip(&other.cage_rad_per_s);
        let cage = cages.map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max);
        let percent = 100.0 / other.mean_n();
        [largest * percent, square.sqrt() * percent, 100.0 * cage]
    }

    fn steps_per_s(&self) -> f64 {
        self.steps / self.cpu_s
    }
}

/// The page's text.
pub fn page(page: &Page) -> String {
    let host = &page.host;
    let mut text = format!(
        "# Time and error of bearings\n\nWritten by `cargo xtask bench bearings`; do not edit.\n\n\
         | | |\n| --- | --- |\n| processor | {}, {} cores |\n| memory | {} |\n| system | {} |\n| date | {} |\n| commit | {} |\n\
         | program | profile `dev` of Cargo.toml (opt-level 3, overflow checks in the project's own crates) |\n| other program | {} |\n\n\
         Times are processor time, which other work on the machine disturbs least; all runs here take one core.\n\n",
        host.cpu, host.cores, host.memory, host.system, host.date, host.commit, page.peer
    );
    evaluations(&mut text, &page.evaluations);
    cages(&mut text, &page.cages);
    shafts(&mut text, &page.shafts);
    surfaces(&mut text, &page.surfaces);
    beside(&mut text, &page.ours, &page.theirs);
    text
}

fn number(line: &Value, key: &str) -> f64 {
    line[key].as_f64().unwrap_or(f64::NAN)
}

fn evaluations(text: &mut String, lines: &[Value]) {
    text.push_str(
        "## One evaluation in equilibrium\n\nModel `quasi-static`, 14 balls, five coordinates of the ring: loads with their tangent. *Warm*: from the balls' places of the evaluation \
         before, as in a run. Means of 20 000 calls; the fastest and the median of nine of them. Asked for: under 20 µs warm.\n\n\
         | rpm | start | fastest µs | median µs |\n| ---: | --- | ---: | ---: |\n",
    );
    for line in lines {
        let start = if line["warm"] == true { "warm" } else { "cold" };
        let _ = writeln!(
            text,
            "| {} | {start} | {:.1} | {:.1} |",
            number(line, "rpm"),
            number(line, "fastest_us"),
            number(line, "median_us")
        );
    }
}

fn cages(text: &mut String, lines: &[Value]) {
    text.push_str(
        "\n## 18 balls and a cage, 6000 rpm, 0.1 s\n\nModel `dynamic`: seed 000's bearing (9.525 mm on 70 mm, 15°) at 500 N of axial preload and 300 N of radial load, a film of oil at \
         the races, its cage with film pockets and guide land, as in fe_models/spindle_6000_rpm.toml; samples every 0.1 ms. *Mean* and *peak*: load of a ball at the inner race over \
         all balls and samples; cage: mean speed of the second half. Behind them how much half the step changes them. Asked for: less than 1 %, and under 20 s.\n\n\
         | step µs | steps | processor s | wall s | iterations a step | mean N | peak N | cage rad/s | half the step: mean % | peak % | cage % |\n\
         | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n",
    );
    for (place, line) in lines.iter().enumerate() {
        let change = |key: &str| {
            lines.get(place + 1).map_or("–".to_owned(), |half| {
                let change = 100.0 * (number(half, key) / number(line, key) - 1.0).abs();
                format!("{change:.1e}")
            })
        };
        let _ = writeln!(
            text,
            "| {:.2} | {} | {:.2} | {:.2} | {:.1} | {:.3} | {:.3} | {:.4} | {} | {} | {} |",
            1e6 * number(line, "step_s"),
            number(line, "steps"),
            number(line, "cpu_s"),
            number(line, "wall_s"),
            number(line, "iterations") / number(line, "steps"),
            number(line, "mean_N"),
            number(line, "peak_N"),
            number(line, "cage_rad_per_s"),
            change("mean_N"),
            change("peak_N"),
            change("cage_rad_per_s"),
        );
    }
}

fn shafts(text: &mut String, lines: &[Value]) {
    text.push_str(
        "\n## Four bearings with cages on one shaft\n\nThe same bearing once and four times on a shaft, steps of 5 µs, 0.01 s; of three runs the fastest. Asked for: at most 4.5 times.\n\n\
         | bearings | unknowns of balls | processor s | times one |\n| ---: | ---: | ---: | ---: |\n",
    );
    for line in lines {
        let _ = writeln!(
            text,
            "| {} | {} | {:.3} | {:.2} |",
            number(line, "bearings"),
            108.0 * number(line, "bearings"),
            number(line, "cpu_s"),
            number(line, "cpu_s") / number(&lines[0], "cpu_s"),
        );
    }
}

fn surfaces(text: &mut String, lines: &[Value]) {
    text.push_str(
        "\n## Races as triangles\n\nThe first 2 ms of the same run on tori and on meshes of triangles (`surface`), steps of 5 µs; *apart*: largest difference of a ball's load from that \
         on the tori, in percent of the mean load. Making the meshes is not in the time.\n\n\
         | edges across, along µm | ms a step | times the tori | iterations a step | apart % |\n| --- | ---: | ---: | ---: | ---: |\n",
    );
    let loads = |line: &Value| -> Vec<f64> {
        let values = line["inner_N"].as_array().into_iter().flatten();
        values.filter_map(Value::as_f64).collect()
    };
    for line in lines {
        let edges = match number(line, "across_um") {
            0.0 => "tori".to_owned(),
            across => format!("{across}, {}", number(line, "along_um")),
        };
        let (own, tori) = (loads(line), loads(&lines[0]));
        let misses = own.iter().zip(&tori).map(|(a, b)| (a - b).abs());
        let mean = tori.iter().sum::<f64>() / tori.len() as f64;
        let _ = writeln!(
            text,
            "| {edges} | {:.3} | {:.1} | {:.1} | {:.3} |",
            1e3 * number(line, "cpu_s") / number(line, "steps"),
            number(line, "cpu_s") / number(&lines[0], "cpu_s"),
            number(line, "iterations") / number(line, "steps"),
            100.0 * misses.fold(0.0, f64::max) / mean
        );
    }
}

fn beside(text: &mut String, ours: &[Beside], theirs: &[Beside]) {
    text.push_str(
        "\n## Beside Exudyn\n\nWhat both programs have: 18 balls of 9.525 mm on 70 mm in grooves of 0.52 opposite each other, the inner ring's 10 µm larger so that all balls carry; \
         a contact K d^1.5 + c d' (8e9 N/m^1.5, 30 N s/m), friction 0.06 above 0.05 m/s of slip, balls on springs to the cage (100 N/mm), a shaft of 3 kg under 300 N at 6000 rpm; \
         20 ms from the same places and speeds. Exudyn: exudyn.machines.CreateBallBearing, implicit generalized-alpha of spectral radius 0.8, modified Newton, sparse solver (dense \
         and full Newton are slower); ours: the same scheme and radius. Errors are those of a ball's load (in percent of the mean load) and of the cage's speed against the same \
         program's run with the shortest step, over all balls and samples every 0.1 ms. Friction near zero slip differs: proportional to the slip there, µs/√(s² + s₀²) here. \
         Balls stay in one plane, because the contact of Exudyn 1.13.6 has a wrong gap for a ball aside of the torus' plane. Asked for: 5 times more steps a second at no larger error.\n\n\
         | step µs | ours steps/s | Exudyn steps/s | times | ours load %: largest, rms | Exudyn load %: largest, rms | ours cage % | Exudyn cage % |\n\
         | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n",
    );
    for (place, run) in ours.iter().enumerate() {
        let other = theirs.get(place);
        let errors = |runs: &[Beside], run: &Beside| match runs.last() {
            Some(last) if last != run => {
                let [largest, rms, cage] = run.apart(last);
                (format!("{largest:.2}, {rms:.3}"), format!("{cage:.1e}"))
            }
            _ => ("–".to_owned(), "–".to_owned()),
        };
        let none = || ("–".to_owned(), "–".to_owned());
        let (our_load, our_cage) = errors(ours, run);
        let (their_load, their_cage) = other.map_or_else(none, |other| errors(theirs, other));
        let speed = other.map_or("–".to_owned(), |o| format!("{:.0}", o.steps_per_s()));
        let times = other.map_or("–".to_owned(), |o| {
            format!("{:.1}", run.steps_per_s() / o.steps_per_s())
        });
        let _ = writeln!(
            text,
            "| {:.4} | {:.0} | {speed} | {times} | {our_load} | {their_load} | {our_cage} | {their_cage} |",
            1e6 * run.step_s,
            run.steps_per_s(),
        );
    }
    if let (Some(a), Some(b)) = (ours.last(), theirs.last()) {
        let [largest, rms, cage] = a.apart(b);
        let _ = writeln!(
            text,
            "\nWith the shortest step the loads of both programs are {largest:.2} % apart at most and {rms:.3} % root mean square, the cages' speeds {cage:.1e} %."
        );
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn differences_are_in_percent_of_the_mean_load() {
        let run = |loads: [f64; 2], speed: f64| {
            let line = json!({"step_s": 1e-5, "steps": 100, "cpu_s": 0.5, "inner_N": [loads], "cage_rad_per_s": [speed]});
            Beside::read(&line).unwrap()
        };
        let [largest, rms, cage] = run([99.0, 100.0], 202.0).apart(&run([100.0, 100.0], 200.0));
        assert!((largest - 1.0).abs() < 1e-12 && (rms - 0.5_f64.sqrt()).abs() < 1e-12);
        assert!((cage - 1.0).abs() < 1e-12);
        assert_eq!(run([1.0, 1.0], 1.0).steps_per_s(), 200.0);
        assert_eq!(Beside::read(&json!({"step_s": 1e-5})), None);
    }

    #[test]
    fn a_page_without_the_other_program_says_so() {
        let mut text = String::new();
        let line = json!({"step_s": 1e-5, "steps": 100, "cpu_s": 0.5, "inner_N": [[1.0]], "cage_rad_per_s": [1.0]});
        beside(&mut text, &[Beside::read(&line).unwrap()], &[]);
        assert!(text.ends_with("| 10.0000 | 200 | – | – | – | – | – | – |\n"));
    }
}
