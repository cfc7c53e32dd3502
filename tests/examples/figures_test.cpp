// The scripts of examples/figures leave what the thesis' Figs. 6.9 to 6.15 show.
#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <cmath>
#include <functional>

#include "draw.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/session/command_json.hpp"
#include "knead/spline/evaluate.hpp"
#include "session/commands.hpp"
#include "session/session_state.hpp"

namespace knead {
namespace {

const std::string directory = KNEAD_SOURCE_DIR "/examples/figures/";

std::vector<Command> script(const std::string& name) {
  const auto text = read_file(directory + name);
  if (!text) ADD_FAILURE() << text.error().message();
  auto commands = parse_script(*text, name);
  if (!commands) ADD_FAILURE() << commands.error().message();
  return std::move(*commands);
}

using After = std::function<void(const Command&, const SessionState&)>;

/// Runs commands in a document without a file, or in one of the directory; `after` sees the state
/// after each.
Session run(const std::vector<Command>& commands, const std::string& file = {},
            const After& after = {}) {
  auto document = file.empty() ? Document::fresh("sheet") : Document::open(directory + file);
  if (!document) ADD_FAILURE() << document.error().message();
  Session session(std::move(*document));
  for (const Command& command : commands) {
    const auto status = session.execute(command);
    if (!status) {
      ADD_FAILURE() << to_json(command) << ": " << status.error().message();
      break;
    }
    if (after) after(command, session.state());
  }
  for (const StepRecord& step : session.state().steps) {
    EXPECT_TRUE(step.converged) << step.note;
    EXPECT_EQ(step.note, "");
  }
  return session;
}

Point at(const SessionState& state, double s, double t, int surface = 0) {
  const Surface& shape = *state.surfaces[static_cast<std::size_t>(surface)].current;
  const Interval u = shape.knots(0).domain(), v = shape.knots(1).domain();
  const auto point = evaluate_point<2>(shape, {u.lower + s * u.length(), v.lower + t * v.length()});
  if (!point) ADD_FAILURE() << point.error().message();
  return *point;
}

/// Points of the surface on a grid of fractions, row by row.
Points grid(const Surface& shape, int count) {
  std::array<std::vector<double>, 2> parameters;
  for (std::size_t d = 0; d < 2; ++d) {
    const Interval domain = shape.knots()[d].domain();
    for (int k = 0; k < count; ++k) {
      parameters[d].push_back(
          std::min(domain.lower + domain.length() * k / (count - 1), domain.upper));
    }
  }
  return evaluate_grid<2>(shape, {std::span<const double>(parameters[0]), parameters[1]})->points();
}

/// Implicit steps never let energy and potential of the tools grow.
void expect_descent(const SessionState& state) {
  double before = 1e300;
  for (const StepRecord& step : state.steps) {
    const double now = 0.5 * step.energy + step.contact;
    EXPECT_LE(now, before + 1e-12 * std::abs(before));
    before = now;
  }
}

void expect_border_in_place(const SessionState& state) {
  const SceneSurface& s = state.surfaces[0];
  const auto [m, n] = s.current->net();
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < n; ++j) {
      if (i > 0 && j > 0 && i < m - 1 && j < n - 1) continue;
      EXPECT_EQ(s.current->control_points().row(i * n + j),
                s.opened->control_points().row(i * n + j));
    }
  }
}

TEST(Figure6_9, TheSheetIsDrawnToABall) {
  const Session session = run(script("figure_6_9_a.json"));
  const SessionState& state = session.state();
  expect_descent(state);
  expect_border_in_place(state);
  EXPECT_LT(state.steps.back().residual, 1e-4);
  // The ball ends 0.7 above the sheet: it is reached, and the bump falls off to all sides.
  EXPECT_GT(at(state, 0.5, 0.5).z(), 0.65);
  for (double angle : {0.0, 0.7, 1.5}) {
    double before = at(state, 0.5, 0.5).z() + 1e-12;
    for (double r = 0.05; r < 0.5; r += 0.05) {
      const double z = at(state, 0.5 + r * std::cos(angle), 0.5 + r * std::sin(angle)).z();
      EXPECT_LT(z, before) << angle << " " << r;
      before = z;
    }
  }
}

