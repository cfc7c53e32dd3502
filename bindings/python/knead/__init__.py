"""Knead: freeform sculpting of exact B-spline and NURBS geometry.

    doc = knead.open("part.step")
    doc.select("#285").tool("ball", shape="sphere", radius=160, at=(0.4, 0.5)).step(30)
    doc.save("out.step")
"""

from ._core import set_thread_count, thread_count
from ._core import version as __version__
from ._errors import Error, Fix, InputError, MissingFileError, NumericalError
from .analysis import Analysis, Mode
from .document import Document, Shape, Snapshot, new, open
from .matrices import Matrices, gramian, matrices
from .report import Report
from .snakes import Snake, SurfaceSnake, snake
from .splines import Curve, CurveCurvature, Removal, Spline, Surface, SurfaceCurvature, Volume

__all__ = [
    "Analysis", "Curve", "CurveCurvature", "Document", "Error", "Fix", "InputError", "Matrices", "MissingFileError",
    "Mode", "NumericalError", "Removal", "Report", "Shape", "Snake", "Snapshot", "Spline", "Surface", "SurfaceCurvature",
    "SurfaceSnake", "Volume", "__version__", "gramian", "matrices", "new", "open", "set_thread_count", "snake",
    "thread_count",
]
