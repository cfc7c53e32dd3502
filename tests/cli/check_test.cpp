// `knead check`: how the faces at edges meet, and its verdict.
#include <cmath>
#include <fstream>
#include <numbers>
#include <regex>

#include "knead/exchange/file_info.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/exchange/format.hpp"
#include "knead/spline/evaluate.hpp"
#include "knead/spline/spline_refinement.hpp"
#include "program.hpp"
#include "session/schema_check.hpp"
#include "support/made_step.hpp"

namespace knead::testing {
namespace {

constexpr double degree = std::numbers::pi / 180;

/// The bonnet's skin cut along a line of constant u, so that both parts meet there.
struct Halves {
  Surface first, second;
};

Surface rows_of(const Surface& s, int from, int to, const KnotVector& u) {
  const int n = s.net()[1];
  return *Surface::create({u, s.knots(1)},
                          s.control_points().middleRows(from * n, (to - from) * n));
}

Halves halves_of(const Surface& skin) {
  const KnotVector& u = skin.knots(0);
  const int p = u.degree();
  const Interval domain = u.domain();
  const double cut = (domain.lower + domain.upper) / 2 + 0.03 * domain.length();
  const std::vector<double> inserted(static_cast<std::size_t>(p), cut);
  const auto finer = insert_knots<2>(skin, {inserted, {}});
  EXPECT_TRUE(finer);
  const auto all = finer->knots(0).knots();
  std::vector<double> low, high(static_cast<std::size_t>(p + 1), cut);
  for (const double k : all) {
    if (k < cut) low.push_back(k);
    if (k > cut) high.push_back(k);
  }
  low.insert(low.end(), static_cast<std::size_t>(p + 1), cut);
  const auto first = *KnotVector::create(p, low), second = *KnotVector::create(p, high);
  const int total = finer->net()[0];
  return {rows_of(*finer, 0, first.count(), first),
          rows_of(*finer, total - second.count(), total, second)};
}

/// The largest angle between both along the cut, degrees, by normals at 2001 parameters.
double angle_between(const Halves& halves) {
  const Interval v = halves.first.knots(1).domain();
  const double u = halves.first.knots(0).domain().upper;
  double largest = 0;
  for (int k = 0; k <= 2000; ++k) {
    const Parameters<2> at{{u, v.lower + v.length() * k / 2000}};
    const auto a = unit_normals(halves.first, at), b = unit_normals(halves.second, at);
    if (!a || !b) return -1;
    const Point n = a->row(0), m = b->row(0);
    largest = std::max(largest, std::atan2(n.cross(m).norm(), n.dot(m)) / degree);
  }
  return largest;
}

/// The second part raised beside the cut so that the largest angle is this.
Halves creased(const Halves& flat, double angle) {
  if (angle == 0) return flat;
  const auto raised = [&](double by) {
    Points net = flat.second.control_points();
    const int n = flat.second.net()[1];
    for (int j = 0; j < n; ++j) net(n + j, 2) += by;
    return Halves{flat.first, *flat.second.with_control_points(net)};
  };
  double by = 0.1;
  for (int k = 0; k < 20; ++k) by *= angle / angle_between(raised(by));
  return raised(by);
}

std::string curve_record(StepBuilder& b, const Points& points, const KnotVector& knots) {
  std::vector<int> ids;
  for (const auto& p : points.rowwise()) ids.push_back(b.point(p[0], p[1], p[2]));
  std::string multiplicities, values;
  const auto all = knots.knots();
  for (std::size_t k = 0; k < all.size();) {
    const auto many = knots.multiplicity(all[k]);
    multiplicities += (k == 0 ? "" : ",") + std::to_string(many);
    values += (k == 0 ? "" : ",") + StepBuilder::real(all[k]);
    k += static_cast<std::size_t>(many);
  }
  return "B_SPLINE_CURVE_WITH_KNOTS(''," + std::to_string(knots.degree()) + "," + "(" +
         StepBuilder::list_of(ids) + "),.UNSPECIFIED.,.F.,.F.,(" + multiplicities + "),(" + values +
         "),.UNSPECIFIED.)";
}

/// A file of both parts; `unit` empty: without one. `edge` is given the id of the common one.
std::string step_of(const Halves& halves, const std::string& unit, std::string* edge = nullptr) {
  StepBuilder b;
  const auto [m, n] = halves.first.net();
  const int rows = halves.second.net()[0];
  const Points &a = halves.first.control_points(), &c = halves.second.control_points();
  const auto corner = [&](const Points& net, int row) {
    return b.vertex(net(row, 0), net(row, 1), net(row, 2));
  };
  const int a0 = corner(a, 0), a1 = corner(a, n - 1), s = corner(c, 0), e = corner(c, n - 1),
            c0 = corner(c, (rows - 1) * n), c1 = corner(c, rows * n - 1);
  const auto along = [&](const Surface& surface, int from, int to, int row) {
    return b.edge(
        from, to,
        curve_record(b, surface.control_points().middleRows(row * n, n), surface.knots(1)));
  };
  const auto across = [&](const Surface& surface, int from, int to, int column) {
    const Points net =
        surface.control_points()(Eigen::seqN(column, surface.net()[0], n), Eigen::all);
    return b.edge(from, to, curve_record(b, net, surface.knots(0)));
  };
  const int middle = along(halves.second, s, e, 0);
  const int first =
      b.face(b.surface(halves.first, "front"),
             {b.bound({across(halves.first, a0, s, 0), middle, -across(halves.first, a1, e, n - 1),
                       -along(halves.first, a0, a1, 0)})});
  const int second =
      b.face(b.surface(halves.second, "rear"),
             {b.bound({across(halves.second, s, c0, 0), along(halves.second, c0, c1, rows - 1),
                       -across(halves.second, e, c1, n - 1), -middle})});
  const int shell = b.entity("OPEN_SHELL('',(" + StepBuilder::list_of({first, second}) + "))");
  const int model = b.entity("SHELL_BASED_SURFACE_MODEL('',(#" + std::to_string(shell) + "))");
  if (!unit.empty())
    b.product("Bonnet", "MANIFOLD_SURFACE_SHAPE_REPRESENTATION", {model}, b.context(unit));
  if (edge != nullptr) *edge = "#" + std::to_string(middle);
  static_cast<void>(m);
  return b.forward("AUTOMOTIVE_DESIGN");
}

class Check : public ::testing::Test {
 protected:
  std::string file(double angle, const std::string& unit = "mm") {
    return workshop_.file("crease.step", step_of(creased(halves_, angle), unit, &edge_));
  }
  Json edge_of(const Json& report) const {
    for (const Json& edge : report.at("edges")) {
      if (edge.at("id") == edge_) return edge;
    }
    ADD_FAILURE() << edge_ << " is missing";
    return {};
  }
  Halves halves_ = halves_of(surface_of(bonnet(), "#285"));
  Workshop workshop_;
  std::string edge_;
};

TEST_F(Check, ACreaseFailsTheClassesBelowIt) {
  const std::string creased_file = file(0.199);
  for (const auto& [grade, code] : {std::pair("a", 1), {"b", 0}, {"c", 0}}) {
    const Outcome run = knead({"check", creased_file, "--class", grade});
    EXPECT_EQ(run.code, code) << grade << run.out << run.err;
    EXPECT_TRUE(run.err.empty());
    EXPECT_NE(
        run.out.find(code == 1 ? "failed: 1 edge exceeds gap 0.01 mm, angle 0.1 degrees: " + edge_
                               : "passed: no edge exceeds"),
        std::string::npos)
        << run.out;
  }
  EXPECT_EQ(knead({"check", creased_file}).code, 0) << "nothing is judged";
  EXPECT_EQ(knead({"check", creased_file, "--class", "a", "--angle", "0.2"}).code, 0);
  EXPECT_EQ(knead({"check", creased_file, "--angle", "0.19"}).code, 1);
  EXPECT_EQ(knead({"check", file(0), "--class", "a", "--curvature", "1"}).code, 0)
      << "the skin itself is smooth there";
}

TEST_F(Check, TheCreaseIsMeasuredToOnePercent) {
  for (const double angle : {0.2, 1.0, 4.0}) {
    const Json report = knead({"check", file(angle), "--json"}).json();
    EXPECT_NEAR(edge_of(report).at("angle").at("value").get<double>(), angle, 0.01 * angle);
    EXPECT_EQ(edge_of(report).at("kind"), "G0");
  }
}

TEST_F(Check, CoursesAreThereWhereTheyAreAskedFor) {
  const auto source = open_source(*read_file(bonnet()), "bonnet.step");
  ASSERT_TRUE(source);
  const auto without = check_edges(**source, {}), with = check_edges(**source, {.courses = true});
  ASSERT_TRUE(without && with);
  EXPECT_EQ(brep::check_json(*without).find("\"course\""), std::string::npos);
  const Json report = Json::parse(brep::check_json(*with));
  for (const Json& edge : report.at("edges")) {
    ASSERT_GE(edge.at("course").size(), 2U) << edge.at("id");
    EXPECT_EQ(edge.at("course").front(), edge.at("start"));
    EXPECT_EQ(edge.at("course").back(), edge.at("end"));
  }
  EXPECT_EQ(against(report, Json::parse(brep::check_schema()), "report"), "");
}

TEST_F(Check, JsonIsAsItsSchemaSays) {
  const Outcome schema = knead({"schema", "check"});
  ASSERT_EQ(schema.code, 0) << schema.err;
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{}, {"--class", "a"}, {"--gap", "1", "--against", bonnet()}}) {
    for (const std::string& name : {bonnet(), file(0.2), file(0)}) {
      std::vector<std::string> arguments = {"check", name, "--json"};
      arguments.insert(arguments.end(), more.begin(), more.end());
      const Json report = knead(arguments).json();
      EXPECT_EQ(against(report, schema.json(), "report"), "");
      EXPECT_EQ(report.at("passed"), report.at("faults").empty());
      EXPECT_EQ(report.at("unit"), "mm");
    }
  }
}

