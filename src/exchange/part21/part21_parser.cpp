#include "part21_parser.hpp"

#include <algorithm>
#include <cctype>

#include "base/large_memory.hpp"
#include "exchange/foreign_format.hpp"
#include "part21_text.hpp"

namespace knead {
namespace {

// Nesting is bounded because every level takes a frame of the stack, and a file of parentheses must
// not exhaust it.
constexpr int max_depth = 200;
constexpr std::string_view start_mark = "ISO-10303-21";
constexpr std::string_view end_mark = "END-ISO-10303-21";

}  // namespace

// Recursive descent with one token of lookahead over the grammar of ISO 10303-21, in one pass.
// Values stand in one list in the order of the text, each list or typed value followed by its
// members, which spares a node per value. Names may be used before they are defined: references are
// resolved when all are known, by sorting. With `names_only_` each record is parsed and dropped at
// once, so that memory is that of the names.
Expected<void> Part21Parser::parse() {
  if (!names_only_) detail::reserve_large(parts_, file_.instances_.capacity());
  if (!file_structure() || !sort_names()) return std::unexpected(error_);
  if (names_only_) return {};
  sort_parts();
  if (!resolve()) return std::unexpected(error_);
  return {};
}

bool Part21Parser::file_structure() {
  if (file_.bytes_.starts_with("\xEF\xBB\xBF")) lexer_.set_position(3);
  advance();
  if (!at_keyword(start_mark)) {
    if (auto foreign = detail::foreign_format(file_.bytes_))
      return fail(foreign->what, foreign->remedy);
    return fail("not a STEP file: it does not begin with the line ISO-10303-21",
                "give a file in the form of ISO 10303-21");
  }
  advance();
  if (!expect_symbol(';', "ISO-10303-21") || !header_section()) return false;
  while (!at_keyword(end_mark)) {
    if (at_keyword("DATA")) {
      if (!data_section()) return false;
    } else if (at_keyword("ANCHOR")) {
      if (!anchor_section()) return false;
    } else if (at_keyword("REFERENCE")) {
      if (!reference_section()) return false;
    } else if (at_keyword("SIGNATURE")) {
      if (!signature_section()) return false;
    } else {
      section_ = "exchange structure";
      return fail_expected("DATA; or END-ISO-10303-21;");
    }
  }
  advance();
  return at_symbol(';') ? after_the_end() : expect_symbol(';', "END-ISO-10303-21");
}

bool Part21Parser::after_the_end() {
  section_ = "after END-ISO-10303-21";
  // Padding of old systems.
  auto position = lexer_.position();
  const auto rest = std::string_view(file_.bytes_).substr(position);
  const auto last = rest.find_last_not_of(std::string_view("\0\x1A \t\r\n\f\v", 8));
  if (last == std::string_view::npos) return true;
  advance();
  while (at_keyword("SIGNATURE")) {
    if (!signature_section()) return false;
  }
  if (token_.kind == Kind::end) return true;
  return fail("more text after END-ISO-10303-21;", "cut the file after END-ISO-10303-21;");
}

bool Part21Parser::header_section() {
  section_ = "HEADER section";
  if (!expect_keyword("HEADER", "begin the file with a HEADER section")) return false;
  if (!expect_symbol(';', "HEADER")) return false;
  while (!at_keyword("ENDSEC")) {
    if (token_.kind != Kind::keyword) return fail_expected("a header entity or ENDSEC;");
    if (at_keyword("DATA") || at_keyword(end_mark)) {
      return fail("the HEADER section is not closed", "put ENDSEC; behind it");
    }
    file_.header_.push_back(static_cast<std::uint32_t>(file_.values_.size()));
    if (!typed(0) || !expect_symbol(';', "a header entity")) return false;
  }
  advance();
  return expect_symbol(';', "ENDSEC");
}

bool Part21Parser::data_section() {
  section_ = "DATA section";
  advance();
  if (at_symbol('(')) {
    // Edition 2: DATA('name',('schema'));
    const auto first = static_cast<std::uint32_t>(file_.values_.size());
    if (!parameter(0)) return false;
    anchors_.push_back({first, static_cast<std::uint32_t>(file_.values_.size())});
  }
  if (!expect_symbol(';', "DATA")) return false;
  while (!at_keyword("ENDSEC")) {
    if (token_.kind == Kind::end || at_keyword(end_mark) || at_keyword("DATA")) {
      return fail("the DATA section is not closed", "put ENDSEC; behind the last entity");
    }
    if (!instance(no_instance)) return false;
    current_ = no_instance;
  }
  advance();
  return expect_symbol(';', "ENDSEC");
}

bool Part21Parser::anchor_section() {
  section_ = "ANCHOR section";
  advance();
  if (!expect_symbol(';', "ANCHOR")) return false;
  const auto first = static_cast<std::uint32_t>(file_.values_.size());
  while (!at_keyword("ENDSEC")) {
    if (token_.kind != Kind::other) return fail_expected("<name> or ENDSEC;");
    advance();
    if (!expect_symbol('=', "an anchor name") || !parameter(0)) return false;
    while (at_symbol('{')) {
      advance();
      if (token_.kind != Kind::keyword) return fail_expected("a tag name");
      advance();
      if (!expect_symbol(':', "a tag name") || !parameter(0) || !expect_symbol('}', "a tag"))
        return false;
    }
    if (!expect_symbol(';', "an anchor")) return false;
  }
  anchors_.push_back({first, static_cast<std::uint32_t>(file_.values_.size())});
  advance();
  return expect_symbol(';', "ENDSEC");
}

bool Part21Parser::reference_section() {
  section_ = "REFERENCE section";
  advance();
  if (!expect_symbol(';', "REFERENCE")) return false;
  while (!at_keyword("ENDSEC")) {
    if (token_.kind == Kind::name) {
      if (!define(token_, no_instance)) return false;
    } else if (token_.kind != Kind::other) {
      return fail_expected("#name or ENDSEC;");
    }
    advance();
    if (!expect_symbol('=', "a name")) return false;
    if (token_.kind != Kind::other) return fail_expected("<resource>");
    advance();
    if (!expect_symbol(';', "a resource")) return false;
  }
  advance();
  return expect_symbol(';', "ENDSEC");
}

bool Part21Parser::signature_section() {
  section_ = "SIGNATURE section";
  // Its content is base 64 text, not tokens.
  const auto end = file_.bytes_.find("ENDSEC", token_.end);
  if (end == std::string::npos)
    return fail("the SIGNATURE section is not closed", "put ENDSEC; behind it");
  lexer_.set_position(static_cast<std::uint32_t>(end));
  advance();
  advance();
  return expect_symbol(';', "ENDSEC");
}

bool Part21Parser::instance(std::uint32_t scope_owner) {
  if (token_.kind != Kind::name) return fail_expected("an entity #…= or ENDSEC;");
  const auto index = static_cast<std::uint32_t>(file_.instances_.size());
  if (index >= Part21File::too_much)
    return fail("too many entities", "at most 2^28 - 2 can be read: split the file");
  const std::size_t values_before = file_.values_.size();
  file_.instances_.emplace_back();
  file_.instances_[index].bytes.begin = token_.begin;
  file_.instances_[index].scope = scope_owner;
  current_ = index;
  if (!define(token_, index)) return false;
  advance();
  if (!expect_symbol('=', "an instance name")) return false;
  if (at_keyword("&SCOPE") && !scope(index)) return false;
  current_ = index;
  if (!record(index)) return false;
  file_.instances_[index].bytes.end = token_.end;
  if (names_only_ && scope_owner == no_instance) {
    // Records within a scope go with the record that owns it.
    file_.values_.resize(values_before);
    file_.instances_.clear();
    current_ = no_instance;
  }
  return expect_symbol(';', "the record");
}

bool Part21Parser::scope(std::uint32_t owner) {
  int depth = 0;
  for (auto k = owner; k != no_instance; k = file_.instances_[k].scope) ++depth;
  if (depth > max_depth)
    return fail("scopes are nested too deeply", "at most 200 levels can be read");
  advance();
  while (!at_keyword("ENDSCOPE")) {
    if (token_.kind == Kind::end || at_keyword("ENDSEC")) {
      current_ = owner;
      return fail("&SCOPE is not closed", "put ENDSCOPE before the record of the entity");
    }
    if (!instance(owner)) return false;
  }
  advance();
  current_ = owner;
  return !at_symbol('/') || export_list();
}

bool Part21Parser::export_list() {
  do {
    advance();
    if (token_.kind != Kind::name) return fail_expected("an instance name in the export list");
    advance();
  } while (at_symbol(','));
  return expect_symbol('/', "the export list");
}

bool Part21Parser::record(std::uint32_t owner) {
  const auto first = static_cast<std::uint32_t>(file_.values_.size());
  ByteRange bytes{token_.begin, token_.end};
  const bool complex = at_symbol('(');
  if (complex) {
    advance();
    while (token_.kind == Kind::keyword) {
      if (!typed(0)) return false;
    }
    bytes.end = token_.end;
    if (file_.values_.size() == first) return fail_expected("an entity name");
    if (!expect_symbol(')', "the parts of a complex entity")) return false;
  } else {
    if (token_.kind != Kind::keyword) return fail_expected("an entity name");
    if (!typed(0)) return false;
    bytes.end = closed_;
  }
  auto& instance = file_.instances_[owner];
  instance.first = first;
  instance.last = static_cast<std::uint32_t>(file_.values_.size());
  instance.record = bytes;
  instance.complex = complex;
  return true;
}

bool Part21Parser::typed(int depth) {
  const auto index = push(Part21Kind::typed, {token_.begin, token_.end});
  if (current_ != no_instance && depth == 0) {
    if (!names_only_) note_part();
    // The record being read is known by this name from here on.
    if (file_.instances_[current_].last == 0) {
      file_.instances_[current_].first = index;
      file_.instances_[current_].last = index + 1;
    }
  }
  advance();
  if (!at_symbol('(')) return fail_expected("( behind the keyword");
  const auto end = parameter_list(depth + 1);
  if (!end) return false;
  close(index);
  closed_ = token_.end;
  advance();
  return true;
}

// Leaves the token at the closing parenthesis.
bool Part21Parser::parameter_list(int depth) {
  if (depth > max_depth)
    return fail("lists are nested too deeply", "at most 200 levels can be read");
  advance();
  if (at_symbol(')')) return true;
  for (;;) {
    if (!parameter(depth)) return false;
    if (at_symbol(')')) return true;
    if (!at_symbol(',')) return fail_expected(", or ) in the parameter list");
    advance();
  }
}

bool Part21Parser::parameter(int depth) {
  const ByteRange bytes{token_.begin, token_.end};
  Part21Kind kind = Part21Kind::other;
  switch (token_.kind) {
    case Kind::integer:
      kind = Part21Kind::integer;
      break;
    case Kind::real:
      kind = Part21Kind::real;
      break;
    case Kind::string:
      kind = Part21Kind::string;
      break;
    case Kind::binary:
      kind = Part21Kind::binary;
      break;
    case Kind::enumeration:
      kind = Part21Kind::enumeration;
      break;
    case Kind::name:
      kind = Part21Kind::reference;
      break;
    case Kind::other:
      break;
    case Kind::keyword:
      return typed(depth + 1);
    default: {
      if (at_symbol('$')) {
        kind = Part21Kind::unset;
      } else if (at_symbol('*')) {
        kind = Part21Kind::derived;
      } else if (at_symbol('(')) {
        const auto index = push(Part21Kind::list, bytes);
        if (!parameter_list(depth + 1)) return false;
        close(index);
        advance();
        return true;
      } else {
        return fail_expected("a parameter");
      }
    }
  }
  push(kind, bytes);
  advance();
  return true;
}

}  // namespace knead
