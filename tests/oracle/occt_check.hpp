#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace knead::oracle {

/// What Open CASCADE says of a new STEP or IGES file.
struct OcctCheck {
  std::vector<std::string>
      complaints;  ///< warnings and errors of the file and of its transfer; not its
                   ///< notes on surfaces that it makes periodic, or finds C0
  std::map<std::string, int> topology;  ///< distinct shapes by kind
  int bad_shapes = 0;                   ///< that BRepCheck finds fault with
  int closed_shells = 0;
  double area = 0, largest_tolerance = 0;          ///< mm
  std::map<std::array<int, 3>, int> face_colours;  ///< faces of each colour, of 255
};

/// None where the file cannot be read.
[[nodiscard]] std::optional<OcctCheck> occt_check(const std::filesystem::path& path);

}  // namespace knead::oracle
