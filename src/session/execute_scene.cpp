#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "executor.hpp"
#include "knead/energy/paint.hpp"
#include "knead/spline/extremum.hpp"

namespace knead {
namespace {

Coefficient<2>* coefficient_named(MaterialFieldOf<2>& material, const std::string& name) {
  static constexpr const char* suffixes[] = {"11", "12", "22"};
  for (std::size_t k = 0; k < 3; ++k) {
    if (name == fmt::format("alpha{}", suffixes[k])) return &material.alpha[k];
    if (name == fmt::format("beta{}", suffixes[k])) return &material.beta[k];
  }
  if (name == "mass") return &material.mass;
  if (name == "damping") return &material.damping;
  return nullptr;
}

}  // namespace

Expected<SurfaceState*> Executor::selected() {
  if (state.selected) return &state.surfaces[static_cast<std::size_t>(*state.selected)];
  if (document.is_fresh() && state.surfaces.empty()) {
    return input_error("there is no surface yet", {}, R"(make one first: {"do":"new","size":[1,1],"net":[8,8]})");
  }
  if (state.surfaces.empty()) {
    return input_error("the file has no B-spline surface that could be sculpted", document.name());
  }
  return input_error(fmt::format("none of the {} surfaces is selected", state.surfaces.size()), {},
                     fmt::format(R"(select one first: {{"do":"select","surface":"{}"}})", state.surfaces.front().id));
}

Expected<int> Executor::find_surface(const std::string& id) const {
  constexpr std::size_t listed = 12;
  std::string known;
  for (std::size_t k = 0; k < state.surfaces.size(); ++k) {
    if (state.surfaces[k].id == id) return static_cast<int>(k);
    if (k < listed) known += (k == 0 ? "" : ", ") + state.surfaces[k].id;
  }
  if (!document.is_fresh()) {
    for (const step::UnreadableSurface& s : document.file().unreadable_surfaces()) {
      if (s.id == id) return std::unexpected(s.reason);
    }
  }
  if (state.surfaces.size() > listed) known += ", …";
  return input_error(
      fmt::format("{} has no surface {}", document.name(), id), "surface",
      known.empty() ? "the file has no B-spline surface that could be sculpted" : "its surfaces are: " + known);
}

Expected<double> Executor::diagonal() {
  auto surface = selected();
  if (!surface) return std::unexpected(surface.error());
  return bounding_box(*(*surface)->reference).diagonal();
}

Expected<void> Executor::operator()(const SelectCommand& c) {
  std::vector<std::string> ids = c.surfaces.value_or(std::vector<std::string>{});
  if (c.surface) ids.insert(ids.begin(), *c.surface);
  if (ids.empty()) return input_error("the field is missing", "surface", "give \"surface\" or \"surfaces\"");
  std::vector<int> chosen;
  for (const std::string& id : ids) {
    auto index = find_surface(id);
    if (!index) {
      if (&id - ids.data() >= (c.surface ? 1 : 0) && index.error().where == "surface") index.error().where = "surfaces";
      return std::unexpected(index.error());
    }
    if (std::ranges::find(chosen, *index) == chosen.end()) chosen.push_back(*index);
  }
  if (c.connected) {
    std::vector<const Surface*> all;
    for (const SurfaceState& s : state.surfaces) all.push_back(s.reference.get());
    const auto found = seams_between(state, all);
    if (!found) return std::unexpected(found.error());
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      for (const Seam& seam : found->seams) {
        if (seam.kind == SeamKind::partial) continue;
        const int other = seam.a.patch == chosen[k] ? seam.b.patch : seam.b.patch == chosen[k] ? seam.a.patch : -1;
        if (other >= 0 && std::ranges::find(chosen, other) == chosen.end()) chosen.push_back(other);
      }
    }
  }
  state.selected = chosen.front();
  state.together.assign(chosen.begin() + 1, chosen.end());
  return {};
}

