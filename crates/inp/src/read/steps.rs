//! Steps and what they say.

use super::Reader;
use super::names::Of;
use crate::message::{InputPlace, suggestion};
use crate::model::{Action, ActionKind, Condition, Course, Path, Step, SurfaceKind, Target};
use crate::source::{DataLine, KeywordBlock};

impl Reader {
    /// `*STEP`.
    pub(crate) fn step(&mut self, block: &KeywordBlock) {
        let number = self.model.steps.len() + 1;
        let name = block.value("NAME").map_or_else(|| format!("step {number}"), str::to_string);
        let large = block.has("NLGEOM") && block.word("NLGEOM").as_deref() != Some("NO");
        // Once strains are large they stay so.
        let large = large || self.model.steps.last().is_some_and(|step| step.large);
        let at_once = block.word("AMPLITUDE").as_deref() == Some("STEP");
        let most = match block.value("INC").map(str::parse::<u64>) {
            None => None,
            Some(Ok(most @ 1..=100_000_000)) => Some(most),
            Some(_) => return self.error(block.place, "INC is a whole number of increments, at least 1"),
        };
        let step = Step { place: block.place, name, large, at_once, most, duration: 1.0, ..Step::default() };
        self.model.steps.push(step);
        self.step = Some(self.model.steps.len() - 1);
    }

    /// `*END STEP`.
    pub(crate) fn end_step(&mut self, _: &KeywordBlock) {
        self.step = None;
    }

    /// `*STATIC`.
    pub(crate) fn static_step(&mut self, block: &KeywordBlock) {
        let mut given = [None; 4];
        if let Some(line) = block.lines.first() {
            for (at, value) in given.iter_mut().enumerate() {
                let Some(number) = self.real_or(line, at, "a time", 0.0) else { return };
                if number < 0.0 {
                    return self.error(line.place, format!("a time is {number}; it must be positive"));
                }
                *value = Some(number).filter(|&number| number > 0.0);
            }
        }
        let path = if block.has("RIKS") {
            let Some(path) = self.path(block) else { return };
            Some(path)
        } else {
            None
        };
        let Some(step) = self.step.and_then(|at| self.model.steps.get_mut(at)) else { return };
        step.procedure = true;
        step.path = path;
        step.direct = block.has("DIRECT");
        step.duration = given[1].unwrap_or(1.0);
        step.increments = [given[0], given[2], given[3]];
    }

    /// Where a step ends that follows a path: behind the times stand the load factor, and a node with its degree of freedom and
    /// displacement.
    fn path(&mut self, block: &KeywordBlock) -> Option<Path> {
        if block.has("DIRECT") {
            self.error(block.place, "increments of a path adapt their length; leave DIRECT out");
            return None;
        }
        let Some(line) = block.lines.first() else { return Some(Path { until: None }) };
        let until = match line.field(5) {
            "" => None,
            name => {
                let target = self.members(line.place, name, Of::Nodes)?;
                Some((target, self.axis(line, 6)?, self.real(line, 7, "the displacement at which the path ends")?))
            }
        };
        let factor = self.real_or(line, 4, "the load factor at which the path ends", 0.0)?;
        if factor != 0.0 && factor != 1.0 {
            let what = "the path ends where the load factor is 1: give the loads of the step times the factor meant, and 1 here";
            self.error(line.place, what);
            return None;
        }
        if let Some((_, 3.., _)) = until {
            self.error(line.place, "a path ends at a displacement: degrees of freedom 1 to 3");
            return None;
        }
        if until.is_none() && factor == 0.0 {
            self.note(
                line.place,
                "the path ends where the whole load is reached; a node and a displacement end it elsewhere",
            );
        }
        Some(Path { until })
    }

    /// Adds to the present step, or to what holds before the first.
    fn act(&mut self, place: InputPlace, course: Course, kind: ActionKind) {
        let action = Action { place, course, kind };
        match self.step.and_then(|at| self.model.steps.get_mut(at)) {
            Some(step) => step.actions.push(action),
            None => self.model.initial.push(action),
        }
    }

