//! `gearmesh check`: reads a file of any kind and says what it is, or what is wrong with it.

use crate::arguments::CheckArguments;
use crate::commands::{reduce, system_table};
use crate::failure::Failure;
use crate::{console, offline};
use gearmesh_geometry::GearDefinition;
use gearmesh_geometry::input::InputDocument;
use gearmesh_model::{FileError, read_reduced_gear};
use gearmesh_scene::system_run::SystemResult;
use gearmesh_scene::{SceneFile, SceneResult, load};

/// Runs the command.
pub fn run(arguments: &CheckArguments) -> Result<(), Failure> {
    let path = &arguments.file;
    if path.extension().is_some_and(|e| e == "h5") {
        return match read_reduced_gear(path) {
            Ok(model) => {
                console::data(format!("{}: reduced gear, sound", path.display()));
                reduce::summary(&model).into_iter().for_each(console::data);
                Ok(())
            }
            Err(FileError::WrongFormat { .. }) => {
                match SystemResult::open(path) {
                    Ok(result) => {
                        let (columns, rows) = (result.rows.columns().len(), result.rows.rows());
                        let size = if rows > 0 {
                            format!(", {columns} columns x {rows} rows")
                        } else {
                            String::new()
                        };
                        let problem = result.problem();
                        let verdict = problem.as_ref().map_or("sound", |_| "not sound");
                        console::data(format!(
                            "{}: result of `{}`, {}{size}, {verdict}",
                            path.display(),
                            result.head.title,
                            result.kind
                        ));
                        system_table::table(&result)?
                            .into_iter()
                            .skip(1)
                            .for_each(console::data);
                        return problem.map_or(Ok(()), |text| Err(Failure::work(text)));
                    }
                    Err(FileError::WrongFormat { .. }) => {}
                    Err(error) => return Err(Failure::input(error)),
                }
                let result = SceneResult::read(path).map_err(Failure::input)?;
                console::data(format!(
                    "{}: result of `{}`, {} torques x {} angles, sound",
                    path.display(),
                    result.title,
                    result.torque_nm.len(),
                    result.angles()
                ));
                Ok(())
            }
            Err(error) => Err(Failure::input(error)),
        };
    }
    let document = InputDocument::read(path)?;
    // A scene has [pair] or [[body]], a gear has [tooth]; the word decides which complaints the user sees.
    if SceneFile::recognises(&document)? {
        let folder = path.parent().unwrap_or(std::path::Path::new(""));
        match SceneFile::from_document(document, folder)? {
            SceneFile::Pair(scene) => {
                let loaded = load(*scene)?;
                loaded.scene.notes.iter().for_each(console::note);
                console::unit_slips(loaded.unit_slips());
                console::data(format!(
                    "{}: scene `{}`, sound",
                    path.display(),
                    loaded.scene.title
                ));
            }
            SceneFile::System(scene) => {
                let loaded = scene.load()?;
                console::unit_slips(loaded.unit_slips());
                let built = loaded.build()?;
                console::data(format!(
                    "{}: scene `{}`, sound: {} bodies, {} joints and motions, {} force elements",
                    path.display(),
                    loaded.scene.title,
                    built.bodies.len(),
                    built.joints.len(),
                    built.elements.len()
                ));
                built.notes.iter().for_each(console::note);
            }
        }
    } else {
        let gear = GearDefinition::from_document(&document)?;
        offline::judge_gear(&gear, &document)?;
        let p = &gear.profile;
        console::data(format!("{}: gear `{}`, sound", path.display(), gear.name));
        console::data(format!(
            "radii mm: tip {:.4}, reference {:.4}, base {:.4}, form {:.4}, root {:.4}{}",
            p.tip_radius_m * 1e3,
            p.reference_radius_m * 1e3,
            p.base_radius_m * 1e3,
            gearmesh_geometry::involute::radius_m(p.form_roll_rad, p.base_radius_m) * 1e3,
            p.root_radius_m * 1e3,
            if p.undercut { "; undercut" } else { "" }
        ));
        if p.helix_angle_rad != 0.0 {
            let width = gear.tooth.face_width_m;
            console::data(format!(
                "helix: {} hand, {:.4} deg at the reference circle, {:.4} deg at the base circle; transverse module {:.5} mm, transverse pressure angle {:.4} deg, overlap ratio over the face width {:.4}, virtual teeth {:.2}",
                p.hand(),
                p.helix_angle_rad.abs().to_degrees(),
                p.base_helix_angle_rad().abs().to_degrees(),
                2e3 * p.reference_radius_m / p.teeth as f64,
                (p.base_radius_m / p.reference_radius_m).acos().to_degrees(),
                p.overlap_ratio(width),
                p.virtual_teeth()
            ));
        }
        if gear.blank.openings.is_some() && gear.sectors() == 1 {
            console::warning(
                "the openings do not divide the teeth: the body does not repeat, and every tooth is solved",
            );
        }
    }
    Ok(())
}
