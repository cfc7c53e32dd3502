#include "fit_system.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "base/interruption.hpp"
#include "base/parallel_for.hpp"
#include "normal_equations.hpp"

namespace knead::morph {
namespace {

// Weights relative to those of the data, which are 1 for the area of the size squared.
constexpr double position_weight = 1e3;
constexpr double slope_weight = 1;
constexpr double least_length = 1e-3;  // of the size: shorter edges weigh as much

// The energy on a domain whose sides are the mean lengths of the lines of parameters, in units of
// the root of the area. Bending makes displacements smooth between data; stretch lets them run out
// flat beyond the last datum within about a side of the domain, where bending alone would go on
// with the slope there to any distance.
constexpr double bend = 1, stretch = 1;
// The whole surface's displacement costs this: a surface that neither data nor edges move stays.
constexpr double least_energy = 1e-6;

// What is not known of a datum is guessed as zero, or what the displacement was before, with this
// share of its weight: where nothing else is known points do not slide.
constexpr double guessed = 1e-3;
constexpr double row_work = 500;  // multiplications for a row of a bicubic net, allocations too

/// The least index at which several threads have failed, whatever their order.
class FirstFailure {
 public:
  void note(std::size_t index) {
    std::size_t least = least_;
    while (index < least && !least_.compare_exchange_weak(least, index)) {
    }
  }
  [[nodiscard]] bool any() const { return least_ != none; }
  [[nodiscard]] std::size_t index() const { return least_; }

 private:
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  std::atomic<std::size_t> least_ = none;
};

/// The difference of both sides of a joint at a point: of R, or of its derivatives across.
Expected<Terms> difference(const FitNets& nets, const Joint& joint, std::size_t point,
                           bool derivative) {
  Terms result;
  for (std::size_t side = 0; side < 2; ++side) {
    const Joint::Foot& foot = joint.points[point][side];
    const double sign = side == 0 ? 1 : -1;
    const int surface = joint.surfaces[side];
    for (int along = derivative ? 0 : -1; along < (derivative ? 2 : 0); ++along) {
      const double factor = derivative ? sign * foot.across[along] : sign;
      const auto added = nets.add_row(surface, foot.at, joint.sides[side], along, factor, result);
      if (!added) return std::unexpected(added.error());
    }
  }
  // Edges along a side of a net concern one row of it, or two.
  std::erase_if(result, [](const auto& term) { return term.second == 0; });
  return result;
}

/// E of one surface. The basis is that of the polynomial net, weights or not: an energy chooses
/// among displacements, and this one is exact, quickly made and bounded whatever the weights.
Expected<SparseMatrix> energy_of(const Surface& s, const FitUnits& units) {
  Material material;
  material.alpha = {stretch, 0, stretch};
  material.beta = {bend, bend, bend};
  Energy<2> energy = stretch_and_bend(material);
  for (const EnergyTerm<2>& term : mass_energy<2>(least_energy)) energy.push_back(term);
  const auto k = Stiffness<2>::create(s.knots(), on_scaled_domain<2>(energy, units.factors));
  if (!k) return std::unexpected(k.error());
  return k->assemble();
}

}  // namespace

Expected<FitSystem> FitSystem::create(const FitNets& nets, std::span<const FitPoint> points,
                                      std::span<const Joint> joints,
                                      std::span<const FitUnits> units, double size) {
  FitSystem result;
  if (auto made = result.make_data(nets, points); !made) return std::unexpected(made.error());
  if (auto made = result.make_joints(nets, joints); !made) return std::unexpected(made.error());
  NormalEquations fit(nets.unknowns);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Point &n = result.along_[k], &d = result.wanted_[k];
    const Point known = n.isZero(0) ? d : Point(guessed * d + (1 - guessed) * n.dot(d) * n);
    fit.add(result.data_[k], result.weights_[k], known);
  }
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const double share = std::max(joints[j].length / size, least_length) /
                         static_cast<double>(joints[j].points.size());
    const double position = position_weight * joints[j].position_share * share;
    const double slope = slope_weight * joints[j].slope_share * share * size * size;
    for (std::size_t k = 0; k < result.apart_[j].size(); ++k)
      fit.add(result.apart_[j][k], position, result.wanted_apart(j, k));
    for (const Terms& row : result.slopes_[j]) fit.add(row, slope, Point::Zero());
  }
  result.right_ = fit.right();
  NormalEquations energies(nets.unknowns);
  for (std::size_t s = 0; s < nets.surfaces.size(); ++s) {
    if (nets.fixed[s]) continue;
    const auto own = energy_of(nets.surfaces[s], units[s]);
    if (!own) return std::unexpected(own.error());
    const auto from = static_cast<std::size_t>(nets.first[s]);
    energies.add(
        *own,
        std::span(nets.unknown).subspan(from, static_cast<std::size_t>(nets.surfaces[s].size())),
        units[s].share);
  }
  auto matrix =
      FitMatrix::create(fit.matrix(), energies.matrix(), result.across(nets.unknowns), nets.kept);
  if (!matrix) return std::unexpected(matrix.error());
  result.matrix_ = *std::move(matrix);
  return result;
}

Expected<void> FitSystem::make_data(const FitNets& nets, std::span<const FitPoint> points) {
  const auto row_of = [&](std::size_t k, Terms& row) {
    return nets.add_row(points[k].surface, points[k].at, Side::right, -1, 1, row);
  };
  for (const FitPoint& point : points) {
    wanted_.push_back(point.wanted);
    along_.push_back(point.along);
    weights_.push_back(point.weight * point.share);
  }
  data_.resize(points.size());
  FirstFailure failure;
  const auto count = static_cast<std::ptrdiff_t>(points.size());
  detail::parallel_for(
      count, detail::block_size(count, row_work), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
          if (!row_of(k, data_[k])) failure.note(k);
        }
      });
  Terms again;
  return failure.any() ? row_of(failure.index(), again) : Expected<void>();
}

