#include <cmath>
#include <cstring>
#include <map>
#include <regex>
#include <set>

#include "knead/spline/evaluate.hpp"
#include "knead/spline/extremum.hpp"
#include "program.hpp"

namespace knead::testing {
namespace {

const char* const skin = "#285";   // bicubic, trimmed, in a shell with neighbours
const char* const ring = "#1044";  // rational

/// A dent in the middle of a surface, lengths relative to its size.
Json dent(const std::string& id, int steps = 2) {
  return {command("select", {{"surface", id}}), command("hold", {{"rows", 1}}),
          command("tool", {{"radius", 0.1}, {"relative", true}, {"at", {0.4, 0.5}}}),
          command("move", {{"by", {0, 0, 0.05}}, {"relative", true}}),
          command("step", {{"count", steps}, {"lambda", 10}})};
}

/// Lets the edges of faces open: what was done is written all the same.
const Json may_open = command("hold", {{"mode", "open"}, {"all", true}});

/// Sculpts the sample, lets edges open and returns the path of the result.
std::string sculpted(const Workshop& workshop, Json commands,
                     const std::string& name = "out.step") {
  commands.push_back(may_open);
  const Outcome run =
      knead({"sculpt", bonnet(), "-o", workshop / name, "--script",
             workshop.script_of_all(commands), "--report", workshop / (name + ".json")});
  EXPECT_EQ(run.code, 0) << run.err;
  return workshop / name;
}

Json report_of(const std::string& output) { return Json::parse(content_of(output + ".json")); }

bool same_bits(const Points& a, const Points& b, Eigen::Index row) {
  return std::memcmp(a.data() + 3 * row, b.data() + 3 * row, 3 * sizeof(double)) == 0;
}

int rows_that_differ(const Points& a, const Points& b) {
  int count = 0;
  for (Eigen::Index k = 0; k < a.rows(); ++k) count += !same_bits(a, b, k);
  return count;
}

/// The records of a DATA section by their id.
std::map<std::string, std::string> records_of(const std::string& step) {
  std::map<std::string, std::string> records;
  static const std::regex record(R"((#\d+)\s*=\s*([^;]*);)");
  for (std::sregex_iterator it(step.begin(), step.end(), record), end; it != end; ++it)
    records[(*it)[1]] = (*it)[2];
  return records;
}

std::set<std::string> references_in(const std::string& record) {
  static const std::regex id(R"(#\d+)");
  return {std::sregex_token_iterator(record.begin(), record.end(), id), {}};
}

TEST(Sculpt, NoCommandsGiveTheSameBytes) {
  const Workshop workshop;
  EXPECT_TRUE(identical(content_of(sculpted(workshop, Json::array())), content_of(bonnet())));
  const Json report = report_of(workshop / "out.step");
  EXPECT_TRUE(report.at("steps").empty());
  EXPECT_EQ(report.at("control_points_moved"), 0);
  EXPECT_EQ(report.at("time"), 0);
}

TEST(Sculpt, NoCommandsAreValidWithoutSplineSurfacesToo) {
  const Workshop workshop;
  const std::string bytes =
      "ISO-10303-21;\r\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','')"
      ";\n"
      "FILE_SCHEMA(('X'));\nENDSEC;\nDATA;\n#1 = CARTESIAN_POINT('',(0.,0.,/* ; "
      "*/0.));\nENDSEC;\nEND-ISO-10303-21;";
  const std::string file = workshop.file("none.step", bytes);
  const std::string script = workshop.script(Json::array());
  const Outcome run = knead({"sculpt", file, "-o", workshop / "out.step", "--script", script});
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_TRUE(identical(content_of(workshop / "out.step"), bytes));
}

TEST(Sculpt, WhatIsUndoneLeavesTheSameBytes) {
  const Workshop workshop;
  Json commands = dent(skin);
  commands.push_back(command("undo"));
  EXPECT_TRUE(identical(content_of(sculpted(workshop, commands)), content_of(bonnet())));
  EXPECT_TRUE(report_of(workshop / "out.step").at("steps").empty());
  commands = dent(skin);
  commands.push_back(command("undo"));
  commands.push_back(command("undo"));
  commands.push_back(command("redo"));
  commands.push_back(command("redo"));
  const std::string again = content_of(sculpted(workshop, commands, "again.step"));
  EXPECT_TRUE(identical(again, content_of(sculpted(workshop, dent(skin), "once.step"))))
      << "redo brings back every bit";
  EXPECT_FALSE(identical(again, content_of(bonnet())));
}

TEST(Sculpt, NothingMovesWithoutAToolInReach) {
  const Workshop workshop;
  Json commands = dent(skin);
  commands[3] = command("move", {{"by", {0, 0, 10}}, {"relative", true}});
  EXPECT_TRUE(identical(content_of(sculpted(workshop, commands)), content_of(bonnet())));
}

TEST(Sculpt, OnlyCoordinatesOfTheSurfaceDiffer) {
  const Workshop workshop;
  for (const char* id : {skin, ring}) {
    const auto before = records_of(content_of(bonnet()));
    const auto after = records_of(content_of(sculpted(workshop, dent(id))));
    const std::set<std::string> points = references_in(after.at(id));
    int changed = 0;
    for (const auto& [name, text] : after) {
      const auto original = before.find(name);
      if (original != before.end() && original->second == text) continue;
      if (name == id) continue;  // it may refer to new points where others use the old ones
      ++changed;
      EXPECT_TRUE(points.contains(name)) << name << " is no point of " << id;
      EXPECT_TRUE(text.starts_with("CARTESIAN_POINT")) << name << " = " << text;
    }
    for (const auto& [name, text] : before) EXPECT_TRUE(after.contains(name)) << name << " is lost";
    EXPECT_GT(changed, 0);
    EXPECT_LE(changed, report_of(workshop / "out.step").at("control_points_moved").get<int>());
  }
}

TEST(Sculpt, TheOtherSurfaceKeepsItsBits) {
  const Workshop workshop;
  const std::string out = sculpted(workshop, dent(skin));
  EXPECT_EQ(rows_that_differ(surface_of(bonnet(), ring).control_points(),
                             surface_of(out, ring).control_points()),
            0);
}

TEST(Sculpt, WeightsAndKnotsOfARationalSurfaceKeepTheirBits) {
  const Workshop workshop;
  const Surface before = surface_of(bonnet(), ring),
                after = surface_of(sculpted(workshop, dent(ring)), ring);
  EXPECT_TRUE(std::ranges::equal(before.weights(), after.weights()));
  for (int d = 0; d < 2; ++d)
    EXPECT_TRUE(std::ranges::equal(before.knots(d).knots(), after.knots(d).knots()));
  EXPECT_GT(rows_that_differ(before.control_points(), after.control_points()), 0);
}

TEST(Sculpt, HeldAndPinnedPointsKeepTheirBits) {
  const Workshop workshop;
  Json commands = dent(skin);
  commands[1] = command("hold", {{"rows", 2}});
  commands.insert(commands.begin() + 2, command("pin", {{"control_points", {{5, 5}, {6, 7}}}}));
  const Surface before = surface_of(bonnet(), skin),
                after = surface_of(sculpted(workshop, commands), skin);
  const auto [m, n] = before.net();
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < n; ++j) {
      const bool fixed =
          i < 2 || j < 2 || i >= m - 2 || j >= n - 2 || (i == 5 && j == 5) || (i == 6 && j == 7);
      EXPECT_EQ(same_bits(before.control_points(), after.control_points(), i * n + j), fixed)
          << i << ", " << j;
    }
  }
}

