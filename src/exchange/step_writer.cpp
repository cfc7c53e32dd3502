#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <optional>
#include <unordered_map>
#include <unordered_set>

#include "knead/exchange/step_file.hpp"
#include "part21_text.hpp"
#include "step_data.hpp"
#include "step_entity.hpp"
#include "step_surfaces.hpp"

namespace knead {
namespace {

using Bits = std::array<std::uint64_t, 3>;

Bits bits_of(const Points& points, Eigen::Index row) {
  return {std::bit_cast<std::uint64_t>(points(row, 0)), std::bit_cast<std::uint64_t>(points(row, 1)),
          std::bit_cast<std::uint64_t>(points(row, 2))};
}

bool same_bits(const Points& a, const Points& b) {
  if (a.rows() != b.rows()) return false;
  for (Eigen::Index k = 0; k < a.rows(); ++k) {
    if (bits_of(a, k) != bits_of(b, k)) return false;
  }
  return true;
}

// Bytes [range) become `text`; where ranges are empty the text is inserted.
struct Change {
  ByteRange range;
  std::string text;
};

// Names for new records: above all others, so that nothing that was deleted from the file before can be meant; but not
// above what readers with 32-bit names understand, where a free name is left below.
class FreshNames {
 public:
  explicit FreshNames(const Part21File& file) : file_(file), next_(file.largest_id() + 1) {}

  std::uint64_t next() {
    constexpr std::uint64_t readable = std::numeric_limits<std::int32_t>::max();
    if (next_ > readable && !exhausted_) {
      while (file_.taken(low_) && low_ <= readable) ++low_;
      if (low_ <= readable) return low_++;
      exhausted_ = true;
    }
    return next_++;
  }

 private:
  const Part21File& file_;
  std::uint64_t next_;
  std::uint64_t low_ = 1;
  bool exhausted_ = false;
};

class Surgeon {
 public:
  explicit Surgeon(const Part21File& file) : file_(file), reader_(file), names_(file) {}

  Expected<void> edit(std::uint32_t surface, const std::vector<std::uint32_t>& refs, const Points& old_points,
                      const Points& new_points) {
    // The control points by the record they come from, in their order.
    std::unordered_map<std::uint32_t, std::vector<Eigen::Index>> occurrences;
    std::vector<std::uint32_t> order;
    for (std::size_t k = 0; k < refs.size(); ++k) {
      const auto target = file_.value(refs[k]).target;
      auto& rows = occurrences[target];
      if (rows.empty()) order.push_back(target);
      rows.push_back(static_cast<Eigen::Index>(k));
    }
    std::string inserted;
    for (const auto point : order) {
      if (auto done = move(point, occurrences[point], refs, old_points, new_points, inserted); !done) return done;
    }
    if (!inserted.empty()) {
      // Right behind the surface: there they are in its scope and its DATA section, whatever the scope of the
      // originals.
      const auto end = file_.instance(surface).bytes.end;
      changes_.push_back({{end, end}, std::move(inserted)});
    }
    return {};
  }

  [[nodiscard]] std::string result() {
    std::sort(changes_.begin(), changes_.end(),
              [](const Change& a, const Change& b) { return a.range.begin < b.range.begin; });
    std::string out;
    out.reserve(file_.bytes().size() + 64 * changes_.size());
    std::uint32_t at = 0;
    for (const auto& change : changes_) {
      out.append(file_.bytes(), at, change.range.begin - at);
      out += change.text;
      at = change.range.end;
    }
    out.append(file_.bytes(), at);
    return out;
  }

 private:
  // One CARTESIAN_POINT and the control points (rows) it stands for.
  Expected<void> move(std::uint32_t point, const std::vector<Eigen::Index>& rows,
                      const std::vector<std::uint32_t>& refs, const Points& old_points, const Points& new_points,
                      std::string& inserted) {
    const auto old_bits = bits_of(old_points, rows.front());
    // Distinct new positions, in order; a row that stays is served by the record as it is.
    std::vector<std::vector<Eigen::Index>> moved;
    bool some_stay = false;
    for (const auto row : rows) {
      const auto bits = bits_of(new_points, row);
      if (bits == old_bits) {
        some_stay = true;
        continue;
      }
      const auto same = std::find_if(moved.begin(), moved.end(),
                                     [&](const auto& group) { return bits_of(new_points, group.front()) == bits; });
      if (same == moved.end()) {
        moved.push_back({row});
      } else {
        same->push_back(row);
      }
    }
    if (moved.empty()) return {};
    const auto coordinates = reader_.coordinate_values(point);
    if (!coordinates) return std::unexpected(coordinates.error());
    const bool used_elsewhere = file_.instance(point).uses > rows.size();
    std::size_t first_new = 0;
    if (!used_elsewhere && !some_stay) {
      auto own = rewritten(*coordinates, old_bits, new_points, moved.front().front());
      changes_.insert(changes_.end(), std::make_move_iterator(own.begin()), std::make_move_iterator(own.end()));
      first_new = 1;
    }
    for (std::size_t g = first_new; g < moved.size(); ++g) {
      const auto name = "#" + std::to_string(names_.next());
      inserted += line_break() + copy_of(point, name, rewritten(*coordinates, old_bits, new_points, moved[g].front()));
      for (const auto row : moved[g])
        changes_.push_back({file_.value(refs[static_cast<std::size_t>(row)]).bytes, name});
    }
    return {};
  }

