//! What the result of a bevel pair has beside that of other pairs: what presses where on both flanks, the figures of a
//! torque that this gives, strain at gauges.

use super::contact_places::ContactPlaces;
use super::result::{SceneResult, StrainSeries};
use crate::periods::{Coverage, Extent};
use gearmesh_contact::bevel_slices::spread_from_heel;
use gearmesh_geometry::Flank;
use gearmesh_model::{Fields, FileError, ReducedGear, ReducedGearError};
use gearmesh_recovery::{GaugeReader, LoadedSlice, Strain};
use std::f64::consts::PI;

/// A bevel pair as its result knows it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BevelRest {
    /// Numbers of teeth.
    pub teeth: [usize; 2],
    /// Side of the teeth that touches.
    pub side: Flank,
    /// Radius on the gear at which the transmission error counts \[m\].
    pub radius_2_m: f64,
    /// Face widths of pinion and gear \[m\]; the slices divide the pinion's.
    pub face_widths_m: [f64; 2],
    /// Length of both flanks from root to tip in the middle of the face \[m\].
    pub flank_heights_m: [f64; 2],
    /// Coefficient of friction of the teeth, where stated.
    pub friction: Option<f64>,
}

impl Default for BevelRest {
    fn default() -> Self {
        Self {
            teeth: [1; 2],
            side: Flank::Right,
            radius_2_m: 1.0,
            face_widths_m: [1.0; 2],
            flank_heights_m: [1.0; 2],
            friction: None,
        }
    }
}

impl BevelRest {
    /// Visits the parts of its group.
    ///
    /// # Errors
    /// [`FileError`] for a part that is missing or means nothing.
    pub(super) fn fields(&mut self, f: &mut Fields<'_>) -> Result<(), FileError> {
        for (name, teeth) in ["teeth_1", "teeth_2"].into_iter().zip(&mut self.teeth) {
            f.count(name, teeth, "teeth of the gear")?;
            if *teeth == 0 {
                return Err(f.contradiction(name, "it is 0, at least 1 is needed"));
            }
        }
        let mut name = self.side.name().to_owned();
        let what = "side of the teeth that touches: right or left";
        f.text("flank", &mut name, what)?;
        let side = Flank::ALL.into_iter().find(|side| side.name() == name);
        self.side = side.ok_or_else(|| f.contradiction("flank", "it is neither right nor left"))?;
        let what = "radius on gear 2 at which the transmission error counts";
        f.number("radius_2_m", &mut self.radius_2_m, "m", what)?;
        let what = "face widths; the slices divide that of gear 1";
        let (widths, gears) = (&mut self.face_widths_m, [("gear", 2)]);
        f.fixed("face_widths_m", widths, &gears, "m", what)?;
        let heights = &mut self.flank_heights_m;
        let what = "way up the flanks, root to tip at mid-face";
        f.fixed("flank_heights_m", heights, &gears, "m", what)?;
        let what = "coefficient of friction of the teeth, for the efficiency";
        f.optional_number("friction", &mut self.friction, "1", what)
    }

    /// Teeth of pinion and gear of a pair; those of pair 0 are 0.
    #[must_use]
    pub fn teeth_of(&self, pair: i64) -> [usize; 2] {
        // Wide enough to be turned round, whatever a file says.
        let on = i128::from(pair) * self.side.mirror() as i128;
        let [pinion, gear] = self.teeth.map(|teeth| teeth as i128);
        [
            on.rem_euclid(pinion) as usize,
            (-on).rem_euclid(gear) as usize,
        ]
    }
}

/// A slice that presses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pressing<'a> {
    /// Pair of teeth.
    pub pair: i64,
    /// Slice along the teeth.
    pub slice: usize,
    /// Normal force \[N\].
    pub force_n: f64,
    /// Peak pressure \[Pa\].
    pub pressure_pa: f64,
    at: usize,
    places: &'a ContactPlaces,
}

impl Pressing<'_> {
    /// Share of the way up the flank of gear 0 or 1.
    #[must_use]
    pub fn up(&self, gear: usize) -> f64 {
        [&self.places.roll_1_rad, &self.places.roll_2_rad][gear][self.at]
    }

    /// Place along the teeth of gear 0 or 1 from mid-face \[m\].
    #[must_use]
    pub fn along_m(&self, gear: usize) -> f64 {
        [&self.places.z_m, &self.places.z_2_m][gear][self.at]
    }

    /// Length along the line of contact \[m\].
    #[must_use]
    pub fn length_m(&self) -> f64 {
        self.places.width_m[self.at]
    }

    /// Half width of the contact by its peak pressure, 2 F/(π l p) \[m\].
    #[must_use]
    pub fn half_width_m(&self) -> f64 {
        2.0 * self.force_n / (PI * self.length_m() * self.pressure_pa)
    }

    /// Sliding speed of the flanks over the pinion's speed \[m/rad\].
    #[must_use]
    pub fn sliding_m(&self) -> f64 {
        self.places.sliding_m[self.at]
    }

    /// Whether the tip of either gear holds it.
    #[must_use]
    pub fn is_on_tip(&self) -> bool {
        (0..2).any(|gear| self.up(gear) >= 1.0)
    }

    /// Whether its whole width stands clear of the tips, where Hertz's pressure has the room that it asks for.
    #[must_use]
    pub fn is_inside(&self) -> bool {
        !self.is_on_tip() && self.places.to_tip_m[self.at] >= self.half_width_m()
    }
}

