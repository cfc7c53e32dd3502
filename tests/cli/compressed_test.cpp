#include "knead/exchange/file_io.hpp"
#include "program.hpp"

namespace knead::testing {
namespace {

/// The bonnet, compressed.
std::string packed(const Workshop& workshop, const std::string& name, Compression kind) {
  return workshop.file(name, *compress(content_of(bonnet()), kind, "bonnet.stp"));
}

std::string unpacked(const std::string& path) {
  return uncompress(content_of(path)).value_or("not compressed");
}

TEST(CompressedFiles, AreDescribedWithWhatTheyHold) {
  const Workshop workshop;
  for (const auto& [name, kind, said] :
       {std::tuple("a.stpZ", Compression::zip, "ZIP: entry \"bonnet.stp\""),
        std::tuple("a.step.gz", Compression::gzip, "gzip: "),
        std::tuple("a.step", Compression::gzip, "gzip: ")}) {
    const std::string file = packed(workshop, name, kind);
    const Outcome text = knead({"info", file});
    ASSERT_EQ(text.code, 0) << text.err;
    EXPECT_NE(text.out.find("compressed as " + std::string(said)), std::string::npos) << text.out;
    Json info = knead({"info", file, "--json"}).json(),
         plain = knead({"info", bonnet(), "--json"}).json();
    for (Json* each : {&info, &plain}) {
      each->erase("file");
      each->erase("remarks");
    }
    EXPECT_EQ(info, plain);
  }
}

TEST(CompressedFiles, TheEndingOfTheOutputDecidesAndAnEmptyScriptKeepsAllBytes) {
  const Workshop workshop;
  const std::string zip = packed(workshop, "a.stpZ", Compression::zip),
                    gzip = packed(workshop, "a.step.gz", Compression::gzip),
                    misnamed = packed(workshop, "b.step", Compression::gzip),
                    script = workshop.script(Json::array());
  const auto sculpted = [&](const std::string& from, const std::string& name) {
    const Outcome run = knead({"sculpt", from, "-o", workshop / name, "--script", script});
    EXPECT_EQ(run.code, 0) << run.err;
    return content_of(workshop / name);
  };
  EXPECT_TRUE(identical(sculpted(zip, "same.stpZ"), content_of(zip)));
  EXPECT_TRUE(identical(sculpted(gzip, "same.p21.gz"), content_of(gzip)));
  EXPECT_TRUE(identical(sculpted(misnamed, "same.step"), content_of(gzip)))
      << "as the input, of the same ending";
  EXPECT_TRUE(identical(sculpted(zip, "none"), content_of(zip)))
      << "as the input, where the name says nothing";
  for (const std::string& from : {zip, gzip, bonnet()}) {
    EXPECT_TRUE(identical(sculpted(from, "plain.stp"), content_of(bonnet())));
    EXPECT_EQ(compression_of(sculpted(from, "made.stpZ")), Compression::zip);
    EXPECT_TRUE(identical(unpacked(workshop / "made.stpZ"), content_of(bonnet())));
    EXPECT_EQ(compression_of(sculpted(from, "made.step.gz")), Compression::gzip);
    EXPECT_TRUE(identical(unpacked(workshop / "made.step.gz"), content_of(bonnet())));
  }
}

TEST(CompressedFiles, AreExportedAndRefusedAsTheirNamesSay) {
  const Workshop workshop;
  const std::string zip = packed(workshop, "a.stpZ", Compression::zip);
  ASSERT_EQ(knead({"export", zip, "-o", workshop / "b.igs.gz"}).code, 0);
  EXPECT_EQ(knead({"info", workshop / "b.igs.gz", "--json"}).json().at("format"), "IGES");
  EXPECT_TRUE(fails_with(knead({"mesh", zip, "-o", workshop / "b.stl.gz"}), 2, {"--out", ".stl"}));
  EXPECT_TRUE(fails_with(knead({"sculpt", zip, "-o", workshop / "c.g2.gz", "--script",
                                workshop.script(Json::array())}),
                         2, {"--output"}));
}

TEST(CompressedFiles, MayHoldAsMuchAsTheOptionSays) {
  const Workshop workshop;
  std::string large = content_of(bonnet());
  large.append(std::size_t{2} << 20, ' ');
  const std::string file = workshop.file("a.step.gz", *compress(large, Compression::gzip, ""));
  EXPECT_EQ(knead({"info", file}).code, 0);
  EXPECT_EQ(knead({"info", file, "--max-unpacked", "3"}).code, 0);
  EXPECT_TRUE(fails_with(knead({"info", file, "--max-unpacked", "2"}), 3,
                         {"a.step.gz", "more than the 2 ", "--max-unpacked"}));
  EXPECT_TRUE(fails_with(knead({"info", file, "--max-unpacked", "4096"}), 2, {"--max-unpacked"}));
}

}  // namespace
}  // namespace knead::testing
