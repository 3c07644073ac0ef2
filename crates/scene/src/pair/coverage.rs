//! What a run of a pair sees of each period: of the mesh, of each gauged tooth; in memory and in words.

use super::result::StrainSeries;
use super::run::LoadedScene;
use crate::periods::{Coverage, Passage, RunStretch, passage_run, whole_run};

/// What has the period of the mesh, in words.
const CONTACT: &str = "transmission error, stiffness, forces and pressure";

impl LoadedScene {
    fn stretch(&self) -> RunStretch {
        RunStretch {
            start: self.scene.start_rad / self.lines.pair.pitch_1_rad(),
            pitches: self.scene.pitches,
            points: self.scene.points_per_pitch,
        }
    }

    /// How much of the period of transmission error, stiffness, forces and pressure the run sees.
    pub fn contact_coverage(&self) -> Coverage {
        Coverage::of_contact(self.periods.contact(), self.scene.pitches)
    }

    /// How much of the period of a gauge's strain the run sees; `index` in the model of `gear` (1 or 2).
    pub fn gauge_coverage(&self, gear: usize, index: usize) -> Coverage {
        let passage = self.passage(gear, self.models[gear - 1].gauges[index].tooth);
        Coverage::of_tooth(self.periods.of_tooth(gear), self.stretch(), &passage)
    }

    /// When a tooth of a gear (1 or 2) and its neighbours are in mesh.
    fn passage(&self, gear: usize, tooth: usize) -> Passage {
        let pair = &self.lines.pair;
        let teeth = self.periods.teeth[gear - 1];
        // Driver angles at which pair 0 comes on the path and leaves it.
        let (start, end) = self.lines.range_1_rad();
        let at = |roll_rad: f64| (roll_rad - pair.roll_1_rad(0.0, 0)) / pair.pitch_1_rad();
        let number = (0..teeth).find(|p| pair.teeth_of(*p as i64)[gear - 1] == tooth % teeth);
        Passage::of((at(start), at(end)), number.unwrap_or(0), teeth)
    }

    /// Runs that would cover what this one does not, for these gauges (gear and index in its model); empty where it
    /// covers everything.
    pub fn proposal(&self, gauges: &[(usize, usize)]) -> String {
        let passages: Vec<(usize, Passage)> = gauges
            .iter()
            .map(|&(gear, index)| {
                let tooth = self.models[gear - 1].gauges[index].tooth;
                (self.periods.of_tooth(gear), self.passage(gear, tooth))
            })
            .collect();
        let lengths: Vec<usize> = passages.iter().map(|(period, _)| *period).collect();
        let whole = whole_run(self.periods.contact(), &lengths);
        if whole.pitches <= self.scene.pitches {
            return String::new();
        }
        let mut text = format!("{whole} covers everything");
        let points = self.scene.points_per_pitch;
        if let Some(run) = passage_run(&self.periods, &passages, points, whole) {
            text += &format!("; {run} covers peak and range of the gauges");
        }
        text
    }

    /// The periods, what the run sees of them, and a run that sees more: lines of a plan.
    pub(super) fn period_lines(&self) -> Vec<String> {
        let periods = &self.periods;
        let of_gear = |gear: usize| {
            format!(
                "gear {gear} {} (body {})",
                periods.teeth[gear - 1],
                periods.body(gear)
            )
        };
        let mut lines = vec![format!(
            "periods    in pitches: mesh 1, {}, {}, common {}",
            of_gear(1),
            of_gear(2),
            periods.common()
        )];
        let mut all = vec![(CONTACT.to_owned(), self.contact_coverage())];
        all.extend(self.gauges.iter().map(|&(gear, index)| {
            let name = &self.models[gear - 1].gauges[index].name;
            (gauge_name(name, gear), self.gauge_coverage(gear, index))
        }));
        lines.extend(
            all.iter()
                .map(|(name, coverage)| format!("covered    {name}: {coverage}")),
        );
        let proposal = self.proposal(&self.gauges);
        if !proposal.is_empty() {
            lines.push(format!("proposal   {proposal}"));
        }
        lines
    }
}

fn gauge_name(name: &str, gear: usize) -> String {
    format!("strain at gauge {name} of gear {gear}")
}

/// All quantities of a result by name.
pub(super) fn named(contact: Coverage, strain: &[StrainSeries]) -> Vec<(String, Coverage)> {
    let mut all = vec![(CONTACT.to_owned(), contact)];
    all.extend(
        strain
            .iter()
            .map(|s| (gauge_name(&s.name, s.gear), s.coverage)),
    );
    all
}
