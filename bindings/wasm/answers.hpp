#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "knead/base/error.hpp"

namespace knead {

/// JSON as the text of a call that has succeeded: 1.
inline int answer_in(std::string& text, const nlohmann::json& json) {
  text = json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  return 1;
}

/// {"error": {kind, what, where, remedy, message}} as the text of one that has not: 0. Modules
/// without commands have no codes; `error_json`, which knows them, would make the lab two fifths
/// larger.
inline int fail_in(std::string& text, const Error& error) {
  const char* kind = error.kind == ErrorKind::numerical ? "numerical"
                     : error.kind == ErrorKind::usage   ? "usage"
                                                        : "input";
  answer_in(text, {{"error",
                    {{"kind", kind},
                     {"what", error.what},
                     {"where", error.where},
                     {"remedy", error.remedy},
                     {"message", error.message()}}}});
  return 0;
}

}  // namespace knead
