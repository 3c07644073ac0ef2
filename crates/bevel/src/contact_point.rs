//! Where two flanks, or an edge and a flank, touch at a turn of the pinion: Newton's method on place and normal.

use nalgebra::{Matrix5, Vector3, Vector5};

use crate::assembly::Assembly;
use crate::cut_surface::SurfacePoint;
use crate::flank::Flank;

/// A pair of flanks in an assembly: pinion, gear.
#[derive(Debug, Clone, Copy)]
pub struct Mesh<'a> {
    /// Flanks of the pinion and of the gear.
    pub flanks: [&'a Flank; 2],
    /// Where the members stand.
    pub assembly: &'a Assembly,
}

/// A contact: parameters on both flanks and the gear's turn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Touch {
    /// Parameters on the pinion's and the gear's flank.
    pub at: [[f64; 2]; 2],
    /// Turn of the pinion \[rad\].
    pub pinion_turn_rad: f64,
    /// Turn of the gear \[rad\].
    pub gear_turn_rad: f64,
    /// Both flanks' points in the fixed frame.
    pub points: [SurfacePoint; 2],
}

/// The line on which an edge of a flank lies, by L and h: cone·L + height·h = offset.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgeLine {
    /// Member with the edge: 0 pinion, 1 gear.
    pub member: usize,
    cone: f64,
    height: f64,
    offset_m: f64,
}

/// Edges of a flank.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EdgeKind {
    /// Tip.
    Tip,
    /// Small end.
    Toe,
    /// Large end.
    Heel,
}

impl EdgeKind {
    /// All.
    pub const ALL: [Self; 3] = [Self::Tip, Self::Toe, Self::Heel];

    /// In words.
    pub fn word(self) -> &'static str {
        match self {
            Self::Tip => "tip",
            Self::Toe => "toe",
            Self::Heel => "heel",
        }
    }
}

/// What touches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ContactKind {
    /// Both flanks inside their limits.
    Flanks,
    /// An edge of a member, 0 the pinion, on the other's flank.
    Edge {
        /// Member with the edge.
        member: usize,
        /// Edge.
        edge: EdgeKind,
    },
    /// The end of a member's tip edge on the other's flank.
    Corner {
        /// Member with the corner.
        member: usize,
        /// Toe or heel.
        end: EdgeKind,
    },
    /// An edge across an edge.
    Crossing {
        /// Edge of the pinion.
        pinion: EdgeKind,
        /// Edge of the gear.
        gear: EdgeKind,
    },
    /// Where a member's flank ends above its fillet: the mate reaches into the fillet.
    LowerEnd {
        /// Member with the fillet.
        member: usize,
    },
}

impl ContactKind {
    /// In words.
    pub fn words(self) -> String {
        let name = |member: usize| ["pinion", "gear"][member];
        match self {
            Self::Flanks => "flanks".to_owned(),
            Self::Edge { member, edge } => format!("{} {}", name(member), edge.word()),
            Self::Corner { member, end } => format!("{} tip at {}", name(member), end.word()),
            Self::Crossing { pinion, gear } => {
                format!("pinion {} across gear {}", pinion.word(), gear.word())
            }
            Self::LowerEnd { member } => format!("{} fillet", name(member)),
        }
    }
}

impl EdgeLine {
    /// An edge of a flank of member 0 or 1.
    pub fn of(flank: &Flank, member: usize, kind: EdgeKind) -> Self {
        let blank = &flank.blank;
        let (cone, height, offset_m) = match kind {
            EdgeKind::Toe => (1.0, 0.0, blank.inner_cone_m()),
            EdgeKind::Heel => (1.0, 0.0, blank.outer_cone_m),
            // h = a_e − (R_e − L) tan θ_a.
            EdgeKind::Tip => {
                let slope = blank.addendum_angle_rad().tan();
                (
                    -slope,
                    1.0,
                    blank.outer_addendum_m - blank.outer_cone_m * slope,
                )
            }
        };
        Self {
            member,
            cone,
            height,
            offset_m,
        }
    }

    /// The two lines of a member that cross at a place L, h.
    pub fn through(member: usize, [cone_m, height_m]: [f64; 2]) -> [Self; 2] {
        let line = |cone, height, offset_m| Self {
            member,
            cone,
            height,
            offset_m,
        };
        [line(1.0, 0.0, cone_m), line(0.0, 1.0, height_m)]
    }

