#include "standing_springs.hpp"

#include <algorithm>
#include <ranges>

namespace knead {
namespace {

// A spring adds an eigenvalue of its own to A⁻¹(A + H), so that conjugate gradients take about one
// substitution for each.
constexpr std::size_t many_springs = 64;  // a footprint that is dragged has about 60, side by side

// Π (p_d + 1): with more terms than a point of the spline, r rᵀ would join control points that A
// does not, and fill L.
template <int D>
std::size_t most_terms(std::span<const Spline<D>> patches) {
  std::size_t most = 0;
  for (const Spline<D>& patch : patches) {
    std::size_t terms = 1;
    for (int d = 0; d < D; ++d) terms *= static_cast<std::size_t>(patch.knots(d).degree() + 1);
    most = std::max(most, terms);
  }
  return most;
}

}  // namespace

template <int D>
bool may_stand(const PointForce& force, std::span<const Spline<D>> patches) {
  return force.kind == PointForce::Kind::spring && force.terms.size() <= most_terms<D>(patches);
}

template <int D>
std::vector<PointForce> standing_springs(std::span<const PointForce> forces,
                                         std::span<const Spline<D>> patches) {
  if (forces.size() < many_springs) return {};
  std::vector<PointForce> springs;
  std::ranges::copy_if(forces, std::back_inserter(springs),
                       [&](const PointForce& force) { return may_stand<D>(force, patches); });
  if (springs.size() < many_springs) springs.clear();
  return springs;
}

bool same_stiffness(std::span<const PointForce> a, std::span<const PointForce> b) {
  return std::ranges::equal(a, b, [](const PointForce& s, const PointForce& t) {
    return s.strength == t.strength && s.terms == t.terms;
  });
}

// Springs that meet in an entry are added up in their order.
SparseMatrix spring_stiffness(int size, std::span<const PointForce> springs) {
  std::vector<Eigen::Triplet<double>> entries;
  std::size_t count = 0;
  for (const PointForce& s : springs) count += s.terms.size() * s.terms.size();
  entries.reserve(count);
  for (const PointForce& s : springs) {
    for (const auto& [i, ri] : s.terms) {
      for (const auto& [j, rj] : s.terms) entries.emplace_back(i, j, s.strength * ri * rj);
    }
  }
  SparseMatrix sum(size, size);
  sum.setFromTriplets(entries.begin(), entries.end());
  return sum;
}

// k/2 |way|², way = Σ r x − to, and its force −k r way on every control point of the spring.
void add_springs(std::span<const PointForce> springs, const Points& x, PotentialState& state) {
  for (const PointForce& s : springs) {
    Point way = -s.to;
    for (const auto& [row, r] : s.terms) way += r * x.row(row).transpose();
    state.potential += 0.5 * s.strength * way.squaredNorm();
    for (const auto& [row, r] : s.terms) state.force.row(row) -= s.strength * r * way.transpose();
  }
}

template std::vector<PointForce> standing_springs<1>(std::span<const PointForce>,
                                                     std::span<const Spline<1>>);
template std::vector<PointForce> standing_springs<2>(std::span<const PointForce>,
                                                     std::span<const Spline<2>>);
template std::vector<PointForce> standing_springs<3>(std::span<const PointForce>,
                                                     std::span<const Spline<3>>);
template bool may_stand<1>(const PointForce&, std::span<const Spline<1>>);
template bool may_stand<2>(const PointForce&, std::span<const Spline<2>>);
template bool may_stand<3>(const PointForce&, std::span<const Spline<3>>);

}  // namespace knead
