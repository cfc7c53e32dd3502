#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Selects the surfaces that the following commands act on. A document's only surface is selected by
/// default.
struct SelectCommand {
  std::optional<std::string> surface;                ///< id of the entity, "#123"
  std::optional<std::vector<std::string>> surfaces;  ///< several, which then move together
  bool connected = false;                            ///< and all that seams connect with these
};

template <>
Expected<void> Executor::execute(const SelectCommand& c);
void describe(SelectCommand& c, Fields& fields);

}  // namespace knead
