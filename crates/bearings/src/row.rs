//! A row of balls or rollers of whichever kind.

use crate::ball_row::BallRow;
use crate::barrel_row::BarrelRow;
use crate::element_load::ElementLoad;
use crate::four_point_row::FourPointRow;
use crate::point_contact::ContactEllipse;
use crate::roller_row::RollerRow;

/// A row.
#[derive(Debug, Clone, PartialEq)]
pub enum Row {
    /// Of balls.
    Ball(BallRow),
    /// Of balls between grooves of two arcs each.
    FourPoint(Box<FourPointRow>),
    /// Of cylindrical or tapered rollers.
    Roller(RollerRow),
    /// Of barrels.
    Barrel(Box<BarrelRow>),
}

impl Row {
    /// Number of balls or rollers.
    #[must_use]
    pub fn elements(&self) -> usize {
        match self {
            Self::Ball(row) => row.balls,
            Self::FourPoint(row) => row.balls,
            Self::Roller(row) => row.rollers,
            Self::Barrel(row) => row.rollers,
        }
    }

    /// Whether a ball or roller is there.
    #[must_use]
    pub fn has(&self, element: usize) -> bool {
        match self {
            Self::Ball(row) => row.has(element),
            Self::FourPoint(_) | Self::Barrel(_) => true,
            Self::Roller(row) => !row.missing.contains(&element),
        }
    }

    /// A row of cylindrical or tapered rollers; none of other elements.
    pub(crate) fn rollers(&self) -> Option<&RollerRow> {
        match self {
            Self::Roller(row) => Some(row),
            Self::Ball(_) | Self::FourPoint(_) | Self::Barrel(_) => None,
        }
    }

    /// d_m/2 \[m\].
    #[must_use]
    pub fn pitch_radius_m(&self) -> f64 {
        match self {
            Self::Ball(row) => row.pitch_radius_m,
            Self::FourPoint(row) => row.pitch_radius_m,
            Self::Roller(row) => row.pitch_radius_m,
            Self::Barrel(row) => row.pitch_radius_m,
        }
    }

    /// Contact ellipses of a ball at the inner and outer race; none for rollers.
    #[must_use]
    pub fn ellipses(&self, load: &ElementLoad) -> [Option<ContactEllipse>; 2] {
        match self {
            Self::Ball(row) => [
                Some(row.inner.contact.ellipse(load.inner_load_n)),
                Some(row.outer.contact.ellipse(load.outer_load_n)),
            ],
            Self::FourPoint(row) => [
                Some(row.inner[0].groove.contact.ellipse(load.inner_load_n)),
                Some(row.outer[0].groove.contact.ellipse(load.outer_load_n)),
            ],
            Self::Roller(_) | Self::Barrel(_) => [None; 2],
        }
    }

    /// Peak pressures at the inner and outer race under an element's load \[Pa\]; of rollers those of the lamina that
    /// carries most.
    #[must_use]
    pub fn peak_pressures_pa(&self, load: &ElementLoad) -> [f64; 2] {
        match self {
            Self::Ball(_) | Self::FourPoint(_) => self
                .ellipses(load)
                .map(|ellipse| ellipse.map_or(0.0, |ellipse| ellipse.peak_pressure_pa)),
            Self::Barrel(row) => [
                row.contacts[0].peak_pressure_pa(load.inner_line_load_n_per_m),
                row.contacts[1].peak_pressure_pa(load.outer_line_load_n_per_m),
            ],
            Self::Roller(row) => [
                row.inner
                    .contact
                    .peak_pressure_pa(load.inner_line_load_n_per_m),
                row.outer
                    .contact
                    .peak_pressure_pa(load.outer_line_load_n_per_m),
            ],
        }
    }
}
