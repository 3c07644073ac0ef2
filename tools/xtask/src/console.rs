//! Progress on stderr: stdout belongs to the programs that xtask starts.

use std::io::Write;
use std::time::Duration;

/// Writes one line to stderr; a closed stderr is not an error.
pub fn say(line: &str) {
    let _ = writeln!(std::io::stderr(), "{line}");
}

/// A duration as people read it: `0.4 s`, `37 s`, `4 min 05 s`.
pub fn readable(duration: Duration) -> String {
    let seconds = duration.as_secs();
    match seconds {
        0..10 => format!("{:.1} s", duration.as_secs_f64()),
        10..60 => format!("{seconds} s"),
        _ => format!("{} min {:02} s", seconds / 60, seconds % 60),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn durations_read_naturally() {
        assert_eq!(readable(Duration::from_millis(420)), "0.4 s");
        assert_eq!(readable(Duration::from_millis(37_900)), "37 s");
        assert_eq!(readable(Duration::from_secs(245)), "4 min 05 s");
    }
}
