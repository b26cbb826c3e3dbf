//! `asperity laws`: every law of a solid and of an interface, with its parameters.

use super::{Outcome, print};
use asperity::declare::Entry;
use asperity::{interface, material};
use std::fmt::Write;

/// Prints the laws.
pub fn laws() -> Outcome {
    let solids = listed("Laws of solids ([material.NAME.LAW])", material::laws::ALL);
    let others = "\n  umat: a law in a shared library, called as a UMAT is; its keys are on the page of all keys\n";
    print(&(solids + others + "\n" + &listed("Laws of interfaces ([contact.NAME.law.LAW])", interface::laws::ALL)))
}

fn listed<T>(title: &str, entries: &[Entry<T>]) -> String {
    let mut text = format!("{title}\n");
    for entry in entries {
        // Writing into a String cannot fail.
        let _ = writeln!(text, "\n  {}: {}", entry.name, entry.meaning);
        let widest = entry.parameters.iter().map(|p| p.key.len()).max().unwrap_or(0);
        for p in entry.parameters {
            let unit = if p.unit.is_empty() { "number" } else { p.unit };
            let default = p.default.map(|value| format!("; default {value}")).unwrap_or_default();
            let _ = writeln!(text, "    {:widest$}  {}; {unit}, {}{default}", p.key, p.meaning, p.range);
        }
        if let Some(pairs) = &entry.pairs {
            let _ = writeln!(text, "    {:widest$}  {}", pairs.key, pairs.meaning);
        }
    }
    text
}
