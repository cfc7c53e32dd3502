// Surfaces of real IGES and .brep files are pressed in their visible middle, and Open CASCADE reads
// the result.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "brep/tessellation/model_mesh.hpp"
#include "exchange/mesh_measures.hpp"
#include "exchange/support.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/exchange/format.hpp"
#include "knead/session/command_json.hpp"
#include "oracle/brep_files.hpp"
#include "oracle/occt_file.hpp"
#include "oracle/press.hpp"
#include "session/session_state.hpp"
#include "support/long_run.hpp"
#include "support/own_files.hpp"

namespace knead::oracle {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_pressed = 4;
constexpr double closed_gap = 1e-3;  // mm

/// A dent in a surface without faces, in lengths of its own.
Press anywhere(const std::string& id) {
  Press result;
  result.script =
      R"({"knead":2,"commands":[{"do":"select","surface":")" + id +
      R"("},{"do":"hold","mode":"open"},{"do":"hold","rows":1},)"
      R"({"do":"tool","radius":0.1,"relative":true,"at":[0.4,0.45]},)"
      R"({"do":"move","by":[0.03,0.04,0.05],"relative":true},{"do":"step","lambda":10}]})";
  return result;
}

class FormatOracle : public testing::FileTest {
 protected:
  void SetUp() override {
    KNEAD_NEEDS(path_);
    auto source = open_source(*read_file(path_), path_.string());
    ASSERT_TRUE(source) << source.error().message();
    source_ = *std::move(source);
    before_ = occt_read_file(path_);
    ASSERT_TRUE(before_);
  }

  /// Up to four surfaces with faces, small nets and large; of a file without faces, any.
  std::vector<const brep::SplineSurface*> chosen() const {
    std::vector<const brep::SplineSurface*> all;
    for (const brep::SplineSurface& s : source_->model()->surfaces) all.push_back(&s);
    std::ranges::stable_sort(all, {},
                             [](const brep::SplineSurface* s) { return s->surface.size(); });
    if (all.size() <= most_pressed) return all;
    std::vector<const brep::SplineSurface*> result;
    for (std::size_t k = 0; k < most_pressed; ++k)
      result.push_back(all[k * (all.size() - 1) / (most_pressed - 1)]);
    return result;
  }

  std::shared_ptr<const Source> source_;
  std::optional<OcctFile> before_;
};

TEST_P(FormatOracle, FacesHaveTheAreaThatOpenCascadeFinds) {
  if (GetParam() == "terrain.brep" && !testing::long_run())
    GTEST_SKIP() << "with KNEAD_LONG=1";  // its net is large
  const auto model = model_faces(*source_->model());
  ASSERT_TRUE(model) << model.error().message();
  double area = 0;
  for (const FaceMesh& mesh : model->faces) area += testing::area_of(mesh);
  const double scale = source_->surfaces()[0].unit == "inch" ? 25.4
                       : source_->surfaces()[0].unit == "m"  ? 1000
                                                             : 1;
  if (model->skipped.empty()) {
    EXPECT_NEAR(area * scale * scale, before_->area, 0.005 * before_->area);
  } else {
    // A sphere without its pole.
    EXPECT_EQ(GetParam(), "Pump_TopCover.brep");
    EXPECT_EQ(model->skipped.size(), 1U);
    EXPECT_LT(area * scale * scale, before_->area);
  }
}

TEST_P(FormatOracle, APressLeavesTopologyAndGapsAsTheyWere) {
  // Its nets are the largest by far; what is written is of the same kinds as in the other .brep
  // files.
  if (GetParam() == "terrain.brep" && !testing::long_run()) GTEST_SKIP() << "with KNEAD_LONG=1";
  const fs::path out = fs::temp_directory_path() /
                       ("knead-format-" + std::to_string(getpid()) + path_.extension().string());
  for (const brep::SplineSurface* s : chosen()) {
    SCOPED_TRACE(s->id);
    const auto pressed =
        s->faces > 0 ? press(*source_->model(), *s, "position") : Expected<Press>(anywhere(s->id));
    ASSERT_TRUE(pressed) << pressed.error().message();
    Session session(Document::from(source_));
    const auto bytes = carried_out(session, pressed->script);
    if (GetParam() ==
        "curvesToSurfaceContinuous.brep") {  // its shortest span is 5.5e-12 of its domain
      ASSERT_FALSE(bytes);
      EXPECT_EQ(bytes.error().kind, ErrorKind::numerical) << bytes.error().message();
      continue;
    }
    ASSERT_TRUE(bytes) << bytes.error().message();
    ASSERT_TRUE(write_file_atomically(out, *bytes));
    const auto after = occt_read_file(out);
    ASSERT_TRUE(after);
    EXPECT_EQ(after->topology, before_->topology);
    EXPECT_LE(after->bad_faces, before_->bad_faces);
    ASSERT_EQ(after->gaps.size(), before_->gaps.size());
    double worst = 0;
    for (std::size_t k = 0; k < after->gaps.size(); ++k) {
      EXPECT_LE(after->gaps[k], std::max(closed_gap, 1.01 * before_->gaps[k])) << "edge " << k;
      worst = std::max(worst, after->gaps[k] - before_->gaps[k]);
    }
    if (s->faces == 0) continue;
    const auto& now = session.state().surfaces[static_cast<std::size_t>(*session.state().selected)];
    const auto there = evaluate_point<2>(*now.current, pressed->at);
    ASSERT_TRUE(there);
    const double reached = (*there - pressed->place).norm() / pressed->depth;
    EXPECT_GE(reached, 0.9) << "of the depth that was asked for";
    const auto net = s->surface.net(), wider = now.current->net();
    std::printf("| %s | %s | %d x %d | %d x %d | %.0f %% | %.2g |\n", GetParam().c_str(),
                s->id.c_str(), net[0], net[1], wider[0], wider[1], 100 * reached, worst);
  }
  fs::remove(out);
}

INSTANTIATE_TEST_SUITE_P(Files, FormatOracle,
                         ::testing::ValuesIn(testing::with_own(testing::iges_files(),
                                                               brep_files())),
                         testing::file_test_name);

}  // namespace
}  // namespace knead::oracle