/// A position of a result whose places of contact are stored on both gears.
#[derive(Debug, Clone, Copy)]
pub struct PressedPosition<'a> {
    pairs: &'a [f64],
    forces_n: &'a [f64],
    pressures_pa: &'a [f64],
    places: &'a ContactPlaces,
    first: usize,
    slices: usize,
}

impl<'a> PressedPosition<'a> {
    /// What presses.
    pub fn pressing(self) -> impl Iterator<Item = Pressing<'a>> {
        let pressed = self
            .forces_n
            .iter()
            .enumerate()
            .filter(|(_, force)| **force > 0.0);
        pressed.map(move |(k, force)| Pressing {
            pair: self.pairs[k / self.slices] as i64,
            slice: k % self.slices,
            force_n: *force,
            pressure_pa: self.pressures_pa[k],
            at: self.first + k,
            places: self.places,
        })
    }

    /// Normal force of each pair of teeth that carries \[N\], the most loaded one first.
    #[must_use]
    pub fn pair_forces_n(self) -> Vec<(i64, f64)> {
        let lines = self
            .pairs
            .iter()
            .zip(self.forces_n.chunks_exact(self.slices));
        let lines = lines.map(|(pair, forces)| (*pair as i64, forces.iter().sum::<f64>()));
        let mut carrying: Vec<(i64, f64)> = lines.filter(|(_, force)| *force > 0.0).collect();
        carrying.sort_by(|a, b| b.1.total_cmp(&a.1));
        carrying
    }
}

impl SceneResult {
    /// A position of the even grid of a bevel pair; none of other pairs.
    #[must_use]
    pub fn even_position(&self, torque: usize, angle: usize) -> Option<PressedPosition<'_>> {
        self.bevel?;
        let block = self.lines.slots * self.lines.slices;
        let of_torque = (torque * self.angles() + angle) * block;
        Some(PressedPosition {
            pairs: &self.lines.pair[angle * self.lines.slots..][..self.lines.slots],
            forces_n: &self.lines.force_n[of_torque..][..block],
            pressures_pa: &self.lines.pressure_pa[of_torque..][..block],
            places: self.lines.places.as_ref()?,
            first: angle * block,
            slices: self.lines.slices,
        })
    }

    /// A position between the even ones of a bevel pair.
    #[must_use]
    pub fn position_between(&self, position: usize) -> Option<PressedPosition<'_>> {
        let it = &self.between;
        let block = it.slots * self.lines.slices;
        Some(PressedPosition {
            pairs: it.pair.get(position * it.slots..)?.get(..it.slots)?,
            forces_n: &it.force_n[position * block..][..block],
            pressures_pa: &it.pressure_pa[position * block..][..block],
            places: it.places.as_ref()?,
            first: position * block,
            slices: self.lines.slices,
        })
    }

    /// The positions of the even grid of a bevel pair under all torques.
    pub fn even_positions(&self) -> impl Iterator<Item = PressedPosition<'_>> {
        (0..self.torque_nm.len()).flat_map(|torque| self.even_positions_of(torque))
    }

    /// Those of a torque, over one pitch.
    pub fn even_positions_of(&self, torque: usize) -> impl Iterator<Item = PressedPosition<'_>> {
        (0..self.points_per_pitch()).filter_map(move |angle| self.even_position(torque, angle))
    }
}

/// Figures of a bevel pair under a torque, at the even positions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BevelFigures {
    /// Radius at which the transmission error counts \[m\].
    pub radius_2_m: f64,
    /// Share of the load that the most loaded pair of teeth carries, least and largest over the positions.
    pub best_pair_shares: [f64; 2],
    /// Pairs of teeth that carry, in the mean.
    pub mean_pairs: f64,
    /// Largest pressure where no tip holds, and of those patches whose whole width is clear of the tips \[Pa\].
    pub pressures_pa: [f64; 2],
    /// Part of the normal forces' sum that tips carry.
    pub tip_share: f64,
    /// Where the pattern begins and ends on the gear's flank, along the face and up the flank, as shares: of what
    /// presses with at least a hundredth of the largest pressure, whole slices counted.
    pub pattern: [[f64; 2]; 2],
    /// Share of the power that reaches the gear's shaft; none without a coefficient of friction.
    pub efficiency: Option<f64>,
}

