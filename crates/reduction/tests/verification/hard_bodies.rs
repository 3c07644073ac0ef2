//! Bodies at the ends of what is made: rims, faces, helices, numbers of teeth, modules, shafts.

use crate::small_gears::{self, COARSE, difference, reduced, without_symmetry};
use gearmesh_geometry::GearDefinition;
use gearmesh_geometry::input::InputDocument;
use gearmesh_model::{ReducedGear, ReductionChecks};
use std::time::Instant;

/// A gear file with lengths in modules.
struct Body {
    teeth: usize,
    module_mm: f64,
    /// Face width over module.
    face: f64,
    /// The blank, its lengths in mm.
    blank: String,
    /// Element lengths over the module: flank, fillet, body, axial.
    lengths: [f64; 4],
}

impl Body {
    fn read(&self) -> Result<GearDefinition, String> {
        let m = self.module_mm;
        let [flank, fillet, body, axial] = self.lengths.map(|length| length * m);
        let text = format!(
            "name = \"hard\"\n[tooth]\nteeth = {}\nmodule_mm = {m:?}\nface_width_mm = {:?}\nprofile_shift = 0.1\n[material]\nyoung_GPa = 210.0\npoisson = 0.3\n\
             [reduction]\nroll_stations = 4\nslices = 2\nflanks = [\"right\"]\n\
             [mesh]\nflank_mm = {flank:?}\nfillet_mm = {fillet:?}\nbody_mm = {body:?}\naxial_mm = {axial:?}\n{}",
            self.teeth,
            self.face * m,
            self.blank
        );
        GearDefinition::from_document(&InputDocument::new("hard.toml", text))
            .map_err(|error| error.to_string())
    }
}

/// As [`COARSE`], over the module.
const LENGTHS: [f64; 4] = [0.8, 0.4, 2.0, 2.0];

fn solid(bore_mm: f64) -> String {
    format!("[blank]\nkind = \"solid\"\nbore_diameter_mm = {bore_mm:?}\n")
}

/// Deflection of a tooth's flank at its second roll station under a line load on tooth 0 there, the near field of the
/// loaded tooth taken out \[m/N\].
fn deflection(gear: &ReducedGear, tooth: usize) -> f64 {
    let (grid, count) = (&gear.grid, gear.grid.len());
    let n = grid.z_m.len();
    // The axial hats overlap; each inner one carries its share of the width.
    let share = |j: usize| if j == 0 || j == n - 1 { 0.5 } else { 1.0 } / (n - 1) as f64;
    let block = &gear.c_hub[tooth * gear.flanks.len() * count * count..][..count * count];
    let mut sum = 0.0;
    for j in 0..n {
        for k in 0..n {
            let place = grid.load(2, j) * count + grid.load(2, k);
            let near = if tooth == 0 { gear.c_tooth[place] } else { 0.0 };
            sum += share(j) * share(k) * (block[place] - near);
        }
    }
    sum
}

fn stated(gear: &ReducedGear, name: &str) -> f64 {
    let found = gear.checks.further.iter().find(|(known, _)| known == name);
    found.unwrap().1
}

