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
    return list;
  }();
  return all;
}

}  // namespace knead::studio
