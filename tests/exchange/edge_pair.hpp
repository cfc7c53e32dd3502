#pragma once

#include <string>
#include <vector>

#include "exchange/step/file.hpp"
#include "knead/brep/edge_measures.hpp"
#include "support/made_step.hpp"

namespace knead::testing {

/// Two faces on both sides of the edge from (0, 0, 0) to (0, 1, 0), the first over x from −1 to 0,
/// the second over x from 0 to 1, with their normals up.
class Pair {
 public:
  StepBuilder builder;
  std::string edge;

  /// Of the edge and of its outer ones. `against`: the record of the edge runs against its line,
  /// and both against the first face.
  brep::ModelMeasures measures(int first, int second, std::array<bool, 2> senses = {true, true},
                               bool against = false, const brep::EdgeTolerances& tolerances = {}) {
    StepBuilder& b = builder;
    const int s = b.vertex(0, 0, 0), e = b.vertex(0, 1, 0);
    int middle = 0;
    if (against) {
      const int back = b.entity("VECTOR('',#" + std::to_string(b.direction(0, 1, 0)) + ",3.)");
      middle = b.edge(
          e, s,
          "LINE('',#" + std::to_string(b.point(0, 0.25, 0)) + ",#" + std::to_string(back) + ")",
          false);
    } else {
      middle = b.line(s, e, {0, 0, 0}, {0, 1, 0});
    }
    const int way = against ? -1 : 1;
    const auto rest = [&](double x) {
      const int p = b.vertex(x, 0, 0), q = b.vertex(x, 1, 0);
      return std::vector<int>{b.straight_edge(s, p, {0, 0, 0}, {x, 0, 0}),
                              b.straight_edge(p, q, {x, 0, 0}, {x, 1, 0}),
                              b.straight_edge(q, e, {x, 1, 0}, {0, 1, 0})};
    };
    const auto left = rest(-1), right_side = rest(1);
    // Bounds run about the normal of the face, of which the surface's may be the opposite.
    const int a = b.face(first, {b.bound({way * middle, -left[2], -left[1], -left[0]})}, senses[0]);
    const int c = b.face(
        second, {b.bound({right_side[0], right_side[1], right_side[2], -way * middle})}, senses[1]);
    b.entity("OPEN_SHELL('',(#" + std::to_string(a) + ",#" + std::to_string(c) + "))");
    edge = "#" + std::to_string(middle);
    const auto file = b.file();
    const auto measured = brep::measure_edges(file.model(), tolerances);
    EXPECT_TRUE(measured) << measured.error().message();
    return *measured;
  }
  brep::EdgeMeasures between(int first, int second, std::array<bool, 2> senses = {true, true},
                             bool against = false) {
    for (brep::EdgeMeasures& m : measures(first, second, senses, against).edges) {
      if (m.id == edge) return m;
    }
    ADD_FAILURE() << "the edge is missing";
    return {};
  }
  int flat() { return builder.plane({-0.5, 0, 0}, {0, 0, 1}, {1, 0, 0}); }
  /// About an axis along y, tangent to the plane z = 0 in the edge.
  int cylinder(double radius, bool below = true) {
    return builder.entity(
        "CYLINDRICAL_SURFACE('',#" +
        std::to_string(builder.placement({0, 7, below ? -radius : radius}, {0, 1, 0}, {0, 0, 1})) +
        "," + StepBuilder::real(radius) + ")");
  }
};

}  // namespace knead::testing
