// What programs ask beside the page: commands one by one, scripts, reports and files of other
// formats.
#include "knead/exchange/format.hpp"
#include "knead/exchange/save_model.hpp"
#include "knead/session/command_json.hpp"
#include "knead/session/report.hpp"
#include "query.hpp"
#include "session/commands.hpp"

namespace knead::studio {
namespace {

/// Each command is an entry of the history. If one fails, none has had an effect; if one is
/// stopped, what was done stands. `at`: what the error of command k becomes.
template <class At>
Expected<void> carry_out(Studio& studio, std::span<const Command> commands, const At& at) {
  bool stopped = false;
  const auto go_on = [&](bool goes) {
    stopped = stopped || !goes;
    return goes;
  };
  const auto progress = [&](int steps, int count) {
    return go_on(!studio.progress || studio.progress(steps, count));
  };
  const auto within = [&] { return go_on(!studio.go_on || studio.go_on()); };
  Session& session = *studio.session;
  auto before = session.before(commands);
  for (std::size_t k = 0; k < commands.size() && !stopped; ++k) {
    auto status = session.execute(commands[k], progress, within);
    if (stopped || status) continue;
    Error error = at(std::move(status.error()), k);
    session.go_back(std::move(before));
    return std::unexpected(std::move(error));
  }
  return {};
}

struct ExecuteQuery {
  using Answer = Nothing;
  Commands commands;
};

void describe(ExecuteQuery& q, Fields& fields) {
  fields.name("execute",
              "Carries out commands as programs do: each is an entry of the history; all or none.");
  fields.add("commands", q.commands,
             {.help = "one after the other", .presence = Presence::required});
}

Expected<Nothing> ask(Studio& studio, const ExecuteQuery& q) {
  if (!studio.session) return nothing_open();
  auto status = carry_out(studio, q.commands, [](Error error, std::size_t) { return error; });
  if (!status) return std::unexpected(std::move(status.error()));
  return {};
}

struct RunQuery {
  using Answer = Nothing;
  Bytes script;
  std::string name = "script";
  bool list = false;
};

void describe(RunQuery& q, Fields& fields) {
  fields.name("run",
              "Carries out a script, as `execute`; errors begin with the place of the command.");
  fields.add("script", q.script, {.help = "its text", .presence = Presence::required});
  fields.add("name", q.name, {.help = "what errors call it"});
  fields.add("list", q.list, {.help = "it is a list of commands alone"});
}

Expected<Nothing> ask(Studio& studio, const RunQuery& q) {
  if (!studio.session) return nothing_open();
  std::size_t implied = 0;
  const auto read =
      q.list ? parse_commands(q.script.data) : parse_script(q.script.data, q.name, &implied);
  if (!read)
    return std::unexpected(q.list ? read.error()
                                  : error_of_script(read.error(), q.script.data, q.name));
  auto status =
      carry_out(studio, std::span(*read).subspan(implied), [&](Error error, std::size_t k) {
        return error_at_command(std::move(error), studio.session->document(), q.name, k);
      });
  if (!status) return std::unexpected(std::move(status.error()));
  return {};
}

Expected<std::string> report(Studio& studio) {
  if (!studio.session) return nothing_open();
  return report_json(*studio.session, outcome_of(*studio.session, studio.file_surfaces));
}

struct FileQuery {
  using Answer = struct WrittenFile;
  std::string name, schema = "ap214";
  double tolerance = 0;
  int detail = 96;
};

constexpr std::array schemas = {Choice("ap214", ""), Choice("ap242", "")};

void describe(FileQuery& q, Fields& fields) {
  fields.name("file", "The document as a file of any format, which the ending of its name tells.");
  fields.add("name", q.name, {.help = "of the file", .presence = Presence::required});
  fields.add("schema", q.schema, {.help = "of STEP", .choices = schemas});
  fields.add("tolerance", q.tolerance,
             {.help = "distance of triangles from faces, file units; 0: a two-thousandth of the "
                      "model's diagonal",
              .range = at_least(0)});
  fields.add("detail", q.detail,
             {.help = "of triangles without faces: lines per direction of each surface",
              .range = between(1, 2000)});
}

struct WrittenFile {
  Bytes file;
  std::vector<std::string> left_out;
};

void describe(WrittenFile& written, Fields& fields) {
  fields.name("written file", "A file of another format.");
  fields.add("file", written.file);
  fields.add("left_out", written.left_out,
             {.help = "what the format does not hold, a sentence each"});
}

Expected<WrittenFile> without_loss(Expected<std::string> bytes) {
  if (!bytes) return std::unexpected(std::move(bytes.error()));
  return WrittenFile{{*std::move(bytes)}, {}};
}

Expected<WrittenFile> meshed(Session& session, const Format& format, const FileQuery& q) {
  if (session.document().model() == nullptr) {
    std::vector<NamedSurface> surfaces;
    SaveOptions options;
    options.detail = q.detail;
    for (const SceneSurface& s : session.state().surfaces) {
      surfaces.push_back({s.name.empty() ? s.id : s.name, *s.current});
      options.unit = s.unit;
    }
    return without_loss(save_surfaces(surfaces, format, options));
  }
  auto saved = session.save();
  if (!saved) return std::unexpected(std::move(saved.error()));
  const auto file = open_source(*std::move(saved), session.document().name());
  if (!file) return std::unexpected(file.error());
  auto model = save_model(**file, format, q.tolerance);
  if (!model) return std::unexpected(std::move(model.error()));
  WrittenFile written{{std::move(model->bytes)}, std::move(model->warnings)};
  for (const LeftOut& left : left_out_of_mesh(**file, model->skipped))
    written.left_out.push_back(sentence(left));
  return written;
}

Expected<WrittenFile> ask(Session& session, const FileQuery& q) {
  const auto triangles = format_of_name(q.name, FormatContent::triangles);
  if (triangles) return meshed(session, **triangles, q);
  const auto format = format_of_name(q.name, FormatContent::surfaces);
  if (!format) {
    Error error = format.error();
    error.remedy += "; triangles: " + list_of_endings(FormatContent::triangles);
    return std::unexpected(std::move(error));
  }
  const Document& document = session.document();
  const bool same_format =
      document.source() != nullptr && (*format)->name == document.source()->format();
  if (same_format) return without_loss(session.save());
  const SaveOptions how{.schema = q.schema == "ap242" ? "ap242" : "ap214"};
  // New files of faces are not written here; the error of that says so.
  return without_loss(session.save_as(**format, how));
}

}  // namespace

std::vector<Query> program_queries() {
  return {query<ExecuteQuery>(), query<RunQuery>(),
          query<Text, report>(
              "report",
              "What commands have made of the document, as `knead sculpt --report` writes it."),
          query<FileQuery>()};
}

}  // namespace knead::studio
