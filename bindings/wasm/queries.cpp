#include "queries.hpp"

#include <algorithm>
#include <iterator>

namespace knead::studio {

// Each is a file of queries/.
std::vector<Query> document_queries();
std::vector<Query> act_queries();
std::vector<Query> program_queries();
std::vector<Query> reading_queries();
std::vector<Query> picture_queries();
std::vector<Query> comb_queries();
std::vector<Query> body_queries();
std::vector<Query> surface_queries();
std::vector<Query> material_queries();
std::vector<Query> context_queries();
std::vector<Query> assembly_queries();

std::span<const Query> queries() {
  static const std::vector<Query> all = [] {
    std::vector<Query> list;
    for (auto* const part : {document_queries, act_queries, program_queries, reading_queries,
                             picture_queries, comb_queries, body_queries, surface_queries,
                             material_queries, context_queries, assembly_queries}) {
      std::ranges::copy(part(), std::back_inserter(list));
    }
    for (const DocumentQuery& query : knead::document_queries())
      list.push_back({query.request, query.answer, nullptr, &query});
    return list;
  }();
  return all;
}

Expected<Answer> ask(const Query& query, Studio& studio, Asked& asked) {
  if (query.document == nullptr) return query.ask(studio, asked);
  if (!studio.session) return nothing_open();
  auto answer = query.document->ask(
      *studio.session, [&](void* request) { return read_request(asked, *query.request, request); });
  if (!answer) return std::unexpected(std::move(answer.error()));
  return Answer{query.answer, *std::move(answer)};
}

}  // namespace knead::studio
