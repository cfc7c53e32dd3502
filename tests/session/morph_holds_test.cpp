// What a scene holds stays exactly where it is while all else follows data.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "knead/spline/evaluate.hpp"
#include "scene/parted_edges.hpp"
#include "session/running.hpp"

namespace knead {
namespace {

using testing::opened;
using testing::run_on;
using testing::two_sheets;

constexpr double rounding = 1e-14;
const std::string refine = R"({"do":"refine","region":[[0,1],[0,1]]},)";
const std::string finer = R"({"do":"select","surface":"#10"},)" + refine + refine;
const std::string rises = R"(,{"do":"morph","space":"0; 0; 0.03 + 0.02*sin(2*x)*y"})";

Point height_wanted(const Point& p) { return {0, 0, 0.03 + 0.02 * std::sin(2 * p.x()) * p.y()}; }

Point place(const Session& session, std::size_t surface, double u, double v) {
  return *evaluate_point<2>(*session.state().surfaces[surface].current, {u, v});
}

Point normal(const Session& session, double u, double v) {
  Parameters<2> at(1, 2);
  at << u, v;
  const auto values = evaluate<2>(*session.state().surfaces[0].current, at, 1);
  const Point su = values->at({1, 0}).row(0).transpose(),
              sv = values->at({0, 1}).row(0).transpose();
  return su.cross(sv).normalized();
}

struct Held {
  const char* what;
  std::string command;
  std::vector<std::array<double, 2>> stays;  ///< parameters of #10
  bool normals = false;

