//! Two gears whose flanks are nodes and patches: pairs of teeth by bounding boxes, the nodes of gear 1's flanks as
//! contacts.
//!
//! A node of gear 1 stands at x in gear 1's frame, gear 2's origin at d there; with N the normal of the patch, out of
//! gear 1's flank into gear 2's, and
//! r = x − d,
//!
//! ```text
//! gradient of the gap G = (N, r × N)      friction k = (t, r × t)
//! ∂N = ϑ × N,   ∂r = −δu                  the patch turns with gear 2, the node stays with gear 1
//! ```
//!
//! What a patch turns as the foot walks over it is left out of ∂N: patches are flat but for their twist.

use std::f64::consts::TAU;

use gearmesh_contact::SliceLayout;
use gearmesh_geometry::Flank;
use nalgebra::{Matrix3, Vector3};
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy};

use super::digital_flank::{Block, DigitalFlank};
use super::patch_foot::Foot;
use crate::error::DrivetrainError;
use crate::flank_contacts::{FlankContacts, Section, ToothContact};
use crate::flank_kinematics::{FlankKinematics, Tangent};
use crate::pose::{Pose, Vector6, stacked};
use crate::slice_plane::Matrix6;

/// Flanks this far apart, or deeper in each other, over the pitch, are those of other teeth.
const OTHER_TEETH: f64 = 0.3;
/// Contacts that memory is kept for at first.
const EXPECTED_CONTACTS: usize = 256;

/// What a mesh asks of a contact beyond its gap.
#[derive(Debug, Clone, Copy)]
struct Touch {
    /// N and two tangents at right angles to it, gear 1's axes.
    normal: Vector3<f64>,
    tangents: [Vector3<f64>; 2],
    /// From gear 2's origin \[m\].
    arm: Vector3<f64>,
    /// `[gear][tangent]`: its parts up the profile and along the tooth.
    on_flanks: [[[f64; 2]; 2]; 2],
}

/// A tooth of gear 1 against one of gear 2.
#[derive(Debug, Clone, Copy)]
struct Pairing {
    teeth: [usize; 2],
    /// Gear 1's tooth in gear 1's frame.
    turn_1: Matrix3<f64>,
    /// Gear 2's tooth in gear 1's frame.
    axes_2: Matrix3<f64>,
}

/// Memory of a search.
#[derive(Debug, Clone, Default)]
struct Search {
    touches: Vec<Touch>,
    /// Of each block the least gap that it may have \[m\], and the patch under its middle.
    blocks: Vec<Option<(f64, [usize; 2])>>,
}

/// Flanks of two gears as nodes and patches; where they stand apart those of the smooth family.
pub struct NodeSurfaces {
    smooth: Box<dyn FlankKinematics>,
    teeth: [usize; 2],
    face_widths_m: [f64; 2],
    /// Along gear 1's face.
    layout: SliceLayout,
    /// Right and left flanks of gear 1 and gear 2.
    sides: [[DigitalFlank; 2]; 2],
    /// Boxes of all teeth of gear 1, right and left flanks.
    boxes: [Bvh; 2],
    /// A_ref \[m²\]; none: K at every node.
    reference_area_m2: Option<f64>,
    /// Whether flanks slide along the teeth as well, as loads of reduced gears count them.
    slides_along: bool,
    found: [Search; 2],
    is_apart: [bool; 2],
}

impl NodeSurfaces {
    /// The flanks `sides` (right and left, of gear 1 and gear 2) of gears with these teeth and face widths \[m\], in
    /// so many slices along gear 1's face.
    /// The smooth family is asked where flanks stand apart. Each node presses with the share of its area in
    /// `reference_area_m2`, or each with the whole law where there is none.
    #[must_use]
    pub fn new(
        smooth: Box<dyn FlankKinematics>,
        (teeth, face_widths_m): ([usize; 2], [f64; 2]),
        slices: usize,
        sides: [[DigitalFlank; 2]; 2],
        reference_area_m2: Option<f64>,
    ) -> Self {
        let boxes = [0, 1].map(|side: usize| {
            let turn = |tooth: usize| TAU * tooth as f64 / teeth[0] as f64;
            let own = (0..teeth[0]).map(|tooth| sides[side][0].box_of_tooth(turn(tooth)));
            Bvh::from_leaves(BvhBuildStrategy::Binned, &own.collect::<Vec<Aabb>>())
        });
        Self {
            smooth,
            teeth,
            face_widths_m,
            layout: SliceLayout::new([face_widths_m[0]; 2], 0.0, slices),
            sides,
            boxes,
            reference_area_m2,
            slides_along: false,
            found: [Search::default(), Search::default()],
            is_apart: [false; 2],
        }
    }

