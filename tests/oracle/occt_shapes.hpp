#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace knead::oracle {

/// Solids and shells that Open CASCADE makes, whose faces lie on every kind of surface that is no
/// B-spline.
[[nodiscard]] std::vector<std::string> occt_shape_names();

/// Writes one of them as a STEP file in millimetres.
[[nodiscard]] bool occt_write_shape(const std::string& name, const std::filesystem::path& path);

/// The area of every face of a STEP file whose surface is not a B-spline (or, with `splines`, is
/// one), by the name of the face's entity; lengths in `unit`.
[[nodiscard]] std::map<std::string, double> occt_face_areas(const std::filesystem::path& path,
                                                            const std::string& unit,
                                                            bool splines = false);

/// A STEP file with its assemblies put together; lengths in `unit`.
struct OcctWhole {
  int faces = 0, solids = 0;
  double area = 0, volume = 0;                   ///< of its faces, of its solids
  std::array<double, 3> lower = {}, upper = {};  ///< of its box
};
/// \param with_box takes long for large surfaces
[[nodiscard]] OcctWhole occt_whole(const std::filesystem::path& path, const std::string& unit,
                                   bool with_box);

}  // namespace knead::oracle