  friend void PrintTo(const Held& held, std::ostream* to) { *to << held.what; }
};

class MorphHolds : public ::testing::TestWithParam<Held> {};

TEST_P(MorphHolds, StayExactly) {
  const Held& held = GetParam();
  const auto sheets = two_sheets();
  Session session = opened(sheets);
  std::string command = held.command;
  if (const auto at = command.find("OUTER"); at != std::string::npos)
    command.replace(at, 5, std::to_string(sheets.outer));
  const auto status = run_on(session, finer + command + rises);
  ASSERT_TRUE(status) << status.error().message();
  const Session before = opened(sheets);
  for (const auto& [u, v] : held.stays) {
    EXPECT_LE((place(session, 0, u, v) - place(before, 0, u, v)).norm(), rounding)
        << u << ", " << v;
    if (!held.normals) continue;
    EXPECT_LE((normal(session, u, v) - Point::UnitZ()).norm(), 10 * rounding);
  }
  // Far from it the data are followed, and nothing is torn.
  const Point was = place(before, 1, 0.9, 0.5);
  EXPECT_LE((place(session, 1, 0.9, 0.5) - was - height_wanted(was)).norm(), 3e-5);
  EXPECT_TRUE(session.parted_edges()->empty());
  bool told = false;
  for (const Note& note : session.state().notes)
    told = told || note.find("contradiction") != std::string::npos;
  EXPECT_TRUE(told) << "data that contradict a hold are named";
  EXPECT_TRUE(session.save());
}

std::vector<std::array<double, 2>> grid(double u0, double u1, double v0, double v1) {
  std::vector<std::array<double, 2>> result;
  for (int i = 0; i <= 6; ++i) {
    for (int j = 0; j <= 6; ++j)
      result.push_back({std::lerp(u0, u1, i / 6.0), std::lerp(v0, v1, j / 6.0)});
  }
  return result;
}

const Held all[] = {
    {"pin", R"({"do":"pin","at":[0.3,0.4]})", {{0.3, 0.4}}},
    {"edge", R"({"do":"edge","which":"u0"})", grid(0, 0, 0, 1)},
    {"clamped", R"({"do":"edge","which":"u0","hold":"tangent"})", grid(0, 0, 0, 1), true},
    {"line", R"({"do":"keep","u":0.37})", grid(0.37, 0.37, 0, 1)},
    {"curve",
     R"({"do":"keep","curve":[[0.2,0.3],[0.4,0.6]]})",
     {{0.2, 0.3}, {0.3, 0.45}, {0.4, 0.6}}},
    {"region", R"({"do":"freeze","region":[[0.1,0.4],[0.2,0.8]]})", grid(0.1, 0.4, 0.2, 0.8), true},
    {"named", R"({"do":"edge","edge":"#OUTER","hold":"position"})", grid(0, 1, 0, 0)}};

TEST(MorphKeeps, AMaskStaysToo) {
  Session session = opened(two_sheets());
  const auto status = run_on(session, finer + R"({"do":"mask","change":"fill"})" + rises);
  ASSERT_TRUE(status) << status.error().message();
  EXPECT_EQ(session.largest_displacement(0), 0);
  EXPECT_GT(session.largest_displacement(1), 0.01);
}

TEST(MorphKeeps, WhatRowsHoldStaysOnFinerNets) {
  Session session = opened(two_sheets());
  const std::string cubic = R"({"do":"select","surface":"#10"},{"do":"elevate","by":[2,2]},)";
  const auto status =
      run_on(session, cubic + refine + refine + refine + R"({"do":"hold","rows":5})" + rises);
  ASSERT_TRUE(status) << status.error().message();
  const Session before = opened(two_sheets());
  for (const auto& [u, v] : grid(0, 0.25, 0, 1))
    EXPECT_LE((place(session, 0, u, v) - place(before, 0, u, v)).norm(), rounding);
}

TEST(MorphKeeps, SurfacesThatAreLockedInANewDocument) {
  Session session(Document::fresh("made", "mm"));
  ASSERT_TRUE(run_on(session, R"({"do":"new","net":[6,6]},
      {"do":"new","net":[6,6],"position":[500,0,0]})"));
  const auto status = run_on(session, fmt::format(R"({{"do":"lock","surfaces":["{}"]}},
      {{"do":"morph","space":"0; 0; 0.1*x"}})",
                                                  session.state().surfaces[0].id));
  ASSERT_TRUE(status) << status.error().message();
  EXPECT_EQ(session.largest_displacement(0), 0);
  EXPECT_GT(session.largest_displacement(1), 0);
}

TEST(MorphKeeps, DataThatKeepASymmetryKeepItOnFinerNets) {
  Session session = opened(two_sheets());
  const auto status = run_on(session, finer + R"x({"do":"symmetry","mirror":"v"},
      {"do":"morph","space":"0; 0; 0.1*sin(9*x)*cos(12*(y-0.5))"})x");
  ASSERT_TRUE(status) << status.error().message();
  for (int i = 0; i <= 8; ++i) {
    for (int j = 0; j <= 8; ++j) {
      const Point a = place(session, 0, i / 8.0, j / 16.0),
                  b = place(session, 0, i / 8.0, 1 - j / 16.0);
      EXPECT_LE((Point(a.x(), 1 - a.y(), a.z()) - b).norm(), 10 * rounding);
    }
  }
  EXPECT_GT(session.state().surfaces[0].current->net()[0], 8) << "which data ask for";
}

TEST(MorphKeeps, AnEdgeInAPlaneStaysInIt) {
  Session session = opened(two_sheets());
  const auto status =
      run_on(session, finer + R"({"do":"symmetry","edge":"u0","point":[0,0,0],"normal":[1,0,0]},
      {"do":"morph","space":"0.05*cos(x)*y; 0; 0.1*cos(3*x)*y"})");
  ASSERT_TRUE(status) << status.error().message();
  for (int j = 0; j <= 8; ++j) EXPECT_LE(std::abs(place(session, 0, 0, j / 8.0).x()), rounding);
  EXPECT_GT(place(session, 0, 0, 1).z(), 0.09) << "and moves within it";
}

std::string name_of(const ::testing::TestParamInfo<Held>& held) { return held.param.what; }

INSTANTIATE_TEST_SUITE_P(, MorphHolds, ::testing::ValuesIn(all), name_of);

}  // namespace
}  // namespace knead