    /// The amplitude of a block; conditions of its kind end where it says OP=NEW.
    fn begin(&mut self, block: &KeywordBlock, condition: Condition) -> Course {
        if block.word("OP").as_deref() == Some("NEW") {
            self.act(block.place, None, ActionKind::Fresh(condition));
        }
        let name = block.value("AMPLITUDE").map(str::to_ascii_uppercase)?;
        let found = self.model.amplitudes.iter().position(|(known, _)| *known == name);
        if found.is_none() {
            let near = suggestion(&name, self.model.amplitudes.iter().map(|(known, _)| known.as_str()));
            self.error(block.place, format!("there is no amplitude '{name}'{near}"));
        }
        found
    }

    /// `*BOUNDARY`.
    pub(crate) fn boundary(&mut self, block: &KeywordBlock) {
        let course = self.begin(block, Condition::Boundary);
        for line in &block.lines {
            let name = line.field(0).to_string();
            let Some(target) = self.members(line.place, &name, Of::Nodes) else { continue };
            let Some((axes, value)) = self.led(line) else { continue };
            for axis in axes {
                self.act(line.place, course, ActionKind::Lead(target.clone(), axis, value));
            }
        }
    }

    /// The axes that a line of *BOUNDARY holds, and the value.
    fn led(&mut self, line: &DataLine) -> Option<(Vec<usize>, f64)> {
        let first = line.field(1).to_ascii_uppercase();
        let symmetry: Option<&[usize]> = match first.as_str() {
            "XSYMM" => Some(&[0, 4, 5]),
            "YSYMM" => Some(&[1, 3, 5]),
            "ZSYMM" => Some(&[2, 3, 4]),
            "XASYMM" => Some(&[1, 2, 3]),
            "YASYMM" => Some(&[0, 2, 4]),
            "ZASYMM" => Some(&[0, 1, 5]),
            "ENCASTRE" => Some(&[0, 1, 2, 3, 4, 5]),
            "PINNED" => Some(&[0, 1, 2]),
            _ => None,
        };
        if let Some(axes) = symmetry {
            return Some((axes.to_vec(), 0.0));
        }
        let first = self.axis(line, 1)?;
        let last = if line.field(2).is_empty() { first } else { self.axis(line, 2)? };
        if last < first {
            self.error(line.place, "the last degree of freedom lies before the first; mend the line");
            return None;
        }
        let value = self.real_or(line, 3, "the value", 0.0)?;
        Some(((first..=last).collect(), value))
    }

    /// A degree of freedom from 1 to 6, counted from zero.
    pub(super) fn axis(&mut self, line: &DataLine, at: usize) -> Option<usize> {
        let field = line.field(at);
        match field.parse::<usize>() {
            Ok(axis @ 1..=6) => Some(axis - 1),
            _ if field.is_empty() => {
                let what = "the degree of freedom is missing: 1 to 3 along the axes, 4 to 6 about them";
                self.error(line.place, what);
                None
            }
            _ => {
                let what = format!(
                    "'{}' is no degree of freedom; it is 1 to 3 along the axes, 4 to 6 about them",
                    super::shorten(field)
                );
                self.error(line.place, what);
                None
            }
        }
    }

    /// `*CLOAD`.
    pub(crate) fn cload(&mut self, block: &KeywordBlock) {
        let course = self.begin(block, Condition::Force);
        for line in &block.lines {
            let name = line.field(0).to_string();
            let Some(target) = self.members(line.place, &name, Of::Nodes) else { continue };
            let (Some(axis), Some(value)) = (self.axis(line, 1), self.real(line, 2, "the force")) else { continue };
            self.act(line.place, course, ActionKind::Force(target, axis, value));
        }
    }

    /// `*DLOAD`.
    pub(crate) fn dload(&mut self, block: &KeywordBlock) {
        let course = self.begin(block, Condition::Distributed);
        for line in &block.lines {
            self.load(line, course);
        }
    }

