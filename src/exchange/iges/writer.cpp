#include "writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <map>

#include "geometry.hpp"
#include "model.hpp"
#include "surface_parameters.hpp"

namespace knead::iges {
namespace {

/// A number in a field of fixed width, filled with zeros or blanks as the field was.
std::string field(std::string_view old, long long value) {
  const auto first = old.find_first_not_of(' ');
  const bool zeros = first != std::string_view::npos && old[first] == '0' && old.size() - first > 1;
  return zeros ? fmt::format("{:0{}}", value, old.size())
               : fmt::format("{:>{}}", value, old.size());
}

/// Replaces spans of a file.
class Surgeon {
 public:
  explicit Surgeon(const File& file) : file_(file) {}

  Expected<void> replace(const Replacement& r) {
    if (file_.find(r.number) == nullptr) return file_.error(r.number, "there is no such surface");
    const auto parameters = file_.parameters(r.number);
    if (!parameters) return std::unexpected(parameters.error());
    const auto values = surface_values(file_, r.number, r.surface, *parameters);
    if (!values) return std::unexpected(values.error());
    if (*values == parameters->values) return {};
    put(r.number, *parameters, *values);
    become(r.number, 128);
    return {};
  }

  Expected<void> replace(const MovedEntities& moved) {
    for (const CurveReplacement& r : moved.curves) {
      const auto parameters = file_.parameters(r.number);
      if (!parameters) return std::unexpected(parameters.error());
      const auto values = curve_values(file_, r, *parameters);
      if (!values) return std::unexpected(values.error());
      put(r.number, *parameters, *values);
      become(r.number, 126);
    }
    const auto lists = vertex_values(file_, moved.vertices);
    if (!lists) return std::unexpected(lists.error());
    for (const auto& [list, values] : *lists) put(list, *file_.parameters(list), values);
    return {};
  }

  Expected<void> replace(const OtherParameters& other) {
    const auto parameters = file_.parameters(other.number);
    if (!parameters) return std::unexpected(parameters.error());
    if (other.values == parameters->values) return {};
    put(other.number, *parameters, other.values);
    become(other.number, integer(other.values.front()).value_or(0));
    return {};
  }

  // In the order of the file: where parameter records grow or shrink, all that follow get other
  // numbers, the directory points to these, and the terminate section counts them.
  std::string bytes() {
    parameters();
    directory();
    terminate();
    std::string result;
    std::size_t at = 0;
    for (const auto& [begin, edit] : edits_) {
      result.append(file_.bytes(), at, begin - at).append(edit.text);
      at = edit.end;
    }
    return result.append(file_.bytes(), at);
  }

 private:
  struct Change {
    std::size_t count = 0;           // records that are replaced
    std::vector<std::string> lines;  // by these
  };
  struct Edit {
    std::size_t end = 0;
    std::string text;
  };

  /// Other parameters for an entity.
  void put(int number, const Parameters& parameters, const std::vector<std::string>& values) {
    const Entity& entity = *file_.find(number);
    const auto count = static_cast<std::size_t>(parameters.lines);
    const std::vector<std::string> lines = wrapped(values, file_.global(), parameters.rest);
    changes_[static_cast<std::size_t>(entity.first)] = {count, lines};
    const auto stated = static_cast<std::size_t>(std::max(entity.lines, 0));
    // Comments may follow; a count that was wrong becomes right.
    const std::size_t comments = stated > count ? stated - count : 0;
    if (lines.size() != count) counts_[number] = lines.size() + comments;
  }

  /// Another type, of form 0.
  void become(int number, int type) {
    if (file_.find(number)->type != type) types_[number] = type;
  }

  std::string line_break() const {
    const auto& records = file_.lines('P');
    const auto end = records.front().end;
    const std::string_view after = std::string_view(file_.bytes()).substr(end, 2);
    return after.starts_with("\r\n") ? "\r\n" : after.starts_with("\n") ? "\n" : "";
  }

