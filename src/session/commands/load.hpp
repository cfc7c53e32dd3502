#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Loads on the selected surfaces; each command replaces the loads before it.
struct LoadCommand {
  Load load;
};

KNEAD_COMMAND(LoadCommand, "load", "loads everywhere on the selected surfaces; replaces those before") {
  v.field("vector", Presence::optional, c.load.vector, "[x, y, z] force per area");
  v.field("gravity", Presence::optional, c.load.gravity, "[x, y, z] acceleration, times the mass");
  v.field("pressure", Presence::optional, c.load.pressure, "force per area along the normal S_u x S_v");
  v.field("wind", Presence::optional, c.load.wind, "[x, y, z] velocity of the air");
  v.field("counts", Presence::optional, c.load.counts, "[m, n] samples of a force over the domain, at least 2 each");
  v.field("samples", Presence::optional, c.load.samples,
          "m n forces [x, y, z] per area, along v first; linear in between");
}

}  // namespace knead
