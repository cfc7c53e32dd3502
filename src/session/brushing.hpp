#pragma once

#include <string>
#include <vector>

#include "act.hpp"
#include "brush_run.hpp"

namespace knead {

// Strokes of brushes.

/// Opens a stroke of a brush with the selected surfaces as they are; its path is empty.
void begin_brush(Act& act, const Brush& brush, std::vector<BrushImage> images, double rope);
/// Leads the open brush on, and makes what it asks for the shapes and rest shapes.
[[nodiscard]] Expected<void> brush_to(Act& act, const std::vector<BrushPoint>& path);

/// Makes the constraints of the open brush, and a plate on a bed that tells how far they are felt, unless they are
/// there.
[[nodiscard]] Expected<void> prepare_brush_model(Act& act);
/// Finer nets under a brush, also of the surfaces beside those on which it is; the shapes from before the stroke
/// follow.
[[nodiscard]] Expected<void> refine_for_brush(Act& act, const std::vector<BrushPoint>& places);

}  // namespace knead
