#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "foreign_format.hpp"
#include "format_list.hpp"
#include "iges_step.hpp"
#include "iges_text.hpp"
#include "iges_writer.hpp"
#include "knead/exchange/step_file.hpp"
#include "moved_edge.hpp"

namespace knead::detail {
namespace {

class IgesSource final : public Source {
 public:
  IgesSource(iges::File file, step::File view, std::vector<UnreadableSurface> unreadable, iges::EdgeSources edges)
      : file_(std::move(file)), view_(std::move(view)), unreadable_(std::move(unreadable)), edges_(std::move(edges)) {
    for (const step::SurfaceEntity& s : view_.surfaces()) {
      surfaces_.push_back({s.id, s.name, file_.global().unit, std::make_shared<const Surface>(s.surface)});
    }
    const auto& worse = view_.unreadable_surfaces();
    unreadable_.insert(unreadable_.end(), worse.begin(), worse.end());
  }

  const std::string& name() const override { return file_.name(); }
  std::string_view format() const override { return "IGES"; }
  const std::vector<SourceSurface>& surfaces() const override { return surfaces_; }
  const std::vector<UnreadableSurface>& unreadable() const override { return unreadable_; }
  const step::File* step_file() const override { return &view_; }
  Expected<void> can_move_edge(const std::string& id) const override { return iges::can_move(file_, edges_, id); }

  std::vector<std::string> remarks() const override {
    const iges::Global& global = file_.global();
    std::vector<std::string> result;
    if (!global.system.empty()) result.push_back("written by " + global.system);
    if (global.scale != 1)
      result.push_back(fmt::format("scale {:.6g}: lengths of the model over real ones", global.scale));
    if (global.resolution > 0) result.push_back(fmt::format("resolution {:.6g}", global.resolution));
    std::map<int, int> counts;
    for (const iges::Entity& entity : file_.entities()) ++counts[entity.type];
    for (const auto& [type, count] : counts) {
      const std::string_view name = iges::type_name(type);
      result.push_back(fmt::format("{} x {}{}", count, type, name.empty() ? "" : fmt::format(" ({})", name)));
    }
    return result;
  }

  Expected<std::string> save(std::span<const std::shared_ptr<const Surface>> surfaces,
                             std::span<const std::string> followed,
                             std::span<const std::shared_ptr<const Curve>> /*curves*/) const override {
    std::vector<iges::Replacement> replacements;
    std::vector<step::Replacement> changed;
    for (std::size_t k = 0; k < surfaces.size(); ++k) {
      if (surfaces[k] == surfaces_[k].surface) continue;
      replacements.push_back({iges::integer(std::string_view(surfaces_[k].id).substr(1)).value_or(0), *surfaces[k]});
      if (!followed.empty()) changed.push_back({surfaces_[k].id, *surfaces[k]});
    }
    const auto moved = step::moved_edges(view_, changed, followed);
    if (!moved) return std::unexpected(moved.error());
    const auto entities = iges::moved_entities(edges_, *moved);
    if (!entities) return std::unexpected(entities.error());
    return iges::with_surfaces(file_, replacements, *entities);
  }

 private:
  iges::File file_;
  step::File view_;
  std::vector<UnreadableSurface> unreadable_;
  iges::EdgeSources edges_;
  std::vector<SourceSurface> surfaces_;
};

Expected<std::shared_ptr<const Source>> open_iges(std::string bytes, std::string name) {
  auto file = iges::File::parse(std::move(bytes), std::move(name));
  if (!file) return std::unexpected(std::move(file.error()));
  auto view = iges::step_view(*file);
  auto step = step::File::parse(std::move(view.text), file->name());
  if (!step) return std::unexpected(std::move(step.error()));
  return std::make_shared<const IgesSource>(*std::move(file), *std::move(step), std::move(view.unreadable),
                                            std::move(view.sources));
}

constexpr std::string_view iges_endings[] = {".igs", ".iges"};

}  // namespace

Format iges_format() {
  return {.id = "iges",
          .name = "IGES",
          .endings = iges_endings,
          .media_type = "model/iges",
          .content = FormatContent::surfaces,
          .holds = "the surfaces themselves, and everything else of an opened file byte for byte",
          .writes_curves = true,
          .recognises = is_iges,
          .open = open_iges,
          .save = iges::text_of};
}

}  // namespace knead::detail
