"""Implicit finite elements for contact with friction under large displacements and strains.

A model is made from a deck, a run takes its increments, a state is what an increment led to::

    import asperity

    model = asperity.Model("tube.toml", set={"contact.bore.law.coulomb.friction": 0.1})
    for state in model.run():
        print(state.time, state.reactions["tube.top"])
    state.field("contact_pressure")     # NumPy arrays, no files

The book has a page about it: "Python".
"""

from ._errors import (
    AsperityError,
    ConvergenceError,
    DeckError,
    DeckWarning,
    DoubtfulResult,
    DoubtfulWarning,
    InternalError,
    ResultError,
    Stopped,
)
from ._native import Check, Model, Run, State, __version__, point

__all__ = [
    "AsperityError",
    "Check",
    "ConvergenceError",
    "DeckError",
    "DeckWarning",
    "DoubtfulResult",
    "DoubtfulWarning",
    "InternalError",
    "Model",
    "ResultError",
    "Run",
    "State",
    "Stopped",
    "point",
    "__version__",
]
