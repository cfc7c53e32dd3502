#pragma once

#include "../command_fields.hpp"

namespace knead {

/// How patches that are selected together are coupled.
struct SeamsCommand {
  SeamPolicy seams;
};

KNEAD_COMMAND(SeamsCommand, "seams", "couple selected surfaces, and each with itself, along shared edges") {
  v.field("couple", Presence::optional, c.seams.couple, "false: they may tear apart");
  v.field("tolerance", Presence::optional, c.seams.tolerance,
          "length; default: 1e-4 of the diagonal of the selected surfaces");
}

}  // namespace knead
