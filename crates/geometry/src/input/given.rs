//! Which keys of a table are given.

/// The named fields of a table, all of them options, each with whether it is given: an array of pairs.
///
/// ```
/// struct Table { length_mm: Option<f64>, r#type: Option<u8> }
/// let table = Table { length_mm: Some(1.0), r#type: None };
/// assert_eq!(gearmesh_geometry::given!(table; length_mm, r#type), [("length_mm", true), ("type", false)]);
/// ```
#[macro_export]
macro_rules! given {
    ($table:expr; $($key:ident),+ $(,)?) => {
        [$((stringify!($key).trim_start_matches("r#"), $table.$key.is_some())),+]
    };
}
