#include "morph.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "exchange/fields/raw_numbers.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/spline/extremum.hpp"
#include "session/acts/converting.hpp"
#include "session/acts/placing.hpp"
#include "session/acts/refining.hpp"
#include "spline/onto_net.hpp"

namespace knead {

void describe(MorphCommand& c, Fields& fields) {
  fields.name("morph", "move all faces so that they follow data, and stay closed");
  fields.add("space", c.request.space,
             {.help = "the displacement as three formulas of x, y, z: \"0; 0; 0.01*x^2\"; or "
                      "\"lattice:\" and a block of space as JSON (docs/morph.md); this, `vectors`, "
                      "`from` with `to`, or `scan`",
              .omit_empty = true});
  fields.add("vectors", c.vectors,
             {.help = "displacements: what such a file holds (lines of x y z dx dy dz, CSV, VTK, "
                      "VTU or VTP), as text, or bytes as base64 after \"base64:\"",
              .omit_empty = true});
  fields.add(
      "from", c.from,
      {.help = "likewise: a mesh (STL, OBJ, PLY, VTK, XYZ) where the file is", .omit_empty = true});
  fields.add("to", c.to, {.help = "the same mesh where it should go", .omit_empty = true});
  fields.add("scan", c.scan,
             {.help = "points or a mesh in which faces should lie", .omit_empty = true});
  describe_following(c.request, fields);
}

namespace {

/// The file that a field of the command holds; none if it is empty.
Expected<std::optional<MorphFile>> file_in(const std::string& text, const char* field) {
  constexpr std::string_view coded = "base64:";
  if (text.empty()) return std::nullopt;
  if (!text.starts_with(coded)) return MorphFile{text, field};
  auto bytes = fields::base64_decoded(std::string_view(text).substr(coded.size()), text.size());
  if (!bytes) {
    return input_error("this is no base64", field,
                       "after \"base64:\" come letters, digits, \"+\", \"/\" and \"=\" alone");
  }
  return MorphFile{*std::move(bytes), field};
}

Expected<MorphData> data_of(const MorphCommand& c) {
  MorphData data;
  const std::tuple<const std::string*, const char*, std::optional<MorphFile>*> files[] = {
      {&c.vectors, "vectors", &data.vectors},
      {&c.from, "from", &data.from},
      {&c.to, "to", &data.to},
      {&c.scan, "scan", &data.scan}};
  for (const auto& [text, field, file] : files) {
    auto read = file_in(*text, field);
    if (!read) return std::unexpected(read.error());
    *file = *std::move(read);
  }
  return data;
}

/// Puts a surface where it was fitted, on the net that this took: the new rest shape.
Expected<void> follow(Act& act, SceneSurface& s, const std::shared_ptr<const Surface>& fitted) {
  if (!same_basis(*s.current, *fitted)) {
    const auto onto = [&](const Surface& shape) -> Expected<Surface> {
      auto finer = onto_net(shape, *fitted);
      if (!finer) return finer;
      // With the same bits of knots and weights: shapes are compared by them.
      const auto weights = fitted->weights();
      return Surface::create(fitted->knots(), finer->control_points(),
                             {weights.begin(), weights.end()});
    };
    if (auto changed = change_net(act, s, onto); !changed) return changed;
  }
  if (auto status = put<2>(s, fitted); !status) return status;
  s.rest = s.current;
  s.velocity.resize(0, 3);
  return {};
}

std::string summary(const MorphReport& report) {
  const std::string unit = report.unit == "unknown" ? "" : " " + report.unit;
  return fmt::format(
      "morph: {} of {} points followed, displacements up to {:.4g}{}; missing of them: rms {:.3g}, "
      "largest {:.3g}{}",
      report.used, report.points, report.before.largest, unit, report.after.rms,
      report.after.largest, unit);
}

}  // namespace

// The surfaces of the file that `morph_file` writes become those of the scene, so that what is
// saved next is that file. Everything at edges has been measured there, on the written file.
Expected<void> execute(const MorphCommand& c, Act& act) {
  auto data = data_of(c);
  if (!data) return std::unexpected(data.error());
  const auto source = saved_source(act.document, act.state);
  if (!source) return std::unexpected(source.error());
  MorphRequest request = c.request;
  for (const SceneSurface& s : std::as_const(act.state).surfaces) {
    if (s.locked) request.settings.keep.push_back(s.id);
  }
  const auto morphed = follow_data(*source, *std::move(data), request);
  if (!morphed) return std::unexpected(morphed.error());
  const auto file = open_source(morphed->bytes, (*source)->name());
  if (!file) return std::unexpected(file.error());
  if (!morphed->report.converted.empty()) {
    if (auto made = convert_surfaces(act, morphed->report.converted, 0); !made) return made;
  }
  const bool fresh = act.document.is_fresh();  // then the file's ids are not those of the scene
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
    if (auto status = follow(act, act.state.surfaces[k], found->surface); !status) return status;
  }
  for (const std::string& id : morphed->edges) {
    if (std::ranges::find(act.state.followed, id, &FollowedEdge::id) == act.state.followed.end())
      act.state.followed.push_back({id, {}});
  }
  act.edges_measured = true;
  const auto parted =
      parted_edges(act.state.document ? *act.state.document : act.document, act.state);
  if (!parted) return std::unexpected(parted.error());
  if (auto none = check_parted(*parted); !none) return none;
  act.state.notes.push_back(summary(morphed->report));
  for (const MorphExcess& excess : morphed->report.above) {
    act.state.notes.push_back(fmt::format(
        "morph: {} {:.3g} of {}{} is above the {:.3g} that was wanted, at ({:.6g}, {:.6g}, {:.6g})",
        excess.measure, excess.found, excess.edge.empty() ? "" : excess.edge + " on ",
        excess.surface, excess.wanted, excess.place[0], excess.place[1], excess.place[2]));
  }
  return {};
}

}  // namespace knead
