#include <gtest/gtest.h>

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <random>

#include "exchange/step/write/text.hpp"
#include "knead/exchange/format.hpp"
#include "knead/spline/evaluate.hpp"
#include "knead/spline/extremum.hpp"
#include "support.hpp"

namespace knead {
namespace {

using testing::run;
using testing::same_bits;
using testing::same_state;

// Random documents under random scripts. Every seed is printed where something fails.

struct Similarity {
  double scale = 1;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  Point shift = Point::Zero();
  [[nodiscard]] Point direction(const Point& d) const { return scale * (turn * d); }
  [[nodiscard]] Point operator()(const Point& p) const { return direction(p) + shift; }
};

struct Random {
  std::mt19937 engine;
  double real(double a, double b) { return std::uniform_real_distribution<double>(a, b)(engine); }
  int whole(int a, int b) { return std::uniform_int_distribution<int>(a, b)(engine); }
  Point point(double size) { return {real(-size, size), real(-size, size), real(-size, size)}; }
};

/// Clamped knots on a random domain, with interior knots of random multiplicity.
KnotVector random_knots(Random& random, int degree) {
  const double from = random.real(-3, 3), length = random.real(0.5, 20);
  std::vector<double> knots(static_cast<std::size_t>(degree) + 1, from);
  const int spans = random.whole(3, 6);
  for (int k = 1; k < spans; ++k) {
    const int multiplicity = random.whole(0, 4) == 0 ? random.whole(1, degree) : 1;
    const double knot = from + length * (k + random.real(-0.25, 0.25)) / spans;
    knots.insert(knots.end(), static_cast<std::size_t>(multiplicity), knot);
  }
  knots.insert(knots.end(), static_cast<std::size_t>(degree) + 1, from + length);
  return *KnotVector::create(degree, knots);
}

/// A wavy, possibly rational sheet of a size near 10.
Surface random_surface(Random& random) {
  const KnotVector u = random_knots(random, random.whole(2, 4)),
                   v = random_knots(random, random.whole(2, 4));
  Points points(u.count() * v.count(), 3);
  std::vector<double> weights;
  const bool rational = random.whole(0, 1) == 1;
  for (int i = 0; i < u.count(); ++i) {
    for (int j = 0; j < v.count(); ++j) {
      const double s = (u.greville(i) - u.domain().lower) / u.domain().length();
      const double t = (v.greville(j) - v.domain().lower) / v.domain().length();
      points.row(i * v.count() + j) << 10 * s, 8 * t,
          std::sin(3 * s) + std::cos(2 * t) + random.real(-0.1, 0.1);
      if (rational) weights.push_back(random.real(0.8, 1.25));
    }
  }
  return *Surface::create({u, v}, points, weights);
}

Surface placed(const Surface& s, const Similarity& m) {
  Points points = s.control_points();
  for (Eigen::Index k = 0; k < points.rows(); ++k)
    points.row(k) = m(points.row(k).transpose()).transpose();
  return *Surface::create({s.knots(0), s.knots(1)}, points,
                          {s.weights().begin(), s.weights().end()});
}

Session document_of(const Surface& surface) {
  const std::vector<step::NewSurface> surfaces = {{"s", surface}};
  auto text = step::text_of(surfaces, {});
  if (!text) ADD_FAILURE() << text.error().message();
  auto source = open_source(*text, "random");
  if (!source) ADD_FAILURE() << source.error().message();
  return Session(Document::from(*std::move(source)));
}

std::string list(const Point& p) {
  return fmt::format("[{:.17g},{:.17g},{:.17g}]", p.x(), p.y(), p.z());
}

/// A random command, with its lengths and directions placed.
std::string random_command(Random& random, const Similarity& m, bool settings = true) {
  const double s = random.real(0.2, 0.8), t = random.real(0.2, 0.8), k = m.scale;
  const Point by = m.direction(random.point(0.3));
  switch (random.whole(0, settings ? 24 : 9)) {
    case 0:
    case 1:  // clear of the surface or into it by less than its radius: what is half way through
             // has two sides to go to
      return fmt::format(
          R"({{"do":"tool","name":"a","radius":{:.17g},"position":{},"stiffness":{}}})",
          k * random.real(1.5, 2.5),
          list(m(Point(10 * s, 8 * t, 3 + std::sin(3 * s) + std::cos(2 * t) - random.real(1, 2)))),
          random.whole(0, 1) == 0 ? "1e3" : "1e4");
    case 2:  // round about its axis, so that the axis alone says how it lies
      return fmt::format(
          R"({{"do":"tool","name":"b","shape":"capsule","radius":{:.17g},"height":{:.17g},)"
          R"("position":{},"axis":{},"mode":"proximity","range":{:.17g}}})",
          k * random.real(1, 2), k * 2, list(m(Point(10 * s, 8 * t, 1))),
          list(m.direction(Point(1, 0.2, 0.1))), k);
    case 3:
      return fmt::format(R"({{"do":"move","tool":"a","by":{}}})", list(by));
    case 4:
    case 5:
    case 6:
      return fmt::format(R"({{"do":"step","count":{},"lambda":{:.17g}}})", random.whole(1, 3),
                         random.real(0.5, 20));
    case 7:
      return fmt::format(R"({{"do":"force","at":[{:.17g},{:.17g}],"to":{},"strength":{:.17g}}})", s,
                         t, list(m(Point(10 * s, 8 * t, 2))), random.real(1, 20));
    case 8:  // its default radius is a share of a box along the axes, which does not turn with the
             // surface
      return fmt::format(
          R"({{"do":"drag","at":[{:.17g},{:.17g}],"by":{},"radius":{:.17g},"steps":2,)"
          R"("plasticity":{:.17g}}})",
          s, t, list(by), k * random.real(0.5, 2), random.real(0, 1));
    case 9:
      return fmt::format(R"({{"do":"load","vector":{}}})",
                         list(m.direction(random.point(0.2)) / (k * k) * k));
    case 10:
      return R"({"do":"remove","tool":"a"})";
    case 11:
      return fmt::format(R"({{"do":"pin","at":[{:.17g},{:.17g}]}})", s, t);
    case 12:
      return fmt::format(R"({{"do":"material","beta":[{0:.17g},{0:.17g},{0:.17g}]}})",
                         random.real(0.005, 0.1));
    case 13:
      return fmt::format(R"({{"do":"edge","which":"{}","hold":"{}"}})",
                         random.whole(0, 1) == 0 ? "u0" : "v1",
                         random.whole(0, 1) == 0 ? "position" : "tangent");
    case 14:
      return fmt::format(R"({{"do":"freeze","region":[[{0:.17g},{0:.17g}],[{1:.17g},{1:.17g}]]}})",
                         s, t);
    case 15:
      return fmt::format(R"({{"do":"keep","{}":{:.17g}}})", random.whole(0, 1) == 0 ? "u" : "v", s);
    case 16:
      return fmt::format(R"({{"do":"refine","region":[[{0:.17g},{0:.17g}],[{1:.17g},{1:.17g}]]}})",
                         s, t);
    case 17:
      return fmt::format(R"({{"do":"limit","distance":{:.17g}}})", k * random.real(0.2, 1));
    case 18:
      return R"({"do":"rest"})";
    case 19:
      return fmt::format(R"({{"do":"evolve","mode":"{}"}})",
                         random.whole(0, 1) == 0 ? "acm" : "dynamic");
    case 20:
      return fmt::format(R"({{"do":"points","which":[{}],"rows_v":[{}],"by":{}}})",
                         random.whole(0, 30), random.whole(0, 4), list(by));
    case 21:
      return fmt::format(R"({{"do":"weights","which":[{0}],"rows_u":[{1}],"{2}":{3:.17g}}})",
                         random.whole(0, 30), random.whole(0, 4),
                         random.whole(0, 1) == 0 ? "weight" : "by", random.real(0.7, 1.4));
    case 22:
      return fmt::format(
          R"({{"do":"relax","at":[{:.17g},{:.17g}],"radius":{:.17g},"strength":{:.17g}}})", s, t,
          k * random.real(1, 4), random.real(0.1, 1));
    default:
      return R"({"do":"release"})";
  }
}

double largest_violation(const Session& session) {
  return session.state().steps.empty() ? 0 : session.state().steps.back().violation;
}

class RandomScript : public ::testing::TestWithParam<unsigned> {};

TEST_P(RandomScript, GivesTheSameBitsByUndoRedoAndReplay) {
  Random random{std::mt19937(GetParam())};
  const Surface surface = random_surface(random);
  Session session = document_of(surface);
  int accepted = 0;
  for (int k = 0; k < 25; ++k) {
    const auto before = std::make_shared<const SessionState>(session.state());
    const std::string json = random_command(random, {});
    const auto status = session.execute(*parse_command(json));
    if (!status) {
      ASSERT_TRUE(same_state(session.state(), *before))
          << json << " was refused: " << status.error().message();
      continue;
    }
    ++accepted;
    const auto after = std::make_shared<const SessionState>(session.state());
    ASSERT_LE(largest_violation(session), 1e-10 * bounding_box(surface).diagonal()) << json;
    if (random.whole(0, 2) > 0) continue;
    run(session, {R"({"do":"undo"})"});
    ASSERT_TRUE(same_state(session.state(), *before)) << json;
    if (random.whole(0, 1) == 0) {
      if (session.execute(*parse_command(R"({"do":"step"})"))) run(session, {R"({"do":"undo"})"});
      ASSERT_TRUE(same_state(session.state(), *before)) << json;
      const auto again = session.execute(*parse_command(json));
      ASSERT_TRUE(again) << json;
    } else {
      run(session, {R"({"do":"redo"})"});
    }
    ASSERT_TRUE(same_state(session.state(), *after)) << json;
  }
  EXPECT_GE(accepted, 12);
  Session replay = document_of(surface);
  for (const Command& command : session.journal())
    ASSERT_TRUE(replay.execute(command)) << to_json(command);
  EXPECT_TRUE(same_state(replay.state(), session.state()));
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomScript, ::testing::Range(1u, 11u),
                         [](const auto& seed) { return std::to_string(seed.param); });

TEST(Property, NothingMovesAtRestUnderAnyConstraints) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(fmt::format("seed {}", seed));
    Random random{std::mt19937(seed)};
    Session session = document_of(random_surface(random));
    for (int k = 0; k < 8; ++k) {
      const std::string json = random_command(random, {});
      const Command command = *parse_command(json);
      if (fields_of<PinCommand>(command) || fields_of<MaterialCommand>(command) ||
          fields_of<EdgeCommand>(command) || fields_of<FreezeCommand>(command) ||
          fields_of<KeepCommand>(command) || fields_of<RefineCommand>(command)) {
        run(session, {json});
      }
    }
    const auto before = session.state().surfaces.front().current;
    for (const char* mode : {"acm", "dynamic"}) {
      run(session,
          {fmt::format(R"({{"do":"evolve","mode":"{}"}})", mode), R"({"do":"step","count":3})"});
      EXPECT_TRUE(same_bits(*session.state().surfaces.front().current, *before)) << mode;
    }
  }
}

