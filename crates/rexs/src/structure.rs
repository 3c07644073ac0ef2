//! Which component belongs to which, from the relations.

use crate::effort;
use crate::error::{Result, RexsError};
use crate::ledger::{About, Ledger};
use crate::model::{Model, Relation};
use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

/// A stage and its two gears.
#[derive(Debug, Clone, Copy)]
pub struct Stage {
    /// Component of the stage.
    pub id: i64,
    /// First and second gear.
    pub gears: [i64; 2],
}

/// The relations whose components are all there.
#[derive(Debug)]
pub struct Structure {
    relations: Vec<Relation>,
    kinds: BTreeMap<i64, String>,
    /// Relations in which a component takes part.
    of: HashMap<i64, Vec<usize>>,
    stages: Vec<Stage>,
    /// Partners of components with many relations, by number and kinds: asked for again and again.
    partners: RefCell<HashMap<(i64, String), Vec<i64>>>,
}

/// From so many relations on the partners of a component are kept.
const MANY_RELATIONS: usize = 16;

/// Relations of the format join two to five components; one that names more than this is a list of something else.
const MOST_REFERENCES: usize = 64;

/// Relations that join gears which are not parts of each other.
const JOINING: [&str; 4] = ["stage", "stage_gear_data", "contact", "reference_position"];

impl Structure {
    /// Reads the relations of a model.
    ///
    /// # Errors
    /// [`RexsError::Duplicate`] for numbers that stand twice, [`RexsError::Cycle`] for components that contain each
    /// other.
    pub fn new(model: &Model, ledger: &mut Ledger) -> Result<Self> {
        let mut kinds = BTreeMap::new();
        for component in &model.components {
            if kinds.insert(component.id, component.kind.clone()).is_some() {
                let all: Vec<String> = model
                    .components
                    .iter()
                    .filter(|c| c.id == component.id)
                    .map(|c| c.words())
                    .collect();
                return Err(RexsError::Duplicate {
                    id: component.id,
                    first: all.first().cloned().unwrap_or_default(),
                    second: all.get(1).cloned().unwrap_or_default(),
                });
            }
        }
        let mut relations = Vec::new();
        for relation in &model.relations {
            let lost: Vec<String> = relation
                .references
                .iter()
                .filter(|r| !kinds.contains_key(&r.id))
                .map(|r| r.id.to_string())
                .collect();
            let count = relation.references.len();
            if count > MOST_REFERENCES {
                ledger.leave_out(
                    &format!("relation {} ({})", relation.id, relation.kind),
                    About::Lost,
                    format!(
                        "names {count} components; allowed are {MOST_REFERENCES}, for a relation joins a part to a whole, or gears to a stage. The relation is \
                         left out: write one for each part"
                    ),
                );
            } else if lost.is_empty() {
                relations.push(relation.clone());
            } else {
                ledger.leave_out(
                    &format!("relation {} ({})", relation.id, relation.kind),
                    About::Lost,
                    format!(
                        "names component {}, which is not in the file; the relation is left out",
                        lost.join(", ")
                    ),
                );
            }
        }
        relations.sort_by_key(|r| r.order.unwrap_or(i64::MAX));
        let mut of: HashMap<i64, Vec<usize>> = HashMap::new();
        for (i, relation) in relations.iter().enumerate() {
            for reference in &relation.references {
                let mine = of.entry(reference.id).or_default();
                if mine.last() != Some(&i) {
                    mine.push(i);
                }
            }
        }
        let stage = |r: &Relation| {
            let gears = [r.role(&["gear_1"])?, r.role(&["gear_2"])?];
            let id = r.role(&["stage", "assembly"])?;
            Some(Stage { id, gears })
        };
        let stages = relations.iter().filter_map(stage).collect();
        let structure = Self {
            relations,
            kinds,
            of,
            stages,
            partners: RefCell::default(),
        };
        structure.demand_no_cycle(model)?;
        Ok(structure)
    }

