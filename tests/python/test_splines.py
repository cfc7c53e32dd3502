import copy
import gc
import pickle
import unittest

import numpy as np

import knead
from support import basis, clamped, surface


class Values(unittest.TestCase):
    def test_surfaces_are_sums_of_basis_functions(self):
        for weights in (False, True):
            s = surface(weights=weights)
            for u, v in ((0.0, 0.0), (1.3, 2.7), (4.0, 5.0), (2.0, 3.0)):
                n = np.multiply.outer(basis(s.knots[0], 3, u), basis(s.knots[1], 2, v))
                if weights:
                    n = n * s.weights
                expected = np.einsum("ij,ijk->k", n, s.control_points) / n.sum()
                np.testing.assert_allclose(s(u, v), expected, rtol=1e-13, atol=1e-13)

    def test_parameters_broadcast(self):
        s = surface()
        u, v = np.linspace(0, 4, 5)[:, None], np.linspace(0, 5, 7)
        self.assertEqual(s(u, v).shape, (5, 7, 3))
        self.assertEqual(s(1, 2).shape, (3,))
        self.assertEqual(s(1.0, 2.0).shape, (3,))
        self.assertEqual(s(np.empty(0), 0.5).shape, (0, 3))
        np.testing.assert_array_equal(s(u, v)[2, 3], s(float(u[2, 0]), float(v[3])))
        np.testing.assert_array_equal(s([1, 2], 3), s(np.float32([1, 2]), np.int8(3)))

    def test_grids_have_the_bits_of_points(self):
        for weights in (False, True):
            s = surface(weights=weights)
            us, vs = np.linspace(0, 4, 23), np.linspace(0, 5, 31)
            for a, b in zip(s.grid(us, vs, order=2), s.evaluate(us[:, None], vs, order=2)):
                np.testing.assert_array_equal(a, b)

    def test_derivatives_are_limits_of_differences(self):
        s = surface(weights=True)
        u, v, h = np.array([0.7, 1.9, 3.2]), np.array([0.4, 2.2, 4.6]), 1e-5
        x, dx, ddx = s.evaluate(u, v, order=2)
        self.assertEqual((x.shape, dx.shape, ddx.shape), ((3, 3), (3, 2, 3), (3, 3, 3)))
        np.testing.assert_allclose(dx[:, 0], (s(u + h, v) - s(u - h, v)) / (2 * h), atol=1e-7)
        np.testing.assert_allclose(dx[:, 1], (s(u, v + h) - s(u, v - h)) / (2 * h), atol=1e-7)
        mixed = (s(u + h, v + h) - s(u + h, v - h) - s(u - h, v + h) + s(u - h, v - h)) / (4 * h * h)
        np.testing.assert_allclose(ddx[:, 1], mixed, atol=1e-3)

    def test_at_knots_the_side_is_chosen(self):
        curve = knead.Curve(1, [0, 0, 1, 2, 2], [(0, 0, 0), (1, 0, 0), (1, 2, 0)])
        np.testing.assert_array_equal(curve.evaluate(1.0, order=1)[1], (0, 2, 0))
        np.testing.assert_array_equal(curve.evaluate(1.0, order=1, side="left")[1], (1, 0, 0))

    def test_volumes_and_curves(self):
        knots = clamped(1, 1)
        net = np.stack(np.meshgrid([0, 1], [0, 2], [0, 3], indexing="ij"), axis=-1)
        v = knead.Volume(1, (knots, knots, knots), net)
        np.testing.assert_allclose(v(0.5, 0.25, [0.1, 1.0]), [(0.5, 0.5, 0.3), (0.5, 0.5, 3)], rtol=1e-15)
        x, dx = v.evaluate(0.3, 0.3, 0.3, order=1)
        np.testing.assert_allclose(dx, np.diag([1, 2, 3]), atol=1e-15)
        self.assertEqual(v.grid([0, 1], [0, 0.5, 1], [0]).shape, (2, 3, 1, 3))
        c = knead.Curve(2, clamped(2, 1), [(0, 0, 0), (1, 0, 0), (1, 1, 0)])
        self.assertEqual((c.degree, c.net, c.domain), (2, 3, (0.0, 1.0)))
        self.assertEqual(c.evaluate([0, 1], order=2)[2].shape, (2, 3))


