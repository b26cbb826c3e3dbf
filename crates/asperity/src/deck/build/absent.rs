//! Contacts that some steps do without.

use super::Builder;
use crate::contact::second_name;
use crate::deck::diagnose::Diagnostic;
use crate::deck::reader::Name;
use std::collections::BTreeSet;

impl Builder<'_> {
    /// For each step the numbers of the terms that it does without, ascending; the terms of contacts are named, from the
    /// number `first` on.
    pub(super) fn absent(&mut self, terms: &[String], first: usize) -> Vec<Vec<usize>> {
        let (deck, mut gone) = (self.deck, BTreeSet::<String>::new());
        let mut all = Vec::new();
        for step in &deck.step {
            for name in &step.remove {
                let meant = self.contacts_of(name);
                if !meant.is_empty() && meant.iter().all(|contact| gone.contains(contact)) {
                    self.refuse(format!("`{name}` is removed already"), name.place);
                }
                gone.extend(meant);
            }
            for name in &step.add {
                let meant = self.contacts_of(name);
                if !meant.is_empty() && !meant.iter().any(|contact| gone.contains(contact)) {
                    let what = format!("`{name}` is there already: no step before has removed it");
                    self.found
                        .push(Diagnostic::error(what).at(name.place).help("`add` brings back what `remove` took"));
                }
                meant.iter().for_each(|contact| _ = gone.remove(contact));
            }
            let is_gone = |term: &String| gone.iter().any(|name| term == name || *term == second_name(name));
            all.push((0..terms.len()).filter(|&i| is_gone(&terms[i])).map(|i| first + i).collect());
        }
        all
    }

    /// The contact of a name, or all of a tool.
    fn contacts_of(&mut self, name: &Name) -> Vec<String> {
        let contacts = self.deck.contact.iter();
        let meant = contacts.filter(|(contact, keys)| contact.text == name.text || keys.target.text == name.text);
        let meant: Vec<String> = meant.map(|(contact, _)| contact.text.clone()).collect();
        if meant.is_empty() {
            self.refuse(format!("no contact has the target `{name}`"), name.place);
        }
        meant
    }
}
