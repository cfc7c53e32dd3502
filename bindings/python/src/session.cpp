#include "session.hpp"

#include <filesystem>
#include <limits>

#include "grids.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/exchange/format.hpp"
#include "knead/exchange/save_model.hpp"
#include "knead/session/command_json.hpp"
#include "knead/session/report.hpp"
#include "knead/session/session_info.hpp"
#include "scene/shell_fields.hpp"
#include "session/queries/document_query.hpp"
#include "session/session_state.hpp"
#include "sparse.hpp"
#include "text.hpp"

namespace knead::python {
namespace {

/// Scripts begin so: the edges of faces are held. It cannot be undone.
Expected<void> begin(Session& session) {
  auto status = session.execute(default_hold());
  if (status) session.begin_history();
  return status;
}

std::shared_ptr<const Source> source_of(const py::bytes& bytes, const std::string& name,
                                        std::size_t max_unpacked) {
  auto text = std::string(bytes);
  return value_of(without_interpreter(
      [&] { return open_source(std::move(text), name, {.max_unpacked = max_unpacked}); }));
}

}  // namespace

PySession::PySession(std::shared_ptr<const Source> source, Session session)
    : source_(std::move(source)), session_(std::move(session)) {}

std::unique_ptr<PySession> PySession::open(const py::bytes& bytes, const std::string& name,
                                           std::size_t max_unpacked) {
  auto made = source_of(bytes, name, max_unpacked);
  auto held = std::make_unique<PySession>(made, Session(Document::from(made)));
  value_of(held->alone([&] { return begin(held->session_); }));
  return held;
}

std::unique_ptr<PySession> PySession::fresh(const std::string& name, const std::string& unit) {
  if (!is_length_unit(unit)) {
    raise({ErrorKind::usage, "\"" + unit + "\" is no unit of length", "unit",
           "use one of " + list_of_length_units()});
  }
  auto held = std::make_unique<PySession>(nullptr, Session(Document::fresh(name, unit)));
  value_of(begin(held->session_));
  return held;
}

std::unique_ptr<PySession> PySession::copy() {
  auto made =
      alone([&] { return restored(session_.snapshot(unlimited), session_.opening_commands()); });
  return std::make_unique<PySession>(source_, value_of(std::move(made)));
}

Expected<Session> PySession::restored(const std::string& snapshot, std::size_t opening) const {
  const Document& present = session_.document();
  auto made = Session::restore(
      source_ ? Document::from(source_) : Document::fresh(present.name(), present.unit()),
      snapshot);
  if (made) made->begin_history_after(opening);
  return made;
}

py::tuple PySession::state() {
  auto [file, snapshot, opening, name, unit] = alone([&] {
    std::vector<std::shared_ptr<const Surface>> surfaces;
    if (source_) {
      for (const SourceSurface& s : source_->surfaces()) surfaces.push_back(s.surface);
    }
    // With its own surfaces a file is saved as the bytes that it has.
    auto bytes = source_ ? source_->save(surfaces) : Expected<std::string>();
    const Document& present = session_.document();
    return std::tuple(std::move(bytes), session_.snapshot(unlimited), session_.opening_commands(),
                      present.name(), present.unit());
  });
  const py::object bytes = source_ ? py::object(py::bytes(value_of(std::move(file)))) : py::none();
  return py::make_tuple(bytes, py::bytes(snapshot), opening, name, unit);
}

std::unique_ptr<PySession> PySession::from_state(const py::tuple& state) {
  const auto name = state[3].cast<std::string>();
  auto source =
      state[0].is_none() ? nullptr : source_of(state[0].cast<py::bytes>(), name, max_file_size);
  auto document =
      source ? Document::from(source) : Document::fresh(name, state[4].cast<std::string>());
  auto held = std::make_unique<PySession>(std::move(source), Session(std::move(document)));
  const auto snapshot = state[1].cast<std::string>();
  const auto opening = state[2].cast<std::size_t>();
  held->session_ = value_of(held->alone([&] { return held->restored(snapshot, opening); }));
  return held;
}

void PySession::execute(const std::string& json, py::object progress) {
  const Command command = value_of(parse_command(json));
  Work work(std::move(progress));
  auto status = alone([&] {
    return session_.execute(
        command, [&](int step, int all) { return work.tell(step, all); },
        [&] { return work.go_on(); });
  });
  work.finish();
  value_of(std::move(status));
}

void PySession::run(const std::string& text, const std::string& name, bool list,
                    py::object progress) {
  std::size_t implied = 0;
  auto read = list ? parse_commands(text) : parse_script(text, name, &implied);
  if (!read) raise(list ? read.error() : error_of_script(read.error(), text, name));
  const std::span<const Command> commands = std::span(*read).subspan(implied);
  Work work(std::move(progress));
  auto status = alone([&] {
    return session_.run(
        commands,
        [&](Error error, std::size_t k) {
          return error_at_command(std::move(error), session_.document(), name, k);
        },
        [&](int step, int all) { return work.tell(step, all); }, [&] { return work.go_on(); });
  });
  work.finish();
  value_of(std::move(status));
}

py::list PySession::shapes() {
  const auto listed = alone([&] {
    std::vector<std::array<std::string, 4>> rows;
    for (const SceneSurface& s : session_.state().surfaces)
      rows.push_back({"surface", s.id, s.name, s.unit});
    for (const SceneBody& body : session_.state().bodies) {
      const ShapeCommon& common = common_of(body);
      rows.push_back({kind_of(body), common.id, common.name, common.unit});
    }
    return rows;
  });
  py::list result;
  for (const auto& [kind, id, name, unit] : listed)
    result.append(py::make_tuple(kind, id, name, unit));
  return result;
}

py::object PySession::shape(const std::string& id, bool opened) {
  const auto found = alone([&]() -> std::variant<std::monostate, Held<1>, Held<2>, Held<3>> {
    for (const SceneSurface& s : session_.state().surfaces) {
      if (s.id == id) return Held<2>{opened ? s.opened : s.current};
    }
    for (const SceneBody& body : session_.state().bodies) {
      if (common_of(body).id != id) continue;
      if (const auto* curve = std::get_if<SceneCurve>(&body))
        return Held<1>{opened ? curve->opened : curve->current};
      const auto& volume = std::get<SceneVolume>(body);
      return Held<3>{opened ? volume.opened : volume.current};
    }
    return std::monostate();
  });
  if (const auto* curve = std::get_if<Held<1>>(&found)) return py::cast(*curve);
  if (const auto* surface = std::get_if<Held<2>>(&found)) return py::cast(*surface);
  if (const auto* volume = std::get_if<Held<3>>(&found)) return py::cast(*volume);
  return py::none();
}

std::string PySession::name() {
  return alone([&] { return session_.document().name(); });
}

std::string PySession::script() {
  return alone([&] { return script_json(session_.journal()); });
}

std::string PySession::info() {
  return alone([&] { return session_json(session_); });
}

std::string PySession::text() {
  return alone([&] { return text_of(session_, source_.get()); });
}

std::string PySession::report() {
  return value_of(alone([&] {
    const std::size_t opened = source_ ? source_->surfaces().size() : 0;
    const Outcome outcome = outcome_of(session_, opened);
    return report_json(session_, outcome);
  }));
}

py::tuple PySession::ask(const std::string& query, const std::string& request,
                         const py::bytes& bytes) {
  const std::string_view given = bytes;
  const DocumentAnswer answer =
      value_of(alone([&] { return ask_document(session_, query, request, given); }));
  py::dict files;
  for (const auto& [name, content] : answer.files) files[py::str(name)] = py::bytes(content);
  return py::make_tuple(answer.json, files);
}

std::string PySession::selected() {
  return alone([&]() -> std::string {
    const SessionState& state = session_.state();
    if (state.body) return common_of(state.bodies[static_cast<std::size_t>(*state.body)]).id;
    return state.selected ? state.surfaces[static_cast<std::size_t>(*state.selected)].id
                          : std::string();
  });
}

py::tuple PySession::file(const std::string& name, double tolerance, int detail,
                          const std::string& schema, bool triangles_too) {
  auto made = alone([&]() -> Expected<WrittenFile> {
    if (name.empty()) {
      auto bytes = session_.save();
      if (!bytes) return std::unexpected(std::move(bytes.error()));
      return WrittenFile{*std::move(bytes), {}};
    }
    const auto triangles = format_of_name(name, FormatContent::triangles);
    if (triangles && !triangles_too) {
      return usage_error(
          std::string((*triangles)->name) + " holds triangles, which lose the surfaces", name,
          "use export");
    }
    auto written = file_of(session_, name,
                           {.schema = schema == "ap242" ? "ap242" : "ap214",
                            .tolerance = tolerance,
                            .detail = detail});
    if (!written || triangles) return written;
    auto bytes = compress_by_name(std::move(written->bytes), name);
    if (!bytes) return std::unexpected(std::move(bytes.error()));
    return WrittenFile{*std::move(bytes), std::move(written->left_out)};
  });
  auto [bytes, left_out] = value_of(std::move(made));
  py::list lines;
  for (const std::string& line : left_out) lines.append(line);
  return py::make_tuple(py::bytes(bytes), lines);
}

py::tuple PySession::analysis(int samples) {
  // Grids, reactions, modes and buckling modes of one moment.
  using Values = std::vector<std::array<double, 2>>;
  const auto values = [](const std::vector<ModeRecord>& records) {
    Values list;
    for (const ModeRecord& mode : records) list.push_back({mode.value, mode.residual});
    return list;
  };
  auto made = alone(
      [&]() -> Expected<
                std::tuple<std::vector<FieldGrid>, std::vector<HoldReaction>, Values, Values>> {
        const SessionState& state = session_.state();
        if (!state.selected) return input_error("no surface is selected", {}, "select one");
        auto grids = result_grids(session_, samples);
        if (!grids) return std::unexpected(grids.error());
        std::vector<HoldReaction> reactions;
        if (is_nonlinear(state.surfaces[static_cast<std::size_t>(*state.selected)].elasticity)) {
          auto found = hold_reactions(state);
          if (!found) return std::unexpected(found.error());
          reactions = *std::move(found);
        }
        return std::tuple(*std::move(grids), std::move(reactions), values(state.modes),
                          values(state.buckling));
      });
  auto [grids, reactions, vibrations, bucklings] = value_of(std::move(made));
  py::list forces, modes, buckling;
  for (const HoldReaction& r : reactions)
    forces.append(py::make_tuple(r.hold, r.force.x(), r.force.y(), r.force.z()));
  for (const auto& [value, residual] : vibrations) modes.append(py::make_tuple(value, residual));
  for (const auto& [value, residual] : bucklings) buckling.append(py::make_tuple(value, residual));
  return py::make_tuple(Grids{std::make_shared<const std::vector<FieldGrid>>(std::move(grids))},
                        forces, modes, buckling);
}

py::tuple PySession::matrices(std::optional<bool> normalised, double tolerance) {
  using Found = std::tuple<std::shared_ptr<const Surface>, MaterialFieldOf<2>, int, Vector3, bool>;
  const auto found = alone([&]() -> Expected<Found> {
    const SessionState& state = session_.state();
    if (!state.selected || state.body)
      return input_error("no surface is selected", {}, "select one");
    const SceneSurface& s = state.surfaces[static_cast<std::size_t>(*state.selected)];
    if (is_nonlinear(s.elasticity)) {
      return usage_error("a shell has no constant matrices: what resists depends on its shape",
                         s.id, "give it a linear material");
    }
    return Found(s.reference, s.material, s.hold_rows, state.load.vector,
                 state.scaling == ScalingMode::normalised);
  });
  const auto [shape, material, hold, load, as_document] = value_of(found);
  return matrices_of(*shape, material, {load[0], load[1], load[2]}, hold,
                     normalised.value_or(as_document), tolerance);
}

void bind_session(py::module_& module) {
  module.def("script_schema", &script_schema);
  module.def("document_queries", &document_queries_json);
  py::class_<PySession>(module, "Session")
      .def_static("open", &PySession::open)
      .def_static("fresh", &PySession::fresh)
      .def_static("from_state", &PySession::from_state)
      .def("state", &PySession::state)
      .def("copy", &PySession::copy)
      .def("execute", &PySession::execute)
      .def("run", &PySession::run)
      .def("shapes", &PySession::shapes)
      .def("shape", &PySession::shape)
      .def("selected", &PySession::selected)
      .def("name", &PySession::name)
      .def("script", &PySession::script)
      .def("info", &PySession::info)
      .def("text", &PySession::text)
      .def("report", &PySession::report)
      .def("ask", &PySession::ask)
      .def("file", &PySession::file)
      .def("analysis", &PySession::analysis)
      .def("matrices", &PySession::matrices);
}

}  // namespace knead::python
