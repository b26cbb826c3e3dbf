//! What is to be written: files and tables.

use super::Reader;
use super::names::Of;
use crate::message::{InputPlace, suggestion};
use crate::model::{Output, OutputKind, Printed, Totals};
use crate::source::KeywordBlock;

/// What a label asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Meant {
    /// These quantities.
    Of(&'static [&'static str]),
    /// What `results.frd` holds of itself.
    Filed,
    /// Nothing that there is.
    Nothing,
}

use Meant::{Filed, Nothing, Of as Quantities};

/// Labels of `*NODE FILE` and `*NODE PRINT`.
static NODES: &[(&str, Meant)] = &[
    ("U", Quantities(&["displacement"])),
    ("RF", Quantities(&["reaction"])),
    ("NT", Nothing),
    ("PU", Nothing),
    ("V", Nothing),
    ("KEQ", Nothing),
    ("RFL", Nothing),
    ("CP", Nothing),
    ("DEPF", Nothing),
    ("DEPT", Nothing),
    ("DTF", Nothing),
    ("HCRI", Nothing),
    ("MACH", Nothing),
    ("MAXU", Nothing),
    ("MF", Nothing),
    ("POT", Nothing),
    ("PRF", Nothing),
    ("PS", Nothing),
    ("PSF", Nothing),
    ("PT", Nothing),
    ("PTF", Nothing),
    ("SEN", Nothing),
    ("TS", Nothing),
    ("TSF", Nothing),
    ("TT", Nothing),
    ("TTF", Nothing),
    ("TURB", Nothing),
    ("VF", Nothing),
];

/// Labels of `*EL FILE` and `*EL PRINT`.
static ELEMENTS: &[(&str, Meant)] = &[
    ("S", Quantities(&["cauchy_stress"])),
    ("E", Quantities(&["logarithmic_strain"])),
    ("LE", Quantities(&["logarithmic_strain"])),
    ("PEEQ", Quantities(&[PLASTIC])),
    ("NOE", Filed),
    ("ZZS", Filed),
    ("ME", Nothing),
    ("ERR", Nothing),
    ("ENER", Nothing),
    ("ECD", Nothing),
    ("EMFB", Nothing),
    ("EMFE", Nothing),
    ("HER", Nothing),
    ("HFL", Nothing),
    ("HFLF", Nothing),
    ("MAXE", Nothing),
    ("MAXS", Nothing),
    ("PHS", Nothing),
    ("SF", Nothing),
    ("SMID", Nothing),
    ("SNEG", Nothing),
    ("SPOS", Nothing),
    ("SVF", Nothing),
    ("SDV", Nothing),
    ("THE", Nothing),
    ("CEEQ", Nothing),
    ("SNE", Nothing),
    ("ELSE", Nothing),
    ("ELKE", Nothing),
    ("EVOL", Nothing),
    ("COORD", Nothing),
    ("EBHE", Nothing),
    ("CENT", Nothing),
    ("EMAS", Nothing),
];

/// Labels of `*CONTACT FILE` and `*CONTACT PRINT`.
static CONTACTS: &[(&str, Meant)] = &[
    ("CDIS", Quantities(&["contact_gap", "contact_slip"])),
    ("CSTR", Quantities(&["contact_pressure", "contact_traction"])),
    ("CF", Quantities(&["contact_force"])),
    ("CFN", Quantities(&["contact_force"])),
    ("CFS", Quantities(&["contact_force"])),
    ("CELS", Nothing),
    ("CNUM", Nothing),
    ("PCON", Nothing),
];

/// The plastic strain, which not all materials have.
pub const PLASTIC: &str = "equivalent_plastic_strain";

