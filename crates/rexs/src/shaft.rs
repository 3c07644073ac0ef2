//! Shafts: sections, and what stands where along them.

use crate::error::RexsError;
use crate::gear::{Material, material};
use crate::ledger::About;
use crate::model::Component;
use crate::placement::Frame;
use crate::source::Source;
use crate::structure::Structure;
use crate::units::{MM, RPM};
use std::cell::OnceCell;
use std::collections::HashMap;

/// A cylindrical piece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Section {
    /// Start along u \[mm\].
    pub start_mm: f64,
    /// End \[mm\].
    pub end_mm: f64,
    /// Outer diameter \[mm\].
    pub outer_mm: f64,
    /// Inner diameter \[mm\], 0 for solid.
    pub inner_mm: f64,
}

/// A shaft.
#[derive(Debug, Clone)]
pub struct Shaft {
    /// Component.
    pub id: i64,
    /// Name in the scene.
    pub name: String,
    /// Place; none until it follows from its stages.
    pub frame: Option<Frame>,
    /// Whether z in the scene runs against u, so that all shafts of parallel axes point the same way.
    pub is_reversed: bool,
    /// Pieces from the lowest u on, without gaps.
    pub sections: Vec<Section>,
    /// Material.
    pub material: Material,
    /// The shaft on which a gear turns loose whose hub this is; none for shafts of the file.
    pub hub_on: Option<i64>,
    /// Stated speed about u \[1/min\], where it defines those of the others.
    pub speed_rpm: Option<f64>,
    /// Places of stations along u \[mm\].
    points_mm: Vec<f64>,
    /// Bodies that take the place of a station, and where along u \[mm\].
    seated: Vec<(f64, String)>,
    /// Stations along z, and the bodies seated first there: made when they are asked for, forgotten by what changes
    /// them.
    stations: OnceCell<Vec<f64>>,
    first_seated: OnceCell<HashMap<usize, usize>>,
    /// Marked points in increasing order.
    sorted_mm: OnceCell<Vec<f64>>,
    /// Faces along u of gears that are cut into the shaft \[mm\].
    faces_mm: Vec<[f64; 2]>,
    /// The same from the lower to the higher one.
    sorted_faces_mm: OnceCell<Vec<[f64; 2]>>,
}

/// Points nearer than this are one station \[mm\].
const SAME_MM: f64 = 1e-3;

impl Shaft {
    /// The hub of a gear that turns loose on this shaft: its number is that of the gear, and it has no sections of its
    /// own.
    pub fn hub(&self, gear: i64, name: &str) -> Self {
        Self {
            id: gear,
            name: name.to_owned(),
            frame: self.frame,
            is_reversed: self.is_reversed,
            sections: Vec::new(),
            material: self.material,
            hub_on: Some(self.id),
            speed_rpm: None,
            points_mm: Vec::new(),
            seated: Vec::new(),
            stations: OnceCell::new(),
            first_seated: OnceCell::new(),
            sorted_mm: OnceCell::new(),
            faces_mm: Vec::new(),
            sorted_faces_mm: OnceCell::new(),
        }
    }

    /// +1 where z runs along u, else −1.
    pub fn sign(&self) -> f64 {
        if self.is_reversed { -1.0 } else { 1.0 }
    }

    fn forget(&mut self) {
        self.stations.take();
        self.first_seated.take();
        self.sorted_mm.take();
    }

    /// Something stands here.
    pub fn mark(&mut self, u_mm: f64) {
        self.forget();
        self.points_mm.push(u_mm);
    }

    /// Cuts a gear into the shaft, with its station in the middle of the face and none elsewhere in it. False where
    /// something else stands within the face.
    pub fn cut_in(&mut self, mid_mm: f64, width_mm: f64) -> bool {
        let face = [mid_mm - 0.5 * width_mm, mid_mm + 0.5 * width_mm];
        let sorted = self.sorted_mm.get_or_init(|| {
            let mut sorted = self.points_mm.clone();
            sorted.sort_by(f64::total_cmp);
            sorted
        });
        let between = |low: f64, high: f64| {
            sorted.partition_point(|u| *u <= high) - sorted.partition_point(|u| *u < low)
        };
        let all = between(face[0] - SAME_MM, face[1] + SAME_MM);
        let is_free = all == between(mid_mm - SAME_MM, mid_mm + SAME_MM);
        if is_free {
            self.faces_mm.push(face);
            self.sorted_faces_mm.take();
            self.stations.take();
            self.first_seated.take();
        }
        is_free
    }

    /// Whether there is shaft at a place along u.
    pub fn reaches(&self, u_mm: f64) -> bool {
        // They join: the first one that ends here or later.
        let next = self.sections.partition_point(|s| s.end_mm < u_mm);
        let here = self.sections.get(next);
        here.is_some_and(|s| s.start_mm <= u_mm)
    }

