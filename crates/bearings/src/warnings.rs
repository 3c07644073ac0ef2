//! What strains a bearing, or the theory by which it is judged: each warning has its figure and its limit.
//!
//! | concern | figure | limit | source |
//! | --- | --- | --- | --- |
//! | static safety | s₀ = C₀/P₀ | 1 for balls, 1.5 for rollers | ISO 76, guide values for normal operation |
//! | pressure | largest peak pressure | 4200 MPa for balls, 4000 MPa for rollers | ISO 76, what C₀ stands for |
//! | shoulder | height of the contact ellipse's end in the groove | the shoulder's | `shoulder.rs` |
//! | dropped balls | balls that carry at rest, and at speed on the outer ring alone | 0 | `speed_up.rs` |
//! | minimum load | P_ref of ISO/TS 16281 at speed | 0.01 C for balls, 0.02 C for rollers | SKF's rule of thumb; guidance |
//! | speed | n d_m | 500 000 mm/min for balls, cylindrical rollers 450 000, tapered 350 000 | SKF's catalogue, grease at light loads; guidance |
//! | load of the life | P_ref | 0.5 C | ISO 281 |
//! | displacement | way of the ring beyond its play | a tenth of an element's diameter | contacts are small against the bodies (Hertz) |
//! | moment | that which the rings exert | C₀ at half the larger of pitch diameter and distance of the rows | no row carries more than C₀ |
//! | laminae | their number | 30 | ISO/TS 16281 |

use std::f64::consts::PI;
use std::fmt;

use crate::definition::{BallBearingKind, BearingDefinition, BearingGeometry, Preload};
use crate::life::Life;
use crate::operation::Operation;
use crate::quasi_static::{QuasiStaticBearing, RowLoads};
use crate::ratings::Ratings;
use crate::ring_equilibrium::{AppliedBearingLoad, TiltCondition};
use crate::ring_load::RingLoad;
use crate::ring_pose::RingPose;
use crate::static_safety::StaticSafety;

/// What a warning is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Concern {
    /// Dents in the races.
    StaticSafety,
    /// Steel that yields.
    Pressure,
    /// A contact ellipse that is cut off.
    Shoulder,
    /// Balls that centrifugal forces have pressed beyond the end of the inner groove.
    DroppedBalls,
    /// Balls or rollers that may skid.
    MinimumLoad,
    /// Lubrication that the speed asks for.
    Speed,
    /// A load beyond the formulas of the life.
    LifeLoad,
    /// Rings that move as no bearing does.
    Displacement,
    /// A moment that no bearing carries.
    Moment,
    /// Too few laminae.
    Laminae,
}

impl Concern {
    /// Its name in JSON.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::StaticSafety => "static-safety",
            Self::Pressure => "pressure",
            Self::Shoulder => "shoulder",
            Self::DroppedBalls => "dropped-balls",
            Self::MinimumLoad => "minimum-load",
            Self::Speed => "speed",
            Self::LifeLoad => "life-load",
            Self::Displacement => "displacement",
            Self::Moment => "moment",
            Self::Laminae => "laminae",
        }
    }

    /// Whether the figure should be less than the limit.
    fn is_upper(self) -> bool {
        !matches!(self, Self::StaticSafety | Self::MinimumLoad | Self::Laminae)
    }
}

/// A figure beyond its limit.
#[derive(Debug, Clone, PartialEq)]
pub struct BearingWarning {
    /// What it is about.
    pub concern: Concern,
    /// The figure, in the unit of the sentence.
    pub value: f64,
    /// Its limit, alike.
    pub limit: f64,
    /// A sentence with both and the limit's source.
    pub text: String,
}

impl fmt::Display for BearingWarning {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        to.write_str(&self.text)
    }
}

impl BearingWarning {
    /// How far the figure is beyond the limit: their ratio, above 1; of a limit of zero the figure and 1.
    #[must_use]
    pub fn excess(&self) -> f64 {
        if self.limit == 0.0 {
            self.value + 1.0
        } else if self.concern.is_upper() {
            self.value / self.limit
        } else {
            self.limit / self.value
        }
    }
}

/// A bearing in equilibrium, as it is looked at.
#[derive(Debug, Clone, Copy)]
pub struct Judged<'a> {
    /// What it is.
    pub definition: &'a BearingDefinition,
    /// The same, evaluated.
    pub bearing: &'a QuasiStaticBearing,
    /// Where its inner ring stands.
    pub pose: &'a RingPose,
    /// Load of its elements on the inner ring.
    pub ring: &'a RingLoad,
    /// Loads of its balls or rollers.
    pub loads: &'a RowLoads,
    /// Force on its inner ring \[N\].
    pub force_n: [f64; 3],
    /// Speeds.
    pub operation: &'a Operation,
    /// Its life under these.
    pub life: &'a Life,
}

/// Collects the warnings whose figures are beyond their limits.
#[derive(Default)]
struct Found(Vec<BearingWarning>);

