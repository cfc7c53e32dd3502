#pragma once

#include <array>
#include <functional>
#include <set>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "exchange/part21/part21.hpp"
#include "exchange/step/bounded/bounded_faces.hpp"
#include "exchange/step/entity.hpp"
#include "fresh_names.hpp"
#include "knead/spline/spline.hpp"

namespace knead::step {

/// Equal to the last bit: tells 0 from -0.
[[nodiscard]] bool same_bits(const Points& a, const Points& b);
[[nodiscard]] bool same_bits(std::span<const double> a, std::span<const double> b);

/// Collects the changes in the bytes of a file that replace surfaces and the edges that moved with
/// them, and nothing else.
class Surgeon {
 public:
  explicit Surgeon(const Part21File& file) : file_(file), reader_(file), names_(file) {}

  /// Moves control points on the same net.
  /// \param refs values that refer to the control points, in their order
  [[nodiscard]] Expected<void> move_points(std::uint32_t instance,
                                           const std::vector<std::uint32_t>& refs,
                                           const Points& old_points, const Points& new_points);

  /// Replaces the net, including degrees, knots and weights (rational if it was).
  [[nodiscard]] Expected<void> replace_surface(std::uint32_t instance,
                                               const std::vector<std::uint32_t>& refs,
                                               const Surface& before, const Surface& after);

  /// Writes the record of a free curve anew, under its name and label. \param refs as for
  /// `move_points`
  [[nodiscard]] Expected<void> replace_net(std::uint32_t instance,
                                           const std::vector<std::uint32_t>& refs,
                                           const Curve& before, const Curve& after);

  /// Gives an EDGE_CURVE another curve in space; its PCURVEs stay.
  [[nodiscard]] Expected<void> replace_curve(std::uint32_t edge, const Curve& curve);

  /// Gives the segments of boundaries that are one edge another curve in space; their PCURVEs stay.
  void replace_boundary(const std::vector<BoundarySource>& sources, const Curve& curve);

  /// Moves a VERTEX_POINT.
  [[nodiscard]] Expected<void> move_vertex(std::uint32_t vertex, const Point& place);

  /// Gives a surface of another form the record of a B-spline surface, under its name and label.
  /// What describes geometry on the surface, except faces, curves and `bounded` surfaces, refers to
  /// a copy of the old record from then on.
  void become_spline(std::uint32_t instance, const Surface& surface,
                     const std::set<std::uint32_t>& bounded);
  /// Lets a face or bounded surface that lies on a part of a surface refer to the surface itself.
  void lie_on(std::uint32_t face, std::uint32_t surface);
  /// Gives a RECTANGULAR_TRIMMED_SURFACE other limits, each pair in the order that its sense has.
  void limit(std::uint32_t bounded, const std::array<Interval, 2>& limits);
  /// Lets the SURFACE_CURVEs of segments refer to a surface in place of their PCURVEs on it, and
  /// gives segments that have a PCURVE alone a SURFACE_CURVE of this curve.
  void lie_along(const BoundaryEdge& edge, std::uint32_t surface, const Curve* curve);
  /// Takes the PCURVEs on any of these surfaces from an edge.
  void drop_parameter_curves(std::uint32_t edge, const std::set<std::uint32_t>& surfaces);

  /// The bytes of the file with all changes.
  [[nodiscard]] std::string result();

 private:
  /// A point by angles, which has no coordinates to rewrite.
  [[nodiscard]] bool is_curved(std::uint32_t point) const {
    return reader_.is(point, "CYLINDRICAL_POINT") || reader_.is(point, "SPHERICAL_POINT");
  }
  // Bytes [range) become `text`; where ranges are empty the text is inserted.
  struct Change {
    ByteRange range;
    std::string text;
  };
  using Coordinates = std::array<std::uint32_t, 3>;

  [[nodiscard]] Expected<void> move(std::uint32_t point, const std::vector<Eigen::Index>& rows,
                                    const std::vector<std::uint32_t>& refs,
                                    const Points& old_points, const Points& new_points,
                                    std::string& inserted);
  [[nodiscard]] Expected<std::vector<std::string>> point_names(
      const std::vector<std::uint32_t>& refs, const Points& old_points, const Points& new_points,
      std::string& inserted);
  /// Gives a record without weights the weights and knots of `after`.
  [[nodiscard]] Expected<void> become_rational(std::uint32_t instance, const Surface& before,
                                               const Surface& after);
  [[nodiscard]] Expected<void> write_knots(std::uint32_t instance, const Surface& before,
                                           const Surface& after);
  [[nodiscard]] std::vector<Change> rewritten(const Coordinates& coordinates,
                                              const Points& old_points, Eigen::Index old_row,
                                              const Points& points, Eigen::Index row) const;
  [[nodiscard]] std::string copy_of(std::uint32_t point, const std::string& name,
                                    const std::vector<Change>& changes) const;
  /// A SURFACE_CURVE(curve in space, what it lies on, which of them is the master), or one of its
  /// subtypes, lies on what this list names, and is led by the curve in space.
  void lie_on_these(std::uint32_t curve, const std::vector<std::uint32_t>& parts,
                    const std::string& list);
  // The records of a curve and its control points, each after a line break.
  [[nodiscard]] std::string curve_records(const Curve& curve, const std::string& name);
  // The text of a number: as in the list (of lists) if it occurs there, otherwise in the fewest
  // digits.
  [[nodiscard]] std::function<std::string(double)> texts(std::uint32_t list) const;
  [[nodiscard]] std::string line_break() const;
  void change(std::uint32_t value, std::string text) {
    changes_.push_back({file_.range(value), std::move(text)});
  }
  void insert(std::uint32_t at, std::string text) {
    changes_.push_back({{at, at}, std::move(text)});
  }

  const Part21File& file_;
  Reader reader_;
  FreshNames names_;
  std::vector<Change> changes_;
  std::set<std::uint32_t> laid_;  // SURFACE_CURVEs that refer to a surface in place of PCURVEs
};

}  // namespace knead::step
