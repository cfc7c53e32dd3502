"""Types, where mypy is installed: of the package, of the templates, and that the stub of the compiled part is true."""

import importlib.util
import pathlib
import subprocess
import sys
import tempfile
import unittest

from support import near

# pybind11's classes have a metaclass of its own, and a constructor that says what it cannot.
CLASSES = ("Curve", "CurveSearch", "Surface", "SurfaceSearch", "Volume", "View", "Grids", "Session", "_Held")
UNKNOWN = [f"knead._core.{name}{part}" for name in CLASSES for part in ("", ".__init__", ".__new__")]
UNKNOWN += ["knead._core._Array", "knead._core._Columns", "knead._core._Progress", "knead._core._T"]


@unittest.skipUnless(importlib.util.find_spec("mypy"), "mypy is not installed")
class Typing(unittest.TestCase):
    def run_of(self, *command):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([sys.executable, "-m", *command], cwd=folder, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_the_package_and_the_template_are_strict(self):
        self.run_of("mypy", "--strict", "--config-file=", "-p", "knead")
        template = near("examples-python", "examples/python") / "sculpt.py"
        self.run_of("mypy", "--strict", "--config-file=", str(template))

    def test_the_stub_is_true(self):
        allowed = pathlib.Path(tempfile.mkstemp(suffix=".txt")[1])
        self.addCleanup(allowed.unlink)
        allowed.write_text("\n".join(UNKNOWN))
        self.run_of("mypy.stubtest", "knead._core", "--allowlist", str(allowed), "--ignore-unused-allowlist")


if __name__ == "__main__":
    unittest.main()
