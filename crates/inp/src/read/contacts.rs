//! What happens where surfaces touch, and which may.

use super::Reader;
use super::names::Of;
use crate::elements::Dialect;
use crate::message::{InputPlace, suggestion};
use crate::model::{Adjust, Interaction, Pair, Tie};
use crate::source::KeywordBlock;

impl Reader {
    /// `*SURFACE INTERACTION`.
    pub(crate) fn surface_interaction(&mut self, block: &KeywordBlock) {
        let Some(name) = self.required(block, "NAME") else { return };
        self.model.interactions.push(Interaction { name: name.to_string(), ..Interaction::default() });
        self.interaction = Some(self.model.interactions.len() - 1);
    }

    fn of_interaction(&mut self, place: InputPlace, name: &str, change: impl FnOnce(&mut Interaction)) {
        match self.interaction.and_then(|at| self.model.interactions.get_mut(at)) {
            Some(interaction) => change(interaction),
            None => {
                self.error(place, format!("*{name} belongs to no interaction; put it below a *SURFACE INTERACTION"))
            }
        }
    }

    /// `*SURFACE BEHAVIOR`.
    pub(crate) fn surface_behavior(&mut self, block: &KeywordBlock) {
        let kind = block.word("PRESSURE-OVERCLOSURE");
        match kind.as_deref() {
            Some("TIED") => {
                if let Some(line) = block.lines.first()
                    && self.positive(line, 0, "the slope of stress over the distance").is_none()
                {
                    return;
                }
                self.of_interaction(block.place, "SURFACE BEHAVIOR", |interaction| interaction.tied = true);
            }
            Some("EXPONENTIAL") => self.exponential(block),
            Some("TABULAR") => self.tabular(block),
            Some("LINEAR") => self.linear(block),
            _ if block.word("PENALTY").is_some_and(|kind| kind == "LINEAR") && !block.lines.is_empty() => {
                self.linear(block);
            }
            _ => {}
        }
    }

    fn linear(&mut self, block: &KeywordBlock) {
        let Some(line) = self.first_line(block, "the slope of pressure over penetration") else { return };
        let Some(slope) = self.positive(line, 0, "the slope of pressure over penetration") else { return };
        self.real_or(line, 2, "the distance of that tension", 0.0);
        let Some(tension) = self.real_or(line, 1, "the tension far away", 0.0) else { return };
        if tension != 0.0 {
            let what = format!("surfaces that are apart pull each other by nothing here, in place of up to {tension}");
            self.note(line.place, what);
        }
        self.slope(block.place, slope);
    }

    fn slope(&mut self, place: InputPlace, slope: f64) {
        self.of_interaction(place, "SURFACE BEHAVIOR", |interaction| interaction.slope = Some(slope));
    }

    /// A pressure that begins at a clearance `c0`, is `p0` at none and grows by a power of e: linear with the slope that it has
    /// there. CalculiX' is a hundredth of `p0` at `c0`; Abaqus' is zero there.
    fn exponential(&mut self, block: &KeywordBlock) {
        let Some(line) = self.first_line(block, "a clearance, and the pressure where there is none") else { return };
        let (Some(clearance), Some(pressure)) = (
            self.positive(line, 0, "the clearance at which surfaces begin to press"),
            self.positive(line, 1, "the pressure where there is no clearance"),
        ) else {
            return;
        };
        let slope = match self.model.dialect {
            Dialect::CalculiX => 100.0_f64.ln() * pressure / clearance,
            // p = p0 / (e - 1) ((c/c0 + 1) (exp(c/c0 + 1) - 1)), whose slope at c = 0 is p0 / c0 (2 e - 1) / (e - 1).
            Dialect::Abaqus => {
                let e = std::f64::consts::E;
                pressure / clearance * (2.0 * e - 1.0) / (e - 1.0)
            }
        };
        let what = format!(
            "EXPONENTIAL becomes linear, from touching on, with the slope {slope:.3e} that it has at no clearance: surfaces that begin to \
             press at a distance of {clearance} come closer by about as much, and differ by less where the pressure is near {pressure}"
        );
        self.note(line.place, what);
        self.slope(block.place, slope);
    }

