//! Sections of a bevel gear's sector along the tooth: where their nodes lie.
//!
//! A section is the cone L = const, normal to the pitch cone; the one at the toe and the one at the heel are the ends
//! of the tooth. In a section a place is the azimuth χ and the height h above the pitch cone. The body below the ring
//! is `bevel_meridian.rs`. Nodes of all sections are numbered alike:
//!
//! ```text
//!            T---------T            h   tip
//!           /  tooth    \           tooth: rows of the outline × columns between the flanks
//!    A--r--P             P--r--A    P   where the fillet makes 45° with the centre line; the tooth stands on the cut P-P
//!    |     |\___________/|     |    A   middle of the tooth space, r lower end of the fillet
//!    |ring |             |     |    ring: a grid of rows × columns
//!    +-----Q-------------Q-----+    where the body begins
//! ```

use gearmesh_bevel::{BevelError, BevelGear, FlankSide, Located};
use gearmesh_geometry::Flank;
use std::f64::consts::{FRAC_PI_4, PI};

use crate::grading::{Pieces, graded};
use crate::plane::{apart, arc_lengths, coons, lerp};

/// Places at which the fillet is looked at.
const LOOKS: usize = 24;
/// Growth of element length per length.
const GROWTH: f64 = 0.3;
/// Depth of the ring below the roots, in mean modules, and at most this share of the rim.
const RING_IN_MODULES: f64 = 0.7;
const RING_SHARE: f64 = 0.6;
/// Length of the cut's tangents at its ends over its width.
const CUT_TANGENT: f64 = 0.7;

/// Right, left.
pub const SIDES: [Flank; 2] = [Flank::Right, Flank::Left];

/// Spacing of the nodes of all sections, as shares; with quadratic elements the middles of the sides are among them.
#[derive(Debug, Clone)]
pub struct Spacing {
    /// From the middle of the tooth space to the fillet's lower end, by length.
    pub bottom: Vec<f64>,
    /// On to P, by length.
    pub low: Vec<f64>,
    /// From P to the flank, by length.
    pub high: Vec<f64>,
    /// From the fillet to the tip, by height.
    pub flank: Vec<f64>,
    /// From flank to flank.
    pub across: Vec<f64>,
    /// From the outline down to the body.
    pub ring: Vec<f64>,
    /// Rows of the body: piece of the meridian's lines and share of it.
    pub body: Vec<(usize, f64)>,
    /// Sections from toe to heel.
    pub along: Vec<f64>,
}

/// One side of a tooth's outline in a section: (χ, h) from the fillet's lower end to the tip.
struct Side {
    /// To the flank; the P-th node is P.
    fillet: Vec<[f64; 2]>,
    flank: Vec<[f64; 2]>,
}

/// A section's nodes.
pub struct Level {
    /// Nodes (m), the ring's grid row by row, then the rows of the tooth above the cut.
    pub nodes: Vec<[f64; 3]>,
    /// Azimuths of the ring's columns where the body begins (rad).
    pub columns_rad: Vec<f64>,
    /// Outline from A to the tip, right and left: cone distance and height (m).
    pub outline_m: [Vec<[f64; 2]>; 2],
    /// The same as points (m).
    pub outline_points_m: [Vec<[f64; 3]>; 2],
}

/// Makes sections of a gear.
pub struct Levels<'a> {
    gear: &'a BevelGear,
    /// Spacing of the nodes.
    pub spacing: Spacing,
    /// Points of the meridian's lines, radius and z: from the ring to the bore, on the toe's and on the heel's side.
    pub(crate) meridian: Vec<[[f64; 2]; 2]>,
    ring_m: f64,
}

