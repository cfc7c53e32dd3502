// `knead morph`: the sample follows maps whose image is known, and what it refuses.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>

#include "knead/brep/edge_measures.hpp"
#include "knead/exchange/format.hpp"
#include "knead/spline/evaluate.hpp"
#include "program.hpp"
#include "session/schema_check.hpp"
#include "support/made_step.hpp"

namespace knead::testing {
namespace {

constexpr double size = 1757;  // of the sample, mm, about

const std::string affine = "0.01*x + 0.002*y + 1; 0.003*z - 2; 0.01*x";

Point affine_of(const Point& p) {
  return {0.01 * p.x() + 0.002 * p.y() + 1, 0.003 * p.z() - 2, 0.01 * p.x()};
}

/// Points of the skin, which nothing places anywhere, and where a map sends them.
template <class Map>
std::string vectors_of(const Map& map, char separator = ' ') {
  const Surface skin = surface_of(bonnet(), "#285");
  std::string text;
  for (int i = 0; i < 40; ++i) {
    for (int j = 0; j < 40; ++j) {
      // Well within its bounds, which are inside those of the surface.
      std::array<double, 2> at{};
      for (std::size_t d = 0; d < 2; ++d) {
        const Interval domain = skin.knots(static_cast<int>(d)).domain();
        at[d] = domain.lower + domain.length() * (0.3 + 0.4 * ((d == 0 ? i : j) + 0.5) / 40);
      }
      const Point p = *evaluate_point<2>(skin, at), d = map(p);
      for (const double x : {p.x(), p.y(), p.z(), d.x(), d.y(), d.z()})
        text += fmt::format("{}{}", x, separator);
      text.back() = '\n';
    }
  }
  return text;
}

double largest_difference(const Surface& after, const Surface& before, double scale) {
  double worst = 0;
  for (int k = 0; k <= 20; ++k) {
    for (int l = 0; l <= 20; ++l) {
      std::array<double, 2> at{};
      for (std::size_t d = 0; d < 2; ++d) {
        const Interval domain = before.knots(static_cast<int>(d)).domain();
        at[d] = domain.lower + domain.length() * (d == 0 ? k : l) / 20;
      }
      const Point p = *evaluate_point<2>(before, at), q = *evaluate_point<2>(after, at);
      worst = std::max(worst, (q - p - scale * affine_of(p)).norm());
    }
  }
  return worst;
}

/// A bilinear patch over x from `from` to `to` and y from 0 to 1, on a net of its own.
Surface patch(double from, double to, int spans) {
  const auto u = *KnotVector::clamped_uniform(3, spans + 3), v = *KnotVector::clamped_uniform(1, 2);
  Points net(u.count() * 2, 3);
  for (int i = 0; i < u.count(); ++i) {
    double at = 0;  // Greville's abscissa: the patch is linear
    for (int k = 1; k <= 3; ++k) at += u[i + k] / (3 * u.domain().length());
    for (int j = 0; j < 2; ++j) net.row(2 * i + j) << std::lerp(from, to, at), j, 0;
  }
  return *Surface::create({u, v}, net);
}

TEST(Morph, SurfacesWithoutFacesStayTogether) {
  const Workshop workshop;
  const std::string file = workshop / "bare.step", out = workshop / "out.step";
  StepBuilder b;
  b.surface(patch(0, 2, 3), "left");
  b.surface(patch(2, 5, 4), "right");
  std::ofstream(file) << b.forward("AUTOMOTIVE_DESIGN");
  const Outcome run = knead({"morph", file, "-o", out, "--space", "0; 0; 0.1*sin(x + 2*y)"});
  ASSERT_EQ(run.code, 0) << run.err;
  const Json report = knead({"check", out, "--json"}).json();
  const auto pairs = std::ranges::count_if(report.at("edges"), [](const Json& edge) {
    return edge.at("id").get<std::string>().find('+') != std::string::npos &&
           edge.at("gap").at("value").get<double>() < 5e-6 &&
           edge.at("angle").at("value").get<double>() < 0.05;
  });
  EXPECT_EQ(pairs, 1) << report.dump(1);
}

TEST(Morph, AnAffineMapOfSpaceIsItsImage) {
  const Workshop workshop;
  const std::string out = workshop / "out.step", report = workshop / "report.json";
  const Outcome run = knead({"morph", bonnet(), "-o", out, "--space", affine, "--report", report});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(run.err, "");
  // Control points are sums of a few thousand terms, written with 17 digits.
  EXPECT_LE(largest_difference(surface_of(out, "#285"), surface_of(bonnet(), "#285"), 1),
            1e-9 * size);
  const Json said = Json::parse(content_of(report));
  EXPECT_LE(said["after"]["largest"], 1e-9 * size);
  EXPECT_EQ(said["points"], said["used"]);
  EXPECT_EQ(said["converted"].size(), 4U);
  EXPECT_EQ(said["edges"].size(), 16U);
  EXPECT_EQ(against(said, knead({"schema", "morph"}).json(), "report"), "");
}

/// A block whose end along x is moved shears its linear half with all points of the faces.
TEST(Morph, ABlockOfSpaceTakesPointsAlong) {
  const Workshop workshop;
  const std::string out = workshop / "out.step";
  const std::string block =
      workshop.file("block.json", R"({"net":[2,2,2],"degree":[1,1,1],"lower":[-2000,-2000,-2000],
                        "upper":[2000,2000,2000],"moves":[{"which":[4,5,6,7],"by":[0,0,40]}]})");
  ASSERT_EQ(knead({"morph", bonnet(), "-o", out, "--space", "lattice:" + block}).code, 0);
  const Surface before = surface_of(bonnet(), "#285"), after = surface_of(out, "#285");
  const Points& net = before.control_points();
  ASSERT_EQ(after.size(), before.size()) << "an affine map";
  for (int k = 0; k < before.size(); ++k) {
    const Point wanted = Point(net.row(k)) + Point(0, 0, 40 * (net(k, 0) + 2000) / 4000);
    EXPECT_LE((Point(after.control_points().row(k)) - wanted).norm(), 1e-9 * size);
  }
}

TEST(Morph, EdgesAreClosedAsBefore) {
  const Workshop workshop;
  const std::string out = workshop / "out.step";
  // A bend and a bulge of some 1 % of the size.
  ASSERT_EQ(knead({"morph", bonnet(), "-o", out, "--space",
                   "0; 10*sin(x/500); 15*cos(y/400)*sin(x/600)", "--tolerance", "0.1"})
                .code,
            0);
  const Outcome before = knead({"check", bonnet(), "--json"}),
                after = knead({"check", out, "--json"});
  ASSERT_EQ(after.code, 0);
  const Json old = before.json()["edges"], now = after.json()["edges"];
  ASSERT_EQ(old.size(), now.size());
  const double tolerance = before.json()["gap_tolerance"];
  for (std::size_t k = 0; k < now.size(); ++k) {
    EXPECT_EQ(now[k]["id"], old[k]["id"]);
    for (const char* measure : {"gap", "off_curve"}) {
      if (now[k][measure].is_null()) continue;
      EXPECT_LE(now[k][measure]["value"].get<double>(),
                std::max(1.01 * old[k][measure]["value"].get<double>(), tolerance))
          << now[k]["id"];
    }
  }
}

TEST(Morph, ScaleZeroIsTheFile) {
  const Workshop workshop;
  const std::string out = workshop / "out.step";
  const Outcome run = knead({"morph", bonnet(), "-o", out, "--space", affine, "--scale", "0"});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_TRUE(identical(content_of(out), content_of(bonnet())));
}

TEST(Morph, SeveralScalesAreSeveralFiles) {
  const Workshop workshop;
  const Outcome run = knead({"morph", bonnet(), "-o", workshop / "out.step", "--space", affine,
                             "--scale", "-1,0.5", "--report", workshop / "r.json"});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(workshop.files(), (std::vector<std::string>{"out_-1.step", "out_0.5.step", "r.json"}));
  const Surface before = surface_of(bonnet(), "#285");
  EXPECT_LE(largest_difference(surface_of(workshop / "out_-1.step", "#285"), before, -1),
            1e-9 * size);
  EXPECT_LE(largest_difference(surface_of(workshop / "out_0.5.step", "#285"), before, 0.5),
            1e-9 * size);
  EXPECT_EQ(Json::parse(content_of(workshop / "r.json")).size(), 2U);
}

TEST(Morph, DisplacementsInAllUnits) {
  const Workshop workshop;
  const std::string out = workshop / "out.step";
  const std::string file = workshop.file("v.csv", "x;y;z;dx;dy;dz\n" + vectors_of(affine_of, ';'));
  const Outcome run = knead({"morph", bonnet(), "-o", out, "--vectors", file});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.out.find("1600 of 1600 points used"), std::string::npos) << run.out;
  EXPECT_LE(largest_difference(surface_of(out, "#285"), surface_of(bonnet(), "#285"), 1),
            1e-8 * size);
  // The same in metres, which must be said.
  std::string metres = "x,y,z,dx,dy,dz\n";
  std::istringstream lines(vectors_of(affine_of));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    for (double x; words >> x;) metres += fmt::format("{},", x / 1000);
    metres.back() = '\n';
  }
  const std::string small = workshop.file("m.csv", metres);
  EXPECT_TRUE(fails_with(knead({"morph", bonnet(), "-o", out, "--vectors", small}), 3,
                         {"the box of the data measures", "--unit", "also if it is mm"}));
  ASSERT_EQ(knead({"morph", bonnet(), "-o", out, "--vectors", small, "--unit", "m"}).code, 0);
  EXPECT_LE(largest_difference(surface_of(out, "#285"), surface_of(bonnet(), "#285"), 1),
            1e-8 * size);
}

