#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <sys/resource.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "knead/session/command_json.hpp"
#include "medians.hpp"
#include "scene/model/model.hpp"
#include "session/session_state.hpp"

// A moving ball in contact with a sheet: a cubic net over the unit square with two rows held and λ
// = 20, a ball of radius 0.15 whose centre goes from (0.5, 0.5, 0.16) by (0.005, 0, −0.004) per
// frame, 20 frames. Times are medians over the frames, in milliseconds of the processor.

namespace {

using namespace knead;

constexpr int frames = 20;

void check(bool fine, const std::string& what) {
  if (fine) return;
  std::fprintf(stderr, "contact_bench: %s\n", what.c_str());
  std::exit(1);
}

void execute(Session& session, const std::string& line) {
  const auto command = parse_command(line);
  check(command.has_value(), line);
  const auto status = session.execute(*command);
  check(status.has_value(), line);
}

SessionState sheet(int net) {
  Session session(Document::fresh("sheet"));
  for (const std::string& line :
       {fmt::format(R"({{"do":"new","shape":"plane","net":[{0},{0}]}})", net),
        std::string(R"({"do":"hold","rows":2})"), std::string(R"({"do":"evolve","lambda":20})"),
        std::string(R"({"do":"tool","name":"ball","radius":0.15,"position":[0.5,0.5,0.16]})")}) {
    execute(session, line);
  }
  return session.state();
}

/// The frames of one run, each appended to `times`.
struct Work {
  std::vector<double> times, iterations, solves;
};

/// \param step of a model, from a state under tools.
template <class Step>
void run(const Step& step_of, const SessionState& start, bool touches, Work& work) {
  std::vector<Tool> tools = start.tools;
  ActiveState state = active_state(start);
  for (int k = 0; k < frames; ++k) {
    const Placement& at = tools[0].shape.placement();
    tools[0].shape = *tools[0].shape.moved(at.rotation, at.position + Point(0.005, 0, -0.004));
    const double begun = bench::milliseconds();
    auto step = step_of(state, touches ? tools : std::vector<Tool>());
    work.times.push_back(bench::milliseconds() - begun);
    check(step.has_value() && step->converged, "a step failed");
    work.iterations.push_back(step->iterations);
    work.solves.push_back(step->solves);
    state.control_points = std::move(step->control_points);
  }
}

void frame(benchmark::State& state, bool touches, StepAccuracy accuracy,
           StepSolver solver = StepSolver::automatic) {
  SessionState start = sheet(static_cast<int>(state.range(0)));
  start.evolution.accuracy = accuracy;
  start.evolution.solver = solver;
  const double begun = bench::milliseconds();
  auto scene = make_model(model_input(start, start.evolution));
  check(scene.has_value(), "no model");
  state.counters["made_ms"] = bench::milliseconds() - begun;
  Work work;
  const auto step = [&](const ActiveState& from, const std::vector<Tool>& tools) {
    return scene->model.step(from, tools);
  };
  for (auto _ : state) run(step, start, touches, work);
  state.counters["ms"] = bench::median(work.times);
  state.counters["iterations"] = bench::median(work.iterations);
  state.counters["solves"] = bench::median(work.solves);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  state.counters["memory_mb"] = static_cast<double>(usage.ru_maxrss) / 1024;
}

void contact(benchmark::State& state) { frame(state, true, StepAccuracy::interactive); }
void contact_exact(benchmark::State& state) { frame(state, true, StepAccuracy::exact); }
void contact_iterative(benchmark::State& state) {
  frame(state, true, StepAccuracy::interactive, StepSolver::iterative);
}
void contact_free(benchmark::State& state) { frame(state, false, StepAccuracy::exact); }

/// The same sheet as a shell whose sides are 50 thicknesses long, static.
void shell(benchmark::State& state, StepAccuracy accuracy) {
  SessionState start = sheet(static_cast<int>(state.range(0)));
  for (std::size_t k = 0; k < start.surfaces.size(); ++k)
    start.surfaces[k].elasticity = ShellMaterial{2e5, 0.3, 0.02, 0};
  start.evolution.mode = Evolution::stationary;
  start.evolution.accuracy = accuracy;
  const auto model = model_of(start, start.evolution);
  check(model.has_value(), "no model of the shell");
  const auto step = [&](const ActiveState& from, const std::vector<Tool>& tools) {
    return (*model)->step(from, tools, {});
  };
  Work work;
  for (auto _ : state) run(step, start, true, work);
  state.counters["ms"] = bench::median(work.times);
  state.counters["iterations"] = bench::median(work.iterations);
}

/// A place of a stroke, as the studio asks for it: a ball half sunk into a sheet of clay, led on by
/// an eighth of its radius.
void stroke(benchmark::State& state) {
  constexpr double size = 200, radius = 0.08 * 1.4142135623730951 * size;
  std::vector<double> times;
  for (auto _ : state) {
    Session session(Document::fresh("sheet"));
    execute(session,
            fmt::format(R"({{"do":"new","size":{0},"net":[{1},{1}]}})", size, state.range(0)));
    execute(session, R"({"do":"hold","rows":2})");
    execute(session, R"({"do":"material","preset":"clay"})");
    execute(session, R"({"do":"evolve","mode":"acm","lambda":100,"accuracy":"interactive"})");
    const auto at = [&](int k) {
      return fmt::format("[{},{},{}]", size * 0.3 + radius / 8 * k, size * 0.45, radius / 2);
    };
    execute(session,
            fmt::format(R"({{"do":"tool","name":"ball","radius":{},"position":{},"plasticity":1}})",
                        radius, at(0)));
    for (int k = 0; k < frames; ++k) {
      const double begun = bench::milliseconds();
      execute(session,
              fmt::format(R"({{"do":"stroke","tool":"ball","path":[{}],"open":true}})", at(k)));
      if (k > 0) times.push_back(bench::milliseconds() - begun);  // the first one makes the model
    }
  }
  state.counters["ms"] = bench::median(times);
}

/// A drag of a thin superellipsoid with friction within a sphere of few spans, which are 15 times
/// the tool's size: every point in contact asks for a nearest point that is searched, as in no
/// other of these.
void thin_tool(benchmark::State& state) {
  std::vector<double> times;
  for (auto _ : state) {
    Session session(Document::fresh("sphere"));
    execute(session, R"({"do":"new","shape":"sphere","radius":1.4})");
    execute(session,
            R"({"do":"tool","shape":"superellipsoid","relative":true,"sizes":[0.4,0.03,0.13],
      "exponents":[0.2,1.54],"axis":[0.76,0.86,0.12],
      "position":[0.04,0.14,0.02],"friction":0.67})");
    const double begun = bench::milliseconds();
    execute(session, R"({"do":"drag","relative":true,"by":[0,0,0.2]})");
    times.push_back(bench::milliseconds() - begun);
  }
  state.counters["ms"] = bench::median(times);
}

void shell_contact(benchmark::State& state) { shell(state, StepAccuracy::interactive); }
void shell_contact_exact(benchmark::State& state) { shell(state, StepAccuracy::exact); }

BENCHMARK(contact)->Arg(32)->Arg(64)->Arg(128)->Arg(256)->Unit(benchmark::kMillisecond);
BENCHMARK(contact_iterative)->Arg(128)->Arg(256)->Unit(benchmark::kMillisecond);
BENCHMARK(contact_exact)->Arg(32)->Arg(64)->Arg(128)->Arg(256)->Unit(benchmark::kMillisecond);
BENCHMARK(stroke)->Arg(32)->Arg(64)->Unit(benchmark::kMillisecond);
BENCHMARK(thin_tool)->Unit(benchmark::kMillisecond);
BENCHMARK(shell_contact)->Arg(32)->Arg(64)->Unit(benchmark::kMillisecond);
BENCHMARK(shell_contact_exact)->Arg(32)->Arg(64)->Unit(benchmark::kMillisecond);
BENCHMARK(contact_free)->Arg(64)->Arg(128)->Arg(256)->Unit(benchmark::kMillisecond);

}  // namespace