impl<'a> Levels<'a> {
    /// Settles the spacing in the middle of the face. `order`: 1, or 2 with nodes in the middles of sides.
    ///
    /// # Errors
    /// [`BevelError`] where the tool leaves no surface.
    pub fn new(gear: &'a BevelGear, order: usize) -> Result<Self, BevelError> {
        let (mesh, blank) = (&gear.mesh, gear.blank());
        let module = gear.mean_module_m();
        let ring_m = (RING_IN_MODULES * module).min(RING_SHARE * gear.body.rim_m);
        let ends = [blank.inner_cone_m(), blank.outer_cone_m];
        let at_ends = |depth: f64| {
            ends.map(|cone| {
                let [z, r] = blank.meridian_m(cone, -blank.dedendum_m(cone) - depth);
                [r, z]
            })
        };
        let mut meridian = vec![at_ends(ring_m), at_ends(gear.body.rim_m)];
        let contour = gear.body.contour.iter();
        meridian.extend(contour.map(|p| p.z_m.map(|z| [p.radius_m, z])));

        let middle = 0.5 * (ends[0] + ends[1]);
        let ([space, low, high, flank], half_width) = half_lengths_m(gear, middle)?;
        let fine = mesh.fillet_m;
        let low_shares = shares(low, &|_| fine, 3);
        let high_shares = shares(high, &|_| fine, 2);
        let last = |shares: &[f64], length: f64| length * (1.0 - shares[shares.len() - 2]);
        let begin = last(&high_shares, high);
        let flank_shares = shares(flank, &|s| (begin + GROWTH * s).min(mesh.flank_m), 4);
        let begin = low * low_shares[1];
        let bottom = space.max(0.1 * half_width);
        let bottom_shares = shares(
            bottom,
            &|s| (begin + GROWTH * (bottom - s)).min(mesh.flank_m),
            2,
        );
        let half: Vec<f64> = shares(
            half_width,
            &|s| (0.5 * fine + GROWTH * s).min(mesh.flank_m),
            3,
        );
        let mirrored = half.iter().rev().skip(1).map(|s| 1.0 - 0.5 * s);
        let across = half.iter().map(|s| 0.5 * s).chain(mirrored).collect();
        let ring = shares(ring_m, &|s| (fine + GROWTH * s).min(0.5 * mesh.body_m), 4);
        let mut body = Vec::new();
        for (piece, pair) in meridian.windows(2).enumerate() {
            let length = [0, 1].map(|k| apart(pair[0][k], pair[1][k]));
            let size = if piece == 0 { 0.6 } else { 1.0 } * mesh.body_m;
            let n = ((length[0].max(length[1]) / size).ceil() as usize).max(1) * order;
            body.extend((1..=n).map(|i| (piece, i as f64 / n as f64)));
        }
        let layers = ((blank.face_width_m / mesh.axial_m).round() as usize).max(2) * order;
        let along = (0..=layers).map(|i| i as f64 / layers as f64).collect();
        let spacing = Spacing {
            bottom: with_middles(bottom_shares, order),
            low: with_middles(low_shares, order),
            high: with_middles(high_shares, order),
            flank: with_middles(flank_shares, order),
            across: with_middles(across, order),
            ring: with_middles(ring, order),
            body,
            along,
        };
        Ok(Self {
            gear,
            spacing,
            meridian,
            ring_m,
        })
    }

