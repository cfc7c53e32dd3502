#include "program.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <stdexcept>
#include <system_error>

#include "cli.hpp"
#include "environment.hpp"
#include "outputs.hpp"
#include "working.hpp"

namespace {

int exit_code(knead::ErrorKind kind) {
  switch (kind) {
    case knead::ErrorKind::usage:
      return 2;
    case knead::ErrorKind::input:
      return 3;
    case knead::ErrorKind::numerical:
      return 4;
  }
  return 4;
}

/// CLI11's description of an error in the arguments, with the command concerned, in one line.
knead::Error usage_error(const CLI::App& app, const CLI::ParseError& error,
                         const std::string& first) {
  const auto used = app.get_subcommands();
  if (used.empty() && !first.empty() && first.front() != '-') {
    std::string known;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
      known += (known.empty() ? "" : ", ") + command->get_name();
    }
    return {knead::ErrorKind::usage, "there is no command \"" + first + "\"", "command line",
            "the commands are: " + known};
  }
  const std::string command = used.empty() ? "knead" : "knead " + used.front()->get_name();
  std::string what = error.what();
  std::ranges::replace(what, '\n', ' ');
  return {knead::ErrorKind::usage, std::move(what), "command line", "see " + command + " --help"};
}

int fail(const knead::Error& error) {
  // Not by fmt::print, which throws if standard error is closed: the exit code still tells.
  const std::string written =
      knead::cli::written_outputs().empty() ? "" : "; written: " + knead::cli::written_outputs();
  const std::string line = "knead: " + error.message() + written + "\n";
  static_cast<void>(std::fputs(line.c_str(), stderr));
  return exit_code(error.kind);
}

/// The value of these options may begin with a minus sign, which would read as an option: joined
/// with "=".
std::vector<std::string> joined_arguments(int argc, char** argv) {
  static constexpr std::array<std::string_view, 8> number_lists = {
      "--knots", "--alpha", "--beta", "--rational-weights", "--from", "--to", "--scale", "--space"};
  std::vector<std::string> arguments(argv + 1, argv + argc);
  for (std::size_t k = 0; k + 1 < arguments.size(); ++k) {
    for (std::string_view option : number_lists) {
      if (arguments[k] != option) continue;
      arguments[k] += "=" + arguments[k + 1];
      arguments.erase(arguments.begin() + static_cast<std::ptrdiff_t>(k) + 1);
      break;
    }
  }
  return {arguments.rbegin(), arguments.rend()};  // CLI11 takes them in reverse order
}

/// Opens what standard streams are closed, so that no file takes their place and gets what is
/// printed; writing to them still fails.
void occupy_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) >= 0) continue;
    if (::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY) != stream) std::abort();
  }
}

/// What is printed is lost; the files are not.
knead::Error lost_output(const std::string& reason) {
  const char* const what = knead::cli::written_outputs().empty()
                               ? "the output could not be written"
                               : "what is printed could not be written";
  return {knead::ErrorKind::input, what + reason, "standard output",
          "is it closed, or the disk full?"};
}

int run(int argc, char** argv) {
  CLI::App app(
      "Knead sculpts exact B-spline and NURBS geometry: the CAD file that comes out is the one "
      "that went in,\n"
      "with the sculpted surface changed and nothing else.",
      "knead");
  app.set_version_flag("--version", std::string("knead ") + KNEAD_VERSION);
  app.require_subcommand(1);
  app.footer(std::string(knead::cli::exit_codes) +
             "\nErrors are one line on standard error: file, place, what is wrong; remedy."
             "\n`knead COMMAND --help` explains a command.");
  const std::array<knead::cli::Action, 14> actions = {
      knead::cli::add_info(app),     knead::cli::add_sculpt(app),  knead::cli::add_analyse(app),
      knead::cli::add_commands(app), knead::cli::add_gramian(app), knead::cli::add_stiffness(app),
      knead::cli::add_matrices(app), knead::cli::add_basis(app),   knead::cli::add_mesh(app),
      knead::cli::add_export(app),   knead::cli::add_schema(app),  knead::cli::add_snake(app),
      knead::cli::add_check(app),    knead::cli::add_morph(app)};
  try {
    app.parse(joined_arguments(argc, argv));
  } catch (const CLI::Success& success) {
    return app.exit(success);  // --help, --version
  } catch (const CLI::ParseError& error) {
    return fail(usage_error(app, error, argc > 1 ? argv[1] : ""));
  }
  if (auto known = knead::cli::check_environment(); !known) return fail(known.error());
  const auto subcommands = app.get_subcommands([](CLI::App*) { return true; });
  int code = EXIT_SUCCESS;
  for (std::size_t k = 0; k < subcommands.size(); ++k) {
    if (!app.got_subcommand(subcommands[k])) continue;
    const auto status = actions[k]();
    if (!status) return fail(status.error());
    code = *status;
  }
  if (std::fflush(stdout) != 0 || std::ferror(stdout)) {
    return fail(lost_output({}));
  }
  return code;
}

}  // namespace

int knead::cli::program(int argc, char** argv) {
  occupy_standard_streams();
  // The library's failures are values. What is left comes from the standard library: no memory, or
  // no place to print to.
  try {
    return run(argc, argv);
  } catch (const std::bad_alloc&) {
    return fail(out_of_memory(place_of_work()));
  } catch (const std::length_error&) {
    return fail(out_of_memory(place_of_work()));
  } catch (const std::system_error& error) {
    return fail(lost_output(std::string(": ") + error.what()));
  }
}
