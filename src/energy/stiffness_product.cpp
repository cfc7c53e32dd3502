#include <algorithm>
#include <cassert>

#include "base/parallel_for.hpp"
#include "knead/energy/stiffness.hpp"
#include "simd/tensor_kernels.hpp"

namespace knead {

const detail::TensorKernels& detail::tensor_kernels(InstructionSet set) {
  if (avx512_tensor_kernels != nullptr && set >= InstructionSet::avx512)
    return *avx512_tensor_kernels;
  if (avx2_tensor_kernels != nullptr && set >= InstructionSet::avx2) return *avx2_tensor_kernels;
  return *vector128_tensor_kernels;
}

namespace {

constexpr std::ptrdiff_t per_point = 3;  // coordinates

/// Leaves what is not given a value as it is.
struct UnsetAllocator : CacheLineAllocator<double> {
  template <class T>
  struct rebind {
    using other = UnsetAllocator;
  };
  void construct(double* p) noexcept { ::new (p) double; }
  void construct(double* p, const double& value) noexcept { *p = value; }
};

/// Numbers whose vectors do not straddle cache lines.
using Aligned = std::vector<double, UnsetAllocator>;

/// How lines of points lie for the kernels: in segments, one per number of a vector, the last ones
/// with zeros behind.
/// K x for K = Σ_t c_t A_t ⊗ B_t (⊗ C_t), without K: with k distinct factors in the first direction
/// it takes k (2p + 1) + k (2q + 1) multiplications a coordinate and control point, where the
/// assembled matrix has (2p + 1)(2q + 1) and must be read from memory. Terms with the same first
/// factor share its product, as nodes of a tree, and their last factors are summed before.
/// A line of the last direction is cut into as many segments as a vector has numbers, and number l
/// of vectors belongs to segment l: a band matrix then moves whole vectors, and only the ends of
/// segments are exchanged (`surround`).
struct Segments {
  const detail::TensorKernels* kernels;
  std::ptrdiff_t size, points,
      line;  // points of a line and of a segment; numbers of a line with its zeros

  explicit Segments(int count)
      : kernels(&detail::tensor_kernels()),
        size(count),
        points((count + kernels->lanes - 1) / kernels->lanes),
        line(points * per_point * kernels->lanes) {}

  void read(const double* x, std::ptrdiff_t lines, double* to) const {
    const bool cut = per_point * size < line;
    Aligned whole(static_cast<std::size_t>(cut ? line : 0), 0.0);
    for (; lines > 0; --lines, x += per_point * size, to += line) {
      if (cut) std::copy_n(x, per_point * size, whole.data());
      kernels->to_segments(cut ? whole.data() : x, per_point * points, to);
    }
  }
  void write(const double* from, std::ptrdiff_t lines, double* y) const {
    const bool cut = per_point * size < line;
    Aligned whole(static_cast<std::size_t>(cut ? line : 0));
    for (; lines > 0; --lines, from += line, y += per_point * size) {
      kernels->from_segments(from, per_point * points, cut ? whole.data() : y);
      if (cut) std::copy_n(whole.data(), per_point * size, y);
    }
  }
};

/// A band matrix as `TensorKernels::add_bands` reads it, zeros outside the matrix.
struct SegmentBand {
  int half_bandwidth;
  std::ptrdiff_t points, lanes;
  Aligned entries;

  SegmentBand(const Segments& segments, int p)
      : half_bandwidth(p),
        points(segments.points),
        lanes(segments.kernels->lanes),
        entries(static_cast<std::size_t>((2 * p + 1) * points * lanes), 0.0) {}

  void add(double factor, const BandMatrix& matrix) {
    const std::ptrdiff_t width = 2 * half_bandwidth + 1;
    for (int s = -half_bandwidth; s <= half_bandwidth; ++s) {
      std::ptrdiff_t row = std::max(0, -s), lane = row / points, i = row % points;
      for (const double entry : matrix.diagonal(s)) {
        entries[static_cast<std::size_t>((i * width + s + half_bandwidth) * lanes + lane)] +=
            factor * entry;
        if (++i == points) {
          i = 0;
          ++lane;
        }
      }
    }
  }
};

/// Σ G_f0 ⊗ … ⊗ M over the distinct factors of all directions but the last, whose factors are
/// summed up: the product of a slab of the net is made of combined slabs of one direction less.
class TensorProduct {
 public:
  struct Node {
    const BandMatrix* matrix = nullptr;  // of this direction, unless it is the last
    std::vector<Node> next;              // of the following direction
    std::vector<SegmentBand> band;       // one, in the last direction
  };

  /// \param p the degree of the last direction.
  TensorProduct(std::span<const int> net, const Segments& segments, int p)
      : kernels_(*segments.kernels),
        net_(net),
        segments_(segments),
        margin_(per_point * p * kernels_.lanes) {
    inner_.resize(net.size());
    std::ptrdiff_t slab = segments.line;
    for (std::size_t d = net.size() - 1; d-- > 0;) {
      inner_[d] = slab;
      slab *= net[d];
    }
    padded_line_ = segments.line + 2 * margin_;
  }

