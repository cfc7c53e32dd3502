#include "house/pages.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>
#include <utility>

namespace knead::house {
namespace {

namespace fs = std::filesystem;

constexpr const char* page_name = "docs/thesis.md";
constexpr int most_links = 2;  // in a cell, so that a screen shows its row

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// "Eqs." and "Eq." are one kind.
std::string kind_of(const std::string& sign) {
  if (sign.starts_with("§")) return "§";
  return sign.starts_with("Table") ? "Table" : sign.substr(0, sign.starts_with("E") ? 2 : 3);
}

/// "5.9" to "5.12": the numbers between, both ends included.
std::vector<std::string> range(const std::string& from, const std::string& to) {
  const auto dot = from.rfind('.') + 1;
  std::vector<std::string> numbers;
  const bool alike = to.substr(0, to.rfind('.') + 1) == from.substr(0, dot);
  if (!alike) return {from, to};
  for (int k = std::stoi(from.substr(dot)); k <= std::stoi(to.substr(dot)); ++k) {
    numbers.push_back(from.substr(0, dot) + std::to_string(k));
  }
  return numbers;
}

/// The numbers at the beginning of a text, "Eq 4.8" each, as far as it goes on as a list of them.
std::vector<std::string> cited(std::string text) {
  static const std::regex item(
      R"(^(?:, | and | to |, and )?((?:§)+|Eqs?\.|Algs?\.|Thms?|Figs?\.|Tables?)? )"
      R"(?(\d\.[\d.]*\d))");
  std::vector<std::string> numbers;
  std::string kind, last;
  for (std::smatch match; std::regex_search(text, match, item); text = match.suffix()) {
    if (match[1].matched) kind = kind_of(match[1]);
    if (kind.empty()) break;
    const std::string number = match[2];
    if (match.str().starts_with(" to ") && !last.empty()) {
      for (const std::string& between : range(last, number))
        numbers.push_back(kind + " " + between);
    } else {
      numbers.push_back(kind + " " + number);
    }
    last = number;
  }
  return numbers;
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  for (std::size_t begin = 1, end; (end = line.find('|', begin)) != std::string::npos;
       begin = end + 1) {
    const std::string cell = line.substr(begin, end - begin);
    const auto first = cell.find_first_not_of(' ');
    cells.push_back(first == std::string::npos
                        ? ""
                        : cell.substr(first, cell.find_last_not_of(' ') - first + 1));
  }
  return cells;
}

struct Row {
  std::size_t line;
  std::vector<std::string> cells;
};

/// Items of the lists below the tables, "- **Eq. 4.8**: text", which says of that row what differs.
struct Difference {
  std::size_t line;
  std::string row, text;
};

struct Tables {
  std::vector<Row> rows;
  std::vector<Difference> differences;
};

Tables tables_of(const fs::path& root) {
  static const std::regex item(R"(^- \*\*(.*)\*\*: (.*)$)");
  std::ifstream in(root / page_name);
  Tables tables;
  std::size_t number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    std::smatch match;
    if (line.starts_with("| ") && !line.starts_with("| thesis |"))
      tables.rows.push_back({number, cells_of(line)});
    if (std::regex_match(line, match, item))
      tables.differences.push_back({number, match[1], match[2]});
  }
  return tables;
}

class Page {
 public:
  explicit Page(fs::path root) : root_(std::move(root)) {}

  std::vector<std::string> errors() {
    const auto [rows, differences] = tables_of(root_);
    if (rows.empty()) found_.push_back(std::string(page_name) + ": there is no table");
    for (const Row& row : rows) {
      line_ = row.line;
      if (row.cells.size() != 4) {
        report("a row has " + std::to_string(row.cells.size()) + " cells instead of 4");
        continue;
      }
      if (cited(row.cells[0]).empty())
        report("\"" + row.cells[0] + "\" is no number of the thesis");
      const bool is_missing = std::ranges::any_of(differences, [&](const Difference& d) {
        return d.row == row.cells[0] && d.text.starts_with("Not ");
      });
      if (row.cells[2].empty() && !is_missing) report("what is not there is not said");
      check_names(row.cells[2]);
      check_names(row.cells[3]);
    }
    for (const Difference& d : differences) {
      line_ = d.line;
      if (std::ranges::none_of(rows, [&](const Row& row) { return row.cells[0] == d.row; }))
        report("\"" + d.row + "\" is the first cell of no row");
    }
    return std::move(found_);
  }

