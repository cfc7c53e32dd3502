#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace knead::testing {

/// The folder of files that others made, which are not part of the project: the one that
/// KNEAD_SHARED names, which is read when a test runs; unset: `shared` beside the project; empty:
/// none.
inline std::filesystem::path foreign_folder() {
  const char* named = std::getenv("KNEAD_SHARED");
  return named != nullptr ? named : KNEAD_SOURCE_DIR "/../shared";
}

/// Where a file of the folder lies, or would; where there is no folder, a path at which nothing can
/// be.
inline std::filesystem::path foreign(const std::string& name) {
  const std::filesystem::path folder = foreign_folder();
  return (folder.empty() ? "/dev/null" : folder) / name;
}
inline std::filesystem::path foreign_cad(const std::string& name) {
  return foreign("data/cad/" + name);
}

// The names of tests are listed when they are built: they do not depend on what is in the folder.
// Each of its CAD files stands in one of these lists.
inline constexpr std::array foreign_step = {"AMSurface.step",
                                            "F-16_OpenVSP3.5.0.stp",
                                            "IEA_15MW_CFD.stp",
                                            "MAINBODY_BACK.stp",
                                            "NIST_MBE_PMI_5.stp",
                                            "ap203_part21_scope.stp",
                                            "ap203_periodic_bspline_triangular_cap.stp",
                                            "ap214_repeated_distinct_surface_knots.stp",
                                            "ap214_vertex_loop_spline_pole.stp",
                                            "as1-oc-214.stp",
                                            "dm1-id-214.stp",
                                            "goteborg.step",
                                            "linkrods.step",
                                            "simple_wing.stp",
                                            "test_pipe.step",
                                            "vsp.stp"};
inline constexpr std::array foreign_iges = {"bracket.iges", "example_45_faces.iges", "hammer.iges",
                                            "kcs.iges",     "series_60.iges",        "shaft.iges",
                                            "tip.iges",     "wigley.iges",           "wing128.igs"};
inline constexpr std::array foreign_brep = {"Pump_TopCover.brep", "curvesToSurfaceContinuous.brep",
                                            "terrain.brep", "wing.brep"};
// CAD files of other folders than `data/cad`, by their names within `data`.
inline constexpr std::array foreign_faults = {"faults/box_with_hole_brep.igs",
                                              "faults/coloured_mapped_item.step",
                                              "faults/cone_far_nappe.step",
                                              "faults/draw_saved_box.brep",
                                              "faults/edge_with_coincident_end_knots.step",
                                              "faults/grid_3x3.step",
                                              "faults/inch_with_mm_styles.step",
                                              "faults/lens_degenerate_torus.step",
                                              "faults/metre_by_conversion.step",
                                              "faults/moved_twice.brep",
                                              "faults/plate_three_square_holes.step",
                                              "faults/revolved_ring_closed_twice.igs",
                                              "faults/sheet_with_held_edges.step",
                                              "faults/sliver_beside_plane.step",
                                              "faults/whole_torus.step"};
inline constexpr std::array foreign_morph = {
    "morph/cax/as1_pe_203.stp",
    "morph/cax/oij_MAINBODY.stp",
    "morph/cax/oij_MAINBODY_BACK.stp",
    "morph/cax/oij_MAINBODY_FRONT.stp",
    "morph/cax/oij_as1-oc-214.stp",
    "morph/cax/oij_as1-tu-203.stp",
    "morph/cax/oij_as1_pe_203.stp",
    "morph/cax/oij_mainbody_asm.stp",
    "morph/cax/oij_mainbodyback.stp",
    "morph/cax/oij_mainbodyfront.stp",
    "morph/prusa/extruder-body-1.stp",
    "morph/prusa/extruder-body-2.stp",
    "morph/pygem/test_pipe.iges",
    "morph/pygem/test_pipe.step",
    "morph/pygem/test_pipe_out_true.iges",
    "morph/pygem/test_pipe_out_true.step",
    "morph/springback/compensatedsurface_mean_simulated_0_5_i0.stp",
    "morph/springback/compensatedsurface_mean_simulated_0_5_i1.stp",
    "morph/springback/compensatedsurface_mean_simulated_0_5_i2.stp",
    "morph/springback/compensatedsurface_mean_simulated_0_5_i3.stp",
    "morph/springback/compensatedsurface_mean_simulated_0_5_i4.stp"};
inline constexpr std::array foreign_text = {"duck1.ctrlpts", "egg.xml", "smesh.45.in.dat",
                                            "smesh.8.dat", "teapot.xml"};
/// Read by the studio's tests alone.
inline constexpr std::array foreign_rhino = {"v2_HumanHead2.3dm", "v2_RhinoLogo.3dm",
                                             "v7_my_surfaces.3dm"};
/// Images, what others find in them, and what is known of them.
inline constexpr std::array foreign_images = {
    "astronaut.png",      "coins.png",           "horse.png",
    "lakes3.png",         "ref_astronaut.csv",   "ref_coins_morphgac.png",
    "ref_text_fixed.csv", "ref_text_free.csv",   "seastar2.png",
    "stardist_img2d.png", "stardist_mask2d.png", "text.png"};

template <std::size_t N>
std::vector<std::filesystem::path> foreign_paths(const std::array<const char*, N>& names,
                                                 const std::string& folder = "data/cad/") {
  std::vector<std::filesystem::path> result;
  for (const char* name : names) result.push_back(foreign(folder + name));
  return result;
}

/// Why a test cannot run for want of these files, or nothing: always in these words, by which
/// scripts know such tests.
inline std::string without_foreign(const std::vector<std::filesystem::path>& paths) {
  for (const auto& path : paths) {
    if (!std::filesystem::exists(path))
      return "no foreign file " + path.filename().string() + " (KNEAD_SHARED)";
  }
  return {};
}
inline std::string without_foreign(const std::filesystem::path& path) {
  return without_foreign(std::vector{path});
}

/// Skips a test, or from SetUp all of a fixture's, where a file of others is missing, or one of
/// several.
#define KNEAD_NEEDS(files)                                                        \
  if (const std::string knead_missing = ::knead::testing::without_foreign(files); \
      !knead_missing.empty())                                                     \
  GTEST_SKIP() << knead_missing

/// The name of a file as part of a test's.
inline std::string test_name(std::string name) {
  std::ranges::replace_if(
      name, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
  return name;
}

/// Of tests whose parameter is the name of a file.
inline std::string file_test_name(const ::testing::TestParamInfo<std::string>& instance) {
  return test_name(instance.param);
}

}  // namespace knead::testing
