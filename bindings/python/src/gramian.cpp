#include "knead/gramian/gramian.hpp"
#include "binding.hpp"

namespace knead::python {

void bind_gramian(py::module_& module) {
  // (offsets, diagonals) as `scipy.sparse.dia_array` has them: diagonals[k, j] is A(j − offsets[k],
  // j).
  module.def("gramian", [](int degree, const py::object& knots, int a, int b) {
    auto vector = KnotVector::create(degree, Doubles(knots).vector());
    if (!vector) raise(vector.error().within("knots"));
    const BandMatrix band = value_of(gramian(*vector, a, b));
    const int p = band.half_bandwidth(), n = band.size();
    std::vector<double> diagonals(static_cast<std::size_t>(2 * p + 1) *
                                  static_cast<std::size_t>(n));
    std::vector<int> offsets;
    for (int s = -p; s <= p; ++s) {
      const auto diagonal = band.diagonal(s);
      const std::ptrdiff_t row = (s + p) * std::ptrdiff_t(n) + std::max(s, 0);
      std::ranges::copy(diagonal, diagonals.begin() + row);
      offsets.push_back(s);
    }
    return py::make_tuple(view_of_own(std::move(offsets), {2 * p + 1}),
                          view_of_own(std::move(diagonals), {2 * p + 1, n}));
  });
}

}  // namespace knead::python
