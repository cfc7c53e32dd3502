// What a Knead document holds, to the engine: a file, the commands of its journal, a snapshot. The
// input is a file and a script, a line "%%" between them.
#include "running.hpp"

using namespace knead;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view input = fuzz::text_of(data, size);
  const std::size_t at = input.find("\n%%\n");
  const std::string file(input.substr(0, at));
  const auto source = open_source(file, "fuzz.step");
  if (!source) {
    fuzz::check_error(source.error());
    return 0;
  }
  Session session(Document::from(*source));
  if (fuzz::control_points(session) > 400) return 0;
  const auto untouched = session.save();
  fuzz::check(untouched.has_value() && *untouched == file,
              "an untouched document is saved with other bytes");
  if (at != input.npos) fuzz::run(session, input.substr(at + 4), 6);
  const auto saved = session.save();
  if (!saved) fuzz::check_error(saved.error());
  const std::string snapshot = session.snapshot();
  const auto restored = Session::restore(Document::from(*source), snapshot);
  fuzz::check(restored.has_value(), "a snapshot cannot be restored");
  const auto same = restored->save();
  fuzz::check(same.has_value() == saved.has_value() && (!same || *same == *saved),
              "a restored session saves other bytes");
  while (session.can_undo())
    fuzz::check(session.execute(make_command(UndoCommand{})).has_value(), "undo");
  const auto undone = session.save();
  fuzz::check(undone.has_value() && *undone == file,
              "after everything was undone other bytes are saved");
  return 0;
}
