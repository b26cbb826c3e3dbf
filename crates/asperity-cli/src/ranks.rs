//! The processes that share a run: this one alone, or the ranks that `mpirun` started, where the program was built with the
//! feature `cluster`. The first writes and speaks, the others follow.

#[cfg(not(feature = "cluster"))]
pub use alone::{any, arrive, obey};
#[cfg(feature = "cluster")]
pub use together::{any, arrive, obey};

#[cfg(not(feature = "cluster"))]
mod alone {
    use crate::arguments::Command;
    use crate::exit::Exit;
    use crate::verbs::Outcome;

    /// Obeys a command, and says how the program ends.
    pub fn obey(command: &Command, lead: impl FnOnce(&Command) -> Outcome) -> Exit {
        lead(command).unwrap_or_else(Exit::after)
    }

    /// Whether any process says yes.
    pub fn any(yes: bool) -> bool {
        yes
    }

    /// Lets the others know that the run has ended here.
    pub fn arrive() {}
}

#[cfg(feature = "cluster")]
mod together {
    use crate::arguments::Command;
    use crate::exit::{Exit, Trouble};
    use crate::verbs::{self, Outcome};
    use asperity::Error;
    use asperity::error::visible;

    /// Obeys a command, a run with all ranks, and says how the program ends.
    pub fn obey(command: &Command, lead: impl FnOnce(&Command) -> Outcome) -> Exit {
        cluster::provide();
        let (run, restart) = match command {
            Command::Run(run) => (run, None),
            Command::Restart(restart) => (&restart.run, Some(restart)),
            _ => return lead(command).unwrap_or_else(Exit::after),
        };
        let ranks = match cluster::start() {
            Ok(ranks) => ranks,
            Err(why) => return Exit::after(Error::Input(why).into()),
        };
        let (exit, words) = if ranks.rank() == 0 {
            (lead(command).unwrap_or_else(Exit::after), None)
        } else {
            match verbs::follow(run, restart) {
                Ok(exit) => (exit, None),
                // The first says so, unless it comes to another end.
                Err(trouble) => (Exit::of_trouble(&trouble), Some(in_words(&trouble))),
            }
        };
        ranks.part(exit as u8, words.as_deref());
        exit
    }

    fn in_words(trouble: &Trouble) -> String {
        match trouble {
            Trouble::Deck(diagnostics) => {
                let words = diagnostics.render(false);
                words.strip_prefix("error: ").unwrap_or(&words).to_owned()
            }
            Trouble::Other(error) => visible(&error.to_string()).into_owned(),
        }
    }

    /// Whether any rank says yes; all must ask.
    pub fn any(yes: bool) -> bool {
        cluster::start().map_or(yes, |ranks| ranks.any(yes))
    }

    /// Lets the other ranks know that the run has ended here.
    pub fn arrive() {
        cluster::start().iter().for_each(|ranks| ranks.arrive());
    }
}
