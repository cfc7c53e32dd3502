#include "knead/spline/curvature.hpp"
#include "knead/spline/evaluate.hpp"
#include "places.hpp"
#include "scene.hpp"

namespace knead {

Expected<ProbeReading> read_probe(const Scene& scene, const Probe& probe) {
  const SceneSurface& s = scene.surfaces[static_cast<std::size_t>(probe.surface)];
  const auto u = parameters_at(*s.current, probe.at);
  if (!u) return std::unexpected(u.error());
  Parameters<2> place(1, 2);
  place << (*u)[0], (*u)[1];
  const auto jet = evaluate<2>(*s.current, place, 1);
  if (!jet) return std::unexpected(jet.error());
  const auto opened = evaluate_point<2>(*s.opened, *u);
  if (!opened) return std::unexpected(opened.error());
  ProbeReading reading;
  reading.point = jet->points().row(0).transpose();
  reading.displacement = reading.point - *opened;
  const Point along_u = jet->at({1, 0}).row(0).transpose(),
              along_v = jet->at({0, 1}).row(0).transpose();
  const Point normal = along_u.cross(along_v);
  if (normal.norm() > 1e-9 * (along_u.squaredNorm() + along_v.squaredNorm()))
    reading.normal = normal.normalized();
  if (const auto bent = curvature(*s.current, *u); bent && !reading.normal.isZero())
    reading.curvature = bent->principal;
  return reading;
}

}  // namespace knead
