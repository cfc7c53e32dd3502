#include "check.hpp"

#include <algorithm>
#include <unordered_set>
#include <utility>

#include "exchange/part21/part21_lexer.hpp"
#include "exchange/part21/part21_text.hpp"
#include "exchange/step/curves.hpp"
#include "exchange/step/surfaces.hpp"

namespace knead::step {
namespace {

constexpr std::size_t enough_text = 4U << 20U;  // of records to be parsed at a time

/// Compares the geometry in parsed bytes with what is wanted.
class Check {
 public:
  Check(const File::Data& before, const WantedSurfaces& surfaces, const WantedCurves& curves)
      : before_(before), surfaces_(surfaces), curves_(curves) {}

  [[nodiscard]] std::size_t surface_count() const { return before_.model->surfaces.size(); }
  [[nodiscard]] std::size_t count() const { return surface_count() + before_.model->curves.size(); }
  /// The name of the record of one: the surfaces, then the curves.
  [[nodiscard]] std::uint64_t id(std::size_t k) const {
    const auto instance =
        k < surface_count() ? before_.of.surfaces[k] : before_.of.curves[k - surface_count()];
    return before_.records.instance(instance).id;
  }
  // Read back by the code that reads files, and compared bit for bit: a mistake in the surgery must
  // not reach a file, and one in printing numbers would show here as well.
  [[nodiscard]] bool right(const Part21File& parsed, std::size_t k) const {
    const Reader reader(parsed);
    const auto instance = parsed.find(id(k));
    if (!instance) return false;
    if (k < surface_count()) {
      const auto read = read_b_spline_surface(reader, *instance);
      const auto found = surfaces_.find(k);
      return read && same_spline(read->surface, found == surfaces_.end()
                                                    ? before_.model->surfaces[k].surface
                                                    : *found->second);
    }
    const std::size_t c = k - surface_count();
    const auto read = read_b_spline_curve(reader, *instance);
    const auto found = curves_.find(c);
    return read && same_spline(*read, found == curves_.end() ? before_.model->curves[c].curve
                                                             : *found->second);
  }
  [[nodiscard]] std::unexpected<Error> broken(const std::string& place) const {
    return std::unexpected(Error{ErrorKind::numerical,
                                 "internal: the written file does not read back as it should",
                                 place, "please report this file", before_.records.name(), 0});
  }

 private:
  const File::Data& before_;
  const WantedSurfaces& surfaces_;
  const WantedCurves& curves_;
};

/// A record and those that it refers to itself, unless they are there already.
/// A surface's record and its points are enough to read it, unless angles need the contexts of the
/// file or SCOPEs hide names. So large files are checked by some megabytes at a time, not parsed a
/// second time as a whole.
void gather(const Part21Names& names, std::uint64_t id, std::unordered_set<std::uint64_t>& there,
            std::string& text) {
  const auto record = names.record(id);
  if (!record) return;
  const auto add = [&](std::uint64_t name, std::string_view bytes) {
    if (there.insert(name).second) (text += bytes) += '\n';
  };
  add(id, *record);
  Part21Lexer lexer(*record);
  static_cast<void>(lexer.next());  // its own name
  for (auto token = lexer.next();
       token.kind != Part21Token::Kind::end && token.kind != Part21Token::Kind::bad;
       token = lexer.next()) {
    if (token.kind != Part21Token::Kind::name) continue;
    const auto name = parse_instance_name(record->substr(token.begin, token.end - token.begin));
    const auto target = name ? names.record(*name) : std::nullopt;
    if (target) add(*name, *target);
  }
}

/// Whether what a surface or curve is depends only on its record and those that it refers to.
bool stands_alone(const Part21File& records) {
  return records.named({"CYLINDRICAL_POINT", "SPHERICAL_POINT"}).empty() &&
         std::ranges::all_of(records.instances(),
                             [](const Part21Instance& k) { return k.scope == no_instance; });
}

}  // namespace

Expected<std::string> checked(std::string bytes, const File::Data& before,
                              const WantedSurfaces& surfaces, const WantedCurves& curves) {
  const Check check(before, surfaces, curves);
  if (!stands_alone(before.records)) {
    auto parsed = Part21File::parse(std::move(bytes), before.records.name());
    if (!parsed) return check.broken(parsed.error().message());
    for (std::size_t k = 0; k < check.count(); ++k) {
      if (!check.right(*parsed, k)) return check.broken("#" + std::to_string(check.id(k)));
    }
    return std::move(*parsed).take_bytes();
  }
  const auto names = Part21Names::parse(bytes, before.records.name());
  if (!names) return check.broken(names.error().message());
  for (std::size_t first = 0; first < check.count();) {
    std::string text = "ISO-10303-21;HEADER;ENDSEC;DATA;\n";
    std::unordered_set<std::uint64_t> there;
    std::size_t last = first;
    while (last < check.count() && text.size() < enough_text)
      gather(*names, check.id(last++), there, text);
    const auto parsed =
        Part21File::parse(std::move(text += "ENDSEC;END-ISO-10303-21;\n"), before.records.name());
    if (!parsed) return check.broken(parsed.error().message());
    for (; first < last; ++first) {
      if (!check.right(*parsed, first)) return check.broken("#" + std::to_string(check.id(first)));
    }
  }
  return bytes;
}

}  // namespace knead::step
