"""Results of an analysis, as named arrays."""

from __future__ import annotations

import os
from importlib import import_module
from typing import Any, Iterator, Mapping, NamedTuple

import numpy as np

from . import _core
from ._arrays import Array


class Mode(NamedTuple):
    """A frequency, or a factor of the load, and its relative residual."""

    value: float
    residual: float


class Field(Mapping[str, Array]):
    """Arrays by name on a grid of one surface: `points` (m, n, 3), `displacement` (m, n, 3); of shells `membrane`,
    `moment`, `von_mises` (m, n, 2) and `bending_strain` (m, n); of modes `mode_1`, …, `buckling_1`, … (m, n, 3)."""

    def __init__(self, id: str, points: Array, fields: dict[str, Array]) -> None:
        self.id = id
        self._arrays = {"points": points, **fields}

    def __getitem__(self, name: str) -> Array:
        return self._arrays[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._arrays)

    def __len__(self) -> int:
        return len(self._arrays)

    def __repr__(self) -> str:
        return f"<{self.id}: {', '.join(self._arrays)}>"


class Analysis(Field):
    """The results on the first selected surface by name, as in `r["von_mises"]`; `surfaces` has those of all.

    reactions  what every hold of a shell exerts, (3,) by its name
    modes, buckling  what the commands of these names have found
    """

    def __init__(self, grids: Any, reactions: Any, modes: Any, buckling: Any) -> None:
        self._grids = grids
        self.surfaces = []
        for name, points, fields in grids.arrays():
            arrays = {}
            for field, view in fields:
                array = np.asarray(view)
                arrays[field] = array[..., 0] if array.shape[-1] == 1 else array
            self.surfaces.append(Field(name, np.asarray(points), arrays))
        first = self.surfaces[0]
        super().__init__(first.id, first["points"], {name: first[name] for name in first if name != "points"})
        self.reactions = {hold: np.array((x, y, z)) for hold, x, y, z in reactions}
        self.modes = [Mode(*mode) for mode in modes]
        self.buckling = [Mode(*mode) for mode in buckling]

    def to_vtu(self, path: str | os.PathLike[str]) -> None:
        """Writes all surfaces with their fields as VTK's unstructured grid, which ParaView opens."""
        _core.write_file(os.fspath(path), self._grids.vtu().encode())

    def to_pyvista(self) -> Any:
        """The same as a grid of PyVista, where that is installed."""
        import tempfile

        pyvista: Any = import_module("pyvista")
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "analysis.vtu")
            self.to_vtu(path)
            return pyvista.read(path)
