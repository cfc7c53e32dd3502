#include "step_trimming.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "knead/spline/evaluate.hpp"
#include "step_curves.hpp"
#include "step_share.hpp"

namespace knead::step {
namespace {

// One of the four boundary isocurves, and how much of it the edges of a face cover.
struct BoundarySide {
  CurveTable table;
  bool required = false;  // to be covered: neither a seam nor a single point
  bool closed = false;
  std::vector<Interval> covered = {};
};

class NaturalBoundary {
 public:
  static std::optional<NaturalBoundary> create(const Surface& surface, double tolerance) {
    NaturalBoundary result;
    result.tolerance_ = tolerance;
    for (int direction = 0; direction < 2; ++direction) {
      for (int end = 0; end < 2; ++end) {
        auto curve = boundary_curve(surface, direction, end);
        auto table =
            curve ? CurveTable::create(*std::move(curve)) : Expected<CurveTable>(std::unexpected(curve.error()));
        if (!table) return std::nullopt;
        BoundarySide side{*std::move(table)};
        side.required = net_diagonal(side.table.points()) > tolerance;
        side.closed = side.table.closed(tolerance);
        result.sides_.push_back(std::move(side));
      }
      auto& first = result.sides_[result.sides_.size() - 2];
      auto& last = result.sides_.back();
      if ((first.table.points() - last.table.points()).rowwise().norm().maxCoeff() <= tolerance) {
        first.required = last.required = false;  // a seam
      }
    }
    return result;
  }

  void begin_face() {
    for (auto& side : sides_) side.covered.clear();
  }

  // False if some point lies off the boundary.
  bool add(const Points& edge) {
    std::vector<std::optional<double>> before(sides_.size());
    for (Eigen::Index k = 0; k < edge.rows(); ++k) {
      bool on = false;
      for (std::size_t s = 0; s < sides_.size(); ++s) {
        const auto foot = sides_[s].table.closest(edge.row(k).transpose(), tolerance_);
        const auto now = foot.distance <= tolerance_ ? std::optional(foot.parameter) : std::nullopt;
        on = on || now.has_value();
        const auto last = std::exchange(before[s], now);
        if (now && last) cover(sides_[s], *last, *now);
      }
      if (!on) return false;
    }
    return true;
  }

  [[nodiscard]] bool covered() const {
    return std::all_of(sides_.begin(), sides_.end(),
                       [this](const BoundarySide& side) { return !side.required || full(side); });
  }

 private:
  static void cover(BoundarySide& side, double from, double to) {
    const auto domain = side.table.curve().knots(0).domain();
    const auto [lower, upper] = std::minmax(from, to);
    if (side.closed && upper - lower > domain.length() / 2) {
      // Across the start of the closed curve.
      side.covered.push_back({upper, domain.upper});
      side.covered.push_back({domain.lower, lower});
    } else {
      side.covered.push_back({lower, upper});
    }
  }

  // Gaps may be as long as the error of the vertices: twice the tolerance at each end. The chord alone does not decide:
  // that of a whole closed curve is zero.
  [[nodiscard]] bool short_arc(const Curve& curve, double from, double to) const {
    constexpr int pieces = 8;
    for (int k = 1; k <= pieces; ++k) {
      const double t = from + (to - from) * k / pieces;
      const auto a = evaluate_point<1>(curve, {from});
      const auto b = evaluate_point<1>(curve, {std::min(t, to)});
      if (!a || !b || (*a - *b).norm() > 4 * tolerance_) return false;
    }
    return true;
  }

  [[nodiscard]] bool full(const BoundarySide& side) const {
    const auto domain = side.table.curve().knots(0).domain();
    auto covered = side.covered;
    std::sort(covered.begin(), covered.end(), [](const Interval& a, const Interval& b) { return a.lower < b.lower; });
    covered.push_back({domain.upper, domain.upper});
    double reached = domain.lower;
    for (const auto& interval : covered) {
      if (interval.lower > reached && !short_arc(side.table.curve(), reached, interval.lower)) return false;
      reached = std::max(reached, interval.upper);
    }
    return true;
  }