TEST(Figure6_9, TheSheetTakesTheShapeOfARing) {
  const Session session = run(script("figure_6_9_b.json"));
  const SessionState& state = session.state();
  expect_descent(state);
  expect_border_in_place(state);
  // The ring of radius 2.5 ends 0.8 above the sheet of side 10: it is reached, the middle drawn up
  // into the hole, so that the ring leaves a groove.
  for (double angle : {0.0, 0.8, 2.0, 4.0}) {
    const auto height = [&](double r) {
      return at(state, 0.5 + 0.1 * r * std::cos(angle), 0.5 + 0.1 * r * std::sin(angle)).z();
    };
    EXPECT_NEAR(height(2.5), 0.8, 0.08);  // a tenth of the way
    EXPECT_GT(height(0), height(2.5) + 0.1);
    EXPECT_LT(height(4), height(2.5) - 0.3);
  }
}

TEST(Figure6_10, InternalForcesFlattenAndShrinkTheSheetToAPoint) {
  std::vector<double> size, thickness;
  const Session session =
      run(script("figure_6_10.json"), {}, [&](const Command& command, const SessionState& state) {
        if (!fields_of<StepCommand>(command) && !fields_of<RestCommand>(command)) return;
        const Points points = grid(*state.surfaces[0].current, 41);
        const Eigen::JacobiSVD<Eigen::MatrixXd> svd(points.rowwise() - points.colwise().mean());
        size.push_back(bounding_box(*state.surfaces[0].current).diagonal());
        thickness.push_back(svd.singularValues()[2] / svd.singularValues()[0]);  // 0 in any plane
      });
  ASSERT_EQ(size.size(), 5u);  // before, after one, two, three and all steps
  EXPECT_GT(thickness.front(), 0.05);
  for (std::size_t k = 1; k < size.size(); ++k) {
    EXPECT_LT(size[k], size[k - 1]);
    EXPECT_LT(thickness[k], thickness[k - 1]);
  }
  // Along a side of 1 the slowest way to shrink, cos πu, loses π²/(λ + π²) of itself in a step,
  // others more.
  const double rate = 10 / (10 + M_PI * M_PI);
  EXPECT_LT(size.back(), 2 * std::pow(rate, 20) * size.front());
  EXPECT_LT(thickness.back(), 1e-5);
}

/// Largest distance and angle between two patches along a shared edge: u = 1 of one on u = 0 of the
/// other.
std::array<double, 2> seam(const SessionState& state, int a, int b, bool along_u, bool smallest) {
  double gap = smallest ? 1e300 : 0, angle = 0;
  const auto jet = [&](int k, double s, double t) {
    Parameters<2> parameters(1, 2);
    const Surface& shape = *state.surfaces[static_cast<std::size_t>(k)].current;
    const Interval u = shape.knots(0).domain(), v = shape.knots(1).domain();
    parameters << std::min(u.lower + s * u.length(), u.upper),
        std::min(v.lower + t * v.length(), v.upper);
    return *evaluate<2>(shape, parameters, 1);
  };
  for (double t = 0; t <= 1; t += 0.0625) {
    const auto first = along_u ? jet(a, t, 1) : jet(a, 1, t),
               second = along_u ? jet(b, t, 0) : jet(b, 0, t);
    const double distance = (first.points() - second.points()).norm();
    gap = smallest ? std::min(gap, distance) : std::max(gap, distance);
    const auto normal = [](const Evaluation<2>& e) {
      const Point u = e.at({1, 0}).row(0), v = e.at({0, 1}).row(0);
      return Point(u.cross(v).normalized());
    };
    angle = std::max(angle, normal(first).cross(normal(second)).norm());
  }
  return {gap, angle};
}

