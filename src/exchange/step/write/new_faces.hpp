#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "print.hpp"
#include "text.hpp"

namespace knead::step {

/// The names of records.
struct NewFaces {
  std::string model;               ///< the SHELL_BASED_SURFACE_MODEL
  std::vector<std::string> faces;  ///< one per surface
};

/// Adds faces on the natural bounds of surfaces, whose records have these names, and their shells.
[[nodiscard]] Expected<NewFaces> add_faces(std::span<const NewSurface> surfaces,
                                           std::span<const std::string> names,
                                           const AddRecord& add);

/// A record that shows something, and its colour.
struct Coloured {
  std::string item;
  std::array<double, 3> colour;
};

/// Adds STYLED_ITEMs.
void add_colours(std::span<const Coloured> all, const std::string& context, const AddRecord& add);

}  // namespace knead::step