    fn load(&mut self, line: &DataLine, course: Course) -> Option<()> {
        let (name, label) = (line.field(0).to_string(), line.field(1).to_ascii_uppercase());
        let target = match name.as_str() {
            // Abaqus takes the whole model.
            "" => Target { name: "ALL".into(), members: (0..self.model.elements.len()).collect() },
            name => self.members(line.place, name, Of::Elements)?,
        };
        let kind = match label.as_str() {
            "GRAV" => {
                let size = self.real(line, 2, "the acceleration")?;
                let mut direction = [0.0; 3];
                for (axis, value) in direction.iter_mut().enumerate() {
                    *value = self.real_or(line, 3 + axis, "a component of the direction", 0.0)?;
                }
                let length = direction.iter().fold(0.0_f64, |length, x| length.hypot(*x));
                if length <= 0.0 {
                    self.error(line.place, "gravity has no direction; give it after the acceleration");
                    return None;
                }
                ActionKind::Volume(target, direction.map(|x| size * x / length), true)
            }
            "BX" | "BY" | "BZ" => {
                let value = self.real(line, 2, "the force per volume")?;
                let axis = usize::from(label.as_bytes()[1] - b'X');
                ActionKind::Volume(target, std::array::from_fn(|i| if i == axis { value } else { 0.0 }), false)
            }
            "CENTRIF" | "CENT" | "CENTRIFUGAL" | "CORIO" | "ROTA" => {
                self.error(
                    line.place,
                    format!("loads of type {label} cannot be translated; GRAV, BX, BY, BZ, P and P1 to P6 can"),
                );
                return None;
            }
            _ => {
                let value = self.real(line, 2, "the pressure")?;
                let faces = self.pressed(line.place, &target.members, &label)?;
                ActionKind::Pressure(Target { name: format!("{name}.{label}"), members: vec![] }, faces, value)
            }
        };
        self.act(line.place, course, kind);
        Some(())
    }

    /// The faces of elements that a label P, P1 to P6 loads.
    fn pressed(&mut self, place: InputPlace, elements: &[usize], label: &str) -> Option<Vec<(usize, Option<usize>)>> {
        let Some(number) = label.strip_prefix('P').filter(|number| number.chars().all(|c| c.is_ascii_digit())) else {
            let what = format!(
                "loads of type '{}' cannot be translated; GRAV, BX, BY, BZ, P and P1 to P6 can",
                super::shorten(label)
            );
            self.error(place, what);
            return None;
        };
        let label = if number.is_empty() { String::new() } else { format!("S{number}") };
        let mut faces = Vec::new();
        for &element in elements {
            faces.push((element, self.face(place, element, &label)?.0));
        }
        Some(faces)
    }

    /// `*DSLOAD`.
    pub(crate) fn dsload(&mut self, block: &KeywordBlock) {
        let course = self.begin(block, Condition::Distributed);
        for line in &block.lines {
            let (name, label) = (line.field(0), line.field(1));
            if !label.eq_ignore_ascii_case("P") {
                let what = format!("loads of type '{}' on surfaces cannot be translated; P can", super::shorten(label));
                self.error(line.place, what);
                continue;
            }
            let Some(surface) = self.named_surface(line.place, name) else { continue };
            let Some(value) = self.real(line, 2, "the pressure") else { continue };
            let found = self.model.surface(&surface).map(|surface| (surface.name.clone(), surface.kind.clone()));
            match found {
                Some((name, SurfaceKind::Faces(faces))) => {
                    let faces = faces.iter().map(|&(element, face, _)| (element, face)).collect();
                    self.act(line.place, course, ActionKind::Pressure(Target { name, members: vec![] }, faces, value));
                }
                _ => self.error(line.place, format!("surface '{name}' has no faces that pressure could act on")),
            }
        }
    }

    /// `*CHANGE FRICTION`: the coefficient stands in the `*FRICTION` below it.
    pub(crate) fn change_friction(&mut self, block: &KeywordBlock) {
        self.end_change();
        let Some(name) = self.required(block, "INTERACTION") else { return };
        let name = name.to_string();
        self.changing = self.interaction_named(block.place, &name).map(|interaction| (interaction, block.place));
    }

    /// A `*CHANGE FRICTION` must have said to what.
    pub(super) fn end_change(&mut self) {
        if let Some((_, place)) = self.changing.take() {
            self.error(place, "*CHANGE FRICTION says no coefficient; put a *FRICTION below it");
        }
    }

