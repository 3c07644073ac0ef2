//! The parts of a pair's result in its file, declared once for writing, reading and docs/files.md.

use std::path::Path;

use gearmesh_model::{
    DataTree, Fields, FileError, FileFormat, OPEN, Record, StoredGear, read_record, write_record,
};

use super::bevel_result::BevelRest;
use super::contact_places::ContactPlaces;
use super::result::{SceneResult, StrainSeries};
use crate::periods::{Coverage, Extent, PairPeriods};
use crate::rating::RatingResult;

/// Name and version of the result file.
pub const RESULT_FORMAT: FileFormat = FileFormat {
    name: "gearmesh-result",
    // 2: axial force; 3: periods, places of contact; 4: definitions of the gears
    version: 4,
};

/// The first version that holds what the gear files say, besides their texts.
const TYPED_DEFINITION: u32 = 4;

impl SceneResult {
    /// Writes the result, atomically.
    ///
    /// # Errors
    /// [`FileError`] when the file cannot be written; an older file is then untouched.
    pub fn write(&self, path: &Path) -> Result<(), FileError> {
        let mut tree = DataTree::default();
        write_record(&mut self.clone(), &mut tree);
        tree.write(path, &RESULT_FORMAT)
    }

    /// Reads a result.
    ///
    /// # Errors
    /// [`FileError`] when the file is missing, cut, altered, of another kind, or an array does not fit the others.
    pub fn read(path: &Path) -> Result<Self, FileError> {
        let (mut tree, version) = DataTree::read_with_version(path, &RESULT_FORMAT)?;
        let result: Self = read_record(&mut tree, path, version)?;
        match result.contradiction() {
            None => Ok(result),
            Some((item, problem)) => Err(FileError::Contradiction {
                path: path.to_owned(),
                item,
                problem,
            }),
        }
    }

    /// A number that does not go with the arrays that are there: its name, and what is wrong with it.
    fn contradiction(&self) -> Option<(String, String)> {
        let found = |item: &str, problem: String| Some((item.to_owned(), problem));
        for (item, length) in [
            ("torque_Nm", self.torque_nm.len()),
            ("angle_rad", self.angle_rad.len()),
        ] {
            if length == 0 {
                return found(item, "it is empty".to_owned());
            }
        }
        let angles = self.angles();
        if self.pitches > angles {
            let problem = format!("it is {}, there are {angles} angles", self.pitches);
            return found("pitches", problem);
        }
        let slots = self.lines.slots;
        if let Some(count) = (self.lines.pair_count.iter()).find(|count| **count as usize > slots) {
            let problem = format!("it says {count}, there are {slots} contact lines");
            return found("pair_count", problem);
        }
        let gauges = self.strain.iter().enumerate();
        let of_gauge = |(i, series): (usize, &StrainSeries)| {
            let period = series.coverage.period_pitches;
            (format!("gauges/{i}/period_pitches"), period)
        };
        let of_mesh = (
            "contact/period_pitches".to_owned(),
            self.contact_coverage.period_pitches,
        );
        let mut periods = std::iter::once(of_mesh).chain(gauges.clone().map(of_gauge));
        if let Some((item, _)) = periods.find(|(_, period)| *period == 0) {
            return Some((item, "it is 0, at least 1 is needed".to_owned()));
        }
        for (i, series) in gauges {
            if !(1..=2).contains(&series.gear) {
                let problem = format!("it is {}, there are gears 1 and 2", series.gear);
                return found(&format!("gauges/{i}/gear"), problem);
            }
        }
        None
    }
}

impl Record for SceneResult {
    fn fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        self.head_fields(f)?;
        self.curve_fields(f)?;
        self.contact_fields(f)?;
        f.optional("bevel", &mut self.bevel, BevelRest::fields)?;
        let (t, a) = (
            ("torque", self.torque_nm.len()),
            ("driver angle", self.angle_rad.len()),
        );
        // Of files before version 3 the periods follow from the gears.
        let periods = periods_of(&self.source.gears);
        let of_mesh = periods.map(|periods| periods.contact());
        let (coverage, pitches) = (&mut self.contact_coverage, self.pitches);
        f.group("contact", |f| {
            coverage_fields(coverage, f, (pitches, of_mesh))
        })?;
        let e = self.between_fields(f)?;
        let mut gauges = self.strain.len();
        f.count("gauge_count", &mut gauges, "gauges")?;
        f.list("gauges", &mut self.strain, |series, f| {
            f.count("gear", &mut series.gear, "gear of the gauge, 1 or 2")?;
            let of_gear = periods.filter(|_| (1..=2).contains(&series.gear));
            let of_tooth = of_gear.map(|periods| periods.of_tooth(series.gear));
            coverage_fields(&mut series.coverage, f, (pitches, of_tooth))?;
            strain_fields(series, f, [t, a], e)
        })?;
        if gauges != self.strain.len() {
            let problem = format!("it says {gauges}, there are {}", self.strain.len());
            return Err(f.contradiction("gauge_count", &problem));
        }
        f.list("ratings", &mut self.ratings, RatingResult::fields)
    }
}

