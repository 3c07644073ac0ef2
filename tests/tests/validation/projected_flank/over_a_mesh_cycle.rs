//! Root strain of gear 2 of pair A while its tooth passes the mesh, by the seed's second method as it is written (eq. 8
//! to 10): the forces of all slices on the elements they meet, friction of 0.3 and forces of tip edges included; and by
//! the rows of the flank grid.

use super::{BothWays, SIDE, larger};
use gearmesh_contact::ContactPatch;
use gearmesh_geometry::input::InputDocument;
use gearmesh_model::write_reduced_gear;
use gearmesh_reduction::Silent;
use gearmesh_reduction::flank_loads::{GridLoad, SparseVector, dot};
use gearmesh_reduction::gauge_row::gauge_row;
use gearmesh_reduction::projected_flank::ProjectedFlank;
use gearmesh_reduction::tooth_vectors::summed;
use gearmesh_scene::{LoadedScene, Scene, load, run};
use std::collections::BTreeMap;
use std::path::Path;

/// Of the gauge's range. Forces stand between the centroids of the outermost hats but at the tip's edge, where the
/// tooth carries a part of the load only: what the stations leave out there (`slices.rs`) stays below half a per cent.
const LINES: f64 = 0.005;
/// Teeth on either side of the gauge's own that are followed.
const TEETH_BESIDE: usize = 2;
/// Teeth of gear 2.
const TEETH: usize = 57;

fn text(name: &str) -> String {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../fe_models/{name}.toml"));
    std::fs::read_to_string(file).unwrap()
}

/// A slice's force at a position of the pair.
struct Force {
    patch: ContactPatch,
    newtons: f64,
}

/// Nodal loads of unit forces on gear 2, as they were found.
struct Found<'a> {
    both: &'a BothWays,
    flanks: BTreeMap<usize, ProjectedFlank<'a>>,
}

impl<'a> Found<'a> {
    /// Of a force on a slice: uniform over it, or in its middle.
    fn load(&mut self, force: &Force, is_line: bool) -> GridLoad {
        let both = self.both;
        let (tooth, place) = (force.patch.teeth[1], force.patch.places[1]);
        let flank = self
            .flanks
            .entry(tooth)
            .or_insert_with(|| both.flank(tooth));
        let half = 0.5 * both.model.slice_width_m();
        if is_line {
            flank
                .line([place.v - half, place.v + half], |_| place.u)
                .unwrap()
        } else {
            flank.point(place.u, place.v).unwrap()
        }
    }

    /// Nodal forces of the normal and the friction force [N].
    fn nodal(&mut self, forces: &[Force], is_line: bool) -> SparseVector {
        let mut all = Vec::new();
        for force in forces {
            let unit = self.load(force, is_line);
            let [normal, tangential] = force.patch.force_components(1);
            for (part, share) in [(&unit.normal, normal), (&unit.tangential, tangential)] {
                all.extend(
                    part.iter()
                        .map(|&(dof, value)| (dof, share * force.newtons * value)),
                );
            }
        }
        summed(all)
    }
}

fn scene(folder: &Path) -> LoadedScene {
    let mut scene = text("pair_a_friction");
    for (from, to) in [
        ("../out/demo/", ""),
        ("\"line-of-action\"", "\"extended\""),
        ("[50.0, 100.0, 150.0, 200.0, 250.0, 300.0]", "[300.0]"),
    ] {
        assert!(scene.contains(from), "{from}");
        scene = scene.replace(from, to);
    }
    load(Scene::from_document(InputDocument::new("pair.toml", scene), folder).unwrap()).unwrap()
}

