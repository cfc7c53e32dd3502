#include "house/rules.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <optional>
#include <regex>
#include <sstream>
#include <string_view>

#include "house/characters.hpp"
#include "house/function_lengths.hpp"

namespace knead::house {
namespace {

namespace fs = std::filesystem;

constexpr int longest_file = 400;
constexpr std::ptrdiff_t longest_line = 100;

/// Their procedures read as verbs: a function that is longer than this hides its steps.
constexpr std::array<std::string_view, 2> rooms_of_long_functions = {"scene", "session"};
constexpr std::size_t longest_function = 70;
/// Kernels that keep all their sums in registers through the whole sweep over the rows: their steps
/// share so many values that functions of them would pass them through memory.
constexpr std::array<std::string_view, 2> files_of_long_functions = {
    "src/gramian/simd/recurrence_cubic.hpp", "src/gramian/simd/recurrence_fixed.hpp"};

constexpr std::size_t most_files = 45;  // in one folder
/// Few doors: what programs need, and nothing that only the rooms say to each other.
constexpr std::size_t most_public_headers = 60;
constexpr std::array<std::string_view, 1> large_folders = {"src/session/commands"};

/// Namespaces of file formats, each known in its folder of src/exchange alone.
constexpr std::array<std::string_view, 3> formats = {"iges", "occt", "step"};

/// Carries what a caller's function throws from one thread to another, where there are exceptions.
constexpr std::string_view file_of_exceptions = "src/base/parallel_for.cpp";

/// The door to Eigen's decompositions, which knows empty, rank-deficient and non-finite matrices.
constexpr std::array<std::string_view, 2> files_of_decompositions = {"src/base/decompositions.hpp",
                                                                     "src/base/decompositions.cpp"};

std::vector<std::string> lines_of(const fs::path& file) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

bool is_source(const fs::path& file) {
  if (file.filename() == "generated.ts") return false;  // written by the build of the studio
  const auto extension = file.extension();
  return extension == ".hpp" || extension == ".cpp" || extension == ".h" || extension == ".ts";
}

std::vector<fs::path> sources_below(const fs::path& directory) {
  std::vector<fs::path> files;
  if (!fs::exists(directory)) return files;
  for (auto entry = fs::recursive_directory_iterator(directory);
       entry != fs::recursive_directory_iterator(); ++entry) {
    if (entry->is_directory() && entry->path().filename() == "node_modules")
      entry.disable_recursion_pending();
    if (entry->is_regular_file() && is_source(entry->path())) files.push_back(entry->path());
  }
  std::ranges::sort(files);
  return files;
}

/// The line without comments, string literals and character literals; `in_comment` carries over
/// block comments.
std::string code_of(const std::string& line, bool& in_comment) {
  std::string code;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (in_comment) {
      if (line.compare(i, 2, "*/") == 0) in_comment = false, ++i;
    } else if (line.compare(i, 2, "//") == 0) {
      break;
    } else if (line.compare(i, 2, "/*") == 0) {
      in_comment = true;
      ++i;
    } else if (line[i] == '"' ||
               (line[i] == '\'' &&
                (i == 0 || !std::isalnum(static_cast<unsigned char>(line[i - 1]))))) {
      const char quote = line[i];
      for (++i; i < line.size() && line[i] != quote; ++i) {
        if (line[i] == '\\') ++i;
      }
    } else {
      code += line[i];
    }
  }
  return code;
}

/// A room and what lives there, as src/rooms.txt says.
struct Room {
  std::string name, purpose;
};

std::vector<Room> rooms_of(const fs::path& root) {
  static const std::regex room("^([a-z]+): (.+)$");
  std::vector<Room> rooms;
  for (const std::string& line : lines_of(root / "src/rooms.txt")) {
    std::smatch match;
    if (std::regex_match(line, match, room)) rooms.push_back({match[1], match[2]});
  }
  return rooms;
}

class Inspection {
 public:
  explicit Inspection(const fs::path& root) : root_(root), rooms_(rooms_of(root)) {}

