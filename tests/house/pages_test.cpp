#include "house/pages.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

namespace knead::house {
namespace {

namespace fs = std::filesystem;

TEST(House, PageOfTheThesisNamesWhatExists) {
  for (const std::string& error : thesis_page_errors(KNEAD_SOURCE_DIR)) ADD_FAILURE() << error;
}

TEST(House, CitationsOfTheThesisHaveARow) {
  for (const std::string& error : citation_errors(KNEAD_SOURCE_DIR)) ADD_FAILURE() << error;
}

TEST(House, PagesLinkToWhatExists) {
  for (const std::string& link : dead_links(KNEAD_SOURCE_DIR)) ADD_FAILURE() << link;
}

/// A page with one row, a header and a test that it names; changed, and looked at.
class HouseThesisPage : public testing::Test {
 protected:
  HouseThesisPage() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    root_ = fs::temp_directory_path() /
            ("knead-thesis-" + std::to_string(getpid()) + "-" + test->name());
    fs::remove_all(root_);
    write("include/knead/energy/energy.hpp", "void stretch();\n");
    write("tests/energy/energy_test.cpp", "TEST_P(Energy,\n       IsConvex) {}\n");
    row("§ 4.2.1, Eqs. 4.8 to 4.10, Alg. 5.1",
        "`stretch` in [energy](../include/knead/energy/energy.hpp)",
        "`Energy.IsConvex` in [test](../tests/energy/energy_test.cpp)");
  }
  ~HouseThesisPage() override { fs::remove_all(root_); }

  void write(const std::string& name, const std::string& text) {
    fs::create_directories((root_ / name).parent_path());
    std::ofstream(root_ / name) << text;
  }

  void row(const std::string& numbers, const std::string& code, const std::string& tests,
           const std::string& differs = "") {
    write("docs/thesis.md",
          "# Thesis\n\n| thesis | what | here | tests |\n|---|---|---|---|\n| " + numbers +
              " | energy | " + code + " | " + tests + " |\n\n" +
              (differs.empty() ? "" : "- **" + numbers + "**: " + differs + "\n"));
  }

  using Errors = std::vector<std::string>;

  fs::path root_;
};

TEST_F(HouseThesisPage, ThatIsRightIsAccepted) {
  EXPECT_EQ(thesis_page_errors(root_), Errors{});
  EXPECT_EQ(citation_errors(root_), Errors{});
}

TEST_F(HouseThesisPage, WithoutItsFunctionIsFound) {
  write("include/knead/energy/energy.hpp", "void stretch_and_bend();\n");
  EXPECT_EQ(thesis_page_errors(root_),
            Errors{"docs/thesis.md:5: stretch is not in ../include/knead/energy/energy.hpp"});
}

TEST_F(HouseThesisPage, WithoutItsFileIsFound) {
  fs::remove(root_ / "include/knead/energy/energy.hpp");
  EXPECT_EQ(thesis_page_errors(root_),
            Errors{"docs/thesis.md:5: ../include/knead/energy/energy.hpp does not exist"});
}

TEST_F(HouseThesisPage, WithoutItsTestIsFound) {
  write("tests/energy/energy_test.cpp", "TEST(Energy, IsConvexToo) {}\n");
  EXPECT_EQ(thesis_page_errors(root_),
            Errors{"docs/thesis.md:5: Energy.IsConvex is not in ../tests/energy/energy_test.cpp"});
}

TEST_F(HouseThesisPage, WithANameThatHasNoFileOrARowThatSaysNothingIsFound) {
  row("Eq. 4.8", "`stretch`", "");
  EXPECT_EQ(thesis_page_errors(root_), Errors{"docs/thesis.md:5: stretch stands without a file"});
  row("Eq. 4.8", "", "");
  EXPECT_EQ(thesis_page_errors(root_), Errors{"docs/thesis.md:5: what is not there is not said"});
  row("Eq. 4.8", "", "", "Not implemented.");
  EXPECT_EQ(thesis_page_errors(root_), Errors{});
  row("4.8", "", "", "Not implemented.");
  EXPECT_EQ(thesis_page_errors(root_),
            Errors{"docs/thesis.md:5: \"4.8\" is no number of the thesis"});
}

TEST_F(HouseThesisPage, WithMoreLinksThanARowShowsOrADifferenceOfNoRowIsFound) {
  const std::string link = "`stretch` in [energy](../include/knead/energy/energy.hpp)";
  row("Eq. 4.8", link + ", " + link, "");
  EXPECT_EQ(thesis_page_errors(root_), Errors{});
  row("Eq. 4.8", link + ", " + link + ", " + link, "");
  EXPECT_EQ(thesis_page_errors(root_),
            Errors{"docs/thesis.md:5: a cell has 3 links: divide the row"});
  write("docs/thesis.md",
        "| thesis | what | here | tests |\n|---|---|---|---|\n| Eq. 4.8 | energy | " + link +
            " | |\n\n- **Eq. 4.9**: Not so.\n");
  EXPECT_EQ(thesis_page_errors(root_),
            Errors{"docs/thesis.md:5: \"Eq. 4.9\" is the first cell of no row"});
}

TEST_F(HouseThesisPage, IsWhatCitationsLeadTo) {
  write("src/energy/energy.cpp",
        "// The thesis' Eq. 4.9 (thesis § 4.2, Eqs. 4.8,\n/// 4.10 and Alg. 5.1); Book, Eq. 9.9; a "
        "parenthesis 4.2.\n");
  EXPECT_EQ(citation_errors(root_), Errors{});
  write("src/energy/energy.cpp", "// See thesis\n// Eqs. 4.10 to 4.12.\n");
  EXPECT_EQ(citation_errors(root_),
            (Errors{"src/energy/energy.cpp: Eq 4.11 has no row in docs/thesis.md",
                    "src/energy/energy.cpp: Eq 4.12 has no row in docs/thesis.md"}));
  write("src/energy/energy.cpp", "// What it costs (thesis 4.2).\n");
  EXPECT_EQ(citation_errors(root_),
            Errors{"src/energy/energy.cpp: \"thesis 4.2). \": write § 5.8, Eq. 5.8, Alg. 5.1, "
                   "Thm 5.2 or Fig. 5.8"});
}

TEST_F(HouseThesisPage, IsAPageWhoseDeadLinksAreFound) {
  write("README.md",
        "# Two words: `x`\n[a](docs/thesis.md), [b](docs/thesis.md#thesis), "
        "[c](https://no.where/x.md), `S[0](i)` "
        "[d](e.md), [e](#two-words-x), [f](#two), [g](docs/thesis.md#rows).\n");
  EXPECT_EQ(dead_links(root_),
            (Errors{"README.md: e.md", "README.md: #two", "README.md: docs/thesis.md#rows"}));
  fs::remove(root_ / "tests/energy/energy_test.cpp");
  write("README.md", "");
  EXPECT_EQ(dead_links(root_), Errors{"docs/thesis.md: ../tests/energy/energy_test.cpp"});
}

}  // namespace
}  // namespace knead::house
