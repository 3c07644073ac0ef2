//! All figures of a torque of a pair at rest, a row each: how files, studies and people name a figure, in which unit,
//! and where its value stands. Console, JSON, pages, overlays, exported tables, studies, Python and the studio show
//! these rows.

use super::bevel_result::{BevelFigures, BevelRest};
use super::figures::{FigureErrors, PairFigures};
use super::result::SceneResult;

/// What a figure measures. Its unit at each door follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FigureKind {
    /// Torque.
    Torque,
    /// Deflections and errors.
    Length,
    /// Errors of bevel pairs.
    Angle,
    /// Mesh stiffness; people and studies read it over the width of the faces' overlap.
    Stiffness,
    /// Pressure.
    Pressure,
    /// Force.
    Force,
    /// Factors and ratios.
    Factor,
    /// Shares of a whole, which people read in per cent.
    Share,
    /// Relative errors of the solution.
    Residual,
}

/// Who sees a figure. JSON and exported tables have all of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Audience {
    /// People and studies.
    All,
    /// The same, people only where the gears push each other along the axis.
    Helical,
    /// Studies.
    Studies,
    /// Bevel pairs.
    Bevel,
    /// Bevel pairs with a coefficient of friction.
    BevelFriction,
    /// People at the console: how well the positions are solved.
    Console,
}

/// A figure.
#[derive(Debug, Clone, Copy)]
pub struct RestFigure {
    /// Name without unit: `te_mean`.
    pub name: &'static str,
    /// The same for people: "TE mean".
    pub words: &'static str,
    /// What it measures.
    pub kind: FigureKind,
    /// Who sees it.
    pub audience: Audience,
    /// Its value in SI units.
    pub of: fn(&PairFigures) -> f64,
}

macro_rules! figures {
    ($($name:literal $words:literal $kind:ident $audience:ident $of:expr;)*) => {
        [$(RestFigure {
            name: $name,
            words: $words,
            kind: FigureKind::$kind,
            audience: Audience::$audience,
            of: $of,
        }),*]
    };
}

/// The rows, in the order in which people read them.
pub const FIGURES: &[RestFigure] = &figures! {
    "torque" "torque" Torque All |f| f.torque_nm;
    "te_mean" "TE mean" Length All |f| f.te_mean_m;
    "te_peak_to_peak" "TE pk-pk" Length All |f| f.te_peak_to_peak_m;
    "te_unloaded_peak_to_peak" "TE pk-pk without load" Length Studies |f| f.unloaded_peak_to_peak_m;
    "stiffness_secant_mean" "secant" Stiffness All |f| f.secant_mean_n_per_m;
    "stiffness_tangent_mean" "tangent" Stiffness All |f| f.tangent_mean_n_per_m;
    "stiffness_tangent_peak_to_peak" "tangent pk-pk" Stiffness Studies |f| f.tangent_peak_to_peak_n_per_m;
    "k_h_beta" "K_Hbeta" Factor All |f| f.k_h_beta;
    "pressure_largest" "p_H max" Pressure All |f| f.pressure_largest_pa;
    "loaded_te_mean" "TE mean" Angle Bevel |f| of_bevel(f, |b| f.te_mean_m / b.radius_2_m);
    "loaded_te_peak_to_peak" "TE pk-pk" Angle Bevel |f| of_bevel(f, |b| f.te_peak_to_peak_m / b.radius_2_m);
    "best_pair_share_least" "best pair least" Share Bevel |f| of_bevel(f, |b| b.best_pair_shares[0]);
    "best_pair_share_largest" "largest" Share Bevel |f| of_bevel(f, |b| b.best_pair_shares[1]);
    "loaded_pairs_mean" "pairs" Factor Bevel |f| of_bevel(f, |b| b.mean_pairs);
    "pressure_off_tips" "off tips" Pressure Bevel |f| of_bevel(f, |b| b.pressures_pa[0]);
    "pressure_inside" "inside" Pressure Bevel |f| of_bevel(f, |b| b.pressures_pa[1]);
    "load_on_tips_share" "on tips" Share Bevel |f| of_bevel(f, |b| b.tip_share);
    "pattern_toe_share" "pattern toe" Share Bevel |f| of_bevel(f, |b| b.pattern[0][0]);
    "pattern_heel_share" "heel" Share Bevel |f| of_bevel(f, |b| b.pattern[0][1]);
    "pattern_root_share" "root" Share Bevel |f| of_bevel(f, |b| b.pattern[1][0]);
    "pattern_tip_share" "tip" Share Bevel |f| of_bevel(f, |b| b.pattern[1][1]);
    "efficiency" "efficiency" Share BevelFriction |f| of_bevel(f, |b| b.efficiency.unwrap_or(f64::NAN));
    "axial_force_1_mean" "axial force gear 1" Force Helical |f| f.axial_force_1_mean_n;
    "axial_over_normal_force" "axial over normal force" Factor Helical |f| f.axial_force_1_mean_n / f.normal_force_mean_n;
    "torque_balance" "balance" Residual Console |f| f.torque_balance;
    "residual" "residual" Residual Console |f| f.residual;
    "iterations_per_position" "iter/pos" Factor Console |f| f.iterations_per_position;
};