  [[nodiscard]] std::vector<Change> rewritten(const std::array<std::uint32_t, 3>& coordinates, const Bits& old_bits,
                                              const Points& points, Eigen::Index row) const {
    const auto bits = bits_of(points, row);
    std::vector<Change> result;
    for (std::size_t k = 0; k < 3; ++k) {
      if (bits[k] == old_bits[k]) continue;
      result.push_back({file_.value(coordinates[k]).bytes, format_real(points(row, static_cast<Eigen::Index>(k)))});
    }
    return result;
  }

  // The record of a point under another name, with its label, spacing and comments, and some coordinates replaced.
  [[nodiscard]] std::string copy_of(std::uint32_t point, const std::string& name,
                                    const std::vector<Change>& changes) const {
    const auto& instance = file_.instance(point);
    std::string text = name + "=";
    std::uint32_t at = instance.record.begin;
    for (const auto& change : changes) {
      text += file_.text(ByteRange{at, change.range.begin});
      text += change.text;
      at = change.range.end;
    }
    text += file_.text(ByteRange{at, instance.record.end});
    return text + ";";
  }

  // As the file has them: LF, CRLF, or none at all.
  [[nodiscard]] std::string line_break() const {
    const auto at = file_.bytes().find_first_of("\r\n");
    if (at == std::string::npos) return {};
    return file_.bytes().compare(at, 2, "\r\n") == 0 ? "\r\n" : file_.bytes().substr(at, 1);
  }

  const Part21File& file_;
  StepReader reader_;
  FreshNames names_;
  std::vector<Change> changes_;
};

Error for_file(Error error, const std::string& file) {
  error.file = file;
  return error;
}

// Reads the result again: every surface must hold what was asked for, bit for bit, or what it held before.
Expected<void> check(const std::string& bytes, const StepFile::Data& before,
                     const std::unordered_map<std::size_t, const Points*>& wanted) {
  const auto broken = [&](const std::string& id) {
    return std::unexpected(Error{ErrorKind::numerical, "internal: the written file does not read back as it should", id,
                                 "please report this file", before.records.name(), 0});
  };
  const auto parsed = Part21File::parse(bytes, before.records.name());
  if (!parsed) return broken(parsed.error().message());
  const StepReader reader(*parsed);
  for (std::size_t k = 0; k < before.surfaces.size(); ++k) {
    const auto& old = before.surfaces[k];
    const auto instance = parsed->find(before.records.instance(before.surface_instances[k]).id);
    if (!instance) return broken(old.id);
    const auto read = read_b_spline_surface(reader, *instance);
    const auto found = wanted.find(k);
    const auto& points = found == wanted.end() ? old.surface.control_points() : *found->second;
    if (!read || !same_bits(read->surface.control_points(), points) || read->surface.knots() != old.surface.knots()) {
      return broken(old.id);
    }
  }
  return {};
}

}  // namespace

Expected<std::string> StepFile::with_control_points(std::span<const StepEdit> edits) const {
  const auto& data = *data_;
  std::unordered_map<std::size_t, const Points*> wanted;
  Surgeon surgeon(data.records);
  bool changed = false;
  for (const auto& edit : edits) {
    const auto found = data.surface_index.find(edit.id);
    if (found == data.surface_index.end()) {
      return std::unexpected(for_file({ErrorKind::input, "no readable B-spline surface has this name", edit.id,
                                       "name one of those that `info` lists"},
                                      name()));
    }
    const auto& surface = data.surfaces[found->second].surface;
    if (!wanted.emplace(found->second, &edit.control_points).second) {
      return std::unexpected(
          for_file({ErrorKind::input, "edited twice", edit.id, "give one edit per surface"}, name()));
    }
    if (auto valid = surface.with_control_points(edit.control_points); !valid) {
      return std::unexpected(for_file(valid.error().within(edit.id), name()));
    }
    if (same_bits(edit.control_points, surface.control_points())) continue;
    changed = true;
    if (auto done = surgeon.edit(data.surface_instances[found->second], data.control_point_refs[found->second],
                                 surface.control_points(), edit.control_points);
        !done) {
      return std::unexpected(std::move(done.error()));
    }
  }
  if (!changed) return bytes();
  auto result = surgeon.result();
  if (auto checked = check(result, data, wanted); !checked) return std::unexpected(std::move(checked.error()));
  return result;
}

}  // namespace knead
