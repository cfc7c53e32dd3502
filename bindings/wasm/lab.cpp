// Basis functions and Gramians of one knot vector as WebAssembly exports them: the studio's lab.
// The caller writes doubles to `lab_input(count)`, calls, and reads JSON from `lab_text()` and
// doubles from `lab_buffer(which)`; every call may grow the memory, so views of it must be renewed.
// Functions that can fail return 0 on failure; the text is then {"error": …}, and the previous
// state stays.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "answers.hpp"
#include "knead/spline/basis.hpp"
#include "lab_curves.hpp"
#include "lab_gramians.hpp"

#define KNEAD_EXPORT(name) extern "C" __attribute__((export_name(#name)))

namespace knead::lab {
namespace {

using Json = nlohmann::json;

constexpr int highest_order = 2 * max_degree + 1, most_integrals = 30;

struct Lab {
  std::vector<double> input;
  std::string text;
  std::optional<KnotVector> knots;
  Curves curves;
  std::vector<double> values;
  Comparison gramians;
};

Lab& held() {
  static Lab value;
  return value;
}

int answer(const Json& json) { return answer_in(held().text, json); }
int fail(const Error& error) { return fail_in(held().text, error); }

int without_knots() {
  return fail({ErrorKind::usage, "there are no knots", {}, "give a knot vector first"});
}

std::optional<Error> wrong_order(int order) {
  if (-most_integrals <= order && order <= highest_order) return {};
  return Error{
      ErrorKind::usage,
      fmt::format("order {} is out of range", order),
      {},
      fmt::format("use {} to {}; negative orders are integrals", -most_integrals, highest_order)};
}

Json names(const std::array<GramianMethod, 3>& methods) {
  Json all = Json::array();
  for (const GramianMethod m : methods) all.push_back(name(m));
  return all;
}

}  // namespace
}  // namespace knead::lab

using namespace knead;
using namespace knead::lab;

KNEAD_EXPORT(lab_input) double* lab_input(std::size_t count) {
  held().input.resize(count);
  return held().input.data();
}

KNEAD_EXPORT(lab_text) const char* lab_text() { return held().text.data(); }
KNEAD_EXPORT(lab_text_size) std::size_t lab_text_size() { return held().text.size(); }

/// Sets the knot vector of all following calls from the input: {"count", "domain", "clamped",
/// "greville", "integrals"}, the last two per function, ∫N_i over the line.
KNEAD_EXPORT(lab_knots) int lab_knots(int degree) {
  auto made = KnotVector::create(degree, held().input);
  if (!made) return fail(made.error());
  const KnotVector& knots = held().knots.emplace(std::move(*made));
  Json greville = Json::array(), integrals = Json::array();
  for (int i = 0; i < knots.count(); ++i) {
    greville.push_back(knots.greville(i));
    integrals.push_back((knots[i + degree + 1] - knots[i]) / (degree + 1));
  }
  const Interval domain = knots.domain();
  return answer({{"count", knots.count()},
                 {"domain", {domain.lower, domain.upper}},
                 {"clamped", {knots.clamped_start(), knots.clamped_end()}},
                 {"greville", std::move(greville)},
                 {"integrals", std::move(integrals)}});
}

/// Samples all functions: buffers 0 points, 1 offsets (32-bit integers), 2 impulses, as in
/// `Curves`.
KNEAD_EXPORT(lab_curves) int lab_curves(int order, int pixels) {
  if (!held().knots) return without_knots();
  if (const auto wrong = wrong_order(order)) return fail(*wrong);
  const Curves& c = held().curves = sample_curves(*held().knots, order, pixels);
  return answer({{"lowest", c.lowest},
                 {"highest", c.highest},
                 {"weight", c.largest_weight},
                 {"unity", c.unity}});
}

/// Values of all functions at u, anywhere on the line: buffer 3, and their sum.
KNEAD_EXPORT(lab_probe) int lab_probe(int order, double u) {
  if (!held().knots) return without_knots();
  if (const auto wrong = wrong_order(order)) return fail(*wrong);
  const auto& values = held().values = values_at(*held().knots, order, u);
  double sum = 0;
  for (const double v : values) sum += v;
  return answer({{"sum", sum}});
}

/// Where and how function i is not smooth: [{"knot", "multiplicity", "orders", "jumps"}], jumps of
/// these derivatives.
KNEAD_EXPORT(lab_jumps) int lab_jumps(int i) {
  if (!held().knots) return without_knots();
  const KnotVector& knots = *held().knots;
  if (i < 0 || i >= knots.count())
    return fail({ErrorKind::usage, fmt::format("there is no basis function {}", i)});
  Json all = Json::array();
  for (const KnotJumps& at : derivative_jumps(knots, i)) {
    all.push_back({{"knot", at.knot},
                   {"multiplicity", at.multiplicity},
                   {"lowest", knots.degree() - at.multiplicity + 1},
                   {"jumps", at.jumps}});
  }
  return answer(all);
}

/// The Gramian G^ab by all methods: buffers 4 to 6 values by gauss, analytic, recurrence; 7 the
/// absolute integrals; 8 to 10 differences gauss − recurrence, analytic − recurrence, analytic −
/// gauss; 11 to 13 the same relative to 7.
KNEAD_EXPORT(lab_gramians) int lab_gramians(int a, int b) {
  if (!held().knots) return without_knots();
  auto all = compare_gramians(*held().knots, a, b);
  if (!all) return fail(all.error());
  held().gramians = std::move(*all);
  const Comparison& g = held().gramians;
  Json worst = Json::array();
  for (const WorstEntry& w : g.worst) {
    worst.push_back({{"absolute", w.absolute},
                     {"absoluteAt", {w.absolute_row, w.absolute_column}},
                     {"relative", w.relative},
                     {"relativeAt", {w.relative_row, w.relative_column}}});
  }
  return answer({{"size", g.size},
                 {"bandwidth", g.half_bandwidth},
                 {"used", names(g.used)},
                 {"worst", worst}});
}

/// Seconds per Gramian G^ab of each method, [gauss, analytic, recurrence], measured for `budget`
/// seconds each.
KNEAD_EXPORT(lab_times) int lab_times(int a, int b, double budget) {
  if (!held().knots) return without_knots();
  const auto seconds = time_gramians(*held().knots, a, b, budget);
  return seconds ? answer(*seconds) : fail(seconds.error());
}

namespace {
struct Bytes {
  const void* data;
  std::size_t size;
};

template <class T>
Bytes bytes_of(const std::vector<T>& v) {
  return {v.data(), v.size() * sizeof(T)};
}

Bytes buffer(int which) {
  const Lab& lab = held();
  const Comparison& g = lab.gramians;
  switch (which) {
    case 0:
      return bytes_of(lab.curves.points);
    case 1:
      return bytes_of(lab.curves.offsets);
    case 2:
      return bytes_of(lab.curves.impulses);
    case 3:
      return bytes_of(lab.values);
    case 7:
      return bytes_of(g.absolute_integral);
    default:
      break;
  }
  const auto from = [which](int first) { return static_cast<std::size_t>(which - first); };
  if (which >= 4 && which <= 6) return bytes_of(g.values[from(4)]);
  if (which >= 8 && which <= 10) return bytes_of(g.differences[from(8)]);
  if (which >= 11 && which <= 13) return bytes_of(g.relative[from(11)]);
  return {nullptr, 0};
}
}  // namespace

KNEAD_EXPORT(lab_buffer) const void* lab_buffer(int which) { return buffer(which).data; }
KNEAD_EXPORT(lab_buffer_size) std::size_t lab_buffer_size(int which) { return buffer(which).size; }
