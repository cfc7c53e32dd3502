#pragma once

#include "knead/exchange/format.hpp"

namespace knead::detail {

/// One function per format, each in its own file. A new format is declared and listed here.
[[nodiscard]] Format step_format();
[[nodiscard]] Format iges_format();
[[nodiscard]] Format brep_format();
[[nodiscard]] Format g2_format();
[[nodiscard]] Format gismo_format();
[[nodiscard]] Format geopdes_format();
[[nodiscard]] Format net_format();
[[nodiscard]] Format json_net_format();
[[nodiscard]] Format stl_format();
[[nodiscard]] Format obj_format();
[[nodiscard]] Format ply_format();
[[nodiscard]] Format gltf_format();

/// The error of writing no surface and no curve.
[[nodiscard]] std::unexpected<Error> nothing_to_write();

inline constexpr Format (*format_list[])() = {
    step_format, iges_format,     brep_format, g2_format,  gismo_format, geopdes_format,
    net_format,  json_net_format, stl_format,  obj_format, ply_format,   gltf_format};

}  // namespace knead::detail
