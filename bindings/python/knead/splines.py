"""B-spline and NURBS curves, surfaces and volumes: immutable, in the exact form of CAD files.

S(u) = Σ_i R_i(u) P_i with R_i = N_i, or R_i = w_i N_i / Σ w N where there are weights; N_i is the product of one basis
function per direction.
"""

from __future__ import annotations

from typing import Any, ClassVar, NamedTuple, Sequence

import numpy as np

from . import _core
from ._arrays import Array, ArrayLike, chosen, count_of_derivatives, number, numbers, whole, wrong_shape
from ._display import Display

_empty = np.empty
_letters = "uvw"


def _from_left(side: str) -> bool:
    return chosen(side, "side", ("right", "left")) == "left"


class CurveCurvature(NamedTuple):
    """How a curve bends: κ = |C' × C''| / |C'|³ and unit vectors; the normal points to the centre of curvature, and is zero
    where the curve is straight. Shapes: (…), (…, 3), (…, 3)."""

    curvature: Array
    tangent: Array
    normal: Array


class SurfaceCurvature(NamedTuple):
    """How a surface bends, positive towards the normal S_u × S_v: H, K, κ₁ ≥ κ₂ and unit vectors. Shapes: (…), (…),
    (…, 2), (…, 3), (…, 2, 3)."""

    mean: Array
    gaussian: Array
    principal: Array
    normal: Array
    directions: Array


class Removal(NamedTuple):
    """A spline on fewer knots, the knots that were removed, and a bound on how far any of its points has moved."""

    spline: Any
    removed: Array
    error_bound: float


