//! Contacts: surface, target, passes, law, penalties.

use super::Builder;
use super::friction::integrated;
use crate::diagnose::Diagnostic;
use crate::keys::{self, Passes};
use crate::reader::Name;
use asperity_core::contact::field::{FieldSurface, FieldTarget};
use asperity_core::contact::{
    Backing, ContactOptions, ContactParts, DefaultPenalty, LoadedSides, PaperContact, TWO_PASSES, default_penalty,
    second_name,
};
use asperity_core::interface::{Closure, Rule};
use asperity_core::mesh::{Mesh, Side};
use asperity_core::model::{self, ELASTIC_SLIP};
use asperity_core::solid::Body;
use asperity_core::system::Dofs;
use asperity_core::tool::{self, ProfileTool};
use std::sync::Arc;

/// Which edges a contact joins.
#[derive(Clone, Copy)]
pub(super) enum Opposite<'a> {
    Tool(usize),
    Sides(&'a [Side]),
}

/// The tools of a model, those of the plane or those of space.
#[derive(Clone, Copy)]
pub(super) struct Tools<'a> {
    pub plane: &'a [Arc<ProfileTool>],
    pub solid: &'a [Arc<tool::space::SpaceTool>],
}

impl Tools<'_> {
    /// A tool as what a contact may touch.
    pub(super) fn target(&self, number: usize, dofs: &Dofs) -> Option<FieldTarget> {
        model::tool_target((self.plane, self.solid), number, dofs)
    }
}

/// Multiple of the computed penalty beyond which a matrix in double precision holds next to nothing of the cells.
const LARGEST_PENALTY: f64 = 1e12;

