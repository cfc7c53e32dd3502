#include <algorithm>
#include <cassert>

#include "base/parallel_for.hpp"
#include "knead/energy/stiffness.hpp"
#include "simd/tensor_kernels.hpp"

namespace knead {

const detail::TensorKernels& detail::tensor_kernels(InstructionSet set) {
  if (avx512_tensor_kernels != nullptr && set >= InstructionSet::avx512) return *avx512_tensor_kernels;
  if (avx2_tensor_kernels != nullptr && set >= InstructionSet::avx2) return *avx2_tensor_kernels;
  return *vector128_tensor_kernels;
}

namespace {

constexpr std::ptrdiff_t per_point = 3;  // coordinates

/// Numbers whose vectors do not straddle cache lines.
using Aligned = std::vector<double, CacheLineAllocator<double>>;

/// A band matrix as its diagonals, every entry once per coordinate, for vectors of points.
struct PointBand {
  int half_bandwidth;
  std::ptrdiff_t length;  // of a diagonal: all points' coordinates, zeros outside the matrix
  Aligned diagonals;

  PointBand(int size, int p)
      : half_bandwidth(p), length(per_point * size), diagonals(static_cast<std::size_t>((2 * p + 1) * length), 0.0) {}

  void add(double factor, const BandMatrix& matrix) {
    for (int s = -half_bandwidth; s <= half_bandwidth; ++s) {
      double* to = diagonals.data() + (s + half_bandwidth) * length + per_point * std::max(0, -s);
      for (const double entry : matrix.diagonal(s)) {
        for (std::ptrdiff_t c = 0; c < per_point; ++c) *to++ += factor * entry;
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
      : kernels_(detail::tensor_kernels()), net_(net), margin_(in_vectors(per_point * p)) {
    std::ptrdiff_t slab = per_point;
    inner_.resize(net.size());
    for (std::size_t d = net.size(); d-- > 0;) {
      inner_[d] = slab;
      slab *= net[d];
    }
    line_ = in_vectors(per_point * net.back() + 2 * margin_);
    padded_.resize(static_cast<std::size_t>(line_), 0.0);
  }

  /// y = the product of x by the nodes of the first direction, at its indices begin … end − 1; at all where it is the
  /// only one.
  void part(const std::vector<Node>& nodes, int begin, int end, const double* x, double* y) {
    add(0, nodes, begin, end, x, true, y);
  }

 private:
  /// The same of one slab x of direction d, added to y unless that is to be taken for zero.
  void add(std::size_t d, const std::vector<Node>& nodes, int begin, int end, const double* x, bool from_zero,
           double* y) {
    if (d + 1 == net_.size()) {
      std::copy_n(x, per_point * net_[d], padded_.data() + margin_);
      bands_.assign(1, nodes.front().band.front().diagonals.data());
      return add_lines(nodes.front().band.front(), 0, 1, from_zero, y);
    }
    if (d + 2 == net_.size()) return add_by_lines(nodes, d, begin, end, x, from_zero, y);
    const std::ptrdiff_t inner = inner_[d];
    Aligned slab(static_cast<std::size_t>(inner));
    std::vector<double> factors;
    for (int i = begin; i < end; ++i) {
      for (const Node& node : nodes) {
        const int p = node.matrix->half_bandwidth(), first = std::max(0, i - p), stop = std::min(net_[d], i + p + 1);
        factors.clear();
        for (int j = first; j < stop; ++j) factors.push_back((*node.matrix)(i, j));
        kernels_.combine(x + first * inner, inner, factors.data(), 1, stop - first, inner, slab.data(), 0);
        add(d + 1, node.next, 0, net_[d + 1], slab.data(), from_zero && &node == &nodes.front(), y + i * inner);
      }
    }
  }

  /// Rounded up, so that what follows is as aligned as what goes before.
  static std::ptrdiff_t in_vectors(std::ptrdiff_t count) { return (count + 7) / 8 * 8; }

  /// The same for the last direction but one, some lines at a time: each is combined by all nodes at once, and each
  /// node's band is read once for all of them.
  void add_by_lines(const std::vector<Node>& nodes, std::size_t d, int begin, int end, const double* x, bool from_zero,
                    double* y) {
    constexpr auto most = static_cast<int>(detail::TensorKernels::lines_at_once);
    const std::ptrdiff_t inner = inner_[d], node_stride = most * line_;
    const auto kinds = static_cast<std::ptrdiff_t>(nodes.size());
    padded_.resize(std::max(padded_.size(), static_cast<std::size_t>(kinds * node_stride)), 0.0);
    bands_.clear();
    for (const Node& node : nodes) bands_.push_back(node.next.front().band.front().diagonals.data());
    const int p = nodes.front().matrix->half_bandwidth();
    std::vector<double> factors;
    for (; begin < end; begin += most) {
      const int lines = std::min(most, end - begin);
      for (int i = begin; i < begin + lines; ++i) {
        const int first = std::max(0, i - p), stop = std::min(net_[d], i + p + 1);
        factors.clear();
        for (int j = first; j < stop; ++j) {
          for (const Node& node : nodes) factors.push_back((*node.matrix)(i, j));
        }
        kernels_.combine(x + first * inner, inner, factors.data(), kinds, stop - first, inner,
                         padded_.data() + (i - begin) * line_ + margin_, node_stride);
      }
      add_lines(nodes.front().next.front().band.front(), node_stride, lines, from_zero, y + begin * inner);
    }
  }
  /// The products of `bands_`, all of the shape of one, with lines that have zeros before and behind, those of the next
  /// one further by node_stride.
  void add_lines(const PointBand& shape, std::ptrdiff_t node_stride, int lines, bool from_zero, double* y) {
    kernels_.add_bands(bands_.data(), std::ssize(bands_), shape.length, 2 * shape.half_bandwidth + 1, per_point,
                       shape.length, padded_.data() + margin_ - per_point * shape.half_bandwidth, node_stride, line_,
                       lines, from_zero, y, shape.length);
  }

  const detail::TensorKernels& kernels_;
  std::span<const int> net_;
  std::vector<std::ptrdiff_t> inner_;  // numbers per index of a direction
  std::ptrdiff_t margin_, line_;       // zeros before and behind the points of a line, and all of it
  Aligned padded_;                     // lines
  std::vector<const double*> bands_;   // of the nodes at work
};

/// y = the product of x by all nodes, by several threads where the net is large.
void find_product(const std::vector<TensorProduct::Node>& root, std::span<const int> net, int degree, const double* x,
                  double* y) {
  double work = 0;  // of a slab of the first direction, which is not divided where it is the only one
  if (net.size() > 1) {
    work = static_cast<double>(per_point * 2 * (2 * degree + 1)) * static_cast<double>(root.size());
    for (const int count : net.subspan(1)) work *= count;
  }
  const std::ptrdiff_t step = detail::TensorKernels::lines_at_once;
  detail::parallel_for(net[0], detail::block_size(net[0], work, step), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    TensorProduct(net, degree).part(root, static_cast<int>(begin), static_cast<int>(end), x, y);
  });
}

}  // namespace

template <int D>
Points Stiffness<D>::apply(const Points& x) const {
  assert(x.rows() == size_);
  if (assembled_) return symmetric_product(*assembled_, x);
  constexpr std::size_t last = D - 1;
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
  if (root.empty()) return Points::Zero(size_, 3);
  Points sum(size_, 3);
  const Aligned from(x.data(), x.data() + x.size());
  find_product(root, net_, degree_[last], from.data(), sum.data());
  return sum;
}

template Points Stiffness<1>::apply(const Points&) const;
template Points Stiffness<2>::apply(const Points&) const;
template Points Stiffness<3>::apply(const Points&) const;

}  // namespace knead
