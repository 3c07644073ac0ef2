//! The cut below the tooth-only submodel.

use crate::tooth_blocks::ToothBlocks;
use crate::tooth_cell::ToothCell;
use gearmesh_geometry::GearDefinition;

/// The cut below the tooth-only submodel, a broken line from the right to the left outline of a tooth centred on +x.
#[derive(Debug, Clone, PartialEq)]
pub struct CutLine {
    /// \[x, y\] \[m\].
    pub points_m: Vec<[f64; 2]>,
    /// Arc length of its ends from the centre of the tooth space on their side \[m\].
    pub arc_m: f64,
}

impl CutLine {
    /// Where the tooth of a definition is cut, by its element lengths along the outline; needs no mesh.
    pub fn new(gear: &GearDefinition) -> Self {
        let blocks = ToothBlocks::new(gear);
        let points = &blocks.problem.points;
        let point = |n: usize| [points[n][0], points[n][1]];
        Self {
            points_m: blocks.cut.iter().map(|&n| point(n)).collect(),
            arc_m: arc_at(&blocks.outline, &blocks.outline_arc_m, blocks.cut.first()),
        }
    }

    /// Whether a point of the section \[x, y\] \[m\] lies below the cut, on it, or no more than `margin_m` above it,
    /// radially; so do all points beside it.
    pub fn is_below(&self, [x, y]: [f64; 2], margin_m: f64) -> bool {
        // The line runs counter-clockwise; the ray from the axis through the point meets the piece whose ends lie on
        // its sides.
        let side = |p: [f64; 2]| p[0] * y - p[1] * x;
        let radius = self.points_m.windows(2).find_map(|ends| {
            let [a, b] = [ends[0], ends[1]];
            let (from, to) = (side(a), side(b));
            (from >= 0.0 && to <= 0.0 && from > to).then(|| {
                let share = from / (from - to);
                (a[0] + share * (b[0] - a[0])).hypot(a[1] + share * (b[1] - a[1]))
            })
        });
        radius.is_none_or(|radius| x.hypot(y) <= radius + margin_m)
    }
}

impl ToothCell {
    /// The cut.
    pub fn cut_line(&self) -> CutLine {
        CutLine {
            points_m: self.cut.iter().map(|&n| self.nodes[n]).collect(),
            arc_m: arc_at(&self.outline, &self.outline_arc_m, self.cut.first()),
        }
    }
}

/// Arc length of a node of the outline.
fn arc_at(outline: &[usize], arcs_m: &[f64], node: Option<&usize>) -> f64 {
    let place = outline.iter().position(|n| Some(n) == node);
    arcs_m[place.unwrap_or(0)]
}