/// Half a module of rim is left below the roots, as little as is allowed: teeth stand on a band that bends from tooth
/// to tooth. The cyclic solution is that of the whole gear; a mesh of 0.7 times the lengths changes loaded tooth and
/// neighbour by less than the stated error; less rim is refused by its key.
#[test]
fn a_rim_of_half_a_module() {
    let blank = |rim_mm: f64| {
        format!(
            "[blank]\nkind = \"thin-rim\"\nbore_diameter_mm = 14.0\nhub_diameter_mm = 20.0\nrim_inner_diameter_mm = {rim_mm:?}\nweb_thickness_mm = 4.0\n"
        )
    };
    // Root diameter 54 + 2 · (0.1 − 1.25) · 3 mm.
    let body = |rim_mm: f64, lengths: [f64; 4]| {
        let body = Body {
            teeth: 18,
            module_mm: 3.0,
            face: 4.0,
            blank: blank(rim_mm),
            lengths,
        };
        body.read()
    };
    let least = 47.1 - 3.001;
    let told = body(least + 0.01, LENGTHS).unwrap_err();
    assert!(told.contains("blank.rim_inner_diameter_mm"), "{told}");
    let gear = body(least, LENGTHS).unwrap();
    let (model, _) = reduced(&gear, true);
    let (whole, _) = reduced(&without_symmetry(&gear), false);
    let symmetry = difference(&whole.c_hub, &model.c_hub);
    assert!(symmetry < 1e-9, "{symmetry:e}");
    let (thick, _) = reduced(&body(least - 6.0, LENGTHS).unwrap(), false);
    let (fine, _) = reduced(
        &body(least, LENGTHS.map(|length| 0.7 * length)).unwrap(),
        false,
    );
    let change = |tooth: usize| deflection(&model, tooth) / deflection(&fine, tooth) - 1.0;
    let softer = [0, 1].map(|tooth| deflection(&model, tooth) / deflection(&thick, tooth));
    let told = [
        stated(&model, ReductionChecks::LOADED_TOOTH_ERROR),
        stated(&model, ReductionChecks::OTHER_TEETH_ERROR),
    ];
    println!(
        "{:.2} and {:.2} times as soft as with a rim of a module and a half; finer mesh {:+.2} and {:+.2} %, stated {:.1} and {:.1} %",
        softer[0],
        softer[1],
        100.0 * change(0),
        100.0 * change(1),
        100.0 * told[0],
        100.0 * told[1]
    );
    assert!(softer[0] > 1.1 && softer[1] > 1.0, "{softer:?}");
    assert!(change(0).abs() < told[0] && change(1).abs() < told[1]);
}

/// Two elements across a face of a module, the fewest with two slices: what ten elements say of a line load, within the
/// stated error.
#[test]
fn the_fewest_elements_across_the_face() {
    let body = |axial: f64| {
        let body = Body {
            teeth: 18,
            module_mm: 3.0,
            face: 1.0,
            blank: solid(20.0),
            lengths: [LENGTHS[0], LENGTHS[1], LENGTHS[2], axial],
        };
        body.read().unwrap()
    };
    let [(few, mesh), (ten, _)] = [1.0, 0.1].map(|axial| reduced(&body(axial), axial == 1.0));
    let layers = mesh.mesh.nodes.len() / mesh.mesh.section.nodes.len();
    assert_eq!(layers, 3);
    let change = [0, 1].map(|tooth| deflection(&few, tooth) / deflection(&ten, tooth) - 1.0);
    let told = stated(&few, ReductionChecks::LOADED_TOOTH_ERROR);
    println!(
        "two elements differ from ten by {:+.2} % on the loaded tooth, {:+.2} % on the next; stated {:.1} %",
        100.0 * change[0],
        100.0 * change[1],
        100.0 * told
    );
    assert!(
        change[0].abs() < told && change[1].abs() < told,
        "{change:?} {told}"
    );
}

/// A helix of almost 45°, from which on helices are refused, of either hand: the cyclic solution is that of the whole
/// gear, the mirror image (other hand, other flanks) deflects alike.
#[test]
fn a_helix_of_almost_45_degrees() {
    let body = |hand: &str, flank: &str| {
        let gear = small_gears::gear(
            COARSE,
            small_gears::SOLID,
            if hand == "right" { 44.9 } else { -44.9 },
        );
        let text = gear.source.replace(
            "flanks = [\"right\", \"left\"]",
            &format!("flanks = [\"{flank}\"]"),
        );
        GearDefinition::from_document(&InputDocument::new("helix.toml", text)).unwrap()
    };
    let gear = body("right", "right");
    let (model, _) = reduced(&gear, false);
    let (whole, _) = reduced(&without_symmetry(&gear), false);
    let symmetry = difference(&whole.c_hub, &model.c_hub);
    assert!(symmetry < 1e-9, "{symmetry:e}");
    let (mirrored, _) = reduced(&body("left", "left"), false);
    let teeth = model.teeth;
    // The tooth ahead is the one behind in the mirror.
    let apart = [(0, 0), (1, teeth - 1), (teeth - 1, 1)]
        .map(|(a, b)| deflection(&model, a) / deflection(&mirrored, b) - 1.0);
    println!("cyclic {symmetry:.1e}; mirror image apart by {apart:?}");
    // The plane mesh of a sector is not its own mirror image: both flanks of a spur gear differ by 2.5e-4 on it.
    assert!(apart.iter().all(|off| off.abs() < 1e-3), "{apart:?}");
}

