// Strokes and brushes that pass from one surface to another that is coupled with it.
#include <numbers>

#include "contact/groove.hpp"
#include "pieces.hpp"
#include "session/brushes.hpp"
#include "support/long_run.hpp"

namespace knead::testing {
namespace {

constexpr double radius = 20, depth = 8;

/// How far the halves are apart at x = 100, and the largest angle between their tangent planes,
/// degrees.
struct Meeting {
  double gap = 0, angle = 0;
};
Meeting seam_of(const Session& session) {
  Meeting seam;
  const Surface &a = *session.state().surfaces[0].current,
                &b = *session.state().surfaces[1].current;
  const auto jet = [](const Surface& s, double u, double v) {
    Parameters<2> at(1, 2);
    at << u, v;
    const auto found = evaluate<2>(s, at, 1);
    const Point su = found->at({1, 0}).row(0), sv = found->at({0, 1}).row(0);
    return std::pair<Point, Point>(found->points().row(0), su.cross(sv).normalized());
  };
  for (int k = 0; k <= 1000; ++k) {
    const auto [p, m] = jet(a, 1, k / 1000.);
    const auto [q, n] = jet(b, 0, k / 1000.);
    seam.gap = std::max(seam.gap, (p - q).norm());
    seam.angle =
        std::max(seam.angle, std::asin(std::min(1., m.cross(n).norm())) * 180 / std::numbers::pi);
  }
  return seam;
}

/// A brush led along points of the plane, over whichever surfaces they lie on.
std::string over(const Session& session, const std::string& fields,
                 const std::vector<Point>& points) {
  std::string path, surfaces;
  for (const Point& p : points) {
    const auto [surface, at] = where(session, p.x(), p.y());
    path += fmt::format("{}[{:.17g},{:.17g}]", path.empty() ? "" : ",", at[0], at[1]);
    surfaces +=
        fmt::format(R"({}"{}")", surfaces.empty() ? "" : ",", session.state().surfaces[surface].id);
  }
  return R"({"do":"brush",)" + fields + R"(,"path":[)" + path + R"(],"surfaces":[)" + surfaces +
         "]}";
}

Point now(const Session& session, double x, double y) {
  const auto [surface, at] = where(session, x, y);
  return testing::at(*session.state().surfaces[surface].current, at[0], at[1]);
}

const std::vector<std::string> clay = {
    R"({"do":"material","preset":"clay"})",
    R"({"do":"tool","shape":"sphere","radius":20,"position":[100,100,60],"plasticity":1})"};

std::string stroke(const Point& from, const Point& to) {
  return fmt::format(R"({{"do":"stroke","path":[[{},{},12],[{},{},12]]}})", from.x(), from.y(),
                     to.x(), to.y());
}

/// Leads the tool from one place to the other; the figures of docs/clay.md are those of a sheet in
/// one piece.
Session grooved(const std::vector<Quad>& sheet, const Point& from, const Point& to) {
  Session session = pieces(sheet, clay);
  run(session, {stroke(from, to)});
  const Groove g = groove_of(shapes_of(session, &SceneSurface::current),
                             shapes_of(session, &SceneSurface::opened), from, to, radius, depth);
  const double chord = 2 * std::sqrt(radius * radius - (radius - depth / 2) * (radius - depth / 2));
  EXPECT_GT(g.shallowest, 0.92 * depth);
  EXPECT_LT(g.lowest, 1.08 * depth);
  EXPECT_LT(g.width, 1.25 * chord);
  EXPECT_LT(g.beyond, 0.01 * depth);
  EXPECT_LT(g.rim, 0.02 * depth);
  return session;
}

TEST(Across, AStrokeInClayLeavesOneGrooveInAllSurfaces) {
  struct Case {
    const char* name;
    std::vector<Quad> sheet;
    Point from, to;
    bool only_long;
  };
  for (const Case& c :
       {Case{"equal nets", halves(), {25, 97, 0}, {175, 97, 0}, true},
        {"along the seam", halves(), {100, 40, 0}, {100, 160, 0}, false},
        {"other nets", halves({64, 64}, {50, 71}), {47, 47, 0}, {153, 153, 0}, false},
        {"another degree", halves({48, 64}, {50, 58}, 4), {25, 97, 0}, {175, 97, 0}, true}}) {
    if (c.only_long && !long_run()) continue;
    SCOPED_TRACE(c.name);
    const Meeting seam = seam_of(grooved(c.sheet, c.from, c.to));
    EXPECT_LT(seam.gap, 1e-12 * side);
    EXPECT_LT(seam.angle, 1e-6);
  }
}

TEST(Across, ThreeSurfacesAroundACornerStayTogetherInTheirGroove) {
  const Session session = grooved(three(), {40, 120, 0}, {160, 90, 0});
  const auto& surfaces = session.state().surfaces;
  double gap = 0;
  for (int k = 0; k <= 500; ++k) {
    const double t = k / 500.;
    const auto apart = [&](int a, double s, double u, int b, double v, double w) {
      gap = std::max(gap, (testing::at(*surfaces[static_cast<std::size_t>(a)].current, s, u) -
                           testing::at(*surfaces[static_cast<std::size_t>(b)].current, v, w))
                              .norm());
    };
    apart(0, t, 0, 1, 0, t);
    apart(0, 0, t, 2, t, 0);
    apart(1, t, 0, 2, 0, t);
  }
  EXPECT_LT(gap, 1e-12 * side);
}

const char* const kinds[] = {R"("kind":"push","height":5)",
                             R"("kind":"inflate","height":5)",
                             R"("kind":"flatten")",
                             R"("kind":"smooth")",
                             R"("kind":"pinch")",
                             R"("kind":"crease","height":5)",
                             R"("kind":"ridge","height":5)",
                             R"("kind":"push","height":5,"steady":0.5)",
                             R"("kind":"push","height":5,"mirror":[[100,0,0],[1,0,0]])",
                             R"("kind":"pull","height":5,"radial":3,"axis":[[100,100,0],[0,0,1]])",
                             R"("kind":"grab","by":[3,-2,9])",
                             R"("kind":"twist","angle":30)",
                             R"("kind":"scale","factor":1.4)"};

bool about_a_place(const std::string& kind) {
  return kind.find("grab") != std::string::npos || kind.find("twist") != std::string::npos ||
         kind.find("scale") != std::string::npos;
}

/// Largest distance of the shapes that two sessions have, of points of the plane as opened, and the
/// largest displacement.
std::pair<double, double> compared(const Session& a, const Session& b) {
  double apart = 0, largest = 0;
  for (int i = 0; i <= 60; ++i) {
    for (int j = 0; j <= 60; ++j) {
      const double x = 40 + 2 * i, y = 40 + 2 * j;
      const Point p = now(a, x, y), q = now(b, x, y);
      apart = std::max(apart, (p - q).norm());
      largest = std::max(largest, (q - Point(x, y, 0)).norm());
    }
  }
  return {apart, largest};
}

/// What a brush does to a sheet with a bump.
Session brushed(const std::vector<Quad>& sheet, const std::string& kind) {
  Session session = pieces(sheet);
  const std::vector<Point> path = about_a_place(kind)
                                      ? std::vector<Point>{{97, 97, 0}}
                                      : std::vector<Point>{{70, 97, 0}, {90, 99, 0}, {125, 108, 0}};
  run(session, {over(session, R"("kind":"pull","radius":40,"height":6)", {{94, 104, 0}}),
                over(session, kind + R"(,"radius":24)", path)});
  return session;
}

// On nets of the same spans the two halves can have every shape that the sheet in one piece can
// have.
TEST(Across, BrushesDoWhatTheyDoOnOneSurface) {
  const auto sheet = [](int m, int n) {
    return std::vector<Quad>{{{Point(0, 0, 0), {200, 0, 0}, {0, 200, 0}, {200, 200, 0}},
                              {m, n},
                              3,
                              {"u0", "u1", "v0", "v1"}}};
  };
  for (const char* kind : kinds) {
    const Session one = brushed(sheet(77, 40), kind);
    const Session both = brushed(halves({40, 40}, {40, 40}), kind),
                  turned = brushed(turned_halves({40, 40}), kind);
    const auto [apart, largest] = compared(both, one);
    EXPECT_LT(apart, 0.03 * largest) << kind;
    EXPECT_LT(compared(turned, both).first, 1e-6 * largest)
        << kind << ", whatever the side of the normals";
    EXPECT_LT(seam_of(both).gap, 1e-12 * side) << kind;
    EXPECT_LT(seam_of(both).angle, 1e-6) << kind;
  }
}

// A crease is as sharp as its net: two sheets in one piece tell how much of a difference comes from
// nets.
TEST(Across, BrushesDoSoOnOtherNets) {
  const auto sheet = [](int m, int n) {
    return std::vector<Quad>{{{Point(0, 0, 0), {200, 0, 0}, {0, 200, 0}, {200, 200, 0}},
                              {m, n},
                              3,
                              {"u0", "u1", "v0", "v1"}}};
  };
  for (const char* kind : {kinds[0], kinds[1], kinds[2], kinds[4], kinds[5], kinds[10]}) {
    const Session one = brushed(sheet(77, 40), kind), other = brushed(sheet(69, 47), kind);
    const Session both = brushed(halves({40, 40}, {36, 47}), kind);
    const auto [by_net, largest] = compared(other, one);
    const double apart = std::min(compared(both, one).first, compared(both, other).first);
    EXPECT_LT(apart, by_net + 0.03 * largest) << kind;
    EXPECT_LT(seam_of(both).gap, 1e-12 * side) << kind;
    EXPECT_LT(seam_of(both).angle, 1e-6) << kind;
  }
}

TEST(Across, AMaskKeepsWhatItCoversOnBothSides) {
  Session session = pieces(halves());
  run(session, {over(session, R"("kind":"mask","radius":30)", {{97, 100, 0}, {103, 100, 0}})});
  for (const SceneSurface& s : session.state().surfaces)
    EXPECT_GT(std::ranges::count(s.mask, 1.), 20) << s.id;
  run(session,
      {over(session, R"("kind":"pull","radius":50,"height":5)", {{80, 100, 0}, {130, 100, 0}})});
  for (const SceneSurface& s : session.state().surfaces) {
    for (std::size_t i = 0; i < s.mask.size(); ++i) {
      if (s.mask[i] < 1) continue;
      const auto row = static_cast<Eigen::Index>(i);
      EXPECT_EQ(s.current->control_points().row(row), s.opened->control_points().row(row));
    }
  }
  EXPECT_GT(now(session, 60, 100).z(), 2);
  EXPECT_GT(now(session, 150, 100).z(), 2);
  EXPECT_LT(seam_of(session).gap, 1e-12 * side);
}

TEST(Across, EventsOnBothSurfacesAreOneStroke) {
  const std::string fields = R"("kind":"inflate","radius":20,"height":5)";
  Session session = pieces(halves({40, 40}, {40, 40}));
  const std::size_t made = session.journal().size();
  const auto event = [&](double x, bool open) {
    const auto [surface, at] = where(session, x, 97);
    return fmt::format(R"({{"do":"brush",{},"surface":"{}","path":[[{:.17g},{:.17g}]]{}}})", fields,
                       session.state().surfaces[surface].id, at[0], at[1],
                       open ? R"(,"open":true)" : "");
  };
  for (int k = 0; k <= 60; ++k) {
    run(session, {event(70 + k, k < 60)});
    if (k > 0) session.join();
    if (k != 40) continue;
    auto back = Session::restore(session.document(), session.snapshot());
    ASSERT_TRUE(back) << back.error().message();
    EXPECT_TRUE(same_state(back->state(), session.state()));
    Session on = std::move(*back);
    run(on, {event(111, true)});
    Session still = std::move(*Session::restore(session.document(), session.snapshot()));
    run(still, {event(111, true)});
    EXPECT_TRUE(same_state(on.state(), still.state()));
  }
  EXPECT_EQ(session.journal().size(), made + 1);
  Session again = fresh(), at_once = pieces(halves({40, 40}, {40, 40}));
  for (const Command& command : session.journal()) ASSERT_TRUE(again.execute(command));
  run(at_once, {over(at_once, fields, {{70, 97, 0}, {100, 97, 0}, {130, 97, 0}})});
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_TRUE(
        same_bits(*again.state().surfaces[k].current, *session.state().surfaces[k].current));
  }
  EXPECT_LT(compared(session, at_once).first, 0.03 * 5);
  run(session, {R"({"do":"undo"})"});
  for (const SceneSurface& s : session.state().surfaces)
    EXPECT_TRUE(same_bits(*s.current, *s.opened));
}

TEST(Across, NetsBesideTheSeamAreRefinedToo) {
  Session session = pieces(halves({12, 20}, {9, 14}), {R"({"do":"refine","permission":"auto"})"});
  run(session,
      {over(session, R"("kind":"pull","radius":20,"height":5)", {{92, 60, 0}, {92, 140, 0}})});
  EXPECT_NEAR(now(session, 92, 100).z(), 5, 0.05);
  EXPECT_NEAR(now(session, 102, 100).z(), 2.5, 0.15)
      << "half at half the radius, on the other surface";
  EXPECT_LT(seam_of(session).gap, 1e-12 * side);
}

TEST(Across, SmoothingAndDraggingReachOverTheSeam) {
  const std::string bump = R"("kind":"pull","radius":30,"height":6)";
  Session session = pieces(halves());
  run(session, {over(session, bump, {{100, 100, 0}})});
  const std::string right = session.state().surfaces[1].id;
  run(session,
      {fmt::format(R"({{"do":"relax","at":[0.02,0.5],"radius":50,"strength":0.8,"surface":"{}"}})",
                   right)});
  EXPECT_LT(now(session, 100, 100).z(), 4);
  EXPECT_LT(now(session, 92, 100).z(), 4);
  EXPECT_LT(seam_of(session).gap, 1e-12 * side);
  run(session,
      {fmt::format(R"({{"do":"drag","at":[0.3,0.5],"radius":20,"by":[0,0,9],"surface":"{}"}})",
                   right)});
  EXPECT_GT(now(session, 130, 100).z(), 3);
}

TEST(Across, SaysWhatIsWrong) {
  Session session = pieces(halves({24, 24}, {24, 24}));
  const std::string first = session.state().surfaces[0].id;
  const auto wrong = [&](const std::string& fields) {
    return refusal(session, R"({"do":"brush","kind":"push",)" + fields + "}").where;
  };
  EXPECT_EQ(wrong(R"("path":[[0.5,0.5],[0.6,0.5]],"surfaces":["#1"])"), "surfaces");
  EXPECT_EQ(wrong(R"("path":[[0.5,0.5]],"surfaces":["#1"],"surface":"#1")"), "surfaces");
  EXPECT_EQ(wrong(R"("path":[[0.5,0.5]],"surfaces":["#9"])"), "surface");
  run(session, {fmt::format(R"({{"do":"select","surface":"{}"}})", first)});
  EXPECT_EQ(wrong(R"("path":[[0.5,0.5]],"surfaces":["#2"])"), "surfaces");
  EXPECT_EQ(wrong(R"("path":[[0.5,0.5],[0.5,1.5]])"), "path");
}

}  // namespace
}  // namespace knead::testing
