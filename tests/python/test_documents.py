import copy
import io
import json
import keyword
import pathlib
import pickle
import subprocess
import tempfile
import unittest

import numpy as np

import knead
from knead import _core
from support import BONNET, PROGRAM, PROGRAMS, SAMPLES, sheet


def commands():
    schema = json.loads(_core.script_schema())["properties"]["commands"]["items"]["oneOf"]
    return {one["properties"]["do"]["const"]: one for one in schema}


class Commands(unittest.TestCase):
    def test_every_command_is_a_method_with_all_its_fields(self):
        import inspect

        for name, command in commands().items():
            method = getattr(knead.Document, name + "_" if keyword.iskeyword(name) else name)
            taken = [p.rstrip("_") for p in inspect.signature(method).parameters]
            self.assertEqual(taken, ["self", *(f for f in command["properties"] if f != "do"), "progress"], name)
            self.assertTrue(method.__doc__)

    def test_no_attribute_of_a_document_has_the_name_of_a_command(self):
        own = set(vars(knead.Document)) | set(dir(object))
        self.assertEqual(own & set(commands()), set())

    def test_the_first_field_is_positional_and_calls_chain(self):
        doc = sheet()
        self.assertIs(doc.step(2, lambda_=10), doc)
        self.assertEqual([c["do"] for c in json.loads(doc.script)["commands"]], ["new", "hold", "tool", "step"])
        self.assertEqual(json.loads(doc.script)["commands"][-1]["lambda"], 10)

    def test_numbers_of_numpy(self):
        doc = sheet().step(np.int64(1), lambda_=np.float32(2))
        doc.move("ball", by=np.array([0, 0, -0.5]))
        self.assertEqual(json.loads(doc.script)["commands"][-1]["by"], [0, 0, -0.5])

    def test_wrong_types_are_named_on_one_line(self):
        doc = knead.new()
        with self.assertRaises(TypeError) as caught:
            doc.new(size=object())
        self.assertRegex(str(caught.exception), "^new: size cannot be object")
        with self.assertRaisesRegex(knead.InputError, "new: size"):
            doc.new(size=(float("nan"), 1))
        with self.assertRaises(knead.Error) as refused:
            doc.step("many")
        self.assertIn("count", refused.exception.where)
        with self.assertRaises(TypeError):
            doc.step(wrong=1)