Expected<void> Executor::operator()(const MaterialCommand& c) {
  if (auto surface = selected(); !surface) return std::unexpected(surface.error());
  if (auto material = validated(c.material); !material) return std::unexpected(material.error());
  for (int k : state.selection()) {
    SurfaceState& s = state.surfaces[static_cast<std::size_t>(k)];
    MaterialFieldOf<2> next;
    if (c.coefficient) {
      next = s.material;
      auto field =
          sampled_field<2>({s.reference->knots(0).domain(), s.reference->knots(1).domain()}, c.counts, c.samples);
      if (!field) return std::unexpected(field.error().within("samples"));
      Coefficient<2>* const place = coefficient_named(next, *c.coefficient);
      if (place == nullptr) {
        return input_error(fmt::format("\"{}\" is not a coefficient", *c.coefficient), "coefficient",
                           "use alpha11, alpha12, alpha22, beta11, beta12, beta22, mass or damping");
      }
      *place = std::move(*field);
    } else if (!c.region) {
      next = s.material;
      for (std::size_t i = 0; i < 3; ++i) {
        next.alpha[i] = c.material.alpha[i];
        next.beta[i] = c.material.beta[i];
      }
      if (c.mass) next.mass = *c.mass;
      if (c.damping) next.damping = *c.damping;
    } else {
      const auto where = region_at(*s.reference, *c.region);
      if (!where) return std::unexpected(where.error());
      Region<2> region;
      const auto& [u, v] = *where;
      region.shape = ParameterBox<2>{{u.lower, v.lower}, {u.upper, v.upper}};
      region.falloff = c.falloff;
      // The fall-off is a fraction of the domain in either direction.
      for (std::size_t d = 0; d < 2; ++d) region.factors[d] = 1 / s.reference->knots()[d].domain().length();
      MaterialPaint<2> values;
      for (std::size_t i = 0; i < 3; ++i) {
        values.alpha[i] = c.material.alpha[i];
        values.beta[i] = c.material.beta[i];
      }
      values.mass = c.mass;
      values.damping = c.damping;
      std::vector<KnotVector> hint;
      for (std::size_t d = 0; d < 2; ++d) {
        const Interval domain = s.reference->knots()[d].domain();
        hint.push_back(*KnotVector::create(
            2, {domain.lower, domain.lower, domain.lower, domain.upper, domain.upper, domain.upper}));
      }
      auto painted = paint<2>(s.material, values, region, {hint[0], hint[1]});
      if (!painted) return std::unexpected(painted.error());
      next = std::move(*painted);
    }
    if (auto checked = validated<2>(next); !checked) return std::unexpected(checked.error());
    s.material = std::move(next);
  }
  return {};
}

Expected<void> Executor::operator()(const RestCommand& c) {
  if (auto surface = selected(); !surface) return std::unexpected(surface.error());
  for (int k : state.selection()) {
    SurfaceState& s = state.surfaces[static_cast<std::size_t>(k)];
    s.rest = s.reference = s.current;
    s.mode = c.mode;
  }
  return {};
}

Expected<void> Executor::operator()(const ScalingCommand& c) {
  state.scaling = c.mode;
  return {};
}

Expected<void> Executor::operator()(const LoadCommand& c) {
  if (!c.samples.empty() || c.counts != std::array<int, 2>{0, 0}) {
    auto surface = selected();
    if (!surface) return std::unexpected(surface.error());
    if (auto load = load_field(c, *(*surface)->reference); !load) return std::unexpected(load.error());
  }
  state.load = c;
  return {};
}

Expected<void> Executor::operator()(const LimitCommand& c) {
  if (!c.distance) {
    state.limit.reset();
    return {};
  }
  if (!(std::isfinite(*c.distance) && *c.distance > 0)) {
    return input_error(fmt::format("{} is not a distance", *c.distance), "distance",
                       "use a number > 0, or leave it out");
  }
  for (const SurfaceState& s : state.surfaces) {
    if (same_basis(*s.opened, *s.current)) continue;
    return input_error(fmt::format("weights or knots of {} were edited, and a limit is measured on those it was opened "
                                   "with",
                                   s.id),
                       "limit", "save the file and open it again, or undo those edits");
  }
  double unit = 1;
  if (c.relative) {
    const auto length = diagonal();
    if (!length) return std::unexpected(length.error());
    unit = *length;
  }
  state.limit = *c.distance * unit;
  return {};
}

}  // namespace knead
