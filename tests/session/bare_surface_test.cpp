// Surfaces of files on which no face lies: their sides are held as faces hold their edges.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "knead/exchange/format.hpp"
#include "knead/spline/evaluate.hpp"
#include "knead/spline/revolution.hpp"
#include "support.hpp"
#include "support/error_codes.hpp"
#include "support/surfaces.hpp"

namespace knead {
namespace {

using testing::fresh;
using testing::refusal;
using testing::run;

/// A file of this format with nothing but surfaces.
Session opened(const std::vector<Surface>& surfaces, const char* format) {
  std::vector<NamedSurface> named;
  for (const Surface& s : surfaces) named.push_back({"", s});
  auto bytes = save_surfaces(named, *find_format(format), {.unit = "mm"});
  if (!bytes) ADD_FAILURE() << bytes.error().message();
  auto source = open_source(*std::move(bytes), fmt::format("bare.{}", format));
  if (!source) ADD_FAILURE() << source.error().message();
  return Session(Document::from(*std::move(source)));
}

Surface sheet() {
  Session session = fresh();
  run(session, {R"({"do":"new","size":[100,100],"net":[12,12]})"});
  return *session.state().surfaces[0].current;
}

const char* const held = R"({"do":"hold","mode":"position","all":true})";
const char* const ball = R"({"do":"tool","name":"b","radius":30,"position":[50,50,25]})";
const char* const press = R"({"do":"step","count":15,"lambda":20})";

std::string id_of(const Session& session, std::size_t k = 0) {
  return session.state().surfaces[k].id;
}
std::string select(const Session& session, std::size_t k = 0) {
  return fmt::format(R"({{"do":"select","surface":"{}"}})", id_of(session, k));
}

/// The largest motion of control points on the sides, and of any.
std::array<double, 2> motion(const Session& session) {
  const SceneSurface& s = session.state().surfaces[0];
  const auto [m, n] = s.current->net();
  std::array<double, 2> result = {0, 0};
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < n; ++j) {
      const double moved =
          (s.current->control_points().row(i * n + j) - s.opened->control_points().row(i * n + j))
              .norm();
      const bool side = i == 0 || j == 0 || i == m - 1 || j == n - 1;
      result[0] = std::max(result[0], side ? moved : 0);
      result[1] = std::max(result[1], moved);
    }
  }
  return result;
}

bool notes(const Session& session, const std::string& what) {
  return std::ranges::any_of(session.state().notes,
                             [&](const std::string& n) { return n.find(what) != n.npos; });
}

constexpr int samples = 40;  // per direction

/// Calls `visit(from, way)` for points of a surface, in the middle of even cells of its domain.
template <class Visit>
void for_each_way(const SceneSurface& s, const Visit& visit) {
  const Interval a = s.current->knots(0).domain(), b = s.current->knots(1).domain();
  for (int i = 0; i < samples; ++i) {
    for (int j = 0; j < samples; ++j) {
      const std::array<double, 2> u = {a.lower + a.length() * (i + 0.5) / samples,
                                       b.lower + b.length() * (j + 0.5) / samples};
      const Point from = *evaluate_point<2>(*s.opened, u);
      visit(from, Point(*evaluate_point<2>(*s.current, u) - from));
    }
  }
}

TEST(BareSurface, HoldsItsSidesInEveryFormat) {
  for (const char* format : {"step", "iges", "3dm", "brep"}) {
    const Format* found = find_format(format);
    if (found == nullptr || found->save == nullptr) continue;
    Session session = opened({sheet()}, format);
    run(session, {held, select(session), ball, press});
    EXPECT_EQ(motion(session)[0], 0) << format;
    EXPECT_GT(motion(session)[1], 3) << format;
    EXPECT_FALSE(notes(session, "nothing holds")) << format;
  }
}

TEST(BareSurface, IsFreeWhereAskedAndThatIsNoted) {
  Session session = opened({sheet()}, "step");
  run(session, {held, select(session), R"({"do":"hold","mode":"open"})", ball, press});
  EXPECT_GT(motion(session)[0], 1);
  EXPECT_TRUE(notes(session, "nothing holds " + id_of(session)));
  EXPECT_TRUE(testing::has_note(session.state().notes, ErrorCode::surface_loose));
}

TEST(BareSurface, LetsASideGoByItsName) {
  for (const char* field : {"which", "edge"}) {
    Session session = opened({sheet()}, "step");
    run(session, {held, select(session),
                  fmt::format(R"({{"do":"edge","{}":"u0","hold":"open"}})", field), ball, press});
    const SceneSurface& s = session.state().surfaces[0];
    const auto moved = [&](double u, double v) {
      const KnotVector &a = s.current->knots(0), &b = s.current->knots(1);
      const std::array<double, 2> at = {a.domain().lower + u * a.domain().length(),
                                        b.domain().lower + v * b.domain().length()};
      return (*evaluate_point<2>(*s.current, at) - *evaluate_point<2>(*s.opened, at)).norm();
    };
    EXPECT_GT(moved(0, 0.5), 0.1) << field;
    EXPECT_EQ(moved(1, 0.5), 0) << field;
    EXPECT_EQ(moved(0.5, 0), 0) << field;
    run(session, {fmt::format(R"({{"do":"edge","{}":"u0","hold":"position"}})", field)});
  }
}

