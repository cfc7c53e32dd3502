#pragma once

#include <set>

#include "brep/moved_edge.hpp"
#include "model.hpp"

namespace knead::occt {

/// Whether an edge of the view can be written anew. Errors (input): there is no such edge; it
/// stands in several places; its curves run at different parameters, or in a form that is not
/// evaluated here.
[[nodiscard]] Expected<void> can_move(const BrepFile& file, const ReadModel::Sources& sources,
                                      const std::string& edge);

/// The changes that move edges and vertices: an edge gets its curve over the parameters that it
/// had, in place of its old one, or behind all others where other edges have that too, and loses
/// its polygons; a vertex other coordinates.
[[nodiscard]] Expected<detail::TextChanges> edge_changes(const BrepFile& file,
                                                         const ReadModel::Sources& sources,
                                                         const brep::MovedEdges& moved);

/// The changes of tolerances that moved edges, and those of changed surfaces, need: where an edge's
/// curves are farther apart, or their ends farther from a vertex, than before and than the
/// tolerance of the edge or vertex, and that by more than roundings, it becomes the sum of both;
/// that of a vertex is no less than its edges'. \param after the file with everything moved \param
/// changed surfaces, from 1
[[nodiscard]] detail::TextChanges tolerance_changes(const BrepFile& file, const BrepFile& after,
                                                    const std::set<int>& changed,
                                                    const brep::MovedEdges& moved,
                                                    const ReadModel::Sources& sources);

}  // namespace knead::occt
