#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>

#include "house/rules.hpp"

namespace knead::house {
namespace {

namespace fs = std::filesystem;

TEST(House, KeepsItsRules) {
  for (const std::string& violation : violations(KNEAD_SOURCE_DIR)) ADD_FAILURE() << violation;
}

TEST(House, IsReallyInspected) {
  EXPECT_TRUE(fs::exists(fs::path(KNEAD_SOURCE_DIR) / "include/knead/base/error.hpp"));
}

std::string contents(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

TEST(House, ListsAndTestsEveryCodeOfErrors) {
  const fs::path root = KNEAD_SOURCE_DIR;
  const std::string header = contents(root / "include/knead/base/error_code.hpp"),
                    page = contents(root / "docs/errors.md");
  std::string tests;
  for (const auto& entry : fs::recursive_directory_iterator(root / "tests")) {
    if (entry.path().extension() == ".cpp") tests += contents(entry.path());
  }
  const std::regex enumerator(R"(\n  (\w+), )");
  int count = 0;
  for (std::sregex_iterator it(header.begin(), header.end(), enumerator), end; it != end;
       ++it, ++count) {
    const std::string name = (*it)[1];
    EXPECT_NE(page.find("| `" + name + "` |"), std::string::npos)
        << "docs/errors.md does not list " << name;
    EXPECT_TRUE(name == "none" || tests.contains("ErrorCode::" + name))
        << "no test expects " << name;
  }
  EXPECT_GT(count, 30);
}

/// A small tree of sources that is written, inspected and removed.
class Tree : public testing::Test {
 protected:
  Tree() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    root_ = fs::temp_directory_path() /
            ("knead-house-" + std::to_string(getpid()) + "-" + test->name());
    fs::remove_all(root_);
    write("src/rooms.txt",
          "# From the ground up.\nbase: errors\nspline: bases\ngramian: bands\nbrep: "
          "faces\nexchange: files\nsession: acts\n");
    write("include/knead/base/error.hpp", "#pragma once\n");
    write("include/knead/spline/basis.hpp",
          "// Why.\n#pragma once\n#include \"knead/base/error.hpp\"\n");
    write("docs/api.md",
          "| [error](../include/knead/base/error.hpp) | |\n| "
          "[basis](../include/knead/spline/basis.hpp) | |\n");
    write("src/spline/basis.cpp",
          "#include \"knead/spline/basis.hpp\"\n\n#include \"detail.hpp\"\n");
    write("src/spline/detail.hpp",
          "#pragma once\n// No throw here, nor a \"try\".\nconst char* s = \"catch\";\n");
  }
  ~Tree() override { fs::remove_all(root_); }

  void write(const std::string& name, const std::string& text) {
    fs::create_directories((root_ / name).parent_path());
    std::ofstream(root_ / name) << text;
  }

  /// Expects exactly one violation, and that it is this one.
  void expect_only(const std::string& expected) {
    const auto found = violations(root_);
    ASSERT_EQ(found.size(), 1u) << testing::PrintToString(found);
    EXPECT_EQ(found.front(), expected);
  }

  fs::path root_;
};

TEST_F(Tree, InOrderIsAccepted) { EXPECT_EQ(violations(root_), std::vector<std::string>{}); }

TEST_F(Tree, RoomThatIncludesARoomBuiltOnItIsFound) {
  write("src/base/error.cpp",
        "#include \"knead/base/error.hpp\"\n#include \"knead/spline/basis.hpp\"\n");
  expect_only(
      "src/base/error.cpp:2: the room base must not include the room spline, which is built on it");
}

TEST_F(Tree, HeaderThatIncludesARoomBuiltOnItIsFound) {
  write("include/knead/base/error.hpp", "#pragma once\n#  include \"knead/spline/basis.hpp\"\n");
  expect_only(
      "include/knead/base/error.hpp:2: the room base must not include the room spline, which is "
      "built on it");
}

TEST_F(Tree, InternalsOfARoomServeTheRoomsBuiltOnIt) {
  write("src/base/rule.hpp", "#pragma once\n");
  write("src/spline/detail.hpp", "#pragma once\n#include \"base/rule.hpp\"\n");
  EXPECT_EQ(violations(root_), std::vector<std::string>{});
}

TEST_F(Tree, RoomThatIncludesInternalsOfARoomBuiltOnItIsFound) {
  write("src/base/rule.hpp", "#pragma once\n#include \"spline/detail.hpp\"\n");
  expect_only(
      "src/base/rule.hpp:2: the room base must not include the room spline, which is built on it");
}

TEST_F(Tree, InternalsThatDoNotExistAreFound) {
  write("src/spline/detail.hpp", "#pragma once\n#include \"base/rule.hpp\"\n");
  expect_only("src/spline/detail.hpp:2: \"base/rule.hpp\" does not exist");
}

TEST_F(Tree, PublicHeaderThatIncludesInternalsIsFound) {
  write("include/knead/spline/basis.hpp", "#pragma once\n#include \"spline/detail.hpp\"\n");
  expect_only("include/knead/spline/basis.hpp:2: \"spline/detail.hpp\" is no public header");
}

TEST_F(Tree, SourceThatIncludesItsInternalHeaderLateIsFound) {
  write("src/spline/detail.cpp", "#include <vector>\n#include \"detail.hpp\"\n");
  expect_only("src/spline/detail.cpp:1: the first include is not the file's own header");
}

TEST_F(Tree, FoldersOfARoomMayIncludeEachOther) {
  write("src/brep/loop.hpp", "#pragma once\n");
  write("src/brep/mesh/chart.hpp", "#pragma once\n#include \"brep/loop.hpp\"\n");
  EXPECT_EQ(violations(root_), std::vector<std::string>{});
}

TEST_F(Tree, FormatThatIsNamedOutsideOfItsFolderIsFound) {
  write("src/exchange/step/file.hpp", "#pragma once\nnamespace knead::step { struct File; }\n");
  write("src/exchange/step/read.cpp", "knead::step::File* file;  // iges::File\n");
  write("src/session/open.cpp", "\n// step::File\nstep::File* file;\n");
  expect_only("src/session/open.cpp:3: the format step is named outside of its folder");
}

TEST_F(Tree, FolderOfManyFilesIsFound) {
  for (int k = 0; k < 45; ++k)
    write("src/exchange/step/x" + std::to_string(k) + ".hpp", "#pragma once\n");
  EXPECT_EQ(violations(root_), std::vector<std::string>{});
  write("src/exchange/step/y.cpp", "int y;\n");
  expect_only("src/exchange/step: 46 files; 45 are allowed");
}

TEST_F(Tree, FileOfAFolderMayHaveTheNameOfOneOfTheRoom) {
  write("include/knead/exchange/format.hpp", "#pragma once\n");
  write("docs/api.md",
        "| [error](../include/knead/base/error.hpp) | |\n| "
        "[basis](../include/knead/spline/basis.hpp) | |\n"
        "| [format](../include/knead/exchange/format.hpp) | |\n");
  write("src/exchange/format.cpp", "#include \"knead/exchange/format.hpp\"\n");
  write("src/exchange/step/format.cpp", "#include <array>\n");
  EXPECT_EQ(violations(root_), std::vector<std::string>{});
}

TEST_F(Tree, PublicHeaderThatThePageDoesNotListIsFound) {
  write("include/knead/spline/spline.hpp", "#pragma once\n");
  expect_only("include/knead/spline/spline.hpp: docs/api.md does not list this header");
}

TEST_F(Tree, InternalHeaderInTheCommandLineIsFound) {
  write("src/spline/detail.hpp", "#pragma once\n");
  write("examples/draw.hpp", "#pragma once\n");
  write("examples/draw.cpp", "#include \"draw.hpp\"\n#include \"knead/spline/basis.hpp\"\n");
  EXPECT_EQ(violations(root_), std::vector<std::string>{});
  write("apps/knead/info.cpp",
        "#include \"knead/base/error.hpp\"\n#include \"spline/detail.hpp\"\n");
  expect_only("apps/knead/info.cpp:2: \"spline/detail.hpp\" is no public header");
}

TEST_F(Tree, TooManyPublicHeadersAreFound) {
  std::string list;
  for (const char* name : {"base/error", "spline/basis"}) {
    list += std::string("(../include/knead/") + name + ".hpp)\n";
  }
  for (int k = 0; k < 100; ++k) {
    const std::string name = "knead/spline/basis_" + std::to_string(k) + ".hpp";
    write("include/" + name, "#pragma once\n");
    list += "(../include/" + name + ")\n";
  }
  write("docs/api.md", list);
  expect_only("include/knead: 102 public headers; 60 are allowed");
}

TEST_F(Tree, ListedHeaderThatDoesNotExistIsFound) {
  fs::remove(root_ / "include/knead/base/error.hpp");
  write("include/knead/spline/basis.hpp", "#pragma once\n");
  expect_only("docs/api.md:1: include/knead/base/error.hpp does not exist");
}

TEST_F(Tree, DecompositionOutsideOfItsDoorIsFound) {
  for (const auto& [code, name] :
       {std::pair{"Eigen::ColPivHouseholderQR<Matrix> qr(a);", "ColPivHouseholderQR"},
        std::pair{"auto x = a.ldlt().solve(b);", "ldlt"},
        std::pair{"Eigen::SimplicialLDLT<Sparse> factor;", "SimplicialLDLT"},
        std::pair{"x = a.partialPivLu().solve(b);", "partialPivLu"}}) {
    write("src/spline/basis.cpp",
          std::string("#include \"knead/spline/basis.hpp\"\n") + code + "\n");
    expect_only("src/spline/basis.cpp:2: " + std::string(name) +
                " is used outside of base/decompositions.hpp");
  }
  write("src/spline/basis.cpp", "#include \"knead/spline/basis.hpp\"\n");
  write("src/base/decompositions.cpp", "Eigen::LLT<Eigen::MatrixXd> llt;\n");
  EXPECT_EQ(violations(root_), std::vector<std::string>{});
}

TEST_F(Tree, UnknownRoomIsFound) {
  write("src/attic/box.hpp", "#pragma once\n");
  expect_only("src/attic: there is no room of this name");
}

TEST_F(Tree, TableOfOtherRoomsIsFound) {
  const std::string begin =
      "Rooms:\n\n<!-- rooms -->\n| room | what lives there |\n|---|---|\n| `base` | errors |\n";
  const std::string rest =
      "| `gramian` | bands |\n| `brep` | faces |\n| `exchange` | files |\n| `session` | acts "
      "|\n<!-- end of rooms -->\n";
  write("README.md", begin + "| `spline` | bases |\n" + rest);
  EXPECT_EQ(violations(root_), std::vector<std::string>{});
  write("README.md", begin + rest);
  expect_only("README.md:3: the table of rooms is not that of src/rooms.txt: run scripts/docs.sh");
}

TEST_F(Tree, FileOutsideOfEveryRoomIsFound) {
  write("src/stray.cpp", "\n");
  expect_only("src/stray.cpp: the file stands outside of every room");
}

TEST_F(Tree, IncludeOfAnApplicationIsFound) {
  write("src/spline/detail.hpp", "#pragma once\n#include \"../../apps/knead/options.hpp\"\n");
  write("apps/knead/options.hpp", "#pragma once\n");
  expect_only("src/spline/detail.hpp:2: \"../../apps/knead/options.hpp\" is no file of this room");
}

TEST_F(Tree, IncludeOfAnOracleIsFound) {
  write("src/spline/detail.hpp", "#pragma once\n#include <Geom_BSplineSurface.hxx>\n");
  expect_only(
      "src/spline/detail.hpp:2: <Geom_BSplineSurface.hxx> belongs to the programs on top, not to a "
      "room");
}

TEST_F(Tree, IncludeThatDoesNotExistIsFound) {
  write("src/spline/detail.hpp", "#pragma once\n#include \"knead/base/missing.hpp\"\n");
  expect_only("src/spline/detail.hpp:2: \"knead/base/missing.hpp\" does not exist");
}

TEST_F(Tree, SourceThatIncludesItsHeaderLateIsFound) {
  write("src/spline/basis.cpp", "#include <vector>\n#include \"knead/spline/basis.hpp\"\n");
  expect_only("src/spline/basis.cpp:1: the first include is not the file's own header");
}

TEST_F(Tree, ThrowInTheCoreIsFound) {
  write("src/spline/detail.hpp", "#pragma once\n/* throw\n*/ inline void f() { throw 1; }\n");
  expect_only("src/spline/detail.hpp:3: the core must not throw");
}

TEST_F(Tree, WhatABodyThrowsIsCarriedBetweenThreadsInOneFile) {
  write("src/base/parallel_for.cpp", "void f() { try { g(); } catch (...) {} }\n");
  EXPECT_EQ(violations(root_), std::vector<std::string>{});
}

TEST_F(Tree, ThrowOutsideOfTheCoreIsAllowed) {
  write("apps/knead/main.cpp", "int main() { throw 1; }\n");
  EXPECT_EQ(violations(root_), std::vector<std::string>{});
}

TEST_F(Tree, HeaderWithoutPragmaOnceIsFound) {
  write("tests/support/help.hpp", "#ifndef A\n#define A\n#endif\n");
  expect_only("tests/support/help.hpp:1: the header does not begin with #pragma once");
}

TEST_F(Tree, LongFunctionIsFoundAndTheLongestAllowedIsNot) {
  std::string body;
  for (int i = 0; i < 68; ++i) body += "  g();\n";
  write("src/spline/detail.hpp", "#pragma once\ninline void f() {\n" + body + "}\n");
  EXPECT_EQ(violations(root_), std::vector<std::string>{});
  write("src/spline/detail.hpp", "#pragma once\ninline void f() {\n" + body + "  g();\n}\n");
  expect_only("src/spline/detail.hpp:2: a function of 71 lines; 70 are allowed");
}

TEST_F(Tree, FileThatNeedsNoExceptionForItsFunctionsIsFound) {
  write("src/gramian/simd/recurrence_cubic.hpp", "#pragma once\ninline void f() {}\n");
  expect_only(
      "src/gramian/simd/recurrence_cubic.hpp: no function is long here any more: strike the file "
      "off the exceptions");
}

TEST_F(Tree, LongFileIsFoundAndTheLongestAllowedIsNot) {
  std::string text;
  for (int i = 0; i < 400; ++i) text += "\n";
  write("tests/base/long_test.cpp", text);
  EXPECT_EQ(violations(root_), std::vector<std::string>{});
  write("tests/base/long_test.cpp", text + "\n");
  expect_only("tests/base/long_test.cpp: 401 lines; 400 are allowed");
}

TEST_F(Tree, LongLineIsFoundAndTheLongestAllowedIsNot) {
  std::string line = "// ";
  for (int k = 0; k < 97; ++k) line += "∂";
  write("tests/base/wide_test.cpp", line + "\u0303\n");
  EXPECT_EQ(violations(root_), std::vector<std::string>{});
  write("tests/base/wide_test.cpp", "\n" + line + "∂\n");
  expect_only("tests/base/wide_test.cpp:2: 101 characters; 100 are allowed");
}

TEST_F(Tree, FileWrittenByTheBuildMayBeLong) {
  std::string text;
  for (int i = 0; i < 500; ++i) text += "\n";
  write("web/src/engine/generated.ts", text);
  EXPECT_EQ(violations(root_), std::vector<std::string>{});
}

}  // namespace
}  // namespace knead::house
