//! Smooth patches against the surfaces that they stand for.

use gearmesh_bevel::{FlankPatch, FlankSide, PairFile};
use nalgebra::Vector3;

/// Points of a patch lie on the flank to 1 nm, normals are the flank's, and derivatives are those of the points.
#[test]
fn patches_are_the_flanks() {
    for name in ["bevel_20_20.toml", "bevel_13_35.toml", "bevel_31_36.toml"] {
        let path = format!("{}/../../fe_models/{name}", env!("CARGO_MANIFEST_DIR"));
        let file = PairFile::read(path.as_ref()).unwrap();
        let design = file.design().unwrap();
        for (m, tooth) in design.teeth.iter().enumerate() {
            for side in FlankSide::BOTH {
                let mate = &file.blank.members[1 - m];
                let patch = FlankPatch::of_tooth(tooth, mate, side).unwrap();
                let flank = tooth.flank(side);
                let (turn_sin, turn_cos) = tooth.half_angle_rad(side).sin_cos();
                let turned = |v: Vector3<f64>| {
                    Vector3::new(
                        v.x * turn_cos - v.y * turn_sin,
                        v.x * turn_sin + v.y * turn_cos,
                        v.z,
                    )
                };
                let mut worst = [0.0f64; 2];
                for i in 0..=10 {
                    for k in 0..=10 {
                        let at = [0.1 * f64::from(i), 0.1 * f64::from(k)];
                        let [cone, height] = patch.place_m(at);
                        let exact = flank.locate(cone, height).unwrap().point;
                        let found = patch.point(at);
                        worst[0] = worst[0].max((found.r - turned(exact.r)).norm());
                        worst[1] = worst[1].max((found.n - turned(exact.n)).norm());
                    }
                }
                // Worst at the lower end of concave flanks, close to which the envelope turns back; convex ones 1e-13
                // m.
                assert!(worst[0] < 1e-9, "{name} {m} {side:?}: {:e} m", worst[0]);
                assert!(worst[1] < 1e-4, "{name} {m} {side:?}: {:e}", worst[1]);
                check_cells(&patch);
                let (at, h) = ([0.37, 0.61], 1e-5);
                let here = patch.point(at);
                for k in 0..2 {
                    let moved = |by: f64| {
                        let mut at = at;
                        at[k] += by;
                        patch.point(at)
                    };
                    let [a, b] = [moved(h), moved(-h)];
                    let slope = |f: fn(&gearmesh_bevel::PatchPoint) -> Vector3<f64>| {
                        (f(&a) - f(&b)) / (2.0 * h)
                    };
                    let near = |found: Vector3<f64>, expected: Vector3<f64>| {
                        let off = (found - expected).norm() / expected.norm();
                        assert!(off < 1e-6, "{name} {m} {side:?} {k}: {off:e}");
                    };
                    near(slope(|p| p.r), here.dr[k]);
                    near(slope(|p| p.dr[0]), here.ddr[k]);
                    near(slope(|p| p.dr[1]), here.ddr[k + 1]);
                    near(slope(|p| p.n), here.dn[k]);
                }
            }
        }
    }
}

/// Eight teeth on 48, no undercut but close to it: the pinion has no surface 0.03 mm below its fillets' beginning,
/// which bows by 0.08 mm. Its patch ends there. It comes so close to the turn of the envelope that polynomials follow
/// less well: 0.03 um at that end, 5 nm above.
#[test]
fn patches_end_where_the_flank_does() {
    let path = format!(
        "{}/../../fe_models/bevel_8_48.toml",
        env!("CARGO_MANIFEST_DIR")
    );
    let file = PairFile::read(path.as_ref()).unwrap();
    let tooth = &file.design().unwrap().teeth[0];
    let [gear, blank] = [&file.blank.members[1], &tooth.blank];
    for side in FlankSide::BOTH {
        let flank = tooth.flank(side);
        let patch = FlankPatch::of_tooth(tooth, gear, side).unwrap();
        let (sin, cos) = tooth.half_angle_rad(side).sin_cos();
        for i in 0..=20 {
            let s = 0.05 * f64::from(i);
            let [cone, low] = patch.place_m([s, 0.0]);
            let end = flank.bottom(cone).unwrap().point.r;
            let [_, end] = blank.cone_place(end.z, end.x.hypot(end.y));
            assert!((low - end).abs() < 2e-7, "{side:?} {s}: {:e} m", low - end);
            for (v, most_m) in [(0.0, 6e-8), (0.1, 1e-8), (0.4, 3e-9), (1.0, 3e-9)] {
                let [cone, height] = patch.place_m([s, v]);
                let r = flank.locate(cone, height).unwrap().point.r;
                let turned = Vector3::new(r.x * cos - r.y * sin, r.x * sin + r.y * cos, r.z);
                let found = patch.point([s, v]);
                let off = (found.r - turned).norm();
                assert!(off < most_m, "{side:?} {s} {v}: {off:e} m");
                // Derivatives are those of the points, along the bow as well.
                let h = 1e-5;
                let [a, b] = [h, -h].map(|by| patch.point([s + by, v]));
                let off = ((a.r - b.r) / (2.0 * h) - found.dr[0]).norm() / found.dr[0].norm();
                assert!(off < 1e-6, "{side:?} {s} {v}: {off:e}");
                let off =
                    ((a.dr[0] - b.dr[0]) / (2.0 * h) - found.ddr[0]).norm() / found.ddr[0].norm();
                assert!(off < 1e-5, "{side:?} {s} {v}: {off:e}");
            }
        }
    }
}

/// The polynomials of cells are the series of the whole patch: places to far below a picometre, with the derivatives
/// that tangents need.
fn check_cells(patch: &FlankPatch) {
    let [[s_low, s_high], [v_low, v_high]] = *patch.domain();
    let mut worst = [0.0f64; 3];
    for i in 0..=100 {
        for k in 0..=200 {
            let at = [
                s_low + (s_high - s_low) * f64::from(i) / 100.0,
                v_low + (v_high - v_low) * f64::from(k) / 200.0,
            ];
            for (worst, off) in worst.iter_mut().zip(patch.azimuth_misfit(at)) {
                *worst = worst.max(off);
            }
        }
    }
    assert!(worst[0] < 1e-13, "{worst:?} rad, and per s and v");
    assert!(worst[1] < 1e-10 && worst[2] < 1e-7, "{worst:?}");
}
