#include "surgeon.hpp"

#include <algorithm>
#include <bit>
#include <unordered_set>

#include "exchange/part21/part21_text.hpp"
#include "exchange/step/surfaces.hpp"
#include "print.hpp"

namespace knead::step {
namespace {

using Bits = std::array<std::uint64_t, 3>;

Bits bits_of(const Points& points, Eigen::Index row) {
  return {std::bit_cast<std::uint64_t>(points(row, 0)),
          std::bit_cast<std::uint64_t>(points(row, 1)),
          std::bit_cast<std::uint64_t>(points(row, 2))};
}

struct BitsHash {
  std::size_t operator()(const Bits& bits) const {
    std::uint64_t hash = 0;
    for (const auto word : bits) hash = (hash ^ word ^ (word >> 29)) * 0x9E3779B97F4A7C15;
    return static_cast<std::size_t>(hash ^ (hash >> 32));
  }
};
template <class T>
using ByValue = std::unordered_map<Bits, T, BitsHash>;

constexpr const char* with_knots = "B_SPLINE_SURFACE_WITH_KNOTS";

}  // namespace

bool same_bits(const Points& a, const Points& b) {
  return same_bits(std::span(a.data(), static_cast<std::size_t>(a.size())),
                   std::span(b.data(), static_cast<std::size_t>(b.size())));
}

bool same_bits(std::span<const double> a, std::span<const double> b) {
  return std::ranges::equal(a, b, [](double x, double y) {
    return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
  });
}

// Control points are references to CARTESIAN_POINTs, and one record may be several control points
// (poles, seams), or a point of something else. A record whose users all move to one place is
// rewritten in place; otherwise what moves gets a copy of it under a new name, and what stays keeps
// the old one.
Expected<void> Surgeon::move_points(std::uint32_t instance, const std::vector<std::uint32_t>& refs,
                                    const Points& old_points, const Points& new_points) {
  // The control points grouped by their record, in order.
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
    if (auto status = move(point, occurrences[point], refs, old_points, new_points, inserted);
        !status)
      return status;
  }
  if (!inserted.empty()) {
    // Right after the surface: there they are in its scope and its DATA section, whatever the scope
    // of the originals.
    const auto end = file_.instance(instance).bytes.end;
    insert(end, std::move(inserted));
  }
  return {};
}

