//! One file per command; here those that print their answer as it is.

pub mod accuracy;
pub mod bearing;
mod bearing_clearance;
pub mod bearing_frequencies;
mod bearing_friction;
mod bearing_page;
pub mod check;
pub mod compare;
pub mod completions;
pub mod compliance;
mod data_set_page;
pub mod demo;
pub mod doctor;
pub mod import;
pub mod init;
pub mod mesh;
pub mod modes;
pub mod optimise;
pub mod record;
pub mod recover;
pub mod reduce;
pub mod run;
pub mod schema;
mod schema_page;
pub mod signal;
pub mod studio;
pub mod study;
mod study_elsewhere;

use crate::arguments::{PlanArguments, Printed};
use crate::console::{self, watch};
use gearmesh_operations::bevel_pair::BevelRequest;
use gearmesh_operations::export::ExportRequest;
use gearmesh_operations::report::ReportRequest;
use gearmesh_operations::tca::TcaRequest;
use gearmesh_operations::{self as operations, Answer, Failure};
use gearmesh_scene::SceneFile;

/// `gearmesh bevel`.
pub fn bevel(a: &Printed<BevelRequest>) -> Result<(), Failure> {
    print(operations::bevel_pair::design(&a.request, &watch()), a.json)
}

/// `gearmesh export`.
pub fn export(a: &Printed<ExportRequest>) -> Result<(), Failure> {
    print(operations::export::export(&a.request, &watch()), a.json)
}

/// `gearmesh plan`.
pub fn plan(a: &PlanArguments) -> Result<(), Failure> {
    let scene = SceneFile::read(&a.scene)?;
    print(operations::plan::plan(scene, &watch()), a.json)
}

/// `gearmesh report`.
pub fn report(a: &Printed<ReportRequest>) -> Result<(), Failure> {
    print(operations::report::report(&a.request, &watch()), a.json)
}

/// `gearmesh tca`.
pub fn tca(a: &Printed<TcaRequest>) -> Result<(), Failure> {
    print(operations::tca::tca(&a.request, &watch()), a.json)
}

fn print(answer: Result<Answer, Failure>, as_json: bool) -> Result<(), Failure> {
    let Answer { figures, lines } = answer?;
    console::found(as_json, || figures, || lines);
    Ok(())
}