class Queries(unittest.TestCase):
    def test_every_query_is_a_method_with_all_its_fields(self):
        import inspect

        described = json.loads(_core.document_queries())
        self.assertIn("check", [one["name"] for one in described])
        for one in described:
            fields = [*one["request"]["properties"], *(file["name"] for file in one["files"])]
            method = getattr(knead.Document, one["name"])
            self.assertEqual([p.rstrip("_") for p in inspect.signature(method).parameters], ["self", *fields], one["name"])
            self.assertTrue(method.__doc__)
            self.assertNotIn(one["name"], commands())

    def test_check_is_what_the_program_says(self):
        doc = knead.open(BONNET)
        for options, fields in (([], {}), (["--class", "a", "--curvature", "2"], {"class_": "a", "curvature": 2}),
                                (["--edges", "#43,#107", "--gap", "1e-5"], {"edges": ["#43", "#107"], "gap": 1e-5})):
            said = subprocess.run([PROGRAMS[0], "check", BONNET, "--json", *options], capture_output=True, check=False).stdout
            self.assertEqual(doc.check(**fields), json.loads(said))

    def test_check_is_of_the_document_as_it_is_now(self):
        doc = knead.open(BONNET)
        skin = next(s.id for s in doc.surfaces if s.label == "bonnet skin")
        doc.select(skin).hold(mode="open").tool("ball", shape="sphere", radius=160, at=(0.5, 0.1)).step(5)
        opened = pathlib.Path(BONNET).read_bytes()
        for against in (BONNET, opened, io.BytesIO(opened), knead.open(BONNET)):
            answer = doc.check(gap=1e-3, against=against)
            self.assertFalse(answer["passed"])
            self.assertIn("gap", [fault["measure"] for fault in answer["faults"]])
        self.assertTrue(knead.open(BONNET).check(gap=1e-3, against=opened)["passed"])

    def test_errors_name_the_field(self):
        doc = knead.open(BONNET)
        for fields, where in (({"angle": 6}, "angle"), ({"unit": "mm"}, "unit"), ({"against": BONNET}, "against"),
                              ({"edges": ["#1"]}, "edges"), ({"class_": "d"}, "class")):
            with self.assertRaises(knead.Error) as refused:
                doc.check(**fields)
            self.assertIn(where, refused.exception.where)
        with self.assertRaisesRegex(TypeError, "against must be"):
            doc.check(gap=1, against=3)
        with self.assertRaisesRegex(knead.Error, "against"):
            doc.check(gap=1, against=b"no file")
        self.assertEqual(sheet().check()["counts"], [{"kind": "open", "count": 4}])

    def test_morphed_is_what_the_program_writes(self):
        bend, opened = "0; 0; 20*sin(x/500)", pathlib.Path(BONNET).read_bytes()
        with tempfile.TemporaryDirectory() as folder:
            file, report = pathlib.Path(folder, "out.step"), pathlib.Path(folder, "report.json")
            subprocess.run([PROGRAMS[0], "morph", BONNET, "-o", file, "--report", report, "--space", bend, "--scale", "-0.5"],
                           check=True, capture_output=True)
            doc = knead.open(BONNET)
            answer = doc.morphed(space=bend, scale=-0.5)
            self.assertEqual(answer["file"], file.read_bytes())
            said = json.loads(report.read_text())
            del said["file"]
            for field in [name for name in said if name.startswith("time_")]:
                del said[field]
            self.assertLessEqual(said.items(), answer["report"].items())
            self.assertIn("## Deviation from the data", answer["page"])
            self.assertEqual(doc.to_bytes(), opened)
            self.assertEqual(doc.morph(space=bend, scale=-0.5).to_bytes(), answer["file"])
            self.assertEqual(doc.undo().to_bytes(), opened)
            self.assertTrue(knead.open(answer["file"], name="out.step").check(gap=1e-2, against=opened)["passed"])

    def test_morphed_takes_data_in_all_ways(self):
        mesh = knead.open(BONNET).export
        with tempfile.TemporaryDirectory() as folder:
            obj = pathlib.Path(folder, "bonnet.obj")
            mesh(obj)
            before = obj.read_text()
            moved = []
            for line in before.splitlines():
                word, *rest = line.split(" ") if line else [""]
                if word == "v":
                    x, y, z = map(float, rest[:3])
                    line = f"v {x!r} {y!r} {z + 3!r}"
                moved.append(line)
            doc = knead.open(BONNET)
            answer = doc.morphed(from_=obj, to=io.BytesIO("\n".join(moved).encode()))
            self.assertLess(answer["report"]["after"]["largest"], 1e-9)
            self.assertAlmostEqual(answer["report"]["before"]["mean"], 3, 9)

    def test_deviation_says_how_far_data_are(self):
        doc = knead.open(BONNET)
        answer = doc.deviation(space="0; 0; 2")
        self.assertEqual((answer["used"], answer["left_out"], answer["alignment"]), (answer["points"], 0, None))
        self.assertLessEqual(answer["deviation"]["largest"], 2 + 1e-12)
        wanted = np.frombuffer(answer["wanted"]).reshape(-1, 3)
        self.assertEqual(wanted.shape, (answer["points"], 3))
        np.testing.assert_array_equal(wanted, np.tile([0, 0, 2.0], (answer["points"], 1)))
        self.assertEqual(set(answer["states"]), {0})

    def test_errors_of_morphed_name_the_field(self):
        doc = knead.open(BONNET)
        for fields, where in (({}, "vectors"), ({"space": "0;0;0", "vectors": b"1 2 3 4 5 6"}, "vectors"), ({"from_": b"1 2 3"}, "to"),
                              ({"space": "0;0"}, "space"), ({"space": "0;0;1", "refine": 0}, "refine"),
                              ({"space": "0;0;1", "keep": ["#1"]}, "keep"), ({"vectors": b"1 2 3 4 5 x"}, "vectors")):
            with self.assertRaises(knead.Error) as refused:
                doc.morphed(**fields)
            self.assertIn(where, str(refused.exception))


