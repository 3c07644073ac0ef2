//! How many threads the loops on several threads may have.

use super::InputError;

/// What rayon reads.
const VARIABLE: &str = "RAYON_NUM_THREADS";

/// Most threads: far more than a machine has cores. rayon would begin as many as it is asked for before the first one
/// works.
const MOST: usize = 1024;

/// Refuses a number of threads that the machine would only be busy to begin. To be called before the first loop on
/// several threads.
///
/// # Errors
/// [`InputError`] naming the variable, with what was found and what is allowed.
pub fn demand_threads() -> Result<(), InputError> {
    match std::env::var(VARIABLE).ok().and_then(|text| problem(&text)) {
        None => Ok(()),
        Some(problem) => Err(InputError {
            file: VARIABLE.to_owned(),
            line: None,
            key: String::new(),
            problem,
        }),
    }
}

/// What is wrong with a number of threads, if anything is. Empty, and 0 as rayon has it, leave the choice to the
/// machine.
fn problem(text: &str) -> Option<String> {
    let is_fine = text.is_empty() || text.parse::<usize>().is_ok_and(|count| count <= MOST);
    (!is_fine).then(|| {
        format!("found {text}, allowed is 1 to {MOST}; without this variable there is a thread for each core")
    })
}

#[cfg(test)]
mod tests {
    use super::problem;

    #[test]
    fn a_number_of_threads_is_a_small_whole_number() {
        for fine in ["", "0", "1", "64", "1024"] {
            assert_eq!(problem(fine), None, "{fine}");
        }
        for wrong in ["1000000", "-1", "two", "1e3", "18446744073709551616"] {
            let found = problem(wrong).unwrap_or_default();
            assert!(found.starts_with(&format!("found {wrong}, allowed is 1 to 1024")));
        }
    }
}
