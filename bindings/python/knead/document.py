"""Documents: a file, the session that sculpts it, and what it has come to."""

from __future__ import annotations

import json
import os
from typing import Any, Iterator, Mapping, Sequence, TypeVar

from . import _core
from ._arrays import Array, chosen, number, whole
from ._commands import Commands, Queries
from ._display import Display
from ._errors import Error, Fix, InputError, MissingFileError
from ._json import encode
from ._progress import Progress, callback
from .analysis import Analysis
from .matrices import Matrices, normalised, of_parts
from .report import Report
from .splines import of_core

_Self = TypeVar("_Self", bound="Document")
File = Any  # its name, its bytes, an object with `read`, or a document
_max_unpacked = 1 << 30
_most_lines = 60  # of a document at a terminal
_schemas = ("ap214", "ap242")


class Shape(Display):
    """A surface, curve or volume of a document: its id, its label, and the spline that it is now."""

    __slots__ = ("_document", "_spline", "id", "label", "unit", "kind")

    def __init__(self, document: Document, kind: str, id: str, label: str, unit: str) -> None:
        self._document, self._spline = document, None
        self.kind, self.id, self.label, self.unit = kind, id, label, unit

    @property
    def shape(self) -> Any:
        """The spline as it is now: a `knead.Surface`, `Curve` or `Volume`, which stays what it is. Without a copy."""
        return self._current(False)

    @property
    def opened(self) -> Any:
        """The spline as it was opened or made."""
        return self._current(True)

    def _current(self, opened: bool) -> Any:
        core = self._document._session.shape(self.id, opened)
        if core is None:
            raise InputError("it is not in the document any more", where=self.id, remedy="see doc.surfaces")
        kept: Any = self._spline
        if kept is not None and kept._core.same_object(core):
            return kept
        made = of_core(core)
        if not opened:
            self._spline = made
        return made

    @property
    def control_points(self) -> Array:
        """A read-only view of the control points as they are now: it keeps them when the document goes on."""
        points: Array = self.shape.control_points
        return points

    @property
    def weights(self) -> Array | None:
        weights: Array | None = self.shape.weights
        return weights

    @property
    def knots(self) -> Any:
        return self.shape.knots

    @property
    def degree(self) -> Any:
        return self.shape.degree

    def __repr__(self) -> str:
        spline = self.shape
        label = f' "{self.label}"' if self.label else ""
        form = "rational" if spline.rational else "polynomial"
        return f"<{self.kind} {self.id}{label}: degree {spline.degree}, net {spline.net}, {form}, lengths in {self.unit}>"

    def _shown(self) -> tuple[list[tuple[Any, Any]], str, str]:
        return [self._with_opened()], repr(self).strip("<>"), self.unit

    def _with_opened(self) -> tuple[Any, Any]:
        """The spline, and what it was if it has moved."""
        now, opened = self.shape, self.opened
        return now, None if now._core.same_object(opened._core) else opened


class Snapshot:
    """A document at one moment, with its file and its history. It can be pickled."""

    __slots__ = ("_state",)

    def __init__(self, state: tuple[Any, ...]) -> None:
        self._state = state

    def restored(self) -> Document:
        """The document as it was, bit for bit, with undo and redo; nothing is computed."""
        return Document(_core.Session.from_state(self._state))

    def __reduce__(self) -> tuple[Any, ...]:
        return Snapshot, (self._state,)