/// A figure that bevel pairs have.
fn of_bevel(figures: &PairFigures, of: impl Fn(&BevelFigures) -> f64) -> f64 {
    figures.bevel.as_ref().map_or(f64::NAN, of)
}

/// An estimated error out of those of a result, as a share; none where it was not estimated.
pub type FigureError = fn(&FigureErrors) -> Option<f64>;

/// Estimated errors of figures: name in files, and the share.
pub const FIGURE_ERRORS: [(&str, FigureError); 6] = [
    ("positions_te_peak_to_peak", |e| e.te_positions),
    ("positions_pressure", |e| e.pressure_positions),
    ("positions_k_h_beta", |e| e.k_h_beta_positions),
    ("slices_k_h_beta", |e| e.slices),
    ("mesh_te_mean", |e| e.mesh_te),
    ("mesh_strain", |e| e.mesh_strain),
];

/// A unit that people read, and the factor that brings SI values there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReadUnit {
    /// Name.
    pub name: &'static str,
    /// Factor.
    pub factor: f64,
    decimals: usize,
}

/// What mesh stiffness is read over: the width of the faces' overlap \[m\]; none where a result does not tell it.
pub type OverWidth = Option<f64>;

impl FigureKind {
    /// The unit that people and studies read.
    #[must_use]
    pub fn read_unit(self, over: OverWidth) -> ReadUnit {
        let (name, factor, decimals) = match (self, over) {
            (Self::Torque, _) => ("N m", 1.0, 1),
            (Self::Length, _) => ("µm", 1e6, 4),
            (Self::Angle, _) => ("µrad", 1e6, 3),
            (Self::Share, _) => ("%", 100.0, 1),
            (Self::Stiffness, Some(width_m)) => ("N/(mm·µm)", 1e-9 / width_m, 4),
            // Of the whole face, for results whose gear files this program does not understand.
            (Self::Stiffness, None) => ("N/µm", 1e-6, 4),
            (Self::Pressure, _) => ("MPa", 1e-6, 1),
            (Self::Force, _) => ("N", 1.0, 3),
            (Self::Factor | Self::Residual, _) => ("", 1.0, 4),
        };
        ReadUnit {
            name,
            factor,
            decimals,
        }
    }

    /// The end of a name: in files, in SI units, and in studies.
    const fn suffixes(self) -> [&'static str; 2] {
        match self {
            Self::Torque => ["_Nm", "_Nm"],
            Self::Length => ["_m", "_um"],
            Self::Angle => ["_rad", "_urad"],
            Self::Stiffness => ["_N_per_m", "_N_per_mm_um"],
            Self::Pressure => ["_Pa", "_MPa"],
            Self::Force => ["_N", "_N"],
            Self::Factor | Self::Share | Self::Residual => ["", ""],
        }
    }
}

impl RestFigure {
    /// Name in files, where values are in SI units: `te_mean_m`.
    #[must_use]
    pub fn name_in_files(&self) -> String {
        self.name.to_owned() + self.kind.suffixes()[0]
    }

    /// Name of the column of a study: `te_mean_um`.
    #[must_use]
    pub fn name_in_studies(&self) -> String {
        self.name.to_owned() + self.kind.suffixes()[1]
    }

    /// The value in the unit of studies.
    #[must_use]
    pub fn studied(&self, figures: &PairFigures, over: OverWidth) -> f64 {
        let factor = match self.kind {
            FigureKind::Share => 1.0,
            kind => kind.read_unit(over).factor,
        };
        factor * (self.of)(figures)
    }

