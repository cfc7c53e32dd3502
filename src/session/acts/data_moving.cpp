#include "data_moving.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "converting.hpp"
#include "data_holds.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/exchange/format.hpp"
#include "placing.hpp"
#include "refining.hpp"
#include "spline/onto_net.hpp"
#include "stepping.hpp"

namespace knead {

Expected<Surface> on_basis_of(const Surface& shape, const Surface& like) {
  auto finer = onto_net(shape, like);
  if (!finer) return finer;
  const auto weights = like.weights();
  return Surface::create(like.knots(), finer->control_points(), {weights.begin(), weights.end()});
}

Expected<void> put_at_rest(SceneSurface& s, std::shared_ptr<const Surface> current) {
  if (auto status = put<2>(s, std::move(current)); !status) return status;
  s.rest = s.current;
  s.velocity.resize(0, 3);
  return {};
}

namespace {

/// Puts a surface where it was fitted, on the net that this took: the new rest shape.
Expected<void> follow(Act& act, SceneSurface& s, const std::shared_ptr<const Surface>& fitted) {
  if (!same_basis(*s.current, *fitted)) {
    const auto onto = [&](const Surface& shape) { return on_basis_of(shape, *fitted); };
    if (auto changed = change_net(act, s, onto); !changed) return changed;
  }
  return put_at_rest(s, fitted);
}

}  // namespace

void note_excess(Act& act, const MorphReport& report, std::string_view command) {
  for (const MorphExcess& excess : report.above) {
    act.state.notes.push_back(fmt::format(
        "{}: {} {:.3g} of {}{} is above the {:.3g} that was wanted, at ({:.6g}, {:.6g}, {:.6g})",
        command, excess.measure, excess.found, excess.edge.empty() ? "" : excess.edge + " on ",
        excess.surface, excess.wanted, excess.place[0], excess.place[1], excess.place[2]));
  }
}

Expected<MorphReport> move_after_data(Act& act, MorphData data, MorphRequest request) {
  const auto source = saved_source(act.document, act.state);
  if (!source) return std::unexpected(source.error());
  const bool fresh = act.document.is_fresh();  // then the file's ids are not those of the scene
  const auto& surfaces = std::as_const(act.state).surfaces;
  const auto& in_file = (*source)->surfaces();
  for (auto* ids : {&request.settings.faces, &request.settings.keep}) {
    for (std::string& id : *ids) {
      const auto k = std::ranges::find(surfaces, id, &SceneSurface::id);
      if (fresh && k != surfaces.end()) id = in_file[k - surfaces.begin()].id;
    }
  }
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    SceneSurface s = surfaces[k];
    const std::string& id = fresh ? in_file[k].id : s.id;
    if (s.locked) request.settings.keep.push_back(id);
    if (holds_edge_by_name(s) && !s.visible) {
      auto region = act.regions.of(s.id);
      if (!region) return std::unexpected(region.error());
      s.visible = std::make_shared<const VisibleRegion>(*std::move(region));
    }
    auto holds = data_holds(s);
    if (!holds) return std::unexpected(holds.error());
    if (*holds) request.holds[id] = *std::move(holds);
  }
  const auto morphed = follow_data(*source, std::move(data), request, [&act](int done, int of) {
    return tell_progress(act, done, of);
  });
  if (!morphed) return std::unexpected(morphed.error());
  const auto file = open_source(morphed->bytes, (*source)->name());
  if (!file) return std::unexpected(file.error());
  if (!morphed->report.converted.empty()) {
    if (auto made = convert_surfaces(act, morphed->report.converted, 0); !made)
      return std::unexpected(made.error());
  }
  const auto& fitted = (*file)->surfaces();
  for (std::size_t k = 0; k < act.state.surfaces.size(); ++k) {
    const SceneSurface& present = std::as_const(act.state).surfaces[k];
    const auto found = fresh ? fitted.begin() + static_cast<std::ptrdiff_t>(k)
                             : std::ranges::find(fitted, present.id, &SourceSurface::id);
    if (found == fitted.end() ||
        (same_basis(*present.current, *found->surface) &&
         present.current->control_points() == found->surface->control_points())) {
      continue;
    }
    if (auto status = follow(act, act.state.surfaces[k], found->surface); !status)
      return std::unexpected(status.error());
  }
  for (const std::string& id : morphed->edges) {
    if (std::ranges::find(act.state.followed, id, &FollowedEdge::id) == act.state.followed.end())
      act.state.followed.push_back({id, {}});
  }
  act.edges_measured = true;
  const auto parted =
      parted_edges(act.state.document ? *act.state.document : act.document, act.state);
  if (!parted) return std::unexpected(parted.error());
  if (auto none = check_parted(*parted); !none) return std::unexpected(none.error());
  return morphed->report;
}

}  // namespace knead
