//! `--set key=value`: one value of the deck given on the command line.
//!
//! The key is a path of keys; an item of a list is named by its number, from one, or by its `name`:
//! `step.2.duration=3`, `step.push.increments.count=20`. The value is written as in a deck; a string needs no quotes.
//! What was set is then read and checked like the rest, and messages about it point into the command line.

use super::diagnose::Diagnostic;
use super::source::Place;
use super::tree::{Node, TreeEntry, Value, parse};

/// Changes the tree; `source` is the number of the text in the list of sources.
pub fn apply(set: &str, source: usize, tree: &mut Node) -> Result<(), Diagnostic> {
    let whole = Place::new(source, 0..set.len());
    let malformed = || Diagnostic::error("`--set` wants key=value").at(whole).help("as in --set solver.newton=full");
    let (key, value) = set.split_once('=').ok_or_else(malformed)?;
    let (keys, _) = read(&format!("{key}=0"), source).ok_or_else(malformed)?;
    let (_, mut node) = read(set, source).or_else(|| read(&format!("{key}=\"\""), source)).ok_or_else(malformed)?;
    if node.value == Value::Text(String::new()) && !value.trim().starts_with(['"', '\'']) {
        let text = value.trim();
        node = Node { value: Value::Text(text.to_owned()), place: Place::new(source, key.len() + 1..set.len()) };
    }
    put(&keys, node, tree)
}

/// Keys with their places, and the value behind them. A value that is a table ends the path as any other.
fn read(text: &str, source: usize) -> Option<(Vec<(String, Place)>, Node)> {
    let (mut node, faults) = parse(text, source);
    if !faults.is_empty() {
        return None;
    }
    let mut keys: Vec<(String, Place)> = Vec::new();
    let end = text.find('=')?;
    while let Value::Table(mut entries) = node.value.clone() {
        if entries.first().is_none_or(|entry| entry.place.start >= end) {
            break;
        }
        let TreeEntry { key, place, node: inner } = entries.swap_remove(0);
        keys.push((key, place));
        node = inner;
    }
    (!keys.is_empty()).then_some((keys, node))
}

fn put(keys: &[(String, Place)], new: Node, tree: &mut Node) -> Result<(), Diagnostic> {
    let Some(((key, place), rest)) = keys.split_first() else {
        *tree = new;
        return Ok(());
    };
    match &mut tree.value {
        Value::Table(entries) => {
            let at = entries.iter().position(|entry| entry.key == *key).unwrap_or_else(|| {
                entries.push(TreeEntry { key: key.clone(), place: *place, node: Node::empty(*place) });
                entries.len() - 1
            });
            put(rest, new, &mut entries[at].node)
        }
        Value::List(items) => {
            let lost = no_item(items, key, *place);
            put(rest, new, find(items, key).ok_or(lost)?)
        }
        other => {
            let what = format!("there is no key `{key}` in {}", other.kind());
            Err(Diagnostic::error(what).at(*place))
        }
    }
}

fn find<'a>(items: &'a mut [Node], key: &str) -> Option<&'a mut Node> {
    if let Ok(number) = key.parse::<usize>() {
        return items.get_mut(number.checked_sub(1)?);
    }
    items.iter_mut().find(|item| name(item) == Some(key))
}

/// What an item of a list says under the key `name`.
fn name(item: &Node) -> Option<&str> {
    let Value::Table(entries) = &item.value else { return None };
    entries.iter().find(|entry| entry.key == "name").and_then(|entry| match &entry.node.value {
        Value::Text(text) => Some(text.as_str()),
        _ => None,
    })
}

fn no_item(items: &[Node], key: &str, place: Place) -> Diagnostic {
    let what = format!("there is no item `{key}` in a list of {}", items.len());
    let diagnostic = Diagnostic::error(what).at(place).help("items are numbered from 1, or called by their `name`");
    match key.parse::<usize>() {
        Ok(_) => diagnostic,
        Err(_) => diagnostic.suggest(key, items.iter().filter_map(name)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(deck: &str, set: &str) -> Result<Node, Diagnostic> {
        let mut tree = parse(deck, 0).0;
        apply(set, 1, &mut tree).map(|()| tree)
    }

    fn same(deck: &str, change: &str, as_written: &str) {
        let changed = format!("{:?}", plain(&set(deck, change).unwrap()));
        assert_eq!(changed, format!("{:?}", plain(&parse(as_written, 0).0)), "{change}");
    }

    /// Values without places.
    fn plain(node: &Node) -> toml::Value {
        match &node.value {
            Value::Text(text) => toml::Value::String(text.clone()),
            Value::Whole(x) => toml::Value::Integer(*x),
            Value::Real(x) => toml::Value::Float(*x),
            Value::Flag(x) => toml::Value::Boolean(*x),
            Value::Date => toml::Value::Boolean(false),
            Value::List(items) => items.iter().map(plain).collect::<Vec<_>>().into(),
            Value::Table(entries) => {
                toml::Value::Table(entries.iter().map(|e| (e.key.clone(), plain(&e.node))).collect())
            }
        }
    }

    #[test]
    fn values_are_changed_and_added() {
        same("a = 1", "a=2", "a = 2");
        same("a.b = 1", "a.c = 2.5", "a = { b = 1, c = 2.5 }");
        same("", "solver.newton=full", "solver.newton = 'full'");
        same("a = 1", "a='x y'", "a = 'x y'");
        same("a = 1", "a=", "a = ''");
        same("a = 'b'", "a=c=d", "a = 'c=d'");
        same("a = { b = 1 }", "a={ c = 2 }", "a = { c = 2 }");
        same("a = [1, 2]", "a.2=[3, 4]", "a = [1, [3, 4]]");
        same("[[step]]\nname='p'\n[[step]]\nname='q'", "step.q.n=1", "[[step]]\nname='p'\n[[step]]\nname='q'\nn=1");
    }

    #[test]
    fn a_misspelt_name_of_an_item_gets_the_nearest() {
        let steps = "[[step]]\nname='press'\n[[step]]\nname='push'";
        let near = set(steps, "step.pres.duration=3").unwrap_err();
        assert_eq!(near.label, "did you mean `press`?");
        let far = set(steps, "step.unload.duration=3").unwrap_err();
        assert_eq!(far.help[1], "valid here: `press`, `push`");
    }

    #[test]
    fn what_cannot_be_set_is_refused_where_it_stands() {
        for (deck, change, words) in [
            ("", "novalue", "key=value"),
            ("", "=3", "key=value"),
            ("", "a b=3", "key=value"),
            ("a = [1]", "a.0=3", "no item `0`"),
            ("a = [1]", "a.2=3", "no item `2`"),
            ("a = 1", "a.b=3", "no key `b` in a whole number"),
        ] {
            let message = set(deck, change).unwrap_err();
            assert!(message.what.contains(words), "{change}: {}", message.what);
            assert_eq!(message.place.unwrap().source, 1);
        }
    }
}
