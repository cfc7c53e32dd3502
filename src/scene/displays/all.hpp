#pragma once

#include "scene/display.hpp"

namespace knead {

// Each is defined in the file named after it.
Display deviation_display();
Display mean_curvature_display();
Display gaussian_curvature_display();
Display largest_curvature_display();
Display draft_angle_display();
Display thickness_display();
Display gap_display();
Display energy_display();
Display von_mises_display();
Display von_mises_outer_display();
Display von_mises_inner_display();
Display bending_strain_display();
Display mask_display();

/// In the order of menus.
inline constexpr std::array all_displays = {deviation_display,
                                            mean_curvature_display,
                                            gaussian_curvature_display,
                                            largest_curvature_display,
                                            draft_angle_display,
                                            thickness_display,
                                            gap_display,
                                            energy_display,
                                            von_mises_display,
                                            von_mises_outer_display,
                                            von_mises_inner_display,
                                            bending_strain_display,
                                            mask_display};

}  // namespace knead
