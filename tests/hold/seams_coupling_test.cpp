#include "knead/hold/seams.hpp"

#include "seams_support.hpp"

namespace knead {
namespace {

using namespace knead::testing;

/// Sums of some tens of products of numbers below 1, displacements of 0.1.
constexpr double rounding = 1e-13;
/// Normals of cross products of derivatives of size 0.01 and more, and an arc tangent.
constexpr double angle_rounding = 1e-11;

void expect_kept(const Coupled& c, unsigned seed = 7) {
  const auto after = c.moved(seed);
  for (const SeamReport& report : c.coupling.reports) {
    if (report.continuity == SeamContinuity::none) continue;
    EXPECT_LT(gap_change(c.patches, after, report.seam), rounding) << report.reason;
    if (report.continuity >= SeamContinuity::g1) {
      EXPECT_LT(angle_change(c.patches, after, report.seam), angle_rounding) << report.reason;
    }
  }
}

TEST(SeamCoupling, AllPairsOfEdgesKeepPositionAndTangentPlane) {
  for (double spread : {1.0, 3.0}) {
    const auto pair = smooth_pair(uniform_clamped(2, 3), clamped_knots(3, {0, 2, 3}),
                                  clamped_knots(3, {0, 1, 1.5, 4}, {4, 1, 3, 4}), 2, 1, spread);
    const int along = pair[0].net()[1];
    for (SurfaceEdge a : all_edges) {
      for (SurfaceEdge b : all_edges) {
        for (bool reversed : {false, true}) {
          const Coupled c({with_edge_at(pair[0], a, false), with_edge_at(pair[1], b, reversed)});
          ASSERT_EQ(c.coupling.reports.size(), 1u);
          EXPECT_EQ(c.report().continuity, SeamContinuity::g1) << c.report().reason;
          EXPECT_FALSE(c.report().restricted);
          EXPECT_NEAR(c.report().ratio, 2, 1e-12);
          EXPECT_LT(c.report().deviation, 1e-12);
          EXPECT_EQ(c.report().reason, "");
          EXPECT_EQ(c.space.free_count(),
                    pair[0].size() + pair[1].size() - 2 * along);  // and not one too many
          expect_kept(c);
        }
      }
    }
  }
}

TEST(SeamCoupling, WithoutItGapAndAngleChange) {
  const Coupled c(
      smooth_pair(uniform_clamped(2, 3), uniform_clamped(3, 2), uniform_clamped(3, 3), 2, 1),
      {.most = SeamContinuity::none});
  EXPECT_EQ(c.report().continuity, SeamContinuity::none);
  EXPECT_EQ(c.report().reason, "not coupled: switched off");
  EXPECT_TRUE(c.coupling.constraints.empty());
  EXPECT_GT(gap_change(c.patches, c.moved(3), c.report().seam), 0.05);
  const Coupled hinge(c.patches, {.most = SeamContinuity::c0});
  EXPECT_EQ(hinge.report().continuity, SeamContinuity::c0);
  expect_kept(hinge);
  EXPECT_GT(angle_change(hinge.patches, hinge.moved(3), hinge.report().seam), 0.01);
}

TEST(SeamCoupling, EqualNetsMoveBitForBit) {
  const Coupled c(
      smooth_pair(uniform_clamped(2, 3), uniform_clamped(2, 3), uniform_clamped(3, 4), 1, 2),
      {.most = SeamContinuity::c0});
  const Points x = c.space.feasible(random_points(c.space.size(), 3));
  for (int j = 0; j < 7; ++j) EXPECT_EQ(x.row(j), x.row(c.patches[0].size() + j));
}

TEST(SeamCoupling, AGapStaysAsTheFileHasIt) {
  auto pair =
      smooth_pair(uniform_clamped(2, 3), uniform_clamped(3, 2), uniform_clamped(3, 3), 0.5, 4);
  Points points = pair[1].control_points();
  points += 2e-4 * random_points(points.rows(), 5);
  pair[1] = *pair[1].with_control_points(points);
  const Coupled c(pair);
  ASSERT_EQ(c.coupling.reports.size(), 1u);
  EXPECT_GT(c.report().seam.gap, 5e-5);
  EXPECT_EQ(c.report().continuity, SeamContinuity::g1);
  EXPECT_NE(c.report().reason.find("off a smooth join"), std::string::npos);
  const auto after = c.moved(3, 0.05);
  EXPECT_LT(gap_change(pair, after, c.report().seam), rounding);
  // The bound that the report states, for turns of less than a radian.
  EXPECT_LT(angle_change(pair, after, c.report().seam), c.report().deviation);
  EXPECT_GT(angle_change(pair, after, c.report().seam), 1e-6);
}

TEST(SeamCoupling, OtherKnotsLeaveWhatBothSidesCanFollow) {
  struct Case {
    KnotVector a, b;
    int common;  // dimension of the intersection, by hand
  };
  const std::vector<Case> cases = {
      {clamped_knots(3, {0, 1}), clamped_knots(3, {0, 1, 2, 3, 4}), 4},     // nested
      {clamped_knots(3, {0, 1, 2, 4}), clamped_knots(3, {0, 1, 3, 4}), 5},  // one knot in common
      {clamped_knots(3, {0, 2, 4}, {4, 3, 4}), clamped_knots(3, {0, 2, 4}, {4, 1, 4}),
       5},                                                                       // multiplicities
      {clamped_knots(2, {0, 1, 2}), clamped_knots(4, {0, 1, 2}, {5, 3, 5}), 4},  // degrees, nested
      {clamped_knots(2, {0, 1, 2}, {3, 2, 3}), clamped_knots(4, {0, 1, 2}, {5, 3, 5}),
       4},  // degree and smoothness
      {clamped_knots(1, {0, 1, 3}), clamped_knots(3, {0, 1, 3}, {4, 1, 4}), 2},
      {uniform_unclamped(3, 3), clamped_knots(3, {0, 1, 2, 3}), 6},  // the same on the domain
      {uniform_unclamped(2, 4), clamped_knots(3, {0, 1, 4}, {4, 2, 4}), 4},
      {uniform_clamped(3, 10), uniform_clamped(3, 11), 4},
      {uniform_clamped(3, 40), uniform_clamped(3, 41), 4},
      {uniform_clamped(2, 30), uniform_clamped(3, 20),
       3},  // ten common knots, all too rough for degree 2: C2
  };
  for (const Case& k : cases) {
    for (bool swapped : {false, true}) {
      const KnotVector &a = swapped ? k.b : k.a, &b = swapped ? k.a : k.b;
      const KnotVector across = uniform_clamped(2, 2);
      // Flat and linear in the parameters: the Greville abscissae of the domain's own affine map.
      const Surface left = turned(sheet(across, a), 0), right = sheet(across, b);
      const auto place = [](const Surface& s, double side) {
        Points points = s.control_points();
        const Interval d = s.knots(1).domain();
        for (Eigen::Index i = 0; i < points.rows(); ++i) {
          points(i, 1) =
              (s.knots(1).greville(static_cast<int>(i) % s.net()[1]) - d.lower) / d.length();
          points(i, 0) = side * points(i, 0);
        }
        return *s.with_control_points(points);
      };
      const Coupled c({turned(place(turned(left, 0), -1), 0), place(right, 1)});
      ASSERT_EQ(c.coupling.reports.size(), 1u);
      EXPECT_EQ(c.report().continuity, SeamContinuity::g1) << c.report().reason;
      EXPECT_EQ(c.report().restricted, c.report().reason != "");
      // Edge rows and the next rows live in the common space each, everything else is free.
      const int free =
          c.patches[0].size() + c.patches[1].size() - 2 * (a.count() + b.count()) + 2 * k.common;
      EXPECT_EQ(c.space.free_count(), free) << a.degree() << " " << b.degree();
      expect_kept(c);
    }
  }
}

TEST(SeamCoupling, RefinementsMakeNeighboursAgree) {
  // A ring of four patches with a mirrored seam: what one has, all get, forwards and backwards.
  std::vector<Surface> patches;
  const std::vector<KnotVector> along = {
      clamped_knots(3, {0, 1, 4}), clamped_knots(2, {0, 1, 2}, {3, 2, 3}),
      clamped_knots(3, {10, 11, 12, 20}), clamped_knots(1, {-1, 7})};
  for (const KnotVector& k : along) patches.push_back(sheet(clamped_knots(2, {0, 1}), k));
  std::vector<Seam> seams;
  for (int k = 0; k < 4; ++k)
    seams.push_back({{k, SurfaceEdge::u1}, {(k + 1) % 4, SurfaceEdge::u0}, k == 0});
  const auto wanted = seam_refinements(pointers(patches), seams);
  ASSERT_EQ(wanted.size(), 4u);
  EXPECT_EQ(wanted[0].elevate, 0);
  EXPECT_EQ(wanted[1].elevate, 1);
  EXPECT_EQ(wanted[3].elevate, 2);
  std::vector<Surface> refined = patches;
  for (const SeamRefinement& r : wanted) {
    ASSERT_EQ(r.direction, 1);
    const KnotVector& k = patches[static_cast<std::size_t>(r.patch)].knots(1);
    std::vector<double> knots = r.insert;
    for (std::size_t i = 0; i < k.knots().size(); ++i) {
      knots.push_back(k.knots()[i]);
      if (i == 0 || k.knots()[i] != k.knots()[i - 1])
        knots.insert(knots.end(), static_cast<std::size_t>(r.elevate), k.knots()[i]);
    }
    std::ranges::sort(knots);
    refined[static_cast<std::size_t>(r.patch)] =
        sheet(clamped_knots(2, {0, 1}), make_knots(k.degree() + r.elevate, knots));
  }
  // {1/4, 1/2 twice (elevated to multiplicity 3), 1/10, 2/10} and mirror images.
  EXPECT_EQ(refined[0].net()[1], 4 + 2 * 3 + 3);
  for (const Surface& s : refined) EXPECT_EQ(s.net()[1], refined[0].net()[1]);
  EXPECT_TRUE(seam_refinements(pointers(refined), seams).empty());
  const auto coupled = couple_seams(pointers(refined), first_rows(refined), seams);
  for (const SeamReport& report : coupled->reports) EXPECT_FALSE(report.restricted);
}

TEST(SeamCoupling, ReasonsForLess) {
  const Surface s = uniform_sheet(3, 5, 5);
  const auto at = [](const Surface& surface, auto map) {
    Points points = surface.control_points();
    for (Eigen::Index k = 0; k < points.rows(); ++k) {
      const Point moved = map(Point(points.row(k)));
      points.row(k) = moved;
    }
    return *surface.with_control_points(points);
  };
  const auto expect = [](const std::vector<Surface>& patches, SeamContinuity continuity,
                         const std::string& reason) {
    const Coupled c(patches);
    ASSERT_EQ(c.coupling.reports.size(), 1u) << reason;
    EXPECT_EQ(c.report().continuity, continuity) << reason;
    EXPECT_NE(c.report().reason.find(reason), std::string::npos) << c.report().reason;
    expect_kept(c);
    return;
  };
  const auto shifted = [](const Point& p) { return Point(p + Point(1, 0, 0)); };
  expect({s, at(s, shifted)}, SeamContinuity::g1, "");
  expect({s, at(s, [](const Point& p) { return Point(1, p.y(), p.x()); })}, SeamContinuity::c0,
         "90 degrees");
  expect({s, at(s, [](const Point& p) { return Point(1 + p.x() * (1 + p.y()), p.y(), 0); })},
         SeamContinuity::c0, "no fixed ratio");
  expect({s, at(s, [](const Point& p) { return Point(1 + p.x(), p.y() + 0.3 * p.x(), 0); })},
         SeamContinuity::c0, "no fixed ratio");
  expect({s, at(s, [](const Point& p) { return Point(1 + p.x(), p.y() / 2, 0); })},
         SeamContinuity::none, "part of an edge");
  expect(
      {s,
       at(s, [](const Point& p) { return Point(1 - p.x(), p.y(), std::max(0.0, p.x() - 0.3)); })},
      SeamContinuity::g1, "folded");
  // Weights along the edge: the same shape of the edge's curve by luck only; here a straight line.
  std::vector<double> weights(25, 1.0);
  weights[2] = 1 + 1e-4;
  expect({s, make_surface(s.knots(0), s.knots(1), at(s, shifted).control_points(), weights)},
         SeamContinuity::c0, "weights of its sides");
  std::vector<double> beside(25, 1.0);
  beside[7] = 1.001;
  expect({s, make_surface(s.knots(0), s.knots(1), at(s, shifted).control_points(), beside)},
         SeamContinuity::c0, "weights beside the edge");
  // Edges that can only move as a whole may also be left.
  const Coupled left(
      {s, make_surface(s.knots(0), s.knots(1), at(s, shifted).control_points(), weights)},
      {.rigid = false});
  EXPECT_EQ(left.report().continuity, SeamContinuity::none);
}

TEST(SeamCoupling, WeightsOfEverySizeAreFollowed) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Coupled c(smooth_pair(uniform_clamped(3, 3), uniform_clamped(2, 3), uniform_clamped(3, 4),
                                1.5, seed, 1e6));
    ASSERT_EQ(c.coupling.reports.size(), 1u);
    EXPECT_EQ(c.report().continuity, SeamContinuity::g1) << c.report().reason;
    const auto after = c.moved(seed);
    EXPECT_LT(gap_change(c.patches, after, c.report().seam), rounding);
    // Weights of 1e-6 beside 1e6 leave the edge curve almost standing still: its normal carries few
    // digits.
    EXPECT_LT(angle_change(c.patches, after, c.report().seam), 1e-6);
  }
}

