//! After how many mesh pitches a quantity of a gear pair repeats, and whether a run has seen that much of it.
//!
//! All periods are whole numbers of pitches. Gear i has z_i teeth, and its body looks the same after every z_i/N_i of
//! them (N_i sectors; one where a tooth differs from the others):
//!
//! | what | repeats after |
//! | --- | --- |
//! | the mesh of two gears whose teeth are all alike | 1 |
//! | gear i, its body | z_i, z_i/N_i |
//! | transmission error, stiffness, forces, pressure | lcm(z_1/N_1, z_2/N_2) |
//! | strain at a tooth of gear i | lcm(z_i, z_k/N_k), k the other gear |
//! | everything: the hunting period | lcm(z_1, z_2) |
//!
//! Derivation: docs/theory/periods.md.

use std::fmt;

use gearmesh_geometry::GearDefinition;
use gearmesh_geometry::definition::greatest_common_divisor;
use gearmesh_model::Named;

/// Pitches that neighbouring teeth are in mesh longer than the tooth itself, at each end: what loads them is felt in
/// its root.
const NEIGHBOURS: f64 = 1.0;

/// Share of a pitch by which rounding may miss the end of a passage.
const ROUNDING: f64 = 1e-9;

/// Least common multiple; the largest number there is where it is larger still.
pub fn least_common_multiple(a: usize, b: usize) -> usize {
    let divisor = greatest_common_divisor(a, b).max(1);
    (a / divisor).saturating_mul(b)
}

/// Teeth and repetition of a pair: all its periods follow.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PairPeriods {
    /// Numbers of teeth.
    pub teeth: [usize; 2],
    /// Equal sectors of each body, divisors of the teeth; 1 where a tooth differs from the others.
    pub sectors: [usize; 2],
}

impl PairPeriods {
    /// The periods of two gears: their openings, and whether one has a cracked tooth.
    pub fn of(gears: [&GearDefinition; 2]) -> Self {
        Self {
            teeth: gears.map(|gear| gear.tooth.teeth),
            sectors: gears.map(|gear| match gear.crack {
                Some(_) => 1,
                None => gear.sectors(),
            }),
        }
    }

    /// The same pair where the teeth of a gear (1 or 2) differ from each other, by errors or faults.
    #[must_use]
    pub fn with_unlike_teeth(mut self, gear: usize) -> Self {
        self.sectors[gear - 1] = 1;
        self
    }

    /// Pitches after which the body of a gear (1 or 2) looks the same.
    pub fn body(&self, gear: usize) -> usize {
        self.teeth[gear - 1] / self.sectors[gear - 1]
    }

    /// Period of what both bodies share: transmission error, stiffness, forces, pressure \[pitches\].
    pub fn contact(&self) -> usize {
        least_common_multiple(self.body(1), self.body(2))
    }

    /// Period of what a tooth of a gear (1 or 2) feels: its own revolution, and the other body's period \[pitches\].
    pub fn of_tooth(&self, gear: usize) -> usize {
        least_common_multiple(self.teeth[gear - 1], self.body(3 - gear))
    }

    /// Pitches after which each tooth has met each tooth that it ever meets.
    pub fn common(&self) -> usize {
        least_common_multiple(self.teeth[0], self.teeth[1])
    }
}

/// The stretch of driver angle in which a gauged tooth and both its neighbours are in mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passage {
    /// Its begin \[pitches of driver angle\]; it comes again after each revolution of the tooth's gear.
    pub from: f64,
    /// Its length \[pitches\].
    pub length: f64,
    /// Teeth of the tooth's gear.
    pub teeth: usize,
}

impl Passage {
    /// Of the pair number `pair`, whose contact goes over `contact` \[pitches of driver angle, of pair 0\].
    pub fn of(contact: (f64, f64), pair: usize, teeth: usize) -> Self {
        Self {
            from: contact.0 + pair as f64 - NEIGHBOURS,
            length: contact.1 - contact.0 + 2.0 * NEIGHBOURS,
            teeth,
        }
    }