    /// Value of the line's equation, its gradient and second derivatives by the flank's parameters.
    fn equation(&self, flank: &Flank, p: &SurfacePoint) -> LineEquation {
        // L and h are linear in z and the radius.
        let by_z = flank.blank.cone_place(1.0, 0.0);
        let by_radius = flank.blank.cone_place(0.0, 1.0);
        let z = self.cone * by_z[0] + self.height * by_z[1];
        let rho = self.cone * by_radius[0] + self.height * by_radius[1];
        let flat = |v: &Vector3<f64>| Vector3::new(v.x, v.y, 0.0);
        let r = flat(&p.r);
        let radius = r.norm();
        let first = p.dr.map(|d| r.dot(&d) / radius);
        let second = |i: usize, j: usize| {
            (flat(&p.dr[i]).dot(&flat(&p.dr[j])) + r.dot(&p.ddr[i + j]) - first[i] * first[j])
                / radius
        };
        (
            z * p.r.z + rho * radius - self.offset_m,
            [0, 1].map(|i| z * p.dr[i].z + rho * first[i]),
            [(0, 0), (0, 1), (1, 1)].map(|(i, j)| z * p.ddr[i + j].z + rho * second(i, j)),
        )
    }
}

/// Newton steps at most.
const MOST_STEPS: usize = 30;

/// The two equations beside r₁ = r₂.
enum Meeting {
    /// The normals are opposite.
    Faces,
    /// A point of an edge, whose tangent lies in the mate's tangent plane.
    Edge(EdgeLine),
    /// Points of both lines.
    Lines([EdgeLine; 2]),
}

/// Newton's equations for the parameters on both flanks and the gear's turn.
struct System {
    residual: Vector5<f64>,
    slopes: Matrix5<f64>,
}

/// Value of a line's equation, its gradient and second derivatives.
type LineEquation = (f64, [f64; 2], [f64; 3]);

impl System {
    /// Rows 0 to 2: both points are one. `arm`: change of the gear's point by its turn.
    fn coincide(p: &[SurfacePoint; 2], arm: &Vector3<f64>, size: f64) -> Self {
        let gap = (p[0].r - p[1].r) / size;
        let mut residual = Vector5::zeros();
        let mut slopes = Matrix5::zeros();
        for i in 0..3 {
            residual[i] = gap[i];
            for k in 0..2 {
                slopes[(i, k)] = p[0].dr[k][i] / size;
                slopes[(i, 2 + k)] = -p[1].dr[k][i] / size;
            }
            slopes[(i, 4)] = -arm[i] / size;
        }
        Self { residual, slopes }
    }

    /// Rows 3 and 4: the normals are opposite. Tangents are held for the step.
    fn oppose_normals(&mut self, p: &[SurfacePoint; 2], axis: Vector3<f64>) {
        let tangents = p[0].tangents(&p[0].dr[0]);
        let turned = axis.cross(&p[1].n);
        for (row, t) in tangents.iter().enumerate() {
            self.residual[3 + row] = t.dot(&(p[0].n + p[1].n));
            for k in 0..2 {
                self.slopes[(3 + row, k)] = t.dot(&p[0].dn[k]);
                self.slopes[(3 + row, 2 + k)] = t.dot(&p[1].dn[k]);
            }
            self.slopes[(3 + row, 4)] = t.dot(&turned);
        }
    }

    /// One row: the member's point lies on the line.
    fn stay_on(&mut self, line: &EdgeLine, (value, c, _): LineEquation, row: usize, size: f64) {
        self.residual[row] = value / size;
        for (k, slope) in c.iter().enumerate() {
            self.slopes[(row, 2 * line.member + k)] = slope / size;
        }
    }

    /// Row 4: the tangent of member `m`'s edge, r_a c_b − r_b c_a, is across the other's normal.
    fn touch_edge(
        &mut self,
        m: usize,
        (_, c, cc): LineEquation,
        p: &[SurfacePoint; 2],
        axis: Vector3<f64>,
    ) {
        let (e, n) = (&p[m], &p[1 - m]);
        let tangent = e.dr[0] * c[1] - e.dr[1] * c[0];
        let scale = 1.0 / tangent.norm();
        self.residual[4] = tangent.dot(&n.n) * scale;
        for k in 0..2 {
            let change =
                e.ddr[k] * c[1] + e.dr[0] * cc[1 + k] - e.ddr[1 + k] * c[0] - e.dr[1] * cc[k];
            self.slopes[(4, 2 * m + k)] = change.dot(&n.n) * scale;
            self.slopes[(4, 2 * (1 - m) + k)] = tangent.dot(&n.dn[k]) * scale;
        }
        let turned = match m {
            0 => tangent.dot(&axis.cross(&n.n)),
            _ => axis.cross(&tangent).dot(&n.n),
        };
        self.slopes[(4, 4)] = turned * scale;
    }
}

