"""Builds the Python package of Knead: a back end of PEP 517 and PEP 660, of the standard library and CMake alone.

A wheel is packed from the build in build/release, which is made or brought up to date first. KNEAD_BUILD names another build
directory; what KNEAD_CMAKE_ARGUMENTS has is given to CMake.
"""

from __future__ import annotations

import base64
import hashlib
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import zipfile
from typing import Any

ROOT = pathlib.Path(__file__).resolve().parents[3]
BUILD = pathlib.Path(os.environ.get("KNEAD_BUILD", ROOT / "build" / "release"))
NAME = "knead_cad"
SUMMARY = "Freeform sculpting of exact B-spline and NURBS geometry"


def version() -> str:
    """That of the project, in its CMakeLists.txt."""
    found = re.search(r"project\(knead VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"))
    assert found is not None
    return found[1]


def tag() -> str:
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"


# What building needs: how it is found, and the Debian package that has it.
TOOLS = (("cmake", "cmake"), ("ninja", "ninja-build"), ("c++", "g++"))
HEADERS = (("Eigen", "libeigen3-dev", "/usr/include/eigen3/Eigen/Core"), ("{fmt}", "libfmt-dev", "/usr/include/fmt/format.h"),
           ("nlohmann/json", "nlohmann-json3-dev", "/usr/include/nlohmann/json.hpp"),
           ("pybind11", "pybind11-dev", "/usr/include/pybind11/pybind11.h"),
           ("CLI11", "libcli11-dev", "/usr/include/CLI/CLI.hpp"), ("libpng", "libpng-dev", "/usr/include/png.h"),
           ("libjpeg", "libjpeg-dev", "/usr/include/jpeglib.h"), ("zlib", "zlib1g-dev", "/usr/include/zlib.h"),
           ("Python's headers", "python3-dev", os.path.join(sysconfig.get_path("include"), "Python.h")))


def missing() -> dict[str, str]:
    """What is not there, by the package that has it."""
    lacks = {package: tool for tool, package in TOOLS if shutil.which(tool) is None}
    # Libraries may be elsewhere: a failing CMake is explained by those that are not in their usual place.
    lacks.update({package: what for what, package, path in HEADERS if not os.path.exists(path)})
    return lacks


def run(*command: str) -> None:
    print(shlex.join(command), flush=True)
    done = subprocess.run(command, cwd=ROOT, check=False)
    if done.returncode == 0:
        return
    lacks = missing()
    hint = "; missing: " + ", ".join(f"{what} (apt-get install {package})" for package, what in lacks.items()) if lacks else ""
    raise SystemExit(f"knead: {command[0]} failed{hint}")


def build() -> pathlib.Path:
    """Brings the package in the build directory up to date: where it is."""
    for tool, package in TOOLS:
        if shutil.which(tool) is None:
            raise SystemExit(f"knead: {tool} is missing: apt-get install {package}")
    arguments = ["-DKNEAD_BUILD_PYTHON=ON", "-DKNEAD_BUILD_APPS=ON", *shlex.split(os.environ.get("KNEAD_CMAKE_ARGUMENTS", ""))]
    if not (BUILD / "build.ninja").exists():
        arguments += ["-DKNEAD_BUILD_TESTS=OFF", "-DKNEAD_BUILD_BENCH=OFF", "-DKNEAD_BUILD_EXAMPLES=OFF"]
    cache = BUILD / "CMakeCache.txt"
    python = os.path.realpath(sys.executable)
    arguments.append(f"-DPython_EXECUTABLE={python}")
    present = cache.read_text(encoding="utf-8", errors="replace") if cache.exists() else ""
    if any(not re.search(rf"^{re.escape(name)}:[A-Z]*={re.escape(value)}$", present, re.M)
           for name, _, value in (argument[2:].partition("=") for argument in arguments)):
        run("cmake", "--preset", "release", "-B", str(BUILD), *arguments)
    run("cmake", "--build", str(BUILD), "--target", "knead_package")
    return BUILD / "python"


