#include "knead/energy/stiffness.hpp"

#include <fmt/format.h>

#include <charconv>
#include <chrono>
#include <cmath>
#include <memory>

#include "cli.hpp"

namespace knead::cli {
namespace {

struct StiffnessArguments {
  std::string degree = "3", net, alpha = "1,0,1", beta = "0,0,0", method{name(default_gramian_method)};
  bool json = false;
};

/// "3" or "3x2": one whole number per direction.
Expected<std::array<int, 2>> parse_pair(const std::string& text, const std::string& option, bool one_for_both) {
  const auto wrong = [&] {
    return usage_error(
        fmt::format("\"{}\" does not fit", text), option,
        one_for_both ? "write one whole number, or two as in 3x2" : "write two whole numbers as in 64x64");
  };
  std::array<int, 2> pair{};
  const char *at = text.data(), *end = at + text.size();
  for (std::size_t d = 0; d < 2; ++d) {
    const auto [stop, code] = std::from_chars(at, end, pair[d]);
    if (code != std::errc{}) return wrong();
    if (d == 0 && stop == end && one_for_both) {
      pair[1] = pair[0];
      return pair;
    }
    if (d == 0 ? (stop == end || *stop != 'x') : stop != end) return wrong();
    at = stop + 1;
  }
  return pair;
}

Expected<std::array<double, 3>> parse_triple(const std::string& text, const std::string& option) {
  auto numbers = parse_numbers(text, option);
  if (!numbers) return std::unexpected(numbers.error());
  if (numbers->size() != 3) {
    return usage_error(fmt::format("{} numbers do not fit", numbers->size()), option, "write three: 11,12,22");
  }
  return std::array<double, 3>{(*numbers)[0], (*numbers)[1], (*numbers)[2]};
}

Expected<void> run(const StiffnessArguments& options) {
  const auto degree = parse_pair(options.degree, "--degree", true);
  if (!degree) return std::unexpected(degree.error());
  const auto net = parse_pair(options.net, "--net", false);
  if (!net) return std::unexpected(net.error());
  const auto alpha = parse_triple(options.alpha, "--alpha");
  if (!alpha) return std::unexpected(alpha.error());
  const auto beta = parse_triple(options.beta, "--beta");
  if (!beta) return std::unexpected(beta.error());
  const auto method = gramian_method(options.method);
  if (!method) return std::unexpected(method.error().within("--method"));
  const auto material = validated({*alpha, *beta});
  if (!material) return std::unexpected(material.error());
  const auto u = KnotVector::clamped_uniform((*degree)[0], (*net)[0]);
  if (!u) return std::unexpected(u.error().within("--net, first direction"));
  const auto v = KnotVector::clamped_uniform((*degree)[1], (*net)[1]);
  if (!v) return std::unexpected(v.error().within("--net, second direction"));

  const double entries = (1.0 + 2 * (*degree)[0]) * (*net)[0] * (1.0 + 2 * (*degree)[1]) * (*net)[1];
  if (entries > 1e9) {
    return input_error(fmt::format("about {:.2g} entries are too many for this machine", entries), "--net",
                       "use a smaller net");
  }
  const auto start = std::chrono::steady_clock::now();
  const auto stiffness =
      Stiffness<2>::create(std::array<KnotVector, 2>{*u, *v}, stretch_and_bend(*material), {*method, 0});
  if (!stiffness) return std::unexpected(stiffness.error());
  const SparseMatrix matrix = stiffness->assemble();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const double norm = matrix.norm();
  if (!std::isfinite(norm)) {
    return numerical_error("the Frobenius norm leaves the range of double precision", "stiffness matrix",
                           "use smaller coefficients");
  }
  if (options.json) {
    fmt::print(R"({{"rows":{},"nnz":{},"frobenius":{},"seconds":{}}})"
               "\n",
               matrix.rows(), matrix.nonZeros(), json_number(norm), json_number(seconds));
  } else {
    fmt::print("{} rows, {} entries, Frobenius norm {:.12g}, assembled in {:.3g} s\n", matrix.rows(), matrix.nonZeros(),
               norm, seconds);
  }
  return {};
}

}  // namespace

Action add_stiffness(CLI::App& app) {
  auto options = std::make_shared<StiffnessArguments>();
  CLI::App* command =
      app.add_subcommand("stiffness", "assemble the stiffness matrix of a net on open uniform knots over [0,1]");
  command->add_option("--degree", options->degree, "degree, or one per direction as in 3x2 (default 3)");
  command->add_option("--net", options->net, "control points per direction, as in 64x64")->required();
  command->add_option("--alpha", options->alpha, "stretch coefficients a11,a12,a22 (default 1,0,1)");
  command->add_option("--beta", options->beta, "bend coefficients b11,b12,b22 (default 0,0,0)");
  command->add_option("--method", options->method, gramian_method_help());
  command->add_flag("--json", options->json, "print JSON");
  command->footer(std::string(exit_codes));
  return [options] { return run(*options); };
}

}  // namespace knead::cli
