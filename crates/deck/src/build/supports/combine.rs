//! From claims to constraints: single unknowns first, then directions, each of which becomes a combination of what is
//! left free at its node. Two claims on one unknown must agree.

use super::Builder;
use super::claim::{Claim, Known, What};
use super::equations::{Equation, Fixed, Relation, Relations};
use crate::diagnose::Diagnostic;
use crate::reader::Name;
use asperity_core::mesh::ROUNDING;
use asperity_core::solve::{Course, Prescribed};
use asperity_core::system::Constraints;
use std::collections::{BTreeMap, BTreeSet};

/// Claims sorted by the unknown that each takes.
#[derive(Default)]
struct Sorted<'c> {
    /// Single unknowns.
    fixed: BTreeMap<usize, &'c Claim>,
    /// Unknowns that follow from others at their node.
    combined: BTreeMap<usize, (Combination, &'c Claim)>,
    /// Pairs of claims that do not agree, and where.
    quarrels: Vec<(usize, &'c Claim, &'c Claim)>,
}

/// A direction of a node: the component along `axis` follows from the others.
struct Combination {
    first: usize,
    normal: [f64; 3],
    axis: usize,
    course: Course,
}

impl Builder<'_> {
    /// Constraints and prescribed values from all claims of a step, the equations and the ties that hold in it; `known` are the
    /// values at its end.
    pub(super) fn constrain(
        &mut self,
        (claims, known): (&[&Claim], &Known),
        equations: &[Equation],
        ties: &[usize],
    ) -> (Constraints, Vec<Prescribed>) {
        let mut sorted = Sorted::default();
        // A node of no cell is held, but not where an equation or a rigid group says what it does.
        let mut related: BTreeSet<usize> = equations.iter().flat_map(|e| e.terms.iter().map(|term| term.0)).collect();
        let unknowns = |node: usize| self.site.dofs.node(node)..self.site.dofs.node(node) + self.site.dofs.per_node();
        let groups = self.rigid_nodes();
        related.extend(groups.keys().flat_map(|&node| unknowns(node)));
        let stands = |claim: &&&Claim| claim.course == Course::Hold;
        let still: BTreeSet<usize> = claims.iter().filter(stands).filter_map(|claim| claim.single()).collect();
        let goes_with_group = |claim: &&&Claim| self.goes_with_group(claim, &groups, &still);
        let claims: Vec<&Claim> = claims.iter().filter(|claim| !goes_with_group(claim)).copied().collect();
        let held = |claim: &Claim, dof: &usize| !(claim.is_weak() && related.contains(dof));
        for claim in &claims {
            if let Some(dof) = claim.single().filter(|dof| held(claim, dof)) {
                sorted.fix(dof, claim);
            }
        }
        for claim in &claims {
            if let (None, What::Direction(first, normal)) = (claim.single(), &claim.what) {
                sorted.combine(*first, self.site.dofs.per_node(), normal, claim);
            }
        }
        for (dof, one, other) in &sorted.quarrels {
            self.quarrel(*dof, one, other);
        }
        let end = |dof: usize, course: &Course| match course {
            Course::Hold => known.at(dof),
            Course::To(end, _) => Some(*end),
        };
        let fixed: Fixed =
            sorted.fixed.iter().map(|(&dof, claim)| (dof, (&claim.course, end(dof, &claim.course)))).collect();
        let mut relations = Relations::of(sorted.relations(), &fixed, equations);
        for glued in ties.iter().map(|&tie| &self.ties[tie]) {
            (0..self.site.dofs.per_node()).for_each(|axis| relations.tie(glued, (&self.site.dofs, axis), &fixed));
        }
        for (what, place) in &relations.refused {
            // The same for each of its nodes and in each step is told once.
            if !self.found.iter().any(|d| d.what == *what && d.place == Some(*place)) {
                self.refuse(what, *place);
            }
        }
        let rigid = self.rigid_unknowns(&sorted, equations);
        sorted.constraints(self.site.dofs.count(), &relations, &rigid)
    }

    /// Whether a claim holds a node of a rigid group along what all of that stands still along, as a plane of symmetry through it does.
    fn goes_with_group(&self, claim: &Claim, groups: &BTreeMap<usize, &Name>, still: &BTreeSet<usize>) -> bool {
        let (dofs, axes) = (&self.site.dofs, self.site.dofs.per_node());
        let (first, normal) = match claim.what {
            What::Unknown(dof) => {
                let first = dofs.first_of_owner(dof);
                (first, std::array::from_fn(|axis| f64::from(u8::from(dof == first + axis))))
            }
            What::Direction(first, normal) => (first, normal),
        };
        let group = groups.get(&(first / axes)).filter(|_| first < dofs.tool(0) && claim.course == Course::Hold);
        let Some(tool) = group.and_then(|name| self.leader(&name.text)) else { return false };
        // Along what of the point may the node move: what turns it about the normal does not.
        let moves = |unknown: usize| match unknown.checked_sub(axes) {
            None => normal[unknown].abs() > ROUNDING,
            Some(axis) => axes == 2 || 1.0 - normal[axis].abs() > ROUNDING * ROUNDING,
        };
        (0..dofs.per_tool())
            .filter(|&unknown| moves(unknown))
            .all(|unknown| still.contains(&(dofs.tool(tool) + unknown)))
    }

    /// Unknowns of nodes of rigid groups, which nothing else may hold or relate.
    fn rigid_unknowns(&mut self, sorted: &Sorted, equations: &[Equation]) -> Vec<usize> {
        let (dofs, mut found) = (&self.site.dofs, BTreeMap::new());
        let nodes: BTreeMap<usize, String> =
            self.rigid_nodes().into_iter().map(|(node, name)| (node, name.text.clone())).collect();
        if nodes.is_empty() {
            return Vec::new();
        }
        let group = |dof: usize| nodes.get(&(dof / dofs.per_node())).filter(|_| dof < dofs.node(dofs.nodes()));
        let claims = sorted.fixed.iter().map(|(&dof, claim)| (dof, *claim));
        let directions = sorted.combined.iter().map(|(&dof, (_, claim))| (dof, *claim));
        for (dof, claim) in claims.chain(directions).filter(|(_, claim)| !claim.is_weak()) {
            if let Some(name) = group(dof) {
                found.insert((claim.by.clone(), name.clone()), (format!("`{}`", claim.by), claim.place));
            }
        }
        for equation in equations {
            if let Some(name) = equation.terms.iter().find_map(|term| group(term.0)) {
                found.insert((equation.by.into(), name.clone()), ("an equation".into(), equation.place));
            }
        }
        for glued in &self.ties {
            if let Some(name) = glued.tie.nodes.iter().flatten().find_map(|node| nodes.get(node)) {
                found.insert(("tie".into(), name.clone()), ("a tie".into(), glued.place));
            }
        }
        let unknowns = nodes.keys().flat_map(|&node| dofs.node(node)..dofs.node(node) + dofs.per_node()).collect();
        for ((_, name), (what, place)) in found {
            let what = format!("{what} holds nodes of `rigid.{name}`, which follow its reference point");
            if self.found.iter().any(|d| d.what == what) {
                continue;
            }
            let help = format!(
                "hold all of the group along it, its rotation too, by `motion.{name}`, or let the groups have no node in common"
            );
            self.found.push(Diagnostic::error(what).at(place).help(help));
        }
        unknowns
    }

    /// Reports two claims that do not agree; the same two once, at however many nodes.
    fn quarrel(&mut self, dof: usize, one: &Claim, other: &Claim) {
        let pair = format!("cannot follow both `{}` and `{}`", one.by, other.by);
        if self.found.iter().any(|d| d.place == Some(other.place) && d.what.ends_with(&pair)) {
            return;
        }
        let node = self.site.mesh.node_number(dof / self.site.dofs.per_node());
        let help = "let the groups have no node in common, or release the older condition";
        self.found.push(Diagnostic::error(format!("node {node} {pair}")).at(other.place).help(help));
    }
}

