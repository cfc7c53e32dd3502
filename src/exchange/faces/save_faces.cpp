#include "knead/exchange/save_model.hpp"

#include <fmt/format.h>

#include "face_plan.hpp"

namespace knead {

bool holds_faces(const Format& format) { return format.save_faces != nullptr; }

Expected<FacesFile> save_faces(const Source& source, const Format& format,
                               const SaveOptions& options, bool convert) {
  if (!holds_faces(format))
    return input_error(fmt::format("new {} files hold no faces", format.name), {},
                       "write STEP or IGES");
  using detail::Conversion;
  const Conversion conversion = !convert                     ? Conversion::none
                                : format.keeps_whole_spheres ? Conversion::all_but_whole_spheres
                                                             : Conversion::all;
  auto plan = detail::face_plan(source, options.unit.empty() ? "mm" : options.unit, conversion);
  if (!plan) return std::unexpected(std::move(plan.error()));
  auto bytes = format.save_faces(*plan, options);
  if (!bytes) return std::unexpected(std::move(bytes.error()));
  return FacesFile{*std::move(bytes), plan->faces,  plan->solids,
                   plan->surfaces,    plan->curves, std::move(plan->left_out)};
}

}  // namespace knead
