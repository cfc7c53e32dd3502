#include "compressed_source.hpp"

#include "knead/exchange/file_io.hpp"

namespace knead::detail {
namespace {

/// What a compressed file holds, and the file itself, which comes back where nothing has changed.
class CompressedSource final : public Source {
 public:
  CompressedSource(std::shared_ptr<const Source> held, std::shared_ptr<const std::string> packed,
                   std::string about)
      : held_(std::move(held)), packed_(std::move(packed)), about_(std::move(about)) {}

  const std::string& name() const override { return held_->name(); }
  std::string_view format() const override { return held_->format(); }
  const std::vector<SourceSurface>& surfaces() const override { return held_->surfaces(); }
  const std::vector<brep::UnreadableSurface>& unreadable() const override {
    return held_->unreadable();
  }
  const std::vector<SourceCurve>& curves() const override { return held_->curves(); }
  bool is_bound_curve(const std::string& id) const override { return held_->is_bound_curve(id); }
  std::string schema() const override { return held_->schema(); }
  std::shared_ptr<const brep::Model> model() const override { return held_->model(); }
  std::unordered_map<std::string, Colour> colours() const override { return held_->colours(); }
  std::vector<LeftOut> left_out() const override { return held_->left_out(); }
  Expected<void> can_move_edge(const std::string& id) const override {
    return held_->can_move_edge(id);
  }

  std::vector<std::string> remarks() const override {
    std::vector<std::string> remarks = held_->remarks();
    remarks.insert(remarks.begin(), about_);
    return remarks;
  }

  Expected<std::string> save(std::span<const std::shared_ptr<const Surface>> surfaces,
                             std::span<const std::string> followed,
                             std::span<const std::shared_ptr<const Curve>> curves) const override {
    auto bytes = held_->save(surfaces, followed, curves);
    if (!bytes) return bytes;
    return compress_like(*bytes, *packed_);
  }

  Expected<std::shared_ptr<const Source>> with_splines(
      std::span<const std::string> surfaces) const override {
    auto made = held_->with_splines(surfaces);
    if (!made) return made;
    return std::make_shared<const CompressedSource>(*std::move(made), packed_, about_);
  }

 private:
  std::shared_ptr<const Source> held_;
  std::shared_ptr<const std::string> packed_;
  std::string about_;
};

Error in_file(Error error, const std::string& name) {
  error.file = name;
  return error;
}

}  // namespace

Expected<std::shared_ptr<const Source>> open_compressed(std::string bytes, std::string name,
                                                        const OpenOptions& options) {
  auto plain = uncompress(bytes, options.max_unpacked);
  if (!plain) return std::unexpected(in_file(std::move(plain.error()), name));
  auto about = describe_compression(bytes);
  if (!about) return std::unexpected(in_file(std::move(about.error()), name));
  if (compression_of(*plain) != Compression::none) {
    return std::unexpected(Error{ErrorKind::input,
                                 "the file is compressed twice",
                                 {},
                                 "unpack it once, and open what comes out",
                                 name});
  }
  auto held = open_source(*std::move(plain), std::move(name));
  if (!held) return held;
  return std::make_shared<const CompressedSource>(
      *std::move(held), std::make_shared<const std::string>(std::move(bytes)), *std::move(about));
}

}  // namespace knead::detail