class Document(Commands, Queries, Display):
    """A document: made by `knead.open` or `knead.new`.

    Its commands are methods, which return the document; its queries are methods, which return what they answer. A command
    takes full effect, or raises `knead.Error` and changes nothing. Long ones stop at Ctrl+C within 0.2 s: `KeyboardInterrupt`, and the steps that were whole stay. Several threads may
    use one document: they wait for each other. A function that a command calls must not use the document itself.
    """

    __slots__ = ("_session", "__weakref__")

    def __init__(self, session: Any) -> None:
        self._session = session

    def _act(self: _Self, name: str, fields: dict[str, Any], progress: Progress) -> _Self:
        given = {field: value for field, value in fields.items() if value is not None}
        given["do"] = name
        self._session.execute(encode(name, given), callback(progress))
        return self

    def _ask(self, name: str, fields: dict[str, Any], files: dict[str, File | None]) -> dict[str, Any]:
        given = {field: value for field, value in fields.items() if value is not None}
        contents = {field: _content(file, field)[0] for field, file in files.items() if file is not None}
        given |= {field: len(content) for field, content in contents.items()}
        answer, files = self._session.ask(name, encode(name, given), b"".join(contents.values()))
        return {**files, **json.loads(answer)}

    def run(self: _Self, script: Any, *, progress: Progress = None) -> _Self:
        """Carries out a script: the name of a file, the text or the dict of a script {"knead": 2, "commands": […]}, a list of
        commands, or one of an error's `fixes`. If a command fails none of them has had an effect, and the error's `where`
        begins with its place; at Ctrl+C the commands and steps that were whole stay."""
        name, listed = "script", False
        text: str | bytes
        if isinstance(script, Fix):
            text, listed = encode("commands", script.commands), True
        elif isinstance(script, Mapping):
            text = encode("script", dict(script))
        elif isinstance(script, (str, os.PathLike)):
            path = os.fspath(script)
            if isinstance(path, str) and path.lstrip().startswith("{"):
                text = path
            else:
                name = str(path)
                text = _read(name)
        elif isinstance(script, Sequence):
            text, listed = encode("commands", list(script)), True
        else:
            raise TypeError(f"script must be a file name, a script or a list of commands, not {type(script).__name__}")
        self._session.run(text, name, listed, callback(progress))
        return self

    @property
    def name(self) -> str:
        name: str = self._session.name()
        return name

    @property
    def script(self) -> str:
        """The script that makes this document of its file: the session is the script."""
        script: str = self._session.script()
        return script

    @property
    def _shapes(self) -> list[Shape]:
        return [Shape(self, *row) for row in self._session.shapes()]

    @property
    def surfaces(self) -> list[Shape]:
        """In the order of the file."""
        return [shape for shape in self._shapes if shape.kind == "surface"]

    @property
    def curves(self) -> list[Shape]:
        return [shape for shape in self._shapes if shape.kind == "curve"]

    @property
    def volumes(self) -> list[Shape]:
        return [shape for shape in self._shapes if shape.kind == "volume"]

    @property
    def selected(self) -> Shape | None:
        """The first shape that commands act on."""
        id = self._session.selected()
        return self[id] if id else None

    def __getitem__(self, key: str) -> Shape:
        """The shape of that id, or of that label if only one has it."""
        if not isinstance(key, str):
            raise TypeError(f"the key must be an id or a label, not {type(key).__name__}")
        shapes = self._shapes
        found = [s for s in shapes if s.id == key] or [s for s in shapes if s.label == key and key]
        if len(found) == 1:
            return found[0]
        ids = ", ".join(s.id for s in (found or shapes)[:6]) + (", …" if len(found or shapes) > 6 else "")
        if found:
            raise KeyError(f"{key!r} is the label of several: {ids}")
        raise KeyError(f"there is no {key!r}; the ids are: {ids or 'none'}")

    def __contains__(self, key: object) -> bool:
        return any(key in (s.id, s.label) for s in self._shapes)

    def __iter__(self) -> Iterator[Shape]:
        return iter(self._shapes)

    @property
    def report(self) -> Report:
        """What the commands have made of it so far. Cost: an evaluation of the energy, and of every moved shape."""
        return Report(self._session.report())

    @property
    def state(self) -> dict[str, Any]:
        """What the studio shows of the session: tools, settings, what holds the surfaces, the last step."""
        state: dict[str, Any] = json.loads(self._session.info())
        return state

    def snapshot(self) -> Snapshot:
        """All of it, with undo and redo."""
        return Snapshot(self._session.state())

    def __copy__(self: _Self) -> _Self:
        return type(self)(self._session.copy())

    def __deepcopy__(self: _Self, memo: object) -> _Self:
        return self.__copy__()

    def copy(self: _Self) -> _Self:
        """An independent document of the same file, with the same history."""
        return self.__copy__()

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (self.snapshot(),)

    def save(self, path: str | os.PathLike[str], *, schema: str = "ap214") -> None:
        """Writes the document, whole or not at all: its own file with the present surfaces and everything else as it was,
        or, where the ending says another format, a new file. Compressed by `.gz` and `.stpZ`. What a new file would lose is
        an error: `export` leaves it out. Without a file STEP is written (schema: "ap214", "ap242")."""
        name = _path(path)
        _core.write_file(name, self._whole(name, schema))

    def to_bytes(self, name: str = "", *, schema: str = "ap214") -> bytes:
        """What `save` would write into a file of that name; without one the document's own file."""
        return self._whole(name, schema)

    def export(self, path: str | os.PathLike[str], *, tolerance: float | None = None, detail: int = 96,
               schema: str = "ap214") -> list[str]:
        """Writes a file of any format: triangles (.stl, .obj, .ply, .glb) of the faces as they are now, or surfaces. Returns
        what it leaves out, a sentence each.

        tolerance  distance of triangles from faces, file units; None: a two-thousandth of the model's diagonal
        detail     of files without faces: lines per direction of each surface
        """
        apart = 0.0 if tolerance is None else number(tolerance, "tolerance")
        if tolerance is not None and not apart > 0:
            raise InputError(f"{apart} is no distance", where="tolerance", remedy="use a length above 0, in the units of the file")
        name = _path(path)
        left_out: list[str]
        made, left_out = self._session.file(name, apart, whole(detail, "detail", 1), chosen(schema, "schema", _schemas), True)
        _core.write_file(name, made)
        return left_out

    def _whole(self, name: str, schema: str) -> bytes:
        made, left_out = self._session.file(name, 0, 96, chosen(schema, "schema", _schemas), False)
        if left_out:
            raise InputError("the new file would lose something: " + "; ".join(left_out), where=name,
                             remedy="save it in its own format, or let export leave this out")
        content: bytes = made
        return content

    def analyse(self, samples: int = 41) -> Analysis:
        """The results on the selected surfaces, at samples × samples points of each, uniform in the parameters: displacements
        from the rest shape; of shells membrane forces, bending moments, von Mises stresses, strains and the reactions of what
        holds them; what the commands `modes` and `buckling` have found."""
        return Analysis(*self._session.analysis(whole(samples, "samples", 2)))

    def matrices(self, *, units: str | None = None, tolerance: float = 1e-10) -> Matrices:
        """K, M, D, F and the free control points of the first selected surface, of its material, load and held rows.
        units: "raw", "normalised"; None: those in which the document is computed."""
        return of_parts(self._session.matrices(None if units is None else normalised(units), number(tolerance, "tolerance")))

    def _shown(self) -> tuple[list[tuple[Any, Any]], str, str]:
        shapes = self._shapes
        unit = shapes[0].unit if shapes else ""
        return [shape._with_opened() for shape in shapes], f"{self.name}, lengths in {unit}" if unit else self.name, unit

    def __repr__(self) -> str:
        """What `knead info` says of a file, with the shapes as they are now. Cost: their bounding boxes."""
        lines: list[str] = self._session.text().splitlines()
        more = len(lines) - _most_lines
        return "\n".join(lines if more <= 1 else [*lines[:_most_lines], f"  and {more} more lines"])


