//! How long the lines are along which a pair touches.

use gearmesh_geometry::GearPair;

/// Shortest total length \[m\] over the mesh cycle of all lines along which unmodified flanks of the common width b
/// touch (AGMA 908-B89, load sharing ratio). With the fractional parts n_r of ε_α and n_a of ε_β and the axial pitch
/// p_x = b/ε_β:
///
/// ```text
/// L = (ε_α b − n_a n_r p_x)/cos β_b                  n_a ≤ 1 − n_r
/// L = (ε_α b − (1 − n_a)(1 − n_r) p_x)/cos β_b       n_a > 1 − n_r
/// ```
///
/// Spur teeth: b times the whole part of ε_α, which is the limit β → 0. Where ε_α or ε_β is a whole number the length
/// does not change: b ε_α/cos β_b.
pub fn shortest_contact_length_m(pair: &GearPair, face_width_m: f64) -> f64 {
    let overlap = pair.overlap_ratio(face_width_m);
    let contact = pair.contact_ratio();
    if overlap == 0.0 {
        return face_width_m * contact.floor();
    }
    let (n_r, n_a) = (contact.fract(), overlap.fract());
    let missing = if n_a <= 1.0 - n_r {
        n_a * n_r
    } else {
        (1.0 - n_a) * (1.0 - n_r)
    };
    face_width_m * (contact - missing / overlap) / pair.base_helix_angle_rad().cos()
}
