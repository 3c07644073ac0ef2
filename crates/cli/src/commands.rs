//! The commands: what each is for, and which function does it. One file each; here those that print their answer as it
//! is.

mod accuracy;
mod bearing;
mod bearing_clearance;
mod bearing_frequencies;
mod bearing_friction;
mod bearing_page;
mod check;
mod compare;
mod completions;
mod compliance;
mod data_set_page;
mod demo;
mod doctor;
mod import;
mod init;
mod mesh;
mod modes;
mod optimise;
mod record;
mod recover;
mod reduce;
mod run;
mod schema;
mod schema_page;
mod signal;
mod studio;
mod study;
mod study_elsewhere;

use crate::arguments::{
    BearingArguments, BearingFrequenciesArguments, CheckArguments, CompletionsArguments,
    DemoArguments, DoctorArguments, InitArguments, ManArguments, PlanArguments, Printed,
    RecordArguments, ReduceArguments, RunArguments, SchemaArguments, SignalArguments,
    StudioArguments, StudyArguments,
};
use crate::console::{self, watch};
use clap::{Parser, Subcommand};
use gearmesh_operations::accuracy::AccuracyRequest;
use gearmesh_operations::bevel_pair::BevelRequest;
use gearmesh_operations::compare::CompareRequest;
use gearmesh_operations::compliance::ComplianceRequest;
use gearmesh_operations::export::ExportRequest;
use gearmesh_operations::import::ImportRequest;
use gearmesh_operations::mesh::MeshRequest;
use gearmesh_operations::modes::ModesRequest;
use gearmesh_operations::optimise::OptimiseRequest;
use gearmesh_operations::recover::RecoverRequest;
use gearmesh_operations::report::ReportRequest;
use gearmesh_operations::tca::TcaRequest;
use gearmesh_operations::{self as operations, Answer, Failure};
use gearmesh_scene::SceneFile;

/// Gear mesh stiffness from finite elements, once; contact and root strain from then on in microseconds.
#[derive(Debug, Parser)]
#[command(name = "gearmesh", version, max_term_width = 100)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Mesh a gear and write it for other programs: ParaView, gmsh, Abaqus, CalculiX, Nastran
    Mesh(Printed<MeshRequest>),
    /// Reduce a gear to its compliance at the flanks (the offline stage)
    Reduce(ReduceArguments),
    /// Find the natural frequencies and mode shapes of a gear, held at its bore
    Modes(Printed<ModesRequest>),
    /// Print the deflection along a flank under a line load
    Compliance(Printed<ComplianceRequest>),
    /// Say what a scene will compute
    Plan(PlanArguments),
    /// Run a scene
    Run(RunArguments),
    /// Recover the strain of all gauges from a result, and whole fields on request
    Recover(Printed<RecoverRequest>),
    /// Compare a result with a reference record
    Compare(Printed<CompareRequest>),
    /// Write a report page
    Report(Printed<ReportRequest>),
    /// Export a result as a table (CSV, Parquet, MATLAB, universal file) or as moving gears (ParaView), a gear as STEP
    Export(Printed<ExportRequest>),
    /// Make a reference record of measured curves: CSV with units, or a universal file
    Record(RecordArguments),
    /// Open a gear pair or a result in the browser: change the pair, see its curves and flanks at once
    Studio(StudioArguments),
    /// Analyse a column of a multibody result: spectra, orders, sidebands, envelope, averages
    Signal(SignalArguments),
    /// Check a gear file, bearing file, scene, study, S-N table, record, model or result
    Check(CheckArguments),
    /// Run a scene again and again with some of its keys changed
    Study(StudyArguments),
    /// Say what accuracy costs in time, for columns of a scene: error against time of every knob
    Accuracy(Printed<AccuracyRequest>),
    /// Seek the relief, crowning or other keys that make the objectives of a gear pair least
    Optimise(Printed<OptimiseRequest>),
    /// Find where a rolling bearing comes to rest under a load: load on every ball or roller, pressures, stiffness,
    /// life
    Bearing(BearingArguments),
    /// Print the frequencies of a rolling bearing: cage, ball or roller, passing of the races
    BearingFrequencies(BearingFrequenciesArguments),
    /// Print blank, machine settings and checks of a bevel pair
    Bevel(Printed<BevelRequest>),
    /// Analyse the tooth contact of a bevel pair: path, transmission error, ellipses, ease-off, edges
    Tca(Printed<TcaRequest>),
    /// Import a gearbox from a REXS file: gear files, scenes, bearing files, a list of what was taken and what not
    Import(Printed<ImportRequest>),
    /// Print the JSON Schema of scene, study, gear, bearing or bevel files
    Schema(SchemaArguments),
    /// Write commented files to start from: a gear, a pair, a gearbox, a bevel pair
    Init(InitArguments),
    /// Say what this machine lacks: Python with gmsh and meshio, memory, other programs
    Doctor(DoctorArguments),
    /// Print the completions of a shell
    Completions(CompletionsArguments),
    /// Write the manual pages
    Man(ManArguments),
    /// Make gear pairs A and B from definition to report
    Demo(DemoArguments),
}