    /// The `*FRICTION` below a `*CHANGE FRICTION`.
    pub(super) fn changed_friction(&mut self, block: &KeywordBlock) {
        let Some((interaction, _)) = self.changing.take() else {
            return self.error(block.place, "*FRICTION in a step belongs to a *CHANGE FRICTION; put that above it");
        };
        let plain = !["ROUGH", "TAUMAX", "EXPONENTIAL DECAY"].iter().any(|parameter| block.has(parameter));
        let known = self.model.interactions.get(interaction).cloned();
        if !plain || block.lines.len() > 1 || known.as_ref().is_some_and(|known| known.rough || known.decay.is_some()) {
            let what = "only the coefficient of friction can be changed, of an interaction that has one or none";
            return self.error(block.place, what);
        }
        let value = match block.lines.first() {
            Some(line) => {
                let slope = self.real_or(line, 1, "the slope of stick", 0.0);
                if slope.is_some_and(|slope| {
                    slope > 0.0 && known.as_ref().is_some_and(|known| known.stick_slope != Some(slope))
                }) {
                    self.note(line.place, "the slope of stick stays what it was: only the coefficient changes");
                }
                self.real(line, 0, "the coefficient of friction")
            }
            None => Some(0.0),
        };
        match value {
            Some(value) if value >= 0.0 => self.act(block.place, None, ActionKind::Friction(interaction, value)),
            Some(value) => {
                self.error(block.place, format!("the coefficient of friction is {value}; it must not be negative"));
            }
            None => {}
        }
    }

    /// `*MODEL CHANGE` of contact pairs and elements.
    pub(crate) fn model_change(&mut self, block: &KeywordBlock) {
        let kind = block.word("TYPE");
        let (add, remove) = (block.has("ADD"), block.has("REMOVE"));
        if add == remove {
            return self.error(block.place, "*MODEL CHANGE needs either ADD or REMOVE");
        }
        match kind.as_deref() {
            Some("CONTACTPAIR") => {
                for (place, [slave, master]) in self.surface_pairs(block) {
                    self.act(place, None, ActionKind::Contact(slave, master, add));
                }
            }
            Some("ELEMENT") => self.change_elements(block, add),
            _ => {
                let what =
                    "contact pairs and elements can be removed and added; write TYPE=CONTACT PAIR or TYPE=ELEMENT";
                self.error(block.place, what);
            }
        }
    }

    /// `*MODEL CHANGE, TYPE=ELEMENT`.
    fn change_elements(&mut self, block: &KeywordBlock, add: bool) {
        if block.word("ADD").is_some_and(|how| how == "WITHSTRAIN") {
            let what =
                "elements come back without stress in the shape that their nodes have; write ADD, or ADD=STRAIN FREE";
            return self.error(block.place, what);
        }
        for line in &block.lines {
            for name in line.fields().into_iter().filter(|name| !name.is_empty()) {
                if let Some(target) = self.members(line.place, name, Of::Elements) {
                    self.act(line.place, None, ActionKind::Elements(target, add));
                }
            }
        }
    }

    /// `*TEMPERATURE`.
    pub(crate) fn temperature(&mut self, block: &KeywordBlock) {
        let course = self.begin(block, Condition::Temperature);
        for line in &block.lines {
            let name = line.field(0).to_string();
            let target = self.members(line.place, &name, Of::Nodes);
            if let (Some(target), Some(value)) = (target, self.real(line, 1, "the temperature")) {
                self.act(line.place, course, ActionKind::Temperature(target, value));
            }
        }
    }

    /// `*INITIAL CONDITIONS`.
    pub(crate) fn initial_conditions(&mut self, block: &KeywordBlock) {
        if block.word("TYPE").as_deref() != Some("TEMPERATURE") {
            let what = "only TYPE=TEMPERATURE can be translated; stresses at the beginning are `initial_stress` of a body in the deck of Asperity";
            return self.error(block.place, what);
        }
        for line in &block.lines {
            let name = line.field(0).to_string();
            let target = self.members(line.place, &name, Of::Nodes);
            if let (Some(target), Some(value)) = (target, self.real(line, 1, "the temperature")) {
                self.model.initial_temperature.extend(target.members.iter().map(|&node| (node, value)));
            }
        }
    }
}