    /// The same gear with outlines of so many pieces from P to the flank, and from there to the tip.
    #[must_use]
    pub fn with_pieces(&self, [high, flank]: [usize; 2]) -> Levels<'a> {
        let even = |n: usize| (0..=n).map(|k| k as f64 / n as f64).collect();
        let mut spacing = self.spacing.clone();
        (spacing.high, spacing.flank) = (even(high), even(flank));
        Levels {
            gear: self.gear,
            spacing,
            meridian: self.meridian.clone(),
            ring_m: self.ring_m,
        }
    }

    /// The same gear with an even number of elements along the tooth, one more than before if need be. `order` as in
    /// [`Self::new`].
    #[must_use]
    pub fn even_along(mut self, order: usize) -> Self {
        let layers = ((self.spacing.along.len() - 1) / order).next_multiple_of(2) * order;
        self.spacing.along = (0..=layers).map(|i| i as f64 / layers as f64).collect();
        self
    }

    /// Columns of the ring's grid, of which the tooth's cut takes the middle ones: (beside the cut, all).
    pub fn columns(&self) -> (usize, usize) {
        let s = &self.spacing;
        let beside = s.bottom.len() + s.low.len() - 2;
        (beside, 2 * beside + s.across.len() - 1)
    }

    /// The section at a share of the way from toe to heel; also a little beyond.
    ///
    /// # Errors
    /// [`BevelError`] where the tool leaves no surface.
    pub fn level(&self, along: f64) -> Result<Level, BevelError> {
        let (blank, s) = (self.gear.blank(), &self.spacing);
        let cone = blank.inner_cone_m() + blank.face_width_m * along;
        let half_pitch = PI / blank.teeth as f64;
        let sides = [self.side(SIDES[0], cone)?, self.side(SIDES[1], cone)?];
        let roots = [0, 1].map(|k| sides[k].fillet[0]);
        let middle = 0.5 * (roots[0][0] + roots[1][0]);
        let bottom_m = 0.5 * (roots[0][1] + roots[1][1]);
        let scale = blank.meridian_m(cone, 0.0)[1];
        // Plane coordinates: x along the circle, y the height.
        let plane = |p: [f64; 2]| [scale * (p[0] - middle), p[1]];

        // Outlines from A to the tip; the last node of `low` is P.
        let outlines: [Vec<[f64; 2]>; 2] = [0, 1].map(|k| {
            let sign = [-1.0, 1.0][k];
            let a = [sign * scale * half_pitch, bottom_m];
            let root = plane(roots[k]);
            let mut line: Vec<[f64; 2]> = s.bottom.iter().map(|w| lerp(a, root, *w)).collect();
            line.extend(sides[k].fillet[1..].iter().map(|p| plane(*p)));
            line.extend(sides[k].flank[1..].iter().map(|p| plane(*p)));
            line
        });
        let (beside, _) = self.columns();
        let foot = [0, 1].map(|k| outlines[k][beside]);
        let width = foot[1][0] - foot[0][0];
        let tangent = CUT_TANGENT * width * FRAC_PI_4.cos();
        let cut: Vec<[f64; 2]> = s
            .across
            .iter()
            .map(|t| hermite(foot, [[tangent, -tangent], [tangent, tangent]], *t))
            .collect();

        // The grid of the ring.
        let mut top: Vec<[f64; 2]> = outlines[0][..=beside].to_vec();
        top.extend(&cut[1..]);
        top.extend(outlines[1][..beside].iter().rev());
        let ring_bottom = -blank.dedendum_m(cone) - self.ring_m;
        let low = self.columns_below(&top, foot, scale * half_pitch);
        let place = |p: [f64; 2]| {
            let [z, r] = blank.meridian_m(cone, p[1]);
            polar(r, middle + p[0] / scale, z)
        };
        let mut nodes = Vec::new();
        for share in &s.ring {
            for (t, x) in top.iter().zip(&low) {
                nodes.push(place(lerp(*t, [*x, ring_bottom], *share)));
            }
        }
        let columns_rad = low.iter().map(|x| middle + x / scale).collect();

        // The tooth above the cut: Coons' patch between cut, outlines and tip.
        let tip = blank.addendum_m(cone);
        let rows = outlines[0].len() - beside;
        let ends = [0, 1].map(|k| outlines[k][outlines[k].len() - 1]);
        let shares = mean_shares(&outlines, beside);
        for i in 1..rows {
            let [r, l] = [0, 1].map(|k| outlines[k][beside + i]);
            let share = shares[i];
            for (t, below) in s.across.iter().zip(&cut) {
                let above = [ends[0][0] + t * (ends[1][0] - ends[0][0]), tip];
                let at = coons([r, l], [*below, above], [foot, ends], (share, *t));
                nodes.push(place(at));
            }
        }
        let points = |line: &Vec<[f64; 2]>| line.iter().map(|p| place(*p)).collect();
        let heights = |line: &Vec<[f64; 2]>| line.iter().map(|p| [cone, p[1]]).collect();
        Ok(Level {
            nodes,
            columns_rad,
            outline_m: [heights(&outlines[0]), heights(&outlines[1])],
            outline_points_m: [points(&outlines[0]), points(&outlines[1])],
        })
    }

    /// Where the columns of the ring's grid end below: even, those of the cut in its middle.
    fn columns_below(&self, top: &[[f64; 2]], foot: [[f64; 2]; 2], edge: f64) -> Vec<f64> {
        let (beside, columns) = self.columns();
        let q = [0, 1].map(|k| {
            let even = [-1.0, 1.0][k] * edge * (1.0 - 2.0 * beside as f64 / columns as f64);
            0.5 * (foot[k][0] + even)
        });
        let parts = |from: f64, to: f64, n: usize| {
            (0..n).map(move |i| from + (to - from) * i as f64 / n as f64)
        };
        let even = parts(-edge, q[0], beside)
            .chain(parts(q[0], q[1], columns - 2 * beside))
            .chain(parts(q[1], edge, beside))
            .chain([edge]);
        // Columns of a shallow ring may go aside by less.
        let share = (self.ring_m / (RING_IN_MODULES * self.gear.mean_module_m())).min(1.0);
        (top.iter().zip(even))
            .map(|(top, even)| top[0] + share * (even - top[0]))
            .collect()
    }

    /// One side of the outline.
    fn side(&self, side: Flank, cone: f64) -> Result<Side, BevelError> {
        let (gear, s) = (self.gear, &self.spacing);
        let looked = look(gear, side, cone)?;
        let p = looked.at_p;
        let end = looked.arcs[LOOKS];
        let low = s.low.iter().map(|w| w * p);
        let high = s.high[1..].iter().map(|w| p + w * (end - p));
        let mut shares: Vec<f64> = low.chain(high).map(|arc| looked.share(arc)).collect();
        shares.reverse();
        let flank_side = gear.flank_side(side);
        let flank = gear.tooth.flank(flank_side);
        let turn = gear.tooth.half_angle_rad(flank_side);
        let at = |found: &Located| {
            let r = found.point.r;
            let [_, height] = flank.place(&r);
            [turn + r.y.atan2(r.x), height]
        };
        let mut fillet: Vec<[f64; 2]> = flank.fillet_line(cone, &shares)?.iter().map(at).collect();
        fillet.reverse();
        let bottom = flank.bottom(cone)?;
        let [low, high] = [at(&bottom)[1], gear.blank().addendum_m(cone)];
        let mut here = bottom;
        let mut points = vec![at(&bottom)];
        for share in &s.flank[1..] {
            here = flank.locate_from(cone, low + share * (high - low), &here)?;
            points.push(at(&here));
        }
        Ok(Side {
            fillet,
            flank: points,
        })
    }
}