  void put(std::size_t begin, std::size_t width, std::string text) {
    if (file_.bytes().compare(begin, width, text) != 0)
      edits_[begin] = {begin + width, std::move(text)};
  }

  void parameters() {
    const auto& records = file_.lines('P');
    const std::string eol = line_break();
    std::size_t number = 0;  // of the next record that is written
    for (std::size_t k = 0; k < records.size();) {
      moved_[k] = number + 1;
      const auto change = changes_.find(k);
      if (change == changes_.end()) {
        const std::size_t at = records[k].begin + letter_column + 1;
        const std::string_view old =
            file_.text(records[k]).substr(letter_column + 1, record_columns - letter_column - 1);
        // Numbers that were wrong stay so where nothing has moved.
        if (number != k) put(at, old.size(), field(old, static_cast<long long>(number) + 1));
        ++k;
        ++number;
        continue;
      }
      const auto& [count, lines] = change->second;
      const std::string_view first = file_.text(records[k]);
      const std::string_view sequence =
          first.substr(letter_column + 1, record_columns - letter_column - 1);
      std::string text;
      for (std::size_t n = 0; n < lines.size(); ++n) {
        text += fmt::format("{}{:<64}{}P{}", n == 0 ? "" : eol, lines[n],
                            first.substr(data_columns, letter_column - data_columns),
                            field(sequence, static_cast<long long>(++number)));
      }
      const std::size_t begin = records[k].begin, end = records[k + count - 1].end;
      edits_[begin] = {end, std::move(text)};
      k += count;
    }
    written_ = number;
  }

  void directory() {
    const auto& records = file_.lines('D');
    for (std::size_t k = 0; k < file_.entities().size(); ++k) {
      const Entity& entity = file_.entities()[k];
      const auto moved = moved_.find(static_cast<std::size_t>(std::max(entity.first, 0)));
      if (entity.first >= 0 && moved != moved_.end() && moved->second != moved->first + 1) {
        put_field(records[2 * k], 1, static_cast<long long>(moved->second));
      }
      const auto type = types_.find(File::number(k));
      if (type != types_.end()) {
        put_field(records[2 * k], 0, type->second);
        put_field(records[2 * k + 1], 0, type->second);
        put_field(records[2 * k + 1], 4, 0);
      }
      const auto count = counts_.find(File::number(k));
      if (count != counts_.end())
        put_field(records[2 * k + 1], 3, static_cast<long long>(count->second));
    }
  }

  void put_field(const Line& line, std::size_t n, long long value) {
    const std::string_view old = file_.text(line).substr(8 * n, 8);
    put(line.begin + 8 * n, old.size(), field(old, value));
  }

  /// "S0000001G0000004D0000006P0000010": the number of records of each section.
  void terminate() {
    if (file_.lines('T').empty() || written_ == file_.lines('P').size()) return;
    const Line& line = file_.lines('T').front();
    const std::string_view record = file_.text(line);
    const auto at = record.substr(0, letter_column).find('P');
    if (at == std::string_view::npos) return;
    put(line.begin + at + 1, 7, field(record.substr(at + 1, 7), static_cast<long long>(written_)));
  }

