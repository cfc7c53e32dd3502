// The report on a morph as a page for people.
#include "morph_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "knead/base/printable.hpp"

namespace knead {
namespace detail {
namespace {

constexpr std::size_t most_rows = 20;

/// Text of a file or of a user as Markdown shows it, also in a table.
std::string plain(std::string_view text) {
  std::string result;
  for (const char c : printable(text, 300)) {
    if (std::string_view("\\`*_[]<>|~").find(c) != std::string_view::npos) result += '\\';
    result += c;
  }
  return result;
}

std::string plain(const std::vector<std::string>& names, std::size_t most = 6) {
  std::string result;
  for (std::size_t k = 0; k < std::min(most, names.size()); ++k)
    result += (k > 0 ? ", " : "") + plain(names[k]);
  if (names.size() > most) result += fmt::format(" and {} more", names.size() - most);
  return result;
}

std::string figure(double x) { return fmt::format("{:.3g}", x); }
std::string figure(const std::optional<double>& x) { return x ? figure(*x) : "–"; }

std::string count_of(double x) {
  std::string digits = fmt::format("{:.0f}", x);
  for (std::size_t at = digits.size(); at > 3; at -= 3) digits.insert(at - 3, ",");
  return digits;
}

/// "1.2 → 3.4", or one of them where both read the same.
std::string change(const std::optional<double>& before, const std::optional<double>& after) {
  if (figure(before) == figure(after)) return figure(after);
  return figure(before) + " → " + figure(after);
}

std::string place(const std::array<double, 3>& at) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", at[0], at[1], at[2]);
}

/// Writes a page of one report.
class Writer {
 public:
  Writer(const MorphReport& report, bool illustrated)
      : report_(report),
        illustrated_(illustrated),
        unit_(report.unit == "unknown" ? "" : " " + plain(report.unit)) {}

  std::string page() {
    head();
    if (report_.used > 0 && report_.scale != 0) {
      deviation();
      surfaces();
    }
    points();
    if (!report_.above.empty()) above();
    if (report_.scale != 0) {
      exceptions();
      edges();
      sizes();
    }
    settings();
    times();
    return std::move(text_);
  }

 private:
  template <class... Values>
  void add(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Values>(values)...);
  }

  /// A row of a table; the first one of each table is followed by its rule.
  void row(const std::vector<std::string>& cells, bool first = false) {
    for (const std::string& cell : cells) text_ += "| " + cell + " ";
    text_ += "|\n";
    if (!first) return;
    text_ += "|---";
    for (std::size_t k = 1; k < cells.size(); ++k) text_ += "|---:";
    text_ += "|\n";
  }

  void more_than(std::size_t count, std::string_view what) {
    if (count > most_rows) add("\nand {} more {}.\n", count - most_rows, what);
  }

  void head() {
    const auto& r = report_;
    add("# {}, moved to follow data\n\n", plain(r.file.substr(r.file.find_last_of('/') + 1)));
    if (r.scale == 0) {
      add("The scale is 0: the file is as it was, byte for byte.\n\n");
    } else {
      add("The faces follow the {}{}. ", plain(r.data),
          r.scale == 1 ? "" : fmt::format(", times {}", r.scale));
      if (r.unit == "unknown")
        add("The file does not say in what unit its lengths are.\n\n");
      else
        add("Lengths are in {}.\n\n", plain(r.unit));
      verdict();
    }
  }

  void verdict() {
    const auto& r = report_;
    std::size_t contradicting = 0, others = 0;
    for (const MorphExcess& excess : r.above) {
      if (excess.measure == "contradiction")
        contradicting += static_cast<std::size_t>(excess.count);
      else
        ++others;
    }
    add("**Verdict:** ");
    if (others == 0) {
      add("nothing is above what was wanted");
    } else {
      add("{} {} above what was wanted ([below](#above-what-was-wanted))", others,
          others == 1 ? "measure is" : "measures are");
    }
    if (contradicting > 0)
      add("; {} points contradict what stays, and are followed in part", contradicting);
    add(". The data want displacements of up to {}{}; of these at most {}{}, {}{} rms, is missing. "
        "No edge is parted by more than the check allows.\n\n",
        figure(r.before.largest), unit_, figure(r.after.largest), unit_, figure(r.after.rms),
        unit_);
  }

  static std::vector<std::string> cells(std::string name, const Deviation& d) {
    return {std::move(name),       figure(d.mean),         figure(d.rms),
            figure(d.of_95),       figure(d.of_99),        figure(d.largest),
            figure(d.signed_mean), figure(d.signed_least), figure(d.signed_most)};
  }