/// Five teeth are read as undercut; 500 teeth on a rim of ten modules
/// deflect like 250 but for what their form and the curvature of the rim, both 1/z, make.
#[test]
fn five_teeth_and_five_hundred() {
    let body = |teeth: usize| Body {
        teeth,
        module_mm: 1.0,
        face: 4.0,
        blank: solid((teeth as f64 - 22.5).max(1.0)),
        lengths: LENGTHS,
    };
    let five = body(5).read().unwrap();
    assert!(five.profile.undercut);
    let found = [125, 250, 500].map(|teeth| {
        let clock = Instant::now();
        let (model, _) = reduced(&body(teeth).read().unwrap(), false);
        println!("{teeth} teeth: {:.1} s", clock.elapsed().as_secs_f64());
        [0, 1, teeth / 2].map(|tooth| deflection(&model, tooth))
    });
    println!("deflections {found:?} m/N");
    for tooth in [0, 1] {
        let changes = [0, 1].map(|k: usize| (found[k + 1][tooth] / found[k][tooth] - 1.0).abs());
        // First order in 1/z: half from one to the next.
        let ratio = changes[1] / changes[0];
        assert!((0.3..0.7).contains(&ratio), "{tooth} {changes:?}");
    }
    // Far from the load hardly anything moves.
    assert!(found[2][2].abs() < 1e-6 * found[2][0], "{found:?}");
}

/// A module of 0.1 mm and one of 50 mm: the same gear as that of 3 mm in another size, so that compliance goes with
/// 1/m.
#[test]
fn modules_of_a_tenth_and_of_fifty() {
    let scaled = |module_mm: f64| {
        let body = Body {
            teeth: 18,
            module_mm,
            face: 4.0,
            blank: solid(7.0 * module_mm),
            lengths: LENGTHS,
        };
        let (model, made) = reduced(&body.read().unwrap(), false);
        let values: Vec<f64> = model.c_hub.iter().map(|c| c * module_mm).collect();
        (values, made.mesh.nodes.len())
    };
    let (of_three, nodes) = scaled(3.0);
    for module_mm in [0.1, 50.0] {
        let (values, other_nodes) = scaled(module_mm);
        let apart = difference(&of_three, &values);
        println!("module {module_mm} mm: apart by {apart:.1e}");
        assert_eq!(nodes, other_nodes, "{module_mm}");
        assert!(apart < 1e-9, "{module_mm}: {apart:e}");
    }
}

/// A pinion as thick as its shaft has nothing that teeth could stand on: a shaft of the root diameter is refused with
/// what is allowed. As thick as allowed, three modules less, it deflects less than on a shaft of half of that, and the
/// cyclic solution is that of the whole gear.
#[test]
fn a_pinion_as_thick_as_its_shaft() {
    let body = |shaft_mm: f64| {
        let body = Body {
            teeth: 18,
            module_mm: 3.0,
            face: 4.0,
            blank: format!(
                "[blank]\nkind = \"solid\"\nbore_diameter_mm = 0.0\nshaft_diameter_mm = [{shaft_mm:?}, {shaft_mm:?}]\n"
            ),
            lengths: LENGTHS,
        };
        body.read()
    };
    let told = body(47.1).unwrap_err();
    assert!(
        told.contains("shaft_diameter_mm.0: found 47.1, allowed is 0") && told.contains("38.100"),
        "{told}"
    );
    let gear = body(38.1).unwrap();
    let (thick, _) = reduced(&gear, false);
    let (whole, _) = reduced(&without_symmetry(&gear), false);
    let symmetry = difference(&whole.c_hub, &thick.c_hub);
    let (thin, _) = reduced(&body(19.05).unwrap(), false);
    let stiffer = deflection(&thick, 0) / deflection(&thin, 0);
    println!("cyclic {symmetry:.1e}; deflects {stiffer:.3} times as much as on half of the shaft");
    assert!(symmetry < 1e-9, "{symmetry:e}");
    assert!((0.3..0.95).contains(&stiffer), "{stiffer}");
}
