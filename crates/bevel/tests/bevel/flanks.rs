//! Flanks from machine settings.

use gearmesh_bevel::tooth::{pressure_angle_rad, spiral_angle_rad};
use gearmesh_bevel::{
    BevelError, FaceMill, Flank, FlankSide, Hand, Located, MachineSettings, MemberBlank, PairData,
    Process, Roll, ThicknessFrom, Tool, Tooth, ToothForm, basic_settings, crown_settings,
};

use crate::common::{blank, data_13_35, data_20_20, near};

const EDGE: f64 = 0.5e-3;

/// All flanks of both pairs, generated and formate, with roll modified and the work displaced.
fn flanks() -> Vec<Flank> {
    let mut list = Vec::new();
    for data in [data_20_20(), data_13_35()] {
        let pair = blank(&data);
        for (i, member) in pair.members.iter().enumerate() {
            for process in [Process::Generated, Process::Formate] {
                if i == 0 && process == Process::Formate {
                    continue;
                }
                let settings = basic_settings(member, &data, EDGE, process).unwrap();
                for (side, mut s) in FlankSide::BOTH.into_iter().zip(settings) {
                    list.push(Flank::cut(member, side, &s).unwrap());
                    s.offset_m = 1e-3;
                    s.work_offset_m = -0.7e-3;
                    s.sliding_base_m += 0.4e-3;
                    if let Some(roll) = &mut s.roll {
                        roll.modified = [0.02, -0.03, 0.05];
                    }
                    list.push(Flank::cut(member, side, &s).unwrap());
                }
            }
        }
        list.push(
            Flank::cut(
                &pair.members[0],
                FlankSide::Convex,
                &crown_settings(
                    &pair.members[0],
                    &PairData {
                        form: ToothForm::Straight,
                        spiral_angle_rad: 0.0,
                        ..data
                    },
                    FlankSide::Convex,
                    EDGE,
                ),
            )
            .unwrap(),
        );
    }
    list
}

fn places(flank: &Flank) -> Vec<[f64; 2]> {
    let b = &flank.blank;
    let mut list = Vec::new();
    for i in 0..5 {
        let cone = b.inner_cone_m() + b.face_width_m * i as f64 / 4.0;
        let (low, high) = (
            flank.place(&flank.bottom(cone).unwrap().point.r)[1],
            b.addendum_m(cone),
        );
        for k in 0..4 {
            list.push([cone, low + (high - low) * k as f64 / 3.0]);
        }
    }
    list
}

#[test]
fn the_envelope_meets_the_equation_of_meshing() {
    let mut most = 0.0f64;
    for flank in flanks() {
        for [cone, height] in places(&flank) {
            let Located { at, point } = flank.locate(cone, height).unwrap();
            let found = flank.place(&point.r);
            near(found[0], cone, 1e-13);
            near(found[1], height, 1e-13);
            most = most.max(
                flank
                    .cut_surface()
                    .unwrap()
                    .envelope_residual(at[0], at[1])
                    .unwrap()
                    .abs(),
            );
        }
    }
    assert!(most < 1e-10, "{most:e}");
}

/// Tangents, normals and second derivatives against central differences of places; normals stand on both tangents,
/// which holds on an envelope only.
#[test]
fn derivatives_and_normals_agree_with_finite_differences() {
    for flank in flanks() {
        for [cone, height] in places(&flank) {
            let Located { at, point } = flank.locate(cone, height).unwrap();
            let mut differences = [nalgebra::Vector3::zeros(); 2];
            for i in 0..2 {
                let h = if point.dr[i].norm() > 0.5 { 1e-7 } else { 1e-5 };
                let shifted = |by: f64| {
                    let mut p = at;
                    p[i] += by;
                    flank.point(p).unwrap()
                };
                let (up, down) = (shifted(h), shifted(-h));
                differences[i] = (up.r - down.r) / (2.0 * h);
                let size = point.dr[i].norm();
                near((differences[i] - point.dr[i]).norm() / size, 0.0, 1e-6);
                for j in 0..2 {
                    let second = (up.dr[j] - down.dr[j]) / (2.0 * h);
                    near(
                        (second - point.ddr[i + j]).norm() / (size + point.ddr[i + j].norm()),
                        0.0,
                        1e-5,
                    );
                }
                let turn = (up.n - down.n) / (2.0 * h);
                near(
                    (turn - point.dn[i]).norm() / (1.0 + point.dn[i].norm()),
                    0.0,
                    1e-6,
                );
                near(point.n.dot(&point.dr[i]) / size, 0.0, 1e-12);
            }
            let normal = differences[0].cross(&differences[1]).normalize();
            let sign = normal.dot(&point.n).signum();
            near((normal * sign - point.n).norm(), 0.0, 1e-6);
            // The curvature tensor is symmetric, and lies in the tangent plane.
            let k = point.curvature();
            near((k - k.transpose()).norm() / k.norm(), 0.0, 1e-9);
            near((k * point.n).norm() / k.norm(), 0.0, 1e-9);
        }
    }
}

