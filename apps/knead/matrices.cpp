#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "cad_input.hpp"
#include "cli.hpp"
#include "knead/contact/free_system.hpp"
#include "knead/exchange/format.hpp"
#include "knead/exchange/numerical_files.hpp"
#include "outputs.hpp"
#include "plain_surface.hpp"
#include "rational_option.hpp"
#include "say.hpp"

namespace knead::cli {
namespace {

using Json = nlohmann::ordered_json;

struct MatricesArguments {
  std::string file, surface, out;
  std::optional<std::string> degree;
  PlainSurfaceOption knots;
  UnpackOption unpack;
  std::string alpha = "1,0,1", beta = "0.01,0.01,0.01", load = "0,0,1", units = "raw";
  double mass = 1, damping = 1;
  int hold = 0;
  RationalOption rational;
};

template <std::size_t N>
Expected<std::array<double, N>> list(const std::string& text, const std::string& option) {
  const auto numbers = parse_numbers(text, option);
  if (!numbers) return std::unexpected(numbers.error());
  if (numbers->size() != N) {
    return usage_error(fmt::format("{} numbers do not fit", numbers->size()), option,
                       fmt::format("write {}", N));
  }
  std::array<double, N> result{};
  std::ranges::copy(*numbers, result.begin());
  return result;
}

/// What is given and would have no effect.
Expected<void> check_used(const MatricesArguments& options) {
  const bool file = !options.file.empty();
  if (!file && !options.surface.empty()) {
    return usage_error("there is no file that would have it", "--surface",
                       "name a CAD file, or leave it out");
  }
  if (file && (options.degree || !options.knots.weights.empty())) {
    return usage_error("a surface of a file has its own", options.degree ? "--degree" : "--weights",
                       "leave it out");
  }
  if (!file && options.knots.weights.empty() && options.rational.given()) {
    return usage_error("without weights nothing is rational", "--tolerance, --denominator",
                       "leave them out, or give --weights");
  }
  for (const auto& [option, value] :
       {std::pair("--mass", options.mass), std::pair("--damping", options.damping)}) {
    if (std::isfinite(value)) continue;
    return usage_error(fmt::format("{} is no finite number", value), option, "write a decimal");
  }
  return {};
}

/// The surface of a file, or a flat one over its own parameters on the knots that are given.
Expected<Surface> read_shape(const MatricesArguments& options, std::string& id) {
  if (options.file.empty()) {
    const auto degree = parse_pair(options.degree.value_or("3"), "--degree", true);
    if (!degree) return std::unexpected(degree.error());
    return options.knots.read(*degree);
  }
  const auto source = open_cad_file(options.file, options.unpack);
  if (!source) return std::unexpected(source.error());
  const auto& surfaces = (*source)->surfaces();
  if (options.surface.empty() && surfaces.size() != 1) {
    return usage_error(
        fmt::format("{} has {}", options.file, counted(surfaces.size(), "surface", "surfaces")),
        "--surface", "name one; `knead info` lists them");
  }
  for (const SourceSurface& s : surfaces) {
    if (!options.surface.empty() && s.id != options.surface) continue;
    id = s.id;
    return *s.surface;
  }
  return usage_error(fmt::format("there is no surface \"{}\"", options.surface), "--surface",
                     "`knead info` lists those of the file");
}

/// Makes the files of a directory, and lists them; they come into it together, or none does.
class Writer {
 public:
  Expected<void> file(const std::string& name, const Expected<std::string>& bytes) {
    if (!bytes) return std::unexpected(bytes.error());
    files_.emplace_back(name, *bytes);
    return {};
  }

  /// Errors: those of `write_together`.
  [[nodiscard]] Expected<void> write(const std::string& directory) const {
    return write_together({"--out", directory}, files_);
  }

  Expected<void> matrix(const std::string& name, const std::string& formula,
                        const SparseMatrix& matrix, double error_bound) {
    if (auto status = file(name + ".mtx", matrix_market(matrix, true)); !status) return status;
    if (auto status = file(name + ".npz", npz(matrix)); !status) return status;
    written.push_back({{"name", name},
                       {"formula", formula},
                       {"files", {name + ".mtx", name + ".npz"}},
                       {"rows", matrix.rows()},
                       {"columns", matrix.cols()},
                       {"entries", matrix.nonZeros()},
                       {"error_bound", std::isfinite(error_bound) ? Json(error_bound) : Json()}});
    return {};
  }

  Expected<void> array(const std::string& name, const std::string& formula,
                       const Expected<std::string>& bytes) {
    written.push_back({{"name", name}, {"formula", formula}, {"files", {name + ".npy"}}});
    return file(name + ".npy", bytes);
  }

  Json written = Json::array();

