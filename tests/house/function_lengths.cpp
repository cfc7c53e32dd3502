#include "house/function_lengths.hpp"

#include <cctype>
#include <regex>

namespace knead::house {
namespace {

bool is_space(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

/// What stands before a block, since the last declaration or block.
struct Head {
  std::string text;
  std::size_t line = 0;  // of its first character; 0: empty

  void add(char c, std::size_t at) {
    if (line == 0 && !is_space(c)) line = at;
    if (line != 0) text += c;
  }
  [[nodiscard]] bool is_access() const {
    return text == "public" || text == "protected" || text == "private";
  }
  [[nodiscard]] bool of_function() const {
    static const std::regex other(
        R"(^(template\s*<[^{}]*>\s*)?(namespace|struct|class|union|enum|extern)\b)");
    return text.find('(') != std::string::npos && !std::regex_search(text, other);
  }
};

class Counter {
 public:
  explicit Counter(const std::vector<std::string>& code) : code_(code) {}

  std::vector<FunctionLength> run() {
    for (; line_ < code_.size(); ++line_) {
      const bool directive = continued_ || code_[line_].starts_with('#');
      continued_ = directive && code_[line_].ends_with('\\');
      if (directive) continue;
      for (column_ = 0; column_ < code_[line_].size(); ++column_) take(code_[line_][column_]);
      take('\n');
    }
    return std::move(found_);
  }

 private:
  void take(char c) {
    if (c == '{') {
      if (depth_in_function_ > 0 || head_.of_function()) {
        ++depth_in_function_;
      } else {
        head_ = {};
      }
    } else if (c == '}' && depth_in_function_ > 0) {
      if (--depth_in_function_ == 0) close();
    } else if (depth_in_function_ == 0 &&
               (c == ';' || c == '}' || (c == ':' && head_.is_access()))) {
      head_ = {};
    } else if (depth_in_function_ == 0) {
      head_.add(c, line_ + 1);
    }
  }

  void close() {
    const char next = next_character();
    if (next == ',' || next == '{')
      return;  // that was an initialiser of a member: the body is still to come
    found_.push_back({head_.line, line_ + 2 - head_.line, head_.text});
    head_ = {};
  }

  /// The next one that is not white.
  [[nodiscard]] char next_character() const {
    for (std::size_t l = line_, c = column_ + 1; l < code_.size(); ++l, c = 0) {
      for (; c < code_[l].size(); ++c) {
        if (!is_space(code_[l][c])) return code_[l][c];
      }
    }
    return '\0';
  }

  const std::vector<std::string>& code_;
  std::size_t line_ = 0, column_ = 0;
  bool continued_ = false;
  int depth_in_function_ = 0;
  Head head_;
  std::vector<FunctionLength> found_;
};

}  // namespace

std::vector<FunctionLength> function_lengths(const std::vector<std::string>& code) {
  return Counter(code).run();
}

}  // namespace knead::house