    /// Lets friction act in the tangent plane, for flanks that slide along the teeth as well.
    #[must_use]
    pub fn sliding_along(mut self) -> Self {
        self.slides_along = true;
        self
    }

    /// A_ref \[m²\], where nodes press with the share of their area in it.
    #[must_use]
    pub fn reference_area_m2(&self) -> Option<f64> {
        self.reference_area_m2
    }

    /// Global search: pairs of teeth whose boxes overlap.
    fn pairings(&self, pose: &Pose, side: Flank) -> Vec<Pairing> {
        let [_, mate] = &self.sides[side as usize];
        let turn = |tooth: usize, gear: usize| {
            let angle = TAU * tooth as f64 / self.teeth[gear] as f64;
            *nalgebra::Rotation3::from_axis_angle(&Vector3::z_axis(), angle).matrix()
        };
        let mut found = Vec::new();
        for tooth_2 in 0..self.teeth[1] {
            let axes_2 = pose.rotation * turn(tooth_2, 1);
            let around = mate.box_at(&axes_2, &pose.displacement_m);
            let near = self.boxes[side as usize].intersect_aabb(&around);
            found.extend(near.map(|tooth_1| Pairing {
                teeth: [tooth_1 as usize, tooth_2],
                turn_1: turn(tooth_1 as usize, 0),
                axes_2,
            }));
        }
        // The tree gives them in its own order.
        found.sort_by_key(|pairing| pairing.teeth);
        found
    }

    /// Goes over all pairs of a side; returns whether no boxes overlap.
    fn find(
        &self,
        pose: &Pose,
        side: Flank,
        search: &mut Search,
        found: &mut FlankContacts,
    ) -> bool {
        found.clear();
        found.action_m_per_u = [0.0; 2];
        search.touches.clear();
        let pairings = self.pairings(pose, side);
        for pairing in &pairings {
            self.find_pair(pose, side, pairing, search, found);
        }
        found.nearest_first();
        pairings.is_empty()
    }

