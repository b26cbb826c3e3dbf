//! Walks the schema of decks and breaks every key in every way: misspelt, missing, of the wrong type, out of range,
//! naming nothing. Each broken deck must be refused with a message that points at the break. The good decks of
//! `tests/decks` together must say every key that the schema has.

mod schema_sites;

use asperity::deck::schema::{Names, Presence, Schema, root};
use asperity::deck::source::Place;
use asperity::deck::{Diagnostic, Severity, read};
use schema_sites::{Step, at, decks, everywhere, folder, last_key, parent, sites};
use std::collections::BTreeSet;
use toml::{Table, Value};

/// The path as messages write it.
fn spoken(path: &[Step]) -> String {
    let quote = |key: &String| if key.contains('.') { format!("{key:?}") } else { key.clone() };
    let one = |step: &Step| match step {
        Step::Key(key) => quote(key),
        Step::Item(i) => (i + 1).to_string(),
    };
    path.iter().map(one).collect::<Vec<_>>().join(".")
}

/// The errors of a deck, and its text. The text is written anew from the values, with each table on its own lines.
fn errors(deck: &Value) -> (Vec<Diagnostic>, String) {
    let text = toml::to_string(deck).unwrap();
    let list = read(&text, "broken.toml", &folder(), &[]).err().map(|d| d.list).unwrap_or_default();
    (list.into_iter().filter(|d| d.severity == Severity::Error).collect(), text)
}

fn pointed(text: &str, place: Option<Place>) -> &str {
    place.and_then(|place| text.get(place.start..place.end)).unwrap_or("")
}

/// Breaks the deck and wants an error that satisfies `wanted`, given the error and the text under its caret.
fn must_fail(deck: &Value, what: &str, wanted: impl Fn(&Diagnostic, &str) -> bool) {
    let (errors, text) = errors(deck);
    let found = errors.iter().any(|error| wanted(error, pointed(&text, error.place)));
    assert!(found, "{what}\n{errors:#?}\n{text}");
}

#[test]
fn good_decks_are_read() {
    for (name, table) in decks() {
        let (errors, _) = errors(&Value::Table(table));
        assert!(errors.is_empty(), "{name}: {errors:#?}");
    }
}

#[test]
fn good_decks_say_every_key() {
    fn all(schema: &Schema, path: &str, paths: &mut BTreeSet<String>) {
        match schema {
            Schema::Table(keys) | Schema::OneOf(keys) => {
                for key in keys {
                    let path = format!("{path}.{}", key.name);
                    all(&key.schema, &path, paths);
                    paths.insert(path);
                }
            }
            Schema::Map { item, .. } => all(item, &format!("{path}.NAME"), paths),
            Schema::List { item, .. } => all(item, &format!("{path}.ITEM"), paths),
            _ => {}
        }
    }
    let mut unsaid = BTreeSet::new();
    all(&root(), "", &mut unsaid);
    assert!(unsaid.len() > 100);
    for (_, table) in decks() {
        let deck = Value::Table(table);
        let mut found = Vec::new();
        sites(&deck, &root(), &[], &mut found);
        let named: Vec<_> = found.iter().filter(|site| site.name.is_some()).map(|site| site.path.clone()).collect();
        for site in &found {
            let words = (0..site.path.len()).map(|i| match &site.path[i] {
                Step::Item(_) => "ITEM",
                Step::Key(_) if named.iter().any(|path| path[..] == site.path[..=i]) => "NAME",
                Step::Key(key) => key,
            });
            unsaid.remove(&words.fold(String::new(), |path, word| path + "." + word));
        }
    }
    assert!(unsaid.is_empty(), "no good deck says {unsaid:#?}");
}

#[test]
fn a_misspelt_key_is_found_with_the_right_one() {
    everywhere(|site, deck| {
        let Some(key) = site.key.as_ref() else { return };
        let wrong = format!("{}q", key.name);
        let mut deck = deck.clone();
        let table = parent(&mut deck, &site.path);
        let value = table.remove(key.name).unwrap();
        table.insert(wrong.clone(), value);
        must_fail(&deck, &format!("{wrong} for {}", spoken(&site.path)), |error, pointed| {
            let told = error.label.contains(&format!("`{}`", key.name))
                || error.help.iter().any(|help| help.contains(&format!("`{}`", key.name)));
            error.what.contains(&format!("`{wrong}`")) && (pointed == wrong || pointed.contains(&wrong)) && told
        });
        if key.name.len() > 2 {
            let label = format!("did you mean `{}`?", key.name);
            must_fail(&deck, &format!("nearest to {wrong}"), |error, _| error.label == label);
        }
    });
}