    /// A table of pressure over overclosure that is a line from touching on.
    fn tabular(&mut self, block: &KeywordBlock) {
        if self.first_line(block, "pressures and overclosures").is_none() {
            return;
        }
        let mut rows: Vec<[f64; 2]> = Vec::new();
        for line in &block.lines {
            let (Some(pressure), Some(depth)) =
                (self.real(line, 0, "a pressure"), self.real(line, 1, "an overclosure"))
            else {
                return;
            };
            // Rows without pressure before the last such say nothing.
            if pressure == 0.0 && rows.last().is_some_and(|last| last[0] == 0.0 && depth > last[1]) {
                rows.clear();
            }
            let rises = rows.last().is_none_or(|last| pressure > last[0] && depth > last[1]);
            if !rises || (rows.is_empty() && pressure != 0.0) {
                let what = "a table of pressure over overclosure begins with a pressure of zero, and both rise from row to row";
                return self.error(line.place, what);
            }
            rows.push([pressure, depth]);
        }
        let (Some(first), Some(last)) = (rows.first(), rows.last()) else { return };
        if rows.len() < 2 {
            return self.error(block.place, "a table of pressure over overclosure has two rows at least");
        }
        if first[1].abs() > 1e-9 * last[1].abs() {
            let what = format!(
                "surfaces press from touching on, and this table begins at an overclosure of {}; begin it at zero",
                first[1]
            );
            return self.error(block.place, what);
        }
        let slope = last[0] / (last[1] - first[1]);
        if rows.iter().all(|[p, h]| (p - slope * (h - first[1])).abs() <= 1e-6 * last[0]) {
            return self.slope(block.place, slope);
        }
        self.note(
            block.place,
            "beyond its last row the table of pressure over overclosure goes on with the slope before it",
        );
        let rows: Vec<[f64; 2]> = rows.iter().map(|&[pressure, depth]| [depth - first[1], pressure]).collect();
        self.of_interaction(block.place, "SURFACE BEHAVIOR", |interaction| interaction.closure = rows);
    }

    /// `*FRICTION`.
    pub(crate) fn friction(&mut self, block: &KeywordBlock) {
        if self.step.is_some() {
            return self.changed_friction(block);
        }
        if block.has("ROUGH") {
            return self.of_interaction(block.place, "FRICTION", |interaction| interaction.rough = true);
        }
        let Some(line) = self.first_line(block, "the coefficient of friction") else { return };
        let Some(friction) = self.real(line, 0, "the coefficient of friction") else { return };
        if friction < 0.0 {
            return self
                .error(line.place, format!("the coefficient of friction is {friction}; it must not be negative"));
        }
        if let Some(other) = block.lines.get(1) {
            return self.error(
                other.place,
                "friction that changes with pressure, slip or temperature cannot be translated; give one row",
            );
        }
        let mut changed = Interaction { friction: Some(friction), ..Interaction::default() };
        if block.has("EXPONENTIAL DECAY") {
            let Some(kinetic) = self.real(line, 1, "the kinetic coefficient") else { return };
            let Some(decay) = self.real_or(line, 2, "the decay", 0.0) else { return };
            changed.decay = Some([kinetic, decay]).filter(|_| decay > 0.0);
            changed.friction = Some(if decay > 0.0 { friction } else { kinetic });
        } else {
            let Some(slope) = self.real_or(line, 1, "the slope of stick", 0.0) else { return };
            changed.stick_slope = Some(slope).filter(|&slope| slope > 0.0);
        }
        if let Some(limit) = block.value("TAUMAX") {
            let Some(limit) = self.number(block.place, limit, "TAUMAX") else { return };
            changed.shear_limit = Some(limit).filter(|&limit| limit > 0.0);
        }
        self.of_interaction(block.place, "FRICTION", |interaction| {
            // What is said of the pressure stays.
            let Interaction { name, slope, closure, tied, .. } = interaction.clone();
            *interaction = Interaction { name, slope, closure, tied, ..changed };
        });
    }

    /// `*TIE`.
    pub(crate) fn tie(&mut self, block: &KeywordBlock) {
        if self.first_line(block, "the two surfaces").is_none() {
            return;
        }
        let tolerance = match block.value("POSITION TOLERANCE") {
            Some(value) => match self.number(block.place, value, "POSITION TOLERANCE") {
                Some(value) if value > 0.0 => Some(value),
                Some(_) => return self.error(block.place, "POSITION TOLERANCE must be positive"),
                None => return,
            },
            None => None,
        };
        let adjust = block.word("ADJUST").is_none_or(|word| word != "NO");
        for line in &block.lines {
            let (first, second) = (line.field(0), line.field(1));
            if second.is_empty() {
                self.error(line.place, "a tie has two surfaces: the one that follows, and the one that it follows");
                continue;
            }
            let (slave, master) = (self.named_surface(line.place, first), self.named_surface(line.place, second));
            if let (Some(slave), Some(master)) = (slave, master) {
                self.model.ties.push(Tie { place: line.place, slave, master, tolerance, adjust });
            }
        }
    }

