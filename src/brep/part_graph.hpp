#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "knead/brep/model.hpp"

namespace knead::brep {

/// Parts, and the uses of them in each other, that an assembly is made of.
class PartGraph {
 public:
  struct Node {
    std::string name;
    LengthUnit unit;
    bool product = false;  ///< it, or what it is used in, belongs to the structure of products
    std::vector<PartPlace> places;  ///< filled by `place`
    std::vector<std::size_t> down;  ///< uses of which it is the parent
    std::size_t open = 0;           ///< uses of which it is the child, not yet followed
  };
  explicit PartGraph(std::size_t parts) : nodes_(parts) {}

  [[nodiscard]] Node& operator[](std::size_t k) { return nodes_[k]; }
  [[nodiscard]] std::size_t size() const { return nodes_.size(); }
  /// The child's coordinates are moved to the parent's.
  void use(Index parent, Index child, const Eigen::Affine3d& move);

  /// Gives each product its places in the model, in the unit of the first root that has one, or
  /// `unit`. Where nothing is a product, what has uses is. Products that no other uses are the
  /// roots, at their own origins. A part that contains itself stands as far as it could be
  /// followed, with a warning. Errors (input): more than `max_places`.
  [[nodiscard]] Expected<void> place(const std::string& unit, Assembly& result);

 private:
  struct Use {
    Index parent = none, child = none;
    Eigen::Affine3d move = Eigen::Affine3d::Identity();
  };
  void mark();
  [[nodiscard]] std::vector<Index> roots(const std::string& unit, Assembly& result);

  std::vector<Node> nodes_;
  std::vector<Use> uses_;
};

/// Length of a child's unit in the parent's; 1 where one is not known.
[[nodiscard]] double unit_ratio(const LengthUnit& child, const LengthUnit& parent);

/// The factor by which a matrix scales lengths, 1e-9 of which it may shear, as far as files print
/// one; none: it shears.
[[nodiscard]] std::optional<double> scale_of(const Eigen::Matrix3d& matrix);

}  // namespace knead::brep