  void deviation() {
    const auto& r = report_;
    add("## Deviation from the data\n\n");
    row({unit_.empty() ? "length" : unit_.substr(1), "mean", "rms", "95 %", "99 %", "largest",
         "signed: mean", "least", "most"},
        true);
    row(cells("before", r.before));
    row(cells("after", r.after));
    if (r.between)
      row(cells(fmt::format("after, at {} points between the data", count_of(r.points_between)),
                *r.between));
    add("\nBefore: what the data want; after: what of that is missing. Signed figures are the "
        "parts along the outward "
        "normal, above 0 where the data lie outside.\n\n");
    if (!illustrated_) return;
    add("![Histograms of the signed deviation before and after](histogram.svg)\n\n"
        "| before | after |\n|---|---|\n"
        "| ![The model before, coloured by the deviation](before.png) | "
        "![The model after, in the same colours](after.png) |\n\n"
        "![Scale of the colours: signed deviation](scale.svg)\n\n"
        "Both are seen from the same two opposite directions; grey is where no data are near. The "
        "deviation after, "
        "on a scale of its own:\n\n"
        "![The model after, in colours of a finer scale](remaining.png)\n\n"
        "![The finer scale](remaining_scale.svg)\n\n");
  }

  void surfaces() {
    std::vector<const MorphedSurface*> worst;
    for (const MorphedSurface& s : report_.surfaces) worst.push_back(&s);
    std::ranges::stable_sort(worst, std::greater(),
                             [](const MorphedSurface* s) { return s->after.largest; });
    add("## By face, the worst first\n\n");
    row({"faces", "surface", "points", "rms before", "rms after", "95 %", "99 %", "largest",
         "signed mean", "control points"},
        true);
    for (std::size_t k = 0; k < std::min(most_rows, worst.size()); ++k) {
      const MorphedSurface& s = *worst[k];
      row({s.faces.empty() ? "–" : plain(s.faces), plain(s.id), count_of(s.points),
           figure(s.before.rms), figure(s.after.rms), figure(s.after.of_95), figure(s.after.of_99),
           figure(s.after.largest), figure(s.after.signed_mean),
           count_of(s.control_points_before) + " → " + count_of(s.control_points_after)});
    }
    more_than(worst.size(), "surfaces");
    add("\n");
  }

  void points() {
    const auto& r = report_;
    add("## Points\n\n");
    row({"points", "number"}, true);
    row({"of the data", count_of(r.points)});
    row({"used", count_of(r.used)});
    row({fmt::format("left out: farther than {}{} from every face", figure(r.reach), unit_),
         count_of(r.left_out)});
    if (r.scan) {
      row({"left out: beside the model, beyond its border", count_of(r.scan->beyond_border)});
      row({"left out: normal more than 45° from that of the face", count_of(r.scan->turned_away)});
      row({"left out: more than six deviations from the moved model", count_of(r.scan->outliers)});
    }
    add("\nPoints used are {}{} from the model at most, {}{} rms.\n\n", figure(r.largest_distance),
        unit_, figure(r.rms_distance), unit_);
    if (r.scan) scan(*r.scan);
    if (r.listed.empty()) return;
    add("The first of those that are too far:\n\n");
    row({"point", "place", "distance"}, true);
    for (const MorphLeftOut& point : r.listed)
      row({fmt::format("{}", point.number), place(point.place),
           point.distance ? figure(point.distance) : "over 100 times the reach"});
    add("\n");
  }

  void scan(const MorphScan& s) {
    add("The noise of each coordinate of the scan is {}{}{}. The distance of its points from the "
        "model is {}{} rms before and {}{} after {} turns.",
        figure(s.noise), unit_,
        s.noise == 0        ? ", as it is taken as exact"
        : s.noise_estimated ? ", as estimated"
                            : ", as given",
        figure(s.rms_before), unit_, figure(s.rms_after), unit_, s.turns);
    if (const auto& laid = s.alignment)
      add(" It was laid onto the model before: turned by {}° and shifted by {}; its distance went "
          "from {} to {}{} rms.",
          figure(laid->angle), place(laid->shift), figure(laid->rms_before),
          figure(laid->rms_after), unit_);
    add("\n\n");
  }

  void above() {
    add("## Above what was wanted\n\n");
    row({"where", "measure", "found", "wanted", "points", "place"}, true);
    for (std::size_t k = 0; k < std::min(most_rows, report_.above.size()); ++k) {
      const MorphExcess& e = report_.above[k];
      row({e.edge.empty() ? "surface " + plain(e.surface) : "edge " + plain(e.edge), e.measure,
           figure(e.found), figure(e.wanted), fmt::format("{}", e.count), place(e.place)});
    }
    more_than(report_.above.size(), "measures");
    add("\n");
  }