TEST(Morph, FarPointsAreLeftOutCountedAndListed) {
  const Workshop workshop;
  const std::string file = workshop.file(
      "v.txt", "700 0 900 0 0 100\n" + vectors_of(affine_of) + "700 0 -900 0 0 100 # below\n");
  const Outcome run = knead({"morph", bonnet(), "-o", workshop / "out.step", "--vectors", file,
                             "--report", workshop / "r.json"});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.out.find("1600 of 1602 points used; 2 farther than"), std::string::npos) << run.out;
  const Json said = Json::parse(content_of(workshop / "r.json"));
  EXPECT_EQ(said["left_out"], 2);
  ASSERT_EQ(said["listed"].size(), 2U);
  EXPECT_EQ(said["listed"][0]["number"], 1);
  EXPECT_EQ(said["listed"][1]["number"], 1602);
  EXPECT_GT(said["listed"][0]["distance"], 0.01 * size);
}

TEST(Morph, APairOfMeshes) {
  const Workshop workshop;
  const std::string from = workshop / "from.stl", out = workshop / "out.step";
  ASSERT_EQ(knead({"mesh", bonnet(), "-o", from, "--tolerance", "2"}).code, 0);
  // Its points, moved, as text with the same corners in the same order.
  const std::string bytes = content_of(from);
  std::string moved = "solid moved\n";
  for (std::size_t k = 84; k + 50 <= bytes.size(); k += 50) {
    moved += "facet normal 0 0 0\nouter loop\n";
    for (std::size_t corner = 0; corner < 3; ++corner) {
      std::array<float, 3> x{};
      std::memcpy(x.data(), bytes.data() + k + 12 + 12 * corner, sizeof(x));
      const Point p(x[0], x[1], x[2]), q = p + affine_of(p);
      moved += fmt::format("vertex {} {} {}\n", q.x(), q.y(), q.z());
    }
    moved += "endloop\nendfacet\n";
  }
  const std::string to = workshop.file("to.stl", moved + "endsolid\n");
  const Outcome run = knead({"morph", bonnet(), "-o", out, "--from", from, "--to", to});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_LE(largest_difference(surface_of(out, "#285"), surface_of(bonnet(), "#285"), 1),
            1e-6 * size)
      << "the points of STL have 24 bits";
  const std::string other = workshop.file("other.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
  EXPECT_TRUE(fails_with(knead({"morph", bonnet(), "-o", out, "--from", from, "--to", other}), 3,
                         {"other.obj: it has 3 points and", "the same mesh"}));
}

TEST(Morph, WhatIsKeptStays) {
  const Workshop workshop;
  const std::string out = workshop / "out.step", report = workshop / "r.json";
  const Outcome run = knead(
      {"morph", bonnet(), "-o", out, "--space", affine, "--keep", "#1044", "--report", report});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(surface_of(out, "#1044").control_points(),
            surface_of(bonnet(), "#1044").control_points());
  const Json said = Json::parse(content_of(report));
  EXPECT_LE(said["after"]["largest"], said["tolerance"]);
  EXPECT_EQ(said["surfaces"].size(), 5U) << "without data for the one that is kept";
}

/// A bend by 1 % of the size of all but one face, which has three edges with others.
TEST(Morph, WhatContradictsAFaceThatStaysFadesOut) {
  const Workshop workshop;
  const std::string out = workshop / "out.step", report = workshop / "r.json";
  const Outcome run = knead({"morph", bonnet(), "-o", out, "--space", "0; 0; 15*cos(x/400)",
                             "--keep", "#595", "--tolerance", "0.1", "--report", report});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.err.find("contradict what stays"), std::string::npos) << run.err;
  const Json said = Json::parse(content_of(report));
  EXPECT_EQ(against(said, knead({"schema", "morph"}).json(), "report"), "");
  int contradicting = 0;
  for (const Json& above : said["above"]) {
    if (above["measure"] == "contradiction") contradicting += above["count"].get<int>();
  }
  EXPECT_GT(contradicting, 0);
  EXPECT_LT(contradicting, 0.05 * said["used"].get<int>());
  EXPECT_LT(said["after"]["of_95"], said["tolerance"]);
  // Every edge is as closed as the tolerance of the check asks.
  const Json before = knead({"check", bonnet(), "--json"}).json();
  const double tolerance = before["gap_tolerance"];
  const Json old = before["edges"], now = knead({"check", out, "--json"}).json()["edges"];
  ASSERT_EQ(old.size(), now.size());
  for (std::size_t k = 0; k < now.size(); ++k) {
    if (now[k]["gap"].is_null()) continue;
    EXPECT_LE(now[k]["gap"]["value"].get<double>(),
              std::max(1.01 * old[k]["gap"]["value"].get<double>(), tolerance))
        << now[k]["id"];
  }
}

