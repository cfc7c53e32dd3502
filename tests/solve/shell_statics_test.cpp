#include "solve/shell_statics.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <functional>
#include <numbers>
#include <optional>
#include <string>

#include "support/surfaces.hpp"

/// The benchmarks of the shell literature; docs/shell.md has their table.
namespace knead {
namespace {

using std::numbers::pi;

/// A shell with what holds and loads it. u and v run from 0 to 1; control point (i, j) is row i n +
/// j.
class Structure {
 public:
  /// Interpolates a surface at the Greville abscissae of a uniform net.
  Structure(int degree, int u_spans, int v_spans,
            const std::function<Point(double, double)>& shape) {
    const auto u = *KnotVector::clamped_uniform(degree, degree + u_spans);
    const auto v = *KnotVector::clamped_uniform(degree, degree + v_spans);
    m_ = u.count();
    n_ = v.count();
    const Eigen::PartialPivLU<Eigen::MatrixXd> lu_u(collocation(u)), lu_v(collocation(v));
    Points points(m_ * n_, 3);
    for (int c = 0; c < 3; ++c) {
      Eigen::MatrixXd values(m_, n_);
      for (int i = 0; i < m_; ++i) {
        for (int j = 0; j < n_; ++j) values(i, j) = shape(u.greville(i), v.greville(j))[c];
      }
      const Eigen::MatrixXd net = lu_v.solve(lu_u.solve(values).transpose()).transpose();
      for (int k = 0; k < m_ * n_; ++k) points(k, c) = net(k / n_, k % n_);
    }
    load = Points::Zero(m_ * n_, 3);
    surface_.emplace(testing::make_surface(u, v, points));
  }

  [[nodiscard]] const Surface& surface() const { return *surface_; }
  [[nodiscard]] int row(int i, int j) const {
    return (i < 0 ? i + m_ : i) * n_ + (j < 0 ? j + n_ : j);
  }
  [[nodiscard]] int along_u() const { return m_; }
  [[nodiscard]] int along_v() const { return n_; }

  /// Displacements a − b = 0 along some axes ("xz"); b < 0: a = 0.
  void tie(int a, int b, const std::string& axes) {
    for (const char axis : axes) {
      LinearConstraint c{axes, {{a, 1.0}}, Point::Zero(), Point::Unit(axis - 'x')};
      if (b >= 0) c.terms.emplace_back(b, -1.0);
      constraints.push_back(std::move(c));
    }
  }
  void hold(int a, const std::string& axes) { tie(a, -1, axes); }
  /// Symmetry about the plane through edge `first` normal to an axis; `second` is the next row of
  /// the net.
  void symmetry(const std::vector<int>& first, const std::vector<int>& second, char normal) {
    std::string others = "xyz";
    others.erase(others.find(normal), 1);
    for (std::size_t k = 0; k < first.size(); ++k) {
      hold(first[k], {normal});
      tie(second[k], first[k], others);
    }
  }
  [[nodiscard]] std::vector<int> u_row(int i) const {
    std::vector<int> rows;
    for (int j = 0; j < n_; ++j) rows.push_back(row(i, j));
    return rows;
  }
  [[nodiscard]] std::vector<int> v_row(int j) const {
    std::vector<int> rows;
    for (int i = 0; i < m_; ++i) rows.push_back(row(i, j));
    return rows;
  }
  /// A force spread evenly over v on the edge u = 1.
  void end_load(const Point& force) {
    const BasisQuadrature q = gauss_basis(surface().knots(1), surface().knots(1).degree() + 1, 0);
    for (int k = 0; k < q.basis.size(); ++k) {
      const auto at = static_cast<std::size_t>(k);
      for (int r = 0; r <= q.basis.degree; ++r) {
        load.row(row(-1, q.basis.first[at] + r)) +=
            q.weights[at] * q.basis.row(k, 0)[r] * force.transpose();
      }
    }
  }

  [[nodiscard]] ShellEquilibrium solve(const ShellMaterial& material,
                                       const ShellStaticsOptions& options = {}) const {
    const auto shell = ShellEnergy::create(surface(), material);
    if (!shell) ADD_FAILURE() << shell.error().message();
    auto result = shell_equilibrium(*shell, surface().control_points(), constraints, load, options);
    if (!result) ADD_FAILURE() << result.error().message();
    EXPECT_TRUE(result->converged) << result->note;
    return std::move(*result);
  }
  /// The displacement of a control point per load, in the limit of small loads.
  [[nodiscard]] Point linear(const ShellMaterial& material, int point) {
    const double small = 1e-6;
    load *= small;
    const ShellEquilibrium result = solve(material, {.tolerance = 1e-6});
    load /= small;
    return (result.control_points - surface().control_points()).row(point).transpose() / small;
  }

