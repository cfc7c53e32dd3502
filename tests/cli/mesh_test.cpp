#include "program.hpp"

namespace knead::testing {
namespace {

TEST(Mesh, WritesEveryFormat) {
  const Workshop workshop;
  for (const char* name : {"a.stl", "a.obj", "A.PLY", "a.glb"}) {
    const Outcome run =
        knead({"mesh", bonnet(), "--out", workshop / name, "--untrimmed", "--detail", "20"});
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_NE(run.out.find("(2 surfaces, "), std::string::npos) << run.out;
    const std::string bytes = content_of(workshop / name);
    EXPECT_NE(run.out.find(std::to_string(bytes.size()) + " bytes"), std::string::npos) << run.out;
    EXPECT_NE(bytes.find("lengths in mm"), std::string::npos);
  }
  EXPECT_TRUE(content_of(workshop / "a.stl").starts_with("Knead"))
      << "not `solid`, which would be text";
  EXPECT_TRUE(content_of(workshop / "A.PLY").starts_with("ply\nformat binary_little_endian 1.0\n"));
}

TEST(Mesh, WritesTheTrimmedModel) {
  const Workshop workshop;
  std::size_t coarse = 0;
  for (const char* tolerance : {"5", "0.5"}) {
    const Outcome run =
        knead({"mesh", bonnet(), "--out", workshop / "a.stl", "--tolerance", tolerance});
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_TRUE(run.err.empty()) << run.err;
    // The sample is an open sheet with the faces around it.
    EXPECT_NE(run.out.find("(6 faces, "), std::string::npos) << run.out;
    EXPECT_NE(run.out.find(", open along "), std::string::npos) << run.out;
    const std::size_t size = content_of(workshop / "a.stl").size();
    EXPECT_GT(size, 2 * coarse);
    coarse = size;
  }
  for (const char* name : {"a.obj", "a.ply", "a.glb"})
    EXPECT_EQ(knead({"mesh", bonnet(), "--out", workshop / name}).code, 0);
}

TEST(Mesh, SaysWhatIsWrong) {
  const Workshop workshop;
  EXPECT_TRUE(fails_with(knead({"mesh", bonnet(), "--out", workshop / "a.3mf"}), 2,
                         {"--out", ".stl, .obj, .ply or .glb"}));
  EXPECT_TRUE(fails_with(
      knead({"mesh", bonnet(), "--out", workshop / "a.stl", "--untrimmed", "--detail", "0"}), 2,
      {"--detail", "1 to 2000"}));
  EXPECT_TRUE(fails_with(knead({"mesh", bonnet(), "--out", workshop / "a.stl", "--detail", "9"}), 2,
                         {"--untrimmed"}));
  EXPECT_TRUE(fails_with(knead({"mesh", bonnet(), "--out", workshop / "a.stl", "--tolerance", "0"}),
                         2, {"--tolerance"}));
  EXPECT_TRUE(
      fails_with(knead({"mesh", bonnet(), "--out", workshop / "a.stl", "--tolerance", "1e-9"}), 2,
                 {"--tolerance", "a length above"}));
  EXPECT_TRUE(fails_with(knead({"mesh", workshop / "none.step", "--out", workshop / "a.stl"}), 3,
                         {"none.step"}));
  EXPECT_TRUE(
      fails_with(knead({"mesh", bonnet(), "--out", workshop / "no/a.stl"}), 3, {"no/a.stl"}));
  EXPECT_TRUE(fails_with(knead({"mesh", bonnet()}), 2, {"--out"}));
  EXPECT_TRUE(workshop.files().empty());
}

}  // namespace
}  // namespace knead::testing