/// A fillet looked at: from its lower end upwards.
struct Looked {
    /// (χ, h).
    points: Vec<[f64; 2]>,
    /// Length from the lower end.
    arcs: Vec<f64>,
    /// Angle of the tangent with the tooth's centre line.
    angles: Vec<f64>,
    /// Length at P.
    at_p: f64,
}

impl Looked {
    /// Share of the fillet at a length.
    fn share(&self, arc: f64) -> f64 {
        let k = self.arcs.partition_point(|a| *a < arc).clamp(1, LOOKS);
        let w = (arc - self.arcs[k - 1]) / (self.arcs[k] - self.arcs[k - 1]);
        ((k - 1) as f64 + w) / LOOKS as f64
    }
}

fn look(gear: &BevelGear, side: Flank, cone: f64) -> Result<Looked, BevelError> {
    let flank_side: FlankSide = gear.flank_side(side);
    let flank = gear.tooth.flank(flank_side);
    let turn = gear.tooth.half_angle_rad(flank_side);
    let shares: Vec<f64> = (0..=LOOKS).rev().map(|k| k as f64 / LOOKS as f64).collect();
    let mut points: Vec<[f64; 2]> = flank
        .fillet_line(cone, &shares)?
        .iter()
        .map(|found| {
            let r = found.point.r;
            [turn + r.y.atan2(r.x), flank.place(&r)[1]]
        })
        .collect();
    points.reverse();
    let radius = |p: [f64; 2]| gear.blank().meridian_m(cone, p[1])[1];
    let mut arcs = vec![0.0];
    let mut pieces = Vec::new();
    for pair in points.windows(2) {
        let dx = 0.5 * (radius(pair[0]) + radius(pair[1])) * (pair[1][0] - pair[0][0]);
        let dy = pair[1][1] - pair[0][1];
        arcs.push(arcs[arcs.len() - 1] + dx.hypot(dy));
        pieces.push(dx.abs().atan2(dy));
    }
    let angles: Vec<f64> = (0..=LOOKS)
        .map(|k| match k {
            0 => 1.5 * pieces[0] - 0.5 * pieces[1],
            LOOKS => 1.5 * pieces[LOOKS - 1] - 0.5 * pieces[LOOKS - 2],
            _ => 0.5 * (pieces[k - 1] + pieces[k]),
        })
        .collect();
    // The tangent rises on its way up; P is kept off the ends.
    let at = (0..LOOKS).rfind(|&k| angles[k] >= FRAC_PI_4).unwrap_or(0);
    let w = ((angles[at] - FRAC_PI_4) / (angles[at] - angles[at + 1]).max(1e-9)).clamp(0.0, 1.0);
    let end = arcs[LOOKS];
    let at_p = (arcs[at] + w * (arcs[at + 1] - arcs[at])).clamp(0.15 * end, 0.85 * end);
    Ok(Looked {
        points,
        arcs,
        angles,
        at_p,
    })
}

