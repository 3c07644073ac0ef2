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
        section = section.push_all(picture(set));
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
    let is_meshed = found.set.teeth.is_meshed;
    let mut heads = vec![
        "share of the sun meshes",
        "largest",
        "normal force, N",
        "share of the ring meshes",
        "largest",
        "normal force, N",
        "pin force, N",
    ];
    if is_meshed {
        heads.extend([
            "share of the pair meshes",
            "largest",
            "normal force, N",
            "pin force of the partner, N",
        ]);
    }
    table = table.columns(Align::Right, heads);
    for (planet, name) in found.set.planets.iter().enumerate() {
        let of = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), short);
        let of_meshes = |shares: &Option<MeshShares>| {
            let parts = shares
                .as_ref()
                .map(|s| [s.mean[planet], s.largest[planet], s.normal_force_n[planet]]);
            [0, 1, 2].map(|part: usize| of(parts.map(|parts| parts[part])))
        };
        let pin = |forces: &Option<Vec<f64>>| of(forces.as_ref().map(|forces| forces[planet]));
        let mut cells = vec![name.clone()];
        cells.extend([of_meshes(&found.sun), of_meshes(&found.ring)].concat());
        cells.push(pin(&found.pin_force_n));
        if is_meshed {
            cells.extend(of_meshes(&found.pair));
            cells.push(pin(&found.partner_pin_force_n));
        }
        table.push_row(cells);
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

/// The force of the mesh at the nearer of two angles around a planet, or of the one that there is.
fn half(
    one: f64,
    other: f64,
    forces: [&Option<Vec<f64>>; 2],
    planet: usize,
) -> impl Fn(f64) -> f64 {
    let [first, second] = forces.map(|forces| forces.as_ref().map(|forces| forces[planet]));
    move |angle| {
        let is_nearer = (angle - one).cos() > (angle - other).cos();
        let [own, rest] = match is_nearer {
            true => [first, second],
            false => [second, first],
        };
        own.or(rest).unwrap_or(0.0)
    }
}

/// Sun, planets and ring on their pitch circles at the start, each part in the colour of the nearest mesh's force; none
/// where forces are not recorded.
fn picture(found: &SetFigures) -> Option<FieldPicture> {
    let set = &found.set;
    let force = |shares: &Option<MeshShares>| shares.as_ref().map(|s| s.normal_force_n.clone());
    let [sun, pair, ring] = [&found.sun, &found.pair, &found.ring].map(force);
    let forces = [&sun, &pair, &ring].into_iter().flatten().flatten();
    if forces.fold(0.0_f64, |most, force| most.max(*force)) <= 0.0 {
        return None;
    }
    let (teeth, a_mm) = (&set.teeth, 1e3 * set.centre_distance_m);
    let partner_mm = 1e3 * set.partners.distance_m;
    let to_ring_mm = if teeth.is_meshed { partner_mm } else { a_mm };
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
        let radius = to_ring_mm * z as f64 / (z as f64 - z2);
        if !teeth.is_meshed {
            planet_mm = planet_mm.max(radius - a_mm);
        }
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
        let words = format!("{}", planet + 1);
        let angle = set.angles_rad[planet];
        if teeth.is_meshed {
            let partner_at_mm = set.partner_at_m(planet).map(|x| 1e3 * x);
            let [x, y] = [0, 1].map(|i| partner_at_mm[i] - at_mm[i]);
            let pair_mm = x.hypot(y) / (z1 + z2);
            let (to_partner, partner_angle) = (y.atan2(x), angle + set.partners.ahead_rad);
            let of_sun = half(angle + PI, to_partner, [&sun, &pair], planet);
            drawing.disc(at_mm, [BORE * pair_mm * z1, pair_mm * z1], of_sun);
            let of_ring = half(partner_angle, to_partner + PI, [&ring, &pair], planet);
            drawing.disc(partner_at_mm, [BORE * pair_mm * z2, pair_mm * z2], of_ring);
            picture = picture.mark(Mark {
                at_mm: partner_at_mm,
                words: words.clone(),
                sign: MarkSign::Words,
            });
        } else {
            let value = half(angle, angle + PI, [&ring, &sun], planet);
            drawing.disc(at_mm, [BORE * planet_mm, planet_mm], value);
        }
        picture = picture.mark(Mark {
            at_mm,
            words,
            sign: MarkSign::Words,
        });
    }
    Some(
        picture
            .mesh(drawing.nodes_mm, drawing.quads)
            .values(FieldValues::PerElement(drawing.values)),
    )
}
