// Runs scripts as `knead sculpt` does and draws what shells make of their loads:
//   example_draw_analysis stress|modes SCRIPT.json OUT.svg [FILE.step]
// `stress`: coloured by von Mises stress, with a legend; `modes`: the first four shapes of the last
// `modes` or `buckling`, rigid ones left out, beside each other.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>

#include "draw.hpp"
#include "knead/energy/shell_energy.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/session/report.hpp"
#include "run_script.hpp"

namespace {

using namespace knead;

constexpr int shown_modes = 4;
constexpr double rigid_share = 1e-3;  // of the largest value: smaller ones are rigid motions
constexpr double amplitude = 0.12;    // of a mode, in sizes of the shape
constexpr double apart = 1.15;        // shapes, in sizes
constexpr int stress_facets = 4, mode_facets = 3;

/// From blue by yellow to red as t goes from 0 to 1.
examples::Colour rising(double t) {
  static constexpr examples::Colour at[] = {{64, 110, 190}, {245, 222, 120}, {190, 40, 40}};
  const double x = 2 * std::clamp(t, 0.0, 1.0);
  const auto k = static_cast<std::size_t>(std::min(x, 1.0));
  examples::Colour mixed{};
  for (std::size_t c = 0; c < 3; ++c)
    mixed[c] = std::lerp(at[k][c], at[k + 1][c], x - static_cast<double>(k));
  return mixed;
}

double von_mises(const SessionSurface& s, const std::optional<ShellMaterial>& shell,
                 const std::array<double, 2>& u) {
  if (!shell) return 0;
  const auto r = shell_results(*s.rest, *s.current, *shell, Parameters<2>{{u[0], u[1]}});
  return r ? std::max(r->front().von_mises[0], r->front().von_mises[1]) : 0;
}

/// A scale from 0 to the largest value, over the picture.
std::string legend(double largest) {
  std::string svg = "<g font-family=\"sans-serif\" font-size=\"13\">\n";
  for (int k = 0; k < 100; ++k) {
    const auto c = rising(k / 99.0);
    svg += fmt::format(
        "<rect x=\"{}\" y=\"12\" width=\"2\" height=\"12\" fill=\"#{:02x}{:02x}{:02x}\"/>\n",
        14 + 2 * k, static_cast<int>(c[0]), static_cast<int>(c[1]), static_cast<int>(c[2]));
  }
  return svg +
         fmt::format(
             "<text x=\"14\" y=\"40\">0</text><text x=\"214\" y=\"40\" text-anchor=\"end\">{:.3g}"
             "</text>\n</g>\n</svg>\n",
             largest);
}

Expected<std::string> stress_picture(const Session& session) {
  const std::vector<SessionSurface> shapes = session.surfaces();
  std::vector<Surface> surfaces;
  for (const SessionSurface& s : shapes) surfaces.push_back(*s.current);
  std::vector<std::optional<ShellMaterial>> shells;
  for (std::size_t k = 0; k < shapes.size(); ++k)
    shells.push_back(shell_of(session, static_cast<int>(k)));
  double largest = 0;
  std::vector<double> seen;
  examples::DrawStyle style{.colour =
                                [&](std::size_t k, const std::array<double, 2>& u) {
                                  seen.push_back(von_mises(shapes[k], shells[k], u));
                                  return examples::Colour{};
                                },
                            .facets_per_span = stress_facets};
  if (const auto once = examples::draw(surfaces, session.tools(), style); !once) return once;
  // What a few facets at points of force show is left beyond the scale.
  std::ranges::sort(seen);
  largest = seen[static_cast<std::size_t>(0.995 * static_cast<double>(seen.size() - 1))];
  style.colour = [&](std::size_t k, const std::array<double, 2>& u) {
    return rising(largest > 0 ? von_mises(shapes[k], shells[k], u) / largest : 0);
  };
  auto svg = examples::draw(surfaces, session.tools(), style);
  if (svg) svg->replace(svg->rfind("</svg>"), std::string::npos, legend(largest));
  return svg;
}

Expected<std::string> modes_picture(const Session& session) {
  const auto& modes = session.modes().empty() ? session.buckling() : session.modes();
  if (modes.empty())
    return input_error("the script has neither modes nor buckling", "modes", "add one of them");
  const SessionSurface s =
      session.surfaces()[static_cast<std::size_t>(session.selection().front())];
  const Points& x = s.current->control_points();
  const double size = (x.colwise().maxCoeff() - x.colwise().minCoeff()).norm();
  double largest = 0;
  for (const auto& mode : modes) largest = std::max(largest, std::abs(mode.value));
  std::vector<Surface> surfaces;
  std::vector<Surface> displacements;
  for (const auto& mode : modes) {
    if (std::abs(mode.value) < rigid_share * largest || surfaces.size() == shown_modes) continue;
    Points moved = x + amplitude * size * mode.shape.topRows(x.rows());
    const double right = apart * size * static_cast<double>(surfaces.size());
    moved.rowwise() += Eigen::RowVector3d(0.8, 0.6, 0) * right;  // to the right in the picture
    auto shape = s.current->with_control_points(std::move(moved));
    auto field = s.current->with_control_points(mode.shape.topRows(x.rows()));
    if (!shape) return std::unexpected(shape.error());
    if (!field) return std::unexpected(field.error());
    surfaces.push_back(std::move(*shape));
    displacements.push_back(std::move(*field));
  }
  const examples::DrawStyle style{.colour =
                                      [&](std::size_t k, const std::array<double, 2>& u) {
                                        const auto d = evaluate_point<2>(displacements[k], u);
                                        return rising(d ? d->norm() : 0);
                                      },
                                  .facets_per_span = mode_facets};
  return examples::draw(surfaces, {}, style);
}

Expected<void> picture(const std::string& what, const std::string& script, const std::string& out,
                       const std::string& file) {
  const auto session = examples::run_script(script, file);
  if (!session) return std::unexpected(session.error());
  const auto svg = what == "stress" ? stress_picture(*session) : modes_picture(*session);
  if (!svg) return std::unexpected(svg.error());
  return write_file_atomically(out, *svg);
}

}  // namespace

int main(int argc, char** argv) try {
  const std::string what = argc > 1 ? argv[1] : "";
  if ((argc != 4 && argc != 5) || (what != "stress" && what != "modes")) {
    std::fputs("usage: example_draw_analysis stress|modes SCRIPT.json OUT.svg [FILE.step]\n",
               stderr);
    return 2;
  }
  const auto status = picture(what, argv[2], argv[3], argc == 5 ? argv[4] : "");
  if (!status) {
    fmt::print(stderr, "example_draw_analysis: {}\n", status.error().message());
    return 1;
  }
  return 0;
} catch (const std::exception& e) {
  std::fputs(e.what(), stderr);
  return 1;
}
