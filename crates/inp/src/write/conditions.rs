//! Conditions as a deck says them: what a step changes, and what it releases.

use super::courses::{Factors, Item};
use super::{Writer, list, quoted};
use std::collections::{BTreeMap, BTreeSet};

/// The values of one kind of condition in each step, by group or tool and component.
pub type Table = Vec<BTreeMap<(String, usize), Item>>;

/// A kind of condition.
pub struct Kind {
    /// Its key in a step: `displacement`.
    pub key: &'static str,
    /// Keys of its components.
    pub components: &'static [&'static str],
    /// What is added to each, as the kind of a pressure.
    pub more: &'static str,
    /// Whether it acts on a group, which may be named twice, or on a tool.
    pub of_group: bool,
}

/// Lines of each step.
#[derive(Debug, Default, Clone)]
pub struct Said {
    /// Conditions.
    pub lines: Vec<String>,
    /// What is released.
    pub released: Vec<String>,
}

impl Writer<'_> {
    /// What each step says of one kind of condition.
    pub(super) fn said(&mut self, kind: &Kind, table: &Table) -> Vec<Said> {
        let keys: BTreeSet<&String> = table.iter().flat_map(|step| step.keys().map(|(key, _)| key)).collect();
        let mut said = vec![Said::default(); table.len()];
        for key in keys {
            let components = components_of(key, table);
            match apart(kind, key, &components, table) {
                false => self.say(kind, key, &components, key, table, &mut said),
                true if kind.of_group => {
                    for &component in &components {
                        let group = self.groups.again(key, kind.components.get(component).unwrap_or(&"along"));
                        self.say(kind, &group, &[component], key, table, &mut said);
                    }
                }
                true => {
                    let place = table.iter().flatten().find(|((known, _), _)| known == key).map(|(_, item)| item.place);
                    let what = format!(
                        "tool '{key}' cannot follow several amplitudes in one step, or be let go along one axis only"
                    );
                    self.error(place.unwrap_or_default(), what);
                }
            }
        }
        said
    }

    /// Says some components of a key under a name.
    fn say(&mut self, kind: &Kind, name: &str, components: &[usize], key: &str, table: &Table, said: &mut [Said]) {
        let at = |step: usize, component: usize| table[step].get(&(key.to_owned(), component));
        for (step, said) in said.iter_mut().enumerate() {
            let before = |component: usize| step.checked_sub(1).and_then(|step| at(step, component));
            let held: Vec<(usize, &Item)> = components.iter().filter_map(|&c| Some((c, at(step, c)?))).collect();
            if held.is_empty()
                && components.iter().any(|&component| before(component).is_some())
                && kind.key != "motion"
            {
                said.released.push(format!("{}.{name}", kind.key));
            }
            let new: Vec<(usize, &Item)> = held.into_iter().filter(|(c, item)| changes(item, before(*c))).collect();
            let Some((_, first)) = new.first() else { continue };
            let mut parts: Vec<String> =
                new.iter().map(|(c, item)| self.component_text(kind, *c, item.factors().0)).collect();
            if !kind.more.is_empty() {
                parts.push(kind.more.to_string());
            }
            if let Some(factors) = new.iter().find_map(|(_, item)| item.factors().1) {
                let pairs: Vec<String> = factors.iter().map(|pair| super::list(pair)).collect();
                parts.push(format!("amplitude = [{}]", pairs.join(", ")));
            }
            let from = self.from(first.place);
            said.lines.push(format!("{}.{} = {{ {} }}{from}\n", kind.key, quoted(name), parts.join(", ")));
        }
    }
}

impl Writer<'_> {
    /// A component and its value; those beyond the axes are directions.
    fn component_text(&self, kind: &Kind, component: usize, value: f64) -> String {
        match (kind.components.get(component), component.checked_sub(3).and_then(|at| self.directions.get(at))) {
            (Some(name), _) => format!("{name} = {value:?}"),
            (None, Some(along)) => format!("along = {}, value = {value:?}", list(&along[..self.dimension()])),
            (None, None) => String::new(),
        }
    }
}

fn components_of(key: &str, table: &Table) -> Vec<usize> {
    let all = table.iter().flat_map(|step| step.keys()).filter(|(known, _)| known == key).map(|(_, c)| *c);
    all.collect::<BTreeSet<usize>>().into_iter().collect()
}

/// Whether a step says something new of a value.
pub(super) fn changes(item: &Item, before: Option<&Item>) -> bool {
    let moves =
        |item: &Item| item.course.as_ref().is_some_and(|points| points.iter().any(|point| point[1] != item.end));
    match before {
        None => true,
        Some(before) => before.end != item.end || moves(item),
    }
}

/// Whether the components of a key cannot be said together: their courses differ, or only some of them end.
fn apart(kind: &Kind, key: &str, components: &[usize], table: &Table) -> bool {
    let at = |step: usize, c: usize| table[step].get(&(key.to_owned(), c));
    let oblique = components.len() > 1 && components.iter().any(|&c| c >= kind.components.len());
    oblique
        || (0..table.len()).any(|step| {
            let before = |c: usize| step.checked_sub(1).and_then(|step| at(step, c));
            let new: Vec<&Item> =
                components.iter().filter_map(|&c| at(step, c).filter(|item| changes(item, before(c)))).collect();
            let mut courses: Vec<Factors> =
                new.iter().filter(|item| moved(item)).map(|item| item.factors().1).collect();
            courses.dedup();
            let held = components.iter().any(|&c| at(step, c).is_some());
            let ended = components.iter().any(|&c| before(c).is_some() && at(step, c).is_none());
            courses.len() > 1 || (held && ended && kind.key != "motion")
        })
}

/// Whether a value goes anywhere, so that its course matters.
fn moved(item: &Item) -> bool {
    item.start != Some(item.end) || item.factors().1.is_some()
}
