//! Which keys of a table are given.

/// The named fields of a table, each with whether it is given.
macro_rules! given {
    ($table:expr; $($key:ident),+ $(,)?) => {
        [$((stringify!($key).trim_start_matches("r#"), $table.$key.is_some())),+]
    };
}

pub(super) use given;
