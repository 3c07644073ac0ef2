//! Parts of definitions that the made-up gear does not have.

use gearmesh_geometry::microgeometry::{
    EndRelief, FaceEnds, ProfileCrowning, ReliefShape, RootRelief, TipRelief, Topography,
};
use gearmesh_geometry::{
    Blank, Contour, ContourPoint, CrackDefinition, CutIntoShaft, Element, Flank, GearMicrogeometry,
    Gearing, InternalRoot, LengthUnit, Lugs, MeshSettings, MeshedBody, Microgeometry, ModeRange,
    Openings, PinionCutter, Rim, RootPosition, Slots, ToothDefinition, Web,
};
use gearmesh_model::{DataTree, Named, Record, read_record, write_record};
use std::path::Path;

fn read_back<R: Record + Default + Clone>(record: &R) -> R {
    let mut tree = DataTree::default();
    write_record(&mut record.clone(), &mut tree);
    read_record(&mut tree, Path::new("gear.h5"), u32::MAX).unwrap()
}

/// What the synthetic gear does not have.
#[test]
fn rarer_parts_come_back_equal() {
    let arc = ReliefShape::Arc { length_m: 2e-3 };
    let flanks = Microgeometry {
        form_roll_rad: 0.1,
        tip_roll_rad: 0.5,
        face_width_m: 0.02,
        profile_crowning: Some(ProfileCrowning {
            amount_m: 1e-6,
            centre_roll_rad: 0.3,
        }),
        tip_relief: Some(TipRelief {
            amount_m: 2e-6,
            start_roll_rad: 0.4,
            shape: arc,
        }),
        root_relief: Some(RootRelief {
            amount_m: 3e-6,
            start_roll_rad: 0.2,
            shape: ReliefShape::Parabolic,
        }),
        profile_angle_m: 4e-6,
        lead_crowning_m: 5e-6,
        flank_angle_m: -6e-6,
        end_relief: Some(EndRelief {
            amount_m: 7e-6,
            length_m: 1e-3,
            shape: ReliefShape::Linear,
            ends: FaceEnds::Negative,
        }),
        twist_m: 8e-6,
        topography: Topography::new(vec![0.1, 0.2], vec![-1e-3, 0.0, 1e-3], vec![1e-6; 6]).ok(),
    };
    let sides = GearMicrogeometry {
        left: Microgeometry::default(),
        right: flanks,
    };
    assert!(sides.right.topography.is_some());
    assert_eq!(read_back(&sides), sides);
    let blank = Blank::Webbed {
        bore_radius_m: 0.01,
        web: Web {
            hub_radius_m: 0.02,
            rim_inner_radius_m: 0.05,
            thickness_m: 0.006,
            offset_m: -0.001,
        },
        contour: Some(Contour {
            hub_z_m: [-0.01, 0.012],
            web: vec![
                ContourPoint {
                    radius_m: 0.02,
                    z_m: [-0.003, 0.003],
                    fillet_radius_m: 0.001,
                },
                ContourPoint {
                    radius_m: 0.05,
                    z_m: [-0.004, 0.005],
                    fillet_radius_m: 0.0,
                },
            ],
        }),
        openings: Some(Openings::Slots(Slots {
            count: 3,
            inner_radius_m: 0.03,
            outer_radius_m: 0.04,
            width_rad: 1.2,
            phase_rad: 0.1,
            corner_radius_m: 0.002,
        })),
    };
    assert_eq!(read_back(&blank), blank);
    let meshed = Blank::Meshed {
        bore_radius_m: 0.01,
        body: MeshedBody {
            file: "body.msh".into(),
            length_unit: LengthUnit::Metre,
            bore_set: "bore".into(),
            flank_sets: "{tooth} {side}".into(),
        },
    };
    assert_eq!(read_back(&meshed), meshed);
    assert_eq!(read_back(&Blank::solid(0.02)), Blank::solid(0.02));
    let cut = Blank::CutIntoShaft(CutIntoShaft {
        hole_radius_m: 5e-4,
        end_radii_m: [0.0, 0.015],
    });
    assert_eq!(read_back(&cut), cut);
    let lugs = Lugs {
        count: 6,
        width_rad: 0.1,
        phase_rad: 0.2,
    };
    for (held_z_m, lugs) in [(None, None), (Some([-4e-3, 2e-3]), Some(lugs))] {
        let ring = Blank::Ring(Rim {
            outer_radius_m: 0.06,
            held_z_m,
            lugs,
        });
        assert_eq!(read_back(&ring), ring);
    }
    let cutter = PinionCutter {
        teeth: 33,
        profile_shift: 0.1,
        addendum: 1.25,
        tip_radius: 0.2,
    };
    for root in [InternalRoot::FullRound, InternalRoot::Cutter(cutter)] {
        let teeth = ToothDefinition {
            teeth: 99,
            gearing: Gearing::Internal(root),
            ..ToothDefinition::default()
        };
        assert_eq!(read_back(&teeth), teeth);
    }
    let crack = CrackDefinition {
        tooth: 4,
        side: Flank::Left,
        start: RootPosition::Radius(0.04),
        depth_m: 1e-3,
        angle_rad: 0.8,
    };
    assert_eq!(read_back(&crack), crack);
    for range in [ModeRange::Count(7), ModeRange::UpToHz(5e3)] {
        assert_eq!(read_back(&range), range);
    }
    for (element, _) in Element::NAMES {
        let mesh = MeshSettings {
            element: *element,
            plane_strain: true,
            ..MeshSettings::default()
        };
        assert_eq!(read_back(&mesh), mesh);
    }
}

#[test]
fn what_does_not_go_together_is_named() {
    let mut tree = DataTree::default();
    let mut relief = TipRelief {
        shape: ReliefShape::Arc { length_m: 1e-3 },
        ..TipRelief::default()
    };
    write_record(&mut relief, &mut tree);
    tree.put_text("shape", "linear");
    let read = |tree: &DataTree| {
        let path = Path::new("gear.h5");
        read_record::<TipRelief>(&mut tree.clone(), path, u32::MAX).unwrap_err()
    };
    let message = read(&tree).to_string();
    assert!(
        message.contains("arc_length") && message.contains("gear.h5"),
        "{message}"
    );
    tree.put_text("shape", "bent");
    let message = read(&tree).to_string();
    assert!(
        message.contains("\"bent\"; known are linear, parabolic, arc"),
        "{message}"
    );
}
