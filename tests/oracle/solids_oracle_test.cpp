// IGES solids and rings as triangles, held against the areas and volumes that Open CASCADE finds.

#include "brep/tessellation/model_mesh.hpp"
#include "exchange/mesh_measures.hpp"
#include "exchange/support.hpp"
#include "knead/exchange/file_io.hpp"
#include "oracle/occt_file.hpp"
#include "support/made_iges_solids.hpp"

namespace knead::oracle {
namespace {

/// Lengths of Open CASCADE are millimetres, `unit` of them long.
void expect_same(const std::string& bytes, const std::filesystem::path& path, double unit,
                 double tolerance) {
  const auto source = testing::open_or_die(bytes, path.string());
  const auto model = model_faces(*source->model(), tolerance);
  ASSERT_TRUE(model) << model.error().message();
  EXPECT_TRUE(model->skipped.empty()) << model->skipped.front().id;
  const auto other = occt_read_file(path);
  ASSERT_TRUE(other);
  EXPECT_EQ(static_cast<std::size_t>(other->topology.at("faces")), model->faces.size());
  double area = 0;
  for (const FaceMesh& mesh : model->faces) area += testing::area_of(mesh);
  EXPECT_NEAR(area * unit * unit, other->area, 1e-3 * other->area);
  if (other->volume == 0) return;
  EXPECT_EQ(open_sides(model->faces), 0U);
  EXPECT_NEAR(testing::volume_of(model->faces) * unit * unit * unit, other->volume,
              tolerance * area * unit * unit * unit + 1e-9 * other->volume);
}

struct Made {
  std::string (*text)();
  double unit;
};

TEST(SolidsOracle, MadeSolidsAndRingsHaveTheVolumesAndAreasThatOpenCascadeFinds) {
  for (const auto& [text, unit] :
       {Made{testing::iges_box_of_turned_faces, 1}, Made{testing::iges_box_of_a_turned_shell, 1000},
        Made{testing::iges_hollow_box, 25.4}, Made{testing::iges_ring_in_mm, 1},
        Made{testing::iges_ring_in_inch_backwards, 25.4}, Made{testing::iges_drum_in_mm, 1},
        Made{testing::iges_drum_in_inch, 25.4}, Made{testing::iges_dome_in_metres, 1000},
        Made{testing::iges_dome_in_inch, 25.4}}) {
    const auto path = std::filesystem::temp_directory_path() /
                      ("knead-solids-" + std::to_string(::getpid()) + ".igs");
    ASSERT_TRUE(write_file_atomically(path, text()));
    expect_same(text(), path, unit, 1e-3);
    std::filesystem::remove(path);
  }
}

TEST(SolidsOracle, ForeignOnesToo) {
  for (const std::string name : {"box_with_hole_brep.igs", "revolved_ring_closed_twice.igs"}) {
    const auto path = testing::foreign("data/faults/" + name);
    KNEAD_NEEDS(path);
    expect_same(*read_file(path), path, 1, 0.01);
  }
}

}  // namespace
}  // namespace knead::oracle
