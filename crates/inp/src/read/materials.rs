//! Materials, sections and amplitudes.

use super::Reader;
use super::names::Of;
use crate::message::{InputPlace, suggestion};
use crate::model::{Amplitude, Form, Material, Rubber, Section, Stiffness, UserLaw};
use crate::source::{DataLine, KeywordBlock};

impl Reader {
    /// `*MATERIAL`.
    pub(crate) fn material(&mut self, block: &KeywordBlock) {
        let Some(name) = self.required(block, "NAME") else { return };
        if self.model.materials.iter().any(|material| material.name.eq_ignore_ascii_case(name)) {
            self.error(block.place, format!("material '{name}' is there twice; give each its own name"));
        }
        self.model.materials.push(Material { name: name.to_string(), place: block.place, ..Material::default() });
        self.material = Some(self.model.materials.len() - 1);
    }

    /// Changes the material that a block belongs to.
    fn of_material(&mut self, place: InputPlace, name: &str, change: impl FnOnce(&mut Material)) {
        match self.material.and_then(|at| self.model.materials.get_mut(at)) {
            Some(material) => change(material),
            None => self.error(place, format!("*{name} belongs to no material; put it below a *MATERIAL")),
        }
    }

    /// Rows of a table of constants: `count` constants and a temperature; rows that differ are refused.
    fn constants(&mut self, block: &KeywordBlock, names: &[&str]) -> Option<Vec<f64>> {
        let first = self.first_line(block, &names.join(", "))?;
        let row = |reader: &mut Self, line: &DataLine| -> Option<Vec<f64>> {
            reader.real_or(line, names.len(), "the temperature", 0.0)?;
            names.iter().enumerate().map(|(at, name)| reader.real(line, at, name)).collect()
        };
        let constants = row(self, first)?;
        for line in &block.lines[1..] {
            if row(self, line)? != constants {
                self.error(line.place, format!("*{} changes with temperature; give one row of constants", block.name));
                return None;
            }
        }
        Some(constants)
    }

    /// So many constants over several lines, and a temperature after them; a second row is refused.
    fn row(&mut self, block: &KeywordBlock, count: usize, what: &str) -> Option<Vec<f64>> {
        self.first_line(block, what)?;
        let mut numbers = Vec::new();
        for line in &block.lines {
            if numbers.len() > count {
                self.error(line.place, format!("*{} changes with temperature; give one row of constants", block.name));
                return None;
            }
            for at in 0..line.fields().len() {
                numbers.push(self.real_or(line, at, "a constant", 0.0)?);
            }
        }
        if numbers.len() < count {
            let told = format!("*{} has {} constants; it needs {count}: {what}", block.name, numbers.len());
            self.error(block.place, told);
            return None;
        }
        numbers.truncate(count);
        Some(numbers)
    }

    /// `*ELASTIC`.
    pub(crate) fn elastic(&mut self, block: &KeywordBlock) {
        let stiffness = match block.word("TYPE").as_deref() {
            Some("ENGINEERINGCONSTANTS") => {
                let what = "E1, E2, E3, nu12, nu13, nu23, G12, G13, G23";
                self.row(block, 9, what).map(Stiffness::Constants)
            }
            Some("ORTHO" | "ORTHOTROPIC") => {
                let what = "D1111, D1122, D2222, D1133, D2233, D3333, D1212, D1313, D2323";
                self.row(block, 9, what).map(|nine| Stiffness::Coefficients(triangle(&nine)))
            }
            Some("ANISO" | "ANISOTROPIC") => {
                let what = "the upper triangle of the stiffness, D1111 to D2323";
                self.row(block, 21, what).map(Stiffness::Coefficients)
            }
            _ => return self.isotropic(block),
        };
        if let Some(stiffness) = stiffness {
            self.of_material(block.place, "ELASTIC", |material| material.stiffness = Some(stiffness));
        }
    }

    fn isotropic(&mut self, block: &KeywordBlock) {
        let Some(constants) = self.constants(block, &["Young's modulus", "Poisson's ratio"]) else { return };
        let [young, poisson] = [constants[0], constants[1]];
        if young <= 0.0 || poisson <= -1.0 || poisson >= 0.5 {
            let what = format!(
                "a modulus of {young} with Poisson's ratio {poisson} is no elastic solid; the modulus is positive, the ratio between -1 and 0.5"
            );
            return self.error(block.place, what);
        }
        self.of_material(block.place, "ELASTIC", |material| material.elastic = Some([young, poisson]));
    }