class Memory(unittest.TestCase):
    def test_control_points_are_read_only_views(self):
        s = surface(weights=True)
        for array in (s.control_points, s.weights, s.knots[0]):
            self.assertFalse(array.flags.writeable)
            self.assertFalse(array.flags.owndata)
        self.assertTrue(np.shares_memory(s.control_points, s.control_points))
        points, first = s.control_points, s.control_points[0, 0].copy()
        del s
        gc.collect()
        np.testing.assert_array_equal(points[0, 0], first)

    def test_what_it_is_made_of_may_change_afterwards(self):
        points = np.zeros((4, 3))
        c = knead.Curve(3, clamped(3, 1), points)
        points[:] = 7
        self.assertEqual(float(c.control_points.max()), 0)

    def test_memory_of_the_caller_is_used(self):
        s = surface()
        us, vs = np.linspace(0, 4, 11), np.linspace(0, 5, 13)
        out = np.full((11, 13, 3), np.nan)
        self.assertIs(s.grid(us, vs, out=out), out)
        np.testing.assert_array_equal(out, s.grid(us, vs))
        several = s.grid(us, vs, order=1)
        kept = [np.array(a) for a in several]
        for a in several:
            a[...] = 0
        self.assertIs(s.grid(us, vs, order=1, out=several), several)
        for a, b in zip(several, kept):
            np.testing.assert_array_equal(a, b)
        # In any layout.
        apart = (np.zeros((11, 13, 3)), np.zeros((11, 13, 2, 3)))
        s.grid(us, vs, order=1, out=apart)
        np.testing.assert_array_equal(apart[1], kept[1])
        turned = np.zeros((3, 13, 11)).T
        s.grid(us, vs, out=turned)
        np.testing.assert_array_equal(turned, kept[0])

    def test_memory_that_does_not_fit_is_refused(self):
        s = surface()
        us = np.linspace(0, 4, 5)
        with self.assertRaisesRegex(knead.InputError, "out.*shape"):
            s.grid(us, us, out=np.zeros((5, 4, 3)))
        with self.assertRaisesRegex(TypeError, "out must be a writable array of float64"):
            s.grid(us, us, out=np.zeros((5, 5, 3), dtype=np.float32))
        frozen = np.zeros((5, 5, 3))
        frozen.flags.writeable = False
        with self.assertRaisesRegex(TypeError, "writable"):
            s.grid(us, us, out=frozen)

    def test_splines_are_values(self):
        s = surface(weights=True)
        again = pickle.loads(pickle.dumps(s))
        self.assertEqual(s, again)
        self.assertEqual(hash(s), hash(again))
        self.assertIs(copy.deepcopy(s), s)
        self.assertNotEqual(s, surface(seed=2))
        with self.assertRaises(AttributeError):
            s.degree = (1, 1)


