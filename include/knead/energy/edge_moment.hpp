#pragma once

#include <memory>

#include "knead/energy/stiffness.hpp"

namespace knead {

/// A moment per length of an edge of a surface, about the edge and following it: its virtual work is
///
///   δA = ∫ m δω·t ds = −∫ m Σ_α (a^α·c) (n·δa_α) ds,   c = t × n,
///
/// t the unit tangent of the edge in the direction of its parameter, n the unit normal and a^α the dual tangents of the
/// present shape, ds the length of the rest shape. A positive one turns by the right-hand rule about t. Integrated by
/// p + 4 Gauss points per span. Immutable, const is thread-safe.
class EdgeMoment {
 public:
  /// The edge on which parameter `across` (0: u, 1: v) is at the start or the end of its domain. Errors: a moment that
  /// is not finite (input); a rational denominator that is not positive (numerical).
  /// \param first row of the surface's first control point among all `size` (0: those of the surface alone).
  [[nodiscard]] static Expected<EdgeMoment> create(const Surface& rest, int across, bool at_end, double per_length,
                                                   int first = 0, int size = 0);

  /// The forces F on the control points x, N × 3.
  [[nodiscard]] Points forces(const Points& x) const;
  /// The symmetric part of ∂F/∂x, 3N × 3N, unknown 3 i + c coordinate c of control point i. Of a straight edge ∂F/∂x is
  /// symmetric: its moment has the potential −∫ m θ ds.
  [[nodiscard]] SparseMatrix stiffness(const Points& x) const;

 private:
  struct Data;
  explicit EdgeMoment(std::shared_ptr<const Data> data) : data_(std::move(data)) {}
  std::shared_ptr<const Data> data_;
};

}  // namespace knead
