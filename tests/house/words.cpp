#include "house/words.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <iterator>
#include <string_view>

namespace knead::house {
namespace {

namespace fs = std::filesystem;

struct Turn {
  std::string_view turn, instead;
};

/// Of a private language, or archaic: a reader stops at each. In small letters; a space stands for
/// any white space.
constexpr std::array<Turn, 20> turns = {{
    {" of before", "earlier, or which version"},
    {"brought near", "prefetched"},
    {"but for ", "except"},
    {"by the clock", "wall-clock time"},
    {"clock on the wall", "wall-clock time"},
    {"dearer", "cost more"},
    {"for good", "permanently"},
    {"grow dear", "cost more"},
    {"in the place of", "instead of"},
    {"is said", "is reported"},
    {"leapt", "skipped"},
    {"mended", "repaired"},
    {"near while", "prefetched"},
    {"nothing twice", "nothing"},
    {"reckon", "compute"},
    {"so far as ", "as far as"},
    {"tell the truth", "is right"},
    {"tells the truth", "is right"},
    {"what became of", "what happened to"},
    {"without a word", "silently"},
}};

std::string bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// What stands between quotes, each followed by a space; a line ends a literal that does not end
/// before. Comments to the end of a line are left out.
std::string texts_of(const std::string& source, bool is_script) {
  std::string texts;
  char quote = 0;
  for (std::size_t i = 0; i < source.size(); ++i) {
    const char c = source[i];
    if (quote == 0) {
      if (!is_script && source.compare(i, 2, "//") == 0)
        i = std::min(source.find('\n', i), source.size() - 1);
      if (c == '"' || c == '`' ||
          (c == '\'' && i > 0 && !std::isalnum(static_cast<unsigned char>(source[i - 1]))))
        quote = c;
    } else if (c == quote || (c == '\n' && quote != '`')) {
      quote = 0;
      texts += ' ';
    } else {
      if (c == '\\' && i + 1 < source.size()) ++i;
      texts += source[i];
    }
  }
  return texts;
}

/// In small letters, any white space as one space.
std::string plain(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (std::isspace(static_cast<unsigned char>(c)) == 0)
      result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    else if (result.empty() || result.back() != ' ')
      result += ' ';
  }
  return result;
}

std::vector<fs::path> files_below(const fs::path& directory) {
  std::vector<fs::path> files;
  if (!fs::exists(directory)) return files;
  for (const auto& entry : fs::recursive_directory_iterator(directory)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

}  // namespace

std::vector<std::string> banned_turns(const fs::path& root) {
  std::vector<std::string> found;
  const auto inspect = [&](const fs::path& file, const std::string& text) {
    for (const Turn& t : turns) {
      if (!text.contains(t.turn)) continue;
      found.push_back(fs::relative(file, root).generic_string() + ": \"" + std::string(t.turn) +
                      "\": write \"" + std::string(t.instead) + "\"");
    }
  };
  for (const char* name : {"README.md", "CONTRIBUTING.md", "CHANGELOG.md", "Makefile"})
    inspect(root / name, plain(bytes_of(root / name)));
  for (const char* part : {"docs", "examples"}) {
    for (const fs::path& file : files_below(root / part)) {
      if (file.extension() == ".md") inspect(file, plain(bytes_of(file)));
    }
  }
  for (const char* part : {"include", "src", "apps", "bindings", "web/src", "scripts"}) {
    for (const fs::path& file : files_below(root / part)) {
      const fs::path kind = file.extension();
      if (kind == ".cpp" || kind == ".hpp" || kind == ".ts" || kind == ".sh")
        inspect(file, plain(texts_of(bytes_of(file), kind == ".sh")));
    }
  }
  return found;
}

}  // namespace knead::house
