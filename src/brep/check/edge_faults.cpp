// Edges judged by thresholds, by themselves or beside another version of the model.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "knead/brep/edge_measures.hpp"

namespace knead::brep {
namespace {

constexpr double same_edge = 1e-3;  // of the size

double value_of(const std::optional<EdgeFigure>& figure) { return figure ? figure->value : 0; }

/// What a threshold of gaps is compared with.
double gap_of(const EdgeMeasures& edge) {
  return std::max(value_of(edge.gap), value_of(edge.off_curve));
}

bool is_meant_smooth(const EdgeMeasures& edge) {
  return edge.kind != EdgeKind::unknown && edge.kind != EdgeKind::open &&
         edge.kind != EdgeKind::non_manifold && edge.angle && edge.angle->value < meant_smooth;
}

/// The measures of an edge that exceed their thresholds, and those of `before` by as much.
void judge(const EdgeMeasures& edge, const EdgeMeasures* before, const EdgeThresholds& thresholds,
           std::vector<EdgeFault>& faults) {
  if (edge.kind == EdgeKind::unknown) return;
  const bool closed_before = before != nullptr && before->kind != EdgeKind::open;
  if (closed_before && edge.kind == EdgeKind::open) {
    const double were = std::max(2.0, static_cast<double>(before->faces.size()));
    faults.push_back({edge.id, "faces", 1, were, were});
  }
  const auto compare = [&](const char* measure, double value, std::optional<double> was,
                           const std::optional<double>& limit) {
    if (limit && value - was.value_or(0) > *limit)
      faults.push_back({edge.id, measure, value, *limit, was});
  };
  const auto was = [&](double value) {
    return before != nullptr ? std::optional(value) : std::nullopt;
  };
  const EdgeMeasures& other = before != nullptr ? *before : edge;
  compare("gap", gap_of(edge), was(gap_of(other)), thresholds.gap);
  if (!is_meant_smooth(other)) return;
  compare("angle", value_of(edge.angle), was(value_of(other.angle)), thresholds.angle);
  compare("curvature", value_of(edge.relative_curvature), was(value_of(other.relative_curvature)),
          thresholds.curvature);
}

double distance(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

double distance_of_ends(const EdgeMeasures& a, const EdgeMeasures& b) {
  return std::min(std::max(distance(a.start, b.start), distance(a.end, b.end)),
                  std::max(distance(a.start, b.end), distance(a.end, b.start)));
}

/// The edges of another version of a model.
class Matches {
 public:
  Matches(const ModelMeasures& now, const ModelMeasures& before)
      : edges_(before.edges), near_(same_edge * std::max(now.size, before.size)) {
    for (const EdgeMeasures& edge : edges_) by_id_.emplace(edge.id, &edge);
    std::size_t common = 0, together = 0;
    for (const EdgeMeasures& edge : now.edges) {
      const auto found = by_id_.find(edge.id);
      if (found == by_id_.end()) continue;
      ++common;
      if (distance_of_ends(edge, *found->second) <= near_) ++together;
    }
    if (2 * together <= common) by_id_.clear();
  }

  const EdgeMeasures* of(const EdgeMeasures& edge) const {
    if (const auto found = by_id_.find(edge.id); found != by_id_.end()) return found->second;
    const EdgeMeasures* nearest = nullptr;
    double least = near_;
    for (const EdgeMeasures& other : edges_) {
      const double far =
          std::max(distance(edge.middle, other.middle), distance_of_ends(edge, other));
      if (far > least || (nearest != nullptr && far == least)) continue;
      least = far;
      nearest = &other;
    }
    return nearest;
  }

 private:
  const std::vector<EdgeMeasures>& edges_;
  double near_;
  std::unordered_map<std::string, const EdgeMeasures*> by_id_;
};

}  // namespace

std::vector<EdgeFault> faults_of(const ModelMeasures& measures, const EdgeThresholds& thresholds) {
  std::vector<EdgeFault> faults;
  for (const EdgeMeasures& edge : measures.edges) judge(edge, nullptr, thresholds, faults);
  return faults;
}

std::vector<EdgeFault> faults_against(const ModelMeasures& measures, const ModelMeasures& before,
                                      const EdgeThresholds& thresholds) {
  const Matches matches(measures, before);
  std::vector<EdgeFault> faults;
  for (const EdgeMeasures& edge : measures.edges) {
    const EdgeMeasures* other = matches.of(edge);
    if (other != nullptr && other->kind == EdgeKind::unknown) other = nullptr;
    judge(edge, other, thresholds, faults);
  }
  return faults;
}

}  // namespace knead::brep
