#pragma once

#include <optional>
#include <span>
#include <vector>

#include "model.hpp"
#include "solve/constraint_elimination.hpp"

namespace knead {

/// What `check_conditions` found out last: conditions that can be met together. Of pins that come
/// after them one by one, as those of a script do, each is eliminated alone, and not all of them
/// anew.
class MetConditions {
 public:
  /// As `check_conditions`, with the same errors. Cost: where pins were added to what was checked
  /// last, that of their own conditions, and of comparing all others.
  [[nodiscard]] Expected<void> check(const ModelInput& input);
  /// How many conditions were eliminated so far: what checking has cost.
  [[nodiscard]] long long eliminated() const { return eliminated_; }

 private:
  struct Met {
    ModelInput input;
    std::vector<int> rows;
    double size;
    bool along_normals;  // some conditions are: the elimination is of coordinates
    detail::ConstraintElimination elimination;
  };

  [[nodiscard]] bool meets_more(const ModelInput& input);
  [[nodiscard]] bool meets(std::size_t surface, std::span<const KeptConstraint> pins);

  std::optional<Met> met_;
  long long eliminated_ = 0;
};

}  // namespace knead