 private:
  void report(const std::string& what) {
    found_.push_back(std::string(page_name) + ":" + std::to_string(line_) + ": " + what);
  }

  /// `name`, `name` in [label](path), …
  void check_names(const std::string& cell) {
    static const std::regex token(R"(`([^`]+)`|\[[^\]]*\]\(([^)#]+)[^)]*\))");
    std::vector<std::string> names;
    int links = 0;
    for (std::sregex_iterator it(cell.begin(), cell.end(), token), end; it != end; ++it) {
      if ((*it)[1].matched) {
        names.push_back((*it)[1]);
      } else {
        check_file((*it)[2], names);
        names.clear();
        ++links;
      }
    }
    if (links > most_links)
      report("a cell has " + std::to_string(links) + " links: divide the row");
    for (const std::string& name : names) report(name + " stands without a file");
  }

  void check_file(const std::string& link, const std::vector<std::string>& names) {
    const fs::path file = (root_ / "docs" / link).lexically_normal();
    if (!fs::is_regular_file(file)) return report(link + " does not exist");
    const std::string text = text_of(file);
    for (const std::string& name : names) {
      const auto dot = name.find('.');
      const std::string pattern = dot == std::string::npos
                                      ? "\\b" + name + "\\b"
                                      : "\\bTEST(_F|_P)?\\(\\s*" + name.substr(0, dot) +
                                            "\\s*,\\s*" + name.substr(dot + 1) + "\\s*\\)";
      if (!std::regex_search(text, std::regex(pattern))) report(name + " is not in " + link);
    }
  }

  fs::path root_;
  std::size_t line_ = 0;
  std::vector<std::string> found_;
};

/// The lines of a text as one, without what comments begin their lines with.
std::string joined(const std::string& text) {
  std::string result;
  for (std::size_t begin = 0; begin < text.size();) {
    const auto end = std::min(text.find('\n', begin), text.size());
    const auto first = text.find_first_not_of(" \t/*<\"", begin);
    if (first < end) result += text.substr(first, end - first) + " ";
    begin = end + 1;
  }
  return result;
}

std::vector<fs::path> files_that_cite(const fs::path& root) {
  static const std::set<std::string> kinds = {".hpp", ".cpp", ".inc", ".ts", ".md"};
  std::vector<fs::path> files;
  for (const char* part :
       {"include", "src", "apps", "bindings", "bench", "examples", "tests", "docs", "web/src"}) {
    if (!fs::exists(root / part)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root / part)) {
      const bool is_page = entry.path() == root / page_name;
      const bool is_own = entry.path().parent_path() == root / "tests/house";
      if (entry.is_regular_file() && kinds.contains(entry.path().extension()) && !is_page &&
          !is_own) {
        files.push_back(entry.path());
      }
    }
  }
  std::ranges::sort(files);
  return files;
}

}  // namespace

std::vector<std::string> thesis_page_errors(const fs::path& root) { return Page(root).errors(); }

