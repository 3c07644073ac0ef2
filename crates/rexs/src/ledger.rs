//! The list of what became of a model: taken, assumed, not represented.

use crate::mesh_model::Meshes;
use std::collections::{BTreeMap, HashMap};
use std::hash::{DefaultHasher, Hash, Hasher};

/// What an entry is about. How much of a scene's figures it may change follows from that, and from nothing else.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum About {
    /// A load, stage, support or speed of the file does not act in the scene as the file has it.
    Lost,
    /// A torque or a speed that the file does not state, or states in two ways.
    Torque,
    /// What stands where: lever arms, directions of tooth forces.
    Place,
    /// Which bearing holds what.
    Support,
    /// Stiffness of bearings, couplings, shafts, materials.
    Stiffness,
    /// Pressure angle, profile shift, tip and root circle: tooth forces and mesh stiffness.
    Teeth,
    /// Bodies of gears below the teeth, which only reduced gears feel.
    Blank,
    /// Flank modifications, which only meshes of reduced gears feel.
    Flanks,
    /// Less than 1 % of torques, forces and stiffness: backlash, what stands for rigid, roots, torques that follow from
    /// the file.
    Small,
    /// Nothing that a scene computes: words, other programs' results, files beside the scene, what the file itself
    /// says.
    Nothing,
}

/// How much of the figures of a scene an entry may change.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Weight {
    /// The scene is not the gearbox of the file: told before anything else.
    Warning,
    /// A torque, a force or a stiffness by more than 1 %.
    Heavy,
    /// Less.
    Light,
}

impl About {
    /// That where what it is about is large, else [`Self::Small`].
    pub fn by(is_large: bool, large: Self) -> Self {
        match is_large {
            true => large,
            false => Self::Small,
        }
    }

    /// Its weight, in scenes with these meshes.
    pub fn weight(self, with: Meshes) -> Weight {
        match self {
            Self::Lost => Weight::Warning,
            Self::Torque | Self::Place | Self::Support | Self::Stiffness | Self::Teeth => {
                Weight::Heavy
            }
            Self::Blank | Self::Flanks if with == Meshes::Hybrid => Weight::Heavy,
            Self::Blank | Self::Flanks | Self::Small | Self::Nothing => Weight::Light,
        }
    }
}

/// One line.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Entry {
    /// The component, or the file.
    pub subject: String,
    /// What about it.
    pub text: String,
    /// What kind of thing it touches.
    pub about: About,
    /// Whether it is a single value that no part of the import asked for, rather than a component, a relation or a
    /// judgement.
    pub is_value: bool,
}

/// What became of a model.
#[derive(Debug, Clone, Default)]
pub struct Ledger {
    /// Values that stand in the files that were made.
    pub taken: Vec<Entry>,
    /// What the model does not say and the files need, or says in a way that had to be interpreted.
    pub assumed: Vec<Entry>,
    /// What the model says and the files do not.
    pub not_represented: Vec<Entry>,
    /// Places of the entries, by hash and list.
    known: HashMap<(u64, u8), Vec<usize>>,
}

impl Ledger {
    fn add(&mut self, list: u8, subject: &str, about: About, text: String, is_value: bool) {
        let entry = Entry {
            subject: subject.to_owned(),
            text,
            about,
            is_value,
        };
        let entries = match list {
            0 => &mut self.taken,
            1 => &mut self.assumed,
            _ => &mut self.not_represented,
        };
        let mut hasher = DefaultHasher::new();
        entry.hash(&mut hasher);
        let same_hash = self.known.entry((hasher.finish(), list)).or_default();
        // Load cases read the same components again.
        if same_hash.iter().all(|&place| entries[place] != entry) {
            same_hash.push(entries.len());
            entries.push(entry);
        }
    }

    /// A value was taken.
    pub fn take(&mut self, subject: &str, text: impl Into<String>) {
        self.add(0, subject, About::Nothing, text.into(), false);
    }

    /// Something was assumed.
    pub fn assume(&mut self, subject: &str, about: About, text: impl Into<String>) {
        self.add(1, subject, about, text.into(), false);
    }

    /// Something is not represented.
    pub fn leave_out(&mut self, subject: &str, about: About, text: impl Into<String>) {
        self.add(2, subject, about, text.into(), false);
    }

    /// A value that no part of the import asked for.
    pub fn leave_out_value(&mut self, subject: &str, text: impl Into<String>) {
        self.add(2, subject, About::Nothing, text.into(), true);
    }

    /// What was assumed or left out, of a weight in scenes with these meshes: judgements, which tell what came of it,
    /// before omissions.
    pub fn of_weight(&self, weight: Weight, with: Meshes) -> impl Iterator<Item = &Entry> {
        let all = self.assumed.iter().chain(&self.not_represented);
        all.filter(move |e| e.about.weight(with) == weight)
    }

    /// The list as a page (Markdown), for scenes with these meshes: the heavy first.
    pub fn page(&self, title: &str, with: Meshes) -> String {
        let mut page = format!("# {title}\n");
        let judged = [
            (
                "Warnings",
                "What makes the scenes another gearbox than that of the file.",
                Weight::Warning,
            ),
            (
                "More than 1 %",
                "What may change a torque, a force or a stiffness by more than 1 %.",
                Weight::Heavy,
            ),
        ];
        for (head, words, weight) in judged {
            let entries: Vec<&Entry> = self.of_weight(weight, with).collect();
            if !entries.is_empty() {
                part(&mut page, head, words, &entries);
            }
        }
        let light = |entries: &'_ [Entry]| -> Vec<Entry> {
            let light = entries
                .iter()
                .filter(|e| e.about.weight(with) == Weight::Light);
            light.cloned().collect()
        };
        let parts = [
            (
                "Not represented",
                "What the file says and the files made of it do not.",
                light(&self.not_represented),
            ),
            (
                "Assumed",
                "What the file does not say, or says in a way that had to be interpreted; less than 1 %.",
                light(&self.assumed),
            ),
            (
                "Taken",
                "Values of the file that stand in the files made of it.",
                self.taken.clone(),
            ),
        ];
        for (head, words, entries) in parts {
            part(&mut page, head, words, &entries.iter().collect::<Vec<_>>());
        }
        page
    }
}

/// A part of the page, by subject in the order in which they come.
fn part(page: &mut String, head: &str, words: &str, entries: &[&Entry]) {
    page.push_str(&format!("\n## {head} ({})\n\n{words}\n", entries.len()));
    let mut places: BTreeMap<&str, usize> = BTreeMap::new();
    let mut subjects: Vec<Vec<&Entry>> = Vec::new();
    for entry in entries {
        let place = *places.entry(&entry.subject).or_insert(subjects.len());
        if place == subjects.len() {
            subjects.push(Vec::new());
        }
        subjects[place].push(entry);
    }
    for subject in subjects {
        for (i, entry) in subject.iter().enumerate() {
            if i == 0 {
                page.push_str(&format!("\n**{}**\n\n", entry.subject));
            }
            page.push_str(&format!("- {}\n", entry.text));
        }
    }
}
