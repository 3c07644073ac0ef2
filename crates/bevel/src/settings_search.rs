//! Machine settings that give a flank a place, a normal and a curvature at one point, or an ease-off over the whole
//! flank.

use nalgebra::{DMatrix, DVector, SMatrix, SVector};

use crate::assembly::{Assembly, AssemblyError};
use crate::blank::PairBlank;
use crate::contact_point::Mesh;
use crate::cut_surface::CutSurface;
use crate::ease_off::EaseOff;
use crate::error::BevelError;
use crate::flank::Flank;
use crate::hand::FlankSide;
use crate::local_synthesis::SynthesisTarget;
use crate::settings::{MachineSettings, Tool};

type Unknowns = SVector<f64, 7>;

/// Settings from the unknowns: radial distance, cradle angle, offset, work offset, ratio, and point radius; lengths in
/// `size`. The sliding
/// base follows the work offset, so that the depth of the root stays.
fn apply(start: &MachineSettings, x: &[f64], size: f64) -> MachineSettings {
    let mut s = *start;
    if let Tool::FaceMill(mill) = &mut s.tool {
        mill.radial_m += x[0] * size;
        mill.cradle_angle_rad += x[1];
        mill.point_radius_m += x[5] * size;
    }
    s.offset_m += x[2] * size;
    s.work_offset_m += x[3] * size;
    s.sliding_base_m -= x[3] * size * s.root_angle_rad.sin();
    if let Some(roll) = &mut s.roll {
        roll.ratio *= 1.0 + x[4];
    }
    s
}

/// Share of the way at most at once.
const FIRST_SHARE: f64 = 0.25;
/// Newton steps for one part of the way.
const MOST_STEPS: usize = 12;
/// Step of the differences by settings; residuals and unknowns are of the order of one.
const DIFFERENCE: f64 = 1e-6;

/// Settings of a pinion's flank that meet a target of local synthesis, from settings nearby (the basic ones). Seven
/// unknowns, the azimuth of the blade among
/// them, for place (2), normal (2) and curvature (3), at cradle turn 0.
///
/// # Errors
/// [`BevelError::Synthesis`] where the search ends without settings.
pub fn settings_for(
    blank: &PairBlank,
    side: FlankSide,
    start: &MachineSettings,
    target: &SynthesisTarget,
) -> Result<MachineSettings, BevelError> {
    let member = &blank.members[0];
    let size = blank.mean_cone_m;
    // The cradle's zero is where the mean point is cut.
    let mut start = *start;
    let mean = Flank::cut(member, side, &start)?.mean().at;
    if let Tool::FaceMill(mill) = &mut start.tool {
        mill.cradle_angle_rad += mean[1];
    }
    let wanted = target.normal;
    let t = wanted.cross(&nalgebra::Vector3::y()).normalize();
    let u = wanted.cross(&t);
    let residual = |x: &Unknowns| -> Option<Unknowns> {
        let settings = apply(&start, x.as_slice(), size);
        let p = CutSurface { settings, side }.flank(mean[0] + x[6], 0.0)?;
        let radius = p.r.x.hypot(p.r.y);
        let (s, c) = (-p.r.y / radius, p.r.x / radius);
        let turn = nalgebra::Matrix3::new(c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0);
        let n = turn * p.n;
        let k = turn * p.curvature() * turn.transpose() - target.curvature;
        let [cone, height] = member.cone_place(p.r.z, radius);
        let f = Unknowns::from([
            (cone - target.place_m[0]) / size,
            (height - target.place_m[1]) / size,
            n.dot(&t),
            n.dot(&u),
            t.dot(&(k * t)) * size,
            t.dot(&(k * u)) * size,
            u.dot(&(k * u)) * size,
        ]);
        f.iter().all(|v| v.is_finite()).then_some(f)
    };
    let lost = || BevelError::Synthesis {
        problem: format!(
            "no settings were found for the pinion's {} flank; ask for a shorter ellipse, a path nearer to the profile or another blade angle",
            side.word()
        ),
    };
    let mut x = Unknowns::zeros();
    let begin = residual(&x).ok_or_else(lost)?;
    let newton = |x: Unknowns, left: f64| newton(&residual, x, begin * left);
    let (mut done, mut share) = (0.0, FIRST_SHARE);
    while done < 1.0 {
        let goal: f64 = f64::min(done + share, 1.0);
        match newton(x, 1.0 - goal) {
            Some(next) => {
                x = next;
                done = goal;
                share *= 1.5;
            }
            None if share < 1e-3 => return Err(lost()),
            None => share *= 0.5,
        }
    }
    let found = apply(&start, x.as_slice(), size);
    match found.face_mill() {
        Some(mill) if mill.point_radius_m > 0.0 && mill.radial_m > 0.0 => Ok(found),
        _ => Err(lost()),
    }
}