TEST_F(Check, AClassNeedsAUnit) {
  const std::string name = file(0.15, "");
  EXPECT_TRUE(fails_with(knead({"check", name, "--class", "a"}), 2, {"unknown", "--unit", "inch"}));
  EXPECT_EQ(knead({"check", name, "--class", "a", "--unit", "mm"}).code, 1);
  EXPECT_EQ(knead({"check", name, "--angle", "0.1"}).code, 1) << "an angle needs none";
  const Json inches = knead({"check", name, "--class", "a", "--unit", "inch", "--json"}).json();
  EXPECT_NEAR(inches.at("thresholds").at("gap").get<double>(), 0.01 / 25.4, 1e-15);
  EXPECT_TRUE(fails_with(knead({"check", name, "--class", "a", "--unit", "ell"}), 2, {"ell"}));
  EXPECT_TRUE(fails_with(knead({"check", file(0.15), "--class", "a", "--unit", "inch"}), 2,
                         {"--unit", "mm"}));
  const Json metres = knead({"check", file(0.15, "m"), "--class", "c", "--json"}).json();
  EXPECT_NEAR(metres.at("thresholds").at("gap").get<double>(), 0.05e-3, 1e-18);
}

TEST_F(Check, AgainstAnEarlierFileOnlyWhatIsWorseCounts) {
  const std::string old = workshop_.file("old.step", step_of(creased(halves_, 0.3), "mm"));
  const auto code = [&](double angle) {
    return knead({"check", file(angle), "--against", old, "--class", "a"}).code;
  };
  EXPECT_EQ(code(0.3), 0);
  EXPECT_EQ(code(0.39), 0);
  EXPECT_EQ(code(0.41), 1);
  EXPECT_EQ(code(0.1), 0) << "better";
}

