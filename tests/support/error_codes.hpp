#pragma once

#include <algorithm>
#include <span>

#include "knead/base/error_code.hpp"
#include "knead/session/session.hpp"

namespace knead::testing {

inline ErrorCode code_of(const Error& error) {
  return error.diagnostic ? error.diagnostic->code : ErrorCode::none;
}

inline bool has_note(std::span<const Note> notes, ErrorCode code) {
  return std::ranges::any_of(
      notes, [code](const Note& n) { return n.diagnostic && n.diagnostic->code == code; });
}

}  // namespace knead::testing
