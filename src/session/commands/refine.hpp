#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Finer nets, the same shape: halves spans in a region or under a tool, or inserts knots.
struct RefineCommand {
  std::optional<std::array<Fractions, 2>> region;
  std::optional<std::string> under;  ///< name of a tool
  std::vector<double> knots_u, knots_v;
  std::optional<RefinePermission> permission;  ///< whether other commands may refine exactly what they need
};

inline constexpr Choice<RefinePermission> refine_permissions[] = {{"auto", RefinePermission::automatic},
                                                                  {"never", RefinePermission::never}};

KNEAD_COMMAND(RefineCommand, "refine", "a finer net of the same shape") {
  v.field("region", Presence::optional, c.region, "[[s0, s1], [t0, t1]]: halve the spans there; or:");
  v.field("under", Presence::optional, c.under, "name of a tool: halve the spans that it reaches; or:");
  v.field("knots_u", Presence::optional, c.knots_u, "knots to insert in u, parameters of the file");
  v.field("knots_v", Presence::optional, c.knots_v, "knots to insert in v");
  v.choice("permission", c.permission, std::span<const Choice<RefinePermission>>(refine_permissions),
           "whether other commands may refine what they need refined; never unless said");
}

}  // namespace knead