  std::vector<std::string> run() {
    for (const char* part : {"include/knead", "src"}) inspect_rooms(root_ / part);
    for (const char* part :
         {"include", "src", "apps", "bindings", "tests", "bench", "examples", "web/src"}) {
      for (const fs::path& file : sources_below(root_ / part)) inspect_form(file);
    }
    for (const char* part : {"include", "src", "apps", "bindings"}) {
      for (const fs::path& file : sources_below(root_ / part)) inspect_formats(file);
    }
    for (const Room& room : rooms_) inspect_folders(root_ / "src" / room.name);
    for (const char* page : {"README.md", "CONTRIBUTING.md"}) inspect_table_of_rooms(root_ / page);
    inspect_list_of_headers();
    inspect_public_headers();
    return std::move(found_);
  }

 private:
  void report(const fs::path& file, std::size_t line, const std::string& what) {
    std::ostringstream text;
    text << fs::relative(file, root_).generic_string();
    if (line > 0) text << ":" << line;
    text << ": " << what;
    found_.push_back(text.str());
  }

  [[nodiscard]] std::optional<std::size_t> floor_of(std::string_view room) const {
    const auto at = std::ranges::find(rooms_, room, &Room::name);
    if (at == rooms_.end()) return std::nullopt;
    return static_cast<std::size_t>(at - rooms_.begin());
  }

  void inspect_rooms(const fs::path& part) {
    if (!fs::exists(part)) return;
    for (const auto& entry : fs::directory_iterator(part)) {
      const std::string name = entry.path().filename().string();
      if (!entry.is_directory()) {
        if (name != "rooms.txt") report(entry.path(), 0, "the file stands outside of every room");
      } else if (const auto floor = floor_of(name)) {
        for (const fs::path& file : sources_below(entry.path())) inspect_core(file, name, *floor);
      } else {
        report(entry.path(), 0, "there is no room of this name");
      }
    }
  }

  void inspect_core(const fs::path& file, const std::string& room, std::size_t floor) {
    static const std::regex include(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"])");
    static const std::regex exception(R"(\b(throw|try|catch)\b)");
    const bool may_catch = fs::relative(file, root_).generic_string() == file_of_exceptions;
    static const std::regex decomposition(
        R"(\b(\w*(HouseholderQR|PivLU|LDLT|LLT|SVD|EigenSolver|SparseLU|SparseQR|)"
        R"(OrthogonalDecomposition))"
        R"(|Eigen::(Tridiagonalization|RealSchur|HessenbergDecomposition|)"
        R"(\w*(Gradient|GRES|BiCGSTAB|Incomplete\w+)))"
        R"(|(?:colPivH|fullPivH|h)ouseholderQr|(?:partial|full)PivLu|)"
        R"(lu|llt|ldlt|(?:jacobi|bdc)Svd)\b(?=\s*[<({]))");
    const bool may_decompose =
        std::ranges::find(files_of_decompositions, fs::relative(file, root_).generic_string()) !=
        files_of_decompositions.end();
    bool in_comment = false;
    std::string first_include;
    const auto lines = lines_of(file);
    std::vector<std::string> codes(lines.size());
    for (std::size_t i = 0; i < lines.size(); ++i) {
      std::smatch match;
      if (!in_comment && std::regex_search(lines[i], match, include)) {
        if (first_include.empty()) first_include = match[2];
        inspect_include(file, i + 1, room, floor, match[1] == "<", match[2]);
        continue;
      }
      const std::string& code = codes[i] = code_of(lines[i], in_comment);
      if (!may_catch && std::regex_search(code, match, exception)) {
        report(file, i + 1, "the core must not " + match[1].str());
      }
      if (!may_decompose && std::regex_search(code, match, decomposition)) {
        report(file, i + 1, match[0].str() + " is used outside of base/decompositions.hpp");
      }
    }
    if (std::ranges::find(rooms_of_long_functions, room) == rooms_of_long_functions.end()) {
      inspect_functions(file, codes);
    }
    const std::string header = file.stem().string() + ".hpp";
    // A file of a folder may have the name of one of the room itself, whose public header is not
    // its own.
    const fs::path of_room = root_ / "src" / room / file.filename();
    const bool is_public = fs::exists(root_ / "include/knead" / room / header) &&
                           !fs::exists(file.parent_path() / header) &&
                           (file == of_room || !fs::exists(of_room));
    if (file.extension() == ".cpp" && (is_public || fs::exists(file.parent_path() / header)) &&
        first_include != (is_public ? "knead/" + room + "/" + header : header)) {
      report(file, 1, "the first include is not the file's own header");
    }
  }

