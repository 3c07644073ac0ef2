//! `[[rating]]` of a pair: the gauges' strain over whole revolutions and the largest normal force, at each torque.

use gearmesh_geometry::input::{Count, TableKeys};
use gearmesh_geometry::{GearDefinition, GearPair, InputError};
use gearmesh_model::ReducedGear;
use gearmesh_rating::{NominalRating, TurningPoints};
use gearmesh_specification::rating::{FatigueTable, RatingTable};
use std::sync::Arc;

use super::result::{SceneResult, StrainSeries};
use super::scene_file::Scene;
use crate::rating::{
    FatigueJob, PassageLength, RatingFigure, RatingResult, nominal_error, nominal_figures,
    nominal_method, nominal_remark, rim_m,
};

/// A rating, made of the curves of a result.
#[derive(Debug, Clone, PartialEq)]
pub struct PairRating {
    /// What is rated, in words.
    pub name: String,
    /// How, in words.
    pub method: String,
    rule: PairRule,
}

#[derive(Debug, Clone, PartialEq)]
enum PairRule {
    Fatigue {
        job: FatigueJob,
        /// Place of the gauge among those of the scene.
        series: usize,
        /// Method of strain recovery, 1 or 2.
        method: usize,
        /// Of the gauge's gear, in one passage of the history.
        revolutions: f64,
    },
    Nominal(Box<NominalRating>),
}

/// The scene's parts that ratings are made of.
pub(crate) struct RatedPair<'a> {
    pub scene: &'a Scene,
    pub pair: &'a GearPair,
    pub gears: [&'a GearDefinition; 2],
    pub models: &'a [Arc<ReducedGear>; 2],
    /// Gauges that are read: gear (1 or 2) and index in its model.
    pub gauges: &'a [(usize, usize)],
}

impl RatedPair<'_> {
    /// All ratings of the scene.
    ///
    /// # Errors
    /// [`InputError`] naming the key.
    pub fn ratings(&self) -> Result<Vec<PairRating>, InputError> {
        let mut ratings = Vec::new();
        for (i, table) in self.scene.ratings.iter().enumerate() {
            let key = format!("rating.{i}");
            let keys = TableKeys::new(&self.scene.document, &key);
            table.refuse_keys_of_systems(&keys)?;
            ratings.push(match table {
                // Refused above: a pair has no bearings.
                RatingTable::BearingLife(_) => continue,
                RatingTable::Fatigue(table) => self.fatigue(table, &keys)?,
                RatingTable::Nominal(table) => {
                    let load = table.load_point();
                    let teeth = self.gears.map(|gear| &gear.tooth);
                    let materials = self.gears.map(|gear| gear.material);
                    let rims = self.gears.map(rim_m);
                    let rating = NominalRating::new(
                        self.pair,
                        teeth,
                        materials,
                        rims,
                        (load, table.tolerance_class.map(Count::get)),
                    )
                    .map_err(|error| nominal_error(&error, "kind", &keys))?;
                    PairRating {
                        name: "the pair".into(),
                        method: nominal_method(load),
                        rule: PairRule::Nominal(Box::new(rating)),
                    }
                }
            });
        }
        Ok(ratings)
    }

    fn fatigue(
        &self,
        table: &FatigueTable,
        keys: &TableKeys<'_>,
    ) -> Result<PairRating, InputError> {
        let rule = &table.rule(keys)?;
        let series = self.gauge(&rule.gauge, table.gear.map(Count::get), keys)?;
        let (gear, _) = self.gauges[series];
        let (pitches, teeth) = (self.scene.pitches, self.models[gear - 1].teeth);
        if !pitches.is_multiple_of(teeth) {
            let problem = format!(
                "its history must be whole revolutions of gear {gear}: run.pitches is {pitches}, allowed are multiples of its {teeth} teeth"
            );
            return Err(keys.error("gauge", problem));
        }
        let material = self.gears[gear - 1].material;
        Ok(PairRating {
            name: format!("gauge {} of gear {gear}", rule.gauge),
            method: rule.method(),
            rule: PairRule::Fatigue {
                job: FatigueJob::new(rule, material, &self.scene.folder, keys)?,
                series,
                method: rule.method,
                revolutions: (pitches / teeth) as f64,
            },
        })
    }

    /// Place of a gauge among those that the scene reads.
    fn gauge(
        &self,
        name: &str,
        gear: Option<usize>,
        keys: &TableKeys<'_>,
    ) -> Result<usize, InputError> {
        let name_of = |&(gear, index): &(usize, usize)| &*self.models[gear - 1].gauges[index].name;
        let asked = |of: usize| gear.is_none_or(|gear| gear == of);
        let mut found = (0..self.gauges.len())
            .filter(|&k| asked(self.gauges[k].0) && name_of(&self.gauges[k]) == name);
        let Some(place) = found.next() else {
            let read = self.gauges.iter().filter(|gauge| asked(gauge.0));
            let known: Vec<&str> = read.map(name_of).collect();
            let problem = format!(
                "[gauges] reads no gauge `{name}` of {}; it reads: {}",
                gear.map_or("either gear".into(), |gear| format!("gear {gear}")),
                if known.is_empty() {
                    "none".into()
                } else {
                    known.join(", ")
                }
            );
            return Err(keys.error("gauge", problem));
        };
        if found.any(|other| self.gauges[other].0 != self.gauges[place].0) {
            let problem = format!("missing; gauges of both gears are called `{name}`");
            return Err(keys.error("gear", problem));
        }
        Ok(place)
    }
}

impl PairRating {
    /// Judges one torque of a result whose strain is that of the scene's gauges.
    fn judged(&self, result: &SceneResult, torque: usize) -> RatingResult {
        let mut warnings = Vec::new();
        let (coverage, figures) = match &self.rule {
            PairRule::Nominal(rating) => {
                warnings.extend(nominal_remark(rating));
                let forces = result.normal_force_n(torque);
                let largest = forces.into_iter().fold(0.0, f64::max);
                let figures = nominal_figures(rating, largest).map_err(|e| e.to_string());
                (result.contact_coverage, figures)
            }
            PairRule::Fatigue {
                job,
                series,
                method,
                revolutions,
            } => {
                let series: &StrainSeries = &result.strain[*series];
                let strain = if *method == 1 {
                    &series.method_1
                } else {
                    &series.method_2
                };
                let figures = history(job, result.curve(strain, torque), *revolutions);
                (series.coverage, figures)
            }
        };
        let name = format!("{} at {} N m", self.name, result.torque_nm[torque]);
        RatingResult::new(name, self.method.clone(), figures)
            .incomplete_by(coverage.missing())
            .warning(warnings)
    }
}

/// Figures of a history of strain.
fn history(
    job: &FatigueJob,
    strain: &[f64],
    revolutions: f64,
) -> Result<Vec<RatingFigure>, String> {
    let mut points = TurningPoints::default();
    for value in strain {
        let stress_pa = job.modulus_pa * value;
        points.push(stress_pa).map_err(|e| e.to_string())?;
    }
    job.figures(points, PassageLength::Revolutions(revolutions))
        .map_err(|e| e.to_string())
}

/// All ratings at all torques, torque by torque.
pub(super) fn judged(ratings: &[PairRating], result: &SceneResult) -> Vec<RatingResult> {
    (0..result.torque_nm.len())
        .flat_map(|torque| {
            ratings
                .iter()
                .map(move |rating| rating.judged(result, torque))
        })
        .collect()
}
