//! Parts and instances: which blocks are read how often, and where the nodes of an instance lie.

use super::Reader;
use crate::message::suggestion;
use crate::model::Scope;
use crate::source::KeywordBlock;
use std::collections::BTreeMap;

impl Reader {
    /// All blocks with the instance that each belongs to: those of a part once for each of its instances.
    pub(super) fn lay_out<'b>(&mut self, blocks: &'b [KeywordBlock]) -> Vec<(usize, &'b KeywordBlock)> {
        self.model.scopes = vec![Scope::default()];
        let mut parts: BTreeMap<String, Vec<&KeywordBlock>> = BTreeMap::new();
        let (mut part, mut instance): (Option<String>, Option<usize>) = (None, None);
        let (mut laid_out, mut used) = (Vec::new(), Vec::new());
        for block in blocks {
            match block.name.as_str() {
                "PART" => {
                    self.known(block);
                    let name = self.required(block, "NAME").unwrap_or_default().to_ascii_uppercase();
                    if parts.insert(name.clone(), vec![]).is_some() {
                        self.error(block.place, format!("part '{name}' is there twice; give each its own name"));
                    }
                    part = Some(name);
                }
                "END PART" => {
                    self.known(block);
                    part = None;
                }
                "INSTANCE" => {
                    self.known(block);
                    instance = self.open_instance(block);
                    let name = self.required(block, "PART").unwrap_or_default().to_ascii_uppercase();
                    match (parts.get(&name), instance) {
                        (Some(blocks), Some(scope)) => {
                            laid_out.extend(blocks.iter().map(|block| (scope, *block)));
                            used.push(name);
                        }
                        (None, _) if !name.is_empty() => {
                            let near = suggestion(&name, parts.keys().map(String::as_str));
                            self.error(block.place, format!("there is no part '{name}'{near}"));
                        }
                        _ => {}
                    }
                }
                "END INSTANCE" => {
                    self.known(block);
                    instance = None;
                }
                "ASSEMBLY" | "END ASSEMBLY" => {
                    self.known(block);
                }
                _ => match (&part, instance) {
                    (Some(part), _) => parts.entry(part.clone()).or_default().push(block),
                    (None, Some(scope)) => laid_out.push((scope, block)),
                    (None, None) => laid_out.push((0, block)),
                },
            }
            if block.name != "NODE" && block.name != "ELEMENT" && !is_structure(&block.name) {
                self.known(block);
            }
        }
        if let Some(last) = blocks.last().filter(|_| part.is_some() || instance.is_some()) {
            let (what, end) = if part.is_some() { ("part", "*END PART") } else { ("instance", "*END INSTANCE") };
            self.error(last.place, format!("the deck ends within a {what}; end it with {end}"));
        }
        for (name, blocks) in parts.iter().filter(|(name, _)| !used.contains(name)) {
            if let Some(first) = blocks.first() {
                self.note(first.place, format!("part '{name}' has no instance and is left out"));
            }
        }
        laid_out
    }

    /// A new instance, placed as its data lines say.
    fn open_instance(&mut self, block: &KeywordBlock) -> Option<usize> {
        let name = self.required(block, "NAME")?.to_string();
        if self.model.scopes.iter().any(|scope| scope.name.eq_ignore_ascii_case(&name)) {
            self.error(block.place, format!("instance '{name}' is there twice; give each its own name"));
            return None;
        }
        let mut scope = Scope { name, ..Scope::default() };
        if let Some(line) = block.lines.first() {
            for axis in 0..3 {
                scope.translation[axis] = self.real_or(line, axis, "a shift of the instance", 0.0)?;
            }
        }
        if let Some(line) = block.lines.get(1) {
            let mut given = [0.0; 7];
            for (at, value) in given.iter_mut().enumerate() {
                *value = self.real(line, at, "a number of the turn (two points of its axis, then degrees)")?;
            }
            let [a, b, c, d, e, f, degrees] = given;
            let axis = [d - a, e - b, f - c];
            let length = axis.iter().fold(0.0_f64, |length, x| length.hypot(*x));
            if length <= 0.0 {
                self.error(line.place, "the two points of the axis of the turn are one; give two");
                return None;
            }
            scope.rotation = Some(([a, b, c], axis.map(|x| x / length), degrees.to_radians()));
        }
        self.model.scopes.push(scope);
        Some(self.model.scopes.len() - 1)
    }

    /// Where a point of the present instance lies in the assembly.
    pub(super) fn placed(&self, x: [f64; 3]) -> [f64; 3] {
        self.model.scopes.get(self.scope).map_or(x, |scope| scope.placed(x))
    }
}

fn is_structure(name: &str) -> bool {
    matches!(name, "PART" | "END PART" | "INSTANCE" | "END INSTANCE" | "ASSEMBLY" | "END ASSEMBLY" | "INCLUDE")
}

impl Scope {
    /// Shifted, then turned about the axis.
    pub fn placed(&self, x: [f64; 3]) -> [f64; 3] {
        let x: [f64; 3] = std::array::from_fn(|i| x[i] + self.translation[i]);
        match self.rotation {
            None => x,
            Some((point, axis, angle)) => {
                let turned = turned(std::array::from_fn(|i| x[i] - point[i]), axis, angle);
                std::array::from_fn(|i| point[i] + turned[i])
            }
        }
    }
}

/// A vector turned about a unit vector (Rodrigues).
fn turned(v: [f64; 3], axis: [f64; 3], angle: f64) -> [f64; 3] {
    let (sin, cos) = angle.sin_cos();
    let along: f64 = (0..3).map(|i| axis[i] * v[i]).sum();
    let across = [axis[1] * v[2] - axis[2] * v[1], axis[2] * v[0] - axis[0] * v[2], axis[0] * v[1] - axis[1] * v[0]];
    std::array::from_fn(|i| cos * v[i] + sin * across[i] + (1.0 - cos) * along * axis[i])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_instance_is_shifted_and_then_turned() {
        let quarter = std::f64::consts::FRAC_PI_2;
        let scope = Scope {
            translation: [1.0, 0.0, 0.0],
            rotation: Some(([1.0, 0.0, 0.0], [0.0, 0.0, 1.0], quarter)),
            ..Scope::default()
        };
        let x = scope.placed([2.0, 0.0, 5.0]);
        let off = [x[0] - 1.0, x[1] - 2.0, x[2] - 5.0];
        assert!(off.iter().all(|off| off.abs() < 1e-15), "{x:?}");
    }
}
