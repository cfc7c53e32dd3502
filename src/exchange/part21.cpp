#include "part21.hpp"

#include <algorithm>
#include <limits>

#include "part21_parser.hpp"
#include "part21_text.hpp"

namespace knead {

Expected<Part21File> Part21File::parse(std::string bytes, std::string name) {
  Part21File file;
  file.bytes_ = std::move(bytes);
  file.name_ = std::move(name);
  if (file.bytes_.size() > std::numeric_limits<std::uint32_t>::max() - 16) {
    return std::unexpected(
        Error{ErrorKind::input, "the file is larger than 4 GB", {}, "split it into parts", file.name_, 0});
  }
  // LF, CRLF and lone CR all end a line.
  for (std::uint32_t k = 0; k < file.bytes_.size(); ++k) {
    const char c = file.bytes_[k];
    if (c == '\n' || (c == '\r' && (k + 1 == file.bytes_.size() || file.bytes_[k + 1] != '\n'))) {
      file.line_starts_.push_back(k + 1);
    }
  }
  // A record takes about 50 bytes and 8 values.
  file.instances_.reserve(file.bytes_.size() / 50);
  file.values_.reserve(file.bytes_.size() / 7);
  file.index_.reserve(file.bytes_.size() / 50);
  if (auto parsed = Part21Parser(file).parse(); !parsed) return std::unexpected(std::move(parsed.error()));
  return file;
}

std::optional<std::uint32_t> Part21File::find(std::uint64_t id) const {
  const auto found = lookup(id);
  if (found == index_.end() || found->instance == no_instance) return std::nullopt;
  return found->instance;
}

std::vector<Part21File::Name>::const_iterator Part21File::lookup(std::uint64_t id) const {
  // Most files number their entities without gaps.
  if (!index_.empty() && id - index_.front().id < index_.size()) {
    const auto guess = index_.begin() + static_cast<std::ptrdiff_t>(id - index_.front().id);
    if (guess->id == id) return guess;
  }
  const auto found = std::ranges::lower_bound(index_, id, {}, &Name::id);
  return found != index_.end() && found->id == id ? found : index_.end();
}

std::vector<std::uint32_t> Part21File::children(std::uint32_t value) const {
  std::vector<std::uint32_t> result;
  for (auto k = value + 1; k < values_[value].next; k = values_[k].next) result.push_back(k);
  return result;
}

int Part21File::line(std::uint32_t byte) const {
  const auto after = std::upper_bound(line_starts_.begin(), line_starts_.end(), byte);
  return static_cast<int>(after - line_starts_.begin()) + 1;
}

bool Part21Parser::at_keyword(std::string_view keyword) const {
  return token_.kind == Kind::keyword && same_keyword(text(), keyword);
}

bool Part21Parser::expect_symbol(char c, const char* after) {
  if (!at_symbol(c)) return fail_expected(std::string(1, c) + " behind " + after);
  advance();
  return true;
}

bool Part21Parser::expect_keyword(std::string_view keyword, const char* remedy) {
  if (!at_keyword(keyword)) return fail("no " + std::string(keyword) + " here", remedy);
  advance();
  return true;
}

std::string Part21Parser::place() const {
  if (current_ == no_instance) return section_;
  const auto& instance = file_.instances_[current_];
  std::string result = "#" + std::to_string(instance.id);
  if (instance.last > instance.first) result += " " + std::string(file_.keyword(instance.first));
  return result;
}

bool Part21Parser::fail_at(std::uint32_t byte, std::string what, std::string remedy) {
  if (failed_) return false;
  failed_ = true;
  error_ = Error{ErrorKind::input, std::move(what), place(), std::move(remedy), file_.name_, file_.line(byte)};
  return false;
}

bool Part21Parser::fail_expected(const std::string& expected) {
  if (token_.kind == Kind::bad) return fail(token_.problem, "correct the text of the file at this place");
  if (token_.kind == Kind::end)
    return fail("the file ends in the middle", expected + " is missing; get the whole file");
  auto found = std::string(text().substr(0, 40));
  for (auto& c : found) {
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  }
  return fail("'" + found + "' has no place here", "expected: " + expected);
}

std::uint32_t Part21Parser::push(Part21Kind kind, ByteRange bytes) {
  const auto index = static_cast<std::uint32_t>(file_.values_.size());
  file_.values_.push_back({kind, bytes, index + 1, no_instance});
  return index;
}

void Part21Parser::close(std::uint32_t value, std::uint32_t end) {
  file_.values_[value].bytes.end = end;
  file_.values_[value].next = static_cast<std::uint32_t>(file_.values_.size());
}

bool Part21Parser::define(const Part21Token& name, std::uint32_t index) {
  const auto id = parse_instance_name(file_.text({name.begin, name.end}));
  if (!id) return fail_at(name.begin, "an instance name above 2^63 - 1", "number the entities from 1");
  if (index != no_instance) file_.instances_[index].id = *id;
  file_.index_.push_back({*id, index, name.begin});
  file_.largest_id_ = std::max(file_.largest_id_, *id);
  return true;
}

bool Part21Parser::sort_names() {
  auto& names = file_.index_;
  const auto before = [](const Part21File::Name& a, const Part21File::Name& b) {
    return a.id != b.id ? a.id < b.id : a.byte < b.byte;
  };
  if (!std::ranges::is_sorted(names, before)) std::ranges::sort(names, before);
  // Of all names defined again, the first in the file.
  const Part21File::Name* again = nullptr;
  for (std::size_t k = 1; k < names.size(); ++k) {
    if (names[k].id == names[k - 1].id && (again == nullptr || names[k].byte < again->byte)) again = &names[k];
  }
  if (again == nullptr) return true;
  const auto& first = *std::ranges::lower_bound(names, again->id, {}, &Part21File::Name::id);
  current_ = again->instance;
  if (current_ == no_instance) section_ = "REFERENCE section";
  return fail_at(
      again->byte,
      "#" + std::to_string(again->id) + " is defined twice" +
          (first.instance == no_instance ? std::string() : ", first in line " + std::to_string(file_.line(first.byte))),
      "give one of them another name");
}

bool Part21Parser::resolve() {
  for (std::uint32_t k = 0; k < file_.instances_.size(); ++k) {
    if (!resolve_range(file_.instances_[k].first, file_.instances_[k].last, k)) return false;
  }
  section_ = "ANCHOR section";
  for (const auto& range : anchors_) {
    if (!resolve_range(range.begin, range.end, no_instance)) return false;
  }
  return true;
}

bool Part21Parser::resolve_range(std::uint32_t first, std::uint32_t last, std::uint32_t owner) {
  for (auto k = first; k < last; ++k) {
    auto& value = file_.values_[k];
    if (value.kind != Part21Kind::reference) continue;
    const auto id = parse_instance_name(file_.text(value.bytes));
    const auto found = id ? file_.lookup(*id) : file_.index_.end();
    if (!id) {
      current_ = owner;
      return fail_at(value.bytes.begin,
                     "it refers to " + std::string(file_.text(value.bytes).substr(0, 40)) + ", a name above 2^63 - 1",
                     "correct the name");
    }
    if (found == file_.index_.end()) {
      current_ = owner;
      if (file_.dangling_count_++ < Part21File::most_dangling)
        file_.dangling_.push_back({place(), *id, value.bytes.begin});
      file_.largest_id_ = std::max(file_.largest_id_, *id);  // no new record must become what is missing
      continue;
    }
    value.target = found->instance;
    if (value.target != no_instance) ++file_.instances_[value.target].uses;
  }
  return true;
}

}  // namespace knead
