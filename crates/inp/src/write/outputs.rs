//! What is to be written.

use super::{Writer, quoted};
use crate::model::{Output, OutputKind, Printed, Totals};
use crate::read::PLASTIC;

impl Writer<'_> {
    /// Files for CalculiX GraphiX and printed tables, each once.
    pub(super) fn outputs(&mut self) {
        let model = self.model;
        if model.outputs.is_empty() {
            return;
        }
        let own = |output: &&Output| matches!(output.kind, OutputKind::Print { whose: Printed::Nodes(_), .. });
        if let Some(output) = model.outputs.iter().find(own).filter(|_| !model.frames.is_empty()) {
            self.note(output.place, "printed along the axes of the model, of nodes with axes of their own, too");
        }
        let plastic = model.materials.iter().any(|material| !material.plastic.is_empty());
        let every = model.outputs.iter().map(|output| output.every).min().unwrap_or(1);
        let files = model.outputs.iter().any(|output| output.kind == OutputKind::File);
        let mut tables: Vec<String> = Vec::new();
        for output in &model.outputs {
            let OutputKind::Print { whose, quantities, totals } = &output.kind else { continue };
            let known = quantities.iter().filter(|quantity| plastic || **quantity != PLASTIC);
            let known: Vec<String> = known.map(|quantity| quoted(quantity)).collect();
            if known.len() < quantities.len() {
                self.note(output.place, "PEEQ left out: no material is plastic");
            }
            if known.is_empty() {
                continue;
            }
            let totals = match totals {
                Totals::No => "",
                Totals::Yes => "totals = \"yes\"\n",
                Totals::Only => "totals = \"only\"\n",
            };
            let owners = self.owners(whose);
            if owners.is_empty() {
                self.note(
                    output.place,
                    "nothing of a body belongs to what is to be printed; its values are in history.csv",
                );
            }
            for owner in owners {
                let table = format!("{owner}quantities = [{}]\n{totals}", known.join(", "));
                if !tables.contains(&table) {
                    tables.push(table);
                }
            }
        }
        self.text += &format!("\n[output]\nevery = {every}\n");
        if files {
            self.text += "export = [\"frd\"]\n";
        }
        let tables: String = tables.iter().map(|table| format!("\n[[output.print]]\n{table}")).collect();
        self.text += &tables;
    }

    /// Groups or contacts whose values are printed, as lines of the deck.
    fn owners(&mut self, whose: &Printed) -> Vec<String> {
        let model = self.model;
        match whose {
            Printed::Nodes(target) => {
                let (name, members) = match target {
                    Some(target) => (target.name.clone(), target.members.clone()),
                    None => ("ALL_NODES".to_owned(), (0..model.nodes.len()).collect()),
                };
                let members: Vec<usize> = members.into_iter().filter(|&node| self.used[node]).collect();
                if members.is_empty() {
                    return vec![];
                }
                vec![format!("of.nodes = {}\n", quoted(&self.groups.nodes(&name, members)))]
            }
            Printed::Elements(target) => {
                let (name, members) = match target {
                    Some(target) => (target.name.clone(), target.members.clone()),
                    None => ("ALL_ELEMENTS".to_owned(), (0..model.elements.len()).collect()),
                };
                let kept = |element: &usize| self.section.get(*element).copied().flatten().is_some();
                let members: Vec<usize> = members.into_iter().filter(kept).collect();
                if members.is_empty() {
                    return vec![];
                }
                vec![format!("of.cells = {}\n", quoted(&self.groups.cells(&name, members)))]
            }
            Printed::Contacts([slave, master]) => {
                let fits =
                    |wanted: &Option<(usize, String)>, own: &(usize, String)| wanted.as_ref().is_none_or(|w| w == own);
                let pairs = model.pairs.iter().enumerate();
                let pairs = pairs.filter(|(_, pair)| fits(slave, &pair.slave) && fits(master, &pair.master));
                let names = pairs.filter_map(|(number, pair)| self.contact_name(number + 1, pair));
                names.map(|name| format!("of.contact = {}\n", quoted(&name))).collect()
            }
        }
    }
}
