//! The page of `cargo xtask accuracy-cost elements`: cases in, Markdown out.

use std::fmt::Write;

use super::host::Host;
use super::page::{cell, thousands};

/// What is modelled of the gear.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Space {
    /// The cross-section.
    PlaneStrain,
    /// The gear with free ends.
    Whole,
}

impl Space {
    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Self::PlaneStrain => "plane strain",
            Self::Whole => "three dimensions",
        }
    }
}

/// Time and size of a reduction.
#[derive(Debug, Clone, PartialEq)]
pub struct Cost {
    /// Wall time of the process \[s\].
    pub wall_s: f64,
    /// Peak memory \[byte\].
    pub peak_bytes: f64,
    /// Free degrees of freedom.
    pub dofs: u64,
}

/// What a local term makes of a model.
#[derive(Debug, Clone, PartialEq)]
pub struct LocalTerm {
    /// Its name.
    pub name: &'static str,
    /// Relative errors of the deflection, all radii and half widths.
    pub errors: Vec<f64>,
    /// Wall time of a contact position \[s\].
    pub position_s: f64,
}

impl LocalTerm {
    /// Largest |error|.
    pub fn worst(&self) -> f64 {
        self.errors.iter().fold(0.0, |worst, e| e.abs().max(worst))
    }

    /// Root of the mean square.
    pub fn rms(&self) -> f64 {
        let sum: f64 = self.errors.iter().map(|e| e * e).sum();
        (sum / self.errors.len() as f64).sqrt()
    }
}

/// A case that ended well.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// Of the reduction.
    pub cost: Cost,
    /// By local term.
    pub locals: Vec<LocalTerm>,
}

/// One element and mesh size.
#[derive(Debug, Clone)]
pub struct Case {
    /// What is modelled.
    pub space: Space,
    /// Element.
    pub element: &'static str,
    /// Element length on the flank \[mm\].
    pub flank_mm: f64,
    /// Figures, or why there are none.
    pub outcome: Result<Outcome, String>,
}

/// Deflections that the cases are compared with.
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    /// Radii \[mm\].
    pub radii_mm: Vec<f64>,
    /// What the third dimension changes, of the deflection in three dimensions, by radius.
    pub change: Vec<f64>,
    /// How far of that was extrapolated.
    pub step: Vec<f64>,
    /// \[µm\], `[half width][radius]`.
    pub plane_um: Vec<Vec<f64>>,
    /// The same in three dimensions.
    pub whole_um: Vec<Vec<f64>>,
}

impl Reference {
    /// Deflections \[µm\], `[half width][radius]`.
    pub fn of(&self, space: Space) -> &[Vec<f64>] {
        match space {
            Space::PlaneStrain => &self.plane_um,
            Space::Whole => &self.whole_um,
        }
    }
}

/// Radius \[mm\] and deflections \[µm\], one a half width.
pub type PlaneGearRow = (f64, Vec<f64>);

/// Half widths \[mm\] from the heads of the columns of `reference/plane_gear/data.csv`; radius \[mm\] and deflections
/// \[µm\] of each row.
pub fn read_plane_gear(text: &str) -> Option<(Vec<f64>, Vec<PlaneGearRow>)> {
    let mut lines = text.lines();
    let half_widths = lines
        .next()?
        .split(',')
        .skip(1)
        .map(|head| {
            let number = head.strip_prefix("deflection_um_at_half_width_")?;
            number.strip_suffix("_mm")?.parse().ok()
        })
        .collect::<Option<Vec<f64>>>()?;
    let rows = lines
        .map(|line| {
            let values = line.split(',').map(|v| v.parse().ok());
            let values = values.collect::<Option<Vec<f64>>>()?;
            let (radius, deflections) = values.split_first()?;
            (deflections.len() == half_widths.len()).then(|| (*radius, deflections.to_vec()))
        })
        .collect::<Option<Vec<_>>>()?;
    Some((half_widths, rows))
}

