#include "energy/shell_crease.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numbers>

#include "support/surfaces.hpp"

namespace knead {
namespace {

constexpr double stiffness = 3;

Surface moved(const Surface& s, const Eigen::Matrix3d& rotation, const Point& by) {
  return *s.with_control_points((s.control_points() * rotation.transpose()).rowwise() +
                                by.transpose());
}

Eigen::Matrix3d turn(double angle, const Point& axis) {
  return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

/// Two unit sheets that meet at a right angle in the line x = 1, of different degrees and knots;
/// the second one runs the other way where `reversed`.
struct Angle {
  Surface a = testing::uniform_sheet(3, 5, 4);
  Surface b;
  bool reversed;

  explicit Angle(bool turned = false) : b(second(turned)), reversed(turned) {}

  static Surface second(bool turned) {
    const Surface flat = testing::uniform_sheet(2, 4, 6);
    Points x = flat.control_points();
    if (turned) x.col(1) = 1 - x.col(1).array();
    return moved(*flat.with_control_points(x), turn(-std::numbers::pi / 2, {0, 1, 0}), {1, 0, 0});
  }
  [[nodiscard]] Points points() const {
    Points all(a.size() + b.size(), 3);
    all << a.control_points(), b.control_points();
    return all;
  }
  [[nodiscard]] ShellCrease crease() const {
    auto made =
        ShellCrease::create({&a, 0, 0, true}, {&b, a.size(), 0, false}, reversed, stiffness);
    if (!made) ADD_FAILURE() << made.error().message();
    return std::move(*made);
  }
};

TEST(ShellCrease, CostsNothingAtRestAndAfterAnyRigidMotion) {
  for (const bool reversed : {false, true}) {
    const Angle angle(reversed);
    const ShellCrease crease = angle.crease();
    const Points rest = angle.points();
    EXPECT_LT(crease.energy(rest), 1e-28);
    const Points turned =
        (rest * turn(2.5, {1, 2, 3}).transpose()).rowwise() + Eigen::RowVector3d(4, -5, 6);
    EXPECT_LT(crease.energy(turned), 1e-26);
    EXPECT_LT(crease.opening(turned), 1e-13);
  }
}

TEST(ShellCrease, OpensByTheAngleThroughWhichOneSideTurns) {
  // C = k (1 − cos δ) per length of the seam, of which there is 1.
  for (const bool reversed : {false, true}) {
    const Angle angle(reversed);
    const ShellCrease crease = angle.crease();
    for (const double by : {-1.2, -0.1, 0.4, 2.0}) {
      Points x = angle.points();
      const Surface turned = moved(moved(angle.b, Eigen::Matrix3d::Identity(), {-1, 0, 0}),
                                   turn(by, {0, 1, 0}), {1, 0, 0});
      x.bottomRows(angle.b.size()) = turned.control_points();
      EXPECT_NEAR(crease.opening(x), std::abs(by), 1e-13);
      EXPECT_NEAR(crease.energy(x), stiffness * (1 - std::cos(by)), 1e-13);
    }
  }
}

TEST(ShellCrease, GradientIsThatOfTheEnergy) {
  for (const bool reversed : {false, true}) {
    const Angle angle(reversed);
    const ShellCrease crease = angle.crease();
    const Points x =
        angle.points() + 0.1 * testing::random_points(angle.a.size() + angle.b.size(), 5);
    Points gradient = Points::Zero(x.rows(), 3);
    crease.add_gradient(x, gradient);
    for (unsigned seed = 1; seed < 6; ++seed) {
      const Points d = testing::random_points(static_cast<int>(x.rows()), seed);
      // Fourth-order differences: off by (h · 10)⁴, derivatives of the basis being of the order of
      // 10, and ε/h.
      const double h = 1e-4;
      const auto c = [&](double t) { return crease.energy(x + t * h * d); };
      const double slope = (8 * (c(1) - c(-1)) - (c(2) - c(-2))) / (12 * h);
      EXPECT_NEAR(gradient.cwiseProduct(d).sum(), slope, 1e-8 * std::max(1.0, std::abs(slope)));
    }
  }
}

TEST(ShellCrease, HessianAtRestIsTheDerivativeOfTheGradient) {
  const Angle angle;
  const ShellCrease crease = angle.crease();
  const Points x = angle.points();
  std::vector<Eigen::Triplet<double>> entries;
  crease.append_hessian(x, entries);
  SparseMatrix hessian(3 * x.rows(), 3 * x.rows());
  hessian.setFromTriplets(entries.begin(), entries.end());
  const Points d = testing::random_points(static_cast<int>(x.rows()), 7);
  const double h = 1e-5;
  Points up = Points::Zero(x.rows(), 3), down = up;
  crease.add_gradient(x + h * d, up);
  crease.add_gradient(x - h * d, down);
  const Points change = (up - down) / (2 * h);
  const Eigen::VectorXd product = hessian * Eigen::Map<const Eigen::VectorXd>(d.data(), d.size());
  const double off =
      (product - Eigen::Map<const Eigen::VectorXd>(change.data(), change.size())).norm();
  EXPECT_LT(off, 1e-7 * product.norm());
}

TEST(ShellCrease, RefusesWhatHasNoAngle) {
  const Angle angle;
  EXPECT_FALSE(
      ShellCrease::create({&angle.a, 0, 0, true}, {&angle.b, angle.a.size(), 0, false}, false, 0));
  const Surface point = *angle.b.with_control_points(Points::Zero(angle.b.size(), 3));
  const auto made =
      ShellCrease::create({&angle.a, 0, 0, true}, {&point, angle.a.size(), 0, false}, false, 1);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().kind, ErrorKind::numerical);
}

}  // namespace
}  // namespace knead
