"""Runs: increments, fields, files, branches, interrupts, threads, memory."""

import copy
import gc
import json
import os
import signal
import sys
import threading
import warnings
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT, SMALL, TUBE

import asperity


def status(directory):
    return json.loads((directory / "summary.json").read_text())["status"]


def test_increments_come_one_by_one_and_fields_without_files(tube, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    run = tube.run()
    seen = [(state.increment, state.step, state.time) for state in run]
    assert [number for number, *_ in seen] == list(range(1, 11)) and seen[-1][2] == pytest.approx(1.0)
    assert run.done and run.status == "converged" and run.directory is None and not list(tmp_path.iterdir())
    state = run.state
    assert state.displacement.shape == tube.nodes.shape
    assert state.displacement[tube.groups["tube.top"], 1] == pytest.approx(-100.0)
    assert state.stress.shape == (30 * 4, 6) and state.field("von_mises", at="cell").shape == (30,)
    for place, names in state.fields.items():
        for name in names:
            assert np.isfinite(state.field(name, at=place)).any() or name == "contact_gap"
    bore = state.contact("bore")
    closed = bore["status"] > 0
    # Coulomb: the shear of what slips is 0.2 times its pressure; forces sum up to the tool's.
    slips = bore["status"] == 2
    assert slips.any() and np.allclose(np.abs(bore["shear"][slips]), 0.2 * bore["pressure"][slips], rtol=1e-9)
    assert bore["force"][closed, 1].sum() == pytest.approx(-state.reactions["tube.top"][1], rel=1e-5)
    assert state.tools["mandrel"]["force"][1] == pytest.approx(-state.reactions["tube.top"][1], rel=1e-5)
    assert state.totals["reaction.tube.top.y"] == state.reactions["tube.top"][1]
    mine = state.field("displacement")
    mine[:] = 0.0
    assert state.displacement[:, 1].min() < -99.0, "an array is its taker's own"


def test_history_has_a_row_an_increment(tube):
    run = tube.solve()
    columns = run.history(frame=False)
    assert columns["increment"].tolist() == list(range(1, 11)) and columns["increment"].dtype == np.int64
    assert columns["reaction.tube.top.y"][-1] == run.state.reactions["tube.top"][1]
    pandas = pytest.importorskip("pandas")
    assert isinstance(run.history(), pandas.DataFrame)


def test_what_is_not_there_is_said_with_what_is(tube):
    state = tube.initial()
    with pytest.raises(LookupError, match="did you mean 'displacement'"):
        state.field("displacment")
    with pytest.raises(LookupError, match="there are bore"):
        state.contact("nothing at all")
    with pytest.raises(ValueError, match="no place \"edge\""):
        state.field("displacement", at="edge")
    with pytest.raises(ValueError, match="doubtful is"):
        tube.run(doubtful="perhaps")
    with pytest.raises(TypeError, match="restart"):
        tube.run(restart=True)


def test_the_directory_is_that_of_the_command(tube, tmp_path):
    out = tmp_path / "out"
    run = tube.solve(out)
    names = {path.name for path in out.iterdir()}
    assert {"summary.json", "history.csv", "deck.json", "bodies.pvd", "contacts.pvd", "increments.csv", "report.html",
            "von_mises.png", "status.json", "certificate.csv", "run.checkpoint"} <= names
    assert status(out) == "converged" == run.status and "report.html" in run.summary["files"]
    with open(out / "history.csv") as lines:
        header, *rows = (line.rstrip("\n").split(",") for line in lines)
    history = run.history(frame=False)
    assert header == list(history) and len(rows) == 10
    assert float(rows[-1][header.index("reaction.tube.top.y")]) == history["reaction.tube.top.y"][-1]


def test_a_loop_that_is_left_can_be_taken_up_and_a_run_that_is_let_go_is_stopped(tube, tmp_path):
    out = tmp_path / "out"
    whole = tube.solve().state
    run = tube.run(out, report=False)
    for state in run:
        if state.increment == 3:
            break
    assert (out / "run.checkpoint").exists() and status(out) == "running"
    with pytest.raises(asperity.ResultError, match="another process is writing"):
        tube.run(out)
    for state in run:
        assert state.increment == 4
        break
    del run, state
    gc.collect()
    assert status(out) == "stopped"
    again = tube.solve(out, restart=True)
    assert again.history(frame=False)["increment"][0] == 5
    assert np.array_equal(again.state.displacement, whole.displacement)
    finished = tube.solve(out, restart=True)
    assert finished.done and finished.status == "converged" and len(finished.history(frame=False)["time"]) == 0
    assert np.array_equal(finished.state.displacement, whole.displacement)
    assert finished.fork().complete().state.increment == 10, "there is nothing left"


def test_a_block_ends_its_run(tube, tmp_path):
    with pytest.raises(ZeroDivisionError), tube.run(tmp_path / "out") as run:
        run.advance()
        1 / 0
    assert status(tmp_path / "out") == "stopped" and run.done and run.advance() is None
    assert (tmp_path / "out" / "report.html").exists()


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="needs interval timers")
def test_an_interrupt_ends_the_run_with_a_checkpoint(tmp_path):
    model = asperity.Model(TUBE, set={"step.push.increments.count": 60, "mesh.part.tube.rectangle.cells": [2, 30]})
    out = tmp_path / "out"
    before = signal.signal(signal.SIGALRM, lambda *_: os.kill(os.getpid(), signal.SIGINT))
    # A shell has its background jobs ignore interrupts.
    handler = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        run = model.run(out)
        run.advance()
        # Far less than the increments that are left take on any machine.
        signal.setitimer(signal.ITIMER_REAL, 0.02)
        with pytest.raises(KeyboardInterrupt):
            run.complete()
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
        signal.signal(signal.SIGINT, handler)
    reached = run.state.increment
    assert 1 < reached < 60 and run.status == "stopped" == status(out) and (out / "run.checkpoint").exists()
    resumed = model.solve(out, restart=True)
    assert np.array_equal(resumed.state.displacement, model.solve().state.displacement)


