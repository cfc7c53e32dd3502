// Every surface of a file that is no B-spline surface, converted in one pass.

#include "exchange/face_builder.hpp"
#include "knead/brep/face_conversion.hpp"

namespace knead::step {
namespace {

using testing::FaceBuilder;

TEST(ExactSplines, AreThoseOfEachSurfaceInOrder) {
  FaceBuilder b;
  const int plane = b.entity("PLANE('',#" + std::to_string(b.frame(0, 0, 0)) + ")");
  const int offset = b.entity("OFFSET_SURFACE('',#" + std::to_string(plane) + ",1.,.F.)");
  b.face(offset, {b.bound({b.circle(2, 1)})});
  b.face(plane, {b.bound({b.circle(3, 0)})});
  b.face(plane, {b.bound({b.circle(5, 0, 10)})});
  const File file = b.file();
  const auto others = other_surfaces(file.model());
  const auto all = exact_splines(file.model());
  ASSERT_EQ(others.size(), 2U);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].error().message(), exact_spline(file.model(), others[0].id).error().message());
  const auto alone = exact_spline(file.model(), others[1].id);
  ASSERT_TRUE(all[1] && alone);
  EXPECT_EQ(all[1]->control_points(), alone->control_points());
  EXPECT_GT(all[1]->control_points().cwiseAbs().maxCoeff(), 14.9);  // of both faces
}

}  // namespace
}  // namespace knead::step
