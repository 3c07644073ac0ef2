//! The orders that a pair's numbers of teeth and openings give, on either of its shafts.

use gearmesh_model::StoredGear;
use gearmesh_scene::SceneResult;
use gearmesh_signal::OrderFilter;

/// A shaft of a pair: whose turns and angles are meant.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Shaft {
    /// Of gear 1, which drives.
    #[default]
    #[serde(rename = "gear_1")]
    Gear1,
    /// Of gear 2.
    #[serde(rename = "gear_2")]
    Gear2,
}

impl Shaft {
    fn index(self) -> usize {
        match self {
            Self::Gear1 => 0,
            Self::Gear2 => 1,
        }
    }
}

impl std::fmt::Display for Shaft {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "gear {}", self.index() + 1)
    }
}

/// Teeth and openings of a pair.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PairOrders {
    /// Numbers of teeth.
    pub teeth: [usize; 2],
    /// Holes or slots of each gear; 0 without.
    pub openings: [usize; 2],
}

impl PairOrders {
    /// Those of a result's gears; none where they are not known.
    pub fn of(result: &SceneResult) -> Option<Self> {
        if let Some(bevel) = &result.bevel {
            return Some(Self {
                teeth: bevel.teeth,
                openings: [0; 2],
            });
        }
        let [Some(gear_1), Some(gear_2)] =
            result.source.gears.each_ref().map(StoredGear::definition)
        else {
            return None;
        };
        let gears = [gear_1, gear_2];
        Some(Self {
            teeth: gears.map(|gear| gear.tooth.teeth),
            openings: gears.map(|gear| gear.blank.openings().map_or(0, |o| o.count())),
        })
    }

    /// Teeth of the gear on a shaft: the order of the mesh.
    pub fn teeth_on(&self, shaft: Shaft) -> usize {
        self.teeth[shaft.index()]
    }

    /// Driver's angle over that of a shaft: z / z₁.
    pub fn driver_turns(&self, shaft: Shaft) -> f64 {
        self.teeth_on(shaft) as f64 / self.teeth[0] as f64
    }

    /// Orders of a shaft at which slots or holes of either gear repeat, n z/z_h, rising.
    pub fn of_openings(&self, shaft: Shaft) -> Vec<f64> {
        let of = |gear: usize| {
            let turns = self.teeth_on(shaft) as f64 / self.teeth[gear] as f64;
            (self.openings[gear] > 0).then_some(self.openings[gear] as f64 * turns)
        };
        let mut orders: Vec<f64> = (0..2).filter_map(of).collect();
        orders.sort_by(f64::total_cmp);
        orders.dedup();
        orders
    }

    /// What is taken out of the transmission error: the mean, and once per revolution of either shaft.
    pub fn filter(&self, shaft: Shaft) -> OrderFilter {
        let mate = self.teeth[1 - shaft.index()];
        OrderFilter::of_transmission_error(self.teeth_on(shaft), mate)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn holes_of_the_wheel_have_no_whole_order_of_the_pinion() {
        let pair = PairOrders {
            teeth: [23, 47],
            openings: [0, 6],
        };
        assert_eq!(pair.of_openings(Shaft::Gear1), [6.0 * 23.0 / 47.0]);
        assert_eq!(pair.of_openings(Shaft::Gear2), [6.0]);
        let slotted = PairOrders {
            teeth: [57, 57],
            openings: [3, 3],
        };
        assert_eq!(slotted.of_openings(Shaft::Gear1), [3.0]);
        assert_eq!(
            (pair.teeth_on(Shaft::Gear2), pair.driver_turns(Shaft::Gear1)),
            (47, 1.0)
        );
    }
}
