//! The parts of a multibody result in its file besides the rows, declared once for writing, reading and docs/files.md.

use std::f64::consts::TAU;

use gearmesh_dynamics::NaturalMode;
use gearmesh_model::{Column, Fields, FileError, OPEN, Record};

use super::column_names::unit_in_name;
use super::column_statistics::Figures;
use super::job::{MeshRecord, RunHead};
use super::result::{EigenResult, SweepResult};
use super::result_kind::ResultKind;
use super::run_record::RunRecord;
use super::speed_plan::Window;
use super::stages::StageLoad;
use crate::rating::RatingResult;
use crate::system::StageSummary;
use crate::system::planetary::PlanetarySet;

/// The first version in which channels and columns state their units.
pub(super) const STATED_UNITS: u32 = 2;

/// Everything but the rows.
#[derive(Debug, Default)]
pub(super) struct Contents {
    pub kind: ResultKind,
    pub head: RunHead,
    pub version: String,
    pub created_utc: String,
    pub record: Option<RunRecord>,
    pub statistics: Vec<Figures>,
    pub statistics_from_s: Option<f64>,
    pub samples_per_row: Option<f64>,
    pub folded: Vec<f64>,
    pub sweep: Option<SweepResult>,
    pub ratings: Vec<RatingResult>,
    pub bodies: Vec<String>,
    pub elements: Vec<String>,
    pub eigen: Vec<EigenResult>,
}

impl Record for Contents {
    fn fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        f.choice("kind", &mut self.kind, "kind of the result")?;
        self.head.fields(f)?;
        f.text("version", &mut self.version, "version of the program")?;
        f.text("created_utc", &mut self.created_utc, "when, UTC")?;
        // A kind has its own parts; the documentation lists those of all.
        let of = |is_one: bool| is_one || f.is_listing();
        let [in_time, transient] =
            [self.kind.is_in_time(), self.kind == ResultKind::Transient].map(of);
        let [sweep, eigen] =
            [ResultKind::SpeedSweep, ResultKind::Eigen].map(|kind| of(self.kind == kind));
        if in_time {
            let record = self.record.get_or_insert_default();
            f.group("run", |f| record.fields(f))?;
        }
        if transient {
            f.group("statistics", |f| {
                figure_fields(&mut self.statistics, f, &[("column", OPEN)])?;
                let what =
                    "begin of the statistics; files of older programs have those of all rows";
                f.number_if_there("from_s", &mut self.statistics_from_s, "s", what)?;
                let what =
                    "samples for each row, from which statistics and filtered columns are made";
                f.number_if_there("samples_per_row", &mut self.samples_per_row, "1", what)?;
                if f.keeps("folded", !self.folded.is_empty()) {
                    let axes = [("column", self.statistics.len())];
                    let what = "RMS value of what vibrates faster than rows can tell";
                    f.numbers("folded", &mut self.folded, &axes, "of the column", what)?;
                }
                Ok(())
            })?;
        }
        if sweep {
            let sweep = self.sweep.get_or_insert_default();
            f.group("sweep", |f| sweep.fields(f))?;
        }
        if eigen {
            self.eigen_fields(f)?;
        }
        f.list("ratings", &mut self.ratings, RatingResult::fields)
    }
}

impl Record for RunHead {
    fn fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        f.text("title", &mut self.title, "title of the scene")?;
        let what = "the scene, word for word";
        f.text("scene_toml", &mut self.scene_toml, what)?;
        let what = "names and digests of the files that the scene names";
        f.lines("inputs", &mut self.inputs, what)?;
        f.lines("notes", &mut self.notes, "assumptions and warnings")?;
        f.list("meshes", &mut self.meshes, MeshRecord::fields)?;
        f.list("planetary", &mut self.sets, PlanetarySet::fields)
    }
}

