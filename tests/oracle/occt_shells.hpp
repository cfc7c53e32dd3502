#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace knead::oracle {

/// Open shells of B-spline faces that meet in edges, over the square 0 … 100 mm.
///
/// "matching": two faces with equal knots along their edge. "other_parameters": the edge is a
/// straight line, through which the two surfaces run at different speeds and with other knots.
/// "inside": the edge crosses the inside of both surfaces askew. "curved": so does one of two faces
/// on the same wavy shape, with other knots. "strips": three faces in a row, with other knots and
/// parametrisations. "corner": four faces around a vertex. "smooth_corner": four with other knots
/// and parametrisations, in one plane.
[[nodiscard]] std::vector<std::string> occt_shell_names();

/// Others with faces on planes and cylinders, over the same square: "planes", two that meet at 30
/// degrees; "plane_and_wavy", a strip beside a wavy B-spline face; "plane_and_flat" and
/// "cylinder_and_flat", tangent to a flat one.
[[nodiscard]] std::vector<std::string> occt_mixed_shell_names();

/// Writes one of them as a STEP file in millimetres, or, where the name ends so, as a .brep file.
[[nodiscard]] bool occt_write_shell(const std::string& name, const std::filesystem::path& path);

/// .brep files: "made_nested.brep", shells in nested compounds, one of them moved and turned by a
/// location; "made_triangulated.brep", a shell with its triangles.
[[nodiscard]] std::vector<std::string> occt_brep_names();
[[nodiscard]] bool occt_write_brep(const std::string& name, const std::filesystem::path& path);

}  // namespace knead::oracle