def test_a_branch_is_the_run_it_left_and_disturbs_nothing(tube):
    run = tube.run()
    for state in run:
        if state.increment == 4:
            break
    other = asperity.Model(TUBE, set={**SMALL, "contact.bore.law.coulomb.friction": 0.0})
    same, changed = state.fork().complete(), run.fork(model=other).complete()
    whole = run.complete().state
    assert np.array_equal(same.state.displacement, whole.displacement)
    assert changed.state.reactions["tube.top"][1] > 1.5 * whole.reactions["tube.top"][1]
    for twin in (state.copy(), copy.copy(state), copy.deepcopy(state)):
        assert twin is not state and np.array_equal(twin.displacement, state.displacement)
    with pytest.raises(asperity.DeckError, match="belongs to another model"):
        asperity.Model(TUBE).run(start=state)


def test_a_run_that_fails_says_why(deck, tmp_path):
    deck["step"][1]["increments"].update(count=1, smallest=0.9)
    deck["step"][1]["displacement"]["block.top"] = {"x": 0.0, "y": -5.0}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", asperity.DeckWarning)
        model = asperity.Model(deck)
    for out in (None, tmp_path / "out"):
        with pytest.raises(asperity.ConvergenceError, match="still fails") as failed:
            model.solve(out)
        error = failed.value
        assert error.summary["status"] == "not-converged" and error.state.increment == 2 and error.directory == out
    assert status(tmp_path / "out") == "not-converged" and (tmp_path / "out" / "run.checkpoint").exists()


def test_a_doubtful_result_is_an_exception_or_a_warning(deck, tmp_path):
    deck["limits"] = {"max_penetration_relative": 1e-12}
    model = asperity.Model(deck)
    with pytest.raises(asperity.DoubtfulResult, match="beyond the limit") as doubtful:
        model.solve(tmp_path / "out")
    assert doubtful.value.summary["status"] == "doubtful" == status(tmp_path / "out")
    with pytest.warns(asperity.DoubtfulWarning, match="max_penetration_relative"):
        run = model.solve(doubtful="warn")
    assert run.status == "doubtful"


