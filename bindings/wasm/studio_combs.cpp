#include "studio_combs.hpp"

#include <nlohmann/json.hpp>

#include "buffers.hpp"

namespace knead::studio {

Expected<CombPicture> comb_picture(const Surface& surface, const CurvatureCombOptions& options, const Point& origin,
                                   const VisibleRegion* visible) {
  const auto combs = curvature_combs(surface, options);
  if (!combs) return std::unexpected(combs.error());
  const auto fraction = [&](int d, double u) {
    const Interval domain = surface.knots(d).domain();
    return (u - domain.lower) / domain.length();
  };
  CombPicture picture;
  for (const CurvatureComb& comb : *combs) {
    bool joined = false;
    for (Eigen::Index k = 0; k < comb.places.rows(); ++k) {
      Eigen::Vector2d at;
      at[comb.direction] = fraction(comb.direction, comb.runs[static_cast<std::size_t>(k)]);
      at[1 - comb.direction] = fraction(1 - comb.direction, comb.at);
      if (visible != nullptr && !visible->contains(at)) {
        joined = false;
        continue;
      }
      const Point place = comb.places.row(k).transpose() - origin, vector = comb.vectors.row(k);
      for (int d = 0; d < 3; ++d) {
        picture.places.push_back(static_cast<float>(place[d]));
        picture.vectors.push_back(static_cast<float>(vector[d]));
      }
      picture.joined.push_back(joined ? 1 : 0);
      joined = true;
      if (const double size = vector.norm(); size > picture.largest) {
        picture.largest = size;
        picture.at = place;
      }
    }
  }
  return picture;
}

std::string comb_json(const CombPicture& p) {
  return "{\"largest\":" + nlohmann::json(p.largest).dump() +
         ",\"at\":" + nlohmann::json({p.at[0], p.at[1], p.at[2]}).dump() +
         ",\"buffers\":" + buffers_json({{"places", p.places}, {"vectors", p.vectors}, {"joined", p.joined}}) + "}";
}

}  // namespace knead::studio
