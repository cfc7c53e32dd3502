// Six kernels and a frame for counting their instructions: knead_instructions KERNEL prepares one,
// runs it once outside and once inside `knead_measured`, which is what scripts/instructions.sh has
// callgrind count. Without an argument it lists the kernels; --compiler prints what compiled it,
// --set the instruction set in use.
#include <array>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "knead/energy/stiffness.hpp"
#include "knead/gramian/gramian.hpp"
#include "knead/session/command_json.hpp"
#include "knead/solve/sparse_cholesky.hpp"
#include "knead/spline/evaluate.hpp"
#include "sample_surface.hpp"
#include "scene/model/model.hpp"
#include "session/session_state.hpp"
#include "tool/tool_load.hpp"

// The one function whose instructions are counted, with all that it calls.
extern "C" [[gnu::noinline]] void knead_measured(const std::function<void()>& kernel) { kernel(); }

namespace {

using namespace knead;

void keep(const void* result) { asm volatile("" : : "g"(result) : "memory"); }

void check(bool fine, const char* what) {
  if (fine) return;
  std::fprintf(stderr, "knead_instructions: %s\n", what);
  std::exit(3);
}

void measure(const std::function<void()>& kernel) {
  kernel();  // what is done once only: symbols bound, memory taken
  knead_measured(kernel);
}

void gramian_recurrence() {
  std::mt19937_64 random(7);
  std::vector<double> knots(4, 0.0);
  for (int k = 0; k < 997; ++k)
    knots.push_back(knots.back() + 1 + static_cast<double>(random() % 1024) / 1024);
  knots.insert(knots.end(), 3, knots.back());
  const KnotVector vector = *KnotVector::create(3, std::move(knots));
  GramianSet set;
  measure([&] {
    recompute_gramians(vector, GramianMethod::recurrence, set);
    keep(set.g00.diagonal(0).data());
  });
}

void grid_evaluation() {
  const Surface surface = bench::sample_surface(false);
  const auto table = tabulate_basis(surface.knots(0), bench::sample_parameters(), 1);
  Evaluation<2> result;
  measure([&] {
    check(evaluate_grid<2>(surface, {&*table, &*table}, 1, result).has_value(),
          "evaluation failed");
    keep(result.derivatives.back().data());
  });
}

Stiffness<2> stiffness() {
  const KnotVector k = *KnotVector::clamped_uniform(3, 64);
  return *Stiffness<2>::create({k, k}, stretch_and_bend<2>({{1, 0.3, 0.5}, {1e-3, 2e-3, 5e-4}}));
}

void stiffness_refresh() {
  const Stiffness<2> k = stiffness();
  SparseMatrix matrix = k.assemble();
  measure([&] {
    k.refresh(matrix);
    keep(matrix.valuePtr());
  });
}

/// Numbers without a library's rounding in them.
Points some_points(int count) {
  std::mt19937 random(3);
  Points points(count, 3);
  for (Eigen::Index i = 0; i < points.size(); ++i)
    points.data()[i] = static_cast<double>(random() % 4096) / 4096;
  return points;
}

void unassembled_apply() {
  const Stiffness<2> k = stiffness();
  const Points x = some_points(k.size());
  measure([&] { keep(k.apply(x).data()); });
}

void substitution() {
  const Stiffness<2> k = stiffness();
  SparseMatrix a = k.assemble();
  for (int i = 0; i < a.rows(); ++i) a.coeffRef(i, i) += 1e-3;
  const auto factor = SparseCholesky::factor(a);
  check(factor.has_value(), "no factor");
  const Points b = some_points(k.size());
  measure([&] { keep(factor->solve(b).data()); });
}

Tool ball(const Point& centre, double radius) {
  return {"ball", *PlacedShape::create(SphereShape{radius},
                                       {Eigen::Quaterniond::Identity(), centre, {1, 1, 1}})};
}

void tool_forces() {
  const KnotVector k = *KnotVector::clamped_uniform(3, 64);
  Points flat(64 * 64, 3);
  for (int i = 0; i < 64; ++i) {
    for (int j = 0; j < 64; ++j) flat.row(i * 64 + j) << k.greville(i), k.greville(j), 0;
  }
  const Surface sheet = *Surface::create({k, k}, flat);
  const auto load =
      ToolLoad<2>::create(sheet, DomainScaling<2>{}, std::numeric_limits<double>::infinity());
  check(load.has_value(), "no load");
  const std::vector<ModelTool> tools = {ModelTool(ball({0.5, 0.5, 0.1}, 0.15), Point::Zero(), 1)};
  measure([&] {
    PotentialState state;
    state.force = Points::Zero(sheet.size(), 3);
    load->evaluate(sheet.control_points(), 0, 0, {.tools = tools}, state);
    check(!state.contacts.empty(), "no contact");
    keep(state.force.data());
  });
}

void contact_frame() {
  Session session(Document::fresh("sheet"));
  for (const char* line :
       {R"({"do":"new","shape":"plane","net":[24,24]})", R"({"do":"hold","rows":2})",
        R"({"do":"evolve","lambda":20,"accuracy":"interactive"})",
        R"({"do":"tool","name":"ball","radius":0.15,"position":[0.5,0.5,0.14]})"}) {
    const auto command = parse_command(line);
    check(command.has_value() && session.execute(*command).has_value(), line);
  }
  const SessionState start = session.state();
  const auto scene = make_model(model_input(start, start.evolution));
  check(scene.has_value(), "no model");
  const ActiveState state = active_state(start);
  measure([&] {
    const auto step = scene->model.step(state, start.tools);
    check(step.has_value() && step->converged, "a step failed");
    keep(step->control_points.data());
  });
}

struct Kernel {
  const char* name;
  void (*run)();
};
constexpr Kernel kernels[] = {{"gramian_recurrence", gramian_recurrence},
                              {"grid_evaluation", grid_evaluation},
                              {"stiffness_refresh", stiffness_refresh},
                              {"unassembled_apply", unassembled_apply},
                              {"substitution", substitution},
                              {"tool_forces", tool_forces},
                              {"contact_frame", contact_frame}};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    for (const Kernel& kernel : kernels) std::puts(kernel.name);
    return 0;
  }
  const std::string_view asked = argv[1];
  if (asked == "--set") return std::puts(std::string(name(best_instruction_set())).c_str()) < 0;
  if (asked == "--compiler") {
#ifdef __clang__
    return std::printf("clang++ %d\n", __clang_major__) < 0;
#else
    return std::printf("g++ %d\n", __GNUC__) < 0;
#endif
  }
  for (const Kernel& kernel : kernels) {
    if (asked != kernel.name) continue;
    kernel.run();
    return 0;
  }
  std::fprintf(stderr, "knead_instructions: no kernel \"%s\"; without an argument all are listed\n",
               argv[1]);
  return 2;
}