// Changes are ranges of the old bytes with new text. They never overlap, so that one sorted pass
// joins them; insertions at one place keep their order. What is not changed keeps every byte,
// comments and spacing included.
std::string Surgeon::result() {
  std::ranges::stable_sort(changes_, {}, [](const Change& change) { return change.range.begin; });
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

// One CARTESIAN_POINT and the control points (rows) it represents.
Expected<void> Surgeon::move(std::uint32_t point, const std::vector<Eigen::Index>& rows,
                             const std::vector<std::uint32_t>& refs, const Points& old_points,
                             const Points& new_points, std::string& inserted) {
  const auto old_bits = bits_of(old_points, rows.front());
  // Distinct new positions, in order; a row that stays keeps using the record.
  std::vector<std::vector<Eigen::Index>> moved;
  bool some_stay = false;
  for (const auto row : rows) {
    const auto bits = bits_of(new_points, row);
    if (bits == old_bits) {
      some_stay = true;
      continue;
    }
    const auto same = std::find_if(moved.begin(), moved.end(), [&](const auto& group) {
      return bits_of(new_points, group.front()) == bits;
    });
    if (same == moved.end()) {
      moved.push_back({row});
    } else {
      same->push_back(row);
    }
  }
  if (moved.empty()) return {};
  const auto coordinates = reader_.coordinate_values(point);
  if (!coordinates && !is_curved(point)) return std::unexpected(coordinates.error());
  // A point by angles stays as it is: what has moved gets records of its own.
  const bool used_elsewhere = !coordinates || file_.instance(point).uses > rows.size();
  std::size_t first_new = 0;
  if (!used_elsewhere && !some_stay) {
    auto rewritings =
        rewritten(*coordinates, old_points, rows.front(), new_points, moved.front().front());
    changes_.insert(changes_.end(), std::make_move_iterator(rewritings.begin()),
                    std::make_move_iterator(rewritings.end()));
    first_new = 1;
  }
  for (std::size_t g = first_new; g < moved.size(); ++g) {
    const auto name = "#" + std::to_string(names_.next());
    inserted +=
        line_break() + (coordinates ? copy_of(point, name,
                                              rewritten(*coordinates, old_points, rows.front(),
                                                        new_points, moved[g].front()))
                                    : print_point(name, new_points.row(moved[g].front()).data()));
    for (const auto row : moved[g]) change(refs[static_cast<std::size_t>(row)], name);
  }
  return {};
}

std::vector<Surgeon::Change> Surgeon::rewritten(const Coordinates& coordinates,
                                                const Points& old_points, Eigen::Index old_row,
                                                const Points& points, Eigen::Index row) const {
  const auto bits = bits_of(points, row), old_bits = bits_of(old_points, old_row);
  std::vector<Change> result;
  for (std::size_t k = 0; k < 3; ++k) {
    if (bits[k] == old_bits[k]) continue;
    result.push_back(
        {file_.range(coordinates[k]), format_real(points(row, static_cast<Eigen::Index>(k)))});
  }
  return result;
}

// A copy of a point's record under another name, with its label, spacing and comments, and some
// coordinates replaced.
std::string Surgeon::copy_of(std::uint32_t point, const std::string& name,
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
std::string Surgeon::line_break() const {
  const auto at = file_.bytes().find_first_of("\r\n");
  if (at == std::string::npos) return {};
  return file_.bytes().compare(at, 2, "\r\n") == 0 ? "\r\n" : file_.bytes().substr(at, 1);
}

Expected<void> Surgeon::replace_surface(std::uint32_t instance,
                                        const std::vector<std::uint32_t>& refs,
                                        const Surface& before, const Surface& after) {
  const auto net = after.net();
  const auto attributes = reader_.attributes(instance, "B_SPLINE_SURFACE", 1, 3);
  for (std::size_t d = 0; d < 2; ++d) {
    const int degree = after.knots()[d].degree();
    if (degree != before.knots()[d].degree()) change(attributes[d], std::to_string(degree));
  }
  std::string inserted;
  const auto names = point_names(refs, before.control_points(), after.control_points(), inserted);
  if (!names) return std::unexpected(names.error());
  change(attributes[2],
         print_net(
             net[0], net[1], [&](int k) { return (*names)[static_cast<std::size_t>(k)]; },
             line_break()));
  if (!inserted.empty()) insert(file_.instance(instance).bytes.end, std::move(inserted));

  if (after.rational() && !before.rational()) return become_rational(instance, before, after);
  if (after.rational() && (net != before.net() || !same_bits(after.weights(), before.weights()))) {
    const auto weights = weights_parameter(reader_, instance);
    const auto text = texts(weights);
    change(weights, print_net(
                        net[0], net[1],
                        [&](int k) { return text(after.weights()[static_cast<std::size_t>(k)]); },
                        line_break()));
  }
  return write_knots(instance, before, after);
}

// The name of the record of each new control point: a record with its value is kept; records that
// only this surface used and no longer needs take over new values; the rest are new.
Expected<std::vector<std::string>> Surgeon::point_names(const std::vector<std::uint32_t>& refs,
                                                        const Points& old_points,
                                                        const Points& new_points,
                                                        std::string& inserted) {
  const auto rows = static_cast<std::size_t>(new_points.rows());
  ByValue<std::vector<std::uint32_t>> records;  // by value, one for each occurrence in the old net
  std::unordered_map<std::uint32_t, std::uint32_t> occurrences;  // of each record
  for (std::size_t k = 0; k < refs.size(); ++k) {
    const auto target = file_.value(refs[k]).target;
    records[bits_of(old_points, static_cast<Eigen::Index>(k))].push_back(target);
    ++occurrences[target];
  }
  const auto name_of = [&](std::uint32_t record) {
    return "#" + std::to_string(file_.instance(record).id);
  };
  std::vector<std::string> names(rows);
  ByValue<std::size_t> met;
  std::unordered_set<std::uint32_t> needed;
  for (std::size_t k = 0; k < rows; ++k) {
    const auto bits = bits_of(new_points, static_cast<Eigen::Index>(k));
    const auto found = records.find(bits);
    if (found == records.end()) continue;
    const auto record = found->second[std::min(met[bits]++, found->second.size() - 1)];
    needed.insert(record);
    names[k] = name_of(record);
  }
  ByValue<std::string> created;
  std::size_t at = 0;
  for (std::size_t k = 0; k < rows; ++k) {
    if (!names[k].empty()) continue;
    const auto row = static_cast<Eigen::Index>(k);
    auto& name = created[bits_of(new_points, row)];
    if (name.empty()) {
      const auto free = [&](std::uint32_t record) {
        return !needed.contains(record) && file_.instance(record).uses == occurrences[record] &&
               !is_curved(record);
      };
      while (at < refs.size() && !free(file_.value(refs[at]).target)) ++at;
      if (at < refs.size()) {
        const auto record = file_.value(refs[at]).target;
        const auto coordinates = reader_.coordinate_values(record);
        if (!coordinates) return std::unexpected(coordinates.error());
        auto rewritings =
            rewritten(*coordinates, old_points, static_cast<Eigen::Index>(at), new_points, row);
        changes_.insert(changes_.end(), std::make_move_iterator(rewritings.begin()),
                        std::make_move_iterator(rewritings.end()));
        needed.insert(record);
        name = name_of(record);
      } else {
        name = "#" + std::to_string(names_.next());
        inserted += line_break() + print_point(name, new_points.row(row).data());
      }
    }
    names[k] = name;
  }
  return names;
}

Expected<void> Surgeon::write_knots(std::uint32_t instance, const Surface& before,
                                    const Surface& after) {
  if (after.knots() == before.knots()) return {};
  const auto listed = knot_parameters(reader_, instance);
  const auto form = implied_form(reader_, instance);
  if (listed.empty() && form) {
    bool still = true;
    for (const auto& knots : after.knots())
      still = still && implied_knots(*form, knots.degree(), knots.count()) == knots;
    if (still) return {};
    std::array<PrintedKnots, 2> printed;
    for (std::size_t d = 0; d < 2; ++d)
      printed[d] = print_knots(after.knots()[d], format_shortest_real);
    const auto text = printed[0].multiplicities + "," + printed[1].multiplicities + "," +
                      printed[0].values + "," + printed[1].values + ",.UNSPECIFIED.";
    const auto& record = file_.instance(instance);
    if (record.complex) {
      insert(file_.range(*reader_.part(instance, "B_SPLINE_SURFACE")).end,
             std::string(with_knots) + "(" + text + ")");
    } else {
      // The knots follow the attributes of B_SPLINE_SURFACE, all of which must be present.
      if (const auto given = file_.children(record.first).size();
          given != attributes_of_b_spline_surface) {
        return reader_.error(instance,
                             "it has " + std::to_string(given) +
                                 " attributes, so knots cannot be listed behind them",
                             "its type has " + std::to_string(attributes_of_b_spline_surface));
      }
      const auto bytes = file_.range(record.first);
      const auto keyword = static_cast<std::uint32_t>(file_.keyword(record.first).size());
      changes_.push_back({{bytes.begin, bytes.begin + keyword}, with_knots});
      insert(bytes.end - 1, "," + text);
    }
  }
  if (form && file_.instance(instance).complex)
    change(*reader_.part(instance, implied_keyword(*form)), "");
  if (listed.empty()) return {};
  for (std::size_t d = 0; d < 2; ++d) {
    if (after.knots()[d] == before.knots()[d]) continue;
    const auto printed = print_knots(after.knots()[d], texts(listed[d + 2]));
    change(listed[d], printed.multiplicities);
    change(listed[d + 2], printed.values);
  }
  // The stated kind of knots (uniform, piecewise Bezier, …) may no longer apply.
  if (listed.size() > 4 && !same_keyword(reader_.enumeration(listed[4]), "UNSPECIFIED"))
    change(listed[4], ".UNSPECIFIED.");
  return {};
}

// Numbers that stay keep their own text, 1.0 or .1E1, found by their bits.
std::function<std::string(double)> Surgeon::texts(std::uint32_t list) const {
  std::unordered_map<std::uint64_t, std::string> known;
  for (auto k = list + 1; k < file_.value(list).next; ++k) {
    if (const auto value = reader_.real(k))
      known.emplace(std::bit_cast<std::uint64_t>(*value), file_.text(k));
  }
  return [known = std::move(known)](double value) {
    const auto found = known.find(std::bit_cast<std::uint64_t>(value));
    return found == known.end() ? format_shortest_real(value) : found->second;
  };
}

}  // namespace knead::step