    /// `*PLASTIC`.
    pub(crate) fn plastic(&mut self, block: &KeywordBlock) {
        if self.first_line(block, "yield stress and plastic strain").is_none() {
            return;
        }
        let mut curve: Vec<[f64; 2]> = Vec::new();
        for line in &block.lines {
            self.real_or(line, 2, "the temperature", 0.0);
            let Some(stress) = self.positive(line, 0, "the yield stress") else { return };
            let Some(strain) = self.real_or(line, 1, "the plastic strain", 0.0) else { return };
            let wrong = match curve.last() {
                None => strain != 0.0,
                Some(last) => strain <= last[1],
            };
            if wrong {
                let what = "plastic strains begin at zero and rise from row to row; a table for each temperature cannot be translated";
                return self.error(line.place, what);
            }
            curve.push([stress, strain]);
        }
        let kinematic = block.word("HARDENING").as_deref() == Some("KINEMATIC");
        if kinematic && curve.len() > 2 {
            return self.error(block.place, "kinematic hardening is linear; give two rows");
        }
        self.of_material(block.place, "PLASTIC", |material| {
            material.plastic = curve;
            material.kinematic = kinematic;
        });
    }

    /// `*POTENTIAL`: Hill's ratios of yield stresses.
    pub(crate) fn potential(&mut self, block: &KeywordBlock) {
        const NAMES: [&str; 6] = ["R11", "R22", "R33", "R12", "R13", "R23"];
        let Some(line) = self.first_line(block, &NAMES.join(", ")) else { return };
        self.real_or(line, 6, "the temperature", 0.0);
        let mut ratios = [1.0; 6];
        for (at, name) in NAMES.iter().enumerate() {
            let Some(ratio) = self.positive(line, at, name) else { return };
            ratios[at] = ratio;
        }
        self.of_material(block.place, "POTENTIAL", |material| material.potential = Some(ratios));
    }

    /// `*USER MATERIAL`: the numbers of a law of the user's own.
    pub(crate) fn user_material(&mut self, block: &KeywordBlock) {
        let mut properties = Vec::new();
        for line in &block.lines {
            for at in 0..line.fields().len() {
                let Some(number) = self.real_or(line, at, "a constant", 0.0) else { return };
                properties.push(number);
            }
        }
        let Some(count) = self.required(block, "CONSTANTS") else { return };
        let Ok(count) = count.parse::<usize>() else {
            return self
                .error(block.place, format!("CONSTANTS is '{}', which is no number of them", super::shorten(count)));
        };
        // What follows the constants is a temperature.
        if properties.len() < count || properties.len() > count + 1 {
            let what = format!("CONSTANTS says {count}, but *USER MATERIAL has {} numbers", properties.len());
            return self.error(block.place, what);
        }
        properties.truncate(count);
        let place = block.place;
        self.of_material(place, "USER MATERIAL", |material| material.user = Some(UserLaw { properties, place }));
    }

    /// `*DEPVAR`: how many values a law of the user's own keeps.
    pub(crate) fn depvar(&mut self, block: &KeywordBlock) {
        let Some(line) = self.first_line(block, "the number of states") else { return };
        let field = line.field(0).to_string();
        let Ok(states) = field.parse::<usize>() else {
            return self.error(line.place, format!("'{}' is no number of states", super::shorten(&field)));
        };
        self.of_material(block.place, "DEPVAR", |material| material.states = states);
    }

    /// `*HYPERELASTIC`.
    pub(crate) fn hyperelastic(&mut self, block: &KeywordBlock) {
        let place = block.place;
        let order = match block.value("N").map(str::parse::<usize>) {
            None => 1,
            Some(Ok(order @ 1..=6)) => order,
            Some(_) => return self.error(place, "N is a whole number from 1 to 6"),
        };
        let has = |name: &str| block.has(name);
        let form = if has("NEO HOOKE") || (has("REDUCED POLYNOMIAL") && order == 1) {
            (Form::NeoHooke, 1, 1)
        } else if has("MOONEY-RIVLIN") || (has("POLYNOMIAL") && order == 1) {
            (Form::MooneyRivlin, 2, 1)
        } else if has("YEOH") || (has("REDUCED POLYNOMIAL") && order == 3) {
            (Form::Yeoh, 3, 3)
        } else if has("OGDEN") {
            (Form::Ogden, 2 * order, order)
        } else if has("ARRUDA-BOYCE") {
            (Form::ArrudaBoyce, 2, 1)
        } else {
            let what = "this form of *HYPERELASTIC cannot be translated; NEO HOOKE, MOONEY-RIVLIN, YEOH, OGDEN, ARRUDA-BOYCE can";
            return self.error(place, what);
        };
        let (form, shape, volume) = form;
        let mut numbers = Vec::new();
        for line in &block.lines {
            let last = line.fields().len();
            for at in 0..last {
                let Some(number) = self.real_or(line, at, "a constant", 0.0) else { return };
                numbers.push(number);
            }
        }
        if numbers.len() < shape {
            return self.error(
                place,
                format!(
                    "*HYPERELASTIC has {} constants; this form needs {shape} and {volume} of volume",
                    numbers.len()
                ),
            );
        }
        if numbers.len() > shape + volume + 1 {
            return self
                .error(place, "*HYPERELASTIC has more constants than its form; give one row for one temperature");
        }
        let volumes = numbers.split_off(shape);
        if volumes.iter().take(volume).skip(1).any(|&d| d != 0.0) {
            return self.error(place, "only D1 of the change of volume can be translated; set D2, D3 to zero");
        }
        let d1 = volumes.first().copied().unwrap_or(0.0);
        if d1 < 0.0 {
            return self.error(place, format!("D1 is {d1}; it must not be negative"));
        }
        let rubber = Rubber { form, constants: numbers, d1, place };
        self.of_material(place, "HYPERELASTIC", |material| material.hyperelastic = Some(rubber));
    }

