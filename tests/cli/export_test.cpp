#include <algorithm>

#include "program.hpp"
#include "step_sheet.hpp"

namespace knead::testing {
namespace {

TEST(Export, WritesTheSameFacesInEveryFormatAndSchema) {
  const Workshop workshop;
  const Json before = knead({"info", bonnet(), "--json"}).json().at("surfaces");
  for (const char* name : {"a.step", "b.stp", "c.igs", "d.iges"}) {
    for (const char* schema : {"ap214", "ap242"}) {
      const std::string out = workshop / name;
      const bool step = std::string(name).find(".st") != std::string::npos;
      std::vector<std::string> arguments = {"export", bonnet(), "--out", out};
      if (step) arguments.insert(arguments.end(), {"--schema", schema});
      const Outcome run = knead(arguments);
      ASSERT_EQ(run.code, 0) << run.err;
      EXPECT_EQ(run.err, "");
      EXPECT_NE(run.out.find("6 faces"), std::string::npos) << run.out;
      const Json info = knead({"info", out, "--json"}).json();
      EXPECT_EQ(info.at("units"), "mm");
      // Swept surfaces are B-splines in IGES; the others have lost nothing.
      ASSERT_GE(info.at("surfaces").size(), before.size());
      for (std::size_t k = 0; k < before.size(); ++k) {
        const auto found = std::ranges::find_if(info.at("surfaces"), [&](const Json& other) {
          return other.at("knots") == before[k].at("knots") &&
                 other.at("bounding_box") == before[k].at("bounding_box");
        });
        ASSERT_NE(found, info.at("surfaces").end());
        const Json& s = *found;
        EXPECT_EQ(s.at("knots"), before[k].at("knots"));
        EXPECT_EQ(s.at("bounding_box"), before[k].at("bounding_box"));
        EXPECT_EQ(s.at("weights"), before[k].at("weights"));
        EXPECT_EQ(s.at("faces"), 1);
        EXPECT_EQ(s.at("trimmed"), before[k].at("trimmed"));
      }
      EXPECT_EQ(info.at("schema"), !step ? ""
                                   : std::string_view(schema) == "ap242"
                                       ? "AP242_MANAGED_MODEL_BASED_3D_ENGINEERING_MIM_LF"
                                       : "AUTOMOTIVE_DESIGN");
    }
  }
}

TEST(Export, ConvertsFacesOnRequest) {
  const Workshop workshop;
  const std::string out = workshop / "a.step";
  const Outcome run = knead({"export", bonnet(), "--out", out, "--convert"});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(run.err, "");
  EXPECT_EQ(knead({"info", out, "--json"}).json().at("surfaces").size(), 6U);
  EXPECT_TRUE(
      fails_with(knead({"export", bonnet(), "--out", workshop / "b.step", "--convert", "--sets"}),
                 2, {"--convert", "--sets"}));
}

TEST(Export, BareSurfacesLoseTheirTrimsAndSaySo) {
  const Workshop workshop;
  const Outcome run = knead({"export", bonnet(), "--out", workshop / "a.step", "--sets"});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.err.find("left out: 1 surface's trims (#285)"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("left out: 4 surfaces of other forms ("), std::string::npos) << run.err;
}

TEST(Export, ASculptedFileBecomesTheSameFileOfAnotherFormatAtOnce) {
  const Workshop workshop;
  const std::string script = workshop.script(
      Json::array({command("select", {{"surface", "#285"}}), command("hold", {{"rows", 1}}),
                   command("tool", {{"radius", 0.1}, {"relative", true}, {"at", {0.4, 0.5}}}),
                   command("move", {{"by", {0, 0, 0.05}}, {"relative", true}}),
                   command("step", {{"count", 2}, {"lambda", 10}}),
                   command("hold", {{"mode", "open"}, {"all", true}})}));
  const std::string step = workshop / "a.step", at_once = workshop / "a.igs",
                    after = workshop / "b.igs";
  ASSERT_EQ(knead({"sculpt", bonnet(), "-o", step, "--script", script}).code, 0);
  const Outcome run = knead({"sculpt", bonnet(), "-o", at_once, "--script", script});
  ASSERT_EQ(run.code, 0) << run.err;
  ASSERT_EQ(knead({"export", step, "--out", after}).code, 0);
  EXPECT_TRUE(identical(content_of(at_once), content_of(after)));
  EXPECT_FALSE(identical(content_of(step), content_of(bonnet())));
}

TEST(Export, RefusesOtherNamesAndSchemas) {
  const Workshop workshop;
  EXPECT_TRUE(fails_with(knead({"export", bonnet(), "--out", workshop / "a.brep"}), 2,
                         {"--out", ".step", ".igs"}));
  EXPECT_TRUE(
      fails_with(knead({"export", bonnet(), "--out", workshop / "a.step", "--schema", "ap209"}), 2,
                 {"--schema"}));
  EXPECT_TRUE(fails_with(knead({"export", bonnet(), "--out", bonnet()}), 2, {"--out"}));
  EXPECT_TRUE(workshop.files().empty());
}

TEST(Export, TakesAUnitWhereTheFileHasNone) {
  const Workshop workshop;
  const std::string bare = workshop.file(
      "square.g2", "200 1 0 0\n3 0\n2 2\n0 0 1 1\n2 2\n0 0 1 1\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n");
  for (const std::string name : {"a.step", "b.igs"}) {
    const std::string out = workshop / name;
    const Outcome run = knead({"export", bare, "--out", out, "--unit", "inch"});
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_EQ(run.out.find("millimetres"), std::string::npos) << run.out;
    EXPECT_EQ(knead({"info", out, "--json"}).json().at("units"), "inch");
    EXPECT_NE(knead({"export", bare, "--out", out}).out.find("written as millimetres"),
              std::string::npos);
  }
  EXPECT_TRUE(fails_with(knead({"export", bare, "--out", workshop / "c.step", "--unit", "ell"}), 2,
                         {"ell", "mm", "inch"}));
  EXPECT_TRUE(fails_with(knead({"export", bonnet(), "--out", workshop / "c.step", "--unit", "m"}),
                         2, {"--unit", "in mm"}));
}

TEST(Export, LeavesOutWhatHasNoFaceAndSaysSo) {
  const Workshop workshop;
  const std::string script = workshop.script(
      Json::array({command("new", {{"shape", "plane"}}),
                   command("new", {{"shape", "plane"}, {"size", 1e-12}, {"name", "tip"}})}));
  ASSERT_EQ(knead({"sculpt", "--new", "-o", workshop / "both.step", "--script", script}).code, 0);
  for (const std::string name : {"a.step", "b.igs"}) {
    const Outcome run = knead({"export", workshop / "both.step", "--out", workshop / name});
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_NE(run.err.find("left out: 1 surface (#"), std::string::npos) << run.err;
    EXPECT_EQ(knead({"info", workshop / name, "--json"}).json().at("surfaces").size(), 1U);
  }
  ASSERT_EQ(knead({"export", workshop / "both.step", "--out", workshop / "c.step", "--sets"}).code,
            0);
  EXPECT_EQ(knead({"info", workshop / "c.step", "--json"}).json().at("surfaces").size(), 2U);
}

TEST(Export, NewSurfacesBecomeStepOfAnySchemaOrIges) {
  const Workshop workshop;
  const std::string script = workshop.script(Json::array({command("new", {{"shape", "plane"}})}));
  for (const std::string name : {"a.step", "b.igs"}) {
    const Outcome run = knead({"sculpt", "--new", "-o", workshop / name, "--script", script});
    ASSERT_EQ(run.code, 0) << run.err;
    const Json info = knead({"info", workshop / name, "--json"}).json();
    EXPECT_EQ(info.at("format"), name == "a.step" ? "STEP" : "IGES");
    EXPECT_EQ(info.at("surfaces").size(), 1U);
  }
  ASSERT_EQ(
      knead({"sculpt", "--new", "-o", workshop / "c.step", "--script", script, "--schema", "ap242"})
          .code,
      0);
  EXPECT_EQ(knead({"info", workshop / "c.step", "--json"}).json().at("schema"),
            "AP242_MANAGED_MODEL_BASED_3D_ENGINEERING_MIM_LF");
  EXPECT_TRUE(fails_with(knead({"sculpt", bonnet(), "-o", workshop / "d.step", "--script", script,
                                "--schema", "ap242"}),
                         2, {"--schema", "a file keeps its schema"}));
}

}  // namespace
}  // namespace knead::testing
