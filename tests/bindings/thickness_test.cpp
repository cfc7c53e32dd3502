#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "exchange/face_builder.hpp"
#include "knead/brep/face_conversion.hpp"
#include "knead/exchange/format.hpp"
#include "knead/spline/revolution.hpp"
#include "studio_picture.hpp"
#include "studio_trims.hpp"

namespace knead::studio {
namespace {

using testing::FaceBuilder;

Scene scene_of(const std::vector<DocumentSurface>& surfaces) {
  Scene scene;
  for (const DocumentSurface& from : surfaces) {
    SceneSurface& s = scene.surfaces.emplace_back();
    s.id = from.id;
    s.opened = s.reference = s.rest = s.current = from.surface;
  }
  return scene;
}

Scene scene_of(const std::vector<Surface>& surfaces) {
  std::vector<DocumentSurface> named;
  for (const Surface& s : surfaces) {
    DocumentSurface& to = named.emplace_back();
    to.id = "#" + std::to_string(named.size());
    to.surface = std::make_shared<const Surface>(s);
  }
  return scene_of(named);
}

/// Of every grid point of a surface; not a number where there is none.
std::vector<double> thicknesses(PictureMaker& pictures, const Scene& scene, int surface,
                                std::shared_ptr<const Surroundings> around = {}) {
  PictureOptions options;
  options.detail = 16;
  options.display = *asked_display("thickness", {});
  options.around = std::move(around);
  EXPECT_TRUE(pictures.make(scene, surface, options).has_value());
  std::vector<double> result;
  for (const float x : pictures.picture().values) {
    result.push_back(x == no_value ? std::numeric_limits<double>::quiet_NaN() : x);
  }
  return result;
}

void expect_between(const std::vector<double>& found, double least, double most) {
  EXPECT_FALSE(found.empty());
  for (const double x : found) {
    EXPECT_GE(x, least);
    EXPECT_LE(x, most);
  }
}

void expect_none(const std::vector<double>& found) {
  EXPECT_FALSE(found.empty());
  for (const double x : found) EXPECT_TRUE(std::isnan(x)) << x;
}

/// z = height over the unit square in 8 × 8 spans, its normal up.
Surface plate(double height) {
  const KnotVector knots = *KnotVector::clamped_uniform(1, 9);
  Points points(81, 3);
  for (int k = 0; k < 81; ++k) points.row(k) << (k / 9) / 8.0, (k % 9) / 8.0, height;
  return *Surface::create({knots, knots}, points);
}

TEST(Thickness, OfParallelPlatesIsTheirDistance) {
  const Scene scene = scene_of(std::vector{plate(0.25), plate(0), plate(-3)});
  PictureMaker pictures;
  expect_between(thicknesses(pictures, scene, 0), 0.25 - 1e-6, 0.25 + 1e-6);
  expect_between(thicknesses(pictures, scene, 1), 3 - 1e-6, 3 + 1e-6);
  expect_none(thicknesses(pictures, scene, 2));
}

TEST(Thickness, HasNoValueWhereNothingIsBehindOrWhatIsThereIsTrimmedAway) {
  const Scene scene = scene_of(std::vector{plate(1), plate(0)});
  VisibleRegion region;  // of the lower one, the strip x < 0.4
  region.faces = {{{{0, 0}, {0.4, 0}, {0.4, 1}, {0, 1}}}};
  auto around = std::make_shared<Surroundings>();
  around->shown["#2"] = {std::make_shared<const VisibleRegion>(region), 1};
  PictureMaker pictures;
  const auto found = thicknesses(pictures, scene, 0, around);
  const Picture& picture = pictures.picture();
  int some = 0;
  for (std::size_t k = 0; k < picture.s.size(); ++k) {
    for (std::size_t l = 1; l + 1 < picture.t.size(); ++l) {
      const double x = found[k * static_cast<std::size_t>(picture.counts[1]) + l];
      if (picture.s[k] == 0) continue;  // on the bound
      const bool over = picture.s[k] < 0.4F;
      some += over ? 1 : 0;
      EXPECT_EQ(std::isnan(x), !over) << picture.s[k];
      if (!over) continue;
      EXPECT_NEAR(x, 1, 1e-6);
    }
  }
  EXPECT_GT(some, 10);
}

TEST(Thickness, IsMeasuredOnTheSideOfTheMaterial) {
  const Scene scene = scene_of(std::vector{plate(1), plate(0)});
  auto around = std::make_shared<Surroundings>();
  around->shown["#1"] = {nullptr, -1};  // its material is above
  PictureMaker pictures;
  expect_none(thicknesses(pictures, scene, 0, around));
  auto other = std::make_shared<Surroundings>();
  other->shown["#2"] = {nullptr, -1};
  expect_between(thicknesses(pictures, scene, 1, other), 1 - 1e-6, 1 + 1e-6);
}

TEST(Thickness, OfAPartOfAnAssemblyDoesNotSeeOtherParts) {
  const Scene scene = scene_of(std::vector{plate(1), plate(0.6), plate(0)});
  FaceMesh below;  // seen from above it faces away
  below.id = "#9";
  below.points = {{-100, -100, 0.8}, {100, -100, 0.8}, {0, 200, 0.8}};
  below.normals.assign(3, -Point::UnitZ());
  below.triangles = {{0, 2, 1}};
  for (const std::size_t part : {std::size_t{0}, std::size_t{1}}) {
    auto around = std::make_shared<Surroundings>();
    around->faces = {below};
    around->parts = {{"#2", 1}, {"#9", part}};
    PictureMaker pictures;
    const double first = part == 0 ? 0.2 : 1;
    expect_between(thicknesses(pictures, scene, 0, around), first - 1e-6, first + 1e-6);
    expect_none(thicknesses(pictures, scene, 1, around));
  }
}

TEST(Thickness, FollowsWhatMoves) {
  Scene scene = scene_of(std::vector{plate(1), plate(0)});
  PictureMaker pictures;
  expect_between(thicknesses(pictures, scene, 0), 1 - 1e-6, 1 + 1e-6);
  scene.surfaces[1].current = std::make_shared<const Surface>(plate(0.5));
  expect_between(thicknesses(pictures, scene, 0), 0.5 - 1e-6, 0.5 + 1e-6);
  scene.surfaces[0].current = std::make_shared<const Surface>(plate(2));
  expect_between(thicknesses(pictures, scene, 0), 1.5 - 1e-6, 1.5 + 1e-6);
}

TEST(Thickness, OfASphereIsItsDiameter) {
  const double r = 5;
  const Scene scene = scene_of(std::vector{*revolve(*circle_quarters({0, 0}, r, 3, 2))});
  auto around = std::make_shared<Surroundings>();
  PictureMaker pictures;
  std::size_t none = 0;
  for (const int sense : {1, -1}) {
    around = std::make_shared<Surroundings>();
    around->shown["#1"] = {nullptr, sense};
    auto found = thicknesses(pictures, scene, 0, around);
    if (std::isnan(found[found.size() / 2])) {
      ++none;
      expect_none(found);
      continue;
    }
    // At a pole the normal is that of the next grid point inside.
    const auto& positions = pictures.picture().positions;
    for (std::size_t k = found.size(); k-- > 0;) {
      if (std::abs(positions[3 * k + 2]) < 0.999 * r) continue;
      EXPECT_NEAR(found[k], 2 * r, 0.02 * r);
      found.erase(found.begin() + static_cast<std::ptrdiff_t>(k));
    }
    // The triangles of the far side are inside it, by 2.5e-4 of the diagonal of the box at most.
    expect_between(found, 2 * r - 2.5e-4 * std::sqrt(12.0) * r, 2 * r + 1e-5);
  }
  EXPECT_EQ(none, 1U);  // one of the senses has the material outside
}

/// A pipe round the z axis: cylinders of the radii 5 and 3, flat rings at z = 0 and 10.
step::File pipe() {
  FaceBuilder b;
  std::array<std::array<int, 2>, 2> rims{};  // [outer, inner][below, above]
  std::array<int, 2> walls{};
  const std::array radii = {5.0, 3.0};
  for (std::size_t w = 0; w < 2; ++w) {
    rims[w] = {b.circle(radii[w], 0), b.circle(radii[w], 10)};
    walls[w] = b.entity("CYLINDRICAL_SURFACE('',#" + std::to_string(b.frame()) + "," +
                        FaceBuilder::real(radii[w]) + ")");
  }
  const int below = b.entity("PLANE('',#" + std::to_string(b.frame()) + ")");
  const int above = b.entity("PLANE('',#" + std::to_string(b.frame(0, 0, 10)) + ")");
  const std::vector<int> faces = {
      b.face(walls[0], {b.bound({rims[0][0]}), b.bound({-rims[0][1]})}),
      b.face(walls[1], {b.bound({-rims[1][0]}), b.bound({rims[1][1]})}, false),
      b.face(above, {b.bound({rims[0][1]}), b.bound({-rims[1][1]})}),
      b.face(below, {b.bound({-rims[0][0]}), b.bound({rims[1][0]})}, false)};
  b.entity("CLOSED_SHELL('',(" + FaceBuilder::list_of(faces) + "))");
  return b.file();
}

/// A document of a file, some of whose surfaces have been made splines.
Document converted(const step::File& file, const std::vector<std::string>& surfaces) {
  auto source = open_source(file.bytes(), "pipe.step");
  EXPECT_TRUE(source.has_value());
  auto document = Document::from(*std::move(source)).with_splines(surfaces);
  EXPECT_TRUE(document.has_value());
  return *std::move(document);
}

TEST(Thickness, OfAPipeIsItsWallWhicheverOfItsFacesAreSplines) {
  const step::File file = pipe();
  const auto all = brep::other_surfaces(file.model());
  ASSERT_EQ(all.size(), 4U);
  const double chord = 2.5e-4 * std::sqrt(300.0) + 5e-4 * 5;
  for (const bool both : {false, true}) {
    std::vector<std::string> ids = {all[0].id};
    if (both) ids.push_back(all[1].id);
    const Document document = converted(file, ids);
    ASSERT_EQ(document.surfaces().size(), ids.size());
    ShownParts shown;
    const auto around = shown.around(document);
    ASSERT_TRUE(around);
    EXPECT_EQ(around->faces.size(), both ? 2U : 3U);
    const Scene scene = scene_of(document.surfaces());
    PictureMaker pictures;
    for (int surface = 0; surface < static_cast<int>(ids.size()); ++surface) {
      auto found = thicknesses(pictures, scene, surface, around);
      // Beyond the rings, and along them, there is no material.
      std::erase_if(found, [](double x) { return std::isnan(x); });
      EXPECT_GT(found.size(), 50U);
      expect_between(found, 2 - chord, 2 + chord);
    }
  }
}

TEST(ShownParts, AreFoundAnewAfterAConversion) {
  const step::File file = pipe();
  const auto all = brep::other_surfaces(file.model());
  ASSERT_EQ(all.size(), 4U);
  const Document one = converted(file, {all[0].id}), two = converted(file, {all[0].id, all[1].id});
  ShownParts shown;
  EXPECT_EQ(shown.trims(one).size(), 1U);
  EXPECT_EQ(shown.around(one)->faces.size(), 3U);
  EXPECT_EQ(shown.trims(two).size(), 2U);
  EXPECT_EQ(shown.around(two)->faces.size(), 2U);
  EXPECT_EQ(shown.trims(one).size(), 1U) << "undone";
  EXPECT_EQ(shown.around(one)->faces.size(), 3U);
}

TEST(Thickness, OfARealSolidIsSomeLengthAtEveryPoint) {
  const auto path = testing::foreign_cad("MAINBODY_BACK.stp");
  KNEAD_NEEDS(path);
  const auto document = Document::open(path);
  ASSERT_TRUE(document.has_value());
  const Scene scene = scene_of(document->surfaces());
  ShownParts shown;
  const auto around = shown.around(*document);
  ASSERT_TRUE(around);
  EXPECT_FALSE(around->faces.empty());
  Eigen::AlignedBox3d box;
  for (const FaceMesh& face : around->faces) {
    for (const Point& p : face.points) box.extend(p);
  }
  for (const SceneSurface& s : scene.surfaces) {
    const Points& net = s.opened->control_points();
    for (Eigen::Index k = 0; k < net.rows(); ++k) box.extend(Point(net.row(k).transpose()));
  }
  PictureMaker pictures;
  for (int surface = 0; surface < static_cast<int>(scene.surfaces.size()); ++surface) {
    const auto found = thicknesses(pictures, scene, surface, around);
    expect_between(found, 0, box.diagonal().norm());  // no value would be neither
    // Most of it is a wall, not a chance hit at the start.
    const auto thin =
        std::ranges::count_if(found, [&](double x) { return x < 1e-3 * box.diagonal().norm(); });
    EXPECT_LT(static_cast<double>(thin), 0.2 * static_cast<double>(found.size()));
  }
}

}  // namespace
}  // namespace knead::studio