impl Record for PlanetarySet {
    fn fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        f.text("name", &mut self.name, "name of the planetary set")?;
        let (teeth, members) = (&mut self.teeth, &mut self.members);
        for (name, count) in [
            ("teeth_planet", &mut teeth.planet),
            ("teeth_planet_to_ring", &mut teeth.planet_to_ring),
        ] {
            let what = "teeth of the planet to the sun and to the ring";
            f.count(name, count, what)?;
        }
        for (name, count, body, own) in [
            ("sun", &mut teeth.sun, "teeth_sun", &mut members.sun),
            ("ring", &mut teeth.ring, "teeth_ring", &mut members.ring),
        ] {
            let mut names: Vec<String> = own.take().into_iter().collect();
            f.lines(name, &mut names, "body, where the set has one")?;
            *own = names.pop();
            let mut number = count.unwrap_or(0);
            f.count(body, &mut number, "its teeth, 0 without it")?;
            *count = (number > 0).then_some(number);
        }
        f.text("carrier", &mut members.carrier, "body of the carrier")?;
        f.lines("planets", &mut self.planets, "bodies of the planets")?;
        self.partner_fields(f)?;
        let what = "meshes of sun and planets";
        f.lines("sun_meshes", &mut self.sun_meshes, what)?;
        let what = "meshes of planets and ring";
        f.lines("ring_meshes", &mut self.ring_meshes, what)?;
        let axes = [("planet", self.planets.len())];
        let what = "angles of the planets from x";
        f.numbers("angles_rad", &mut self.angles_rad, &axes, "rad", what)?;
        let what = "distance of the pins from the axis";
        f.number("centre_distance_m", &mut self.centre_distance_m, "m", what)?;
        let mut axis = self.axis.to_vec();
        if f.has("axis") {
            let what = "direction of the axis in the world";
            f.numbers("axis", &mut axis, &[("coordinate", 3)], "1", what)?;
        }
        self.axis = axis.try_into().unwrap_or([0.0, 0.0, 1.0]);
        Ok(())
    }
}

impl PlanetarySet {
    /// Of meshed planets; files of older programs have none.
    fn partner_fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        if !f.keeps("partners", self.teeth.is_meshed) {
            return Ok(());
        }
        self.teeth.is_meshed = true;
        let it = &mut self.partners;
        let what = "of meshed planets: bodies of the partners";
        f.lines("partners", &mut it.bodies, what)?;
        let what = "of meshed planets: meshes of planets and partners";
        f.lines("pair_meshes", &mut it.meshes, what)?;
        let what = "of meshed planets: how far partners are ahead of their planets";
        f.number("partner_ahead_rad", &mut it.ahead_rad, "rad", what)?;
        let what = "of meshed planets: distance of the partners' pins from the axis";
        f.number("partner_distance_m", &mut it.distance_m, "m", what)
    }
}

impl Record for MeshRecord {
    fn fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        f.text("name", &mut self.name, "name of the gear mesh")?;
        for (body, name) in self.bodies.iter_mut().zip(["body_1", "body_2"]) {
            f.text(name, body, "body of the gear")?;
        }
        for (teeth, name) in self.teeth.iter_mut().zip(["teeth_1", "teeth_2"]) {
            f.count(name, teeth, "teeth of the gear")?;
        }
        let corners = &mut self.flank_corners_m;
        if f.keeps("flank_corners_m", !corners.is_empty()) {
            let axes = [("gear", 2), ("corner", 4), ("place", 2)];
            let what = "of bevel pairs: cone distance and height above the pitch cone of lower line and tip at the toe, tip and lower line at the heel";
            f.numbers("flank_corners_m", corners, &axes, "m", what)?;
        }
        f.optional("stage", &mut self.stage, StageSummary::fields)?;
        let mut speeds: Vec<f64> = self.speeds_rad_per_s.into_iter().flatten().collect();
        if f.has("speeds_rad_per_s") {
            let what = "speeds of gear 1 and gear 2 about their z at the start";
            let axes = [("gear", OPEN)];
            f.numbers("speeds_rad_per_s", &mut speeds, &axes, "rad/s", what)?;
        }
        self.speeds_rad_per_s = speeds.first_chunk().copied();
        Ok(())
    }
}

