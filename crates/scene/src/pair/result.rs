//! The result of a scene, in memory and as an HDF5 file.

use super::contact_places::ContactPlaces;
use super::coverage::{named, periods_of, put_coverage, take_coverage};
use crate::periods::Coverage;
use crate::rating::{RatingResult, put_ratings, take_ratings};
use gearmesh_model::{DataArray, DataTree, FileError, FileFormat, Values};
use std::path::Path;

/// Name and version of the result file.
pub const RESULT_FORMAT: FileFormat = FileFormat {
    name: "gearmesh-result",
    version: 3,
};

/// Strain of one gauge, `[torque][angle]`, dimensionless.
#[derive(Debug, Clone, PartialEq)]
pub struct StrainSeries {
    /// Gear 1 or 2.
    pub gear: usize,
    /// Name of the gauge.
    pub name: String,
    /// Estimated relative error of the mesh at this gauge, zero where it was not estimated.
    pub error_estimate_relative: f64,
    /// How much of its period the run has seen.
    pub coverage: Coverage,
    /// Method 1.
    pub method_1: Vec<f64>,
    /// Method 2.
    pub method_2: Vec<f64>,
}

impl StrainSeries {
    /// The estimated relative error of the mesh; none where it was not estimated.
    pub fn error_estimate(&self) -> Option<f64> {
        (self.error_estimate_relative > 0.0).then_some(self.error_estimate_relative)
    }
}

/// All curves of a run. With T torques, A angles, L line slots and S slices.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SceneResult {
    /// Title of the scene.
    pub title: String,
    /// The scene file, verbatim.
    pub scene_toml: String,
    /// The gear files kept in the models, verbatim.
    pub gear_toml: [String; 2],
    /// Model files, as absolute paths, so that the result can be used from any folder.
    pub model_files: [String; 2],
    /// Microgeometry of gear 1 and gear 2 in words; empty in files of older programs.
    pub microgeometry: [String; 2],
    /// Program version.
    pub version: String,
    /// When, UTC.
    pub created_utc: String,
    /// Pitches of gear 1 that the angles run through.
    pub pitches: usize,
    /// How much of the period of transmission error, stiffness, forces and pressure the run has seen.
    pub contact_coverage: Coverage,
    /// A run that would cover what this one does not; empty where it covers everything.
    pub proposal: String,
    /// Driver angles \[rad\], A.
    pub angle_rad: Vec<f64>,
    /// Torques on gear 2 \[N·m\], T.
    pub torque_nm: Vec<f64>,
    /// Transmission error \[m\], `[T][A]`.
    pub te_m: Vec<f64>,
    /// Transmission error at first touch \[m\], `[A]`.
    pub unloaded_m: Vec<f64>,
    /// Torque on gear 1 \[N·m\], `[T][A]`.
    pub torque_1_nm: Vec<f64>,
    /// Axial force on gear 1 \[N\], positive along +z, `[T][A]`; gear 2 feels the opposite. Zero for spur gears.
    pub axial_force_1_n: Vec<f64>,
    /// Secant mesh stiffness \[N/m\], `[T][A]`.
    pub secant_n_per_m: Vec<f64>,
    /// Tangent mesh stiffness \[N/m\], `[T][A]`.
    pub tangent_n_per_m: Vec<f64>,
    /// Line slots L.
    pub slots: usize,
    /// Slices S.
    pub slices: usize,
    /// Pair number in each slot, `[A][L]`; only the first `pair_count` are used.
    pub pair: Vec<f64>,
    /// Contact lines looked at, `[A]`; tip edges beyond the path that stay apart count too, with no force.
    pub pair_count: Vec<u32>,
    /// Slice forces \[N\], `[T][A][L][S]`.
    pub force_n: Vec<f64>,
    /// Hertz pressure \[Pa\], `[T][A][L][S]`.
    pub pressure_pa: Vec<f64>,
    /// Where the slices touch; none in files of older programs.
    pub places: Option<ContactPlaces>,
    /// Largest over mean line load of the most loaded line, worst position, per torque: K_Hβ.
    pub k_h_beta: Vec<f64>,
    /// Newton iterations, sum over all positions, per torque.
    pub iterations: Vec<u32>,
    /// Largest relative residual, per torque.
    pub residual: Vec<f64>,
    /// Largest relative error of Σ F b = T₂, per torque.
    pub torque_balance: Vec<f64>,
    /// Strain.
    pub strain: Vec<StrainSeries>,
    /// Ratings, torque by torque.
    pub ratings: Vec<RatingResult>,
    /// Warnings about assumptions.
    pub warnings: Vec<String>,
    /// Solution and strain time \[s\].
    pub seconds: [f64; 2],
}