/// At the mean point: pressure angle exactly, spiral angle of the middle of the slot between those of both sides;
/// normals point into the tooth.
#[test]
fn basic_settings_give_the_angles_of_the_blank() {
    for data in [data_20_20(), data_13_35()] {
        for member in &blank(&data).members {
            let tooth = Tooth::cut(
                member,
                &basic_settings(member, &data, EDGE, Process::Generated).unwrap(),
                None,
            )
            .unwrap();
            let spiral: Vec<f64> = tooth
                .flanks
                .iter()
                .map(|f| spiral_angle_rad(f, f.mean()).to_degrees())
                .collect();
            near(
                0.5 * (spiral[0] + spiral[1]),
                35.0 * member.hand.sign(),
                0.1,
            );
            for flank in &tooth.flanks {
                // The mean point of a flank is cut half a slot beside the middle of the machine.
                near(
                    pressure_angle_rad(flank, flank.mean()).to_degrees(),
                    20.0,
                    0.15,
                );
                let facing = flank.side.facing(member.hand);
                assert!(flank.mean().point.n.y * facing < 0.0, "{}", flank.name());
            }
            // The tooth's trace bends round the cutter: hollow on the concave side.
            let along = |f: &Flank| {
                let p = &f.mean().point;
                let t = p.tangents(&nalgebra::Vector3::new(
                    member.pitch_angle_rad.sin(),
                    0.0,
                    member.pitch_angle_rad.cos(),
                ))[0];
                t.dot(&(p.curvature() * t))
            };
            assert!(along(&tooth.flanks[0]) < 0.0 && along(&tooth.flanks[1]) > 0.0);
            // A spread blade leaves its own point width at the bottom of every slot.
            let [outside, inside] = [0, 1].map(|i| {
                tooth.flanks[i]
                    .cut_surface()
                    .unwrap()
                    .settings
                    .face_mill()
                    .unwrap()
                    .point_radius_m
            });
            for cone in [
                member.inner_cone_m(),
                member.mean_cone_m,
                member.outer_cone_m,
            ] {
                near(
                    tooth.slot_width_m(cone).unwrap().unwrap().point_m / (outside - inside),
                    1.0,
                    0.02,
                );
            }
            tooth.check(0.0, 0.0).unwrap();
        }
    }
}

/// Mirror of hand: settings and blank of the other hand give the mirror image. Mirror of unit: a pair ten times as
/// large is ten times as large.
#[test]
fn hands_are_mirror_images_and_units_scale() {
    for data in [data_20_20(), data_13_35()] {
        for (i, member) in blank(&data).members.iter().enumerate() {
            let other = MemberBlank {
                hand: member.hand.mate(),
                ..member.clone()
            };
            let large = blank(&PairData {
                outer_module_m: 10.0 * data.outer_module_m,
                face_width_m: data.face_width_m.map(|b| 10.0 * b),
                cutter_radius_m: 10.0 * data.cutter_radius_m,
                ..data.clone()
            })
            .members[i]
                .clone();
            let settings = basic_settings(member, &data, EDGE, Process::Generated).unwrap();
            let scaled = basic_settings(
                &large,
                &PairData {
                    cutter_radius_m: 10.0 * data.cutter_radius_m,
                    ..data.clone()
                },
                10.0 * EDGE,
                Process::Generated,
            )
            .unwrap();
            for (k, side) in FlankSide::BOTH.into_iter().enumerate() {
                let mut s = settings[k];
                s.offset_m = 0.5e-3;
                s.roll = s.roll.map(|roll| Roll {
                    modified: [0.01, 0.02, 0.03],
                    ..roll
                });
                let mut t = scaled[k];
                t.offset_m = 5e-3;
                t.roll = s.roll;
                let flank = Flank::cut(member, side, &s).unwrap();
                let mirrored = Flank::cut(&other, side, &s.mirrored()).unwrap();
                let large = Flank::cut(&large, side, &t).unwrap();
                for [cone, height] in places(&flank) {
                    let p = flank.locate(cone, height).unwrap().point;
                    let q = mirrored.locate(cone, height).unwrap().point;
                    near(
                        (p.r - nalgebra::Vector3::new(q.r.x, -q.r.y, q.r.z)).norm(),
                        0.0,
                        1e-13,
                    );
                    near(
                        (p.n - nalgebra::Vector3::new(q.n.x, -q.n.y, q.n.z)).norm(),
                        0.0,
                        1e-11,
                    );
                    let q = large.locate(10.0 * cone, 10.0 * height).unwrap().point;
                    near((10.0 * p.r - q.r).norm(), 0.0, 1e-12);
                }
            }
        }
    }
}