impl SceneResult {
    fn head_fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        let source = &mut self.source;
        f.text("title", &mut source.title, "title of the scene")?;
        let what = "the scene, word for word";
        f.text("scene_toml", &mut source.scene_toml, what)?;
        let typed = f.version() >= TYPED_DEFINITION;
        let names = [("gear_1_toml", "gear_1"), ("gear_2_toml", "gear_2")];
        for (gear, names) in source.gears.iter_mut().zip(names) {
            gear.fields(f, names, typed)?;
        }
        let names = ["model_1", "model_2"];
        for (file, name) in source.model_files.iter_mut().zip(names) {
            f.text(name, file, "file of the model, absolute")?;
        }
        let names = ["microgeometry_1", "microgeometry_2"];
        for (text, name) in source.microgeometry.iter_mut().zip(names) {
            if f.has(name) {
                f.text(name, text, "microgeometry of the gear in words")?;
            }
        }
        if f.has("proposal") {
            let what = "a run that would see whole periods; empty where this one does";
            f.text("proposal", &mut self.proposal, what)?;
        }
        f.text("version", &mut source.version, "version of the program")?;
        f.text("created_utc", &mut source.created_utc, "when, UTC")?;
        f.lines("warnings", &mut self.warnings, "warnings about assumptions")?;
        let what = "pitches of gear 1 run through";
        f.count("pitches", &mut self.pitches, what)?;
        self.pitches = self.pitches.max(1);
        let what = "wall time of contact and of strain";
        let seconds = &mut self.solution.seconds;
        f.fixed("seconds", seconds, &[("stage", 2)], "s", what)
    }

    fn curve_fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        let angles = &mut self.angle_rad;
        let what = "driver angle, zero where pair 0 touches at the pitch point";
        f.numbers("angle_rad", angles, &[("driver angle", OPEN)], "rad", what)?;
        let torques = &mut self.torque_nm;
        let what = "torque on gear 2";
        f.numbers("torque_Nm", torques, &[("torque", OPEN)], "N m", what)?;
        let (t, a) = (("torque", torques.len()), ("driver angle", angles.len()));
        let what = "transmission error r_b2 theta_2 - r_b1 theta_1, negative under load";
        f.bulk("te_m", &mut self.te_m, &[t, a], "m", what)?;
        let what = "transmission error at first touch";
        f.bulk("te_unloaded_m", &mut self.unloaded_m, &[a], "m", what)?;
        let (values, what) = (&mut self.torque_1_nm, "torque on gear 1");
        f.bulk("torque_1_Nm", values, &[t, a], "N m", what)?;
        if f.has("axial_force_1_N") {
            let values = &mut self.axial_force_1_n;
            let what = "axial force on gear 1, positive along +z; gear 2 feels the opposite";
            f.bulk("axial_force_1_N", values, &[t, a], "N", what)?;
        } else {
            // Version 1 knew spur gears only.
            self.axial_force_1_n = vec![0.0; t.1 * a.1];
        }
        let (name, values) = ("stiffness_secant_N_per_m", &mut self.secant_n_per_m);
        f.bulk(name, values, &[t, a], "N/m", "secant mesh stiffness")?;
        let (name, values) = ("stiffness_tangent_N_per_m", &mut self.tangent_n_per_m);
        f.bulk(name, values, &[t, a], "N/m", "tangent mesh stiffness")?;
        let what = "face load factor of the most loaded line, worst position";
        f.numbers("k_h_beta", &mut self.lines.k_h_beta, &[t], "1", what)?;
        let solution = &mut self.solution;
        let what = "Newton iterations, sum over all positions";
        f.counts("iterations", &mut solution.iterations, &[t], what)?;
        let what = "largest relative residual of the contact problem";
        f.numbers("residual", &mut solution.residual, &[t], "1", what)?;
        // Older programs did not store it.
        if f.has("te_mesh_error") {
            let what = "estimated relative error of the mesh in the deflection of teeth, zero where it was not estimated";
            f.number("te_mesh_error", &mut self.te_mesh_error, "1", what)?;
        }
        let what = "largest relative error of the torque balance";
        f.numbers(
            "torque_balance",
            &mut solution.torque_balance,
            &[t],
            "1",
            what,
        )
    }

    fn contact_fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        let (t, a) = (
            ("torque", self.torque_nm.len()),
            ("driver angle", self.angle_rad.len()),
        );
        let it = &mut self.lines;
        let what = "pair number of each contact line";
        let lines = [a, ("contact line", OPEN)];
        f.numbers("pair", &mut it.pair, &lines, "1", what)?;
        if f.is_reading() {
            it.slots = it.pair.len() / a.1.max(1);
        }
        let l = ("contact line", it.slots);
        let what = "contact lines looked at; a tip edge that stays apart has no force";
        f.counts("pair_count", &mut it.pair_count, &[a], what)?;
        let axes = [t, a, l, ("slice", OPEN)];
        let what = "normal force of each slice, positive in compression";
        f.bulk("force_N", &mut it.force_n, &axes, "N", what)?;
        if f.is_reading() {
            it.slices = it.force_n.len() / (t.1 * a.1 * l.1).max(1);
        }
        let s = ("slice", it.slices);
        let what = "peak Hertz pressure of each slice";
        let axes = [t, a, l, s];
        f.bulk("pressure_Pa", &mut it.pressure_pa, &axes, "Pa", what)?;
        // Older programs did not store the places.
        if f.keeps("contact/width_m", it.places.is_some()) {
            place_fields(it.places.get_or_insert_default(), f, "", &[a, l, s])?;
        }
        Ok(())
    }
}

