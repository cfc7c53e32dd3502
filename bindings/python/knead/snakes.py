"""Active contours in pictures, active surfaces in volumes (docs/snakes.md, docs/voxels.md)."""

from __future__ import annotations

from typing import Any, Mapping

import numpy as np

from . import _core
from ._arrays import Array, ArrayLike, numbers, wrong_shape
from ._progress import Progress, callback
from ._json import encode
from .splines import Curve, Surface, of_core


class Snake:
    """A contour: `curve` in the plane z = 0, x along the columns and y along the rows, in pixels; `mask`, what is inside of a
    closed one; how it came to rest."""

    def __init__(self, curve: Any, closed: bool, iterations: int, converged: bool, last_motion: float, crossings: int,
                 mask: Any) -> None:
        self.curve: Curve = of_core(curve)
        self.closed, self.iterations, self.converged = closed, iterations, converged
        self.last_motion, self.crossings = last_motion, crossings
        self.mask = np.asarray(mask) >= 0.5

    def __repr__(self) -> str:
        return f"<knead.Snake: {self.iterations} iterations, {'at rest' if self.converged else 'not at rest'}>"


class SurfaceSnake:
    """A closed surface in a volume: `surface`, its `form` ("sphere", "torus"), `area` and `volume`, and the `mask` of the
    voxels inside."""

    def __init__(self, surface: Any, form: str, iterations: int, converged: bool, last_motion: float, crossings: int,
                 area: float, volume: float, mask: Any) -> None:
        self.surface: Surface = of_core(surface)
        self.form, self.iterations, self.converged = form, iterations, converged
        self.last_motion, self.crossings, self.area, self.volume = last_motion, crossings, area, volume
        self.mask = np.asarray(mask) >= 0.5

    def __repr__(self) -> str:
        return f"<knead.SurfaceSnake: {self.form}, {self.iterations} iterations>"


def _grey(values: Any, name: str) -> Array:
    """White is 1: whole numbers count from 0 to the most that they can be."""
    kind = np.asarray(values).dtype
    array = numbers(values, name)
    return array / np.iinfo(kind).max if kind.kind == "u" else array


def _starts(start: Any, closed: bool) -> tuple[list[dict[str, Any]], bool]:
    """Starts in the form of scripts, and whether there are several."""
    if isinstance(start, Mapping):
        return [dict(start)], False
    if isinstance(start, (list, tuple)) and start and all(isinstance(item, Mapping) for item in start):
        return [dict(item) for item in start], True
    points = numbers(start, "start")
    if points.ndim != 2 or points.shape[1] != 2:
        raise wrong_shape("start", points.shape, "(number of points, 2), x and y in pixels")
    return [{"shape": "points", "points": points, "closed": bool(closed)}], False


def snake(picture: ArrayLike, start: Any = None, *, closed: bool = True, image: Mapping[str, Any] | None = None,
          mask: ArrayLike | None = None, spacing: ArrayLike = (1, 1, 1), origin: ArrayLike = (0, 0, 0),
          blobs: Mapping[str, Any] | None = None, progress: Progress = None, **settings: Any) -> Any:
    """Lets a contour (2-D array) or a closed surface (3-D array) find a shape.

    picture   grey values, white being 1; unsigned whole numbers count to the most that they can be. [row, column], or
              [k, j, i] of voxel (i, j, k)
    start     points [(x, y), …] of one contour, or the snakes of a script: {"centre": …, "radii": …}, or a list of these.
              In volumes it may be left out: a sphere in nearly all of it
    image     what attracts, as in scripts: {"edge": 1, "region": 0, …}
    mask      what {"distance": …} counts from
    spacing, origin  of voxels along x, y, z
    settings  further ones of scripts, by name: alpha, beta, gamma, control_points, balloon, max_iterations, …

    A `Snake` or a `SurfaceSnake`; of several starts a list. At Ctrl+C contours stop within 0.2 s, and nothing is returned;
    surfaces are not interrupted. Errors name the field.
    """
    values = _grey(picture, "picture")
    drawn = None if mask is None else numbers(mask, "mask")
    if values.ndim not in (2, 3):
        raise wrong_shape("picture", values.shape, "(rows, columns), or (nz, ny, nx)")
    if drawn is not None and drawn.shape != values.shape:
        raise wrong_shape("mask", drawn.shape, f"{values.shape}, that of the picture")
    script: dict[str, Any] = {"knead": 2}
    several = blobs is not None
    if start is not None:
        script["snakes"], many = _starts(start, closed)
        several = several or many
    for name, value in (("image", image), ("blobs", blobs), ("settings", settings)):
        if value or (name == "blobs" and value is not None):
            script[name] = dict(value or {})
    if values.ndim == 2:
        contours = [Snake(*made) for made in _core.image_snakes(values, encode("snake", script), drawn, callback(progress))]
        return contours if several else contours[0]
    steps = np.broadcast_to(numbers(spacing, "spacing"), (3,))
    frame = np.ascontiguousarray(np.diag(steps))
    place = np.ascontiguousarray(np.broadcast_to(numbers(origin, "origin"), (3,)))
    text = "" if len(script) == 1 else encode("snake", script)
    surfaces = [SurfaceSnake(*made) for made in _core.volume_snakes(values, place, frame, text, drawn)]
    return surfaces if several else surfaces[0]
