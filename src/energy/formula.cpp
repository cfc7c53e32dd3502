#include "formula.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/read_double.hpp"

namespace knead {
namespace {

struct Function {
  std::string_view name;
  int arguments;
  double (*value)(const double* x);
};

// The operators come first, under names that nobody can write.
constexpr Function formula_functions[] = {
    {"+", 2, [](const double* x) { return x[0] + x[1]; }},
    {"-", 2, [](const double* x) { return x[0] - x[1]; }},
    {"*", 2, [](const double* x) { return x[0] * x[1]; }},
    {"/", 2, [](const double* x) { return x[0] / x[1]; }},
    {"^", 2, [](const double* x) { return x[1] == 2 ? x[0] * x[0] : std::pow(x[0], x[1]); }},
    {"negative", 1, [](const double* x) { return -x[0]; }},
    {"abs", 1, [](const double* x) { return std::abs(x[0]); }},
    {"sign", 1, [](const double* x) { return x[0] > 0   ? 1.0
                                             : x[0] < 0 ? -1.0
                                                        : x[0]; }},
    {"sqrt", 1, [](const double* x) { return std::sqrt(x[0]); }},
    {"cbrt", 1, [](const double* x) { return std::cbrt(x[0]); }},
    {"exp", 1, [](const double* x) { return std::exp(x[0]); }},
    {"log", 1, [](const double* x) { return std::log(x[0]); }},
    {"log2", 1, [](const double* x) { return std::log2(x[0]); }},
    {"log10", 1, [](const double* x) { return std::log10(x[0]); }},
    {"sin", 1, [](const double* x) { return std::sin(x[0]); }},
    {"cos", 1, [](const double* x) { return std::cos(x[0]); }},
    {"tan", 1, [](const double* x) { return std::tan(x[0]); }},
    {"asin", 1, [](const double* x) { return std::asin(x[0]); }},
    {"acos", 1, [](const double* x) { return std::acos(x[0]); }},
    {"atan", 1, [](const double* x) { return std::atan(x[0]); }},
    {"sinh", 1, [](const double* x) { return std::sinh(x[0]); }},
    {"cosh", 1, [](const double* x) { return std::cosh(x[0]); }},
    {"tanh", 1, [](const double* x) { return std::tanh(x[0]); }},
    {"floor", 1, [](const double* x) { return std::floor(x[0]); }},
    {"ceil", 1, [](const double* x) { return std::ceil(x[0]); }},
    {"min", 2, [](const double* x) { return std::min(x[0], x[1]); }},
    {"max", 2, [](const double* x) { return std::max(x[0], x[1]); }},
    {"atan2", 2, [](const double* x) { return std::atan2(x[0], x[1]); }},
    {"hypot", 2, [](const double* x) { return std::hypot(x[0], x[1]); }},
    {"step", 2, [](const double* x) { return x[1] < x[0] ? 0.0 : 1.0; }},
    {"clamp", 3, [](const double* x) { return std::max(x[1], std::min(x[2], x[0])); }},
    {"smoothstep", 3,
     [](const double* x) {
       const double r = std::max(0.0, std::min(1.0, (x[2] - x[0]) / (x[1] - x[0])));
       return r * r * (3 - 2 * r);
     }},
    {"mix", 3, [](const double* x) { return x[0] + x[2] * (x[1] - x[0]); }},
};
constexpr int first_variable = static_cast<int>(std::size(formula_functions));
constexpr int first_named = 6, negative = 5;

int function_named(std::string_view name) {
  for (int k = first_named; k < first_variable; ++k) {
    if (formula_functions[k].name == name) return k;
  }
  return -1;
}

std::string function_names() {
  std::string names;
  for (int k = first_named; k < first_variable; ++k) {
    names.append(k == first_named ? "" : ", ").append(formula_functions[k].name);
  }
  return names;
}

int operator_of(char c) {
  const std::string_view operators = "+-*/^";
  const std::size_t k = operators.find(c);
  return c == '\0' || k == operators.npos ? -1 : static_cast<int>(k);
}

// How tightly they bind: a sum, a product, a sign, a power.
constexpr int precedence[] = {1, 1, 2, 2, 4, 3};

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

}  // namespace

/// Precedence climbing over the text; operations are appended in the order in which they are
/// carried out.
class FormulaParser {
 public:
  FormulaParser(std::string_view text, std::span<const std::string_view> variables)
      : text_(text), variables_(variables) {}

  Expected<Formula> parse() {
    if (text_.size() > Formula::max_length) {
      return input_error(fmt::format("the formula has {} characters", text_.size()), "",
                         fmt::format("use up to {}", Formula::max_length));
    }
    if (auto status = expression(0); !status) return std::unexpected(status.error());
    if (next() != '\0')
      return wrong("an operator is expected", "write one of + - * / ^, or end the formula");
    return std::move(formula_);
  }

 private:
  using Status = Expected<void>;

  char next() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n'))
      ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }

  std::unexpected<Error> wrong(std::string what, std::string remedy = {}) const {
    return input_error(std::move(what), fmt::format("character {}", at_ + 1), std::move(remedy));
  }

