#include "seams_support.hpp"

namespace knead {
namespace {

using namespace knead::testing;

constexpr double corner_rounding = 1e-13, corner_angle_rounding = 1e-10;

void expect_kept(const Coupled& c, SeamContinuity continuity) {
  const auto after = c.moved(11);
  for (const SeamReport& report : c.coupling.reports) {
    EXPECT_EQ(report.continuity, continuity) << report.reason;
    EXPECT_LT(gap_change(c.patches, after, report.seam), corner_rounding);
    if (report.continuity < SeamContinuity::g1) continue;
    EXPECT_LT(angle_change(c.patches, after, report.seam), corner_angle_rounding);
  }
}

/// Sector k of n of a disc, bilinear in shape: u from the centre along one spoke, v along the next.
Surface sector(int k, int n, const KnotVector& knots) {
  const auto spoke = [n](int i) {
    const double angle = 2 * std::numbers::pi * i / n;
    return Point(std::cos(angle), std::sin(angle), 0);
  };
  Points points(knots.count() * knots.count(), 3);
  for (int i = 0; i < knots.count(); ++i) {
    for (int j = 0; j < knots.count(); ++j) {
      points.row(i * knots.count() + j) =
          knots.greville(i) * spoke(k) + knots.greville(j) * spoke(k + 1);
    }
  }
  return make_surface(knots, knots, points);
}

TEST(SeamCorners, PatchesAroundACornerStayTogether) {
  for (int n : {3, 5, 7}) {
    std::vector<Surface> patches;
    for (int k = 0; k < n; ++k) {
      const Surface s = sector(k, n, clamped_knots(3, {0, 0.5, 1}));
      patches.push_back(k % 3 == 0 ? transposed(s) : k % 3 == 1 ? turned(s, 0) : s);
    }
    const Coupled c(patches);
    ASSERT_EQ(c.coupling.reports.size(), static_cast<std::size_t>(n));
    expect_kept(c, SeamContinuity::c0);                   // the cross-derivatives meet askew
    EXPECT_EQ(c.space.free_count(), 1 + n * 4 + n * 16);  // the centre, spokes, insides
  }
}

TEST(SeamCorners, FourPatchesInAGridAreSmoothAtTheirCorner) {
  std::vector<Surface> patches;
  for (int k = 0; k < 4; ++k) {
    const Surface s = sector(k, 4, clamped_knots(3, {0, 0.25, 1}));
    patches.push_back(k == 1 ? transposed(s) : k == 2 ? turned(s, 1) : s);
  }
  const Coupled c(patches);
  ASSERT_EQ(c.coupling.reports.size(), 4u);
  expect_kept(c, SeamContinuity::g1);
  // As one surface: a C1 tensor product of two halves that share 2 functions less than they have
  // together.
  EXPECT_EQ(c.space.free_count(), (5 + 5 - 2) * (5 + 5 - 2));
}

TEST(SeamCorners, ACubeIsClosed) {
  const KnotVector k = uniform_clamped(2, 3);
  const int n = k.count();
  const Surface face = sheet(k, k);
  std::vector<Surface> patches;
  for (int axis = 0; axis < 3; ++axis) {
    for (int side = 0; side < 2; ++side) {
      Points points = face.control_points();
      for (Eigen::Index i = 0; i < points.rows(); ++i) {
        const Point p = points.row(i);
        points(i, axis) = side;
        points(i, (axis + 1) % 3) = side == 0 ? p.x() : 1 - p.x();
        points(i, (axis + 2) % 3) = p.y();
      }
      patches.push_back(*face.with_control_points(points));
    }
  }
  const Coupled c(patches);
  ASSERT_EQ(c.coupling.reports.size(), 12u);
  expect_kept(c, SeamContinuity::c0);
  EXPECT_EQ(c.space.free_count(), 8 + 12 * (n - 2) + 6 * (n - 2) * (n - 2));
  // All at one corner move alike.
  const auto after = c.moved(5);
  for (std::size_t a = 0; a < 6; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      for (const int i : {0, n - 1, n * (n - 1), n * n - 1}) {
        for (const int j : {0, n - 1, n * (n - 1), n * n - 1}) {
          if (patches[a].control_points().row(i) != patches[b].control_points().row(j)) continue;
          EXPECT_LT((after[a].control_points().row(i) - after[b].control_points().row(j)).norm(),
                    corner_rounding);
        }
      }
    }
  }
}

/// A torus whose control points lie on a torus: m × n of them around, the last `wrap_u`, `wrap_v`
/// equal to the first.
Surface torus(const KnotVector& u, const KnotVector& v, int wrap_u, int wrap_v) {
  Points points(u.count() * v.count(), 3);
  for (int i = 0; i < u.count(); ++i) {
    for (int j = 0; j < v.count(); ++j) {
      const double a = 2 * std::numbers::pi * (i % (u.count() - wrap_u)) / (u.count() - wrap_u);
      const double b = 2 * std::numbers::pi * (j % (v.count() - wrap_v)) / (v.count() - wrap_v);
      points.row(i * v.count() + j) << (3 + std::cos(b)) * std::cos(a),
          (3 + std::cos(b)) * std::sin(a), std::sin(b);
    }
  }
  return make_surface(u, v, points);
}

TEST(SeamCorners, APeriodicTorusStaysPeriodicInAllDerivatives) {
  const KnotVector u = uniform_unclamped(3, 8), v = uniform_unclamped(2, 7);
  const Coupled c({torus(u, v, 3, 2)});
  ASSERT_EQ(c.coupling.reports.size(), 2u);
  expect_kept(c, SeamContinuity::periodic);
  EXPECT_EQ(c.space.free_count(), 8 * 7);
  const Surface after = c.moved(5)[0];
  const std::vector<double> inside{3.3, 4.1, 6.6}, ends_u{3, 11}, ends_v{2, 9};
  const auto across_u = evaluate_grid<2>(after, {ends_u, inside}, 2),
             across_v = evaluate_grid<2>(after, {inside, ends_v}, 1);
  for (const MultiIndex<2>& a : multi_indices<2>(2)) {
    EXPECT_LT((across_u->at(a).topRows(3) - across_u->at(a).bottomRows(3)).cwiseAbs().maxCoeff(),
              corner_rounding);
    if (a[0] + a[1] > 1) continue;
    for (int k = 0; k < 3; ++k)
      EXPECT_LT((across_v->at(a).row(2 * k) - across_v->at(a).row(2 * k + 1)).norm(),
                corner_rounding);
  }
  const Coupled smooth({torus(u, v, 3, 2)}, {.most = SeamContinuity::g1});
  expect_kept(smooth, SeamContinuity::g1);
  EXPECT_EQ(smooth.space.free_count(), 9 * 7);  // C1 of degree 3 has one more than C2
}

TEST(SeamCorners, PeriodicWithUnevenKnotsAndWeights) {
  std::vector<double> knots;
  const std::vector<double> breaks = {0, 1, 1.5, 3.5, 3.6};  // and again every 5
  for (int k = -3; k <= 5 + 3; ++k)
    knots.push_back(5.0 * std::floor(k / 5.0) + breaks[static_cast<std::size_t>((k + 5) % 5)]);
  const KnotVector u = make_knots(3, knots), v = uniform_clamped(2, 2);
  Points points(u.count() * v.count(), 3);
  std::vector<double> weights;
  for (int i = 0; i < u.count(); ++i) {
    for (int j = 0; j < v.count(); ++j) {
      const double a = 2 * std::numbers::pi * (i % 5) / 5;
      points.row(i * v.count() + j) << std::cos(a), std::sin(a), j;
      weights.push_back(1 + 0.5 * std::sin(1.0 + i % 5 + 2 * j));
    }
  }
  const Coupled c({make_surface(u, v, points, weights)});
  ASSERT_EQ(c.coupling.reports.size(), 1u);
  expect_kept(c, SeamContinuity::periodic);
  EXPECT_EQ(c.space.free_count(), 5 * v.count());
  // Weights that do not repeat: no rational basis is periodic any more.
  weights[0] = 1.3;
  const Coupled broken({make_surface(u, v, points, weights)}, {}, 10);
  for (const SeamReport& report : broken.coupling.reports)
    EXPECT_LT(report.continuity, SeamContinuity::periodic);
}

TEST(SeamCorners, AClampedTorusAndAnExactCylinderStaySmooth) {
  // A clamped net closed both ways whose rows beside the seam lie opposite of each other.
  const KnotVector k = uniform_clamped(3, 4);
  const int n = k.count();
  Points points(n * n, 3);
  const double around[7] = {0, 0.1, 0.3, 0.5, 0.7, 0.9, 1};
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const auto place = [&](int q) {  // on a square, the seam in the middle of a side
        const double a = 2 * std::numbers::pi * around[q];
        const double x = q == 0 || q == n - 1 ? std::cos(2 * std::numbers::pi * 0.1) : std::cos(a);
        return std::pair(x, q == 0 || q == n - 1 ? 0.0 : std::sin(a));
      };
      const auto [x, y] = place(i);
      const auto [r, z] = place(j);
      points.row(i * n + j) << (3 + r) * x, (3 + r) * y, z;
    }
  }
  const Coupled c({make_surface(k, k, points)});
  ASSERT_EQ(c.coupling.reports.size(), 2u);
  expect_kept(c, SeamContinuity::g1);
  EXPECT_EQ(c.space.free_count(), (n - 2) * (n - 2));

  const Coupled tube({cylinder()});
  expect_kept(tube, SeamContinuity::g1);
  EXPECT_EQ(tube.space.free_count(), 2 * (9 - 2));
  const Coupled ball({sphere()});
  ASSERT_EQ(ball.coupling.reports.size(), 1u);
  EXPECT_EQ(ball.report().continuity, SeamContinuity::g1);
  EXPECT_LT(gap_change(ball.patches, ball.moved(2), ball.report().seam), corner_rounding);
}

