#include "studio_combs.hpp"

#include <nlohmann/json.hpp>

#include "buffers.hpp"

namespace knead::studio {

namespace {

/// Puts teeth into a picture, those that are visible.
class CombDrawer {
 public:
  CombDrawer(const Surface& surface, Point origin, const VisibleRegion* visible)
      : surface_(surface), origin_(std::move(origin)), visible_(visible) {}
  CombPicture picture;

  /// The next tooth is the first of a comb.
  void begin() { joined_ = false; }
  void add(const std::array<double, 2>& parameters, const Point& on, const Point& vector) {
    if (visible_ != nullptr && !visible_->contains({fraction(0, parameters[0]), fraction(1, parameters[1])})) {
      joined_ = false;
      return;
    }
    const Point place = on - origin_;
    for (int d = 0; d < 3; ++d) {
      picture.places.push_back(static_cast<float>(place[d]));
      picture.vectors.push_back(static_cast<float>(vector[d]));
    }
    picture.joined.push_back(joined_ ? 1 : 0);
    joined_ = true;
    if (const double size = vector.norm(); size > picture.largest) {
      picture.largest = size;
      picture.at = place;
    }
  }

 private:
  [[nodiscard]] double fraction(int d, double u) const {
    const Interval domain = surface_.knots(d).domain();
    return (u - domain.lower) / domain.length();
  }
  const Surface& surface_;
  Point origin_;
  const VisibleRegion* visible_;
  bool joined_ = false;
};

}  // namespace

Expected<CombPicture> comb_picture(const Surface& surface, const CurvatureCombOptions& options, const Point& origin,
                                   const VisibleRegion* visible) {
  const auto combs = curvature_combs(surface, options);
  if (!combs) return std::unexpected(combs.error());
  CombDrawer drawer(surface, origin, visible);
  for (const CurvatureComb& comb : *combs) {
    drawer.begin();
    for (Eigen::Index k = 0; k < comb.places.rows(); ++k) {
      const double runs = comb.runs[static_cast<std::size_t>(k)];
      drawer.add(comb.direction == 0 ? std::array{runs, comb.at} : std::array{comb.at, runs},
                 comb.places.row(k).transpose(), comb.vectors.row(k).transpose());
    }
  }
  return std::move(drawer.picture);
}

Expected<CombPicture> section_comb_picture(const Surface& surface, const SectionPlane& plane, const Point& origin,
                                           const VisibleRegion* visible) {
  constexpr double dense = 1e-3;
  const Points& net = surface.control_points();
  const double extent = (net.colwise().maxCoeff() - net.colwise().minCoeff()).norm();
  const auto combs = section_combs(surface, plane, extent > 0 ? dense * extent : 1);
  if (!combs) return std::unexpected(combs.error());
  CombDrawer drawer(surface, origin, visible);
  for (const SectionComb& comb : *combs) {
    drawer.begin();
    for (Eigen::Index k = 0; k < comb.places.rows(); ++k) {
      drawer.add({comb.parameters(k, 0), comb.parameters(k, 1)}, comb.places.row(k).transpose(),
                 comb.vectors.row(k).transpose());
    }
  }
  return std::move(drawer.picture);
}

std::string comb_json(const CombPicture& p) {
  return "{\"largest\":" + nlohmann::json(p.largest).dump() +
         ",\"at\":" + nlohmann::json({p.at[0], p.at[1], p.at[2]}).dump() +
         ",\"buffers\":" + buffers_json({{"places", p.places}, {"vectors", p.vectors}, {"joined", p.joined}}) + "}";
}

}  // namespace knead::studio
