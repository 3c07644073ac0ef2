//! From what a pair file asks to machine settings and flanks of both members.

use crate::basic_settings::{Process, basic_settings, crown_settings};
use crate::blank::{PairBlank, ToothForm};
use crate::cut_thickness::{ThicknessFrom, settings_of_thickness};
use crate::error::BevelError;
use crate::flank::Flank;
use crate::grid_surface::GridSurface;
use crate::hand::FlankSide;
use crate::local_synthesis::{Synthesis, SynthesisTarget};
use crate::settings::MachineSettings;
use crate::settings_search::{AskedEaseOff, settings_for, settings_for_ease_off};
use crate::tooth::Tooth;

/// Where the settings of a member come from; those of two flanks are concave, convex.
#[derive(Debug, Clone, PartialEq)]
pub enum Cutting {
    /// By the pair's crown gear: conjugate to a mate cut so, too.
    Crown,
    /// Basic settings.
    Basic(Process),
    /// Pinion: each flank by local synthesis.
    Synthesis([Synthesis; 2]),
    /// Pinion: each flank fitted to an ease-off.
    EaseOff([AskedEaseOff; 2]),
    /// As stated, and which thickness the teeth have, where that is stated.
    Given([MachineSettings; 2], Option<ThicknessFrom>),
    /// Not cut here: through measured or published points.
    Points(Box<[GridSurface; 2]>),
}

/// A pair with settings.
#[derive(Debug, Clone, PartialEq)]
pub struct PairDesign {
    /// Settings of pinion and gear, each concave, convex; none of a member from points.
    pub settings: [Option<[MachineSettings; 2]>; 2],
    /// Pinion and gear.
    pub teeth: [Tooth; 2],
    /// Root mean square of what a fit to an ease-off left, concave and convex flank of the pinion \[m\].
    pub fit_rms_m: Option<[f64; 2]>,
}

impl PairDesign {
    /// Settings and flanks of a pair; `cutting` and edge radii of the blades are those of pinion and gear.
    ///
    /// # Errors
    /// [`BevelError`] where no settings are found, or the tool does not reach the mean points.
    pub fn new(
        blank: &PairBlank,
        cutting: &[Cutting; 2],
        edge_radius_m: [f64; 2],
    ) -> Result<Self, BevelError> {
        let data = &blank.data;
        let derived = |i: usize| -> Result<[MachineSettings; 2], BevelError> {
            let member = &blank.members[i];
            let crown =
                || FlankSide::BOTH.map(|side| crown_settings(member, data, side, edge_radius_m[i]));
            match &cutting[i] {
                Cutting::Given(settings, _) => Ok(*settings),
                Cutting::Crown => Ok(crown()),
                Cutting::Basic(_) if data.form == ToothForm::Straight => Ok(crown()),
                Cutting::Basic(process) => {
                    // The formula's point width is that of the pitch cone: the slot that is cut is not quite the
                    // blank's.
                    let basic = basic_settings(member, data, edge_radius_m[i], *process)?;
                    settings_of_thickness(member, &basic, member.mean_thickness_m)
                }
                // Where the search begins.
                Cutting::Synthesis(_) | Cutting::EaseOff(_) | Cutting::Points(_) => {
                    basic_settings(member, data, edge_radius_m[i], Process::Generated)
                }
            }
        };
        let thickness = |i: usize| match &cutting[i] {
            Cutting::Given(_, asked) => *asked,
            // One operation only where its point width was found above.
            Cutting::Basic(_) => None,
            _ => Some(ThicknessFrom::Blank),
        };
        let (gear_settings, gear) = match &cutting[1] {
            Cutting::Points(grids) => (None, Tooth::through(&blank.members[1], grids)?),
            _ => {
                let settings = derived(1)?;
                let tooth = Tooth::cut(&blank.members[1], &settings, thickness(1))?;
                (Some(settings), tooth)
            }
        };
        if let Cutting::Points(grids) = &cutting[0] {
            return Ok(Self {
                settings: [None, gear_settings],
                teeth: [Tooth::through(&blank.members[0], grids)?, gear],
                fit_rms_m: None,
            });
        }
        let mut pinion_settings = derived(0)?;
        let mut fit_rms_m = None;
        match &cutting[0] {
            Cutting::Synthesis(asked) => {
                for (i, side) in FlankSide::BOTH.into_iter().enumerate() {
                    let target = SynthesisTarget::new(blank, gear.flank(side.mate()), &asked[i])?;
                    pinion_settings[i] = settings_for(blank, side, &pinion_settings[i], &target)?;
                }
            }
            Cutting::EaseOff(asked) => {
                let mut left = [0.0; 2];
                for (i, side) in FlankSide::BOTH.into_iter().enumerate() {
                    (pinion_settings[i], left[i]) = settings_for_ease_off(
                        blank,
                        gear.flank(side.mate()),
                        &pinion_settings[i],
                        &asked[i],
                    )?;
                }
                fit_rms_m = Some(left);
            }
            _ => {}
        }
        let pinion = Tooth::cut(&blank.members[0], &pinion_settings, thickness(0))?;
        Ok(Self {
            settings: [Some(pinion_settings), gear_settings],
            teeth: [pinion, gear],
            fit_rms_m,
        })
    }

    /// Flanks in contact: the pinion's and its mate's.
    pub fn flanks(&self, pinion: FlankSide) -> [&Flank; 2] {
        [
            self.teeth[0].flank(pinion),
            self.teeth[1].flank(pinion.mate()),
        ]
    }
}
