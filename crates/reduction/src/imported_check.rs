//! Whether a mesh that was made elsewhere fits its definition: one part, its bore, its flanks.

use crate::imported_error::{ImportedMeshError, Misfit};
use crate::tooth_frame::in_tooth;
use gearmesh_geometry::{Flank, GearDefinition, MeshedBody, ProfileCurve};
use gearmesh_mesh::OutlineFace;
use gearmesh_model::MeshData;
use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

/// Distance to the bore or to the profile that is forgiven, as a share of the module.
const TOLERANCE: f64 = 2e-3;
/// Share of a flank that the faces of its set must cover.
const COVERAGE: f64 = 0.99;

/// A mesh beside the definition that it must fit.
pub(crate) struct ImportCheck<'a> {
    pub(crate) gear: &'a GearDefinition,
    pub(crate) body: &'a MeshedBody,
    pub(crate) curve: ProfileCurve,
    pub(crate) mesh: &'a MeshData,
}

impl ImportCheck<'_> {
    pub(crate) fn misfit(&self, problem: Misfit) -> Box<ImportedMeshError> {
        Box::new(ImportedMeshError::Misfit {
            file: self.body.file.display().to_string(),
            problem,
        })
    }

    fn at_mm(&self, node: u32) -> [f64; 3] {
        self.mesh.points[node as usize].map(|v| v * 1e3)
    }

    pub(crate) fn tolerance_m(&self) -> f64 {
        TOLERANCE * self.gear.tooth.module_m
    }

    /// All elements hang together.
    pub(crate) fn parts(&self) -> Result<(), Box<ImportedMeshError>> {
        let mut parent: Vec<u32> = (0..self.mesh.points.len() as u32).collect();
        fn root(parent: &mut [u32], mut n: u32) -> u32 {
            while parent[n as usize] != n {
                parent[n as usize] = parent[parent[n as usize] as usize];
                n = parent[n as usize];
            }
            n
        }
        for (_, cell) in self.mesh.iter_cells() {
            let first = root(&mut parent, cell[0]);
            for &n in &cell[1..] {
                let other = root(&mut parent, n);
                parent[other as usize] = first;
            }
        }
        let mut sizes: BTreeMap<u32, usize> = BTreeMap::new();
        for n in 0..parent.len() as u32 {
            *sizes.entry(root(&mut parent, n)).or_default() += 1;
        }
        match sizes.iter().min_by_key(|(_, size)| **size) {
            Some((&node, &nodes)) if sizes.len() > 1 => Err(self.misfit(Misfit::Parts {
                parts: sizes.len(),
                nodes,
                at_mm: self.at_mm(node),
            })),
            _ => Ok(()),
        }
    }

    fn set(&self, name: &str) -> Option<&[u32]> {
        let set = self.mesh.point_sets.get(name).map(Vec::as_slice);
        set.filter(|nodes| !nodes.is_empty())
    }

    fn missing(&self, wanted: String, more: usize, use_of: &'static str) -> Box<ImportedMeshError> {
        const SHOWN: usize = 8;
        let names = &self.mesh.point_sets;
        let mut found: Vec<String> = names
            .keys()
            .take(SHOWN)
            .map(|n| format!("\"{n}\""))
            .collect();
        if names.len() > SHOWN {
            found.push(format!("and {} more", names.len() - SHOWN));
        }
        self.misfit(Misfit::SetMissing {
            wanted,
            more,
            use_of,
            found: found.join(", "),
        })
    }

    /// Nodes of the bore, all on its cylinder.
    pub(crate) fn bore(&self) -> Result<Vec<u32>, Box<ImportedMeshError>> {
        let name = &self.body.bore_set;
        let nodes = self
            .set(name)
            .ok_or_else(|| self.missing(name.clone(), 0, "where the gear is held"))?;
        let expected = self.gear.blank.bore_radius_m();
        let radius = |n: u32| {
            let [x, y, _] = self.mesh.points[n as usize];
            x.hypot(y)
        };
        let off = |n: &u32| (radius(*n) - expected).abs();
        let worst = nodes
            .iter()
            .copied()
            .max_by(|a, b| off(a).total_cmp(&off(b)));
        match worst {
            Some(node) if off(&node) > self.tolerance_m() => Err(self.misfit(Misfit::Bore {
                set: name.clone(),
                node,
                at_mm: self.at_mm(node),
                found_mm: radius(node) * 1e3,
                expected_mm: expected * 1e3,
                allowed_um: self.tolerance_m() * 1e6,
            })),
            _ => Ok(nodes.to_vec()),
        }
    }

    /// Distance of a node from a flank's involute \[m\], positive into the tooth.
    fn off_flank_m(&self, node: u32, tooth: usize, side: Flank) -> f64 {
        let teeth = self.gear.tooth.teeth;
        let profile = &self.gear.profile;
        let point = in_tooth(self.mesh.points[node as usize], tooth, teeth, side);
        let radius = point[0].hypot(point[1]);
        let roll = (radius / profile.base_radius_m).powi(2) - 1.0;
        let roll = roll.max(0.0).sqrt();
        // Turned involutes are parallel: r_b times the angle apart. Beyond the flank's ends, how far beyond.
        let angle = point[1].atan2(point[0]) + profile.half_angle_rad(roll);
        let wrapped = (angle + PI).rem_euclid(TAU) - PI;
        let aside = wrapped * profile.base_radius_m;
        let ends = [profile.form_roll_rad, profile.flank_end_roll_rad]
            .map(|xi| profile.base_radius_m * (1.0 + xi * xi).sqrt());
        let beyond = (ends[0] - radius).max(radius - ends[1]).max(0.0);
        if beyond > aside.abs() { beyond } else { aside }
    }

    /// Names of the sets of the loaded flanks; all their nodes lie on them.
    pub(crate) fn flanks(&self) -> Result<Vec<(usize, Flank, String)>, Box<ImportedMeshError>> {
        let sides = &self.gear.reduction.flanks;
        let all: Vec<(usize, Flank, String)> = (0..self.gear.tooth.teeth)
            .flat_map(|tooth| sides.iter().map(move |&side| (tooth, side)))
            .map(|(tooth, side)| (tooth, side, self.body.flank_set(tooth, side)))
            .collect();
        let missing: Vec<&String> = all
            .iter()
            .map(|(_, _, name)| name)
            .filter(|name| self.set(name).is_none())
            .collect();
        if let Some(first) = missing.first() {
            let wanted = (*first).clone();
            return Err(self.missing(wanted, missing.len() - 1, "a loaded flank"));
        }
        for (tooth, side, name) in &all {
            let off = |n: &u32| self.off_flank_m(*n, *tooth, *side).abs();
            let nodes = self.set(name).unwrap_or(&[]).iter().copied();
            let worst = nodes.max_by(|a, b| off(a).total_cmp(&off(b)));
            if let Some(node) = worst.filter(|n| off(n) > self.tolerance_m()) {
                return Err(self.misfit(Misfit::Flank {
                    set: name.clone(),
                    node,
                    at_mm: self.at_mm(node),
                    distance_um: off(&node) * 1e6,
                    side: side.name(),
                    tooth: *tooth,
                    allowed_um: self.tolerance_m() * 1e6,
                    hint: self.hint(name, *tooth, *side),
                }));
            }
        }
        Ok(all)
    }

    /// What a flank in the wrong place looks like: another unit, another phase, the mirror image.
    fn hint(&self, name: &str, tooth: usize, side: Flank) -> String {
        let nodes = self.set(name).unwrap_or(&[]);
        let mean = |f: &dyn Fn(u32) -> f64| {
            nodes.iter().map(|n| f(*n)).sum::<f64>() / nodes.len().max(1) as f64
        };
        let radius =
            mean(&|n| self.mesh.points[n as usize][0].hypot(self.mesh.points[n as usize][1]));
        let ratio = radius / self.gear.profile.reference_radius_m;
        if !(0.2..5.0).contains(&ratio) {
            return format!(
                "Its nodes have a mean radius of {:.4} mm, the reference circle {:.4} mm: check blank.length_unit",
                radius * 1e3,
                self.gear.profile.reference_radius_m * 1e3
            );
        }
        let fits = |other: Flank, at: usize| {
            nodes
                .iter()
                .all(|n| self.off_flank_m(*n, at, other).abs() <= self.tolerance_m())
        };
        let teeth = self.gear.tooth.teeth;
        if fits(side.opposite(), tooth) || fits(side.opposite(), (teeth - tooth) % teeth) {
            return format!(
                "It is where the {} flank lies: the mesh is a mirror image, or the sets are named from the other end",
                side.opposite().name()
            );
        }
        let aside = mean(&|n| self.off_flank_m(n, tooth, side));
        let spread = mean(&|n| (self.off_flank_m(n, tooth, side) - aside).abs());
        if spread < 0.1 * aside.abs() {
            let degrees = (aside / self.gear.profile.base_radius_m).to_degrees();
            return format!(
                "All of it is turned by {:.4} deg: tooth 0 must be centred on +x, teeth counted counter-clockwise seen from +z",
                side.mirror() * degrees
            );
        }
        "Check module, pressure angle, profile shift, thickness allowance and the diameters of [tooth]".into()
    }

    /// The faces found cover the flanks.
    pub(crate) fn coverage(
        &self,
        outlines: &[[Vec<OutlineFace>; 2]],
        flanks: &[(usize, Flank, String)],
    ) -> Result<(), Box<ImportedMeshError>> {
        let profile = &self.gear.profile;
        let half = 0.5 * self.gear.tooth.face_width_m;
        let arcs = [self.curve.flank_start_m(), self.curve.flank_end_m()];
        let whole = 2.0 * half * (arcs[1] - arcs[0]);
        for (tooth, side, name) in flanks {
            let faces = &outlines[*tooth][*side as usize];
            let covered: f64 = faces
                .iter()
                .flat_map(|face| crate::face_overlap::overlap_points(face, arcs, [-half, half]))
                .map(|point| point.area_m2)
                .sum();
            if covered < COVERAGE * whole {
                let radius = |xi: f64| profile.base_radius_m * (1.0 + xi * xi).sqrt() * 1e3;
                return Err(self.misfit(Misfit::Coverage {
                    set: name.clone(),
                    covered_percent: 100.0 * covered / whole,
                    side: side.name(),
                    tooth: *tooth,
                    from_mm: radius(profile.form_roll_rad),
                    to_mm: radius(profile.flank_end_roll_rad),
                    width_mm: 2e3 * half,
                }));
            }
        }
        Ok(())
    }
}