class Sculpting(unittest.TestCase):
    def test_the_sample_as_the_program_sculpts_it(self):
        doc = knead.open(BONNET)
        self.assertEqual(doc.surfaces[0].id, "#285")
        skin = doc["#285"]
        self.assertIs(type(skin.shape), knead.Surface)
        before = skin.control_points
        doc.select("#285").material(alpha=(1, 0, 1), beta=(0.003,) * 3).hold(mode="position")
        doc.tool("ball", shape="sphere", radius=160, at=(0.4, 0.5), mode="collision").move("ball", by=(0, 0, 125))
        doc.step(15, lambda_=20).move("ball", by=(0, 0, -25)).step(15, lambda_=20)
        by_script = knead.open(str(BONNET)).run(SAMPLES / "bonnet.json")
        np.testing.assert_array_equal(skin.control_points, by_script["#285"].control_points)
        self.assertEqual(doc.to_bytes(), by_script.to_bytes())
        self.assertGreater(doc.report.largest_displacement, 10)
        np.testing.assert_array_equal(before, knead.open(BONNET)["#285"].control_points)
        (u, v) = (np.linspace(*side, 9) for side in skin.shape.domain)
        np.testing.assert_allclose(skin.opened.grid(u, v), knead.open(BONNET)["#285"].shape.grid(u, v), atol=1e-9)
        self.assertGreater(doc.report.control_points_moved, 0)
        self.assertEqual(len(doc.report.steps), 30)

    def test_an_untouched_file_keeps_its_bytes(self):
        bytes = BONNET.read_bytes()
        for doc in (knead.open(bytes), knead.open(io.BytesIO(bytes)), knead.open(BONNET)):
            self.assertEqual(doc.to_bytes(), bytes)

    def test_undo_and_redo(self):
        doc = sheet().step(3)
        shape = next(iter(doc))
        after = shape.control_points
        doc.undo()
        self.assertEqual(float(abs(shape.control_points[..., 2]).max()), 0)
        doc.redo()
        np.testing.assert_array_equal(shape.control_points, after)
        self.assertGreater(float(abs(after[..., 2]).max()), 0)

    def test_a_failed_call_changes_nothing(self):
        doc = sheet().step(2).undo()
        script, points = doc.script, next(iter(doc)).control_points
        with self.assertRaises(knead.Error):
            doc.move("no such tool", by=(0, 0, 1))
        with self.assertRaises(knead.Error) as caught:
            doc.run([{"do": "step", "count": 1}, {"do": "move", "tool": "none", "by": [0, 0, 1]}])
        self.assertIn("commands[1]", caught.exception.where)
        self.assertEqual(doc.script, script)
        np.testing.assert_array_equal(next(iter(doc)).control_points, points)
        doc.redo()  # what could be redone still can
        self.assertEqual(len(doc.report.steps), 2)

    def test_scripts_in_and_out(self):
        doc = sheet().step(2)
        again = knead.new("sheet").run(doc.script)
        self.assertEqual(again.script, doc.script)
        np.testing.assert_array_equal(next(iter(again)).control_points, next(iter(doc)).control_points)
        self.assertEqual(knead.new("sheet").run(json.loads(doc.script)).script, doc.script)

    def test_what_is_no_script(self):
        with tempfile.TemporaryDirectory() as folder:
            picture = pathlib.Path(folder, "p.png")
            picture.write_bytes(b"\x89PNG\r\n\x1a\n" + bytes(20))
            with self.assertRaisesRegex(knead.InputError, "this is an image, not a script"):
                knead.new().run(picture)
        with self.assertRaisesRegex(knead.InputError, "not finite"):
            knead.new().run([{"do": "move", "tool": "ball", "by": [0, 0, float("nan")]}])

    def test_snapshots_pickles_and_copies(self):
        for doc in (sheet().step(2), knead.open(BONNET).measure("p", surface="#285", at=(0.5, 0.5))):
            points = next(iter(doc)).control_points
            for again in (copy.copy(doc), copy.deepcopy(doc), pickle.loads(pickle.dumps(doc)), doc.snapshot().restored()):
                self.assertEqual(again.script, doc.script)
                np.testing.assert_array_equal(next(iter(again)).control_points, points)
                self.assertEqual(again.to_bytes(), doc.to_bytes())
                again.undo()
                self.assertNotEqual(again.script, doc.script)

    def test_fixes_can_be_run(self):
        doc = knead.new().new(size=(10, 10), net=(10, 10)).limit(0.1)
        with self.assertRaises(knead.Error) as caught:
            doc.points([44], by=(0, 0, 1))
        error = caught.exception
        self.assertEqual(error.code, "beyond_limit")
        self.assertEqual(error.fixes[0].code, "end_limit")
        self.assertIn("limit", error.values)
        doc.run(error.fixes[0]).points([44], by=(0, 0, 1))
        again = pickle.loads(pickle.dumps(error))
        self.assertEqual((str(again), again.code, again.fixes), (str(error), error.code, error.fixes))

    def test_curves_and_volumes(self):
        doc = knead.new().new("volume", form="box", size=(3, 2, 1)).new("curve", form="circle", radius=2)
        volume, curve = doc.volumes[0], doc.curves[0]
        self.assertEqual((type(volume.shape), type(curve.shape)), (knead.Volume, knead.Curve))
        self.assertEqual(doc.surfaces, [])
        (u, v, w) = ((a + b) / 2 for a, b in volume.shape.domain)
        np.testing.assert_allclose(volume.shape(u, v, w), (1.5, 1, 0.5), atol=1e-14)
        at = np.linspace(*curve.shape.domain, 9)
        np.testing.assert_allclose(np.linalg.norm(curve.shape(at), axis=1), 2, rtol=1e-14)


