// What the readers' targets have in common: open, describe, mesh, write unchanged, move and write.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "brep/tessellation/context_faces.hpp"
#include "brep/tessellation/model_mesh.hpp"
#include "brep/trim_loops.hpp"
#include "fuzz.hpp"
#include "knead/brep/face_edges.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/exchange/format.hpp"
#include "knead/exchange/source.hpp"

namespace knead::fuzz {

/// The surfaces of the file and, if `moved`, their control points a little higher.
inline std::vector<std::shared_ptr<const Surface>> surfaces_of(const Source& source, bool moved) {
  std::vector<std::shared_ptr<const Surface>> result;
  for (const SourceSurface& s : source.surfaces()) {
    result.push_back(s.surface);
    if (!moved) continue;
    Points points = s.surface->control_points();
    points.col(2).array() += 0.125;
    auto higher = s.surface->with_control_points(points);
    if (higher) result.back() = std::make_shared<const Surface>(*std::move(higher));
  }
  return result;
}

inline void check_faces(const brep::Model& model) {
  const auto check_meshes = [](const FaceMeshes& meshes) {
    for (const FaceMesh& f : meshes.faces) {
      check(f.points.size() == f.normals.size(), "as many normals as points");
      for (const auto& t : f.triangles) {
        for (const auto k : t)
          check(k < f.points.size(), "a corner of a triangle that is no point: " + f.id);
      }
    }
  };
  for (const auto& made : {context_faces(model, 0.1), model_faces(model)}) {
    if (made) check_meshes(*made);
    if (!made) check_error(made.error());
  }
  if (const auto loops = trim_loops(model, 0.1); !loops) check_error(loops.error());
  for (const auto& s : model.surfaces) {
    if (const auto region = visible_region(model, s.id); !region) check_error(region.error());
  }
}

/// All of it, on a file that may or may not be one.
inline void read_and_write(std::string_view bytes, const std::string& name) {
  if (compression_of(bytes) != Compression::none) return;  // the target `packed`
  PeakMemory::begin();
  const auto source = open_source(std::string(bytes), name);
  check_memory(bytes.size(), "reading");
  if (!source) return check_error(source.error());
  for (const SourceSurface& s : (*source)->surfaces())
    check_finite(*s.surface, "a surface of the file");
  for (const SourceCurve& c : (*source)->curves()) check_finite(*c.curve, "a curve of the file");
  for (const brep::UnreadableSurface& u : (*source)->unreadable()) check_error(u.reason);
  const auto same = (*source)->save(surfaces_of(**source, false));
  check(same.has_value() && *same == bytes, "an unchanged file is written with other bytes");
  if (const auto model = (*source)->model()) check_faces(*model);
  for (const LeftOut& left : left_out_of_faces(**source))
    check(left.count > 0 && !left.reason.empty(), sentence(left));
  if ((*source)->surfaces().empty()) return;
  const auto written = (*source)->save(surfaces_of(**source, true));
  if (!written) return check_error(written.error());
  const auto again = open_source(*written, name);
  check(again.has_value(), "what was written cannot be read");
  check((*again)->surfaces().size() == (*source)->surfaces().size(),
        "another number of surfaces was written");
}

}  // namespace knead::fuzz
