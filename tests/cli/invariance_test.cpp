#include <Eigen/Geometry>
#include <functional>
#include <numbers>

#include "knead/spline/evaluate.hpp"
#include "knead/spline/extremum.hpp"
#include "program.hpp"
#include "step_sheet.hpp"

namespace knead::testing {
namespace {

// The same surface in other words gives the same sculpted shape: each test rewrites surface and
// tool, runs the same script, takes the control points back and compares them to 1e-9 of the
// largest displacement.

Surface make(const KnotVector& u, const KnotVector& v, const Points& points,
             std::vector<double> weights) {
  auto made = Surface::create({u, v}, points, std::move(weights));
  if (!made) throw std::runtime_error(made.error().message());
  return *std::move(made);
}

std::vector<double> weights_of(const Surface& s) {
  return {s.weights().begin(), s.weights().end()};
}

/// A similarity of space: turn, scale, shift.
struct Placement {
  double scale = 1;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  Point shift = Point::Zero();
  [[nodiscard]] Point direction(const Point& d) const { return scale * (turn * d); }
  [[nodiscard]] Point operator()(const Point& p) const { return direction(p) + shift; }
  [[nodiscard]] Points back(const Points& points) const {
    return (points.rowwise() - shift.transpose()) * turn /
           scale;  // rows: (Rᵀ (p − t))ᵀ = (p − t)ᵀ R
  }
};

Surface placed(const Surface& s, const Placement& placement) {
  Points points = s.control_points();
  for (Eigen::Index k = 0; k < points.rows(); ++k) {
    points.row(k) = placement(points.row(k).transpose()).transpose();
  }
  return make(s.knots(0), s.knots(1), points, weights_of(s));
}

/// Control points in the order that `source` gives: new row k is old row source(k).
Surface reordered(const Surface& s, const KnotVector& u, const KnotVector& v,
                  const std::function<int(int)>& source) {
  Points points(s.size(), 3);
  std::vector<double> weights;
  for (int k = 0; k < s.size(); ++k) {
    points.row(k) = s.control_points().row(source(k));
    if (s.rational()) weights.push_back(s.weights()[static_cast<std::size_t>(source(k))]);
  }
  return make(u, v, points, std::move(weights));
}

Surface swapped(const Surface& s) {
  const auto [m, n] = s.net();
  return reordered(s, s.knots(1), s.knots(0), [m, n](int k) { return (k % m) * n + k / m; });
}

/// u becomes a + b − u: nothing but a sign in floating point, as domains here are moved to be
/// symmetric about 0 first.
Surface reversed(const Surface& s, int direction) {
  std::vector<double> knots;
  for (double knot : s.knots(direction).knots()) knots.insert(knots.begin(), -knot);
  const auto turned = KnotVector::create(s.knots(direction).degree(), knots);
  const auto [m, n] = s.net();
  return direction == 0 ? reordered(s, *turned, s.knots(1),
                                    [m, n](int k) { return (m - 1 - k / n) * n + k % n; })
                        : reordered(s, s.knots(0), *turned,
                                    [n](int k) { return (k / n) * n + n - 1 - k % n; });
}

Surface reparametrised(const Surface& s, double a, double b, double c, double d) {
  const auto mapped = [](const KnotVector& knots, double factor, double offset) {
    std::vector<double> values;
    for (double knot : knots.knots()) values.push_back(factor * knot + offset);
    return *KnotVector::create(knots.degree(), values);
  };
  return make(mapped(s.knots(0), a, b), mapped(s.knots(1), c, d), s.control_points(),
              weights_of(s));
}

struct Press {
  Point centre, by;
  double radius = 0;
  std::string mode = "collision", weight = "mass", rest = "shape";
  std::array<double, 3> alpha = {1, 0.2, 0.7}, beta = {0.01, 0.02, 0.005};
  [[nodiscard]] Press placed(const Placement& p) const {
    Press moved = *this;
    moved.centre = p(centre);
    moved.by = p.direction(by);
    moved.radius = p.scale * radius;
    return moved;
  }
};

/// A tool that has entered the surface from the side of its normal by a third of its radius.
Press press_on(const Surface& s) {
  const Interval u = s.knots(0).domain(), v = s.knots(1).domain();
  const auto grid = evaluate_grid<2>(
      s,
      std::array<std::span<const double>, 2>{std::vector{u.lower + 0.45 * u.length()},
                                             std::vector{v.lower + 0.55 * v.length()}},
      1);
  const Point su = grid->at({1, 0}).row(0), sv = grid->at({0, 1}).row(0),
              at = grid->points().row(0);
  Press press;
  press.radius = 0.12 * bounding_box(s).diagonal();
  press.centre = at + su.cross(sv).normalized() * press.radius;
  press.by = -su.cross(sv).normalized() * press.radius / 3;
  return press;
}

Points sculpted(const Surface& s, const Press& press, bool hold = true) {
  const Workshop workshop;
  const auto xyz = [](const Point& p) { return Json{p.x(), p.y(), p.z()}; };
  const Json commands = {
      command("material", {{"alpha", press.alpha}, {"beta", press.beta}}),
      command("rest", {{"mode", press.rest}}),
      command("hold", {{"rows", hold ? 1 : 0}}),
      command("tool",
              {{"position", xyz(press.centre)}, {"radius", press.radius}, {"mode", press.mode}}),
      command("move", {{"by", xyz(press.by)}}),
      command("step", {{"count", 3}, {"lambda", 5}, {"weight", press.weight}})};
  const std::string file = workshop.file("sheet.step", step_sheet(s)), out = workshop / "out.step";
  const Outcome run =
      knead({"sculpt", file, "-o", out, "--script", workshop.script_of_all(commands)});
  EXPECT_EQ(run.code, 0) << run.err;
  if (!run.err.empty()) {  // the ring's spans are five times the tool
    EXPECT_TRUE(run.err.starts_with("knead: warning: the net is too coarse to follow the tool"))
        << run.err;
  }
  return surface_of(out, sheet_id).control_points();
}

void expect_same(const Surface& rest, const Points& expected, const Points& actual,
                 const std::string& what) {
  const double largest = (expected - rest.control_points()).rowwise().norm().maxCoeff();
  ASSERT_GT(largest, 1e-3 * bounding_box(rest).diagonal()) << "the tool must do something";
  EXPECT_LE((expected - actual).rowwise().norm().maxCoeff(), 1e-9 * largest) << what;
}

/// The sample's surfaces, their domains moved to be symmetric about 0.
class ScaleFree : public ::testing::TestWithParam<const char*> {
 protected:
  Surface rest_ = [] {
    const Surface s = surface_of(bonnet(), GetParam());
    const auto middle = [](const Interval& i) { return -0.5 * (i.lower + i.upper); };
    return reparametrised(s, 1, middle(s.knots(0).domain()), 1, middle(s.knots(1).domain()));
  }();
  Press press_ = press_on(rest_);
};

TEST_P(ScaleFree, MillimetresOrInches) {
  for (const char* mode : {"collision", "proximity"}) {
    for (const char* weight : {"mass", "identity"}) {
      press_.mode = mode;
      press_.weight = weight;
      const Placement inches{1 / 25.4};
      const Points after = sculpted(rest_, press_);
      const Points other = sculpted(placed(rest_, inches), press_.placed(inches));
      expect_same(rest_, after, inches.back(other), std::string(mode) + ", " + weight);
    }
  }
}

TEST_P(ScaleFree, TheThesisEnergyToo) {
  press_.rest = "none";
  const Placement metres{1e-3};
  expect_same(rest_, sculpted(rest_, press_),
              metres.back(sculpted(placed(rest_, metres), press_.placed(metres))), "m");
}

TEST_P(ScaleFree, TurnedInSpace) {
  const Placement turn{1, Eigen::AngleAxisd(1.1, Point(1, 2, -3).normalized()).toRotationMatrix(),
                       Point(70, -30, 500)};
  for (bool hold : {true, false}) {
    expect_same(rest_, sculpted(rest_, press_, hold),
                turn.back(sculpted(placed(rest_, turn), press_.placed(turn), hold)),
                hold ? "held" : "free");
  }
}

TEST_P(ScaleFree, DirectionsSwapped) {
  Press other = press_;  // the coefficients of u become those of v
  std::swap(other.alpha[0], other.alpha[2]);
  std::swap(other.beta[0], other.beta[2]);
  const Surface turned = swapped(rest_);
  const Points after = sculpted(turned, other);
  expect_same(
      rest_, sculpted(rest_, press_),
      swapped(make(turned.knots(0), turned.knots(1), after, weights_of(turned))).control_points(),
      "swapped");
}

TEST_P(ScaleFree, DirectionsReversed) {
  Press other = press_;
  other.alpha[1] = -other.alpha[1];  // α12 S_u · S_v changes sign with one direction
  const Points expected = sculpted(rest_, press_);
  for (int d = 0; d < 2; ++d) {
    const Surface turned = reversed(rest_, d);
    const Points after = sculpted(turned, other);
    expect_same(rest_, expected,
                reversed(make(turned.knots(0), turned.knots(1), after, weights_of(turned)), d)
                    .control_points(),
                d == 0 ? "u" : "v");
  }
}

TEST_P(ScaleFree, KnotsMappedAffinely) {
  const Points expected = sculpted(rest_, press_);
  expect_same(rest_, expected, sculpted(reparametrised(rest_, 37.5, -11, 0.02, 3), press_),
              "long and short domains");
  expect_same(rest_, expected, sculpted(reparametrised(rest_, 1, 100, 1, -100), press_),
              "far from 0");
}

TEST_P(ScaleFree, RelativeToolsOnCopiesOfEverySize) {
  const Workshop workshop;
  const Json commands = {command("tool", {{"radius", 0.1}, {"relative", true}, {"at", {0.3, 0.6}}}),
                         command("move", {{"by", {0.02, 0.01, 0.04}}, {"relative", true}}),
                         command("step", {{"lambda", 20}})};
  const auto run = [&](double scale) {
    const Placement copy{scale};
    const std::string file = workshop.file("sheet.step", step_sheet(placed(rest_, copy))),
                      out = workshop / "out.step";
    EXPECT_EQ(knead({"sculpt", file, "-o", out, "--script", workshop.script_of_all(commands)}).code,
              0);
    return copy.back(surface_of(out, sheet_id).control_points());
  };
  const Points expected = run(1);
  for (double scale : {1e-5, 1 / 25.4, 1e4})
    expect_same(rest_, expected, run(scale), std::to_string(scale));
}

INSTANTIATE_TEST_SUITE_P(Sample, ScaleFree, ::testing::Values("#285", "#1044"),
                         [](const auto& parameter) {
                           return "Surface" + std::string(parameter.param + 1);
                         });

}  // namespace
}  // namespace knead::testing