TEST(Figure6_11, PatchesComeApartAtTheirSeams) {
  const Session session = run(script("figure_6_11.json"), "patches.step");
  for (auto [a, b, along_u] :
       {std::tuple{0, 2, false}, {1, 3, false}, {0, 1, true}, {2, 3, true}}) {
    EXPECT_GT(seam(session.state(), a, b, along_u, true)[0], 1);  // of patches 5 wide
  }
}

TEST(Figure6_11, CoupledPatchesShrinkAsOne) {
  const Session session = run(script("figure_6_11_coupled.json"), "patches.step");
  const SessionState& state = session.state();
  EXPECT_GT(state.steps.back().largest_displacement, 1);
  ASSERT_EQ(state.seam_reports.size(), 4u);
  for (const SeamReport& report : state.seam_reports)
    EXPECT_EQ(report.continuity, SeamContinuity::g1);
  for (auto [a, b, along_u] :
       {std::tuple{0, 2, false}, {1, 3, false}, {0, 1, true}, {2, 3, true}}) {
    const auto [gap, angle] = seam(state, a, b, along_u, false);
    EXPECT_LT(gap, 1e-12 * 10);
    EXPECT_LT(angle, 1e-6);
  }
}

TEST(Figure6_12, SidesBetweenFourHeldCornersBecomePinched) {
  const Session session = run(script("figure_6_12.json"));
  const SessionState& state = session.state();
  expect_descent(state);
  for (double s : {0.0, 1.0}) {
    for (double t : {0.0, 1.0})
      EXPECT_LT((at(state, s, t) - Point(10 * s, 10 * t, 0)).norm(), 1e-10 * 10);
  }
  const double depth = at(state, 0.5, 0).y();
  EXPECT_GT(depth, 2);  // of 10
  for (double t = 0.05; t < 1; t += 0.05) {
    const double inward = at(state, t, 0).y();
    EXPECT_GT(inward, 0);
    EXPECT_LE(inward, depth + 1e-12);                     // most in the middle
    EXPECT_NEAR(10 - at(state, t, 1).y(), inward, 1e-9);  // every side alike
    EXPECT_NEAR(at(state, 0, t).x(), inward, 1e-9);
    EXPECT_NEAR(10 - at(state, 1, t).x(), inward, 1e-9);
  }
}

TEST(Figure6_13, TheBumpGoesTowardsTheConcavity) {
  auto commands = script("figure_6_13.json");
  const Session above = run(commands);
  const SessionState& state = above.state();
  expect_descent(state);
  expect_border_in_place(state);
  // The bowl's rim is at 0.1, its hollow above: the sheet has risen into it, and is highest in the
  // middle of it.
  EXPECT_GT(at(state, 0.5, 0.5).z(), 0.9);
  EXPECT_GT(at(state, 0.5, 0.5).z(), at(state, 0.5, 0.55).z());
  EXPECT_LT(at(state, 0.5, 0.9).z(), 0.1);  // outside of the bowl it stays below the rim
  for (Command& command : commands) {
    if (const auto* tool = fields_of<ToolCommand>(command)) {
      ToolCommand other = *tool;
      other.axis = Vector3{0, 0, 1};
      (*other.position)[2] *= -1;
      command = make_command(other);
    }
  }
  const Session below = run(commands);
  for (double s : {0.1, 0.3, 0.5})
    EXPECT_NEAR(at(below.state(), s, 0.4).z(), -at(state, s, 0.4).z(), 1e-9);
}

