"""Exceptions and warnings. The text of each is what the command ``asperity`` would print."""

from __future__ import annotations

from typing import Any


class AsperityError(Exception):
    """Anything that ends a model or a run.

    ``summary`` is that of the run, as in ``summary.json``, ``state`` the last one it accepted, and ``directory`` where its
    results are; ``None`` where there was no run or nothing was written.
    """

    summary: dict[str, Any] | None = None
    state: Any = None
    directory: Any = None


class DeckError(AsperityError, ValueError):
    """The deck is wrong. ``messages`` has each message: severity, text, label, help, file, line."""

    messages: list[dict[str, Any]]

    def __init__(self, *args: Any) -> None:
        super().__init__(*args)
        self.messages = []


class ConvergenceError(AsperityError, RuntimeError):
    """The increments shrank to nothing. ``summary["diagnosis"]`` says of what, most likely.

    Of a driven point ``records`` holds what was reached.
    """

    records: dict[str, Any] | None = None


class DoubtfulResult(AsperityError, RuntimeError):
    """The run came to its end, and a figure of its certificate is beyond its limit. The results are there."""


class Stopped(AsperityError):
    """Another process asked the run to stop (``asperity watch``); the checkpoint is written."""


class ResultError(AsperityError, RuntimeError):
    """A file could not be read or a result not be written."""


class InternalError(AsperityError, RuntimeError):
    """A fault of the program itself; please report it."""


class DeckWarning(UserWarning):
    """The deck can be run, but look here first."""


class DoubtfulWarning(UserWarning):
    """As :class:`DoubtfulResult`, where a warning was asked for (``doubtful="warn"``)."""