/// The whole page.
pub fn page(
    host: &Host,
    program: &str,
    reference: &Reference,
    cases: &[Case],
    picture: &str,
) -> String {
    let per_cent = |values: &[f64]| {
        let values: Vec<String> = values.iter().map(|v| format!("{:.2}", 100.0 * v)).collect();
        values.join(", ")
    };
    let radii: Vec<String> = reference
        .radii_mm
        .iter()
        .map(|r| format!("{r:.2}"))
        .collect();
    let mut page = format!(
        "# Accuracy and cost of elements, mesh sizes and local terms\n\n\
        Written by `cargo xtask accuracy-cost elements`; do not edit.\n\n\
        | | |\n| --- | --- |\n\
        | processor | {}, {} cores |\n| memory | {} |\n| system | {} |\n| date | {} |\n| commit | {} |\n\
        | program | {program} |\n\n\
        ![largest error over the time of a reduction]({picture})\n\n\
        Solid gear, z 50, m 3 mm, bore radius 30 mm fixed, E 206 GPa, 20 mm wide; 100 N/mm over the whole width on one right flank; \
        deflection of the contact's centre along the normal, mean over the width, at seven radii under Hertz half widths of 0.06 and 0.12 mm. \
        Body and axial element lengths are in the default's proportion to that on the flank (default 0.9 mm), those of fillets in that of quadratic elements (0.24 mm).\n\n\
        - **Error in plane strain**: against `reference/plane_gear`, computed by other software, good to 0.05 %.\n\
        - **Error in three dimensions**: against the same plus what free ends change, computed by this program as the difference of \
        its deflections in three dimensions and in plane strain on two finer meshes, extrapolated. At radii {} mm that is {} % of the \
        deflection, of which {} % were extrapolated.\n\
        - **Cost**: `gearmesh reduce --no-error-estimate`, one process on all cores; *position* is a contact position of the gear with \
        itself, five slices, as `gearmesh run` tells it.\n",
        host.cpu,
        host.cores,
        host.memory,
        host.system,
        host.date,
        host.commit,
        radii.join(", "),
        per_cent(&reference.change),
        per_cent(&reference.step),
    );
    for space in [Space::PlaneStrain, Space::Whole] {
        let _ = write!(
            page,
            "\n## {}\n\n{}",
            capital(space.name()),
            table(space, cases)
        );
    }
    page
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| {
        first.to_uppercase().chain(letters).collect()
    })
}

fn table(space: Space, cases: &[Case]) -> String {
    let mut table = String::from(
        "| element | flank mm | DOF | reduce s | peak GB | local term | max error % | rms error % | position µs |\n\
         | --- | ---: | ---: | ---: | ---: | --- | ---: | ---: | ---: |\n",
    );
    for case in cases.iter().filter(|case| case.space == space) {
        match &case.outcome {
            Ok(Outcome { cost, locals }) => {
                for local in locals {
                    let _ = writeln!(
                        table,
                        "| {} | {} | {} | {:.1} | {:.2} | {} | {:.2} | {:.2} | {:.1} |",
                        case.element,
                        case.flank_mm,
                        thousands(cost.dofs),
                        cost.wall_s,
                        cost.peak_bytes / 1e9,
                        local.name,
                        100.0 * local.worst(),
                        100.0 * local.rms(),
                        1e6 * local.position_s
                    );
                }
            }
            Err(reason) => {
                let _ = writeln!(
                    table,
                    "| {} | {} | {}{}",
                    case.element,
                    case.flank_mm,
                    cell(reason),
                    " |".repeat(7)
                );
            }
        }
    }
    table
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn case(outcome: Result<Outcome, String>) -> Case {
        Case {
            space: Space::Whole,
            element: "hex20",
            flank_mm: 0.8,
            outcome,
        }
    }

    #[test]
    fn every_line_has_all_columns() {
        let good = Outcome {
            cost: Cost {
                wall_s: 2.0,
                peak_bytes: 5e8,
                dofs: 123_456,
            },
            locals: vec![LocalTerm {
                name: "none",
                errors: vec![0.03, -0.04],
                position_s: 3.24e-6,
            }],
        };
        let cases = [
            case(Ok(good)),
            case(Err("exit code 2: no | such\nelement".into())),
        ];
        let table = table(Space::Whole, &cases);
        for line in table.lines() {
            assert_eq!(line.replace("\\|", "").matches('|').count(), 10, "{line}");
        }
        assert!(
            table.contains("| hex20 | 0.8 | 123 456 | 2.0 | 0.50 | none | 4.00 | 3.54 | 3.2 |"),
            "{table}"
        );
        assert_eq!(super::table(Space::PlaneStrain, &cases).lines().count(), 2);
    }

    #[test]
    fn the_reference_is_read_with_its_half_widths() {
        let text = "radius_mm,deflection_um_at_half_width_0.06_mm,deflection_um_at_half_width_0.12_mm\n72.6,3.0,2.8\n";
        assert_eq!(
            read_plane_gear(text),
            Some((vec![0.06, 0.12], vec![(72.6, vec![3.0, 2.8])]))
        );
        assert_eq!(read_plane_gear("radius_mm,other\n1,2\n"), None);
        assert_eq!(read_plane_gear(&text.replace(",2.8", "")), None);
    }
}
