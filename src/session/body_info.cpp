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
  fields.add("lower", b.lower,
             {.help = "corner of the control points' bounding box", .unit = Unit::length});
  fields.add("upper", b.upper, {.help = "the opposite corner", .unit = Unit::length});
  fields.add("alpha", b.alpha,
             {.help = "coefficients 11 of a curve, 11, 12, 13, 22, 23, 33 of a volume"});
  fields.add("beta", b.beta, {.help = "likewise"});
  fields.add("mass", b.mass);
  fields.add("damping", b.damping);
  fields.add("w1", b.w1, {.help = "weight of the metric; null where the model is linear"});
  fields.add("w2", b.w2, {.help = "weight of a curve's curvature"});
  fields.add("hold", b.hold, {.help = "outer layers of control points that do not move"});
  fields.add("pins", b.pins, {.help = "numbers of pinned control points"});
  fields.add("sides", b.sides,
             {.help = "which of them are held: `u0`, `u1` of a curve, to `w1` of a volume"});
  fields.add("holds", b.holds, {.help = "how many sides and points are held besides"});
  fields.add("moved", b.moved, {.help = "number of control points that are not as they were made"});
  fields.add("displacement", b.displacement, {.help = "the largest", .unit = Unit::length});
}

namespace {

template <int D>
BodyInfo info_of(const SceneShape<D>& s, const SceneBody& body) {
  const Points& points = s.current->control_points();
  BodyInfo info;
  info.id = s.id;
  info.name = s.name;
  info.unit = s.unit;
  info.kind = D == 1 ? BodyKind::curve : BodyKind::volume;
  info.degree = degrees_of(body);
  info.net = net_of(body);
  info.rational = s.current->rational();
  info.lower = array_of(points.colwise().minCoeff().transpose());
  info.upper = array_of(points.colwise().maxCoeff().transpose());
  for (const auto& alpha : s.material.alpha) info.alpha.push_back(std::get<double>(alpha));
  for (const auto& beta : s.material.beta) info.beta.push_back(std::get<double>(beta));
  info.mass = std::get<double>(s.material.mass);
  info.damping = std::get<double>(s.material.damping);
  if (const auto* forms = std::get_if<FormWeights>(&s.elasticity)) {
    info.w1 = forms->w1;
    if (D == 1) info.w2 = forms->w2;
  }
  info.hold = s.hold_rows;
  for (const std::array<int, D>& pin : s.pins) {
    int number = 0;
    for (std::size_t d = 0; d < D; ++d) number = number * s.current->net()[d] + pin[d];
    info.pins.push_back(number);
  }
  for (const KeptConstraintOf<D>& kept : s.constraints) {
    if (const auto* hold = std::get_if<SideHold>(&kept.constraint))
      info.sides.push_back(side_name(hold->side));
  }
  info.holds = static_cast<int>(s.constraints.size());
  info.moved = moved_control_points(body);
  info.displacement = largest_displacement(body);
  return info;
}

}  // namespace

std::vector<BodyInfo> bodies_of(const Scene& scene) {
  std::vector<BodyInfo> result;
  for (const SceneBody& b : scene.bodies) {
    result.push_back(std::visit([&](const auto& s) { return info_of(s, b); }, b));
  }
  return result;
}

}  // namespace knead