/// The gear of a published 38/51 pair (docs/theory/bevel_gears.md): its printed settings give a left-hand gear whose
/// root cone and depth are those printed.
#[test]
fn printed_settings_of_a_gear_of_51_teeth() {
    let mm = 1e-3;
    let gamma = (51.0f64 / 38.0).atan();
    near(gamma.to_degrees(), 53.3103, 1e-4);
    let delta = 2.181757f64.to_radians();
    let outer = 0.5 * 3.8 * mm * 51.0 / gamma.sin();
    near(outer / mm - 11.0, 109.8406, 1e-4);
    let member = MemberBlank {
        name: "gear",
        teeth: 51,
        hand: Hand::Left,
        pitch_angle_rad: gamma,
        face_angle_rad: gamma + 2f64.to_radians(),
        root_angle_rad: gamma - delta,
        outer_addendum_m: 2.57070 * mm,
        outer_dedendum_m: 4.60370 * mm,
        face_width_m: 22.0 * mm,
        outer_cone_m: outer,
        mean_cone_m: outer - 11.0 * mm,
        mean_thickness_m: 0.5 * std::f64::consts::PI * 3.8 * mm * (1.0 - 11.0 * mm / outer),
    };
    near(member.root_angle_rad.to_degrees(), 51.1285, 1e-4);
    let settings = |point: f64, angle: f64| MachineSettings {
        tool: Tool::FaceMill(FaceMill {
            point_radius_m: point * mm,
            blade_angle_rad: angle.to_radians(),
            edge_radius_m: 1.0 * mm,
            radial_m: 95.559965 * mm,
            cradle_angle_rad: -54.735452f64.to_radians(),
        }),
        root_angle_rad: 51.1285f64.to_radians(),
        sliding_base_m: 0.0,
        offset_m: 0.0,
        work_offset_m: 0.0,
        roll: Some(Roll::constant(1.0 / 0.802465)),
    };
    let tooth = Tooth::cut(
        &member,
        &[settings(96.265, 18.0), settings(94.235, 22.0)],
        None,
    )
    .unwrap();
    tooth.check(0.0, 0.0).unwrap();
    for flank in &tooth.flanks {
        // Hand and spiral angle.
        near(
            spiral_angle_rad(flank, flank.mean()).to_degrees(),
            -35.0,
            1.0,
        );
        // Where the fillet ends: on the root cone, at the printed depth.
        let lowest = |cone: f64| flank.place(&flank.root(cone).unwrap().point.r);
        let (toe, heel) = (lowest(member.inner_cone_m()), lowest(outer));
        for [cone, height] in [toe, heel] {
            near(-height / mm, member.dedendum_m(cone) / mm, 2e-3);
        }
        let angle = ((toe[1] - heel[1]) / (heel[0] - toe[0])).atan();
        near(angle.to_degrees(), 2.181757, 1e-3);
    }
}

