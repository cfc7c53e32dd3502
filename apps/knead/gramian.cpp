#include "knead/gramian/gramian.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "cli.hpp"
#include "knead/gramian/rational_gramian.hpp"
#include "knots_option.hpp"
#include "say.hpp"

namespace knead::cli {
namespace {

struct GramianArguments {
  KnotsOption knots;
  int a = 0, b = 0;
  std::string method, weights, format = "json";
  double tolerance = 1e-10;
  bool all = false;
};

struct NamedGramian {
  std::string term;
  BandMatrix matrix;
};

struct Result {
  std::string method;
  std::vector<NamedGramian> gramians;
  std::optional<double> error_bound = {};  // of the rational method
  std::optional<double> digits = {};       // that the analytic method has left
};

constexpr double few_digits = 8;

/// The analytic method cancels where knots are close; the recurrence, which loses no digits, says
/// how much.
Expected<void> estimate_digits(const KnotVector& knots,
                               const std::vector<std::array<int, 2>>& orders, Result& result) {
  if (result.method != name(GramianMethod::analytic)) return {};
  for (std::size_t k = 0; k < orders.size(); ++k) {
    const auto digits = digits_left(knots, orders[k][0], orders[k][1], result.gramians[k].matrix);
    if (!digits) return std::unexpected(digits.error());
    result.digits = std::min(result.digits.value_or(17), *digits);
  }
  if (*result.digits < few_digits) {
    say(stderr,
        "knead: warning: the method analytic has {} left on these knots; --method recurrence loses "
        "none\n",
        *result.digits < 0.5 ? "no digits" : fmt::format("about {:.0f} digits", *result.digits));
  }
  return {};
}

/// Row i of the band: G(i, i − p) … G(i, i + p), zero outside the matrix.
void print_json(int degree, const Result& result) {
  const std::vector<NamedGramian>& gramians = result.gramians;
  const int count = gramians.front().matrix.size();
  say(R"({{"degree":{},"count":{},"method":"{}",)", degree, count, result.method);
  if (result.error_bound) say("\"error_bound\":{},", json_number(*result.error_bound));
  if (result.digits) say("\"digits\":{:.1f},", *result.digits);
  say("\"gramians\":{{");
  for (std::size_t k = 0; k < gramians.size(); ++k) {
    say("{}\n \"{}\":{{\"band\":[", k == 0 ? "" : ",", gramians[k].term);
    for (int i = 0; i < count; ++i) {
      say("{}[", i == 0 ? "\n  " : ",\n  ");
      for (int j = i - degree; j <= i + degree; ++j) {
        const double value = j < 0 || j >= count ? 0 : gramians[k].matrix(i, j);
        say("{}{}", j == i - degree ? "" : ",", json_number(value));
      }
      say("]");
    }
    say("]}}");
  }
  say("}}}}\n");
}

void print_csv(int degree, const Result& result) {
  say("term,i,j,value\n");
  for (const NamedGramian& g : result.gramians) {
    const int count = g.matrix.size();
    for (int i = 0; i < count; ++i) {
      for (int j = std::max(0, i - degree); j <= std::min(count - 1, i + degree); ++j) {
        say("{},{},{},{}\n", g.term, i, j, json_number(g.matrix(i, j)));
      }
    }
  }
}

constexpr std::string_view constant_denominator = "constant-denominator", rational = "rational";

std::vector<std::array<int, 2>> orders(const GramianArguments& options) {
  if (options.all) return {{0, 0}, {1, 1}, {2, 2}, {1, 0}};
  return {{options.a, options.b}};
}

/// "21"; orders of two digits are kept apart, "10,2".
std::string term_name(int a, int b) {
  return fmt::format("{}{}{}", a, a > 9 || b > 9 ? "," : "", b);
}

Expected<Result> compute(const GramianArguments& options, const KnotVector& knots) {
  const std::string chosen =
      options.method.empty() ? std::string(name(default_gramian_method)) : options.method;
  const auto method = gramian_method(chosen);
  if (!method) return std::unexpected(method.error().within("--method"));
  const int a = options.a, b = options.b;  // 0, 0 if all terms are requested, which use one method
  Result result{std::string(name(used_gramian_method(knots, a, b, *method))), {}};
  if (options.all) {
    auto set = knead::gramians(knots, *method);
    if (!set) return std::unexpected(set.error());
    result.gramians = {{"00", set->g00}, {"11", set->g11}, {"22", set->g22}, {"10", set->g10}};
    return result;
  }
  auto matrix = gramian(knots, a, b, *method);
  if (!matrix) return std::unexpected(matrix.error().within("--a, --b"));
  result.gramians = {{term_name(a, b), std::move(*matrix)}};
  return result;
}

/// With weights: to a tolerance, or by the approximation with a constant denominator per span.
Expected<Result> compute_rational(const GramianArguments& options, const KnotVector& knots) {
  const auto weights = parse_numbers(options.weights, "--rational-weights");
  if (!weights) return std::unexpected(weights.error());
  Result result{options.method.empty() ? std::string(rational) : options.method, {}};
  if (result.method != rational && result.method != constant_denominator) {
    return usage_error(fmt::format("the method \"{}\" does not take weights", options.method),
                       "--method", fmt::format("use {} or {}", rational, constant_denominator));
  }
  if (!(options.tolerance > 0)) {
    return usage_error(fmt::format("{} is no tolerance", options.tolerance), "--tolerance",
                       "use a fraction such as 1e-10");
  }
  for (const auto& [a, b] : orders(options)) {
    const std::string term = term_name(a, b);
    if (result.method == constant_denominator) {
      auto matrix =
          of_option(constant_denominator_gramian(knots, *weights, a, b), "--rational-weights");
      if (!matrix) return std::unexpected(matrix.error());
      result.gramians.push_back({term, std::move(*matrix)});
    } else {
      auto found = of_option(rational_gramian(knots, *weights, a, b, options.tolerance),
                             "--rational-weights");
      if (!found) return std::unexpected(found.error());
      result.gramians.push_back({term, std::move(found->matrix)});
      result.error_bound = std::max(result.error_bound.value_or(0), found->error_bound);
    }
  }
  return result;
}

Expected<void> run(const GramianArguments& options) {
  const auto knots = options.knots.read();
  if (!knots) return std::unexpected(knots.error());
  auto result =
      options.weights.empty() ? compute(options, *knots) : compute_rational(options, *knots);
  if (!result) return std::unexpected(result.error());
  for (const NamedGramian& g : result->gramians) {
    if (g.matrix.all_finite()) continue;
    return numerical_error(
        fmt::format("entries leave the range of double precision (method {})", result->method),
        "Gramian " + g.term, "scale the knots nearer to 1");
  }
  if (auto status = estimate_digits(*knots, orders(options), *result); !status) return status;
  if (options.format == "csv") {
    print_csv(options.knots.degree, *result);
  } else {
    print_json(options.knots.degree, *result);
  }
  return {};
}

}  // namespace

Action add_gramian(CLI::App& app) {
  auto options = std::make_shared<GramianArguments>();
  CLI::App* command = app.add_subcommand("gramian", "print Gramian matrices of a B-spline basis");
  options->knots.add_to(*command);
  CLI::Option* a = command->add_option("--a", options->a,
                                       "derivative of the row functions, 0 to 15 (default 0)");
  CLI::Option* b = command->add_option("--b", options->b,
                                       "derivative of the column functions, 0 to 15 (default 0)");
  command->add_flag("--all", options->all, "print 00, 11, 22 and 10")->excludes(a)->excludes(b);
  command->add_option(
      "--method", options->method,
      gramian_method_help() + "; with weights: rational (default) or constant-denominator");
  CLI::Option* weights =
      command->add_option("--rational-weights", options->weights,
                          "one positive weight per function: Gramians of the rational basis");
  command
      ->add_option("--tolerance", options->tolerance,
                   "error allowed with weights, relative to the largest entry (default 1e-10); the "
                   "JSON gives the bound")
      ->needs(weights);
  command->add_option("--format", options->format, "json (default) or csv")
      ->check(CLI::IsMember({"json", "csv"}));
  command->footer(
      "Row i of \"band\" holds G(i, i-p) … G(i, i+p), zero outside the matrix; 17 significant "
      "digits. \"method\" is "
      "the\n"
      "one used: recurrence covers 00, 10, 01, 11 and 22 and leaves other orders to gauss.\n" +
      std::string(exit_codes));
  return [options] { return run(*options); };
}

}  // namespace knead::cli