impl Found {
    fn check(&mut self, concern: Concern, value: f64, limit: f64, text: impl FnOnce() -> String) {
        let beyond = if concern.is_upper() {
            value > limit
        } else {
            value < limit
        };
        if beyond {
            self.0.push(BearingWarning {
                concern,
                value,
                limit,
                text: text(),
            });
        }
    }
}

impl Judged<'_> {
    /// All warnings; empty for a bearing within its limits.
    #[must_use]
    pub fn warnings(&self) -> Vec<BearingWarning> {
        let mut found = Found::default();
        self.static_safety(&mut found);
        self.pressure(&mut found);
        self.shoulders(&mut found);
        self.dropped_balls(&mut found);
        self.least_and_most_load(&mut found);
        self.nonsense(&mut found);
        self.speed(&mut found);
        if let BearingGeometry::Roller(g) = &self.definition.geometry {
            let laminae = g.laminae;
            found.check(Concern::Laminae, laminae as f64, 30.0, || {
                format!("laminae: {laminae}, ISO/TS 16281 asks for 30 at least; lives depend on their number")
            });
        }
        found.0
    }

    fn of_rollers(&self) -> bool {
        matches!(self.definition.geometry, BearingGeometry::Roller(_))
    }

    fn elements(&self) -> &'static str {
        if self.of_rollers() {
            "rollers"
        } else {
            "balls"
        }
    }

    fn static_safety(&self, found: &mut Found) {
        let ratings = Ratings::of(self.definition);
        let Some(safety) = StaticSafety::of(self.definition, &ratings, self.force_n) else {
            return;
        };
        let limit = if self.of_rollers() { 1.5 } else { 1.0 };
        found.check(Concern::StaticSafety, safety.factor, limit, || {
            format!(
                "static safety: s0 = C0/P0 = {:.2} (P0 {:.0} N) is less than {limit}, the guide value of ISO 76 for {} in normal operation: races keep dents",
                safety.factor,
                safety.equivalent_n,
                self.elements()
            )
        });
    }

    fn pressure(&self, found: &mut Found) {
        let mut most = (0.0, "");
        for (row, elements) in self.bearing.rows.iter().zip(&self.loads.elements) {
            for element in elements {
                let [inner, outer] = row.peak_pressures_pa(element);
                for (pressure, race) in [(inner, "inner"), (outer, "outer")] {
                    if pressure > most.0 {
                        most = (pressure, race);
                    }
                }
            }
        }
        let limit = if self.of_rollers() { 4000.0 } else { 4200.0 };
        let (value, race) = (1e-6 * most.0, most.1);
        found.check(Concern::Pressure, value, limit, || {
            format!(
                "pressure: {value:.0} MPa at the {race} race is more than {limit} MPa, to which ISO 76 rates {} at rest: steel yields, which Hertz's theory does not know",
                self.elements()
            )
        });
    }

    fn shoulders(&self, found: &mut Found) {
        let BearingGeometry::Ball(g) = &self.definition.geometry else {
            return;
        };
        if g.kind == BallBearingKind::Thrust {
            return;
        }
        let mut highest = [0.0_f64; 2];
        for (row, elements) in self.bearing.rows.iter().zip(&self.loads.elements) {
            for element in elements {
                let ellipses = row.ellipses(element);
                let halves = ellipses.map(|ellipse| ellipse.map_or(0.0, |e| e.half_length_m));
                let angles = [
                    element.inner_contact_angle_rad,
                    element.outer_contact_angle_rad,
                ];
                let heights = g.ellipse_heights_m(angles, halves);
                for (most, height) in highest.iter_mut().zip(heights) {
                    *most = most.max(height);
                }
            }
        }
        let origin = if g.stated_shoulder_heights_m.is_some() {
            "as stated"
        } else {
            "an estimate; state shoulder_heights_mm"
        };
        let sides = highest.into_iter().zip(g.shoulder_heights_m());
        for ((height, shoulder), race) in sides.zip(["inner", "outer"]) {
            let (value, limit) = (1e3 * height, 1e3 * shoulder);
            found.check(Concern::Shoulder, value, limit, || {
                format!(
                    "shoulder: the contact ellipse reaches {value:.3} mm up the {race} groove, whose shoulder ends at {limit:.3} mm ({origin}): the ellipse is cut off, \
                     pressure rises at the edge"
                )
            });
        }
    }

    fn dropped_balls(&self, found: &mut Found) {
        let balls = || self.loads.elements.iter().flatten();
        if !balls().any(|ball| ball.beyond_inner_groove) {
            return;
        }
        // A ball beside the load's zone is loose at rest, too.
        let tilt = self.pose.to_five();
        let load = AppliedBearingLoad {
            force_n: self.force_n,
            tilt: TiltCondition::Held([tilt[3], tilt[4]]),
        };
        let at_rest = self.operation.at_rest();
        let resting = (self.bearing.equilibrium(&load, &at_rest))
            .and_then(|pose| self.bearing.loads(&pose, &at_rest));
        let Ok((_, resting)) = resting else {
            return;
        };
        let beyond = || {
            let all = balls().zip(resting.elements.iter().flatten());
            all.filter(|(ball, resting)| ball.beyond_inner_groove && resting.inner_load_n > 0.0)
        };
        let dropped = beyond().filter(|(ball, _)| ball.has_dropped()).count();
        let (count, of) = (beyond().count(), balls().count());
        found.check(Concern::DroppedBalls, count as f64, 0.0, || {
            format!(
                "dropped balls: {count} of {of} that carry at rest lie beyond the end of the inner groove ({dropped} on the outer ring alone, the others on the edge there): \
                 centrifugal forces press them to the bottom of the outer groove, and a real ring's shoulder ends before. Give more axial load or preload, or a lower speed"
            )
        });
    }

    fn least_and_most_load(&self, found: &mut Found) {
        let c = Ratings::of(self.definition).dynamic_n;
        let load = self.life.reference_equivalent_n;
        let share = if self.of_rollers() { 0.02 } else { 0.01 };
        if self.operation.is_turning() {
            found.check(Concern::MinimumLoad, load, share * c, || {
                format!(
                    "minimum load: P_ref {load:.1} N is less than {share} C = {:.1} N, below which {} may skid (a rule of thumb in SKF's catalogue, guidance)",
                    share * c,
                    self.elements()
                )
            });
        }
        found.check(Concern::LifeLoad, load, 0.5 * c, || {
            format!(
                "life: P_ref {load:.0} N is more than 0.5 C = {:.0} N, up to which the formulas of ISO 281 hold",
                0.5 * c
            )
        });
    }

    /// Displacements and moments that speak of a slip of units or of another bearing.
    fn nonsense(&self, found: &mut Found) {
        let (diameter_m, pitch_m, play_m) = match &self.definition.geometry {
            BearingGeometry::Ball(g) => {
                let distance_m = g.groove_distance_m();
                let radial_m = g.radial_clearance_m().max(0.0);
                // Play along the axis of a deep groove: 2A sin α₀ from one side to the other.
                let axial_m = match g.kind {
                    BallBearingKind::AngularContact | BallBearingKind::Thrust => 0.0,
                    _ => {
                        2.0 * distance_m
                            * (1.0 - (1.0 - 0.5 * radial_m / distance_m).powi(2))
                                .max(0.0)
                                .sqrt()
                    }
                };
                (g.ball_diameter_m, g.pitch_diameter_m, radial_m.max(axial_m))
            }
            BearingGeometry::Roller(g) => (
                g.diameter_m,
                g.pitch_diameter_m,
                g.radial_clearance_m.max(0.0),
            ),
        };
        let play_m = match self.definition.preload {
            Preload::Displacement(shift_m) => play_m.max(-shift_m),
            _ => play_m,
        };
        let (value, limit) = (
            1e3 * (self.pose.centre_m.norm() - play_m),
            100.0 * diameter_m,
        );
        found.check(Concern::Displacement, value, limit, || {
            format!(
                "displacement: the inner ring moves by {value:.2} mm beyond its play, more than {limit:.2} mm, a tenth of the {}' diameter: contacts are no longer small, as Hertz's theory wants them; check the units of load and sizes",
                self.elements()
            )
        });
        let distance_m = self
            .definition
            .arrangement
            .rows()
            .iter()
            .fold(0.0, |most: f64, row| most.max(2.0 * row.0.abs()));
        let [x, y] = [self.ring.load[3], self.ring.load[4]];
        let ratings = Ratings::of(self.definition);
        let (value, limit) = (x.hypot(y), 0.5 * ratings.static_n * pitch_m.max(distance_m));
        found.check(Concern::Moment, value, limit, || {
            format!(
                "moment: the rings exert {value:.0} N m on each other, more than {limit:.0} N m, what C0 makes at half the pitch diameter or distance of the rows: no bearing of this size carries it; check the tilt and its unit"
            )
        });
    }

    fn speed(&self, found: &mut Found) {
        let (pitch_m, limit) = match &self.definition.geometry {
            BearingGeometry::Ball(g) => (g.pitch_diameter_m, 500_000.0),
            BearingGeometry::Roller(g) if g.taper.is_some() || g.barrel.is_some() => {
                (g.pitch_diameter_m, 350_000.0)
            }
            BearingGeometry::Roller(g) => (g.pitch_diameter_m, 450_000.0),
        };
        let rad_per_s = (self.operation.inner_rad_per_s - self.operation.outer_rad_per_s).abs();
        let value = rad_per_s * 30.0 / PI * 1e3 * pitch_m;
        found.check(Concern::Speed, value, limit, || {
            format!(
                "speed: n d_m = {value:.0} mm/min is more than {limit}, to which SKF's catalogue recommends grease under light loads (guidance; oil and precision bearings go further)"
            )
        });
    }
}
