//! Pictures of the stress in a loaded tooth and its neighbours, for the pages of `report` and `tca`: from the side that
//! is pressed, and in the middle of the face.

use crate::failure::Result;
use crate::stressed_gear::{GaugeReading, Pressed, RootFace, StressedGear, ToothFrame};
use gearmesh_fe::von_mises;
use gearmesh_geometry::Flank;
use gearmesh_reduction::skin::{first_principal_pa, skin_of, stress_on_faces};
use gearmesh_report::body_view::BodyView;
use gearmesh_report::page::{Align, FieldPicture, Mark, MarkSign, Section, Table, Text};
use gearmesh_report::short;
use serde_json::{Value, json};

/// The view from the side that is pressed: so far from looking down on the tip towards that side, and towards the
/// tooth's larger end.
const FROM_SIDE: [f64; 3] = [1.0, 0.5, 0.1];

/// Gauges so near to the middle of the face, in faces, are drawn in the cut.
const NEAR_CUT: f64 = 0.1;

/// A gear under forces at one moment.
pub struct LoadedGear<'a> {
    /// What it is called.
    pub name: &'a str,
    /// Its body.
    pub stressed: &'a StressedGear,
    /// What acts on it.
    pub pressed: &'a Pressed,
    /// When, and under which load, in words.
    pub when: &'a str,
}

/// The largest of a root's stresses, and where.
#[derive(Clone, Copy, Default)]
struct Largest {
    mpa: f64,
    at_m: [f64; 3],
}

/// Von Mises and first principal stress.
type Pair = [Largest; 2];

/// What is said of all pictures at the head of their section.
pub const WORDS: &str = "Stress of the finite elements under the forces of all pairs of teeth, in the middles of their faces. Close to the contact it is that of forces \
     spread over the elements, not the pressure of the contact; colours end at the largest stress of the root. A ring marks that place, squares the gauges, whose tooth this \
     one stands for.";

/// The stress of one side's root.
fn root_stress(of: &LoadedGear<'_>, root: &[RootFace], u: &[f64]) -> Result<Pair> {
    let faces: Vec<_> = root.iter().map(|r| r.face.clone()).collect();
    let stress = stress_on_faces(of.stressed.model(), &faces, u)?;
    let largest = |value: OfStress| {
        let values = stress.iter().map(|s| 1e-6 * value(s)).zip(root);
        let found = values.max_by(|a, b| a.0.total_cmp(&b.0));
        found.map_or(Largest::default(), |(mpa, root)| Largest {
            mpa,
            at_m: root.middle_m,
        })
    };
    Ok([largest(von_mises), largest(first_principal_pa)])
}

/// Adds a table and the pictures of a gear; and the figures for other programs.
pub fn add(section: Section, of: &LoadedGear<'_>) -> Result<(Section, Value)> {
    let u = of.stressed.displacement_m(of.pressed)?;
    let Some(worst) = WorstTooth::new(of, &u)? else {
        let words = format!("{}: nothing presses on its teeth, {}.", of.name, of.when);
        return Ok((section.push(Text::note(words)), Value::Null));
    };
    let section = section.push(worst.table(of));
    let section = worst.side_pictures(of, &u, section)?;
    let section = worst.section_pictures(of, &u, section)?;
    Ok((section, worst.figures(of)))
}

/// The loaded tooth whose root on the pressed side carries most.
struct WorstTooth {
    tooth: usize,
    /// The side that is pressed.
    side: Flank,
    root: Pair,
    /// The root of the other side.
    other: Pair,
    gauges: Vec<GaugeReading>,
}