TEST(Sculpt, TheReportSaysWhatTheFileShows) {
  const Workshop workshop;
  const std::string out = sculpted(workshop, dent(skin, 3));
  const Json report = report_of(out);
  const Surface before = surface_of(bonnet(), skin), after = surface_of(out, skin);
  ASSERT_EQ(report.at("steps").size(), 3U);
  double time = 0;
  for (const Json& step : report.at("steps")) {
    ASSERT_EQ(step.size(), 13U + step.contains("note"));
    EXPECT_GE(step.at("energy").get<double>(), 0);
    EXPECT_GE(step.at("residual").get<double>(), 0);
    EXPECT_LE(step.at("residual").get<double>(), 1);
    EXPECT_GT(step.at("largest_displacement").get<double>(), 0);
    time += step.at("time").get<double>();
  }
  ASSERT_EQ(report.size(), 11U);
  EXPECT_TRUE(report.at("places").empty()) << "no part is used twice";
  const Json& last = report.at("steps").back();
  EXPECT_DOUBLE_EQ(report.at("time").get<double>(), time);
  EXPECT_EQ(report.at("residual"), last.at("residual"));
  EXPECT_EQ(report.at("largest_displacement"), last.at("largest_displacement"));
  EXPECT_EQ(report.at("energy_before"), 0) << "at rest there is no displacement";
  // Of the unrounded step; after it, that of the control points.
  const double energy = last.at("energy");
  EXPECT_NEAR(report.at("energy_after").get<double>(), energy, 1e-12 * energy);
  EXPECT_EQ(report.at("control_points_moved"),
            rows_that_differ(before.control_points(), after.control_points()));

  // Sampled displacements stay below the largest one and come near to it.
  std::vector<double> u, v;
  for (int k = 0; k <= 200; ++k) {
    const Interval a = before.knots(0).domain(), b = before.knots(1).domain();
    u.push_back(k == 200 ? a.upper : a.lower + a.length() * k / 200);
    v.push_back(k == 200 ? b.upper : b.lower + b.length() * k / 200);
  }
  const std::array<std::span<const double>, 2> at{u, v};
  const auto s = evaluate_grid<2>(before, at), t = evaluate_grid<2>(after, at);
  ASSERT_TRUE(s && t);
  const double sampled = (t->points() - s->points()).rowwise().norm().maxCoeff();
  const double largest = report.at("largest_displacement");
  EXPECT_LE(sampled, largest * (1 + 1e-12));
  EXPECT_GE(sampled, largest * 0.999);
}

