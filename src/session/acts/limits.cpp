#include "limits.hpp"

#include <fmt/format.h>

#include <variant>

#include "base/counts.hpp"

namespace knead {

Expected<void> check_net_size(const std::array<int, 2>& counts) {
  if (product_of(counts, max_net_size)) return {};
  return input_error(fmt::format("a net of {} x {} has more than {} million control points",
                                 counts[0], counts[1], max_net_size / 1000000),
                     "net", "use fewer");
}

Expected<void> check_document_size(const Scene& scene, std::int64_t more) {
  std::int64_t size = more;
  for (const SceneSurface& s : scene.surfaces) size += s.current->size();
  for (const SceneBody& body : scene.bodies) size += control_points_of(body).rows();
  if (size <= max_document_size) return {};
  return input_error(
      fmt::format(
          "all surfaces, curves and volumes together would have {} control points, more than {} "
          "million",
          size, max_document_size / 1000000),
      "net", "use fewer");
}

Expected<void> check_steps(int steps, std::size_t places) {
  if (places == 0 || static_cast<std::size_t>(steps) <= max_steps / places) return {};
  return input_error(
      places == 1 ? fmt::format("{} steps are too many", steps)
                  : fmt::format("{} steps at each of {} positions are too many", steps, places),
      "steps", fmt::format("a command may take {} in all", max_steps));
}

Expected<void> check_radius(double radius) {
  constexpr double least = 1e-50, greatest = 1e50;  // as of tools
  if (radius >= least && radius <= greatest) return {};
  return input_error(fmt::format("{} is not a radius", radius), "radius",
                     radius > 0 ? "use a number from 1e-50 to 1e50" : "use a number > 0");
}

}  // namespace knead