    /// Local search of a pair of teeth: all nodes that stand in a patch, or the nearest one.
    fn find_pair(
        &self,
        pose: &Pose,
        side: Flank,
        pairing: &Pairing,
        search: &mut Search,
        found: &mut FlankContacts,
    ) {
        let [own, mate] = &self.sides[side as usize];
        let to_2 = pairing.axes_2.transpose();
        let into = to_2 * pairing.turn_1;
        let origin = -to_2 * pose.displacement_m;
        let far_m = OTHER_TEETH * self.pitch_m();
        let [low, high] = mate.bounds;
        let (line, first) = (found.lines.len(), found.contacts.len());
        let mut nearest: Option<(usize, Foot)> = None;
        let mut from = mate.patches.map(|count| count / 2);
        let stands = |number: usize, from: [usize; 2]| {
            let y = into * own.nodes[number].place_m + origin;
            let near = (0..3).all(|k| (low[k] - far_m..=high[k] + far_m).contains(&y[k]));
            near.then(|| mate.foot(&y, from)).flatten()
        };
        if let Some(centre) = stands(own.nodes.len() / 2, from) {
            // Gaps of flanks that face each other differ by less.
            if centre.gap_m.abs() > 0.5 * self.pitch_m() {
                return;
            }
            from = centre.patch;
        }
        // Within a radius R of a node the gap is not less than g − R s − ½ κ R², s how far its normals are from
        // opposite and κ the sum of the curvatures: blocks farther open than touching nodes and the nearest are passed
        // over.
        let curvature = own.curvature_per_m + mate.curvature_per_m;
        let mut reach_m = f64::INFINITY;
        let least_m = |block: &Block, foot: &Foot| {
            let aside = (into * own.nodes[block.middle].normal + foot.normal).norm();
            foot.gap_m - block.radius_m * (aside + 0.5 * curvature * block.radius_m)
        };
        search.blocks.clear();
        for block in &own.blocks {
            let foot = stands(block.middle, from);
            if let Some(foot) = &foot {
                from = foot.patch;
                if foot.gap_m.abs() <= far_m {
                    reach_m = reach_m.min(foot.gap_m);
                }
            }
            let least = foot.map(|foot| (least_m(block, &foot), foot.patch));
            search.blocks.push(least);
        }
        let reach_m = reach_m.max(found.bent_m);
        for (block, number) in own.blocks.iter().zip(0..) {
            match search.blocks[number] {
                Some((least_m, _)) if least_m > reach_m => continue,
                Some((_, patch)) => from = patch,
                None => {}
            }
            for &number in &block.nodes {
                let Some(foot) = stands(number, from) else {
                    continue;
                };
                from = foot.patch;
                if foot.gap_m.abs() > far_m {
                    continue;
                }
                if nearest.is_none_or(|(_, least)| foot.gap_m < least.gap_m) {
                    nearest = Some((number, foot));
                }
                if foot.gap_m <= found.bent_m {
                    self.push(pose, side, pairing, (line, number, foot), search, found);
                }
            }
        }
        if let Some((number, foot)) = nearest {
            if found.contacts.len() == first {
                self.push(pose, side, pairing, (line, number, foot), search, found);
            }
            found.add_line(pairing.teeth, first, foot.gap_m);
        }
    }

    fn push(
        &self,
        pose: &Pose,
        side: Flank,
        pairing: &Pairing,
        (line, number, foot): (usize, usize, Foot),
        search: &mut Search,
        found: &mut FlankContacts,
    ) {
        let [own, mate] = &self.sides[side as usize];
        let node = &own.nodes[number];
        let arm = pairing.turn_1 * node.place_m - pose.displacement_m;
        let normal = -(pairing.axes_2 * foot.normal);
        let [along_2, up_2] = foot.slopes.map(|slope| pairing.axes_2 * slope);
        let gradient = stacked(normal, arm.cross(&normal));
        // The foot walks as the node moves against the patch: (TᵀT)⁻¹Tᵀ of −(δu + ϑ × r).
        let (a, b, c) = (
            along_2.norm_squared(),
            along_2.dot(&up_2),
            up_2.norm_squared(),
        );
        let det = a * c - b * b;
        let walks = [
            (c * along_2 - b * up_2) / det,
            (a * up_2 - b * along_2) / det,
        ];
        let per_patch = [
            self.face_widths_m[1] / mate.patches[0] as f64,
            (mate.ends[1] - mate.ends[0]) / mate.patches[1] as f64,
        ];
        let walking = |k: usize| -per_patch[k] * stacked(walks[k], arm.cross(&walks[k]));
        let places = [own.at_node(number), mate.at(foot.patch, foot.within)];
        let up = places.map(|place| place[1]);
        let slices = self.layout.slices;
        let contact = found.contacts.len();
        found.sections.push(Section {
            roll_rad: up,
            touching_roll_rad: up,
            roll_gradient: [Vector6::zeros(), walking(1)],
            share: 1.0,
            stiffness: self
                .reference_area_m2
                .map_or(1.0, |area| node.area_m2 / area),
            length_m: self.layout.width_m(),
            radius_m: 1.0,
            along_gradient: [Vector6::zeros(), walking(0)],
            contacts: (contact, 1),
            ..Section::default()
        });
        found.contacts.push(ToothContact {
            line,
            slice: ((places[0][0] * slices as f64) as usize).min(slices - 1),
            section: contact,
            heights_m: [0, 1].map(|gear: usize| (places[gear][0] - 0.5) * self.face_widths_m[gear]),
            gap_m: foot.gap_m,
            gap_rate_m_per_s: gradient.dot(&pose.rates()),
            gradient,
        });
        let up_2 = (up_2 - normal * normal.dot(&up_2)).normalize();
        // Along the profile only: to the tip of gear 1 on right flanks.
        let first = if self.slides_along {
            up_2
        } else {
            -side.mirror() * up_2
        };
        let tangents = [first, normal.cross(&first)];
        let own = node.tangents.map(|tangent| pairing.turn_1 * tangent);
        let across_2 = (along_2 - up_2 * up_2.dot(&along_2)).normalize();
        let seen = |[up, along]: [Vector3<f64>; 2]| tangents.map(|t| [t.dot(&up), t.dot(&along)]);
        search.touches.push(Touch {
            normal,
            tangents,
            arm,
            on_flanks: [seen(own), seen([up_2, across_2])],
        });
    }