class Spline(Display):
    """What curves, surfaces and volumes have in common. Two splines are equal if all their numbers are.

    Evaluation is defined on the closed domain. At a knot derivatives are the limits from `side`, "right" or "left", in
    every direction; at the ends of the domain those from inside. A parameter outside of it is a `knead.Error`.
    """

    __slots__ = ("_core", "_search", "__weakref__")
    _kind: ClassVar[Any]
    _directions: ClassVar[int]

    def __init__(self, degree: Any, knots: Any, control_points: ArrayLike, weights: ArrayLike | None = None) -> None:
        several = self._directions > 1
        degrees = self._each(degree, "degree") if several else (degree,)
        vectors = self._each(knots, "knots") if several else (knots,)
        names = [f"knots[{d}]" if several else "knots" for d in range(self._directions)]
        checked = tuple(whole(p, f"degree[{d}]" if several else "degree", 1) for d, p in enumerate(degrees))
        lists = tuple(numbers(vector, name) for vector, name in zip(vectors, names))
        for vector, name in zip(lists, names):
            if vector.ndim != 1:
                raise wrong_shape(name, vector.shape, "(number of knots,)")
        points = numbers(control_points, "control_points")
        net = tuple(len(vector) - p - 1 for vector, p in zip(lists, checked))
        if min(net) > 0 and points.shape != (*net, 3):
            raise wrong_shape("control_points", points.shape, f"{(*net, 3)}: as many as knots and degree say")
        factors = None if weights is None else numbers(weights, "weights")
        if factors is not None and factors.shape != points.shape[:-1]:
            raise wrong_shape("weights", factors.shape, f"{points.shape[:-1]}: one for each control point")
        self._core = self._kind.create(checked, lists, points, factors)
        self._search: Any = None

    def _each(self, value: Any, name: str) -> tuple[Any, ...]:
        """One for every direction; a number stands for all of them."""
        if hasattr(value, "__index__") and np.ndim(value) == 0:
            return (value,) * self._directions
        try:
            items = tuple(value)
        except TypeError:
            items = ()
        if len(items) != self._directions:
            raise TypeError(f"{name} must be a sequence of {self._directions}, one for every direction")
        return items

    @classmethod
    def _of(cls, core: Any) -> Any:
        spline = cls.__new__(cls)
        spline._core, spline._search = core, None
        return spline

    def _alone(self, values: Sequence[Any]) -> Any:
        """Of a curve, which has one direction, the value itself."""
        return values[0] if self._directions == 1 else tuple(values)

    @property
    def degree(self) -> Any:
        """Of a curve a number, else one for every direction."""
        return self._alone(self._core.degree)

    @property
    def _knots(self) -> list[Array]:
        return [np.asarray(self._core.knots(d)) for d in range(self._directions)]

    @property
    def knots(self) -> Any:
        """The knot vector, or one for every direction: read-only views."""
        return self._alone(self._knots)

    @property
    def control_points(self) -> Array:
        """(m, 3), (m, n, 3) or (m, n, l, 3), Cartesian: a read-only view."""
        return np.asarray(self._core.control_points())

    @property
    def weights(self) -> Array | None:
        """One for every control point, a read-only view; None of a polynomial spline."""
        view = self._core.weights()
        return None if view is None else np.asarray(view)

    @property
    def rational(self) -> bool:
        """Whether it was made with weights, even if all are equal."""
        return self._core.weights() is not None

    @property
    def net(self) -> Any:
        """How many control points there are in each direction."""
        return self._alone(self.control_points.shape[:-1])

    @property
    def domain(self) -> Any:
        """(lower, upper), of surfaces and volumes for every direction."""
        return self._alone([(float(k[p]), float(k[len(k) - p - 1])) for k, p in zip(self._knots, self._core.degree)])

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Spline) or self._directions != other._directions:
            return NotImplemented
        mine: Any = self.weights
        others: Any = other.weights
        return (self._core.degree == other._core.degree and np.array_equal(self.control_points, other.control_points)
                and all(np.array_equal(a, b) for a, b in zip(self._knots, other._knots))
                and (mine is None) == (others is None) and (mine is None or bool(np.array_equal(mine, others))))

    def __hash__(self) -> int:
        return hash((self._core.degree, self.control_points.shape, (self.control_points + 0.0).tobytes()))

    def __copy__(self) -> Any:
        return self

    def __deepcopy__(self, memo: object) -> Any:
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        knots = self._alone([np.array(k) for k in self._knots])
        weights = self.weights
        return type(self), (self.degree, knots, np.array(self.control_points), None if weights is None else np.array(weights))

    def __repr__(self) -> str:
        form = "rational" if self.rational else "polynomial"
        return f"<knead.{type(self).__name__}: degree {self.degree}, net {self.net}, {form}>"

    def _places(self, parameters: Sequence[ArrayLike]) -> tuple[list[Array], tuple[int, ...]]:
        """The parameters of scattered points, one after the other, and the shape that they have together."""
        arrays = [numbers(p, name) for p, name in zip(parameters, _letters)]
        try:
            together = np.broadcast_arrays(*arrays)
        except ValueError:
            shapes = " and ".join(str(a.shape) for a in arrays)
            raise wrong_shape(" and ".join(_letters[:len(arrays)]), arrays[0].shape, f"one that fits the others: {shapes}") from None
        return [np.ascontiguousarray(a).reshape(-1) for a in together], together[0].shape

    def _lines(self, parameters: Sequence[ArrayLike]) -> tuple[list[Array], tuple[int, ...]]:
        """The parameters of the lines of a grid, and its shape."""
        arrays = [numbers(p, name + "s") for p, name in zip(parameters, _letters)]
        for array, name in zip(arrays, _letters):
            if array.ndim != 1:
                raise wrong_shape(name + "s", array.shape, "(number of lines,)")
        return arrays, tuple(len(a) for a in arrays)

    def _evaluated(self, at: list[Array], shape: tuple[int, ...], order: Any, side: str, grid: bool, out: Any) -> Any:
        order = whole(order, "order")
        left = _from_left(side)
        counts = [count_of_derivatives(self._directions, k) for k in range(order + 1)]
        if out is None:
            memory = _empty((sum(counts), *shape, 3))
            self._core.evaluate(at, order, left, grid, list(memory))
            results, first = [], 0
            for k, count in enumerate(counts):
                several = self._directions > 1 and k > 0
                results.append(np.moveaxis(memory[first:first + count], 0, -2) if several else memory[first])
                first += count
            return results[0] if order == 0 else tuple(results)
        given = [out] if order == 0 else list(out)
        if len(given) != order + 1:
            raise TypeError(f"out must be {order + 1} arrays, as evaluation to order {order} returns them")
        parts: list[Array] = []
        for k, (array, count) in enumerate(zip(given, counts)):
            several = self._directions > 1 and k > 0
            wanted = (*shape, count, 3) if several else (*shape, 3)
            if not isinstance(array, np.ndarray) or array.dtype != np.float64 or not array.flags.writeable:
                raise TypeError("out must be a writable array of float64" if order == 0 else
                                f"out[{k}] must be a writable array of float64")
            if array.shape != wanted:
                raise wrong_shape("out" if order == 0 else f"out[{k}]", array.shape, str(wanted))
            parts += [array[..., j, :] for j in range(count)] if several else [array]
        whole_parts = [part if part.flags.c_contiguous else _empty(part.shape) for part in parts]
        self._core.evaluate(at, order, left, grid, whole_parts)
        for part, whole_part in zip(parts, whole_parts):
            if part is not whole_part:
                part[...] = whole_part
        return out

    def _nearest(self, points: ArrayLike) -> tuple[Array, Array]:
        places = numbers(points, "points")
        if places.ndim < 1 or places.shape[-1] != 3:
            raise wrong_shape("points", places.shape, "(…, 3)")
        shape = places.shape[:-1]
        parameters, distances = _empty((*shape, self._directions)), _empty(shape)
        if self._search is None:
            self._search = self._core.search()
        self._search.nearest(places, parameters, distances)
        return (parameters[..., 0] if self._directions == 1 else parameters), distances

    def _direction(self, direction: Any) -> int:
        if isinstance(direction, str) and direction in _letters[:self._directions] and direction:
            return _letters.index(direction)
        known = " or ".join(repr(name) for name in _letters[:self._directions])
        raise TypeError(f"direction must be {known}, not {direction!r}")

    def coarsened(self, direction: str, tolerance: float) -> Removal:
        """Without knots of a direction ("u", "v", "w"), as long as no point S(u) moves by more than the tolerance (a
        length). Greedy: the knot whose removal needs the smallest change goes first."""
        core, removed, bound = self._core.without_knots(self._direction(direction), number(tolerance, "tolerance"))
        return Removal(type(self)._of(core), np.asarray(removed), bound)

    def _refined(self, inserted: Sequence[ArrayLike]) -> Any:
        lists = []
        for knots, name in zip(inserted, _letters):
            lists.append(np.atleast_1d(numbers(knots, name)))
            if lists[-1].ndim != 1:
                raise wrong_shape(name, lists[-1].shape, "(number of knots,)")
        return type(self)._of(self._core.inserted(lists))

    def _elevated(self, times: Sequence[int]) -> Any:
        core = self._core
        for direction, (count, name) in enumerate(zip(times, _letters)):
            if whole(count, name) > 0:
                core = core.elevated(direction, whole(count, name))
        return type(self)._of(core)


