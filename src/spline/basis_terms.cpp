#include "basis_terms.hpp"

#include "knead/spline/basis.hpp"

namespace knead {

template <int D>
std::vector<std::pair<int, double>> basis_terms(const Spline<D>& spline,
                                                const std::array<double, D>& u, int first,
                                                Side side) {
  std::vector<std::pair<int, double>> terms = {{0, 1.0}};
  for (std::size_t d = 0; d < D; ++d) {
    const KnotVector& knots = spline.knots()[d];
    std::array<double, max_degree + 1> n;
    const int span = knots.find_span(u[d], side), p = knots.degree();
    basis_values(knots, span, u[d], n.data());
    std::vector<std::pair<int, double>> next;
    next.reserve(terms.size() * static_cast<std::size_t>(p + 1));
    for (const auto& [row, value] : terms) {
      for (int r = 0; r <= p; ++r) {
        next.emplace_back(row * knots.count() + span - p + r,
                          value * n[static_cast<std::size_t>(r)]);
      }
    }
    terms = std::move(next);
  }
  double sum = 0;
  for (auto& [row, value] : terms) {
    if (spline.rational()) value = spline.weights()[static_cast<std::size_t>(row)] * value;
    sum += value;
    row += first;
  }
  for (auto& term : terms) term.second /= sum;
  return terms;
}

template std::vector<std::pair<int, double>> basis_terms<1>(const Curve&,
                                                            const std::array<double, 1>&, int,
                                                            Side);
template std::vector<std::pair<int, double>> basis_terms<2>(const Surface&,
                                                            const std::array<double, 2>&, int,
                                                            Side);
template std::vector<std::pair<int, double>> basis_terms<3>(const Volume&,
                                                            const std::array<double, 3>&, int,
                                                            Side);

}  // namespace knead
