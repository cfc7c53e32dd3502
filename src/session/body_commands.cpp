#include "body_commands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "components.hpp"
#include "knead/scene/places.hpp"
#include "limits.hpp"
#include "scene/body_model.hpp"

namespace knead {
namespace {

/// The error of a field that only surfaces have.
std::unexpected<Error> of_surfaces(const SceneBody& body, const char* field, const char* remedy = "leave it out") {
  return input_error(fmt::format("a {} has no {}", kind_of(body), field), field, remedy);
}

/// Whether a model can be made under the constraints there are.
Expected<void> check(Executor& executor) {
  const SceneBody& body = *executor.body();
  return std::visit(
      [&]<int D>(const BodyShapes<D>&) -> Expected<void> {
        const auto model = make_body_model<D>(body_input<D>(executor.state, body, trial_evolution()));
        return model ? Expected<void>() : std::unexpected(model.error());
      },
      body.shapes);
}

template <int D>
Expected<void> set_material(BodyShapes<D>& shapes, const MaterialCommand& c) {
  MaterialOf<D> next = shapes.material;
  const auto set = [](const std::optional<std::vector<double>>& given, auto& to, const char* field) -> Expected<void> {
    if (!given) return {};
    if (given->size() != to.size()) {
      return input_error(fmt::format("{} numbers for a {}", given->size(), D == 1 ? "curve" : "volume"), field,
                         D == 1 ? "give [11]" : "give [11, 12, 13, 22, 23, 33]");
    }
    std::ranges::copy(*given, to.begin());
    return {};
  };
  if (auto done = set(c.alpha, next.alpha, "alpha"); !done) return done;
  if (auto done = set(c.beta, next.beta, "beta"); !done) return done;
  if (auto checked = validated<D>(next); !checked) return std::unexpected(checked.error());
  shapes.material = next;
  return {};
}

Expected<void> set_at(double& to, const std::optional<double>& given, const char* field) {
  if (!given) return {};
  if (!(std::isfinite(*given) && *given >= 0)) {
    return input_error(fmt::format("{} is not a {}", *given, field), field, "use a number >= 0");
  }
  to = *given;
  return {};
}

/// What resists in the body after the command.
template <int D>
Expected<void> set_elasticity(const SceneBody& body, const MaterialCommand& c, Elasticity<D>& elasticity) {
  if (c.model == MaterialModel::shell) {
    return input_error(fmt::format("a {} is no shell", kind_of(body)), "model", R"(use "linear" or "fundamental")");
  }
  const bool keeps = c.model ? *c.model == MaterialModel::fundamental : is_nonlinear(elasticity);
  if (!keeps) {
    if (c.w1 || c.w2) {
      return input_error("only fundamental forms have weights w1 and w2", "model", R"(add "model":"fundamental")");
    }
    elasticity = LinearElasticity{};
    return {};
  }
  if (c.w2 && D == 3) {
    return input_error("a volume has a metric alone", "w2", "leave it out");
  }
  const auto* before = std::get_if<FormWeights>(&elasticity);
  FormWeights next = before != nullptr ? *before : FormWeights{};
  for (const auto& [given, to, field] : {std::tuple{&c.w1, &next.w1, "w1"}, std::tuple{&c.w2, &next.w2, "w2"}}) {
    if (!*given) continue;
    const std::array<double, 3>& w = **given;
    if (w[0] != w[1] || w[1] != w[2]) {
      return input_error(fmt::format("a {} has one weight of each form", kind_of(body)), field, "give one number");
    }
    if (auto done = set_at(*to, w[0], field); !done) return done;
  }
  elasticity = next;
  return {};
}

/// The number of a control point by its indices. Errors (input): it does not exist.
Expected<int> number_of(const std::vector<int>& net, const std::vector<int>& index, const std::string& where) {
  int number = 0;
  bool exists = index.size() == net.size();
  for (std::size_t d = 0; d < net.size() && exists; ++d) {
    exists = index[d] >= 0 && index[d] < net[d];
    number = number * net[d] + index[d];
  }
  if (exists) return number;
  return input_error(fmt::format("there is no control point [{}]", fmt::join(index, ", ")), where,
                     fmt::format("the net is {}, counted from 0", fmt::join(net, " by ")));
}

/// Control points that the command names, each once.
Expected<std::vector<int>> named_points(const SceneBody& body, const NamedPoints& named) {
  const int count = static_cast<int>(control_points_of(body).rows());
  if (!named.rows_u.empty()) return std::unexpected(of_surfaces(body, "rows_u", "give which").error());
  if (!named.rows_v.empty()) return std::unexpected(of_surfaces(body, "rows_v", "give which").error());
  std::vector<int> points;
  for (std::size_t k = 0; k < named.which.size(); ++k) {
    const int number = named.which[k];
    if (number < 0 || number >= count) {
      return input_error(fmt::format("there is no control point {}", number), fmt::format("which[{}]", k),
                         fmt::format("use numbers from 0 to {}", count - 1));
    }
    if (std::ranges::find(points, number) == points.end()) points.push_back(number);
  }
  if (!points.empty()) return points;
  return input_error("no control points are named", "which", "give their numbers, counted from 0");
}

/// Moves rows of every shape, so that the result is its own rest shape; places that coincided still do.
template <int D>
Expected<void> move_points(SceneBody& body, BodyShapes<D>& shapes, const std::vector<int>& named, const Points& after) {
  const Points before = shapes.current->control_points();
  const auto moved = [&](Points points) {
    for (const int row : named) {
      if (points.row(row) == before.row(row)) {
        points.row(row) = after.row(row);
      } else {
        points.row(row) += after.row(row) - before.row(row);
      }
    }
    return points;
  };
  const bool at_rest = shapes.rest == shapes.current;
  auto current = shapes.current->with_control_points(after);
  if (!current) return std::unexpected(current.error());
  auto rest = shapes.rest->with_control_points(moved(shapes.rest->control_points()));
  if (!rest) return std::unexpected(rest.error());
  shapes.current = std::make_shared<const Spline<D>>(*std::move(current));
  shapes.rest = at_rest ? shapes.current : std::make_shared<const Spline<D>>(*std::move(rest));
  for (KeptBodyHold& kept : body.holds) kept.where = moved(kept.where);
  return {};
}

}  // namespace

Expected<void> on_body(Executor& executor, const MaterialCommand& c) {
  SceneBody& body = *executor.body();
  const struct {
    const char* name;
    bool given;
  } fields[] = {{"region", c.region.has_value()},       {"coefficient", c.coefficient.has_value()},
                {"samples", !c.samples.empty()},        {"formula", c.formula.has_value()},
                {"preset", c.preset.has_value()},       {"plasticity", c.plasticity.has_value()},
                {"yield", c.yield.has_value()},         {"locality", c.locality.has_value()},
                {"young", c.young.has_value()},         {"poisson", c.poisson.has_value()},
                {"thickness", c.thickness.has_value()}, {"density", c.density.has_value()}};
  for (const auto& [name, given] : fields) {
    if (given) return of_surfaces(body, name, "use alpha, beta, mass and damping");
  }
  if (!c.alpha && !c.beta && !c.mass && !c.damping && !c.model && !c.w1 && !c.w2) {
    return input_error("no field is given", "alpha", "give alpha, beta, mass, damping, or a model");
  }
  auto elastic = std::visit([&]<int D>(BodyShapes<D>& shapes) { return set_elasticity<D>(body, c, shapes.elasticity); },
                            body.shapes);
  if (!elastic) return elastic;
  if (auto done = set_at(body.mass, c.mass, "mass"); !done) return done;
  if (auto done = set_at(body.damping, c.damping, "damping"); !done) return done;
  return std::visit([&](auto& shapes) { return set_material(shapes, c); }, body.shapes);
}

Expected<void> on_body(Executor& executor, const HoldCommand& c) {
  SceneBody& body = *executor.body();
  const HoldMode mode = c.mode.value_or(HoldMode::rows);
  if (c.all.value_or(false)) return executor.execute(c);  // of all surfaces
  if (mode != HoldMode::rows && mode != HoldMode::free) return of_surfaces(body, "faces", R"(use "mode":"rows")");
  if (c.rows < 0) return input_error(fmt::format("{} rows cannot be held", c.rows), "rows", "use 0 or more");
  body.hold_rows = mode == HoldMode::rows ? c.rows : 0;
  return check(executor);
}

Expected<void> on_body(Executor& executor, const PinCommand& c) {
  SceneBody& body = *executor.body();
  if (c.to && !c.at) return input_error("there is no point to move there", "to", "give at, the point");
  if (c.control_points.empty() && !c.at) {
    return input_error("nothing is pinned", "control_points", "give control_points, or at");
  }
  const auto components = components_of(c.components);
  if (!components) return std::unexpected(components.error());
  if (c.components && !c.at) {
    return input_error("control points are pinned in all coordinates", "components", "give at, the point");
  }
  const std::vector<int> net = net_of(body);
  for (std::size_t k = 0; k < c.control_points.size(); ++k) {
    const auto number = number_of(net, c.control_points[k], fmt::format("control_points[{}]", k));
    if (!number) return std::unexpected(number.error());
    body.pins.insert(*number);
  }
  if (c.at) body.holds.push_back({PlacePin{*c.at, c.to, *components}, control_points_of(body)});
  return check(executor);
}

Expected<void> on_body(Executor& executor, const EdgeCommand& c) {
  SceneBody& body = *executor.body();
  if (c.edge) return of_surfaces(body, "faces", "give which, one of its sides");
  if (c.hold == EdgeCondition::follow) return of_surfaces(body, "faces", R"(use "hold":"free")");
  const auto components = components_of(c.components);
  if (!components) return std::unexpected(components.error());
  const int directions = body.is_curve() ? 1 : 3;
  std::vector<DomainSide> sides;
  for (int direction = 0; direction < directions; ++direction) {
    for (const bool upper : {false, true}) {
      const auto choice = static_cast<SideChoice>(static_cast<int>(SideChoice::u0) + 2 * direction + (upper ? 1 : 0));
      if (c.which == SideChoice::all || c.which == choice) sides.push_back({direction, upper});
    }
  }
  if (sides.empty()) {
    return input_error("a curve has no such end", "which", "use u0, u1 or all");
  }
  const int order = c.hold == EdgeCondition::position ? 0 : c.hold == EdgeCondition::clamped ? 1 : 2;
  std::erase_if(body.holds, [&](KeptBodyHold& kept) {
    auto* hold = std::get_if<SideHold>(&kept.hold);
    if (hold == nullptr || std::ranges::find(sides, hold->side) == sides.end()) return false;
    for (std::size_t d = 0; d < 3; ++d) hold->components[d] = hold->components[d] && !(*components)[d];
    return std::ranges::none_of(hold->components, std::identity());
  });
  if (c.hold == EdgeCondition::free) return {};
  for (const DomainSide& side : sides) {
    body.holds.push_back({SideHold{side, order, *components}, control_points_of(body)});
  }
  return check(executor);
}

Expected<void> on_body(Executor& executor, const ReleaseCommand& c) {
  SceneBody& body = *executor.body();
  if (auto known = check_release(c); !known) return known;
  const auto meant = [&](std::string_view kind) {
    return !c.what || std::ranges::find(*c.what, kind) != c.what->end();
  };
  if (meant("hold")) body.hold_rows = 0;
  if (meant("pins")) body.pins.clear();
  std::erase_if(body.holds, [&](const KeptBodyHold& kept) {
    return meant(std::holds_alternative<SideHold>(kept.hold) ? "edges" : "pins");
  });
  return {};
}

Expected<void> on_body(Executor& executor, const PointsCommand& c) {
  SceneBody& body = *executor.body();
  const auto named = named_points(body, c.points);
  if (!named) return std::unexpected(named.error());
  if (c.by.has_value() == !c.to.empty()) {
    return input_error("one of by and to is needed", "by", "give [dx, dy, dz], or a list of positions");
  }
  if (!c.to.empty() && c.relative) return input_error("positions are not relative", "relative", "leave it out");
  if (!c.to.empty() && c.to.size() != named->size()) {
    return input_error(fmt::format("{} positions for {} control points", c.to.size(), named->size()), "to",
                       "give one for each; a point named twice counts once");
  }
  const double unit = c.relative ? diagonal_of(body) : 1;
  Points after = control_points_of(body);
  for (std::size_t k = 0; k < named->size(); ++k) {
    const Eigen::RowVector3d vector(c.by ? c.by->data() : c.to[k].data());
    after.row((*named)[k]) = c.by ? Eigen::RowVector3d(after.row((*named)[k]) + unit * vector) : vector;
  }
  return std::visit([&](auto& shapes) { return move_points(body, shapes, *named, after); }, body.shapes);
}

Expected<void> on_body(Executor& executor, const RefineCommand& c) {
  SceneBody& body = *executor.body();
  if (c.under) return of_surfaces(body, "under", "leave it out: every span is halved");
  if (c.region) return of_surfaces(body, "region", "leave it out: every span is halved");
  if (!c.knots_u.empty() || !c.knots_v.empty()) {
    return of_surfaces(body, c.knots_u.empty() ? "knots_v" : "knots_u", "leave it out: every span is halved");
  }
  if (c.permission) return executor.execute(c);
  double size = 1;
  const std::vector<int> net = net_of(body);
  for (const int n : net) size *= 2.0 * n;
  if (size > static_cast<double>(max_net_size)) {
    return input_error(fmt::format("the net could get more than {} control points", max_net_size), body.id,
                       "work on a smaller net");
  }
  if (auto done = halve_spans(body); !done) return done;
  executor.state.notes.push_back(fmt::format("{}: the net is now {}", body.id, fmt::join(net_of(body), " by ")));
  return {};
}

}  // namespace knead
