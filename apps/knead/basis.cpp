#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <optional>

#include "cli.hpp"
#include "knead/spline/basis.hpp"
#include "knots_option.hpp"
#include "say.hpp"

namespace knead::cli {
namespace {

constexpr int max_integral = 30, max_samples = 10'000'000;

struct BasisArguments {
  KnotsOption knots;
  int index = 0, samples = 101;
  std::optional<int> derivative, integral;
  std::optional<double> from, to;
  std::string format = "csv";
};

Expected<void> check(const BasisArguments& options, int count) {
  if (options.index < 0 || options.index >= count) {
    return usage_error(fmt::format("there is no basis function {}", options.index), "--index",
                       fmt::format("use 0 to {}", count - 1));
  }
  if (options.derivative.value_or(0) < 0)
    return usage_error("the order is negative", "--derivative", "use 0 or more");
  if (options.integral && (*options.integral < 0 || *options.integral > max_integral)) {
    return usage_error(fmt::format("{} integrations cannot be done", *options.integral),
                       "--integral", fmt::format("use 0 to {}", max_integral));
  }
  if (options.samples < 1 || options.samples > max_samples) {
    return usage_error(fmt::format("{} samples cannot be taken", options.samples), "--samples",
                       fmt::format("use 1 to {}", max_samples));
  }
  return {};
}

/// The jumps at knots of N^(order), or for order p + 1 its impulses.
std::string jumps_json(const KnotVector& knots, int index, int order) {
  const bool impulses = order == knots.degree() + 1;
  std::string text;
  const auto add = [&text](const KnotJumps& at, const char* what, double value,
                           const std::string& more) {
    text += fmt::format("{}{{\"knot\":{},\"{}\":{}{}}}", text.empty() ? "" : ",",
                        json_number(at.knot), what, json_number(value), more);
  };
  for (const KnotJumps& at : derivative_jumps(knots, index)) {
    const double jump = at.of_order(order, knots.degree());
    const std::vector<double> weights = impulses ? at.impulses() : std::vector<double>();
    if (!weights.empty()) {
      std::string all;
      for (const double weight : weights) all += (all.empty() ? "" : ",") + json_number(weight);
      add(at, "weight", weights.front(), ",\"weights\":[" + all + "]");
    } else if (jump != 0) {
      add(at, "jump", jump, "");
    }
  }
  return fmt::format("\"{}\":[{}],", impulses ? "diracs" : "jumps", text);
}

Expected<void> run(const BasisArguments& options) {
  const auto knots = options.knots.read();
  if (!knots) return std::unexpected(knots.error());
  if (auto checked = check(options, knots->count()); !checked) return checked;
  const double from = options.from.value_or(knots->domain().lower),
               to = options.to.value_or(knots->domain().upper);
  if (!std::isfinite(from) || !std::isfinite(to))
    return usage_error("the interval is not finite", "--from, --to");
  const int order = options.derivative.value_or(0);
  const bool json = options.format == "json";
  if (json) {
    say(R"({{"degree":{},"count":{},"index":{},"{}":{},)", knots->degree(), knots->count(),
        options.index, options.integral ? "integral" : "derivative",
        options.integral.value_or(order));
    if (!options.integral) say("{}", jumps_json(*knots, options.index, order));
    say("\"samples\":[");
  } else {
    say("u,value\n");
  }
  for (int k = 0; k < options.samples; ++k) {
    const double t = options.samples == 1 ? 0 : static_cast<double>(k) / (options.samples - 1);
    const double u = k + 1 == options.samples && k > 0 ? to : from + (to - from) * t;
    const double value = options.integral
                             ? basis_integral(*knots, options.index, *options.integral, u)
                             : basis_function(*knots, options.index, order, u);
    if (json) {
      say("{}[{},{}]", k == 0 ? "" : ",", json_number(u), json_number(value));
    } else {
      say("{},{}\n", json_number(u), json_number(value));
    }
  }
  if (json) say("]}}\n");
  return {};
}

}  // namespace

Action add_basis(CLI::App& app) {
  auto options = std::make_shared<BasisArguments>();
  CLI::App* command = app.add_subcommand(
      "basis", "sample a basis function, its derivatives or its repeated integrals");
  options->knots.add_to(*command);
  command->add_option("--index", options->index, "which function, counted from 0 (default 0)");
  CLI::Option* derivative = command->add_option("--derivative", options->derivative,
                                                "order of the derivative (default 0)");
  command->add_option("--integral", options->integral, "number of integrations from the left")
      ->excludes(derivative);
  command->add_option("--samples", options->samples,
                      "number of samples, ends included (default 101)");
  command->add_option("--from", options->from, "first parameter (default: start of the domain)");
  command->add_option("--to", options->to, "last parameter (default: end of the domain)");
  command->add_option("--format", options->format, "csv (default) or json")
      ->check(CLI::IsMember({"csv", "json"}));
  command->footer(
      "At a knot the limit from the right is taken. JSON also lists where the derivative jumps; "
      "for the derivative of\n"
      "order degree + 1, which is zero elsewhere, it lists the weights of the Dirac impulses and, "
      "where a knot is "
      "repeated,\n"
      "of their derivatives.\n" +
      std::string(exit_codes));
  return [options] { return run(*options); };
}

}  // namespace knead::cli
