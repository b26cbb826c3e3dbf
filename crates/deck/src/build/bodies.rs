//! Bodies: every cell in just one.

use super::Builder;
use crate::diagnose::Diagnostic;
use crate::keys::{BodyKeys, ObjectiveRate, completed, integrated};
use crate::reader::Name;
use asperity_core::material::Material;
use asperity_core::mesh::Side;
use asperity_core::solid::{Body, BodyOptions, Heat, Strain, layers};
use std::sync::Arc;

/// No body yet.
pub(super) const NONE: usize = usize::MAX;

impl Builder<'_> {
    /// The bodies, each with the number of its material.
    pub(super) fn bodies(&mut self) -> Option<Vec<(Body, usize)>> {
        let materials = self.materials()?;
        let before = self.found.len();
        self.check_cells();
        self.check_temperatures();
        let deck = self.deck;
        let bodies: Vec<_> = deck
            .body
            .iter()
            .map(|(name, keys)| {
                let number = self.deck.material.iter().position(|(material, _)| material.text == keys.material.text)?;
                let cells = self.site.mesh.groups.get(&name.text)?.cells.clone();
                let options = BodyOptions {
                    formulation: *keys.formulation,
                    integration: *keys.integration,
                    strain: *keys.strain,
                    thickness: self.site.thickness,
                    held: self.held(&cells),
                    bonded: self.bonded(&cells),
                };
                let site = (self.site.mesh.clone(), self.site.dofs.clone(), self.site.space);
                // Nothing turns in small strain, and nothing is said against a rate that was not.
                let still = (*keys.strain == Strain::Small && keys.rate.is_none()).then_some(ObjectiveRate::Jaumann);
                let rate = keys.rate.map(|rate| rate.value).or(still);
                let material = materials[number].clone();
                let water = keys.pore_stiffness.map(|water| water.value);
                let material = completed(material, &keys.prony, keys.mullins.as_ref(), water);
                let said = keys.pore_stiffness.map(|water| water.place).or(keys.mullins.as_ref().map(|m| m.place));
                let material =
                    self.keep(material.map_err(asperity_core::Error::input), said.unwrap_or(keys.prony.place))?;
                let law = integrated(material.as_ref(), rate, keys.update.as_ref());
                let said = keys.update.as_ref().map(|update| update.place).or(keys.rate.map(|rate| rate.place));
                let place = said.unwrap_or(name.place);
                let law = self.keep(law.map_err(asperity_core::Error::input), place)?;
                let material = law.map_or(material, Arc::from);
                let material =
                    self.keep(keys.strain.law(material).map_err(asperity_core::Error::input), keys.strain.place)?;
                let body = Body::new(&name.text, site, cells, material, options);
                let body = self.keep(body, name.place)?;
                let body = self.along(body, keys)?;
                let body = self.heated(body, name, keys)?;
                Some((self.prestressed(body, name, keys)?, number))
            })
            .collect();
        bodies.into_iter().collect::<Option<Vec<_>>>().filter(|_| self.found.len() == before)
    }

    fn along(&mut self, body: Body, keys: &BodyKeys) -> Option<Body> {
        let Some(said) = &keys.axes else { return Some(body) };
        let Some(axes) = said.axes(self.site.mesh.origin) else {
            self.refuse("`along` is zero: the axis has no direction", said.along.place);
            return None;
        };
        self.keep(body.along(axes), said.place)
    }

    /// Where half of the surface of a body or more is held along all axes, glued or stuck, the cells through it from there. What is only held along
    /// its normal, as planes of symmetry are, is no surface.
    fn bonded(&self, cells: &[usize]) -> Option<f64> {
        let (mesh, mut held) = (&self.site.mesh, self.held_nodes());
        let stuck = self.deck.contact.iter().filter(|(_, contact)| contact.law.entry.name == "sticking");
        let stuck = stuck.flat_map(|(_, contact)| [&contact.surface, &contact.target]);
        for group in self.deck.tie.iter().flat_map(|tie| [&tie.surface, &tie.target]).chain(stuck) {
            self.nodes(&group.text).iter().for_each(|&node| held[node] = [true; 3]);
        }
        let axes = ..self.site.space.dimension();
        let whole = |side: Side| mesh.side(side).1.all(|node| held[node][axes].iter().all(|held| *held));
        let slides = |side: Side| mesh.faces(side).is_some_and(|axis| mesh.side(side).1.all(|node| held[node][axis]));
        let boundary = mesh.boundary(cells);
        let (bonded, others): (Vec<Side>, Vec<Side>) = boundary.iter().copied().partition(|&side| whole(side));
        let extent = |sides: &mut dyn Iterator<Item = &Side>| sides.map(|&side| mesh.extent(side)).sum::<f64>();
        let free = extent(&mut others.iter().filter(|&&side| !slides(side)));
        let half = !bonded.is_empty() && extent(&mut bonded.iter()) >= (1.0 - 1e-9) * free;
        half.then(|| layers(mesh, &bonded, &boundary))
    }

    /// Axes along which all sides of a body that face them are held from the first step to the end.
    fn held(&self, cells: &[usize]) -> [bool; 3] {
        let (mesh, held) = (&self.site.mesh, self.held_nodes());
        let mut all = [None; 3];
        for side in mesh.boundary(cells) {
            if let Some(axis) = mesh.faces(side) {
                let whole = mesh.side(side).1.all(|node| held[node][axis]);
                all[axis] = Some(all[axis].unwrap_or(true) && whole);
            }
        }
        all.map(|all| all == Some(true))
    }

    /// Axes along which each node is held from the first step to the end.
    fn held_nodes(&self) -> Vec<[bool; 3]> {
        let (mesh, mut held) = (&self.site.mesh, vec![[false; 3]; self.site.mesh.points.len()]);
        let stays = |kind: &str, name: &Name| self.deck.step.iter().all(|step| !step.releases(kind, &name.text));
        let Some(first) = self.deck.step.first() else { return held };
        for (name, keys) in first.displacement.iter().filter(|(name, _)| stays("displacement", name)) {
            let axes = [keys.x.is_some(), keys.y.is_some(), keys.z.is_some()];
            self.nodes(&name.text).iter().for_each(|&node| (0..3).for_each(|axis| held[node][axis] |= axes[axis]));
        }
        for group in
            first.symmetry.iter().filter(|name| stays("symmetry", name)).filter_map(|name| mesh.groups.get(&name.text))
        {
            for (side, axis) in group.sides.iter().filter_map(|&side| Some((side, mesh.faces(side)?))) {
                mesh.side(side).1.for_each(|node| held[node][axis] = true);
            }
        }
        held
    }

    fn prestressed(&mut self, body: Body, name: &Name, keys: &BodyKeys) -> Option<Body> {
        let Some(stress) = &keys.initial_stress else { return Some(body) };
        if let Some(shear) = stress.across_the_plane().filter(|_| self.plane()) {
            self.refuse(
                format!("`body.{name}.initial_stress` has a shear across the plane of a plane model"),
                shear.place,
            );
            return None;
        }
        self.keep(body.prestressed(stress.field(self.site.mesh.origin[1])), name.place)
    }

    /// The body with its temperature, which needs an expansion and a step that says it.
    fn heated(&mut self, body: Body, name: &Name, keys: &BodyKeys) -> Option<Body> {
        let temperature = self.temperature(&name.text);
        let said = self.deck.step.iter().flat_map(|step| &step.temperature).find(|(other, _)| other.text == name.text);
        match (&keys.expansion, temperature, said) {
            (None, _, None) => Some(body),
            (Some(expansion), Some(temperature), _) => {
                Some(body.heated(Heat { expansion: expansion.value, temperature }))
            }
            (Some(expansion), None, _) => {
                self.refuse(
                    format!(
                        "`body.{name}.expansion` has no use: no step says `temperature.{name}` or that of its nodes"
                    ),
                    expansion.place,
                );
                None
            }
            (None, _, Some((at, _))) => {
                let what =
                    format!("`temperature.{name}` has no use: the body `{name}` has no `expansion` (which may be 0)");
                self.refuse(what, at.place);
                None
            }
        }
    }

    fn materials(&mut self) -> Option<Vec<Arc<dyn Material>>> {
        let (deck, plane) = (self.deck, self.plane());
        let mut materials = Vec::new();
        for (name, law) in &deck.material {
            let built = law.build(&name.text, self.folder, plane).map_err(asperity_core::Error::input);
            let built = self.keep(built, law.place());
            materials.push(built.map(|(material, library)| {
                self.files.extend(library);
                material
            }));
        }
        materials.into_iter().collect()
    }

    /// No cell may lie in two bodies, none in no body.
    fn check_cells(&mut self) {
        let mesh = self.site.mesh.clone();
        let mut owner = vec![NONE; mesh.cell_count()];
        for (number, (name, _)) in self.deck.body.iter().enumerate() {
            let cells = mesh.groups.get(&name.text).map_or(&[][..], |group| &group.cells);
            if let Some(&twice) = cells.iter().find(|&&cell| owner[cell] != NONE) {
                let other = &self.deck.body[owner[twice]].0;
                let what = format!("cell {} lies in the bodies `{other}` and `{name}`", mesh.cell_number(twice));
                self.found.push(Diagnostic::error(what).at(name.place).help("a cell belongs to one body"));
            }
            cells.iter().for_each(|&cell| owner[cell] = number);
        }
        let lost: Vec<usize> = (0..owner.len()).filter(|&cell| owner[cell] == NONE).collect();
        if let (Some(&first), Some((name, _))) = (lost.first(), self.deck.body.last()) {
            let group = mesh.groups.iter().find(|(_, group)| group.cells.binary_search(&first).is_ok());
            let of = group.map_or(String::new(), |(name, _)| format!(" of the group `{name}`"));
            let cell = mesh.cell_number(first);
            let others = if lost.len() > 1 { format!(", and {} more", lost.len() - 1) } else { String::new() };
            let what = format!("cell {cell}{of} belongs to no body{others}");
            self.found.push(
                Diagnostic::error(what).at(name.place).help("make a body of them, or leave them out of the mesh"),
            );
        }
    }
}