 private:
  std::vector<std::pair<std::string, std::string>> files_;
};

Expected<void> run(const MatricesArguments& options) {
  if (options.file.empty() == !options.knots.given()) {
    return usage_error("neither a file nor knots, or both, are given", "FILE",
                       "name a CAD file, or give --degree, --knots-u and --knots-v");
  }
  if (auto used = check_used(options); !used) return used;
  if (options.units != "raw" && options.units != "normalised") {
    return usage_error(fmt::format("\"{}\" is no kind of units", options.units), "--units",
                       "write raw or normalised");
  }
  const auto alpha = list<3>(options.alpha, "--alpha"), beta = list<3>(options.beta, "--beta");
  const auto load = list<3>(options.load, "--load");
  if (!alpha || !beta || !load)
    return std::unexpected(!alpha ? alpha.error() : !beta ? beta.error() : load.error());
  const auto material = of_option(validated({*alpha, *beta}), "--alpha, --beta");
  if (!material) return std::unexpected(material.error());
  std::string id;
  auto shape = read_shape(options, id);
  if (!shape) return std::unexpected(shape.error());
  const auto net = shape->net();
  const auto free = of_option(free_unknowns(net, options.hold), "--hold");
  if (!free) return std::unexpected(free.error());
  const auto settings = options.rational.read();
  if (!settings) return std::unexpected(settings.error());
  DomainScaling<2> scaling;
  if (options.units == "normalised") {
    const auto normalised = normalised_scaling<2>(*shape);
    if (!normalised) return std::unexpected(normalised.error());
    scaling = *normalised;
  }
  const FreeSystem system(*std::move(shape), *free, scaling, *settings);
  Writer writer;
  for (const NamedEnergy& named : system_energies(*material, options.mass, options.damping)) {
    const auto made = system.of(named.energy);
    if (!made) return std::unexpected(made.error());
    if (auto status = writer.matrix(named.name, named.formula, made->matrix, made->error_bound);
        !status)
      return status;
  }
  const auto forces = system.forces({(*load)[0], (*load)[1], (*load)[2]});
  if (!forces) return std::unexpected(forces.error());
  if (auto status = writer.array("F", "load int R_i", npy(*forces)); !status) return status;
  if (auto status = writer.array("points", "control points", npy(system.points())); !status)
    return status;
  if (auto status = writer.array("free", "unknowns of the rows, of all m n", npy(system.free()));
      !status)
    return status;

  Json knots = Json::array();
  for (int d = 0; d < 2; ++d) {
    const auto values = system.shape().knots(d).knots();
    knots.push_back(std::vector<double>(values.begin(), values.end()));
  }
  const auto weights = system.shape().weights();
  const Json description = {
      {"file", options.file},
      {"surface", id},
      {"degree", {system.shape().knots(0).degree(), system.shape().knots(1).degree()}},
      {"net", net},
      {"knots", std::move(knots)},
      {"weights", std::vector<double>(weights.begin(), weights.end())},
      {"ordering",
       "control point (i, j) of the net m x n is unknown i n + j, from 0; the same for x, y and z"},
      {"units", options.units},
      {"length", scaling.length},
      {"factors", scaling.factors},
      {"alpha", *alpha},
      {"beta", *beta},
      {"mass", options.mass},
      {"damping", options.damping},
      {"load", *load},
      {"held_rows", options.hold},
      {"unknowns", system.free().size()},
      {"matrices", writer.written}};
  if (auto status = writer.file("matrices.json", description.dump(1) + "\n"); !status)
    return status;
  if (auto status = writer.write(options.out); !status) return status;
  say("wrote {} matrices and arrays of {} unknowns to {}\n", writer.written.size(),
      system.free().size(), options.out);
  return {};
}

}  // namespace

Action add_matrices(CLI::App& app) {
  auto options = std::make_shared<MatricesArguments>();
  CLI::App* command = app.add_subcommand(
      "matrices", "write stiffness, mass, damping and load of a surface for other programs");
  command->add_option("FILE", options->file, cad_file_help())->type_name("");
  command->add_option("--surface", options->surface,
                      "its surface, such as #285; may be left out where there is one");
  command->add_option("--degree", options->degree,
                      "without a file: degree, or one per direction as in 3x2 (default 3)");
  options->knots.add_to(*command, "without a file: ");
  command->add_option("--out", options->out, "directory for the files; made if it is missing")
      ->required();
  command->add_option("--alpha", options->alpha,
                      "stretch coefficients a11,a12,a22 (default 1,0,1)");
  command->add_option("--beta", options->beta,
                      "bend coefficients b11,b12,b22 (default 0.01,0.01,0.01)");
  command->add_option("--mass", options->mass, "mass per measure of the domain (default 1)");
  command->add_option("--damping", options->damping,
                      "damping per measure of the domain (default 1)");
  command->add_option("--load", options->load,
                      "load per measure of the domain, x,y,z (default 0,0,1)");
  command->add_option("--units", options->units, "raw, or normalised as in scripts (default raw)");
  options->rational.add_to(*command);
  command->add_option("--hold", options->hold,
                      "rows of control points held on each side, which are left out (default 0)");
  options->unpack.add_to(*command);
  command->footer(
      "Each matrix is written as Matrix Market text (lower triangle) and as NumPy's .npz for "
      "scipy.sparse.load_npz,\n"
      "F, the control points and the numbers of the free unknowns as .npy, all described in "
      "matrices.json.\n" +
      std::string(exit_codes));
  return [options] { return run(*options); };
}

}  // namespace knead::cli
