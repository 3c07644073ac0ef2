//! Involute pairs at rest with friction, errors of single flanks (flank_deviations.rs), and gears that stand beside the
//! axes about which they turn (runout.rs): the patches of their contact lines (contact_lines.rs).

use crate::contact_error::ContactError;
use crate::contact_lines::{ContactLine, ContactLines, Friction};
use crate::contact_patch::ContactPatch;
use crate::contact_zone::SliceLayout;
use crate::flank_deviations::FlankDeviations;
use crate::flanks_at_rest::FlanksAtRest;
use crate::runout::{Placement, Runout};
use crate::tip_contact::TipGear;

/// Gap of a slice without flank \[m\]: beyond any deflection, and small enough for the solver's sums.
const NO_FLANK_M: f64 = 1.0;

/// Flanks of an involute pair at rest.
#[derive(Debug, Clone)]
pub struct InvoluteAtRest {
    lines: ContactLines,
    layout: SliceLayout,
    friction: Option<Friction>,
    pub(crate) deviations: FlankDeviations,
    pub(crate) runout: Option<Runout>,
    active: Vec<ContactLine>,
}

impl InvoluteAtRest {
    /// The flanks of a pair on these slices; the lines reach as far as they do.
    #[must_use]
    pub fn new(mut lines: ContactLines, layout: SliceLayout, friction: Option<Friction>) -> Self {
        lines.zone = layout.reference;
        Self {
            active: Vec::with_capacity(most_lines(&lines)),
            lines,
            layout,
            friction,
            deviations: FlankDeviations::default(),
            runout: None,
        }
    }

    /// Contact lines at the last driver angle.
    #[must_use]
    pub fn active_lines(&self) -> &[ContactLine] {
        &self.active
    }

    /// Lets errors of single flanks and the places of the gears on their bodies act on the patches.
    fn displace(
        &self,
        placement: &Placement,
        patches: &mut [ContactPatch],
    ) -> Result<(), ContactError> {
        let pair = &self.lines.pair;
        let transverse = pair.base_helix_angle_rad().cos();
        let [arm_1, arm_2] = placement.arms_m.map(|arm| transverse * arm);
        let mut some_flank = false;
        for patch in patches {
            let deviation =
                (self.deviations).opening_m(patch, [0, 1].map(|gear| pair.flank_of(gear)));
            some_flank |= deviation.is_finite();
            let balance = &mut patch.balance;
            balance.closing += arm_2 / pair.gear_2.base_radius_m;
            balance.levers_m[0] += arm_1;
            balance.levers_m[1] += arm_2;
            // Gears beside their axes stand as rigid flanks leave them; the gap is linear in the approach about there.
            patch.gap_m += deviation.min(NO_FLANK_M) + balance.closing * placement.opening_m;
        }
        if some_flank {
            Ok(())
        } else {
            Err(ContactError::NoFlanks)
        }
    }
}

/// Most lines at once: gears beside their axes may stand closer together than the pair.
pub(crate) fn most_lines(lines: &ContactLines) -> usize {
    lines.most_pairs() + 1
}

impl FlanksAtRest for InvoluteAtRest {
    fn patches_at(
        &mut self,
        driver_angle_rad: f64,
        patches: &mut Vec<ContactPatch>,
    ) -> Result<(), ContactError> {
        let placement = (self.runout).map_or_else(Placement::default, |runout| {
            runout.at(&self.lines.pair, driver_angle_rad)
        });
        self.lines.place(&placement);
        let angle_rad = driver_angle_rad + placement.ahead_rad;
        self.lines.at(angle_rad, &mut self.active);
        for line in self.active.iter().enumerate() {
            (self.lines).push_patches(line, &self.layout, self.friction, patches);
        }
        self.displace(&placement, patches)
    }

    fn lines(&self) -> usize {
        self.active.len()
    }

    fn pair_and_tip(&self, line: usize) -> (i64, Option<TipGear>) {
        let line = &self.active[line];
        (line.pair, line.tip.map(|tip| tip.tip_gear))
    }

    fn radius_2_m(&self) -> f64 {
        self.lines.pair.gear_2.base_radius_m
    }
}
