#pragma once

#include "knead/exchange/format.hpp"

namespace knead::detail {

/// One function per format, each in its own file. A new format is declared and listed here.
[[nodiscard]] Format step_format();
[[nodiscard]] Format iges_format();
[[nodiscard]] Format stl_format();
[[nodiscard]] Format obj_format();
[[nodiscard]] Format ply_format();
[[nodiscard]] Format gltf_format();

inline constexpr Format (*format_list[])() = {step_format, iges_format, stl_format,
                                              obj_format,  ply_format,  gltf_format};

}  // namespace knead::detail