std::vector<std::string> citation_errors(const fs::path& root) {
  std::set<std::string> known;
  for (const Row& row : tables_of(root).rows) {
    for (const std::string& number : cited(row.cells.empty() ? "" : row.cells[0])) {
      known.insert(number);
      if (!number.starts_with("§")) continue;
      for (auto dot = number.rfind('.'); dot != std::string::npos;
           dot = number.rfind('.', dot - 1)) {
        known.insert(number.substr(0, dot));
      }
    }
  }
  static const std::regex unsigned_number(
      R"(^(?:sections?|figures?|equations?|theorems?) ?\d|^\d\.\d)", std::regex::icase);
  std::vector<std::string> found;
  for (const fs::path& file : files_that_cite(root)) {
    const std::string text = joined(text_of(file)),
                      name = fs::relative(file, root).generic_string();
    for (std::size_t at = text.find("hesis"); at != std::string::npos;
         at = text.find("hesis", at + 1)) {
      // "thesis" or "Thesis", no part of another word.
      if (at == 0 || std::tolower(static_cast<unsigned char>(text[at - 1])) != 't' ||
          (at > 1 && std::isalpha(static_cast<unsigned char>(text[at - 2])) != 0))
        continue;
      const auto begin = text.find_first_not_of("', ", at + 5);
      if (begin == std::string::npos || begin == at + 5) continue;
      const std::string after = text.substr(begin, 120);
      if (std::regex_search(after, unsigned_number)) {
        found.push_back(name + ": \"thesis " + after.substr(0, 20) +
                        "\": write § 5.8, Eq. 5.8, Alg. 5.1, Thm 5.2 or Fig. 5.8");
      }
      for (const std::string& number : cited(after)) {
        if (!known.contains(number))
          found.push_back(name + ": " + number + " has no row in " + page_name);
      }
    }
  }
  return found;
}

namespace {

/// The anchors of a page: its headings in small letters, without punctuation, spaces as hyphens;
/// the second of a name ends in "-1".
std::set<std::string> anchors_of(const std::string& page) {
  static const std::regex heading(R"(^#+ (.*))");
  static const std::regex link(R"(\[([^\]]*)\]\([^)]*\))");
  std::set<std::string> anchors;
  bool in_code = false;
  std::istringstream in(page);
  for (std::string line; std::getline(in, line);) {
    std::smatch match;
    if (line.starts_with("```")) in_code = !in_code;
    if (in_code || !std::regex_match(line, match, heading)) continue;
    std::string anchor;
    for (const char c : std::regex_replace(match[1].str(), link, "$1")) {
      const auto byte = static_cast<unsigned char>(c);
      if (c == ' ') anchor += '-';
      if (std::isalnum(byte) != 0 || byte >= 0x80 || c == '-' || c == '_')
        anchor += static_cast<char>(std::tolower(byte));
    }
    std::string numbered = anchor;
    for (int k = 1; !anchors.insert(numbered).second; ++k)
      numbered = anchor + "-" + std::to_string(k);
  }
  return anchors;
}

}  // namespace

std::vector<std::string> dead_links(const fs::path& root) {
  std::vector<fs::path> pages;
  for (const auto& entry : fs::directory_iterator(root)) pages.push_back(entry.path());
  for (const char* part : {"docs", "examples", "samples"}) {
    if (!fs::exists(root / part)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root / part))
      pages.push_back(entry.path());
  }
  std::ranges::sort(pages);
  static const std::regex link(R"(\]\(([^)#: ]*[./][^)#: ]*)?(?:#([^)]*))?\))");
  std::vector<std::string> dead;
  for (const fs::path& page : pages) {
    if (page.extension() != ".md") continue;
    const std::string text = text_of(page), name = fs::relative(page, root).generic_string();
    for (std::sregex_iterator it(text.begin(), text.end(), link), end; it != end; ++it) {
      const std::string target = (*it)[1], anchor = (*it)[2];
      const fs::path file = target.empty() ? page : page.parent_path() / target;
      if (!fs::exists(file)) {
        dead.push_back(name + ": " + target);
      } else if (!anchor.empty() && file.extension() == ".md" &&
                 !anchors_of(text_of(file)).contains(anchor)) {
        dead.push_back(name + ": " + target + "#" + anchor);
      }
    }
  }
  return dead;
}

}  // namespace knead::house
