//! Tooth flanks that face each other at a pose: pairs of teeth, the sections they are seen in, and their slices,
//! whatever the family of the gears.

use std::sync::Arc;

use gearmesh_contact::{ContactPatch, FlankPlace, PatchBalance};

use crate::flank_error::FlankError;
use crate::pose::Vector6;

/// Deviations of one gear's flanks.
pub type FlankErrors = Vec<Arc<dyn FlankError>>;

/// Where two flanks cross the line of action. The slices of a spur pair share the one at mid-face; of helical teeth
/// each slice has its own.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Section {
    /// Roll angles on gear 1 and gear 2 \[rad\]; continued beyond the ends of the path. Of a slice that is partly on
    /// the path that of the part's middle.
    pub roll_rad: [f64; 2],
    /// The same, at most at the end of the flank.
    pub touching_roll_rad: [f64; 2],
    /// Derivatives of the roll angles by the increments of the pose.
    pub roll_gradient: [Vector6; 2],
    /// Width that touches over the slice's width at the reference displacement, above zero: it changes with the overlap
    /// of the faces, and of helical teeth on the rigid path with the part that is on it.
    pub share: f64,
    /// Its derivative by the increments of the pose, and that of ln `stiffness`.
    pub share_gradient: Vector6,
    /// Stiffness of the contact over that which the law states, for families whose curvature changes along the path; 1
    /// elsewhere.
    pub stiffness: f64,
    /// Length of a slice's part that touches, along the contact line \[m\].
    pub length_m: f64,
    /// Relative radius of curvature across the contact line \[m\], and its growth ∂(ln ρ)/∂ξ on gear 1 and gear 2.
    pub radius_m: f64,
    /// See `radius_m`.
    pub radius_growth: [f64; 2],
    /// ∂(ln length)/∂u on gear 1 and gear 2, besides what the share says.
    pub length_growth: [f64; 2],
    /// Derivatives of the places along the teeth of gear 1 and gear 2 by the increments of the pose, where slices walk
    /// along them.
    pub along_gradient: [Vector6; 2],
    /// First of its contacts, and how many there are.
    pub contacts: (usize, usize),
}

impl Section {
    /// Whether the contact walks over the flank of gear 0 or 1; beyond the end of the flank it no longer does.
    #[must_use]
    pub fn walks(&self, gear: usize) -> bool {
        self.roll_rad[gear] == self.touching_roll_rad[gear]
    }
}

/// Two tooth flanks that face each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TeethLine {
    /// Teeth of gear 1 and gear 2.
    pub teeth: [usize; 2],
    /// First of its sections.
    pub section: usize,
    /// Gap that ideal flanks would have in the middle of the zone \[m\], in the transverse plane.
    pub ideal_gap_m: f64,
    /// First of its contacts, and how many there are.
    pub contacts: (usize, usize),
}

/// One slice of such a pair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToothContact {
    /// Number of its line.
    pub line: usize,
    /// Number of the slice.
    pub slice: usize,
    /// Number of its section.
    pub section: usize,
    /// Place along the teeth: heights above the mid-faces of gear 1 and gear 2 \[m\].
    pub heights_m: [f64; 2],
    /// Gap \[m\] along the flanks' normal, open positive.
    pub gap_m: f64,
    /// Rate of the gap \[m/s\].
    pub gap_rate_m_per_s: f64,
    /// Derivative of the gap by the increments of the pose: the load of a unit force on gear 2.
    pub gradient: Vector6,
}

/// Shapes of one gear's modes at the contacts of one side; empty for gears without modes.
#[derive(Debug, Clone, Default)]
pub struct ModalRows {
    /// ω² of each mode \[rad²/s²\].
    pub omega_squared: Vec<f64>,
    /// φ, `[contact][mode]` \[kg^-½\].
    pub shapes: Vec<f64>,
    /// ∂φ/∂ξ, `[contact][mode]`; zero where the contact has reached the end of the flank.
    pub slopes: Vec<f64>,
    /// ∂φ/∂(place along the tooth), `[contact][mode]` \[kg^-½/m\]; empty where slices do not walk along the teeth of
    /// the gear.
    pub slopes_along: Vec<f64>,
    /// How fast flanks slide along each tangent of the friction per unit of η̇, `[contact][mode]` \[kg^-½\]; empty in a
    /// mesh without friction, the second one of flanks that slide along the profile only.
    pub sliding: [Vec<f64>; 2],
}

impl ModalRows {
    /// Number of modes.
    #[must_use]
    pub fn count(&self) -> usize {
        self.omega_squared.len()
    }

    /// Takes everything from other rows but those of sliding, which teeth do not feel; into the memory that is there.
    pub(crate) fn copy_normal_from(&mut self, other: &Self) {
        self.omega_squared.clone_from(&other.omega_squared);
        self.shapes.clone_from(&other.shapes);
        self.slopes.clone_from(&other.slopes);
        self.slopes_along.clone_from(&other.slopes_along);
    }

    /// φ of a contact.
    #[must_use]
    pub fn shape(&self, contact: usize) -> &[f64] {
        self.row(&self.shapes, contact)
    }

    /// ∂φ/∂ξ of a contact.
    #[must_use]
    pub fn slope(&self, contact: usize) -> &[f64] {
        self.row(&self.slopes, contact)
    }

    /// How a contact slides along one of the tangents; empty where it does not.
    #[must_use]
    pub fn sliding(&self, contact: usize, tangent: usize) -> &[f64] {
        self.row(&self.sliding[tangent], contact)
    }

