//! Limits of the certificate. Their keys are the figures that have one: what is declared there is a key here.

use crate::form::{Fields, Form, KeyTable, key, number};
use crate::reader::Reader;
use crate::schema::Key;
use crate::tree::Node;
use asperity_core::declare::{Range, unit};
use asperity_results::output::{FIGURES, Limit, Limits};

/// What the figures of the certificate may be; a run that passes a limit is doubtful.
#[derive(Debug, Clone, Default)]
pub struct LimitKeys {
    /// The limits.
    pub limits: Limits,
}

fn limited() -> impl Iterator<Item = (&'static str, Limit)> {
    FIGURES.iter().filter_map(|figure| Some((figure.name, figure.limit?)))
}

fn limit() -> impl Form<Value = f64> {
    number(unit::NONE, Range::NOT_NEGATIVE)
}

impl KeyTable for LimitKeys {
    fn keys() -> Vec<Key> {
        limited().map(|(name, declared)| key(&limit().or(declared.default), name, declared.about)).collect()
    }

    fn read(node: &Node, reader: &mut Reader) -> Option<Self> {
        let (mut fields, mut limits) = (Fields::open(node, reader)?, Limits::default());
        for (name, declared) in limited() {
            if let Some(value) = fields.take(name, &limit().or(declared.default), reader) {
                limits.set(name, value);
            }
        }
        fields.close(reader).then_some(Self { limits })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tree::parse;

    fn read(text: &str) -> (Option<Limits>, usize) {
        let (node, faults) = parse(text, 0);
        let mut reader = Reader::default();
        let limits = LimitKeys::read(&node, &mut reader).map(|keys| keys.limits);
        (limits, faults.len() + reader.diagnostics.len())
    }

    #[test]
    fn every_limit_is_a_key_with_its_default() {
        assert_eq!(read(""), (Some(Limits::default()), 0));
        for (name, _) in limited() {
            let (limits, faults) = read(&format!("{name} = 0.123"));
            assert_eq!((limits.unwrap().of(name), faults), (Some(0.123), 0));
            assert_ne!(Limits::default().of(name), Some(0.123));
            assert_eq!(read(&format!("{name} = -1.0")).1, 1, "{name}");
        }
        assert_eq!(read("energy_balanc = 1.0").1, 1);
    }
}
