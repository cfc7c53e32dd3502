#include "plain_surface.hpp"

#include <fmt/format.h>

#include <charconv>

namespace knead::cli {

Expected<std::array<int, 2>> parse_pair(const std::string& text, const std::string& option,
                                        bool one_for_both) {
  const auto wrong = [&] {
    return usage_error(fmt::format("\"{}\" does not fit", text), option,
                       one_for_both ? "write one whole number, or two as in 3x2"
                                    : "write two whole numbers as in 64x64");
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

void PlainSurfaceOption::add_to(CLI::App& command, const std::string& purpose) {
  command.add_option("--knots-u", u, purpose + "knots of the first direction");
  command.add_option("--knots-v", v, purpose + "knots of the second direction");
  command.add_option("--weights", weights,
                     purpose + "weights of all control points, v fast (default: none)");
}

Expected<Surface> PlainSurfaceOption::read(const std::array<int, 2>& degree) const {
  std::array<KnotVector, 2> knots = {*KnotVector::clamped_uniform(1, 2),
                                     *KnotVector::clamped_uniform(1, 2)};
  for (std::size_t d = 0; d < 2; ++d) {
    const std::string option = d == 0 ? "--knots-u" : "--knots-v";
    auto values = parse_numbers(d == 0 ? u : v, option);
    if (!values) return std::unexpected(values.error());
    auto made = of_option(KnotVector::create(degree[d], *std::move(values)), option);
    if (!made) return std::unexpected(made.error());
    knots[d] = *std::move(made);
  }
  std::vector<double> all;
  if (!weights.empty()) {
    auto values = parse_numbers(weights, "--weights");
    if (!values) return std::unexpected(values.error());
    all = *std::move(values);
  }
  const int m = knots[0].count(), n = knots[1].count();
  Points points(m * n, 3);
  for (int k = 0; k < m * n; ++k)
    points.row(k) << knots[0].greville(k / n), knots[1].greville(k % n), 0;
  return of_option(Surface::create(std::move(knots), std::move(points), std::move(all)),
                   weights.empty() ? "--knots-u, --knots-v" : "--weights");
}

}  // namespace knead::cli