impl<'c> Sorted<'c> {
    fn fix(&mut self, dof: usize, claim: &'c Claim) {
        match self.fixed.get(&dof) {
            Some(other) if !other.is_weak() && other.course != claim.course => {
                self.quarrels.push((dof, other, claim));
            }
            Some(other) if !other.is_weak() => {}
            _ => {
                self.fixed.insert(dof, claim);
            }
        }
    }

    /// Lets the free component with the largest share of a direction follow from the others.
    fn combine(&mut self, first: usize, axes: usize, normal: &[f64; 3], claim: &'c Claim) {
        let taken = (0..axes).find_map(|axis| self.combined.get(&(first + axis)));
        if let Some((other, by)) = taken {
            if other.normal != *normal || other.course != claim.course {
                self.quarrels.push((first, by, claim));
            }
            return;
        }
        let free = |axis: &usize| !self.fixed.contains_key(&(first + axis)) && normal[*axis].abs() > ROUNDING;
        let share = |a: &usize, b: &usize| normal[*a].abs().total_cmp(&normal[*b].abs()).then(b.cmp(a));
        match (0..axes).filter(free).max_by(share) {
            Some(axis) => {
                let combination = Combination { first, normal: *normal, axis, course: claim.course.clone() };
                self.combined.insert(first + axis, (combination, claim));
            }
            None => self.stand_still(first, axes, claim),
        }
    }