impl Record for SweepResult {
    fn fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        self.column_fields(f)?;
        let mut numbers = |name: &str, unit: &str, what: &str, of: fn(&mut Window) -> &mut f64| {
            let values = self.windows.iter_mut().map(|window| *of(window));
            let mut values: Vec<f64> = values.collect();
            f.numbers(name, &mut values, &[("window", OPEN)], unit, what)?;
            self.windows.resize_with(values.len(), Window::default);
            let windows = self.windows.iter_mut().zip(values);
            windows.for_each(|(window, value)| *of(window) = value);
            Ok::<_, FileError>(())
        };
        let what = "prescribed speed";
        numbers("speed_rad_per_s", "rad/s", what, |w| &mut w.speed_rad_per_s)?;
        numbers("from_s", "s", "begin of the measurement", |w| &mut w.from_s)?;
        numbers("to_s", "s", "end of the measurement", |w| &mut w.to_s)?;
        let windows = ("window", self.windows.len());
        let ways = self.windows.iter().map(|w| f64::from(u8::from(w.up)));
        let mut up: Vec<f64> = ways.collect();
        let what = "1 on the way up, 0 on the way down";
        f.numbers("up", &mut up, &[windows], "1", what)?;
        let ways = self.windows.iter_mut().zip(up);
        ways.for_each(|(window, up)| window.up = up != 0.0);
        let columns = self.columns.len();
        let mut figures = self.figures.concat();
        figure_fields(&mut figures, f, &[windows, ("column", columns)])?;
        self.figures = figures.chunks(columns.max(1)).map(<[_]>::to_vec).collect();
        Ok(())
    }
}

impl SweepResult {
    fn column_fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        let of = |part: fn(&Column) -> &String| self.columns.iter().map(part).cloned().collect();
        let (mut names, mut units, mut texts): (Vec<String>, Vec<String>, Vec<String>) =
            (of(|c| &c.name), of(|c| &c.unit), of(|c| &c.description));
        f.lines("columns", &mut names, "names of the columns")?;
        if f.version() >= STATED_UNITS {
            f.lines("units", &mut units, "their units")?;
            f.lines("descriptions", &mut texts, "what they are")?;
        } else {
            units = names
                .iter()
                .map(|name| unit_in_name(name).to_owned())
                .collect();
            texts = vec![String::new(); names.len()];
        }
        if names.len() != units.len() || names.len() != texts.len() {
            return Err(f.contradiction("units", "there are not as many as columns"));
        }
        let columns = names.into_iter().zip(units).zip(texts);
        let column =
            |((name, unit), text): ((String, String), String)| Column::new(name, &unit, &text);
        self.columns = columns.map(column).collect();
        Ok(())
    }
}

fn figure_fields(
    figures: &mut Vec<Figures>,
    f: &mut Fields<'_>,
    axes: &[(&str, usize)],
) -> Result<(), FileError> {
    let mut part = |name: &str, what: &str, of: fn(&mut Figures) -> &mut f64| {
        let mut values: Vec<f64> = figures.iter_mut().map(|figures| *of(figures)).collect();
        f.numbers(name, &mut values, axes, "of the column", what)?;
        figures.resize_with(values.len(), Figures::default);
        let pairs = figures.iter_mut().zip(values);
        pairs.for_each(|(figures, value)| *of(figures) = value);
        Ok::<_, FileError>(())
    };
    part("mean", "mean", |f| &mut f.mean)?;
    let what = "standard deviation: RMS value about the mean";
    part("deviation", what, |f| &mut f.deviation)?;
    part("least", "smallest value", |f| &mut f.least)?;
    part("largest", "largest value", |f| &mut f.largest)
}

impl Contents {
    fn eigen_fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        f.lines("eigen/bodies", &mut self.bodies, "names of the bodies")?;
        // Files of older programs have no elements.
        if f.has("eigen/elements") {
            let what = "names of the force elements";
            f.lines("eigen/elements", &mut self.elements, what)?;
        }
        let names = [self.bodies.len(), self.elements.len()];
        f.numbered_list("eigen", &mut self.eigen, |point, f| {
            point_fields(point, f, names)
        })
    }
}

