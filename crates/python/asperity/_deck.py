"""Decks from Python: dicts become the text of a deck, so that messages have lines to point at; arrays become a mesh."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ._errors import DeckError

_BARE = re.compile(r"[A-Za-z0-9_-]+\Z")
_ARRAYS = ("nodes", "cells", "groups")
MESH_NAME = "NumPy arrays"


def understood(deck: Any, sets: Any, folder: Any) -> dict[str, Any]:
    """What the native module reads a deck from: a path, or text with perhaps a mesh."""
    text, mesh, path = None, None, "deck in Python"
    if isinstance(deck, Mapping):
        rest, mesh = _without_arrays(deck)
        text = written(rest)
    elif isinstance(deck, str) and "\n" in deck:
        text = deck
    elif isinstance(deck, (str, os.PathLike)):
        path = os.fspath(deck)
    else:
        raise TypeError(f"a deck is a path, the text of a deck or a dict, not {type(deck).__name__}")
    return {"text": text, "path": path, "folder": folder or "", "sets": _sets(sets), "mesh": mesh}


def _sets(sets: Any) -> list[str]:
    if isinstance(sets, Mapping):
        return [f"{key}={_value(value, key)}" for key, value in sets.items()]
    if isinstance(sets, str):
        return [sets]
    return [str(one) for one in sets]


def written(deck: Mapping[str, Any]) -> str:
    """A dict as the text of a deck."""
    lines: list[str] = []
    _table(deck, (), lines)
    return "\n".join(lines) + "\n"


def _table(table: Mapping[str, Any], path: tuple[str, ...], lines: list[str]) -> None:
    tables = []
    for key, value in table.items():
        if not isinstance(key, str):
            raise DeckError(f"{_name(path)}: a key is a string, not {key!r}")
        if isinstance(value, Mapping) or _is_tables(value):
            tables.append((key, value))
        else:
            lines.append(f"{_key(key)} = {_value(value, _name((*path, key)))}")
    for key, value in tables:
        header = ".".join(_key(part) for part in (*path, key))
        for one in [value] if isinstance(value, Mapping) else value:
            lines.append(f"\n[{header}]" if isinstance(value, Mapping) else f"\n[[{header}]]")
            _table(one, (*path, key), lines)


def _is_tables(value: Any) -> bool:
    return isinstance(value, (list, tuple)) and bool(value) and all(isinstance(one, Mapping) for one in value)


def _key(key: str) -> str:
    return key if _BARE.match(key) else _text(key)


def _text(text: str) -> str:
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _name(path: tuple[str, ...]) -> str:
    return ".".join(path) or "the deck"


def _value(value: Any, name: str) -> str:
    if isinstance(value, np.ndarray) or isinstance(value, np.generic):
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, os.PathLike):
        return _text(os.fspath(value))
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_key(str(key))} = {_value(one, f'{name}.{key}')}" for key, one in value.items()) + " }"
    if isinstance(value, Sequence):
        return "[" + ", ".join(_value(one, name) for one in value) + "]"
    raise DeckError(f"{name}: {value!r} is no value of a deck; numbers, strings, bools, lists, arrays and dicts are")


def _without_arrays(deck: Mapping[str, Any]) -> tuple[Mapping[str, Any], dict[str, Any] | None]:
    """The deck without the arrays of its mesh, and these."""
    mesh = deck.get("mesh")
    if not isinstance(mesh, Mapping) or not any(key in mesh for key in _ARRAYS):
        return deck, None
    if "file" in mesh:
        raise DeckError("mesh: both a file and arrays are given; keep one")
    if "nodes" not in mesh or "cells" not in mesh:
        raise DeckError("mesh: arrays of a mesh are `nodes` and `cells`, and `groups` if it has any")
    rest = {key: value for key, value in mesh.items() if key not in _ARRAYS}
    return {**deck, "mesh": {"file": MESH_NAME, **rest}}, _arrays(mesh)


def _arrays(mesh: Mapping[str, Any]) -> dict[str, Any]:
    nodes = np.asarray(mesh["nodes"], dtype=float)
    if nodes.ndim != 2 or nodes.shape[1] not in (2, 3):
        raise DeckError(f"mesh.nodes: an array of 2 or 3 columns is needed, not one of shape {nodes.shape}")
    nodes = np.pad(nodes, ((0, 0), (0, 3 - nodes.shape[1])))
    cells = [(str(kind), _whole(rows, 2, f"mesh.cells['{kind}']")) for kind, rows in mesh["cells"].items()]
    groups = {str(name): _group(group, f"mesh.groups['{name}']") for name, group in mesh.get("groups", {}).items()}
    return {"nodes": nodes.tolist(), "cells": cells, "groups": groups}


def _group(group: Any, name: str) -> tuple[list[int], list[int]]:
    """Nodes and cells of a group; an array by itself is one of nodes."""
    if not isinstance(group, Mapping):
        return _whole(group, 1, name), []
    unknown = set(group) - {"nodes", "cells"}
    if unknown:
        raise DeckError(f"{name}: there is no {sorted(map(str, unknown))[0]!r}; a group has `nodes` and `cells`")
    return _whole(group.get("nodes", []), 1, f"{name}['nodes']"), _whole(group.get("cells", []), 1, f"{name}['cells']")


def _whole(values: Any, dimensions: int, name: str) -> Any:
    array = np.asarray(values)
    if array.size == 0:
        return []
    if array.ndim != dimensions or array.dtype.kind not in "iu":
        kind = "rows of node indices" if dimensions == 2 else "a list of indices"
        raise DeckError(f"{name}: {kind} from 0 are needed, not {array.dtype} of shape {array.shape}")
    return array.tolist()
