// Pairs of faces that share an edge are pressed on it, the edge being free, and Open CASCADE
// measures whether the solid is still closed.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>

#include "knead/exchange/format.hpp"

#include "oracle/brep_files.hpp"
#include "oracle/occt_file.hpp"
#include "oracle/occt_shells.hpp"
#include "oracle/press.hpp"
#include "oracle/pressed_edges.hpp"
#include "support/long_run.hpp"

namespace knead::oracle {
namespace {

/// Files with smooth edges between B-spline faces, and with sharp ones that are not right angles.
std::vector<std::string> few_files() {
  return testing::with_own(testing::own_step(), std::array{"NIST_MBE_PMI_5.stp", "as1-oc-214.stp"});
}

class PressedPair : public StepOracle {};

TEST_P(PressedPair, StaysClosedAlongTheEdgeThatFollows) {
  // Its nets are the largest, and its edges are pressed with its planes converted, too.
  if (GetParam() == "linkrods.step" && !testing::long_run()) GTEST_SKIP() << "with KNEAD_LONG=1";
  for (const Pair& pair : each_kind(file_->model(), pairs_of(file_->model()))) {
    move(path_, file_->model(), pair, Motion::press, directory_, 0);
  }
}

class StrokedPair : public StepOracle {};

TEST_P(StrokedPair, StaysClosedUnderStrokes) {
  testing::Sample sample(3);  // of two motions: both have their turn
  for (const Pair& pair : each_kind(file_->model(), pairs_of(file_->model()))) {
    for (const Motion motion : {Motion::groove, Motion::grab}) {
      if (sample.next()) move(path_, file_->model(), pair, motion, directory_, 0);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Files, StrokedPair, ::testing::ValuesIn(few_files()),
                         testing::file_test_name);

INSTANTIATE_TEST_SUITE_P(Files, PressedPair, ::testing::ValuesIn(testing::step_files()),
                         testing::file_test_name);

class PressedIgesPair : public testing::FileTest {};

TEST_P(PressedIgesPair, StaysClosedAlongTheEdgeThatFollows) {
  const auto source = open_source(*read_file(path_), path_.string());
  ASSERT_TRUE(source) << source.error().message();
  const brep::Model& file = *(*source)->model();
  const auto directory = fs::temp_directory_path() / ("knead-iges-" + std::to_string(getpid()));
  fs::create_directories(directory);
  for (const Pair& pair : each_kind(file, pairs_of(file)))
    move(path_, file, pair, Motion::press, directory, 0);
  fs::remove_all(directory);
}

INSTANTIATE_TEST_SUITE_P(Files, PressedIgesPair, ::testing::ValuesIn(testing::iges_files()),
                         testing::file_test_name);

class PressedShell : public ::testing::TestWithParam<std::string> {};

TEST_P(PressedShell, StaysClosedAlongTheEdgesThatFollow) {
  const auto directory = fs::temp_directory_path() / ("knead-shells-" + std::to_string(getpid()));
  fs::create_directories(directory / "after");
  const auto path = directory / (GetParam() + ".step");
  ASSERT_TRUE(occt_write_shell(GetParam(), path));
  const auto file = step::File::read(path);
  ASSERT_TRUE(file) << file.error().message();
  const double height = GetParam() == "corner" ? 4 * std::sin(50.0 / 30) * std::cos(50.0 / 40) : 0;
  const bool corner = GetParam().ends_with("corner");
  auto pairs = corner ? std::vector<Pair>() : pairs_of(file->model());
  if (corner || GetParam() == "strips")
    pairs.push_back(chain_of(file->model(), Point(50, 50, height)));
  ASSERT_FALSE(pairs.empty());
  for (const Pair& pair : pairs)
    move(path, file->model(), pair, Motion::press, directory / "after", 0.5);
  fs::remove_all(directory);
}

TEST_P(PressedShell, StaysClosedUnderStrokes) {
  if (GetParam().ends_with("corner")) GTEST_SKIP() << "pairs only";
  const auto directory = fs::temp_directory_path() / ("knead-shells-" + std::to_string(getpid()));
  fs::create_directories(directory / "after");
  const auto path = directory / (GetParam() + ".step");
  ASSERT_TRUE(occt_write_shell(GetParam(), path));
  const auto file = step::File::read(path);
  ASSERT_TRUE(file) << file.error().message();
  for (const Pair& pair : pairs_of(file->model())) {
    for (const Motion motion : {Motion::groove, Motion::grab}) {
      move(path, file->model(), pair, motion, directory / "after",
           motion == Motion::grab ? 0.3 : 0.5);
    }
  }
  fs::remove_all(directory);
}

/// Presses the edges of a .brep file; Open CASCADE finds the same topology, no more faults, and no
/// edge farther from its faces, at equal parameters, than before or than 0.001.
void press_brep(const fs::path& path, const std::vector<Pair>& pairs) {
  const auto source = *open_source(*read_file(path), path.string());
  const auto before = occt_read_file(path);
  ASSERT_TRUE(before);
  const fs::path written =
      fs::temp_directory_path() / ("knead-pressed-" + std::to_string(getpid()) + ".brep");
  for (const Pair& pair : pairs) {
    SCOPED_TRACE(pair.edges.front());
    Session session(Document::from(source));
    const auto bytes = carried_out(session, pair.script(*source->model(), Motion::press));
    if (!bytes) {  // a motion is refused that would fold a face, or part the faces
      EXPECT_EQ(bytes.error().kind, ErrorKind::numerical) << bytes.error().message();
      std::cout << fmt::format("| {} | {} | refused: {} | | | |\n", path.filename().string(),
                               fmt::join(pair.edges, ", "), bytes.error().what);
      continue;
    }
    const std::string was = *read_file(path);
    EXPECT_NE(*bytes, was);
    // Places and curves in parameters stay; so do polygons and triangles.
    for (const auto& [from, to] :
         {std::pair("CASCADE", "\nCurves "), std::pair("\nPolygon3D", "\nSurfaces ")}) {
      const auto part = [&](const std::string& all) {
        const std::size_t begin = all.find(from);
        return all.substr(begin, all.find(to) - begin);
      };
      EXPECT_EQ(part(*bytes), part(was));
    }
    ASSERT_TRUE(write_file_atomically(written, *bytes));
    const auto after = occt_read_file(written);
    ASSERT_TRUE(after);
    EXPECT_EQ(after->topology, before->topology);
    EXPECT_LE(after->bad_faces, before->bad_faces);
    ASSERT_EQ(after->gaps.size(), before->gaps.size());
    double gap = 0, gap_before = 0;
    for (std::size_t k = 0; k < after->gaps.size(); ++k) {
      EXPECT_LE(after->gaps[k], std::max(1e-3, before->gaps[k])) << "edge " << k;
      gap = std::max(gap, after->gaps[k]);
      gap_before = std::max(gap_before, before->gaps[k]);
    }
    double went = 0;
    for (std::size_t k = 0; k < session.state().surfaces.size(); ++k) {
      went = std::max(went, session.largest_displacement(static_cast<int>(k)));
    }
    EXPECT_GE(went, 0.5 * pair.depth);
    std::cout << fmt::format("| {} | {} | {:.0f} % | {:.2g} | {:.2g} | {} |\n",
                             path.filename().string(), fmt::join(pair.edges, ", "),
                             100 * went / pair.depth, gap_before, gap, after->bad_faces);
  }
  fs::remove(written);
}

TEST_P(PressedShell, StaysClosedAsABrepFile) {
  const auto directory = fs::temp_directory_path() / ("knead-brep-" + std::to_string(getpid()));
  fs::create_directories(directory);
  const auto path = directory / (GetParam() + ".brep");
  ASSERT_TRUE(occt_write_shell(GetParam(), path));
  const auto source = open_source(*read_file(path), path.string());
  ASSERT_TRUE(source) << source.error().message();
  const brep::Model& file = *(*source)->model();
  const double height = GetParam() == "corner" ? 4 * std::sin(50.0 / 30) * std::cos(50.0 / 40) : 0;
  const bool corner = GetParam().ends_with("corner");
  const auto pairs = corner ? std::vector{chain_of(file, Point(50, 50, height))} : pairs_of(file);
  ASSERT_FALSE(pairs.empty());
  press_brep(path, pairs);
  fs::remove_all(directory);
}

class PressedBrepPair : public testing::FileTest {};

TEST_P(PressedBrepPair, StaysClosedAlongTheEdgeThatFollows) {
  const auto source = open_source(*read_file(path_), path_.string());
  ASSERT_TRUE(source) << source.error().message();
  press_brep(path_, pairs_of(*(*source)->model()));
}

INSTANTIATE_TEST_SUITE_P(Files, PressedBrepPair, ::testing::ValuesIn(brep_files()),
                         testing::file_test_name);

INSTANTIATE_TEST_SUITE_P(Shells, PressedShell, ::testing::ValuesIn(occt_shell_names()),
                         [](const auto& instance) { return instance.param; });

}  // namespace
}  // namespace knead::oracle