    fn demand_no_cycle(&self, model: &Model) -> Result<()> {
        let mut parts: BTreeMap<i64, Vec<i64>> = BTreeMap::new();
        for r in self
            .relations
            .iter()
            .filter(|r| r.kind.contains("assembly"))
        {
            if let (Some(whole), Some(part)) = (r.role(&["assembly"]), r.role(&["part"])) {
                parts.entry(whole).or_default().push(part);
            }
        }
        let mut done = BTreeSet::new();
        for &start in parts.keys() {
            // Depth first, with the path from the start on a stack of its own.
            let mut path = vec![(start, 0_usize)];
            let mut on_path = BTreeSet::from([start]);
            if done.contains(&start) {
                continue;
            }
            while let Some(&mut (id, ref mut next)) = path.last_mut() {
                let child = parts.get(&id).and_then(|p| p.get(*next)).copied();
                *next += 1;
                match child {
                    None => {
                        done.insert(id);
                        on_path.remove(&id);
                        path.pop();
                    }
                    Some(child) if on_path.contains(&child) => {
                        let from = path.iter().position(|(p, _)| *p == child).unwrap_or(0);
                        let ids = path[from..].iter().map(|(p, _)| *p).chain([child]);
                        let words =
                            ids.map(|id| model.component(id).map_or(String::new(), |c| c.words()));
                        return Err(RexsError::Cycle {
                            what: "components that contain each other",
                            chain: words.collect::<Vec<_>>().join(" > "),
                        });
                    }
                    Some(child) if done.contains(&child) => {}
                    Some(child) => {
                        on_path.insert(child);
                        path.push((child, 0));
                    }
                }
            }
        }
        Ok(())
    }

    /// Relations in which a component takes part.
    fn naming(&self, id: i64) -> impl Iterator<Item = &Relation> {
        let mine = effort::each(self.of.get(&id).into_iter().flatten());
        mine.map(|&i| &self.relations[i])
    }

    fn kind(&self, id: i64) -> &str {
        self.kinds.get(&id).map_or("", String::as_str)
    }

    /// Components of some types that share a relation with a component, whatever the relation is called: programs
    /// differ. Relations that only join gears to stages do not count.
    pub fn partners(&self, id: i64, kinds: &[&str]) -> Vec<i64> {
        if self.of.get(&id).map_or(0, Vec::len) < MANY_RELATIONS {
            return self.found_partners(id, kinds);
        }
        let mut kept = self.partners.borrow_mut();
        let mine = kept.entry((id, kinds.join(" ")));
        let found = { mine }
            .or_insert_with(|| self.found_partners(id, kinds))
            .clone();
        effort::visited(found.len());
        found
    }

    fn found_partners(&self, id: i64, kinds: &[&str]) -> Vec<i64> {
        let mut found = Vec::new();
        let mut seen = HashSet::new();
        for r in self
            .naming(id)
            .filter(|r| !JOINING.contains(&r.kind.as_str()))
        {
            for other in effort::each(r.references.iter()).map(|other| other.id) {
                if other != id && kinds.contains(&self.kind(other)) && seen.insert(other) {
                    found.push(other);
                }
            }
        }
        found
    }

    /// The stages, in the order of the file.
    pub fn stages(&self) -> &[Stage] {
        effort::visited(self.stages.len());
        &self.stages
    }

    /// Left and right flank of a gear.
    pub fn flanks(&self, gear: i64) -> [Option<i64>; 2] {
        let mut found = [None, None];
        for r in self.naming(gear) {
            for (side, roles) in [["left", "left_flank"], ["right", "right_flank"]]
                .iter()
                .enumerate()
            {
                found[side] = found[side].or(r.role(roles).filter(|&flank| flank != gear));
            }
        }
        found
    }

    /// What stands inside and outside of a bearing or coupling: the two sides.
    pub fn sides(&self, id: i64) -> Option<[i64; 2]> {
        self.naming(id).find_map(|r| {
            let inner = r.role(&["inner_part", "side_1", "inner"])?;
            let outer = r.role(&["outer_part", "side_2", "outer"])?;
            Some([inner, outer])
        })
    }

    /// The data of a gear in a stage.
    pub fn stage_gear_data(&self, stage: i64, gear: i64) -> Option<i64> {
        let mut fitting = self.naming(gear).filter(|r| r.names(stage));
        fitting.find_map(|r| r.role(&["stage_gear_data"]))
    }

    /// Shafts of a planetary stage in relations of a kind: `planet_carrier_shaft` and so on.
    pub fn planetary_shafts(&self, stage: i64, kind: &str) -> Vec<i64> {
        let of_kind = self.naming(stage).filter(|r| r.kind == kind);
        let own = of_kind.filter(|r| r.role(&["planetary_stage", "stage"]) == Some(stage));
        own.filter_map(|r| r.role(&["shaft"])).collect()
    }

    /// Relations in which some roles of planetary stages are given, by component.
    pub fn planetary_role(&self, id: i64) -> Option<&str> {
        let roles = ["planet_shaft", "planet_pin", "planet_carrier_shaft"];
        let mut kinds = self
            .naming(id)
            .filter(|r| roles.contains(&r.kind.as_str()) && r.role(&["shaft"]) == Some(id));
        kinds.next().map(|r| r.kind.as_str())
    }
}
