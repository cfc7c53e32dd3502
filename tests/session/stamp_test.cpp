// The brush that presses a pattern or a shape as a height.
#include <gtest/gtest.h>

#include <numbers>

#include "brushes.hpp"

namespace knead::testing {
namespace {

constexpr double stamp_radius = 50, stamp_height = 3;
const double half_side = stamp_radius / std::numbers::sqrt2;

/// A row of bumps that grow towards the upper right corner.
double pattern_at(double xi, double eta) {
  return 0.25 * (2 + xi + 0.5 * eta) * 0.5 * (1 + std::cos(2 * std::numbers::pi * xi));
}
std::string rows(int count) {
  std::string text;
  for (int k = 0; k < count; ++k) {
    text += k == 0 ? "[" : ",[";
    for (int l = 0; l < count; ++l) {
      text += fmt::format("{}{:.6f}", l == 0 ? "" : ",",
                          pattern_at(-1 + 2. * l / (count - 1), 1 - 2. * k / (count - 1)));
    }
    text += "]";
  }
  return "[" + text + "]";
}
std::string stamp(const std::string& more, const Point& at) {
  return dab(
      fmt::format(R"("kind":"stamp","radius":{},"height":{},{})", stamp_radius, stamp_height, more),
      at);
}
double height_at(const Session& session, double x, double y) {
  return on(shape(session), x, y).z();
}

TEST(Stamp, IsAsHighAsItsPattern) {
  const Point place(103, 97, 0);
  double before = 1;
  for (const int net : {48, 96, 144}) {
    Session session = flat(net);
    run(session, {stamp(R"("core":0.8,"pattern":)" + rows(81), place)});
    double worst = 0;
    for (int i = -40; i <= 40; ++i) {
      for (int j = -40; j <= 40; ++j) {
        const double xi = i / 40., eta = j / 40.;
        const double asked = stamp_height * stamp_rim(xi, eta, 0.8) * pattern_at(xi, eta);
        worst = std::max(worst, std::abs(height_at(session, place.x() + half_side * xi,
                                                   place.y() + half_side * eta) -
                                         asked));
      }
    }
    EXPECT_LT(worst, before * stamp_height) << "finer nets are nearer";
    before = worst / stamp_height;
    const double beyond = stamp_radius + 2.1 * side / (net - 3);
    EXPECT_EQ(height_at(session, place.x() + beyond, place.y()), 0);
    EXPECT_EQ(height_at(session, place.x(), place.y() - beyond), 0);
  }
  EXPECT_LT(before, 0.01) << "a bump is 25 spans wide, and its rim five";
}

TEST(Stamp, TurnsAndIsMirrored) {
  const std::string ramp = R"("pattern":[[0,1],[0,1]])";
  Session along = flat(64), turned = flat(64);
  run(along, {stamp(ramp, {100, 100, 0})});
  run(turned, {stamp(R"("angle":90,)" + ramp, {100, 100, 0})});
  EXPECT_GT(height_at(along, 115, 100), 2 * height_at(along, 85, 100));
  for (const auto& [x, y] : {std::pair{15., 5.}, {-12., 7.}, {20., -20.}}) {
    EXPECT_NEAR(height_at(along, 100 + x, 100 + y), height_at(turned, 100 - y, 100 + x), 1e-9);
  }
  Session mirrored = flat(64);
  run(mirrored, {stamp(R"("angle":30,"mirror":[[100,0,0],[1,0,0]],)" + ramp, {60, 100, 0})});
  EXPECT_GT(height_at(mirrored, 75, 105), 0.5);
  for (const auto& [x, y] : {std::pair{60., 100.}, {75., 105.}, {50., 85.}}) {
    EXPECT_NEAR(height_at(mirrored, x, y), height_at(mirrored, 200 - x, y), 1e-9);
  }
}

TEST(Stamp, IsTheShapeOfATool) {
  const double wide = 0.75 * half_side;  // as far as the core
  const Point place(100, 100, 0);
  Session ball = flat(96), ring = flat(96), block = flat(96);
  run(ball, {stamp(R"("shape":"sphere")", place)});
  run(ring, {stamp(R"("shape":"torus")", place)});
  run(block, {stamp(R"("shape":"box")", place)});
  for (const double share : {0., 0.3, 0.6, 0.75}) {
    EXPECT_NEAR(height_at(ball, 100 + share * wide, 100),
                stamp_height * std::sqrt(1 - share * share), 0.02 * stamp_height)
        << share;
    EXPECT_NEAR(height_at(block, 100, 100 - share * wide), stamp_height, 0.02 * stamp_height)
        << share;
  }
  EXPECT_NEAR(height_at(ring, 100, 100 + 0.8 * wide), stamp_height, 0.03 * stamp_height)
      << "the crest of the tube";
  EXPECT_NEAR(height_at(ring, 100, 100), 0, 0.01 * stamp_height) << "the hole";
  for (const Session* session : {&ball, &ring, &block})
    EXPECT_NEAR(height_at(*session, 100 + 1.15 * wide, 100), 0, 0.02 * stamp_height);
}

TEST(Stamp, IsOneActThatSnapshotsKeep) {
  Session session = flat(48);
  const Surface before = shape(session);
  const std::string fields = fmt::format(
      R"({{"do":"brush","kind":"stamp","radius":{},"pattern":[[0,1],[1,0]],)", stamp_radius);
  run(session, {fields + R"("path":[[0.5,0.5]],"angle":0,"open":true})",
                fields + R"("path":[],"angle":40,"open":true})"});
  session.join();
  auto again = Session::restore(Document::fresh("sheet"), session.snapshot(1 << 20));
  ASSERT_TRUE(again) << again.error().message();
  for (Session* s : {&session, &*again}) run(*s, {fields + R"("path":[],"angle":50})"});
  EXPECT_TRUE(same_bits(shape(session), shape(*again)));
  EXPECT_FALSE(same_bits(shape(session), before));
}

TEST(Stamp, SaysWhatIsWrong) {
  Session session = flat(48);
  const auto error = [&](const std::string& more) {
    const auto command = parse_command(stamp(more, {100, 100, 0}));
    const auto status = command ? session.execute(*command) : std::unexpected(command.error());
    return status ? std::string("no error") : status.error().message();
  };
  EXPECT_NE(error(R"("angle":0)").find("either a pattern or a shape"), std::string::npos);
  EXPECT_NE(error(R"("pattern":[[1,2],[3]])").find("row 2 has 1 heights"), std::string::npos);
  EXPECT_NE(error(R"("pattern":[[1,2]])").find("1 × 2"), std::string::npos);
  EXPECT_NE(error(R"("shape":"plane")").find("no bounds"), std::string::npos);
  EXPECT_NE(error(R"("shape":"cupboard")").find("is not known"), std::string::npos);
}

}  // namespace
}  // namespace knead::testing
