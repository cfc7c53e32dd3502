#pragma once

#include <algorithm>
#include <vector>

#include "solve/constrained_cholesky.hpp"
#include "tool/potential.hpp"

namespace knead {

/// The control points affected by contacts and those around them, and the inverse of A between
/// them. Contact forces are confined to them, and so are the displacements that Newton's iteration
/// needs: arrays have one row per control point of the neighbourhood, in a fixed order to which
/// `extend` appends.
///
/// An inverse within it uses the columns of L on the way from these points to the root of the
/// elimination, a part of L that shrinks with the share of the net (docs/factor.md). To grow costs
/// a new part and all that is known relative to it, hence a ring more than is needed at once.
class ContactNeighbourhood {
 public:
  ContactNeighbourhood(const ConstrainedCholesky& inverse, const Potential& potential)
      : inverse_(inverse),
        potential_(potential),
        inside_(static_cast<std::size_t>(inverse.space().size()), 0),
        watched_(potential.watch(inside_)),
        directions_(Points::Zero(inverse.space().size(), 3)),
        forces_(directions_) {}

  /// Grows until the contacts of a state and the control points around them are inside, and one
  /// ring more, so that contacts may travel. False if they are already.
  bool extend(const PotentialState& state) {
    std::vector<char> marks(inside_.size(), 0);
    potential_.mark(state, marks);
    potential_.widen(marks);
    if (contains(marks)) return false;
    std::vector<int> points = subset_.points;
    for (std::size_t i = 0; i < marks.size(); ++i) {
      if (!marks[i] || inside_[i]) continue;
      inside_[i] = 1;
      points.push_back(static_cast<int>(i));
    }
    subset_ = inverse_.subset(std::move(points));
    watched_ = potential_.watch(inside_);
    return true;
  }
  /// Whether all contacts of a state act inside only.
  [[nodiscard]] bool contains(const PotentialState& state) const {
    std::vector<char> marks(inside_.size(), 0);
    potential_.mark(state, marks);
    return contains(marks);
  }

  [[nodiscard]] Eigen::Index size() const {
    return static_cast<Eigen::Index>(subset_.points.size());
  }
  [[nodiscard]] const ConstrainedCholesky::Subset& subset() const { return subset_; }
  /// The elements inside.
  [[nodiscard]] const WatchedElements& watched() const { return watched_; }

  [[nodiscard]] Points gather(const Points& all) const {
    Points here(size(), 3);
    for (Eigen::Index k = 0; k < size(); ++k)
      here.row(k) = all.row(subset_.points[static_cast<std::size_t>(k)]);
    return here;
  }
  /// Sets the rows of the neighbourhood.
  void scatter(const Points& here, Points& all) const {
    for (Eigen::Index k = 0; k < size(); ++k)
      all.row(subset_.points[static_cast<std::size_t>(k)]) = here.row(k);
  }
  /// The same array with zero rows for control points added since.
  [[nodiscard]] Points grown(const Points& here) const {
    Points result = Points::Zero(size(), 3);
    result.topRows(here.rows()) = here;
    return result;
  }
  /// A⁻¹ of forces here, restricted to the neighbourhood.
  [[nodiscard]] Points inverse(const Points& forces) const {
    return inverse_.solve_within(subset_, forces);
  }
  /// The Hessian of contacts inside, applied to a direction here.
  [[nodiscard]] Points hessian(const PotentialState& state, const Points& direction) {
    scatter(direction, directions_);
    for (const int i : subset_.points) forces_.row(i).setZero();
    potential_.apply_hessian(state, directions_, forces_);
    return gather(forces_);
  }

 private:
  [[nodiscard]] bool contains(const std::vector<char>& marks) const {
    for (std::size_t i = 0; i < marks.size(); ++i) {
      if (marks[i] && !inside_[i]) return false;
    }
    return true;
  }

  const ConstrainedCholesky& inverse_;
  const Potential& potential_;
  std::vector<char> inside_;
  ConstrainedCholesky::Subset subset_;
  WatchedElements watched_;
  Points directions_, forces_;  // of all control points, used inside only
};

}  // namespace knead
