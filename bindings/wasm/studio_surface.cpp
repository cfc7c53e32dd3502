#include "studio_surface.hpp"

#include <nlohmann/json.hpp>

namespace knead::studio {
namespace {

using Json = nlohmann::json;

}  // namespace

std::string surface_json(const Surface& surface) {
  Json points = Json::array();
  for (Eigen::Index k = 0; k < surface.size(); ++k) {
    const auto row = surface.control_points().row(k);
    points.push_back({row[0], row[1], row[2]});
  }
  const auto u = surface.knots(0).knots(), v = surface.knots(1).knots();
  const auto weights = surface.weights();
  return Json({{"degree", {surface.knots(0).degree(), surface.knots(1).degree()}},
               {"net", surface.net()},
               {"knots_u", std::vector<double>(u.begin(), u.end())},
               {"knots_v", std::vector<double>(v.begin(), v.end())},
               {"weights", surface.rational() ? Json(std::vector<double>(weights.begin(), weights.end())) : Json()},
               {"points", std::move(points)}})
      .dump();
}

}  // namespace knead::studio
