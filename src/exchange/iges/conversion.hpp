#pragma once

#include <span>
#include <string>
#include <vector>

#include "file.hpp"
#include "knead/brep/model.hpp"

namespace knead::iges {

/// The bytes of the file with surfaces of other forms as B-spline surfaces (128) with the same
/// points, and every other byte as it was (docs/conversion.md). Curves in the parameters of these
/// surfaces would be wrong: boundaries (142, 141) and loops (508) of faces on them refer to the
/// curves in space alone. What depended on these surfaces or boundaries, and nothing refers to any
/// more, becomes a null entity (0). \param model of the file \param surfaces ids of them, or of
/// faces on them Errors (input): one that cannot be converted; a boundary on it is given in
/// parameters alone; an offset surface (140) is made of it; (numerical) the result does not read
/// back. Cost: that of `exact_spline` for each, and a pass over the file.
[[nodiscard]] Expected<std::string> with_splines(const File& file, const brep::Model& model,
                                                 std::span<const std::string> surfaces);

}  // namespace knead::iges
