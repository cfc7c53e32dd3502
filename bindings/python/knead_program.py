#!python
"""The program knead of the wheel: the command line in the compiled part of the package, without the package's Python."""

import os
import signal
import sys
from importlib.machinery import PathFinder

for _at_python in (signal.SIGPIPE, signal.SIGXFSZ):  # which Python ignores
    signal.signal(_at_python, signal.SIG_DFL)
if signal.getsignal(signal.SIGINT) is signal.default_int_handler:  # else whoever started it ignores Ctrl+C
    signal.signal(signal.SIGINT, signal.SIG_DFL)

_package = PathFinder.find_spec("knead")
_core = _package and PathFinder.find_spec("knead._core", _package.submodule_search_locations)
if not _core or not _core.loader:
    sys.exit("knead: the package knead is not installed for " + sys.executable)
_module = _core.loader.create_module(_core)
assert _module is not None
_core.loader.exec_module(_module)
_module.program([os.fsencode(_argument) for _argument in ("knead", *sys.argv[1:])])
