#include "exchange/part21/part21_text.hpp"
#include "exchange/step/surfaces.hpp"
#include "print.hpp"
#include "surgeon.hpp"

namespace knead::step {
namespace {

constexpr std::size_t attributes_with_knots = attributes_of_b_spline_surface + 5;

/// The position of the comma between two parameters, where there may also be comments.
std::uint32_t comma_between(const std::string& bytes, std::uint32_t from) {
  while (bytes[from] != ',') {
    from = bytes.compare(from, 2, "/*") == 0
               ? static_cast<std::uint32_t>(bytes.find("*/", from) + 2)
               : from + 1;
  }
  return from;
}

}  // namespace

// A simple record KEYWORD(name,own,knots) becomes
//   (BOUNDED_SURFACE()B_SPLINE_SURFACE(own)B_SPLINE_SURFACE_WITH_KNOTS(knots)
//    GEOMETRIC_REPRESENTATION_ITEM()RATIONAL_B_SPLINE_SURFACE(weights)
//    REPRESENTATION_ITEM(name)SURFACE()),
// parts by the alphabet (ISO 10303-21, 11.2.5.3); a complex one gets the part it lacks.
// A simple record cannot have weights: RATIONAL_B_SPLINE_SURFACE is a subtype beside
// B_SPLINE_SURFACE_WITH_KNOTS, and an instance of both is written as a complex one.
Expected<void> Surgeon::become_rational(std::uint32_t instance, const Surface& before,
                                        const Surface& after) {
  const auto net = after.net();
  const auto weights =
      "RATIONAL_B_SPLINE_SURFACE(" +
      print_net(
          net[0], net[1],
          [&](int k) { return format_shortest_real(after.weights()[static_cast<std::size_t>(k)]); },
          line_break()) +
      ")";
  const auto& record = file_.instance(instance);
  if (record.complex) {
    if (auto status = write_knots(instance, before, after); !status) return status;
    const auto item = reader_.part(instance, "REPRESENTATION_ITEM");
    insert(item ? file_.range(*item).begin : record.record.end - 1, weights);
    return {};
  }
  const auto values = file_.children(record.first);
  const auto form = implied_form(reader_, instance);
  if (values.size() != (form ? attributes_of_b_spline_surface : attributes_with_knots)) {
    return reader_.error(instance,
                         "it has " + std::to_string(values.size()) +
                             " attributes, so it cannot be rewritten with weights",
                         "its type has " + std::to_string(form ? attributes_of_b_spline_surface
                                                               : attributes_with_knots));
  }
  bool implied = form.has_value();
  for (const auto& knots : after.knots()) {
    implied = implied && implied_knots(*form, knots.degree(), knots.count()) == knots;
  }
  const auto bytes = file_.range(record.first);
  const std::string name(file_.text(values[0]));
  const std::string keyword = form ? implied_keyword(*form) : "";
  // From the keyword to the comma after the name: comments there are lost.
  const auto second = comma_between(file_.bytes(), file_.range(values[0]).end) + 1;
  const std::string first = implied && *form == ImpliedKnots::bezier ? keyword + "()" : "";
  changes_.push_back({{bytes.begin, second}, "(" + first + "BOUNDED_SURFACE()B_SPLINE_SURFACE("});
  std::string rest = ")";
  if (form && !implied) {
    std::array<PrintedKnots, 2> printed;
    for (std::size_t d = 0; d < 2; ++d)
      printed[d] = print_knots(after.knots()[d], format_shortest_real);
    rest += "B_SPLINE_SURFACE_WITH_KNOTS(" + printed[0].multiplicities + "," +
            printed[1].multiplicities + "," + printed[0].values + "," + printed[1].values +
            ",.UNSPECIFIED.)";
  } else if (!form) {
    const auto comma =
        comma_between(file_.bytes(), file_.range(values[attributes_of_b_spline_surface - 1]).end);
    changes_.push_back({{comma, comma + 1}, ")B_SPLINE_SURFACE_WITH_KNOTS("});
    if (auto status = write_knots(instance, before, after); !status) return status;
  }
  rest += "GEOMETRIC_REPRESENTATION_ITEM()";
  if (implied && *form == ImpliedKnots::quasi_uniform) rest += keyword + "()";
  rest += weights + "REPRESENTATION_ITEM(" + name + ")SURFACE()";
  if (implied && *form == ImpliedKnots::uniform) rest += keyword + "()";
  changes_.push_back({{bytes.end - 1, bytes.end}, rest + ")"});
  return {};
}

}  // namespace knead::step
