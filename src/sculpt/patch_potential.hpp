#pragma once

#include <algorithm>

#include "knead/sculpt/tool_load.hpp"

namespace knead {

/// Tools, friction and limit on all patches of a model, in normalised units.
template <int D>
class PatchPotential final : public Potential {
 public:
  PatchPotential(std::span<const ToolLoad<D>> loads, std::span<const int> rows, std::vector<ModelTool> tools)
      : loads_(loads), rows_(rows), tools_(std::move(tools)) {
    for (const ModelTool& tool : tools_) given_.push_back(tool.stiffness());
  }

  /// Friction from the contacts at x on; it is fully developed after moving by `slip`.
  void grip(const Points& x, double slip) {
    if (std::ranges::none_of(tools_, [](const ModelTool& t) { return t.tool().friction > 0 && t.tool().collides(); }))
      return;
    for (std::size_t k = 0; k < loads_.size(); ++k) friction_.push_back(loads_[k].anchors(x, rows_[k], tools_, slip));
  }
  /// No point may be further than `distance` from where `original` has it.
  void limit(const Points& original, double distance, double stiffness) {
    limits_.clear();
    for (std::size_t k = 0; k < loads_.size(); ++k) {
      limits_.push_back({distance, stiffness, original.middleRows(rows_[k], rows_[k + 1] - rows_[k])});
    }
  }
  void set_stiffness(std::size_t tool, double stiffness) {
    tools_[tool].set_stiffness(stiffness);
    given_[tool] = stiffness;
  }
  [[nodiscard]] const Tool& tool(std::size_t k) const { return tools_[k].tool(); }
  [[nodiscard]] double stiffness(std::size_t k) const { return given_[k]; }

  [[nodiscard]] PotentialState evaluate(const Points& x) const override {
    PotentialState state;
    state.force = Points::Zero(x.rows(), 3);
    for (std::size_t k = 0; k < loads_.size(); ++k) {
      loads_[k].evaluate(x, rows_[k], static_cast<int>(k),
                         {tools_, friction_.empty() ? nullptr : &friction_[k], limits_.empty() ? nullptr : &limits_[k]},
                         state);
    }
    return state;
  }

  [[nodiscard]] Points apply_hessian(const PotentialState& state, const Points& v) const override {
    Points result = Points::Zero(v.rows(), 3);
    for (const ContactPoint& c : state.contacts) {
      const auto k = static_cast<std::size_t>(c.patch);
      loads_[k].apply_hessian(c, rows_[k], v, result);
    }
    return result;
  }

  void soften(double cap) override {
    for (std::size_t t = 0; t < tools_.size(); ++t) tools_[t].set_stiffness(std::min(given_[t], cap));
  }

  [[nodiscard]] double stiffest() const override {
    double result = 0;
    for (double stiffness : given_) result = std::max(result, stiffness);
    return result;
  }

 private:
  std::span<const ToolLoad<D>> loads_;
  std::span<const int> rows_;
  std::vector<ModelTool> tools_;
  std::vector<double> given_;  // their stiffness, not softened
  std::vector<FrictionAnchors> friction_;
  std::vector<DisplacementLimit> limits_;
};

}  // namespace knead