  /// y = the product of x by the nodes of the first direction, at its indices begin … end − 1; at
  /// all where it is the only one.
  void part(const std::vector<Node>& nodes, int begin, int end, const double* x, double* y) {
    const bool one_line = net_.size() == 1;
    const int most = net_.size() == 2 ? lines_at_once : 1, count = one_line ? 1 : net_[0];
    const int p = one_line ? 0 : nodes.front().matrix->half_bandwidth();
    const std::ptrdiff_t inner = one_line ? segments_.line : inner_[0],
                         lines = inner / segments_.line;
    const std::ptrdiff_t numbers = lines * per_point * segments_.size;  // of x and y for each index
    const int room = std::min(count, window_size * (2 * p + most));
    Aligned window(static_cast<std::size_t>(room * inner)),
        result(static_cast<std::size_t>(most * inner));
    int first = std::max(0, begin - p), known = first;  // indices in the window
    for (int i = one_line ? 0 : begin; i < (one_line ? 1 : end); i += most) {
      const int stop = std::min(i + most, end), needed = std::min(count, stop + p);
      if (needed - first > room) {
        const int kept = std::max(0, i - p);
        std::copy(window.data() + (kept - first) * inner, window.data() + (known - first) * inner,
                  window.data());
        first = kept;
      }
      segments_.read(x + known * numbers, (needed - known) * lines,
                     window.data() + (known - first) * inner);
      known = needed;
      ask_for(x + known * numbers, (std::min(count, known + most) - known) * numbers);
      ask_for(y + i * numbers, one_line ? 0 : (stop - i) * numbers);
      add(0, nodes, i, stop, window.data(), first, true, result.data());
      segments_.write(result.data(), (one_line ? 1 : stop - i) * lines, y + i * numbers);
    }
  }

  static constexpr auto lines_at_once = static_cast<int>(detail::TensorKernels::lines_at_once);
  // Of x at a time in segments, as multiples of what a step needs.
  static constexpr int window_size = 3;

 private:
  /// Has numbers brought near while others are worked on.
  static void ask_for(const double* numbers, std::ptrdiff_t count) {
    for (std::ptrdiff_t k = 0; k < count; k += 8) __builtin_prefetch(numbers + k, 0, 2);
  }

  /// The same of one slab x of direction d, whose first index is given, added to y unless that is
  /// to be taken for zero; y begins at index begin. Lines lie in segments.
  void add(std::size_t d, const std::vector<Node>& nodes, int begin, int end, const double* x,
           int x_first, bool from_zero, double* y) {
    if (d + 1 == net_.size()) {
      const SegmentBand& band = nodes.front().band.front();
      make_room(1);
      std::copy_n(x, segments_.line, padded_.data() + margin_);
      bands_.assign(1, band.entries.data());
      return add_lines(band, 1, from_zero, y);
    }
    if (d + 2 == net_.size()) return add_by_lines(nodes, d, begin, end, x, x_first, from_zero, y);
    const std::ptrdiff_t inner = inner_[d];
    Aligned slab(static_cast<std::size_t>(inner));
    std::vector<double> factors;
    for (int i = begin; i < end; ++i) {
      for (const Node& node : nodes) {
        const int p = node.matrix->half_bandwidth(), first = std::max(0, i - p),
                  stop = std::min(net_[d], i + p + 1);
        factors.clear();
        for (int j = first; j < stop; ++j) factors.push_back((*node.matrix)(i, j));
        kernels_.combine(x + (first - x_first) * inner, inner, factors.data(), 1, stop - first,
                         inner, slab.data(), 0);
        add(d + 1, node.next, 0, net_[d + 1], slab.data(), 0, from_zero && &node == &nodes.front(),
            y + (i - begin) * inner);
      }
    }
  }

  /// The same for the last direction but one, some lines at a time: each is combined by all nodes
  /// at once, and each node's band is read once for all of them.
  void add_by_lines(const std::vector<Node>& nodes, std::size_t d, int begin, int end,
                    const double* x, int x_first, bool from_zero, double* y) {
    const std::ptrdiff_t inner = inner_[d], node_stride = lines_at_once * padded_line_;
    const auto kinds = static_cast<std::ptrdiff_t>(nodes.size());
    make_room(kinds);
    const int p = nodes.front().matrix->half_bandwidth();
    if (known_ != &nodes) look_up(nodes);
    for (; begin < end; begin += lines_at_once, y += lines_at_once * inner) {
      const int lines = std::min(lines_at_once, end - begin);
      for (int i = begin; i < begin + lines; ++i) {
        const int first = std::max(0, i - p), stop = std::min(net_[d], i + p + 1);
        double* factor = factors_.data();
        const double* const* diagonal = diagonals_.data() + (first - i + p) * kinds;
        for (int j = first; j < stop; ++j) {
          for (std::ptrdiff_t g = 0; g < kinds; ++g) *factor++ = (*diagonal++)[std::min(i, j)];
        }
        kernels_.combine(x + (first - x_first) * inner, inner, factors_.data(), kinds, stop - first,
                         inner, padded_.data() + (i - begin) * padded_line_ + margin_, node_stride);
      }
      add_lines(nodes.front().next.front().band.front(), lines, from_zero, y);
    }
  }

