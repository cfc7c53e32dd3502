#include "edge_meetings.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <span>
#include <utility>

#include "base/parallel_for.hpp"
#include "spline/box_tree.hpp"

namespace knead::brep {
namespace {

constexpr int least_steps = 32, bisections = 48, most_changes = 4;
constexpr double chord_share = 1e-3;   // of the extent of a curve
constexpr double beside = 0.9;         // |cos| of the angle between edges that run along each other
constexpr double least_length = 1e-3;  // of the edge
constexpr double least_reaches = 10;
constexpr double nearly_farthest = 0.9;
constexpr double hardly = 0.5;  // of reach

/// What of the other edges is nearest to a point of one.
struct Partner {
  std::size_t of = std::numeric_limits<std::size_t>::max();  ///< a loose edge by number; none
  bool same_way = true;
  double distance = std::numeric_limits<double>::infinity();
  bool several = false;  ///< others are within reach there too

  [[nodiscard]] bool is_same(const Partner& p) const { return of == p.of; }
};

class MeetingFinder {
 public:
  MeetingFinder(const std::vector<LooseEdge>& edges, double reach, double parted)
      : edges_(edges), reach_(reach), farthest_(parted * reach) {
    std::vector<Eigen::AlignedBox3d> boxes;
    parameters_.resize(edges.size());
    for (std::size_t k = 0; k < edges.size(); ++k) {
      parameters_[k] = divided(*edges[k].piece);
      const EdgeCurve& curve = edges[k].piece->curve;
      for (std::size_t s = 0; s + 1 < parameters_[k].size(); ++s) {
        const Segment segment{k, curve.at(parameters_[k][s]), curve.at(parameters_[k][s + 1]),
                              s == 0, s + 2 == parameters_[k].size()};
        if (!segment.a.allFinite() || !segment.b.allFinite()) continue;
        segments_.push_back(segment);
        boxes.emplace_back(segment.a.cwiseMin(segment.b), segment.a.cwiseMax(segment.b));
      }
    }
    tree_ = BoxTree(boxes);
  }

  std::vector<EdgeMeeting> parts(std::size_t k) const {
    const EdgePiece& piece = *edges_[k].piece;
    std::vector<std::pair<double, Partner>> samples;
    std::vector<double> at = parameters_[k];
    // Ends are where others end too: there the nearest is decided by rounding.
    const double inwards = 1e-6 * (piece.to - piece.from);
    at.front() += inwards;
    at.back() -= inwards;
    for (const double t : at) {
      const Partner here = partner(k, t, samples.empty() ? Partner{} : samples.back().second);
      // Between two partners there may be others, or none: the ends of those that meet in a point
      // do not quite.
      for (int n = 0; n < most_changes && !samples.empty(); ++n) {
        if (here.is_same(samples.back().second)) break;
        const auto [last, next] = change(k, samples.back().first, t, samples.back().second);
        samples.emplace_back(last, partner(k, last, samples.back().second));
        samples.emplace_back(next, partner(k, next, here));
      }
      samples.emplace_back(t, here);
    }
    std::vector<std::pair<double, Partner>> ends;  // where a part begins, and its partner
    for (std::size_t s = 0; s < samples.size();) {
      std::size_t end = s + 1;
      while (end < samples.size() && samples[end].second.is_same(samples[s].second)) ++end;
      add_run(k, std::span(samples).subspan(s, end - s), s == 0, end == samples.size(), ends);
      s = end;
    }
    ends.front().first = piece.from;
    return without_short(k, ends);
  }

 private:
  struct Segment {
    std::size_t of = 0;
    Point a, b;
    bool first = false, last = false;  ///< of its edge
  };

  std::vector<double> divided(const EdgePiece& piece) const {
    std::vector<double> all =
        piece.curve.subdivided(piece.from, piece.to, {chord_share, reach_ / 4});
    for (int k = 0; k <= least_steps; ++k)
      all.push_back(std::lerp(piece.from, piece.to, static_cast<double>(k) / least_steps));
    std::ranges::sort(all);
    const double near = 1e-9 * (piece.to - piece.from);
    std::vector<double> apart;
    for (const double t : all) {
      if (apart.empty() || t - apart.back() > near) apart.push_back(t);
    }
    return apart;
  }

  /// The nearest of the edges whose nearest point is not an end that p lies beyond; `before`, the
  /// partner of a point beside it, as long as it is hardly farther: of edges that coincide rounding
  /// would decide.
  Partner partner(std::size_t k, double t, const Partner& before) const {
    const EdgeCurve& curve = edges_[k].piece->curve;
    const Point p = curve.at(t), tangent = curve.derivative(t).normalized();
    struct Nearest : Partner {
      bool beside = false;
    };
    std::vector<Nearest> others;
    tree_.meeting({p.array() - farthest_, p.array() + farthest_}, [&](std::uint32_t s) {
      const auto& [of, a, b, first, last] = segments_[s];
      if (of == k || edges_[of].part != edges_[k].part) return;
      const Point along = b - a;
      const double length = along.norm(), cosine = along.dot(tangent) / length;
      if (!(length > 0)) return;
      const double foot = (p - a).dot(along) / (length * length);
      const double distance = (a + std::clamp(foot, 0.0, 1.0) * along - p).norm();
      if (distance > farthest_) return;
      const bool ended = (first && foot < 0) || (last && foot > 1);
      const Nearest here{{of, cosine > 0, distance}, !ended && std::abs(cosine) > beside};
      const auto known = std::ranges::find(others, of, &Nearest::of);
      if (known == others.end()) {
        others.push_back(here);
      } else if (distance < known->distance) {
        *known = here;
      }
    });
    Partner best, same;
    int near = 0;
    for (const Nearest& other : others) {
      if (!other.beside) continue;
      near += other.distance <= reach_;
      if (other.is_same(before)) same = other;
      if (other.distance < best.distance || (other.distance == best.distance && other.of < best.of))
        best = other;
    }
    if (same.distance <= best.distance + hardly * reach_) best = same;
    best.several = near > 1;
    return best;
  }

