// What programs ask beside the page: commands one by one, scripts, reports and files of other
// formats.
#include "knead/session/command_json.hpp"
#include "knead/session/report.hpp"
#include "query.hpp"
#include "session/commands.hpp"

namespace knead::studio {
namespace {

Expected<Nothing> answered(Expected<void> status) {
  if (!status) return std::unexpected(std::move(status.error()));
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
  return answered(studio.session->run(
      q.commands, [](Error error, std::size_t) { return error; }, studio.progress, studio.go_on));
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
  return answered(studio.session->run(
      std::span(*read).subspan(implied),
      [&](Error error, std::size_t k) {
        return error_at_command(std::move(error), studio.session->document(), q.name, k);
      },
      studio.progress, studio.go_on));
}

Expected<std::string> report(Studio& studio) {
  if (!studio.session) return nothing_open();
  return report_json(*studio.session, outcome_of(*studio.session, studio.file_surfaces));
}

struct FileQuery {
  using Answer = struct FileAnswer;
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

struct FileAnswer {
  Bytes file;
  std::vector<std::string> left_out;
};

void describe(FileAnswer& written, Fields& fields) {
  fields.name("written file", "A file of another format.");
  fields.add("file", written.file);
  fields.add("left_out", written.left_out,
             {.help = "what the format does not hold, a sentence each"});
}

Expected<FileAnswer> ask(Session& session, const FileQuery& q) {
  auto written =
      file_of(session, q.name, {.schema = q.schema, .tolerance = q.tolerance, .detail = q.detail});
  if (!written) return std::unexpected(std::move(written.error()));
  return FileAnswer{{std::move(written->bytes)}, std::move(written->left_out)};
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
