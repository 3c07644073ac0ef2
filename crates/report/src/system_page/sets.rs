//! Planetary sets: how the planets share the load, and a picture of the set coloured by the mesh forces.

use std::f64::consts::{PI, TAU};

use gearmesh_model::FileError;
use gearmesh_scene::system_run::{MeshShares, SetFigures, SystemResult};

use crate::page::{Align, FieldPicture, FieldValues, Mark, MarkSign, Section, Table, Text};
use crate::short;

/// Quads around a disc.
const AROUND: usize = 96;
/// Bore of sun and planets, and outside of the ring, over their pitch radii: a drawing, not the bodies.
const BORE: f64 = 0.45;
const OUTSIDE: f64 = 1.12;

/// A section for all sets; none without.
pub(super) fn section(r: &SystemResult) -> Result<Option<Section>, FileError> {
    let sets = r.sets()?;
    if sets.is_empty() {
        return Ok(None);
    }
    let mut section = Section::new(format!("{}: planetary sets", r.head.title));
    for set in &sets {
        section = section.push(Text::paragraph(format!(
            "{}: {}.",
            set.set.name,
            set.set.words()
        )));
        section = section.push(table(set));
        if let Some(picture) = picture(set) {
            section = section.push(picture);
        }
    }
    Ok(Some(section))
}

fn table(found: &SetFigures) -> Table {
    let factor = |shares: &Option<MeshShares>| {
        let factor = shares.as_ref().map(MeshShares::mesh_load_factor);
        factor.map_or_else(|| "–".to_owned(), short)
    };
    let title = format!(
        "{}, {}: K_γ {} of the sun meshes, {} of the ring meshes",
        found.set.name,
        found.over,
        factor(&found.sun),
        factor(&found.ring)
    );
    let mut table = Table::new(title).column("planet", Align::Left);
    for head in [
        "share of the sun meshes",
        "largest",
        "normal force, N",
        "share of the ring meshes",
        "largest",
        "normal force, N",
        "pin force, N",
    ] {
        table = table.column(head, Align::Right);
    }
    for (planet, name) in found.set.planets.iter().enumerate() {
        let of = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), short);
        let of_meshes = |shares: &Option<MeshShares>| {
            let parts = shares
                .as_ref()
                .map(|s| [s.mean[planet], s.largest[planet], s.normal_force_n[planet]]);
            [0, 1, 2].map(|part: usize| of(parts.map(|parts| parts[part])))
        };
        let pin = found.pin_force_n.as_ref().map(|forces| forces[planet]);
        let cells = [of_meshes(&found.sun), of_meshes(&found.ring)].concat();
        table.push_row([vec![name.clone()], cells, vec![of(pin)]].concat());
    }
    table
}

/// Quads with a value each.
#[derive(Default)]
struct Drawing {
    nodes_mm: Vec<[f64; 2]>,
    quads: Vec<[u32; 4]>,
    values: Vec<f64>,
}

impl Drawing {
    /// A disc with a hole; `value` at the angle of each of its parts.
    fn disc(&mut self, [x, y]: [f64; 2], radii_mm: [f64; 2], value: impl Fn(f64) -> f64) {
        let first = self.nodes_mm.len() as u32;
        let angle = |i: usize| TAU * i as f64 / AROUND as f64;
        for i in 0..AROUND {
            let (sin, cos) = angle(i).sin_cos();
            self.nodes_mm
                .extend(radii_mm.map(|radius| [x + radius * cos, y + radius * sin]));
        }
        for i in 0..AROUND {
            let [here, next] = [i, (i + 1) % AROUND].map(|i| first + 2 * i as u32);
            self.quads.push([here, here + 1, next + 1, next]);
            self.values.push(value(angle(i) + PI / AROUND as f64));
        }
    }
}

/// Sun, planets and ring on their pitch circles at the start, each part in the colour of the nearest mesh's force; none
/// where forces are not recorded.
fn picture(found: &SetFigures) -> Option<FieldPicture> {
    let set = &found.set;
    let force = |shares: &Option<MeshShares>| shares.as_ref().map(|s| s.normal_force_n.clone());
    let (sun, ring) = (force(&found.sun), force(&found.ring));
    let forces = [&sun, &ring].into_iter().flatten().flatten();
    if forces.fold(0.0_f64, |most, force| most.max(*force)) <= 0.0 {
        return None;
    }
    let (teeth, a_mm) = (&set.teeth, 1e3 * set.centre_distance_m);
    let [z1, z2] = [teeth.planet, teeth.planet_to_ring].map(|z| z as f64);
    let nearest = |angle: f64| {
        let off = |planet: &usize| (angle - set.angles_rad[*planet]).cos();
        let planets = 0..set.planets.len();
        planets
            .max_by(|a, b| off(a).total_cmp(&off(b)))
            .unwrap_or(0)
    };
    let mut drawing = Drawing::default();
    // Of stepped planets the larger gear is drawn.
    let mut planet_mm = 0.0_f64;
    if let (Some(z), Some(sun)) = (teeth.sun, &sun) {
        let radius = a_mm * z as f64 / (z as f64 + z1);
        planet_mm = planet_mm.max(a_mm - radius);
        drawing.disc([0.0; 2], [BORE * radius, radius], |angle| {
            sun[nearest(angle)]
        });
    }
    if let (Some(z), Some(ring)) = (teeth.ring, &ring) {
        let radius = a_mm * z as f64 / (z as f64 - z2);
        planet_mm = planet_mm.max(radius - a_mm);
        drawing.disc([0.0; 2], [radius, OUTSIDE * radius], |angle| {
            ring[nearest(angle)]
        });
    }
    let mut picture = FieldPicture::new(
        format!("{}: normal forces of the meshes", set.name),
        "normal force",
        "N",
    );
    for planet in 0..set.planets.len() {
        let at_mm = set.planet_at_m(planet).map(|x| 1e3 * x);
        // The side towards the ring has the ring's force.
        let value = |angle: f64| {
            let outwards = (angle - set.angles_rad[planet]).cos() > 0.0;
            let [own, other] = if outwards {
                [&ring, &sun]
            } else {
                [&sun, &ring]
            };
            own.as_ref().or(other.as_ref()).map_or(0.0, |f| f[planet])
        };
        drawing.disc(at_mm, [BORE * planet_mm, planet_mm], value);
        picture = picture.mark(Mark {
            at_mm,
            words: format!("{}", planet + 1),
            sign: MarkSign::Words,
        });
    }
    Some(
        picture
            .mesh(drawing.nodes_mm, drawing.quads)
            .values(FieldValues::PerElement(drawing.values)),
    )
}
