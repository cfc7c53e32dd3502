#pragma once

#include <string>
#include <unordered_map>

#include "file.hpp"
#include "knead/exchange/source.hpp"

namespace knead::step {

/// The colours that the styles of a STEP file give to faces and surfaces, by id ("#123").
///
/// A STYLED_ITEM colours what its item leads to: a face or surface itself, the faces of a shell,
/// solid or surface model. One on a face comes before one on its shell, and that before one on the
/// solid; an OVER_RIDING_STYLED_ITEM before others on the same item. A surface without a style of
/// its own has the colour of the first face on it. The colour is the first COLOUR_RGB or named
/// colour below its surface styles; styles of curves and points do not count. Cost: linear in the
/// records below styled items.
[[nodiscard]] std::unordered_map<std::string, Colour> face_colours(const File& file);

}  // namespace knead::step
