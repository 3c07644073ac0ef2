//! Things that are linked to each other.

/// For each of so many things the first one of those that are linked to it, by others or itself.
pub(super) fn firsts(count: usize, links: impl IntoIterator<Item = [usize; 2]>) -> Vec<usize> {
    // A tree for each group: of each thing an earlier one of its group, of the first one itself.
    let mut above: Vec<usize> = (0..count).collect();
    let first = |above: &[usize], mut thing: usize| {
        while above[thing] != thing {
            thing = above[thing];
        }
        thing
    };
    for link in links {
        let [a, b] = link.map(|thing| first(&above, thing));
        above[a.max(b)] = a.min(b);
    }
    (0..count).map(|thing| first(&above, thing)).collect()
}
