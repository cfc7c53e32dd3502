"""Commands as JSON."""

from __future__ import annotations

import json
import os
from typing import Any, Mapping

from ._arrays import described
from ._errors import InputError


def _plain(value: Any) -> Any:
    """What NumPy and others know of their values in Python's own."""
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, Mapping):
        return dict(value)
    if isinstance(value, (set, frozenset, range)) or hasattr(value, "__array__"):
        return list(value)
    raise TypeError


_encode = json.JSONEncoder(default=_plain, allow_nan=False, separators=(",", ":")).encode


def encode(name: str, fields: Any) -> str:
    """TypeError and `InputError`, on one line, name the argument."""
    try:
        return _encode(fields)
    except (TypeError, ValueError, RecursionError) as error:
        for field, value in fields.items() if isinstance(fields, Mapping) else ():
            try:
                _encode(value)
            except ValueError:
                raise InputError("a number that is not finite", where=f"{name}: {field}", remedy="use finite numbers") from None
            except (TypeError, RecursionError):
                raise TypeError(f"{name}: {field} cannot be {described(value)}") from None
        if isinstance(error, ValueError):
            raise InputError("a number that is not finite", where=name, remedy="use finite numbers") from None
        raise TypeError(f"{name} cannot be made of {described(fields)}") from None
