//! What a scene will compute, before anything is computed.

use super::rating::PairRating;
use super::run::LoadedScene;
use crate::megabytes::megabytes;
use gearmesh_geometry::Misalignment;

/// Size and effects of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Lines for people: what is computed, with which model.
    pub lines: Vec<String>,
    /// Static positions to solve: angles times torques.
    pub positions: usize,
    /// Largest number of unknown slice forces at a position.
    pub unknowns: usize,
    /// Runs that would cover the periods that this one does not; empty where it covers all.
    pub proposal: String,
}

impl Plan {
    /// Derives the plan of a scene with its loaded models.
    pub fn new(loaded: &LoadedScene) -> Self {
        let LoadedScene {
            scene,
            lines,
            layout,
            ratings,
            ..
        } = loaded;
        let positions = scene.positions() * scene.torques_nm.len();
        let unknowns = lines.most_pairs() * layout.slices;
        let mut text = vec![
            format!("scene      {}", scene.title),
            format!(
                "analysis   static, {} torques x {} positions",
                scene.torques_nm.len(),
                scene.positions()
            ),
        ];
        text.extend(pair_lines(loaded));
        text.push(format!(
            "mesh       `hybrid`, path {}, local `{}`, {} slices, at most {unknowns} unknown forces",
            match scene.edge_radius_m {
                None => "`line-of-action`".to_string(),
                Some(radius) => format!("`extended` with a tip edge radius of {} um", (radius * 1e9).round() / 1e3),
            },
            scene.contact.local.name(),
            layout.slices
        ));
        text.push(match scene.contact.friction {
            None => "friction   not computed".to_string(),
            Some(f) => format!(
                "friction   `coulomb`, coefficient {}, reversal within {} um",
                f.coefficient,
                f.reversal_m * 1e6
            ),
        });
        text.extend(flank_lines(loaded));
        let gauges: usize = scene.gears.iter().map(|gear| gear.gauges.len()).sum();
        text.push(if gauges == 0 {
            "gauges     not computed".to_string()
        } else {
            format!(
                "gauges     {gauges}, methods 1 and 2, {} readings",
                2 * gauges * positions
            )
        });
        text.push(format!(
            "result     {positions} positions, {}",
            megabytes(loaded.result_bytes())
        ));
        text.extend(loaded.period_lines());
        let rated = |r: &PairRating| format!("rating     {}, at each torque: {}", r.name, r.method);
        text.extend(ratings.iter().map(rated));
        Self {
            lines: text,
            positions,
            unknowns,
            proposal: loaded.proposal(&loaded.gauges),
        }
    }
}

/// The two gears, and the pair that they make.
fn pair_lines(loaded: &LoadedScene) -> Vec<String> {
    let [gear_1, gear_2] = &loaded.models;
    let (scene, layout, pair) = (&loaded.scene, &loaded.layout, &loaded.lines.pair);
    let mut text = Vec::new();
    for (number, gear) in [(1, gear_1), (2, gear_2)] {
        let bore = match scene.gears[number - 1].slides {
            true => " whose bore slides on a rigid pin",
            false => "",
        };
        text.push(format!(
            "gear {number}     {}: z {}, body `reduced`{bore}, {} flank loads, {} repeating sectors, from {} degrees of freedom ({})",
            gear.name,
            gear.teeth,
            gear.grid.len(),
            gear.sectors,
            gear.provenance.dofs,
            gear.provenance.element
        ));
    }
    text.push(format!(
        "pair       a {:.4} mm, working pressure angle {:.4} deg, contact ratio {:.4}, backlash {:.4} mm, {} flanks",
        pair.centre_distance_m * 1e3,
        pair.working_pressure_angle_rad.to_degrees(),
        pair.contact_ratio(),
        pair.backlash_m() * 1e3,
        scene.flank.name()
    ));
    text.extend((pair.assembly_words()).map(|words| format!("assembly   {words}")));
    if pair.is_helical() {
        text.push(format!(
            "helix      gear 1 {} hand, gear 2 {} hand, base helix angle {:.4} deg, contact ratio transverse {:.4} + overlap {:.4} = total {:.4}",
            pair.gear_1.hand(),
            pair.gear_2.hand(),
            pair.base_helix_angle_rad().abs().to_degrees(),
            pair.contact_ratio(),
            pair.overlap_ratio(layout.reference.width_m),
            pair.total_contact_ratio(layout.reference.width_m)
        ));
    }
    text
}

/// What is no ideal flank on an ideal axis.
fn flank_lines(loaded: &LoadedScene) -> Vec<String> {
    let [gear_1, gear_2] = &loaded.models;
    let (scene, pair) = (&loaded.scene, &loaded.lines.pair);
    let mut text = Vec::new();
    for (number, gear) in [(1, gear_1), (2, gear_2)] {
        text.extend(
            (gear.crack.as_ref())
                .map(|crack| format!("fault      gear {number}: {}", crack.description())),
        );
    }
    for (number, microgeometry) in [1, 2].into_iter().zip(&loaded.microgeometry) {
        text.push(format!("flanks     gear {number}: {microgeometry}"));
    }
    for (number, gear) in [1, 2].into_iter().zip(&scene.gears) {
        let kinds: Vec<&str> = (gear.errors.iter().map(|error| error.kind()))
            .chain(gear.eccentricity.map(|_| "eccentricity"))
            .collect();
        if !kinds.is_empty() {
            text.push(format!("errors     gear {number}: {}", kinds.join(", ")));
        }
    }
    if pair.misalignment != Misalignment::default() {
        text.push(format!(
            "axes       inclination {:.6} mrad, deviation {:.6} mrad",
            pair.misalignment.inclination_rad * 1e3,
            pair.misalignment.deviation_rad * 1e3
        ));
    }
    text
}