    /// The number of an interaction.
    pub(super) fn interaction_named(&mut self, place: InputPlace, name: &str) -> Option<usize> {
        let found = self.model.interactions.iter().position(|one| one.name.eq_ignore_ascii_case(name));
        if found.is_none() {
            let near = suggestion(name, self.model.interactions.iter().map(|one| one.name.as_str()));
            self.error(place, format!("there is no surface interaction '{name}'{near}"));
        }
        found
    }

    /// `*CONTACT PAIR`.
    pub(crate) fn contact_pair(&mut self, block: &KeywordBlock) {
        let Some(name) = self.required(block, "INTERACTION") else { return };
        let name = name.to_string();
        let Some(interaction) = self.interaction_named(block.place, &name) else { return };
        let adjust = match block.value("ADJUST").map(str::to_string) {
            _ if !block.has("ADJUST") => None,
            None => Some(Adjust { distance: 0.0, nodes: None, clearance: None }),
            Some(text) => match text.parse::<f64>() {
                Ok(distance) if distance >= 0.0 && distance.is_finite() => {
                    Some(Adjust { distance, nodes: None, clearance: None })
                }
                Ok(_) => {
                    return self.error(block.place, "ADJUST is a distance, which is not negative, or a set of nodes");
                }
                Err(_) => {
                    let Some(target) = self.members(block.place, &text, Of::Nodes) else { return };
                    Some(Adjust { distance: f64::INFINITY, nodes: Some(target.members), clearance: None })
                }
            },
        };
        let mortar = block.word("TYPE").is_some_and(|kind| kind.contains("MORTAR"));
        let field = mortar || self.model.dialect == Dialect::Abaqus;
        if !field && block.word("TYPE").is_some_and(|kind| kind == "NODETOSURFACE") {
            let what = "NODE TO SURFACE has springs at the nodes of the slave in CalculiX; here contact lives on the faces between them";
            self.note(block.place, what);
        }
        for (place, [slave, master]) in self.surface_pairs(block) {
            self.model.pairs.push(Pair { place, slave, master, interaction, adjust: adjust.clone(), field });
        }
    }

    /// `*CLEARANCE`: how far the slave of a pair stands off from its master before the first step, whatever the mesh says.
    pub(crate) fn clearance(&mut self, block: &KeywordBlock) {
        let named = ["SLAVE", "MASTER"].map(|side| self.required(block, side).map(str::to_string));
        let [Some(slave), Some(master)] = named else { return };
        let Some(value) = self.required(block, "VALUE").map(str::to_string) else { return };
        let Some(value) = self.number(block.place, &value, "VALUE") else { return };
        if value < 0.0 {
            return self.error(block.place, "VALUE must not be negative; model an overlap in the mesh");
        }
        let (slave, master) = (self.named_surface(block.place, &slave), self.named_surface(block.place, &master));
        let (Some(slave), Some(master)) = (slave, master) else { return };
        let adjust = Adjust { distance: f64::INFINITY, nodes: None, clearance: Some(value) };
        match self.model.pairs.iter_mut().find(|pair| (&pair.slave, &pair.master) == (&slave, &master)) {
            Some(pair) => pair.adjust = Some(adjust),
            None => self.error(
                block.place,
                format!("there is no *CONTACT PAIR of '{}' and '{}' above; put *CLEARANCE below it", slave.1, master.1),
            ),
        }
    }

    /// The pairs of surfaces that the lines of a block name, where both are there; a line with one is of that with itself.
    pub(super) fn surface_pairs(&mut self, block: &KeywordBlock) -> Vec<(InputPlace, [(usize, String); 2])> {
        let mut pairs = Vec::new();
        if self.first_line(block, "the two surfaces").is_none() {
            return pairs;
        }
        for line in &block.lines {
            let first = line.field(0);
            let second = Some(line.field(1)).filter(|field| !field.is_empty()).unwrap_or(first);
            let (slave, master) = (self.named_surface(line.place, first), self.named_surface(line.place, second));
            if let (Some(slave), Some(master)) = (slave, master) {
                pairs.push((line.place, [slave, master]));
            }
        }
        pairs
    }
}