def _restored(snapshot: Snapshot) -> Document:
    return snapshot.restored()


def _path(path: Any) -> str:
    try:
        return os.fsdecode(path)
    except TypeError:
        raise TypeError(f"path must be the name of a file, not {type(path).__name__}") from None


def _read(path: str) -> bytes:
    try:
        read: bytes = _core.read_file(path)
        return read
    except Error as error:
        if os.path.exists(path):
            raise
        raise MissingFileError("the file does not exist", file=path, remedy="check the path", kind=error.kind,
                               message=str(error)) from None


def _content(source: Any, argument: str) -> tuple[bytes, str | None]:
    """The bytes of a file, and its name."""
    if isinstance(source, Document):
        return source.to_bytes(), source.name
    if isinstance(source, (str, os.PathLike)):
        path = _path(source)
        return _read(path), path
    called = getattr(source, "name", None)
    if hasattr(source, "read"):
        source = source.read()
    if not isinstance(source, (bytes, bytearray, memoryview)):
        raise TypeError(f"{argument} must be a file name, bytes or a file opened for bytes, not {type(source).__name__}")
    return bytes(source), called


def open(source: Any, *, name: str | None = None, max_unpacked: int = _max_unpacked) -> Document:
    """A document of a CAD file: its name, its bytes, or an object with `read`. The edges of faces are held.

    name          what errors call it, and whose ending tells the format where bytes do not
    max_unpacked  bytes that a compressed file may hold
    """
    content, called = _content(source, "source")
    return Document(_core.Session.open(content, str(name or called or "document"), whole(max_unpacked, "max_unpacked")))


def new(name: str = "sheet", *, unit: str = "mm") -> Document:
    """A document without a file: its command `new` makes surfaces, curves and volumes, and `save` writes STEP."""
    if not isinstance(name, str):
        raise TypeError(f"name must be text, not {type(name).__name__}")
    if not isinstance(unit, str):
        raise TypeError(f"unit must be text, not {type(unit).__name__}")
    return Document(_core.Session.fresh(name, unit))