impl WorstTooth {
    /// None where nothing presses.
    fn new(of: &LoadedGear<'_>, u: &[f64]) -> Result<Option<Self>> {
        let gear = of.stressed;
        let mut loaded: Vec<(usize, Flank)> = of
            .pressed
            .forces
            .iter()
            .map(|f| (f.tooth, f.side))
            .collect();
        loaded.sort_unstable_by_key(|(tooth, side)| (*tooth, *side as usize));
        loaded.dedup();
        let mut worst: Option<(usize, Flank, Pair)> = None;
        for (tooth, side) in loaded {
            let found = root_stress(of, &gear.root(tooth, side)?, u)?;
            if worst.is_none_or(|(_, _, most)| found[0].mpa > most[0].mpa) {
                worst = Some((tooth, side, found));
            }
        }
        let Some((tooth, side, root)) = worst else {
            return Ok(None);
        };
        Ok(Some(Self {
            tooth,
            side,
            root,
            other: root_stress(of, &gear.root(tooth, side.opposite())?, u)?,
            gauges: gear.gauges_on(tooth, u)?,
        }))
    }

    fn table(&self, of: &LoadedGear<'_>) -> Table {
        let (tooth, side, far) = (self.tooth, self.side, self.side.opposite());
        let mut table = Table::new(format!("{}, tooth {tooth}, {}", of.name, of.when))
            .column("", Align::Left)
            .column("largest", Align::Right)
            .column("where", Align::Left);
        for (words, of_root) in [
            (format!("root, {side} side (pressed)"), self.root),
            (format!("root, {far} side"), self.other),
        ] {
            for ((quantity, _), largest) in QUANTITIES.into_iter().zip(of_root) {
                table.push_row([
                    format!("{words}: {quantity}"),
                    format!("{} MPa", short(largest.mpa)),
                    of.stressed.place_in_words(largest.at_m),
                ]);
            }
        }
        for gauge in &self.gauges {
            table.push_row([
                format!("gauge `{}`, {} side", gauge.name, gauge.side),
                format!("{} µε", short(1e6 * gauge.strain)),
                of.stressed.place_in_words(gauge.at_m),
            ]);
        }
        table
    }

    /// The pictures from the side that is pressed, with the ends of the tooth, its gauges and the largest stress.
    fn side_pictures(
        &self,
        of: &LoadedGear<'_>,
        u: &[f64],
        mut section: Section,
    ) -> Result<Section> {
        let (gear, side) = (of.stressed, self.side);
        let frame = gear.frame(self.tooth, side);
        let view = seen_along(&frame, FROM_SIDE);
        let shown = Shown::new(of, self.tooth, u, StressedGear::cell_elements)?;
        for ((quantity, value), largest) in QUANTITIES.into_iter().zip(self.root) {
            let title = format!(
                "{}, tooth {}, {side} side: {quantity}, {}",
                of.name, self.tooth, of.when
            );
            let mut picture = shown.picture(&view, (&title, quantity, value), largest.mpa);
            for (end, name) in frame.ends_m.iter().zip(gear.end_names()) {
                picture = picture.mark(Mark {
                    at_mm: view.place_mm(*end),
                    words: name.to_owned(),
                    sign: MarkSign::Words,
                });
            }
            for gauge in self.gauges.iter().filter(|gauge| gauge.side == side) {
                picture = picture.mark(of_gauge(&view, gauge));
            }
            section = section.push(picture.mark(Mark {
                at_mm: view.place_mm(largest.at_m),
                words: format!("{} MPa", short(largest.mpa)),
                sign: MarkSign::Ring,
            }));
        }
        Ok(section)
    }

    /// The pictures of the cut in the middle of the face, with the gauges that are near it.
    fn section_pictures(
        &self,
        of: &LoadedGear<'_>,
        u: &[f64],
        mut section: Section,
    ) -> Result<Section> {
        let (gear, tooth) = (of.stressed, self.tooth);
        let half = Shown::new(of, tooth, u, StressedGear::half_cell_elements)?;
        let frame = gear.frame(tooth, self.side);
        let view = BodyView::new(frame.along, frame.up);
        for ((quantity, value), largest) in QUANTITIES.into_iter().zip(self.root) {
            let title = format!(
                "{}, tooth {tooth}, cut in the middle of the face, seen from the {}: {quantity}",
                of.name,
                gear.end_names()[1]
            );
            let picture = half.picture(&view, (&title, quantity, value), largest.mpa);
            let off_cut = |g: &GaugeReading| (gear.share_along_face(g.at_m) - 0.5).abs();
            let near_cut = self.gauges.iter().filter(|g| off_cut(g) < NEAR_CUT);
            section = section.push(near_cut.fold(picture, |picture, gauge| {
                picture.mark(of_gauge(&view, gauge))
            }));
        }
        Ok(section)
    }

