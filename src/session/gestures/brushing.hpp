#pragma once

#include <vector>

#include "gesture.hpp"
#include "session/acts/act.hpp"

namespace knead {

/// A stroke of a brush. While it is open, the selected surfaces are those from before it with what
/// it asks for along all of its path, as far as constraints and masks allow that, as shapes and
/// rest shapes; lifted, they stay so.
class BrushStroke {
 public:
  using Place = BrushPoint;
  struct Begin {
    Brush brush;
    std::vector<BrushImage> images;
    /// The pointer draws the brush by a rope of this length; 0: they are together.
    double rope = 0;
  };
  explicit BrushStroke(Act& act) : act_(act) {}

  [[nodiscard]] bool is_open() const { return act_.state.brush.has_value(); }
  [[nodiscard]] Expected<void> begin(const Begin& begin);
  [[nodiscard]] Expected<void> lead(const std::vector<BrushPoint>& path);
  [[nodiscard]] Expected<void> lift();

 private:
  Act& act_;
};

/// Makes the constraints of the open brush, and a plate on a bed that tells how far they are felt,
/// unless they are there.
[[nodiscard]] Expected<void> prepare_brush_model(Act& act);
/// Finer nets under the open brush, also of the surfaces beside those on which it is; the shapes
/// from before the stroke follow.
[[nodiscard]] Expected<void> refine_for_brush(Act& act, const std::vector<BrushPoint>& places);

}  // namespace knead