TEST_F(Check, WritesAJunitReportThatIsWellFormed) {
  const std::string out = workshop_ / "r.xml";
  EXPECT_EQ(knead({"check", file(0.2), "--class", "a", "--junit", out}).code, 1);
  const std::string xml = content_of(out);
  EXPECT_TRUE(
      xml.starts_with("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites tests=\"7\" "
                      "failures=\"1\""))
      << xml;
  const std::regex tag(R"(<(/?)([a-z]+)((?: [a-z]+="[^"<]*")*)(/?)>)");
  std::vector<std::string> open;
  std::size_t end = xml.find("?>") + 2, cases = 0;
  for (std::sregex_iterator it(xml.begin() + static_cast<std::ptrdiff_t>(end), xml.end(), tag),
       last;
       it != last; ++it) {
    cases += (*it)[2] == "testcase" && (*it)[1].length() == 0 ? 1 : 0;
    EXPECT_EQ(it->prefix().str().find_first_not_of(" \n"), std::string::npos) << it->prefix();
    if ((*it)[1].length() > 0) {
      ASSERT_FALSE(open.empty());
      EXPECT_EQ(open.back(), (*it)[2].str());
      open.pop_back();
    } else if ((*it)[4].length() == 0) {
      open.push_back((*it)[2]);
    }
  }
  EXPECT_TRUE(open.empty());
  EXPECT_EQ(cases, 7U);
  EXPECT_NE(xml.find("<failure message=\"angle 0."), std::string::npos) << xml;
}

