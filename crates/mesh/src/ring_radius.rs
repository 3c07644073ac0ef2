//! Where the teeth end and the body begins.

use gearmesh_geometry::{Element, GearDefinition};

/// Share of the rim below the ring that tetrahedra leave to the body.
const BELOW_RING: f64 = 0.4;

/// Radius of the circle below which the body begins \[m\]: the rim's inner circle where the rim is thin, otherwise
/// about one and a half modules below the root. It keeps at least half way between the root and what lies inside: bore,
/// openings, and the outline of the shaft that the gear is cut into, whose faces are held while teeth are condensed
/// with nothing held. In a ring the same outwards: one and a half modules from the root, at most half way to the
/// outside.
pub fn ring_radius_m(gear: &GearDefinition) -> f64 {
    let module = gear.tooth.module_m;
    let root = gear.profile.root_radius_m;
    if let Some(rim) = gear.blank.rim() {
        let half_way = 0.5 * (root + rim.outer_radius_m);
        return half_way.min(root + 1.5 * module);
    }
    let default = root - 1.5 * module;
    match gear.blank.web() {
        // Fillets run out into the rim's inner surface: the ring keeps clear of it.
        Some(web) if gear.mesh.element == Element::Tet10 => {
            default.max(web.rim_inner_radius_m + BELOW_RING * (root - web.rim_inner_radius_m))
        }
        Some(web) if web.rim_inner_radius_m > root - 2.5 * module => web.rim_inner_radius_m,
        Some(_) => default,
        None => {
            let shaft = gear.blank.cut_into_shaft().map(|s| s.end_radii_m);
            let openings = gear.blank.openings().map(|o| o.radii_m().1);
            let within = [gear.blank.edge_radius_m()]
                .into_iter()
                .chain(shaft.into_iter().flatten())
                .chain(openings);
            default.max(0.5 * (within.fold(0.0, f64::max) + root))
        }
    }
}
