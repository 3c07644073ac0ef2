//! Names of columns, and of parts in them.

/// A name as part of a column's name: `/` would make a group.
pub(crate) fn plain(name: &str) -> String {
    name.replace('/', "_")
}

/// Name of the column of a force element's channel.
pub(crate) fn element_column(element: &str, channel: &str) -> String {
    format!("elements/{}/{channel}", plain(element))
}

/// Name of the column of a body's channel.
pub(crate) fn body_column(body: &str, channel: &str) -> String {
    format!("bodies/{}/{channel}", plain(body))
}