def metadata() -> str:
    readme = (ROOT / "bindings" / "python" / "README.md").read_text(encoding="utf-8")
    return "\n".join([
        "Metadata-Version: 2.1", "Name: knead-cad", f"Version: {version()}", f"Summary: {SUMMARY}", "License: Apache-2.0",
        "Requires-Python: >=3.11", "Requires-Dist: numpy>=1.24", "Provides-Extra: sparse",
        "Requires-Dist: scipy>=1.10; extra == 'sparse'", "Classifier: Programming Language :: C++",
        "Classifier: Programming Language :: Python :: 3", "Classifier: Typing :: Typed",
        "Description-Content-Type: text/markdown", "", readme])


def wheel_text() -> str:
    return f"Wheel-Version: 1.0\nGenerator: knead_backend\nRoot-Is-Purelib: false\nTag: {tag()}\n"


class Wheel:
    """An archive in which the same files give the same bytes."""

    def __init__(self, directory: str) -> None:
        self.name = f"{NAME}-{version()}-{tag()}.whl"
        self.info = f"{NAME}-{version()}.dist-info"
        os.makedirs(directory, exist_ok=True)
        self._zip = zipfile.ZipFile(os.path.join(directory, self.name), "w")
        self._record: list[str] = []

    def add(self, name: str, content: bytes, executable: bool = False) -> None:
        entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
        entry.external_attr = (0o100755 if executable else 0o100644) << 16
        self._zip.writestr(entry, content, zipfile.ZIP_DEFLATED, 9)
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        self._record.append(f"{name},sha256={digest},{len(content)}")

    def close(self) -> str:
        self.add(f"{self.info}/METADATA", metadata().encode())
        self.add(f"{self.info}/WHEEL", wheel_text().encode())
        self.add(f"{self.info}/LICENSE", (ROOT / "LICENSE").read_bytes())
        record = f"{self.info}/RECORD"
        self._zip.writestr(zipfile.ZipInfo(record, (1980, 1, 1, 0, 0, 0)), "\n".join([*self._record, f"{record},,", ""]))
        self._zip.close()
        return self.name


def add_program(wheel: Wheel) -> None:
    """The program knead, in the directory of programs of the environment: it starts the one in the module."""
    script = (ROOT / "bindings" / "python" / "knead_program.py").read_bytes()
    wheel.add(f"{NAME}-{version()}.data/scripts/knead", script, executable=True)


def build_wheel(wheel_directory: str, config_settings: Any = None, metadata_directory: str | None = None) -> str:
    package = build()
    wheel = Wheel(wheel_directory)
    for file in sorted((package / "knead").iterdir()):
        if file.is_file():
            wheel.add(f"knead/{file.name}", file.read_bytes())
    add_program(wheel)
    return wheel.close()


def build_editable(wheel_directory: str, config_settings: Any = None, metadata_directory: str | None = None) -> str:
    package = build()
    wheel = Wheel(wheel_directory)
    wheel.add("knead_cad.pth", f"{package}\n".encode())
    add_program(wheel)
    return wheel.close()


def build_sdist(sdist_directory: str, config_settings: Any = None) -> str:
    """The files that git knows, under one directory."""
    name = f"{NAME}-{version()}"
    files = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True).stdout.decode().split("\0")
    os.makedirs(sdist_directory, exist_ok=True)
    with tarfile.open(os.path.join(sdist_directory, name + ".tar.gz"), "w:gz") as archive:
        for file in filter(None, files):
            archive.add(ROOT / file, f"{name}/{file}", recursive=False)
    return name + ".tar.gz"


def get_requires_for_build_wheel(config_settings: Any = None) -> list[str]:
    return []


get_requires_for_build_editable = get_requires_for_build_sdist = get_requires_for_build_wheel

if __name__ == "__main__":
    print(build_wheel(sys.argv[1]))
