#include "dissection.hpp"

#include <Eigen/OrderingMethods>
#include <algorithm>
#include <cassert>
#include <numeric>
#include <span>
#include <utility>

namespace knead {

// Indices of control points, not parameters or lengths: what a separator costs is the number of its
// unknowns. Two patches are `widest` apart in direction 0, and an extent within a net is at most
// `widest` − 1, so that patches are cut apart before any of them is cut.
template <int D>
GridPlaces grid_places(std::span<const Spline<D>> patches) {
  GridPlaces result{1 + D, {}};
  int widest = 1;
  for (const Spline<D>& patch : patches) widest = std::max(widest, std::ranges::max(patch.net()));
  for (std::size_t k = 0; k < patches.size(); ++k) {
    for (int i = 0; i < patches[k].size(); ++i) {
      result.indices.push_back(static_cast<int>(k) * widest);
      int inner = patches[k].size();
      for (const int n : patches[k].net()) {
        inner /= n;
        result.indices.push_back(i / inner % n);
      }
    }
  }
  return result;
}

template GridPlaces grid_places<1>(std::span<const Spline<1>>);
template GridPlaces grid_places<2>(std::span<const Spline<2>>);
template GridPlaces grid_places<3>(std::span<const Spline<3>>);

namespace {

constexpr std::size_t leaf = 64;  // so few unknowns are not divided
// The share of a part before its separator. Where that is in the middle, whatever happens in the
// middle of a net needs most of L; here as little is needed there as anywhere else, and L is as
// small.
constexpr double share_before = 0.38;

// The recursion behind `dissect`. `split` sorts a part along its longest direction, cuts it, and
// makes the separator of all unknowns behind the cut that have an entry of A with one before it.
// What remains behind has then no entry with what is before, whatever the places say: A alone makes
// the order right, and the places only make it good.
//
// The order is: before, behind, separator, each of the first two again so. L_ij is nonzero only
// where a path from j to i exists through unknowns eliminated before both (Rose, Tarjan and Lueker,
// "Algorithmic aspects of vertex elimination on graphs", 1976), and no path from before to behind
// avoids the separator. So fill stays inside the two parts and between each of them and the
// separators behind it. On an n × n net of degree p the first separator has p n unknowns; L has O(N
// log N) entries and takes O(N^1.5) operations for N = n² (George 1973), against O(N^1.5) and O(N²)
// of a band. On volumes they are O(N^(4/3)) and O(N²).
class Dissector {
 public:
  Dissector(const SparseMatrix& a, const GridPlaces& places, int node_size)
      : a_(a),
        places_(places),
        node_size_(std::max(static_cast<std::size_t>(node_size), leaf)),
        side_(static_cast<std::size_t>(a.cols()), Side::none) {
    result_.order.resize(a.cols());
  }

  Dissection run() {
    std::vector<int> all(side_.size());
    std::iota(all.begin(), all.end(), 0);
    divide(all, true);
    return std::move(result_);
  }

 private:
  enum class Side : char { none, before, behind };

  /// Gives places to the unknowns of a part, and returns its last node.
  /// \param is_own it is or has nodes of its own.
  ///
  /// A part of at most `node_size_` unknowns is divided further for the sake of its order, but it
  /// is one node: its children get `is_own` = false and add no nodes. Numbers are given out in
  /// postorder, so that a node's unknowns are adjacent, nodes follow one another, and parents come
  /// last.
  int divide(std::span<int> part, bool is_own) {
    const bool one_node = is_own && part.size() <= node_size_;
    const int begin = next_;
    const int direction = part.size() <= leaf ? -1 : longest(part);
    std::size_t first = 0, second = 0;
    if (direction >= 0) std::tie(first, second) = split(part, direction);
    std::vector<int> children;
    if (second > 0) {
      const bool further = is_own && !one_node;
      children = {divide(part.first(first), further), divide(part.subspan(first, second), further)};
    }
    for (const int i : part.subspan(first + second)) result_.order[i] = next_++;
    if (!is_own) return -1;
    const int from = one_node || children.empty()
                         ? begin
                         : next_ - static_cast<int>(part.size() - first - second);
    const auto node = static_cast<int>(result_.nodes.size());
    result_.nodes.push_back({from, next_, -1});
    for (const int child : children) {
      if (child >= 0) result_.nodes[static_cast<std::size_t>(child)].parent = node;
    }
    return node;
  }

  /// The direction in which a part is longest; −1 if all of it is in one place.
  [[nodiscard]] int longest(std::span<const int> part) const {
    int result = -1, most = 0;
    for (int d = 0; d < places_.directions; ++d) {
      const auto [lower, upper] =
          std::ranges::minmax(part, {}, [&](int i) { return places_.at(i, d); });
      const int extent = places_.at(upper, d) - places_.at(lower, d);
      if (extent <= most) continue;
      most = extent;
      result = d;
    }
    return result;
  }

