"""Models from files, text, dicts and arrays; what is said of them; exceptions."""

import random
import warnings
from pathlib import Path

import numpy as np
import pytest
from conftest import DECK, ROOT, SMALL, TUBE

import asperity
from asperity._deck import written


def top(run):
    return run.state.reactions["block.top"]


def test_a_file_a_text_and_a_dict_make_one_model(deck):
    file = asperity.Model(TUBE, set=SMALL)
    text = asperity.Model(TUBE.read_text(), set=[f"{key}={value}" for key, value in SMALL.items()])
    assert file.unknowns == text.unknowns == 2 * len(file.nodes) + 3
    assert (file.space, file.steps, file.bodies, file.contacts, file.tools) == (
        "axisymmetric", ["push"], ["tube"], ["bore"], ["mandrel"])
    as_dict, as_text = asperity.Model(deck), asperity.Model(written(deck))
    assert as_dict.deck == as_text.deck
    assert np.array_equal(top(as_dict.solve()), top(as_text.solve()))


def test_arrays_make_the_mesh_that_they_are(deck):
    generated = asperity.Model(deck)
    assert set(generated.cells) == {"quad4"} and generated.cells["quad4"].shape == (8, 4)
    groups = {name: nodes for name, nodes in generated.groups.items() if name != "block"}
    groups["block"] = {"cells": np.arange(8)}
    deck["mesh"] = {"nodes": generated.nodes[:, :2], "cells": generated.cells, "groups": groups}
    arrays = asperity.Model(deck)
    assert np.array_equal(arrays.nodes, generated.nodes)
    assert {k: v.tolist() for k, v in arrays.groups.items()} == {k: v.tolist() for k, v in generated.groups.items()}
    assert np.array_equal(top(arrays.solve()), top(generated.solve()))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"cells": {"quad5": [[0, 1, 2, 3]]}}, "no kind 'quad5'; did you mean 'quad4'?"),
        ({"cells": {"quad4": [[0, 1, 2]]}}, "3 columns, 4 are needed"),
        ({"cells": {"quad4": [[0, 1, 2, 99]]}}, "holds 99; indices go from 0 to 3"),
        ({"cells": {"quad4": [[0, 1, 2, -1]]}}, "holds -1"),
        ({"cells": {"quad4": [[0.5, 1, 2, 3]]}}, "rows of node indices"),
        ({"nodes": [[0, 0, 0, 0]]}, "2 or 3 columns"),
        ({"nodes": [[0, 0], [1, 0], [1, float("nan")], [0, 1]]}, "not"),
        ({"groups": {"a": {"sides": [1]}}}, "no 'sides'"),
        ({"groups": {"a": [7]}}, "mesh.groups['a'] holds 7"),
        ({"file": "x.msh"}, "keep one"),
    ],
)
def test_what_is_wrong_with_arrays_is_said(deck, change, words):
    square = {"nodes": [[0, 0], [1, 0], [1, 1], [0, 1]], "cells": {"quad4": [[0, 1, 2, 3]]}, "groups": {}}
    deck["mesh"] = {**square, **change}
    with pytest.raises((asperity.DeckError, ValueError)) as refused:
        asperity.Model(deck)
    assert words in str(refused.value)


def test_an_input_deck_runs_and_leaves_its_translation(tmp_path):
    run = asperity.Model(ROOT / "benches/input_decks/decks/blocks.inp").solve(tmp_path / "out", doubtful="warn")
    assert run.status in ("converged", "doubtful")
    assert (tmp_path / "out" / "blocks.toml").exists() and (tmp_path / "out" / "blocks.mesh.inp").exists()


def test_the_error_of_a_deck_carries_every_message_with_its_line(deck):
    deck["boddy"] = {}
    deck["material"]["steel"]["elastic"]["young"] = -1
    with pytest.raises(asperity.DeckError) as refused:
        asperity.Model(deck)
    error = refused.value
    assert "did you mean `body`?" in str(error) and "^" in str(error)
    assert len(error.messages) >= 2 and all(message["severity"] == "error" for message in error.messages)
    lines = written(deck).splitlines()
    at = next(message for message in error.messages if "boddy" in message["text"])
    assert "boddy" in lines[at["line"] - 1]
    assert isinstance(error, ValueError) and isinstance(error, asperity.AsperityError)


def test_wrong_arguments_are_refused():
    with pytest.raises(TypeError, match="a deck is a path"):
        asperity.Model(3)
    with pytest.raises(asperity.DeckError, match="no-such-deck.toml"):
        asperity.Model("no-such-deck.toml")
    with pytest.raises(asperity.DeckError, match="title: .* is no value of a deck"):
        asperity.Model({"title": object()})
    with pytest.raises(asperity.DeckError, match="a key is a string"):
        asperity.Model({1: 2})


def test_text_that_dicts_become_is_read_as_it_was_meant():
    tomllib = pytest.importorskip("tomllib")
    values = {"a b": [1, 2.5, True, "q\"\n\\\t\x7f€"], "n": np.float64(1e-300), "i": np.arange(3), "e": {}, "p": Path("x/y"),
              "t": [{"u": 1}, {"v": {"w": [{"z": 1}, 2]}}], "big": 1e22, "none": []}
    want = {**values, "n": 1e-300, "i": [0, 1, 2], "p": "x/y"}
    assert tomllib.loads(written(values)) == want


def test_check_says_what_the_command_says(deck):
    check = asperity.Model(deck).check()
    assert "contact foot" in check.text and check.ok and check.text in str(check)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", asperity.DeckWarning)
        deck["tool"]["plate"]["profile"][0]["line"] = [[3.0, -50.0], [-1.0, -50.0]]
        far = asperity.Model(deck).check()
    assert not far.ok and far.problems


def mutated(value, chance):
    """A deck with something in it that nobody expects."""
    odd = [None, -1, 0, 1e308, float("nan"), "", "x" * 50, [], {}, [[]], True, b"bytes", {"a": 1}, ["a", 1], 1 << 70, "\ud800"]
    if chance.random() < 0.06:
        return chance.choice(odd)
    if isinstance(value, dict):
        found = {(key + "x" if chance.random() < 0.01 else key): mutated(one, chance) for key, one in value.items()}
        return dict(list(found.items())[: chance.randint(0, len(found))]) if chance.random() < 0.03 else found
    if isinstance(value, list):
        return [mutated(one, chance) for one in value]
    return value


def test_no_deck_brings_anything_but_an_exception():
    chance = random.Random(1)
    refused = 0
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for _ in range(400):
            try:
                asperity.Model(mutated(DECK, chance)).check()
            except (asperity.DeckError, TypeError, ValueError):
                refused += 1
    assert 200 < refused


def test_points_are_driven():
    records = asperity.point(ROOT / "cases/point/elastic.toml")
    name, columns = next(iter(records.items()))
    assert len({len(column) for column in columns.values()}) == 1 and "stress_xx" in columns
    tension = {
        "version": 1,
        "material": {"steel": {"elastic": {"young": 200.0, "poisson": 0.25}}},
        "step": [{"increments": 4, "strain": {"xx": 0.02}, "stress": {"yy": 0.0, "zz": 0.0}}],
    }
    steel = asperity.point(tension)["steel"]
    assert steel["stress_xx"][-1] == pytest.approx(200.0 * 0.02, rel=1e-5)
    with pytest.raises(asperity.DeckError, match="did you mean"):
        asperity.point(tension, set={"material.steel.elastic.yung": 1.0})
