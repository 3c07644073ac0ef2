//! Ring gears: against an envelope of the cutter that is found by force, the external gear with the same space, the
//! formulas of ISO 21771, and pairs with a gear inside, driven from either side.

mod files;
mod outline;
mod pairs;

use gearmesh_geometry::ToothGeometry;
use gearmesh_geometry::definition::{Gearing, InternalRoot, PinionCutter, ToothDefinition};

const M: f64 = 2e-3;

fn alpha() -> f64 {
    20f64.to_radians()
}

fn external(teeth: usize, profile_shift: f64) -> ToothDefinition {
    ToothDefinition {
        teeth,
        module_m: M,
        pressure_angle_rad: alpha(),
        profile_shift,
        addendum: 1.0,
        dedendum: 1.25,
        rack_tip_radius: 0.38,
        face_width_m: 20e-3,
        ..ToothDefinition::default()
    }
}

fn cut(teeth: usize, profile_shift: f64, cutter: PinionCutter) -> ToothDefinition {
    ToothDefinition {
        gearing: Gearing::Internal(InternalRoot::Cutter(cutter)),
        ..external(teeth, profile_shift)
    }
}

const CUTTER: PinionCutter = PinionCutter {
    teeth: 33,
    profile_shift: 0.1,
    addendum: 1.25,
    tip_radius: 0.25,
};

fn broached(teeth: usize, profile_shift: f64) -> ToothDefinition {
    ToothDefinition {
        gearing: Gearing::Internal(InternalRoot::FullRound),
        ..external(teeth, profile_shift)
    }
}

fn geometry(d: &ToothDefinition) -> ToothGeometry {
    ToothGeometry::new(d).unwrap_or_else(|e| panic!("{e}"))
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

fn planet_and_ring(helix_deg: f64) -> [ToothGeometry; 2] {
    let helix_angle_rad = helix_deg.to_radians();
    let planet = ToothDefinition {
        helix_angle_rad,
        thickness_allowance_m: 40e-6,
        ..external(24, 0.2)
    };
    let ring = ToothDefinition {
        addendum: 0.75,
        helix_angle_rad,
        thickness_allowance_m: 60e-6,
        ..cut(
            75,
            -0.2,
            PinionCutter {
                teeth: 27,
                ..CUTTER
            },
        )
    };
    [geometry(&planet), geometry(&ring)]
}
