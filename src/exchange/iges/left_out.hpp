#pragma once

#include <set>
#include <vector>

#include "file.hpp"
#include "knead/brep/model.hpp"
#include "knead/exchange/source.hpp"

namespace knead::iges {

/// What of an IGES file is not read: points, curves that nothing read is made of, surfaces of other
/// forms without faces, faces without bounds, solids without faces, subfigures that are not placed,
/// annotations, groups and the like. \param model what the file became (`read_model`) \param
/// unplaced instances (408) that have no place there Cost: linear in the file.
[[nodiscard]] std::vector<LeftOut> left_out(const File& file, const brep::Model& model,
                                            const std::set<int>& unplaced);

}  // namespace knead::iges
