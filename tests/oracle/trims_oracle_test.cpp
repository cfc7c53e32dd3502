// Faces of real solids are pressed in their visible middle, and Open CASCADE measures whether their
// neighbours still fit.

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numbers>

#include "knead/brep/face_edges.hpp"
#include "knead/exchange/format.hpp"
#include "knead/hold/constraints.hpp"
#include "knead/session/command_json.hpp"
#include "knead/spline/evaluate.hpp"
#include "oracle/occt_gaps.hpp"
#include "oracle/press.hpp"
#include "oracle/step_oracle.hpp"
#include "session/session_state.hpp"
#include "support/long_run.hpp"

namespace knead::oracle {
namespace {

constexpr double closed = 1e-3;  // mm: an edge that is no farther from its faces counts as closed
constexpr double same_angle = 1e-3;  // degrees
constexpr std::size_t most_faces = 6;
// Radians, at knot lines that were smooth.
constexpr double most_hinge = 0.05 * std::numbers::pi / 180;

/// Up to six trimmed surfaces, small nets and large.
std::vector<const brep::SplineSurface*> chosen(const brep::Model& file) {
  std::vector<const brep::SplineSurface*> trimmed;
  for (const auto& s : file.surfaces) {
    if (s.trimmed) trimmed.push_back(&s);
  }
  std::ranges::stable_sort(trimmed, {},
                           [](const brep::SplineSurface* s) { return s->surface.size(); });
  if (trimmed.size() <= most_faces) return trimmed;
  std::vector<const brep::SplineSurface*> result;
  for (std::size_t k = 0; k < most_faces; ++k) {
    result.push_back(trimmed[k * (trimmed.size() - 1) / (most_faces - 1)]);
  }
  return result;
}

/// The largest angle between the normals of both sides of a knot line, at lines that were smooth
/// before.
double hinge(const Surface& before, const Surface& after) {
  ConstraintList ignored(after.size());
  const auto was = keep_smooth(before, {}, ignored), is = keep_smooth(after, {}, ignored);
  EXPECT_TRUE(was && is);
  double largest = 0;
  for (std::size_t k = 0; was && is && k < is->size(); ++k) {
    if ((*was)[k].state == SmoothLine::State::coupled ||
        (*was)[k].state == SmoothLine::State::sampled) {
      largest = std::max(largest, (*is)[k].angle);
    }
  }
  return largest;
}

/// Records of `before` that are not in `after`, but for the surface itself and control points.
std::vector<std::string> lost_records(const std::string& before, const std::string& after,
                                      const std::string& surface) {
  const auto old_records = records_of(before), new_records = records_of(after);
  std::vector<std::string> lost;
  for (const std::string& record : old_records) {
    if (new_records.contains(record) || record.find("CARTESIAN_POINT") != std::string::npos)
      continue;
    const auto name = record.find_first_not_of(" \r\n");
    if (name != std::string::npos && record.compare(name, surface.size(), surface) == 0 &&
        !std::isdigit(static_cast<unsigned char>(record[name + surface.size()]))) {
      continue;
    }
    lost.push_back(record);
  }
  return lost;
}

/// A row of the table in docs/evidence/trims.md, where its file is named.
void write_row(const std::string& row) {
  std::cout << row << "\n";
  if (const char* path = std::getenv("KNEAD_TRIMS_TABLE"))
    std::ofstream(path, std::ios::app) << row << "\n";
}

class PressedFace : public StepOracle {
 protected:
  void press_all(const std::string& mode);
};

void PressedFace::press_all(const std::string& mode) {
  const auto before = OcctFaces::read(path_);
  ASSERT_TRUE(before);
  if (GetParam() == "linkrods.step" && !testing::long_run())
    GTEST_SKIP() << "with KNEAD_LONG=1";  // its nets are large
  testing::Sample sample(3);
  for (const brep::SplineSurface* s : chosen(file_->model())) {
    if (!sample.next()) continue;
    SCOPED_TRACE(s->id + " " + mode);
    const auto pressed = press(file_->model(), *s, mode);
    ASSERT_TRUE(pressed) << pressed.error().message();
    Session session(Document::from(*open_source(file_->bytes(), file_->name())));
    const auto bytes = carried_out(session, pressed->script);
    ASSERT_TRUE(bytes) << bytes.error().message();
    const auto path = directory_ / GetParam();
    ASSERT_TRUE(write_file_atomically(path, *bytes));
    const auto after = OcctFaces::read(path);
    ASSERT_TRUE(after);

    EXPECT_EQ(before->topology(), after->topology());
    EXPECT_LE(after->bad_faces(), before->bad_faces());
    EXPECT_LE(after->bad_edges(), before->bad_edges());
    for (const std::string& record : lost_records(file_->bytes(), *bytes, s->id))
      ADD_FAILURE() << record << " is lost";

    const auto edges_before = before->edges(s->id, *before),
               edges_after = before->edges(s->id, *after);
    ASSERT_EQ(edges_before.size(), edges_after.size());
    double gap_before = 0, gap = 0, turn = 0;
    int smooth = 0;
    for (std::size_t k = 0; k < edges_after.size(); ++k) {
      EXPECT_LE(edges_after[k].gap,
                std::max({closed, edges_before[k].tolerance, edges_before[k].gap}))
          << "edge " << k;
      gap_before = std::max(gap_before, edges_before[k].gap);
      gap = std::max(gap, edges_after[k].gap);
      if (mode == "tangent") {
        EXPECT_LE(edges_after[k].turn, same_angle) << "edge " << k;
      }
      turn = std::max(turn, edges_after[k].turn);
      smooth += edges_after[k].smooth ? 1 : 0;
    }
    const auto moved = before->moved(s->id, *after);
    EXPECT_FALSE(moved.folded);
    const auto& now = session.state().surfaces[static_cast<std::size_t>(*session.state().selected)];
    const auto there = evaluate_point<2>(*now.current, pressed->at);
    ASSERT_TRUE(there);
    const double reached = (*there - pressed->place).norm() / pressed->depth;
    EXPECT_GE(reached, 0.985) << "of the depth that was asked for";
    EXPECT_LE(reached, 1.06) << "of the depth that was asked for";
    EXPECT_LE(hinge(*now.opened, *now.current), most_hinge);
    const auto [m, n] = s->surface.net();
    const auto [m2, n2] = now.current->net();
    char row[400];
    std::snprintf(
        row, sizeof row,
        "| %s | %s | %s | %zu (%d smooth) | %d × %d | %d × %d | %.0f %% | %.2g | %.2g | %.1g |",
        GetParam().c_str(), s->id.c_str(), mode.c_str(), edges_after.size(), smooth, m, n, m2, n2,
        100 * reached, gap_before, gap, turn);
    write_row(row);
  }
}

TEST_P(PressedFace, StaysWithItsNeighboursWhereItsEdgesAreHeld) { press_all("position"); }

TEST_P(PressedFace, KeepsItsTangentPlanesToo) { press_all("tangent"); }

INSTANTIATE_TEST_SUITE_P(Files, PressedFace, ::testing::ValuesIn(testing::step_files()),
                         testing::file_test_name);

}  // namespace
}  // namespace knead::oracle
