#pragma once

#include <optional>

#include "describe/record_json.hpp"
#include "described_state.hpp"
#include "session_state.hpp"

namespace knead {

/// The session as it is reported.
struct SessionInfo;
template <>
const Type& type_of<SessionInfo>();

// Parts of what is reported about a session that are asked for by themselves as well.

template <class T>
std::string json_of(const T& value) {
  return to_json(type_of<T>(), &value, Absent::null);
}

struct EdgeInfo {
  std::string id;
  std::vector<std::string> faces;
  double deviation = 0;
};
void describe(EdgeInfo& e, Fields& fields);

struct EdgesInfo {
  std::string surface;
  double tolerance = 0;
  std::vector<EdgeInfo> edges;
  std::string unknown;
};
void describe(EdgesInfo& e, Fields& fields);

/// The edges of the faces on every surface of a file that has moved, and by how much each is parted
/// (`parted_edges`).
[[nodiscard]] std::vector<EdgesInfo> edges_info(const Session& session);

struct ReadingInfo {
  std::string name;
  int surface = 0;
  Fractions at = {0, 0};
  Vector3 point = {0, 0, 0}, displacement = {0, 0, 0}, normal = {0, 0, 0};
  std::optional<std::array<double, 2>> curvature;
  std::optional<std::array<double, 2>> von_mises, membrane, moment;
  std::optional<double> bending_strain;
};
void describe(ReadingInfo& r, Fields& fields);
/// All but the name and the surface.
void describe_measures(ReadingInfo& r, Fields& fields);

struct VibrationInfo {
  double frequency = 0, residual = 0;
};
void describe(VibrationInfo& m, Fields& fields);

struct BucklingInfo {
  double load_factor = 0, residual = 0;
};
void describe(BucklingInfo& m, Fields& fields);

/// `VibrationInfo` or `BucklingInfo` of modes.
template <class Info>
std::vector<Info> infos_of(const std::vector<ModeRecord>& modes) {
  std::vector<Info> list;
  for (const ModeRecord& mode : modes) list.push_back({mode.value, mode.residual});
  return list;
}

enum class BodyKind { curve, volume };
std::span<const Choice> choices(BodyKind);

struct BodyInfo {
  std::string id, name, unit;
  BodyKind kind = BodyKind::curve;
  std::vector<int> degree, net;
  bool rational = false;
  Vector3 lower = {0, 0, 0}, upper = {0, 0, 0};
  std::vector<double> alpha, beta;
  double mass = 0, damping = 0;
  std::optional<double> w1, w2;
  int hold = 0;
  std::vector<int> pins;
  std::vector<std::string> sides = {};
  int holds = 0, moved = 0;
  double displacement = 0;
};
void describe(BodyInfo& b, Fields& fields);

/// Of the scene's curves and volumes.
[[nodiscard]] std::vector<BodyInfo> bodies_of(const Scene& scene);

/// Errors: those of `read_probe` and `read_shell`.
[[nodiscard]] Expected<ReadingInfo> reading_of(const Scene& scene, const Probe& probe);

/// Of the scene's measurements; those that cannot be read are left out.
[[nodiscard]] std::vector<ReadingInfo> readings_of(const Scene& scene);

}  // namespace knead