/// The fillet goes on where the flank ends: same place, same normal.
#[test]
fn the_fillet_joins_the_flank_smoothly() {
    let mut joined = 0;
    for flank in flanks() {
        let settings = flank.cut_surface().unwrap().settings;
        if settings.roll.is_none() || settings.face_mill().is_none() {
            continue;
        }
        let at = flank.bottom(flank.blank.mean_cone_m).unwrap().at;
        let (p, q) = (flank.point(at).unwrap(), flank.fillet(at).unwrap());
        near((p.r - q.r).norm(), 0.0, 1e-12);
        near((p.n - q.n).norm(), 0.0, 1e-9);
        // The fillet ends with its normal across the machine plane.
        let root = flank.root(flank.blank.mean_cone_m).unwrap().point;
        near(root.n.z, settings.root_angle_rad.sin(), 1e-9);
        joined += 1;
    }
    assert!(joined >= 12, "{joined}");
}

#[test]
fn bad_teeth_are_refused_with_their_place() {
    // Undercut: eight teeth without addendum modification, deep roots.
    let data = PairData {
        teeth: [8, 8],
        face_width_m: [6e-3; 2],
        ..data_20_20()
    };
    let pair = blank(&data);
    let settings = basic_settings(&pair.members[0], &data, 0.1e-3, Process::Generated).unwrap();
    let error = Tooth::cut(&pair.members[0], &settings, Some(ThicknessFrom::Blank))
        .unwrap()
        .check(0.0, 0.0)
        .unwrap_err();
    assert!(
        matches!(error, BevelError::Undercut { cone_mm, .. } if (cone_mm - 1e3 * pair.members[0].inner_cone_m()).abs() < 1e-9),
        "{error}"
    );
    // Pointed: the teeth of seed 001 made thin.
    let data = data_20_20();
    let mut member = blank(&data).members[0].clone();
    let settings = basic_settings(&member, &data, EDGE, Process::Generated).unwrap();
    member.mean_thickness_m *= 0.5;
    let error = Tooth::cut(&member, &settings, Some(ThicknessFrom::Blank))
        .unwrap()
        .check(0.0, 0.0)
        .unwrap_err();
    assert!(matches!(error, BevelError::Pointed { .. }), "{error}");
    // A blade wider than the slot's bottom.
    let member = blank(&data).members[0].clone();
    let tooth = Tooth::cut(&member, &settings, Some(ThicknessFrom::Blank)).unwrap();
    let slot = tooth.check(0.0, 0.0).unwrap().least_slot_m.unwrap();
    tooth.check(0.0, 0.9 * slot).unwrap();
    let error = tooth.check(0.0, 1.1 * slot).unwrap_err();
    assert!(matches!(error, BevelError::BladeTooWide { .. }), "{error}");
    // No flank: the cutter does not reach the blank.
    let mut far = settings[0];
    far.tool = Tool::FaceMill(FaceMill {
        radial_m: 1.0,
        ..*far.face_mill().unwrap()
    });
    assert!(matches!(
        Flank::cut(&member, FlankSide::Concave, &far),
        Err(BevelError::NoFlankPoint { .. })
    ));
}

/// A formate gear of 35 teeth: whether the pinion of 13 is undercut at its toe depends on the contact that is asked
/// for.
#[test]
fn the_mate_of_a_formate_gear_is_undercut_by_what_is_asked() {
    let path = format!(
        "{}/../../fe_models/bevel_13_35.toml",
        env!("CARGO_MANIFEST_DIR")
    );
    let text = std::fs::read_to_string(path).unwrap();
    let text = text.replacen("settings = \"basic\"", "settings = \"formate\"", 1);
    let checked = |text: String| {
        let document = gearmesh_geometry::input::InputDocument::new("pair.toml", text);
        let file = gearmesh_bevel::PairFile::from_document(&document).unwrap();
        let member = &file.members[0];
        let design = file.design().unwrap();
        design.teeth[0].check(member.least_top_land_m, member.point_width_m)
    };
    let error = checked(text.clone()).unwrap_err();
    assert!(
        matches!(error, BevelError::Undercut { height_mm, .. } if (-0.6..-0.3).contains(&height_mm)),
        "{error}"
    );
    let along_the_profile = text
        .replacen(
            "path_angle_deg = [100.0, 80.0]",
            "path_angle_deg = [90.0, 90.0]",
            1,
        )
        .replacen("[8.0, 8.0]", "[12.0, 12.0]", 1);
    assert!(checked(along_the_profile).is_ok());
}
