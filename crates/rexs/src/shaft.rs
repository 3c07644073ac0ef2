//! Shafts: what stands where along them.

use crate::material::Material;
use crate::vectors::Frame;
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
#[derive(Debug, Clone, Default)]
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
pub const SAME_MM: f64 = 1e-3;

impl Shaft {
    /// The hub of a gear that turns loose on this shaft: its number is that of the gear, and it has no sections of its
    /// own.
    pub fn hub(&self, gear: i64, name: &str) -> Self {
        Self {
            id: gear,
            name: name.to_owned(),
            frame: self.frame,
            is_reversed: self.is_reversed,
            material: self.material,
            hub_on: Some(self.id),
            ..Self::default()
        }
    }

    /// +1 where z runs along u, else −1.
    pub fn sign(&self) -> f64 {
        if self.is_reversed { -1.0 } else { 1.0 }
    }

    /// Direction of z in the gear unit; that of u, where the shaft has no place yet, is x.
    pub fn z(&self) -> [f64; 3] {
        let frame = self.frame.unwrap_or(Frame::WORLD);
        frame.axes[0].map(|x| self.sign() * x)
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

    /// Lowest and highest place where something stands \[mm\]; the largest and the smallest number where nothing does.
    pub fn marked_mm(&self) -> [f64; 2] {
        let points = self.points_mm.iter();
        points.fold([f64::MAX, f64::MIN], |[a, b], &u| [a.min(u), b.max(u)])
    }

    /// A further section, behind the others.
    pub fn give(&mut self, section: Section) {
        self.forget();
        self.sections.push(section);
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

    /// Place along u nearest to a point, within its sections where it has some; of no point or frame that of u = 0.
    pub fn nearest_mm(&self, point: Option<[f64; 3]>) -> f64 {
        let [start, end] = self.ends_mm();
        let along = self.frame.zip(point).map_or(0.0, |(f, p)| f.u_of(p));
        match start < end {
            true => along.clamp(start, end),
            false => along,
        }
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