class Looking(unittest.TestCase):
    def test_shapes_by_id_and_label(self):
        doc = knead.open(BONNET)
        skin = doc.surfaces[0]
        if skin.label:
            self.assertEqual(doc[skin.label].id, skin.id)
        self.assertIn(skin.id, doc)
        self.assertNotIn("#1", doc)
        with self.assertRaisesRegex(KeyError, "the ids are: #285"):
            doc["#1"]
        with self.assertRaisesRegex(TypeError, "id or a label"):
            doc[0]
        self.assertIn("#285", repr(skin))

    def test_at_a_terminal_a_document_says_what_the_program_says_of_its_file(self):
        told = subprocess.run([PROGRAM, "info", BONNET], capture_output=True, text=True, check=True).stdout
        doc = knead.open(BONNET)
        self.assertEqual(repr(doc) + "\n", told)
        self.assertIn("net 14 x 12", told)
        doc.select("#285").elevate(by=(1, 0))
        self.assertEqual(repr(doc).replace("degree 4 x 3", "degree 3 x 3").split("net")[0], told.split("net")[0])
        made = knead.new("parts").new(size=(3, 2)).new("volume", form="box", size=(3, 2, 1)).new("curve", form="circle", radius=2)
        self.assertRegex(repr(made), r"(?s)^parts: without a file, units mm, 1 B-spline surface\n.*curve of degree 2.*volume of degree 3")
        for k in range(40):
            made.new(size=(1, 1))
        self.assertRegex(repr(made), r"\n  and \d+ more lines$")

    def test_views_do_not_copy_and_stay(self):
        doc = sheet()
        shape = next(iter(doc))
        points = shape.control_points
        self.assertTrue(np.shares_memory(points, shape.control_points))
        kept = points.copy()
        doc.step(2)
        np.testing.assert_array_equal(points, kept)
        self.assertFalse(np.shares_memory(points, shape.control_points))

    def test_reports(self):
        report = sheet().step(4).report
        self.assertEqual(report.steps.shape, (4,))
        self.assertEqual(report.steps.dtype["residual"], np.float64)
        self.assertTrue((report.steps["time"] > 0).all())
        self.assertTrue(report.steps["converged"].dtype == np.bool_)
        self.assertGreaterEqual(set(report.to_dict()), {"steps", "time", "edges", "seams", "notes", "energy_after"})

    def test_analysis(self):
        doc = sheet().step(2)
        result = doc.analyse(samples=5)
        self.assertEqual(result["points"].shape, (5, 5, 3))
        self.assertEqual(result["displacement"].shape, (5, 5, 3))
        self.assertFalse(result["points"].flags.writeable)
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "r.vtu"
            result.to_vtu(path)
            self.assertIn("displacement", path.read_text())
        with self.assertRaisesRegex(knead.Error, "samples"):
            doc.analyse(samples=1)


