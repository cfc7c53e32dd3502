#pragma once

#include <span>
#include <string>

#include "query.hpp"

namespace knead {
class TypeScript;
}

namespace knead::studio {

/// All that the page can ask for.
[[nodiscard]] std::span<const Query> queries();

/// Answers a call of the page. The input is the bytes of the request one after the other, then, of
/// `json_size` bytes,
/// `{"query": name, "request": {…}}` with their sizes in their places. The text is
///
///     {"answer": …, "memory": {"positions": ["Float32Array", 1234, 96], …}}
///
/// with what of the answer lies in memory as type, address and number of elements, under "" the
/// answer itself; or `error_json`. The answer stays in `kept`.
[[nodiscard]] std::string call(Studio& studio, std::string input, std::size_t json_size,
                               Answer& kept);

/// The commands as methods (`CommandMethods`), and of each the field that may stand alone
/// (`firstFields`).
void declare_commands(TypeScript& types);

/// The types of all requests and answers, and `Queries`: both by the names of the queries.
void declare_queries(TypeScript& types);

}  // namespace knead::studio