  Points load;
  std::vector<LinearConstraint> constraints;

 private:
  static Eigen::MatrixXd collocation(const KnotVector& knots) {
    std::vector<double> places;
    for (int i = 0; i < knots.count(); ++i) places.push_back(knots.greville(i));
    const auto table = *tabulate_basis(knots, places, 0);
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(knots.count(), knots.count());
    for (int i = 0; i < knots.count(); ++i) {
      for (int r = 0; r <= knots.degree(); ++r) {
        matrix(i, table.first[static_cast<std::size_t>(i)] + r) = table.row(i, 0)[r];
      }
    }
    return matrix;
  }

  int m_ = 0, n_ = 0;
  std::optional<Surface> surface_;
};

/// A quarter of the Scordelis–Lo roof: u from the crown to the free edge, v from the diaphragm to
/// the middle.
double roof(int degree, int spans) {
  Structure s(degree, spans, spans, [](double u, double v) {
    return Point(25 * std::sin(u * 40 * pi / 180), 25 * v, 25 * std::cos(u * 40 * pi / 180));
  });
  for (const int k : s.v_row(0)) s.hold(k, "xz");
  s.symmetry(s.v_row(-1), s.v_row(-2), 'y');
  s.symmetry(s.u_row(0), s.u_row(1), 'x');
  const ShellMaterial material{4.32e8, 0, 0.25};
  s.load = ShellEnergy::create(s.surface(), material)->area_load({0, 0, -90});
  return s.linear(material, s.row(-1, -1)).z();
}

/// An eighth of the pinched cylinder: u a quarter turn from the load, v from the diaphragm to the
/// middle.
double cylinder(int degree, int spans) {
  Structure s(degree, spans, spans, [](double u, double v) {
    return Point(300 * std::sin(u * pi / 2), 300 * v, 300 * std::cos(u * pi / 2));
  });
  for (const int k : s.v_row(0)) s.hold(k, "xz");
  s.symmetry(s.v_row(-1), s.v_row(-2), 'y');
  s.symmetry(s.u_row(0), s.u_row(1), 'x');
  s.symmetry(s.u_row(-1), s.u_row(-2), 'z');
  s.load(s.row(0, -1), 2) = -0.25;
  return -s.linear({3e6, 0.3, 3}, s.row(0, -1)).z();
}

/// A quarter of the pinched hemisphere: u the longitude, v the latitude up to the pole.
double hemisphere(int degree, int spans) {
  Structure s(degree, spans, spans, [](double u, double v) {
    const double a = u * pi / 2, b = v * pi / 2;
    return Point(10 * std::cos(a) * std::cos(b), 10 * std::sin(a) * std::cos(b), 10 * std::sin(b));
  });
  for (int i = 0; i < s.along_u(); ++i) {
    s.hold(s.row(i, -1), "xyz");
    s.hold(s.row(i, -2), "z");
  }
  s.symmetry(s.u_row(0), s.u_row(1), 'y');
  s.symmetry(s.u_row(-1), s.u_row(-2), 'x');
  s.load(s.row(0, 0), 0) = 1;
  s.load(s.row(-1, 0), 1) = -1;
  return s.linear({6.825e7, 0.3, 0.04}, s.row(0, 0)).x();
}

TEST(ShellStatics, ScordelisLoRoof) {
  const double reference = -0.3006, limit = roof(4, 16);
  EXPECT_NEAR(limit, reference, 0.01 * 0.3006);
  EXPECT_NEAR(roof(3, 16), reference, 0.01 * 0.3006);
  EXPECT_LE(std::abs(roof(3, 8) - limit),
            std::abs(roof(3, 4) - limit) / 10);  // fourth order: a sixteenth at last
}

TEST(ShellStatics, PinchedCylinder) {
  const double reference = 1.8248e-5, fine = cylinder(4, 16);
  EXPECT_NEAR(fine, reference, 0.01 * reference);
  EXPECT_NEAR(cylinder(3, 32), reference, 0.01 * reference);
  EXPECT_LE(std::abs(fine - reference), std::abs(cylinder(4, 8) - reference) / 4);
}

TEST(ShellStatics, PinchedHemisphere) {
  const double reference = 0.0924, fine = hemisphere(4, 16);
  EXPECT_NEAR(fine, reference, 0.01 * reference);
  EXPECT_NEAR(hemisphere(3, 32), reference, 0.01 * reference);
  EXPECT_LE(std::abs(fine - reference), std::abs(hemisphere(4, 8) - reference) / 4);
}

void clamp_start(Structure& s) {
  for (const int k : s.u_row(0)) s.hold(k, "xyz");
  for (const int k : s.u_row(1)) s.hold(k, "z");
}

/// The tip of the cantilever of Sze, Liu and Lo, Finite Elem. Anal. Des. 40 (2004).
Point cantilever() {
  Structure s(3, 16, 1, [](double u, double v) { return Point(10 * u, v, 0); });
  clamp_start(s);
  s.end_load({0, 0, -4});
  const ShellEquilibrium result = s.solve({1.2e6, 0, 0.1}, {.increments = 4});
  EXPECT_EQ(result.increments.size(), 4u);
  for (const ShellIncrement& i : result.increments) EXPECT_LE(i.iterations, 8) << i.load_factor;
  EXPECT_NEAR(result.reactions.col(2).sum(), 4, 1e-6);  // the hold carries the load
  return (result.control_points - s.surface().control_points()).row(s.row(-1, 0)).transpose();
}

TEST(ShellStatics, CantileverUnderEndShear) {
  const Point d = cantilever();
  EXPECT_NEAR(d.z(), -6.698, 0.005 * 6.698);
  EXPECT_NEAR(d.x(), -3.286, 0.005 * 3.286);
}

/// What the inner and the outer corner of the slit annular plate of the same article rise by.
std::array<double, 2> slit_plate(int along, int across) {
  Structure s(4, along, across, [](double u, double v) {
    return Point((6 + 4 * v) * std::cos(2 * pi * u), (6 + 4 * v) * std::sin(2 * pi * u), 0);
  });
  clamp_start(s);
  s.end_load({0, 0, 0.8 * 4});
  const ShellEquilibrium result = s.solve({21e6, 0, 0.03}, {.increments = 10});
  const Points d = result.control_points - s.surface().control_points();
  return {d(s.row(-1, 0), 2), d(s.row(-1, -1), 2)};
}

TEST(ShellStatics, SlitAnnularPlate) {
  const auto [inside, outside] = slit_plate(32, 4);
  EXPECT_NEAR(inside, 13.891, 0.005 * 13.891);
  EXPECT_NEAR(outside, 17.528, 0.005 * 17.528);
}

/// That a result is the one printed, to half a unit of its last digit and what other instruction
/// sets round differently.
void expect_printed(double result, double printed, double digit) {
  EXPECT_NEAR(result, printed, 0.51 * digit) << printed;
}

TEST(ShellStatics, AllResultsAreThoseOfTheTable) {  // of docs/shell.md, row by row
  expect_printed(roof(3, 4), -0.30012, 1e-5);
  expect_printed(roof(3, 8), -0.30059, 1e-5);
  expect_printed(roof(3, 16), -0.30059, 1e-5);
  expect_printed(roof(4, 16), -0.30059, 1e-5);
  expect_printed(cylinder(3, 8), 1.5461e-5, 1e-9);
  expect_printed(cylinder(3, 16), 1.8019e-5, 1e-9);
  expect_printed(cylinder(3, 32), 1.8247e-5, 1e-9);
  expect_printed(cylinder(4, 8), 1.7678e-5, 1e-9);
  expect_printed(cylinder(4, 16), 1.8190e-5, 1e-9);
  expect_printed(hemisphere(3, 8), 0.08835, 1e-5);
  expect_printed(hemisphere(3, 16), 0.09222, 1e-5);
  expect_printed(hemisphere(3, 32), 0.09240, 1e-5);
  expect_printed(hemisphere(4, 8), 0.09169, 1e-5);
  expect_printed(hemisphere(4, 16), 0.09237, 1e-5);
  const Point tip = cantilever();
  expect_printed(-tip.z(), 6.6997, 1e-4);
  expect_printed(-tip.x(), 3.2894, 1e-4);
  const auto [coarse_inside, coarse_outside] = slit_plate(32, 4);
  expect_printed(coarse_inside, 13.833, 1e-3);
  expect_printed(coarse_outside, 17.469, 1e-3);
  const auto [inside, outside] = slit_plate(64, 8);
  expect_printed(inside, 13.844, 1e-3);
  expect_printed(outside, 17.482, 1e-3);
}

TEST(ShellStatics, NamesWhatIsWrong) {
  Structure s(2, 2, 2, [](double u, double v) { return Point(u, v, 0); });
  const auto shell = *ShellEnergy::create(s.surface(), {1, 0.3, 0.1});
  const Points& rest = s.surface().control_points();
  s.load(0, 2) = 1;
  const auto free = shell_equilibrium(shell, rest, {}, s.load);
  ASSERT_FALSE(free);
  EXPECT_EQ(free.error().kind, ErrorKind::numerical);
  const auto none = shell_equilibrium(shell, rest, {}, s.load, {.increments = 0});
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message().find("increments"), std::string::npos);
  EXPECT_FALSE(shell_equilibrium(shell, rest, {}, Points::Zero(3, 3)));
}

}  // namespace
}  // namespace knead
