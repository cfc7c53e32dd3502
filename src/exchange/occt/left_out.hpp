#pragma once

#include <cstddef>
#include <vector>

#include "file.hpp"
#include "knead/exchange/source.hpp"

namespace knead::occt {

/// What of a file of Open CASCADE's shapes is not read: further uses of faces, faces without a
/// surface or without wires, wires, edges and vertices that are no parts of faces, curves of no
/// edge, surfaces of other forms without faces. Cost: linear in the file. \param again further uses
/// of faces, which its model leaves out (`ReadModel`)
[[nodiscard]] std::vector<LeftOut> left_out(const BrepFile& file, std::size_t again);

}  // namespace knead::occt