TEST(Property, EnergyFallsWithoutForces) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(fmt::format("seed {}", seed));
    Random random{std::mt19937(seed)};
    Session session = document_of(random_surface(random));
    for (int k = 0; k < 4; ++k) {
      const std::string json = random_command(random, {}, false);
      const auto command = parse_command(json);
      if (fields_of<MoveCommand>(*command)) continue;
      const auto status = session.execute(*command);
      ASSERT_TRUE(status) << json << status.error().message();
    }
    run(session,
        {R"({"do":"drag","at":[0.4,0.6],"by":[0.2,0.1,0.8],"plasticity":0})", R"({"do":"load"})"});
    while (!session.state().tools.empty())
      run(session, {R"({"do":"remove","tool":")" + session.state().tools.front().name + R"("})"});
    while (!session.state().forces.empty()) run(session, {R"({"do":"remove"})"});
    const bool dynamic = seed % 2 == 0;
    if (dynamic) run(session, {R"({"do":"evolve","mode":"dynamic"})"});
    double energy = *session.energy();
    ASSERT_GT(energy, 0);
    if (dynamic) {  // ½XᵀKX + ½VᵀMV; `energy` is XᵀKX
      energy *= 0.5;
    }
    for (int k = 0; k < 10; ++k) {
      run(session, {R"({"do":"step"})"});
      const StepRecord& step = session.state().steps.back();
      const double now = dynamic ? 0.5 * step.energy + step.kinetic : step.energy;
      EXPECT_LE(now, energy * (1 + 1e-12)) << k;
      energy = now;
    }
  }
}