impl Builder<'_> {
    /// The contacts of Gauss points, those of the second of two passes right behind those of the first.
    pub(super) fn paper_contacts(&mut self, tools: Tools, bodies: &[(Body, usize)]) -> Option<Vec<PaperContact>> {
        let backings = backings(&self.site.mesh, self.deck, bodies.iter().map(|(body, _)| body));
        let deck = self.deck;
        self.check_doubles();
        let of_points: Vec<_> = deck.contact.iter().filter(|(_, keys)| !self.is_field(keys)).collect();
        let contacts: Vec<_> =
            of_points.into_iter().map(|(name, keys)| self.paper_contact(name, keys, tools, &backings)).collect();
        Some(contacts.into_iter().collect::<Option<Vec<_>>>()?.into_iter().flatten().collect())
    }

    /// The law of a contact, integrated as said.
    pub(super) fn interface(&mut self, name: &Name, keys: &keys::Contact) -> Option<Rule> {
        let law = keys.law.build().map_err(asperity_core::Error::input);
        let law = self.keep(law, keys.law.place)?;
        let update = keys.update.as_ref().map(|update| update.update());
        let place = keys.update.as_ref().map_or(keys.law.place, |update| update.place);
        let place = keys.closure.as_ref().map_or(place, |closure| closure.place);
        let closure = self.keep(closure(keys).map_err(asperity_core::Error::input), place)?.map(Arc::new);
        let first = self.keep(
            integrated(law, update, (closure.as_ref(), keys.recession())).map_err(asperity_core::Error::input),
            place,
        )?;
        self.running(name, keys, (first, closure))
    }

    pub(super) fn opposite<'m>(&self, keys: &keys::Contact, mesh: &'m Mesh) -> Option<Opposite<'m>> {
        let tool = self.deck.tool.iter().position(|(tool, _)| tool.text == keys.target.text);
        tool.map(Opposite::Tool).or_else(|| Some(Opposite::Sides(mesh.groups.get(&keys.target.text)?.sides.as_slice())))
    }

    /// No two sides may touch by two contacts: they would do so twice as hard.
    pub(super) fn check_doubles(&mut self) {
        let mesh = self.site.mesh.clone();
        let sides = |name: &Name| mesh.groups.get(&name.text).map_or(&[][..], |group| &group.sides);
        let share = |one: &[Side], other: &[Side]| one.iter().any(|side| other.contains(side));
        let same = |one: &Name, other: &Name| one.text == other.text || share(sides(one), sides(other));
        let mut found = Vec::new();
        for (i, (name, keys)) in self.deck.contact.iter().enumerate() {
            let twice = |other: &keys::Contact| {
                (same(&other.surface, &keys.surface) && same(&other.target, &keys.target))
                    || (share(sides(&other.surface), sides(&keys.target))
                        && share(sides(&other.target), sides(&keys.surface)))
            };
            for (other, _) in self.deck.contact[..i].iter().filter(|(_, other)| twice(other)) {
                let what = format!("the contacts `{other}` and `{name}` let the same sides touch `{}`", keys.target);
                found.push(Diagnostic::error(what).at(keys.surface.place).help("keep one of the two"));
            }
        }
        self.found.append(&mut found);
    }

    fn paper_contact(
        &mut self,
        name: &Name,
        keys: &keys::Contact,
        tools: Tools,
        backings: &[Backing],
    ) -> Option<Vec<PaperContact>> {
        let law = self.interface(name, keys)?;
        let (mesh, dofs, space) = (self.site.mesh.clone(), self.site.dofs.clone(), self.site.space);
        let surface = mesh.groups.get(&keys.surface.text)?.sides.as_slice();
        let opposite = self.opposite(keys, &mesh)?;
        let computed = self.computed_penalty(keys, (surface, opposite), backings);
        let options = self.options(keys, (surface, opposite), computed);
        self.check_penalties(name, keys, computed.value);
        self.check_elastic_slip(keys, &options);
        if !self.check_passes(name, keys, (surface, opposite)) || !self.check_points(keys) {
            return None;
        }
        let thickness = self.site.thickness;
        let order = keys.gauss.map(|gauss| gauss.value);
        let build = |name: &str, sides: &[Side], target: FieldTarget| {
            let parts = ContactParts {
                name: name.into(),
                surface: FieldSurface::whole(&mesh, sides, space, thickness),
                boundary: boundary_behind(&mesh, sides, &self.deck.body),
                target,
                law: law.clone(),
                options,
                space,
                dofs: dofs.clone(),
                mesh: mesh.clone(),
            };
            PaperContact::new(parts, order)
        };
        let faces = |sides: &[Side]| FieldTarget::faces(FieldSurface::whole(&mesh, sides, space, thickness), &mesh);
        Some(match opposite {
            Opposite::Tool(number) => vec![build(&name.text, surface, tools.target(number, &dofs)?)],
            Opposite::Sides(sides) => {
                let second =
                    is_double(&options, surface, sides).then(|| build(&second_name(&name.text), sides, faces(surface)));
                std::iter::once(build(&name.text, surface, faces(sides))).chain(second).collect()
            }
        })
    }

    /// What is said of a field says nothing of Gauss points.
    fn check_points(&mut self, keys: &keys::Contact) -> bool {
        let what = "`augmentation` is for a field of contact stress: form = \"field\", without what only points have";
        if let Some(keys) = &keys.augmentation {
            self.refuse(what, keys.place);
        }
        keys.augmentation.is_none()
    }

    pub(super) fn options(
        &self,
        keys: &keys::Contact,
        (surface, opposite): (&[Side], Opposite),
        computed: DefaultPenalty,
    ) -> ContactOptions {
        let loads = self.carried(keys, (surface, opposite));
        let steepest = closure(keys).ok().flatten().map(|closure| closure.steepest());
        let given = keys.penalty.or(steepest);
        let penalty = given.unwrap_or(computed.value);
        ContactOptions {
            penalty,
            modulus: computed.modulus,
            raised: given.is_none().then_some(computed.raised),
            tangential_penalty: keys.tangential_penalty.unwrap_or(penalty),
            elastic_slip: self.elastic_slip(keys),
            thickness: self.site.thickness,
            loads,
            coupling: keys.coupling.is_none_or(|coupling| coupling.value),
            augmentation: keys.augmentation.as_ref().map(|spot| spot.value.augmentation()),
            overlap: keys.overlap.value.overlap(self.deck.step.first().map_or(1.0, |step| step.duration)),
            wear: keys.wear.as_ref().map(|wear| wear.coefficient),
        }
    }

    /// Where the tangential penalty of a field is not said it follows from an elastic slip. Multipliers take elastic slip out by
    /// themselves.
    fn elastic_slip(&self, keys: &keys::Contact) -> Option<f64> {
        let slides = keys.law.build().is_ok_and(|law| law.sliding_stress(1.0).is_some());
        let follows = self.is_field(keys) && keys.tangential_penalty.is_none() && keys.augmentation.is_none();
        (slides && follows).then(|| keys.elastic_slip.map_or(ELASTIC_SLIP, |part| part.value))
    }

    /// An elastic slip that nothing would follow must not be said.
    pub(super) fn check_elastic_slip(&mut self, keys: &keys::Contact, options: &ContactOptions) {
        if let Some(part) = keys.elastic_slip.filter(|_| options.elastic_slip.is_none()) {
            let what = "`elastic_slip` is for friction by the pressure in a field, without augmentation and `tangential_penalty`";
            self.refuse(what, part.place);
        }
    }

    /// The penalty that holds where a deck gives none.
    pub(super) fn computed_penalty(
        &self,
        keys: &keys::Contact,
        (surface, opposite): (&[Side], Opposite),
        backings: &[Backing],
    ) -> DefaultPenalty {
        let surfaces = match opposite {
            Opposite::Sides(others) => vec![surface, others],
            Opposite::Tool(_) => vec![surface],
        };
        let part = if self.carried(keys, (surface, opposite)) == LoadedSides::Own { TWO_PASSES } else { 1.0 };
        let whole = default_penalty((&*self.site.mesh, self.site.space), &surfaces, |cell| backings[cell]);
        DefaultPenalty { value: part * whole.value, ..whole }
    }

    /// A penalty must leave the equations some digits of the stiffness of the cells.
    pub(super) fn check_penalties(&mut self, name: &Name, keys: &keys::Contact, computed: f64) {
        for (key, penalty) in [("penalty", keys.penalty), ("tangential_penalty", keys.tangential_penalty)] {
            if let Some(penalty) = penalty.filter(|penalty| *penalty > LARGEST_PENALTY * computed) {
                let what = format!(
                    "`contact.{name}.{key}` of {penalty:.1e} is more than {LARGEST_PENALTY:.0e} times the computed one, \
                     {computed:.4e}"
                );
                let help = "beside it rounding hides the stiffness of the cells; leave it out, or stay below a thousand times that";
                self.found.push(Diagnostic::error(what).at(name.place).help(help));
            }
        }
    }

    /// One pass or two: two between sides of second degree, one where a side is of first degree and would be felt as the
    /// facets into which contact bends it. A surface that touches itself carries the points of both sides anyhow.
    fn carried(&self, keys: &keys::Contact, (surface, opposite): (&[Side], Opposite)) -> LoadedSides {
        let Opposite::Sides(others) = opposite else { return LoadedSides::Both };
        if self.is_field(keys) {
            return LoadedSides::Both;
        }
        let passes = keys.passes.map_or(Passes::Auto, |passes| passes.value);
        let smooth = |sides: &[Side]| sides.iter().all(|side| self.site.mesh.side(*side).0.degree > 1);
        let two = match passes {
            Passes::One => false,
            Passes::Two => true,
            Passes::Auto if same_sides(surface, others) => true,
            Passes::Auto => smooth(surface) && smooth(others),
        };
        if two { LoadedSides::Own } else { LoadedSides::Both }
    }

    /// What is said of two bodies must be of use.
    pub(super) fn check_passes(
        &mut self,
        name: &Name,
        keys: &keys::Contact,
        (surface, opposite): (&[Side], Opposite),
    ) -> bool {
        let before = self.found.len();
        let rigid = matches!(opposite, Opposite::Tool(_));
        let local = keys.law.build().is_ok_and(|law| law.radius() == 0.0);
        if !local && !rigid {
            self.refuse("a mean of the pressure is for contact with a tool", keys.law.place);
        }
        let Opposite::Sides(others) = opposite else {
            let said =
                [keys.passes.map(|spot| ("passes", spot.place)), keys.coupling.map(|spot| ("coupling", spot.place))];
            for (key, place) in said.into_iter().flatten() {
                self.refuse(format!("`{key}` is for the contact of two bodies; `{}` is a tool", keys.target), place);
            }
            return self.found.len() == before;
        };
        let second = second_name(&name.text);
        if self.deck.contact.iter().any(|(other, _)| other.text == second) {
            self.refuse(format!("`{second}` is what the second side of `{name}` is called"), name.place);
        }
        let shared = surface.iter().any(|side| others.contains(side));
        if shared && !same_sides(surface, others) {
            let what = format!("`{}` and `{}` share some of their sides", keys.surface, keys.target);
            let help = "for self-contact name one group in both places; else name groups without common sides";
            self.found.push(Diagnostic::error(what).at(keys.target.place).help(help));
        }
        if let Some(passes) = keys.passes.filter(|passes| shared && passes.value == Passes::One) {
            self.refuse(
                "a surface that touches itself carries the points of both sides: that is two passes",
                passes.place,
            );
        }
        let perturbed = self.deck.solver.tangent == keys::TangentWord::Perturbation;
        if let Some(coupling) = keys.coupling.filter(|coupling| perturbed && !coupling.value) {
            self.refuse(
                "a perturbed tangent holds the coupling: `coupling = false` needs tangent = \"exact\"",
                coupling.place,
            );
        }
        self.found.len() == before
    }
}

