//! How thick a tooth is by the azimuths of its two tables of points, beside the blank: the only thing by which a wrong
//! origin on the axis shows that is not in the flanks' form. Derivation: docs/theory/bevel_gears.md, "Flanks from
//! points".

use std::f64::consts::TAU;

use crate::tooth::Tooth;

/// A difference above this share of the mean normal module is reported.
const MOST_OFF: f64 = 0.05;
/// So far along the axis an origin is sought, in mean normal modules.
const REACH: f64 = 1.5;

/// Thickness of a tooth along the circle, on the pitch cone at the mean cone distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TableThickness {
    /// By the tables \[m\].
    pub found_m: f64,
    /// By the blank, which is what is used \[m\].
    pub blank_m: f64,
    /// By how much the tables' origin would have to lie farther towards the heel for both to agree \[m\]; none where no
    /// move of up to one and a half modules does it.
    pub origin_m: Option<f64>,
    /// Whether the difference is more than a twentieth of the mean normal module.
    pub is_doubtful: bool,
}

impl Tooth {
    /// The thickness by the tables of both flanks; none of flanks that were cut. Teeth are taken to be the same,
    /// whichever of them each table is of.
    pub fn table_thickness(&self, mean_normal_module_m: f64) -> Option<TableThickness> {
        let blank = &self.blank;
        let radius = blank.mean_cone_m * blank.pitch_angle_rad.sin();
        let pitch = TAU / blank.teeth as f64;
        let (sin, cos) = blank.pitch_angle_rad.sin_cos();
        let azimuths = [0, 1].map(|i: usize| self.flanks[i].table_azimuth_rad());
        let [Some(a), Some(b)] = azimuths else {
            return None;
        };
        // The tables moved along the axis: what stands at the mean place then stood elsewhere on the flank.
        let thickness = |origin_m: f64| -> Option<f64> {
            let mut angle = 0.0;
            for (flank, azimuth) in self.flanks.iter().zip([a, b]) {
                let place = [blank.mean_cone_m - origin_m * cos, origin_m * sin];
                let r = flank.locate(place[0], place[1]).ok()?.point.r;
                let sense = flank.side.facing(blank.hand);
                angle += sense * (azimuth + r.y.atan2(r.x));
            }
            Some(radius * angle.rem_euclid(pitch))
        };
        let blank_m = blank.mean_thickness_m;
        let found_m = thickness(0.0)?;
        let circle = radius * pitch;
        // Differences over the circle: a tooth that lacks as much as the slot has.
        let off = |origin_m: f64| {
            let d = thickness(origin_m)? - blank_m;
            Some(d - circle * (d / circle).round())
        };
        let mut origin_m = Some(0.0);
        let step = 1e-3 * mean_normal_module_m;
        for _ in 0..20 {
            origin_m = origin_m.and_then(|at| {
                let slope = (off(at + step)? - off(at - step)?) / (2.0 * step);
                let next = at - off(at)? / slope;
                (next.abs() <= REACH * mean_normal_module_m).then_some(next)
            });
        }
        let origin_m = origin_m.filter(|at| off(*at).is_some_and(|d| d.abs() < 1e-7));
        Some(TableThickness {
            found_m,
            blank_m,
            origin_m,
            is_doubtful: off(0.0)?.abs() > MOST_OFF * mean_normal_module_m,
        })
    }
}