#[test]
fn a_missing_key_is_named_if_it_is_required() {
    everywhere(|site, deck| {
        let Some(key) = site.key.as_ref() else { return };
        let mut deck = deck.clone();
        parent(&mut deck, &site.path).remove(key.name);
        if site.tagged {
            must_fail(&deck, &spoken(&site.path), |error, _| error.what.contains(&format!("`{}`", key.name)));
        } else if key.presence == Presence::Required {
            let name = format!("`{}`", key.name);
            must_fail(&deck, &spoken(&site.path), |error, _| {
                error.what.split_once("does not say ").is_some_and(|(_, keys)| keys.contains(&name))
            });
        }
    });
}

#[test]
fn a_value_of_the_wrong_type_is_refused_where_it_stands() {
    let wrong = |schema: &Schema| -> Vec<Value> {
        let (text, number, flag) = (Value::from("?"), Value::from(-7.5), Value::from(true));
        let (list, table) = (Value::Array(vec![]), Value::Table(Table::new()));
        let date = Value::Datetime("1990-01-01".parse().unwrap());
        match schema {
            Schema::Number { .. } => vec![text, flag, list, table, date],
            Schema::Whole { .. } => vec![text, number, flag, list, table, date],
            Schema::Flag => vec![text, number, list, table, date],
            Schema::Text(_) | Schema::Word(_) | Schema::Name(_) => vec![number, flag, list, table, date],
            Schema::List { .. } => vec![text, number, flag, table, date],
            Schema::Map { .. } | Schema::Table(_) | Schema::OneOf(_) => vec![text, number, flag, list, date],
        }
    };
    everywhere(|site, deck| {
        for value in wrong(&site.schema) {
            let mut deck = deck.clone();
            *at(&mut deck, &site.path) = value.clone();
            let path = format!("`{}`", spoken(&site.path));
            must_fail(&deck, &format!("{path} = {value}"), |error, pointed| {
                let header = value.is_table() && pointed.contains(&last_key(&site.path));
                error.what.contains(&path) && (pointed == value.to_string() || header)
            });
        }
    });
}

#[test]
fn a_value_out_of_range_is_refused_where_it_stands() {
    fn beyond(schema: &Schema, value: &Value) -> Vec<Value> {
        match schema {
            Schema::Number { range, .. } => {
                let ends = [range.least.map(|(a, _)| a - 1.0), range.most.map(|(b, _)| b + 1.0)];
                let open = [range.least, range.most].into_iter().flatten().filter(|(_, included)| !included);
                let never = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
                let all = ends.into_iter().flatten().chain(open.map(|(end, _)| end)).chain(never);
                all.map(Value::from).collect()
            }
            Schema::Whole { least, most } => {
                let under = i64::try_from(*least).unwrap() - 1;
                let over = i64::try_from(*most).ok().map(|most| Value::from(most + 1));
                [Value::from(under), Value::from(-1)].into_iter().chain(over).collect()
            }
            Schema::Word(_) => vec![Value::from("no-such-word"), Value::from("")],
            Schema::List { least, most, .. } => {
                let items = value.as_array().unwrap();
                let short = (*least > 0).then(|| items[..least - 1].to_vec().into());
                let long = (*most < usize::MAX)
                    .then(|| items.iter().cycle().take(most + 1).cloned().collect::<Vec<_>>().into());
                short.into_iter().chain(long).collect()
            }
            _ => vec![],
        }
    }
    everywhere(|site, deck| {
        let mut deck = deck.clone();
        let value = at(&mut deck, &site.path).clone();
        for wrong in beyond(&site.schema, &value) {
            *at(&mut deck, &site.path) = wrong.clone();
            let path = format!("`{}`", spoken(&site.path));
            let points = |pointed: &str| match &wrong {
                Value::Array(_) => pointed.starts_with('['),
                Value::Float(x) => pointed.parse::<f64>().is_ok_and(|y| y == *x || (y.is_nan() && x.is_nan())),
                other => pointed == other.to_string(),
            };
            must_fail(&deck, &format!("{path} = {wrong}"), |error, pointed| {
                error.what.contains(&path) && points(pointed)
            });
        }
    });
}

#[test]
fn a_name_of_nothing_is_found_with_the_nearest_one() {
    everywhere(|site, deck| {
        let mut deck = deck.clone();
        match (&site.schema, site.name) {
            (Schema::Name(names), _) => {
                let right = at(&mut deck, &site.path).as_str().unwrap().to_owned();
                let wrong = format!("{right}q");
                *at(&mut deck, &site.path) = wrong.clone().into();
                dangling(&deck, *names, &right, &wrong);
            }
            (_, Some((names, false))) => {
                let (right, table) = (last_key(&site.path), parent(&mut deck, &site.path));
                let (wrong, value) = (format!("{right}q"), table.remove(&right).unwrap());
                table.insert(wrong.clone(), value);
                dangling(&deck, names, &right, &wrong);
            }
            _ => {}
        }
    });
}

fn dangling(deck: &Value, names: Names, right: &str, wrong: &str) {
    must_fail(deck, &format!("{wrong} for the {} {right}", names.noun()), |error, pointed| {
        error.what.contains(&format!("`{wrong}`")) && pointed.contains(wrong) && error.label.contains("did you mean")
    });
}
