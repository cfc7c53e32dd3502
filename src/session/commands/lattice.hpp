#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Deforms the selected surfaces with a block of space round them, on which the tools act (thesis § 5.7).
struct LatticeCommand {
  std::array<int, 3> net = {6, 6, 6};
  std::array<int, 3> degree = {3, 3, 3};
  double margin = 0.05;  ///< of the diagonal
  int steps = 4;
  double lambda = 1;
  std::vector<std::string> hold;  ///< faces: "u0" … "w1", u along x, v along y, w along z
};

KNEAD_COMMAND(LatticeCommand, "lattice", "deform the surfaces with an elastic block of space that the tools act on") {
  v.field("net", Presence::optional, c.net, "control points of the block along x, y, z");
  v.field("degree", Presence::optional, c.degree, "along x, y, z");
  v.field("margin", Presence::optional, c.margin, "how far it reaches beyond the surfaces, of their diagonal");
  v.field("steps", Presence::optional, c.steps, "number of steps");
  v.field("lambda", Presence::optional, c.lambda, "inverse step size");
  v.field("hold", Presence::optional, c.hold, "faces that stay: u0, u1 (along x), v0, v1, w0, w1");
}

}  // namespace knead