TEST(SeamCorners, ATranslationOfEverythingIsAlwaysAllowed) {
  for (const auto& patches : {smooth_pair(uniform_clamped(3, 3), uniform_clamped(2, 3),
                                          uniform_clamped(3, 4), 1.5, 1, 1e2),
                              std::vector<Surface>{cylinder()}, std::vector<Surface>{sphere()}}) {
    const Coupled c(patches);
    const Points x = Points::Ones(c.space.size(), 3) * 0.7;
    EXPECT_LT(c.space.violation(x), 1e-14);
  }
}

/// side × side patches of a sheet, cut at uneven places and turned every way, each point off by
/// some noise.
std::vector<Surface> uneven_grid(int side, double noise) {
  const std::vector<double> cuts = {0, 1, 1.3, 2.9, 3.6, 5, 5.4, 6.5, 7.1};
  std::vector<Surface> patches;
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
      const Surface s = uniform_sheet(3, 6, 6, cuts[a + 1] - cuts[a], cuts[b + 1] - cuts[b]);
      Points points = s.control_points() +
                      noise * random_points(s.size(), static_cast<unsigned>(side * i + j + 1));
      points.rowwise() += Eigen::RowVector3d(cuts[a], cuts[b], 0);
      patches.push_back(with_edge_at(*s.with_control_points(points),
                                     static_cast<SurfaceEdge>((i + 2 * j) % 4), j % 3 == 1));
    }
  }
  return patches;
}