class Files(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name)

    def test_saved_files_are_read_again(self):
        doc = sheet().step(2)
        doc.save(self.path / "out.step")
        again = knead.open(self.path / "out.step")
        np.testing.assert_array_equal(next(iter(again)).control_points, next(iter(doc)).control_points)
        doc.save(self.path / "out.step.gz")
        self.assertLess((self.path / "out.step.gz").stat().st_size, (self.path / "out.step").stat().st_size)
        self.assertEqual(len(knead.open(self.path / "out.step.gz").surfaces), 1)

    def test_triangles_are_exported_and_not_saved(self):
        doc = knead.open(BONNET)
        for ending in ("glb", "stl"):
            self.assertIsInstance(doc.export(self.path / f"x.{ending}"), list)
            self.assertGreater((self.path / f"x.{ending}").stat().st_size, 1000)
        with self.assertRaisesRegex(knead.InputError, "use export"):
            doc.save(self.path / "y.stl")
        with self.assertRaises(knead.InputError):
            doc.save(self.path / "y.docx")
        self.assertEqual(sorted(p.name for p in self.path.iterdir()), ["x.glb", "x.stl"])

    def test_other_formats(self):
        doc = knead.open(BONNET)
        doc.export(self.path / "x.igs")
        again = knead.open(self.path / "x.igs")
        np.testing.assert_array_equal(again.surfaces[0].control_points, doc.surfaces[0].control_points)

    def test_missing_files(self):
        for call in (lambda: knead.open(self.path / "none.step"), lambda: knead.new().run(self.path / "none.json")):
            with self.assertRaises(FileNotFoundError) as caught:
                call()
            error = caught.exception
            self.assertIsInstance(error, knead.Error)
            self.assertIsInstance(error, ValueError)
            self.assertIn("none", error.file)
            self.assertIn("none", str(error))

    def test_what_is_no_cad_file(self):
        with self.assertRaises(ValueError) as caught:
            knead.open(b"hello", name="a.step")
        self.assertEqual(caught.exception.file, "a.step")
        (self.path / "a.json").write_text('{"knead": 2,\n "commands": [}')
        with self.assertRaises(knead.Error) as caught:
            knead.new().run(self.path / "a.json")
        self.assertEqual(caught.exception.line, 2)
        with self.assertRaisesRegex(TypeError, "source must be"):
            knead.open(7)
        with self.assertRaisesRegex(knead.InputError, "unit"):
            knead.new(unit="ell")


if __name__ == "__main__":
    unittest.main()