    /// Pitches from a place to the next begin of the passage.
    fn ahead_of(&self, place: f64) -> f64 {
        let ahead = (self.from - place).rem_euclid(self.teeth as f64);
        // A begin that rounding puts just before the place is at the place.
        if ahead > self.teeth as f64 - ROUNDING {
            0.0
        } else {
            ahead
        }
    }
}

/// The stretch of driver angle that a run sees \[pitches\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunStretch {
    /// First position.
    pub start: f64,
    /// Pitches.
    pub pitches: usize,
    /// Positions a pitch.
    pub points: usize,
}

impl RunStretch {
    fn holds(&self, passage: &Passage) -> bool {
        let last = self.pitches as f64 - 1.0 / self.points as f64;
        passage.ahead_of(self.start) + passage.length <= last + ROUNDING
    }
}

/// How much of a quantity a run has seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Extent {
    /// At least one period.
    Whole,
    /// Less, but the one passage of the gauged tooth, with both neighbours: peak and range are right, mean and spectrum
    /// are not.
    Passage,
    /// Less: any figure may change with a longer run.
    Part,
}

impl Named for Extent {
    const NAMES: &'static [(Self, &'static str)] = &[
        (Self::Whole, "whole"),
        (Self::Passage, "passage"),
        (Self::Part, "part"),
    ];
}

/// Period of a quantity beside the run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Coverage {
    /// Pitches after which the quantity repeats.
    pub period_pitches: usize,
    /// Pitches that the run goes through.
    pub run_pitches: usize,
    /// How much of the period the run has seen.
    pub extent: Extent,
}

impl Default for Coverage {
    /// Nothing run, of nothing known.
    fn default() -> Self {
        Self {
            period_pitches: 1,
            run_pitches: 0,
            extent: Extent::Part,
        }
    }
}

impl Coverage {
    /// Of a quantity of the mesh.
    pub fn of_contact(period_pitches: usize, run_pitches: usize) -> Self {
        Self {
            period_pitches,
            run_pitches,
            extent: if run_pitches >= period_pitches {
                Extent::Whole
            } else {
                Extent::Part
            },
        }
    }

    /// Of the strain at a tooth that makes one passage a period; where it makes several, which differ, only the period
    /// counts.
    pub fn of_tooth(period_pitches: usize, run: RunStretch, passage: &Passage) -> Self {
        let whole = Self::of_contact(period_pitches, run.pitches);
        let once = period_pitches == passage.teeth && run.holds(passage);
        match whole.extent {
            Extent::Part if once => Self {
                extent: Extent::Passage,
                ..whole
            },
            _ => whole,
        }
    }

    /// Whether the largest and the smallest value are those of any longer run.
    pub fn has_extremes(&self) -> bool {
        self.extent != Extent::Part
    }

    /// Whether mean, spectrum and rating are those of any longer run.
    pub fn is_whole(&self) -> bool {
        self.extent == Extent::Whole
    }

    /// Pitches to make means over: as many whole periods as the run has, or all of the run where it has none.
    pub fn averaged_pitches(&self) -> usize {
        match self.run_pitches / self.period_pitches.max(1) {
            0 => self.run_pitches,
            periods => periods * self.period_pitches,
        }
    }

    /// Pitches that a periodic function is made of: whole revolutions of a shaft with `teeth` where the run has them,
    /// or one period. None where the run has less.
    pub fn periodic_pitches(&self, teeth: usize) -> Option<usize> {
        let turns = least_common_multiple(self.period_pitches, teeth);
        [turns, self.period_pitches]
            .into_iter()
            .find(|pitches| *pitches <= self.run_pitches)
    }

    /// What is missing, in words; none where nothing is.
    pub fn missing(&self) -> Option<String> {
        let Self {
            period_pitches,
            run_pitches,
            ..
        } = self;
        match self.extent {
            Extent::Whole => None,
            Extent::Passage => Some(format!(
                "mean and spectrum incomplete: {run_pitches} of {period_pitches} pitches; peak and range are those of the tooth's one passage"
            )),
            Extent::Part => Some(format!(
                "incomplete: {run_pitches} of {period_pitches} pitches"
            )),
        }
    }
}