TEST(Sculpt, TheThesisEnergyFallsStepByStepWithoutForces) {
  const Workshop workshop;
  const Json commands = {command("select", {{"surface", skin}}),
                         command("rest", {{"mode", "none"}}),
                         command("step", {{"count", 5}, {"lambda", 10}})};
  const Json report = report_of(sculpted(workshop, commands));
  double energy = report.at("energy_before");
  EXPECT_GT(energy, 0);
  for (const Json& step : report.at("steps")) {
    EXPECT_LT(step.at("energy").get<double>(), energy);
    energy = step.at("energy");
  }
}

TEST(Sculpt, LeftOutFieldsMeanTheirDocumentedDefaults) {
  const Workshop workshop;
  const BoundingBox box = bounding_box(surface_of(bonnet(), skin));
  const double diagonal = box.diagonal();
  const Json brief = {command("select", {{"surface", skin}}),
                      command("material", {{"reset", true}}),
                      command("rest"),
                      command("hold"),
                      command("tool", {{"at", {0.4, 0.5}}}),
                      command("move", {{"by", {1, 2, 3}}}),
                      command("step")};
  const Json full = {command("select", {{"surface", skin}}),
                     command("material", {{"alpha", {1, 0, 1}}, {"beta", {0.01, 0.01, 0.01}}}),
                     command("rest", {{"mode", "shape"}}),
                     command("hold", {{"rows", 2}}),
                     command("tool", {{"name", "tool"},
                                      {"shape", "sphere"},
                                      {"radius", 0.1 * diagonal},
                                      {"at", {0.4, 0.5}},
                                      {"mode", "collision"},
                                      {"stiffness", 1e4},
                                      {"range", 0.05 * diagonal},
                                      {"relative", false}}),
                     command("move", {{"tool", "tool"}, {"by", {1, 2, 3}}, {"relative", false}}),
                     command("step", {{"count", 1}, {"lambda", 1}, {"weight", "mass"}})};
  const std::string a = content_of(sculpted(workshop, brief, "a.step"));
  EXPECT_TRUE(identical(a, content_of(sculpted(workshop, full, "b.step"))));
  EXPECT_FALSE(identical(a, content_of(bonnet())));
}

TEST(Sculpt, RelativeLengthsAreFractionsOfTheBoxDiagonal) {
  const Workshop workshop;
  const Surface surface = surface_of(bonnet(), ring);
  const double d = bounding_box(surface).diagonal();
  const Interval u = surface.knots(0).domain(), v = surface.knots(1).domain();
  const auto centre =
      evaluate_point<2>(surface, {u.lower + 0.25 * u.length(), v.lower + 0.5 * v.length()});
  ASSERT_TRUE(centre);
  const Json relative = {
      command("select", {{"surface", ring}}),
      command("tool", {{"radius", 0.125}, {"relative", true}, {"at", {0.25, 0.5}}}),
      command("move", {{"by", {0, 0, 0.0625}}, {"relative", true}}), command("step")};
  const Json absolute = {command("select", {{"surface", ring}}),
                         command("tool", {{"radius", 0.125 * d},
                                          {"position", {centre->x(), centre->y(), centre->z()}}}),
                         command("move", {{"by", {0, 0, 0.0625 * d}}}), command("step")};
  EXPECT_TRUE(identical(content_of(sculpted(workshop, relative, "a.step")),
                        content_of(sculpted(workshop, absolute, "b.step"))));
}

TEST(Sculpt, OneScriptMaySculptSeveralSurfaces) {
  const Workshop workshop;
  Json commands = dent(skin);
  commands.push_back(command("remove"));
  for (const Json& c : dent(ring)) commands.push_back(c);
  const std::string out = sculpted(workshop, commands);
  for (const char* id : {skin, ring}) {
    EXPECT_GT(rows_that_differ(surface_of(bonnet(), id).control_points(),
                               surface_of(out, id).control_points()),
              0);
  }
}

TEST(Sculpt, TheSameScriptGivesTheSameBytes) {
  const Workshop workshop;
  EXPECT_TRUE(identical(content_of(sculpted(workshop, dent(skin), "a.step")),
                        content_of(sculpted(workshop, dent(skin), "b.step"))));
}

