//! The same deck with softer penalties.

use super::Loaded;
use super::source::Spot;
use asperity_core::Error;
use asperity_core::model::Model;
use asperity_results::output::Parts;

impl Loaded {
    /// The deck with the penalties of `model`, which was made from it, divided by `ratio`.
    ///
    /// # Errors
    /// An error when the deck has no contact.
    pub fn softened(mut self, model: &Model, ratio: f64) -> Result<Self, Error> {
        let contacts = Parts::of(model).contacts;
        for (name, keys) in &mut self.deck.contact {
            let options = contacts.iter().find(|(_, other, _)| *other == name.text).map(|(_, _, c)| c.options());
            let Some(options) = options else { continue };
            keys.penalty = Some(options.penalty / ratio);
            match options.elastic_slip {
                None => keys.tangential_penalty = Some(options.tangential_penalty / ratio),
                Some(part) => keys.elastic_slip = Some(Spot { value: part * ratio, place: name.place }),
            }
        }
        if self.deck.contact.is_empty() {
            return Err(Error::Input("there is no contact in this deck, and no penalty to study".into()));
        }
        Ok(self)
    }
}
