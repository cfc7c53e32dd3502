#pragma once

#include <span>
#include <string>
#include <vector>

#include "knead/exchange/format.hpp"
#include "sections.hpp"

namespace knead::iges {

/// A new IGES file (5.3, fixed ASCII form) of these surfaces (128) and the curves of the options
/// (126), in order.
///
/// With `options.faces` a B-rep beside them: vertices (502), edges (504) on the sides of the
/// surfaces, exactly, which faces that meet share, loops (508), faces (510) and their shells (514).
/// Colours are entities 314. Names are labels of up to eight characters, and properties 406 form 15
/// where they are longer; characters beyond ASCII become "?". Numbers have 17 digits. The text
/// depends on nothing else. Errors (input): nothing to write; a unit that IGES does not have; a
/// knot inside the domain repeated more often than the degree.
[[nodiscard]] Expected<std::string> text_of(std::span<const NamedSurface> surfaces,
                                            const SaveOptions& options);

/// Vertices, edges, loops, faces and shells over surfaces with these directory numbers; those of
/// the shells.
[[nodiscard]] Expected<std::vector<int>> add_shells(std::span<const NamedSurface> surfaces,
                                                    const std::vector<int>& numbers, Sections& to);

/// The parameters of an entity 128, without its type.
[[nodiscard]] std::vector<std::string> surface_values(const Surface& surface);

/// The parameters of an entity 126, likewise.
[[nodiscard]] std::vector<std::string> curve_values(const Curve& curve);

}  // namespace knead::iges
