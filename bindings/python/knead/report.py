"""What the commands of a document have made of it."""

from __future__ import annotations

import json
from typing import Any

import numpy as np


class Report:
    """What the commands have made of a document, at the time it was asked for. Times in seconds, lengths in file units."""

    def __init__(self, text: str) -> None:
        self._read: dict[str, Any] = json.loads(text)

    @property
    def steps(self) -> Any:
        """A structured array, one record for each step: `steps["residual"]`, "time", "energy", "stretch", "bend", "kinetic",
        "contact", "gap", "largest_displacement", "constraint_violation", and the flags "converged", "limited"; "load_factor"
        and "energy_error" are NaN where there are none."""
        floats = ("time", "energy", "residual", "largest_displacement", "stretch", "bend", "kinetic", "contact", "gap",
                  "constraint_violation", "load_factor", "energy_error")
        kinds = [(name, np.float64) for name in floats] + [("converged", np.bool_), ("limited", np.bool_)]
        rows = self._read["steps"]
        table = np.empty(len(rows), dtype=kinds)
        for name in floats:
            table[name] = [np.nan if row.get(name) is None else row[name] for row in rows]
        for name in ("converged", "limited"):
            table[name] = [row[name] for row in rows]
        table.flags.writeable = False
        return table

    @property
    def edges(self) -> list[dict[str, Any]]:
        """Of every surface with known edges of faces: how they are held, and how far the surface is from them."""
        edges: list[dict[str, Any]] = self._read["edges"]
        return edges

    @property
    def seams(self) -> list[dict[str, Any]]:
        seams: list[dict[str, Any]] = self._read["seams"]
        return seams

    @property
    def notes(self) -> list[str]:
        """What commands did besides what they were asked for."""
        notes: list[str] = self._read["notes"]
        return notes

    @property
    def energy_before(self) -> float | None:
        energy: float | None = self._read["energy_before"]
        return energy

    @property
    def energy_after(self) -> float | None:
        energy: float | None = self._read["energy_after"]
        return energy

    @property
    def largest_displacement(self) -> float:
        return float(self._read["largest_displacement"])

    @property
    def control_points_moved(self) -> int:
        return int(self._read["control_points_moved"])

    def to_dict(self) -> dict[str, Any]:
        """All of it, as `knead sculpt --report` writes it."""
        copied: dict[str, Any] = json.loads(json.dumps(self._read))
        return copied

    def __repr__(self) -> str:
        return (f"<knead.Report: {len(self._read['steps'])} steps, largest displacement {self.largest_displacement:.6g}, "
                f"{self.control_points_moved} control points moved>")