TEST(Figure6_14, TheDentIsAsDeepAsTheBallIsPressed) {
  constexpr double radius = 1.5;
  double depth = 0;
  const Session session =
      run(script("figure_6_14.json"), {}, [&](const Command& command, const SessionState& state) {
        if (!fields_of<StepCommand>(command)) return;
        depth += 0.5;
        EXPECT_LE(state.steps.back().gap, rigid_gap);
        // The gap is kept at Gauss points at most a sixth of the radius apart; between four of them
        // the ball's cap is at most (r/6)² / 2 / (2r) = r/144 high.
        EXPECT_NEAR(at(state, 0.5, 0.5).z(), -depth, radius / 144) << depth;
        EXPECT_NEAR(grid(*state.surfaces[0].current, 101).col(2).minCoeff(), -depth, radius / 144);
      });
  EXPECT_EQ(depth, 1.5);
  expect_border_in_place(session.state());
}

TEST(Figure6_15, TheSheetFallsDrapesOverTheBallAndComesToRest) {
  auto commands = script("figure_6_15.json");
#ifdef KNEAD_SANITIZERS  // the fall and the first contact only: sanitizers make it a minute
  StepCommand fewer = *fields_of<StepCommand>(commands.back());
  fewer.count = 12;
  commands.back() = make_command(fewer);
#endif
  const Session session = run(commands);
  const SessionState& state = session.state();
  for (const StepRecord& step : state.steps) EXPECT_LE(step.gap, rigid_gap);
#ifdef KNEAD_SANITIZERS
  return;
#endif
  const Points points = grid(*state.surfaces[0].current, 401);
  const Point centre(5, 5, -2.5);
  constexpr double radius = 2;
  double nearest = 1e300;
  int touching = 0;
  for (Eigen::Index k = 0; k < points.rows(); ++k) {
    const double distance = (Point(points.row(k)) - centre).norm();
    nearest = std::min(nearest, distance);
    touching += distance < radius * (1 + 1e-3);
  }
  EXPECT_GT(nearest, radius * (1 - 1e-3));
  EXPECT_GT(touching, 401 * 401 / 100);  // it lies on a cap of the ball, not on a point
  // It hangs: the middle on the ball, corners far below the ball's middle, and no point of it
  // higher than the middle.
  EXPECT_NEAR(at(state, 0.5, 0.5).z(), -0.5, 1e-3 * radius);
  EXPECT_LT(at(state, 0, 0).z(), -5);
  EXPECT_LT(at(state, 0.5, 0).z(), -4);
  EXPECT_LT(points.col(2).maxCoeff(), -0.5 + 1e-3 * radius);
  // The swing dies.
  double peak = 0;
  for (const StepRecord& step : state.steps) peak = std::max(peak, step.kinetic);
  EXPECT_LT(state.steps.back().kinetic, 1e-6 * peak);
  EXPECT_LT(state.steps.back().residual, 1e-4);
  // Nothing but rounding, let through by what a step takes as converged (1e-11), breaks the
  // symmetries of the square.
  const Points& p = state.surfaces[0].current->control_points();
  const auto [m, n] = state.surfaces[0].current->net();
  double asymmetry = 0;
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < n; ++j) {
      const auto a = p.row(i * n + j), mirrored = p.row((m - 1 - i) * n + j),
                 swapped = p.row(j * n + i);
      asymmetry = std::max({asymmetry, std::abs(a[0] + mirrored[0] - 10),
                            std::abs(a[1] - mirrored[1]), std::abs(a[2] - mirrored[2]),
                            std::abs(a[0] - swapped[1]), std::abs(a[2] - swapped[2])});
    }
  }
  EXPECT_LT(asymmetry, 1e-8 * 10);
}

TEST(Pictures, ShowSurfacesAndTools) {
  auto commands = script("figure_6_14.json");
  commands.erase(commands.begin() + 4, commands.end());  // the first is the default hold
  const Session session = run(commands);
  const Surface surface = *session.state().surfaces[0].current;
  const auto svg = examples::draw({&surface, 1}, session.state().tools);
  ASSERT_TRUE(svg);
  EXPECT_TRUE(svg->starts_with("<svg"));
  EXPECT_TRUE(svg->ends_with("</svg>\n"));
  EXPECT_NE(svg->find("fill-opacity"), std::string::npos);  // the ball
}

}  // namespace
}  // namespace knead
