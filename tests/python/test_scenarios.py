"""The scenarios that run natively and in WebAssembly (tests/scenarios), by the methods of a document and by the program."""

import json
import keyword
import pathlib
import subprocess
import tempfile
import unittest

import knead
from support import BONNET, PROGRAMS, near

FOLDER = near("scenarios", "tests/scenarios")


def commands_of(scenario):
    return [step for step in scenario["steps"] if "do" in step]


def carry_out(doc, command):
    fields = {f + "_" if keyword.iskeyword(f) else f: value for f, value in command.items() if f != "do"}
    getattr(doc, command["do"] + ("_" if keyword.iskeyword(command["do"]) else ""))(**fields)


def at(state, pointer):
    for name in pointer.split("/")[1:]:
        state = state[int(name)] if isinstance(state, list) else state.get(name)
    return state


def points_of(doc):
    return {shape.id: (shape.kind, shape.control_points.tobytes()) for shape in doc}


def untimed(report):
    """How long steps took differs from run to run."""
    return {**report, "time": 0, "steps": [{**step, "time": 0} for step in report["steps"]]}


class Scenarios(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def sculpted(self, program, arguments, commands):
        """The bytes and the report that a program makes of these commands."""
        script, output, report = (self.folder / name for name in ("script.json", "out.step", "report.json"))
        script.write_text(json.dumps({"knead": 2, "commands": commands}))
        subprocess.run([program, "sculpt", *arguments, "--script", script, "--output", output, "--report", report], check=True,
                       capture_output=True)
        return output.read_bytes(), json.loads(report.read_text())

    def by_methods(self, scenario, doc):
        """As the scenario says, with what it expects."""
        for step in scenario["steps"]:
            if "do" in step:
                carry_out(doc, step)
            elif "refused" in step:
                before = doc.state
                with self.assertRaises(knead.Error) as caught:
                    carry_out(doc, step["refused"])
                self.assertEqual(caught.exception.where, step["where"])
                self.assertEqual(doc.state, before)
            else:
                value = at(doc.state, step["expect"])
                if "is" in step:
                    self.assertEqual(value, step["is"], step)
                else:
                    self.assertTrue(step["min"] <= value <= step["max"], (value, step))

    def test_python_and_the_program_make_the_same_bits(self):
        scenarios = sorted(FOLDER.glob("*.json"))
        self.assertGreaterEqual(len(scenarios), 8)
        for file in scenarios:
            with self.subTest(file.stem):
                scenario = json.loads(file.read_text())
                opened = near(pathlib.Path(scenario["open"]).name, scenario["open"]) if "open" in scenario else None
                doc = knead.open(opened) if opened else knead.new()
                self.by_methods(scenario, doc)
                script = knead.open(opened) if opened else knead.new()
                script.run(commands_of(scenario))
                self.assertEqual(points_of(script), points_of(doc))
                saved, report = doc.to_bytes("out.step"), untimed(doc.report.to_dict())
                for program in PROGRAMS:
                    bytes, told = self.sculpted(program, [opened] if opened else ["--new"], commands_of(scenario))
                    self.assertEqual(bytes, saved, program)
                    self.assertEqual(untimed(told), report, program)
                # Of volumes the sides are saved.
                made, read = ({row for row in points_of(d).values() if row[0] != "volume"} for d in (doc, knead.open(saved, name="out.step")))
                self.assertEqual(made - read, set())

    def test_untouched_files_stay_as_they_are(self):
        exported = self.folder / "bonnet.igs"
        knead.open(BONNET).export(exported)
        for file in (BONNET, near("patches.step", "examples/figures/patches.step"), exported):
            for program in PROGRAMS:
                output = self.folder / ("out" + file.suffix)
                script = self.folder / "none.json"
                script.write_text('{"knead": 2, "commands": []}')
                subprocess.run([program, "sculpt", file, "--script", script, "--output", output], check=True, capture_output=True)
                self.assertEqual(output.read_bytes(), file.read_bytes(), program)
            self.assertEqual(knead.open(file).to_bytes(), file.read_bytes())


if __name__ == "__main__":
    unittest.main()