  /// Reorders a part into what is before a cut, what is behind it and the separator: how many are
  /// before and behind; none where no cut divides it. Cost: O(size log size) and one pass over the
  /// entries of A in the part's columns.
  std::pair<std::size_t, std::size_t> split(std::span<int> part, int direction) {
    std::ranges::sort(part, [&](int i, int j) {
      const int a = places_.at(i, direction), b = places_.at(j, direction);
      return a != b ? a < b : i < j;
    });
    // The first cut says how thick a separator is; the second divides what is left.
    const auto before_of = [](std::size_t count) {
      return static_cast<std::size_t>(share_before * static_cast<double>(count));
    };
    std::size_t cut = cut_near(part, before_of(part.size()), direction);
    const std::size_t thick = mark(part, cut);
    if (cut > 0 && thick < part.size() - cut) {
      const std::size_t other = cut_near(part, before_of(part.size() - thick), direction);
      if (other > 0 && other != cut) mark(part, cut = other);
    }
    const auto is_before = [&](int i) {
      return side_[static_cast<std::size_t>(i)] == Side::before;
    };
    const auto is_behind = [&](int i) {
      return side_[static_cast<std::size_t>(i)] == Side::behind;
    };
    const auto rest = std::stable_partition(part.begin(), part.end(), is_before);
    const auto separator = std::stable_partition(rest, part.end(), is_behind);
    for (const int i : part) side_[static_cast<std::size_t>(i)] = Side::none;
    const auto first = static_cast<std::size_t>(rest - part.begin());
    const auto second = static_cast<std::size_t>(separator - rest);
    if (first == 0 || second == 0) {
      std::ranges::sort(part);
      return {0, 0};
    }
    // Back to the order of the unknowns, which on a net is a band: leaves keep it.
    std::ranges::sort(part.first(first));
    std::ranges::sort(part.subspan(first, second));
    order_separator(part.subspan(first + second), direction);
    return {first, second};
  }

  /// How many unknowns of a sorted part are before the place of number `at`; those before the place
  /// behind it if none.
  ///
  /// A cut never divides unknowns of one place: they depend on the same others, and would all be in
  /// the separator anyway.
  [[nodiscard]] std::size_t cut_near(std::span<const int> part, std::size_t at,
                                     int direction) const {
    const int place = places_.at(part[at], direction);
    const auto of = [&](int i) { return places_.at(i, direction); };
    const auto lower = std::ranges::lower_bound(part, place, {}, of) - part.begin();
    if (lower > 0) return static_cast<std::size_t>(lower);
    return static_cast<std::size_t>(std::ranges::upper_bound(part, place, {}, of) - part.begin());
  }

  /// Marks the sides of the first `cut` unknowns and of the others, and leaves out those of the
  /// others that depend on the first, whose number is returned.
  ///
  /// The separator comes from the side behind only. That suffices to part the two, and is half of
  /// what the unknowns on both sides of the cut would be. Unknowns of other parts are `none` here:
  /// they belong to separators behind this part, or to parts that no entry joins to it.
  std::size_t mark(std::span<const int> part, std::size_t cut) {
    for (std::size_t k = 0; k < part.size(); ++k)
      side_[static_cast<std::size_t>(part[k])] = k < cut ? Side::before : Side::behind;
    std::size_t count = 0;
    for (const int i : part.subspan(cut)) {
      bool touches = false;
      for (SparseMatrix::InnerIterator it(a_, i); it && !touches; ++it) {
        touches = side_[static_cast<std::size_t>(it.index())] == Side::before;
      }
      if (!touches) continue;
      separator_.push_back(i);
      ++count;
    }
    for (const int i : separator_) side_[static_cast<std::size_t>(i)] = Side::none;
    separator_.clear();
    return count;
  }

  /// Along its longest direction, as a band.
  ///
  /// A separator's own block of L is nearly full, so that its order changes the number of entries
  /// little. Along it neighbours have mostly the same rows, which makes wide panels (`Panels`).
  void order_separator(std::span<int> part, int across) const {
    int along = across, most = -1;
    for (int d = 0; d < places_.directions && !part.empty(); ++d) {
      const auto [lower, upper] =
          std::ranges::minmax(part, {}, [&](int i) { return places_.at(i, d); });
      const int extent = places_.at(upper, d) - places_.at(lower, d);
      if (d == across || extent <= most) continue;
      most = extent;
      along = d;
    }
    std::ranges::sort(part, [&](int i, int j) {
      const int a = places_.at(i, along), b = places_.at(j, along);
      return a != b ? a < b : i < j;
    });
  }

  const SparseMatrix& a_;
  const GridPlaces& places_;
  std::size_t node_size_;
  std::vector<Side> side_;
  std::vector<int> separator_;
  int next_ = 0;
  Dissection result_;
};

}  // namespace

Dissection dissect(const SparseMatrix& a, const GridPlaces& places, int node_size) {
  assert(static_cast<std::size_t>(a.cols()) * static_cast<std::size_t>(places.directions) ==
         places.indices.size());
  return Dissector(a, places, node_size).run();
}

Dissection minimum_degree(const SparseMatrix& a) {
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> inverse;
  Eigen::AMDOrdering<int>()(a, inverse);
  return {inverse.inverse().eval().indices(), {}};
}

}  // namespace knead