    fn figures(&self, of: &LoadedGear<'_>) -> Value {
        let (root, other) = (&self.root, &self.other);
        let place = |largest: &Largest| largest.at_m.map(|x| 1e3 * x);
        json!({
            "gear": of.name,
            "when": of.when,
            "tooth": self.tooth,
            "side": self.side.to_string(),
            "root_von_Mises_MPa": root[0].mpa,
            "root_von_Mises_at_mm": place(&root[0]),
            "root_first_principal_MPa": root[1].mpa,
            "root_first_principal_at_mm": place(&root[1]),
            "other_side_von_Mises_MPa": other[0].mpa,
            "other_side_first_principal_MPa": other[1].mpa,
            "gauges_ustrain": self.gauges.iter().map(|g| json!({ "name": g.name, "side": g.side.to_string(), "strain": 1e6 * g.strain })).collect::<Vec<_>>(),
        })
    }
}

fn of_gauge(view: &BodyView, gauge: &GaugeReading) -> Mark {
    Mark {
        at_mm: view.place_mm(gauge.at_m),
        words: format!("{}: {} µε", gauge.name, short(1e6 * gauge.strain)),
        sign: MarkSign::Square,
    }
}

/// What is drawn of the six components of a stress \[Pa\].
type OfStress = fn(&[f64; 6]) -> f64;

/// Its name and its value.
const QUANTITIES: [(&str, OfStress); 2] = [
    ("von Mises stress", von_mises),
    ("first principal stress", first_principal_pa),
];

/// A view by shares of the tooth's directions up, to its side and along it.
fn seen_along(frame: &ToothFrame, [up, side, along]: [f64; 3]) -> BodyView {
    let towards =
        [0, 1, 2].map(|k: usize| up * frame.up[k] + side * frame.side[k] + along * frame.along[k]);
    BodyView::new(towards, frame.up)
}

/// A tooth, its neighbours and the ring below them, cut out of the body.
struct Shown<'a> {
    points_m: &'a [[f64; 3]],
    faces: Vec<(Vec<u32>, [f64; 6])>,
}

impl<'a> Shown<'a> {
    fn new(
        of: &LoadedGear<'a>,
        tooth: usize,
        displacement_m: &[f64],
        elements: fn(&StressedGear, usize) -> Vec<u32>,
    ) -> Result<Self> {
        let (gear, teeth) = (of.stressed, of.stressed.teeth());
        let shown = [tooth + teeth - 1, tooth, tooth + 1];
        let elements: Vec<u32> = (shown.iter())
            .flat_map(|tooth| elements(gear, tooth % teeth))
            .collect();
        let faces = skin_of(gear.model(), &elements);
        let stress = stress_on_faces(gear.model(), &faces, displacement_m)?;
        Ok(Self {
            points_m: gear.model().nodes(),
            faces: faces.into_iter().map(|f| f.corners).zip(stress).collect(),
        })
    }

    fn picture(
        &self,
        view: &BodyView,
        (title, quantity, value): (&str, &str, OfStress),
        top_mpa: f64,
    ) -> FieldPicture {
        let faces: Vec<(Vec<u32>, f64)> = (self.faces.iter())
            .map(|(corners, stress)| (corners.clone(), 1e-6 * value(stress)))
            .collect();
        let picture = FieldPicture::new(title, quantity, "MPa");
        view.picture(picture, self.points_m, &faces)
            .colour_range(0.0, top_mpa.max(1e-6))
    }
}
