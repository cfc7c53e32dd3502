#pragma once

#include <fmt/format.h>

#include "sheet.hpp"

namespace knead::testing {

inline constexpr double side = 200;

/// A bicubic sheet of 200 × 200.
inline Session flat(int net, const std::vector<std::string>& more = {}) {
  Session session = fresh();
  run(session,
      {fmt::format(R"({{"do":"new","size":[200,200],"net":[{0},{0}]}})", net), R"({"do":"edge"})"});
  run(session, more);
  return session;
}

inline std::string place(const Point& at) {
  return fmt::format("[{:.17g},{:.17g}]", at.x() / side, at.y() / side);
}

/// A brush led from one point of a sheet to another, given by so many pieces.
inline std::string brush(const std::string& fields, const Point& from, const Point& to,
                         int pieces = 1) {
  std::string path;
  for (int k = 0; k <= pieces; ++k) {
    path += (k == 0 ? "" : ",") + place(from + static_cast<double>(k) / pieces * (to - from));
  }
  return R"({"do":"brush",)" + fields + R"(,"path":[)" + path + "]}";
}
/// A brush at one point.
inline std::string dab(const std::string& fields, const Point& at) {
  return R"({"do":"brush",)" + fields + R"(,"path":[)" + place(at) + "]}";
}

inline const Surface& shape(const Session& session) { return *first(session).current; }
inline Point on(const Surface& s, double x, double y) { return at(s, x / side, y / side); }
inline double difference(const Surface& a, const Surface& b) {
  return (a.control_points() - b.control_points()).rowwise().norm().maxCoeff();
}

}  // namespace knead::testing