TEST_F(Check, OnlyTheEdgesThatAreNamed) {
  const std::string name = file(0.2);
  const Json report = knead({"check", name, "--edges", edge_, "--json"}).json();
  EXPECT_EQ(report.at("edges").size(), 1U);
  EXPECT_TRUE(fails_with(knead({"check", name, "--edges", edge_ + ",#1"}), 2, {"--edges", "#1"}));
}

TEST_F(Check, AFileWithoutEdgesSaysSo) {
  const std::string net = workshop_.file(
      "square.g2", "200 1 0 0\n3 0\n2 2\n0 0 1 1\n2 2\n0 0 1 1\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n");
  const Outcome run = knead({"check", net});
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.out.find("no edges"), std::string::npos) << run.out;
  EXPECT_TRUE(knead({"check", net, "--json"}).json().at("edges").empty());
}

TEST_F(Check, SaysWhatIsWrong) {
  EXPECT_TRUE(fails_with(knead({"check", bonnet(), "--class", "d"}), 2, {"--class"}));
  EXPECT_TRUE(fails_with(knead({"check", bonnet(), "--gap=-1"}), 2, {"--gap"}));
  EXPECT_TRUE(fails_with(knead({"check", bonnet(), "--angle", "6"}), 2, {"--angle", "5"}));
  EXPECT_TRUE(fails_with(knead({"check", bonnet(), "--curvature", "101"}), 2, {"--curvature"}));
  EXPECT_TRUE(fails_with(knead({"check", bonnet(), "--against", bonnet()}), 2, {"--against"}));
  EXPECT_TRUE(fails_with(knead({"check", bonnet(), "--unit", "mm"}), 2, {"--unit", "class"}));
  EXPECT_TRUE(fails_with(knead({"check", workshop_ / "none.step"}), 3, {"none.step"}));
  EXPECT_TRUE(
      fails_with(knead({"check", bonnet(), "--junit", workshop_ / "no/r.xml"}), 3, {"no/r.xml"}));
}

TEST_F(Check, TheSampleHasNoSmoothEdges) {
  const Outcome run = knead({"check", bonnet(), "--class", "a"});
  EXPECT_EQ(run.code, 0) << run.out;
  EXPECT_NE(run.out.find("16 edges"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("8 open, 8 sharp"), std::string::npos) << run.out;
}

}  // namespace
}  // namespace knead::testing
