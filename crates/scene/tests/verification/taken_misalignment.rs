//! A pair that takes the misalignment of its axes from a gearbox: against the gearbox itself, and what is refused.

use gearmesh_geometry::input::InputDocument;
use gearmesh_scene::system_run::RunJob;
use gearmesh_scene::{Scene, SceneResult, load as load_pair, run};

use crate::common::load;
use crate::made_up_gears::{pair, write_models};
use crate::system_runs::Desk;

/// A wheel on a bearing that tilts: the pair that takes its misalignment from there has its transmission error, one
/// with aligned axes has not. The lead of gear 1 is not even, so that the sign of the misalignment counts.
#[test]
fn misalignment_is_taken_from_a_gearbox() {
    let folder = tempfile::tempdir().unwrap();
    write_models(folder.path());
    std::fs::write(
        folder.path().join("lead.csv"),
        "z_mm,removed_um\n-10,0\n10,6\n",
    )
    .unwrap();
    let lead = "teeth.errors_1 = [{ kind = \"deviation\", lead = \"lead.csv\" }]";
    let pair = pair();
    let roll = pair.working_pressure_angle_rad.tan();
    let start_deg = pair.gear_1.half_angle_rad(roll).to_degrees();
    let wheel_deg = 180.0 + pair.gear_2.half_angle_rad(roll).to_degrees() + start_deg * 30.0 / 41.0;
    // The torque is taken by a torsion spring; the bearing stands 15 mm beside the gear and tilts.
    let gearbox = |flanks: &str, sign: f64, wheel_deg: f64| {
        format!(
            "title = \"box\"\n[run]\nkind = \"static\"\nload_factors = [0.5, 1.0]\n\
         [[body]]\nname = \"pinion\"\ngear = \"gear_30.h5\"\ncardan_deg = [0.0, 0.0, 0.0]\n\
         [[body]]\nname = \"wheel\"\ngear = \"gear_41.h5\"\nposition_mm = [106.8, 0.0, 0.0]\ncardan_deg = [0.0, 0.0, {wheel_deg:?}]\n\
         [[joint]]\nname = \"axle 1\"\nkind = \"fixed\"\nbody_2 = \"pinion\"\n\
         [[bearing]]\nname = \"bearing\"\nbody_2 = \"wheel\"\nat_mm = [106.8, 0.0, 15.0]\n[bearing.model]\nkind = \"linear\"\n\
         radial_stiffness_N_per_mm = 1e7\naxial_stiffness_N_per_mm = 1e7\ntilt_stiffness_Nm_per_rad = 4e4\n\
         [[load]]\nbody = \"wheel\"\ntorque_Nm = {:?}\n\
         [[gear_mesh]]\nname = \"stage\"\ngear_1 = \"pinion\"\ngear_2 = \"wheel\"\nmodel.kind = \"hybrid\"\nmodel.local = \"weber-banaschek\"\n\
         teeth.flanks = \"{flanks}\"\nteeth.path = \"line-of-action\"\n{lead}\n",
            -sign * 100.0
        )
    };
    let desk = Desk::new();
    let text = gearbox("right", 1.0, wheel_deg);
    let result = desk.run(RunJob::from_scene(load(&text, folder.path()).unwrap()).unwrap());
    let errors_m = result.rows.read("elements/stage/transmission_error_m");
    let [te_at_half, te] = errors_m.unwrap()[..] else {
        unreachable!()
    };
    let file = desk.output.display();
    let loaded_under = |torques_nm: &[f64], keys: &str| {
        let text = format!(
            "title = \"taken\"\n[pair]\ngear_1 = \"gear_30.h5\"\ngear_2 = \"gear_41.h5\"\ncentre_distance_mm = 106.8\n{keys}\n\
             [run]\ntorques_Nm = {torques_nm:?}\nstart_deg = {start_deg:?}\npitches = 1\npoints_per_pitch = 4\n\
             [mesh]\nmodel.kind = \"hybrid\"\nmodel.local = \"weber-banaschek\"\nteeth.path = \"line-of-action\"\n{lead}\n"
        );
        load_pair(
            Scene::from_document(InputDocument::new("pair.toml", text), folder.path()).unwrap(),
        )
    };
    let loaded_with = |torque_nm: f64, keys: &str| loaded_under(&[torque_nm], keys);
    let scene = |keys: &str| loaded_with(100.0, keys);
    let from = format!("misalignment_from = {{ result = \"{file}\", mesh = \"stage\" }}");
    let taken = scene(&from).unwrap();
    let found = taken.scene.misalignment;
    assert!(found.deviation_rad.abs() > 2e-4, "{found:?}");
    let note = &taken.scene.notes[0];
    assert!(
        note.contains("misalignment of mesh `stage` at point 1 of"),
        "{note}"
    );
    let result = run(&taken, &|_, _| ()).unwrap();
    let aligned = run(&scene("").unwrap(), &|_, _| ()).unwrap();
    let keys = format!(
        "inclination_mrad = {:?}\ndeviation_mrad = {:?}",
        -1e3 * found.inclination_rad,
        -1e3 * found.deviation_rad
    );
    let mirrored = run(&scene(&keys).unwrap(), &|_, _| ()).unwrap();
    let differs = |other: &SceneResult| (other.te_m[0] - te).abs();
    assert!(differs(&result) < 1e-8, "{te:e} {:e}", result.te_m[0]);
    assert!(differs(&aligned) > 5e-8 && differs(&mirrored) > 1e-6);
    let half =
        format!("misalignment_from = {{ result = \"{file}\", mesh = \"stage\", point = 0 }}");
    // The load moves along the face, so that the axes do not lean in proportion.
    let half = loaded_with(50.0, &half).unwrap();
    let leans = half.scene.misalignment.deviation_rad;
    assert!(
        (leans - found.deviation_rad).abs() > 5e-5,
        "{leans:e} {found:?}"
    );
    let at_half = run(&half, &|_, _| ()).unwrap().te_m[0];
    assert!(
        (at_half - te_at_half).abs() < 1e-8,
        "{at_half:e} {te_at_half:e}"
    );

    for (keys, complaint) in [
        (
            from.replace("\"stage\"", "\"stag\""),
            "pair.misalignment_from.mesh: there is no gear mesh `stag`",
        ),
        (
            from.replace("result.h5", "none.h5"),
            "pair.misalignment_from.result: the result",
        ),
        (
            from.replace(" }", ", point = 2 }"),
            "pair.misalignment_from.point: found 2, the result has points 0 to 1",
        ),
        (
            format!("{from}\nflank = \"left\""),
            "`stage` carries on its right flanks there, the pair on its left ones",
        ),
    ] {
        let refused = scene(&keys).unwrap_err().to_string();
        assert!(
            refused.contains(complaint),
            "`{complaint}` is not in {refused}"
        );
    }
    // An equilibrium is that of one torque: others have other axes.
    let several = loaded_under(&[50.0, 100.0], &from).unwrap_err().to_string();
    let complaint = "run.torques_Nm: found [50.0, 100.0] with pair.misalignment_from";
    assert!(several.contains(complaint), "{several}");
    assert!(
        several.contains("of that equilibrium alone: write a scene for each torque"),
        "{several}"
    );
    assert_eq!(taken.scene.notes.len(), 1, "{:?}", taken.scene.notes);
    let other = loaded_with(150.0, &from).unwrap();
    let note = other.scene.notes.last().unwrap();
    assert!(
        note.contains("run.torques_Nm is 150 N m, but the axes"),
        "{note}"
    );

    let both = format!("{from}\ndeviation_mrad = 0.1");
    let text = format!(
        "title = \"t\"\n[pair]\ngear_1 = \"a\"\ngear_2 = \"b\"\ncentre_distance_mm = 106.8\n{both}\n[run]\ntorques_Nm = [1.0]\npitches = 1\npoints_per_pitch = 4\n[mesh]\nmodel.kind = \"hybrid\"\n"
    );
    let refused =
        Scene::from_document(InputDocument::new("pair.toml", text), folder.path()).unwrap_err();
    assert!(
        refused
            .to_string()
            .contains("pair.deviation_mrad: is stated and taken from a result"),
        "{refused}"
    );
}
