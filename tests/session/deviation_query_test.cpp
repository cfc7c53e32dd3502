// How far data are from a document that stays as it is.
#include "session/queries/deviation.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "knead/exchange/file_io.hpp"
#include "knead/exchange/format.hpp"
#include "session/running.hpp"
#include "support/made_files.hpp"

namespace knead {
namespace {

using testing::opened;
using testing::run_on;
using testing::two_sheets;

/// The numbers of an answer.
std::vector<double> numbers(const Bytes& bytes) {
  std::vector<double> result(bytes.data.size() / sizeof(double));
  std::memcpy(result.data(), bytes.data.data(), result.size() * sizeof(double));
  return result;
}

/// 10 × 10 at z = 0.
Session plate() {
  auto session = Session(Document::fresh("plate", "mm"));
  EXPECT_TRUE(run_on(session, R"({"do":"new","size":[10,10],"net":[6,6]})"));
  return session;
}

DataDeviation answer(const Session& session, const DeviationQuery& query) {
  auto found = ask(session, query);
  EXPECT_TRUE(found) << found.error().message();
  return found ? *std::move(found) : DataDeviation();
}

TEST(DeviationQuery, DistancesOfAScanAreAlongTheNormalAndTheOthersSayWhyTheyAreNone) {
  const Session session = plate();
  const std::string before = *session.save();
  DeviationQuery query;
  // Above, below, far, beside the border, and facing along the plate.
  query.data.scan.data =
      "5 5 0.05 0 0 1\n2 3 -0.02 0 0 1\n4 4 3 0 0 1\n10.06 5 0.01 0 0 1\n6 6 0.01 1 0 0\n";
  const DataDeviation found = answer(session, query);
  EXPECT_EQ(found.unit, "mm");
  EXPECT_EQ(found.points, 5);
  EXPECT_EQ(found.used, 2);
  EXPECT_EQ(found.left_out, 1);
  EXPECT_EQ(found.beyond_border, 1);
  EXPECT_EQ(found.turned_away, 1);
  EXPECT_EQ(found.states.data, std::string({0, 0, 1, 2, 3}));
  EXPECT_NEAR(found.reach, 0.1 * std::sqrt(2), 1e-12) << "1 % of the box";
  const auto distances = numbers(found.distances), feet = numbers(found.feet),
             wanted = numbers(found.wanted), normals = numbers(found.normals);
  ASSERT_EQ(distances.size(), 5U);
  const double sense = normals[2];  // of the plate's normal
  EXPECT_NEAR(std::abs(sense), 1, 1e-12);
  EXPECT_NEAR(distances[0], 0.05 * sense, 1e-9);
  EXPECT_NEAR(distances[1], -0.02 * sense, 1e-9);
  EXPECT_EQ(distances[2], 0);
  EXPECT_NEAR(feet[0], 5, 1e-6);
  EXPECT_NEAR(feet[2], 0, 1e-12);
  EXPECT_NEAR(wanted[2], 0.05, 1e-9);
  EXPECT_NEAR(numbers(found.places)[8], 3, 1e-15) << "also of points that are left out";
  EXPECT_NEAR(found.deviation.rms, std::sqrt((0.05 * 0.05 + 0.02 * 0.02) / 2), 1e-9);
  EXPECT_NEAR(found.deviation.largest, 0.05, 1e-9);
  EXPECT_EQ(*session.save(), before);
}

// Whatever the senses of its surfaces and faces: a map that blows a block up leads outward.
TEST(DeviationQuery, DistancesArePositiveOutsideOfASolid) {
  const auto source = open_source(testing::block_file(), "block.step");
  ASSERT_TRUE(source) << source.error().message();
  const Session session(Document::from(*source));
  DeviationQuery query;
  query.request.space = "0.01*(x-2); 0.01*(y-1); 0.01*(z-0.5)";
  const DataDeviation found = answer(session, query);
  ASSERT_GT(found.used, 0);
  const auto distances = numbers(found.distances);
  EXPECT_GT(std::ranges::min(distances), 0);
}

TEST(DeviationQuery, DisplacementsAreUnscaledInTheUnitOfTheModel) {
  const Session session = plate();
  DeviationQuery query;
  query.data.vectors.data = "0.5 0.5 0 0.01 0 0.02\n0.2 0.3 0 0 0 -0.01\n9 9 9 0 0 1\n";
  query.request.settings.unit = "cm";
  query.request.settings.scale = -1;
  const DataDeviation found = answer(session, query);
  EXPECT_EQ(found.used, 2);
  EXPECT_EQ(found.left_out, 1);
  const auto wanted = numbers(found.wanted), distances = numbers(found.distances);
  EXPECT_NEAR(wanted[0], 0.1, 1e-12);
  EXPECT_NEAR(wanted[2], 0.2, 1e-12);
  EXPECT_NEAR(std::abs(distances[0]), 0.2, 1e-9);
  EXPECT_NEAR(distances[1] / distances[0], -0.5, 1e-9);
  query.request.along = "normal";
  EXPECT_NEAR(numbers(answer(session, query).wanted)[0], 0, 1e-12);
}

TEST(DeviationQuery, OfAMapOfSpaceThePointsAreTheFeet) {
  const Session session = plate();
  DeviationQuery query;
  query.request.space = "0; 0; 0.25";
  const DataDeviation found = answer(session, query);
  EXPECT_EQ(found.places.data, found.feet.data);
  EXPECT_GT(found.points, 100);
  EXPECT_NEAR(found.deviation.rms, 0.25, 1e-12);
}

TEST(DeviationQuery, AnAlignedScanOfTheModelItselfLiesOnIt) {
  Session session = opened(two_sheets());
  ASSERT_TRUE(run_on(session, R"({"do":"morph","space":"0; 0; 0.2*sin(2*x)*y + 0.1*x*x"})"));
  const Surface& sheet = *session.state().surfaces[0].current;
  DeviationQuery query;
  for (int k = 0; k < 20; ++k) {
    for (int l = 0; l < 20; ++l) {
      const Interval u = sheet.knots(0).domain(), v = sheet.knots(1).domain();
      const auto p = evaluate_point<2>(
          sheet, {u.lower + (k + 0.5) / 20 * u.length(), v.lower + (l + 0.5) / 20 * v.length()});
      ASSERT_TRUE(p);
      // Turned by 90° about z, and moved.
      query.data.scan.data += fmt::format("{} {} {}\n", -p->y() + 3, p->x() - 1, p->z() + 2);
    }
  }
  query.request.settings.reach = 0.5;
  query.request.settings.align = true;
  const DataDeviation found = answer(session, query);
  ASSERT_TRUE(found.alignment);
  EXPECT_GT(found.used, 360);
  EXPECT_LT(found.deviation.rms, 0.02);
  EXPECT_LT(found.alignment->rms_after, found.alignment->rms_before);
}

TEST(DeviationQuery, ErrorsNameTheField) {
  const Session session = plate();
  const auto refused = [&](DeviationQuery query) {
    const auto found = ask(session, query);
    EXPECT_FALSE(found);
    return found ? std::string() : found.error().message();
  };
  EXPECT_NE(refused({}).find("vectors"), std::string::npos);
  DeviationQuery query;
  query.data.scan.data = "5 5 x\n";
  EXPECT_NE(refused(query).find("scan"), std::string::npos);
  query.data.scan.data = "5 5 3\n6 6 3\n1 2 3\n";
  EXPECT_NE(refused(query).find("none of 3 points"), std::string::npos);
  query.request.settings.reach = -1;
  EXPECT_NE(refused(query).find("reach"), std::string::npos);
}

}  // namespace
}  // namespace knead
