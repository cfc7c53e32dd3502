#include <algorithm>

#include "command_fields.hpp"
#include "info_values.hpp"

namespace knead {

std::span<const Choice> choices(BodyKind) {
  static constexpr Choice list[] = {{"curve", BodyKind::curve}, {"volume", BodyKind::volume}};
  return list;
}

void describe(BodyInfo& b, Fields& fields) {
  fields.name("body info", "A curve or a volume of the session.");
  fields.add("id", b.id);
  fields.add("name", b.name);
  fields.add("unit", b.unit, {.help = "of all lengths"});
  fields.add("kind", b.kind);
  fields.add("degree", b.degree, {.help = "in each direction"});
  fields.add("net", b.net, {.help = "control points in each direction; the last one is fastest"});
  fields.add("rational", b.rational);
  fields.add("lower", b.lower, {.help = "corner of the control points' bounding box", .unit = Unit::length});
  fields.add("upper", b.upper, {.help = "the opposite corner", .unit = Unit::length});
  fields.add("alpha", b.alpha, {.help = "coefficients 11 of a curve, 11, 12, 13, 22, 23, 33 of a volume"});
  fields.add("beta", b.beta, {.help = "likewise"});
  fields.add("mass", b.mass);
  fields.add("damping", b.damping);
  fields.add("w1", b.w1, {.help = "weight of the metric; null where the model is linear"});
  fields.add("w2", b.w2, {.help = "weight of a curve's curvature"});
  fields.add("hold", b.hold, {.help = "outer layers of control points that do not move"});
  fields.add("pins", b.pins, {.help = "numbers of pinned control points"});
  fields.add("sides", b.sides, {.help = "which of them are held: `u0`, `u1` of a curve, to `w1` of a volume"});
  fields.add("holds", b.holds, {.help = "how many sides and points are held besides"});
  fields.add("moved", b.moved, {.help = "number of control points that are not as they were made"});
  fields.add("displacement", b.displacement, {.help = "the largest", .unit = Unit::length});
}

std::vector<BodyInfo> bodies_of(const Scene& scene) {
  std::vector<BodyInfo> result;
  for (const SceneBody& b : scene.bodies) {
    const Points& points = control_points_of(b);
    BodyInfo info;
    info.id = b.id;
    info.name = b.name;
    info.unit = b.unit;
    info.kind = b.is_curve() ? BodyKind::curve : BodyKind::volume;
    info.degree = degrees_of(b);
    info.net = net_of(b);
    info.lower = array_of(points.colwise().minCoeff().transpose());
    info.upper = array_of(points.colwise().maxCoeff().transpose());
    std::visit(
        [&](const auto& shapes) {
          info.rational = shapes.current->rational();
          info.alpha.assign(shapes.material.alpha.begin(), shapes.material.alpha.end());
          info.beta.assign(shapes.material.beta.begin(), shapes.material.beta.end());
          if (const auto* forms = std::get_if<FormWeights>(&shapes.elasticity)) {
            info.w1 = forms->w1;
            if (b.is_curve()) info.w2 = forms->w2;
          }
        },
        b.shapes);
    info.mass = b.mass;
    info.damping = b.damping;
    info.hold = b.hold_rows;
    info.pins.assign(b.pins.begin(), b.pins.end());
    for (const KeptBodyHold& kept : b.holds) {
      const auto* hold = std::get_if<SideHold>(&kept.hold);
      if (hold == nullptr) continue;
      info.sides.push_back({"uvw"[hold->side.direction], hold -> side.upper ? '1' : '0'});
    }
    info.holds = static_cast<int>(b.holds.size());
    info.moved = moved_control_points(b);
    info.displacement = largest_displacement(b);
    result.push_back(std::move(info));
  }
  return result;
}

}  // namespace knead
