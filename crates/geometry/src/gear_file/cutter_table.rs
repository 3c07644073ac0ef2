//! `[tooth.cutter]`: the pinion cutter of internal teeth.

use super::TableKeys;
use crate::definition::{PinionCutter, ToothDefinition};
use crate::input::{Bounded, InputDocument, InputError, NotNegative, Positive, Within};
use schemars::JsonSchema;
use serde::Deserialize;

/// The keys of `[tooth.cutter]`.
#[derive(Deserialize, JsonSchema, Default)]
#[serde(deny_unknown_fields)]
pub(super) struct CutterTable {
    /// Number of teeth; where not given the fewest, from a third of the ring's on, whose involute reaches the ring's
    /// tip and whose tip runs clear of it.
    teeth: Option<usize>,
    /// Profile shift coefficient in modules; 0 where not given.
    profile_shift: Option<Bounded<Within<-2, 2>>>,
    /// Addendum in modules: its tip diameter is its reference diameter + 2 m (addendum + profile_shift); 1.25 where not
    /// given.
    addendum: Option<Bounded<Positive>>,
    /// Radius of its tip edges in modules, in the transverse section; 0.25, or the largest that fits, where not given.
    tip_radius: Option<Bounded<NotNegative>>,
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
        Ok(PinionCutter::suited(
            tooth,
            self.teeth,
            self.profile_shift.map_or(0.0, f64::from),
            self.addendum.map(f64::from),
            self.tip_radius.map(f64::from),
        ))
    }
}
