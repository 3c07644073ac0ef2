//! A body seen from one direction: faces of its surface that look at the viewer, projected without perspective, the far
//! ones first.

use crate::page::{FieldPicture, FieldValues};

/// Light of a face that looks at the viewer, and of one that is seen along.
const LIGHT: [f64; 2] = [1.0, 0.72];

/// From where a body is seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyView {
    /// To the right, up and towards the viewer: unit vectors, right-handed.
    axes: [[f64; 3]; 3],
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    let part = |i: usize, j: usize| a[i] * b[j] - a[j] * b[i];
    [part(1, 2), part(2, 0), part(0, 1)]
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = dot(a, a).sqrt().max(f64::MIN_POSITIVE);
    a.map(|x| x / length)
}

impl BodyView {
    /// Seen by a viewer in this direction from the body, with `up` upwards as far as it goes; the two must not be
    /// parallel.
    #[must_use]
    pub fn new(towards_viewer: [f64; 3], up: [f64; 3]) -> Self {
        let towards = unit(towards_viewer);
        let right = unit(cross(up, towards));
        Self {
            axes: [right, cross(towards, right), towards],
        }
    }

    /// Where a point is seen: to the right and up \[mm\] of a point in metres.
    #[must_use]
    pub fn place_mm(&self, point_m: [f64; 3]) -> [f64; 2] {
        [0, 1].map(|k: usize| 1e3 * dot(self.axes[k], point_m))
    }

    /// A picture of faces, corners counter-clockwise seen from outside, with a value each.
    #[must_use]
    pub fn picture(
        &self,
        picture: FieldPicture,
        points_m: &[[f64; 3]],
        faces: &[(Vec<u32>, f64)],
    ) -> FieldPicture {
        let towards = self.axes[2];
        // Depth, light and number of those that are seen.
        let mut seen: Vec<(f64, f64, usize)> = Vec::new();
        for (number, (corners, _)) in faces.iter().enumerate() {
            let at = |k: usize| points_m[corners[k % corners.len()] as usize];
            let less = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|k: usize| a[k] - b[k]);
            // Of a quadrilateral by its diagonals; of a triangle the third corner counts twice.
            let [p, q, r, s] = [0, 1, 2, corners.len() - 1].map(at);
            let facing = dot(unit(cross(less(r, p), less(s, q))), towards);
            let facing = match corners.len() {
                3 => dot(unit(cross(less(q, p), less(r, p))), towards),
                _ => facing,
            };
            if facing > 0.0 {
                let depths = (0..corners.len()).map(|k| dot(at(k), towards));
                let light = LIGHT[1] + (LIGHT[0] - LIGHT[1]) * facing;
                seen.push((depths.sum::<f64>() / corners.len() as f64, light, number));
            }
        }
        seen.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut numbers = std::collections::HashMap::new();
        let mut nodes_mm = Vec::new();
        let (mut quads, mut values) = (Vec::new(), Vec::new());
        for (_, _, number) in &seen {
            let (corners, value) = &faces[*number];
            let last = corners.len() - 1;
            quads.push([0, 1, 2, 3].map(|k: usize| {
                let node = corners[k.min(last)];
                *numbers.entry(node).or_insert_with(|| {
                    nodes_mm.push(self.place_mm(points_m[node as usize]));
                    nodes_mm.len() as u32 - 1
                })
            }));
            values.push(*value);
        }
        picture
            .mesh(nodes_mm, quads)
            .values(FieldValues::PerElement(values))
            .shades(seen.iter().map(|(_, light, _)| *light).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::page::{Page, Section};

    /// A unit cube seen from the front, a little from above and the right: three faces, the front one last.
    #[test]
    #[allow(clippy::unwrap_used)]
    fn a_cube_shows_three_faces_and_nothing_behind_them() {
        let points: Vec<[f64; 3]> = (0..8)
            .map(|k| [k & 1, k >> 1 & 1, k >> 2 & 1].map(|x| 1e-3 * f64::from(x)))
            .collect();
        let faces = [
            vec![0, 2, 3, 1],
            vec![4, 5, 7, 6],
            vec![0, 1, 5, 4],
            vec![2, 6, 7, 3],
            vec![0, 4, 6, 2],
            vec![1, 3, 7, 5],
        ];
        let faces: Vec<(Vec<u32>, f64)> = faces
            .into_iter()
            .zip([0.0, 1.0, 2.0, 3.0, 4.0, 5.0])
            .collect();
        let view = BodyView::new([0.2, 0.3, 0.9], [0.0, 1.0, 0.0]);
        let [x, y] = view.place_mm([1e-3, 0.0, 0.0]);
        assert!(x > 0.9 && y.abs() < 0.1);
        let picture = view.picture(FieldPicture::new("t", "q", "u"), &points, &faces);
        let html = Page::new("p")
            .section(Section::new("s").push(picture.clone()))
            .render()
            .unwrap();
        assert!(html.contains("\"shades\":\""));
        let (values, shades) = picture.drawn();
        assert_eq!(values, &FieldValues::PerElement(vec![5.0, 3.0, 1.0]));
        // The front face looks at the viewer most.
        assert!(shades[2] > shades[1] && shades[1] > shades[0]);
    }
}
