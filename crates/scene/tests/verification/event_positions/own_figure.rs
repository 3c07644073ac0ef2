//! A figure of a pair at rest that is no row of the table: the ripple of the mesh stiffness over its mean.

use gearmesh_scene::SceneResult;
use gearmesh_scene::pair::figure_table::{Audience, FigureKind, RestFigure};

pub const RIPPLE: RestFigure = RestFigure {
    name: "stiffness_ripple",
    words: "stiffness ripple",
    kind: FigureKind::Factor,
    audience: Audience::All,
    of: |f| f.tangent_peak_to_peak_n_per_m / f.tangent_mean_n_per_m,
};

/// Its heading, its text under the first torque, and its names in files and studies.
pub fn at_the_doors(result: &SceneResult) -> [String; 4] {
    let over = result.overlap_width_m().ok();
    [
        RIPPLE.heading(over),
        RIPPLE.text(&result.figures(0), over),
        RIPPLE.name_in_files(),
        RIPPLE.name_in_studies(),
    ]
}
