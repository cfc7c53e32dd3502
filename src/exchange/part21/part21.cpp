#include "part21.hpp"

#include <algorithm>
#include <limits>
#include <span>

#include "base/large_memory.hpp"
#include "part21_parser.hpp"
#include "part21_text.hpp"

namespace knead {

Expected<Part21File> Part21File::parse(std::string bytes, std::string name) {
  Part21File file;
  file.bytes_ = std::move(bytes);
  file.name_ = std::move(name);
  if (file.bytes_.size() > std::numeric_limits<std::uint32_t>::max() - 16) {
    return std::unexpected(Error{ErrorKind::input,
                                 "the file is larger than 4 GB",
                                 {},
                                 "split it into parts",
                                 file.name_,
                                 0});
  }
  file.reserve();
  if (auto parsed = Part21Parser(file).parse(); !parsed)
    return std::unexpected(std::move(parsed.error()));
  return file;
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
  error_ = Error{ErrorKind::input,  std::move(what), place(),
                 std::move(remedy), file_.name_,     file_.line(byte)};
  return false;
}

bool Part21Parser::fail_expected(const std::string& expected) {
  if (token_.kind == Kind::bad)
    return fail(token_.problem, "correct the text of the file at this place");
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
  const auto length =
      kind == Part21Kind::reference ? Part21File::too_much : bytes.end - bytes.begin;
  file_.values_.push_back({bytes.begin, static_cast<std::uint32_t>(kind) & 15U,
                           std::min(length, Part21File::too_much) & Part21File::too_much});
  return index;
}

void Part21Parser::close(std::uint32_t value) {
  const auto next = static_cast<std::uint32_t>(file_.values_.size());
  file_.values_[value].content =
      std::min(next - value, Part21File::too_much) & Part21File::too_much;
  if (next - value >= Part21File::too_much) file_.wide_[value] = next;
}

bool Part21Parser::define(const Part21Token& name, std::uint32_t index) {
  const auto id = parse_instance_name(file_.text({name.begin, name.end}));
  if (!id)
    return fail_at(name.begin, "an instance name above 2^63 - 1", "number the entities from 1");
  if (names_only_) {
    file_.index_.push_back({*id, no_instance, name.begin});
    if (index != no_instance) file_.instances_[index].id = *id;
    return true;
  }
  const bool ascends = index != no_instance && (index == 0 || *id > file_.largest_id_);
  if (file_.index_.empty() && !ascends) {
    const auto before = index == no_instance ? file_.instances_.size() : index;
    for (std::uint32_t k = 0; k < before; ++k)
      file_.index_.push_back({file_.instances_[k].id, k, file_.instances_[k].bytes.begin});
  }
  if (index != no_instance) file_.instances_[index].id = *id;
  if (!file_.index_.empty() || !ascends) file_.index_.push_back({*id, index, name.begin});
  file_.largest_id_ = std::max(file_.largest_id_, *id);
  return true;
}

void Part21Parser::note_part() {
  const auto bytes = ByteRange{token_.begin, token_.end};
  const auto written = file_.text(bytes);
  const std::size_t size = written.size();
  const auto byte = [&](std::size_t k) {
    return static_cast<std::size_t>(static_cast<unsigned char>(written[k]));
  };
  const std::size_t slot =
      (size + 7 * byte(0) + 31 * byte(size / 2) + 127 * byte(size - 1)) % recent_.size();
  auto& [text, number] = recent_[slot];
  if (text != written) {
    const auto [known, fresh] =
        keyword_numbers_.try_emplace(written, static_cast<std::uint32_t>(file_.keywords_.size()));
    if (fresh) file_.keywords_.push_back({bytes});
    text = written;
    number = known->second;
  }
  parts_.emplace_back(number, current_);
}

// Gathers the instances of each keyword.
void Part21Parser::sort_parts() {
  auto& keywords = file_.keywords_;
  for (const auto& [number, instance] : parts_) ++keywords[number].last;
  std::uint32_t at = 0;
  for (auto& keyword : keywords) {
    keyword.first = at;
    at += keyword.last;
    keyword.last = keyword.first;
  }
  detail::reserve_large(file_.named_, parts_.size());
  file_.named_.resize(parts_.size());
  for (const auto& [number, instance] : parts_) file_.named_[keywords[number].last++] = instance;
  // Those within a &SCOPE come before the record that they belong to.
  for (const auto& keyword : keywords) {
    const std::span named(file_.named_.begin() + keyword.first,
                          file_.named_.begin() + keyword.last);
    if (!std::ranges::is_sorted(named)) std::ranges::sort(named);
  }
  std::ranges::sort(keywords, KeywordOrder(),
                    [this](const auto& keyword) { return file_.text(keyword.bytes); });
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
    if (names[k].id == names[k - 1].id && (again == nullptr || names[k].byte < again->byte))
      again = &names[k];
  }
  if (again == nullptr) return true;
  const auto& first = *std::ranges::lower_bound(names, again->id, {}, &Part21File::Name::id);
  current_ = again->instance;
  if (current_ == no_instance) section_ = "REFERENCE section";
  return fail_at(again->byte,
                 "#" + std::to_string(again->id) + " is defined twice" +
                     (first.instance == no_instance
                          ? std::string()
                          : ", first in line " + std::to_string(file_.line(first.byte))),
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
    if (static_cast<Part21Kind>(value.kind) != Part21Kind::reference) continue;
    const auto id = parse_instance_name(file_.text(k));
    if (!id) {
      current_ = owner;
      return fail_at(
          value.begin,
          "it refers to " + std::string(file_.text(k).substr(0, 40)) + ", a name above 2^63 - 1",
          "correct the name");
    }
    const auto found = file_.lookup(*id);
    if (!found) {
      current_ = owner;
      if (file_.dangling_count_++ < Part21File::most_dangling)
        file_.dangling_.push_back({place(), *id, value.begin});
      file_.largest_id_ =
          std::max(file_.largest_id_, *id);  // no new record must become what is missing
      continue;
    }
    if (*found == no_instance) continue;
    value.content = *found & Part21File::too_much;
    ++file_.instances_[*found].uses;
  }
  return true;
}

}  // namespace knead
