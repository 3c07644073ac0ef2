//! All commands of the program with files that they take.

use crate::common::succeeds;

/// A command and how it ends with sound files.
pub struct Case {
    /// Its words: the command first; names of files are those of the bench.
    pub words: &'static str,
    /// Exit code.
    pub code: i32,
}

const fn ends_well(words: &'static str) -> Case {
    Case { words, code: 0 }
}

/// What the command says of its input: it reads all of it.
const fn refuses(words: &'static str) -> Case {
    Case { words, code: 2 }
}

/// Every command, with every kind of file that it reads.
pub const CASES: &[Case] = &[
    ends_well("mesh gear.toml -o o.vtu"),
    ends_well("reduce gear.toml -o o.h5 --no-error-estimate"),
    ends_well("modes gear.toml --count 1 --shapes o.vtu"),
    ends_well(
        "compliance gear.h5 --tooth 0 --radius-mm 27 --line-load-N-per-mm 100 --half-width-mm 0.1",
    ),
    ends_well("plan pair.toml"),
    ends_well("plan wheel.toml"),
    ends_well("run pair.toml -o o.h5"),
    ends_well("run wheel.toml -o o.h5"),
    ends_well("recover pair.h5 -o o.h5 --field-gear 2 --field-angle-deg 0 --field-output o.vtu"),
    ends_well("compare pair.h5 record"),
    ends_well("report pair.h5 wheel.h5 -o o.html"),
    ends_well("report pair.h5 -o o.html --reference record"),
    ends_well("export pair.h5 -o o.csv"),
    ends_well("export wheel.h5 -o o.csv"),
    ends_well("export pair.h5 -o o.mat"),
    ends_well("export pair.h5 -o o.parquet"),
    ends_well("export pair.h5 -o o.uff"),
    ends_well("export pair.h5 -o o.pvd --moments 2"),
    ends_well("export gear.toml -o o.step"),
    ends_well("record curves.csv"),
    ends_well("record curves.uff"),
    // No column of the file is called like those of records.
    refuses("record curves.csv -o out --title t --source s --angle-origin a"),
    refuses("record curves.uff -o out --title t --source s --angle-origin a"),
    ends_well("signal columns wheel.h5"),
    ends_well("signal statistics wheel.h5 COLUMN"),
    ends_well("signal spectrum wheel.h5 COLUMN -o o.html"),
    ends_well("signal sidebands wheel.h5 COLUMN --carrier 25 --modulator 4 -o o.csv"),
    ends_well("signal envelope wheel.h5 COLUMN --low 10 --high 30 -o o.html"),
    refuses("signal average wheel.h5 COLUMN --shaft BODY"),
    refuses("signal map wheel.h5 COLUMN --shaft BODY"),
    refuses("signal statistics wheel.h5 BODY"),
    ends_well("check gear.toml"),
    ends_well("check gear.h5"),
    ends_well("check pair.toml"),
    ends_well("check pair.h5"),
    ends_well("check wheel.toml"),
    ends_well("check wheel.h5"),
    ends_well("check study.toml"),
    ends_well("check bearing.toml"),
    ends_well("check sn.toml"),
    ends_well("check record"),
    refuses("check curves.csv"),
    ends_well("study study.toml -o out"),
    ends_well("study study.toml -o out --scheduler local"),
    ends_well("accuracy wheel.toml --columns COLUMN:mean -o o.html"),
    ends_well("optimise optimise.toml -o out"),
    // It serves scenes and results until Ctrl-C; a study is neither.
    refuses("studio study.toml --no-open"),
    ends_well("schema scene"),
    ends_well("bearing bearing.toml --load-N 0,0,500 --report o.html"),
    ends_well("bearing-frequencies bearing.toml"),
    ends_well("bevel bevel.toml --grid out"),
    ends_well("tca bevel.toml --report o.html"),
    ends_well("import box.rexs -o out --no-run"),
    refuses("import box.rexsj -o out --no-run"),
    ends_well("import box.rexsz -o out --no-run"),
    refuses("import two.rexsz -o out --no-run"),
    ends_well("init pair -o out"),
    ends_well("doctor"),
    ends_well("completions bash"),
    ends_well("man -o out"),
    // Two pairs at full size take minutes. It writes by the functions of `reduce`, `run` and `report`; here it says
    // that it needs the project's folder.
    refuses("demo -o out"),
];

/// The names of the commands below some words, as the program's own help lists them.
fn listed(words: &[&str]) -> Vec<String> {
    let help = succeeds(&[words, &["--help"]].concat()).stdout;
    let list = help.lines().skip_while(|line| *line != "Commands:").skip(1);
    list.take_while(|line| !line.is_empty())
        .filter(|line| line.starts_with("  ") && !line.starts_with("   "))
        .map(|line| line.split_whitespace().next().unwrap().to_owned())
        .filter(|name| name != "help")
        .collect()
}

/// Whether a command with these words at its begin is in the table.
fn is_there(words: &str) -> bool {
    let begins = |case: &Case| {
        case.words
            .split(' ')
            .take(words.split(' ').count())
            .eq(words.split(' '))
    };
    CASES.iter().any(begins)
}

#[test]
fn every_command_is_in_the_table() {
    let commands = listed(&[]);
    assert!(commands.len() > 20, "{commands:?}");
    let analyses = listed(&["signal"]).into_iter();
    let analyses = analyses.map(|name| format!("signal {name}"));
    let missing: Vec<String> = (commands.into_iter().chain(analyses))
        .filter(|words| !is_there(words))
        .collect();
    assert!(missing.is_empty(), "not in the table: {missing:?}");
}