impl Reader {
    /// `*NODE FILE`.
    pub(crate) fn node_file(&mut self, block: &KeywordBlock) {
        self.file(block, NODES);
    }
    /// `*EL FILE`.
    pub(crate) fn element_file(&mut self, block: &KeywordBlock) {
        self.file(block, ELEMENTS);
    }
    /// `*CONTACT FILE`.
    pub(crate) fn contact_file(&mut self, block: &KeywordBlock) {
        self.file(block, CONTACTS);
    }
    /// `*NODE PRINT`.
    pub(crate) fn node_print(&mut self, block: &KeywordBlock) {
        let set = block.value("NSET").map(str::to_string);
        let found = set.map(|set| self.members(block.place, &set, Of::Nodes));
        if found.as_ref().is_none_or(Option::is_some) {
            self.print(block, NODES, Printed::Nodes(found.flatten()));
        }
    }
    /// `*EL PRINT`.
    pub(crate) fn element_print(&mut self, block: &KeywordBlock) {
        let set = block.value("ELSET").map(str::to_string);
        let found = set.map(|set| self.members(block.place, &set, Of::Elements));
        if found.as_ref().is_none_or(Option::is_some) {
            self.print(block, ELEMENTS, Printed::Elements(found.flatten()));
        }
    }
    /// `*CONTACT PRINT`.
    pub(crate) fn contact_print(&mut self, block: &KeywordBlock) {
        let named = ["SLAVE", "MASTER"].map(|side| block.value(side).map(str::to_string));
        let mut sides = [None, None];
        for (side, name) in sides.iter_mut().zip(named) {
            let Some(name) = name else { continue };
            *side = self.named_surface(block.place, &name);
            if side.is_none() {
                return;
            }
        }
        self.print(block, CONTACTS, Printed::Contacts(sides));
    }

    fn file(&mut self, block: &KeywordBlock, labels: &[(&str, Meant)]) {
        self.quantities(block, labels, true);
        self.output(block, OutputKind::File);
    }

    fn print(&mut self, block: &KeywordBlock, labels: &[(&str, Meant)], whose: Printed) {
        let quantities = self.quantities(block, labels, false);
        let totals = match block.word("TOTALS").as_deref() {
            Some("YES") => Totals::Yes,
            Some("ONLY") => Totals::Only,
            _ => Totals::No,
        };
        if !quantities.is_empty() {
            self.output(block, OutputKind::Print { whose, quantities, totals });
        }
    }

    fn output(&mut self, block: &KeywordBlock, kind: OutputKind) {
        let mut every = 1;
        for name in ["FREQUENCY", "FREQUENCYF"] {
            let Some(text) = block.value(name) else { continue };
            match text.parse::<u64>() {
                Ok(number) => every = number,
                Err(_) => {
                    let what = format!("{name} is '{}', which is not a whole number", super::shorten(text));
                    return self.error(block.place, what);
                }
            }
        }
        // Without increments between them there are no outputs.
        if every > 0 {
            self.model.outputs.push(Output { place: block.place, every, kind });
        }
    }

    /// The quantities that the labels of a block ask for; what there is not is told.
    fn quantities(&mut self, block: &KeywordBlock, labels: &[(&str, Meant)], filed: bool) -> Vec<&'static str> {
        let (mut found, mut lost): (Vec<&str>, Vec<(InputPlace, String)>) = (vec![], vec![]);
        for line in &block.lines {
            for field in line.fields() {
                let label = field.to_ascii_uppercase();
                // Of these the first four letters count.
                let label =
                    ["CDIS", "CSTR"].iter().find(|name| label.starts_with(**name)).map_or(label, |name| (*name).into());
                match labels.iter().find(|(known, _)| *known == label) {
                    Some((_, Meant::Of(quantities))) => found.extend(*quantities),
                    Some((_, Meant::Filed)) if filed => {}
                    Some(_) => lost.push((line.place, label)),
                    None if field.is_empty() => {}
                    // What is written changes no answer.
                    None => {
                        let near = suggestion(&label, labels.iter().map(|(known, _)| *known));
                        let what = format!("*{} has no output '{}'{near}", block.name, super::shorten(field));
                        let a_name = label.chars().all(|c| c.is_ascii_alphanumeric()) && label.len() <= 8;
                        match a_name {
                            true => self.note(line.place, format!("{what}; left out")),
                            false => self.error(line.place, what),
                        }
                    }
                }
            }
        }
        for (place, label) in lost {
            self.note(place, format!("{label} left out: there is no such result"));
        }
        let mut once: Vec<&str> = Vec::new();
        for quantity in found {
            if !once.contains(&quantity) {
                once.push(quantity);
            }
        }
        once
    }
}