  /// What `add_by_lines` reads of its nodes for every line.
  void look_up(const std::vector<Node>& nodes) {
    known_ = &nodes;
    bands_.clear();
    diagonals_.clear();
    for (const Node& node : nodes) bands_.push_back(node.next.front().band.front().entries.data());
    const int p = nodes.front().matrix->half_bandwidth();
    for (int s = -p; s <= p; ++s) {
      for (const Node& node : nodes)
        diagonals_.push_back(std::as_const(*node.matrix).diagonal(s).data());
    }
    factors_.resize(diagonals_.size());
  }

  /// For so many lines of each of so many kinds.
  void make_room(std::ptrdiff_t kinds) {
    const auto numbers = static_cast<std::size_t>(kinds * lines_at_once * padded_line_);
    if (padded_.size() < numbers) padded_.resize(numbers);
  }

  /// The products of `bands_`, all of the shape of one, with the lines in `padded_`.
  void add_lines(const SegmentBand& shape, std::ptrdiff_t lines, bool from_zero, double* y) {
    const std::ptrdiff_t node_stride = lines_at_once * padded_line_;
    double* const from = padded_.data() + margin_;
    for (std::ptrdiff_t g = 0; g < std::ssize(bands_); ++g) {
      for (std::ptrdiff_t l = 0; l < lines; ++l) {
        kernels_.surround(from + g * node_stride + l * padded_line_, shape.points,
                          shape.half_bandwidth);
      }
    }
    kernels_.add_bands(bands_.data(), std::ssize(bands_), shape.half_bandwidth, shape.points, from,
                       node_stride, padded_line_, lines, from_zero, y, segments_.line);
  }

  const detail::TensorKernels& kernels_;
  std::span<const int> net_;
  const Segments& segments_;
  std::vector<std::ptrdiff_t> inner_;  // numbers per index of a direction, but the last
  std::ptrdiff_t margin_,
      padded_line_;  // numbers before and behind the points of a line, and all of it
  Aligned padded_;   // lines
  const std::vector<Node>* known_ = nullptr;  // the nodes at work
  std::vector<const double*> bands_;          // theirs
  std::vector<const double*> diagonals_;      // of their matrices, side by side
  std::vector<double> factors_;               // of one line
};

/// y = the product of x by all nodes, by several threads where the net is large.
void find_product(const std::vector<TensorProduct::Node>& root, std::span<const int> net,
                  const Segments& segments, int degree, const double* x, double* y) {
  // Of a slab of the first direction, which is not divided where it is the only one.
  double work = 0;
  if (net.size() > 1) {
    work = static_cast<double>(per_point * 2 * (2 * degree + 1)) * static_cast<double>(root.size());
    for (const int count : net.subspan(1)) work *= count;
  }
  const std::ptrdiff_t step = TensorProduct::lines_at_once;
  detail::parallel_for(net[0], detail::block_size(net[0], work, step),
                       [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                         TensorProduct(net, segments, degree)
                             .part(root, static_cast<int>(begin), static_cast<int>(end), x, y);
                       });
}

}  // namespace

template <int D>
Points Stiffness<D>::apply(const Points& x) const {
  assert(x.rows() == size_);
  if (assembled_) return symmetric_product(*assembled_, x);
  constexpr std::size_t last = D - 1;
  const Segments segments(net_[last]);
  std::vector<TensorProduct::Node> root;
  for (const Term& term : terms_) {
    std::vector<TensorProduct::Node>* nodes = &root;
    for (std::size_t d = 0; d < last; ++d) {
      const BandMatrix* matrix = &factors_[d][static_cast<std::size_t>(term.factor[d])];
      auto found = std::ranges::find(*nodes, matrix, &TensorProduct::Node::matrix);
      if (found == nodes->end()) found = nodes->insert(nodes->end(), {matrix, {}, {}});
      nodes = &found->next;
    }
    if (nodes->empty()) nodes->push_back({nullptr, {}, {SegmentBand(segments, degree_[last])}});
    nodes->front().band.front().add(term.coefficient,
                                    factors_[last][static_cast<std::size_t>(term.factor[last])]);
  }
  if (root.empty()) return Points::Zero(size_, 3);
  Points sum(size_, 3);
  find_product(root, net_, segments, degree_[last], x.data(), sum.data());
  return sum;
}

template Points Stiffness<1>::apply(const Points&) const;
template Points Stiffness<2>::apply(const Points&) const;
template Points Stiffness<3>::apply(const Points&) const;

}  // namespace knead
