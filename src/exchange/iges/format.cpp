#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "brep/moved_edge.hpp"
#include "conversion.hpp"
#include "exchange/foreign_format.hpp"
#include "exchange/format_list.hpp"
#include "left_out.hpp"
#include "model.hpp"
#include "model_text.hpp"
#include "text.hpp"
#include "writer.hpp"

namespace knead::detail {
namespace {

class IgesSource final : public Source {
 public:
  /// \param known surfaces that keep their objects
  IgesSource(iges::File file, iges::ReadModel read, std::span<const SourceSurface> known = {})
      : file_(std::move(file)),
        model_(std::make_shared<const brep::Model>(std::move(read.model))),
        edges_(std::move(read.sources)),
        unplaced_(std::move(read.unplaced)) {
    for (const brep::SplineSurface& s : model_->surfaces) {
      const auto same = std::ranges::find(known, s.id, &SourceSurface::id);
      surfaces_.push_back({s.id, s.name, file_.global().unit,
                           same == known.end() ? std::shared_ptr<const Surface>(model_, &s.surface)
                                               : same->surface});
    }
  }

  const std::string& name() const override { return file_.name(); }
  std::string_view format() const override { return "IGES"; }
  const std::vector<SourceSurface>& surfaces() const override { return surfaces_; }
  const std::vector<brep::UnreadableSurface>& unreadable() const override {
    return model_->unreadable;
  }
  std::shared_ptr<const brep::Model> model() const override { return model_; }
  Expected<void> can_move_edge(const std::string& id) const override {
    return iges::can_move(file_, edges_, id);
  }

  Expected<std::shared_ptr<const Source>> with_splines(
      std::span<const std::string> surfaces) const override {
    auto bytes = iges::with_splines(file_, *model_, surfaces);
    if (!bytes) return std::unexpected(std::move(bytes.error()));
    auto file = iges::File::parse(*std::move(bytes), name());
    if (!file) return std::unexpected(std::move(file.error()));
    auto read = iges::read_model(*file);
    return std::make_shared<const IgesSource>(*std::move(file), std::move(read), surfaces_);
  }

  std::vector<LeftOut> left_out() const override {
    return iges::left_out(file_, *model_, unplaced_);
  }

  std::vector<std::string> remarks() const override {
    const iges::Global& global = file_.global();
    std::vector<std::string> result;
    if (!global.system.empty()) result.push_back("written by " + global.system);
    if (global.scale != 1)
      result.push_back(
          fmt::format("scale {:.6g}: lengths of the model over real ones", global.scale));
    if (global.resolution > 0)
      result.push_back(fmt::format("resolution {:.6g}", global.resolution));
    std::map<int, int> counts;
    for (const iges::Entity& entity : file_.entities()) ++counts[entity.type];
    for (const auto& [type, count] : counts) {
      const std::string_view name = iges::type_name(type);
      result.push_back(
          fmt::format("{} x {}{}", count, type, name.empty() ? "" : fmt::format(" ({})", name)));
    }
    return result;
  }

  Expected<std::string> save(
      std::span<const std::shared_ptr<const Surface>> surfaces,
      std::span<const std::string> followed,
      std::span<const std::shared_ptr<const Curve>> /*curves*/) const override {
    std::vector<iges::Replacement> replacements;
    std::vector<brep::Replacement> changed;
    for (std::size_t k = 0; k < surfaces.size(); ++k) {
      if (surfaces[k] == surfaces_[k].surface) continue;
      replacements.push_back(
          {iges::integer(std::string_view(surfaces_[k].id).substr(1)).value_or(0), *surfaces[k]});
      if (!followed.empty()) changed.push_back({surfaces_[k].id, *surfaces[k]});
    }
    const auto moved = brep::moved_edges(*model_, changed, followed);
    if (!moved) return std::unexpected(moved.error());
    const auto entities = iges::moved_entities(edges_, *moved);
    if (!entities) return std::unexpected(entities.error());
    return iges::with_surfaces(file_, replacements, *entities);
  }

 private:
  iges::File file_;
  std::shared_ptr<const brep::Model> model_;
  iges::EdgeSources edges_;
  std::set<int> unplaced_;
  std::vector<SourceSurface> surfaces_;
};

Expected<std::shared_ptr<const Source>> open_iges(std::string bytes, std::string name) {
  auto file = iges::File::parse(std::move(bytes), std::move(name));
  if (!file) return std::unexpected(std::move(file.error()));
  auto read = iges::read_model(*file);
  return std::make_shared<const IgesSource>(*std::move(file), std::move(read));
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
          .keeps_whole_spheres = true,
          .recognises = is_iges,
          .open = open_iges,
          .save = iges::text_of,
          .save_faces = iges::model_text};
}

}  // namespace knead::detail
