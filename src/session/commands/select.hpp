#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Selects the surfaces, or the curve or volume, that the following commands act on. A document's
/// only surface is selected by default.
struct SelectCommand {
  static constexpr ActsOn acts_on = ActsOn::scene;
  std::optional<std::string> surface;                ///< id of the entity, "#123"
  std::optional<std::vector<std::string>> surfaces;  ///< several, which then move together
  bool connected = false;                            ///< and all that seams connect with these
  std::optional<std::string> body;                   ///< a curve or a volume, instead of surfaces
};

Expected<void> execute(const SelectCommand& c, Act& act);
void describe(SelectCommand& c, Fields& fields);

}  // namespace knead