impl SceneResult {
    /// Positions between the even ones, and their axis; none in files of older programs.
    fn between_fields(
        &mut self,
        f: &mut Fields<'_>,
    ) -> Result<Option<(&'static str, usize)>, FileError> {
        let it = &mut self.between;
        if !f.keeps("between/angle_rad", !it.angle_rad.is_empty()) {
            return Ok(None);
        }
        let t = ("torque", self.torque_nm.len());
        let what = "positions between the even ones of each torque, one torque after the other";
        f.counts("between/count", &mut it.count, &[t], what)?;
        let count: u64 = it.count.iter().map(|count| u64::from(*count)).sum();
        let e = ("position between", count as usize);
        let what = "driver angle";
        f.numbers("between/angle_rad", &mut it.angle_rad, &[e], "rad", what)?;
        let what = "transmission error";
        f.numbers("between/te_m", &mut it.te_m, &[e], "m", what)?;
        let what = "transmission error at first touch";
        f.numbers("between/te_unloaded_m", &mut it.unloaded_m, &[e], "m", what)?;
        let (name, what) = (
            "between/stiffness_tangent_N_per_m",
            "tangent mesh stiffness",
        );
        f.numbers(name, &mut it.tangent_n_per_m, &[e], "N/m", what)?;
        let axes = [
            e,
            ("contact line between", OPEN),
            ("slice", self.lines.slices),
        ];
        let what = "normal force of each slice";
        f.bulk("between/force_N", &mut it.force_n, &axes, "N", what)?;
        if f.is_reading() {
            it.slots = it.force_n.len() / (e.1 * self.lines.slices).max(1);
        }
        let lines = [e, ("contact line between", it.slots)];
        let axes = [lines[0], lines[1], ("slice", self.lines.slices)];
        let (name, what) = ("between/pressure_Pa", "peak Hertz pressure of each slice");
        f.bulk(name, &mut it.pressure_pa, &axes, "Pa", what)?;
        if f.keeps("between/pair", it.places.is_some()) {
            let what = "bevel gears: pair number of each contact line";
            f.numbers("between/pair", &mut it.pair, &lines, "1", what)?;
            place_fields(it.places.get_or_insert_default(), f, "between/", &axes)?;
        }
        for (name, values, of) in [
            (
                "te",
                &mut it.te_error,
                "the transmission error's peak-to-peak value",
            ),
            ("k_h_beta", &mut it.k_h_beta_error, "K_Hβ"),
            ("pressure", &mut it.pressure_error, "the largest pressure"),
        ] {
            let what = format!("what of {of} the positions leave open, over it");
            f.numbers(&format!("between/{name}_error"), values, &[t], "1", &what)?;
        }
        Ok(Some(e))
    }
}