class Geometry(unittest.TestCase):
    def arc(self):
        r = np.sqrt(0.5)
        return knead.Curve(2, clamped(2, 1), [(2, 0, 0), (2, 2, 0), (0, 2, 0)], [1, r, 1])

    def test_a_circle_has_one_curvature(self):
        k = self.arc().curvature(np.linspace(0, 1, 9))
        np.testing.assert_allclose(k.curvature, 0.5, rtol=1e-14)
        np.testing.assert_allclose(np.einsum("ij,ij->i", k.tangent, k.normal), 0, atol=1e-14)

    def test_a_cylinder(self):
        r, arc = np.sqrt(0.5), self.arc()
        net = np.stack([arc.control_points, arc.control_points + (0, 0, 3)], axis=1)
        s = knead.Surface((2, 1), (clamped(2, 1), clamped(1, 1)), net, [[1, 1], [r, r], [1, 1]])
        u, v = np.linspace(0, 1, 5)[:, None], np.linspace(0, 1, 4)
        k = s.curvature(u, v)
        np.testing.assert_allclose(k.gaussian, 0, atol=1e-14)
        np.testing.assert_allclose(abs(k.mean), 0.25, rtol=1e-13)
        self.assertEqual((k.principal.shape, k.directions.shape), ((5, 4, 2), (5, 4, 2, 3)))
        np.testing.assert_allclose(k.normal, s.normals(u, v), atol=1e-14)
        x = s(u, v)
        at, d = s.closest(x + 0.25 * s.normals(u, v))
        np.testing.assert_allclose(d, 0.25, rtol=1e-12)
        np.testing.assert_allclose(s(at[..., 0], at[..., 1]), x, atol=1e-10)

    def test_refined_and_coarsened_have_the_same_shape(self):
        s = surface(weights=True)
        finer = s.refined(u=[0.5, 0.5, 3.25], v=1.5).elevated(v=1)
        self.assertEqual((finer.degree, finer.net), ((3, 3), (10, s.refined(v=1.5).elevated(v=1).net[1])))
        u, v = np.linspace(0, 4, 9)[:, None], np.linspace(0, 5, 9)
        np.testing.assert_allclose(finer(u, v), s(u, v), rtol=1e-13, atol=1e-13)
        removal = s.refined(u=[0.5, 3.25]).coarsened("u", 1e-9)
        np.testing.assert_array_equal(removal.removed, (0.5, 3.25))
        self.assertLessEqual(removal.error_bound, 1e-9)
        self.assertEqual(removal.spline.net, s.net)


class Arrays(unittest.TestCase):
    def test_degrees_and_knots_may_be_arrays(self):
        knots, points = np.array([clamped(1, 1), clamped(1, 1)]), np.zeros((2, 2, 3))
        s = knead.Surface(np.array([1, 1]), knots, points)
        self.assertEqual(s, knead.Surface(1, list(knots), points))
        self.assertEqual(s, knead.Surface(np.array(1), list(knots), points))


class Errors(unittest.TestCase):
    def test_what_is_wrong_is_named(self):
        points = np.zeros((4, 3))
        for kind, text, make in (
                (knead.InputError, "knots", lambda: knead.Curve(3, [0, 0, 0, 0, 2, 1, 1, 1], points)),
                (knead.InputError, "control_points", lambda: knead.Curve(3, clamped(3, 1), np.zeros((5, 3)))),
                (knead.InputError, "weights", lambda: knead.Curve(3, clamped(3, 1), points, [1, 1])),
                (knead.InputError, "degree", lambda: knead.Curve(0, clamped(3, 1), points)),
                (TypeError, "control_points must be numbers, not str 'x'", lambda: knead.Curve(3, clamped(3, 1), "x")),
                (TypeError, "degree must be a whole number", lambda: knead.Curve(2.5, clamped(3, 1), points)),
                (TypeError, "knots must be a sequence of 2", lambda: knead.Surface(3, [clamped(3, 1)], points)),
                (TypeError, "u must be numbers", lambda: knead.Curve(3, clamped(3, 1), points)(None)),
                (knead.InputError, "order", lambda: knead.Curve(3, clamped(3, 1), points).evaluate(0, order=-1)),
                (knead.InputError, "side", lambda: knead.Curve(3, clamped(3, 1), points).evaluate(0, side="up"))):
            with self.subTest(text), self.assertRaisesRegex(kind, text) as caught:
                make()
            self.assertNotIn("\n", str(caught.exception))

    def test_outside_the_domain(self):
        s = surface()
        for at in (lambda: s(5.0, 0.0), lambda: s([0, 5], 0), lambda: s.grid([0, 5], [0])):
            with self.assertRaises(knead.Error) as caught:
                at()
            error = caught.exception
            self.assertIsInstance(error, ValueError)
            self.assertTrue(error.what and error.where and error.kind in ("usage", "input"))

    def test_a_pole_has_no_curvature(self):
        knots = clamped(1, 1)
        s = knead.Surface(1, (knots, knots), [[(0, 0, 0), (0, 0, 0)], [(1, 0, 0), (0, 1, 0)]])
        with self.assertRaises(ArithmeticError) as caught:
            s.curvature(0, 0.5)
        self.assertEqual(caught.exception.kind, "numerical")
        np.testing.assert_array_equal(s.normals(0, 0.5), (0, 0, 0))


if __name__ == "__main__":
    unittest.main()