  /// Quoted includes: "knead/ROOM/x.hpp" of the public headers; in src also "ROOM/x.hpp" of another
  /// room's internals, or of another folder of the same room, and "x.hpp" or "../x.hpp" of the same
  /// room's.
  void inspect_include(const fs::path& file, std::size_t line, const std::string& room,
                       std::size_t floor, bool angled, const std::string& name) {
    if (angled) {
      const bool on_top =
          name.starts_with("CLI/") || name.ends_with(".hxx") || name.starts_with("emscripten");
      if (on_top)
        report(file, line, "<" + name + "> belongs to the programs on top, not to a room");
      if (name.starts_with("knead/"))
        report(file, line, "<" + name + "> must be written with quotes");
      return;
    }
    const bool to_public = name.starts_with("knead/");
    if (!to_public && is_public(file)) {
      report(file, line, "\"" + name + "\" is no public header");
      return;
    }
    const fs::path inside = fs::relative(file.parent_path() / name, root_ / "src" / room);
    const bool beside = fs::exists(file.parent_path() / name) && *inside.begin() != "..";
    if (!to_public && beside) return;
    const std::string path = to_public ? name.substr(6) : name;
    const std::string other = path.substr(0, path.find('/'));
    const auto other_floor = floor_of(other);
    const fs::path included = root_ / "src" / name;
    const bool other_folder =
        other == room && fs::exists(included) && included.parent_path() != file.parent_path();
    if (!to_public && (!other_floor || (other == room && !other_folder))) {
      report(file, line, "\"" + name + "\" is no file of this room");
    } else if (!other_floor) {
      report(file, line, "\"" + name + "\": there is no room " + other);
    } else if (*other_floor > floor) {
      report(file, line,
             "the room " + room + " must not include the room " + other + ", which is built on it");
    } else if (!fs::exists(root_ / (to_public ? "include" : "src") / name)) {
      report(file, line, "\"" + name + "\" does not exist");
    }
  }

  [[nodiscard]] bool is_public(const fs::path& file) const {
    return fs::relative(file, root_).generic_string().starts_with("include/");
  }

  void inspect_functions(const fs::path& file, const std::vector<std::string>& code) {
    const std::string name = fs::relative(file, root_).generic_string();
    const bool may_be_long =
        std::ranges::find(files_of_long_functions, name) != files_of_long_functions.end();
    bool any = false;
    for (const FunctionLength& f : function_lengths(code)) {
      if (f.lines <= longest_function) continue;
      any = true;
      if (may_be_long) continue;
      report(file, f.line,
             "a function of " + std::to_string(f.lines) + " lines; " +
                 std::to_string(longest_function) + " are allowed");
    }
    if (may_be_long && !any)
      report(file, 0, "no function is long here any more: strike the file off the exceptions");
  }

  /// docs/api.md has a line with a link for every public header, and no other.
  void inspect_list_of_headers() {
    static const std::regex link(R"(\(\.\./(include/[^)]+)\))");
    const fs::path list = root_ / "docs/api.md";
    std::vector<std::string> listed;
    const auto lines = lines_of(list);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      std::smatch match;
      if (!std::regex_search(lines[i], match, link)) continue;
      if (!fs::exists(root_ / match[1].str()))
        report(list, i + 1, match[1].str() + " does not exist");
      if (std::ranges::find(listed, match[1].str()) != listed.end())
        report(list, i + 1, match[1].str() + " is listed twice");
      listed.push_back(match[1]);
    }
    for (const fs::path& header : sources_below(root_ / "include")) {
      const std::string name = fs::relative(header, root_).generic_string();
      if (std::ranges::find(listed, name) == listed.end())
        report(header, 0, "docs/api.md does not list this header");
    }
  }

