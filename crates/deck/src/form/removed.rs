//! What decks once said and no longer say, each with what takes its place.

/// A key of a table, or a word of a key, with what to do; the table is the first part of its path.
const REMOVED: &[(&str, &str, &str)] = &[
    (
        "contact",
        "guard",
        "leave it out: facets are judged by the figure `facet_ratio`, whose limit is `limits.facet_ratio`",
    ),
    ("contact", "normals", "leave it out: a field of contact stress, form = \"field\", has averaged normals"),
    (
        "contact",
        "parts",
        "leave it out: a field of contact stress, form = \"field\", feels what is narrower than an edge",
    ),
    ("contact", "traction", "form = \"paper\" is what it is called now"),
    (
        "contact",
        "variational",
        "form = \"field\": its pressure does its work on the gap, along the normals of what is touched",
    ),
];

/// What to do where `said`, a key or a word, stands at or in `path`.
pub fn successor(path: &str, said: &str) -> Option<&'static str> {
    let table = path.split('.').next()?;
    REMOVED.iter().find(|(of, what, _)| *of == table && *what == said).map(|(.., help)| *help)
}
