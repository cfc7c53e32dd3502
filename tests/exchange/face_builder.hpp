#pragma once

#include <array>
#include <sstream>
#include <string>
#include <vector>

#include "exchange/support.hpp"

namespace knead::testing {

/// Writes faces record by record; entities are named from #100 on.
class FaceBuilder {
 public:
  int entity(const std::string& record) {
    text_ << "#" << next_ << "=" << record << ";\n";
    return next_++;
  }
  static std::string ref(int id) { return "#" + std::to_string(id); }
  static std::string real(double x) {
    std::ostringstream text;
    text.precision(17);
    text << std::uppercase << std::scientific << x;  // as Part 21 has it
    return text.str();
  }
  int point(double x, double y, double z) {
    return entity("CARTESIAN_POINT('',(" + real(x) + "," + real(y) + "," + real(z) + "))");
  }
  int direction(double x, double y, double z) {
    return entity("DIRECTION('',(" + real(x) + "," + real(y) + "," + real(z) + "))");
  }
  /// Axis along z, reference direction along x.
  int frame(double x = 0, double y = 0, double z = 0) {
    return entity("AXIS2_PLACEMENT_3D('',#" + std::to_string(point(x, y, z)) + ",$,$)");
  }
  int vertex(double x, double y, double z) {
    return entity("VERTEX_POINT('',#" + std::to_string(point(x, y, z)) + ")");
  }
  int line(int from, int to, std::array<double, 3> at, std::array<double, 3> way) {
    const int p = point(at[0], at[1], at[2]);
    const int vector =
        entity("VECTOR('',#" + std::to_string(direction(way[0], way[1], way[2])) + ",1.)");
    return edge(from, to, "LINE('',#" + std::to_string(p) + ",#" + std::to_string(vector) + ")");
  }
  int edge(int from, int to, const std::string& curve, bool same_sense = true) {
    const int geometry = entity(curve);
    return entity("EDGE_CURVE('',#" + std::to_string(from) + ",#" + std::to_string(to) + ",#" +
                  std::to_string(geometry) + (same_sense ? ",.T.)" : ",.F.)"));
  }
  /// A circle round the z axis that begins and ends on the x axis.
  int circle(double radius, double z, double x = 0, double y = 0) {
    const int v = vertex(x + radius, y, z);
    return edge(v, v, "CIRCLE('',#" + std::to_string(frame(x, y, z)) + "," + real(radius) + ")");
  }
  /// Edges in their order; against its own direction where the number is negative.
  int bound(const std::vector<int>& edges, bool orientation = true) {
    std::string list;
    for (const int e : edges) {
      const int oriented = entity("ORIENTED_EDGE('',*,*,#" + std::to_string(std::abs(e)) +
                                  (e > 0 ? ",.T.)" : ",.F.)"));
      list += (list.empty() ? "#" : ",#") + std::to_string(oriented);
    }
    const int loop = entity("EDGE_LOOP('',(" + list + "))");
    return entity("FACE_BOUND('',#" + std::to_string(loop) + (orientation ? ",.T.)" : ",.F.)"));
  }
  int vertex_bound(double x, double y, double z) {
    const int loop = entity("VERTEX_LOOP('',#" + std::to_string(vertex(x, y, z)) + ")");
    return entity("FACE_BOUND('',#" + std::to_string(loop) + ",.T.)");
  }
  int polygon_bound(const std::vector<std::array<double, 3>>& corners) {
    std::string list;
    for (const auto& c : corners)
      list += (list.empty() ? "#" : ",#") + std::to_string(point(c[0], c[1], c[2]));
    const int loop = entity("POLY_LOOP('',(" + list + "))");
    return entity("FACE_OUTER_BOUND('',#" + std::to_string(loop) + ",.T.)");
  }
  int face(int surface, const std::vector<int>& bounds, bool same_sense = true) {
    return entity("ADVANCED_FACE('',(" + list_of(bounds) + "),#" + std::to_string(surface) +
                  (same_sense ? ",.T.)" : ",.F.)"));
  }
  static std::string list_of(const std::vector<int>& ids) {
    std::string list;
    for (const int id : ids) list += (list.empty() ? "#" : ",#") + std::to_string(id);
    return list;
  }

  [[nodiscard]] std::string text() const { return text_.str(); }
  [[nodiscard]] step::File file() const { return parse_or_die(step_text(text())); }

 private:
  std::ostringstream text_;
  int next_ = 100;
};

/// A unit square, the surface #10.
inline const std::string square = unit_square_points() + bilinear_patch();

/// The faces on it.
inline step::File on_square(const FaceBuilder& builder) {
  return parse_or_die(step_text(square + builder.text()));
}

}  // namespace knead::testing
