"""What goes wrong: the errors of the library, as exceptions with the same fields."""

from __future__ import annotations

import errno
import json
from typing import Any, NamedTuple


class Fix(NamedTuple):
    """Something that can be done about an error or a note: `doc.run(fix)` does it."""

    code: str
    commands: list[dict[str, Any]]


class Error(Exception):
    """A failure that has changed nothing.

    code    what has happened, for programs (docs/errors.md); "none" if only the text is known
    kind    "usage", "input" or "numerical"
    what    what is wrong; where: the place inside the input; remedy: what would help
    values  what the text speaks of, by name
    fixes   what can be done, the most likely first
    file    which is wrong, and its line (0: unknown)
    """

    def __init__(self, what: str, *, where: str = "", remedy: str = "", kind: str = "usage", code: str = "none",
                 values: dict[str, Any] | None = None, fixes: list[Fix] | None = None, file: str = "", line: int = 0,
                 message: str = "") -> None:
        super().__init__(what)
        self.what, self.where, self.remedy = what, where, remedy
        self.kind, self.code = kind, code
        self.values = values if values is not None else {}
        self.fixes = fixes if fixes is not None else []
        self.file, self.line = file, line
        self._message = message or (f"{where}: " if where else "") + what + (f"; {remedy}" if remedy else "")

    def __str__(self) -> str:
        return self._message

    def __reduce__(self) -> tuple[Any, ...]:
        return _again, (type(self), self.what, {
            "where": self.where, "remedy": self.remedy, "kind": self.kind, "code": self.code, "values": self.values,
            "fixes": self.fixes, "file": self.file, "line": self.line, "message": self._message})


class InputError(Error, ValueError):
    """A file, a script, a value or the call itself is wrong."""


class MissingFileError(InputError, FileNotFoundError):
    """There is no such file."""

    def __init__(self, what: str, **fields: Any) -> None:
        super().__init__(what, **fields)
        self.errno = errno.ENOENT
        self.filename = self.file


class NumericalError(Error, ArithmeticError):
    """The data are valid, but the computation cannot be carried out."""


def _again(kind: type[Error], what: str, fields: dict[str, Any]) -> Error:
    return kind(what, **fields)


def made_of(text: str, file: str, line: int) -> Error:
    """What the compiled part raises: an error as the library tells it."""
    read = json.loads(text)["error"]
    fixes = [Fix(fix["code"], fix["commands"]) for fix in read.get("fixes") or []]
    kind = NumericalError if read["kind"] == "numerical" else InputError
    return kind(read["what"], where=read.get("where") or "", remedy=read.get("remedy") or "", kind=read["kind"],
                code=read.get("code") or "none", values=read.get("values") or {}, fixes=fixes, file=file, line=line,
                message=read.get("message") or "")
