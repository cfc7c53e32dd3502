#include "knead/energy/stiffness.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <memory>

#include "cli.hpp"
#include "plain_surface.hpp"
#include "rational_option.hpp"
#include "say.hpp"

namespace knead::cli {
namespace {

struct StiffnessArguments {
  std::string degree = "3", net, alpha = "1,0,1", beta = "0,0,0",
              method{name(default_gramian_method)};
  PlainSurfaceOption knots;
  RationalOption rational;
  bool json = false;
};

Expected<std::array<double, 3>> parse_triple(const std::string& text, const std::string& option) {
  auto numbers = parse_numbers(text, option);
  if (!numbers) return std::unexpected(numbers.error());
  if (numbers->size() != 3) {
    return usage_error(fmt::format("{} numbers do not fit", numbers->size()), option,
                       "write three: 11,12,22");
  }
  return std::array<double, 3>{(*numbers)[0], (*numbers)[1], (*numbers)[2]};
}

constexpr double max_entries = 2e8;  // of the matrix; assembling takes 24 bytes for each

Expected<void> check_size(const std::array<int, 2>& degree, const std::array<int, 2>& net,
                          const std::string& option) {
  const double entries = (1.0 + 2 * degree[0]) * net[0] * (1.0 + 2 * degree[1]) * net[1];
  if (entries <= max_entries) return {};
  return usage_error(fmt::format("a matrix of about {:.2g} entries is too large", entries), option,
                     fmt::format("use a net or degrees with at most {:.2g}", max_entries));
}

/// On the knots that are given, or open uniform ones over [0, 1].
Expected<Surface> shape_of(const StiffnessArguments& options, const std::array<int, 2>& degree) {
  if (options.knots.given() != options.net.empty()) {
    return usage_error("neither a net nor knots of both directions, or both, are given", "--net",
                       "write --net as in 64x64, or --knots-u and --knots-v; knead stiffness "
                       "--help explains them");
  }
  if (options.knots.given()) {
    auto shape = options.knots.read(degree);
    if (!shape) return shape;
    if (auto fits = check_size(degree, shape->net(), "--knots-u"); !fits)
      return std::unexpected(fits.error());
    return shape;
  }
  const auto net = parse_pair(options.net, "--net", false);
  if (!net) return std::unexpected(net.error());
  if (auto fits = check_size(degree, *net, "--net"); !fits) return std::unexpected(fits.error());
  const auto u =
      of_option(KnotVector::clamped_uniform(degree[0], (*net)[0]), "--net, first direction");
  if (!u) return std::unexpected(u.error());
  const auto v =
      of_option(KnotVector::clamped_uniform(degree[1], (*net)[1]), "--net, second direction");
  if (!v) return std::unexpected(v.error());
  return Surface::create({*u, *v}, Points::Zero((*net)[0] * (*net)[1], 3));
}

Expected<void> run(const StiffnessArguments& options) {
  const auto degree = parse_pair(options.degree, "--degree", true);
  if (!degree) return std::unexpected(degree.error());
  const auto alpha = parse_triple(options.alpha, "--alpha");
  if (!alpha) return std::unexpected(alpha.error());
  const auto beta = parse_triple(options.beta, "--beta");
  if (!beta) return std::unexpected(beta.error());
  const auto method = gramian_method(options.method);
  if (!method) return std::unexpected(method.error().within("--method"));
  const auto material = of_option(validated({*alpha, *beta}), "--alpha, --beta");
  if (!material) return std::unexpected(material.error());
  const auto shape = shape_of(options, *degree);
  if (!shape) return std::unexpected(shape.error());
  auto settings = options.rational.read();
  if (!settings) return std::unexpected(settings.error());
  if (options.knots.weights.empty() && options.rational.given()) {
    return usage_error("without weights nothing is rational", "--tolerance, --denominator",
                       "leave them out, or give --weights");
  }
  settings->method = *method;
  const auto start = std::chrono::steady_clock::now();
  // Everything comes from options.
  const auto stiffness = of_option(
      Stiffness<2>::create(*shape, stretch_and_bend(*material), *settings), "command line");
  if (!stiffness) return std::unexpected(stiffness.error());
  const SparseMatrix matrix = stiffness->assemble();
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const double norm = matrix.norm();
  if (!std::isfinite(norm)) {
    return numerical_error("the Frobenius norm leaves the range of double precision",
                           "stiffness matrix", "use smaller coefficients");
  }
  if (options.json) {
    say(R"({{"rows":{},"nnz":{},"frobenius":{},"seconds":{},"error_bound":{}}})"
        "\n",
        matrix.rows(), matrix.nonZeros(), json_number(norm), json_number(seconds),
        json_number(stiffness->error_bound()));
  } else {
    say("{} rows, {} entries, Frobenius norm {:.12g}, assembled in {:.3g} s\n", matrix.rows(),
        matrix.nonZeros(), norm, seconds);
    if (shape->rational()) say("{}\n", RationalOption::describe(stiffness->error_bound()));
  }
  return {};
}

}  // namespace

Action add_stiffness(CLI::App& app) {
  auto options = std::make_shared<StiffnessArguments>();
  CLI::App* command = app.add_subcommand(
      "stiffness",
      "assemble the stiffness matrix of a net on open uniform knots over [0,1], or on given knots");
  command->add_option("--degree", options->degree,
                      "degree, or one per direction as in 3x2 (default 3)");
  command->add_option("--net", options->net, "control points per direction, as in 64x64");
  options->knots.add_to(*command, "instead of --net: ");
  command->add_option("--alpha", options->alpha,
                      "stretch coefficients a11,a12,a22 (default 1,0,1)");
  command->add_option("--beta", options->beta, "bend coefficients b11,b12,b22 (default 0,0,0)");
  command->add_option("--method", options->method, gramian_method_help());
  options->rational.add_to(*command);
  command->add_flag("--json", options->json, "print JSON");
  command->footer(std::string(exit_codes));
  return [options] { return run(*options); };
}

}  // namespace knead::cli