    fn row<'a>(&self, rows: &'a [f64], contact: usize) -> &'a [f64] {
        if rows.is_empty() {
            return &[];
        }
        &rows[contact * self.count()..][..self.count()]
    }
}

/// How the slices stand along the teeth, against where they were laid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AlongTeeth {
    /// How far gear 2 has moved along the teeth from where the slices were laid \[m\].
    pub moved_m: f64,
    /// Width of a whole slice over its width there.
    pub share: f64,
}

impl Default for AlongTeeth {
    /// Where they were laid.
    fn default() -> Self {
        Self {
            moved_m: 0.0,
            share: 1.0,
        }
    }
}

/// Tooth flanks facing each other on one side of the teeth, at one pose. Reused from call to call.
#[derive(Debug, Clone, Default)]
pub struct FlankContacts {
    /// Where the slices stand along the teeth.
    pub along_teeth: AlongTeeth,
    /// How far a contact moves along the line of action as it walks over gear 1's and gear 2's flank \[m\] per unit of
    /// u; on involute flanks the base radii.
    pub action_m_per_u: [f64; 2],
    /// Pairs of teeth.
    pub lines: Vec<TeethLine>,
    /// Sections: one a line of spur teeth, one a contact of helical ones.
    pub sections: Vec<Section>,
    /// Their slices, line by line.
    pub contacts: Vec<ToothContact>,
    /// Shapes of gear 1's and gear 2's vibration modes at them; empty without.
    pub modal: [ModalRows; 2],
    /// How far vibration bends flanks towards each other at most \[m\], as a bound: stated before flanks are looked
    /// for, so that those are found that touch when they are bent.
    pub bent_m: f64,
    /// Gap of ideal flanks in the middle of the zone \[m\] where no flanks of this side can touch and no lines were
    /// looked for.
    pub open_gap_m: Option<f64>,
}

impl FlankContacts {
    /// Memory for so many contacts.
    #[must_use]
    pub fn with_capacity(contacts: usize) -> Self {
        Self {
            along_teeth: AlongTeeth::default(),
            action_m_per_u: [1.0; 2],
            lines: Vec::with_capacity(contacts),
            sections: Vec::with_capacity(contacts),
            contacts: Vec::with_capacity(contacts),
            modal: [ModalRows::default(), ModalRows::default()],
            bent_m: 0.0,
            open_gap_m: None,
        }
    }

    /// Forgets what was found; what is of the modes is left alone.
    pub fn clear(&mut self) {
        self.along_teeth = AlongTeeth::default();
        self.lines.clear();
        self.sections.clear();
        self.contacts.clear();
        self.open_gap_m = None;
    }

    /// Gap \[m\] of ideal flanks of the first pair of teeth, or of flanks that are out of reach; none where no teeth
    /// face each other.
    pub(crate) fn ideal_gap_m(&self) -> Option<f64> {
        let line = self.lines.first().map(|line| line.ideal_gap_m);
        line.or(self.open_gap_m)
    }

    /// Adds the line of two teeth whose contacts, each with a section of its own, are those from `first` on.
    pub(crate) fn add_line(&mut self, teeth: [usize; 2], first: usize, ideal_gap_m: f64) {
        self.lines.push(TeethLine {
            teeth,
            section: first,
            ideal_gap_m,
            contacts: (first, self.contacts.len() - first),
        });
    }

    /// Brings the nearest pair of teeth to the front, and returns its number before: the transmission error is its gap.
    /// Contacts stay where they are.
    pub(crate) fn nearest_first(&mut self) -> Option<usize> {
        let gap_m = |line: usize| self.lines[line].ideal_gap_m;
        let nearest = (0..self.lines.len()).min_by(|a, b| gap_m(*a).total_cmp(&gap_m(*b)));
        let first = nearest?;
        self.lines.swap(0, first);
        for number in [0, first] {
            let (begin, count) = self.lines[number].contacts;
            for contact in &mut self.contacts[begin..begin + count] {
                contact.line = number;
            }
        }
        Some(first)
    }

    /// How deep flanks overlap at most \[m\], along their normal; zero where none do.
    #[must_use]
    pub fn deepest_overlap_m(&self) -> f64 {
        let gaps = self.contacts.iter().map(|contact| contact.gap_m);
        gaps.fold(0.0, |deepest: f64, gap_m| deepest.max(-gap_m))
    }

    /// The patch of a contact of a line with this number, pressed along its normal.
    #[must_use]
    pub fn patch(&self, (number, line): (usize, &TeethLine), contact: usize) -> ContactPatch {
        let contact = &self.contacts[contact];
        let section = self.section(contact);
        ContactPatch {
            teeth: line.teeth,
            line: number,
            slice: contact.slice,
            places: [0, 1].map(|gear: usize| FlankPlace {
                u: section.touching_roll_rad[gear],
                v: contact.heights_m[gear],
            }),
            share: section.share,
            length_m: section.length_m,
            radius_m: section.radius_m,
            radius_growth: section.radius_growth,
            length_growth: section.length_growth,
            normal: [0, 1, 2].map(|axis: usize| contact.gradient[axis]),
            gap_m: contact.gap_m,
            balance: PatchBalance::ALONG_NORMALS,
            edge: None,
        }
    }

    /// The section of a contact.
    #[must_use]
    pub fn section(&self, contact: &ToothContact) -> &Section {
        &self.sections[contact.section]
    }
}