impl BevelFigures {
    /// Of a torque of a bevel pair's result; none of other pairs.
    pub(super) fn of(result: &SceneResult, torque: usize) -> Option<Self> {
        let bevel = result.bevel?;
        let pressing = || result.even_positions_of(torque).flat_map(|p| p.pressing());
        let largest = |counts: fn(&Pressing<'_>) -> bool| {
            let pressures = pressing().filter(counts).map(|at| at.pressure_pa);
            pressures.fold(0.0, f64::max)
        };
        let sum = |counts: fn(&Pressing<'_>) -> bool| -> f64 {
            // A sum of nothing is -0.0.
            pressing().filter(counts).map(|at| at.force_n).sum::<f64>() + 0.0
        };
        let pairs: Vec<Vec<(i64, f64)>> = result
            .even_positions_of(torque)
            .map(|p| p.pair_forces_n())
            .collect();
        let shares = pairs.iter().map(|carrying| {
            let all: f64 = carrying.iter().map(|(_, force)| force).sum();
            carrying.first().map_or(1.0, |(_, first)| first / all)
        });
        let (mut along, mut up) = ([f64::INFINITY, 0.0], [f64::INFINITY, 0.0]);
        let least_pa = 0.01 * largest(|_| true);
        let half = 0.5 / result.lines.slices as f64;
        for at in pressing().filter(|at| at.pressure_pa >= least_pa) {
            let (s, v) = (at.along_m(1) / bevel.face_widths_m[1] + 0.5, at.up(1));
            along = [
                f64::min(along[0], (s - half).max(0.0)),
                f64::max(along[1], (s + half).min(1.0)),
            ];
            up = [f64::min(up[0], v), f64::max(up[1], v)];
        }
        Some(Self {
            radius_2_m: bevel.radius_2_m,
            best_pair_shares: [
                shares.clone().fold(f64::INFINITY, f64::min),
                shares.fold(0.0, f64::max),
            ],
            mean_pairs: pairs.iter().map(Vec::len).sum::<usize>() as f64 / pairs.len() as f64,
            pressures_pa: [largest(|at| !at.is_on_tip()), largest(|at| at.is_inside())],
            tip_share: sum(|at| at.is_on_tip()) / sum(|_| true),
            pattern: [along, up],
            efficiency: bevel
                .friction
                .map(|friction| bevel.efficiency(result, torque, friction)),
        })
    }
}

impl BevelRest {
    /// Share of the power that reaches the gear's shaft over the positions: at each 1/(1 + μ Σ F v/(T z₁/z₂)), F the
    /// normal forces and v their sliding for each radian of the pinion. Friction moves no load here.
    fn efficiency(&self, result: &SceneResult, torque: usize, friction: f64) -> f64 {
        let output = result.torque_nm[torque] * self.teeth[0] as f64 / self.teeth[1] as f64;
        let of = |position: PressedPosition<'_>| {
            let lost = position.pressing().map(|at| at.force_n * at.sliding_m());
            1.0 / (1.0 + friction * lost.sum::<f64>() / output)
        };
        let all: Vec<f64> = result.even_positions_of(torque).map(of).collect();
        all.iter().sum::<f64>() / all.len() as f64
    }
}

/// Strain of gauges (gear, index in its model) of a bevel pair's result. A gauge on another tooth than 0 is read as if
/// it were on tooth 0, which passes the mesh while the run goes on.
///
/// # Errors
/// [`ReducedGearError`] where a model carries no loads on the side that touches.
pub fn strain(
    models: [&ReducedGear; 2],
    result: &SceneResult,
    gauges: &[(usize, usize)],
) -> Result<Vec<StrainSeries>, ReducedGearError> {
    let bevel = result.bevel.unwrap_or_default();
    // The pitch that is solved stands in the middle of the run.
    let before = (result.pitches / 2) as i64;
    let one = |&(gear, index): &(usize, usize)| {
        let (member, model) = (gear - 1, models[gear - 1]);
        let rows = &model.gauges[index];
        let spread = spread_from_heel(model, bevel.face_widths_m[0], result.lines.slices);
        let reader = GaugeReader::new(model, rows, bevel.side, &spread)?;
        let read = |position: Option<PressedPosition<'_>>, later: i64| -> Strain {
            let pressing = position.into_iter().flat_map(PressedPosition::pressing);
            reader.read(pressing.map(|at| LoadedSlice {
                tooth: (bevel.teeth_of(at.pair + later)[member] + rows.tooth) % model.teeth,
                slice: at.slice,
                roll_rad: at.up(member),
                components: [1.0, 0.0],
                force_n: at.force_n,
            }))
        };
        let coverage = Coverage {
            extent: Extent::Passage,
            ..Coverage::of_contact(model.teeth, result.pitches)
        };
        Ok(StrainSeries::read(
            result,
            (gear, rows, coverage),
            |torque, angle| read(result.even_position(torque, angle), 0),
            |position, later| read(result.position_between(position), later as i64 - before),
        ))
    };
    gauges.iter().map(one).collect()
}
