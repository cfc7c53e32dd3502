#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace knead::oracle {

/// Solids and shells that Open CASCADE makes, whose faces lie on every kind of surface that is no B-spline.
[[nodiscard]] std::vector<std::string> occt_shape_names();

/// Writes one of them as a STEP file in millimetres.
[[nodiscard]] bool occt_write_shape(const std::string& name, const std::filesystem::path& path);

/// The area of every face of a STEP file whose surface is not a B-spline (or, with `splines`, is one), by the name of
/// the face's entity; lengths in `unit`.
[[nodiscard]] std::map<std::string, double> occt_face_areas(const std::filesystem::path& path, const std::string& unit,
                                                            bool splines = false);

/// The volume of every solid of a STEP file, by the name of its MANIFOLD_SOLID_BREP; lengths in `unit`.
[[nodiscard]] std::map<std::string, double> occt_solid_volumes(const std::filesystem::path& path,
                                                               const std::string& unit);

}  // namespace knead::oracle
