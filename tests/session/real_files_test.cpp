#include <gtest/gtest.h>

#include <filesystem>
#include <numbers>
#include <set>

#include "knead/spline/evaluate.hpp"
#include "knead/spline/extremum.hpp"
#include "support.hpp"
#include "support/own_files.hpp"

namespace knead {
namespace {

using testing::run;

// Surfaces of every kind from real CAD files, under default settings.

/// Largest angle between the normals on both sides of interior knot lines of full multiplicity,
/// degrees.
double largest_crease(const Surface& s) {
  double largest = 0;
  for (int d = 0; d < 2; ++d) {
    const KnotVector &knots = s.knots(d), &along = s.knots(1 - d);
    const Interval domain = knots.domain(), line = along.domain();
    std::set<double> full;
    for (double knot : knots.knots()) {
      if (knot > domain.lower && knot < domain.upper &&
          std::ranges::count(knots.knots(), knot) >= knots.degree())
        full.insert(knot);
    }
    for (double knot : full) {
      for (double t : {0.13, 0.37, 0.5, 0.71, 0.9}) {
        std::array<Point, 2> normal;
        for (int side = 0; side < 2; ++side) {
          Parameters<2> where(1, 2);
          where(0, d) = knot + (side == 0 ? -1e-9 : 1e-9) * domain.length();
          where(0, 1 - d) = line.lower + t * line.length();
          const auto jet = evaluate<2>(s, where, 1);
          if (!jet) return std::nan("");
          const Point u = jet->at({1, 0}).row(0), v = jet->at({0, 1}).row(0);
          normal[static_cast<std::size_t>(side)] = u.cross(v).normalized();
        }
        const double angle =
            std::atan2(normal[0].cross(normal[1]).norm(), normal[0].dot(normal[1]));
        if (std::isfinite(angle)) largest = std::max(largest, angle * 180 / std::numbers::pi);
      }
    }
  }
  return largest;
}

/// Counts the surfaces, and those of them with lines that could become creases.
void bend(const std::vector<std::filesystem::path>& files, int& sculpted, int& lines) {
  for (const auto& path : files) {
    auto document = Document::open(path);
    ASSERT_TRUE(document) << document.error().message();
    Session session(std::move(*document));
    std::set<std::array<int, 5>> kinds;
    for (std::size_t k = 0; k < session.document().surfaces().size(); ++k) {
      const DocumentSurface& s = session.document().surfaces()[k];
      const double crease = largest_crease(*s.surface), size = bounding_box(*s.surface).diagonal();
      const auto closed = session.document().model()->surfaces[k].closed;
      const std::array<int, 5> kind = {s.surface->rational(), closed[0], closed[1],
                                       s.surface->knots(0).degree(), s.surface->knots(1).degree()};
      if (s.surface->size() > 600 || size == 0 || kinds.size() > 5 || !kinds.insert(kind).second)
        continue;
      SCOPED_TRACE(path.filename().string() + " " + s.id);
      run(session,
          {R"({"do":"select","surface":")" + s.id + R"("})", R"({"do":"hold","mode":"open"})",
           R"({"do":"tool","radius":0.2,"relative":true,"at":[0.45,0.55],"touches":"all"})",
           R"({"do":"move","by":[0.03,0.05,0.15],"relative":true})"});
      if (const auto status = session.execute(make_command(StepCommand{1, 3, {}})); !status) {
        EXPECT_NE(status.error().what.find("no area"), std::string::npos)
            << status.error().message();
        continue;
      }
      const StepRecord& step = session.state().steps.back();
      EXPECT_LE(step.violation, 1e-10 * size);
      EXPECT_TRUE(std::isfinite(step.energy));
      ++sculpted;
      if (crease < 1e-3 && step.largest_displacement > 1e-3 * size) {
        EXPECT_LT(largest_crease(*session.state().surfaces[k].current), 1e-3) << "degrees";
        ++lines;
      }
      run(session,
          {R"({"do":"undo"})", R"({"do":"edge","hold":"tangent"})", R"({"do":"step","lambda":3})"});
      EXPECT_LE(session.state().steps.back().violation, 1e-10 * size);
      const auto bytes = session.save();
      ASSERT_TRUE(bytes) << bytes.error().message();
      EXPECT_TRUE(step::File::parse(*bytes, "saved"));
    }
  }
}

TEST(RealFiles, SurfacesOfEveryKindBendWithoutCreasesAndKeepTheirConstraints) {
  int sculpted = 0, lines = 0;
  bend(testing::own_step_paths(), sculpted, lines);
  EXPECT_GE(sculpted, 1);
}

TEST(RealFiles, ForeignSurfacesBendWithoutCreasesAndKeepTheirConstraints) {
  const auto files = testing::foreign_paths(testing::foreign_step);
  KNEAD_NEEDS(files);
  int sculpted = 0, lines = 0;
  bend(files, sculpted, lines);
  EXPECT_GE(sculpted, 20);
  EXPECT_GE(lines, 10);
}

TEST(RealFiles, CollapsedCapsOfAWingAreLeftOutOfWhatIsConnected) {
  const std::filesystem::path file = testing::foreign_cad("simple_wing.stp");
  KNEAD_NEEDS(file);
  const auto document = Document::open(file);
  ASSERT_TRUE(document) << document.error().message();
  int moved = 0, refused = 0;
  for (const DocumentSurface& s : document->surfaces()) {
    Session session{Document(*document)};
    const auto select = R"({"do":"select","surface":")" + s.id + R"(","connected":true})";
    const auto command = parse_command(select);
    ASSERT_TRUE(command);
    if (const auto status = session.execute(*command); !status) {
      EXPECT_EQ(status.error().what, s.id + " has no area");
      ++refused;
      continue;
    }
    EXPECT_NE(session.state().notes.back().find("left out: it has no area"), std::string::npos);
    run(session, {R"({"do":"step"})"});
    ++moved;
  }
  EXPECT_EQ(moved, 7);
  EXPECT_EQ(refused, 6);
}

}  // namespace
}  // namespace knead
