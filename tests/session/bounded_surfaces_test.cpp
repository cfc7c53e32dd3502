// Surfaces that are bounded by curves alone are sculpted as faces are: edges hold, follow, and stay
// closed.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "brep/shared_edge.hpp"
#include "knead/exchange/format.hpp"
#include "session/running.hpp"
#include "support/bounded_plates.hpp"

namespace knead {
namespace {

using testing::BoundedSheets;
using testing::MadeSheets;
using testing::run;

/// The largest distance of each edge from the surfaces of its faces. Edges without a name in the
/// file have other ids in another file.
std::vector<double> gaps_of(const brep::Model& model) {
  std::vector<double> result;
  for (const brep::Edge& edge : model.edges) {
    const auto shared = SharedEdge::create(model, edge.id);
    EXPECT_TRUE(shared) << shared.error().message();
    result.push_back(shared ? shared->gap() : std::numeric_limits<double>::infinity());
  }
  return result;
}

class PressedBoundedSurfaces : public ::testing::TestWithParam<MadeSheets> {
 protected:
  void SetUp() override {
    sheets_ = GetParam().make();
    source_ = *open_source(sheets_.text, "sheets");
  }
  [[nodiscard]] double size() const { return 4.5 * sheets_.scale; }
  /// The edges that both faces have.
  [[nodiscard]] static std::vector<std::string> shared_edges(const brep::Model& model) {
    std::vector<std::string> result;
    const auto west = brep::edges_around(model.faces[0]), east = brep::edges_around(model.faces[1]);
    for (const brep::Index edge : west) {
      if (std::ranges::find(east, edge) != east.end()) result.push_back(model.edges[edge].id);
    }
    return result;
  }
  /// Presses a ball into a place of the roof, times the scale, by `depth`; returns what is saved.
  [[nodiscard]] std::string pressed(const std::string& before, double x, double y, double depth,
                                    double radius = 0.4) {
    Session session(Document::from(source_));
    const double s = sheets_.scale;
    const auto status =
        run(session,
            R"({"do":"select","surfaces":[")" + sheets_.surfaces[0] + R"(",")" +
                sheets_.surfaces[1] + R"("]},)" + before +
                fmt::format(R"({{"do":"material","alpha":[1,0,1],"beta":[0.003,0.003,0.003]}},
        {{"do":"tool","name":"ball","radius":{},"rigid":true,"position":[{},{},{}]}},
        {{"do":"evolve","mode":"static"}})",
                            s * radius, s * x, s * y, s * (testing::roof(x, y) + radius - depth)));
    EXPECT_TRUE(status) << status.error().message();
    moved_ = std::max(session.largest_displacement(0), session.largest_displacement(1));
    const auto bytes = session.save();
    EXPECT_TRUE(bytes) << bytes.error().message();
    return bytes.value_or(std::string());
  }
  /// No edge is farther from its surfaces than it was, but for 1e-6 of the size.
  void expect_closed(const std::string& bytes) const {
    const auto after = open_source(bytes, "sheets");
    ASSERT_TRUE(after) << after.error().message();
    const auto was = gaps_of(*source_->model()), now = gaps_of(*(*after)->model());
    ASSERT_EQ(now.size(), was.size());
    for (std::size_t k = 0; k < now.size(); ++k)
      EXPECT_LE(now[k], was[k] + 1e-6 * size()) << "edge " << k;
  }

  BoundedSheets sheets_;
  std::shared_ptr<const Source> source_;
  double moved_ = 0;
};

TEST_P(PressedBoundedSurfaces, KeepTheirEdges) {
  const std::string bytes = pressed("", 0.45, 1.55, 0.05, 0.3);
  EXPECT_GT(moved_, 0.04 * sheets_.scale);
  expect_closed(bytes);
}

TEST_P(PressedBoundedSurfaces, StayClosedWhereTheirEdgeFollows) {
  const std::string bytes =
      pressed(R"({"do":"edge","which":")" + shared_edges(*source_->model()).at(0) +
                  R"(","hold":"follow"},)",
              2, 1, 0.1);
  EXPECT_GT(moved_, 0.08 * sheets_.scale);
  expect_closed(bytes);
  double lowest = std::numeric_limits<double>::infinity();
  const auto after = *open_source(bytes, "sheets");
  for (const std::string& id : shared_edges(*after->model())) {
    const auto edge = SharedEdge::create(*after->model(), id);
    ASSERT_TRUE(edge);
    for (const auto& sample : edge->samples()) {
      if (std::abs(sample.point.y() - sheets_.scale) < 0.1 * sheets_.scale)
        lowest = std::min(lowest, sample.point.z());
    }
  }
  EXPECT_NEAR(lowest, sheets_.scale * (testing::roof(2, 1) - 0.1), 0.01 * sheets_.scale);
}

TEST_P(PressedBoundedSurfaces, LeadTheirOwnEdgesAlong) {
  const brep::Model& model = *source_->model();
  // Along y = 0.
  const std::string stored = model.edges[brep::edges_around(model.faces[0]).front()].id;
  const std::string bytes =
      pressed(R"({"do":"edge","which":")" + stored + R"(","hold":"follow"},)", 1, 0.1, 0.1);
  EXPECT_GT(moved_, 0.05 * sheets_.scale);
  expect_closed(bytes);
}

INSTANTIATE_TEST_SUITE_P(Kinds, PressedBoundedSurfaces, ::testing::ValuesIn(testing::all_sheets()),
                         [](const auto& instance) { return instance.param.name; });

}  // namespace
}  // namespace knead
