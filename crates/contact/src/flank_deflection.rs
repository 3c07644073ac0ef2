//! Deflection of one gear's flank under a line load of given width: what `gearmesh compliance` prints.

use crate::local_contact::LocalContact;
use crate::nlcp::ContactBody;
use crate::slice_compliance::SliceCompliance;
use gearmesh_geometry::involute;
use gearmesh_model::{Flank, ReducedGear, ReducedGearError};

/// A uniform line load on one flank of one tooth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlankLoad {
    /// Loaded tooth.
    pub tooth: usize,
    /// Side.
    pub flank: Flank,
    /// Radius of the load \[m\].
    pub radius_m: f64,
    /// Line load \[N/m\].
    pub line_load_n_per_m: f64,
    /// Half width of the Hertz contact \[m\].
    pub half_width_m: f64,
}

/// Deflection along the inward normal, one value a slice \[m\].
#[derive(Debug, Clone, PartialEq)]
pub struct FlankDeflection {
    /// From the reduced model.
    pub global_m: Vec<f64>,
    /// From the local contact; zero on other teeth.
    pub local_m: Vec<f64>,
}

impl FlankDeflection {
    /// Mean over the width: (global, local) \[m\].
    pub fn means_m(&self) -> (f64, f64) {
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        (mean(&self.global_m), mean(&self.local_m))
    }
}

/// Deflection on tooth `at_tooth`, same radius and side, under a line load.
///
/// global = Φᵀ C Φ F with F equal on all slices; local = k q \[ln(2h/a) − ν/(2(1−ν))\], k = 2(1−ν²)/(πE), on the
/// loaded tooth only, where `local` asks for it; h as `local` has it (see [`crate::local_contact`]). The calibrated
/// local part is a correction of the global one and may be negative.
///
/// # Errors
/// [`ReducedGearError::FlankNotReduced`] when the model carries no loads on that side,
/// [`ReducedGearError::NotCalibrated`] when `local` is calibrated and the model is not.
pub fn flank_deflection(
    gear: &ReducedGear,
    load: &FlankLoad,
    at_tooth: usize,
    local: LocalContact,
) -> Result<FlankDeflection, ReducedGearError> {
    let compliance = SliceCompliance::new(gear, load.flank, local)?;
    let roll = involute::roll_angle_rad(load.radius_m, gear.base_radius_m);
    let n = compliance.slices();
    let [loaded, other] = [load.tooth, at_tooth].map(|tooth| compliance.on_tooth(tooth, roll));
    let between = compliance.between(&loaded, &other);
    let force = load.line_load_n_per_m * compliance.slice_width_m();
    let global_m = (0..n)
        .map(|j| (0..n).map(|i| between.value([i, j]) * force).sum())
        .collect();
    let own = match local {
        LocalContact::WeberBanaschek | LocalContact::Calibrated if at_tooth == load.tooth => {
            let body = ContactBody {
                youngs_modulus_pa: gear.young_pa,
                poisson_ratio: gear.poisson,
                depth_m: compliance.local_depth_m(roll, 1.0),
            };
            body.weber_banaschek_m(load.line_load_n_per_m, load.half_width_m)
        }
        _ => 0.0,
    };
    Ok(FlankDeflection {
        global_m,
        local_m: vec![own; n],
    })
}
