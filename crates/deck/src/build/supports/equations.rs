//! Linear equations between unknowns, solved for one unknown each, so that what follows depends on free and prescribed
//! unknowns only.

use super::Builder;
use crate::diagnose::Diagnostic;
use crate::source::Place;
use asperity_core::solve::Course;
use std::collections::BTreeMap;

/// A factor below this part of the largest of its equation is rounding.
const ROUNDING: f64 = 1e-12;

/// A sum of unknowns with factors that is zero.
pub struct Equation {
    /// Unknowns and factors.
    pub terms: Vec<(usize, f64)>,
    /// Where the deck says it,
    pub place: Place,
    /// and by which key.
    pub by: &'static str,
}

/// Prescribed unknowns: the course of each, and where it leads or holds it, if that is known.
pub type Fixed<'c> = BTreeMap<usize, (&'c Course, Option<f64>)>;

/// What an unknown follows: a combination of others, plus a course.
#[derive(Debug, Clone)]
pub struct Relation {
    /// Other unknowns with their coefficients.
    pub others: Vec<(usize, f64)>,
    /// What is added.
    pub course: Course,
    /// Whether it comes of an equation.
    pub equation: bool,
}

/// Relations by the unknown that follows, none of which is followed by another.
pub struct Relations {
    /// The relations.
    pub list: BTreeMap<usize, Relation>,
    /// Equations that cannot hold: which and why, and where.
    pub refused: Vec<(String, Place)>,
    /// For each unknown those that may follow it.
    followers: BTreeMap<usize, Vec<usize>>,
}

impl Relations {
    /// Solves each equation for its first unknown that is free and has a factor to speak of. An equation that
    /// follows from others, or from what prescribed unknowns do anyhow, is left out.
    pub fn of(given: BTreeMap<usize, Relation>, fixed: &Fixed, equations: &[Equation]) -> Self {
        let mut relations = Self { list: BTreeMap::new(), refused: vec![], followers: BTreeMap::new() };
        given.into_iter().for_each(|(dof, relation)| relations.insert(dof, relation));
        equations.iter().for_each(|equation| relations.hold(equation, fixed));
        relations
    }

    /// Adds an equation, or takes note that it cannot hold.
    pub fn hold(&mut self, equation: &Equation, fixed: &Fixed) {
        if let Err(why) = self.add(equation, fixed) {
            self.refused.push((format!("`{}` cannot hold: {why}", equation.by), equation.place));
        }
    }

    fn insert(&mut self, dof: usize, relation: Relation) {
        for (other, _) in &relation.others {
            self.followers.entry(*other).or_default().push(dof);
        }
        self.list.insert(dof, relation);
    }

    fn add(&mut self, equation: &Equation, fixed: &Fixed) -> Result<(), String> {
        let mut sum: BTreeMap<usize, f64> = BTreeMap::new();
        for &(dof, factor) in &equation.terms {
            match self.list.get(&dof) {
                None => *sum.entry(dof).or_default() += factor,
                Some(relation) if relation.course == Course::Hold => {
                    relation.others.iter().for_each(|&(other, c)| *sum.entry(other).or_default() += factor * c);
                }
                Some(_) => return Err("a support leads one of its nodes along a direction".into()),
            }
        }
        let largest = equation.terms.iter().fold(0.0_f64, |largest, term| largest.max(term.1.abs()));
        sum.retain(|_, factor| factor.abs() > ROUNDING * largest);
        let free = |dof: &usize| sum.contains_key(dof) && !fixed.contains_key(dof);
        let most = sum.iter().filter(|(dof, _)| free(dof)).fold(0.0_f64, |most, (_, c)| most.max(c.abs()));
        let order = equation.terms.iter().map(|term| term.0).chain(sum.keys().copied());
        let Some(pivot) = order.into_iter().find(|dof| free(dof) && sum[dof].abs() >= 0.1 * most) else {
            return match holds(&sum, fixed) {
                true => Ok(()),
                false => {
                    Err("all its nodes are held or led, to where it does not hold; remove one of them, or this".into())
                }
            };
        };
        let scale = -1.0 / sum[&pivot];
        let others: Vec<(usize, f64)> =
            sum.iter().filter(|(dof, _)| **dof != pivot).map(|(&dof, factor)| (dof, factor * scale)).collect();
        for follower in self.followers.remove(&pivot).unwrap_or_default() {
            let Some(relation) = self.list.get_mut(&follower) else { continue };
            if relation.replace(pivot, &others) {
                others.iter().for_each(|(other, _)| self.followers.entry(*other).or_default().push(follower));
            }
        }
        self.insert(pivot, Relation { others, course: Course::Hold, equation: true });
        Ok(())
    }
}

