#include <algorithm>

#include "brep/moved_edge.hpp"
#include "colours.hpp"
#include "conversion.hpp"
#include "data.hpp"
#include "exchange/format_list.hpp"
#include "exchange/step/write/model_text.hpp"
#include "exchange/step/write/text.hpp"
#include "file.hpp"
#include "knead/base/printable.hpp"
#include "left_out.hpp"

namespace knead::detail {
namespace {

class StepSource final : public Source {
 public:
  /// \param known surfaces that keep their objects
  explicit StepSource(step::File file, std::span<const SourceSurface> known = {},
                      std::span<const SourceCurve> known_curves = {})
      : file_(std::move(file)) {
    const auto model = file_.shared_model();
    for (const brep::SplineSurface& s : model->surfaces) {
      const auto same = std::ranges::find(known, s.id, &SourceSurface::id);
      surfaces_.push_back({s.id, s.name, s.unit,
                           same == known.end() ? std::shared_ptr<const Surface>(model, &s.surface)
                                               : same->surface});
    }
    for (const brep::FreeCurve& c : model->curves) {
      const auto same = std::ranges::find(known_curves, c.id, &SourceCurve::id);
      curves_.push_back(
          {c.id, c.name, c.unit,
           same == known_curves.end() ? std::make_shared<const Curve>(c.curve) : same->curve});
    }
  }

  const std::string& name() const override { return file_.name(); }
  const std::vector<SourceSurface>& surfaces() const override { return surfaces_; }
  const std::vector<SourceCurve>& curves() const override { return curves_; }
  bool is_bound_curve(const std::string& id) const override { return file_.is_bound_curve(id); }
  const std::vector<brep::UnreadableSurface>& unreadable() const override {
    return file_.model().unreadable;
  }
  std::string_view format() const override { return "STEP"; }
  std::string schema() const override { return file_.schema(); }
  std::shared_ptr<const brep::Model> model() const override { return file_.shared_model(); }
  std::unordered_map<std::string, Colour> colours() const override {
    return step::face_colours(file_);
  }
  Expected<void> can_move_edge(const std::string& id) const override {
    const auto& boundaries = file_.data().of.boundaries;
    const auto found = boundaries.find(id);
    if (found == boundaries.end() || !found->second.fixed) return {};
    return input_error("its curve is a part of a SURFACE_CURVE, which cannot move by itself", id,
                       "hold the edge");
  }
  std::vector<std::string> remarks() const override {
    std::vector<std::string> result;
    for (const Error& warning : file_.warnings()) result.push_back("warning: " + warning.message());
    return result;
  }

  std::vector<LeftOut> left_out() const override { return step::left_out(file_); }

  Expected<std::shared_ptr<const Source>> with_splines(
      std::span<const std::string> surfaces) const override {
    auto file = step::with_splines(file_, surfaces);
    if (!file) return std::unexpected(std::move(file.error()));
    return std::make_shared<const StepSource>(*std::move(file), surfaces_, curves_);
  }

  Expected<std::string> save(std::span<const std::shared_ptr<const Surface>> surfaces,
                             std::span<const std::string> followed,
                             std::span<const std::shared_ptr<const Curve>> curves) const override {
    std::vector<brep::Replacement> replacements;
    for (std::size_t k = 0; k < surfaces.size(); ++k) {
      if (surfaces[k] != surfaces_[k].surface)
        replacements.push_back({surfaces_[k].id, *surfaces[k]});
    }
    const auto moved = brep::moved_edges(file_.model(), replacements, followed);
    if (!moved) return std::unexpected(moved.error());
    std::vector<step::CurveReplacement> replaced;
    for (std::size_t k = 0; k < curves.size(); ++k) {
      if (curves[k] != curves_[k].curve) replaced.push_back({curves_[k].id, *curves[k]});
    }
    return file_.with_surfaces(replacements, *moved, replaced);
  }

 private:
  step::File file_;
  std::vector<SourceSurface> surfaces_;
  std::vector<SourceCurve> curves_;
};

/// The first token of an exchange structure, after white space, comments and a byte order mark.
bool recognises(std::string_view bytes) {
  constexpr std::size_t enough = 4096;
  return bytes.substr(0, enough).find("ISO-10303-21") != std::string_view::npos;
}

Expected<std::shared_ptr<const Source>> open(std::string bytes, std::string name) {
  auto file = step::File::parse(std::move(bytes), std::move(name));
  if (!file) return std::unexpected(std::move(file.error()));
  return std::make_shared<const StepSource>(std::move(*file));
}

Expected<step::TextOptions> text_options(const SaveOptions& options) {
  step::TextOptions text;
  if (!options.unit.empty()) text.unit = options.unit;
  text.product = options.title;
  text.faces = options.faces;
  if (options.schema == "ap242") {
    text.schema = step::Schema::ap242;
  } else if (options.schema != "ap214") {
    return input_error("\"" + printable(options.schema) + "\" is not a schema of new STEP files",
                       {}, "use ap214 or ap242");
  }
  return text;
}

Expected<std::string> save_step(std::span<const NamedSurface> surfaces,
                                const SaveOptions& options) {
  const auto text = text_options(options);
  if (!text) return std::unexpected(text.error());
  std::vector<step::NewSurface> made;
  for (const NamedSurface& s : surfaces) made.push_back({s.name, s.surface, s.colour, s.id});
  std::vector<step::NewCurve> curves;
  for (const NamedCurve& c : options.curves) curves.push_back({c.name, c.curve, c.id});
  return step::text_of(made, *text, curves);
}

Expected<std::string> save_step_faces(const FacePlan& plan, const SaveOptions& options) {
  const auto text = text_options(options);
  if (!text) return std::unexpected(text.error());
  return step::model_text(plan, *text);
}

constexpr std::string_view step_endings[] = {".step", ".stp", ".p21"};

}  // namespace

Format step_format() {
  return {.id = "step",
          .name = "STEP",
          .endings = step_endings,
          .media_type = "model/step",
          .content = FormatContent::surfaces,
          .holds = "the surfaces themselves, and everything else of the file byte for byte",
          .writes_curves = true,
          .recognises = recognises,
          .open = open,
          .save = save_step,
          .save_faces = save_step_faces};
}

}  // namespace knead::detail
