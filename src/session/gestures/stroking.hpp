#pragma once

#include <span>
#include <string>
#include <vector>

#include "gesture.hpp"
#include "sculpt/travelled.hpp"
#include "session/acts/act.hpp"

namespace knead {

/// A stroke of a tool that leaves its groove as it goes: every place leaves its dent in the shapes
/// from before it. While it is open, the selected surfaces show these with what stays so far, and
/// with the dent that the tool is in. Lifted, the tool goes home, and what stays is the shape and
/// the rest shape. Edges that follow are closed all along.
class Stroke {
 public:
  using Place = Point;  // of the tool's centre
  struct Begin {
    std::string tool;
    double share = 1;  ///< of what the material lets stay
  };
  explicit Stroke(Act& act) : act_(act) {}

  [[nodiscard]] bool is_open() const { return act_.state.stroke.has_value(); }
  [[nodiscard]] Expected<void> begin(const Begin& begin);
  [[nodiscard]] Expected<void> lead(const std::vector<Point>& path);
  [[nodiscard]] Expected<void> lift();
  /// Shows, and leaves, only this share of what it shows. It is open.
  [[nodiscard]] Expected<void> keep_share(double share);

 private:
  Expected<void> press_along(const std::vector<Point>& places);
  Expected<ActiveStep> press_at(const Point& place, std::vector<Tool>& tools);
  Expected<void> show(bool down);
  Expected<void> show_remembered(bool down);

  Act& act_;
};

inline constexpr std::size_t pure_terms[] = {0, 2};  // α11 and α22, β11 and β22

/// Makes the model that the open stroke presses, unless it is there.
[[nodiscard]] Expected<void> prepare_stroke_model(Act& act);
/// What these tools ask, which are there after these travels, of the shapes from before the open
/// stroke: a displacement.
[[nodiscard]] Expected<ActiveStep> press(Act& act, std::vector<Tool> tools,
                                         std::span<const Travel> travels);
/// Makes a tool as hard as the open stroke needs it, unless it is, or does not collide.
void harden(Tool& tool, const OpenStroke& stroke);

}  // namespace knead
