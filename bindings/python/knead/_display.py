"""How documents, shapes and splines show themselves in notebooks: turnable where scripts run, else as a drawing. All of it is
within the output, so that it is there in saved notebooks and converted pages, without a server and without the network."""

from __future__ import annotations

import base64
import json
import pathlib
from typing import Any, NamedTuple

import numpy as np

from ._arrays import Array

# Points of all surfaces together: some 8 bytes each, and a third more as text.
_most_points = 40_000


def _quoted(text: str) -> str:
    for character, name in (("&", "amp"), ("<", "lt"), (">", "gt"), ('"', "quot")):
        text = text.replace(character, f"&{name};")
    return text


class Part(NamedTuple):
    """A surface as a grid of points (m, n, 3), or a curve (m, 3), and by how much its points have moved, if that is known."""

    points: Array
    moved: Array | None


def _lines(domain: tuple[float, float], knots: Array, count: int) -> Array:
    """Even parameters, and the knots, so that corners are where they are."""
    inside = knots[(knots > domain[0]) & (knots < domain[1])]
    even = np.linspace(*domain, count)
    lines: Array = np.unique(np.concatenate([even, inside])) if len(inside) < count else even
    return lines


def _of_surface(surface: Any, opened: Any, count: int) -> Part:
    us, vs = (_lines(d, k, count) for d, k in zip(surface.domain, surface.knots))
    points = surface.grid(us, vs)
    if opened is None:
        return Part(points, None)
    apart = points - opened.grid(us, vs)
    sign = np.sign(np.einsum("...k,...k", apart, surface.normals(us[:, None], vs)))
    return Part(points, np.linalg.norm(apart, axis=-1) * np.where(sign < 0, -1.0, 1.0))


def parts_of(splines: list[tuple[Any, Any]]) -> list[Part]:
    """Of splines, and what they were as opened (or None)."""
    sheets = sum({1: 0, 2: 1, 3: 6}[s._directions] for s, _ in splines)
    count = int(np.clip(np.sqrt(_most_points / max(sheets, 1)), 4, 64))
    parts = []
    for spline, opened in splines:
        if spline._directions == 1:
            parts.append(Part(spline.grid(_lines(spline.domain, spline.knots, 200)), None))
        elif spline._directions == 2:
            parts.append(_of_surface(spline, opened, count))
        else:
            lines = [_lines(d, k, min(count, 24)) for d, k in zip(spline.domain, spline.knots)]
            for direction in range(3):
                for end in spline.domain[direction]:
                    at = [np.array([end]) if d == direction else lines[d] for d in range(3)]
                    parts.append(Part(spline.grid(*at).squeeze(direction), None))
    return parts


def _range(parts: list[Part]) -> float:
    return max((float(abs(p.moved).max()) for p in parts if p.moved is not None), default=0.0)


def _box(parts: list[Part]) -> tuple[Array, float]:
    corners = np.array([f(p.points.reshape(-1, 3), axis=0) for p in parts for f in (np.min, np.max)])
    lower, upper = corners.min(axis=0), corners.max(axis=0)
    return (lower + upper) / 2, max(float(np.linalg.norm(upper - lower)) / 2, 1e-300)


def _packed(array: Any) -> str:
    return base64.b64encode(np.ascontiguousarray(array).tobytes()).decode()


def svg_of(parts: list[Part], caption: str) -> str:
    """Lines of the surfaces, seen from above at an angle; red and blue where they have moved along and against the normal."""
    if not parts:
        return "<svg xmlns='http://www.w3.org/2000/svg' width='1' height='1'/>"
    middle, size = _box(parts)
    turn = np.array([[0.8, 0.6, 0.0], [-0.36, 0.48, 0.8]]).T
    most, width, height = _range(parts), 480, 360
    drawn = []
    for part in parts:
        flat = (part.points - middle) @ turn * (0.48 * height / size)
        flat = np.stack([width / 2 + flat[..., 0], height / 2 - flat[..., 1]], axis=-1)
        rows = [(flat, part.moved)] if flat.ndim == 2 else []
        if flat.ndim == 3:
            m, n = (np.unique(np.linspace(0, k - 1, min(k, 16)).astype(int)) for k in flat.shape[:2])
            rows += [(flat[i], None if part.moved is None else part.moved[i]) for i in m]
            rows += [(flat[:, j], None if part.moved is None else part.moved[:, j]) for j in n]
        for row, moved in rows:
            value = 0.0 if moved is None or most == 0 else float(moved[np.argmax(abs(moved))]) / most
            pale = int(150 * (1 - abs(value)))
            colour = f"#{220 if value > 0 else pale:02x}{pale:02x}{220 if value < 0 else pale:02x}"
            drawn.append(f'<polyline fill="none" stroke="{colour}" points="{" ".join(f"{x:.1f},{y:.1f}" for x, y in row)}"/>')
    text = f'<text x="8" y="{height - 8}" font-family="sans-serif" font-size="12">{_quoted(caption)}</text>'
    return (f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}">'
            f'{"".join(drawn)}{text}</svg>')


def html_of(parts: list[Part], caption: str, unit: str) -> str:
    if not parts:
        return f"<p>{_quoted(caption)}</p>"
    middle, size = _box(parts)
    most = _range(parts)
    listed = []
    for part in parts:
        places = np.round((part.points - middle) / size * 32767).astype("<i2")
        values = np.zeros(part.points.shape[:-1], dtype="i1")
        if part.moved is not None and most > 0:
            values = np.round(part.moved / most * 127).astype("i1")
        listed.append({"shape": part.points.shape[:-1], "points": _packed(places), "values": _packed(values)})
    data = {"parts": listed, "most": most, "unit": unit, "caption": caption}
    script = (pathlib.Path(__file__).parent / "_display.js").read_text(encoding="utf-8")
    text = json.dumps(data).replace("</", "<\\/")  # a label must not end the script
    page = ("<!doctype html><meta charset='utf-8'><style>body{margin:0;font:12px sans-serif;overflow:hidden}"
            "canvas{width:100%;height:100vh;cursor:grab;display:block}#legend{position:absolute;right:8px;top:8px}"
            "#caption{position:absolute;left:8px;bottom:8px}</style>"
            f"<noscript>{svg_of(parts, caption)}</noscript><canvas></canvas><div id='legend'></div><div id='caption'></div>"
            f"<script>{script}\nshow({text})</script>")
    return (f'<iframe srcdoc="{_quoted(page)}" title="{_quoted(caption)}" '
            'style="width:100%;max-width:640px;height:420px;border:1px solid #ccc"></iframe>')


class Display:
    """Shows itself as the last line of a cell."""

    __slots__ = ()

    def _shown(self) -> tuple[list[tuple[Any, Any]], str, str]:
        """Splines with what they were as opened, a caption, the unit of lengths."""
        return [(self, None)], repr(self).strip("<>"), ""

    def _repr_html_(self) -> str:
        splines, caption, unit = self._shown()
        return html_of(parts_of(splines), caption, unit)

    def _repr_svg_(self) -> str:
        splines, caption, _ = self._shown()
        return svg_of(parts_of(splines), caption)