/// Shares of a length at which its pieces begin and end.
fn shares(length: f64, size: &dyn Fn(f64) -> f64, least: usize) -> Vec<f64> {
    let places = graded(0.0, length, size, Pieces::at_least(least));
    places.into_iter().map(|s| s / length).collect()
}

/// In the section at a cone distance, the mean of both sides \[m\]: half the space, the fillet up to P, from there to
/// the flank, the flank; and half the width of the tooth at its root.
fn half_lengths_m(gear: &BevelGear, cone: f64) -> Result<([f64; 4], f64), BevelError> {
    let blank = gear.blank();
    let (mut lengths, mut half_width): ([f64; 4], f64) = ([0.0; 4], 0.0);
    let mut roots = [0.0; 2];
    for (k, side) in SIDES.into_iter().enumerate() {
        let looked = look(gear, side, cone)?;
        let radius = |p: [f64; 2]| blank.meridian_m(cone, p[1])[1];
        lengths[1] += 0.5 * looked.at_p;
        lengths[2] += 0.5 * (looked.arcs[LOOKS] - looked.at_p);
        let top = blank.addendum_m(cone) - looked.points[LOOKS][1];
        lengths[3] += 0.5 * top / looked.angles[LOOKS].cos();
        let root = looked.points[0];
        roots[k] = root[0] * radius(root);
        half_width += 0.5 * (root[0] * radius(root)).abs();
    }
    let pitch = 2.0 * PI / blank.teeth as f64;
    let at_root = blank.meridian_m(cone, -blank.dedendum_m(cone))[1];
    lengths[0] = 0.5 * (pitch * at_root - (roots[1] - roots[0]));
    Ok((lengths, half_width))
}

/// Shares of the way from P to the tip of the nodes of both outlines, in the mean.
fn mean_shares(outlines: &[Vec<[f64; 2]>; 2], first: usize) -> Vec<f64> {
    let n = outlines[0].len() - first;
    let mut mean = vec![0.0; n];
    for line in outlines {
        let arcs = arc_lengths(&line[first..]);
        for (sum, arc) in mean.iter_mut().zip(&arcs) {
            *sum += 0.5 * arc / arcs[n - 1];
        }
    }
    mean
}

/// The shares with `order − 1` more between each two.
fn with_middles(shares: Vec<f64>, order: usize) -> Vec<f64> {
    if order == 1 {
        return shares;
    }
    let mut all = vec![shares[0]];
    for pair in shares.windows(2) {
        all.extend([0.5 * (pair[0] + pair[1]), pair[1]]);
    }
    all
}

fn polar(r: f64, angle: f64, z: f64) -> [f64; 3] {
    let (sin, cos) = angle.sin_cos();
    [r * cos, r * sin, z]
}

/// Cubic between two points with their tangents.
fn hermite(ends: [[f64; 2]; 2], tangents: [[f64; 2]; 2], t: f64) -> [f64; 2] {
    let u = 1.0 - t;
    let weights = [
        u * u * (1.0 + 2.0 * t),
        t * t * (3.0 - 2.0 * t),
        t * u * u,
        -t * t * u,
    ];
    [0, 1].map(|k| {
        weights[0] * ends[0][k]
            + weights[1] * ends[1][k]
            + weights[2] * tangents[0][k]
            + weights[3] * tangents[1][k]
    })
}
