//! Memory that an offline job will take against what the machine has free: told, or refused before it is taken.

use crate::failure::Result;
use crate::watch::Watch;
use gearmesh_geometry::GearDefinition;
use gearmesh_geometry::input::InputDocument;
use gearmesh_reduction::{MemoryEstimate, OfflineJob};
use std::path::Path;

const GIGA: f64 = 1e9;
/// Below this nobody waits or runs out of memory.
const NOT_WORTH_A_NOTE: f64 = 0.3 * GIGA;

/// Free memory \[byte\]: what the system can give without swapping, and free swap, within the limit of the control
/// group. None where the system does not tell.
pub fn free_bytes() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    let kilobytes = |name: &str| -> Option<f64> {
        let line = text.lines().find(|line| line.starts_with(name))?;
        line.split_whitespace().nth(1)?.parse().ok()
    };
    let free = 1024.0 * (kilobytes("MemAvailable:")? + kilobytes("SwapFree:").unwrap_or(0.0));
    let group = |name: &str| -> Option<f64> {
        let path = Path::new("/sys/fs/cgroup").join(name);
        std::fs::read_to_string(path).ok()?.trim().parse().ok()
    };
    match (group("memory.max"), group("memory.current")) {
        (Some(limit), Some(used)) => Some(free.min((limit - used).max(0.0))),
        _ => Some(free),
    }
}

/// Time of a job \[s\].
pub(crate) type Duration = fn(&MemoryEstimate) -> f64;

/// A rough time, as part of a list.
fn time_in_words(seconds: f64) -> String {
    match seconds {
        short if short < 20.0 => format!(", {:.0} s", short.max(1.0)),
        some if some < 90.0 => format!(", {:.0} s", 5.0 * (some / 5.0).round()),
        long => format!(", {:.0} min", long / 60.0),
    }
}

/// Tells what a job on a gear will take; with `even_if_short` not an error where less is free.
pub(crate) fn demand(
    gear: &GearDefinition,
    file: &str,
    (job, duration): (OfflineJob, Option<Duration>),
    even_if_short: bool,
    watch: &Watch<'_>,
) -> Result<()> {
    let Some(estimate) = MemoryEstimate::new(gear, job) else {
        return Ok(());
    };
    let free = free_bytes();
    let size = format!(
        "about {} nodes, {} degrees of freedom, {:.1} GB of memory{}",
        rounded(estimate.size.nodes),
        rounded(3.0 * estimate.size.nodes),
        estimate.bytes / GIGA,
        duration.map_or_else(String::new, |of| time_in_words(of(&estimate)))
    );
    match free {
        Some(free) if estimate.bytes > free && !even_if_short => {
            let (key, problem) = advice(&estimate);
            let document = InputDocument::new(file, gear.source.clone());
            let problem = format!(
                "{size}, {:.1} GB are free; {problem}. The estimate is rough: --even-if-memory-is-short begins all the same",
                free / GIGA
            );
            Err(document.error(key, problem).into())
        }
        _ if estimate.bytes < NOT_WORTH_A_NOTE => Ok(()),
        Some(free) => {
            watch.note(format!(
                "{}: {size} ({:.1} GB are free)",
                gear.name,
                free / GIGA
            ));
            Ok(())
        }
        None => {
            watch.note(format!("{}: {size}", gear.name));
            Ok(())
        }
    }
}

/// The key to look at, and what to do.
fn advice(estimate: &MemoryEstimate) -> (&'static str, String) {
    let (shortest, share) = estimate.shortest;
    if estimate.modes_bytes > 0.5 * estimate.bytes {
        return (
            "modes",
            format!(
                "the natural modes, about {} of them, take {:.1} GB of it: ask for fewer, or for those up to a lower frequency",
                modes(estimate.modes),
                estimate.modes_bytes / GIGA
            ),
        );
    }
    let key = match shortest {
        "flank_mm" => "mesh.flank_mm",
        "fillet_mm" => "mesh.fillet_mm",
        "body_mm" => "mesh.body_mm",
        "axial_mm" => "mesh.axial_mm",
        _ => "mesh.element",
    };
    let problem = if share < 0.99 {
        format!("{shortest} is {share:.2} times its default: take longer elements")
    } else {
        "take longer elements (flank_mm, fillet_mm, body_mm, axial_mm of [mesh]), fewer loads (slices, roll_stations of [reduction]), or openings \
         whose number has a factor in common with the teeth's"
            .to_owned()
    };
    (key, problem)
}

/// A few modes as they are, many in words.
fn modes(count: f64) -> String {
    if count < 1e4 {
        format!("{count:.0}")
    } else {
        rounded(count)
    }
}

/// Two digits, in words of a person.
fn rounded(count: f64) -> String {
    match count {
        c if c >= 1e9 => format!("{:.1} billion", c / 1e9),
        c if c >= 1e6 => format!("{:.1} million", c / 1e6),
        c => format!("{:.0} thousand", c / 1e3),
    }
}
