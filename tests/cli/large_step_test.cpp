// Large STEP files take memory in proportion to their size, and little of it.
#include <cmath>
#include <filesystem>
#include <fstream>

#include "less_memory.hpp"
#include "program.hpp"
#include "support/sanitized.hpp"

namespace knead::testing {
namespace {

constexpr int side = 40, surfaces = 200;

/// Surfaces beside each other, with a net of `side` times `side` points that no other uses.
void write_surfaces(const std::string& path) {
  std::ofstream out(path);
  out.precision(17);
  out << "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','',''"
         ");\n"
         "FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\n";
  int id = 1;
  for (int s = 0; s < surfaces; ++s) {
    std::string net;
    for (int i = 0; i < side; ++i) {
      net += i == 0 ? "((" : "),(";
      for (int j = 0; j < side; ++j) {
        out << '#' << id << "=CARTESIAN_POINT('point',(" << std::fixed << 2 * s + i / 40.0 << ','
            << j / 40.0 << ',' << std::sin(i + j) / 100 << "));\n";
        net += (j == 0 ? "#" : ",#") + std::to_string(id++);
      }
    }
    const std::string knots = "(4,4)", last = std::to_string(side - 3);
    std::string multiplicities = "(4", values = "(0.";
    for (int k = 1; k < side - 3; ++k) {
      multiplicities += ",1";
      values += "," + std::to_string(k) + ".";
    }
    multiplicities += ",4)";
    values += "," + last + ".)";
    out << '#' << id++ << "=B_SPLINE_SURFACE_WITH_KNOTS('sheet',3,3," << net
        << ")),.UNSPECIFIED.,.F.,.F.,.F.," << multiplicities << ',' << multiplicities << ','
        << values << ',' << values << ",.UNSPECIFIED.);\n";
  }
  out << "ENDSEC;\nEND-ISO-10303-21;\n";
}

TEST(LargeStep, IsListedAndChangedInFourTimesItsSize) {
  if (sanitized()) GTEST_SKIP() << "the sanitizer reserves more";
  const Workshop workshop;
  const std::string file = workshop / "large.step", out = workshop / "out.step";
  write_surfaces(file);
  const std::string script =
      workshop.script(Json::array({command("select", {{"surface", "#1601"}}),
                                   command("points", {{"which", {820}}, {"by", {0, 0, 1}}})}));
  const auto size = std::filesystem::file_size(file);
  ASSERT_GT(size, 20U << 20U);
  const rlim_t program = rlim_t{44} << 20U;  // its code, libraries and stack
  const LessMemory limit(program + 4 * size);
  const Outcome info = knead({"info", file});
  EXPECT_EQ(info.code, 0) << info.err;
  EXPECT_NE(info.out.find("200 B-spline surfaces"), std::string::npos);
  const Outcome sculpt = knead({"sculpt", file, "-o", out, "--script", script});
  EXPECT_EQ(sculpt.code, 0) << sculpt.err;
  EXPECT_NE(sculpt.out.find("(1 surface changed)"), std::string::npos) << sculpt.out;
}

}  // namespace
}  // namespace knead::testing
