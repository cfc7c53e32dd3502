#pragma once

#include <span>
#include <string>
#include <vector>

#include "file.hpp"
#include "knead/spline/spline.hpp"
#include "moved.hpp"

namespace knead::iges {

/// A B-spline surface for one of the file, in the coordinates of the model.
struct Replacement {
  int number = 0;  ///< directory number
  Surface surface;
};

/// Other parameters for an entity, the first of which is its type.
struct OtherParameters {
  int number = 0;  ///< directory number
  std::vector<std::string> values;
};

/// The bytes of the file with these surfaces, and every other byte as it was.
///
/// A surface of another type than 128 becomes one (surface_parameters.hpp).
///
/// The parameter records of a changed entity are written anew in 64 columns; numbers that stay the
/// same keep their text, others have 17 digits. Where their number changes, the records behind them
/// are numbered anew, and so are the pointers and the count in the directory and the count in the
/// terminate section. Points of an entity with a transformation matrix go back through its inverse,
/// to rounding. `moved`: curves become entities 126 in their places, and vertices move in their
/// lists (502). `others`: of entities beside them. The result is read again and compared: the
/// surfaces, the curves to 1e-13, and the parameters of all other entities. Errors: unknown numbers
/// (input); the check fails (numerical). Cost: linear in the file.
[[nodiscard]] Expected<std::string> with_surfaces(const File& file,
                                                  std::span<const Replacement> replacements,
                                                  const MovedEntities& moved = {},
                                                  std::span<const OtherParameters> others = {});

/// Parameters in records of 64 columns, and what follows the terminator.
[[nodiscard]] std::vector<std::string> wrapped(const std::vector<std::string>& values,
                                               const Global& global, const std::string& rest);

}  // namespace knead::iges
