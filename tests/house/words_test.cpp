#include "house/words.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

namespace knead::house {
namespace {

namespace fs = std::filesystem;

TEST(House, SpeaksPlainly) {
  for (const std::string& turn : banned_turns(KNEAD_SOURCE_DIR)) ADD_FAILURE() << turn;
}

TEST(House, FindsBannedTurnsInPagesAndTexts) {
  const fs::path root = fs::temp_directory_path() / ("knead-words-" + std::to_string(getpid()));
  const auto write = [&](const std::string& name, const std::string& text) {
    fs::create_directories((root / name).parent_path());
    std::ofstream(root / name) << text;
  };
  write("docs/design/step.md", "Numbers are Brought\nnear.\n");
  write(
      "src/base/error.cpp",
      "// what became of it\nauto a = 'x', b = \"as before\"; f(\"a \\\"second\\\" is said\");\n");
  write(
      "web/src/app/main.ts",
      "const but for = 1; // 'it's for good'\nsay('nothing', `for\n${name} good`, 'for good');\n");
  EXPECT_EQ(banned_turns(root),
            (std::vector<std::string>{"docs/design/step.md: \"brought near\": write \"prefetched\"",
                                      "src/base/error.cpp: \"is said\": write \"is reported\"",
                                      "web/src/app/main.ts: \"for good\": write \"permanently\""}));
  fs::remove_all(root);
}

}  // namespace
}  // namespace knead::house