impl Mesh<'_> {
    fn points(&self, at: &[[f64; 2]; 2]) -> Option<[SurfacePoint; 2]> {
        Some([self.flanks[0].point(at[0])?, self.flanks[1].point(at[1])?])
    }

    /// Relative speed along the normal at a point of the gear that touches, with the teeth's ratio of speeds: n·v₁₂
    /// over the pinion's speed and the mean cone distance.
    pub(crate) fn slip(&self, p: &SurfacePoint) -> f64 {
        let [m1, m2] = &self.assembly.members;
        let v = m1.axis().cross(&(p.r - m1.apex_m))
            + m2.axis().cross(&(p.r - m2.apex_m)) * self.assembly.ratio;
        p.n.dot(&v) / self.flanks[0].blank.mean_cone_m
    }

    /// Contact of both surfaces, also beyond the blanks' limits, from a contact nearby. None where Newton finds none.
    pub fn touch(&self, pinion_turn: f64, start: &Touch) -> Option<Touch> {
        self.solve(pinion_turn, start, &Meeting::Faces)
    }

    /// Contact of an edge with the other member's surface.
    pub fn edge_touch(&self, pinion_turn: f64, edge: &EdgeLine, start: &Touch) -> Option<Touch> {
        self.solve(pinion_turn, start, &Meeting::Edge(*edge))
    }

    /// Contact of the points that two lines fix: an edge of each member, or two lines of one member that meet in a
    /// point of its flank.
    pub fn lines_touch(
        &self,
        pinion_turn: f64,
        lines: [EdgeLine; 2],
        start: &Touch,
    ) -> Option<Touch> {
        self.solve(pinion_turn, start, &Meeting::Lines(lines))
    }

    fn solve(&self, pinion_turn: f64, start: &Touch, meeting: &Meeting) -> Option<Touch> {
        let size = self.flanks[0].blank.mean_cone_m;
        let [pinion, gear] = &self.assembly.members;
        let axis = gear.axis();
        let mut at = start.at;
        let mut turn = start.gear_turn_rad;
        let mut last = f64::INFINITY;
        for _ in 0..MOST_STEPS {
            let own = self.points(&at)?;
            let p = [
                pinion.placed(&own[0], pinion_turn),
                gear.placed(&own[1], turn),
            ];
            let arm = axis.cross(&(p[1].r - gear.apex_m));
            let mut system = System::coincide(&p, &arm, size);
            match meeting {
                Meeting::Faces => system.oppose_normals(&p, axis),
                Meeting::Lines(lines) => {
                    for (row, line) in lines.iter().enumerate() {
                        system.stay_on(
                            line,
                            line.equation(self.flanks[line.member], &own[line.member]),
                            3 + row,
                            size,
                        );
                    }
                }
                Meeting::Edge(line) => {
                    let equation = line.equation(self.flanks[line.member], &own[line.member]);
                    system.stay_on(line, equation, 3, size);
                    system.touch_edge(line.member, equation, &p, axis);
                }
            }
            let System { residual, slopes } = system;
            let error = residual.norm();
            if error < 1e-13 || (error < 1e-10 && error >= 0.5 * last) {
                if p[0].n.dot(&p[1].n) > 0.0 && matches!(meeting, Meeting::Faces) {
                    return None;
                }
                return Some(Touch {
                    at,
                    pinion_turn_rad: pinion_turn,
                    gear_turn_rad: turn,
                    points: p,
                });
            }
            last = error;
            let mut step = slopes.lu().solve(&residual)?;
            // Parameters and turns are of the order of one; a step far beyond the flank is cut.
            let most = step.amax();
            if !most.is_finite() {
                return None;
            }
            if most > 0.2 {
                step *= 0.2 / most;
            }
            for k in 0..2 {
                at[0][k] -= step[k];
                at[1][k] -= step[2 + k];
            }
            turn -= step[4];
        }
        None
    }
}