impl SceneResult {
    /// Number of angles.
    pub fn angles(&self) -> usize {
        self.angle_rad.len()
    }

    /// One torque's part of a `[T][A]` array.
    pub fn curve<'a>(&self, values: &'a [f64], torque: usize) -> &'a [f64] {
        &values[torque * self.angles()..(torque + 1) * self.angles()]
    }

    /// Positions in a pitch.
    pub fn points_per_pitch(&self) -> usize {
        self.angles() / self.pitches.max(1)
    }

    /// The part of one torque's curve of the mesh that means are made of: as many whole periods as there are.
    pub fn averaged<'a>(&self, values: &'a [f64], torque: usize) -> &'a [f64] {
        let points = self.contact_coverage.averaged_pitches() * self.points_per_pitch();
        &self.curve(values, torque)[..points]
    }

    /// All quantities with how much of their period the run has seen: those of the mesh first, then each gauge.
    pub fn coverages(&self) -> Vec<(String, Coverage)> {
        named(self.contact_coverage, &self.strain)
    }

    /// What is incomplete, a sentence for each quantity; empty where nothing is.
    pub fn incomplete(&self) -> Vec<String> {
        let sentence =
            |(name, coverage): (String, Coverage)| Some(format!("{name}: {}", coverage.missing()?));
        self.coverages().into_iter().filter_map(sentence).collect()
    }

    /// Whether the gears push each other along the axis: helical teeth.
    pub fn has_axial_force(&self) -> bool {
        self.axial_force_1_n.iter().any(|force| *force != 0.0)
    }

    /// Sum of all slice forces at each position of a torque \[N\], `[A]`.
    pub fn normal_force_n(&self, torque: usize) -> Vec<f64> {
        (0..self.angles())
            .map(|angle| self.position_forces(torque, angle).iter().sum())
            .collect()
    }

    /// Slice forces of all lines at one position \[N\], `[L][S]`.
    pub fn position_forces(&self, torque: usize, angle: usize) -> &[f64] {
        let size = self.slots * self.slices;
        &self.force_n[(torque * self.angles() + angle) * size..][..size]
    }

    /// Slice forces of one line \[N\].
    pub fn forces(&self, torque: usize, angle: usize, slot: usize) -> &[f64] {
        let first = ((torque * self.angles() + angle) * self.slots + slot) * self.slices;
        &self.force_n[first..first + self.slices]
    }

    /// Writes the result, atomically.
    ///
    /// # Errors
    /// [`FileError`] when the file cannot be written; an older file is then untouched.
    pub fn write(&self, path: &Path) -> Result<(), FileError> {
        let (t, a) = (
            ("torque", self.torque_nm.len()),
            ("driver angle", self.angles()),
        );
        let (l, s) = (("contact line", self.slots), ("slice", self.slices));
        let mut tree = DataTree::default();
        let mut put =
            |name: &str, values: &[f64], axes: &[(&str, usize)], unit: &str, text: &str| {
                tree.put(
                    name,
                    DataArray::new(Values::F64(values.to_vec()), axes, unit, text),
                );
            };
        put(
            "angle_rad",
            &self.angle_rad,
            &[a],
            "rad",
            "driver angle, zero where pair 0 touches at the pitch point",
        );
        put(
            "torque_Nm",
            &self.torque_nm,
            &[t],
            "N m",
            "torque on gear 2",
        );
        put(
            "te_m",
            &self.te_m,
            &[t, a],
            "m",
            "transmission error r_b2 theta_2 - r_b1 theta_1, negative under load",
        );
        put(
            "te_unloaded_m",
            &self.unloaded_m,
            &[a],
            "m",
            "transmission error at first touch",
        );
        put(
            "torque_1_Nm",
            &self.torque_1_nm,
            &[t, a],
            "N m",
            "torque on gear 1",
        );
        put(
            "axial_force_1_N",
            &self.axial_force_1_n,
            &[t, a],
            "N",
            "axial force on gear 1, positive along +z; gear 2 feels the opposite",
        );
        put(
            "stiffness_secant_N_per_m",
            &self.secant_n_per_m,
            &[t, a],
            "N/m",
            "secant mesh stiffness",
        );
        put(
            "stiffness_tangent_N_per_m",
            &self.tangent_n_per_m,
            &[t, a],
            "N/m",
            "tangent mesh stiffness",
        );
        put(
            "pair",
            &self.pair,
            &[a, l],
            "1",
            "pair number of each contact line",
        );
        put(
            "force_N",
            &self.force_n,
            &[t, a, l, s],
            "N",
            "normal force of each slice, positive in compression",
        );
        put(
            "pressure_Pa",
            &self.pressure_pa,
            &[t, a, l, s],
            "Pa",
            "peak Hertz pressure of each slice",
        );
        put(
            "k_h_beta",
            &self.k_h_beta,
            &[t],
            "1",
            "face load factor of the most loaded line, worst position",
        );
        put(
            "residual",
            &self.residual,
            &[t],
            "1",
            "largest relative residual of the contact problem",
        );
        put(
            "torque_balance",
            &self.torque_balance,
            &[t],
            "1",
            "largest relative error of the torque balance",
        );
        put(
            "seconds",
            &self.seconds,
            &[("stage", 2)],
            "s",
            "wall time of contact and of strain",
        );
        if let Some(places) = &self.places {
            places.put(&mut tree, &[a, l, s]);
        }
        tree.put(
            "pair_count",
            DataArray::new(
                Values::U32(self.pair_count.clone()),
                &[a],
                "1",
                "contact lines looked at; a tip edge that stays apart has no force",
            ),
        );
        tree.put(
            "iterations",
            DataArray::new(
                Values::U32(self.iterations.clone()),
                &[t],
                "1",
                "Newton iterations",
            ),
        );
        tree.put(
            "pitches",
            DataArray::count(self.pitches as u32, "pitches of gear 1 run through"),
        );
        tree.put(
            "gauge_count",
            DataArray::count(self.strain.len() as u32, "gauges"),
        );
        for (i, series) in self.strain.iter().enumerate() {
            let name = |part: &str| format!("gauges/{i}/{part}");
            tree.put(
                name("gear"),
                DataArray::count(series.gear as u32, "gear of the gauge"),
            );
            tree.put_text(name("name"), series.name.clone());
            put_coverage(&mut tree, &format!("gauges/{i}"), &series.coverage);
            tree.put(
                name("error"),
                DataArray::scalar(
                    series.error_estimate_relative,
                    "1",
                    "estimated relative mesh error",
                ),
            );
            for (part, values) in [
                ("method_1", &series.method_1),
                ("method_2", &series.method_2),
            ] {
                let array = DataArray::new(
                    Values::F64(values.clone()),
                    &[t, a],
                    "1",
                    "strain along the profile, positive in tension",
                );
                tree.put(name(part), array);
            }
        }
        put_coverage(&mut tree, "contact", &self.contact_coverage);
        for (name, text) in self.texts() {
            tree.put_text(name, text);
        }
        put_ratings(&mut tree, &self.ratings);
        tree.write(path, &RESULT_FORMAT)
    }

    fn texts(&self) -> Vec<(&'static str, String)> {
        vec![
            ("title", self.title.clone()),
            ("scene_toml", self.scene_toml.clone()),
            ("gear_1_toml", self.gear_toml[0].clone()),
            ("gear_2_toml", self.gear_toml[1].clone()),
            ("microgeometry_1", self.microgeometry[0].clone()),
            ("microgeometry_2", self.microgeometry[1].clone()),
            ("model_1", self.model_files[0].clone()),
            ("model_2", self.model_files[1].clone()),
            ("proposal", self.proposal.clone()),
            ("version", self.version.clone()),
            ("created_utc", self.created_utc.clone()),
            ("warnings", self.warnings.join("\n")),
        ]
    }

    /// Reads a result.
    ///
    /// # Errors
    /// [`FileError`] when the file is missing, cut, altered, of another kind, or an array does not fit the others.
    pub fn read(path: &Path) -> Result<Self, FileError> {
        let mut tree = DataTree::read(path, &RESULT_FORMAT)?;
        let [angles] = tree.shape(path, "angle_rad")?;
        let [torques] = tree.shape(path, "torque_Nm")?;
        let [_, _, slots, slices] = tree.shape(path, "force_N")?;
        let curves = [torques, angles];
        let lines = [torques, angles, slots, slices];
        let pitches = tree.take_count(path, "pitches")?.max(1);
        let gauges = tree.take_count(path, "gauge_count")?;
        let gear_toml = [
            tree.take_text(path, "gear_1_toml")?,
            tree.take_text(path, "gear_2_toml")?,
        ];
        let periods = periods_of(&gear_toml);
        let of_old = periods.map(|periods| periods.contact());
        let contact_coverage = take_coverage(&mut tree, (path, "contact"), pitches, of_old)?;
        let mut strain = Vec::new();
        for i in 0..gauges {
            let name = |part: &str| format!("gauges/{i}/{part}");
            let gear = tree.take_count(path, &name("gear"))?;
            let of_old = periods.filter(|_| (1..=2).contains(&gear));
            let of_old = of_old.map(|periods| periods.of_tooth(gear));
            let group = format!("gauges/{i}");
            strain.push(StrainSeries {
                gear,
                coverage: take_coverage(&mut tree, (path, &group), pitches, of_old)?,
                name: tree.take_text(path, &name("name"))?,
                error_estimate_relative: tree.take_scalar(path, &name("error"))?,
                method_1: tree.take_f64(path, &name("method_1"), &curves)?,
                method_2: tree.take_f64(path, &name("method_2"), &curves)?,
            });
        }
        let ratings = take_ratings(&mut tree, path)?;
        let seconds = tree.take_f64(path, "seconds", &[2])?;
        let proposal = tree.texts.remove("proposal").unwrap_or_default();
        // Files before these texts have none.
        let microgeometry = ["microgeometry_1", "microgeometry_2"]
            .map(|name| tree.texts.remove(name).unwrap_or_default());
        let mut text = |name: &str| tree.take_text(path, name);
        let title = text("title")?;
        let scene_toml = text("scene_toml")?;
        let model_files = [text("model_1")?, text("model_2")?];
        let (version, created_utc) = (text("version")?, text("created_utc")?);
        let warnings = text("warnings")?.lines().map(str::to_owned).collect();
        Ok(Self {
            title,
            scene_toml,
            gear_toml,
            model_files,
            microgeometry,
            version,
            created_utc,
            pitches,
            contact_coverage,
            proposal,
            angle_rad: tree.take_f64(path, "angle_rad", &[angles])?,
            torque_nm: tree.take_f64(path, "torque_Nm", &[torques])?,
            te_m: tree.take_f64(path, "te_m", &curves)?,
            unloaded_m: tree.take_f64(path, "te_unloaded_m", &[angles])?,
            torque_1_nm: tree.take_f64(path, "torque_1_Nm", &curves)?,
            axial_force_1_n: if tree.arrays.contains_key("axial_force_1_N") {
                tree.take_f64(path, "axial_force_1_N", &curves)?
            } else {
                // Version 1 knew spur gears only.
                vec![0.0; torques * angles]
            },
            secant_n_per_m: tree.take_f64(path, "stiffness_secant_N_per_m", &curves)?,
            tangent_n_per_m: tree.take_f64(path, "stiffness_tangent_N_per_m", &curves)?,
            slots,
            slices,
            pair: tree.take_f64(path, "pair", &[angles, slots])?,
            pair_count: tree.take_u32(path, "pair_count", &[angles])?,
            force_n: tree.take_f64(path, "force_N", &lines)?,
            pressure_pa: tree.take_f64(path, "pressure_Pa", &lines)?,
            places: ContactPlaces::take(&mut tree, path, &[angles, slots, slices])?,
            k_h_beta: tree.take_f64(path, "k_h_beta", &[torques])?,
            iterations: tree.take_u32(path, "iterations", &[torques])?,
            residual: tree.take_f64(path, "residual", &[torques])?,
            torque_balance: tree.take_f64(path, "torque_balance", &[torques])?,
            strain,
            ratings,
            warnings,
            seconds: [seconds[0], seconds[1]],
        })
    }
}
