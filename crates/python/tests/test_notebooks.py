"""The notebooks: every code cell in its order, in one namespace, as a kernel would. They assert what they claim."""

import json
from pathlib import Path

import pytest

NOTEBOOKS = sorted((Path(__file__).resolve().parents[1] / "notebooks").glob("*.ipynb"))


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebook(path, monkeypatch):
    pytest.importorskip("scipy")
    pytest.importorskip("matplotlib").use("Agg")
    monkeypatch.chdir(path.parent)
    space = {"__name__": "__main__"}
    for cell in json.loads(path.read_text(encoding="utf-8"))["cells"]:
        if cell["cell_type"] == "code":
            exec(compile("".join(cell["source"]), f"{path.name}:{cell['id']}", "exec"), space)


def test_there_are_two():
    assert len(NOTEBOOKS) == 2
