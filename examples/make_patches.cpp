// Writes a STEP file of four patches that meet in a cross, cut from one dome: a document of several
// surfaces made from scratch.
#include <array>
#include <cstdio>
#include <exception>
#include <stdexcept>

#include "knead/exchange/file_io.hpp"
#include "knead/session/document.hpp"
#include "knead/spline/spline_refinement.hpp"

namespace {

using namespace knead;

template <class T>
T value(Expected<T> result) {
  if (!result) throw std::runtime_error(result.error().message());
  return std::move(*result);
}

/// The quarter [s/2, (s + 1)/2] × [t/2, (t + 1)/2] of a surface over [0, 1]² with knots of full
/// multiplicity at 1/2: its control points are those that belong to the quarter.
Surface quarter(const Surface& whole, int s, int t) {
  std::array<std::vector<double>, 2> knots;
  std::array<int, 2> first{};
  for (int d = 0; d < 2; ++d) {
    const auto side = static_cast<std::size_t>(d);
    const int which = d == 0 ? s : t;
    const double lower = 0.5 * which, upper = lower + 0.5;
    const KnotVector& all = whole.knots(d);
    for (double x : all.knots()) {
      if (x >= lower && x <= upper) knots[side].push_back(x);
    }
    // Three of the four knots that end a clamped cubic at 1/2 stand there already.
    knots[side].insert(which == 0 ? knots[side].end() : knots[side].begin(), 0.5);
    first[side] = which == 0 ? 0 : all.count() - (static_cast<int>(knots[side].size()) - 4);
  }
  const KnotVector u = value(KnotVector::create(3, knots[0])),
                   v = value(KnotVector::create(3, knots[1]));
  Points points(u.count() * v.count(), 3);
  for (int i = 0; i < u.count(); ++i) {
    for (int j = 0; j < v.count(); ++j) {
      points.row(i * v.count() + j) =
          whole.control_points().row((first[0] + i) * whole.net()[1] + first[1] + j);
    }
  }
  return value(Surface::create({u, v}, points));
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2) {
    std::fputs("usage: example_make_patches OUT.step\n", stderr);
    return 2;
  }
  const KnotVector knots = value(KnotVector::clamped_uniform(3, 12));
  Points points(144, 3);
  for (int i = 0; i < 12; ++i) {
    for (int j = 0; j < 12; ++j) {
      const double u = knots.greville(i), v = knots.greville(j);
      points.row(12 * i + j) << 10 * u, 10 * v, 48 * u * (1 - u) * v * (1 - v);
    }
  }
  const Surface dome = value(Surface::create({knots, knots}, points));
  const Surface cut = value(insert_knots<2>(dome, {{{0.5, 0.5, 0.5}, {0.5, 0.5, 0.5}}}));
  std::vector<DocumentSurface> patches;
  for (int s = 0; s < 2; ++s) {
    for (int t = 0; t < 2; ++t) {
      patches.push_back({"", "patch " + std::to_string(2 * s + t + 1), "mm",
                         std::make_shared<const Surface>(quarter(cut, s, t))});
    }
  }
  const auto written =
      write_file_atomically(argv[1], value(Document::fresh("patches").save(patches)));
  if (!written) throw std::runtime_error(written.error().message());
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return 1;
}
