//! The figures of a pair at rest for people.

use gearmesh_scene::SceneResult;
use gearmesh_scene::pair::PairFigures;

use crate::failure::Failure;
use crate::{periods, ratings};

/// The curves' figures for people.
pub fn table(result: &SceneResult) -> Result<Vec<String>, Failure> {
    let mut lines = vec![
        format!("{}: {} positions per torque", result.title, result.angles()),
        format!(
            "{:>10} {:>12} {:>12} {:>16} {:>17} {:>8} {:>12} {:>12} {:>9}",
            "torque N m",
            "TE mean um",
            "TE pk-pk um",
            "secant N/(mm um)",
            "tangent N/(mm um)",
            "K_Hbeta",
            "p_H max MPa",
            "balance",
            "iter/pos"
        ),
    ];
    let mark = periods::mark(&result.contact_coverage);
    let width_mm = 1e3 * result.overlap_width_m()?;
    let figures: Vec<PairFigures> = (0..result.torque_nm.len())
        .map(|k| result.figures(k))
        .collect();
    for (k, f) in figures.iter().enumerate() {
        let per_width = |stiffness: f64| stiffness / width_mm * 1e-6;
        lines.push(format!(
            "{:>10.1} {:>12.4} {:>12.4} {:>16.4} {:>17.4} {:>8.4} {:>12.1} {:>12.1e} {:>9.2}{mark}",
            f.torque_nm,
            f.te_mean_m * 1e6,
            f.te_peak_to_peak_m * 1e6,
            per_width(f.secant_mean_n_per_m),
            per_width(f.tangent_mean_n_per_m),
            f.k_h_beta,
            f.pressure_largest_pa * 1e-6,
            result.torque_balance[k],
            f64::from(result.iterations[k]) / result.angles() as f64
        ));
    }
    lines.push(result.means_over());
    lines.push(format!("errors: {}", result.errors_in_words()));
    if result.has_axial_force() {
        lines.push(format!(
            "{:>10} {:>22} {:>24}",
            "torque N m", "axial force gear 1 N", "axial over normal force"
        ));
        for f in &figures {
            lines.push(format!(
                "{:>10.1} {:>22.3} {:>24.6}{mark}",
                f.torque_nm,
                f.axial_force_1_mean_n,
                f.axial_force_1_mean_n / f.normal_force_mean_n
            ));
        }
    }
    lines.push(format!(
        "contact {:.3} s ({:.1} us a position), strain {:.3} s",
        result.seconds[0],
        1e6 * result.seconds[0] / (result.angles() * result.torque_nm.len()) as f64,
        result.seconds[1]
    ));
    lines.extend(periods::lines(result));
    lines.extend(ratings::lines(&result.ratings));
    Ok(lines)
}
