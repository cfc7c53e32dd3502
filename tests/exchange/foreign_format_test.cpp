#include <gtest/gtest.h>

#include "exchange/step/file.hpp"
#include "knead/exchange/format.hpp"

namespace knead {
namespace {

using namespace std::string_literals;

struct Foreign {
  std::string bytes, named;
};

std::string iges_line(const std::string& text, char section) {
  return text + std::string(72 - text.size(), ' ') + section + "      1\n";
}

std::string binary_stl() {
  std::string bytes(84 + 2 * 50, '\0');
  bytes.replace(0, 5, "solid");  // as some writers begin binary files, too
  bytes[80] = 2;
  return bytes;
}

std::vector<Foreign> foreign_files() {
  return {{iges_line("a plate", 'S') + iges_line("1H,,1H;", 'G'), "IGES"},
          {"3D Geometry File Format        4"s + std::string(100, '\0'), "Rhino"},
          {"\nCASCADE Topology V1, (c) Matra-Datavision\nLocations 0\n", "Open CASCADE"},
          {"DBRep_DrawableShape\n\nCASCADE Topology V3\n", "Open CASCADE"},
          {"**ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz**\n", "Parasolid"},
          {"PS\0\0\0\x33: TRANSMIT FILE created by modeller version 3000000"s, "Parasolid"},
          {"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1"s + std::string(600, '\0'), "SolidWorks"},
          {"V5_CFV2\0\0\0"s, "CATIA"},
          {"solid plate\nfacet normal 0 0 1\nouter loop\n", "STL"},
          {binary_stl(), "STL"},
          {"glTF\x02\0\0\0"s, "glTF"},
          {R"({"asset": {"version": "2.0"}, "scenes": []})", "glTF"},
          {"ply\nformat ascii 1.0\n", "PLY"},
          {"PK\x03\x04\x14"s, "ZIP"},
          {"\x1F\x8B\x08"s, "gzip"},
          {"<?xml version=\"1.0\"?>\n<iso_10303_28_terse schema=\"AP242\">", "XML"},
          {"\xFF\xFEI\0S\0O\0"s, "UTF-16"},
          {"", "empty"}};
}

TEST(ForeignFormat, AFileOfAnotherFormatIsRecognisedByItsContentAndTheErrorSaysWhatToDo) {
  for (const auto& [bytes, named] : foreign_files()) {
    for (const std::string name : {"part.step", "part", "part.prt"}) {
      const auto source = open_source(bytes, name);
      ASSERT_FALSE(source) << named;
      const Error& error = source.error();
      EXPECT_NE(error.what.find(named), std::string::npos) << named << ": " << error.message();
      EXPECT_FALSE(error.remedy.empty());
      EXPECT_EQ(error.file, name);
    }
    const auto file = step::File::parse(bytes, "x.step");
    ASSERT_FALSE(file);
    EXPECT_NE(file.error().what.find(named), std::string::npos) << file.error().message();
  }
}

TEST(ForeignFormat, AStepFileThatMentionsOtherFormatsAndTextThatIsNothingAreNotTakenForThem) {
  const auto step = step::File::parse(
      "/* solid: made of a glTF, CASCADE Topology V1 */ "
      "ISO-10303-21;HEADER;FILE_DESCRIPTION((''),'2;1');"
      "FILE_NAME('','',(''),(''),'','','');FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));ENDSEC;DATA;ENDSEC;"
      "END-ISO-10303-21;",
      "x.step");
  EXPECT_TRUE(step) << step.error().message();
  const auto text = step::File::parse("Dear all, the part is attached.\n", "x.step");
  ASSERT_FALSE(text);
  EXPECT_NE(text.error().what.find("does not begin with the line ISO-10303-21"), std::string::npos);
  const auto unknown = open_source("Dear all", "x.txt");
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().what.find("not known"), std::string::npos);
}

}  // namespace
}  // namespace knead
