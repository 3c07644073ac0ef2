//! The commands on gears, on two small ones: what they print, what they write, and identities of the figures.

use crate::common;
mod compliance;
mod threads;

use common::{Desk, SOLID, THIN, argument, gearmesh, number, run_scene, succeeds, workshop};
use serde_json::Value;

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(number).collect()
}

#[test]
fn help_names_all_commands() {
    let answer = succeeds(&["--help"]);
    insta::assert_snapshot!(answer.stdout, @r"
    Gear mesh stiffness from finite elements, once; contact and root strain from then on in microseconds
    
    Usage: gearmesh <COMMAND>
    
    Commands:
      mesh                 Mesh a gear and write it for other programs: ParaView, gmsh, Abaqus,
                           CalculiX, Nastran
      reduce               Reduce a gear to its compliance at the flanks (the offline stage)
      modes                Find the natural frequencies and mode shapes of a gear, held at its bore
      compliance           Print the deflection along a flank under a line load
      plan                 Say what a scene will compute
      run                  Run a scene
      recover              Recover the strain of all gauges from a result, and whole fields on request
      compare              Compare a result with a reference record
      report               Write a report page
      export               Export a result as a table (CSV, Parquet, MATLAB, universal file) or as
                           moving gears (ParaView), a gear as STEP
      record               Make a reference record of measured curves: CSV with units, or a universal
                           file
      studio               Open a gear pair or a result in the browser: change the pair, see its curves
                           and flanks at once
      signal               Analyse a column of a multibody result: spectra, orders, sidebands, envelope,
                           averages
      check                Check a gear file, bearing file, scene, study, S-N table, record, model or
                           result
      study                Run a scene again and again with some of its keys changed
      accuracy             Say what accuracy costs in time, for columns of a scene: error against time
                           of every knob
      optimise             Seek the relief, crowning or other keys that make the objectives of a gear
                           pair least
      bearing              Find where a rolling bearing comes to rest under a load: load on every ball
                           or roller, pressures, stiffness, life
      bearing-frequencies  Print the frequencies of a rolling bearing: cage, ball or roller, passing of
                           the races
      bevel                Print blank, machine settings and checks of a bevel pair
      tca                  Analyse the tooth contact of a bevel pair: path, transmission error,
                           ellipses, ease-off, edges
      import               Import a gearbox from a REXS file: gear files, scenes, bearing files, a list
                           of what was taken and what not
      schema               Print the JSON Schema of scene, study, gear, bearing or bevel files
      init                 Write commented files to start from: a gear, a pair, a gearbox, a bevel pair
      doctor               Say what this machine lacks: Python with gmsh and meshio, memory, other
                           programs
      completions          Print the completions of a shell
      man                  Write the manual pages
      demo                 Make gear pairs A and B from definition to report
      help                 Print this message or the help of the given subcommand(s)
    
    Options:
      -h, --help     Print help
      -V, --version  Print version
    ");
    for command in [
        "mesh",
        "reduce",
        "modes",
        "compliance",
        "plan",
        "run",
        "recover",
        "compare",
        "report",
        "check",
        "study",
        "optimise",
        "accuracy",
        "schema",
        "demo",
        "export",
        "bevel",
        "tca",
        "studio",
    ] {
        let help = succeeds(&[command, "--help"]).stdout;
        assert!(
            help.contains(&format!("Usage: gearmesh {command} ")),
            "{help}"
        );
    }
    let wrong = gearmesh(&["reduced"]);
    assert_eq!((wrong.code, wrong.stdout.as_str()), (Some(2), ""));
}

/// Root diameter 3 (18 + 0.2 − 2.5), tip diameter 3 (18 + 0.2 + 2), base diameter 54 cos 20°.
#[test]
fn check_says_what_a_file_is() {
    let desk = Desk::new();
    let gear = desk.file("gear.toml", SOLID);
    let text = succeeds(&["check", argument(&gear)]).stdout;
    for part in [
        "gear `small solid`, sound",
        "tip 30.3000",
        "reference 27.0000",
        "base 25.3717",
        "root 23.5500",
    ] {
        assert!(text.contains(part), "`{part}` is not in {text}");
    }
    let found = succeeds(&["check", argument(&gear), "--json"]).json();
    assert_eq!(
        (found["kind"].as_str(), found["sound"].as_bool()),
        (Some("gear"), Some(true))
    );
    assert!((found["tip_radius_mm"].as_f64().unwrap() - 30.3).abs() < 1e-9);
    let model = succeeds(&["check", argument(&workshop().thin)]).stdout;
    assert!(
        model.contains("reduced gear, sound") && model.contains("small thin rim"),
        "{model}"
    );
    let (result, _) = run_scene(&desk, "");
    let text = succeeds(&["check", argument(&result)]).stdout;
    assert!(
        text.contains("result of `small pair`, sound: 2 torques x 24 angles"),
        "{text}"
    );
    let text = succeeds(&["check", argument(&desk.path("scene.toml"))]).stdout;
    assert!(text.contains("scene `small pair`, sound"), "{text}");
}

#[test]
fn mesh_writes_what_it_counts() {
    let desk = Desk::new();
    let gear = desk.file("gear.toml", THIN);
    let output = desk.path("gear.vtu");
    let figures = succeeds(&["mesh", argument(&gear), "-o", argument(&output), "--json"]).json();
    assert_eq!(desk.names(), ["gear.toml", "gear.vtu"]);
    let file = String::from_utf8_lossy(&std::fs::read(&output).unwrap()).into_owned();
    let counts = format!(
        "NumberOfPoints=\"{}\" NumberOfCells=\"{}\"",
        figures["nodes"], figures["elements"]
    );
    assert!(
        file.contains("UnstructuredGrid") && file.contains(&counts),
        "{counts}"
    );
    assert_eq!(figures["sectors"], 18);
    let (smallest, mean) = (
        number(&figures["scaled_jacobian_smallest"]),
        number(&figures["scaled_jacobian_mean"]),
    );
    assert!(
        0.2 <= smallest && smallest <= mean && mean <= 1.0,
        "{figures}"
    );
    // The reduction works on the same mesh.
    assert_eq!(figures["nodes"], workshop().figures[1]["nodes"]);
}

/// A contour with fillets is meshed in tetrahedra without being asked, which the program says, with the reason.
#[test]
fn a_contour_with_fillets_becomes_tetrahedra() {
    const CONTOUR: &str = "kind = \"contour\"
hub_z_mm = [-8.0, 6.0]
web = [{ diameter_mm = 20.0, z_mm = [-2.0, 2.0], fillet_radius_mm = 2.0 }, { diameter_mm = 38.0, z_mm = [-1.0, 3.0] }]";
    let desk = Desk::new();
    let text = SOLID.replace("kind = \"solid\"", CONTOUR);
    let gear = desk.file("gear.toml", text);
    let output = desk.path("gear.bdf");
    let unit = ["--length-unit", "mm"];
    let answer = succeeds(
        &[
            &["mesh", argument(&gear), "-o", argument(&output)],
            &unit[..],
        ]
        .concat(),
    );
    let deck = std::fs::read_to_string(&output).unwrap();
    assert!(
        deck.starts_with("$ gearmesh mesh, lengths in mm;"),
        "{}",
        &deck[..80]
    );
    // The largest x is the tip's: 3 (18 + 0.2 + 2)/2 mm.
    let x_mm = deck.lines().filter(|line| line.starts_with("GRID*"));
    let x_mm = x_mm.map(|line| line[40..56].trim().parse::<f64>().unwrap());
    let largest_mm = x_mm.fold(0.0, f64::max);
    assert!(
        largest_mm < 30.3 + 1e-9 && largest_mm > 30.0,
        "{largest_mm}"
    );
    assert!(
        answer.stderr.contains(
            "tetrahedra of ten nodes (mesh.element = \"tet10\"): the contour has fillets"
        ),
        "{answer:#?}"
    );
    let stdout = answer.stdout;
    assert!(stdout.contains(" tetrahedra, "), "{stdout}");
}

/// Figures on modes that must hold on any mesh, and the shapes as point fields.
#[test]
fn modes_are_sorted_paired_and_drawn() {
    let desk = Desk::new();
    let with_density = THIN.replace("poisson = 0.3", "poisson = 0.3\ndensity_kg_per_m3 = 7850.0");
    let gear = desk.file("gear.toml", &with_density);
    let shapes = desk.path("shapes.vtu");
    let command = ["modes", argument(&gear), "--count", "5"];
    let options = ["--shapes", argument(&shapes), "--json"];
    let figures = succeeds(&[&command[..], &options[..]].concat()).json();
    let modes = figures["modes"].as_array().unwrap();
    assert!(modes.len() == 5 || modes.len() == 6, "{figures}");
    let hz: Vec<f64> = modes.iter().map(|m| number(&m["frequency_Hz"])).collect();
    assert!(hz[0] > 0.0 && hz.windows(2).all(|w| w[0] <= w[1] * (1.0 + 1e-9)));
    for mode in modes {
        let shares = ["radial_share", "circumferential_share", "axial_share"];
        let sum: f64 = shares.iter().map(|name| number(&mode[name])).sum();
        assert!((sum - 1.0).abs() < 1e-12, "{mode}");
        let paired = mode["nodal_diameters"] != 0 && mode["nodal_diameters"] != 9;
        let near = hz
            .iter()
            .filter(|f| (*f / number(&mode["frequency_Hz"]) - 1.0).abs() < 1e-8);
        assert_eq!(near.count(), if paired { 2 } else { 1 }, "{figures}");
    }
    let sums = numbers(&figures["effective_mass_sums"]);
    assert!(sums.iter().all(|s| (0.0..=1.0).contains(s)), "{sums:?}");
    let file = String::from_utf8_lossy(&std::fs::read(&shapes).unwrap()).into_owned();
    for mode in 1..=modes.len() {
        assert!(file.contains(&format!("Name=\"mode_{mode:03}_")), "{mode}");
    }
    let table = succeeds(&command).stdout;
    assert!(
        table.contains("nodal") && table.lines().count() == modes.len() + 4,
        "{table}"
    );

    // The model file holds what [modes] and [hub] ask for.
    let tables = "[modes]\ncount = 3\n[hub]\nsupport = \"reference-point\"\n";
    let gear = desk.file("both.toml", format!("{with_density}\n{tables}"));
    let model = desk.path("model.h5");
    let arguments = [
        "reduce",
        argument(&gear),
        "-o",
        argument(&model),
        "--no-error-estimate",
    ];
    let text = succeeds(&arguments).stdout;
    assert!(text.contains("bore rigid on a reference point"), "{text}");
    assert!(text.contains("natural modes up to"), "{text}");
    // Without an estimate no error is stated, rather than one of zero.
    for what in [
        "mesh error of the deflection, loaded tooth: not estimated",
        "mesh error of the deflection, other teeth: not estimated",
        "mesh error of the deflection, next tooth loaded, too: not estimated",
        "mesh error not estimated",
    ] {
        assert!(text.contains(what), "`{what}` is not in {text}");
    }
    let answer = succeeds(
        &[
            &["compliance", argument(&model), "--tooth", "2"][..],
            &["--line-load-N-per-mm", "100", "--half-width-mm", "0.1"],
            &["--radius-mm", "27"],
        ]
        .concat(),
    );
    assert!(
        answer.stdout.contains("tooth 2; mesh error not estimated"),
        "{answer:#?}"
    );
}

#[test]
fn modes_that_cannot_be_found_are_refused() {
    let desk = Desk::new();
    let gear = desk.file("gear.toml", THIN);
    let refused = |arguments: &[&str], expected: &str| {
        let answer = gearmesh(&[&["modes", argument(&gear)], arguments].concat());
        assert_eq!(
            (answer.code, answer.stdout.as_str()),
            (Some(2), ""),
            "{answer:#?}"
        );
        assert!(answer.stderr.contains(expected), "{answer:#?}");
    };
    refused(&[], "--count, --up-to-Hz, or [modes]");
    refused(&["--count", "0"], "--count: found 0");
    refused(&["--up-to-Hz=-3"], "--up-to-Hz: found -3");
    refused(&["--count", "3"], "material.density_kg_per_m3");
    refused(&["--count", "3", "--up-to-Hz", "10"], "cannot be used with");
}

#[test]
fn an_unknown_mesh_format_is_refused() {
    let desk = Desk::new();
    let gear = desk.file("gear.toml", SOLID);
    let answer = gearmesh(&[
        "mesh",
        argument(&gear),
        "-o",
        argument(&desk.path("gear.mesch")),
    ]);
    assert_eq!(
        (answer.code, answer.stdout.as_str()),
        (Some(2), ""),
        "{answer:#?}"
    );
    assert!(
        answer.stderr.contains("gear.mesch: this writes a mesh for other programs; allowed are names that end in .bdf .inp .msh"),
        "{answer:#?}"
    );
    assert_eq!(desk.names(), ["gear.toml"]);
}

/// `run -o pair.csv` once wrote HDF5 into it.
#[test]
fn a_name_must_end_in_what_is_written() {
    let desk = Desk::new();
    let file = desk.file("file.toml", "nothing");
    for (command, name, needle) in [
        (
            "run",
            "pair.csv",
            "this writes HDF5; allowed are names that end in .h5 .hdf5; `gearmesh export` makes tables of a result: .csv .parquet .mat .uff",
        ),
        ("reduce", "model.vtu", "this writes HDF5"),
        ("recover", "strain.csv", "this writes HDF5"),
        (
            "export",
            "x.xlsx",
            "this writes tables, series of moving gears or CAD; allowed are names that end in .csv .parquet .mat",
        ),
        (
            "report",
            "page.pdf",
            "this writes an HTML page; allowed are names that end in .html .htm",
        ),
    ] {
        let output = desk.path(name);
        let answer = gearmesh(&[command, argument(&file), "-o", argument(&output)]);
        assert_eq!(
            (answer.code, answer.stdout.as_str()),
            (Some(2), ""),
            "{answer:#?}"
        );
        assert!(answer.stderr.contains(needle), "{answer:#?}");
    }
    assert_eq!(desk.names(), ["file.toml"]);
}

/// The compliance is symmetric (reciprocity) and ΨᵀKΨ = C_hub − C_tooth.
#[test]
fn reduce_prints_the_figures_of_its_checks() {
    for figures in &workshop().figures {
        assert!(number(&figures["symmetry"]) < 1e-10, "{figures}");
        assert!(number(&figures["pattern_identity"]) < 1e-9, "{figures}");
        assert_eq!(figures["sectors"], 18);
        // 4 roll stations x (2 slices x 2 + 1) axial stations.
        assert_eq!(figures["flank_loads"], 20);
        let (dofs, nodes) = (
            figures["dofs"].as_u64().unwrap(),
            figures["nodes"].as_u64().unwrap(),
        );
        assert!(dofs < 3 * nodes && dofs > 2 * nodes, "{figures}");
        for teeth in ["loaded tooth", "other teeth", "next tooth loaded, too"] {
            let error =
                number(&figures["further"][format!("mesh error of the deflection, {teeth}")]);
            assert!(error > 0.0 && error < 0.1, "{figures}");
        }
    }
    let names: Vec<_> = workshop().figures[1]["gauges"]
        .as_array()
        .unwrap()
        .iter()
        .map(|g| g["name"].clone())
        .collect();
    assert_eq!(names, ["tension", "compression"]);
}
