//! Speeds that stay over what of a recorded motion is judged: lines at mesh orders mean something there.

use super::bodies::Bodies;
use super::carriers::Holds;
use super::gear_mesh::PreparedMesh;
use super::joints::PlacedMotion;
use super::start_speeds::settle_speeds;
use crate::system::SystemScene;
use gearmesh_specification::system::run::Run;

/// The bodies at these speeds, from bodies whose speeds nothing holds; none where a motion changes its speed from the
/// begin of the statistics to the end, and of runs that are not recorded in time.
pub(super) fn find(
    scene: &SystemScene,
    free: &Bodies,
    holds: Holds<'_>,
    (motions, meshes): (&[PlacedMotion], &[PreparedMesh]),
) -> Option<Bodies> {
    let Run::Transient { end_s } = scene.run else {
        return None;
    };
    let judged_s = [scene.output.statistics_begin_s(end_s), end_s];
    let steady_of = |motion: &PlacedMotion| motion.steady_spin(judged_s);
    let mut spins = motions.iter().filter_map(steady_of);
    if !spins.all(f64::is_finite) {
        return None;
    }
    let mut steady = free.clone();
    settle_speeds(
        &mut steady,
        holds,
        (motions, &steady_of),
        meshes,
        &mut Vec::new(),
    );
    Some(steady)
}
