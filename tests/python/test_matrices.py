import os
import subprocess
import sys
import unittest

import numpy as np

import knead
from support import FOLDER, clamped, sheet, surface


class Matrices(unittest.TestCase):
    def test_stiffness_has_the_null_space_of_the_energy(self):
        for weights in (False, True):
            s = surface(weights=weights)
            k, m, d, f, free = knead.matrices(s, load=(0, 0, 2), mass=3, damping=5)
            n = s.control_points.reshape(-1, 3).shape[0]
            self.assertEqual((k.shape, m.shape, f.shape, free.shape), ((n, n), (n, n), (n, 3), (n,)))
            self.assertEqual(abs(k - k.T).max(), 0)
            # Rational functions of equal control points are constant too, to the tolerance of their integrals.
            np.testing.assert_allclose(k @ np.ones(n), 0, atol=1e-8 if weights else 1e-12)
            self.assertAlmostEqual(float(np.ones(n) @ (m @ np.ones(n))), 3 * 4 * 5, places=7)
            self.assertAlmostEqual(float(np.ones(n) @ (d @ np.ones(n))), 5 * 4 * 5, places=7)
            np.testing.assert_allclose(f.sum(axis=0), (0, 0, 2 * 4 * 5), rtol=1e-8, atol=1e-12)

    def test_held_rows_are_left_out(self):
        s = surface()
        whole, part = knead.matrices(s), knead.matrices(s, hold=1)
        m, n = s.net
        expected = [i * n + j for i in range(1, m - 1) for j in range(1, n - 1)]
        np.testing.assert_array_equal(part.free, expected)
        self.assertEqual(abs(part.stiffness - whole.stiffness[expected][:, expected]).max(), 0)

    def test_arrays_share_memory(self):
        from knead import _core
        from knead.matrices import of_parts

        for hold in (0, 1):
            parts = _core.matrices(surface()._core, (1, 0, 1), (0.01, 0.01, 0.01), 1.0, 1.0, (0.0, 0.0, 1.0), hold, False, 1e-10)
            made = of_parts(parts)
            for matrix, arrays in zip(made, parts[:3]):
                for array, view in zip((matrix.data, matrix.indices, matrix.indptr), arrays):
                    self.assertTrue(np.shares_memory(array, np.asarray(view)))
            for array, view in zip(made[3:], parts[3:]):
                self.assertTrue(np.shares_memory(array, np.asarray(view)))

    @unittest.skipUnless(os.path.exists("/proc/self/clear_refs"), "this system does not tell the memory of a process")
    def test_memory(self):
        for hold in (0, 2):
            # What is freed is given back at once, so that what is left is what is used.
            done = subprocess.run([sys.executable, "-c", MEMORY, str(hold)], capture_output=True, text=True, check=True,
                                  cwd=FOLDER, env={**os.environ, "MALLOC_MMAP_THRESHOLD_": "1000000"})
            size, most, left = map(int, done.stdout.split())
            self.assertLess(left, 1.1 * size, done.stdout)
            # By `FreeSystem` in C++ it is 2.4 times the size, most of it for a while.
            self.assertLess(most, 1.6 * size, done.stdout)

    def test_of_documents(self):
        doc = sheet(net=(9, 9))
        k, m, d, f, free = doc.matrices()
        self.assertEqual(k.shape, (49, 49))
        self.assertEqual(len(free), 49)
        raw = doc.matrices(units="raw")
        self.assertGreater(abs(raw.mass - m).max(), 0)

    def test_gramians(self):
        knots = clamped(3, 4)
        g = knead.gramian(knots, 3)
        self.assertEqual(g.shape, (7, 7))
        self.assertAlmostEqual(float(g.sum()), 4, places=12)
        self.assertEqual(abs(g - g.T).max(), 0)
        stiff = knead.gramian(knots, 3, 1, 1)
        np.testing.assert_allclose(stiff @ np.ones(7), 0, atol=1e-13)
        mixed, other = knead.gramian(knots, 3, 1, 0), knead.gramian(knots, 3, 0, 1)
        self.assertEqual(abs(mixed - other.T).max(), 0)
        nodes, factors = np.polynomial.legendre.leggauss(5)
        s = knead.Curve(3, knots, np.eye(7)[:, [0, 1, 2]])
        total = sum(0.5 * w * np.multiply.outer(x, x) for a in range(4) for t, w in zip(nodes, factors)
                    for x in [s(a + 0.5 + 0.5 * t)])
        np.testing.assert_allclose(g.toarray()[:3, :3], total, atol=1e-14)

    def test_scipy_is_imported_when_it_is_needed(self):
        code = "import knead, sys; assert 'scipy' not in sys.modules; knead.gramian([0,0,1,1], 1); assert 'scipy' in sys.modules"
        subprocess.run([sys.executable, "-c", code], check=True)

    def test_errors(self):
        with self.assertRaisesRegex(TypeError, "surface must be"):
            knead.matrices(7)
        with self.assertRaisesRegex(knead.InputError, "alpha"):
            knead.matrices(surface(), alpha=(1, 0))
        with self.assertRaises(knead.Error):
            knead.matrices(surface(), alpha=(-1, 0, 1))
        with self.assertRaises(knead.Error):
            knead.matrices(surface(), hold=9)
        with self.assertRaises(knead.Error):
            knead.new().matrices()


