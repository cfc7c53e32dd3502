#include "kernel_call.hpp"

#include <algorithm>

namespace knead::detail {

KernelCall::KernelCall(const KnotVector& knots, GramianSet& set) {
  const std::span<const double> all = knots.knots();
  const int size = static_cast<int>(all.size());
  // The tail begins early enough to contain the knots of rows past the last, which kernels sweep
  // too.
  knots_.body = all.data();
  knots_.size = size;
  knots_.tail_begin = std::max(0, size - KernelKnots::readable);
  const auto end = std::copy(all.begin() + knots_.tail_begin, all.end(), tail_.begin());
  std::fill(end, tail_.end(), all.back());
  knots_.tail = tail_.data();

  BandMatrix* const terms[4] = {&set.g00, &set.g11, &set.g22, &set.g10};
  for (int t = 0; t < 4; ++t) {
    output_.g[t] = terms[t]->diagonal(0).data();
    output_.stride[t] = terms[t]->stride();
  }
  for (int s = 1; s <= knots.degree(); ++s) output_.lower10[s - 1] = set.g10.diagonal(-s).data();
}

void resize(GramianSet& set, const KnotVector& knots) {
  const auto fit = [&](BandMatrix& matrix, BandSymmetry symmetry) {
    if (matrix.size() != knots.count() || matrix.half_bandwidth() != knots.degree() ||
        matrix.symmetry() != symmetry) {
      matrix = BandMatrix(knots.count(), knots.degree(), symmetry);
    }
  };
  fit(set.g00, BandSymmetry::symmetric);
  fit(set.g11, BandSymmetry::symmetric);
  fit(set.g22, BandSymmetry::symmetric);
  fit(set.g10, BandSymmetry::general);
}

}  // namespace knead::detail
