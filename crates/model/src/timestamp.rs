//! UTC time stamps for provenance, ISO 8601 to the second.

use std::time::{SystemTime, UNIX_EPOCH};

/// The present time in UTC, for example `2026-03-01T12:30:05Z`. A clock set before 1970 gives 1970.
pub fn utc_now() -> String {
    let seconds = SystemTime::now()
        .duration_since(UNIX_EPOCH)
        .map_or(0, |elapsed| elapsed.as_secs());
    utc_from_unix_seconds(seconds)
}

/// ISO 8601 text of a Unix time.
///
/// The day count is turned into a Gregorian date by counting in 400-year eras of 146 097 days that begin on 1 March
/// (H. Hinnant, "chrono-compatible low-level date algorithms", `civil_from_days`): the leap day is then the last of
/// its year and month lengths follow (153 m + 2) / 5.
fn utc_from_unix_seconds(seconds: u64) -> String {
    let (days, second_of_day) = (seconds / 86_400, seconds % 86_400);
    let days_from_march_0000 = days + 719_468;
    let era = days_from_march_0000 / 146_097;
    let day_of_era = days_from_march_0000 % 146_097;
    let year_of_era =
        (day_of_era - day_of_era / 1_460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let march_month = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * march_month + 2) / 5 + 1;
    let month = if march_month < 10 {
        march_month + 3
    } else {
        march_month - 9
    };
    let year = era * 400 + year_of_era + u64::from(month <= 2);
    let (hour, minute, second) = (
        second_of_day / 3_600,
        second_of_day / 60 % 60,
        second_of_day % 60,
    );
    format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}Z")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_dates() {
        assert_eq!(utc_from_unix_seconds(0), "1970-01-01T00:00:00Z");
        assert_eq!(utc_from_unix_seconds(951_782_400), "2000-02-29T00:00:00Z");
        assert_eq!(utc_from_unix_seconds(1_000_000_000), "2001-09-09T01:46:40Z");
        assert_eq!(utc_from_unix_seconds(4_102_444_799), "2099-12-31T23:59:59Z");
    }
}
