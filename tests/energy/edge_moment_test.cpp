#include "knead/energy/loads.hpp"

#include <gtest/gtest.h>

#include "support/knot_families.hpp"
#include "support/surfaces.hpp"

namespace knead {
namespace {

TEST(EdgeMoment, DoesItsWorkOnTurnsAboutTheEdgeAlone) {
  const Surface rest =
      testing::relief(testing::uniform_clamped(3, 4), testing::uniform_clamped(2, 3), 3, 0.2);
  const Points x = rest.control_points();
  for (int across = 0; across < 2; ++across) {
    const auto moment = EdgeMoment::create(rest, across, true, 2.5);
    ASSERT_TRUE(moment) << moment.error().message();
    const Points forces = moment->forces(x);
    const double scale = forces.cwiseAbs().sum();
    EXPECT_GT(scale, 1);
    EXPECT_LT(forces.colwise().sum().norm(), 1e-14 * scale);  // no work on translations
    // On a rotation ω the work is m ω·∫ t ds: of a rest shape the chord of the edge.
    const auto [m, n] = rest.net();
    const Point chord =
        (x.row(m * n - 1) - (across == 0 ? x.row((m - 1) * n) : x.row(n - 1))).transpose();
    for (int axis = 0; axis < 3; ++axis) {
      double work = 0;
      for (Eigen::Index k = 0; k < x.rows(); ++k) {
        work += forces.row(k).dot(Point(Point::Unit(axis).cross(Point(x.row(k).transpose()))));
      }
      EXPECT_NEAR(work, 2.5 * chord[axis], 1e-13 * scale);
    }
  }
}

TEST(EdgeMoment, StiffnessIsTheDerivativeOnAStraightEdge) {
  const Surface rest =
      testing::sheet(testing::uniform_clamped(3, 3), testing::uniform_clamped(2, 2), 2, 1);
  const auto moment = EdgeMoment::create(rest, 0, true, 1.5);
  ASSERT_TRUE(moment) << moment.error().message();
  Points x = rest.control_points(), d = Points::Zero(x.rows(), 3);
  for (Eigen::Index k = 0; k < x.rows();
       ++k) {  // bent about the edge, and along by the same: the edge stays straight
    x(k, 2) += 0.3 * x(k, 0) * x(k, 0);
    d.row(k) << 0.2 * x(k, 0), 0, x(k, 0) * (2 - x(k, 0));
  }
  const double h = 1e-5;
  const Points change = (moment->forces(x + h * d) - moment->forces(x - h * d)) / (2 * h);
  const Eigen::VectorXd expected =
      moment->stiffness(x) * Eigen::Map<const Eigen::VectorXd>(d.data(), d.size());
  for (Eigen::Index k = 0; k < d.size(); ++k) EXPECT_NEAR(change.data()[k], expected[k], 1e-7) << k;
}

TEST(EdgeMoment, MustBeFinite) {
  const Surface rest = testing::uniform_sheet(2, 4, 4);
  EXPECT_EQ(EdgeMoment::create(rest, 0, false, NAN).error().where, "moment");
}

}  // namespace
}  // namespace knead