  /// Where the partner of `from` ends, between two parameters: the last with it and the first
  /// without.
  std::pair<double, double> change(std::size_t k, double from, double to,
                                   const Partner& first) const {
    for (int n = 0; n < bisections; ++n) {
      const double middle = (from + to) / 2;
      (partner(k, middle, first).is_same(first) ? from : to) = middle;
    }
    return {from, to};
  }

  /// Adds the part of samples with the same partner. Where it ends because both run apart, as
  /// from a common vertex, it ends as soon as they are farther apart than `reach`; one that nowhere
  /// comes so near is none.
  void add_run(std::size_t k, std::span<const std::pair<double, Partner>> run, bool begins,
               bool ends, std::vector<std::pair<double, Partner>>& parts) const {
    const auto is_near = [&](const auto& sample) { return sample.second.distance <= reach_; };
    const auto first = std::ranges::find_if(run, is_near);
    if (first == run.end()) {
      parts.emplace_back(run.front().first, Partner{});
      return;
    }
    const auto runs_apart = [&](const auto& sample) {
      return sample.second.distance > nearly_farthest * farthest_;
    };
    double from = run.front().first, to = run.back().first;
    if (!begins && runs_apart(run.front()))
      from = crossing(k, (first - 1)->first, first->first, first->second);
    if (!ends && runs_apart(run.back())) {
      const auto last = std::ranges::find_if(run.rbegin(), run.rend(), is_near).base();
      to = crossing(k, last->first, (last - 1)->first, first->second);
    }
    if (from > run.front().first) parts.emplace_back(run.front().first, Partner{});
    parts.emplace_back(from, run[run.size() / 2].second);
    if (to < run.back().first) parts.emplace_back(to, Partner{});
  }

  /// Where the partner comes within `reach`, between a parameter where it is not and one where it
  /// is.
  double crossing(std::size_t k, double outside, double inside, const Partner& of) const {
    for (int n = 0; n < bisections; ++n) {
      const double middle = (outside + inside) / 2;
      (partner(k, middle, of).distance <= reach_ ? inside : outside) = middle;
    }
    return inside;
  }

  std::vector<EdgeMeeting> without_short(
      std::size_t k, const std::vector<std::pair<double, Partner>>& ends) const {
    const EdgePiece& piece = *edges_[k].piece;
    const auto length = [&](double from, double to) {
      return (piece.curve.at(to) - piece.curve.at(from)).norm();
    };
    double whole = 0;
    for (std::size_t s = 0; s + 1 < parameters_[k].size(); ++s)
      whole += length(parameters_[k][s], parameters_[k][s + 1]);
    const double least = std::max(least_length * whole, least_reaches * reach_);
    std::vector<EdgeMeeting> parts;
    bool leading = false;  // what there is so far is short
    for (std::size_t s = 0; s < ends.size(); ++s) {
      const double from = ends[s].first, to = s + 1 < ends.size() ? ends[s + 1].first : piece.to;
      const Partner& partner = ends[s].second;
      const EdgeMeeting part{from, to, partner.of < edges_.size() ? edges_[partner.of].edge : none,
                             partner.same_way, partner.several};
      const bool is_short = (to - from) < 0.1 * (piece.to - piece.from) && length(from, to) < least;
      if (parts.empty()) {
        parts.push_back(part);
        leading = is_short;
      } else if (leading && !is_short) {
        parts.back() = {parts.back().from, to, part.other, part.same_way, part.several};
        leading = false;
      } else if (is_short || parts.back().other == part.other) {
        parts.back().to = to;
      } else {
        parts.push_back(part);
      }
    }
    return parts;
  }

  const std::vector<LooseEdge>& edges_;
  double reach_, farthest_;
  std::vector<std::vector<double>> parameters_;
  std::vector<Segment> segments_;
  BoxTree tree_;
};

}  // namespace

std::vector<std::vector<EdgeMeeting>> meetings_of(const std::vector<LooseEdge>& edges, double reach,
                                                  double parted) {
  const MeetingFinder finder(edges, reach, parted);
  std::vector<std::vector<EdgeMeeting>> result(edges.size());
  detail::parallel_for(
      static_cast<std::ptrdiff_t>(edges.size()), 1, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (std::ptrdiff_t k = begin; k < end; ++k)
          result[static_cast<std::size_t>(k)] = finder.parts(static_cast<std::size_t>(k));
      });
  // Each part once, as that of the first of both edges.
  std::set<std::pair<Index, Index>> met;
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const Index edge = edges[k].edge;
    std::erase_if(result[k], [&](const EdgeMeeting& part) {
      return part.other != none && met.contains({part.other, edge});
    });
    for (const EdgeMeeting& part : result[k]) {
      if (part.other != none) met.insert({edge, part.other});
    }
  }
  return result;
}

}  // namespace knead::brep
