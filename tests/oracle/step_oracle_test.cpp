// Open CASCADE 7.6 reads what Knead writes: the same faces, and poles that differ where they were
// edited and only there.

#include <cmath>
#include <set>

#include "oracle/step_oracle.hpp"

namespace knead::oracle {
namespace {

using knead::testing::same_bits;

// Control points moved so little that a face stays a face: inside the net, so that edges and seams
// stay where they are, or, in a net without inside, one in the middle.
Points moved(const Surface& surface) {
  Points points = surface.control_points();
  const auto net = surface.net();
  const double size = 1e-4 * (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
  const bool inside = net[0] > 2 && net[1] > 2;
  for (int i = 0; i < net[0]; ++i) {
    for (int j = 0; j < net[1]; ++j) {
      const bool moves = inside ? i > 0 && i < net[0] - 1 && j > 0 && j < net[1] - 1
                                : i == net[0] / 2 && j == net[1] / 2;
      if (moves)
        points.row(i * net[1] + j) +=
            size * Eigen::RowVector3d(0.3, std::sin(i + 1.0), std::cos(j + 2.0 * i));
    }
  }
  return points;
}

void expect_same_but_poles(const OcctSurface& a, const OcctSurface& b, const std::string& id) {
  EXPECT_EQ(a.degree, b.degree) << id;
  EXPECT_EQ(a.net, b.net) << id;
  EXPECT_EQ(a.knots, b.knots) << id;
  EXPECT_EQ(a.weights, b.weights) << id;
  EXPECT_EQ(a.periodic, b.periodic) << id;
}

struct Tally {
  int exact = 0;          // edited surfaces compared as a whole, bit for bit
  int altered = 0;        // edited surfaces that Open CASCADE already alters in the file as it was
  int altered_poles = 0;  // their poles
  // Of those, the ones it holds as the file has them all the same: compared bit for bit.
  int kept_poles = 0;
  // And those it holds up to the rounding of a conversion of units: compared to 1e-14.
  int near_poles = 0;
};

// Poles of a surface that Open CASCADE alters (makes periodic, clamps, converts): where it held the
// old control point it holds the new one likewise.
void compare_altered(const OcctSurface& before, const OcctSurface& after,
                     const Surface& old_surface, const Points& wanted, const std::string& id,
                     Tally& tally) {
  ++tally.altered;
  tally.altered_poles += before.net[0] * before.net[1];
  const auto net = old_surface.net();
  const double rounding = 1e-14 * old_surface.control_points().cwiseAbs().maxCoeff();
  for (int i = 0; i < std::min(before.net[0], net[0]); ++i) {
    for (int j = 0; j < std::min(before.net[1], net[1]); ++j) {
      const Eigen::Index k = i * before.net[1] + j;
      const Eigen::Index m = i * net[1] + j;
      if (same_bits(before.poles.row(k), old_surface.control_points().row(m))) {
        ++tally.kept_poles;
        EXPECT_TRUE(same_bits(after.poles.row(k), wanted.row(m)))
            << id << " pole " << i << ", " << j;
      } else if ((before.poles.row(k) - old_surface.control_points().row(m))
                     .cwiseAbs()
                     .maxCoeff() <= rounding) {
        ++tally.near_poles;
        EXPECT_LE((after.poles.row(k) - wanted.row(m)).cwiseAbs().maxCoeff(), 2 * rounding)
            << id << " pole " << i << ", " << j;
      }
    }
  }
}

// Surfaces in `edited` (by name) hold their new control points; all others what they held.
Tally compare(const step::File& file, const OcctModel& before, const OcctModel& after,
              const std::map<std::string, Points>& edited) {
  Tally tally;
  EXPECT_EQ(before.topology, after.topology);
  EXPECT_EQ(before.faces, after.faces);
  auto entities_before = before.entities;
  auto entities_after = after.entities;
  EXPECT_GE(entities_after["StepGeom_CartesianPoint"], entities_before["StepGeom_CartesianPoint"]);
  entities_before.erase("StepGeom_CartesianPoint");
  entities_after.erase("StepGeom_CartesianPoint");
  EXPECT_EQ(entities_before, entities_after);
  for (const auto& surface : file.surfaces()) {
    const auto a = before.results.find(surface.id);
    const auto b = after.results.find(surface.id);
    EXPECT_NE(a, before.results.end()) << surface.id;
    EXPECT_NE(b, after.results.end()) << surface.id;
    if (a == before.results.end() || b == after.results.end()) continue;
    EXPECT_EQ(a->second.surfaces.size(), b->second.surfaces.size()) << surface.id;
    for (std::size_t k = 0; k < std::min(a->second.surfaces.size(), b->second.surfaces.size());
         ++k) {
      const auto& old_surface = a->second.surfaces[k];
      const auto& new_surface = b->second.surfaces[k];
      expect_same_but_poles(old_surface, new_surface, surface.id);
      const auto edit = edited.find(surface.id);
      if (edit == edited.end()) {
        EXPECT_TRUE(same_bits(old_surface.poles, new_surface.poles))
            << surface.id << " was not edited";
      } else if (old_surface.net == surface.surface.net() &&
                 same_bits(old_surface.poles, surface.surface.control_points())) {
        EXPECT_TRUE(same_bits(new_surface.poles, edit->second)) << surface.id;
        ++tally.exact;
      } else if (old_surface.net == new_surface.net) {
        compare_altered(old_surface, new_surface, surface.surface, edit->second, surface.id, tally);
      }
    }
  }
  return tally;
}

TEST_P(StepOracle, FindsTheSameFacesAndOnlyTheEditedPolesDiffer) {
  std::vector<step::Edit> edits;
  std::map<std::string, Points> edited;
  for (const auto& surface : file_->surfaces()) {
    edits.push_back({surface.id, moved(surface.surface)});
    edited.emplace(surface.id, edits.back().control_points);
  }
  const auto tally =
      compare(*file_, *before_, read_written(file_->with_control_points(edits)), edited);
  std::cout << GetParam() << ": " << tally.exact << " surfaces bit for bit";
  if (tally.altered > 0) {
    std::cout << ", " << tally.altered << " that Open CASCADE alters on reading; of their "
              << tally.altered_poles << " poles it keeps " << tally.kept_poles
              << " (compared bit for bit) and rounds " << tally.near_poles
              << " (compared to 1e-14)";
  }
  std::cout << "\n";
  EXPECT_GE(tally.exact + tally.altered, file_->surfaces().empty() ? 0 : 1);
}

TEST_P(StepOracle, OneEditedSurfaceLeavesAllOthersAlone) {
  if (file_->surfaces().empty()) GTEST_SKIP() << "no B-spline surfaces";
  const auto& surface = file_->surfaces()[file_->surfaces().size() / 2];
  const step::Edit edit{surface.id, moved(surface.surface)};
  compare(*file_, *before_, read_written(file_->with_control_points({&edit, 1})),
          {{surface.id, edit.control_points}});
}

// A face is whole where its area is that of its surface.
TEST_P(StepOracle, AgreesOnWhatIsTrimmed) {
  for (const auto& surface : file_->surfaces()) {
    const auto found = before_->results.find(surface.id);
    if (found == before_->results.end() || found->second.area_ratios.empty()) continue;
    const auto& ratios = found->second.area_ratios;
    const bool trimmed = std::any_of(ratios.begin(), ratios.end(),
                                     [](double ratio) { return std::abs(ratio - 1) > 1e-3; });
    EXPECT_EQ(surface.trimmed, trimmed)
        << surface.id << ": area " << ratios.front() << " of the whole";
  }
}

INSTANTIATE_TEST_SUITE_P(Files, StepOracle, ::testing::ValuesIn(testing::step_files()),
                         testing::file_test_name);

}  // namespace
}  // namespace knead::oracle