# The bytes of the arrays of a system of 256 x 256 control points, and by how much the process has grown, most and in the end.
MEMORY = """
import sys
import numpy as np
import knead
from support import clamped, surface

def memory(name):
    return next(1024 * int(line.split()[1]) for line in open("/proc/self/status") if line.startswith(name))

knead.matrices(surface())
before = memory("VmRSS")
with open("/proc/self/clear_refs", "w") as file:
    file.write("5")
s = knead.Surface(3, 2 * (clamped(3, 253),), np.zeros((256, 256, 3)))
made = knead.matrices(s, hold=int(sys.argv[1]))
arrays = [getattr(m, name) for m in made[:3] for name in ("data", "indices", "indptr")] + [made.load, made.free, s.control_points]
print(sum(a.nbytes for a in arrays), memory("VmHWM") - before, memory("VmRSS") - before)
"""


class Snakes(unittest.TestCase):
    def disc(self, dtype=float):
        y, x = np.mgrid[:80, :100]
        inside = (x - 50) ** 2 + (y - 40) ** 2 < 20 ** 2
        return (inside * (1 if dtype is float else 255)).astype(dtype)

    def circle(self, radius):
        t = np.linspace(0, 2 * np.pi, 24, endpoint=False)
        return np.stack([50 + radius * np.cos(t), 40 + radius * np.sin(t)], axis=1)

    def test_a_disc_is_found(self):
        for dtype in (float, np.uint8):
            c = knead.snake(self.disc(dtype), start=self.circle(28), image={"region": 1, "edge": 0}, units=400, alpha=1,
                            beta=300, gamma=0.1, motion=0.02)
            self.assertTrue(c.converged)
            self.assertEqual(c.mask.shape, (80, 100))
            wrong = (c.mask != (self.disc() > 0.5)).sum()
            self.assertLess(wrong, 0.03 * np.pi * 400)
            middle = c.curve(np.linspace(*c.curve.domain, 50))[:, :2].mean(axis=0)
            np.testing.assert_allclose(middle, (50, 40), atol=0.5)

    def test_progress_and_several(self):
        told = []
        several = knead.snake(self.disc(), start=[{"centre": [50, 40], "radii": 28}, {"centre": [20, 20], "radii": 8}],
                              max_iterations=40, progress=lambda done, all: told.append(done))
        self.assertEqual(len(several), 2)
        self.assertGreater(len(told), 1)
        told = []
        at_rest = knead.snake(self.disc(), start=self.circle(28), image={"region": 1, "edge": 0}, units=400, alpha=1,
                              beta=300, gamma=0.1, motion=0.02, progress=lambda done, all: told.append((done, all)))
        self.assertEqual(told[-1], (at_rest.iterations, at_rest.iterations))

    def test_blobs_by_default(self):
        found = knead.snake(self.disc(), blobs={}, max_iterations=5)
        self.assertEqual(len(found), len(knead.snake(self.disc(), blobs={"dark": False}, max_iterations=5)))
        self.assertGreater(len(found), 0)

    def test_volumes(self):
        z, y, x = np.mgrid[:24, :26, :28]
        ball = ((x - 14) ** 2 + (y - 13) ** 2 + (z - 12) ** 2 < 7 ** 2).astype(float)
        s = knead.snake(ball)
        self.assertEqual((s.form, s.mask.shape), ("sphere", ball.shape))
        self.assertLess((s.mask != (ball > 0.5)).sum(), 0.15 * ball.sum())
        self.assertAlmostEqual(s.volume / (4 / 3 * np.pi * 343), 1, delta=0.15)

    def test_errors(self):
        with self.assertRaisesRegex(knead.InputError, "picture"):
            knead.snake([1, 2, 3], start=[(0, 0)])
        with self.assertRaisesRegex(knead.InputError, "start"):
            knead.snake(self.disc(), start=[1, 2, 3])
        with self.assertRaisesRegex(knead.Error, "snakes"):
            knead.snake(self.disc())
        with self.assertRaisesRegex(knead.Error, "alfa"):
            knead.snake(self.disc(), start=self.circle(20), alfa=1)


if __name__ == "__main__":
    unittest.main()
