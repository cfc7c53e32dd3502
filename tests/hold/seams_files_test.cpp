#include <chrono>
#include <cstdio>
#include <filesystem>

#include "exchange/step/file.hpp"
#include "seams_support.hpp"
#include "support/own_files.hpp"

/// Seams of CAD files.
namespace knead {
namespace {

using namespace knead::testing;

std::vector<Surface> surfaces_of(const step::File& file) {
  std::vector<Surface> patches;
  for (const brep::SplineSurface& s : file.surfaces()) patches.push_back(s.surface);
  return patches;
}

class SeamFiles : public FileTest {};

double milliseconds(std::chrono::steady_clock::time_point since) {
  return 1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
}

/// Returns the number of seams of surfaces with themselves.
int check_closed(const std::vector<std::filesystem::path>& paths) {
  int closed = 0;
  for (const auto& path : paths) {
    const auto file = step::File::read(path);
    EXPECT_TRUE(file) << path;
    if (!file || file->surfaces().empty()) continue;
    const auto patches = surfaces_of(*file);
    const double tolerance = suggested_seam_tolerance(pointers(patches));
    const auto found = find_seams(pointers(patches), tolerance);
    EXPECT_TRUE(found);
    for (std::size_t k = 0; found && k < patches.size(); ++k) {
      for (int d = 0; d < 2; ++d) {
        bool itself = false;
        for (const Seam& s : found->seams) {
          itself =
              itself || (s.kind == SeamKind::whole && s.a.patch == static_cast<int>(k) &&
                         s.b.patch == s.a.patch && s.a.edge != s.b.edge &&
                         edge_across(s.a.edge) == d && edge_across(s.b.edge) == d && !s.reversed);
        }
        bool pole = false;  // an edge that is a point closes nothing
        for (const CollapsedEdge& c : found->collapsed) {
          pole = pole || (c.edge.patch == static_cast<int>(k) && edge_across(c.edge.edge) == d);
        }
        const bool expected = file->surfaces()[k].closed[static_cast<std::size_t>(d)] && !pole;
        EXPECT_EQ(itself, expected)
            << path.filename() << " " << file->surfaces()[k].id << " direction " << d;
        closed += itself;
      }
    }
  }
  return closed;
}

TEST(Seams, OfSurfacesWithThemselvesAreThoseOfClosedOnes) { check_closed(own_step_paths()); }

TEST(Seams, OfForeignSurfacesWithThemselvesAreThoseOfClosedOnes) {
  const auto paths = foreign_paths(foreign_step);
  KNEAD_NEEDS(paths);
  EXPECT_GT(check_closed(paths), 20);
}

TEST(Seams, HolesMadeOfTwoHalvesHaveTwoSmoothSeamsEach) {
  const auto path = foreign_cad("as1-oc-214.stp");
  KNEAD_NEEDS(path);
  const auto file = step::File::read(path);
  ASSERT_TRUE(file);
  const Coupled c(surfaces_of(*file), {}, suggested_seam_tolerance(pointers(surfaces_of(*file))));
  std::vector<int> seams(c.patches.size(), 0);
  for (const SeamReport& report : c.coupling.reports) {
    if (report.seam.kind != SeamKind::whole) continue;
    EXPECT_EQ(report.continuity, SeamContinuity::g1) << report.reason;
    ++seams[static_cast<std::size_t>(report.seam.a.patch)];
    ++seams[static_cast<std::size_t>(report.seam.b.patch)];
  }
  for (int count : seams) EXPECT_EQ(count, 2);  // all its B-spline surfaces are halves of cylinders
}

TEST_P(SeamFiles, EveryCoupledSeamKeepsItsGapAndEverySmoothOneItsAngle) {
  const auto file = step::File::read(path_);
  ASSERT_TRUE(file);
  if (file->surfaces().empty()) GTEST_SKIP() << "no B-spline surfaces";
  const auto patches = surfaces_of(*file);
  const double tolerance = suggested_seam_tolerance(pointers(patches)), size = 1e4 * tolerance;
  auto begin = std::chrono::steady_clock::now();
  const auto found = find_seams(pointers(patches), tolerance);
  const double finding = milliseconds(begin);
  begin = std::chrono::steady_clock::now();
  const auto coupling = couple_seams(pointers(patches), first_rows(patches), found->seams);
  ASSERT_TRUE(coupling);
  const double coupled = milliseconds(begin);
  begin = std::chrono::steady_clock::now();
  const auto space = ConstraintSpace::create(first_rows(patches).back(), coupling->constraints);
  ASSERT_TRUE(space) << space.error().message();
  const double eliminated = milliseconds(begin);

  const auto after =
      displaced(patches, space->feasible(0.01 * size * random_points(space->size(), 5)));
  int counts[4] = {}, whole = 0, partial = 0;
  double gap = 0, angle = 0;
  for (const SeamReport& report : coupling->reports) {
    ++counts[static_cast<int>(report.continuity)];
    whole += report.seam.kind == SeamKind::whole;
    partial += report.seam.kind == SeamKind::partial;
    if (report.continuity == SeamContinuity::none) continue;
    gap = std::max(gap, gap_change(patches, after, report.seam) / size);
    if (report.continuity >= SeamContinuity::g1 && report.deviation < 1e-12) {
      angle = std::max(angle, angle_change(patches, after, report.seam));
    }
  }
  EXPECT_LT(gap, 1e-12);
  EXPECT_LT(angle, 1e-6);
  std::printf(
      "%-42s %3zu surfaces, %3d seams (%d partial, %zu poles): none %d, C0 %d, G1 %d; found %.1f "
      "ms, coupled %.1f ms, eliminated %.1f ms; gap %.1e, angle %.1e\n",
      GetParam().c_str(), patches.size(), whole, partial, found->collapsed.size(), counts[0],
      counts[1], counts[2], finding, coupled, eliminated, gap, angle);
}

INSTANTIATE_TEST_SUITE_P(Files, SeamFiles, ::testing::ValuesIn(step_files()), file_test_name);

}  // namespace
}  // namespace knead