std::vector<SparseMatrix> FitSystem::across(int unknowns) const {
  std::vector<SparseMatrix> result;
  if (std::ranges::all_of(along_, [](const Point& n) { return n.isZero(0); })) return result;
  result.resize(coordinate_blocks.size());
  detail::parallel_for(std::ssize(result), 1, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto c = static_cast<std::size_t>(begin); c < static_cast<std::size_t>(end); ++c) {
      const auto [i, j] = coordinate_blocks[c];
      NormalEquations block(unknowns);
      for (std::size_t k = 0; k < data_.size(); ++k) {
        const Point& n = along_[k];
        if (n.isZero(0)) continue;
        const double share = (i == j ? 1.0 : 0.0) - n[i] * n[j];
        block.add(data_[k], (1 - guessed) * weights_[k] * share, Point::Zero());
      }
      result[c] = block.matrix();
    }
  });
  return result;
}

Expected<void> FitSystem::make_joints(const FitNets& nets, std::span<const Joint> joints) {
  apart_.resize(joints.size());
  slopes_.resize(joints.size());
  for (const Joint& joint : joints) wanted_apart_.push_back(joint.apart);
  const auto rows_of = [&](std::size_t j) -> Expected<void> {
    const Joint& joint = joints[j];
    apart_[j].clear();
    slopes_[j].clear();
    for (std::size_t k = 0; k < joint.points.size(); ++k) {
      const bool sloped = joint.smooth && !joint.points[k][0].across.isZero() &&
                          !joint.points[k][1].across.isZero();
      for (const bool derivative : {false, true}) {
        if (derivative ? !sloped : !joint.position) continue;
        auto row = difference(nets, joint, k, derivative);
        if (!row) return std::unexpected(row.error());
        (derivative ? slopes_ : apart_)[j].push_back(*std::move(row));
      }
    }
    return {};
  };
  FirstFailure failure;
  const auto count = static_cast<std::ptrdiff_t>(joints.size());
  detail::parallel_for(count, detail::block_size(count, 100 * row_work),
                       [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                         for (auto j = static_cast<std::size_t>(begin);
                              j < static_cast<std::size_t>(end); ++j) {
                           if (!rows_of(j)) failure.note(j);
                         }
                       });
  return failure.any() ? rows_of(failure.index()) : Expected<void>();
}

FitSystem::Parting FitSystem::parting(std::size_t joint, const Points& x) const {
  Parting result;
  for (std::size_t k = 0; k < apart_[joint].size(); ++k) {
    const double distance = (value_of(apart_[joint][k], x) - wanted_apart(joint, k)).norm();
    if (distance <= result.distance) continue;
    result = {distance, k};
  }
  return result;
}

void FitSystem::measure(FitState& state) const {
  const auto count = static_cast<std::ptrdiff_t>(data_.size());
  std::vector<double> squares(data_.size());
  detail::parallel_for(
      count, detail::block_size(count, 60), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k)
          squares[k] = residual(k, state.x).squaredNorm();
      });
  const double sum = std::accumulate(squares.begin(), squares.end(), 0.0);
  state.rms_residual = squares.empty() ? 0 : std::sqrt(sum / static_cast<double>(squares.size()));
  state.largest_residual = squares.empty() ? 0 : std::sqrt(*std::ranges::max_element(squares));
  state.largest_parting = state.largest_slope = 0;
  for (std::size_t j = 0; j < apart_.size(); ++j) {
    state.largest_parting = std::max(state.largest_parting, parting(j, state.x).distance);
    for (const Terms& row : slopes_[j])
      state.largest_slope = std::max(state.largest_slope, value_of(row, state.x).norm());
  }
}

// Probes whose coordinates are 1 or -1 by chance, of a fixed sequence (M. Hutchinson, *A stochastic
// estimator of the trace of the influence matrix*, 1990): three at once, one per coordinate.
double FitSystem::freedom(const SparseCholesky& factor) const {
  std::mt19937 random(1);
  Points probes(static_cast<Eigen::Index>(data_.size()), 3);
  Points right = Points::Zero(right_.rows(), 3);
  for (std::size_t k = 0; k < data_.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    const auto bits = random();
    for (int c = 0; c < 3; ++c) probes(row, c) = (bits >> c & 1) != 0 ? 1 : -1;
    // Of data along a direction one probe is for it alone, and counts three times.
    if (!along_[k].isZero(0))
      probes.row(row) = std::sqrt(3.0) * probes(row, 0) * along_[k].transpose();
    for (const auto& [unknown, value] : data_[k])
      right.row(unknown) += weights_[k] * value * probes.row(row);
  }
  const Points x = matrix_.solved(factor, right);
  double result = 0;
  for (std::size_t k = 0; k < data_.size(); ++k)
    result += value_of(data_[k], x).dot(probes.row(static_cast<Eigen::Index>(k)).transpose());
  return result / 3;
}

Expected<FitState> FitSystem::solve(double lambda,
                                    const std::function<bool(const FitState&)>& enough,
                                    bool with_freedom) const {
  const auto factor = matrix_.factor(lambda);
  if (!factor) return std::unexpected(factor.error());
  FitState state{.x = Points::Zero(right_.rows(), 3)};
  do {
    if (Interruption::asked_for()) return interrupted_error();
    state.x += matrix_.solved(*factor, right_ - matrix_.times_m(state.x));
    ++state.rounds;
    measure(state);
  } while (!enough(state));
  if (with_freedom) state.freedom = freedom(*factor);
  return state;
}

}  // namespace knead::morph