    /// Outer and inner diameter between two stations, outside the faces of gears that are cut into the shaft \[mm\].
    pub fn between_mm(&self, stations_mm: [f64; 2]) -> [f64; 2] {
        let [mut low, mut high] = stations_mm.map(|z| self.sign() * z);
        if low > high {
            (low, high) = (high, low);
        }
        if let Some([_, to]) = self.face_at(low, 0.0) {
            low = to;
        }
        if let Some([from, _]) = self.face_at(high, 0.0) {
            high = from;
        }
        self.diameters_mm(0.5 * (low + high))
    }

    /// The face of a gear that is cut into the shaft, around a place along u.
    fn face_at(&self, u_mm: f64, beyond_mm: f64) -> Option<[f64; 2]> {
        let faces = self.sorted_faces_mm.get_or_init(|| {
            let mut sorted = self.faces_mm.clone();
            sorted.sort_by(|a, b| a[0].total_cmp(&b[0]));
            sorted
        });
        let next = faces.partition_point(|f| f[0] <= u_mm + beyond_mm);
        let face = faces[next.saturating_sub(2)..next].iter().rev();
        let mut around = face.filter(|f| u_mm <= f[1] + beyond_mm && u_mm >= f[0] - beyond_mm);
        around.next().copied()
    }

    /// Stations along z \[mm\], increasing.
    pub fn stations_mm(&self) -> &[f64] {
        self.stations.get_or_init(|| self.made_stations_mm())
    }

    fn made_stations_mm(&self) -> Vec<f64> {
        let ends = self.sections.iter().flat_map(|s| [s.start_mm, s.end_mm]);
        // Marked points go before borders of sections, which they may move by less than a micrometre.
        let mut kept: Vec<f64> = Vec::new();
        // Those that are kept, by whole lengths below which two are the same.
        let mut cells: HashMap<i64, Vec<f64>> = HashMap::new();
        let in_face = |u: &f64| self.face_at(*u, SAME_MM).is_some();
        let ends = ends.filter(|u| !in_face(u));
        for u in self.points_mm.iter().copied().chain(ends) {
            let z = self.sign() * u;
            let cell = (z / SAME_MM).floor() as i64;
            let near = (cell - 1..=cell + 1)
                .filter_map(|c| cells.get(&c))
                .flatten();
            if { near }.all(|other| (other - z).abs() >= SAME_MM) {
                cells.entry(cell).or_default().push(z);
                kept.push(z);
            }
        }
        kept.sort_by(f64::total_cmp);
        kept
    }

    /// Number of the station at a place along u.
    pub fn station(&self, u_mm: f64) -> usize {
        let z = self.sign() * u_mm;
        let stations = self.stations_mm();
        let distance = |i: &usize| (stations[*i] - z).abs();
        let next = stations.partition_point(|s| *s < z);
        (next.saturating_sub(1)..stations.len().min(next + 1))
            .min_by(|a, b| distance(a).total_cmp(&distance(b)))
            .unwrap_or(0)
    }

    /// Seats a body, which takes the place of the station's own.
    pub fn seat(&mut self, u_mm: f64, body: &str) {
        self.first_seated.take();
        self.seated.push((u_mm, body.to_owned()));
    }

    /// The body that is seated first at a station.
    pub fn seated(&self, station: usize) -> Option<&str> {
        let first = self.first_seated.get_or_init(|| {
            let mut first = HashMap::new();
            for (i, (u, _)) in self.seated.iter().enumerate() {
                first.entry(self.station(*u)).or_insert(i);
            }
            first
        });
        first.get(&station).map(|&i| self.seated[i].1.as_str())
    }

    /// Body at a place along u: what is seated there, else the station's own.
    pub fn body(&self, u_mm: f64) -> String {
        self.station_body(self.station(u_mm))
    }

    /// Body of a station: what is seated there, else its own.
    pub fn station_body(&self, station: usize) -> String {
        // The body of a hub is the gear itself.
        if self.hub_on.is_some() {
            return self.name.clone();
        }
        let own = || format!("{}/{station}", self.name);
        self.seated(station).map_or_else(own, str::to_owned)
    }

    /// Both ends along u \[mm\].
    pub fn ends_mm(&self) -> [f64; 2] {
        let of = |pick: fn(&Section) -> f64| self.sections.iter().map(pick);
        [
            of(|s| s.start_mm).fold(f64::MAX, f64::min),
            of(|s| s.end_mm).fold(f64::MIN, f64::max),
        ]
    }