TEST(Property, MotionsAndScalesOfFileAndScriptCarryOver) {
  int moved = 0;
  for (unsigned seed = 1; seed <= 25; ++seed) {
    SCOPED_TRACE(fmt::format("seed {}", seed));
    Similarity motion;
    {
      Random random{std::mt19937(1000 + seed)};
      motion.scale = std::exp(random.real(-5, 5));
      motion.turn =
          Eigen::AngleAxisd(random.real(0, 3), random.point(1).normalized()).toRotationMatrix();
      motion.shift = motion.scale * random.point(20);
    }
    const auto play = [&](const Similarity& m) {
      Random random{std::mt19937(seed)};
      Session session = document_of(placed(random_surface(random), m));
      run(session, {R"({"do":"hold","rows":1})"});
      for (int k = 0; k < 12; ++k) {
        const auto command = parse_command(random_command(random, m));
        // Loads are in units of the model, whose length is the surface's.
        if (fields_of<LoadCommand>(*command)) continue;
        (void)session.execute(*command);
      }
      return session;
    };
    const Session a = play({}), b = play(motion);
    ASSERT_EQ(a.journal().size(), b.journal().size());
    const Points &p = a.state().surfaces.front().current->control_points(),
                 &q = b.state().surfaces.front().current->control_points();
    const double largest = a.largest_displacement(0);
    moved += largest > 0.1;
    double error = 0;
    ASSERT_EQ(p.rows(), q.rows());
    for (Eigen::Index k = 0; k < p.rows(); ++k) {
      error = std::max(error,
                       (motion(p.row(k).transpose()) - q.row(k).transpose()).norm() / motion.scale);
    }
    EXPECT_LE(error, 1e-7 * std::max(largest, 1e-3)) << "of " << largest << "\n"
                                                     << script_json(a.journal());
  }
  EXPECT_GE(moved, 12);
}

}  // namespace
}  // namespace knead
