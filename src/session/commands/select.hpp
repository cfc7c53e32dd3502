#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Chooses the surfaces that the following commands act on. A document with one surface has it selected already.
struct SelectCommand {
  std::optional<std::string> surface;                ///< id of the entity, "#123"
  std::optional<std::vector<std::string>> surfaces;  ///< several, which then move together
  bool connected = false;                            ///< and all that seams connect with these
};

template <>
Expected<void> Executor::execute(const SelectCommand& c);
void describe(SelectCommand& c, Fields& fields);

}  // namespace knead