class Curve(Spline):
    """A curve C(u): degree p, n + p + 1 knots, (n, 3) control points, n weights or None."""

    __slots__ = ()
    _kind, _directions = _core.Curve, 1

    def __call__(self, u: ArrayLike) -> Array:
        """C(u), of shape (…, 3)."""
        if type(u) is float:
            out = _empty(3)
            self._core.point(out, u)
            return out
        points: Array = self.evaluate(u)
        return points

    def evaluate(self, u: ArrayLike, *, order: int = 0, side: str = "right", out: Any = None) -> Any:
        """C(u), of shape (…, 3); with an order above 0 the tuple of C and its derivatives to that order. `out`: arrays of
        these shapes, whose memory is used."""
        return self._evaluated(*self._places((u,)), order, side, False, out)

    def grid(self, us: ArrayLike, *, order: int = 0, side: str = "right", out: Any = None) -> Any:
        """As `evaluate`, many points at once, with the same bits."""
        return self._evaluated(*self._lines((us,)), order, side, True, out)

    def curvature(self, u: ArrayLike, *, side: str = "right") -> CurveCurvature:
        """Curvature, tangent and principal normal. Error: C' = 0 somewhere (numerical)."""
        at, shape = self._places((u,))
        out = _empty((*shape, 7))
        self._core.curvatures(at, _from_left(side), out)
        return CurveCurvature(out[..., 0], out[..., 1:4], out[..., 4:7])

    def closest(self, points: ArrayLike) -> tuple[Array, Array]:
        """Of points (…, 3) the parameters (…) of the nearest points, and their distances (…)."""
        return self._nearest(points)

    def refined(self, u: ArrayLike = ()) -> Curve:
        """The same curve with these knots inserted."""
        result: Curve = self._refined((u,))
        return result

    def elevated(self, u: int = 1) -> Curve:
        """The same curve with the degree raised."""
        result: Curve = self._elevated((u,))
        return result


