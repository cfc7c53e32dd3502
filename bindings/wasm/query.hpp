#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "describe/json.hpp"
#include "session/queries/document_query.hpp"
#include "studio.hpp"
#include "values.hpp"

namespace knead::studio {

/// What a query is asked with: the request's JSON, and the bytes beside it.
struct Asked {
  Json json;
  std::string bytes;
};

/// Reads a request. Errors (input): as `read_record`; those of a command as `read_command`.
[[nodiscard]] Expected<void> read_request(Asked& asked, const Type& type, void* request);

/// What a query answers, in its type.
struct Answer {
  const Type* type = nullptr;
  DescribedValue value = {nullptr, [](const void*) {}};  ///< null: `json`
  std::string json = {};
};

/// One whose JSON is written already.
[[nodiscard]] Expected<Answer> written_answer(const Type& type, Expected<std::string> json);

/// The answer A of a result: itself, where it stays until the next call, the text of one of text or
/// bytes, or its JSON.
template <class A, class Result>
Expected<Answer> answer_of(Expected<Result> result) {
  constexpr bool text = std::is_same_v<Result, std::string>;
  if constexpr (text && !requires(A answer) { answer.data; }) {
    return written_answer(type_of<A>(), std::move(result));
  } else {
    if (!result) return std::unexpected(std::move(result.error()));
    if constexpr (std::is_pointer_v<Result>) {
      return Answer{&type_of<A>(), {*result, [](const void*) {}}};
    } else {
      return Answer{&type_of<A>(), {new A{*std::move(result)}, [](const void* value) {
                                      delete static_cast<const A*>(value);
                                    }}};
    }
  }
}

/// A question of the page to the engine. The name, the meaning and the fields are those of the
/// request's description.
struct Query {
  const Type* request = nullptr;
  const Type* answer = nullptr;
  /// Errors: those of reading the request and of `ask`.
  Expected<Answer> (*ask)(Studio& studio, Asked& asked) = nullptr;
  const DocumentQuery* document = nullptr;  ///< it is this one, asked of the session
};

/// Errors: those of reading the request and of the query; without a session (usage).
[[nodiscard]] Expected<Answer> ask(const Query& query, Studio& studio, Asked& asked);

/// What a function of the session, or of the studio, answers. Errors: its own; without a session
/// (usage).
template <class A, class Ask>
Expected<Answer> answer_by(Studio& studio, const Ask& ask) {
  if constexpr (std::is_invocable_v<Ask, Studio&>) {
    return answer_of<A>(ask(studio));
  } else {
    return studio.session ? answer_of<A>(ask(*studio.session)) : nothing_open();
  }
}

/// The query of a described request R, which says the type of its answer (`R::Answer`). Beside it
/// `ask(Studio&, R)` or `ask(Session&, R)` is defined, which `answer_of` understands; without a
/// session the second is an error (usage).
template <class R>
Query query() {
  return {&type_of<R>(), &type_of<typename R::Answer>(),
          [](Studio& studio, Asked& asked) -> Expected<Answer> {
            R request;
            if (auto status = read_request(asked, type_of<R>(), &request); !status) {
              return std::unexpected(std::move(status.error()));
            }
            const auto answered = [&request](auto& by) -> decltype(ask(by, std::move(request))) {
              return ask(by, std::move(request));
            };
            return answer_by<typename R::Answer>(studio, answered);
          }};
}

/// The request of queries about a surface alone.
struct OfSurface {
  int surface = 0;
};

inline void describe(OfSurface& q, Fields& fields) {
  fields.add("surface", q.surface, {.help = "its number", .presence = Presence::required});
}

/// One whose request has no fields, or is a surface; `ask(Studio&)` or `ask(Studio&, int)`, or of a
/// Session&, answers an A.
template <class A, auto ask>
Query query(std::string_view name, std::string_view help) {
  constexpr bool alone =
      std::is_invocable_v<decltype(ask), Studio&> || std::is_invocable_v<decltype(ask), Session&>;
  static Type request = alone ? Type() : type_of<OfSurface>();
  request.name = name;
  request.help = help;
  return {&request, &type_of<A>(), [](Studio& studio, Asked& asked) -> Expected<Answer> {
            OfSurface of;
            if (auto status = read_request(asked, request, &of); !status)
              return std::unexpected(std::move(status.error()));
            if constexpr (alone) {
              return answer_by<A>(studio, ask);
            } else {
              return answer_by<A>(
                  studio, [&of](auto& by) -> decltype(ask(by, 0)) { return ask(by, of.surface); });
            }
          }};
}

}  // namespace knead::studio
