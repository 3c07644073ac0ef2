//! Knobs of other kinds of scenes: loaded bevel pairs, speed sweeps.

use std::path::Path;

use gearmesh_scene::accuracy::words;

use super::found_in;

/// Under load positions and slices of the loaded contact are knobs of their own; those of the rigid flanks change
/// nothing there.
#[test]
fn a_loaded_bevel_pair_has_knobs_of_its_load() {
    let folder = tempfile::tempdir().unwrap();
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fe_models");
    let text = std::fs::read_to_string(shipped.join("bevel_20_20_loaded.toml")).unwrap();
    let text = text.replace("[50.0, 100.0, 200.0]", "[100.0]");
    let text = text.replace("slices = 31", "slices = 12");
    let text = text.replace("positions_per_pitch = 16", "positions_per_pitch = 8");
    std::fs::write(folder.path().join("scene.toml"), text).unwrap();
    let found = found_in(folder.path(), &["loaded_te_peak_to_peak_urad"]).unwrap();
    let names: Vec<&str> = found.knobs.iter().map(|knob| &knob.name[..]).collect();
    assert_eq!(
        names,
        [
            "tca.positions_per_pitch",
            "load.positions_per_pitch",
            "load.slices"
        ]
    );
    let largest = |name: &str| {
        let begins = |words: &String| words.starts_with(name) && !words.contains(", ");
        let alone = found.tried.iter();
        let alone = alone.filter(|one| begins(&words(&found.knobs, &one.rungs)));
        alone.map(|one| one.error()).fold(0.0, f64::max)
    };
    assert_eq!(largest("tca."), 0.0);
    assert!(largest("load.slices") > 1e-3, "{found:?}");
    // Positions are laid at the events, however many even ones there are: twelve of them are within 1 % of 240.
    assert!(largest("load.positions") < 1e-2, "{found:?}");
}

/// A disc on a damped torsion spring behind a shaft whose speed is stepped: what is left of the swing decays with the
/// time that is given to it.
#[test]
fn a_sweep_is_worth_its_settling_time() {
    let scene = "title = \"sweep\"\n[run]\nkind = \"speed-sweep\"\nmotion = \"driver\"\nfrom_rpm = 60.0\nto_rpm = 120.0\nspeeds = 2\ndirection = \"up\"\n\
        settle_s = 0.4\nmeasure_s = 0.1\n[solver]\nstep_s = 2e-3\n[output]\ninterval_s = 2e-3\n\
        [[body]]\nname = \"shaft\"\nmass_kg = 1.0\ninertia_kg_m2 = [1e-3, 1e-3, 1e-3]\nspeed_rpm = 60.0\n\
        [[body]]\nname = \"disc\"\nmass_kg = 1.0\ninertia_kg_m2 = [1e-2, 1e-2, 1e-2]\nspeed_rpm = 60.0\n\
        [[joint]]\nname = \"axle\"\nkind = \"revolute\"\nbody_2 = \"shaft\"\n\
        [[joint]]\nname = \"bearing\"\nkind = \"revolute\"\nbody_2 = \"disc\"\n\
        [[motion]]\nname = \"driver\"\njoint = \"axle\"\nspeed_rpm = 60.0\n\
        [[torsion_spring]]\nname = \"coupling\"\nbody_1 = \"shaft\"\nbody_2 = \"disc\"\nstiffness_Nm_per_rad = 100.0\ndamping_Nm_s_per_rad = 0.2\n";
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("scene.toml"), scene).unwrap();
    let column = "bodies/disc/angular_velocity_z_rad_per_s:peak-to-peak";
    let found = found_in(folder.path(), &[column]).unwrap();
    let of = |settle: &str| {
        let setting = format!("run.settle_s = {settle}");
        let mut tried = found.tried.iter();
        let one = tried.find(|one| words(&found.knobs, &one.rungs) == setting);
        one.unwrap_or_else(|| unreachable!("{setting} is not among {found:?}"))
    };
    let [quarter, half] = ["0.1", "0.2"].map(of);
    assert!(
        quarter.error() > 2.0 * half.error() && half.error() > 1e-3,
        "{found:?}"
    );
    // Two speeds: a shorter settling time saves steps.
    let reference = found.tried[0].effort.calls;
    assert!(quarter.effort.calls < half.effort.calls && half.effort.calls < reference);
}