    fn touch(&self, contact: usize, side: Flank) -> Option<&Touch> {
        self.found[side as usize].touches.get(contact)
    }
}

/// (v, r × v) of a vector that turns with gear 2 at an arm that gear 2's origin leaves, and its derivatives.
fn load(v: &Vector3<f64>, arm: &Vector3<f64>) -> (Vector6, Matrix6) {
    let (turned, armed) = (v.cross_matrix(), arm.cross_matrix());
    let mut by_pose = Matrix6::zeros();
    by_pose.fixed_view_mut::<3, 3>(0, 3).copy_from(&-turned);
    by_pose.fixed_view_mut::<3, 3>(3, 0).copy_from(&turned);
    by_pose
        .fixed_view_mut::<3, 3>(3, 3)
        .copy_from(&-(armed * turned));
    (stacked(*v, arm.cross(v)), by_pose)
}

impl FlankKinematics for NodeSurfaces {
    fn layout(&self) -> &SliceLayout {
        &self.layout
    }

    fn capacity(&self) -> usize {
        EXPECTED_CONTACTS
    }

    fn pitch_m(&self) -> f64 {
        self.smooth.pitch_m()
    }

    fn most_added_m(&self) -> f64 {
        self.smooth.most_added_m()
    }

    fn locate(&mut self, pose: &Pose) -> Result<(), DrivetrainError> {
        self.smooth.locate(pose)
    }

    fn contacts(&mut self, pose: &Pose, side: Flank, found: &mut FlankContacts) {
        let mut search = std::mem::take(&mut self.found[side as usize]);
        self.is_apart[side as usize] = self.find(pose, side, &mut search, found);
        self.found[side as usize] = search;
    }

    fn contacts_at(
        &self,
        pose: &Pose,
        side: Flank,
        found: &mut FlankContacts,
    ) -> Result<(), DrivetrainError> {
        self.find(pose, side, &mut Search::default(), found);
        Ok(())
    }

    fn gap_curvature(&self, _: &FlankContacts, contact: usize, side: Flank) -> Matrix6 {
        let touch = self.touch(contact, side);
        touch.map_or_else(Matrix6::zeros, |touch| load(&touch.normal, &touch.arm).1)
    }

    fn sliding(
        &self,
        _: &FlankContacts,
        contact: usize,
        side: Flank,
        derivatives: bool,
    ) -> [Option<Tangent>; 2] {
        let Some(touch) = self.touch(contact, side) else {
            return [None; 2];
        };
        let [profile, tooth] = touch.tangents.map(|tangent| {
            let (direction, change) = load(&tangent, &touch.arm);
            let change = derivatives.then_some(change);
            Tangent { direction, change }
        });
        [Some(profile), self.slides_along.then_some(tooth)]
    }

    fn tangents_on_flanks(&self, contact: usize, side: Flank) -> Option<[[[f64; 2]; 2]; 2]> {
        let touch = self.touch(contact, side).filter(|_| self.slides_along)?;
        Some(touch.on_flanks)
    }

    fn towards_gear_2(&self, pose: &Pose) -> Vector3<f64> {
        self.smooth.towards_gear_2(pose)
    }

    fn nearest_gap_m(&self, side: Flank) -> Option<f64> {
        self.smooth.nearest_gap_m(side)
    }

    fn is_apart(&self) -> bool {
        self.is_apart.iter().all(|apart| *apart)
    }
}
