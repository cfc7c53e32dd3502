#include "knead/gramian/gramian.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "cli.hpp"
#include "knead/exchange/file_io.hpp"

namespace knead::cli {
namespace {

struct Options {
  int degree = 3, a = 0, b = 0;
  std::string knots, knots_file, method{name(default_gramian_method)}, format = "json";
  bool all = false;
};

struct NamedGramian {
  std::string term;
  BandMatrix matrix;
};

Expected<std::vector<double>> read_knots(const Options& options) {
  if (options.knots_file.empty()) return parse_numbers(options.knots, "--knots");
  auto text = read_file(options.knots_file);
  if (!text) return std::unexpected(text.error());
  return parse_numbers(*text, "--knots-file");
}

Expected<KnotVector> knot_vector(const Options& options) {
  if (options.degree < 1 || options.degree > max_degree) {
    return input_error(fmt::format("degree {} is out of range", options.degree), "--degree",
                       fmt::format("use 1 to {}", max_degree));
  }
  auto numbers = read_knots(options);
  auto knots = numbers ? KnotVector::create(options.degree, std::move(*numbers))
                       : Expected<KnotVector>(std::unexpected(numbers.error()));
  if (knots) return knots;
  Error error = knots.error();
  if (options.knots_file.empty()) {
    if (numbers) error = error.within("--knots");
  } else {
    error.kind = ErrorKind::input;  // what is wrong stands in a file, not in the call
    error.file = options.knots_file;
  }
  return std::unexpected(error);
}

bool all_finite(const BandMatrix& matrix) {
  for (int i = 0; i < matrix.size(); ++i) {
    for (int j = std::max(0, i - matrix.half_bandwidth());
         j <= std::min(matrix.size() - 1, i + matrix.half_bandwidth()); ++j) {
      if (!std::isfinite(matrix(i, j))) return false;
    }
  }
  return true;
}

/// Row i of the band: G(i, i − p) … G(i, i + p), zero outside of the matrix.
void print_json(int degree, int count, const std::string& method, const std::vector<NamedGramian>& gramians) {
  fmt::print(R"({{"degree":{},"count":{},"method":"{}","gramians":{{)", degree, count, method);
  for (std::size_t k = 0; k < gramians.size(); ++k) {
    fmt::print("{}\n \"{}\":{{\"band\":[", k == 0 ? "" : ",", gramians[k].term);
    for (int i = 0; i < count; ++i) {
      fmt::print("{}[", i == 0 ? "\n  " : ",\n  ");
      for (int j = i - degree; j <= i + degree; ++j) {
        const double value = j < 0 || j >= count ? 0 : gramians[k].matrix(i, j);
        fmt::print("{}{}", j == i - degree ? "" : ",", json_number(value));
      }
      fmt::print("]");
    }
    fmt::print("]}}");
  }
  fmt::print("}}}}\n");
}

void print_csv(int degree, int count, const std::vector<NamedGramian>& gramians) {
  fmt::print("term,i,j,value\n");
  for (const NamedGramian& g : gramians) {
    for (int i = 0; i < count; ++i) {
      for (int j = std::max(0, i - degree); j <= std::min(count - 1, i + degree); ++j) {
        fmt::print("{},{},{},{}\n", g.term, i, j, json_number(g.matrix(i, j)));
      }
    }
  }
}

Expected<void> run(const Options& options) {
  const auto method = gramian_method(options.method);
  if (!method) return std::unexpected(method.error().within("--method"));
  if (options.knots.empty() == options.knots_file.empty()) {
    return usage_error(options.knots.empty() ? "no knots are given" : "the knots are given twice", "command line",
                       "give either --knots or --knots-file");
  }
  const auto knots = knot_vector(options);
  if (!knots) return std::unexpected(knots.error());
  std::vector<NamedGramian> gramians;
  if (options.all) {
    auto set = knead::gramians(*knots, *method);
    if (!set) return std::unexpected(set.error());
    gramians = {{"00", set->g00}, {"11", set->g11}, {"22", set->g22}, {"10", set->g10}};
  } else {
    auto matrix = gramian(*knots, options.a, options.b, *method);
    if (!matrix) return std::unexpected(matrix.error().within("--a, --b"));
    gramians = {{fmt::format("{}{}", options.a, options.b), std::move(*matrix)}};
  }
  for (const NamedGramian& g : gramians) {
    if (all_finite(g.matrix)) continue;
    return numerical_error(fmt::format("entries leave the range of double precision (method {})", options.method),
                           "Gramian " + g.term, "scale the knots nearer to 1");
  }
  if (options.format == "csv") {
    print_csv(options.degree, knots->count(), gramians);
  } else {
    print_json(options.degree, knots->count(), options.method, gramians);
  }
  return {};
}

}  // namespace

Action add_gramian(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("gramian", "print Gramian matrices of a B-spline basis");
  command->add_option("--degree", options->degree, "degree of the basis, 1 to 15")->required();
  command->add_option("--knots", options->knots,
                      "all knots, separated by commas, each as often as its multiplicity; may begin with a minus sign");
  command->add_option("--knots-file", options->knots_file, "file with the knots, separated by commas or white space");
  CLI::Option* a = command->add_option("--a", options->a, "derivative of the row functions, 0 to 2 (default 0)");
  CLI::Option* b = command->add_option("--b", options->b, "derivative of the column functions, 0 to 2 (default 0)");
  command->add_flag("--all", options->all, "print 00, 11, 22 and 10")->excludes(a)->excludes(b);
  command->add_option("--method", options->method, gramian_method_help());
  command->add_option("--format", options->format, "json (default) or csv")->check(CLI::IsMember({"json", "csv"}));
  command->footer(
      "Row i of \"band\" holds G(i, i-p) … G(i, i+p), zero outside of the matrix; 17 significant digits.\n" +
      std::string(exit_codes));
  return [options] { return run(*options); };
}

}  // namespace knead::cli