TEST(Morph, SaysWhatIsWrongAndWritesNothing) {
  const Workshop workshop;
  const std::string out = workshop / "out.step";
  const auto fails = [&](std::vector<std::string> options, int code,
                         const std::vector<std::string>& named) {
    options.insert(options.begin(), {"morph", bonnet(), "-o", out});
    EXPECT_TRUE(fails_with(knead(options), code, named));
    EXPECT_FALSE(std::filesystem::exists(out));
  };
  const std::string good = workshop.file("v.txt", vectors_of(affine_of));
  const std::string bad = workshop.file("bad.txt", "1 2 3 4 5 6\n1 2 3 nan 5 6\n");
  const std::string far = workshop.file("far.txt", "9000 9000 9000 1 1 1\n9000 9100 9900 1 1 1\n");
  const std::string vtk =
      workshop.file("v.vtk",
                    "# vtk DataFile Version 3.0\n\nASCII\nDATASET POLYDATA\nPOINTS 1 float\n700 0 "
                    "100\nPOINT_DATA "
                    "1\nVECTORS u float\n0 0 1\nSCALARS t float\nLOOKUP_TABLE default\n1\n");
  fails({}, 2, {"--vectors", "nothing says where"});
  fails({"--vectors", good, "--space", affine}, 2, {"several data"});
  fails({"--from", good}, 2, {"--to", "give the other one too"});
  fails({"--vectors", bad}, 3, {"bad.txt:2: nan is no finite number"});
  fails({"--vectors", far}, 3, {"none of 2 points is within", "--unit", "--reach"});
  fails({"--vectors", vtk, "--field", "w"}, 3, {"\"w\"; there are \"u\", \"t\" of 1"});
  fails({"--vectors", good, "--columns", "a,b,c"}, 2, {"--columns: 3 columns are named, not six"});
  fails({"--space", "x;y"}, 2, {"--space", "2 formulas, not three"});
  fails({"--space", "lattice:" + bad}, 2, {"--space: lattice", "this is not JSON"});
  fails({"--space", "lattice:" + workshop / "none.json"}, 3, {"none.json"});
  fails({"--space", "1/(x-x);0;0"}, 3, {"the displacement is not finite"});
  fails({"--space", affine, "--keep", "#9"}, 2,
        {"--keep", "\"#9\" is neither a face nor a surface"});
  fails({"--space", affine, "--faces", "#285", "--keep", "#285"}, 3, {"nothing is free to move"});
  fails({"--space", affine, "--tolerance", "-1"}, 2, {"--tolerance"});
  fails({"--space", affine, "--refine", "0.5"}, 2, {"--refine"});
  fails({"--space", affine, "--scale", "one"}, 2, {"--scale"});
  fails({"--vectors", good, "--unit", "cubit"}, 2, {"--unit", "cubit"});
  fails({"--space", affine, "--place", "nowhere"}, 2, {"--place", "nowhere"});
}

}  // namespace
}  // namespace knead::testing