fn point_fields(
    it: &mut EigenResult,
    f: &mut Fields<'_>,
    [bodies, elements]: [usize; 2],
) -> Result<(), FileError> {
    let what = "share of the scene's loads";
    f.number("load_factor", &mut it.point.load_factor, "1", what)?;
    let what = "speed of the varied motion, where one is varied";
    let speed = &mut it.point.speed_rad_per_s;
    f.number_if_there("speed_rad_per_s", speed, "rad/s", what)?;
    let of = |value: fn(&NaturalMode) -> f64| it.modes.iter().map(value).collect::<Vec<f64>>();
    let mut frequency = of(NaturalMode::frequency_hz);
    let mut damping = of(NaturalMode::damping_ratio);
    let mut growth = of(|mode| mode.growth_per_s);
    let (modes, what) = (("mode", OPEN), "frequency of the damped vibration");
    f.numbers("frequency_Hz", &mut frequency, &[modes], "Hz", what)?;
    let modes = ("mode", frequency.len());
    let what = "damping ratio";
    f.numbers("damping_ratio", &mut damping, &[modes], "1", what)?;
    let what = "real part of the eigenvalue, negative where the motion dies out";
    f.numbers("growth_per_s", &mut growth, &[modes], "1/s", what)?;
    let amplitudes = || it.modes.iter().flat_map(|mode| &mode.shape);
    let mut real: Vec<f64> = amplitudes().map(|a| a[0]).collect();
    let mut imaginary: Vec<f64> = amplitudes().map(|a| a[1]).collect();
    let axes = [modes, ("degree of freedom", OPEN)];
    let what = "of each body displacement and rotation along world axes, then modal coordinates; the largest is 1";
    f.numbers("shape_real", &mut real, &axes, "m or rad", what)?;
    let dofs = real.len() / modes.1.max(1);
    let axes = [modes, ("degree of freedom", dofs)];
    f.numbers("shape_imaginary", &mut imaginary, &axes, "m or rad", what)?;
    let axes = [modes, ("body", bodies)];
    let what = "share of each body in the kinetic energy";
    share_fields("participation", &mut it.participation, f, (axes, what))?;
    if elements > 0 || f.is_listing() {
        let axes = [modes, ("element", elements)];
        let what = "share of each force element in the strain energy";
        share_fields("strain", &mut it.strain, f, (axes, what))?;
    }
    f.list("meshes", &mut it.loads, |(mesh, load), f| {
        f.count("mesh", mesh, "place of the mesh among all")?;
        load.fields(f)
    })?;
    if f.is_reading() {
        let shape = |i: usize| (i * dofs..(i + 1) * dofs).map(|k| [real[k], imaginary[k]]);
        let mode = |i: usize| NaturalMode {
            growth_per_s: growth[i],
            angular_frequency_rad_per_s: TAU * frequency[i],
            shape: shape(i).collect(),
        };
        it.modes = (0..modes.1).map(mode).collect();
    }
    Ok(())
}

impl Record for StageLoad {
    fn fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        let what = "moments of the mesh on the bodies of gear 1 and gear 2 about their z";
        let axes = [("gear", 2)];
        f.fixed("moments_Nm", &mut self.moments_nm, &axes, "N·m", what)?;
        let mut forces: Vec<f64> = self.forces_n.into_iter().flatten().collect();
        let what = "tangential, radial and axial force on gear 1; none of kinematic meshes";
        f.numbers("forces_N", &mut forces, &[("way", OPEN)], "N", what)?;
        self.forces_n = forces.first_chunk().copied();
        let what = "largest over mean line load of the slices";
        f.optional_number("k_h_beta", &mut self.k_h_beta, "1", what)?;
        let what = "pairs of teeth that carry; none of kinematic meshes";
        f.optional_number("loaded_pairs", &mut self.loaded_pairs, "1", what)
    }
}

fn share_fields(
    name: &str,
    shares: &mut Vec<Vec<f64>>,
    f: &mut Fields<'_>,
    (axes, what): ([(&str, usize); 2], &str),
) -> Result<(), FileError> {
    let mut flat = shares.concat();
    f.numbers(name, &mut flat, &axes, "1", what)?;
    *shares = flat.chunks(axes[1].1.max(1)).map(<[_]>::to_vec).collect();
    Ok(())
}
