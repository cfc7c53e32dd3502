"""Arrays in, arrays out."""

from __future__ import annotations

import math
import operator
from typing import TYPE_CHECKING, Any

import numpy as np

from ._errors import InputError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]
else:  # numpy.typing takes longer to import than this package
    Array = ArrayLike = Any

__all__ = ["Array", "ArrayLike", "chosen", "count_of_derivatives", "described", "number", "numbers", "whole", "wrong_shape"]


def numbers(value: Any, name: str) -> Array:
    """C-contiguous doubles of anything array-like. TypeError, on one line, names the argument."""
    try:
        array = np.asarray(value)
        if array.dtype.kind == "O" and not any(item is None for item in array.flat):  # they may know themselves as numbers
            array = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        array = None
    if array is None or array.dtype.kind not in "biuf":
        raise TypeError(f"{name} must be numbers, not {described(value)}")
    return np.asarray(array, dtype=np.float64, order="C")


def number(value: Any, name: str) -> float:
    array = numbers(value, name)
    if array.ndim != 0:
        raise TypeError(f"{name} must be one number, not {described(value)}")
    return float(array)


def whole(value: Any, name: str, least: int = 0) -> int:
    try:
        result = operator.index(value)
    except TypeError:
        raise TypeError(f"{name} must be a whole number, not {described(value)}") from None
    if result < least:
        raise InputError(f"{result} is below {least}", where=name, remedy=f"use {least} or more")
    return int(result)


def chosen(value: Any, name: str, choices: tuple[str, ...]) -> str:
    if isinstance(value, str) and value in choices:
        return value
    listed = " or ".join(repr(choice) for choice in choices)
    if not isinstance(value, str):
        raise TypeError(f"{name} must be {listed}, not {described(value)}")
    raise InputError(f"{value!r} is not known", where=name, remedy=f"use {listed}")


def described(value: Any) -> str:
    text = repr(value).split("\n")[0]
    kind = type(value).__name__
    return kind if len(text) > 40 else f"{kind} {text}"


def wrong_shape(name: str, shape: tuple[int, ...], wanted: str) -> InputError:
    return InputError(f"an array of shape {shape} does not fit", where=name, remedy=f"its shape should be {wanted}")


def count_of_derivatives(directions: int, order: int) -> int:
    """How many partial derivatives have this total order."""
    return math.comb(order + directions - 1, directions - 1)