  // Operations are in reverse Polish notation. The height of the stack after each is known here, so
  // that evaluation needs neither checks nor memory of its own.
  Status push(int code, double value = 0) {
    const int takes = code < 0 || code >= first_variable ? 0 : formula_functions[code].arguments;
    waiting_ += 1 - takes;
    if (waiting_ > Formula::max_depth)
      return wrong("the formula is nested too deeply", "leave out parentheses");
    formula_.operations_.push_back({code, value});
    return {};
  }

  /// What binds tighter than `least`.
  Status expression(int least) {
    if (++open_ > Formula::max_depth)
      return wrong("the formula is nested too deeply", "leave out parentheses");
    if (auto status = operand(); !status) return status;
    for (int op = operator_of(next()); op >= 0 && precedence[op] > least;
         op = operator_of(next())) {
      ++at_;
      // a^b^c is a^(b^c); all others group to the left.
      const bool to_the_right = op == 4;
      if (auto status = expression(to_the_right ? precedence[op] - 1 : precedence[op]); !status)
        return status;
      if (auto status = push(op); !status) return status;
    }
    --open_;
    return {};
  }

  Status operand() {
    const char c = next();
    // A sign binds less than a power and more than a product: -x^2 is -(x^2), and as it begins an
    // operand 2^-1 is allowed.
    if (c == '-' || c == '+') {
      ++at_;
      if (auto status = expression(precedence[negative]); !status) return status;
      return c == '-' ? push(negative) : Status{};
    }
    if (c == '(') {
      ++at_;
      if (auto status = expression(0); !status) return status;
      return close();
    }
    if (is_digit(c) || c == '.') return number();
    if (is_letter(c)) return name();
    return wrong(c == '\0' ? "the formula ends where a value is expected" : "a value is expected",
                 "write a number, a variable, a function or a parenthesis");
  }

  Status close() {
    if (next() != ')') return wrong("a closing parenthesis is expected", "write )");
    ++at_;
    return {};
  }

  Status number() {
    double value = 0;
    const char* const first = text_.data() + at_;
    const auto [end, error] = read_double(first, text_.data() + text_.size(), value);
    if (error != std::errc{})
      return wrong("the number is too large, too small or not complete", "write one as 1.5e-3");
    at_ += static_cast<std::size_t>(end - first);
    return push(-1, value);
  }

  Status name() {
    std::size_t end = at_;
    while (end < text_.size() && (is_letter(text_[end]) || is_digit(text_[end]))) ++end;
    const std::string_view name = text_.substr(at_, end - at_);
    const auto variable = std::ranges::find(variables_, name);
    if (variable != variables_.end()) {
      at_ = end;
      return push(first_variable + static_cast<int>(variable - variables_.begin()));
    }
    if (name == "pi" || name == "e") {
      at_ = end;
      return push(-1, name == "e" ? std::numbers::e : std::numbers::pi);
    }
    const int function = function_named(name);
    if (function < 0) {
      return wrong(fmt::format("\"{}\" is neither a variable nor a function", name.substr(0, 40)),
                   fmt::format("variables are {}; functions are {}", fmt::join(variables_, ", "),
                               function_names()));
    }
    at_ = end;
    return arguments(function);
  }

  Status arguments(int function) {
    const int count = formula_functions[function].arguments;
    const auto expected = [&] {
      constexpr std::array<std::string_view, 4> places = {"", "a", "a, b", "a, b, c"};
      const std::string_view name = formula_functions[function].name;
      return wrong(
          fmt::format("{} takes {} argument{} in parentheses", name, count, count == 1 ? "" : "s"),
          fmt::format("write {}({})", name, places[static_cast<std::size_t>(count)]));
    };
    if (next() != '(') return expected();
    ++at_;
    for (int k = 0; k < count; ++k) {
      if (k > 0) {
        if (next() != ',') return expected();
        ++at_;
      }
      if (auto status = expression(0); !status) return status;
    }
    if (next() != ')') return expected();
    ++at_;
    return push(function);
  }

  std::string_view text_;
  std::span<const std::string_view> variables_;
  std::size_t at_ = 0;
  int waiting_ = 0, open_ = 0;
  Formula formula_;
};

Expected<Formula> Formula::parse(std::string_view text,
                                 std::span<const std::string_view> variables) {
  return FormulaParser(text, variables).parse();
}

double Formula::operator()(std::span<const double> values) const {
  std::array<double, max_depth> stack;
  std::size_t size = 0;
  for (const auto& [code, value] : operations_) {
    if (code < 0) {
      stack[size++] = value;
    } else if (code >= first_variable) {
      stack[size++] = values[static_cast<std::size_t>(code - first_variable)];
    } else {
      size -= static_cast<std::size_t>(formula_functions[code].arguments);
      stack[size] = formula_functions[code].value(&stack[size]);
      ++size;
    }
  }
  return stack[0];
}

bool Formula::uses(std::size_t variable) const {
  return std::ranges::any_of(operations_, [&](const Operation& o) {
    return o.code == first_variable + static_cast<int>(variable);
  });
}

}  // namespace knead