#[test]
fn a_passing_tooth_strains_its_root_alike() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str| {
        // Both ways load one mesh and read it alike, whose fillets and body may be coarse.
        let both = BothWays::new(format!(
            "{}\n[mesh]\nfillet_mm = 0.26\nbody_mm = 6.0\n",
            text(name)
        ));
        write_reduced_gear(&folder.path().join(format!("{name}.h5")), &both.model).unwrap();
        both
    };
    write("gear1");
    let both = write("gear2");
    let loaded = scene(folder.path());
    let result = run(&loaded, &|_, _| ()).unwrap();
    assert_eq!(loaded.lines.pair.flank_of(1), SIDE);

    // Positions at which the gauge's tooth, number 0, or one beside it carries.
    let near = |tooth: usize| tooth.min(TEETH - tooth) <= TEETH_BESIDE;
    let at = |angle: usize| -> Vec<Force> {
        let forces = result.position_forces(0, angle);
        let patches = loaded.patches_at(result.angle_rad[angle]).into_iter();
        let all = patches.map(|patch| Force {
            newtons: forces[patch.line * result.lines.slices + patch.slice],
            patch,
        });
        all.filter(|force| force.newtons > 0.0).collect()
    };
    let positions: Vec<(usize, Vec<Force>)> = (0..result.angles())
        .map(|angle| (angle, at(angle)))
        .filter(|(_, forces)| forces.iter().any(|force| near(force.patch.teeth[1])))
        .collect();
    let on_edges = positions
        .iter()
        .filter(|(_, forces)| forces.iter().any(|f| f.patch.edge.is_some()));
    let (count, edges) = (positions.len(), on_edges.count());
    println!("{count} positions, {edges} of them with forces at tip edges");
    assert!(edges > 10 && count > 4 * 48);

    let mut found = Found {
        both: &both,
        flanks: BTreeMap::new(),
    };
    let mut by_load = |is_line: bool| -> Vec<SparseVector> {
        positions
            .iter()
            .map(|(_, forces)| found.nodal(forces, is_line))
            .collect()
    };
    let loads = [by_load(true), by_load(false)];
    for series in &result.strain {
        let gauge = both
            .gear
            .gauges
            .iter()
            .find(|gauge| gauge.name == series.name)
            .unwrap();
        let row = gauge_row(
            &both.gear,
            &both.body.mesh,
            &both.body.model,
            gauge,
            gauge.tooth,
        )
        .unwrap();
        // One solution a gauge; and, as the seed has it, one a position, at some of them.
        let mut influence = Vec::new();
        both.body
            .solve_each(&[&row], &Silent, |_, y| influence = y.to_vec());
        let grid: Vec<f64> = positions
            .iter()
            .map(|(angle, _)| series.method_2[*angle])
            .collect();
        let read = |loads: &[SparseVector]| {
            loads
                .iter()
                .map(|load| dot(load, &influence))
                .collect::<Vec<f64>>()
        };
        let [lines, points] = [0, 1].map(|way| read(&loads[way]));
        let ends = lines
            .iter()
            .fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(*x), b.max(*x)));
        let range = ends.1 - ends.0;
        let off = |values: &[f64], only_edges: bool| {
            let each = values.iter().zip(&lines).zip(&positions);
            let kept = each.filter(|(_, (_, forces))| {
                !only_edges || forces.iter().any(|force| force.patch.edge.is_some())
            });
            kept.map(|((a, b), _)| (a - b) / range).fold(0.0, larger)
        };
        println!(
            "{}: {:.1} ustrain from end to end; flank grid off by {:.3} %, at tip edges {:.3} %; one point a slice by {:.3} %",
            series.name,
            1e6 * range,
            100.0 * off(&grid, false),
            100.0 * off(&grid, true),
            100.0 * off(&points, false)
        );
        assert!(off(&grid, false).abs() < LINES, "{}", series.name);
        // Seed 004's 5 slices with one point each are a coarse rule beside a gauge a slice wide.
        assert!(off(&points, false).abs() < 0.1, "{}", series.name);

        let some: Vec<usize> = (0..count).step_by(count / 4).collect();
        let whole: Vec<&SparseVector> = some.iter().map(|&k| &loads[0][k]).collect();
        both.body.solve_each(&whole, &Silent, |k, d| {
            let direct = dot(&row, d);
            let by_influence = lines[some[k]];
            assert!(
                (direct - by_influence).abs() < 1e-9 * range,
                "{direct} {by_influence}"
            );
        });
    }
}