    /// Outer and inner diameter at a place along u \[mm\]; beyond the ends those of the last piece.
    pub fn diameters_mm(&self, u_mm: f64) -> [f64; 2] {
        // They join: the first one that ends here or later.
        let next = self.sections.partition_point(|s| s.end_mm < u_mm);
        let nearest = self.sections.get(next).or(self.sections.last());
        nearest.map_or([0.0, 0.0], |s| [s.outer_mm, s.inner_mm])
    }
}

/// Faster shafts are slips \[1/min\]: dental turbines reach half of it.
pub const MOST_RPM: f64 = 1e6;

/// Pieces of a taper.
const TAPER_PIECES: usize = 3;

/// Reads a shaft with its sections.
///
/// # Errors
/// Those of [`Source`].
pub fn read(
    source: &Source<'_>,
    structure: &Structure,
    component: &Component,
    name: String,
    frame: Option<Frame>,
) -> Result<Shaft, RexsError> {
    let mut sections = Vec::new();
    let mut end_mm = 0.0;
    for id in structure.partners(component.id, &["shaft_section"]) {
        let Some(piece) = source.model.component(id) else {
            continue;
        };
        let Some(length) = source.number(piece, "length", MM)?.filter(|l| *l > 0.0) else {
            source.leave_out(piece, About::Stiffness, "a section without length");
            continue;
        };
        let start = source
            .number(piece, "u_coordinate_on_shaft", MM)?
            .unwrap_or(end_mm);
        end_mm = start + length;
        let value = |id: &str| source.number(piece, id, MM);
        let [outer_0, outer_1] = [value("outer_diameter_begin")?, value("outer_diameter_end")?];
        let [inner_0, inner_1] = [value("inner_diameter_begin")?, value("inner_diameter_end")?];
        let Some(outer) = outer_0.or(outer_1).filter(|d| *d > 0.0) else {
            source.leave_out(
                piece,
                About::Stiffness,
                "a section without an outer diameter",
            );
            continue;
        };
        let outer = [
            outer_0.unwrap_or(outer),
            outer_1.filter(|d| *d > 0.0).unwrap_or(outer),
        ];
        let inner = [
            inner_0.or(inner_1).unwrap_or(0.0),
            inner_1.or(inner_0).unwrap_or(0.0),
        ];
        let is_taper = outer[0] != outer[1] || inner[0] != inner[1];
        if is_taper {
            // Bending stiffness goes with d^4: 1/d^4 along the taper, and in the middles of its pieces.
            let [a, b] = outer;
            let exact = (a.powi(-3) - b.powi(-3)) / (3.0 * (b - a));
            let middles = (0..TAPER_PIECES)
                .map(|k| a + (b - a) * (k as f64 + 0.5) / TAPER_PIECES as f64)
                .map(|d| d.powi(-4) / TAPER_PIECES as f64);
            let off = (middles.sum::<f64>() / exact - 1.0).abs();
            let about = if off > 1e-2 || inner[0] != inner[1] {
                About::Stiffness
            } else {
                About::Small
            };
            source.assume(
                piece,
                about,
                format!("a taper: {TAPER_PIECES} cylinders of its diameters in their middles"),
            );
        }
        let pieces = if is_taper { TAPER_PIECES } else { 1 };
        for k in 0..pieces {
            let at = |d: [f64; 2]| d[0] + (d[1] - d[0]) * (k as f64 + 0.5) / pieces as f64;
            let [outer_mm, mut inner_mm] = [at(outer), at(inner).max(0.0)];
            if inner_mm >= outer_mm {
                source.leave_out(piece, About::Stiffness, format!("an inner diameter of {inner_mm} mm, which is not below the outer one: solid"));
                inner_mm = 0.0;
            }
            let step = length / pieces as f64;
            sections.push(Section {
                start_mm: start + k as f64 * step,
                end_mm: start + (k + 1) as f64 * step,
                outer_mm,
                inner_mm,
            });
        }
    }
    sections.sort_by(|a, b| a.start_mm.total_cmp(&b.start_mm));
    let mut sections = part_overlaps(source, component, sections);
    close_gaps(source, component, &mut sections);
    let speed = source.number_up_to(component, "rotational_speed", RPM, MOST_RPM)?;
    let defines = source.flag(component, "defines_speed")?;
    Ok(Shaft {
        id: component.id,
        name,
        frame,
        is_reversed: false,
        sections,
        material: material(source, structure, component)?,
        hub_on: None,
        speed_rpm: speed.filter(|n| *n != 0.0 && defines != Some(false)),
        points_mm: Vec::new(),
        seated: Vec::new(),
        stations: OnceCell::new(),
        first_seated: OnceCell::new(),
        sorted_mm: OnceCell::new(),
        faces_mm: Vec::new(),
        sorted_faces_mm: OnceCell::new(),
    })
}

