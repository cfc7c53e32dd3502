#include <algorithm>
#include <cassert>

#include "knead/energy/stiffness.hpp"
#include "simd/tensor_kernels.hpp"

namespace knead {

const detail::TensorKernels& detail::tensor_kernels(InstructionSet set) {
  if (avx512_tensor_kernels != nullptr && set >= InstructionSet::avx512) return *avx512_tensor_kernels;
  if (avx2_tensor_kernels != nullptr && set >= InstructionSet::avx2) return *avx2_tensor_kernels;
  return *vector128_tensor_kernels;
}

namespace {

constexpr std::ptrdiff_t coordinates = 3;

/// Numbers whose vectors do not straddle cache lines.
using Aligned = std::vector<double, CacheLineAllocator<double>>;

/// A band matrix as its diagonals, every entry once per coordinate, for vectors of points.
struct PointBand {
  int half_bandwidth;
  std::ptrdiff_t length;  // of a diagonal: all points' coordinates, zeros outside the matrix
  Aligned diagonals;

  PointBand(int size, int p)
      : half_bandwidth(p), length(coordinates * size), diagonals(static_cast<std::size_t>((2 * p + 1) * length), 0.0) {}

  void add(double factor, const BandMatrix& matrix) {
    for (int s = -half_bandwidth; s <= half_bandwidth; ++s) {
      double* to = diagonals.data() + (s + half_bandwidth) * length + coordinates * std::max(0, -s);
      for (const double entry : matrix.diagonal(s)) {
        for (std::ptrdiff_t c = 0; c < coordinates; ++c) *to++ += factor * entry;
      }
    }
  }
};

/// Σ G_f0 ⊗ … ⊗ M over the distinct factors of all directions but the last, whose factors are summed up: the product of
/// a slab of the net is made of combined slabs of one direction less.
class TensorProduct {
 public:
  struct Node {
    const BandMatrix* matrix = nullptr;  // of this direction, unless it is the last
    std::vector<Node> next;              // of the following direction
    std::vector<PointBand> band;         // one, in the last direction
  };

  /// \param p the degree of the last direction.
  TensorProduct(std::span<const int> net, int p)
      : kernels_(detail::tensor_kernels()), net_(net), margin_(in_vectors(coordinates * p)) {
    std::ptrdiff_t slab = coordinates;
    inner_.resize(net.size());
    for (std::size_t d = net.size(); d-- > 0;) {
      inner_[d] = slab;
      slab *= net[d];
    }
    line_ = in_vectors(coordinates * net.back() + 2 * margin_);
    padded_.resize(static_cast<std::size_t>(line_), 0.0);
  }

  /// y += the product of one slab x of direction d by the nodes of that direction.
  void add(std::size_t d, const std::vector<Node>& nodes, const double* x, double* y) {
    if (d + 1 == net_.size()) {
      std::copy_n(x, coordinates * net_[d], padded_.data() + margin_);
      return add_lines(nodes.front().band.front(), padded_.data(), 1, y);
    }
    if (d + 2 == net_.size()) return add_by_lines(nodes, d, x, y);
    const std::ptrdiff_t inner = inner_[d];
    Aligned slab(static_cast<std::size_t>(inner));
    std::vector<double> factors;
    for (int i = 0; i < net_[d]; ++i) {
      for (const Node& node : nodes) {
        const int p = node.matrix->half_bandwidth(), first = std::max(0, i - p), end = std::min(net_[d], i + p + 1);
        factors.clear();
        for (int j = first; j < end; ++j) factors.push_back((*node.matrix)(i, j));
        kernels_.combine(x + first * inner, inner, factors.data(), 1, end - first, inner, slab.data(), 0);
        add(d + 1, node.next, slab.data(), y + i * inner);
      }
    }
  }

 private:
  /// Rounded up, so that what follows is as aligned as what goes before.
  static std::ptrdiff_t in_vectors(std::ptrdiff_t count) { return (count + 7) / 8 * 8; }

  /// The same for the last direction but one, some lines at a time: each is combined by all nodes at once, and each
  /// node's band is read once for all of them.
  void add_by_lines(const std::vector<Node>& nodes, std::size_t d, const double* x, double* y) {
    constexpr auto most = static_cast<int>(detail::TensorKernels::lines_at_once);
    const std::ptrdiff_t inner = inner_[d], node_stride = most * line_;
    const auto kinds = static_cast<std::ptrdiff_t>(nodes.size());
    padded_.resize(std::max(padded_.size(), static_cast<std::size_t>(kinds * node_stride)), 0.0);
    const int p = nodes.front().matrix->half_bandwidth();
    std::vector<double> factors;
    for (int begin = 0; begin < net_[d]; begin += most) {
      const int lines = std::min(most, net_[d] - begin);
      for (int i = begin; i < begin + lines; ++i) {
        const int first = std::max(0, i - p), end = std::min(net_[d], i + p + 1);
        factors.clear();
        for (int j = first; j < end; ++j) {
          for (const Node& node : nodes) factors.push_back((*node.matrix)(i, j));
        }
        kernels_.combine(x + first * inner, inner, factors.data(), kinds, end - first, inner,
                         padded_.data() + (i - begin) * line_ + margin_, node_stride);
      }
      for (std::ptrdiff_t g = 0; g < kinds; ++g) {
        add_lines(nodes[static_cast<std::size_t>(g)].next.front().band.front(), padded_.data() + g * node_stride, lines,
                  y + begin * inner);
      }
    }
  }
  /// Of lines with zeros before and behind.
  void add_lines(const PointBand& band, const double* x, int lines, double* y) {
    kernels_.add_band(band.diagonals.data(), band.length, 2 * band.half_bandwidth + 1, coordinates, band.length,
                      x + margin_ - coordinates * band.half_bandwidth, line_, lines, y, band.length);
  }

  const detail::TensorKernels& kernels_;
  std::span<const int> net_;
  std::vector<std::ptrdiff_t> inner_;  // numbers per index of a direction
  std::ptrdiff_t margin_, line_;       // zeros before and behind the points of a line, and all of it
  Aligned padded_;                     // lines
};

}  // namespace

template <int D>
Points Stiffness<D>::apply(const Points& x) const {
  assert(x.rows() == size_);
  if (assembled_) return symmetric_product(*assembled_, x);
  constexpr std::size_t last = D - 1;
  TensorProduct product(net_, degree_[last]);
  std::vector<TensorProduct::Node> root;
  for (const Term& term : terms_) {
    std::vector<TensorProduct::Node>* nodes = &root;
    for (std::size_t d = 0; d < last; ++d) {
      const BandMatrix* matrix = &factors_[d][static_cast<std::size_t>(term.factor[d])];
      auto found = std::ranges::find(*nodes, matrix, &TensorProduct::Node::matrix);
      if (found == nodes->end()) found = nodes->insert(nodes->end(), {matrix, {}, {}});
      nodes = &found->next;
    }
    if (nodes->empty()) nodes->push_back({nullptr, {}, {PointBand(net_[last], degree_[last])}});
    nodes->front().band.front().add(term.coefficient, factors_[last][static_cast<std::size_t>(term.factor[last])]);
  }
  Points sum = Points::Zero(size_, 3);
  const Aligned from(x.data(), x.data() + x.size());
  if (!root.empty()) product.add(0, root, from.data(), sum.data());
  return sum;
}

template Points Stiffness<1>::apply(const Points&) const;
template Points Stiffness<2>::apply(const Points&) const;
template Points Stiffness<3>::apply(const Points&) const;

}  // namespace knead
