//! What is said of pressures beyond what steel carries elastically, in commands that print columns of figures.

use crate::console;
use gearmesh_scene::pair::warnings::ELASTIC_SHARE;

/// Young's modulus of steel \[Pa\]: columns of pressure do not say whose it is.
const STEEL_PA: f64 = 206e9;

/// Warns of the column with the largest pressure, where that is above the limit. `columns`: names and largest pressures
/// \[Pa\].
pub fn warn(columns: impl Iterator<Item = (String, f64)>) {
    let limit_pa = ELASTIC_SHARE * STEEL_PA;
    let too_large = columns.filter(|(_, pa)| *pa > limit_pa);
    if let Some((name, pa)) = too_large.max_by(|a, b| a.1.total_cmp(&b.1)) {
        console::warning(format!(
            "{name}: the pressure reaches {:.2} GPa; above {} % of Young's modulus, {:.2} GPa for steel, the material yields, and the elastic contact \
             computed here no longer holds",
            1e-9 * pa,
            100.0 * ELASTIC_SHARE,
            1e-9 * limit_pa
        ));
    }
}