  std::vector<BoundarySide> sides_;
  double tolerance_ = 0;
};

// The bounds of one face; false if they leave the boundary or are of an unknown type.
bool add_bounds(const Reader& reader, std::uint32_t bounds, NaturalBoundary& boundary) {
  for (const auto bound : reader.references(bounds)) {
    const auto own = reader.attributes(bound, "FACE_BOUND", 1, 1);
    const auto loop = own.empty() ? std::nullopt : reader.reference(own[0]);
    if (!loop) return false;
    if (reader.is(*loop, "VERTEX_LOOP")) continue;  // a pole, or a point that bounds nothing
    if (!reader.is(*loop, "EDGE_LOOP")) return false;
    const auto path = reader.attributes(*loop, "PATH", 1, 1);
    if (path.empty()) return false;
    for (const auto oriented : reader.references(path[0])) {
      const auto parts = reader.attributes(oriented, "ORIENTED_EDGE", 3, 1);
      const auto edge = parts.empty() ? std::nullopt : reader.reference(parts[0]);
      const auto points = edge ? sample_edge(reader, *edge) : std::nullopt;
      if (!points || !boundary.add(*points)) return false;
    }
  }
  return true;
}

// The basis surface trimmed by a RECTANGULAR_TRIMMED_SURFACE or CURVE_BOUNDED_SURFACE.
std::optional<std::uint32_t> cut_surface(const Reader& reader, std::uint32_t instance,
                                         const std::unordered_map<std::uint32_t, std::size_t>& index,
                                         const std::vector<ReadSurface>& surfaces) {
  if (reader.is(instance, "CURVE_BOUNDED_SURFACE")) {
    const auto own = reader.attributes(instance, "CURVE_BOUNDED_SURFACE", 1, 3);
    const bool whole = !own.empty() && reader.references(own[1]).empty() && reader.enumeration(own[2]) == "T";
    return own.empty() || whole ? std::nullopt : reader.reference(own[0]);
  }
  if (!reader.is(instance, "RECTANGULAR_TRIMMED_SURFACE")) return std::nullopt;
  const auto own = reader.attributes(instance, "RECTANGULAR_TRIMMED_SURFACE", 1, 5);
  const auto basis = own.empty() ? std::nullopt : reader.reference(own[0]);
  const auto found = basis ? index.find(*basis) : index.end();
  if (found == index.end()) return std::nullopt;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto domain = surfaces[found->second].surface.knots(static_cast<int>(k / 2)).domain();
    const auto bound = reader.real(own[k + 1]);
    const double end = k % 2 == 0 ? domain.lower : domain.upper;
    if (!bound || std::abs(*bound - end) > 1e-9 * domain.length()) return basis;
  }
  return std::nullopt;
}

using SurfaceFace = std::pair<std::size_t, std::uint32_t>;  // a surface's index, and the instance of a face on it

// What all faces on one surface make of it.
void use_surface(const Reader& reader, const Surface& surface, double uncertainty, std::span<const SurfaceFace> faces,
                 FaceUse& use) {
  const double diagonal = net_diagonal(surface.control_points());
  const double tolerance = std::clamp(2 * uncertainty, 1e-5 * diagonal, 1e-4 * diagonal);
  std::optional<NaturalBoundary> boundary;
  for (const auto& [s, face] : faces) {
    ++use.faces;
    const auto bounds = reader.attributes(face, "FACE", 1, 1);
    if (bounds.empty() || use.trimmed) continue;
    if (!boundary) boundary = NaturalBoundary::create(surface, tolerance);
    use.trimmed = true;
    if (!boundary) continue;  // it cannot be evaluated
    boundary->begin_face();
    use.trimmed = !add_bounds(reader, bounds[0], *boundary) || !boundary->covered();
  }
}

}  // namespace

std::vector<FaceUse> face_uses(const Reader& reader, const std::vector<ReadSurface>& surfaces,
                               const std::vector<double>& uncertainty) {
  std::vector<FaceUse> uses(surfaces.size());
  std::unordered_map<std::uint32_t, std::size_t> index;
  for (std::size_t k = 0; k < surfaces.size(); ++k) index.emplace(surfaces[k].instance, k);
  for (const auto k : reader.file().named({"CURVE_BOUNDED_SURFACE", "RECTANGULAR_TRIMMED_SURFACE"})) {
    const auto cut = cut_surface(reader, k, index, surfaces);
    const auto found = cut ? index.find(*cut) : index.end();
    if (found != index.end()) uses[found->second].trimmed = true;
  }
  std::vector<SurfaceFace> faces;
  for (const auto k : reader.file().named({"ADVANCED_FACE", "FACE_SURFACE"})) {
    const auto geometry = reader.attributes(k, "FACE_SURFACE", 2, 1);
    const auto target = geometry.empty() ? std::nullopt : reader.reference(geometry[0]);
    const auto found = target ? index.find(*target) : index.end();
    if (found != index.end()) faces.emplace_back(found->second, k);
  }
  std::ranges::sort(faces);
  std::vector<std::span<const SurfaceFace>> of_surfaces;
  for (auto first = faces.begin(); first != faces.end();) {
    const auto last = std::find_if(first, faces.end(), [&](const SurfaceFace& f) { return f.first != first->first; });
    of_surfaces.emplace_back(first, last);
    first = last;
  }
  share(reader, of_surfaces.size(), [&](const Reader& own, std::size_t k) {
    const std::size_t s = of_surfaces[k].front().first;
    use_surface(own, surfaces[s].surface, uncertainty[s], of_surfaces[k], uses[s]);
  });
  return uses;
}

}  // namespace knead::step