  void exceptions() {
    const std::pair<const std::vector<MorphException>*, const char*> lists[] = {
        {&report_.fixed, "Surfaces that could not move"},
        {&report_.unknown_edges, "Edges that could not be followed"}};
    for (const auto& [list, title] : lists) {
      if (list->empty()) continue;
      add("## {}\n\n", title);
      row({"id", "reason"}, true);
      for (std::size_t k = 0; k < std::min(most_rows, list->size()); ++k)
        row({plain((*list)[k].id), plain((*list)[k].reason)});
      more_than(list->size(), "of them");
      add("\n");
    }
  }

  /// The edges with the largest growth of some figure.
  [[nodiscard]] std::vector<const MorphedEdge*> most_changed() const {
    using Value = std::optional<double> MorphedEdge::*;
    static constexpr std::pair<Value, Value> measures[] = {
        {&MorphedEdge::gap_before, &MorphedEdge::gap_after},
        {&MorphedEdge::angle_before, &MorphedEdge::angle_after},
        {&MorphedEdge::curvature_before, &MorphedEdge::curvature_after}};
    constexpr std::size_t of_each = 7;
    std::vector<const MorphedEdge*> result;
    for (const auto& [before, after] : measures) {
      std::vector<const MorphedEdge*> order;
      const auto growth = [&](const MorphedEdge* e) {
        return (e->*after).value_or(0) - (e->*before).value_or(0);
      };
      for (const MorphedEdge& e : report_.edges) order.push_back(&e);
      std::ranges::stable_sort(order, std::greater(), growth);
      for (std::size_t k = 0; k < std::min(of_each, order.size()); ++k) {
        if (growth(order[k]) > 0 && std::ranges::find(result, order[k]) == result.end())
          result.push_back(order[k]);
      }
    }
    return result;
  }

  void edges() {
    const auto shown = most_changed();
    add("## Edges\n\n{} edges have other figures than before{}\n\n", report_.edges.size(),
        shown.empty() ? "." : "; those of which gap, angle or curvature difference grew most:");
    if (shown.empty()) return;
    row({"edge", "kind", "gap" + (unit_.empty() ? "" : "," + unit_), "angle, degrees",
         "curvature difference, %"},
        true);
    for (const MorphedEdge* e : shown)
      row({plain(e->id), plain(e->kind), change(e->gap_before, e->gap_after),
           change(e->angle_before, e->angle_after),
           change(e->curvature_before, e->curvature_after)});
    add("\n");
  }

  void sizes() {
    const auto& r = report_;
    add("## Size\n\n");
    row({"", "before", "after", "factor"}, true);
    const auto line = [&](std::string name, double before, double after) {
      row({std::move(name), count_of(before), count_of(after),
           before > 0 ? fmt::format("{:.2f}", after / before) : "–"});
    };
    line("control points", r.control_points_before, r.control_points_after);
    line("bytes of the file", r.bytes_before, r.bytes_after);
    add("\n{} surfaces became B-splines, to move.\n\n", r.converted.size());
  }

  void settings() {
    const auto& r = report_;
    add("## Settings\n\n");
    row({"setting", "value"}, true);
    row({"data", plain(r.data)});
    row({"scale", fmt::format("{}", r.scale)});
    if (r.scale != 0) row({"tolerance", figure(r.tolerance) + unit_});
    row({"reach", figure(r.reach) + unit_});
    row({"control points at most, times", figure(r.refinement)});
    if (r.along_normal) row({"displacements", "their part along the normal"});
    if (!r.data_unit.empty()) row({"unit of the data", plain(r.data_unit)});
    if (!r.only.empty()) row({"only these move", plain(r.only)});
    if (!r.kept.empty()) row({"these stay", plain(r.kept)});
    if (!r.places.empty()) row({"places", plain(r.places)});
    row({"size of the model", figure(r.size) + unit_});
    if (r.scale != 0) {
      row({"λ", figure(r.lambda)});
      row({"solves on the last factor", fmt::format("{}", r.rounds)});
      row({"refinements", fmt::format("{}", r.refinements)});
    }
    add("\n");
  }

  void times() {
    const auto& r = report_;
    add("## Time\n\n");
    row({"phase", "seconds"}, true);
    const std::pair<const char*, double> phases[] = {
        {"model: conversion, regions, edges", r.time_model},
        {"data: reading, nearest points", r.time_data},
        {"fit", r.time_fit},
        {"deviation", r.time_deviation},
        {"writing", r.time_save},
        {"check of the edges", r.time_check}};
    double sum = 0;
    for (const auto& [name, seconds] : phases) {
      sum += seconds;
      row({name, fmt::format("{:.2f}", seconds)});
    }
    row({"all", fmt::format("{:.2f}", sum)});
  }

  const MorphReport& report_;
  bool illustrated_;
  std::string unit_;  // with a space before it
  std::string text_;
};

}  // namespace

std::string page_text(const MorphReport& report, bool illustrated) {
  return Writer(report, illustrated).page();
}

}  // namespace detail

std::string morph_page(const MorphReport& report) { return detail::page_text(report, false); }

}  // namespace knead
