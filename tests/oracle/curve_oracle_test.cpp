#include <gtest/gtest.h>

#include "knead/exchange/file_io.hpp"
#include "knead/exchange/format.hpp"
#include "knead/spline/evaluate.hpp"
#include "oracle/occt_curves.hpp"
#include "session/support.hpp"

namespace knead::oracle {
namespace {

using testing::fresh;
using testing::run;
using testing::same_bits;

OcctCurves read_saved(const Session& session, const std::string& name) {
  const auto bytes = session.save();
  if (!bytes) ADD_FAILURE() << bytes.error().message();
  const std::string path = ::testing::TempDir() + name;
  EXPECT_TRUE(write_file_atomically(path, *bytes));
  return occt_curves(path);
}

const std::vector<std::string> three_curves = {
    R"({"do":"new","shape":"curve","form":"circle","radius":3})",
    R"({"do":"force","at":[0.3],"to":[0,5,1],"strength":20})",
    R"({"do":"step","count":3})",
    R"({"do":"new","shape":"curve","form":"helix","radius":4,"height":9,"net":30})",
    R"({"do":"new","shape":"curve","degree":5,"net":9,"size":7})",
    R"({"do":"pin","at":[0.4],"to":[3,1,1]})",
    R"({"do":"step"})"};

void expect_its_curves(const Session& session, const OcctCurves& read) {
  EXPECT_EQ(read.warnings, 0);
  std::size_t k = 0;
  for (const SceneBody& body : session.state().bodies) {
    const auto* curve = std::get_if<SceneCurve>(&body);
    if (curve == nullptr) continue;
    ASSERT_LT(k, read.curves.size());
    const Curve &ours = *curve->current, &theirs = read.curves[k++];
    for (int i = 0; i <= 100; ++i) {
      EXPECT_NEAR(
          (*evaluate_point<1>(ours, {i / 100.}) - *evaluate_point<1>(theirs, {i / 100.})).norm(), 0,
          1e-14);
    }
    if (curve->name == "circle")
      continue;  // closed, which makes it periodic in Open CASCADE: on other knots
    EXPECT_TRUE(same_bits(ours.control_points(), theirs.control_points())) << curve->name;
    EXPECT_TRUE(std::ranges::equal(ours.weights(), theirs.weights())) << curve->name;
    EXPECT_EQ(ours.knots(), theirs.knots()) << curve->name;
  }
  EXPECT_EQ(k, read.curves.size());
}

TEST(CurveOracle, ReadsCurvesAloneToTheBit) {
  Session session = fresh();
  run(session, three_curves);
  const OcctCurves read = read_saved(session, "curves.step");
  expect_its_curves(session, read);
  EXPECT_EQ(read.faces, 0);
}

TEST(CurveOracle, ReadsAFileWhoseCurvesWereSculptedWhereTheyStand) {
  Session made = fresh();
  run(made, three_curves);
  auto source = open_source(*made.save(), "curves.step");
  ASSERT_TRUE(source);
  Session session(Document::from(*std::move(source)));
  ASSERT_EQ(session.state().bodies.size(), 3U);
  for (const SceneBody& b : std::vector<SceneBody>(session.state().bodies)) {
    run(session,
        {R"({"do":"select","body":")" + common_of(b).id + R"("})",
         R"({"do":"edge","which":"u0","hold":"position"})",
         R"({"do":"force","at":[0.6],"to":[1,1,8],"strength":30})", R"({"do":"step","count":2})"});
  }
  run(session, {R"({"do":"refine"})"});
  const OcctCurves read = read_saved(session, "sculpted_curves.step");
  expect_its_curves(session, read);
  EXPECT_EQ(read.faces, 0);
}

TEST(CurveOracle, ReadsThemBesideSurfacesAndTheSidesOfVolumes) {
  Session session = fresh();
  run(session, three_curves);
  run(session,
      {R"({"do":"new","shape":"volume","form":"cylinder"})", R"({"do":"new","shape":"torus"})"});
  const OcctCurves read = read_saved(session, "mixed.step");
  expect_its_curves(session, read);
  EXPECT_EQ(read.faces, 7);
}

}  // namespace
}  // namespace knead::oracle
