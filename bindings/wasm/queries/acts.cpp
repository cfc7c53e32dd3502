// Commands, and the history that they make.
#include "knead/session/command_json.hpp"
#include "knead/session/session_info.hpp"
#include "query.hpp"
#include "session/commands.hpp"
#include "session/info_values.hpp"
#include "studio_context.hpp"

namespace knead::studio {
namespace {

struct ActQuery {
  using Answer = Nothing;
  Commands commands;
  bool join = false, keep = false;
};

void describe(ActQuery& q, Fields& fields) {
  fields.name("act", "Carries out commands as one act: all or none.");
  fields.add("commands", q.commands,
             {.help = "one after the other", .presence = Presence::required});
  fields.add("join", q.join, {.help = "it belongs to the entry of the history before it"});
  fields.add("keep", q.keep, {.help = "it is an entry even if it changes nothing"});
}

Expected<Nothing> ask(Studio& studio, const ActQuery& q) {
  if (!studio.session) return nothing_open();
  Session& session = *studio.session;
  const auto& state = session.state();
  const bool first =
      session.document().is_fresh() && state.surfaces.empty() && state.bodies.empty();
  session.stop_at_faces(true);
  if (auto status = session.act(q.commands, {.join = q.join, .keep = q.keep}, studio.progress);
      !status) {
    return std::unexpected(std::move(status.error()));
  }
  if (first) studio.origin = origin_near(session.state(), studio.origin);
  return {};
}

Expected<Nothing> drop_unchanged(Session& session) {
  session.drop_unchanged();
  return {};
}

struct BeginHistoryQuery {
  using Answer = int;
  std::optional<int> commands;
};

void describe(BeginHistoryQuery& q, Fields& fields) {
  fields.name(
      "begin_history",
      "What stands belongs to the document: undo ends there. The answer is how many commands "
      "of the journal that are.");
  fields.add("commands", q.commands,
             {.help = "what stood after so many commands of the journal instead of now"});
}

Expected<int> ask(Session& session, const BeginHistoryQuery& q) {
  if (q.commands) {
    session.begin_history_after(static_cast<std::size_t>(std::max(0, *q.commands)));
  } else {
    session.begin_history();
  }
  return static_cast<int>(session.opening_commands());
}

struct RehearseQuery {
  using Answer = Nothing;
  Commands commands;
};

void describe(RehearseQuery& q, Fields& fields) {
  fields.name(
      "rehearse",
      "Carries out commands and leaves the session as it is; what was made for them is kept, so "
      "that they take less time later.");
  fields.add("commands", q.commands,
             {.help = "one after the other", .presence = Presence::required});
}

Expected<Nothing> ask(Session& session, const RehearseQuery& q) {
  if (auto status = session.rehearse(q.commands); !status)
    return std::unexpected(std::move(status.error()));
  return {};
}

Expected<std::string> journal(Session& session) { return commands_json(session.journal()); }

Expected<std::string> script(Session& session) { return script_json(session.journal()); }

Expected<std::string> script_opening(Studio&) { return commands_json({default_hold()}); }

Expected<std::string> state(Session& session) { return session_json(session); }

struct StepsQuery {
  using Answer = std::vector<StepRecord>;
  int first = 0;
};

void describe(StepsQuery& q, Fields& fields) {
  fields.name("steps", "What steps did.");
  fields.add("first", q.first, {.help = "the number of the first of them"});
}

Expected<std::string> ask(Session& session, const StepsQuery& q) {
  return steps_json(session, static_cast<std::size_t>(std::max(0, q.first)));
}

}  // namespace

std::vector<Query> act_queries() {
  return {
      query<ActQuery>(),
      query<Nothing, drop_unchanged>("drop_unchanged",
                                     "The last entry of the history goes if it is steps and "
                                     "settings that have changed nothing."),
      query<BeginHistoryQuery>(),
      query<RehearseQuery>(),
      query<Text, journal>("journal", "The list of all commands in effect as JSON, one per line."),
      query<Text, script>("script", "A script that does what the journal did."),
      query<std::vector<CommandVariant>, script_opening>(
          "script_opening", "The commands that precede those of every script."),
      query<SessionInfo, state>("state", "The session as panels show it."),
      query<StepsQuery>()};
}

}  // namespace knead::studio
