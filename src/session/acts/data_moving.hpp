#pragma once

#include <string_view>

#include "act.hpp"
#include "session/queries/morph_fields.hpp"

namespace knead {

/// Moves the surfaces of the scene so that they follow data, all of them together with their edges:
/// they become those of the file that `morph_file` makes of the document as it would be saved, so
/// that what is saved next is that file. Everything at edges has been measured there, on the
/// written file. Locked surfaces stay. Errors: those of `follow_data`; an edge that would be left
/// open.
[[nodiscard]] Expected<MorphReport> move_after_data(Act& act, MorphData data, MorphRequest request);

/// Notes what of a report is above what was wanted.
void note_excess(Act& act, const MorphReport& report, std::string_view command);

/// Puts a surface where it is to rest from now on. Errors: those of `put`.
[[nodiscard]] Expected<void> put_at_rest(SceneSurface& s, std::shared_ptr<const Surface> current);

/// A shape on the net of another one, with the same bits of knots and weights: shapes are compared
/// by them. Errors: those of `onto_net`.
[[nodiscard]] Expected<Surface> on_basis_of(const Surface& shape, const Surface& like);

}  // namespace knead
