#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "sheet.hpp"

namespace knead {
namespace {

using testing::at;
using testing::first;
using testing::fresh;

// The scripts of examples/analysis against the literature (docs/shell.md): linear ones, in the limit of small loads.

/// The displacement of a place after a script.
Point displacement_after(const std::string& name, double s, double t) {
  std::ifstream file(std::string(KNEAD_SOURCE_DIR) + "/examples/analysis/" + name + ".json");
  std::stringstream text;
  text << file.rdbuf();
  const auto script = parse_script(text.str(), name);
  if (!script) {
    ADD_FAILURE() << script.error().message();
    return Point::Zero();
  }
  Session session = fresh();
  for (const Command& command : *script) {
    const auto done = session.execute(command);
    if (!done) ADD_FAILURE() << done.error().message();
    if (!done) return Point::Zero();
  }
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

}  // namespace
}  // namespace knead
