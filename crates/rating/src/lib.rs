#![doc = include_str!("../README.md")]
//! # Where things are
//!
//! Rating: is the tooth strong enough, and for how long.
//!
//! | you have | you want | use |
//! | --- | --- | --- |
//! | a tooth and where it is loaded | root section, Lewis factor, nominal bending stress | [`RootSection`] |
//! | a helical tooth | the spur gear of its normal section | [`VirtualGear`] |
//! | a pair | the highest point of single contact | [`highest_single_contact_rolls_rad`] |
//! | a pair and its normal force | Lewis's stresses and the flank pressure, and the nominal stresses of ISO 6336 | [`NominalRating`] |
//! | a pair and a line load | Hertz pressure along the path | [`flank_pressure`] |
//! | strain of a root gauge | stress | [`root_stress_pa`] |
//! | a stress history | cycles | [`rainflow()`], of a long one that comes in pieces over its [`TurningPoints`] |
//! | a table or slopes | cycles to failure of an amplitude | [`SnCurve`] |
//! | cycles and an S-N curve | damage, life | [`miner_damage`], [`history_damage`] |
//!
//! The root section's stress is nominal: no notch factor. Recovered root strain holds the notch already; its S-N table
//! must be one of local stress. SI units; megapascals exist in S-N tables only. Equations: docs/theory/rating.md.

mod contact_length;
mod damage;
mod damage_error;
mod flank_pressure;
mod iso_nominal;
mod mean_stress;
mod nominal;
mod rainflow;
mod root_section;
mod root_stress;
mod sn_curve;
mod sn_table;
mod virtual_gear;

pub use contact_length::shortest_contact_length_m;
pub use damage::{Damage, history_damage, miner_damage};
pub use damage_error::DamageError;
pub use flank_pressure::{FlankPressure, FlankPressureError, flank_pressure};
pub use iso_nominal::{IsoPressure, IsoRoot};
pub use mean_stress::MeanStress;
pub use nominal::{NominalError, NominalRating, NominalStresses};
pub use rainflow::{Cycle, Passage, RainflowError, TurningPoints, rainflow, turning_points};
pub use root_section::{
    LoadPoint, RootConstruction, RootSection, RootSectionError, highest_single_contact_roll_rad,
    highest_single_contact_rolls_rad, lewis_stress_pa,
};
pub use root_stress::{SurfaceState, root_stress_pa};
pub use sn_curve::{AboveTable, BelowTable, SnCurve, SnError, SnPoint};
pub use sn_table::{SnTable, SnTableError};
pub use virtual_gear::VirtualGear;
