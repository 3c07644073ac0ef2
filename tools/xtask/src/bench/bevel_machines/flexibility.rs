//! Seed 001's pair, rigid, with its reduced members, and with members that vibrate.

use std::fmt::Write;
use std::path::Path;

use super::Runner;
use crate::console::say;
use crate::error::XtaskError;

/// Seed 001's pair rigid and flexible: every scene of it that is shipped.
pub(super) fn flexibility(
    text: &mut String,
    runner: Runner,
    shipped: &Path,
) -> Result<(), XtaskError> {
    let runner = Runner {
        folder: shipped.to_owned(),
        ..runner
    };
    text.push_str(
        "\n## 20/20, rigid and flexible\n\nfe_models/dynamics_bevel_20_20*.toml, second half of each run, at 3000 rpm under 100 N·m. *Speed*: peak to peak of the gear's. *Range*: peak to peak of the mesh force. \
         *Joint*: force of the gear's revolute joint along the world's axes; x is the gear's own axis, z the pinion's. ± is the RMS about the mean.\n\n\
         | teeth | s | speed rpm | mesh force N | range N | joint: world x N | y N | z N |\n| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n",
    );
    for (name, suffix, members) in [
        ("rigid, `impact`", "", None),
        ("`hybrid`", "_hybrid", Some("")),
        ("`hybrid`, bodies `modal`", "_modal", Some("_modal")),
    ] {
        let file = format!("dynamics_bevel_20_20{suffix}.toml");
        if !shipped.join(&file).exists() {
            continue;
        }
        say(&format!("== 20/20: {name}"));
        if let Some(members) = members {
            reduced_members(&runner, members)?;
        }
        let (_, cpu_s) = runner.run(&file)?;
        let speed = runner.spread("bodies/gear/angular_velocity_z_rad_per_s")?;
        let force = runner.spread("elements/mesh/normal_force_left_N")?;
        let mut joint = Vec::new();
        for axis in ["x", "y", "z"] {
            let found = runner.spread(&format!("joints/gear shaft/force_world_{axis}_N"))?;
            joint.push(found.shown());
        }
        let _ = writeln!(
            text,
            "| {name} | {cpu_s:.1} | {:.2} | {} | {:.0} | {} |",
            speed.range * 30.0 / std::f64::consts::PI,
            force.shown(),
            force.range,
            joint.join(" | ")
        );
    }
    Ok(())
}

/// Makes the models of both members, of files with this end of their names, where the scenes look for them, unless they
/// are there.
fn reduced_members(runner: &Runner, suffix: &str) -> Result<(), XtaskError> {
    for member in ["pinion", "gear"] {
        let gear = format!("bevel_{member}_20_20{suffix}.toml");
        let model = format!("../out/scenes/bevel_{member}_20_20{suffix}.h5");
        runner.reduced(&runner.folder.join(gear), &runner.folder.join(model))?;
    }
    Ok(())
}