TEST(SeamCoupling, EveryKindOfKnotsAlongTheSeam) {
  for (int degree : {1, 2, 3, 5}) {
    for (const NamedKnots& family : knot_families(degree)) {
      for (bool reversed : {false, true}) {
        // One span across; the seam is stated, as a curve that jumps (multiplicity p + 1) is not
        // found reversed.
        const auto pair =
            smooth_pair(uniform_clamped(2, 1), uniform_clamped(1, 1), family.knots, 1, 3);
        const std::vector<Surface> patches = {pair[0], reversed ? turned(pair[1], 1) : pair[1]};
        const Seam seam{{0, SurfaceEdge::u0}, {1, SurfaceEdge::u0}, reversed};
        EXPECT_TRUE(seam_refinements(pointers(patches), {&seam, 1}).empty()) << family.name;
        const auto coupling = couple_seams(pointers(patches), first_rows(patches), {&seam, 1});
        ASSERT_TRUE(coupling);
        EXPECT_FALSE(coupling->reports[0].restricted) << family.name;
        const auto space =
            ConstraintSpace::create(first_rows(patches).back(), coupling->constraints);
        ASSERT_TRUE(space);
        const auto after =
            displaced(patches, space->feasible(0.1 * random_points(space->size(), 9)));
        EXPECT_LT(gap_change(patches, after, seam), rounding)
            << family.name << " " << degree << reversed;
        if (family.knots.max_interior_multiplicity() <= degree) {
          EXPECT_EQ(coupling->reports[0].continuity, SeamContinuity::g1)
              << family.name << coupling->reports[0].reason;
        }
      }
    }
  }
}

}  // namespace
}  // namespace knead