/// Where slices touch, in the group `contact` of `prefix`.
fn place_fields(
    it: &mut ContactPlaces,
    f: &mut Fields<'_>,
    prefix: &str,
    axes: &[(&str, usize)],
) -> Result<(), FileError> {
    let mut visit = |name: &str, values: &mut Vec<f64>, unit: &str, what: &str| {
        f.bulk(&format!("{prefix}contact/{name}"), values, axes, unit, what)
    };
    let what = "roll angle tan(alpha) of the contact on gear 1; bevel gears: share of the way up the flank";
    visit("roll_1_rad", &mut it.roll_1_rad, "rad", what)?;
    let what = "axial place of the contact from mid-face of gear 1";
    visit("z_m", &mut it.z_m, "m", what)?;
    let what = "touching width of the slice, zero where it does not touch";
    visit("width_m", &mut it.width_m, "m", what)?;
    let of_bevel = format!("{prefix}contact/roll_2_rad");
    if !f.keeps(&of_bevel, !it.roll_2_rad.is_empty()) {
        return Ok(());
    }
    let mut visit = |name: &str, values: &mut Vec<f64>, unit: &str, what: &str| {
        f.bulk(&format!("{prefix}contact/{name}"), values, axes, unit, what)
    };
    let what = "bevel gears: share of the way up the flank of gear 2";
    visit("roll_2_rad", &mut it.roll_2_rad, "1", what)?;
    let what = "bevel gears: axial place of the contact from mid-face of gear 2";
    visit("z_2_m", &mut it.z_2_m, "m", what)?;
    let what = "bevel gears: sliding speed over the speed of gear 1";
    visit("sliding_m", &mut it.sliding_m, "m/rad", what)?;
    let what = "bevel gears: way to the nearer tip of both gears, up the flank";
    visit("to_tip_m", &mut it.to_tip_m, "m", what)
}

fn strain_fields(
    it: &mut StrainSeries,
    f: &mut Fields<'_>,
    axes: [(&str, usize); 2],
    e: Option<(&str, usize)>,
) -> Result<(), FileError> {
    f.text("name", &mut it.name, "name of the gauge")?;
    let (error, what) = (
        &mut it.error_estimate_relative,
        "estimated relative mesh error",
    );
    f.number("error", error, "1", what)?;
    let what = "strain along the profile by method 1, positive in tension";
    f.bulk("method_1", &mut it.method_1, &axes, "1", what)?;
    let what = "the same by method 2";
    f.bulk("method_2", &mut it.method_2, &axes, "1", what)?;
    if e.is_some() {
        // One a position in files before 2026-11-27.
        let axes = [("position between, period of the mesh", OPEN)];
        let names = ["between_method_1", "between_method_2"];
        for (name, values) in names.into_iter().zip(&mut it.between) {
            let what = "the same at the positions between the even ones, in every period of the mesh that the run has";
            f.bulk(name, values, &axes, "1", what)?;
        }
    }
    Ok(())
}

/// What is known of a quantity's period. Files before version 3 do not have it: it follows from the gears.
fn coverage_fields(
    it: &mut Coverage,
    f: &mut Fields<'_>,
    (run_pitches, period_of_old_file): (usize, Option<usize>),
) -> Result<(), FileError> {
    if let (Some(period), false) = (period_of_old_file, f.has("period_pitches")) {
        *it = Coverage::of_contact(period, run_pitches);
        return Ok(());
    }
    let what = "pitches after which it repeats";
    f.count("period_pitches", &mut it.period_pitches, what)?;
    f.choice("extent", &mut it.extent, "how much of it the run has seen")?;
    if f.is_reading() {
        let of_contact = Coverage::of_contact(it.period_pitches, run_pitches);
        let is_passage = it.extent == Extent::Passage && of_contact.extent == Extent::Part;
        let extent = if is_passage {
            Extent::Passage
        } else {
            of_contact.extent
        };
        *it = Coverage {
            extent,
            ..of_contact
        };
    }
    Ok(())
}

/// The periods of the gears of a result; none where they are not known.
fn periods_of(gears: &[StoredGear; 2]) -> Option<PairPeriods> {
    let [Some(gear_1), Some(gear_2)] = gears.each_ref().map(StoredGear::definition) else {
        return None;
    };
    Some(PairPeriods::of([gear_1, gear_2]))
}
