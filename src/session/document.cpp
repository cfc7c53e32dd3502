#include "knead/session/document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <span>

#include "knead/exchange/file_io.hpp"
#include "knead/exchange/format.hpp"
#include "scene/shape.hpp"

namespace knead {

Document Document::from(std::shared_ptr<const Source> source) {
  Document document;
  document.name_ = source->name();
  document.source_ = std::move(source);
  return document;
}

Document Document::fresh(std::string name, std::string unit) {
  Document document;
  document.name_ = std::move(name);
  document.unit_ = std::move(unit);
  return document;
}

Expected<Document> Document::open(const std::filesystem::path& path, const OpenOptions& options) {
  auto bytes = read_file(path);
  if (!bytes) return std::unexpected(std::move(bytes.error()));
  auto source = open_source(*std::move(bytes), path.string(), options);
  if (!source) return std::unexpected(std::move(source.error()));
  return from(*std::move(source));
}

const std::vector<DocumentSurface>& Document::surfaces() const {
  static const std::vector<DocumentSurface> none;
  return source_ ? source_->surfaces() : none;
}

const std::vector<SourceCurve>& Document::curves() const {
  static const std::vector<SourceCurve> none;
  return source_ ? source_->curves() : none;
}

Expected<Document> Document::with_splines(std::span<const std::string> surfaces) const {
  if (!source_) {
    return input_error("only surfaces of a file can be converted", name_,
                       "begin with a file, or make B-spline surfaces with the command new");
  }
  auto source = source_->with_splines(surfaces);
  if (!source) return std::unexpected(std::move(source.error()));
  Document document = *this;
  document.source_ = *std::move(source);
  document.converted_.insert(document.converted_.end(), surfaces.begin(), surfaces.end());
  return document;
}

namespace {

bool same_bits(std::span<const double> a, std::span<const double> b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}

bool same_bits(const Surface& a, const Surface& b) {
  const auto coordinates = [](const Surface& s) {
    return std::span<const double>(s.control_points().data(),
                                   static_cast<std::size_t>(s.control_points().size()));
  };
  for (int d = 0; d < 2; ++d) {
    if (a.knots(d).degree() != b.knots(d).degree() ||
        !same_bits(a.knots(d).knots(), b.knots(d).knots()))
      return false;
  }
  return same_bits(coordinates(a), coordinates(b)) && same_bits(a.weights(), b.weights());
}

}  // namespace

Expected<std::string> Document::save(std::span<const DocumentSurface> surfaces,
                                     std::span<const std::string> followed,
                                     std::span<const DocumentBody> bodies) const {
  if (source_) {
    std::vector<std::shared_ptr<const Surface>> present;
    const auto& opened = source_->surfaces();
    for (std::size_t k = 0; k < surfaces.size(); ++k) {
      // What has come back to what it was keeps its bytes, such as a surface that was refined and
      // coarsened.
      const bool back = k < opened.size() && same_bits(*surfaces[k].surface, *opened[k].surface);
      present.push_back(back ? opened[k].surface : surfaces[k].surface);
    }
    std::vector<std::shared_ptr<const Curve>> curves;
    for (const SourceCurve& c : source_->curves()) {
      const auto body = std::ranges::find(bodies, c.id, &DocumentBody::id);
      const auto* curve =
          body == bodies.end() ? nullptr : std::get_if<std::shared_ptr<const Curve>>(&body->shape);
      curves.push_back(curve != nullptr ? *curve : c.curve);
    }
    return source_->save(present, followed, curves);
  }
  return save_as(*find_format("step"), surfaces, bodies);
}

Expected<std::string> Document::save_as(const Format& format,
                                        std::span<const DocumentSurface> surfaces,
                                        std::span<const DocumentBody> bodies,
                                        SaveOptions options) const {
  if (model() != nullptr) {
    return input_error(
        fmt::format("a new file would lose the faces of this {} file", source_->format()), {},
        "write it in its own format");
  }
  if (format.save == nullptr)
    return input_error(fmt::format("new {} files cannot be written", format.name), {},
                       "write STEP");
  std::vector<NamedSurface> made;
  for (const DocumentSurface& s : surfaces) made.push_back({s.name, *s.surface, {}, s.id});
  options.unit = !surfaces.empty() ? surfaces.front().unit
                 : !bodies.empty() ? bodies.front().unit
                                   : unit_;
  for (const DocumentBody& body : bodies) {
    if (const auto* curve = std::get_if<std::shared_ptr<const Curve>>(&body.shape)) {
      options.curves.push_back({body.name, **curve, body.id});
      continue;
    }
    auto sides = sides_of(*std::get<std::shared_ptr<const Volume>>(body.shape));
    if (!sides) return std::unexpected(sides.error().within(body.id));
    static constexpr const char* names[] = {"u0", "u1", "v0", "v1", "w0", "w1"};
    for (std::size_t k = 0; k < sides->size(); ++k) {
      made.push_back({fmt::format("{} {}", body.name, names[k]),
                      std::move((*sides)[k]),
                      {},
                      fmt::format("{} {}", body.id, names[k])});
    }
  }
  options.title = name_;
  if (options.unit == "unknown") options.unit = "mm";
  return save_surfaces(made, format, options);
}

}  // namespace knead
