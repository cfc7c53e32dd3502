"""How far long work is."""

from __future__ import annotations

import sys
import time
from typing import Any, Callable, Union

Progress = Union[bool, Callable[[int, int], Any], None]
"""True: a bar on stderr. Or a function of the numbers of steps done and to do; if it returns False, work stops after the step
that it was told of. What it raises is raised by the call."""


class Bar:
    """One line, written anew at most twenty times a second."""

    def __init__(self) -> None:
        self._next = 0.0

    def __call__(self, done: int, all: int) -> None:
        now = time.monotonic()
        if done < all and now < self._next:
            return
        self._next = now + 0.05
        filled = 30 * done // max(all, 1)
        end = "\n" if done >= all else ""
        print(f"\r[{'#' * filled}{'.' * (30 - filled)}] {done}/{all}", end=end, file=sys.stderr, flush=True)


def callback(progress: Progress) -> Callable[[int, int], Any] | None:
    if progress is None or progress is False:
        return None
    if progress is True:
        return Bar()
    if not callable(progress):
        raise TypeError(f"progress must be True or a function of two numbers, not {type(progress).__name__}")
    return progress
