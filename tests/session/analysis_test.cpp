#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "sheet.hpp"
#include "support/long_run.hpp"

namespace knead {
namespace {

using testing::at;
using testing::first;
using testing::fresh;

// The scripts of examples/analysis against the literature (docs/shell.md): linear ones, in the
// limit of small loads.

/// The session after a script.
Session session_after(const std::string& name) {
  std::ifstream file(std::string(KNEAD_SOURCE_DIR) + "/examples/analysis/" + name + ".json");
  std::stringstream text;
  text << file.rdbuf();
  Session session = fresh();
  const auto script = parse_script(text.str(), name);
  if (!script) ADD_FAILURE() << script.error().message();
  if (!script) return session;
  for (const Command& command : *script) {
    const auto status = session.execute(command);
    if (!status) ADD_FAILURE() << status.error().message();
    if (!status) break;
  }
  return session;
}

/// The displacement of a place after a script.
Point displacement_after(const std::string& name, double s, double t) {
  const Session session = session_after(name);
  if (session.state().steps.empty()) return Point::Zero();
  EXPECT_TRUE(session.state().steps.back().converged);
  return at(*first(session).current, s, t) - at(*first(session).opened, s, t);
}

TEST(AnalysisScript, ScordelisLoRoof) {
  // −0.3006 under 90 per area, here under a ten-thousandth of it.
  EXPECT_NEAR(displacement_after("scordelis_lo_roof", 1, 1)[2] * 1e4, -0.3006, 0.01 * 0.3006);
}

TEST(AnalysisScript, PinchedCylinder) {
  EXPECT_NEAR(displacement_after("pinched_cylinder", 0, 1)[2], -1.8248e-5, 0.01 * 1.8248e-5);
}

TEST(AnalysisScript, BucklingCan) {
  // E t² / (R √(3 (1 − ν²))), the classical load of a simply supported cylinder under axial
  // compression, of waves of any length; the linear stress before it is not quite uniform, as the
  // ends keep the cylinder from widening.
  const Session session = session_after("buckling_can");
  const auto& found = session.state().buckling;
  ASSERT_FALSE(found.empty());
  const double classical = 210000 / (100 * std::sqrt(3 * (1 - 0.3 * 0.3)));
  EXPECT_NEAR(found.front().value, classical, 0.01 * classical);
  EXPECT_NEAR(found.front().value, 1264.7, 0.1);  // docs/shell.md
}

TEST(AnalysisScript, PinchedHemisphere) {
  EXPECT_NEAR(displacement_after("pinched_hemisphere", 0, 0)[0] * 1e4, 0.0924, 0.01 * 0.0924);
}

TEST(AnalysisScript, RolledCantilever) {
  // A moment m = 2π D / L closes a beam without stretch to a circle. Koiter's beam also gets
  // shorter as it bends, λ < 1: no membrane force acts, t E ε + D θ'² = 0, and m = D λ² θ', ε = (λ²
  // − 1)/2.
  const double t = 0.1, young = 1.2e6, length = 10, bend = young * t * t * t / 12,
               m = 2 * std::numbers::pi * bend / length;
  double squared = 1;
  for (int k = 0; k < 50; ++k)
    squared = 1 - 2 * bend / (young * t) * std::pow(m / (bend * squared), 2);
  const double turn = m / (bend * squared) * length, radius = std::sqrt(squared) * length / turn;
  const Point end = Point(length, 0, 0) + displacement_after("rolled_cantilever", 1, 0.5);
  EXPECT_NEAR(end[0], radius * std::sin(turn), 1e-5 * length);
  EXPECT_NEAR(end[2], radius * (std::cos(turn) - 1), 1e-5 * length);
  EXPECT_LT((end - Point(0, end[1], 0)).norm(), 1e-3 * length);  // closed
}

/// How much longer the hem is than before.
double hem_stretch(const Session& session) {
  const auto length = [](const Surface& s) {
    double sum = 0;
    for (int k = 0; k < 400; ++k) sum += (at(s, (k + 1) / 400.0, 0) - at(s, k / 400.0, 0)).norm();
    return sum;
  };
  return length(*first(session).current) / length(*first(session).opened) - 1;
}

TEST(AnalysisScript, ADrapeHangsInFoldsAndTheLinearOneIsStretched) {
  const Session linear = session_after("drape_linear");
  EXPECT_GT(hem_stretch(linear), 0.02);
  if (!testing::long_run()) GTEST_SKIP() << "the drape itself takes 12 s: KNEAD_LONG";
  const Session folded = session_after("drape_in_folds");
  EXPECT_LT(std::abs(hem_stretch(folded)), 2e-3);
  // The hem of the linear one stays above its place; that in folds is drawn in, and corners hang
  // lowest.
  const Surface& cloth = *first(folded).current;
  EXPECT_GT(at(cloth, 0.5, 0)[1], at(*first(folded).opened, 0.5, 0)[1] + 10);
  EXPECT_LT(at(cloth, 0, 0)[2], at(cloth, 0.5, 0)[2]);
}

TEST(AnalysisScript, TheModesOfAFreePlateAreThoseOfTheTable) {
  const Session plate = session_after("free_plate");
  // ω a² √(ρt/D) = 13.468 of the first mode that bends (docs/shell.md), in cycles per second.
  const double bending = 210000 / (12 * (1 - 0.09)),
               lowest = 13.468 / (100 * 100) * std::sqrt(bending / 7.85e-9);
  const auto& modes = plate.state().modes;
  ASSERT_EQ(modes.size(), 10U);
  EXPECT_NEAR(modes[6].value, lowest / (2 * std::numbers::pi), 2e-4 * lowest);
}

}  // namespace
}  // namespace knead