/// Whether the target of a contact carries points of its own, in a second pass.
pub(super) fn is_double(options: &ContactOptions, surface: &[Side], target: &[Side]) -> bool {
    options.loads == LoadedSides::Own && !same_sides(surface, target)
}

/// Whether two lists hold the same sides; those of a group are sorted.
/// The table of pressure over penetration that a contact has.
fn closure(keys: &keys::Contact) -> Result<Option<Closure>, String> {
    let rows = keys.closure.as_ref().map(|rows| rows.iter().map(|row| [row[0], row[1]]).collect());
    rows.map(Closure::new).transpose()
}

fn same_sides(one: &[Side], other: &[Side]) -> bool {
    one == other
}

/// What stands behind the faces of each cell, with what the first step holds.
pub(crate) fn backings<'b>(mesh: &Mesh, deck: &keys::Deck, bodies: impl IntoIterator<Item = &'b Body>) -> Vec<Backing> {
    let first = || deck.step.first().into_iter();
    let given = |(name, keys): &'_ (Name, keys::Displacement)| {
        (name.text.clone(), [keys.x.is_some(), keys.y.is_some(), keys.z.is_some()])
    };
    let given = first().flat_map(|step| &step.displacement).map(given);
    let mirrored = first().flat_map(|step| &step.symmetry).map(|name| (name.text.clone(), [true; 3]));
    model::backings(mesh, given.chain(mirrored), bodies)
}

/// The whole outer boundary of what hangs together with the cells behind the sides, in whatever groups.
pub(super) fn boundary_behind(mesh: &Mesh, sides: &[Side], bodies: &[(Name, keys::BodyKeys)]) -> Vec<Side> {
    let groups = bodies.iter().filter_map(|(name, _)| mesh.groups.get(&name.text));
    model::boundary_behind(mesh, sides, groups.flat_map(|group| group.cells.iter().copied()))
}