/// Newton's method from unknowns nearby to those at which the residual is `wanted`; none where it does not get there.
fn newton(
    residual: &impl Fn(&Unknowns) -> Option<Unknowns>,
    mut x: Unknowns,
    wanted: Unknowns,
) -> Option<Unknowns> {
    let mut f = residual(&x)? - wanted;
    for _ in 0..MOST_STEPS {
        if f.norm() < 1e-12 {
            return Some(x);
        }
        let mut slopes = SMatrix::<f64, 7, 7>::zeros();
        for i in 0..7 {
            let beside = |step: f64| {
                let mut x = x;
                x[i] += step;
                residual(&x)
            };
            let difference = beside(DIFFERENCE)? - beside(-DIFFERENCE)?;
            slopes.set_column(i, &(difference / (2.0 * DIFFERENCE)));
        }
        let step = slopes.lu().solve(&f)?;
        if step.amax() > 0.5 {
            return None;
        }
        x -= step;
        let next = residual(&x)? - wanted;
        if next.norm() > 0.5 * f.norm() {
            return (next.norm() < 1e-10).then_some(x);
        }
        f = next;
    }
    None
}

/// An ease-off asked for: amounts at the ends of the flank \[m\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AskedEaseOff {
    /// At toe and heel.
    pub lengthwise_m: f64,
    /// At the tip and the working depth's lower end.
    pub profile_m: f64,
    /// Twist: at the tip of the heel, its negative at the tip of the toe.
    pub bias_m: f64,
}

impl AskedEaseOff {
    /// Value at a place of the pinion.
    pub fn at(&self, blank: &PairBlank, [cone, height]: [f64; 2]) -> f64 {
        let half = blank.outer_cone_m - blank.mean_cone_m;
        let [pinion, gear] = &blank.members;
        let u = (cone - blank.mean_cone_m) / half;
        let v = 2.0 * height
            / (pinion.addendum_m(blank.mean_cone_m) + gear.addendum_m(blank.mean_cone_m));
        self.lengthwise_m * u * u + self.profile_m * v * v + self.bias_m * u * v
    }
}

/// Places along the face and up the flank at which an ease-off is fitted.
const FIT: [usize; 2] = [7, 5];

/// Settings of a pinion's flank whose ease-off is nearest to an asked one (least squares over the flank), and the root
/// mean square of what is left \[m\]. Free are
/// radial distance, cradle angle, offset, work offset, ratio, point radius and modified roll c₂ and c₃.
///
/// # Errors
/// [`BevelError`] where the flanks do not meet.
pub fn settings_for_ease_off(
    blank: &PairBlank,
    gear: &Flank,
    start: &MachineSettings,
    asked: &AskedEaseOff,
) -> Result<(MachineSettings, f64), BevelError> {
    const N: usize = 8;
    let member = &blank.members[0];
    let side = gear.side.mate();
    let size = blank.mean_cone_m;
    let assembly = Assembly::new(blank, &AssemblyError::default());
    let settings = |x: &DVector<f64>| {
        let mut s = apply(start, x.as_slice(), size);
        if let Some(roll) = &mut s.roll {
            roll.modified[0] += x[6];
            roll.modified[1] += x[7];
        }
        s
    };
    let residual = |x: &DVector<f64>| -> Result<DVector<f64>, BevelError> {
        let flank = Flank::cut(member, side, &settings(x))?;
        let mesh = Mesh {
            flanks: [&flank, gear],
            assembly: &assembly,
        };
        let map: Vec<([f64; 2], EaseOff)> = mesh.ease_off_map(FIT[0], FIT[1])?;
        Ok(DVector::from_iterator(
            map.len(),
            map.iter()
                .map(|(place, e)| (e.gap_m - asked.at(blank, *place)) / size),
        ))
    };
    let mut x = DVector::zeros(N);
    let mut f = residual(&x)?;
    let mut damping = 1e-6;
    for _ in 0..40 {
        let mut slopes = DMatrix::zeros(f.len(), N);
        for i in 0..N {
            let beside = |step: f64| {
                let mut x = x.clone();
                x[i] += step;
                residual(&x)
            };
            let difference = beside(DIFFERENCE)? - beside(-DIFFERENCE)?;
            slopes.set_column(i, &(difference / (2.0 * DIFFERENCE)));
        }
        let gradient = slopes.transpose() * &f;
        let normal = slopes.transpose() * &slopes;
        // Levenberg and Marquardt: settings that do the same stay where they are.
        let mut better = false;
        for _ in 0..12 {
            let mut damped = normal.clone();
            for i in 0..N {
                damped[(i, i)] += damping * normal.trace() / N as f64;
            }
            let Some(step) = damped.cholesky().map(|c| c.solve(&gradient)) else {
                damping *= 10.0;
                continue;
            };
            let next = &x - step;
            match residual(&next) {
                Ok(g) if g.norm() < f.norm() => {
                    better = g.norm() < f.norm() * (1.0 - 1e-4);
                    (x, f) = (next, g);
                    damping *= 0.1;
                    break;
                }
                _ => damping *= 10.0,
            }
        }
        if !better {
            break;
        }
    }
    let rms = size * f.norm() / (f.len() as f64).sqrt();
    Ok((settings(&x), rms))
}
