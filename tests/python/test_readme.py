"""What the README of the package shows, and the snippets of docs/python.md and the templates, run."""

import contextlib
import io
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

from support import BONNET, near


class Shown(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        shutil.copy(BONNET, self.folder)
        before = os.getcwd()
        os.chdir(folder.name)
        self.addCleanup(os.chdir, before)

    def test_the_readme_runs(self):
        blocks = re.findall(r"```python\n(.*?)```", near("README-python.md", "bindings/python/README.md").read_text(), re.S)
        self.assertTrue(blocks)
        with contextlib.redirect_stderr(io.StringIO()), contextlib.redirect_stdout(io.StringIO()) as printed:
            names = {}
            for block in blocks:
                exec(compile(block, "README.md", "exec"), names)
        self.assertTrue((self.folder / "out.step").exists() and (self.folder / "r.vtu").exists())
        self.assertEqual(names["dx"].shape, (50, 50, 2, 3))
        self.assertTrue(names["c"].mask.any())
        del printed

    def test_the_template_runs(self):
        folder = near("examples-python", "examples/python")
        script = folder / "sculpt.py"
        self.assertLessEqual(len(script.read_text().splitlines()), 30)
        subprocess.run([sys.executable, script, "bonnet.step", "sculpted.step"], check=True, capture_output=True)
        self.assertTrue((self.folder / "sculpted.step").exists())

    def test_the_notebook_runs(self):
        import json

        import knead

        notebook = json.loads((near("examples-python", "examples/python") / "sculpt.ipynb").read_text())
        names = {}
        with contextlib.redirect_stderr(io.StringIO()):
            for cell in notebook["cells"]:
                if cell["cell_type"] == "code":
                    exec(compile("".join(cell["source"]), "sculpt.ipynb", "exec"), names)
        self.assertIsInstance(names["doc"], knead.Document)


if __name__ == "__main__":
    unittest.main()
