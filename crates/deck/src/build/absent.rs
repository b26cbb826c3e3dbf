//! Contacts and bodies that some steps do without.

use super::Builder;
use super::bodies::NONE;
use crate::diagnose::Diagnostic;
use crate::keys::StepKeys;
use crate::reader::Name;
use asperity_core::contact::second_name;
use asperity_core::mesh::Group;
use std::collections::BTreeSet;

impl Builder<'_> {
    /// For each step the numbers of the terms that it does without, ascending. `terms` are named: bodies, contacts up to number
    /// `contacts_end`, then springs and loads.
    pub(super) fn absent(&mut self, terms: &[String], contacts_end: usize) -> Vec<Vec<usize>> {
        let (deck, mut gone) = (self.deck, BTreeSet::<usize>::new());
        let (bodies, owner, mut all) = (deck.body.len(), self.owners(), Vec::new());
        for (step, absent) in deck.step.iter().zip(self.absent_bodies()) {
            for name in &step.remove {
                let meant = self.terms_of(name, &terms[..contacts_end]);
                if !meant.is_empty() && meant.iter().all(|term| gone.contains(term)) {
                    self.refuse(format!("`{name}` is removed already"), name.place);
                }
                gone.extend(meant);
            }
            for name in &step.add {
                let meant = self.terms_of(name, &terms[..contacts_end]);
                if !meant.is_empty() && !meant.iter().any(|term| gone.contains(term)) {
                    let what = format!("`{name}` is there already: no step before has removed it");
                    self.found
                        .push(Diagnostic::error(what).at(name.place).help("`add` brings back what `remove` took"));
                }
                meant.iter().for_each(|term| _ = gone.remove(term));
            }
            let mut without = gone.clone();
            without.extend((bodies..contacts_end).filter(|&term| self.contact_is_on(&terms[term], (&owner, &absent))));
            without.extend(
                (contacts_end..terms.len()).filter(|&term| self.load_is_on(&terms[term], (&owner, &absent), step)),
            );
            all.push(without.into_iter().collect());
        }
        all
    }

    /// For each step the numbers of the bodies that it does without.
    pub(super) fn absent_bodies(&self) -> Vec<BTreeSet<usize>> {
        let (deck, mut gone) = (self.deck, BTreeSet::new());
        let mut all = Vec::new();
        for step in &deck.step {
            gone.extend(step.remove.iter().filter_map(|name| self.body_of(name)));
            step.add.iter().filter_map(|name| self.body_of(name)).for_each(|body| _ = gone.remove(&body));
            all.push(gone.clone());
        }
        all
    }

    /// The body of a name that is that of no contact and no tool.
    fn body_of(&self, name: &Name) -> Option<usize> {
        let deck = self.deck;
        let other =
            deck.contact.iter().any(|(contact, keys)| contact.text == name.text || keys.target.text == name.text);
        deck.body.iter().position(|(body, _)| body.text == name.text).filter(|_| !other)
    }

    /// The contact of a name, or all of a tool, or a body.
    fn terms_of(&mut self, name: &Name, terms: &[String]) -> Vec<usize> {
        if let Some(body) = self.body_of(name) {
            return vec![body];
        }
        let (deck, bodies) = (self.deck, self.deck.body.len());
        let meant =
            deck.contact.iter().filter(|(contact, keys)| contact.text == name.text || keys.target.text == name.text);
        let meant: Vec<&str> = meant.map(|(contact, _)| contact.text.as_str()).collect();
        if meant.is_empty() {
            self.refuse(format!("no contact has the target `{name}`, and it is no body"), name.place);
        }
        let is_meant = |term: &String| meant.iter().any(|name| term == name || *term == second_name(name));
        (bodies..terms.len()).filter(|&term| is_meant(&terms[term])).collect()
    }

    /// The ties that hold in each step: those whose surfaces are both there.
    pub(super) fn standing_ties(&mut self, absent: &[BTreeSet<usize>]) -> Vec<Vec<usize>> {
        let (deck, owner, mesh) = (self.deck, self.owners(), self.site.mesh.clone());
        let owners = |name: &Name| -> BTreeSet<usize> {
            let sides = mesh.groups.get(&name.text).map_or(&[][..], |group| &group.sides);
            sides.iter().map(|side| owner[side.cell]).collect()
        };
        let sides: Vec<[BTreeSet<usize>; 2]> = self
            .ties
            .iter()
            .map(|glued| [owners(&deck.tie[glued.number].surface), owners(&deck.tie[glued.number].target)])
            .collect();
        let mut refused = BTreeSet::new();
        let mut standing = |absent: &BTreeSet<usize>| {
            let mut gone = |number: &usize| {
                sides[*number].iter().any(|bodies| {
                    let gone = bodies.iter().filter(|body| absent.contains(body)).count();
                    if gone > 0 && gone < bodies.len() {
                        refused.insert(*number);
                    }
                    gone > 0
                })
            };
            (0..sides.len()).filter(|number| !gone(number)).collect()
        };
        let all = absent.iter().map(&mut standing).collect();
        for number in refused {
            let place = self.ties[number].place;
            let what = "a surface of this tie lies on a body that is removed and on others";
            self.found.push(Diagnostic::error(what).at(place).help("make a tie for each body"));
        }
        all
    }

    /// The body of each cell.
    pub(super) fn owners(&self) -> Vec<usize> {
        let mut owner = vec![NONE; self.site.mesh.cell_count()];
        for (number, (name, _)) in self.deck.body.iter().enumerate() {
            let cells = self.site.mesh.groups.get(&name.text).map_or(&[][..], |group| &group.cells);
            cells.iter().for_each(|&cell| owner[cell] = number);
        }
        owner
    }

    /// Whether a contact has a side on one of these bodies.
    fn contact_is_on(&self, term: &str, (owner, bodies): (&[usize], &BTreeSet<usize>)) -> bool {
        if bodies.is_empty() {
            return false;
        }
        let on = |group: &Name| {
            let sides = self.site.mesh.groups.get(&group.text).map_or(&[][..], |group| &group.sides);
            sides.iter().any(|side| bodies.contains(&owner[side.cell]))
        };
        let of = |name: &str| term == name || term == second_name(name);
        let tool = |keys: &Name| self.deck.tool.iter().any(|(tool, _)| tool.text == keys.text);
        self.deck
            .contact
            .iter()
            .any(|(name, keys)| of(&name.text) && (on(&keys.surface) || (!tool(&keys.target) && on(&keys.target))))
    }

    /// Whether a load acts on these bodies alone; one that acts on others too is refused.
    fn load_is_on(&mut self, term: &str, (owner, bodies): (&[usize], &BTreeSet<usize>), step: &StepKeys) -> bool {
        let mesh = self.site.mesh.clone();
        let Some((kind, name)) = term.split_once('.').filter(|_| !bodies.is_empty()) else { return false };
        let Some(group) = mesh.groups.get(name) else { return false };
        let of_sides = |group: &Group| group.sides.iter().map(|side| side.cell).collect::<Vec<_>>();
        let cells = match kind {
            "pressure" | "traction" => of_sides(group),
            "gravity" | "body_force" => group.cells.clone(),
            _ => return false,
        };
        let on = cells.iter().filter(|&&cell| bodies.contains(&owner[cell])).count();
        if on > 0 && on < cells.len() {
            let what = format!("`{term}` acts on a body that is removed and on others: lay it on groups of their own");
            let place = step.remove.first().map_or(self.deck.space.place, |name| name.place);
            if !self.found.iter().any(|found| found.what == what) {
                self.refuse(what, place);
            }
        }
        on > 0 && on == cells.len()
    }
}
