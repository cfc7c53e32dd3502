// Pins with targets: conditions that may contradict each other, checked one after another.

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "scene/model/met_conditions.hpp"
#include "sheet.hpp"

namespace knead {
namespace {

using testing::first;
using testing::fresh;
using testing::new_sheet;
using testing::refusal;
using testing::run;

std::string pin(double s, double t, double height) {
  return fmt::format(R"({{"do":"pin","at":[{},{}],"to":[{},{},{}]}})", s, t, 10 * s, 10 * t,
                     height);
}

/// Pins of a sheet of 10 by 10, on the first n of a grid of 4 by 4 places, to heights in a plane.
Session pinned(int n) {
  Session session = fresh();
  run(session, {new_sheet});
  for (int k = 0; k < n; ++k) {
    const double s = 0.2 + 0.2 * (k / 4), t = 0.2 + 0.2 * (k % 4);
    run(session, {pin(s, t, 0.1 + s - t)});
  }
  return session;
}

ModelInput input_of(const Session& session) {
  return model_input(session.state(), trial_evolution());
}

TEST(MetConditions, EliminateEveryPinOnce) {
  MetConditions conditions;
  const Session all = pinned(16);
  ModelInput input = input_of(all);
  const std::vector<KeptConstraint> pins = input.shapes.front().constraints;
  ASSERT_EQ(pins.size(), 16U);
  input.shapes.front().constraints.resize(1);
  ASSERT_TRUE(conditions.check(input));
  for (std::size_t n = 2; n <= 16; ++n) {
    const long long before = conditions.eliminated();
    input.shapes.front().constraints.push_back(pins[n - 1]);
    ASSERT_TRUE(conditions.check(input));
    EXPECT_EQ(conditions.eliminated() - before, 1) << n;
  }
}

TEST(MetConditions, RefuseWhatContradictsEarlierPinsAsIfAllWereNew) {
  const Session all = pinned(16);
  ModelInput input = input_of(all);
  std::vector<KeptConstraint>& pins = input.shapes.front().constraints;
  MetConditions conditions;
  ASSERT_TRUE(conditions.check(input));
  KeptConstraint elsewhere = pins.front();
  (*std::get<PointPin>(elsewhere.constraint).to)[2] += 1;
  pins.push_back(elsewhere);
  const auto anew = check_conditions(input), after = conditions.check(input);
  ASSERT_FALSE(anew);
  ASSERT_FALSE(after);
  EXPECT_EQ(after.error().message(), anew.error().message());
  EXPECT_NE(after.error().what.find("contradicts"), std::string::npos);
  // Nothing of what was refused is remembered, whatever comes next.
  pins.back() = pins.front();
  EXPECT_TRUE(conditions.check(input));
  pins.resize(3);
  EXPECT_TRUE(conditions.check(input));
  pins.push_back(elsewhere);
  EXPECT_FALSE(conditions.check(input));
}

TEST(MetConditions, HoldControlPointsAndSingleCoordinatesAmongPins) {
  const Session all = pinned(6);
  ModelInput input = input_of(all);
  std::vector<KeptConstraint>& pins = input.shapes.front().constraints;
  MetConditions conditions;
  ASSERT_TRUE(conditions.check(input));
  KeptConstraint corner = pins.front();  // a control point of a clamped net
  corner.constraint = PointPin{{0, 0}};
  pins.push_back(corner);
  ASSERT_TRUE(conditions.check(input));
  KeptConstraint height = pins.front();
  height.constraint = PointPin{{0.5, 0.5}, Vector3{5, 5, 1}, {false, false, true}};
  pins.push_back(height);
  ASSERT_TRUE(conditions.check(input));
  KeptConstraint lower = height;
  (*std::get<PointPin>(lower.constraint).to)[2] = 0.5;
  pins.push_back(lower);
  EXPECT_FALSE(conditions.check(input));
}

TEST(PinCommand, AfterOthersIsRefusedWhereItContradictsThem) {
  Session session = pinned(16);
  const std::size_t before = first(session).constraints.size();
  EXPECT_NE(refusal(session, pin(0.2, 0.2, 5)).what.find("contradicts"), std::string::npos);
  EXPECT_EQ(first(session).constraints.size(), before);
  run(session, {pin(0.5, 0.5, 0.4), R"({"do":"step"})"});
  const auto at = testing::at(*first(session).current, 0.5, 0.5);
  EXPECT_NEAR(at.z(), 0.4, 1e-9);
}

}  // namespace
}  // namespace knead
