// Pairs of faces that share an edge are pressed on it, the edge being free, and Open CASCADE measures whether the solid
// is still closed.

#include <cmath>

#include "knead/exchange/format.hpp"

#include "oracle/occt_shells.hpp"
#include "oracle/pressed_edges.hpp"

namespace knead::oracle {
namespace {

/// Files with smooth edges between B-spline faces, and with sharp ones that are not right angles.
std::vector<fs::path> few_files() {
  std::vector<fs::path> result;
  for (const fs::path& file : all_files()) {
    const auto name = file.filename();
    if (name == "NIST_MBE_PMI_5.stp" || name == "as1-oc-214.stp") result.push_back(file);
  }
  return result;
}

class PressedPair : public StepOracle {};

TEST_P(PressedPair, StaysClosedAlongTheEdgeThatFollows) {
  for (const Pair& pair : pairs_of(*file_)) move(GetParam(), *file_, pair, Motion::press, directory_, 0);
}

class StrokedPair : public StepOracle {};

TEST_P(StrokedPair, StaysClosedUnderStrokes) {
  for (const Pair& pair : pairs_of(*file_)) {
    for (const Motion motion : {Motion::groove, Motion::grab}) {
      move(GetParam(), *file_, pair, motion, directory_, 0);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Files, StrokedPair, ::testing::ValuesIn(few_files()), test_name);

INSTANTIATE_TEST_SUITE_P(Files, PressedPair, ::testing::ValuesIn(all_files()), test_name);

class PressedIgesPair : public ::testing::TestWithParam<fs::path> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(PressedIgesPair);

TEST_P(PressedIgesPair, StaysClosedAlongTheEdgeThatFollows) {
  const auto source = open_source(*read_file(GetParam()), GetParam().string());
  ASSERT_TRUE(source) << source.error().message();
  const step::File& file = *(*source)->step_file();
  const auto directory = fs::temp_directory_path() / ("knead-iges-" + std::to_string(getpid()));
  fs::create_directories(directory);
  for (const Pair& pair : pairs_of(file)) move(GetParam(), file, pair, Motion::press, directory, 0);
  fs::remove_all(directory);
}

INSTANTIATE_TEST_SUITE_P(Files, PressedIgesPair, ::testing::ValuesIn(testing::iges_files_in(testing::collection())),
                         test_name);

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
  auto pairs = corner ? std::vector<Pair>() : pairs_of(*file);
  if (corner || GetParam() == "strips") pairs.push_back(chain_of(*file, Point(50, 50, height)));
  ASSERT_FALSE(pairs.empty());
  for (const Pair& pair : pairs) move(path, *file, pair, Motion::press, directory / "after", 0.5);
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
  for (const Pair& pair : pairs_of(*file)) {
    for (const Motion motion : {Motion::groove, Motion::grab}) {
      move(path, *file, pair, motion, directory / "after", motion == Motion::grab ? 0.3 : 0.5);
    }
  }
  fs::remove_all(directory);
}

INSTANTIATE_TEST_SUITE_P(Shells, PressedShell, ::testing::ValuesIn(occt_shell_names()),
                         [](const auto& instance) { return instance.param; });

}  // namespace
}  // namespace knead::oracle