TEST(BareSurface, KeepsWhatItIsJoinedTo) {
  Points left = sheet().control_points();
  left.col(0) /= 2;
  Points right = left;
  right.col(0).array() += 50;
  Session session =
      opened({*sheet().with_control_points(left), *sheet().with_control_points(right)}, "step");
  run(session, {held, select(session),
                R"({"do":"tool","name":"b","radius":20,"position":[25,50,15]})", press});
  EXPECT_EQ(motion(session)[0], 0);
  EXPECT_GT(motion(session)[1], 1);
}

// Stretch spreads what a tool presses far over a surface, clay much less. Nothing else holds them:
// without their place held both would move by the whole depth, on the other side too.
TEST(BareSurface, AClosedOneDentsWhereItIsPressed) {
  for (const bool torus : {false, true}) {
    for (const bool clay : {false, true}) {
      const Surface shape =
          torus ? *revolve(*circle_quarters({10, 0}, 4, 0, 4)) : testing::sphere();
      const double top = torus ? 4 : 1, x = torus ? 10 : 0, deep = 0.25 * top, r = 0.5 * top;
      const auto at = [&](double z) { return fmt::format("[{},0,{}]", x, z); };
      Session session = opened({shape}, "step");
      const char* const halved = R"({"do":"refine","region":[[0,1],[0,1]]})";
      run(session, {held, select(session), halved, halved});
      if (clay) run(session, {R"({"do":"material","preset":"clay"})"});
      run(session,
          {fmt::format(R"({{"do":"tool","name":"b","radius":{},"position":{}}})", r,
                       at(clay ? 9 * top : top + r - deep)),
           clay ? fmt::format(R"({{"do":"stroke","tool":"b","path":[{}]}})", at(top + r - deep))
                : R"({"do":"step","count":30,"lambda":1})"});
      double pressed = 0, opposite = 0;
      for_each_way(session.state().surfaces[0], [&](const Point& from, const Point& way) {
        pressed = std::max(pressed, -way.z());
        if (torus ? from.x() < -6 : from.z() < -0.9) opposite = std::max(opposite, way.norm());
      });
      EXPECT_GT(pressed, (clay ? 0.9 : 0.65) * deep) << torus;
      EXPECT_LT(opposite, (clay ? 0.25 : 0.5) * deep) << torus;
      EXPECT_FALSE(notes(session, "nothing holds"));
    }
  }
}

const char* const shell =
    R"({"do":"material","model":"shell","young":1000,"poisson":0,"thickness":0.05})";

TEST(BareSurface, AShellThatNothingHoldsIsNoted) {
  for (const char* act : {R"({"do":"step","count":2,"lambda":20})",
                          R"({"do":"stroke","tool":"b","path":[[50,50,25]]})"}) {
    Session session = opened({sheet()}, "step");
    run(session, {held, select(session), R"({"do":"hold","mode":"open"})", shell, ball, act});
    EXPECT_TRUE(notes(session, "nothing holds " + id_of(session))) << act;
    Session kept = opened({sheet()}, "step");
    run(kept, {held, select(kept), shell, ball, act});
    EXPECT_FALSE(notes(kept, "nothing holds")) << act;
  }
}

TEST(BareSurface, AClosedShellKeepsItsPlace) {
  Session session = opened({testing::sphere()}, "step");
  run(session, {held, select(session), R"({"do":"refine","region":[[0,1],[0,1]]})", shell,
                R"({"do":"tool","name":"b","radius":0.5,"position":[0,0,1.35]})",
                R"({"do":"step","count":8,"lambda":0.01})"});
  Point mean = Point::Zero();
  double deepest = 0;
  for_each_way(session.state().surfaces[0], [&](const Point& from, const Point& way) {
    const double share = std::sqrt(std::max(0.0, 1 - from.z() * from.z()));
    mean += share * way / (samples * samples);
    deepest = std::max(deepest, -way.z());
  });
  EXPECT_GT(deepest, 0.08);
  EXPECT_LT(mean.norm(), 0.1 * deepest);
  EXPECT_FALSE(notes(session, "nothing holds"));
}

TEST(BareSurface, WhatIsMadeHoldsWhatTheScriptSays) {
  Session session = fresh();
  run(session, {R"({"do":"new","size":[100,100],"net":[12,12]})", held, ball, press});
  EXPECT_GT(motion(session)[0], 1);
  EXPECT_TRUE(notes(session, "nothing holds"));
}

}  // namespace
}  // namespace knead
