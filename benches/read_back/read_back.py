"""Reads a result directory with PyVista and meshio and recomputes equilibrium from the files alone. See README.md."""

import argparse
import csv
import json
import sys
from pathlib import Path

import meshio
import numpy as np
import pyvista

# Bounds of the relative errors. Sums are in another order here than in the program; equilibrium holds as far as the
# run's own residual tolerance, which the caller may pass.
ROUNDING = 1e-12


class Figures:
    """The largest error of each figure over all frames."""

    def __init__(self):
        self.errors = {}

    def add(self, name, found, expected, size, bound):
        error = float(np.max(np.abs(np.asarray(found) - np.asarray(expected)), initial=0.0))
        error = error / size if size > 0 else error
        worst, _ = self.errors.get(name, (0.0, bound))
        self.errors[name] = (max(worst, error), bound)

    def report(self):
        good = True
        for name, (error, bound) in self.errors.items():
            kept = error <= bound
            good &= kept
            print(f"{name:44s} {error:9.2e}  bound {bound:7.0e}  {'ok' if kept else 'FAILED'}")
        return good


def frames(directory, name):
    """The times of a series and its files."""
    path = directory / f"{name}.pvd"
    if not path.exists():
        return {}
    reader = pyvista.PVDReader(str(path))
    return {dataset.time: directory / dataset.path for dataset in reader.datasets}


def read(path, figures):
    """A grid by PyVista, its arrays compared with meshio's."""
    grid = pyvista.read(path)
    other = meshio.read(path)
    same = np.array_equal(other.points, grid.points)
    for name in grid.point_data:
        same &= np.array_equal(np.asarray(grid.point_data[name]), other.point_data[name], equal_nan=True)
    for name in grid.cell_data:
        blocks = np.concatenate([np.asarray(block) for block in other.cell_data[name]])
        same &= np.array_equal(np.asarray(grid.cell_data[name]), blocks, equal_nan=True)
    figures.add("arrays of PyVista and meshio", 0.0 if same else 1.0, 0.0, 1.0, 0.0)
    return grid


def moved(grid):
    return np.asarray(grid.points) + grid.point_data["displacement"]


def tensor(voigt):
    """XX YY ZZ XY YZ XZ as matrices."""
    xx, yy, zz, xy, yz, xz = np.asarray(voigt).T
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]).transpose(2, 0, 1)


def affine_motions(dimension):
    """Translations and gradients of unit size."""
    for i in range(dimension):
        yield np.eye(3)[i], np.zeros((3, 3))
        for j in range(dimension):
            gradient = np.zeros((3, 3))
            gradient[i, j] = 1.0
            yield np.zeros(3), gradient


def inner_work(points, velocity, gradient, axisymmetric):
    x, volume = moved(points), np.asarray(points.point_data["volume"])
    sigma = tensor(points.point_data["cauchy_stress"])
    density = np.einsum("pij,ij->p", sigma, gradient)
    if axisymmetric:
        density = density + sigma[:, 2, 2] * (velocity(x)[:, 0] / x[:, 0])
    return float(density @ volume), float(np.abs(density) @ volume)


def outer_work(bodies, contacts, velocity):
    data = bodies.point_data
    works = [np.sum((data["reaction"] + data["load"]) * velocity(moved(bodies)), axis=1)]
    if contacts is not None:
        works.append(np.sum(contact_forces(contacts) * velocity(moved(contacts)), axis=1))
    works = np.concatenate(works)
    return float(np.sum(works)), float(np.sum(np.abs(works)))


def contact_forces(contacts):
    data = contacts.point_data
    return np.asarray(data["contact_traction"]) * np.asarray(data["contact_area"])[:, None]


def check_equilibrium(bodies, points, contacts, space, figures, tolerance):
    dimension = 3 if space == "solid" else 2
    for shift, gradient in affine_motions(dimension):
        velocity = lambda x: shift + x @ gradient.T
        inner, inner_size = inner_work(points, velocity, gradient, space == "axisymmetric")
        outer, outer_size = outer_work(bodies, contacts, velocity)
        figures.add("work of stress and of forces", inner, outer, max(inner_size, outer_size), tolerance)


def row_at(history, time):
    return next((row for row in history if float(row["time"]) == time), None)


def check_contacts(contacts, names, row, figures):
    number = np.asarray(contacts.point_data["contact"])
    for index, name in enumerate(names):
        own = number == index
        force = contact_forces(contacts)[own]
        for axis, letter in enumerate("xyz"):
            column = f"contact.{name}.force.{letter}"
            if column in row:
                size = float(np.sum(np.linalg.norm(force, axis=1)))
                figures.add("arrows and contact.NAME.force", force[:, axis].sum(), float(row[column]), size, ROUNDING)
        closed = own & (np.asarray(contacts.point_data["contact_status"]) > 0)
        area = float(np.sum(np.asarray(contacts.point_data["contact_area"])[closed]))
        figures.add("contact.NAME.area", area, float(row[f"contact.{name}.area"]), max(area, 1e-300), ROUNDING)
        pressure = float(np.max(np.asarray(contacts.point_data["contact_pressure"])[own], initial=0.0))
        figures.add("contact.NAME.max_pressure", pressure, float(row[f"contact.{name}.max_pressure"]), 1.0, 0.0)