impl Command {
    /// Does what is asked.
    pub fn run(&self) -> Result<(), Failure> {
        match self {
            Self::Mesh(a) => mesh::run(a),
            Self::Reduce(a) => reduce::run(a),
            Self::Modes(a) => modes::run(a),
            Self::Compliance(a) => compliance::run(a),
            Self::Plan(a) => plan(a),
            Self::Run(a) => run::run(a),
            Self::Recover(a) => recover::run(a),
            Self::Compare(a) => compare::run(a),
            Self::Export(a) => export(a),
            Self::Record(a) => record::run(a),
            Self::Report(a) => report(a),
            Self::Studio(a) => studio::run(a),
            Self::Signal(a) => signal::run(a),
            Self::Check(a) => check::run(a),
            Self::Accuracy(a) => accuracy::run(a),
            Self::Study(a) => study::run(a),
            Self::Optimise(a) => optimise::run(a),
            Self::Schema(a) => schema::run(a),
            Self::Bearing(a) => bearing::run(a),
            Self::BearingFrequencies(a) => bearing_frequencies::run(a),
            Self::Bevel(a) => bevel(a),
            Self::Tca(a) => tca(a),
            Self::Import(a) => import::run(a),
            Self::Init(a) => init::run(a),
            Self::Doctor(a) => doctor::run(a),
            Self::Completions(a) => completions::completions(a),
            Self::Man(a) => completions::man(a),
            Self::Demo(a) => demo::run(a),
        }
    }
}

/// `gearmesh bevel`.
fn bevel(a: &Printed<BevelRequest>) -> Result<(), Failure> {
    print(operations::bevel_pair::design(&a.request, &watch()), a.json)
}

/// `gearmesh export`.
fn export(a: &Printed<ExportRequest>) -> Result<(), Failure> {
    print(operations::export::export(&a.request, &watch()), a.json)
}

/// `gearmesh plan`.
fn plan(a: &PlanArguments) -> Result<(), Failure> {
    let scene = SceneFile::read(&a.scene)?;
    print(operations::plan::plan(scene, &watch()), a.json)
}

/// `gearmesh report`.
fn report(a: &Printed<ReportRequest>) -> Result<(), Failure> {
    print(operations::report::report(&a.request, &watch()), a.json)
}

/// `gearmesh tca`.
fn tca(a: &Printed<TcaRequest>) -> Result<(), Failure> {
    print(operations::tca::tca(&a.request, &watch()), a.json)
}

fn print(answer: Result<Answer, Failure>, as_json: bool) -> Result<(), Failure> {
    let Answer { figures, lines } = answer?;
    console::found(as_json, || figures, || lines);
    Ok(())
}
