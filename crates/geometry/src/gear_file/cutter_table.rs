//! `[tooth.cutter]`: the pinion cutter of internal teeth.

use super::TableKeys;
use crate::definition::{PinionCutter, ToothDefinition};
use crate::input::{InputDocument, InputError};
use schemars::JsonSchema;
use serde::Deserialize;

/// The keys of `[tooth.cutter]`.
#[derive(Deserialize, JsonSchema, Default)]
#[serde(deny_unknown_fields)]
pub(super) struct CutterTable {
    /// Number of teeth; where not given the fewest, from a third of the ring's on, whose involute reaches the ring's tip
    /// and whose tip runs clear of it.
    teeth: Option<usize>,
    /// Profile shift coefficient in modules; 0 where not given.
    #[serde(default)]
    profile_shift: f64,
    /// Addendum in modules: its tip diameter is its reference diameter + 2 m (addendum + profile_shift); 1.25 where not
    /// given.
    addendum: Option<f64>,
    /// Radius of its tip edges in modules, in the transverse section; 0.25, or the largest that fits, where not given.
    tip_radius: Option<f64>,
}

impl CutterTable {
    /// The cutter; `tooth` are the teeth that it cuts.
    pub(super) fn check(
        self,
        document: &InputDocument,
        tooth: &ToothDefinition,
    ) -> Result<PinionCutter, InputError> {
        let keys = TableKeys::new(document, "tooth.cutter");
        let most = tooth.teeth.saturating_sub(3);
        if let Some(teeth) = self.teeth {
            keys.require(
                "teeth",
                teeth as f64,
                (5..=most).contains(&teeth),
                &format!("5 to {most}, three less than the ring's"),
            )?;
        }
        let shift = self.profile_shift;
        keys.require("profile_shift", shift, shift.abs() <= 2.0, "-2 to 2")?;
        for (key, value, least, allowed) in [
            (
                "addendum",
                self.addendum,
                f64::MIN_POSITIVE,
                "more than 0 (multiples of the module)",
            ),
            (
                "tip_radius",
                self.tip_radius,
                0.0,
                "0 or more (multiples of the module)",
            ),
        ] {
            if let Some(value) = value {
                keys.require(key, value, value >= least, allowed)?;
            }
        }
        Ok(PinionCutter::suited(
            tooth,
            self.teeth,
            shift,
            self.addendum,
            self.tip_radius,
        ))
    }
}
