"""The compiled part of the package as a file, and the program in it."""

import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import knead
from knead import _core
from support import BONNET, FOLDER, PROGRAM, PROGRAMS

# What every Linux with C++ programs has.
SYSTEM = {"libc.so.6", "libm.so.6", "libstdc++.so.6", "libgcc_s.so.1", "ld-linux-x86-64.so.2", "ld-linux-aarch64.so.1"}


def printed_by(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


class Module(unittest.TestCase):
    def test_it_needs_nothing_but_the_system(self):
        needed = set(re.findall(r"\(NEEDED\).*\[(.*)\]", printed_by("readelf", "-d", _core.__file__)))
        self.assertLessEqual(needed, SYSTEM)
        self.assertIn("libc.so.6", needed)

    def test_it_shows_what_python_looks_for_alone(self):
        symbols = [line.split()[-1] for line in printed_by("nm", "-D", "--defined-only", _core.__file__).splitlines()]
        self.assertEqual(symbols, ["PyInit__core"])

    def test_it_knows_no_numpy(self):
        # One wheel serves every NumPy: arrays cross as buffers, not by its interface in C.
        self.assertNotIn(b"_ARRAY_API", pathlib.Path(_core.__file__).read_bytes())

    def test_importing_takes_numpy_and_the_standard_library(self):
        code = "import sys, numpy; before = set(sys.modules); import knead; print(*{m.split('.')[0] for m in set(sys.modules) - before})"
        more = set(printed_by(sys.executable, "-c", code).split()) - set(sys.stdlib_module_names)
        self.assertEqual(more, {"knead"})

    def test_the_wheel_is_small(self):
        wheels = list((FOLDER.parent / "dist").glob("*.whl"))
        if not wheels:
            self.skipTest("it is not here")
        self.assertLess(wheels[0].stat().st_size, 6_000_000)


@unittest.skipUnless(PROGRAM, "the package is not installed")
class Program(unittest.TestCase):
    def test_it_is_the_one_of_the_package(self):
        self.assertEqual(printed_by(PROGRAM, "--version"), f"knead {knead.__version__}\n")

    @unittest.skipUnless(os.path.isfile(os.environ.get("KNEAD_CLI_TEST", "")), "the native tests are not here")
    def test_it_passes_the_native_tests(self):
        # But the one that counts the memory of a program, which has no Python in it.
        chosen = "-LargeStep.*" if os.environ.get("KNEAD_LONG") else \
            "ExitCodes.*:Errors.*:Help.*:SnakeCommand.*:Hostile.CtrlC*"
        done = subprocess.run([os.environ["KNEAD_CLI_TEST"], "--gtest_brief=1", "--gtest_repeat=1",
                               "--gtest_filter=" + chosen],
                              env={**os.environ, "KNEAD_PROGRAM": PROGRAM}, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stdout[-5000:])
        self.assertRegex(done.stdout, r"PASSED  \] [1-9]")

    def test_ctrl_c_ends_it_as_it_ends_programs(self):
        with tempfile.TemporaryDirectory() as folder:
            script = pathlib.Path(folder, "s.json")
            script.write_text(json.dumps({"knead": 2, "commands": [
                {"do": "new"}, {"do": "load", "gravity": [0, 0, -1]}, {"do": "step", "count": 1000000}]}))
            for program in PROGRAMS:
                started = subprocess.Popen([program, "sculpt", "--new", "--script", script, "--output", pathlib.Path(folder, "out.step")],
                                           stderr=subprocess.DEVNULL,
                                           preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
                time.sleep(0.3)
                started.send_signal(signal.SIGINT)
                self.assertEqual(started.wait(), -signal.SIGINT, program)


if __name__ == "__main__":
    unittest.main()
