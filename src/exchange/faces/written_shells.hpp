#pragma once

#include <span>
#include <vector>

#include "knead/brep/model.hpp"

namespace knead::detail {

/// A face as a new file has it.
struct WrittenFace {
  brep::Index face = brep::none;
  bool same_sense = true;  ///< its normal is that of its surface
};

/// Faces that meet in edges.
struct WrittenShell {
  std::vector<WrittenFace> faces;
  bool closed = false;  ///< every edge has a face on either side, and the normals look out
};

/// A body between a closed shell and those round its hollows. All of them look out, as if hollows
/// were bodies.
struct WrittenSolid {
  WrittenShell outer;
  std::vector<WrittenShell> hollows;
};

struct WrittenShells {
  std::vector<WrittenSolid> solids;
  std::vector<WrittenShell> sheets;  ///< that bound no body
};

/// Whether the loops of a bound of a written face run with the face on their left, as seen from the
/// tip of its normal.
[[nodiscard]] bool runs_forward(const brep::Bound& bound, const brep::Face& face,
                                const WrittenFace& written);

/// The shells of faces of a model that share edges, and lie in the same shell where the model has
/// shells.
///
/// Faces keep their senses where those of neighbours agree; else they are turned as the first of
/// their shell, if that is possible. A closed shell is a solid. One whose volume is negative is a
/// hollow of the solid with the smallest box round its own, or is turned where there is none.
/// Volumes are those of a coarse mesh; where it fails a closed shell keeps its senses, and is a
/// sheet if the model turns it, as it does those of hollows. Cost: that of the mesh of the faces of
/// closed shells, and n log n in the edges.
[[nodiscard]] WrittenShells written_shells(const brep::Model& model,
                                           std::span<const brep::Index> faces);

}  // namespace knead::detail