    /// A direction of a node that other claims take whole: it agrees only if nothing moves.
    fn stand_still(&mut self, first: usize, axes: usize, claim: &'c Claim) {
        let mut others = (first..first + axes).filter_map(|dof| self.fixed.get(&dof));
        let moves = |course: &Course| *course != Course::Hold;
        let against = if moves(&claim.course) { others.next() } else { others.find(|other| moves(&other.course)) };
        if let Some(other) = against {
            self.quarrels.push((first, other, claim));
        }
    }

    /// The directions as relations between unknowns.
    fn relations(&self) -> BTreeMap<usize, Relation> {
        let relation = |(&dof, (c, _)): (&usize, &(Combination, &Claim))| {
            (dof, Relation { others: c.others(), course: c.course.scaled(c.scale()), equation: false })
        };
        self.combined.iter().map(relation).collect()
    }

    fn constraints(&self, count: usize, relations: &Relations, rigid: &[usize]) -> (Constraints, Vec<Prescribed>) {
        let list = &relations.list;
        let rows: Vec<_> = list.iter().map(|(&dof, relation)| (dof, relation.others.clone())).collect();
        let simple = self.fixed.iter().map(|(&dof, claim)| (dof, vec![], claim.course.clone()));
        let related = list.iter().map(|(&dof, relation)| (dof, relation.others.clone(), relation.course.clone()));
        let prescribed = simple.chain(related).map(|(dof, others, course)| Prescribed { dof, others, course });
        let fixed: Vec<usize> = self.fixed.keys().chain(rigid).copied().collect();
        let tied = list.iter().filter(|(_, relation)| relation.equation);
        let tied = tied.map(|(&dof, relation)| (dof, relation.others.clone())).collect();
        (Constraints::new(count, &fixed, &rows).tied(tied), prescribed.collect())
    }
}

impl Combination {
    fn scale(&self) -> f64 {
        1.0 / self.normal[self.axis]
    }
    /// The other unknowns with their factors.
    fn others(&self) -> Vec<(usize, f64)> {
        let rest = (0..3).filter(|&axis| axis != self.axis && self.normal[axis].abs() > ROUNDING);
        rest.map(|axis| (self.first + axis, -self.normal[axis] * self.scale())).collect()
    }
}