impl fmt::Display for Coverage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.missing() {
            Some(missing) => f.write_str(&missing),
            None => write!(
                f,
                "complete: {} pitches, period {}",
                self.run_pitches, self.period_pitches
            ),
        }
    }
}

/// A run that would cover more.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProposedRun {
    /// `run.start_deg`; none where any start will do.
    pub start_deg: Option<f64>,
    /// `run.pitches`.
    pub pitches: usize,
}

impl fmt::Display for ProposedRun {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(start_deg) = self.start_deg {
            write!(f, "run.start_deg = {start_deg:.2}, ")?;
        }
        write!(f, "run.pitches = {}", self.pitches)
    }
}

/// The shortest run that covers one period of everything.
pub fn whole_run(contact_period: usize, gauge_periods: &[usize]) -> ProposedRun {
    let longest = gauge_periods.iter().copied().max().unwrap_or(1);
    ProposedRun {
        start_deg: None,
        pitches: longest.max(contact_period),
    }
}

/// The shortest run that sees the whole passage of every gauged tooth, and a period of the mesh: right for peak and
/// range. None without gauges, where a tooth has passages that differ, and where it would be no shorter than `whole`.
pub fn passage_run(
    periods: &PairPeriods,
    gauges: &[(usize, Passage)],
    points: usize,
    whole: ProposedRun,
) -> Option<ProposedRun> {
    if gauges
        .iter()
        .any(|(period, passage)| *period != passage.teeth)
    {
        return None;
    }
    let pitch_deg = 360.0 / periods.teeth[0] as f64;
    let runs = gauges.iter().map(|(_, first)| {
        // The begin nearest to angle 0, downwards to the hundredth of a degree that is printed.
        let turn = first.teeth as f64;
        let from = first.from - turn * (first.from / turn).round();
        let start_deg = (100.0 * from * pitch_deg - ROUNDING).floor() / 100.0;
        let start = start_deg / pitch_deg;
        let end = |(_, passage): &(usize, Passage)| passage.ahead_of(start) + passage.length;
        let length = gauges.iter().map(end).fold(0.0, f64::max);
        let pitches = (length + 1.0 / points as f64 - ROUNDING).ceil() as usize;
        ProposedRun {
            start_deg: Some(start_deg),
            pitches: pitches.max(periods.contact()),
        }
    });
    runs.min_by_key(|run| run.pitches)
        .filter(|run| run.pitches < whole.pitches)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn pair(teeth: [usize; 2], sectors: [usize; 2]) -> PairPeriods {
        PairPeriods { teeth, sectors }
    }

    #[test]
    fn periods_are_those_of_the_table() {
        let solid = pair([23, 47], [23, 47]);
        assert_eq!(
            (solid.contact(), solid.of_tooth(1), solid.of_tooth(2)),
            (1, 23, 47)
        );
        // Six holes in 47 teeth: nothing of the wheel repeats before its revolution.
        let drilled = pair([23, 47], [23, 1]);
        assert_eq!(
            (drilled.contact(), drilled.of_tooth(1), drilled.of_tooth(2)),
            (47, 1081, 47)
        );
        // Six holes in 48 teeth: eight teeth from hole to hole.
        let even = pair([23, 48], [23, 6]);
        assert_eq!(
            (even.contact(), even.of_tooth(1), even.of_tooth(2)),
            (8, 184, 48)
        );
        assert_eq!(solid.with_unlike_teeth(2), drilled);
        assert_eq!(
            (drilled.common(), pair([20, 30], [20, 30]).common()),
            (1081, 60)
        );
    }

    /// The definition itself: teeth of pair p, and the place of each body under them, are those of pair p + period, and
    /// of no earlier one.
    #[test]
    fn nothing_repeats_earlier() {
        for (teeth, sectors) in [
            ([23, 47], [23, 1]),
            ([12, 18], [4, 3]),
            ([10, 15], [5, 15]),
            ([57, 57], [57, 3]),
        ] {
            let periods = pair(teeth, sectors);
            let place = |p: usize, gear: usize| p % (teeth[gear] / sectors[gear]);
            let first = |same: &dyn Fn(usize) -> bool| (1..).find(|p| same(*p)).unwrap();
            let bodies = |p: usize| place(p, 0) == 0 && place(p, 1) == 0;
            assert_eq!(periods.contact(), first(&bodies));
            for (gear, &turn) in teeth.iter().enumerate() {
                let tooth = |p: usize| p.is_multiple_of(turn) && place(p, 1 - gear) == 0;
                assert_eq!(periods.of_tooth(gear + 1), first(&tooth));
            }
        }
    }

    #[test]
    fn a_run_that_starts_in_the_passage_does_not_hold_it() {
        // Contact of pair 0 from -0.8 to 0.8 pitches; with its neighbours from -1.8 to 1.8.
        let passage = Passage::of((-0.8, 0.8), 0, 47);
        let run = |start, pitches| RunStretch {
            start,
            pitches,
            points: 24,
        };
        let extent = |start, pitches| Coverage::of_tooth(47, run(start, pitches), &passage).extent;
        assert_eq!(extent(0.0, 3), Extent::Part);
        assert_eq!(extent(-1.8, 3), Extent::Part);
        assert_eq!(extent(-1.8, 4), Extent::Passage);
        assert_eq!(extent(45.2, 4), Extent::Passage);
        assert_eq!(extent(0.0, 46), Extent::Part);
        assert_eq!(extent(0.0, 47), Extent::Whole);
        // Passages that differ: only the period will do.
        let several = Coverage::of_tooth(1081, run(-1.8, 60), &passage);
        assert_eq!(several.extent, Extent::Part);
        assert!(several.to_string().contains("60 of 1081 pitches"));
    }

    #[test]
    fn means_and_functions_are_of_whole_periods() {
        let coverage = Coverage::of_contact(47, 100);
        assert_eq!(coverage.averaged_pitches(), 94);
        assert_eq!(coverage.periodic_pitches(23), Some(47));
        assert_eq!(Coverage::of_contact(1, 60).periodic_pitches(57), Some(57));
        assert_eq!(Coverage::of_contact(1, 5).periodic_pitches(57), Some(1));
        let part = Coverage::of_contact(47, 3);
        assert_eq!(
            (part.averaged_pitches(), part.periodic_pitches(23)),
            (3, None)
        );
    }

    proptest! {
        /// A proposed run covers what it was proposed for, at the angle as it is printed.
        #[test]
        fn proposals_cover(
            z1 in 12usize..90, z2 in 12usize..90, teeth in prop::collection::vec((0usize..2, 0usize..90), 1..4),
            from in -1.2..-0.4f64, ratio in 1.0..2.5f64, points in 4usize..60,
        ) {
            let periods = pair([z1, z2], [z1, z2]);
            let gauges: Vec<(usize, Passage)> = teeth.iter().map(|(gear, tooth)| {
                let z = periods.teeth[*gear];
                (periods.of_tooth(gear + 1), Passage::of((from, from + ratio), tooth % z, z))
            }).collect();
            let lengths: Vec<usize> = gauges.iter().map(|(period, _)| *period).collect();
            let whole = whole_run(periods.contact(), &lengths);
            prop_assert!(lengths.iter().all(|period| *period <= whole.pitches));
            if let Some(run) = passage_run(&periods, &gauges, points, whole) {
                let printed: f64 = format!("{:.2}", run.start_deg.unwrap()).parse().unwrap();
                let start = printed * z1 as f64 / 360.0;
                for (period, passage) in &gauges {
                    let stretch = RunStretch { start, pitches: run.pitches, points };
                    prop_assert!(Coverage::of_tooth(*period, stretch, passage).has_extremes(), "{run} {passage:?}");
                }
            }
        }
    }
}