  const File& file_;
  std::map<std::size_t, Change> changes_;  // by first record
  std::map<int, std::size_t> counts_;      // new counts of the directory
  std::map<int, int> types_;               // of entities of another type than before
  std::map<std::size_t, std::size_t>
      moved_;  // the new number of each record that is kept or begins an entity
  std::map<std::size_t, Edit> edits_;  // by first byte
  std::size_t written_ = 0;
};

bool same_bits(const Surface& a, const Surface& b) {
  return a.knots() == b.knots() && std::ranges::equal(a.weights(), b.weights()) &&
         a.net() == b.net() &&
         std::memcmp(a.control_points().data(), b.control_points().data(),
                     static_cast<std::size_t>(a.control_points().size()) * sizeof(double)) == 0;
}

Expected<void> check(const File& before, const std::string& bytes,
                     std::span<const Replacement> replacements, const MovedEntities& moved,
                     std::span<const OtherParameters> others) {
  const auto failed = [&](int number, const std::string& what) {
    return numerical_error("the written file does not read back: " + what, before.label(number),
                           "report this");
  };
  const auto after = File::parse(bytes, before.name());
  if (!after) return failed(1, after.error().message());
  if (after->entities().size() != before.entities().size())
    return failed(1, "another number of entities");
  const auto lists = vertex_values(before, moved.vertices);
  if (!lists) return std::unexpected(lists.error());
  for (std::size_t k = 0; k < before.entities().size(); ++k) {
    const int number = File::number(k);
    const auto curve = std::ranges::find(moved.curves, number, &CurveReplacement::number);
    if (curve != moved.curves.end()) {
      if (!reads_back(*after, *curve)) return failed(number, "the curve differs");
      continue;
    }
    if (const auto list = lists->find(number); list != lists->end()) {
      const auto now = after->parameters(number);
      if (!now || now->values != list->second) return failed(number, "its vertices differ");
      continue;
    }
    const auto r = std::ranges::find(replacements, number, &Replacement::number);
    if (r == replacements.end()) {
      auto a = before.parameters(number);
      const auto b = after->parameters(number);
      const auto other = std::ranges::find(others, number, &OtherParameters::number);
      if (a && other != others.end()) a->values = other->values;
      if (a.has_value() != b.has_value() || (a && a->values != b->values))
        return failed(number, "its parameters differ");
      continue;
    }
    const auto outer = outer_transform(*after, number);
    const auto surface =
        outer ? read_surface(*after, number, *outer) : std::unexpected(outer.error());
    if (!surface) return failed(number, surface.error().message());
    const auto transform = transform_of(*after, number);
    const bool still = (*outer * *transform).matrix().isIdentity(0);
    const Points &p = surface->control_points(), &q = r->surface.control_points();
    const bool close = p.rows() == q.rows() &&
                       (p - q).cwiseAbs().maxCoeff() <= 1e-13 * (1 + q.cwiseAbs().maxCoeff());
    if (still ? !same_bits(*surface, r->surface) : !close)
      return failed(number, "the surface differs");
  }
  return {};
}

}  // namespace

std::vector<std::string> wrapped(const std::vector<std::string>& values, const Global& global,
                                 const std::string& rest) {
  std::vector<std::string> lines(1);
  const auto put = [&](std::string token) {
    if (lines.back().size() + token.size() > data_columns && !lines.back().empty())
      lines.emplace_back();
    while (token.size() > data_columns) {
      lines.back() = token.substr(0, data_columns);
      token.erase(0, data_columns);
      lines.emplace_back();
    }
    lines.back() += token;
  };
  for (std::size_t k = 0; k < values.size(); ++k) {
    put(values[k] + (k + 1 < values.size() ? global.separator : global.terminator));
  }
  const auto last = rest.find_last_not_of(" \t\r");
  if (last != std::string::npos) put(rest.substr(0, last + 1));
  return lines;
}

Expected<std::string> with_surfaces(const File& file, std::span<const Replacement> replacements,
                                    const MovedEntities& moved,
                                    std::span<const OtherParameters> others) {
  if (replacements.empty() && moved.curves.empty() && moved.vertices.empty() && others.empty())
    return file.bytes();
  Surgeon surgeon(file);
  for (const Replacement& r : replacements) {
    if (auto status = surgeon.replace(r); !status)
      return std::unexpected(std::move(status.error()));
  }
  if (auto status = surgeon.replace(moved); !status)
    return std::unexpected(std::move(status.error()));
  for (const OtherParameters& other : others) {
    if (auto status = surgeon.replace(other); !status)
      return std::unexpected(std::move(status.error()));
  }
  std::string bytes = surgeon.bytes();
  if (auto status = check(file, bytes, replacements, moved, others); !status)
    return std::unexpected(std::move(status.error()));
  return bytes;
}

}  // namespace knead::iges