/// Where pieces overlap, all of them are there, as a collar that is drawn over a shaft.
fn part_overlaps(
    source: &Source<'_>,
    component: &Component,
    sections: Vec<Section>,
) -> Vec<Section> {
    let mut reach = f64::MIN;
    let mut has_overlap = false;
    for section in &sections {
        has_overlap |= reach - section.start_mm > 1e-6;
        reach = reach.max(section.end_mm);
    }
    if !has_overlap {
        return sections;
    }
    source.assume(
        component,
        About::Stiffness,
        "sections overlap: there the largest outer and the smallest inner diameter count",
    );
    let mut borders: Vec<f64> = sections
        .iter()
        .flat_map(|s| [s.start_mm, s.end_mm])
        .collect();
    borders.sort_by(f64::total_cmp);
    borders.dedup_by(|a, b| (*a - *b).abs() < 1e-6);
    // Pieces that begin before the middle of a strip and have not ended, in the order of their starts.
    let mut next = 0;
    let mut here: Vec<Section> = Vec::new();
    let piece = |w: &[f64]| {
        let middle = 0.5 * (w[0] + w[1]);
        while next < sections.len() && sections[next].start_mm < middle {
            here.push(sections[next]);
            next += 1;
        }
        here.retain(|s| middle < s.end_mm);
        here.first()?;
        Some(Section {
            start_mm: w[0],
            end_mm: w[1],
            outer_mm: here.iter().map(|s| s.outer_mm).fold(0.0, f64::max),
            inner_mm: here.iter().map(|s| s.inner_mm).fold(f64::MAX, f64::min),
        })
    };
    borders.windows(2).filter_map(piece).collect()
}

/// Each piece ends where the next one begins.
fn close_gaps(source: &Source<'_>, component: &Component, sections: &mut [Section]) {
    for i in 1..sections.len() {
        let (start, end) = (sections[i].start_mm, sections[i - 1].end_mm);
        if (start - end).abs() > 1e-6 {
            let length = end - sections[i - 1].start_mm;
            let about = if (start - end).abs() > 1e-2 * length {
                About::Stiffness
            } else {
                About::Small
            };
            source.assume(
                component,
                about,
                format!(
                    "sections do not join at u = {start} mm ({} of {:.6} mm): the one before ends there",
                    if start > end { "gap" } else { "overlap" },
                    (start - end).abs()
                ),
            );
        }
        sections[i - 1].end_mm = start;
    }
}

/// Shafts that are longer than this many diameters are none of a gearbox.
const MOST_SLENDER: f64 = 100.0;

/// A shaft without sections: one as thick as what sits on it, and long enough.
pub fn demand_sections(
    source: &Source<'_>,
    component: &Component,
    shaft: &mut Shaft,
    bores_mm: &[f64],
) {
    let [least, most] = shaft
        .points_mm
        .iter()
        .fold([f64::MAX, f64::MIN], |[a, b], &u| [a.min(u), b.max(u)]);
    if shaft.sections.is_empty() {
        let outer = bores_mm.iter().copied().fold(f64::MAX, f64::min);
        let outer_mm = if outer < 1e6 { outer } else { 30.0 };
        let [start_mm, end_mm] = if least < most {
            [least, most]
        } else {
            [0.0, 100.0]
        };
        source.assume(
            component,
            About::Stiffness,
            format!("no sections given: {outer_mm} mm thick from u = {start_mm} to {end_mm} mm"),
        );
        shaft.forget();
        shaft.sections.push(Section {
            start_mm,
            end_mm,
            outer_mm,
            inner_mm: 0.0,
        });
    }
    let ends = [
        shaft.sections.first().map(|s| s.start_mm),
        shaft.sections.last().map(|s| s.end_mm),
    ];
    if let [Some(start), Some(end)] = ends {
        for u in [least, most] {
            if u.abs() < 1e9 && (u < start - SAME_MM || u > end + SAME_MM) {
                // Something that hangs over by less than the shaft is thick may be drawn so; more is a slip of a
                // coordinate.
                let beyond = (start - u).max(u - end);
                let is_slip = beyond > shaft.diameters_mm(u)[0];
                let about = if is_slip {
                    About::Lost
                } else {
                    About::Stiffness
                };
                let what = format!(
                    "something stands at u = {u} mm, beyond its sections ({start} to {end} mm): the last section goes on to there, the shaft is \
                     {:.6} mm longer",
                    beyond
                );
                source.assume(component, about, what);
            }
        }
        let thickest = shaft.sections.iter().map(|s| s.outer_mm);
        let thickest = thickest.fold(0.0, f64::max);
        let length = end.max(most) - start.min(least);
        if least <= most && length > MOST_SLENDER * thickest {
            let what = format!(
                "{length} mm long and {thickest} mm thick at most: look at the places along u of what stands on it"
            );
            source.assume(component, About::Lost, what);
        }
    }
}
