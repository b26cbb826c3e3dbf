"""What the tests share: the tube of `cases/tube`, small, and as a dict."""

import copy
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
TUBE = ROOT / "cases" / "tube" / "tube.toml"
SMALL = {"step.push.increments.count": 10, "mesh.part.tube.rectangle.cells": [2, 15]}

DECK = {
    "version": 1,
    "title": "Block pressed on a plate",
    "space": "plane-strain",
    "mesh": {"part": {"block": {"rectangle": {"from": [0.0, 0.0], "to": [2.0, 1.0], "cells": [4, 2], "cell": "quad4"}}}},
    "material": {"steel": {"elastic": {"young": 210e3, "poisson": 0.3}}},
    "body": {"block": {"material": "steel"}},
    "tool": {"plate": {"profile": [{"line": [[3.0, 0.0], [-1.0, 0.0]]}]}},
    "contact": {"foot": {"surface": "block.bottom", "target": "plate", "law": {"coulomb": {"friction": 0.3}}}},
    "step": [
        {"name": "press", "increments": {"count": 2}, "displacement": {"block.top": {"x": 0.0, "y": -0.002}}},
        {"name": "shear", "increments": {"count": 4}, "displacement": {"block.top": {"x": 0.004, "y": -0.002}}},
    ],
}


@pytest.fixture
def deck():
    return copy.deepcopy(DECK)


@pytest.fixture
def tube():
    import asperity

    return asperity.Model(TUBE, set=SMALL)
