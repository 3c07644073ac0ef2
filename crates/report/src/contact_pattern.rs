//! What the flank of gear 1 feels over a whole passage: the largest pressure and line load at every place that touches.

use gearmesh_scene::{ContactPlaces, SceneResult};

use crate::page::{FieldPicture, FieldValues, Section, Text};

/// Strips along the profile, at most.
const MOST_STRIPS: usize = 60;

/// Strips per position in a pitch: fewer strips than positions, so that none stays empty by chance.
const STRIPS_PER_POSITION: f64 = 0.7;

/// Fields on the flank; `None` where an older program has not stored where the slices touch.
pub(crate) fn section(r: &SceneResult) -> Option<Section> {
    let places = r.lines.places.as_ref()?;
    let up = match &r.bevel {
        Some(bevel) => Up::Share(bevel.flank_heights_m[0]),
        None => Up::Roll(r.source.gears[0].definition()?.profile.base_radius_m),
    };
    let flank = Flank::new(r, places, up)?;
    let last = r.torque_nm.len() - 1;
    let block = r.lines.force_n.len() / r.torque_nm.len();
    let of = |values: &[f64], torque: usize| values[torque * block..(torque + 1) * block].to_vec();
    let line_load = |torque: usize| -> Vec<f64> {
        let forces = of(&r.lines.force_n, torque)
            .into_iter()
            .zip(&places.width_m);
        forces
            .map(|(force, width)| if *width > 0.0 { force / width } else { 0.0 })
            .collect()
    };
    let mut section = Section::new(format!("{}: contact pattern", r.source.title)).push(Text::paragraph(
        "The flank of gear 1 from mid-face, root below and tip above: at each place the largest value of all positions. What is not coloured \
         does not touch. Across is the axial place z, up the radius, of bevel gears the way up the flank.",
    ));
    let mut shown = vec![last];
    if last > 0 {
        shown.push(0);
    }
    for torque in shown {
        let at = format!("at {} N m", r.torque_nm[torque]);
        let pressure = of(&r.lines.pressure_pa, torque);
        let picture = flank.picture(
            places,
            format!("Largest Hertz pressure {at}"),
            ("pressure", "MPa", 1e-6),
            &pressure,
        );
        section = match picture {
            Some(picture) => section.push(picture),
            None => section.push(Text::paragraph(format!("No contact {at}."))),
        };
    }
    let picture = flank.picture(
        places,
        format!("Largest line load at {} N m", r.torque_nm[last]),
        ("line load", "N/mm", 1e-3),
        &line_load(last),
    );
    section = section.push_all(picture);
    Some(section)
}

/// What places along the profile are drawn at.
enum Up {
    /// The radius of a roll angle; base radius \[m\].
    Roll(f64),
    /// The share of a way up the flank \[m\].
    Share(f64),
}

/// Strips along the profile by slices across the face.
struct Flank {
    up: Up,
    slices: usize,
    /// Edges of the strips, roll angles \[rad\].
    edges_rad: Vec<f64>,
    /// Sides of the slices, one more than there are \[mm\].
    sides_mm: Vec<f64>,
}

impl Flank {
    fn new(r: &SceneResult, places: &ContactPlaces, up: Up) -> Option<Self> {
        let touching =
            || (places.width_m.iter().zip(&places.roll_1_rad)).filter(|(w, _)| **w > 0.0);
        let low = touching()
            .map(|(_, roll)| *roll)
            .fold(f64::INFINITY, f64::min);
        let high = touching().map(|(_, roll)| *roll).fold(0.0, f64::max);
        if high <= low {
            return None;
        }
        let step_rad = r.angle_rad.get(1)? - r.angle_rad[0];
        let positions = match up {
            Up::Roll(_) => (high - low) / step_rad,
            Up::Share(_) => r.points_per_pitch() as f64,
        };
        let strips = (STRIPS_PER_POSITION * positions) as usize;
        let strips = strips.clamp(4, MOST_STRIPS);
        let edges = (0..=strips).map(|k| low + (high - low) * k as f64 / strips as f64);
        if let Some(bevel) = &r.bevel {
            let side =
                |k: usize| 1e3 * bevel.face_widths_m[0] * (k as f64 / r.lines.slices as f64 - 0.5);
            return Some(Self {
                up,
                slices: r.lines.slices,
                edges_rad: edges.collect(),
                sides_mm: (0..=r.lines.slices).map(side).collect(),
            });
        }
        let width = places.width_m.iter().copied().fold(0.0, f64::max);
        let mut sides_mm = Vec::new();
        for slice in 0..r.lines.slices {
            let own = (slice..places.z_m.len()).step_by(r.lines.slices);
            // A slice that is partly on the path touches beside its own middle.
            let whole = own.max_by(|a, b| places.width_m[*a].total_cmp(&places.width_m[*b]))?;
            let middle = places.z_m[whole];
            if slice == 0 {
                sides_mm.push(1e3 * (middle - 0.5 * width));
            }
            sides_mm.push(1e3 * (middle + 0.5 * width));
        }
        Some(Self {
            up,
            slices: r.lines.slices,
            edges_rad: edges.collect(),
            sides_mm,
        })
    }

    /// Largest value of each strip and slice; places without force are left out.
    fn picture(
        &self,
        places: &ContactPlaces,
        title: String,
        (quantity, unit, factor): (&str, &str, f64),
        values: &[f64],
    ) -> Option<FieldPicture> {
        let strips = self.edges_rad.len() - 1;
        let (low, high) = (self.edges_rad[0], self.edges_rad[strips]);
        let mut largest = vec![0.0_f64; strips * self.slices];
        for (at, &value) in values.iter().enumerate() {
            if places.width_m[at] > 0.0 && value > 0.0 {
                let place = (places.roll_1_rad[at] - low) / (high - low) * strips as f64;
                let strip = (place as usize).min(strips - 1);
                let cell = &mut largest[strip * self.slices + at % self.slices];
                *cell = cell.max(value);
            }
        }
        let up_mm = |at: f64| match self.up {
            Up::Roll(base_radius_m) => 1e3 * base_radius_m * (1.0 + at * at).sqrt(),
            Up::Share(height_m) => 1e3 * height_m * at,
        };
        let across = self.sides_mm.len();
        let along = self.edges_rad.iter().map(|roll| up_mm(*roll));
        let nodes = along.flat_map(|r| self.sides_mm.iter().map(move |z| [*z, r]));
        let (mut quads, mut shown) = (Vec::new(), Vec::new());
        for (cell, value) in largest
            .iter()
            .enumerate()
            .filter(|(_, value)| **value > 0.0)
        {
            let (strip, slice) = (cell / self.slices, cell % self.slices);
            let first = (strip * across + slice) as u32;
            let above = first + across as u32;
            quads.push([first, first + 1, above + 1, above]);
            shown.push(factor * value);
        }
        (!quads.is_empty()).then(|| {
            FieldPicture::new(title, quantity, unit)
                .mesh(nodes.collect(), quads)
                .values(FieldValues::PerElement(shown))
                .colours_of_most()
        })
    }
}
