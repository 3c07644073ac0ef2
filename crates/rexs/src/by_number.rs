//! Parts of a train that are found by the number of their component.

use crate::effort;
use std::collections::HashMap;
use std::hash::Hash;
use std::ops::{Deref, DerefMut};

/// What has the number of a component.
pub trait Numbered {
    /// The component.
    fn id(&self) -> i64;
}

/// A list in the order of the file, whose parts are found by number; numbers stand once.
#[derive(Debug, Clone)]
pub struct ByNumber<T> {
    list: Vec<T>,
    places: HashMap<i64, usize>,
}

impl<T> Default for ByNumber<T> {
    fn default() -> Self {
        Self {
            list: Vec::new(),
            places: HashMap::new(),
        }
    }
}

impl<T: Numbered> ByNumber<T> {
    /// Adds a part.
    pub fn push(&mut self, part: T) {
        self.places.entry(part.id()).or_insert(self.list.len());
        self.list.push(part);
    }

    /// Place of a part in the list.
    pub fn place(&self, id: i64) -> Option<usize> {
        effort::visited(1);
        self.places.get(&id).copied()
    }

    /// All parts, in the order of the file.
    pub fn iter(&self) -> impl DoubleEndedIterator<Item = &T> + ExactSizeIterator + Clone {
        effort::visited(self.list.len());
        self.list.iter()
    }

    /// Keeps some.
    pub fn retain(&mut self, wanted: impl FnMut(&T) -> bool) {
        effort::visited(self.list.len());
        self.list.retain(wanted);
        self.places.clear();
        for (place, part) in self.list.iter().enumerate() {
            self.places.entry(part.id()).or_insert(place);
        }
    }
}

/// Values by their keys, those of a key in the order in which they come.
pub fn grouped<K: Eq + Hash, V>(pairs: impl IntoIterator<Item = (K, V)>) -> HashMap<K, Vec<V>> {
    let mut found: HashMap<K, Vec<V>> = HashMap::new();
    for (key, value) in pairs {
        found.entry(key).or_default().push(value);
    }
    found
}

/// The one at the top of a tree of places, each of which names the one above it, itself at the top; the way there is
/// halved for the next time.
pub fn topmost(above: &mut [usize], mut i: usize) -> usize {
    while above[i] != i {
        above[i] = above[above[i]];
        i = above[i];
    }
    i
}

impl<T> Deref for ByNumber<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        &self.list
    }
}

/// Numbers are not to be changed by it.
impl<T> DerefMut for ByNumber<T> {
    fn deref_mut(&mut self) -> &mut [T] {
        &mut self.list
    }
}
