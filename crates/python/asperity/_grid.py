"""Grids for PyVista and frames for pandas, where these are installed."""

from __future__ import annotations

from typing import Any

import numpy as np


def unstructured(parts: dict[str, Any]) -> Any:
    """A grid of VTK as PyVista has it."""
    try:
        import pyvista
    except ImportError as error:
        raise ImportError("grid() needs PyVista: pip install pyvista") from error
    offsets = parts["offsets"]
    starts = np.concatenate(([0], offsets[:-1])) if len(offsets) else offsets
    cells = np.insert(parts["connectivity"], starts, offsets - starts)
    grid = pyvista.UnstructuredGrid(cells, parts["types"], parts["points"])
    for name, values in parts["point_data"].items():
        grid.point_data[name] = values
    for name, values in parts["cell_data"].items():
        grid.cell_data[name] = values
    return grid


def frame(columns: dict[str, Any], wanted: bool | None) -> Any:
    """Columns as a DataFrame where pandas is installed, or as they are."""
    if wanted is False:
        return columns
    try:
        import pandas
    except ImportError as error:
        if wanted:
            raise ImportError("history(frame=True) needs pandas: pip install pandas") from error
        return columns
    return pandas.DataFrame(columns)