  /// Public headers are few, and all that the command line and the examples are written against.
  void inspect_public_headers() {
    const std::size_t count = sources_below(root_ / "include").size();
    if (count > most_public_headers) {
      report(root_ / "include/knead", 0,
             std::to_string(count) + " public headers; " + std::to_string(most_public_headers) +
                 " are allowed");
    }
    static const std::regex include("^#include \"([^\"]+)\"");
    for (const char* part : {"apps/knead", "examples"}) {
      for (const fs::path& file : sources_below(root_ / part)) {
        const auto lines = lines_of(file);
        for (std::size_t i = 0; i < lines.size(); ++i) {
          std::smatch match;
          if (std::regex_search(lines[i], match, include) &&
              !fs::exists(file.parent_path() / match[1].str()) &&
              !fs::exists(root_ / "include" / match[1].str())) {
            report(file, i + 1, "\"" + match[1].str() + "\" is no public header");
          }
        }
      }
    }
  }

  /// Pages of the tree that have a table of rooms have the one of src/rooms.txt.
  void inspect_table_of_rooms(const fs::path& page) {
    const auto lines = lines_of(page);
    const auto begin = std::ranges::find(lines, "<!-- rooms -->");
    if (begin == lines.end()) return;
    std::vector<std::string> table = {"<!-- rooms -->", "| room | what lives there |", "|---|---|"};
    for (const Room& room : rooms_)
      table.push_back("| `" + room.name + "` | " + room.purpose + " |");
    table.emplace_back("<!-- end of rooms -->");
    if (std::ranges::mismatch(std::ranges::subrange(begin, lines.end()), table).in2 != table.end())
      report(page, static_cast<std::size_t>(begin - lines.begin()) + 1,
             "the table of rooms is not that of src/rooms.txt: run scripts/docs.sh");
  }

  /// No format is named outside of its folder.
  void inspect_formats(const fs::path& file) {
    const auto lines = lines_of(file);
    const std::string name = fs::relative(file, root_).generic_string();
    bool in_comment = false;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const std::string code = code_of(lines[i], in_comment);
      for (const std::string_view format : formats) {
        if (name.starts_with("src/exchange/" + std::string(format) + "/")) continue;
        if (std::regex_search(code, std::regex("\\b" + std::string(format) + "::")))
          report(file, i + 1,
                 "the format " + std::string(format) + " is named outside of its folder");
      }
    }
  }

  void inspect_folders(const fs::path& folder) {
    if (!fs::exists(folder)) return;
    std::size_t files = 0;
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (entry.is_directory()) inspect_folders(entry.path());
      files += is_source(entry.path()) ? 1 : 0;
    }
    const std::string name = fs::relative(folder, root_).generic_string();
    if (files > most_files && std::ranges::find(large_folders, name) == large_folders.end())
      report(folder, 0,
             std::to_string(files) + " files; " + std::to_string(most_files) + " are allowed");
  }

  void inspect_form(const fs::path& file) {
    const auto lines = lines_of(file);
    if (lines.size() > static_cast<std::size_t>(longest_file)) {
      report(file, 0,
             std::to_string(lines.size()) + " lines; " + std::to_string(longest_file) +
                 " are allowed");
    }
    const bool formatted = file.extension() == ".hpp" || file.extension() == ".cpp";
    for (std::size_t k = 0; formatted && k < lines.size(); ++k) {
      if (const std::ptrdiff_t length = characters(lines[k]); length > longest_line) {
        report(file, static_cast<int>(k + 1),
               std::to_string(length) + " characters; " + std::to_string(longest_line) +
                   " are allowed");
      }
    }
    if (file.extension() != ".hpp") return;
    bool in_comment = false;
    for (const std::string& line : lines) {
      const std::string code = code_of(line, in_comment);
      if (code.find_first_not_of(" \t\r") == std::string::npos) continue;
      if (!code.starts_with("#pragma once"))
        report(file, 1, "the header does not begin with #pragma once");
      return;
    }
  }

  fs::path root_;
  std::vector<Room> rooms_;
  std::vector<std::string> found_;
};

}  // namespace

std::vector<std::string> violations(const fs::path& root) { return Inspection(root).run(); }

}  // namespace knead::house
