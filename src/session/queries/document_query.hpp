#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "describe/bytes.hpp"
#include "knead/session/session.hpp"

namespace knead {

/// A value of a described type.
using DescribedValue = std::unique_ptr<const void, void (*)(const void*)>;

/// Reads a request into one that has its defaults.
using ReadRequest = std::function<Expected<void>(void* request)>;

/// What can be asked of a document beside its commands: a sub-command of the program, whose
/// options are the described fields of the request. Python, npm and the page offer each of
/// `document_queries()` by its description.
struct DocumentQuery {
  const Type* request = nullptr;  ///< its name and help are those of the query
  const Type* answer = nullptr;
  /// Errors: those of `read`, and of the query, `where` beginning with the field.
  Expected<DescribedValue> (*ask)(const Session& session, const ReadRequest& read) = nullptr;
};

/// The query of a described request R, which says the type of its answer (`R::Answer`); beside it
/// `ask(const Session&, const R&)` is defined.
template <class R>
DocumentQuery document_query() {
  using A = typename R::Answer;
  return {&type_of<R>(), &type_of<A>(),
          [](const Session& session, const ReadRequest& read) -> Expected<DescribedValue> {
            R request;
            if (auto status = read(&request); !status)
              return std::unexpected(std::move(status.error()));
            auto answer = ask(session, request);
            if (!answer) return std::unexpected(std::move(answer.error()));
            return DescribedValue{new A{*std::move(answer)},
                                  [](const void* value) { delete static_cast<const A*>(value); }};
          }};
}

/// All of them.
[[nodiscard]] std::span<const DocumentQuery> document_queries();

/// What a query answers: JSON, and the content of each file by the name of its field.
struct DocumentAnswer {
  std::string json;
  std::vector<std::pair<std::string, std::string>> files;
};

/// Asks by name. The request is JSON, in which a field of `Bytes` is the number of its bytes; these
/// are the next of `bytes`. Errors: no such query (usage); those of `read_record`; fewer bytes than
/// the request says (usage); those of the query.
[[nodiscard]] Expected<DocumentAnswer> ask_document(const Session& session, std::string_view name,
                                                    std::string_view request,
                                                    std::string_view bytes);

/// [{"name", "help", "answer": help of the answer, "request": schema, "files": [{"name", "help",
/// "required"}]}, …]
[[nodiscard]] std::string document_queries_json();

}  // namespace knead
