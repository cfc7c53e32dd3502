#include "knots.hpp"

#include <utility>

namespace knead::step {

Expected<KnotVector> implied_knots(ImpliedKnots form, int degree, int count) {
  if (degree < 1 || degree > max_degree) {
    return input_error("the degree is " + std::to_string(degree), {},
                       "degrees 1 to " + std::to_string(max_degree) + " can be read");
  }
  if (count < degree + 1) {
    return input_error(
        std::to_string(count) + " control points for degree " + std::to_string(degree), {},
        "at least degree + 1 are needed");
  }
  std::vector<double> knots;
  const auto add = [&knots](int times, double value) {
    knots.insert(knots.end(), static_cast<std::size_t>(times), value);
  };
  if (form == ImpliedKnots::uniform) {
    for (int k = -degree; k <= count; ++k) add(1, k);
    return KnotVector::create(degree, std::move(knots));
  }
  const int inside = form == ImpliedKnots::bezier ? degree : 1;
  if ((count - 1 - degree) % inside != 0) {
    return input_error(std::to_string(count) +
                       " control points do not make whole Bezier pieces of degree " +
                       std::to_string(degree));
  }
  const int spans = (count - 1 - degree) / inside + 1;
  add(degree + 1, 0);
  for (int k = 1; k < spans; ++k) add(inside, k);
  add(degree + 1, spans);
  return KnotVector::create(degree, std::move(knots));
}

namespace {

std::string prefix_of(const std::string& direction) {
  return direction.empty() ? std::string() : direction + " ";
}

}  // namespace

Expected<std::vector<double>> read_knot_list(const Reader& reader, std::uint32_t instance,
                                             int degree, int count, std::uint32_t multiplicities,
                                             std::uint32_t values, const std::string& direction) {
  const std::string prefix = prefix_of(direction);
  if (!reader.is_list(multiplicities) || !reader.is_list(values)) {
    return reader.error(instance, "its " + prefix + "knots or multiplicities are not a list");
  }
  const auto m = reader.file().children(multiplicities);
  const auto x = reader.file().children(values);
  if (m.size() != x.size()) {
    return reader.error(instance, std::to_string(x.size()) + " " + prefix + "knots with " +
                                      std::to_string(m.size()) + " multiplicities");
  }
  const std::int64_t needed = std::int64_t{count} + degree + 1;
  std::int64_t sum = 0;
  std::vector<double> knots;
  for (std::size_t k = 0; k < m.size(); ++k) {
    const auto times = reader.integer(m[k]);
    const auto value = reader.real(x[k]);
    const auto where = prefix + "knot " + std::to_string(k);
    if (!times || *times < 1)
      return reader.error(instance, "the multiplicity of " + where + " is not a positive integer");
    if (!value) return reader.error(instance, where + " is not a number a double can hold");
    sum += *times;
    // A multiplicity of a damaged file may be two thousand million: nothing is stored beyond what
    // can be right, and the sum that is reported is still the file's.
    if (sum <= needed) knots.insert(knots.end(), static_cast<std::size_t>(*times), *value);
  }
  if (sum != needed) {
    return reader.error(instance,
                        "the " + prefix + "multiplicities add up to " + std::to_string(sum) +
                            " for " + std::to_string(count) + " control points of degree " +
                            std::to_string(degree),
                        "they must add up to " + std::to_string(needed));
  }
  return knots;
}

Expected<KnotVector> read_knots(const Reader& reader, std::uint32_t instance, int degree, int count,
                                std::uint32_t multiplicities, std::uint32_t values,
                                const std::string& direction) {
  auto list = read_knot_list(reader, instance, degree, count, multiplicities, values, direction);
  if (!list) return std::unexpected(std::move(list.error()));
  return knots_of_list(reader, instance, degree, *std::move(list), direction);
}

Expected<KnotVector> knots_of_list(const Reader& reader, std::uint32_t instance, int degree,
                                   std::vector<double> list, const std::string& direction) {
  auto result = KnotVector::create(degree, std::move(list));
  if (!result) {
    const std::string prefix = prefix_of(direction);
    const auto& reason = result.error();
    return reader.error(
        instance,
        prefix + "knots: " + reason.what + (reason.where.empty() ? "" : " (" + reason.where + ")"),
        reason.remedy);
  }
  return result;
}

}  // namespace knead::step