    /// Whether a pair states the figure; `bevel`: what it is as a bevel pair, if it is one.
    #[must_use]
    pub fn is_of(&self, bevel: Option<&BevelRest>) -> bool {
        match self.audience {
            Audience::Bevel => bevel.is_some(),
            Audience::BevelFriction => bevel.is_some_and(|bevel| bevel.friction.is_some()),
            _ => true,
        }
    }

    /// Whether studies have the figure of such a pair; they have a row for each torque.
    #[must_use]
    pub fn is_studied(&self, bevel: Option<&BevelRest>) -> bool {
        let hidden = self.audience == Audience::Console || self.kind == FigureKind::Torque;
        !hidden && self.is_of(bevel)
    }

    /// Words and unit.
    #[must_use]
    pub fn heading(&self, over: OverWidth) -> String {
        let unit = self.kind.read_unit(over).name;
        format!("{} {unit}", self.words).trim_end().to_owned()
    }

    /// The value as people read it.
    #[must_use]
    pub fn text(&self, figures: &PairFigures, over: OverWidth) -> String {
        let value = (self.of)(figures);
        let ReadUnit {
            factor, decimals, ..
        } = self.kind.read_unit(over);
        match self.kind {
            FigureKind::Residual => format!("{value:.1e}"),
            FigureKind::Torque => format!("{value}"),
            _ => format!("{:.decimals$}", factor * value),
        }
    }
}

/// Figures as people read them: heads, and a row of texts for each torque.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FigureTable {
    /// Words and units.
    pub heads: Vec<String>,
    /// Texts under them.
    pub rows: Vec<Vec<String>>,
}

impl FigureTable {
    /// Lines for terminals of any kind: the heads and a line for each row, its cells to the right.
    #[must_use]
    pub fn lines(&self) -> Vec<String> {
        let in_ascii = |head: &String| head.replace('µ', "u").replace('·', " ");
        let heads: Vec<String> = self.heads.iter().map(in_ascii).collect();
        let line = |cells: &Vec<String>| {
            let cells = cells.iter().zip(&heads);
            let cells = cells.map(|(cell, head)| format!("{cell:>0$}", head.len().max(10)));
            cells.collect::<Vec<_>>().join(" ")
        };
        std::iter::once(&heads)
            .chain(&self.rows)
            .map(line)
            .collect()
    }

    /// Of torques of results, by their numbers, in one unit each.
    #[must_use]
    pub fn new(of: &[(&SceneResult, usize)], seen: impl Fn(&RestFigure) -> bool) -> Self {
        let widths: Vec<OverWidth> = of.iter().map(|(r, _)| r.overlap_width_m().ok()).collect();
        let is_known = widths.iter().all(Option::is_some);
        let shown: Vec<&RestFigure> = FIGURES.iter().filter(|figure| seen(figure)).collect();
        let over = |k: usize| widths[k].filter(|_| is_known);
        let first = if of.is_empty() { None } else { over(0) };
        let row = |(k, (result, torque)): (usize, &(&SceneResult, usize))| {
            let figures = result.figures(*torque);
            shown
                .iter()
                .map(|figure| figure.text(&figures, over(k)))
                .collect()
        };
        Self {
            heads: shown.iter().map(|figure| figure.heading(first)).collect(),
            rows: of.iter().enumerate().map(row).collect(),
        }
    }
}

impl SceneResult {
    /// The figures that files have of it.
    pub fn stated_figures(&self) -> impl Iterator<Item = &'static RestFigure> {
        let of_pair = |figure: &&RestFigure| figure.is_of(self.bevel.as_ref());
        FIGURES.iter().filter(of_pair)
    }

    /// Whether people see a figure of this result.
    #[must_use]
    pub fn shows(&self, figure: &RestFigure) -> bool {
        match figure.audience {
            Audience::All => true,
            Audience::Helical => self.has_axial_force(),
            Audience::Bevel | Audience::BevelFriction => figure.is_of(self.bevel.as_ref()),
            Audience::Studies | Audience::Console => false,
        }
    }

    /// All torques as people read them; `console`: with what only the console shows.
    #[must_use]
    pub fn figure_table(&self, console: bool) -> FigureTable {
        let torques: Vec<(&Self, usize)> = (0..self.torque_nm.len()).map(|k| (self, k)).collect();
        FigureTable::new(&torques, |figure| {
            self.shows(figure) || console && figure.audience == Audience::Console
        })
    }
}
