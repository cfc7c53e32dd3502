#include "knead/energy/shell_energy.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <functional>

#include "base/gauss_legendre.hpp"
#include "support/surfaces.hpp"

namespace knead {
namespace {

const ShellMaterial rubber{3, 0.3, 0.05, 1};

ShellEnergy shell_of(const Surface& rest, const ShellMaterial& material = rubber,
                     int gauss_points = 0) {
  auto made = ShellEnergy::create(rest, material, gauss_points);
  if (!made) ADD_FAILURE() << made.error().message();
  return std::move(*made);
}

/// Curved rest shapes: polynomial and rational, degrees that differ, double knots, unclamped.
std::vector<Surface> shells() {
  const KnotVector cubic = testing::uniform_clamped(3, 3),
                   quadratic = testing::uniform_clamped(2, 2);
  return {testing::relief(cubic, quadratic, 1), testing::relief(quadratic, cubic, 2, 0.1, 3),
          testing::relief(testing::clamped_knots(3, {0, 1, 2}, {4, 2, 4}),
                          testing::uniform_unclamped(4, 2), 3)};
}

Points bent(const Surface& rest, unsigned seed, double by = 0.1) {
  return rest.control_points() + by * testing::random_points(rest.size(), seed);
}

/// A Bézier patch in extended precision, its shell energy written down from the definition by cross
/// products: no code and no formula of the derivatives is shared with the library.
class ExtendedPatch {
 public:
  using Real = long double;
  using Vector = Eigen::Matrix<Real, 3, 1>;
  using Net = Eigen::Matrix<Real, Eigen::Dynamic, 3, Eigen::RowMajor>;

  ExtendedPatch(const Surface& rest, const ShellMaterial& m) : rest_(rest), m_(m) {}

  [[nodiscard]] Real energy(const Net& x) const {
    const Net at_rest = rest_.control_points().cast<Real>();
    const GaussRule u = gauss_legendre(rest_.knots(0).degree() + 1),
                    v = gauss_legendre(rest_.knots(1).degree() + 1);
    Real sum = 0;
    for (std::size_t i = 0; i < u.abscissae.size(); ++i) {
      for (std::size_t j = 0; j < v.abscissae.size(); ++j) {
        const Real s = (1 + Real(u.abscissae[i])) / 2, t = (1 + Real(v.abscissae[j])) / 2;
        sum += Real(u.weights[i]) * Real(v.weights[j]) / 4 *
               density(forms(at_rest, s, t), forms(x, s, t));
      }
    }
    return sum;
  }

 private:
  struct Forms {
    Real a[2][2], b[2][2], area;
  };

  static Real bernstein(int p, int i, Real t) {
    if (i < 0 || i > p) return 0;
    if (p == 0) return 1;
    return (1 - t) * bernstein(p - 1, i, t) + t * bernstein(p - 1, i - 1, t);
  }
  static Real bernstein(int p, int i, Real t, int order) {
    return order == 0
               ? bernstein(p, i, t)
               : p * (bernstein(p - 1, i - 1, t, order - 1) - bernstein(p - 1, i, t, order - 1));
  }

  /// Homogeneous derivatives, then the quotient rule.
  [[nodiscard]] Forms forms(const Net& x, Real s, Real t) const {
    const int p = rest_.knots(0).degree(), q = rest_.knots(1).degree();
    Vector h[3][3];
    Real w[3][3];
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; a + b < 3; ++b) {
        h[a][b].setZero();
        w[a][b] = 0;
        for (int k = 0; k < x.rows(); ++k) {
          const Real weight =
              rest_.rational() ? Real(rest_.weights()[static_cast<std::size_t>(k)]) : 1;
          const Real n = weight * bernstein(p, k / (q + 1), s, a) * bernstein(q, k % (q + 1), t, b);
          h[a][b] += n * x.row(k).transpose();
          w[a][b] += n;
        }
      }
    }
    const Vector at = h[0][0] / w[0][0];
    const Vector d[2] = {(h[1][0] - w[1][0] * at) / w[0][0], (h[0][1] - w[0][1] * at) / w[0][0]};
    Vector dd[2][2];
    dd[0][0] = (h[2][0] - 2 * w[1][0] * d[0] - w[2][0] * at) / w[0][0];
    dd[1][1] = (h[0][2] - 2 * w[0][1] * d[1] - w[0][2] * at) / w[0][0];
    dd[0][1] = dd[1][0] = (h[1][1] - w[1][0] * d[1] - w[0][1] * d[0] - w[1][1] * at) / w[0][0];
    const Vector cross = d[0].cross(d[1]);
    Forms f;
    f.area = cross.norm();
    for (int a = 0; a < 2; ++a) {
      for (int b = 0; b < 2; ++b) {
        f.a[a][b] = d[a].dot(d[b]);
        f.b[a][b] = dd[a][b].dot(cross) / f.area;
      }
    }
    return f;
  }

