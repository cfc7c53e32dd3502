#pragma once

#include "../command_fields.hpp"

namespace knead {

/// Deforms the selected surfaces with a block of space around them, on which the tools act, or
/// whose control points are moved by hand (thesis § 5.7).
struct LatticeCommand {
  std::array<int, 3> net = {6, 6, 6};
  std::array<int, 3> degree = {3, 3, 3};
  double margin = 0.05;  ///< of the diagonal
  int steps = 4;
  double lambda = 1;
  std::vector<std::string> hold;  ///< faces: "u0" … "w1", u along x, v along y, w along z
  std::vector<int> which;         ///< control points moved by hand: (i n_y + j) n_z + k
  std::optional<Vector3> by;      ///< by this; there are no steps then
  bool again = false;             ///< from where the pull before has left them
  std::optional<ThroughAllowance> allow = {};
};

Expected<void> execute(const LatticeCommand& c, Act& act);
void describe(LatticeCommand& c, Fields& fields);

}  // namespace knead
