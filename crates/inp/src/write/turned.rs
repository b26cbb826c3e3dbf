//! Conditions along axes of nodes' own, as components along the axes of the model or as values along a direction.

use super::Writer;
use super::courses::Item;
use crate::model::Frame;

/// Along which a node is led.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Led {
    /// An axis of the model.
    Axis(usize),
    /// A direction.
    Along([f64; 3]),
}

/// Sines of angles below this count as nothing.
pub(super) const PARALLEL: f64 = 1e-12;

/// What values along some axes of a frame say along those of the model: components where an axis of the frame is one of the
/// model, or where all that are none are led; a value along a direction where one is. None where two of three are.
pub fn resolved(frame: &Frame, dimension: usize, led: &[(usize, Item)]) -> Option<Vec<(Led, Item)>> {
    let parallel = |axis: usize| {
        let others = |j: usize| (0..3).filter(|&k| k != j).all(|k| frame[axis][k].abs() < PARALLEL);
        (0..dimension).find(|&j| others(j))
    };
    let mut found = Vec::new();
    let mut oblique = Vec::new();
    for (axis, item) in led {
        match parallel(*axis) {
            Some(j) => found.push((Led::Axis(j), item.scaled(frame[*axis][j]))),
            None => oblique.push((frame[*axis], item)),
        }
    }
    let all = (0..dimension).filter(|&axis| parallel(axis).is_none()).count();
    match oblique.as_slice() {
        [] => {}
        [(direction, item)] if all > 1 => found.push((Led::Along(*direction), (*item).clone())),
        several if several.len() == all => {
            for axis in (0..dimension).filter(|&axis| several.iter().any(|(e, _)| e[axis].abs() > PARALLEL)) {
                let parts: Vec<Item> = several.iter().map(|(e, item)| item.scaled(e[axis])).collect();
                found.push((Led::Axis(axis), Item::sum(&parts)?));
            }
        }
        _ => return None,
    }
    Some(found)
}

impl Writer<'_> {
    /// The number of a component that stands for a direction, counted on from those along the axes.
    pub(super) fn component(&mut self, led: Led) -> usize {
        let direction = match led {
            Led::Axis(axis) => return axis,
            Led::Along(direction) => direction,
        };
        let known = self.directions.iter().position(|other| *other == direction);
        3 + known.unwrap_or_else(|| {
            self.directions.push(direction);
            self.directions.len() - 1
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::message::InputPlace;

    const FRAME: Frame = [[0.6, 0.8, 0.0], [-0.8, 0.6, 0.0], [0.0, 0.0, 1.0]];

    fn item(end: f64) -> Item {
        Item { end, start: Some(0.0), course: None, place: InputPlace::default() }
    }

    #[test]
    fn axes_of_a_node_become_those_of_the_model_where_they_can() {
        let values = |led: &[(usize, f64)]| {
            let led: Vec<(usize, Item)> = led.iter().map(|(axis, end)| (*axis, item(*end))).collect();
            resolved(&FRAME, 3, &led).map(|all| all.into_iter().map(|(led, item)| (led, item.end)).collect::<Vec<_>>())
        };
        assert_eq!(values(&[(2, 3.0)]), Some(vec![(Led::Axis(2), 3.0)]));
        assert_eq!(values(&[(0, 2.0)]), Some(vec![(Led::Along(FRAME[0]), 2.0)]));
        assert_eq!(values(&[(0, 5.0), (1, 0.0)]), Some(vec![(Led::Axis(0), 3.0), (Led::Axis(1), 4.0)]));
        let tilted = [[0.6, 0.8, 0.0], [-0.48, 0.36, 0.8], [0.64, -0.48, 0.6]];
        assert!(resolved(&tilted, 3, &[(0, item(1.0)), (1, item(1.0))]).is_none());
    }
}