    /// `*DENSITY`.
    pub(crate) fn density(&mut self, block: &KeywordBlock) {
        if let Some(constants) = self.constants(block, &["the density"]) {
            self.of_material(block.place, "DENSITY", |material| material.density = Some(constants[0]));
        }
    }

    /// `*EXPANSION`.
    pub(crate) fn expansion(&mut self, block: &KeywordBlock) {
        if let Some(constants) = self.constants(block, &["the expansion"]) {
            self.of_material(block.place, "EXPANSION", |material| material.expansion = Some(constants[0]));
        }
    }

    /// `*SOLID SECTION`.
    pub(crate) fn solid_section(&mut self, block: &KeywordBlock) {
        let (Some(set), Some(name)) = (self.required(block, "ELSET"), self.required(block, "MATERIAL")) else { return };
        let Some(target) = self.members(block.place, set, Of::Elements) else { return };
        let known = &self.model.materials;
        let Some(material) = known.iter().position(|material| material.name.eq_ignore_ascii_case(name)) else {
            let near = suggestion(name, known.iter().map(|material| material.name.as_str()));
            return self.error(block.place, format!("there is no material '{name}'{near}"));
        };
        let thickness = match block.lines.first() {
            Some(line) if !line.field(0).is_empty() => {
                let Some(thickness) = self.positive(line, 0, "the thickness") else { return };
                Some(thickness)
            }
            _ => None,
        };
        let orientation = block.value("ORIENTATION").map(|name| self.full_name(name).to_ascii_uppercase());
        let (set, elements, place) = (self.full_name(set), target.members, block.place);
        let section = Section { set, elements, material, thickness, orientation, place };
        self.model.sections.push(section);
    }

    /// `*AMPLITUDE`.
    pub(crate) fn amplitude(&mut self, block: &KeywordBlock) {
        let Some(name) = self.required(block, "NAME") else { return };
        if self.first_line(block, "pairs of a time and a factor").is_none() {
            return;
        }
        let mut numbers = Vec::new();
        for line in &block.lines {
            for at in 0..line.fields().len() {
                let Some(number) = self.real(line, at, "a number of the amplitude") else { return };
                numbers.push(number);
            }
        }
        let (pairs, rest) = numbers.as_chunks::<2>();
        if !rest.is_empty() {
            return self.error(
                block.place,
                format!("amplitude '{name}' has {} numbers; it holds pairs of a time and a factor", numbers.len()),
            );
        }
        if let Some(two) = pairs.windows(2).find(|two| two[0][0] >= two[1][0]) {
            let what = format!("the times of amplitude '{name}' must rise, but {} follows {}", two[1][0], two[0][0]);
            return self.error(block.place, what);
        }
        let total = block.word("TIME").as_deref() == Some("TOTALTIME");
        let smooth = block.word("DEFINITION").as_deref() == Some("SMOOTHSTEP");
        let points = if smooth { smoothed(pairs) } else { pairs.to_vec() };
        let amplitude = Amplitude { points, total };
        self.model.amplitudes.push((name.to_ascii_uppercase(), amplitude));
    }
}

/// The 21 coefficients of an orthotropic stiffness from the nine that are not zero.
fn triangle(nine: &[f64]) -> Vec<f64> {
    let mut all = vec![0.0; 21];
    for (at, value) in [0, 1, 2, 3, 4, 5, 9, 14, 20].into_iter().zip(nine) {
        all[at] = *value;
    }
    all
}

/// Straight pieces of a smooth step between each two points: `a + (b - a) x^3 (10 - 15 x + 6 x^2)`.
fn smoothed(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    const PIECES: usize = 16;
    let between = |two: &[[f64; 2]]| {
        let ([t, a], [end, b]) = (two[0], two[1]);
        let at = move |piece: usize| {
            let x = piece as f64 / PIECES as f64;
            [t + (end - t) * x, a + (b - a) * x * x * x * (10.0 - 15.0 * x + 6.0 * x * x)]
        };
        (0..PIECES).map(at).collect::<Vec<_>>()
    };
    points.windows(2).flat_map(between).chain(points.last().copied()).collect()
}
