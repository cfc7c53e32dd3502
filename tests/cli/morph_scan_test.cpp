// `knead morph --scan`: the sample follows scans of itself, bent and anywhere.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <sstream>

#include "program.hpp"
#include "session/schema_check.hpp"

namespace knead::testing {
namespace {

/// The points of the file's triangles, and what is left of them after a move.
std::string scan_of(const Workshop& workshop, const std::string& file,
                    const Eigen::Affine3d& move) {
  const std::string mesh = workshop / "mesh.obj";
  EXPECT_EQ(knead({"mesh", file, "-o", mesh, "--tolerance", "0.5"}).code, 0);
  std::istringstream lines(content_of(mesh));
  std::string result;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string word;
    Point p;
    if (words >> word; word != "v") {
      if (word == "f") result += line + "\n";
      continue;
    }
    words >> p.x() >> p.y() >> p.z();
    const Point q = move * p;
    result += fmt::format("v {} {} {}\n", q.x(), q.y(), q.z());
  }
  return result;
}

/// Points all over the triangles of an OBJ file, about so far from each other.
std::string points_between(const std::string& mesh, double spacing) {
  std::istringstream lines(mesh);
  std::vector<Point> corners;
  std::string result;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "v") {
      Point p;
      words >> p.x() >> p.y() >> p.z();
      corners.push_back(p);
    }
    if (word != "f") continue;
    std::array<Point, 3> t;
    for (Point& corner : t) {
      words >> word;
      corner = corners[static_cast<std::size_t>(std::stoi(word)) - 1];
    }
    const double longest =
        std::max({(t[1] - t[0]).norm(), (t[2] - t[1]).norm(), (t[0] - t[2]).norm()});
    const double n = std::ceil(longest / spacing);
    for (double i = 1.0 / 3; i < n; ++i) {
      for (double j = 1.0 / 3; i + j < n; ++j) {
        const Point p = t[0] + i / n * (t[1] - t[0]) + j / n * (t[2] - t[0]);
        result += fmt::format("{} {} {}\n", p.x(), p.y(), p.z());
      }
    }
  }
  return result;
}

TEST(MorphScan, AScanOfTheBentPartIsFollowed) {
  const Workshop workshop;
  const std::string bent = workshop / "bent.step", scan = workshop / "scan.xyz",
                    out = workshop / "out.step", report = workshop / "report.json";
  ASSERT_EQ(knead({"morph", bonnet(), "-o", bent, "--space", "0; 0; 8*sin(x/400)*cos(y/300)"}).code,
            0);
  std::ofstream(scan) << points_between(scan_of(workshop, bent, Eigen::Affine3d::Identity()), 20);
  const Outcome run = knead({"morph", bonnet(), "-o", out, "--scan", scan, "--report", report});
  ASSERT_EQ(run.code, 0) << run.err;
  const Json said = Json::parse(content_of(report));
  EXPECT_EQ(against(said, knead({"schema", "morph"}).json(), "report"), "");
  EXPECT_GT(said["used"].get<int>(), 0.9 * said["points"].get<int>());
  EXPECT_TRUE(said["scan"]["noise_estimated"]);
  EXPECT_LT(said["scan"]["rms_after"], 0.02 * said["scan"]["rms_before"].get<double>());
  // Every point of the scan, those that were left out too, is on the new part.
  const Outcome again = knead({"morph", out, "-o", workshop / "again.step", "--scan", scan,
                               "--scale", "0", "--report", report});
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_LT(Json::parse(content_of(report))["rms_distance"], 0.1);
}

TEST(MorphScan, AScanLiesAnywhere) {
  const Workshop workshop;
  const std::string scan = workshop / "scan.obj", out = workshop / "out.step",
                    report = workshop / "report.json";
  const Eigen::Affine3d move = Eigen::Translation3d(4000, -300, 900) *
                               Eigen::AngleAxisd(2.2, Point(1, -2, 0.5).normalized());
  std::ofstream(scan) << scan_of(workshop, bonnet(), move);
  const Outcome lost = knead({"morph", bonnet(), "-o", out, "--scan", scan});
  EXPECT_EQ(lost.code, 3);
  EXPECT_NE(lost.err.find("--align"), std::string::npos) << lost.err;
  const Outcome run =
      knead({"morph", bonnet(), "-o", out, "--scan", scan, "--align", "--report", report});
  ASSERT_EQ(run.code, 0) << run.err;
  const Json laid = Json::parse(content_of(report))["scan"]["alignment"];
  const Eigen::Matrix3d back = move.rotation().transpose();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      EXPECT_NEAR(laid["rotation"][row][column].get<double>(), back(row, column), 1e-3);
  }
  EXPECT_GT(laid["rms_before"], 1000);
  EXPECT_LT(laid["rms_after"], 1);
}

}  // namespace
}  // namespace knead::testing