def check_reactions(bodies, row, figures):
    reaction = np.asarray(bodies.point_data["reaction"])
    for column, value in row.items():
        if not column.startswith("reaction."):
            continue
        group, letter = column[len("reaction."):].rsplit(".", 1)
        mask = np.asarray(bodies.point_data[f"group.{group}"]) > 0
        forces = reaction[mask][:, "xyz".index(letter)]
        size = float(np.sum(np.abs(reaction[mask])))
        figures.add("nodal reactions and reaction.GROUP", forces.sum(), float(value), size, ROUNDING)


# The order of a symmetric tensor in VTU, in PyVista's nine components of an XDMF file and in meshio's six.
NINE = [0, 4, 8, 1, 5, 2]
SIX = [0, 3, 5, 1, 4, 2]


def check_xdmf(path, bodies, figures):
    """All frames in one file, by both readers, against the frames of the bodies."""
    reader = pyvista.get_reader(str(path))
    with meshio.xdmf.TimeSeriesReader(path) as other:
        points, _ = other.read_points_cells()
        found = {time: (points, fields) for time, fields, _ in map(other.read_data, range(other.num_steps))}
    for time, grid in bodies.items():
        reader.set_active_time_value(time)
        own, (points, fields) = reader.read(), found[time]
        same = np.array_equal(points, grid.points) and np.array_equal(own.points, grid.points)
        sizes = [mesh.compute_cell_sizes().cell_data for mesh in (own, grid)]
        measure = [np.asarray(size["Area"]) + np.asarray(size["Volume"]) for size in sizes]
        figures.add("cells of the XDMF file", measure[0], measure[1], float(np.max(measure[1])), ROUNDING)
        for name in set(grid.point_data) & set(fields):
            wanted = np.nan_to_num(np.asarray(grid.point_data[name]))
            arrays = [np.asarray(own.point_data[name]), fields[name]]
            if wanted.ndim > 1 and wanted.shape[1] == 6:
                arrays = [array.reshape(len(wanted), -1) for array in arrays]
                arrays = [array[:, NINE if array.shape[1] == 9 else SIX] for array in arrays]
            same &= all(np.array_equal(array, wanted) for array in arrays)
        figures.add("arrays of the XDMF file", 0.0 if same else 1.0, 0.0, 1.0, 0.0)


def check_deformed(series, bodies, figures):
    for time, path in series.items():
        figures.add("points of deformed.pvd", pyvista.read(path).points, moved(bodies[time]), 1.0, 0.0)


def check_surfaces(path, contacts, figures):
    """The mean pressures of faces lie within those at the points."""
    mean = np.asarray(pyvista.read(path).cell_data["contact_pressure"])
    within = np.max(mean, initial=0.0) <= np.max(contacts.point_data["contact_pressure"], initial=0.0) * (1.0 + ROUNDING)
    figures.add("pressure on faces within that at points", 0.0 if within else 1.0, 0.0, 1.0, 0.0)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("directory", type=Path)
    parser.add_argument("--tolerance", type=float, default=1e-6, help="residual tolerance of the run")
    arguments = parser.parse_args()
    directory = arguments.directory
    summary = json.loads((directory / "summary.json").read_text())
    with open(directory / "history.csv", newline="") as file:
        # Units stand behind the names of columns where the deck names them.
        history = [{name.split(" [")[0]: value for name, value in row.items()} for row in csv.DictReader(file)]
    series = {name: frames(directory, name) for name in ("bodies", "points", "contacts", "tools", "surfaces", "deformed")}
    figures, grids = Figures(), {}
    for time, path in series["bodies"].items():
        bodies, points = read(path, figures), read(series["points"][time], figures)
        grids[time] = bodies
        contacts = read(series["contacts"][time], figures) if time in series["contacts"] else None
        if time in series["tools"]:
            read(series["tools"][time], figures)
        check_equilibrium(bodies, points, contacts, summary["space"], figures, arguments.tolerance)
        if time in series["surfaces"]:
            read(series["surfaces"][time], figures)
            check_surfaces(series["surfaces"][time], contacts, figures)
        row = row_at(history, time)
        if row is not None:
            check_reactions(bodies, row, figures)
            if contacts is not None:
                check_contacts(contacts, summary["contact_order"], row, figures)
    check_deformed(series["deformed"], grids, figures)
    if (directory / "results.xdmf").exists():
        check_xdmf(directory / "results.xdmf", grids, figures)
    count = len(series["bodies"])
    print(f"{summary['title'] or directory}: {summary['status']}, {count} frames, {len(history)} rows")
    good = figures.report()
    sys.exit(0 if good and count > 0 else 1)


if __name__ == "__main__":
    main()
