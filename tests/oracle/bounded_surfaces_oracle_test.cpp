// Surfaces that are bounded by curves alone, pressed on the edge at which they meet: Open CASCADE
// finds the same faces, and no edge farther from its faces than before.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "knead/exchange/file_io.hpp"
#include "knead/exchange/format.hpp"
#include "oracle/occt_file.hpp"
#include "session/running.hpp"
#include "support/bounded_plates.hpp"

namespace knead::oracle {
namespace {

namespace fs = std::filesystem;

class BoundedSheetsInOcct : public ::testing::TestWithParam<testing::MadeSheets> {};

TEST_P(BoundedSheetsInOcct, StayClosed) {
  const auto sheets = GetParam().make();
  const double scale = sheets.scale, millimetres = scale == 5 ? 1000 : 1;
  const auto source = *open_source(sheets.text, "sheets");
  const brep::Model& model = *source->model();
  const auto west = brep::edges_around(model.faces[0]), east = brep::edges_around(model.faces[1]);
  const auto shared = std::ranges::find_if(
      west, [&](brep::Index e) { return std::ranges::find(east, e) != east.end(); });
  ASSERT_NE(shared, west.end());
  Session session(Document::from(source));
  const auto status = testing::run(
      session, R"({"do":"select","surfaces":[")" + sheets.surfaces[0] + R"(",")" +
                   sheets.surfaces[1] + R"("]},{"do":"edge","which":")" + model.edges[*shared].id +
                   R"(","hold":"follow"},)" +
                   fmt::format(R"({{"do":"material","alpha":[1,0,1],"beta":[0.003,0.003,0.003]}},
      {{"do":"tool","name":"ball","radius":{},"rigid":true,"position":[{},{},{}]}},
      {{"do":"evolve","mode":"static"}})",
                               0.4 * scale, 2 * scale, scale, scale * (testing::roof(2, 1) + 0.3)));
  ASSERT_TRUE(status) << status.error().message();
  const auto bytes = session.save();
  ASSERT_TRUE(bytes) << bytes.error().message();
  const fs::path directory =
      fs::temp_directory_path() / ("knead-bounded-" + std::to_string(getpid()));
  fs::create_directories(directory);
  const fs::path before = directory / ("before" + GetParam().ending),
                 after = directory / ("after" + GetParam().ending);
  ASSERT_TRUE(write_file_atomically(before, sheets.text));
  ASSERT_TRUE(write_file_atomically(after, *bytes));
  const auto was = occt_read_file(before), now = occt_read_file(after);
  ASSERT_TRUE(was && now);
  EXPECT_EQ(was->topology.at("faces"), 2);
  EXPECT_EQ(now->topology, was->topology);
  EXPECT_LE(now->bad_faces, was->bad_faces);
  const double size = 4.5 * scale * millimetres;
  ASSERT_EQ(now->gaps.size(), was->gaps.size());
  double largest = 0;
  for (std::size_t k = 0; k < now->gaps.size(); ++k) {
    EXPECT_LE(now->gaps[k], was->gaps[k] + 1e-6 * size) << "edge " << k;
    largest = std::max(largest, now->gaps[k]);
  }
  const auto apart = occt_partings(before), later = occt_partings(after);
  ASSERT_EQ(later.size(), apart.size());
  int met = 0;
  for (std::size_t k = 0; k < apart.size(); ++k) {
    if (apart[k] > 1e-6 * size) continue;
    ++met;
    EXPECT_LE(later[k], apart[k] + 1e-6 * size) << "edge " << k;
    largest = std::max(largest, later[k]);
  }
  EXPECT_EQ(met, 2) << "the edge of either face at which they meet";
  std::cout << fmt::format("| {} | {:.2g} | {:.2g} |\n", GetParam().name,
                           *std::ranges::max_element(was->gaps) / size, largest / size);
  fs::remove_all(directory);
}

INSTANTIATE_TEST_SUITE_P(Kinds, BoundedSheetsInOcct, ::testing::ValuesIn(testing::all_sheets()),
                         [](const auto& instance) { return instance.param.name; });

}  // namespace
}  // namespace knead::oracle
