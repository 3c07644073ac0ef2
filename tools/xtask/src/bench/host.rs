//! What a benchmark ran on: the machine, the day, the commit.

use std::path::Path;
use std::process::Command;

/// Machine, day and commit, in words.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Host {
    /// Model of the processor.
    pub cpu: String,
    /// Cores that this process may use.
    pub cores: usize,
    /// Main memory.
    pub memory: String,
    /// Operating system.
    pub system: String,
    /// Day and time in UTC.
    pub date: String,
    /// Commit, and whether the tree was clean.
    pub commit: String,
}

impl Host {
    /// Asks the system; what cannot be found out says so.
    pub fn find(root: &Path) -> Self {
        let read = |path: &str| std::fs::read_to_string(path).unwrap_or_default();
        let commit = printed(
            Command::new("git")
                .current_dir(root)
                .args(["rev-parse", "HEAD"]),
        );
        let changes = printed(
            Command::new("git")
                .current_dir(root)
                // The page itself is what this command changes.
                .args([
                    "status",
                    "--porcelain",
                    "--",
                    ".",
                    ":!docs/benchmarks",
                    ":!docs/accuracy-cost.*",
                ]),
        );
        Self {
            cpu: field(&read("/proc/cpuinfo"), "model name", ':').unwrap_or_else(unknown),
            cores: std::thread::available_parallelism().map_or(1, usize::from),
            memory: field(&read("/proc/meminfo"), "MemTotal", ':')
                .and_then(|text| gigabytes(&text))
                .unwrap_or_else(unknown),
            system: field(&read("/etc/os-release"), "PRETTY_NAME", '=')
                .map(|name| name.trim_matches('"').to_owned())
                .unwrap_or_else(unknown),
            date: printed(Command::new("date").args(["-u", "+%Y-%m-%d %H:%M UTC"]))
                .unwrap_or_else(unknown),
            commit: match (commit, changes) {
                (Some(commit), Some(changes)) if changes.is_empty() => {
                    format!("{commit}, clean tree")
                }
                (Some(commit), Some(_)) => format!("{commit} with uncommitted changes"),
                _ => unknown(),
            },
        }
    }
}

fn unknown() -> String {
    "unknown".into()
}

/// Standard output of a command that succeeds.
fn printed(command: &mut Command) -> Option<String> {
    let output = command.output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().to_owned())
}

/// Value of the first line `name<separator>value`.
fn field(text: &str, name: &str, separator: char) -> Option<String> {
    text.lines()
        .filter_map(|line| line.split_once(separator))
        .find(|(key, _)| key.trim() == name)
        .map(|(_, value)| value.trim().to_owned())
}

/// `24576000 kB` (KiB, as Linux means it) in GB.
fn gigabytes(text: &str) -> Option<String> {
    let kib: f64 = text.strip_suffix("kB")?.trim().parse().ok()?;
    Some(format!("{:.1} GB", kib * 1024.0 / 1e9))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_are_found_as_the_system_writes_them() {
        let cpu = "processor\t: 0\nmodel name\t: Some CPU @ 2.50GHz\nmodel name\t: another";
        assert_eq!(
            field(cpu, "model name", ':').as_deref(),
            Some("Some CPU @ 2.50GHz")
        );
        assert_eq!(
            field("ID=x\nPRETTY_NAME=\"A B\"", "PRETTY_NAME", '=').as_deref(),
            Some("\"A B\"")
        );
        assert_eq!(field(cpu, "flags", ':'), None);
        assert_eq!(gigabytes("1000000 kB").as_deref(), Some("1.0 GB"));
        assert_eq!(gigabytes("many"), None);
    }
}
