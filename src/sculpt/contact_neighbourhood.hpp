#pragma once

#include <vector>

#include "solve/constrained_cholesky.hpp"

namespace knead {

/// The control points affected by contacts, and the inverse of A between them. Contact forces are confined to them, and
/// so are the displacements that Newton's iteration needs: arrays have one row per control point of the neighbourhood,
/// in a fixed order to which `extend` appends.
class ContactNeighbourhood {
 public:
  explicit ContactNeighbourhood(const ConstrainedCholesky& inverse)
      : inverse_(inverse), inside_(static_cast<std::size_t>(inverse.space().size()), 0) {}

  /// Adds the marked control points.
  void extend(const std::vector<char>& marks) {
    std::vector<int> points = part_.points;
    for (std::size_t i = 0; i < marks.size(); ++i) {
      if (!marks[i] || inside_[i]) continue;
      inside_[i] = 1;
      points.push_back(static_cast<int>(i));
    }
    if (points.size() > part_.points.size()) part_ = inverse_.part(std::move(points));
  }

  [[nodiscard]] Eigen::Index size() const { return static_cast<Eigen::Index>(part_.points.size()); }
  [[nodiscard]] Points gather(const Points& all) const {
    Points here(size(), 3);
    for (Eigen::Index k = 0; k < size(); ++k) here.row(k) = all.row(part_.points[static_cast<std::size_t>(k)]);
    return here;
  }
  [[nodiscard]] Points scatter(const Points& here) const {
    Points all = Points::Zero(inverse_.space().size(), 3);
    for (Eigen::Index k = 0; k < size(); ++k) all.row(part_.points[static_cast<std::size_t>(k)]) = here.row(k);
    return all;
  }
  /// The same array with zero rows for control points added since.
  [[nodiscard]] Points grown(const Points& here) const {
    Points result = Points::Zero(size(), 3);
    result.topRows(here.rows()) = here;
    return result;
  }
  /// A⁻¹ of forces here, restricted to the neighbourhood.
  [[nodiscard]] Points inverse(const Points& forces) const { return inverse_.solve_within(part_, forces); }
  /// The same at all control points.
  [[nodiscard]] Points inverse_everywhere(const Points& forces) const { return inverse_.solve_from(part_, forces); }

 private:
  const ConstrainedCholesky& inverse_;
  std::vector<char> inside_;
  ConstrainedCholesky::Part part_;
};

}  // namespace knead
