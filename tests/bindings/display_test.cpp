#include "scene/display.hpp"

#include <gtest/gtest.h>

#include <set>

#include "studio_picture.hpp"

namespace knead::studio {
namespace {

/// The unit square in z = height (x), with 2 × 2 control points and degree 1.
Surface plane(double slope) {
  Points points(4, 3);
  points << 0, 0, 0, 0, 1, 0, 1, 0, slope, 1, 1, slope;
  const KnotVector knots = *KnotVector::create(1, {0, 0, 1, 1});
  return *Surface::create({knots, knots}, points);
}

Scene scene_of(const Surface& opened, const Surface& current) {
  Scene scene;
  SceneSurface s;
  s.id = "#1";
  s.opened = s.reference = s.rest = std::make_shared<const Surface>(opened);
  s.current = std::make_shared<const Surface>(current);
  scene.surfaces.push_back(std::move(s));
  return scene;
}

using Given = std::vector<std::pair<std::string, std::vector<double>>>;

std::vector<float> values(const Scene& scene, const std::string& name, bool opened = false,
                          const Given& settings = {}) {
  auto display = asked_display(name, settings);
  if (!display) {
    ADD_FAILURE() << display.error().message();
    return {};
  }
  PictureMaker pictures;
  PictureOptions options;
  options.detail = 3;
  options.display = *std::move(display);
  options.opened = opened;
  const auto made = pictures.make(scene, 0, options);
  EXPECT_TRUE(made.has_value());
  return pictures.picture().values;
}

void expect_all(const std::vector<float>& found, double expected) {
  EXPECT_FALSE(found.empty());
  for (const float x : found) EXPECT_NEAR(x, expected, 1e-5);
}

TEST(Display, HasANameOfItsOwnAndADescription) {
  std::set<std::string_view> names;
  for (const Display& d : displays()) {
    EXPECT_TRUE(names.insert(d.name).second) << d.name;
    EXPECT_FALSE(d.title.empty() || d.unit.empty() || d.help.empty()) << d.name;
    EXPECT_EQ(d.is_signed, d.palette == DisplayPalette::diverging) << d.name;
    EXPECT_NE(d.values, nullptr) << d.name;
    if (d.limits) {
      EXPECT_LT((*d.limits)[0], (*d.limits)[1]) << d.name;
    }
    for (const DisplaySetting& s : d.settings)
      EXPECT_TRUE(s.value.size() == 1 || s.value.size() == 3) << s.name;
  }
}

TEST(Display, ThatDoesNotExistIsAnError) {
  EXPECT_TRUE(find_display("draft").has_value());
  const auto none = find_display("beauty");
  ASSERT_FALSE(none.has_value());
  EXPECT_NE(none.error().remedy.find("deviation"), std::string::npos);
  EXPECT_FALSE(asked_display("", {}).has_value());
}

TEST(DisplaySettings, AreThoseGivenAndTheDefaultsOfTheOthers) {
  const Display& draft = **find_display("draft");
  EXPECT_EQ(*display_settings(draft, {}), (std::vector<std::vector<double>>{{0, 0, 1}}));
  const std::vector<std::pair<std::string, std::vector<double>>> given = {{"direction", {1, 2, 3}}};
  EXPECT_EQ(*display_settings(draft, given), (std::vector<std::vector<double>>{{1, 2, 3}}));
  for (const std::vector<double>& wrong : {std::vector<double>{}, {1}, {1, 2, NAN}}) {
    const std::vector<std::pair<std::string, std::vector<double>>> bad = {{"direction", wrong}};
    EXPECT_EQ(display_settings(draft, bad).error().where, "settings.direction");
  }
  const std::vector<std::pair<std::string, std::vector<double>>> unknown = {{"axis", {0, 0, 1}}};
  EXPECT_EQ(display_settings(draft, unknown).error().where, "settings.axis");
}

TEST(DraftAngle, IsThatOfThePlaneAgainstTheDirectionOfThePull) {
  const Surface inclined = plane(1);  // its normal is (-1, 0, 1) / √2
  const Scene scene = scene_of(inclined, inclined);
  expect_all(values(scene, "draft"), 45);
  expect_all(values(scene, "draft", false, {{"direction", {0, 0, -2}}}), -45);
  expect_all(values(scene, "draft", false, {{"direction", {-1, 0, 1}}}), 90);
  expect_all(values(scene, "draft", false, {{"direction", {0, 1, 0}}}), 0);
}

TEST(Deviation, IsTheDistanceFromTheShapeAsOpenedWithTheSideOfTheNormal) {
  const Surface flat = plane(0);
  Points raised = flat.control_points();
  raised.col(2).array() += 0.25;
  const Surface above = *flat.with_control_points(raised);
  expect_all(values(scene_of(flat, above), "deviation"), 0.25);
  expect_all(values(scene_of(above, flat), "deviation"), -0.25);
  expect_all(values(scene_of(flat, above), "deviation", true), 0);
}

/// The plane in 30 spans along x, so that it is drawn by as many lines.
Surface plane_in_spans(double slope) {
  const KnotVector along = *KnotVector::clamped_uniform(1, 31),
                   across = *KnotVector::create(1, {0, 0, 1, 1});
  Points points(62, 3);
  for (int i = 0; i < 62; ++i) {
    const double x = (i / 2) / 30.0;
    points.row(i) << x, i % 2, slope * x;
  }
  return *Surface::create({along, across}, points);
}

/// The range of deviations of a plane that was inclined by `slope`, as far as it is visible.
DisplayRange range_of_inclined(double slope, std::shared_ptr<const VisibleRegion> visible) {
  const Scene scene = scene_of(plane_in_spans(0), plane_in_spans(slope));
  PictureMaker pictures;
  PictureOptions options;
  options.detail = 30;
  options.display = *asked_display("deviation", {});
  options.visible = std::move(visible);
  EXPECT_TRUE(pictures.make(scene, 0, options).has_value());
  return pictures.range().value_or(DisplayRange{});
}

TEST(DisplayRange, HoldsTheValuesOfWhatIsVisible) {
  const DisplayRange whole = range_of_inclined(4, nullptr);
  EXPECT_NEAR(whole.greatest, 4, 1e-12);
  EXPECT_NEAR(whole.upper, 4, 1e-12);
  EXPECT_NEAR(whole.lower, -4, 1e-12);
  EXPECT_NEAR(whole.least, 0, 1e-12);
  VisibleRegion region;  // its strip below x = 0.6
  region.faces = {{{{0, 0}, {0.6, 0}, {0.6, 1}, {0, 1}}}};
  const DisplayRange strip = range_of_inclined(4, std::make_shared<const VisibleRegion>(region));
  // Every third line is asked: exact to two of the 30.
  EXPECT_NEAR(strip.greatest, 0.6 * 4, 2 * 4 / 30.0 + 1e-12);
  region.faces = {{{{0.61, 0.4}, {0.62, 0.4}, {0.62, 0.6}, {0.61, 0.6}}}};  // between all lines
  EXPECT_NEAR(range_of_inclined(4, std::make_shared<const VisibleRegion>(region)).greatest, 4,
              1e-12);
}

TEST(DisplayRange, IsOneRangeForAllSurfacesAndBeginsAnewWithTheFirst) {
  Scene scene = scene_of(plane(0), plane(1));
  scene.surfaces.push_back(scene_of(plane(0), plane(-3)).surfaces[0]);
  PictureMaker pictures;
  PictureOptions options;
  EXPECT_TRUE(pictures.make(scene, 0, options).has_value());
  EXPECT_FALSE(pictures.range().has_value());  // without a display
  options.display = *asked_display("deviation", {});
  for (int surface : {0, 1}) EXPECT_TRUE(pictures.make(scene, surface, options).has_value());
  EXPECT_NEAR(pictures.range()->least, -3, 1e-12);
  EXPECT_NEAR(pictures.range()->upper, 3, 1e-12);
  EXPECT_TRUE(pictures.make(scene, 0, options).has_value());
  EXPECT_NEAR(pictures.range()->upper, 1, 1e-12);
}

TEST(DisplayRange, OfADisplayWithLimitsIsThatOfTheDisplay) {
  const DisplayRange range = [] {
    PictureMaker pictures;
    PictureOptions options;
    options.display = *asked_display("draft", {});
    EXPECT_TRUE(pictures.make(scene_of(plane(1), plane(1)), 0, options).has_value());
    return *pictures.range();
  }();
  EXPECT_EQ(range.lower, -3);
  EXPECT_EQ(range.upper, 3);
  EXPECT_NEAR(range.greatest, 45, 1e-10);
}

TEST(Gap, IsTheDistanceToTheNearestToolAndZeroWithoutOne) {
  Scene scene = scene_of(plane(0), plane(0));
  expect_all(values(scene, "gap"), 0);
  Tool tool{"plane", *PlacedShape::create(PlaneShape{}, {.position = Point(0, 0, -2)})};
  scene.tools.push_back(tool);
  expect_all(values(scene, "gap"), 2);
}

TEST(Picture, HasNoValuesWithoutADisplay) {
  const Scene scene = scene_of(plane(0), plane(0));
  EXPECT_TRUE(values(scene, "none").empty());
}

}  // namespace
}  // namespace knead::studio