  /// By the four-index tensor C.
  [[nodiscard]] Real density(const Forms& rest, const Forms& now) const {
    const Real det = rest.a[0][0] * rest.a[1][1] - rest.a[0][1] * rest.a[0][1], nu = m_.poisson,
               t = m_.thickness;
    const Real inverse[2][2] = {{rest.a[1][1] / det, -rest.a[0][1] / det},
                                {-rest.a[0][1] / det, rest.a[0][0] / det}};
    Real sum = 0;
    for (int k = 0; k < 16; ++k) {
      const int a = k & 1, b = k >> 1 & 1, c = k >> 2 & 1, d = k >> 3;
      const Real tensor =
          Real(m_.young) / (1 - nu * nu) *
          (nu * inverse[a][b] * inverse[c][d] +
           (1 - nu) / 2 * (inverse[a][c] * inverse[b][d] + inverse[a][d] * inverse[b][c]));
      sum +=
          tensor * (t * (now.a[a][b] - rest.a[a][b]) * (now.a[c][d] - rest.a[c][d]) / 4 +
                    t * t * t / 12 * (rest.b[a][b] - now.b[a][b]) * (rest.b[c][d] - now.b[c][d]));
    }
    return sum / 2 * rest.area;
  }

  const Surface& rest_;
  ShellMaterial m_;
};

TEST(ShellEnergy, AgreesWithItsDefinitionAndTheDifferencesOfItInExtendedPrecision) {
  const auto bezier = [](int p) { return testing::clamped_knots(p, {0, 1}); };
  for (const Surface& rest : {testing::relief(bezier(3), bezier(2), 4),
                              testing::relief(bezier(2), bezier(4), 5, 0.2, 3)}) {
    const ShellEnergy shell = shell_of(rest);
    const ExtendedPatch patch(rest, rubber);
    const Points x = bent(rest, 6), gradient = shell.gradient(x);
    const ExtendedPatch::Net at = x.cast<long double>();
    const auto exact = static_cast<double>(patch.energy(at));
    EXPECT_NEAR(shell.energy(x).sum(), exact, 1e-13 * exact);
    const SparseMatrix hessian = shell.hessian(x);
    const long double h = 1e-3L;  // fourth order: about h⁴ = 1e-12 of the scale, rounding 1e-16
    for (int k = 0; k < 3 * rest.size(); ++k) {
      const auto energy = [&](int steps, int other = 0, int other_steps = 0) {
        ExtendedPatch::Net moved = at;
        moved(k / 3, k % 3) += steps * h;
        moved(other / 3, other % 3) += other_steps * h;
        return patch.energy(moved);
      };
      const long double slope =
          (8 * (energy(1) - energy(-1)) - (energy(2) - energy(-2))) / (12 * h);
      EXPECT_NEAR(gradient(k / 3, k % 3), static_cast<double>(slope),
                  1e-10 * gradient.cwiseAbs().maxCoeff());
      const int other = (7 * k + 3) % (3 * rest.size());
      const auto mixed = [&](int n) {
        return (energy(n, other, n) - energy(n, other, -n) - energy(-n, other, n) +
                energy(-n, other, -n)) /
               (4 * n * n * h * h);
      };
      EXPECT_NEAR(hessian.coeff(k, other), static_cast<double>((4 * mixed(1) - mixed(2)) / 3),
                  1e-9 * hessian.diagonal().cwiseAbs().maxCoeff());
    }
  }
}

TEST(ShellEnergy, HasTheHessianOfItsGradient) {
  for (const Surface& rest : shells()) {
    const ShellEnergy shell = shell_of(rest);
    const Points x = bent(rest, 7), d = testing::random_points(rest.size(), 8);
    const SparseMatrix hessian = shell.hessian(x);
    EXPECT_EQ(SparseMatrix(hessian - SparseMatrix(hessian.transpose())).norm(), 0);
    const double h = 1e-4;
    const auto g = [&](double t) { return shell.gradient(x + t * h * d); };
    const Points difference = (8 * (g(1) - g(-1)) - (g(2) - g(-2))) / (12 * h);
    const Eigen::VectorXd image = hessian * Eigen::Map<const Eigen::VectorXd>(d.data(), d.size());
    EXPECT_LE((Eigen::Map<const Eigen::VectorXd>(difference.data(), d.size()) - image)
                  .cwiseAbs()
                  .maxCoeff(),
              1e-9 * image.cwiseAbs().maxCoeff());
  }
}

