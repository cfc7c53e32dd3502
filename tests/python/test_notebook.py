"""The notebook of the examples: run, saved, converted and opened in a browser, where its models turn without network."""

import importlib.util
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

from support import BONNET, FOLDER, near

WEB = pathlib.Path(os.environ.get("KNEAD_WEB", FOLDER.parents[1] / "web"))
CHROMIUM = os.environ.get("CHROMIUM", "/usr/bin/chromium")
THERE = (all(importlib.util.find_spec(name) for name in ("nbconvert", "ipykernel")) and shutil.which("node")
         and os.access(CHROMIUM, os.X_OK) and (WEB / "node_modules" / "playwright-core").is_dir())


@unittest.skipUnless(THERE, "nbconvert, ipykernel, Chromium or playwright-core is not installed: scripts/notebook_test.sh")
class Notebook(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        shutil.copy(BONNET, self.folder)
        shutil.copy(near("examples-python", "examples/python") / "sculpt.ipynb", self.folder)
        # A kernel of this Python, before the system's of the same name.
        kernel = self.folder / "jupyter" / "kernels" / "python3"
        kernel.mkdir(parents=True)
        (kernel / "kernel.json").write_text(json.dumps({
            "argv": [sys.executable, "-m", "ipykernel_launcher", "-f", "{connection_file}"], "display_name": "Python 3",
            "language": "python"}))

    def convert(self, *arguments):
        environment = {**os.environ, "JUPYTER_PATH": str(self.folder / "jupyter"), "JUPYTER_DATA_DIR": str(self.folder / "data"),
                       "JUPYTER_RUNTIME_DIR": str(self.folder / "run"), "IPYTHONDIR": str(self.folder / "ipython")}
        done = subprocess.run([sys.executable, "-m", "nbconvert", *arguments], cwd=self.folder, env=environment,
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_models_turn_in_the_page_that_a_notebook_becomes(self):
        self.convert("--to", "notebook", "--execute", "--output", "executed.ipynb", "sculpt.ipynb")
        saved = json.loads((self.folder / "executed.ipynb").read_text())
        outputs = [output["data"] for cell in saved["cells"] for output in cell.get("outputs", []) if "data" in output]
        shown = ["".join(data["text/html"]) for data in outputs if "text/html" in data]
        self.assertEqual(len(shown), 2)
        for data in outputs:
            self.assertLess(len(json.dumps(data)), 600_000)
        self.assertTrue(any("image/svg+xml" in data for data in outputs))
        self.assertTrue((self.folder / "sculpted.step").exists())
        # What nbconvert's own page would fetch is left out: formulas, and scripts of other displays.
        self.convert("--to", "html", "--HTMLExporter.mathjax_url=data:,", "--HTMLExporter.require_js_url=data:,", "executed.ipynb")
        told = subprocess.run(["node", FOLDER / "turn.mjs", WEB, self.folder / "executed.html"], capture_output=True, text=True,
                              check=False)
        self.assertEqual(told.returncode, 0, told.stderr)
        page = json.loads(told.stdout)
        self.assertEqual((page["asked"], page["errors"], len(page["models"])), ([], [], len(shown)))
        for model in page["models"]:
            self.assertGreater(model["drawn"], 0.05 * model["pixels"], model)
            self.assertEqual(model["restless"], 0, model)
            self.assertGreater(model["turned"], 0.02 * model["pixels"], model)


if __name__ == "__main__":
    unittest.main()
