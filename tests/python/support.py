"""What several tests use."""

import os
import pathlib
import shutil
import sys

import numpy as np

import knead

FOLDER = pathlib.Path(__file__).resolve().parent


def near(*names):
    """The first that is there: beside the tests where they were copied to, or in the project."""
    return next(p for p in (root / name for root in (FOLDER.parent, FOLDER.parents[1]) for name in names) if p.exists())


SAMPLES = near("samples")
BONNET = SAMPLES / "bonnet.step"
# The program in the wheel, and the one built for itself where KNEAD_PROGRAM names it.
PROGRAM = shutil.which("knead", path=os.path.dirname(sys.executable))
PROGRAMS = [program for program in (PROGRAM, os.environ.get("KNEAD_PROGRAM")) if program]


def clamped(degree, spans):
    return np.concatenate([np.zeros(degree), np.arange(spans + 1.0), np.full(degree, float(spans))])


def surface(degree=(3, 2), spans=(4, 5), weights=False, seed=1):
    random = np.random.default_rng(seed)
    knots = tuple(clamped(p, n) for p, n in zip(degree, spans))
    net = tuple(p + n for p, n in zip(degree, spans))
    points = random.normal(size=(*net, 3))
    points[..., 0] += 4 * np.arange(net[0])[:, None]
    points[..., 1] += 4 * np.arange(net[1])[None, :]
    return knead.Surface(degree, knots, points, random.uniform(0.5, 2, net) if weights else None)


def sheet(net=(20, 20), size=(10, 10)):
    """A flat sheet held at its edges, and a ball above it."""
    doc = knead.new("sheet").new(size=size, net=net).hold(1)
    return doc.tool("ball", shape="sphere", radius=2, position=(5, 5, 1.5))


def basis(knots, degree, u):
    """Cox and de Boor, by their recursion."""
    last = knots[-degree - 1]
    values = [float(a <= u < b or (u == last and a < b == last)) for a, b in zip(knots, knots[1:])]
    for p in range(1, degree + 1):
        values = [(0 if knots[i + p] == knots[i] else (u - knots[i]) / (knots[i + p] - knots[i]) * values[i])
                  + (0 if knots[i + p + 1] == knots[i + 1] else
                     (knots[i + p + 1] - u) / (knots[i + p + 1] - knots[i + 1]) * values[i + 1])
                  for i in range(len(values) - 1)]
    return np.array(values)