TEST(ShellEnergy, LinearisesItsStresses) {
  const Surface rest = shells().front();
  const ShellEnergy shell = shell_of(rest);
  const Points x = bent(rest, 9), d = testing::random_points(rest.size(), 10);
  const double h = 1e-4;
  const ShellStress slope = (shell.stress(x + h * d) - shell.stress(x - h * d)) / (2 * h);
  const ShellStress linear = shell.stress(x, d) - shell.stress(x);
  EXPECT_LE((slope - linear).cwiseAbs().maxCoeff(), 1e-6 * linear.cwiseAbs().maxCoeff());
}

TEST(ShellEnergy, DoesNotChangeUnderRigidMotions) {
  for (const Surface& rest : shells()) {
    const ShellEnergy shell = shell_of(rest);
    for (const double angle : {0.01, 1.0, 3.0}) {
      const Eigen::Matrix3d turn =
          Eigen::AngleAxisd(angle, Point(1, 2, -0.5).normalized()).toRotationMatrix();
      const Points turned =
          (rest.control_points() * turn.transpose()).rowwise() + Eigen::RowVector3d(3, -2, 5);
      // The differences of coordinates of 10 are rounded to 1e-15 each, and energy is quadratic in
      // them.
      EXPECT_LE(shell.energy(turned).sum(), 1e-26 * shell.stretching_scale());
      const Points x = bent(rest, 11), y = x * turn.transpose();
      EXPECT_NEAR(shell.energy(y).sum(), shell.energy(x).sum(), 1e-12 * shell.energy(x).sum());
      EXPECT_LE((shell.gradient(y) - shell.gradient(x) * turn.transpose()).cwiseAbs().maxCoeff(),
                1e-12 * shell.gradient(x).cwiseAbs().maxCoeff());
    }
  }
}

TEST(ShellEnergy, HasSixZeroModesAndNoMore) {
  std::vector<Surface> cases = shells();
  cases.push_back(testing::sheet(testing::uniform_clamped(2, 3), testing::uniform_clamped(2, 3)));
  for (const Surface& rest : cases) {
    const ShellEnergy shell = shell_of(rest);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(
        Eigen::MatrixXd(shell.hessian(rest.control_points())));
    const Eigen::VectorXd& values = modes.eigenvalues();
    const double largest = values[values.size() - 1];
    EXPECT_LE(std::abs(values[0]), 1e-13 * largest);
    EXPECT_LE(std::abs(values[5]), 1e-13 * largest);
    EXPECT_GE(values[6], 1e-9 * largest);
  }
}

TEST(ShellEnergy, OfSimpleDeformationsIsThatOfPlateTheory) {
  const Surface rest =
      testing::sheet(testing::uniform_clamped(3, 2), testing::uniform_clamped(3, 2), 2, 1.5);
  const ShellEnergy shell = shell_of(rest);
  const double young = rubber.young, poisson = rubber.poisson, t = rubber.thickness;
  const double stretch = young * t / (1 - poisson * poisson), bend = stretch * t * t / 12;
  EXPECT_NEAR(shell.area(), 3, 1e-14);
  Points x = rest.control_points();
  x.col(0) *= 1.2;
  EXPECT_NEAR(shell.energy(x).membrane, stretch / 2 * std::pow((1.44 - 1) / 2, 2) * 3, 1e-14);
  EXPECT_LE(shell.energy(x).bending, 1e-28);
  // Saddle z = k x y, whose net is that of x times that of y.
  const double k = 1e-5;
  x = rest.control_points();
  x.col(2) = k * x.col(0).cwiseProduct(x.col(1));
  EXPECT_NEAR(shell.energy(x).bending / (k * k), bend * (1 - poisson) * 3, 1e-9 * bend);
  const Points load = shell.area_load({0, 0, -2});
  EXPECT_NEAR(load.col(2).sum(), -6, 1e-14);
}

TEST(ShellEnergy, NamesWhatIsWrong) {
  const auto message = [](const ShellMaterial& m) { return validated(m).error().message(); };
  EXPECT_NE(message({0, 0.3, 1, 0}).find("young"), std::string::npos);
  EXPECT_NE(message({1, 0.6, 1, 0}).find("poisson"), std::string::npos);
  EXPECT_NE(message({1, 0.3, -1, 0}).find("thickness"), std::string::npos);
  EXPECT_NE(message({1, 0.3, 1, NAN}).find("density"), std::string::npos);
  EXPECT_NE(ShellEnergy::create(testing::cylinder(), rubber).error().message().find("degree"),
            std::string::npos);
  const Surface sheet = testing::uniform_sheet(2, 4, 4);
  const auto flat =
      ShellEnergy::create(*sheet.with_control_points(Points::Zero(sheet.size(), 3)), rubber);
  ASSERT_FALSE(flat);
  EXPECT_EQ(flat.error().kind, ErrorKind::numerical);
}

}  // namespace
}  // namespace knead
