#include "document_query.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "check.hpp"
#include "describe/text.hpp"
#include "deviation.hpp"
#include "morph.hpp"

namespace knead {
namespace {

bool is_file(const Field& field) { return field.type == &type_of<Bytes>(); }

Type without_files(const Type& type) {
  Type others = type;
  std::erase_if(others.fields, is_file);
  return others;
}

/// The next of the bytes for each file of the request, in the order of its members, which are
/// taken out of the JSON.
Expected<void> read_files(Json& request, std::string_view bytes, const Type& type, void* value) {
  const auto file = [&](const auto& member) -> const Field* {
    const Field* const field = type.find(member.first);
    return field != nullptr && is_file(*field) ? field : nullptr;
  };
  for (const auto& member : request.members) {
    const Field* const field = file(member);
    if (field == nullptr) continue;
    const double size = member.second.number;
    if (!(size >= 0 && size <= static_cast<double>(bytes.size())))
      return usage_error("there are fewer bytes than the request says", field->name);
    static_cast<Bytes*>(field->of(value))->data = bytes.substr(0, static_cast<std::size_t>(size));
    bytes.remove_prefix(static_cast<std::size_t>(size));
  }
  std::erase_if(request.members, file);
  return {};
}

}  // namespace

std::span<const DocumentQuery> document_queries() {
  static const std::vector<DocumentQuery> all = {
      document_query<CheckQuery>(), document_query<DeviationQuery>(), document_query<MorphQuery>()};
  return all;
}

Expected<DocumentAnswer> ask_document(const Session& session, std::string_view name,
                                      std::string_view request, std::string_view bytes) {
  const auto query = std::ranges::find(document_queries(), name,
                                       [](const DocumentQuery& q) { return q.request->name; });
  if (query == document_queries().end())
    return usage_error(fmt::format("nothing called \"{}\" can be asked of a document", name));
  auto json = parse_json(request);
  if (!json) return std::unexpected(std::move(json.error()));
  const auto answer = query->ask(session, [&](void* value) -> Expected<void> {
    if (auto read = read_files(*json, bytes, *query->request, value); !read) return read;
    return read_record(*json, without_files(*query->request), value);
  });
  if (!answer) return std::unexpected(answer.error());
  DocumentAnswer written{to_json(*query->answer, answer->get(), Absent::null), {}};
  for (const Field& field : query->answer->fields) {
    if (is_file(field))
      written.files.emplace_back(field.name,
                                 static_cast<const Bytes*>(field.of(answer->get()))->data);
  }
  return written;
}

std::string document_queries_json() {
  std::string all;
  for (const DocumentQuery& query : document_queries()) {
    std::string files;
    for (const Field& field : query.request->fields) {
      if (!is_file(field)) continue;
      files += fmt::format(R"({}{{"name":{},"help":{},"required":{}}})", files.empty() ? "" : ",",
                           json_text(field.name), json_text(field.help),
                           field.presence == Presence::required);
    }
    all += fmt::format(R"({}{{"name":{},"help":{},"answer":{},"request":{},"files":[{}]}})",
                       all.empty() ? "" : ",\n", json_text(query.request->name),
                       json_text(query.request->help), json_text(query.answer->help),
                       schema_of(without_files(*query.request)), files);
  }
  return "[" + all + "]";
}

}  // namespace knead
