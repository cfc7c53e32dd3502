#pragma once

#include "entity.hpp"
#include "faces.hpp"
#include "knead/brep/model.hpp"
#include "surfaces.hpp"

namespace knead::step {

/// Adds the vertices, edges, these faces and the shells of a file to a model, and the supports of
/// its faces; those on the B-spline surfaces with these records lead to them. Faces that are
/// surfaces have no bounds yet. Returns the records of the supports. Cost: linear in the file;
/// curves are read by several threads.
[[nodiscard]] std::vector<std::uint32_t> read_topology(const Reader& reader,
                                                       const std::vector<std::uint32_t>& surfaces,
                                                       const std::vector<FaceRecord>& faces,
                                                       brep::Model& model);

}  // namespace knead::step
