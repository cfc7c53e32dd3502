#pragma once

#include <cmath>

#include "knead/spline/evaluate.hpp"
#include "support.hpp"

namespace knead::testing {

inline const char* const new_sheet = R"({"do":"new","size":[10,10],"net":[10,10]})";
inline const std::vector<std::string> sheet = {new_sheet, R"({"do":"edge"})"};

inline Session on_sheet(const std::vector<std::string>& more = {}) {
  Session session = fresh();
  run(session, sheet);
  run(session, more);
  return session;
}

inline const SceneSurface& first(const Session& session) {
  return session.state().surfaces.front();
}

inline Point at(const Surface& s, double a, double b) {
  const Interval u = s.knots(0).domain(), v = s.knots(1).domain();
  return *evaluate_point<2>(s, {std::min(u.lower + a * u.length(), u.upper),
                                std::min(v.lower + b * v.length(), v.upper)});
}

/// Largest displacement over samples of the rectangle [a, b] x [c, d] of fractions.
inline double moved(const Session& session, double a, double b, double c, double d) {
  double largest = 0;
  for (int i = 0; i <= 12; ++i) {
    for (int j = 0; j <= 12; ++j) {
      const double s = a + (b - a) * i / 12, t = c + (d - c) * j / 12;
      largest = std::max(
          largest, (at(*first(session).current, s, t) - at(*first(session).opened, s, t)).norm());
    }
  }
  return largest;
}

inline const char* const ball = R"({"do":"tool","name":"ball","radius":2,"position":[5,5,-1.5]})";
inline const char* const lift = R"({"do":"load","vector":[0,0,1]})";

}  // namespace knead::testing