/// Whether a sum of prescribed unknowns that is zero stays so: nothing moves, or all that moves has one course in time and ends
/// where the sum is zero.
fn holds(sum: &BTreeMap<usize, f64>, fixed: &Fixed) -> bool {
    let course = |dof| fixed.get(dof).map(|(course, _)| *course);
    let mut times = sum.keys().filter_map(|dof| match course(dof)? {
        Course::Hold => None,
        Course::To(_, amplitude) => Some(amplitude),
    });
    let Some(first) = times.next() else { return true };
    let ends: Option<Vec<f64>> = sum.iter().map(|(dof, factor)| Some(factor * fixed.get(dof)?.1?)).collect();
    let zero =
        |ends: Vec<f64>| ends.iter().sum::<f64>().abs() <= ROUNDING * ends.iter().map(|end| end.abs()).sum::<f64>();
    times.all(|other| other == first) && ends.is_some_and(zero)
}

impl Relation {
    /// Puts what an unknown follows in its place, if it is among these.
    fn replace(&mut self, dof: usize, by: &[(usize, f64)]) -> bool {
        let Some(at) = self.others.iter().position(|other| other.0 == dof) else { return false };
        let (_, factor) = self.others.swap_remove(at);
        let mut sum: BTreeMap<usize, f64> = self.others.drain(..).collect();
        by.iter().for_each(|&(other, c)| *sum.entry(other).or_default() += factor * c);
        self.others = sum.into_iter().filter(|(_, c)| *c != 0.0).collect();
        true
    }
}

impl Builder<'_> {
    /// The equations of the deck: one for each node of the group of its first term.
    pub(super) fn equations(&mut self) -> Vec<Equation> {
        let (deck, mut equations) = (self.deck, Vec::new());
        for said in &deck.equation {
            let foreign = said.terms.iter().find(|term| term.axis.value.0 >= self.site.space.dimension());
            if let Some(term) = foreign {
                self.refuse("an equation has a term along z, but the model is plane", term.axis.place);
                continue;
            }
            let many = said.terms.iter().skip(1).find(|term| self.nodes(&term.group.text).len() != 1);
            if let Some(term) = many {
                let count = self.nodes(&term.group.text).len();
                let what =
                    format!("`{}` holds {count} nodes; a term of an equation after the first is of one", term.group);
                let help = "choose one by [group.NAME], or put this term first";
                self.found.push(Diagnostic::error(what).at(term.group.place).help(help));
                continue;
            }
            let unknown = |node: usize, axis: usize| self.site.dofs.node(node) + axis;
            let [first, rest @ ..] = said.terms.as_slice() else { continue };
            for &node in self.nodes(&first.group.text) {
                let rest =
                    rest.iter().map(|term| (unknown(self.nodes(&term.group.text)[0], term.axis.value.0), term.factor));
                let terms = std::iter::once((unknown(node, first.axis.value.0), first.factor)).chain(rest).collect();
                equations.push(Equation { terms, place: said.place, by: "equation" });
            }
        }
        equations
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_core::amplitude::Amplitude;

    fn equation(terms: &[(usize, f64)]) -> Equation {
        Equation { terms: terms.to_vec(), place: Place::default(), by: "equation" }
    }

    #[test]
    fn chains_are_followed_to_what_is_free_or_prescribed() {
        let equations =
            [equation(&[(0, 1.0), (1, -1.0)]), equation(&[(1, 2.0), (2, -1.0)]), equation(&[(0, 2.0), (2, -1.0)])];
        let course = to(1.0);
        let relations = Relations::of(BTreeMap::new(), &Fixed::from([(2, (&course, Some(1.0)))]), &equations);
        assert!(relations.refused.is_empty());
        assert_eq!(relations.list[&0].others, [(2, 0.5)]);
        assert_eq!(relations.list[&1].others, [(2, 0.5)]);
        assert_eq!(relations.list.len(), 2, "the third follows from the others");
    }

    fn to(end: f64) -> Course {
        Course::To(end, Amplitude::ramp())
    }

    /// Two unknowns that an equation makes equal, led as these say.
    fn refused(courses: [(Course, Option<f64>); 2]) -> bool {
        let fixed = courses.iter().enumerate().map(|(dof, (course, end))| (dof, (course, *end))).collect();
        let refused = Relations::of(BTreeMap::new(), &fixed, &[equation(&[(0, 1.0), (1, -1.0)])]).refused;
        assert!(refused.iter().all(|(what, _)| what.contains("held or led")));
        !refused.is_empty()
    }

    #[test]
    fn what_is_led_all_over_must_be_led_alike() {
        assert!(!refused([(Course::Hold, None), (Course::Hold, None)]));
        assert!(!refused([(to(0.1), Some(0.1)), (to(0.1), Some(0.1))]));
        assert!(!refused([(to(0.1), Some(0.1)), (Course::Hold, Some(0.1))]));
        assert!(refused([(to(0.1), Some(0.1)), (Course::Hold, Some(0.0))]));
        assert!(refused([(to(0.1), Some(0.1)), (Course::Hold, None)]));
        assert!(refused([(to(0.1), Some(0.1)), (to(0.2), Some(0.2))]));
        let at_once = Course::To(0.1, Amplitude::at_once());
        assert!(refused([(to(0.1), Some(0.1)), (at_once, Some(0.1))]));
    }
}