class Surface(Spline):
    """A surface S(u, v): two degrees, two knot vectors, an (m, n, 3) net, (m, n) weights or None."""

    __slots__ = ()
    _kind, _directions = _core.Surface, 2

    def __call__(self, u: ArrayLike, v: ArrayLike) -> Array:
        """S(u, v), of shape (…, 3), u and v broadcast together."""
        if type(u) is float and type(v) is float:
            out = _empty(3)
            self._core.point(out, u, v)
            return out
        points: Array = self.evaluate(u, v)
        return points

    def evaluate(self, u: ArrayLike, v: ArrayLike, *, order: int = 0, side: str = "right", out: Any = None) -> Any:
        """S(u, v), of shape (…, 3), u and v broadcast together; with an order above 0 the tuple of S, its first derivatives
        (…, 2, 3), where [..., 0, :] is S_u and [..., 1, :] is S_v, the second (…, 3, 3), S_uu, S_uv, S_vv, and so on.
        `out`: arrays of these shapes, whose memory is used."""
        return self._evaluated(*self._places((u, v)), order, side, False, out)

    def grid(self, us: ArrayLike, vs: ArrayLike, *, order: int = 0, side: str = "right", out: Any = None) -> Any:
        """As `evaluate`, at all combinations of us and vs: (len(us), len(vs), 3). A point costs about p + 1 terms."""
        return self._evaluated(*self._lines((us, vs)), order, side, True, out)

    def curvature(self, u: ArrayLike, v: ArrayLike, *, side: str = "right") -> SurfaceCurvature:
        """Mean, Gaussian and principal curvatures with their directions. Error: no tangent plane somewhere, as at a pole
        (numerical)."""
        at, shape = self._places((u, v))
        out = _empty((*shape, 13))
        self._core.curvatures(at, _from_left(side), out)
        return SurfaceCurvature(out[..., 0], out[..., 1], out[..., 2:4], out[..., 4:7], out[..., 7:].reshape(*shape, 2, 3))

    def normals(self, u: ArrayLike, v: ArrayLike, *, side: str = "right") -> Array:
        """Unit normals S_u × S_v / |S_u × S_v|, of shape (…, 3); zero where there is no tangent plane."""
        at, shape = self._places((u, v))
        out = _empty((*shape, 3))
        self._core.normals(at, _from_left(side), out)
        return out

    def closest(self, points: ArrayLike) -> tuple[Array, Array]:
        """Of points (…, 3) the parameters (…, 2) of the nearest points, and their distances (…): the global minimum, by
        branch and bound. What is prepared for it is kept."""
        return self._nearest(points)

    def refined(self, u: ArrayLike = (), v: ArrayLike = ()) -> Surface:
        """The same surface with these knots inserted."""
        result: Surface = self._refined((u, v))
        return result

    def elevated(self, u: int = 0, v: int = 0) -> Surface:
        """The same surface with degrees raised."""
        result: Surface = self._elevated((u, v))
        return result


class Volume(Spline):
    """A volume V(u, v, w): three degrees, three knot vectors, an (m, n, l, 3) net, weights or None."""

    __slots__ = ()
    _kind, _directions = _core.Volume, 3

    def __call__(self, u: ArrayLike, v: ArrayLike, w: ArrayLike) -> Array:
        """V(u, v, w), of shape (…, 3), the parameters broadcast together."""
        if type(u) is float and type(v) is float and type(w) is float:
            out = _empty(3)
            self._core.point(out, u, v, w)
            return out
        points: Array = self.evaluate(u, v, w)
        return points

    def evaluate(self, u: ArrayLike, v: ArrayLike, w: ArrayLike, *, order: int = 0, side: str = "right",
                 out: Any = None) -> Any:
        """V, of shape (…, 3); with an order above 0 the tuple of V, its first derivatives (…, 3, 3), and so on, as of
        surfaces: of the same order those more often by u first."""
        return self._evaluated(*self._places((u, v, w)), order, side, False, out)

    def grid(self, us: ArrayLike, vs: ArrayLike, ws: ArrayLike, *, order: int = 0, side: str = "right",
             out: Any = None) -> Any:
        """As `evaluate`, at all combinations: (len(us), len(vs), len(ws), 3)."""
        return self._evaluated(*self._lines((us, vs, ws)), order, side, True, out)

    def refined(self, u: ArrayLike = (), v: ArrayLike = (), w: ArrayLike = ()) -> Volume:
        """The same volume with these knots inserted."""
        result: Volume = self._refined((u, v, w))
        return result

    def elevated(self, u: int = 0, v: int = 0, w: int = 0) -> Volume:
        """The same volume with degrees raised."""
        result: Volume = self._elevated((u, v, w))
        return result


def of_core(core: Any) -> Any:
    """The spline of one of the module's."""
    kinds = {_core.Curve: Curve, _core.Surface: Surface, _core.Volume: Volume}
    return kinds[type(core)]._of(core)