TEST(SeamCorners, ALargeGridIsOneSmoothSheet) {
  constexpr int side = 8;
  const Coupled c(uneven_grid(side, 0));
  ASSERT_EQ(c.coupling.reports.size(), 2u * side * (side - 1));
  expect_kept(c, SeamContinuity::g1);
  const int across = 6 * side - 2 * (side - 1);
  EXPECT_EQ(c.space.free_count(), across * across);
}

TEST(SeamCorners, RoundingInAFileHoldsNothing) {
  // Ratios that do not fit around a corner to the last digits would hold its tangents and its twist
  // still.
  constexpr int side = 6;
  for (double noise : {1e-13, 1e-11, 1e-9, 1e-5}) {
    const Coupled c(uneven_grid(side, noise));
    ASSERT_EQ(c.coupling.reports.size(), 2u * side * (side - 1));
    // Small beside the smallest spans, 0.1: no derivative turns round.
    const auto after = c.moved(11, 0.005);
    for (const SeamReport& report : c.coupling.reports) {
      EXPECT_EQ(report.continuity, SeamContinuity::g1) << report.reason;
      EXPECT_LT(gap_change(c.patches, after, report.seam), corner_rounding);
      EXPECT_LT(angle_change(c.patches, after, report.seam), std::max(1e-6, report.deviation));
    }
    const int across = 6 * side - 2 * (side - 1);
    EXPECT_EQ(c.space.free_count(), across * across) << noise;
    EXPECT_LT(c.space.violation(Points::Ones(c.space.size(), 3)), 1e-14);
  }
}

}  // namespace
}  // namespace knead