TEST(Sculpt, AFileMayBeSculptedInPlace) {
  const Workshop workshop;
  const std::string file = workshop.file("in.step", content_of(bonnet()));
  Json commands = dent(skin);
  commands.push_back(may_open);
  const Outcome run =
      knead({"sculpt", file, "-o", file, "--script", workshop.script_of_all(commands)});
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_TRUE(identical(content_of(file), content_of(sculpted(workshop, dent(skin)))));
}

TEST(Sculpt, WrittenCoordinatesCarrySeventeenDigits) {
  const Workshop workshop;
  const auto before = records_of(content_of(bonnet())),
             after = records_of(content_of(sculpted(workshop, dent(ring))));
  static const std::regex digits(R"([-+]?[0-9.]+(E[-+]?[0-9]+)?)");
  int longest = 0;
  for (const auto& [name, text] : after) {
    if (const auto original = before.find(name);
        original != before.end() && original->second == text)
      continue;
    if (!text.starts_with("CARTESIAN_POINT")) continue;
    for (std::sregex_iterator it(text.begin(), text.end(), digits), end; it != end; ++it) {
      const std::string number = (*it)[0], mantissa = number.substr(0, number.find('E'));
      longest = std::max(longest, static_cast<int>(std::ranges::count_if(
                                      mantissa, [](char c) { return c >= '0'; })));
    }
  }
  EXPECT_GE(longest, 17);
}

TEST(Sculpt, TheReportHasMeasurements) {
  const Workshop workshop;
  Json commands = dent(skin);
  commands.insert(commands.begin() + 1, command("measure", {{"name", "tip"}, {"at", {0.4, 0.5}}}));
  const Json report = report_of(sculpted(workshop, commands));
  ASSERT_EQ(report.at("measurements").size(), 1U);
  const Json& tip = report.at("measurements").front();
  EXPECT_EQ(tip.at("name"), "tip");
  EXPECT_EQ(tip.at("surface"), skin);
  EXPECT_EQ(tip.at("at"), Json({0.4, 0.5}));
  EXPECT_EQ(tip.at("point").size(), 3U);
  const auto length = [](const Json& v) {
    return std::hypot(v[0].get<double>(), v[1].get<double>(), v[2].get<double>());
  };
  EXPECT_NEAR(length(tip.at("normal")), 1, 1e-12);
  EXPECT_GE(tip.at("curvature")[0], tip.at("curvature")[1]);
  EXPECT_GT(length(tip.at("displacement")), 0.5 * report.at("largest_displacement").get<double>());
  commands[3]["minor"] = 3;  // a sphere has none
  const Outcome refused =
      knead({"sculpt", bonnet(), "-o", workshop / "2.step", "--script",
             workshop.file("2.json", Json{{"knead", 2}, {"commands", commands}}.dump())});
  EXPECT_EQ(refused.code, 3);
  EXPECT_NE(refused.err.find("commands[3].minor"), std::string::npos) << refused.err;
  EXPECT_FALSE(report_of(sculpted(workshop, dent(skin), "plain.step")).contains("measurements"));
}

TEST(Sculpt, AnEdgeIsLeftOpenOnlyWhereItIsFreed) {
  const Workshop workshop;
  const Json lift = command("points", {{"which", {20, 40, 41}}, {"by", {0, 0, 20}}});
  const auto run = [&](const Json& commands) {
    return knead({"sculpt", bonnet(), "-o", workshop / "open.step", "--script",
                  workshop.script_of_all(commands), "--report", workshop / "open.step.json"});
  };
  const Outcome never_held = run({command("select", {{"surface", skin}}), lift});
  EXPECT_EQ(never_held.code, 4);
  EXPECT_NE(never_held.err.find("would be left 2.45 from the faces #39 and #807"),
            std::string::npos)
      << never_held.err;
  EXPECT_FALSE(std::filesystem::exists(workshop / "open.step"));
  EXPECT_FALSE(std::filesystem::exists(workshop / "open.step.json"));
  const Outcome held =
      run({command("select", {{"surface", skin}}), command("hold", {{"mode", "position"}}), lift});
  EXPECT_EQ(held.code, 4);
  EXPECT_NE(
      held.err.find("#203 on #285 between the faces #39 and #807 is held, and would open by 2.47"),
      std::string::npos)
      << held.err;
  const Outcome freed =
      run({command("select", {{"surface", skin}}), command("hold", {{"mode", "open"}}), lift});
  EXPECT_EQ(freed.code, 0) << freed.err;
  const auto notes = report_of(workshop / "open.step").at("notes");
  EXPECT_EQ(std::ranges::count_if(notes,
                                  [](const Json& note) {
                                    return note.get<std::string>().find(
                                               "which was freed, is open") != std::string::npos;
                                  }),
            2);
}

}  // namespace
}  // namespace knead::testing