def test_another_process_can_stop_a_run(tube, tmp_path):
    run = tube.run(tmp_path)
    run.advance()
    (tmp_path / "stop.request").touch()
    with pytest.raises(asperity.Stopped):
        run.complete()
    assert status(tmp_path) == "stopped"


def test_other_threads_go_on_while_an_increment_is_solved(tube):
    run, ended, turns = tube.run(), threading.Event(), 0

    def work():
        run.complete()
        ended.set()

    thread = threading.Thread(target=work)
    thread.start()
    refused = 0
    while not ended.wait(0.001):
        turns += 1
        try:
            run.state
        except RuntimeError as error:
            assert "another thread" in str(error)
            refused += 1
    thread.join()
    assert run.status == "converged" and turns > 10 and refused > 0


def test_grids_are_those_of_the_files(tube):
    pytest.importorskip("pyvista")
    state = tube.solve().state
    bodies, contacts = state.grid(), state.grid("contacts")
    assert bodies.n_cells == 30 and np.array_equal(bodies.point_data["displacement"], state.displacement)
    assert bodies.point_data["group.tube.top"].sum() == len(tube.groups["tube.top"])
    assert np.array_equal(contacts.point_data["contact_pressure"], state.field("contact_pressure"))
    assert bodies.warp_by_vector("displacement").bounds[2] == pytest.approx(-100.0, abs=5.0)
    assert state.grid("tools").n_cells > 0 and state.grid("points").n_points == len(state.stress)
    with pytest.raises(ValueError, match="no grid"):
        state.grid("all")


def resident():
    with open("/proc/self/statm") as statm:
        return int(statm.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


@pytest.mark.filterwarnings("ignore::asperity.DoubtfulWarning")
@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")
def test_a_hundred_runs_in_one_process_do_not_grow():
    small = {"step.push.increments.count": 4, "mesh.part.tube.rectangle.cells": [1, 12]}
    forces, sizes = [], []
    for i in range(120):
        friction = 0.3 * i / 119
        model = asperity.Model(TUBE, set={**small, "contact.bore.law.coulomb.friction": friction})
        forces.append(-model.solve(doubtful="warn").state.reactions["tube.top"][1])
        gc.collect()
        sizes.append(resident())
    assert np.all(np.diff(forces) > 0)
    # The first twenty fill what allocators and threads keep.
    assert max(sizes[20:]) - sizes[20] < 4_000_000, sizes[::20]


def test_every_name_has_a_stub_and_words():
    stubs = (Path(asperity.__file__).parent / "_native.pyi").read_text()
    for kind in (asperity.Model, asperity.Check, asperity.Run, asperity.State):
        assert f"class {kind.__name__}:" in stubs and kind.__doc__
        for name in vars(kind):
            if not name.startswith("_"):
                assert f"def {name}(" in stubs, f"{kind.__name__}.{name}"
                assert getattr(kind, name).__doc__ or kind is asperity.Check, f"{kind.__name__}.{name}"
    assert "def point(" in stubs and asperity.point.__doc__


def test_the_manual_names_all_there_is():
    page = (ROOT / "book/src/python.md").read_text(encoding="utf-8")
    names = set(asperity.__all__) - {"__version__"}
    for kind in (asperity.Model, asperity.Run, asperity.State, asperity.Check):
        names |= {name for name in vars(kind) if not name.startswith("_")}
    missing = [name for name in sorted(names) if f"`{name}`" not in page and f"`{name}(" not in page and f".{name}(" not in page]
    assert not missing


def test_the_first_script_of_the_manual_runs(monkeypatch, capsys):
    monkeypatch.chdir(ROOT)
    page = (ROOT / "book/src/python.md").read_text(encoding="utf-8")
    script = page.split("## The first script")[1].split("```python\n")[1].split("```")[0]
    exec(compile(script, "python.md", "exec"), {})
    said = capsys.readouterr().out
    assert "contact bore" in said and said.count("iterations\n") == 50
