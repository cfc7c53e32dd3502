"""Matrices of splines, as SciPy has them: SciPy is imported when one is asked for."""

from __future__ import annotations

from importlib import import_module
from typing import Any, NamedTuple

import numpy as np

from . import _core
from ._arrays import Array, ArrayLike, chosen, number, numbers, whole, wrong_shape
from .splines import Surface


class Matrices(NamedTuple):
    """M ẍ + D ẋ + K x = F for each coordinate, on the control points that are free: K, M, D `scipy.sparse.csc_array`, F
    (free, 3), and the numbers of the free control points; (i, j) of an m × n net is number i n + j."""

    stiffness: Any
    mass: Any
    damping: Any
    load: Array
    free: Any


def _columns(parts: Any) -> Any:
    sparse: Any = import_module("scipy.sparse")
    *arrays, shape = parts
    return sparse.csc_array(tuple(np.asarray(array) for array in arrays), shape=shape, copy=False)


def of_parts(parts: Any) -> Matrices:
    """In the memory that they are in."""
    stiffness, mass, damping, load, free = parts
    return Matrices(_columns(stiffness), _columns(mass), _columns(damping), np.asarray(load), np.asarray(free))


def normalised(units: str) -> bool:
    return chosen(units, "units", ("raw", "normalised")) == "normalised"


def _several(value: ArrayLike, name: str) -> tuple[float, ...]:
    array = numbers(value, name)
    if array.shape != (3,):
        raise wrong_shape(name, array.shape, "(3,)")
    return tuple(float(x) for x in array)


def matrices(surface: Surface, *, alpha: ArrayLike = (1, 0, 1), beta: ArrayLike = (0.01, 0.01, 0.01), mass: float = 1,
             damping: float = 1, load: ArrayLike = (0, 0, 1), hold: int = 0, units: str = "raw",
             tolerance: float = 1e-10) -> Matrices:
    """Stiffness, mass, damping and load of a surface under the energy
    E = ∫ α11 |S_u|² + 2 α12 S_u·S_v + α22 |S_v|² + β11 |S_uu|² + 2 β12 |S_uv|² + β22 |S_vv|² = Σ Pᵀ K P.

    hold       rows of control points held on each side, which are left out
    units      "raw", or "normalised": coordinates and parameters in the units of the surface
    tolerance  of rational surfaces: the largest error of an entry, as a fraction of √(K_II K_JJ)
    """
    if not isinstance(surface, Surface):
        raise TypeError(f"surface must be a knead.Surface, not {type(surface).__name__}")
    return of_parts(_core.matrices(surface._core, _several(alpha, "alpha"), _several(beta, "beta"), number(mass, "mass"),
                                   number(damping, "damping"), _several(load, "load"), whole(hold, "hold"), normalised(units),
                                   number(tolerance, "tolerance")))


def gramian(knots: ArrayLike, degree: int, a: int = 0, b: int = 0) -> Any:
    """The Gramian G_ij = ∫ N_i^(a) N_j^(b) du over the domain, as a banded `scipy.sparse.dia_array`. Exact to the last
    digits; cost O(n p²)."""
    sparse: Any = import_module("scipy.sparse")
    vector = numbers(knots, "knots")
    if vector.ndim != 1:
        raise wrong_shape("knots", vector.shape, "(number of knots,)")
    offsets, diagonals = _core.gramian(whole(degree, "degree", 1), vector, whole(a, "a"), whole(b, "b"))
    data = np.asarray(diagonals)
    return sparse.dia_array((data, np.asarray(offsets)), shape=(data.shape[1], data.shape[1]))
